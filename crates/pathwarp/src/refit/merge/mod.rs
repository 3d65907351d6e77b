//! Fewer pieces across smooth joints of the source.
//!
//! A drawing often has more nodes than its shape needs. Smoothly joined segments have one smooth curve as their image, here
//! parametrised by its own length. A search over the places of a grid (the joints, and points between them) finds few cubics
//! that cover this curve (`search`), each extended as far as it reaches (`reach`). They are used only if they are fewer than
//! the segments' own pieces and every one has passed a check by samples in each of its segments or, if proofs are wanted, has
//! been proven segment by segment.

mod carry;
mod check;
mod cubic;
mod leg;
mod limits;
mod own;
mod proven;
mod reach;
mod repeats;
mod run;
mod search;

use super::gather;
use super::options::Options;
use super::piece::FittedPiece;
use super::proof::RationalForm;
use super::report::{Assurance, PathReport};
use super::segment::SegmentFitter;
use super::source::SourceCurve;
use crate::map::{Jet, Map};
use crate::outline::Seg;
use carry::{Carried, Site};
use kurbo::{Point, Vec2};
use leg::Leg;
use limits::{CLEAR_DERIVATIVE, MAX_RUN, MERGE_GRID, MERGE_SEARCHES, MERGE_SHARE, SMOOTH_JOINT, SURE_CORNER};
use own::OwnPieces;
use reach::{ReachMemory, Reaches};
pub(super) use repeats::Shapes;
use repeats::{CarriedWay, Repeats, Way};
use run::{RunSegment, SegmentRun};
use search::fewest_legs;
use std::sync::Arc;

/// Work of a trial with its share of the checks, in evaluations of the map. The samples themselves are fewer.
const TRIAL_WORK: f64 = 40.0;

/// What outlasts a subpath.
#[derive(Default)]
pub(super) struct MergeMemory {
    repeats: Repeats,
    reach: ReachMemory,
}

impl MergeMemory {
    /// Begins with the shapes of other paths.
    pub(super) fn new(known: Arc<Shapes>) -> Self {
        Self { repeats: Repeats::new(known), ..Self::default() }
    }

    /// The shapes it began with.
    pub(super) fn known(&self) -> Arc<Shapes> {
        Arc::clone(&self.repeats.known)
    }

    /// The shapes of the runs so far.
    pub(super) fn into_shapes(self) -> Shapes {
        self.repeats.own
    }
}

/// Merges the pieces of consecutive segments.
pub(super) struct Merger<'a> {
    fitter: &'a SegmentFitter<'a>,
    segs: &'a [Seg],
    /// At the ends of each segment.
    jets: &'a [[Jet; 2]],
    pieces: Vec<FittedPiece>,
    report: PathReport,
    memory: &'a mut MergeMemory,
}

/// Returns `false` if the images of two consecutive segments certainly form a corner, given the map's jet where they meet.
#[inline]
pub(super) fn may_be_smooth(before: &Seg, after: &Seg, jet: &Jet) -> bool {
    let (v, w) = (before.deriv(1.0), after.deriv(0.0));
    let (into, away) = (jet.push(v), jet.push(w));
    // One-sided tangents decide where a derivative vanishes or nearly does.
    let scale = CLEAR_DERIVATIVE * CLEAR_DERIVATIVE * (jet.dx.hypot2() + jet.dy.hypot2());
    let clear = |d: Vec2, seg: &Seg| d.hypot2() > scale * seg.end().distance_squared(seg.start());
    let (dot, cross) = (into.dot(away), into.cross(away).abs());
    dot > 0.0 && cross <= SURE_CORNER * dot || !clear(into, before) || !clear(away, after)
}

