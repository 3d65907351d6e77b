//! Finds undeclared kinks and jumps along lines across the box of a map, and describes the creases to declare.

use super::{Tested, coordinates, number};
use kurbo::{Point, Vec2};

/// The number of lines across the box in either direction.
const LINES: u32 = 16;
/// The number of intervals between the samples of a line.
const INTERVALS: u32 = 192;
/// The largest number of intervals of a line that are examined.
const MAX_PEAKS: usize = 24;
/// The number of halvings of such an interval.
const HALVINGS: usize = 20;
/// The number of halvings after which changes of slope are compared: in a smooth map they have fallen to 1/128, at a kink they are the
/// same, and at a jump they have grown to 128 times.
const COMPARED: usize = 7;
/// The least change of slope that counts, as a fraction of the slope or of 1.
const LEAST: f64 = 1e-4;

/// An interval of a line in which there may be a kink or jump.
#[derive(Clone, Copy)]
struct Interval {
    center: Point,
    /// Half of the interval, along the line.
    half: Vec2,
    /// The changes of slope in the interval, from the first halving on.
    changes: [f64; HALVINGS],
}

/// A point where a map is not smooth.
#[derive(Clone, Copy)]
struct Break {
    at: Point,
    /// The change of slope, or for a jump the distance.
    by: f64,
    is_jump: bool,
}

/// Describes every curve on which the map has a kink or jump that it does not declare, each with the point where it is worst.
pub(super) fn undeclared(tested: &Tested<'_>) -> Vec<(String, Point)> {
    let mut left = refine(tested, candidates(tested));
    let size = tested.frame.size().to_vec2().hypot();
    let mut faults = Vec::new();
    while !left.is_empty() {
        let points: Vec<Point> = left.iter().map(|b| b.at).collect();
        let curve = curve_through_most(&points, 2e-7 * size);
        // The other points lie on other curves, or on none.
        let (on, others): (Vec<Break>, Vec<Break>) =
            left.into_iter().partition(|b| curve.is_none_or(|c| c.distance(b.at) < 1e-5 * size));
        left = others;
        let Some(worst) = on.iter().copied().reduce(|a, b| if b.by > a.by { b } else { a }) else { break };
        let (at, by) = (coordinates(worst.at), number(worst.by));
        let (more, there) = match curve {
            Some(curve) => (String::new(), format!("at {}", curve.text())),
            None if on.len() == 1 => (String::new(), "there".to_owned()),
            None => (format!(" and {} other places", on.len() - 1), "there".to_owned()),
        };
        let fault = if worst.is_jump {
            format!(
                "jumps by {by} at {at}{more}; declare a crease {there} (lines connect its sides), or make it continuous"
            )
        } else {
            format!("has a kink at {at}{more}, where its slope changes by {by}; declare a crease {there}")
        };
        faults.push((fault, worst.at));
    }
    faults
}

/// The intervals of lines across the box where fourth differences of the values are largest.
fn candidates(tested: &Tested<'_>) -> Vec<Interval> {
    let frame = tested.frame;
    let mut all = Vec::new();
    for (k, along_x) in (0..LINES).flat_map(|k| [(k, true), (k, false)]) {
        // No line goes through the center or a corner.
        let across = (f64::from(k) + 0.382) / f64::from(LINES);
        let sample = |i: u32| {
            let t = f64::from(i) / f64::from(INTERVALS);
            let (x, y) = if along_x { (t, across) } else { (across, t) };
            Point::new(frame.x0 + x * frame.width(), frame.y0 + y * frame.height())
        };
        let samples: Vec<Point> = (0..=INTERVALS).map(sample).collect();
        let values = tested.values(&samples);
        let fourth = |v: &[Point]| {
            let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|i| v[i].to_vec2());
            (a + e - 4.0 * (b + d) + 6.0 * c).hypot()
        };
        let fourth: Vec<f64> = values.windows(5).map(fourth).collect();
        let is_larger = |i: Option<usize>, than: f64| i.and_then(|i| fourth.get(i)).is_some_and(|v| *v > than);
        let is_peak = |i: &usize| {
            fourth[*i] > 0.0 && !is_larger(i.checked_sub(1), fourth[*i]) && !is_larger(Some(i + 1), fourth[*i])
        };
        let mut peaks: Vec<usize> = (0..fourth.len()).filter(is_peak).collect();
        peaks.sort_by(|a, b| fourth[*b].total_cmp(&fourth[*a]));
        let (half, changes) = (samples[2] - samples[0], [0.0; HALVINGS]);
        all.extend(peaks.iter().take(MAX_PEAKS).map(|i| Interval { center: samples[i + 2], half, changes }));
    }
    all
}

