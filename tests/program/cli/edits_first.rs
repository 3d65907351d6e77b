//! `--simplify` and `--outset`: drawings are edited before they are bent.

use super::common::text;
use crate::support::{pathwarp_in, root};
use pathwarp::kurbo::{BezPath, ParamCurve as _, Point};
use std::path::Path;

const FLAG: [&str; 5] = ["warp", "--style", "flag", "--bend", "30%"];

fn run(args: &[&str], input: &[u8]) -> String {
    let out = pathwarp_in(Path::new("."), args, input);
    assert_eq!(out.status.code(), Some(0), "{args:?}: {}", text(&out.stderr));
    text(&out.stdout)
}

fn sample(name: &str) -> Vec<u8> {
    std::fs::read(root().join("samples").join(name)).unwrap()
}

/// An option gives the result of a separate command for each edit.
#[test]
fn edits_come_before_the_bend() {
    for name in ["traced/word.svg", "logo.svg", "lettering-text.svg"] {
        let source = sample(name);
        let simple = run(&["simplify", "-", "--tolerance", "0.5"], &source);
        let thick = run(&["offset", "-", "--by", "2"], simple.as_bytes());
        let expected = run(&FLAG, thick.as_bytes());
        let at_once = run(&[&FLAG[..], &["--simplify", "0.5", "--outset", "2"]].concat(), &source);
        assert_eq!(at_once, expected, "{name}");
        let thin = run(&["offset", "-", "--by", "0.5", "--side", "inside"], &source);
        let at_once = run(&[&FLAG[..], &["--outset=-0.5"]].concat(), &source);
        assert_eq!(at_once, run(&FLAG, thin.as_bytes()), "{name}");
        let nothing = run(&[&FLAG[..], &["--simplify", "0", "--outset", "0mm"]].concat(), &source);
        assert_eq!(nothing, run(&FLAG, &source), "{name}");
    }
}

/// A drawing that is only offset has the page of `offset`, and a bend adds to that. The margin is 4 units.
#[test]
fn the_page_grows_with_the_artwork() {
    let source = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 300 100'><path d='M4,4H296V96H4Z'/></svg>";
    let offset = run(&["offset", "-", "--by", "10"], source.as_bytes());
    assert!(offset.contains("viewBox='-10 -10 320 120'"), "{offset}");
    assert_eq!(run(&["affine", "-", "--outset", "10"], source.as_bytes()), offset);
    let moved = run(&["affine", "-", "--outset", "10", "--move-x", "20"], source.as_bytes());
    assert!(moved.contains("viewBox='0 -10 330 120'"), "{moved}");
    let simple = run(&["affine", "-", "--simplify", "1"], source.as_bytes());
    assert!(simple.contains("viewBox='0 0 300 100'"), "{simple}");
}

/// A chain and a recipe give the result of the options and of one command after the other.
#[test]
fn edits_are_steps() {
    let source = sample("traced/word.svg");
    let dir = tempfile::tempdir().unwrap();
    let recipe = dir.path().join("r.toml").display().to_string();
    let chain = |more: &[&str]| {
        let first = ["offset", "-", "--by", "0.5", "--side", "inside", "--join", "miter"];
        run(&[&first[..], more, &["+"], &FLAG].concat(), &source)
    };
    let moved = ["offset", "-", "--by", "0.5", "--side", "inside", "--join", "miter"];
    let expected = run(&FLAG, run(&moved, &source).as_bytes());
    assert_eq!(chain(&["--write-recipe", &recipe]), expected);
    let text = std::fs::read_to_string(&recipe).unwrap();
    assert!(text.contains("deformation = \"offset\"") && text.contains("join = \"miter\""), "{text}");
    assert_eq!(run(&["run", &recipe, "-"], &source), expected);
    // An edit with a selection leaves the rest alone, even before other edits.
    let two = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 90 90'><path id='a' d='M9,9H30V30H9Z'/><path id='b' d='M50,50H80V80H50Z'/></svg>";
    let grown = run(&["offset", "-", "--by", "2", "--select", "#a"], two.as_bytes());
    assert!(grown.contains("d='M50,50H80V80H50Z'") && !grown.contains("M9,9"), "{grown}");
    let both = ["offset", "-", "--by", "2", "--select", "#a", "+", "offset", "--by", "3", "--select", "#b"];
    let then = run(&["offset", "-", "--by", "3", "--select", "#b"], grown.as_bytes());
    assert_eq!(run(&both, two.as_bytes()), then);
    for (wrong, part) in [
        (&["warp", "-", "--style", "flag", "+", "simplify"][..], "simplify comes before all steps that bend"),
        (&["run", &recipe, "-", "--inverse", "--frame", "0,0,9,9"], "has no inverse"),
        (&["offset", "-", "--by", "1", "--strokes", "keep"], "--strokes is for steps that bend"),
        (&["offset", "-", "+", "warp", "--style", "flag"], "by"),
    ] {
        let out = pathwarp_in(Path::new("."), wrong, &source);
        assert!(out.status.code() == Some(2) && text_of(&out).contains(part), "{wrong:?}: {}", text_of(&out));
    }
}

fn text_of(out: &std::process::Output) -> String {
    text(&out.stderr)
}

