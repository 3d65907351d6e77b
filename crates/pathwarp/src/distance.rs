//! The Hausdorff distance between two paths: the largest distance from a point of either path to the other.
//!
//! ```
//! use pathwarp::{Outline, distance};
//!
//! let circle = Outline::from_svg("M90,50 A40,40 0 1 1 10,50 A40,40 0 1 1 90,50 Z")?;
//! let octagon = Outline::from_svg("M90,50 L78,78 L50,90 L22,78 L10,50 L22,22 L50,10 L78,22 Z")?;
//! let apart = distance::symmetric(&circle, &octagon).unwrap_or_default();
//! // In the middle of each side.
//! assert!((3.0..3.3).contains(&apart), "{apart}");
//! # Ok::<(), pathwarp::Error>(())
//! ```

use crate::budget::{Budget, Exceeded, Limits, cost};
use crate::outline::{Outline, Seg};
use kurbo::{Point, Rect, Vec2};

/// The number of intervals per segment that [`symmetric`] samples.
const PER_SEGMENT: usize = 64;
/// The number of intervals between starting points of the search for the nearest point of a segment.
const INTERVALS: usize = 16;
/// The cosine of 45°. Intervals in which the curve turns by more are halved for further starting points.
const COS_TURN: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// The limit on the depth of these halvings.
const MAX_HALVINGS: u32 = 12;
/// The limit on the steps of a search.
const MAX_STEPS: usize = 24;
/// A search ends with a step that gains no more than this fraction of the distance.
const SETTLED: f64 = 1e-9;
/// A search ends if a step of this fraction of the Gauss–Newton step gains nothing.
const MIN_DAMPING: f64 = 1e-3;

/// The work of looking at a box, at a line, and at a point of a Bézier curve or of an arc, in comparisons of the budget.
const BOX: f64 = 0.08;
const LINE: f64 = 0.3;
const CURVE: f64 = 0.2;
const ARC: f64 = 0.7;
/// The number of points of a curve that a step of the search for its foot point counts as.
const STEP: f64 = 2.0;

/// The symmetric Hausdorff distance between two paths: the largest distance from a point of either path to the other.
///
/// It is sampled at 65 points per segment, whose nearest points are found by the damped Gauss–Newton method from 17 starting points per
/// segment, more where the segment turns sharply. The result is a lower bound, exact up to the change of the distance between samples.
/// `None` if one of the paths is empty.
#[must_use]
pub fn symmetric(a: &Outline, b: &Outline) -> Option<f64> {
    symmetric_within(a, b, &Budget::new(Limits::none())).ok().flatten()
}

/// The [`symmetric`] distance, with its comparisons charged to `budget`: paths of very many segments that are everywhere about equally
/// far apart take time in proportion to the product of their numbers.
///
/// # Errors
/// [`Exceeded`] if `budget` does not allow so many comparisons.
pub fn symmetric_within(a: &Outline, b: &Outline, budget: &Budget) -> Result<Option<f64>, Exceeded> {
    let Some(from_a) = one_way(a, b, 0.0, budget)? else { return Ok(None) };
    one_way(b, a, from_a, budget)
}

/// The largest distance from a point of `from` to `to`, or `min` if that is larger.
fn one_way(from: &Outline, to: &Outline, min: f64, budget: &Budget) -> Result<Option<f64>, Exceeded> {
    let mut targets = Targets::new(parts(to, Target::with_starts).collect());
    if targets.all.is_empty() {
        return Ok(None);
    }
    let mut largest = None;
    for sampled in parts(from, |s| Target::Seg(s, Vec::new())) {
        let mut work = 0.0;
        for i in 0..=sampled.intervals() {
            let p = sampled.eval(i as f64 / PER_SEGMENT as f64);
            let known = largest.unwrap_or(min);
            largest = Some(targets.distance(p, known, &mut work).max(known));
        }
        budget.spend(cost::COMPARISON * work)?;
    }
    Ok(largest)
}

/// The segments of a path, and its subpaths that are points.
fn parts<'a>(path: &'a Outline, seg: fn(&'a Seg) -> Target<'a>) -> impl Iterator<Item = Target<'a>> {
    let dots = path.subpaths.iter().filter(|s| s.segs.is_empty()).map(|s| Target::Dot(s.start));
    path.segs().map(seg).chain(dots)
}

/// A part of a path: a segment with the further starting points of a search, or a subpath that is a point.
enum Target<'a> {
    Seg(&'a Seg, Vec<f64>),
    Dot(Point),
}

impl<'a> Target<'a> {
    fn with_starts(seg: &'a Seg) -> Self {
        let mut starts = Vec::new();
        if !matches!(seg, Seg::Line(_)) {
            let ends: [_; INTERVALS + 1] =
                std::array::from_fn(|i| i as f64 / INTERVALS as f64).map(|t| (t, seg.deriv(t)));
            for w in ends.windows(2) {
                add_starts(seg, w[0], w[1], MAX_HALVINGS, &mut starts);
            }
        }
        Self::Seg(seg, starts)
    }

