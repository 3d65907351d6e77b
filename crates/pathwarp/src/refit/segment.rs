//! One segment: its canonical direction, its smooth parts, and their pieces.

use super::limits::{MAX_RATIONAL_SWEEP, POINT_SIZE, TEAR};
use super::options::Options;
use super::report::reverse;
use super::source::SourceCurve;
use super::split;
use crate::budget::Limit;
use crate::map::{Class, Creases, Jet, Map, RationalDegree};
use crate::outline::{EllipticArc, Seg};
use bezierfit::parts::StretchFitter;
use bezierfit::{BreakPoint, NotFinite, Piece, Report, SlowSpots, Source};
use kurbo::{CubicBez, Line, Point};
use std::sync::Arc;

/// Creases of one segment that are found by comparing branches with the map.
const MAX_FOUND: usize = 16;

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
    /// Appends the image of one segment, given the jets at its ends. `Err`: a place at which the map is not finite.
    pub(super) fn fit(
        &self,
        seg: &Seg,
        jets: [&Jet; 2],
        pieces: &mut Vec<Piece>,
        report: &mut Report,
    ) -> Result<(), NotFinite> {
        if self.projective && matches!(seg, Seg::Line(_)) {
            pieces.push(Piece::Line(Line::new(jets[0].p, jets[1].p)));
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
        pieces: &mut Vec<Piece>,
        report: &mut Report,
    ) -> Result<(), NotFinite> {
        let n = (arc.sweep.abs() / MAX_RATIONAL_SWEEP).ceil();
        let mut from = *first;
        for i in 0..n as usize {
            let part = arc.subsegment(i as f64 / n, (i + 1) as f64 / n);
            let to = if i + 1 == n as usize { *last } else { self.map.jet(part.p1) };
            if !to.is_finite() {
                return Err(NotFinite { t: (i + 1) as f64 / n, at: part.p1 });
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
        pieces: &mut Vec<Piece>,
        report: &mut Report,
    ) -> Result<(), NotFinite> {
        if self.options.budget.left(Limit::Evaluations) <= 0.0 {
            pieces.push(Piece::Line(Line::new(jets[0].p, jets[1].p)));
            return Ok(());
        }
        let certify = self.options.certify;
        let source = SourceCurve::for_proof(seg, self.map, self.degree, certify);
        if source.size() <= POINT_SIZE * (seg.start().to_vec2().hypot() + seg.end().to_vec2().hypot()) {
            // A segment of no length is kept, as it carries line caps and markers; it has no direction to preserve.
            pieces.push(Piece::Line(Line::new(jets[0].p, jets[1].p)));
            return Ok(());
        }
        let mut slow = split::slow_spots(seg);
        if source.is_rational() {
            slow = slow.map(|t| source.param(t));
        }
        if self.creases.items().is_empty() {
            let from = source.end_with(0.0, jets[0].p, jets[0]);
            let to = source.end_with(1.0, jets[1].p, jets[1]);
            return self.cover(&source, 0.0, &slow, [&from, &to], pieces, report);
        }
        self.fit_parts(&source, jets, &slow, pieces, report)
    }

    /// Counts work. Too much of it is an error of the whole path, which ends by itself: `fit` does no more.
    pub(super) fn spend(&self, evaluations: f64) {
        let _ = self.options.budget.spend(Limit::Evaluations, evaluations as u64);
    }

    /// Covers a smooth part, whose ends are at most `blur` from the source's image.
    #[inline(always)]
    fn cover(
        &self,
        source: &SourceCurve<'_>,
        blur: f64,
        slow: &SlowSpots,
        [from, to]: [&BreakPoint; 2],
        pieces: &mut Vec<Piece>,
        report: &mut Report,
    ) -> Result<(), NotFinite> {
        let left = self.options.budget.left(Limit::Evaluations) / self.work;
        let (tolerance, prove) = (self.options.tolerance, (self.options.certify, blur));
        let mut fitter = StretchFitter::new(source, slow, tolerance, prove, left);
        let covered = fitter.cover(from, to, pieces, report);
        self.spend(fitter.evaluations() as f64 * self.work);
        covered
    }

    /// Splits a segment at the map's creases and covers each part under the branch of the map that holds there.
    #[inline(never)]
    fn fit_parts(
        &self,
        whole: &SourceCurve<'_>,
        jets: [&Jet; 2],
        slow: &SlowSpots,
        pieces: &mut Vec<Piece>,
        report: &mut Report,
    ) -> Result<(), NotFinite> {
        let (seg, map) = (whole.seg, self.map);
        self.spend(self.creases.splits_work(seg, self.work));
        let mut ends = self.creases.splits(seg);
        ends.push(1.0);
        ends.reverse();
        let mut found = 0;
        let mut from = Node { t: 0.0, u: 0.0, p: jets[0].p, jet: Some(jets[0]) };
        while let Some(&t) = ends.last() {
            let u = if t == 1.0 { 1.0 } else { whole.param(t) };
            let branch = match self.branch_between(seg, from.t, t) {
                Ok(b) => b,
                // A crease that the map does not tell, or that was missed.
                Err(at) if found < MAX_FOUND => {
                    found += 1;
                    ends.push(from.t + (t - from.t) * at);
                    continue;
                }
                Err(_) => map.branch(seg.eval(0.5 * (from.t + t))),
            };
            ends.pop();
            let to = match t == 1.0 {
                false => Node { t, u, p: map.point(seg.eval(t)), jet: None },
                true => Node { t, u, p: jets[1].p, jet: Some(jets[1]) },
            };
            if let Some(Class::Affine(m)) = branch.as_ref().map(Map::class)
                && let Some(part) = seg.part(from.t, to.t)
            {
                affine_part(&part.transformed(m), from.p, to.p, self.options.tolerance, pieces);
            } else {
                let inside;
                let source = match &branch {
                    None => whole,
                    Some(b) => {
                        inside = SourceCurve::for_proof(seg, b, b.rational_degree(), self.options.certify);
                        &inside
                    }
                };
                self.fit_part(source, branch.is_some(), [&from, &to], slow, pieces, report)?;
            }
            from = to;
        }
        Ok(())
    }

    /// The branch that is the map between two parameters: that of a point inside, confirmed at others. `Err`: where, as a share of
    /// the way, another branch begins.
    fn branch_between(&self, seg: &Seg, from: f64, to: f64) -> Result<Option<Arc<dyn Map>>, f64> {
        /// Places that symmetrical artwork avoids, the one near the middle first.
        const PROBES: [f64; 5] = [0.483_7, 0.211_3, 0.788_9, 0.061_1, 0.939_1];
        let place = |s: f64| seg.eval(from + (to - from) * s);
        let at = PROBES.map(place);
        let Some(first) = self.map.branch(at[0]) else { return Ok(None) };
        let mut images = [[Point::ORIGIN; PROBES.len()]; 2];
        self.map.points(&at, &mut images[0]);
        let near = |p: Point, q: Point| {
            let far = p.distance(q);
            // Where the map is not finite, the fit says so.
            !(far > TEAR * self.options.tolerance && far > 1e-11 * p.to_vec2().hypot())
        };
        let mut agrees = |b: &Arc<dyn Map>| {
            b.points(&at, &mut images[1]);
            (0..PROBES.len()).find(|&i| !near(images[0][i], images[1][i]))
        };
        let Some(off) = agrees(&first) else { return Ok(Some(first)) };
        let other = self.map.branch(at[off]).filter(|b| agrees(b).is_none());
        if other.is_some() {
            return Ok(other);
        }
        let (mut inside, mut outside) = (PROBES[0], PROBES[off]);
        while (inside - outside).abs() > 1e-12 {
            let mid = 0.5 * (inside + outside);
            let p = place(mid);
            *if near(self.map.point(p), first.point(p)) { &mut inside } else { &mut outside } = mid;
        }
        Err(inside)
    }

    /// Covers the part between two nodes. If the map tears at a node, a line connects the node to the branch's own value.
    fn fit_part(
        &self,
        source: &SourceCurve<'_>,
        on_branch: bool,
        nodes: [&Node<'_>; 2],
        slow: &SlowSpots,
        pieces: &mut Vec<Piece>,
        report: &mut Report,
    ) -> Result<(), NotFinite> {
        let mut blur = 0.0f64;
        let mut end = |node: &Node<'_>| -> Result<(BreakPoint, bool), NotFinite> {
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
            pieces.push(Piece::Line(Line::new(nodes[0].p, e0.p)));
        }
        self.cover(source, blur, slow, [&e0, &e1], pieces, report)?;
        if torn1 {
            pieces.push(Piece::Line(Line::new(e1.p, nodes[1].p)));
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
fn affine_part(part: &Seg, from: Point, to: Point, tolerance: f64, pieces: &mut Vec<Piece>) {
    let near = |a: Point, b: Point| a.distance(b) <= TEAR * tolerance;
    let (a, b) = (part.start(), part.end());
    if !near(a, from) {
        pieces.push(Piece::Line(Line::new(from, a)));
    }
    let (p0, p3) = (if near(a, from) { from } else { a }, if near(b, to) { to } else { b });
    pieces.push(match part {
        Seg::Line(_) => Piece::Line(Line::new(p0, p3)),
        other => Piece::Cubic(CubicBez { p0, p3, ..other.to_cubic() }),
    });
    if !near(b, to) {
        pieces.push(Piece::Line(Line::new(b, to)));
    }
}
