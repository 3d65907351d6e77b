//! Surfaces that the boundary of a region crosses: their images are cut along it, and are correct on both sides up to the cut.

use pathwarp::budget::{Budget, Limit, Limits};
use pathwarp::param::Args;
use pathwarp_solid::deform::Registry3;
use pathwarp_solid::glam::DVec3;
use pathwarp_solid::map::{Chain3, Crease3, Creases3, Jet3, Map3};
use pathwarp_solid::mesh::topology;
use pathwarp_solid::patch::{Surface, TrimCurve, bpt, deform_patches, tessellate_image};
use pathwarp_solid::{Box3, Frame3};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

const EYE: DVec3 = DVec3::new(32.0, 32.0, 400.0);
/// The factor by which the fourth corner is pushed away.
const PUSH: f64 = 1.5;

/// Returns a surface over 8..48 × 6..50 whose x and y are linear in u and v, with the height z(x, y).
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

/// Returns the part of space beyond a plane through `at`, as a large tetrahedron: three points of the plane, and one beyond.
fn beyond(at: DVec3, normal: DVec3) -> [DVec3; 4] {
    let n = normal.normalize();
    let a = n.any_orthonormal_vector();
    let b = n.cross(a);
    let rim = |t: f64| at + 2000.0 * (a * t.to_radians().cos() + b * t.to_radians().sin());
    [rim(0.0), rim(120.0), rim(240.0), at + 300.0 * n]
}

/// Returns the linear function that is 0 on the plane of the first three corners and 1 at the fourth.
fn along(p: DVec3, [a, b, c, d]: [DVec3; 4]) -> f64 {
    let normal = (b - a).cross(c - a);
    normal.dot(p - a) / normal.dot(d - a)
}

/// Returns the source of an image under p̂ = O + (p − O)/δ with linear δ, which is 1 on the plane and 1/1.5 at the fourth corner. Correct
/// only for points beyond the plane.
fn source(q: DVec3, corners: [DVec3; 4]) -> DVec3 {
    let along = |p: DVec3| along(p, corners);
    let slope = 1.0 / PUSH - 1.0;
    let r = q - EYE;
    // s = δ(O + s·r), where δ is 1 + slope·along.
    let s = (1.0 + slope * along(EYE)) / (1.0 - slope * (along(EYE + r) - along(EYE)));
    let p = EYE + r * s;
    if along(p) > 0.0 { p } else { q }
}

/// Returns the map that pushes the fourth corner away and keeps the face of the other corners fixed.
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
                    // The slope of the hills is above 1, and they are stretched.
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

/// Six flat patches make a box across the boundary of a region; as polygons they stay closed.
#[test]
fn closed_surfaces_give_closed_polygons() {
    let corner = |k: usize| DVec3::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2 & 1) as f64) * 48.0 + 4.0;
    // Counter-clockwise as seen from outside: u runs to the second corner, v to the third.
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

/// Where the boundary of the region lies along the joint of two patches, each side has different derivatives, and they stay joined.
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
    // A twist comes first, so that no image is exact.
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

/// Nothing keeps this face of the box fixed: the surface is torn there, and a point of the tear is reported.
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

/// Returns the map of `ffd` in a frame of 64.
fn lattice(pairs: &[(&str, &str)]) -> Chain3 {
    let frame = Frame3::new(Box3::new(DVec3::ZERO, DVec3::splat(64.0)));
    let mut map = Chain3::default();
    map.push(Registry3::builtin().get("ffd").unwrap().build_from(&Args::from_pairs(pairs), &frame).unwrap().map);
    map
}

