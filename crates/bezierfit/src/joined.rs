//! Fewer pieces for consecutive stretches: across smooth joints, and across the pieces of one long curve. Stretches that join smoothly
//! become the segments of a run, whose fewest pieces `merge` searches for.

use crate::limits::{LONG_GRID, LONG_SEGMENT, LONG_STRETCH, LONG_WORK, LONGEST_RUN};
use crate::merge::{FitOwn, MergeSettings, OwnPieces, ReachMemory, Reaches, refined};
use crate::part::Part;
use crate::report::{Piece, Report};
use crate::run::{RunSegment, SegmentRun, sample_lanes};
use crate::source::{BreakPoint, Quotient, Result, Source};
use crate::stretch::StretchFitter;

/// Settings for a search for fewer pieces across smooth joints.
#[derive(Debug, Clone, Copy)]
pub(crate) struct JoinSettings {
    pub(crate) tolerance: f64,
    /// Largest turn of a smooth joint, in radians.
    pub(crate) corner: f64,
    /// Prove errors where possible.
    pub(crate) certify: bool,
    /// Set if each stretch has one piece: new pieces are hardly longer, so that the grid of their ends must be finer.
    pub(crate) finely: bool,
    /// Fit alike from either end.
    pub(crate) evenly: bool,
}

/// A stretch with the pieces that cover it, and their report.
pub(crate) struct Covered<'a, S> {
    pub(crate) part: Part<'a, S>,
    pub(crate) pieces: Vec<Piece>,
    pub(crate) report: Report,
}

impl<'a, S: Source> Covered<'a, S> {
    /// Appends the stretch to a list: piece by piece if it has at least [`LONG_STRETCH`], else as a whole. `joints` are their last ends.
    pub(crate) fn append_to(self, joints: &[BreakPoint], out: &mut Vec<Self>) {
        let Self { part, pieces, report } = self;
        if pieces.len() < LONG_STRETCH || pieces.len() != joints.len() || !report.unresolved.is_empty() {
            out.push(Self { part, pieces, report });
            return;
        }
        let mut from = part.ends[0];
        for ((piece, own), to) in pieces.into_iter().zip(&report.pieces).zip(joints) {
            let mut report = Report::default();
            report.add_error(own.error, own.assurance);
            out.push(Self { part: part.sub_part([from, *to]), pieces: vec![piece], report });
            from = *to;
        }
    }
}

/// Appends the pieces of consecutive stretches, or fewer that cross smooth joints between stretches with at most two pieces.
pub(crate) fn join<S: Source>(
    covered: &[Covered<'_, S>],
    settings: JoinSettings,
    memory: &mut ReachMemory,
    out: &mut Vec<Piece>,
    report: &mut Report,
) -> Result<()> {
    let mut i = 0;
    while let Some(first) = covered.get(i) {
        let usual_length = 8;
        let mut run = SegmentRun::new(first.part.is_simple(), usual_length);
        if settings.finely {
            (run.grid, run.per_segment) = (LONG_GRID, 2 * LONG_GRID);
        }
        let (end, samples) = (covered.len().min(i + LONGEST_RUN), run.per_segment);
        let count = run.extend(&covered[i..end], settings.corner, |Covered { part, pieces, report }| {
            let form = if settings.certify { part.quotient().and_then(Quotient::provable) } else { None };
            let is_line = matches!(pieces[..], [Piece::Line(_)]);
            let is_resolved = || part.resolved([0.0, 1.0], samples, settings.tolerance) != Some(false);
            let joins = pieces.len() <= 2 && report.unresolved.is_empty() && (form.is_some() || is_resolved());
            Ok(joins.then(|| RunSegment::new(*part, form, part.ends, is_line)))
        })?;
        let append_own = |k: usize, pieces: &mut Vec<Piece>, report: &mut Report| {
            pieces.extend(&covered[i + k].pieces);
            report.add(&covered[i + k].report);
            Ok(())
        };
        if count < 2 {
            append_own(0, out, report)?;
        } else {
            let settings = (settings.tolerance, settings.evenly);
            fewest(&run, OwnPieces::new(count, append_own), settings, memory, out, report)?;
        }
        i += count.max(1);
    }
    Ok(())
}

/// Covers a stretch piece by piece, and then with fewer pieces if it takes several and has no slow spots.
///
/// # Errors
/// [`NotFinite`](crate::NotFinite) if the curve is not finite somewhere.
pub fn cover_far<S: Source>(
    fitter: &mut StretchFitter<'_, S>,
    [from, to]: [&BreakPoint; 2],
    corner: f64,
    pieces: &mut Vec<Piece>,
    report: &mut Report,
) -> Result<()> {
    let (start, first) = (pieces.len(), report.pieces.len());
    fitter.cover(from, to, pieces, report)?;
    // Near slow spots, even samples do not suffice; and proofs over several pieces need ends on the curve.
    let count = fitter.joints.len();
    let is_unfit = !fitter.slow.all().is_empty() || fitter.form.as_ref().is_some_and(|f| f.blur > 0.0);
    if count < LONG_SEGMENT || pieces.len() - start != count || is_unfit {
        return Ok(());
    }
    let part = Part::between(fitter.source, [*from, *to]);
    let whole = Covered { part, pieces: pieces.split_off(start), report: report.split_off(first) };
    let mut covered = Vec::with_capacity(count);
    whole.append_to(&fitter.joints, &mut covered);
    let StretchFitter { tolerance, evenly, .. } = *fitter;
    let settings = JoinSettings { tolerance, corner, certify: fitter.form.is_some(), finely: true, evenly };
    fitter.extra.set(fitter.extra.get() + (2 * LONG_GRID + LONG_WORK) * covered.len());
    let lanes = covered.iter().flat_map(|c| sample_lanes(2 * LONG_GRID).map(move |t| (&c.part, t)));
    // The ends are known already.
    Source::announce(&mut { lanes }, &mut std::iter::empty());
    join(&covered, settings, &mut ReachMemory::default(), pieces, report)
}

/// Appends the fewest pieces of a run or, if `evenly`, few that are alike from either end. Returns the number of cubics that were tried.
pub(crate) fn fewest<S: Source + Clone>(
    run: &SegmentRun<S>,
    own: OwnPieces<impl FitOwn>,
    (tolerance, evenly): (f64, bool),
    memory: &mut ReachMemory,
    pieces: &mut Vec<Piece>,
    report: &mut Report,
) -> Result<usize> {
    let proof = run.segments.first().is_some_and(RunSegment::is_provable);
    // No cubics are carried to copies of the shape.
    let settings = MergeSettings { tolerance, proof, marks: false, again: false, evenly };
    let mut reaches = Reaches::new(run, own, settings, memory);
    let legs = match evenly {
        true if run.segments.len() < 2 => None,
        true => reaches.even()?,
        false => reaches.fewest()?,
    };
    let tried = reaches.tried();
    // The search on a finer grid does not keep legs alike from either end.
    let (mut own, legs) = if evenly { (reaches.own, legs) } else { refined(run, reaches.own, legs, settings, memory)? };
    own.append(legs, run.assurance(tolerance), pieces, report)?;
    Ok(tried)
}
