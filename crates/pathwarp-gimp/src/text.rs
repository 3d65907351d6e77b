//! Reads the text format of "Export path" in GIMP 1: records of a name, a count, flags, and one line per point.

use crate::error::{Error, ErrorKind};
use crate::old_strokes::{TypedPoint, split_strokes};
use crate::path::GimpPath;

/// The first bytes of a file in this format.
pub(crate) const FIRST: &[u8] = b"Name: ";

/// Reads all records. After an error, `paths` holds the records before it.
pub(crate) fn read(text: &str, paths: &mut Vec<GimpPath>) -> Result<(), Error> {
    /// A lower bound on the length of a point's line, `TYPE: 1 X: 0 Y: 0`.
    const MIN_LINE: u64 = 16;
    let mut at = 0;
    let mut lines = text.split_inclusive('\n').map(|l| {
        let start = at;
        at += l.len() as u64;
        (start, l.trim_end_matches(['\n', '\r']))
    });
    while let Some((start, line)) = lines.next() {
        if line.trim().is_empty() {
            continue;
        }
        let name = line.strip_prefix("Name: ").ok_or_else(|| Error::damaged(start, "expected `Name: …`"))?;
        let mut field = |key: &str| -> Result<u64, Error> {
            let (at, line) = lines
                .next()
                .ok_or_else(|| Error::new(ErrorKind::Truncated, text.len() as u64, format!("`{key}` is missing")))?;
            let value = line.strip_prefix(key).and_then(|v| v.trim().parse().ok());
            value.ok_or_else(|| Error::damaged(at, format!("expected `{key}` and a number")))
        };
        let n = field("#POINTS:")?;
        let closed = field("CLOSED:")? != 0;
        field("DRAW:")?;
        field("STATE:")?;
        if n > text.len() as u64 / MIN_LINE {
            return Err(Error::damaged(start, format!("{n} points do not fit into the file")));
        }
        let mut points = Vec::new();
        let mut offsets = Vec::new();
        for _ in 0..n {
            let (at, line) = lines
                .next()
                .ok_or_else(|| Error::new(ErrorKind::Truncated, text.len() as u64, "the file ends inside a path"))?;
            let point = point(line);
            points.push(point.ok_or_else(|| Error::damaged(at, "expected `TYPE: n X: x Y: y`"))?);
            offsets.push(at);
        }
        if !points.is_empty() {
            let offset = |i: usize| offsets.get(i).copied().unwrap_or(start);
            let strokes = split_strokes(&points, closed, &offset)?;
            paths.push(GimpPath { name: name.to_owned(), visible: false, strokes });
        }
    }
    Ok(())
}

/// Parses the line of a point.
fn point(line: &str) -> Option<TypedPoint> {
    let mut words = line.split_whitespace();
    let mut after = |key: &str| (words.next() == Some(key)).then(|| words.next()).flatten();
    let kind = after("TYPE:")?.parse().ok()?;
    let x: f64 = after("X:")?.parse().ok()?;
    let y: f64 = after("Y:")?.parse().ok()?;
    (x.is_finite() && y.is_finite()).then_some((kind, [x, y]))
}
