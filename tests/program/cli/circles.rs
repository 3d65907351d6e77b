//! Circles, arcs and spirals as path references, and text set on them.

use super::common::text;
use crate::support::{expect_code, pathwarp_in};
use pathwarp::Outline;
use pathwarp::kurbo::Point;
use std::f64::consts::TAU;

#[track_caller]
fn mapped(along: &str, points: &str) -> Vec<[f64; 2]> {
    let dir = tempfile::tempdir().unwrap();
    let args = ["map", "bend", "--along", along, "--baseline", "0", "--frame", "0,0,100,50"];
    let out = pathwarp_in(dir.path(), &args, points.as_bytes());
    assert!(out.status.success(), "{}", text(&out.stderr));
    let point = |line: &str| {
        let (x, y) = line.split_once(' ').unwrap();
        [x.parse().unwrap(), y.parse().unwrap()]
    };
    text(&out.stdout).lines().map(point).collect()
}

/// The baseline runs along the true circle: the middle on its top, a quarter of the circumference further on its right.
#[test]
fn artwork_bends_along_circles_and_arcs() {
    const QUARTER: f64 = 10.0 * std::f64::consts::FRAC_PI_2;
    let points = format!("50 50\n{} 50\n50 45\n{} 50", 50.0 + QUARTER, 50.0 + 0.5 * QUARTER);
    let r2 = std::f64::consts::FRAC_1_SQRT_2;
    let upper = [[50.0, 15.0], [60.0, 25.0], [50.0, 10.0], [50.0 + 10.0 * r2, 25.0 - 10.0 * r2]];
    let near = |got: &[[f64; 2]], expected: &[[f64; 2]], what: &str| {
        for (a, b) in got.iter().zip(expected) {
            assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-9, "{what}: {a:?} {b:?}");
        }
    };
    for along in [
        "circle:r=10",
        "circle:r=10%",
        "circle:r=10,cx=50%,cy=25",
        "arc:r=10,from=180,to=360",
        "arc:r=10,from=0.5turn,to=0",
    ] {
        // The last one is the lower half.
        let got = mapped(along, &points);
        if along.ends_with("to=0") {
            near(&got, &[[50.0, 35.0], [60.0, 25.0], [50.0, 30.0], [50.0 + 10.0 * r2, 25.0 + 10.0 * r2]], along);
        } else {
            near(&got, &upper, along);
        }
    }
    near(&mapped("circle:r=1in,cx=0,cy=0", "50 50"), &[[0.0, -96.0]], "an inch");
}

/// Millimetres refer to the page, also in an option of another deformation.
#[test]
fn a_circle_in_a_drawing_has_its_size_on_the_page() {
    let dir = tempfile::tempdir().unwrap();
    let drawing =
        "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' viewBox='0 0 100 50'><path id='p' d='M30,25H70'/></svg>";
    let args = ["bend", "-", "--along", "circle:r=20mm,cx=50mm,cy=60mm", "-q", "--frame", "0,0,100,50"];
    let out = pathwarp_in(dir.path(), &args, drawing.as_bytes());
    let list = pathwarp_in(dir.path(), &["paths", "-", "--json"], &out.stdout);
    let list: serde_json::Value = serde_json::from_slice(&list.stdout).unwrap();
    let points = list["paths"][0]["strokes"][0]["points"].as_array().unwrap();
    // Incoming handle, anchor, outgoing handle.
    for anchor in points.chunks(3).map(|c| &c[1]) {
        let (x, y) = (anchor[0].as_f64().unwrap() - 50.0, anchor[1].as_f64().unwrap() - 60.0);
        assert!((x.hypot(y) - 20.0).abs() < 0.01, "{anchor}");
    }
    let args = ["envelope", "-", "--envelope", "circle:r=20mm", "-q"];
    let out = pathwarp_in(dir.path(), &args, drawing.replace("M30,25H70", "M30,20H70V40H30Z").as_bytes());
    assert!(out.status.success(), "{}", text(&out.stderr));
}

#[test]
fn errors_name_the_wrong_value() {
    let dir = tempfile::tempdir().unwrap();
    for (along, part) in [
        ("circle:", "has no r: write circle:r=60mm"),
        ("circle:r=-2mm", "must be larger than 0"),
        ("circle:r=2,x=5", "`x`; circle takes r, cx, cy"),
        ("arc:r=2,from=0", "has no to"),
        ("arc:r=2,from=0,to=500", "at most 360°"),
        ("arc:r=2,from=here,to=5", "wrong from: `here`"),
        ("spiral:turns=2,inner=3", "has no outer: write spiral:turns=3"),
        ("spiral:turns=2,inner=3,outer=2", "inner must be at least 0, and outer larger"),
        ("spiral:turns=2000,inner=3,outer=9", "at most 100"),
        ("spiral:turns=2,inner=3,outer=9,inwards", "which is not NAME=VALUE, cw or ccw"),
    ] {
        let out = pathwarp_in(dir.path(), &["bend", "-", "--along", along], super::common::SQUARE.as_bytes());
        let said = text(&out.stderr);
        assert!(out.status.code() == Some(2) && said.contains(part) && said.contains("--along"), "{along}: {said}");
    }
}

