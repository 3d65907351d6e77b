//! The browser, for tests of the editor's page and of how others read drawings.

use crate::support::root;
use std::path::Path;
use std::process::Command;

/// Chromium, if it is installed.
pub fn chromium() -> Option<&'static str> {
    let browsers = [
        "/usr/bin/chromium-headless-shell",
        "/usr/bin/chromium",
        "/usr/bin/chromium-browser",
        "/usr/bin/google-chrome",
    ];
    browsers.into_iter().find(|b| Path::new(b).exists())
}

/// Whether Firefox is where the page's tests look for it.
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
    } else if chromium().is_none() {
        Some("Chromium")
    } else {
        None
    }
}
