//! Turns of curves at their joints.

use crate::curves::Curve;
use crate::distance::Sampled;
use kurbo::{CubicBez, Point, Vec2};
use std::f64::consts::PI;

/// The sharpest turn between consecutive cubics, in degrees.
pub fn largest_turn(out: &[CubicBez]) -> f64 {
    out.windows(2).map(|w| turn(arriving(&w[0]), leaving(&w[1]))).fold(0.0, f64::max)
}

/// The angle between two directions, in degrees.
pub fn turn(a: Vec2, b: Vec2) -> f64 {
    a.cross(b).atan2(a.dot(b)).abs().to_degrees()
}

/// The direction in which a cubic starts.
pub fn leaving(c: &CubicBez) -> Vec2 {
    [c.p1, c.p2, c.p3].iter().map(|p| *p - c.p0).find(|v| v.hypot() > 1e-9).unwrap_or_default()
}

/// The direction in which a cubic ends.
pub fn arriving(c: &CubicBez) -> Vec2 {
    [c.p2, c.p1, c.p0].iter().map(|p| c.p3 - *p).find(|v| v.hypot() > 1e-9).unwrap_or_default()
}

/// The sharpest turn, in degrees, at a joint of a result where the exact image is smooth, and its position. The result may be
/// `room` away from the image.
pub fn kink(exact: &Sampled<'_>, written: &[Curve], (closed, room): (bool, f64)) -> (f64, Point) {
    /// Share of a curve over which directions are taken.
    const STEP: f64 = 1e-4;
    // Curves that are too short to be seen have no direction.
    let written: Vec<&Curve> = written.iter().filter(|c| c.at(0.0).distance(c.at(0.5)) > 1e-3 * room).collect();
    let (n, m) = (written.len(), exact.run.pieces());
    let is_short = |i: usize| {
        let [a, b, c] = [0.0, 0.3, 0.5].map(|t| exact.run.at((i, t)));
        a.distance(b).max(a.distance(c)) <= 1e-3 * room
    };
    let short: Vec<bool> = (0..m).map(is_short).collect();
    // The next curve with a length, `by` curves on each time.
    let beyond =
        |from: usize, by: usize| (1..=m).map(|k| (from + k * by) % m).find(|i| closed && !short[*i]).unwrap_or(from);
    let mut worst = (0.0, Point::ORIGIN);
    for i in usize::from(!closed)..n {
        let (a, b) = (written[(i + n - 1) % n], written[i]);
        let (into, away) = (a.directions()[1], b.directions()[0]);
        let turn = into.cross(away).atan2(into.dot(away));
        let p = b.at(0.0);
        if turn.abs().to_degrees() <= 0.5 {
            continue;
        }
        // The samples of the exact image near the joint. There may be several parts if the path meets itself.
        let radius = room + exact.points.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min);
        let is_near = |k: &usize| exact.points[*k].distance(p) <= radius && !short[exact.positions[*k].0];
        let mut corner = 0.0_f64;
        for (at, t) in (0..exact.points.len()).filter(is_near).map(|k| exact.positions[k]) {
            // The image just before and after, across a joint of the source.
            let (before, after) = match t {
                0.0 => ((beyond(at, m - 1), 1.0), (at, 0.0)),
                1.0 => ((at, 1.0), (beyond(at, 1), 0.0)),
                t => ((at, t), (at, t)),
            };
            // Far enough on both sides for a crease near the sample.
            let step = if t < 0.5 { STEP } else { -STEP };
            let pair = [t, t + step].map(|t| exact.run.at((at, t)));
            let gap = (radius * STEP / pair[0].distance(pair[1])).clamp(2.0 * STEP, 0.05);
            let [a, b] = [gap + STEP, gap].map(|d| exact.run.at((before.0, before.1 - d)));
            let [c, d] = [gap, gap + STEP].map(|d| exact.run.at((after.0, after.1 + d)));
            let (u, v) = (b - a, d - c);
            // At a tear the image jumps, whatever the directions.
            let is_torn = b.distance(c) > 10.0 * (2.0 * gap / STEP) * u.hypot().max(v.hypot());
            let has_no_direction = is_torn || u == Vec2::ZERO || v == Vec2::ZERO;
            corner = corner.max(if has_no_direction { PI } else { u.cross(v).atan2(u.dot(v)).abs() });
        }
        // Beside the joint, a curve turns as well.
        let excess = turn.abs() - 2.0 * corner;
        if corner.to_degrees() < 0.25 && excess > worst.0 {
            worst = (excess, p);
        }
    }
    (worst.0.to_degrees(), worst.1)
}
