//! The registry's entry: reads an [`Ffd`] from text.

use super::save::{self, MAX_CELLS, MAX_DEGREE};
use super::{Ffd, Grid, SIDES};
use crate::deform::built::{Built, SavedFile};
use crate::deform::change::Change;
use crate::deform::entry::{ByHand, Case, Deformation, Example, Info, Instead, Law};
use crate::error::Error;
use crate::map::Lattice;
use crate::param::{Axis, Kind, NamedText, Param, Settings};
use kurbo::{Point, Rect, Vec2};

pub(in crate::deform) struct Entry;

static INFO: Info = Info::new("ffd", "pull artwork about by a grid of control points")
    .group("Lattices and nets")
    .by_hand(ByHand {
        label: Some("Grid"),
        neutral: &[("degree", "3x3")],
        instead: &[Instead { param: "lattice", others: &["degree"], with: None }],
        ..ByHand::NONE
    })
    .about("A grid of control points lies over the artwork. Move some of them, and the artwork near them follows smoothly. Points are \
named i,j: column from the left, row from the top, both from 0. A grid of degree 3x2 has 4 by 3 of them; higher degrees bend \
more finely.\n\nOr move points of the artwork themselves (--pin), and the grid follows with the smallest change.\n\n\
With an explicit region (--region) nothing moves outside it. To keep the artwork from tearing at the region's border, freeze \
the outermost row or column of points there (--freeze left:1); two keep it smooth, three keep its curvature.")
    .source("T. W. Sederberg, S. R. Parry, Free-form deformation of solid geometric models, SIGGRAPH 1986; T. W. Sederberg, \
Computer Aided Geometric Design, chapter 14; for --pin: W. M. Hsu, J. F. Hughes, H. Kaufman, Direct manipulation of free-form \
deformations, SIGGRAPH 1992")
    .params(&[
        Param::new("degree", Kind::Text("MxN"), "Degrees along x and y, 1 to 10 each: one less than the control points there.").default("3x3"),
        Param::new(
            "region",
            Kind::Text("artwork|X,Y,W,H"),
            "The box the grid lies on; outside it nothing moves. The artwork's box has no outside: the map continues there.",
        )
        .default("artwork"),
        Param::new("move", Kind::Text("I,J:DX,DY"), "Move control point i,j by dx,dy (a length, or % of the artwork's box).").repeated(),
        Param::new("at", Kind::Text("I,J:X,Y"), "Put control point i,j at x,y.").repeated(),
        Param::new("weight", Kind::Text("I,J:W"), "Give control point i,j this weight: above 1 it pulls harder than the others.").repeated(),
        Param::new("pin", Kind::Text("X,Y:X,Y"), "Take the first point of the artwork to the second; the control points that are \
not frozen follow with the smallest change. Equal points hold a place.")
        .repeated(),
        Param::new("freeze", Kind::Text("SIDE:COUNT,…"), "Keep rows or columns along sides in their places, e.g. left:2,top:1: 1 for \
no tear at the region's border there, 2 for smooth, k+1 for k continuous derivatives."),
        Param::flag("extend", "Let the map continue outside the region instead of leaving everything there in place."),
        Param::flag("spline", "A B-spline grid: each control point has influence on a few cells only."),
        Param::new("cells", Kind::Text("NxM"), "Cells of the B-spline grid along x and y, 1 to 64 each; it has degree + cells \
control points. Default with --spline: 4x4."),
        Param::new("lattice", Kind::File, "Start from a saved grid (JSON) instead of --degree and a regular one; with --region it is \
laid onto that."),
        Param::new("save-lattice", Kind::Save, "Save the grid with everything that was moved, to use it again."),
    ])
    .demo(&[("degree", "3x2"), ("move", "1,0:5,25"), ("move", "2,1:15,-20"), ("move", "0,2:-10,5"), ("weight", "1,1:2")])
    .examples(&[
        Example {
            what: "Pull the middle of a logo upwards",
            command: "ffd samples/logo.svg --degree 2x2 --move 1,1:0,-60% -o out.svg",
        },
        Example {
            what: "Bend only the right half of a badge, smoothly joined to the left one",
            command: "ffd samples/badge.svg --region 50%,-10%,60%,120% --freeze left:2,top:1,bottom:1,right:1 --degree 4x3 --move 2,1:30,-20 --move 2,2:30,20 -o out.svg --preview out.png",
        },
        Example {
            what: "Take two places of a word elsewhere and hold a third",
            command: "ffd samples/lettering.svg --pin 50%,50%:50%,20% --pin 90%,50%:95%,70% --pin 5%,50%:5%,50% -o out.svg",
        },
        Example {
            what: "A finer grid whose points act locally, saved for use again",
            command: "ffd samples/grid.svg --spline --degree 3x3 --cells 5x5 --move 3,3:25,20 --move 5,5:-25,10 --save-lattice out.json -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[]),
        Law::Identity(&[("degree", "10x1"), ("region", "10,20,30,40")]),
        Law::Identity(&[("degree", "3x2"), ("spline", "true"), ("extend", "true")]),
        Law::Identity(&[("pin", "30,30:30,30"), ("pin", "70,20:70,20")]),
        Law::Same(&[("move", "1,2:0,0"), ("weight", "0,0:2")], &[("weight", "0,0:2")]),
        Law::Same(&[("at", "1,1:50,40"), ("degree", "2x2")], &[("move", "1,1:0,-10"), ("degree", "2x2")]),
        // Equal weights have no effect.
        Law::Same(&[("degree", "1x1"), ("weight", "0,0:3 1,0:3 0,1:3 1,1:3"), ("move", "1,1:9,9")], &[("degree", "1x1"), ("move", "1,1:9,9")]),
        Law::KeepsLinesAlong(&[("degree", "4x1"), ("move", "1,0:5,20 3,1:9,-20"), ("weight", "2,0:3")], (0.0, 1.0)),
        Law::KeepsLinesAlong(&[("degree", "1x3"), ("move", "0,1:5,20 1,2:9,-20")], (1.0, 0.0)),
        Law::FixedOutside(&[("region", "20,30,50,40"), ("move", "1,1:10,5 2,2:-5,5")], [20.0, 30.0, 70.0, 70.0]),
        Law::FixedOutside(
            &[("region", "20,30,50,40"), ("spline", "true"), ("cells", "3x2"), ("pin", "40,50:44,52"), ("freeze", "left:1,right:1,top:1,bottom:1")],
            [20.0, 30.0, 70.0, 70.0],
        ),
    ])
    .cases(&[
        // The middle of degree 2×2: the middle point counts a quarter.
        Case { args: &[("degree", "2x2"), ("move", "1,1:10,-8")], at: (50.0, 50.0), to: (52.5, 48.0), tolerance: 1e-13 },
        // With weight 5 it counts 5/8 instead of 2/8: (3·50 + 5·60)/8.
        Case { args: &[("degree", "2x2"), ("move", "1,1:10,0"), ("weight", "1,1:5")], at: (50.0, 50.0), to: (56.25, 50.0), tolerance: 1e-13 },
        Case { args: &[("pin", "30,40:37,35")], at: (30.0, 40.0), to: (37.0, 35.0), tolerance: 1e-12 },
        // Halfway in a uniform quadratic B-spline of two cells the two middle points count a half each, along x and y.
        Case { args: &[("degree", "2x2"), ("cells", "2x2"), ("move", "1,1:8,0")], at: (50.0, 50.0), to: (52.0, 50.0), tolerance: 1e-13 },
    ]);

impl Deformation for Entry {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let own_region = s.rect_if("region")?;
        let (grid, from_file) = grid(s)?;
        let ffd = Ffd {
            grid,
            changes: changes(s)?,
            pins: pins(s)?,
            frozen: frozen(s)?,
            extended: s.flag("extend")? || (own_region.is_none() && !from_file),
        };
        let (mut built, lattice) = ffd.build_with_lattice()?;
        if let Some(name) = s.texts("save-lattice").last() {
            built.saves.push(SavedFile { name: (*name).to_owned(), text: save::write(&lattice) });
        }
        Ok(built)
    }
}

