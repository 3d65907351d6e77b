//! Bézier triangles: the artwork in a triangle follows a net of control points.
//!
//! F(u) = Σ wᵢⱼₖ Pᵢⱼₖ Bᵢⱼₖ(u) / Σ wᵢⱼₖ Bᵢⱼₖ(u), with Bᵢⱼₖ(u) = n!/(i!j!k!)·u₀ⁱu₁ʲu₂ᵏ and u the barycentric coordinates in
//! the reference triangle ABC (see [`net`]). Pᵢⱼₖ starts at (iA + jB + kC)/n. At degree 1 the
//! map is affine, with weights projective; at degree 2 six points are free and lines become conics' projections: parabolas, or
//! conics with weights. Outside a triangle that was asked for nothing moves; the restriction of the map to a side depends on that
//! side's points alone, so a side whose points stay put is joined without a gap. Outside the triangle about the artwork's box the map
//! continues: strokes reach past the box.
//!
//! G. Farin, *Triangular Bernstein–Bézier patches*, CAGD 3 (1986); J. Sánchez-Reyes, J. M. Chacón, *Anamorphic free-form
//! deformation*, CAGD 46 (2016), where the net is moved along rays (see `anamorph`).

mod entry;
pub(super) mod net;
#[cfg(test)]
mod tests;

pub(super) use entry::Entry;

use super::built::{Built, Role};
use super::change::Change;
use crate::error::{Error, GeometryError, within};
use kurbo::{BezPath, Point, Rect, Vec2};
use net::{TriangleNet, indices};

/// A Bézier triangle: the artwork in it follows a triangular net of control points.
///
/// F(u) = Σ wᵢⱼₖ Pᵢⱼₖ Bᵢⱼₖ(u) / Σ wᵢⱼₖ Bᵢⱼₖ(u), u being barycentric coordinates in the reference triangle. Control point
/// (i, j, k), i + j + k = n, starts at (iA + jB + kC)/n.
///
/// ```
/// use pathwarp::{deform::Triangle, kurbo::Point, map::Map};
///
/// let bent = Triangle::new([(0.0, 0.0), (100.0, 0.0), (0.0, 100.0)]).shift([1, 1, 0], (0.0, 30.0)).build()?;
/// assert!(bent.map.point(Point::new(25.0, 25.0)).distance(Point::new(25.0, 32.5)) < 1e-12);
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Triangle {
    corners: [Point; 3],
    degree: usize,
    changes: Vec<([usize; 3], Change)>,
    extended: bool,
    frame: Option<Rect>,
}

impl Triangle {
    /// Creates a net of degree 2 over a reference triangle. Outside it nothing moves, unless it is
    /// [extended](Self::extend).
    pub fn new(corners: [impl Into<Point>; 3]) -> Self {
        Self { corners: corners.map(Into::into), degree: 2, changes: Vec::new(), extended: false, frame: None }
    }

    /// Creates a net over a triangle about the artwork's box: its first corner at the top, its second at the bottom left. The map
    /// continues outside it.
    #[must_use]
    pub fn around(frame: Rect) -> Self {
        let half = frame.width() / 2.0;
        let corners = [
            Point::new(frame.center().x, frame.y0 - frame.height()),
            Point::new(frame.x0 - half, frame.y1),
            Point::new(frame.x1 + half, frame.y1),
        ];
        Self { frame: Some(frame), extended: true, ..Self::new(corners) }
    }

    /// Sets the degree n, 1 to 10.
    #[must_use]
    pub fn degree(self, degree: usize) -> Self {
        Self { degree, ..self }
    }

    /// Puts control point (i, j, k) at a place.
    #[must_use]
    pub fn place(mut self, node: [usize; 3], at: impl Into<Point>) -> Self {
        self.changes.push((node, Change::Place(at.into())));
        self
    }

    /// Moves control point (i, j, k), user units.
    #[must_use]
    pub fn shift(mut self, node: [usize; 3], by: impl Into<Vec2>) -> Self {
        self.changes.push((node, Change::Shift(by.into())));
        self
    }

