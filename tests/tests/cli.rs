//! The program from outside: exit codes, files, streams, messages.

mod support;

use serde_json::Value;
use std::fs;
use std::path::Path;
use support::{artwork, expect_code, pathwarp_in, root, sample, words};

const CAGE: &str = "M 10,90 C 40,110 60,70 95,85 C 85,60 105,40 90,15 C 60,-5 40,35 5,10 C 15,40 0,60 10,90 Z";
const SQUARE: &str =
    "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path id='s' d='M0,0H100V100H0Z'/></svg>";

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn every_example_in_help_runs() {
    let registry = pathwarp::deform::Registry::builtin();
    let dir = tempfile::tempdir().unwrap();
    for e in registry.entries() {
        for example in e.info().examples {
            run_into(dir.path(), example.command);
        }
    }
}

#[test]
fn every_job_of_the_cookbook_runs() {
    let page = fs::read_to_string(root().join("docs/cookbook.md")).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let commands: Vec<&str> = page.lines().filter_map(|l| l.strip_prefix("pathwarp ")).collect();
    assert!(commands.len() >= 15, "{commands:?}");
    for command in commands {
        let messages = run_into(dir.path(), command);
        assert!(messages.is_empty(), "{command}: {messages}");
    }
}

/// Runs a command line of the documentation, perhaps a pipe, what it writes going to `dir`; gives its messages.
fn run_into(dir: &Path, command: &str) -> String {
    let inside = |w: &String| {
        if w.starts_with("out") && w.contains('.') { dir.join(w).display().to_string() } else { w.clone() }
    };
    let (mut drawing, mut messages) = (Vec::new(), String::new());
    for stage in words(command).split(|w| w == "|") {
        let args: Vec<String> = stage.iter().filter(|w| *w != "pathwarp").map(inside).collect();
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        let out = pathwarp_in(&root(), &args, &drawing);
        assert_eq!(out.status.code(), Some(0), "{command}: {}", text(&out.stderr));
        messages += &text(&out.stderr);
        drawing = out.stdout;
    }
    let svg = fs::read_to_string(dir.join("out.svg")).unwrap();
    assert!(svg.contains("<svg"), "{command}");
    fs::remove_file(dir.join("out.svg")).unwrap();
    messages
}

#[test]
fn help_list_completions_and_manual_know_every_deformation() {
    let (list, _) = expect_code(0, &["list"]);
    let (help, _) = expect_code(0, &["--help"]);
    let (man, _) = expect_code(0, &["man"]);
    let (bash, _) = expect_code(0, &["completions", "bash"]);
    for e in pathwarp::deform::Registry::builtin().entries() {
        let info = e.info();
        for (what, page) in [("list", &list), ("help", &help), ("man", &man), ("completions", &bash)] {
            assert!(page.contains(info.name), "{} is not in {what}", info.name);
        }
        let (own, _) = expect_code(0, &["help", info.name]);
        assert!(
            own.contains("Examples:") && info.params.iter().all(|p| own.contains(&format!("--{}", p.name))),
            "{own}"
        );
    }
}

#[test]
fn standard_input_to_standard_output() {
    let dir = tempfile::tempdir().unwrap();
    for args in [&["shaper", "--shaper", CAGE][..], &["shaper", "--shaper", CAGE, "-", "-o", "-"]] {
        let out = pathwarp_in(dir.path(), args, SQUARE.as_bytes());
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
        assert!(text(&out.stdout).contains("id='s'"));
        assert!(out.stderr.is_empty(), "silent on success: {}", text(&out.stderr));
    }
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
}

#[test]
fn a_drawing_is_not_written_under_a_pictures_name() {
    let dir = tempfile::tempdir().unwrap();
    let out = pathwarp_in(dir.path(), &["affine", "-o", "out.png", "--rotate", "30"], SQUARE.as_bytes());
    assert_eq!(out.status.code(), Some(2), "{}", text(&out.stderr));
    assert!(text(&out.stderr).contains("out.png: a drawing is written as SVG"), "{}", text(&out.stderr));
    assert!(!dir.path().join("out.png").exists());
}

