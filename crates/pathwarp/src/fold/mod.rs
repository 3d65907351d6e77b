//! Detects folds: places at which a map turns the plane over, so that the artwork overlaps itself.
//!
//! The Jacobian determinant is the local area scale. It is negative if the map mirrors the neighbourhood of a point. A map that
//! mirrors everything folds nothing; a map whose determinant changes sign on the artwork folds it.
//!
//! A [`Survey`] first tries to prove for the whole artwork that the determinant keeps its sign (`sign.rs`). If that succeeds, as it does
//! for most nets, no shape is sampled; otherwise every shape is sampled along its outline and inside (`interior.rs`).

mod interior;
mod orientation;
mod sign;
mod survey;

pub use orientation::Orientation;
pub use survey::Survey;

use crate::map::Map;
use crate::outline::Outline;

/// Examines one shape: a [`Survey`] of its own.
#[must_use]
pub fn orientation(outline: &Outline, filled: bool, map: &dyn Map) -> Orientation {
    Survey::new(map, outline.bounding_box(), outline.segs().count()).orientation(outline, filled)
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
