//! Free-form deformation against its definition (de Casteljau's algorithm, de Boor's recursion), and the promises about its images and
//! borders.

use pathwarp::kurbo::{CubicBez, Line, ParamCurve, PathEl, Point, Rect, Shape, Vec2};
use pathwarp::map::{AffineMap, Class, Creases, Jet, Lattice, LatticeMap, Map, RationalBezier};
use pathwarp::refit::{Options, warp_path};
use pathwarp::{Outline, Seg};
use pathwarp_oracle::Random;

const REGION: Rect = Rect::new(20.0, 10.0, 120.0, 90.0);

/// Returns a lattice with all points moved by up to `by` (fraction of a cell), and weights between 1/w and w.
fn random(degree: [usize; 2], cells: [usize; 2], by: f64, w: f64, seed: u64) -> Lattice {
    let mut l = Lattice::regular(REGION, degree, cells);
    let mut r = Random::new(seed);
    let step = Vec2::new(REGION.width() / l.columns() as f64, REGION.height() / l.rows() as f64) * by;
    for j in 0..l.rows() {
        for i in 0..l.columns() {
            l.shift(i, j, Vec2::new(r.between(-1.0, 1.0) * step.x, r.between(-1.0, 1.0) * step.y));
            l.set_weight(i, j, w.powf(r.between(-1.0, 1.0)));
        }
    }
    l
}

fn casteljau(mut c: Vec<[f64; 3]>, t: f64) -> [f64; 3] {
    for n in (1..c.len()).rev() {
        for i in 0..n {
            c[i] = [0, 1, 2].map(|k| c[i][k] + t * (c[i + 1][k] - c[i][k]));
        }
    }
    c[0]
}

fn homogeneous(l: &Lattice, i: usize, j: usize) -> [f64; 3] {
    let (p, w) = (l.point(i, j), l.weight(i, j));
    [p.x * w, p.y * w, w]
}

fn by_definition(l: &Lattice, p: Point) -> Point {
    let (s, t) = ((p.x - REGION.x0) / REGION.width(), (p.y - REGION.y0) / REGION.height());
    let rows = (0..l.rows()).map(|j| casteljau((0..l.columns()).map(|i| homogeneous(l, i, j)).collect(), s));
    let [x, y, w] = casteljau(rows.collect(), t);
    Point::new(x / w, y / w)
}

fn grid(r: Rect, n: usize) -> impl Iterator<Item = Point> {
    let at = move |k: usize| (k as f64 + 0.31) / (n as f64 + 0.5);
    (0..=n).flat_map(move |i| (0..=n).map(move |j| Point::new(r.x0 + at(i) * r.width(), r.y0 + at(j) * r.height())))
}

#[test]
fn values_are_de_casteljaus_at_every_degree() {
    for m in 1..=10 {
        for n in 1..=10 {
            for w in [1.0, 3.0] {
                let l = random([m, n], [1, 1], 2.0, w, (m * 100 + n) as u64);
                let map = LatticeMap::new(&l, false);
                let ps: Vec<Point> = grid(REGION, 6).collect();
                let (mut points, mut jets) = (vec![Point::ORIGIN; ps.len()], vec![Jet::default(); ps.len()]);
                map.points(&ps, &mut points);
                map.jets(&ps, &mut jets);
                for ((p, q), j) in ps.iter().zip(points).zip(jets) {
                    assert!(
                        by_definition(&l, *p).distance(q) < 1e-11,
                        "{m}x{n} {w}: {:e}",
                        by_definition(&l, *p).distance(q)
                    );
                    assert!(j.p.distance(q) < 1e-11);
                }
            }
        }
    }
}

