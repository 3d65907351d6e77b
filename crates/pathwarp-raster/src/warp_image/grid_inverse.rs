//! Inverts a map over a box, starting from a grid of the map's values.
//!
//! The box is cut into cells, whose corners are mapped forwards. To invert a point, the triangle of mapped corners that contains it
//! gives a first answer, and Newton steps x ← x + J⁻¹(q − F(x)) improve it. A point outside all triangles has no inverse, which takes
//! one table lookup to find out and no step. The inverse extends a little beyond the image of the box. There it inverts the map, or,
//! if that is undefined or changes much around the box, its tangents.
//!
//! Unlike [`NewtonInverse`](pathwarp::map::NewtonInverse), answers are not certified: this serves colours, not geometry.

use super::image_warp::composed;
use kurbo::{Affine, Point, Rect, Vec2};
use pathwarp::engine::{Batches, Cost};
use pathwarp::map::{Creases, Jet, Map};
use std::fmt;

/// Pixels of the result per side of a cell.
const PIXELS: f64 = 2.0;
/// Range of the number of cells along a side of a square box. An oblong one has more along its longer and fewer along its shorter side.
const SQUARE_CELLS: (f64, f64) = (8.0, 24.0);
/// Range of the number of cells along any side.
const CELL_RANGE: (f64, f64) = (6.0, 96.0);
/// Smallest ratio of the shorter to the longer side of a box. Flatter boxes are inflated, so that even a line has cells.
const MIN_ASPECT: f64 = 1e-3;
/// Buckets along a side of the image's bounding box.
const BUCKETS: usize = 32;
/// Largest number of Newton steps. The first nearly always suffices; more help at creases.
const MAX_STEPS: usize = 5;
/// A residual below this fraction of the image's size needs just one more step, which about squares it.
const CLOSE: f64 = 1.0 / 1024.0;
/// The residual of a strict answer is at most this multiple of [`CLOSE`].
const STRICT: f64 = 4.0;
/// Around the box, the map is inverted if it differs from its tangent by at most this fraction of the distance; else the tangent is.
const MAX_DEVIATION: f64 = 0.25;
/// Largest distance from the first answer, in cells.
const MAX_DRIFT: f64 = 1.5;

/// The inverse of a map over a box and a little beyond it. NaN marks points outside.
pub struct GridInverse<'a> {
    map: &'a dyn Map,
    placed: Affine,
    after: Affine,
    nodes: Vec<Node>,
    triangles: Vec<Triangle>,
    buckets: Buckets,
    /// Size of a cell of the box.
    cell: Vec2,
    /// A residual below this needs just one more step.
    close: f64,
    /// The largest residual of an answer; infinite unless answers are strict.
    max_residual: f64,
}

impl fmt::Debug for GridInverse<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("GridInverse").field("map", &self.map).finish_non_exhaustive()
    }
}

/// A corner of the cells.
#[derive(Debug, Clone, Copy)]
struct Node {
    point: Point,
    image: Point,
}

/// Half a cell.
#[derive(Debug, Clone, Copy)]
struct Triangle {
    /// Indices of nodes.
    corners: [usize; 3],
    /// `true` if the triangle lies in the box.
    is_inner: bool,
    /// `true` if the map, not a tangent, applies in the triangle, so that Newton steps can improve its answers.
    is_mapped: bool,
    /// `true` if the triangle's image has the orientation of the larger part of the box.
    is_upright: bool,
}

