//! `pathwarp edit` in a headless Chromium: the tests of the page (`crates/pathwarp-editor/web/tests`) with the real program.

use crate::support::{browser, pathwarp_program, root};
use std::process::Command;

#[test]
fn the_page_works_in_a_browser() {
    let web = root().join("crates/pathwarp-editor/web");
    if let Some(what) = browser::missing() {
        crate::support::skipped(format_args!("the editor's page is not tested without {what}"));
        return;
    }
    let out = Command::new("node").arg("tests/run.mjs").current_dir(&web).env("PATHWARP", pathwarp_program()).output();
    let out = out.unwrap();
    let said = String::from_utf8_lossy(&out.stdout);
    println!("{said}");
    said.lines().filter_map(|l| l.trim().strip_prefix("skipped: ")).for_each(crate::support::skipped);
    assert!(out.status.success(), "{said}{}", String::from_utf8_lossy(&out.stderr));
}

#[test]
fn what_cannot_be_edited_is_said() {
    let out = crate::support::pathwarp(&["edit", "-"]);
    assert_eq!(out.status.code(), Some(2));
    let folder = tempfile::tempdir().unwrap();
    let bad = folder.path().join("bad.svg");
    std::fs::write(&bad, "<svg").unwrap();
    let out = crate::support::pathwarp(&["edit", "--no-open", bad.to_str().unwrap()]);
    assert_eq!(out.status.code(), Some(3));
    assert!(String::from_utf8_lossy(&out.stderr).contains("bad.svg"), "{out:?}");
    assert!(out.stdout.is_empty(), "the address is printed before the drawing is read");
}
