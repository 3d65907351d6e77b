//! Promises of options and sources, measured on the output.

use super::common::{Drawn, distance, off, polygon, wave};
use bezierfit::{
    Assurance, Degree, Error, Kurbo, Nodes, Options, PathSource, Pieces, Segment, Source, fit, fit_points, simplify,
};
use kurbo::{BezPath, CubicBez, Line, ParamCurve, ParamCurveDeriv, PathEl, PathSeg, Point, QuadBez, Vec2};
use pathwarp_oracle::Random;

#[test]
fn tolerances_that_make_no_sense_are_errors() {
    let path = BezPath::from_svg("M0 0C1 2 3 4 5 0").unwrap();
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let options = Options::new(tolerance);
        let is_that = |e: Error| matches!(e, Error::Tolerance(t) if t.to_bits() == tolerance.to_bits());
        assert!(is_that(fit(&wave(3.0), &options).unwrap_err()));
        assert!(is_that(simplify(&path, &options).unwrap_err()));
    }
    let corner = Options::new(0.1).with_corner(f64::NAN);
    assert!(matches!(simplify(&path, &corner), Err(Error::Corner(_))));
}

#[test]
fn the_report_has_an_entry_for_every_piece() {
    let path =
        BezPath::from_svg("M0 0H50C77.6 0 100 22.4 100 50C100 77.6 77.6 100 50 100L0 90ZM5 5C6 7 8 7 9 5Z").unwrap();
    for degree in [Degree::Cubic, Degree::Quadratic] {
        let options = Options::new(0.05).with_degree(degree);
        for fitted in [simplify(&path, &options).unwrap(), fit(&wave(9.0), &options).unwrap()] {
            let report = &fitted.report;
            assert_eq!(report.pieces.len(), fitted.path.segments().count());
            let worst = report.pieces.iter().map(|p| p.error).fold(0.0, f64::max);
            assert_eq!(worst, report.max_error);
            assert_eq!(report.pieces.iter().map(|p| p.assurance).min(), Some(report.assurance));
        }
    }
    let simple = simplify(&path, &Options::new(0.05)).unwrap();
    assert_eq!(simple.report.pieces[0].assurance, Assurance::Exact);
    let circle = kurbo::Shape::to_path(&kurbo::Circle::new((0.0, 0.0), 100.0), 1e-12);
    let proven = simplify(&circle, &Options::new(0.05).with_certify(true)).unwrap();
    assert!(proven.report.pieces.iter().all(|p| p.assurance >= Assurance::Certified));
    assert!(proven.report.pieces.iter().any(|p| p.assurance == Assurance::Certified));
}

#[test]
fn at_most_n_pieces_have_nearly_the_least_error() {
    let source = wave(20.0);
    let mut last = f64::INFINITY;
    for n in 1..=12 {
        let fitted = fit(&source, &Options::new(1e-3).with_pieces(Pieces::AtMost(n))).unwrap();
        assert!(fitted.path.segments().count() <= n);
        let error = distance(&source, &fitted.path, fitted.report.max_error);
        assert!(error <= 1.001 * fitted.report.max_error, "{n}: {error} {:?}", fitted.report);
        assert!(error <= last * 1.01, "{n}: {error}, with one less {last}");
        assert_eq!(fitted.report.max_error > 1e-3, !fitted.report.unresolved.is_empty());
        // A tolerance a little below the error takes more pieces.
        let below = Options::new(0.9 * fitted.report.max_error);
        assert!(fitted.report.max_error <= 1e-3 || fit(&source, &below).unwrap().path.segments().count() > n, "{n}");
        last = error;
    }
    let enough = fit(&source, &Options::new(0.5).with_pieces(Pieces::AtMost(1000))).unwrap();
    assert_eq!(enough, fit(&source, &Options::new(0.5)).unwrap());
}

