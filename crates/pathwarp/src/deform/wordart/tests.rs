//! Compares the guides with the standard's formulas, written out here independently for one box.

use super::*;
use crate::check;
use crate::deform::Deformation as _;
use crate::map::Map;
use crate::param::{Args, Frame};
use kurbo::{CubicBez, Line, ParamCurve, ParamCurveArclen, PathSeg, Point, QuadBez};

#[test]
fn is_sound() {
    let faults = check::entry(&ENTRY);
    assert!(faults.is_empty(), "{faults:#?}");
}

const W: f64 = 300.0;
const H: f64 = 120.0;

fn build(pairs: &[(&str, &str)]) -> Result<Built, Error> {
    ENTRY.build_from(&Args::from_pairs(pairs), &Frame::new(Rect::new(0.0, 0.0, W, H)))
}

fn default_guides(name: &str) -> Guides {
    let preset = TextShape::builtin().into_iter().find(|p| p.name == name).unwrap();
    let values: Vec<f64> = preset.adj.iter().map(|a| a.default).collect();
    preset.guides(W, H, &values).unwrap()
}

/// First and last point of a guide.
type Ends = [(f64, f64); 2];

fn ends(segs: &[Seg]) -> Ends {
    let (a, b) = (segs.first().unwrap().start(), segs.last().unwrap().end());
    [(a.x, a.y), (b.x, b.y)]
}

