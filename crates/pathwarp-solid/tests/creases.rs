//! Surfaces that the end of a region crosses: their images are cut along it, and both sides are right up to the cut.

#![allow(clippy::unwrap_used)]

use pathwarp::budget::{Budget, Limits};
use pathwarp::param::Args;
use pathwarp_solid::deform::Registry3;
use pathwarp_solid::glam::DVec3;
use pathwarp_solid::map::Chain3;
use pathwarp_solid::mesh::topology;
use pathwarp_solid::patch::{Surface, deform_patches, tessellate_image};
use pathwarp_solid::{Box3, Frame3};

const EYE: DVec3 = DVec3::new(32.0, 32.0, 400.0);
/// The factor by which the fourth corner is pushed away.
const PUSH: f64 = 1.5;

/// A surface over 8..48 × 6..50 whose x and y are linear in u and v; z(x, y) is its height.
fn hills() -> Surface {
    let points = (0..16).map(|k| {
        let wave = f64::from((k * 29 + 11) % 13);
        DVec3::new(8.0 + 40.0 * f64::from(k % 4) / 3.0, 6.0 + 44.0 * f64::from(k / 4) / 3.0, 20.0 + 2.0 * wave)
    });
    Surface::bezier("hills", [3, 3], points.collect())
}

fn height(surface: &Surface, x: f64, y: f64) -> f64 {
    let (u, v) = ((x - 8.0) / 40.0, (y - 6.0) / 44.0);
    let b = |t: f64| [(1.0 - t).powi(3), 3.0 * t * (1.0 - t).powi(2), 3.0 * t * t * (1.0 - t), t.powi(3)];
    let (bu, bv) = (b(u), b(v));
    (0..16).map(|k| surface.points[k].z * bu[k % 4] * bv[k / 4]).sum()
}

/// The part of space beyond a plane through `at`, as a large tetrahedron over it: three points of the plane, and one beyond.
fn beyond(at: DVec3, normal: DVec3) -> [DVec3; 4] {
    let n = normal.normalize();
    let a = n.any_orthonormal_vector();
    let b = n.cross(a);
    let rim = |t: f64| at + 2000.0 * (a * t.to_radians().cos() + b * t.to_radians().sin());
    [rim(0.0), rim(120.0), rim(240.0), at + 300.0 * n]
}

/// 0 on the plane of the first three corners, and 1 at the fourth.
fn along(p: DVec3, [a, b, c, d]: [DVec3; 4]) -> f64 {
    let normal = (b - a).cross(c - a);
    normal.dot(p - a) / normal.dot(d - a)
}

/// The image's source, from p̂ = O + (p − O)/δ with δ linear: 1 on the plane and 1/1.5 at the fourth corner. Without the region's end,
/// points beyond the plane only.
fn source(q: DVec3, corners: [DVec3; 4]) -> DVec3 {
    let along = |p: DVec3| along(p, corners);
    let slope = 1.0 / PUSH - 1.0;
    let r = q - EYE;
    // s = δ(O + s·r), where δ is 1 + slope·along.
    let s = (1.0 + slope * along(EYE)) / (1.0 - slope * (along(EYE + r) - along(EYE)));
    let p = EYE + r * s;
    if along(p) > 0.0 { p } else { q }
}

/// The map that pushes the fourth corner away and holds the face of the others.
fn local(corners: [DVec3; 4]) -> Chain3 {
    let show = |p: &DVec3| format!("{},{},{}", p.x, p.y, p.z);
    let reference = corners.iter().map(show).collect::<Vec<_>>().join(" ");
    let args = Args::from_pairs(&[
        ("eye", &*show(&EYE)),
        ("reference", &reference),
        ("push", "0,0,0,1:150%"),
        ("local", "true"),
    ]);
    let frame = Frame3::new(Box3::new(DVec3::ZERO, DVec3::splat(64.0)));
    let mut map = Chain3::default();
    map.push(Registry3::builtin().get("anamorph").unwrap().build_from(&args, &frame).unwrap().map);
    map
}

#[test]
fn images_follow_the_end_of_a_region() {
    let hills = hills();
    for (name, at, normal, most) in [
        ("along u = const", DVec3::new(30.0, 0.0, 20.0), DVec3::X, 1),
        ("oblique", DVec3::new(30.0, 30.0, 20.0), DVec3::new(1.0, 0.4, 0.2), 1),
        ("a corner", DVec3::new(20.0, 16.0, 20.0), DVec3::new(-1.0, -1.0, 0.1), 3),
        ("loops round the tops", DVec3::new(30.0, 30.0, 34.0), DVec3::new(0.02, 0.01, 1.0), 200),
    ] {
        let corners = beyond(at, normal);
        let map = local(corners);
        for tolerance in [0.1, 0.002] {
            let mut parts = vec![hills.clone()];
            let done = deform_patches(&mut parts, &map, tolerance, &Budget::new(Limits::default())).unwrap();
            assert!(done.cut == 1 && done.distance <= tolerance, "{name}: {done:?}");
            assert!(parts.len() <= most, "{name}: {} parts", parts.len());
            let (mut seen, mut moved) = (vec![false; 20 * 20], 0);
            for pieces in parts.iter().map(|s| s.pieces().0) {
                let side = if pieces.len() < 100 { 61 } else { 7 };
                for k in 0..side * side * pieces.len() {
                    let (piece, k) = (&pieces[k % pieces.len()], k / pieces.len());
                    let [u, v] = [k % side, k / side].map(|i| i as f64 / (side - 1) as f64);
                    let q = piece.point(u, v);
                    let p = source(q, corners);
                    let off = (p.z - height(&hills, p.x, p.y)).abs();
                    // The hills are steeper than one in one, and stretched.
                    assert!(off <= 4.0 * tolerance + 1e-9, "{name}: {off} at {q}, from {p}");
                    moved += usize::from(p.distance(q) > 0.01);
                    let cell = [(p.x - 8.0) / 40.0, (p.y - 6.0) / 44.0].map(|t| ((t * 20.0) as usize).min(19));
                    seen[cell[1] * 20 + cell[0]] = true;
                }
            }
            let missing = seen.iter().filter(|s| !**s).count();
            assert!(moved > 0 && missing == 0, "{name}: {missing} of 400 places are not covered");
        }
    }
}

