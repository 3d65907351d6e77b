//! The registry's entry: reads a [`Triangle`] from text.

use super::Triangle;
use crate::deform::built::Built;
use crate::deform::change::Change;
use crate::deform::entry::{ByHand, Case, Deformation, Example, Info, Law, Pairs};
use crate::error::Error;
use crate::param::{Axis, Kind, Param, Settings};
use kurbo::{Point, Vec2};

pub(in crate::deform) struct Entry;

static INFO: Info = Info::new("triangle", "pull artwork about by a triangular net of control points")
    .group("Lattices and nets")
    .by_hand(ByHand {
        label: Some("Triangle net"),
        ..ByHand::NONE
    })
    .about("Lays a triangle over the artwork, with control points along its sides and inside it, and lets the artwork follow \
them. Degree 1 has the three corners; degree 2 the middles of the sides too; degree 3 one more in the middle. The higher \
the degree, the more local each point's pull. A triangle bends less stiffly than a rectangular net of the same degree, and treats \
all directions alike.\n\nA control point is named by three numbers I,J,K that add up to the degree: how near it lies to the first, \
second and third corner. 2,0,0 is the first corner of a triangle of degree 2, 0,1,1 the middle of the side opposite.\n\nOutside an \
explicit triangle (--reference) nothing moves, unless --extend is given. Where a side's control points stay in their places, inside \
and outside join without a gap; otherwise there is a warning.")
    .source("G. Farin, Triangular Bernstein-Bézier patches, CAGD 3, 1986; J. Sánchez-Reyes, J. M. Chacón, Anamorphic Free-Form \
Deformation, CAGD 46, 2016")
    .params(&[
        Param::new(
            "reference",
            Kind::Text("X,Y X,Y X,Y"),
            "The triangle's corners; outside it nothing moves. Default: a triangle about the artwork, its first corner at the top, its \
second at the bottom left, and the map continues outside it.",
        ),
        Param::new("degree", Kind::Count, "Degree of the net: control points along a side, less one.")
            .default("2")
            .within(1.0, 10.0),
        Param::new("move", Kind::Text("I,J,K:DX,DY"), "Moves a control point by this much; may be given many times.")
            .repeated(),
        Param::new("at", Kind::Text("I,J,K:X,Y"), "Puts a control point here; may be given many times.").repeated(),
        Param::new(
            "weight",
            Kind::Text("I,J,K:W"),
            "Strength with which a control point pulls the artwork towards itself, 1 by default; may be given many times.",
        )
        .repeated(),
        Param::flag(
            "extend",
            "Let the map continue outside the triangle instead of leaving everything there in place.",
        ),
    ])
    .demo(&[("move", "0,1,1:10,15"), ("weight", "1,1,0:2")])
    .examples(&[
        Example {
            what: "Pull the bottom down in the middle",
            command: "triangle samples/lettering.svg --move 0,1,1:0,60% -o out.svg",
        },
        Example {
            what: "Push out one spot of a badge; its surroundings stay",
            command: "triangle samples/badge.svg --reference '50%,5% 5%,80% 95%,80%' --degree 3 --move 1,1,1:0,-20% -o out.svg",
        },
        Example {
            what: "Two of the six points moved",
            command: "triangle samples/grid.svg --move 1,1,0:-30%,30% --move 1,0,1:30%,30% -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[]),
        Law::Identity(&[("degree", "7"), ("reference", "0,0 90,10 20,80"), ("extend", "true")]),
        Law::Identity(&[("weight", "1,0,1:1"), ("move", "1,0,1:0,0")]),
        Law::KeepsLines(&[("degree", "1"), ("move", "1,0,0:10,-20"), ("weight", "0,1,0:1.5"), ("extend", "true")]),
        Law::Area(&[("degree", "1"), ("reference", "0,0 100,0 0,100"), ("at", "0,1,0:200,0"), ("extend", "true")], 2.0),
    ])
    .cases(&[
        // The middle of a side: a quarter of its ends and half of its middle point.
        Case { args: SIX, at: (50.0, 0.0), to: (50.0, 15.0), tolerance: 1e-12 },
        // u = (½, ¼, ¼): B110 = 2·½·¼ = ¼ of the shift.
        Case { args: SIX, at: (25.0, 25.0), to: (25.0, 32.5), tolerance: 1e-12 },
        Case { args: SIX, at: (90.0, 90.0), to: (90.0, 90.0), tolerance: 0.0 },
        // Beyond the triangle, continued: u = (−½, ¾, ¾), B110 = −¾.
        Case {
            args: &[("reference", "0,0 100,0 0,100"), ("move", "1,1,0:0,30"), ("extend", "true")],
            at: (75.0, 75.0),
            to: (75.0, 52.5),
            tolerance: 1e-12,
        },
        // Below the box of the artwork, about which the triangle lies: u = (−0.05, 0.525, 0.525), B011 = 2·0.525².
        Case { args: &[("move", "0,1,1:0,10")], at: (50.0, 110.0), to: (50.0, 115.5125), tolerance: 1e-12 },
        // Weights draw along the sides: (¼·0 + ½·2·50 + ¼·100)/(¼ + 1 + ¼) = 50; at u = (¾, ¼, 0) it is
        // (2·⅜·50 + 100/16)/(9/16 + ¾ + 1/16) = 43.75/1.375.
        Case {
            args: &[("reference", "0,0 100,0 0,100"), ("weight", "1,1,0:2")],
            at: (25.0, 0.0),
            to: (43.75 / 1.375, 0.0),
            tolerance: 1e-12,
        },
    ]);

const SIX: Pairs = &[("reference", "0,0 100,0 0,100"), ("move", "1,1,0:0,30")];

impl Deformation for Entry {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let over = over(s)?;
        let extended = over.extended || s.flag("extend")?;
        Triangle { degree: s.number("degree")? as usize, changes: changes(s)?, extended, ..over }.build()
    }
}

/// Reads the reference triangle; the default lies about the artwork's box, twice as wide and twice as high.
fn over(s: &Settings<'_>) -> Result<Triangle, Error> {
    let frame = s.frame().rect;
    let Some(text) = s.texts("reference").pop() else { return Ok(Triangle::around(frame)) };
    let points = s.points_in("reference", text)?;
    let corners: [Point; 3] = points.try_into().map_err(|p: Vec<Point>| {
        Error::usage("reference", text, format!("has {} points; a triangle has three", p.len()))
    })?;
    Ok(Triangle { frame: Some(frame), ..Triangle::new(corners) })
}

/// Reads `at`, `move` and `weight`, in this order.
fn changes(s: &Settings<'_>) -> Result<Vec<([usize; 3], Change)>, Error> {
    let mut out = Vec::new();
    for text in s.texts("at") {
        let (node, rest) = s.node_in::<3>("at", text)?;
        out.push((node, Change::Place(s.point_in("at", rest)?)));
    }
    for text in s.texts("move") {
        let (node, rest) = s.node_in::<3>("move", text)?;
        let wrong = || Error::usage("move", rest, "is not a shift DX,DY");
        let (dx, dy) = rest.split_once(',').ok_or_else(wrong)?;
        let shift = Vec2::new(s.length_in("move", dx, Axis::X)?, s.length_in("move", dy, Axis::Y)?);
        out.push((node, Change::Shift(shift)));
    }
    for text in s.texts("weight") {
        let (node, rest) = s.node_in::<3>("weight", text)?;
        out.push((node, Change::Weight(s.number_in("weight", rest)?)));
    }
    Ok(out)
}
