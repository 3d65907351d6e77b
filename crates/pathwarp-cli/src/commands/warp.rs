//! Commands that warp files: `pathwarp DEFORMATION …` by a deformation or a chain, `run` by a saved recipe, and the edits `simplify`,
//! `offset`, `unite`, `contour` and `outline`.

use crate::arguments::{self, inputs_arg};
use crate::commands::args::{file_arg, given_file, switch};
use crate::ending::{Ending, Status};
use crate::steps::{self, ChainPart};
use crate::{mistakes, pipeline};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command};
use pathwarp::deform::{Info, Registry};
use pathwarp::param::Kind;
use pathwarp::recipe::{Recipe, Step};
use pathwarp_engine::edits;
use pathwarp_engine::failure::Failure;
use pathwarp_engine::options::{Given, OPTIONS};
use pathwarp_engine::recipe_file;
use pathwarp_engine::steps::INVERSE;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fmt::Write as _;

pub(super) fn deformation_command(info: &Info) -> Command {
    described(info).args(arguments::args())
}

/// Returns the subcommand of a deformation, of the plane or of space, with its help and parameters.
pub(super) fn described(info: &Info) -> Command {
    let mut examples = String::from("Examples:");
    for e in info.examples {
        let _ = write!(examples, "\n  {}:\n    pathwarp {}", e.what, e.command);
    }
    let _ = write!(examples, "\n\nSource: {}", info.source);
    Command::new(info.name)
        .aliases(steps::alias(info.name))
        .about(info.title)
        .long_about(format!("{} — {}\n\n{}", info.name, info.title, info.about))
        .after_help(examples)
        .args(steps::args(info))
}

/// Runs the deformation `name`, chained with those in `later`.
pub(super) fn deform(
    registry: &Registry,
    name: &str,
    m: &ArgMatches,
    words: &[OsString],
    later: &[&[OsString]],
) -> Result<Status, Ending> {
    let first = ChainPart { step: steps::step(registry, name, m), options: arguments::given(m) };
    let mut parts = vec![first];
    parts.extend(steps::parts(registry, later, &arguments::options_without_inputs().collect::<Vec<_>>())?);
    let (recipe, given) = steps::chained(parts)?;
    check_inputs(words, &given)?;
    let bends = recipe.steps.iter().any(|s| edits::info(&s.deformation).is_none());
    let is_for_edits = |name: &&str| EDIT_OPTIONS.iter().chain(&SHARED).any(|known| known == name);
    if let Some(other) = given.names().find(|name| !bends && !is_for_edits(name)) {
        return Err(Failure::usage(format!("--{other} is for steps that bend; {name} does not bend")).into());
    }
    Ok(pipeline::run(registry, &recipe, &given, None)?)
}

/// Refuses inputs that are parts of values, options or names.
fn check_inputs(words: &[OsString], given: &Given) -> Result<(), Failure> {
    let problem = mistakes::inputs(words, given.inputs(), given.gives("out") || given.gives("out-dir"));
    problem.map_or(Ok(()), |problem| Err(Failure::Usage(problem)))
}

pub(super) fn run_command(registry: &Registry) -> Command {
    Command::new("run")
        .about("Run a recipe file that --write-recipe saved")
        .arg(file_arg("RECIPE", "A recipe (TOML)"))
        .arg(switch(INVERSE, "Apply the inverse of every step, the last first (give --frame: the source's box)"))
        .args(arguments::args())
        .args(parameters(registry))
        .args_override_self(true)
        .after_help(
            "A recipe:\n  pathwarp = 1\n  [options]\n  tolerance = \"0.01\"\n  [[step]]\n  deformation = \"shaper\"\n  \
             shaper = \"cage.svg#flag\"   # relative to the recipe's own folder\n  select = [\"#logo\"]           # this step holds for a part only; also exclude\n\nExamples:\n  pathwarp shaper logo.svg \
             --shaper cage.svg -o out.svg --write-recipe flag.toml\n  pathwarp run flag.toml other.svg -o other-out.svg\n  pathwarp run \
             flag.toml other.svg --bottom 2 -o other-out.svg   # overrides the recipe's value",
        )
}

/// Returns the parameters of all deformations, which override the recipe's. They are hidden, since the recipe determines which apply.
fn parameters(registry: &Registry) -> Vec<Arg> {
    // Each name, with `true` if it is a switch in every deformation that has it.
    let mut known: BTreeMap<&'static str, bool> = BTreeMap::new();
    for p in registry.entries().iter().flat_map(|e| e.info().params) {
        *known.entry(p.name).or_insert(true) &= p.kind == Kind::Flag;
    }
    let is_taken = |name: &str| name == INVERSE || OPTIONS.iter().any(|o| o.name == name);
    let arg = |(name, is_flag): (&'static str, bool)| {
        let arg = Arg::new(name).long(name).hide(true);
        if is_flag { arg.action(ArgAction::SetTrue) } else { arg.action(ArgAction::Append).allow_hyphen_values(true) }
    };
    known.into_iter().filter(|(name, _)| !is_taken(name)).map(arg).collect()
}

