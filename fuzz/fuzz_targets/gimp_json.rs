//! Point lists: any text is read or refused, and what is written again is sound.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pathwarp_gimp::{Kind, open, read, to_json};
use std::io::Cursor;

fuzz_target!(|data: &[u8]| {
    let Ok(file) = open(Cursor::new(data)) else { return };
    if file.kind != Kind::Json {
        return;
    }
    let again = read(to_json(file.size, &file.paths).as_bytes()).expect("what was written is sound");
    assert_eq!(again, file.paths);
});
