//! Mirrors: drawings on a table that look right in a mirror that stands on it.
//!
//! The origin of space is the middle F of the mirror's foot, with x to the right, y down and z away from the viewer. The table is y = 0.
//! Its point (x, z) is drawn at F' + (x, −z), where F' is the foot's position on the page. The artwork appears in a plane through a
//! point Q of the mirror's axis, square to the line from the eye O to Q. For a cylinder, Q is F and the artwork stands on it; for a cone,
//! the artwork is centred on F; for a sphere, it is centred below the middle, halfway down the part that reflects the table.
//!
//! The ray with direction d from O through the point P of the picture meets the mirror at H, the nearer root of a quadratic. With the
//! mirror's normal n there, it leaves along r = d − 2(d·n)/(n·n)·n and meets the table at H − r·H_y/r_y. A cylinder or cone with the axis
//! a and the radius R(s) = R − g·s at s = (q − F)·a is |q − F − s·a|² = R(s)², with the normal q − F − s·a + g·R(s)·a.
//!
//! The inverse has no closed form (for a sphere it is Alhazen's problem) and is found by Newton's method over the picture.

use super::scene::{Eye, Scene};
use super::surface::{Space, cross, dot, length, minus, picture_axes};
use crate::deform::triangle::polygon;
use crate::error::{Error, show};
use crate::map::{Cost, Crease, Creases, Formula, Jet, Level, Map, Real};
use kurbo::{BezPath, Circle, Point, Rect, Shape, Vec2};
use std::f64::consts::PI;
use std::sync::Arc;

/// A mirror that stands on the table, in which the artwork appears. Lengths are in user units, angles in degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Mirror {
    /// The shape.
    pub shape: MirrorShape,
    /// Angle by which the axis leans away from the viewer.
    pub tilt: f64,
    /// Length by which the artwork is raised.
    pub lift: f64,
    /// Position of the foot's middle on the page; `None` for a point below the artwork's middle.
    pub at: Option<Point>,
}

/// The shape of a mirror.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum MirrorShape {
    /// A cylinder that stands on its base: radius, and height if it is known.
    Cylinder(f64, Option<f64>),
    /// A cone that stands on its base: radius of the base and height.
    Cone(f64, f64),
    /// A sphere that lies on the table: radius.
    Sphere(f64),
}

impl Mirror {
    /// Creates an upright mirror.
    #[must_use]
    pub fn new(shape: MirrorShape) -> Self {
        Self { shape, tilt: 0.0, lift: 0.0, at: None }
    }

    setters! {
        /// Leans the axis away from the viewer, degrees.
        tilt(tilt: f64);
        /// Lets the artwork appear higher.
        lift(lift: f64);
        /// Places the middle of the foot on the page.
        at(at: impl Into<Point>) => at: Some(at.into());
    }

    /// Returns the mirror in the notation of `--mirror`, for messages.
    fn text(self) -> String {
        match self.shape {
            MirrorShape::Cylinder(r, _) => format!("cylinder:radius={r}"),
            MirrorShape::Cone(r, h) => format!("cone:radius={r},height={h}"),
            MirrorShape::Sphere(r) => format!("sphere:radius={r}"),
        }
    }

    fn wrong(self, problem: impl Into<String>) -> Error {
        Error::usage("mirror", self.text(), problem)
    }

    fn radius(self) -> f64 {
        let (MirrorShape::Cylinder(r, _) | MirrorShape::Cone(r, _) | MirrorShape::Sphere(r)) = self.shape;
        r
    }

    /// Returns the loss of radius per unit along the axis.
    fn slope(self) -> f64 {
        if let MirrorShape::Cone(r, h) = self.shape { r / h } else { 0.0 }
    }

    fn height(self) -> Option<f64> {
        match self.shape {
            MirrorShape::Cylinder(_, h) => h,
            MirrorShape::Cone(_, h) => Some(h),
            MirrorShape::Sphere(r) => Some(2.0 * r),
        }
    }

    /// Returns the direction of the axis, upwards.
    fn axis(self) -> Space {
        let t = self.tilt.to_radians();
        [0.0, -t.cos(), t.sin()]
    }

