//! Features: `cargo test --workspace` builds every crate once, although some tests build a program on the way.

use crate::support;
use std::collections::BTreeSet;
use std::process::Command;

/// Every package with its features, as cargo resolves them for a selection of packages.
fn resolved(selection: &[&str]) -> BTreeSet<String> {
    let mut tree = Command::new(env!("CARGO"));
    tree.args(["tree", "--locked", "--prefix", "none", "--format", "{p} [{f}]"]).args(selection);
    let out = tree.current_dir(support::root()).output().unwrap();
    assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
    let text = String::from_utf8(out.stdout).unwrap();
    text.lines().map(|l| l.trim_end_matches(" (*)").to_owned()).filter(|l| !l.is_empty()).collect()
}

#[test]
fn programs_under_test_have_the_features_of_the_workspace() {
    let workspace = resolved(&["--workspace", "--edges", "normal,build,dev"]);
    for program in ["pathwarp-cli", "pathwarp-ripple"] {
        let alone = resolved(&["--package", program, "--edges", "normal,build"]);
        let again: Vec<&String> = alone.difference(&workspace).collect();
        assert!(
            alone.len() > 100 && again.is_empty(),
            "built again for {program}, as other crates ask for more features: {again:#?}"
        );
    }
}
