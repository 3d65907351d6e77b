//! The command line: one subcommand for each deformation of the registry, and one file for each further subcommand.

mod about;
mod args;
mod compare;
mod convert;
mod edit;
mod exact;
mod gimp_paths;
mod help;
mod install;
mod map;
mod plugin;
mod render;
mod solid;
pub(crate) mod text;
mod warp;

pub(crate) use convert::convert_file;

use crate::arguments;
use crate::ending::{Ending, Status};
use crate::plugins::{self, Plugins};
use crate::{mistakes, watch};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{ArgMatches, Command};
use pathwarp::deform::Registry;
use pathwarp::param::shape_names;
use pathwarp_engine::catalogue::Catalogue as _;
use pathwarp_engine::edits;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::{advice, coming_from, output};
use std::ffi::OsString;

/// The placeholder of a path reference in help.
const PATHREF: &str = "PATHREF";

const ABOUT: &str = "Bends, warps and deforms SVG artwork, and writes clean Bézier curves.";

const AFTER: &str = "Path references (PATHREF), for every option that takes a path:
  FILE#NAME       the path with that id, label or title in an SVG file, or with that name in a GIMP file (XCF, point list)
  FILE            the only path in the file, or a JSON file of points [[x,y],…]
  #NAME           a path of the input document; it becomes a guide: not part of the artwork, but kept in the file
  'M 0,0 C …'     SVG path data
  heart           a shape about the middle of the frame and as wide; heart,ratio=1.2 sets width to height, heart,width=80mm the width:
SHAPES
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

/// Returns the whole command line.
pub(crate) fn build(registry: &Registry) -> Command {
    let deformations = registry.entries().iter().map(|e| warp::deformation_command(e.info()));
    root().subcommands(deformations).subcommands(OTHERS.iter().map(|o| (o.declare)(registry)))
}

/// Returns the command line with only the subcommand that `word` names: declaring all takes longer than warping a small drawing.
fn build_for(registry: &Registry, word: Option<&OsString>) -> Command {
    let word = word.and_then(|w| w.to_str()).unwrap_or_default();
    if let Some(entry) = registry.get(word) {
        return root().subcommand(warp::deformation_command(entry.info()));
    }
    match find_other(word) {
        Some(o) => root().subcommand((o.declare)(registry)),
        None => build(registry),
    }
}

/// Returns the command line without subcommands.
fn root() -> Command {
    let lines: Vec<String> = shape_names().chunks(8).map(|names| format!("{:18}{}", "", names.join(" "))).collect();
    Command::new("pathwarp")
        .version(env!("CARGO_PKG_VERSION"))
        .about(ABOUT)
        .after_help(
            "Paths in options, chains, exit codes: pathwarp --help. A word of another program: pathwarp help WORD",
        )
        .after_long_help(AFTER.replace("SHAPES", &lines.join("\n")))
        .subcommand_required(true)
        .arg_required_else_help(true)
        .infer_subcommands(false)
        .arg(plugins::option())
}

/// A subcommand that is not a deformation.
struct Subcommand {
    name: &'static str,
    declare: fn(&Registry) -> Command,
    run: fn(&Call<'_>) -> Result<Status, Ending>,
}

/// A parsed command line.
struct Call<'a> {
    registry: &'a Registry,
    plugins: &'a Plugins,
    matches: &'a ArgMatches,
    /// The words of the first part, and those of the parts after each `+`.
    words: &'a [OsString],
    later: &'a [&'a [OsString]],
}

impl Call<'_> {
    /// Runs the deformation or edit `name`.
    fn deform(&self, name: &str) -> Result<Status, Ending> {
        warp::deform(self.registry, name, self.matches, self.words, self.later)
    }
}