/// Compares the ends of every guide with the formulas of presetTextWarpDefinitions, for the default adjust values.
#[test]
fn the_guides_ends_are_the_formulas() {
    // A circle lacks 1/60000 of a degree, in the standard's parametrisation; ends are given as fractions of w and h.
    let pairs: &[(&str, &[Ends])] = &[
        ("plain", &[[(0.0, 0.0), (1.0, 0.0)], [(0.0, 1.0), (1.0, 1.0)]]),
        ("stop", &[[(0.0, 0.25), (1.0, 0.25)], [(0.0, 0.75), (1.0, 0.75)]]),
        ("triangle", &[[(0.0, 0.5), (1.0, 0.5)], [(0.0, 1.0), (1.0, 1.0)]]),
        ("triangle-inverted", &[[(0.0, 0.0), (1.0, 0.0)], [(0.0, 0.5), (1.0, 0.5)]]),
        ("chevron", &[[(0.0, 0.25), (1.0, 0.25)], [(0.0, 1.0), (1.0, 1.0)]]),
        ("chevron-inverted", &[[(0.0, 0.0), (1.0, 0.0)], [(0.0, 0.75), (1.0, 0.75)]]),
        ("ring-inside", &[[(0.0, 0.3), (0.0, 0.3)], [(0.0, 0.7), (0.0, 0.7)]]),
        ("ring-outside", &[[(0.0, 0.3), (0.0, 0.3)], [(0.0, 0.7), (0.0, 0.7)]]),
        ("arch-up", &[[(0.0, 0.5), (1.0, 0.5)]]),
        ("arch-down", &[[(0.0, 0.5), (1.0, 0.5)]]),
        ("circle", &[[(0.0, 0.5), (0.0, 0.5)]]),
        ("button", &[[(0.0, 0.5), (1.0, 0.5)], [(0.0, 0.5), (1.0, 0.5)], [(0.0, 0.5), (1.0, 0.5)]]),
        ("arch-up-pour", &[[(0.0, 0.5), (1.0, 0.5)], [(0.25, 0.5), (0.75, 0.5)]]),
        ("arch-down-pour", &[[(0.375, 0.5), (0.625, 0.5)], [(0.0, 0.5), (1.0, 0.5)]]),
        ("circle-pour", &[[(0.0, 0.5), (0.0, 0.5)], [(0.25, 0.5), (0.25, 0.5)]]),
        (
            "button-pour",
            &[
                [(0.0, 0.5), (1.0, 0.5)],
                [(0.25, 0.5), (0.75, 0.5)],
                // d = h/8, half width w/4·√(1 − (1/2)²).
                [(0.5 - 0.216_506_350_946_109_66, 0.375), (0.5 + 0.216_506_350_946_109_66, 0.375)],
                [(0.5 - 0.216_506_350_946_109_66, 0.625), (0.5 + 0.216_506_350_946_109_66, 0.625)],
                [(0.25, 0.5), (0.75, 0.5)],
                [(0.0, 0.5), (1.0, 0.5)],
            ],
        ),
        ("curve-up", &[[(0.0, 0.45977), (1.0, 0.0)], [(0.0, 0.827_586_25), (1.0, 0.827_586_25)]]),
        ("curve-down", &[[(0.0, 0.0), (1.0, 0.45977)], [(0.0, 0.827_586_25), (1.0, 0.827_586_25)]]),
        ("can-up", &[[(0.0, 0.14286), (1.0, 0.14286)], [(0.0, 1.0), (1.0, 1.0)]]),
        ("can-down", &[[(0.0, 0.0), (1.0, 0.0)], [(0.0, 0.85714), (1.0, 0.85714)]]),
        ("wave1", &[[(0.0, 0.125), (1.0, 0.125)], [(0.0, 0.875), (1.0, 0.875)]]),
        ("wave2", &[[(0.0, 0.125), (1.0, 0.125)], [(0.0, 0.875), (1.0, 0.875)]]),
        ("double-wave1", &[[(0.0, 0.0625), (1.0, 0.0625)], [(0.0, 0.9375), (1.0, 0.9375)]]),
        ("wave4", &[[(0.0, 0.0625), (1.0, 0.0625)], [(0.0, 0.9375), (1.0, 0.9375)]]),
        ("inflate", &[[(0.0, 0.1875), (1.0, 0.1875)], [(0.0, 0.8125), (1.0, 0.8125)]]),
        ("deflate", &[[(0.0, 0.0), (1.0, 0.0)], [(0.0, 1.0), (1.0, 1.0)]]),
        ("inflate-bottom", &[[(0.0, 0.0), (1.0, 0.0)], [(0.0, 0.6), (1.0, 0.6)]]),
        ("deflate-bottom", &[[(0.0, 0.0), (1.0, 0.0)], [(0.0, 1.0), (1.0, 1.0)]]),
        ("inflate-top", &[[(0.0, 0.4), (1.0, 0.4)], [(0.0, 1.0), (1.0, 1.0)]]),
        ("deflate-top", &[[(0.0, 0.0), (1.0, 0.0)], [(0.0, 1.0), (1.0, 1.0)]]),
        (
            "deflate-inflate",
            &[
                [(0.0, 0.0), (1.0, 0.0)],
                [(0.0, 0.45), (1.0, 0.45)],
                [(0.0, 0.55), (1.0, 0.55)],
                [(0.0, 1.0), (1.0, 1.0)],
            ],
        ),
        (
            "deflate-inflate-deflate",
            &[
                [(0.0, 0.0), (1.0, 0.0)],
                [(0.0, 0.3), (1.0, 0.3)],
                [(0.0, 0.36), (1.0, 0.36)],
                [(0.0, 0.63), (1.0, 0.63)],
                [(0.0, 0.7), (1.0, 0.7)],
                [(0.0, 1.0), (1.0, 1.0)],
            ],
        ),
        ("fade-right", &[[(0.0, 0.0), (1.0, 0.33333)], [(0.0, 1.0), (1.0, 0.66667)]]),
        ("fade-left", &[[(0.0, 0.33333), (1.0, 0.0)], [(0.0, 0.66667), (1.0, 1.0)]]),
        ("fade-up", &[[(0.33333, 0.0), (0.66667, 0.0)], [(0.0, 1.0), (1.0, 1.0)]]),
        ("fade-down", &[[(0.0, 0.0), (1.0, 0.0)], [(0.33333, 1.0), (0.66667, 1.0)]]),
        ("slant-up", &[[(0.0, 0.55555), (1.0, 0.0)], [(0.0, 1.0), (1.0, 0.44445)]]),
        ("slant-down", &[[(0.0, 0.0), (1.0, 0.55555)], [(0.0, 0.44445), (1.0, 1.0)]]),
        ("cascade-up", &[[(0.0, 0.13889), (1.0, 0.0)], [(0.0, 1.0), (1.0, 0.44444)]]),
        ("cascade-down", &[[(0.0, 0.0), (1.0, 0.13889)], [(0.0, 0.44444), (1.0, 1.0)]]),
    ];
    assert_eq!(
        pairs.iter().map(|p| p.0).collect::<Vec<_>>(),
        TextShape::builtin().iter().map(|p| p.name.clone()).collect::<Vec<_>>()
    );
    for (name, expected) in pairs {
        let guides: Vec<Vec<Seg>> = match default_guides(name) {
            Guides::Between(b) => b.into_iter().flatten().collect(),
            Guides::Along(p) => p,
        };
        assert_eq!(guides.len(), expected.len(), "{name}");
        for (guide, want) in guides.iter().zip(*expected) {
            // Whole turns lack 1/60000 of a degree: the ends are that close on the ellipse, 2.9e-7·radius at most.
            let turns = ["ring-inside", "ring-outside", "circle", "circle-pour"].contains(name);
            let near = if turns { 3e-7 * W } else { 1e-9 * W };
            for ((x, y), (u, v)) in ends(guide).into_iter().zip(want) {
                assert!(
                    (x - u * W).abs() < near && (y - v * H).abs() < near,
                    "{name}: {x},{y}, not {},{}",
                    u * W,
                    v * H
                );
            }
        }
    }
}

