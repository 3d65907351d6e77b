//! Options of a fit.

use crate::limits::SMOOTH_JOINT;

/// What is wanted of a fit.
///
/// ```
/// use bezierfit::Options;
///
/// let options = Options::new(0.01).with_prove(true).with_corner(15.0_f64.to_radians());
/// assert_eq!(options.tolerance, 0.01);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Largest allowed Hausdorff distance between the source and the output, both ways.
    pub tolerance: f64,
    /// Prove the error where the source is a quotient of polynomials, instead of measuring it by dense sampling.
    pub prove: bool,
    /// Joints of a path that turn by less than this, in radians, are smooth: by default half a degree, since drawings round their
    /// coordinates.
    pub corner: f64,
}

impl Options {
    /// Within `tolerance`, measured.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        Self { tolerance, prove: false, corner: SMOOTH_JOINT }
    }

    /// Sets [`Options::prove`].
    #[must_use]
    pub fn with_prove(self, prove: bool) -> Self {
        Self { prove, ..self }
    }

    /// Sets [`Options::corner`].
    #[must_use]
    pub fn with_corner(self, corner: f64) -> Self {
        Self { corner, ..self }
    }
}
