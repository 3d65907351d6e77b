//! Compares the envelope with formulas written out independently, and with the shaper.

use super::fit::sides_at_pace;
use super::*;
use crate::deform::Deformation as _;
use crate::deform::Registry;
use crate::map::{AffineMap, Class, Creases};
use crate::param::{Args, Frame};
use crate::refit;
use kurbo::{ParamCurve, ParamCurveArclen, PathSeg};
use std::f64::consts::FRAC_1_SQRT_2;

const SQUARE: Rect = Rect::new(0.0, 0.0, 100.0, 100.0);

fn built(pairs: &[(&str, &str)]) -> Result<Built, Error> {
    ENTRY.build_from(&Args::from_pairs(pairs), &Frame::new(SQUARE))
}

fn map(pairs: &[(&str, &str)]) -> Arc<dyn Map> {
    built(pairs).unwrap_or_else(|e| panic!("{pairs:?}: {e}")).map
}

fn fault(pairs: &[(&str, &str)]) -> String {
    built(pairs).err().unwrap_or_else(|| panic!("{pairs:?} builds")).to_string()
}

fn grid(n: u32, beyond: f64) -> impl Iterator<Item = Point> {
    let at = move |i: u32| -beyond + (100.0 + 2.0 * beyond) * f64::from(i) / f64::from(n);
    (0..=n).flat_map(move |i| (0..=n).map(move |j| Point::new(at(i), at(j))))
}

/// With one cubic for every side, the map equals the shaper to 1e-12, beyond the box as well.
#[test]
fn one_cubic_a_side_is_the_shaper() {
    const CAGES: [&str; 3] = [
        "M 10,90 C 40,110 60,70 95,85 C 85,60 105,40 90,15 C 60,-5 40,35 5,10 C 15,40 0,60 10,90 Z",
        "M 10,90 Q 40,110 95,85 L 90,15 5,10 Z",
        "M 0,10 C 5,2 60,-6 80,0 C 86,50 90,70 99,104 C 60,120 50,80 3,96 C -10,60 4,40 0,10 Z",
    ];
    let registry = Registry::builtin();
    for cage in CAGES {
        for reverse in [false, true] {
            let flag = |name: &'static str| reverse.then_some((name, "true"));
            let mut own = vec![("envelope", cage), ("by", "parameter")];
            own.extend(flag("reverse"));
            let shaper = registry.get("shaper").unwrap();
            let args = Args::from_pairs(&if reverse {
                vec![("shaper", cage), ("reverse-shaper", "true")]
            } else {
                vec![("shaper", cage)]
            });
            let (a, b) = (map(&own), shaper.build_from(&args, &Frame::new(SQUARE)).unwrap().map);
            for p in grid(24, 10.0) {
                let (x, y) = (a.jet(p), b.jet(p));
                assert!(
                    x.p.distance(y.p) < 1e-12 * 100.0_f64.max(y.p.to_vec2().hypot()),
                    "{cage} {p:?} {:e}",
                    x.p.distance(y.p)
                );
                assert!((x.dx - y.dx).hypot() + (x.dy - y.dy).hypot() < 1e-12, "{cage} {p:?}");
            }
        }
    }
}

/// Returns a wavy run of `n` pieces from one corner to another: lines, quadratics, cubics and arcs in turn.
fn wavy(from: Point, to: Point, n: u32) -> String {
    use std::fmt::Write as _;
    let (step, side) = ((to - from) / f64::from(n), (to - from).turn_90() / (f64::from(n) * 4.0));
    let mut out = String::new();
    for i in 0..n {
        let (a, b) = (from + step * f64::from(i), from + step * f64::from(i + 1));
        let sign = if i % 2 == 0 { 1.0 } else { -0.6 };
        let (c, d) = (a + step * 0.3 + side * sign, a + step * 0.6 + side * (0.5 * sign));
        let _ = match (i + n) % 4 {
            0 => write!(out, "L{},{} ", b.x, b.y),
            1 => write!(out, "C{},{} {},{} {},{} ", c.x, c.y, d.x, d.y, b.x, b.y),
            2 => write!(out, "Q{},{} {},{} ", c.x, c.y, b.x, b.y),
            _ => write!(out, "A{0},{0} 0 0 1 {1},{2} ", 0.9 * step.hypot(), b.x, b.y),
        };
    }
    out
}

