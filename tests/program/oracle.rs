//! Every sample under several deformations: the distance between the output and the densely sampled exact image.
//!
//! The oracle is independent: it evaluates circles, ellipses and arcs by their definition, samples the map densely, and finds
//! nearest points by brute force and golden-section search. It shares no code with the refitting.

use crate::support::{artwork, expect_code, sample};
use pathwarp::Seg;
use pathwarp::deform::Registry;
use pathwarp::kurbo::{Point, Vec2};
use pathwarp::map::Map;
use pathwarp::param::{Args, Frame};
use pathwarp_svg::{Document, ReadOptions, Selection};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Samples per source segment.
const TRUE_SAMPLES: usize = 400;
/// Samples per output segment.
const OUT_SAMPLES: usize = 200;

/// A point of a segment, from the definition of each kind.
fn at(seg: &Seg, t: f64) -> Point {
    let mix = |a: Vec2, b: Vec2| a * (1.0 - t) + b * t;
    match seg {
        Seg::Line(l) => mix(l.p0.to_vec2(), l.p1.to_vec2()).to_point(),
        Seg::Quad(q) => {
            let (a, b) = (mix(q.p0.to_vec2(), q.p1.to_vec2()), mix(q.p1.to_vec2(), q.p2.to_vec2()));
            mix(a, b).to_point()
        }
        Seg::Cubic(c) => {
            let [a, b, c, d] = [c.p0, c.p1, c.p2, c.p3].map(Point::to_vec2);
            let (ab, bc, cd) = (mix(a, b), mix(b, c), mix(c, d));
            mix(mix(ab, bc), mix(bc, cd)).to_point()
        }
        Seg::Arc(a) => {
            let th = a.start + t * a.sweep;
            a.center + a.a * th.cos() + a.b * th.sin()
        }
    }
}

/// A curve as a function of [0, 1].
type Curve<'a> = Box<dyn Fn(f64) -> Point + 'a>;

/// The distance from `p` to a run of curves; `hint` is the index of the last nearest one, whose neighbours are tried first. The
/// search is local (coarse samples, then golden section), so it may overestimate the distance but never underestimate it.
fn nearest(curves: &[Curve<'_>], coarse: &[Vec<Point>], p: Point, hint: &mut usize, good: f64) -> f64 {
    let n = curves.len();
    let h = *hint;
    let mut best = f64::INFINITY;
    let around = (1..=n / 2).flat_map(|away| [(h + away) % n, (h + n - away) % n]);
    for i in std::iter::once(h).chain(around) {
        let (k, d) = coarse[i]
            .iter()
            .map(|q| q.distance(p))
            .enumerate()
            .fold((0, f64::INFINITY), |m, x| if x.1 < m.1 { x } else { m });
        let spacing = coarse[i].windows(2).map(|w| w[0].distance(w[1])).fold(0.0, f64::max);
        if d - spacing > best {
            continue;
        }
        let last = (coarse[i].len() - 1) as f64;
        let (mut lo, mut hi) = (((k as f64 - 1.0) / last).max(0.0), ((k as f64 + 1.0) / last).min(1.0));
        let f = |t: f64| curves[i](t).distance(p);
        for _ in 0..60 {
            let (a, b) = (lo + 0.382 * (hi - lo), hi - 0.382 * (hi - lo));
            if f(a) < f(b) { hi = b } else { lo = a }
        }
        let found = d.min(f(0.5 * (lo + hi)));
        if found < best {
            (best, *hint) = (found, i);
        }
        if best <= good {
            break;
        }
    }
    best
}

/// The largest distance between the image of `source` under `map` and `out`, both ways.
fn hausdorff(source: &[Seg], map: &dyn Map, out: &[Seg], good: f64) -> f64 {
    let truth: Vec<Curve<'_>> = source.iter().map(|s| Box::new(|t| map.point(at(s, t))) as Curve<'_>).collect();
    let written: Vec<Curve<'_>> = out.iter().map(|s| Box::new(|t| at(s, t)) as Curve<'_>).collect();
    let sampled = |c: &[Curve<'_>], n: usize| -> Vec<Vec<Point>> {
        c.iter().map(|f| (0..=n).map(|i| f(i as f64 / n as f64)).collect()).collect()
    };
    let (true_fine, out_fine) = (sampled(&truth, TRUE_SAMPLES), sampled(&written, OUT_SAMPLES));
    let (true_coarse, out_coarse) = (sampled(&truth, 40), sampled(&written, 40));
    let mut worst: f64 = 0.0;
    let mut hint = 0;
    for p in true_fine.iter().flatten() {
        worst = worst.max(nearest(&written, &out_coarse, *p, &mut hint, good));
    }
    hint = 0;
    for p in out_fine.iter().flatten() {
        worst = worst.max(nearest(&truth, &true_coarse, *p, &mut hint, good));
    }
    worst
}

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
    // Compare painted shapes only: a clip path may be written in another form that clips the same, which the pictures test.
    let everything = Selection::default();
    let shapes: Vec<_> = source.selected(&everything).collect();
    let images: Vec<_> = warped.selected(&everything).collect();
    assert_eq!(shapes.len(), images.len(), "{name}: every shape is still there");
    let reported = report["inputs"][0]["shapes"].as_array().unwrap();
    let said = reported.iter().map(|s| s["max_error"].as_f64().unwrap()).fold(0.0, f64::max);
    let mut worst: f64 = 0.0;
    for (s, w) in shapes.iter().zip(&images) {
        let segs = |o: &pathwarp::Outline| -> Vec<Seg> { o.segs().copied().collect() };
        let d = hausdorff(&segs(&s.outline), &*map, &segs(&w.outline), 0.2 * promised);
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
        let segs: Vec<Seg> = warped.path("c").unwrap().outline.segs().copied().collect();
        let written: Vec<Curve<'_>> = segs.iter().map(|s| Box::new(|t| at(s, t)) as Curve<'_>).collect();
        let coarse: Vec<Vec<Point>> =
            written.iter().map(|f| (0..=40).map(|i| f(f64::from(i) / 40.0)).collect()).collect();
        let mut hint = 0;
        for i in 0..4000 {
            let th = f64::from(i) * std::f64::consts::TAU / 4000.0;
            let p = map.point(Point::new(12.0 + 9.0 * th.cos(), 11.0 + 9.0 * th.sin()));
            let d = nearest(&written, &coarse, p, &mut hint, 0.0);
            assert!(d <= tolerance, "{d} at {th}, {tolerance} promised");
        }
    }
}

/// The oracle can fail: it finds a shape that is moved by twice the tolerance.
#[test]
fn the_oracle_sees_a_shift() {
    let doc = read(&sample("monogram.svg"));
    let identity = pathwarp::map::AffineMap::IDENTITY;
    for s in doc.shapes() {
        let segs: Vec<Seg> = s.outline.segs().copied().collect();
        let moved: Vec<Seg> =
            segs.iter().map(|g| g.transformed(pathwarp::kurbo::Affine::translate((0.02, 0.0)))).collect();
        let d = hausdorff(&segs, &identity, &moved, 0.0);
        assert!(d > 0.015 && d <= 0.02 + 1e-9, "{d}");
    }
}