#[test]
fn exactly_n_pieces_are_n() {
    let path = BezPath::from_svg("M0 0H50C77.6 0 100 22.4 100 50L0 90ZM5 5C6 7 8 7 9 5L5 5Z").unwrap();
    let segments = path.segments().count();
    for n in [segments, segments + 1, 20, 1000] {
        let exactly = Options::new(0.1).with_pieces(Pieces::Exactly(n));
        let fitted = simplify(&path, &exactly).unwrap();
        assert_eq!((fitted.path.segments().count(), fitted.report.pieces.len()), (n, n));
        assert_eq!(fitted.path.elements().iter().filter(|e| matches!(e, PathEl::ClosePath)).count(), 2);
    }
    let source = wave(20.0);
    for n in [1, 2, 7, 50] {
        let fitted = fit(&source, &Options::new(0.1).with_pieces(Pieces::Exactly(n))).unwrap();
        assert_eq!(fitted.path.segments().count(), n);
        let stated = fitted.report.max_error;
        assert!(distance(&source, &fitted.path, stated) <= 1.001 * stated + 1e-9);
    }
    // Corners need more pieces than that.
    for pieces in [Pieces::AtMost(3), Pieces::Exactly(3), Pieces::AtMost(0)] {
        let few = simplify(&path, &Options::new(0.1).with_corner(0.01).with_pieces(pieces));
        assert!(matches!(few, Err(Error::TooFewPieces { least: 6, .. })), "{few:?}");
    }
}

#[test]
fn pieces_run_across_smooth_joints_only_if_they_may() {
    let circle = |n: usize| {
        let at = move |t: f64| {
            let (s, c) = (std::f64::consts::TAU * t).sin_cos();
            (Point::new(100.0 * c, 100.0 * s), Vec2::new(-s, c) * (100.0 * std::f64::consts::TAU))
        };
        Drawn::new(at, (1..n).map(|i| i as f64 / n as f64).collect())
    };
    let count = |n, merge| {
        fit(&circle(n), &Options::new(0.1).with_nodes(if merge { Nodes::Fewest } else { Nodes::Source }))
            .unwrap()
            .path
            .segments()
            .count()
    };
    assert_eq!((count(16, true), count(16, false)), (4, 16));
    let path = BezPath::from_svg("M0 0C10 0 20 1 30 3C40 5 50 8 60 12").unwrap();
    assert_eq!(simplify(&path, &Options::new(0.1).with_nodes(Nodes::Source)).unwrap().path, path);
    assert_eq!(simplify(&path, &Options::new(0.1)).unwrap().path.segments().count(), 1);
}

#[test]
fn jumps_begin_subpaths() {
    let steps =
        |t: f64| (Point::new(90.0 * t, if t < 0.5 { 0.0 } else { 20.0 } + 9.0 * t * t), Vec2::new(90.0, 18.0 * t));
    for degree in [Degree::Cubic, Degree::Quadratic] {
        let fitted = fit(&Drawn::new(steps, vec![0.5]), &Options::new(0.01).with_degree(degree)).unwrap();
        let starts = fitted.path.elements().iter().filter(|e| matches!(e, PathEl::MoveTo(_))).count();
        assert_eq!(starts, 2);
        let end = fitted.path.segments().next().unwrap().end();
        assert!(end.distance(Point::new(45.0, 2.25)) < 1e-9, "{end}");
    }
}

#[test]
fn whole_paths_are_sources() {
    let path =
        BezPath::from_svg("M0 0H50C77.6 0 100 22.4 100 50C100 77.6 77.6 100 50 100L0 90ZM5 5C6 7 8 7 9 5Z").unwrap();
    let source = PathSource::new(&path).unwrap();
    let fitted = fit(&source, &Options::new(0.05)).unwrap();
    let simple = simplify(&path, &Options::new(0.05)).unwrap();
    assert_eq!(fitted.path.segments().count(), simple.path.segments().count());
    for (a, b) in [(&fitted.path, &path), (&path, &fitted.path)] {
        let points = a.segments().flat_map(|s| (0..=60).map(move |i| s.eval(f64::from(i) / 60.0)));
        assert!(off(&points.collect::<Vec<_>>(), b) <= 0.05);
    }
    assert!(PathSource::new(&BezPath::new()).is_none());
}

/// Numbers of points of a quadratic spline that a font stores: control points, and points on the curve that are not halfway between two.
fn stored(path: &BezPath) -> (usize, usize) {
    let quads: Vec<QuadBez> =
        path.segments().filter_map(|s| if let PathSeg::Quad(q) = s { Some(q) } else { None }).collect();
    let implied = quads.windows(2).filter(|w| w[0].p2.distance(w[0].p1.midpoint(w[1].p1)) < 1e-9).count();
    (quads.len(), implied)
}

