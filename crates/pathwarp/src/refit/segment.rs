//! One segment: its canonical direction, its smooth parts, and their pieces.

use super::check::THOROUGH_WORK;
use super::limits::{MAX_ATTEMPTS, MAX_RATIONAL_SWEEP, POINT_SIZE, TEAR};
use super::options::Options;
use super::piece::{FittedPiece, reverse};
use super::proof::RationalForm;
use super::report::PathReport;
use super::source::{BreakPoint, SourceCurve};
use super::split::{self, SlowSpots};
use super::stretch::StretchFitter;
use crate::budget::Limit;
use crate::map::{Class, Creases, Jet, Map, RationalDegree};
use crate::outline::{EllipticArc, Seg};
use kurbo::{CubicBez, Line, Point};
use std::cell::Cell;

/// Evaluations of the map for an attempt at a piece with its usual checks.
const EVALUATIONS: usize = 32;

/// A part with more attempts may be one where the map oscillates faster than samples can tell, so that most need the thorough check:
/// fewer are allowed from there on.
const HARD: usize = 64;

/// Fits the images of single segments.
pub(super) struct SegmentFitter<'a> {
    pub(super) map: &'a dyn Map,
    /// The map keeps lines.
    pub(super) projective: bool,
    /// The map's degree, if it is a quotient of polynomials.
    pub(super) degree: Option<RationalDegree>,
    pub(super) creases: &'a Creases,
    /// The map's [`work`](Map::work).
    pub(super) work: f64,
    pub(super) options: &'a Options,
}

