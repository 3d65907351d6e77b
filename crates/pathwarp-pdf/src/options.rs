//! Options for writing a PDF.

use kurbo::BezPath;
use pathwarp::budget::Limits;
use std::fmt;

/// Default resolution of pictures that replace filters, in pixels per inch: the usual one for print.
pub(crate) const PRINT: f64 = 300.0;

/// Returns the exact outline of a path in its own coordinates, if usvg's is an approximation.
pub type ExactOutline<'a> = dyn Fn(&usvg::Path) -> Option<BezPath> + 'a;

/// Options for writing a PDF.
pub struct Options<'a> {
    /// Provides outlines in place of usvg's, which approximates arcs.
    pub exact: &'a ExactOutline<'a>,
    /// Pixels per inch of pictures that replace filters; `None` stands for 300.
    pub picture_dpi: Option<f64>,
    /// Limits on embedded pictures, and on those that replace filters.
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
        Self { exact: &|_| None, picture_dpi: None, limits: Limits::default() }
    }
}
