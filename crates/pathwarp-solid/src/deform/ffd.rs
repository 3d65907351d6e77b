//! Free-form deformation of space by a box of control points.
//!
//! [`Lattice3`] has the formula. Pins are solved as in W. M. Hsu, J. F. Hughes, H. Kaufman, *Direct manipulation of free-form
//! deformations*, SIGGRAPH 1992.

use super::entry::{About3, Built3, Case3, Entry, Law3};
use crate::hull::HullMap;
use crate::lattice::{Lattice3, LatticeMap3};
use crate::settings::{Box3, Settings3, show};
use glam::DVec3;
use pathwarp::Error;
use pathwarp::deform::{Example, Info, SavedFile};
use pathwarp::engine::solve::{misses, smallest_change};
use pathwarp::param::{Kind, Param};
use pathwarp::setters;
use serde::Deserialize;
use std::sync::Arc;

/// Limit on the degree of a lattice along an axis.
const MAX_DEGREE: usize = 10;
/// Limit on the number of Bézier pieces along an axis.
const MAX_CELLS: usize = 16;
/// Limit on the number of pins. The work grows with its cube.
const MAX_PINS: usize = 256;

/// Faces of a box in the order of [`Ffd3::freeze`]: along x, y and z, with the lower one first.
const FACES: [&str; 6] = ["left", "right", "bottom", "top", "back", "front"];

/// A change of one control point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Change3 {
    /// Moves it to this point.
    Place(DVec3),
    /// Moves it by this vector.
    Shift(DVec3),
    /// Sets its weight. Above 1, it pulls harder than the others.
    Weight(f64),
}

impl Change3 {
    const fn param(self) -> &'static str {
        match self {
            Self::Place(_) => "at",
            Self::Shift(_) => "move",
            Self::Weight(_) => "weight",
        }
    }
}

/// Free-form deformation: a model follows a box of control points.
///
/// ```
/// use glam::DVec3;
/// use pathwarp_solid::{Box3, deform::{Change3, Ffd3}, Lattice3, map::Map3};
///
/// let lattice = Lattice3::regular(Box3::new(DVec3::ZERO, DVec3::splat(100.0)), [2, 2, 2], [1, 1, 1]);
/// let pulled = Ffd3::new(lattice).change([1, 1, 1], Change3::Shift(DVec3::new(8.0, 0.0, 0.0))).extend(true).build()?;
/// assert_eq!(pulled.map.point(DVec3::splat(50.0)).x, 51.0);
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Ffd3 {
    lattice: Lattice3,
    changes: Vec<([usize; 3], Change3)>,
    pins: Vec<(DVec3, DVec3)>,
    frozen: [usize; 6],
    extended: bool,
}

impl Ffd3 {
    /// Starts from a lattice. Nothing moves outside its box, unless it is [extended](Self::extend).
    #[must_use]
    pub fn new(lattice: Lattice3) -> Self {
        Self { lattice, changes: Vec::new(), pins: Vec::new(), frozen: [0; 6], extended: false }
    }

    /// Changes a control point.
    #[must_use]
    pub fn change(mut self, node: [usize; 3], change: Change3) -> Self {
        self.changes.push((node, change));
        self
    }

    /// Moves a point of the model to another. The control points that are not frozen follow with the smallest change. All pins, at
    /// most 256, are solved together after all other changes.
    #[must_use]
    pub fn pin(mut self, from: DVec3, to: DVec3) -> Self {
        self.pins.push((from, to));
        self
    }

    setters! {
        /// Freezes layers of control points along the left, right, bottom, top, back and front face. One layer avoids a tear at the
        /// face, and k + 1 layers keep k derivatives continuous.
        freeze(layers: [usize; 6]) => frozen: layers;
        /// Sets whether the map continues outside the box.
        extend(extended: bool) => extended: extended;
    }

    /// Builds the map. Pins that are missed give warnings.
    ///
    /// # Errors
    /// [`Error::Usage`] for a box without volume, control points that do not exist, changes of frozen points, too many pins, and
    /// pins outside the box of a map that is not extended.
    pub fn build(&self) -> Result<Built3, Error> {
        Ok(self.build_with_lattice()?.0)
    }

