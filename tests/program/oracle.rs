//! Every sample under several deformations: the distance between the output and the densely sampled exact image.

use crate::support::{artwork, expect_code, sample};
use pathwarp::deform::Registry;
use pathwarp::kurbo::{Affine, Point, Vec2};
use pathwarp::param::{Args, Frame};
use pathwarp_oracle::curves::Curved as _;
use pathwarp_oracle::{Run, distance, far};
use pathwarp_svg::{Document, ReadOptions, Selection};
use serde_json::Value;
use std::fs;
use std::path::Path;

fn read(path: &Path) -> Document {
    Document::read(&fs::read(path).unwrap(), "test", &ReadOptions::default()).unwrap()
}

/// Runs the program on a sample and checks every shape and the report. Strokes are kept and gradients fitted, so that every shape
/// of the input is one shape of the output.
fn check(name: &str, deformation: &str, args: &[(&str, &str)], tolerance: Option<&str>) {
    let dir = tempfile::tempdir().unwrap();
    let (out, report) = (dir.path().join("out.svg"), dir.path().join("r.json"));
    let mut line = vec![deformation.to_owned(), sample(name).display().to_string(), "--strokes".into(), "keep".into()];
    line.extend(["--gradients".into(), "fit".into()]);
    for (k, v) in args {
        line.extend([format!("--{k}"), (*v).to_owned()]);
    }
    line.extend(tolerance.iter().flat_map(|t| ["--tolerance".to_owned(), (*t).to_owned()]));
    line.extend([
        "-o".into(),
        out.display().to_string(),
        "--report".into(),
        report.display().to_string(),
        "--quiet".into(),
    ]);
    expect_code(0, &line);
    let report: Value = serde_json::from_slice(&fs::read(report).unwrap()).unwrap();
    let promised = report["inputs"][0]["tolerance"].as_f64().unwrap();

    let source = read(&sample(name));
    let frame = Frame::new(source.artwork_box(&Selection::default()).unwrap());
    let map = Registry::builtin().get(deformation).unwrap().build_from(&Args::from_pairs(args), &frame).unwrap().map;
    let warped = read(&out);
    // Compare painted shapes only: a clip path may be written in another form that clips alike, which the pictures test.
    let everything = Selection::default();
    let shapes: Vec<_> = source.selected(&everything).collect();
    let images: Vec<_> = warped.selected(&everything).collect();
    assert_eq!(shapes.len(), images.len(), "{name}: every shape is still there");
    let reported = report["inputs"][0]["shapes"].as_array().unwrap();
    let said = reported.iter().map(|s| s["max_error"].as_f64().unwrap()).fold(0.0, f64::max);
    let mut worst: f64 = 0.0;
    for (s, w) in shapes.iter().zip(&images) {
        let d = distance(&*s.outline, &*map, &*w.outline, 400, promised);
        assert!(d <= promised, "{name}, {deformation} {args:?}: {} is {d} off, {promised} is promised", s.id);
        worst = worst.max(d);
    }
    assert!(said <= promised, "{name}: {said} reported, {promised} promised");
    assert!(worst <= said.max(0.2 * promised) * 1.05, "{name}: {worst} found, {said} reported");
}

const CAGE: &str = "M 10,90 C 60,130 60,60 95,85 C 75,60 115,40 90,15 C 60,-25 40,45 5,10 C 25,40 -10,60 10,90 Z";

#[test]
fn shaper_default_tolerance() {
    for name in artwork() {
        check(&name, "shaper", &[("shaper", CAGE)], None);
    }
}

#[test]
fn shaper_fine() {
    for name in ["icon.svg", "badge.svg", "monogram.svg", "tiles.svg"] {
        check(name, "shaper", &[("shaper", CAGE), ("target", "10%,100% 70%,80%")], Some("1e-4"));
    }
}

#[test]
fn shaper_projective_wrappers() {
    for name in ["icon.svg", "lettering.svg", "logo.svg"] {
        let args = [
            ("shaper", CAGE),
            ("base", "0%,110% 110%,100% 90%,-10% 5%,-5%"),
            ("target", "0%,100% 100%,90% 70%,10% 20%,0%"),
        ];
        check(name, "shaper", &args, None);
    }
}

#[test]
fn projective_and_affine() {
    for name in artwork() {
        check(&name, "projective", &[("target", "0%,100% 100%,90% 70%,10% 20%,0%")], None);
        check(&name, "affine", &[("rotate", "20"), ("scale-x", "1.3"), ("skew-x", "12")], None);
    }
}

/// Circles and ellipses given as basic shapes, checked against sine and cosine rather than against the reader's geometry.
#[test]
fn circles_count_from_the_true_circle() {
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 24 24'><circle id='c' cx='12' cy='11' r='9'/><path id='a' d='M3 20 a4 2 30 1 1 5 1'/></svg>";
    let map = |tolerance: f64| {
        let doc = Document::read(svg.as_bytes(), "t", &ReadOptions::default()).unwrap();
        let frame = Frame::new(doc.view_box());
        let built = Registry::builtin()
            .get("shaper")
            .unwrap()
            .build_from(&Args::from_pairs(&[("shaper", CAGE)]), &frame)
            .unwrap();
        let options = pathwarp_svg::WarpOptions::new(pathwarp::refit::Options::new(tolerance));
        (doc.warp(&built.map, &options).unwrap().svg, built.map)
    };
    for tolerance in [1e-2, 1e-4, 1e-6] {
        let (out, map) = map(tolerance);
        let warped = Document::read(out.as_bytes(), "t", &ReadOptions::default()).unwrap();
        let written = warped.path("c").unwrap().outline.curves();
        let circle = |i: u32| Vec2::from_angle(f64::from(i) * std::f64::consts::TAU / 4000.0);
        let exact: Vec<Point> = (0..4000).map(|i| map.point(Point::new(12.0, 11.0) + circle(i) * 9.0)).collect();
        let (d, at) = far(&exact, &[Run::of(&written).sampled(200, tolerance)]);
        assert!(d <= tolerance, "{d} at {at:?}, {tolerance} promised");
    }
}

/// The oracle can fail: it finds a shape that is moved by twice the tolerance.
#[test]
fn the_oracle_sees_a_shift() {
    let doc = read(&sample("monogram.svg"));
    let identity = pathwarp::map::AffineMap::IDENTITY;
    for s in doc.shapes() {
        let moved = s.outline.transformed(Affine::translate((0.02, 0.0)));
        let d = distance(&*s.outline, &identity, &moved, 400, 0.02);
        assert!(d > 0.015 && d <= 0.02 + 1e-9, "{d}");
    }
}
