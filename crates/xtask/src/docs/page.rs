//! A page of commands: an introduction, then one entry per command with its picture.

use crate::chore::{ChoreError, at};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// A page of entries.
pub(super) struct CookbookPage {
    /// Path of the page from the workspace's root.
    pub(super) file: &'static str,
    /// Folder of its pictures, relative to the page.
    pub(super) pictures: &'static str,
    /// The title and everything above the entries.
    pub(super) intro: &'static str,
    pub(super) entries: &'static [CookbookEntry],
}

/// One command with its picture.
pub(super) struct CookbookEntry {
    /// File name of the picture without its extension, in kebab-case.
    pub(super) name: &'static str,
    pub(super) title: &'static str,
    /// One paragraph.
    pub(super) text: &'static str,
    /// The words after `pathwarp`, including `-o out.svg`. The command runs in the workspace's root.
    pub(super) command: &'static str,
}

impl CookbookPage {
    /// The folder of the pictures.
    pub(super) fn folder(&self, root: &Path) -> PathBuf {
        root.join("docs").join(self.pictures)
    }

    /// The picture of an entry.
    pub(super) fn picture(&self, root: &Path, entry: &CookbookEntry) -> PathBuf {
        self.folder(root).join(format!("{}.png", entry.name))
    }

    /// Writes the page and creates the folder of its pictures.
    pub(super) fn write(&self, root: &Path) -> Result<(), ChoreError> {
        let folder = self.folder(root);
        fs::create_dir_all(&folder).map_err(at(&folder))?;
        let file = root.join(self.file);
        fs::write(&file, self.text()).map_err(at(&file))
    }

    /// The page as Markdown.
    pub(super) fn text(&self) -> String {
        let mut out = String::from(self.intro);
        for CookbookEntry { name, title, text, command } in self.entries {
            let _ = write!(
                out,
                "\n## {title}\n\n![{title}]({}/{name}.png)\n\n{text}\n\n```sh\npathwarp {command}\n```\n",
                self.pictures
            );
        }
        out
    }
}
