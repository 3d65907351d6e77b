//! Fits a single segment: finds its canonical direction and its smooth parts, and covers each part with pieces.

use super::limits::{MAX_RATIONAL_SWEEP, POINT_SIZE, TEAR};
use super::options::Options;
use super::overview::Overview;
use super::report::reverse;
use super::source::{self, SourceCurve};
use crate::map::{Class, CreaseKind, Creases, Jet, Map, RationalDegree};
use crate::outline::Seg;
use bezierfit::parts::{SMOOTH_JOINT, StretchFitter, cover_far};
use bezierfit::{NotFinite, Piece, Report};
use kurbo::{CubicBez, Line, Point};
use std::sync::Arc;

/// The number of creases of one segment that are found by comparing branches with the map.
const MAX_FOUND: usize = 16;

/// Fits the images of single segments.
pub(super) struct SegmentFitter<'a> {
    pub(super) map: &'a dyn Map,
    /// `true` if the map keeps lines.
    pub(super) projective: bool,
    /// The map's degree, if it is a quotient of polynomials.
    pub(super) degree: Option<RationalDegree>,
    pub(super) creases: &'a Creases,
    /// The map's work per evaluation.
    pub(super) work: f64,
    pub(super) options: &'a Options,
    pub(super) overview: Option<&'a Overview>,
}

