//! Nodes that a shape does not need are removed, however many there are and whatever creases the map has.

use pathwarp::check::frame;
use pathwarp::deform::{Registry, Swirl};
use pathwarp::kurbo::{CubicBez, Point, Rect, Vec2};
use pathwarp::map::{Class, Map};
use pathwarp::param::{Args, Frame};
use pathwarp::refit::{Nodes, Options, PathReport, warp_path};
use pathwarp::{Outline, Seg, Subpath};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Returns a circle of `n` cubics within the frame of checks.
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

/// Returns that circle as two arcs.
fn arcs() -> Outline {
    Outline::from_svg("M83,47A31,31 0 0 1 21,47A31,31 0 0 1 83,47Z").unwrap()
}

fn warped(outline: &Outline, map: &dyn Map, tolerance: f64) -> Option<PathReport> {
    let report = warp_path(outline, map, &Options::new(tolerance).with_nodes(Nodes::Fewest)).ok()?.report;
    assert!(report.max_error <= tolerance, "{report:?}");
    Some(report)
}

/// Returns the demos of all deformations that fit curves: affine ones move control points, and some are not defined on all of the circle.
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
        let Ok(warped) = warp_path(&outline, &map, &Options::new(tolerance).with_nodes(Nodes::Fewest)) else {
            continue;
        };
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

/// Returns the part of a segment between two parameters.
fn part(seg: &Seg, from: f64, to: f64) -> Seg {
    match seg {
        Seg::Arc(a) => Seg::Arc(a.subsegment(from, to)),
        other => other.part(from, to).unwrap(),
    }
}

/// Returns a segment in equal parts of its parameter.
fn divided(seg: &Seg, n: usize) -> Outline {
    let at = |i: usize| i as f64 / n as f64;
    let segs = (0..n).map(|i| part(seg, at(i), at(i + 1))).collect();
    Outline { subpaths: vec![Subpath { start: seg.start(), segs, closed: false }] }
}

/// Returns the number of pieces if each reaches as far as a single one can.
fn greedy(seg: &Seg, map: &dyn Map, tolerance: f64) -> usize {
    let fits = |from: f64, to: f64| {
        let alone = divided(&part(seg, from, to), 1);
        warp_path(&alone, map, &Options::new(tolerance)).is_ok_and(|w| w.report.segments_out == 1)
    };
    let (mut from, mut pieces, mut step) = (0.0, 0, 0.1);
    while from < 1.0 {
        // Gallop until a piece misses, then bisect closely, since at a crease a remainder would be one more piece.
        let (mut low, mut high) = (from, f64::INFINITY);
        while low < 1.0 && high - low > 1e-9 {
            let to = if high.is_finite() { 0.5 * (low + high) } else { f64::min(low + step, 1.0) };
            *if fits(from, to) { &mut low } else { &mut high } = to;
        }
        step = 0.4 * (low - from).max(1e-3);
        from = f64::max(low, from + 1e-8);
        pieces += 1;
    }
    pieces
}

/// One long segment takes hardly more pieces than a greedy search, and so does this curve in parts. By default only a part of the cases
/// runs; `EVERY=1` runs them all.
#[test]
fn one_long_segment_has_as_many_pieces_as_a_greedy_search_finds() {
    let every: usize = std::env::var("EVERY").map_or(16, |n| n.parse().unwrap());
    let curves =
        ["M5 30L95 60", "M5 80C30 -40 60 150 95 20", "M10 50A40 30 20 0 1 90 55", "M20 50A30 30 0 1 1 20 50.001"];
    const PARTS: [usize; 5] = [1, 2, 3, 7, 40];
    let (mut least, mut all, mut worst, mut wrong) = (0, [0; 5], [0.0f64; 5], Vec::new());
    let cases = maps().into_iter().flat_map(|m| curves.map(|d| (m.clone(), d)));
    let tolerances = [0.5, 0.2, 0.05, 0.02, 0.005, 0.002, 0.0005, 0.0002];
    let cases = cases.flat_map(|c| tolerances.map(|t| (c.clone(), t)));
    for (((name, map), d), tolerance) in cases.enumerate().filter(|(i, _)| i * 7 % every == 0).map(|c| c.1) {
        let long = Outline::from_svg(d).unwrap().subpaths[0].segs[0];
        if warped(&divided(&long, 1), &map, tolerance).is_none() {
            continue;
        }
        let fewest = greedy(&long, &map, tolerance);
        least += fewest;
        for (k, n) in PARTS.into_iter().enumerate() {
            let found = warped(&divided(&long, n), &map, tolerance).unwrap().segments_out;
            let ratio = found as f64 / fewest as f64;
            if n == 1 && found > fewest + 1 && ratio > 1.25 {
                wrong.push(format!("{name}, {d} in {n} within {tolerance}: {found}, greedy {fewest}"));
            }
            (all[k], worst[k]) = (all[k] + found, worst[k].max(ratio));
        }
    }
    println!(
        "greedy {least}; {PARTS:?}: {all:?}, {:?}, worst {worst:?}",
        all.map(|n| f64::from(n as u32) / f64::from(least as u32))
    );
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(1000 * all[0] <= 1050 * least, "{all:?}, greedy {least}");
}

#[test]
fn a_line_under_nine_waves_takes_nine_pieces() {
    let entry = Registry::builtin().get("wave").unwrap().clone();
    let frame = Frame::new(Rect::new(0.0, 0.0, 400.0, 300.0));
    let map = entry.build_from(&Args::from_pairs(&[("length", "100"), ("height", "20")]), &frame).unwrap().map;
    let pieces = warped(&Outline::from_svg("M0 150H400").unwrap(), &map, 0.05).unwrap().segments_out;
    assert!(pieces <= 9, "{pieces}");
}

/// Returns a closed polygon of points.
fn polygon(places: impl Iterator<Item = Point>) -> Outline {
    let mut all: Vec<Point> = places.collect();
    all.push(all[0]);
    let segs: Vec<Seg> = all.windows(2).map(|w| Seg::Line(pathwarp::kurbo::Line::new(w[0], w[1]))).collect();
    Outline { subpaths: vec![Subpath { start: all[0], segs, closed: true }] }
}

/// Returns chords of a circle, each of which turns by less than a corner.
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
    // The circle is far from the swirl.
    let swirl = Swirl::new(Point::new(60.0, 40.0), 25.0).build().unwrap().map;
    let away = Point::new(500.0, 500.0);
    let flattened = warped(&polygon(chords(away, 20.0, 1500)), &swirl, 0.02).unwrap();
    assert!(flattened.segments_out <= 8, "{flattened:?}");
    let round = Outline::from_svg("M500 500C503 500 506 501 509 503C512 505 514 508 515 512L500 520Z").unwrap();
    let kept = warp_path(&round, &swirl, &Options::new(0.02).with_nodes(Nodes::Fewest)).unwrap();
    assert_eq!(kept.path.to_svg(), round.to_bez_path(1e-9).to_svg());
}