#[test]
fn artwork_that_leaves_the_page_is_warned_of_once() {
    let dir = tempfile::tempdir().unwrap();
    let run = |options: &[&str]| {
        let mut args = vec!["affine", "--move-x", "30", "--move-y", "-8", "--report", "r.json"];
        args.extend(options);
        let out = pathwarp_in(dir.path(), &args, SQUARE.as_bytes());
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
        let report: Value = serde_json::from_slice(&fs::read(dir.path().join("r.json")).unwrap()).unwrap();
        (text(&out.stderr), report["inputs"][0]["warnings"].as_array().unwrap().clone())
    };
    let (said, told) = run(&[]);
    assert_eq!(said.lines().count(), 1, "{said}");
    for part in ["extends past the page by up to 30 units", "30 %; top, right", "--fit grow", "--fit page"] {
        assert!(said.contains(part) && told[0].as_str().unwrap().contains(part), "{part} not in {said}");
    }
    assert_eq!(told.len(), 1);
    let (said, told) = run(&["--quiet"]);
    assert!(said.is_empty() && told.len() == 1, "{said} {told:?}");
    for fit in ["grow", "page"] {
        let (said, told) = run(&["--fit", fit]);
        assert!(said.is_empty() && told.is_empty(), "{fit}: {said}");
    }
}

#[test]
fn wrong_usage_is_2_and_names_the_fault() {
    for (args, part) in [
        (&["wobble"][..], "wobble"),
        (&["shaper"], "--shaper"),
        (&["shaper", "--shaper", CAGE, "--tolerance", "-1"], "--tolerance"),
        (&["shaper", "--shaper", CAGE, "--tolerance", "nan"], "--tolerance"),
        (&["shaper", "--shaper", CAGE, "--bottom", "7"], "--bottom"),
        (&["shaper", "--shaper", CAGE, "--frame", "1,2,3"], "--frame"),
        (&["shaper", "--shaper", CAGE, "--strokes", "wide"], "--strokes"),
        (&["shaper", "--shaper", "--explain"], "--shaper"),
        (&["shaper", "--shaper", CAGE, "+", "list"], "list"),
        (&["list", "+", "affine"], "chains deformations"),
        (&["shaper", "--shaper", CAGE, "+", "affine", "--out", "b.svg"], "multiple times"),
        (&["shaper", "--shaper", CAGE, "+", "affine", "--into", "b.xcf"], "cannot be used with"),
        (&["shaper", "--shaper", CAGE, "+", "affine", "in.svg"], "in.svg"),
        (&["affine", "--matrix", "1,0,0,1,0"], "6 are wanted"),
        (&["affine", "--rotate", "30 parsecs"], "parsecs"),
    ] {
        let dir = tempfile::tempdir().unwrap();
        let mut all = args.to_vec();
        if args[0] != "list" && args[0] != "wobble" {
            all.splice(1..1, ["-o", "out.svg"]);
        }
        let out = pathwarp_in(dir.path(), &all, SQUARE.as_bytes());
        assert_eq!(out.status.code(), Some(2), "{args:?}: {}", text(&out.stderr));
        assert!(text(&out.stderr).contains(part), "{args:?}: {}", text(&out.stderr));
        assert!(!dir.path().join("out.svg").exists());
    }
}

