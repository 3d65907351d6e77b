//! Repeated shapes: runs of smoothly joined segments that come again at other sites of a drawing, like the letters of a text.
//!
//! A *way* divides a run into legs, each covered by one cubic or by a segment's pieces. The cubics of one site are carried to the
//! next; if that fails, the ways that were the best at other sites are tried before a search.
//!
//! Between two sites, a map differs little but in size and direction. A carried cubic gets the ends and tangents of the new site, and
//! handles scaled like the image. Its error then differs from the old one by a smooth amount, as images of one curve under two smooth
//! maps do, so that a few samples measure the difference, without a fit or a check of all samples.

use super::limits::{
    CARRIED_TURN, CARRY_DOWN, CARRY_MARGIN, CARRY_TRIALS, CARRY_UP, MAX_CARRIED, MAX_SHAPES, MAX_WAYS, SAME_SHAPE,
    SEARCH_AGAIN,
};
use super::segment::{Part, SegmentFitter};
use super::source::{SourceCurve, images};
use crate::map::Jet;
use crate::outline::Seg;
use bezierfit::parts::{ChordFrame, FOOT_ROUNDING, FitOwn, Leg, MERGE_GRID, MarkedCubic, SMOOTH_JOINT};
use bezierfit::{Lanes, Piece, Report, Source};
use kurbo::{Point, Vec2};
use std::sync::Arc;

/// A division of a run into legs.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Way {
    /// The number of segments.
    pub(super) segments: usize,
    /// The legs; `None` if every segment keeps its pieces.
    pub(super) legs: Option<Vec<Leg>>,
    /// The number of pieces.
    pub(super) pieces: usize,
}

/// A way with its cubics.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CarriedWay {
    /// The partial derivatives of the map at its start.
    pub(super) jacobian: [Vec2; 2],
    /// The distance of its control points from the shape's.
    pub(super) distance: f64,
    pub(super) segments: usize,
    pub(super) pieces: usize,
    /// The legs, with cubics for those that are merged; `None` if every segment keeps its pieces.
    pub(super) legs: Option<Vec<(Leg, Option<Carried>)>>,
}

/// A shape of runs that were searched.
#[derive(Debug, Clone, PartialEq)]
struct Shape {
    /// The control points relative to the first.
    points: Vec<Vec2>,
    /// Ways that were the best at some site, those of the fewest pieces first.
    ways: Vec<Way>,
    carried: Vec<CarriedWay>,
    /// The number of times that cubics could not be carried to this shape.
    uses: usize,
    /// Its index among the shapes known before, and the distance between the control points.
    known: Option<(usize, f64)>,
}

/// A summary that distinguishes most shapes.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Summary {
    /// A hash of the number and kinds of the segments.
    kinds: u64,
    /// The first of the control points.
    first: Vec2,
}

impl Summary {
    fn of_parts(segs: &[Part]) -> Self {
        Self { kinds: kinds(segs), first: points(segs).next().unwrap_or_default() }
    }

    fn is_near(&self, other: &Self, limit: f64) -> bool {
        self.kinds == other.kinds && distance(self.first, other.first) <= limit
    }
}

/// Shapes that were searched.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Shapes {
    /// The summary of each shape.
    summaries: Vec<Summary>,
    all: Vec<Shape>,
}

impl Shapes {
    /// The index of a shape whose control points are at most `limit` from those of `segs`, and their largest distance.
    fn find(&self, summary: &Summary, segs: &[Part], limit: f64) -> Option<(usize, f64)> {
        let largest_distance = |s: &Shape| {
            points(segs).zip(&s.points).try_fold(0.0f64, |largest, (p, q)| {
                let d = distance(p, *q);
                (d <= limit).then(|| largest.max(d))
            })
        };
        let mut similar = self.summaries.iter().enumerate().filter(|(_, s)| s.is_near(summary, limit));
        similar.find_map(|(i, _)| Some((i, largest_distance(&self.all[i])?)))
    }
}

/// The shapes of the last runs, and the known shapes of other paths.
#[derive(Debug, Default)]
pub(super) struct Repeats {
    pub(super) own: Shapes,
    pub(super) known: Arc<Shapes>,
    /// The entry to be replaced next, once there are [`MAX_SHAPES`].
    oldest: usize,
}

impl Repeats {
    pub(super) fn new(known: Arc<Shapes>) -> Self {
        Self { known, ..Self::default() }
    }

