//! The editor's server: slow and wrong requests.

use super::bounded::{Folder, RECT, svg};
use crate::support::editor::{Editor, ask};
use crate::support::events::awaited;
use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::time::Duration;

/// Runs until the other side closes, and returns its messages.
fn rest(mut stream: TcpStream) -> String {
    let mut said = Vec::new();
    let _ = stream.read_to_end(&mut said);
    String::from_utf8_lossy(&said).into_owned()
}

#[test]
fn slow_and_wrong_requests_leave_the_editor_alive() {
    let folder = Folder::with(&[("a.svg", &svg(RECT))]);
    let editor = Editor::open(folder.path(), "a.svg");
    let mut page = editor.socket();
    // A request in drops never ends, so the server has to break it off.
    let mut drops = editor.connect();
    awaited("the end of a request in drops", move || {
        while drops.write_all(b"x").is_ok() {
            std::thread::sleep(Duration::from_millis(500));
        }
    });
    let long = "a".repeat(100_000);
    let headers = "a: b\r\n".repeat(5000);
    for wrong in [
        "GET / HTTP/1.1\r\n\r\n".to_owned(),
        format!("GET /{long} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n", editor.port),
        format!("GET / HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{headers}\r\n", editor.port),
        "\0\u{1}\u{2}\r\n\r\n".to_owned(),
    ] {
        let mut stream = editor.connect();
        let _ = stream.write_all(wrong.as_bytes());
        let said = rest(stream);
        assert!(said.is_empty() || said.starts_with("HTTP/1.1 4"), "{said}");
    }
    // A frame that announces more than memory holds ends its connection only.
    let mut huge = editor.socket();
    huge.write_all(&[0x81, 0xff, 0x7f, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 0]).unwrap();
    rest(huge);
    for wrong in ["{", "[]", "{\"id\":1,\"do\":\"fly\"}", "{\"id\":-1}"] {
        assert!(ask(&mut page, wrong)["error"].is_string(), "{wrong}");
    }
    assert_eq!(ask(&mut page, "{\"id\":7,\"do\":\"hello\"}")["id"], 7);
}