/// Returns the point at a share of a run's length by kurbo's integration, an independent reference.
fn by_length(segs: &[Seg], share: f64) -> Point {
    let as_kurbo = |s: &Seg| match s {
        Seg::Line(l) => PathSeg::Line(*l),
        Seg::Quad(q) => PathSeg::Quad(*q),
        Seg::Cubic(c) => PathSeg::Cubic(*c),
        Seg::Arc(_) => panic!("arcs are measured by their angle"),
    };
    // A circular arc's length is its angle times its radius.
    let length = |s: &Seg| if let Seg::Arc(a) = s { a.sweep.abs() * a.a.hypot() } else { as_kurbo(s).arclen(1e-12) };
    let all: f64 = segs.iter().map(length).sum();
    let mut left = share * all;
    for s in segs {
        let own = length(s);
        if left <= own {
            return match s {
                Seg::Arc(a) => a.eval(left / own),
                _ => as_kurbo(s).eval(as_kurbo(s).inv_arclen(left, 1e-12)),
            };
        }
        left -= own;
    }
    segs.last().unwrap().end()
}

/// Sides of 1, 3 and 17 pieces are reproduced to 1e-9, at equal shares of their length.
#[test]
fn boundaries_are_reproduced_by_length() {
    let c = [(0.0, 100.0), (110.0, 95.0), (100.0, -10.0), (-5.0, 5.0)].map(Point::from);
    for n in [1, 3, 17] {
        let runs: Vec<String> = (0..4).map(|i| wavy(c[i], c[(i + 1) % 4], n)).collect();
        let path = format!("M{},{} {}Z", c[0].x, c[0].y, runs.concat());
        let corners = c.map(|p| format!("{},{}", p.x, p.y)).join(" ");
        let m = map(&[("envelope", &path), ("corners", &corners)]);
        let outline = Outline::from_svg(&path).unwrap();
        let segs: Vec<Seg> = outline.segs().copied().collect();
        assert_eq!(segs.len(), 4 * n as usize);
        for (k, side) in segs.chunks(n as usize).enumerate() {
            for i in 0..=40 {
                let t = f64::from(i) / 40.0;
                let on = [(100.0 * t, 100.0), (100.0, 100.0 - 100.0 * t), (100.0 - 100.0 * t, 0.0), (0.0, 100.0 * t)];
                let (got, wanted) = (m.point(on[k].into()), by_length(side, t));
                assert!(got.distance(wanted) < 1e-9, "{n} pieces, side {k}, {t}: {:e}", got.distance(wanted));
            }
        }
    }
}

/// The inside agrees with the formula of the Coons patch, with shares of length from kurbo.
#[test]
fn the_inside_is_the_coons_patch() {
    let path = "M0,100 C20,120 40,80 50,100 Q70,130 110,95 L100,50 Q120,20 100,-10 C70,-30 30,10 -5,5 Q20,60 0,100 Z";
    let segs: Vec<Seg> = Outline::from_svg(path).unwrap().segs().copied().collect();
    let m = map(&[("envelope", path), ("corners", "1,3,5,6")]);
    let [b, r, t, l] = [&segs[..2], &segs[2..4], &segs[4..5], &segs[5..]];
    for p in grid(13, 0.0) {
        let (u, v) = (p.x / 100.0, 1.0 - p.y / 100.0);
        let [b, r, t, l] =
            [by_length(b, u), by_length(r, v), by_length(t, 1.0 - u), by_length(l, 1.0 - v)].map(Point::to_vec2);
        let corner = |x: f64, y: f64| Vec2::new(x, y);
        let bilinear = (corner(0.0, 100.0) * (1.0 - u) + corner(110.0, 95.0) * u) * (1.0 - v)
            + (corner(-5.0, 5.0) * (1.0 - u) + corner(100.0, -10.0) * u) * v;
        let wanted = b * (1.0 - v) + t * v + l * (1.0 - u) + r * u - bilinear;
        assert!((m.point(p).to_vec2() - wanted).hypot() < 1e-9, "{p:?}");
    }
}

