//! Compares the nets with the measured table, written out here independently with plain numbers and circles.

use super::*;
use crate::deform::Deformation as _;
use crate::outline::Outline;
use crate::param::{Args, Frame};
use crate::{check, refit};
use kurbo::{ParamCurve, ParamCurveNearest as _};
use std::f64::consts::PI;

#[test]
fn is_sound() {
    let faults = check::entry(&ENTRY);
    assert!(faults.is_empty(), "{faults:#?}");
}

const W: f64 = 240.0;
const H: f64 = 90.0;

/// The points of a net, in rows.
type Points = [[(f64, f64); 4]; 4];

fn rest(w: f64, h: f64) -> Points {
    let t = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];
    t.map(|v| t.map(|u| (u * w, v * h)))
}

/// Returns an arc of the angle |b|·π about (W/2, yc) with radius r, above or below its centre.
fn arc(w: f64, b: f64, yc: f64, r: f64, up: bool) -> [(f64, f64); 4] {
    let theta = b.abs() * PI;
    let (s, c, k) = ((theta / 2.0).sin(), (theta / 2.0).cos(), 4.0 / 3.0 * (theta / 4.0).tan());
    let side = if up { -1.0 } else { 1.0 };
    let (x0, x1, y) = (w / 2.0 - r * s, w / 2.0 + r * s, yc + side * r * c);
    let (dx, dy) = (k * r * c, side * k * r * s);
    [(x0, y), (x0 + dx, y + dy), (x1 - dx, y + dy), (x1, y)]
}

fn mirrored(n: Points, h: f64) -> Points {
    [3, 2, 1, 0].map(|j: usize| n[j].map(|(x, y)| (x, h - y)))
}

/// Adds straight left and right sides with handles at thirds, and the inner points.
fn completed(mut n: Points) -> Points {
    let mix = |p: (f64, f64), q: (f64, f64), t: f64| (p.0 + (q.0 - p.0) * t, p.1 + (q.1 - p.1) * t);
    for c in [0, 3] {
        (n[1][c], n[2][c]) = (mix(n[0][c], n[3][c], 1.0 / 3.0), mix(n[0][c], n[3][c], 2.0 / 3.0));
    }
    inner(n)
}

/// Adds the inner points of the bilinear Coons patch.
fn inner(mut n: Points) -> Points {
    let sum = |terms: &[(f64, (f64, f64))]| {
        terms.iter().fold((0.0, 0.0), |a, (k, p)| (a.0 + k * p.0 / 9.0, a.1 + k * p.1 / 9.0))
    };
    let p = n;
    // The point (j, c) beside the corner (cj, cc); (fj, fc) is the corner opposite.
    let point = |j: usize, c: usize, cj: usize, cc: usize| {
        let (fj, fc) = (3 - cj, 3 - cc);
        sum(&[
            (6.0, p[cj][c]),
            (6.0, p[j][cc]),
            (3.0, p[fj][c]),
            (3.0, p[j][fc]),
            (-4.0, p[cj][cc]),
            (-2.0, p[cj][fc]),
            (-2.0, p[fj][cc]),
            (-1.0, p[fj][fc]),
        ])
    };
    (n[1][1], n[1][2], n[2][1], n[2][2]) = (point(1, 1, 0, 0), point(1, 2, 0, 3), point(2, 1, 3, 0), point(2, 2, 3, 3));
    n
}

