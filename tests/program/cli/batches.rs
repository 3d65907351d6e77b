//! Several inputs: one bad file does not stop the others, results appear one by one, folders and patterns, dry runs.

use super::common::{CAGE, SQUARE, files_below, text};
use crate::support::events::Pipe;
use crate::support::{pathwarp_in, sample, start_in};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;

const WARP: [&str; 3] = ["warp", "--style", "flag"];
const OUT: [&str; 2] = ["--out-dir", "out"];

fn run(folder: &Path, options: &[&str], inputs: &[&str]) -> (Output, String) {
    let to = if options.contains(&"--out-dir") { &[][..] } else { &OUT };
    let out = pathwarp_in(folder, &[&WARP, to, options, inputs].concat(), b"");
    let said = text(&out.stderr);
    (out, said)
}

/// Two good drawings around three bad ones: not XML, missing, and flat.
fn mixed(folder: &Path) -> [&'static str; 5] {
    fs::write(folder.join("a.svg"), SQUARE).unwrap();
    fs::write(folder.join("broken.svg"), "<svg").unwrap();
    fs::write(folder.join("flat.svg"), SQUARE.replace("M0,0H100V100H0Z", "M0,50H100")).unwrap();
    fs::write(folder.join("z.svg"), SQUARE).unwrap();
    ["a.svg", "broken.svg", "missing.svg", "flat.svg", "z.svg"]
}

#[test]
fn bad_files_do_not_stop_a_batch() {
    let dir = tempfile::tempdir().unwrap();
    let inputs = mixed(dir.path());
    let (out, said) = run(dir.path(), &["--report", "r.json", "--jobs", "2"], &inputs);
    assert_eq!(out.status.code(), Some(1), "{said}");
    let errors: Vec<&str> = said.lines().filter(|l| l.starts_with("error: ")).collect();
    // In the order of the inputs, at the end, with a summary.
    for (error, part) in errors.iter().zip(["broken.svg", "missing.svg", "flat.svg", "3 of 5 inputs failed"]) {
        assert!(error.contains(part), "{part} not in {error}");
    }
    assert_eq!(errors.len(), 4, "{said}");
    assert!(said.ends_with(&(errors.join("\n") + "\n")), "{said}");
    assert_eq!(files_below(&dir.path().join("out")), ["a.svg", "z.svg"]);

    let report: Value = serde_json::from_slice(&fs::read(dir.path().join("r.json")).unwrap()).unwrap();
    let rows = report["inputs"].as_array().unwrap();
    assert_eq!(rows.iter().map(|r| r["file"].as_str().unwrap()).collect::<Vec<_>>(), inputs);
    for (row, input) in rows.iter().zip(inputs) {
        let failed = !matches!(input, "a.svg" | "z.svg");
        assert_eq!(row["error"].is_string(), failed, "{row}");
        assert_eq!(row["output"].is_null(), failed, "{row}");
        assert_eq!(row["shapes"].as_array().unwrap().is_empty(), failed, "{row}");
    }
    assert_eq!([&report["totals"]["inputs"], &report["totals"]["failed"]], [5, 3]);

    // The good files give the results that they give alone, on their pages.
    let alone = pathwarp_in(dir.path(), &["warp", "--style", "flag", "--fit", "none", "a.svg"], b"");
    assert_eq!(alone.stdout, fs::read(dir.path().join("out/a.svg")).unwrap());
}

#[test]
fn on_error_stop_writes_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let inputs = mixed(dir.path());
    let (out, said) = run(dir.path(), &["--on-error", "stop", "--report", "r.json"], &inputs);
    assert_eq!(out.status.code(), Some(3), "{said}");
    assert!(said.contains("broken.svg") && !said.contains("inputs failed"), "{said}");
    assert_eq!(files_below(dir.path()), ["a.svg", "broken.svg", "flat.svg", "z.svg"]);
    assert!(!dir.path().join("out").exists());
    // Without a bad file, all are written.
    let (out, said) = run(dir.path(), &["--on-error", "stop"], &["a.svg", "z.svg"]);
    assert_eq!(out.status.code(), Some(0), "{said}");
    assert_eq!(files_below(&dir.path().join("out")), ["a.svg", "z.svg"]);
}