    /// The index of the shape of a run, which is entered if it is new, and the distance between their control points.
    pub(super) fn shape(&mut self, segs: &[Part], tolerance: f64) -> (usize, f64) {
        let (summary, limit) = (Summary::of_parts(segs), SAME_SHAPE * tolerance);
        self.own.find(&summary, segs, limit).unwrap_or_else(|| {
            let known = self.known.find(&summary, segs, limit);
            let ways = known.map_or(Vec::new(), |(i, _)| self.known.all[i].ways.clone());
            let new = Shape { points: points(segs).collect(), ways, carried: Vec::new(), uses: 0, known };
            let Shapes { summaries, all } = &mut self.own;
            if all.len() < MAX_SHAPES {
                summaries.push(summary);
                all.push(new);
                return (all.len() - 1, 0.0);
            }
            let i = self.oldest;
            (summaries[i], all[i]) = (summary, new);
            self.oldest = (i + 1) % MAX_SHAPES;
            (i, 0.0)
        })
    }

    /// The ways to try before a search; none if it is time to look for better ones.
    pub(super) fn ways(&mut self, shape: usize) -> &[Way] {
        let shape = &mut self.own.all[shape];
        shape.uses += 1;
        if shape.uses.is_multiple_of(SEARCH_AGAIN) { &[] } else { &shape.ways }
    }

    /// Ways with their cubics, from the sites whose Jacobian is most similar to that of `to`, the jet at the start, the most similar first.
    /// Each comes with the distance of its control points from the shape's.
    pub(super) fn nearest(&self, shape: usize, to: &Jet) -> impl Iterator<Item = (&CarriedWay, f64)> {
        let shape = &self.own.all[shape];
        let (known, extra) = shape.known.map_or((&[][..], 0.0), |(i, d)| (&self.known.all[i].carried, d));
        let known = known.iter().map(move |w| (w, w.distance + extra));
        let all = shape.carried.iter().map(|w| (w, w.distance)).chain(known);
        let change = |way: &CarriedWay| Change::new(way.jacobian, to).map(|c| c.factor);
        let mut similar: Vec<_> = all.filter_map(|(w, distance)| Some((change(w)?, (w, distance)))).collect();
        similar.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        similar.into_iter().take(CARRY_TRIALS).map(|(_, way)| way)
    }

    /// Returns `true` if the shape has come before.
    pub(super) fn comes_again(&self, shape: usize) -> bool {
        let shape = &self.own.all[shape];
        shape.known.is_some() || !shape.carried.is_empty()
    }

    /// Remembers a way with its cubics.
    pub(super) fn carry(&mut self, shape: usize, way: CarriedWay) {
        let carried = &mut self.own.all[shape].carried;
        if carried.len() == MAX_CARRIED {
            carried.remove(0);
        }
        carried.push(way);
    }

    /// Remembers the result of a search.
    pub(super) fn add(&mut self, shape: usize, way: Way) {
        let ways = &mut self.own.all[shape].ways;
        if !ways.contains(&way) {
            let at = ways.partition_point(|w| w.pieces <= way.pieces);
            ways.insert(at, way);
            ways.truncate(MAX_WAYS);
        }
    }
}

/// The larger of the distances in x and in y.
fn distance(p: Vec2, q: Vec2) -> f64 {
    (p.x - q.x).abs().max((p.y - q.y).abs())
}

/// A hash of the number and kinds of segments.
fn kinds(segs: &[Part]) -> u64 {
    segs.iter().fold(segs.len() as u64, |hash, part| {
        let kind = match part.seg {
            Seg::Line(_) => 1,
            Seg::Quad(_) => 2,
            Seg::Cubic(_) => 3,
            Seg::Arc(_) => 4,
        };
        hash.wrapping_mul(31).wrapping_add(kind)
    })
}

/// The points that determine the segments, relative to their start.
fn points(segs: &[Part]) -> impl Iterator<Item = Vec2> {
    let start = segs.first().map_or(Point::ORIGIN, |p| p.seg.start());
    segs.iter().flat_map(move |part| match &part.seg {
        Seg::Line(s) => [s.p1 - start, Vec2::ZERO, Vec2::ZERO],
        Seg::Quad(s) => [s.p1 - start, s.p2 - start, Vec2::ZERO],
        Seg::Cubic(s) => [s.p1 - start, s.p2 - start, s.p3 - start],
        Seg::Arc(s) => [s.p1 - start, s.a * s.sweep, s.b * s.sweep],
    })
}

/// Consecutive segments at one site of the map.
#[derive(Clone, Copy)]
pub(super) struct Site<'a> {
    pub(super) fitter: &'a SegmentFitter<'a>,
    pub(super) parts: &'a [Part],
}

/// An end of a cubic.
struct End {
    p: Point,
    /// The unit tangent and the speed of the image on the side of the cubic.
    tangent: Vec2,
    speed: f64,
}

impl<'a> Site<'a> {
    /// Returns `true` if cubics are carried to and from here: if the map is a quotient of polynomials, so that two images of a curve
    /// differ smoothly, no proofs are wanted, and single values are cheap.
    pub(super) fn carries(&self) -> bool {
        let SegmentFitter { map, degree, options, .. } = self.fitter;
        degree.is_some() && !options.certify && !map.prefers_batches()
    }