    /// Builds the map, and returns it with the changed lattice.
    ///
    /// # Errors
    /// [`Error::Usage`] in the cases of [`Ffd3::build`].
    pub fn build_with_lattice(&self) -> Result<(Built3, Lattice3), Error> {
        let mut lattice = self.lattice.clone();
        let region = lattice.region();
        if !(region.size().min_element() > 0.0 && region.size().is_finite()) {
            let problem = "has no volume: the model is flat; name a box x,y,z,w,h,d";
            return Err(Error::usage("region", "model", problem));
        }
        if let Some(f) = (0..6).find(|f| self.frozen[*f] > lattice.size()[f / 2]) {
            let problem = format!("freezes too many: 0 to {} there", lattice.size()[f / 2]);
            return Err(Error::usage("freeze", format!("{}:{}", FACES[f], self.frozen[f]), problem));
        }
        let mut warnings = Vec::new();
        let put_back: Vec<_> = lattice.nodes().filter(|n| self.is_frozen(*n) && lattice.is_changed(*n)).collect();
        if !put_back.is_empty() {
            warnings.push(format!("frozen control points are put back in place: {}", names(&put_back)));
            for node in put_back {
                lattice.place(node, lattice.regular_point(node));
                lattice.set_weight(node, 1.0);
            }
        }
        self.apply_changes(&mut lattice)?;
        self.apply_pins(&mut lattice, &mut warnings)?;
        let mut built = Built3::new(Arc::new(LatticeMap3::new(&lattice, self.extended)));
        built.warnings = warnings;
        let [l, m, n] = lattice.size();
        let [a, b, c] = lattice.degree();
        let (min, max) = (show(region.min), show(region.max));
        built.note(format!("grid: {l} by {m} by {n} control points of degree {a}x{b}x{c} over {min} to {max}"));
        let outside = if self.extended { "the map continues" } else { "nothing moves" };
        built.note(format!("outside the region: {outside}"));
        built.guides = control_net(&lattice);
        Ok((built, lattice))
    }

    fn is_frozen(&self, node: [usize; 3]) -> bool {
        let size = self.lattice.size();
        (0..3).any(|a| node[a] < self.frozen[2 * a] || node[a] + self.frozen[2 * a + 1] >= size[a])
    }

    fn apply_changes(&self, lattice: &mut Lattice3) -> Result<(), Error> {
        for &(node, change) in &self.changes {
            let wrong = |problem: String| Error::usage(change.param(), names(&[node]), problem);
            if !lattice.has(node) {
                let [l, m, n] = lattice.size().map(|n| n - 1);
                let range = format!("i goes from 0 to {l}, j from 0 to {m}, k from 0 to {n}");
                return Err(wrong(format!("is not a control point: {range}")));
            }
            if self.is_frozen(node) {
                return Err(wrong("is a control point that `freeze` keeps in place".into()));
            }
            match change {
                Change3::Place(p) => lattice.place(node, p),
                Change3::Shift(v) => lattice.shift(node, v),
                Change3::Weight(w) => lattice.set_weight(node, w),
            }
        }
        Ok(())
    }

