//! The browser, for tests of the editor's page and of drawings as other programs read them.

use crate::support::root;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use pathwarp_raster::{Pixmap, decode_png};
use serde_json::{Value, json};
use std::io::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

fn has_chromium() -> bool {
    let names = ["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"];
    names.iter().any(|name| Path::new("/usr/bin").join(name).exists())
}

/// Returns `true` if Firefox is where the page's tests look for it.
pub fn has_firefox() -> bool {
    ["/usr/bin/firefox-esr", "/usr/bin/firefox"].into_iter().any(|b| Path::new(b).exists())
}

/// Names a tool that tests of the page need and that is missing.
pub fn missing() -> Option<&'static str> {
    let is_there = |program: &str| Command::new(program).arg("--version").output().is_ok_and(|o| o.status.success());
    let modules = root().join("crates/pathwarp-editor/web/node_modules");
    if !is_there("node") {
        Some("node")
    } else if !["playwright-core", "ws", "axe-core"].iter().all(|name| modules.join(name).is_dir()) {
        Some("playwright-core, ws and axe-core (npm ci in crates/pathwarp-editor/web)")
    } else if !has_chromium() {
        Some("Chromium")
    } else {
        None
    }
}

/// Returns the picture that Chromium shows of a page of this size in px. The script restarts Chromium if it takes no picture.
pub fn shown(page: &Path, size: [usize; 2]) -> Pixmap {
    shown_with(page, size, &[])
}

/// Returns the picture that Chromium shows of a page, with variables of the environment.
pub fn shown_with(page: &Path, [width, height]: [usize; 2], environment: &[(&str, &str)]) -> Pixmap {
    let mut node = Command::new("node");
    node.envs(environment.iter().copied());
    node.arg(root().join("crates/xtask/src/browser/pages.mjs")).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut node = node.spawn().unwrap();
    let asked = json!({ "file": page, "size": [width, height], "scale": 1 });
    writeln!(node.stdin.take().unwrap(), "{asked}").unwrap();
    let answer: Value = serde_json::from_slice(&node.wait_with_output().unwrap().stdout).unwrap();
    let png = answer["png"].as_str().unwrap_or_else(|| panic!("{}: {answer}", page.display()));
    decode_png(&STANDARD.decode(png).unwrap()).unwrap()
}
