//! Finds the furthest place that one cubic reaches along a run, by few fits, each remembered.

use super::carry::Carried;
use super::check::Distances;
use super::cubic::{RunCubic, Stretch, Trial};
use super::leg::Leg;
use super::limits::{
    BETWEEN_TARGET, CARRY_BELOW, INTERPOLATIONS, JUMP_ERROR, LEAP_WITHIN, LEAPS, LEAST_PAST_JOINT, MAX_SPAN,
    MERGE_GRID, REACH_TARGET, REFUSED_ERROR, SMALLEST_REACH_ERROR,
};
use super::own::OwnPieces;
use super::proven::proven;
use super::run::SegmentRun;
use crate::refit::piece::FittedPiece;
use crate::refit::source::BreakPoint;
use kurbo::Point;

/// A cubic that was tried from one place to another.
struct Tried {
    to: usize,
    /// Error ÷ tolerance at the samples. At most 1 if the cubic fits.
    error: f64,
    /// Index of the cubic, if it fits.
    cubic: Option<usize>,
    /// Set once it has passed its check.
    passed: Option<Passed>,
    /// The next entry with the same start.
    next: usize,
}

/// A piece that has passed its check.
struct Passed {
    piece: FittedPiece,
    error: f64,
    carried: Option<Carried>,
}

/// No entry.
const NONE: usize = usize::MAX;

/// Lists of [`Reaches`], which keep their memory from run to run.
#[derive(Default)]
pub(super) struct ReachMemory {
    /// Break points at the grid places, computed on first use.
    ends: Vec<Option<BreakPoint>>,
    /// For each joint, how far on either side of it a cubic may extend: the shorter side of a cubic that crosses it is at most
    /// this long.
    crossing: Vec<f64>,
    tried: Vec<Tried>,
    /// The last entry of `tried` from each place.
    latest: Vec<usize>,
    /// The cubics that fit.
    cubics: Vec<RunCubic>,
    distances: Distances,
    /// Places reached from the start before: drawings change little along a curve.
    pub(super) last_reach: usize,
}

/// Everything known about single cubics between the grid places of a run.
pub(super) struct Reaches<'r, 'a> {
    run: &'r SegmentRun<'a>,
    pub(super) own: OwnPieces<'r>,
    tolerance: f64,
    /// The tolerance of proofs, if they are wanted.
    proof: Option<f64>,
    /// Pieces are remembered for other sites.
    carries: bool,
    /// They are wanted there.
    comes_again: bool,
    memory: &'r mut ReachMemory,
}

impl<'r, 'a> Reaches<'r, 'a> {
    pub(super) fn new(
        run: &'r SegmentRun<'a>,
        own: OwnPieces<'r>,
        tolerance: f64,
        proof: Option<f64>,
        comes_again: bool,
        memory: &'r mut ReachMemory,
    ) -> Self {
        let places = run.grid() + 1;
        memory.ends.clear();
        memory.ends.resize(places, None);
        memory.latest.clear();
        memory.latest.resize(places, NONE);
        memory.tried.clear();
        memory.cubics.clear();
        let crossing = (0..=run.segments.len()).map(|j| (tolerance / (JUMP_ERROR * run.curvature_jump(j))).sqrt());
        memory.crossing.clear();
        memory.crossing.extend(crossing);
        let carries = own.site.carries();
        Self { run, own, tolerance, proof, carries, comes_again: carries && comes_again, memory }
    }

    /// Number of cubics that were tried.
    pub(super) fn tried(&self) -> usize {
        self.memory.tried.len()
    }

    /// The last grid place.
    pub(super) fn last(&self) -> usize {
        self.run.grid()
    }

    /// The break point at place `k`. `Err`: the source point, if the map is not finite there.
    fn end(&mut self, k: usize) -> Result<BreakPoint, Point> {
        if let Some(end) = self.memory.ends[k] {
            return Ok(end);
        }
        let end = self.run.end_at(k)?;
        self.memory.ends[k] = Some(end);
        Ok(end)
    }

    /// Returns `true` if one cubic fits from place `k` to `m`, as far as its samples show.
    pub(super) fn fits(&mut self, k: usize, m: usize) -> Result<bool, Point> {
        Ok(m > k && self.error(k, m)? <= 1.0)
    }

