//! The server: it listens on the loopback interface, and ends when its page is closed.

use crate::guard::Guard;
use crate::host::{Host, Purpose};
use crate::session::Session;
use crate::socket::{self, OpenPage, Shared};
use crate::{draft, http};
use pathwarp::recipe::Recipe;
use std::io;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Time within which a reloaded page connects again.
const GRACE: Duration = Duration::from_secs(4);
/// Time between checks for new connections and for the end.
const TICK: Duration = Duration::from_millis(20);
/// Longest wait for the first page, if a program waits for it.
const FIRST_PAGE: Duration = Duration::from_secs(120);
/// Time within which the last answer reaches its page.
const FAREWELL: Duration = Duration::from_millis(300);
/// Most simultaneous connections; a page has one socket and requests three files.
const MOST_CONNECTIONS: usize = 64;

/// The options of the editor.
#[derive(Debug, Clone)]
pub struct Options {
    /// The drawing to edit.
    pub file: PathBuf,
    /// The use of the finished steps.
    pub purpose: Purpose,
    /// The port; `None` for an unused one.
    pub port: Option<u16>,
    /// `true` to open the page in a browser.
    pub open: bool,
}

/// Messages to the user while the server starts.
#[derive(Debug)]
pub enum News<'a> {
    /// The address of the page.
    Address(&'a str),
    /// No browser could be started to show the page.
    NoBrowser(&'a io::Error),
}

/// Opens the drawing, announces the address of the page, and serves it until it is closed. Returns the steps that the user has confirmed,
/// if a program waits for them.
///
/// # Errors
/// A sentence for the user if the drawing cannot be opened, the port is taken, or a program waits and no page opens.
pub fn serve(host: Arc<dyn Host>, options: &Options, announce: impl Fn(&News<'_>)) -> Result<Option<Recipe>, String> {
    let bytes = std::fs::read(&options.file).map_err(|e| format!("{}: cannot be read: {e}", options.file.display()))?;
    let waits = options.purpose.program().is_some();
    // Drafts are not stored for programs, whose drawings stay unchanged without a result.
    let state = if waits { None } else { draft::state() };
    let (listener, guard) = listen(options, state.as_deref())?;
    let session = Session::open(host, &options.file, &bytes, options.purpose.clone(), state)?;
    session.keep_address(&guard);
    let address = guard.address();
    announce(&News::Address(&address));
    if options.open && (waits || has_display()) {
        match open_browser(&address) {
            Err(e) if waits => return Err(format!("no browser can be started: {e}")),
            // The user can open the printed address.
            Err(e) => announce(&News::NoBrowser(&e)),
            Ok(()) => {}
        }
    }
    listener.set_nonblocking(true).map_err(|e| failed(&e))?;
    let shared = Arc::new(Shared::new(session));
    accept(&listener, &guard, &shared, waits.then_some(FIRST_PAGE))?;
    Ok(shared.with_session(|s| s.result()))
}

/// Listens at the port of the last run on this drawing, if it is unused, so that a page which is still open connects again.
fn listen(options: &Options, state: Option<&Path>) -> Result<(TcpListener, Guard), String> {
    let at = |port: u16| TcpListener::bind((Ipv4Addr::LOCALHOST, port));
    let last = state.and_then(|s| Guard::last(s, &options.file));
    if let Some(guard) = last.filter(|g| options.port.is_none_or(|p| p == g.port))
        && let Ok(listener) = at(guard.port)
    {
        return Ok((listener, guard));
    }
    let port = options.port.unwrap_or(0);
    let listener = at(port).map_err(|e| unusable(port, &e))?;
    let guard = listener.local_addr().and_then(|a| Guard::new(a.port())).map_err(|e| failed(&e))?;
    Ok((listener, guard))
}

fn failed(e: &io::Error) -> String {
    format!("the server cannot run: {e}")
}

/// Explains why the server cannot listen at a port.
fn unusable(port: u16, e: &io::Error) -> String {
    match e.kind() {
        io::ErrorKind::AddrInUse => {
            format!("port {port} is in use by another program; choose another one, or none for a free one")
        }
        _ => format!("port {port}: {e}"),
    }
}

/// Opens the browser in the usual environment variable, or else the system's.
fn open_browser(address: &str) -> io::Result<()> {
    match std::env::var("BROWSER") {
        // Lists and patterns are left to the desktop's opener.
        Ok(name) if !name.is_empty() && !name.contains([':', '%', ';']) => open::with_detached(address, name),
        _ => open::that_detached(address),
    }
}

/// Returns `false` if no browser could display anything.
fn has_display() -> bool {
    let set = |name: &str| std::env::var_os(name).is_some_and(|v| !v.is_empty());
    cfg!(any(windows, target_os = "macos")) || set("DISPLAY") || set("WAYLAND_DISPLAY")
}

/// Answers connections until all pages have been closed for a while, or the steps are confirmed for the program that waits. The first page
/// must open within the given time, if any.
fn accept(
    listener: &TcpListener,
    guard: &Guard,
    shared: &Arc<Shared>,
    first_page: Option<Duration>,
) -> Result<(), String> {
    let busy = Arc::new(AtomicUsize::new(0));
    let start = Instant::now();
    // Starts when the loop notices it, so that a program that was suspended still waits for the full time.
    let mut alone_since: Option<Instant> = None;
    loop {
        if shared.pages.is_done() {
            std::thread::sleep(FAREWELL);
            return Ok(());
        }
        if shared.pages.is_awaited() {
            alone_since = None;
        } else if alone_since.get_or_insert_with(Instant::now).elapsed() > GRACE {
            return Ok(());
        }
        if first_page.is_some_and(|most| start.elapsed() > most && !shared.pages.was_open()) {
            return Err("no browser has opened the page".into());
        }
        let Ok((stream, _)) = listener.accept() else {
            std::thread::sleep(TICK);
            continue;
        };
        if busy.load(Ordering::SeqCst) >= MOST_CONNECTIONS {
            continue;
        }
        busy.fetch_add(1, Ordering::SeqCst);
        let (guard, shared, busy) = (guard.clone(), Arc::clone(shared), Arc::clone(&busy));
        std::thread::spawn(move || {
            connection(stream, &guard, &shared);
            busy.fetch_sub(1, Ordering::SeqCst);
        });
    }
}

/// Serves one connection. Its errors are ignored, since browsers break connections at any time.
fn connection(stream: TcpStream, guard: &Guard, shared: &Arc<Shared>) {
    if stream.set_nonblocking(false).is_err() {
        return;
    }
    if let Ok(Some(stream)) = http::answer(stream, guard) {
        let page = OpenPage::new(shared);
        let _ = socket::run(stream, shared);
        drop(page);
    }
}
