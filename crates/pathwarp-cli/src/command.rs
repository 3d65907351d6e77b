//! The command line itself, made from the registry.

use crate::failure::Failure;
use crate::{
    Outcome, common, compare, convert, gallery, install, output, paths, query, recipe_file, render, text, unwarp,
};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use pathwarp::deform::{Info, Registry};
use pathwarp::param::{Args, Kind, Param};
use pathwarp::recipe::{Recipe, Step};
use std::ffi::OsString;
use std::fmt::Write as _;
use std::io::IsTerminal;
use std::path::PathBuf;

const ABOUT: &str = "Bends, warps and deforms SVG artwork, and gives clean Bézier curves back.";

/// The switch that every deformation has.
const INVERSE: &str = "inverse";

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
        c = c.subcommand(deformation(e.info()));
    }
    c.subcommand(run_command())
        .subcommand(Command::new("list").about("List the deformations"))
        .subcommand(query::command(registry))
        .subcommand(unwarp::command())
        .subcommand(Command::new("schema").about("Print the JSON schema of recipe files"))
        .subcommand(text::command())
        .subcommand(paths::command())
        .subcommand(convert::command())
        .subcommand(render::command())
        .subcommand(gallery::command())
        .subcommand(compare::command())
        .subcommand(install::command())
        .subcommand(
            Command::new("completions")
                .about("Print completions for a shell")
                .arg(Arg::new("SHELL").required(true).value_parser(value_parser!(clap_complete::Shell))),
        )
        .subcommand(Command::new("man").about("Print the manual page"))
}

/// A deformation's own options, without the common ones.
pub(crate) fn own_args(info: &Info) -> impl Iterator<Item = Arg> {
    let inverse = Arg::new(INVERSE)
        .long(INVERSE)
        .action(ArgAction::SetTrue)
        .help_heading("Options")
        .help("Undo it: the inverse map, where there is one (give --frame: percentages mean the source's box)");
    info.params
        .iter()
        .map(|p| {
            let mut help = p.help.to_owned();
            if let Some(d) = p.default {
                let _ = write!(help, " [default: {d}]");
            }
            let arg = Arg::new(p.name).long(p.name).help(help).help_heading("Options");
            if p.kind == Kind::Flag {
                return arg.action(ArgAction::SetTrue);
            }
            // Coordinates may start with a minus; a missing value must still not swallow the next option.
            arg.value_name(p.value_name())
                .allow_hyphen_values(true)
                .value_parser(|t: &str| {
                    if t.starts_with("--") { Err("a value is missing before this option") } else { Ok(t.to_owned()) }
                })
                .action(if p.repeat { ArgAction::Append } else { ArgAction::Set })
        })
        .chain([inverse])
}

fn deformation(info: &Info) -> Command {
    let mut examples = String::from("Examples:");
    for e in info.examples {
        let _ = write!(examples, "\n  {}:\n    pathwarp {}", e.what, e.command);
    }
    let _ = write!(examples, "\n\nSource: {}", info.source);
    Command::new(info.name)
        .about(info.title)
        .long_about(format!("{} — {}\n\n{}", info.name, info.title, info.about))
        .after_help(examples)
        .args(own_args(info))
        .args(common::args())
}

/// `pathwarp run RECIPE [INPUT…]`: a saved command line, whose options the ones given here overrule.
fn run_command() -> Command {
    Command::new("run")
        .about("Run a recipe file, as --write-recipe saves it")
        .arg(Arg::new("RECIPE").required(true).value_parser(value_parser!(PathBuf)).help("A recipe (TOML)"))
        .arg(
            Arg::new(INVERSE)
                .long(INVERSE)
                .action(ArgAction::SetTrue)
                .help("Undo it: the inverse of every step, the last first (give --frame: the source's box)"),
        )
        .args(common::args())
        .args_override_self(true)
        .after_help(
            "A recipe:\n  pathwarp = 1\n  [options]\n  tolerance = \"0.01\"\n  [[step]]\n  deformation = \"shaper\"\n  \
             shaper = \"cage.svg#flag\"   # relative to the recipe's own folder\n\nExamples:\n  pathwarp shaper logo.svg \
             --shaper cage.svg -o out.svg --write-recipe flag.toml\n  pathwarp run flag.toml other.svg -o other-out.svg",
        )
}

/// The recipe that `run` names, and its command line with the recipe's options before the ones given.
pub(crate) fn run_recipe(
    registry: &Registry,
    words: &[OsString],
    m: &ArgMatches,
) -> Result<(Recipe, ArgMatches), Failure> {
    let file = m.get_one::<PathBuf>("RECIPE").cloned().unwrap_or_default();
    let saved = recipe_file::read(registry, &file)?;
    let at = words.iter().position(|w| w == "run").map_or(1, |i| i + 1);
    let mut line = vec![OsString::from("run")];
    line.extend(saved.options.iter().map(OsString::from));
    line.extend_from_slice(&words[at..]);
    // The words given were understood before; what is wrong now comes from the file.
    let merged = run_command()
        .try_get_matches_from(line)
        .map_err(|e| Failure::file(&file, format!("its [options] are no options of the command line: {e}")))?;
    let recipe = if m.get_flag(INVERSE) { saved.recipe.inverted() } else { saved.recipe };
    Ok((recipe, merged))
}

