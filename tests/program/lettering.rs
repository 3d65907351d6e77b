//! Lettering under deformations, through the program: baselines on curves, letters that keep their shape, stems that stay vertical.

use crate::support::expect_code;
use pathwarp::kurbo::{Point, Rect, Vec2};
use pathwarp::{Outline, Seg};
use pathwarp_oracle::flat;
use pathwarp_svg::{Document, ReadOptions};
use std::fs;
use std::path::Path;

/// A word whose letters have straight feet and vertical stems, in the bundled font.
const WORD: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 400 200'>\
<text id='word' x='20' y='120' font-size='90' font-family='Noto Sans'>HILTEN</text></svg>";
const BASELINE: f64 = 120.0;

fn document(file: &Path) -> Document {
    Document::read(&fs::read(file).unwrap(), "out", &ReadOptions::default()).unwrap()
}

/// The outlines of all shapes as one.
fn drawn(doc: &Document) -> Outline {
    Outline { subpaths: doc.shapes().iter().flat_map(|s| s.outline.subpaths.clone()).collect() }
}

/// Runs `pathwarp` on the word. Returns the drawing before and after, and the messages.
fn run(svg: &str, args: &[&str]) -> (Outline, Outline, String) {
    let dir = tempfile::tempdir().unwrap();
    let (file, out) = (dir.path().join("in.svg"), dir.path().join("out.svg"));
    fs::write(&file, svg).unwrap();
    let (input, output) = (file.display().to_string(), out.display().to_string());
    let mut all = vec![args[0], &input, "-o", &output, "--explain"];
    all.extend(&args[1..]);
    let (_, said) = expect_code(0, &all);
    (drawn(&document(&file)), drawn(&document(&out)), said)
}

/// The distance of `p` from an outline.
fn away(outline: &Outline, p: Point) -> f64 {
    flat(outline, 1e-6).distance(p)
}

/// The x ranges of the feet: lines that lie on the baseline.
fn feet(source: &Outline) -> Vec<(f64, f64)> {
    let on = |p: Point| (p.y - BASELINE).abs() < 1e-4;
    let lines = source.segs().filter(|s| on(s.start()) && on(s.end()) && s.start().x != s.end().x);
    lines.map(|s| (s.start().x, s.end().x)).collect()
}

/// The baseline lands on the curve within the tolerance. On a circle of radius 300 about 200,350 the point at distance s from the top is
/// 300·(sin(s/300), −cos(s/300)) from the centre, computed here independently of the program.
#[test]
fn the_baseline_lands_on_the_curve() {
    const TOLERANCE: f64 = 0.01;
    let arc = "M-100,350 A300,300 0 0 1 500,350";
    for frame in [None, Some("baseline-ascent"), Some("baseline-capheight"), Some("ink")] {
        let mut args = vec!["bend", "--along", arc, "--tolerance", "0.01", "--align", "start", "--offset", "200"];
        if let Some(f) = frame {
            args.extend(["--frame", f]);
        }
        let (before, after, _) = run(WORD, &args);
        let feet = feet(&before);
        assert!(feet.len() >= 8, "{feet:?}");
        let left = if frame == Some("ink") { before.bounding_box().unwrap().x0 } else { 20.0 };
        for (a, b) in feet {
            for i in 0..=10 {
                let x = a + (b - a) * f64::from(i) / 10.0;
                let angle = (x - left + 200.0) / 300.0 - std::f64::consts::FRAC_PI_2;
                let on = Point::new(200.0 + 300.0 * angle.sin(), 350.0 - 300.0 * angle.cos());
                let off = away(&after, on);
                // Single precision puts the feet of the text within 1e-5 of its baseline.
                assert!(off < TOLERANCE + 1e-4, "{frame:?}: {x} should be at {on:?}, is {off} away");
            }
        }
    }
    // On request, the middle of the box lands on the curve instead.
    let (before, after, _) = run(WORD, &["bend", "--along", "0,50 400,50", "--frame", "artwork"]);
    let (a, b) = (before.bounding_box().unwrap(), after.bounding_box().unwrap());
    assert!((b.center().y - 50.0).abs() < 1e-3 && (a.height() - b.height()).abs() < 1e-3);
}

