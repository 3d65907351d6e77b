//! Creases: the lines along which a map is not smooth, and the boundary of its domain.
//!
//! Both are level sets φ(x, y) = 0 in the source plane, so that a chain can pull the crease of a later map back through the
//! earlier maps, as φ ∘ F. The refitter splits paths at their crossings with creases.

use super::enclosure::enclose_segment;
use super::{Enclosure, Map, Real};
use crate::outline::Seg;
use kurbo::{
    Point, Rect, Vec2,
    common::{solve_itp, solve_quadratic},
};
use std::fmt;
use std::sync::Arc;

/// A function on the plane whose zero set is the crease.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Level {
    /// A straight crease a·x + b·y + c = 0, crossed exactly.
    Line {
        /// The coefficient of x.
        a: f64,
        /// The coefficient of y.
        b: f64,
        /// The constant term.
        c: f64,
    },
    /// The part of a straight line inside a box. Outside the box, the map is smooth across the line.
    Stretch {
        /// The coefficient of x.
        a: f64,
        /// The coefficient of y.
        b: f64,
        /// The constant term.
        c: f64,
        /// The box.
        within: Rect,
    },
    /// A circle: the distance from its centre minus the radius, or, for a negative radius, −radius minus the distance.
    Circle {
        /// The centre.
        center: Point,
        /// The radius; negative if the inside is positive.
        radius: f64,
    },
    /// Any continuous function.
    Field(Arc<dyn Field>),
}

/// A continuous function on the plane. Closures from a point to a number implement it.
pub trait Field: Send + Sync {
    /// The value at a point.
    fn at(&self, p: Point) -> f64;

    /// Encloses the function along a curve with enclosed coordinates. Without bounds (`None`), crossings are found from samples alone.
    fn enclose(&self, _along: [Enclosure; 2]) -> Option<Enclosure> {
        None
    }
}

impl<F: Fn(Point) -> f64 + Send + Sync> Field for F {
    fn at(&self, p: Point) -> f64 {
        self(p)
    }
}

impl fmt::Debug for dyn Field {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Field")
    }
}

/// The number of samples per segment when crossings of a field are bracketed.
const SAMPLES: u32 = 64;

/// The work of an enclosure, in evaluations.
const ENCLOSURE_WORK: usize = 8;

impl Level {
    /// Encloses the function along a curve; see [`Field::enclose`].
    #[must_use]
    pub fn enclose(&self, [x, y]: [Enclosure; 2]) -> Option<Enclosure> {
        match self {
            Self::Line { a, b, c } | Self::Stretch { a, b, c, .. } => Some(x * *a + y * *b + *c),
            Self::Circle { center, radius } => Some(circle([x, y], *center, *radius)),
            Self::Field(f) => f.enclose([x, y]),
        }
    }

    /// The value of the function; for a [`Level::Stretch`], outside its box too.
    #[must_use]
    pub fn at(&self, p: Point) -> f64 {
        match self {
            Self::Line { a, b, c } | Self::Stretch { a, b, c, .. } => a * p.x + b * p.y + c,
            Self::Circle { center, radius } => circle([p.x, p.y], *center, *radius),
            Self::Field(f) => f.at(p),
        }
    }

    /// Adds the parameters in (0, 1) where `seg` goes from one side of the zero set to the other. A segment that touches it, up to
    /// rounding, stays on its side. Straight levels are solved exactly; others are bracketed. Returns the number of additional evaluations.
    pub fn crossings(&self, seg: &Seg, out: &mut Vec<f64>) -> usize {
        let within = if let Self::Stretch { within, .. } = self {
            // Inflated by the rounding error of a crossing.
            let margin = 1e-9 * (within.width() + within.height());
            Some(within.inflate(margin, margin))
        } else {
            None
        };
        let (knots, noise, evaluations) = self.knots(seg);
        let mut last: Option<(f64, f64)> = None;
        for (t1, value1) in knots.into_iter().filter(|k| k.1.abs() > noise) {
            if let Some((t0, value0)) = last.replace((t1, value1))
                && value0 * value1 < 0.0
            {
                let sign = value1.signum();
                let f = |t: f64| sign * self.at(seg.eval(t));
                // kurbo recommends 1 and 0.2 divided by the width as the method's parameters.
                let t = solve_itp(f, t0, t1, 1e-16, 1, 0.2 / (t1 - t0), sign * value0, sign * value1);
                if within.is_none_or(|b| b.contains(seg.eval(t))) {
                    out.push(t);
                }
            }
        }
        evaluations
    }

