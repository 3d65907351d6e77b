//! Subpaths and outlines.

use super::Seg;
use kurbo::{Affine, BezPath, Line, Point, Rect};

/// A connected run of segments.
#[derive(Debug, Clone, PartialEq)]
pub struct Subpath {
    /// The first point. A subpath without segments is a single point, drawn as a dot with round caps.
    pub start: Point,
    /// The segments, each starting at the end of the previous one. They include the closing line of a closed subpath, unless
    /// its length is zero.
    pub segs: Vec<Seg>,
    /// `true` for a closed subpath.
    pub closed: bool,
}

impl Subpath {
    /// The anchors: the first points of all segments and, for an open subpath, the last point.
    #[must_use]
    pub fn anchors(&self) -> Vec<Point> {
        let mut out: Vec<Point> = self.segs.iter().map(Seg::start).collect();
        if out.is_empty() {
            out.push(self.start);
        } else if !self.closed {
            out.extend(self.segs.last().map(Seg::end));
        }
        out
    }

    /// The last point.
    #[must_use]
    pub fn end(&self) -> Point {
        self.segs.last().map_or(self.start, Seg::end)
    }

    /// The bounding box.
    #[must_use]
    pub fn bounding_box(&self) -> Rect {
        let point = |p: Point| Rect::from_points(p, p);
        let ends = self.segs.iter().map(Seg::end).fold(point(self.start), |b, p| b.union(point(p)));
        // The extremes of most segments lie inside the box of all ends.
        self.segs.iter().fold(ends, |b, g| g.extend(b))
    }

    /// The diagonal of the bounding box.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        self.bounding_box().size().to_vec2().hypot()
    }

    /// The same curve in the opposite direction.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self { start: self.end(), segs: self.segs.iter().rev().map(Seg::reversed).collect(), closed: self.closed }
    }
}

/// A path as drawn: the source of every deformation.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outline {
    /// The subpaths in drawing order.
    pub subpaths: Vec<Subpath>,
}

impl Outline {
    /// An open polyline through `points`, or a closed polygon.
    #[must_use]
    pub fn from_points(points: &[Point], closed: bool) -> Self {
        let Some(&start) = points.first() else { return Self::default() };
        let mut segs: Vec<Seg> = points.windows(2).map(|p| Seg::Line(Line::new(p[0], p[1]))).collect();
        let end = points.last().copied().unwrap_or(start);
        if closed && end != start {
            segs.push(Seg::Line(Line::new(end, start)));
        }
        Self { subpaths: vec![Subpath { start, segs, closed }] }
    }

    /// All segments in drawing order.
    pub fn segs(&self) -> impl Iterator<Item = &Seg> {
        self.subpaths.iter().flat_map(|s| &s.segs)
    }

    /// The largest magnitude of coordinates; see [`Seg::extent`].
    #[must_use]
    pub fn extent(&self) -> f64 {
        self.segs().map(Seg::extent).fold(0.0, f64::max)
    }

    /// Returns `true` if there is nothing to draw.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.subpaths.is_empty()
    }

    /// The union of the images under all of `places`; the outline itself if there are none.
    #[must_use]
    pub fn repeated(&self, places: &[Affine]) -> Self {
        if places.is_empty() {
            return self.clone();
        }
        Self { subpaths: places.iter().flat_map(|m| self.transformed(*m).subpaths).collect() }
    }

    /// The image under an affine map, exact.
    #[must_use]
    pub fn transformed(&self, m: Affine) -> Self {
        let subpaths = self
            .subpaths
            .iter()
            .map(|s| Subpath {
                start: m * s.start,
                segs: s.segs.iter().map(|g| g.transformed(m)).collect(),
                closed: s.closed,
            })
            .collect();
        Self { subpaths }
    }

    /// The bounding box; `None` for an empty path.
    #[must_use]
    pub fn bounding_box(&self) -> Option<Rect> {
        let ends = self.subpaths.iter().flat_map(|s| s.segs.iter().map(Seg::end).chain([s.start]));
        let ends = ends.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b))?;
        // The extremes of most segments lie inside the box of all ends.
        Some(self.segs().fold(ends, |b, g| g.extend(b)))
    }

    /// Converts to a [`BezPath`], each arc to cubics within `tolerance` of it.
    #[must_use]
    pub fn to_bez_path(&self, tolerance: f64) -> BezPath {
        let mut out = BezPath::new();
        for s in &self.subpaths {
            out.move_to(s.start);
            let closing = s.closed && matches!(s.segs.last(), Some(Seg::Line(_)));
            let drawn = s.segs.len() - usize::from(closing);
            for g in &s.segs[..drawn] {
                match g {
                    Seg::Line(l) => out.line_to(l.p1),
                    Seg::Quad(q) => out.quad_to(q.p1, q.p2),
                    Seg::Cubic(c) => out.curve_to(c.p1, c.p2, c.p3),
                    Seg::Arc(a) => {
                        for c in a.to_cubics(tolerance) {
                            out.curve_to(c.p1, c.p2, c.p3);
                        }
                    }
                }
            }
            if s.closed {
                out.close_path();
            }
        }
        out
    }
}