impl<'a> GridInverse<'a> {
    /// Inverts the composition of `placed`, `map` and `after`, in this order, over the box `area` and up to `reach` around it. The inverse
    /// serves a picture of about `pixels` pixels along each side.
    #[must_use]
    pub fn new(map: &'a dyn Map, area: Rect, reach: f64, placed: Affine, after: Affine, pixels: f64) -> Self {
        let longest = area.width().max(area.height());
        let grow = |side: f64| 0.5 * (MIN_ASPECT * longest - side).max(0.0);
        let area = area.inflate(grow(area.width()), grow(area.height()));
        let grid = Grid::new(area, reach, (pixels / PIXELS).clamp(SQUARE_CELLS.0, SQUARE_CELLS.1));
        let (nodes, continues) = grid.nodes(map, placed, after);
        let triangles = grid.triangles(&nodes, continues);
        let images = nodes.iter().map(|n| n.image).filter(|p| p.is_finite());
        let bounds = images.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b)).unwrap_or_default();
        let buckets = Buckets::new(bounds, &nodes, &triangles);
        let close = CLOSE * bounds.width().hypot(bounds.height());
        Self { map, placed, after, nodes, triangles, buckets, cell: grid.cell(), close, max_residual: f64::INFINITY }
    }

    /// Leaves out answers with a large residual, and those where the map reverses orientation.
    #[must_use]
    pub(crate) fn strict(self) -> Self {
        Self { max_residual: STRICT * self.close, ..self }
    }

    /// Returns `false` if certainly no point of a box has an inverse.
    #[must_use]
    pub fn touches(&self, r: Rect) -> bool {
        let starts = &self.buckets.starts;
        let mut touched = self.buckets.touched_by(r.intersect(self.buckets.bounds));
        r.overlaps(self.buckets.bounds) && touched.any(|b| starts[b] < starts[b + 1])
    }

    /// The first answer for a point, and `true` if Newton steps can improve it. `last` caches the triangle of the previous answer, which a
    /// neighbour is likely to share.
    fn locate(&self, q: Point, last: &mut Option<u32>) -> Option<(Point, bool)> {
        let found = last.and_then(|triangle| self.answer_in(triangle, q));
        if found.is_some() {
            return found;
        }
        let mut reversed = None;
        for triangle in self.buckets.triangles_near(q)? {
            let t = &self.triangles[*triangle as usize];
            let Some(found) = self.answer_in(*triangle, q) else { continue };
            if t.is_upright {
                *last = t.is_mapped.then_some(*triangle);
                return Some(found);
            }
            reversed = reversed.or(Some(found).filter(|_| self.max_residual.is_infinite()));
        }
        reversed
    }

    /// The answer of a triangle if the point is in its image.
    #[inline]
    fn answer_in(&self, triangle: u32, q: Point) -> Option<(Point, bool)> {
        let t = &self.triangles[triangle as usize];
        let [a, b, c] = t.corners.map(|n| &self.nodes[n]);
        let (v, w) = barycentric(q, a.image, b.image, c.image)?;
        Some((a.point + (b.point - a.point) * v + (c.point - a.point) * w, t.is_mapped))
    }

    /// The next Newton step, given the map's jet at the current point, with its residual. `None` if the jet is singular.
    fn step(&self, q: Point, jet: &Jet) -> Option<(Vec2, f64)> {
        let jet = composed(jet, self.after, self.placed);
        let (r, det) = (q - jet.p, jet.det());
        let step = Vec2::new(r.cross(jet.dy) / det, jet.dx.cross(r) / det);
        step.is_finite().then(|| (step, r.hypot()))
    }
}

impl Map for GridInverse<'_> {
    fn jet(&self, q: Point) -> Jet {
        let p = self.point(q);
        if !p.is_finite() {
            return Jet::UNDEFINED;
        }
        composed(&self.map.jet(self.placed * p), self.after, self.placed).inverted(p)
    }

    fn cost(&self) -> Cost<'_> {
        if self.map.prefers_batches() { Cost::NET.batched(self) } else { Cost::NET }
    }

    fn point(&self, q: Point) -> Point {
        let mut out = [Point::ORIGIN];
        self.points(&[q], &mut out);
        out[0]
    }

    fn points(&self, qs: &[Point], out: &mut [Point]) {
        const UNDEFINED: Point = Point::new(f64::NAN, f64::NAN);
        let mut active = Vec::with_capacity(qs.len());
        let mut last = None;
        for (index, (q, o)) in qs.iter().zip(out.iter_mut()).enumerate() {
            let found = self.locate(*q, &mut last);
            *o = found.map_or(UNDEFINED, |f| f.0);
            if found.is_some_and(|f| f.1) {
                active.push(Search { index, start: *o, current: *o, best: f64::INFINITY });
            }
        }
        let mut points = Vec::with_capacity(active.len());
        let mut jets = vec![Jet::default(); active.len()];
        for _ in 0..MAX_STEPS {
            if active.is_empty() {
                break;
            }
            points.clear();
            points.extend(active.iter().map(|s| self.placed * s.current));
            self.map.jets(&points, &mut jets[..active.len()]);
            let mut jets = jets.iter();
            active.retain_mut(|s| {
                let found = jets.next().and_then(|jet| self.step(qs[s.index], jet));
                let Some((step, residual)) = found.filter(|f| f.1 < s.best) else {
                    if s.best > self.max_residual {
                        out[s.index] = UNDEFINED;
                    }
                    return false;
                };
                out[s.index] = if residual > self.max_residual { UNDEFINED } else { s.current };
                s.best = residual;
                let next = s.current + step;
                let drift = next - s.start;
                if drift.x.abs() > MAX_DRIFT * self.cell.x || drift.y.abs() > MAX_DRIFT * self.cell.y {
                    return false;
                }
                s.current = next;
                if residual <= self.close {
                    out[s.index] = next;
                    return false;
                }
                true
            });
        }
    }
}

