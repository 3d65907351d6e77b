//! Finds places where undoing a map cannot be right: two points of the source have the same image, so that its inverse can return
//! only one of them.

use crate::map::{Creases, Map};
use kurbo::{Point, Rect};

/// Samples in each direction over the box. Places smaller than the spacing can go unnoticed.
const GRID: usize = 32;
/// All samples.
pub(crate) const SAMPLES: usize = GRID * GRID;
/// Distance between a point and what the inverse makes of its image, as a share of the box's diagonal, beyond which they are two
/// points: far above the error of an inverse by Newton's method.
const APART: f64 = 1e-6;

/// A point of the source whose image comes back as another point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ambiguity {
    pub(crate) source: Point,
    pub(crate) returned: Point,
    pub(crate) image: Point,
}

/// Returns the first point inside `frame` that `inverse` does not bring back from its image under `map`. Points without an image
/// or without a preimage are passed over: they are errors or warnings of their own.
pub(crate) fn ambiguity(map: &dyn Map, inverse: &dyn Map, frame: Rect) -> Option<Ambiguity> {
    let mut creases = Creases::default();
    map.creases(&mut creases);
    // The middles of cells: the two ends of a seam along the box's edge share their image by design.
    let at = |i: usize, j: usize| {
        let share = |n: usize| (n as f64 + 0.5) / GRID as f64;
        Point::new(frame.x0 + frame.width() * share(i), frame.y0 + frame.height() * share(j))
    };
    let sources: Vec<Point> = (0..SAMPLES).map(|n| at(n % GRID, n / GRID)).filter(|p| creases.defined_at(*p)).collect();
    let mut images = vec![Point::ORIGIN; sources.len()];
    map.points(&sources, &mut images);
    let mut returned = vec![Point::ORIGIN; sources.len()];
    inverse.points(&images, &mut returned);
    let apart = APART * frame.width().hypot(frame.height());
    let all = sources.into_iter().zip(images).zip(returned).map(|((source, image), returned)| Ambiguity {
        source,
        returned,
        image,
    });
    all.filter(|a| a.image.is_finite() && a.returned.is_finite()).find(|a| a.source.distance(a.returned) > apart)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{AffineMap, Formula, NewtonInverse, Real};
    use kurbo::Affine;
    use std::sync::Arc;

    /// Folds along x = 0.
    struct Fold;
    impl Formula for Fold {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x * x, y)
        }
    }

    #[test]
    fn a_fold_is_ambiguous_and_one_side_of_it_is_not() {
        let inverse = |frame| NewtonInverse::over(Arc::new(Fold), frame, 0.25);
        let both = Rect::new(-1.0, 0.0, 2.0, 1.0);
        let found = ambiguity(&Fold, &inverse(both), both).unwrap();
        assert!((found.source.x + found.returned.x).abs() < 1e-6, "{found:?}");
        let half = Rect::new(1.0, 0.0, 2.0, 1.0);
        assert_eq!(ambiguity(&Fold, &inverse(half), half), None);
        let turn = Affine::rotate(1.0);
        assert_eq!(ambiguity(&AffineMap(turn), &AffineMap(turn.inverse()), both), None);
    }
}
