//! GIMP 1 text: any text is read or rejected without a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let _ = pathwarp_gimp::salvage(std::io::Cursor::new(data));
});