    /// Returns the point of the artwork that appears at the middle Q of the picture.
    pub(super) fn anchor(self, frame: Rect) -> Point {
        match self.shape {
            MirrorShape::Cylinder(..) => Point::new(frame.center().x, frame.y1),
            _ => frame.center(),
        }
    }
}

/// A mirror, its eye and the picture in it.
#[derive(Debug, Clone)]
pub(super) struct Reflection {
    mirror: Mirror,
    /// The eye in space, or the direction towards it if it is `infinite`.
    eye: Space,
    infinite: bool,
    /// The middle Q of the picture.
    middle: Space,
    /// The point of the artwork at Q.
    anchor: Point,
    /// The picture's directions right and down.
    axes: [Space; 2],
    /// The foot on the page.
    pub(super) foot: Point,
    /// The artwork's box.
    domain: Rect,
}

/// Distance of a ray from a cone's tip, relative to the radius of its base, at which reflections end.
const TIP: f64 = 2e-3;

impl Reflection {
    pub(super) fn new(mirror: Mirror, scene: &Scene) -> Result<Self, Error> {
        let r = mirror.radius();
        if ![r, mirror.height().unwrap_or(r)].iter().all(|v| (1e-9..1e9).contains(v)) {
            return Err(mirror.wrong("has a size that is not positive"));
        }
        if mirror.tilt.is_nan() || mirror.tilt.abs() > 60.0 || !mirror.lift.is_finite() {
            return Err(mirror.wrong("leans too far; tilt runs from -60 to 60"));
        }
        let anchor = mirror.anchor(scene.frame);
        let foot = mirror.at.unwrap_or(anchor);
        let (eye, infinite) = match scene.eye {
            Eye::At(at, distance) => ([at.x - anchor.x, at.y - anchor.y, -distance], false),
            Eye::Infinite(towards) => (towards, true),
        };
        if eye[1] >= 0.0 {
            let problem = "is not above the table on which the mirror stands; give it a height (`eye-height`)";
            return Err(Error::usage("eye", "", problem));
        }
        let mut out =
            Self { mirror, eye, infinite, middle: [0.0; 3], anchor, axes: [[0.0; 3]; 2], foot, domain: scene.frame };
        if !infinite && out.outside(eye) <= 0.0 {
            let problem = "contains the eye; move the eye away (`distance`, `eye-height`) or make the mirror smaller";
            return Err(mirror.wrong(problem));
        }
        let mut lift = mirror.lift;
        if let MirrorShape::Sphere(r) = mirror.shape {
            out.middle = [0.0, -r, 0.0];
            // A ray that descends by the angle e is level after a reflection at the height where the sphere's normal rises by e/2.
            let to = out.sight();
            lift -= 0.5 * r * (1.0 + (0.5 * (to[1] / length(to)).asin()).sin());
        }
        let forward = out.sight().map(|v| v / length(out.sight()));
        out.axes = picture_axes(forward);
        for i in 0..3 {
            out.middle[i] -= out.axes[1][i] * lift;
        }
        Ok(out)
    }

    /// Returns the line of sight to the middle Q.
    fn sight(&self) -> Space {
        if self.infinite { self.eye.map(|v| -v) } else { minus(self.middle, self.eye) }
    }

    /// Returns a number that is positive if the point is outside the mirror.
    fn outside(&self, q: Space) -> f64 {
        if let MirrorShape::Sphere(r) = self.mirror.shape {
            return q[0] * q[0] + (q[1] + r).powi(2) + q[2] * q[2] - r * r;
        }
        let s = dot(q, self.mirror.axis());
        let radius = self.mirror.radius() - self.mirror.slope() * s;
        if self.mirror.height().is_some_and(|h| s > h) { 1.0 } else { dot(q, q) - s * s - radius * radius }
    }

    /// Returns the point in space of a point of the picture.
    fn picture_point<S: Real>(&self, x: S, y: S) -> [S; 3] {
        let (u, v) = (x - self.anchor.x, y - self.anchor.y);
        std::array::from_fn(|i| u * self.axes[0][i] + v * self.axes[1][i] + self.middle[i])
    }