#[test]
fn unreadable_input_is_3_and_names_the_place() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("latin1.svg"), b"<svg xmlns='http://www.w3.org/2000/svg'>\xe4</svg>").unwrap();
    fs::write(dir.path().join("broken.svg"), "<svg xmlns='http://www.w3.org/2000/svg'>\n<path").unwrap();
    fs::write(dir.path().join("empty.svg"), "").unwrap();
    fs::write(dir.path().join("ok.svg"), SQUARE).unwrap();
    fs::write(dir.path().join("points.json"), "[[1,2],[3]]").unwrap();
    for (input, shaper, part) in [
        ("missing.svg", CAGE, "missing.svg"),
        ("latin1.svg", CAGE, "UTF-8"),
        ("broken.svg", CAGE, "broken.svg"),
        ("empty.svg", CAGE, "empty.svg"),
        ("ok.svg", "no-such-file.svg#a", "no-such-file.svg"),
        ("ok.svg", "#nothing", "#nothing"),
        ("ok.svg", "points.json", "points.json"),
    ] {
        let out = pathwarp_in(dir.path(), &["shaper", input, "--shaper", shaper, "-o", "out.svg"], b"");
        assert_eq!(out.status.code(), Some(3), "{input} {shaper}: {}", text(&out.stderr));
        assert!(text(&out.stderr).contains(part), "{input} {shaper}: {}", text(&out.stderr));
        assert!(!dir.path().join("out.svg").exists());
    }
    // A file beside the artwork is named first, and the artwork not at all.
    fs::write(dir.path().join("style.toml"), "name = 7").unwrap();
    fs::write(dir.path().join("cage.svg"), "<svg").unwrap();
    for args in [
        ["warp", "--style", "missing.toml"],
        ["warp", "--style", "style.toml"],
        ["wordart", "--preset", "missing.json"],
        ["shaper", "--shaper", "missing.svg#a"],
        ["shaper", "--shaper", "cage.svg#a"],
    ] {
        let out = pathwarp_in(dir.path(), &[&args[..], &["ok.svg", "-o", "out.svg"]].concat(), b"");
        let (said, file) = (text(&out.stderr), args[2].split('#').next().unwrap());
        assert_eq!(out.status.code(), Some(3), "{args:?}: {said}");
        assert!(said.starts_with(&format!("error: {file}")) && !said.contains("ok.svg"), "{args:?}: {said}");
    }
}

#[test]
fn forbidden_geometry_is_4_and_leaves_the_old_file_alone() {
    let anchors = sample("anchors.svg").display().to_string();
    let horizon = "0,0 100,0 40,40 0,100";
    let dir = tempfile::tempdir().unwrap();
    let old = dir.path().join("out.svg");
    fs::write(&old, "precious").unwrap();
    for (args, parts) in [
        (vec!["--shaper", "M0,0 L10,0 L10,10 L0,10 L1,1"], vec!["not closed", "--shaper"]),
        (vec!["--shaper", "M0,0 L10,0 L10,10 Z"], vec!["3 anchors"]),
        (
            vec!["--shaper", CAGE, "--target", &(anchors.clone() + "#target4-collinear")],
            vec!["one line", "target4-collinear"],
        ),
        (vec!["--shaper", CAGE, "--base", "5,5 5,5"], vec!["coincide", "--base"]),
        (vec!["--shaper", CAGE, "--base", "10,40 20,40 17,35 13,35"], vec!["s hits infinity at"]),
        (vec!["--shaper", CAGE, "--target", horizon], vec!["infinity"]),
    ] {
        let mut all = vec!["shaper", "-", "-o", "out.svg"];
        all.extend(args.iter().copied());
        let out = pathwarp_in(dir.path(), &all, SQUARE.as_bytes());
        let said = text(&out.stderr);
        assert_eq!(out.status.code(), Some(4), "{args:?}: {said}");
        assert!(parts.iter().all(|p| said.contains(p)), "{args:?}: {said}");
        assert_eq!(fs::read_to_string(&old).unwrap(), "precious");
    }
}

/// Renaming a finished file over `/dev/null` would put a file in its place.
#[cfg(unix)]
#[test]
fn what_is_no_file_is_written_to_and_stays_what_it_is() {
    use std::os::unix::fs::FileTypeExt;
    let folder = tempfile::tempdir().unwrap();
    let (pipe, link, file) =
        (folder.path().join("pipe"), folder.path().join("link.svg"), folder.path().join("file.svg"));
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let reader = std::thread::spawn({
        let pipe = pipe.clone();
        move || fs::read(pipe).unwrap()
    });
    let warp = |to: &Path| {
        let (input, to) = (sample("icon.svg"), to.to_str().unwrap());
        let out = pathwarp_in(folder.path(), &["swirl", input.to_str().unwrap(), "-o", to], b"");
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
    };
    warp(&pipe);
    let piped = reader.join().unwrap();
    assert!(piped.starts_with(b"<"));
    assert!(fs::metadata(&pipe).unwrap().file_type().is_fifo());
    fs::write(&file, "old").unwrap();
    std::os::unix::fs::symlink(&file, &link).unwrap();
    warp(&link);
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read(&file).unwrap(), piped);
}

