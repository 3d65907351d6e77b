//! Detects images that are a line to rounding.

use super::lanes::{Lanes, larger};
use super::limits::{IMAGE_ROUNDING, SAMPLE_ROUNDING, STRAIGHT_SIZE, STRAIGHT_TOLERANCE, STRAIGHT_TURN};
use super::source::BreakPoint;
use kurbo::{Line, Vec2};

/// Returns the line between the ends and the largest distance of the samples from it, if the image is that line to within
/// an invisible distance, runs along it in one direction, and leaves and enters it without a corner.
#[inline(always)]
pub(super) fn straight(
    g: &Lanes,
    from: &BreakPoint,
    to: &BreakPoint,
    size: f64,
    tolerance: f64,
) -> Option<(Line, f64)> {
    let q = to.p - from.p;
    let from_origin = larger(from.p.x.abs() + from.p.y.abs(), to.p.x.abs() + to.p.y.abs());
    let rounding = IMAGE_ROUNDING * from_origin;
    let (by_size, by_tolerance) = (STRAIGHT_SIZE * size, STRAIGHT_TOLERANCE * tolerance);
    let limit = larger(if by_size < by_tolerance { by_size } else { by_tolerance }, SAMPLE_ROUNDING * size) + rounding;
    // One sample rejects nearly all curved pieces.
    if (g.x[2] * q.y - g.y[2] * q.x).abs() > size * limit {
        return None;
    }
    all_on_line(g, from, to, limit, if size <= rounding { rounding } else { 0.0 })
}

/// `point` is the largest extent of a piece that is a single point to rounding; zero for all other pieces.
#[inline(never)]
fn all_on_line(g: &Lanes, from: &BreakPoint, to: &BreakPoint, limit: f64, point: f64) -> Option<(Line, f64)> {
    let (q, line) = (to.p - from.p, Line::new(from.p, to.p));
    if point > 0.0 {
        return g.x.iter().chain(&g.y).all(|v| v.abs() <= point).then_some((line, 0.0));
    }
    let length = q.hypot();
    let (mut last, mut worst) = (0.0, 0.0);
    for i in 0..8 {
        let along = g.x[i] * q.x + g.y[i] * q.y;
        let off = (g.x[i] * q.y - g.y[i] * q.x).abs();
        if along <= last || off > length * limit {
            return None;
        }
        last = along;
        worst = if off > worst { off } else { worst };
    }
    let turns = |t: Vec2| t.cross(q).abs() > STRAIGHT_TURN * length || t.dot(q) <= 0.0;
    (last < q.hypot2() && !turns(from.away) && !turns(to.into)).then(|| (line, worst / length))
}
