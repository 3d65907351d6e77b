//! The protocol as lines of text, for programs written by hand.

use crate::answer::{BuildAnswer, word};
use crate::fault::{Fault, beginning};
use pathwarp::engine::Ask;
use pathwarp::kurbo::{Point, Rect};
use pathwarp::map::{Crease, Creases, Level};
use std::fmt::Write as _;

/// Encodes the request to build a map from `lines`.
pub(crate) fn build(lines: &[String]) -> Vec<u8> {
    format!("build {}\n{}", lines.len(), lines.concat()).into_bytes()
}

/// Encodes the request for a batch.
pub(crate) fn batch(ask: Ask, points: &[Point], out: &mut Vec<u8>) {
    let mut text = String::with_capacity(40 * points.len() + 16);
    let _ = writeln!(text, "{} {}", word(ask), points.len());
    for p in points {
        let _ = writeln!(text, "{} {}", p.x, p.y);
    }
    out.extend_from_slice(text.as_bytes());
}

/// Returns the length of the answer to `build` at the beginning of `bytes`, up to the line `ok`, or a line that begins with `error`.
pub(crate) fn build_length(bytes: &[u8]) -> Option<usize> {
    let mut length = 0;
    for line in bytes.split_inclusive(|b| *b == b'\n') {
        length += line.len();
        let is_last = matches!(line.split(u8::is_ascii_whitespace).next(), Some(b"ok" | b"error"));
        if line.ends_with(b"\n") && is_last {
            return Some(length);
        }
    }
    None
}

/// Reads the lines of the answer to `build`.
pub(crate) fn read_build(bytes: &[u8]) -> Result<BuildAnswer, Fault> {
    let mut out = BuildAnswer::default();
    for line in String::from_utf8_lossy(bytes).lines() {
        let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
        match word {
            "ok" => {}
            "error" => return Err(Fault::Refused(rest.to_owned())),
            "note" => out.notes.push(rest.to_owned()),
            "warning" => out.warnings.push(rest.to_owned()),
            "detail" => out.detail = Some(positive(rest).ok_or_else(|| garbage(line))?),
            "crease" | "edge" => {
                let read = crease(rest, word == "edge");
                out.creases.push(read.ok_or_else(|| Fault::Crease(beginning(line.as_bytes())))?);
            }
            _ => return Err(garbage(line)),
        }
    }
    Ok(out)
}

fn garbage(line: &str) -> Fault {
    let expected = "ok, error, note, warning, detail, crease or edge".into();
    Fault::Garbage { expected, found: beginning(line.as_bytes()) }
}

/// Reads a number above zero.
fn positive(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|v: &f64| *v > 0.0 && v.is_finite())
}

/// Reads `line A B C [X0 Y0 X1 Y1]` or `circle X Y R`. Where an edge's level is positive, the map is defined.
fn crease(text: &str, edge: bool) -> Option<Crease> {
    let mut words = text.split_whitespace();
    let shape = words.next()?;
    let numbers = words.map(str::parse).collect::<Result<Vec<f64>, _>>().ok()?;
    let level = match (shape, numbers.as_slice()) {
        ("line", &[a, b, c]) if a.hypot(b) > 0.0 => Level::Line { a, b, c },
        ("line", &[a, b, c, x0, y0, x1, y1]) if a.hypot(b) > 0.0 && !edge => {
            Level::Stretch { a, b, c, within: Rect::new(x0, y0, x1, y1) }
        }
        ("circle", &[x, y, r]) if r != 0.0 => Level::Circle { center: Point::new(x, y), radius: r },
        _ => return None,
    };
    Some(if edge { Crease::edge(level) } else { Crease::kink(level) })
}

/// Reads creases and edges as programs declare them: `line A B C [X0 Y0 X1 Y1]` or `circle X Y R`, each perhaps after `crease` or `edge`.
///
/// # Errors
/// [`Fault::Crease`] for a text that is none of these.
pub fn creases<'a>(texts: impl IntoIterator<Item = &'a str>) -> Result<Creases, Fault> {
    let mut out = Creases::default();
    for text in texts {
        let (word, rest) = text.trim().split_once(' ').unwrap_or((text, ""));
        let shape = if ["crease", "edge"].contains(&word) { rest } else { text };
        out.push(crease(shape, word == "edge").ok_or_else(|| Fault::Crease(beginning(text.as_bytes())))?);
    }
    Ok(out)
}

/// Counts the lines of an answer as it arrives.
#[derive(Default)]
pub(crate) struct LineCount {
    lines: usize,
    seen: usize,
}

impl LineCount {
    /// Returns the length of the first `wanted` lines, once they have arrived. A single line that begins with `error` is a whole answer.
    pub(crate) fn length(&mut self, bytes: &[u8], wanted: usize) -> Option<usize> {
        for (i, b) in bytes.iter().enumerate().skip(self.seen) {
            if *b == b'\n' {
                self.lines += 1;
                if self.lines == wanted || bytes.starts_with(b"error ") {
                    return Some(i + 1);
                }
            }
        }
        self.seen = bytes.len();
        None
    }
}

/// Reads the numbers of an answer to a batch.
pub(crate) fn read_batch(bytes: &[u8], ask: Ask, out: &mut Vec<f64>) -> Result<(), Fault> {
    let text = std::str::from_utf8(bytes).map_err(|_| wrong_line(ask, bytes))?;
    for line in text.lines() {
        let before = out.len();
        for word in line.split_ascii_whitespace() {
            out.push(word.parse().map_err(|_| match line.strip_prefix("error ") {
                Some(message) => Fault::Refused(message.to_owned()),
                None => wrong_line(ask, line.as_bytes()),
            })?);
        }
        if out.len() - before != ask.numbers() {
            return Err(wrong_line(ask, line.as_bytes()));
        }
    }
    Ok(())
}

fn wrong_line(ask: Ask, line: &[u8]) -> Fault {
    Fault::Garbage { expected: format!("a line of {} numbers", ask.numbers()), found: beginning(line) }
}
