//! Edits: steps at the beginning of a recipe that change shapes without bending them. The options `simplify` and `outset` stand for the usual
//! ones.

use crate::caption::CAPTION;
use crate::failure::Failure;
use pathwarp::deform::{ByHand, Info};
use pathwarp::param::{Axis, Kind, Param};
use pathwarp::recipe::{Recipe, Step};

/// The edits. Each has the name of its command. Captions come before the others wherever they stand among them.
pub static EDITS: [Info; 6] = [
    CAPTION,
    Info::new("simplify", "give paths the fewest nodes within a distance")
        .group("Before bending")
        .params(&[
            Param::length("within", Axis::Diagonal, "Largest distance from the drawing as it was.")
                .within(0.0, 1e9)
                .slider(0.0, 2.0),
            Param::angle(
                "corners",
                "Joints that turn by more than this stay corners. Default: those for which no smooth curve can stand within the distance.",
            )
            .within(0.0, 180.0),
            // Recipes of older versions have it.
            Param::flag("polylines", ""),
        ])
        .by_hand(ByHand { neutral: &[("within", "0.05%")], showing: &[("within", "1%")], ..ByHand::NONE }),
    Info::new("offset", "let areas grow, or shrink")
        .group("Before bending")
        .params(&[
            Param::length("by", Axis::Diagonal, "Distance by which outlines move, such as 2mm.")
                .within(1e-9, 1e9)
                .slider(0.0, 10.0)
                .needed(),
            Param::new("join", Kind::Choice(&["round", "miter", "bevel"]), "What becomes of corners that open.")
                .default("round"),
            Param::new(
                "side",
                Kind::Choice(&["outside", "inside", "both"]),
                "outside: areas grow, and open lines run to their right, as one walks along them; inside: they shrink, and run to their left.",
            )
            .default("outside"),
            Param::flag("lines", "Move open lines sideways where there are areas, too. Default: they stay, unless there is nothing else."),
        ])
        .by_hand(ByHand {
            labels: &[("by", "Distance")],
            neutral: &[("by", "1%")],
            showing: &[("by", "2%")],
            ..ByHand::NONE
        }),
    Info::new("unite", "make one shape of those that overlap or touch")
        .group("Before bending")
        .params(&[Param::new(
            "by",
            Kind::Choice(&["all", "fill"]),
            "all: one shape of all; fill: one for each colour, gradient or pattern.",
        )
        .default("all")])
        .by_hand(ByHand { labels: &[("by", "One shape of")], ..ByHand::NONE }),
    Info::new("contour", "draw one line around all that is visible")
        .group("Before bending")
        .params(&CONTOUR)
        .by_hand(ByHand {
            labels: &[("by", "Distance"), ("holes", "Holes"), ("join", "Join"), ("only", "Only the line")],
            neutral: &[("by", "1%")],
            showing: &[("by", "3%")],
            ..ByHand::NONE
        }),
    Info::new("outline", "turn strokes and text into filled outlines").group("Before bending"),
];

const CONTOUR: [Param; 8] = [
    Param::length(
        "by",
        Axis::Diagonal,
        "Distance of the line from the artwork, such as 3mm; inside of its edge if below zero.",
    )
    .within(-1e9, 1e9)
    .slider(0.0, 20.0)
    .needed(),
    Param::new(
        "holes",
        Kind::Choice(&["fill", "keep"]),
        "fill: one line around each island; keep: another in each hole that is left.",
    )
    .default("fill"),
    Param::flag("join", "Bridge what lies further apart than twice the distance with necks as wide as the distance."),
    Param::flag("only", "The line without the artwork."),
    Param::new(
        "spot",
        Kind::Text("NAME"),
        "Name of the line's layer, and in a PDF of its ink, such as CutContour, which is printed over what lies below.",
    ),
    Param::flag("knockout", "Let the ink of --spot knock out what lies below."),
    Param::length("bleed", Axis::Diagonal, "How far the artwork's edge colours go on beyond the line, such as 2mm.")
        .within(0.0, 1e9),
    Param::flag("marks", "Draw crop and register marks around the line."),
];

/// The description of the edit called `name`.
pub fn info(name: &str) -> Option<&'static Info> {
    EDITS.iter().find(|info| info.name == name)
}

/// Divides a recipe into its edits and the steps that bend.
///
/// # Errors
/// An edit comes later, or is inverse.
pub fn divided(recipe: &Recipe) -> Result<(Vec<Step>, Recipe), Failure> {
    let is_edit = |s: &&Step| info(&s.deformation).is_some();
    let (edits, steps) = recipe.steps.split_at(recipe.steps.iter().take_while(is_edit).count());
    let inverse = edits.iter().find(|s| s.inverse);
    match inverse.or_else(|| steps.iter().find(is_edit)) {
        Some(s) => {
            let name = &s.deformation;
            Err(Failure::usage(format!("{name} comes before all steps that bend, and has no inverse")))
        }
        None => Ok((edits.to_vec(), Recipe { steps: steps.to_vec() })),
    }
}
