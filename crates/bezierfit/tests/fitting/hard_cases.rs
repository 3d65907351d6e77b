//! Curves on which other fitters hang, panic, leave the curve or cut corners. Each is covered within the tolerance, by an independent
//! measurement, with a bounded number of pieces and of evaluations.

use super::common::{Drawn, distance, off, polygon};
use bezierfit::{Degree, Fitted, Offset, Options, PathSource, Pieces, Source, fit, simplify};
use kurbo::{BezPath, CubicBez, ParamCurve, ParamCurveDeriv, ParamCurveNearest, PathSeg, Point, Vec2};
use pathwarp_oracle::Random;

/// Fits a source, and checks the distance and the numbers of pieces and of evaluations.
fn check(name: &str, source: &dyn Source, tolerance: f64, most: usize) -> Fitted {
    let counted = Drawn::new(|t| source.eval(t), source.breaks());
    let fitted = fit(&counted, &Options::new(tolerance)).unwrap();
    let pieces = fitted.path.segments().count();
    let error = distance(source, &fitted.path, tolerance);
    assert!(fitted.report.unresolved.is_empty(), "{name}: {:?}", fitted.report);
    assert!(error <= 1.001 * tolerance, "{name}: {} of the tolerance", error / tolerance);
    assert!(pieces <= most, "{name}: {pieces} pieces");
    let spent = counted.evaluations.get();
    assert!(spent <= 5000 * most, "{name}: {spent} evaluations");
    fitted
}

fn polyline(points: &[(f64, f64)], close: bool) -> BezPath {
    polygon(&points.iter().map(|p| (*p).into()).collect::<Vec<_>>(), close)
}

/// Polygons of kurbo's issues 601 and 603 (a panic on a sliver), 602 (a hang on a fold) and 604 (a control point 19,000 units away on a
/// nearly flat polygon), with their coordinates and tolerances.
#[test]
fn polygons_keep_their_corners() {
    let sliver = polyline(&[(1.0, 0.7), (4.1, 2.0), (4.4, 2.1), (0.0, 0.0)], true);
    let fold = polyline(&[(10.0, 2.0), (20.0, 0.0), (0.0, 0.0)], false);
    let flat = polyline(&[(415.74, 324.0), (440.0, 324.5), (460.0, 325.49), (480.0, 325.0), (493.93, 324.0)], false);
    for path in [sliver, fold, flat] {
        for tolerance in [0.01, 2.0, 16.0] {
            let simple = simplify(&path, &Options::new(tolerance).with_corner(0.01)).unwrap();
            assert_eq!(simple.path, path, "{tolerance}");
            let meant = simplify(&path, &Options::new(tolerance)).unwrap();
            assert!(meant.path.segments().count() <= path.segments().count());
            assert!(distance(&PathSource::new(&path).unwrap(), &meant.path, tolerance) <= tolerance);
        }
    }
    // These polygons as one curve with corners where the sides meet, as kurbo's fits got them.
    for path in [sliver_and_fold(0), sliver_and_fold(1)] {
        let fitted = fit(&PathSource::new(&path).unwrap(), &Options::new(2.0)).unwrap();
        let error = distance(&PathSource::new(&path).unwrap(), &fitted.path, 2.0);
        assert!(error <= 2.0 && fitted.report.unresolved.is_empty(), "{error}");
    }
    let mixed = BezPath::from_svg("M0 0H50C77.6 0 100 22.4 100 50V100").unwrap();
    let simple = simplify(&mixed, &Options::new(0.01)).unwrap();
    assert_eq!(simple.path.segments().count(), 3);
}

/// The sliver of kurbo's issue 601 and the fold of 602.
fn sliver_and_fold(which: usize) -> BezPath {
    match which {
        0 => polyline(&[(1.0, 0.7), (4.1, 2.0), (4.4, 2.1), (0.0, 0.0)], true),
        _ => polyline(&[(10.0, 2.0), (20.0, 0.0), (0.0, 0.0)], false),
    }
}

