//! Commands for authors of plug-ins: `new-plugin` writes a template, and `check` checks a plug-in or a built-in deformation.

use crate::commands::args::option;
use crate::commands::install::{Part, install_files};
use crate::ending::Status;
use crate::plugins::{Plugins, is_file_name};
use clap::{Arg, ArgMatches, Command, value_parser};
use pathwarp::check::{Check, frame, report};
use pathwarp::deform::{Deformation, Registry};
use pathwarp::kurbo::Point;
use pathwarp::map::Jet;
use pathwarp::param::Args;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::{advice, output, readable};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

pub(super) fn check_command() -> Command {
    Command::new("check")
        .about("Check a deformation, built in or a plug-in: help, parameters, derivatives, inverse, laws, speed")
        .arg(
            Arg::new("WHAT")
                .required(true)
                .value_name("NAME|FILE")
                .help("A deformation, or the file of a plug-in, which need not be installed"),
        )
        .after_help(
            "The deformation is built from its demo values over the box 0,0,100,100. A law or case that does not hold is shown with \
             the values and the place. A plug-in is started anew, even if it was broken before. The exit code is 1 if \
             something is wrong.\n\nExamples:\n  pathwarp check wave\n  pathwarp check ./pathwarp-ripple.py",
        )
}

pub(super) fn check(registry: &Registry, plugins: &Plugins, m: &ArgMatches) -> Result<Status, Failure> {
    let what = m.get_one::<String>("WHAT").map_or("", String::as_str);
    let by_file = || plugins.last_given().map(|p| p as &dyn Deformation);
    let by_name = registry.get(what).map(|e| &**e as &dyn Deformation);
    let entry = if is_file_name(Path::new(what)) { by_file() } else { by_name };
    let Some(entry) = entry else {
        let unknown = || advice::unknown("deformation", what, registry.entries().iter().map(|e| e.info().name));
        return Err(plugins.failure(what).unwrap_or_else(|| Failure::usage(unknown())));
    };
    let name = entry.info().name;
    let title = match plugins.get(name) {
        None => format!("{name}, built in\n"),
        Some(p) => format!("{name}, the plug-in {}\n", p.path().display()),
    };
    output::to_stdout(title.as_bytes())?;
    // Measure before the checks, which take long if it is slow.
    let speed = speed(entry).map(|speed| format!("  ok    {:<10}  {speed}\n", "speed")).unwrap_or_default();
    let mut printed = output::to_stdout(speed.as_bytes());
    let (mut wrong, mut count) = (0, 0);
    report(entry, |check| {
        count += 1;
        wrong += usize::from(!check.faults.is_empty());
        if printed.is_ok() {
            printed = print_check(&check);
        }
    });
    printed?;
    let verdict = if wrong == 0 { "is sound".to_owned() } else { format!("fails {wrong} of {count} checks") };
    output::to_stdout(format!("{name} {verdict}\n").as_bytes())?;
    Ok(Status::partial_if(wrong > 0))
}

/// Prints the lines of one check.
fn print_check(check: &Check) -> Result<(), Failure> {
    let word = if check.faults.is_empty() { "ok  " } else { "FAIL" };
    let mut out = format!("  {word}  {:<10}  {}\n", check.name, readable::safe_message(&check.detail));
    for fault in &check.faults {
        let _ = writeln!(out, "        {:<10}  {}", "", readable::safe_message(fault));
    }
    output::to_stdout(out.as_bytes())
}

/// Describes the time for a point and for a jet, singly and in large batches; `None` if the map cannot be built or fails.
fn speed(entry: &dyn Deformation) -> Option<String> {
    /// Points in a batch.
    const BATCH: usize = 4096;
    /// Points in a small batch, and number of calls for single points.
    const FEW: usize = 50;
    /// Time for a point from which larger batches are skipped.
    const SLOW: Duration = Duration::from_micros(500);
    /// Approximate number of points for a drawing of some hundred segments.
    const DRAWING: u32 = 20_000;
    let built = entry.build_from(&Args::from_pairs(entry.info().demo), &frame()).ok()?;
    let map = &*built.map;
    // Points along a diagonal of the box.
    let sample = |i: usize| Point::new(3.0 + 0.0231 * i as f64, 97.0 - 0.0229 * i as f64);
    let points: Vec<Point> = (0..BATCH).map(sample).collect();
    let (mut images, mut jets) = (points.clone(), vec![Jet::default(); BATCH]);
    let time_each = |count: usize, work: &mut dyn FnMut()| {
        let clock = Instant::now();
        work();
        clock.elapsed() / count as u32
    };
    let point = time_each(FEW, &mut || map.points(&points[..FEW], &mut images[..FEW]));
    let speed = if point > SLOW {
        let drawing = point * DRAWING;
        format!("slow: {point:.1?} for a point, in batches of {FEW}; a drawing of {DRAWING} points takes {drawing:.1?}")
    } else {
        let point = time_each(BATCH, &mut || map.points(&points, &mut images));
        let jet = time_each(BATCH, &mut || map.jets(&points, &mut jets));
        let single = time_each(FEW, &mut || points.iter().take(FEW).for_each(|p| _ = map.point(*p)));
        format!(
            "{point:.1?} for a point and {jet:.1?} for one with derivatives, in batches of {BATCH}; {single:.1?} for a single one"
        )
    };
    built.failure.as_ref().is_none_or(|failed| failed().is_none()).then_some(speed)
}