impl Batches for GridInverse<'_> {}

/// A point that is being inverted.
struct Search {
    index: usize,
    /// The first answer, and the current one.
    start: Point,
    current: Point,
    /// The smallest residual so far.
    best: f64,
}

/// The cells of a box, and a ring of cells around it.
struct Grid {
    area: Rect,
    /// Width of the ring.
    reach: f64,
    columns: usize,
    rows: usize,
}

impl Grid {
    /// Divides `area` into cells. A square box has `square` along each side.
    fn new(area: Rect, reach: f64, square: f64) -> Self {
        let oblong = (area.width() / area.height()).sqrt();
        let cells = |n: f64| if n.is_finite() { n.clamp(CELL_RANGE.0, CELL_RANGE.1) as usize } else { square as usize };
        Self { area, reach, columns: cells(square * oblong), rows: cells(square / oblong) }
    }

    /// Size of a cell of the box.
    fn cell(&self) -> Vec2 {
        Vec2::new(self.area.width() / self.columns as f64, self.area.height() / self.rows as f64)
    }

    /// Nodes along the width. The box has one more than columns, and the ring one on each side.
    fn nodes_per_row(&self) -> usize {
        self.columns + 3
    }

    /// The nodes of the box and around it, row by row, and `true` if the images of the latter come from the map, `false` if they come from
    /// its tangents.
    fn nodes(&self, map: &dyn Map, placed: Affine, after: Affine) -> (Vec<Node>, bool) {
        let (area, per_row) = (self.area, self.nodes_per_row());
        let coordinate = |k: usize, start: f64, size: f64, cells: usize| match k {
            0 => start - self.reach,
            k if k == cells + 2 => start + size + self.reach,
            k => start + size * (k - 1) as f64 / cells as f64,
        };
        let point = |node: usize| {
            let x = coordinate(node % per_row, area.x0, area.width(), self.columns);
            Point::new(x, coordinate(node / per_row, area.y0, area.height(), self.rows))
        };
        let points: Vec<Point> = (0..per_row * (self.rows + 3)).map(point).collect();
        let nearest = |p: &Point| Point::new(p.x.clamp(area.x0, area.x1), p.y.clamp(area.y0, area.y1));
        let inside: Vec<Point> = points.iter().map(nearest).collect();
        let sources: Vec<Point> = inside.iter().map(|p| placed * *p).collect();
        let mut jets = vec![Jet::default(); sources.len()];
        map.jets(&sources, &mut jets);
        let mut creases = Creases::default();
        map.creases(&mut creases);
        let node = |(k, (jet, source)): (usize, (&Jet, &Point))| {
            let jet = composed(jet, after, placed);
            let image = jet.p + jet.push(points[k] - inside[k]);
            let image = if creases.defined_at(*source) { image } else { Point::new(f64::NAN, f64::NAN) };
            Node { point: points[k], image }
        };
        let mut nodes: Vec<Node> = jets.iter().zip(&sources).enumerate().map(node).collect();
        let around: Vec<usize> = (0..nodes.len()).filter(|k| points[*k] != inside[*k]).collect();
        let beyond: Vec<Point> = around.iter().map(|k| placed * points[*k]).collect();
        let mut images = vec![Point::ORIGIN; beyond.len()];
        map.points(&beyond, &mut images);
        let continues = around.iter().zip(&beyond).zip(&mut images).all(|((k, source), image)| {
            *image = after * *image;
            let (by_tangent, inner_image) = (nodes[*k].image, after * jets[*k].p);
            let max_distance = MAX_DEVIATION * by_tangent.distance(inner_image);
            creases.defined_at(*source) && image.distance(by_tangent) <= max_distance
        });
        if continues {
            around.iter().zip(images).for_each(|(k, image)| nodes[*k].image = image);
        }
        (nodes, continues)
    }

