//! Any segment under any bicubic net: the refit must terminate, and its output must be finite, and within the tolerance or
//! reported as over budget.
//!
//! `cargo +nightly fuzz run refit`

#![no_main]

use libfuzzer_sys::fuzz_target;
use pathwarp::kurbo::{Affine, CubicBez, Point};
use pathwarp::map::BicubicNet;
use pathwarp::refit::{Nodes, Options, warp_path};
use pathwarp::{Outline, Seg, Subpath};

/// Reads a coordinate in 0..1000 from two bytes. Equal bytes give equal coordinates, so degenerate cases are easy to reach.
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
    let options = Options::new(tolerance).with_certify(first & 4 != 0).with_nodes(if first & 8 != 0 { Nodes::Fewest } else { Nodes::Source });
    let path = Outline { subpaths: vec![Subpath { start: seg.start(), segs: vec![seg], closed: false }] };
    let Ok(warped) = warp_path(&path, &map, &options) else { return };
    assert!(warped.path.is_finite());
    assert!(warped.report.segments_out < 4000);
    assert!(!warped.report.unresolved.is_empty() || warped.report.max_error <= tolerance);
});
