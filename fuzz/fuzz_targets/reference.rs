//! Path references, `FILE#NAME`, `FILE`, `#NAME`, path data, points, circles and arcs, and the files that they name.
//!
//! The first byte chooses the deformation; the first line is the reference, the rest is the content of its file.

#![no_main]

use libfuzzer_sys::fuzz_target;
use pathwarp_fuzz::{Program, bounded, let_libraries_panic};
use std::sync::LazyLock;

static PROGRAM: LazyLock<Program> = LazyLock::new(|| Program::with(&[]));

/// Parameters that are paths. The value is appended.
const COMMANDS: [&[&str]; 6] = [
    &["bend", "--along"],
    &["shaper", "--shaper"],
    &["envelope", "--envelope"],
    &["projective", "--target"],
    &["bilinear", "--target"],
    &["similitude", "--target"],
];

/// The names that a file may have, by which its kind is known.
const FILES: [&str; 4] = ["r.svg", "r.json", "r.xcf", "r"];

fn run(choice: u8, reference: &str, content: &[u8]) {
    // Other files than ours are not for this target to read.
    if let Some(name) = FILES.iter().find(|f| reference == **f || reference.starts_with(&format!("{f}#"))) {
        PROGRAM.write(name, content);
    } else if reference.contains(['/', '.']) && !pathwarp::param::is_inline(reference) && !reference.starts_with('#') {
        return;
    }
    let words = COMMANDS[usize::from(choice) % COMMANDS.len()];
    let value = format!("{}={reference}", words[1]);
    PROGRAM.run(&[words[0], &value, "in.svg", "-o", "out.svg"]);
}

fuzz_target!(
    init: let_libraries_panic(),
    |data: &[u8]| {
        let Some((&choice, rest)) = data.split_first() else { return };
        let mut parts = rest.splitn(2, |b| *b == b'\n');
        let Some(Ok(reference)) = parts.next().map(std::str::from_utf8) else { return };
        // A program's arguments hold no zero bytes.
        if !reference.contains('\0') {
            bounded(|| run(choice, reference, parts.next().unwrap_or_default()));
        }
    }
);
