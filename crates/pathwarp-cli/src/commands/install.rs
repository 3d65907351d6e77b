//! `pathwarp install gimp`: installs the plug-in, with a copy of this program, in GIMP 3's folder.

use crate::failure::Failure;
use crate::output::{self, PendingFile};
use crate::status::Status;
use crate::terminal;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use std::env;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// The plug-in's source. GIMP 3 looks for `plug-ins/NAME/NAME.py`.
const PLUG_IN: &str = include_str!("../../plug-ins/gimp/pathwarp-gimp.py");
const PLUG_IN_NAME: &str = "pathwarp-gimp";

pub(super) const NAME: &str = "install";

pub(super) fn command() -> Command {
    let flag = |name: &'static str, help: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue).help(help);
    Command::new(NAME)
        .about("Install the plug-in for another program")
        .arg(Arg::new("WHAT").required(true).value_parser(["gimp"]).help("gimp: the plug-in for GIMP 3"))
        .arg(
            Arg::new("dir")
                .long("dir")
                .value_name("DIR")
                .value_parser(value_parser!(PathBuf))
                .help("GIMP's plug-ins folder (Edit > Preferences > Folders > Plug-ins) [default: that of every GIMP 3 found]"),
        )
        .arg(flag("uninstall", "Remove the plug-in"))
        .arg(flag("dry-run", "Print the changes without making them"))
        .after_help("Examples:\n  pathwarp install gimp\n  pathwarp install gimp --dry-run\n  pathwarp install gimp --uninstall")
}

pub(super) fn run(m: &ArgMatches) -> Result<Status, Failure> {
    let folders = match m.get_one::<PathBuf>("dir") {
        Some(d) => vec![d.clone()],
        None => found(),
    };
    if folders.is_empty() {
        return Err(Failure::usage(
            "found no folder of GIMP 3; start GIMP 3 once, or name its plug-ins folder with --dir",
        ));
    }
    let dry = m.get_flag("dry-run");
    let mut done = String::new();
    for folder in folders {
        let home = folder.join(PLUG_IN_NAME);
        let script = home.join(PLUG_IN_NAME).with_extension("py");
        let program = home.join("bin").join("pathwarp").with_extension(env::consts::EXE_EXTENSION);
        if m.get_flag("uninstall") {
            done += &uninstall(&home, &[&script, &program], dry)?;
        } else {
            for f in [&script, &program] {
                let _ = writeln!(done, "{} {}", if dry { "would write" } else { "wrote" }, f.display());
            }
            if !dry {
                install(&script, &program)?;
            }
        }
    }
    output::to_stdout(done.as_bytes())?;
    Ok(Status::Complete)
}

/// Removes the files that exist, and the folders if nothing else is in them. Returns a line for each file.
fn uninstall(home: &Path, files: &[&PathBuf], dry: bool) -> Result<String, Failure> {
    let mut done = String::new();
    let existing: Vec<&&PathBuf> = files.iter().filter(|f| f.exists()).collect();
    if existing.is_empty() {
        terminal::note(&format!("{} is not installed", home.display()));
    }
    for f in existing {
        let _ = writeln!(done, "{} {}", if dry { "would remove" } else { "removed" }, f.display());
        if !dry {
            fs::remove_file(f).map_err(|e| Failure::output(f, format!("cannot be removed: {e}")))?;
        }
    }
    if !dry {
        // A folder that holds other files stays.
        let _ = fs::remove_dir(home.join("bin"));
        let _ = fs::remove_dir(home);
    }
    Ok(done)
}

fn install(script: &Path, program: &Path) -> Result<(), Failure> {
    let own = env::current_exe().and_then(fs::read);
    let own = own.map_err(|e| Failure::Input(format!("the program file cannot be read: {e}")))?;
    let folder = program.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder).map_err(|e| Failure::output(folder, format!("cannot be created: {e}")))?;
    PendingFile::commit_all(vec![PendingFile::new(script, PLUG_IN.as_bytes())?, PendingFile::new(program, &own)?])?;
    #[cfg(unix)]
    for f in [script, program] {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(f, fs::Permissions::from_mode(0o755)).map_err(|e| Failure::output(f, e))?;
    }
    Ok(())
}

/// The plug-ins folders of all versions of GIMP 3 that this user has started.
fn found() -> Vec<PathBuf> {
    if let Some(own) = env::var_os("GIMP3_DIRECTORY") {
        return vec![PathBuf::from(own).join("plug-ins")];
    }
    let var = |name: &str| env::var_os(name).map(PathBuf::from);
    let home = var("HOME").unwrap_or_default();
    let roots = if cfg!(target_os = "windows") {
        vec![var("APPDATA").unwrap_or_default().join("GIMP")]
    } else if cfg!(target_os = "macos") {
        vec![home.join("Library/Application Support/GIMP")]
    } else {
        vec![
            var("XDG_CONFIG_HOME").unwrap_or_else(|| home.join(".config")).join("GIMP"),
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
