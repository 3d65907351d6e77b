//! The size limit for pictures.

/// Largest picture that this crate makes or reads, in pixels: 2^28, one gibibyte of memory.
///
/// A larger picture is almost always the result of a wrong unit, and would fail later for lack of memory.
pub const MAX_PIXELS: u32 = 1 << 28;
