//! `--gradients exact` through the program, compared with the rendering of the original sampled through the inverse map.

use crate::support::pathwarp_in;
use base64::Engine as _;
use pathwarp_oracle::drawings::{Gap, drawing, gap};
use serde_json::Value;
use std::fs;

/// Name, drawing, number of gradients that become pictures with `exact`; the others become gradients that look alike.
const GRADIENTS: &[(&str, &str, u64)] = &[
    (
        "linear and radial, in box units and user space",
        "<linearGradient id='a'><stop stop-color='#f40'/><stop offset='.4' stop-color='#fe3'/><stop offset='1' \
         stop-color='#03c'/></linearGradient><radialGradient id='b' gradientUnits='userSpaceOnUse' cx='60' cy='60' r='40' \
         fx='50' fy='45' href='#a'/><rect x='5' y='5' width='60' height='40' fill='url(#a)'/><circle cx='60' cy='65' r='30' \
         fill='url(#b)'/>",
        2,
    ),
    (
        "repeated and reflected, half transparent, in frames of their own",
        "<linearGradient id='a' spreadMethod='repeat' x2='.3' y2='.1'><stop stop-color='red' stop-opacity='.2'/><stop \
         offset='1' stop-color='blue'/></linearGradient><radialGradient id='b' spreadMethod='reflect' cx='.3' cy='.4' r='.25' \
         gradientTransform='rotate(20) scale(1 .7)'><stop stop-color='white'/><stop offset='1' stop-color='#063'/>\
         </radialGradient><g transform='translate(8 2) rotate(8) scale(1.1 .9)'><path d='M5 5H85V50H5zM30 15H60V40H30z' \
         fill-rule='evenodd' fill='url(#a)'/><ellipse cx='50' cy='72' rx='40' ry='22' fill='url(#b)' opacity='.8'/></g>",
        2,
    ),
    (
        "on a stroke and on its fill, on text and in a copy",
        "<linearGradient id='a' gradientUnits='userSpaceOnUse' x1='10' y1='10' x2='90' y2='80'><stop stop-color='gold'/>\
         <stop offset='.5' stop-color='purple'/><stop offset='1' stop-color='teal'/></linearGradient><defs><path id='p' \
         d='M10 10h30v20z' fill='url(#a)'/></defs><path d='M15 45C50 20 60 80 90 40L70 60z' fill='url(#a)' stroke='url(#a)' \
         stroke-width='9' fill-opacity='.4' stroke-linejoin='round'/><use href='#p' x='30'/><text x='8' y='95' \
         font-size='38' font-family='Noto Sans' fill='url(#a)'>Sea</text>",
        1,
    ),
];

/// Bends a drawing. Returns its distance from the expected picture, the file, and its report.
fn bent(body: &str, gradients: &str) -> (Gap, String, Value) {
    let dir = tempfile::tempdir().unwrap();
    let svg = drawing(body);
    fs::write(dir.path().join("in.svg"), &svg).unwrap();
    // The formulas of `common::Bend`.
    let map = ["--x", "x + 6*sin(y/30)", "--y", "y + 8*sin(x/25)"];
    let args = ["expr", "in.svg", "-o", "out.svg", "--report", "r.json", "--gradients", gradients];
    let run = pathwarp_in(dir.path(), &[&args[..], &map].concat(), b"");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let out = fs::read_to_string(dir.path().join("out.svg")).unwrap();
    let report = serde_json::from_slice(&fs::read(dir.path().join("r.json")).unwrap()).unwrap();
    (gap(&svg, &out), out, report)
}

fn pictures(report: &Value) -> u64 {
    let shapes = report["inputs"][0]["shapes"].as_array().unwrap();
    shapes.iter().filter_map(|s| s["pictures"].as_u64()).sum()
}

#[test]
fn exact_gradients_are_the_bent_rendering() {
    for (name, body, count) in GRADIENTS {
        let (exact, svg, report) = bent(body, "exact");
        let (fitted, _, fits) = bent(body, "fit");
        println!("{name}: {:.2} / 255 exact, {:.2} / 255 fitted", exact.mean, fitted.mean);
        assert!(exact.mean <= 1.0, "{name}: {exact:?}");
        // Check that the comparison can fail.
        assert!(fitted.mean > 3.0 * exact.mean, "{name}: {fitted:?} and {exact:?}");
        assert_eq!(pictures(&report), *count, "{name}");
        assert_eq!(svg.matches("<image").count() as u64, *count, "{name}");
        assert_eq!(pictures(&fits), 0);
        let shapes = |r: &Value| r["inputs"][0]["shapes"].as_array().unwrap().clone();
        assert!(shapes(&report).iter().all(|s| s.get("paint_residual").is_none()), "{report}");
        // The map moves a drawing of 100 units by a few units.
        assert!(shapes(&fits).iter().all(|s| (0.1..10.0).contains(&s["paint_residual"].as_f64().unwrap())), "{fits}");
    }
}

