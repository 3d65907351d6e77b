//! Fonts for the tests.

/// Reads a file from `fonts`.
pub fn file(name: &str) -> Vec<u8> {
    read(&format!("crates/pathwarp-text/tests/fonts/{name}"))
}

/// Reads the bundled Noto Sans: 1000 units per em; A is 639 wide, i 258, the space 260.
pub fn bundled() -> Vec<u8> {
    read("crates/pathwarp-svg/fonts/NotoSans-Regular.subset.ttf")
}

fn read(name: &str) -> Vec<u8> {
    std::fs::read(crate::support::root().join(name)).unwrap()
}
