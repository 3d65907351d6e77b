//! Outlines of glyphs: the font's own curves, y pointing down, in its units.

use crate::Error;
use kurbo::{BezPath, Point};
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::pen::PathStyle;
use skrifa::outline::{DrawSettings, OutlineGlyphCollection, OutlineGlyphFormat, OutlinePen};
use skrifa::raw::TableProvider as _;
use skrifa::raw::tables::glyf::{Glyf, Glyph};
use skrifa::raw::tables::loca::Loca;
use skrifa::{FontRef, GlyphId};
use std::collections::HashMap;

/// A glyph made of more parts than this, counting parts of parts, is none. The reader bounds points and depth, but parts
/// without points would keep it busy for ever.
const MOST_PARTS: usize = 10_000;

/// The outlines of a font.
pub(crate) struct Outlines<'a> {
    glyphs: OutlineGlyphCollection<'a>,
    composites: Option<(Glyf<'a>, Loca<'a>)>,
}

impl<'a> Outlines<'a> {
    pub(crate) fn new(font: &FontRef<'a>) -> Result<Self, Error> {
        let kinds = [OutlineGlyphFormat::Glyf, OutlineGlyphFormat::Cff2, OutlineGlyphFormat::Cff];
        let Some(glyphs) = kinds.into_iter().find_map(|k| OutlineGlyphCollection::with_format(font, k)) else {
            return Err(Error::NotAFont("it has no outlines (bitmap fonts are not set)".into()));
        };
        let composites = match glyphs.format() {
            Some(OutlineGlyphFormat::Glyf) => font.glyf().ok().zip(font.loca(None).ok()),
            _ => None,
        };
        Ok(Self { glyphs, composites })
    }

    /// The outline of a glyph; empty for spaces.
    pub(crate) fn draw(&self, glyph: GlyphId, at: LocationRef<'_>) -> Result<BezPath, Error> {
        let damaged = |problem: String| Error::Glyph { glyph: glyph.to_u32(), problem };
        if self.parts(glyph, 0, &mut HashMap::new()) > MOST_PARTS {
            return Err(damaged(format!("it has more than {MOST_PARTS} parts")));
        }
        let mut pen = Pen::default();
        if let Some(outline) = self.glyphs.get(glyph) {
            // HarfBuzz's way keeps fractions of units in variable fonts, where FreeType's rounds.
            let settings = DrawSettings::unhinted(Size::unscaled(), at).with_path_style(PathStyle::HarfBuzz);
            outline.draw(settings, &mut pen).map_err(|e| damaged(e.to_string()))?;
        }
        if pen.path.iter().any(|el| el.end_point().is_some_and(|p| !p.is_finite())) {
            return Err(damaged("it has points that are not finite".into()));
        }
        Ok(pen.path)
    }

    /// How many parts drawing a glyph takes, all the way down; each glyph is counted once and its sum remembered.
    fn parts(&self, glyph: GlyphId, depth: usize, known: &mut HashMap<u32, usize>) -> usize {
        /// One more than the reader follows.
        const DEEP: usize = 33;
        if let Some(n) = known.get(&glyph.to_u32()) {
            return *n;
        }
        let Some((glyf, loca)) = &self.composites else { return 1 };
        // Met again inside itself: the reader refuses that.
        known.insert(glyph.to_u32(), MOST_PARTS + 1);
        let n = match loca.get_glyf(glyph, glyf) {
            Ok(Some(Glyph::Composite(c))) if depth < DEEP => {
                let mut n = 1_usize;
                for part in c.components() {
                    n = n.saturating_add(self.parts(part.glyph.into(), depth + 1, known));
                    if n > MOST_PARTS {
                        break;
                    }
                }
                n
            }
            _ => 1,
        };
        known.insert(glyph.to_u32(), n);
        n
    }
}

#[derive(Default)]
struct Pen {
    path: BezPath,
}

fn point(x: f32, y: f32) -> Point {
    Point::new(f64::from(x), -f64::from(y))
}

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.move_to(point(x, y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.path.line_to(point(x, y));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.path.quad_to(point(x1, y1), point(x, y));
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.path.curve_to(point(x1, y1), point(x2, y2), point(x, y));
    }

    fn close(&mut self) {
        self.path.close_path();
    }
}