impl SegmentFitter<'_> {
    /// Appends the image of one segment, given the jets at its ends. `Err`: a point at which the map is not finite.
    pub(super) fn fit(
        &self,
        seg: &Seg,
        jets: [&Jet; 2],
        pieces: &mut Vec<FittedPiece>,
        report: &mut PathReport,
    ) -> Result<(), Point> {
        if self.projective && matches!(seg, Seg::Line(_)) {
            pieces.push(FittedPiece::Line(Line::new(jets[0].p, jets[1].p)));
            return Ok(());
        }
        let reversed;
        let flipped = split::is_backwards(seg);
        let canonical = if flipped {
            reversed = seg.reversed();
            &reversed
        } else {
            seg
        };
        let [first, last] = if flipped { [jets[1], jets[0]] } else { jets };
        let start = pieces.len();
        match canonical {
            Seg::Arc(a) if self.options.certify && a.sweep.abs() > MAX_RATIONAL_SWEEP && self.degree.is_some() => {
                self.fit_long_arc(a, [first, last], pieces, report)?;
            }
            _ => self.fit_canonical(canonical, [first, last], pieces, report)?,
        }
        if flipped {
            reverse(&mut pieces[start..]);
        }
        Ok(())
    }

    /// Cuts an arc for a proof: only arcs of less than half a turn are quotients of polynomials with positive denominators.
    fn fit_long_arc(
        &self,
        arc: &EllipticArc,
        [first, last]: [&Jet; 2],
        pieces: &mut Vec<FittedPiece>,
        report: &mut PathReport,
    ) -> Result<(), Point> {
        let n = (arc.sweep.abs() / MAX_RATIONAL_SWEEP).ceil();
        let mut from = *first;
        for i in 0..n as usize {
            let part = arc.subsegment(i as f64 / n, (i + 1) as f64 / n);
            let to = if i + 1 == n as usize { *last } else { self.map.jet(part.p1) };
            if !to.is_finite() {
                return Err(part.p1);
            }
            self.fit_canonical(&Seg::Arc(part), [&from, &to], pieces, report)?;
            from = to;
        }
        Ok(())
    }

    /// Appends the image of a segment in its canonical direction.
    fn fit_canonical(
        &self,
        seg: &Seg,
        jets: [&Jet; 2],
        pieces: &mut Vec<FittedPiece>,
        report: &mut PathReport,
    ) -> Result<(), Point> {
        if self.options.budget.left(Limit::Evaluations) <= 0.0 {
            pieces.push(FittedPiece::Line(Line::new(jets[0].p, jets[1].p)));
            return Ok(());
        }
        let certify = self.options.certify;
        let mut source = SourceCurve::new(seg, self.map);
        if certify {
            source.make_rational();
        }
        if source.size() <= POINT_SIZE * (seg.start().to_vec2().hypot() + seg.end().to_vec2().hypot()) {
            // A segment of no length is kept, as it carries line caps and markers; it has no direction to preserve.
            pieces.push(FittedPiece::Line(Line::new(jets[0].p, jets[1].p)));
            return Ok(());
        }
        let mut slow = split::slow_spots(seg);
        if source.is_rational() {
            slow = slow.map(|t| source.param(t));
        }
        if self.creases.items().is_empty() {
            let from = source.end_with(0.0, jets[0].p, jets[0]);
            let to = source.end_with(1.0, jets[1].p, jets[1]);
            return self.cover(&source, self.degree, 0.0, &slow, [&from, &to], pieces, report);
        }
        self.fit_parts(&source, jets, &slow, pieces, report)
    }

    /// The attempts after which this part ends: those that exceed the budget by themselves, so that the result does not depend on
    /// what other threads count at the same time.
    fn most_attempts(&self) -> usize {
        let left = self.options.budget.left(Limit::Evaluations) / self.work;
        let (usual, hard) = (left / EVALUATIONS as f64, left / THOROUGH_WORK as f64);
        let most = if usual < HARD as f64 { usual } else { hard.max(HARD as f64) };
        MAX_ATTEMPTS.min((most as usize).saturating_add(1))
    }

    /// Counts work. Too much of it is an error of the whole path, which ends by itself: `fit` does no more.
    pub(super) fn spend(&self, evaluations: f64) {
        let _ = self.options.budget.spend(Limit::Evaluations, evaluations as u64);
    }

    /// Covers a smooth part, whose ends are at most `blur` from the source's image.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    fn cover(
        &self,
        source: &SourceCurve<'_>,
        degree: Option<RationalDegree>,
        blur: f64,
        slow: &SlowSpots,
        [from, to]: [&BreakPoint; 2],
        pieces: &mut Vec<FittedPiece>,
        report: &mut PathReport,
    ) -> Result<(), Point> {
        let form = if self.options.certify { RationalForm::new(source, degree) } else { None };
        let form = form.map(|f| f.with_blur(blur));
        let degree = degree.filter(|_| blur == 0.0);
        let tolerance = self.options.tolerance;
        let (most_attempts, extra) = (self.most_attempts(), Cell::new(0));
        let mut fitter = StretchFitter { source, slow, tolerance, form, degree, attempts: 0, extra, most_attempts };
        let covered = fitter.cover(from, to, pieces, report);
        let each = if fitter.attempts > HARD { THOROUGH_WORK } else { EVALUATIONS };
        let checked = fitter.attempts * EVALUATIONS + fitter.extra.get();
        self.spend((fitter.attempts * each).max(checked) as f64 * self.work);
        covered
    }

    /// Splits a segment at the map's creases and covers each part under the branch of the map that holds there.
    #[inline(never)]
    fn fit_parts(
        &self,
        whole: &SourceCurve<'_>,
        jets: [&Jet; 2],
        slow: &SlowSpots,
        pieces: &mut Vec<FittedPiece>,
        report: &mut PathReport,
    ) -> Result<(), Point> {
        let (seg, map) = (whole.seg, self.map);
        self.spend(self.creases.splits_work(seg, self.work));
        let splits = self.creases.splits(seg);
        let mut from = Node { t: 0.0, u: 0.0, p: jets[0].p, jet: Some(jets[0]) };
        for i in 0..=splits.len() {
            let to = match splits.get(i) {
                Some(&t) => Node { t, u: whole.param(t), p: map.jet(seg.eval(t)).p, jet: None },
                None => Node { t: 1.0, u: 1.0, p: jets[1].p, jet: Some(jets[1]) },
            };
            let branch = map.branch(whole.at(0.5 * (from.u + to.u)));
            if let Some(Class::Affine(m)) = branch.as_ref().map(Map::class)
                && let Some(part) = seg.part(from.t, to.t)
            {
                affine_part(&part.transformed(m), from.p, to.p, self.options.tolerance, pieces);
            } else {
                let inside;
                let source = match &branch {
                    None => whole,
                    Some(b) => {
                        inside = SourceCurve::for_proof(seg, b, self.options.certify);
                        &inside
                    }
                };
                self.fit_part(source, branch.is_some(), [&from, &to], slow, pieces, report)?;
            }
            from = to;
        }
        Ok(())
    }

    /// Covers the part between two nodes. If the map tears at a node, a line connects the node to the branch's own value.
    fn fit_part(
        &self,
        source: &SourceCurve<'_>,
        on_branch: bool,
        nodes: [&Node<'_>; 2],
        slow: &SlowSpots,
        pieces: &mut Vec<FittedPiece>,
        report: &mut PathReport,
    ) -> Result<(), Point> {
        let mut blur = 0.0f64;
        let mut end = |node: &Node<'_>| -> Result<(BreakPoint, bool), Point> {
            if let (false, Some(jet)) = (on_branch, node.jet) {
                return Ok((source.end_with(node.u, node.p, jet), false));
            }
            let own = source.end(node.u)?;
            let off = own.p.distance(node.p);
            if off > TEAR * self.options.tolerance {
                return Ok((own, true));
            }
            blur = blur.max(off);
            Ok((BreakPoint { p: node.p, ..own }, false))
        };
        let ((e0, torn0), (e1, torn1)) = (end(nodes[0])?, end(nodes[1])?);
        if torn0 {
            pieces.push(FittedPiece::Line(Line::new(nodes[0].p, e0.p)));
        }
        self.cover(source, source.map.rational_degree(), blur, slow, [&e0, &e1], pieces, report)?;
        if torn1 {
            pieces.push(FittedPiece::Line(Line::new(e1.p, nodes[1].p)));
        }
        Ok(())
    }
}

/// An end of a smooth part, whose image the neighbouring part shares bit by bit.
struct Node<'a> {
    /// Parameter of the segment, and of the curve.
    t: f64,
    u: f64,
    p: Point,
    /// The map's jet, at the ends of the segment.
    jet: Option<&'a Jet>,
}

/// Appends a part that an affine branch moves exactly, between the nodes it shares with its neighbours.
fn affine_part(part: &Seg, from: Point, to: Point, tolerance: f64, pieces: &mut Vec<FittedPiece>) {
    let near = |a: Point, b: Point| a.distance(b) <= TEAR * tolerance;
    let (a, b) = (part.start(), part.end());
    if !near(a, from) {
        pieces.push(FittedPiece::Line(Line::new(from, a)));
    }
    let (p0, p3) = (if near(a, from) { from } else { a }, if near(b, to) { to } else { b });
    pieces.push(match part {
        Seg::Line(_) => FittedPiece::Line(Line::new(p0, p3)),
        other => FittedPiece::Cubic(CubicBez { p0, p3, ..other.to_cubic() }),
    });
    if !near(b, to) {
        pieces.push(FittedPiece::Line(Line::new(b, to)));
    }
}
