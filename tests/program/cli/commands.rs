//! Further subcommands, and programs that add deformations.

use super::common::{SQUARE, text};
use crate::support::{expect_code, pathwarp_in, sample};
use serde_json::Value;
use std::fs;

#[test]
fn paths_lists_names_anchors_and_points() {
    let (json, _) = expect_code(0, &["paths", "--json", "samples/cages.svg"]);
    let list: Value = serde_json::from_str(&json).unwrap();
    let all = list["paths"].as_array().unwrap();
    let arch = all.iter().find(|p| p["name"] == "arch").unwrap();
    let stroke = &arch["strokes"][0];
    assert_eq!((stroke["closed"].as_bool(), stroke["anchors"].as_u64()), (Some(true), Some(4)));
    assert_eq!(stroke["points"].as_array().unwrap().len(), 12);
    let (table, _) = expect_code(0, &["paths", "samples/cages.svg"]);
    assert!(table.lines().any(|l| l.starts_with("arch") && l.contains("closed")), "{table}");
}

#[test]
fn compare_measures_the_distance_and_can_fail() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("a.svg"), SQUARE).unwrap();
    fs::write(dir.path().join("b.svg"), SQUARE.replace("M0,0H100V100", "M0,0H100V90")).unwrap();
    let same =
        pathwarp_in(dir.path(), &["compare", "a.svg", "a.svg", "--max-distance", "1e-9", "--max-pixels", "0"], b"");
    assert_eq!(same.status.code(), Some(0), "{}", text(&same.stdout));
    let apart = pathwarp_in(dir.path(), &["compare", "--json", "a.svg", "b.svg", "--max-distance", "9.9"], b"");
    assert_eq!(apart.status.code(), Some(1));
    let c: Value = serde_json::from_slice(&apart.stdout).unwrap();
    assert!((c["max_distance"].as_f64().unwrap() - 10.0).abs() < 1e-9);
    assert!((c["pixels"]["visible_share"].as_f64().unwrap() - 0.1).abs() < 0.005, "{c}");
}

/// A stroke of fixed width is as wide under a scale as one without.
#[test]
fn compare_sees_what_browsers_show() {
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, path: &str| {
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{path}</svg>");
        fs::write(dir.path().join(name), svg).unwrap();
    };
    let style = "stroke='black' stroke-width='4' vector-effect='non-scaling-stroke'";
    write("a.svg", &format!("<path id='p' transform='scale(10 1)' d='M5 10v80' {style}/>"));
    write("b.svg", "<path id='p' d='M50 10v80' stroke='black' stroke-width='4'/>");
    let out = pathwarp_in(dir.path(), &["compare", "a.svg", "b.svg", "--max-pixels", "0"], b"");
    assert_eq!(out.status.code(), Some(0), "{}", text(&out.stdout));
}

#[test]
fn what_is_warped_in_part_is_said_in_a_sentence() {
    let svg = SQUARE.replace("<path", "<path fill='future(1)'");
    let dir = tempfile::tempdir().unwrap();
    let out = pathwarp_in(dir.path(), &["warp", "-", "--style", "arc"], svg.as_bytes());
    let said = text(&out.stderr);
    let wanted =
        "is warped only with black in place of “fill: future(1)”, a colour that is not understood; write it as #rrggbb";
    assert!(out.status.code() == Some(1) && said.contains(wanted), "{said}");
}

