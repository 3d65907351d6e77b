//! The birational map against the exact numbers of the paper, and round trips over many random lattices.

use super::*;
use crate::refit::{Options, warp_path};
use crate::{Outline, Seg};
use kurbo::CubicBez;

const UNIT: Rect = Rect::new(0.0, 0.0, 1.0, 1.0);

fn points(p: &[(f64, f64)]) -> Vec<Point> {
    p.iter().map(|p| Point::from(*p)).collect()
}

fn build(left: &[Point], right: &[Point]) -> Result<Birational, GeometryError> {
    Birational::new(UNIT, Rows::LeftRight, [left, right], None, false, ["--left", "--right"])
}

/// The condition for the weights of degree 1×1, equation (7).
fn condition(p: [[Point; 2]; 2]) -> f64 {
    let det = |a: Point, b: Point, c: Point| (b - a).cross(c - a);
    let [[p00, p01], [p10, p11]] = p;
    det(p01, p00, p10) * det(p10, p11, p01) / (det(p11, p01, p00) * det(p00, p10, p11))
}

#[test]
fn the_papers_quadrilateral() {
    let (p00, p10, p01, p11) =
        (Point::new(0.0, 0.0), Point::new(12.0, 0.0), Point::new(8.0, 6.0), Point::new(12.0, 4.0));
    // Figure 3.c: A = (20, 0), Q0 = (0, 0) and Q1 = (0, 10) give w01 = 5/3 with the others 1.
    let row = |a: Point, b: Point| Monoid::new(&[a, b], [20.0, 0.0, 1.0], [p00, Point::new(0.0, 10.0)]).unwrap();
    let rows = [row(p00, p01), row(p10, p11)];
    assert!((rows[0].weights[1] - 5.0 / 3.0).abs() < 1e-15 && (rows[1].weights[1] - 1.0).abs() < 1e-15);
    assert!((condition([[p00, p01], [p10, p11]]) - 3.0 / 5.0).abs() < 1e-15, "w00·w11 / (w01·w10)");
    let map = Birational::from_monoids(UNIT, Rows::LeftRight, vec![rows]);
    let q = Point::new(8.0, 4.0);
    let back = Map::inverse(&map).unwrap();
    assert!(map.point(Point::new(0.4, 2.0 / 3.0)).distance(q) < 1e-14);
    assert!(back.point(q).distance(Point::new(0.4, 2.0 / 3.0)) < 1e-15);
    // Equation (6), with 36 where the paper prints 26.
    for (x, y) in [(8.0, 4.0), (3.0, 1.0), (11.0, 2.5), (6.0, 5.0)] {
        let by_hand = Point::new((3.0 * x - 4.0 * y) / (36.0 - 4.0 * y), 2.0 * y / (20.0 - x));
        assert!(back.point(Point::new(x, y)).distance(by_hand) < 1e-14);
    }
    // Under the default normalisation the points have other parameters, but the condition holds.
    let own = build(&[p00, p01], &[p10, p11]).unwrap();
    let rows = &own.pieces[0].rows;
    let (w0, w1) = (&rows[0].weights, &rows[1].weights);
    assert!((w0[0] * w1[1] / (w0[1] * w1[0]) - 0.6).abs() < 1e-14 && (w0[1] * w1[1] - 1.0).abs() < 1e-14);
}

#[test]
fn a_rectangle_is_the_identity_and_a_parallelogram_affine() {
    let left: Vec<Point> = (0..=4).map(|j| Point::new(0.0, f64::from(j) / 4.0)).collect();
    let right: Vec<Point> = left.iter().map(|p| *p + Vec2::new(1.0, 0.0)).collect();
    assert_eq!(build(&left, &right).unwrap().class(), Class::Affine(kurbo::Affine::IDENTITY));
    let right: Vec<Point> = left.iter().map(|p| *p + Vec2::new(3.0, 2.0)).collect();
    assert!(matches!(build(&left, &right).unwrap().class(), Class::Affine(_)));
}

/// The closed form s = f₀/(f₀ − f₁), and the equation of each row, which vanishes on it.
#[test]
fn the_rows_equations_invert_the_map() {
    let map = bent();
    let [a, b] = map.pieces[0].rows.clone();
    for i in 0..=10 {
        for j in 0..=10 {
            let p = Point::new(f64::from(i) / 10.0, f64::from(j) / 10.0);
            let x = map.point(p);
            let (f0, f1) = (a.implicit(x), b.implicit(x));
            assert!((f0 / (f0 - f1) - p.x).abs() < 1e-12, "{p:?}");
            assert!((a.parameter(x) - p.y).abs() < 1e-13 && (b.parameter(x) - p.y).abs() < 1e-13);
            if i == 0 {
                assert!(f0.abs() < 1e-14, "{f0}");
            }
        }
    }
}

