//! Free-form deformation by a grid of control points.
//!
//! With s, t from 0 to 1 across the region, the image in homogeneous coordinates is X(s,t) = Σ Bᵐᵢ(s) Bⁿⱼ(t) wᵢⱼ·(xᵢⱼ, yᵢⱼ, 1)
//! (T. W. Sederberg, S. R. Parry, *Free-form deformation of solid geometric models*, SIGGRAPH 1986; T. W. Sederberg, *Computer Aided
//! Geometric Design*, chapter 14, equations 14.1-14.3): see [`Lattice`]. Control points are counted from 0, from the left (i) and
//! from the top (j). Points of the artwork can be pinned to their images (W. M. Hsu, J. F. Hughes, H. Kaufman, *Direct manipulation of
//! free-form deformations*, SIGGRAPH 1992): see [`pull`].
//!
//! If the region is the artwork's box, the map continues outside it, so that strokes, which reach past the box, follow smoothly.
//! Any other region ends in a border, beyond which nothing moves unless the map is extended.

#[cfg(feature = "serde")]
mod file;
mod save;

use super::entry::{Built, ByHand, Case, Entry, Example, Info, Instead, Law, Role, SavedFile};
use crate::error::{Error, check_range, show};
use crate::map::{AffineMap, Class, Lattice, LatticeMap, Map};
use crate::param::{Axis, Kind, NamedText, Param, Settings};
use crate::solve::{misses, smallest_change};
use kurbo::{BezPath, Point, Rect, Vec2};
use std::sync::Arc;

#[cfg(feature = "serde")]
pub(super) use file::region_in_file;
pub(super) use save::{MAX_CELLS, MAX_DEGREE};

/// Free-form deformation: artwork follows a grid of control points.
///
/// X(s,t) = Σ Bᵐᵢ(s) Bⁿⱼ(t) wᵢⱼ·(xᵢⱼ, yᵢⱼ, 1) over a region, with Bernstein polynomials or uniform clamped B-splines B.
/// Control points are numbered from the left (i) and from the top (j), from 0.
///
/// ```
/// use pathwarp::{deform::Ffd, kurbo::{Point, Rect}, map::Map};
///
/// let pulled = Ffd::new(Rect::new(0.0, 0.0, 100.0, 100.0)).degree(2, 2).shift(1, 1, (10.0, -8.0)).build()?;
/// assert!(pulled.map.point(Point::new(50.0, 50.0)).distance(Point::new(52.5, 48.0)) < 1e-13);
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Ffd {
    grid: Grid,
    changes: Vec<([usize; 2], Change)>,
    pins: Vec<(Point, Point)>,
    /// Numbers of columns and rows that do not move: left, right, top, bottom.
    frozen: [usize; 4],
    extended: bool,
}

/// The grid before it is changed.
#[derive(Debug, Clone, PartialEq)]
enum Grid {
    Regular { region: Rect, degree: [usize; 2], cells: [usize; 2] },
    Given(Lattice),
}

/// Sides, in the order of [`Ffd::frozen`].
const SIDES: [&str; 4] = ["left", "right", "top", "bottom"];

impl Ffd {
    /// Creates a regular grid of degree 3×3 over `region`. Outside the region nothing moves, unless it is
    /// [extended](Self::extend).
    #[must_use]
    pub fn new(region: Rect) -> Self {
        Self::from_grid(Grid::Regular { region, degree: [3, 3], cells: [1, 1] })
    }

    /// Starts from the control points of a lattice.
    #[must_use]
    pub fn from_lattice(lattice: Lattice) -> Self {
        Self::from_grid(Grid::Given(lattice))
    }

    fn from_grid(grid: Grid) -> Self {
        Self { grid, changes: Vec::new(), pins: Vec::new(), frozen: [0; 4], extended: false }
    }

    /// Sets the degrees along x and y of a regular grid, 1 to 10 each. A grid of degree n has n + 1 control points.
    #[must_use]
    pub fn degree(mut self, x: usize, y: usize) -> Self {
        if let Grid::Regular { degree, .. } = &mut self.grid {
            *degree = [x, y];
        }
        self
    }