    fn apply_pins(&self, lattice: &mut Lattice3, warnings: &mut Vec<String>) -> Result<(), Error> {
        let shown = |(p, q): &(DVec3, DVec3)| format!("{}:{}", show(*p), show(*q));
        if let Some(extra) = self.pins.get(MAX_PINS) {
            return Err(Error::usage(
                "pin",
                shown(extra),
                format!("is one pin too many; at most {MAX_PINS} are possible"),
            ));
        }
        let region = lattice.region();
        // For each pin, the influences of the control points that may move, and the displacement that they have to add up to.
        let (mut rows, mut wanted) = (Vec::new(), Vec::new());
        for pin in &self.pins {
            let (from, to) = *pin;
            if !self.extended && !region.contains(from) {
                return Err(Error::usage("pin", shown(pin), "takes hold outside the region, where nothing moves"));
            }
            let mut row = vec![0.0; lattice.nodes().count()];
            let mut image = DVec3::ZERO;
            for (node, r) in lattice.influence(from) {
                image += lattice.point(node) * r;
                if !self.is_frozen(node) {
                    row[lattice.index(node)] = r;
                }
            }
            rows.push(row);
            wanted.push((to - image).to_array());
        }
        let change = smallest_change(&rows, &wanted);
        for (node, v) in lattice.nodes().zip(&change).filter(|(_, v)| **v != [0.0; 3]) {
            lattice.shift(node, DVec3::from_array(*v));
        }
        for (pin, miss) in self.pins.iter().zip(misses(&rows, &wanted, &change)) {
            if miss > 1e-9 * region.diagonal() {
                let reason = "the grid has too few control points that may move; raise `degree` or freeze fewer";
                warnings.push(format!("the pin {} is missed by {miss:.6}: {reason}", shown(pin)));
            }
        }
        Ok(())
    }
}

fn names(nodes: &[[usize; 3]]) -> String {
    /// Limit on the control points listed in a message.
    const MAX_NAMES: usize = 8;
    let mut out = nodes.iter().take(MAX_NAMES).map(|[i, j, k]| format!("{i},{j},{k}")).collect::<Vec<_>>().join(" ");
    if nodes.len() > MAX_NAMES {
        out += &format!(" and {} more", nodes.len() - MAX_NAMES);
    }
    out
}

/// Returns the lines of control points along all three axes as polylines.
fn control_net(lattice: &Lattice3) -> Vec<Vec<DVec3>> {
    let line = |mut node: [usize; 3], axis: usize| {
        let points = (0..lattice.size()[axis]).map(|i| {
            node[axis] = i;
            lattice.point(node)
        });
        points.collect()
    };
    let lines_along = |axis: usize| lattice.nodes().filter(move |n| n[axis] == 0).map(move |n| line(n, axis));
    (0..3).flat_map(lines_along).collect()
}

/// A lattice in space as JSON.
///
/// ```json
/// {
///   "degree": [1, 1, 1],
///   "cells": [1, 1, 1],
///   "region": [0, 0, 0, 10, 10, 10],
///   "points": [
///     [[[0, 0, 0], [10, 0, 0]], [[0, 10, 0], [10, 10, 0]]],
///     [[[0, 0, 10], [10, 0, 10]], [[0, 10, 10], [12, 10, 10, 2]]]
///   ]
/// }
/// ```
///
/// `points` holds layers from the back, each of rows from the bottom, each of points from left to right: x, y, z and, unless it is 1,
/// the weight. A row has degree + cells points. `region` is x, y, z, width, height and depth of the box; it defaults to the model's box.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LatticeFile {
    degree: [usize; 3],
    #[serde(default = "one")]
    cells: [usize; 3],
    region: Option<[f64; 6]>,
    points: Vec<Vec<Vec<Vec<f64>>>>,
}

fn one() -> [usize; 3] {
    [1; 3]
}