fn bent() -> Birational {
    let left = points(&[(0.0, 0.0), (-20.0, 25.0), (15.0, 55.0), (5.0, 90.0)]);
    let right = points(&[(80.0, -10.0), (100.0, 30.0), (70.0, 60.0), (95.0, 110.0)]);
    build(&left, &right).unwrap()
}

#[test]
fn lines_of_constant_t_stay_straight_and_images_are_exact() {
    let map = bent();
    let line = Outline::from_svg("M0.05,0.3 L0.95,0.3").unwrap();
    let w = warp_path(&line, &map, &Options::new(1e-6)).unwrap();
    assert_eq!(w.report.segments_out, 1);
    assert!(matches!(w.path.elements()[1], kurbo::PathEl::LineTo(_)), "{:?}", w.path);
    let cubic = Seg::Cubic(CubicBez::new((0.1, 0.1), (0.9, 0.0), (0.8, 0.7), (0.2, 0.9)));
    let source = RationalBezier::from_seg(&cubic).unwrap();
    let image = map.image(&source).unwrap();
    assert_eq!(image.degree(), 3 * (1 + 3));
    let back = map.inverted();
    let again = Map::image(&back, &image).unwrap();
    for i in 0..=20 {
        let t = f64::from(i) / 20.0;
        assert!(image.eval(t).distance(map.point(source.eval(t))) < 1e-12);
        assert!(again.eval(t).distance(source.eval(t)) < 1e-8);
    }
    let direct = Map::image(&back, &RationalBezier::polynomial(&points(&[(10.0, 20.0), (50.0, 70.0)]))).unwrap();
    assert_eq!(direct.degree(), 4);
    for i in 0..=20 {
        let t = f64::from(i) / 20.0;
        let q = Point::new(10.0, 20.0).lerp(Point::new(50.0, 70.0), t);
        assert!(direct.eval(t).distance(back.point(q)) < 1e-12);
    }
}

/// Pseudo-random numbers in [-1, 1) (splitmix64).
struct Random(u64);
impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// 10⁵ random lattices of degree 1×1 to 1×5: round trips agree to 1e-12 of the lattice's size in the image, and in the source
/// relative to the condition number of the map there.
#[test]
fn round_trips() {
    let mut random = Random(7);
    let (mut built, mut worst_image, mut worst_source) = (0, 0.0f64, 0.0f64);
    while built < 100_000 {
        let n = 1 + built % 5;
        let amount = 0.9 / n as f64;
        let row = |random: &mut Random, x: f64| -> Vec<Point> {
            let at = |j: usize| 100.0 * j as f64 / n as f64;
            (0..=n).map(|j| Point::new(x + 40.0 * random.next(), at(j) + 100.0 * amount * random.next())).collect()
        };
        let (left, right) = (row(&mut random, 0.0), row(&mut random, 100.0));
        let Ok(map) = build(&left, &right) else { continue };
        built += 1;
        let p = Point::new(0.5 + 0.5 * random.next(), 0.5 + 0.5 * random.next());
        let back = map.inverted();
        let jet = map.jet(p);
        let again = Map::point(&back, jet.p);
        let steep = (jet.dx.hypot2() + jet.dy.hypot2()).sqrt();
        // The shift of the source point caused by a rounding error of the image coordinates.
        let condition = (steep / jet.det().abs() * 150.0).max(1.0);
        worst_source = worst_source.max(again.distance(p) / condition);
        worst_image = worst_image.max(map.point(again).distance(jet.p) / 150.0);
    }
    assert!(worst_source < 1e-12, "{worst_source:e}");
    assert!(worst_image < 1e-12, "{worst_image:e}");
}

#[test]
fn points_out_of_place_are_named() {
    let right = points(&[(10.0, 0.0), (10.0, 5.0), (10.0, 10.0)]);
    let e = build(&points(&[(0.0, 0.0), (-1.0, -2.0), (0.0, 10.0)]), &right).unwrap_err().to_string();
    assert!(e.contains("--left: point 2 (-1,-2) lies beyond the line through the first points"), "{e}");
    assert!(e.contains("allow poles"), "{e}");
    let e = build(&points(&[(0.0, 0.0), (-1.0, 0.0), (0.0, 10.0)]), &right).unwrap_err().to_string();
    assert!(e.contains("lies on the line") && !e.contains("poles: "), "{e}");
    let e = build(&points(&[(0.0, 0.0), (3.0, 12.0), (0.0, 10.0)]), &right).unwrap_err().to_string();
    assert!(e.contains("point 2 (3,12) lies beyond the line through the last points"), "{e}");
    let e = build(&points(&[(10.0, 0.0), (3.0, 5.0), (0.0, 10.0)]), &right).unwrap_err().to_string();
    assert!(e.contains("coincide at 10,0"), "{e}");
    // With poles allowed, the map is defined, and refused only for a path that meets a pole.
    let left = points(&[(0.0, 0.0), (-1.0, -2.0), (0.0, 10.0)]);
    let map = Birational::new(UNIT, Rows::LeftRight, [&left, &right], None, true, ["--left", "--right"]).unwrap();
    let back = map.inverted();
    let p = Point::new(0.9, 0.1);
    assert!(Map::point(&back, map.point(p)).distance(p) < 1e-12);
    let across = Outline::from_svg("M0.01,0 L0.01,1").unwrap();
    assert!(matches!(warp_path(&across, &map, &Options::new(1e-3)), Err(GeometryError::Infinity { .. })));
}

