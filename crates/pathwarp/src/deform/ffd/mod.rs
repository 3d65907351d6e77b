//! Free-form deformation by a grid of control points.
//!
//! With s, t running from 0 to 1 across the region, X(s,t) = Σ Bᵐᵢ(s) Bⁿⱼ(t) wᵢⱼ·(xᵢⱼ, yᵢⱼ, 1) (T. W. Sederberg, S. R. Parry,
//! *Free-form deformation of solid geometric models*, SIGGRAPH 1986; T. W. Sederberg, *Computer Aided Geometric Design*,
//! chapter 14, equations 14.1-14.3): see [`Lattice`]. Control points are counted from the left (i) and from the top (j),
//! from 0. Pins are solved for as in W. M. Hsu, J. F. Hughes, H. Kaufman, *Direct manipulation of free-form deformations*,
//! SIGGRAPH 1992: see [`map::pull`](crate::map::pull).
//!
//! A region that is the artwork's own box has no outside: the pieces run on there, so that strokes and what else reaches over
//! the outlines' box follow smoothly. Any other region ends in a border, beyond which nothing moves, unless `extend` is given.

use crate::deform::built::{Built, Explanation, Overlay, Role, SavedFile};
use crate::deform::entry::{Case, Deformation, Example, Info, Law};
use crate::error::Error;
use crate::lattice_file::{self, MOST_CELLS, MOST_DEGREE};
use crate::map::{AffineMap, Class, Lattice, LatticeMap, Map};
use crate::param::{Axis, Kind, Param, Settings};
use kurbo::{BezPath, Point, Vec2};
use pins::{MOST_PINS, pull};
use std::sync::Arc;

mod pins;

pub(super) struct Ffd;