    /// The piece from place `k` to `m` with its checked or proven error. `None` if it is not within the tolerance.
    pub(super) fn piece(&mut self, k: usize, m: usize) -> Result<Option<(FittedPiece, f64)>, Point> {
        let i = self.entry(k, m)?;
        if let (Some(cubic), None) = (self.memory.tried[i].cubic, &self.memory.tried[i].passed) {
            let passed = self.checked(cubic, k, m)?;
            let tried = &mut self.memory.tried[i];
            tried.passed = passed;
            if tried.passed.is_none() {
                (tried.error, tried.cubic) = (REFUSED_ERROR, None);
            }
        }
        Ok(self.memory.tried[i].passed.as_ref().map(|p| (p.piece, p.error)))
    }

    /// A leg's piece as other sites need it, if it has passed its check.
    pub(super) fn carried(&mut self, leg: Leg) -> Option<Carried> {
        let i = self.known(leg.from, leg.to)?;
        self.memory.tried[i].passed.as_mut()?.carried.take()
    }

    /// Checks a cubic, by its index, and one fitted more closely if it is just outside the tolerance or to be carried with a larger error
    /// than need be.
    fn checked(&mut self, cubic: usize, k: usize, m: usize) -> Result<Option<Passed>, Point> {
        let cubic = self.memory.cubics[cubic];
        let leg = Leg { from: k, to: m, merged: true };
        let found = self.within(&cubic, leg)?;
        let enough = if self.comes_again { CARRY_BELOW * self.tolerance } else { self.tolerance };
        if found.as_ref().is_some_and(|f| f.error <= enough) {
            return Ok(found);
        }
        let closer = match self.stretch(k, m)?.fitted_closely(&cubic).cubic {
            Some(closer) => self.within(&closer, leg)?,
            None => None,
        };
        let error = |p: &Option<Passed>| p.as_ref().map_or(f64::INFINITY, |p| p.error);
        Ok(if error(&closer) < error(&found) { closer } else { found })
    }

    /// The error of a cubic by the samples of all segments, or proven segment by segment. `None` if it is not within the tolerance.
    fn within(&mut self, cubic: &RunCubic, leg: Leg) -> Result<Option<Passed>, Point> {
        let enough = self.tolerance;
        let checked = self.memory.distances.measure(self.run, cubic, enough)?;
        let Some(mut error) = checked.filter(|e| *e <= enough) else { return Ok(None) };
        if let Some(tolerance) = self.proof {
            error = proven(self.run, cubic, &self.memory.distances.feet, tolerance)?;
            if error > tolerance {
                return Ok(None);
            }
        }
        let distances = &self.memory.distances;
        let carried = self.carries.then(|| {
            // Elsewhere only differences from here are measured.
            let error = error.max(distances.highest_parabola(self.run, cubic));
            Carried::new(&self.own.site, self.run.per_segment, leg, cubic, (distances, error))
        });
        Ok(Some(Passed { piece: cubic.piece(), error, carried: carried.flatten() }))
    }

    fn stretch(&mut self, k: usize, m: usize) -> Result<Stretch, Point> {
        let ends = [self.end(k)?, self.end(m)?];
        Ok(Stretch::new(self.run, ends, [self.run.sample(k), self.run.sample(m)], self.tolerance))
    }

    /// The entry of the cubic from `k` to `m`, if it was tried.
    fn known(&self, k: usize, m: usize) -> Option<usize> {
        let mut i = self.memory.latest[k];
        while i != NONE && self.memory.tried[i].to != m {
            i = self.memory.tried[i].next;
        }
        (i != NONE).then_some(i)
    }

