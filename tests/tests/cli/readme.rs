//! Every block of commands in the README runs word for word in a shell, in a folder with files of the names that it uses.
#![cfg(unix)]

use crate::support::{pathwarp_in, pathwarp_program, root, sample};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Samples under the names that the README gives to a reader's own files.
const FILES: [(&str, &str); 10] = [
    ("logo.svg", "before.svg"),
    ("badge.svg", "badge.svg"),
    ("cages.svg", "cage.svg"),
    ("envelopes.svg", "shapes.svg"),
    ("lettering.svg", "word.svg"),
    ("monogram.svg", "other.svg"),
    ("icon.svg", "icons/icon.svg"),
    ("grid.svg", "icons/grid.svg"),
    ("tiles.svg", "drawings/tiles.svg"),
    ("headline.svg", "drawings/headline.svg"),
];
/// The drawing with a cage, and the paths of an XCF.
const CAGE: &str = "<path id='cage' fill='none' d='M0,120 Q60,90 120,120 L110,0 Q60,30 10,0 Z'/></svg>";
const PATHS: &str = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path id='Logo' d='M10,10H90V90H10Z'/>\
                     <path id='Cage' d='M0,100 Q50,60 100,100 L100,0 Q50,-40 0,0 Z'/></svg>";

fn prepare(folder: &Path) {
    fs::create_dir(folder.join("icons")).unwrap();
    fs::create_dir(folder.join("drawings")).unwrap();
    for (from, to) in FILES {
        fs::copy(sample(from), folder.join(to)).unwrap();
    }
    std::os::unix::fs::symlink(root().join("samples"), folder.join("samples")).unwrap();
    let logo = fs::read_to_string(sample("logo.svg")).unwrap();
    fs::write(folder.join("logo.svg"), logo.replace("</svg>", CAGE)).unwrap();
    fs::write(folder.join("after.svg"), pathwarp_in(folder, &["wave", "-q"], logo.as_bytes()).stdout).unwrap();
    fs::write(
        folder.join("photo.jpg"),
        pathwarp_in(folder, &["render", "-", "--format", "jpg"], logo.as_bytes()).stdout,
    )
    .unwrap();
    assert!(pathwarp_in(folder, &["convert", "-", "-o", "art.xcf"], PATHS.as_bytes()).status.success());
}

#[test]
fn every_block_of_commands_runs() {
    let dir = tempfile::tempdir().unwrap();
    prepare(dir.path());
    let programs = pathwarp_program().parent().unwrap().display().to_string();
    let path = format!("{programs}:{}", std::env::var("PATH").unwrap());
    let page = fs::read_to_string(root().join("README.md")).unwrap();
    let blocks = page.split("```").skip(1).step_by(2).filter_map(|block| block.strip_prefix("sh\n"));
    let mut run = 0;
    // The editor waits for its reader.
    let waits = |b: &str| b.starts_with("pathwarp edit ");
    for block in blocks.filter(|b| b.lines().any(|l| l.starts_with("pathwarp ")) && !waits(b)) {
        let shell =
            Command::new("sh").args(["-e", "-x", "-c", block]).current_dir(dir.path()).env("PATH", &path).output();
        let shell = shell.unwrap();
        assert!(shell.status.success(), "{}", String::from_utf8_lossy(&shell.stderr));
        run += 1;
    }
    assert!(run >= 4, "{run} blocks");
}
