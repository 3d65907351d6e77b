//! Compares anamorphoses with geometry in space and the papers' figures, and tests errors.

use super::dilation::{Dilation, Reference};
use super::scene::Eye;
use super::surface::{Camera, Cone, Space, SpacePlane, Sphere};
use super::*;
use crate::check;
use crate::deform::Deformation;
use crate::map::{Class, Dual, Homography, RationalBezier};
use crate::outline::Seg;
use crate::param::{Args, Frame, Settings};
use std::f64::consts::PI;

/// The derivatives of a point in space along the drawing's x and y.
#[derive(Debug)]
struct SpaceJet {
    dx: Space,
    dy: Space,
}

fn space_jet(cast: &Anamorphosis, p: Point) -> SpaceJet {
    let q = cast.image(Dual { v: p.x, x: 1.0, y: 0.0 }, Dual { v: p.y, x: 0.0, y: 1.0 });
    SpaceJet { dx: q.map(|d| d.x), dy: q.map(|d| d.y) }
}

type Given = &'static [(&'static str, &'static str)];

/// The registry's entry with another demo.
struct With(Info);

impl Deformation for With {
    fn info(&self) -> &Info {
        &self.0
    }
    fn build(&self, s: &Settings<'_>) -> Result<Built, Error> {
        ENTRY.build(s)
    }
}

