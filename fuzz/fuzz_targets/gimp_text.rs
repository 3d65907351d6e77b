//! GIMP 1's text: any text is read or refused, without a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let _ = pathwarp_gimp::salvage(std::io::Cursor::new(data));
});
