//! GIMP's SVG: any text is read or refused, and what is written again is sound.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pathwarp_gimp::{Kind, open, read, to_svg};
use std::io::Cursor;

fuzz_target!(|data: &[u8]| {
    let Ok(file) = open(Cursor::new(data)) else { return };
    if file.kind != Kind::Svg {
        return;
    }
    let size = file.size.unwrap_or([640.0, 400.0]);
    let again = read(to_svg(size, &file.paths, None).as_bytes()).expect("what was written is sound");
    assert_eq!(again.len(), file.paths.len());
});
