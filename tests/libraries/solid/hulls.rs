//! Checks pentahedra and lattices of other hulls against independent formulas (J. Hoschek, D. Lasser, 1993; S. Coquillart, 1990).

use pathwarp::Error;
use pathwarp::param::Args;
use pathwarp_oracle::Random;
use pathwarp_solid::deform::Registry3;
use pathwarp_solid::glam::{DMat3, DVec3};
use pathwarp_solid::map::Map3;
use pathwarp_solid::{Box3, Frame3};
use std::sync::Arc;

/// A ring around the y-axis, as a file that the program reads: six points around with the weights of a whole circle as a rational quintic,
/// five from y = −1 to 45, four from radius 6 to 36.
const RING: &str = include_str!("../../../samples/solid/ring.json");

fn build(name: &str, pairs: &[(&str, &str)], file: &str) -> Result<Arc<dyn Map3>, Error> {
    let registry = Registry3::builtin();
    let entry = registry.get(name).unwrap();
    let mut args = Args::from_pairs(pairs);
    args.resolve_files(entry.about().info.params, |_| Ok(file.to_owned()))?;
    let frame = Frame3::new(Box3::new(DVec3::new(-50.0, 0.0, -30.0), DVec3::new(50.0, 50.0, 30.0)));
    Ok(entry.build_from(&args, &frame)?.map)
}

fn bernstein(n: i32, i: i32, t: f64) -> f64 {
    let choose = (0..i).fold(1.0, |c, k| c * f64::from(n - k) / f64::from(k + 1));
    choose * t.powi(i) * (1.0 - t).powi(n - i)
}

/// Returns points in the box between two corners.
fn points(from: [f64; 3], to: [f64; 3]) -> Vec<DVec3> {
    let mut random = Random::new(68);
    (0..300).map(|_| DVec3::from_array(std::array::from_fn(|a| random.between(from[a], to[a])))).collect()
}

/// Compares a map and its inverse with a formula.
fn compare(map: &Arc<dyn Map3>, points: &[DVec3], truth: impl Fn(DVec3) -> DVec3) {
    let back = map.inverse().unwrap();
    let mut moved = 0.0_f64;
    for p in points {
        let (got, want) = (map.point(*p), truth(*p));
        assert!(got.distance(want) < 1e-10 * (1.0 + want.length()), "{p}: {got} {want}");
        assert!(back.point(got).distance(*p) < 1e-8, "{p}: {}", back.point(got));
        moved = moved.max(got.distance(*p));
    }
    assert!(moved > 1.0);
}

/// δ(u, w) = Σ δᵢⱼₖₗ·n!/(i!j!k!)·u₀ⁱu₁ʲu₂ᵏ·Bₗᵐ(w) over a skew pentahedron, in barycentric coordinates by Cramer's rule.
#[test]
fn pentahedra_are_the_formula() {
    let [a, b, c, d] =
        [[-60.0, -5.0, 40.0], [70.0, 0.0, 35.0], [0.0, 90.0, 50.0], [-55.0, 5.0, -60.0]].map(DVec3::from_array);
    let corners = [a, b, c, d, b + d - a, c + d - a].map(|p| format!("{},{},{}", p.x, p.y, p.z)).join(" ");
    let coordinates = |p: DVec3| {
        let whole = DMat3::from_cols(b - a, c - a, d - a).determinant();
        let v = DMat3::from_cols(p - a, c - a, d - a).determinant() / whole;
        let w = DMat3::from_cols(b - a, p - a, d - a).determinant() / whole;
        let l = DMat3::from_cols(b - a, c - a, p - a).determinant() / whole;
        ([1.0 - v - w, v, w], l)
    };
    // Control points 1,1,0,2 and 0,0,2,0 of degree 2 over the triangle and 3 along the edges.
    let sum = |[u, v, w]: [f64; 3], l: f64, [first, second]: [f64; 2]| {
        1.0 + (first - 1.0) * 2.0 * u * v * bernstein(3, 2, l) + (second - 1.0) * w * w * bernstein(3, 0, l)
    };
    let ps = points([-50.0, 0.0, -30.0], [50.0, 50.0, 30.0]);
    let tool = [("reference", corners.as_str()), ("degree", "2x2x3")];
    let eye = DVec3::new(10.0, 20.0, 400.0);
    let near = [&tool[..], &[("eye", "10,20,400"), ("push", "1,1,0,2:1.25 0,0,2,0:0.8")]].concat();
    compare(&build("anamorph", &near, "").unwrap(), &ps, |p| {
        let (u, l) = coordinates(p);
        eye + (p - eye) / sum(u, l, [0.8, 1.25])
    });
    let far = [&tool[..], &[("eye", "inf:0,0,2"), ("away", "1,1,0,2:30 0,0,2,0:-20")]].concat();
    compare(&build("anamorph", &far, "").unwrap(), &ps, |p| {
        let (u, l) = coordinates(p);
        p + DVec3::Z * (sum(u, l, [-29.0, 21.0]) - 1.0)
    });
    // Points outside stay, on every side.
    let local = [&near[..], &[("local", "true")]].concat();
    let local = build("anamorph", &local, "").unwrap();
    let beyond = points([-90.0, -60.0, -90.0], [90.0, 90.0, 60.0]);
    for p in &beyond {
        let (u, l) = coordinates(*p);
        let inside = u.iter().all(|u| *u > 0.0) && l > 0.0 && l < 1.0;
        let want = if inside { eye + (*p - eye) / sum(u, l, [0.8, 1.25]) } else { *p };
        assert!(local.point(*p).distance(want) < 1e-9, "{p}");
    }
    for (points, degree, part) in [
        ("0,0,0 9,0,0 0,9,0 0,0,9 9,0,9 0,9,8", "1", "parallel"),
        ("0,0,0 9,0,0 0,9,0 3,3,0 12,3,0 3,12,0", "1", "flat"),
        ("0,0,0 9,0,0 0,9,0 0,0,9 9,0,9 0,9,9", "1x2x1", "NxNxM"),
        ("0,0,0 9,0,0 0,9,0 0,0,9 9,0,9", "1", "six"),
    ] {
        let said =
            build("anamorph", &[("eye", "0,0,50"), ("reference", points), ("degree", degree)], "").err().unwrap();
        assert!(said.to_string().contains(part), "{points}: {said}");
    }
}

