//! SVG from GIMP: any text is read or rejected, and a written copy reads again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pathwarp_gimp::{FileKind, open, read, to_svg};
use std::io::Cursor;

fuzz_target!(|data: &[u8]| {
    let Ok(file) = open(Cursor::new(data)) else { return };
    if file.kind != FileKind::Svg {
        return;
    }
    let size = file.size.unwrap_or([640.0, 400.0]);
    let again = read(to_svg(size, &file.paths, None).as_bytes()).expect("a written file is valid");
    assert_eq!(again.len(), file.paths.len());
});
