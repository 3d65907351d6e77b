//! Any segment under any bicubic net: the refit must end, stay finite, and keep its promise or say that it did not.
//!
//! `cargo +nightly fuzz run refit`

#![no_main]

use libfuzzer_sys::fuzz_target;
use pathwarp::kurbo::{Affine, CubicBez, Point};
use pathwarp::map::BicubicNet;
use pathwarp::refit::{Options, warp_path};
use pathwarp::{Outline, Seg, Subpath};

/// Two bytes to a coordinate of 0..1000; equal bytes give equal coordinates, so that degenerate cases are easy to reach.
fn coordinate(bytes: &[u8], i: usize) -> f64 {
    let at = |k: usize| f64::from(bytes.get(k).copied().unwrap_or(0));
    (at(2 * i) * 256.0 + at(2 * i + 1)) * (1000.0 / 65535.0)
}

fn point(bytes: &[u8], i: usize) -> Point {
    Point::new(coordinate(bytes, 2 * i), coordinate(bytes, 2 * i + 1))
}

fuzz_target!(|bytes: &[u8]| {
    let Some((&first, rest)) = bytes.split_first() else { return };
    let seg = Seg::Cubic(CubicBez::new(point(rest, 0), point(rest, 1), point(rest, 2), point(rest, 3)));
    let net = std::array::from_fn(|r| std::array::from_fn(|s| point(rest, 4 + 4 * r + s)));
    let map = BicubicNet::new(&net, Affine::scale(0.001));
    let tolerance = [1.0, 0.1, 0.01, 0.001][usize::from(first % 4)];
    let options = Options::new(tolerance).with_certify(first & 4 != 0).with_merge(first & 8 != 0);
    let path = Outline { subpaths: vec![Subpath { start: seg.start(), segs: vec![seg], closed: false }] };
    let Ok(warped) = warp_path(&path, &map, &options) else { return };
    assert!(warped.path.is_finite());
    assert!(warped.report.segments_out < 4000);
    assert!(!warped.report.over_budget.is_empty() || warped.report.max_error <= tolerance);
});
