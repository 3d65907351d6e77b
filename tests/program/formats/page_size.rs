//! `--page-width` and `--page-height`: the size of the result, and lengths that refer to the result.

use super::dxf_reader::Dxf;
use crate::support::geometry::{drawing, gap, outlines};
use crate::support::pathwarp_in;
use pathwarp::kurbo::Point;
use std::path::Path;

const SAMPLING: f64 = 4e-4;

fn run(args: &[&str], svg: &str) -> Vec<u8> {
    let out = pathwarp_in(Path::new("."), args, svg.as_bytes());
    assert_eq!(out.status.code(), Some(0), "{args:?}: {}", String::from_utf8_lossy(&out.stderr));
    out.stdout
}

fn dxf(args: &[&str], svg: &str) -> Dxf {
    Dxf::read(std::str::from_utf8(&run(&[args, &["--format", "dxf"]].concat(), svg)).unwrap())
}

fn scaled(lines: &[Vec<Point>], k: f64) -> Vec<Vec<Point>> {
    lines.iter().map(|l| l.iter().map(|p| Point::new(k * p.x, k * p.y)).collect()).collect()
}

/// Returns the sides of a result's page, as given by its root.
fn sides(svg: &[u8]) -> [String; 2] {
    let text = std::str::from_utf8(svg).unwrap();
    let value = |name: &str| text.split(&format!(" {name}=")).nth(1).unwrap()[1..].split(['\'', '"']).next().unwrap();
    ["width", "height"].map(|name| value(name).to_owned())
}

#[test]
fn the_page_has_the_size_asked_for_and_the_other_side_in_proportion() {
    let svg = drawing("80mm", "60mm", 1.0);
    let stay = ["affine", "-", "--move-x", "0"];
    for (size, wanted) in [
        (&["--page-width", "40mm"][..], ["40mm", "30mm"]),
        (&["--page-height", "3cm"], ["4cm", "3cm"]),
        (&["--page-width", "2in", "--page-height", "30mm"], ["40mm", "30mm"]),
        (&["--page-width", "40mm", "--page-height", "90mm"], ["40mm", "30mm"]),
        (&["--page-width", "1m"], ["1000mm", "750mm"]),
        (&["--page-width", "400"], ["400", "300"]),
    ] {
        let args = [&stay[..], size].concat();
        assert_eq!(sides(&run(&args, &svg)), wanted, "{size:?}");
        let got = outlines(&run(&args, &svg));
        let number: f64 = wanted[0].trim_end_matches(char::is_alphabetic).parse().unwrap();
        let mm = number
            * if wanted[0].ends_with("cm") {
                10.0
            } else if wanted[0].ends_with("mm") {
                1.0
            } else {
                25.4 / 96.0
            };
        let exact = scaled(&outlines(svg.as_bytes()), mm / 80.0);
        assert!(gap(&got, &exact).max(gap(&exact, &got)) < SAMPLING * (mm / 80.0).max(1.0), "{size:?}");
    }
    // Pages without a viewBox get one.
    let plain = "<svg xmlns='http://www.w3.org/2000/svg' width='90' height='30'><path d='M9,9H60V20Z'/></svg>";
    let small = run(&[&stay[..], &["--page-width", "30mm"]].concat(), plain);
    assert!(std::str::from_utf8(&small).unwrap().contains("viewBox=\"0 0 90 30\""));
    for wrong in ["50%", "-3mm", "wide"] {
        let out = pathwarp_in(Path::new("."), &["affine", "-", "--page-width", wrong], svg.as_bytes());
        assert_eq!(out.status.code(), Some(2), "{wrong}");
    }
}

