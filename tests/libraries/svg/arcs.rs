//! Arcs stay arcs where their images are arcs.

use pathwarp::deform::Mobius;
use pathwarp::kurbo::{Affine, Line, Point, Rect};
use pathwarp::map::{AffineMap, Map};
use pathwarp::{Outline, Seg};
use pathwarp_oracle::drawings::{Bend, Hidden, drawing, read, warp_options};
use pathwarp_svg::Structure;

const ARCS: [&str; 6] = [
    "<circle cx='50' cy='40' r='30'/>",
    "<ellipse cx='50' cy='40' rx='30' ry='12' transform='rotate(20)'/>",
    "<rect x='10' y='15' width='70' height='40' rx='12'/>",
    "<path d='M20 30A30 30 0 0 1 79 31L60 70Z'/>",
    "<path d='M20 50A25 25 0 1 0 70 50M80 20C90 30 90 40 80 50A15 15 0 0 1 80 80'/>",
    "<path d='M20 50A30 15 40 1 1 60 60L20 90Z' transform='scale(1 .6)'/>",
];

/// Returns path data of the warped shape.
fn data(svg: &str) -> String {
    let d = svg.split(" d=").nth(1).unwrap();
    d[1..].split(&d[..1]).next().unwrap().to_owned()
}

/// Returns an outline whose open subpaths end with a line to their start, as fills do.
fn closed(outline: &Outline) -> Outline {
    let mut outline = outline.clone();
    for s in &mut outline.subpaths {
        let end = s.segs.last().map_or(s.start, Seg::end);
        if end != s.start {
            s.segs.push(Seg::Line(Line::new(end, s.start)));
        }
    }
    outline
}

/// Checks that the written path is as close as reported, and has as many arcs as expected.
fn check(body: &str, map: &dyn Map, arcs: impl Fn(usize) -> bool) {
    for structure in [Structure::Auto, Structure::Flatten] {
        for decimals in [None, Some(2)] {
            let document = read(&drawing(body));
            let o = warp_options().with_structure(structure).with_precision(decimals);
            let w = document.warp(map, &o).unwrap();
            let d = data(&w.svg);
            let placed = read(&w.svg).shapes()[0].outline.clone();
            let source = closed(&document.shapes()[0].outline);
            let distance = pathwarp_oracle::distance(&source, map, &closed(&placed), 64, 1e-4);
            let stated = w.shapes[0].path.max_error;
            assert!(distance <= stated + 1e-9, "{body}: {distance} of {stated}\n{d}");
            assert!(decimals.is_some() || stated <= 1e-4, "{body}: {stated}");
            assert!(arcs(d.matches('A').count()), "{body}: {d}");
            assert_eq!(w.shapes[0].path.segments_out, Outline::from_svg(&d).unwrap().segs().count(), "{body}: {d}");
        }
    }
}

#[test]
fn affine_maps_keep_all_arcs() {
    let similitude = Affine::rotate(0.3) * Affine::scale(0.7);
    for m in [
        Affine::translate((3.0, 4.0)),
        similitude,
        Affine::FLIP_X * similitude,
        Affine::new([0.8, 0.3, -0.2, 0.5, 20.0, 10.0]),
    ] {
        for body in ARCS {
            check(body, &AffineMap(m), |n| n > 0);
        }
    }
}

#[test]
fn moebius_maps_keep_circles() {
    let map = Mobius::by_pole(Rect::new(0.0, 0.0, 100.0, 100.0), (40.0, 260.0)).build().unwrap().map;
    for (body, circles) in ARCS.iter().zip([true, false, true, true, true, false]) {
        check(body, &*map, |n| (n > 0) == circles);
    }
    // The arcs of a circle lie on one circle after the map.
    let w = read(&drawing(ARCS[0])).warp(&*map, &warp_options()).unwrap();
    let image = Outline::from_svg(&data(&w.svg)).unwrap();
    let circles: Vec<_> = image
        .segs()
        .map(|s| match s {
            Seg::Arc(a) => (a.center, a.a.hypot()),
            other => panic!("{other:?}"),
        })
        .collect();
    let expected = 0.5 * map.point(Point::new(50.0, 10.0)).distance(map.point(Point::new(50.0, 70.0)));
    for (center, radius) in &circles {
        assert!(center.distance(circles[0].0) < 1e-4 && (radius - circles[0].1).abs() < 1e-4, "{circles:?}");
        // The pole is not above the middle, so the two points are not quite opposite.
        assert!((radius / expected - 1.0).abs() < 0.01, "{radius} {expected}");
    }
}

#[test]
fn similitudes_that_do_not_say_so_keep_circles() {
    check(ARCS[0], &Hidden(Affine::rotate(1.0) * Affine::scale(0.6)), |n| n == 4);
}

#[test]
fn other_images_become_curves() {
    for body in ARCS {
        check(body, &Bend, |n| n == 0);
    }
}

/// A curve that ends where it starts, beside true arcs, and an arc that ends where the last one ended.
#[test]
fn loops_cost_no_arcs_and_no_precision() {
    for d in [
        "M90 50A40 40 0 1 1 10 50A40 40 0 1 1 90 50ZM50 45C40 30 60 30 50 45Z",
        "M90 50A40 40 0 1 1 10 50A40 40 0 1 1 90 50ZC5 5 5 5 5 5",
        "M90 50A40 40 0 1 1 10 50A40 40 0 1 1 90 50ZM50 45Q40 30 50 45",
        "M44 8A30 25 0 0 0 50 90A22 10 30 1 0 50 90Z",
    ] {
        let source = Outline::from_svg(d).unwrap();
        let arcs = source.segs().filter(|s| matches!(s, Seg::Arc(_))).count();
        let turn = AffineMap(Affine::rotate_about(0.2, Point::new(50.0, 50.0)));
        let svg = read(&drawing(&format!("<path d='{d}'/>"))).warp(&turn, &warp_options()).unwrap().svg;
        assert!(data(&svg).matches(['A', 'a']).count() >= arcs, "{svg}");
        let bent = read(&drawing(&format!("<path d='{d}'/>"))).warp(&Bend, &warp_options()).unwrap().svg;
        let written = Outline::from_svg(&data(&bent)).unwrap();
        let off = pathwarp_oracle::distance(&closed(&source), &Bend, &closed(&written), 64, 1e-4);
        assert!(off <= 1.1e-4, "{d}: {off}");
    }
}
