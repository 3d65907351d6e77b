//! `pathwarp install gimp|inkscape`: installs the plug-in, with a copy of this program, in another program's folder.

mod files;
mod gimp;
mod inkscape;

use crate::failure::Failure;
use crate::output;
use crate::status::Status;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use pathwarp::deform::Registry;
use std::path::{Path, PathBuf};

pub(super) const NAME: &str = "install";

pub(super) fn command() -> Command {
    let flag = |name: &'static str, help: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue).help(help);
    let path = |name: &'static str, value: &'static str, help: &'static str| {
        Arg::new(name).long(name).value_name(value).value_parser(value_parser!(PathBuf)).help(help)
    };
    Command::new(NAME)
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
        .arg(flag("uninstall", "Remove the plug-in").visible_alias("remove"))
        .arg(flag("dry-run", "Print the changes without making them"))
        .after_help(
            "Examples:\n  pathwarp install gimp\n  pathwarp install inkscape\n  pathwarp install inkscape --dry-run\n  pathwarp install \
             inkscape --uninstall\n  pathwarp install inkscape --folder pkg/usr/share/inkscape/extensions --program pathwarp   # for a package",
        )
}

pub(super) fn run(registry: &Registry, m: &ArgMatches) -> Result<Status, Failure> {
    let is_gimp = m.get_one::<String>("WHAT").is_some_and(|w| w == "gimp");
    let program = m.get_one::<PathBuf>("program").map(PathBuf::as_path);
    if is_gimp && program.is_some() {
        return Err(Failure::usage("--program is for Inkscape; the plug-in for GIMP has its own copy"));
    }
    let folders = match m.get_one::<PathBuf>("dir") {
        Some(d) => vec![d.clone()],
        None if is_gimp => gimp::found(),
        None => inkscape::found(),
    };
    if folders.is_empty() {
        let what =
            if is_gimp { "GIMP 3; start GIMP 3 once, or name its plug-ins" } else { "Inkscape; name its extensions" };
        return Err(Failure::usage(format!("found no folder of {what} folder with --dir")));
    }
    let home = |folder: &Path| if is_gimp { gimp::home(folder) } else { inkscape::home(folder) };
    let parts = || if is_gimp { gimp::parts() } else { inkscape::parts(registry, program) };
    let dry = m.get_flag("dry-run");
    let mut done = String::new();
    for home in folders.iter().map(|f| home(f)) {
        done += &if m.get_flag("uninstall") {
            let names = if is_gimp { gimp::names().to_vec() } else { inkscape::installed(&home) };
            files::uninstall(&home, &names, dry)?
        } else {
            files::install(&home, &parts()?, dry)?
        };
    }
    output::to_stdout(done.as_bytes())?;
    Ok(Status::Complete)
}