/// Sets the parameters given on the command line in the only step that has them.
fn override_parameters(registry: &Registry, recipe: &mut Recipe, m: &ArgMatches) -> Result<(), Failure> {
    for id in m.ids() {
        let name = id.as_str();
        if m.value_source(name) != Some(ValueSource::CommandLine) || OPTIONS.iter().any(|o| o.name == name) {
            continue;
        }
        let has_param = |info: &Info| info.params.iter().any(|p| p.name == name);
        if !registry.entries().iter().any(|e| has_param(e.info())) {
            continue;
        }
        let has = |step: &Step| registry.get(&step.deformation).is_some_and(|e| has_param(e.info()));
        let mut steps: Vec<&mut Step> = recipe.steps.iter_mut().filter(|s| has(s)).collect();
        let values = || m.get_raw(name).into_iter().flatten().map(|v| v.to_string_lossy().into_owned()).collect();
        match steps.as_mut_slice() {
            [only] => only.args.set(name, values()),
            [] => return Err(Failure::usage(format!("no step of the recipe has --{name}"))),
            several => {
                let problem = "steps of the recipe have it; change it in the recipe";
                return Err(Failure::usage(format!("--{name}: {} {problem}", several.len())));
            }
        }
    }
    Ok(())
}

pub(super) fn run_recipe(registry: &Registry, m: &ArgMatches, words: &[OsString]) -> Result<Status, Failure> {
    let file = given_file(m, "RECIPE")?;
    let mut saved = recipe_file::read(registry, file, arguments::reading(m)?.external)?;
    override_parameters(registry, &mut saved.recipe, m)?;
    let given = saved.options.overridden_by(&arguments::given(m));
    check_inputs(words, &given)?;
    // The command line has no conflicts by itself, so a conflict found now involves the recipe.
    given.check_conflicts().map_err(|e| Failure::file(file, format!("[options] {e}")))?;
    let recipe = if m.get_flag(INVERSE) { saved.recipe.inverted() } else { saved.recipe };
    pipeline::run(registry, &recipe, &given, Some(file))
}

/// The common options in the help of edits, which concern inputs and outputs.
const SHARED: [&str; 29] = [
    "out",
    "format",
    "out-dir",
    "in-place",
    "recursive",
    "dry-run",
    "into",
    "salvage",
    "tolerance",
    "select",
    "exclude",
    "precision",
    "structure",
    "dxf-curves",
    "kerf",
    "engrave",
    "duplicates",
    "page-width",
    "page-height",
    "frame",
    "fit",
    "on-error",
    "report",
    "preview",
    "write-recipe",
    "embed-recipe",
    "jobs",
    "explain",
    "quiet",
];

/// The options that some edits list beside their parameters.
const EDIT_OPTIONS: [&str; 3] = ["text", "union", "image-dpi"];

pub(super) fn caption_command() -> Command {
    let about = "Set words on a drawing";
    edit_command("caption", about, &[])
        .long_about(format!(
            "{about}.\n\nThe words lie above the drawing, as the outlines of their letters, and bend with it. A recipe has them as words. The group \
             of the first caption is called caption-1, and its letters caption-1-1, caption-1-2 and so on, for --select.",
        ))
        .after_help(
            "Examples:\n  A name below a badge:\n    pathwarp caption badge.svg --words Fjord --at 50%,105% --align center -o named.svg\n  Two \
             lines, and then a flag of all:\n    pathwarp caption badge.svg --words 'The Old' --words Bakery --weight bold --fill '#c30' -o flag.svg + \
             warp --style flag",
        )
}

pub(super) fn simplify_command() -> Command {
    let about = "Give paths the fewest nodes within a distance";
    edit_command("simplify", about, &[])
        .long_about(format!(
            "{about}.\n\nTraced drawings and those of many small steps get smooth curves with few nodes, each point of which is within \
             --tolerance of the original, and the original of them. Ids, classes, groups and everything else stay as they are; so do \
             paths that would not get fewer nodes, basic shapes, text and copies (use).",
        ))
        .after_help(
            "Examples:\n  A traced drawing:\n    pathwarp simplify trace.svg -o clean.svg\n  Within a tenth of a millimetre, for a \
             cutter:\n    pathwarp simplify trace.svg --tolerance 0.1mm -o clean.dxf\n  A folder, in place:\n    pathwarp simplify icons/ \
             --recursive --in-place",
        )
}

