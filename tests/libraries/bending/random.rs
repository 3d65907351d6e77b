//! Random segments under random maps: the refit stays within its budget, and its output is finite and within the tolerance, or the
//! report warns. The generators prefer degenerate cases: points that coincide, or are collinear, or nearly so.

mod cases;
pub(crate) mod maps;

use maps::{Waves, map};
use pathwarp::kurbo::{CubicBez, Line, Point, QuadBez};
use pathwarp::map::Map;
use pathwarp::outline::EllipticArc;
use pathwarp::refit::{Assurance, Nodes, Options, warp_path};
use pathwarp::{Outline, Seg, Subpath};
use proptest::prelude::*;
use std::f64::consts::TAU;

/// Coordinates on a coarse grid, which often coincide or line up; some are slightly off it.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => (0u8..=8).prop_map(|i| f64::from(i) * 125.0),
        2 => 0.0..1000.0f64,
        1 => ((0u8..=8), -1e-7..1e-7f64).prop_map(|(i, e)| f64::from(i) * 125.0 + e),
    ]
}

fn point() -> impl Strategy<Value = Point> {
    (coordinate(), coordinate()).prop_map(Point::from)
}

fn seg() -> impl Strategy<Value = Seg> {
    prop_oneof![
        1 => (point(), point()).prop_map(|(a, b)| Seg::Line(Line::new(a, b))),
        1 => (point(), point(), point()).prop_map(|(a, b, c)| Seg::Quad(QuadBez::new(a, b, c))),
        4 => (point(), point(), point(), point()).prop_map(|(a, b, c, d)| Seg::Cubic(CubicBez::new(a, b, c, d))),
        // Handles on the ends, and cubics along one line.
        1 => (point(), point(), point()).prop_map(|(a, b, c)| Seg::Cubic(CubicBez::new(a, a, b, c))),
        1 => (point(), point(), -2.0..3.0f64, -2.0..3.0f64)
            .prop_map(|(a, b, s, t)| Seg::Cubic(CubicBez::new(a, a.lerp(b, s), a.lerp(b, t), b))),
        1 => (point(), 1.0..300.0f64, 0.01..300.0f64, 0.0..6.3f64, -6.2..6.2f64).prop_map(|(c, a, b, start, sweep)| {
            Seg::Arc(EllipticArc::new(c, (a, a * 0.3).into(), (-b * 0.3, b).into(), start, sweep))
        }),
    ]
}

/// Waves of which the steepest fold over.
fn waves() -> impl Strategy<Value = Waves> {
    let pair = |range: std::ops::Range<f64>| prop::array::uniform2(range);
    (pair(30.0..1500.0), pair(0.0..0.25), pair(0.0..TAU)).prop_map(|(length, steep, phase)| Waves {
        length,
        height: [length[0] * steep[0], length[1] * steep[1]],
        phase,
    })
}

/// Checks that the image of `seg` is within the tolerance or reported, and that the reversed segment gives it reversed.
fn holds(seg: Seg, map: &dyn Map, options: &Options) -> Result<(), TestCaseError> {
    let path = Outline { subpaths: vec![Subpath { start: seg.start(), segs: vec![seg], closed: false }] };
    let (tolerance, certify) = (options.tolerance, options.certify);
    let w = warp_path(&path, map, options).unwrap();
    let out = pathwarp_oracle::cubics(&w.path);
    prop_assert!(out.iter().all(|c| c.p1.is_finite() && c.p2.is_finite() && c.p3.is_finite()));
    prop_assert!(out.len() < 2000);
    if w.report.unresolved.is_empty() {
        prop_assert!(w.report.max_error <= tolerance);
        prop_assert!(!certify || map.rational_degree().is_none() || w.report.assurance >= Assurance::Certified);
        let e = pathwarp_oracle::distance(&seg, map, &w.path, 1000, tolerance);
        prop_assert!(e <= tolerance * 1.0005 + 1e-9, "{} {:?}", e / tolerance, w.report);
    }
    // Skip segments that are equal to their reverse.
    if seg.reversed() == seg {
        return Ok(());
    }
    let back = Outline { subpaths: path.subpaths.iter().map(Subpath::reversed).collect() };
    let b = warp_path(&back, map, options).unwrap();
    let mirrored = pathwarp_oracle::cubics(&b.path);
    prop_assert_eq!(out.len(), mirrored.len());
    for (c, d) in out.iter().zip(mirrored.iter().rev()) {
        prop_assert!(c.p0 == d.p3 && c.p3 == d.p0);
    }
    Ok(())
}

fn tolerance() -> impl Strategy<Value = f64> {
    prop_oneof![Just(1.0), Just(0.1), Just(0.01), Just(0.001)]
}

proptest! {
    #![proptest_config(maps::cases(300))]

    #[test]
    fn within_the_tolerance_under_bicubic_maps(seg in seg(), map in map(), tolerance in tolerance(), certify: bool) {
        holds(seg, &map, &Options::new(tolerance).with_nodes(Nodes::Source).with_certify(certify))?;
    }

    #[test]
    fn within_the_tolerance_under_opaque_maps(seg in seg(), map in waves(), tolerance in tolerance(), certify: bool) {
        holds(seg, &map, &Options::new(tolerance).with_nodes(Nodes::Source).with_certify(certify))?;
    }
}

/// Failures that these tests have found.
#[test]
fn errors_between_the_samples_are_seen() {
    let all = cases::risen_between_samples().into_iter().chain(cases::leaps_between_samples()).chain([
        cases::hook_at_a_cusp(),
        cases::slow_between_samples(),
        cases::hidden_in_the_middle(),
        cases::corner_near_the_end(),
        cases::spike_at_a_tip(),
    ]);
    for (i, (map, seg)) in all.enumerate() {
        let path = Outline { subpaths: vec![Subpath { start: seg.start(), segs: vec![seg], closed: false }] };
        for tolerance in [1.0, 0.1, 0.01, 0.001] {
            let w = warp_path(&path, &map, &Options::new(tolerance)).unwrap();
            let e = pathwarp_oracle::distance(&seg, &map, &w.path, 2000, tolerance);
            assert!(w.report.unresolved.is_empty() && e <= tolerance, "case {i}, {tolerance}: {e}");
        }
    }
}