#[test]
fn compare_matches_what_is_renamed_by_place_and_fails_where_a_shape_is_missing() {
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, body: &str| {
        let svg = format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{body}</svg>");
        fs::write(dir.path().join(name), svg).unwrap();
    };
    write("a.svg", "<path id='p' d='M0,0h10v10z'/><path id='q' d='M50,50h10v10z'/>");
    write("b.svg", "<path id='other' d='M50,53h10v10z'/><path id='another' d='M0,0h10v10z'/>");
    write("c.svg", "<path id='p' d='M0,0h10v10z'/>");
    write("d.svg", "");
    let compare = |a: &str, b: &str| {
        let out = pathwarp_in(dir.path(), &["compare", "--json", a, b], b"");
        (out.status.code(), serde_json::from_slice::<Value>(&out.stdout).unwrap())
    };
    let (code, c) = compare("a.svg", "b.svg");
    let distances: Vec<f64> = c["paths"].as_array().unwrap().iter().map(|p| p["distance"].as_f64().unwrap()).collect();
    assert!(code == Some(0) && distances[0] < 1e-9 && (distances[1] - 3.0).abs() < 1e-9, "{c}");
    for (a, b, only) in [("a.svg", "c.svg", "only_in_a"), ("c.svg", "a.svg", "only_in_b")] {
        let (code, c) = compare(a, b);
        assert!(code == Some(1) && c[only] == serde_json::json!(["q"]), "{c}");
    }
    assert_eq!(compare("d.svg", "c.svg").0, Some(1));
}

#[test]
fn folded_pictures_are_said() {
    let dir = tempfile::tempdir().unwrap();
    let photo = pathwarp_raster::Pixmap::new(100, 90).unwrap();
    fs::write(dir.path().join("p.png"), pathwarp_raster::encode_png(&photo).unwrap()).unwrap();
    fs::write(
        dir.path().join("d.svg"),
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><image id='pic' width='100' height='90' href='p.png'/></svg>",
    )
    .unwrap();
    for (input, name) in [("p.png", "the picture"), ("d.svg", "pic")] {
        let folded = |x: &str| {
            let out = pathwarp_in(dir.path(), &["expr", input, "--x", x, "-o", &format!("out-{input}")], b"");
            text(&out.stderr).contains(&format!("{name} folds over"))
        };
        assert!(folded("abs(x-50)") && !folded("x+sin(y)"), "{input}");
    }
}

#[test]
fn compare_matches_paths_without_id_by_their_order() {
    let dir = tempfile::tempdir().unwrap();
    let compare = |a: &str, b: &str| -> Value {
        let svg = |body: &str| format!("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{body}</svg>");
        fs::write(dir.path().join("a.svg"), svg(a)).unwrap();
        fs::write(dir.path().join("b.svg"), svg(b)).unwrap();
        let out = pathwarp_in(dir.path(), &["compare", "--json", "a.svg", "b.svg"], b"");
        serde_json::from_slice(&out.stdout).unwrap()
    };
    let distances = |c: &Value| -> Vec<f64> {
        c["paths"].as_array().unwrap().iter().map(|p| p["distance"].as_f64().unwrap().round()).collect()
    };
    let square = |x: i32| format!("<path d='M{x},0h10v10h-10z'/>");
    // Everything is on one line, so longer numbers shift the text after them; and a rectangle may have become a path.
    let a = format!("{}{}<g id='g'>{}<path id='p' d='M0,50h9'/></g>", square(0), square(20), square(40));
    let b = format!("{}{}<g id='g'>{}<path id='p' d='M0,57h9'/></g>", square(-100), square(23), square(45));
    let c = compare(&a, &b);
    assert_eq!(distances(&c), [100.0, 3.0, 5.0, 7.0]);
    assert!(c["only_in_a"].as_array().unwrap().is_empty() && c["only_in_b"].as_array().unwrap().is_empty(), "{c}");
    let circle = compare("<rect width='10' height='10'/>", "<path d='M0,0h12v10h-12z'/>");
    assert_eq!(distances(&circle), [2.0]);
    // With one more path in the group the others are still compared, matched by their position in the file.
    let more = format!("{}{}<g id='g'>{}{}</g>", square(0), square(20), square(41), square(70));
    let c = compare(&a, &more);
    assert_eq!(distances(&c), [0.0, 0.0, 1.0]);
    assert_eq!((c["only_in_a"][0].as_str(), c["only_in_b"].as_array().unwrap().len()), (Some("p"), 1), "{c}");
}

