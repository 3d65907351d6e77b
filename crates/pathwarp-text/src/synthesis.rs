//! Synthesised styles: thicker stems and slanted letters, for fonts that have neither.
//!
//! Every point of the control polygon moves outwards along the mitre of its two edges, as FreeType's FT_Outline_Embolden does; a
//! slant is a shear about the baseline.

use kurbo::{Affine, BezPath, PathEl, Point, Shape as _, Vec2};

/// A synthesised style.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Synthesis {
    /// Thickness added to stems, as a share of the em.
    pub(crate) bold: f64,
    /// Angle of the slant to the right, degrees.
    pub(crate) slant: f64,
}

impl Synthesis {
    /// Changes the outline of a glyph in font units, with y pointing down.
    pub(crate) fn apply(&self, outline: BezPath, units_per_em: f64) -> BezPath {
        let thick = if self.bold > 0.0 { emboldened(&outline, self.bold * units_per_em) } else { outline };
        if self.slant == 0.0 { thick } else { Affine::skew(-self.slant.to_radians().tan(), 0.0) * thick }
    }
}

/// Thickens stems by `by`: half of it on each side, and to the right by the same, so that the left side bearing stays.
fn emboldened(outline: &BezPath, by: f64) -> BezPath {
    // Of nested contours, the outer one decides the sign.
    let outwards = if outline.area() < 0.0 { 1.0 } else { -1.0 };
    let mut out = BezPath::new();
    let mut contour: Vec<PathEl> = Vec::new();
    for el in outline.elements().iter().copied().chain([PathEl::MoveTo(Point::ORIGIN)]) {
        if matches!(el, PathEl::MoveTo(_)) && !contour.is_empty() {
            out.extend(thickened(&contour, 0.5 * by * outwards));
            contour.clear();
        }
        contour.push(el);
    }
    Affine::translate((0.5 * by, 0.0)) * out
}

/// Moves the points of one contour by `distance` to the right of its direction (y pointing down).
fn thickened(contour: &[PathEl], distance: f64) -> Vec<PathEl> {
    let points: Vec<Point> = contour.iter().flat_map(points_of).collect();
    let moved: Vec<Point> = (0..points.len()).map(|i| points[i] + mitre(&points, i) * distance).collect();
    let mut next = moved.into_iter();
    let mut take = || next.next().unwrap_or_default();
    let rebuilt = contour.iter().map(|el| match el {
        PathEl::MoveTo(_) => PathEl::MoveTo(take()),
        PathEl::LineTo(_) => PathEl::LineTo(take()),
        PathEl::QuadTo(..) => PathEl::QuadTo(take(), take()),
        PathEl::CurveTo(..) => PathEl::CurveTo(take(), take(), take()),
        PathEl::ClosePath => PathEl::ClosePath,
    });
    rebuilt.collect()
}

fn points_of(el: &PathEl) -> Vec<Point> {
    match *el {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => vec![p],
        PathEl::QuadTo(a, p) => vec![a, p],
        PathEl::CurveTo(a, b, p) => vec![a, b, p],
        PathEl::ClosePath => Vec::new(),
    }
}

/// The vector by which a point moves if both edges of the closed polygon at it move by 1 to their right.
fn mitre(points: &[Point], i: usize) -> Vec2 {
    /// 1 + cos of the turn beyond which the mitre is cut: FreeType's limit.
    const SHARPEST: f64 = 1.0 / 16.0;
    let n = points.len();
    // Neighbours that coincide have no direction.
    let towards = |step: usize| {
        let others = (1..n).map(|k| points[(i + k * step) % n] - points[i]);
        others.into_iter().find(|d| d.hypot2() > 0.0).map(|d| d / d.hypot())
    };
    let (Some(after), Some(before)) = (towards(1), towards(n - 1)) else { return Vec2::ZERO };
    let normal = |d: Vec2| Vec2::new(-d.y, d.x);
    let (a, b) = (normal(-before), normal(after));
    let spread = 1.0 + a.dot(b);
    if spread > SHARPEST { (a + b) / spread } else { a }
}

#[cfg(test)]
mod tests {
    use super::*;

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
