//! An independent oracle: formulas written from their definitions, with plain arrays. Maps must agree with them up to a relative error of
//! 1e-9, inverses must lead back, and rays must stay rays and planes planes, up to 1e-12.

use pathwarp::param::Args;
use pathwarp_solid::deform::Registry3;
use pathwarp_solid::glam::DVec3;
use pathwarp_solid::map::{Map3, NewtonInverse3};
use pathwarp_solid::{Box3, Frame3};
use std::sync::Arc;

type P = [f64; 3];

const BOX: [P; 2] = [[-10.0, 5.0, 20.0], [50.0, 45.0, 90.0]];

fn build(name: &str, pairs: &[(&str, &str)]) -> Arc<dyn Map3> {
    let [a, b] = BOX.map(DVec3::from_array);
    let frame = Frame3::new(Box3::new(a, b));
    let entry = Registry3::builtin();
    entry.get(name).unwrap().build_from(&Args::from_pairs(pairs), &frame).unwrap().map
}

/// Returns points all over the box.
fn points() -> Vec<P> {
    let mut random = pathwarp_oracle::Random::new(12345);
    (0..400).map(|_| std::array::from_fn(|a| random.between(BOX[0][a], BOX[1][a]))).collect()
}

/// Compares a map, for single points and batches, with a formula, and checks that its inverse leads back.
fn compare(map: &Arc<dyn Map3>, truth: impl Fn(P) -> P) {
    let ps = points();
    let mut batch: Vec<DVec3> = ps.iter().copied().map(DVec3::from_array).collect();
    map.points(&mut batch);
    let [a, b] = BOX.map(DVec3::from_array);
    let frame = Box3::new(a, b);
    let newton = || Arc::new(NewtonInverse3::new(Arc::clone(map), frame, 1.0, [4; 3])) as Arc<dyn Map3>;
    let back = map.inverse().unwrap_or_else(newton);
    for (p, q) in ps.iter().zip(&batch) {
        let want = DVec3::from_array(truth(*p));
        let p = DVec3::from_array(*p);
        let size = want.length() + 1.0;
        for got in [*q, map.point(p), map.jet(p).p] {
            assert!(got.distance(want) <= 1e-9 * size, "{p}: {got}, not {want}");
            // The documented bound is 1e-9; the actual error is only rounding.
            assert!(got.distance(want) <= 1e-12 * size, "{p}: off by {:e}", got.distance(want));
        }
        let returned = back.point(want);
        assert!(returned.distance(p) <= 1e-9 * (p.length() + 1.0), "{p} comes back as {returned}");
        // Compare the Jacobian with difference quotients of the formula.
        const H: f64 = 1e-4;
        for (axis, e) in DVec3::AXES.into_iter().enumerate() {
            let at = |h: f64| DVec3::from_array(truth((p + e * h).to_array()));
            let slope = (at(H) - at(-H)) / (2.0 * H);
            assert!(slope.distance(map.jet(p).d.col(axis)) <= 1e-6 * (1.0 + slope.length()), "{p} {axis}");
        }
    }
}

fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |b, i| b * (n - i) as f64 / (i + 1) as f64)
}

fn bernstein(n: usize, i: usize, t: f64) -> f64 {
    binomial(n, i) * t.powi(i as i32) * (1.0 - t).powi((n - i) as i32)
}

/// Returns a B-spline on uniform clamped knots, by the recursion of Cox and de Boor.
fn b_spline(degree: usize, cells: usize, i: usize, x: f64) -> f64 {
    let knot = |k: usize| (k.clamp(degree, degree + cells) - degree) as f64 / cells as f64;
    fn basis(knot: &dyn Fn(usize) -> f64, i: usize, d: usize, x: f64) -> f64 {
        if d == 0 {
            return f64::from(u8::from(knot(i) <= x && x < knot(i + 1)));
        }
        let part = |num: f64, den: f64, b: f64| if den > 0.0 { num / den * b } else { 0.0 };
        part(x - knot(i), knot(i + d) - knot(i), basis(knot, i, d - 1, x))
            + part(knot(i + d + 1) - x, knot(i + d + 1) - knot(i + 1), basis(knot, i + 1, d - 1, x))
    }
    basis(&knot, i, degree, x)
}

/// Returns Σ N·w·P / Σ N·w over a lattice in which these points and weights are changed.
fn lattice(
    p: P,
    counts: [usize; 3],
    basis: impl Fn(usize, usize, f64) -> f64,
    regular: impl Fn(usize, usize) -> f64,
    changed: &[([usize; 3], P, f64)],
) -> P {
    let t: P = std::array::from_fn(|a| (p[a] - BOX[0][a]) / (BOX[1][a] - BOX[0][a]));
    let (mut sum, mut weights) = ([0.0; 3], 0.0);
    for i in 0..counts[0] {
        for j in 0..counts[1] {
            for k in 0..counts[2] {
                let node = [i, j, k];
                let change = changed.iter().find(|c| c.0 == node);
                let w = change.map_or(1.0, |c| c.2);
                let influence = w * (0..3).map(|a| basis(a, node[a], t[a])).product::<f64>();
                for a in 0..3 {
                    let at = BOX[0][a] + regular(a, node[a]) * (BOX[1][a] - BOX[0][a]);
                    sum[a] += influence * (at + change.map_or(0.0, |c| c.1[a]));
                }
                weights += influence;
            }
        }
    }
    sum.map(|v| v / weights)
}

