//! `cargo xtask hostile FOLDER`: runs commands on every file in a folder of hostile files, and prints the table in `docs/reliability.md`: exit
//! code, CPU time and memory. It fails if any run breaks the limits promised there.

use crate::chore::{Chore, ChoreError, at, program_option, workspace};
use crate::process::{Job, Usage};
use crate::shell;
use clap::{Arg, ArgMatches, Command, value_parser};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

pub(crate) const CHORE: Chore = Chore { command, run };

/// The limits promised for files of up to a mebibyte.
const SECONDS: f64 = 5.0;
const MEGABYTES: f64 = 500.0;

/// The headings and commands for drawings. `IN` is the file, `OUT` a new one.
const DRAWINGS: [(&str, &str); 4] = [
    ("swirl", "swirl IN -o OUT.svg"),
    ("flat, outlined", "wave IN -o OUT.svg --structure flatten --strokes outline --fit page"),
    ("mls, exact", "mls IN --pair 10,10:20,20 --pin 50,50 --gradients exact -o OUT.svg"),
    ("render", "render IN -o OUT.png"),
];

fn command() -> Command {
    Command::new("hostile")
        .about("Run commands on hostile files and print their time, memory and exit codes")
        .arg(Arg::new("folder").required(true).value_name("FOLDER").value_parser(value_parser!(PathBuf)))
        .arg(program_option())
}

fn run(arguments: &ArgMatches) -> Result<String, ChoreError> {
    let program = shell::program(&workspace(), arguments)?;
    let folder: &PathBuf = arguments.get_one("folder").ok_or("name a folder")?;
    let sample = workspace().join("samples/logo.svg").canonicalize().map_err(|e| e.to_string())?;
    let scratch = tempfile::tempdir().map_err(|e| e.to_string())?;
    let mut table = "| file | size | ".to_owned();
    table += &DRAWINGS.map(|(heading, _)| heading).join(" | ");
    table += " |\n|---|---|---|---|---|---|\n";
    let mut broken = Vec::new();
    for file in shell::files_below(folder, |f| !shell::ends_in(f, &["md"]))? {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let size = std::fs::metadata(&file).map_err(at(&file))?.len();
        let lines: Vec<String> = match file.extension().and_then(|e| e.to_str()) {
            Some("toml") => vec![format!("run IN {} -o OUT.svg", sample.display())],
            Some("png" | "jpg") => vec!["swirl IN -o OUT.png".into()],
            _ => DRAWINGS.iter().map(|(_, line)| (*line).to_owned()).collect(),
        };
        let mut cells = Vec::new();
        for line in &lines {
            let used = measure(&program, line, &file, scratch.path())?;
            // The program's documented exit codes go up to 5.
            if used.code.is_none_or(|c| c > 5) || used.cpu >= SECONDS || used.megabytes() >= MEGABYTES {
                broken.push(format!("{name}: {line}"));
            }
            let code = used.code.map_or_else(|| "killed".to_owned(), |c| c.to_string());
            cells.push(format!("{code}: {:.2} s, {:.0} MB", used.cpu, used.megabytes()));
        }
        cells.resize(DRAWINGS.len(), String::new());
        let _ = writeln!(table, "| {name} | {:.1} kB | {} |", size as f64 / 1e3, cells.join(" | "));
    }
    if broken.is_empty() { Ok(table) } else { Err(format!("{table}\nthe promise is broken by {}", broken.join("; "))) }
}

/// Runs a command line in which `IN` is the file and `OUT` a new one in `scratch`.
pub(crate) fn measure(program: &Path, line: &str, file: &Path, scratch: &Path) -> Result<Usage, ChoreError> {
    let (input, output) = (file.to_string_lossy(), scratch.join("out"));
    let word = |w: String| w.replace("IN", &input).replace("OUT", &output.to_string_lossy());
    let args = shell::words(line).into_iter().map(|w| if w == "IN" || w.starts_with("OUT") { word(w) } else { w });
    Job::new(program, args).run_unchecked()
}
