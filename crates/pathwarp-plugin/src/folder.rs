//! Finds the plug-ins in the user's folder, and caches their entries.

use crate::deformation::Plugin;
use crate::entry::Reserved;
use crate::fault::Fault;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::env;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

/// Environment variable that sets the folder of plug-ins.
pub const FOLDER_VARIABLE: &str = "PATHWARP_PLUGINS";

/// Prefix of the file names of plug-ins.
const PREFIX: &str = "pathwarp-";

/// The plug-ins that were found.
#[derive(Debug, Default)]
pub struct Found {
    /// Usable plug-ins, sorted by name.
    pub plugins: Vec<Plugin>,
    /// Programs that cannot be used.
    pub broken: Vec<Broken>,
}

/// A program that cannot be used.
#[derive(Debug, Clone, PartialEq)]
pub struct Broken {
    /// The plug-in's name, taken from the name of its file.
    pub name: String,
    /// The file.
    pub path: PathBuf,
    /// The reason.
    pub fault: Fault,
}

/// Returns the user's folder of plug-ins.
#[must_use]
pub fn folder() -> Option<PathBuf> {
    let given = env::var_os(FOLDER_VARIABLE).filter(|f| !f.is_empty());
    given.map(PathBuf::from).or_else(|| Some(user_folder("XDG_DATA_HOME", ".local/share", "APPDATA")?.join("plug-ins")))
}

/// Returns the file that caches entries.
fn cache_file() -> Option<PathBuf> {
    let folder = if cfg!(target_os = "macos") {
        PathBuf::from(env::var_os("HOME")?).join("Library/Caches/pathwarp")
    } else {
        user_folder("XDG_CACHE_HOME", ".cache", "LOCALAPPDATA")?
    };
    Some(folder.join("plug-ins.json"))
}

/// Returns pathwarp's folder in one of the user's folders, which these variables name, or a path below the home folder.
fn user_folder(xdg: &str, below_home: &str, windows: &str) -> Option<PathBuf> {
    let var = |name: &str| env::var_os(name).filter(|v| !v.is_empty()).map(PathBuf::from);
    let base = if cfg!(target_os = "windows") {
        var(windows)?
    } else if cfg!(target_os = "macos") {
        var("HOME")?.join("Library/Application Support")
    } else {
        var(xdg).filter(|p| p.is_absolute()).or_else(|| Some(var("HOME")?.join(below_home)))?
    };
    Some(base.join("pathwarp"))
}

/// Returns the name of the plug-in in the file `path`, `pathwarp-NAME` with any extension; on Windows, with that of an executable.
#[must_use]
pub fn name_of(path: &Path) -> Option<String> {
    if cfg!(target_os = "windows") {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        if !["exe", "com", "bat", "cmd"].contains(&extension.as_str()) {
            return None;
        }
    }
    let name = path.file_stem()?.to_str()?.strip_prefix(PREFIX)?;
    (!name.is_empty()).then(|| name.to_owned())
}

/// Finds the plug-ins in the user's folder. A program is started only if its file is new or has changed, or if its name is `afresh`;
/// otherwise its entry, or its fault, comes from a cache.
#[must_use]
pub fn installed(reserved: Reserved<'_>, afresh: Option<&str>) -> Found {
    let mut found = Found::default();
    let Some(folder) = folder() else { return found };
    let Ok(files) = std::fs::read_dir(&folder) else { return found };
    let mut files: Vec<PathBuf> = files.flatten().map(|f| f.path()).filter(|p| name_of(p).is_some()).collect();
    if files.is_empty() {
        return found;
    }
    files.sort();
    let mut cache = Cache::read(cache_file());
    for path in files {
        let Some(name) = name_of(&path) else { continue };
        let path = path.canonicalize().unwrap_or(path);
        if path.is_dir() {
            continue;
        }
        let plugin = match cache.get(&path).filter(|_| afresh != Some(name.as_str())) {
            Some(Ok(entry)) => Plugin::known(&path, entry, reserved),
            Some(Err(fault)) => Err(fault.clone()),
            None => {
                let started = Plugin::start(&path, reserved);
                cache.set(&path, started.as_ref().map(|(_, text)| text.as_str()));
                started.map(|(plugin, _)| plugin)
            }
        };
        found.add(name, path, plugin);
    }
    cache.write();
    found
}