const fn subcommand(
    name: &'static str,
    declare: fn(&Registry) -> Command,
    run: fn(&Call<'_>) -> Result<Status, Ending>,
) -> Subcommand {
    Subcommand { name, declare, run }
}

/// The subcommands that are not deformations, in the order of the help.
static OTHERS: &[Subcommand] = &[
    subcommand("edit", |_| edit::edit_command(), |c| Ok(edit::edit(c.registry, c.plugins, c.matches)?)),
    subcommand("run", warp::run_command, |c| Ok(warp::run_recipe(c.registry, c.matches, c.words)?)),
    subcommand("list", |_| about::list_command(), |c| Ok(about::list(c.registry, c.plugins, c.matches)?)),
    subcommand("map", map::map_command, |c| map::map(c.registry, c.matches, c.later)),
    subcommand("solid", |_| solid::solid_command(), |c| solid::solid(c.matches, c.later)),
    subcommand("unwarp", |_| convert::unwarp_command(), |c| Ok(convert::unwarp(c.matches)?)),
    subcommand("schema", |_| about::schema_command(), |c| Ok(about::print_schema(c.registry)?)),
    subcommand("text", text::text_command, |c| Ok(text::text(c.registry, c.matches, c.words)?)),
    subcommand("badge", text::badge_command, |c| Ok(text::badge(c.registry, c.matches, c.words)?)),
    subcommand("paths", |_| convert::paths_command(), |c| Ok(convert::list_paths(c.matches)?)),
    subcommand("caption", |_| warp::caption_command(), |c| c.deform("caption")),
    subcommand("simplify", |_| warp::simplify_command(), |c| c.deform("simplify")),
    subcommand("offset", |_| warp::offset_command(), |c| c.deform("offset")),
    subcommand("unite", |_| warp::unite_command(), |c| c.deform("unite")),
    subcommand("contour", |_| warp::contour_command(), |c| c.deform("contour")),
    subcommand("outline", |_| warp::outline_command(), |c| c.deform("outline")),
    subcommand("convert", |_| convert::convert_command(), |c| Ok(convert::convert(c.matches)?)),
    subcommand("render", |_| render::render_command(), |c| Ok(render::render(c.matches)?)),
    subcommand("gallery", render::gallery_command, |c| Ok(render::gallery(c.registry, c.matches)?)),
    subcommand("compare", |_| compare::compare_command(), |c| Ok(compare::compare_files(c.matches)?)),
    subcommand("check", |_| plugin::check_command(), |c| Ok(plugin::check(c.registry, c.plugins, c.matches)?)),
    subcommand(
        "new-plugin",
        |_| plugin::new_plugin_command(),
        |c| {
            let is_taken = |name: &str| name == "help" || find_other(name).is_some() || c.registry.get(name).is_some();
            Ok(plugin::new_plugin(c.matches, is_taken)?)
        },
    ),
    subcommand("install", |_| install::install_command(), |c| Ok(install::install(c.registry, c.matches)?)),
    subcommand(
        "completions",
        |_| about::completions_command(),
        |c| Ok(about::completions(c.registry, build(c.registry), c.matches)?),
    ),
    subcommand("man", |_| about::man_command(), |c| Ok(about::man(build(c.registry), c.matches)?)),
];

/// Finds a subcommand that is not a deformation.
fn find_other(name: &str) -> Option<&'static Subcommand> {
    OTHERS.iter().find(|o| o.name == name)
}

/// Runs the subcommand that `args` names; the first of them is the program's name.
pub(crate) fn dispatch(registry: &Registry, args: &[OsString]) -> Result<Status, Ending> {
    let (args, plugins) = plugins::load(registry, args, &OTHERS.iter().map(|o| o.name).collect::<Vec<_>>())?;
    let result = dispatch_with(&plugins, &plugins.added_to(registry), &args);
    plugins.show_messages();
    result
}

/// Corrects the spelling of a command in `help WORD…`: capitals, accents, spaces or underscores for hyphens. `None` if that does not help.
fn respelled(registry: &Registry, args: &[OsString]) -> Option<Vec<OsString>> {
    let [program, help, words @ ..] = args else { return None };
    let wanted = coming_from::plain(&join_words(words));
    let is_wanted = |name: &&str| !wanted.is_empty() && coming_from::plain(name) == wanted;
    let mut names = OTHERS.iter().map(|o| o.name).chain(registry.infos().into_iter().map(|i| i.name));
    let name = names.find(is_wanted).filter(|_| help == "help" && words.iter().all(|w| w != "+"))?;
    Some(vec![program.clone(), help.clone(), name.into()])
}

/// Runs a subcommand with the plug-ins that are loaded, which `registry` has, too.
fn dispatch_with(plugins: &Plugins, registry: &Registry, args: &[OsString]) -> Result<Status, Ending> {
    let respelled = respelled(registry, args);
    let args = respelled.as_deref().unwrap_or(args);
    // Each part after a lone `+` is parsed separately.
    let mut parts = args.split(|a| a == "+");
    let first = parts.next().unwrap_or_default();
    let later: Vec<&[OsString]> = parts.collect();
    if first.get(1).is_some_and(|w| w == "help") && first.get(2).is_some_and(|w| w == "options") {
        output::to_stdout(help::options(arguments::options_without_inputs()).as_bytes())?;
        return Ok(Status::Complete);
    }
    if let Some(text) = foreign_help(registry, first) {
        output::to_stdout(text.as_bytes())?;
        return Ok(Status::Complete);
    }
    if let Some(problem) = mistakes::single_dashed(args, || options_of(registry, args)) {
        return Err(Failure::Usage(problem).into());
    }
    let mut command = build_for(registry, first.get(1));
    if first.iter().any(|a| a == "-h") {
        command = help::shortened(command, &first[1..], "pathwarp");
    } else if first.iter().any(|a| a == "--help") || first.get(1).is_some_and(|a| a == "help") {
        command = help::paged(command, &first[1..]);
    }
    let matches = command
        .try_get_matches_from(first)
        .map_err(|e| broken_plugin(plugins, first).map_or_else(|| with_advice(registry, first, e), Ending::from))?;
    let Some((name, m)) = matches.subcommand() else {
        return Err(Failure::usage("no command given; `pathwarp list` shows the deformations").into());
    };
    let reading = arguments::reading(m)?;
    // An editor may stay open for hours; it counts the work of each picture.
    if name != "edit" {
        watch::begin(reading.limits);
    }
    // The pipeline checks the fonts later, when it knows the options of all parts and of the recipe.
    if registry.get(name).is_some() {
        return warp::deform(registry, name, m, first, &later).map_err(|e| match e {
            Ending::Clap(e) => with_advice(registry, args, e),
            other => other,
        });
    }
    if name != "run" {
        reading.check()?;
    }
    let takes_chain = ["run", "map", "solid"].contains(&name) || edits::info(name).is_some();
    if !takes_chain && !later.is_empty() {
        return Err(Failure::usage(format!("{name} is not a deformation; `+` chains deformations")).into());
    }
    let missing = || Failure::usage(format!("there is no command {name}"));
    (find_other(name).ok_or_else(missing)?.run)(&Call { registry, plugins, matches: m, words: first, later: &later })
}

