//! Runs of the same shape at different places, as the letters of a text: the cubics of one are carried to the next, or the legs that
//! merged it are tried first.

use super::carry::{Carried, Change};
use super::limits::{CARRY_TRIALS, MAX_CARRIED, MAX_SHAPES, MAX_WAYS, SAME_SHAPE, SEARCH_AGAIN};
use super::segment::Part;
use crate::map::Jet;
use crate::outline::Seg;
use bezierfit::parts::Leg;
use kurbo::{Point, Vec2};
use std::sync::Arc;

/// A way through the places of a run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Way {
    /// Number of segments.
    pub(super) segments: usize,
    /// `None`: the segments' own pieces.
    pub(super) legs: Option<Vec<Leg>>,
    /// Number of pieces.
    pub(super) pieces: usize,
}

/// A way with its cubics.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CarriedWay {
    /// The partial derivatives of the map at its start.
    pub(super) jacobian: [Vec2; 2],
    /// Distance of its control points from those of the shape.
    pub(super) off: f64,
    pub(super) segments: usize,
    pub(super) pieces: usize,
    /// Cubics of merged legs. `None`: the segments' own pieces.
    pub(super) legs: Option<Vec<(Leg, Option<Carried>)>>,
}

/// A shape of runs that were searched.
#[derive(Debug, Clone, PartialEq)]
struct Shape {
    /// Control points relative to the first.
    points: Vec<Vec2>,
    /// Ways that were the best somewhere, those of the fewest pieces first.
    ways: Vec<Way>,
    carried: Vec<CarriedWay>,
    /// How often cubics could not be carried to this shape.
    uses: usize,
    /// Its index among the shapes known before, and the distance between the control points.
    known: Option<(usize, f64)>,
}

/// What tells most shapes apart at a glance.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Glance {
    /// Number and kinds of the segments.
    kinds: u64,
    /// The first of the control points.
    first: Vec2,
}

impl Glance {
    fn of(segs: &[Part]) -> Self {
        Self { kinds: kinds(segs), first: points(segs).next().unwrap_or_default() }
    }

    fn is_near(&self, other: &Self, near: f64) -> bool {
        self.kinds == other.kinds && apart(self.first, other.first) <= near
    }
}

/// Shapes that were searched.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Shapes {
    /// One for each shape.
    glances: Vec<Glance>,
    all: Vec<Shape>,
}

impl Shapes {
    /// The index of a shape whose control points are at most `near` from those of `segs`, and their largest distance.
    fn find(&self, glance: &Glance, segs: &[Part], near: f64) -> Option<(usize, f64)> {
        let off = |s: &Shape| {
            points(segs).zip(&s.points).try_fold(0.0f64, |off, (p, q)| {
                let d = apart(p, *q);
                (d <= near).then(|| off.max(d))
            })
        };
        let alike = self.glances.iter().enumerate().filter(|(_, g)| g.is_near(glance, near));
        alike.filter_map(|(i, _)| Some((i, off(&self.all[i])?))).next()
    }
}

/// The shapes of the last runs, and those of other paths.
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
        let (glance, near) = (Glance::of(segs), SAME_SHAPE * tolerance);
        let entered = |i: usize| (i, 0.0);
        self.own.find(&glance, segs, near).unwrap_or_else(|| {
            let known = self.known.find(&glance, segs, near);
            let ways = known.map_or(Vec::new(), |(i, _)| self.known.all[i].ways.clone());
            let new = Shape { points: points(segs).collect(), ways, carried: Vec::new(), uses: 0, known };
            let Shapes { glances, all } = &mut self.own;
            if all.len() < MAX_SHAPES {
                glances.push(glance);
                all.push(new);
                return entered(all.len() - 1);
            }
            let i = self.oldest;
            (glances[i], all[i]) = (glance, new);
            self.oldest = (i + 1) % MAX_SHAPES;
            entered(i)
        })
    }

    /// The ways to try before a search; none if it is time to look for better ones.
    pub(super) fn ways(&mut self, shape: usize) -> &[Way] {
        let shape = &mut self.own.all[shape];
        shape.uses += 1;
        if shape.uses.is_multiple_of(SEARCH_AGAIN) { &[] } else { &shape.ways }
    }

    /// Ways with their cubics, from sites much like one with the jet `to` at its start, the most alike first. Each with the distance of
    /// its control points from those of the shape.
    pub(super) fn nearest(&self, shape: usize, to: &Jet) -> impl Iterator<Item = (&CarriedWay, f64)> {
        let shape = &self.own.all[shape];
        let (known, off) = shape.known.map_or((&[][..], 0.0), |(i, off)| (&self.known.all[i].carried, off));
        let all = shape.carried.iter().map(|w| (w, w.off)).chain(known.iter().map(move |w| (w, w.off + off)));
        let change = |way: &CarriedWay| Change::new(way.jacobian, to).map(|c| c.factor);
        let mut near: Vec<_> = all.filter_map(|(w, off)| Some((change(w)?, (w, off)))).collect();
        near.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        near.into_iter().take(CARRY_TRIALS).map(|(_, way)| way)
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
fn apart(p: Vec2, q: Vec2) -> f64 {
    (p.x - q.x).abs().max((p.y - q.y).abs())
}

/// A number that nearly tells the number and kinds of segments.
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
        let (_, off) = repeats.shape(&segs("M0,0C1,2 3,4.002 5,5.001"), 0.1);
        assert!((off - 0.002).abs() < 1e-12);
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