/// A line of constant s becomes the Bézier curve of the `H_j(s)`, exactly, as one cubic.
#[test]
fn iso_lines_are_exact() {
    for (m, n) in [(3, 3), (2, 3), (5, 3), (3, 2), (10, 3)] {
        let l = random([m, n], [1, 1], 1.0, 1.0, 5);
        let map = LatticeMap::new(&l, false);
        for s in [0.0, 0.25, 0.6, 1.0] {
            let x = REGION.x0 + s * REGION.width();
            let line = Seg::Line(Line::new((x, REGION.y0), (x, REGION.y1)));
            let source = Outline::from_points(&[line.start(), line.end()], false);
            let w = warp_path(&source, &map, &Options::new(1e-9)).unwrap();
            let h: Vec<Point> = (0..=n)
                .map(|j| {
                    let [x, y, w] = casteljau((0..=m).map(|i| homogeneous(&l, i, j)).collect(), s);
                    Point::new(x / w, y / w)
                })
                .collect();
            let expected = match h[..] {
                [a, b, c] => pathwarp::kurbo::QuadBez::new(a, b, c).raise(),
                [a, b, c, d] => CubicBez::new(a, b, c, d),
                _ => unreachable!(),
            };
            let [PathEl::MoveTo(p0), PathEl::CurveTo(p1, p2, p3)] = w.path.elements() else {
                panic!("{m}x{n} {s}: not one cubic: {:?}", w.path);
            };
            for (got, want) in [(p0, expected.p0), (p1, expected.p1), (p2, expected.p2), (p3, expected.p3)] {
                assert!(got.distance(want) < 1e-8, "{m}x{n} {s}: {got:?} {want:?}");
            }
            // The exact image gives the same curve.
            let exact = map.image(&RationalBezier::from_seg(&line).unwrap()).unwrap();
            assert_eq!(exact.degree(), (m + n).max(n));
            assert!(exact.eval(0.4).distance(expected.eval(0.4)) < 1e-11);
        }
    }
}

#[test]
fn exact_images_of_cubics_and_arcs() {
    let cubic = Seg::Cubic(CubicBez::new((30.0, 20.0), (100.0, 10.0), (110.0, 80.0), (40.0, 70.0)));
    let line = Seg::Line(Line::new((30.0, 30.0), (90.0, 30.0)));
    for (w, degree, seg) in [(1.0, 15, cubic), (2.0, 15, cubic), (1.0, 5, line), (2.0, 5, line)] {
        let l = random([3, 2], [1, 1], 1.0, w, 9);
        let map = LatticeMap::new(&l, false);
        let source = RationalBezier::from_seg(&seg).unwrap();
        let image = map.image(&source).unwrap();
        assert_eq!(image.degree(), degree);
        assert_eq!(image.is_polynomial(), w == 1.0);
        for i in 0..=20 {
            let t = f64::from(i) / 20.0;
            assert!(image.eval(t).distance(map.point(source.eval(t))) < 1e-11);
        }
    }
    // Across the border there is no exact image; wholly outside it is the curve itself.
    let map = LatticeMap::new(&random([3, 2], [1, 1], 1.0, 1.0, 9), false);
    let across = RationalBezier::polynomial(&[Point::new(0.0, 30.0), Point::new(60.0, 40.0)]);
    assert!(map.image(&across).is_none());
    let beyond = RationalBezier::polynomial(&[Point::new(0.0, 30.0), Point::new(10.0, 40.0)]);
    assert_eq!(map.image(&beyond), Some(beyond.clone()));
}

/// Everything outside stays, point by point and curve by curve; segments are split exactly at the border.
#[test]
fn nothing_moves_outside() {
    let mut l = Lattice::regular(REGION, [3, 3], [1, 1]);
    l.shift(1, 1, Vec2::new(15.0, 9.0));
    l.shift(2, 1, Vec2::new(-5.0, 12.0));
    let map = LatticeMap::new(&l, false);
    let art = Outline::from_svg("M0,0 C5,40 10,60 0,95 L15,5 M0,50 L140,50 M125,0 Q130,50 140,90").unwrap();
    let w = warp_path(&art, &map, &Options::new(1e-3)).unwrap();
    let segs: Vec<_> = w.path.segments().collect();
    let source = art.to_bez_path(0.0);
    let drawn: Vec<_> = source.segments().collect();
    let same = |a: pathwarp::kurbo::PathSeg, b: pathwarp::kurbo::PathSeg| {
        (0..=4).all(|i| a.eval(f64::from(i) / 4.0) == b.eval(f64::from(i) / 4.0))
    };
    assert!(same(segs[0], drawn[0]) && same(segs[1], drawn[1]));
    let last = segs[segs.len() - 1];
    assert!((0..=4).all(|i| last.eval(f64::from(i) / 4.0).distance(drawn[3].eval(f64::from(i) / 4.0)) < 1e-13));
    // The line through the region is straight to the border, curved inside, and straight again.
    let inner = &segs[2..segs.len() - 1];
    assert!(
        matches!(inner[0], pathwarp::kurbo::PathSeg::Line(s) if s.p1.distance((20.0, 50.0).into()) < 1e-9),
        "{:?}",
        inner[0]
    );
    assert!(
        matches!(inner[inner.len() - 1], pathwarp::kurbo::PathSeg::Line(s) if s.p0.distance((120.0, 50.0).into()) < 1e-9)
    );
    assert!(inner.len() == 3);
    // A line that passes above the region is not split, though it crosses the prolonged lines of the border.
    let mut creases = Creases::default();
    map.creases(&mut creases);
    assert!(creases.splits(&Seg::Line(Line::new((0.0, 5.0), (140.0, 5.0)))).is_empty());
    assert_eq!(creases.splits(&Seg::Line(Line::new((0.0, 15.0), (140.0, 15.0)))).len(), 2);
}