/// Nearly flat polygons do not leave their neighbourhood as points of smooth curves, either: kurbo's issues 604 and 605, in which
/// end tangents are missing.
#[test]
fn flat_polygons_stay_flat() {
    let points = [(415.74, 324.0), (440.0, 324.5), (460.0, 325.49), (480.0, 325.0), (493.93, 324.0)].map(Point::from);
    for tolerance in [0.01, 0.25, 2.0, 16.0] {
        for degree in [Degree::Cubic, Degree::Quadratic] {
            let options = Options::new(tolerance).with_degree(degree).with_corner(2.0);
            let fitted = simplify(&polygon(&points, false), &options).unwrap();
            assert!(off(&points, &fitted.path) <= tolerance);
            let bounds = kurbo::Shape::bounding_box(&fitted.path);
            assert!(bounds.x0 >= 415.7 && bounds.x1 <= 494.0 && bounds.y0 > 323.0 && bounds.y1 < 326.5, "{bounds:?}");
        }
    }
}

/// A path of smooth runs and corners, from kurbo's issue 268: kurbo crosses its corners at 0.18 and panics at 0.3.
#[test]
fn corners_between_smooth_runs_are_not_crossed() {
    // Petals of many cubics around a middle, with corners where they meet.
    let mut path = BezPath::new();
    let at = |u: f64| {
        let (r, a) = (100.0 * (5.0 * u).sin().abs(), u);
        Point::new(200.0 + r * a.cos(), 200.0 + r * a.sin())
    };
    let along = |u: f64| (at(u + 1e-6) - at(u - 1e-6)) / 2e-6;
    let petal = std::f64::consts::PI / 5.0;
    let n = 24;
    path.move_to(at(0.0));
    for k in 0..10 * n {
        let [u, v] = [k, k + 1].map(|i| petal * f64::from(i) / f64::from(n));
        let [from, to] = [along(u + 2e-6), along(v - 2e-6)].map(|d| d * (petal / f64::from(n) / 3.0));
        path.curve_to(at(u) + from, at(v) - to, at(v));
    }
    path.close_path();
    for tolerance in [0.18, 0.3] {
        let simple = simplify(&path, &Options::new(tolerance)).unwrap();
        let error = distance(&PathSource::new(&path).unwrap(), &simple.path, tolerance);
        assert!(error <= tolerance, "{error}");
        assert!(simple.path.segments().count() <= 40, "{}", simple.path.segments().count());
        for k in 0..10 {
            let corner = at(petal * f64::from(k));
            assert!(simple.path.segments().any(|s| s.start().distance(corner) < 1e-9));
        }
    }
}

/// Offsets as in kurbo's issues 344 (at −8 within 0.01) and 300, which hang or give NaN: an end without a handle, curves on one
/// line, radii of curvature below the distance.
#[test]
fn offsets_break_at_their_cusps() {
    let cubic = |p: [f64; 8]| PathSeg::Cubic(CubicBez::new((p[0], p[1]), (p[2], p[3]), (p[4], p[5]), (p[6], p[7])));
    let no_handle = cubic([51.0, 0.0, -0.085_937_5, 161.640_625, 0.0, 164.0, 0.0, 164.0]);
    let hook = cubic([0.0, 0.0, 100.0, 0.0, 100.0, 20.0, 0.0, 20.0]);
    let bow = cubic([0.0, 0.0, 30.0, 80.0, 70.0, 80.0, 100.0, 0.0]);
    for (name, seg) in [("without a handle", no_handle), ("hook", hook), ("bow", bow)] {
        for distance in [-60.0, -8.0, -1.0, 1.0, 8.0, 60.0] {
            check(&format!("{name} at {distance}"), &Offset::new(seg, distance), 0.01, 40);
        }
    }
    // Each point of the offset is at the distance from the curve.
    let far = fit(&Offset::new(bow, 5.0), &Options::new(1e-4)).unwrap();
    for p in far.path.segments().flat_map(|s| (0..=10).map(move |i| s.eval(f64::from(i) / 10.0))) {
        let off = bow.nearest(p, 1e-12).distance_sq.sqrt();
        assert!((off - 5.0).abs() < 1.1e-4, "{off}");
    }
}

