//! Further samples of a piece whose foot points are known at sixteen.

use crate::refit::candidate::Candidate;
use crate::refit::lanes::{Lane, Lanes};
use crate::refit::samples::{ALL, Evenly};
use crate::refit::source::SourceCurve;
use kurbo::Point;

/// Eight samples with their foot points and squared distances.
pub(super) struct Probe {
    pub(super) g: Lanes,
    pub(super) s: Lane,
    pub(super) squares: Lane,
}

/// Samples the image at `tau` and measures its distance from the cubic, after `steps` Newton steps for the foot points.
pub(super) fn probe(
    source: &SourceCurve<'_>,
    c: &Candidate,
    feet: &Evenly,
    tau: &Lane,
    steps: usize,
) -> Result<Probe, Point> {
    let mut s: Lane = tau.map(|t| interpolated(feet, t));
    let g = c.images(source, tau)?;
    let squares = c.frame.distances(&g, c.a, c.b, &mut s, steps);
    Ok(Probe { g, s, squares })
}

/// Piecewise linear interpolation of the known foot points.
#[inline(always)]
fn interpolated(feet: &Evenly, tau: f64) -> f64 {
    let at = tau * (ALL - 1) as f64;
    let k = (at as usize).min(ALL - 2);
    feet[k] + (feet[k + 1] - feet[k]) * (at - k as f64)
}