/// Joins words to a text.
fn join_words(words: &[OsString]) -> String {
    words.iter().map(|w| w.to_string_lossy()).collect::<Vec<_>>().join(" ")
}

/// Returns the text of `help WORD` for a word, or several words, that is not a command.
fn foreign_help(registry: &Registry, args: &[OsString]) -> Option<String> {
    let [_, help, words @ ..] = args else { return None };
    let command = |name: &str| build_for(registry, Some(&name.into())).find_subcommand(name).cloned();
    let wanted = join_words(words);
    if help != "help" || wanted.starts_with('-') || command(&wanted).is_some() || wanted == "help" {
        return None;
    }
    coming_from::help(registry, &wanted, |name| command(name)?.get_about().map(ToString::to_string))
}

/// Returns the error that `args` begin with a deformation whose plug-in is broken.
fn broken_plugin(plugins: &Plugins, args: &[OsString]) -> Option<Failure> {
    let word = args.get(1).filter(|w| *w != "help").or(args.get(2));
    plugins.failure(word?.to_str()?)
}

/// Adds advice to an error of clap: commands and options of other programs, and quotes for `#NAME`, a comment to shells.
fn with_advice(registry: &Registry, args: &[OsString], mut error: clap::Error) -> Ending {
    let context = |kind: ContextKind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.clone()),
        _ => None,
    };
    let is_help = args.get(1).is_some_and(|a| a == "help");
    match error.kind() {
        ErrorKind::InvalidSubcommand if args.get(1).is_none_or(|a| a != "solid") => {
            let asked = args.get(2..).filter(|words| is_help && !words.is_empty()).map(join_words);
            let word = asked.or_else(|| context(ContextKind::InvalidSubcommand)).unwrap_or_default();
            if let Some(meant) = mistakes::command(registry, &word) {
                return Failure::usage(meant).into();
            }
            let whole = build(registry);
            let foreign: Vec<String> = coming_from::all().map(|w| w.words[0].to_lowercase()).collect();
            let known = whole.get_subcommands().map(Command::get_name).chain(foreign.iter().map(String::as_str));
            let word = word.to_lowercase();
            let unknown = advice::unknown("command", &word, known);
            let separator = if unknown.ends_with('?') { " " } else { "; " };
            let unknown = unknown + separator + "`pathwarp list` shows all deformations";
            if is_help { Failure::usage(unknown).into() } else { error.into() }
        }
        ErrorKind::InvalidValue if context(ContextKind::InvalidArg).is_some_and(|arg| arg.contains(PATHREF)) => {
            let advice = "shells take a word that starts with # for a comment; quote it: '#NAME'";
            error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![advice.into()]));
            error.into()
        }
        ErrorKind::UnknownArgument => {
            let arg = context(ContextKind::InvalidArg).unwrap_or_default();
            let known = options_of(registry, args);
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            let problem = if arg.starts_with('-') {
                format!("there is no option {arg}; {}", mistakes::option(&arg, &known))
            } else {
                format!("{arg} is one word too many; {}", mistakes::surplus(&arg, args, &known))
            };
            Failure::usage(problem).into()
        }
        _ => error.into(),
    }
}

/// Returns the options of the commands that a command line names.
fn options_of(registry: &Registry, args: &[OsString]) -> Vec<String> {
    let commands = args.iter().enumerate().skip(1).filter(|(i, _)| *i == 1 || args[i - 1] == "+").map(|(_, word)| word);
    let options = commands.flat_map(|word| {
        let whole = build_for(registry, Some(word));
        let arguments =
            word.to_str().and_then(|w| whole.find_subcommand(w)).into_iter().flat_map(Command::get_arguments);
        arguments.filter_map(|a| a.get_long().map(str::to_owned)).collect::<Vec<_>>()
    });
    options.collect()
}