pub(super) fn offset_command() -> Command {
    let about = "Let areas grow or shrink, and lines run beside themselves";
    edit_command("offset", about, &["text"])
        .long_about(format!(
            "{about}.\n\nEach point of the result has its distance from the source, within --tolerance. Loops and slivers are removed; what is \
             narrower than the distance vanishes, and a note says so. A path is one area: its outlines unite, those of different paths do \
             not. Open lines stay where they are, unless --lines is given or there is nothing else: then each runs beside itself. Strokes keep \
             their width; text becomes outlines.",
        ))
        .after_help(
            "Examples:\n  Bolder letters:\n    pathwarp offset word.svg --by 0.3mm -o bolder.svg\n  One line around all of a sticker (see contour):\n    \
             pathwarp contour badge.svg --by 3mm -o sticker.svg\n  Parts a little larger, for a \
             tight fit, with room for the cut:\n    pathwarp offset parts.svg --by 0.05mm --join miter --kerf 0.2mm -o parts.dxf\n  Inlays, a little smaller than their \
             holes:\n    pathwarp offset inlays.svg --by 0.2mm --side inside -o smaller.svg",
        )
}

pub(super) fn unite_command() -> Command {
    let about = "Make one shape of those that overlap or touch";
    edit_command("unite", about, &["text"])
        .long_about(format!(
            "{about}.\n\nLetters of a script, joined Arabic, a word on a bar, a logo of parts: what has a fill becomes one outline, in the place \
             and with the paint of the uppermost shape, which names the others in data-united. Curves stay curves, and gaps narrower than \
             --tolerance close. Shapes without a fill stay, and so do strokes; outline turns them into shapes. Clip paths, masks, filters and \
             transparent groups each keep a shape of their own.",
        ))
        .after_help(
            "Examples:\n  A script name, for a cutter:\n    pathwarp unite name.svg -o welded.dxf\n  One shape for each \
             colour, for vinyl:\n    pathwarp unite logo.svg --by fill -o layers.svg\n  A word and the bar below it, and nothing else:\n    pathwarp unite sign.svg \
             --select '#word' --select '#bar' -o sign-cut.svg",
        )
}

pub(super) fn contour_command() -> Command {
    let about = "Draw one line around all that is visible, for stickers and signs";
    edit_command("contour", about, &["text", "image-dpi"])
        .long_about(format!(
            "{about}.\n\nStrokes count with their width, letters as they are set, pictures by their opacity, and clip paths and masks leave what \
             they leave; filters do not count. The line is round around corners, has the distance everywhere within --tolerance, and lies \
             in a layer of its own above the artwork. What is nearer than twice the distance shares a line; a note says how many lines \
             there are. In a PDF, --spot makes the line an ink of its own, as cutting machines look for it.",
        ))
        .after_help(
            "Examples:\n  A sticker's edge around a badge:\n    pathwarp contour badge.svg --by 3mm -o sticker.svg\n  For a print shop, with room to \
             cut:\n    pathwarp contour badge.svg --by 1mm --spot CutContour --bleed 2mm --marks -o sticker.pdf\n  A sign in one piece, \
             only its edge:\n    pathwarp contour word.svg --by 4mm --join --only -o sign.dxf",
        )
}

pub(super) fn outline_command() -> Command {
    let about = "Turn strokes and text into filled outlines";
    edit_command("outline", about, &["text", "union"])
        .long_about(format!(
            "{about}.\n\nThe outline of a stroke, with its joins, caps and dashes, is within --tolerance of what the stroke covers. Shapes \
             without a stroke stay as they are.",
        ))
        .after_help(
            "Examples:\n  A logo for a program that knows no strokes and no fonts:\n    pathwarp outline logo.svg -o outlines.svg\n  Only \
             the strokes:\n    pathwarp outline logo.svg --text skip -o outlines.svg",
        )
}

/// Returns the command of an edit. The common options `listed` stand beside its parameters in the help.
fn edit_command(name: &'static str, about: &'static str, listed: &[&str]) -> Command {
    let option = |arg: Arg| match OPTIONS.iter().find(|o| arg.get_id() == o.name) {
        Some(o) if listed.contains(&o.name) => arg.help_heading("Options"),
        Some(o) if o.reading => arg.help_heading("Reading"),
        Some(o) => arg.hide(!SHARED.contains(&o.name)),
        None => arg,
    };
    let params = edits::info(name).into_iter().flat_map(steps::args);
    // As a command, the edit uses the option `tolerance` instead of `within`.
    let params = params.map(|arg| if arg.get_id() == "within" { arg.hide(true) } else { arg });
    let options = arguments::options_without_inputs().map(option);
    let command = Command::new(name).about(about).arg(inputs_arg()).args(params).args(options);
    if name != "simplify" {
        return command;
    }
    command.mut_arg("tolerance", |a| {
        a.help(
            "Largest distance between the drawing and the result: user units, or a length such as 0.05mm. If it is given, it holds for all \
             contours alike [default: 5e-4 of the artwork's diagonal, and for small contours 2e-3 of their own]",
        )
    })
}
