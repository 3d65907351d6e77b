//! One segment of a path.

use super::EllipticArc;
use kurbo::{Affine, CubicBez, Line, ParamCurve, ParamCurveDeriv, PathSeg, Point, QuadBez, Rect, Shape, Vec2};

/// A segment of a path, parametrised over [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Seg {
    /// A straight line.
    Line(Line),
    /// A quadratic Bézier curve.
    Quad(QuadBez),
    /// A cubic Bézier curve.
    Cubic(CubicBez),
    /// An arc of an ellipse.
    Arc(EllipticArc),
}

impl From<PathSeg> for Seg {
    fn from(s: PathSeg) -> Self {
        match s {
            PathSeg::Line(s) => Self::Line(s),
            PathSeg::Quad(s) => Self::Quad(s),
            PathSeg::Cubic(s) => Self::Cubic(s),
        }
    }
}

impl Seg {
    /// The point at `t` in [0, 1]. The ends are exact.
    #[inline]
    #[must_use]
    pub fn eval(&self, t: f64) -> Point {
        match self {
            Self::Line(s) => s.eval(t),
            Self::Quad(s) => s.eval(t),
            Self::Cubic(s) => s.eval(t),
            Self::Arc(s) => s.eval(t),
        }
    }

    /// The derivative with respect to `t`.
    #[inline]
    #[must_use]
    pub fn deriv(&self, t: f64) -> Vec2 {
        match self {
            Self::Line(s) => s.p1 - s.p0,
            Self::Quad(s) => s.deriv().eval(t).to_vec2(),
            Self::Cubic(s) => s.deriv().eval(t).to_vec2(),
            Self::Arc(s) => s.deriv(t),
        }
    }

    /// The first point.
    #[must_use]
    pub fn start(&self) -> Point {
        match self {
            Self::Line(s) => s.p0,
            Self::Quad(s) => s.p0,
            Self::Cubic(s) => s.p0,
            Self::Arc(s) => s.p0,
        }
    }

    /// The last point.
    #[must_use]
    pub fn end(&self) -> Point {
        match self {
            Self::Line(s) => s.p1,
            Self::Quad(s) => s.p2,
            Self::Cubic(s) => s.p3,
            Self::Arc(s) => s.p1,
        }
    }

    /// The same segment in the opposite direction.
    #[must_use]
    pub fn reversed(&self) -> Self {
        match self {
            Self::Line(s) => Self::Line(Line::new(s.p1, s.p0)),
            Self::Quad(s) => Self::Quad(QuadBez::new(s.p2, s.p1, s.p0)),
            Self::Cubic(s) => Self::Cubic(CubicBez::new(s.p3, s.p2, s.p1, s.p0)),
            Self::Arc(s) => Self::Arc(s.reversed()),
        }
    }

    /// The part of a line or Bézier curve between two parameters, exactly the same segment for (0, 1); `None` for arcs.
    #[must_use]
    pub fn part(&self, t0: f64, t1: f64) -> Option<Self> {
        let whole = t0 == 0.0 && t1 == 1.0;
        match self {
            Self::Arc(_) => None,
            _ if whole => Some(*self),
            Self::Line(s) => Some(Self::Line(s.subsegment(t0..t1))),
            Self::Quad(s) => Some(Self::Quad(s.subsegment(t0..t1))),
            Self::Cubic(s) => Some(Self::Cubic(s.subsegment(t0..t1))),
        }
    }

    /// The image under an affine map, exact for every kind.
    #[must_use]
    pub fn transformed(&self, m: Affine) -> Self {
        match self {
            Self::Line(s) => Self::Line(m * *s),
            Self::Quad(s) => Self::Quad(m * *s),
            Self::Cubic(s) => Self::Cubic(m * *s),
            Self::Arc(s) => Self::Arc(s.transformed(m)),
        }
    }

    /// The bounding box.
    #[must_use]
    pub fn bounding_box(&self) -> Rect {
        match self {
            Self::Line(s) => s.bounding_box(),
            Self::Quad(s) => s.bounding_box(),
            Self::Cubic(s) => s.bounding_box(),
            Self::Arc(s) => s.bounding_box(),
        }
    }

    /// Extends a box that holds the ends to hold the segment. Extremes are computed only if control points lie outside.
    #[must_use]
    pub fn extend(&self, b: Rect) -> Rect {
        let holds = |p: Point| b.x0 <= p.x && p.x <= b.x1 && b.y0 <= p.y && p.y <= b.y1;
        let inside = match self {
            Self::Line(_) => true,
            Self::Quad(s) => holds(s.p1),
            Self::Cubic(s) => holds(s.p1) && holds(s.p2),
            Self::Arc(s) => {
                let reach = s.reach();
                holds(s.center - reach) && holds(s.center + reach)
            }
        };
        if inside { b } else { b.union(self.bounding_box()) }
    }

    /// The segment as one cubic: exact for lines, quadratics and cubics. For an arc of sweep Δ, the cubic with its end tangents
    /// and handles of length (4/3)·tan(Δ/4) times the conjugate radius (radial error 2.7e-4 of the radius for a quarter circle).
    #[must_use]
    pub fn to_cubic(&self) -> CubicBez {
        match self {
            Self::Line(s) => CubicBez::new(s.p0, s.p0.lerp(s.p1, 1.0 / 3.0), s.p0.lerp(s.p1, 2.0 / 3.0), s.p1),
            Self::Quad(s) => s.raise(),
            Self::Cubic(s) => *s,
            Self::Arc(s) => s.to_cubic(),
        }
    }

    /// The largest magnitude of the coordinates that the segment is computed with: of its control points; of an arc, a bound.
    #[must_use]
    pub fn extent(&self) -> f64 {
        let all = |points: &[Point]| points.iter().fold(0.0, |most: f64, p| most.max(p.x.abs()).max(p.y.abs()));
        match self {
            Self::Line(s) => all(&[s.p0, s.p1]),
            Self::Quad(s) => all(&[s.p0, s.p1, s.p2]),
            Self::Cubic(s) => all(&[s.p0, s.p1, s.p2, s.p3]),
            Self::Arc(s) => all(&[s.center]) + s.a.hypot() + s.b.hypot(),
        }
    }

    /// Returns `true` if every coordinate is finite and below 1e100 in magnitude.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        const HUGE: f64 = 1e100;
        let ok = |p: Point| (p.x.abs() < HUGE) & (p.y.abs() < HUGE);
        match self {
            Self::Line(s) => ok(s.p0) & ok(s.p1),
            Self::Quad(s) => ok(s.p0) & ok(s.p1) & ok(s.p2),
            Self::Cubic(s) => ok(s.p0) & ok(s.p1) & ok(s.p2) & ok(s.p3),
            Self::Arc(s) => s.is_finite(HUGE),
        }
    }
}
