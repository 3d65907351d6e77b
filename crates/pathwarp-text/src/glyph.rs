//! Reads the outlines of glyphs, the exact curves of the font in font units with y pointing down, and thickens or slants them.

use crate::charstrings::Charstrings;
use crate::error::Error;
use crate::work::MAX_WORK;
use kurbo::{Affine, BezPath, PathEl, Point, Shape as _, Vec2};
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::pen::PathStyle;
use skrifa::outline::{DrawSettings, OutlineGlyphCollection, OutlineGlyphFormat, OutlinePen};
use skrifa::raw::TableProvider as _;
use skrifa::raw::tables::glyf::{Glyf, Glyph};
use skrifa::raw::tables::loca::Loca;
use skrifa::{FontRef, GlyphId};
use std::collections::HashMap;

/// Maximum number of components of a glyph, including nested ones. The reader limits points and depth, but components without
/// points could occupy it forever.
const MAX_PARTS: usize = 10_000;

/// The outlines of a font.
#[derive(Clone, Default)]
pub(crate) struct Outlines<'a> {
    /// `None` if the font is for shaping only.
    glyphs: Option<OutlineGlyphCollection<'a>>,
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
        Ok(Self { glyphs: Some(glyphs), composites, charstrings })
    }

    /// Returns the outline of a glyph; empty for spaces.
    pub(crate) fn draw(&self, glyph: GlyphId, location: LocationRef<'_>) -> Result<BezPath, Error> {
        let damaged = |problem: String| Error::Glyph { glyph: glyph.to_u32(), problem };
        if self.count_parts(glyph, 0, &mut HashMap::new())? > MAX_PARTS {
            return Err(damaged(format!("it has more than {MAX_PARTS} parts")));
        }
        if self.charstrings.as_ref().is_some_and(|c| c.work(glyph, MAX_WORK) >= MAX_WORK) {
            return Err(damaged(format!("it has {MAX_WORK} bytes or more, with all of its subroutines")));
        }
        let mut pen = GlyphPen::default();
        if let Some(outline) = self.glyphs.as_ref().and_then(|all| all.get(glyph)) {
            // The HarfBuzz style keeps fractions of units in variable fonts; the FreeType style rounds.
            let settings = DrawSettings::unhinted(Size::unscaled(), location).with_path_style(PathStyle::HarfBuzz);
            outline.draw(settings, &mut pen).map_err(|e| damaged(e.to_string()))?;
        }
        if pen.0.iter().any(|el| el.end_point().is_some_and(|p| !p.is_finite())) {
            return Err(damaged("it has points that are not finite".into()));
        }
        Ok(pen.0)
    }

    /// Counts the components of a glyph, including nested ones; `known` keeps the sums. A component without points but with data for
    /// them is an error, since the reader would panic.
    fn count_parts(&self, glyph: GlyphId, depth: usize, known: &mut HashMap<u32, usize>) -> Result<usize, Error> {
        /// One more level than the reader follows.
        const MAX_DEPTH: usize = 33;
        if let Some(n) = known.get(&glyph.to_u32()) {
            return Ok(*n);
        }
        let Some((glyf, loca)) = &self.composites else { return Ok(1) };
        // A glyph that contains itself counts as too many; the reader rejects it.
        known.insert(glyph.to_u32(), MAX_PARTS + 1);
        let n = match loca.get_glyf(glyph, glyf) {
            Ok(Some(Glyph::Composite(c))) if depth < MAX_DEPTH => {
                let mut n = 1_usize;
                for part in c.components() {
                    n = n.saturating_add(self.count_parts(part.glyph.into(), depth + 1, known)?);
                    if n > MAX_PARTS {
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

/// Collects the path that skrifa draws.
#[derive(Default)]
struct GlyphPen(BezPath);

/// Turns y to point down.
fn point(x: f32, y: f32) -> Point {
    Point::new(f64::from(x), -f64::from(y))
}

impl OutlinePen for GlyphPen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to(point(x, y));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to(point(x, y));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.0.quad_to(point(x1, y1), point(x, y));
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.0.curve_to(point(x1, y1), point(x2, y2), point(x, y));
    }

    fn close(&mut self) {
        self.0.close_path();
    }
}

/// A synthesized style.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Synthesis {
    /// Thickness added to stems, as a fraction of the em.
    pub(crate) bold: f64,
    /// Angle of the slant to the right, in degrees.
    pub(crate) slant: f64,
}

impl Synthesis {
    /// Changes the outline of a glyph in font units, with y pointing down.
    pub(crate) fn apply(&self, outline: BezPath, units_per_em: f64) -> BezPath {
        let thick = if self.bold > 0.0 { emboldened(&outline, self.bold * units_per_em) } else { outline };
        if self.slant == 0.0 { thick } else { Affine::skew(-self.slant.to_radians().tan(), 0.0) * thick }
    }
}

/// Thickens stems by `thickness`, half of it on each side, and moves the outline right by that half, so that the left side bearing stays.
fn emboldened(outline: &BezPath, thickness: f64) -> BezPath {
    // An outer contour has a larger area than its holes, so it decides the sign. With y down, a negative area has its outside on the right.
    let outwards = if outline.area() < 0.0 { 1.0 } else { -1.0 };
    let mut out = BezPath::new();
    let mut contour: Vec<PathEl> = Vec::new();
    for el in outline.elements().iter().copied().chain([PathEl::MoveTo(Point::ORIGIN)]) {
        if matches!(el, PathEl::MoveTo(_)) && !contour.is_empty() {
            out.extend(moved_right(&contour, 0.5 * thickness * outwards));
            contour.clear();
        }
        contour.push(el);
    }
    Affine::translate((0.5 * thickness, 0.0)) * out
}

/// Moves a contour by about `distance` to the right of its direction (y pointing down): every control point by the mitre of the control
/// polygon.
fn moved_right(contour: &[PathEl], distance: f64) -> Vec<PathEl> {
    let points: Vec<Point> = contour.iter().flat_map(control_points).collect();
    let mut moved = (0..points.len()).map(|i| points[i] + mitre(&points, i) * distance);
    let mut next = || moved.next().unwrap_or_default();
    let rebuilt = contour.iter().map(|el| match el {
        PathEl::MoveTo(_) => PathEl::MoveTo(next()),
        PathEl::LineTo(_) => PathEl::LineTo(next()),
        PathEl::QuadTo(..) => PathEl::QuadTo(next(), next()),
        PathEl::CurveTo(..) => PathEl::CurveTo(next(), next(), next()),
        PathEl::ClosePath => PathEl::ClosePath,
    });
    rebuilt.collect()
}

fn control_points(el: &PathEl) -> Vec<Point> {
    match *el {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => vec![p],
        PathEl::QuadTo(a, p) => vec![a, p],
        PathEl::CurveTo(a, b, p) => vec![a, b, p],
        PathEl::ClosePath => Vec::new(),
    }
}

/// Returns the vector by which point `i` of a closed polygon moves if both of its edges move by 1 to their right. Where the turn is too
/// sharp for a mitre, it is the normal of the edge before.
fn mitre(points: &[Point], i: usize) -> Vec2 {
    /// 1 + cos of the turn beyond which the mitre is cut, as in FreeType.
    const MIN_SPREAD: f64 = 1.0 / 16.0;
    let n = points.len();
    // Skips neighbours that coincide with the point. A step of n - 1 goes back by 1.
    let towards = |step: usize| {
        let mut others = (1..n).map(|k| points[(i + k * step) % n] - points[i]);
        others.find(|d| d.hypot2() > 0.0).map(Vec2::normalize)
    };
    let (Some(after), Some(before)) = (towards(1), towards(n - 1)) else { return Vec2::ZERO };
    let normal = |d: Vec2| Vec2::new(-d.y, d.x);
    let (a, b) = (normal(-before), normal(after));
    let spread = 1.0 + a.dot(b);
    if spread > MIN_SPREAD { (a + b) / spread } else { a }
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

    /// A square with a square hole, both ways round: the outer side grows, the hole shrinks.
    #[test]
    fn stems_grow_on_both_sides() {
        let ring = BezPath::from_svg("M0,0 H100 V100 H0 Z M30,30 V70 H70 V30 Z").unwrap();
        for outline in [ring.clone(), ring.reverse_subpaths()] {
            let thick = emboldened(&outline, 10.0);
            assert_eq!(thick.bounding_box(), kurbo::Rect::new(0.0, -5.0, 110.0, 105.0));
            assert!((thick.area().abs() - (110.0_f64.powi(2) - 30.0_f64.powi(2))).abs() < 1e-9, "{thick:?}");
        }
    }

    /// A disc of arcs grows by its circumference (Steiner): exact for true arcs, nearly for cubics.
    #[test]
    fn curves_move_evenly() {
        let disc = kurbo::Circle::new((0.0, 0.0), 50.0).to_path(1e-3);
        let area = emboldened(&disc, 4.0).area().abs();
        assert!((area / (std::f64::consts::PI * 52.0 * 52.0) - 1.0).abs() < 2e-3, "{area}");
    }

    #[test]
    fn a_slant_keeps_the_baseline() {
        let bar = BezPath::from_svg("M0,0 H10 V-100 H0 Z").unwrap();
        let italic = Synthesis { slant: 14.0, bold: 0.0 }.apply(bar, 1000.0).bounding_box();
        assert!((italic.x1 - 10.0 - 100.0 * 14.0_f64.to_radians().tan()).abs() < 1e-9 && italic.x0 == 0.0);
    }
}
