//! Meshes: artwork bent by a quilt of bicubic patches, also by the warps that Photoshop keeps with its layers.
//!
//! Each patch is the tensor product Bézier surface of sixteen points (see [`BicubicNet`](crate::map::BicubicNet)); patches share the points of the
//! sides where they meet. Along such a joint the map is C¹ if the control points beside it divide evenly: (p₊ − p)/after =
//! (p − p₋)/before in every row (G. Farin, *Curves and Surfaces for CAGD*, §15.4).

mod entry;
#[cfg(feature = "serde")]
mod file;
#[cfg(feature = "serde")]
mod psd;
mod quilt;
#[cfg(test)]
mod tests;

pub(super) use entry::Entry;

use super::built::{Built, Role};
use crate::error::{Error, GeometryError};
use crate::map::{AffineMap, Class, Map};
use crate::param::Frame;
use kurbo::{Point, Rect, Shape};
use quilt::Quilt;
use std::sync::Arc;

/// A mesh: a quilt of bicubic Bézier patches in rows and columns, which share the points of their common sides.
///
/// ```
/// use pathwarp::{deform::Mesh, kurbo::{Point, Rect}, map::Map};
///
/// // One patch; its bottom right corner is pulled down.
/// let mut rows: Vec<Vec<Point>> =
///     (0..4).map(|j| (0..4).map(|i| Point::new(30.0 * f64::from(i), 30.0 * f64::from(j))).collect()).collect();
/// rows[3][3].y += 20.0;
/// let mesh = Mesh::new(Rect::new(0.0, 0.0, 90.0, 90.0), rows).build()?;
/// assert!(mesh.map.point(Point::new(90.0, 90.0)).distance(Point::new(90.0, 110.0)) < 1e-12);
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    source: Source,
    smooth: bool,
    frame: Option<Rect>,
}

/// The control points, checked or not.
#[derive(Debug, Clone, PartialEq)]
enum Source {
    Points { region: Rect, rows: Vec<Vec<Point>>, cuts: [Option<Vec<f64>>; 2] },
    Quilt(Quilt),
}

/// Least jump of the slope at a joint that is worth a warning, as a share of it.
const VISIBLE_KINK: f64 = 0.005;

/// Distance by which artwork may extend past the mesh's box, in shares of it, without a warning.
const BEYOND: f64 = 0.5;

impl Mesh {
    /// Lays a mesh onto the box `region`: rows of control points from the top, each from left to right, 3·columns + 1 points in
    /// each of 3·rows + 1 rows for up to 64 columns and rows of patches.
    #[must_use]
    pub fn new(region: Rect, rows: Vec<Vec<Point>>) -> Self {
        Self { source: Source::Points { region, rows, cuts: [None, None] }, smooth: false, frame: None }
    }

    /// Sets the positions where patches meet, as shares of the box across and down, rising between 0 and 1. Default: even.
    #[must_use]
    pub fn cuts(mut self, x: Vec<f64>, y: Vec<f64>) -> Self {
        if let Source::Points { cuts, .. } = &mut self.source {
            *cuts = [Some(x), Some(y)];
        }
        self
    }

    /// Makes the joints smooth; the points beside them move.
    #[must_use]
    pub fn smooth(self, smooth: bool) -> Self {
        Self { smooth, ..self }
    }

    /// Sets the artwork's box, if it differs from the mesh's: artwork far outside the mesh gives a warning.
    #[must_use]
    pub fn frame(self, frame: Rect) -> Self {
        Self { frame: Some(frame), ..self }
    }

    /// Builds the map. Kinks at the joints give a warning.
    ///
    /// # Errors
    /// [`Error::Geometry`] for a flat box, [`Error::Input`] for rows of illegal or different length.
    pub fn build(&self) -> Result<Built, Error> {
        let mut quilt = match &self.source {
            Source::Quilt(quilt) => quilt.clone(),
            Source::Points { region, rows, cuts: [x, y] } => {
                Quilt::new("mesh", with_area(*region)?, rows.clone(), x.clone(), y.clone())?
            }
        };
        if self.smooth {
            quilt.smooth();
        }
        let [columns, rows] = quilt.size();
        let (kinks, most) = quilt.kinks();
        let r = quilt.region;
        let frame = self.frame.unwrap_or(r);
        let map = quilt.map().ok_or(GeometryError::FlatFrame { width: r.width(), height: r.height() })?;
        let map: Arc<dyn Map> = match map.class() {
            Class::Affine(m) => Arc::new(AffineMap(crate::anchors::settled(m, &Frame::new(frame)))),
            _ => map,
        };
        let mut built = Built::new(map);
        let joints = if most < VISIBLE_KINK { "smooth" } else { "kinked" };
        built.note(format!("mesh: {columns} by {rows} patches; joints: {joints}"));
        let beyond = r.inflate(BEYOND * r.width(), BEYOND * r.height());
        if !matches!(built.map.class(), Class::Affine(_)) && frame.union(beyond) != beyond {
            built.warn(format!(
                "mesh: the artwork extends far past its box {} {} to {} {}, where a mesh has little control: `region artwork` \
lays it onto the artwork",
                r.x0, r.y0, r.x1, r.y1
            ));
        }
        if most >= VISIBLE_KINK {
            built.warn(format!(
                "mesh: {kinks} pairs of control points beside joints make kinks (by up to {:.0} % of the slope); `smooth` evens them out",
                100.0 * most
            ));
        }
        built.overlay(Role::Base, r.to_path(0.1));
        built.overlay(Role::Cage, quilt.curves());
        Ok(built)
    }
}

/// Refuses a box without area.
fn with_area(r: Rect) -> Result<Rect, Error> {
    if r.width() > 0.0 && r.height() > 0.0 {
        return Ok(r);
    }
    Err(GeometryError::FlatFrame { width: r.width(), height: r.height() }.into())
}
