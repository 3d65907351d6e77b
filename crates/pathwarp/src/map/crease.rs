//! Creases: the lines along which a map is not smooth, and the boundary of its domain.
//!
//! Both are level sets φ(x, y) = 0 in the source plane, so that a chain can pull the crease of a later map back through the
//! earlier maps, as φ ∘ F. The refitter splits paths at their crossings with creases.

use crate::outline::Seg;
use kurbo::{
    Point, Rect,
    common::{solve_cubic, solve_quadratic},
};
use std::fmt;
use std::sync::Arc;

/// A function on the plane whose zero set is the crease.
#[derive(Clone)]
#[non_exhaustive]
pub enum Level {
    /// a·x + b·y + c: a straight crease, crossed exactly.
    Line {
        /// Coefficient of x.
        a: f64,
        /// Coefficient of y.
        b: f64,
        /// Constant term.
        c: f64,
    },
    /// The part of a straight line inside a box. Outside the box, the map is smooth across the line.
    Stretch {
        /// Coefficient of x.
        a: f64,
        /// Coefficient of y.
        b: f64,
        /// Constant term.
        c: f64,
        /// The box.
        within: Rect,
    },
    /// Any continuous function.
    Field(Arc<dyn Fn(Point) -> f64 + Send + Sync>),
}

impl fmt::Debug for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line { a, b, c } => write!(f, "{a}·x + {b}·y + {c}"),
            Self::Stretch { a, b, c, within } => write!(f, "{a}·x + {b}·y + {c} within {within:?}"),
            Self::Field(_) => f.write_str("field"),
        }
    }
}

/// Samples per segment when crossings are bracketed. A crease touched and left again between two samples is missed.
const SAMPLES: u32 = 64;

impl Level {
    /// The value of the function; for a [`Level::Stretch`], that of the whole line.
    #[must_use]
    pub fn at(&self, p: Point) -> f64 {
        match self {
            Self::Line { a, b, c } | Self::Stretch { a, b, c, .. } => a * p.x + b * p.y + c,
            Self::Field(f) => f(p),
        }
    }

    /// Adds the parameters in (0, 1) where `seg` meets the zero set. Straight levels and Bézier segments are solved exactly;
    /// otherwise crossings are bracketed between samples.
    pub fn crossings(&self, seg: &Seg, out: &mut Vec<f64>) {
        let within = if let Self::Stretch { within, .. } = self {
            // Wider by the rounding error of a crossing.
            let room = 1e-9 * (within.width() + within.height());
            Some(within.inflate(room, room))
        } else {
            None
        };
        let mut add = |t: f64| {
            if t > 0.0 && t < 1.0 && within.is_none_or(|b| b.contains(seg.eval(t))) {
                out.push(t);
            }
        };
        match (self, seg) {
            (Self::Line { .. } | Self::Stretch { .. }, Seg::Line(_) | Seg::Quad(_) | Seg::Cubic(_)) => {
                straight_crossings(|p| self.at(p), seg).into_iter().for_each(add);
            }
            _ => {
                let f = |t: f64| self.at(seg.eval(t));
                let mut prev = (0.0, f(0.0));
                for i in 1..=SAMPLES {
                    let t = f64::from(i) / f64::from(SAMPLES);
                    let here = (t, f(t));
                    if here.1 == 0.0 {
                        add(t);
                    } else if prev.1 * here.1 < 0.0 {
                        add(bisect(f, prev, here));
                    }
                    prev = here;
                }
            }
        }
    }
}