/// The baseline starts at the inner end of r = inner + growth·angle and stays on it, whatever the positions of the ends.
#[test]
fn artwork_bends_along_spirals_in_the_direction_they_name() {
    for (turns, from, ccw) in [(2.0, 180.0, false), (0.75, 0.0, false), (1.3, 200.0, true), (0.4, 90.0, false)] {
        let way = if ccw { -1.0 } else { 1.0 };
        let direction = if ccw { "ccw" } else { "cw" };
        let along = format!("spiral:turns={turns},inner=10,outer=30,from={from},{direction},cx=0,cy=0");
        let dir = tempfile::tempdir().unwrap();
        let args = ["map", "bend", "--along", &along, "--align", "start", "--baseline", "0", "--frame", "0,0,100,50"];
        let step = turns * TAU * 20.0 / 60.0;
        let points: String = (0..60).map(|i| format!("{} 50\n", f64::from(i) * step)).collect();
        let out = pathwarp_in(dir.path(), &args, points.as_bytes());
        let (mut last, mut angle) = (Point::ORIGIN, 0.0);
        for (i, line) in text(&out.stdout).lines().enumerate() {
            let (x, y) = line.split_once(' ').unwrap();
            let p = Point::new(x.parse().unwrap(), y.parse().unwrap());
            if i > 0 {
                let turn = last.to_vec2().cross(p.to_vec2()).atan2(last.to_vec2().dot(p.to_vec2()));
                assert!(turn * way > 0.0, "{along}: {p}");
                angle += turn.abs();
            }
            let expected = 10.0 + 20.0 * angle / (turns * TAU);
            assert!((p.to_vec2().hypot() - expected).abs() < 1e-5, "{along}: {p} {expected}");
            if i == 0 {
                let begin = f64::to_radians(from);
                assert!(p.distance(Point::new(10.0 * begin.cos(), 10.0 * begin.sin())) < 1e-6, "{along}: {p}");
            }
            last = p;
            // Beyond its end, the skeleton would continue straight.
            if angle > turns * TAU - 4.0 * step / 30.0 {
                break;
            }
        }
        assert!(angle > turns * TAU - 0.9, "{along}: {angle}");
    }
}

/// A closed path in reverse carries artwork upright on its lowest point, inside.
#[test]
fn artwork_stands_upright_in_a_circle_in_reverse() {
    let dir = tempfile::tempdir().unwrap();
    let args =
        ["map", "bend", "--along", "circle:r=10,cx=0,cy=0", "--reverse", "--baseline", "0", "--frame", "0,0,100,50"];
    let out = text(&pathwarp_in(dir.path(), &args, b"50 50\n50 45\n51 50").stdout);
    let points: Vec<Vec<f64>> = out.lines().map(|l| l.split(' ').map(|n| n.parse().unwrap()).collect()).collect();
    assert!(points[0][0].abs() < 1e-9 && (points[0][1] - 10.0).abs() < 1e-9, "{out}");
    assert!((points[1][1] - 5.0).abs() < 1e-9 && points[2][0] > 0.9, "{out}");
}

/// Returns the letters of every group of a drawing, as points of outlines about 0,0: radius, clockwise angle from the right (degrees).
fn letters(svg: &str) -> Vec<Vec<Vec<(f64, f64)>>> {
    let letter = |path: &str| {
        let outline = Outline::from_svg(path.split('"').next().unwrap()).unwrap();
        let points = outline.segs().flat_map(|s| (0..64).map(|i| s.eval(f64::from(i) / 64.0).to_vec2()));
        points.map(|v| (v.hypot(), v.atan2().to_degrees().rem_euclid(360.0))).collect()
    };
    svg.split("<g ").skip(1).map(|g| g.split(" d=\"").skip(1).map(letter).collect()).collect()
}

fn range(letters: &[Vec<(f64, f64)>], of: fn(&(f64, f64)) -> f64) -> (f64, f64) {
    let all = || letters.iter().flatten().map(of);
    (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max))
}