#[test]
fn is_sound() {
    let faults = check::entry(&ENTRY);
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn is_sound_on_every_surface() {
    const DEMOS: &[Given] = &[
        &[("distance", "500"), ("eye-height", "400"), ("onto", "plane:floor")],
        &[("distance", "500"), ("eye-height", "40"), ("onto", "plane:ramp=30"), ("picture-width", "70")],
        &[("distance", "500"), ("eye", "300,50"), ("onto", "plane:left")],
        &[("distance", "500"), ("eye", "-300,50"), ("onto", "plane:right")],
        &[("distance", "500"), ("eye", "50,300"), ("onto", "plane:ceiling")],
        &[("distance", "300"), ("onto", "cylinder:radius=80,level"), ("eye", "40,70")],
        &[("distance", "60"), ("onto", "cylinder:radius=90,inside"), ("picture-width", "70")],
        &[("distance", "300"), ("onto", "cone:top-radius=90,bottom-radius=70,height=100"), ("eye", "50,20")],
        &[("distance", "300"), ("onto", "cone:top-radius=100,bottom-radius=140,height=80")],
        &[("distance", "90"), ("onto", "cone:top-radius=70,bottom-radius=110,inside")],
        &[("distance", "200"), ("onto", "sphere:radius=130"), ("view", "-60,10,250")],
        &[("distance", "200"), ("onto", "sphere:radius=130,inside"), ("view", "-60,10,150")],
        &[("distance", "120"), ("onto", "sphere:eye"), ("view", "90,80,100")],
        &[("distance", "200"), ("onto", "cylinder:radius=130"), ("view", "-60,10,250")],
        &[("distance", "200"), ("onto", "plane:wall=20"), ("view", "-60,10,250")],
        &[("distance", "150"), ("degree", "2x3"), ("push", "1,1:1.4"), ("away", "2,3:30"), ("view", "-60,10,250")],
        &[("distance", "150"), ("reference", "-50,0 150,0 50,200"), ("push", "0,1,0:1.4")],
        &[("eye", "50,250"), ("degree", "3x2"), ("push", "1,0:1.3"), ("away", "3,2:-20"), ("at", "0,2:-10,120")],
        &[("eye", "50,250"), ("reference", "-50,100 150,100 50,-100"), ("degree", "3"), ("push", "1,1,1:1.3")],
        &[("eye", "inf:0.2,-1,1.5"), ("onto", "plane:floor")],
        &[("eye", "inf:20deg,10deg"), ("onto", "cylinder:radius=80")],
        &[("eye", "inf:-0.2,-0.1,1"), ("onto", "cone:top-radius=70,bottom-radius=110,inside")],
        &[("eye", "inf:0.2,-0.3,1"), ("onto", "sphere:radius=130"), ("view", "-60,10,250")],
        &[("eye", "inf:0.2,-0.3,1"), ("degree", "2x3"), ("away", "1,1:20"), ("away", "2,3:30"), ("view", "-60,10,250")],
        &[("mirror", "cylinder:radius=60"), ("distance", "300"), ("eye-height", "250")],
        &[("mirror", "cylinder:radius=80,tilt=-12,lift=5"), ("eye", "inf:0.2,-1,1.1"), ("picture-width", "70")],
        &[("mirror", "cone:radius=100,height=160,tilt=5,lift=60"), ("eye-height", "500"), ("picture-width", "40")],
        &[("mirror", "sphere:radius=200"), ("distance", "400"), ("eye-height", "350"), ("picture-width", "50")],
        &[("eye", "inf:1,-0.5"), ("degree", "3x2"), ("away", "1,0:13"), ("at", "0,2:-10,120"), ("point", "40,50:5px")],
        &[
            ("eye", "50,250"),
            ("reference", "0,100 100,100 50,0"),
            ("degree", "4"),
            ("point", "50,60:1.04"),
            ("local", "true"),
        ],
    ];
    for demo in DEMOS {
        let entry = With(Info { demo, laws: &[], cases: &[], ..INFO });
        let faults = check::entry(&entry);
        assert!(faults.is_empty(), "{:?} {faults:#?}", entry.0.demo);
    }
}

fn build(pairs: &[(&str, &str)]) -> Result<Built, Error> {
    ENTRY.build_from(&Args::from_pairs(pairs), &check::frame())
}

const FOOT: Point = Point::new(40.0, 30.0);

fn cast(surface: Surface) -> Anamorphosis {
    Anamorphosis { eye: Eye::At(FOOT, 250.0), surface }
}

fn net(reference: Reference) -> Dilation {
    let mut d = Dilation::none(reference);
    for [i, j, k] in reference.nodes() {
        d.set([i, j, k], 0.6 + 0.11 * i as f64 + 0.07 * (j * j) as f64 + 0.05 * (i * i * j) as f64 + 0.13 * k as f64);
    }
    d
}

const CORNERS: [Point; 3] = [Point::new(-20.0, 0.0), Point::new(130.0, 10.0), Point::new(40.0, 150.0)];

fn surfaces() -> Vec<Surface> {
    let middle = Point::new(50.0, 60.0);
    let round = |radius, slope, horizontal, inside| Surface::Cone(Cone { middle, radius, slope, horizontal, inside });
    vec![
        Surface::Plane(SpacePlane::new([0.0, 400.0, 0.0], [0.05, 1.0, 0.3], Point::ORIGIN)),
        Surface::Plane(SpacePlane::new([0.0, 0.0, 90.0], [0.5, 0.2, 1.0], Point::ORIGIN)),
        round(200.0, 0.0, false, false),
        round(300.0, 0.0, true, true),
        round(200.0, -0.3, false, false),
        round(200.0, 0.4, false, true),
        Surface::Sphere(Sphere { middle, radius: 200.0, inside: false }),
        Surface::Sphere(Sphere { middle, radius: 200.0, inside: true }),
        Surface::Radial(Radial::stereographic(FOOT, 250.0, Rect::new(0.0, 0.0, 100.0, 100.0))),
        Surface::Radial(Radial::net(&net(Reference::Triangle(CORNERS, 2)))),
        Surface::Radial(Radial::net(&net(Reference::Rectangle(Rect::new(0.0, 0.0, 100.0, 120.0), [3, 2])))),
    ]
}

fn grid() -> impl Iterator<Item = Point> {
    (0..=10).flat_map(|i| (0..=10).map(move |j| Point::new(10.0 * f64::from(i), 10.0 * f64::from(j))))
}

/// Images satisfy the equation of the surface and lie on their rays; jets agree with difference quotients.
#[test]
fn every_image_is_on_the_surface_and_seen_where_it_was_drawn() {
    let away = |a: Space, b: Space| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
    for surface in surfaces() {
        let cast = cast(surface);
        let seen = cast.eye_view();
        for p in grid() {
            assert!(cast.defined(p) > 0.0, "{cast:?} {p:?}");
            let q = cast.point(p);
            assert!(seen.point(p).distance(p) < 1e-12 * 250.0, "{cast:?} {p:?}");
            let k = 250.0 / (q[2] + 250.0);
            assert!(k > 0.0 && (FOOT + (Point::new(q[0], q[1]) - FOOT) * k).distance(p) < 1e-12 * 250.0);
            let off = match &cast.surface {
                Surface::Plane(s) => (0..3).map(|i| s.normal[i] * (q[i] - s.through[i])).sum::<f64>(),
                Surface::Cone(r) => {
                    let across = if r.horizontal { q[1] - r.middle.y } else { q[0] - r.middle.x };
                    let along = if r.horizontal { q[0] - r.middle.x } else { q[1] - r.middle.y };
                    let axis = if r.inside { -r.radius } else { r.radius };
                    across.hypot(q[2] - axis) - (r.radius + r.slope * along)
                }
                Surface::Sphere(s) => away(q, s.centre()) - s.radius,
                Surface::Radial(_) => 0.0,
            };
            assert!(off.abs() < 1e-10, "{cast:?} {p:?} {off:e}");
            let (jet, h) = (space_jet(&cast, p), 1e-4);
            let slope = |d: Vec2| {
                let (a, b) = (cast.point(p + d), cast.point(p - d));
                std::array::from_fn(|i| (a[i] - b[i]) / (2.0 * h))
            };
            let (dx, dy) = (slope(Vec2::new(h, 0.0)), slope(Vec2::new(0.0, h)));
            assert!(away(jet.dx, dx) < 1e-5 * (1.0 + away(dx, [0.0; 3])), "{cast:?} {p:?} {jet:?} {dx:?}");
            assert!(away(jet.dy, dy) < 1e-5 * (1.0 + away(dy, [0.0; 3])));
        }
    }
}

/// A surface laid flat keeps lengths: derivatives have equal scalar products in space and in the plane.
#[test]
fn unrolled_surfaces_are_true_to_size() {
    let product = |a: Space, b: Space| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
    let mut flat = 0;
    for surface in surfaces() {
        let cast = cast(surface);
        let Some(map) = cast.unrolled() else { continue };
        flat += 1;
        let back = map.inverse().unwrap();
        for p in grid() {
            let (s, j) = (space_jet(&cast, p), map.jet(p));
            for (a, b) in [
                (product(s.dx, s.dx), j.dx.hypot2()),
                (product(s.dx, s.dy), j.dx.dot(j.dy)),
                (product(s.dy, s.dy), j.dy.hypot2()),
            ] {
                assert!((a - b).abs() < 1e-10 * (1.0 + s.dx.map(f64::abs).iter().sum::<f64>()), "{cast:?} {p:?}");
            }
            assert!(j.det() > 0.0, "mirrored: {cast:?}");
            assert!(back.point(j.p).distance(p) < 1e-9, "{cast:?} {p:?} {:?}", back.point(j.p));
        }
    }
    assert_eq!(flat, 6);
}

/// Finds the ten coefficients of a quadric from `points`, and returns the residual of `others`.
fn off_quadric(points: &[Space], others: &[Space]) -> f64 {
    let size = points.iter().flatten().fold(0.0, |m, v| f64::max(m, v.abs()));
    let row = |q: &Space| -> Vec<f64> {
        let [x, y, z] = q.map(|v| v / size);
        vec![x * x, y * y, z * z, x * y, y * z, z * x, x, y, z, 1.0]
    };
    let mut rows: Vec<Vec<f64>> = points.iter().map(row).collect();
    let mut pivots = Vec::new();
    for k in 0..9 {
        let all = (k..rows.len()).flat_map(|r| (0..10).map(move |c| (r, c)));
        let (r, c) = all.max_by(|a, b| rows[a.0][a.1].abs().total_cmp(&rows[b.0][b.1].abs())).unwrap();
        rows.swap(k, r);
        pivots.push(c);
        for i in (0..rows.len()).filter(|i| *i != k) {
            let f = rows[i][c] / rows[k][c];
            let from = rows[k].clone();
            rows[i].iter_mut().zip(from).for_each(|(to, v)| *to -= f * v);
        }
    }
    let free = (0..10).find(|c| !pivots.contains(c)).unwrap();
    let mut quadric = [0.0; 10];
    quadric[free] = 1.0;
    for (k, c) in pivots.iter().enumerate() {
        quadric[*c] = -rows[k][free] / rows[k][*c];
    }
    let most = quadric.iter().fold(0.0, |m, v| f64::max(m, v.abs()));
    let value = |q: &Space| row(q).iter().zip(quadric).map(|(a, b)| a * b).sum::<f64>().abs() / most;
    others.iter().map(value).fold(0.0, f64::max)
}

#[test]
fn degree_two_lies_on_a_quadric_through_the_eye() {
    let all: Vec<Surface> = surfaces();
    let bilinear = net(Reference::Rectangle(Rect::new(0.0, 0.0, 100.0, 120.0), [1, 1]));
    for (surface, is) in [
        (all[8].clone(), true),
        (all[9].clone(), true),
        (Surface::Radial(Radial::net(&bilinear)), true),
        (all[10].clone(), false),
    ] {
        let cast = cast(surface);
        let points: Vec<Space> = grid().step_by(11).chain(grid().step_by(7)).map(|p| cast.point(p)).collect();
        let mut others: Vec<Space> = grid().map(|p| cast.point(p)).collect();
        others.push([FOOT.x, FOOT.y, -250.0]);
        let off = off_quadric(&points, &others);
        assert_eq!(off < 1e-9, is, "{off:e}");
    }
}

#[test]
fn the_matrix_of_degree_one_is_the_bezier_form() {
    let d = net(Reference::Triangle(CORNERS, 1));
    let d0 = d.delta_at(FOOT);
    let along = Vec2::new(d.delta_at(FOOT + Vec2::new(1.0, 0.0)) - d0, d.delta_at(FOOT + Vec2::new(0.0, 1.0)) - d0);
    let o = FOOT;
    // The matrix [I 0; d d₀] about the eye.
    let m = [
        [1.0 + o.x * along.x, o.x * along.y, o.x * (d0 - along.dot(o.to_vec2())) - o.x],
        [o.y * along.x, 1.0 + o.y * along.y, o.y * (d0 - along.dot(o.to_vec2())) - o.y],
        [along.x, along.y, d0 - along.dot(o.to_vec2())],
    ];
    let (matrix, bezier) = (Homography::new(m), d.about(Eye::At(FOOT, 0.0), false));
    assert!(matches!(Map::class(&bezier), Class::Projective(_)));
    // A cubic stays a cubic, with weights.
    let cubic = Seg::Cubic(kurbo::CubicBez::new((5.0, 5.0), (90.0, 5.0), (20.0, 80.0), (60.0, 60.0)));
    let source = RationalBezier::from_seg(&cubic).unwrap();
    let image = bezier.simplest().image(&source).unwrap();
    assert_eq!(image.degree(), 3);
    for p in grid() {
        // The paper's Σ uᵢ (bᵢ, δᵢ), in coordinates about the eye.
        let area = |a: Point, b: Point, c: Point| (b - a).cross(c - a);
        let [a, b, c] = CORNERS;
        let u = [area(p, b, c), area(a, p, c), area(a, b, p)].map(|v| v / area(a, b, c));
        let delta = u[0] * d.delta_of([1, 0, 0]) + u[1] * d.delta_of([0, 1, 0]) + u[2] * d.delta_of([0, 0, 1]);
        let paper = FOOT + (p - FOOT) / delta;
        let bezier = d.about(Eye::At(FOOT, 0.0), false).simplest();
        assert!(bezier.point(p).distance(paper) < 1e-12 * 100.0 && matrix.point(p).distance(paper) < 1e-12 * 100.0);
        let back = bezier.inverse().unwrap();
        assert!(back.point(paper).distance(p) < 1e-10);
    }
    for (q, w) in image.points.iter().zip(&source.points) {
        let p = Point::new(w[0], w[1]);
        assert!(
            (q[2] - d.delta_at(p)).abs() < 1e-12
                && Point::new(q[0] / q[2], q[1] / q[2]).distance(matrix.point(p)) < 1e-11
        );
    }
}

const METRE: f64 = 96.0 / 0.0254;

/// By similar triangles, an eye 1.6 m high and 20 m away sees the far end of a 10 m marking, 30 m away, at a height of
/// 1.6·10/30 m above the near end. The far end is 30/20 times as wide as it appears.
#[test]
fn a_road_marking_ten_metres_long() {
    let frame = Frame::new(Rect::new(100.0, 40.0, 400.0, 240.0));
    let args = |pairs: &[(&str, &str)]| ENTRY.build_from(&Args::from_pairs(pairs), &frame).unwrap().map;
    let road = [("eye-height", "1.6m"), ("distance", "20m"), ("onto", "plane:floor")];
    let m = args(&[&road[..], &[("length", "10m")]].concat());
    let (near, far) = (m.point((250.0, 240.0).into()), m.point((250.0, 40.0).into()));
    assert!(near.distance((250.0, 240.0).into()) < 1e-9);
    assert!((near.y - far.y - 10.0 * METRE).abs() < 1e-9 * METRE && (near.x - far.x).abs() < 1e-9);
    // 200 units represent 1.6/3 m, so 300 are 0.8 m: 1.2 m at the far end.
    let width = |y: f64| m.point((400.0, y).into()).x - m.point((100.0, y).into()).x;
    assert!((width(240.0) - 0.8 * METRE).abs() < 1e-9 * METRE);
    assert!((width(40.0) - 1.2 * METRE).abs() < 1e-9 * METRE);
    // Its width gives the same scale.
    let same = args(&[&road[..], &[("picture-width", "80cm")]].concat());
    assert!(same.point((123.0, 77.0).into()).distance(m.point((123.0, 77.0).into())) < 1e-8);
    assert!(matches!(m.class(), Class::Projective(_)));
    // As drawn: 200 units are 52.9 mm, which shows 20·52.9/(1600 − 52.9) m of the road.
    let small = args(&road);
    let h = 200.0 / METRE;
    let far = small.point((250.0, 40.0).into());
    assert!((240.0 - far.y - 20.0 * h / (1.6 - h) * METRE).abs() < 1e-9 * METRE);
    // A ramp of 10 m, whose end is 5 m high.
    let ramp = [("eye-height", "8m"), ("distance", "20m"), ("onto", "plane:ramp=30"), ("length", "10m")];
    let m = args(&ramp);
    let (near, far) = (m.point((250.0, 240.0).into()), m.point((250.0, 40.0).into()));
    assert!((near.y - far.y - 10.0 * METRE).abs() < 1e-9 * METRE);
}

/// A horizontal line at the eye's height on a cylinder: the ray at φ from the direction of the axis ends by the sine rule.
#[test]
fn labels_are_as_long_as_their_arcs() {
    let m = build(&[("distance", "300"), ("onto", "cylinder:radius=80")]).unwrap().map;
    for i in 0..=20 {
        let x = 5.0 * f64::from(i);
        let phi = ((x - 50.0) / 300.0).atan();
        // In the triangle eye, axis, point: (D + r) sin φ = r sin(θ + φ).
        let theta = (380.0 * phi.sin() / 80.0).asin() - phi;
        let got = m.point((x, 50.0).into());
        assert!(got.distance((50.0 + 80.0 * theta, 50.0).into()) < 1e-10, "{got:?}");
    }
    // A hollow is seen from inside and outside, where the nearer wall does not count: r sin θ = (x − 50)/D · (D − r + r cos θ).
    for distance in [150.0, 300.0] {
        let hollow = build(&[("distance", &distance.to_string()), ("onto", "cylinder:radius=80,inside")]).unwrap().map;
        for theta in [-0.5, -0.2, 0.0, 0.3, 0.6_f64] {
            let x = 50.0 + distance * 80.0 * theta.sin() / (distance - 80.0 + 80.0 * theta.cos());
            let got = hollow.point((x, 50.0).into());
            assert!(got.distance((50.0 + 80.0 * theta, 50.0).into()) < 1e-10, "{distance} {theta}: {got:?}");
        }
    }
    // A cone whose half angle has the sine ½, so that half a turn unrolls to a quarter turn.
    let cone = Surface::Cone(Cone {
        middle: Point::ORIGIN,
        radius: 100.0,
        slope: -(1.0 / 3.0f64.sqrt()),
        horizontal: false,
        inside: true,
    });
    let cast = Anamorphosis { eye: Eye::At(Point::ORIGIN, 100.0), surface: cone };
    let m = cast.unrolled().unwrap();
    // Seen from its axis at 45°: the point at a quarter of a half turn and height 0, 200 from the apex below.
    let got = m.point(Point::new(100.0, 0.0));
    let want = Point::new(200.0 * (PI / 8.0).sin(), 200.0 - 200.0 * (PI / 8.0).cos());
    assert!(got.distance(want) < 1e-11, "{got:?} {want:?}");
}

/// Compares a camera's view with the central projection; polynomial maps have exact images.
#[test]
fn views_are_central_projections_and_exact_where_they_can_be() {
    let at = [-100.0, 20.0, -180.0];
    for (k, surface) in surfaces().into_iter().enumerate() {
        let cast = cast(surface);
        let middle = Point::new(50.0, 50.0);
        let target = cast.point(middle);
        let camera = Camera::new(at, target, middle).unwrap();
        let view = cast.camera_view(&camera, Rect::new(0.0, 0.0, 100.0, 100.0));
        assert!(view.point(middle).distance(middle) < 1e-10);
        let minus = |a: Space, b: Space| -> Space { std::array::from_fn(|i| a[i] - b[i]) };
        let dot = |a: Space, b: Space| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
        let axis = minus(target, at);
        for p in grid().filter(|p| p.distance(middle) > 1.0) {
            // The angle to the optical axis, in space and from the picture.
            let q = minus(cast.point(p), at);
            let cos = dot(q, axis) / (dot(q, q) * dot(axis, axis)).sqrt();
            if cos > 0.1 {
                let tan = view.point(p).distance(middle) / dot(axis, axis).sqrt();
                assert!((tan - (1.0 - cos * cos).sqrt() / cos).abs() < 1e-6, "{k} {p:?}");
            }
        }
        let line = RationalBezier::polynomial(&[Point::new(10.0, 20.0), Point::new(90.0, 60.0)]);
        match (&cast.surface, view.image(&line)) {
            (Surface::Plane(_), Some(image)) => assert_eq!(image.degree(), 1),
            (Surface::Radial(_), Some(image)) => {
                assert_eq!(image.degree(), [2, 2, 3][k - 8]);
                for i in 0..=8 {
                    let t = f64::from(i) / 8.0;
                    assert!(image.eval(t).distance(view.point(line.eval(t))) < 1e-9);
                }
            }
            (Surface::Plane(_) | Surface::Radial(_), None) => panic!("{k} has no exact image"),
            (_, image) => assert!(image.is_none()),
        }
    }
}

/// A triangle of degree 1 in front of the eye is a plane, unrolled true to size: its corners have their distances in space.
#[test]
fn three_pushed_corners_span_a_plane() {
    let m = build(&[
        ("distance", "200"),
        ("eye", "30,40"),
        ("reference", "0,0 100,0 0,100"),
        ("push", "0,1,0:1.5"),
        ("away", "0,0,1:50"),
    ]);
    let m = m.unwrap().map;
    assert!(matches!(m.class(), Class::Projective(_)));
    let corners = [(0.0, 0.0), (100.0, 0.0), (0.0, 100.0)];
    let eye = [30.0, 40.0, -200.0];
    let image = corners.map(|(x, y)| {
        let d: Space = [x - eye[0], y - eye[1], 200.0];
        let n = d.iter().map(|v| v * v).sum::<f64>().sqrt();
        let k = if x > 0.0 {
            1.5
        } else if y > 0.0 {
            (n + 50.0) / n
        } else {
            1.0
        };
        [eye[0] + d[0] * k, eye[1] + d[1] * k, eye[2] + d[2] * k]
    });
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        let apart = (0..3).map(|i| (image[a][i] - image[b][i]).powi(2)).sum::<f64>().sqrt();
        assert!((m.point(corners[a].into()).distance(m.point(corners[b].into())) - apart).abs() < 1e-10);
    }
}

