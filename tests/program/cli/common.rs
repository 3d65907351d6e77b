//! Artwork and helpers shared by several files.

use std::fs;
use std::path::Path;

pub const CAGE: &str = "M 10,90 C 40,110 60,70 95,85 C 85,60 105,40 90,15 C 60,-5 40,35 5,10 C 15,40 0,60 10,90 Z";
pub const SQUARE: &str =
    "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path id='s' d='M0,0H100V100H0Z'/></svg>";

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The files below a folder, relative to it, sorted.
pub fn files_below(folder: &Path) -> Vec<String> {
    let mut out = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            out.extend(files_below(&path).iter().map(|f| format!("{name}/{f}")));
        } else {
            out.push(name);
        }
    }
    out.sort();
    out
}
