//! The command line: one subcommand per deformation of the registry, and one file per further subcommand, which holds its
//! arguments and its run.

mod check;
mod compare;
mod completions;
mod convert;
mod deformation;
mod edit;
mod edits;
mod file_args;
mod gallery;
mod install;
mod list;
mod man;
mod map;
mod new_plugin;
mod paths;
mod points;
mod render;
mod run;
mod schema;
mod short_help;
mod solid;
mod text;
mod unwarp;

use crate::advice::{self, mistakes};
use crate::edits::{EDITS, OFFSET, OUTLINE, SIMPLIFY};
use crate::failure::Failure;
use crate::options::Given;
use crate::plugins::{self, Plugins};
use crate::status::Status;
use crate::{coming_from, output, watch};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, Command};
use pathwarp::deform::Registry;
use std::ffi::OsString;

/// The placeholder of a path reference in help.
const PATHREF: &str = "PATHREF";

const ABOUT: &str = "Bends, warps and deforms SVG artwork, and writes clean Bézier curves.";

const AFTER: &str = "Path references (PATHREF), for every option that takes a path:
  FILE#NAME       the path with that id, label or title in an SVG file, or with that name in a GIMP file (XCF, point list)
  FILE            the only path in the file, or a JSON file of points [[x,y],…]
  #NAME           a path of the input document; it becomes a guide: not part of the artwork, but kept in the file
  'M 0,0 C …'     SVG path data
  circle:r=60mm   a circle about the middle of the frame, or about cx=X,cy=Y
  arc:r=60mm,from=180,to=360   an arc of it; angles clockwise from the right, so this is the upper half
  spiral:turns=3,inner=20mm,outer=80mm   outwards from the left, clockwise; also from=ANGLE, ccw, cx=X, cy=Y
  'x,y x,y …'     points; percentages count from the left and top of the frame: 50%,0%

Chains: pathwarp projective IN.svg --target … + shaper --shaper … -o OUT.svg
All steps are composed before any curve is fitted. Name the inputs in the first part; common options may be in any part.
--select (or --exclude) in several parts holds for the step of its part: warp IN.svg --select .a + swirl --select .b -o OUT.svg

Exit codes: 0 success; 1 done, but something was left unchanged or missed the tolerance, or some of several inputs failed;
2 wrong usage; 3 unreadable input, or one that takes more work than a limit allows; 4 the geometry does not allow it; 5 an output cannot be written; 130 interrupted.
On 2 to 5 no output file is touched. An interrupted run leaves the results it has finished.";

/// The whole command line.
pub(crate) fn build(registry: &Registry) -> Command {
    let deformations = registry.entries().iter().map(|e| deformation::command(e.info()));
    root().subcommands(deformations).subcommands(OTHERS.iter().map(|(_, command)| command(registry)))
}

/// The command line with no other subcommand than the one that `word` names: declaring them all takes longer than warping a
/// small drawing.
fn build_for(registry: &Registry, word: Option<&OsString>) -> Command {
    let word = word.and_then(|w| w.to_str()).unwrap_or_default();
    if let Some(entry) = registry.get(word) {
        return root().subcommand(deformation::command(entry.info()));
    }
    match OTHERS.iter().find(|(name, _)| *name == word) {
        Some((_, command)) => root().subcommand(command(registry)),
        None => build(registry),
    }
}

fn root() -> Command {
    Command::new("pathwarp")
        .version(env!("CARGO_PKG_VERSION"))
        .about(ABOUT)
        .after_help(
            "Paths in options, chains, exit codes: pathwarp --help. A word of another program: pathwarp help WORD",
        )
        .after_long_help(AFTER)
        .subcommand_required(true)
        .arg_required_else_help(true)
        .infer_subcommands(false)
        .arg(
            Arg::new(plugins::OPTION)
                .long(plugins::OPTION)
                .value_name("FILE")
                .global(true)
                .hide_short_help(true)
                .help("Use the plug-in in this file, too (docs/plugin-protocol.md)"),
        )
}

/// Declares a subcommand.
type Declare = fn(&Registry) -> Command;

