//! The distance between the exact image of a path and what was written, and the joints that turn where the image does not.

use crate::curves::Curve;
use kurbo::{Point, Vec2};

/// Maps points, many at a time.
pub type Image<'a> = &'a dyn Fn(&[Point]) -> Vec<Point>;

/// A sampled subpath: the place in the source of each sample, and the sample.
pub struct Sampled {
    pub at: Vec<(usize, f64)>,
    pub points: Vec<Point>,
}

/// Samples a subpath's image, `n` times each curve, and more where a chord may be farther from it than a tenth of the tolerance.
pub fn sampled(run: &[Curve], image: Image<'_>, n: usize, tolerance: f64) -> Sampled {
    const MOST: usize = 40_000;
    let mut at: Vec<(usize, f64)> =
        (0..run.len()).flat_map(|i| (0..=n).map(move |k| (i, k as f64 / n as f64))).collect();
    let mut points = image(&at.iter().map(|(i, t)| run[*i].at(*t)).collect::<Vec<_>>());
    for _ in 0..40 {
        let step = |k: usize| points[k + 1] - points[k];
        let steps: Vec<Vec2> = (0..points.len() - 1).map(step).collect();
        let wide = |k: usize| {
            // The height of an arc over its chord is an eighth of the chord times the turn.
            let bulges = |other: &Vec2| {
                let turn = steps[k].cross(*other).atan2(steps[k].dot(*other)).abs();
                steps[k].hypot() * turn > 0.8 * tolerance
            };
            let same = at[k].0 == at[k + 1].0 && at[k + 1].1 - at[k].1 > 1e-13;
            same && ((k > 0 && bulges(&steps[k - 1])) || steps.get(k + 1).is_some_and(bulges))
        };
        let halved: Vec<usize> = (0..steps.len()).filter(|k| wide(*k)).collect();
        if halved.is_empty() || at.len() > MOST {
            break;
        }
        let new: Vec<(usize, f64)> = halved.iter().map(|&k| (at[k].0, 0.5 * (at[k].1 + at[k + 1].1))).collect();
        let images = image(&new.iter().map(|(i, t)| run[*i].at(*t)).collect::<Vec<_>>());
        let mut merged = (Vec::with_capacity(at.len() + new.len()), Vec::with_capacity(at.len() + new.len()));
        let mut next = 0;
        for k in 0..at.len() {
            merged.0.push(at[k]);
            merged.1.push(points[k]);
            if halved.get(next) == Some(&k) {
                merged.0.push(new[next]);
                merged.1.push(images[next]);
                next += 1;
            }
        }
        (at, points) = merged;
    }
    Sampled { at, points }
}

fn to_chord(p: Point, a: Point, b: Point) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.hypot2()).clamp(0.0, 1.0);
    if t.is_nan() { p.distance(a) } else { p.distance(a + along * t) }
}

/// The largest distance of the points of `from` from the curves `to`. Both run alike, so that the search goes on where the last point
/// was found, and goes far only where it is not within `good` of a chord. `on` gives the points of the curves.
pub fn far(from: &[Sampled], to: &[Sampled], on: &dyn Fn(usize, (usize, f64)) -> Point, good: f64) -> (f64, Point) {
    let chords: Vec<(usize, usize)> =
        to.iter().enumerate().flat_map(|(s, run)| (0..run.points.len() - 1).map(move |k| (s, k))).collect();
    let (n, mut worst, mut hint) = (chords.len(), (0.0, Point::ORIGIN), 0);
    let chord = |p: Point, (s, k): (usize, usize)| to_chord(p, to[s].points[k], to[s].points[k + 1]);
    for p in from.iter().flat_map(|s| &s.points) {
        let (mut best, h) = (f64::INFINITY, hint);
        for away in 0..=n / 2 {
            for k in [(h + away) % n, (h + n - away) % n] {
                let d = chord(*p, chords[k]);
                if d < best {
                    (best, hint) = (d, k);
                }
            }
            if best <= good && away >= 4 {
                break;
            }
        }
        if best > good {
            // Beside a chord, the curve itself: over this chord and its neighbours.
            for &(s, k) in &chords[hint.saturating_sub(1)..=(hint + 1).min(n - 1)] {
                let (a, b) = (to[s].at[k], to[s].at[k + 1]);
                if a.0 == b.0 {
                    best = best.min(beside(*p, &|t| on(s, (a.0, t)), a.1, b.1));
                }
            }
        }
        if best > worst.0 || best.is_nan() {
            worst = (best, *p);
        }
    }
    worst
}