    /// Makes a regular grid a B-spline with this many cells along x and y, 1 to 64 each. It has degree + cells control points.
    #[must_use]
    pub fn cells(mut self, x: usize, y: usize) -> Self {
        if let Grid::Regular { cells, .. } = &mut self.grid {
            *cells = [x, y];
        }
        self
    }

    /// Sets the position of control point (i, j).
    #[must_use]
    pub fn place(mut self, i: usize, j: usize, at: impl Into<Point>) -> Self {
        self.changes.push(([i, j], Change::Place(at.into())));
        self
    }

    /// Moves control point (i, j) by a vector in user units.
    #[must_use]
    pub fn shift(mut self, i: usize, j: usize, by: impl Into<Vec2>) -> Self {
        self.changes.push(([i, j], Change::Shift(by.into())));
        self
    }

    /// Sets the weight of control point (i, j): above 1 it pulls harder than the others.
    #[must_use]
    pub fn weight(mut self, i: usize, j: usize, weight: f64) -> Self {
        self.changes.push(([i, j], Change::Weight(weight)));
        self
    }

    /// Pins a point of the artwork to its image, by the smallest change of the control points that are not frozen. All pins are solved
    /// for together, after all other changes. At most 256.
    #[must_use]
    pub fn pin(mut self, from: impl Into<Point>, to: impl Into<Point>) -> Self {
        self.pins.push((from.into(), to.into()));
        self
    }

    setters! {
        /// Keeps so many columns and rows along the left, right, top and bottom side in place: 1 avoids a tear at the region's
        /// border there, k + 1 keeps k derivatives continuous.
        freeze(left: usize, right: usize, top: usize, bottom: usize) => frozen: [left, right, top, bottom];
        /// Lets the map continue outside the region.
        extend(extended: bool) => extended: extended;
    }

    /// Builds the map. Borders that tear the artwork and pins that are missed give warnings.
    ///
    /// # Errors
    /// [`Error::Usage`] when the region has no area, degrees or control points are out of range, frozen points are changed, there are too
    /// many pins, or a pin is outside the region of a map that is not extended.
    pub fn build(&self) -> Result<Built, Error> {
        Ok(self.build_with_lattice()?.0)
    }

    /// Builds the map, and returns it with the changed grid.
    ///
    /// # Errors
    /// [`Error::Usage`] in the cases listed for [`Ffd::build`].
    pub fn build_with_lattice(&self) -> Result<(Built, Lattice), Error> {
        let mut lattice = self.initial_lattice()?;
        let mut warnings = Vec::new();
        let (columns, rows) = (lattice.columns(), lattice.rows());
        let is_reset = |&(i, j): &(usize, usize)| self.is_frozen([columns, rows], i, j) && lattice.is_changed(i, j);
        let reset: Vec<_> = indices(&lattice).filter(is_reset).collect();
        if !reset.is_empty() {
            warnings.push(format!("frozen control points of the grid are put back in place: {}", list_points(&reset)));
            for (i, j) in reset {
                lattice.place(i, j, lattice.regular_point(i, j));
                lattice.set_weight(i, j, 1.0);
            }
        }
        self.apply_changes(&mut lattice)?;
        self.apply_pins(&mut lattice, &mut warnings)?;
        if !self.extended {
            warnings.extend(tears(&lattice));
        }

        let map = LatticeMap::new(&lattice, self.extended);
        let map: Arc<dyn Map> = match map.class() {
            Class::Affine(m) => Arc::new(AffineMap(m)),
            _ => Arc::new(map),
        };
        let (region, [m, n]) = (lattice.region(), lattice.degree());
        let Rect { x0, y0, x1, y1 } = region;
        let mut built = Built::new(map);
        built.explanation.warnings = warnings;
        built.note(format!("grid: {columns} by {rows} control points of degree {m}x{n} over {x0},{y0} to {x1},{y1}"));
        let outside = if self.extended { "the map continues" } else { "nothing moves" };
        built.note(format!("outside the region: {outside}"));
        built.overlay(Role::Base, polylines(&Lattice::regular(region, [m, n], lattice.cells())));
        built.overlay(Role::Cage, polylines(&lattice));
        Ok((built, lattice))
    }

