//! Fewer pieces across smooth joints: the fewest cubics that cover a run of segments, where pieces may end at the points of a grid.
//!
//! After c pieces nearly only the furthest grid point matters, because a cubic that covers a stretch also covers its later part.
//! So the search keeps one grid point for each number of pieces, extends it as far as one cubic reaches, and compares with
//! the segments' *own pieces*, fitted to each segment alone, which lead from joint to joint.
//!
//! How far a cubic reaches is found as in a bisection. Its error goes with about the sixth power of its length, which predicts the next
//! length to try; between a cubic that fits and one that misses, the logarithm of the error is interpolated.
//!
//! Grid points are numbered along the run (`k`, `m` in the code); joints (`j`) are the multiples of the grid points per segment. A *leg*
//! leads from one grid point to a later one. Every cubic is fitted once and remembered by its grid points.

use crate::distances::{Distances, MarkedCubic, proven};
use crate::limits::{ACCEPTED, BETWEEN_TARGET, CARRY_BELOW, FINEST_STEP, JUMP_ERROR, MERGE_GRID, REACH_TARGET};
use crate::report::{Assurance, Piece, Report};
use crate::run::{RunCubic, SegmentRun, Stretch, Trial};
use crate::source::{BreakPoint, Result, Source};
use std::collections::VecDeque;

/// A cubic that was tried from one grid point to another.
struct Tried {
    to: usize,
    /// Error ÷ tolerance at the samples. At most 1 if the cubic fits.
    error: f64,
    /// The cubic, if it fits and has not been checked.
    cubic: Option<Box<RunCubic>>,
    /// The piece, once it has passed its check.
    passed: Option<Box<Passed>>,
    /// Index of the entry before with the same start, or [`NO_ENTRY`].
    next: usize,
}

/// A piece that has passed its check.
struct Passed {
    piece: Piece,
    error: f64,
    marked: Option<MarkedCubic>,
}

/// Index that stands for no entry.
const NO_ENTRY: usize = usize::MAX;
/// Most break points that are remembered.
const MAX_ENDS: usize = 256;
/// Number of joints in a block, all of which are passed at once where curvature limits none of them.
const BLOCK_JOINTS: usize = 64;

/// Memory of [`Reaches`], reused from run to run.
#[derive(Default)]
pub struct ReachMemory {
    /// Break points at grid points, at their number modulo the length; computed on first use.
    ends: Vec<Option<(usize, BreakPoint)>>,
    /// For each joint, the greatest length of the shorter side of a cubic that crosses it.
    crossing: Vec<f64>,
    /// For each block of joints, the length along the run from which on a cubic starts near enough to cross all of them.
    blocks: Vec<f64>,
    tried: Vec<Tried>,
    /// The last entry of `tried` from each grid point.
    latest: Vec<usize>,
    distances: Distances,
    /// Grid points that the last cubic spanned, as a guess for the next.
    pub last_reach: usize,
}

/// A search on a run, with all that is known about single cubics between its grid points.
pub struct Reaches<'r, S, F> {
    pub(crate) run: &'r SegmentRun<S>,
    /// Pieces of the single segments.
    pub own: OwnPieces<F>,
    /// Tolerance of checks, smaller than the tolerance of proofs.
    tolerance: f64,
    settings: MergeSettings,
    memory: &'r mut ReachMemory,
}

/// Requirements for merged pieces.
#[derive(Debug, Clone, Copy)]
pub struct MergeSettings {
    /// Largest allowed distance.
    pub tolerance: f64,
    /// Prove the error.
    pub proof: bool,
    /// Keep samples of cubics, so that these can be carried to other copies of the shape.
    pub marks: bool,
    /// The shape comes again, so that marked cubics will be carried. That adds a little to their errors, which should be small.
    pub again: bool,
    /// Fit alike from either end: a cubic does not depend on the direction of its stretch.
    pub evenly: bool,
}