#[test]
fn spline_rows_share_the_lines_between_their_pieces() {
    let left = points(&[(0.0, 0.0), (-20.0, 25.0), (15.0, 50.0), (-10.0, 80.0), (5.0, 95.0), (0.0, 130.0)]);
    let right = points(&[(80.0, -5.0), (100.0, 30.0), (70.0, 55.0), (95.0, 70.0), (80.0, 100.0), (90.0, 120.0)]);
    for degree in [1, 2, 3] {
        let map = Birational::new(UNIT, Rows::LeftRight, [&left, &right], Some(degree), false, ["--left", "--right"])
            .unwrap();
        let pieces = 6 - degree;
        assert_eq!(map.pieces.len(), pieces);
        let back = map.inverted();
        for k in 1..pieces {
            let t = k as f64 / pieces as f64;
            for i in 0..=10 {
                let s = f64::from(i) / 10.0;
                let (a, b) = (map.jet(Point::new(s, t - 1e-9)), map.jet(Point::new(s, t + 1e-9)));
                assert!(a.p.distance(b.p) < 1e-6, "{degree} {k} {s}");
                assert!((a.dx - b.dx).hypot() < 1e-5, "both pieces run at the same speed along the line between them");
                if degree > 1 && (i == 0 || i == 10) {
                    let turn = a.dy.cross(b.dy) / (a.dy.hypot() * b.dy.hypot());
                    assert!(turn.abs() < 1e-6, "rows keep their tangents: {turn}");
                }
            }
        }
        for i in 0..=20 {
            for j in 0..=20 {
                let p = Point::new(f64::from(i) / 20.0, 0.003 + f64::from(j) / 20.1);
                let q = Map::point(&back, map.point(p));
                assert!(q.distance(p) < 1e-11, "{degree} {p:?} {q:?}");
            }
        }
    }
    // Regular rows give the identity.
    let regular: Vec<Point> = [0.0, 1.0 / 6.0, 0.5, 5.0 / 6.0, 1.0].iter().map(|y| Point::new(0.0, *y)).collect();
    let facing: Vec<Point> = regular.iter().map(|p| *p + Vec2::new(1.0, 0.0)).collect();
    let map = Birational::new(UNIT, Rows::LeftRight, [&regular, &facing], Some(2), false, ["", ""]).unwrap();
    assert!(map.point(Point::new(0.3, 0.77)).distance(Point::new(0.3, 0.77)) < 1e-15);
}

/// The value of y where x(t) = x on a rational Bézier row with given weights, by bisection.
fn graph_by_definition(points: &[Point], weights: &[f64], x: f64) -> f64 {
    let n = points.len() - 1;
    let at = |t: f64| {
        let choose = |i: usize| (0..i).fold(1.0, |c, k| c * (n - k) as f64 / (k + 1) as f64);
        let b = |i: usize| weights[i] * choose(i) * t.powi(i as i32) * (1.0 - t).powi((n - i) as i32);
        let w: f64 = (0..=n).map(b).sum();
        (0..=n).map(|i| points[i].to_vec2() * (b(i) / w)).sum::<Vec2>()
    };
    let (mut lo, mut hi) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (lo + hi);
        if at(middle).x < x { lo = middle } else { hi = middle }
    }
    at(lo).y
}

/// Equation 23: with Q₀ and Q₁ at the ends of parallel lines, x' = x, and each row is the graph of a function.
#[test]
fn explicit_rows_are_graphs() {
    let top = points(&[(0.0, 0.0), (0.2, -0.4), (0.3, 0.1), (1.0, 0.0)]);
    let bottom = points(&[(0.0, 1.0), (0.8, 1.2), (0.9, 1.0), (1.0, 1.0)]);
    let map = Birational::new(UNIT, Rows::TopBottom, [&top, &bottom], None, false, ["top", "bottom"]).unwrap();
    assert_eq!(map.axis()[2], 0.0, "the lines across are parallel");
    let map = map.along([top[0], top[3]]).unwrap();
    let graph = Monoid::graph(&top).unwrap();
    // Equation 12 by hand: w_i = -i·(x_{i-1} - 1)/((4 - i)·x_i)·w_{i-1}.
    let mut weights = vec![1.0];
    for i in 1..=3 {
        weights.push(weights[i - 1] * i as f64 * (1.0 - top[i - 1].x) / ((4 - i) as f64 * top[i].x));
    }
    for i in 1..20 {
        let x = f64::from(i) / 20.0;
        let y = graph_by_definition(&top, &weights, x);
        assert!(map.point(Point::new(x, 0.0)).distance(Point::new(x, y)) < 1e-12);
        assert!(graph.point(graph.parameter(Point::new(x, 7.0))).distance(Point::new(x, y)) < 1e-12);
    }
}

