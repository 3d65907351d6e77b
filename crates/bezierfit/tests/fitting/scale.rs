//! Corners as seen from a tolerance away: drawings by hand, traced, scanned or flattened ones become smooth curves and lines.

use super::common::polygon;
use bezierfit::{Degree, Options, simplify};
use kurbo::{BezPath, ParamCurve, Point, Vec2};
use pathwarp_oracle::curves::Curved as _;
use pathwarp_oracle::{Random, Run, apart};
use std::f64::consts::{PI, TAU};

/// Simplifies a path and checks the Hausdorff distance. Returns the result with the number of its segments.
fn simple(name: &str, path: &BezPath, tolerance: f64) -> (BezPath, usize) {
    let fitted = simplify(path, &Options::new(tolerance)).unwrap();
    let (source, result) = (path.curves(), fitted.path.curves());
    let count = fitted.path.segments().count();
    let error = apart(&Run::of(&source).sampled(8, tolerance), &Run::of(&result).sampled(60, tolerance)).0;
    assert!(
        error <= tolerance,
        "{name}: {error} of {tolerance}, in {count} pieces {} {}",
        path.to_svg(),
        fitted.path.to_svg()
    );
    assert!(
        fitted.report.max_error <= tolerance * (1.0 + 1e-9)
            && fitted.report.max_error >= 0.9 * error - 1e-3 * tolerance,
        "{name}: {error}"
    );
    assert_eq!(fitted.report.pieces.len(), count);
    (fitted.path, count)
}

/// A number with the normal distribution (G. E. P. Box, M. E. Muller 1958).
fn normal(random: &mut Random) -> f64 {
    (-2.0 * random.between(1e-300, 1.0).ln()).sqrt() * (TAU * random.between(0.0, 1.0)).cos()
}

/// The outline of the pixels whose middles lie in a shape, walked with the shape at its left.
fn pixels(inside: impl Fn(f64, f64) -> bool, from: [i32; 2]) -> Vec<Point> {
    let inside = |x: i32, y: i32| inside(f64::from(x) + 0.5, f64::from(y) + 0.5);
    let [mut x, y] = from;
    while inside(x, y) {
        x += 1;
    }
    let start = [x, y];
    let ([mut x, mut y], [mut dx, mut dy]) = (start, [0, 1]);
    let mut out = Vec::new();
    loop {
        out.push(Point::new(f64::from(x), f64::from(y)));
        for [u, v] in [[dy, -dx], [dx, dy], [-dy, dx]] {
            // The pixels at the left and the right of the edge that goes on in this direction.
            let [left, right] = [[-v, u], [v, -u]].map(|[a, b]| [x + (u + a - 1) / 2, y + (v + b - 1) / 2]);
            if inside(left[0], left[1]) && !inside(right[0], right[1]) {
                [dx, dy] = [u, v];
                break;
            }
        }
        (x, y) = (x + dx, y + dy);
        if [x, y] == start {
            return out;
        }
    }
}

#[test]
fn corners_stay_where_no_smooth_curve_can_stand_for_them() {
    let mut random = Random::new(62);
    for k in [3, 4, 5, 6, 8, 12, 17] {
        let turn = TAU / f64::from(k);
        // The nearest circle is s/4·tan(θ/4) off, for sides of length s and a turn θ.
        for (off, kept) in [(1.5, true), (2.0, true), (9.0, true), (0.7, false), (0.4, false)] {
            let side = 4.0 * off / (0.25 * turn).tan();
            let (r, a) = (0.5 * side / (0.5 * turn).sin(), random.between(0.0, TAU));
            let corners: Vec<Point> =
                (0..k).map(|i| (Vec2::from_angle(a + turn * f64::from(i)) * r).to_point()).collect();
            let (path, count) = simple("polygon", &polygon(&corners, true), 1.0);
            if kept {
                assert_eq!(path, polygon(&corners, true), "{k} corners, {off}");
            } else {
                assert!(count < (k as usize).max(4), "{k} corners, {off}: {count}");
            }
        }
    }
}

