//! The editor's server: slow and wrong requests, and drafts that came with a drawing.

use super::bounded::{Folder, RECT, svg};
use crate::support::pathwarp_program;
use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A running editor. It ends with the test.
struct Editor {
    child: Child,
    /// The port, and the token's query.
    port: u16,
    query: String,
}

impl Drop for Editor {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Editor {
    fn open(folder: &Folder) -> Self {
        let mut child = Command::new(pathwarp_program())
            .args(["edit", "a.svg", "--no-open"])
            .current_dir(folder.path())
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (out, err) = (child.stdout.take().unwrap(), child.stderr.take().unwrap());
        let lines = BufReader::new(out).lines().chain(BufReader::new(err).lines());
        let address = lines.map_while(Result::ok).find_map(|l| Some(l.split_once("http://127.0.0.1:")?.1.to_owned()));
        let address = address.expect("the editor names its address");
        let (port, query) = address.split_once("/?").unwrap();
        let query = query.split_whitespace().next().unwrap().to_owned();
        Self { child, port: port.parse().unwrap(), query }
    }

    fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(200))).unwrap();
        stream
    }

    /// A WebSocket that has been accepted.
    fn socket(&self) -> TcpStream {
        let mut stream = self.connect();
        let (port, query) = (self.port, &self.query);
        let head = format!(
            "GET /socket?{query} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: http://127.0.0.1:{port}\r\nConnection: Upgrade\r\n\
             Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
        );
        stream.write_all(head.as_bytes()).unwrap();
        let mut said = Vec::new();
        while !said.ends_with(b"\r\n\r\n") {
            let mut byte = [0];
            stream.read_exact(&mut byte).unwrap();
            said.push(byte[0]);
        }
        assert!(said.starts_with(b"HTTP/1.1 101"), "{}", String::from_utf8_lossy(&said));
        stream
    }
}

/// Sends a short message, whose mask is zero, and returns the answer.
fn ask(stream: &mut TcpStream, message: &str) -> serde_json::Value {
    let length = u8::try_from(message.len()).unwrap();
    assert!(length < 126);
    let frame = [&[0x81, 0x80 | length, 0, 0, 0, 0][..], message.as_bytes()].concat();
    stream.write_all(&frame).unwrap();
    let mut exactly = |n: usize| {
        let mut bytes = vec![0; n];
        stream.read_exact(&mut bytes).unwrap();
        bytes
    };
    let number = |bytes: Vec<u8>| bytes.into_iter().fold(0, |n, b| n << 8 | usize::from(b));
    let head = exactly(2);
    let length = match head[1] & 0x7f {
        126 => number(exactly(2)),
        127 => number(exactly(8)),
        n => usize::from(n),
    };
    serde_json::from_slice(&exactly(length)).unwrap()
}

/// Runs until the other side closes, and returns what it said.
fn rest(mut stream: TcpStream) -> String {
    let mut said = Vec::new();
    let _ = stream.read_to_end(&mut said);
    String::from_utf8_lossy(&said).into_owned()
}

#[test]
fn slow_and_wrong_requests_leave_the_editor_alive() {
    let folder = Folder::with(&[("a.svg", &svg(RECT))]);
    let editor = Editor::open(&folder);
    let mut page = editor.socket();
    // A request in drops, which never ends.
    let mut drops = editor.connect();
    let begun = Instant::now();
    while drops.write_all(b"x").is_ok() {
        assert!(begun.elapsed() < Duration::from_secs(100), "a request may take for ever");
        std::thread::sleep(Duration::from_millis(500));
    }
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

#[test]
fn drafts_from_strangers_name_no_files_elsewhere() {
    let step = |deformation: &str, args: &str| {
        format!("{{\"deformation\":\"{deformation}\",\"inverse\":false,\"args\":{args}}}")
    };
    let draft = |steps: &str, dropped: &str| {
        format!("{{\"pathwarp\":1,\"steps\":[{steps}],\"undo\":[],\"redo\":[],\"dropped\":{dropped}}}")
    };
    let good = draft(&step("wave", "{\"length\":[\"20\"]}"), "null");
    for (text, admitted) in [
        (good, true),
        (draft(&step("ffd", "{\"lattice\":[\"/etc/passwd\"]}"), "null"), false),
        (draft(&step("bend", "{\"along\":[\"/etc/passwd#a\"]}"), "null"), false),
        (draft(&step("ffd", "{\"save-lattice\":[\"evil.json\"]}"), "null"), false),
        (draft("", "[\"../../evil.svg\",\"PHN2Zy8+\"]"), false),
    ] {
        let folder = Folder::with(&[("a.svg", &svg(RECT)), (".a.svg.pathwarp-edit", text.as_bytes())]);
        let editor = Editor::open(&folder);
        let answer = ask(&mut editor.socket(), "{\"id\":1,\"do\":\"hello\"}");
        let state = &answer["state"];
        assert_eq!(state["restored"], admitted, "{text}: {state}");
        assert_eq!(state["steps"].as_array().unwrap().len(), usize::from(admitted), "{text}");
        assert_eq!(state["problem"].is_null(), admitted, "{text}: {state}");
    }
}

/// A pipe in the place of a draft would hold the editor for ever, and a link may lead anywhere.
#[cfg(unix)]
#[test]
fn only_regular_files_are_drafts() {
    for make in [&["mkfifo", ".a.svg.pathwarp-edit"][..], &["ln", "-s", "/dev/zero", ".a.svg.pathwarp-edit"]] {
        let folder = Folder::with(&[("a.svg", &svg(RECT))]);
        assert!(Command::new(make[0]).args(&make[1..]).current_dir(folder.path()).status().unwrap().success());
        let editor = Editor::open(&folder);
        assert_eq!(ask(&mut editor.socket(), "{\"id\":1,\"do\":\"hello\"}")["state"]["restored"], false);
        assert!(fs::symlink_metadata(folder.path().join(".a.svg.pathwarp-edit")).is_ok());
    }
}
