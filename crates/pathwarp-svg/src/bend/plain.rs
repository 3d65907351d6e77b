//! The image of a path that belongs to no drawing, as path data: what a drawing would hold for it.

use super::arcs::with_arcs;
use super::digits::{Digits, allowed};
use super::edit::Edit;
use super::stubs;
use crate::source::number::{arcs_data, path_data};
use pathwarp::kurbo::BezPath;
use pathwarp::map::{AffineMap, Map, Undeclared};
use pathwarp::outline::Subpath;
use pathwarp::refit::{self, PathReport, RefittedPath, SharedEdges, suited};
use pathwarp::{GeometryError, Outline};

/// The image of a path.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct WarpedPath {
    /// SVG path data, rounded. Arcs whose images are circles again stay arcs.
    pub data: String,
    /// Lines and cubics, not rounded.
    pub path: BezPath,
    /// Statistics.
    pub report: PathReport,
}

/// Edits a path and writes it as path data, as [`Document::warp`](crate::Document::warp) with the option
/// [`edit`](crate::WarpOptions::edit) writes that of a `<path>`. It has no stroke that could become an outline.
///
/// # Errors
/// A coordinate is not finite, or the work exceeds the budget of the options.
pub fn edit_path(
    outline: &Outline,
    edit: Edit,
    options: &refit::Options,
    precision: Option<u8>,
) -> Result<WarpedPath, GeometryError> {
    let (simplifies, options) = match edit {
        Edit::Simplify { corner, .. } => (true, &options.clone().with_merge(true).with_corner(corner)),
        _ => (false, options),
    };
    let edited = match edit.edited(outline, options, &[])? {
        Some(RefittedPath { path, report, .. }) => {
            let digits = Digits { size: 1.0, given: precision, whole: options.tolerance };
            WarpedPath { data: path_data(&path, digits.decimals(options.tolerance)), path, report }
        }
        None if simplifies => warp_path(outline, &Undeclared, options, precision)?,
        None => return warp_path(outline, &AffineMap::IDENTITY, options, precision),
    };
    if simplifies && edited.report.segments_out >= edited.report.segments_in {
        return warp_path(outline, &AffineMap::IDENTITY, options, precision);
    }
    Ok(edited)
}

/// Maps a path and writes its image as path data, as [`Document::warp`](crate::Document::warp) writes that of a `<path>` in root
/// user space. `precision` is the number of decimals; `None` takes enough for a hundredth of the tolerance.
///
/// ```
/// use pathwarp::map::AffineMap;
/// use pathwarp::{Outline, kurbo::Affine, refit};
///
/// let circle = Outline::from_svg("M0,0 A5,5 0 0 1 10,0")?;
/// let options = refit::Options::new(0.01);
/// let warped = pathwarp_svg::warp_path(&circle, &AffineMap(Affine::scale(2.0)), &options, Some(0))?;
/// assert_eq!(warped.data, "M0,0 A10 10 0 0 1 10 -10 A10 10 0 0 1 20 0");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// The map is undefined on the path, a coordinate is not finite, or the work exceeds the budget of the options.
pub fn warp_path(
    outline: &Outline,
    map: &dyn Map,
    options: &refit::Options,
    precision: Option<u8>,
) -> Result<WarpedPath, GeometryError> {
    options.check()?;
    let digits = Digits { size: 1.0, given: precision, whole: options.tolerance };
    let held = |s: &Subpath| if options.suited { suited(options.tolerance, s.diagonal()) } else { options.tolerance };
    let contours: Vec<f64> = outline.subpaths.iter().map(held).collect();
    let finest = contours.iter().copied().fold(options.tolerance, f64::min);
    let mut outline = outline.clone();
    outline.subpaths.iter_mut().for_each(|s| stubs::drop_closing_stub(s, digits.rounding(finest)));
    let spans = SharedEdges::held([(&outline, &contours[..])]).spans(&outline, &contours);
    let tolerance = allowed(options.tolerance, digits.rounding(options.tolerance));
    let options = options.clone().with_tolerance(tolerance).with_spans(digits.allowed(&spans));
    if let Some((image, report)) = with_arcs(map, &outline, &options)? {
        let data = arcs_data(&image, digits.more(), |i| digits.decimals(contours[i]));
        return Ok(WarpedPath { data, path: image.to_bez_path(finest), report });
    }
    let warped = refit::warp_path(&outline, map, &options)?;
    let mut report = warped.report;
    report.share = digits.errors(&spans, &warped.spans)[1];
    let data = digits.path_data(&warped.path, &outline, &spans, &warped.spans);
    Ok(WarpedPath { data, path: warped.path, report })
}
