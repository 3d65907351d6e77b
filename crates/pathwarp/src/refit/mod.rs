//! Refits the image of a path under a map with lines and cubics, within a given Hausdorff distance.
//!
//! [`warp_path`] works segment by segment. Let g(t) be the image of a segment under the map.
//!
//! 1. **Exact cases** (`path`). Affine maps move control points; projective maps keep lines.
//! 2. **Direction and splits** (`segment`, `split`). Each segment is fitted in a canonical direction, so that shared edges come
//!    out identical, and is split where the map has creases and where the source has cusps or near-cusps.
//! 3. **Samples** (`source`, `samples`). g is evaluated at eight parameters in one batch, at eight more in between when needed,
//!    and with its derivative at the break points. An image that is a line to rounding ends here (`straight`).
//! 4. **Fit** (`frame`, `residuals`, `fit`). A piece keeps end points and end tangents (G¹). Its two handle lengths minimise the
//!    normal residuals: Gauss–Newton by variable projection, each step bent along the valley of equal area. The error is of sixth
//!    order in the piece's length. The Hermite cubic, with the image's end derivatives, is tried first (`hermite`).
//! 5. **Further attempts** (`improve`): converge, restart elsewhere in the valley, minimax by exchange (`minimax`).
//! 6. **Acceptance** (`judge`). A fit is judged by the cheapest test that can decide: eight samples; sixteen, with the peaks
//!    predicted between them (`resolution`, `peaks`); samples halfway beside doubtful ones; a dense check (`check`); or, if
//!    asked for, a proof by polynomial bounds (`proof`).
//! 7. **Break points** (`breaks`). The sixth root of error ÷ tolerance measures difficulty. Break points go to its quantiles,
//!    with fewer pieces tried first and single break points bisected, until every piece fits.
//! 8. **Merging** (`merge`), if asked for. Dynamic programming finds the fewest cubics across smooth joints.
//!
//! `limits` holds every threshold of these stages, with the reason for its value. `docs/refitting.md` derives the method.

// Loops over eight lanes run by index through several arrays at once, the form that LLVM vectorises.
#![allow(clippy::needless_range_loop)]

mod attempt;
mod breaks;
mod candidate;
mod check;
mod cusp;
mod fit;
mod frame;
mod gather;
mod hermite;
mod improve;
mod judge;
mod known;
mod lanes;
mod limits;
mod merge;
mod minimax;
mod options;
mod outcome;
mod parallel;
mod path;
mod peaks;
mod piece;
mod polyline;
mod proof;
mod report;
mod request;
mod residuals;
mod resolution;
mod samples;
mod segment;
mod shared;
mod source;
mod split;
mod straight;
mod stretch;
mod valley;

pub use known::KnownShapes;
pub use options::{Options, suited};
pub use report::{Assurance, PathReport, RESOLUTION, RefittedPath, SpanReport};
pub use shared::{SharedEdges, Span};

use crate::error::GeometryError;
use crate::map::Map;
use crate::outline::Outline;

/// Returns the image of `outline` under `map`, within `options.tolerance`, or what the options say of its parts.
///
/// Subpaths keep their order, direction and closedness. Unless pieces are merged, source nodes remain nodes. Smooth joints
/// remain smooth. Affine maps move control points, and arcs become cubics within the tolerance; under projective maps lines
/// remain lines.
///
/// Sets [`PathReport::unresolved`] if coordinates are so large that their rounding exceeds the tolerance.
///
/// # Errors
/// [`GeometryError::Infinity`] if the path meets a point at which the map is undefined or not finite, and
/// [`GeometryError::NotFinite`] if the path itself has such coordinates. They call the shape "path"; see
/// [`GeometryError::on_shape`].
///
/// ```
/// use pathwarp::{Outline, map::Formula, map::Real, refit};
///
/// struct Wave;
/// impl Formula for Wave {
///     fn f<S: Real>(&self, x: S, y: S) -> (S, S) { (x, y + (x / 20.0).sin() * 5.0) }
/// }
/// let square = Outline::from_svg("M0 0H100V100H0Z").unwrap();
/// let warped = refit::warp_path(&square, &Wave, &refit::Options::new(0.01)).unwrap();
/// assert!(warped.report.max_error <= 0.01);
/// ```
pub fn warp_path(outline: &Outline, map: &dyn Map, options: &Options) -> Result<RefittedPath, GeometryError> {
    let own;
    let options = if options.suited && options.spans.is_empty() {
        let contours: Vec<f64> = outline.subpaths.iter().map(|s| suited(options.tolerance, s.diagonal())).collect();
        let alone = || SharedEdges::held([(outline, &contours[..])]);
        let spans = if *options.shared == SharedEdges::default() {
            alone().spans(outline, &contours)
        } else {
            options.shared.spans(outline, &contours)
        };
        own = options.clone().with_spans(spans);
        &own
    } else {
        options
    };
    KnownShapes::default().warp_path(outline, map, options)
}
