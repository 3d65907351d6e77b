//! Refits the image of a path under a map with lines and cubics, within a given Hausdorff distance.
//!
//! [`warp_path`] works segment by segment. Affine maps move control points; projective maps keep lines (`path`). Each other segment is
//! taken in a canonical direction (`split`), so that shared edges come out identical, and cut where the map has creases (`segment`).
//! The image of each part is a source (`source`) for the crate `bezierfit`, which fits it. If asked for, fewer pieces are looked for
//! across smooth joints (`merge`); those of shapes that come again are carried from one place to the next (`carry`, `repeats`).
//!
//! `docs/refitting.md` derives the method.

mod carry;
mod gather;
mod known;
mod limits;
mod merge;
mod options;
mod parallel;
mod path;
mod repeats;
mod report;
mod segment;
mod shared;
mod source;
mod split;

pub use bezierfit::Assurance;
pub use known::KnownShapes;
pub use options::{Options, suited};
pub use report::{PathReport, RESOLUTION, RefittedPath, SpanReport};
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
/// [`GeometryError::Tolerance`] if a tolerance is not a positive, finite number, [`GeometryError::Infinity`] if the path meets a point at which the map is undefined or not finite, and
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
    options.check()?;
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
