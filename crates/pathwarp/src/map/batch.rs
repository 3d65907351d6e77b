//! Fixed-width batches, the layout in which the refitter samples a map.
//!
//! [`Map::lanes`](super::Map::lanes) and [`Map::denominators`](super::Map::denominators) work on one batch: [`WIDTH`] points,
//! x and y in separate arrays, which the compiler turns into vector instructions. This layer is hidden from the documentation and
//! may change in any release: authors implement [`Map::point`](super::Map::point) or [`Map::points`](super::Map::points), from
//! which the default batches follow.

/// Points in a batch: two AVX registers of four, or four SSE2 registers of two.
pub const WIDTH: usize = 8;

/// One number for each point of a batch.
pub type Lane = [f64; WIDTH];
