//! Counts the bytes that this process has read and the pixels that it has drawn: front ends bound its time and memory by them.

use std::sync::atomic::{AtomicU64, Ordering};

static BYTES: AtomicU64 = AtomicU64::new(0);
static PIXELS: AtomicU64 = AtomicU64::new(0);

/// Adds the size of a file that is read: larger ones may take longer.
pub fn count_input(bytes: usize) {
    BYTES.fetch_add(bytes as u64, Ordering::Relaxed);
}

/// Adds a picture: a large one may take long even if its file is small.
pub fn count_pixels(pixels: f64) {
    PIXELS.fetch_add(pixels as u64, Ordering::Relaxed);
}

/// Returns the bytes and the pixels so far.
#[must_use]
pub fn counted() -> [u64; 2] {
    [&BYTES, &PIXELS].map(|n| n.load(Ordering::Relaxed))
}
