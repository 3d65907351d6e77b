//! The editor as seen by its page: the program, and messages over its socket.

use super::events::LAST_RESORT;
use super::pathwarp_program;
use serde_json::Value;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// A running editor. It ends with the test.
pub struct Editor {
    child: Child,
    pub port: u16,
    /// The token's query.
    pub query: String,
    /// A connection that replaces the page. Without a page the editor ends after seconds, which a test may take between two requests.
    page: Option<TcpStream>,
}

impl Drop for Editor {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Editor {
    /// Opens a file of a folder; drafts go to the folder `state` in it.
    pub fn open(folder: &Path, file: &str) -> Self {
        Self::with(folder, file, |command| {
            command.env("XDG_STATE_HOME", folder.join("state"));
        })
    }

    /// Opens a file of a folder, with separate variables of the environment.
    pub fn with(folder: &Path, file: &str, variables: impl FnOnce(&mut Command)) -> Self {
        let mut command = Command::new(pathwarp_program());
        variables(command.args(["edit", file, "--no-open"]).current_dir(folder));
        let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let (out, err) = (child.stdout.take().unwrap(), child.stderr.take().unwrap());
        let lines = BufReader::new(out).lines().chain(BufReader::new(err).lines());
        let address = lines.map_while(Result::ok).find_map(|l| Some(l.split_once("http://127.0.0.1:")?.1.to_owned()));
        let address = address.expect("the editor names its address");
        let (port, query) = address.split_once("/?").unwrap();
        let query = query.split_whitespace().next().unwrap().to_owned();
        let mut out = Self { child, port: port.parse().unwrap(), query, page: None };
        out.page = Some(out.socket());
        out
    }

    pub fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(LAST_RESORT)).unwrap();
        stream
    }

    /// A WebSocket that has been accepted.
    pub fn socket(&self) -> TcpStream {
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

/// Sends a message, whose mask is zero, and returns the answer.
pub fn ask(stream: &mut TcpStream, message: &str) -> Value {
    let length = u16::try_from(message.len()).unwrap();
    let frame = [&[0x81, 0xfe][..], &length.to_be_bytes(), &[0; 4], message.as_bytes()].concat();
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
