//! What the connections share: the session, and which pages are open.

use crate::session::Session;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// What the connections share.
pub(crate) struct Shared {
    session: Mutex<Session>,
    pub(crate) pages: Pages,
}

/// The pages that are open.
#[derive(Default)]
pub(crate) struct Pages {
    open: AtomicUsize,
    ever: AtomicUsize,
    /// Counts the changes of the session, so that every page notices those of the others.
    pub(crate) changes: AtomicUsize,
    /// The steps are kept for the program that waits for them.
    pub(crate) done: AtomicBool,
}

impl Pages {
    /// Returns `true` while a page is open, and before the first one is.
    pub(crate) fn is_awaited(&self) -> bool {
        self.open.load(Ordering::SeqCst) > 0 || !self.was_open()
    }

    /// Returns `true` once a page has been open.
    pub(crate) fn was_open(&self) -> bool {
        self.ever.load(Ordering::SeqCst) > 0
    }

    /// Returns `true` if nothing is left to do.
    pub(crate) fn is_done(&self) -> bool {
        self.done.load(Ordering::SeqCst)
    }
}

/// A page while it is connected.
pub(crate) struct OpenPage(Arc<Shared>);

impl OpenPage {
    pub(crate) fn new(shared: &Arc<Shared>) -> Self {
        shared.pages.open.fetch_add(1, Ordering::SeqCst);
        shared.pages.ever.fetch_add(1, Ordering::SeqCst);
        Self(Arc::clone(shared))
    }
}

impl Drop for OpenPage {
    fn drop(&mut self) {
        self.0.pages.open.fetch_sub(1, Ordering::SeqCst);
    }
}

impl Shared {
    pub(crate) fn new(session: Session) -> Self {
        Self { session: Mutex::new(session), pages: Pages::default() }
    }

    /// Works on the session. A panic in another connection does not end the editor: steps are taken over only after the drawing has been bent by
    /// them.
    pub(crate) fn with_session<T>(&self, f: impl FnOnce(&mut Session) -> T) -> T {
        f(&mut self.session.lock().unwrap_or_else(PoisonError::into_inner))
    }
}
