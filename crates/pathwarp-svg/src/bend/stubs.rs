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
mod tests {
    use super::*;
    use pathwarp::Outline;

    #[test]
    fn only_stubs_are_dropped() {
        for (d, shortest, segments) in [
            ("M0 0C5 5 9 5 9 0L1e-9 1e-9Z", 1e-6, 2),
            ("M0 0C5 5 9 5 9 0L1e-9 1e-9Z", 1e-10, 3),
            ("M0 0C5 5 9 5 9 0L1e-9 1e-9", 1e-6, 2),
            ("M0 0C5 5 9 5 9 0Z", 1e-6, 2),
            ("M0 0A5 5 0 0 1 9 1A5 5 0 0 1 1e-9 1e-9Z", 1e-6, 2),
            ("M0 0L1e-9 0Z", 1e-6, 1),
        ] {
            let mut s = Outline::from_svg_lossy(d).subpaths.remove(0);
            drop_closing_stub(&mut s, shortest);
            assert_eq!(s.segs.len(), segments, "{d}");
            assert!(!s.closed || s.end() == s.start, "{d}");
        }
    }
}