/// The subcommands that are not deformations, in the order of the help.
const OTHERS: [(&str, Declare); 21] = [
    (edit::NAME, |_| edit::command()),
    (run::NAME, run::command),
    (list::NAME, |_| list::command()),
    (map::NAME, map::command),
    (solid::NAME, |_| solid::command()),
    (unwarp::NAME, |_| unwarp::command()),
    (schema::NAME, |_| schema::command()),
    (text::NAME, text::command),
    (paths::NAME, |_| paths::command()),
    (SIMPLIFY.name, |_| edits::simplify()),
    (OFFSET.name, |_| edits::offset()),
    (OUTLINE.name, |_| edits::outline()),
    (convert::NAME, |_| convert::command()),
    (render::NAME, |_| render::command()),
    (gallery::NAME, gallery::command),
    (compare::NAME, |_| compare::command()),
    (check::NAME, |_| check::command()),
    (new_plugin::NAME, |_| new_plugin::command()),
    (install::NAME, |_| install::command()),
    (completions::NAME, |_| completions::command()),
    (man::NAME, |_| man::command()),
];

/// Runs the subcommand that `args` names; the first of them is the program's name.
pub(crate) fn dispatch(registry: &Registry, args: &[OsString]) -> Result<Status, Failure> {
    let (args, plugins) = plugins::load(registry, args, &OTHERS.map(|(name, _)| name))?;
    let result = dispatched(&plugins.added_to(registry), &args, &plugins);
    plugins.tell();
    result
}

fn dispatched(registry: &Registry, args: &[OsString], plugins: &Plugins) -> Result<Status, Failure> {
    // Each part after a lone `+` is a command line of its own.
    let mut parts = args.split(|a| a == "+");
    let first = parts.next().unwrap_or_default();
    let later: Vec<&[OsString]> = parts.collect();
    if let Some(text) = foreign_help(registry, first) {
        output::to_stdout(text.as_bytes())?;
        return Ok(Status::Complete);
    }
    if let Some(said) = mistakes::single_dashed(args, || options_of(registry, args)) {
        return Err(Failure::Usage(said));
    }
    let mut command = build_for(registry, first.get(1));
    if first.iter().any(|a| a == "-h") {
        command = short_help::shortened(command, &first[1..], "pathwarp");
    }
    let matches = command
        .try_get_matches_from(first)
        .map_err(|e| broken(plugins, first).unwrap_or_else(|| suggested(registry, first, e)))?;
    let Some((name, m)) = matches.subcommand() else {
        return Err(Failure::usage("no command given; `pathwarp list` shows the deformations"));
    };
    let reading = Given::reading(m)?;
    // An editor may be open for hours; it counts the work of every picture.
    if name != edit::NAME {
        watch::begin(reading.limits);
    }
    // The pipeline checks the fonts itself, when it has the options of all parts and of the recipe.
    if registry.get(name).is_some() {
        return deformation::run(registry, name, m, first, &later).map_err(|e| match e {
            Failure::Clap(e) => suggested(registry, args, e),
            other => other,
        });
    }
    if name == run::NAME {
        return run::run(registry, m, first);
    }
    reading.check()?;
    if name != map::NAME && name != solid::NAME && !later.is_empty() {
        return Err(Failure::usage(format!("{name} is not a deformation; `+` chains deformations")));
    }
    match name {
        edit::NAME => edit::run(registry, plugins, m),
        list::NAME => list::run(registry, plugins, m),
        check::NAME => check::run(registry, plugins, m),
        new_plugin::NAME => {
            let taken =
                |name: &str| name == "help" || OTHERS.iter().any(|(n, _)| *n == name) || registry.get(name).is_some();
            new_plugin::run(m, taken)
        }
        map::NAME => map::run(registry, m, &later),
        solid::NAME => solid::run(m, &later),
        unwarp::NAME => unwarp::run(m),
        schema::NAME => schema::run(registry),
        text::NAME => text::run(registry, m, first),
        paths::NAME => paths::run(m),
        _ if EDITS.iter().any(|e| e.name == name) => edits::run(registry, name, m, first),
        convert::NAME => convert::run(m),
        render::NAME => render::run(m),
        gallery::NAME => gallery::run(registry, m),
        compare::NAME => compare::run(m),
        install::NAME => install::run(registry, m),
        completions::NAME => completions::run(registry, build(registry), m),
        man::NAME => man::run(build(registry), m),
        other => Err(Failure::usage(format!("there is no command {other}"))),
    }
}