#[test]
fn a_prescribed_point_gets_there_and_torn_sides_warn() {
    for degree in ["1", "2", "4"] {
        let m = build(&[
            ("eye", "50,300"),
            ("reference", "0,100 100,100 50,0"),
            ("degree", degree),
            ("point", "45,60:1.1"),
            ("local", "true"),
        ]);
        let m = m.unwrap();
        let want = Point::new(50.0, 300.0) + (Point::new(45.0, 60.0) - Point::new(50.0, 300.0)) * 1.1;
        assert!(m.map.point((45.0, 60.0).into()).distance(want) < 1e-11);
        // The first side joins; at degree 4 all do.
        let inside = m.map.branch((45.0, 60.0).into()).unwrap();
        assert!(inside.point((20.0, 100.0).into()).distance((20.0, 100.0).into()) < 1e-12);
        assert_eq!(m.explanation.warnings.is_empty(), degree == "4", "{:?}", m.explanation.warnings);
    }
}

#[test]
fn every_fault_is_named() {
    let cases: &[(Given, &str)] = &[
        (&[("onto", "plane:floor")], "distance is needed"),
        (&[("distance", "100"), ("onto", "plane:floor")], "never comes down"),
        (&[("distance", "100"), ("eye", "50,200"), ("onto", "plane:floor")], "from behind"),
        (&[("distance", "100"), ("onto", "plane:slope")], "does not have"),
        (&[("distance", "100"), ("onto", "plane:")], "is not one of"),
        (&[("distance", "100"), ("onto", "cylinder:")], "needs radius"),
        (&[("distance", "100"), ("onto", "cylinder:radius=20,diameter=40")], "has a radius and a diameter; give one"),
        (&[("distance", "100"), ("onto", "cylinder:radius=20,radius=40")], "twice"),
        (&[("distance", "100"), ("onto", "cylinder:radius=20")], "misses the surface"),
        (&[("distance", "100"), ("onto", "cylinder:radius=-20")], "not positive"),
        (&[("distance", "100"), ("onto", "cone:top=20")], "top-radius=… or top-diameter=…"),
        (&[("distance", "100"), ("onto", "cone:bottom=20,top-radius=9")], "bottom-radius=… or bottom-diameter=…"),
        (&[("distance", "100"), ("onto", "cone:top-radius=20")], "needs bottom-radius=… or bottom-diameter=…"),
        (&[("distance", "100"), ("onto", "cone:top-radius=90,bottom-radius=40,slant=50")], "a slant that is too short"),
        (&[("distance", "100"), ("onto", "torus:radius=20")], "not a surface"),
        (&[("distance", "100"), ("onto", "sphere:radius=200")], "view is needed"),
        (&[("distance", "100"), ("onto", "sphere:eye"), ("push", "0,0:2")], "has the surface already"),
        (&[("distance", "100"), ("degree", "2"), ("push", "1,1:2")], "view is needed"),
        (&[("distance", "100"), ("onto", "plane:wall=10"), ("view", "50,50,-9"), ("eye", "50,50")], "too near"),
        (&[("distance", "100"), ("onto", "plane:wall=10"), ("view", "50,50")], "X,Y,Z"),
        (&[("distance", "100"), ("onto", "plane:floor"), ("length", "10"), ("eye", "5,5")], "eye-height is needed"),
        (&[("distance", "100"), ("onto", "cylinder:radius=99"), ("length", "10")], "picture-width"),
        (&[("distance", "100"), ("eye-height", "9"), ("eye", "0,0"), ("onto", "plane:floor")], "give one"),
        (&[("distance", "0"), ("onto", "plane:floor")], "out of range"),
        (&[("distance", "9"), ("local", "true")], "without `distance`"),
        (&[("push", "2,0:2")], "I runs from 0 to 1"),
        (&[("push", "1,0:0")], "through the eye"),
        (&[("push", "1,0:-1")], "through the eye"),
        (&[("away", "1,0:-1000")], "through the eye"),
        (&[("reference", "0,0 9,9 99,99")], "one line"),
        (&[("reference", "0,0 9,0")], "no area"),
        (&[("degree", "0")], "not a degree"),
        (&[("degree", "3x")], "not a degree"),
        (&[("point", "50,50:1.2"), ("local", "true")], "fixed"),
        (&[("point", "50,50")], "X,Y:FACTOR"),
        (&[("eye", "inf:1")], "inf:DX,DY"),
        (&[("eye", "inf:0,0")], "no direction"),
        (&[("eye", "inf:0,-1,-1"), ("onto", "plane:floor")], "give a positive DZ"),
        (&[("eye", "inf:0,1,1"), ("onto", "plane:floor")], "from behind"),
        (&[("eye", "inf:0,-1,1"), ("onto", "plane:floor"), ("distance", "9")], "is infinite for this `eye`"),
        (&[("eye", "inf:0,-1,1"), ("onto", "sphere:eye")], "needs a `distance`"),
        (&[("eye", "inf:0,-1"), ("push", "0,0:2")], "give a length instead"),
        (&[("eye", "inf:0,0,1"), ("onto", "plane:floor")], "edge-on"),
        (&[("mirror", "cylinder:radius=60")], "distance is needed"),
        (&[("mirror", "cube:radius=60"), ("distance", "300"), ("eye-height", "200")], "is not a mirror"),
        (&[("mirror", "cylinder:radius=60"), ("distance", "30"), ("eye-height", "200")], "contains the eye"),
        (&[("mirror", "sphere:radius=150"), ("distance", "30"), ("eye-height", "200")], "contains the eye"),
        (&[("mirror", "cylinder:radius=60"), ("distance", "300"), ("eye", "50,120")], "not above the table"),
        (&[("mirror", "cylinder:radius=40"), ("distance", "300"), ("eye-height", "200")], "misses the mirror"),
        (
            &[("mirror", "cylinder:radius=60,height=30"), ("distance", "300"), ("eye-height", "200")],
            "over the mirror's top",
        ),
        (
            &[
                ("mirror", "cone:radius=60,height=40"),
                ("distance", "300"),
                ("eye-height", "200"),
                ("picture-width", "9"),
            ],
            "reflects no table",
        ),
        (&[("mirror", "cylinder:radius=60,lift=-50"), ("distance", "300"), ("eye-height", "200")], "hides itself"),
        (&[("mirror", "cone:radius=60"), ("distance", "300")], "needs height"),
        (&[("mirror", "cylinder:radius=60"), ("onto", "plane:floor"), ("distance", "300")], "cannot go with `mirror`"),
        (&[("foot", "5,5")], "mirror is needed"),
    ];
    for (pairs, part) in cases {
        let e = build(pairs).err().unwrap_or_else(|| panic!("{pairs:?} builds")).to_string();
        assert!(e.contains(part), "{pairs:?}: {e}");
    }
}

