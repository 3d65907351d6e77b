//! Detects folds: places at which a map turns the plane over, so that the artwork overlaps itself.
//!
//! The Jacobian determinant is the local area scale. It is negative if the map mirrors the neighbourhood of a point. A map that
//! mirrors everything folds nothing; a map whose determinant changes sign on the artwork folds it.

mod interior;

use crate::map::{Class, Creases, Jet, Map};
use crate::outline::Outline;
use interior::interior;
use kurbo::Point;

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

/// Intervals per segment.
const PER_SEGMENT: usize = 16;
/// Samples in each direction over the bounding box of a filled shape.
const GRID: usize = 24;

/// Samples the determinant along `outline`, and inside it if `filled`. An affine map folds nothing; no samples are taken.
///
/// Folds narrower than the spacing of the samples (a sixteenth of a segment, a twenty-fourth of the bounding box) can go
/// unnoticed.
#[must_use]
pub fn orientation(outline: &Outline, filled: bool, map: &dyn Map) -> Orientation {
    let mut out = Orientation::default();
    if let Class::Affine(_) = map.class() {
        return out;
    }
    let mut creases = Creases::default();
    map.creases(&mut creases);
    for seg in outline.segs() {
        let points: [Point; PER_SEGMENT + 1] = std::array::from_fn(|i| seg.eval(i as f64 / PER_SEGMENT as f64));
        out.sample(&points, map);
    }
    if let (true, Some(bounds)) = (filled, outline.bounding_box()) {
        for mut row in interior(outline, bounds, GRID) {
            row.retain(|p| creases.defined_at(*p));
            out.sample(&row, map);
        }
    }
    out
}

impl Orientation {
    /// Adds samples in a row.
    fn sample(&mut self, points: &[Point], map: &dyn Map) {
        let mut jets = vec![Jet::default(); points.len()];
        map.jets(points, &mut jets);
        let mut last = 0.0;
        for (p, j) in points.iter().zip(&jets) {
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

    /// The samples of both.
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

    /// A point of this shape that is turned over relative to the majority of the artwork's samples, `all`.
    #[must_use]
    pub fn folded_against(&self, all: &Self) -> Option<Point> {
        if all.positive >= all.negative { self.first_negative } else { self.first_positive }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Formula, Real};

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
        // Entirely on the mirrored side: no fold alone, but one relative to artwork that is not mirrored.
        let left = Outline::from_svg("M-6,0 H-5 V1 H-6 Z").unwrap();
        let l = orientation(&left, true, &Fold);
        assert!(l.folded_against(&l).is_none() && l.folded_against(&l.and(&o).and(&o)).is_some());
    }
}
