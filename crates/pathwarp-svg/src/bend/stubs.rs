//! Closing lines that come from rounding: a subpath that returns to its start only nearly is closed by a line too short to write.

use pathwarp::Seg;
use pathwarp::kurbo::Point;
use pathwarp::outline::Subpath;

/// Returns `true` if a subpath is closed by a line not longer than `shortest`, after other segments.
pub(super) fn has_closing_stub(s: &Subpath, shortest: f64) -> bool {
    matches!(s.segs.as_slice(), [.., _, Seg::Line(stub)] if s.closed && stub.p0.distance(stub.p1) <= shortest)
}

/// Drops the closing line of a subpath if it is a stub. The segment before it then ends at the start.
pub(super) fn drop_closing_stub(s: &mut Subpath, shortest: f64) {
    if has_closing_stub(s, shortest) {
        s.segs.pop();
        if let Some(before) = s.segs.last_mut() {
            *end(before) = s.start;
        }
    }
}

/// The end of a segment.
fn end(s: &mut Seg) -> &mut Point {
    match s {
        Seg::Line(l) => &mut l.p1,
        Seg::Quad(q) => &mut q.p2,
        Seg::Cubic(c) => &mut c.p3,
        Seg::Arc(a) => &mut a.p1,
    }
}

#[cfg(test)]
mod tests;