#[test]
fn noise_stairs_and_facets_become_what_they_mean() {
    let mut random = Random::new(7);
    // Points on r = 80 + 12 cos 3φ with noise.
    for (n, sigma) in [(2000, 0.08), (2000, 0.15), (20_000, 0.15)] {
        let point = |i: i32| {
            let a = TAU * f64::from(i) / f64::from(n);
            let noise = Vec2::new(normal(&mut random), normal(&mut random)) * sigma;
            (Vec2::from_angle(a) * (80.0 + 12.0 * (3.0 * a).cos()) + noise).to_point()
        };
        let noisy: Vec<Point> = (0..n).map(point).collect();
        assert!(simple("noise", &polygon(&noisy, true), 1.0).1 <= 12);
    }
    for r in [40.0, 71.3, 160.0] {
        let outline = pixels(|x, y| x.hypot(y) < r, [0, 0]);
        assert!(simple("pixels", &polygon(&outline, true), 1.0).1 <= 12, "{r}");
    }
    // A sloping bar of pixels has four sides.
    let (along, across) = (Vec2::from_angle(0.3), Vec2::from_angle(0.3 + 0.5 * PI));
    let bar = |x: f64, y: f64| Vec2::new(x, y).dot(along).abs() < 60.0 && Vec2::new(x, y).dot(across).abs() < 20.0;
    assert_eq!(simple("bar", &polygon(&pixels(bar, [0, 0]), true), 1.5).1, 4);
    let stairs: Vec<Point> = (0..120).map(|i| Point::new(f64::from(i / 2), f64::from((i + 1) / 2))).collect();
    assert_eq!(simple("stairs", &polygon(&stairs, false), 1.0).1, 1);
    let zigzag: Vec<Point> = (0..150).map(|i| Point::new(f64::from(i), if i % 2 == 0 { 0.1 } else { -0.1 })).collect();
    assert_eq!(simple("zigzag", &polygon(&zigzag, false), 1.5).1, 1);
    // Arcs of one circle whose ends are rounded, so that they join at small angles.
    let mut arcs = BezPath::new();
    let at = |i: i32| {
        let p = Vec2::from_angle(TAU * f64::from(i) / 36.0) * 30.0;
        Point::new((4.0 * p.x).round() / 4.0, (4.0 * p.y).round() / 4.0)
    };
    arcs.move_to(at(0));
    for i in 0..36 {
        let handle = 4.0 / 3.0 * (TAU / 144.0).tan() * 30.0;
        let [t0, t1] = [i, i + 1].map(|i| Vec2::from_angle(TAU * (f64::from(i) / 36.0 + 0.25)) * handle);
        arcs.curve_to(at(i) + t0, at(i + 1) - t1, at(i + 1));
    }
    arcs.close_path();
    assert_eq!(simple("arcs", &arcs, 0.6).1, 2);
}

#[test]
fn segments_of_no_length_and_nodes_on_lines_vanish() {
    let path = BezPath::from_svg("M0 0L0 0L30 0L60 0L60 0L60 40L60 40L31 40L30 40L0 40L0 0Z").unwrap();
    let (path, _) = simple("rectangle", &path, 0.1);
    assert_eq!(path.to_svg(), "M0,0 L60,0 L60,40 L0,40 Z");
}

#[test]
fn random_polylines_keep_their_distance() {
    let mut random = Random::new(99);
    for round in 0..300 {
        let (n, closed) = (2 + random.below(120), random.below(2) == 0);
        let step = random.one_of(&[0.3, 1.0, 4.0, 20.0]);
        let drift = random.one_of(&[0.0, 0.3, 1.0, PI]);
        let (mut at, mut heading) = (Point::new(50.0, 50.0), 0.0);
        let mut points = vec![at];
        for _ in 1..n {
            heading += drift * normal(&mut random);
            at += Vec2::from_angle(heading) * (step * random.between(0.0, 1.0));
            // Some points are repeated, and some lie on a grid.
            at = if random.below(8) == 0 { at.round() } else { at };
            points.push(at);
        }
        let path = polygon(&points, closed);
        let (_, count) = simple(&format!("{round}"), &path, 1.0);
        assert!(count <= path.segments().count(), "{round}: {count}");
        for degree in [Degree::Quadratic, Degree::Cubic] {
            let corner = Options::new(1.0).with_degree(degree).with_corner(0.4);
            let again = simplify(&path, &corner).unwrap();
            assert!(again.report.max_error <= 1.0 + 1e-9, "{round}");
        }
    }
}

/// Letters and stars keep their corners within the tolerance, also with noise.
#[test]
fn corners_of_noisy_stars_stay_near() {
    let mut random = Random::new(3);
    for tips in [4, 5, 7] {
        let corner = |i: usize| {
            let r = if i.is_multiple_of(2) { 100.0 } else { 45.0 };
            (Vec2::from_angle(0.2 + PI * i as f64 / tips as f64) * r).to_point()
        };
        let mut points = Vec::new();
        for i in 0..2 * tips {
            let (a, b) = (corner(i), corner(i + 1));
            let noise = |r: &mut Random| Vec2::new(normal(r), normal(r)) * 0.1;
            points.extend((0..60).map(|k| a.lerp(b, f64::from(k) / 60.0) + noise(&mut random)));
        }
        let (path, count) = simple("star", &polygon(&points, true), 1.0);
        assert_eq!(count, 2 * tips, "{}", path.to_svg());
        for i in 0..2 * tips {
            assert!(path.segments().any(|s| s.start().distance(corner(i)) < 1.0), "{tips}: corner {i}");
        }
    }
}
