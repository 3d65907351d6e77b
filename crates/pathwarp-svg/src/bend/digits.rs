//! How many decimals coordinates have, and what rounding to them costs.

use crate::source::number::{MOST_DECIMALS, path_data_by};
use pathwarp::Outline;
use pathwarp::kurbo::{BezPath, PathEl};
use pathwarp::refit::{Span, SpanReport};

/// The fraction of the tolerance that rounding may use.
pub(super) const ROUNDING: f64 = 0.01;

/// The number of decimals of coordinates: as given, or enough for [`ROUNDING`]. A unit as written is `size` units of root user
/// space.
pub(super) fn decimals(size: f64, tolerance: f64, given: Option<u8>) -> u8 {
    given.unwrap_or_else(|| {
        let needed = (size * std::f64::consts::FRAC_1_SQRT_2 / (ROUNDING * tolerance)).log10().ceil();
        if needed.is_finite() { needed.clamp(0.0, f64::from(MOST_DECIMALS)) as u8 } else { MOST_DECIMALS }
    })
}

/// Largest error from rounding to `decimals`, in root user units: half the diagonal of a unit of the last, and a third of that unit for
/// cubics written as quadratics.
pub(super) fn rounding(size: f64, decimals: u8) -> f64 {
    size * (std::f64::consts::FRAC_1_SQRT_2 + 0.3) * 0.1_f64.powi(i32::from(decimals))
}

/// The tolerance less the room for rounding.
pub(super) fn allowed(tolerance: f64, rounding: f64) -> f64 {
    (tolerance - rounding).max(0.5 * tolerance)
}

/// Space and decimals of what is written.
#[derive(Debug, Clone, Copy)]
pub(super) struct Digits {
    /// A unit as written, in root user units.
    pub(super) size: f64,
    /// Decimals on request.
    pub(super) given: Option<u8>,
    /// The tolerance of the drawing.
    pub(super) whole: f64,
}

impl Digits {
    /// As many as the whole drawing has, unless their rounding is more than a tenth of this tolerance.
    pub(super) fn decimals(self, tolerance: f64) -> u8 {
        /// Tolerances whose hundredth is a tenth of the one given.
        const COARSE: f64 = 10.0;
        decimals(self.size, self.whole.min(COARSE * tolerance), self.given)
    }

    /// Decimals that an arc may have beside these.
    pub(super) fn more(self) -> u8 {
        if self.given.is_none() { 4 } else { 0 }
    }

    pub(super) fn rounding(self, tolerance: f64) -> f64 {
        rounding(self.size, self.decimals(tolerance))
    }

    /// The same spans, less the room for rounding.
    pub(super) fn allowed(self, spans: &[Span]) -> Vec<Span> {
        let less = |s: &Span| Span { tolerance: allowed(s.tolerance, self.rounding(s.tolerance)), ..*s };
        spans.iter().map(less).collect()
    }

    /// The largest error of the spans with rounding, and the largest as a share of the span's tolerance.
    pub(super) fn errors(self, spans: &[Span], reports: &[SpanReport]) -> [f64; 2] {
        let each = spans.iter().zip(reports).map(|(s, r)| (r.max_error + self.rounding(s.tolerance), s.tolerance));
        each.fold([0.0, 0.0], |[most, share], (e, t)| [f64::max(most, e), f64::max(share, e / t)])
    }

    /// The text of the image of `outline`, in which every span has its own decimals.
    pub(super) fn path_data(self, path: &BezPath, outline: &Outline, spans: &[Span], reports: &[SpanReport]) -> String {
        let mut each: Vec<[u8; 2]> = Vec::with_capacity(path.elements().len());
        let mut spans = spans.iter().zip(reports).map(|(s, r)| (s, r.pieces)).peekable();
        let mut subpaths = outline.subpaths.iter();
        let mut left = 0;
        for el in path.elements() {
            each.push(match el {
                PathEl::MoveTo(_) => {
                    // The closing lines before are not written.
                    while left > 0 {
                        left -= spans.next().map_or(left, |(s, _)| s.segments);
                    }
                    left = subpaths.next().map_or(0, |s| s.segs.len());
                    let start = spans.peek().filter(|_| left > 0).map_or(f64::INFINITY, |(s, _)| s.nodes[0]);
                    [self.decimals(start); 2]
                }
                PathEl::ClosePath => [0; 2],
                _ => match spans.peek_mut() {
                    None => [MOST_DECIMALS; 2],
                    Some((s, pieces)) => {
                        let is_last = *pieces <= 1;
                        let own = self.decimals(s.tolerance);
                        let node = if is_last { own.max(self.decimals(s.nodes[1])) } else { own };
                        *pieces = pieces.saturating_sub(1);
                        if is_last {
                            left -= s.segments.min(left);
                            spans.next();
                        }
                        [own, node]
                    }
                },
            });
        }
        path_data_by(path, self.given.is_none(), |i| each[i])
    }
}
