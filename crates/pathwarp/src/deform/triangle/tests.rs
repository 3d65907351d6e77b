//! Bézier triangles: degrees, sides, rationals.

use super::*;
use crate::check;
use crate::deform::Deformation as _;
use crate::map::RationalBezier;
use crate::outline::Seg;
use crate::param::Args;

fn build(pairs: &[(&str, &str)]) -> Result<Built, Error> {
    ENTRY.build_from(&Args::from_pairs(pairs), &check::frame())
}

#[test]
fn is_sound() {
    let faults = check::entry(&ENTRY);
    assert!(faults.is_empty(), "{faults:#?}");
}

/// Compares every degree with the definition by factorials.
#[test]
fn every_degree_agrees_with_the_definition() {
    let corners = [Point::new(-20.0, 10.0), Point::new(120.0, -5.0), Point::new(30.0, 140.0)];
    for n in 1..=10usize {
        for rational in [false, true] {
            let mut net = TriangleNet::regular(corners, n).unwrap();
            for [i, j, k] in indices(n) {
                let wobble = (7 * i + 3 * j + 11 * k) as f64;
                net.shift([i, j, k], Vec2::new(9.0 * wobble.sin(), 9.0 * wobble.cos()));
                if rational {
                    net.set_weight([i, j, k], 1.5 + wobble.sin());
                }
            }
            let m = net.map(true, None);
            for p in [(30.0, 40.0), (0.0, 20.0), (90.0, 10.0), (40.0, 100.0), (-15.0, 120.0)].map(Point::from) {
                let area = |a: Point, b: Point, c: Point| (b - a).cross(c - a);
                let [a, b, c] = corners;
                let u = [area(p, b, c), area(a, p, c), area(a, b, p)].map(|v| v / area(a, b, c));
                let factorial = |k: usize| (1..=k).map(|v| v as f64).product::<f64>();
                let (mut x, mut w) = (Vec2::ZERO, 0.0);
                for ([i, j, k], value) in indices(n).into_iter().zip(basis(corners, n, p)) {
                    let many = factorial(n) / (factorial(i) * factorial(j) * factorial(k));
                    let b = many * u[0].powi(i as i32) * u[1].powi(j as i32) * u[2].powi(k as i32);
                    assert!((value - b).abs() < 1e-11);
                    let wobble = (7 * i + 3 * j + 11 * k) as f64;
                    let weight = if rational { 1.5 + wobble.sin() } else { 1.0 };
                    x += net.point([i, j, k]).to_vec2() * (b * weight);
                    w += b * weight;
                }
                let off = m.point(p).distance((x / w).to_point());
                // The change of basis multiplies rounding by up to 3ⁿ, by more far outside.
                let inside = u.iter().all(|v| *v >= 0.0);
                let near = if inside { 1e-13 * 3f64.powi(n as i32) } else { 1e-7 };
                assert!(off < near, "degree {n}: {off:e}");
                if p.x > 0.0 && p.y < 50.0 {
                    assert!(net.map(false, None).point(p).distance(m.point(p)) < 1e-12);
                }
            }
        }
    }
    assert_eq!(regular_point(corners, [0, 2, 0]), corners[1]);
}

#[test]
fn degree_one_is_affine_and_with_weights_projective() {
    let one = build(&[("degree", "1"), ("move", "0,1,0:5,5"), ("extend", "true")]).unwrap().map;
    assert!(matches!(one.class(), Class::Affine(_)));
    let two = build(&[("degree", "1"), ("weight", "0,1,0:3"), ("extend", "true")]).unwrap().map;
    assert!(matches!(two.class(), Class::Projective(_)));
    // Moved together, six points make an affine map too.
    let corners = ["2,0,0:0,10", "0,2,0:0,20", "0,0,2:0,0", "1,1,0:0,15", "1,0,1:0,5", "0,1,1:0,10"];
    let mut args = Args::from_pairs(&[("extend", "true")]);
    corners.iter().for_each(|c| args.push("move", *c));
    let m = ENTRY.build_from(&args, &check::frame()).unwrap().map;
    assert!(matches!(m.class(), Class::Affine(_)));
}

