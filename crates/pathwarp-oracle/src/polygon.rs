//! Edges in a tree of boxes, for distances from points and winding numbers.

use kurbo::{Point, Rect, Vec2};

/// Edges in a leaf of the tree.
const LEAF: usize = 4;

/// Edges. Where they form closed rings, they bound an area by the nonzero rule.
pub struct Polygon {
    pub edges: Vec<[Point; 2]>,
    /// The box of node `i` holds the boxes of nodes `2i` and `2i + 1`; the root is 1, and the last half are leaves.
    boxes: Vec<Rect>,
}

impl Polygon {
    /// Builds the tree over these edges.
    pub fn new(edges: Vec<[Point; 2]>) -> Self {
        let leaves = edges.len().div_ceil(LEAF).next_power_of_two();
        let nothing = Rect::new(f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY);
        let mut boxes = vec![nothing; 2 * leaves];
        for (leaf, edges) in boxes[leaves..].iter_mut().zip(edges.chunks(LEAF)) {
            *leaf = edges.iter().flatten().fold(nothing, |b, p| b.union_pt(*p));
        }
        for i in (1..leaves).rev() {
            boxes[i] = boxes[2 * i].union(boxes[2 * i + 1]);
        }
        Self { edges, boxes }
    }

    /// The polygon of rings of points, which are closed.
    pub fn of_rings<'a>(rings: impl IntoIterator<Item = &'a [Point]>) -> Self {
        let closed = |r: &'a [Point]| (0..r.len()).map(|i| [r[i], r[(i + 1) % r.len()]]);
        Self::new(rings.into_iter().flat_map(closed).collect())
    }

    /// The winding number about a point, by the edges that cross the horizontal line to its right.
    pub fn winding(&self, p: Point) -> i32 {
        let (leaves, mut turns, mut open) = (self.boxes.len() / 2, 0, vec![1]);
        while let Some(node) = open.pop() {
            let b = self.boxes[node];
            if p.y < b.y0 || p.y > b.y1 || p.x > b.x1 {
                continue;
            }
            if node < leaves {
                open.extend([2 * node, 2 * node + 1]);
                continue;
            }
            for [a, b] in self.edges.iter().skip((node - leaves) * LEAF).take(LEAF) {
                let is_left = (p.y - a.y) * (b.x - a.x) < (p.x - a.x) * (b.y - a.y);
                turns += match (a.y <= p.y, b.y <= p.y) {
                    (true, false) if !is_left => 1,
                    (false, true) if is_left => -1,
                    _ => 0,
                };
            }
        }
        turns
    }

    /// Returns `true` if the area holds a point.
    pub fn covers(&self, p: Point) -> bool {
        self.winding(p) != 0
    }

    /// The distance of a point from the edges, and the nearest edge.
    pub fn nearest(&self, p: Point) -> (f64, usize) {
        let mut best = (f64::INFINITY, 0);
        self.search(p, f64::INFINITY, |i, d| {
            if d < best.0 {
                best = (d, i);
            }
            best.0
        });
        best
    }

    /// The distance of a point from the edges.
    pub fn distance(&self, p: Point) -> f64 {
        self.nearest(p).0
    }

    /// The distance of a point from the area.
    pub fn outside(&self, p: Point) -> f64 {
        if self.covers(p) { 0.0 } else { self.distance(p) }
    }

    /// The largest distance of a corner of one area from the other area.
    pub fn apart(&self, other: &Self) -> f64 {
        let one = |a: &Self, b: &Self| a.edges.iter().flatten().map(|p| b.outside(*p)).fold(0.0, f64::max);
        one(self, other).max(one(other, self))
    }

    /// Pairs of edges that cross, each ending at least `by` beyond the other.
    pub fn crossings(&self, by: f64) -> usize {
        let across = |[a, b]: [Point; 2], other: [Point; 2]| {
            let [s, t] = other.map(|p| (b - a).cross(p - a) / (b - a).hypot());
            s * t < 0.0 && s.abs().min(t.abs()) > by
        };
        let mut count = 0;
        for (i, e) in self.edges.iter().enumerate() {
            let within = 0.5 * e[0].distance(e[1]);
            self.search(e[0].midpoint(e[1]), within, |k, _| {
                count += usize::from(k < i && across(*e, self.edges[k]) && across(self.edges[k], *e));
                within
            });
        }
        count
    }

    /// The polygon whose corners are the images of these corners.
    pub fn mapped(&self, image: impl Fn(Point) -> Point) -> Self {
        Self::new(self.edges.iter().map(|e| e.map(&image)).collect())
    }

    /// Calls `visit` with each edge that may be nearer to a point than `within`, and its distance. `visit` returns a new `within`.
    pub(crate) fn search(&self, p: Point, mut within: f64, mut visit: impl FnMut(usize, f64) -> f64) {
        let leaves = self.boxes.len() / 2;
        let distance_squared = |node: usize| {
            let b = self.boxes[node];
            Vec2::new((b.x0 - p.x).max(p.x - b.x1).max(0.0), (b.y0 - p.y).max(p.y - b.y1).max(0.0)).hypot2()
        };
        // A stack of nodes: one more for each level of the tree.
        let mut open = [(1, distance_squared(1)); 64];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (node, d) = open[count];
            if d > within * within {
                continue;
            }
            if node < leaves {
                let [a, b] = [2 * node, 2 * node + 1].map(|n| (n, distance_squared(n)));
                (open[count], open[count + 1]) = if a.1 < b.1 { (b, a) } else { (a, b) };
                count += 2;
                continue;
            }
            let from = (node - leaves) * LEAF;
            for i in from..(from + LEAF).min(self.edges.len()) {
                within = visit(i, self.edge_distance(i, p));
            }
        }
    }

    /// The distance of a point from one of the edges.
    pub(crate) fn edge_distance(&self, edge: usize, p: Point) -> f64 {
        to_edge(self.edges[edge], p)
    }
}

/// The distance of a point from an edge.
pub(crate) fn to_edge([a, b]: [Point; 2], p: Point) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.hypot2()).clamp(0.0, 1.0);
    // Not a number where the edge has no length, or more than a number can hold.
    if t.is_nan() { p.distance(a) } else { p.distance(a + along * t) }
}
