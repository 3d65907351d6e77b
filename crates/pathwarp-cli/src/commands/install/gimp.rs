//! The plug-in for GIMP 3: a script with a copy of the program beside it.

use super::files::{Part, own_program, variable};
use crate::failure::Failure;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// The plug-in's source. GIMP 3 looks for `plug-ins/NAME/NAME.py`.
const PLUG_IN: &str = include_str!("../../../plug-ins/gimp/pathwarp-gimp.py");
const PLUG_IN_NAME: &str = "pathwarp-gimp";

/// The folder of the plug-in in a folder of plug-ins.
pub(super) fn home(folder: &Path) -> PathBuf {
    folder.join(PLUG_IN_NAME)
}

/// Names of the files, relative to the plug-in's folder: the script and the program.
pub(super) fn names() -> [PathBuf; 2] {
    let program = Path::new("bin").join("pathwarp").with_extension(env::consts::EXE_EXTENSION);
    [PathBuf::from(PLUG_IN_NAME).with_extension("py"), program]
}

/// The files, with names relative to the plug-in's folder.
pub(super) fn parts() -> Result<Vec<Part>, Failure> {
    let [script, program] = names();
    Ok(vec![
        Part { name: script, content: PLUG_IN.as_bytes().to_vec(), runs: true },
        Part { name: program, content: own_program()?, runs: true },
    ])
}

/// The plug-ins folders of all versions of GIMP 3 that this user has started.
pub(super) fn found() -> Vec<PathBuf> {
    if let Some(own) = env::var_os("GIMP3_DIRECTORY") {
        return vec![PathBuf::from(own).join("plug-ins")];
    }
    let home = variable("HOME").unwrap_or_default();
    let roots = if cfg!(target_os = "windows") {
        vec![variable("APPDATA").unwrap_or_default().join("GIMP")]
    } else if cfg!(target_os = "macos") {
        vec![home.join("Library/Application Support/GIMP")]
    } else {
        vec![
            variable("XDG_CONFIG_HOME").unwrap_or_else(|| home.join(".config")).join("GIMP"),
            home.join(".var/app/org.gimp.GIMP/config/GIMP"),
            home.join("snap/gimp/current/.config/GIMP"),
        ]
    };
    let mut out = Vec::new();
    for root in roots {
        for entry in fs::read_dir(&root).into_iter().flatten().flatten() {
            if entry.file_name().to_string_lossy().starts_with("3.") && entry.path().is_dir() {
                out.push(entry.path().join("plug-ins"));
            }
        }
    }
    out.sort();
    out
}
