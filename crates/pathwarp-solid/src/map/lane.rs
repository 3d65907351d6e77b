//! One number for each point of a batch.

/// Points in a batch: two AVX registers of four, or four SSE2 registers of two.
pub(crate) const WIDTH: usize = 8;

/// A coordinate of each point of a batch.
pub(crate) type Lane = [f64; WIDTH];
