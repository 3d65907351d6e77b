//! `pathwarp install gimp|inkscape`: installs the plug-in, with a copy of this program, in another program's folder.

use crate::commands::args::{option, switch};
use crate::ending::Status;
use crate::inkscape::inx::{self, Program};
use crate::terminal;
use clap::{Arg, ArgMatches, Command, value_parser};
use pathwarp::deform::Registry;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::output::{self, PendingFile};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{self, Stdio};
use std::{env, fs};

pub(super) fn install_command() -> Command {
    let path = |name, value, help| option(name, value, help).value_parser(value_parser!(PathBuf));
    Command::new("install")
        .about("Install the plug-in for another program")
        .arg(
            Arg::new("WHAT")
                .required(true)
                .value_parser(["gimp", "inkscape"])
                .help("gimp: the plug-in for GIMP 3; inkscape: a dialog for every deformation"),
        )
        .arg(
            path(
                "dir",
                "DIR",
                "The program's folder of plug-ins or extensions (Preferences > Folders > Plug-ins in GIMP, Preferences > System > \
                 User extensions in Inkscape) [default: that of every one found]",
            )
            .visible_alias("folder"),
        )
        .arg(path(
            "program",
            "PATH",
            "For Inkscape: call this program, by its name on the search path or an absolute path, instead of a copy of this one",
        ))
        .arg(switch("uninstall", "Remove the plug-in").visible_alias("remove"))
        .arg(switch("dry-run", "Print the changes without making them"))
        .after_help(
            "Examples:\n  pathwarp install gimp\n  pathwarp install inkscape\n  pathwarp install inkscape --dry-run\n  pathwarp install \
             inkscape --uninstall\n  pathwarp install inkscape --folder pkg/usr/share/inkscape/extensions --program pathwarp   # for a package",
        )
}

pub(super) fn install(registry: &Registry, m: &ArgMatches) -> Result<Status, Failure> {
    let is_gimp = m.get_one::<String>("WHAT").is_some_and(|w| w == "gimp");
    let program = m.get_one::<PathBuf>("program").map(PathBuf::as_path);
    if is_gimp && program.is_some() {
        return Err(Failure::usage("--program is for Inkscape; the plug-in for GIMP has its own copy"));
    }
    let folders = match m.get_one::<PathBuf>("dir") {
        Some(d) => vec![d.clone()],
        None if is_gimp => gimp_folders(),
        None => inkscape_folders(),
    };
    if folders.is_empty() {
        let what =
            if is_gimp { "GIMP 3; start GIMP 3 once, or name its plug-ins" } else { "Inkscape; name its extensions" };
        return Err(Failure::usage(format!("found no folder of {what} folder with --dir")));
    }
    let parts = || if is_gimp { gimp_parts() } else { inkscape_parts(registry, program) };
    let is_dry = m.get_flag("dry-run");
    let mut lines = String::new();
    for folder in folders {
        let plug_in_folder = folder.join(if is_gimp { GIMP_PLUG_IN } else { INKSCAPE_EXTENSION });
        lines += &if m.get_flag("uninstall") {
            let names = if is_gimp { gimp_names().to_vec() } else { inkscape_installed(&plug_in_folder) };
            uninstall_files(&plug_in_folder, &names, is_dry)?
        } else {
            install_files(&plug_in_folder, &parts()?, is_dry)?
        };
    }
    output::to_stdout(lines.as_bytes())?;
    Ok(Status::Complete)
}

/// A file to install.
pub(super) struct Part {
    /// Path relative to the plug-in's folder.
    pub(super) name: PathBuf,
    pub(super) content: Vec<u8>,
    pub(super) is_executable: bool,
}

/// Reads this program's executable file.
fn this_program() -> Result<Vec<u8>, Failure> {
    let program = env::current_exe().and_then(fs::read);
    program.map_err(|e| Failure::Input(format!("the program file cannot be read: {e}")))
}