/// Branches agree with the map inside their cells and on their edges, whatever the pace, and have exact derivatives.
#[test]
fn branches_and_creases() {
    let path = "M0,100 C20,120 40,80 50,100 Q70,130 110,95 L100,50 Q120,20 100,-10 C70,-30 30,10 -5,5 Q20,60 0,100 Z";
    for by in ["length", "parameter"] {
        let m = map(&[("envelope", path), ("corners", "1,3,5,6"), ("by", by)]);
        let mut creases = Creases::default();
        m.creases(&mut creases);
        assert_eq!(creases.items().len(), if by == "length" { 6 } else { 2 }, "{by}");
        for p in grid(17, 20.0).filter(|p| creases.items().iter().all(|c| c.level.at(*p).abs() > 1e-3)) {
            let (a, b) = (m.jet(p), m.branch(p).unwrap().jet(p));
            assert!(a.p.distance(b.p) < 1e-11 && (a.dx - b.dx).hypot() + (a.dy - b.dy).hypot() < 1e-11, "{by} {p:?}");
            let h = 1e-5;
            let dx = (m.point(p + Vec2::new(h, 0.0)) - m.point(p - Vec2::new(h, 0.0))) / (2.0 * h);
            assert!((dx - a.dx).hypot() < 1e-6, "{by} {p:?} {dx:?} {:?}", a.dx);
        }
        // Branches on both sides of a crease agree on it.
        for c in creases.items() {
            for q in grid(9, 0.0) {
                let (f, g) = (c.level.at(q), c.level.at(q + Vec2::new(1.0, 0.0)) - c.level.at(q));
                let (h, eps) = (c.level.at(q + Vec2::new(0.0, 1.0)) - c.level.at(q), 1e-4);
                let n = Vec2::new(g, h) / (g * g + h * h);
                let on = q - n * f;
                let [a, b] = [eps, -eps].map(|e| m.branch(on + n * e).unwrap().point(on));
                assert!(a.distance(b) < 1e-9, "{by} {c:?} {on:?}: {a:?} {b:?}");
            }
        }
        // Only by parameter are the cells polynomials, with a known degree.
        let known = m.branch(Point::new(20.0, 80.0)).unwrap().rational_degree().is_some();
        assert_eq!(known, by == "parameter");
    }
}

/// Artwork is never mirrored, for any start and direction of the path.
#[test]
fn nothing_is_mirrored_and_the_bottom_is_below() {
    let shapes = [
        "M20,34 C60,44 96,40 130,20 C164,40 200,44 240,34 C244,110 226,190 130,240 C34,190 16,110 20,34 Z",
        "M400,72 C420,20 510,14 520,84 C528,146 440,190 400,240 C360,190 272,146 280,84 C290,14 380,20 400,72 Z",
        "M550,60 C620,20 690,96 780,56 L752,120 L780,184 C690,224 620,148 550,188 Z",
        "M200,100 A100,60 0 1 1 0,100 A100,60 0 1 1 200,100 Z",
        "M30,0 H170 A30,30 0 0 1 200,30 V70 A30,30 0 0 1 170,100 H30 A30,30 0 0 1 0,70 V30 A30,30 0 0 1 30,0 Z",
        "M100,0 L200,170 L0,170 Z",
        "M0,50 L50,0 H150 L200,50 L150,100 H50 Z",
        // A crescent, whose lowest corners are its horns.
        "M0,100 A100,100 0 0 1 200,100 L170,110 A70,70 0 0 0 30,110 Z",
    ];
    for shape in shapes {
        let sub = Outline::from_svg(shape).unwrap().subpaths.remove(0);
        for reversed in [false, true] {
            for start in 0..sub.segs.len() {
                let mut turned = if reversed { sub.reversed() } else { sub.clone() };
                turned.segs.rotate_left(start);
                turned.start = turned.segs[0].start();
                let ring = corners::ring("envelope", &turned, None, None, false, &super::grid(5).collect::<Vec<_>>())
                    .unwrap_or_else(|e| panic!("{shape} {start}: {e}"));
                let sides =
                    sides_at_pace(&ring, None, Keep::Nothing, &mut Built::new(Arc::new(AffineMap::IDENTITY))).unwrap();
                let m = Coons::new(sides, Affine::new([0.01, 0.0, 0.0, -0.01, 0.0, 1.0]));
                // The heart has a notch in the middle, so both sides of it are tested.
                let [l, r] = [40.0, 60.0].map(|x| m.jet(Point::new(x, 50.0)));
                assert!(l.det() > 0.0 && r.det() > 0.0, "{shape} from {start}, reversed {reversed}: mirrored");
                // Right is right, and up is up: wrong corners turn it by 45° or more, a wavy shape by less.
                let (dx, dy) = (l.dx + r.dx, l.dy + r.dy);
                assert!(
                    dx.y.abs() < 0.5 * dx.x && dy.x.abs() < 0.5 * dy.y,
                    "{shape} from {start}: turned, {dx:?} {dy:?}"
                );
            }
        }
    }
}