/// Starts the plug-in in one file, which may be in any folder.
///
/// # Errors
/// A [`Fault`], such as [`Fault::NoFile`], when the plug-in cannot be used.
pub fn by_file(path: &Path, reserved: Reserved<'_>) -> Result<Plugin, Fault> {
    Plugin::start(path, reserved).map(|(plugin, _)| plugin)
}

impl Found {
    fn add(&mut self, name: String, path: PathBuf, plugin: Result<Plugin, Fault>) {
        use pathwarp::deform::Deformation;
        let fault = match plugin {
            Ok(p) if p.info().name != name => {
                Fault::Entry(format!("its name is `{}`, but that of its file pathwarp-{name}", p.info().name))
            }
            Ok(p) if self.plugins.iter().any(|q| q.info().name == name) => {
                Fault::NameTaken(format!("{name}, which {} has, too", p.path().display()))
            }
            Ok(p) => return self.plugins.push(p),
            Err(fault) => fault,
        };
        self.broken.push(Broken { name, path, fault });
    }
}

/// The version of the cache file. A file of another version is replaced.
const VERSION: u32 = 1;

/// Caches the entries and faults of programs.
#[derive(Default)]
struct Cache {
    file: Option<PathBuf>,
    data: Data,
    changed: bool,
}

#[derive(Default, Serialize, Deserialize)]
struct Data {
    version: u32,
    programs: BTreeMap<String, Known>,
}

/// The entry or fault of a program, with the state of its file.
#[derive(Serialize, Deserialize)]
struct Known {
    stamp: Stamp,
    entry: Result<String, Fault>,
}

/// Time of the last change in nanoseconds, size in bytes, and permissions.
#[derive(Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
struct Stamp(u128, u64, u32);

impl Stamp {
    fn from_file(path: &Path) -> Option<Self> {
        let meta = path.metadata().ok()?;
        #[cfg(unix)]
        let mode = std::os::unix::fs::PermissionsExt::mode(&meta.permissions());
        #[cfg(not(unix))]
        let mode = 0;
        Some(Self(meta.modified().ok()?.duration_since(UNIX_EPOCH).ok()?.as_nanos(), meta.len(), mode))
    }
}

impl Cache {
    /// Reads the cache. A file that is missing or damaged counts as empty.
    fn read(file: Option<PathBuf>) -> Self {
        let read = |f: &PathBuf| serde_json::from_slice(&std::fs::read(f).ok()?).ok();
        let data = file.as_ref().and_then(read).filter(|d: &Data| d.version == VERSION);
        let data = data.unwrap_or(Data { version: VERSION, programs: BTreeMap::new() });
        Self { file, data, changed: false }
    }

    /// Returns the entry or fault of a program if its file has not changed.
    fn get(&self, path: &Path) -> Option<Result<&str, &Fault>> {
        let known = self.data.programs.get(path.to_str()?)?;
        (Stamp::from_file(path)? == known.stamp).then_some(known.entry.as_deref())
    }

    /// Stores an entry or a fault.
    fn set(&mut self, path: &Path, entry: Result<&str, &Fault>) {
        // The program is not to blame for having been called by a plug-in.
        if entry == Err(&Fault::Nested) {
            return;
        }
        let (Some(name), Some(stamp)) = (path.to_str(), Stamp::from_file(path)) else { return };
        let entry = entry.map(ToOwned::to_owned).map_err(Clone::clone);
        self.data.programs.insert(name.to_owned(), Known { stamp, entry });
        self.data.programs.retain(|name, _| Path::new(name).exists());
        self.changed = true;
    }

    /// Writes the file if anything has changed. If that fails, programs are started again next time.
    fn write(&self) {
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
