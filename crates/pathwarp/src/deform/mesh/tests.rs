//! Quilts against de Casteljau's algorithm patch by patch, and Photoshop's warps against the styles.

use super::*;
use crate::check;
use crate::deform::Deformation as _;
use crate::map::Map;
use crate::param::{Args, Frame};
use kurbo::{CubicBez, ParamCurve, Vec2};

#[test]
fn is_sound() {
    let faults = check::entry(&ENTRY);
    assert!(faults.is_empty(), "{faults:#?}");
}

fn with(name: &str, text: &str, more: &[(&str, &str)]) -> Result<Built, Error> {
    let mut args = Args::from_pairs(&[(name, "file.json")]);
    for (n, v) in more {
        args.push(n, *v);
    }
    args.resolve_files(ENTRY.info().params, |_| Ok(text.to_owned())).unwrap();
    ENTRY.build_from(&args, &Frame::new(Rect::new(10.0, 20.0, 110.0, 80.0)))
}

/// Returns the points of two columns and two rows of patches, some of them moved.
fn points() -> Vec<Vec<(f64, f64)>> {
    (0..7)
        .map(|j| {
            (0..7)
                .map(|i| {
                    let (x, y) = (f64::from(i) * 20.0, f64::from(j) * 10.0);
                    (x + 3.0 * f64::from((i * j) % 5), y - 2.0 * f64::from((i + 2 * j) % 4))
                })
                .collect()
        })
        .collect()
}

fn json(points: &[Vec<(f64, f64)>], extra: &str) -> String {
    let rows: Vec<String> = points
        .iter()
        .map(|r| format!("[{}]", r.iter().map(|(x, y)| format!("[{x},{y}]")).collect::<Vec<_>>().join(",")))
        .collect();
    format!("{{ {extra} \"points\": [{}] }}", rows.join(","))
}

#[test]
fn every_patch_is_its_net() {
    let p = points();
    let m = with("mesh", &json(&p, "\"region\": [0,0,120,60], \"x\": [0.25], \"y\": [0.5],"), &[]).unwrap().map;
    for (i, j, x0, x1, y0, y1) in [
        (0, 0, 0.0, 30.0, 0.0, 30.0),
        (1, 0, 30.0, 120.0, 0.0, 30.0),
        (0, 1, 0.0, 30.0, 30.0, 60.0),
        (1, 1, 30.0, 120.0, 30.0, 60.0),
    ] {
        for (u, v) in [(0.01, 0.01), (0.3, 0.7), (0.5, 0.99), (0.99, 0.4)] {
            let row = |r: usize| {
                let q: Vec<Point> = (0..4).map(|c| p[3 * j + r][3 * i + c].into()).collect();
                CubicBez::new(q[0], q[1], q[2], q[3]).eval(u)
            };
            let expected = CubicBez::new(row(0), row(1), row(2), row(3)).eval(v);
            let got = m.point(Point::new(x0 + u * (x1 - x0), y0 + v * (y1 - y0)));
            assert!(got.distance(expected) < 1e-10, "{i} {j} {u} {v}: {got:?} {expected:?}");
        }
    }
}

/// After smoothing, both sides of every joint have the same derivative, also where four patches meet. Without it, kinks are reported.
#[test]
fn joints_are_smoothed() {
    let text = json(&points(), "\"region\": [0,0,120,60], \"x\": [0.25],");
    let rough = with("mesh", &text, &[]).unwrap();
    assert!(rough.explanation.warnings[0].contains("`smooth`"), "{:?}", rough.explanation.warnings);
    let smooth = with("mesh", &text, &[("smooth", "true")]).unwrap();
    assert!(smooth.explanation.warnings.is_empty());
    let jump = |m: &dyn Map, p: (f64, f64), q: (f64, f64)| {
        let (a, b) = (m.branch(p.into()).unwrap(), m.branch(q.into()).unwrap());
        let at = Point::from(p).midpoint(Point::from(q));
        let (a, b) = (a.jet(at), b.jet(at));
        assert!(a.p.distance(b.p) < 1e-10);
        (a.dx - b.dx).hypot().max((a.dy - b.dy).hypot())
    };
    let e = 1e-3;
    let mut rough_jump: f64 = 0.0;
    for t in [5.0, 17.0, 29.0, 30.5, 44.0, 57.0] {
        assert!(jump(&*smooth.map, (30.0 - e, t), (30.0 + e, t)) < 1e-9, "{t}");
        assert!(jump(&*smooth.map, (2.0 * t, 30.0 - e), (2.0 * t, 30.0 + e)) < 1e-9, "{t}");
        rough_jump = rough_jump.max(jump(&*rough.map, (30.0 - e, t), (30.0 + e, t)));
    }
    assert!(rough_jump > 0.1);
}

fn psd(style: &str, rest: &str) -> String {
    format!(
        "{{ \"warps\": [{{ \"layer\": \"Logo\", \"style\": \"{style}\", \"value\": 40.0, \"perspective\": 10.0, \
         \"perspective_other\": -20.0, \"vertical\": true{rest} }}] }}"
    )
}

