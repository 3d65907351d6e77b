//! What the editing is for.

use std::path::PathBuf;

/// What becomes of the steps.
#[derive(Debug, Clone)]
pub enum Purpose {
    /// Results are saved to files; `out` is the one that *Save* writes, `None` a name beside the drawing.
    Files {
        /// The file that *Save* writes.
        out: Option<PathBuf>,
    },
    /// A program waits for the steps, and nothing is written. Without a page, it would wait in vain, so that is an error.
    Program {
        /// Its name.
        name: String,
        /// The drawing's name there.
        drawing: String,
    },
}

impl Purpose {
    /// The program that waits.
    pub(crate) fn program(&self) -> Option<&str> {
        if let Self::Program { name, .. } = self { Some(name) } else { None }
    }
}
