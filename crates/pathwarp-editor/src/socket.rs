//! One connection of a page: answers its requests in order, and announces changes made by other pages.

use crate::picture::{PathUpdate, Picture};
use crate::protocol::{Message, Request};
use crate::session::{Session, Shown};
use serde_json::{Value, json};
use std::io;
use std::net::TcpStream;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Error, WebSocket};

/// Largest message in bytes, enough for a dropped drawing.
const LARGEST_MESSAGE: usize = 256 << 20;
/// Time after which an idle page learns of changes made by others.
const POLL_INTERVAL: Duration = Duration::from_millis(200);

/// Serves a page until it closes.
pub(crate) fn run(stream: TcpStream, shared: &Arc<Shared>) -> Result<(), Error> {
    stream.set_read_timeout(Some(POLL_INTERVAL))?;
    let config =
        WebSocketConfig::default().max_message_size(Some(LARGEST_MESSAGE)).max_frame_size(Some(LARGEST_MESSAGE));
    let mut page = Page {
        socket: WebSocket::from_raw_socket(stream, Role::Server, Some(config)),
        shared: Arc::clone(shared),
        picture: None,
        path_update: None,
        known_changes: shared.pages.changes.load(Ordering::SeqCst),
    };
    loop {
        match page.socket.read() {
            Ok(tungstenite::Message::Text(text)) => page.answer(&text)?,
            Ok(tungstenite::Message::Close(_)) | Err(Error::ConnectionClosed | Error::AlreadyClosed) => return Ok(()),
            Ok(_) => {}
            Err(Error::Io(e)) if matches!(e.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut) => {
                page.announce()?;
            }
            // Resuming a suspended program interrupts the call.
            Err(Error::Io(e)) if e.kind() == io::ErrorKind::Interrupted => {}
            Err(e) => return Err(e),
        }
    }
}

struct Page {
    socket: WebSocket<TcpStream>,
    shared: Arc<Shared>,
    /// The last picture sent.
    picture: Option<Picture>,
    /// The quick update from that picture to the next draft, if nothing but path data may change.
    path_update: Option<PathUpdate>,
    /// The number of changes that the page has been told.
    known_changes: usize,
}

impl Page {
    fn send(&mut self, value: &Value) -> Result<(), Error> {
        self.socket.send(tungstenite::Message::text(value.to_string()))
    }

    /// Announces changes by other pages.
    fn announce(&mut self) -> Result<(), Error> {
        let now = self.shared.pages.changes.load(Ordering::SeqCst);
        if now == self.known_changes {
            return Ok(());
        }
        self.known_changes = now;
        let state = self.shared.with_session(|s| s.state());
        self.send(&json!({ "event": "changed", "state": state }))
    }

    fn answer(&mut self, text: &str) -> Result<(), Error> {
        let Message { id, request } = match serde_json::from_str(text) {
            Ok(message) => message,
            Err(e) => return self.send(&json!({ "error": format!("this request is not understood: {e}") })),
        };
        let shared = Arc::clone(&self.shared);
        let mut answer = shared.with_session(|session| {
            self.respond(session, request)
                .unwrap_or_else(|problem| json!({ "error": session.with_drawing_name(&problem) }))
        });
        answer["id"] = json!(id);
        self.send(&answer)
    }

