//! Fewer pieces across smooth joints of the source.
//!
//! A drawing often has more nodes than its shape needs. The fitter treats smoothly joined segments as one curve and searches for the
//! fewest cubics that cover it. They are used only if they are fewer than the segments' pieces and every one has passed its check.

use super::limits::{CLEAR_DERIVATIVE, MAX_SHAPE};
use super::options::Options;
use super::repeats::{Carried, CarriedWay, Repeats, Shapes, Site, Way};
use super::segment::{Part, SegmentFitter};
use super::source::SourceCurve;
use crate::map::{Jet, Map};
use crate::outline::Seg;
use bezierfit::parts::{
    ACCEPTED, FitOwn, Leg, MERGE_GRID, MergeSettings, NodeSettings, OwnPieces, PassedLeg, ReachMemory, Reaches,
    RunSegment, SMOOTH_JOINT, STRAIGHT, STRAIGHT_TURN, SegmentRun, Side, per_segment, placed, refined, sample_lanes,
};
use bezierfit::{Assurance, Nodes, NotFinite, Piece, Quotient, Report, Source};
use kurbo::{Point, Vec2};
use std::sync::Arc;

/// The work of a trial with its share of the checks, in evaluations of the map. The samples themselves are fewer.
const TRIAL_WORK: f64 = 40.0;

/// State reused from one subpath to the next.
#[derive(Default)]
pub(super) struct MergeMemory {
    repeats: Repeats,
    reach: ReachMemory,
}

impl MergeMemory {
    /// Starts with the shapes of other paths.
    pub(super) fn new(known: Arc<Shapes>) -> Self {
        Self { repeats: Repeats::new(known), ..Self::default() }
    }

    /// The shapes of other paths that it started with.
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
    parts: &'a [Part],
    /// `true` if the parts are a closed subpath without corners.
    is_ring: bool,
    pieces: Vec<Piece>,
    report: Report,
    memory: &'a mut MergeMemory,
}

/// Returns `false` if the images of two consecutive segments certainly turn by more than `SMOOTH_JOINT`, given the map's jets where
/// they meet.
#[inline]
fn may_be_smooth([before, after]: [&Seg; 2], jets: [&Jet; 2]) -> bool {
    /// Only joints that certainly turn are excluded here; the run decides about the others.
    const MARGIN: f64 = 1.03;
    let (into, away) = (jets[0].push(before.deriv(1.0)), jets[1].push(after.deriv(0.0)));
    // One-sided tangents decide where a derivative vanishes or nearly does.
    let is_clear = |d: Vec2, jet: &Jet, seg: &Seg| {
        let scale = CLEAR_DERIVATIVE * CLEAR_DERIVATIVE * (jet.dx.hypot2() + jet.dy.hypot2());
        d.hypot2() > scale * seg.end().distance_squared(seg.start())
    };
    let (dot, cross) = (into.dot(away), into.cross(away).abs());
    (dot > 0.0 && cross <= MARGIN * SMOOTH_JOINT.tan() * dot)
        || !is_clear(into, jets[0], before)
        || !is_clear(away, jets[1], after)
}

/// Returns `true` if a smooth joint of the source belongs to its structure.
fn is_structure(before: &Seg, after: &Seg) -> bool {
    let side = |seg: &Seg, t: f64| {
        let cubic = |p: [Point; 4]| if t == 0.0 { p[2] - p[0] } else { p[1] - p[3] };
        let bend = match seg {
            Seg::Line(_) => Vec2::ZERO,
            Seg::Quad(q) => q.p0.to_vec2() - q.p1.to_vec2() * 2.0 + q.p2.to_vec2(),
            Seg::Cubic(c) => cubic([c.p0, c.p1, c.p2, c.p3]),
            Seg::Arc(a) => a.center - a.eval(t),
        };
        Side { tangent: seg.deriv(t), bend, is_line: matches!(seg, Seg::Line(_)) }
    };
    let ends_arc = match (before, after) {
        (Seg::Arc(a), Seg::Arc(b)) => a.center.distance(b.center) > 1e-6 * (a.a.hypot() + a.b.hypot()),
        (a, b) => matches!(a, Seg::Arc(_)) != matches!(b, Seg::Arc(_)),
    };
    ends_arc || bezierfit::parts::is_structure(&side(before, 1.0), &side(after, 0.0))
}

