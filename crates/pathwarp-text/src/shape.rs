//! Shapes runs with the first font, and the parts that it lacks with the next one.

use crate::error::{Error, guarded};
use crate::font::Font;
use crate::itemize::{Run, Writing, for_shaper};
use crate::lettering::PlacedGlyph;
use crate::limits::TextLimits;
use crate::style::Feature;
use harfrust::{BufferFlags, Direction, Language, ShapeOptions, UnicodeBuffer};
use std::collections::BTreeSet;
use std::ops::Range;

/// A cluster of glyphs, in user units.
#[derive(Debug, Clone)]
pub(crate) struct ShapedCluster {
    /// Byte range in the line.
    pub(crate) range: Range<usize>,
    pub(crate) advance: f64,
    pub(crate) glyphs: Vec<PlacedGlyph>,
    /// `true` if no font has all of its characters.
    pub(crate) missing: bool,
}

/// Shapes all runs of a text.
pub(crate) struct RunShaper<'s, 'f> {
    pub(crate) fonts: &'s [Font<'f>],
    pub(crate) size: f64,
    pub(crate) features: Vec<harfrust::Feature>,
    pub(crate) language: Option<Language>,
    pub(crate) limits: &'s TextLimits,
    /// Number of glyphs so far.
    pub(crate) glyph_count: usize,
}

impl RunShaper<'_, '_> {
    /// Shapes a run. The clusters go from left to right.
    pub(crate) fn run(&mut self, line: &str, run: &Run) -> Result<Vec<ShapedCluster>, Error> {
        let order = order_of_preference(self.fonts, run.writing);
        self.shape(line, run, run.range.clone(), &order)
    }

    /// Shapes the `range` of a run with the first font of `order`, and clusters that it lacks with the others.
    fn shape(
        &mut self,
        line: &str,
        run: &Run,
        range: Range<usize>,
        order: &[usize],
    ) -> Result<Vec<ShapedCluster>, Error> {
        let [first, others @ ..] = order else { return Err(Error::NoFont) };
        let shaped = self.with_font(line, run, &range, *first)?;
        if others.is_empty() || !shaped.iter().any(|c| c.missing) {
            return Ok(shaped);
        }
        let mut out = Vec::with_capacity(shaped.len());
        // A damaged font may repeat a cluster; shape each missing part only once.
        let mut sought = BTreeSet::new();
        for group in shaped.chunk_by(|a, b| a.missing == b.missing) {
            if group.iter().all(|c| !c.missing) {
                out.extend_from_slice(group);
                continue;
            }
            let start = group.iter().map(|c| c.range.start).min().unwrap_or(0);
            let end = group.iter().map(|c| c.range.end).max().unwrap_or(0);
            if sought.insert(start) && start < end {
                let found = self.shape(line, run, start..end, others)?;
                // Clusters that no font has show the first font's box for missing characters.
                let all_missing = found.iter().all(|c| c.missing);
                out.extend(if all_missing { group.to_vec() } else { found });
            }
        }
        Ok(out)
    }