/// In an envelope the baseline becomes the bottom curve; descenders extend below it.
#[test]
fn in_an_envelope_the_baseline_is_the_bottom() {
    let word = WORD.replace("HILTEN", "Hilpen");
    let args = [
        "envelope",
        "--bottom",
        "M20,150 L380,150",
        "--height",
        "100",
        "--frame",
        "baseline-capheight",
        "--tolerance",
        "0.01",
    ];
    let (before, after, _) = run(&word, &args);
    assert!(after.bounding_box().unwrap().y1 > 160.0, "the p hangs below");
    let right = 20.0 + 90.0 * (0.741 + 0.258 + 0.258 + 0.615 + 0.564 + 0.618);
    let feet = feet(&before);
    assert!(feet.len() >= 5);
    for (a, b) in feet {
        for x in [a, b] {
            let on = Point::new(20.0 + 360.0 * (x - 20.0) / (right - 20.0), 150.0);
            assert!(away(&after, on) < 0.011, "{x}: {on:?} {}", away(&after, on));
        }
    }
}

/// Under an arch with `--keep verticals`, stems stay vertical within 0.1°.
#[test]
fn stems_stay_upright_under_an_arch() {
    let args = [
        "envelope",
        "--bottom",
        "M20,170 Q200,60 380,170",
        "--top",
        "M20,90 Q200,-60 380,90",
        "--keep",
        "verticals",
        "--frame",
        "baseline-capheight",
    ];
    let (_, after, _) = run(WORD, &args);
    let mut stems = 0;
    let mut worst: f64 = 0.0;
    for s in after.segs() {
        let v = s.end() - s.start();
        // The diagonals of the N lean by much more than this; a stem that is bent is no line, and would be missing from the count below.
        if !matches!(s, Seg::Line(_)) || v.y.abs() < 20.0 || v.x.abs() > 0.1 * v.y.abs() {
            continue;
        }
        stems += 1;
        for i in 0..=50 {
            let d = s.deriv(f64::from(i) / 50.0);
            worst = worst.max(d.x.abs().atan2(d.y.abs()).to_degrees());
        }
    }
    assert!(stems >= 12, "{stems} stems");
    assert!(worst < 0.1, "a stem leans by {worst}°");
}

/// Returns the letters of a drawing: its subpaths, which in this word are one per letter, from left to right.
fn nodes(outline: &Outline) -> Vec<Vec<Point>> {
    outline.subpaths.iter().map(pathwarp::Subpath::anchors).collect()
}

/// `--glyphs rotate` keeps every letter congruent: distances between its nodes agree within 1e-9.
#[test]
fn turned_letters_keep_their_shape() {
    let curves = ["M0,180 C100,20 300,20 400,180", "M100,150 A100,80 0 1 1 300,150 A100,80 0 1 1 100,150 Z"];
    for along in curves {
        let args = ["bend", "--along", along, "--glyphs", "rotate", "--precision", "13"];
        let (before, after, said) = run(WORD, &args);
        let (a, b) = (nodes(&before), nodes(&after));
        assert_eq!(a.len(), b.len());
        assert!(said.contains("baseline"), "{said}");
        let mut turned = 0;
        for (p, q) in a.iter().zip(&b) {
            assert_eq!(p.len(), q.len());
            for i in 0..p.len() {
                for j in 0..i {
                    let (d, e) = (p[i].distance(p[j]), q[i].distance(q[j]));
                    assert!((d - e).abs() < 1e-9, "{d} {e}");
                }
            }
            let (v, w) = (p[1] - p[0], q[1] - q[0]);
            turned += usize::from((v.cross(w) / (v.hypot() * w.hypot())).abs() > 0.1);
        }
        assert!(turned >= 3, "{turned} letters turned");
    }
}

