//! Chores of the workspace, run as `cargo xtask NAME`.

mod cookbook;
mod corpus;
mod docs;
mod guide;
mod lettering;
mod new_deformation;
mod outputs;
mod refit_report;
mod svg_corpus;

use clap::{Arg, ArgAction, Command, value_parser};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What went wrong, for people.
type Fault = String;

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let matches = Command::new("cargo xtask")
        .about("Chores of the workspace")
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommand(
            Command::new("new-deformation")
                .about("Write a deformation's file, its lines in the registry and its test")
                .arg(Arg::new("NAME").required(true).help("kebab-case, e.g. swirl or square-wave"))
                .arg(
                    Arg::new("root")
                        .long("root")
                        .value_name("DIR")
                        .value_parser(value_parser!(PathBuf))
                        .help("The workspace to write to [default: this one]"),
                ),
        )
        .subcommand(
            Command::new("corpus")
                .about(
                    "Fetch the icons that the refitting is measured on (needs npm); with --svg, measure whole drawings \
                     (cargo run --release -p xtask -- corpus --svg FOLDER)",
                )
                .arg(
                    Arg::new("svg")
                        .long("svg")
                        .value_name("FOLDER")
                        .action(ArgAction::Append)
                        .value_parser(value_parser!(PathBuf))
                        .help("A folder of SVG files, for instance resvg's tests"),
                )
                .arg(
                    Arg::new("fonts")
                        .long("fonts")
                        .value_name("FOLDER")
                        .value_parser(value_parser!(PathBuf))
                        .help("Fonts for their text, instead of the machine's"),
                )
                .arg(
                    Arg::new("every")
                        .long("every")
                        .value_name("N")
                        .value_parser(value_parser!(usize))
                        .default_value("1")
                        .help("Take one file of N"),
                )
                .arg(
                    Arg::new("pictures")
                        .long("pictures")
                        .value_name("FOLDER")
                        .value_parser(value_parser!(PathBuf))
                        .help("Where to put pictures of what misses: as it should be, as it is, the difference"),
                )
                .arg(
                    Arg::new("only")
                        .long("only")
                        .value_name("CHECK")
                        .action(ArgAction::Append)
                        .value_parser(svg_corpus::CHECKS)
                        .help("Make this check alone, and take no times; may be given several times"),
                )
                .arg(Arg::new("times").long("times").action(ArgAction::SetTrue).help("Only time reading and writing")),
        )
        .subcommand(
            Command::new("refit-report")
                .about("Draw the pieces, nodes and error of a refitted path")
                .arg(
                    Arg::new("path")
                        .long("path")
                        .value_name("DATA")
                        .default_value(refit_report::PATH)
                        .help("SVG path data"),
                )
                .arg(
                    Arg::new("tolerance")
                        .long("tolerance")
                        .value_name("D")
                        .value_parser(value_parser!(f64))
                        .default_value("0.05")
                        .help("Largest distance, user units"),
                )
                .arg(
                    Arg::new("out")
                        .long("out")
                        .value_name("FILE.svg")
                        .value_parser(value_parser!(PathBuf))
                        .default_value("docs/images/refit.svg")
                        .help("Where to draw"),
                ),
        )
        .subcommand(
            Command::new("outputs")
                .about("Store a hash of everything the program writes, or compare with one stored")
                .arg(
                    Arg::new("store")
                        .long("store")
                        .value_name("FILE")
                        .value_parser(value_parser!(PathBuf))
                        .conflicts_with("check")
                        .required_unless_present("check")
                        .help("Run every example and write the hashes"),
                )
                .arg(
                    Arg::new("check")
                        .long("check")
                        .value_name("FILE")
                        .value_parser(value_parser!(PathBuf))
                        .help("Run the commands of FILE again and name those that now write other bytes"),
                )
                .arg(
                    Arg::new("drawings")
                        .long("drawings")
                        .value_name("FOLDER")
                        .action(ArgAction::Append)
                        .value_parser(value_parser!(PathBuf))
                        .help("Also warp drawings of this folder; may be given several times"),
                )
                .arg(
                    Arg::new("count")
                        .long("count")
                        .value_name("N")
                        .value_parser(value_parser!(usize))
                        .default_value("300")
                        .help("Drawings taken from each folder"),
                )
                .arg(
                    Arg::new("every")
                        .long("every")
                        .value_name("N")
                        .value_parser(value_parser!(usize))
                        .default_value("1")
                        .help("Check one command of N"),
                )
                .arg(
                    Arg::new("program")
                        .long("program")
                        .value_name("FILE")
                        .value_parser(value_parser!(PathBuf))
                        .help("The pathwarp to run [default: one is built]"),
                ),
        )
        .subcommand(
            Command::new("docs").about("Write a page and a picture for every deformation, and the cookbook").arg(
                Arg::new("program")
                    .long("program")
                    .value_name("FILE")
                    .value_parser(value_parser!(PathBuf))
                    .help("The pathwarp that draws [default: one is built]"),
            ),
        )
        .get_matches();
    let done = match matches.subcommand() {
        Some(("new-deformation", m)) => {
            let name = m.get_one::<String>("NAME").map_or("", String::as_str);
            new_deformation::run(m.get_one::<PathBuf>("root").unwrap_or(&root), name)
        }
        Some(("corpus", m)) if m.contains_id("svg") => svg_corpus::run(&svg_corpus::Job {
            folders: m.get_many("svg").unwrap_or_default().cloned().collect(),
            fonts: m.get_one("fonts").cloned(),
            every: m.get_one("every").copied().unwrap_or(1),
            pictures: m.get_one("pictures").cloned(),
            only: m.get_many::<String>("only").unwrap_or_default().cloned().collect(),
            times: m.get_flag("times"),
        }),
        Some(("corpus", _)) => corpus::run().map(|()| "wrote corpus/icons.txt".to_owned()).map_err(|e| e.to_string()),
        Some(("outputs", m)) => outputs::run(
            &root,
            &outputs::Task {
                program: m.get_one("program").cloned(),
                drawings: m.get_many("drawings").unwrap_or_default().cloned().collect(),
                count: m.get_one("count").copied().unwrap_or(1),
                file: m.get_one("store").or(m.get_one("check")).cloned().unwrap_or_default(),
                check: m.contains_id("check"),
                every: m.get_one("every").copied().unwrap_or(1),
            },
        ),
        Some(("docs", m)) => docs::run(&root, m.get_one::<PathBuf>("program").map(PathBuf::as_path)),
        Some(("refit-report", m)) => {
            match (m.get_one::<String>("path"), m.get_one::<f64>("tolerance"), m.get_one::<PathBuf>("out")) {
                (Some(path), Some(tolerance), Some(out)) if *tolerance > 0.0 => {
                    refit_report::run(path, *tolerance, out)
                }
                _ => Err("the tolerance is a positive number".into()),
            }
        }
        _ => Err("no such chore".into()),
    };
    match done {
        Ok(said) => {
            say(&said);
            ExitCode::SUCCESS
        }
        Err(fault) => {
            say(&format!("error: {fault}"));
            ExitCode::FAILURE
        }
    }
}

#[expect(clippy::print_stderr, reason = "a program's messages")]
fn say(text: &str) {
    eprintln!("{text}");
}
