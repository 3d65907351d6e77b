//! The edges of a shape as the renderer's scan lines meet them.

use tiny_skia::{PathSegment, Transform};
use usvg::{LineCap, LineJoin, Stroke};

/// Work for a row of pixels that an edge crosses, in four scan lines; for two edges in the same row, as one that begins is looked
/// for among those that are there; and for an edge.
const CROSSING: f64 = 4.0;
const BESIDE: f64 = 0.4;
const SEGMENT: f64 = 10.0;

/// Edges of an outline, with the rows that they cross.
pub(super) struct Edges {
    count: f64,
    /// Rows crossed, summed over all edges.
    rows: f64,
}

impl Edges {
    pub(super) fn of_fill(path: &tiny_skia::Path, transform: Transform, height: f32) -> Self {
        let mut edges = Self { count: 0.0, rows: 0.0 };
        // Parts above and below the picture are cut off first.
        let y = |p: tiny_skia::Point| {
            let y = transform.ky * p.x + transform.sy * p.y + transform.ty;
            if y > 0.0 { f64::from(y.min(height)) } else { 0.0 }
        };
        let (mut start, mut last) = (0.0, 0.0);
        for segment in path.segments() {
            // The control polygon crosses at least as many rows as the curve.
            let (points, end) = match segment {
                PathSegment::MoveTo(p) => {
                    // An open subpath is filled as if it were closed.
                    edges.rows += f64::abs(start - last);
                    (start, last) = (y(p), y(p));
                    continue;
                }
                PathSegment::LineTo(p) => ([last; 2], y(p)),
                PathSegment::QuadTo(a, p) => ([last, y(a)], y(p)),
                PathSegment::CubicTo(a, b, p) => ([y(a), y(b)], y(p)),
                PathSegment::Close => ([last; 2], start),
            };
            edges.rows += (points[0] - last).abs() + (points[1] - points[0]).abs() + (end - points[1]).abs();
            edges.count += 1.0;
            last = end;
        }
        edges.rows += f64::abs(start - last);
        edges
    }

    /// The outline of a stroke of `width` pixels: two sides, and a join or a cap at every node, which is as high as the stroke is wide.
    pub(super) fn of_stroke(
        path: &tiny_skia::Path,
        stroke: &Stroke,
        width: f64,
        transform: Transform,
        height: f32,
    ) -> Self {
        let line = Self::of_fill(path, transform, height);
        let nodes = path.len() as f64;
        let round = stroke.linejoin() == LineJoin::Round || stroke.linecap() == LineCap::Round;
        let (edges, sides) = if round { (8.0, 4.0) } else { (2.0, 2.0) };
        let width = width.min(f64::from(height));
        Self { count: 2.0 * line.count + edges * nodes, rows: 2.0 * line.rows + sides * width * nodes }
    }

    /// The work of filling the outline, which is `height` pixels high as far as it is seen.
    pub(super) fn work(&self, height: f64) -> f64 {
        let beside = self.rows / height.max(1.0);
        SEGMENT * self.count + CROSSING * self.rows + BESIDE * self.count.min(self.rows) * beside
    }
}
