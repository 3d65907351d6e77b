//! Draws the glyphs of lines.

use crate::error::Error;
use crate::font::Font;
use crate::lettering::{Cluster, LetteringLine, PlacedGlyph};
use crate::limits::TextLimits;
use crate::shape::ShapedCluster;
use kurbo::{Affine, BezPath, Point};
use skrifa::GlyphId;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// A cluster and the space after it.
pub(crate) struct SpacedCluster {
    pub(crate) cluster: ShapedCluster,
    pub(crate) gap: f64,
}

/// Draws glyphs, and caches their outlines.
pub(crate) struct GlyphPainter<'s, 'f> {
    pub(crate) fonts: &'s [Font<'f>],
    pub(crate) size: f64,
    /// Outlines in font units, by font and glyph.
    pub(crate) outlines: HashMap<(usize, u32), BezPath>,
    pub(crate) limits: &'s TextLimits,
    /// Number of path elements so far.
    pub(crate) element_count: usize,
}

impl GlyphPainter<'_, '_> {
    /// Draws a line from x = 0 with its baseline at `y`.
    pub(crate) fn line(&mut self, text: &str, spaced: Vec<SpacedCluster>, y: f64) -> Result<LetteringLine, Error> {
        let mut x = 0.0;
        let mut clusters = Vec::with_capacity(spaced.len());
        for SpacedCluster { cluster, gap } in spaced {
            let origin = Point::new(x, y);
            let mut outline = BezPath::new();
            for g in &cluster.glyphs {
                self.draw(g, origin, &mut outline)?;
            }
            x += cluster.advance + gap;
            let ShapedCluster { range, advance, glyphs, .. } = cluster;
            clusters.push(Cluster { text: text[range].to_owned(), origin, advance, outline, glyphs });
        }
        let (start, end) = (Point::new(0.0, y), Point::new(x, y));
        Ok(LetteringLine { text: text.to_owned(), start, end, scale: 1.0, clusters })
    }

    /// Appends a glyph to the outline of its cluster, which begins at `origin`.
    fn draw(&mut self, g: &PlacedGlyph, origin: Point, out: &mut BezPath) -> Result<(), Error> {
        let Some(font) = self.fonts.get(g.font) else { return Ok(()) };
        let glyph = match self.outlines.entry((g.font, g.id)) {
            Entry::Occupied(e) => e.into_mut(),
            Entry::Vacant(e) => {
                let outline = font.outlines.draw(GlyphId::new(g.id), font.location())?;
                e.insert(font.synthesis.apply(outline, font.units_per_em()))
            }
        };
        self.element_count += glyph.elements().len();
        self.limits.segments(self.element_count)?;
        let transform =
            Affine::translate((origin.x + g.dx, origin.y + g.dy)) * Affine::scale(self.size / font.units_per_em());
        out.extend(glyph.elements().iter().map(|el| transform * *el));
        Ok(())
    }
}
