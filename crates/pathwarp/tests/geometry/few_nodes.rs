//! Nodes that a shape does not need go, however many there are and whatever creases the map has.

use crate::support;
use kurbo::{CubicBez, Point, Vec2};
use pathwarp::check::frame;
use pathwarp::deform::{Registry, Swirl};
use pathwarp::map::{Class, Map};
use pathwarp::param::Args;
use pathwarp::refit::{Options, PathReport, warp_path};
use pathwarp::{Outline, Seg, Subpath};
use std::f64::consts::TAU;
use std::sync::Arc;

/// A circle of `n` cubics within the frame of checks.
fn circle(n: usize) -> Outline {
    let step = TAU / n as f64;
    let at = |i: usize| Vec2::from_angle(step * (i % n) as f64);
    let handle = 4.0 / 3.0 * (0.25 * step).tan();
    let place = |v: Vec2| Point::new(52.0, 47.0) + v * 31.0;
    let turned = |v: Vec2| Vec2::new(-v.y, v.x) * handle;
    let cubic = |i: usize| {
        let (u, v) = (at(i), at(i + 1));
        CubicBez::new(place(u), place(u + turned(u)), place(v - turned(v)), place(v))
    };
    let segs: Vec<Seg> = (0..n).map(|i| Seg::Cubic(cubic(i))).collect();
    Outline { subpaths: vec![Subpath { start: segs[0].start(), segs, closed: true }] }
}

/// The same circle of two arcs.
fn arcs() -> Outline {
    Outline::from_svg("M83,47A31,31 0 0 1 21,47A31,31 0 0 1 83,47Z").unwrap()
}

fn warped(outline: &Outline, map: &dyn Map, tolerance: f64) -> Option<PathReport> {
    let report = warp_path(outline, map, &Options::new(tolerance).with_merge(true)).ok()?.report;
    assert!(report.max_error <= tolerance, "{report:?}");
    Some(report)
}

/// The demos of all deformations that fit curves: affine ones move control points, and some are not defined on all of the circle.
fn maps() -> Vec<(&'static str, Arc<dyn Map>)> {
    let registry = Registry::builtin();
    let built = registry.entries().iter().map(|entry| {
        let info = entry.info();
        (info.name, entry.build_from(&Args::from_pairs(info.demo), &frame()).unwrap().map)
    });
    built.filter(|(_, map)| !matches!(map.class(), Class::Affine(_))).collect()
}

#[test]
fn a_circle_of_many_nodes_has_as_many_pieces_as_one_of_two_under_every_deformation() {
    let mut compared = 0;
    for (name, map) in maps() {
        for tolerance in [0.1, 0.014, 0.0005] {
            let Some(two) = warped(&arcs(), &map, tolerance) else { continue };
            for n in [8, 40, 400] {
                let Some(many) = warped(&circle(n), &map, tolerance) else { continue };
                let (many, two) = (many.segments_out, two.segments_out);
                assert!(many <= two + 1, "{name} within {tolerance}: {many} pieces of {n} segments, {two} of two arcs");
                compared += 1;
            }
        }
    }
    assert!(compared > 100, "{compared}");
}

#[test]
fn few_pieces_across_creases_are_within_the_tolerance() {
    for (name, map) in maps() {
        let tolerance = 0.02;
        let outline = circle(40);
        let Ok(warped) = warp_path(&outline, &map, &Options::new(tolerance).with_merge(true)) else { continue };
        let (segs, out) = (&outline.subpaths[0].segs, support::cubics(&warped.path));
        let error = support::distance_of_run(segs, &*map, &out, 400, 0.9 * tolerance);
        assert!(error <= 1.0001 * tolerance, "{name}: {} of the tolerance", error / tolerance);
    }
}

#[test]
fn a_hundred_thousand_nodes_are_few_pieces() {
    let swirl = Swirl::new(Point::new(60.0, 40.0), 25.0).build().unwrap().map;
    let two = warped(&arcs(), &swirl, 0.014).unwrap().segments_out;
    let many = warped(&circle(100_000), &swirl, 0.014).unwrap().segments_out;
    assert!(many <= two + 1, "{many} pieces, {two} of two arcs");
}
