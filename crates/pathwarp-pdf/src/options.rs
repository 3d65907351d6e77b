//! Options for writing a PDF.

use kurbo::{BezPath, Point, Rect};
use pathwarp::budget::Limits;
use std::fmt;

/// Default resolution of pictures that replace filters, in pixels per inch: the usual one for print.
pub(crate) const PRINT: f64 = 300.0;

/// Returns the exact outline of a path in the coordinates of its data, if usvg approximates it.
pub type ExactOutline<'a> = dyn Fn(&usvg::Path) -> Option<BezPath> + 'a;

/// A Coons patch: the control points of its sides, which lead around it from corner to corner, and the colours of the corners in the same
/// order: red, green, blue and opacity, 0 to 1.
pub type MeshPatch = ([Point; 12], [[f64; 4]; 4]);

/// Returns the patches of the mesh gradient that a paint stands for, in the user space of a path with this box. usvg has no mesh gradients.
pub type MeshOf<'a> = dyn Fn(&usvg::Paint, Rect) -> Option<Vec<MeshPatch>> + 'a;

/// A special ink, in which a stroke is printed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Spot {
    /// Its name; `All` stands for all plates.
    pub name: String,
    /// `true` if it knocks out the paint below, `false` if it is printed over it.
    pub knockout: bool,
}

/// Returns the special ink of a path's stroke, if it has one.
pub type SpotOf<'a> = dyn Fn(&usvg::Path) -> Option<Spot> + 'a;

/// Options for writing a PDF.
pub struct Options<'a> {
    /// Provides exact outlines, since usvg approximates arcs.
    pub exact: &'a ExactOutline<'a>,
    /// Provides mesh gradients that replace paints.
    pub mesh: &'a MeshOf<'a>,
    /// Provides inks that replace the colours of strokes.
    pub spot: &'a SpotOf<'a>,
    /// Pixels per inch of pictures that replace filters; `None` stands for 300.
    pub picture_dpi: Option<f64>,
    /// Limits on pictures that are embedded or replace filters.
    pub limits: Limits,
}

impl fmt::Debug for Options<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Options")
            .field("picture_dpi", &self.picture_dpi)
            .field("limits", &self.limits)
            .finish_non_exhaustive()
    }
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self { exact: &|_| None, mesh: &|_, _| None, spot: &|_| None, picture_dpi: None, limits: Limits::default() }
    }
}