/// Returns the limit of far eyes in a direction, by Richardson's extrapolation from eyes at 1, 2, 4, … times a distance.
fn limit(of: impl Fn(f64) -> Point) -> Point {
    let mut row: Vec<Vec2> = (0..7).map(|k| of(1e3 * f64::from(1 << k)).to_vec2()).collect();
    let mut power = 2.0;
    while row.len() > 1 {
        row = row.windows(2).map(|w| (w[1] * power - w[0]) / (power - 1.0)).collect();
        power *= 2.0;
    }
    row[0].to_point()
}

/// An eye at infinity is the limit of far eyes, and its rays are parallel.
#[test]
fn an_eye_at_infinity_is_the_limit_of_far_ones() {
    let u = {
        let v = [0.3, -0.5, 1.0_f64];
        let n = v.iter().map(|v| v * v).sum::<f64>().sqrt();
        v.map(|v| v / n)
    };
    let space: &[Given] = &[
        &[("onto", "plane:floor")],
        &[("onto", "plane:wall=25")],
        &[("onto", "cylinder:radius=130")],
        &[("onto", "cylinder:radius=150,level,inside")],
        &[("onto", "cone:top-radius=120,bottom-radius=150")],
        &[("onto", "sphere:radius=150"), ("view", "-60,10,250")],
        &[("onto", "sphere:radius=150,inside"), ("view", "-60,10,150")],
        &[("degree", "2x3"), ("away", "1,1:20"), ("away", "2,3:-15"), ("view", "-60,10,250")],
        &[("reference", "-50,0 150,0 50,200"), ("away", "0,1,0:40"), ("away", "1,0,0:-10")],
    ];
    let plane: &[Given] = &[
        &[("degree", "2x3"), ("away", "1,1:20"), ("away", "2,3:-15")],
        &[("reference", "-50,0 150,0 50,200"), ("degree", "2"), ("at", "0,1,1:140,30"), ("away", "1,0,1:-10")],
    ];
    for (more, in_front) in space.iter().map(|m| (m, true)).chain(plane.iter().map(|m| (m, false))) {
        let place = if in_front { "inf:0.3,-0.5,1" } else { "inf:0.6,-0.8" };
        let at = build(&[&[("eye", place)], &more[..]].concat()).unwrap().map;
        for p in [Point::new(20.0, 10.0), Point::new(90.0, 80.0), Point::new(55.0, 45.0)] {
            let far = limit(|d| {
                let v = if in_front { [u[0], u[1]] } else { [0.6, -0.8] };
                let (eye, distance) = (format!("{},{}", 50.0 + v[0] * d, 50.0 + v[1] * d), (u[2] * d).to_string());
                let own: &[(&str, &str)] = &[("eye", &eye), ("distance", &distance)];
                build(&[&own[..if in_front { 2 } else { 1 }], &more[..]].concat()).unwrap().map.point(p)
            });
            assert!(far.distance(at.point(p)) < 1e-9 * 100.0, "{more:?} {p:?}: {far:?} {:?}", at.point(p));
        }
    }
    let point = build(&[("eye", "inf:0.6,-0.8"), ("degree", "2"), ("point", "60,30:10px")]).unwrap().map;
    assert!(point.point((60.0, 30.0).into()).distance(Point::new(54.0, 38.0)) < 1e-11);
    // By parallel rays: the floor under a point at height h is met h/0.5 further away and 0.3·h/0.5 aside.
    let floor = build(&[("eye", "inf:0.3,-0.5,1"), ("onto", "plane:floor")]).unwrap().map;
    let right = build(&[("eye", "inf:0deg,30deg"), ("onto", "cylinder:radius=80")]).unwrap().map;
    for p in grid() {
        let away = (100.0 - p.y) / 0.5;
        let want = Point::new(p.x - 0.3 * away, 100.0 - away);
        assert!(floor.point(p).distance(want) < 1e-10, "{p:?}");
        // A cylinder of radius r around an axis r behind the middle: z = r − √(r² − x²) and y falls by z·tan 30°.
        let (x, r) = (p.x - 50.0, 80.0_f64);
        let z = r - (r * r - x * x).sqrt();
        let want = Point::new(50.0 + r * (x / r).asin(), p.y + z * (PI / 6.0).tan());
        assert!(right.point(p).distance(want) < 1e-10, "{p:?}");
    }
}

