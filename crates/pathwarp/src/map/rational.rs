//! Rational Bézier curves of any degree in homogeneous coordinates: the exact images that certificates are proved on.

use crate::outline::{EllipticArc, Seg};
use kurbo::Point;

/// A rational Bézier curve: control points (x·w, y·w, w). Polynomial curves have every w = 1.
#[derive(Debug, Clone, PartialEq)]
pub struct RationalBezier {
    /// The homogeneous control points; the degree is one less than their number.
    pub points: Vec<[f64; 3]>,
}

impl RationalBezier {
    /// The polynomial curve with these control points.
    #[must_use]
    pub fn polynomial(points: &[Point]) -> Self {
        Self { points: points.iter().map(|p| [p.x, p.y, 1.0]).collect() }
    }

    /// The exact form of a piece of a path: degree 1, 2 or 3; an arc of at most a half turn is a rational quadratic (longer
    /// ones have none with positive weights: `None`).
    #[must_use]
    pub fn from_seg(seg: &Seg) -> Option<Self> {
        Some(match seg {
            Seg::Line(s) => Self::polynomial(&[s.p0, s.p1]),
            Seg::Quad(s) => Self::polynomial(&[s.p0, s.p1, s.p2]),
            Seg::Cubic(s) => Self::polynomial(&[s.p0, s.p1, s.p2, s.p3]),
            Seg::Arc(s) => return Self::from_arc(s),
        })
    }

    /// An arc as a rational quadratic: the middle weight is cos(Δ/2). Its parameter is not the angle.
    fn from_arc(arc: &EllipticArc) -> Option<Self> {
        const MOST: f64 = 0.9 * std::f64::consts::PI;
        if arc.sweep.abs() > MOST {
            return None;
        }
        let half = arc.sweep / 2.0;
        let w = half.cos();
        let (s, c) = (arc.start + half).sin_cos();
        // Where the end tangents meet, times w: w·(c + (a cos μ + b sin μ)/w), μ the middle angle.
        let m = arc.center.to_vec2() * w + arc.a * c + arc.b * s;
        Some(Self { points: vec![[arc.p0.x, arc.p0.y, 1.0], [m.x, m.y, w], [arc.p1.x, arc.p1.y, 1.0]] })
    }

    /// The degree.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.points.len().saturating_sub(1)
    }

    /// Whether all weights are one.
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

    /// The curve whose homogeneous control points are `f` of this one's: exact for linear `f`.
    #[must_use]
    pub fn mapped(&self, f: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        Self { points: self.points.iter().map(|p| f(*p)).collect() }
    }
}