/// Reads a lattice. The flag is `true` if the file specifies its region; otherwise the region is `frame`.
pub(super) fn read(name: &str, text: &str, frame: Box3) -> Result<(Lattice3, bool), Error> {
    let file: LatticeFile = serde_json::from_str(text).map_err(|e| {
        Error::input(format!("{name}:{}:{}", e.line(), e.column()), format!("is not a lattice in space: {e}"))
    })?;
    let wrong = |what: String| Error::input(name, what);
    for (what, numbers, max) in [("degrees", file.degree, MAX_DEGREE), ("cells", file.cells, MAX_CELLS)] {
        if numbers.iter().any(|n| !(1..=max).contains(n)) {
            return Err(wrong(format!("its {what} are {numbers:?}; each must be 1 to {max}")));
        }
    }
    let region = match file.region {
        None => frame,
        Some(r @ [x, y, z, w, h, d]) if r.iter().all(|v| v.abs() < 1e100) && w > 0.0 && h > 0.0 && d > 0.0 => {
            let min = DVec3::new(x, y, z);
            Box3 { min, max: min + DVec3::new(w, h, d) }
        }
        Some(r) => return Err(wrong(format!("its region {r:?} is not a box x, y, z, width, height, depth"))),
    };
    let mut lattice = Lattice3::regular(region, file.degree, file.cells);
    let [nx, ny, nz] = lattice.size();
    let fits = file.points.len() == nz && file.points.iter().all(|l| l.len() == ny && l.iter().all(|r| r.len() == nx));
    if !fits {
        let problem = format!("its points are not {nz} layers of {ny} rows of {nx}, as its degree and cells ask for");
        return Err(wrong(problem));
    }
    for node in lattice.nodes() {
        let [i, j, k] = node;
        let (p, w) = match file.points[k][j][i][..] {
            [x, y, z] => (DVec3::new(x, y, z), 1.0),
            [x, y, z, w] => (DVec3::new(x, y, z), w),
            _ => return Err(wrong(format!("point {i},{j},{k} is neither x, y, z nor x, y, z, weight"))),
        };
        if !(p.abs().max_element() < 1e100 && w.abs() < 1e100) {
            return Err(wrong(format!("point {i},{j},{k} has a number larger than 1e100")));
        }
        lattice.place(node, p);
        lattice.set_weight(node, w);
    }
    Ok((lattice, file.region.is_some()))
}

/// Writes a lattice as JSON; adding 0 turns −0 into 0.
fn write(lattice: &Lattice3) -> String {
    let numbers = |v: &[f64]| format!("[{}]", v.iter().map(|v| format!("{}", v + 0.0)).collect::<Vec<_>>().join(", "));
    let [nx, ny, nz] = lattice.size();
    let point = |i: usize, j: usize, k: usize| {
        let (p, w) = (lattice.point([i, j, k]), lattice.weight([i, j, k]));
        if w == 1.0 { numbers(&p.to_array()) } else { numbers(&p.extend(w).to_array()) }
    };
    let row = |j: usize, k: usize| format!("[{}]", (0..nx).map(|i| point(i, j, k)).collect::<Vec<_>>().join(", "));
    let layer = |k: usize| format!("    [{}]", (0..ny).map(|j| row(j, k)).collect::<Vec<_>>().join(",\n     "));
    let (r, layers) = (lattice.region(), (0..nz).map(layer).collect::<Vec<_>>().join(",\n"));
    let region: Vec<f64> = r.min.to_array().into_iter().chain(r.size().to_array()).collect();
    let [d, c] = [lattice.degree(), lattice.cells()];
    format!(
        "{{\n  \"degree\": {d:?},\n  \"cells\": {c:?},\n  \"region\": {},\n  \"points\": [\n{layers}\n  ]\n}}\n",
        numbers(&region)
    )
}

/// A lattice of any shape.
pub(super) const HULL: Param = Param::new(
    "hull",
    Kind::File,
    "Use a saved lattice (JSON) of any shape, such as a ring around an axis, as the \
one that is still at rest: points within it get its coordinates, nothing moves outside, and I,J,K are its control points.",
);