/// Follows the ray from the eye through a point of the picture to the mirror, and after the reflection to the table y = 0, by vectors.
/// The origin is the middle of the foot, with x right, y down, z away.
fn traced(shape: MirrorShape, tilt: f64, eye: Space, p: Space) -> Option<Space> {
    let add = |a: Space, b: Space, k: f64| -> Space { std::array::from_fn(|i| a[i] + b[i] * k) };
    let dot = |a: Space, b: Space| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
    let axis = [0.0, -tilt.to_radians().cos(), tilt.to_radians().sin()];
    // The distance of a point from the inside, and its gradient.
    let outside = |q: Space| -> (f64, Space) {
        match shape {
            MirrorShape::Sphere(r) => {
                let w = add(q, [0.0, -r, 0.0], -1.0);
                (dot(w, w).sqrt() - r, w)
            }
            MirrorShape::Cylinder(r, _) => {
                let w = add(q, axis, -dot(q, axis));
                (dot(w, w).sqrt() - r, w)
            }
            MirrorShape::Cone(r, h) => {
                let s = dot(q, axis);
                let w = add(q, axis, -s);
                let across = dot(w, w).sqrt();
                (across - r * (1.0 - s / h), add(w.map(|v| v / across), axis, r / h))
            }
        }
    };
    // The point at which the ray first enters, by steps and bisection.
    let d = add(p, eye, -1.0);
    let (mut a, steps) = (0.0, 40_000);
    let mut b =
        (1..=steps).map(|k| 1.5 * f64::from(k) / f64::from(steps)).find(|t| outside(add(eye, d, *t)).0 < 0.0)?;
    a += b - 1.5 / f64::from(steps);
    for _ in 0..80 {
        let m = 0.5 * (a + b);
        if outside(add(eye, d, m)).0 > 0.0 { a = m } else { b = m }
    }
    let hit = add(eye, d, 0.5 * (a + b));
    let n = outside(hit).1;
    let r = add(d, n, -2.0 * dot(d, n) / dot(n, n));
    Some(add(hit, r, -hit[1] / r[1]))
}

