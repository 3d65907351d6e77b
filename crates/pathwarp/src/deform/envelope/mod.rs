//! Artwork put into a shape: an envelope of four sides, each a curve of any number of pieces.
//!
//! The map is the Coons patch of the sides ([`Coons`]), which for sides of one cubic is the shaper's (Koppinen, *A plane
//! transformation from 16 control points*, equation 7).

pub(super) mod corners;
mod curves;
mod faults;
#[cfg(test)]
mod tests;

use super::built::{Built, Explanation, Overlay, Role};
use super::entry::{Case, Deformation, Example, Info, Law};
use crate::anchors;
use crate::error::{Error, show};
use crate::map::{AffineMap, Class, Coons, Map, Pace, Side, Sides};
use crate::outline::{Outline, Seg, Subpath};
use crate::param::{Axis, Kind, Param, Settings};
use corners::Ring;
use kurbo::{Affine, Point};
use std::sync::Arc;

pub(super) struct Envelope;

static INFO: Info = Info::new("envelope", "put artwork into any closed shape, or between curves")
    .group("Envelopes")
    .about("The artwork's box is laid onto a shape with four sides, which may have any number of pieces, and what is inside \
follows. Name a closed path (--envelope, for instance an object of the drawing itself), or draw the sides one by one: --bottom and \
--top, with --left and --right if they are to be curves as well, or --bottom alone with a --height.\n\nA closed path's corners are its \
nodes, if it has just four and one lies in each quarter of its box; or its nodes that turn by 20° or more, if that is so of them. \
Otherwise they are the places nearest to the corners of the box, measured in shares of it, or the node with such an angle within \
15 % of such a place; of four angles and four such places those that span more. So circles, hearts, shields and rounded boxes have \
corners too. --corners overrules that. The bottom is the lowest side on the screen among those that can be read from left to right with the inside above them, so that \
lettering is never mirrored; --bottom-side and --reverse overrule that. --explain tells what was chosen.\n\nAlong a side the artwork is spread \
evenly by length. --by parameter follows the curve's own pace instead (pieces share a side by their lengths); \
with one cubic for every side that is the shaper's map. --by extent goes by even steps across the screen.\n\n--keep verticals makes \
uprights straight lines between bottom and top, and truly upright where both curves span the same width; --keep horizontals does \
the same for levels. Both need the two other sides to be straight. --keep lines keeps every line, which needs four straight sides: a projective map.")
    .source("S. A. Coons, Surfaces for Computer-Aided Design of Space Forms, MIT 1967; Markku Koppinen, A plane transformation from 16 control points, equation (7)")
    .params(&[
        Param::path("envelope", "The closed path to put the artwork into."),
        Param::path("bottom", "Instead of --envelope, the bottom side, an open curve."),
        Param::path("top", "The top side."),
        Param::path("left", "The left side. Default: as --sides says."),
        Param::path("right", "The right side. Default: as --sides says."),
        Param::length("height", Axis::Y, "With --bottom or --top alone: how far away the facing side is, the same curve again. Default: the artwork's height.")
            .within(1e-9, 1e9)
            .slider(1.0, 500.0),
        Param::new("sides", Kind::Choice(&["straight", "square"]), "What joins the ends of two curves: straight lines, or curves that meet both at right angles.")
            .default("straight"),
        Param::new("by", Kind::Choice(&["length", "parameter", "extent"]), "What is even along a side: distances, the curve's own parameter, or steps across the screen.")
            .default("length"),
        Param::new("corners", Kind::Text("N,N,N,N|X,Y…"), "The closed path's corners: four numbers of its nodes, or four points near it. Default: found."),
        Param::new("bottom-side", Kind::Count, "The closed path's side that is the bottom: 1 to 4, from its first corner on as drawn. Default: the lowest.")
            .within(1.0, 4.0),
        Param::flag("reverse", "Run the bottom the other way: the result is mirrored."),
        Param::new("keep", Kind::Choice(&["nothing", "verticals", "horizontals", "lines"]), "What is to stay straight.")
            .default("nothing"),
    ])
    .demo(&[("envelope", "M8,78 Q30,96 50,84 T95,85 C85,60 105,40 90,15 L70,6 C50,-5 30,30 5,10 C15,40 0,60 8,78 Z"), ("corners", "1,3,4,6")])
    .examples(&[
        Example {
            what: "A logo in a swallow-tailed pennant: the shape's corners and its bottom are found",
            command: "envelope samples/logo.svg --envelope samples/envelopes.svg#pennant --explain -o out.svg",
        },
        Example {
            what: "A word between two curves of several pieces, its uprights kept upright",
            command: "envelope samples/lettering.svg --bottom samples/envelopes.svg#valley --top samples/envelopes.svg#hill --keep verticals --fit page -o out.svg --preview out.png",
        },
        Example {
            what: "The same curve above and below, typed in place",
            command: "envelope samples/lettering.svg --bottom 'M0,160 C120,100 260,220 400,150' --height 90 -o out.svg",
        },
        Example {
            what: "Text whose baseline comes to lie on the lower curve and whose capitals reach the upper one",
            command: "envelope samples/headline.svg --frame baseline-capheight --bottom 'M30,200 Q240,90 450,200' --height 80 -o out.svg",
        },
        Example {
            what: "A circle has no corners: they are taken where it comes nearest to its box's",
            command: "envelope samples/monogram.svg --envelope 'M200,100 A100,100 0 1 1 0,100 A100,100 0 1 1 200,100 Z' -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("envelope", "0,0 100,0 100,100 0,100")]),
        Law::Identity(&[("bottom", "0,100 100,100"), ("top", "0,0 30,0 100,0")]),
        Law::Identity(&[("bottom", "0,100 100,100")]),
        // Neither where a closed path starts nor which way it runs matters.
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
        // y = 100 − 1.6·x·(100−x)/100, upright: at x = 20 the curve is 25.6 higher.
        Case { args: UPRIGHT, at: (20.0, 100.0), to: (20.0, 74.4), tolerance: 1e-10 },
        Case { args: UPRIGHT, at: (20.0, 0.0), to: (20.0, 24.4), tolerance: 1e-10 },
    ]);

const CIRCLE: &str = "M100,50 A50,50 0 1 1 0,50 A50,50 0 1 1 100,50 Z";
const ARCH: super::entry::Pairs = &[("bottom", "M0,100 A50,50 0 0 1 100,100"), ("height", "40")];
const CAGE: super::entry::Pairs = &[("envelope", "M 10,90 Q 40,110 95,85 L 90,15 5,10 Z"), ("by", "parameter")];
const UPRIGHT: super::entry::Pairs = &[("bottom", "M0,100 Q50,20 100,100"), ("height", "50"), ("keep", "verticals")];
const R2: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Off the straight line by no more than this share of its length, a side is straight.
const STRAIGHT: f64 = 1e-9;

impl Deformation for Envelope {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let by = if s.given("by") { Some(s.choice("by")?) } else { None };
        over(&ring(s)?, s, s.choice("keep")?, by)
    }
}