/// Each way of placing letters keeps stems vertical, bars horizontal, or both.
#[test]
fn skewed_stems_stay_upright_and_ribbons_level() {
    let chords = |o: &Outline| -> Vec<Vec2> { o.segs().map(|s| s.end() - s.start()).collect() };
    let along = "M0,180 C120,60 280,60 400,180";
    for (args, stems, bars) in [
        (&["--skew"][..], true, false),
        (&["--glyphs", "skew"], true, false),
        (&["--ribbon"], false, true),
        (&["--glyphs", "stair"], true, true),
        (&["--glyphs", "rotate"], false, false),
    ] {
        let mut all = vec!["bend", "--along", along, "--precision", "9"];
        all.extend(args);
        let (before, after, _) = run(WORD, &all);
        let pairs: Vec<(Vec2, Vec2)> = chords(&before).into_iter().zip(chords(&after)).collect();
        let long = |v: &Vec2| v.hypot() > 8.0;
        assert!(before.segs().count() == after.segs().count() && pairs.iter().filter(|(b, _)| long(b)).count() > 30);
        let kept = |axis: fn(Vec2) -> f64| {
            let own = pairs.iter().filter(|(b, _)| long(b) && axis(*b) == 0.0);
            own.map(|(_, a)| axis(*a / a.hypot()).abs()).fold(0.0, f64::max) < 1e-9
        };
        assert_eq!((kept(|v| v.x), kept(|v| v.y)), (stems, bars), "{args:?}");
    }
}

#[test]
fn letters_that_cannot_be_placed_cause_messages() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("in.svg");
    fs::write(&file, WORD).unwrap();
    let input = file.display().to_string();
    let fault = |input: &str, args: &[&str]| {
        let mut all = vec!["bend", input, "-o", "-"];
        all.extend(args);
        let out = crate::support::pathwarp(&all);
        (out.status.code().unwrap(), String::from_utf8_lossy(&out.stderr).into_owned())
    };
    let grid = crate::support::sample("grid.svg").display().to_string();
    let (code, said) = fault(&grid, &["--along", "0,0 50,9", "--frame", "baseline-ascent"]);
    assert!(code == 3 && said.contains("no lettering"), "{code} {said}");
    let (code, said) = fault(&input, &["--along", "0,0 50,9", "--skew", "--ribbon"]);
    assert!(code == 2 && said.contains("one way only"), "{code} {said}");
    let (code, said) = fault(&input, &["--along", "0,0 50,9", "--skew", "--inverse"]);
    assert!(code != 0 && said.contains("no inverse"), "{code} {said}");
    let (code, said) = fault(&input, &["--along", "0,0 50,9", "--frame", "baseline"]);
    assert!(code == 2 && said.contains("baseline-capheight"), "{code} {said}");
}

/// `--spacing even` on a circle of radius 120 about 200,220: lengths are true at half the frame's height h, so that a point whose x is s
/// right of the middle lies at the angle s / (120 + h), computed here independently of the program. At that height every letter keeps
/// its width.
#[test]
fn even_spacing_keeps_letter_widths_at_half_their_height() {
    const RADIUS: f64 = 120.0;
    let arc = "M80,220 A120,120 0 0 1 320,220";
    // Noto Sans: advances, ascent and the height of capitals in thousandths of the font size.
    let middle = 20.0 + 0.5 * 90.0 * (0.741 + 0.339 + 0.76 + 0.556 + 0.741);
    for (frame, height) in [("baseline-capheight", 0.714 * 90.0), ("baseline-ascent", 1.069 * 90.0)] {
        let args = ["bend", "--along", arc, "--spacing", "even", "--frame", frame, "--tolerance", "0.005"];
        let (before, after, _) = run(&WORD.replace("HILTEN", "HINEH"), &args);
        let to = |p: Point| {
            let (sin, cos) = ((p.x - middle) / (RADIUS + 0.5 * height)).sin_cos();
            Point::new(200.0, 220.0) + Vec2::new(sin, -cos) * (RADIUS + BASELINE - p.y)
        };
        for s in before.segs() {
            for p in [s.start(), s.eval(0.5)] {
                let off = away(&after, to(p));
                assert!(off < 0.006, "{frame}: {p:?} should be at {:?}, is {off} away", to(p));
            }
        }
    }
}