    /// Follows the ray through (x, y) to the mirror.
    fn reflect<S: Real>(&self, x: S, y: S) -> ReflectedRay<S> {
        let dot = |a: [S; 3], b: [S; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let p = self.picture_point(x, y);
        // Rays start near the mirror, since a far eye would cost digits.
        let most = 8.0 * (self.mirror.radius() + self.mirror.height().unwrap_or(0.0) + self.domain.height());
        let d: [S; 3] = std::array::from_fn(|i| if self.infinite { S::from(-self.eye[i]) } else { p[i] - self.eye[i] });
        let distance = dot(d, d).sqrt();
        let d = d.map(|v| v / distance);
        let back = if self.infinite || distance.value() > most { S::from(most) } else { distance };
        let from: [S; 3] = std::array::from_fn(|i| p[i] - d[i] * back);
        let (a, g) = (self.mirror.axis().map(S::from), self.mirror.slope());
        let centre = if let MirrorShape::Sphere(r) = self.mirror.shape { -r } else { 0.0 };
        let o = [from[0], from[1] - centre, from[2]];
        let is_sphere = centre != 0.0;
        let (os, ds) = if is_sphere { (S::from(0.0), S::from(0.0)) } else { (dot(o, a), dot(d, a)) };
        let radius = -os * g + self.mirror.radius();
        // The nearer root of qa·λ² + 2qb·λ + qc = 0, in the form that does not cancel.
        let qa = dot(d, d) - ds * ds * (1.0 + g * g);
        let qb = dot(o, d) - os * ds + radius * ds * g;
        let qc = dot(o, o) - os * os - radius * radius;
        let discriminant = qb * qb - qa * qc;
        let lambda = qc / (discriminant.sqrt() - qb);
        let w: [S; 3] = std::array::from_fn(|i| o[i] + d[i] * lambda);
        let s = os + ds * lambda;
        let radius = -s * g + self.mirror.radius();
        let n: [S; 3] = std::array::from_fn(|i| if is_sphere { w[i] } else { w[i] - a[i] * s + a[i] * radius * g });
        let turn = dot(d, n) / dot(n, n) * 2.0;
        let direction = std::array::from_fn(|i| d[i] - n[i] * turn);
        ReflectedRay { hit: [w[0], w[1] + centre, w[2]], direction, discriminant, s, lambda, facing: -dot(d, n) }
    }

    /// Returns the point of the table, x and z, at which the ray through (x, y) arrives.
    fn table<S: Real>(&self, x: S, y: S) -> (S, S) {
        let b = self.reflect(x, y);
        let t = -b.hit[1] / b.direction[1];
        (b.hit[0] + b.direction[0] * t, b.hit[2] + b.direction[2] * t)
    }

    /// Returns a number that is positive if a point of the artwork is seen in the mirror, and the reason why it is not seen otherwise.
    pub(super) fn fault(&self, p: Point) -> (f64, &'static str) {
        let b: ReflectedRay<f64> = self.reflect(p.x, p.y);
        let r = self.mirror.radius();
        let top = self.mirror.height().map_or(1.0, |h| (h - b.s) / r);
        let tip = match self.mirror.shape {
            MirrorShape::Cone(r, h) => {
                let (tip, p) = (self.mirror.axis().map(|v| v * h), self.picture_point(p.x, p.y));
                let ray = if self.infinite { self.eye } else { minus(p, self.eye) };
                length(cross(minus(tip, p), ray)) / (length(ray) * r) - TIP
            }
            _ => 1.0,
        };
        // Numbers that must be positive.
        let conditions = [
            (
                tip,
                "the eye sees the cone's tip, where the mirror has no direction; leave a hole in the artwork there, or move it (`lift`)",
            ),
            (
                b.discriminant / (r * r),
                "the ray misses the mirror; make the artwork smaller (`picture-width`) or the mirror larger",
            ),
            (b.lambda / r, "the mirror begins behind the eye; move the eye away (`distance`)"),
            (
                if matches!(self.mirror.shape, MirrorShape::Sphere(_)) { 1.0 } else { top },
                "the ray passes over the mirror's top; make the mirror higher, or the artwork smaller (`picture-width`)",
            ),
            (b.facing, "the mirror hides itself: the eye sees its back; move the eye or lessen the tilt"),
            (
                -b.hit[1] / r,
                "the mirror is under the table and hides itself; make the artwork smaller (`picture-width`), lift it (`lift`), or lessen the tilt",
            ),
            (
                b.direction[1],
                "the mirror reflects no table, but what is above it; lower the artwork (`lift`), raise the eye, or tilt the mirror towards it",
            ),
        ];
        let unmet = conditions.iter().find(|f| f.0.is_nan() || f.0 <= 0.0);
        *unmet.or(conditions.iter().min_by(|a, b| a.0.total_cmp(&b.0))).unwrap_or(&conditions[0])
    }

    /// Returns the height along the axis up to which the mirror shows the artwork.
    pub(super) fn needed_height(&self) -> f64 {
        super::surface::box_samples(self.domain).map(|p| self.reflect(p.x, p.y).s).fold(0.0, f64::max)
    }

    /// Refuses a mirror that does not show all of the artwork, except around the tip of a cone, which is returned.
    pub(super) fn check(&self) -> Result<Option<Point>, Error> {
        let mut tip = None;
        for p in super::surface::box_samples(self.domain) {
            match self.fault(p) {
                (v, _) if v > 0.0 => {}
                (_, why) if why.contains("tip") => tip = Some(p),
                (_, why) => {
                    return Err(self.mirror.wrong(format!("does not show the artwork's box: at {} {why}", show(p))));
                }
            }
        }
        Ok(tip)
    }

    /// Returns the point of the page that shows the point of the table below or above a point in space.
    pub(super) fn on_page(&self, [x, _, z]: Space) -> Point {
        self.foot + Vec2::new(x, -z)
    }

    /// Returns the outline of the foot on the page; for a sphere, its outline as seen from above.
    pub(super) fn footprint(&self) -> BezPath {
        /// Corners of the outline of a tilted mirror.
        const CORNERS: u32 = 360;
        let r = self.mirror.radius();
        if self.mirror.tilt == 0.0 || matches!(self.mirror.shape, MirrorShape::Sphere(_)) {
            return Circle::new(self.foot, r).to_path(1e-4 * r);
        }
        let (a, g) = (self.mirror.axis(), self.mirror.slope());
        let corner = |k: u32| {
            let (sin, cos) = (2.0 * PI * f64::from(k) / f64::from(CORNERS)).sin_cos();
            // The distance from F at which the table's direction (cos, sin) leaves the mirror, from |q|² − (q·a)² = R(q·a)².
            let c = sin * a[2];
            let distance = r / ((1.0 - c * c).sqrt() + g * c);
            self.on_page([distance * cos, 0.0, distance * sin])
        };
        polygon(&(0..CORNERS).map(corner).collect::<Vec<_>>())
    }

    /// Returns the eye's position on the page, its distance from the foot and its height; `None` at infinity.
    pub(super) fn eye(&self) -> Option<(Point, [f64; 2])> {
        let [x, y, z] = self.eye;
        (!self.infinite).then(|| (self.on_page([x, 0.0, z]), [x.hypot(z), -y]))
    }

    /// Returns the point in space of a point of the drawing, of the picture, or of the mirror, there as (angle, share of the height).
    pub(super) fn in_space(&self, part: ScenePart, p: Point) -> Option<Space> {
        match part {
            ScenePart::Table => {
                let (x, z) = self.table(p.x, p.y);
                (self.fault(p).0 > 0.0).then_some([x, 0.0, z])
            }
            ScenePart::Picture => Some(self.picture_point(p.x, p.y)),
            ScenePart::Mirror(height) => {
                let (sin, cos) = (2.0 * PI * p.x).sin_cos();
                if let MirrorShape::Sphere(r) = self.mirror.shape {
                    let (up, out) = (PI * p.y).sin_cos();
                    return Some([r * up * cos, -r - r * out, r * up * sin]);
                }
                let (a, s) = (self.mirror.axis(), p.y * height);
                let r = self.mirror.radius() - self.mirror.slope() * s;
                // The directions across the axis are x and the one square to both.
                let across = [0.0, a[2], -a[1]];
                Some(std::array::from_fn(|i| a[i] * s + r * (if i == 0 { cos } else { sin * across[i] })))
            }
        }
    }

    /// Returns the height of the mirror; if it is not known, one that shows all of the artwork.
    pub(super) fn height(&self) -> f64 {
        self.mirror.height().unwrap_or_else(|| 1.1 * self.needed_height())
    }
}

/// A part of a mirror's scene in space.
#[derive(Debug, Clone, Copy)]
pub(super) enum ScenePart {
    /// The drawing on the table.
    Table,
    /// The picture in the mirror.
    Picture,
    /// The mirror, with this height.
    Mirror(f64),
}

/// A ray reflected by the mirror.
struct ReflectedRay<S> {
    /// The point H of the mirror.
    hit: [S; 3],
    /// The direction after the reflection.
    direction: [S; 3],
    /// The discriminant of the quadratic for λ; negative if the ray misses the mirror.
    discriminant: S,
    /// The position along the axis of H.
    s: S,
    /// The distance from the ray's start to H.
    lambda: S,
    /// Positive where the mirror faces the eye.
    facing: S,
}

impl Formula for Reflection {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let (x, z) = self.table(x, y);
        (x + self.foot.x, -z + self.foot.y)
    }

