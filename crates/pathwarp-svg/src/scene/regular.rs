//! Degenerate segments in a form that can be offset. Where the derivative of a cubic vanishes at an end, its curvature has no
//! bound, and kurbo's offset is not finite.

use pathwarp::kurbo::{CubicBez, Line, ParamCurve as _, Point, Shape as _};
use pathwarp::{Outline, Seg, Subpath};

/// Longest piece at a degenerate end that is replaced by a line, in the curve's parameter.
const LONGEST: f64 = 0.05;

/// Returns `true` if the whole segment is the point `at`.
pub(crate) fn is_point(s: &Seg, at: Point) -> bool {
    let c = s.to_cubic();
    [c.p0, c.p1, c.p2, c.p3].iter().all(|p| *p == at)
}

/// Share of the tolerance below which a segment has no shape.
const TINY: f64 = 1e-3;

/// Returns `true` if all of a segment is nearer to its start than this.
fn is_tiny(s: &Seg, near: f64) -> bool {
    let c = s.to_cubic();
    [c.p1, c.p2, c.p3].iter().all(|p| p.distance(c.p0) < near)
}

/// The same outline, within `tolerance`, without segments of zero length and without derivatives that vanish at an end.
pub(super) fn regular(s: &Subpath, tolerance: f64) -> Subpath {
    let mut segs = Vec::with_capacity(s.segs.len());
    for g in s.segs.iter().filter(|g| !is_point(g, g.start())) {
        match g {
            _ if is_tiny(g, TINY * tolerance) => {
                segs.extend((g.start() != g.end()).then(|| Seg::Line(Line::new(g.start(), g.end()))));
            }
            Seg::Quad(q) if q.p1 == q.p0 || q.p1 == q.p2 => segs.push(Seg::Line(Line::new(q.p0, q.p2))),
            Seg::Cubic(c) => split(*c, tolerance, &mut segs),
            Seg::Line(_) | Seg::Quad(_) | Seg::Arc(_) => segs.push(*g),
        }
    }
    Subpath { segs, ..s.clone() }
}

/// Replaces the degenerate ends of a cubic by lines.
fn split(c: CubicBez, tolerance: f64, out: &mut Vec<Seg>) {
    let (first, last) = (c.p1 == c.p0, c.p2 == c.p3);
    if first && (last || c.p2 == c.p0) || last && c.p1 == c.p3 {
        out.push(Seg::Line(Line::new(c.p0, c.p3)));
        return;
    }
    let head = if first { cut(c, tolerance) } else { 0.0 };
    let tail = if last { cut(CubicBez::new(c.p3, c.p2, c.p1, c.p0), tolerance) } else { 0.0 };
    let middle = c.subsegment(head..1.0 - tail);
    if first {
        out.push(Seg::Line(Line::new(c.p0, middle.p0)));
    }
    out.push(Seg::Cubic(middle));
    if last {
        out.push(Seg::Line(Line::new(middle.p3, c.p3)));
    }
}

/// Length, in the parameter, of the piece at the degenerate start of a cubic that a line replaces. With a = p2 - p0 and
/// b = p3 - p0, the curve is p0 + 3t²(1-t)a + t³b, so the piece [0, t] differs from its chord by less than t³(3|a| + |b|), and its
/// direction from the chord's by about t|b|/|a|.
fn cut(c: CubicBez, tolerance: f64) -> f64 {
    let (a, b) = ((c.p2 - c.p0).hypot(), (c.p3 - c.p0).hypot());
    let size = 3.0 * a + b;
    LONGEST.min(LONGEST * a / size).min((0.25 * tolerance / size).cbrt())
}

/// An outline as a polygon, which can always be offset.
pub(super) fn polygon(s: &Subpath, tolerance: f64) -> Outline {
    let mut path = pathwarp::kurbo::BezPath::new();
    let one = Outline { subpaths: vec![s.clone()] }.to_bez_path(tolerance);
    pathwarp::kurbo::flatten(one.path_elements(tolerance), tolerance, |e| path.push(e));
    (&path).into()
}

