//! Recipe files, as the command `run` reads them: any text is rejected or warps a drawing.

#![no_main]

use libfuzzer_sys::fuzz_target;
use pathwarp_fuzz::{Program, bounded, let_libraries_panic};
use std::sync::LazyLock;

/// Files that recipes can name: a cage, a lattice, a style.
static PROGRAM: LazyLock<Program> = LazyLock::new(|| {
    Program::with(&[
        ("cage.svg", include_bytes!("../../samples/cages.svg")),
        ("l.json", include_bytes!("../../samples/pinch.json")),
        ("roof.toml", include_bytes!("../../samples/roof.toml")),
    ])
});

fuzz_target!(
    init: let_libraries_panic(),
    |data: &[u8]| {
        PROGRAM.write("r.toml", data);
        bounded(|| PROGRAM.run(&["run", "r.toml", "in.svg", "-o", "out.svg"]));
    }
);
