//! The folder of plug-ins.

use crate::deformation::Plugin;
use crate::entry::Reserved;
use crate::fault::Fault;
use crate::remembered::Remembered;
use std::env;
use std::path::{Path, PathBuf};

/// Environment variable for another folder.
pub const FOLDER_VARIABLE: &str = "PATHWARP_PLUGINS";

/// What the names of programs begin with.
const PREFIX: &str = "pathwarp-";

/// The plug-ins that were found.
#[derive(Debug, Default)]
pub struct Found {
    /// Those that can be used, by name.
    pub plugins: Vec<Plugin>,
    /// Those that cannot.
    pub broken: Vec<Broken>,
}

/// A program that cannot be used.
#[derive(Debug, Clone, PartialEq)]
pub struct Broken {
    /// The name by its file.
    pub name: String,
    /// The file.
    pub path: PathBuf,
    /// The reason.
    pub fault: Fault,
}

/// The user's folder of plug-ins.
#[must_use]
pub fn folder() -> Option<PathBuf> {
    let given = env::var_os(FOLDER_VARIABLE).filter(|f| !f.is_empty());
    given.map(PathBuf::from).or_else(|| Some(of_user("XDG_DATA_HOME", ".local/share", "APPDATA")?.join("plug-ins")))
}

/// The file that remembers entries.
fn memory() -> Option<PathBuf> {
    let folder = if cfg!(target_os = "macos") {
        PathBuf::from(env::var_os("HOME")?).join("Library/Caches/pathwarp")
    } else {
        of_user("XDG_CACHE_HOME", ".cache", "LOCALAPPDATA")?
    };
    Some(folder.join("plug-ins.json"))
}

/// This program's own folder in one of the user's folders.
fn of_user(xdg: &str, below_home: &str, windows: &str) -> Option<PathBuf> {
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

/// The name of the plug-in in the file `path`, `pathwarp-NAME` with any extension; on Windows with one of those that can be started.
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

/// The plug-ins of the user's folder. A program is started only if its file is new or has changed, or if it is called `afresh`:
/// otherwise its entry, or its fault, is remembered.
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
    let mut memory = Remembered::read(memory());
    for path in files {
        let Some(name) = name_of(&path) else { continue };
        let path = path.canonicalize().unwrap_or(path);
        if path.is_dir() {
            continue;
        }
        let plugin = match memory.get(&path).filter(|_| afresh != Some(name.as_str())) {
            Some(Ok(entry)) => Plugin::known(&path, entry, reserved),
            Some(Err(fault)) => Err(fault.clone()),
            None => {
                let started = Plugin::start(&path, reserved);
                memory.set(&path, started.as_ref().map(|(_, text)| text.as_str()));
                started.map(|(plugin, _)| plugin)
            }
        };
        found.add(name, path, plugin);
    }
    memory.write();
    found
}

/// The program in one file, wherever it lies.
///
/// # Errors
/// It cannot be used.
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
