//! `pathwarp DEFORMATION …`: warps files by one deformation or a chain.

use crate::advice::mistakes;
use crate::failure::Failure;
use crate::options::{self, Given, OPTIONS};
use crate::pipeline;
use crate::status::Status;
use crate::steps::{self, ChainPart};
use clap::{ArgMatches, Command};
use pathwarp::deform::{Info, Registry};
use pathwarp::recipe::Recipe;
use std::ffi::OsString;
use std::fmt::Write as _;

/// The common options that `-h` shows.
const COMMON: [&str; 6] = ["out", "out-dir", "select", "tolerance", "fit", "preview"];

pub(super) fn command(info: &Info) -> Command {
    let whole = described(info).args(options::args()).mut_args(|arg| {
        let hidden = OPTIONS.iter().any(|o| *arg.get_id() == o.name) && !COMMON.contains(&arg.get_id().as_str());
        let full = arg.get_help().map(ToString::to_string).unwrap_or_default();
        arg.help(brief(&full)).long_help(full).hide_short_help(hidden)
    });
    let Some(first) = info.examples.first() else { return whole };
    let rest = format!("All options and examples: pathwarp {} --help", info.name);
    whole.after_help(format!("{}:\n  pathwarp {}\n\n{rest}", first.what, first.command))
}

/// The beginning of a help text, for a line, with its default.
fn brief(help: &str) -> String {
    const LINE: usize = 60;
    let (text, default) = match help.split_once(" [default: ") {
        Some((text, default)) => (text, format!(" [{}", default.trim_end_matches(']'))),
        None => (help, String::new()),
    };
    let default = if default.is_empty() || default.len() > LINE / 2 { String::new() } else { default + "]" };
    let ends = text
        .char_indices()
        .filter(|(i, c)| ".;:,(".contains(*c) && text[i + c.len_utf8()..].starts_with([' ', 'a']))
        .map(|(i, _)| i);
    let end = ends.chain([text.len()]).take_while(|i| *i <= LINE).last();
    let first = end.or_else(|| text.find([';', ':', '.', ',']).filter(|i| *i > 0)).unwrap_or(text.len());
    // Not within brackets.
    let open = text[..first].rfind('(').filter(|i| !text[*i..first].contains(')'));
    text[..open.unwrap_or(first)].trim_end().to_owned() + &default
}

/// The subcommand of a deformation, of the plane or of space, with its help and its own parameters.
pub(super) fn described(info: &Info) -> Command {
    let mut examples = String::from("Examples:");
    for e in info.examples {
        let _ = write!(examples, "\n  {}:\n    pathwarp {}", e.what, e.command);
    }
    let _ = write!(examples, "\n\nSource: {}", info.source);
    Command::new(info.name)
        .about(info.title)
        .long_about(format!("{} — {}\n\n{}", info.name, info.title, info.about))
        .after_help(examples.clone())
        .after_long_help(examples)
        .args(steps::args(info))
}

/// Runs the deformation `name`, chained with those in `later`.
pub(super) fn run(
    registry: &Registry,
    name: &str,
    m: &ArgMatches,
    words: &[OsString],
    later: &[&[OsString]],
) -> Result<Status, Failure> {
    let first = ChainPart { step: steps::step(registry, name, m), options: Given::inputs_and_options(m) };
    let mut parts = vec![first];
    parts.extend(steps::parts(registry, later, &options::options_without_inputs().collect::<Vec<_>>())?);
    steps::assign(parts.iter_mut().map(|p| (std::slice::from_mut(&mut p.step), &mut p.options)));
    // The first part's options come last, as its inputs do.
    let mut options = parts.iter().skip(1).chain(parts.first()).map(|p| &p.options);
    let given = options.try_fold(Given::default(), |all, options| all.joined(options))?;
    mistaken(words, &given)?;
    pipeline::run(registry, &Recipe { steps: parts.into_iter().map(|p| p.step).collect() }, &given, None)
}

/// Refuses inputs that are parts of something else.
pub(super) fn mistaken(words: &[OsString], given: &Given) -> Result<(), Failure> {
    mistakes::inputs(words, given.inputs(), given.gives("out") || given.gives("out-dir"))
        .map_or(Ok(()), |said| Err(Failure::Usage(said)))
}