#[test]
fn polynomial_and_rational_lattices() {
    let degree = [3, 2, 4];
    for weight in [1.0, 3.5] {
        let changed = [
            ([1, 2, 0], [5.0, -3.0, 2.0], 1.0),
            ([2, 1, 3], [-4.0, 1.0, 6.0], weight),
            ([3, 0, 4], [1.0, 2.0, 3.0], 1.0),
        ];
        let map = build(
            "ffd",
            &[
                ("degree", "3x2x4"),
                ("move", "1,2,0:5,-3,2 2,1,3:-4,1,6 3,0,4:1,2,3"),
                ("weight", &format!("2,1,3:{weight}")),
            ],
        );
        compare(&map, |p| {
            lattice(
                p,
                degree.map(|d| d + 1),
                |a, i, t| bernstein(degree[a], i, t),
                |a, i| i as f64 / degree[a] as f64,
                &changed,
            )
        });
    }
}

#[test]
fn spline_lattices() {
    let (degree, cells) = ([2, 3, 1], [3, 2, 2]);
    let counts = [0, 1, 2].map(|a| degree[a] + cells[a]);
    let greville = |a: usize, i: usize| {
        let knot = |k: usize| (k.clamp(degree[a], degree[a] + cells[a]) - degree[a]) as f64 / cells[a] as f64;
        (i + 1..=i + degree[a]).map(knot).sum::<f64>() / degree[a] as f64
    };
    let changed = [([2, 2, 1], [3.0, -2.0, 1.5], 2.0), ([1, 3, 2], [-1.0, 2.0, 1.0], 1.0)];
    let map = build(
        "ffd",
        &[("degree", "2x3x1"), ("cells", "3x2x2"), ("move", "2,2,1:3,-2,1.5 1,3,2:-1,2,1"), ("weight", "2,2,1:2")],
    );
    let inverse = map.inverse().unwrap();
    // The Jacobian jumps at joints of degree 1 along z, so compare values only.
    for p in points() {
        let want = lattice(p, counts, |a, i, t| b_spline(degree[a], cells[a], i, t), greville, &changed);
        let (got, want) = (map.point(DVec3::from_array(p)), DVec3::from_array(want));
        assert!(got.distance(want) < 1e-12 * (1.0 + want.length()), "{p:?}: {got} {want}");
        let back = inverse.point(want);
        assert!(back.distance(DVec3::from_array(p)) < 1e-9 * 100.0, "{p:?} {back}");
    }
}

fn det(m: [P; 3]) -> f64 {
    m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
        + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
}

fn minus(a: P, b: P) -> P {
    std::array::from_fn(|k| a[k] - b[k])
}

/// Returns barycentric coordinates as ratios of volumes.
fn barycentric(p: P, t: [P; 4]) -> [f64; 4] {
    let volume = |t: [P; 4]| det([minus(t[1], t[0]), minus(t[2], t[0]), minus(t[3], t[0])]);
    std::array::from_fn(|i| {
        let mut s = t;
        s[i] = p;
        volume(s) / volume(t)
    })
}

fn radial(eye: P, p: P, delta: f64) -> P {
    std::array::from_fn(|k| eye[k] + (p[k] - eye[k]) / delta)
}

const EYE: P = [20.0, 30.0, 300.0];
const CORNERS: [P; 4] = [[-20.0, 0.0, 20.0], [70.0, 0.0, 20.0], [0.0, 90.0, 20.0], [20.0, 20.0, 110.0]];
const TETRAHEDRON: &str = "-20,0,20 70,0,20 0,90,20 20,20,110";

#[test]
fn tetrahedra_of_degree_one_and_two() {
    let map =
        build("anamorph", &[("eye", "20,30,300"), ("reference", TETRAHEDRON), ("push", "0,0,0,1:1.25 0,1,0,0:0.8")]);
    compare(&map, |p| {
        let u = barycentric(p, CORNERS);
        radial(EYE, p, u[0] + u[1] / 0.8 + u[2] + u[3] / 1.25)
    });
    assert!(map.collineation().is_some());
    let map = build(
        "anamorph",
        &[
            ("eye", "20,30,300"),
            ("reference", TETRAHEDRON),
            ("degree", "2"),
            ("push", "0,1,0,1:1.25 2,0,0,0:0.9 1,1,0,0:1.1"),
        ],
    );
    compare(&map, |p| {
        // De Casteljau's algorithm: one affine combination, of values at the ends and middles of the six edges, and again of the results.
        let u = barycentric(p, CORNERS);
        let delta = |i: usize, j: usize| match (i.min(j), i.max(j)) {
            (1, 3) => 1.0 / 1.25,
            (0, 0) => 1.0 / 0.9,
            (0, 1) => 1.0 / 1.1,
            _ => 1.0,
        };
        let first: [f64; 4] = std::array::from_fn(|i| (0..4).map(|j| u[j] * delta(i, j)).sum());
        radial(EYE, p, (0..4).map(|i| u[i] * first[i]).sum())
    });
}