static ABOUT: About3 = About3 {
    info: Info::new("ffd", "pull a model about by a box of control points")
        .group("Lattices")
        .about("A box of control points lies around the model. Move some of them, and the model near them follows smoothly. Points \
are named i,j,k: from the left, from the bottom, from the back, each from 0. A box of degree 3x2x2 has 4 by 3 by 3 of them; \
higher degrees bend more finely.\n\nOr move points of the model themselves (--pin), and the box follows with the smallest \
change.\n\nWith an explicit region (--region) nothing moves outside it. To keep the model from tearing at a face of the region, \
freeze the outermost layer of points there (--freeze left:1); two keep it smooth, three keep its curvature.")
        .source("T. W. Sederberg, S. R. Parry, Free-form deformation of solid geometric models, SIGGRAPH 1986; P. Kalra et al., \
Simulation of facial muscle actions based on rational free form deformations, 1992; for --pin: W. M. Hsu, J. F. Hughes, \
H. Kaufman, Direct manipulation of free-form deformations, SIGGRAPH 1992; for --hull: S. Coquillart, Extended free-form deformation, \
SIGGRAPH 1990")
        .params(&[
            Param::new("degree", Kind::Text("LxMxN"), "Degrees along x, y and z, 1 to 10 each: one less than the control points \
there. One number stands for all three.")
            .default("2x2x2"),
            Param::new("region", Kind::Text("model|X,Y,Z,W,H,D"), "The box of the control points; outside it nothing moves. The \
model's box has no outside: the map continues there.")
            .default("model"),
            Param::new("move", Kind::Text("I,J,K:DX,DY,DZ"), "Move control point i,j,k by dx,dy,dz (lengths, or % of the model's box).")
                .repeated(),
            Param::new("at", Kind::Text("I,J,K:X,Y,Z"), "Put control point i,j,k at x,y,z.").repeated(),
            Param::new("weight", Kind::Text("I,J,K:W"), "Give control point i,j,k this weight: above 1 it pulls harder than the others.")
                .repeated(),
            Param::new("pin", Kind::Text("X,Y,Z:X,Y,Z"), "Take the first point of the model to the second; the control points that \
are not frozen follow with the smallest change. Equal points hold a place.")
            .repeated(),
            Param::new("freeze", Kind::Text("FACE:COUNT,…"), "Keep layers of points along faces in their places, e.g. \
left:2,bottom:1: 1 for no tear at the region's face there, 2 for smooth, k+1 for k continuous derivatives. The faces are left, \
right, bottom, top, back, front."),
            Param::flag("extend", "Let the map continue outside the region instead of leaving everything there in place."),
            Param::flag("spline", "A B-spline box: each control point has influence on a few cells only."),
            Param::new("cells", Kind::Text("LxMxN"), "Cells of the B-spline box along x, y and z, 1 to 16 each: it has degree + \
cells control points. Default with --spline: 4x4x4."),
            Param::new("lattice", Kind::File, "Start from a saved box of points (JSON) instead of --degree and a regular one; with \
--region it is laid onto that."),
            HULL,
            Param::new("save-lattice", Kind::Save, "Save the box with everything that was moved, to use it again."),
        ])
        .demo(&[("degree", "2x2x1"), ("move", "1,2,0:0,40,0"), ("move", "2,1,1:15,0,20"), ("weight", "1,1,1:2")])
        .examples(&[
            Example {
                what: "Pull the middle of a model upwards",
                command: "solid ffd samples/solid/teapot.obj --move 1,2,1:0,60%,0 -o out.obj",
            },
            Example {
                what: "Stretch only the right part, smoothly joined to the rest",
                command: "solid ffd samples/solid/teapot.obj --region 60%,-10%,-10%,60%,120%,120% --degree 4x2x2 --freeze left:2 \
--move 3,1,1:30%,20%,0 -o out.obj",
            },
            Example {
                what: "Give a pot a waist, by a ring of control points around it",
                command: "solid ffd samples/solid/teapot.obj --hull samples/solid/ring.json --move 0,2,2:0,0,40 --move 1,2,2:-160,0,40 \
--move 2,2,2:-80,0,-120 --move 3,2,2:80,0,-120 --move 4,2,2:160,0,40 --move 5,2,2:0,0,40 -o out.obj",
            },
            Example {
                what: "Take one place of a model elsewhere and hold another, with a finer box that is saved for use again",
                command: "solid ffd samples/solid/teapot.obj --spline --cells 3 --pin 95%,60%,50%:110%,90%,50% --pin 50%,0%,50%:50%,0%,50% \
--save-lattice out.json -o out.obj",
            },
        ]),
    laws: &[
        Law3::Identity(&[]),
        Law3::Identity(&[("degree", "10x1x3"), ("region", "10,20,30,40,50,60")]),
        Law3::Identity(&[("degree", "3x2x1"), ("spline", "true"), ("extend", "true")]),
        Law3::Identity(&[("pin", "30,30,30:30,30,30")]),
        Law3::Same(&[("move", "1,2,0:0,0,0"), ("weight", "0,0,0:2")], &[("weight", "0,0,0:2")]),
        Law3::Same(&[("at", "1,1,1:50,40,55")], &[("move", "1,1,1:0,-10,5")]),
        Law3::KeepsLinesAlong(&[("degree", "4x1x2"), ("move", "1,0,0:5,20,3 3,1,2:9,-20,8"), ("weight", "2,0,1:3")], [0.0, 1.0, 0.0]),
        Law3::KeepsPlanes(&[("degree", "1"), ("move", "0,1,0:10,0,0 1,1,0:10,0,0 0,1,1:10,0,0 1,1,1:10,0,0")]),
        Law3::FixedOutside(&[("region", "20,30,40,50,40,30"), ("move", "1,1,1:10,5,5 2,2,2:-5,5,9")], [[20.0, 30.0, 40.0], [70.0, 70.0, 70.0]]),
        Law3::FixedOutside(
            &[("region", "20,30,40,50,40,30"), ("spline", "true"), ("cells", "3x2x1"), ("pin", "40,50,55:44,52,50"),
              ("freeze", "left:1,right:1,top:1,bottom:1,back:1,front:1")],
            [[20.0, 30.0, 40.0], [70.0, 70.0, 70.0]],
        ),
    ],
    cases: &[
        // In the middle of the frame, a cube of 100, the middle point of degree 2 counts an eighth.
        Case3 { args: &[("move", "1,1,1:8,-16,24")], at: [50.0, 50.0, 50.0], to: [51.0, 48.0, 53.0], tolerance: 1e-13 },
        // With weight 8 it counts 8/15 instead of 1/8.
        Case3 { args: &[("move", "1,1,1:15,0,0"), ("weight", "1,1,1:8")], at: [50.0, 50.0, 50.0], to: [58.0, 50.0, 50.0], tolerance: 1e-13 },
        Case3 { args: &[("pin", "30,40,20:37,35,25")], at: [30.0, 40.0, 20.0], to: [37.0, 35.0, 25.0], tolerance: 1e-12 },
    ],
};