    /// Returns the grid before its changes.
    fn initial_lattice(&self) -> Result<Lattice, Error> {
        let lattice = match &self.grid {
            Grid::Given(lattice) => lattice.clone(),
            Grid::Regular { region, degree, cells } => {
                for (name, pair, max) in [("degree", degree, MAX_DEGREE), ("cells", cells, MAX_CELLS)] {
                    for n in pair {
                        check_range(name, *n as f64, 1.0, max as f64)?;
                    }
                }
                Lattice::regular(*region, *degree, *cells)
            }
        };
        let r = lattice.region();
        if !(r.width() > 0.0 && r.height() > 0.0) {
            return Err(Error::usage("region", "artwork", "has no area: the artwork is flat; name a box x,y,w,h"));
        }
        // Columns along the left and the right side, rows along the top and the bottom.
        let size = [lattice.columns(), lattice.rows()];
        if let Some(side) = (0..4).find(|side| self.frozen[*side] > size[side / 2]) {
            let problem = format!("freezes too many: 0 to {} there", size[side / 2]);
            return Err(Error::usage("freeze", format!("{}:{}", SIDES[side], self.frozen[side]), problem));
        }
        Ok(lattice)
    }

    /// Returns `true` if control point (i, j) of a grid of this size is frozen.
    fn is_frozen(&self, [columns, rows]: [usize; 2], i: usize, j: usize) -> bool {
        let [left, right, top, bottom] = self.frozen;
        i < left || i + right >= columns || j < top || j + bottom >= rows
    }

    fn apply_changes(&self, l: &mut Lattice) -> Result<(), Error> {
        for &([i, j], change) in &self.changes {
            let wrong = |problem: String| Error::usage(change.param(), format!("{i},{j}"), problem);
            if i >= l.columns() || j >= l.rows() {
                let (m, n) = (l.columns() - 1, l.rows() - 1);
                return Err(wrong(format!("is not a control point: i goes from 0 to {m}, j from 0 to {n}")));
            }
            if self.is_frozen([l.columns(), l.rows()], i, j) {
                return Err(wrong("is a control point that `freeze` keeps in place".into()));
            }
            match change {
                Change::Place(p) => l.place(i, j, p),
                Change::Shift(v) => l.shift(i, j, v),
                Change::Weight(w) => l.set_weight(i, j, w),
            }
        }
        Ok(())
    }

    fn apply_pins(&self, l: &mut Lattice, warnings: &mut Vec<String>) -> Result<(), Error> {
        let shown = |(p, q): &(Point, Point)| format!("{}:{}", show(*p), show(*q));
        if let Some(extra) = self.pins.get(MAX_PINS) {
            return Err(Error::usage(
                "pin",
                shown(extra),
                format!("is one pin too many; at most {MAX_PINS} are possible"),
            ));
        }
        let r = l.region();
        let in_region = |p: Point| (r.x0..=r.x1).contains(&p.x) && (r.y0..=r.y1).contains(&p.y);
        if let Some(pin) = self.pins.iter().find(|(from, _)| !self.extended && !in_region(*from)) {
            return Err(Error::usage("pin", shown(pin), "takes hold outside the region, where nothing moves"));
        }
        if self.pins.is_empty() {
            return Ok(());
        }
        let size = [l.columns(), l.rows()];
        let distances = pull(l, |i, j| !self.is_frozen(size, i, j), &self.pins);
        let rounding = 1e-9 * (r.width() + r.height());
        for (pin, distance) in self.pins.iter().zip(distances).filter(|(_, distance)| *distance > rounding) {
            warnings.push(format!(
                "the pin {} is missed by {distance:.6}: the grid has too few control points that may move; raise `degree` or freeze fewer",
                shown(pin)
            ));
        }
        Ok(())
    }
}