#[test]
fn quadratics_are_within_the_tolerance_and_imply_their_joints() {
    let circle = CubicBez::new((0.0, 0.0), (55.0, 0.0), (100.0, 45.0), (100.0, 100.0));
    for (name, seg) in [
        ("quarter", circle),
        ("S", CubicBez::new((0.0, 0.0), (80.0, 0.0), (20.0, 100.0), (100.0, 100.0))),
        ("flat", CubicBez::new((0.0, 0.0), (30.0, 0.1), (60.0, 0.3), (100.0, -0.4))),
        ("loop", CubicBez::new((0.0, 0.0), (150.0, 100.0), (-50.0, 100.0), (100.0, 0.0))),
        ("near-cusp", CubicBez::new((0.0, 0.0), (100.0, 100.0), (2.0, 100.0), (100.0, 0.0))),
        ("cusp", CubicBez::new((0.0, 0.0), (100.0, 100.0), (0.0, 100.0), (100.0, 0.0))),
        ("no handle", CubicBez::new((0.0, 0.0), (0.0, 0.0), (50.0, 100.0), (100.0, 0.0))),
    ] {
        for tolerance in [1.0, 0.1, 1e-3] {
            let options = Options::new(tolerance).with_degree(Degree::Quadratic);
            let fitted = simplify(
                &BezPath::from_vec(vec![PathEl::MoveTo(seg.p0), PathEl::CurveTo(seg.p1, seg.p2, seg.p3)]),
                &options,
            )
            .unwrap();
            let error = distance(&Segment::new(PathSeg::Cubic(seg)), &fitted.path, tolerance);
            assert!(error <= 1.001 * tolerance && fitted.report.unresolved.is_empty(), "{name} {tolerance}: {error}");
            assert!(fitted.path.elements()[1..].iter().all(|e| matches!(e, PathEl::QuadTo(..) | PathEl::LineTo(_))));
            let (quads, implied) = stored(&fitted.path);
            let breaks = if name == "cusp" { 1 } else { 0 };
            assert!(implied + 1 + breaks >= quads || name.contains("cusp"), "{name}: {implied} of {quads}");
        }
    }
    // End tangents stay.
    let fitted = fit(&wave(9.0), &Options::new(0.1).with_degree(Degree::Quadratic)).unwrap();
    let first = fitted.path.segments().next().unwrap().to_cubic().deriv().eval(0.0).to_vec2();
    assert!(first.cross(wave(9.0).eval(0.0).1).abs() <= 1e-9 * first.hypot() * 300.0);
    assert!(distance(&wave(9.0), &fitted.path, 0.1) <= 0.1);
}

/// A closed curve whose extremes have handles along the axes, in uneven parts.
#[test]
fn quadratics_keep_extremes_on_the_curve() {
    let d = "M100,0C100,30 80,70 0,70C-60,70 -90,40 -90,0C-90,-50 -40,-80 0,-80C70,-80 100,-40 100,0Z";
    let ends = [(100.0, 0.0), (0.0, 70.0), (-90.0, 0.0), (0.0, -80.0)].map(Point::from);
    let path = BezPath::from_svg(d).unwrap();
    for tolerance in [1.0, 0.1, 0.01] {
        let options = Options::new(tolerance).with_degree(Degree::Quadratic).with_nodes(Nodes::Auto);
        let fitted = simplify(&path, &options).unwrap();
        let segs: Vec<QuadBez> =
            fitted.path.segments().filter_map(|s| if let PathSeg::Quad(q) = s { Some(q) } else { None }).collect();
        for p in ends {
            let at: Vec<usize> = (0..segs.len()).filter(|i| segs[*i].p0 == p).collect();
            let [i] = at[..] else { panic!("{tolerance}: {p} is at {at:?}") };
            let handle = segs[i].p1 - p;
            assert!(handle.x.abs().min(handle.y.abs()) <= 1e-9, "{tolerance}: {handle}");
        }
        let error = off(
            &path.segments().flat_map(|s| (0..=60).map(move |i| s.eval(f64::from(i) / 60.0))).collect::<Vec<_>>(),
            &fitted.path,
        );
        assert!(error <= tolerance, "{tolerance}: {error}");
    }
}