/// In a browser, a style overrides the attributes, so the style also gets the new size.
#[test]
fn a_size_in_a_style_gives_way() {
    let drawing = |root: &str, sheet: &str| {
        format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 50' {root}>{sheet}<rect x='10' y='10' width='60' height='30'/></svg>"
        )
    };
    let fixed = "width:200px;height:100px";
    for svg in
        [drawing(&format!("style='fill:red;{fixed}'"), ""), drawing("", &format!("<style>svg{{{fixed}}}</style>"))]
    {
        for (more, [width, height]) in [
            (&["--page-width", "80mm"][..], ["80mm", "40mm"]),
            (&["--page-height", "60"], ["120px", "60px"]),
            (&[], ["200px", "140px"]),
        ] {
            // Without a size, the page grows by ten units and the margin of ten.
            let down = if more.is_empty() { "20" } else { "0" };
            let out = run(&[&["affine", "-", "--move-y", down], more].concat(), &svg);
            let text = std::str::from_utf8(&out).unwrap();
            let root = text.split('>').next().unwrap();
            let style = root.split(" style=").nth(1).unwrap();
            assert!(style.contains(&format!("width:{width};height:{height}")), "{more:?}: {root}");
            assert!(
                !style.contains("100px") && (sides(&out)[0].trim_end_matches("px") == width.trim_end_matches("px")),
                "{root}"
            );
        }
    }
}

/// Parameters are lengths of the source; the page size is that of the result, after `--fit`.
#[test]
fn parameters_are_lengths_of_the_source() {
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='80mm' height='60mm' viewBox='0 0 80 60'>\
               <circle cx='20' cy='20' r='10' fill='none' stroke='red' stroke-width='0.1'/></svg>";
    let circle = |args: &[&str]| {
        let file = dxf(&[&["affine", "-", "--move-x", "20mm", "--fit", "none"], args].concat(), svg);
        let e = &file.entities[0];
        [e.number(10), e.number(20), e.number(40)]
    };
    let near = |a: [f64; 3], b: [f64; 3]| assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-4), "{a:?} {b:?}");
    near(circle(&["--page-width", "160mm"]), [80.0, 80.0, 20.0]);
    near(circle(&["--page-width", "160mm", "--kerf", "0.2mm"]), [80.0, 80.0, 20.1]);
}

/// A tolerance with a unit holds in the result: a coarser one gives fewer nodes, on any page.
#[test]
fn the_tolerance_is_that_of_the_result() {
    let svg = drawing("80mm", "60mm", 1.0);
    let bent = |more: &[&str]| {
        run(&[&["expr", "-", "--y", "y + 9*sin(x/7)", "--fit", "none", "--strokes", "keep"], more].concat(), &svg)
    };
    let exact = outlines(&bent(&["--tolerance", "1e-4"]));
    let nodes = |svg: &[u8]| svg.iter().filter(|b| b"CcSsQqAa".contains(b)).count();
    let fine = bent(&["--tolerance", "0.02mm", "--page-width", "800mm"]);
    let got = scaled(&outlines(&fine), 0.1);
    assert!(gap(&got, &exact) < 0.002 + SAMPLING, "{}", gap(&got, &exact));
    let coarse = bent(&["--tolerance", "0.02mm", "--page-width", "8mm"]);
    let got = scaled(&outlines(&coarse), 10.0);
    let off = gap(&got, &exact);
    assert!(off < 0.2 + 5.0 * SAMPLING, "{off}");
    assert!(nodes(&coarse) < nodes(&fine), "{} {}", nodes(&coarse), nodes(&fine));
}

/// Lettering and conversions have these options, too.
#[test]
fn every_command_that_writes_drawings_has_it() {
    let text = run(&["text", "Label", "--page-width", "80mm"], "");
    assert_eq!(sides(&text)[0], "80mm");
    let svg = drawing("80mm", "60mm", 1.0);
    let file = dxf(&["convert", "-", "--page-width", "40mm"], &svg);
    let (got, exact) = (file.polylines(), scaled(&outlines(svg.as_bytes()), 0.5));
    assert!(gap(&got, &exact).max(gap(&exact, &got)) < SAMPLING);
    let pdf = run(&["convert", "-", "--page-width", "25.4mm", "--format", "pdf"], &svg);
    let text = String::from_utf8_lossy(&pdf).into_owned();
    assert!(text.contains("/MediaBox [0 0 72 54"), "{}", &text[..600.min(text.len())]);
}