/// The map jumps at the plane x = 0, in which patches of the teapot meet, even at the tip of its lid. Each patch follows its side.
#[test]
fn a_jump_at_joints() {
    let teapot = bpt::read(include_bytes!("../../../samples/solid/newell.bpt")).unwrap();
    // The corner at 0,5,5 of a box from 0,0,−5 to 5,5,5, and the same lattice with its degrees raised.
    let raised = "0,2,1:0,0.1333333333333333,0 0,3,1:0,0.2,0 0,2,2:0,0.2666666666666667,0 0,3,2:0,0.4,0 \
                  0,1,1:0,0.0666666666666667,0 0,1,2:0,0.1333333333333333,0 0,1,3:0,0.2,0 0,2,3:0,0.4,0 0,3,3:0,0.6,0";
    for (degree, change) in [("1", "0,1,1:0,0.6,0"), ("1x3x3", raised)] {
        let map = lattice(&[("region", "0,0,-5,5,5,10"), ("degree", degree), ("move", change)]);
        let mut images = teapot.clone();
        let done = deform_patches(&mut images, &map, 1e-3, &Budget::new(Limits::default())).unwrap();
        assert!(images.len() == 32 && done.distance <= 1e-3 && done.torn_at.is_some(), "{done:?}");
        for (n, (from, to)) in teapot.iter().zip(&images).enumerate() {
            let moves = from.bounds().unwrap().max.x > 0.0;
            let (from, cells) = (&from.pieces().0[0], to.pieces().0);
            let across = cells.len().isqrt();
            for k in 0..17 * 17 {
                let [u, v] = [k % 17, k / 17].map(|i| f64::from(i) / 16.0);
                let p = from.point(u, v);
                let influence = (1.0 - p.x / 5.0) * p.y / 5.0 * (p.z + 5.0) / 10.0;
                let truth = p + DVec3::Y * if moves { 0.6 * influence } else { 0.0 };
                let [i, j] = [u, v].map(|t| ((t * across as f64) as usize).min(across - 1));
                let own = [u * across as f64 - i as f64, v * across as f64 - j as f64];
                let off = cells[j * across + i].point(own[0], own[1]).distance(truth);
                assert!(off <= 1e-3, "degree {degree}, surface {n} at {u},{v}: {off}");
            }
        }
    }
}

/// A surface with a joint where the map jumps falls apart there into exact halves.
#[test]
fn a_jump_at_a_joint_of_one_surface() {
    let row = |y: f64| (0..5).map(move |i| DVec3::new(8.0 + 12.0 * f64::from(i), y, 30.0 + f64::from(i * i)));
    let mut surface = Surface::bezier("", [4, 1], row(10.0).chain(row(50.0)).collect());
    surface.degree = [2, 1];
    surface.knots[0] = vec![0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0];
    let map = lattice(&[("region", "32,0,0,32,64,64"), ("degree", "1"), ("move", "0,1,1:0,16,0")]);
    let halves = surface.pieces().0;
    let mut images = vec![surface];
    let done = deform_patches(&mut images, &map, 1e-3, &Budget::new(Limits::default())).unwrap();
    assert!(images.len() == 2 && done.distance == 0.0 && done.torn_at.is_some(), "{done:?}");
    for (n, image) in images.iter().enumerate() {
        for (u, v) in [(0.0, 0.0), (0.0, 1.0), (0.3, 0.6), (1.0, 0.4)] {
            let p = halves[n].point(u, v);
            let influence = (2.0 - p.x / 32.0) * p.y / 64.0 * p.z / 64.0;
            let truth = p + DVec3::Y * if n == 1 { 16.0 * influence } else { 0.0 };
            let off = image.pieces().0[0].point(u, v).distance(truth);
            assert!(off < 1e-12, "half {n} at {u},{v}: {off}");
        }
    }
}

/// Returns a circle of four rational quadratics.
fn circle(r: f64) -> Vec<TrimCurve> {
    let corners = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
    let curve = |c: &[(i32, i32)]| TrimCurve {
        degree: 2,
        knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
        points: c.iter().map(|(x, y)| [0.5 + r * f64::from(*x), 0.5 + r * f64::from(*y)]).collect(),
        weights: vec![1.0, 0.5f64.sqrt(), 1.0],
    };
    [0, 2, 4, 6].map(|k| curve(&corners[k..k + 3])).to_vec()
}