/// Compares the control points of guides between two curves, and ellipses, with the formulas.
#[test]
fn the_two_curve_family_reproduces_its_guides() {
    let cubic = |p: [(f64, f64); 4]| {
        vec![PathSeg::Cubic(CubicBez::new(
            (p[0].0 * W, p[0].1 * H),
            (p[1].0 * W, p[1].1 * H),
            (p[2].0 * W, p[2].1 * H),
            (p[3].0 * W, p[3].1 * H),
        ))]
    };
    let poly = |p: &[(f64, f64)]| -> Vec<PathSeg> {
        p.windows(2).map(|w| PathSeg::Line(Line::new((w[0].0 * W, w[0].1 * H), (w[1].0 * W, w[1].1 * H)))).collect()
    };
    let quad = |p: [(f64, f64); 3]| {
        vec![PathSeg::Quad(QuadBez::new((p[0].0 * W, p[0].1 * H), (p[1].0 * W, p[1].1 * H), (p[2].0 * W, p[2].1 * H)))]
    };
    let two = |a: [(f64, f64); 4], b: [(f64, f64); 4]| [cubic(a), cubic(b)].concat();
    let t = 1.0 / 3.0;
    let d = 0.125 * 10.0 / 3.0;
    let e = 0.0625 * 10.0 / 3.0;
    let wave = |y: f64, s: f64| cubic([(0.0, y), (t, y - s * d), (2.0 * t, y + s * d), (1.0, y)]);
    let double = |y: f64, s: f64| {
        two(
            [(0.0, y), (t / 2.0, y - s * e), (t, y + s * e), (0.5, y)],
            [(0.5, y), (2.0 * t, y - s * e), (2.5 * t, y + s * e), (1.0, y)],
        )
    };
    let cases: Vec<(&str, Vec<PathSeg>, Vec<PathSeg>)> = vec![
        ("slant-up", poly(&[(0.0, 0.55555), (1.0, 0.0)]), poly(&[(0.0, 1.0), (1.0, 0.44445)])),
        ("slant-down", poly(&[(0.0, 0.0), (1.0, 0.55555)]), poly(&[(0.0, 0.44445), (1.0, 1.0)])),
        ("triangle", poly(&[(0.0, 0.5), (0.5, 0.0), (1.0, 0.5)]), poly(&[(0.0, 1.0), (1.0, 1.0)])),
        ("triangle-inverted", poly(&[(0.0, 0.0), (1.0, 0.0)]), poly(&[(0.0, 0.5), (0.5, 1.0), (1.0, 0.5)])),
        ("chevron", poly(&[(0.0, 0.25), (0.5, 0.0), (1.0, 0.25)]), poly(&[(0.0, 1.0), (0.5, 0.75), (1.0, 1.0)])),
        (
            "chevron-inverted",
            poly(&[(0.0, 0.0), (0.5, 0.25), (1.0, 0.0)]),
            poly(&[(0.0, 0.75), (0.5, 1.0), (1.0, 0.75)]),
        ),
        (
            "stop",
            poly(&[(0.0, 0.25), (t, 0.0), (2.0 * t, 0.0), (1.0, 0.25)]),
            poly(&[(0.0, 0.75), (t, 1.0), (2.0 * t, 1.0), (1.0, 0.75)]),
        ),
        (
            "inflate",
            cubic([(0.0, 0.1875), (t, -0.0625), (2.0 * t, -0.0625), (1.0, 0.1875)]),
            cubic([(0.0, 0.8125), (t, 1.0625), (2.0 * t, 1.0625), (1.0, 0.8125)]),
        ),
        ("inflate-top", quad([(0.0, 0.4), (0.5, 0.0), (1.0, 0.4)]), poly(&[(0.0, 1.0), (1.0, 1.0)])),
        ("inflate-bottom", poly(&[(0.0, 0.0), (1.0, 0.0)]), quad([(0.0, 0.6), (0.5, 1.0), (1.0, 0.6)])),
        ("deflate-top", quad([(0.0, 0.0), (0.5, 1.0), (1.0, 0.0)]), poly(&[(0.0, 1.0), (1.0, 1.0)])),
        // 18750 of the shorter side, 120 of 300 by 120: handles 4/3 of it inside.
        (
            "deflate",
            cubic([(0.0, 0.0), (t, 0.25), (2.0 * t, 0.25), (1.0, 0.0)]),
            cubic([(0.0, 1.0), (t, 0.75), (2.0 * t, 0.75), (1.0, 1.0)]),
        ),
        ("wave1", wave(0.125, 1.0), wave(0.875, 1.0)),
        ("wave2", wave(0.125, -1.0), wave(0.875, -1.0)),
        ("double-wave1", double(0.0625, 1.0), double(0.9375, 1.0)),
        ("wave4", double(0.0625, -1.0), double(0.9375, -1.0)),
    ];
    for (name, top, bottom) in cases {
        for by in ["parameter", "arclength"] {
            let m = build(&[("preset", name), ("by", by)]).unwrap().map;
            for (side, guide) in [(0.0, &top), (H, &bottom)] {
                let total: f64 = guide.iter().map(|s| s.arclen(1e-12)).sum();
                let n = guide.len() as f64;
                let mut gone = 0.0;
                for (k, seg) in guide.iter().enumerate() {
                    for i in 0..=20 {
                        let t = f64::from(i) / 20.0;
                        let u = match by {
                            "parameter" => (k as f64 + t) / n,
                            _ if i == 0 => gone / total,
                            _ => (gone + seg.subsegment(0.0..t).arclen(1e-12)) / total,
                        };
                        let p = m.point(Point::new(u * W, side));
                        assert!(p.distance(seg.eval(t)) < 1e-7, "{name} by {by} at {u}: {p:?}, not {:?}", seg.eval(t));
                    }
                    gone += seg.arclen(1e-12);
                }
            }
            // Lines between the guides are straight and evenly divided.
            let (a, b, c) =
                (m.point((0.3 * W, 0.0).into()), m.point((0.3 * W, 0.25 * H).into()), m.point((0.3 * W, H).into()));
            assert!(b.distance(a.lerp(c, 0.25)) < 1e-9, "{name}");
        }
    }
}