/// With k + 1 rows frozen, the first k derivatives agree across the border and the next does not, by one-sided difference quotients of
/// order k and k + 1 on both sides.
#[test]
fn frozen_rows_make_smooth_joints() {
    let degree = 5;
    for frozen in 1..=3 {
        for w in [1.0, 2.0] {
            let mut l = random([degree, degree], [1, 1], 1.0, w, 3);
            for j in 0..l.rows() {
                for i in 0..frozen {
                    l.place(i, j, l.regular_point(i, j));
                    l.set_weight(i, j, 1.0);
                }
            }
            let map = LatticeMap::new(&l, false);
            // F(p) − p inside, in powers of the distance d to the border. The order is that of the first power that does not vanish.
            let at = |d: f64| {
                let p = Point::new(REGION.x0 + d, 47.0);
                (map.point(p) - p).hypot()
            };
            let order = (at(2e-2) / at(1e-2)).log2();
            assert!((order - frozen as f64).abs() < 0.02, "{frozen} frozen: the displacement grows with power {order}");
            assert_eq!(at(-1e-3), 0.0);
        }
    }
}

#[test]
fn a_torn_border_is_drawn_on_by_a_line() {
    let mut l = Lattice::regular(REGION, [1, 1], [1, 1]);
    l.shift(0, 0, Vec2::new(10.0, 7.0));
    l.shift(0, 1, Vec2::new(10.0, 7.0));
    let map = LatticeMap::new(&l, false);
    let w = warp_path(&Outline::from_svg("M0,50 L140,50").unwrap(), &map, &Options::new(1e-3)).unwrap();
    let points: Vec<Point> = w.path.elements().iter().filter_map(PathEl::end_point).collect();
    let near = |p: Point, q: (f64, f64)| p.distance(q.into()) < 1e-8;
    assert!(
        near(points[1], (20.0, 50.0)) && near(points[2], (30.0, 57.0)) || near(points[1], (20.0, 50.0)),
        "{points:?}"
    );
    assert!(points.iter().any(|p| near(*p, (30.0, 57.0))) && points.iter().any(|p| near(*p, (20.0, 50.0))));
    assert!(near(points[points.len() - 1], (140.0, 50.0)) && w.report.unresolved.is_empty());
    assert!(w.report.segments_out <= 6, "{:?}", w.path);
}

#[test]
fn spline_lattices_follow_their_definition_and_join_smoothly() {
    for (degree, cells) in [([3, 2], [4, 3]), ([1, 4], [2, 2]), ([2, 2], [5, 1])] {
        for w in [1.0, 2.0] {
            let l = random(degree, cells, 1.5, w, 11);
            let map = LatticeMap::new(&l, true);
            for p in grid(REGION, 12) {
                // The influences are computed independently, by basis functions instead of patches.
                let by_influence =
                    l.influence(p).into_iter().fold(Vec2::ZERO, |sum, ((i, j), r)| sum + l.point(i, j).to_vec2() * r);
                assert!(map.point(p).distance(by_influence.to_point()) < 1e-11);
            }
            for k in 1..cells[0] {
                let x = REGION.x0 + REGION.width() * k as f64 / cells[0] as f64;
                let (a, b) = (map.jet(Point::new(x - 1e-7, 40.0)), map.jet(Point::new(x + 1e-7, 40.0)));
                assert!(a.p.distance(b.p) < 1e-5);
                if degree[0] > 1 {
                    assert!((a.dx - b.dx).hypot() < 1e-5 && (a.dy - b.dy).hypot() < 1e-5);
                }
            }
        }
    }
    let l = random([3, 3], [3, 3], 0.5, 1.0, 1);
    let art = Outline::from_svg("M0,0 L140,100 M30,80 A40,30 0 1 1 110,80").unwrap();
    let map = LatticeMap::new(&l, true);
    let w = warp_path(&art, &map, &Options::new(1e-3)).unwrap();
    assert!(pathwarp_oracle::distance(&art, &map, &w.path, 50, 1e-3) < 1e-3 + 1e-9);
}

