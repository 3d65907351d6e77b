//! `cargo xtask corpus`: fetches the icons that refitting is measured on, or measures whole drawings.

mod drawings;
mod icons;

use crate::chore::{Chore, ChoreError, count_option, path_option, paths};
use clap::{Arg, ArgAction, ArgMatches, Command};
use drawings::CorpusRun;

/// See the module.
pub(crate) const CHORE: Chore = Chore { command, run };

fn command() -> Command {
    Command::new("corpus")
        .about(
            "Fetch the icons that refitting is measured on (needs npm); with --svg, measure whole drawings \
             (cargo run --release -p xtask -- corpus --svg FOLDER)",
        )
        .arg(
            path_option("svg", "FOLDER")
                .action(ArgAction::Append)
                .help("A folder of SVG files, such as the tests of resvg; may be given several times"),
        )
        .arg(path_option("fonts", "FOLDER").help("Fonts for text in the drawings [default: the system's]"))
        .arg(count_option("every", "1").help("Measure every Nth file only"))
        .arg(
            path_option("pictures", "FOLDER")
                .help("Write pictures of failures to FOLDER: expected, actual, difference"),
        )
        .arg(
            Arg::new("only")
                .long("only")
                .value_name("CHECK")
                .action(ArgAction::Append)
                .value_parser(drawings::CHECKS)
                .help("Run this check only, without timing; may be given several times"),
        )
        .arg(Arg::new("times").long("times").action(ArgAction::SetTrue).help("Time reading and writing only"))
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    if !arguments.contains_id("svg") {
        return icons::fetch_all().map_err(|e| e.to_string());
    }
    drawings::measure(&CorpusRun {
        folders: paths(arguments, "svg"),
        fonts: arguments.get_one("fonts").cloned(),
        every: arguments.get_one("every").copied().unwrap_or(1),
        pictures: arguments.get_one("pictures").cloned(),
        only: arguments.get_many::<String>("only").unwrap_or_default().cloned().collect(),
        times: arguments.get_flag("times"),
    })
}
