//! Edits: steps at the beginning of a recipe that change shapes without bending them. The options `simplify` and `outset` are shortcuts.

use crate::failure::Failure;
use pathwarp::deform::{ByHand, Info};
use pathwarp::param::{Axis, Kind, Param};
use pathwarp::recipe::{Recipe, Step};

/// The edits, each named after its command. Captions are done before the others wherever they stand among them.
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
            // For recipes of older versions.
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
        .params(&CONTOUR_PARAMS)
        .by_hand(ByHand {
            labels: &[("by", "Distance"), ("holes", "Holes"), ("join", "Join"), ("only", "Only the line")],
            neutral: &[("by", "1%")],
            showing: &[("by", "3%")],
            ..ByHand::NONE
        }),
    Info::new("outline", "turn strokes and text into filled outlines").group("Before bending"),
];

/// The edit that sets a caption.
pub const CAPTION: Info =
    Info::new("caption", "set words on the drawing").group("Before bending").params(&CAPTION_PARAMS).by_hand(ByHand {
        label: Some("Words"),
        labels: &[("at", "Place"), ("letter-spacing", "Spacing"), ("line-height", "Line spacing"), ("fill", "Colour")],
        neutral: &[("words", "Words")],
        showing: &[("words", "Words"), ("align", "center"), ("fill", "#c30"), ("size", "30%")],
        ..ByHand::NONE
    });

const CAPTION_PARAMS: [Param; 10] = [
    Param::new("words", Kind::Text("WORDS"), "The words. Given several times, each is a line.").needed().repeated(),
    Param::new(
        "at",
        Kind::Point,
        "The place of the first line's baseline: its left end, middle or right end, as --align says.",
    )
    .default("50%,50%"),
    Param::length("size", Axis::Y, "Size of the letters' em.").within(1e-9, 1e6).slider(0.0, 50.0).default("10%"),
    Param::new("font", Kind::Text("FAMILY"), "An installed family, or a font file. Default: the bundled Noto Sans."),
    Param::new(
        "weight",
        Kind::Choice(&["thin", "extralight", "light", "regular", "medium", "semibold", "bold", "extrabold", "black"]),
        "Weight within the family; a bolder one is made where the family lacks it.",
    )
    .default("regular"),
    Param::flag("italic", "Use the family's italic, or slant the letters where it has none."),
    Param::new("fill", Kind::Text("COLOUR"), "Colour, as in CSS.").default("black"),
    Param::new("align", Kind::Choice(&["left", "center", "right"]), "Alignment of the lines.").default("left"),
    Param::number("letter-spacing", "Space added between letters, as a share of the size.")
        .within(-1e3, 1e3)
        .slider(-0.2, 1.0)
        .default("0%"),
    Param::number("line-height", "Distance between baselines, as a share of the size.")
        .within(0.0, 1e3)
        .slider(0.5, 3.0)
        .default("120%"),
];

const CONTOUR_PARAMS: [Param; 8] = [
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

/// Returns the description of the edit called `name`.
pub fn info(name: &str) -> Option<&'static Info> {
    EDITS.iter().find(|info| info.name == name)
}

/// Splits a recipe into its edits and the steps that bend.
///
/// # Errors
/// [`Failure::Usage`] if an edit follows a step that bends, or is inverse.
pub fn divided(recipe: &Recipe) -> Result<(Vec<Step>, Recipe), Failure> {
    let is_edit = |s: &&Step| info(&s.deformation).is_some();
    let (edits, steps) = recipe.steps.split_at(recipe.steps.iter().take_while(is_edit).count());
    match edits.iter().find(|s| s.inverse).or_else(|| steps.iter().find(is_edit)) {
        Some(Step { deformation, .. }) => {
            Err(Failure::usage(format!("{deformation} comes before all steps that bend, and has no inverse")))
        }
        None => Ok((edits.to_vec(), Recipe { steps: steps.to_vec() })),
    }
}
