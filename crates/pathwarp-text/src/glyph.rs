//! Outlines of glyphs: the exact curves of the font in font units, with y pointing down.

use crate::charstrings::Charstrings;
use crate::error::Error;
use crate::work::MOST_WORK;
use kurbo::{BezPath, Point};
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::pen::PathStyle;
use skrifa::outline::{DrawSettings, OutlineGlyphCollection, OutlineGlyphFormat, OutlinePen};
use skrifa::raw::TableProvider as _;
use skrifa::raw::tables::glyf::{Glyf, Glyph};
use skrifa::raw::tables::loca::Loca;
use skrifa::{FontRef, GlyphId};
use std::collections::HashMap;

/// Maximum number of components of a glyph, including nested ones. The reader limits points and depth, but components without
/// points could occupy it for ever.
const MOST_PARTS: usize = 10_000;

/// The outlines of a font.
pub(crate) struct Outlines<'a> {
    glyphs: OutlineGlyphCollection<'a>,
    composites: Option<(Glyf<'a>, Loca<'a>)>,
    charstrings: Option<Charstrings<'a>>,
}

impl<'a> Outlines<'a> {
    pub(crate) fn new(font: &FontRef<'a>) -> Result<Self, Error> {
        let kinds = [OutlineGlyphFormat::Glyf, OutlineGlyphFormat::Cff2, OutlineGlyphFormat::Cff];
        let Some(glyphs) = kinds.into_iter().find_map(|k| OutlineGlyphCollection::with_format(font, k)) else {
            return Err(Error::NotAFont("it has no outlines (bitmap fonts are not supported)".into()));
        };
        let composites = match glyphs.format() {
            Some(OutlineGlyphFormat::Glyf) => font.glyf().ok().zip(font.loca(None).ok()),
            _ => None,
        };
        let charstrings = composites.is_none().then(|| Charstrings::new(font)).flatten();
        Ok(Self { glyphs, composites, charstrings })
    }

    /// Returns the outline of a glyph; empty for spaces.
    pub(crate) fn draw(&self, glyph: GlyphId, at: LocationRef<'_>) -> Result<BezPath, Error> {
        let damaged = |problem: String| Error::Glyph { glyph: glyph.to_u32(), problem };
        if self.parts(glyph, 0, &mut HashMap::new())? > MOST_PARTS {
            return Err(damaged(format!("it has more than {MOST_PARTS} parts")));
        }
        if self.charstrings.as_ref().is_some_and(|c| c.work(glyph, MOST_WORK) >= MOST_WORK) {
            return Err(damaged(format!("it has {MOST_WORK} bytes or more, with all of its subroutines")));
        }
        let mut pen = GlyphPen::default();
        if let Some(outline) = self.glyphs.get(glyph) {
            // The HarfBuzz style keeps fractions of units in variable fonts; the FreeType style rounds.
            let settings = DrawSettings::unhinted(Size::unscaled(), at).with_path_style(PathStyle::HarfBuzz);
            outline.draw(settings, &mut pen).map_err(|e| damaged(e.to_string()))?;
        }
        if pen.path.iter().any(|el| el.end_point().is_some_and(|p| !p.is_finite())) {
            return Err(damaged("it has points that are not finite".into()));
        }
        Ok(pen.path)
    }

    /// Counts the components of a glyph, including nested ones, with memoized sums. A component without points but with data for
    /// them is an error, since the reader would panic.
    fn parts(&self, glyph: GlyphId, depth: usize, known: &mut HashMap<u32, usize>) -> Result<usize, Error> {
        /// One level more than the reader follows.
        const DEEP: usize = 33;
        if let Some(n) = known.get(&glyph.to_u32()) {
            return Ok(*n);
        }
        let Some((glyf, loca)) = &self.composites else { return Ok(1) };
        // A glyph inside itself counts as too many; the reader rejects it.
        known.insert(glyph.to_u32(), MOST_PARTS + 1);
        let n = match loca.get_glyf(glyph, glyf) {
            Ok(Some(Glyph::Composite(c))) if depth < DEEP => {
                let mut n = 1_usize;
                for part in c.components() {
                    n = n.saturating_add(self.parts(part.glyph.into(), depth + 1, known)?);
                    if n > MOST_PARTS {
                        break;
                    }
                }
                n
            }
            Ok(Some(Glyph::Simple(s))) if s.num_points() == 0 && !s.glyph_data().is_empty() => {
                return Err(Error::Glyph { glyph: glyph.to_u32(), problem: "it has no points".into() });
            }
            _ => 1,
        };
        known.insert(glyph.to_u32(), n);
        Ok(n)
    }
}

/// Collects a path.
#[derive(Default)]
struct GlyphPen {
    path: BezPath,
}

fn point(x: f32, y: f32) -> Point {
    Point::new(f64::from(x), -f64::from(y))
}

impl OutlinePen for GlyphPen {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The last contour ends at point 65535, so the number of points wraps to zero; or there is data but no contour.
    #[test]
    fn glyphs_without_points_are_errors() {
        const HEBREW: &[u8] = include_bytes!("../tests/fonts/hebrew.ttf");
        /// Size of the number of contours and the bounding box, which come first (OpenType 1.9.1, glyf).
        const HEADER: usize = 10;
        let (font, shin) = (FontRef::new(HEBREW).unwrap(), GlyphId::new(10));
        let draw =
            |bytes: &[u8]| Outlines::new(&FontRef::new(bytes).unwrap()).unwrap().draw(shin, LocationRef::default());
        assert!(!draw(HEBREW).unwrap().is_empty());

        let tag = skrifa::Tag::new(b"glyf");
        let table = font.table_directory().table_records().iter().find(|r| r.tag() == tag).unwrap().offset() as usize;
        let start = table + font.loca(None).unwrap().get_raw(10).unwrap() as usize;
        let contours = usize::from(HEBREW[start + 1]);
        for (at, two) in [(HEADER + 2 * (contours - 1), [0xff, 0xff]), (0, [0, 0])] {
            let mut bytes = HEBREW.to_vec();
            bytes[start + at..][..2].copy_from_slice(&two);
            let damaged = draw(&bytes);
            assert!(matches!(damaged, Err(Error::Glyph { glyph: 10, .. })), "{damaged:?}");
        }
    }
}