impl<'r, S: Source, F: FitOwn> Reaches<'r, S, F> {
    /// Starts the search on a run. `memory` may come from any other run.
    pub fn new(
        run: &'r SegmentRun<S>,
        mut own: OwnPieces<F>,
        settings: MergeSettings,
        memory: &'r mut ReachMemory,
    ) -> Self {
        let tolerance = ACCEPTED * settings.tolerance;
        own.grid = run.grid;
        let points = run.last_grid_point() + 1;
        memory.ends.clear();
        memory.ends.resize(points.min(MAX_ENDS), None);
        memory.latest.clear();
        memory.latest.resize(points, NO_ENTRY);
        memory.tried.clear();
        let crossing = (0..=run.segments.len()).map(|j| {
            let most = (tolerance / (JUMP_ERROR * run.curvature_jump(j))).sqrt();
            // Shorter segments say nothing about the curvature so far from the joint.
            if most < run.shorter_beside(j) { most } else { f64::INFINITY }
        });
        memory.crossing.clear();
        memory.crossing.extend(crossing);
        let earliest = |(j, most): (usize, &f64)| run.length_at(j * run.grid) - most;
        let blocks = memory.crossing.chunks(BLOCK_JOINTS).enumerate().map(|(b, block)| {
            block
                .iter()
                .enumerate()
                .map(|(i, most)| earliest((b * BLOCK_JOINTS + i, most)))
                .fold(f64::NEG_INFINITY, f64::max)
        });
        memory.blocks.clear();
        memory.blocks.extend(blocks);
        Self { run, own, tolerance, settings, memory }
    }

    /// Number of cubics that were tried.
    pub fn tried(&self) -> usize {
        self.memory.tried.len()
    }

    /// The last grid point.
    pub(crate) fn last(&self) -> usize {
        self.run.last_grid_point()
    }

    /// The break point at grid point `k`. An error if the curve is not finite there.
    fn end(&mut self, k: usize) -> Result<BreakPoint> {
        let slot = k % self.memory.ends.len();
        if let Some((at, end)) = self.memory.ends[slot]
            && at == k
        {
            return Ok(end);
        }
        let end = self.run.end_at(k)?;
        self.memory.ends[slot] = Some((k, end));
        Ok(end)
    }

    /// The piece from grid point `k` to `m` with its checked or proven error. `None` if it is not within the tolerance.
    fn piece(&mut self, k: usize, m: usize) -> Result<Option<(Piece, f64)>> {
        let i = self.entry(k, m)?;
        if let Some(cubic) = self.memory.tried[i].cubic.take() {
            let passed = self.check_or_refit(*cubic, k, m)?.map(Box::new);
            let tried = &mut self.memory.tried[i];
            if passed.is_none() {
                // A miss, but a near one.
                tried.error = 1.2;
            }
            tried.passed = passed;
        }
        // An error by samples may be too small by the margin that the tolerance of checks leaves; a proven one is not.
        let margin = if self.settings.proof { 1.0 } else { ACCEPTED };
        Ok(self.memory.tried[i].passed.as_ref().map(|p| (p.piece, p.error / margin)))
    }

    /// Takes the marked cubic of a leg, if it has passed its check.
    pub fn marked(&mut self, leg: Leg) -> Option<MarkedCubic> {
        let i = self.entry_if_tried(leg.from, leg.to)?;
        self.memory.tried[i].passed.as_mut()?.marked.take()
    }

    /// Checks a cubic. If it fails, or has a large error and will be carried, checks a closer fit too. Returns the better of both.
    fn check_or_refit(&mut self, cubic: RunCubic, k: usize, m: usize) -> Result<Option<Passed>> {
        let found = self.check(&cubic)?;
        let enough =
            if self.settings.marks && self.settings.again { CARRY_BELOW * self.tolerance } else { self.tolerance };
        if found.as_ref().is_some_and(|f| f.error <= enough) {
            return Ok(found);
        }
        let closer = match self.stretch(k, m)?.fitted_closely(&cubic)?.cubic {
            Some(closer) => self.check(&closer)?,
            None => None,
        };
        let error = |p: &Option<Passed>| p.as_ref().map_or(f64::INFINITY, |p| p.error);
        Ok(if error(&closer) < error(&found) { closer } else { found })
    }

    /// Piece and error of a cubic, by the samples of all segments or proven segment by segment. `None` if it is not within the tolerance.
    /// `measure` leaves foot points in `distances.feet` for the proof and the marks.
    fn check(&mut self, cubic: &RunCubic) -> Result<Option<Passed>> {
        let enough = self.tolerance;
        let checked = self.memory.distances.measure(self.run, cubic, enough)?;
        let Some(mut error) = checked.filter(|e| *e <= enough) else { return Ok(None) };
        if self.settings.proof {
            let tolerance = self.settings.tolerance;
            error = proven(self.run, cubic, &self.memory.distances.feet, tolerance)?;
            if error > tolerance {
                return Ok(None);
            }
        }
        let marked = self.settings.marks.then(|| self.memory.distances.marked(self.run, cubic, error)).flatten();
        Ok(Some(Passed { piece: cubic.piece(), error, marked }))
    }