    fn bounds(&self) -> Rect {
        match self {
            Self::Seg(s, _) => s.bounding_box(),
            Self::Dot(p) => Rect::from_points(*p, *p),
        }
    }

    /// The number of intervals between samples.
    fn intervals(&self) -> usize {
        if matches!(self, Self::Seg(..)) { PER_SEGMENT } else { 0 }
    }

    fn eval(&self, t: f64) -> Point {
        match self {
            Self::Seg(s, _) => s.eval(t),
            Self::Dot(p) => *p,
        }
    }

    /// The distance from `p`, or `known` if that is smaller. Adds to `work`.
    fn distance(&self, p: Point, known: f64, work: &mut f64) -> f64 {
        match self {
            Self::Seg(s, starts) => to_segment(s, starts, p, known, work),
            Self::Dot(d) => {
                *work += LINE;
                d.distance(p).min(known)
            }
        }
    }
}

/// The parts of a path under a tree of boxes: node i holds nodes 2i and 2i + 1, and the parts are the leaves. Consecutive parts of a
/// path are near each other, so their boxes are small.
struct Targets<'a> {
    all: Vec<Target<'a>>,
    boxes: Vec<Rect>,
    /// The nearest part to the last point: neighbouring samples have neighbouring foot points.
    last: usize,
    /// The nodes that are still to be searched.
    pending: Vec<usize>,
}

/// The empty box, which is infinitely far from every point.
const NOWHERE: Rect = Rect::new(f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY);

impl<'a> Targets<'a> {
    fn new(all: Vec<Target<'a>>) -> Self {
        let leaves = all.len().next_power_of_two();
        let mut boxes = vec![NOWHERE; 2 * leaves];
        for (leaf, target) in boxes[leaves..].iter_mut().zip(&all) {
            *leaf = target.bounds();
        }
        for i in (1..leaves).rev() {
            let (a, b) = (boxes[2 * i], boxes[2 * i + 1]);
            boxes[i] = Rect::new(a.x0.min(b.x0), a.y0.min(b.y0), a.x1.max(b.x1), a.y1.max(b.y1));
        }
        Self { all, boxes, last: 0, pending: Vec::new() }
    }

    /// The distance from `p`. The search ends once the distance is known to be at most `enough`. Adds to `work`.
    fn distance(&mut self, p: Point, enough: f64, work: &mut f64) -> f64 {
        let leaves = self.boxes.len() / 2;
        let mut best = self.all[self.last].distance(p, f64::INFINITY, work);
        self.pending.clear();
        self.pending.push(1);
        while let Some(node) = self.pending.pop()
            && best > enough
        {
            *work += BOX;
            // False for NaN, so that boxes that are not finite are searched.
            if box_distance(&self.boxes[node], p) >= best {
                continue;
            }
            if node < leaves {
                let (a, b) = (2 * node, 2 * node + 1);
                let is_b_nearer = box_distance(&self.boxes[a], p) > box_distance(&self.boxes[b], p);
                // The nearer child is searched first.
                self.pending.extend(if is_b_nearer { [a, b] } else { [b, a] });
                continue;
            }
            let Some(target) = self.all.get(node - leaves) else { continue };
            let d = target.distance(p, best, work);
            if d < best {
                (best, self.last) = (d, node - leaves);
            }
        }
        best
    }
}

fn box_distance(r: &Rect, p: Point) -> f64 {
    let dx = (r.x0 - p.x).max(p.x - r.x1).max(0.0);
    let dy = (r.y0 - p.y).max(p.y - r.y1).max(0.0);
    dx.hypot(dy)
}

/// Adds a start wherever the part of a segment between two parameters, each with its derivative, turns sharply. A cubic does so at most
/// twice.
fn add_starts(seg: &Seg, a: (f64, Vec2), b: (f64, Vec2), halvings: u32, starts: &mut Vec<f64>) {
    let t = 0.5 * (a.0 + b.0);
    let mid = (t, seg.deriv(t));
    // The derivative of a cubic is a parabola, whose directions are between those of its control points.
    let control = 2.0 * mid.1 - 0.5 * (a.1 + b.1);
    let is_sharp = |u: Vec2, v: Vec2| u.dot(v) < COS_TURN * u.hypot() * v.hypot();
    let turns = halvings > 0 && (is_sharp(a.1, control) || is_sharp(control, b.1) || is_sharp(a.1, b.1));
    // A search cannot leave a point where the derivative is zero.
    if turns || (a.1 == Vec2::ZERO) != (b.1 == Vec2::ZERO) {
        starts.push(t);
    }
    if turns {
        add_starts(seg, a, mid, halvings - 1, starts);
        add_starts(seg, mid, b, halvings - 1, starts);
    }
}

