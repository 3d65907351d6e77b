//! Free-form deformation by a grid of control points.
//!
//! With s, t running from 0 to 1 across the region, X(s,t) = Σ Bᵐᵢ(s) Bⁿⱼ(t) wᵢⱼ·(xᵢⱼ, yᵢⱼ, 1) (T. W. Sederberg, S. R. Parry,
//! *Free-form deformation of solid geometric models*, SIGGRAPH 1986; T. W. Sederberg, *Computer Aided Geometric Design*,
//! chapter 14, equations 14.1-14.3): see [`Lattice`]. Control points are counted from the left (i) and from the top (j),
//! from 0. Pins are solved for as in W. M. Hsu, J. F. Hughes, H. Kaufman, *Direct manipulation of free-form deformations*,
//! SIGGRAPH 1992: see [`pins`].
//!
//! A region that is the artwork's own box has no outside: the pieces continue there, so that strokes and everything else that
//! extends past the outlines' box follow smoothly. Any other region ends in a border, beyond which nothing moves, unless the
//! map is extended.

mod entry;
#[cfg(feature = "serde")]
mod file;
mod pins;
mod save;

pub(super) use entry::Entry;
pub(super) use save::{MAX_CELLS, MAX_DEGREE};

use super::built::{Built, Role};
use super::change::Change;
use crate::error::{Error, show, within};
use crate::map::{AffineMap, Class, Lattice, LatticeMap, Map};
use kurbo::{BezPath, Point, Rect, Vec2};
use pins::{MAX_PINS, pull};
use std::sync::Arc;

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
    /// Columns and rows kept in place: left, right, top, bottom.
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
        Self::with(Grid::Regular { region, degree: [3, 3], cells: [1, 1] })
    }

    /// Starts from a grid that may have been changed already.
    #[must_use]
    pub fn from_lattice(lattice: Lattice) -> Self {
        Self::with(Grid::Given(lattice))
    }

    fn with(grid: Grid) -> Self {
        Self { grid, changes: Vec::new(), pins: Vec::new(), frozen: [0; 4], extended: false }
    }

    /// Sets the degrees along x and y of a regular grid, 1 to 10 each: one less than the control points there.
    #[must_use]
    pub fn degree(mut self, x: usize, y: usize) -> Self {
        if let Grid::Regular { degree, .. } = &mut self.grid {
            *degree = [x, y];
        }
        self
    }

    /// Makes a regular grid a B-spline of so many cells along x and y, 1 to 64 each: it has degree + cells control points.
    #[must_use]
    pub fn cells(mut self, x: usize, y: usize) -> Self {
        if let Grid::Regular { cells, .. } = &mut self.grid {
            *cells = [x, y];
        }
        self
    }

    /// Puts control point (i, j) at a place.
    #[must_use]
    pub fn place(mut self, i: usize, j: usize, at: impl Into<Point>) -> Self {
        self.changes.push(([i, j], Change::Place(at.into())));
        self
    }

    /// Moves control point (i, j), user units.
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

    /// Takes a point of the artwork to another; the control points that are not frozen follow with the smallest change. Pins
    /// are solved for together, after all other changes. At most 256.
    #[must_use]
    pub fn pin(mut self, from: impl Into<Point>, to: impl Into<Point>) -> Self {
        self.pins.push((from.into(), to.into()));
        self
    }

    /// Keeps so many columns and rows along the left, right, top and bottom side in place: 1 avoids a tear at the region's
    /// border there, k + 1 keeps k derivatives continuous.
    #[must_use]
    pub fn freeze(self, left: usize, right: usize, top: usize, bottom: usize) -> Self {
        Self { frozen: [left, right, top, bottom], ..self }
    }

    /// Lets the map continue outside the region.
    #[must_use]
    pub fn extend(self, extended: bool) -> Self {
        Self { extended, ..self }
    }

    /// Builds the map. Borders that tear the artwork and pins that are missed give warnings.
    ///
    /// # Errors
    /// [`Error::Usage`] for a region without area, degrees or control points out of range, changes of frozen points, too many
    /// pins, and pins outside the region of a map that is not extended.
    pub fn build(&self) -> Result<Built, Error> {
        Ok(self.build_with_lattice()?.0)
    }

    /// Builds the map, and returns the changed grid with it.
    ///
    /// # Errors
    /// As [`Ffd::build`].
    pub fn build_with_lattice(&self) -> Result<(Built, Lattice), Error> {
        let mut lattice = self.start()?;
        let mut warnings = Vec::new();
        let size = [lattice.columns(), lattice.rows()];
        let held: Vec<_> =
            indices(&lattice).filter(|&(i, j)| self.holds(size, i, j) && lattice.is_changed(i, j)).collect();
        if !held.is_empty() {
            warnings.push(format!("frozen control points of the grid are put back in place: {}", names(&held)));
            for (i, j) in held {
                lattice.place(i, j, lattice.regular_point(i, j));
                lattice.set_weight(i, j, 1.0);
            }
        }
        self.change(&mut lattice)?;
        self.pull(&mut lattice, &mut warnings)?;
        if !self.extended {
            warnings.extend(tears(&lattice));
        }

        let map = LatticeMap::new(&lattice, self.extended);
        let map: Arc<dyn Map> = match map.class() {
            Class::Affine(m) => Arc::new(AffineMap(m)),
            _ => Arc::new(map),
        };
        let r = lattice.region();
        let mut built = Built::new(map);
        built.explanation.warnings = warnings;
        built.note(format!(
            "grid: {} by {} control points of degree {}x{} over {},{} to {},{}",
            lattice.columns(),
            lattice.rows(),
            lattice.degree()[0],
            lattice.degree()[1],
            r.x0,
            r.y0,
            r.x1,
            r.y1
        ));
        built
            .note(format!("outside the region: {}", if self.extended { "the map continues" } else { "nothing moves" }));
        built.overlay(Role::Base, net(&Lattice::regular(r, lattice.degree(), lattice.cells())));
        built.overlay(Role::Cage, net(&lattice));
        Ok((built, lattice))
    }

    /// Returns the grid before its changes.
    fn start(&self) -> Result<Lattice, Error> {
        let lattice = match &self.grid {
            Grid::Given(lattice) => lattice.clone(),
            Grid::Regular { region, degree, cells } => {
                for (name, pair, most) in [("degree", degree, MAX_DEGREE), ("cells", cells, MAX_CELLS)] {
                    for n in pair {
                        within(name, *n as f64, 1.0, most as f64)?;
                    }
                }
                Lattice::regular(*region, *degree, *cells)
            }
        };
        let r = lattice.region();
        if !(r.width() > 0.0 && r.height() > 0.0) {
            return Err(Error::usage("region", "artwork", "has no area: the artwork is flat; name a box x,y,w,h"));
        }
        let size = [lattice.columns(), lattice.rows()];
        if let Some(k) = (0..4).find(|k| self.frozen[*k] > size[k / 2]) {
            let problem = format!("freezes too many: 0 to {} there", size[k / 2]);
            return Err(Error::usage("freeze", format!("{}:{}", SIDES[k], self.frozen[k]), problem));
        }
        Ok(lattice)
    }

    /// Returns `true` for a frozen control point of a grid of this size.
    fn holds(&self, [columns, rows]: [usize; 2], i: usize, j: usize) -> bool {
        let [left, right, top, bottom] = self.frozen;
        i < left || i + right >= columns || j < top || j + bottom >= rows
    }

    fn change(&self, l: &mut Lattice) -> Result<(), Error> {
        for &([i, j], change) in &self.changes {
            let wrong = |problem: String| Error::usage(change.param(), format!("{i},{j}"), problem);
            if i >= l.columns() || j >= l.rows() {
                let (m, n) = (l.columns() - 1, l.rows() - 1);
                return Err(wrong(format!("is not a control point: i goes from 0 to {m}, j from 0 to {n}")));
            }
            if self.holds([l.columns(), l.rows()], i, j) {
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

    fn pull(&self, l: &mut Lattice, warnings: &mut Vec<String>) -> Result<(), Error> {
        let shown = |(p, q): &(Point, Point)| format!("{}:{}", show(*p), show(*q));
        if let Some(extra) = self.pins.get(MAX_PINS) {
            return Err(Error::usage("pin", shown(extra), format!("is one too many: {MAX_PINS} pins at most")));
        }
        let r = l.region();
        for pin in &self.pins {
            if !self.extended && !(r.x0..=r.x1).contains(&pin.0.x) | !(r.y0..=r.y1).contains(&pin.0.y) {
                return Err(Error::usage("pin", shown(pin), "takes hold outside the region, where nothing moves"));
            }
        }
        if self.pins.is_empty() {
            return Ok(());
        }
        let size = [l.columns(), l.rows()];
        let off = pull(l, |i, j| !self.holds(size, i, j), &self.pins);
        for (pin, off) in self.pins.iter().zip(off).filter(|(_, off)| *off > 1e-9 * (r.width() + r.height())) {
            warnings.push(format!(
                "the pin {} is missed by {off:.6}: the grid has too few control points that may move; raise `degree` or freeze fewer",
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

fn names(points: &[(usize, usize)]) -> String {
    /// A longer list would not be read.
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
    let on = |k: usize, i: usize, j: usize| [i == 0, i == m, j == 0, j == n][k];
    let side = |(k, name): (usize, &&str)| {
        let moved: Vec<_> = indices(l).filter(|&(i, j)| on(k, i, j) && l.is_changed(i, j)).collect();
        (!moved.is_empty()).then(|| {
            format!(
                "artwork that crosses the region's {name} border tears there, because control points {} on it were changed; keep them \
in place with `freeze {name}:1`, or let the map continue with `extend`",
                names(&moved)
            )
        })
    };
    SIDES.iter().enumerate().filter_map(side).collect()
}

/// Draws rows and columns of control points as polylines.
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