    fn stretch(&mut self, k: usize, m: usize) -> Result<Stretch> {
        let ends = [self.end(k)?, self.end(m)?];
        let settings = (self.tolerance, self.settings.evenly);
        Ok(Stretch::new(self.run, ends, [self.run.sample_at(k), self.run.sample_at(m)], settings))
    }

    /// Index of the cubic from `k` to `m`, if it was tried.
    fn entry_if_tried(&self, k: usize, m: usize) -> Option<usize> {
        let mut i = self.memory.latest[k];
        while i != NO_ENTRY && self.memory.tried[i].to != m {
            i = self.memory.tried[i].next;
        }
        (i != NO_ENTRY).then_some(i)
    }

    /// Index of the cubic from `k` to `m`, which is fitted on first use.
    fn entry(&mut self, k: usize, m: usize) -> Result<usize> {
        if let Some(i) = self.entry_if_tried(k, m) {
            return Ok(i);
        }
        let Trial { error, cubic } = self.stretch(k, m)?.fitted()?;
        let relative = error / self.tolerance;
        let error = if cubic.is_some() { relative.min(1.0) } else { relative.max(1.0 + f64::EPSILON) };
        let memory = &mut *self.memory;
        let cubic = cubic.map(Box::new);
        memory.tried.push(Tried { to: m, error, cubic, passed: None, next: memory.latest[k] });
        memory.latest[k] = memory.tried.len() - 1;
        Ok(memory.latest[k])
    }

    /// Error ÷ tolerance of the cubic from `k` to `m` at its samples.
    pub(crate) fn error(&mut self, k: usize, m: usize) -> Result<f64> {
        let i = self.entry(k, m)?;
        Ok(self.memory.tried[i].error)
    }

    /// The furthest grid point to which jumps of curvature let a cubic from `k` extend.
    fn curvature_limit(&self, k: usize) -> usize {
        let (last, start) = (self.last(), self.run.length_at(k));
        let mut j = k / self.run.grid + 1;
        while j < self.run.segments.len() {
            if j.is_multiple_of(BLOCK_JOINTS) && self.memory.blocks[j / BLOCK_JOINTS] <= start {
                j += BLOCK_JOINTS;
                continue;
            }
            let (joint, most) = (self.run.length_at(j * self.run.grid), self.memory.crossing[j]);
            if joint - start <= most {
                j += 1;
                continue;
            }
            // The side before the joint is too long, so the side after it must be short enough.
            let mut m = j * self.run.grid;
            while m < last && self.run.length_at(m + 1) - joint <= most {
                m += 1;
            }
            return m;
        }
        last
    }

    /// The furthest grid point found that one cubic from `k` reaches; `k` itself if there is none, or if `k` is a joint and the segment's
    /// own fit, a single piece, leads as far.
    fn furthest(&mut self, k: usize) -> Result<usize> {
        let limit = self.curvature_limit(k);
        let grid = self.run.grid;
        let joint = (k / grid + 1) * grid;
        if limit <= joint && self.own_leads_to(joint, k)? {
            return Ok(k);
        }
        loop {
            let m = self.seek(k, (joint, limit), false)?;
            if m > k {
                self.memory.last_reach = m - k;
            }
            if m == k || self.piece(k, m)?.is_some() {
                return Ok(m);
            }
        }
    }

    /// Returns `true` if `k` is the joint before `joint`, and the segment between them has a single piece.
    fn own_leads_to(&mut self, joint: usize, k: usize) -> Result<bool> {
        Ok(k + self.run.grid == joint && self.own.count(k / self.run.grid)? == 1)
    }

