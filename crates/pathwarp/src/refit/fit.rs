//! Fits the image of one smooth part of a segment: Hermite cubics, halved until dense samples lie within the tolerance.

use super::{Assurance, PathReport, Piece};
use crate::map::Map;
use crate::outline::Seg;
use kurbo::{CubicBez, Line, ParamCurve, Point, Vec2};

/// Halvings of one segment at most.
const MAX_DEPTH: u32 = 16;
/// Samples a piece is checked at.
const CHECKS: usize = 16;

/// Appends the image of `seg` over [`from`, `to`]. `Err` holds the source place where the map is not finite.
pub(super) fn fit(
    seg: &Seg,
    from: f64,
    to: f64,
    map: &dyn Map,
    tolerance: f64,
    out: &mut Vec<Piece>,
    report: &mut PathReport,
) -> Result<(), Point> {
    let mut stack = vec![(from, to, 0)];
    while let Some((a, b, depth)) = stack.pop() {
        let end = |t: f64| {
            let p = seg.eval(t);
            let j = map.jet(p);
            if j.is_finite() { Ok((j.p, j.push(seg.deriv(t)))) } else { Err(p) }
        };
        let ((p0, d0), (p1, d1)) = (end(a)?, end(b)?);
        let k = (b - a) / 3.0;
        let cubic = CubicBez::new(p0, p0 + d0 * k, p1 - d1 * k, p1);
        let mut source = [Point::ORIGIN; CHECKS];
        let mut image = [Point::ORIGIN; CHECKS];
        for (i, p) in source.iter_mut().enumerate() {
            *p = seg.eval(a + (b - a) * (i as f64 + 0.5) / CHECKS as f64);
        }
        map.points(&source, &mut image);
        if let Some(i) = image.iter().position(|p| !p.is_finite()) {
            return Err(source[i]);
        }
        let line = p1 - p0;
        let off_line = |q: &Point| {
            let n = line.hypot();
            if n == 0.0 { q.distance(p0) } else { ((*q - p0).cross(line) / n).abs() }
        };
        /// Straight to rounding.
        const STRAIGHT: f64 = 1e-12;
        let straight = image.iter().map(off_line).fold(0.0, f64::max);
        let monotone = image.windows(2).all(|w| (w[1] - w[0]).dot(line) >= 0.0);
        if straight <= STRAIGHT * line.hypot() && monotone {
            out.push(Piece::Line(Line::new(p0, p1)));
            continue;
        }
        let error = image
            .iter()
            .enumerate()
            .map(|(i, q)| foot_distance(&cubic, (i as f64 + 0.5) / CHECKS as f64, *q))
            .fold(0.0, f64::max);
        if error <= tolerance * 0.8 || depth == MAX_DEPTH {
            if error > tolerance {
                report.over_budget.push(seg.eval(0.5 * (a + b)));
            }
            report.max_error = report.max_error.max(error);
            report.assurance = report.assurance.min(Assurance::Checked);
            out.push(Piece::Cubic(cubic));
        } else {
            let m = 0.5 * (a + b);
            stack.push((m, b, depth + 1));
            stack.push((a, m, depth + 1));
        }
    }
    Ok(())
}

/// Distance from `q` to the curve near `t`, by two Newton steps for the foot.
fn foot_distance(c: &CubicBez, t: f64, q: Point) -> f64 {
    use kurbo::ParamCurveDeriv;
    let d = c.deriv();
    let mut s = t;
    let mut best = c.eval(t).distance(q);
    for _ in 0..2 {
        let (r, v): (Vec2, Vec2) = (c.eval(s) - q, d.eval(s).to_vec2());
        let n = v.hypot2();
        if n == 0.0 {
            break;
        }
        s = (s - r.dot(v) / n).clamp(0.0, 1.0);
        best = best.min(c.eval(s).distance(q));
    }
    best
}
