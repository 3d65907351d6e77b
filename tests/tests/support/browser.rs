//! The browser for tests of the editor's page.

use super::root;
use std::path::Path;
use std::process::Command;

/// Names a tool that tests in a browser need and that is missing.
pub fn missing() -> Option<&'static str> {
    let is_there = |program: &str| Command::new(program).arg("--version").output().is_ok_and(|o| o.status.success());
    let browsers = [
        "/usr/bin/chromium-headless-shell",
        "/usr/bin/chromium",
        "/usr/bin/chromium-browser",
        "/usr/bin/google-chrome",
    ];
    let modules = root().join("crates/pathwarp-editor/web/node_modules");
    if !is_there("node") {
        Some("node")
    } else if !["playwright-core", "ws", "axe-core"].iter().all(|name| modules.join(name).is_dir()) {
        Some("playwright-core, ws and axe-core (npm ci in crates/pathwarp-editor/web)")
    } else if !browsers.iter().any(|b| Path::new(b).exists()) {
        Some("Chromium")
    } else {
        None
    }
}
