//! Refits the image of a path under a map with lines and cubics, within a given Hausdorff distance.
//!
//! [`warp_path`] works segment by segment. Affine maps move control points; projective maps keep lines (`path`). Each other segment is
//! taken in a canonical direction (`source`), so that shared edges come out identical, and cut where the map has creases (`segment`).
//! The crate `bezierfit` fits the image of each part. If asked for, fewer pieces are searched across smooth joints (`merge`); pieces of
//! shapes that come again, such as letters, are carried along (`repeats`).
//!
//! [`simplified`] gives outlines the fewest nodes without a map, and shared borders the same curves in all outlines (`borders`).
//! `docs/refitting.md` derives the method.

pub(crate) mod borders;
mod curve;
mod limits;
mod merge;
mod options;
mod overview;
mod path;
mod repeats;
pub(crate) mod report;
mod segment;
pub(crate) mod shared;
mod source;

pub use bezierfit::{Assurance, Nodes};
pub use borders::simplified;
pub use curve::warp_curve;
pub(crate) use limits::ARCS;
pub use options::{Options, suited};
pub use report::{PathReport, RefittedPath};

use crate::error::GeometryError;
use crate::map::{Class, Creases, Gathered, Jet, Map};
use crate::outline::{Outline, Seg};
use kurbo::Point;
use merge::MergeMemory;
use repeats::Shapes;
use shared::SharedEdges;
use std::sync::Arc;

/// Returns the image of `outline` under `map`, within `options.tolerance`, or the tolerances of its [spans](Options::spans).
///
/// Subpaths keep their order, direction and closedness, and smooth joints remain smooth. With [`Nodes::Source`], source nodes remain
/// nodes; with [`Nodes::Auto`] and [`Nodes::Extremes`], a closed smooth subpath begins at the node nearest to its start. Affine maps move
/// control points, and arcs become cubics within the tolerance; under projective maps lines remain lines.
///
/// Sets [`PathReport::resolution`] if coordinates are so large that their rounding exceeds the tolerance.
///
/// # Errors
/// [`GeometryError::Tolerance`] if a tolerance is not a positive, finite number; [`GeometryError::NotFinite`] if the path has coordinates
/// that are not finite; [`GeometryError::Infinity`] if it meets a point at which the map is undefined or not finite;
/// [`GeometryError::Limit`] if the budget is exceeded. They call the shape "path"; see [`GeometryError::on_shape`].
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
    if !options.suited || !options.spans.is_empty() {
        return KnownShapes::default().warp_path(outline, map, options);
    }
    let contours: Vec<f64> = outline.subpaths.iter().map(|s| options.of_contour(s)).collect();
    let spans = if *options.shared == SharedEdges::default() {
        SharedEdges::held([(outline, &contours[..])]).spans(outline, &contours)
    } else {
        options.shared.spans(outline, &contours)
    };
    KnownShapes::default().warp_path(outline, map, &options.clone().with_spans(spans))
}

/// Shapes that come again in a drawing, with the cubics that merge them. Paths that are refitted with this knowledge need not search
/// for these cubics again, and no thread waits for another.
///
/// It only saves time: every path keeps its tolerance, and has the same image whatever the number of threads.
#[doc(hidden)]
#[derive(Debug, Clone, Default, PartialEq)]
pub struct KnownShapes(Arc<Shapes>);

impl KnownShapes {
    /// The shapes of one outline among many: the largest that has at most 1/32 of all segments. Empty if there is no such outline, if it
    /// is small, or if nothing is to be merged.
    #[must_use]
    pub fn among<'a>(outlines: impl IntoIterator<Item = &'a Outline>, map: &dyn Map, options: &Options) -> Self {
        /// The least ratio of all segments to the outline's, whose work is done twice.
        const RATIO: usize = 32;
        /// The least number of segments for which this pays: a line of text.
        const LEAST: usize = 400;
        if options.nodes != Nodes::Fewest || map.prefers_batches() || matches!(map.class(), Class::Affine(_)) {
            return Self::default();
        }
        let sized: Vec<(usize, &Outline)> = outlines.into_iter().map(|o| (o.segs().count(), o)).collect();
        let all: usize = sized.iter().map(|(n, _)| n).sum();
        let candidates = sized.into_iter().filter(|(n, _)| *n >= LEAST && n * RATIO <= all);
        // Among equals, the first one.
        let Some((_, outline)) = candidates.reduce(|a, b| if b.0 > a.0 { b } else { a }) else {
            return Self::default();
        };
        // A path that cannot be refitted is reported when its turn comes.
        let mut memory = MergeMemory::default();
        let _ = refit(outline, map, options, &mut memory);
        Self(Arc::new(memory.into_shapes()))
    }

    /// Returns the image of `outline`, refitted with this knowledge; see [`warp_path`].
    ///
    /// # Errors
    /// The errors of [`warp_path`].
    pub fn warp_path(
        &self,
        outline: &Outline,
        map: &dyn Map,
        options: &Options,
    ) -> Result<RefittedPath, GeometryError> {
        refit(outline, map, options, &mut MergeMemory::new(Arc::clone(&self.0)))
    }
}

/// Returns the image of `outline`; see [`warp_path`].
fn refit(
    outline: &Outline,
    map: &dyn Map,
    options: &Options,
    memory: &mut MergeMemory,
) -> Result<RefittedPath, GeometryError> {
    options.check()?;
    let mut out = RefittedPath::default();
    let counted = map.within(&options.budget);
    let map = counted.as_deref().unwrap_or(map);
    let gathered = map.cost().batches.is_some_and(|b| !b.remembers()).then(|| Gathered::new(map));
    if let Class::Affine(m) = map.class() {
        path::affine(outline, m, options, &mut out)?;
    } else {
        let map = gathered.as_ref().map_or(map, |g| g as &dyn Map);
        let creases = Creases::of_map(map);
        let announced = path::announce_short(outline, map, &creases, options);
        for sub in &outline.subpaths {
            // A map that searches is undefined once the budget is used up.
            let limit = |e| options.budget.exceeded().map_or(e, GeometryError::Limit);
            path::subpath(sub, map, &creases, (options, announced), memory, &mut out).map_err(limit)?;
        }
    }
    out.report.segments_in = outline.segs().count();
    let image = report::extent(&out.path);
    let size = if image > FAR_AWAY * outline.extent() { image.max(amplified(outline, map)) } else { image };
    out.report.account_for_rounding(outline, size, options.tolerance);
    Ok(out)
}

/// The ratio of the largest coordinates of image and outline above which the image lies near a pole.
const FAR_AWAY: f64 = 1e4;

/// The size of coordinates that have the same rounding error as the outline's, amplified by the map.
fn amplified(outline: &Outline, map: &dyn Map) -> f64 {
    let samples = |s: &Seg| (0..=64).map(|i| s.eval(f64::from(i) / 64.0)).collect::<Vec<Point>>();
    let points: Vec<Point> = outline.segs().flat_map(samples).collect();
    let mut jets = vec![Jet::default(); points.len()];
    map.jets(&points, &mut jets);
    let size = |(p, j): (&Point, &Jet)| j.dx.hypot().max(j.dy.hypot()) * p.to_vec2().hypot();
    points.iter().zip(&jets).map(size).filter(|v| v.is_finite()).fold(0.0, f64::max)
}