/// Returns `true` if the images of two consecutive parts may join smoothly.
pub(super) fn joins(before: &Part, after: &Part) -> bool {
    let torn = before.bridge(1).is_some() || after.bridge(0).is_some();
    !torn && may_be_smooth([&before.seg, &after.seg], [&before.jets[1], &after.jets[0]])
}

/// Announces the samples of all segments of `runs` that may be merged, and the points where pieces may end, to a map that prefers
/// batches and knows the jets at the joints.
pub(super) fn announce(runs: &[&[Seg]], map: &dyn Map, options: &Options) {
    let mut sources = Vec::new();
    for segs in runs {
        let joint_may_be_smooth = |i: usize| match (i.checked_sub(1).and_then(|i| segs.get(i)), segs.get(i)) {
            (Some(before), Some(after)) => may_be_smooth([before, after], [&map.jet(after.start()); 2]),
            _ => false,
        };
        let in_run =
            |(i, seg): (usize, &'_ Seg)| (joint_may_be_smooth(i) || joint_may_be_smooth(i + 1)).then_some(*seg);
        sources.extend(segs.iter().enumerate().filter_map(in_run));
    }
    let degree = map.rational_degree();
    let sources: Vec<_> = sources.iter().map(|seg| SourceCurve::for_proof(seg, map, degree, options.certify)).collect();
    let lanes = sample_lanes(per_segment(degree.is_some()));
    let ends = (1..MERGE_GRID).map(|k| k as f64 / MERGE_GRID as f64);
    Source::announce(
        &mut sources.iter().flat_map(|s| lanes.clone().map(move |t| (s, t))),
        &mut sources.iter().flat_map(|s| ends.clone().map(move |t| (s, t))),
    );
}

impl<'a> Merger<'a> {
    pub(super) fn new(
        fitter: &'a SegmentFitter<'a>,
        (parts, is_ring): (&'a [Part], bool),
        memory: &'a mut MergeMemory,
    ) -> Self {
        // The search begins anew, so that the result does not depend on the subpath before.
        memory.reach.last_reach = 0;
        Self { fitter, parts, is_ring, pieces: Vec::with_capacity(parts.len()), report: Report::default(), memory }
    }

    /// The pieces of all segments, merged where that saves some.
    pub(super) fn merged(mut self) -> Result<(Vec<Piece>, Report), NotFinite> {
        let extremes = self.fitter.options.nodes == Nodes::Extremes;
        let mut i = 0;
        while i < self.parts.len() {
            let end = i + 1 + self.parts[i..].windows(2).take_while(|w| joins(&w[0], &w[1])).count();
            self.pieces.extend(self.parts[i].bridge(0));
            while i < end {
                i += if i + 1 < end || extremes { self.append_run(i, end)? } else { self.append_single(i)? };
            }
            self.pieces.extend(self.parts[end - 1].bridge(1));
        }
        Ok((self.pieces, self.report))
    }

    /// Appends the pieces of a segment that cannot be in a run, and returns 1.
    fn append_single(&mut self, i: usize) -> Result<usize, NotFinite> {
        self.fitter.fit_inside(&self.parts[i], &mut self.pieces, &mut self.report)?;
        Ok(1)
    }

    /// Appends the pieces of the first segments from `start` up to `end`, whose joints may be smooth, and returns the number of segments.
    fn append_run(&mut self, start: usize, end: usize) -> Result<usize, NotFinite> {
        // The budget is used up, and the whole path will be refused.
        if self.fitter.options.budget.left() <= 0.0 {
            return self.append_single(start);
        }
        let (parts, tolerance) = (&self.parts[start..end], self.fitter.options.tolerance);
        if self.fitter.options.nodes.are_placed() {
            return self.append_placed(start, end);
        }
        let shape = (parts.len() <= MAX_SHAPE).then(|| self.memory.repeats.shape(parts, tolerance));
        if let Some(shape) = shape
            && let Some(segments) = self.append_carried(shape, start, end)?
        {
            return Ok(segments);
        }
        let run = self.longest_run(start, end)?;
        if run.segments.len() < 2 {
            return self.append_single(start);
        }
        self.append_merged(&run, start, shape)?;
        Ok(run.segments.len())
    }

    /// Appends the pieces of the first segments from `start` up to `end`, with nodes where the options want them; returns their number.
    fn append_placed(&mut self, start: usize, end: usize) -> Result<usize, NotFinite> {
        let options = self.fitter.options;
        let mut run = self.longest_run(start, end)?;
        if run.segments.is_empty() && options.nodes == Nodes::Extremes {
            let parts: &'a [Part] = self.parts;
            run.extend(&parts[start..=start], SMOOTH_JOINT, |part| Ok(self.run_segment(part, true)))?;
        }
        let count = run.segments.len();
        if count < 1 + usize::from(options.nodes == Nodes::Auto) {
            return self.append_single(start);
        }
        for (i, segment) in run.segments.iter_mut().enumerate() {
            let before = (start + i).checked_sub(1).unwrap_or(self.parts.len() - 1);
            segment.kept = is_structure(&self.parts[before].seg, &self.parts[start + i].seg);
        }
        let closed = self.is_ring && count == self.parts.len() && run.closes(SMOOTH_JOINT);
        let left = options.budget.left() / self.fitter.work;
        let settings = NodeSettings { nodes: options.nodes, tolerance: options.tolerance, closed, left };
        let work = placed(&run, settings, &mut self.memory.reach, &mut self.pieces, &mut self.report)?;
        self.fitter.spend(TRIAL_WORK * work.tried as f64 + self.fitter.work * work.evaluations as f64);
        Ok(count)
    }

    /// The segments from `start` up to `end`, under the map.
    fn site(&self, start: usize, end: usize) -> Site<'a> {
        Site { fitter: self.fitter, parts: &self.parts[start..end] }
    }

    /// Appends the pieces of a run whose cubics were found at another site, and returns the number of its segments. `None` if there
    /// are none or they may not suffice here.
    fn append_carried(
        &mut self,
        (shape, distance): (usize, f64),
        start: usize,
        end: usize,
    ) -> Result<Option<usize>, NotFinite> {
        if !self.site(start, end).carries() {
            return Ok(None);
        }
        let [jet, _] = &self.parts[start].jets;
        let magnification = (jet.dx.hypot2() + jet.dy.hypot2()).sqrt();
        for (way, other_distance) in self.memory.repeats.nearest(shape, jet) {
            // The curves differ by at most √2 of the distances before the map, which may magnify more further on.
            let difference = 2.0 * magnification * (distance + other_distance);
            let tolerance = ACCEPTED * self.fitter.options.tolerance - difference;
            let site = self.site(start, start + way.segments);
            let piece = |(leg, cubic): &(Leg, Option<Carried>)| {
                let piece = if leg.merged { cubic.as_ref()?.carry_to(&site, *leg, tolerance) } else { None };
                let piece = piece.map(|(piece, error)| (piece, error + difference));
                (piece.is_some() || !leg.merged).then_some((*leg, piece))
            };
            let legs = match &way.legs {
                None => None,
                Some(legs) => match legs.iter().map(piece).collect::<Option<Vec<PassedLeg>>>() {
                    None => continue,
                    found => found,
                },
            };
            let mut own = OwnPieces::new(way.segments, site.own());
            if own.count_of(legs.as_deref())? <= way.pieces {
                let segments = way.segments;
                own.append(legs, Assurance::Checked, &mut self.pieces, &mut self.report)?;
                return Ok(Some(segments));
            }
        }
        Ok(None)
    }

    /// The longest run of smoothly joined segments from `start` up to `end`.
    fn longest_run(&self, start: usize, end: usize) -> Result<SegmentRun<SourceCurve<'a>>, NotFinite> {
        let mut run = SegmentRun::new(self.fitter.degree.is_some(), end - start);
        let parts: &'a [Part] = self.parts;
        run.extend(&parts[start..end], SMOOTH_JOINT, |part| Ok(self.run_segment(part, false)))?;
        Ok(run)
    }

    /// Prepares a segment for a run. `None` if it cannot be in one: it has no length, or it has slow spots and is not `alone`.
    fn run_segment(&self, part: &'a Part, alone: bool) -> Option<RunSegment<SourceCurve<'a>>> {
        let options = self.fitter.options;
        let source = part.source(self.fitter, &part.seg);
        let form = if options.certify { source.quotient().and_then(Quotient::provable) } else { None };
        let slow = source.slow_spots();
        if source.size == 0.0 || !(alone || slow.all().is_empty()) {
            return None;
        }
        let samples = per_segment(self.fitter.degree.is_some());
        let may_hide_features = |range: [f64; 2], samples: usize| {
            form.is_none() && source.resolved(range, samples, options.tolerance) == Some(false)
        };
        // The enclosures of shorter parts are tighter.
        let quarter = |i: u8| [0.25 * f64::from(i), 0.25 * f64::from(i + 1)];
        if may_hide_features([0.0, 1.0], samples) && (0..4).any(|i| may_hide_features(quarter(i), samples / 4)) {
            return None;
        }
        let [first, last] = &part.jets;
        let ends = [source.end_with(0.0, first.p, first), source.end_with(1.0, last.p, last)];
        let is_straight = || {
            let chord = ends[1].p - ends[0].p;
            let is_along = |v: Vec2| v.cross(chord).abs() <= STRAIGHT_TURN * chord.hypot() && v.dot(chord) > 0.0;
            let limit = STRAIGHT * options.tolerance * chord.hypot();
            let is_near = |t: f64| (source.eval(t).0 - ends[0].p).cross(chord).abs() <= limit;
            is_along(ends[0].away) && is_along(ends[1].into) && [0.27, 0.5, 0.81].into_iter().all(is_near)
        };
        let is_line = matches!(part.seg, Seg::Line(_));
        let bent = is_line && !is_straight();
        let mut segment = RunSegment::new(source, form, ends, is_line);
        segment.slow = slow;
        Some(if bent { segment.bent() } else { segment })
    }

    /// Appends the fewest pieces for a run that begins with segment `start`.
    fn append_merged(
        &mut self,
        run: &SegmentRun<SourceCurve<'a>>,
        start: usize,
        shape: Option<(usize, f64)>,
    ) -> Result<(), NotFinite> {
        let segments = run.segments.len();
        let (site, options) = (self.site(start, start + segments), self.fitter.options);
        let proof = run.segments.first().is_some_and(RunSegment::is_provable);
        let own = OwnPieces::new(segments, site.own());
        let MergeMemory { repeats, reach } = &mut *self.memory;
        let marks = site.carries() && shape.is_some();
        let again = shape.is_some_and(|(shape, _)| repeats.comes_again(shape));
        let settings = MergeSettings { tolerance: options.tolerance, proof, marks, again, evenly: false };
        let mut reaches = Reaches::new(run, own, settings, reach);
        let ways = shape.map_or(&[][..], |(shape, _)| repeats.ways(shape));
        let legs = match repeated(ways.iter().filter(|w| w.segments == segments), &mut reaches)? {
            Some(legs) => legs,
            None => {
                let legs = reaches.fewest()?;
                if let Some((shape, _)) = shape {
                    let pieces = reaches.own.count_of(legs.as_deref())?;
                    let found = legs.as_ref().map(|legs| legs.iter().map(|(leg, _)| *leg).collect());
                    repeats.add(shape, Way { segments, legs: found, pieces });
                }
                legs
            }
        };
        if let (true, Some((shape, distance))) = (marks, shape) {
            let pieces = reaches.own.count_of(legs.as_deref())?;
            let mut carried = |leg: Leg| Carried::new(&site, leg, reaches.marked(leg)?);
            let legs = legs.as_ref().map(|legs| legs.iter().map(|(leg, _)| (*leg, carried(*leg))).collect());
            let Jet { dx, dy, .. } = site.parts[0].jets[0];
            repeats.carry(shape, CarriedWay { jacobian: [dx, dy], distance, segments, pieces, legs });
        }
        self.fitter.spend(TRIAL_WORK * reaches.tried() as f64);
        let Reaches { own, .. } = reaches;
        let (mut own, legs) = refined(run, own, legs, settings, reach)?;
        own.append(legs, run.assurance(options.tolerance), &mut self.pieces, &mut self.report)
    }
}

/// The first of the ways for other runs of the same shape that takes no more pieces here. The inner `None` means the segments' pieces.
fn repeated<'w>(
    ways: impl Iterator<Item = &'w Way>,
    reaches: &mut Reaches<'_, SourceCurve<'_>, impl FitOwn>,
) -> Result<Option<Option<Vec<PassedLeg>>>, NotFinite> {
    for way in ways {
        let legs = match &way.legs {
            None => None,
            Some(legs) => match reaches.pieces_of(legs)? {
                None => continue,
                found => found,
            },
        };
        if reaches.own.count_of(legs.as_deref())? <= way.pieces {
            return Ok(Some(legs));
        }
    }
    Ok(None)
}
