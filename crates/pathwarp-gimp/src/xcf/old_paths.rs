//! `PROP_PATHS`, GIMP 1's paths: every stroke but the last is closed, and open ones lack their first handle.

use super::{Layout, Record, Xcf, coordinate, count, string};
use crate::error::Error;
use crate::input::Input;
use crate::path::{GimpPath, Stroke};

/// A path of format 1 without a name and without points.
const LEAST_PATH: u64 = 21;
/// A point: its type and two coordinates.
const POINT: u64 = 12;
const ANCHOR: u32 = 1;
const CONTROL: u32 = 2;
const NEW_STROKE: u32 = 3;
/// The state byte of closed and of open paths.
const CLOSED: u8 = 4;
const OPEN: u8 = 2;

/// Reads the property. Its length word says nothing: GIMP ignores it, and so have writers.
pub(super) fn read(input: &mut Input<'_>, xcf: &mut Xcf) -> Result<(), Error> {
    input.u32("PROP_PATHS")?;
    for _ in 0..count(input, LEAST_PATH, "paths")? {
        let start = input.at();
        let name = string(input, "a path's name")?;
        input.u32("a path")?;
        let state_at = input.at();
        input.u8("a path")?;
        let closed = input.u32("a path")? != 0;
        let count_at = input.at();
        let n = count(input, POINT, "points of a path")?;
        let at = input.at();
        let format = input.u32("a path")?;
        let mut tattoo = None;
        match format {
            1 => {}
            2 => drop(input.u32("a path")?),
            3 => {
                input.u32("a path")?;
                tattoo = Some(input.u32("a path")?);
            }
            other => return Err(Error::at(at, format!("a path of format {other} is unknown; known are 1, 2 and 3"))),
        }
        let points_at = input.at();
        if u64::from(n) * POINT > input.left() {
            let left = input.left();
            return Err(Error::at(count_at, format!("{n} points of a path need more than the {left} bytes left")));
        }
        let points = points(input, n, format == 1)?;
        // GIMP gives up at a path without points; the ones behind it are as good as any.
        if !points.is_empty() {
            let strokes = strokes(&points, closed, &|i| points_at + i as u64 * POINT)?;
            xcf.records.push(Record {
                path: GimpPath { name, visible: false, strokes },
                span: start..input.at(),
                layout: Layout::Old { state_at, tattoo },
            });
        }
    }
    Ok(())
}

/// The points of a path, as listed.
fn points(input: &mut Input<'_>, n: u32, whole: bool) -> Result<Vec<(u32, [f64; 2])>, Error> {
    let mut out = Vec::new();
    for _ in 0..n {
        let at = input.at();
        let kind = input.u32("a path's points")?;
        if !(ANCHOR..=NEW_STROKE).contains(&kind) {
            return Err(Error::at(
                at,
                format!("a point of kind {kind}; there are 1 (anchor), 2 (handle) and 3 (new stroke)"),
            ));
        }
        let mut read = |at: u64| {
            let w = input.u32("a path's points")?.to_be_bytes();
            if whole { Ok(f64::from(i32::from_be_bytes(w))) } else { coordinate(w, at) }
        };
        out.push((kind, [read(at + 4)?, read(at + 8)?]));
    }
    Ok(out)
}

/// Points as GIMP 1 lists them (type and place, the anchor before its handles), as strokes. `at` tells where a point stands.
pub(crate) fn strokes(
    points: &[(u32, [f64; 2])],
    closed: bool,
    at: &dyn Fn(usize) -> u64,
) -> Result<Vec<Stroke>, Error> {
    let starts = points.iter().enumerate().filter(|(i, (kind, _))| *i == 0 || *kind == NEW_STROKE).map(|(i, _)| i);
    let starts: Vec<usize> = starts.chain([points.len()]).collect();
    let mut out = Vec::with_capacity(starts.len());
    for (k, w) in starts.windows(2).enumerate() {
        let run = &points[w[0]..w[1]];
        let closed = closed || k + 2 < starts.len();
        for (i, (kind, _)) in run.iter().enumerate() {
            let fits = match i {
                0 => matches!(*kind, ANCHOR | NEW_STROKE),
                i if i % 3 == 0 => *kind == ANCHOR,
                _ => *kind == CONTROL,
            };
            if !fits {
                let problem = format!("point {} of a path is of kind {kind}, out of order", w[0] + i + 1);
                return Err(Error::at(at(w[0] + i), problem));
            }
        }
        let mut points: Vec<[f64; 2]> = run.iter().map(|(_, p)| *p).collect();
        match (closed, points.len() % 3) {
            // The last handle is the first anchor's incoming one.
            (true, 0) => points.rotate_right(1),
            // The first anchor's incoming handle carries no geometry and is not stored.
            (false, 2) => points.insert(0, points[0]),
            _ => {
                let what = if closed { "closed stroke of 3n" } else { "open stroke of 3n - 1" };
                return Err(Error::at(at(w[0]), format!("a {what} points has {}", points.len())));
            }
        }
        out.push(Stroke { closed, points });
    }
    Ok(out)
}

/// The tail of a path: from its state byte on, in the format that keeps fractions.
pub(super) fn encode(strokes: &[Stroke], tattoo: Option<u32>) -> Vec<u8> {
    let closed = strokes.last().is_none_or(|s| s.closed);
    let listed: Vec<(u32, [f64; 2])> = strokes.iter().flat_map(listed).collect();
    let mut out = vec![if closed { CLOSED } else { OPEN }];
    out.extend(u32::from(closed).to_be_bytes());
    out.extend(u32::try_from(listed.len()).unwrap_or(u32::MAX).to_be_bytes());
    // A format, a word that is always 1, and in format 3 the tattoo.
    let format: u32 = if tattoo.is_some() { 3 } else { 2 };
    for word in [format, 1].into_iter().chain(tattoo) {
        out.extend(word.to_be_bytes());
    }
    for (i, (kind, [x, y])) in listed.iter().enumerate() {
        let kind = if i == 0 { ANCHOR } else { *kind };
        out.extend(kind.to_be_bytes());
        out.extend((*x as f32).to_be_bytes());
        out.extend((*y as f32).to_be_bytes());
    }
    out
}

/// A stroke's points in the old order.
fn listed(s: &Stroke) -> Vec<(u32, [f64; 2])> {
    let kind = |i: usize| match i {
        0 => NEW_STROKE,
        i if i % 3 == 0 => ANCHOR,
        _ => CONTROL,
    };
    let rest = s.points.iter().skip(1).copied().enumerate().map(|(i, p)| (kind(i), p));
    let first = s.points.first().filter(|_| s.closed).map(|p| (CONTROL, *p));
    rest.chain(first).collect()
}

/// Whether the old form can hold these strokes: only the last may be open.
pub(super) fn holds(strokes: &[Stroke]) -> bool {
    strokes.iter().rev().skip(1).all(|s| s.closed)
}
