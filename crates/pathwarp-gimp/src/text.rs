//! The text of GIMP 1's "Export path": records of a name, a count, flags, and a line for every point.

use crate::error::Error;
use crate::path::GimpPath;
use crate::xcf::old_strokes;

pub(crate) const FIRST: &[u8] = b"Name: ";

/// Reads all records; those before a fault stay in `paths`.
pub(crate) fn read(text: &str, paths: &mut Vec<GimpPath>) -> Result<(), Error> {
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
        let name = line.strip_prefix("Name: ").ok_or_else(|| Error::at(start, "`Name: …` must stand here"))?;
        let mut field = |key: &str| -> Result<u64, Error> {
            let (at, line) = lines.next().ok_or_else(|| Error::at(text.len() as u64, format!("`{key}` is missing")))?;
            let value = line.strip_prefix(key).and_then(|v| v.trim().parse().ok());
            value.ok_or_else(|| Error::at(at, format!("`{key}` and a number must stand here")))
        };
        let n = field("#POINTS:")?;
        let closed = field("CLOSED:")? != 0;
        field("DRAW:")?;
        field("STATE:")?;
        // The shortest line of a point takes more.
        const LEAST: u64 = 16;
        if n > text.len() as u64 / LEAST {
            return Err(Error::at(start, format!("{n} points are more than the file can hold")));
        }
        let mut points = Vec::new();
        let mut places = Vec::new();
        for _ in 0..n {
            let (at, line) = lines.next().ok_or_else(|| Error::at(text.len() as u64, "the file ends inside a path"))?;
            let point = point(line);
            points.push(point.ok_or_else(|| Error::at(at, "`TYPE: n X: x Y: y` must stand here"))?);
            places.push(at);
        }
        if !points.is_empty() {
            let place = |i: usize| places.get(i).copied().unwrap_or(start);
            let strokes = old_strokes(&points, closed, &place)?;
            paths.push(GimpPath { name: name.to_owned(), visible: false, strokes });
        }
    }
    Ok(())
}

fn point(line: &str) -> Option<(u32, [f64; 2])> {
    let mut words = line.split_whitespace();
    let mut after = |key: &str| (words.next() == Some(key)).then(|| words.next()).flatten();
    let kind = after("TYPE:")?.parse().ok()?;
    let x: f64 = after("X:")?.parse().ok()?;
    let y: f64 = after("Y:")?.parse().ok()?;
    (x.is_finite() && y.is_finite()).then_some((kind, [x, y]))
}
