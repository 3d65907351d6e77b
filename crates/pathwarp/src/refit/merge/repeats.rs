//! Runs of the same shape at different places, as the letters of a text: the legs that merged one are tried first on the next.

use super::limits::{MAX_SHAPES, MAX_WAYS, SAME_SHAPE, SEARCH_AGAIN};
use super::search::Leg;
use crate::outline::Seg;
use kurbo::{Point, Vec2};

/// A way through the places of a run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Way {
    /// `None`: the segments' own pieces.
    pub(super) legs: Option<Vec<Leg>>,
    /// Number of pieces.
    pub(super) pieces: usize,
}

/// A shape of runs that were searched.
#[derive(Debug)]
struct Shape {
    /// Control points relative to the first.
    points: Vec<Vec2>,
    /// Ways that were the best somewhere, those of the fewest pieces first.
    ways: Vec<Way>,
    /// How often the shape has come again.
    uses: usize,
}

/// The shapes of the last runs.
#[derive(Debug, Default)]
pub(super) struct Repeats {
    /// Number and kinds of the segments of each shape.
    kinds: Vec<u64>,
    shapes: Vec<Shape>,
    /// The entry to be replaced next, once there are [`MAX_SHAPES`].
    oldest: usize,
}

impl Repeats {
    /// The index of the shape of a run, which is entered if it is new.
    pub(super) fn shape(&mut self, segs: &[Seg], tolerance: f64) -> usize {
        let (kinds, near) = (kinds(segs), SAME_SHAPE * tolerance);
        let start = segs.first().map_or(Point::ORIGIN, Seg::start);
        let same = |s: &Shape| {
            points(segs, start).zip(&s.points).all(|(p, q)| (p.x - q.x).abs() <= near && (p.y - q.y).abs() <= near)
        };
        let known = self.kinds.iter().zip(&self.shapes).position(|(k, s)| *k == kinds && same(s));
        known.unwrap_or_else(|| {
            let new = Shape { points: points(segs, start).collect(), ways: Vec::new(), uses: 0 };
            if self.shapes.len() < MAX_SHAPES {
                self.kinds.push(kinds);
                self.shapes.push(new);
                return self.shapes.len() - 1;
            }
            let i = self.oldest;
            (self.kinds[i], self.shapes[i]) = (kinds, new);
            self.oldest = (i + 1) % MAX_SHAPES;
            i
        })
    }

    /// The ways to try before a search; none if it is time to look for better ones.
    pub(super) fn ways(&mut self, shape: usize) -> &[Way] {
        let shape = &mut self.shapes[shape];
        shape.uses += 1;
        if shape.uses.is_multiple_of(SEARCH_AGAIN) { &[] } else { &shape.ways }
    }

    /// Remembers the result of a search.
    pub(super) fn add(&mut self, shape: usize, way: Way) {
        let ways = &mut self.shapes[shape].ways;
        if !ways.contains(&way) {
            let at = ways.partition_point(|w| w.pieces <= way.pieces);
            ways.insert(at, way);
            ways.truncate(MAX_WAYS);
        }
    }
}

/// A number that nearly tells the number and kinds of segments.
fn kinds(segs: &[Seg]) -> u64 {
    segs.iter().fold(segs.len() as u64, |hash, seg| {
        let kind = match seg {
            Seg::Line(_) => 1,
            Seg::Quad(_) => 2,
            Seg::Cubic(_) => 3,
            Seg::Arc(_) => 4,
        };
        hash.wrapping_mul(31).wrapping_add(kind)
    })
}

/// The points that determine the segments, without their starts.
fn points(segs: &[Seg], start: Point) -> impl Iterator<Item = Vec2> {
    segs.iter().flat_map(move |seg| match seg {
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

    fn segs(d: &str) -> Vec<Seg> {
        Outline::from_svg(d).unwrap().subpaths[0].segs.clone()
    }

    #[test]
    fn runs_of_the_same_shape_are_found_elsewhere() {
        let mut repeats = Repeats::default();
        let mut shape = |d: &str| repeats.shape(&segs(d), 0.1);
        assert_eq!(shape("M0,0C1,2 3,4 5,5Q6,6 9,1"), 0);
        assert_eq!(shape("M0,0C1,2 3,4 5,5"), 1);
        assert_eq!(shape("M70.001,-8C71,-6 73,-4 75,-3Q76,-2 79,-7"), 0);
        assert_eq!(shape("M70,1C71,3 73,5 75,6"), 1);
        assert_eq!(shape("M70,-8C71,-6 73,-4 75,-3Q76,-2 79,-7.1"), 2);
        assert_eq!(shape("M70,-8C71,-6 73,-4 75,-3L79,-7"), 3);
    }

    #[test]
    fn the_fewest_pieces_are_tried_first_and_searches_repeated() {
        let mut repeats = Repeats::default();
        let shape = repeats.shape(&segs("M0,0C1,2 3,4 5,5"), 0.1);
        let (many, few) = (Way { legs: None, pieces: 3 }, Way { legs: Some(Vec::new()), pieces: 1 });
        for way in [&many, &few, &many] {
            repeats.add(shape, way.clone());
        }
        let tried: Vec<usize> = (0..SEARCH_AGAIN).map(|_| repeats.ways(shape).len()).collect();
        assert_eq!(tried[..SEARCH_AGAIN - 1], vec![2; SEARCH_AGAIN - 1]);
        assert_eq!(tried[SEARCH_AGAIN - 1], 0);
        assert_eq!(repeats.ways(shape), [few, many]);
    }
}