    /// The furthest grid point up to `limit` that one cubic reaches from `k`, as far as its samples show; `k` if the segment's own piece
    /// leads as far, to `joint`. If `back`, grid points count from the end. With `joint` = k + 1, own pieces do not matter.
    fn seek(&mut self, k: usize, (joint, limit): (usize, usize), back: bool) -> Result<usize> {
        let start = self.length_to(k, back);
        let (mut low, mut high) = (k, limit + 1);
        // Errors at `low` and `high`, if known.
        let (mut below, mut above) = (None, None);
        let mut probe = (joint + self.run.grid / 2).max(k + self.memory.last_reach).min(limit);
        for round in 0.. {
            let [from, to] = self.in_order([k, probe], back);
            // Smaller errors may be rounding. This limits the growth of the next guess to sixfold.
            let error = self.error(from, to)?.max(1e-4);
            if error <= 1.0 {
                (low, below) = (probe, Some(error));
            } else {
                (high, above) = (probe, Some(error));
            }
            if high <= joint + 1 && self.own_leads_to(joint, k)? {
                return Ok(k);
            }
            if low + ((low - k) / FINEST_STEP).max(1) >= high {
                break;
            }
            let [fits, misses] = [low, high.min(limit)].map(|k| self.length_to(k, back) - start);
            let wanted = match (below, above) {
                (Some(below), None) => fits * (REACH_TARGET / below).powf(1.0 / 6.0),
                (None, Some(above)) => misses * above.powf(-1.0 / 6.0),
                // After six rounds, the middle, as the model may mislead.
                (Some(below), Some(above)) if round < 6 => {
                    let share = (BETWEEN_TARGET / below).ln() / (above / below).ln();
                    fits * (misses / fits).powf(share.clamp(0.0, 1.0))
                }
                _ => 0.5 * (fits + misses),
            };
            probe = self.grid_point_before(start + wanted, [low + 1, high - 1], back);
        }
        Ok(low)
    }

    /// Two grid points in the order of the run.
    fn in_order(&self, [k, m]: [usize; 2], back: bool) -> [usize; 2] {
        if back { [self.last() - m, self.last() - k] } else { [k, m] }
    }

    /// Length of the run up to a grid point.
    fn length_to(&self, k: usize, back: bool) -> f64 {
        let run = self.run;
        if back { run.length_at(self.last()) - run.length_at(self.last() - k) } else { run.length_at(k) }
    }

    /// The last grid point between two up to which the length is at most `length`; the first of them if there is none.
    fn grid_point_before(&self, length: f64, between: [usize; 2], back: bool) -> usize {
        if !back {
            return self.run.grid_point_before(length, between);
        }
        let [mut low, mut high] = [between[0], between[1] + 1];
        while low + 1 < high {
            let mid = low.midpoint(high);
            *if self.length_to(mid, true) <= length { &mut low } else { &mut high } = mid;
        }
        low
    }

    /// The grid points that divide the run into the fewest pieces, each in the middle of the range in which it may lie. `None` if no cubic
    /// leads from some grid point to the next.
    pub(crate) fn middles(&mut self) -> Result<Option<Vec<usize>>> {
        let last = self.last();
        // The furthest ends of 0, 1, 2… pieces from the start, and from the end.
        let mut furthest = [vec![0], vec![0]];
        for (ends, back) in furthest.iter_mut().zip([false, true]) {
            let mut k = 0;
            self.memory.last_reach = 0;
            while k < last {
                let m = self.seek(k, (k + 1, last), back)?;
                let [from, to] = self.in_order([k, m], back);
                if m == k {
                    return Ok(None);
                }
                // A piece that does not pass its check is a miss from then on.
                if self.piece(from, to)?.is_some() {
                    self.memory.last_reach = m - k;
                    ends.push(m);
                    k = m;
                }
            }
        }
        let [ahead, back] = furthest;
        let n = ahead.len().max(back.len()) - 1;
        let mut out = vec![0];
        for i in 1..n {
            let (high, low) = (ahead.get(i).unwrap_or(&last), last - back.get(n - i).unwrap_or(&last));
            let middle = 0.5 * (self.run.length_at(low) + self.run.length_at(*high));
            out.push(self.nearest_grid_point(middle, [out[i - 1], last - 1]));
        }
        out.push(last);
        Ok(out.windows(2).all(|w| w[0] < w[1]).then_some(out))
    }

    /// The grid point nearest to a length; of two that are equally near, the one closer to the middle of the run.
    pub(crate) fn nearest_grid_point(&self, length: f64, between: [usize; 2]) -> usize {
        let (run, whole) = (self.run, self.run.length_at(self.last()));
        let k = run.grid_point_before(length, between);
        let (down, up) = (length - run.length_at(k), run.length_at(k + 1) - length);
        let towards = if 2.0 * length < whole { 1.0 } else { -1.0 };
        if down - up > -1e-6 * towards * whole / self.last() as f64 { k + 1 } else { k }
    }

