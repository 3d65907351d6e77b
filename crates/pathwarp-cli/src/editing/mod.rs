//! Drawings in the editor: what `pathwarp-editor` needs from the command line.

mod artwork;
mod host;

pub(crate) use host::EditorHost;