/// The distance of a point from a short curve.
fn beside(p: Point, on: &dyn Fn(f64) -> Point, mut a: f64, mut b: f64) -> f64 {
    const GOLDEN: f64 = 0.381_966_011_250_105;
    for _ in 0..36 {
        let (l, r) = (a + GOLDEN * (b - a), b - GOLDEN * (b - a));
        if on(l).distance(p) < on(r).distance(p) { b = r } else { a = l }
    }
    on(0.5 * (a + b)).distance(p)
}

/// The sharpest turn, in degrees, at a joint of what was written where the exact image is smooth.
pub fn kink(
    source: &[Curve],
    exact: &Sampled,
    image: Image<'_>,
    written: &[Curve],
    (closed, room): (bool, f64),
) -> (f64, Point) {
    /// Share of a curve over which directions are taken.
    const STEP: f64 = 1e-4;
    // What is too short to be seen has no direction.
    let written: Vec<&Curve> = written.iter().filter(|c| c.at(0.0).distance(c.at(0.5)) > 1e-3 * room).collect();
    let (n, m) = (written.len(), source.len());
    let places = image(&source.iter().flat_map(|c| [0.0, 0.3, 0.5].map(|t| c.at(t))).collect::<Vec<_>>());
    let short: Vec<bool> =
        places.chunks(3).map(|p| p[0].distance(p[1]).max(p[0].distance(p[2])) <= 1e-3 * room).collect();
    // The next curve with a length, `by` curves on each time.
    let beyond =
        |from: usize, by: usize| (1..=m).map(|k| (from + k * by) % m).find(|i| closed && !short[*i]).unwrap_or(from);
    let mut worst = (0.0, Point::ORIGIN);
    for i in (if closed { 0 } else { 1 })..n {
        let (a, b) = (written[(i + n - 1) % n], written[i]);
        let (into, away) = (a.directions()[1], b.directions()[0]);
        let turn = into.cross(away).atan2(into.dot(away));
        let p = b.at(0.0);
        if turn.abs().to_degrees() <= 0.5 {
            continue;
        }
        // The places of the source that come near the joint: where the path meets itself, several.
        let reach = room + exact.points.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min);
        let near = (0..exact.points.len()).filter(|k| exact.points[*k].distance(p) <= reach).map(|k| exact.at[k]);
        let near = near.filter(|(at, _)| !short[*at]);
        let mut corner = 0.0_f64;
        for (at, t) in near {
            // The image just before and after, across a joint of the source.
            let (before, after) = match t {
                0.0 => ((beyond(at, m - 1), 1.0), (at, 0.0)),
                1.0 => ((at, 1.0), (beyond(at, 1), 0.0)),
                t => ((at, t), (at, t)),
            };
            // Far enough on both sides for a crease near the sample.
            let ahead = if t < 0.5 { STEP } else { -STEP };
            let pair = image(&[source[at].at(t), source[at].at(t + ahead)]);
            let beside = (reach * STEP / pair[0].distance(pair[1])).clamp(2.0 * STEP, 0.05);
            let q = image(&[
                source[before.0].at(before.1 - beside - STEP),
                source[before.0].at(before.1 - beside),
                source[after.0].at(after.1 + beside),
                source[after.0].at(after.1 + beside + STEP),
            ]);
            let (u, v) = (q[1] - q[0], q[3] - q[2]);
            // At a tear the image leaves for the other side, whatever the directions.
            let torn = q[1].distance(q[2]) > 10.0 * (2.0 * beside / STEP) * u.hypot().max(v.hypot());
            let turned = if torn || u == Vec2::ZERO || v == Vec2::ZERO {
                std::f64::consts::PI
            } else {
                u.cross(v).atan2(u.dot(v)).abs()
            };
            corner = corner.max(turned);
        }
        // Beside the joint, a curve turns as well.
        let off = turn.abs() - 2.0 * corner;
        if corner.to_degrees() < 0.25 && off > worst.0 {
            worst = (off, p);
        }
    }
    (worst.0.to_degrees(), worst.1)
}