    /// The legs with their pieces. `None` if one of them does not pass its check.
    ///
    /// # Errors
    /// [`NotFinite`](crate::NotFinite) if a segment is not finite.
    pub fn pieces_of(&mut self, legs: &[Leg]) -> Result<Option<Vec<PassedLeg>>> {
        let mut out = Vec::with_capacity(legs.len());
        for leg in legs {
            let piece = if leg.merged { self.piece(leg.from, leg.to)? } else { None };
            if piece.is_some() || !leg.merged {
                out.push((*leg, piece));
            }
        }
        Ok((out.len() == legs.len()).then_some(out))
    }

    /// The legs with the fewest pieces, all of which have passed their check. `None` if they are not fewer than the segments have.
    ///
    /// # Errors
    /// [`NotFinite`](crate::NotFinite) if a segment is not finite.
    pub fn fewest(&mut self) -> Result<Option<Vec<PassedLeg>>> {
        match fewest_legs(self)? {
            Some(legs) => self.pieces_of(&legs),
            None => Ok(None),
        }
    }
}

/// A step between two grid points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Leg {
    /// First grid point.
    pub from: usize,
    /// Last grid point.
    pub to: usize,
    /// Set if one cubic covers the leg; otherwise the pieces of one segment do.
    pub merged: bool,
}

/// Function that fits a segment, given its index in the run, and appends its pieces.
pub trait FitOwn: FnMut(usize, &mut Vec<Piece>, &mut Report) -> Result<()> {}

impl<F: FnMut(usize, &mut Vec<Piece>, &mut Report) -> Result<()>> FitOwn for F {}

/// Pieces of single segments, fitted only when they are needed. Where merging succeeds, few are.
pub struct OwnPieces<F> {
    fit: F,
    /// Grid points per segment, in which legs are counted.
    grid: usize,
    pieces: Vec<Piece>,
    /// For each segment that was fitted, its range in `pieces` and its report.
    known: Vec<Option<(usize, usize, Report)>>,
}

impl<F: FitOwn> OwnPieces<F> {
    /// Makes an empty list for a number of segments.
    pub fn new(segments: usize, fit: F) -> Self {
        Self { fit, grid: MERGE_GRID, pieces: Vec::new(), known: vec![None; segments] }
    }

    fn fitted(&mut self, i: usize) -> Result<&(usize, usize, Report)> {
        if self.known[i].is_none() {
            let (start, mut report) = (self.pieces.len(), Report::default());
            (self.fit)(i, &mut self.pieces, &mut report)?;
            self.known[i] = Some((start, self.pieces.len(), report));
        }
        Ok(self.known[i].get_or_insert_with(|| (0, 0, Report::default())))
    }

    /// Number of pieces of segment `i`.
    fn count(&mut self, i: usize) -> Result<usize> {
        self.fitted(i).map(|(from, to, _)| to - from)
    }

    pub(crate) fn segments(&self) -> usize {
        self.known.len()
    }

    /// Number of pieces of all segments.
    pub(crate) fn total(&mut self) -> Result<usize> {
        (0..self.segments()).map(|i| self.count(i)).sum()
    }

    /// Number of pieces of these legs; without legs, of all segments fitted separately.
    ///
    /// # Errors
    /// [`NotFinite`](crate::NotFinite) if a segment is not finite.
    pub fn count_of(&mut self, legs: Option<&[PassedLeg]>) -> Result<usize> {
        let Some(legs) = legs else { return self.total() };
        legs.iter().map(|(leg, _)| if leg.merged { Ok(1) } else { self.count(leg.from / self.grid) }).sum()
    }

    /// Appends the pieces of segment `i`.
    fn append_segment(&mut self, i: usize, out: &mut Vec<Piece>, report: &mut Report) -> Result<()> {
        let &(from, to, ref own) = self.fitted(i)?;
        report.add(own);
        out.extend_from_slice(&self.pieces[from..to]);
        Ok(())
    }

    /// Appends the pieces of these legs; without legs, of all segments fitted separately.
    ///
    /// # Errors
    /// [`NotFinite`](crate::NotFinite) if a segment is not finite.
    pub fn append(
        &mut self,
        legs: Option<Vec<PassedLeg>>,
        assurance: Assurance,
        pieces: &mut Vec<Piece>,
        report: &mut Report,
    ) -> Result<()> {
        let Some(legs) = legs else {
            return (0..self.segments()).try_for_each(|i| self.append_segment(i, pieces, report));
        };
        for (leg, piece) in legs {
            if let Some((piece, error)) = piece {
                report.add_error(error, assurance);
                pieces.push(piece);
            } else {
                self.append_segment(leg.from / self.grid, pieces, report)?;
            }
        }
        Ok(())
    }
}

