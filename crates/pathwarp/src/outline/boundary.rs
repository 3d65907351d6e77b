//! The boundary of a filled path as lines.

use kurbo::{PathEl, Point};

/// Calls `line` with the ends of every line of a path that is flattened within `tolerance`, in order. Open subpaths are closed by a
/// line, as SVG fills them. Lines without length may be among them.
pub fn boundary(path: impl IntoIterator<Item = PathEl>, tolerance: f64, mut line: impl FnMut(Point, Point)) {
    let (mut start, mut at) = (Point::ORIGIN, Point::ORIGIN);
    kurbo::flatten(path, tolerance, |element| match element {
        PathEl::MoveTo(p) => {
            line(at, start);
            (start, at) = (p, p);
        }
        PathEl::LineTo(p) => {
            line(at, p);
            at = p;
        }
        PathEl::ClosePath => {
            line(at, start);
            at = start;
        }
        // Flattened paths have no curves.
        PathEl::QuadTo(..) | PathEl::CurveTo(..) => {}
    });
    line(at, start);
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::BezPath;

    /// The area within the lines is that of the path, closed.
    #[test]
    fn subpaths_are_closed() {
        let path = BezPath::from_svg("M0,0 H10 V10 H0 M20,0 Q40,0 40,20 V0 Z").unwrap();
        let mut area = 0.0;
        boundary(path, 1e-3, |a, b| area += 0.5 * a.to_vec2().cross(b.to_vec2()));
        // A parabola leaves a third of the triangle of its control points, which runs the other way.
        assert!((area - (100.0 - 200.0 / 3.0)).abs() < 0.05, "{area}");
    }
}
