//! What is done to shapes without bending them: the parameters of `simplify`, `offset` and `outline`, read like those of a deformation.

use pathwarp::Error;
use pathwarp::edit::{Offset, Side};
use pathwarp::kurbo::Join;
use pathwarp::param::{Args, Axis, Frame, Kind, Param, Settings};
use pathwarp::recipe::{Recipe, Step};
use pathwarp_svg::Edit;

/// Tolerance of [`SIMPLIFY`] as a fraction of the artwork's diagonal, if none is given: half a pixel of a thousand.
const SIMPLIFY_TOLERANCE: f64 = 5e-4;

/// Joints that turn by more than these degrees are corners: of paths, and of polylines.
const CORNERS: f64 = 15.0;
const POLYLINE_CORNERS: f64 = 30.0;

/// A kind of edit.
#[derive(Debug)]
pub struct EditInfo {
    /// Name of the command.
    pub name: &'static str,
    /// Parameters, of which the command has options.
    pub params: &'static [Param],
    /// Default tolerance as a fraction of the artwork's diagonal; `None` if it is that of deformations.
    pub tolerance: Option<f64>,
    read: fn(&Settings<'_>) -> Result<Edit, Error>,
}

impl PartialEq for EditInfo {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// Gives paths the fewest nodes within a distance.
pub static SIMPLIFY: EditInfo = EditInfo {
    name: "simplify",
    params: &[
        Param::angle("corners", "Joints that turn by more than this stay corners [default: 15deg, of polylines 30deg]")
            .within(0.0, 80.0),
        Param::flag("polylines", "Draw curves through the vertices of paths that are all straight lines"),
    ],
    tolerance: Some(SIMPLIFY_TOLERANCE),
    read: |s| {
        let polylines = s.flag("polylines")?;
        let usual = if polylines { POLYLINE_CORNERS } else { CORNERS };
        Ok(Edit::Simplify { corner: s.number_if("corners")?.unwrap_or(usual).to_radians(), polylines })
    },
};

/// Turns strokes into areas.
pub static OUTLINE: EditInfo = EditInfo { name: "outline", params: &[], tolerance: None, read: |_| Ok(Edit::Outline) };

/// Moves outlines by a distance.
pub static OFFSET: EditInfo = EditInfo {
    name: "offset",
    params: &[
        Param::length("by", Axis::Diagonal, "Distance by which outlines move, such as 2mm.").within(1e-9, 1e9).needed(),
        Param::new("join", Kind::Choice(&["round", "miter", "bevel"]), "What becomes of corners that open.").default("round"),
        Param::new(
            "side",
            Kind::Choice(&["outside", "inside", "both"]),
            "outside: areas grow, and open paths run to their right, as one walks along them; inside: they shrink, and run to their left.",
        )
        .default("outside"),
    ],
    tolerance: None,
    read: |s| {
        let join = match s.choice("join")? {
            "miter" => Join::Miter,
            "bevel" => Join::Bevel,
            _ => Join::Round,
        };
        let side = match s.choice("side")? {
            "inside" => Side::Inside,
            "both" => Side::Both,
            _ => Side::Outside,
        };
        Ok(Edit::Offset(Offset { by: s.number("by")?, join, side, even_odd: false }))
    },
};

pub(crate) static EDITS: [&EditInfo; 3] = [&SIMPLIFY, &OFFSET, &OUTLINE];

/// An edit with its values as given.
#[derive(Debug, Clone, PartialEq)]
pub struct EditChoice {
    /// The kind.
    pub info: &'static EditInfo,
    /// The values of its parameters.
    pub args: Args,
}

impl EditChoice {
    /// The edit of artwork in this frame.
    pub fn read(&self, frame: &Frame) -> Result<Edit, Error> {
        (self.info.read)(&Settings::new(self.info.params, &self.args, frame)?)
    }
}

/// The usual edit that gives paths few nodes.
pub(crate) fn simplifying() -> Edit {
    Edit::Simplify { corner: CORNERS.to_radians(), polylines: false }
}

/// The usual edit by which areas grow, or shrink by a distance below zero.
pub(crate) fn growing(by: f64) -> Edit {
    let side = if by > 0.0 { Side::Outside } else { Side::Inside };
    Edit::Offset(Offset { by: by.abs(), join: Join::Round, side, even_odd: false })
}

/// The recipe of an edit, in which nothing moves: its frame is what lengths refer to.
pub fn still() -> Recipe {
    Recipe { steps: vec![Step::new("affine", Args::new())] }
}
