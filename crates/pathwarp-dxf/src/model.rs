//! The outlines to write, and the options.

use pathwarp::Outline;
use pathwarp::budget::Limits;
use pathwarp::outline::Subpath;
use pathwarp::refit::suited;

/// An outline with its layer and colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape<'a> {
    /// Name of the layer. Characters that DXF forbids become underscores; names that differ only in case are one layer.
    pub layer: &'a str,
    /// Red, green and blue, or `None` for the colour of the layer, which is black or white to contrast with the background.
    pub color: Option<[u8; 3]>,
    /// The outline in millimetres, x to the right and y up.
    pub outline: &'a Outline,
}

/// The highest degree of a [`Spline`] that CAD programs read.
pub const MAX_DEGREE: usize = 9;

/// A B-spline curve in space, rational or not, of a degree up to [`MAX_DEGREE`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spline<'a> {
    /// Name of the layer. Characters that DXF forbids become underscores.
    pub layer: &'a str,
    /// Degree.
    pub degree: usize,
    /// Clamped knots: as many as points, the degree and 1 together.
    pub knots: &'a [f64],
    /// Control points in millimetres, x to the right and y up.
    pub points: &'a [[f64; 3]],
    /// A positive weight for each control point; empty if all weights are equal.
    pub weights: &'a [f64],
}

/// The form of Bézier curves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Curves {
    /// Exact splines of degree 3.
    #[default]
    Splines,
    /// Polylines, one for every subpath.
    Polylines,
}

/// Options for writing a DXF.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// The form of Bézier curves.
    pub curves: Curves,
    /// Largest distance of polylines from curves, in mm. Arcs within a tenth of it from circular ones are written as circular arcs.
    pub tolerance: f64,
    /// `true` to hold small contours to the tolerance that [suits](pathwarp::refit::suited) their size.
    pub suited: bool,
    /// Width and height of the page in mm.
    pub page: [f64; 2],
    /// Limits on the number of segments.
    pub limits: Limits,
}

impl Default for Options {
    /// Returns options for splines on an A4 page, with a tolerance of 0.01 mm.
    fn default() -> Self {
        let page = [210.0, 297.0];
        Self { curves: Curves::Splines, tolerance: 0.01, suited: false, page, limits: Limits::default() }
    }
}

impl Options {
    /// Returns the tolerance for a contour.
    pub(crate) fn tolerance_for(&self, contour: &Subpath) -> f64 {
        if self.suited { suited(self.tolerance, contour.diagonal()) } else { self.tolerance }
    }
}