    /// The entry of the cubic from `k` to `m`, which is fitted on first use.
    fn entry(&mut self, k: usize, m: usize) -> Result<usize, Point> {
        if let Some(i) = self.known(k, m) {
            return Ok(i);
        }
        let stretch = self.stretch(k, m)?;
        let Trial { error, cubic } = stretch.fitted();
        let relative = error / stretch.tolerance;
        let error = if cubic.is_some() { relative.min(1.0) } else { relative.max(1.0 + f64::EPSILON) };
        let memory = &mut *self.memory;
        let cubic = cubic.map(|cubic| {
            memory.cubics.push(cubic);
            memory.cubics.len() - 1
        });
        memory.tried.push(Tried { to: m, error, cubic, passed: None, next: memory.latest[k] });
        memory.latest[k] = memory.tried.len() - 1;
        Ok(memory.latest[k])
    }

    fn error(&mut self, k: usize, m: usize) -> Result<f64, Point> {
        let i = self.entry(k, m)?;
        Ok(self.memory.tried[i].error)
    }

    /// The furthest place that jumps of curvature let a cubic from `k` reach.
    pub(super) fn limit(&self, k: usize) -> usize {
        let limit = self.last().min(k + MERGE_GRID * MAX_SPAN);
        let start = self.run.place(k);
        for j in k / MERGE_GRID + 1..self.run.segments.len() {
            if j * MERGE_GRID >= limit {
                break;
            }
            let (joint, most) = (self.run.place(j * MERGE_GRID), self.memory.crossing[j]);
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
    pub(super) fn furthest(&mut self, k: usize) -> Result<usize, Point> {
        let limit = self.limit(k);
        let joint = (k / MERGE_GRID + 1) * MERGE_GRID;
        if limit <= joint && self.own_leads_to(joint, k)? {
            return Ok(k);
        }
        loop {
            let m = self.seek(k, joint, limit)?;
            if m > k {
                self.memory.last_reach = m - k;
            }
            if m == k || self.piece(k, m)?.is_some() {
                return Ok(m);
            }
        }
    }

    /// Returns `true` if `k` is the joint before `joint`, and the segment between them has a single piece.
    fn own_leads_to(&mut self, joint: usize, k: usize) -> Result<bool, Point> {
        Ok(k + MERGE_GRID == joint && self.own.count(k / MERGE_GRID)? == 1)
    }

    /// The furthest place that one cubic reaches from `k` as far as its samples show.
    fn seek(&mut self, k: usize, joint: usize, limit: usize) -> Result<usize, Point> {
        let start = self.run.place(k);
        let (mut low, mut high) = (k, limit + 1);
        // Errors at `low` and `high`, as far as they are known.
        let (mut below, mut above) = (None, None);
        let mut probe = (joint + LEAST_PAST_JOINT).max(k + self.memory.last_reach).min(limit);
        for step in 0.. {
            let error = self.error(k, probe)?.max(SMALLEST_REACH_ERROR);
            if error <= 1.0 {
                (low, below) = (probe, Some(error));
            } else {
                (high, above) = (probe, Some(error));
            }
            if high <= joint + 1 && self.own_leads_to(joint, k)? {
                return Ok(k);
            }
            if low + 1 >= high {
                break;
            }
            let (l, h) = (self.run.place(low) - start, self.run.place(high.min(limit)) - start);
            let wanted = match (below, above) {
                (Some(below), None) => l * (REACH_TARGET / below).powf(1.0 / 6.0),
                (None, Some(above)) => h * above.powf(-1.0 / 6.0),
                (Some(below), Some(above)) if step < INTERPOLATIONS => {
                    l * (h / l).powf(((BETWEEN_TARGET / below).ln() / (above / below).ln()).clamp(0.0, 1.0))
                }
                _ => 0.5 * (l + h),
            };
            probe = low + 1;
            while probe + 1 < high && self.run.place(probe + 1) - start <= wanted {
                probe += 1;
            }
        }
        self.leap(k, low, limit)
    }

    /// Tries the places just beyond a near miss: a few longer stretches fit although the next one does not.
    fn leap(&mut self, k: usize, mut low: usize, limit: usize) -> Result<usize, Point> {
        'further: while low < limit && self.error(k, low + 1)? <= LEAP_WITHIN {
            for m in low + 2..=(low + 1 + LEAPS).min(limit) {
                let error = self.error(k, m)?;
                if error <= 1.0 {
                    low = m;
                    continue 'further;
                }
                if error > LEAP_WITHIN {
                    break;
                }
            }
            break;
        }
        Ok(low)
    }
}
