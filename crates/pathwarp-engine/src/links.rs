//! Links of a drawing to files: where the drawing goes, they are rewritten to lead to the same files, or pictures are embedded.

use crate::failure::Failure;
use crate::output::is_stream;
use pathwarp_svg::engine::Relinking;
use pathwarp_svg::{Document, ReadOptions};
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Where a drawing goes.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum Destination {
    /// Back to the input: links stay as they are.
    #[default]
    Back,
    /// To a file: relative links lead from its folder.
    File(PathBuf),
    /// To an unknown folder, as with standard output: pictures are embedded.
    Anywhere,
}

impl Destination {
    /// Returns the destination of an output; `None` is standard output.
    pub fn of(target: Option<&Path>) -> Self {
        target.filter(|to| !is_stream(to)).map_or(Self::Anywhere, |to| Self::File(to.to_owned()))
    }

    /// Rewrites the links of a result for its destination. `read` tells where they lead now, and what may be read.
    ///
    /// # Errors
    /// [`Failure::Library`] if the embedded pictures exceed the limits.
    pub fn linked(&self, svg: String, read: &ReadOptions) -> Result<String, Failure> {
        Ok(self.relinking(read).of(&svg, read)?.unwrap_or(svg))
    }

    /// Returns the source of a result, to be stored in it. Pictures that could not be read from the destination are embedded.
    pub(crate) fn source(&self, document: &Document, read: &ReadOptions) -> Result<Vec<u8>, Failure> {
        let mut relinking = self.relinking(read);
        relinking.embed |= relinking.way.starts_with("..");
        let new = relinking.of(&document.decoded(), read)?;
        Ok(new.map_or_else(|| document.source().to_vec(), String::into_bytes))
    }

    fn relinking(&self, read: &ReadOptions) -> Relinking {
        let inside = Relinking { embed: true, ..Relinking::default() };
        match (self, &read.base_dir) {
            (Self::Back, _) | (_, None) => Relinking::default(),
            (Self::File(to), Some(from)) => way(from, to).map_or(inside, |way| Relinking { way, embed: false }),
            (Self::Anywhere, _) => inside,
        }
    }
}

/// Returns the relative path from a file to a folder, as the beginning of a link, if there is one.
fn way(from: &Path, file: &Path) -> Option<String> {
    let full = |folder: &Path| {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        fs::canonicalize(folder).or_else(|_| std::path::absolute(folder)).ok()
    };
    let (from, to): (PathBuf, PathBuf) = (full(from)?, full(file.parent()?)?);
    let shared = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        return None;
    }
    let mut out = "../".repeat(to.components().count() - shared);
    for part in from.components().skip(shared) {
        let Component::Normal(name) = part else { return None };
        for b in name.to_str()?.bytes() {
            // Other characters may end a link, or begin its query or fragment.
            if b.is_ascii_alphanumeric() || b"-_.~+@,=!$*".contains(&b) {
                out.push(char::from(b));
            } else {
                out.push_str(&format!("%{b:02X}"));
            }
        }
        out.push('/');
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_lead_from_folder_to_folder() {
        let dir = tempfile::tempdir().unwrap();
        let at = |name: &str| dir.path().join(name);
        for name in ["in put", "out/deep"] {
            fs::create_dir_all(at(name)).unwrap();
        }
        let found = |from: &str, to: &str| way(&at(from), &at(to)).unwrap();
        assert_eq!(found("in put", "out/deep/b.svg"), "../../in%20put/");
        assert_eq!(found("in put", "in put/b.svg"), "");
        assert_eq!(found("out/deep", "b.svg"), "out/deep/");
    }
}
