//! `PROP_VECTORS`, GIMP 2's paths, and the strokes that path items share with it.

use super::{Layout, Record, Xcf, coordinate, count, string, word};
use crate::error::Error;
use crate::input::Input;
use crate::path::{GimpPath, Stroke};

/// The one version there is.
const VERSION: u32 = 1;
/// A path without a name and without strokes.
const LEAST_PATH: u64 = 24;
/// A stroke without points.
const LEAST_STROKE: u64 = 16;
/// A parasite without a name and without data.
const LEAST_PARASITE: u64 = 12;
/// The one kind of stroke there is.
const BEZIER: u32 = 1;
const ANCHOR: u32 = 0;
const CONTROL: u32 = 1;
/// Points that are read at once.
const AT_ONCE: u32 = 4096;

/// Reads the property, whose length word GIMP checks.
pub(super) fn read(input: &mut Input<'_>, length: u64, xcf: &mut Xcf) -> Result<(), Error> {
    let (start, file_end) = (input.at(), input.end);
    // What a file promises beyond its end is missed where the reading gets there; paths before it are whole.
    let end = start.saturating_add(length);
    input.end = end.min(file_end);
    let read = paths(input, xcf);
    input.end = file_end;
    read.map_err(|e| if end < file_end { e.within(length, "PROP_VECTORS") } else { e })?;
    if input.at() != end {
        let found = input.at() - start;
        let problem = format!("PROP_VECTORS has {found} bytes of paths, but its length word says {length}");
        return Err(Error::at(start.saturating_sub(4), problem));
    }
    Ok(())
}

fn paths(input: &mut Input<'_>, xcf: &mut Xcf) -> Result<(), Error> {
    version(input)?;
    input.u32("PROP_VECTORS")?;
    for _ in 0..count(input, LEAST_PATH, "paths")? {
        let start = input.at();
        let name = string(input, "a path's name")?;
        input.skip(4, "a path's tattoo")?;
        let visible = input.u32("a path")? != 0;
        input.skip(4, "a path's link")?;
        let parasites = count(input, LEAST_PARASITE, "parasites of a path")?;
        let count_at = input.at();
        let n = count(input, LEAST_STROKE, "strokes of a path")?;
        for _ in 0..parasites {
            parasite(input)?;
        }
        let strokes_at = input.at();
        let strokes = strokes(input, n)?;
        xcf.records.push(Record {
            path: GimpPath { name, visible, strokes },
            span: start..input.at(),
            layout: Layout::Vectors { count_at, strokes_at },
        });
    }
    Ok(())
}

/// Paths have a version of their own.
pub(super) fn version(input: &mut Input<'_>) -> Result<(), Error> {
    let at = input.at();
    match input.u32("a path's version")? {
        VERSION => Ok(()),
        other => Err(Error::at(at, format!("paths of version {other} are unknown; the known version is {VERSION}"))),
    }
}

fn parasite(input: &mut Input<'_>) -> Result<(), Error> {
    let what = "a path's parasite";
    let name = u64::from(input.u32(what)?);
    input.skip(name, what)?;
    input.u32(what)?;
    let size = u64::from(input.u32(what)?);
    input.skip(size, what)
}

/// A path's strokes; those without points are passed over.
pub(super) fn strokes(input: &mut Input<'_>, n: u32) -> Result<Vec<Stroke>, Error> {
    let mut out = Vec::new();
    for _ in 0..n {
        let at = input.at();
        let kind = input.u32("a stroke")?;
        if kind != BEZIER {
            return Err(Error::at(
                at,
                format!("a stroke of kind {kind} is unknown; Bézier strokes are of kind {BEZIER}"),
            ));
        }
        let closed = input.u32("a stroke")? != 0;
        let at = input.at();
        let axes = input.u32("a stroke")?;
        if !(2..=6).contains(&axes) {
            return Err(Error::at(at, format!("points with {axes} axes; they have 2 to 6")));
        }
        let size = 4 + 4 * u64::from(axes);
        let at = input.at();
        let points = count(input, size, "points of a stroke")?;
        if !points.is_multiple_of(3) {
            let problem = format!("a stroke of {points} points; every anchor has three, itself and two handles");
            return Err(Error::at(at, problem));
        }
        let points = self::points(input, points, size)?;
        if !points.is_empty() {
            out.push(Stroke { closed, points });
        }
    }
    Ok(out)
}

fn points(input: &mut Input<'_>, n: u32, size: u64) -> Result<Vec<[f64; 2]>, Error> {
    let mut out: Vec<[f64; 2]> = Vec::new();
    let mut left = n;
    while left > 0 {
        let now = left.min(AT_ONCE);
        let start = input.at();
        let bytes = input.vec(u64::from(now) * size, "a stroke's points")?;
        for (i, p) in bytes.chunks_exact(usize::try_from(size).unwrap_or(usize::MAX)).enumerate() {
            let at = start + i as u64 * size;
            let kind = u32::from_be_bytes(word(p, 0));
            let expected = if out.len() % 3 == 1 { ANCHOR } else { CONTROL };
            if kind != expected {
                let problem = format!("point {} of a stroke is of kind {kind} where {expected} must be", out.len() + 1);
                return Err(Error::at(at, problem));
            }
            out.push([coordinate(word(p, 4), at + 4)?, coordinate(word(p, 8), at + 8)?]);
        }
        left -= now;
    }
    Ok(out)
}

/// The strokes as GIMP writes them: two axes.
pub(super) fn encode(strokes: &[Stroke]) -> Vec<u8> {
    let mut out = Vec::new();
    for s in strokes {
        // The number of points was bounded by 32 bits when it was read, and refitting cannot near that.
        let n = u32::try_from(s.points.len()).unwrap_or(u32::MAX);
        for word in [BEZIER, u32::from(s.closed), 2, n] {
            out.extend(word.to_be_bytes());
        }
        for (i, [x, y]) in s.points.iter().enumerate() {
            let kind = if i % 3 == 1 { ANCHOR } else { CONTROL };
            out.extend(kind.to_be_bytes());
            out.extend((*x as f32).to_be_bytes());
            out.extend((*y as f32).to_be_bytes());
        }
    }
    out
}
