//! Reads `PROP_VECTORS`, the paths of GIMP 2, and encodes strokes, also for path items.

use super::model::{PathLayout, PathRecord, Xcf};
use super::primitives::{coordinate, count, push_point, push_words, string};
use crate::error::Error;
use crate::path::{GimpPath, Stroke};
use crate::source::ByteSource;

/// The only version.
const VERSION: u32 = 1;
/// Size of a path without a name and strokes.
const MIN_PATH: u64 = 24;
/// Size of a stroke without points.
pub(super) const MIN_STROKE: u64 = 16;
/// Size of a parasite without a name and data.
const MIN_PARASITE: u64 = 12;
/// The only type of stroke.
const BEZIER: u32 = 1;
const ANCHOR: u32 = 0;
const CONTROL: u32 = 1;
/// Number of points read at a time.
const CHUNK: u32 = 4096;

/// Reads the property. GIMP checks its length word.
pub(super) fn read(input: &mut ByteSource<'_>, length: u64, xcf: &mut Xcf) -> Result<(), Error> {
    let start = input.offset();
    // A property that claims to extend past the file is read up to the file's end, so that its first paths are salvaged.
    input.limited(length, "PROP_VECTORS", |input| paths(input, xcf))?;
    let found = input.offset() - start;
    if found != length {
        let problem = format!("PROP_VECTORS holds {found} bytes of paths, but its length word says {length}");
        return Err(Error::damaged(start.saturating_sub(4), problem));
    }
    Ok(())
}

fn paths(input: &mut ByteSource<'_>, xcf: &mut Xcf) -> Result<(), Error> {
    version(input)?;
    // The index of the active path.
    input.u32("PROP_VECTORS")?;
    for _ in 0..count(input, MIN_PATH, "paths")? {
        let start = input.offset();
        let name = string(input, "a path's name")?;
        input.skip(4, "a path's tattoo")?;
        let visible = input.u32("a path")? != 0;
        input.skip(4, "a path's link")?;
        let parasites = count(input, MIN_PARASITE, "parasites of a path")?;
        let count_at = input.offset();
        let n = count(input, MIN_STROKE, "strokes of a path")?;
        for _ in 0..parasites {
            parasite(input)?;
        }
        let strokes_at = input.offset();
        let strokes = strokes(input, n)?;
        xcf.records.push(PathRecord {
            path: GimpPath { name, visible, strokes },
            span: start..input.offset(),
            layout: PathLayout::Vectors { count_at, strokes_at },
        });
    }
    Ok(())
}

pub(super) fn version(input: &mut ByteSource<'_>) -> Result<(), Error> {
    let at = input.offset();
    match input.u32("a path's version")? {
        VERSION => Ok(()),
        other => Err(Error::unsupported(at, format!("path version {other} is unknown; only {VERSION} is known"))),
    }
}

fn parasite(input: &mut ByteSource<'_>) -> Result<(), Error> {
    let what = "a path's parasite";
    let name = u64::from(input.u32(what)?);
    input.skip(name, what)?;
    input.u32(what)?;
    let size = u64::from(input.u32(what)?);
    input.skip(size, what)
}

/// Reads the strokes of a path, leaving out those without points.
pub(super) fn strokes(input: &mut ByteSource<'_>, n: u32) -> Result<Vec<Stroke>, Error> {
    let mut out = Vec::new();
    for _ in 0..n {
        let at = input.offset();
        let kind = input.u32("a stroke")?;
        if kind != BEZIER {
            let problem = format!("a stroke of type {kind} is unknown; Bézier strokes have type {BEZIER}");
            return Err(Error::damaged(at, problem));
        }
        let closed = input.u32("a stroke")? != 0;
        let at = input.offset();
        let axes = input.u32("a stroke")?;
        if !(2..=6).contains(&axes) {
            return Err(Error::damaged(at, format!("points with {axes} axes; 2 to 6 are possible")));
        }
        let size = 4 + 4 * u64::from(axes);
        let at = input.offset();
        let points = count(input, size, "points of a stroke")?;
        if !points.is_multiple_of(3) {
            let problem =
                format!("a stroke has {points} points, not a multiple of three (every anchor has two handles)");
            return Err(Error::damaged(at, problem));
        }
        let points = self::points(input, points, size)?;
        if !points.is_empty() {
            out.push(Stroke { closed, points });
        }
    }
    Ok(out)
}

/// Reads `n` points of `size` bytes: a type, x, y, and other axes such as pressure, which are skipped.
fn points(input: &mut ByteSource<'_>, n: u32, size: u64) -> Result<Vec<[f64; 2]>, Error> {
    let mut out: Vec<[f64; 2]> = Vec::new();
    let mut left = n;
    while left > 0 {
        let now = left.min(CHUNK);
        let start = input.offset();
        let bytes = input.vec(u64::from(now) * size, "a stroke's points")?;
        for (i, p) in bytes.chunks_exact(size as usize).enumerate() {
            let at = start + i as u64 * size;
            let words = p.as_chunks().0;
            let kind = u32::from_be_bytes(words[0]);
            let expected = if out.len() % 3 == 1 { ANCHOR } else { CONTROL };
            if kind != expected {
                let problem = format!("point {} of a stroke has type {kind} instead of {expected}", out.len() + 1);
                return Err(Error::damaged(at, problem));
            }
            out.push([coordinate(words[1], at + 4)?, coordinate(words[2], at + 8)?]);
        }
        left -= now;
    }
    Ok(out)
}

/// Encodes strokes as GIMP writes them, with two axes.
pub(super) fn encode(strokes: &[Stroke]) -> Vec<u8> {
    let mut out = Vec::new();
    for s in strokes {
        // Points read from a file were counted in 32 bits, and refitting makes far fewer.
        push_words(&mut out, &[BEZIER, u32::from(s.closed), 2, s.points.len() as u32]);
        for (i, point) in s.points.iter().enumerate() {
            push_point(&mut out, if i % 3 == 1 { ANCHOR } else { CONTROL }, *point);
        }
    }
    out
}
