//! Finds the furthest place that one cubic reaches along a run, by few fits, each remembered.

use super::run::SegmentRun;
use crate::refit::limits::{
    JUMP_ERROR, LEAP_WITHIN, LEAPS, MAX_SPAN, MERGE_GRID, REACH_TARGET, REFUSED_ERROR, SMALLEST_REACH_ERROR,
};
use crate::refit::outcome::FitOutcome;
use crate::refit::source::BreakPoint;
use crate::refit::stretch::StretchFitter;
use kurbo::Point;

/// The fitter of a run.
pub(super) type RunFitter<'r, 'a> = StretchFitter<'r, SegmentRun<'a>>;

/// Places within reach of one cubic, with its start.
const ROW: usize = MERGE_GRID * MAX_SPAN + 1;

/// Everything known about single cubics between the grid places of a run.
pub(super) struct Reaches<'r, 'a> {
    run: &'r SegmentRun<'a>,
    /// `bounds[i]..bounds[i + 1]` are the pieces of segment i.
    bounds: &'r [usize],
    /// Break points at the grid places, computed on first use.
    ends: Vec<Option<BreakPoint>>,
    /// For each joint, how far on either side of it a cubic may extend: the shorter side of a cubic that crosses it is at most
    /// this long.
    crossing: Vec<f64>,
    /// Error ÷ tolerance of the best cubic found between two places. At most 1 if it fits.
    /// Row by row for each start; NaN if not tried yet.
    errors: Vec<f64>,
}

impl<'r, 'a> Reaches<'r, 'a> {
    pub(super) fn new(run: &'r SegmentRun<'a>, bounds: &'r [usize], tolerance: f64) -> Self {
        let crossing = (0..=run.segments.len()).map(|j| (tolerance / (JUMP_ERROR * run.curvature_jump(j))).sqrt());
        Self {
            run,
            bounds,
            ends: vec![None; run.grid() + 1],
            crossing: crossing.collect(),
            errors: vec![f64::NAN; ROW * (run.grid() + 1)],
        }
    }

    /// The last grid place.
    pub(super) fn last(&self) -> usize {
        self.run.grid()
    }

    /// Number of pieces of segment `i`.
    pub(super) fn pieces(&self, i: usize) -> usize {
        self.bounds[i + 1] - self.bounds[i]
    }

    /// Number of pieces of all segments.
    pub(super) fn unmerged(&self) -> usize {
        self.bounds[self.bounds.len() - 1] - self.bounds[0]
    }

    /// The break point at place `k`. `Err`: the source point, if the map is not finite there.
    pub(super) fn end(&mut self, k: usize) -> Result<BreakPoint, Point> {
        if let Some(end) = self.ends[k] {
            return Ok(end);
        }
        let end = self.run.end_at(k)?;
        self.ends[k] = Some(end);
        Ok(end)
    }

    /// Rules out the cubic from `k` to `m`: it did not pass the final check.
    pub(super) fn refuse(&mut self, k: usize, m: usize) {
        self.errors[ROW * k + (m - k)] = REFUSED_ERROR;
    }

    /// Returns `true` if one cubic fits from place `k` to `m`.
    pub(super) fn fits(&mut self, fitter: &mut RunFitter<'_, '_>, k: usize, m: usize) -> Result<bool, Point> {
        Ok(m > k && self.error(fitter, k, m)? <= 1.0)
    }

    fn error(&mut self, fitter: &mut RunFitter<'_, '_>, k: usize, m: usize) -> Result<f64, Point> {
        let known = self.errors[ROW * k + (m - k)];
        if !known.is_nan() {
            return Ok(known);
        }
        let (from, to) = (self.end(k)?, self.end(m)?);
        let error = match fitter.attempt(&from, &to)? {
            FitOutcome::Fits { reach, .. } => (reach / fitter.tolerance).min(1.0),
            FitOutcome::Misses { reach, .. } => (reach / fitter.tolerance).max(1.0 + f64::EPSILON),
        };
        self.errors[ROW * k + (m - k)] = error;
        Ok(error)
    }

    /// The furthest place that jumps of curvature let a cubic from `k` reach.
    pub(super) fn limit(&self, k: usize) -> usize {
        let limit = self.last().min(k + MERGE_GRID * MAX_SPAN);
        let start = self.run.place(k);
        for j in k / MERGE_GRID + 1..self.run.segments.len() {
            if j * MERGE_GRID >= limit {
                break;
            }
            let (joint, most) = (self.run.starts[j], self.crossing[j]);
            if joint - start <= most {
                continue;
            }
            // The side before the joint is too long, so the side after it must be short enough.
            let mut m = j * MERGE_GRID;
            while m < limit && self.run.place(m + 1) - joint <= most {
                m += 1;
            }
            return m;
        }
        limit
    }

    /// The furthest place that one cubic from `k` was found to reach; `k` itself if there is none, or if nothing beyond the
    /// segment's own single piece can be reached.
    ///
    /// A stretch that fails makes nearly all longer ones fail, so places are tried in the manner of a bisection, with the
    /// sixth-order law of the error as the guess.
    pub(super) fn furthest(&mut self, fitter: &mut RunFitter<'_, '_>, k: usize) -> Result<usize, Point> {
        let limit = self.limit(k);
        let joint = (k / MERGE_GRID + 1) * MERGE_GRID;
        if limit <= joint && k.is_multiple_of(MERGE_GRID) && self.pieces(k / MERGE_GRID) == 1 {
            return Ok(k);
        }
        let (mut low, mut high) = (k, limit + 1);
        // Half a segment past the next joint: the least that is likely to save a piece.
        let mut probe = (joint + MERGE_GRID / 2).min(limit);
        while low + 1 < high {
            let error = self.error(fitter, k, probe)?;
            let (from, length) = (self.run.place(k), self.run.place(probe) - self.run.place(k));
            let wanted = from + length * (REACH_TARGET / error.max(SMALLEST_REACH_ERROR)).powf(1.0 / 6.0);
            if error <= 1.0 {
                low = probe;
                probe = low + 1;
                while probe + 1 < high && self.run.place(probe + 1) <= wanted {
                    probe += 1;
                }
            } else {
                high = probe;
                probe = high.saturating_sub(1);
                while probe > low + 1 && self.run.place(probe) > wanted {
                    probe -= 1;
                }
            }
        }
        self.leap(fitter, k, low, limit)
    }

    /// Tries the places just beyond a near miss: a few longer stretches fit although the next one does not.
    fn leap(&mut self, fitter: &mut RunFitter<'_, '_>, k: usize, mut low: usize, limit: usize) -> Result<usize, Point> {
        'further: while low < limit {
            if self.error(fitter, k, low + 1)? > LEAP_WITHIN {
                break;
            }
            for m in low + 1..=(low + 1 + LEAPS).min(limit) {
                if self.fits(fitter, k, m)? {
                    low = m;
                    continue 'further;
                }
            }
            break;
        }
        Ok(low)
    }
}