    /// The triangles between nodes that have images. Those of the box come first, since they take precedence.
    fn triangles(&self, nodes: &[Node], continues: bool) -> Vec<Triangle> {
        let image_area = |corners: [usize; 3]| {
            let [a, b, c] = corners.map(|n| nodes[n].image);
            (b - a).cross(c - a)
        };
        let per_row = self.nodes_per_row();
        let mut out: Vec<(Triangle, f64)> = Vec::with_capacity(2 * nodes.len());
        for k in (0..per_row * (self.rows + 2)).filter(|k| k % per_row != per_row - 1) {
            let is_inner = (1..=self.columns).contains(&(k % per_row)) && (1..=self.rows).contains(&(k / per_row));
            for corners in [[k, k + 1, k + per_row], [k + 1, k + per_row + 1, k + per_row]] {
                let area = image_area(corners);
                if area.is_finite() && area != 0.0 {
                    let is_mapped = is_inner || continues;
                    out.push((Triangle { corners, is_inner, is_mapped, is_upright: true }, area));
                }
            }
        }
        // The larger part of the image decides which orientation is upright.
        let upright = out.iter().filter(|(t, _)| t.is_inner).map(|(_, area)| area).sum::<f64>().signum();
        for (t, area) in &mut out {
            t.is_upright = area.signum() == upright;
        }
        out.sort_by_key(|(t, _)| !t.is_inner);
        out.into_iter().map(|(t, _)| t).collect()
    }
}

/// Weights of a triangle's second and third corner at a point inside it.
fn barycentric(q: Point, a: Point, b: Point, c: Point) -> Option<(f64, f64)> {
    /// Slack for rounding, so that points on a common side belong to both triangles.
    const ROUNDING: f64 = 1e-9;
    let (ab, ac, aq) = (b - a, c - a, q - a);
    let scale = 1.0 / ab.cross(ac);
    let (v, w) = (aq.cross(ac) * scale, ab.cross(aq) * scale);
    (v >= -ROUNDING && w >= -ROUNDING && v + w <= 1.0 + ROUNDING).then_some((v, w))
}

/// A grid of buckets over the image, each with the triangles that may touch it, in order of precedence.
struct Buckets {
    bounds: Rect,
    /// Start of each bucket's list, and the end of the last.
    starts: Vec<u32>,
    lists: Vec<u32>,
}

impl Buckets {
    fn new(bounds: Rect, nodes: &[Node], triangles: &[Triangle]) -> Self {
        let mut out = Self { bounds, starts: vec![0; BUCKETS * BUCKETS + 1], lists: Vec::new() };
        let image_box = |t: &Triangle| {
            let [a, b, c] = t.corners.map(|n| nodes[n].image);
            Rect::from_points(a, b).union_pt(c)
        };
        let boxes: Vec<Rect> = triangles.iter().map(image_box).collect();
        // First the number of triangles in each bucket, then where its list starts.
        for image in &boxes {
            out.touched_by(*image).for_each(|b| out.starts[b + 1] += 1);
        }
        for b in 0..BUCKETS * BUCKETS {
            out.starts[b + 1] += out.starts[b];
        }
        out.lists = vec![0; out.starts[BUCKETS * BUCKETS] as usize];
        let mut next = out.starts.clone();
        for (triangle, image) in (0..).zip(&boxes) {
            for b in out.touched_by(*image) {
                out.lists[next[b] as usize] = triangle;
                next[b] += 1;
            }
        }
        out
    }

    /// The buckets that a box touches, or else the nearest ones.
    fn touched_by(&self, r: Rect) -> impl Iterator<Item = usize> + use<> {
        let ((i0, j0), (i1, j1)) = (self.index(r.origin()), self.index(Point::new(r.x1, r.y1)));
        (j0..=j1).flat_map(move |j| (i0..=i1).map(move |i| j * BUCKETS + i))
    }

    /// Column and row of the bucket that is nearest to a point.
    fn index(&self, q: Point) -> (usize, usize) {
        let index = |v: f64, a: f64, b: f64| (((v - a) / (b - a) * BUCKETS as f64).max(0.0) as usize).min(BUCKETS - 1);
        (index(q.x, self.bounds.x0, self.bounds.x1), index(q.y, self.bounds.y0, self.bounds.y1))
    }

