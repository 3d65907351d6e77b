//! `contour` as a command, in recipes, and in the files for cutters and printers.

use super::common::text;
use crate::support::pathwarp_in;
use std::path::Path;

fn run(args: &[&str], input: &str) -> (Option<i32>, Vec<u8>, String) {
    let out = pathwarp_in(Path::new("."), args, input.as_bytes());
    (out.status.code(), out.stdout, text(&out.stderr))
}

/// Two bars of 30 by 10 mm, 20 mm apart.
const BARS: &str = "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' height='80mm' viewBox='0 0 100 80'><g id='art'><path id='a' d='M20,20H50V30H20Z'/><path id='b' d='M20,50H50V60H20Z' fill='red'/></g></svg>";

#[test]
fn a_note_says_how_many_lines_there_are() {
    let (code, out, said) = run(&["contour", "-", "--by", "3mm"], BARS);
    assert!(code == Some(0) && said.starts_with("note: 2 lines around 2 islands"), "{said}");
    assert!(text(&out).contains("id=\"Contour\"") && text(&out).contains("id='art'"), "{}", text(&out));
    for quiet in [&["contour", "-", "--by", "11mm"][..], &["contour", "-", "--by", "3mm", "--join"]] {
        assert_eq!(run(quiet, BARS).2, "", "{quiet:?}");
    }
    let dir = tempfile::tempdir().unwrap();
    let recipe = dir.path().join("r.toml").display().to_string();
    let cut = ["contour", "-", "--by", "3mm", "--spot", "CutContour", "--bleed", "1mm", "--marks"];
    let (_, first, _) = run(&[&cut[..], &["--write-recipe", &recipe]].concat(), BARS);
    assert_eq!(run(&["run", &recipe, "-"], BARS).1, first);
    assert_eq!(run(&cut, BARS).1, first, "the same twice");
}

/// Sizes are correct to a hundredth of a millimetre: the box of the line in the DXF, in mm, on the layer with its name.
#[test]
fn the_dxf_has_a_layer_of_the_name() {
    let (_, out, _) = run(
        &["contour", "-", "--by", "11mm", "--spot", "CutContour", "--dxf-curves", "polyline", "--format", "dxf"],
        BARS,
    );
    let dxf = text(&out);
    let lines: Vec<&str> = dxf.lines().map(str::trim).collect();
    let mut at = [Vec::new(), Vec::new()];
    let (mut layer, mut entity) = ("", "");
    for pair in lines.chunks_exact(2) {
        match pair[0] {
            "0" => entity = pair[1],
            "8" => layer = pair[1],
            "10" | "20" if layer == "CutContour" && entity == "LWPOLYLINE" => {
                at[usize::from(pair[0] == "20")].push(pair[1].parse::<f64>().unwrap());
            }
            _ => {}
        }
    }
    let extent = |v: &[f64]| {
        v.iter().copied().fold(f64::NEG_INFINITY, f64::max) - v.iter().copied().fold(f64::INFINITY, f64::min)
    };
    assert!(
        (extent(&at[0]) - 52.0).abs() < 0.01 && (extent(&at[1]) - 62.0).abs() < 0.01,
        "{:?}",
        at.map(|v| extent(&v))
    );
    assert!(dxf.contains("\nart\n"), "named groups stay layers");
}

/// The PDF has one ink of the name, which overprints the artwork below unless told to knock it out.
#[test]
fn the_pdf_has_an_ink_of_the_name() {
    let pdf = |more: &[&str]| {
        let args =
            [&["contour", "-", "--by", "3mm", "--join", "--spot", "Cut Contour", "--format", "pdf"], more].concat();
        let (code, out, said) = run(&args, BARS);
        assert_eq!(code, Some(0), "{said}");
        String::from_utf8_lossy(&out).into_owned()
    };
    let over = pdf(&[]);
    assert_eq!(over.matches("/Separation /Cut#20Contour /DeviceCMYK").count(), 1, "{over}");
    assert!(over.contains("/OP true") && over.contains("/OPM 1"), "{over}");
    assert!(!pdf(&["--knockout"]).contains("/OP true"));
    assert!(pdf(&["--marks"]).contains("/Separation /All /DeviceCMYK"));
}

#[test]
fn what_cannot_be_is_said_in_a_sentence() {
    let unmeasured = BARS.replace("width='100mm' height='80mm'", "");
    let hidden = BARS.replace("<g id", "<g opacity='0' id");
    let long = "x".repeat(128);
    for (args, input, code, part) in [
        (&["--by=-6mm"][..], BARS, 3, "nothing is left"),
        (&["--by", "3mm"], &unmeasured, 0, "the page has no unit"),
        (&["--by", "3mm"], &hidden, 3, "nothing is visible"),
        (&["--by", "3mm", "--spot", "Cut", "-o", "x.png"], BARS, 2, "png"),
        (&["--by", "3mm", "--spot", &long], BARS, 2, "at most 127 bytes"),
        (&["--by", "3mm", "--spot", ""], BARS, 2, "at least one letter"),
        (&["--by", "3mm", "--spot", "All"], BARS, 2, "meaning of its own"),
        (&["--by", "3mm", "--knockout"], BARS, 2, "--spot"),
        (&["--by", "3mm", "--only", "--bleed", "1mm"], BARS, 2, "--only"),
        (&[], BARS, 2, "--by"),
    ] {
        let (found, _, said) = run(&[&["contour", "-"], args].concat(), input);
        assert!(found == Some(code) && said.contains(part), "{args:?}: {found:?} {said}");
    }
}

/// The pixels beyond a red bar are red, as far as the bleed extends.
#[test]
fn the_bleed_continues_colours() {
    let args = ["contour", "-", "--by", "1mm", "--bleed", "2mm", "--format", "svg"];
    let (_, out, _) = run(&args, BARS);
    let svg = text(&out);
    assert!(svg.find("id=\"Bleed\"").unwrap() < svg.find("id='art'").unwrap(), "{svg}");
    let (_, png, _) = run(&["render", "-", "--width", "1000", "-o", "-", "--format", "png"], &svg);
    let drawn = pathwarp_raster::decode_png(&png).unwrap();
    let scale = f64::from(drawn.width()) / 100.0;
    let at = |x: f64, y: f64| {
        let p = drawn.pixel((x * scale) as u32, (y * scale) as u32).unwrap();
        [p.red(), p.green(), p.blue(), p.alpha()]
    };
    assert_eq!([at(35.0, 62.0), at(18.0, 55.0), at(35.0, 18.0)], [[255, 0, 0, 255], [255, 0, 0, 255], [0, 0, 0, 255]]);
    assert_eq!([at(35.0, 63.6), at(35.0, 40.0)].map(|p| p[3]), [0, 0]);
}
