//! Fonts for the tests.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used)]

use std::path::Path;

/// Reads a file from `fonts`.
pub fn file(name: &str) -> Vec<u8> {
    read(&format!("tests/fonts/{name}"))
}

/// Reads the bundled Noto Sans: 1000 units per em; A is 639 wide, i 258, the space 260.
pub fn bundled() -> Vec<u8> {
    read("../pathwarp-svg/fonts/NotoSans-Regular.subset.ttf")
}

fn read(name: &str) -> Vec<u8> {
    std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap()
}