fn indices(l: &Lattice) -> impl Iterator<Item = (usize, usize)> + use<> {
    let (m, n) = (l.columns(), l.rows());
    (0..n).flat_map(move |j| (0..m).map(move |i| (i, j)))
}

/// Lists control points for a message.
fn list_points(points: &[(usize, usize)]) -> String {
    /// Limit on the points that are listed.
    const SHOWN: usize = 8;
    let mut out = points.iter().take(SHOWN).map(|(i, j)| format!("{i},{j}")).collect::<Vec<_>>().join(" ");
    if points.len() > SHOWN {
        out += &format!(" and {} more", points.len() - SHOWN);
    }
    out
}

/// Warns of sides at which the artwork tears.
fn tears(l: &Lattice) -> Vec<String> {
    let (m, n) = (l.columns() - 1, l.rows() - 1);
    let is_on_side = |side: usize, i: usize, j: usize| [i == 0, i == m, j == 0, j == n][side];
    let tear = |(side, name): (usize, &&str)| {
        let changed: Vec<_> = indices(l).filter(|&(i, j)| is_on_side(side, i, j) && l.is_changed(i, j)).collect();
        (!changed.is_empty()).then(|| {
            format!(
                "artwork that crosses the region's {name} border tears there, because control points {} on it were changed; keep them \
in place with `freeze {name}:1`, or let the map continue with `extend`",
                list_points(&changed)
            )
        })
    };
    SIDES.iter().enumerate().filter_map(tear).collect()
}

/// Draws rows and columns of control points.
fn polylines(l: &Lattice) -> BezPath {
    let mut out = BezPath::new();
    let (columns, rows) = (l.columns(), l.rows());
    for (i, j) in indices(l) {
        if i == 0 { out.move_to(l.point(i, j)) } else { out.line_to(l.point(i, j)) }
    }
    for (i, j) in (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j))) {
        if j == 0 { out.move_to(l.point(i, j)) } else { out.line_to(l.point(i, j)) }
    }
    out
}

/// Limit on pins. The work grows with the cube of their number.
const MAX_PINS: usize = 256;

/// Moves the control points that are `free` so that the lattice takes the first point of each pin to the second. Returns the
/// distance by which each pin is missed, which is rounding if the lattice can meet all pins.
///
/// The image of a point is Σ Rₖ Pₖ, with influences Rₖ that do not depend on the control points' positions Pₖ. A pin p → q asks for
/// changes dₖ with Σₖ Rₖ(p) dₖ = q − F(p): one row of a linear system per pin, whose solution of least norm is taken.
fn pull(lattice: &mut Lattice, free: impl Fn(usize, usize) -> bool, pins: &[(Point, Point)]) -> Vec<f64> {
    let columns = lattice.columns();
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(pins.len());
    let mut shifts: Vec<[f64; 2]> = Vec::with_capacity(pins.len());
    for (from, to) in pins {
        let mut row = vec![0.0; columns * lattice.rows()];
        let mut image = Vec2::ZERO;
        for ((i, j), r) in lattice.influence(*from) {
            image += lattice.point(i, j).to_vec2() * r;
            if free(i, j) {
                row[j * columns + i] = r;
            }
        }
        rows.push(row);
        let shift = to.to_vec2() - image;
        shifts.push([shift.x, shift.y]);
    }
    let changes = smallest_change(&rows, &shifts);
    for (k, [x, y]) in changes.iter().enumerate().filter(|(_, d)| **d != [0.0; 2]) {
        lattice.shift(k % columns, k / columns, Vec2::new(*x, *y));
    }
    misses(&rows, &shifts, &changes)
}

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

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| {
    let is_artworks_box = s.rect_if("region")?.is_none();
    let (grid, has_region) = grid(s)?;
    let ffd = Ffd {
        grid,
        changes: changes(s, |text| text.split_whitespace().collect())?,
        pins: pins(s)?,
        frozen: frozen(s)?,
        extended: s.flag("extend")? || (is_artworks_box && !has_region),
    };
    let (mut built, lattice) = ffd.build_with_lattice()?;
    if let Some(name) = s.texts("save-lattice").last() {
        built.saves.push(SavedFile { name: (*name).to_owned(), text: save::write(&lattice) });
    }
    Ok(built)
});

