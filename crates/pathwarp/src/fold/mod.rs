//! Detects folds, at which a map turns the plane over, so that the artwork overlaps itself.
//!
//! The Jacobian determinant is the local scale of areas, negative where the map mirrors the neighbourhood of a point. A map that
//! mirrors everything folds nothing; a map whose determinant changes sign on the artwork folds it.
//!
//! A [`Survey`] first tries to prove for the whole artwork that the determinant keeps its sign (`sign.rs`). If that succeeds, as it does
//! for most nets, no shape is sampled; otherwise every shape is sampled along its outline and inside.

mod sign;

use crate::budget::Budget;
use crate::error::GeometryError;
use crate::map::{Class, Creases, Jet, Map};
use crate::outline::{Outline, Seg, boundary};
use crate::param::Frame;
use kurbo::{Affine, Point, Rect};

/// Returns the orientation of one shape, by a [`Survey`] of this shape alone.
#[must_use]
pub fn orientation(outline: &Outline, filled: bool, map: &dyn Map) -> Orientation {
    Survey::new(map, outline.bounding_box(), outline.segs().count()).orientation(outline, filled)
}

/// Intervals per segment.
const PER_SEGMENT: usize = 16;
/// Samples in each direction over the bounding box of a filled shape.
const GRID: usize = 24;
/// Samples that a proof may always take, as many as for two filled shapes.
const MIN_PROOF_SAMPLES: usize = 2 * GRID * GRID;

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
    /// The map is affine, and folds nothing.
    Affine,
    /// The determinant has this sign, 1 or −1, on all of the artwork.
    Sign(f64),
    Nothing,
}