/// A gradient whose bend is invisible stays a gradient.
#[test]
fn a_gradient_that_can_follow_stays_one() {
    let body = "<linearGradient id='a'><stop stop-color='#777'/><stop offset='1' stop-color='#787878'/></linearGradient>\
                <rect width='90' height='90' fill='url(#a)'/>";
    let (_, svg, report) = bent(body, "exact");
    assert_eq!((svg.matches("<image").count(), pictures(&report)), (0, 0), "{svg}");
    assert!(report["inputs"][0]["shapes"][0]["paint_residual"].as_f64().unwrap() > 0.1, "{report}");
}

/// By default, a gradient becomes a picture only if its fit would be noticed.
#[test]
fn gradients_that_would_look_wrong_are_exact_by_default() {
    for (name, body, count) in GRADIENTS {
        let (auto, svg, report) = bent(body, "auto");
        let (fitted, ..) = bent(body, "fit");
        println!("{name}: {:.2} / 255 by default, {:.2} / 255 fitted", auto.mean, fitted.mean);
        assert!(auto.mean <= 1.0 && fitted.mean > 1.5 * auto.mean, "{name}: {auto:?} and {fitted:?}");
        assert!(pictures(&report) <= *count, "{name}");
        // The default is `auto`.
        let dir = tempfile::tempdir().unwrap();
        let run = |args: &[&str]| {
            pathwarp_in(
                dir.path(),
                &[&["expr", "--x", "x + 6*sin(y/30)", "--y", "y + 8*sin(x/25)"], args].concat(),
                drawing(body).as_bytes(),
            )
        };
        assert_eq!(String::from_utf8(run(&[]).stdout).unwrap(), svg);
    }
    // A few levels of difference: visible in a comparison, not by itself.
    let soft = "<linearGradient id='a'><stop stop-color='#333'/><stop offset='1' stop-color='#999'/></linearGradient>\
                <rect width='90' height='90' fill='url(#a)'/>";
    let count = |way: &str| pictures(&bent(soft, way).2);
    assert_eq!((count("auto"), count("exact"), count("fit")), (0, 1, 0));
    // A hard edge that moves a little.
    let hard = "<linearGradient id='a'><stop offset='.5' stop-color='red'/><stop offset='.5' stop-color='blue'/>\
                </linearGradient><rect width='10' height='10' fill='url(#a)'/>";
    assert_eq!(pictures(&bent(hard, "auto").2), 0);
    assert_eq!(pictures(&bent(&hard.replace("'10'", "'90'"), "auto").2), 1);
}

/// Every gradient that became a picture is reported once, and no picture shows its pixels.
#[test]
fn pictures_are_said_and_not_coarse() {
    let dir = tempfile::tempdir().unwrap();
    let body = "<linearGradient id='a' x2='0' y2='1'><stop stop-color='red'/><stop offset='1' stop-color='blue'/></linearGradient>\
                <rect id='wide' width='900' height='40' fill='url(#a)'/><rect id='high' y='100' width='8' height='8' fill='url(#a)'/>";
    fs::write(dir.path().join("in.svg"), drawing(body)).unwrap();
    let run = |args: &[&str]| {
        let map = ["expr", "in.svg", "-o", "out.svg", "--y", "y + 30*sin(x/90)", "--report", "r.json"];
        let run = pathwarp_in(dir.path(), &[&map[..], args].concat(), b"");
        let report: Value = serde_json::from_slice(&fs::read(dir.path().join("r.json")).unwrap()).unwrap();
        (String::from_utf8(run.stderr).unwrap(), report["inputs"][0]["warnings"].to_string())
    };
    let line = "a gradient became a picture; --gradients fit keeps it vector";
    let (told, warnings) = run(&["--explain"]);
    assert_eq!((told.matches(line).count(), warnings.matches(line).count()), (1, 1), "{told}");
    assert!(told.contains("gradients: pictures on wide"), "{told}");
    let svg = fs::read_to_string(dir.path().join("out.svg")).unwrap();
    let (width, height) = first_picture(&svg);
    assert!(width >= 900 / 4 && height >= 64, "{width} x {height}");
    let (told, warnings) = run(&["--gradients", "fit"]);
    assert!(!told.contains("picture") && warnings == "[]", "{told}");
}

/// Width and height in pixels of the first picture in a drawing, a PNG.
fn first_picture(svg: &str) -> (u32, u32) {
    let data = svg.split("data:image/png;base64,").nth(1).unwrap().split('"').next().unwrap();
    let bytes = base64::engine::general_purpose::STANDARD.decode(data).unwrap();
    let read = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
    (read(16), read(20))
}
