//! A map that a program was asked to build: the request, which every process of the program gets before points of that map.

use std::sync::atomic::{AtomicU64, Ordering};

/// A map by its number, and the request to build it.
#[derive(Debug)]
pub(crate) struct Instance {
    pub(crate) id: u64,
    pub(crate) request: Vec<u8>,
}

impl Instance {
    /// Numbers begin at 1; a process that has built nothing is at 0.
    pub(crate) fn new(request: Vec<u8>) -> Self {
        static LAST: AtomicU64 = AtomicU64::new(0);
        Self { id: LAST.fetch_add(1, Ordering::Relaxed) + 1, request }
    }
}
