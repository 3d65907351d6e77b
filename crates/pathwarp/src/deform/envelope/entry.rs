//! The registry's entry: reads an [`Envelope`] from text.

use super::columns::Room;
use super::ring::{Corners, SIDES};
use super::{Envelope, Keep, Spread};
use crate::deform::built::Built;
use crate::deform::entry::{ByHand, Case, Deformation, Example, Info, Law, Pairs, Variant};
use crate::error::Error;
use crate::param::{Axis, Kind, NamedPath, Param, Settings};
use std::sync::Arc;

pub(in crate::deform) struct Entry;

pub(super) static INFO: Info = Info::new("envelope", "put artwork into any closed shape, or between curves")
    .group("Envelopes")
    .by_hand(ByHand {
        neutral: &[
            ("top", "M0,0 C33.3333,0 66.6667,0 100,0"),
            ("bottom", "M0,100 C33.3333,100 66.6667,100 100,100"),
        ],
        variants: &[Variant {
            label: "Closed shape",
            param: "envelope",
            neutral: "M0,100 L50,100 L100,100 L100,50 L100,0 L50,0 L0,0 L0,50 Z",
            showing: "M10,95 L50,120 L90,95 L100,50 L90,5 L50,-20 L10,5 L0,50 Z",
        }],
        ..ByHand::NONE
    })
    .guides(&["envelope"], 1)
    .with_letters()
    .about("The artwork's box is laid onto a shape, and the artwork follows. Name a closed path (--envelope, for instance an object of \
the drawing itself), or draw the sides one by one: --bottom and --top, with --left and --right if they are to be curves as well, or \
--bottom alone with a --height.\n\nHow a closed path is filled is chosen (--keep auto). A path with four corners of its own (a flag, a \
banner, a trapezoid) bends the artwork between its four sides. Lettering in any other shape stands in columns between the lower and \
the upper outline, its stems upright; other artwork takes whatever distorts it less: columns, rows or four sides. Tails, such as a speech \
bubble's, and thin ends stay free. In columns, lettering ends where the shape is still a quarter of its greatest height (--ends). \
--explain says what was chosen.\n\nA closed path's corners are its nodes, if it has just four and one lies in each quarter of its box. \
Otherwise they are those of its nodes that turn by 20° or more which distort the artwork least; for a quarter of the box without such \
a node, the point nearest to its corner stands in. --corners overrules that; where another choice is hardly worse, a warning names it. \
The bottom is the lowest side on the screen that can be read from left to right, so that lettering is never mirrored; --bottom-side and \
--reverse overrule that.\n\nAlong a side the artwork is spread evenly by length. --by parameter follows the curve's parameter instead \
(pieces share a side by their lengths); with one cubic for every side that is the shaper's map. --by extent goes by even steps across the \
screen.\n\n--keep verticals fills a closed path in columns, and makes verticals straight lines between --bottom and --top, exactly vertical \
where both span the same width; --keep horizontals does the same in rows. --keep lines keeps every line, which needs four straight sides: \
a projective map. --keep nothing bends artwork between four sides, whatever the shape.")
    .source("S. A. Coons, Surfaces for Computer-Aided Design of Space Forms, MIT 1967; Markku Koppinen, A plane transformation from 16 control points, equation (7)")
    .params(&[
        Param::path("envelope", "The closed path to put the artwork into."),
        Param::path("bottom", "Instead of --envelope, the bottom side, an open curve."),
        Param::path("top", "The top side."),
        Param::path("left", "The left side. Default: as --sides says."),
        Param::path("right", "The right side. Default: as --sides says."),
        Param::length("height", Axis::Y, "With --bottom or --top alone: distance of the facing side, which is the same curve again. Default: the artwork's height.")
            .within(1e-9, 1e9)
            .slider(1.0, 500.0),
        Param::new("sides", Kind::Choice(&["straight", "square"]), "The sides between the ends of two curves: straight lines, or curves that meet both at right angles.")
            .default("straight"),
        Param::new("by", Kind::Choice(&["length", "parameter", "extent"]), "The spacing along a side: even by length, by the curve's parameter, or by steps across the screen.")
            .default("length"),
        Param::new("corners", Kind::Text("N,N,N,N|X,Y…"), "The closed path's corners: four numbers of its nodes, or four points near it. Default: found."),
        Param::new("bottom-side", Kind::Count, "The closed path's side that is the bottom: 1 to 4, from its first corner on as drawn. Default: the lowest.")
            .within(1.0, 4.0),
        Param::flag("reverse", "Run the bottom the other way: the result is mirrored."),
        Param::new("keep", Kind::Choice(&["auto", "nothing", "verticals", "horizontals", "lines"]), "Lines that stay straight.")
            .default("auto"),
        Param::number("ends", "In columns or rows: the artwork ends where the shape is still this share of its greatest height (width). Default: 25% for lettering, else 0.")
            .within(0.0, 0.99)
            .slider(0.0, 0.5),
        Param::length("padding", Axis::Y, "Distance that the artwork keeps from the shape's outline.").default("0").within(0.0, 1e9).slider(0.0, 50.0),
    ])
    .demo(&[("envelope", "M8,78 Q30,96 50,84 T95,85 C85,60 105,40 90,15 L70,6 C50,-5 30,30 5,10 C15,40 0,60 8,78 Z"), ("corners", "1,3,4,6")])
    .examples(&[
        Example {
            what: "A logo in a swallow-tailed pennant: the shape's corners and its bottom are found",
            command: "envelope samples/logo.svg --envelope samples/envelopes.svg#pennant --explain -o out.svg",
        },
        Example {
            what: "A word between two curves of several pieces, its verticals kept vertical",
            command: "envelope samples/lettering.svg --bottom samples/envelopes.svg#valley --top samples/envelopes.svg#hill --keep verticals --fit page -o out.svg --preview out.png",
        },
        Example {
            what: "The same curve above and below, typed in place",
            command: "envelope samples/lettering.svg --bottom 'M0,160 C120,100 260,220 400,150' --height 90 -o out.svg",
        },
        Example {
            what: "Text whose baseline lies on the lower curve and whose capitals reach the upper one",
            command: "envelope samples/headline.svg --frame baseline-capheight --bottom 'M30,200 Q240,90 450,200' --height 80 -o out.svg",
        },
        Example {
            what: "A word in a leaf: its stems stay upright",
            command: "envelope samples/headline.svg --envelope samples/shapes.svg#leaf -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("envelope", "0,0 100,0 100,100 0,100")]),
        Law::Identity(&[("bottom", "0,100 100,100"), ("top", "0,0 30,0 100,0")]),
        Law::Identity(&[("bottom", "0,100 100,100")]),
        // The start and the direction of a closed path do not matter.
        Law::Same(
            &[("envelope", "M10,90 Q40,110 95,85 L90,15 50,30 5,10 Z"), ("corners", "10,90 95,85 90,15 5,10")],
            &[("envelope", "M50,30 L90,15 95,85 Q40,110 10,90 L5,10 Z"), ("corners", "10,90 95,85 90,15 5,10")],
        ),
        // A circle's corners are found on its diagonals.
        Law::Same(
            &[("envelope", CIRCLE)],
            &[("envelope", CIRCLE), ("corners", "14.6446609406726,85.3553390593274 85.3553390593274,85.3553390593274 85.3553390593274,14.6446609406726 14.6446609406726,14.6446609406726")],
        ),
        // Sides one by one are the closed path.
        Law::Same(
            &[("bottom", "M0,90 Q50,110 100,90"), ("top", "M0,0 Q40,20 100,10"), ("right", "M100,90 Q80,50 100,10"), ("left", "0,0 0,90")],
            &[("envelope", "M0,90 Q50,110 100,90 Q80,50 100,10 Q40,20 0,0 Z")],
        ),
        Law::KeepsLinesAlong(&[("bottom", "M0,90 C30,130 60,60 100,95"), ("top", "M5,10 Q60,-30 90,5"), ("by", "parameter")], (0.0, 1.0)),
        Law::KeepsLinesAlong(&[("bottom", "M0,90 C30,130 60,60 100,95 L140,100"), ("top", "M5,10 Q60,-30 90,5"), ("keep", "verticals")], (0.0, 1.0)),
        Law::KeepsLinesAlong(&[("left", "M0,90 C30,60 -30,40 0,0"), ("right", "M100,110 L80,50 110,5"), ("keep", "horizontals")], (1.0, 0.0)),
        Law::KeepsLines(&[("envelope", "0,90 100,80 80,10 10,0"), ("keep", "lines")]),
    ])
    .cases(&[
        // Half a circle of radius 50, and the same 40 higher: quarter of the way along is 45° round.
        Case { args: ARCH, at: (25.0, 100.0), to: (50.0 - 50.0 * R2, 100.0 - 50.0 * R2), tolerance: 1e-10 },
        Case { args: ARCH, at: (50.0, 0.0), to: (50.0, 10.0), tolerance: 1e-10 },
        Case { args: ARCH, at: (75.0, 50.0), to: (50.0 + 50.0 * R2, 80.0 - 50.0 * R2), tolerance: 1e-10 },
        // The shaper's own case: the middle of a Coons patch.
        Case { args: CAGE, at: (50.0, 50.0), to: (46.875, 55.625), tolerance: 1e-12 },
        // y = 100 − 1.6·x·(100−x)/100: at x = 20 the curve is 25.6 higher.
        Case { args: UPRIGHT, at: (20.0, 100.0), to: (20.0, 74.4), tolerance: 1e-10 },
        Case { args: UPRIGHT, at: (20.0, 0.0), to: (20.0, 24.4), tolerance: 1e-10 },
    ]);

const CIRCLE: &str = "M100,50 A50,50 0 1 1 0,50 A50,50 0 1 1 100,50 Z";
const ARCH: Pairs = &[("bottom", "M0,100 A50,50 0 0 1 100,100"), ("height", "40")];
const CAGE: Pairs = &[("envelope", "M 10,90 Q 40,110 95,85 L 90,15 5,10 Z"), ("by", "parameter")];
const UPRIGHT: Pairs = &[("bottom", "M0,100 Q50,20 100,100"), ("height", "50"), ("keep", "verticals")];
const R2: f64 = std::f64::consts::FRAC_1_SQRT_2;

impl Deformation for Entry {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let mut curves: [Option<NamedPath>; 4] = Default::default();
        for (curve, name) in curves.iter_mut().zip(SIDES) {
            *curve = s.path_if(name)?;
        }
        let spread = match s.choice("by")? {
            "parameter" => Spread::Parameter,
            "extent" => Spread::Extent,
            _ => Spread::Length,
        };
        let envelope = Envelope {
            frame: s.frame().rect,
            shape: s.path_if("envelope")?,
            curves,
            height: s.number_if("height")?,
            square: s.choice("sides")? == "square",
            spread: s.given("by").then_some(spread),
            corners: corners(s)?,
            bottom_side: s.number_if("bottom-side")?.map(|n| n as usize),
            reverse: s.flag("reverse")?,
            keep: Keep::named(s.choice("keep")?),
            room: Room { ends: s.number_if("ends")?, padding: s.number("padding")? },
            lettering: !s.frame().letters.is_empty(),
            ink: Arc::clone(&s.frame().ink),
        };
        envelope.build()
    }
}

/// Reads the corners: four numbers of nodes, or points.
fn corners(s: &Settings<'_>) -> Result<Option<Corners>, Error> {
    let Some(text) = s.texts("corners").pop() else { return Ok(None) };
    let words: Vec<&str> = text.split([',', ' ', ';']).filter(|w| !w.is_empty()).collect();
    let numbers: Option<Vec<usize>> = words.iter().map(|w| w.parse().ok()).collect();
    match numbers.map(<[usize; 4]>::try_from) {
        Some(Ok(nodes)) => Ok(Some(Corners::Nodes(nodes))),
        _ => {
            let points = s.points_in("corners", text).ok().and_then(|p| p.try_into().ok());
            let problem = "is neither four numbers of nodes (1,4,7,9) nor four points x,y";
            points.map(|p| Some(Corners::Points(p))).ok_or_else(|| Error::usage("corners", text, problem))
        }
    }
}
