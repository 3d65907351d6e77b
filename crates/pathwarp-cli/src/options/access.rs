//! What a run may do for its inputs: how much work, and which files it may read besides those named.

use pathwarp::budget::Limits;

/// Limits on work, and the permission to read linked files.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Access {
    /// Limits on the work that an input may cause.
    pub(crate) limits: Limits,
    /// Read linked files from anywhere, not only beside the input.
    pub(crate) external: bool,
}