#[test]
fn cuboids_and_sheets() {
    let map = build("anamorph", &[("eye", "20,30,300"), ("degree", "3x1x2"), ("push", "1,1,1:1.2 3,0,2:0.7")]);
    compare(&map, |p| {
        let t: P = std::array::from_fn(|a| (p[a] - BOX[0][a]) / (BOX[1][a] - BOX[0][a]));
        let b = |i, j, k| bernstein(3, i, t[0]) * bernstein(1, j, t[1]) * bernstein(2, k, t[2]);
        radial(EYE, p, 1.0 + (1.0 / 1.2 - 1.0) * b(1, 1, 1) + (1.0 / 0.7 - 1.0) * b(3, 0, 2))
    });
    // A rectangle in the plane z = 10. Rays carry points to it.
    let map = build(
        "anamorph",
        &[("eye", "20,30,300"), ("reference", "-20,0,10 60,50,10"), ("degree", "2x1x1"), ("push", "1,1,0:1.5")],
    );
    let on_plane = |p: P| {
        let t = (10.0 - EYE[2]) / (p[2] - EYE[2]);
        [EYE[0] + t * (p[0] - EYE[0]), EYE[1] + t * (p[1] - EYE[1])]
    };
    compare(&map, |p| {
        let [x, y] = on_plane(p);
        radial(EYE, p, 1.0 + (1.0 / 1.5 - 1.0) * bernstein(2, 1, (x + 20.0) / 80.0) * bernstein(1, 1, y / 50.0))
    });
    // A triangle in the same plane, of degree 2.
    let map = build(
        "anamorph",
        &[("eye", "20,30,300"), ("reference", "-20,0,10 60,0,10 0,80,10"), ("degree", "2"), ("push", "1,0,1:1.5")],
    );
    compare(&map, |p| {
        let [x, y] = on_plane(p);
        let area =
            |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let [a, b, c] = [[-20.0, 0.0], [60.0, 0.0], [0.0, 80.0]];
        let u = [area([x, y], b, c), area(a, [x, y], c), area(a, b, [x, y])].map(|v| v / area(a, b, c));
        radial(EYE, p, 1.0 + (1.0 / 1.5 - 1.0) * 2.0 * u[0] * u[2])
    });
}

/// Every image lies on its ray, and a collineation maps planes to planes, up to 1e-12.
#[test]
fn rays_and_planes() {
    let eye = DVec3::from_array(EYE);
    let maps = [
        build("anamorph", &[("eye", "20,30,300"), ("reference", TETRAHEDRON), ("push", "0,0,0,1:1.25")]),
        build("anamorph", &[("eye", "20,30,300"), ("degree", "3"), ("push", "1,1,1:1.25 2,2,2:0.8")]),
        build("anamorph", &[("eye", "20,30,300"), ("reference", "-20,0,10 60,0,10 0,80,10"), ("push", "1,0,0:1.5")]),
    ];
    for map in &maps {
        for p in points().into_iter().map(DVec3::from_array) {
            let q = map.point(p);
            assert!((q - eye).normalize().cross((p - eye).normalize()).length() < 1e-12);
        }
    }
    for p in points().chunks(4) {
        let [a, b, c] = [0, 1, 2].map(|i| DVec3::from_array(p[i]));
        let inner = a * 0.2 + b * 0.5 + c * 0.3;
        let [a, b, c, d] = [a, b, c, inner].map(|p| maps[0].point(p));
        assert!((d - a).dot((b - a).cross(c - a).normalize()).abs() < 1e-12 * 300.0);
    }
}

/// Returns a point by the generalised algorithm of de Casteljau, in which every level is an affine map of space with its handles.
fn casteljau(points: &[P], handles: impl Fn(usize, usize) -> [P; 2], u: f64, v: f64, w: f64) -> P {
    let mut row = points.to_vec();
    for level in 1..points.len() {
        for i in 0..points.len() - level {
            let [s, t] = handles(level, i);
            row[i] = std::array::from_fn(|k| row[i][k] + u * (row[i + 1][k] - row[i][k]) + v * s[k] + w * t[k]);
        }
    }
    row[0]
}

#[test]
fn skeletons_with_handles_on_every_level() {
    let map = build(
        "bend",
        &[
            ("along", "z"),
            ("skeleton", "20,25,0 22,25,30 30,28,60 40,30,100"),
            ("side", "0:1,0,0 1:1,0.1,0 2:0.9,0,-0.3"),
            ("up", "0:0,1,0 1:0,1,0.1 2:0,1.2,0"),
            ("shear", "2,0:0.1,0,0:0,0.05,0 2,1:0,0.02,0:0,0,0.1 3,0:0.02,0.03,0:0,0,0"),
        ],
    );
    let handles = |level: usize, i: usize| match (level, i) {
        (1, 0) => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        (1, 1) => [[1.0, 0.1, 0.0], [0.0, 1.0, 0.1]],
        (1, 2) => [[0.9, 0.0, -0.3], [0.0, 1.2, 0.0]],
        (2, 0) => [[0.1, 0.0, 0.0], [0.0, 0.05, 0.0]],
        (2, 1) => [[0.0, 0.02, 0.0], [0.0, 0.0, 0.1]],
        _ => [[0.02, 0.03, 0.0], [0.0; 3]],
    };
    let polygon = [[20.0, 25.0, 0.0], [22.0, 25.0, 30.0], [30.0, 28.0, 60.0], [40.0, 30.0, 100.0]];
    // The axis after z is x.
    compare(&map, |p| casteljau(&polygon, handles, (p[2] - 20.0) / 70.0, p[0] - 20.0, p[1] - 25.0));
}