    /// Shapes the `range` of a run with one font. The clusters go from left to right.
    fn with_font(
        &mut self,
        line: &str,
        run: &Run,
        range: &Range<usize>,
        index: usize,
    ) -> Result<Vec<ShapedCluster>, Error> {
        let Some(font) = self.fonts.get(index) else { return Err(Error::NoFont) };
        let mut buffer = UnicodeBuffer::new();
        for (i, c) in line[range.clone()].char_indices() {
            // Lines are far shorter than `u32::MAX`.
            buffer.add(c, (range.start + i) as u32);
        }
        // Letters may join across the ends of a run.
        buffer.set_pre_context(&line[..range.start]);
        buffer.set_post_context(&line[range.end..]);
        let mut flags = BufferFlags::empty();
        flags.set(BufferFlags::BEGINNING_OF_TEXT, range.start == 0);
        flags.set(BufferFlags::END_OF_TEXT, range.end == line.len());
        buffer.set_flags(flags);
        buffer.set_direction(if run.rtl { Direction::RightToLeft } else { Direction::LeftToRight });
        match run.writing {
            Writing::Script(script) => for_shaper(script).into_iter().for_each(|s| buffer.set_script(s)),
            Writing::Emoji => buffer.set_script(harfrust::script::COMMON),
        }
        if let Some(language) = &self.language {
            buffer.set_language(language.clone());
        }
        let shaper = font.data.shaper(&font.font).instance(Some(&font.instance)).build();
        let shaped = shaper.shape(buffer, ShapeOptions::new().features(&self.features));
        self.glyph_count += shaped.len();
        self.limits.glyphs(self.glyph_count)?;

        let scale = self.size / font.units_per_em();
        let infos = shaped.glyph_infos();
        let starts: BTreeSet<usize> = infos.iter().map(|g| g.cluster as usize).collect();
        let mut out: Vec<ShapedCluster> = Vec::new();
        for (info, position) in infos.iter().zip(shaped.glyph_positions()) {
            let start = info.cluster as usize;
            if out.last().is_none_or(|c| c.range.start != start) {
                // A cluster ends at the start of the next one in text order.
                let end = starts.range(start + 1..).next().copied().unwrap_or(range.end);
                out.push(ShapedCluster { range: start..end, advance: 0.0, glyphs: Vec::new(), missing: false });
            }
            let Some(cluster) = out.last_mut() else { continue };
            // Marks without an advance don't get one.
            let thickness = if position.x_advance > 0 { font.synthesis.bold * self.size } else { 0.0 };
            let glyph = PlacedGlyph {
                font: index,
                id: info.glyph_id,
                dx: cluster.advance + f64::from(position.x_offset) * scale,
                dy: -f64::from(position.y_offset) * scale,
                advance: f64::from(position.x_advance) * scale + thickness,
            };
            cluster.advance += glyph.advance;
            cluster.missing |= glyph.id == 0;
            cluster.glyphs.push(glyph);
        }
        Ok(out)
    }
}

/// Returns the fonts for a writing in order of preference: emoji prefer fonts that are only for emoji, other writings those for all.
fn order_of_preference(fonts: &[Font<'_>], writing: Writing) -> Vec<usize> {
    let restricted_to = |only: Option<Writing>| (0..fonts.len()).filter(move |i| fonts[*i].only == only);
    let (general, special) = (restricted_to(None), restricted_to(Some(writing)));
    if writing == Writing::Emoji { special.chain(general).collect() } else { general.chain(special).collect() }
}

/// A part of a line in one font.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FontRun {
    /// Index of the font.
    pub font: usize,
    /// The clusters from left to right: byte range in the line, and advance width in user units.
    pub clusters: Vec<(Range<usize>, f64)>,
    /// `true` if no font has these letters.
    pub missing: bool,
}

/// Shapes a run of a line and divides it by font, from left to right. Letters outside the run have no influence.
///
/// # Errors
/// [`Error::Failed`] when a font is damaged, [`Error::TooLarge`] when the glyphs exceed the default limits, [`Error::NoFont`] when `fonts`
/// has none for the run's writing.
pub fn shape_run(
    line: &str,
    run: &Run,
    fonts: &[Font<'_>],
    size: f64,
    features: &[Feature],
) -> Result<Vec<FontRun>, Error> {
    let limits = TextLimits::default();
    let features = for_whole_text(features);
    let mut shaper = RunShaper { fonts, size, features, language: None, limits: &limits, glyph_count: 0 };
    let start = run.range.start;
    let alone = Run { range: 0..run.range.len(), ..run.clone() };
    let clusters = guarded(|| shaper.run(&line[run.range.clone()], &alone))?;
    let mut out: Vec<FontRun> = Vec::new();
    for c in clusters {
        let font = c.glyphs.first().map_or(0, |g| g.font);
        if out.last().is_none_or(|r| (r.font, r.missing) != (font, c.missing)) {
            out.push(FontRun { font, clusters: Vec::new(), missing: c.missing });
        }
        if let Some(last) = out.last_mut() {
            last.clusters.push((c.range.start + start..c.range.end + start, c.advance));
        }
    }
    Ok(out)
}

/// Converts features for the shaper, applying them to the whole text.
pub(crate) fn for_whole_text(features: &[Feature]) -> Vec<harfrust::Feature> {
    features.iter().map(|f| harfrust::Feature::new(f.tag, f.value, ..)).collect()
}
