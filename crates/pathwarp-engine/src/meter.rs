//! The size of what this process has read and drawn so far, for a front end that bounds its time and memory by it.

use std::sync::atomic::{AtomicU64, Ordering};

static BYTES: AtomicU64 = AtomicU64::new(0);
static PIXELS: AtomicU64 = AtomicU64::new(0);

/// Adds the size of a file that is read: larger ones may take longer.
pub fn count_input(bytes: usize) {
    BYTES.fetch_add(bytes as u64, Ordering::Relaxed);
}

/// Adds a picture: large ones may take longer, whatever the size of the file.
pub fn count_pixels(pixels: f64) {
    PIXELS.fetch_add(pixels as u64, Ordering::Relaxed);
}

/// The bytes and the pixels so far.
#[must_use]
pub fn counted() -> [u64; 2] {
    [&BYTES, &PIXELS].map(|n| n.load(Ordering::Relaxed))
}