/// Artwork that no step bends stays. Elements without ids are named by their positions in the source, and no ids are added.
#[test]
fn edits_concern_what_is_bent() {
    let svg = |a: &str, b: &str| {
        format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path{a} d='M10,10H40V40H10Z'/><path{b} d='M50,50H80V80H50Z'/></svg>"
        )
    };
    let plain = svg("", "");
    let place = format!("path at 1:{}", plain.rfind("<path").unwrap() + 1);
    let by_place = run(&[&FLAG[..], &["--outset", "3", "--select", &place]].concat(), plain.as_bytes());
    let by_id = run(&[&FLAG[..], &["--outset", "3", "--select", "#b"]].concat(), svg("", " id='b'").as_bytes());
    assert_eq!(by_place, by_id.replace(" id='b'", ""));
    assert!(by_place.contains("d='M10,10H40V40H10Z'") && !by_place.contains("50,50"), "{by_place}");
    let chain = ["--select", &place, "--outset", "3", "+", "affine", "--move-x", "5", "--select", "nothing"];
    let out = pathwarp_in(Path::new("."), &[&FLAG[..], &chain].concat(), plain.as_bytes());
    assert!(text(&out.stderr).contains("nothing matches `nothing`"), "{}", text(&out.stderr));
}

/// A recipe keeps the edits, and a result leads back to its source.
#[test]
fn recipes_keep_the_edits() {
    let source = sample("lettering.svg");
    let embedded = run(&[&FLAG[..], &["--outset", "1%", "--simplify", "0.1mm", "--embed-recipe"]].concat(), &source);
    assert!(embedded.contains("outset = \"1%\"") && embedded.contains("simplify = \"0.1mm\""));
    assert_eq!(run(&["unwarp", "-"], embedded.as_bytes()).as_bytes(), source);
}

#[test]
fn what_cannot_be_edited_is_said() {
    let said = |args: &[&str], input: &[u8]| {
        let out = pathwarp_in(Path::new("."), &[&FLAG[..], args].concat(), input);
        assert_eq!(out.status.code(), Some(2), "{args:?}");
        text(&out.stderr)
    };
    let logo = sample("logo.svg");
    assert!(said(&["--simplify", "wide"], &logo).contains("--simplify: `wide` is not a length"));
    assert!(said(&["--simplify=-1"], &logo).contains("below zero"));
    assert!(said(&["--simplify", "1e-30"], &logo).contains("--simplify: 1e-30 is finer than"));
    let dir = tempfile::tempdir().unwrap();
    let picture = dir.path().join("logo.png").display().to_string();
    assert!(pathwarp_in(dir.path(), &["render", "-", "-o", &picture], &logo).status.success());
    assert!(said(&["--outset", "1", &picture], b"").contains("a picture has none"));
}

/// Small contours keep their shape beside large ones, in one path or in several.
#[test]
fn dots_of_large_drawings_grow_evenly() {
    let dot = "M52,50A2,2 0 1 1 48,50A2,2 0 1 1 52,50Z";
    let drawings =
        [format!("<path d='{dot}M0,900H9000V9000H0Z'/>"), format!("<path d='{dot}'/><path d='M0,900H9000V9000H0Z'/>")];
    for drawing in drawings {
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9000 9000'>{drawing}</svg>");
        let out = run(&["offset", "-", "--by", "1"], svg.as_bytes());
        let data = out.split(['"', '\'']).filter(|t| t.starts_with('M'));
        let path: BezPath = data.flat_map(|d| BezPath::from_svg(d).unwrap()).collect();
        let near = |p: &Point| p.distance(Point::new(50.0, 50.0)) < 10.0;
        let points = path.segments().flat_map(|s| (0..=20).map(move |i| s.eval(f64::from(i) / 20.0)));
        let radii: Vec<f64> = points.filter(near).map(|p| p.distance(Point::new(50.0, 50.0))).collect();
        // 2e-3 of the diagonal of the dot.
        let allowed = 2e-3 * 32.0_f64.sqrt() + 1e-4;
        assert!(radii.len() > 60 && radii.iter().all(|r| (r - 3.0).abs() <= allowed), "{drawing}: {radii:?}");
    }
}

/// Open lines stay unchanged beside areas, and move where they are selected, or alone. Filled shapes are areas, closed or not.
#[test]
fn lines_stay_beside_areas() {
    let leaf = "<path id='leaf' fill='#6a4' d='M10,10H90V60H10Z'/>";
    let vein = "<path id='vein' fill='none' stroke='#000' d='M20,35H80'/>";
    let drawing = |body: &str| format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 70'>{body}</svg>");
    let offset = |body: &str, more: &[&str]| {
        let args = [&["offset", "-", "--by", "4", "--join", "miter"], more].concat();
        let out = pathwarp_in(Path::new("."), &args, drawing(body).as_bytes());
        (String::from_utf8(out.stdout).unwrap(), String::from_utf8(out.stderr).unwrap())
    };
    let (grown, notes) = offset(&format!("{leaf}{vein}"), &[]);
    assert!(grown.contains("M6,6") && grown.contains("M20,35H80"), "{grown}");
    assert!(notes.contains("--lines") && notes.contains("vein"), "{notes}");
    for (body, more) in [
        (format!("{leaf}{vein}"), &["--lines"][..]),
        (format!("{leaf}{vein}"), &["--select", "#vein"]),
        (vein.into(), &[]),
    ] {
        let (moved, notes) = offset(&body, more);
        assert!(moved.contains("39") && !moved.contains("M20,35H80") && !notes.contains("--lines"), "{moved} {notes}");
    }
    let (grown, _) = offset(&format!("{}{vein}", leaf.replace('Z', "")), &[]);
    assert!(grown.contains("M6,6") && grown.contains("M20,35H80"), "{grown}");
}