/// H has straight feet and reaches the height of capitals, 0.714 em in the bundled font, and is symmetric.
#[test]
fn two_lines_are_in_one_ring() {
    const CAP: f64 = 0.714 * 20.0;
    let near = |(a, b): (f64, f64), (c, d): (f64, f64), what: &str| {
        assert!((a - c).abs() < 0.02 && (b - d).abs() < 0.02, "{what}: {a} {b}, expected {c} {d}");
    };
    let set = |more: &[&str]| {
        let words = ["text", "HHH", "--below", "HHHH", "--on", "circle:r=60mm", "--size", "20mm", "-q"];
        let (svg, _) = expect_code(0, &[&words, more].concat());
        assert!(svg.contains("mm\" height=") && svg.contains("aria-label=\"HHHH\""), "{svg}");
        letters(&svg)
    };
    for (more, ring) in [(&[][..], (60.0, 60.0 + CAP)), (&["--inside"], (60.0 - CAP, 60.0))] {
        let both = set(more);
        assert_eq!(both.iter().map(Vec::len).collect::<Vec<_>>(), [3, 4]);
        for (letters, middle) in both.iter().zip([270.0, 90.0]) {
            near(range(letters, |p| p.0), ring, "the ring");
            let (from, to) = range(letters, |p| p.1);
            assert!((0.5 * (from + to) - middle).abs() < 0.01 && to - from > 30.0, "{from} {to}");
        }
        // From left to right: clockwise above, counter-clockwise below.
        let middle = |letter: &Vec<(f64, f64)>| letter.iter().map(|p| p.1).sum::<f64>() / letter.len() as f64;
        assert!(middle(&both[0][0]) < middle(&both[0][2]) && middle(&both[1][0]) > middle(&both[1][3]));
    }
    // The middles turn together, or each to a different angle.
    for (more, middles) in
        [(&["--at", "300"][..], [300.0, 120.0]), (&["--at", "250", "--at", "0.5turn"], [250.0, 180.0])]
    {
        for (letters, middle) in set(more).iter().zip(middles) {
            let (from, to) = range(letters, |p| p.1);
            assert!((0.5 * (from + to) - middle).abs() < 0.01, "{more:?}: {from} {to}");
        }
    }
    // The letters are upright: the foot of an L is below its stem.
    let (svg, _) = expect_code(0, &["text", "--below", "L", "--on", "circle:r=60mm", "--size", "20mm"]);
    let all = letters(&svg);
    let foot = all[0][0].iter().filter(|p| p.1 < 88.0).map(|p| p.0);
    assert!(foot.fold(f64::INFINITY, f64::min) > 60.0 + 0.5 * CAP, "{svg}");
}

#[test]
fn text_on_open_paths_takes_the_options_of_bend() {
    let upper = "arc:r=60mm,from=180,to=360";
    let on =
        |more: &[&str]| letters(&expect_code(0, &[&["text", "HHHH", "--size", "10mm", "-q", "--on"], more].concat()).0);
    // Turned letters keep their size; --at is the middle on an arc, in either direction of it.
    for (path, at) in [(upper, "240"), ("arc:r=60mm,from=360,to=180", "240"), ("arc:r=60mm,from=160,to=20", "100")] {
        let set = on(&[path, "--at", at, "--glyphs", "rotate"]);
        let (from, to) = range(&set[0], |p| p.1);
        assert!((0.5 * (from + to) - at.parse::<f64>().unwrap()).abs() < 0.01, "{path}: {from} {to}");
    }
    for (align, first) in [("start", 180.0..183.0), ("right", 331.0..334.0)] {
        let from = range(&on(&[upper, "--align", align])[0], |p| p.1).0;
        assert!(first.contains(&from), "{align}: {from}");
    }
    // Without sidebearings, the text covers the whole arc.
    let (from, to) = range(&on(&[upper, "--stretch", "scale"])[0], |p| p.1);
    assert!((180.0..190.0).contains(&from) && (350.0..360.0).contains(&to), "{from} {to}");
    let both = on(&["circle:r=60mm", "--below", "HH", "--stretch", "fit"]);
    let (above, below) = (range(&both[0], |p| p.1), range(&both[1], |p| p.1));
    assert!(above.0 > 180.0 && above.0 < 195.0 && below.0 > 0.0 && below.0 < 17.0, "{above:?} {below:?}");
    // Around a whole ring, letters keep their widths and stand on it.
    for letter in &on(&["circle:r=60mm", "--stretch", "fit"])[0] {
        let letter = std::slice::from_ref(letter);
        let (radii, (from, to)) = (range(letter, |p| p.0), range(letter, |p| p.1));
        assert!((radii.0 - 60.0).abs() < 0.02 && (radii.1 - 67.14).abs() < 0.02, "{radii:?}");
        assert!(to - from < 8.0, "{from} {to}");
    }
    let there = |offset: &str| range(&on(&["circle:r=60mm", "--offset", offset])[0], |p| p.1).0;
    assert!((there("10mm") - there("0") - (10.0_f64 / 60.0).to_degrees()).abs() < 0.01);
}

