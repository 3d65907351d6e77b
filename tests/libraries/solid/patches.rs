//! Checks images of rational surfaces in exact arithmetic. Every floating-point number is a fraction, so the source surface, an independent
//! formula of the map and the resulting surface are evaluated without rounding.

mod exact;

use cpu_time::ThreadTime;
use exact::{Q, bernstein, q, rational_point, size_of};
use pathwarp::budget::{Budget, Limit, Limits};
use pathwarp::param::Args;
use pathwarp_solid::deform::Registry3;
use pathwarp_solid::glam::{DMat4, DVec3, DVec4};
use pathwarp_solid::map::{Chain3, Collineation, Map3};
use pathwarp_solid::patch::{DeformedPatches, PatchError, Surface, TrimCurve, deform_patches, json, tessellate};
use pathwarp_solid::{Box3, Frame3};
use std::sync::Arc;
use std::time::Duration;

fn budget() -> Budget {
    Budget::new(Limits::default())
}

/// Returns a map over the box 0..64 on all axes. Powers of two keep the parameters exact.
fn chain(name: &str, pairs: &[(&str, &str)]) -> Chain3 {
    let frame = Frame3::new(Box3::new(DVec3::ZERO, DVec3::splat(64.0)));
    let mut chain = Chain3::default();
    chain.push(Registry3::builtin().get(name).unwrap().build_from(&Args::from_pairs(pairs), &frame).unwrap().map);
    chain
}

/// Returns a patch inside the box, with weights if `rational`.
fn patch(degree: [usize; 2], rational: bool) -> Surface {
    let [m, n] = degree;
    let points = (0..(m + 1) * (n + 1)).map(|k| {
        let (i, j) = (k % (m + 1), k / (m + 1));
        let wave = ((k * 29 + 11) % 13) as f64;
        DVec3::new(8.0 + 40.0 * i as f64 / m as f64, 6.0 + 44.0 * j as f64 / n as f64, 20.0 + 2.0 * wave)
    });
    let mut s = Surface::bezier("s", degree, points.collect());
    if rational {
        s.weights.iter_mut().enumerate().for_each(|(k, w)| *w = 0.5 + ((k * 7) % 5) as f64 * 0.25);
    }
    s.trims = vec![vec![TrimCurve {
        degree: 1,
        knots: vec![0.0, 0.0, 1.0, 1.0],
        points: vec![[0.25, 0.25], [0.75, 0.5]],
        weights: vec![1.0, 1.0],
    }]];
    s
}

/// Compares the image with the formula at a grid of parameters; the relative error must not exceed `within`.
fn compare(source: &Surface, map: &Chain3, degree: [usize; 2], within: f64, truth: impl Fn([Q; 3]) -> [Q; 3]) {
    let mut images = vec![source.clone()];
    let done = deform_patches(&mut images, map, 1e-3, &budget()).unwrap();
    let image = &images[0];
    assert_eq!((done.exact, done.refitted, image.degree), (1, 0, degree));
    assert_eq!(image.trims, source.trims);
    const PLACES: [u32; 5] = [0, 3, 7, 12, 16];
    for i in PLACES {
        for j in PLACES {
            let [u, v] = [i, j].map(|k| q(f64::from(k) / 16.0));
            let want = truth(rational_point(source, &u, &v));
            let got = rational_point(image, &u, &v);
            let off = size_of(&std::array::from_fn(|k| &got[k] - &want[k]));
            assert!(off <= within * (1.0 + size_of(&want)), "{i} {j}: off by {off:e}");
        }
    }
}

