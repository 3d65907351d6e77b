//! Arguments that the subcommands of `solid` share.

use crate::arguments::{INPUT, some_options};
use crate::commands::args::option;
use clap::{Arg, ArgMatches, value_parser};
use pathwarp::kurbo::Rect;
use pathwarp::param::{Axis, Frame, Length, LengthUnit};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::units::MM_PER_PX;
use pathwarp_solid::Box3;
use pathwarp_solid::glam::DVec3;
use std::path::PathBuf;

/// The common options that apply to solids.
const SHARED: &[&str] = &[
    "out",
    "out-dir",
    "precision",
    "report",
    "write-recipe",
    "preview",
    "explain",
    "jobs",
    "limit",
    "allow-external",
    "quiet",
];

/// Returns the common options.
pub(super) fn options() -> Vec<Arg> {
    some_options(SHARED).collect()
}

/// Returns the arguments for models, the common options and the box.
pub(super) fn model_args() -> Vec<Arg> {
    let model = Arg::new(INPUT)
        .num_args(0..)
        .value_name("MODEL")
        .value_parser(value_parser!(PathBuf))
        .help(
            "Models: OBJ, STL, PLY or glTF files, curved surfaces (.bpt, .json), or SVG drawings; - or none reads standard input",
        );
    let common = |name, value, help| option(name, value, help).help_heading("Common options");
    let refine = common(
        "refine",
        "D",
        "Subdivide faces until the deformed surface is within D of the exact one: units of the model, or a length such as 0.05mm; \
         without it, vertices move and edges stay straight. For curved surfaces the largest distance where the image is not exact \
         [default: a ten-thousandth of their size]",
    );
    let extrude = common(
        "extrude",
        "DEPTH",
        "Make a drawing's fills and strokes solids of this depth, such as 5mm; without it they are flat",
    );
    std::iter::once(model).chain(options()).chain([frame_arg(), refine, extrude]).collect()
}

/// The options only for solids.
pub(super) struct SolidOptions {
    /// The box that percentages refer to, if it differs from the model's.
    pub(super) frame: Option<Box3>,
    /// The largest distance between the deformed surface and the exact one.
    pub(super) refine: Option<Length>,
    /// Depth in millimetres to which a drawing is extruded.
    pub(super) depth: Option<f64>,
}

impl SolidOptions {
    /// Reads the options from a command line.
    pub(super) fn read(m: &ArgMatches) -> Result<Self, Failure> {
        let in_mm = Frame::new(Rect::ZERO).with_units_per_px([MM_PER_PX; 2]);
        let depth = length(m, "extrude")?.map(|l| l.in_units(Axis::X, &in_mm));
        Ok(Self { frame: given_frame(m)?, refine: length(m, "refine")?, depth })
    }
}

/// Returns the positive length given for an option.
fn length(m: &ArgMatches, option: &str) -> Result<Option<Length>, Failure> {
    let Some(text) = m.get_one::<String>(option) else { return Ok(None) };
    let wrong = |problem: String| Failure::usage(format!("--{option}: `{text}` {problem}"));
    let length: Length = text.parse().map_err(|e| wrong(format!("{e}")))?;
    let is_valid = length.value > 0.0 && length.unit != LengthUnit::Percent;
    if is_valid { Ok(Some(length)) } else { Err(wrong("is not a positive length".into())) }
}

/// The option `--box`.
pub(super) fn frame_arg() -> Arg {
    let help = "Box that percentages and defaults refer to [default: the model's box]";
    option("box", "X,Y,Z,W,H,D", help).allow_hyphen_values(true).help_heading("Common options")
}

/// Returns the box given by `--box`.
pub(super) fn given_frame(m: &ArgMatches) -> Result<Option<Box3>, Failure> {
    let Some(text) = m.get_one::<String>("box") else { return Ok(None) };
    let finite = |word: &str| word.trim().parse().ok().filter(|v: &f64| v.is_finite());
    let numbers: Option<Vec<f64>> = text.split(',').map(finite).collect();
    match numbers.as_deref() {
        Some(&[x, y, z, w, h, d]) if [w, h, d].iter().all(|v| *v > 0.0) => {
            let min = DVec3::new(x, y, z);
            Ok(Some(Box3 { min, max: min + DVec3::new(w, h, d) }))
        }
        _ => Err(Failure::usage(format!("--box: `{text}` is not X,Y,Z,W,H,D with positive W, H and D"))),
    }
}