#[test]
fn photoshops_warps_are_the_styles_and_nets() {
    let frame = Frame::new(Rect::new(10.0, 20.0, 110.0, 80.0));
    let arch = with("psd", &psd("warpArch", ""), &[]).unwrap();
    let args = [("style", "arch"), ("bend", "40%"), ("horizontal", "10%"), ("vertical", "-20%"), ("axis", "vertical")];
    let ours = crate::deform::Registry::builtin();
    let ours = ours.get("warp").unwrap().build_from(&Args::from_pairs(&args), &frame).unwrap();
    let rest: Vec<Vec<(f64, f64)>> = (0..4)
        .map(|j| {
            (0..4)
                .map(|i| (f64::from(i) * 30.0 + if (i, j) == (1, 1) { 9.0 } else { 0.0 }, f64::from(j) * 10.0))
                .collect()
        })
        .collect();
    let mesh = format!(", \"mesh\": {}", json(&rest, "\"region\": [0,0,90,30], \"fit\": true,"));
    let custom = with("psd", &psd("warpCustom", &mesh), &[("layer", "Logo")]).unwrap();
    for p in [(10.0, 20.0), (40.0, 33.0), (77.0, 71.0)].map(Point::from) {
        assert!(arch.map.point(p).distance(ours.map.point(p)) < 1e-10);
        // The inner point moved a tenth of the width, and counts B1(u)·B1(v) there.
        let (u, v) = ((p.x - 10.0) / 100.0, (p.y - 20.0) / 60.0);
        let b = |t: f64| 3.0 * t * (1.0 - t) * (1.0 - t);
        assert!(custom.map.point(p).distance(p + Vec2::new(10.0 * b(u) * b(v), 0.0)) < 1e-10, "{p:?}");
    }
    let fault = |r: Result<Built, Error>| r.map(|_| ()).unwrap_err().to_string();
    assert!(fault(with("psd", &psd("warpCylinder", ""), &[])).contains("warpCylinder"));
    assert!(fault(with("psd", &psd("warpArc", ""), &[("layer", "Other")])).contains("`Logo`"));
    assert!(fault(with("psd", "{ \"warps\": [] }", &[])).contains("no warped layer"));
}

/// A file written by hand has one warp, with the keys of Photoshop's descriptors that are not zero.
#[test]
fn warps_written_by_hand() {
    let flag = with("psd", "{ \"warpStyle\": \"warpFlag\", \"warpValue\": 50 }", &[]).unwrap();
    // The flag's formula on this box: y + 2·b·h·(3u(1-u)² - 3u²(1-u)).
    for p in [(25.0, 30.0), (60.0, 70.0)].map(Point::from) {
        let u = (p.x - 10.0) / 100.0;
        let rise = 60.0 * 3.0 * u * (1.0 - u) * (1.0 - 2.0 * u);
        assert!(flag.map.point(p).distance(p + Vec2::new(0.0, rise)) < 1e-10, "{p:?}");
    }
    // A mesh on another box is laid onto the artwork.
    let points: Vec<Vec<(f64, f64)>> =
        (0..4).map(|j| (0..4).map(|i| (f64::from(i), f64::from(j) + f64::from(i))).collect()).collect();
    let mesh = format!("{{ \"style\": \"warpCustom\", \"mesh\": {} }}", json(&points, "\"region\": [0,0,3,3],"));
    let custom = with("psd", &mesh, &[]).unwrap();
    for p in [(10.0, 20.0), (60.0, 70.0)].map(Point::from) {
        let to = p + Vec2::new(0.0, 60.0 * (p.x - 10.0) / 100.0);
        assert!(custom.map.point(p).distance(to) < 1e-10, "{p:?}");
    }
    let fault = with("psd", "{ \"value\": 3 }", &[]).map(|_| ()).unwrap_err().to_string();
    assert!(fault.contains("\"style\": \"warpArc\""), "{fault}");
}

#[test]
fn a_mesh_far_from_the_artwork_is_reported() {
    let warned = |region: &str, more: &[(&str, &str)]| {
        let b = with("mesh", &json(&points(), region), more).unwrap();
        b.explanation.warnings.iter().any(|w| w.contains("`region artwork`"))
    };
    assert!(warned("\"region\": [0,0,1,1],", &[]));
    assert!(!warned("\"region\": [0,0,1,1],", &[("region", "artwork")]));
    assert!(!warned("\"region\": [20,30,100,60],", &[]));
}

#[test]
fn faults_are_named() {
    let p = points();
    let fault = |text: &str| with("mesh", text, &[]).map(|_| ()).unwrap_err().to_string();
    assert!(fault(&json(&p[..5], "")).contains("5 rows"));
    assert!(fault(&json(&p, "\"x\": [0.5, 0.7],")).contains("`x`"));
    assert!(fault(&json(&p, "\"region\": [0,0,0,5],")).contains("not a box"));
    let mut ragged = p.clone();
    ragged[2].pop();
    assert!(fault(&json(&ragged, "")).contains("row 2"));
    assert!(fault("{\"points\": 3}").contains("file.json:1:"));
    let none = ENTRY.build_from(&Args::new(), &check::frame()).map(|_| ()).unwrap_err().to_string();
    assert!(none.contains("net is needed"));
}