impl SegmentFitter<'_> {
    /// Appends the image of one segment, given the jets at its ends. Fails where the map is not finite.
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
        let (canonical, flipped) = source::canonical(seg);
        let [first, last] = if flipped { [jets[1], jets[0]] } else { jets };
        let start = pieces.len();
        if self.creases.items().is_empty() && !self.is_long_arc(seg) {
            let source = SourceCurve::for_proof(&canonical, self.map, self.degree, self.options.certify);
            self.fit_smooth(&source.with_overview(self.overview), [first, last], 0.0, pieces, report)?;
        } else {
            for part in self.cut(&canonical, [first, last])? {
                self.fit_part(&part, pieces, report)?;
            }
        }
        if flipped {
            reverse(&mut pieces[start..]);
        }
        Ok(())
    }

    /// Returns `true` for arcs that are cut for a proof: only arcs of less than half a turn are quotients with positive denominators.
    fn is_long_arc(&self, seg: &Seg) -> bool {
        let is_long = matches!(seg, Seg::Arc(a) if a.sweep.abs() > MAX_RATIONAL_SWEEP);
        self.options.certify && self.degree.is_some() && is_long
    }

    /// Appends the image of a segment in its canonical direction, on which the map is smooth, given the jets at its ends, whose points
    /// are at most `blur` from the images under this map.
    #[inline(always)]
    fn fit_smooth(
        &self,
        source: &SourceCurve<'_>,
        [first, last]: [&Jet; 2],
        blur: f64,
        pieces: &mut Vec<Piece>,
        report: &mut Report,
    ) -> Result<(), NotFinite> {
        let seg = source.seg;
        // A segment of no length is kept, as it carries line caps and markers; it has no direction to preserve.
        let is_point = source.size <= POINT_SIZE * (seg.start().to_vec2().hypot() + seg.end().to_vec2().hypot());
        if is_point || self.options.budget.left() <= 0.0 {
            pieces.push(Piece::Line(Line::new(first.p, last.p)));
            return Ok(());
        }
        let slow = source.slow_spots();
        let from = source.end_with(0.0, first.p, first);
        let to = source.end_with(1.0, last.p, last);
        let left = self.options.budget.left() / self.work;
        let (tolerance, prove) = (self.options.tolerance, (self.options.certify, blur));
        let mut fitter = StretchFitter::new(source, &slow, tolerance, prove, left);
        fitter.evenly = self.options.nodes.are_placed();
        let covered = if self.options.nodes.merges() {
            cover_far(&mut fitter, [&from, &to], SMOOTH_JOINT, pieces, report)
        } else {
            fitter.cover(&from, &to, pieces, report)
        };
        self.spend(fitter.evaluations() as f64 * self.work);
        covered
    }

    /// Counts work. If the budget is exceeded, `fit` stops searching, and the whole path fails at its end.
    pub(super) fn spend(&self, evaluations: f64) {
        let _ = self.options.budget.spend(evaluations);
    }

    /// Appends the image of a part. Where the map tears, a line connects the image with its neighbour.
    pub(super) fn fit_part(&self, part: &Part, pieces: &mut Vec<Piece>, report: &mut Report) -> Result<(), NotFinite> {
        pieces.extend(part.bridge(0));
        self.fit_inside(part, pieces, report)?;
        pieces.extend(part.bridge(1));
        Ok(())
    }

    /// Appends the image of a part, without the lines that connect it with its neighbours.
    pub(super) fn fit_inside(
        &self,
        part: &Part,
        pieces: &mut Vec<Piece>,
        report: &mut Report,
    ) -> Result<(), NotFinite> {
        let Some(cut) = &part.cut else { return self.fit(&part.seg, part.jets.each_ref(), pieces, report) };
        if !cut.confirmed {
            report.unresolved.push(part.seg.eval(0.5));
        }
        let [first, last] = part.jets.each_ref();
        let affine = cut.branch.as_ref().map(Map::class);
        if let (Some(Class::Affine(m)), false) = (affine, matches!(part.seg, Seg::Arc(_))) {
            pieces.push(match part.seg.transformed(m) {
                Seg::Line(_) => Piece::Line(Line::new(first.p, last.p)),
                other => Piece::Cubic(CubicBez { p0: first.p, p3: last.p, ..other.to_cubic() }),
            });
        } else {
            let (canonical, flipped) = source::canonical(&part.seg);
            let start = pieces.len();
            let source = part.source(self, &canonical);
            let jets = if flipped { [last, first] } else { [first, last] };
            self.fit_smooth(&source, jets, cut.blur, pieces, report)?;
            if flipped {
                reverse(&mut pieces[start..]);
            }
        }
        Ok(())
    }

    /// Appends the parts of a segment, in its direction: the segment itself if `whole`, or if the map has no creases but edges.
    pub(super) fn parts(&self, seg: &Seg, jets: [&Jet; 2], whole: bool, out: &mut Vec<Part>) -> Result<(), NotFinite> {
        let creased = self.creases.items().iter().any(|c| c.kind != CreaseKind::Edge);
        let is_budget_spent = self.options.budget.left() <= 0.0;
        if whole || is_budget_spent || !(creased || self.is_long_arc(seg)) {
            out.push(Part::whole(*seg, jets));
            return Ok(());
        }
        let (canonical, flipped) = source::canonical(seg);
        let mut parts = self.cut(&canonical, if flipped { [jets[1], jets[0]] } else { jets })?;
        if flipped {
            Part::reverse_all(&mut parts);
        }
        out.extend(parts);
        Ok(())
    }

    /// Cuts a segment in its canonical direction into parts on which the map is smooth.
    #[inline(never)]
    fn cut(&self, seg: &Seg, [first, last]: [&Jet; 2]) -> Result<Vec<Part>, NotFinite> {
        self.spend(self.creases.splits_work(seg, self.work));
        let (mut ends, evaluations) = self.creases.splits_and_work(seg);
        self.spend(evaluations as f64 * self.work);
        if let (true, Seg::Arc(a)) = (self.is_long_arc(seg), seg) {
            let n = (a.sweep.abs() / MAX_RATIONAL_SWEEP).ceil();
            ends.extend((1..n as usize).map(|i| i as f64 / n));
            ends.sort_by(f64::total_cmp);
        }
        ends.push(1.0);
        ends.reverse();
        let mut out = Vec::with_capacity(ends.len());
        let (mut found, mut from, mut p0) = (0, 0.0, first.p);
        while let Some(&t) = ends.last() {
            let (branch, confirmed) = match self.branch_between(seg, from, t) {
                Ok(b) => (b, true),
                // A crease that the map does not state, or that was missed.
                Err(share) if found < MAX_FOUND => {
                    found += 1;
                    ends.push(from + (t - from) * share);
                    continue;
                }
                Err(_) => (self.map.branch(seg.eval(0.5 * (from + t))), false),
            };
            ends.pop();
            let part = match seg {
                Seg::Arc(a) => Seg::Arc(a.subsegment(from, t)),
                other => other.part(from, t).unwrap_or(*other),
            };
            let p3 = if t == 1.0 { last.p } else { self.map.point(part.end()) };
            let jet = |p: Point, known: Option<&Jet>| match (&branch, known) {
                (None, Some(jet)) => *jet,
                (None, None) => self.map.jet(p),
                (Some(branch), _) => branch.jet(p),
            };
            let mut jets =
                [jet(part.start(), (from == 0.0).then_some(first)), jet(part.end(), (t == 1.0).then_some(last))];
            let (mut blur, mut torn) = (0.0f64, [None; 2]);
            for (k, p) in [p0, p3].into_iter().enumerate() {
                let distance = jets[k].p.distance(p);
                if !(jets[k].is_finite() && p.is_finite()) {
                    return Err(NotFinite { t: [from, t][k], at: seg.eval([from, t][k]) });
                }
                if distance > TEAR * self.options.tolerance {
                    torn[k] = Some(p);
                } else {
                    (blur, jets[k].p) = (blur.max(distance), p);
                }
            }
            out.push(Part { seg: part, jets, cut: Some(Cut { branch, blur, torn, confirmed }) });
            (from, p0) = (t, p3);
        }
        Ok(out)
    }

    /// The branch that agrees with the map between two parameters: the branch of a point inside, confirmed at others. `Err`: the share of
    /// the way at which another branch begins.
    fn branch_between(&self, seg: &Seg, from: f64, to: f64) -> Result<Option<Arc<dyn Map>>, f64> {
        /// Shares of the way that symmetrical artwork avoids, the one near the middle first.
        const PROBES: [f64; 5] = [0.483_7, 0.211_3, 0.788_9, 0.061_1, 0.939_1];
        let point = |share: f64| seg.eval(from + (to - from) * share);
        let probes = PROBES.map(point);
        let Some(first) = self.map.branch(probes[0]) else { return Ok(None) };
        let mut images = [[Point::ORIGIN; PROBES.len()]; 2];
        self.map.points(&probes, &mut images[0]);
        let agree = |p: Point, q: Point| {
            let distance = p.distance(q);
            // Where the map is not finite, the fit fails later.
            !(distance > TEAR * self.options.tolerance && distance > 1e-11 * p.to_vec2().hypot())
        };
        let mut first_difference = |b: &Arc<dyn Map>| {
            b.points(&probes, &mut images[1]);
            (0..PROBES.len()).find(|&i| !agree(images[0][i], images[1][i]))
        };
        let Some(different) = first_difference(&first) else { return Ok(Some(first)) };
        let other = self.map.branch(probes[different]).filter(|b| first_difference(b).is_none());
        if other.is_some() {
            return Ok(other);
        }
        let (mut inside, mut outside) = (PROBES[0], PROBES[different]);
        while (inside - outside).abs() > 1e-12 {
            let middle = 0.5 * (inside + outside);
            let p = point(middle);
            *if agree(self.map.point(p), first.point(p)) { &mut inside } else { &mut outside } = middle;
        }
        Err(inside)
    }
}