#[cfg(test)]
mod tests {
    use crate::scene::expand::stroke_outline;
    use pathwarp::kurbo::{ParamCurveNearest as _, Point, Shape as _};
    use pathwarp::{Outline, Seg};
    use usvg::{Node, Options, Tree};

    /// Paths with every kind of degenerate segment, at the start, inside, at the end, and before `Z`.
    const DEGENERATE: [&str; 22] = [
        "M20 20C20 20 60 80 80 20",
        "M20 20C40 80 80 20 80 20",
        "M20 20C20 20 80 70 80 70",
        "M20 20C20 20 20 20 80 60",
        "M20 20C80 60 80 60 80 60",
        "M20 20L20 20C30 40 60 80 80 20",
        "M20 20C20 20 20 20 20 20L80 60",
        "M20 20L20 20L80 20L50 70Z",
        "M20 20C20 20 20 20 20 20C30 50 60 60 80 20Z",
        "M20 20L50 50C50 50 50 50 50 50L80 20",
        "M20 20L50 50L80 20C80 20 80 20 80 20",
        "M20 20Q20 20 80 60",
        "M20 20Q80 60 80 60",
        "M20 20Q20 20 20 20L80 60",
        "M20 20C90 20 -20 20 80 20",
        "M20 70C90 10 10 10 80 70",
        "M50 20C90 90 90 90 50 20",
        "M20 50A30 0 0 0 1 80 50",
        "M20 20L20.0000001 20L80 60",
        "M20 20C20.0000001 20 79.99999999 60 80 60",
        "M81.87 28.24C77.17 29.34 77.57 30.04 77.57 30.04C77.87 30.54 79.17 29.84 79.17 29.84C82.87 28.64 81.87 28.24 81.87 28.24Z",
        "M50 20C3 31 7 38 7 38C10 43 23 36 23 36C60 24 50 20 50 20Z",
    ];

    fn stroke(style: &str) -> usvg::Stroke {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'><path d='M0 0H9' stroke='red' {style}/></svg>"
        );
        let tree = Tree::from_str(&svg, &Options::default()).unwrap();
        let Some(Node::Path(p)) = tree.root().children().first() else { panic!("{svg}") };
        p.stroke().unwrap().clone()
    }

    /// A stroke with round caps and joins covers the points within half its width of the curve.
    #[test]
    fn degenerate_segments_have_strokes() {
        for d in DEGENERATE {
            let path = Outline::from_svg_lossy(d);
            // Wider ones leave holes in small loops, as in all renderers.
            for width in [0.2, 4.0] {
                let round = format!("stroke-width='{width}' stroke-linecap='round' stroke-linejoin='round'");
                let covered = stroke_outline(&path, &stroke(&round), 1e-3).to_bez_path(1e-4);
                let segs: Vec<_> = path.segs().map(Seg::to_cubic).collect();
                for i in 0..60 * 60 {
                    let p = Point::new(f64::from(i % 60) * 1.7, f64::from(i / 60) * 1.7);
                    let off = segs.iter().map(|s| s.nearest(p, 1e-6).distance_sq.sqrt()).fold(f64::INFINITY, f64::min);
                    if (off - 0.5 * width).abs() > 0.02 {
                        assert_eq!(covered.winding(p) != 0, off < 0.5 * width, "{d}, {width} wide, at {p:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn degenerate_segments_have_finite_strokes() {
        for d in DEGENERATE {
            for cap in ["butt", "round", "square"] {
                for join in ["miter", "round", "bevel"] {
                    for (width, dashes) in [(0.2, "none"), (8.0, "none"), (8.0, "5 4"), (0.2, "0 .3"), (30.0, "1 9 4")]
                    {
                        let style = format!(
                            "stroke-width='{width}' stroke-linecap='{cap}' stroke-linejoin='{join}' stroke-dasharray='{dashes}'"
                        );
                        let out = stroke_outline(&Outline::from_svg_lossy(d), &stroke(&style), 1e-3);
                        let reach = out.bounding_box().unwrap();
                        assert!(reach.is_finite() && reach.width() < 300.0, "{d}, {style}: {reach:?}");
                        assert!(out.to_bez_path(1e-3).is_finite(), "{d}, {style}");
                    }
                }
            }
        }
    }
}