    /// Answers a request; [`Request`] describes each. Of steps that are stored, only the first `shown` ones are drawn.
    fn respond(&mut self, session: &mut Session, request: Request) -> Result<Value, String> {
        match request {
            Request::Hello => {
                (self.picture, self.path_update) = (None, None);
                Ok(json!({ "catalogue": session.catalogue(), "state": session.state() }))
            }
            Request::Background => Ok(json!({ "background": *self.shared.background() })),
            Request::KeepBackground { background } => {
                *self.shared.background() = background;
                Ok(json!({}))
            }
            Request::Ahead { steps, draft } => Ok(json!({ "svg": session.bend(&steps, draft)?.picture()?.text() })),
            Request::Drawn { name, bytes } => Ok(json!({ "svg": session.drawn(&name, &bytes)?.text() })),
            Request::Parts => Ok(json!({ "parts": session.parts()? })),
            Request::Bend { steps, draft } => session.bend(&steps, draft).and_then(|picture| self.show(picture)),
            Request::Commit { steps, shown } => session.commit(steps, shown).and_then(|p| self.changed(session, p)),
            Request::Undo { shown } => session.undo(shown).and_then(|picture| self.changed(session, picture)),
            Request::Redo { shown } => session.redo(shown).and_then(|picture| self.changed(session, picture)),
            Request::Before => Ok(json!({ "svg": session.before()?.text() })),
            Request::Stretch { steps } => Ok(json!({ "stretch": session.stretch(&steps)? })),
            Request::Opening { deformation, variant, steps, select } => {
                Ok(json!({ "step": session.opening(&deformation, variant.as_deref(), &steps, select)? }))
            }
            Request::Scope { steps, select } => Ok(json!({ "step": session.scope(steps, select)? })),
            Request::Thumbnail { steps, example, variant } => {
                let example = example.map(|name| session.example(&name, variant.as_deref())).transpose()?;
                let steps = steps.or_else(|| example.map(|step| vec![step])).unwrap_or_default();
                Ok(json!({ "svg": session.thumbnail(&steps)? }))
            }
            Request::Families => Ok(json!({ "families": session.families()? })),
            Request::SetWords { words } => {
                let lacking = session.set_words(&words)?;
                self.count_change();
                Ok(json!({ "state": session.state(), "lacking": lacking }))
            }
            Request::Open { name, bytes } => {
                session.replace(&name, &bytes)?;
                self.count_change();
                Ok(json!({ "state": session.state() }))
            }
            Request::Bring { name, bytes } => session.bring(&name, &bytes),
            Request::Save { to, replace } => {
                let mut answer = session.save(&to, replace)?;
                self.count_change();
                answer["state"] = session.state();
                Ok(answer)
            }
            Request::Download { to } => session.download(&to),
            Request::HandOver => {
                session.hand_over()?;
                self.shared.pages.done.store(true, Ordering::SeqCst);
                Ok(json!({ "done": true }))
            }
            Request::Presets => Ok(json!({ "presets": session.presets()? })),
            Request::KeepPreset { name } => Ok(json!({ "presets": session.keep_preset(&name)? })),
            Request::ForgetPreset { name } => Ok(json!({ "presets": session.forget_preset(&name)? })),
            Request::Preset { name } => Ok(json!({ "steps": session.preset(&name)? })),
            Request::Preimage { steps, at } => session.preimage(&steps, at.into()),
            Request::Renet { steps, values } => session.renet(&steps, values),
            Request::CommandLine { to } => session.command_line(&to),
        }
    }

    /// Returns the message with a picture.
    fn show(&mut self, shown: Shown) -> Result<Value, String> {
        let is_draft = shown.is_draft;
        if let (true, Some(update), Some(picture)) = (is_draft, &mut self.path_update, &mut self.picture)
            && let Some(changes) = update.next(&shown.svg)
        {
            picture.redraw(&changes);
            let mut answer = shown.about;
            answer["picture"] = changed_paths(changes);
            return Ok(answer);
        }
        let picture = shown.picture()?;
        self.path_update = is_draft.then(|| PathUpdate::prepare(shown.svg, &picture)).flatten();
        let mut answer = shown.about;
        answer["picture"] = picture.message(self.picture.as_ref());
        self.picture = Some(picture);
        Ok(answer)
    }

    /// Counts a change of the steps, and returns the message about it.
    fn changed(&mut self, session: &Session, shown: Shown) -> Result<Value, String> {
        self.count_change();
        let mut answer = self.show(shown)?;
        answer["state"] = session.state();
        Ok(answer)
    }

    /// Counts a change that this page has made.
    fn count_change(&mut self) {
        self.known_changes = self.shared.pages.changes.fetch_add(1, Ordering::SeqCst) + 1;
    }
}

/// Returns the message that gives lines of the picture new path data.
fn changed_paths(changes: Vec<(usize, String)>) -> Value {
    let change = |(line, data)| Value::Array(vec![json!(line), json!("d"), Value::String(data)]);
    json!({ "changes": changes.into_iter().map(change).collect::<Vec<_>>() })
}

/// State shared by the connections.
pub(crate) struct Shared {
    session: Mutex<Session>,
    /// The page's picture behind the drawing; only pages know its format.
    background: Mutex<Value>,
    pub(crate) pages: Pages,
}

/// The pages that are open.
#[derive(Default)]
pub(crate) struct Pages {
    open: AtomicUsize,
    ever: AtomicUsize,
    /// The number of changes, by which every page notices those of the others.
    pub(crate) changes: AtomicUsize,
    /// `true` once the steps are confirmed for the program that waits.
    pub(crate) done: AtomicBool,
}

impl Pages {
    /// Returns `true` while a page is open, and before the first one opens.
    pub(crate) fn is_awaited(&self) -> bool {
        self.open.load(Ordering::SeqCst) > 0 || !self.was_open()
    }

    /// Returns `true` once a page has been open.
    pub(crate) fn was_open(&self) -> bool {
        self.ever.load(Ordering::SeqCst) > 0
    }

    /// Returns `true` if the session has ended.
    pub(crate) fn is_done(&self) -> bool {
        self.done.load(Ordering::SeqCst)
    }
}

/// A page, counted as open while this exists.
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
        Self { session: Mutex::new(session), background: Mutex::default(), pages: Pages::default() }
    }

    fn background(&self) -> MutexGuard<'_, Value> {
        self.background.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Locks the session, even after a panic in another connection: it is still whole, since steps change only once they are bent.
    pub(crate) fn with_session<T>(&self, f: impl FnOnce(&mut Session) -> T) -> T {
        f(&mut self.session.lock().unwrap_or_else(PoisonError::into_inner))
    }
}
