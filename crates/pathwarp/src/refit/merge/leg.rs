//! A step on the way through a run.

/// A step between two grid places.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Leg {
    pub(super) from: usize,
    pub(super) to: usize,
    /// By one cubic; otherwise by the pieces of one segment.
    pub(super) merged: bool,
}