#[test]
fn spirals_loops_flat_ellipses_and_cusps_are_followed() {
    let spiral = |t: f64| {
        let (s, c) = (40.0 * t).sin_cos();
        (Point::new(100.0 * t * c, 100.0 * t * s), Vec2::new(c - 40.0 * t * s, s + 40.0 * t * c) * 100.0)
    };
    check("spiral", &Drawn::new(spiral, Vec::new()), 0.01, 40);
    // A clothoid: its derivative is in closed form, its points are integrals by the midpoint rule.
    let clothoid = |t: f64| {
        let phase = |u: f64| 12.0 * u * u;
        let n = 400;
        let sum = (0..n)
            .map(|i| Vec2::from_angle(phase(t * (f64::from(i) + 0.5) / f64::from(n))))
            .fold(Vec2::ZERO, |a, b| a + b);
        ((sum * (100.0 * t / f64::from(n))).to_point(), Vec2::from_angle(phase(t)) * 100.0)
    };
    check("clothoid", &Drawn::new(clothoid, Vec::new()), 0.01, 20);
    let ellipse = |t: f64| {
        let (s, c) = (std::f64::consts::TAU * t).sin_cos();
        (Point::new(1000.0 * c, s), Vec2::new(-1000.0 * s, c) * std::f64::consts::TAU)
    };
    check("ellipse", &Drawn::new(ellipse, Vec::new()), 0.01, 24);
    let lissajous = |t: f64| {
        let u = std::f64::consts::TAU * t;
        let (x, y) = ((3.0 * u).sin(), (2.0 * u).sin());
        (
            Point::new(100.0 * x, 100.0 * y),
            Vec2::new(300.0 * (3.0 * u).cos(), 200.0 * (2.0 * u).cos()) * std::f64::consts::TAU,
        )
    };
    check("Lissajous", &Drawn::new(lissajous, Vec::new()), 0.01, 60);
    // The curve y² = x³, with the cusp inside.
    let cusp = |t: f64| {
        let u = 2.0 * t - 1.0;
        (Point::new(50.0 * u * u, 50.0 * u * u * u), Vec2::new(200.0 * u, 300.0 * u * u))
    };
    check("cusp", &Drawn::new(cusp, Vec::new()), 0.01, 8);
    let near = |t: f64| {
        let u = 2.0 * t - 1.0;
        (Point::new(50.0 * u * u, 50.0 * u * u * u + 0.01 * u), Vec2::new(200.0 * u, 300.0 * u * u + 0.02))
    };
    check("near-cusp", &Drawn::new(near, Vec::new()), 0.001, 16);
}

/// Closed and open curves far from the origin under x + 4 sin(y/16), y − xy/500. They are 20 units wide and 10,000 long, and turn back
/// within a few units.
#[test]
fn hairpins_are_followed() {
    let mut random = Random::new(3);
    for k in 0..24 {
        let mut point = || Point::new(random.between(0.0, 100.0), random.between(0.0, 100.0));
        let drop = CubicBez::new((50.0, 62.5), (16.7, 47.78587920056), (83.3, 47.78587920056), (50.0, 62.5));
        let cubic = if k == 0 { drop } else { CubicBez::new(point(), point(), point(), point()) };
        let around = kurbo::Shape::bounding_box(&cubic);
        let hairpin = |t: f64| {
            let (p, d) = (cubic.eval(t), cubic.deriv().eval(t));
            let (x, y) = (1e5 + p.x, 3e5 + p.y);
            let (sin, cos) = (y / 16.0).sin_cos();
            let down = (p.x * 3e5 + p.y * 1e5 + p.x * p.y) / 500.0;
            (
                Point::new(p.x + 4.0 * sin, p.y - down),
                Vec2::new(d.x + 0.25 * cos * d.y, d.y - (d.x * y + x * d.y) / 500.0),
            )
        };
        check("hairpin", &Drawn::new(hairpin, Vec::new()), 1e-4 * around.width().hypot(around.height()), 12);
    }
}

#[test]
fn scale_does_not_matter() {
    let bow = CubicBez::new((0.0, 0.0), (0.3, 0.8), (0.7, 0.8), (1.0, 0.0));
    let counts = [1e-6, 1.0, 1e6].map(|size: f64| {
        let scaled = PathSeg::Cubic(kurbo::Affine::scale(size) * bow);
        check(&format!("{size}"), &Offset::new(scaled, 0.1 * size), 1e-4 * size, 8).path.segments().count()
    });
    assert!(counts[0] == counts[1] && counts[1] == counts[2], "{counts:?}");
}

