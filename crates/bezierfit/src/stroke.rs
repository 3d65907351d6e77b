//! Outlines of strokes.

use crate::error::Error;
use crate::options::Options;
use crate::path::Fitted;
use crate::report::{Assurance, Report};
use kurbo::{BezPath, Stroke, StrokeOpts};

/// The outline of a path's stroke, to be filled by the nonzero rule, within `options.tolerance`.
///
/// # Errors
/// The path has coordinates that are not finite.
pub fn stroke(path: &BezPath, style: &Stroke, options: &Options) -> Result<Fitted, Error> {
    let path = kurbo::stroke(path, style, &StrokeOpts::default(), options.tolerance);
    let mut report = Report::default();
    report.add_error(options.tolerance, Assurance::Checked);
    Ok(Fitted { path, report })
}