#[test]
fn render_and_preview_write_pictures() {
    let dir = tempfile::tempdir().unwrap();
    let png = dir.path().join("logo.png");
    expect_code(0, &["render", "samples/logo.svg", "-o", png.to_str().unwrap(), "--width", "300"]);
    assert_eq!(pathwarp_raster::decode_png(&fs::read(png).unwrap()).unwrap().width(), 300);
    let preview = dir.path().join("p.png");
    expect_code(
        0,
        &[
            "shaper",
            "samples/logo.svg",
            "--shaper",
            "samples/cages.svg#flag",
            "-o",
            "-",
            "--preview",
            preview.to_str().unwrap(),
        ],
    );
    assert!(pathwarp_raster::decode_png(&fs::read(preview).unwrap()).unwrap().width() > 600);
}

/// A gallery of a curve has nodes and handles over each of its cells, and a preview is large enough to show them.
#[test]
fn pictures_show_nodes() {
    let dir = tempfile::tempdir().unwrap();
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 90 60'><path d='M9,9C40,0 60,20 80,50H9Z'/></svg>";
    let run = |args: &[&str]| {
        let out = pathwarp_in(dir.path(), args, svg.as_bytes());
        assert_eq!(out.status.code(), Some(0), "{args:?}: {}", text(&out.stderr));
        out.stdout
    };
    run(&["warp", "-", "--style", "flag", "-o", "o.svg", "--preview", "p.png", "--show-nodes"]);
    let png = pathwarp_raster::decode_png(&fs::read(dir.path().join("p.png")).unwrap()).unwrap();
    assert!(png.width() > 2800, "{}", png.width());
    // Each of the sixteen cells has lines, knobs and nodes.
    let paths = |sheet: &[u8]| text(sheet).matches("<path").count();
    let [plain, shown] = [&["gallery", "-"][..], &["gallery", "-", "--show-nodes"]].map(|args| paths(&run(args)));
    assert_eq!(shown - plain, 3 * 16);
}

/// The vertices of the mesh of a disc on a cylinder lie on the cylinder and, seen by the eye, inside the disc.
#[test]
fn artwork_on_a_mug_is_written_as_a_mesh() {
    let dir = tempfile::tempdir().unwrap();
    let disc = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><circle id='disc' cx='50' cy='50' r='30'/></svg>";
    let args = [
        "anamorph",
        "--distance",
        "400",
        "--onto",
        "cylinder:radius=40",
        "--tolerance",
        "0.01",
        "--mesh",
        "m.obj",
        "--curves",
        "c.obj",
        "-o",
        "o.svg",
    ];
    let out = pathwarp_in(dir.path(), &args, disc.as_bytes());
    assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
    let obj = fs::read_to_string(dir.path().join("m.obj")).unwrap();
    assert!(obj.contains("o disc") && obj.lines().filter(|l| l.starts_with("f ")).count() > 100);
    let vertices: Vec<Vec<f64>> = obj
        .lines()
        .filter_map(|l| l.strip_prefix("v "))
        .map(|l| l.split(' ').map(|w| w.parse().unwrap()).collect())
        .collect();
    for v in &vertices {
        // The axis is vertical through x = 50, one radius behind the drawing (z points to the viewer).
        assert!(((v[0] - 50.0).hypot(v[2] + 40.0) - 40.0).abs() < 1e-3, "{v:?}");
        // The eye, at 50,50 and 400 in front, sees the vertex inside the disc.
        let k = 400.0 / (400.0 - v[2]);
        assert!(((v[0] - 50.0) * k).hypot((v[1] + 50.0) * k) < 30.0 + 0.02, "{v:?}");
    }
    assert!(fs::read_to_string(dir.path().join("c.obj")).unwrap().lines().any(|l| l.starts_with("l ")));
    let plane = pathwarp_in(dir.path(), &["anamorph", "--mesh", "m.obj"], disc.as_bytes());
    assert_eq!(plane.status.code(), Some(2), "{}", text(&plane.stderr));
}