/// Reads the deformation from text. Without a region as a box or in a file, the map continues beyond the model's box.
pub(in crate::deform) const ENTRY: Entry = Entry(&ABOUT, |s| {
    let hull = hull(s, &["degree", "region", "lattice", "spline", "cells", "pin", "freeze", "extend"])?;
    let (lattice, from_file) = hull.clone().map_or_else(|| lattice(s), |hull| Ok((hull, true)))?;
    let extended = s.flat().flag("extend")? || (s.box_if("region")?.is_none() && !from_file);
    let mut ffd = Ffd3::new(lattice).freeze(frozen_layers(s)?).extend(extended);
    for (node, change) in changes(s)? {
        ffd = ffd.change(node, change);
    }
    for (from, to) in s.point_pairs("pin")? {
        ffd = ffd.pin(from, to);
    }
    let (mut built, lattice) = ffd.build_with_lattice()?;
    if let Some(hull) = hull {
        // The control net of a curved hull is far from the hull itself.
        built.guides.clear();
        built.map = Arc::new(HullMap::new(&hull, &lattice)?);
    }
    if let Some(name) = s.last("save-lattice") {
        built.saves.push(SavedFile { name: name.to_owned(), text: write(&lattice) });
    }
    Ok(built)
});

/// Reads the lattice that `hull` names, if any. It is an error if one of the parameters `others` is given too.
pub(super) fn hull(s: &Settings3<'_>, others: &[&str]) -> Result<Option<Lattice3>, Error> {
    let Some(named) = s.file_if("hull")? else { return Ok(None) };
    refuse(s, "hull", others)?;
    Ok(Some(read(&named.name, &named.text, s.bounds())?.0))
}

/// Refuses the parameters `others` beside a file with a whole lattice.
fn refuse(s: &Settings3<'_>, file: &str, others: &[&str]) -> Result<(), Error> {
    let Some(name) = others.iter().find(|n| s.flat().given(n)) else { return Ok(()) };
    let problem = format!("cannot go with `{file}`, which is a whole box of points");
    Err(Error::usage(name, s.words(name).join(" "), problem))
}

