//! Entries and faults of programs, remembered as long as their files stay the same, so that no program is started for a list.

use crate::fault::Fault;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

/// The version of the file. One of another version is written anew.
const VERSION: u32 = 1;

/// What is known about programs.
#[derive(Default)]
pub(crate) struct Remembered {
    file: Option<PathBuf>,
    data: Data,
    changed: bool,
}

#[derive(Default, Serialize, Deserialize)]
struct Data {
    version: u32,
    programs: BTreeMap<String, Known>,
}

/// A program with the state of its file.
#[derive(Serialize, Deserialize)]
struct Known {
    stamp: Stamp,
    entry: Result<String, Fault>,
}

/// Time of the last change in nanoseconds, size, and permissions.
#[derive(Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
struct Stamp(u128, u64, u32);

impl Stamp {
    fn of(path: &Path) -> Option<Self> {
        let meta = path.metadata().ok()?;
        #[cfg(unix)]
        let mode = std::os::unix::fs::PermissionsExt::mode(&meta.permissions());
        #[cfg(not(unix))]
        let mode = 0;
        Some(Self(meta.modified().ok()?.duration_since(UNIX_EPOCH).ok()?.as_nanos(), meta.len(), mode))
    }
}

impl Remembered {
    /// Reads the file. One that is missing or damaged is an empty one.
    pub(crate) fn read(file: Option<PathBuf>) -> Self {
        let read = |f: &PathBuf| serde_json::from_slice(&std::fs::read(f).ok()?).ok();
        let data = file.as_ref().and_then(read).filter(|d: &Data| d.version == VERSION);
        let data = data.unwrap_or(Data { version: VERSION, programs: BTreeMap::new() });
        Self { file, data, changed: false }
    }

    /// The entry of a program, or its fault, if its file has not changed.
    pub(crate) fn get(&self, path: &Path) -> Option<Result<&str, &Fault>> {
        let known = self.data.programs.get(path.to_str()?)?;
        (Stamp::of(path)? == known.stamp).then_some(known.entry.as_deref())
    }

    /// Remembers an entry or a fault.
    pub(crate) fn set(&mut self, path: &Path, entry: Result<&str, &Fault>) {
        // That says nothing about the program.
        if entry == Err(&Fault::Nested) {
            return;
        }
        let (Some(name), Some(stamp)) = (path.to_str(), Stamp::of(path)) else { return };
        let entry = entry.map(ToOwned::to_owned).map_err(Clone::clone);
        self.data.programs.insert(name.to_owned(), Known { stamp, entry });
        self.data.programs.retain(|name, _| Path::new(name).exists());
        self.changed = true;
    }

    /// Writes the file if something is new. If that fails, programs are started again next time.
    pub(crate) fn write(&self) {
        let Some((file, folder)) = self.file.as_ref().filter(|_| self.changed).and_then(|f| Some((f, f.parent()?)))
        else {
            return;
        };
        let write = || -> std::io::Result<()> {
            std::fs::create_dir_all(folder)?;
            let mut temporary = tempfile::NamedTempFile::new_in(folder)?;
            temporary.write_all(&serde_json::to_vec(&self.data)?)?;
            temporary.persist(file)?;
            Ok(())
        };
        let _ = write();
    }
}