/// Returns a path from an environment variable.
fn variable(name: &str) -> Option<PathBuf> {
    env::var_os(name).filter(|v| !v.is_empty()).map(PathBuf::from)
}

/// Writes the files below `plug_in_folder`. Returns a line for each.
pub(super) fn install_files(plug_in_folder: &Path, parts: &[Part], is_dry: bool) -> Result<String, Failure> {
    let mut lines = String::new();
    let mut pending = Vec::new();
    for part in parts {
        let file = plug_in_folder.join(&part.name);
        let _ = writeln!(lines, "{} {}", if is_dry { "would write" } else { "wrote" }, file.display());
        if !is_dry {
            let folder = file.parent().unwrap_or(Path::new(""));
            fs::create_dir_all(folder).map_err(|e| Failure::output(folder, format!("cannot be created: {e}")))?;
            pending.push(PendingFile::new(&file, &part.content)?);
        }
    }
    PendingFile::commit_all(pending)?;
    #[cfg(unix)]
    for file in parts.iter().filter(|p| p.is_executable && !is_dry).map(|p| plug_in_folder.join(&p.name)) {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(&file, fs::Permissions::from_mode(0o755)).map_err(|e| Failure::output(&file, e))?;
    }
    Ok(lines)
}

/// Removes the files that exist, and folders that become empty. Returns a line for each file.
fn uninstall_files(plug_in_folder: &Path, names: &[PathBuf], is_dry: bool) -> Result<String, Failure> {
    let mut lines = String::new();
    let existing: Vec<PathBuf> = names.iter().map(|n| plug_in_folder.join(n)).filter(|f| f.exists()).collect();
    if existing.is_empty() {
        terminal::note(&format!("{} is not installed", plug_in_folder.display()));
    }
    for file in &existing {
        let _ = writeln!(lines, "{} {}", if is_dry { "would remove" } else { "removed" }, file.display());
        if !is_dry {
            fs::remove_file(file).map_err(|e| Failure::output(file, format!("cannot be removed: {e}")))?;
        }
    }
    if !is_dry {
        // Folders with other files stay.
        for folder in existing.iter().filter_map(|f| f.parent()).filter(|f| *f != plug_in_folder) {
            let _ = fs::remove_dir(folder);
        }
        let _ = fs::remove_dir(plug_in_folder);
    }
    Ok(lines)
}

/// Returns the folders where a program called `name` may keep its settings. On Linux it may also be installed by Flatpak, as `flatpak`,
/// or by Snap. `macos` lists its folders on macOS, relative to the user's home.
fn settings_folders(name: &str, flatpak: &str, macos: &[&str]) -> Vec<PathBuf> {
    let home = variable("HOME").unwrap_or_default();
    if cfg!(target_os = "windows") {
        return vec![variable("APPDATA").unwrap_or_default().join(name)];
    }
    if cfg!(target_os = "macos") {
        return macos.iter().map(|folder| home.join(folder)).collect();
    }
    let config = variable("XDG_CONFIG_HOME").unwrap_or_else(|| home.join(".config"));
    let of_flatpak = home.join(format!(".var/app/{flatpak}/config"));
    let of_snap = home.join(format!("snap/{}/current/.config", name.to_lowercase()));
    [config, of_flatpak, of_snap].map(|folder| folder.join(name)).to_vec()
}

/// The plug-in's source. GIMP 3 looks for `plug-ins/NAME/NAME.py`.
const PLUG_IN: &str = include_str!("../../plug-ins/gimp/pathwarp-gimp.py");
/// The plug-in's folder within GIMP's folder of plug-ins.
const GIMP_PLUG_IN: &str = "pathwarp-gimp";

/// Returns the paths of the script and the program, relative to the plug-in's folder.
fn gimp_names() -> [PathBuf; 2] {
    let program = Path::new("bin").join("pathwarp").with_extension(env::consts::EXE_EXTENSION);
    [PathBuf::from(GIMP_PLUG_IN).with_extension("py"), program]
}

