//! Compares bends with the paper and with exact shapes, and tests the settings of letters.

use super::*;
use crate::check;
use crate::deform::Deformation as _;
use crate::map::{Creases, Level, Map as _, RationalBezier};
use crate::outline::Seg;
use crate::param::Args;
use kurbo::Point;

#[test]
fn is_sound() {
    let faults = check::entry(&ENTRY);
    assert!(faults.is_empty(), "{faults:#?}");
}

fn build(pairs: &[(&str, &str)]) -> Result<Built, Error> {
    ENTRY.build_from(&Args::from_pairs(pairs), &check::frame())
}

fn with_handles(pairs: &[(&str, &str)], json: &str) -> Result<Built, Error> {
    let mut args = Args::from_pairs(pairs);
    args.push("handles", "h.json");
    args.resolve_files(INFO.params, |_| Ok(json.to_owned()))?;
    ENTRY.build_from(&args, &check::frame())
}

/// Derivatives agree with differences, and branches with the map, on every kind of skeleton, away from the joints.
#[test]
fn jets_are_right_on_every_kind_of_skeleton() {
    for along in [
        "M0,60 C30,20 70,90 100,50",
        "M0,60 A60,40 20 0 1 100,50",
        "0,40 30,60 70,50 110,90",
        "M10,50 A40,40 0 1 1 90,50 A40,40 0 1 1 10,50 Z",
        "M0,60 C0,60 50,0 100,50 C120,60 140,60 140,60",
    ] {
        for by in ["arclength", "parameter"] {
            let m = build(&[("along", along), ("by", by), ("stretch", "fit"), ("width", "0.2")]).unwrap().map;
            for i in 0..40 {
                let p = Point::new(-20.1 + 3.7 * f64::from(i), 30.0 + f64::from(i));
                let (j, h) = (m.jet(p), 1e-5);
                let dx = (m.point(p + Vec2::new(h, 0.0)) - m.point(p - Vec2::new(h, 0.0))) / (2.0 * h);
                let dy = (m.point(p + Vec2::new(0.0, h)) - m.point(p - Vec2::new(0.0, h))) / (2.0 * h);
                let off = (dx - j.dx).hypot() + (dy - j.dy).hypot();
                assert!(off < 1e-5 * (1.0 + j.dx.hypot()), "{along} {by} {p:?} {off:e}: {j:?} {dx:?}");
                let b = m.branch(p).unwrap().jet(p);
                assert!(b.p.distance(j.p) < 1e-12 && (b.dx - j.dx).hypot() < 1e-12);
            }
        }
    }
}

/// Equal steps of x are equal distances along the skeleton, and heights are heights.
#[test]
fn by_arc_length_nothing_is_stretched_on_the_skeleton() {
    let m = build(&[("along", "M0,60 C30,0 60,120 100,50 S 150,0 170,70"), ("align", "start")]).unwrap().map;
    for i in 0..=100 {
        let x = f64::from(i);
        let j = m.jet(Point::new(x, 50.0));
        assert!((j.dx.hypot() - 1.0).abs() < 1e-12 && (j.dy.hypot() - 1.0).abs() < 1e-12, "{x}: {j:?}");
        assert!(j.dx.dot(j.dy).abs() < 1e-12);
    }
}

/// Neighbouring pieces meet on every joint, corners included, at any height.
#[test]
fn joints_do_not_tear() {
    for by in ["arclength", "parameter"] {
        let along = "M0,50 L40,20 Q60,10 70,40 C80,70 100,80 120,60 A30,30 0 0 1 150,60";
        let b = build(&[("along", along), ("by", by), ("align", "start")]).unwrap();
        assert!(b.explanation.notes.iter().any(|n| n.contains("corner")), "{:?}", b.explanation.notes);
        let mut creases = Creases::default();
        b.map.creases(&mut creases);
        assert!(creases.items().len() >= 4);
        for c in creases.items() {
            let Level::Line { a, c, .. } = c.level else { panic!("joints are vertical lines") };
            for y in [0.0, 30.0, 77.0] {
                let at = |dx: f64| b.map.point(Point::new(-c / a + dx, y));
                assert!(at(-1e-9).distance(at(1e-9)) < 1e-6, "{by} {c} {y}: {:?} {:?}", at(-1e-9), at(1e-9));
            }
        }
    }
}

