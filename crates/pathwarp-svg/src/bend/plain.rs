//! The image of a path that belongs to no drawing, as path data: what a drawing would hold for it.

use super::arcs::with_arcs;
use super::stubs;
use super::task::{allowed, decimals, rounding};
use crate::source::number::{arcs_data, path_data};
use pathwarp::kurbo::BezPath;
use pathwarp::map::Map;
use pathwarp::refit::{self, PathReport};
use pathwarp::{GeometryError, Outline};

/// The image of a path.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct WarpedPath {
    /// SVG path data, rounded. Arcs whose images are circles again stay arcs.
    pub data: String,
    /// Lines and cubics, not rounded.
    pub path: BezPath,
    /// Statistics.
    pub report: PathReport,
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
    let decimals = decimals(1.0, options.tolerance, precision);
    let rounding = rounding(1.0, decimals);
    let mut outline = outline.clone();
    outline.subpaths.iter_mut().for_each(|s| stubs::drop_closing_stub(s, rounding));
    let options = options.clone().with_tolerance(allowed(options.tolerance, rounding));
    if let Some((image, report)) = with_arcs(map, &outline, &options)? {
        let data = arcs_data(&image, decimals);
        return Ok(WarpedPath { data, path: image.to_bez_path(options.tolerance), report });
    }
    let warped = refit::warp_path(&outline, map, &options)?;
    Ok(WarpedPath { data: path_data(&warped.path, decimals), path: warped.path, report: warped.report })
}