/// Returns the files to install for GIMP.
fn gimp_parts() -> Result<Vec<Part>, Failure> {
    let [script, program] = gimp_names();
    Ok(vec![
        Part { name: script, content: PLUG_IN.as_bytes().to_vec(), is_executable: true },
        Part { name: program, content: this_program()?, is_executable: true },
    ])
}

/// Returns the plug-ins folders of all versions of GIMP 3 that this user has started.
fn gimp_folders() -> Vec<PathBuf> {
    if let Some(folder) = env::var_os("GIMP3_DIRECTORY") {
        return vec![PathBuf::from(folder).join("plug-ins")];
    }
    let roots = settings_folders("GIMP", "org.gimp.GIMP", &["Library/Application Support/GIMP"]);
    let entries = roots.iter().flat_map(|root| fs::read_dir(root).into_iter().flatten().flatten());
    let versions = entries.filter(|e| e.file_name().to_string_lossy().starts_with("3.") && e.path().is_dir());
    let mut out: Vec<PathBuf> = versions.map(|version| version.path().join("plug-ins")).collect();
    out.sort();
    out
}

/// The extension's folder within Inkscape's folder of extensions.
const INKSCAPE_EXTENSION: &str = "pathwarp";

/// Returns the files to install for Inkscape. The extension calls `program`, a name or path, or by default a copy of this program.
fn inkscape_parts(registry: &Registry, program: Option<&Path>) -> Result<Vec<Part>, Failure> {
    let copy = Path::new("pathwarp").with_extension(env::consts::EXE_EXTENSION);
    let name = program.unwrap_or(&copy).display().to_string();
    let location = match program {
        None => "inx",
        Some(p) if p.is_absolute() => "absolute",
        Some(p) if p.components().count() == 1 => "path",
        Some(p) => return Err(Failure::usage(format!("--program {}: give an absolute path or a name", p.display()))),
    };
    let descriptions = inx::files(registry, &Program { location, name });
    let part = |(name, text): (String, String)| {
        let content = text.into_bytes();
        Part { name: name.into(), content, is_executable: false }
    };
    let mut parts: Vec<Part> = descriptions.into_iter().map(part).collect();
    if program.is_none() {
        parts.push(Part { name: copy, content: this_program()?, is_executable: true });
    }
    Ok(parts)
}

/// Returns the files that [`inkscape_parts`] may have written, in this or another version of the program.
fn inkscape_installed(plug_in_folder: &Path) -> Vec<PathBuf> {
    let is_ours = |name: &Path| {
        let name = name.to_string_lossy();
        (name.starts_with("pathwarp-") && name.ends_with(".inx")) || name == "pathwarp" || name == "pathwarp.exe"
    };
    let entries = fs::read_dir(plug_in_folder).into_iter().flatten().flatten();
    let mut names: Vec<PathBuf> = entries.map(|e| PathBuf::from(e.file_name())).filter(|n| is_ours(n)).collect();
    names.sort();
    names
}

/// Returns the extensions folders of every Inkscape that this user has.
fn inkscape_folders() -> Vec<PathBuf> {
    if let Some(folder) = variable("INKSCAPE_PROFILE_DIR") {
        return vec![folder.join("extensions")];
    }
    let macos = ["Library/Application Support/org.inkscape.Inkscape/config/inkscape", ".config/inkscape"];
    let roots = settings_folders("inkscape", "org.inkscape.Inkscape", &macos);
    let mut found: Vec<PathBuf> = roots.into_iter().filter(|r| r.is_dir()).collect();
    if found.is_empty() {
        // Inkscape is installed, but the user has never started it.
        let mut ask = process::Command::new("inkscape");
        let answer = ask.arg("--user-data-directory").stdin(Stdio::null()).stderr(Stdio::null()).output().ok();
        let folder = answer.and_then(|a| String::from_utf8(a.stdout).ok()).map(|t| PathBuf::from(t.trim()));
        found.extend(folder.filter(|f| f.is_absolute()));
    }
    found.into_iter().map(|r| r.join("extensions")).collect()
}
