//! Dynamic programming for the fewest pieces over a grid of places.

use super::run::SegmentRun;
use crate::refit::limits::{MAX_SPAN, MERGE_GRID, MERGE_PATIENCE};
use crate::refit::outcome::FitOutcome;
use crate::refit::source::BreakPoint;
use crate::refit::stretch::StretchFitter;
use kurbo::Point;

/// A step between two grid places.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Leg {
    pub(super) from: usize,
    pub(super) to: usize,
    /// By one cubic; otherwise by the pieces of one segment.
    pub(super) merged: bool,
}

/// The way through the grid with the fewest pieces. `None` if there are not fewer than the segments have. `ends` are the
/// break points at the grid places, `bounds` the index of each segment's first piece, and `refused` the legs to leave out.
pub(super) fn fewest_legs(
    run: &SegmentRun<'_>,
    fitter: &mut StretchFitter<'_, SegmentRun<'_>>,
    ends: &[BreakPoint],
    bounds: &[usize],
    refused: &[(usize, usize)],
) -> Result<Option<Vec<Leg>>, Point> {
    let unmerged = bounds[bounds.len() - 1] - bounds[0];
    let n = run.grid();
    // cost[k]: the least number of pieces up to place k; back[k]: the start of the last of them, and `true` if merged.
    let mut cost = vec![usize::MAX; n + 1];
    let mut back = vec![(0, false); n + 1];
    cost[0] = 0;
    for k in 0..n {
        if cost[k] == usize::MAX || cost[k] >= unmerged {
            continue;
        }
        // A segment's own pieces lead from joint to joint.
        if k % MERGE_GRID == 0 {
            let seg = k / MERGE_GRID;
            let with = cost[k] + bounds[seg + 1] - bounds[seg];
            if with < cost[k + MERGE_GRID] {
                (cost[k + MERGE_GRID], back[k + MERGE_GRID]) = (with, (k, false));
            }
        }
        let mut failed = 0;
        for m in k + 1..=n.min(k + MERGE_GRID * MAX_SPAN) {
            // Skip places that are reached as cheaply already.
            if cost[k] + 1 >= cost[m] || refused.contains(&(k, m)) {
                continue;
            }
            match fitter.attempt(&ends[k], &ends[m])? {
                FitOutcome::Fits { .. } => {
                    failed = 0;
                    (cost[m], back[m]) = (cost[k] + 1, (k, true));
                }
                FitOutcome::Misses { .. } => {
                    failed += 1;
                    if failed > MERGE_PATIENCE {
                        break;
                    }
                }
            }
        }
    }
    if cost[n] >= unmerged {
        return Ok(None);
    }
    let mut legs = Vec::with_capacity(cost[n]);
    let mut to = n;
    while to > 0 {
        let (from, merged) = back[to];
        legs.push(Leg { from, to, merged });
        to = from;
    }
    legs.reverse();
    Ok(Some(legs))
}
