//! A deformation's own parameters: as clap arguments, and read back into a step.

use crate::catalogue::Catalogue;
use clap::{Arg, ArgAction, ArgMatches};
use pathwarp::deform::Info;
use pathwarp::param::{Args, Kind, Param};
use pathwarp::recipe::Step;
use std::fmt::Write as _;

/// The switch that every deformation has.
pub(crate) const INVERSE: &str = "inverse";

const HEADING: &str = "Options";

/// The parameters of a deformation as clap arguments, without the common options.
pub(crate) fn args(info: &Info) -> impl Iterator<Item = Arg> {
    let inverse = Arg::new(INVERSE)
        .long(INVERSE)
        .action(ArgAction::SetTrue)
        .help_heading(HEADING)
        .help("Apply the inverse map, if there is one (give --frame: percentages refer to the source's box)");
    info.params.iter().map(param_arg).chain([inverse])
}

pub(crate) fn param_arg(p: &Param) -> Arg {
    let mut help = p.help.to_owned();
    if let Some(d) = p.default {
        let _ = write!(help, " [default: {d}]");
    }
    let arg = Arg::new(p.name).long(p.name).help(help).help_heading(HEADING);
    if p.kind == Kind::Flag {
        return arg.action(ArgAction::SetTrue);
    }
    // Coordinates may start with a minus, but a missing value must not swallow the next option.
    arg.value_name(p.value_name())
        .allow_hyphen_values(true)
        .value_parser(
            |t: &str| {
                if t.starts_with("--") { Err("a value is missing before this option") } else { Ok(t.to_owned()) }
            },
        )
        .action(if p.repeat { ArgAction::Append } else { ArgAction::Set })
}

/// The step that the parsed subcommand of the deformation `name` asks for.
pub(crate) fn step(catalogue: &dyn Catalogue, name: &str, m: &ArgMatches) -> Step {
    let args = param_values(catalogue.info(name).map_or(&[][..], |i| i.params), m);
    Step { inverse: m.get_flag(INVERSE), ..Step::new(name, args) }
}

/// The values that a parsed command line gives for parameters.
pub(crate) fn param_values(params: &[Param], m: &ArgMatches) -> Args {
    let mut args = Args::new();
    for p in params {
        if p.kind == Kind::Flag {
            if m.get_flag(p.name) {
                args.push(p.name, "true");
            }
        } else {
            for v in m.get_many::<String>(p.name).into_iter().flatten() {
                args.push(p.name, in_lower_case(p, v));
            }
        }
    }
    args
}

/// A name that differs from a known one only in case, as that one.
pub(crate) fn in_lower_case(p: &Param, value: &str) -> String {
    let (Kind::NameOrFile(names) | Kind::Choice(names)) = p.kind else { return value.to_owned() };
    let same = names.iter().find(|n| n.eq_ignore_ascii_case(value));
    same.map_or_else(|| value.to_owned(), |n| (*n).to_owned())
}