#[test]
fn corners_by_the_stated_rule() {
    let note =
        |pairs: &[(&str, &str)]| built(&[pairs, &[("keep", "nothing")]].concat()).unwrap().explanation.notes.join("\n");
    // The corners of a circle are on its diagonals, those of an ellipse on the diagonals of its box.
    let n = note(&[("envelope", "M200,100 A100,50 0 1 1 0,100 A100,50 0 1 1 200,100 Z")]);
    let (x, y) = (100.0 * FRAC_1_SQRT_2, 50.0 * FRAC_1_SQRT_2);
    let p = |sx: f64, sy: f64| show(Point::new(100.0 + sx * x, 100.0 + sy * y));
    let wanted = [p(-1.0, 1.0), p(1.0, 1.0), p(1.0, -1.0), p(-1.0, -1.0)].join(" ");
    assert!(n.contains(&wanted) && n.contains("nearest to the corners of its box"), "{n}\n{wanted}");
    // A swallow-tailed pennant has five corners, of which the notch is not chosen.
    let n = note(&[("envelope", "M0,0 L100,0 L80,50 L100,100 L0,100 Z")]);
    assert!(n.contains("0,100 100,100 100,0 0,0"), "{n}");
    // Four corners by angle, among smooth joints.
    let n = note(&[("envelope", "M0,0 L50,0 L100,0 L100,50 L100,100 L0,100 Z")]);
    assert!(n.contains("found by angle") && n.contains("0,100 100,100 100,0 0,0"), "{n}");
    // A ribbon has the corners of its ends, however little its middle is bent; not its notches, nor a point of a smooth curve.
    for y in ["0", "5", "10"] {
        let ribbon = format!("M0,40 Q100,{y} 200,40 L190,70 L200,100 Q100,60 0,100 L10,70 Z");
        let n = note(&[("envelope", &ribbon)]);
        assert!(n.contains("0,100 200,100 200,40 0,40"), "{n}");
    }
    // A square on its tip keeps its corners, although none lies in a quarter of its box.
    let n = note(&[("envelope", "M50,0 L100,50 L50,100 L0,50 Z")]);
    assert!(n.contains("found by angle"), "{n}");
    // A fish's tail is narrow, yet drawn with four corners.
    let n = note(&[(
        "envelope",
        "M8,266 C34,212 44,288 94,234 C97,229 97,223 94,218 C44,164 34,240 8,186 C18,210 18,242 8,266 Z",
    )]);
    assert!(n.contains("8,266 94,234 94,218 8,186"), "{n}");
    // A triangle has no corner at its tip.
    let n = note(&[("envelope", "M50,0 L100,100 L0,100 Z")]);
    assert!(n.contains("0,100 100,100 60,20 40,20"), "{n}");
    // Other bottoms turn the picture, but never mirror it.
    for k in ["1", "2", "3", "4"] {
        let m = map(&[("envelope", "0,0 100,0 100,100 0,100"), ("bottom-side", k)]);
        assert!((m.jet(Point::new(20.0, 30.0)).det() - 1.0).abs() < 1e-12);
    }
    let m = map(&[("envelope", "0,0 100,0 100,100 0,100"), ("bottom-side", "1")]);
    assert!(m.point(Point::new(10.0, 100.0)).distance(Point::new(90.0, 0.0)) < 1e-12);
    let m = map(&[("envelope", "0,0 100,0 100,100 0,100"), ("reverse", "true")]);
    assert!(m.point(Point::new(10.0, 80.0)).distance(Point::new(90.0, 80.0)) < 1e-12);
}

