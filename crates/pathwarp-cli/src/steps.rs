//! Converts the words of a command line to steps of a recipe.

use crate::arguments;
use crate::ending::Ending;
use clap::{Arg, ArgAction, ArgMatches, Command};
use pathwarp::deform::Info;
use pathwarp::param::{Args, Kind, Param};
use pathwarp::recipe::{Recipe, Step};
use pathwarp_engine::catalogue::Catalogue;
use pathwarp_engine::edits::{self, EDITS};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::options::Given;
use pathwarp_engine::steps::{INVERSE, as_known_name, assign};
use std::ffi::OsString;
use std::fmt::Write as _;

/// A part of a chain.
pub(crate) struct ChainPart {
    pub(crate) step: Step,
    /// The common options in this part; they apply to the whole chain.
    pub(crate) options: Given,
}

/// Returns an alternative name of a deformation.
pub(crate) fn alias(name: &str) -> Option<&'static str> {
    (name == "projective").then_some("perspective")
}

/// Joins the steps of all parts, and the options for the whole chain. If several parts select artwork, each selection goes to its step.
pub(crate) fn chained(mut parts: Vec<ChainPart>) -> Result<(Recipe, Given), Failure> {
    assign(parts.iter_mut().map(|p| (std::slice::from_mut(&mut p.step), &mut p.options)));
    // Of options that repeat, such as fonts, the first part's values come last.
    let mut options = parts.iter().skip(1).chain(parts.first()).map(|p| &p.options);
    let given = options.try_fold(Given::default(), |all, options| all.joined(options))?;
    Ok((Recipe { steps: parts.into_iter().map(|p| p.step).collect() }, given))
}

/// Parses the parts after each `+`, which take these common options.
pub(crate) fn parts(
    catalogue: &dyn Catalogue,
    words: &[&[OsString]],
    options: &[Arg],
) -> Result<Vec<ChainPart>, Ending> {
    words.iter().map(|words| part(catalogue, words, options)).collect()
}

fn part(catalogue: &dyn Catalogue, words: &[OsString], options: &[Arg]) -> Result<ChainPart, Ending> {
    let edits = EDITS.iter().filter(|_| !catalogue.is_solid());
    let deformation = |info: &Info| {
        Command::new(info.name).aliases(alias(info.name)).about(info.title).args(args(info)).args(options)
    };
    let command = Command::new("pathwarp … +")
        .no_binary_name(true)
        .disable_help_flag(true)
        .disable_help_subcommand(true)
        .subcommand_required(true)
        .subcommands(catalogue.infos().into_iter().chain(edits).map(deformation));
    let mut m = command.try_get_matches_from(words)?;
    let (name, sub) = m.remove_subcommand().ok_or_else(|| Failure::usage("a deformation must follow `+`"))?;
    Ok(ChainPart { step: step(catalogue, &name, &sub), options: arguments::given(&sub) })
}

const HEADING: &str = "Options";

/// Returns the parameters of a deformation as clap arguments.
pub(crate) fn args(info: &Info) -> impl Iterator<Item = Arg> {
    let inverse = edits::info(info.name).is_none().then(|| {
        Arg::new(INVERSE)
            .long(INVERSE)
            .action(ArgAction::SetTrue)
            .help_heading(HEADING)
            .help("Apply the inverse map (give --frame: percentages refer to the source)")
    });
    info.params.iter().map(param_arg).chain(inverse)
}

pub(crate) fn param_arg(p: &Param) -> Arg {
    let mut help = p.help.to_owned();
    if let Some(d) = p.default {
        let _ = write!(help, " [default: {d}]");
    }
    let arg = Arg::new(p.name).long(p.name).help(help).help_heading(HEADING).hide(p.help.is_empty());
    if p.kind == Kind::Flag {
        return arg.action(ArgAction::SetTrue);
    }
    // Coordinates may begin with a minus, but the next option is not a value.
    let parse = |t: &str| match t.starts_with("--") {
        true => Err("a value is missing before this option"),
        false => Ok(t.to_owned()),
    };
    let arg = arg.value_name(p.value_name()).allow_hyphen_values(true).value_parser(parse);
    arg.action(if p.repeat { ArgAction::Append } else { ArgAction::Set })
}

/// Returns the step that the parsed subcommand of the deformation `name` requests.
pub(crate) fn step(catalogue: &dyn Catalogue, name: &str, m: &ArgMatches) -> Step {
    let args = param_values(catalogue.info(name).map_or(&[][..], |i| i.params), m);
    let inverse = m.try_get_one(INVERSE).is_ok_and(|given| given == Some(&true));
    Step { inverse, ..Step::new(name, args) }
}

/// Returns the values of parameters on a parsed command line.
pub(crate) fn param_values(params: &[Param], m: &ArgMatches) -> Args {
    let mut args = Args::new();
    for p in params {
        if p.kind != Kind::Flag {
            let values = m.get_many::<String>(p.name).into_iter().flatten();
            values.for_each(|v| args.push(p.name, as_known_name(p, v)));
        } else if m.get_flag(p.name) {
            args.push(p.name, "true");
        }
    }
    args
}
