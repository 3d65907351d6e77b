//! Nodes that a shape does not need go, however many there are and whatever creases the map has.

use pathwarp::check::frame;
use pathwarp::deform::{Registry, Swirl};
use pathwarp::kurbo::{CubicBez, Point, Vec2};
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
        let error = pathwarp_oracle::distance(&outline, &*map, &warped.path, 400, tolerance);
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

/// A polygon of places at angles from `from` on, closed.
fn polygon(places: impl Iterator<Item = Point>) -> Outline {
    let mut all: Vec<Point> = places.collect();
    all.push(all[0]);
    let segs: Vec<Seg> = all.windows(2).map(|w| Seg::Line(pathwarp::kurbo::Line::new(w[0], w[1]))).collect();
    Outline { subpaths: vec![Subpath { start: all[0], segs, closed: true }] }
}

/// Chords of a circle, each of which turns by less than a corner.
fn chords(middle: Point, radius: f64, n: usize) -> impl Iterator<Item = Point> {
    (0..n).map(move |i| middle + Vec2::from_angle(TAU * i as f64 / n as f64) * radius)
}

#[test]
fn flattened_circles_are_few_pieces_where_some_chords_stay_straight() {
    let bend = Registry::builtin().get("wave").unwrap().build_from(&Args::new(), &frame()).unwrap().map;
    let swirl = Swirl::new(Point::new(60.0, 40.0), 25.0).build().unwrap().map;
    for map in [bend, swirl] {
        for n in [4000, 8000] {
            let many = warped(&polygon(chords(Point::new(52.0, 47.0), 20.0, n)), &map, 0.02).unwrap().segments_out;
            assert!(many <= 12, "{n}: {many}");
        }
    }
}

#[test]
fn what_is_only_moved_keeps_its_nodes_unless_they_are_far_too_many() {
    // Far from the swirl.
    let swirl = Swirl::new(Point::new(60.0, 40.0), 25.0).build().unwrap().map;
    let away = Point::new(500.0, 500.0);
    let flattened = warped(&polygon(chords(away, 20.0, 1500)), &swirl, 0.02).unwrap();
    assert!(flattened.segments_out <= 8, "{flattened:?}");
    let round = Outline::from_svg("M500 500C503 500 506 501 509 503C512 505 514 508 515 512L500 520Z").unwrap();
    let kept = warp_path(&round, &swirl, &Options::new(0.02).with_merge(true)).unwrap();
    assert_eq!(kept.path.to_svg(), round.to_bez_path(1e-9).to_svg());
}
