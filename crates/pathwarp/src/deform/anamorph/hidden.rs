//! The part of a sheet that another part of it hides from a camera.
//!
//! A point p of the drawing is hidden if another point q of the artwork's box has the same image, F(q) = F(p), and is nearer to the
//! camera. The points q are roots of F(q) − F(p), sought by Newton's method from the cells of a grid whose images may hold F(p). Beside a
//! fold, where two roots meet, one start more is p mirrored at the fold: with the determinant D of the Jacobian and its kernel's direction
//! k, the fold is at the distance D/∂ₖD along k, and the mirrored point is p − 2k·D/∂ₖD.
//!
//! The boundary of the hidden part consists of folds and of the points that lie behind the outline of what is in front of them. It is
//! traced as the boundary of the predicate: on the edges of a grid by bisection, then between two points by bisection across their line,
//! until the distance from the line is below the tolerance.

use crate::map::{Class, Cost, Creases, Enclosure, Jet, Map, RationalBezier, forward_common};
use crate::outline::Outline;
use crate::outline::marching_squares::{GridEdge, marching_squares};
use crate::refit;
use kurbo::{Point, Rect, Vec2};
use std::sync::Arc;

/// Cells along a side of the grid.
const CELLS: usize = 64;
/// Cells by which the hidden part is traced beyond the artwork's box, for strokes.
const MARGIN: usize = 6;
/// Two points of the drawing differ if they are this share of the box's diagonal apart.
const APART: f64 = 1e-6;

/// The distance from the camera of a point of the drawing.
type Depth = Box<dyn Fn(Point) -> f64 + Send + Sync>;

/// The artwork's box as a sheet in space in front of a camera.
pub(super) struct Sheet {
    map: Arc<dyn Map>,
    depth: Depth,
    frame: Rect,
    /// Boxes of the images of the grid's cells.
    images: Vec<Rect>,
    /// Largest factor by which the map stretches lengths.
    stretch: f64,
}

impl Sheet {
    /// Examines the sheet over `frame`, whose image is `map`'s; `None` if it has no fold.
    pub(super) fn folded(map: Arc<dyn Map>, depth: Depth, frame: Rect) -> Option<Self> {
        let at = |i: usize, j: usize| map.jet(in_box(frame, i as f64, j as f64));
        let jets: Vec<Jet> =
            (0..=CELLS).flat_map(|j| (0..=CELLS).map(move |i| (i, j))).map(|(i, j)| at(i, j)).collect();
        let has = |sign: f64| jets.iter().any(|jet| sign * jet.det() > 0.0);
        if !(has(1.0) && has(-1.0)) {
            return None;
        }
        let corner = |k: usize| jets[(k / CELLS) * (CELLS + 1) + k % CELLS..].iter();
        let image = |k: usize| {
            let corners = corner(k).take(2).chain(corner(k).skip(CELLS + 1).take(2));
            let b = corners.map(|jet| Rect::from_points(jet.p, jet.p)).reduce(|a, b| a.union(b)).unwrap_or_default();
            // The image of a cell may bulge beyond its corners.
            let room = 0.1 * (b.width() + b.height());
            b.inflate(room, room)
        };
        let images = (0..CELLS * CELLS).map(image).collect();
        let stretch = jets.iter().map(|jet| jet.dx.hypot().hypot(jet.dy.hypot())).fold(0.0, f64::max);
        Some(Self { map, depth, frame, images, stretch })
    }

    /// Returns `true` if another point of the sheet lies in front of `p`.
    fn hides(&self, p: Point) -> bool {
        let (jet, depth) = (self.map.jet(p), (self.depth)(p));
        let apart = APART * self.frame.size().to_vec2().hypot();
        let is_in_front = |q: Point| q.distance(p) > apart && (self.depth)(q) < depth;
        jet.p.is_finite() && self.roots(jet.p, self.mirrored(p, &jet)).any(is_in_front)
    }

    /// Returns points of the sheet with this image, found from the grid's cells and from `start`.
    fn roots(&self, image: Point, start: Option<Point>) -> impl Iterator<Item = Point> {
        let cells = self.images.iter().enumerate().filter(move |(_, b)| b.contains(image));
        let middle = |k: usize| in_box(self.frame, (k % CELLS) as f64 + 0.5, (k / CELLS) as f64 + 0.5);
        let room = 1e-9 * self.frame.size().to_vec2().hypot();
        let starts = start.into_iter().chain(cells.map(move |(k, _)| middle(k)));
        starts
            .filter_map(move |start| self.root(start, image))
            .filter(move |q| self.frame.inflate(room, room).contains(*q))
    }

    /// Returns the root of F(q) − `image` that Newton's method finds from `start`.
    fn root(&self, start: Point, image: Point) -> Option<Point> {
        const STEPS: usize = 16;
        let cell = self.frame.size().to_vec2().hypot() / CELLS as f64;
        let mut q = start;
        for _ in 0..STEPS {
            let jet = self.map.jet(q);
            let step = jet.inverted(q).push(image - jet.p);
            if !step.is_finite() || q.distance(start) > 8.0 * cell {
                return None;
            }
            q += step * (2.0 * cell / step.hypot()).min(1.0);
            if step.hypot() < 1e-3 * APART * cell {
                return Some(q);
            }
        }
        None
    }