fn joined(points: &[P]) -> String {
    points.iter().map(|p| format!("{},{},{}", p[0], p[1], p[2])).collect::<Vec<_>>().join(" ")
}

const SKELETON: [P; 7] = [
    [-10.0, 25.0, 55.0],
    [0.0, 30.0, 60.0],
    [12.0, 20.0, 58.0],
    [20.0, 26.0, 48.0],
    [35.0, 22.0, 52.0],
    [42.0, 27.0, 60.0],
    [55.0, 25.0, 57.0],
];

/// Points and handles of a B-spline of any degree are blended by the same basis functions.
#[test]
fn splines_with_handles_at_their_points() {
    let side = |i: usize| [0.05 * i as f64, 1.0 + 0.03 * i as f64, 0.02 * (i * i) as f64 - 0.1];
    let up = |i: usize| [-0.02 * i as f64, 0.1, 0.9 + 0.02 * i as f64];
    let text =
        |f: &dyn Fn(usize) -> P| (0..7).map(|i| format!("{i}:{}", joined(&[f(i)]))).collect::<Vec<_>>().join(" ");
    for degree in 2..=6 {
        let [skeleton, side_text, up_text, number] = [joined(&SKELETON), text(&side), text(&up), degree.to_string()];
        let map = build(
            "bend",
            &[("skeleton", &skeleton), ("spline", "true"), ("degree", &number), ("side", &side_text), ("up", &up_text)],
        );
        let cells = 7 - degree;
        for p in points() {
            let (u, v, w) = ((p[0] + 10.0) / 60.0, p[1] - 25.0, p[2] - 55.0);
            let want: P = std::array::from_fn(|k| {
                (0..7).map(|i| b_spline(degree, cells, i, u) * (SKELETON[i][k] + v * side(i)[k] + w * up(i)[k])).sum()
            });
            assert!(map.point(DVec3::from_array(p)).distance(DVec3::from_array(want)) < 1e-11, "{degree} {p:?}");
        }
    }
}

/// At every joint, lines beside a skeleton with default handles have one derivative (equation 4), and one direction where the skeleton
/// is drawn in pieces whose polygon is straight there (equation 5).
#[test]
fn default_handles_leave_no_kinks() {
    let zigzag: Vec<P> =
        (0..9).map(|i| [10.0 * f64::from(i), 40.0 * f64::from(i % 2), 25.0 * f64::from(i % 3)]).collect();
    let drawn = "0,0,0 10,20,5 20,20,10 30,0,10 35,-10,10 50,-9,20 50,0,30 50,18,50 40,20,40 30,5,60";
    let distances: Vec<f64> = zigzag.windows(2).map(|p| norm(minus(p[1], p[0])).sqrt()).collect();
    let whole: f64 = distances.iter().sum();
    let uniform = |n: usize| (1..n).map(|i| i as f64 / n as f64).collect::<Vec<f64>>();
    let centripetal: Vec<f64> = (1..8).map(|i| distances[..i].iter().sum::<f64>() / whole).collect();
    let text = joined(&zigzag);
    for (pairs, joints, even) in [
        (&[("skeleton", &*text), ("spline", "true"), ("degree", "2")][..], uniform(7), true),
        (&[("skeleton", &text), ("spline", "true")], uniform(6), true),
        (&[("skeleton", &text), ("spline", "true"), ("degree", "5")], uniform(4), true),
        (&[("skeleton", &text), ("interpolate", "true")], centripetal, true),
        (&[("skeleton", drawn)], uniform(3), false),
    ] {
        let map = build("bend", pairs);
        for u in joints {
            for (y, z) in [(25.0, 55.0), (25.5, 55.2), (24.0, 56.0), (26.0, 54.0)] {
                let at = |e: f64| map.jet(DVec3::new(-10.0 + 60.0 * u + e, y, z)).d.col(0);
                let (a, b) = (at(-1e-11), at(1e-11));
                let off = if even { (a - b).length() / a.length() } else { (a.normalize() - b.normalize()).length() };
                assert!(off < 1e-9, "{pairs:?} {u} {y} {z}: {a} {b}");
            }
        }
    }
}

fn norm(v: P) -> f64 {
    v.iter().map(|c| c * c).sum::<f64>().sqrt()
}