/// The zeros of an affine function on a Bézier segment: roots of a polynomial of its degree.
fn straight_crossings(level: impl Fn(Point) -> f64, seg: &Seg) -> Vec<f64> {
    /// A leading coefficient this small relative to the values is rounding noise, which the closed forms would amplify.
    const NOISE: f64 = 1e-14;
    // Bernstein coefficients, and from them the power basis.
    let c = match seg {
        Seg::Line(s) => {
            let [a, b] = [s.p0, s.p1].map(level);
            [a, b - a, 0.0, 0.0]
        }
        Seg::Quad(s) => {
            let [a, b, c] = [s.p0, s.p1, s.p2].map(level);
            if same_sign(&[a, b, c]) {
                return Vec::new();
            }
            [a, 2.0 * (b - a), c - 2.0 * b + a, 0.0]
        }
        _ => {
            let s = seg.to_cubic();
            let [a, b, c, d] = [s.p0, s.p1, s.p2, s.p3].map(level);
            if same_sign(&[a, b, c, d]) {
                return Vec::new();
            }
            [a, 3.0 * (b - a), 3.0 * (c - 2.0 * b + a), d - 3.0 * c + 3.0 * b - a]
        }
    };
    let small = NOISE * c.iter().fold(0.0, |a: f64, v| a.max(v.abs()));
    let degree = (1..4).rev().find(|&k| c[k].abs() > small).unwrap_or(0);
    let mut roots: Vec<f64> = match degree {
        0 => Vec::new(),
        1 => vec![-c[0] / c[1]],
        2 => solve_quadratic(c[0], c[1], c[2]).into_iter().collect(),
        _ => solve_cubic(c[0], c[1], c[2], c[3]).into_iter().collect(),
    };
    for t in &mut roots {
        // Newton steps remove the cancellation error of the closed forms. Near a double root, keep only those that help.
        for _ in 0..3 {
            let value = |t: f64| ((c[3] * t + c[2]) * t + c[1]) * t + c[0];
            let slope = (3.0 * c[3] * *t + 2.0 * c[2]) * *t + c[1];
            let next = *t - value(*t) / slope;
            if next.is_finite() && value(next).abs() < value(*t).abs() {
                *t = next;
            }
        }
    }
    roots
}

/// Returns `true` if a polynomial with these Bernstein coefficients has no zero between 0 and 1, as they all have the same sign.
fn same_sign(coefficients: &[f64]) -> bool {
    coefficients.iter().all(|c| *c > 0.0) || coefficients.iter().all(|c| *c < 0.0)
}

fn bisect(f: impl Fn(f64) -> f64, mut lo: (f64, f64), mut hi: (f64, f64)) -> f64 {
    // Sixty halvings exhaust the precision of a unit interval.
    for _ in 0..60 {
        let t = 0.5 * (lo.0 + hi.0);
        let v = f(t);
        if v == 0.0 {
            return t;
        }
        if (v < 0.0) == (lo.1 < 0.0) {
            lo = (t, v);
        } else {
            hi = (t, v);
        }
    }
    0.5 * (lo.0 + hi.0)
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
    /// The behaviour of the map at it.
    pub kind: CreaseKind,
}

impl Crease {
    /// A crease along which the derivative jumps.
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

/// Evaluations of a map that take as long as the crossings of a segment with a straight crease.
const STRAIGHT_WORK: f64 = 1.0;

impl Creases {
    /// The work of [`splits`](Self::splits) for a map of `work` per evaluation, in evaluations of a net.
    pub(crate) fn splits_work(&self, seg: &Seg, work: f64) -> f64 {
        let of = |c: &Crease| match (&c.level, seg) {
            (Level::Line { .. } | Level::Stretch { .. }, Seg::Line(_) | Seg::Quad(_) | Seg::Cubic(_)) => STRAIGHT_WORK,
            (Level::Field(_), _) => f64::from(SAMPLES) * work,
            _ => f64::from(SAMPLES) * 0.1,
        };
        self.items.iter().map(of).sum()
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
        /// A shorter part would be lost in rounding.
        const APART: f64 = 1e-9;
        let mut ts = Vec::new();
        for c in &self.items {
            if c.kind == CreaseKind::Kink {
                c.level.crossings(seg, &mut ts);
            }
        }
        ts.sort_by(f64::total_cmp);
        ts.retain(|t| *t > APART && *t < 1.0 - APART);
        ts.dedup_by(|b, a| *b - *a < APART);
        ts
    }

    /// The first point of `seg` at which the map is not defined.
    #[must_use]
    pub fn first_undefined(&self, seg: &Seg) -> Option<Point> {
        let mut ts = Vec::new();
        for c in &self.items {
            if c.kind == CreaseKind::Edge {
                if c.level.at(seg.start()) <= 0.0 {
                    return Some(seg.start());
                }
                c.level.crossings(seg, &mut ts);
                if c.level.at(seg.end()) <= 0.0 {
                    ts.push(1.0);
                }
            }
        }
        ts.into_iter().min_by(f64::total_cmp).map(|t| seg.eval(t))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{CubicBez, Line, QuadBez};

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