impl<'a> Survey<'a> {
    /// Prepares the survey of artwork with this bounding box and number of segments. The more segments there are, the more
    /// samples may be taken to prove for the whole box that the map does not fold.
    #[must_use]
    pub fn new(map: &'a dyn Map, bounds: Option<Rect>, segments: usize) -> Self {
        let mut creases = Creases::default();
        let proven = |b: Rect| sign::proven(map, b, MIN_PROOF_SAMPLES.max(segments.saturating_mul(PER_SEGMENT)));
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

    /// Returns `true` if shapes must be sampled, because nothing is known about the map's orientation on the whole artwork.
    #[must_use]
    pub fn samples(&self) -> bool {
        matches!(self.knowledge, Knowledge::Nothing)
    }

    /// Charges the work of sampling `copies` copies of `shapes` outlines with `segments` segments in all.
    ///
    /// # Errors
    /// [`GeometryError::Limit`] when the work exceeds the limit.
    pub fn spend(&self, shapes: usize, segments: usize, copies: usize, budget: &Budget) -> Result<(), GeometryError> {
        /// Work of a sample taken in a batch, as a fraction of a single one.
        const SAMPLE: f64 = 0.25;
        /// Fraction of the grid over a shape's box that lies inside the shape, with the work of finding these points.
        const FILLED: f64 = 0.5;
        let samples = segments as f64 * (PER_SEGMENT + 1) as f64 + shapes as f64 * FILLED * (GRID * GRID) as f64;
        let work = if self.samples() { SAMPLE * self.map.work() * samples * copies.max(1) as f64 } else { 0.0 };
        budget.spend(work).map_err(GeometryError::Limit)
    }

    /// Returns the orientation of a shape of the artwork. Unless the map is affine or the survey has a proof, the determinant is sampled
    /// along `outline`, and inside it if `filled`.
    ///
    /// Folds narrower than the spacing of the samples (a sixteenth of a segment, a twenty-fourth of the bounding box) can go
    /// unnoticed.
    #[must_use]
    pub fn orientation(&self, outline: &Outline, filled: bool) -> Orientation {
        match self.knowledge {
            Knowledge::Affine => Orientation::default(),
            Knowledge::Sign(sign) => {
                let samples = outline.segs().count() * (PER_SEGMENT + 1);
                let first = outline.segs().next().map(Seg::start);
                if sign > 0.0 {
                    Orientation { positive: samples, first_positive: first, ..Orientation::default() }
                } else {
                    Orientation { negative: samples, first_negative: first, ..Orientation::default() }
                }
            }
            Knowledge::Nothing => self.sample(outline, filled),
        }
    }

    /// Returns the orientation of all copies of a shape, its images under `places`; of the shape itself if `places` is empty.
    #[must_use]
    pub fn orientation_of_copies(&self, outline: &Outline, places: &[Affine], filled: bool) -> Orientation {
        match (places, &self.knowledge) {
            ([], _) => self.orientation(outline, filled),
            (_, Knowledge::Nothing) => self.sample(&outline.repeated(places), filled),
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

    /// Samples a shape along its outline and, if it is filled, inside.
    fn sample(&self, outline: &Outline, filled: bool) -> Orientation {
        if self.map.prefers_batches() {
            return self.sample_at_once(outline, filled);
        }
        let map = self.map;
        let mut out = Orientation::default();
        let mut jets = [Jet::default(); PER_SEGMENT + 1];
        for seg in outline.segs() {
            let points = samples_of(seg);
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

    /// Samples a shape with one call of the map.
    fn sample_at_once(&self, outline: &Outline, filled: bool) -> Orientation {
        let mut points: Vec<Point> = outline.segs().flat_map(samples_of).collect();
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

fn samples_of(seg: &Seg) -> [Point; PER_SEGMENT + 1] {
    std::array::from_fn(|i| seg.eval(i as f64 / PER_SEGMENT as f64))
}

// The orientation of a shape under a map.

/// Signs of the Jacobian determinant over samples of a shape.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Orientation {
    /// Number of samples with a positive determinant.
    pub positive: usize,
    /// Number of samples with a negative determinant.
    pub negative: usize,
    /// Number of sign changes between neighbouring samples.
    pub changes: usize,
    /// The first sample with a positive determinant.
    pub first_positive: Option<Point>,
    /// The first sample with a negative determinant.
    pub first_negative: Option<Point>,
}

impl Orientation {
    /// Adds a row of neighbouring samples.
    fn add(&mut self, points: &[Point], jets: &[Jet]) {
        let mut last = 0.0;
        for (p, j) in points.iter().zip(jets) {
            let det = j.det();
            if !det.is_finite() || det == 0.0 {
                continue;
            }
            if det > 0.0 {
                self.positive += 1;
                self.first_positive.get_or_insert(*p);
            } else {
                self.negative += 1;
                self.first_negative.get_or_insert(*p);
            }
            if det * last < 0.0 {
                self.changes += 1;
            }
            last = det;
        }
    }

    /// Returns the orientation of the samples of both.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        Self {
            positive: self.positive + other.positive,
            negative: self.negative + other.negative,
            changes: self.changes + other.changes,
            first_positive: self.first_positive.or(other.first_positive),
            first_negative: self.first_negative.or(other.first_negative),
        }
    }

    /// Returns the orientation against which shapes are compared, from the samples of all artwork: the orientation of most samples, unless
    /// the map turns over most of the artwork but not the corners of the artwork's box, `bounds`.
    #[must_use]
    pub fn usual(&self, map: &dyn Map, bounds: Rect) -> Self {
        let is_mostly_negative = self.positive > 0 && self.negative > self.positive;
        let are_corners_positive = || Frame::new(bounds).corners().into_iter().all(|c| map.jet(c).det() > 0.0);
        let positive = if is_mostly_negative && are_corners_positive() { self.negative } else { self.positive };
        Self { positive, ..*self }
    }

    /// Returns a point of this shape that is turned over relative to most samples of the artwork, `all`.
    #[must_use]
    pub fn folded_against(&self, all: &Self) -> Option<Point> {
        if all.positive >= all.negative { self.first_negative } else { self.first_positive }
    }
}

/// Flattening tolerance, relative to the diagonal of the outline, far below the spacing of the grid.
const FLATNESS: f64 = 1e-3;

/// Returns the points of an `n` × `n` grid over `bounds` that lie inside the outline by the nonzero rule, row by row. Open subpaths
/// are closed by a line, as SVG fills them.
///
/// Every line of the flattened outline is visited once and recorded in the rows that it crosses. The cost is the number of lines and
/// crossings, whereas a winding number for each point would cost segments times points.
fn interior(outline: &Outline, bounds: Rect, n: usize) -> Vec<Vec<Point>> {
    let x = |i: usize| bounds.x0 + bounds.width() * (i as f64 + 0.5) / n as f64;
    let y = |k: usize| bounds.y0 + bounds.height() * (k as f64 + 0.5) / n as f64;
    let first_row_below = |y: f64| {
        let k = ((y - bounds.y0) / bounds.height() * n as f64 - 0.5).ceil();
        k.clamp(0.0, n as f64) as usize
    };
    // Where lines cross each row: the abscissa, and 1 for downwards or −1 for upwards.
    let mut crossings: Vec<Vec<(f64, i32)>> = vec![Vec::new(); n];
    let tolerance = FLATNESS * bounds.width().hypot(bounds.height());
    boundary(outline.to_bez_path(tolerance), tolerance, |a, b| {
        let (top, bottom, direction) = if a.y < b.y { (a, b, 1) } else { (b, a, -1) };
        if top.y < bottom.y {
            let rows = first_row_below(top.y)..first_row_below(bottom.y);
            for (k, row) in rows.clone().zip(&mut crossings[rows]) {
                let t = (y(k) - top.y) / (bottom.y - top.y);
                row.push((top.x + (bottom.x - top.x) * t, direction));
            }
        }
    });
    let row = |(k, mut crossings): (usize, Vec<(f64, i32)>)| {
        crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut crossings, mut winding) = (crossings.into_iter().peekable(), 0);
        let is_inside = |p: &Point| {
            while let Some((_, direction)) = crossings.next_if(|(x, _)| *x <= p.x) {
                winding += direction;
            }
            winding != 0
        };
        (0..n).map(|i| Point::new(x(i), y(k))).filter(is_inside).collect()
    };
    crossings.into_iter().enumerate().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{BicubicNet, Formula, Net, Real};
    use kurbo::{Shape, Vec2};

    /// Folds along x = 0.
    struct Fold;
    impl Formula for Fold {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x * x, y)
        }
    }

    #[test]
    fn a_fold_is_found_on_the_outline_and_inside() {
        let across = Outline::from_svg("M-5,0 H10 V10 H-5 Z").unwrap();
        let o = orientation(&across, true, &Fold);
        assert!(o.positive > 0 && o.negative > 0 && o.changes > 0);
        assert!(o.folded_against(&o).unwrap().x < 0.0, "the smaller part is folded");
        let right = Outline::from_svg("M5,0 H10 V10 H5 Z").unwrap();
        let o = orientation(&right, true, &Fold);
        assert!(o.negative == 0 && o.folded_against(&o).is_none());
        // A shape entirely on the mirrored side folds only relative to artwork that is not mirrored.
        let left = Outline::from_svg("M-6,0 H-5 V1 H-6 Z").unwrap();
        let l = orientation(&left, true, &Fold);
        assert!(l.folded_against(&l).is_none() && l.folded_against(&l.and(&o).and(&o)).is_some());
    }

    /// Returns a net over the unit square whose middle is pulled by `by`.
    fn net(by: f64) -> BicubicNet {
        let mut net: Net = std::array::from_fn(|r| std::array::from_fn(|s| Point::new(s as f64 / 3.0, r as f64 / 3.0)));
        for row in &mut net[1..3] {
            row[1].x += by;
        }
        BicubicNet::new(&net, Affine::IDENTITY)
    }

    /// A net that hides its algebra, so that nothing can be proven.
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

    /// The middle, which is the larger part of the artwork, is turned over.
    #[test]
    fn what_is_turned_over_folds_though_it_is_the_larger_part() {
        struct Middle;
        impl Formula for Middle {
            fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
                (x * x * x - x * S::from(48.0), y)
            }
        }
        let shapes = ["M-5,0 H-2 V1 H-5 Z", "M-1,0 H3 V1 H-1 Z", "M4.5,0 H5 V1 H4.5 Z"];
        let shapes = shapes.map(|d| Outline::from_svg(d).unwrap());
        let folds = |shapes: &[Outline], bounds: Rect| {
            let each: Vec<_> = shapes.iter().map(|s| orientation(s, true, &Middle)).collect();
            let all = each.iter().fold(Orientation::default(), |all, o| all.and(o));
            let usual = all.usual(&Middle, bounds);
            (all.negative > all.positive, each.iter().map(|o| o.folded_against(&usual).is_some()).collect::<Vec<_>>())
        };
        assert_eq!(folds(&shapes, Rect::new(-5.0, 0.0, 5.0, 1.0)), (true, vec![true, true, false]));
        // In artwork that ends where the map turns it over, the larger part is not turned over.
        assert_eq!(folds(&shapes[..2], Rect::new(-5.0, 0.0, 3.0, 1.0)), (true, vec![true, false]));
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

    /// The sweep agrees with kurbo's winding numbers, computed point by point from the curves, except on the outline.
    #[test]
    fn the_sweep_agrees_with_winding_numbers() {
        const N: usize = 24;
        for data in [
            "M0,0 H100 V80 H0 Z M20,20 V60 H80 V20 Z",
            "M50,0 C110,10 90,100 40,90 S-20,10 50,0 Z M30,30 h20 v20 h-20 Z",
            "M0,50 A50,50 0 1 1 100,50 A50,50 0 1 1 0,50 Z",
            "M0,0 L100,0 L0,70 L100,70 Z",
        ] {
            let outline = Outline::from_svg(data).unwrap();
            let bounds = outline.bounding_box().unwrap();
            let path = outline.to_bez_path(1e-6);
            let found = interior(&outline, bounds, N).concat();
            assert!(found.len() > N, "{data}");
            for j in 0..N {
                for i in 0..N {
                    let at = |k: usize, from: f64, size: f64| from + size * (k as f64 + 0.5) / N as f64;
                    let p = Point::new(at(i, bounds.x0, bounds.width()), at(j, bounds.y0, bounds.height()));
                    let near = [-0.2, 0.2].iter().any(|d| path.winding(p + Vec2::new(*d, 0.0)) != path.winding(p));
                    assert!(near || (path.winding(p) != 0) == found.contains(&p), "{data} at {p}");
                }
            }
        }
    }

    #[test]
    fn open_subpaths_are_closed_and_flat_ones_are_empty() {
        let square = Outline::from_svg("M0,0 H10 V10 H0").unwrap();
        assert_eq!(interior(&square, square.bounding_box().unwrap(), 4).concat().len(), 16);
        let line = Outline::from_svg("M0,0 H10").unwrap();
        assert!(interior(&line, line.bounding_box().unwrap(), 4).concat().is_empty());
    }
}
