//! The command line: one subcommand per deformation of the registry, and one file per further subcommand, which holds its
//! arguments and its run.

mod compare;
mod completions;
mod convert;
mod deformation;
mod file_args;
mod gallery;
mod install;
mod list;
mod man;
mod map;
mod paths;
mod render;
mod run;
mod schema;
mod text;
mod unwarp;

use crate::failure::Failure;
use crate::status::Status;
use clap::Command;
use pathwarp::deform::Registry;
use std::ffi::OsString;

const ABOUT: &str = "Bends, warps and deforms SVG artwork, and gives clean Bézier curves back.";

const AFTER: &str = "Path references (PATHREF), wherever an option takes a path:
  FILE#NAME       the path of that id, label or title in an SVG file, or of that name in GIMP's (XCF, point lists)
  FILE            the only path in the file; a JSON file of points [[x,y],…]
  #NAME           in the input document; it is then a guide: left out of the artwork, kept in the file
  'M 0,0 C …'     SVG path data in place
  'x,y x,y …'     plain points; 50%,0% counts from the frame's left and top

Chains: pathwarp projective IN.svg --target … + shaper --shaper … -o OUT.svg
Everything is composed before any curve is fitted. Inputs are named in the first part; the common options may stand in any.

Exit codes: 0 all done; 1 done, but something was left as it was; 2 wrong usage; 3 input unreadable;
4 the geometry forbids it. On 2, 3 and 4 no output file is touched.";

/// The whole command line.
pub(crate) fn build(registry: &Registry) -> Command {
    let mut c = Command::new("pathwarp")
        .version(env!("CARGO_PKG_VERSION"))
        .about(ABOUT)
        .after_help(AFTER)
        .subcommand_required(true)
        .arg_required_else_help(true)
        .infer_subcommands(false);
    for e in registry.entries() {
        c = c.subcommand(deformation::command(e.info()));
    }
    c.subcommand(run::command())
        .subcommand(list::command())
        .subcommand(map::command(registry))
        .subcommand(unwarp::command())
        .subcommand(schema::command())
        .subcommand(text::command())
        .subcommand(paths::command())
        .subcommand(convert::command())
        .subcommand(render::command())
        .subcommand(gallery::command(registry))
        .subcommand(compare::command())
        .subcommand(install::command())
        .subcommand(completions::command())
        .subcommand(man::command())
}

/// Runs the subcommand that `args` names; the first of them is the program's name.
pub(crate) fn dispatch(registry: &Registry, args: &[OsString]) -> Result<Status, Failure> {
    // Each part after a lone `+` is a command line of its own.
    let mut parts = args.split(|a| a == "+");
    let first = parts.next().unwrap_or_default();
    let later: Vec<&[OsString]> = parts.collect();
    let matches = build(registry).try_get_matches_from(first)?;
    let Some((name, m)) = matches.subcommand() else {
        return Err(Failure::usage("no command given; `pathwarp list` shows the deformations"));
    };
    if registry.get(name).is_some() {
        return deformation::run(registry, name, m, &later);
    }
    if name != map::NAME && !later.is_empty() {
        return Err(Failure::usage(format!("{name} is not a deformation; `+` chains deformations")));
    }
    match name {
        run::NAME => run::run(registry, m),
        list::NAME => list::run(registry),
        map::NAME => map::run(registry, m, &later),
        unwarp::NAME => unwarp::run(m),
        schema::NAME => schema::run(registry),
        text::NAME => text::run(m),
        paths::NAME => paths::run(m),
        convert::NAME => convert::run(m),
        render::NAME => render::run(m),
        gallery::NAME => gallery::run(registry, m),
        compare::NAME => compare::run(m),
        install::NAME => install::run(m),
        completions::NAME => completions::run(build(registry), m),
        man::NAME => man::run(build(registry)),
        other => Err(Failure::usage(format!("there is no command {other}"))),
    }
}