    fn creases(&self, out: &mut Creases) {
        let reflection = self.clone();
        out.push(Crease::edge(Level::Field(Arc::new(move |p: Point| reflection.fault(p).0))));
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(MirrorInverse::new(self.clone())))
    }
}

/// The inverse. A convex mirror shows each point of the table at most once, so any solution is the only one.
struct MirrorInverse {
    reflection: Reflection,
    /// Points of the artwork, and their images.
    starts: Vec<[Point; 2]>,
}

impl MirrorInverse {
    fn new(reflection: Reflection) -> Self {
        /// Starts along either axis of the artwork's box.
        const SIDE: u32 = 24;
        let r = reflection.domain;
        let share = |k: u32| (f64::from(k) + 0.5) / f64::from(SIDE);
        let point = |k: u32| Point::new(r.x0 + share(k % SIDE) * r.width(), r.y0 + share(k / SIDE) * r.height());
        let starts = (0..SIDE * SIDE).map(point).filter(|p| reflection.fault(*p).0 > 0.0);
        let starts = starts.map(|p| [p, Map::point(&reflection, p)]).collect();
        Self { reflection, starts }
    }

    /// Solves by damped Newton steps, from the points of the artwork whose images are nearest.
    fn solve(&self, q: Point) -> Option<Jet> {
        const STEPS: usize = 60;
        const TRIES: usize = 4;
        let mut starts: Vec<(f64, Point)> = self.starts.iter().map(|[p, image]| (image.distance(q), *p)).collect();
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        starts.into_iter().take(TRIES).find_map(|(mut distance, mut p)| {
            for _ in 0..STEPS {
                let jet = Map::jet(&self.reflection, p);
                let gap = q - jet.p;
                let step = Vec2::new(gap.cross(jet.dy), jet.dx.cross(gap)) / jet.det();
                let halved = (0..12).map(|k| p + step * 0.5_f64.powi(k));
                let mut halved = halved.map(|p| (Map::point(&self.reflection, p).distance(q), p));
                let Some(nearer) = halved.find(|(next, _)| *next < distance) else { break };
                (distance, p) = nearer;
            }
            let jet = Map::jet(&self.reflection, p);
            let size = (q - self.reflection.foot).hypot() + self.reflection.mirror.radius();
            let found = jet.p.distance(q) <= 1e-10 * size && self.reflection.fault(p).0 > 0.0;
            let det = jet.det();
            found.then(|| Jet { p, dx: Vec2::new(jet.dy.y, -jet.dx.y) / det, dy: Vec2::new(-jet.dy.x, jet.dx.x) / det })
        })
    }
}

impl Map for MirrorInverse {
    fn jet(&self, q: Point) -> Jet {
        self.solve(q).unwrap_or(Jet::UNDEFINED)
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(self.reflection.clone()))
    }

    fn cost(&self) -> Cost<'_> {
        Cost::new(64.0)
    }
}