/// Announces the samples of all segments of `runs` that may be merged, and the places where pieces may end, to a map that prefers
/// batches and knows the jets at the joints.
pub(super) fn announce(runs: &[&[Seg]], map: &dyn Map, options: &Options) {
    let mut sources = Vec::new();
    for segs in runs {
        let smooth = |i: usize| match (i.checked_sub(1).and_then(|i| segs.get(i)), segs.get(i)) {
            (Some(before), Some(after)) => may_be_smooth(before, after, &map.jet(after.start())),
            _ => false,
        };
        let in_run = |(i, seg): (usize, &'_ Seg)| (smooth(i) || smooth(i + 1)).then_some(*seg);
        sources.extend(segs.iter().enumerate().filter_map(in_run));
    }
    let sources: Vec<_> = sources.iter().map(|seg| SourceCurve::for_proof(seg, map, options.certify)).collect();
    let lanes = SegmentRun::new(map.rational_degree().is_some(), 0).lanes();
    let ends = (1..MERGE_GRID).map(|k| k as f64 / MERGE_GRID as f64);
    gather::announce_all(map, &sources, &lanes, &ends);
}

impl<'a> Merger<'a> {
    pub(super) fn new(
        fitter: &'a SegmentFitter<'a>,
        segs: &'a [Seg],
        jets: &'a [[Jet; 2]],
        memory: &'a mut MergeMemory,
    ) -> Self {
        memory.reach.last_reach = 0;
        Self { fitter, segs, jets, pieces: Vec::with_capacity(segs.len()), report: PathReport::default(), memory }
    }

    /// The pieces of all segments, merged where that saves some. `smooth[i]` is `false` if the image has a corner where segment i
    /// begins.
    pub(super) fn merged(mut self, smooth: &[bool]) -> Result<(Vec<FittedPiece>, PathReport), Point> {
        let mut i = 0;
        while i < self.segs.len() {
            let joined = smooth[i + 1..].iter().take(MAX_RUN - 1).take_while(|s| **s).count();
            i += if joined > 0 { self.joined(i, i + joined + 1)? } else { self.single(i)? };
        }
        Ok((self.pieces, self.report))
    }

    /// Appends the pieces of a segment that cannot be in a run, and returns 1.
    fn single(&mut self, i: usize) -> Result<usize, Point> {
        let [first, last] = &self.jets[i];
        self.fitter.fit(&self.segs[i], [first, last], &mut self.pieces, &mut self.report)?;
        Ok(1)
    }

    /// Appends the pieces of the first segments from `start` up to `end`, whose joints may be smooth, and returns how many they are.
    fn joined(&mut self, start: usize, end: usize) -> Result<usize, Point> {
        // The whole path is refused then.
        if self.fitter.options.budget.left() <= 0.0 {
            return self.single(start);
        }
        let (shape, off) = self.memory.repeats.shape(&self.segs[start..end], self.fitter.options.tolerance);
        if let Some(segments) = self.carried((shape, off), start, end)? {
            return Ok(segments);
        }
        let run = self.run(start, end)?;
        if run.segments.len() < 2 {
            return self.single(start);
        }
        self.merge(&run, start, (shape, off))?;
        Ok(run.segments.len())
    }

    fn site(&self, start: usize, end: usize) -> Site<'a> {
        Site { fitter: self.fitter, segs: &self.segs[start..end], jets: &self.jets[start..end] }
    }

    /// Appends the pieces of a run whose cubics were found at another site, and returns the number of its segments. `None` if there
    /// are none or they may not suffice here.
    fn carried(&mut self, (shape, off): (usize, f64), start: usize, end: usize) -> Result<Option<usize>, Point> {
        if !self.site(start, end).carries() {
            return Ok(None);
        }
        let [jet, _] = &self.jets[start];
        let magnified = (jet.dx.hypot2() + jet.dy.hypot2()).sqrt();
        for (way, other) in self.memory.repeats.nearest(shape, jet) {
            // The curves differ by at most √2 of this before the map, which may magnify more further on.
            let unlike = 2.0 * magnified * (off + other);
            let tolerance = MERGE_SHARE * self.fitter.options.tolerance - unlike;
            let site = self.site(start, start + way.segments);
            if site.segs.iter().any(|s| self.fitter.options.shared.contains(s)) {
                continue;
            }
            let piece = |(leg, cubic): &(Leg, Option<Carried>)| {
                let piece = if leg.merged { cubic.as_ref()?.at(&site, *leg, tolerance) } else { None };
                let piece = piece.map(|(piece, error)| (piece, error + unlike));
                (piece.is_some() || !leg.merged).then_some((*leg, piece))
            };
            let legs = match &way.legs {
                None => None,
                Some(legs) => match legs.iter().map(piece).collect::<Option<Vec<PassedLeg>>>() {
                    None => continue,
                    found => found,
                },
            };
            let mut own = OwnPieces::new(site);
            if count(&mut own, legs.as_deref())? <= way.pieces {
                let segments = way.segments;
                append(legs, &mut own, &mut self.pieces, &mut self.report)?;
                return Ok(Some(segments));
            }
        }
        Ok(None)
    }

    /// The longest run of smoothly joined segments from `start` up to `end`.
    fn run(&self, start: usize, end: usize) -> Result<SegmentRun<'a>, Point> {
        let mut run = SegmentRun::new(self.fitter.degree.is_some(), end - start);
        for i in start..end {
            if self.fitter.options.shared.contains(&self.segs[i]) {
                break;
            }
            let Some(segment) = self.run_segment(i) else { break };
            let turn = |last: &RunSegment<'_>| {
                let (into, away) = (last.to.into, segment.from.away);
                into.cross(away).atan2(into.dot(away)).abs()
            };
            if run.segments.last().is_some_and(|last| turn(last) > SMOOTH_JOINT) || !run.push(segment)? {
                break;
            }
        }
        Ok(run)
    }

    /// A segment of a run. `None` if it cannot be in one, be it that nothing could be proven about it.
    fn run_segment(&self, i: usize) -> Option<RunSegment<'a>> {
        let SegmentFitter { map, degree, options, .. } = *self.fitter;
        let source = SourceCurve::for_proof(&self.segs[i], map, options.certify);
        let form = if options.certify { Some(RationalForm::new(&source, degree)?) } else { None };
        RunSegment::new(source, form, &self.jets[i])
    }

    /// Appends the fewest pieces for a run that begins with segment `start`.
    fn merge(&mut self, run: &SegmentRun<'a>, start: usize, (shape, off): (usize, f64)) -> Result<(), Point> {
        let segments = run.segments.len();
        let (site, options) = (self.site(start, start + segments), self.fitter.options);
        let own = OwnPieces::new(site);
        let proof = options.certify.then_some(options.tolerance);
        let MergeMemory { repeats, reach } = &mut *self.memory;
        let again = repeats.comes_again(shape);
        let mut reaches = Reaches::new(run, own, MERGE_SHARE * options.tolerance, proof, again, reach);
        let ways = repeats.ways(shape);
        let legs = match repeated(ways.iter().filter(|w| w.segments == segments), &mut reaches)? {
            Some(legs) => legs,
            None => {
                let legs = passed(&mut reaches)?;
                let pieces = count(&mut reaches.own, legs.as_deref())?;
                let found = legs.as_ref().map(|legs| legs.iter().map(|(leg, _)| *leg).collect());
                repeats.add(shape, Way { segments, legs: found, pieces });
                legs
            }
        };
        if site.carries() {
            let pieces = count(&mut reaches.own, legs.as_deref())?;
            let legs = legs.as_ref().map(|legs| legs.iter().map(|(leg, _)| (*leg, reaches.carried(*leg))).collect());
            let Jet { dx, dy, .. } = site.jets[0][0];
            repeats.carry(shape, CarriedWay { jacobian: [dx, dy], off, segments, pieces, legs });
        }
        self.fitter.spend(TRIAL_WORK * reaches.tried() as f64);
        let Reaches { mut own, .. } = reaches;
        append(legs, &mut own, &mut self.pieces, &mut self.report)
    }
}