#[test]
fn artwork_as_flat_as_a_line_needs_a_base() {
    let dir = tempfile::tempdir().unwrap();
    let line = SQUARE.replace("M0,0H100V100H0Z", "M0,50H100");
    for args in [&["shaper", "--shaper", CAGE][..], &["projective", "--target", "0,0 10,0 10,10 0,10"]] {
        let out = pathwarp_in(dir.path(), args, line.as_bytes());
        assert_eq!(out.status.code(), Some(4));
        assert!(text(&out.stderr).contains("100 wide and 0 high"), "{}", text(&out.stderr));
        let with = pathwarp_in(dir.path(), &[args, &["--frame", "0,0,100,100"]].concat(), line.as_bytes());
        assert_eq!(with.status.code(), Some(0), "{}", text(&with.stderr));
    }
}

#[test]
fn a_shape_beyond_the_horizon_can_be_skipped() {
    let dir = tempfile::tempdir().unwrap();
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path id='near' d='M12,36 l4,0 0,3 z'/><path id='far' d='M0,0H100V100H0Z'/></svg>";
    let args = [
        "shaper",
        "-",
        "--shaper",
        CAGE,
        "--base",
        "10,40 20,40 17,35 13,35",
        "--on-error",
        "skip",
        "-o",
        "out.svg",
        "--report",
        "r.json",
    ];
    let out = pathwarp_in(dir.path(), &args, svg.as_bytes());
    assert_eq!(out.status.code(), Some(1), "{}", text(&out.stderr));
    let warped = fs::read_to_string(dir.path().join("out.svg")).unwrap();
    assert!(warped.contains("M0,0H100V100H0Z") && !warped.contains("M12,36"), "{warped}");
    let report: Value = serde_json::from_slice(&fs::read(dir.path().join("r.json")).unwrap()).unwrap();
    assert_eq!(report["inputs"][0]["skipped"][0]["id"], "far");
    assert_eq!(report["inputs"][0]["shapes"][0]["id"], "near");
}

#[test]
fn the_report_has_every_field() {
    let dir = tempfile::tempdir().unwrap();
    let (svg, json) = (dir.path().join("o.svg"), dir.path().join("r.json"));
    let [input, cage] = [sample("monogram.svg"), sample("cages.svg")].map(|p| p.display().to_string());
    let cage = cage + "#flag";
    expect_code(
        0,
        &["shaper", &input, "--shaper", &cage, "-o", svg.to_str().unwrap(), "--report", json.to_str().unwrap()],
    );
    let r: Value = serde_json::from_slice(&fs::read(json).unwrap()).unwrap();
    assert_eq!(r["tool"], "pathwarp");
    assert_eq!(r["steps"][0], "shaper");
    let file = &r["inputs"][0];
    let tolerance = file["tolerance"].as_f64().unwrap();
    let shapes = file["shapes"].as_array().unwrap();
    assert!(!shapes.is_empty());
    let mut sums = [0, 0];
    for s in shapes {
        assert!(s["max_error"].as_f64().unwrap() <= tolerance && s["certified"].is_boolean() && s["folds"] == 0);
        sums[0] += s["segments_in"].as_u64().unwrap();
        sums[1] += s["segments_out"].as_u64().unwrap();
    }
    assert_eq!(r["totals"]["shapes"].as_u64().unwrap() as usize, shapes.len());
    assert_eq!([&r["totals"]["segments_in"], &r["totals"]["segments_out"]].map(|v| v.as_u64().unwrap()), sums);
    assert!(r["totals"]["seconds"].as_f64().unwrap() > 0.0);
    assert_eq!(file["output"], svg.display().to_string());
}

#[test]
fn what_misses_the_tolerance_is_told_with_its_place() {
    // Three thousand waves across the drawing.
    let dir = tempfile::tempdir().unwrap();
    let run = |options: &[&str]| {
        let mut args = vec!["expr", "--x", "x", "--y", "y + 5*sin(200*x)", "--report", "r.json"];
        args.extend(options);
        let out = pathwarp_in(dir.path(), &args, SQUARE.as_bytes());
        let report: Value = serde_json::from_slice(&fs::read(dir.path().join("r.json")).unwrap()).unwrap();
        (out, report["inputs"][0].clone())
    };
    for options in [&["--tolerance", "0.001"][..], &["--tolerance", "0.001", "--certify", "--merge", "off"]] {
        let (out, r) = run(options);
        assert_eq!(out.status.code(), Some(1));
        assert!(text(&out.stderr).contains("misses the tolerance near"), "{}", text(&out.stderr));
        let s = &r["shapes"][0];
        assert!(s["max_error"].as_f64().unwrap() > 0.001 && s["assurance"] == "checked" && s["certified"] == false);
        let places = s["over_budget"].as_array().unwrap();
        assert!(!places.is_empty());
        // On the horizontal sides: the others are moved as they are.
        assert!(places.iter().all(|p| p[1] == 0.0 || p[1] == 100.0), "{places:?}");
    }
}