/// Returns the net of a style from the measured table.
fn table(style: &str, b: f64, w: f64, h: f64) -> Points {
    let theta = b.abs() * PI;
    let (s, c) = ((theta / 2.0).sin(), (theta / 2.0).cos());
    let r = w / (2.0 * s);
    let mut n = rest(w, h);
    match style {
        "arc" => {
            n[3] = arc(w, b, h + r * c, r, true);
            n[0] = arc(w, b, h + r * c, r + h, true);
            let n = completed(n);
            if b < 0.0 { mirrored(n, h) } else { n }
        }
        "arc-lower" => {
            n[3] = if b > 0.0 { arc(w, b, h - r * c, r, false) } else { arc(w, b, h + r * c, r, true) };
            completed(n)
        }
        "arc-upper" => {
            n[0] = if b > 0.0 { arc(w, b, r * c, r, true) } else { arc(w, b, -r * c, r, false) };
            completed(n)
        }
        "arch" => {
            n[0] = if b > 0.0 { arc(w, b, r * c, r, true) } else { arc(w, b, -r * c, r, false) };
            n[3] = n[0].map(|(x, y)| (x, y + h));
            completed(n)
        }
        "bulge" => {
            n[0] = if b > 0.0 { arc(w, b, r * c, r, true) } else { arc(w, b, -r * c, r, false) };
            n[3] = if b > 0.0 { arc(w, b, h - r * c, r, false) } else { arc(w, b, h + r * c, r, true) };
            completed(n)
        }
        "shell-upper" | "shell-lower" => {
            let turn = if b > 0.0 { s } else { -s };
            n[0] = if b > 0.0 { arc(w, b, h + r * c, r + h, true) } else { arc(w, b, -r * c, r, false) };
            n[1][0] = (n[0][0].0 + h / 3.0 * turn, n[0][0].1 + h / 3.0 * c);
            n[1][3] = (n[0][3].0 - h / 3.0 * turn, n[0][3].1 + h / 3.0 * c);
            if style == "shell-lower" { mirrored(n, h) } else { n }
        }
        "flag" | "fish" => {
            for j in 0..4 {
                let g = if style == "flag" { 1.0 } else { [-1.0, -1.0 / 3.0, 1.0 / 3.0, 1.0][j] };
                n[j][1].1 += 2.0 * b * h * g;
                n[j][2].1 -= 2.0 * b * h * g;
            }
            n
        }
        "wave" => {
            for row in &mut n[1..3] {
                row[1].1 += 4.0 / 3.0 * b * h;
                row[2].1 -= 4.0 / 3.0 * b * h;
            }
            n
        }
        "rise" => {
            for row in &mut n {
                row[0].1 += 2.0 * b * h;
                row[1].1 += 2.0 * b * h;
            }
            n
        }
        "fisheye" => {
            let (x, y) = (2.0 / 3.0 * b * w, 2.0 / 3.0 * b * h);
            for (j, c, sx, sy) in [(1, 1, -1.0, -1.0), (1, 2, 1.0, -1.0), (2, 1, -1.0, 1.0), (2, 2, 1.0, 1.0)] {
                n[j][c].0 += sx * x;
                n[j][c].1 += sy * y;
            }
            n
        }
        "inflate" | "squeeze" => {
            let (l, m) = ([1.0, 1.0 / 3.0, -1.0 / 3.0, -1.0], [0.0, 1.0, 1.0, 0.0]);
            let sign = if style == "squeeze" { -1.0 } else { 1.0 };
            for j in 0..4 {
                for c in 0..4 {
                    n[j][c].0 -= sign * b / 3.0 * w * l[c] * m[j];
                    n[j][c].1 -= b / 3.0 * h * m[c] * l[j];
                }
            }
            n
        }
        "twist" => {
            let a = b.abs();
            let moves = if b > 0.0 {
                [(1, 1, a * w, 0.0), (1, 2, 0.0, a * h), (2, 1, 0.0, -a * h), (2, 2, -a * w, 0.0)]
            } else {
                [(1, 1, 0.0, a * h), (1, 2, -a * w, 0.0), (2, 1, a * w, 0.0), (2, 2, 0.0, -a * h)]
            };
            for (j, c, x, y) in moves {
                n[j][c].0 += x;
                n[j][c].1 += y;
            }
            n
        }
        other => panic!("{other}"),
    }
}

const BENDS: [f64; 6] = [-1.0, -0.5, -0.2, 0.2, 0.5, 1.0];

fn undistorted(bend: f64) -> StyleParams {
    StyleParams { bend, distortion: [0.0, 0.0], vertical: false }
}

/// Returns the largest distance between points of the nets.
fn distance(net: &Net, points: &Points) -> f64 {
    let pairs = net.iter().flatten().zip(points.iter().flatten());
    pairs.map(|(p, q)| p.distance((*q).into())).fold(0.0, f64::max)
}

#[test]
fn every_style_is_there_under_every_spelling() {
    let styles = Style::builtin();
    assert_eq!(styles.iter().map(|s| s.name.as_str()).collect::<Vec<_>>(), NAMES);
    for (ours, psd) in
        [("arc", "warpArc"), ("shell-lower", "warpShellLower"), ("fisheye", "warpFishEye"), ("twist", "warpTwist")]
    {
        let found: Vec<_> = styles.iter().filter(|s| s.is_called(psd)).map(|s| s.name.as_str()).collect();
        assert_eq!(found, [ours]);
    }
    // Every style has its spelling in Photoshop's files.
    assert!(styles.iter().all(|s| s.also.iter().any(|a| a.starts_with("warp"))));
}