/// Warnings name the letter that is bent too tightly or placed too steeply for a skew.
#[test]
fn warnings_name_the_letters() {
    let tight = "M0,20 L180,20 A25,25 0 0 0 205,-5 L205,-200";
    let (_, _, said) = run(WORD, &["bend", "--along", tight, "--align", "start"]);
    // The bend runs from 180 to 219.3 along the skeleton; the T begins at 144.4 less kerning, the E at 194.4 and ends at 244.4.
    assert!(said.contains("the letters `T`, `E` fold over themselves"), "{said}");
    let (_, _, said) = run(WORD, &["bend", "--along", tight, "--align", "start", "--glyphs", "rotate"]);
    assert!(said.contains("collide"), "{said}");
    let (_, _, said) = run(WORD, &["bend", "--along", tight, "--align", "start", "--skew"]);
    assert!(said.contains("too steep") && said.contains("`N`"), "{said}");
}

/// `--stretch fit` spreads the letters over the skeleton, `repeat` repeats the word; the letters keep their shape.
#[test]
fn letters_are_spread_and_repeated() {
    let boxes = |o: &Outline| -> Vec<Rect> {
        o.subpaths.iter().map(|s| Outline { subpaths: vec![s.clone()] }.bounding_box().unwrap()).collect()
    };
    let (before, after, _) =
        run(WORD, &["bend", "--along", "0,80 800,80", "--glyphs", "rotate", "--stretch", "fit", "--precision", "9"]);
    let (a, b) = (boxes(&before), boxes(&after));
    for (a, b) in a.iter().zip(&b) {
        assert!((a.width() - b.width()).abs() < 1e-6 && (a.height() - b.height()).abs() < 1e-6);
    }
    // All gaps grow equally, and the first and last advances end at the ends of the skeleton: H and N have bearings of 0.097.
    let gaps = |o: &[Rect]| -> Vec<f64> { o.windows(2).map(|p| p[1].x0 - p[0].x1).collect() };
    let grown: Vec<f64> = gaps(&a).iter().zip(gaps(&b)).map(|(a, b)| b - a).collect();
    assert!(grown.len() == 5 && grown.iter().all(|g| *g > 70.0 && (g - grown[0]).abs() < 1e-4), "{grown:?}");
    assert!((b[0].x0 - 0.097 * 90.0).abs() < 1e-4 && (800.0 - b[5].x1 - 0.097 * 90.0).abs() < 1e-4, "{b:?}");
    let (_, after, said) =
        run(WORD, &["bend", "--along", "0,80 1200,80", "--glyphs", "rotate", "--stretch", "repeat", "--gap", "20"]);
    assert_eq!(after.subpaths.len(), 3 * before.subpaths.len(), "{said}");
    let right = after.bounding_box().unwrap().x1;
    assert!((1180.0..1200.0).contains(&right), "{right}");
}

