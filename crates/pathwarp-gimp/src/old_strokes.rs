//! Converts strokes from and to the order in which GIMP 1 lists points, in XCF files and in text.
//!
//! Every stroke starts with its anchor, followed by the outgoing handle of each anchor and the incoming handle of the next. Every
//! stroke but the last is closed, and an open stroke lacks its first handle.

use crate::error::Error;
use crate::path::Stroke;

pub(crate) const ANCHOR: u32 = 1;
pub(crate) const CONTROL: u32 = 2;
/// An anchor that starts a further stroke.
pub(crate) const NEW_STROKE: u32 = 3;

/// A point with its type.
pub(crate) type TypedPoint = (u32, [f64; 2]);

/// Splits the points of a path into strokes. `offset` returns the offset of a point in the file.
pub(crate) fn split_strokes(
    points: &[TypedPoint],
    closed: bool,
    offset: &dyn Fn(usize) -> u64,
) -> Result<Vec<Stroke>, Error> {
    let starts = points.iter().enumerate().filter(|(i, (kind, _))| *i == 0 || *kind == NEW_STROKE).map(|(i, _)| i);
    let bounds: Vec<usize> = starts.chain([points.len()]).collect();
    let mut out = Vec::with_capacity(bounds.len());
    for w in bounds.windows(2) {
        let run = &points[w[0]..w[1]];
        let closed = closed || w[1] < points.len();
        for (i, (kind, _)) in run.iter().enumerate() {
            let in_order = match i {
                0 => matches!(*kind, ANCHOR | NEW_STROKE),
                i if i % 3 == 0 => *kind == ANCHOR,
                _ => *kind == CONTROL,
            };
            if !in_order {
                let problem = format!("point {} of a path has type {kind}, which is out of order", w[0] + i + 1);
                return Err(Error::damaged(offset(w[0] + i), problem));
            }
        }
        let mut points: Vec<[f64; 2]> = run.iter().map(|(_, p)| *p).collect();
        match (closed, points.len() % 3) {
            // The last handle is the incoming handle of the first anchor.
            (true, 0) => points.rotate_right(1),
            // The incoming handle of the first anchor carries no geometry and is not stored.
            (false, 2) => points.insert(0, points[0]),
            _ => {
                let expected = if closed {
                    "a closed stroke must have a multiple of three"
                } else {
                    "an open stroke must have one less than a multiple of three"
                };
                return Err(Error::damaged(offset(w[0]), format!("{expected} points, but has {}", points.len())));
            }
        }
        out.push(Stroke { closed, points });
    }
    Ok(out)
}

/// Lists the points of a stroke in the order of GIMP 1, as a further stroke of a path.
pub(crate) fn list_points(s: &Stroke) -> Vec<TypedPoint> {
    let kind = |i: usize| match i {
        0 => NEW_STROKE,
        i if i % 3 == 0 => ANCHOR,
        _ => CONTROL,
    };
    let rest = s.points.iter().skip(1).copied().enumerate().map(|(i, p)| (kind(i), p));
    let first = s.points.first().filter(|_| s.closed).map(|p| (CONTROL, *p));
    rest.chain(first).collect()
}

/// Returns `true` if the form of GIMP 1 can hold the strokes: only the last may be open.
pub(crate) fn can_hold(strokes: &[Stroke]) -> bool {
    strokes.iter().rev().skip(1).all(|s| s.closed)
}