#[test]
fn what_is_not_finite_is_said() {
    let pole = |t: f64| (Point::new(t, 1.0 / (t - 0.5)), Vec2::new(1.0, -1.0 / (t - 0.5).powi(2)));
    let hole = |t: f64| if (0.4..0.6).contains(&t) { (Point::new(f64::NAN, 0.0), Vec2::ZERO) } else { pole(t) };
    assert!(fit(&Drawn::new(hole, Vec::new()), &Options::new(0.01)).is_err());
    let broken =
        BezPath::from_vec(vec![kurbo::PathEl::MoveTo(Point::ORIGIN), kurbo::PathEl::LineTo(Point::new(f64::NAN, 1.0))]);
    assert!(simplify(&broken, &Options::new(0.01)).is_err());
}

#[test]
fn a_circle_of_any_number_of_cubics_is_four() {
    for n in [8, 40, 1000, 100_000] {
        let step = std::f64::consts::TAU / f64::from(n);
        let handle = 4.0 / 3.0 * (0.25 * step).tan() * 1000.0;
        let at = |i: i32| Vec2::from_angle(step * f64::from(i % n));
        let along = |i: i32| Vec2::new(-at(i).y, at(i).x) * handle;
        let place = |i: i32| (at(i) * 1000.0).to_point();
        let mut path = BezPath::new();
        path.move_to(place(0));
        (0..n).for_each(|i| path.curve_to(place(i) + along(i), place(i + 1) - along(i + 1), place(i + 1)));
        path.close_path();
        for certify in [false, true] {
            let simple = simplify(&path, &Options::new(1.0).with_certify(certify)).unwrap();
            assert_eq!(simple.path.segments().count(), 4, "{n} {certify}");
            let radii = simple
                .path
                .segments()
                .flat_map(|s| (0..=50).map(move |i| s.eval(f64::from(i) / 50.0).to_vec2().hypot()));
            assert!(radii.into_iter().all(|r| (r - 1000.0).abs() <= 1.0));
        }
        let quadratics = simplify(&path, &Options::new(1.0).with_degree(Degree::Quadratic)).unwrap();
        // Eleven quadratics that touch the circle at both ends are off by (sec α + cos α)/2 − 1 = 0.00086, where α = π/11.
        assert!(quadratics.path.segments().count() <= 11, "{n}: {}", quadratics.path.segments().count());
        let radii = quadratics
            .path
            .segments()
            .flat_map(|s| (0..=50).map(move |i| s.eval(f64::from(i) / 50.0).to_vec2().hypot()));
        assert!(radii.into_iter().all(|r| (r - 1000.0).abs() <= 1.0) && quadratics.report.max_error <= 1.0);
    }
}

#[test]
fn noise_ends_and_is_said() {
    let noise = |t: f64| {
        let phase = 1e7 * t * t;
        (Point::new(100.0 * t, 50.0 * phase.sin()), Vec2::new(100.0, 1e9 * t * phase.cos()))
    };
    for (degree, pieces) in
        [(Degree::Cubic, Pieces::Fewest), (Degree::Quadratic, Pieces::Fewest), (Degree::Cubic, Pieces::AtMost(3))]
    {
        const MOST: usize = 220_000;
        let noise = Drawn::new(noise, Vec::new());
        let options = Options::new(0.01).with_degree(degree).with_pieces(pieces).with_evaluations(MOST);
        match (pieces, fit(&noise, &options)) {
            (Pieces::Fewest, fitted) => {
                assert!(matches!(fitted, Err(bezierfit::Error::NotMet { error, .. }) if error > 49.0), "{fitted:?}");
                let best = fit(&noise, &options.with_best(true)).unwrap().report;
                assert!(!best.unresolved.is_empty() && best.max_error < 200.0, "{}", best.max_error);
            }
            (_, Ok(fitted)) => assert!(fitted.report.max_error > 10.0),
            (_, Err(e)) => assert!(matches!(e, bezierfit::Error::TooFewPieces { .. }), "{e}"),
        }
        let most = if pieces == Pieces::Fewest { 3 } else { 60 } * MOST;
        assert!(noise.evaluations.get() <= most, "{degree:?}: {}", noise.evaluations.get());
    }
}