/// Appends the pieces of a way; without one, the segments' own.
fn append(
    legs: Option<Vec<PassedLeg>>,
    own: &mut OwnPieces<'_>,
    pieces: &mut Vec<FittedPiece>,
    report: &mut PathReport,
) -> Result<(), Point> {
    let assurance = if own.site.fitter.options.certify { Assurance::Certified } else { Assurance::Checked };
    let Some(legs) = legs else { return (0..own.segments()).try_for_each(|i| own.append(i, pieces, report)) };
    for (leg, piece) in legs {
        if let Some((piece, error)) = piece {
            report.add_error(error, assurance);
            pieces.push(piece);
        } else {
            own.append(leg.from / MERGE_GRID, pieces, report)?;
        }
    }
    Ok(())
}

/// A leg with its piece and that one's error, if it is merged.
type PassedLeg = (Leg, Option<(FittedPiece, f64)>);

/// The first of the ways for other runs of the same shape that takes no more pieces here. The inner `None` stands for the segments' own.
fn repeated<'w>(
    ways: impl Iterator<Item = &'w Way>,
    reaches: &mut Reaches<'_, '_>,
) -> Result<Option<Option<Vec<PassedLeg>>>, Point> {
    for way in ways {
        let legs = match &way.legs {
            None => None,
            Some(legs) => match pieces_of(reaches, legs)? {
                None => continue,
                found => found,
            },
        };
        if count(&mut reaches.own, legs.as_deref())? <= way.pieces {
            return Ok(Some(legs));
        }
    }
    Ok(None)
}

/// Number of pieces that a way takes; without one, of the segments' own.
fn count(own: &mut OwnPieces<'_>, legs: Option<&[PassedLeg]>) -> Result<usize, Point> {
    let Some(legs) = legs else { return own.total() };
    legs.iter().map(|(leg, _)| if leg.merged { Ok(1) } else { own.count(leg.from / MERGE_GRID) }).sum()
}

/// The legs with their pieces. `None` if one of them does not pass its check.
fn pieces_of(reaches: &mut Reaches<'_, '_>, legs: &[Leg]) -> Result<Option<Vec<PassedLeg>>, Point> {
    let mut out = Vec::with_capacity(legs.len());
    for leg in legs {
        let piece = if leg.merged { reaches.piece(leg.from, leg.to)? } else { None };
        if piece.is_some() || !leg.merged {
            out.push((*leg, piece));
        }
    }
    Ok((out.len() == legs.len()).then_some(out))
}

/// The way with the fewest pieces, all of which have passed their check. `None` if they are not fewer than the segments have.
fn passed(reaches: &mut Reaches<'_, '_>) -> Result<Option<Vec<PassedLeg>>, Point> {
    for _ in 0..MERGE_SEARCHES {
        let Some(legs) = fewest_legs(reaches)? else { return Ok(None) };
        // A piece that fails is left out of the next search.
        if let Some(out) = pieces_of(reaches, &legs)? {
            return Ok(Some(out));
        }
    }
    Ok(None)
}
