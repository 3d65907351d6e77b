//! The result of a refit: the path, its error, and how far that error can be trusted.

use crate::outline::Outline;
use bezierfit::parts::append;
use bezierfit::{Assurance, Piece, Report};
use kurbo::{BezPath, PathEl, Point};

/// The rounding error relative to the largest coordinate: some hundreds of roundings in double precision. A finer error cannot be measured,
/// as the fit chases noise.
pub const RESOLUTION: f64 = 1e-13;

/// The share by which rounding may lift a sum of errors above the tolerance.
pub(super) const SUMMED: f64 = 1e-9;

/// Statistics of a refitted path.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PathReport {
    /// The number of segments in the source, closing lines included.
    pub segments_in: usize,
    /// The number of segments in the output, closing lines included.
    pub segments_out: usize,
    /// The largest distance between the true image and the output, in root user units.
    pub max_error: f64,
    /// The largest error as a share of the tolerance that holds there.
    pub share: f64,
    /// The basis of `max_error`: the weakest of all segments.
    pub assurance: Assurance,
    /// Points in the source at which the tolerance was not met: the work budget ran out, or rounding is larger.
    pub unresolved: Vec<Point>,
    /// The resolution of the coordinates, [`RESOLUTION`] times the largest in source or image, if it exceeds the tolerance. The
    /// image is then known no better; `max_error` is at least this, and `unresolved` holds a point.
    pub resolution: Option<f64>,
}

impl Default for PathReport {
    fn default() -> Self {
        let (segments_in, segments_out, assurance) = (0, 0, Assurance::Exact);
        let (max_error, share, unresolved, resolution) = Default::default();
        Self { segments_in, segments_out, max_error, share, assurance, unresolved, resolution }
    }
}

impl PathReport {
    /// Converts the fitter's report on a part with this tolerance.
    pub(crate) fn fitted(report: &Report, tolerance: f64) -> Self {
        let mut out = Self::default();
        (out.max_error, out.share, out.assurance) = (report.max_error, report.max_error / tolerance, report.assurance);
        out.unresolved.clone_from(&report.unresolved);
        out
    }

    /// Accounts for coordinates so large that their rounding exceeds the tolerance. `image` is the largest coordinate of the image. If the
    /// tolerance is missed and no point for it is known, the path's first point becomes unresolved.
    pub fn account_for_rounding(&mut self, outline: &Outline, image: f64, tolerance: f64) {
        let resolution = RESOLUTION * outline.extent().max(image);
        let mut missed = self.max_error > tolerance * (1.0 + SUMMED);
        if resolution > tolerance {
            self.resolution = Some(resolution);
            self.add_error(resolution, Assurance::Checked);
            missed = true;
        }
        self.share = self.share.max(self.max_error / tolerance);
        if missed && self.unresolved.is_empty() {
            self.unresolved.extend(outline.subpaths.first().map(|s| s.start));
        }
    }

    /// Adds the report of another part of the same path; the numbers of segments stay.
    pub fn add(&mut self, part: Self) {
        self.add_error(part.max_error, part.assurance);
        self.share = self.share.max(part.share);
        self.unresolved.extend(part.unresolved);
        self.resolution = [self.resolution, part.resolution].into_iter().flatten().reduce(f64::max);
    }

    /// Adds the fitter's report on some pieces; `share` is left to the caller.
    pub(super) fn add_pieces(&mut self, part: Report) {
        self.add_error(part.max_error, part.assurance);
        self.unresolved.extend(part.unresolved);
    }

    /// Accounts for a piece with this error.
    pub(super) fn add_error(&mut self, error: f64, assurance: Assurance) {
        self.max_error = self.max_error.max(error);
        self.assurance = self.assurance.min(assurance);
    }
}

/// The largest coordinate of a path.
pub(super) fn extent(path: &BezPath) -> f64 {
    let size = |p: Point| p.x.abs().max(p.y.abs());
    path.elements().iter().fold(0.0, |largest, e| match *e {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => size(p).max(largest),
        PathEl::QuadTo(p, q) => size(p).max(size(q)).max(largest),
        PathEl::CurveTo(p, q, r) => size(p).max(size(q)).max(size(r)).max(largest),
        PathEl::ClosePath => largest,
    })
}

/// The image of a path.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct RefittedPath {
    /// Lines and cubics.
    pub path: BezPath,
    /// The results of the options' [spans](super::Options::spans), one each.
    pub spans: Vec<SpanReport>,
    /// Statistics.
    pub report: PathReport,
}

/// The result of a span.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpanReport {
    /// The number of lines and cubics, including a closing line.
    pub pieces: usize,
    /// The largest distance between the true image and the output, in root user units.
    pub max_error: f64,
}

impl RefittedPath {
    /// Writes a subpath. In a closed one, a last line is left to the close command.
    pub(super) fn subpath(&mut self, start: Point, pieces: &[Piece], closed: bool) {
        self.report.segments_out += pieces.len();
        append(&mut self.path, start, pieces, closed);
    }
}

/// Reverses the direction of a run of pieces.
pub(super) fn reverse(pieces: &mut [Piece]) {
    pieces.reverse();
    for p in pieces {
        *p = p.reversed();
    }
}