/// Compares mirrors with rays reflected by vectors, and inverts them.
#[test]
fn mirrors_reflect_the_drawing_into_the_eye() {
    let frame = Frame::new(Rect::new(0.0, 0.0, 100.0, 100.0));
    let cases = [
        (MirrorShape::Cylinder(60.0, None), 0.0, 0.0, [10.0, -250.0, -300.0], "cylinder:radius=60"),
        (MirrorShape::Cylinder(70.0, None), -12.0, 5.0, [0.0, -300.0, -350.0], "cylinder:diameter=140,tilt=-12,lift=5"),
        (MirrorShape::Cone(130.0, 200.0), 0.0, 0.0, [0.0, -600.0, 0.0], "cone:radius=130,height=200"),
        (
            MirrorShape::Cone(130.0, 200.0),
            6.0,
            -9.0,
            [20.0, -600.0, -60.0],
            "cone:radius=130,height=200,tilt=6,lift=-9",
        ),
        (MirrorShape::Sphere(250.0), 0.0, 0.0, [-40.0, -300.0, -600.0], "sphere:radius=250"),
    ];
    for (shape, tilt, lift, eye, text) in cases {
        let anchor =
            if matches!(shape, MirrorShape::Cylinder(..)) { Point::new(50.0, 100.0) } else { Point::new(50.0, 50.0) };
        let at = format!("{},{}", anchor.x + eye[0], anchor.y + eye[1]);
        let distance = (-eye[2]).to_string();
        // An eye straight above the mirror has no distance.
        let mut args = vec![("mirror", text), ("foot", "70,-30")];
        if eye[2] < 0.0 {
            args.extend([("distance", &*distance), ("eye", &at)]);
        } else {
            args.push(("eye-height", "600"));
        }
        let m = ENTRY.build_from(&Args::from_pairs(&args), &frame).unwrap_or_else(|e| panic!("{text}: {e}")).map;
        let back = m.inverse().unwrap();
        // The picture is square to the line from the eye to its middle.
        let dot = |a: Space, b: Space| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
        let unit = |a: Space| a.map(|v| v / dot(a, a).sqrt());
        let mut middle: Space = match shape {
            MirrorShape::Sphere(r) => [0.0, -r, 0.0],
            _ => [0.0; 3],
        };
        let sight = unit(std::array::from_fn(|i| middle[i] - eye[i]));
        let right = if sight[2].hypot(sight[0]) < 1e-9 { [1.0, 0.0, 0.0] } else { unit([sight[2], 0.0, -sight[0]]) };
        let down = [
            sight[1] * right[2] - sight[2] * right[1],
            sight[2] * right[0] - sight[0] * right[2],
            sight[0] * right[1] - sight[1] * right[0],
        ];
        let mut raised = lift;
        if let MirrorShape::Sphere(r) = shape {
            raised -= 0.5 * r * (1.0 + (0.5 * sight[1].asin()).sin());
        }
        middle = std::array::from_fn(|i| middle[i] - down[i] * raised);
        let mut seen = 0;
        for p in grid() {
            let at: Space =
                std::array::from_fn(|i| middle[i] + right[i] * (p.x - anchor.x) + down[i] * (p.y - anchor.y));
            // At the tip of a cone there is no direction.
            if matches!(shape, MirrorShape::Cone(..)) && p.distance(Point::new(50.0, 50.0)) < 25.0 {
                continue;
            }
            let want = traced(shape, tilt, eye, at).unwrap();
            let want = Point::new(70.0 + want[0], -30.0 - want[2]);
            let got = m.point(p);
            let size = want.to_vec2().hypot().max(100.0);
            assert!(got.distance(want) < 1e-9 * size, "{text} {p:?}: {got:?} {want:?}");
            let p2 = back.point(got);
            assert!(p2.distance(p) < 1e-7, "{text} {p:?}: {p2:?}");
            seen += 1;
        }
        assert!(seen > 80);
    }
    // An eye at infinity is the limit of far ones.
    let far = |d: f64| {
        let v = [0.2, -1.0, 1.1].map(|v: f64| v / (0.04f64 + 1.0 + 1.21).sqrt());
        let (eye, distance) = (format!("{},{}", 50.0 + v[0] * d, 100.0 + v[1] * d), (v[2] * d).to_string());
        let all = [("mirror", "cylinder:radius=80,tilt=-12"), ("distance", &*distance), ("eye", &*eye)];
        build(&all).unwrap().map.point((30.0, 20.0).into())
    };
    let at = build(&[("mirror", "cylinder:radius=80,tilt=-12"), ("eye", "inf:0.2,-1,1.1")]).unwrap().map;
    assert!(limit(far).distance(at.point((30.0, 20.0).into())) < 1e-7);
}

