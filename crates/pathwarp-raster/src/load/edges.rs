//! The edges of a shape as the renderer's scan lines meet them.

use tiny_skia::{PathSegment, Transform};
use usvg::{LineCap, LineJoin, Stroke};

/// Work for a row of pixels that an edge crosses, in four scan lines; for two edges in the same row, as they may cross; and for an edge.
const CROSSING: f64 = 4.0;
const BESIDE: f64 = 0.4;
const SEGMENT: f64 = 10.0;

/// Edges of an outline, with the rows and columns that they cross.
pub(super) struct Edges {
    count: f64,
    /// Sums over all edges, in pixels.
    rows: f64,
    columns: f64,
}

impl Edges {
    /// The edges of a path that is filled.
    pub(super) fn of(path: &tiny_skia::Path, transform: Transform, [width, height]: [f32; 2]) -> Self {
        let mut edges = Self { count: 0.0, rows: 0.0, columns: 0.0 };
        // Parts outside of the picture are cut off first.
        let within = |v: f32, size: f32| if v > 0.0 { f64::from(v.min(size)) } else { 0.0 };
        let place = |mut p: tiny_skia::Point| {
            transform.map_point(&mut p);
            [within(p.x, width), within(p.y, height)]
        };
        let (mut start, mut last) = ([0.0; 2], [0.0; 2]);
        for segment in path.segments() {
            // The control polygon crosses at least as many rows as the curve.
            match segment {
                PathSegment::MoveTo(p) => {
                    // An open subpath is filled as if it were closed.
                    edges.add(&[last, start]);
                    start = place(p);
                    last = start;
                    continue;
                }
                PathSegment::LineTo(p) => last = edges.add(&[last, place(p)]),
                PathSegment::QuadTo(a, p) => last = edges.add(&[last, place(a), place(p)]),
                PathSegment::CubicTo(a, b, p) => last = edges.add(&[last, place(a), place(b), place(p)]),
                PathSegment::Close => last = edges.add(&[last, start]),
            }
            edges.count += 1.0;
        }
        edges.add(&[last, start]);
        edges
    }

    /// Adds a polygon, and returns its end.
    fn add<const N: usize>(&mut self, polygon: &[[f64; 2]; N]) -> [f64; 2] {
        for p in polygon.windows(2) {
            self.columns += (p[1][0] - p[0][0]).abs();
            self.rows += (p[1][1] - p[0][1]).abs();
        }
        polygon[N - 1]
    }

    /// The outline of a stroke of `width` pixels along these edges: two sides, and a join or a cap at every node, which is as high as the
    /// stroke is wide.
    pub(super) fn stroked(&self, nodes: usize, stroke: &Stroke, width: f64, picture: [f32; 2]) -> Self {
        let nodes = nodes as f64;
        let round = stroke.linejoin() == LineJoin::Round || stroke.linecap() == LineCap::Round;
        let (edges, sides) = if round { (8.0, 4.0) } else { (2.0, 2.0) };
        let around = |size: f32| sides * width.min(f64::from(size)) * nodes;
        Self {
            count: 2.0 * self.count + edges * nodes,
            rows: 2.0 * self.rows + around(picture[1]),
            columns: 2.0 * self.columns + around(picture[0]),
        }
    }

    /// The work of filling the outline, which has this size as far as it is seen.
    pub(super) fn work(&self, [width, height]: [f64; 2]) -> f64 {
        let beside = self.rows / height.max(1.0);
        // Edges change places in a row only where their columns overlap.
        let overlap = (2.0 * self.columns / (self.count.max(1.0) * width.max(1.0))).min(1.0);
        SEGMENT * self.count + CROSSING * self.rows + BESIDE * self.count.min(self.rows) * beside * overlap
    }
}
