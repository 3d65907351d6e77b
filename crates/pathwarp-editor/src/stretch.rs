//! The stretch of a map over the artwork's box, as a grid of cells with their images, which the page shows as a heat map.

use pathwarp::kurbo::{Point, Rect};
use pathwarp::map::{Jet, Map};
use serde_json::{Value, json};

/// Cells along the longer side of the box, fine enough to show local distortion.
const CELLS: f64 = 80.0;
/// Fewest cells along the shorter side.
const FEWEST: f64 = 6.0;

/// Relative change of areas that counts as rounding: maps that keep areas are computed in floating point.
const SAME_AREA: f64 = 1e-6;

/// Returns the images of the grid's points, row by row (`null` outside of the map's domain), and for each cell the factor of lengths at its
/// centre, in the direction of the largest change; it is negative where the orientation differs from the majority's.
pub(crate) fn stretch(map: &dyn Map, frame: Rect) -> Value {
    let longer = frame.width().max(frame.height());
    let cells = |side: f64| (CELLS * side / longer).round().max(FEWEST) as usize;
    if longer <= 0.0 {
        return Value::Null;
    }
    let (columns, rows) = (cells(frame.width()), cells(frame.height()));
    let at = |i: f64, j: f64| {
        let (u, v) = (i / columns as f64, j / rows as f64);
        Point::new(frame.x0 + u * frame.width(), frame.y0 + v * frame.height())
    };
    let grid = (0..=rows).flat_map(|j| (0..=columns).map(move |i| at(i as f64, j as f64)));
    let point = |p: Point| if p.is_finite() { json!([p.x, p.y]) } else { Value::Null };
    let points: Vec<Value> = grid.map(|p| point(map.point(p))).collect();
    let middles = (0..rows).flat_map(|j| (0..columns).map(move |i| at(i as f64 + 0.5, j as f64 + 0.5)));
    let factors: Vec<f64> = middles.map(|p| factor(&map.jet(p))).collect();
    // The map may mirror the whole drawing.
    let mirrored = factors.iter().filter(|f| **f < 0.0).count() * 2 > factors.len();
    let sign = if mirrored { -1.0 } else { 1.0 };
    let shown = |f: &f64| if f.is_finite() { json!(sign * f) } else { Value::Null };
    json!({ "columns": columns, "points": points, "factors": factors.iter().map(shown).collect::<Vec<_>>() })
}

/// Returns the singular value of the derivative whose logarithm is farther from 0, with the sign of the determinant. If the map keeps
/// areas, as waves and swirls do, both are equally far, and the larger one is returned.
fn factor(jet: &Jet) -> f64 {
    let (a, b, c) = (jet.dx.hypot2(), jet.dy.hypot2(), jet.dx.dot(jet.dy));
    let area = jet.dx.cross(jet.dy);
    let longest = (0.5 * (a + b) + (0.5 * (a - b)).hypot(c)).sqrt();
    let grows = area.abs() >= 1.0 - SAME_AREA;
    (if grows || longest == 0.0 { longest } else { area.abs() / longest }).copysign(area)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::map::{Formula, Real};

    struct Fold;
    impl Formula for Fold {
        // Twice as wide, and folded along y = 30.
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x * 2.0, (y - 30.0) * (y - 30.0) * 0.05)
        }
    }

    struct Shear;
    impl Formula for Shear {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x, y + x * 1.5)
        }
    }

    /// A shear by k keeps areas, and stretches one direction by (k + √(k² + 4))/2, which is 2 for k = 3/2.
    #[test]
    fn maps_that_keep_areas_stretch_lengths() {
        let out = stretch(&Shear, Rect::new(0.0, 0.0, 10.0, 10.0));
        let factors = out["factors"].as_array().unwrap();
        assert!(factors.iter().all(|f| (f.as_f64().unwrap() - 2.0).abs() < 1e-9), "{factors:?}");
    }

    #[test]
    fn factors_and_folds() {
        let out = stretch(&Fold, Rect::new(0.0, 0.0, 120.0, 40.0));
        let (columns, factors) = (out["columns"].as_u64().unwrap() as usize, out["factors"].as_array().unwrap());
        assert_eq!((columns, factors.len() % columns), (CELLS as usize, 0));
        let rows = factors.len() / columns;
        assert_eq!(out["points"].as_array().unwrap().len(), (rows + 1) * (columns + 1));
        // The larger part, above the fold, is mirrored, so the rest is negative. At the top, heights grow more than widths, which double;
        // near the fold, they shrink to almost nothing.
        let height = |row: usize| 0.1 * (30.0 - 40.0 * (row as f64 + 0.5) / rows as f64);
        assert!((factors[0].as_f64().unwrap() - height(0)).abs() < 1e-9);
        let last = (0..rows).rfind(|&row| height(row) > 0.0).unwrap();
        assert!((factors[last * columns].as_f64().unwrap() - height(last)).abs() < 1e-9);
        assert!(factors.last().unwrap().as_f64().unwrap() < 0.0);
    }
}