/// Warns of handles that make kinks, and refuses bad ones by name.
#[test]
fn kinks_are_named_in_space() {
    let [a, b] = BOX.map(DVec3::from_array);
    let frame = Frame3::new(Box3::new(a, b));
    let built =
        |pairs: &[(&str, &str)]| Registry3::builtin().get("bend").unwrap().build_from(&Args::from_pairs(pairs), &frame);
    let straight = ("skeleton", "0,0,0 10,0,0 20,0,0 30,0,0 40,0,0 50,0,0 60,0,0");
    let warned = built(&[straight, ("side", "3:0,1,0 4:0,1,0.5")]).unwrap().warnings.join("");
    assert!(warned.contains("kinks at 1 of 1 joints") && warned.contains("30.0"), "{warned}");
    assert!(built(&[straight]).unwrap().warnings.is_empty());
    for (more, problem) in [
        (&[("side", "0:0,0,0")][..], "has no length"),
        (&[("side", "2:0,1,0 3:0,2,0")], "would tear"),
        (&[("spline", "true"), ("up", "7:0,0,1")], "0 to 6"),
        (&[("spline", "true"), ("shear", "2,0:0,0,1:0,0,1")], "no deeper level"),
        (&[("spline", "true"), ("degree", "11")], "10"),
        (&[("spline", "true"), ("interpolate", "true")], "cannot go with `interpolate`"),
        (&[("preset", "swell")], "has its own skeleton"),
    ] {
        let refused = built(&[&[straight], more].concat()).err().unwrap().to_string();
        assert!(refused.contains(problem), "{refused}");
    }
    let twice = built(&[("skeleton", "0,0,0 1,1,1 1,1,1 2,0,0"), ("interpolate", "true")]).err().unwrap().to_string();
    assert!(twice.contains("two equal points, 1 and 2"), "{twice}");
}

/// Compares a stretch and a swell with their definitions.
#[test]
fn stretch_and_swell() {
    compare(&build("bend", &[("preset", "stretch"), ("along", "y"), ("factor", "1.7")]), |p| {
        [p[0], 5.0 + 1.7 * (p[1] - 5.0), p[2]]
    });
    compare(&build("bend", &[("preset", "swell"), ("along", "z"), ("factor", "1.4")]), |p| {
        let u = (p[2] - 20.0) / 70.0;
        let k = 1.0 + 4.0 * 0.4 * u * (1.0 - u);
        [20.0 + k * (p[0] - 20.0), 25.0 + k * (p[1] - 25.0), p[2]]
    });
}

/// Compares Barr's deformations with their closed forms.
#[test]
fn barr() {
    let turned = |x: f64, y: f64, a: f64| [x * a.cos() - y * a.sin(), x * a.sin() + y * a.cos()];
    compare(&build("bend", &[("preset", "twist"), ("along", "z"), ("angle", "75")]), |p| {
        let [x, y] = turned(p[0] - 20.0, p[1] - 25.0, 75f64.to_radians() * (p[2] - 20.0) / 70.0);
        [20.0 + x, 25.0 + y, p[2]]
    });
    compare(&build("bend", &[("preset", "taper"), ("along", "z"), ("factor", "0.3")]), |p| {
        let r = 1.0 - 0.7 * (p[2] - 20.0) / 70.0;
        [20.0 + r * (p[0] - 20.0), 25.0 + r * (p[1] - 25.0), p[2]]
    });
    compare(&build("bend", &[("preset", "bend"), ("along", "x"), ("angle", "40")]), |p| {
        // About the centre of curvature, at the distance 60/angle from the middle line.
        let angle = 40f64.to_radians();
        let (radius, theta) = (60.0 / angle, angle * (p[0] + 10.0) / 60.0);
        let r = radius - (p[1] - 25.0);
        [-10.0 + r * theta.sin(), 25.0 + radius - r * theta.cos(), p[2]]
    });
}

/// Checks a cone of radius 90 at the bottom and 110 at the top, whose side is 40 long: the distance and height of a point on the side, and
/// of a step away from it.
#[test]
fn cones_and_cylinders() {
    for (pairs, [bottom, top]) in
        [(&[("radius", "100")][..], [100.0, 100.0]), (&[("radius", "90"), ("top-radius", "110")], [90.0, 110.0])]
    {
        compare(&build("wrap", pairs), |p| {
            let sine: f64 = (top - bottom) / 40.0;
            let cosine = (1.0 - sine * sine).sqrt();
            let (along, out) = (p[1] - 25.0, p[2] - 20.0);
            let theta = (p[0] - 20.0) / 100.0;
            let rho = 100.0 + along * sine + out * cosine;
            [20.0 + rho * theta.sin(), 25.0 + along * cosine - out * sine, 20.0 - 100.0 + rho * theta.cos()]
        });
    }
}

/// For one pin, the smallest of all changes that satisfy it is d·Bᵢ(p)/ΣBⱼ(p)²; frozen layers do not change.
#[test]
fn pins_are_reached_with_the_smallest_change() {
    let (pin, d) = ([14.0, 29.0, 41.0], [6.0, -5.0, 8.0]);
    let t: P = std::array::from_fn(|a| (pin[a] - BOX[0][a]) / (BOX[1][a] - BOX[0][a]));
    for frozen in [0, 1] {
        let nodes = (frozen..3).flat_map(|i| (0..3).flat_map(move |j| (0..3).map(move |k| [i, j, k])));
        let influence: Vec<([usize; 3], f64)> =
            nodes.map(|n| (n, (0..3).map(|a| bernstein(2, n[a], t[a])).product())).collect();
        let square: f64 = influence.iter().map(|(_, b)| b * b).sum();
        let changed: Vec<_> = influence.iter().map(|(n, b)| (*n, d.map(|v| v * b / square), 1.0)).collect();
        let freeze = format!("left:{frozen}");
        let mut pairs = vec![("degree", "2"), ("pin", "14,29,41:20,24,49")];
        if frozen > 0 {
            pairs.push(("freeze", &freeze));
        }
        let map = build("ffd", &pairs);
        assert!(map.point(DVec3::from_array(pin)).distance(DVec3::new(20.0, 24.0, 49.0)) < 1e-12);
        for p in points() {
            let want = lattice(p, [3; 3], |_, i, t| bernstein(2, i, t), |_, i| i as f64 / 2.0, &changed);
            let (got, want) = (map.point(DVec3::from_array(p)), DVec3::from_array(want));
            assert!(got.distance(want) <= 1e-9 * (1.0 + want.length()), "{p:?}: {got}, not {want}");
        }
    }
}

