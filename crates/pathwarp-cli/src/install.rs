//! `pathwarp install gimp`: the plug-in, with this program beside it, into GIMP 3's folder.

use crate::failure::Failure;
use crate::output::{self, Pending};
use crate::{Outcome, terminal};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use std::env;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// The plug-in. GIMP 3 looks for `plug-ins/NAME/NAME.py`.
const PLUG_IN: &str = include_str!("../../../integrations/gimp/pathwarp-gimp.py");
const NAME: &str = "pathwarp-gimp";

pub(crate) fn command() -> Command {
    let flag = |name: &'static str, help: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue).help(help);
    Command::new("install")
        .about("Put the plug-in for another program in its place")
        .arg(Arg::new("WHAT").required(true).value_parser(["gimp"]).help("gimp: the plug-in for GIMP 3"))
        .arg(
            Arg::new("dir")
                .long("dir")
                .value_name("DIR")
                .value_parser(value_parser!(PathBuf))
                .help("GIMP's plug-ins folder (Edit > Preferences > Folders > Plug-ins); default: that of every GIMP 3 found here"),
        )
        .arg(flag("uninstall", "Take it away again"))
        .arg(flag("dry-run", "Only say what would be done"))
        .after_help("Examples:\n  pathwarp install gimp\n  pathwarp install gimp --dry-run\n  pathwarp install gimp --uninstall")
}

pub(crate) fn run(m: &ArgMatches) -> Result<Outcome, Failure> {
    let folders = match m.get_one::<PathBuf>("dir") {
        Some(d) => vec![d.clone()],
        None => found(),
    };
    if folders.is_empty() {
        return Err(Failure::usage(
            "no folder of GIMP 3 was found; start GIMP 3 once, or name its plug-ins folder with --dir",
        ));
    }
    let dry = m.get_flag("dry-run");
    let mut said = String::new();
    for folder in folders {
        let home = folder.join(NAME);
        let script = home.join(NAME).with_extension("py");
        let program = home.join("bin").join("pathwarp").with_extension(env::consts::EXE_EXTENSION);
        // Writing to a String cannot fail.
        if m.get_flag("uninstall") {
            let there: Vec<&PathBuf> = [&script, &program].into_iter().filter(|f| f.exists()).collect();
            if there.is_empty() {
                terminal::note(&format!("{} is not there", home.display()));
            }
            for f in there {
                let _ = writeln!(said, "{} {}", if dry { "would remove" } else { "removed" }, f.display());
                if !dry {
                    fs::remove_file(f).map_err(|e| Failure::file(f, format!("cannot be removed: {e}")))?;
                }
            }
            if !dry {
                // What others have put there keeps its folder.
                let _ = fs::remove_dir(home.join("bin"));
                let _ = fs::remove_dir(&home);
            }
            continue;
        }
        for f in [&script, &program] {
            let _ = writeln!(said, "{} {}", if dry { "would write" } else { "wrote" }, f.display());
        }
        if !dry {
            install(&script, &program)?;
        }
    }
    output::to_stdout(said.as_bytes())?;
    Ok(Outcome::Done)
}

fn install(script: &Path, program: &Path) -> Result<(), Failure> {
    let own = env::current_exe().and_then(fs::read);
    let own = own.map_err(|e| Failure::Input(format!("this program's own file cannot be read: {e}")))?;
    let folder = program.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder).map_err(|e| Failure::file(folder, format!("cannot be made: {e}")))?;
    Pending::commit_all(vec![Pending::new(script, PLUG_IN.as_bytes())?, Pending::new(program, &own)?])?;
    #[cfg(unix)]
    for f in [script, program] {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(f, fs::Permissions::from_mode(0o755)).map_err(|e| Failure::file(f, e))?;
    }
    Ok(())
}

/// The plug-ins folders of every GIMP 3 that has been started here.
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
