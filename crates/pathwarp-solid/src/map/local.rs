//! The coordinates of a box in which polynomials are stored.

use glam::DVec3;

/// Coordinates from −1 to 1 across a box: t = (p − middle)·scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Local {
    pub(crate) middle: DVec3,
    pub(crate) scale: DVec3,
}

impl Local {
    pub(crate) fn coordinates(&self, p: DVec3) -> DVec3 {
        (p - self.middle) * self.scale
    }

    /// Converts a batch of points.
    #[inline(always)]
    pub(crate) fn lanes(&self, p: &[Lane; 3]) -> [Lane; 3] {
        let (middle, scale) = (self.middle.to_array(), self.scale.to_array());
        std::array::from_fn(|k| std::array::from_fn(|i| (p[k][i] - middle[k]) * scale[k]))
    }
}

/// Number of points in a batch: two AVX registers of four, or four SSE2 registers of two.
pub(crate) const WIDTH: usize = 8;

/// One coordinate for each point of a batch.
pub(crate) type Lane = [f64; WIDTH];
