//! Shapes runs of text with the fonts that a text names, and with other fonts for the letters that these lack.

use super::faces::Look;
use super::fallback::Wanted;
use super::fonts::{self, Bytes, Chooser, FontFile, FontGuard};
use super::images::{Missing, Rejected};
use super::read::ReadOptions;
use pathwarp_text::{Error, Font, FontRun, Run, Variation, Writing, features, runs, shape_run};
use skrifa::raw::TableProvider as _;
use skrifa::{FontRef, Tag};
use std::sync::Arc;
use usvg::fontdb::{Database, ID, Source};

/// A font of a text.
pub(super) struct TextFont {
    /// The face in the database; `None` for a file that a user gave.
    pub(super) face: Option<ID>,
    data: Bytes,
    index: u32,
    /// The writing for which it was found; `None` if the text names it.
    only: Option<Writing>,
}

impl TextFont {
    pub(super) fn of_face(face: ID, only: Option<Writing>, db: &Database) -> Option<Self> {
        let info = db.face(face)?;
        let data = match &info.source {
            Source::Binary(data) => data.clone(),
            _ => db.with_face_data(face, |data, _| Arc::new(data.to_vec()) as Bytes)?,
        };
        Some(Self { face: Some(face), data, index: info.index, only })
    }

    /// Returns `true` if the font draws small capitals (OpenType's feature `smcp`).
    pub(super) fn has_small_capitals(&self) -> bool {
        let font = FontRef::from_index((*self.data).as_ref(), self.index).ok();
        let features = font.and_then(|f| f.gsub().ok()?.feature_list().ok());
        features.is_some_and(|all| all.feature_records().iter().any(|r| r.feature_tag() == Tag::new(b"smcp")))
    }

    /// The font at the style's positions on axes. Returns `None` if it is damaged.
    fn font(&self, style: &ShapingStyle) -> Option<Font<'_>> {
        let font = Font::for_shaping((*self.data).as_ref(), self.index).ok()?;
        let axes = font.axes();
        let position = |(tag, value): &(String, f32)| {
            let axis = axes.iter().find(|a| a.tag == *tag)?;
            Variation::new(tag, f64::from(*value).clamp(axis.min, axis.max)).ok()
        };
        let font = font.with_variations(&style.variations.iter().filter_map(position).collect::<Vec<_>>()).ok()?;
        Some(if let Some(writing) = self.only { font.only_for(writing) } else { font })
    }
}

/// The properties on which the shape of letters depends beside their font.
#[derive(Default)]
pub(super) struct ShapingStyle {
    pub(super) size: f64,
    /// OpenType features in the form that [`features`] reads.
    pub(super) features: String,
    /// Positions on axes. Axes that a font lacks have no effect.
    pub(super) variations: Vec<(String, f32)>,
    pub(super) language: String,
}

/// Shapes a run of a line, from left to right. Adds fonts for letters that `fonts` lack, in the order of these letters. Returns nothing if
/// the fonts are damaged.
pub(super) fn shape_with_fallback(
    line: &str,
    run: &Run,
    fonts: &mut Vec<TextFont>,
    (style, look): (&ShapingStyle, Look),
    (chooser, db): (&Chooser, &mut Arc<Database>),
) -> Vec<FontRun> {
    /// Limit on rounds that add a font for a run. Real texts need one or two.
    const MAX_ROUNDS: usize = 8;
    let features = features(&style.features).unwrap_or_default();
    let mut add = |letters: &str, fonts: &mut Vec<TextFont>| {
        let tried = |f: &&TextFont| f.only.is_none_or(|w| w == run.writing);
        let used: Vec<ID> = fonts.iter().filter(tried).filter_map(|f| f.face).collect();
        let found =
            chooser.fallback(&Wanted { letters, writing: run.writing, language: &style.language, look }, &used, db);
        let is_for_emoji = |id: &ID| db.face(*id).is_some_and(|f| f.families.iter().any(|n| n.0.contains("Emoji")));
        let found = found.filter(|id| run.writing != Writing::Emoji || is_for_emoji(id) || !fonts.is_empty());
        let font = found.and_then(|id| TextFont::of_face(id, Some(run.writing), db));
        let added = font.is_some();
        fonts.extend(font);
        added
    };
    if run.writing == Writing::Emoji && !fonts.iter().any(|f| f.only == Some(Writing::Emoji)) {
        add(&line[run.range.clone()], fonts);
    }
    // Clusters that no font has.
    let mut absent: Vec<std::ops::Range<usize>> = Vec::new();
    for _ in 0..MAX_ROUNDS {
        // Unreadable fonts are skipped, but keep their indices.
        let read: Vec<Option<Font<'_>>> = fonts.iter().map(|f| f.font(style)).collect();
        let indices: Vec<usize> = (0..read.len()).filter(|i| read[*i].is_some()).collect();
        let usable: Vec<Font<'_>> = read.into_iter().flatten().collect();
        let mut parts = match shape_run(line, run, &usable, style.size, &features) {
            Ok(parts) => parts,
            Err(Error::NoFont) => {
                drop(usable);
                let first = line[run.range.clone()].chars().next().unwrap_or_default();
                if !add(&first.to_string(), fonts) {
                    return Vec::new();
                }
                continue;
            }
            Err(_) => return Vec::new(),
        };
        parts.iter_mut().for_each(|p| p.font = indices[p.font]);
        let lacking = parts.iter().filter(|p| p.missing).flat_map(|p| &p.clusters).map(|c| &c.0);
        let Some(cluster) = lacking.filter(|c| !absent.contains(c)).min_by_key(|c| c.start).cloned() else {
            return parts;
        };
        drop(usable);
        if !add(&line[cluster.clone()], fonts) {
            absent.push(cluster);
        }
    }
    Vec::new()
}

/// Finds installed or given fonts for the letters of a text that `fonts` lack, each with its writing. `weight` is 100 to 900; `language` is
/// a BCP 47 tag, or empty.
#[must_use]
pub fn fallback_fonts(
    text: &str,
    fonts: &[Font<'_>],
    (weight, italic): (u16, bool),
    language: &str,
    read: &ReadOptions,
) -> Vec<(FontFile, Writing)> {
    let mut db = fonts::database(read.system_fonts, &read.fonts);
    let guard = FontGuard::new(read, &Rejected::default());
    let chooser = Chooser::new(read.generic_families.clone(), Missing::default(), guard);
    let look = Look::new(weight, italic);
    let style = ShapingStyle { size: 1.0, language: language.to_owned(), ..ShapingStyle::default() };
    let mut found = Vec::new();
    for line in text.lines() {
        for run in runs(line) {
            let parts = shape_run(line, &run, fonts, style.size, &[]).unwrap_or_default();
            for clusters in parts.into_iter().filter(|p| p.missing).map(|p| p.clusters) {
                let start = clusters.iter().map(|c| c.0.start).min().unwrap_or_default();
                let end = clusters.iter().map(|c| c.0.end).max().unwrap_or_default();
                let run = Run { range: start..end, ..run.clone() };
                shape_with_fallback(line, &run, &mut found, (&style, look), (&chooser, &mut db));
            }
        }
    }
    let file = |f: TextFont| Some((FontFile { bytes: (*f.data).as_ref().to_vec(), index: f.index }, f.only?));
    found.into_iter().filter_map(file).collect()
}
