//! The area that `--crop` keeps of a photograph: the image of the frame, at the frame's size in the photograph.

use super::proportions::Proportions;
use crate::failure::Failure;
use pathwarp::Outline;
use pathwarp::deform::{Built, Projective, Role};
use pathwarp::kurbo::{BezPath, PathEl, Point, Rect, Shape as _};
use pathwarp::map::Map;
use pathwarp::recipe::{BuiltRecipe, Recipe};

/// Number of samples on a side.
const SAMPLES: usize = 64;

/// The image of the frame under the map.
pub(super) struct Crop {
    pub(super) bounds: Rect,
    /// `true` if the image is a rectangle along the axes.
    is_straight: bool,
}

/// The frame in the photograph, before it is straightened.
pub(super) struct Source {
    pub(super) outline: Outline,
    /// The means of its two widths and of its two heights.
    size: (f64, f64),
    /// Its corners, counterclockwise from the lower left, if a camera would see a rectangle like that.
    corners: Option<[Point; 4]>,
}

impl Source {
    /// Returns the proportions of the frame in space, if its corners and the picture's centre determine them reliably.
    pub(super) fn proportions(&self, picture: Rect) -> Option<Proportions> {
        let corners = self.corners?;
        Proportions::seen(corners, picture).filter(|p| p.is_sound(corners, picture))
    }

    /// Returns a size in pixels with this ratio of width to height that keeps all detail; without a ratio, the mean size.
    pub(super) fn size_at(&self, ratio: Option<f64>) -> (f64, f64) {
        let (width, height) = self.size;
        let Some(ratio) = ratio else { return self.size };
        let width = width.max(height * ratio);
        (width, width / ratio)
    }

    /// Turns a ratio of sides into width to height: upright or lying like the frame in space, or else like the frame in the photograph.
    pub(super) fn oriented(&self, sides: f64, picture: Rect) -> f64 {
        let seen = self.corners.and_then(|corners| Proportions::seen(corners, picture));
        let seen = seen.map_or(self.size.0 / self.size.1, |p| p.ratio);
        if (seen > 1.0) == (sides > 1.0) { sides } else { 1.0 / sides }
    }
}

impl Crop {
    /// Finds the image of the frame of the first step that straightens something: one with corners that differ from its frame's, or an
    /// inverse one, which maps its selection onto the frame. If there is none, the first step's frame is taken.
    pub(super) fn of(built: &BuiltRecipe, recipe: &Recipe) -> Result<Self, Failure> {
        let is_inverse = |i: usize| recipe.steps.get(built.indices[i]).is_some_and(|s| s.inverse);
        let frame = |i: usize| corners(built.frames[i].rect);
        let straightens =
            |i: &usize| is_inverse(*i) || quad(&built.steps[*i], Role::Base).is_some_and(|q| q != frame(*i));
        let step = (0..built.steps.len()).find(straightens).unwrap_or(0);
        let (role, first) = if is_inverse(step) { (Role::Target, step + 1) } else { (Role::Base, step) };
        let quad = quad(&built.steps[step], role).unwrap_or_else(|| frame(step));
        let image = side_points(quad).map(|p| built.steps[first..].iter().fold(p, |p, s| s.map.point(p)));
        let image: Vec<Point> = image.collect();
        let bounds = image.iter().map(|p| Rect::from_points(*p, *p)).reduce(|a, b| a.union(b)).unwrap_or_default();
        if !(image.iter().all(|p| p.is_finite()) && bounds.width() > 0.0 && bounds.height() > 0.0) {
            return Err(Failure::Geometry(
                "--crop: the map is undefined on part of the frame; omit --crop, or choose a smaller frame".into(),
            ));
        }
        Ok(Self { bounds, is_straight: is_box(&image, bounds) })
    }

    /// Returns the frame in the photograph, if its image is a rectangle along the axes.
    pub(super) fn source(&self, inverse: &dyn Map) -> Option<Source> {
        let points: Vec<Point> = side_points(corners(self.bounds)).map(|p| inverse.point(p)).collect();
        let length = |side: usize| {
            let point = |i: usize| points[((side * SAMPLES) + i) % points.len()];
            (0..SAMPLES).map(|i| point(i).distance(point(i + 1))).sum::<f64>()
        };
        let mean = |a: usize, b: usize| 0.5 * (length(a) + length(b));
        let size = (mean(0, 2), mean(1, 3));
        let is_known = self.is_straight && size.0.is_finite() && size.1.is_finite();
        is_known.then(|| {
            let corners = perspective(self.bounds, &points);
            Source { outline: Outline::from_points(&points, true), size, corners }
        })
    }
}

/// Selects the corners from points along the sides of the preimage of `bounds`, if a projective map takes the box there.
fn perspective(bounds: Rect, points: &[Point]) -> Option<[Point; 4]> {
    /// The largest distance in pixels that counts as zero.
    const SAME: f64 = 0.05;
    let quad = [0, 1, 2, 3].map(|side| points[side * SAMPLES]);
    let map = Projective::new(corners(bounds), quad).build().ok()?.map;
    side_points(corners(bounds)).zip(points).all(|(p, q)| map.point(p).distance(*q) < SAME).then_some(quad)
}

/// Returns the corners of a box, counterclockwise from the lower left, the order of anchors.
fn corners(r: Rect) -> [Point; 4] {
    [(r.x0, r.y1), (r.x1, r.y1), (r.x1, r.y0), (r.x0, r.y0)].map(Point::from)
}

/// Returns points along the sides of a quadrilateral, of which each [`SAMPLES`]-th is a corner.
fn side_points(quad: [Point; 4]) -> impl Iterator<Item = Point> {
    let side = move |i: usize| (0..SAMPLES).map(move |k| quad[i].lerp(quad[(i + 1) % 4], k as f64 / SAMPLES as f64));
    (0..4).flat_map(side)
}

/// Returns the guide of a step, if it is a quadrilateral.
fn quad(step: &Built, role: Role) -> Option<[Point; 4]> {
    let path: &BezPath = &step.explanation.overlays.iter().find(|o| o.role == role)?.path;
    let mut points: Vec<Point> = Vec::new();
    for (i, element) in path.elements().iter().enumerate() {
        match *element {
            PathEl::MoveTo(p) if i == 0 => points.push(p),
            PathEl::LineTo(p) if i > 0 => points.push(p),
            PathEl::ClosePath => {}
            _ => return None,
        }
    }
    if points.len() == 5 && points[4] == points[0] {
        points.pop();
    }
    <[Point; 4]>::try_from(points).ok().filter(|_| path.area() != 0.0)
}

/// Returns `true` if the image of a quadrilateral's sides is a box, and corners map to corners.
fn is_box(image: &[Point], bounds: Rect) -> bool {
    /// The largest distance that counts as zero, as a share of the box's diagonal.
    const SAME: f64 = 2e-3;
    let near = SAME * bounds.width().hypot(bounds.height());
    let edge_distance = |p: Point| {
        let [left, top] = [p.x - bounds.x0, p.y - bounds.y0];
        [left, bounds.width() - left, top, bounds.height() - top].into_iter().fold(f64::INFINITY, f64::min)
    };
    let is_image = |corner: &Point| image.iter().step_by(SAMPLES).any(|p| p.distance(*corner) <= near);
    image.iter().all(|p| edge_distance(*p) <= near) && corners(bounds).iter().all(is_image)
}