/// Reads the initial grid. The flag is `true` for a lattice from a file whose region that file or `region` gives.
fn grid(s: &Settings<'_>) -> Result<(Grid, bool), Error> {
    // `None` for the artwork's box, whether by default or by `region artwork`.
    let region = s.rect_if("region")?;
    let frame = s.frame().rect;
    if let Some(file) = s.file_if("lattice")? {
        for name in ["degree", "spline", "cells"] {
            if s.given(name) {
                let problem = "cannot go with `lattice`, which is a whole grid";
                return Err(Error::usage(name, s.texts(name).join(" "), problem));
            }
        }
        let (lattice, has_region) = read(file, region.unwrap_or(frame))?;
        // The grid of a file is laid onto an explicit region.
        return Ok(match region {
            Some(r) => (Grid::Given(lattice.on(r)), true),
            None if s.given("region") => (Grid::Given(lattice.on(frame)), false),
            None => (Grid::Given(lattice), has_region),
        });
    }
    let degree = pair(s, "degree", MAX_DEGREE)?.unwrap_or([3, 3]);
    let cells = match pair(s, "cells", MAX_CELLS)? {
        Some(c) => c,
        None if s.flag("spline")? => [4, 4],
        None => [1, 1],
    };
    Ok((Grid::Regular { region: region.unwrap_or(frame), degree, cells }, false))
}

#[cfg(feature = "serde")]
fn read(file: &NamedText, frame: Rect) -> Result<(Lattice, bool), Error> {
    file::read(&file.name, &file.text, frame)
}

#[cfg(not(feature = "serde"))]
fn read(file: &NamedText, _: Rect) -> Result<(Lattice, bool), Error> {
    Err(crate::error::no_json(&file.name))
}

/// Reads `3x2`, or `3` for both.
fn pair(s: &Settings<'_>, name: &str, max: usize) -> Result<Option<[usize; 2]>, Error> {
    let Some(text) = s.texts(name).last().copied() else { return Ok(None) };
    let number = |t: &str| t.trim().parse::<usize>().ok().filter(|n| (1..=max).contains(n));
    let (a, b) = text.split_once(['x', 'X', '×']).unwrap_or((text, text));
    match (number(a), number(b)) {
        (Some(a), Some(b)) => Ok(Some([a, b])),
        _ => Err(Error::usage(name, text, format!("is not two numbers from 1 to {max}, such as 3x2"))),
    }
}

/// Reads the changes in `at`, `move` and `weight`, in this order, of control points with N indices; `split` divides a value into changes.
pub(super) fn changes<'a, const N: usize>(
    s: &Settings<'a>,
    split: impl Fn(&'a str) -> Vec<&'a str>,
) -> Result<Vec<([usize; N], Change)>, Error> {
    let mut out = Vec::new();
    for name in ["at", "move", "weight"] {
        for text in s.texts(name).into_iter().flat_map(&split) {
            let (node, value) = s.node_in::<N>(name, text)?;
            let change = match name {
                "at" => Change::Place(s.point_in(name, value)?),
                "move" => {
                    let wrong = || Error::usage(name, text, "does not end with a shift DX,DY, such as 10,-5");
                    let (x, y) = value.split_once(',').ok_or_else(wrong)?;
                    Change::Shift(Vec2::new(s.length_in(name, x, Axis::X)?, s.length_in(name, y, Axis::Y)?))
                }
                _ => Change::Weight(s.number_in(name, value)?),
            };
            out.push((node, change));
        }
    }
    Ok(out)
}

