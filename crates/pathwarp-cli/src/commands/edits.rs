//! `pathwarp simplify`, `offset` and `outline`: edits of shapes, with the inputs and outputs of every deformation.

use super::deformation::mistaken;
use crate::edits::{EDITS, EditChoice, EditInfo, OFFSET, OUTLINE, SIMPLIFY, still};
use crate::failure::Failure;
use crate::options::{Given, inputs_arg, reading_args, some_options};
use crate::pipeline;
use crate::status::Status;
use crate::steps;
use clap::{ArgMatches, Command};
use pathwarp::deform::Registry;
use std::ffi::OsString;

/// The common options that say what is read and where the result goes.
const SHARED: [&str; 20] = [
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
    "on-error",
    "report",
    "preview",
    "jobs",
    "explain",
    "quiet",
];

pub(super) fn simplify() -> Command {
    let about = "Give paths the fewest nodes within a distance";
    declared(&SIMPLIFY, about)
        .long_about(format!(
            "{about}.\n\nTraced drawings and those of many small steps get smooth curves with few nodes, each point of which is within \
             --tolerance of the original, and the original of them. Ids, classes, groups and everything else stay as they are; so do \
             paths that would not get fewer nodes, basic shapes, text and copies (use). The default tolerance is 5e-4 of the drawing's \
             diagonal, and less for small contours.",
        ))
        .after_help(
            "Examples:\n  A traced drawing:\n    pathwarp simplify trace.svg -o clean.svg\n  Within a tenth of a millimetre, for a \
             cutter:\n    pathwarp simplify trace.svg --tolerance 0.1mm -o clean.dxf\n  A folder, in place:\n    pathwarp simplify icons/ \
             --recursive --in-place",
        )
}

pub(super) fn offset() -> Command {
    let about = "Let areas grow or shrink, and lines run beside themselves";
    declared(&OFFSET, about)
        .args(some_options(&["text"]).map(|a| a.help_heading("Options")))
        .long_about(format!(
            "{about}.\n\nEach point of the result has its distance from the source, within --tolerance. Loops and slivers are removed; what is \
             narrower than the distance vanishes, and a note says so. A path is one area: its outlines unite, those of different paths do \
             not. Strokes keep their width; text becomes outlines.",
        ))
        .after_help(
            "Examples:\n  A sticker's edge around a badge:\n    pathwarp offset badge.svg --by 3mm -o edge.svg\n  Half of a laser's kerf, for \
             a tight fit:\n    pathwarp offset parts.svg --by 0.1mm --join miter -o parts.dxf\n  Inlays, a little smaller than their \
             holes:\n    pathwarp offset inlays.svg --by 0.2mm --side inside -o smaller.svg",
        )
}

pub(super) fn outline() -> Command {
    let about = "Turn strokes and text into filled outlines";
    declared(&OUTLINE, about)
        .args(some_options(&["text", "union"]).map(|a| a.help_heading("Options")))
        .long_about(format!(
            "{about}.\n\nThe outline of a stroke, with its joins, caps and dashes, is within --tolerance of what the stroke covers. Shapes \
             without a stroke stay as they are.",
        ))
        .after_help(
            "Examples:\n  A logo for a program that knows no strokes and no fonts:\n    pathwarp outline logo.svg -o outlines.svg\n  Only \
             the strokes:\n    pathwarp outline logo.svg --text skip -o outlines.svg",
        )
}

fn declared(info: &'static EditInfo, about: &'static str) -> Command {
    let own = info.params.iter().map(steps::param_arg);
    let shared = some_options(&SHARED).map(|a| a.help_heading("Common options"));
    Command::new(info.name).about(about).args([inputs_arg()]).args(own).args(shared).args(reading_args())
}

/// Runs the edit `name`.
pub(super) fn run(registry: &Registry, name: &str, m: &ArgMatches, words: &[OsString]) -> Result<Status, Failure> {
    let info =
        EDITS.into_iter().find(|e| e.name == name).ok_or_else(|| Failure::usage(format!("there is no {name}")))?;
    let mut given = Given::inputs_and_options(m);
    given.check_conflicts().map_err(Failure::Usage)?;
    mistaken(words, &given)?;
    given.edit = Some(EditChoice { info, args: steps::param_values(info.params, m) });
    pipeline::run(registry, &still(), &given, None)
}
