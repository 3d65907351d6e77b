//! The program's commands, run in this process on files of a folder in memory.

use crate::SMALL;
use pathwarp::deform::Registry;
use std::ffi::OsString;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Files in memory where the system has a place for them.
const MEMORY: &str = "/dev/shm";

/// A drawing that every command can warp: curves, an arc, a stroke, a gradient and a group.
pub const DRAWING: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100' width='100' height='100'>\
<linearGradient id='l'><stop stop-color='red'/><stop offset='1'/></linearGradient>\
<g id='g'><path id='p' fill='url(#l)' d='M10 10C40 0 60 30 90 10V60A20 10 0 0 1 50 70L10 60Z'/></g>\
<path id='line' fill='none' stroke='#000' d='M5 90Q50 60 95 90'/></svg>";

/// A folder in which the program runs.
pub struct Program {
    folder: TempDir,
    registry: Registry,
}

impl Program {
    /// A folder that holds [`DRAWING`] as `in.svg`, and these files. The process changes into it.
    ///
    /// # Panics
    /// There is no room for the files.
    #[must_use]
    pub fn with(files: &[(&str, &[u8])]) -> Self {
        let place = Some(Path::new(MEMORY)).filter(|p| p.is_dir());
        let folder = place.map_or_else(TempDir::new, TempDir::new_in).expect("a folder");
        std::env::set_current_dir(folder.path()).expect("the folder");
        let it = Self { folder, registry: Registry::builtin() };
        it.write("in.svg", DRAWING.as_bytes());
        files.iter().for_each(|(name, content)| it.write(name, content));
        it
    }

    /// Writes a file.
    ///
    /// # Panics
    /// There is no room for it.
    pub fn write(&self, name: &str, content: &[u8]) {
        fs::write(self.folder.path().join(name), content).expect("room for a file");
    }

    /// Runs the program with these words and small limits. It must end without a panic and leave no temporary files.
    ///
    /// # Panics
    /// The promise is broken.
    pub fn run(&self, words: &[&str]) {
        let limits = SMALL.iter().flat_map(|(limit, most)| ["--limit".to_owned(), format!("{limit}={most}")]);
        let all = ["pathwarp"].iter().chain(words).map(OsString::from).chain(limits.map(OsString::from));
        let _ = pathwarp_cli::run(&self.registry, all);
        let left = fs::read_dir(self.folder.path()).expect("the folder").flatten();
        for file in left {
            let name = file.file_name();
            assert!(!name.to_string_lossy().starts_with('.'), "{} is left", name.display());
        }
    }
}
