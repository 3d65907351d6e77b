//! Point lists: any text is read or rejected, and a written copy reads the same.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pathwarp_gimp::{FileKind, open, read, to_json};
use std::io::Cursor;

fuzz_target!(|data: &[u8]| {
    let Ok(file) = open(Cursor::new(data)) else { return };
    if file.kind != FileKind::Json {
        return;
    }
    let again = read(to_json(file.size, &file.paths).as_bytes()).expect("a written file is valid");
    assert_eq!(again, file.paths);
});