/// Returns coordinates of the ring: height and radius from 0 to 1.
fn in_ring(p: DVec3) -> Option<[f64; 2]> {
    let at = [(p.y + 1.0) / 46.0, (p.x.hypot(p.z) - 6.0) / 30.0];
    at.iter().all(|t| (0.0..=1.0).contains(t)).then_some(at)
}

/// Returns the share of the points 2,2 of height and radius, all around.
fn share(p: DVec3) -> f64 {
    in_ring(p).map_or(0.0, |[h, r]| bernstein(4, 2, h) * bernstein(3, 2, r))
}

/// Six points of a ring move towards the axis by 10.4, their distance from it being 26: in cylindrical coordinates, only radii shrink.
/// Nothing moves outside.
#[test]
fn a_ring_of_control_points_is_a_cylindrical_lattice() {
    let around = [[0.0, -1.0], [4.0, -1.0], [2.0, 3.0], [-2.0, 3.0], [-4.0, -1.0], [0.0, -1.0]];
    let moves = |i: usize| format!("{i},2,2:{},0,{}", -10.4 * around[i][0], -10.4 * around[i][1]);
    let moves: Vec<String> = (0..6).map(moves).collect();
    let pairs = [("hull", "ring.json"), ("move", &*moves.join(" "))];
    let map = build("ffd", &pairs, RING).unwrap();
    let shrunk = |p: DVec3| {
        let r = p.x.hypot(p.z);
        DVec3::new(p.x, 0.0, p.z) * (1.0 - 10.4 * share(p) / r) + DVec3::Y * p.y
    };
    compare(&map, &points([-40.0, -5.0, -40.0], [40.0, 50.0, 40.0]), shrunk);
    for (pairs, file, part) in [
        (&[("hull", "r.json"), ("degree", "2")][..], RING, "cannot go with `hull`"),
        (&[("hull", "r.json"), ("move", "6,0,0:1,0,0")], RING, "not a control point"),
        (&[("hull", "r.json")], &RING.replace("\"degree\": [5", "\"degree\": [4"), "layers"),
        // Heights that decrease again.
        (&[("hull", "r.json")], &RING.replace("33.5", "-33.5"), "folds"),
    ] {
        let said = build("ffd", pairs, file).err().unwrap().to_string();
        assert!(said.contains(part), "{pairs:?}: {said}");
    }
}

/// In a lattice of any hull, only the last homogeneous coordinate of its points changes (the paper's conclusion), so that
/// p̂ = O + (p − O)/δ with δ over the coordinates of the ring.
#[test]
fn anamorphoses_over_a_hull_move_along_rays() {
    let all = |value: &str| (0..6).map(|i| format!("{i},2,2:{value}")).collect::<Vec<_>>().join(" ");
    let ps = points([-40.0, -5.0, -40.0], [40.0, 50.0, 40.0]);
    let (push, away) = (all("1.05"), all("12"));
    let map = build("anamorph", &[("hull", "ring.json"), ("eye", "10,30,300"), ("push", &push)], RING).unwrap();
    let eye = DVec3::new(10.0, 30.0, 300.0);
    compare(&map, &ps, |p| eye + (p - eye) / (1.0 + (1.0 / 1.05 - 1.0) * share(p)));
    let map = build("anamorph", &[("hull", "ring.json"), ("eye", "inf:0,3,4"), ("away", &away)], RING).unwrap();
    compare(&map, &ps, |p| p - DVec3::new(0.0, 0.6, 0.8) * (12.0 * share(p)));
    // A prescribed point of the model moves the control point with most influence.
    let map = build("anamorph", &[("hull", "r.json"), ("eye", "10,30,300"), ("point", "0,22,26:1.01")], RING).unwrap();
    let (p, want) = (DVec3::new(0.0, 22.0, 26.0), eye + (DVec3::new(0.0, 22.0, 26.0) - eye) * 1.01);
    assert!(map.point(p).distance(want) < 1e-9, "{} {want}", map.point(p));
}
