//! Reads and encodes `PROP_PATHS`, the paths of GIMP 1.

use super::model::{PathLayout, PathRecord, Xcf};
use super::primitives::{coordinate, count, push_point, push_words, string};
use crate::error::Error;
use crate::old_strokes::{ANCHOR, NEW_STROKE, TypedPoint, list_points, split_strokes};
use crate::path::{GimpPath, Stroke};
use crate::source::ByteSource;

/// Size of a path of format 1 without a name and points.
const MIN_PATH: u64 = 21;
/// Size of a point: its type and two coordinates.
const POINT: u64 = 12;
/// State byte of a closed path.
const CLOSED: u8 = 4;
/// State byte of an open path.
const OPEN: u8 = 2;

/// Reads the property. GIMP ignores its length word, which some programs write wrong.
pub(super) fn read(input: &mut ByteSource<'_>, xcf: &mut Xcf) -> Result<(), Error> {
    input.u32("PROP_PATHS")?;
    for _ in 0..count(input, MIN_PATH, "paths")? {
        let start = input.offset();
        let name = string(input, "a path's name")?;
        // The lock, then the state, which the next flag repeats.
        input.u32("a path")?;
        let state_at = input.offset();
        input.u8("a path")?;
        let closed = input.u32("a path")? != 0;
        let count_at = input.offset();
        let n = count(input, POINT, "points of a path")?;
        let at = input.offset();
        let format = input.u32("a path")?;
        if !(1..=3).contains(&format) {
            let problem = format!("a path of format {format} is unknown; 1, 2 and 3 are known");
            return Err(Error::unsupported(at, problem));
        }
        // Formats 2 and 3 have a word that is always 1, and format 3 the tattoo.
        if format > 1 {
            input.u32("a path")?;
        }
        let tattoo = if format == 3 { Some(input.u32("a path")?) } else { None };
        let points_at = input.offset();
        let size = u64::from(n) * POINT;
        input.need(size, count_at, || format!("{n} points of a path need {size} bytes"))?;
        let points = points(input, n, format == 1)?;
        // GIMP stops at a path without points, but later paths are sound.
        if !points.is_empty() {
            let strokes = split_strokes(&points, closed, &|i| points_at + (i as u64 * POINT))?;
            xcf.records.push(PathRecord {
                path: GimpPath { name, visible: false, strokes },
                span: start..input.offset(),
                layout: PathLayout::Old { state_at, tattoo },
            });
        }
    }
    Ok(())
}

/// Reads the points of a path in the order of the file. Format 1 stores them as whole numbers.
fn points(input: &mut ByteSource<'_>, n: u32, whole: bool) -> Result<Vec<TypedPoint>, Error> {
    let mut out = Vec::new();
    for _ in 0..n {
        let at = input.offset();
        let kind = input.u32("a path's points")?;
        if !(ANCHOR..=NEW_STROKE).contains(&kind) {
            let problem = format!("a point has type {kind}; it must be 1 (anchor), 2 (handle) or 3 (new stroke)");
            return Err(Error::damaged(at, problem));
        }
        let mut read = |at: u64| {
            let w = input.u32("a path's points")?.to_be_bytes();
            if whole { Ok(f64::from(i32::from_be_bytes(w))) } else { coordinate(w, at) }
        };
        out.push((kind, [read(at + 4)?, read(at + 8)?]));
    }
    Ok(out)
}

/// Encodes a path, from its state byte to its last point, in a format that keeps fractions.
pub(super) fn encode(strokes: &[Stroke], tattoo: Option<u32>) -> Vec<u8> {
    let closed = strokes.last().is_none_or(|s| s.closed);
    let points: Vec<TypedPoint> = strokes.iter().flat_map(list_points).collect();
    let mut out = vec![if closed { CLOSED } else { OPEN }];
    let format = if tattoo.is_some() { 3 } else { 2 };
    // After the format, a word that is always 1, and in format 3 the tattoo.
    push_words(&mut out, &[u32::from(closed), points.len() as u32, format, 1]);
    push_words(&mut out, tattoo.as_slice());
    for (i, (kind, point)) in points.iter().enumerate() {
        push_point(&mut out, if i == 0 { ANCHOR } else { *kind }, *point);
    }
    out
}