#[test]
fn folds_are_reported_with_the_radius() {
    // A circle of radius 30, up outside: the bottom of the box reaches 50 inwards.
    let ring = "M20,50 A30,30 0 1 1 80,50 A30,30 0 1 1 20,50 Z";
    let w = build(&[("along", ring)]).unwrap().explanation.warnings;
    assert!(w.iter().any(|w| w.contains("folds") && w.contains("more than 30.0000")), "{w:?}");
    let w = build(&[("along", ring), ("baseline", "0")]).unwrap().explanation.warnings;
    assert!(w.is_empty(), "{w:?}");
    // At a sharp corner even points of the skeleton are turned over, so the warning gives no distance.
    let corner = "M35,63 C64,65 45,84 58,59 C44,72 92,71 92,58";
    let w = build(&[("along", corner), ("baseline", "74%")]).unwrap().explanation.warnings;
    assert!(w.iter().any(|w| w.contains("folds")) && !w.iter().any(|w| w.contains("more than -")), "{w:?}");
    let w = build(&[("along", "M0,0 L50,0")]).unwrap().explanation.warnings;
    assert!(w.iter().any(|w| w.contains("continues straight")), "{w:?}");
}

#[test]
fn a_closed_skeleton_closes_and_runs_on() {
    let ring = "M20,50 A30,30 0 1 0 80,50 A30,30 0 1 0 20,50 Z";
    let m = build(&[("along", ring), ("stretch", "fit"), ("baseline", "0")]).unwrap().map;
    for y in [20.0, 100.0] {
        assert!(m.point(Point::new(0.0, y)).distance(m.point(Point::new(100.0, y))) < 1e-10);
        assert!(m.point(Point::new(-30.0, y)).distance(m.point(Point::new(70.0, y))) < 1e-10);
    }
    // The middle is on top, although the ring starts at the left and was drawn counter-clockwise; up is outside.
    assert!(m.point(Point::new(50.0, 100.0)).distance(Point::new(50.0, 20.0)) < 0.2);
    assert!(m.point(Point::new(50.0, 50.0)).y < 0.0);
}

/// The ends of a whole circle meet, so neither is left of the other.
#[test]
fn whole_circles_run_as_they_say() {
    for from in (0..360).step_by(15) {
        let along = format!("arc:r=30,from={from},to={},cx=50,cy=50", from + 360);
        let m = build(&[("along", &along), ("baseline", "0")]).unwrap().map;
        let [x, y] = [f64::cos, f64::sin].map(|f| f(f64::from(from + 180).to_radians()));
        let j = m.jet(Point::new(50.0, 100.0));
        assert!(j.p.distance(Point::new(50.0 + 30.0 * x, 50.0 + 30.0 * y)) < 1e-9, "{from}: {:?}", j.p);
        assert!((j.dx - Vec2::new(-y, x)).hypot() < 1e-9, "{from}: {:?}", j.dx);
    }
}

#[test]
fn the_polynomial_mode_has_exact_images() {
    let m = build(&[("along", "M0,60 C30,20 70,90 100,50 S150,0 200,60"), ("by", "parameter"), ("stretch", "fit")])
        .unwrap()
        .map;
    let source = RationalBezier::from_seg(&Seg::Line(kurbo::Line::new((5.0, 10.0), (40.0, 90.0)))).unwrap();
    let image = m.branch(Point::new(20.0, 50.0)).unwrap().image(&source).unwrap();
    // Handles at the points of cubic pieces: C has degree 3, v·S one more.
    assert_eq!(image.degree(), 4);
    for i in 0..=10 {
        let t = f64::from(i) / 10.0;
        assert!(image.eval(t).distance(m.point(source.eval(t))) < 1e-10);
    }
}

