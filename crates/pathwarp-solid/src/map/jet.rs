//! The first-order behaviour of a map of space at a point.

use glam::{DMat3, DVec3};

/// Value and Jacobian of a map of space at a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Jet3 {
    /// The value F(x, y, z).
    pub p: DVec3,
    /// The Jacobian: its columns are ∂F/∂x, ∂F/∂y and ∂F/∂z.
    pub d: DMat3,
}

impl Jet3 {
    /// The jet of a map outside its domain.
    pub const UNDEFINED: Self = Self { p: DVec3::NAN, d: DMat3::NAN };

    /// The jet of the map that moves nothing.
    #[must_use]
    pub fn identity(p: DVec3) -> Self {
        Self { p, d: DMat3::IDENTITY }
    }

    /// The determinant of the Jacobian: the local scale of volumes, negative where the map mirrors.
    #[must_use]
    pub fn det(&self) -> f64 {
        self.d.determinant()
    }

    /// The jet of `outer ∘ self`, where `outer` is the jet of the outer map at `self.p`.
    #[must_use]
    pub fn then(&self, outer: &Self) -> Self {
        Self { p: outer.p, d: outer.d * self.d }
    }

    /// The direction of the image of a surface's normal `n`: the cofactors of the Jacobian, det J · J⁻ᵀ, times `n`. Unlike the
    /// inverse transpose it exists for a singular Jacobian too, and its sign follows the orientation of transformed triangles.
    #[must_use]
    pub fn normal(&self, n: DVec3) -> DVec3 {
        let [a, b, c] = [self.d.x_axis, self.d.y_axis, self.d.z_axis];
        b.cross(c) * n.x + c.cross(a) * n.y + a.cross(b) * n.z
    }

    /// Returns `true` if all twelve numbers are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.p.is_finite() && self.d.is_finite()
    }
}
