//! Opens files in an installed Inkscape without a screen, moves everything there and back, and saves.

use std::ffi::{OsStr, OsString};
use std::fmt::Write as _;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The seconds after which a run counts as hanging, as with a window that shows a message. Inkscape's largest examples take several.
const LAST_RESORT: &str = "1000";

/// A command that ends after the last resort.
fn limited(program: impl AsRef<OsStr>) -> Command {
    let mut out = Command::new("timeout");
    out.args(["--kill-after=5", LAST_RESORT]).arg(program);
    out
}

/// Inkscape: the program that the environment variable names, or the one with the usual name.
const VARIABLE: &str = "PATHWARP_INKSCAPE";

fn program() -> OsString {
    std::env::var_os(VARIABLE).unwrap_or_else(|| "inkscape".into())
}

/// Returns `true` if Inkscape is installed, else prints a remark.
pub fn is_installed() -> bool {
    match Command::new(program()).arg("--version").stdin(Stdio::null()).output() {
        Ok(out) => {
            eprint!("{}", String::from_utf8_lossy(&out.stdout));
            out.status.success()
        }
        Err(e) if std::env::var_os(VARIABLE).is_some() => panic!("{VARIABLE} names no program that runs: {e}"),
        Err(_) => {
            crate::support::skipped(format_args!("there is no program `inkscape`, and {VARIABLE} names none"));
            false
        }
    }
}

/// The drawings that come with Inkscape.
pub fn examples() -> Option<Vec<PathBuf>> {
    let data = Command::new(program()).arg("--system-data-directory").stdin(Stdio::null()).output().ok()?;
    let folder = Path::new(str::from_utf8(&data.stdout).ok()?.trim()).join("examples");
    let files = fs::read_dir(folder).ok()?.map(|f| f.unwrap().path());
    Some(files.filter(|f| f.extension().is_some_and(|e| e == "svg" || e == "svgz")).collect())
}

/// Opens and edits `NAME.svg` in a folder for each name, and saves it as `NAME.edited.svg`.
pub fn edit(folder: &Path, names: &[String]) {
    let mut script = String::new();
    for n in names {
        let at = |end: &str| folder.join(format!("{n}{end}")).display().to_string();
        let _ = write!(
            script,
            "file-open:{}\nselect-all:all\ntransform-translate:5,0\ntransform-translate:-5,0\nexport-filename:{}\n\
             export-plain-svg\nexport-do\nfile-close\n",
            at(".svg"),
            at(".edited.svg")
        );
    }
    script.push_str("quit\n");
    fs::write(folder.join("script"), script).unwrap();
    let has_screen = Command::new("xvfb-run").arg("--help").output().is_ok();
    let mut run = limited(if has_screen { "xvfb-run".into() } else { program() });
    if has_screen {
        run.arg("-a").arg(program());
    }
    let log = File::create(folder.join("log")).unwrap();
    // A separate profile, so that the user's is neither read nor changed.
    run.arg("--shell").env("INKSCAPE_PROFILE_DIR", folder.join("profile")).current_dir(folder);
    run.stdin(File::open(folder.join("script")).unwrap()).stdout(log.try_clone().unwrap()).stderr(log);
    // The way Inkscape ends does not matter; its saved files are examined.
    let ended = run.status().unwrap().code();
    assert!(!matches!(ended, Some(124 | 137)), "Inkscape hangs: {}", fs::read_to_string(folder.join("log")).unwrap());
}

/// Returns `true` if there is a virtual screen, which effects need, else prints a remark.
pub fn has_screen() -> bool {
    let found = Command::new("xvfb-run").arg("--help").output().is_ok();
    if !found {
        crate::support::skipped("there is no program `xvfb-run`, in which Inkscape is tested");
    }
    found
}

/// Opens a file in a window and runs actions, by a profile in the folder.
pub fn act(folder: &Path, file: &Path, actions: &str) {
    let mut run = limited("xvfb-run");
    run.arg("-a").arg(program()).args(["-g", "--batch-process"]);
    finish(run.arg(file).arg(format!("--actions={actions}")), folder);
}

/// Runs Inkscape without a window, by a profile in the folder.
pub fn convert(folder: &Path, args: &[&str]) {
    finish(limited(program()).args(args), folder);
}

fn finish(run: &mut Command, folder: &Path) {
    // A program in the folder replaces the browser.
    let run = run.env("INKSCAPE_PROFILE_DIR", folder.join("profile")).env("BROWSER", folder.join("browser"));
    let run = run.current_dir(folder).stdin(Stdio::null());
    let out = run.output().unwrap();
    let said = [out.stdout, out.stderr].map(|t| String::from_utf8_lossy(&t).into_owned()).join("\n");
    assert!(out.status.success(), "{run:?}: {said}");
}