/// Reads the initial grid. The flag is `true` if a file gave it its region.
fn grid(s: &Settings<'_>) -> Result<(Grid, bool), Error> {
    let own_region = s.rect_if("region")?;
    let frame = s.frame().rect;
    if let Some(file) = s.file_if("lattice")? {
        for name in ["degree", "spline", "cells"] {
            if s.given(name) {
                let problem = "cannot go with `lattice`, which is a whole grid";
                return Err(Error::usage(name, s.texts(name).join(" "), problem));
            }
        }
        let (lattice, named) = read(file, own_region.unwrap_or(frame))?;
        // An explicit region wins: the grid is laid onto it.
        return Ok(match own_region {
            Some(r) => (Grid::Given(lattice.on(r)), true),
            None if s.given("region") => (Grid::Given(lattice.on(frame)), false),
            None => (Grid::Given(lattice), named),
        });
    }
    let degree = pair(s, "degree", MAX_DEGREE)?.unwrap_or([3, 3]);
    let cells = match pair(s, "cells", MAX_CELLS)? {
        Some(c) => c,
        None if s.flag("spline")? => [4, 4],
        None => [1, 1],
    };
    Ok((Grid::Regular { region: own_region.unwrap_or(frame), degree, cells }, false))
}

#[cfg(feature = "serde")]
fn read(file: &NamedText, frame: Rect) -> Result<(Lattice, bool), Error> {
    super::file::read(&file.name, &file.text, frame)
}