#[test]
fn exact_images_have_n_times_the_degree() {
    let cubic = Seg::Cubic(kurbo::CubicBez::new((5.0, 5.0), (90.0, 5.0), (20.0, 80.0), (60.0, 60.0)));
    let source = RationalBezier::from_seg(&cubic).unwrap();
    for (degree, node) in [("2", "0,1,1"), ("3", "1,1,1"), ("5", "1,2,2")] {
        let (shift, weight) = (format!("{node}:9,9"), format!("{node}:2"));
        for args in [vec![("move", &*shift)], vec![("move", &shift), ("weight", &weight)]] {
            let m = build(&[args, vec![("degree", degree)]].concat()).unwrap().map;
            let image = m.image(&source).unwrap();
            assert_eq!(image.degree(), 3 * degree.parse::<usize>().unwrap());
            for i in 0..=20 {
                let t = f64::from(i) / 20.0;
                assert!(image.eval(t).distance(m.point(source.eval(t))) < 1e-10);
            }
        }
    }
}

#[test]
fn a_fixed_side_joins_and_a_torn_one_warns() {
    let reference = ("reference", "10,20 90,30 40,90");
    let inner = build(&[reference, ("degree", "3"), ("move", "1,1,1:8,-6")]).unwrap();
    assert!(inner.explanation.warnings.is_empty(), "{:?}", inner.explanation.warnings);
    let b = inner.map.branch(Point::new(45.0, 45.0)).unwrap();
    for t in [0.0, 0.2, 0.7, 1.0] {
        let p = Point::new(10.0, 20.0).lerp(Point::new(90.0, 30.0), t);
        assert!(b.point(p).distance(p) < 1e-13);
    }
    let torn = build(&[reference, ("move", "1,1,0:8,-6")]).unwrap();
    assert!(
        torn.explanation.warnings.len() == 1 && torn.explanation.warnings[0].contains("first and second"),
        "{:?}",
        torn.explanation.warnings
    );
}

/// The triangle about the artwork's box has no edge, because strokes reach past it.
#[test]
fn the_artworks_box_has_no_outside() {
    let built = build(&[("move", "0,1,1:0,10")]).unwrap();
    assert!(built.explanation.warnings.is_empty(), "{:?}", built.explanation.warnings);
    let bottom = check::frame().rect.y1;
    for x in [-20.0, 10.0, 50.0, 90.0, 130.0] {
        let [above, below] = [-1e-6, 1e-6].map(|d| built.map.point(Point::new(x, bottom + d)));
        assert!(above.distance(below) < 1e-5, "{x}: {above} {below}");
    }
}

#[test]
fn every_fault_is_named() {
    for (pairs, part) in [
        (&[("reference", "0,0 1,1")][..], "three"),
        (&[("reference", "0,0 1,1 2,2")], "one line"),
        (&[("move", "1,1,1:3,3")], "add up to 2"),
        (&[("move", "1,1:3,3")], "I,J,K:"),
        (&[("move", "1,1,0:3")], "DX,DY"),
        (&[("weight", "1,1,0:0")], "above 0"),
        (&[("move", "99999999999999999999,1,0:0,0")], "I,J,K:"),
        (&[("degree", "11")], "out of range"),
    ] {
        let e = build(pairs).err().unwrap().to_string();
        assert!(e.contains(part), "{e}");
    }
}

/// Returns the image of barycentric coordinates under a net of six points in the order of `index`, by the definition.
fn six(points: &[Point], weights: &[f64], [a, b, c]: [f64; 3]) -> Point {
    let basis = [a * a, 2.0 * a * b, 2.0 * a * c, b * b, 2.0 * b * c, c * c];
    let w: f64 = basis.iter().zip(weights).map(|(b, w)| b * w).sum();
    let terms = points.iter().zip(basis.iter().zip(weights));
    terms.map(|(p, (b, k))| p.to_vec2() * (b * k / w)).sum::<Vec2>().to_point()
}