/// The paper's δ₃ = 1 + (δ − 1)/u₃ takes a point to its image. Outside of the tetrahedron and on the held face nothing moves.
#[test]
fn a_prescribed_point_of_a_local_tetrahedron() {
    let at = [22.0, 27.0, 60.0];
    let u = barycentric(at, CORNERS);
    let last = 1.0 + (1.0 / 1.3 - 1.0) / u[3];
    let map = build(
        "anamorph",
        &[("eye", "20,30,300"), ("reference", TETRAHEDRON), ("local", "true"), ("point", "22,27,60:1.3")],
    );
    let goal: P = std::array::from_fn(|k| EYE[k] + 1.3 * (at[k] - EYE[k]));
    assert!(map.point(DVec3::from_array(at)).distance(DVec3::from_array(goal)) < 1e-9);
    let (mut inside, mut outside) = (0, 0);
    for p in points() {
        let u = barycentric(p, CORNERS);
        let moved = u.iter().all(|v| *v >= 0.0);
        let want = if moved { radial(EYE, p, 1.0 + (last - 1.0) * u[3]) } else { p };
        (inside, outside) = (inside + i32::from(moved), outside + i32::from(!moved));
        let got = map.point(DVec3::from_array(p));
        assert!(got.distance(DVec3::from_array(want)) <= 1e-9 * (1.0 + got.length()), "{p:?}: {got}, not {want:?}");
        let back = map.inverse().unwrap().point(got);
        // Images of points inside may cover points that stay, so either may be the source.
        assert!(map.point(back).distance(got) <= 1e-9 * (1.0 + got.length()), "{p:?} comes back as {back}");
    }
    assert!(inside > 20 && outside > 20);
    // A point on the held face.
    let face: P = std::array::from_fn(|k| 0.2 * CORNERS[0][k] + 0.3 * CORNERS[1][k] + 0.5 * CORNERS[2][k]);
    assert!(map.point(DVec3::from_array(face)).distance(DVec3::from_array(face)) < 1e-12);
}

/// Returns the direction 0.3, 0.2, 1 of an eye at infinity.
fn towards() -> P {
    let n = (0.09_f64 + 0.04 + 1.0).sqrt();
    [0.3 / n, 0.2 / n, 1.0 / n]
}

/// Returns a point moved away from the eye at infinity.
fn shifted(p: P, length: f64) -> P {
    std::array::from_fn(|k| p[k] - towards()[k] * length)
}

/// Returns the limit of values for eyes that are further and further away, by Richardson's extrapolation.
fn limit(of: impl Fn(f64) -> DVec3) -> DVec3 {
    let mut row: Vec<DVec3> = (0..7).map(|k| of(1e3 * f64::from(1 << k))).collect();
    let mut power = 2.0;
    while row.len() > 1 {
        row = row.windows(2).map(|w| (w[1] * power - w[0]) / (power - 1.0)).collect();
        power *= 2.0;
    }
    row[0]
}

