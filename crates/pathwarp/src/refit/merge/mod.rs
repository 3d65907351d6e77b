//! Fewer pieces across smooth joints of the source.
//!
//! A drawing often has more nodes than its shape needs. Smoothly joined segments have one smooth curve as their image, here
//! parametrised by its own length. A search over the places of a grid (the joints, and points between them) finds few cubics
//! that cover this curve (`search`), each extended as far as it reaches (`reach`). They are used only if they are fewer than
//! the segments' own pieces and every one has passed a check by samples in each of its segments or, if proofs are wanted, has
//! been proven segment by segment.

mod check;
mod cubic;
mod proven;
mod reach;
mod run;
mod search;

use super::limits::{CLEAR_DERIVATIVE, MAX_RUN, MERGE_GRID, MERGE_SEARCHES, MERGE_SHARE, SMOOTH_JOINT, SURE_CORNER};
use super::options::Options;
use super::piece::FittedPiece;
use super::proof::RationalForm;
use super::report::{Assurance, PathReport};
use super::source::SourceCurve;
use crate::map::{Jet, Map, RationalDegree};
use crate::outline::Seg;
use kurbo::{Point, Vec2};
use reach::Reaches;
use run::{RunSegment, SegmentRun};
use search::{Leg, fewest_legs};

/// Merges the pieces of one subpath.
pub(super) struct Merger<'a> {
    pub(super) map: &'a dyn Map,
    /// The map's degree, if it is a quotient of polynomials.
    pub(super) degree: Option<RationalDegree>,
    pub(super) options: &'a Options,
}

/// The segments of a subpath, each with its own pieces.
pub(super) struct FittedSegments<'a> {
    pub(super) segs: &'a [Seg],
    /// `smooth[i]` is `false` if the image has a corner where segment i begins.
    pub(super) smooth: &'a [bool],
    pub(super) pieces: &'a [FittedPiece],
    /// `bounds[i]..bounds[i + 1]` are the pieces of segment i.
    pub(super) bounds: &'a [usize],
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

impl Merger<'_> {
    /// The pieces of all segments, merged where that saves some.
    pub(super) fn merged(
        &self,
        fitted: &FittedSegments<'_>,
        report: &mut PathReport,
    ) -> Result<Vec<FittedPiece>, Point> {
        let FittedSegments { segs, smooth, pieces, bounds } = *fitted;
        let mut out = Vec::with_capacity(pieces.len());
        let mut i = 0;
        while i < segs.len() {
            let joined = smooth[i + 1..].iter().take(MAX_RUN - 1).take_while(|s| **s).count();
            let run = self.run(if joined > 0 { &segs[i..=i + joined] } else { &[] })?;
            // A segment that cannot be in a run keeps its pieces.
            let end = i + run.segments.len().max(1);
            let own = &pieces[bounds[i]..bounds[end]];
            let better = if end - i > 1 { self.fewest(&run, pieces, &bounds[i..=end])? } else { None };
            match better {
                Some((merged, error)) => {
                    let assurance = if self.options.certify { Assurance::Certified } else { Assurance::Checked };
                    report.add_error(error, assurance);
                    out.extend_from_slice(&merged);
                }
                None => out.extend_from_slice(own),
            }
            i = end;
        }
        Ok(out)
    }

    /// The longest run of smoothly joined segments at the start of `segs`.
    fn run<'s>(&self, segs: &'s [Seg]) -> Result<SegmentRun<'s>, Point>
    where
        Self: 's,
    {
        let mut run = SegmentRun::new(self.degree.is_some());
        for seg in segs {
            if self.options.shared.contains(seg) {
                break;
            }
            let Some(segment) = self.run_segment(seg)? else { break };
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
    fn run_segment<'s>(&self, seg: &'s Seg) -> Result<Option<RunSegment<'s>>, Point>
    where
        Self: 's,
    {
        let certify = self.options.certify;
        let source = SourceCurve::for_proof(seg, self.map, certify);
        let form = if certify { RationalForm::new(&source, self.degree) } else { None };
        if certify && form.is_none() { Ok(None) } else { RunSegment::new(source, form) }
    }

    /// The fewest pieces for a run, and their largest error. `None` if they are not fewer than its segments have.
    fn fewest(
        &self,
        run: &SegmentRun<'_>,
        pieces: &[FittedPiece],
        bounds: &[usize],
    ) -> Result<Option<(Vec<FittedPiece>, f64)>, Point> {
        let tolerance = self.options.tolerance;
        let proof = self.options.certify.then_some(tolerance);
        let mut reaches = Reaches::new(run, bounds, MERGE_SHARE * tolerance, proof);
        for _ in 0..MERGE_SEARCHES {
            let Some(legs) = fewest_legs(&mut reaches)? else { return Ok(None) };
            let (mut out, mut worst) = (Vec::with_capacity(reaches.unmerged()), 0.0f64);
            let mut passed = true;
            for Leg { from, to, merged } in legs {
                if !merged {
                    out.extend_from_slice(&pieces[bounds[from / MERGE_GRID]..bounds[to / MERGE_GRID]]);
                } else if let Some((piece, error)) = reaches.piece(from, to)? {
                    worst = worst.max(error);
                    out.push(piece);
                } else {
                    // It is left out of the next search.
                    passed = false;
                }
            }
            if passed {
                return Ok(Some((out, worst)));
            }
        }
        Ok(None)
    }
}