/// Reads the initial lattice. The flag is `true` if a file specifies its region.
fn lattice(s: &Settings3<'_>) -> Result<(Lattice3, bool), Error> {
    let region = s.box_if("region")?;
    let frame = s.bounds();
    if let Some(named) = s.file_if("lattice")? {
        refuse(s, "lattice", &["degree", "spline", "cells"])?;
        let (lattice, has_region) = read(&named.name, &named.text, region.unwrap_or(frame))?;
        return Ok(match region {
            Some(r) => (lattice.on(r), true),
            None if s.flat().given("region") => (lattice.on(frame), false), // `--region model`
            None => (lattice, has_region),
        });
    }
    let degree = s.counts_if("degree", MAX_DEGREE)?.unwrap_or([2; 3]);
    let cells = match s.counts_if("cells", MAX_CELLS)? {
        Some(c) => c,
        None if s.flat().flag("spline")? => [4; 3],
        None => [1; 3],
    };
    Ok((Lattice3::regular(region.unwrap_or(frame), degree, cells), false))
}

/// Reads `at`, `move` and `weight`, in this order.
fn changes(s: &Settings3<'_>) -> Result<Vec<([usize; 3], Change3)>, Error> {
    let mut out = Vec::new();
    for name in ["at", "move", "weight"] {
        for word in s.words(name) {
            let (node, value) = s.flat().node_in::<3>(name, word)?;
            let change = match name {
                "at" => Change3::Place(s.point_in(name, value)?),
                "move" => Change3::Shift(s.vector_in(name, value)?),
                _ => Change3::Weight(s.flat().number_in(name, value)?),
            };
            out.push((node, change));
        }
    }
    Ok(out)
}

fn frozen_layers(s: &Settings3<'_>) -> Result<[usize; 6], Error> {
    let mut counts = [0; 6];
    for word in s.words("freeze").into_iter().flat_map(|t| t.split(',')).filter(|w| !w.is_empty()) {
        let (face, count) = word.split_once(':').unwrap_or((word, "1"));
        let face = FACES.iter().position(|n| *n == face).ok_or_else(|| {
            let problem = format!("is not FACE:COUNT with a face {}, such as left:2", FACES.join(", "));
            Error::usage("freeze", word, problem)
        })?;
        counts[face] = count
            .parse()
            .map_err(|_| Error::usage("freeze", word, "does not end with a whole number, such as left:2"))?;
    }
    Ok(counts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        let frame = Box3::new(DVec3::ZERO, DVec3::ONE);
        let mut lattice =
            Lattice3::regular(Box3::new(DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 6.0, 8.0)), [2, 1, 3], [2, 1, 1]);
        lattice.shift([1, 0, 2], DVec3::new(0.125, -0.5, 3.0));
        lattice.set_weight([3, 1, 0], 2.5);
        let (back, named) = read("a.json", &write(&lattice), frame).unwrap();
        assert!(named && back.nodes().all(|n| (back.point(n) - lattice.point(n)).length() < 1e-14 && back.weight(n) == lattice.weight(n)));
        assert_eq!((back.region(), back.degree(), back.cells()), (lattice.region(), lattice.degree(), lattice.cells()));
    }

    #[test]
    fn faults_are_named() {
        let frame = Box3::new(DVec3::ZERO, DVec3::ONE);
        for (text, part) in [
            ("{", "a.json:1:1"),
            (r#"{"degree":[0,1,1],"points":[]}"#, "degrees"),
            (r#"{"degree":[1,1,1],"points":[]}"#, "2 layers of 2 rows of 2"),
            (r#"{"degree":[1,1,1],"region":[0,0,0,1,0,1],"points":[]}"#, "not a box"),
        ] {
            let e = read("a.json", text, frame).unwrap_err().to_string();
            assert!(e.contains(part), "{text}: {e}");
        }
    }
}