/// Compares what a view hides with what rays from the camera meet first on a mesh of the sheet.
#[test]
fn a_view_hides_what_lies_behind_other_parts_of_the_sheet() {
    const N: usize = 100;
    let index = |i: usize, j: usize| j * (N + 1) + i;
    let on_sheet = |i: usize, j: usize| Point::new(i as f64 * 100.0 / N as f64, j as f64 * 100.0 / N as f64);
    let minus = |a: Space, b: Space| -> Space { std::array::from_fn(|i| a[i] - b[i]) };
    let dot = |a: Space, b: Space| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
    let cross = |a: Space, b: Space| -> Space {
        std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
    };
    let mut counts = [0, 0];
    for (surface, camera) in [
        (&[("push", "1,1:165%"), ("degree", "2x2")][..], [250.0, -80.0, 20.0]),
        (&[("push", "1,0:135%"), ("push", "0,1:125%"), ("degree", "1x1")], [300.0, -90.0, 70.0]),
        (&[("push", "1,1:185%"), ("push", "2,2:60%"), ("degree", "3x3")], [170.0, -40.0, -30.0]),
        (&[("onto", "cylinder:radius=80")], [460.0, -125.0, -100.0]),
        (&[("onto", "cone:top-radius=90,bottom-radius=75")], [-320.0, -90.0, -60.0]),
        (&[("onto", "sphere:radius=95")], [310.0, -260.0, -40.0]),
    ] {
        let view = camera.map(|v| v.to_string()).join(",");
        let built = build(&[surface, &[("distance", "300"), ("view", &view)]].concat()).unwrap();
        let hidden = built.hidden.expect("folds")(0.01).to_bez_path(1e-3);
        let (space, from) = (built.space.unwrap(), [camera[0], camera[1], -camera[2]]);
        let grid = (0..=N).flat_map(|j| (0..=N).map(move |i| (i, j)));
        let mesh: Vec<Space> = grid.map(|(i, j)| minus((space.place)(on_sheet(i, j)).unwrap(), from)).collect();
        let cells = || (0..N).flat_map(|j| (0..N).map(move |i| (i, j)));
        let triangles: Vec<[usize; 3]> = cells()
            .flat_map(|(i, j)| {
                let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect();
        // The triangle abc meets the segment from the camera to p if p is a positive combination of its corners, with a sum above 1.
        let is_hidden = |k: usize| {
            triangles.iter().filter(|t| !t.contains(&k)).any(|t| {
                let [a, b, c] = t.map(|k| mesh[k]);
                let volume = dot(a, cross(b, c));
                let shares = [[b, c], [c, a], [a, b]].map(|[u, v]| dot(mesh[k], cross(u, v)) / volume);
                shares.iter().all(|s| *s >= 0.0) && shares.iter().sum::<f64>() > 1.0 + 1e-9
            })
        };
        for (i, j) in cells().filter(|(i, j)| i % 8 == 3 && j % 8 == 5) {
            let truth = is_hidden(index(i, j));
            let around = [(i - 2, j), (i + 2, j), (i, j - 2), (i, j + 2), (i - 2, j - 2), (i + 2, j + 2)];
            // Points near the edge of the hidden part do not count, since the mesh has straight edges.
            if around.iter().all(|(i, j)| is_hidden(index(*i, *j)) == truth) {
                counts[usize::from(truth)] += 1;
                let winding = hidden.winding(on_sheet(i, j));
                assert_eq!(winding % 2 != 0, truth, "{surface:?} at {:?}", on_sheet(i, j));
            }
        }
    }
    assert!(counts[0] > 300 && counts[1] > 60, "{counts:?}");
}