/// With handles from a file, the box's top edge lies at the ends of the handles, and the joint conditions are reported.
#[test]
fn handles_from_a_file() {
    let along = ("along", "M0,100 Q50,60 100,100");
    let args = [along, ("stretch", "fit"), ("by", "parameter"), ("baseline", "0")];
    let m = with_handles(&args, r#"{"pieces":[{"levels":[[[-10,-50],[20,-70]],[[5,5]]]}]}"#).unwrap().map;
    let near = |p: (f64, f64), q: (f64, f64)| m.point(p.into()).distance(q.into()) < 1e-12;
    assert!(
        near((0.0, 100.0), (0.0, 100.0)) && near((100.0, 100.0), (100.0, 100.0)) && near((50.0, 100.0), (50.0, 80.0))
    );
    assert!(near((0.0, 0.0), (-5.0, 55.0)) && near((100.0, 0.0), (125.0, 35.0)) && near((50.0, 0.0), (60.0, 25.0)));

    let two = [("along", "M0,50 Q25,20 50,50 T100,50"), ("stretch", "fit"), ("by", "parameter")];
    let smooth = r#"{"pieces":[{"levels":[[[0,-9],[4,-12]]]},{"levels":[[[4,-12],[8,-15]]]}]}"#;
    let notes = with_handles(&two, smooth).unwrap().explanation.notes.join("\n");
    assert!(notes.contains("joint at 50,50 is C¹"), "{notes}");
    let kinked = r#"{"pieces":[{"levels":[[[0,-9],[4,-12]]]},{"levels":[[[4,-12],[0,-15]]]}]}"#;
    let notes = with_handles(&two, kinked).unwrap().explanation.notes.join("\n");
    assert!(notes.contains("on the skeleton only"), "{notes}");

    for (json, part) in [
        (r#"{"pieces":[{"levels":[[[0,-9],[4,-12]]]},{"levels":[[[9,-12],[0,-15]]]}]}"#, "tear"),
        (r#"{"pieces":[{"levels":[[[0,-9]]]},{"levels":[[[0,-9]]]}]}"#, "need 2, 1 handles"),
        (r#"{"pieces":[]}"#, "for 0 pieces"),
        (r#"{"piece":[]}"#, "unknown field"),
        ("[", "is not a file of handles"),
    ] {
        let e = with_handles(&two, json).err().unwrap().to_string();
        assert!(e.contains(part), "{e}");
    }
    assert!(with_handles(&[("along", "M0,50 A50,50 0 0 1 100,50")], smooth).is_err());
}

#[test]
fn skeletons_that_cannot_be_followed_are_refused() {
    let fault = |along: &str| build(&[("along", along)]).err().unwrap().to_string();
    assert!(fault("M0,0 L50,0 L0,0.1").contains("turns back on itself at 50,0"));
    assert!(fault("M0,0 L5,0 M6,0 L9,9").contains("single connected run"));
    assert!(fault("M5,5 L5,5").contains("no length"));
}

/// Three copies fit a line of three times the width, two with gaps; on a circle they are spread evenly.
#[test]
fn artwork_is_repeated_as_often_as_there_is_room() {
    let row = |along: &str, gap: &str| {
        let b = build(&[("along", along), ("stretch", "repeat"), ("gap", gap), ("baseline", "0")]).unwrap();
        let places: Vec<Point> = b.placement.copies.iter().map(|m| b.map.point(*m * Point::new(0.0, 100.0))).collect();
        (places, b.explanation.warnings)
    };
    let near = |a: &[Point], b: &[(f64, f64)]| {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.distance(Point::from(*b)) < 1e-9)
    };
    let (places, warnings) = row("20,50 320,50", "0");
    assert!(
        near(&places, &[(20.0, 50.0), (120.0, 50.0), (220.0, 50.0)]) && warnings.is_empty(),
        "{places:?} {warnings:?}"
    );
    let (places, _) = row("20,50 320,50", "10%");
    assert!(near(&places, &[(20.0, 50.0), (220.0, 50.0)]), "{places:?}");
    let (places, warnings) = row("0,50 60,50", "0");
    assert!(places.len() == 1 && warnings.len() == 1, "{places:?} {warnings:?}");

    // A circle of radius 100 is 628.3 long: six, or five with gaps of 5 at least.
    for (gap, count) in [("0", 6), ("5", 5), ("-10", 6)] {
        let (places, warnings) = row("M0,0 A100,100 0 1 1 200,0 A100,100 0 1 1 0,0 Z", gap);
        assert!(places.len() == count && warnings.is_empty(), "{places:?} {warnings:?}");
        let chord = 200.0 * (std::f64::consts::PI / count as f64).sin();
        for i in 0..count {
            let d = places[i].distance(places[(i + 1) % count]);
            assert!((d - chord).abs() < 1e-9, "{i}: {d} {chord}");
        }
    }
    let fault =
        |gap: &str| build(&[("along", "0,50 320,50"), ("stretch", "repeat"), ("gap", gap)]).err().unwrap().to_string();
    assert!(fault("-100").contains("would not advance") && fault("-99.999").contains("the limit is"));
}

/// Measured at half the height, equal steps of x are equal distances there, and the derivatives are right.
#[test]
fn even_spacing_keeps_widths_at_half_the_height() {
    for along in ["M0,60 C60,-40 140,160 300,50", "M-100,150 A150,150 0 0 1 200,150", "0,80 400,40"] {
        let pairs = [("along", along), ("spacing", "even"), ("baseline", "0"), ("align", "start"), ("width", "0.4")];
        let m = build(&pairs).unwrap().map;
        for i in 0..100 {
            let p = Point::new(0.05 + f64::from(i), 50.0);
            let (j, h) = (m.jet(p), 1e-5);
            assert!((j.dx.hypot() - 1.0).abs() < 1e-9, "{along}: {p:?} {j:?}");
            for p in [p, Point::new(p.x, 90.0)] {
                let dx = (m.point(p + Vec2::new(h, 0.0)) - m.point(p - Vec2::new(h, 0.0))) / (2.0 * h);
                assert!((dx - m.jet(p).dx).hypot() < 1e-5, "{along} {p:?}");
            }
        }
        // Scaled, the artwork is as long at half its height as the skeleton's offset there.
        let m =
            build(&[("along", along), ("spacing", "even"), ("baseline", "0"), ("stretch", "scale"), ("width", "0.4")]);
        let m = m.unwrap().map;
        let (a, b) = (m.jet(Point::new(10.0, 50.0)), m.jet(Point::new(90.0, 50.0)));
        assert!((a.dx.hypot() - b.dx.hypot()).abs() < 1e-8);
        assert!((a.dy.hypot() - 0.4 * a.dx.hypot()).abs() < 1e-6, "{along}: {} {}", a.dy.hypot(), a.dx.hypot());
    }
    let fault = |more: (&str, &str)| {
        let pairs = [("along", "M20,50 A30,30 0 1 0 80,50"), ("spacing", "even"), ("as-drawn", "true"), more];
        build(&pairs).err().map(|e| e.to_string()).unwrap_or_default()
    };
    assert!(fault(("baseline", "0")).contains("gentler bend"), "{}", fault(("baseline", "0")));
    assert!(fault(("by", "parameter")).contains("`by arclength`"));
}

/// On a circle of radius 100 about 0,0 a letter whose middle is at distance s from the top is turned by s/100.
#[test]
fn letters_stand_on_a_circle() {
    let outline = Outline { subpaths: Vec::new() };
    let letter =
        |x: f64| Letter { name: "n".into(), origin: Point::new(x, 90.0), advance: 10.0, outline: outline.clone() };
    let frame = || check::frame().on_baseline(90.0).with_letters([letter(20.0), letter(65.0)].into());
    let set = |how: &str| {
        let args = [("along", "M-100,0 A100,100 0 0 1 100,0"), ("glyphs", how)];
        ENTRY.build_from(&Args::from_pairs(&args), &frame()).unwrap().placement.letters
    };
    for (k, middle) in [(0, 25.0), (1, 70.0)] {
        let (sin, cos) = ((middle - 50.0) / 100.0_f64).sin_cos();
        // A point 3 to the right of the middle and 7 above the baseline.
        let p = Point::new(middle + 3.0, 83.0);
        let c = Vec2::new(100.0 * sin, -100.0 * cos);
        let wanted = [
            ("rotate", c + Vec2::new(cos, sin) * 3.0 + Vec2::new(sin, -cos) * 7.0),
            ("skew", c + Vec2::new(cos, sin) * 3.0 + Vec2::new(0.0, -7.0)),
            ("ribbon", c + Vec2::new(3.0, 0.0) + Vec2::new(sin, -cos) * 7.0),
        ];
        for (how, to) in wanted {
            let [m] = set(how)[k][..] else { panic!("one copy") };
            assert!((m * p).distance(to.to_point()) < 1e-10, "{how} {k}: {:?} {to:?}", m * p);
        }
        // In stairs, the start of the advance is on the circle.
        let (sin, cos) = ((middle - 55.0) / 100.0_f64).sin_cos();
        let [m] = set("stair")[k][..] else { panic!("one copy") };
        let on = Point::new(100.0 * sin, -100.0 * cos);
        assert!((m * Point::new(middle - 5.0, 90.0)).distance(on) < 1e-10);
        assert_eq!(m.as_coeffs()[..4], [1.0, 0.0, 0.0, 1.0]);
    }
}

fn objects(widths: &[f64]) -> Arc<[Letter]> {
    let at = |i: usize| Point::new(30.0 * i as f64, 0.0);
    let one =
        |(i, w): (usize, &f64)| Letter { name: i.to_string(), origin: at(i), advance: *w, outline: Outline::default() };
    widths.iter().enumerate().map(one).collect()
}

/// Around a circle of radius 50 about 50,50, the distance between the middles of neighbouring objects is half of both widths and a gap,
/// which is the same everywhere, also from the last to the first.
#[test]
fn copies_of_a_cycle_close_on_a_ring_with_equal_gaps() {
    let (widths, length) = ([10.0, 4.0, 7.0], 100.0 * std::f64::consts::PI);
    let frame = check::frame().with_objects(objects(&widths));
    for (copies, count) in [("5", 5), ("fill", (length / (21.0 + 3.0 * 2.0)) as usize)] {
        for glyphs in ["rotate", "stair"] {
            let args = [("along", CIRCLE), ("glyphs", glyphs), ("copies", copies), ("gap", "2"), ("baseline", "0")];
            let built = ENTRY.build_from(&Args::from_pairs(&args), &frame).unwrap();
            let places = &built.placement.letters;
            assert!(built.placement.of_objects && built.placement.copies.is_empty());
            assert!(places.len() == 3 && places.iter().all(|p| p.len() == count));
            let gap = (length - count as f64 * 21.0) / (3 * count) as f64;
            let mut s = 0.0;
            for k in 0..3 * count {
                let (m, w) = (places[k % 3][k / 3], widths[k % 3]);
                let middle = Point::new(30.0 * (k % 3) as f64 + 0.5 * w, 100.0);
                let (sin, cos) = (s / 50.0_f64).sin_cos();
                assert!((m * middle).distance(Point::new(50.0 + 50.0 * sin, 50.0 - 50.0 * cos)) < 1e-9, "{copies} {k}");
                let turned = if glyphs == "rotate" { Vec2::new(cos, sin) } else { Vec2::new(1.0, 0.0) };
                assert!((m * (middle + Vec2::new(1.0, 0.0)) - m * middle - turned).hypot() < 1e-9);
                s += 0.5 * w + gap + 0.5 * widths[(k + 1) % 3];
            }
            assert!((s - length).abs() < 1e-9);
        }
    }
}

#[test]
fn objects_reach_from_end_to_end_of_an_open_skeleton() {
    let frame = check::frame().with_objects(objects(&[10.0, 20.0]));
    let built = |more: &[(&str, &str)]| {
        let args = [&[("along", "M0,0H200"), ("glyphs", "rotate")], more].concat();
        ENTRY.build_from(&Args::from_pairs(&args), &frame).unwrap()
    };
    let starts = |b: &Built| -> Vec<f64> {
        let at = |i: usize| move |m: &Affine| (*m * Point::new(30.0 * i as f64, 0.0)).x;
        (0..2).flat_map(|i| b.placement.letters[i].iter().map(at(i))).collect()
    };
    // Three times 30 wide in 200, with 5 gaps of 22.
    let wanted = [0.0, 74.0, 148.0, 32.0, 106.0, 180.0];
    assert!(starts(&built(&[("copies", "3")])).iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-9));
    assert!(starts(&built(&[("stretch", "fit")])).iter().zip([0.0, 180.0]).all(|(a, b)| (a - b).abs() < 1e-9));
    // By default, the middle of the frame lies on the middle of the skeleton.
    assert!(starts(&built(&[])).iter().zip([50.0, 80.0]).all(|(a, b)| (a - b).abs() < 1e-9));
    assert!(built(&[("copies", "3")]).explanation.warnings.is_empty());
    let crowded = built(&[("copies", "7")]).explanation.warnings;
    assert!(crowded.iter().any(|w| w.contains("only 6 copies fit")), "{crowded:?}");
}

#[test]
fn senseless_copies_are_refused() {
    let frame = check::frame().with_objects(objects(&[10.0]));
    for (args, problem) in [
        (&[("copies", "0")][..], "neither a number"),
        (&[("copies", "many")], "neither a number"),
        (&[("copies", "2"), ("stretch", "fit")], "cannot be stretched"),
        (&[("copies", "10001"), ("glyphs", "rotate")], "the limit is 10000"),
        (&[("copies", "fill"), ("gap", "-20"), ("glyphs", "rotate")], "would not advance"),
    ] {
        let args = [&[("along", CIRCLE)], args].concat();
        let refused = ENTRY.build_from(&Args::from_pairs(&args), &frame).err().unwrap().to_string();
        assert!(refused.contains(problem), "{refused}");
    }
    assert!(build(&[("along", CIRCLE), ("glyphs", "rotate")]).err().unwrap().to_string().contains("neither"));
}

/// Letters around a whole ring keep their widths. The gaps between them grow equally, the one from the last to the first twice as much.
#[test]
fn text_around_a_ring_is_spread_and_not_widened() {
    let letters: Vec<Letter> = (0..4)
        .map(|i| Letter {
            name: "I".into(),
            origin: Point::new(12.0 * f64::from(i), 100.0),
            advance: 10.0,
            outline: Outline::from_points(
                &[(0.0, 100.0), (10.0, 90.0)].map(|(x, y)| Point::new(x + 12.0 * f64::from(i), y)),
                false,
            ),
        })
        .collect();
    let frame =
        crate::param::Frame::new(Rect::new(0.0, 80.0, 46.0, 100.0)).on_baseline(100.0).with_letters(letters.into());
    let built = ENTRY.build_from(&Args::from_pairs(&[("along", CIRCLE), ("stretch", "fit")]), &frame).unwrap();
    assert!(built.placement.before && !built.placement.of_objects);
    let place =
        |i: usize, x: f64| built.map.point(built.placement.letters[i][0] * Point::new(12.0 * i as f64 + x, 100.0));
    let angle = |p: Point| (p - Point::new(50.0, 50.0)).angle();
    let along = |a: Point, b: Point| 50.0 * (angle(b) - angle(a)).rem_euclid(std::f64::consts::TAU);
    let spare = 100.0 * std::f64::consts::PI - 46.0;
    for i in 0..4 {
        assert!((along(place(i, 0.0), place(i, 10.0)) - 10.0).abs() < 1e-9);
        let gap = if i == 3 { 2.0 * spare / 5.0 } else { 2.0 + spare / 5.0 };
        assert!((along(place(i, 10.0), place((i + 1) % 4, 0.0)) - gap).abs() < 1e-9, "{i}");
    }
}

/// Artwork turns near the corners of a polygon. The rest of its sides is not sheared, and neither side of a corner folds.
#[test]
fn sides_of_a_polygon_are_straight_between_their_corners() {
    // A tenth of the frame stands on each side of the skeleton, so the blends at a right angle are 30 long.
    let m = build(&[("along", "0,0 1000,0 1000,1000"), ("align", "start"), ("width", "0.2")]).unwrap().map;
    for i in 0..40 {
        let (s, y) = (25.0 * f64::from(i) - 20.0, 2.5 * f64::from(i));
        let d = 0.2 * (50.0 - y);
        for (s, expected, dx, dy) in [
            (s.min(969.0), Point::new(s.min(969.0), -d), Vec2::new(1.0, 0.0), Vec2::new(0.0, 0.2)),
            (1031.0 + s.max(0.0), Point::new(1000.0 + d, 31.0 + s.max(0.0)), Vec2::new(0.0, 1.0), Vec2::new(-0.2, 0.0)),
        ] {
            let j = m.jet(Point::new(s, y));
            assert!(j.p.distance(expected) < 1e-9 && (j.dx - dx).hypot() + (j.dy - dy).hypot() < 1e-12, "{s} {j:?}");
        }
        let near = m.jet(Point::new(960.0 + 2.0 * f64::from(i), y));
        assert!(near.det() > 0.3 * 0.2, "{near:?}");
    }
    // A side too short for that is blended between both its mitres.
    let short = build(&[("along", "0,0 50,0 50,50"), ("align", "start")]).unwrap().map;
    assert!(short.point(Point::new(25.0, 0.0)).distance(Point::new(50.0, -50.0)) < 1e-9);
}

/// Artwork that fits gives no warning; a single one states by how much longer artwork exceeds the path.
#[test]
fn artwork_longer_than_the_path_is_named() {
    let said = |along: &str| build(&[("along", along)]).unwrap().explanation.warnings;
    assert_eq!(said("0,50 100,50"), [""; 0]);
    assert_eq!(said("0,50 99.95,50"), [""; 0]);
    assert_eq!(said("0,0 100,0 100,200"), [""; 0]);
    let [warning] = &said("0,50 80,50")[..] else { panic!() };
    assert!(warning.contains("longer than the path by 20.000 (25 % of the path)"), "{warning}");
}

/// Returns the value of a B-spline's basis function over uniform knots: clamped with `cells` cells, or else on all whole numbers.
fn basis(cells: Option<usize>, i: isize, d: usize, degree: usize, x: f64) -> f64 {
    let knot = |k: isize| cells.map_or(k as f64, |c| (k - degree as isize).clamp(0, c as isize) as f64);
    let (t, n) = (knot(i), knot(i + d as isize + 1));
    if d == 0 {
        return f64::from(u8::from(t <= x && x < n));
    }
    let part = |num: f64, den: f64, b: f64| if den > 0.0 { num / den * b } else { 0.0 };
    part(x - t, knot(i + d as isize) - t, basis(cells, i, d - 1, degree, x))
        + part(n - x, n - knot(i + 1), basis(cells, i + 1, d - 1, degree, x))
}

/// Points and handles of a spline of any degree are blended by the same B-splines (by an independent recursion of Cox and de Boor), and
/// lines along the skeleton are as smooth at the joints as the formula.
#[test]
fn handles_at_the_points_of_a_spline_are_control_points_too() {
    let points =
        [(0., 50.), (20., 10.), (60., 20.), (80., 90.), (130., 70.), (150., 20.), (170., 60.), (190., 50.), (230., 0.)];
    let sides = [
        (0., -60.),
        (20., -50.),
        (-9., -70.),
        (5., -40.),
        (0., -55.),
        (-20., -60.),
        (8., -45.),
        (10., -50.),
        (0., -66.),
    ];
    let text = |v: &[(f64, f64)], by: &str| v.iter().map(|(x, y)| format!("{x},{y}")).collect::<Vec<_>>().join(by);
    let json = format!(r#"{{"points":[[{}]]}}"#, text(&sides, "],["));
    let along = text(&points, " ");
    for degree in 1..=8 {
        let cells = points.len() - degree;
        let number = degree.to_string();
        let args = [("along", &*along), ("spline", &*number), ("by", "parameter"), ("stretch", "fit")];
        let m = with_handles(&args, &json).unwrap().map;
        for k in 0..97 {
            let (u, y) = ((f64::from(k) + 0.5) / 97.0, 3.0 * f64::from(k % 30));
            let sum = (0..points.len()).fold(Vec2::ZERO, |sum, i| {
                let b = basis(Some(cells), i as isize, degree, degree, u * cells as f64);
                sum + (Vec2::from(points[i]) + Vec2::from(sides[i]) * ((50.0 - y) / 100.0)) * b
            });
            let got = m.point(Point::new(100.0 * u, y));
            assert!(got.distance(sum.to_point()) < 1e-10, "{degree} {u}: {got:?} {sum:?}");
        }
        for k in 1..cells {
            let at = |e: f64| m.jet(Point::new(100.0 * k as f64 / cells as f64 + e, 12.0));
            let (a, b) = (at(-1e-11), at(1e-11));
            assert!(degree == 1 || (a.dx - b.dx).hypot() < 1e-9 * a.dx.hypot().max(1.0), "{degree}: {a:?} {b:?}");
        }
    }
}

/// Splines of high degree by arc length are true to size, with the right derivatives.
#[test]
fn splines_of_high_degree_are_measured() {
    let points = "0,50 20,10 60,20 80,90 130,70 150,20 170,60 190,50 230,0 250,40";
    for how in [("spline", "4"), ("spline", "9"), ("interpolate", "true")] {
        let m = build(&[("along", points), how, ("align", "start"), ("width", "0.1")]).unwrap().map;
        for k in 1..40 {
            for y in [50.0, 10.0] {
                let (p, h) = (Point::new(2.5 * f64::from(k) + 0.01, y), 1e-5);
                let dx = (m.point(p + Vec2::new(h, 0.0)) - m.point(p - Vec2::new(h, 0.0))) / (2.0 * h);
                assert!((dx - m.jet(p).dx).hypot() < 1e-5, "{how:?} {p:?}");
                assert!(y < 50.0 || (m.jet(p).dx.hypot() - 1.0).abs() < 1e-9, "{how:?} {p:?}");
            }
        }
    }
}

/// A curve runs through its points with a continuous second derivative, and its default handles stand square on it.
#[test]
fn skeletons_run_through_points() {
    let points = [(0., 50.), (20., 10.), (60., 20.), (80., 90.), (130., 70.), (150., 20.)];
    let text: Vec<String> = points.iter().map(|(x, y)| format!("{x},{y}")).collect();
    let args = [("along", &*text.join(" ")), ("interpolate", "true"), ("by", "parameter"), ("stretch", "fit")];
    let widths: Vec<f64> = points.windows(2).map(|p| Point::from(p[0]).distance(p[1].into()).sqrt()).collect();
    let knots: Vec<f64> =
        (0..6).map(|i| 100.0 * widths[..i].iter().sum::<f64>() / widths.iter().sum::<f64>()).collect();
    let m = build(&args).unwrap().map;
    let at = |x: f64| m.jet(Point::new(x, 50.0));
    for (x, p) in knots.iter().zip(points) {
        let j = at(*x);
        assert!(j.p.distance(p.into()) < 1e-10 && j.dx.dot(j.dy).abs() < 1e-9 * j.dx.hypot(), "{j:?}");
        assert!((j.dy.hypot() - 1.0).abs() < 1e-12 && j.dx.cross(j.dy) > 0.0, "{j:?}");
    }
    let second = |x: f64, h: f64| (at(x + h).dx - at(x).dx) / h;
    for x in &knots[1..5] {
        let (before, after) = (second(x - 1e-9, -1e-4), second(*x + 1e-9, 1e-4));
        assert!((before - after).hypot() < 1e-2 * (1.0 + before.hypot()), "{before:?} {after:?}");
    }
    assert!(second(1e-9, 1e-4).hypot() < 1e-3, "no curvature at the ends");
}

/// Stretch, swell and taper agree with their definitions.
#[test]
fn presets_are_polynomial_profiles() {
    let m = |pairs: &[(&str, &str)]| build(pairs).unwrap().map;
    let (stretch, taper) = (m(&[("preset", "stretch"), ("factor", "3")]), m(&[("preset", "taper")]));
    let swell = m(&[("preset", "swell"), ("factor", "0.2")]);
    for i in 0..50 {
        let (x, y) = (2.0 * f64::from(i) + 1.0, 97.0 - 1.7 * f64::from(i));
        let (u, d) = (x / 100.0, y - 50.0);
        let near = |m: &Arc<dyn crate::map::Map>, x: f64, y: f64| {
            m.point(Point::new(100.0 * u, 50.0 + d)).distance(Point::new(x, y)) < 1e-11
        };
        assert!(near(&stretch, 3.0 * x, y) && near(&taper, x, 50.0 + d * (1.0 - 0.5 * u)), "{x} {y}");
        // A parabola through 1, 0.2 and 1.
        assert!(near(&swell, x, 50.0 + d * (1.0 - 3.2 * u * (1.0 - u))), "{x} {y}");
    }
}

#[test]
fn bad_skeletons_and_handles_are_named() {
    let spline = [("along", "0,0 50,20 100,0"), ("spline", "2")];
    let none = r#"{"points":[null,null,null]}"#;
    for (args, json, problem) in [
        (&spline[..], r#"{"points":[[0,-9],[0,0],null]}"#, "without length at point 2"),
        (&spline, r#"{"points":[null]}"#, "for 1 points"),
        (&spline, r#"{"points":[null,null,null],"pieces":[]}"#, "either `pieces` or"),
        (&spline[..1], none, "needs `spline` or `interpolate`"),
        (&[spline[0], spline[1], ("reverse", "true")], none, "the other way"),
        (&[("along", "M0,0 Q50,20 100,0")], r#"{"pieces":[{"levels":[[[0,0],[1,1]]]}]}"#, "without length at piece 1"),
    ] {
        let e = with_handles(args, json).err().unwrap().to_string();
        assert!(e.contains(problem), "{e}");
    }
    for (args, problem) in [
        (&[("along", "0,0 50,20 50,20 100,0"), ("interpolate", "true")][..], "two equal points in a row at 50,20"),
        (&[("along", "0,0 50,20"), ("spline", "11")], "10"),
        (&[("along", "0,0 50,20"), ("spline", "0")], "10"),
        (&[("along", "0,0 50,20"), ("spline", "1"), ("interpolate", "true")], "cannot go with `interpolate`"),
        (&[("along", "0,0 50,20"), ("preset", "taper")], "has its own skeleton"),
        (&[("along", "0,0 50,20"), ("factor", "2")], "is for a `preset`"),
        (&[("preset", "twist")], "stretch, swell"),
    ] {
        let e = build(args).err().unwrap().to_string();
        assert!(e.contains(problem), "{e}");
    }
}

/// At every joint, both sides of every parallel have the same derivative if the skeleton is a spline, and the same direction if it is
/// drawn. Lines once turned by 100° here.
#[test]
fn default_handles_leave_no_kinks() {
    let zigzag = "0,100 30,40 60,120 90,50 120,130 150,60 180,100";
    let ring = "M0,0 L60,-10 100,30 70,90 10,70 Z";
    let drawn = "M0,100 C20,40 60,40 80,100 S120,160 150,100 Q170,60 210,70 L250,80 Q290,90 250,150 T170,160";
    let loops = "M0,0 C80,0 60,60 0,60 C-30,60 -40,0 0,0 Z";
    let scattered: Vec<String> = (1..13).map(|i| format!("{},{}", i * 7919 % 307, i * i * 104_729 % 311)).collect();
    for along in [zigzag, ring, drawn, loops, &scattered.join(" ")] {
        for how in [("spline", "2"), ("spline", "3"), ("spline", "4"), ("interpolate", "true"), ("reverse", "true")] {
            if (how.0 == "reverse") != (along == drawn || along == loops) {
                continue;
            }
            let args = [("along", along), how, ("by", "parameter"), ("stretch", "fit"), ("width", "0.05")];
            let built = build(&args).unwrap();
            let warnings = &built.explanation.warnings;
            assert!(warnings.iter().all(|w| !w.contains("kink")), "{along} {how:?} {warnings:?}");
            let mut creases = Creases::default();
            built.map.creases(&mut creases);
            let mut joints = 0;
            for c in creases.items() {
                let Level::Line { a, c, .. } = c.level else { panic!("joints are vertical lines") };
                if !(1e-6..100.0 - 1e-6).contains(&(-c / a)) {
                    continue;
                }
                joints += 1;
                for y in [0.0, 20.0, 50.0, 90.0, 100.0] {
                    let at = |e: f64| built.map.jet(Point::new(-c / a + e, y)).dx;
                    let (p, q) = (at(-1e-12), at(1e-12));
                    let off = if how.0 == "reverse" {
                        p.cross(q).atan2(p.dot(q)).abs() * 1e-3
                    } else {
                        (p - q).hypot() / p.hypot().max(1.0)
                    };
                    assert!(off < 1e-9, "{along} {how:?} {y}: {p:?} {q:?}");
                }
            }
            assert!(joints > 0);
        }
    }
}