/// The map of the frame into these sides that keeps what is to be kept; `by` is the pace, where it was given.
pub(super) fn over(ring: &Ring, s: &Settings<'_>, keep: &str, by: Option<&str>) -> Result<Built, Error> {
    let frame = anchors::frame_corners(s.frame())?;
    let rect = s.frame().rect;
    let pre = Affine::new([
        1.0 / rect.width(),
        0.0,
        0.0,
        -1.0 / rect.height(),
        -rect.x0 / rect.width(),
        rect.y1 / rect.height(),
    ]);
    let mut notes = ring.notes.clone();
    let mut warnings = Vec::new();
    let overlays = vec![Overlay { role: Role::Cage, path: outline(ring) }];

    if keep == "lines" {
        for (k, side) in ring.sides.iter().enumerate() {
            demand_straight(side, NAMES[k], "`keep lines` needs four straight sides")?;
        }
        let corners = ring.sides.each_ref().map(|side| side.first().map_or(Point::ORIGIN, Seg::start));
        let anchors::Anchors::Four(from) = frame else { return Err(no_length("frame")) };
        notes.push("kept: every line, by the projective map of the four corners".into());
        let map = anchors::projective("envelope", from, corners)?;
        return Ok(Built::new(Arc::new(map)).explained(Explanation { notes, overlays, warnings }));
    }

    let sides = paced(ring, by, keep, &mut notes, &mut warnings)?;
    let map = Coons::new(sides, pre);
    let inverse = Affine::new([rect.width(), 0.0, 0.0, -rect.height(), rect.x0, rect.y1]);
    warnings.extend(faults::warnings(&map, inverse));
    let map = map.simplest();
    let map = match map.class() {
        Class::Affine(m) => Arc::new(AffineMap(anchors::settled(m, s.frame()))),
        _ => map,
    };
    Ok(Built::new(map).explained(Explanation { notes, overlays, warnings }))
}

const NAMES: [&str; 4] = ["bottom", "right", "top", "left"];

/// The four sides as drawn, from whichever parameters give them.
fn ring(s: &Settings<'_>) -> Result<Ring, Error> {
    match (s.path_if("envelope")?, curves::ring(s)?) {
        (Some(path), None) => {
            if s.given("height") {
                return Err(Error::usage("height", s.texts("height").join(" "), "goes with `bottom` or `top` alone"));
            }
            corners::ring(&path, s)
        }
        (Some(path), Some(_)) => Err(Error::usage(
            "envelope",
            path.name,
            "cannot go with `bottom`, `top`, `left` and `right`: a closed path has all four",
        )),
        (None, Some(ring)) => {
            if let Some(name) = ["corners", "bottom-side"].into_iter().find(|n| s.given(n)) {
                return Err(Error::usage(
                    name,
                    s.texts(name).join(" "),
                    "goes with `envelope`: here the sides are drawn one by one",
                ));
            }
            Ok(ring)
        }
        (None, None) => Err(Error::Missing {
            param: "envelope".into(),
            hint: "the closed path to put the artwork into (or `bottom` and `top`: the curves below and above)".into(),
        }),
    }
}