/// Halves intervals again and again towards the largest change of slope, and returns the points where it does not vanish.
fn refine(tested: &Tested<'_>, mut intervals: Vec<Interval>) -> Vec<Break> {
    let size = tested.frame.size().to_vec2().hypot();
    let mut found = Vec::new();
    for round in 0..HALVINGS {
        // One more sample on either side, as rounding may push a jump over the end of the interval.
        let samples = |i: &Interval| (-3..=3).map(|k| i.center + i.half * (0.5 * f64::from(k))).collect::<Vec<_>>();
        let values = tested.values(&intervals.iter().flat_map(samples).collect::<Vec<_>>());
        let mut kept = Vec::new();
        for (interval, v) in intervals.iter().zip(values.chunks_exact(7)) {
            let half = 0.5 * interval.half;
            let change =
                |k: usize| (v[k - 1].to_vec2() + v[k + 1].to_vec2() - 2.0 * v[k].to_vec2()).hypot() / half.hypot();
            let larger = |a: usize, b: usize| if change(b) > change(a) { b } else { a };
            let finite = [3, 2, 4, 1, 5].into_iter().filter(|k| change(*k).is_finite());
            let Some(k) = finite.reduce(larger) else { continue };
            let mut next = Interval { center: interval.center + half * (k as f64 - 3.0), half, ..*interval };
            next.changes[round] = change(k);
            let before = round.checked_sub(COMPARED).map_or(0.0, |i| next.changes[i]);
            let is_left = change(k) > 0.05 * LEAST && change(k) > 0.3 * before;
            if is_left && round + 1 < HALVINGS {
                kept.push(next);
            } else if is_left && tested.is_in_domain(next.center) && !tested.has_crease_near(next.center, half) {
                let slope = (v[k + 1] - v[k - 1]).hypot() / (2.0 * half.hypot());
                let is_jump = change(k) > 32.0 * before;
                let by = if is_jump { change(k) * half.hypot() } else { change(k) };
                // Two adjacent peaks lead to one point.
                let is_new = found.iter().all(|b: &Break| b.at.distance(next.center) > 1e-5 * size);
                if is_new && by > if is_jump { 1e-7 * size } else { LEAST * slope.max(1.0) } {
                    found.push(Break { at: next.center, by, is_jump });
                }
            }
        }
        intervals = kept;
    }
    found
}

/// A curve that can be declared as a crease.
#[derive(Clone, Copy)]
enum Curve {
    /// The line a·x + b·y + c = 0; the larger of a and b is 1 or −1.
    Line([f64; 3]),
    /// The circle with this center and radius.
    Circle([f64; 3]),
}

impl Curve {
    fn distance(self, p: Point) -> f64 {
        match self {
            Self::Line([a, b, c]) => (a * p.x + b * p.y + c).abs() / a.hypot(b),
            Self::Circle([x, y, r]) => (p.distance(Point::new(x, y)) - r).abs(),
        }
    }

    /// The crease in the notation of plug-ins and functions.
    fn text(self) -> String {
        let (word, numbers) = match self {
            Self::Line(numbers) => ("line", numbers),
            Self::Circle(numbers) => ("circle", numbers),
        };
        // The points are known to a hundred millionth of the box.
        let [a, b, c] = numbers.map(|v| number(if v.abs() < 1e-5 { 0.0 } else { v }));
        format!("{word} {a} {b} {c}")
    }
}

/// The line or circle that contains most of the points within a distance, at least four; `None` if there is none.
fn curve_through_most(points: &[Point], tolerance: f64) -> Option<Curve> {
    // Curves are drawn through up to 24 of the points.
    let tried: Vec<Point> = points.iter().step_by(points.len().div_ceil(24).max(1)).copied().collect();
    let count = |c: &Curve| points.iter().filter(|p| c.distance(**p) < tolerance).count();
    let mut best: Option<(usize, Curve)> = None;
    let mut consider = |curve: Option<Curve>| {
        let counted = curve.map(|c| (count(&c), c)).filter(|(n, _)| *n >= 4);
        best = counted.filter(|(n, _)| best.is_none_or(|(most, _)| *n > most)).or(best);
    };
    for (i, a) in tried.iter().enumerate() {
        for (j, b) in tried.iter().enumerate().skip(i + 1) {
            consider(line(*a, *b, tolerance));
            tried.iter().skip(j + 1).for_each(|c| consider(circle(*a, *b, *c)));
        }
    }
    best.map(|(_, curve)| curve)
}

/// The line through two points known within a tolerance; `None` if they are too close to determine its direction.
fn line(a: Point, b: Point, tolerance: f64) -> Option<Curve> {
    let along = b - a;
    let n = along.turn_90() / along.x.abs().max(along.y.abs());
    (along.hypot() > 1e5 * tolerance).then(|| {
        // Of both signs of the equation, the one that begins without a minus.
        let n = if n.x < -1e-6 || (n.x.abs() <= 1e-6 && n.y < 0.0) { -n } else { n };
        Curve::Line([n.x, n.y, -n.dot(a.to_vec2())])
    })
}

/// The circle through three points; `None` if they lie on a line, or nearly so.
fn circle(a: Point, b: Point, c: Point) -> Option<Curve> {
    let (p, q) = (b - a, c - a);
    let twice_area = p.cross(q);
    let size = p.hypot().max(q.hypot());
    if (2.0 * twice_area).abs() < 1e-2 * size * size {
        return None;
    }
    let to_center =
        Vec2::new(q.y * p.hypot2() - p.y * q.hypot2(), p.x * q.hypot2() - q.x * p.hypot2()) / (2.0 * twice_area);
    let center = a + to_center;
    Some(Curve::Circle([center.x, center.y, to_center.hypot()]))
}
