//! The editor's page in Chromium and Firefox: the tests in `crates/pathwarp-editor/web/tests`.

use crate::browser;
use crate::support::{pathwarp_program, root};
use std::process::Command;

#[test]
fn the_page_works_in_chromium() {
    the_page_works("chromium", &[]);
}

/// The page's tasks, from beginning to end.
#[test]
fn the_jobs_are_done_in_firefox() {
    if browser::has_firefox() {
        the_page_works("firefox", &["job_"]);
    } else {
        crate::support::skipped("the editor's jobs are not tested in Firefox");
    }
}

/// Runs the tests of the page whose names contain one of these words, or all.
fn the_page_works(browser: &str, tests: &[&str]) {
    let web = root().join("crates/pathwarp-editor/web");
    if let Some(what) = browser::missing() {
        crate::support::skipped(format_args!("the editor's page is not tested without {what}"));
        return;
    }
    let mut node = Command::new("node");
    node.arg("tests/run.mjs").args(tests).current_dir(&web).env("PATHWARP", pathwarp_program());
    let out = node.env("TESTED_IN", browser).output().unwrap();
    let said = String::from_utf8_lossy(&out.stdout);
    println!("{said}");
    said.lines().filter_map(|l| l.trim().strip_prefix("skipped: ")).for_each(crate::support::skipped);
    assert!(out.status.success(), "{said}{}", String::from_utf8_lossy(&out.stderr));
}