#[test]
fn folds_are_warned_of_and_counted() {
    let dir = tempfile::tempdir().unwrap();
    // A shaper whose top side runs back on itself.
    let twisted = "M0,100 L100,100 L100,0 C-150,0 250,0 0,0 Z";
    let out = pathwarp_in(dir.path(), &["shaper", "--shaper", twisted, "--report", "r.json"], SQUARE.as_bytes());
    assert_eq!(out.status.code(), Some(0));
    let said = text(&out.stderr);
    assert!(said.contains("s folds over near"), "{said}");
    let r: Value = serde_json::from_slice(&fs::read(dir.path().join("r.json")).unwrap()).unwrap();
    assert!(r["totals"]["folds"].as_u64().unwrap() > 0);
    assert!(r["inputs"][0]["warnings"][0].as_str().unwrap().contains("s folds over"));
    // A mirroring map is no fold.
    let mirrored = pathwarp_in(dir.path(), &["shaper", "--shaper", CAGE, "--reverse-shaper"], SQUARE.as_bytes());
    assert!(mirrored.stderr.is_empty(), "{}", text(&mirrored.stderr));
}

#[test]
fn several_inputs_go_to_a_folder_and_threads_change_nothing() {
    let inputs: Vec<String> = artwork().iter().map(|n| sample(n).display().to_string()).collect();
    let cage = sample("cages.svg").display().to_string() + "#flag";
    let run = |jobs: &str, dir: &Path| {
        let mut args: Vec<&str> =
            vec!["shaper", "--shaper", &cage, "--jobs", jobs, "--quiet", "--out-dir", dir.to_str().unwrap()];
        args.extend(inputs.iter().map(String::as_str));
        expect_code(0, &args);
    };
    let dir = tempfile::tempdir().unwrap();
    let (one, four) = (dir.path().join("one"), dir.path().join("four"));
    run("1", &one);
    run("4", &four);
    for name in artwork() {
        let bytes = fs::read(one.join(&name)).unwrap();
        assert!(!bytes.is_empty() && bytes == fs::read(four.join(&name)).unwrap(), "{name}");
    }
    let (_, said) = expect_code(2, &["shaper", &inputs[0], &inputs[1], "--shaper", &cage]);
    assert!(said.contains("--out-dir"), "{said}");
}

#[test]
fn guides_in_the_document_stay_and_are_no_artwork() {
    let (svg, _) = expect_code(
        0,
        &["shaper", "samples/paper-two-anchors.svg", "--base", "#Base", "--target", "#Target", "--shaper", "#Shaper"],
    );
    let source = fs::read_to_string(sample("paper-two-anchors.svg")).unwrap();
    for id in ["Base", "Target", "Shaper"] {
        let line = |s: &str| s.lines().find(|l| l.contains(&format!("id=\"{id}\""))).unwrap().to_owned();
        assert_eq!(line(&svg), line(&source));
    }
    assert_ne!(svg, source);
}

#[test]
fn explain_tells_the_corners() {
    let (_, said) =
        expect_code(0, &["shaper", "samples/grid.svg", "--shaper", "samples/cages.svg#arch", "--explain", "-o", "-"]);
    for part in ["bottom side of", "corners of", "base:", "target: none"] {
        assert!(said.contains(part), "{part} not in {said}");
    }
}