#[test]
fn what_is_affine_says_so() {
    let identity = Lattice::regular(REGION, [4, 3], [2, 1]);
    for extended in [false, true] {
        assert_eq!(LatticeMap::new(&identity, extended).class(), Class::Affine(pathwarp::kurbo::Affine::IDENTITY));
    }
    let mut moved = identity.clone();
    for j in 0..moved.rows() {
        for i in 0..moved.columns() {
            let p = moved.regular_point(i, j);
            moved.place(i, j, Point::new(3.0 + 2.0 * p.x - 0.5 * p.y, 0.1 * p.x + 0.7 * p.y));
        }
    }
    let Class::Affine(m) = LatticeMap::new(&moved, true).class() else { panic!("not affine") };
    assert!((m * Point::new(5.0, -7.0)).distance(Point::new(16.5, -4.4)) < 1e-11);
    assert_eq!(LatticeMap::new(&moved, false).class(), Class::Smooth);
}

#[test]
fn the_inverse_undoes_and_says_where_it_cannot() {
    for (degree, cells, w) in
        [([3, 3], [1, 1], 1.0), ([4, 2], [1, 1], 2.0), ([2, 3], [3, 2], 1.0), ([3, 3], [4, 4], 1.5)]
    {
        let mut l = random(degree, cells, 0.5, w, 21);
        let (m, n) = (l.columns() - 1, l.rows() - 1);
        for j in 0..=n {
            for i in 0..=m {
                if i == 0 || j == 0 || i == m || j == n {
                    l.place(i, j, l.regular_point(i, j));
                    l.set_weight(i, j, 1.0);
                }
            }
        }
        let map = LatticeMap::new(&l, false);
        let back = map.inverse().unwrap();
        for p in grid(REGION.inflate(15.0, 15.0), 20) {
            let q = back.point(map.point(p));
            assert!(q.distance(p) < 1e-11, "{degree:?} {cells:?} {p:?} {q:?}");
        }
        // The drawing is mapped there and back, within the tolerance each way.
        let art = Outline::from_svg("M10,50 L130,55 M70,50 m-20,0 a20,20 0 1 0 40,0 a20,20 0 1 0 -40,0").unwrap();
        let there = warp_path(&art, &map, &Options::new(1e-4)).unwrap();
        let again = warp_path(&Outline::from(&there.path), &*back, &Options::new(1e-4)).unwrap();
        let worst = pathwarp_oracle::distance(&art, &AffineMap::IDENTITY, &again.path, 20, 1e-3);
        assert!(worst < 1e-3, "{degree:?} {cells:?} {worst}");
        assert!(again.path.bounding_box().is_finite());
    }
    // Outside of the surroundings that an extended region covers, there is no answer.
    let map = LatticeMap::new(&random([3, 3], [1, 1], 0.3, 1.0, 2), true);
    let back = map.inverse().unwrap();
    assert!(back.point(Point::new(1e6, 0.0)).is_nan());
    for p in grid(REGION, 20) {
        assert!(back.point(map.point(p)).distance(p) < 1e-11);
    }
}

/// Beyond its region an extended lattice may fold back over itself; the preimage in the region then takes precedence.
#[test]
fn the_region_goes_before_its_surroundings() {
    let region = Rect::new(20.0, 20.0, 220.0, 220.0);
    let mut l = Lattice::regular(region, [3, 2], [1, 1]);
    l.shift(1, 1, Vec2::new(9.0, 12.0));
    l.set_weight(1, 1, 2.0);
    let map = LatticeMap::new(&l, true);
    let back = map.inverse().unwrap();
    for i in 0..=40 {
        for j in 0..=40 {
            let p = Point::new(20.0 + 5.0 * f64::from(i), 20.0 + 5.0 * f64::from(j));
            assert!(back.point(map.point(p)).distance(p) < 1e-10, "{p:?}");
        }
    }
}

#[test]
fn denominators_that_vanish_are_edges() {
    let mut l = Lattice::regular(REGION, [2, 2], [1, 1]);
    l.set_weight(1, 1, -6.0);
    let map = LatticeMap::new(&l, false);
    let mut creases = Creases::default();
    map.creases(&mut creases);
    assert!(!creases.defined_at(REGION.center()) && creases.defined_at(Point::new(21.0, 11.0)));
    assert!(creases.defined_at(Point::ORIGIN), "outside nothing happens");
    let through = Outline::from_svg("M0,50 L140,50").unwrap();
    assert!(warp_path(&through, &map, &Options::new(1e-3)).is_err());
}