static INFO: Info = Info::new("ffd", "pull artwork about by a grid of control points")
    .group("Lattices and nets")
    .about("A grid of control points lies over the artwork. Move some of them, and what lies near follows smoothly. Points are \
named i,j: column from the left, row from the top, both from 0. A grid of degree 3x2 has 4 by 3 of them; higher degrees bend \
more finely.\n\nOr say which points of the artwork are to go where (--pin), and the grid follows with the smallest change.\n\n\
With a region of its own (--region) nothing moves outside it. So that the artwork does not tear at the region's border, leave \
the outermost row or column of points there in its place (--freeze left:1); two keep it smooth, three keep its curvature.")
    .source("T. W. Sederberg, S. R. Parry, Free-form deformation of solid geometric models, SIGGRAPH 1986; T. W. Sederberg, \
Computer Aided Geometric Design, chapter 14; for --pin: W. M. Hsu, J. F. Hughes, H. Kaufman, Direct manipulation of free-form \
deformations, SIGGRAPH 1992")
    .params(&[
        Param::new("degree", Kind::Text("MxN"), "Degrees along x and y, 1 to 10 each: one less than the control points there.").default("3x3"),
        Param::new(
            "region",
            Kind::Text("artwork|X,Y,W,H"),
            "The box the grid lies on; outside it nothing moves. The artwork's box has no outside: there the map runs on.",
        )
        .default("artwork"),
        Param::new("move", Kind::Text("I,J:DX,DY"), "Move control point i,j by dx,dy (a length, or % of the artwork's box).").repeated(),
        Param::new("at", Kind::Text("I,J:X,Y"), "Put control point i,j at x,y.").repeated(),
        Param::new("weight", Kind::Text("I,J:W"), "Give control point i,j this weight: above 1 it pulls harder than the others.").repeated(),
        Param::new("pin", Kind::Text("X,Y:X,Y"), "Take the first point of the artwork to the second; the control points that are \
not frozen follow with the smallest change. Equal points hold a place fast.")
        .repeated(),
        Param::new("freeze", Kind::Text("SIDE:COUNT,…"), "Keep rows or columns along sides in their places, e.g. left:2,top:1: 1 for \
no tear at the region's border there, 2 for smooth, k+1 for k continuous derivatives."),
        Param::flag("extend", "Let the map run on outside the region instead of leaving everything there in place."),
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
        // Equal weights are no weights.
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

impl Deformation for Ffd {
    fn info(&self) -> &Info {
        &INFO
    }

    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        let own_region = s.rect_if("region")?;
        let (mut lattice, from_file) = start(s)?;
        let extended = s.flag("extend")? || (own_region.is_none() && !from_file);
        let r = lattice.region();
        if !(r.width() > 0.0 && r.height() > 0.0) {
            return Err(Error::usage("region", "artwork", "has no area: the artwork is flat; name a box x,y,w,h"));
        }

        let mut warnings = Vec::new();
        let frozen = Frozen::read(s, &lattice)?;
        let held: Vec<_> = indices(&lattice).filter(|&(i, j)| frozen.holds(i, j) && lattice.is_changed(i, j)).collect();
        if !held.is_empty() {
            warnings.push(format!("frozen control points of the file are put back: {}", names(&held)));
            for (i, j) in held {
                lattice.place(i, j, lattice.regular_point(i, j));
                lattice.set_weight(i, j, 1.0);
            }
        }
        moves(s, &mut lattice, &frozen)?;
        pins(s, &mut lattice, &frozen, extended, &mut warnings)?;
        if !extended {
            warnings.extend(tears(&lattice));
        }

        let map = LatticeMap::new(&lattice, extended);
        let map: Arc<dyn Map> = match map.class() {
            Class::Affine(m) => Arc::new(AffineMap(m)),
            _ => Arc::new(map),
        };
        let notes = vec![
            format!(
                "grid: {} by {} control points of degree {}x{} over {},{} to {},{}",
                lattice.columns(),
                lattice.rows(),
                lattice.degree()[0],
                lattice.degree()[1],
                r.x0,
                r.y0,
                r.x1,
                r.y1
            ),
            format!("outside the region: {}", if extended { "the map runs on" } else { "nothing moves" }),
        ];
        let regular = Lattice::regular(r, lattice.degree(), lattice.cells());
        let overlays =
            vec![Overlay { role: Role::Base, path: net(&regular) }, Overlay { role: Role::Cage, path: net(&lattice) }];
        let mut built = Built::new(map).explained(Explanation { notes, overlays, warnings });
        if let Some(name) = s.texts("save-lattice").last() {
            built.saves.push(SavedFile { name: (*name).to_owned(), text: lattice_file::write(&lattice) });
        }
        Ok(built)
    }
}

/// The grid to begin with, and whether it brought its own region.
fn start(s: &Settings<'_>) -> Result<(Lattice, bool), Error> {
    let own_region = s.rect_if("region")?;
    let frame = s.frame().rect;
    if let Some(file) = s.file_if("lattice")? {
        for name in ["degree", "spline", "cells"] {
            if s.given(name) {
                return Err(Error::usage(name, s.texts(name).join(" "), "cannot go with `lattice`: the file says it"));
            }
        }
        let (lattice, named) = lattice_file::read(&file.name, &file.text, own_region.unwrap_or(frame))?;
        // A region that was asked for wins: the grid is laid onto it.
        return Ok(match own_region {
            Some(r) => (lattice.on(r), true),
            None if s.given("region") => (lattice.on(frame), false),
            None => (lattice, named),
        });
    }
    let degree = pair(s, "degree", MOST_DEGREE)?.unwrap_or([3, 3]);
    let cells = match pair(s, "cells", MOST_CELLS)? {
        Some(c) => c,
        None if s.flag("spline")? => [4, 4],
        None => [1, 1],
    };
    Ok((Lattice::regular(own_region.unwrap_or(frame), degree, cells), false))
}

/// `3x2`, or `3` for both.
fn pair(s: &Settings<'_>, name: &str, most: usize) -> Result<Option<[usize; 2]>, Error> {
    let Some(text) = s.texts(name).last().copied() else { return Ok(None) };
    let number = |t: &str| t.trim().parse::<usize>().ok().filter(|n| (1..=most).contains(n));
    let (a, b) = text.split_once(['x', 'X', '×']).unwrap_or((text, text));
    match (number(a), number(b)) {
        (Some(a), Some(b)) => Ok(Some([a, b])),
        _ => Err(Error::usage(name, text, format!("is not two numbers from 1 to {most}, such as 3x2"))),
    }
}

fn indices(l: &Lattice) -> impl Iterator<Item = (usize, usize)> + use<> {
    let (m, n) = (l.columns(), l.rows());
    (0..n).flat_map(move |j| (0..m).map(move |i| (i, j)))
}

fn names(points: &[(usize, usize)]) -> String {
    /// More would not be read.
    const SHOWN: usize = 8;
    let mut out = points.iter().take(SHOWN).map(|(i, j)| format!("{i},{j}")).collect::<Vec<_>>().join(" ");
    if points.len() > SHOWN {
        out += &format!(" and {} more", points.len() - SHOWN);
    }
    out
}

/// How many columns and rows are kept in place: left, right, top, bottom.
struct Frozen {
    counts: [usize; 4],
    size: [usize; 2],
}

/// Sides, in the order of [`Frozen::counts`].
const SIDES: [&str; 4] = ["left", "right", "top", "bottom"];

impl Frozen {
    fn read(s: &Settings<'_>, l: &Lattice) -> Result<Self, Error> {
        let mut out = Self { counts: [0; 4], size: [l.columns(), l.rows()] };
        for text in s.texts("freeze") {
            for word in text.split([',', ' ']).filter(|w| !w.is_empty()) {
                let (side, count) = word.split_once(':').unwrap_or((word, "1"));
                let wrong = |what: String| Error::usage("freeze", word, what);
                let k = SIDES.iter().position(|n| *n == side).ok_or_else(|| {
                    wrong("is not SIDE:COUNT with a side left, right, top or bottom, such as left:2".into())
                })?;
                let most = out.size[k / 2];
                out.counts[k] = count
                    .parse()
                    .ok()
                    .filter(|n| *n <= most)
                    .ok_or_else(|| wrong(format!("does not say how many to freeze: 0 to {most} there")))?;
            }
        }
        Ok(out)
    }

    fn holds(&self, i: usize, j: usize) -> bool {
        let [left, right, top, bottom] = self.counts;
        i < left || i + right >= self.size[0] || j < top || j + bottom >= self.size[1]
    }
}

/// `at`, `move` and `weight`, in this order.
fn moves(s: &Settings<'_>, l: &mut Lattice, frozen: &Frozen) -> Result<(), Error> {
    for name in ["at", "move", "weight"] {
        for word in s.texts(name).into_iter().flat_map(str::split_whitespace) {
            let wrong = |what: String| Error::usage(name, word, what);
            let form = INFO.params.iter().find(|p| p.name == name).map_or(String::new(), Param::value_name);
            let (index, value) = word.split_once(':').ok_or_else(|| wrong(format!("is not {form}")))?;
            let parse = |t: &str| t.trim().parse::<usize>().ok();
            let (i, j) = index
                .split_once(',')
                .and_then(|(i, j)| parse(i).zip(parse(j)))
                .ok_or_else(|| wrong(format!("is not {form}: `{index}` names no control point i,j")))?;
            if i >= l.columns() || j >= l.rows() {
                let (m, n) = (l.columns() - 1, l.rows() - 1);
                return Err(wrong(format!(
                    "names a control point that is not there: i goes from 0 to {m}, j from 0 to {n}"
                )));
            }
            if frozen.holds(i, j) {
                return Err(wrong("changes a control point that `freeze` keeps in place".into()));
            }
            match name {
                "at" => l.place(i, j, s.point_in(name, value)?),
                "move" => {
                    let (x, y) = value.split_once(',').ok_or_else(|| wrong(format!("is not {form}")))?;
                    l.shift(i, j, Vec2::new(s.length_in(name, x, Axis::X)?, s.length_in(name, y, Axis::Y)?));
                }
                _ => {
                    let w = value.trim().parse::<f64>().ok().filter(|w| w.is_finite());
                    l.set_weight(i, j, w.ok_or_else(|| wrong(format!("is not {form}: `{value}` is no number")))?);
                }
            }
        }
    }
    Ok(())
}

/// `pin`, last.
fn pins(
    s: &Settings<'_>,
    l: &mut Lattice,
    frozen: &Frozen,
    extended: bool,
    warnings: &mut Vec<String>,
) -> Result<(), Error> {
    let words: Vec<&str> = s.texts("pin").into_iter().flat_map(str::split_whitespace).collect();
    if words.len() > MOST_PINS {
        return Err(Error::usage("pin", words[MOST_PINS], format!("is one too many: {MOST_PINS} pins at most")));
    }
    let mut pins: Vec<(Point, Point)> = Vec::with_capacity(words.len());
    for word in &words {
        let (from, to) =
            word.split_once(':').ok_or_else(|| Error::usage("pin", *word, "is not FROM:TO, such as 10,20:15,25"))?;
        let (from, to) = (s.point_in("pin", from)?, s.point_in("pin", to)?);
        let r = l.region();
        if !extended && !(r.x0..=r.x1).contains(&from.x) | !(r.y0..=r.y1).contains(&from.y) {
            return Err(Error::usage("pin", *word, "takes hold outside the region, where nothing moves"));
        }
        pins.push((from, to));
    }
    if pins.is_empty() {
        return Ok(());
    }
    let off = pull(l, |i, j| !frozen.holds(i, j), &pins);
    let r = l.region();
    for (word, off) in words.iter().zip(off).filter(|(_, off)| *off > 1e-9 * (r.width() + r.height())) {
        warnings.push(format!(
            "`pin {word}` is missed by {off:.6}: the grid has too few control points that may move; raise `degree` or freeze fewer"
        ));
    }
    Ok(())
}

/// The sides at which the artwork tears.
fn tears(l: &Lattice) -> Vec<String> {
    let (m, n) = (l.columns() - 1, l.rows() - 1);
    let on = |k: usize, i: usize, j: usize| [i == 0, i == m, j == 0, j == n][k];
    let side = |(k, name): (usize, &&str)| {
        let moved: Vec<_> = indices(l).filter(|&(i, j)| on(k, i, j) && l.is_changed(i, j)).collect();
        (!moved.is_empty()).then(|| {
            format!(
                "artwork that crosses the region's {name} border tears there: control points {} on it were changed; keep them \
with `freeze {name}:1`, or let the map run on with `extend`",
                names(&moved)
            )
        })
    };
    SIDES.iter().enumerate().filter_map(side).collect()
}

/// Rows and columns of control points as polylines.
fn net(l: &Lattice) -> BezPath {
    let mut p = BezPath::new();
    let mut line = |points: Vec<Point>| {
        for (k, q) in points.into_iter().enumerate() {
            if k == 0 { p.move_to(q) } else { p.line_to(q) }
        }
    };
    for j in 0..l.rows() {
        line((0..l.columns()).map(|i| l.point(i, j)).collect());
    }
    for i in 0..l.columns() {
        line((0..l.rows()).map(|j| l.point(i, j)).collect());
    }
    p
}