/// Words as one text.
fn joined(words: &[OsString]) -> String {
    words.iter().map(|w| w.to_string_lossy()).collect::<Vec<_>>().join(" ")
}

/// What `help WORD` says about a word that is no command, and which may be several words.
fn foreign_help(registry: &Registry, args: &[OsString]) -> Option<String> {
    let [_, help, words @ ..] = args else { return None };
    let known = |name: &str| build_for(registry, Some(&name.into())).find_subcommand(name).cloned();
    let wanted = joined(words);
    if help != "help" || wanted.starts_with('-') || known(&wanted).is_some() || wanted == "help" {
        return None;
    }
    coming_from::help(registry, &wanted, |name| known(name)?.get_about().map(ToString::to_string))
}

/// The error that the deformation that `args` begin with is a broken plug-in.
fn broken(plugins: &Plugins, args: &[OsString]) -> Option<Failure> {
    let named = |word: &&OsString| plugins.broken.iter().find(|b| b.name.as_str() == word.as_os_str());
    let word = args.get(1).filter(|w| *w != "help").or(args.get(2));
    word.as_ref().and_then(named).map(|b| b.fault.of(&b.path).into())
}

/// Adds to an error of clap what is most likely meant: commands and options of other programs, quotes around `#NAME`, which shells
/// take for a comment.
fn suggested(registry: &Registry, args: &[OsString], mut error: clap::Error) -> Failure {
    let context = |kind: ContextKind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.clone()),
        _ => None,
    };
    let is_help = args.get(1).is_some_and(|a| a == "help");
    let tip = match error.kind() {
        ErrorKind::InvalidSubcommand if args.get(1).is_none_or(|a| a != solid::NAME) => {
            let asked = args.get(2..).filter(|words| is_help && !words.is_empty()).map(joined);
            let word = asked.or_else(|| context(ContextKind::InvalidSubcommand)).unwrap_or_default();
            if let Some(meant) = mistakes::command(registry, &word) {
                return Failure::usage(meant);
            }
            let whole = build(registry);
            let foreign: Vec<String> = coming_from::all().map(|w| w.words[0].to_lowercase()).collect();
            let known = whole.get_subcommands().map(Command::get_name).chain(foreign.iter().map(String::as_str));
            let word = word.to_lowercase();
            let unknown = advice::unknown("command", &word, known);
            let join = if unknown.ends_with('?') { " " } else { "; " };
            let unknown = unknown + join + "`pathwarp list` shows all deformations";
            return if is_help { Failure::usage(unknown) } else { error.into() };
        }
        ErrorKind::InvalidValue if context(ContextKind::InvalidArg).is_some_and(|arg| arg.contains(PATHREF)) => {
            Some("shells take a word that starts with # for a comment; quote it: '#NAME'".to_owned())
        }
        ErrorKind::UnknownArgument => {
            let arg = context(ContextKind::InvalidArg).unwrap_or_default();
            let known = options_of(registry, args);
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            return Failure::usage(if arg.starts_with('-') {
                format!("there is no option {arg}; {}", mistakes::option(&arg, &known))
            } else {
                format!("{arg} is one word too many; {}", mistakes::surplus(&arg, args, &known))
            });
        }
        _ => None,
    };
    if let Some(tip) = tip {
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    }
    error.into()
}

/// The options of the commands that a command line names.
fn options_of(registry: &Registry, args: &[OsString]) -> Vec<String> {
    let commands = args.iter().enumerate().skip(1).filter(|(i, _)| *i == 1 || args[i - 1] == "+").map(|(_, word)| word);
    let names = commands.flat_map(|word| {
        let whole = build_for(registry, Some(word));
        let command = word.to_str().and_then(|w| whole.find_subcommand(w));
        let longs = command.into_iter().flat_map(|c| c.get_arguments().filter_map(|a| a.get_long().map(str::to_owned)));
        longs.collect::<Vec<_>>()
    });
    names.collect()
}