#[test]
fn an_eye_at_infinity_moves_along_parallel_rays() {
    let eye = ("eye", "inf:0.3,0.2,1");
    let in_box = |p: P| -> P { std::array::from_fn(|a| (p[a] - BOX[0][a]) / (BOX[1][a] - BOX[0][a])) };
    // The point at which a ray meets the plane z = 10.
    let on_plane = |p: P| {
        let [x, y, z] = towards();
        [p[0] - x / z * (p[2] - 10.0), p[1] - y / z * (p[2] - 10.0)]
    };
    type Truth<'a> = Box<dyn Fn(P) -> P + 'a>;
    let cases: Vec<(Vec<(&str, &str)>, Truth<'_>)> = vec![
        (
            vec![("reference", TETRAHEDRON), ("away", "0,0,0,1:25 0,1,0,0:-8")],
            Box::new(|p| {
                let u = barycentric(p, CORNERS);
                shifted(p, 25.0 * u[3] - 8.0 * u[1])
            }),
        ),
        (
            vec![("reference", TETRAHEDRON), ("degree", "2"), ("away", "0,1,0,1:12 2,0,0,0:-7")],
            Box::new(|p| {
                let u = barycentric(p, CORNERS);
                shifted(p, 24.0 * u[1] * u[3] - 7.0 * u[0] * u[0])
            }),
        ),
        (
            vec![("degree", "3x1x2"), ("away", "1,1,1:12 3,0,2:-9")],
            Box::new(move |p| {
                let t = in_box(p);
                let b = |i, j, k| bernstein(3, i, t[0]) * bernstein(1, j, t[1]) * bernstein(2, k, t[2]);
                shifted(p, 12.0 * b(1, 1, 1) - 9.0 * b(3, 0, 2))
            }),
        ),
        (
            vec![("degree", "2"), ("cells", "3x2x1"), ("away", "1,2,1:9 3,0,2:-6")],
            Box::new(move |p| {
                let t = in_box(p);
                let b = |i, j, k| b_spline(2, 3, i, t[0]) * b_spline(2, 2, j, t[1]) * b_spline(2, 1, k, t[2]);
                shifted(p, 9.0 * b(1, 2, 1) - 6.0 * b(3, 0, 2))
            }),
        ),
        (
            vec![("reference", "-20,0,10 60,50,10"), ("degree", "2x1x1"), ("away", "1,1,0:15")],
            Box::new(move |p| {
                let [x, y] = on_plane(p);
                shifted(p, 15.0 * bernstein(2, 1, (x + 20.0) / 80.0) * bernstein(1, 1, y / 50.0))
            }),
        ),
        (
            vec![("reference", "-20,0,10 60,0,10 0,80,10"), ("degree", "2"), ("away", "1,0,1:15")],
            Box::new(move |p| {
                let [x, y] = on_plane(p);
                let (v, w) = ((x + 20.0 - 20.0 * y / 80.0) / 80.0, y / 80.0);
                shifted(p, 15.0 * 2.0 * (1.0 - v - w) * w)
            }),
        ),
    ];
    for (pairs, truth) in &cases {
        let map = build("anamorph", &[&[eye][..], pairs].concat());
        compare(&map, truth);
        for p in points().into_iter().take(5).map(DVec3::from_array) {
            let far = limit(|d| {
                let [x, y, z] = towards().map(|v| v * d);
                let eye = format!("{},{},{}", 20.0 + x, 25.0 + y, 55.0 + z);
                build("anamorph", &[&[("eye", &*eye)][..], pairs].concat()).point(p)
            });
            assert!(far.distance(map.point(p)) < 1e-9 * 100.0, "{pairs:?} {p}: {far} {}", map.point(p));
        }
    }
    // A point that is prescribed by a length.
    let map = build("anamorph", &[eye, ("reference", TETRAHEDRON), ("point", "22,27,60:10mm")]);
    let (at, want) = ([22.0, 27.0, 60.0], shifted([22.0, 27.0, 60.0], 10.0));
    assert!(map.point(DVec3::from_array(at)).distance(DVec3::from_array(want)) < 1e-10);
}

/// B-splines as a reference: δ = Σ δᵢ·Nᵢ.
#[test]
fn splines_push_along_rays() {
    let map = build(
        "anamorph",
        &[("eye", "20,30,300"), ("degree", "2"), ("cells", "3x2x1"), ("push", "1,2,1:1.2 3,0,2:0.8")],
    );
    compare(&map, |p| {
        let t: P = std::array::from_fn(|a| (p[a] - BOX[0][a]) / (BOX[1][a] - BOX[0][a]));
        let b = |i, j, k| b_spline(2, 3, i, t[0]) * b_spline(2, 2, j, t[1]) * b_spline(2, 1, k, t[2]);
        radial(EYE, p, 1.0 + (1.0 / 1.2 - 1.0) * b(1, 2, 1) + (1.0 / 0.8 - 1.0) * b(3, 0, 2))
    });
}

/// Equations 12 to 14 of the paper: a collineation by d and d₀, or by its axis and one point.
#[test]
fn collineations_by_their_data() {
    let map = build("anamorph", &[("eye", "20,30,300"), ("collineation", "0.001,-0.002,0.0005,1.3")]);
    compare(&map, |p| {
        let q: P = std::array::from_fn(|k| p[k] - EYE[k]);
        radial(EYE, p, 0.001 * q[0] - 0.002 * q[1] + 0.0005 * q[2] + 1.3)
    });
    assert!(map.collineation().is_some());
    let map =
        build("anamorph", &[("eye", "20,30,300"), ("axis", "0,0,20 70,0,20 0,90,22"), ("point", "20,20,80:1.25")]);
    let normal = [0.0, -2.0 / 90.0, 1.0];
    let off = |p: P| (0..3).map(|k| normal[k] * (p[k] - [0.0, 0.0, 20.0][k])).sum::<f64>();
    compare(&map, |p| radial(EYE, p, 1.0 + (1.0 / 1.25 - 1.0) * off(p) / off([20.0, 20.0, 80.0])));
}

