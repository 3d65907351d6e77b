//! The server: listens on the loopback interface, and ends when its page is closed.

use crate::draft::Draft;
use crate::guard::Guard;
use crate::host::Host;
use crate::session::Session;
use crate::shared::{OpenPage, Shared};
use crate::{http, socket};
use std::io;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// A page that is reloaded connects again within this time.
const GRACE: Duration = Duration::from_secs(4);
/// The time between two looks for new connections and for the end.
const TICK: Duration = Duration::from_millis(20);
/// Most connections at a time; a page has one socket, and asks for three files.
const MOST_CONNECTIONS: usize = 64;

/// What to edit, and how.
#[derive(Debug, Clone)]
pub struct Options {
    /// The drawing.
    pub file: PathBuf,
    /// The file that *Save* writes; `None`: a name beside the drawing.
    pub out: Option<PathBuf>,
    /// The port; `None`: a free one.
    pub port: Option<u16>,
    /// Open the page in a browser.
    pub open: bool,
}

/// Opens the drawing, calls `announce` with the address of the page, and answers it until it is closed.
///
/// # Errors
/// The drawing cannot be opened, or the port is taken. Errors are sentences for the user.
pub fn serve(host: Arc<dyn Host>, options: &Options, announce: impl FnOnce(&str)) -> Result<(), String> {
    let bytes = std::fs::read(&options.file).map_err(|e| format!("{}: cannot be read: {e}", options.file.display()))?;
    let draft = Draft::of(&options.file);
    let session = Session::open(host, &options.file, &bytes, options.out.clone(), draft)?;
    let port = options.port.unwrap_or(0);
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(|e| format!("port {port}: {e}"))?;
    let run = || -> io::Result<()> {
        let guard = Guard::new(listener.local_addr()?.port())?;
        let address = guard.address();
        announce(&address);
        if options.open && has_display() {
            // The address is printed; a browser that cannot be started is no error.
            let _ = open::that_detached(&address);
        }
        listener.set_nonblocking(true)?;
        let shared = Arc::new(Shared::new(session));
        accept(&listener, &guard, &shared);
        Ok(())
    };
    run().map_err(|e| format!("the server cannot run: {e}"))
}

/// Returns `false` where no browser could show itself.
fn has_display() -> bool {
    let set = |name: &str| std::env::var_os(name).is_some_and(|v| !v.is_empty());
    cfg!(any(windows, target_os = "macos")) || set("DISPLAY") || set("WAYLAND_DISPLAY")
}

/// Answers connections until all pages have been closed for a while.
fn accept(listener: &TcpListener, guard: &Guard, shared: &Arc<Shared>) {
    let busy = Arc::new(AtomicUsize::new(0));
    let mut last_open = Instant::now();
    loop {
        if shared.pages.is_awaited() {
            last_open = Instant::now();
        }
        if last_open.elapsed() > GRACE {
            return;
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

/// One connection; its end needs no report, as browsers break connections at will.
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
