//! Every command line in help runs, and help covers every deformation.

use crate::support::{expect_code, words_into};
use std::fs;
use std::path::Path;

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

/// Runs a command line of the documentation with its output in `dir`.
fn run_into(dir: &Path, command: &str) {
    expect_code(0, &words_into(dir, command));
    // The result is a drawing, or a photograph if the source is one.
    let out = dir.join(if command.ends_with(" -o out.jpg") { "out.jpg" } else { "out.svg" });
    let result = fs::read(&out).unwrap();
    let is_drawing = String::from_utf8_lossy(&result).contains("<svg");
    assert!(is_drawing || result.starts_with(b"\xff\xd8") && out.ends_with("out.jpg"), "{command}");
    fs::remove_file(out).unwrap();
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