#[test]
fn collineations_keep_degree_knots_and_trims() {
    // At the control points of the first surface, every δ is a power of two, so nothing is rounded.
    let matrix = DMat4::from_cols(
        DVec4::new(1.0, 0.0, 0.0, 0.0),
        DVec4::new(0.0, 1.0, 0.0, 0.0),
        DVec4::new(0.0, 0.0, 1.0, 1.0 / 32.0),
        DVec4::new(0.0, 0.0, 0.0, 1.0),
    );
    let mut map = Chain3::default();
    map.push(Arc::new(Collineation::new(matrix)));
    let truth = |[x, y, z]: [Q; 3]| {
        let delta = Q::ONE + &z / q(32.0);
        [x / &delta, y / &delta, z / delta]
    };
    let points = (0..4).map(|k| DVec3::new(f64::from(k % 2), f64::from(k / 2), [0.0, 32.0, 96.0, 224.0][k as usize]));
    let flat = Surface::bezier("flat", [1, 1], points.collect());
    let mut image = vec![flat.clone()];
    deform_patches(&mut image, &map, 1.0, &budget()).unwrap();
    assert_eq!(image[0].weights, [1.0, 2.0, 4.0, 8.0]);
    assert_eq!(image[0].points[3], DVec3::new(0.125, 0.125, 28.0));
    compare(&flat, &map, [1, 1], 0.0, truth);
    compare(&patch([3, 3], true), &map, [3, 3], 1e-15, truth);
    // A NURBS surface keeps its knots.
    let mut nurbs = patch([3, 4], true);
    nurbs.degree = [2, 3];
    nurbs.knots = [vec![0.0, 0.0, 0.0, 0.25, 1.0, 1.0, 1.0], vec![0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 1.0]];
    assert_eq!(nurbs.fault(), None);
    compare(&nurbs, &map, [2, 3], 1e-15, truth);
}

/// Evaluates a lattice of degree 1 with weights, some of whose corners move.
fn trilinear([x, y, z]: [Q; 3], moved: &[([usize; 3], [f64; 3], f64)]) -> [Q; 3] {
    let t = [x, y, z].map(|v| v / q(64.0));
    let (mut sum, mut weights) = ([Q::ZERO, Q::ZERO, Q::ZERO], Q::ZERO);
    for k in 0..8usize {
        let node = [k & 1, k >> 1 & 1, k >> 2];
        let change = moved.iter().find(|c| c.0 == node);
        let w = q(change.map_or(1.0, |c| c.2));
        let influence = (0..3).fold(w, |p, a| p * bernstein(1, node[a], &t[a]));
        for a in 0..3 {
            sum[a] += &influence * q(64.0 * node[a] as f64 + change.map_or(0.0, |c| c.1[a]));
        }
        weights += influence;
    }
    sum.map(|s| s / &weights)
}

#[test]
fn lattices_raise_the_degree() {
    let moved = [([1, 1, 1], [8.0, -4.0, 16.0], 1.0), ([0, 1, 0], [-2.0, 6.0, 1.0], 1.0)];
    let map = chain("ffd", &[("degree", "1"), ("move", "1,1,1:8,-4,16 0,1,0:-2,6,1")]);
    compare(&patch([3, 3], false), &map, [9, 9], 1e-13, |p| trilinear(p, &moved));
    compare(&patch([2, 4], true), &map, [6, 12], 1e-13, |p| trilinear(p, &moved));
    let weighted = [moved[0], ([0, 1, 0], [-2.0, 6.0, 1.0], 3.0)];
    let map = chain("ffd", &[("degree", "1"), ("move", "1,1,1:8,-4,16 0,1,0:-2,6,1"), ("weight", "0,1,0:3")]);
    compare(&patch([3, 3], true), &map, [9, 9], 1e-13, |p| trilinear(p, &weighted));
    // Polynomial surfaces stay polynomial.
    let mut image = vec![patch([3, 3], false)];
    deform_patches(&mut image, &chain("ffd", &[("degree", "1"), ("move", "1,1,1:8,-4,16")]), 1.0, &budget()).unwrap();
    assert!(image[0].weights.iter().all(|w| *w == 1.0));
}

fn radial(p: &[Q; 3], eye: [f64; 3], delta: &Q) -> [Q; 3] {
    std::array::from_fn(|a| q(eye[a]) + (&p[a] - q(eye[a])) / delta)
}

