//! The extension for Inkscape: a description of every dialog, with a copy of the program beside them.

use super::files::{Part, own_program, variable};
use crate::failure::Failure;
use crate::inkscape::inx::{Program, files};
use pathwarp::deform::Registry;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The folder in Inkscape's folder of extensions.
const HOME: &str = "pathwarp";

/// The folder of the extension in a folder of extensions.
pub(super) fn home(folder: &Path) -> PathBuf {
    folder.join(HOME)
}

/// The files, with names relative to the extension's folder. `program` is called instead of a copy of this one if it is given: a name
/// on the search path, or a path.
pub(super) fn parts(registry: &Registry, program: Option<&Path>) -> Result<Vec<Part>, Failure> {
    let copy = Path::new("pathwarp").with_extension(env::consts::EXE_EXTENSION);
    let name = program.unwrap_or(&copy).display().to_string();
    let location = match program {
        None => "inx",
        Some(p) if p.is_absolute() => "absolute",
        Some(p) if p.components().count() == 1 => "path",
        Some(p) => return Err(Failure::usage(format!("--program {}: give an absolute path or a name", p.display()))),
    };
    let descriptions = files(registry, &Program { location, name });
    let part = |(name, text): (String, String)| Part { name: name.into(), content: text.into_bytes(), runs: false };
    let mut parts: Vec<Part> = descriptions.into_iter().map(part).collect();
    if program.is_none() {
        parts.push(Part { name: copy, content: own_program()?, runs: true });
    }
    Ok(parts)
}

/// The files that [`parts`] may have written, by this or another version of the program.
pub(super) fn installed(home: &Path) -> Vec<PathBuf> {
    let is_ours = |name: &Path| {
        let name = name.to_string_lossy();
        name.starts_with("pathwarp-") && name.ends_with(".inx") || name == "pathwarp" || name == "pathwarp.exe"
    };
    let entries = fs::read_dir(home).into_iter().flatten().flatten();
    let mut names: Vec<PathBuf> = entries.map(|e| PathBuf::from(e.file_name())).filter(|n| is_ours(n)).collect();
    names.sort();
    names
}

/// The extensions folders of every Inkscape that this user has.
pub(super) fn found() -> Vec<PathBuf> {
    if let Some(own) = variable("INKSCAPE_PROFILE_DIR") {
        return vec![own.join("extensions")];
    }
    let home = variable("HOME").unwrap_or_default();
    let roots = if cfg!(target_os = "windows") {
        vec![variable("APPDATA").unwrap_or_default().join("inkscape")]
    } else if cfg!(target_os = "macos") {
        vec![
            home.join("Library/Application Support/org.inkscape.Inkscape/config/inkscape"),
            home.join(".config/inkscape"),
        ]
    } else {
        vec![
            variable("XDG_CONFIG_HOME").unwrap_or_else(|| home.join(".config")).join("inkscape"),
            home.join(".var/app/org.inkscape.Inkscape/config/inkscape"),
            home.join("snap/inkscape/current/.config/inkscape"),
        ]
    };
    let mut found: Vec<PathBuf> = roots.into_iter().filter(|r| r.is_dir()).collect();
    if found.is_empty() {
        // Inkscape is installed but was never started.
        let mut ask = Command::new("inkscape");
        let answer = ask.arg("--user-data-directory").stdin(Stdio::null()).stderr(Stdio::null()).output().ok();
        let folder = answer.and_then(|a| String::from_utf8(a.stdout).ok()).map(|t| PathBuf::from(t.trim()));
        found.extend(folder.filter(|f| f.is_absolute()));
    }
    found.into_iter().map(|r| r.join("extensions")).collect()
}
