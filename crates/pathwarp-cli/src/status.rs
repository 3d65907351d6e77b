//! The status of a run that did not fail.

/// The result of a run that did not fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Status {
    /// Everything was done.
    Complete,
    /// Something was left unchanged or missed the tolerance, or a comparison exceeded its limit.
    Partial,
}

impl Status {
    /// Returns `Partial` if `partial`, else `Complete`.
    pub(crate) fn partial_if(partial: bool) -> Self {
        if partial { Self::Partial } else { Self::Complete }
    }
}