/// The sides at their pace, and those made straight that have to be.
fn paced(
    ring: &Ring,
    by: Option<&str>,
    keep: &str,
    notes: &mut Vec<String>,
    warnings: &mut Vec<String>,
) -> Result<Sides, Error> {
    let [bottom, right, top, left] = &ring.sides;
    let back = |c: &[Seg]| c.iter().rev().map(Seg::reversed).collect::<Vec<_>>();
    let (top, left) = (back(top), back(left));
    let (given, by) = (by.is_some(), by.unwrap_or("length"));
    let pace = |lying: bool| match by {
        "parameter" => Pace::Parameter,
        "extent" if lying => Pace::Width,
        "extent" => Pace::Height,
        _ => Pace::Length,
    };
    let side = |c: &[Seg], k: usize, pace: Pace| Side::new(c, pace).ok_or_else(|| unwalkable(NAMES[k], pace, by));
    let straight = |c: &[Seg], k: usize| {
        let what = format!("`keep {keep}` needs the {} and the {} side straight", NAMES[(k + 2) % 4], NAMES[k]);
        demand_straight(c, NAMES[k], &what)?;
        let ends = c.first().zip(c.last()).map(|(a, b)| (a.start(), b.end()));
        ends.and_then(|(a, b)| Side::straight(a, b)).ok_or_else(|| no_length(NAMES[k]))
    };
    let (lying, axis) = match keep {
        "verticals" => (true, Pace::Width),
        "horizontals" => (false, Pace::Height),
        _ => {
            return Ok(Sides {
                bottom: side(bottom, 0, pace(true))?,
                right: side(right, 1, pace(false))?,
                top: side(&top, 2, pace(true))?,
                left: side(&left, 3, pace(false))?,
            });
        }
    };
    // The kept lines run between a pair of curves; the other two sides are kept lines themselves.
    let (pair, names) = if lying { ([bottom, &top], [0, 2]) } else { ([&left, right], [3, 1]) };
    let upright = if given { None } else { Side::new(pair[0], axis).zip(Side::new(pair[1], axis)) };
    let even = upright.is_some();
    let (a, b) = match upright {
        Some(pair) => pair,
        None => (side(pair[0], names[0], pace(lying))?, side(pair[1], names[1], pace(lying))?),
    };
    let lean = lean(&a, &b, lying);
    let what = if lying { "uprights" } else { "levels" };
    notes.push(format!(
        "kept: {what} are straight and lean by at most {lean:.3}°, by the ruled map between the two curves"
    ));
    if !given && !even {
        warnings.push(format!(
            "envelope: {what} stay straight but lean by up to {lean:.1}°: a curve turns back or is too steep to be gone along evenly across the screen"
        ));
    }
    Ok(if lying {
        Sides { bottom: a, top: b, right: straight(right, 1)?, left: straight(&left, 3)? }
    } else {
        Sides { left: a, right: b, bottom: straight(bottom, 0)?, top: straight(&top, 2)? }
    })
}

/// How far the lines between two curves lean at most, degrees.
fn lean(a: &Side, b: &Side, lying: bool) -> f64 {
    const SAMPLES: u32 = 256;
    let one = |i: u32| {
        let u = f64::from(i) / f64::from(SAMPLES);
        let v = b.at(u).0 - a.at(u).0;
        let (off, along) = if lying { (v.x, v.y) } else { (v.y, v.x) };
        off.abs().atan2(along.abs()).to_degrees()
    };
    (0..=SAMPLES).map(one).fold(0.0, f64::max)
}

fn demand_straight(c: &[Seg], name: &str, what: &str) -> Result<(), Error> {
    let side = Side::new(c, Pace::Length).ok_or_else(|| no_length(name))?;
    let (off, at) = side.off_straight();
    if off <= STRAIGHT * side.length() {
        return Ok(());
    }
    let problem = format!(
        "{what}; the {name} side is curved: near {} it is {off:.6} off the line between its ends. No map keeps such lines then: \
draw two curves only (`bottom` and `top` keep verticals, `left` and `right` keep horizontals), or leave `keep` away",
        show(at)
    );
    Err(Error::usage("keep", "the envelope", problem))
}

fn no_length(name: &str) -> Error {
    Error::usage("envelope", format!("the {name} side"), "has no length")
}

fn unwalkable(name: &str, pace: Pace, by: &str) -> Error {
    if matches!(pace, Pace::Width | Pace::Height) {
        let across = if pace == Pace::Width { "left to right" } else { "bottom to top" };
        let problem =
            format!("needs sides that run {across} without turning back; the {name} side does not: use `by length`");
        Error::usage("by", by, problem)
    } else {
        no_length(name)
    }
}

/// The sides as one closed path, for a preview.
fn outline(ring: &Ring) -> kurbo::BezPath {
    let segs: Vec<Seg> = ring.sides.iter().flatten().copied().collect();
    let start = segs.first().map_or(Point::ORIGIN, Seg::start);
    let all = Outline { subpaths: vec![Subpath { start, segs, closed: true }] };
    let size = all.bounding_box().map_or(1.0, |b| b.width() + b.height());
    all.to_bez_path(1e-4 * size)
}