#[test]
fn nets_are_the_tables() {
    for style in Style::builtin() {
        for b in BENDS {
            let net = style.net(W, H, &undistorted(b)).unwrap();
            let d = distance(&net, &table(&style.name, b, W, H));
            assert!(d < 1e-9, "{} {b}: {d:e}\n{net:?}", style.name);
        }
        let zero = style.net(W, H, &undistorted(0.0)).unwrap();
        assert!(distance(&zero, &rest(W, H)) < 1e-12, "{}", style.name);
    }
}

/// The vertical axis gives the style on the transposed box; a rise then ends where it began.
#[test]
fn the_vertical_axis_is_transposition() {
    for style in Style::builtin() {
        for b in BENDS {
            let net = style.net(W, H, &StyleParams { vertical: true, ..undistorted(b) }).unwrap();
            let across = table(&style.name, b, H, W);
            let shift = if style.name == "rise" { -2.0 * b * W } else { 0.0 };
            let expected: Points = std::array::from_fn(|j| {
                std::array::from_fn(|c| {
                    let (x, y) = across[c][j];
                    (y + shift, x)
                })
            });
            assert!(distance(&net, &expected) < 1e-9, "{} {b}", style.name);
        }
    }
}

/// Scales columns, then rows (or the reverse), about the middles of their ends. The family decides which points are scaled.
fn distorted(style: &str, b: f64, [wide, high]: [f64; 2], [h, v]: [f64; 2], columns_first: bool) -> Points {
    let t = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0];
    let columns = |n: &Points| {
        let mut out = *n;
        for c in 0..4 {
            let m = ((n[0][c].0 + n[3][c].0) / 2.0, (n[0][c].1 + n[3][c].1) / 2.0);
            let f = 1.0 + h * (2.0 * t[c] - 1.0);
            for j in 0..4 {
                out[j][c] = (m.0 + (n[j][c].0 - m.0) * f, m.1 + (n[j][c].1 - m.1) * f);
            }
        }
        out
    };
    let rows = |n: &Points| {
        let mut out = *n;
        for j in 0..4 {
            let m = ((n[j][0].0 + n[j][3].0) / 2.0, (n[j][0].1 + n[j][3].1) / 2.0);
            let f = 1.0 + v * (2.0 * t[j] - 1.0);
            for c in 0..4 {
                out[j][c] = (m.0 + (n[j][c].0 - m.0) * f, m.1 + (n[j][c].1 - m.1) * f);
            }
        }
        out
    };
    let scale = |n: &Points| if columns_first { rows(&columns(n)) } else { columns(&rows(n)) };
    let n = table(style, b, wide, high);
    match style {
        "twist" | "fisheye" | "shell-upper" | "shell-lower" => scale(&n),
        "wave" | "inflate" | "squeeze" => {
            let (zero, mut out) = (rest(wide, high), scale(&rest(wide, high)));
            for j in 0..4 {
                for c in 0..4 {
                    let f = (1.0 + h * (2.0 * t[c] - 1.0)) * (1.0 + v * (2.0 * t[j] - 1.0));
                    out[j][c].0 += (n[j][c].0 - zero[j][c].0) * f;
                    out[j][c].1 += (n[j][c].1 - zero[j][c].1) * f;
                }
            }
            out
        }
        _ => inner(scale(&n)),
    }
}

