//! Free-form deformation of space by a box of control points.
//!
//! See [`Lattice3`] for the formula. Pins are solved for as in W. M. Hsu, J. F. Hughes, H. Kaufman, *Direct manipulation of
//! free-form deformations*, SIGGRAPH 1992.

mod entry;
mod file;

pub(super) use entry::Entry;

use super::built::Built3;
use crate::box3::Box3;
use crate::lattice::{Lattice3, LatticeMap3};
use crate::settings::show;
use glam::DVec3;
use pathwarp::Error;
use pathwarp::solve::{misses, smallest_change};
use std::sync::Arc;

/// The highest degree of a lattice along an axis.
const MAX_DEGREE: usize = 10;
/// The largest number of Bézier pieces along an axis.
const MAX_CELLS: usize = 16;
/// Limit on pins: the work grows with the cube of their number.
const MAX_PINS: usize = 256;

/// Faces of a box, in the order of [`Ffd3::freeze`]: x, y, z, the lower one first.
const FACES: [&str; 6] = ["left", "right", "bottom", "top", "back", "front"];

/// A change of one control point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Change3 {
    /// Put it here.
    Place(DVec3),
    /// Move it by so much.
    Shift(DVec3),
    /// Set its weight: above 1 it pulls harder than the others.
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
    /// Starts from a lattice. Outside its box nothing moves, unless it is [extended](Self::extend).
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

    /// Takes a point of the model to another; the control points that are not frozen follow with the smallest change. Pins are
    /// solved for together, after all other changes. At most 256.
    #[must_use]
    pub fn pin(mut self, from: DVec3, to: DVec3) -> Self {
        self.pins.push((from, to));
        self
    }

    /// Keeps so many layers of control points in place along the left, right, bottom, top, back and front face: 1 avoids a tear
    /// at the face, k + 1 keeps k derivatives continuous.
    #[must_use]
    pub fn freeze(self, layers: [usize; 6]) -> Self {
        Self { frozen: layers, ..self }
    }

    /// Lets the map continue outside the box.
    #[must_use]
    pub fn extend(self, extended: bool) -> Self {
        Self { extended, ..self }
    }

    /// Builds the map. Pins that are missed give warnings.
    ///
    /// # Errors
    /// [`Error::Usage`] for a box without volume, control points that do not exist, changes of frozen points, too many pins, and
    /// pins outside the box of a map that is not extended.
    pub fn build(&self) -> Result<Built3, Error> {
        Ok(self.build_with_lattice()?.0)
    }

    /// Builds the map, and returns the changed lattice with it.
    ///
    /// # Errors
    /// As [`Ffd3::build`].
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
        let held: Vec<_> = lattice.nodes().filter(|n| self.holds(*n) && lattice.is_changed(*n)).collect();
        if !held.is_empty() {
            warnings.push(format!("frozen control points are put back in place: {}", names(&held)));
            for node in held {
                lattice.place(node, lattice.regular_point(node));
                lattice.set_weight(node, 1.0);
            }
        }
        self.apply_changes(&mut lattice)?;
        self.pull(&mut lattice, &mut warnings)?;
        let mut built = Built3::new(Arc::new(LatticeMap3::new(&lattice, self.extended)));
        built.warnings = warnings;
        let [l, m, n] = lattice.size();
        let [a, b, c] = lattice.degree();
        let Box3 { min, max } = region;
        built.note(format!(
            "grid: {l} by {m} by {n} control points of degree {a}x{b}x{c} over {} to {}",
            show(min),
            show(max)
        ));
        built
            .note(format!("outside the region: {}", if self.extended { "the map continues" } else { "nothing moves" }));
        built.guides = net(&lattice);
        Ok((built, lattice))
    }

    /// Returns `true` for a frozen control point.
    fn holds(&self, node: [usize; 3]) -> bool {
        let size = self.lattice.size();
        (0..3).any(|a| node[a] < self.frozen[2 * a] || node[a] + self.frozen[2 * a + 1] >= size[a])
    }

    fn apply_changes(&self, lattice: &mut Lattice3) -> Result<(), Error> {
        for &(node, change) in &self.changes {
            let wrong = |problem: String| Error::usage(change.param(), names(&[node]), problem);
            if !lattice.has(node) {
                let [l, m, n] = lattice.size().map(|n| n - 1);
                return Err(wrong(format!(
                    "is not a control point: i goes from 0 to {l}, j from 0 to {m}, k from 0 to {n}"
                )));
            }
            if self.holds(node) {
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

    fn pull(&self, lattice: &mut Lattice3, warnings: &mut Vec<String>) -> Result<(), Error> {
        let shown = |(p, q): &(DVec3, DVec3)| format!("{}:{}", show(*p), show(*q));
        if let Some(extra) = self.pins.get(MAX_PINS) {
            return Err(Error::usage("pin", shown(extra), format!("is one too many: {MAX_PINS} pins at most")));
        }
        let region = lattice.region();
        let (mut rows, mut want) = (Vec::new(), Vec::new());
        for pin in &self.pins {
            let (from, to) = *pin;
            if !self.extended && !region.contains(from) {
                return Err(Error::usage("pin", shown(pin), "takes hold outside the region, where nothing moves"));
            }
            let mut row = vec![0.0; lattice.nodes().count()];
            let mut image = DVec3::ZERO;
            for (node, r) in lattice.influence(from) {
                image += lattice.point(node) * r;
                if !self.holds(node) {
                    row[lattice.index(node)] = r;
                }
            }
            rows.push(row);
            want.push((to - image).to_array());
        }
        let change = smallest_change(&rows, &want);
        for (node, v) in lattice.nodes().zip(&change).filter(|(_, v)| **v != [0.0; 3]) {
            lattice.shift(node, DVec3::from_array(*v));
        }
        for (pin, off) in self.pins.iter().zip(misses(&rows, &want, &change)) {
            if off > 1e-9 * region.diagonal() {
                warnings.push(format!(
                    "the pin {} is missed by {off:.6}: the grid has too few control points that may move; raise `degree` or freeze fewer",
                    shown(pin)
                ));
            }
        }
        Ok(())
    }
}

fn names(nodes: &[[usize; 3]]) -> String {
    /// A longer list would not be read.
    const SHOWN: usize = 8;
    let mut out = nodes.iter().take(SHOWN).map(|[i, j, k]| format!("{i},{j},{k}")).collect::<Vec<_>>().join(" ");
    if nodes.len() > SHOWN {
        out += &format!(" and {} more", nodes.len() - SHOWN);
    }
    out
}

/// Rows, columns and files of control points as polylines.
fn net(lattice: &Lattice3) -> Vec<Vec<DVec3>> {
    let size = lattice.size();
    let mut out = Vec::new();
    for axis in 0..3 {
        for start in lattice.nodes().filter(|n| n[axis] == 0) {
            let mut along = start;
            let line = (0..size[axis]).map(|i| {
                along[axis] = i;
                lattice.point(along)
            });
            out.push(line.collect());
        }
    }
    out
}