/// Warnings concern the ink, not the boxes around it: the p reaches below the centre of a tight hill and the H does not; the
/// empty corners of L and T may overlap.
#[test]
fn warnings_are_of_ink() {
    let hill = ["bend", "--along", "M100,150 A18,18 0 0 1 136,150"];
    let (_, _, said) = run(&WORD.replace("HILTEN", "HpH"), &hill);
    assert!(said.contains("the letter `p` folds"), "{said}");
    let (_, _, said) = run(WORD, &hill);
    assert!(!said.contains("folds"), "{said}");
    let valley = ["bend", "--along", "M100,50 A100,100 0 0 0 300,50", "--glyphs", "rotate"];
    let (_, _, said) = run(&WORD.replace("HILTEN", "HH"), &valley);
    assert!(said.contains("`HH` collide"), "{said}");
    let (_, _, said) = run(&WORD.replace("HILTEN", "LT"), &valley);
    assert!(!said.contains("collide"), "{said}");
    // On a closed path the last letter meets the first.
    let ring = "M173,100 A27,27 0 1 1 227,100 A27,27 0 1 1 173,100 Z";
    let (_, _, said) = run(&WORD.replace("HILTEN", "HIHI"), &["bend", "--along", ring, "--glyphs", "rotate"]);
    assert!(said.contains("`IH` collide"), "{said}");
}

/// `pathwarp bend` and `pathwarp envelope` treat the output of `pathwarp text` like text, with equal frames and placement of letters. Text
/// is laid out in single precision, hence the 1e-3. No pair of the word is kerned: in text, kerning moves letters and leaves their
/// advances; here it is part of the advances, so the middles of kerned letters would differ by half of it.
#[test]
fn lettering_made_here_is_bent_like_text() {
    let here = crate::support::root();
    let set = crate::support::pathwarp_in(&here, &["text", "HINEH", "--size", "90"], b"");
    assert!(set.status.success(), "{}", String::from_utf8_lossy(&set.stderr));
    let made = String::from_utf8(set.stdout).unwrap();
    let baseline = made.split("data-baseline=\"").nth(1).and_then(|t| t.split('"').next()).unwrap();
    let numbers: Vec<f64> = baseline.split(' ').map(|w| w.parse().unwrap()).collect();
    let [x0, y0, x1, y1] = numbers[..] else { panic!("{baseline}") };
    assert!(y0 == y1 && x0 < x1, "{baseline}");
    let text = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 400 200'>\
<text x='{x0}' y='{y0}' font-size='90' font-family='Noto Sans'>HINEH</text></svg>"
    );
    let arc = "M-100,350 A300,300 0 0 1 500,350";
    let (bottom, top) = ("M20,170 Q200,60 380,170", "M20,90 Q200,-60 380,90");
    for args in [
        &["bend", "--along", arc][..],
        &["bend", "--along", arc, "--glyphs", "rotate"],
        &["bend", "--along", arc, "--skew", "--stretch", "fit"],
        &["bend", "--along", arc, "--ribbon", "--spacing", "even", "--frame", "baseline-xheight"],
        &["bend", "--along", arc, "--glyphs", "stair", "--stretch", "repeat", "--gap", "9"],
        &["envelope", "--bottom", bottom, "--top", top, "--frame", "baseline-capheight"],
        &["envelope", "--bottom", bottom, "--top", top, "--frame", "ascent-descent", "--keep", "verticals"],
    ] {
        let mut all = args.to_vec();
        all.extend(["--tolerance", "1e-4", "--precision", "9", "--merge", "off"]);
        let (_, wanted, _) = run(&text, &all);
        all.insert(1, "-");
        let bent = crate::support::pathwarp_in(&here, &all, made.as_bytes());
        assert!(bent.status.success(), "{args:?}: {}", String::from_utf8_lossy(&bent.stderr));
        let bent = drawn(&Document::read(&bent.stdout, "bent", &ReadOptions::default()).unwrap());
        assert!(bent.bounding_box().unwrap().width() > 250.0, "{args:?}");
        for (a, b) in [(&bent, &wanted), (&wanted, &bent)] {
            let corners: Vec<Point> = a.segs().map(pathwarp::Seg::start).collect();
            assert!(corners.len() > 50, "{args:?}");
            for p in corners {
                assert!(away(b, p) < 1e-3, "{args:?}: {p:?} is {} away", away(b, p));
            }
        }
    }
}