/// With `keep verticals`, verticals of the refitted result are straight and vertical within 0.1°.
#[test]
fn uprights_stay_upright_through_the_refit() {
    const TOLERANCE: f64 = 0.005;
    let hill = "M0,60 C40,60 60,10 110,10 C160,10 190,50 240,50 S300,20 360,20";
    let valley = "M0,120 C50,120 90,150 140,150 C190,150 220,110 270,110 C310,110 340,135 360,135";
    let cases: [&[(&str, &str)]; 3] = [
        &[("bottom", valley), ("top", hill), ("keep", "verticals")],
        &[("bottom", "M0,160 C100,80 260,80 360,160"), ("height", "70"), ("keep", "verticals")],
        &[("bottom", "M0,160 Q180,60 360,160"), ("top", "M0,60 C120,0 200,-40 360,60"), ("keep", "verticals")],
    ];
    for pairs in cases {
        let b = built(pairs).unwrap();
        assert!(b.explanation.warnings.is_empty(), "{:?}", b.explanation.warnings);
        for i in 0..=20 {
            let x = 5.0 * f64::from(i);
            let art = Outline::from_svg(&format!("M{x},0 V100")).unwrap();
            let w = refit::warp_path(&art, &b.map, &refit::Options::new(TOLERANCE)).unwrap();
            let segs: Vec<PathSeg> = w.path.segments().collect();
            assert_eq!(segs.len(), 1, "{x}");
            let (from, to) = (segs[0].eval(0.0), segs[0].eval(1.0));
            for k in 0..=200 {
                let p = segs[0].eval(f64::from(k) / 200.0);
                assert!((p - from).cross(to - from).abs() / (to - from).hypot() < 1e-9, "{x}: bent");
            }
            let lean = (to.x - from.x).abs().atan2((to.y - from.y).abs()).to_degrees();
            assert!(lean < 0.1, "{x} leans by {lean}°");
            // Its ends lie at the same share of the width of both curves.
            assert!((from.x - 3.6 * x).abs() < 1e-9, "{x} {from:?}");
        }
    }
    // Without an exact map the verticals are still straight, and a warning gives their lean.
    let b = built(&[
        ("bottom", "M0,100 A50,50 0 0 1 100,100"),
        ("top", "M-20,100 A70,70 0 0 1 120,100"),
        ("keep", "verticals"),
    ])
    .unwrap();
    assert!(b.explanation.warnings.iter().any(|w| w.contains("lean by up to 90.0°")), "{:?}", b.explanation.warnings);
    let bent = |m: &dyn Map, x: f64| {
        let [a, b, c] = [0.0, 40.0, 100.0].map(|y| m.point(Point::new(x, y)));
        (b - a).cross(c - a).abs() / (c - a).hypot()
    };
    assert!((0..=20).all(|i| bent(&*b.map, 5.0 * f64::from(i)) < 1e-10));
}

#[test]
fn keep_says_when_nothing_can() {
    let curved = "M0,0 L100,0 Q130,50 100,100 L0,100 Z";
    let e = fault(&[("envelope", curved), ("keep", "lines")]);
    assert!(e.contains("four straight sides") && e.contains("right side"), "{e}");
    // Here the lines can be kept.
    let m = map(&[("envelope", curved), ("keep", "horizontals")]);
    assert!((m.point(Point::new(70.0, 30.0)).y - 30.0).abs() < 1e-10);
    let m = map(&[("envelope", "0,90 100,80 80,10 10,0"), ("keep", "lines")]);
    assert!(matches!(m.class(), Class::Projective(_)));
}