#[test]
fn chains_equal_their_parts_one_after_another() {
    let dir = tempfile::tempdir().unwrap();
    let run = |args: &[&str], input: &[u8]| {
        let out = pathwarp_in(dir.path(), args, input);
        assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
        out.stdout
    };
    let fine = ["--tolerance", "1e-4", "--precision", "8"];
    let perspective = ["projective", "--target", "0,100 100,95 80,10 15,0"];
    let bend = ["shaper", "--shaper", CAGE];
    let first = run(&[&perspective[..], &fine].concat(), SQUARE.as_bytes());
    let both = run(&[&bend[..], &fine].concat(), &first);
    let chained = run(&[&perspective[..], &fine, &["+"], &bend].concat(), SQUARE.as_bytes());
    // The common options may stand in any part.
    let last = run(&[&perspective[..], &["+"], &bend, &fine].concat(), SQUARE.as_bytes());
    assert!(last == chained);
    let apart =
        run(&[&perspective[..], &fine[..2], &["+"], &bend, &fine[2..], &["-o", "-"]].concat(), SQUARE.as_bytes());
    assert!(apart == chained);
    fs::write(dir.path().join("-in.svg"), SQUARE).unwrap();
    let named = [&perspective[..], &["--", "-in.svg", "+"], &bend, &fine, &["-o", "named.svg"]].concat();
    assert!(run(&named, b"").is_empty());
    assert!(fs::read(dir.path().join("named.svg")).unwrap() == chained);
    fs::write(dir.path().join("a.svg"), both).unwrap();
    fs::write(dir.path().join("b.svg"), chained).unwrap();
    let out = run(&["compare", "--json", "a.svg", "b.svg"], b"");
    let c: Value = serde_json::from_slice(&out).unwrap();
    assert!(c["max_distance"].as_f64().unwrap() < 3e-4, "{c}");
}

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
fn compare_tells_how_far_and_can_fail() {
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

#[test]
fn compare_counts_off_what_has_no_id() {
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
    // All on one line; numbers of other lengths move what follows, and a circle may have become a path.
    let a = format!("{}{}<g id='g'>{}<path id='p' d='M0,50h9'/></g>", square(0), square(20), square(40));
    let b = format!("{}{}<g id='g'>{}<path id='p' d='M0,57h9'/></g>", square(-100), square(23), square(45));
    let c = compare(&a, &b);
    assert_eq!(distances(&c), [100.0, 3.0, 5.0, 7.0]);
    assert!(c["only_in_a"].as_array().unwrap().is_empty() && c["only_in_b"].as_array().unwrap().is_empty(), "{c}");
    let circle = compare("<rect width='10' height='10'/>", "<path d='M0,0h12v10h-12z'/>");
    assert_eq!(distances(&circle), [2.0]);
    // One more in the group: the others are still compared; here the place in the file tells which is which.
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

/// A mesh of a disc on a cylinder: its vertices lie on the cylinder, and its area is the disc's, rolled back.
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
        // The axis is upright through x = 50, a radius behind the drawing (z points to the viewer).
        assert!(((v[0] - 50.0).hypot(v[2] + 40.0) - 40.0).abs() < 1e-3, "{v:?}");
        // The eye at (50, 50, 400 in front) sees the vertex inside the drawn disc.
        let k = 400.0 / (400.0 - v[2]);
        assert!(((v[0] - 50.0) * k).hypot((v[1] + 50.0) * k) < 30.0 + 0.02, "{v:?}");
    }
    assert!(fs::read_to_string(dir.path().join("c.obj")).unwrap().lines().any(|l| l.starts_with("l ")));
    let plane = pathwarp_in(dir.path(), &["anamorph", "--mesh", "m.obj"], disc.as_bytes());
    assert_eq!(plane.status.code(), Some(2), "{}", text(&plane.stderr));
}

#[test]
fn a_crate_of_one_file_adds_its_deformation() {
    let program = support::program("pathwarp-ripple", "pathwarp-ripple");
    let dir = tempfile::tempdir().unwrap();
    let run = |args: &[&str]| std::process::Command::new(&program).args(args).current_dir(root()).output().unwrap();
    assert!(text(&run(&["list"]).stdout).contains("rings on water"));
    let out = dir.path().join("o.svg");
    let done = run(&["ripple", "samples/grid.svg", "-o", out.to_str().unwrap()]);
    assert!(done.status.success(), "{}", text(&done.stderr));
    assert!(fs::read_to_string(out).unwrap().contains('C'), "straight lines have become curves");
    assert!(run(&["shaper", "samples/grid.svg", "--shaper", CAGE, "-o", "-"]).status.success());
}