/// The fourth weight by equation 7 from three; A of the quadrilateral is (20, 0).
#[test]
fn three_weights_make_the_fourth_and_q_sets_the_speed() {
    let (left, right) = (points(&[(0.0, 0.0), (8.0, 6.0)]), points(&[(12.0, 0.0), (12.0, 4.0)]));
    let map = build(&left, &right).unwrap();
    let [x, y, w] = map.axis();
    assert!((x / w - 20.0).abs() < 1e-12 && (y / w).abs() < 1e-12);
    let other = map.respaced([3.0, 0.25], 1.7).unwrap();
    let [a, b] = &other.pieces[0].rows;
    let ratio = a.weights[0] * b.weights[1] / (a.weights[1] * b.weights[0]);
    assert!((ratio - condition([[left[0], left[1]], [right[0], right[1]]])).abs() < 1e-14);
    let p = Point::new(0.3, 0.8);
    assert!(Map::point(&other.inverted(), other.point(p)).distance(p) < 1e-14);
    let paper = map.along([left[0], Point::new(0.0, 10.0)]).unwrap();
    for (x, y) in [(8.0, 4.0), (3.0, 1.0), (11.0, 2.5), (6.0, 5.0)] {
        let by_hand = Point::new((3.0 * x - 4.0 * y) / (36.0 - 4.0 * y), 2.0 * y / (20.0 - x));
        assert!(Map::point(&paper.inverted(), Point::new(x, y)).distance(by_hand) < 1e-14);
        assert_eq!(map.preimages(Point::new(x, y)).unwrap().len(), 1);
    }
    assert!(map.respaced([1.0, 0.0], 1.0).is_none() && map.respaced([1.0; 2], -1.0).is_none());
    let off = map.along([Point::new(0.0, 1.0), Point::new(0.0, 10.0)]).unwrap_err();
    assert!(matches!(off, GeometryError::WrongSide { path, .. } if path == "Q0"));
}

#[test]
fn faults_of_monoids_are_named() {
    let p = points(&[(0.0, 2.0), (0.0, 3.0), (2.0, 4.0), (5.0, 2.0)]);
    let a = [3.0, 0.0, 1.0];
    assert!(matches!(Monoid::new(&p[..1], a, [p[0], p[0]]), Err(GeometryError::AnchorCount { .. })));
    assert!(matches!(Monoid::new(&p, [0.0, 2.0, 1.0], [p[0], p[3]]), Err(GeometryError::Coincident { .. })));
    let on_line = points(&[(0.0, 2.0), (1.5, 1.0), (2.0, 4.0), (5.0, 2.0)]);
    let e = Monoid::new(&on_line, a, [p[0], p[3]]).unwrap_err();
    assert!(matches!(e, GeometryError::WrongSide { which: 2, on: true, .. }), "{e}");
    assert!(Monoid::graph(&points(&[(0.0, 0.0), (0.0, 1.0), (1.0, 1.0)])).is_err());
}

/// Curves along the rows are smooth where the lines between all pieces meet in one point, and kink where they do not.
#[test]
fn spline_rows_kink_unless_all_lines_between_pieces_meet_in_one_point() {
    let left = points(&[(0.0, 0.0), (-20.0, 25.0), (15.0, 50.0), (-10.0, 80.0), (5.0, 95.0), (0.0, 130.0)]);
    let kink = |right: &[Point]| {
        let map = Birational::new(UNIT, Rows::LeftRight, [&left, right], Some(3), false, ["", ""]).unwrap();
        map.kink().unwrap().0
    };
    let a = Point::new(300.0, 60.0);
    assert!(kink(&left.iter().map(|p| p.lerp(a, 0.3)).collect::<Vec<_>>()) < 1e-6);
    assert!(kink(&left.iter().map(|p| *p + Vec2::new(90.0, 0.0)).collect::<Vec<_>>()) < 1e-6);
    let slipped: Vec<Point> = left.iter().map(|p| Point::new(p.x + 90.0, p.y * p.y / 130.0)).collect();
    assert!(kink(&slipped) > 1.0, "{}", kink(&slipped));
}
