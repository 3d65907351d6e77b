//! The stretch of a map over the artwork's box, as a grid of cells with their images: what a page shows as a heat map.

use pathwarp::kurbo::{Point, Rect};
use pathwarp::map::{Jet, Map};
use serde_json::{Value, json};

/// Cells along the longer side of the box: fine enough to see where a drawing suffers.
const CELLS: f64 = 48.0;
/// Fewest cells along the shorter side.
const FEWEST: f64 = 6.0;

/// The images of the grid's points, row by row (`null` outside of the map's domain), and for each cell the factor of lengths
/// √|det J| at its middle, negative where the map turns the drawing over against the rest.
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
    let points: Vec<Value> = grid.map(|p| map.point(p)).map(shown).collect();
    let middles = (0..rows).flat_map(|j| (0..columns).map(move |i| at(i as f64 + 0.5, j as f64 + 0.5)));
    let areas: Vec<f64> = middles.map(|p| area(&map.jet(p))).collect();
    // A map may mirror the whole drawing on purpose.
    let mirrored = areas.iter().filter(|a| **a < 0.0).count() * 2 > areas.len();
    let factor = |a: &f64| {
        let length = a.abs().sqrt().copysign(if mirrored { -a } else { *a });
        if length.is_finite() { json!(length) } else { Value::Null }
    };
    json!({ "columns": columns, "points": points, "factors": areas.iter().map(factor).collect::<Vec<_>>() })
}

fn area(jet: &Jet) -> f64 {
    jet.dx.cross(jet.dy)
}

fn shown(p: Point) -> Value {
    if p.is_finite() { json!([p.x, p.y]) } else { Value::Null }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::map::{Formula, Real};

    struct Fold;
    impl Formula for Fold {
        // Twice as wide, and folded over along y = 30.
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x * 2.0, (y - 30.0) * (y - 30.0) * 0.05)
        }
    }

    #[test]
    fn factors_and_folds() {
        let out = stretch(&Fold, Rect::new(0.0, 0.0, 120.0, 40.0));
        let (columns, factors) = (out["columns"].as_u64().unwrap() as usize, out["factors"].as_array().unwrap());
        assert_eq!((columns, factors.len() % columns), (48, 0));
        let rows = factors.len() / columns;
        assert_eq!(out["points"].as_array().unwrap().len(), (rows + 1) * (columns + 1));
        // The larger part, above, is turned over: so the rest stands out.
        let y = 40.0 * 0.5 / rows as f64;
        let expected = (2.0 * 0.1 * (30.0 - y)).sqrt();
        assert!((factors[0].as_f64().unwrap() - expected).abs() < 1e-9);
        assert!(factors.last().unwrap().as_f64().unwrap() < 0.0);
    }
}