/// A segment, or a part of one on which the map is smooth.
#[derive(Clone)]
pub(super) struct Part {
    pub(super) seg: Seg,
    /// The jets at the ends. Adjacent parts share the points bit by bit, unless the map tears.
    pub(super) jets: [Jet; 2],
    cut: Option<Cut>,
}

/// The map that holds on a part.
#[derive(Clone)]
struct Cut {
    /// The branch of the map; `None` for the whole map.
    branch: Option<Arc<dyn Map>>,
    /// The distance of the shared points from their images under the branch.
    blur: f64,
    /// The neighbour's points at ends where the map tears.
    torn: [Option<Point>; 2],
    /// `true` if the branch was found to agree with the map.
    confirmed: bool,
}

impl Part {
    /// A whole segment with the jets at its ends.
    pub(super) fn whole(seg: Seg, jets: [&Jet; 2]) -> Self {
        Self { seg, jets: jets.map(|j| *j), cut: None }
    }

    /// Reverses the direction of consecutive parts.
    pub(super) fn reverse_all(parts: &mut [Self]) {
        parts.reverse();
        for part in parts {
            part.jets.reverse();
            if let Some(cut) = &mut part.cut {
                cut.torn.reverse();
            }
            part.seg = part.seg.reversed();
        }
    }

    /// The source curve of `seg`, the part's segment in either direction.
    pub(super) fn source<'a>(&'a self, fitter: &SegmentFitter<'a>, seg: &'a Seg) -> SourceCurve<'a> {
        let certify = fitter.options.certify;
        match self.cut.as_ref().and_then(|c| c.branch.as_ref()) {
            None => SourceCurve::for_proof(seg, fitter.map, fitter.degree, certify).with_overview(fitter.overview),
            Some(b) => SourceCurve::for_proof(seg, b, b.class().degree(), certify),
        }
    }

    /// Returns `true` if an affine map moves the part.
    pub(super) fn is_affine(&self) -> bool {
        let branch = self.cut.as_ref().and_then(|c| c.branch.as_ref());
        branch.is_some_and(|b| matches!(b.class(), Class::Affine(_)))
    }

    /// Removes the tear between consecutive parts whose ends have the same image.
    pub(super) fn join(before: &mut Self, after: &mut Self) {
        if let (Some(a), Some(b)) = (&mut before.cut, &mut after.cut)
            && before.jets[1].p == after.jets[0].p
        {
            (a.torn[1], b.torn[0]) = (None, None);
        }
    }

    /// The line to the part from its neighbour at the start (0), or from the part to its neighbour at the end (1), if the map tears there.
    pub(super) fn bridge(&self, end: usize) -> Option<Piece> {
        let (neighbour, p) = (self.cut.as_ref()?.torn[end]?, self.jets[end].p);
        Some(Piece::Line(if end == 0 { Line::new(neighbour, p) } else { Line::new(p, neighbour) }))
    }
}
