//! The first-order behaviour of a map at a point.

use kurbo::{Point, Vec2};

/// Value and both partial derivatives of a map at a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Jet {
    /// The value F(x, y).
    pub p: Point,
    /// ∂F/∂x.
    pub dx: Vec2,
    /// ∂F/∂y.
    pub dy: Vec2,
}

impl Jet {
    /// The jet of a map outside its domain: six NaNs.
    pub const UNDEFINED: Self = Self {
        p: Point::new(f64::NAN, f64::NAN),
        dx: Vec2::new(f64::NAN, f64::NAN),
        dy: Vec2::new(f64::NAN, f64::NAN),
    };

    /// The derivative in direction `v`: the Jacobian times `v`.
    #[inline]
    #[must_use]
    pub fn push(&self, v: Vec2) -> Vec2 {
        self.dx * v.x + self.dy * v.y
    }

    /// The determinant of the Jacobian: the local scale of areas, negative where the map mirrors.
    #[inline]
    #[must_use]
    pub fn det(&self) -> f64 {
        self.dx.cross(self.dy)
    }

    /// The jet of `outer ∘ self`, where `outer` is the jet of the outer map at `self.p`.
    #[inline]
    #[must_use]
    pub fn then(&self, outer: &Self) -> Self {
        Self { p: outer.p, dx: outer.push(self.dx), dy: outer.push(self.dy) }
    }

    /// Returns `true` if all six numbers are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.p.is_finite() && self.dx.is_finite() && self.dy.is_finite()
    }
}
