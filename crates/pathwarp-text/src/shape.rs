//! Shapes runs with the first font, and the parts that it lacks with the next one.

use crate::error::Error;
use crate::font::Font;
use crate::itemize::{Run, for_shaper};
use crate::lettering::PlacedGlyph;
use crate::limits::TextLimits;
use crate::style::Feature;
use harfrust::{BufferFlags, Direction, Language, ShapeOptions, UnicodeBuffer};
use std::collections::{BTreeSet, HashMap};
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
    pub(crate) set: usize,
}

impl RunShaper<'_, '_> {
    /// Shapes a run. The clusters go from left to right.
    pub(crate) fn run(&mut self, line: &str, run: &Run) -> Result<Vec<ShapedCluster>, Error> {
        self.shape(line, run, run.range.clone(), 0)
    }

    /// Shapes a part of a run with the fonts from `first` on.
    fn shape(&mut self, line: &str, run: &Run, range: Range<usize>, first: usize) -> Result<Vec<ShapedCluster>, Error> {
        let own = self.with_font(line, run, &range, first)?;
        if first + 1 >= self.fonts.len() || !own.iter().any(|c| c.missing) {
            return Ok(own);
        }
        let mut out = Vec::with_capacity(own.len());
        // A damaged font may repeat a cluster; shape each missing part only once.
        let mut sought = BTreeSet::new();
        for group in own.chunk_by(|a, b| a.missing == b.missing) {
            if group.iter().all(|c| !c.missing) {
                out.extend_from_slice(group);
                continue;
            }
            let start = group.iter().map(|c| c.range.start).min().unwrap_or(0);
            let end = group.iter().map(|c| c.range.end).max().unwrap_or(0);
            if sought.insert(start) && start < end {
                out.extend(self.shape(line, run, start..end, first + 1)?);
            }
        }
        Ok(out)
    }

    /// Shapes a part of a run with one font.
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
        if let Some(script) = for_shaper(run.script) {
            buffer.set_script(script);
        }
        if let Some(language) = &self.language {
            buffer.set_language(language.clone());
        }
        let shaper = font.data.shaper(&font.font).instance(Some(&font.instance)).build();
        let shaped = shaper.shape(buffer, ShapeOptions::new().features(&self.features));
        self.set += shaped.len();
        self.limits.glyphs(self.set)?;

        let scale = self.size / font.units_per_em();
        let infos = shaped.glyph_infos();
        // A cluster ends at the start of the next one in text order.
        let starts: BTreeSet<usize> = infos.iter().map(|g| g.cluster as usize).collect();
        let ends: HashMap<usize, usize> =
            starts.iter().copied().zip(starts.iter().skip(1).copied().chain([range.end])).collect();
        let mut out: Vec<ShapedCluster> = Vec::new();
        let mut last = None;
        for (info, place) in infos.iter().zip(shaped.glyph_positions()) {
            if last != Some(info.cluster) {
                last = Some(info.cluster);
                let start = info.cluster as usize;
                let end = ends.get(&start).copied().unwrap_or(range.end);
                out.push(ShapedCluster { range: start..end, advance: 0.0, glyphs: Vec::new(), missing: false });
            }
            let Some(cluster) = out.last_mut() else { continue };
            // Marks without an advance don't get one.
            let thicker = if place.x_advance > 0 { font.synthesis.bold * self.size } else { 0.0 };
            let glyph = PlacedGlyph {
                font: index,
                id: info.glyph_id,
                dx: cluster.advance + f64::from(place.x_offset) * scale,
                dy: -f64::from(place.y_offset) * scale,
                advance: f64::from(place.x_advance) * scale + thicker,
            };
            cluster.advance += glyph.advance;
            cluster.missing |= glyph.id == 0;
            cluster.glyphs.push(glyph);
        }
        Ok(out)
    }
}

/// Converts features for the shaper, applying them to the whole text.
pub(crate) fn for_whole_text(features: &[Feature]) -> Vec<harfrust::Feature> {
    features.iter().map(|f| harfrust::Feature::new(f.tag, f.value, ..)).collect()
}