#[test]
fn an_error_in_the_recipe_ends_a_batch_at_once() {
    let dir = tempfile::tempdir().unwrap();
    let inputs = mixed(dir.path());
    for (args, code) in [
        (["shaper", "--shaper", "no-such.svg#cage"], 3),
        (["shaper", "--bottom", "7"], 2),
        (["warp", "--style", "wobble"], 2),
        (["affine", "--rotate", "30 parsecs"], 2),
    ] {
        let out = pathwarp_in(dir.path(), &[&args[..], &["--out-dir", "out"], &inputs].concat(), b"");
        let said = text(&out.stderr);
        assert_eq!(out.status.code(), Some(code), "{args:?}: {said}");
        assert_eq!(said.lines().filter(|l| l.starts_with("error: ")).count(), 1, "{args:?}: {said}");
        assert!(!dir.path().join("out").exists(), "{args:?}");
    }
}

#[test]
fn skip_keeps_the_shape_and_leaves_unreadable_files_out() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("a.svg"), SQUARE).unwrap();
    fs::write(dir.path().join("broken.svg"), "<svg").unwrap();
    let beyond = ["shaper", "--shaper", CAGE, "--base", "10,40 20,40 17,35 13,35", "--out-dir", "out"];
    let both = ["a.svg", "broken.svg"];
    let strict = pathwarp_in(dir.path(), &[&beyond[..], &both].concat(), b"");
    assert_eq!(strict.status.code(), Some(1));
    assert!(text(&strict.stderr).contains("2 of 2 inputs failed; nothing was written"), "{}", text(&strict.stderr));
    let skipping = pathwarp_in(dir.path(), &[&beyond[..], &["--on-error", "skip"], &both].concat(), b"");
    let said = text(&skipping.stderr);
    assert_eq!(skipping.status.code(), Some(1), "{said}");
    assert!(said.contains("s is not warped") && said.contains("1 of 2 inputs failed"), "{said}");
    assert_eq!(files_below(&dir.path().join("out")), ["a.svg"]);
}

#[test]
fn page_warnings_of_a_batch_are_one_line() {
    let dir = tempfile::tempdir().unwrap();
    for i in 0..20 {
        fs::write(dir.path().join(format!("{i:02}.svg")), SQUARE).unwrap();
    }
    let args = ["affine", "--move-x", "30", "-r", ".", "--out-dir", "out", "--report", "r.json"];
    let out = pathwarp_in(dir.path(), &args, b"");
    let said = text(&out.stderr);
    assert_eq!((out.status.code(), said.lines().count()), (Some(0), 1), "{said}");
    assert!(said.contains("20 of 20 inputs") && said.contains("30 %") && said.contains("--fit grow"), "{said}");
    let report: Value = serde_json::from_slice(&fs::read(dir.path().join("r.json")).unwrap()).unwrap();
    assert!(report["inputs"].as_array().unwrap().iter().all(|i| i["warnings"].as_array().unwrap().len() == 1));
}

/// Makes a folder with drawings, one of them in a folder below, and with other files.
fn tree(folder: &Path) {
    fs::create_dir_all(folder.join("art/sub/.hidden")).unwrap();
    for file in ["art/b.svg", "art/a.svg", "art/sub/a.svg", "art/sub/.hidden/c.svg", "art/.d.svg"] {
        fs::write(folder.join(file), SQUARE).unwrap();
    }
    fs::write(folder.join("art/notes.txt"), "no drawing").unwrap();
}