#[test]
fn distortions_come_in_order() {
    for style in Style::builtin() {
        for b in BENDS {
            for (h, v) in [(0.3, 0.0), (0.0, -0.4), (0.25, -0.6), (-1.0, 0.5)] {
                let net = style.net(W, H, &StyleParams { distortion: [h, v], ..undistorted(b) }).unwrap();
                let d = distance(&net, &distorted(&style.name, b, [W, H], [h, v], true));
                assert!(d < 1e-9, "{} {b} {h} {v}: {d:e}", style.name);
                // With the vertical axis, the two distortions change roles; horizontal still comes first.
                let net = style.net(W, H, &StyleParams { bend: b, distortion: [h, v], vertical: true }).unwrap();
                let across = distorted(&style.name, b, [H, W], [v, h], false);
                let shift = if style.name == "rise" { -2.0 * b * W } else { 0.0 };
                let expected: Points =
                    std::array::from_fn(|j| std::array::from_fn(|c| (across[c][j].1 + shift, across[c][j].0)));
                let d = distance(&net, &expected);
                assert!(d < 1e-9, "{} {b} {h} {v} sideways: {d:e}", style.name);
            }
        }
    }
    // The order matters where both act on bent sides, so that the test detects it.
    let arch = Style::builtin().into_iter().find(|s| s.name == "arch").unwrap();
    let level = arch.net(W, H, &StyleParams { distortion: [0.25, -0.6], ..undistorted(0.5) }).unwrap();
    let upright =
        arch.net(H, W, &StyleParams { distortion: [-0.6, 0.25], vertical: true, ..undistorted(0.5) }).unwrap();
    let swapped: Points = std::array::from_fn(|j| std::array::from_fn(|c| (upright[c][j].y, upright[c][j].x)));
    assert!(distance(&level, &swapped) > 0.1);
}

fn build(pairs: &[(&str, &str)]) -> Built {
    ENTRY.build_from(&Args::from_pairs(pairs), &Frame::new(Rect::new(5.0, 7.0, 5.0 + W, 7.0 + H))).unwrap()
}

/// Every node that comes from a node of the source lies where the table's net puts it, and each side of the box becomes one curve,
/// an outermost row or column of the net.
#[test]
fn a_drawings_nodes_lie_where_the_table_says() {
    let drawing = "M40,20 C80,10 90,60 130,50 L200,80 Q220,40 160,30 Z M20,20 A14,9 10 1 0 60,70 L20,90";
    let art = Outline::from_svg(drawing).unwrap();
    let frame =
        Outline::from_points(&[(5.0, 7.0), (5.0 + W, 7.0), (5.0 + W, 7.0 + H), (5.0, 7.0 + H)].map(Point::from), true);
    for name in NAMES {
        for b in BENDS {
            let n = table(name, b, W, H);
            let at = |p: Point| {
                let column = n.map(|r| {
                    let q = r.map(|(x, y)| Point::new(x + 5.0, y + 7.0));
                    CubicBez::new(q[0], q[1], q[2], q[3]).eval((p.x - 5.0) / W)
                });
                CubicBez::new(column[0], column[1], column[2], column[3]).eval((p.y - 7.0) / H)
            };
            let map = build(&[("style", name), ("bend", &b.to_string())]).map;
            let out = refit::warp_path(&art, &map, &refit::Options::new(0.02)).unwrap();
            let nodes: Vec<Point> = out.path.segments().flat_map(|s| [s.start(), s.end()]).collect();
            for seg in art.segs() {
                let q = at(seg.start());
                let near = nodes.iter().map(|p| p.distance(q)).fold(f64::INFINITY, f64::min);
                assert!(near < 1e-9, "{name} {b}: no node at {q:?}, the nearest {near:e} away");
            }
            let side = refit::warp_path(&frame, &map, &refit::Options::new(1e-6)).unwrap();
            let segs: Vec<Seg> = Outline::from(&side.path).segs().copied().collect();
            assert!(segs.len() == 4, "{name} {b}: {} segments", segs.len());
            let top = segs[0].to_cubic();
            for i in 0..=10 {
                let t = f64::from(i) / 10.0;
                let p = Point::new(5.0 + t * W, 7.0);
                assert!(top.nearest(at(p), 1e-9).distance_sq.sqrt() < 2e-6, "{name} {b} {t}");
            }
        }
    }
}

#[test]
fn one_net_is_certified() {
    let map = build(&[("style", "fisheye"), ("bend", "70%")]).map;
    let art = Outline::from_svg("M40,20 C80,10 90,60 130,50 L200,80 Z").unwrap();
    let options = refit::Options::new(0.01).with_certify(true);
    let out = refit::warp_path(&art, &map, &options).unwrap();
    assert!(out.report.max_error <= 0.01, "{:?}", out.report);
    assert_eq!(out.report.assurance, refit::Assurance::Certified);
}

