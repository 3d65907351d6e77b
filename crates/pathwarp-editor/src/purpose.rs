//! The destination of an edit: files, or a program that waits for the steps.

use std::path::PathBuf;

/// The use of the steps once they are chosen.
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
