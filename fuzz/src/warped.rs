//! Checks of a path under a map: finite, deterministic, and within the tolerance by an independent measurement.

use crate::limits;
use pathwarp::budget::Budget;
use pathwarp::kurbo::{Point, Rect, Shape as _};
use pathwarp::map::Map;
use pathwarp::recipe::BuiltRecipe;
use pathwarp::refit::{Assurance, Options, RefittedPath, warp_path};
use pathwarp::{Outline, Seg};
use pathwarp_oracle::curves::Curved as _;
use pathwarp_oracle::{Run, far};
use std::sync::Arc;

/// Samples of each source segment.
const SAMPLES: usize = 16;
/// Most segments of a result that is measured.
const MOST_SEGMENTS: usize = 100;
/// Accuracy of the measure, relative to the tolerance.
const ACCURACY: f64 = 1e-3;
/// Rounding of coordinates, relative to the largest one.
const ROUNDING: f64 = 1e-12;
/// The finest tolerance, relative to the largest coordinate, that rounding allows for: finer ones are reported.
const FINEST: f64 = 1e-13;
/// By how much a sampled error may be exceeded: the error between samples is an estimate.
const ESTIMATED: f64 = 1.25;

/// Warps a path by a recipe and checks the result.
pub fn check_built(path: &Outline, built: &BuiltRecipe, options: &Options) {
    for copy in built.placement.copies.iter().take(4) {
        assert!(copy.is_finite(), "a copy is placed by {copy:?}");
    }
    check_map(path, &built.map, options);
}

/// Warps a path by a map and checks the result.
pub fn check_map(path: &Outline, map: &dyn Map, options: &Options) {
    let warp = || warp_path(path, map, &options.clone().with_budget(Arc::new(Budget::new(limits()))));
    let first = warp();
    let again = warp();
    match (&first, &again) {
        (Ok(a), Ok(b)) => assert!(same(a, b), "two runs differ: {a:?} and {b:?}"),
        (Err(_), Err(_)) => return,
        _ => panic!("two runs differ: {first:?} and {again:?}"),
    }
    let Ok(warped) = first else { return };
    assert!(warped.path.is_finite(), "{:?}", warped.path);
    let report = &warped.report;
    assert!(report.max_error >= 0.0, "{report:?}");
    let size = path.segs().map(extent).chain([largest(warped.path.control_box())]).fold(0.0, f64::max);
    let coarse = options.tolerance < FINEST * size * (1.0 - ROUNDING);
    assert!(!coarse || report.resolution.is_some(), "no word about {size}: {report:?}");
    if !report.unresolved.is_empty() {
        return;
    }
    let allowed = if report.assurance == Assurance::Exact { f64::INFINITY } else { options.tolerance };
    assert!(report.max_error <= allowed, "{report:?}");
    measure(path, map, &warped, options.tolerance);
}

/// The largest coordinate of a box.
fn largest(b: Rect) -> f64 {
    [b.x0, b.y0, b.x1, b.y1].iter().fold(0.0, |a: f64, v| a.max(v.abs()))
}

/// The size of the numbers that a segment is computed with.
fn extent(seg: &Seg) -> f64 {
    match seg {
        Seg::Arc(a) => a.center.to_vec2().hypot() + a.a.hypot() + a.b.hypot(),
        other => largest(other.to_cubic().bounding_box()),
    }
}

/// The same bits, also for numbers that are not equal to themselves.
fn same(a: &RefittedPath, b: &RefittedPath) -> bool {
    format!("{a:?}") == format!("{b:?}")
}

/// Measures the distance from the true image to the result.
fn measure(path: &Outline, map: &dyn Map, warped: &RefittedPath, tolerance: f64) {
    let pieces = warped.path.curves();
    if pieces.is_empty() || pieces.len() > MOST_SEGMENTS {
        return;
    }
    let result = Run::of(&pieces);
    let result = [result.sampled(64, tolerance)];
    for seg in path.segs() {
        for i in 0..=SAMPLES {
            let at = seg.eval(i as f64 / SAMPLES as f64);
            let image = map.point(at);
            let size = image.to_vec2().hypot() + derivative_size(map, at) * at.to_vec2().hypot();
            if !image.is_finite() || !size.is_finite() {
                continue;
            }
            let estimated = if warped.report.assurance <= Assurance::Checked { ESTIMATED } else { 1.0 };
            let (found, _) = far(&[image], &result);
            assert!(
                found <= tolerance * (estimated + ACCURACY) + ROUNDING * size,
                "{image:?}, the image of {at:?}, is {found} from the result; {:?} within {tolerance}",
                warped.report
            );
        }
    }
}

/// Growth of rounding errors of a point by the map.
fn derivative_size(map: &dyn Map, at: Point) -> f64 {
    let jet = map.jet(at);
    let size = jet.dx.hypot() + jet.dy.hypot();
    if size.is_finite() { size } else { f64::INFINITY }
}