/// Columns agree with (u, v) ↦ (x, b(x) + v·(t(x) − b(x))) for outlines whose heights are known.
#[test]
fn columns_by_the_formula() {
    /// A shape whose columns reach from end to end: its path, its range of x, and its upper and lower outline at x.
    type Shape = (&'static str, [f64; 2], fn(f64) -> [f64; 2]);
    let shapes: [Shape; 4] = [
        ("M200,100 A100,100 0 1 1 0,100 A100,100 0 1 1 200,100 Z", [0.0, 200.0], |x| {
            let h = (x * (200.0 - x)).max(0.0).sqrt();
            [100.0 - h, 100.0 + h]
        }),
        // Both quadratics: x = 200 t, y = 60 ∓ 200 t (1 − t).
        ("M0,60 Q100,-40 200,60 Q100,160 0,60 Z", [0.0, 200.0], |x| {
            let h = x * (200.0 - x) / 200.0;
            [60.0 - h, 60.0 + h]
        }),
        ("M50,10 L150,10 L195,95 L150,180 L50,180 L5,95 Z", [5.0, 195.0], |x| {
            let h = 85.0 * ((100.0 - (x - 100.0).abs() - 5.0) / 45.0).min(1.0);
            [95.0 - h, 95.0 + h]
        }),
        // An arrow: the columns continue at the level of the shaft, then along the head.
        ("M0,60 H120 V20 L200,100 L120,180 V140 H0 Z", [0.0, 200.0], |x| {
            let h = (200.0 - x).min(40.0);
            [100.0 - h, 100.0 + h]
        }),
    ];
    for (path, [from, to], heights) in shapes {
        for ends in [0.0, 0.25] {
            let text = ends.to_string();
            let m = map(&[("envelope", path), ("keep", "verticals"), ("ends", &text)]);
            let height = |x: f64| heights(x)[1] - heights(x)[0];
            let steps = 200_000;
            let xs = (0..=steps).map(|i| from + (to - from) * f64::from(i) / f64::from(steps));
            let most = xs.clone().map(height).fold(0.0, f64::max);
            let inside: Vec<f64> = xs.filter(|x| height(*x) >= ends * most).collect();
            let (first, last) = (inside[0], inside[inside.len() - 1]);
            for p in grid(20, 0.0) {
                let x = first + (last - first) * p.x / 100.0;
                let [top, bottom] = heights(x);
                let wanted = Point::new(x, top + (bottom - top) * p.y / 100.0);
                let got = m.point(p);
                // The ends are known to one column, where the circle is steep.
                assert!(
                    got.distance(wanted) < 0.02 * if ends == 0.0 { 1e-6 } else { 1.0 },
                    "{path} {p:?}: {got:?} {wanted:?}"
                );
                assert!((m.point(Point::new(p.x, 0.0)).x - got.x).abs() < 1e-9, "{path} {p:?} is not upright");
            }
            let back = m.inverse().unwrap();
            for p in grid(7, -5.0) {
                assert!(back.point(m.point(p)).distance(p) < 1e-8, "{path} {p:?}");
            }
        }
    }
    // Rows are columns of the path with x and y exchanged.
    let heart = "M100,50 C118,0 200,0 200,65 C200,120 140,145 100,185 C60,145 0,120 0,65 C0,0 82,0 100,50 Z";
    let swapped = "M50,100 C0,118 0,200 65,200 C120,200 145,140 185,100 C145,60 120,0 65,0 C0,0 0,82 50,100 Z";
    let (columns, rows) =
        (map(&[("envelope", heart), ("keep", "verticals")]), map(&[("envelope", swapped), ("keep", "horizontals")]));
    for p in grid(11, 0.0) {
        let (a, b) = (columns.point(p), rows.point(Point::new(p.y, p.x)));
        assert!(a.distance(Point::new(b.y, b.x)) < 1e-9, "{p:?}: {a:?} {b:?}");
    }
}

/// Two curves that meet at both ends enclose a shape, which is filled like the same closed path.
#[test]
fn curves_that_meet_enclose_a_shape() {
    let drawn = map(&[
        ("bottom", "M0,100 A100,100 0 0 0 200,100"),
        ("top", "M0,100 A100,100 0 0 1 200,100"),
        ("keep", "verticals"),
    ]);
    let closed = map(&[("envelope", "M200,100 A100,100 0 1 1 0,100 A100,100 0 1 1 200,100 Z"), ("keep", "verticals")]);
    for p in grid(20, 0.0) {
        assert!(drawn.point(p).distance(closed.point(p)) < 1e-9, "{p:?}");
    }
    let e = fault(&[("bottom", "0,9 9,9"), ("top", "0,9 9,9")]);
    assert!(e.starts_with("envelope: "), "{e}");
}

/// The map chosen for lettering and for other artwork suits the shape.
#[test]
fn what_suits_is_chosen() {
    let chosen = |path: &str, lettering: bool| {
        let outline = Outline::from_svg(path).unwrap();
        let built = Envelope::new(Rect::new(0.0, 0.0, 300.0, 100.0), &outline).lettering(lettering).build().unwrap();
        let notes = built.explanation.notes.join("\n");
        if notes.contains("columns") { "columns" } else { "sides" }
    };
    let honest = [
        "M0,40 Q100,0 200,40 L190,70 L200,100 Q100,60 0,100 L10,70 Z",
        "M0,40 Q100,10 200,40 L190,70 L200,100 Q100,70 0,100 L10,70 Z",
        "M0,25 C60,-15 130,55 200,20 V120 C130,155 60,85 0,125 Z",
        "M40,0 H160 L200,100 H0 Z",
        "M0,30 C60,10 140,10 200,30 L180,70 L200,110 C140,90 60,90 0,110 L20,70 Z",
        "M0,0 H200 V100 H0 Z",
    ];
    let filled = [
        "M0,60 Q100,-40 200,60 Q100,160 0,60 Z",
        "M200,100 A100,100 0 1 1 0,100 A100,100 0 1 1 200,100 Z",
        "M40,10 H160 a40,40 0 0 1 0,80 H40 a40,40 0 0 1 0,-80 Z",
        "M100,0 C110,40 165,75 165,120 A65,65 0 0 1 35,120 C35,75 90,40 100,0 Z",
        "M100,50 C118,0 200,0 200,65 C200,120 140,145 100,185 C60,145 0,120 0,65 C0,0 82,0 100,50 Z",
        "M50,10 L150,10 L195,95 L150,180 L50,180 L5,95 Z",
        "M100,0 L200,170 L0,170 Z",
        "M100,0 L200,80 V180 H0 V80 Z",
        "M100,0 L200,80 L100,160 L0,80 Z",
        "M80,0 H120 V50 C120,75 160,80 160,115 V190 H40 V115 C40,80 80,75 80,50 Z",
    ];
    for path in honest {
        assert_eq!([chosen(path, true), chosen(path, false)], ["sides"; 2], "{path}");
    }
    for path in filled {
        assert_eq!(chosen(path, true), "columns", "{path}");
    }
}

/// Lettering in a swallow-tailed banner ends at the notches, through which its outermost verticals go.
#[test]
fn letters_end_at_notches() {
    let outline =
        Outline::from_svg("M0,30 C60,10 140,10 200,30 L180,70 L200,110 C140,90 60,90 0,110 L20,70 Z").unwrap();
    let built = Envelope::new(SQUARE, &outline).lettering(true).build().unwrap();
    assert!(built.explanation.notes.iter().any(|n| n.contains("end at 20,70")), "{:?}", built.explanation.notes);
    let off = |x: f64, notch: Point| {
        let [a, b] = [100.0, 0.0].map(|y| built.map.point(Point::new(x, y)));
        ((b - a).cross(notch - a) / (b - a).hypot()).abs()
    };
    assert!(off(0.0, Point::new(20.0, 70.0)) < 1e-9 && off(100.0, Point::new(180.0, 70.0)) < 1e-9);
}

/// Letters stay on one side of a waist.
#[test]
fn letters_do_not_run_through_a_waist() {
    let fish = "M0,80 C40,20 110,20 150,80 L200,40 V120 L150,80 C110,140 40,140 0,80 Z";
    let m = map(&[("envelope", fish), ("keep", "verticals"), ("ends", "0.25")]);
    assert!(grid(40, 0.0).all(|p| m.point(p).x < 150.0));
}

/// A speech bubble's tail stays free, and padded artwork keeps its distance from the outline.
#[test]
fn tails_and_edges_stay_free() {
    let bubble = "M20,0 H180 A20,20 0 0 1 200,20 V100 A20,20 0 0 1 180,120 H90 L55,150 V120 H20 A20,20 0 0 1 0,100 V20 A20,20 0 0 1 20,0 Z";
    let m = map(&[("envelope", bubble), ("keep", "verticals")]);
    assert!(grid(40, 0.0).all(|p| m.point(p).y <= 120.0 + 1e-9));
    let circle = "M200,100 A100,100 0 1 1 0,100 A100,100 0 1 1 200,100 Z";
    let m = map(&[("envelope", circle), ("keep", "verticals"), ("padding", "10")]);
    for p in grid(40, 0.0) {
        let r = m.point(p).distance(Point::new(100.0, 100.0));
        assert!(r <= 90.0 + 0.01, "{p:?} lies {r} from the centre");
    }
}

#[test]
fn crossings_and_folds_are_named() {
    let warned = |pairs: &[(&str, &str)], what: &[&str]| {
        let w = built(pairs).unwrap().explanation.warnings.join("\n");
        assert!(what.iter().all(|t| w.contains(t)), "{what:?}:\n{w}");
    };
    // A loop in the bottom; it crosses itself on its axis, x = 50.
    warned(
        &[("bottom", "M0,100 C150,20 -50,20 100,100"), ("top", "0,0 100,0")],
        &["the bottom side crosses itself near 50,"],
    );
    warned(
        &[("bottom", "0,100 100,20"), ("top", "0,50 100,60")],
        &["the bottom and the top side cross near 55.5", "folds over"],
    );
    // The sides cross in the middle of both, at a joint of chords.
    warned(
        &[("bottom", "0,100 100,0"), ("top", "0,0 100,100")],
        &["the bottom and the top side cross near 50,50", "folds over"],
    );
    // The bottom doubles back without crossing anything.
    let hook = [("bottom", "0,100 80,90 20,60 100,40"), ("top", "0,0 100,0")];
    warned(&hook, &["folds over near", "nearest to the bottom side"]);
    assert_eq!(built(&hook).unwrap().explanation.warnings.len(), 1);
    assert!(
        built(INFO.demo).unwrap().explanation.warnings.is_empty(),
        "{:?}",
        built(INFO.demo).unwrap().explanation.warnings
    );
}

#[test]
fn every_fault_is_named() {
    assert!(fault(&[]).contains("envelope is needed"));
    assert!(fault(&[("envelope", "M0,0 Q50,50 100,0")]).contains("not closed"));
    assert!(fault(&[("envelope", "0,0 100,0 200,0")]).contains("is flat"));
    assert!(fault(&[("bottom", "M0,0 L1,0 L1,1 Z")]).contains("for a closed path use `envelope`"));
    assert!(fault(&[("left", "0,0 0,9")]).contains("right is needed"));
    assert!(fault(&[("bottom", "0,9 9,9"), ("left", "0,9 0,0")]).contains("top is needed"));
    assert!(fault(&[("bottom", "0,9 9,9"), ("top", "0,0 9,0"), ("left", "1,9 1,0")]).contains("does not meet"));
    assert!(fault(&[("bottom", "0,9 9,9"), ("top", "0,0 9,0"), ("height", "3")]).contains("height: `3` goes with"));
    assert!(fault(&[("envelope", "0,0 9,0 9,9 0,9"), ("top", "0,0 9,0")]).contains("cannot go with"));
    assert!(fault(&[("envelope", "0,0 9,0 9,9 0,9"), ("corners", "1,2,3,7")]).contains("nodes 1 to 4"));
    assert!(fault(&[("envelope", "0,0 9,0 9,9 0,9"), ("corners", "1,2,3,3")]).contains("twice"));
    assert!(fault(&[("envelope", "0,0 9,0 9,9 0,9"), ("corners", "1,2,3")]).contains("corners: `1,2,3`"));
    assert!(fault(&[("bottom", "M0,0 C150,20 -50,20 100,0"), ("by", "extent")]).contains("bottom side does not"));
    let many = (0..2100).map(|i| format!("{},{}", i, (i % 7) * (i % 5))).collect::<Vec<_>>().join(" ");
    assert!(fault(&[("envelope", &many)]).contains("the limit is 2000"));
}

/// The general inverse by Newton's method returns to the source at every pace, across joints too.
#[test]
fn it_can_be_undone() {
    let path = "M0,100 C20,120 40,80 50,100 Q70,130 110,95 L100,50 Q120,20 100,-10 C70,-30 30,10 -5,5 Q20,60 0,100 Z";
    for by in ["length", "parameter", "extent"] {
        let m = map(&[("envelope", path), ("corners", "1,3,5,6"), ("by", by)]);
        let back = crate::map::NewtonInverse::over(Arc::clone(&m), SQUARE, 0.25);
        for p in grid(23, -1.0) {
            let q = back.point(m.point(p));
            assert!(q.distance(p) < 1e-9, "{by} {p:?} {q:?}");
        }
    }
}