#[test]
fn anamorphoses_over_every_reference() {
    let eye = [16.0, 24.0, 512.0];
    let at = ("eye", "16,24,512");
    // A tetrahedron on the axes, of degree 2: its barycentric coordinates are x/128, y/128, z/128 and the remainder to 1.
    let tetrahedron = ("reference", "0,0,0 128,0,0 0,128,0 0,0,128");
    let map = chain("anamorph", &[at, tetrahedron, ("degree", "2"), ("push", "0,1,0,1:1.6 2,0,0,0:0.8")]);
    compare(&patch([3, 3], true), &map, [6, 6], 1e-13, |p| {
        let [u, v, w] = p.clone().map(|c| c / q(128.0));
        let rest = Q::ONE - &u - &v - &w;
        // The control points between the second and fourth corners, and at the first corner.
        let delta = Q::ONE + (Q::ONE / q(1.6) - Q::ONE) * q(2.0) * u * w + (Q::ONE / q(0.8) - Q::ONE) * &rest * &rest;
        radial(&p, eye, &delta)
    });
    // A pentahedron on the same axes, of degree 1 over x and y and 2 along z, multiplies a patch's degree by 3.
    let pentahedron = ("reference", "0,0,0 128,0,0 0,128,0 0,0,128 128,0,128 0,128,128");
    let map = chain("anamorph", &[at, pentahedron, ("degree", "1x1x2"), ("push", "0,1,0,1:1.6 1,0,0,2:0.8")]);
    compare(&patch([2, 3], true), &map, [6, 9], 1e-12, |p| {
        let [u, v, w] = p.clone().map(|c| c / q(128.0));
        let rest = Q::ONE - &u - &v;
        let delta = Q::ONE
            + (Q::ONE / q(1.6) - Q::ONE) * u * bernstein(2, 1, &w)
            + (Q::ONE / q(0.8) - Q::ONE) * rest * bernstein(2, 2, &w);
        radial(&p, eye, &delta)
    });
    let cuboid = chain("anamorph", &[at, ("degree", "2x1x1"), ("push", "1,0,1:1.6")]);
    compare(&patch([2, 3], true), &cuboid, [8, 12], 1e-12, |p| {
        let t = p.clone().map(|c| c / q(64.0));
        let b = bernstein(2, 1, &t[0]) * bernstein(1, 0, &t[1]) * bernstein(1, 1, &t[2]);
        radial(&p, eye, &(Q::ONE + (Q::ONE / q(1.6) - Q::ONE) * b))
    });
    // Sheets in the plane z = 0, on which the ray through a point has the coordinates O + (p − O)·512/(512 − z).
    let foot = |p: &[Q; 3], a: usize| q(eye[a]) + (&p[a] - q(eye[a])) * q(512.0) / (q(512.0) - &p[2]);
    let rectangle =
        chain("anamorph", &[at, ("reference", "-64,-64,0 64,64,0"), ("degree", "1x1x1"), ("push", "1,1,0:1.6")]);
    compare(&patch([2, 3], false), &rectangle, [6, 9], 1e-12, |p| {
        let b = bernstein(1, 1, &((foot(&p, 0) + q(64.0)) / q(128.0)))
            * bernstein(1, 1, &((foot(&p, 1) + q(64.0)) / q(128.0)));
        radial(&p, eye, &(Q::ONE + (Q::ONE / q(1.6) - Q::ONE) * b))
    });
    let triangle =
        chain("anamorph", &[at, ("reference", "0,0,0 128,0,0 0,128,0"), ("degree", "2"), ("push", "0,1,1:1.6")]);
    compare(&patch([3, 3], false), &triangle, [9, 9], 1e-12, |p| {
        let (u, v) = (foot(&p, 0) / q(128.0), foot(&p, 1) / q(128.0));
        radial(&p, eye, &(Q::ONE + (Q::ONE / q(1.6) - Q::ONE) * q(2.0) * u * v))
    });
}