    /// Parameters from 0 to 1 with the function's values, at most one zero between neighbours; the size of its rounding errors; and the
    /// number of evaluations beyond the [`SAMPLES`] of [`Creases::splits_work`]. No parameters if it has no zero on the segment.
    fn knots(&self, seg: &Seg) -> (Vec<(f64, f64)>, f64, usize) {
        let f = |t: f64| (t, self.at(seg.eval(t)));
        match self {
            Self::Line { a, b, c } | Self::Stretch { a, b, c, .. } => {
                let extremes = straight_extremes(|p| self.at(p), (*a, *b), seg);
                let noise = 4.0 * f64::EPSILON * ((a.abs() + b.abs()) * seg.extent() + c.abs());
                (extremes.into_iter().map(f).collect(), noise, 0)
            }
            Self::Circle { .. } | Self::Field(_) => {
                let enclosed = self.enclosed(seg, &f);
                let evaluations = ENCLOSURE_WORK * enclosed.as_ref().map_or(0, Vec::len);
                let knots = enclosed.unwrap_or_else(|| sampled(f));
                let is_on_one_side = knots.iter().all(|k| k.1 > 0.0) || knots.iter().all(|k| k.1 < 0.0);
                let noise = if is_on_one_side { 0.0 } else { noise(seg, &knots) };
                (knots, noise, evaluations.saturating_sub(SAMPLES as usize))
            }
        }
    }

    /// The ends of parts of a segment on which the function has at most one zero, by its enclosures; `None` if they do not suffice. On
    /// a part, `d[0]` bounds the change of the function, for a circle that of the point: a distance changes no faster than the point.
    fn enclosed(&self, seg: &Seg, f: &impl Fn(f64) -> (f64, f64)) -> Option<Vec<(f64, f64)>> {
        /// Limits for the number of parts and their length: where the function touches zero, there is no end to halving.
        const MAX_PARTS: usize = 20_000;
        const SHORTEST: f64 = 1e-7;
        let (mut knots, mut ends) = (vec![f(0.0)], vec![f(1.0)]);
        let mut parts = 0;
        while let (Some((t0, value0)), Some((t1, value1))) = (knots.last().copied(), ends.last().copied()) {
            parts += 1;
            let along = enclose_segment(seg, [t0, t1]);
            let has_no_zero = |slope: f64| value0 * value1 > 0.0 && value0.abs() + value1.abs() > slope;
            if matches!(self, Self::Circle { .. }) && has_no_zero(along[0].d[0].hypot(along[1].d[0])) {
                knots.extend(ends.pop());
                continue;
            }
            let e = self.enclose(along)?;
            let has_no_zero = e.lo > 0.0 || e.hi < 0.0 || has_no_zero(e.d[0]);
            // d[1] bounds half the second derivative, so the slope differs from the mean slope by at most 2·d[1].
            let is_monotonic = (value1 - value0).abs() > 2.0 * e.d[1];
            let is_undefined = value0.is_nan() || value1.is_nan();
            if has_no_zero || is_monotonic || is_undefined || t1 - t0 < SHORTEST {
                knots.extend(ends.pop());
            } else if parts > MAX_PARTS {
                return None;
            } else {
                ends.push(f(0.5 * (t0 + t1)));
            }
        }
        Some(knots)
    }
}

/// The value of a [`Level::Circle`].
fn circle<S: Real>([x, y]: [S; 2], center: Point, radius: f64) -> S {
    ((x - center.x).hypot(y - center.y) - radius.abs()) * radius.signum()
}