/// A leg, with the piece and its error if it is merged.
pub type PassedLeg = (Leg, Option<(Piece, f64)>);

/// Searches for legs with fewer pieces on a finer grid, with about 24 points for each piece: where pieces are hardly longer than segments,
/// ending at the points of a coarse grid costs many. Its cubics have no marks. Returns `legs` if there are none with fewer pieces.
///
/// # Errors
/// [`NotFinite`](crate::NotFinite) if a segment is not finite.
pub fn refined<S: Source + Clone, F: FitOwn>(
    run: &SegmentRun<S>,
    mut own: OwnPieces<F>,
    legs: Option<Vec<PassedLeg>>,
    settings: MergeSettings,
    memory: &mut ReachMemory,
) -> Result<(OwnPieces<F>, Option<Vec<PassedLeg>>)> {
    let pieces = own.count_of(legs.as_deref())?;
    let by = (24 * pieces / run.last_grid_point()).next_power_of_two().min(MOST_REFINED);
    if by == 1 {
        return Ok((own, legs));
    }
    let Some(fine) = run.finer(by)? else { return Ok((own, legs)) };
    let mut reaches = Reaches::new(&fine, own, MergeSettings { marks: false, ..settings }, memory);
    let fewer = reaches.fewest()?;
    let mut own = reaches.own;
    if fewer.is_some() && own.count_of(fewer.as_deref())? < pieces {
        return Ok((own, fewer));
    }
    own.grid = run.grid;
    Ok((own, legs))
}

/// Largest factor by which a grid is refined.
const MOST_REFINED: usize = 16;

/// The furthest grid point found for some number of pieces.
#[derive(Debug, Clone, Copy)]
struct Furthest {
    grid_point: usize,
    /// Start of the last leg, and `true` if it is merged. `None` if one piece fewer leads as far.
    leg: Option<(usize, bool)>,
}

/// The legs with the fewest pieces. `None` if they are not fewer than the segments have.
fn fewest_legs(reaches: &mut Reaches<'_, impl Source, impl FitOwn>) -> Result<Option<Vec<Leg>>> {
    let (last, grid) = (reaches.last(), reaches.run.grid);
    let mut furthest = vec![Furthest { grid_point: 0, leg: None }];
    // For each leg by own pieces, the number of pieces up to its end, and that end, a joint.
    let mut by_own: VecDeque<(usize, usize)> = VecDeque::new();
    for count in 0.. {
        // A segment has at least one piece.
        if count + 1 >= reaches.own.segments() && count + 1 >= reaches.own.total()? {
            break;
        }
        let Furthest { grid_point: k, leg } = furthest[count];
        let joint = k - k % grid;
        let mut best = Furthest { grid_point: reaches.furthest(k)?, leg: Some((k, true)) };
        // The pieces of a single segment matter only if no cubic leads as far. The leg to k may also end at the joint before.
        if best.grid_point <= joint + grid
            && best.grid_point < last
            && joint < last
            && (joint == k
                || matches!(leg, Some((from, true)) if from < joint
                    && reaches.error(from, joint)? <= 1.0 && reaches.piece(from, joint)?.is_some()))
        {
            by_own.push_back((count + reaches.own.count(joint / grid)?, joint + grid));
        }
        for &(pieces, to) in &by_own {
            if pieces == count + 1 && to >= best.grid_point && to > k {
                best = Furthest { grid_point: to, leg: Some((to - grid, false)) };
            }
        }
        by_own.retain(|(pieces, _)| *pieces > count + 1);
        furthest.push(if best.grid_point > k { best } else { Furthest { grid_point: k, leg: None } });
        if best.grid_point == last {
            return trace_back(&furthest, reaches).map(Some);
        }
    }
    Ok(None)
}

/// Follows the legs back from the end.
fn trace_back(furthest: &[Furthest], reaches: &mut Reaches<'_, impl Source, impl FitOwn>) -> Result<Vec<Leg>> {
    let mut legs = Vec::new();
    let mut count = furthest.len() - 1;
    let mut to = reaches.last();
    while to > 0 {
        let Some((from, merged)) = furthest[count].leg else {
            count -= 1;
            continue;
        };
        legs.push(Leg { from, to, merged });
        count -= if merged { 1 } else { reaches.own.count(from / reaches.run.grid)? };
        to = from;
    }
    legs.reverse();
    Ok(legs)
}