    /// Indices of the triangles that may contain a point; `None` if the point is outside of all.
    fn triangles_near(&self, q: Point) -> Option<&[u32]> {
        let b = &self.bounds;
        if !((b.x0..=b.x1).contains(&q.x) && (b.y0..=b.y1).contains(&q.y)) {
            return None;
        }
        let (i, j) = self.index(q);
        let bucket = j * BUCKETS + i;
        self.lists.get(self.starts[bucket] as usize..self.starts[bucket + 1] as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::map::{Formula, Real};

    struct Bend;
    impl Formula for Bend {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x + (y / 30.0).sin() * 6.0, y + (x / 25.0).sin() * 8.0)
        }
    }

    const AREA: Rect = Rect::new(10.0, 20.0, 90.0, 70.0);
    const READ: Affine = Affine::new([0.5, 0.1, -0.2, 0.8, 3.0, -5.0]);
    const WRITE: Affine = Affine::new([2.0, 0.0, 0.5, -1.0, 30.0, 7.0]);

    fn forward(p: Point) -> Point {
        WRITE * Bend.point(READ * p)
    }

    #[test]
    fn the_image_of_the_box_is_inverted() {
        let inverse = GridInverse::new(&Bend, AREA, 20.0, READ, WRITE, 50.0);
        let mut worst: f64 = 0.0;
        for k in 0..10_000 {
            let p = AREA.origin() + Vec2::new(0.8 * f64::from(k % 100) + 0.4, 0.5 * f64::from(k / 100) + 0.25);
            worst = worst.max(inverse.point(forward(p)).distance(p));
        }
        println!("largest error {worst:.1e}");
        assert!(worst < 1e-4, "{worst}");
        let (p, q) = (Point::new(40.0, 50.0), forward(Point::new(40.0, 50.0)));
        let jet = inverse.jet(q);
        let there = composed(&Bend.jet(READ * p), WRITE, READ).then(&jet);
        assert!((there.dx - Vec2::new(1.0, 0.0)).hypot() + (there.dy - Vec2::new(0.0, 1.0)).hypot() < 1e-6);
    }

    #[test]
    fn beyond_the_box_it_follows_the_tangent_and_then_ends() {
        let inverse = GridInverse::new(&Bend, AREA, 20.0, READ, WRITE, 50.0);
        for (p, c) in [((8.0, 45.0), (10.0, 45.0)), ((95.0, 30.0), (90.0, 30.0)), ((50.0, 75.0), (50.0, 70.0))] {
            let (p, c) = (Point::from(p), Point::from(c));
            let jet = composed(&Bend.jet(READ * c), WRITE, READ);
            let back = inverse.point(jet.p + jet.push(p - c));
            assert!(back.distance(p) < 0.1, "{p} {back}");
        }
        assert!(inverse.point(forward(Point::new(200.0, 50.0))).is_nan());
        assert!(inverse.point(Point::new(f64::NAN, 0.0)).is_nan());
    }

    /// The map folds where its determinant changes sign; the larger sheet counts.
    #[test]
    fn of_two_sheets_the_larger_is_taken() {
        struct Fold;
        impl Formula for Fold {
            fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
                (x * x, y)
            }
        }
        let inverse =
            GridInverse::new(&Fold, Rect::new(-1.0, 0.0, 3.0, 1.0), 0.1, Affine::IDENTITY, Affine::IDENTITY, 50.0);
        assert!((inverse.point(Point::new(0.49, 0.5)).x - 0.7).abs() < 1e-4);
    }

    /// A kink between the corners of a cell, at most a close residual times the ratio of the slopes off.
    #[test]
    fn kinks_are_followed() {
        struct Kink;
        impl Map for Kink {
            fn jet(&self, p: Point) -> Jet {
                let k = if p.x < 0.4321 { 1.0 } else { 3.0 };
                Jet { p: Point::new(0.4321 + k * (p.x - 0.4321), p.y), dx: Vec2::new(k, 0.0), dy: Vec2::new(0.0, 1.0) }
            }
        }
        // The diagonal of the image with its surroundings.
        let size = Vec2::new(2.6, 1.2).hypot();
        let inverse =
            GridInverse::new(&Kink, Rect::new(0.0, 0.0, 1.0, 1.0), 0.1, Affine::IDENTITY, Affine::IDENTITY, 50.0);
        for k in 0..1000 {
            let p = Point::new(f64::from(k) / 1000.0, 0.3);
            assert!(inverse.point(Kink.point(p)).distance(p) < 3.0 * CLOSE * size, "{p}");
        }
    }
}