/// The size of the rounding errors of a function with these values on a segment. Far from the origin, coordinates cancel.
fn noise(seg: &Seg, knots: &[(f64, f64)]) -> f64 {
    let largest = knots.iter().map(|k| k.1.abs()).filter(|v| v.is_finite()).fold(0.0, f64::max);
    let size = seg.bounding_box().size();
    let ulps = seg.extent() / size.width.max(size.height).max(f64::MIN_POSITIVE);
    largest * (1e-14 + 4.0 * f64::EPSILON * ulps).min(1e-3)
}

/// The parameters between which an affine function with gradient `(a, b)` is monotonic on a segment, its ends included. Empty if it has
/// no zero there.
fn straight_extremes(level: impl Fn(Point) -> f64, (a, b): (f64, f64), seg: &Seg) -> Vec<f64> {
    let is_on_one_side = |ps: &[Point]| {
        let mut values = ps.iter().map(|p| level(*p));
        values.clone().all(|v| v > 0.0) || values.all(|v| v < 0.0)
    };
    let along = |v: Vec2| a * v.x + b * v.y;
    let mut ts: Vec<f64> = match seg {
        Seg::Line(s) if is_on_one_side(&[s.p0, s.p1]) => return Vec::new(),
        Seg::Line(_) => Vec::new(),
        Seg::Quad(s) if is_on_one_side(&[s.p0, s.p1, s.p2]) => return Vec::new(),
        Seg::Quad(s) => solve_quadratic(along(s.p1 - s.p0), along((s.p2 - s.p1) - (s.p1 - s.p0)), 0.0).to_vec(),
        Seg::Cubic(s) if is_on_one_side(&[s.p0, s.p1, s.p2, s.p3]) => return Vec::new(),
        Seg::Cubic(s) => {
            let [d0, d1, d2] = [s.p1 - s.p0, s.p2 - s.p1, s.p3 - s.p2].map(along);
            solve_quadratic(d0, 2.0 * (d1 - d0), d2 - 2.0 * d1 + d0).to_vec()
        }
        // Up to rounding, the level on an arc differs from the centre's by at most this hypotenuse.
        Seg::Arc(s) if level(s.center).abs() > 1.000_001 * along(s.a).hypot(along(s.b)) => return Vec::new(),
        Seg::Arc(s) => {
            let first = along(s.b).atan2(along(s.a));
            // More half turns than a start and a sweep can reach.
            (-8..=8).map(|k| (first + f64::from(k) * std::f64::consts::PI - s.start) / s.sweep).collect()
        }
    };
    ts.retain(|t| *t > 0.0 && *t < 1.0);
    ts.extend([0.0, 1.0]);
    ts.sort_by(f64::total_cmp);
    ts
}

/// Samples of a function on a segment, with its extremes near zero between them.
fn sampled(f: impl Fn(f64) -> (f64, f64)) -> Vec<(f64, f64)> {
    let h = 1.0 / f64::from(SAMPLES);
    let mut knots: Vec<(f64, f64)> = (0..=SAMPLES).map(|i| f64::from(i) * h).map(&f).collect();
    let last = SAMPLES as usize;
    for i in 0..=last {
        let [a, b, c] = [knots[i.saturating_sub(1)].1, knots[i].1, knots[(i + 1).min(last)].1];
        if b.abs() <= a.abs() && b.abs() <= c.abs() && a * c > 0.0 && a * b >= 0.0 {
            let (from, to) = ((knots[i].0 - h).max(0.0), (knots[i].0 + h).min(1.0));
            knots.extend(dip(&f, knots[i], [from, to], (a - b).abs().max((c - b).abs())));
        }
    }
    knots.sort_by(|a, b| a.0.total_cmp(&b.0));
    knots
}

