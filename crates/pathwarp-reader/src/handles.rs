//! Handles that lie on their nodes. They leave a curve's direction to the next handle; usvg's markers take the next node instead.

use std::fmt::Write as _;
use svgtypes::{PathParser, PathSegment};

/// How far such a handle is moved towards the next one, in parts of the way: the curve stays within half of that.
const STEP: f64 = 1e-4;

/// Path data with handles off their nodes. `None` if there are none on them, or the data are damaged.
pub(super) fn off_nodes(data: &str) -> Option<String> {
    let (mut at, mut start, mut handle) = ([0.0; 2], [0.0; 2], None);
    let mut out = String::new();
    let mut changed = false;
    for segment in PathParser::from(data) {
        let segment = segment.ok()?;
        let before = at;
        let place = |abs: bool, x: f64, y: f64| if abs { [x, y] } else { [before[0] + x, before[1] + y] };
        let mut next_handle = None;
        let curve = match segment {
            PathSegment::MoveTo { abs, x, y } => {
                at = place(abs, x, y);
                start = at;
                None
            }
            PathSegment::LineTo { abs, x, y }
            | PathSegment::Quadratic { abs, x, y, .. }
            | PathSegment::EllipticalArc { abs, x, y, .. } => {
                at = place(abs, x, y);
                None
            }
            // Their handle depends on what is before.
            PathSegment::SmoothQuadratic { .. } => return None,
            PathSegment::HorizontalLineTo { abs, x } => {
                at[0] = if abs { x } else { before[0] + x };
                None
            }
            PathSegment::VerticalLineTo { abs, y } => {
                at[1] = if abs { y } else { before[1] + y };
                None
            }
            PathSegment::CurveTo { abs, x1, y1, x2, y2, x, y } => {
                Some([place(abs, x1, y1), place(abs, x2, y2), place(abs, x, y)])
            }
            PathSegment::SmoothCurveTo { abs, x2, y2, x, y } => {
                let first = handle.map_or(before, |h: [f64; 2]| [2.0 * before[0] - h[0], 2.0 * before[1] - h[1]]);
                Some([first, place(abs, x2, y2), place(abs, x, y)])
            }
            PathSegment::ClosePath { .. } => {
                at = start;
                None
            }
        };
        if let Some([mut p1, mut p2, p3]) = curve {
            let towards = |from: [f64; 2], to: [f64; 2]| [0, 1].map(|i| from[i] + STEP * (to[i] - from[i]));
            let (old1, old2) = (p1, p2);
            next_handle = Some(p2);
            if old1 == before {
                p1 = towards(before, if old2 == before { p3 } else { old2 });
            }
            if old2 == p3 {
                p2 = towards(p3, if old1 == p3 { before } else { old1 });
            }
            changed |= p1 != old1 || p2 != old2;
            at = p3;
            let _ = write!(out, "C{} {} {} {} {} {}", p1[0], p1[1], p2[0], p2[1], p3[0], p3[1]);
        } else {
            // In coordinates of the drawing, as what was relative before no longer is to the same.
            let _ = match segment {
                PathSegment::MoveTo { .. } => write!(out, "M{} {}", at[0], at[1]),
                PathSegment::ClosePath { .. } => write!(out, "Z"),
                PathSegment::Quadratic { abs, x1, y1, .. } => {
                    let p = place(abs, x1, y1);
                    write!(out, "Q{} {} {} {}", p[0], p[1], at[0], at[1])
                }
                PathSegment::EllipticalArc { rx, ry, x_axis_rotation, large_arc, sweep, .. } => {
                    let (large, sweep) = (u8::from(large_arc), u8::from(sweep));
                    write!(out, "A{rx} {ry} {x_axis_rotation} {large} {sweep} {} {}", at[0], at[1])
                }
                _ => write!(out, "L{} {}", at[0], at[1]),
            };
        }
        handle = next_handle;
    }
    changed.then_some(out)
}

#[cfg(test)]
mod tests {
    use super::off_nodes;

    #[test]
    fn handles_move_a_little() {
        assert_eq!(off_nodes("M0 0C0 0 100 0 100 100"), Some("M0 0C0.01 0 100 0 100 100".into()));
        assert_eq!(off_nodes("m10 0h10c0 10 0 20 0 20z"), Some("M10 0L20 0C20 10 20 19.999 20 20Z".into()));
        assert_eq!(off_nodes("M0 0s0 100 100 100"), Some("M0 0C0 0.01 0 100 100 100".into()));
        for plain in ["M0 0C1 0 100 0 100 100", "M0 0L1 1z", "M0 0C0 0 x"] {
            assert_eq!(off_nodes(plain), None, "{plain}");
        }
    }
}