#[test]
fn files_of_ones_own_and_their_faults() {
    let with = |text: &str| {
        let mut args = Args::from_pairs(&[("style", "my.json"), ("bend", "50%")]);
        args.resolve_files(ENTRY.info().params, |_| Ok(text.to_owned())).unwrap();
        ENTRY.build_from(&args, &check::frame())
    };
    let flag = r#"{ "name": "f", "family": "points", "moves": [{ "at": "*,1", "y": "2*b*h" }, { "at": "*,2", "y": "-2*b*h" }] }"#;
    let (from_file, builtin) = (
        with(flag).unwrap().map,
        ENTRY.build_from(&Args::from_pairs(&[("style", "flag")]), &check::frame()).unwrap().map,
    );
    for p in [(10.0, 10.0), (60.0, 30.0), (95.0, 99.0)] {
        assert!(from_file.point(p.into()).distance(builtin.point(p.into())) < 1e-12);
    }
    let head = r#"{ "name": "f", "family": "points", "#;
    for (rest, part) in [
        (r#""moves": [{ "at": "4,1" }] }"#, "`4,1`"),
        (r#""moves": [{ "at": "1,1", "y": "2*q" }] }"#, "q"),
        (r#""arcs": [{ "row": 7, "y": "0", "half": "w", "lift": "k" }] }"#, "row 7"),
        (r#""let": ["t = 1/0"] }"#, "finite"),
        (r#""colour": 1 }"#, "colour"),
    ] {
        let fault = with(&format!("{head}{rest}")).map(|_| ()).unwrap_err().to_string();
        assert!(fault.contains(part), "{fault}");
    }
    let refused = |pairs: &[(&str, &str)]| {
        ENTRY.build_from(&Args::from_pairs(pairs), &check::frame()).map(|_| ()).unwrap_err().to_string()
    };
    assert!(refused(&[("style", "flags")]).contains("arc-lower"));
    assert!(refused(&[("bend", "191%")]).contains("-190% to 190%"));
    // Styles without arcs have no limit.
    assert!(ENTRY.build_from(&Args::from_pairs(&[("style", "rise"), ("bend", "700%")]), &check::frame()).is_ok());
}

/// With `keep verticals`, verticals stay vertical within 0.1° for styles that bend them otherwise, if their sides allow it.
#[test]
fn kept_verticals_are_upright() {
    let build = |pairs: &[(&str, &str)]| {
        ENTRY.build_from(&Args::from_pairs(pairs), &Frame::new(Rect::new(0.0, 0.0, 200.0, 100.0)))
    };
    for style in ["arch", "arc-lower", "arc-upper", "bulge", "flag", "rise", "fish"] {
        for bend in ["-50%", "20%", "50%"] {
            let built = build(&[("style", style), ("bend", bend), ("keep", "verticals")]);
            let built = built.unwrap_or_else(|e| panic!("{style} {bend}: {e}"));
            assert!(built.explanation.warnings.is_empty(), "{style} {bend}: {:?}", built.explanation.warnings);
            let free = build(&[("style", style), ("bend", bend)]).unwrap().map;
            for i in 0..=20 {
                let x = 10.0 * f64::from(i);
                let [a, b, c] = [0.0, 37.0, 100.0].map(|y| built.map.point((x, y).into()));
                let lean = (c.x - a.x).abs().atan2((c.y - a.y).abs()).to_degrees();
                assert!(lean < 0.1, "{style} {bend} at {x}: {lean}°");
                assert!((b - a).cross(c - a).abs() < 1e-9 * (c - a).hypot2(), "{style} {bend} at {x}: bent");
            }
            // Corners are those of the style, and points of the bottom lie on its bottom.
            for corner in [(0.0, 0.0), (200.0, 0.0), (0.0, 100.0), (200.0, 100.0)] {
                assert!(built.map.point(corner.into()).distance(free.point(corner.into())) < 1e-9, "{style} {bend}");
            }
        }
    }
    let e = build(&[("style", "inflate"), ("bend", "50%"), ("keep", "verticals")]).err().unwrap().to_string();
    assert!(e.contains("is impossible with this style") && e.contains("arch") && !e.contains("inflate,"), "{e}");
    // Styles that leave the sides straight have nothing to keep; that is an error rather than the identity.
    for style in ["wave", "fisheye", "twist"] {
        for keep in ["verticals", "horizontals", "lines"] {
            let e = build(&[("style", style), ("bend", "50%"), ("keep", keep)]).err().unwrap().to_string();
            assert!(e.contains("sides do not bend") && !e.contains("fisheye, "), "{style} {keep}: {e}");
        }
        assert!(build(&[("style", style), ("bend", "0"), ("keep", "lines")]).is_ok());
    }
}