fn pins(s: &Settings<'_>) -> Result<Vec<(Point, Point)>, Error> {
    let pin = |word: &str| {
        let wrong = || Error::usage("pin", word, "is not FROM:TO, such as 10,20:15,25");
        let (from, to) = word.split_once(':').ok_or_else(wrong)?;
        Ok((s.point_in("pin", from)?, s.point_in("pin", to)?))
    };
    s.texts("pin").into_iter().flat_map(str::split_whitespace).map(pin).collect()
}

fn frozen(s: &Settings<'_>) -> Result<[usize; 4], Error> {
    let mut counts = [0; 4];
    for word in s.texts("freeze").into_iter().flat_map(|t| t.split([',', ' '])).filter(|w| !w.is_empty()) {
        let wrong = |problem: &str| Error::usage("freeze", word, problem);
        let (name, count) = word.split_once(':').unwrap_or((word, "1"));
        let side = SIDES.iter().position(|n| *n == name);
        let side =
            side.ok_or_else(|| wrong("is not SIDE:COUNT with a side left, right, top or bottom, such as left:2"))?;
        counts[side] = count.parse().map_err(|_| wrong("does not end with a whole number, such as left:2"))?;
    }
    Ok(counts)
}

/// A change of one control point, of a grid or of a Bézier triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Change {
    /// Sets its position.
    Place(Point),
    /// Moves it by a vector, in user units.
    Shift(Vec2),
    /// Sets its weight.
    Weight(f64),
}

impl Change {
    /// Returns the name of the parameter for this change.
    pub(super) const fn param(self) -> &'static str {
        match self {
            Self::Place(_) => "at",
            Self::Shift(_) => "move",
            Self::Weight(_) => "weight",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    fn lattice() -> Lattice {
        Lattice::regular(Rect::new(10.0, 20.0, 110.0, 80.0), [3, 2], [1, 1])
    }

    #[test]
    fn pins_are_met_with_the_smallest_change() {
        let mut l = lattice();
        l.set_weight(1, 1, 2.0);
        let pins = [
            (Point::new(30.0, 40.0), Point::new(35.0, 38.0)),
            (Point::new(80.0, 60.0), Point::new(80.0, 66.0)),
            (Point::new(90.0, 30.0), Point::new(90.0, 30.0)),
        ];
        let off = pull(&mut l, |_, _| true, &pins);
        let map = LatticeMap::new(&l, false);
        for ((from, to), off) in pins.iter().zip(off) {
            assert!(map.point(*from).distance(*to) < 1e-12 && off < 1e-12);
        }
        // The smallest change is a combination of the pins' rows, and so orthogonal to any change that keeps the pins.
        let norm = |l: &Lattice| -> f64 {
            (0..3)
                .flat_map(|j| (0..4).map(move |i| (i, j)))
                .map(|(i, j)| (l.point(i, j) - l.regular_point(i, j)).hypot2())
                .sum()
        };
        let mut other = l.clone();
        other.shift(0, 0, Vec2::new(3.0, -2.0));
        pull(&mut other, |i, j| (i, j) != (0, 0), &pins);
        let map = LatticeMap::new(&other, false);
        assert!(pins.iter().all(|(from, to)| map.point(*from).distance(*to) < 1e-12));
        assert!(norm(&other) > norm(&l));
    }

    #[test]
    fn frozen_points_stay_and_contradictions_are_reported() {
        let mut l = lattice();
        let at = Point::new(60.0, 50.0);
        let off = pull(&mut l, |i, _| i > 1, &[(at, Point::new(65.0, 50.0))]);
        assert!(off[0] < 1e-12 && (0..3).all(|j| !l.is_changed(0, j) && !l.is_changed(1, j)));
        let mut l = lattice();
        let off = pull(&mut l, |_, _| true, &[(at, Point::new(66.0, 50.0)), (at, Point::new(60.0, 50.0))]);
        assert!((off[0] - 3.0).abs() < 1e-12 && (off[1] - 3.0).abs() < 1e-12, "halfway: {off:?}");
    }
}