/// Ten million units away, models and eyes give equal results up to the rounding of coordinates.
#[test]
fn anamorphoses_are_the_same_far_from_the_origin() {
    let far = DVec3::new(1e7, -1.2e7, 0.8e7);
    let cases: &[(&[(&str, &str)], &str)] = &[
        (&[("push", "0,0,0,1:1.25 0,1,0,0:0.8")], "-20,0,20 70,0,20 0,90,20 20,20,110"),
        (&[("degree", "2"), ("push", "0,1,0,1:1.25 2,0,0,0:0.9")], "-20,0,20 70,0,20 0,90,20 20,20,110"),
        (&[("degree", "2"), ("push", "0,2,0:1.25")], "-20,0,10 60,0,10 0,80,10"),
        (&[("degree", "2"), ("push", "0,1,0:1.25")], "-20,0,10 60,50,10"),
        (&[("degree", "2"), ("push", "1,1,1:1.05"), ("local", "true")], "-10,5,20 50,45,90"),
        (&[("degree", "2x2x1"), ("push", "0,1,1,1:1.25")], "-20,0,20 70,0,20 0,90,20 -10,0,110 80,0,110 10,90,110"),
        (&[("degree", "2"), ("cells", "2x2x2"), ("push", "0,1,0:1.25")], "-10,5,20 50,45,90"),
    ];
    for (pairs, corners) in cases {
        for eye in ["20,30,300", "inf:0.3,0.2,1"] {
            let at = |by: DVec3| {
                let moved = |text: &str| {
                    let v: Vec<f64> = text.split(',').map(|t| t.parse().unwrap()).collect();
                    format!("{},{},{}", v[0] + by.x, v[1] + by.y, v[2] + by.z)
                };
                let corners: Vec<String> = corners.split(' ').map(moved).collect();
                let (corners, place) =
                    (corners.join(" "), if eye.starts_with("inf") { eye.into() } else { moved(eye) });
                // The pushes are given as lengths, for either eye.
                let pairs: Vec<(&str, &str)> = pairs
                    .iter()
                    .map(|(name, value)| match (*name, eye.starts_with("inf")) {
                        ("push", true) => ("away", *value),
                        _ => (*name, *value),
                    })
                    .collect();
                build("anamorph", &[&[("eye", &*place), ("reference", &*corners)][..], &pairs[..]].concat())
            };
            let (near, away) = (at(DVec3::ZERO), at(far));
            let back = away.inverse();
            for p in points().into_iter().map(|p| DVec3::from_array(p.map(|v| (v * 64.0).round() / 64.0))) {
                let (want, got) = (near.point(p), away.point(p + far));
                // The spacing of numbers at 1.2e7 is 2e-9.
                assert!((got - far).distance(want) < 2e-8, "{pairs:?} {eye} {p}: {} {want}", got - far);
                if let Some(back) = &back {
                    assert!(back.point(got).distance(p + far) < 1e-7, "{pairs:?} {eye} {p}");
                }
            }
        }
    }
}

/// Two tetrahedra on either side of a face, and a third that shares an edge: δ is linear in each, and continuous.
#[test]
fn tetrahedra_that_share_faces_do_not_tear() {
    let corners: [P; 5] =
        [[-30.0, -30.0, 40.0], [110.0, -20.0, 40.0], [10.0, 120.0, 40.0], [20.0, 25.0, 130.0], [20.0, 25.0, -40.0]];
    let text = corners.map(|c| c.map(|v| v.to_string()).join(",")).join(" ");
    let pairs = [
        ("eye", "20,30,300"),
        ("reference", &*text),
        ("tetrahedra", "0,1,2,3 0,2,1,4"),
        ("push", "3:1.2 4:0.9 0:1.05"),
    ];
    let map = build("anamorph", &pairs);
    let delta = [1.0 / 1.05, 1.0, 1.0, 1.0 / 1.2, 1.0 / 0.9];
    let back = map.inverse().unwrap();
    let mut sides = [0; 3];
    for p in points() {
        let inside = [[0, 1, 2, 3], [0, 2, 1, 4]]
            .into_iter()
            .position(|t: [usize; 4]| barycentric(p, t.map(|i| corners[i])).iter().all(|u| *u >= 0.0));
        let want = match inside {
            Some(k) => {
                let t = [[0, 1, 2, 3], [0, 2, 1, 4]][k];
                let u = barycentric(p, t.map(|i| corners[i]));
                radial(EYE, p, (0..4).map(|i| u[i] * delta[t[i]]).sum())
            }
            None => p,
        };
        sides[inside.unwrap_or(2)] += 1;
        let (got, want) = (map.point(DVec3::from_array(p)), DVec3::from_array(want));
        assert!(got.distance(want) <= 1e-12 * (1.0 + want.length()), "{p:?}: {got} {want}");
        assert!(map.point(back.point(got)).distance(got) <= 1e-9 * (1.0 + got.length()), "{p:?}");
    }
    assert!(sides[0] > 20 && sides[1] > 20, "{sides:?}");
    // The common face from either side.
    for k in 0..50 {
        let (v, w) = (0.013 * f64::from(k % 7) + 0.1, 0.017 * f64::from(k) / 2.0 + 0.05);
        let on: P = std::array::from_fn(|i| corners[0][i] * (1.0 - v - w) + corners[1][i] * v + corners[2][i] * w);
        let [above, below] = [1e-9, -1e-9].map(|h| map.point(DVec3::new(on[0], on[1], on[2] + h)));
        assert!(above.distance(below) < 1e-7, "{on:?}: {above} {below}");
    }
    let frame = Frame3::new(Box3::new(DVec3::ZERO, DVec3::ONE));
    let fails = |pairs: &[(&str, &str)]| {
        Registry3::builtin()
            .get("anamorph")
            .unwrap()
            .build_from(&Args::from_pairs(pairs), &frame)
            .unwrap_err()
            .to_string()
    };
    let with = |t: &'static str| fails(&[pairs[0], pairs[1], ("tetrahedra", t)]);
    assert!(with("0,1,2").contains("four numbers"));
    assert!(with("0,1,2,7").contains("0 to 4"));
    assert!(with("0,1,2,2").contains("one plane"));
    assert!(with("0,1,2,3 1,2,4,3").contains("lies in"), "{}", with("0,1,2,3 1,2,4,3"));
}