    /// The image at grid point `k`, seen from the segment after it or before it. `None` if it has no derivative there.
    fn end(&self, k: usize, after: bool) -> Option<End> {
        let (joint, inner) = (k / MERGE_GRID, k % MERGE_GRID);
        let i = if after || inner > 0 { joint } else { joint.checked_sub(1)? };
        let part = self.parts.get(i)?;
        let source = SourceCurve::new(&part.seg, self.fitter.map, None);
        let mut end = if inner > 0 {
            source.end(inner as f64 / MERGE_GRID as f64).ok()?
        } else {
            let jet = &part.jets[usize::from(!after)];
            source.end_with(if after { 0.0 } else { 1.0 }, jet.p, jet)
        };
        // Adjacent pieces share a joint bit by bit.
        if let (0, Some(next)) = (inner, self.parts.get(joint)) {
            end.p = next.jets[0].p;
        }
        let tangent = if after { end.away } else { end.into };
        (end.speed > 0.0).then_some(End { p: end.p, tangent, speed: end.speed })
    }

    /// Returns a function that fits the site's segments one by one.
    pub(super) fn own(self) -> impl FitOwn {
        move |i: usize, pieces: &mut Vec<Piece>, report: &mut Report| {
            self.fitter.fit_inside(&self.parts[i], pieces, report)
        }
    }

    /// Returns `true` if the image is smooth at the joints inside a leg.
    fn is_smooth(&self, leg: Leg) -> bool {
        (leg.from / MERGE_GRID + 1..leg.to.div_ceil(MERGE_GRID)).all(|j| {
            let (Some(before), Some(after)) = (self.parts.get(j - 1), self.parts.get(j)) else { return false };
            let jet = &after.jets[0];
            let (into, away) = (jet.push(before.seg.deriv(1.0)), jet.push(after.seg.deriv(0.0)));
            into.cross(away).abs() <= SMOOTH_JOINT * into.dot(away)
        })
    }

    /// The images of eight points, given as segments and their parameters.
    fn images(&self, at: &[(usize, f64); 8]) -> Lanes {
        let point = |(segment, t): (usize, f64)| self.parts.get(segment).map_or(Point::ORIGIN, |s| s.seg.eval(t));
        images(self.fitter.map, &at.map(point))
    }
}

/// The change of a map's Jacobian from one site to another: J₁·J₀⁻¹.
#[derive(Debug, Clone, Copy)]
struct Change {
    columns: [Vec2; 2],
    det: f64,
    /// The largest factor, 1 or more, by which a length grows or shrinks.
    factor: f64,
}

impl Change {
    /// Returns the change; `None` unless the change of every length is between [`CARRY_DOWN`] and [`CARRY_UP`].
    fn new([dx, dy]: [Vec2; 2], to: &Jet) -> Option<Self> {
        let k = 1.0 / dx.cross(dy);
        let columns = [(to.dx * dy.y - to.dy * dx.y) * k, (to.dy * dx.x - to.dx * dy.x) * k];
        // The squares of the singular values are mean ± half their difference.
        let (mean, det) = (0.5 * (columns[0].hypot2() + columns[1].hypot2()), columns[0].cross(columns[1]));
        let half = (mean * mean - det * det).max(0.0).sqrt();
        let (most, least) = ((mean + half).sqrt(), (mean - half).max(0.0).sqrt());
        let is_in_range = most <= CARRY_UP && least >= CARRY_DOWN;
        (det > 0.0 && is_in_range).then(|| Self { columns, det, factor: most.max(1.0 / least) })
    }

    fn push(&self, v: Vec2) -> Vec2 {
        self.columns[0] * v.x + self.columns[1] * v.y
    }

    /// Returns `true` if the change turns one direction nearly into the other.
    fn turns(&self, from: Vec2, to: Vec2) -> bool {
        let v = self.push(from);
        v.cross(to).abs() <= CARRIED_TURN * v.dot(to)
    }

    /// The factor by which distances from a curve with this unit tangent change.
    fn across(&self, tangent: Vec2) -> f64 {
        self.det / self.push(tangent).hypot()
    }
}

/// A cubic that has passed its check, with the data needed to carry it to other sites.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Carried {
    /// The partial derivatives of the map at the last joint before it.
    jacobian: [Vec2; 2],
    /// The unit tangents and the speeds of the image at both ends.
    tangents: [Vec2; 2],
    speeds: [f64; 2],
    cubic: MarkedCubic,
}