#[test]
fn points_become_arcs_lines_and_corners() {
    let degrees = |d: f64| d.to_radians();
    // A rounded rectangle with few points at its corners and none on its sides.
    let mut points = Vec::new();
    for (i, (x, y)) in [(200.0, 100.0), (0.0, 100.0), (0.0, 0.0), (200.0, 0.0)].into_iter().enumerate() {
        points.extend(
            (0..=9).map(|k| Point::new(x, y) + Vec2::from_angle(degrees(90.0 * i as f64 + 10.0 * f64::from(k))) * 20.0),
        );
    }
    let fitted = simplify(&polygon(&points, true), &Options::new(0.12)).unwrap();
    let segs: Vec<PathSeg> = fitted.path.segments().collect();
    let lines: Vec<Line> = segs.iter().filter_map(|s| if let PathSeg::Line(l) = s { Some(*l) } else { None }).collect();
    assert_eq!((segs.len(), lines.len()), (8, 4), "{}", fitted.path.to_svg());
    assert!(off(&points, &fitted.path) <= 0.12);
    // Corners stay exactly.
    let square = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(Point::from);
    let fitted = simplify(&polygon(&square, true), &Options::new(0.1).with_corner(degrees(30.0))).unwrap();
    assert_eq!(fitted.path.to_svg(), "M0,0 L10,0 L10,10 L0,10 Z");
    // A noisy open curve of many points.
    let (mut random, curve) = (Random::new(7), wave(9.0));
    let mut noise = || random.between(-0.02, 0.02);
    let noisy: Vec<Point> =
        (0..2000).map(|i| curve.eval(f64::from(i) / 1999.0).0 + Vec2::new(noise(), noise())).collect();
    let fitted = simplify(&polygon(&noisy, false), &Options::new(0.2).with_corner(degrees(170.0))).unwrap();
    assert!(fitted.path.segments().count() <= 12, "{}", fitted.path.segments().count());
    assert!(off(&noisy, &fitted.path) <= 0.2);
    // Few points, equal points, points that are not finite.
    for few in [&noisy[..0], &noisy[..1], &noisy[..2], &noisy[..3], &[Point::ORIGIN; 5][..]] {
        for closed in [false, true] {
            let fitted = simplify(&polygon(few, closed), &Options::new(0.1)).unwrap();
            assert!(fitted.path.segments().count() == 0 || off(few, &fitted.path) <= 0.1);
        }
    }
    assert!(matches!(
        simplify(&polygon(&[Point::new(f64::NAN, 0.0)], true), &Options::new(0.1)),
        Err(Error::NotFinite(_))
    ));
}

/// Points of a circle, a square and a wave. Corners of the curve stay, and points are no corners.
#[test]
fn points_have_no_corners_of_their_own() {
    let circle = |i: i32| 100.0 * Vec2::from_angle(f64::from(i % 400) * std::f64::consts::TAU / 400.0);
    let square = |i: i32| match (i / 100 % 4, f64::from(i % 100)) {
        (0, t) => (t, 0.0),
        (1, t) => (100.0, t),
        (2, t) => (100.0 - t, 100.0),
        (_, t) => (0.0, 100.0 - t),
    };
    for (points, most) in [
        ((0..=400).map(|i| circle(i).to_point()).collect::<Vec<Point>>(), 8),
        ((0..=400).map(|i| square(i).into()).collect(), 4),
        ((0..400).map(|i| wave(9.0).eval(f64::from(i) / 399.0).0).collect(), 20),
    ] {
        let fitted = fit_points(points.iter().copied(), &Options::new(0.1)).unwrap();
        assert!(fitted.path.segments().count() <= most, "{}", fitted.path.to_svg());
        for p in points {
            let off = fitted.path.segments().map(|s| kurbo::ParamCurveNearest::nearest(&s, p, 1e-9).distance_sq);
            assert!(off.fold(f64::INFINITY, f64::min).sqrt() <= 0.1001);
        }
    }
    assert!(matches!(fit_points([(0.0, f64::NAN), (1.0, 1.0)], &Options::new(0.1)), Err(Error::NotFinite(_))));
    for few in [vec![], vec![(1.0, 1.0)], vec![(1.0, 1.0); 2], vec![(1.0, 1.0); 3]] {
        assert!(fit_points(few, &Options::new(0.1)).is_ok());
    }
}

/// Kurbo's fitter takes one of our sources and keeps its corner; a curve survives both adaptors.
#[test]
fn curves_go_to_kurbo_and_back() {
    let theirs = kurbo::fit_to_bezpath(&Kurbo(wave(20.0)), 0.01);
    assert!(distance(&wave(20.0), &theirs, 0.01) <= 0.02);
    let roof = PathSource::new(&BezPath::from_svg("M0 0C10 20 40 50 50 50L100 0").unwrap()).unwrap();
    let twice = Kurbo(Kurbo(roof.clone()));
    assert_eq!(Source::breaks(&twice), Source::breaks(&roof));
    assert_eq!(fit(&twice, &Options::new(0.01)).unwrap().path.segments().count(), 2);
    let corner =
        kurbo::fit_to_bezpath(&Kurbo(roof), 0.01).segments().any(|s| s.end().distance(Point::new(50.0, 50.0)) < 1e-9);
    assert!(corner);
}