/// The step that a parsed subcommand stands for.
fn step(registry: &Registry, name: &str, m: &ArgMatches) -> Step {
    let mut args = Args::new();
    for p in registry.get(name).map_or(&[][..], |e| e.info().params) {
        read(p, m, &mut args);
    }
    Step { inverse: m.get_flag(INVERSE), ..Step::new(name, args) }
}

fn read(p: &Param, m: &ArgMatches, args: &mut Args) {
    if p.kind == Kind::Flag {
        if m.get_flag(p.name) {
            args.push(p.name, "true");
        }
        return;
    }
    for v in m.get_many::<String>(p.name).into_iter().flatten() {
        args.push(p.name, v.clone());
    }
}

/// A step after a `+`: a deformation with its own options, and those of `shared`.
fn chained_step(registry: &Registry, words: &[OsString], shared: &[Arg]) -> Result<(Step, ArgMatches), Failure> {
    let mut c = Command::new("pathwarp … +")
        .no_binary_name(true)
        .disable_help_flag(true)
        .disable_help_subcommand(true)
        .subcommand_required(true);
    for e in registry.entries() {
        c = c.subcommand(Command::new(e.info().name).about(e.info().title).args(own_args(e.info())).args(shared));
    }
    let mut m = c.try_get_matches_from(words)?;
    m.remove_subcommand()
        .map(|(name, sub)| (step(registry, &name, &sub), sub))
        .ok_or_else(|| Failure::usage("a deformation must follow `+`"))
}

/// The steps after each `+`, and the common options among them, which count for all of the chain: to be read with the first
/// part's.
pub(crate) fn chain(registry: &Registry, rest: &[Vec<OsString>]) -> Result<(Vec<Step>, Vec<OsString>), Failure> {
    let shared: Vec<Arg> = common::options().collect();
    let (mut steps, mut words) = (Vec::new(), Vec::new());
    for part in rest {
        let (step, m) = chained_step(registry, part, &shared)?;
        steps.push(step);
        words.extend(common::as_typed(&m));
    }
    Ok((steps, words))
}

/// A deformation's matches and the steps after it, as a recipe.
pub(crate) fn recipe(registry: &Registry, name: &str, m: &ArgMatches, rest: Vec<Step>) -> Recipe {
    let mut steps = vec![step(registry, name, m)];
    steps.extend(rest);
    Recipe { steps }
}

/// The steps after each `+`, with no options but their own.
pub(crate) fn bare_chain(registry: &Registry, rest: &[Vec<OsString>]) -> Result<Vec<Step>, Failure> {
    rest.iter().map(|part| chained_step(registry, part, &[]).map(|(step, _)| step)).collect()
}

/// `pathwarp list`: a menu.
pub(crate) fn list(registry: &Registry) -> Result<Outcome, Failure> {
    let infos: Vec<&Info> = registry.entries().iter().map(|e| e.info()).collect();
    let width = infos.iter().map(|i| i.name.len()).max().unwrap_or(0);
    let mut groups: Vec<&str> = Vec::new();
    for i in &infos {
        if !groups.contains(&i.group) {
            groups.push(i.group);
        }
    }
    let mut out = String::new();
    let heading = anstyle::Style::new().bold();
    for g in groups {
        let _ = writeln!(out, "{heading}{g}{heading:#}");
        for i in infos.iter().filter(|i| i.group == g) {
            let _ = writeln!(out, "  {:width$}  {}", i.name, i.title);
        }
        out.push('\n');
    }
    out.push_str("`pathwarp help NAME` tells more; `+` between two of them chains them.\n");
    let plain = if std::io::stdout().is_terminal() { out } else { anstream::adapter::strip_str(&out).to_string() };
    output::to_stdout(plain.as_bytes())?;
    Ok(Outcome::Done)
}

/// `pathwarp completions SHELL`.
pub(crate) fn completions(registry: &Registry, m: &ArgMatches) -> Result<Outcome, Failure> {
    let mut out = Vec::new();
    if let Some(shell) = m.get_one::<clap_complete::Shell>("SHELL") {
        clap_complete::generate(*shell, &mut build(registry), "pathwarp", &mut out);
    }
    output::to_stdout(&out)?;
    Ok(Outcome::Done)
}

/// `pathwarp man`.
pub(crate) fn man(registry: &Registry) -> Result<Outcome, Failure> {
    let mut out = Vec::new();
    clap_mangen::Man::new(build(registry)).render(&mut out).map_err(|e| Failure::stdout(&e))?;
    output::to_stdout(&out)?;
    Ok(Outcome::Done)
}
