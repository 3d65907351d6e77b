//! The orientations of many shapes under one map.

use super::interior::interior;
use super::orientation::Orientation;
use super::sign;
use crate::budget::Budget;
use crate::error::GeometryError;
use crate::map::{Class, Creases, Jet, Map};
use crate::outline::{Outline, Seg};
use kurbo::{Affine, Point, Rect};

/// Intervals per segment.
const PER_SEGMENT: usize = 16;
/// Samples in each direction over the bounding box of a filled shape.
const GRID: usize = 24;
/// Samples that a proof may always take: those of two filled shapes.
const FOR_ANY_PROOF: usize = 2 * GRID * GRID;

/// Examines the shapes of a drawing for folds of one map.
#[derive(Debug)]
pub struct Survey<'a> {
    map: &'a dyn Map,
    creases: Creases,
    knowledge: Knowledge,
}

/// Signs known before any shape is sampled.
#[derive(Debug)]
enum Knowledge {
    /// The map is affine and folds nothing.
    Affine,
    /// The determinant has this sign, 1 or −1, on all of the artwork.
    Sign(f64),
    Nothing,
}

impl<'a> Survey<'a> {
    /// Prepares the survey of artwork with this bounding box and this number of segments. The more segments it has, the more
    /// effort goes into proving for the whole box that the map does not fold.
    #[must_use]
    pub fn new(map: &'a dyn Map, bounds: Option<Rect>, segments: usize) -> Self {
        let mut creases = Creases::default();
        let proven = |b: Rect| sign::proven(map, b, FOR_ANY_PROOF.max(segments.saturating_mul(PER_SEGMENT)));
        let knowledge = match (map.class(), bounds) {
            (Class::Affine(_), _) => Knowledge::Affine,
            (_, Some(b)) if b.is_finite() => proven(b).map_or(Knowledge::Nothing, Knowledge::Sign),
            _ => Knowledge::Nothing,
        };
        if matches!(knowledge, Knowledge::Nothing) {
            map.creases(&mut creases);
        }
        Self { map, creases, knowledge }
    }

    /// Returns `true` if shapes must be sampled: the map is not known to keep its orientation on the whole artwork.
    #[must_use]
    pub fn samples(&self) -> bool {
        matches!(self.knowledge, Knowledge::Nothing)
    }

    /// Counts the work of sampling `shapes` outlines with `segments` together, in as many copies.
    ///
    /// # Errors
    /// It exceeds the limit.
    pub fn spend(&self, shapes: usize, segments: usize, copies: usize, budget: &Budget) -> Result<(), GeometryError> {
        /// A sample is taken in a batch.
        const SAMPLE: f64 = 0.25;
        /// Share of a grid over a box that is inside of the shape, and the work to find out.
        const FILLED: f64 = 0.5;
        let samples = segments as f64 * (PER_SEGMENT + 1) as f64 + shapes as f64 * FILLED * (GRID * GRID) as f64;
        let work = if self.samples() { SAMPLE * self.map.work() * samples * copies.max(1) as f64 } else { 0.0 };
        budget.spend(work).map_err(GeometryError::Limit)
    }

    /// Returns the orientation of a shape of the artwork. Unless the survey has a proof, the determinant is sampled along `outline`, and
    /// inside it if `filled`; of an affine map no samples are taken.
    ///
    /// Folds narrower than the spacing of the samples (a sixteenth of a segment, a twenty-fourth of the bounding box) can go
    /// unnoticed.
    #[must_use]
    pub fn orientation(&self, outline: &Outline, filled: bool) -> Orientation {
        match self.knowledge {
            Knowledge::Affine => Orientation::default(),
            Knowledge::Sign(sign) => {
                let samples = outline.segs().count() * (PER_SEGMENT + 1);
                Orientation::uniform(sign, samples, outline.segs().next().map(Seg::start))
            }
            Knowledge::Nothing => self.sampled(outline, filled),
        }
    }

    /// Returns the orientation of all copies of a shape, at `places`; of the shape itself if there are none.
    #[must_use]
    pub fn orientation_of_copies(&self, outline: &Outline, places: &[Affine], filled: bool) -> Orientation {
        match (places, &self.knowledge) {
            ([], _) => self.orientation(outline, filled),
            (_, Knowledge::Nothing) => self.sampled(&outline.repeated(places), filled),
            ([first, ..], _) => {
                let one = self.orientation(outline, filled);
                Orientation {
                    positive: one.positive * places.len(),
                    negative: one.negative * places.len(),
                    first_positive: one.first_positive.map(|p| *first * p),
                    first_negative: one.first_negative.map(|p| *first * p),
                    ..one
                }
            }
        }
    }