/// The parameter between `from` and `to` at which a function that is smallest at the sample `least` comes nearest to zero, or crosses it.
/// `None` if its rise to the neighbouring samples shows that it stays away.
fn dip(f: impl Fn(f64) -> (f64, f64), least: (f64, f64), [from, to]: [f64; 2], rise: f64) -> Option<(f64, f64)> {
    /// The shares of the golden section search: (3 − √5)/2 from either end.
    const GOLDEN: f64 = 0.381_966_011_250_105;
    /// The largest fall between samples, as a multiple of the rise to the neighbouring ones.
    const FALL: f64 = 2.0;
    const STEPS: usize = 40;
    let sign = if least.1 < 0.0 { -1.0 } else { 1.0 };
    if sign * least.1 > FALL * rise {
        return None;
    }
    // At an end of the segment there is a dip only if the function falls from there.
    if least.0 == from || least.0 == to {
        let inward = least.0 + 1e-6 * (from + to - 2.0 * least.0);
        if sign * f(inward).1 >= sign * least.1 {
            return None;
        }
    }
    let (mut a, mut b, mut best) = (from, to, least);
    for _ in 0..STEPS {
        let inner = [a + GOLDEN * (b - a), b - GOLDEN * (b - a)].map(&f);
        let lower = usize::from(sign * inner[1].1 < sign * inner[0].1);
        if sign * inner[lower].1 < sign * best.1 {
            best = inner[lower];
        }
        if sign * best.1 < 0.0 && best.0 != least.0 {
            break;
        }
        *if lower == 0 { &mut b } else { &mut a } = inner[1 - lower].0;
    }
    (best.0 != least.0).then_some(best)
}

/// The behaviour of a map at a crease.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CreaseKind {
    /// The derivative jumps, or the value does: a path across a jump is connected by a straight line.
    Kink,
    /// The boundary of the domain: the map is defined only where the level is positive.
    Edge,
}

/// A crease: a level set and the behaviour there.
#[derive(Debug, Clone)]
pub struct Crease {
    /// The level set.
    pub level: Level,
    /// The behaviour of the map there.
    pub kind: CreaseKind,
}

impl Crease {
    /// A crease along which the derivative or the value jumps.
    #[must_use]
    pub fn kink(level: Level) -> Self {
        Self { level, kind: CreaseKind::Kink }
    }

    /// The boundary of the domain, where the map is defined for level > 0.
    #[must_use]
    pub fn edge(level: Level) -> Self {
        Self { level, kind: CreaseKind::Edge }
    }
}

/// The creases of a map.
#[derive(Debug, Clone, Default)]
pub struct Creases {
    items: Vec<Crease>,
}

/// The work of finding the crossings of a segment with a straight crease, in evaluations of a bicubic net.
const STRAIGHT_WORK: f64 = 1.0;
/// The work of one sample of an arc beside a straight crease, where no map is evaluated.
const SAMPLE_WORK: f64 = 0.1;

impl Creases {
    /// The creases of `map`.
    pub(crate) fn of_map(map: &(impl Map + ?Sized)) -> Self {
        let mut all = Self::default();
        map.creases(&mut all);
        all
    }

    /// The work of [`splits`](Self::splits) for a map of `work` per evaluation, in evaluations of a bicubic net.
    pub(crate) fn splits_work(&self, seg: &Seg, work: f64) -> f64 {
        let crease_work = |c: &Crease| match (&c.level, seg) {
            (Level::Line { .. } | Level::Stretch { .. }, Seg::Line(_) | Seg::Quad(_) | Seg::Cubic(_)) => STRAIGHT_WORK,
            (Level::Circle { .. } | Level::Field(_), _) => f64::from(SAMPLES) * work,
            _ => f64::from(SAMPLES) * SAMPLE_WORK,
        };
        self.items.iter().map(crease_work).sum()
    }

    /// Adds a crease.
    pub fn push(&mut self, c: Crease) {
        self.items.push(c);
    }

    /// The creases, in the order they were added.
    #[must_use]
    pub fn items(&self) -> &[Crease] {
        &self.items
    }

    /// Returns `true` if the map is defined at `p`.
    #[must_use]
    pub fn defined_at(&self, p: Point) -> bool {
        self.items.iter().all(|c| c.kind != CreaseKind::Edge || c.level.at(p) > 0.0)
    }