impl Carried {
    /// A cubic from one of the site's legs. `None` if it begins or ends where the speed of the image is zero.
    pub(super) fn new(site: &Site<'_>, leg: Leg, cubic: MarkedCubic) -> Option<Self> {
        let (from, to) = (site.end(leg.from, true)?, site.end(leg.to, false)?);
        let [Jet { dx, dy, .. }, _] = site.parts.get(leg.from / MERGE_GRID)?.jets;
        let (tangents, speeds) = ([from.tangent, to.tangent], [from.speed, to.speed]);
        Some(Self { jacobian: [dx, dy], tangents, speeds, cubic })
    }

    /// The cubic at another site, with a bound of its error. `None` if the error may exceed `tolerance`.
    pub(super) fn carry_to(&self, site: &Site<'_>, leg: Leg, tolerance: f64) -> Option<(Piece, f64)> {
        let change = Change::new(self.jacobian, &site.parts.get(leg.from / MERGE_GRID)?.jets[0])?;
        let across =
            self.cubic.batches.iter().flat_map(|b| &b.tangents).chain(&self.tangents).map(|t| change.across(*t));
        let error = self.cubic.error * across.fold(0.0, f64::max);
        let left = tolerance - error;
        if left <= 0.0 || !site.is_smooth(leg) {
            return None;
        }
        let (from, to) = (site.end(leg.from, true)?, site.end(leg.to, false)?);
        if !(change.turns(self.tangents[0], from.tangent) && change.turns(self.tangents[1], to.tangent)) {
            return None;
        }
        let (t0, t1) = (from.tangent, to.tangent);
        let frame = ChordFrame { q: to.p - from.p, t0, t1, floor: [0.0; 2], size: 0.0, home: [0.0; 2], pull: 0.0 };
        let [a, b] = self.cubic.handles;
        let (a, b) = (a * from.speed / self.speeds[0], b * to.speed / self.speeds[1]);
        let (mut difference, mut last) = (0.0f64, 0.0);
        for batch in &self.cubic.batches {
            let mut g = site.images(&batch.at);
            for i in 0..8 {
                g.x[i] -= from.p.x;
                g.y[i] -= from.p.y;
            }
            let mut s = batch.feet;
            let squares = frame.distances(&g, a, b, &mut s, 1);
            let errors = frame.signed_distances(&g, a, b, &s, &squares);
            for i in 0..8 {
                let new = (errors[i] - change.across(batch.tangents[i]) * batch.errors[i]).abs();
                // Written so that NaN fails.
                if !(new * CARRY_MARGIN <= left && s[i] >= last - FOOT_ROUNDING) {
                    return None;
                }
                difference = difference.max(new);
                last = s[i];
            }
        }
        let piece = Piece::Cubic(frame.cubic(from.p, to.p, a, b));
        Some((piece, error + CARRY_MARGIN * difference))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::Outline;

    fn segs(d: &str) -> Vec<Part> {
        Outline::from_svg(d).unwrap().subpaths[0].segs.iter().map(|s| Part::whole(*s, [&Jet::default(); 2])).collect()
    }

    #[test]
    fn runs_of_the_same_shape_are_found_elsewhere() {
        let mut repeats = Repeats::default();
        let mut shape = |d: &str| repeats.shape(&segs(d), 0.1).0;
        assert_eq!(shape("M0,0C1,2 3,4 5,5Q6,6 9,1"), 0);
        assert_eq!(shape("M0,0C1,2 3,4 5,5"), 1);
        assert_eq!(shape("M70.001,-8C71,-6 73,-4 75,-3Q76,-2 79,-7"), 0);
        assert_eq!(shape("M70,1C71,3 73,5 75,6"), 1);
        let (_, distance) = repeats.shape(&segs("M0,0C1,2 3,4.002 5,5.001"), 0.1);
        assert!((distance - 0.002).abs() < 1e-12);
        let mut shape = |d: &str| repeats.shape(&segs(d), 0.1).0;
        assert_eq!(shape("M70,-8C71,-6 73,-4 75,-3Q76,-2 79,-7.1"), 2);
        assert_eq!(shape("M70,-8C71,-6 73,-4 75,-3L79,-7"), 3);
    }

    #[test]
    fn the_fewest_pieces_are_tried_first_and_searches_repeated() {
        let mut repeats = Repeats::default();
        let (shape, _) = repeats.shape(&segs("M0,0C1,2 3,4 5,5"), 0.1);
        let many = Way { segments: 2, legs: None, pieces: 3 };
        let few = Way { segments: 2, legs: Some(Vec::new()), pieces: 1 };
        for way in [&many, &few, &many] {
            repeats.add(shape, way.clone());
        }
        let tried: Vec<usize> = (0..SEARCH_AGAIN).map(|_| repeats.ways(shape).len()).collect();
        assert_eq!(tried[..SEARCH_AGAIN - 1], vec![2; SEARCH_AGAIN - 1]);
        assert_eq!(tried[SEARCH_AGAIN - 1], 0);
        assert_eq!(repeats.ways(shape), [few, many]);
    }
}