    fn sampled(&self, outline: &Outline, filled: bool) -> Orientation {
        if self.map.prefers_batches() {
            return self.sampled_at_once(outline, filled);
        }
        let map = self.map;
        let mut out = Orientation::default();
        let mut jets = [Jet::default(); PER_SEGMENT + 1];
        for seg in outline.segs() {
            let points = along(seg);
            map.jets(&points, &mut jets);
            out.add(&points, &jets);
        }
        if let (true, Some(bounds)) = (filled, outline.bounding_box()) {
            let mut jets = [Jet::default(); GRID];
            for mut row in interior(outline, bounds, GRID) {
                row.retain(|p| self.creases.defined_at(*p));
                let jets = &mut jets[..row.len()];
                map.jets(&row, jets);
                out.add(&row, jets);
            }
        }
        out
    }

    /// The same with one call of the map for all samples.
    fn sampled_at_once(&self, outline: &Outline, filled: bool) -> Orientation {
        let mut points: Vec<Point> = outline.segs().flat_map(along).collect();
        let mut rows = vec![PER_SEGMENT + 1; points.len() / (PER_SEGMENT + 1)];
        if let (true, Some(bounds)) = (filled, outline.bounding_box()) {
            for row in interior(outline, bounds, GRID) {
                let before = points.len();
                points.extend(row.into_iter().filter(|p| self.creases.defined_at(*p)));
                rows.push(points.len() - before);
            }
        }
        let mut jets = vec![Jet::default(); points.len()];
        self.map.jets(&points, &mut jets);
        let mut out = Orientation::default();
        let (mut points, mut jets) = (points.as_slice(), jets.as_slice());
        for n in rows {
            out.add(&points[..n], &jets[..n]);
            (points, jets) = (&points[n..], &jets[n..]);
        }
        out
    }
}

/// The samples of a segment.
fn along(seg: &Seg) -> [Point; PER_SEGMENT + 1] {
    std::array::from_fn(|i| seg.eval(i as f64 / PER_SEGMENT as f64))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{BicubicNet, Formula, Net, Real};

    /// A net over the unit square that pulls its middle by `by`.
    fn net(by: f64) -> BicubicNet {
        let mut net: Net = std::array::from_fn(|r| std::array::from_fn(|s| Point::new(s as f64 / 3.0, r as f64 / 3.0)));
        for row in &mut net[1..3] {
            row[1].x += by;
        }
        BicubicNet::new(&net, Affine::IDENTITY)
    }

    /// The same map, without its algebra.
    struct Hidden(BicubicNet);
    impl Map for Hidden {
        fn jet(&self, p: Point) -> Jet {
            self.0.jet(p)
        }
    }

    #[test]
    fn a_proof_and_samples_agree() {
        let shape = Outline::from_svg("M0.1,0.1 H0.9 V0.9 H0.1 Z").unwrap();
        let bounds = shape.bounding_box();
        for (by, proves) in [(0.1, true), (1.2, false)] {
            let (known, hidden) = (net(by), Hidden(net(by)));
            let (survey, sampled) = (Survey::new(&known, bounds, 4), Survey::new(&hidden, bounds, 4));
            assert_eq!((survey.samples(), sampled.samples()), (!proves, true));
            let (a, b) = (survey.orientation(&shape, true), sampled.orientation(&shape, true));
            assert_eq!(a.folded_against(&a), b.folded_against(&b), "{by}");
            assert_eq!((a.negative > 0, a.first_positive), (b.negative > 0, b.first_positive), "{by}");
        }
    }

    #[test]
    fn copies_are_all_counted() {
        let shape = Outline::from_svg("M0,0 H0.1 V0.1 H0 Z").unwrap();
        let places = [Affine::translate((0.2, 0.2)), Affine::translate((0.5, 0.5))];
        let (known, hidden) = (net(0.1), Hidden(net(0.1)));
        let all = Some(Rect::new(0.2, 0.2, 0.6, 0.6));
        let proven = Survey::new(&known, all, 8).orientation_of_copies(&shape, &places, false);
        assert_eq!(proven, Survey::new(&hidden, all, 8).orientation_of_copies(&shape, &places, false));
        assert_eq!(proven.positive, 2 * 4 * (PER_SEGMENT + 1));
    }

    #[test]
    fn a_mirrored_drawing_does_not_fold() {
        struct Mirror;
        impl Formula for Mirror {
            fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
                (-x + (y * 0.1).sin(), y)
            }
        }
        let shape = Outline::from_svg("M0,0 H10 V10 H0 Z").unwrap();
        let o = Survey::new(&Mirror, shape.bounding_box(), 4).orientation(&shape, true);
        assert!(o.positive == 0 && o.negative > 500 && o.folded_against(&o).is_none(), "{o:?}");
    }
}
