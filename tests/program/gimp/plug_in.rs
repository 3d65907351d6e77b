//! The plug-in for GIMP: installed and removed.

use crate::support::{expect_code, root};
use std::fs;
use std::process::{Command, Stdio};

#[test]
fn the_plug_in_is_installed_and_removed() {
    let dir = tempfile::tempdir().unwrap();
    let plug_ins = dir.path().join("plug-ins");
    let d = plug_ins.to_str().unwrap();
    let (said, _) = expect_code(0, &["install", "gimp", "--dir", d, "--dry-run"]);
    assert!(said.contains("would write") && !plug_ins.exists());
    expect_code(0, &["install", "gimp", "--dir", d]);
    let home = plug_ins.join("pathwarp-gimp");
    let script = fs::read(home.join("pathwarp-gimp.py")).unwrap();
    assert_eq!(script, fs::read(root().join("crates/pathwarp-cli/plug-ins/gimp/pathwarp-gimp.py")).unwrap());
    let own = home.join("bin").join("pathwarp").with_extension(std::env::consts::EXE_EXTENSION);
    assert!(Command::new(own).arg("list").stdout(Stdio::null()).status().unwrap().success());
    fs::write(home.join("notes.txt"), "mine").unwrap();
    expect_code(0, &["install", "gimp", "--dir", d, "--uninstall"]);
    assert_eq!(fs::read_dir(&home).unwrap().count(), 1, "other files stay");
    fs::remove_file(home.join("notes.txt")).unwrap();
    expect_code(0, &["install", "gimp", "--dir", d]);
    expect_code(0, &["install", "gimp", "--dir", d, "--uninstall"]);
    assert!(!home.exists());
}
