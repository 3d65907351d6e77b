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
        let embedding = Relinking { embed: true, ..Relinking::default() };
        match (self, &read.base_dir) {
            (Self::Back, _) | (_, None) => Relinking::default(),
            (Self::File(to), Some(folder)) => {
                link_to_folder(folder, to).map_or(embedding, |way| Relinking { way, embed: false })
            }
            (Self::Anywhere, _) => embedding,
        }
    }
}

/// Returns the relative path to a folder from a file, as the beginning of a link, if there is one.
fn link_to_folder(folder: &Path, file: &Path) -> Option<String> {
    let absolute = |folder: &Path| {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        fs::canonicalize(folder).or_else(|_| std::path::absolute(folder)).ok()
    };
    let (to, from): (PathBuf, PathBuf) = (absolute(folder)?, absolute(file.parent()?)?);
    let shared = to.components().zip(from.components()).take_while(|(a, b)| a == b).count();
    // On Windows, folders on different drives share nothing.
    if shared == 0 {
        return None;
    }
    let mut out = "../".repeat(from.components().count() - shared);
    for part in to.components().skip(shared) {
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
    fn links_lead_from_a_file_to_a_folder() {
        let dir = tempfile::tempdir().unwrap();
        let path = |name: &str| dir.path().join(name);
        for name in ["in put", "out/deep"] {
            fs::create_dir_all(path(name)).unwrap();
        }
        let link = |folder: &str, file: &str| link_to_folder(&path(folder), &path(file)).unwrap();
        assert_eq!(link("in put", "out/deep/b.svg"), "../../in%20put/");
        assert_eq!(link("in put", "in put/b.svg"), "");
        assert_eq!(link("out/deep", "b.svg"), "out/deep/");
    }
}