/// Six flat patches that are a box, across the end of a region: as polygons they stay closed.
#[test]
fn closed_surfaces_give_closed_polygons() {
    let corner = |k: usize| DVec3::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2 & 1) as f64) * 48.0 + 4.0;
    // Seen from outside, counter-clockwise: u to the second, v to the third.
    let faces = [[0, 2, 1], [4, 5, 6], [0, 1, 4], [2, 6, 3], [0, 4, 2], [1, 3, 5]];
    let surfaces: Vec<Surface> = faces
        .iter()
        .map(|[a, b, c]| {
            let [a, b, c] = [*a, *b, *c].map(corner);
            Surface::bezier("", [1, 1], vec![a, b, c, b + c - a])
        })
        .collect();
    let corners = beyond(DVec3::new(30.0, 30.0, 20.0), DVec3::new(1.0, 0.4, 0.2));
    let map = local(corners);
    // The Jacobian of O + (p − O)/δ for a linear δ has the determinant δ(O)/δ(p)⁴.
    let delta = |p: DVec3| 1.0 + (1.0 / PUSH - 1.0) * along(p, corners);
    let cells = (0..60 * 60 * 60_usize).map(|k| DVec3::new((k % 60) as f64, (k / 60 % 60) as f64, (k / 3600) as f64));
    let cells = cells.map(|c| (c + 0.5) * 0.8 + 4.0);
    let volume: f64 =
        cells.map(|p| 0.8f64.powi(3) * if along(p, corners) > 0.0 { delta(EYE) / delta(p).powi(4) } else { 1.0 }).sum();
    for within in [None, Some(0.05)] {
        let mesh = tessellate_image(&surfaces, &map, within, &Budget::new(Limits::default())).unwrap();
        let t = topology(&mesh);
        assert!(t.is_closed() && t.euler() == 2 && (t.volume / volume - 1.0).abs() < 2e-3, "{t:?}, not {volume}");
    }
}

/// The end of the region lies along the joint of two patches: each side has its own derivatives, and both stay joined.
#[test]
fn a_crease_along_a_joint() {
    let hills = hills();
    let next = Surface::bezier(
        "next",
        [3, 3],
        (0..16)
            .map(|k| {
                let p = hills.points[k - k % 4 + 3];
                p + DVec3::new(
                    6.0 * f64::from(u8::try_from(k % 4).unwrap()),
                    0.0,
                    if k % 4 == 0 { 0.0 } else { k as f64 },
                )
            })
            .collect(),
    );
    // A twist before, so that no image is exact.
    let mut map = local(beyond(DVec3::new(48.0, 30.0, 20.0), DVec3::X));
    let frame = Frame3::new(Box3::new(DVec3::ZERO, DVec3::splat(64.0)));
    let twist = Args::from_pairs(&[("preset", "twist"), ("along", "y"), ("angle", "60")]);
    map.push(Registry3::builtin().get("bend").unwrap().build_from(&twist, &frame).unwrap().map);
    let mut images = vec![hills, next];
    let done = deform_patches(&mut images, &map, 1e-3, &Budget::new(Limits::default())).unwrap();
    assert!(done.refitted == 2 && done.distance <= 1e-3 && done.torn_at.is_none(), "{done:?}");
    assert!(images.iter().all(|s| s.points.len() < 3000), "{}", images[0].points.len());
    let [left, right] = [0, 1].map(|k| images[k].pieces().0);
    let n = (left.len() as f64).sqrt() as usize;
    for j in 0..n {
        let (a, b) = (&left[j * n + n - 1], &right[j * n]);
        for t in [0.0, 0.3, 1.0] {
            assert!(a.point(1.0, t).distance(b.point(0.0, t)) < 1e-9);
        }
    }
}

/// Nothing holds the face of this box: the surface is torn there, which is told.
#[test]
fn tears_are_found() {
    let frame = Frame3::new(Box3::new(DVec3::ZERO, DVec3::splat(64.0)));
    for (region, torn) in [("30,0,0,64,64,64", true), ("60,0,0,64,64,64", false)] {
        let args = Args::from_pairs(&[("region", region), ("degree", "1"), ("move", "0,1,1:4,8,0")]);
        let mut map = Chain3::default();
        map.push(Registry3::builtin().get("ffd").unwrap().build_from(&args, &frame).unwrap().map);
        let done = deform_patches(&mut vec![hills()], &map, 1e-2, &Budget::new(Limits::default())).unwrap();
        assert!(done.torn_at.is_some() == torn && done.distance <= 1e-2, "{done:?}");
    }
}
