//! The HTTP requests of a page: its files, and the upgrade to a WebSocket. Each connection carries one request.

use crate::guard::{Guard, Refusal};
use std::io::{self, Read as _, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};
use tungstenite::handshake::server::{create_response, write_response};
use tungstenite::http::{Method, Request, Version};

/// Most bytes of a request's head. Browsers send less than two thousand.
const LONGEST_HEAD: usize = 16 << 10;
const MOST_HEADERS: usize = 64;
/// Most time for a browser that has connected to send its whole request, and for each write of the answer.
const PATIENCE: Duration = Duration::from_secs(10);

/// The content security policy. The page's script and style are files. A drawing may hold embedded pictures, and style attributes, of
/// which `drawing.ts` makes properties, as they are forbidden here. Nothing is ever loaded from elsewhere.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src data: blob:; connect-src 'self'; \
                      base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// Answers the request on a new connection. Returns the connection if it was upgraded to a WebSocket.
pub(crate) fn answer(mut stream: TcpStream, guard: &Guard) -> io::Result<Option<TcpStream>> {
    stream.set_write_timeout(Some(PATIENCE))?;
    stream.set_nodelay(true)?;
    let Some(request) = read(&mut stream)? else {
        return refuse(&mut stream, "400 Bad Request", "this is not a request of a browser");
    };
    let header = |name: &str| request.headers().get(name).and_then(|v| v.to_str().ok());
    if let Err(refusal) = guard.check_host_and_origin(header("host"), header("origin")) {
        return refuse(&mut stream, "403 Forbidden", explain(refusal));
    }
    if request.method() != Method::GET {
        return refuse(&mut stream, "405 Method Not Allowed", "only GET is allowed");
    }
    let (path, query) = (request.uri().path(), request.uri().query().unwrap_or_default());
    // The script and the style contain nothing private; browsers ask for them without the page's query.
    let public = ["/editor.js", "/editor.css", "/proof"].contains(&path);
    if !public && let Err(refusal) = guard.check_token(query) {
        return refuse(&mut stream, "403 Forbidden", explain(refusal));
    }
    if path == "/socket" {
        // Browsers state the origin of every WebSocket.
        if header("origin").is_none() {
            return refuse(&mut stream, "403 Forbidden", explain(Refusal::Origin));
        }
        return match create_response(&request) {
            Ok(response) => {
                write_response(&mut stream, &response).map_err(io::Error::other)?;
                Ok(Some(stream))
            }
            Err(_) => refuse(&mut stream, "400 Bad Request", "this is not a WebSocket"),
        };
    }
    // A page that has lost the server asks for this proof, a hash of the token and its question: another program may listen here now.
    if path == "/proof" {
        return respond(&mut stream, "200 OK", "text/plain", &guard.proof(query));
    }
    match ASSETS.iter().find(|a| a.path == path) {
        Some(asset) => respond(&mut stream, "200 OK", asset.kind, asset.text),
        None => refuse(&mut stream, "404 Not Found", "there is no such page"),
    }
}

fn explain(refusal: Refusal) -> &'static str {
    match refusal {
        Refusal::Host => "this server answers at 127.0.0.1 only",
        Refusal::Origin => "this server answers its own page only",
        Refusal::Token => "open the whole address that `pathwarp edit` has printed, with its token",
    }
}

/// Reads the head of a request; `None` if it is not one. No more follows: browsers then wait for the answer.
fn read(stream: &mut TcpStream) -> io::Result<Option<Request<()>>> {
    let begun = Instant::now();
    let mut head = Vec::new();
    let mut piece = [0; 2048];
    loop {
        // A head sent byte by byte would occupy a connection for hours.
        let rest = PATIENCE.checked_sub(begun.elapsed()).filter(|d| !d.is_zero()).ok_or(io::ErrorKind::TimedOut)?;
        stream.set_read_timeout(Some(rest))?;
        let n = stream.read(&mut piece)?;
        head.extend_from_slice(&piece[..n]);
        if let Some(parsed) = parse(&head) {
            return Ok(parsed);
        }
        if n == 0 || head.len() > LONGEST_HEAD {
            return Ok(None);
        }
    }
}

/// Parses a head. The outer option is `None` if it is incomplete, the inner one if it is malformed.
fn parse(head: &[u8]) -> Option<Option<Request<()>>> {
    let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
    let mut parsed = httparse::Request::new(&mut headers);
    match parsed.parse(head) {
        Ok(httparse::Status::Partial) => return None,
        Ok(httparse::Status::Complete(_)) => {}
        Err(_) => return Some(None),
    }
    let version = if parsed.version == Some(1) { Version::HTTP_11 } else { Version::HTTP_10 };
    let (Some(method), Some(path)) = (parsed.method, parsed.path) else { return Some(None) };
    let mut request = Request::builder().method(method).uri(path).version(version);
    for h in parsed.headers.iter() {
        request = request.header(h.name, h.value);
    }
    Some(request.body(()).ok())
}

fn refuse(stream: &mut TcpStream, status: &str, why: &str) -> io::Result<Option<TcpStream>> {
    respond(stream, status, "text/plain; charset=utf-8", &format!("{why}\n"))
}

/// Writes an answer that ends the connection, which is therefore not returned.
fn respond(stream: &mut TcpStream, status: &str, kind: &str, text: &str) -> io::Result<Option<TcpStream>> {
    let length = text.len();
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\nContent-Security-Policy: {POLICY}\r\n\
         X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nCross-Origin-Opener-Policy: same-origin\r\n\
         Cross-Origin-Resource-Policy: same-origin\r\nCache-Control: no-store\r\nConnection: close\r\n\r\n"
    );
    stream.write_all(head.as_bytes())?;
    stream.write_all(text.as_bytes())?;
    stream.flush()?;
    Ok(None)
}

/// A file of the page.
pub(crate) struct Asset {
    pub(crate) path: &'static str,
    pub(crate) kind: &'static str,
    pub(crate) text: &'static str,
}

/// All files of the page.
pub(crate) static ASSETS: [Asset; 3] = [
    Asset { path: "/", kind: "text/html; charset=utf-8", text: include_str!("../assets/index.html") },
    Asset { path: "/editor.js", kind: "text/javascript; charset=utf-8", text: include_str!("../assets/editor.js") },
    Asset { path: "/editor.css", kind: "text/css; charset=utf-8", text: include_str!("../assets/editor.css") },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_are_parsed_once_complete() {
        assert!(parse(b"GET / HTTP/1.1\r\nHost: a").is_none());
        let request = parse(b"GET /x?token=1 HTTP/1.1\r\nHost: a\r\n\r\n").unwrap().unwrap();
        assert_eq!((request.uri().path(), request.uri().query()), ("/x", Some("token=1")));
        assert_eq!(request.headers()["host"], "a");
        assert!(parse(b"\x00\x01 nonsense\r\n\r\n").unwrap().is_none());
    }
}