#[cfg(not(feature = "serde"))]
fn read(file: &NamedText, _: Rect) -> Result<(Lattice, bool), Error> {
    Err(crate::error::no_json(&file.name))
}

/// Reads `3x2`, or `3` for both.
fn pair(s: &Settings<'_>, name: &str, most: usize) -> Result<Option<[usize; 2]>, Error> {
    let Some(text) = s.texts(name).last().copied() else { return Ok(None) };
    let number = |t: &str| t.trim().parse::<usize>().ok().filter(|n| (1..=most).contains(n));
    let (a, b) = text.split_once(['x', 'X', '×']).unwrap_or((text, text));
    match (number(a), number(b)) {
        (Some(a), Some(b)) => Ok(Some([a, b])),
        _ => Err(Error::usage(name, text, format!("is not two numbers from 1 to {most}, such as 3x2"))),
    }
}

/// Reads `at`, `move` and `weight`, in this order.
fn changes(s: &Settings<'_>) -> Result<Vec<([usize; 2], Change)>, Error> {
    let mut out = Vec::new();
    for name in ["at", "move", "weight"] {
        for word in s.texts(name).into_iter().flat_map(str::split_whitespace) {
            let wrong = |problem: String| Error::usage(name, word, problem);
            let form = INFO.params.iter().find(|p| p.name == name).map_or(String::new(), Param::value_name);
            let (index, value) = word.split_once(':').ok_or_else(|| wrong(format!("is not {form}")))?;
            let parse = |t: &str| t.trim().parse::<usize>().ok();
            let (i, j) = index
                .split_once(',')
                .and_then(|(i, j)| parse(i).zip(parse(j)))
                .ok_or_else(|| wrong(format!("is not {form}: `{index}` is not a control point i,j")))?;
            let change = match name {
                "at" => Change::Place(s.point_in(name, value)?),
                "move" => {
                    let (x, y) = value.split_once(',').ok_or_else(|| wrong(format!("is not {form}")))?;
                    Change::Shift(Vec2::new(s.length_in(name, x, Axis::X)?, s.length_in(name, y, Axis::Y)?))
                }
                _ => {
                    let w = value.trim().parse::<f64>().ok().filter(|w| w.is_finite());
                    Change::Weight(w.ok_or_else(|| wrong(format!("is not {form}: `{value}` is not a number")))?)
                }
            };
            out.push(([i, j], change));
        }
    }
    Ok(out)
}

fn pins(s: &Settings<'_>) -> Result<Vec<(Point, Point)>, Error> {
    let pin = |word: &str| {
        let (from, to) =
            word.split_once(':').ok_or_else(|| Error::usage("pin", word, "is not FROM:TO, such as 10,20:15,25"))?;
        Ok((s.point_in("pin", from)?, s.point_in("pin", to)?))
    };
    s.texts("pin").into_iter().flat_map(str::split_whitespace).map(pin).collect()
}

fn frozen(s: &Settings<'_>) -> Result<[usize; 4], Error> {
    let mut counts = [0; 4];
    for text in s.texts("freeze") {
        for word in text.split([',', ' ']).filter(|w| !w.is_empty()) {
            let (side, count) = word.split_once(':').unwrap_or((word, "1"));
            let k = SIDES.iter().position(|n| *n == side).ok_or_else(|| {
                let problem = "is not SIDE:COUNT with a side left, right, top or bottom, such as left:2";
                Error::usage("freeze", word, problem)
            })?;
            let number = count.parse().map_err(|_| Error::usage("freeze", word, "does not end with a number"));
            counts[k] = number?;
        }
    }
    Ok(counts)
}