#[test]
fn skeletons_and_tapers() {
    let skeleton = [[0.0, 32.0, 32.0], [20.0, 40.0, 32.0], [44.0, 30.0, 36.0], [70.0, 10.0, 50.0]];
    let handles = [
        [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[0.25, 1.0, 0.0], [0.0, 0.125, 1.0]],
        [[0.0, 0.75, 0.5], [0.25, 0.0, 1.0]],
    ];
    let map = chain(
        "bend",
        &[
            ("skeleton", "0,32,32 20,40,32 44,30,36 70,10,50"),
            ("side", "0:0,1,0 1:0.25,1,0 2:0,0.75,0.5"),
            ("up", "0:0,0,1 1:0,0.125,1 2:0.25,0,1"),
        ],
    );
    let curve = |points: Vec<[f64; 3]>, u: &Q| -> [Q; 3] {
        let n = points.len() - 1;
        std::array::from_fn(|a| {
            points.iter().enumerate().fold(Q::ZERO, |sum, (i, p)| sum + bernstein(n, i, u) * q(p[a]))
        })
    };
    compare(&patch([3, 3], true), &map, [9, 9], 1e-13, |[x, y, z]| {
        let (u, v, w) = (x / q(64.0), y - q(32.0), z - q(32.0));
        let [c, s, t] =
            [skeleton.to_vec(), handles.iter().map(|h| h[0]).collect(), handles.iter().map(|h| h[1]).collect()]
                .map(|p| curve(p, &u));
        std::array::from_fn(|a| &c[a] + &v * &s[a] + &w * &t[a])
    });
    let taper = chain("bend", &[("preset", "taper"), ("along", "z"), ("factor", "0.25")]);
    compare(&patch([3, 3], false), &taper, [6, 6], 1e-13, |[x, y, z]| {
        let r = Q::ONE - q(0.75) * &z / q(64.0);
        [q(32.0) + &r * (x - q(32.0)), q(32.0) + r * (y - q(32.0)), z]
    });
    // In a chain of maps, degrees multiply.
    let mut both = chain("bend", &[("preset", "taper"), ("along", "z"), ("factor", "0.25")]);
    both.push(Arc::clone(&chain("ffd", &[("degree", "1"), ("move", "1,1,1:8,-4,16")]).steps()[0]));
    compare(&patch([2, 1], false), &both, [12, 6], 1e-12, |[x, y, z]| {
        let r = Q::ONE - q(0.75) * &z / q(64.0);
        let tapered = [q(32.0) + &r * (x - q(32.0)), q(32.0) + r * (y - q(32.0)), z];
        trilinear(tapered, &[([1, 1, 1], [8.0, -4.0, 16.0], 1.0)])
    });
}

/// Where a joint of a spline lattice is at a joint of the surface, composition is exact piece by piece. A patch outside is unchanged.
#[test]
fn pieces_within_cells_are_exact_and_others_are_refitted() {
    let map = chain("ffd", &[("degree", "1"), ("cells", "2x1x1"), ("move", "1,1,1:4,8,0")]);
    let row = |y: f64| (0..5).map(move |i| DVec3::new(8.0 + 12.0 * f64::from(i), y, 30.0 + f64::from(i * i)));
    let mut nurbs = Surface::bezier("n", [4, 1], row(10.0).chain(row(50.0)).collect());
    nurbs.degree = [2, 1];
    nurbs.knots[0] = vec![0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0];
    let tent = |[x, y, z]: [Q; 3]| {
        // Both cells meet in the middle, at x = 32.
        let s = if x < q(32.0) { &x / q(32.0) } else { q(2.0) - &x / q(32.0) };
        let k = s * &y / q(64.0) * &z / q(64.0);
        [x + q(4.0) * &k, y + q(8.0) * k, z]
    };
    compare(&nurbs, &map, [6, 3], 1e-13, tent);
    let mut across = vec![patch([3, 3], false)];
    let done = deform_patches(&mut across, &map, 0.5, &budget()).unwrap();
    assert!(done.refitted == 1 && done.distance <= 0.5, "{done:?}");
    let region = chain("ffd", &[("region", "0,0,80,64,64,64"), ("move", "1,1,1:4,8,0")]);
    let mut outside = vec![patch([3, 3], true)];
    deform_patches(&mut outside, &region, 0.5, &budget()).unwrap();
    assert_eq!(outside[0], patch([3, 3], true));
}

