//! Features: `cargo test --workspace` builds every crate once, although some tests build a program on the way.

use crate::support;
use std::collections::BTreeSet;
use std::process::Command;

/// Every package of the workspace and below it with its features, as cargo resolves them for these kinds of dependencies.
fn resolved(kinds: &str) -> BTreeSet<String> {
    let mut tree = Command::new(env!("CARGO"));
    tree.args(["tree", "--locked", "--workspace", "--prefix", "none", "--format", "{p} [{f}]", "--edges", kinds]);
    let out = tree.current_dir(support::root()).output().unwrap();
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let text = String::from_utf8(out.stdout).unwrap();
    text.lines().map(|l| l.trim_end_matches(" (*)").to_owned()).filter(|l| !l.is_empty()).collect()
}

/// Programs are built with the features that all crates ask for together, tests with those that tests ask for as well.
#[test]
fn tests_ask_for_no_more_features_than_programs() {
    let (programs, tests) = (resolved("normal,build"), resolved("normal,build,dev"));
    let again: Vec<&String> = programs.difference(&tests).collect();
    assert!(programs.len() > 100 && again.is_empty(), "built twice, as tests ask for more features: {again:#?}");
}