#[test]
fn sheets_and_paths_of_gimp_have_it() {
    let svg = drawing("80mm", "60mm", 1.0);
    let sheet = run(&["gallery", "-", "--page-width", "210mm", "--page-height", "297mm"], &svg);
    let [width, height] = sides(&sheet).map(|side| side.trim_end_matches("mm").parse::<f64>().unwrap());
    assert!(width == 210.0 && height < 297.0 || width < 210.0 && height == 297.0, "{width} {height}");
    let refused = ["gallery", "-", "--page-width", "210mm", "--format", "png"];
    assert_eq!(pathwarp_in(Path::new("."), &refused, svg.as_bytes()).status.code(), Some(2));

    let list = |more: &[&str]| -> serde_json::Value {
        serde_json::from_slice(&run(&[&["convert", "-", "--format", "json"], more].concat(), &svg)).unwrap()
    };
    let points = |v: &serde_json::Value| -> Vec<f64> {
        let points = v["paths"][0]["strokes"][0]["controlpoints"].as_array().unwrap();
        points.iter().map(|p| p.as_f64().unwrap()).collect()
    };
    let (plain, large) = (list(&[]), list(&["--page-width", "50mm"]));
    // 50 mm are 50/25.4 · 96 px.
    let scale = 50.0 / 25.4 * 96.0 / plain["width"].as_f64().unwrap();
    for side in ["width", "height"] {
        assert!((large[side].as_f64().unwrap() - scale * plain[side].as_f64().unwrap()).abs() < 1e-9, "{side}");
    }
    for (a, b) in points(&plain).iter().zip(points(&large)) {
        assert!((scale * a - b).abs() < 1e-9 * b.abs().max(1.0), "{a} {b}");
    }
    let dir = tempfile::tempdir().unwrap();
    let xcf = dir.path().join("out.xcf").display().to_string();
    run(&["convert", "-", "--page-width", "300", "-o", &xcf], &svg);
    // The canvas is in the header (devel-docs/xcf.txt): after the magic number of 14 bytes.
    let bytes = std::fs::read(&xcf).unwrap();
    assert_eq!(bytes[14..18], 300u32.to_be_bytes());
}

/// The report has the tolerance of the curves in units of the source: a tenth of it on a page ten times as large.
#[test]
fn the_report_has_the_tolerance_of_the_result() {
    let svg = drawing("80mm", "60mm", 1.0);
    let dir = tempfile::tempdir().unwrap();
    let report = dir.path().join("report.json").display().to_string();
    let out = dir.path().join("out.svg").display().to_string();
    let tolerance = |more: &[&str]| {
        let bend = ["expr", "-", "--y", "y + 9*sin(x/7)", "--fit", "none", "--tolerance", "0.02mm"];
        run(&[&bend[..], &["--report", &report, "-o", &out], more].concat(), &svg);
        let read: serde_json::Value = serde_json::from_slice(&std::fs::read(&report).unwrap()).unwrap();
        let file = &read["inputs"][0];
        let most = |key: &str| {
            let shapes = file["shapes"].as_array().unwrap();
            shapes.iter().map(|s| s[key].as_f64().unwrap_or(f64::NAN)).fold(0.0, f64::max)
        };
        assert!(most("max_error") <= 1.001 * file["tolerance"].as_f64().unwrap());
        file["tolerance"].as_f64().unwrap()
    };
    let (same, large) = (tolerance(&[]), tolerance(&["--page-width", "800mm"]));
    assert!((same / large - 10.0).abs() < 1e-6, "{same} {large}");
}