#[test]
fn a_recipes_values_are_overridden_on_the_command_line() {
    let dir = tempfile::tempdir().unwrap();
    let run = |args: &[&str], code: i32| {
        let out = pathwarp_in(dir.path(), args, SQUARE.as_bytes());
        assert_eq!(out.status.code(), Some(code), "{args:?}: {}", text(&out.stderr));
        (out.stdout, text(&out.stderr))
    };
    let chain = ["warp", "--style", "flag", "--bend", "40%", "-q", "+", "affine", "--rotate", "10"];
    run(&[&chain[..], &["--write-recipe", "r.toml"]].concat(), 0);
    let bent = |bend: &str, turn: &str| {
        run(&["warp", "--style", "flag", "--bend", bend, "-q", "+", "affine", "--rotate", turn], 0).0
    };
    assert_eq!(run(&["run", "r.toml", "-q"], 0).0, bent("40%", "10"));
    assert_eq!(run(&["run", "r.toml", "-q", "--bend", "-10%"], 0).0, bent("-10%", "10"));
    assert_eq!(run(&["run", "r.toml", "-", "--bend=10%", "--rotate", "-30", "-q"], 0).0, bent("10%", "-30"));
    assert!(run(&["run", "r.toml", "--shaper", "x.svg"], 2).1.contains("no step of the recipe has --shaper"));
    run(&["warp", "--style", "flag", "+", "warp", "--style", "arc", "--write-recipe", "two.toml", "-q"], 0);
    assert!(run(&["run", "two.toml", "--bend", "10%"], 2).1.contains("2 steps"));
    // A flag.
    let cage = sample("cages.svg").display().to_string() + "#flag";
    run(&["shaper", "--shaper", &cage, "--write-recipe", "cage.toml", "-q"], 0);
    let mirrored = run(&["shaper", "--shaper", &cage, "--reverse-shaper", "-q"], 0).0;
    assert_eq!(run(&["run", "cage.toml", "--reverse-shaper", "-q"], 0).0, mirrored);
}

#[test]
fn list_prints_json_and_man_prints_one_command() {
    let (list, _) = expect_code(0, &["list", "--json"]);
    let list: Value = serde_json::from_str(&list).unwrap();
    let (registry, all) = (pathwarp::deform::Registry::builtin(), list["deformations"].as_array().unwrap().clone());
    assert_eq!(all.len(), registry.entries().len());
    for (e, shown) in registry.entries().iter().zip(all) {
        assert_eq!(shown["name"], e.info().name);
        assert_eq!(shown["parameters"].as_array().unwrap().len(), e.info().params.len());
    }
    let (man, _) = expect_code(0, &["man", "warp"]);
    assert!(man.contains("pathwarp-warp") && man.contains("bend") && !man.contains("anamorph"), "{man}");
    let dir = tempfile::tempdir().unwrap();
    let pages = dir.path().join("man/man1");
    expect_code(0, &["man", "--out-dir", pages.to_str().unwrap()]);
    assert_eq!(fs::read_to_string(pages.join("pathwarp-warp.1")).unwrap(), man);
    let others = ["run", "render", "man"].iter().all(|name| pages.join(format!("pathwarp-{name}.1")).exists());
    assert!(
        others && fs::read_dir(&pages).unwrap().count() > registry.entries().len() && pages.join("pathwarp.1").exists()
    );
    let (_, said) = expect_code(2, &["man", "wrap"]);
    assert!(said.contains("did you mean `warp`"), "{said}");
}

#[test]
fn pages_of_different_proportions_are_compared_by_their_paths() {
    let dir = tempfile::tempdir().unwrap();
    std::fs::write(dir.path().join("a.svg"), SQUARE).unwrap();
    let wide = SQUARE.replace("viewBox='0 0 100 100'", "viewBox='0 0 200 100'").replace("M0,0H100", "M0,3H100");
    std::fs::write(dir.path().join("b.svg"), wide).unwrap();
    let out = pathwarp_in(dir.path(), &["compare", "a.svg", "b.svg"], b"");
    let said = text(&out.stdout);
    assert!(out.status.success() && said.contains("largest distance: 3.000000"), "{said}{}", text(&out.stderr));
    assert!(said.contains("not compared"), "{said}");
    let out = pathwarp_in(dir.path(), &["compare", "a.svg", "b.svg", "--json", "--max-pixels", "0.5"], b"");
    let json: Value = serde_json::from_slice(&out.stdout).unwrap();
    assert!(json["pixels"].is_null() && out.status.code() == Some(1), "{json}");
}
