//! Exact images of curves as splines with weights, against equations (3), (5) and (9) of Sánchez-Reyes and Chacón.

use super::dxf_reader::{Dxf, Entity};
use crate::support::{expect_code, pathwarp_in};
use pathwarp::kurbo::Point;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

const MM_PER_PX: f64 = 25.4 / 96.0;

/// A triangle of degree 1 whose third point is pushed to 160 % of its distance from the eye: δ is 1, 1 and 1/1.6 at its points.
const TRIANGLE: [&str; 9] = [
    "anamorph",
    "--frame",
    "0,0,100,100",
    "--eye",
    "50,150",
    "--reference",
    "0,100 100,100 50,-60",
    "--push",
    "0,0,1:160%",
];

/// δ at a point, linear between the triangle's points. It depends on y alone.
fn delta(y: f64) -> f64 {
    1.0 + (100.0 - y) / 160.0 * (1.0 / 1.6 - 1.0)
}

fn projected(x: f64, y: f64) -> [f64; 2] {
    [50.0 + (x - 50.0) / delta(y), 150.0 + (y - 150.0) / delta(y)]
}

fn run(folder: &Path, args: &[&str]) {
    let out = pathwarp_in(folder, &[&["map"], args].concat(), b"");
    assert_eq!(out.status.code(), Some(0), "{args:?}: {}", String::from_utf8_lossy(&out.stderr));
}

fn splines(folder: &Path, file: &str) -> Vec<Entity> {
    let file = Dxf::read(&fs::read_to_string(folder.join(file)).unwrap());
    assert!(file.entities.iter().all(|e| e.kind == "SPLINE"));
    file.entities
}

/// The point of a spline of a DXF whose knots are 0, 1, 2 and so on, in px.
fn at(e: &Entity, span: usize, t: f64) -> [f64; 2] {
    let [x, y, z] = e.in_span(e.number(71) as usize * (span + 1), span as f64 + t);
    assert_eq!(z, 0.0);
    [x / MM_PER_PX, -y / MM_PER_PX]
}

fn near(a: [f64; 2], b: [f64; 2]) {
    assert!(Point::from((a[0], a[1])).distance(Point::from((b[0], b[1]))) < 1e-7, "{a:?} {b:?}");
}

/// Equation (9): a NURBS curve keeps degree and knots; its points move along rays, and its weights become w·δ.
#[test]
fn a_nurbs_curve_keeps_its_knots_under_a_projective_map() {
    let dir = tempfile::tempdir().unwrap();
    let points = [[10.0, 20.0, 0.0], [30.0, 80.0, 0.0], [60.0, 10.0, 0.0], [90.0, 70.0, 0.0], [40.0, 95.0, 0.0]];
    let (knots, weights) = ([0.0, 0.0, 0.0, 0.0, 0.25, 1.0, 1.0, 1.0, 1.0], [1.0, 2.0, 0.5, 1.0, 3.0]);
    let curve = json!({"curves": [{"name": "c", "degree": 3, "points": points, "knots": knots, "weights": weights}]});
    fs::write(dir.path().join("in.json"), curve.to_string()).unwrap();
    run(dir.path(), &[&TRIANGLE[..], &["--exact", "in.json", "-o", "out.json"]].concat());
    let out: Value = serde_json::from_slice(&fs::read(dir.path().join("out.json")).unwrap()).unwrap();
    let out = &out["curves"][0];
    assert_eq!((&out["name"], &out["degree"], &out["knots"]), (&json!("c"), &json!(3), &json!(knots)));
    let scale = out["weights"][0].as_f64().unwrap() / delta(20.0);
    for (i, ([x, y, _], w)) in points.into_iter().zip(weights).enumerate() {
        let found = [0, 1].map(|k| out["points"][i][k].as_f64().unwrap());
        near(found, projected(x, y));
        assert!((out["weights"][i].as_f64().unwrap() - scale * w * delta(y)).abs() < 1e-12);
    }
    // As a spline of a DXF, on a layer of its name, it has two spans and as many points.
    run(dir.path(), &[&TRIANGLE[..], &["--exact", "in.json", "-o", "out.dxf"]].concat());
    let e = &splines(dir.path(), "out.dxf")[0];
    assert_eq!((e.text(8), e.number(71), e.number(73), e.all(40)), (Some("c"), 3.0, 5.0, knots.to_vec()));
    for (x, i) in e.all(10).iter().zip(0..) {
        assert!((x / MM_PER_PX - projected(points[i][0], points[i][1])[0]).abs() < 1e-6);
    }
}