/// Every net near a regular one has weights that make it birational: its inverse is exact, and no other real point has the same image.
#[test]
fn six_points_are_birational() {
    let mut state = 11u64;
    let mut random = || {
        state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let corners = [Point::new(0.0, 0.0), Point::new(100.0, 0.0), Point::new(20.0, 90.0)];
    let at = |u: [f64; 3]| corners[0] + (corners[1] - corners[0]) * u[1] + (corners[2] - corners[0]) * u[2];
    let (mut others, mut several) = (0, 0);
    for round in 0..200 {
        let lambda = if round % 2 == 0 { [1.0; 3] } else { [1.5, 0.8, 1.1] };
        let mut net = TriangleNet::regular(corners, 2).unwrap();
        indices(2).into_iter().for_each(|ijk| net.shift(ijk, Vec2::new(9.0 * random(), 9.0 * random())));
        let points: Vec<Point> = indices(2).into_iter().map(|ijk| net.point(ijk)).collect();
        let found = birational::birational(&points, lambda, corners).unwrap();
        let [a, b, c] = found.weights;
        let weights = [lambda[0] * lambda[0], a, b, lambda[1] * lambda[1], c, lambda[2] * lambda[2]];
        for (ijk, w) in indices(2).into_iter().zip(weights) {
            net.set_weight(ijk, w);
        }
        let (plain, exact) = (net.map(true, None), net.map(true, Some(found.back)));
        for _ in 0..5 {
            let (x, y) = (0.5 + 0.5 * random(), 0.5 + 0.5 * random());
            let u = if x + y > 1.0 { [x + y - 1.0, 1.0 - x, 1.0 - y] } else { [1.0 - x - y, x, y] };
            let q = six(&points, &weights, u);
            assert!(exact.point(at(u)).distance(q) < 1e-10);
            let back = exact.inverse().unwrap();
            assert!(back.cost().searches.is_none());
            assert!(back.point(q).distance(at(u)) < 1e-7, "{round}: {u:?}");
            assert_eq!(exact.preimages(q).unwrap().len(), 1);
            // The general search for preimages does not use the birational weights; it finds this point alone.
            let all = crate::map::preimages(&plain, &[q], Rect::ZERO).concat();
            several += usize::from(all.len() > 1);
            let equal = TriangleNet { weights: vec![1.0; 6], ..net.clone() }.map(true, None);
            others += usize::from(equal.preimages(six(&points, &[1.0; 6], u)).unwrap().len() > 1);
        }
    }
    assert_eq!(several, 0);
    assert!(others > 500, "with equal weights most places come from several: {others}");
}

#[test]
fn a_net_without_birational_weights_is_named() {
    let flag = ("birational", "true");
    let fails = |pairs: &[(&str, &str)]| build(pairs).unwrap_err().to_string();
    assert!(fails(&[flag, ("degree", "3")]).contains("degree 2"));
    assert!(fails(&[flag, ("weight", "1,1,0:2")]).contains("corners only"));
    let far = fails(&[flag, ("reference", "0,0 100,0 0,100"), ("at", "0,1,1:150,-30")]);
    assert!(far.contains("no positive weights"), "{far}");
    let flat = fails(&[flag, ("reference", "0,0 100,0 0,100"), ("at", "0,0,2:50,0")]);
    assert!(flat.contains("on one line"), "{flat}");
    let local = build(&[flag, ("reference", "0,0 100,0 0,100"), ("move", "0,1,1:9,4")]).unwrap();
    let (p, back) = (Point::new(30.0, 40.0), local.map.inverse().unwrap());
    assert!(back.point(local.map.point(p)).distance(p) < 1e-10);
    assert_eq!(back.point(Point::new(-30.0, 40.0)), Point::new(-30.0, 40.0));
}