/// The guides of cans and rings are halves and wholes of ellipses, in either direction, run evenly.
#[test]
fn cans_and_rings_are_ellipses() {
    let is_on = |p: Point, cy: f64, ry: f64| (((p.x - 0.5 * W) / (0.5 * W)).hypot((p.y - cy) / ry) - 1.0).abs() < 1e-9;
    for i in 0..=24 {
        let x = f64::from(i) / 24.0 * W;
        for (name, top, bottom, ry, up) in
            [("can-up", 0.14286 * H, H, 0.14286 * H, true), ("can-down", 0.0, 0.85714 * H, 0.14286 * H, false)]
        {
            let m = build(&[("preset", name)]).unwrap().map;
            for (y, cy) in [(0.0, top), (H, bottom)] {
                let p = m.point((x, y).into());
                assert!(
                    is_on(p, cy, ry) && (if up { p.y <= cy + 1e-9 } else { p.y >= cy - 1e-9 }),
                    "{name} {x}: {p:?}"
                );
            }
        }
        for (name, sign) in [("ring-inside", 1.0), ("ring-outside", -1.0)] {
            for by in ["arclength", "parameter"] {
                let m = build(&[("preset", name), ("by", by), ("box", "artwork")]).unwrap().map;
                for (y, cy) in [(0.0, 0.3 * H), (H, 0.7 * H)] {
                    let p = m.point((x, y).into());
                    assert!(is_on(p, cy, 0.3 * H), "{name} {x}: {p:?}");
                    if i == 6 {
                        // A quarter of the way is a quarter turn from the left: the top, or the bottom.
                        assert!(p.distance((0.5 * W, cy - sign * 0.3 * H).into()) < 1e-3, "{name} {by}: {p:?}");
                    }
                }
            }
        }
    }
}