    /// Returns the point mirrored at a fold nearby.
    fn mirrored(&self, p: Point, jet: &Jet) -> Option<Point> {
        let cell = self.frame.size().to_vec2().hypot() / CELLS as f64;
        // The kernel's direction is across the longer row of the Jacobian.
        let [a, b] = [Vec2::new(jet.dx.x, jet.dy.x), Vec2::new(jet.dx.y, jet.dy.y)];
        let row = if a.hypot() > b.hypot() { a } else { b };
        let kernel = Vec2::new(-row.y, row.x) / row.hypot();
        let h = 1e-3 * cell;
        let [before, after] = [-h, h].map(|h| self.map.jet(p + kernel * h).det());
        let to_fold = jet.det() * 2.0 * h / (after - before);
        (to_fold.abs() < 2.0 * cell).then(|| p - kernel * (2.0 * to_fold))
    }

    /// Returns the outlines of the hidden part, by the even-odd rule, so that images are within `tolerance`.
    pub(super) fn hidden(&self, tolerance: f64) -> Outline {
        let within = (tolerance / self.stretch).max(APART * self.frame.size().to_vec2().hypot());
        let loops = Tracing { sheet: self, within: 0.5 * within }.loops();
        let traced = Outline { subpaths: loops.iter().flat_map(|l| Outline::from_points(l, true).subpaths).collect() };
        let options = refit::Options::new(0.5 * within);
        refit::simplified(&traced, None, &options, &[]).map_or(traced, |fitted| Outline::from(&fitted.path))
    }
}

/// The point `i` cells to the right and `j` cells down in a box.
fn in_box(r: Rect, i: f64, j: f64) -> Point {
    let n = CELLS as f64;
    Point::new(r.x0 + r.width() * i / n, r.y0 + r.height() * j / n)
}

/// Traces the boundary of the hidden part.
struct Tracing<'a> {
    sheet: &'a Sheet,
    /// Distance within which the boundary is found.
    within: f64,
}

impl Tracing<'_> {
    /// Returns the closed polygons of the boundary.
    fn loops(&self) -> Vec<Vec<Point>> {
        const SIDE: usize = CELLS + 2 * MARGIN;
        let margin = MARGIN as f64;
        let at = |(i, j): (usize, usize)| in_box(self.sheet.frame, i as f64 - margin, j as f64 - margin);
        // Nothing is hidden on the grid's border, so that every polygon closes.
        let hides = |i: usize, j: usize| ![i, j].iter().any(|k| *k == 0 || *k == SIDE) && self.sheet.hides(at((i, j)));
        let known: Vec<bool> = (0..=SIDE).flat_map(|j| (0..=SIDE).map(move |i| hides(i, j))).collect();
        let hidden = |(i, j): (usize, usize)| known[j * (SIDE + 1) + i];
        let crossing = |&(i, j, is_down): &GridEdge| {
            let ends = [(i, j), if is_down { (i, j + 1) } else { (i + 1, j) }];
            let [a, b] = if hidden(ends[0]) { ends } else { [ends[1], ends[0]] };
            self.bisect(at(a), at(b))
        };
        let polygon = |edges: Vec<GridEdge>| {
            let crossings: Vec<Point> = edges.iter().map(crossing).collect();
            let mut polygon = Vec::new();
            for (k, &here) in crossings.iter().enumerate() {
                polygon.push(here);
                self.divide([here, crossings[(k + 1) % crossings.len()]], true, &mut polygon);
            }
            polygon
        };
        marching_squares([SIDE; 2], |i, j| hidden((i, j))).into_iter().map(polygon).collect()
    }

    /// Returns a point of the boundary between a hidden point and one that is not.
    fn bisect(&self, mut hidden: Point, mut seen: Point) -> Point {
        while hidden.distance(seen) > 0.5 * self.within {
            let middle = hidden.midpoint(seen);
            if self.sheet.hides(middle) {
                hidden = middle;
            } else {
                seen = middle;
            }
        }
        hidden.midpoint(seen)
    }

    /// Adds the points of the boundary between two of its points. The `first` division is not omitted: a wave may cross the middle.
    fn divide(&self, [a, b]: [Point; 2], first: bool, out: &mut Vec<Point>) {
        let across = Vec2::new(a.y - b.y, b.x - a.x) * 0.5;
        let [left, right] = [a.midpoint(b) + across, a.midpoint(b) - across];
        if a.distance(b) < 4.0 * self.within {
            return;
        }
        let between = match [left, right].map(|p| self.sheet.hides(p)) {
            [true, false] => self.bisect(left, right),
            [false, true] => self.bisect(right, left),
            _ => return,
        };
        if first || between.distance(a.midpoint(b)) > self.within {
            self.divide([a, between], false, out);
            out.push(between);
            self.divide([between, b], false, out);
        }
    }
}

/// A view of a folded sheet, whose inverse leads to the part in front.
pub(super) struct FoldedView(pub(super) Arc<Sheet>);

impl Map for FoldedView {
    fn jet(&self, p: Point) -> Jet {
        self.0.map.jet(p)
    }

    fn point(&self, p: Point) -> Point {
        self.0.map.point(p)
    }

    fn enclose(&self, along: [Enclosure; 2]) -> Option<[Enclosure; 2]> {
        self.0.map.enclose(along)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(Front(Arc::clone(&self.0))))
    }

    fn cost(&self) -> Cost<'_> {
        self.0.map.cost()
    }

    forward_common!(self => Map, &*self.0.map);
}

/// The inverse of a view: the point of the sheet that the camera sees.
struct Front(Arc<Sheet>);

impl Map for Front {
    fn jet(&self, image: Point) -> Jet {
        let p = self.point(image);
        if p.is_finite() { self.0.map.jet(p).inverted(p) } else { Jet::UNDEFINED }
    }

    fn point(&self, image: Point) -> Point {
        let depth = |p: &Point| (self.0.depth)(*p);
        self.0.roots(image, None).min_by(|a, b| depth(a).total_cmp(&depth(b))).unwrap_or(Jet::UNDEFINED.p)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(FoldedView(Arc::clone(&self.0))))
    }
}