    /// Sets the weight of control point (i, j, k), above 0 and up to a million.
    #[must_use]
    pub fn weight(mut self, node: [usize; 3], weight: f64) -> Self {
        self.changes.push((node, Change::Weight(weight)));
        self
    }

    /// Lets the map continue outside the triangle.
    #[must_use]
    pub fn extend(self, extended: bool) -> Self {
        Self { extended, ..self }
    }

    /// Builds the map. A side that tears the artwork gives a warning.
    ///
    /// # Errors
    /// [`GeometryError::Collinear`] for a flat triangle, [`Error::Usage`] for a degree, control point or weight out of range.
    pub fn build(&self) -> Result<Built, Error> {
        let Self { corners, extended, .. } = *self;
        within("degree", self.degree as f64, 1.0, 10.0)?;
        let mut net = TriangleNet::regular(corners, self.degree).ok_or_else(|| GeometryError::Collinear {
            path: "reference".into(),
            which: [1, 2, 3],
            points: corners.to_vec(),
        })?;
        for &(node, change) in &self.changes {
            self.change(&mut net, node, change)?;
        }
        let mut built = Built::new(net.map(extended));
        if !extended {
            let names = ["first and second", "second and third", "third and first"];
            let crosses = |k: usize| self.frame.is_none_or(|f| meets(f, corners[k], corners[(k + 1) % 3]));
            for k in (0..3).filter(|&k| !net.side_is_fixed(k) && crosses(k)) {
                built.warn(format!(
                    "the side between the {} corner meets the artwork's box and has control points moved: artwork that crosses it \
is torn apart; keep that side's points in place, choose a larger `reference`, or give `extend`",
                    names[k]
                ));
            }
        }
        built.overlay(Role::Base, outline(corners));
        built.overlay(Role::Cage, cage(&net));
        Ok(built)
    }

    fn change(&self, net: &mut TriangleNet, node: [usize; 3], change: Change) -> Result<(), Error> {
        let [i, j, k] = node;
        let wrong = |problem: String| Error::usage(change.param(), format!("{i},{j},{k}"), problem);
        if node.iter().try_fold(0usize, |sum, v| sum.checked_add(*v)) != Some(self.degree) {
            return Err(wrong(format!(
                "is not a control point: I, J and K must add up to {}, the degree",
                self.degree
            )));
        }
        match change {
            Change::Place(p) => net.place(node, p),
            Change::Shift(v) => net.shift(node, v),
            Change::Weight(w) if w > 0.0 && w <= 1e6 => net.set_weight(node, w),
            Change::Weight(_) => return Err(wrong("has a weight out of range: above 0, up to a million".into())),
        }
        Ok(())
    }
}

/// Draws the reference triangle.
fn outline(corners: [Point; 3]) -> BezPath {
    let mut path = BezPath::new();
    path.move_to(corners[0]);
    path.line_to(corners[1]);
    path.line_to(corners[2]);
    path.close_path();
    path
}

/// Returns `true` if the line between two points runs through a box or along its edge, past which strokes reach.
fn meets(r: Rect, a: Point, b: Point) -> bool {
    let room = 1e-9 * (r.width() + r.height());
    let r = r.inflate(room, room);
    // Clip the line's parameter range by the box's two slabs.
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for (p, d, lo, hi) in [(a.x, b.x - a.x, r.x0, r.x1), (a.y, b.y - a.y, r.y0, r.y1)] {
        if d == 0.0 {
            if p <= lo || p >= hi {
                return false;
            }
        } else {
            let (t0, t1) = ((lo - p) / d, (hi - p) / d);
            from = from.max(t0.min(t1));
            to = to.min(t0.max(t1));
        }
    }
    from < to
}

/// Draws the net's lines in three directions.
fn cage(net: &TriangleNet) -> BezPath {
    let mut path = BezPath::new();
    for [i, j, k] in indices(net.degree()).into_iter().filter(|ijk| ijk[0] > 0) {
        let (left, right) = (net.point([i - 1, j + 1, k]), net.point([i - 1, j, k + 1]));
        path.move_to(net.point([i, j, k]));
        path.line_to(left);
        path.line_to(right);
        path.close_path();
    }
    path
}
