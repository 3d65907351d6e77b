//! Collineations: maps of space that keep planes plane.

use glam::{DMat4, DVec4};

/// A collineation: (x, y, z, 1) times a matrix, divided by the last coordinate.
///
/// It is defined where certain linear forms are positive: its own last coordinate, and those of the collineations of which it is
/// composed.
#[derive(Debug, Clone, PartialEq)]
pub struct Collineation {
    pub(super) matrix: DMat4,
    /// Linear forms in (x, y, z, 1) that are positive in the domain.
    pub(super) positive: Vec<DVec4>,
}

impl Collineation {
    /// The collineation that moves nothing.
    pub const IDENTITY: Self = Self { matrix: DMat4::IDENTITY, positive: Vec::new() };

    /// Makes a collineation from its matrix, defined where the last coordinate is positive.
    #[must_use]
    pub fn new(matrix: DMat4) -> Self {
        let last = matrix.row(3);
        let affine = last == DVec4::new(0.0, 0.0, 0.0, 1.0);
        Self { matrix, positive: if affine { Vec::new() } else { vec![last] } }
    }

    /// The matrix.
    #[must_use]
    pub fn matrix(&self) -> DMat4 {
        self.matrix
    }

    /// The collineation that applies this one first, and then `next`.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        // The form f at M·p is the form Mᵀ·f at p.
        let pulled = next.positive.iter().map(|f| self.matrix.transpose() * *f);
        Self { matrix: next.matrix * self.matrix, positive: self.positive.iter().copied().chain(pulled).collect() }
    }
}