/// The distance from `p` to `seg`, or `known` if that is smaller. Searches from `starts` as well. Adds to `work`.
fn to_segment(seg: &Seg, starts: &[f64], p: Point, known: f64, work: &mut f64) -> f64 {
    if let Seg::Line(l) = seg {
        *work += LINE;
        let v = l.p1 - l.p0;
        let t = ((p - l.p0).dot(v) / v.hypot2()).clamp(0.0, 1.0);
        let foot = if t.is_nan() { l.p0 } else { l.p0.lerp(l.p1, t) };
        return foot.distance(p).min(known);
    }
    let point_work = if matches!(seg, Seg::Arc(_)) { ARC } else { CURVE };
    *work += point_work * (INTERVALS + 1) as f64;
    let distances: [f64; INTERVALS + 1] = std::array::from_fn(|i| seg.eval(i as f64 / INTERVALS as f64).distance(p));
    let mut best = distances.iter().copied().fold(known, f64::min);
    // No point of the segment is farther than this from the nearest starting point.
    let max_gap = max_speed(seg) * 0.5 / INTERVALS as f64;
    *work += point_work * starts.len() as f64;
    let regular = distances.into_iter().enumerate().map(|(i, d)| (i as f64 / INTERVALS as f64, d));
    for (mut t, mut d) in regular.chain(starts.iter().map(|&t| (t, seg.eval(t).distance(p)))) {
        if d - max_gap >= best {
            continue;
        }
        // Gauss–Newton iteration for the foot point, with shorter steps where the curve turns too sharply for it.
        let mut damping = 1.0;
        for _ in 0..MAX_STEPS {
            *work += STEP * point_work;
            let v = seg.deriv(t);
            let n = v.hypot2();
            if n == 0.0 {
                break;
            }
            let next_t = (t - damping * (seg.eval(t) - p).dot(v) / n).clamp(0.0, 1.0);
            let next_d = seg.eval(next_t).distance(p);
            if next_d < d {
                let is_settled = d - next_d <= SETTLED * d;
                (t, d, damping) = (next_t, next_d, (2.0 * damping).min(1.0));
                if is_settled {
                    break;
                }
            } else if damping > MIN_DAMPING {
                damping *= 0.25;
            } else {
                break;
            }
        }
        best = best.min(d);
    }
    best
}

/// A bound for the length of the derivative.
fn max_speed(seg: &Seg) -> f64 {
    match seg {
        Seg::Line(l) => l.p0.distance(l.p1),
        Seg::Quad(q) => 2.0 * q.p0.distance(q.p1).max(q.p1.distance(q.p2)),
        Seg::Cubic(c) => 3.0 * c.p0.distance(c.p1).max(c.p1.distance(c.p2)).max(c.p2.distance(c.p3)),
        Seg::Arc(a) => a.a.hypot().hypot(a.b.hypot()) * a.sweep.abs(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_distances() {
        let path = |d: &str| Outline::from_svg(d).unwrap();
        // Concentric circles; and a line beside a longer one, whose far end has the largest distance.
        let ring = |r: f64| path(&format!("M{r},0 A{r},{r} 0 0 1 -{r},0 A{r},{r} 0 0 1 {r},0 Z"));
        assert!((symmetric(&ring(10.0), &ring(10.5)).unwrap() - 0.5).abs() < 1e-9);
        assert!((symmetric(&path("M0,0 H10"), &path("M0,1 H14")).unwrap() - 17.0_f64.sqrt()).abs() < 1e-12);
        assert!(symmetric(&ring(10.0), &ring(10.0)).unwrap() < 1e-12);
        for turned in [
            // The cubic turns back within a thousandth of its length,
            "M9,-54 C10,0.6 3,-563 1,11",
            // at its start, where its derivative is zero,
            "M0,1 C0,1 0,0 5,71",
            "M97,93 C97,93 100.77894663640085,96.52167116657114 6,4",
            // and twice within a small part of it.
            "M94,46 C34.86324402573272,15.739518830697063 57.79779568305158,27.49665112689303 49,23",
            "M50,0 A100,0.01 30 0 1 -50,9",
        ] {
            let turned = path(turned);
            let distance = symmetric(&turned, &turned).unwrap();
            assert!(distance < 1e-9, "{turned:?} is {distance} from itself");
        }
        assert_eq!(symmetric(&ring(1.0), &Outline::default()), None);
        assert_eq!(symmetric(&path("M3,4"), &path("M0,0M9,0H8")), Some(52.0_f64.sqrt()));
    }

    #[test]
    fn many_segments_take_little_unless_all_are_as_near() {
        use crate::budget::{Limit, Limits};
        let zigzag = |n: usize, y: f64| {
            let points: Vec<Point> = (0..n).map(|i| Point::new(i as f64, y + (i % 2) as f64)).collect();
            Outline::from_points(&points, false)
        };
        let budget = Budget::new(Limits::default().with(Limit::Work, 40e6));
        assert!(
            (symmetric_within(&zigzag(9000, 0.0), &zigzag(9000, 0.25), &budget).unwrap().unwrap() - 0.25).abs() < 1e-12
        );
        // Every part of the star is equally far from the centre.
        let star: Vec<Point> = (0..30_000).map(|i| Point::new(1e3 * f64::from(i % 2 * 2 - 1), 0.0)).collect();
        let few = Budget::new(Limits::default().with(Limit::Work, 1e3));
        assert_eq!(
            symmetric_within(&Outline::from_points(&star, false), &zigzag(9, 5.0), &few).unwrap_err().limit,
            Limit::Work
        );
    }
}