/// A path of a file has its size on paper in any units: a radius of an inch, in px and in units of 0.1 mm.
#[test]
fn a_path_of_a_file_has_its_size() {
    let dir = tempfile::tempdir().unwrap();
    for (page, radius) in [("width='300' height='300'", 96), ("width='80mm' height='80mm' viewBox='0 0 800 800'", 254)]
    {
        let file = dir.path().join("ring.svg");
        let ring = format!("<svg xmlns='http://www.w3.org/2000/svg' {page}><circle id='ring' r='{radius}'/></svg>");
        std::fs::write(&file, ring).unwrap();
        let on = format!("{}#ring", file.display());
        for more in [&[][..], &["--below", "HH", "--at", "0"]] {
            let (svg, _) = expect_code(0, &[&["text", "HH", "--size", "5mm", "--on", &on], more].concat());
            let radii = range(&letters(&svg)[0], |p| p.0);
            assert!((radii.0 - 25.4).abs() < 0.01, "{page}: {radii:?}");
        }
    }
}

#[test]
fn what_does_not_go_on_a_path_says_so() {
    for (args, part) in [
        (&["--below", "B"][..], "--on"),
        (&["--on", "spiral:turns=2,inner=20,outer=50", "--at", "5"], "--offset moves the line"),
        (&["--on", "M0,0 H100", "--below", "B", "--inside"], "closed paths"),
        (&["--on", "circle:r=60", "--at", "1", "--at", "2", "--at", "3"], "two angles"),
        (&["--on", "circle:r=sixty"], "--on"),
        (&["--on", "circle:r=60", "--at", "north"], "--at"),
        (&["--on", "circle:r=60", "--glyphs", "turn"], "rotate"),
        (&["--glyphs", "rotate"], "--on"),
    ] {
        let (_, said) = expect_code(2, &[&["text", "A"], args].concat());
        assert!(said.contains(part), "{args:?}: {said}");
    }
    let long = ["text", "A long line above", "--below", "and a long one below", "--on", "circle:r=60"];
    assert!(expect_code(0, &long).1.contains("run into each other"));
}

/// The map depends on the frame and the options alone: the image of a point does not depend on the other points.
#[test]
fn a_point_has_the_same_image_whatever_is_asked_for_beside_it() {
    let dir = tempfile::tempdir().unwrap();
    let heart = "M50,90C0,50 0,10 25,10C40,10 50,25 50,30C50,25 60,10 75,10C100,10 100,50 50,90Z";
    let round = "M50,0C80,0 100,20 100,50C100,80 80,100 50,100C20,100 0,80 0,50C0,20 20,0 50,0Z";
    for shape in [heart, round] {
        let image = |points: &str| {
            let args = ["map", "envelope", "--envelope", shape, "--frame", "0,0,100,50"];
            let out = pathwarp_in(dir.path(), &args, points.as_bytes());
            assert!(out.status.success(), "{}", text(&out.stderr));
            text(&out.stdout).lines().next().unwrap().to_owned()
        };
        let alone = image("30 20");
        for beside in ["31 20", "0 0\n100 50", "99 49\n98 1", "5 45"] {
            assert_eq!(image(&format!("30 20\n{beside}")), alone, "{beside}");
        }
    }
}

/// A bend folds below its sharp middle, where there is no artwork.
#[test]
fn folds_count_only_where_there_is_artwork() {
    let dir = tempfile::tempdir().unwrap();
    let warned = |shapes: &str| {
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 200 130'>{shapes}</svg>");
        let args =
            ["bend", "-", "--along", "M0,200 Q100,0 200,200", "--stretch", "fit", "--baseline", "100%", "-o", "-"];
        let out = pathwarp_in(dir.path(), &args, svg.as_bytes());
        (text(&out.stderr).contains("folds over itself"), text(&out.stderr))
    };
    const ENDS: &str = "<path d='M0,0H20V130H0Z'/><path d='M180,0H200V130H180Z'/>";
    let (folds, messages) = warned(ENDS);
    assert!(!folds, "{messages}");
    assert!(warned(&format!("{ENDS}<path d='M90,0H110V130H90Z'/>")).0);
}
