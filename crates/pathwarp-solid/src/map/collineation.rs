//! Collineations: maps of space that keep planes plane.

use glam::{DMat4, DVec3, DVec4};

/// A collineation: (x, y, z, 1) times a matrix, divided by the last coordinate. Coordinates are relative to a point, so that no digits
/// are lost far from the origin.
///
/// It is defined where certain linear forms are positive: its last coordinate, and the last coordinates of the collineations of
/// which it is composed.
#[derive(Debug, Clone, PartialEq)]
pub struct Collineation {
    pub(super) matrix: DMat4,
    /// Linear forms in (x, y, z, 1) that are positive in the domain.
    pub(super) positive: Vec<DVec4>,
    /// The point relative to which the matrix and the forms are meant.
    pub(super) about: DVec3,
}

impl Collineation {
    /// The collineation that moves nothing.
    pub const IDENTITY: Self = Self { matrix: DMat4::IDENTITY, positive: Vec::new(), about: DVec3::ZERO };

    /// Makes a collineation from its matrix, defined where the last coordinate is positive.
    #[must_use]
    pub fn new(matrix: DMat4) -> Self {
        let last = matrix.row(3);
        let affine = last == DVec4::new(0.0, 0.0, 0.0, 1.0);
        Self { matrix, positive: if affine { Vec::new() } else { vec![last] }, about: DVec3::ZERO }
    }

    /// Makes a collineation from its matrix in coordinates relative to a point.
    #[must_use]
    pub fn about(matrix: DMat4, about: DVec3) -> Self {
        Self { about, ..Self::new(matrix) }
    }

    /// Returns the matrix, in coordinates relative to some point. Its determinant does not depend on that point.
    #[must_use]
    pub fn matrix(&self) -> DMat4 {
        self.matrix
    }

    /// Returns the homogeneous image of a point.
    #[must_use]
    pub fn homogeneous(&self, p: DVec3) -> DVec4 {
        let q = self.matrix * (p - self.about).extend(1.0);
        q + (self.about * q.w).extend(0.0)
    }

    /// Returns the collineation that applies this one first, and then `next`.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        // `next`, relative to the point of this one.
        let (to, back) = (next.about - self.about, self.about - next.about);
        let (matrix, shift) = (next.matrix * DMat4::from_translation(back), DMat4::from_translation(back).transpose());
        let matrix = DMat4::from_translation(to) * matrix;
        // The form f at M·p is the form Mᵀ·f at p.
        let pulled = next.positive.iter().map(|f| self.matrix.transpose() * (shift * *f));
        let positive = self.positive.iter().copied().chain(pulled).collect();
        Self { matrix: matrix * self.matrix, positive, about: self.about }
    }
}
