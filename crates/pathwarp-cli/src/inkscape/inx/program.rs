//! The program that the descriptions name.

/// The command that the descriptions name: a file beside them, a program on the search path, or a path.
pub(crate) struct Program {
    /// `inx`, `path` or `absolute`.
    pub(crate) location: &'static str,
    pub(crate) name: String,
}