/// Returns a point of a trimming curve with one span, by its definition.
fn on_curve(c: &TrimCurve, t: f64) -> [f64; 2] {
    let n = i32::try_from(c.degree).unwrap();
    let binomial = |i: i32| (0..i).fold(1.0, |b, k| b * f64::from(n - k) / f64::from(k + 1));
    let b = |i: usize| {
        let i = i32::try_from(i).unwrap();
        binomial(i) * t.powi(i) * (1.0 - t).powi(n - i)
    };
    let sum = |f: &dyn Fn(usize) -> f64| (0..c.points.len()).map(|i| b(i) * c.weights[i] * f(i)).sum::<f64>();
    [sum(&|i| c.points[i][0]) / sum(&|_| 1.0), sum(&|i| c.points[i][1]) / sum(&|_| 1.0)]
}

/// Returns `true` if an odd number of loops surrounds a point.
fn surrounded(loops: &[Vec<[f64; 2]>], [u, v]: [f64; 2]) -> bool {
    let crosses =
        |p: &[f64; 2], q: &[f64; 2]| (p[1] > v) != (q[1] > v) && u < p[0] + (v - p[1]) / (q[1] - p[1]) * (q[0] - p[0]);
    let count = |l: &Vec<[f64; 2]>| l.iter().zip(l.iter().cycle().skip(1)).filter(|(p, q)| crosses(p, q)).count();
    loops.iter().map(count).sum::<usize>() % 2 == 1
}

/// A ring is cut out of the hills. The loops of the parts leave the same ring, wherever the crease runs.
#[test]
fn trimmed_surfaces_are_cut() {
    let mut ring = hills();
    ring.trims = vec![circle(0.4), circle(0.15)];
    for (name, at, normal) in [
        ("along u = const", DVec3::new(30.0, 0.0, 20.0), DVec3::X),
        ("along v = const", DVec3::new(0.0, 24.0, 20.0), DVec3::NEG_Y),
        ("oblique", DVec3::new(30.0, 30.0, 20.0), DVec3::new(1.0, 0.4, 0.2)),
        ("a corner", DVec3::new(20.0, 16.0, 20.0), DVec3::new(-1.0, -1.0, 0.1)),
        ("loops round the tops", DVec3::new(30.0, 30.0, 34.0), DVec3::new(0.02, 0.01, 1.0)),
    ] {
        let corners = beyond(at, normal);
        let tolerance = 0.01;
        let mut parts = vec![ring.clone()];
        let done = deform_patches(&mut parts, &local(corners), tolerance, &Budget::new(Limits::default())).unwrap();
        assert!(
            done.cut == 1 && done.distance <= tolerance && parts.iter().all(|s| s.fault().is_none()),
            "{name}: {done:?}"
        );
        // The tolerance in space, converted to parameters of the source, which is 40 by 44 units.
        let near = 4.0 * tolerance / 40.0;
        let from_middle = |q: DVec3| {
            let p = source(q, corners);
            assert!((p.z - height(&hills(), p.x, p.y)).abs() <= 4.0 * tolerance, "{name}: {p}");
            ([(p.x - 8.0) / 40.0, (p.y - 6.0) / 44.0], ((p.x - 8.0) / 40.0 - 0.5).hypot((p.y - 6.0) / 44.0 - 0.5))
        };
        let mut seen = vec![false; 20 * 20];
        for part in &parts {
            let (cells, breaks) = part.pieces();
            let across = breaks[0].len() - 1;
            let image = |s: f64, t: f64| {
                let [i, j] = [0, 1].map(|a| {
                    let inner = &breaks[a][1..breaks[a].len() - 1];
                    inner.partition_point(|b| *b <= [s, t][a])
                });
                let own = |a: usize, k: usize| ([s, t][a] - breaks[a][k]) / (breaks[a][k + 1] - breaks[a][k]);
                cells[j * across + i].point(own(0, i), own(1, j))
            };
            let polygon =
                |l: &Vec<TrimCurve>| l.iter().flat_map(|c| (0..40).map(|i| on_curve(c, f64::from(i) / 40.0))).collect();
            let loops: Vec<Vec<[f64; 2]>> = part.trims.iter().map(polygon).collect();
            for [s, t] in loops.iter().flatten().copied() {
                let (_, r) = from_middle(image(s, t));
                // Parts are less than 50 wide.
                let on_side = [s, t].iter().any(|v| v.abs().min((v - 1.0).abs()) < tolerance / 50.0);
                assert!(
                    on_side || (r - 0.4).abs() < near || (r - 0.15).abs() < near,
                    "{name}: {s},{t} is {r} from the middle"
                );
            }
            let side = if parts.len() > 20 { 24 } else { 80 };
            for k in 0..side * side {
                let [s, t] = [k % side, k / side].map(|i| (f64::from(i) + 0.4) / f64::from(side));
                let inside = loops.is_empty() || surrounded(&loops, [s, t]);
                let (at, r) = from_middle(image(s, t));
                // A quarter of a circle or less becomes a polygon of 40 corners.
                let margin = near + 1e-3;
                if inside {
                    assert!(r > 0.15 - margin && r < 0.4 + margin, "{name}: {at:?} is not on the ring");
                    let cell = at.map(|t| ((t * 20.0) as usize).min(19));
                    seen[cell[1] * 20 + cell[0]] = true;
                } else {
                    assert!(r < 0.15 + margin || r > 0.4 - margin, "{name}: {at:?} is missing");
                }
            }
        }
        let missing = (0..400).filter(|k| {
            let r = ((f64::from(k % 20) + 0.5) / 20.0 - 0.5).hypot((f64::from(k / 20) + 0.5) / 20.0 - 0.5);
            r > 0.2 && r < 0.35 && !seen[*k as usize]
        });
        assert_eq!(missing.count(), 0, "{name}");
    }
}

