//! The registry's entry: reads a [`Shaper`] from text.

use super::net::{Bottom, from_rows};
use super::{Cage, Shaper};
use crate::deform::built::Built;
use crate::deform::entry::{ByHand, Case, Deformation, Example, Info, Law, Pairs, Variant};
use crate::error::{Error, within};
use crate::param::{Kind, Param, Settings};

pub(in crate::deform) struct Entry;

static INFO: Info = Info::new("shaper", "bend artwork into a closed path of four curved sides")
    .group("Envelopes")
    .by_hand(ByHand {
        label: Some("Cage"),
        fixed: &["shaper", "net", "base", "target"],
        neutral: &[(
            "shaper",
            "M0,100 C33.3333,100 66.6667,100 100,100 C100,66.6667 100,33.3333 100,0 C66.6667,0 33.3333,0 0,0 C0,33.3333 0,66.6667 0,100 Z",
        )],
        variants: &[Variant {
            label: "Cage, 16 points",
            param: "net",
            neutral: "M0,100 C33.3333,100 66.6667,100 100,100 M0,66.6667 C33.3333,66.6667 66.6667,66.6667 100,66.6667 \
                      M0,33.3333 C33.3333,33.3333 66.6667,33.3333 100,33.3333 M0,0 C33.3333,0 66.6667,0 100,0",
            showing: "M0,100 C33,110 67,90 100,100 M0,67 C10,40 50,110 100,67 M0,33 C50,-10 90,60 100,33 M0,0 C33,10 67,-10 100,0",
        }],
        ..ByHand::NONE
    })
    .guides(&["shaper", "base", "target"], 1)
    .about("Draw a closed path with four anchors: that is the shape. The artwork's box (or the base) is laid onto it, side by \
side, and everything inside follows smoothly. With a target, the shaper's corners are then moved there, so that its \
size and position do not matter.\n\nThe bottom is the side that lies lowest on the screen, run left to right, unless another \
way of laying the four corners distorts them much less, as for a wide logo in a tilted shape; --bottom and --reverse-shaper overrule \
that, and --explain says which was chosen and why. Bases and targets of two anchors are run left to right, \
those of four start with their lowest side; --base-as-drawn and --target-as-drawn take them as they were drawn.\n\nA base of \
two anchors fixes only the bottom side: artwork twice as tall as the base is wide reaches past the shaper's top.")
    .source("Markku Koppinen, A plane transformation from 16 control points, equations (1)-(10)")
    .params(&[
        Param::path("shaper", "The closed path of four sides (lines, curves or arcs) to bend the artwork into."),
        Param::path(
            "net",
            "Instead of --shaper, all 16 control points: four paths of one cubic each, or 16 points, row by row, the bottom row \
first, each left to right.",
        )
        .repeated(),
        Param::path(
            "base",
            "Two or four anchors in the source that are laid onto the shaper's bottom side or its four corners. Default: the \
corners of the artwork's box.",
        ),
        Param::path(
            "target",
            "Two or four anchors: the images of the shaper's bottom corners, or of all four. Default: those corners themselves.",
        ),
        Param::new("bottom", Kind::Text("N or lowest"), "The side that is the bottom: 1 to 4, in the order they were drawn, or the lowest on the screen. Default: the one that distorts the corners least."),
        Param::flag("reverse-shaper", "Run the bottom side the other way (right to left): the result is mirrored."),
        Param::flag("base-as-drawn", "Take the base's anchors in the order they were drawn."),
        Param::flag("target-as-drawn", "Take the target's anchors in the order they were drawn."),
    ])
    .demo(&[("shaper", "M 10,90 C 40,110 60,70 95,85 C 85,60 105,40 90,15 C 60,-5 40,35 5,10 C 15,40 0,60 10,90 Z")])
    .examples(&[
        Example {
            what: "Bend a logo into a path of another file",
            command: "shaper samples/logo.svg --shaper samples/banner.svg -o out.svg",
        },
        Example {
            what: "The paper's example: Base, Target and Shaper are paths of the document itself",
            command: "shaper samples/paper-two-anchors.svg --base '#Base' --target '#Target' --shaper '#Shaper' -o out.svg --preview out.png",
        },
        Example {
            what: "A cage typed in place, explained",
            command: "shaper samples/monogram.svg --shaper 'M0,120 Q60,90 120,120 L110,0 Q60,30 10,0 Z' --explain -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("shaper", "0,0 100,0 100,100 0,100")]),
        Law::Identity(&[("shaper", "M0,100 L0,0 L100,0 L100,100 Z")]),
        Law::Identity(&[("shaper", "0,0 10,0 10,10 0,10"), ("target", "0,100 100,100")]),
        Law::Area(&[("shaper", "0,0 50,0 50,50 0,50")], 0.25),
        Law::Same(
            // With a target, the shaper's size and position do not matter.
            &[("shaper", "M 10,90 Q 40,110 95,85 L 90,15 5,10 Z"), ("base", "0,100 100,100"), ("target", "5,90 70,80")],
            &[("shaper", "M 30,190 Q 90,230 200,180 L 190,40 20,30 Z"), ("base", "0,100 100,100"), ("target", "5,90 70,80")],
        ),
        Law::Same(
            // Neither does the start of a closed path, nor its direction.
            &[("shaper", "M 10,90 Q 40,110 95,85 L 90,15 5,10 Z")],
            &[("shaper", "M 90,15 L 95,85 Q 40,110 10,90 L 5,10 Z")],
        ),
        Law::KeepsLines(&[("shaper", "0,0 100,0 100,100 0,100"), ("target", "0,100 100,90 80,20 10,0")]),
    ])
    .cases(&[
        // Corners on corners; the bottom side's middle on the bottom arc's middle (a quadratic: (10+2·40+95)/4, ...).
        Case { args: CASE, at: (0.0, 100.0), to: (10.0, 90.0), tolerance: 1e-12 },
        Case { args: CASE, at: (100.0, 100.0), to: (95.0, 85.0), tolerance: 1e-12 },
        Case { args: CASE, at: (100.0, 0.0), to: (90.0, 15.0), tolerance: 1e-12 },
        Case { args: CASE, at: (50.0, 100.0), to: (46.25, 98.75), tolerance: 1e-12 },
        // The middle of a Coons patch: half the sum of the sides' middles less the corners' mean.
        Case { args: CASE, at: (50.0, 50.0), to: (46.875, 55.625), tolerance: 1e-12 },
    ]);

const CASE: Pairs = &[("shaper", "M 10,90 Q 40,110 95,85 L 90,15 5,10 Z")];

impl Deformation for Entry {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let cage = match (s.path_if("shaper")?, s.paths("net")?) {
            (Some(_), rows) if !rows.is_empty() => {
                let problem = "cannot go with `shaper`: one of them gives the net";
                return Err(Error::usage("net", rows[0].name.clone(), problem));
            }
            (Some(path), _) => Cage::Path(path),
            (None, rows) if !rows.is_empty() => {
                if s.given("bottom") || s.given("reverse-shaper") {
                    let problem = "is taken as given; `bottom` and `reverse-shaper` go with `shaper`";
                    return Err(Error::usage("net", rows[0].name.clone(), problem));
                }
                Cage::Net(Box::new(from_rows(&rows)?), rows[0].name.clone())
            }
            _ => {
                let hint = "the closed path of four sides to bend the artwork into (or `net` with 16 points)";
                return Err(Error::missing("shaper", hint));
            }
        };
        let shaper = Shaper {
            cage,
            bottom: bottom(s)?,
            reverse: s.flag("reverse-shaper")?,
            base: s.path_if("base")?,
            base_as_drawn: s.flag("base-as-drawn")?,
            target: s.path_if("target")?,
            target_as_drawn: s.flag("target-as-drawn")?,
            frame: Some(s.frame().rect),
        };
        shaper.build()
    }
}

fn bottom(s: &Settings<'_>) -> Result<Bottom, Error> {
    match s.texts("bottom").last() {
        None => Ok(Bottom::LeastDistorting),
        Some(&"lowest") => Ok(Bottom::Lowest),
        Some(text) => match text.trim().parse::<i32>() {
            Ok(side) => within("bottom", f64::from(side), 1.0, 4.0).map(|_| Bottom::Side(side.unsigned_abs() as usize)),
            Err(_) => Err(Error::usage("bottom", *text, "is neither a side, 1 to 4, nor the word lowest")),
        },
    }
}
