//! Curves from outlines in ways that are no maps.

use crate::error::GeometryError;
use crate::outline::{Outline, Seg, Subpath};
use crate::refit::{Options, PathReport, RefittedPath};
use bezierfit::{Error, Fitted, fit_points};
use kurbo::{BezPath, Point};

/// Edges of a contour that is a polygon on purpose rather than a curve in small steps.
const FEW_EDGES: usize = 4;

/// Smooth curves through the vertices of contours of straight lines, within a contour's tolerance of each vertex: that of `contours`, or
/// `options.tolerance` for those beyond its end. Corners are vertices at which a contour turns by more than [`corner`](Options::corner). `None` if a contour has something else than lines, has no more than
/// four, or shares an edge with another, which would come apart.
///
/// # Errors
/// A vertex is not finite.
///
/// ```
/// use pathwarp::{Outline, edit::through_vertices, refit::Options};
///
/// let hexagon = Outline::from_svg("M10,0L5,8.66L-5,8.66L-10,0L-5,-8.66L5,-8.66Z")?;
/// let options = Options::new(0.1).with_corner(70.0_f64.to_radians());
/// let round = through_vertices(&hexagon, &options, &[])?.unwrap();
/// assert!(round.report.segments_out < 6);
/// # Ok::<(), pathwarp::Error>(())
/// ```
pub fn through_vertices(
    outline: &Outline,
    options: &Options,
    contours: &[f64],
) -> Result<Option<RefittedPath>, GeometryError> {
    let is_line = |s: &Seg| matches!(s, Seg::Line(_));
    let stays =
        |s: &Subpath| s.segs.len() <= FEW_EDGES || !s.segs.iter().all(is_line) || options.shared.holds_any(&s.segs);
    if outline.subpaths.iter().any(stays) {
        return Ok(None);
    }
    let (mut path, mut report) = (BezPath::new(), PathReport::default());
    for (i, s) in outline.subpaths.iter().enumerate() {
        let tolerance = contours.get(i).copied().unwrap_or(options.tolerance);
        let fitter = bezierfit::Options::new(tolerance).with_corner(options.corner);
        let points: Vec<Point> = [s.start].into_iter().chain(s.segs.iter().map(Seg::end)).collect();
        let fitted = fit_points(&points, s.closed, &fitter).map_err(refused)?;
        report.add(reported(&fitted, tolerance));
        report.segments_in += s.segs.len();
        path.extend(fitted.path);
    }
    report.segments_out = path.segments().count();
    Ok(Some(RefittedPath { path, spans: Vec::new(), report }))
}

fn reported(fitted: &Fitted, tolerance: f64) -> PathReport {
    let r = &fitted.report;
    let mut out = PathReport::default();
    (out.max_error, out.share, out.assurance) = (r.max_error, r.max_error / tolerance, r.assurance);
    out.over_budget.clone_from(&r.unresolved);
    out
}

fn refused(e: Error) -> GeometryError {
    let at = if let Error::NotFinite(e) = e { e.at } else { Point::ORIGIN };
    GeometryError::Infinity { shape: "path".to_owned(), at }
}