/// A map that counts the queries for the side of a crease on which a point lies.
struct Asked {
    map: Arc<dyn Map3>,
    times: Arc<AtomicUsize>,
}

impl Map3 for Asked {
    fn jet(&self, p: DVec3) -> Jet3 {
        self.map.jet(p)
    }

    fn creases(&self, out: &mut Creases3) {
        let mut own = Creases3::default();
        self.map.creases(&mut own);
        for crease in own.items().iter().cloned() {
            let times = Arc::clone(&self.times);
            let level = move |p: DVec3| {
                times.fetch_add(1, Ordering::Relaxed);
                (crease.level)(p)
            };
            out.push(Crease3 { level: Arc::new(level), kind: crease.kind });
        }
    }
}

/// A map that tears the teapot apart at the sides of a box causes endless searches for the points. Each search costs a unit of work or
/// more, so that the budget ends them, and not a clock.
#[test]
fn searches_for_creases_are_counted() {
    let teapot = bpt::read(include_bytes!("../../../samples/solid/newell.bpt")).unwrap();
    let frame = Frame3::new(Box3::around(teapot.iter().flat_map(|s| s.points.iter().copied())).unwrap());
    let args =
        [("eye", "50%,60%,600%"), ("reference", "20%,20%,20% 80%,80%,80%"), ("push", "1,1,1:1.2"), ("local", "true")];
    let map = Registry3::builtin().get("anamorph").unwrap().build_from(&Args::from_pairs(&args), &frame).unwrap().map;
    let times = Arc::new(AtomicUsize::new(0));
    let mut chain = Chain3::default();
    chain.push(Arc::new(Asked { map, times: Arc::clone(&times) }));
    let most = 2e6;
    let budget = Budget::new(Limits::default().with(Limit::Work, most));
    let e = deform_patches(&mut teapot.clone(), &chain, 1e-3, &budget).unwrap_err();
    let times = times.load(Ordering::Relaxed) as f64;
    assert!(e.to_string().contains("`work`") && times > 1e4 && times < most, "{e}: {times} questions");
}