/// Angles are directions from the centre, not parameters; sweeps are mirrored about the vertical axis.
#[test]
fn arches_begin_where_their_angle_points() {
    for degrees in [10.0_f64, 100.0, 150.0, 200.0, 300.0] {
        let text = format!("{degrees}deg");
        let up = build(&[("preset", "arch-up"), ("adj", &text), ("box", "artwork")]).unwrap().map;
        let (a, b) = (up.point((0.0, H).into()), up.point((W, H).into()));
        let d = a - Point::new(0.5 * W, 0.5 * H);
        let turn = (d.y.atan2(d.x).to_degrees() - degrees).rem_euclid(360.0);
        assert!(turn.min(360.0 - turn) < 1e-6, "{degrees}: {d:?}");
        assert!((a.x + b.x - W).abs() < 1e-6 && (a.y - b.y).abs() < 1e-6, "{degrees}: {a:?} {b:?}");
    }
}

#[test]
fn bands_take_lines_of_text() {
    let m = build(&[("preset", "deflate-inflate"), ("split", "40%")]).unwrap().map;
    assert!(m.point((0.0, 0.2 * H).into()).distance((0.0, 0.225 * H).into()) < 1e-9);
    assert!(m.point((0.0, H).into()).distance((0.0, H).into()) < 1e-9);
    assert!(m.point((0.0, 0.7 * H).into()).distance((0.0, 0.775 * H).into()) < 1e-9);
    let button = build(&[("preset", "button"), ("box", "artwork")]).unwrap().map;
    assert!(button.point((0.5 * W, 2.0 * H / 3.0).into()).distance((0.5 * W, 0.5 * H).into()) < 1e-9);
}

#[test]
fn names_and_limits() {
    for (a, b) in [
        ("Chevron Up", "textChevron"),
        ("Wave: Down", "wave1"),
        ("ARCH", "textArchUp"),
        ("Double Wave Up-Down", "textWave4"),
        ("Square", "plain"),
    ] {
        let found = |n: &str| TextShape::builtin().into_iter().find(|p| p.is_called(n)).map(|p| p.name);
        assert!(found(a).is_some() && found(a) == found(b), "{a} {b}");
    }
    assert_eq!(TextShape::builtin().iter().map(|p| p.name.as_str()).collect::<Vec<_>>(), NAMES);
    assert!(NAMES.len() == 40 && NAMES.iter().enumerate().all(|(i, n)| !NAMES[..i].contains(n)));
    let fault = |pairs: &[(&str, &str)]| build(pairs).map(|_| ()).unwrap_err().to_string();
    assert!(fault(&[("preset", "bubble")]).contains("cascade-down"));
    assert!(fault(&[("preset", "inflate"), ("adj", "20001")]).contains("0 to 20000"));
    assert!(fault(&[("preset", "inflate"), ("adj", "adj2=1")]).contains("adj"));
    assert!(fault(&[("preset", "inflate"), ("split", "50%")]).contains("split"));
    assert!(fault(&[("preset", "button"), ("split", "50%,40%")]).contains("rising"));
}