/// Images under a cubic lattice and a twist are within the tolerance on a finer grid than that of the fit, and neighbours stay joined.
#[test]
fn refitted_surfaces_are_within_the_tolerance_and_watertight() {
    let turned = |s: &Surface| {
        let mut t = s.clone();
        // A patch beyond the edge u = 1, described from v = 1 to 0.
        t.points = (0..16)
            .map(|k| s.points[(3 - k / 4) * 4 + 3] + DVec3::new(5.0 * (k % 4) as f64, 0.0, (k % 4) as f64))
            .collect();
        t.trims.clear();
        t
    };
    for map in [
        chain("ffd", &[("degree", "3"), ("move", "1,2,1:12,-9,14")]),
        chain("bend", &[("preset", "twist"), ("along", "y"), ("angle", "100")]),
    ] {
        let mut before = 0;
        for tolerance in [0.5, 0.01, 1e-4] {
            let source = vec![patch([3, 3], false), turned(&patch([3, 3], false))];
            let mut images = source.clone();
            let done: DeformedPatches = deform_patches(&mut images, &map, tolerance, &budget()).unwrap();
            assert!(done.refitted == 2 && done.distance <= tolerance && images[0].trims == source[0].trims);
            assert!(images[0].points.len() >= before);
            before = images[0].points.len();
            for (from, to) in source.iter().zip(&images) {
                for k in 0..9 * 9 {
                    let [u, v] = [k % 9, k / 9].map(|i| q((f64::from(i) + 0.4) / 9.0));
                    let f = |s: &Surface| DVec3::from_array(rational_point(s, &u, &v).map(|x| exact::float(&x)));
                    let off = map.point(f(from)).distance(f(to));
                    assert!(off <= 1.05 * tolerance, "{off} of {tolerance}");
                }
            }
            for k in 0..=4 {
                let v = f64::from(k) / 4.0;
                let [a, b] = [(&images[0], 1.0, v), (&images[1], 0.0, 1.0 - v)]
                    .map(|(s, u, v)| rational_point(s, &q(u), &q(v)).map(|x| exact::float(&x)));
                assert!(DVec3::from_array(a).distance(DVec3::from_array(b)) < 1e-9);
            }
        }
    }
}

#[test]
fn infinity_and_endless_work_are_refused() {
    // The eye is inside the box, so points behind it have no image.
    let map = chain("anamorph", &[("eye", "30,30,20"), ("reference", "0,0,0 64,0,0 0,64,0"), ("push", "1,0,0:2")]);
    let e = deform_patches(&mut vec![patch([3, 3], false)], &map, 0.1, &budget()).unwrap_err();
    assert!(matches!(e, PatchError::Undefined { surface: 0, .. }), "{e}");
    let small = Budget::new(Limits::default().with(Limit::Work, 1e4));
    let twist = chain("bend", &[("preset", "twist"), ("along", "y"), ("angle", "100")]);
    let e = deform_patches(&mut vec![patch([3, 3], false)], &twist, 1e-12, &small).unwrap_err();
    assert!(e.to_string().contains("`work`"), "{e}");
    let small = Budget::new(Limits::default().with(Limit::Work, 1e3));
    assert!(tessellate(&[patch([3, 3], false)], Some(1e-9), &small).is_err());
    let mesh = tessellate(&[patch([3, 3], false)], Some(0.01), &budget()).unwrap();
    assert!(mesh.polygons.len() > 64 && mesh.name_of(0) == "s");
}

/// Long NURBS and high degrees in a small file take linear time, or are refused.
#[test]
fn long_surfaces_take_linear_time() {
    let n = 20_000;
    let points = (0..2 * n).map(|k| DVec3::new(8.0 + 40.0 * f64::from(k % n) / f64::from(n), f64::from(k / n), 20.0));
    let mut long = Surface::bezier("long", [1, 1], points.collect());
    long.degree = [3, 1];
    long.knots[0] = [vec![0.0; 3], (0..n - 2).map(f64::from).collect(), vec![f64::from(n - 3); 3]].concat();
    assert_eq!(long.fault(), None);
    let begun = ThreadTime::now();
    assert_eq!(long.pieces().0.len(), 19_997);
    let map = chain("ffd", &[("degree", "1"), ("move", "1,1,1:8,-4,16")]);
    let small = Budget::new(Limits::default().with(Limit::Work, 1e6));
    assert!(deform_patches(&mut vec![long], &map, 0.1, &small).unwrap_err().to_string().contains("`work`"));
    // The degree is too high for a composition; this must be found before any product is computed.
    let high = chain("ffd", &[("degree", "10"), ("move", "5,5,5:4,0,0")]);
    let small = Budget::new(Limits::default().with(Limit::Work, 1e6));
    let done = deform_patches(&mut vec![patch([3, 3], false)], &high, 0.5, &small).unwrap();
    // Pieces and products are not counted; the bound of 20 seconds allows for slow machines.
    assert!(done.refitted == 1 && begun.elapsed() < Duration::from_secs(20), "{:?}", begun.elapsed());
}

