//! Rational Bézier curves of any degree in homogeneous coordinates: the exact images on which error bounds are proved.

use crate::outline::{EllipticArc, Seg};
use kurbo::Point;

/// A rational Bézier curve: control points (x·w, y·w, w). Polynomial curves have every w = 1.
#[derive(Debug, Clone, PartialEq)]
pub struct RationalBezier {
    /// The homogeneous control points, one more than the degree.
    pub points: Vec<[f64; 3]>,
}

impl RationalBezier {
    /// The polynomial curve with these control points.
    #[must_use]
    pub fn polynomial(points: &[Point]) -> Self {
        Self { points: points.iter().map(|p| [p.x, p.y, 1.0]).collect() }
    }

    /// The exact form of a path segment: degree 1, 2 or 3 for lines and Bézier curves. An arc of up to 0.9 of a half turn is a
    /// rational quadratic; `None` for longer arcs, whose middle weight is near zero or negative.
    #[must_use]
    pub fn from_seg(seg: &Seg) -> Option<Self> {
        Some(match seg {
            Seg::Line(s) => Self::polynomial(&[s.p0, s.p1]),
            Seg::Quad(s) => Self::polynomial(&[s.p0, s.p1, s.p2]),
            Seg::Cubic(s) => Self::polynomial(&[s.p0, s.p1, s.p2, s.p3]),
            Seg::Arc(s) => return Self::from_arc(s),
        })
    }

    /// An arc as a rational quadratic with middle weight cos(Δ/2). Its parameter is not proportional to the angle.
    fn from_arc(arc: &EllipticArc) -> Option<Self> {
        /// The middle weight is 0 at a half turn, and badly conditioned just below it.
        const MAX_SWEEP: f64 = 0.9 * std::f64::consts::PI;
        if arc.sweep.abs() > MAX_SWEEP {
            return None;
        }
        let half = arc.sweep / 2.0;
        let w = half.cos();
        let (s, c) = (arc.start + half).sin_cos();
        // The intersection of the end tangents, times w: w·(c + (a cos μ + b sin μ)/w), μ the middle angle.
        let m = arc.center.to_vec2() * w + arc.a * c + arc.b * s;
        Some(Self { points: vec![[arc.p0.x, arc.p0.y, 1.0], [m.x, m.y, w], [arc.p1.x, arc.p1.y, 1.0]] })
    }

    /// The degree.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.points.len().saturating_sub(1)
    }

    /// Returns `true` if all weights are 1.
    #[must_use]
    pub fn is_polynomial(&self) -> bool {
        self.points.iter().all(|p| p[2] == 1.0)
    }

    /// The point at `t`, by de Casteljau's algorithm on the homogeneous points.
    #[must_use]
    pub fn eval(&self, t: f64) -> Point {
        let mut row = self.points.clone();
        for n in (1..row.len()).rev() {
            for i in 0..n {
                let next = row[i + 1];
                for (a, b) in row[i].iter_mut().zip(next) {
                    *a += t * (b - *a);
                }
            }
        }
        row.first().map_or(Point::ORIGIN, |p| Point::new(p[0] / p[2], p[1] / p[2]))
    }

    /// The curve whose homogeneous control points are `f` of these: the exact image for linear `f`.
    #[must_use]
    pub fn mapped(&self, f: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        Self { points: self.points.iter().map(|p| f(*p)).collect() }
    }
}