/// A contour of a line, a cubic and an arc is one closed spline of degree 3, with weights.
#[test]
fn a_contour_is_one_spline_with_weights() {
    let dir = tempfile::tempdir().unwrap();
    let path = "M10,20 H50 C60,20 70,60 50,60 A20,20 0 0 1 10,60 Z";
    run(dir.path(), &[&TRIANGLE[..], &["--exact", path, "-o", "out.dxf"]].concat());
    let all = splines(dir.path(), "out.dxf");
    let [e] = &all[..] else { panic!("{all:?}") };
    let (n, knots) = (e.number(73) as usize, e.all(40));
    assert_eq!((e.number(71), e.all(41).len()), (3.0, n));
    assert!(e.all(41).iter().all(|w| *w > 0.0));
    let [xs, ys] = [e.all(10), e.all(20)];
    assert_eq!((xs[0], ys[0]), (xs[n - 1], ys[n - 1]));
    let spans = *knots.last().unwrap() as usize;
    for i in 0..=20 {
        let t = f64::from(i) / 20.0;
        near(at(e, 0, t), projected(10.0 + 40.0 * t, 20.0));
        let b = [(1.0 - t).powi(3), 3.0 * t * (1.0 - t).powi(2), 3.0 * t * t * (1.0 - t), t.powi(3)];
        let x: f64 = b.iter().zip([50.0, 60.0, 70.0, 50.0]).map(|(b, v)| b * v).sum();
        let y: f64 = b.iter().zip([20.0, 20.0, 60.0, 60.0]).map(|(b, v)| b * v).sum();
        near(at(e, 1, t), projected(x, y));
        // Between the cubic and the line that closes, every source is on the circle: ŷ gives δ and with it the source.
        for span in 2..spans - 1 {
            let [u, v] = at(e, span, t);
            let k = 0.375 / 160.0;
            let delta = (1.0 + 50.0 * k) / (1.0 - (v - 150.0) * k);
            let source = Point::new(50.0 + (u - 50.0) * delta, 150.0 + (v - 150.0) * delta);
            assert!((source.distance(Point::new(30.0, 60.0)) - 20.0).abs() < 1e-7, "{source:?}");
        }
    }
}

/// Equation (5): p = 3 under a lattice of degree 1 × 1 gives 3·(1 + 1); its image is the bilinear formula of the cubic's points.
#[test]
fn degrees_rise_under_lattices_up_to_nine() {
    let dir = tempfile::tempdir().unwrap();
    let ffd =
        |degree: &'static str| ["ffd", "--frame", "0,0,100,100", "--extend", "--degree", degree, "--move", "1,1:40,20"];
    let cubic = "M0,0 C40,90 60,-30 100,80";
    run(dir.path(), &[&ffd("1x1")[..], &["--exact", cubic, "-o", "out.dxf"]].concat());
    let e = &splines(dir.path(), "out.dxf")[0];
    assert_eq!((e.number(71), e.number(73), e.all(41).len()), (6.0, 7.0, 0));
    for i in 0..=20 {
        let t = f64::from(i) / 20.0;
        let b = [3.0 * t * (1.0 - t).powi(2), 3.0 * t * t * (1.0 - t), t.powi(3)];
        let (x, y) = (40.0 * b[0] + 60.0 * b[1] + 100.0 * b[2], 90.0 * b[0] - 30.0 * b[1] + 80.0 * b[2]);
        let both = x / 100.0 * (y / 100.0);
        near(at(e, 0, t), [x + 40.0 * both, y + 20.0 * both]);
    }
    // Degree 3·(2 + 2) is too high for CAD programs, and fits into JSON.
    let (dxf, json) = (dir.path().join("h.dxf"), dir.path().join("h.json"));
    let high = |to: &Path| {
        let args = [&["map"], &ffd("2x2")[..], &["--exact", cubic, "-o"]].concat();
        args.into_iter().map(String::from).chain([to.display().to_string()]).collect::<Vec<_>>()
    };
    let args = high(&dxf);
    let (_, said) = expect_code(2, &args.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(["curve 1", "degree 12", "at most 9", ".json"].iter().all(|w| said.contains(w)), "{said}");
    assert!(!dxf.exists());
    let args = high(&json);
    expect_code(0, &args.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(fs::read_to_string(json).unwrap().contains("\"degree\":12"));
}

/// Curves in space: p̂ = p/δ(p) from the eye at the origin, with δ linear over a tetrahedron. Polygons and files to read are refused.
#[test]
fn curves_in_space_are_splines() {
    let dir = tempfile::tempdir().unwrap();
    let arc = json!({"curves": [{"name": "arc", "degree": 2, "points": [[4, 0, 9], [4, 4, 9], [0, 4, 9]], "weights": [1, 0.5f64.sqrt(), 1]}]});
    fs::write(dir.path().join("arc.json"), arc.to_string()).unwrap();
    let tool = ["--eye", "0,0,0", "--reference", "0,0,4 8,0,4 0,8,4 0,0,12", "--push", "0,0,0,1:200%"];
    let solid = |args: &[&str]| pathwarp_in(dir.path(), &[&["solid", "anamorph"], args, &tool].concat(), b"");
    assert_eq!(solid(&["arc.json", "-o", "out.dxf"]).status.code(), Some(0));
    let e = &splines(dir.path(), "out.dxf")[0];
    assert_eq!((e.number(71), e.text(8)), (2.0, Some("arc")));
    for i in 0..=20 {
        let [x, y, z] = e.in_span(2, f64::from(i) / 20.0);
        // At z = 9, the fourth point has 5/8 of the weight: δ = 1 − 5/16.
        let p = [x, y, z].map(|v| v * (1.0 - 5.0 / 16.0));
        assert!((p[2] - 9.0).abs() < 1e-8 && (p[0].hypot(p[1]) - 4.0).abs() < 1e-8, "{p:?}");
    }
    for (from, to, said) in [("out.dxf", "x.json", "not read"), ("m.obj", "x.dxf", "polygons")] {
        fs::write(dir.path().join("m.obj"), "v 0 0 9\nv 1 0 9\nv 0 1 9\nf 1 2 3\n").unwrap();
        let out = solid(&[from, "-o", to]);
        let message = String::from_utf8_lossy(&out.stderr);
        assert!(out.status.code() != Some(0) && message.contains(said), "{message}");
    }
}