/// The placeholder for the name in the templates.
const PLACEHOLDER: &str = "@NAME@";

const PYTHON: &str = include_str!("../../plug-ins/new/plugin.py");
const RUST: &str = include_str!("../../plug-ins/new/main.rs");
const MANIFEST: &str = include_str!("../../plug-ins/new/Cargo.toml.in");

pub(super) fn new_plugin_command() -> Command {
    Command::new("new-plugin")
        .about("Write a plug-in to start from: a deformation that is a program")
        .arg(
            Arg::new("LANGUAGE")
                .required(true)
                .value_parser(["python", "rust"])
                .help("python: one file that speaks lines of text; rust: a crate without dependencies that speaks binary"),
        )
        .arg(Arg::new("NAME").required(true).help("Name of the deformation: lower-case words joined by hyphens"))
        .arg(
            option("dir", "DIR", "Folder to write to").default_value(".").value_parser(value_parser!(PathBuf)),
        )
        .after_help(
            "Existing files are not overwritten.\n\nExamples:\n  pathwarp new-plugin python ripple\n  pathwarp check \
             ./pathwarp-ripple.py\n  pathwarp ripple logo.svg -o out.svg --plugin ./pathwarp-ripple.py\n\ndocs/writing-deformations.md \
             goes on from there.",
        )
}

/// Writes the template. `is_taken` returns `true` for names of commands.
pub(super) fn new_plugin(m: &ArgMatches, is_taken: impl Fn(&str) -> bool) -> Result<Status, Failure> {
    let word = |name: &str| m.get_one::<String>(name).map_or("", String::as_str);
    let (language, name) = (word("LANGUAGE"), word("NAME"));
    let is_word = |w: &str| !w.is_empty() && w.bytes().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit());
    if !name.split('-').all(is_word) || !name.starts_with(|c: char| c.is_ascii_lowercase()) {
        return Err(Failure::usage(format!("NAME: `{name}` is not lower-case words joined by hyphens")));
    }
    if is_taken(name) {
        return Err(Failure::usage(format!("NAME: `{name}` is a command already; choose another name")));
    }
    let folder = m.get_one::<PathBuf>("dir").map_or(Path::new("."), PathBuf::as_path);
    let program = format!("pathwarp-{name}");
    let home = folder.join(&program);
    let files = match language {
        "python" => vec![(home.with_extension("py"), PYTHON)],
        _ => vec![(home.join("Cargo.toml"), MANIFEST), (home.join("src/main.rs"), RUST)],
    };
    if let Some((file, _)) = files.iter().find(|(file, _)| file.exists()) {
        return Err(Failure::output(file, "exists already"));
    }
    let part = |(file, template): &(PathBuf, &str)| {
        let content = template.replace(PLACEHOLDER, name).into_bytes();
        Part { name: file.clone(), content, is_executable: language == "python" }
    };
    let mut text = install_files(Path::new(""), &files.iter().map(part).collect::<Vec<_>>(), false)?;
    let first = files[0].0.display();
    let (build, file) = match language {
        "python" => (String::new(), first.to_string()),
        _ => {
            let built = home.join("target/release").join(program).display().to_string();
            (format!("  cargo build --release --manifest-path {first}\n"), built)
        }
    };
    let _ =
        write!(text, "next:\n{build}  pathwarp check {file}\n  pathwarp {name} IN.svg -o OUT.svg --plugin {file}\n");
    if let Some(folder) = pathwarp_plugin::folder() {
        let _ = writeln!(text, "to install it, copy {file} to {}", folder.display());
    }
    output::to_stdout(text.as_bytes())?;
    Ok(Status::Complete)
}