/// A quarter of a circle of radius 32 about 8,8,20 keeps its degree under a collineation, and has degree 2·d under a map of degree d. Every
/// point of the image is the image of the circle's point at the same parameter.
#[test]
fn curves_in_space_keep_their_degree() {
    let arc =
        r#"{"curves":[{"degree":2,"points":[[40,8,20],[40,40,20],[8,40,20]],"weights":[1,0.7071067811865476,1]}]}"#;
    let tetrahedron = ("reference", "0,0,0 64,0,0 0,64,0 0,0,64");
    let cases: [(&[(&str, &str)], usize); 3] = [
        (&[tetrahedron, ("push", "1,0,0,0:1.25 0,0,1,0:0.8")], 2),
        (&[tetrahedron, ("degree", "2"), ("push", "1,1,0,0:1.25")], 4),
        (&[("degree", "1x2x1"), ("push", "1,1,0:1.25")], 8),
    ];
    for (pairs, degree) in cases {
        let map = chain("anamorph", &[&[("eye", "20,30,300")][..], pairs].concat());
        let source = json::read(arc.as_bytes()).unwrap();
        let mut image = source.clone();
        let done = deform_patches(&mut image, &map, 1e-3, &budget()).unwrap();
        assert_eq!((done.exact, image.len(), image[0].degree[0]), (1, 1, degree));
        // It is still a curve after it has been written and read again.
        let written = json::write(&image).unwrap();
        assert!(written.starts_with("{\"curves\":[{"), "{written}");
        let image = json::read(written.as_bytes()).unwrap();
        let [source, image] = [&source[0], &image[0]].map(|s| s.pieces().0.swap_remove(0));
        for i in 0..=16 {
            let t = f64::from(i) / 16.0;
            let p = source.point(t, 0.0);
            assert!(((p.x - 8.0).hypot(p.y - 8.0) - 32.0).abs() < 1e-12 * 32.0);
            assert!(image.point(t, 0.0).distance(map.point(p)) < 1e-11 * 64.0, "{pairs:?} {t}");
        }
    }
    let faulty = arc.replace("[8,40,20]", "[8,40,1e300]");
    assert!(json::read(faulty.as_bytes()).unwrap_err().to_string().contains("curve 1"));
}

/// In a picture of a square with a round hole, the hole is open and its area is missing.
#[test]
fn pictures_leave_out_what_is_trimmed_away() {
    let mut square = Surface::bezier(
        "s",
        [1, 1],
        [[0, 0], [64, 0], [0, 64], [64, 64]].map(|[x, y]| DVec3::new(f64::from(x), f64::from(y), 0.0)).to_vec(),
    );
    let line =
        |points: Vec<[f64; 2]>| TrimCurve { degree: 1, knots: vec![0.0, 0.0, 1.0, 1.0], points, weights: vec![1.0; 2] };
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
    let quarter = |k: usize| {
        let at = |i: usize| {
            let [x, y] =
                [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [-1.0, 1.0], [-1.0, 0.0], [-1.0, -1.0], [0.0, -1.0], [1.0, -1.0]]
                    [i % 8];
            [0.5 + 0.25 * x, 0.5 + 0.25 * y]
        };
        let points = vec![at(2 * k), at(2 * k + 1), at(2 * k + 2)];
        TrimCurve {
            degree: 2,
            knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
            points,
            weights: vec![1.0, 0.5_f64.sqrt(), 1.0],
        }
    };
    square.trims = vec![corners.windows(2).map(|w| line(w.to_vec())).collect(), (0..4).map(quarter).collect()];
    let mesh = tessellate(&[square], None, &budget()).unwrap();
    let area = pathwarp_solid::mesh::topology(&mesh).area;
    let want = 64.0 * 64.0 * (1.0 - std::f64::consts::PI / 16.0);
    assert!((area - want).abs() < 0.005 * want, "{area} {want}");
}