    /// The sorted parameters in (0, 1) at which `seg` must be split so that the map is smooth on every part. Parameters closer
    /// than 1e-9 to each other or to the ends are merged.
    #[must_use]
    pub fn splits(&self, seg: &Seg) -> Vec<f64> {
        self.splits_and_work(seg).0
    }

    /// Returns [`splits`](Self::splits), and the number of evaluations beyond [`splits_work`](Self::splits_work).
    pub(crate) fn splits_and_work(&self, seg: &Seg) -> (Vec<f64>, usize) {
        /// A shorter part would be lost in rounding.
        const SHORTEST: f64 = 1e-9;
        let mut ts = Vec::new();
        let kinks = self.items.iter().filter(|c| c.kind == CreaseKind::Kink);
        let evaluations = kinks.map(|c| c.level.crossings(seg, &mut ts)).sum();
        ts.sort_by(f64::total_cmp);
        ts.retain(|t| *t > SHORTEST && *t < 1.0 - SHORTEST);
        ts.dedup_by(|b, a| *b - *a < SHORTEST);
        (ts, evaluations)
    }

    /// The first point of `seg` at which the map is not defined.
    #[must_use]
    pub(crate) fn first_undefined(&self, seg: &Seg) -> Option<Point> {
        let mut ts = Vec::new();
        for c in self.items.iter().filter(|c| c.kind == CreaseKind::Edge) {
            if c.level.at(seg.start()) <= 0.0 {
                return Some(seg.start());
            }
            c.level.crossings(seg, &mut ts);
            let (knots, noise, _) = c.level.knots(seg);
            ts.extend(knots.iter().filter(|k| k.1 <= noise).map(|k| k.0));
        }
        ts.into_iter().min_by(f64::total_cmp).map(|t| seg.eval(t))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{CubicBez, Line, ParamCurve, QuadBez};

    /// A long segment may go through a small field between two samples, beside the segment's end or elsewhere.
    #[test]
    fn a_field_is_found_between_samples() {
        let disc = Level::Field(Arc::new(|p: Point| p.to_vec2().hypot() - 40.0));
        for (from, to) in [(-45.0, 2000.0), (-1000.0, 1010.0), (-2000.0, 45.0), (-30_000.0, 70_000.0)] {
            for y in [0.0, 20.0, 39.0, 39.99] {
                let (mut ts, line) = (Vec::new(), Line::new((from, y), (to, y + 1e-3)));
                disc.crossings(&Seg::Line(line), &mut ts);
                let error = |t: &f64| (line.eval(*t).to_vec2().hypot() - 40.0).abs();
                assert!(ts.len() == 2 && ts.iter().all(|t| error(t) < 1e-7), "{from} {y}: {ts:?}");
            }
        }
    }

    /// Straight and nearly straight segments are as accurate as curved ones.
    #[test]
    fn straight_creases_are_crossed_exactly() {
        let line = Seg::Line(Line::new((0.0, 50.0), (140.0, 50.0)));
        let (q, c) = (Seg::Quad(QuadBez::new((0.0, 0.0), (70.1, 9.0), (140.0, 0.0))), Seg::Cubic(line.to_cubic()));
        for at in [20.000000000031, 63.7, 120.0] {
            let level = Level::Line { a: 1.0, b: 0.0, c: -at };
            for seg in [line, q, c] {
                let mut ts = Vec::new();
                level.crossings(&seg, &mut ts);
                assert!(ts.len() == 1 && (seg.eval(ts[0]).x - at).abs() < 1e-13 * at, "{seg:?} {ts:?}");
            }
        }
        let s = Seg::Cubic(CubicBez::new((0.0, 0.0), (100.0, 0.0), (-50.0, 0.0), (50.0, 0.0)));
        let mut ts = Vec::new();
        Level::Line { a: 1.0, b: 0.0, c: -25.0 }.crossings(&s, &mut ts);
        assert!(ts.len() == 3 && ts.iter().all(|t| (s.eval(*t).x - 25.0).abs() < 1e-13), "{ts:?}");
    }
}