/// A file with the triangle gives the built-in shape. Files without bands or paths, or with broken guides, are refused.
#[test]
fn files_of_ones_own() {
    let with = |text: &str| {
        let mut args = Args::from_pairs(&[("preset", "my.json"), ("adj", "30%")]);
        args.resolve_files(ENTRY.info().params, |_| Ok(text.to_owned())).unwrap();
        ENTRY.build_from(&args, &Frame::new(Rect::new(0.0, 0.0, W, H)))
    };
    let head = r#"{ "name": "roof", "adj": [{ "name": "a", "default": 0, "least": 0, "most": 50000 }], "#;
    let from_file =
        with(&format!(r#"{head} "bands": [["M 0,a*h/100000 L w/2,0 w,a*h/100000", "M 0,h L w,h"]] }}"#)).unwrap().map;
    let builtin = build(&[("preset", "triangle"), ("adj", "30%")]).unwrap().map;
    assert!(from_file.point((80.0, 70.0).into()).distance(builtin.point((80.0, 70.0).into())) < 1e-12);
    for rest in [
        r#""bands": [] }"#,
        r#""bands": [["", "M 0,h L w,h"]] }"#,
        r#""bands": [["M 0 L w,0", "M 0,h L w,h"]] }"#,
        r#""paths": ["M 0,0"] }"#,
        r#""x": 1 }"#,
    ] {
        assert!(with(&format!("{head}{rest}")).is_err(), "{rest}");
    }
}

/// The artwork's verticals, continued, reach the guides of the whole shape after the padding or more, exactly so where it is least.
#[test]
fn padding_is_kept_from_the_guides() {
    const PADDING: f64 = 4.0;
    for name in NAMES {
        if matches!(default_guides(name), Guides::Along(_)) {
            continue;
        }
        let map =
            |more: &[(&str, &str)]| build(&[&[("preset", *name), ("box", "artwork")], more].concat()).unwrap().map;
        let (whole, padded) = (map(&[]), map(&[("padding", "4")]));
        for (y, inwards) in [(1e-9, 0.01), (H - 1e-9, -0.01)] {
            let guide: Vec<Point> = (0..=3000).map(|i| whole.point(Point::new(W * f64::from(i) / 3000.0, y))).collect();
            // The distance to the guide along the vertical, and from the vertical to the sample taken for it.
            let to_guide = |x: f64| {
                let [from, behind] = [0.0, inwards].map(|d| padded.point(Point::new(x, y + d)));
                let out = (from - behind).normalize();
                let ahead = guide.iter().map(|g| *g - from).filter(|g| g.dot(out) > 0.0);
                let met = ahead.min_by(|a, b| a.cross(out).abs().total_cmp(&b.cross(out).abs())).unwrap();
                (met.dot(out), met.cross(out).abs())
            };
            let all: Vec<(f64, f64)> = (0..=40).map(|i| to_guide(W * f64::from(i) / 40.0)).collect();
            // If a vertical runs nearly along a guide, its samples do not show where they meet.
            let certain = || all.iter().filter(|(_, missed)| *missed < 0.15).map(|(distance, _)| *distance);
            let least = certain().fold(f64::INFINITY, f64::min);
            assert!((0.98 * PADDING..1.1 * PADDING).contains(&least), "{name}: {least}");
            assert!(certain().count() > 30, "{name}");
        }
    }
    let plain = build(&[("preset", "plain"), ("padding", "10%")]).unwrap().map;
    for (p, image) in [((0.0, 0.0), (12.0, 12.0)), ((W, H), (W - 12.0, H - 12.0)), ((150.0, 60.0), (150.0, 60.0))] {
        assert!(plain.point(p.into()).distance(image.into()) < 1e-9);
    }
    assert!(build(&[("preset", "plain"), ("padding", "60")]).unwrap_err().to_string().contains("leaves nothing"));
}

/// The bottom of artwork that stands on a circle is a circle, larger by the padding.
#[test]
fn padding_lifts_off_a_guide() {
    let built = build(&[("preset", "arch-up"), ("padding", "7")]).unwrap();
    let guide = &built.explanation.overlays[0].path;
    let center = kurbo::Shape::bounding_box(guide);
    let (center, radius) = (Point::new(center.center().x, center.y1), 0.5 * center.width());
    for x in [0.0, 80.0, 150.0, W] {
        let gap = built.map.point(Point::new(x, H)).distance(center) - radius;
        assert!((gap - 7.0).abs() < 1e-2, "{gap}");
    }
}
