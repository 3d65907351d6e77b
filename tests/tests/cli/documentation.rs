//! Every command line in help and in the cookbook runs, and help knows every deformation.

use super::common::text;
use crate::support::{expect_code, pathwarp_in, root, words};
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

#[test]
fn every_command_of_the_cookbook_runs() {
    let page = fs::read_to_string(root().join("docs/cookbook.md")).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let commands: Vec<&str> = page.lines().filter_map(|l| l.strip_prefix("pathwarp ")).collect();
    assert!(commands.len() >= 15, "{commands:?}");
    for command in commands {
        let messages = run_into(dir.path(), command);
        assert!(messages.is_empty(), "{command}: {messages}");
    }
}

/// Runs a command line of the documentation, which may be a pipe, with its output in `dir`. Returns its messages.
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
