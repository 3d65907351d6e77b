//! Surfaces that the end of a region crosses: their images are cut along it, and both sides are right up to the cut.

#![allow(clippy::unwrap_used)]

use pathwarp::budget::{Budget, Limits};
use pathwarp::param::Args;
use pathwarp_solid::deform::Registry3;
use pathwarp_solid::glam::DVec3;
use pathwarp_solid::map::Chain3;
use pathwarp_solid::patch::{Surface, deform_patches};
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

/// The image's source, from p̂ = O + (p − O)/δ with δ linear: 1 on the plane and 1/1.5 at the fourth corner. Without the region's end,
/// points beyond the plane only.
fn source(q: DVec3, [a, b, c, d]: [DVec3; 4]) -> DVec3 {
    let normal = (b - a).cross(c - a);
    let along = |p: DVec3| normal.dot(p - a) / normal.dot(d - a);
    let slope = 1.0 / PUSH - 1.0;
    let r = q - EYE;
    // s = δ(O + s·r), where δ is 1 + slope·along.
    let s = (1.0 + slope * along(EYE)) / (1.0 - slope * (along(EYE + r) - along(EYE)));
    let p = EYE + r * s;
    if along(p) > 0.0 { p } else { q }
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