#[test]
fn folders_are_searched_and_repeated() {
    let dir = tempfile::tempdir().unwrap();
    tree(dir.path());
    let (out, said) = run(dir.path(), &[], &["art"]);
    assert_eq!(out.status.code(), Some(3));
    assert!(said.contains("-r"), "{said}");
    for _ in 0..2 {
        // The results of the first run are not inputs of the second.
        let (out, said) = run(dir.path(), &["--out-dir", "art/out", "-r"], &["art"]);
        assert_eq!(out.status.code(), Some(0), "{said}");
        assert_eq!(files_below(&dir.path().join("art/out")), ["a.svg", "b.svg", "sub/a.svg"]);
    }
    let (out, said) =
        run(dir.path(), &["--out-dir", "named/{stem}-flag.svg", "--recursive"], &["art/sub", "art/b.svg"]);
    assert_eq!(out.status.code(), Some(0), "{said}");
    assert_eq!(files_below(&dir.path().join("named")), ["a-flag.svg", "b-flag.svg"]);
    let stems =
        ["warp", "--style", "flag", "-o", "{stem}.warped.svg", "--preview", "{stem}.png", "art/a.svg", "art/b.svg"];
    let out = pathwarp_in(dir.path(), &stems, b"");
    assert_eq!(out.status.code(), Some(0), "{}", text(&out.stderr));
    for file in ["a.warped.svg", "b.warped.svg", "a.png", "b.png"] {
        assert!(dir.path().join(file).is_file(), "{file}");
    }
    fs::create_dir(dir.path().join("empty")).unwrap();
    let (out, said) = run(dir.path(), &["-r"], &["empty"]);
    assert_eq!(out.status.code(), Some(3));
    assert!(said.contains("holds no SVG files"), "{said}");
}

#[test]
fn a_dry_run_lists_the_outputs_and_writes_none() {
    let dir = tempfile::tempdir().unwrap();
    tree(dir.path());
    let before = files_below(dir.path());
    let (out, said) = run(dir.path(), &["-r", "--dry-run", "--report", "r.json"], &["art"]);
    assert_eq!(out.status.code(), Some(0), "{said}");
    let lines = ["art/a.svg -> out/a.svg", "art/b.svg -> out/b.svg", "art/sub/a.svg -> out/sub/a.svg"];
    assert_eq!(text(&out.stdout).lines().collect::<Vec<_>>(), lines);
    assert_eq!(files_below(dir.path()), before);
    assert!(!dir.path().join("out").exists());
}

/// Ctrl-C and SIGTERM leave whole, finished files and no temporary ones.
#[cfg(unix)]
#[test]
fn an_interrupted_batch_leaves_whole_files_only() {
    const FILES: usize = 100;
    for signal in ["INT", "TERM"] {
        let dir = tempfile::tempdir().unwrap();
        fs::create_dir(dir.path().join("art")).unwrap();
        let art: Vec<String> = (0..FILES).map(|i| format!("art/{i:04}.svg")).collect();
        // The batch waits at its last drawing, which nobody writes.
        let (last, others) = art.split_last().unwrap();
        let pipe = Pipe::new(dir.path().join(last));
        for file in others {
            fs::copy(sample("badge.svg"), dir.path().join(file)).unwrap();
        }
        let mut args = [&WARP[..], &OUT, &["-q", "--report", "r.json", "--jobs", "2"]].concat();
        args.extend(art.iter().map(String::as_str));
        let child = start_in(dir.path(), &args);
        let _held = pipe.is_read("the batch comes to its last drawing");
        let kill = std::process::Command::new("kill").args([format!("-{signal}"), child.id().to_string()]).status();
        assert!(kill.unwrap().success());
        let end = child.wait_with_output().unwrap();
        let said = text(&end.stderr);
        assert_eq!(end.status.code(), Some(130), "{signal}: {said}");
        let out = dir.path().join("out");
        let left = files_below(&out);
        assert!(!left.is_empty() && left.len() < FILES, "{signal}: {} of {FILES}", left.len());
        let written =
            if left.len() == 1 { "result of 1 input is" } else { &format!("results of {} inputs are", left.len()) };
        assert!(said.contains(&format!("interrupted; the {written} written")), "{said}");
        assert!(!dir.path().join("r.json").exists());
        let whole =
            pathwarp_in(dir.path(), &["warp", "--style", "flag", "--fit", "none", "art/0000.svg", "-q"], b"").stdout;
        for file in &left {
            assert!(!file.contains(".pathwarp-"), "{signal} leaves {file}");
            assert!(fs::read(out.join(file)).unwrap() == whole, "{signal}: {file} is not whole");
        }
    }
}
