//! Surfaces onto which artwork is projected, and views of them.
//!
//! Coordinates in space are in user units, x to the right, y down, z away from the viewer. The drawing lies in z = 0 and the eye O at
//! (x, y, −distance). The ray through the drawing's point p is O + λ·d, d = (p, 0) − O, and the surface determines λ = 1/δ:
//!
//! - a plane through P with normal n: δ = n·d / n·(P − O), linear in p;
//! - a net of control points on rays: δ is a polynomial; also a sphere with the eye on its near pole, whose far pole touches the drawing
//!   (δ = |d|²/distance², the inverse of the stereographic projection);
//! - cylinders, cones and other spheres: λ is the nearer root of a quadratic aλ² + 2bλ + c = 0, or the further one for a hollow,
//!   computed in the form that does not cancel, λ = c/(−b ± √(b² − ac)).
//!
//! In homogeneous coordinates, an eye at infinity in the direction of the unit vector e is (e, 0) instead of (O, 1). The paper's points
//! (p, 1) + (δ − 1)·(O, 1) become p + (δ − 1)·e, so that control points move by the lengths 1 − δ. On planes δ − 1 = n·(P − p)/n·e. On
//! curved surfaces, rays start in front of the whole surface and run along the line of sight. Polynomial δ are in J. Sánchez-Reyes,
//! J. M. Chacón, *Anamorphic free-form deformation*, CAGD 46 (2016), §3.
//!
//! There are three views. **Unrolled**, a plane has two coordinates; a cylinder or cone is cut along its far line and rolled out. With
//! the radius R(y) = r + g·(y − y₀), σ = √(1 + g²) and κ = −g/σ, the point at angle θ and height y has, relative to the middle (x₀, y₀),
//! the coordinates
//!
//! > X = R·sin(κθ)/κ,  Y = σ·(y − y₀) + 2R·sin²(κθ/2)/κ
//!
//! which are polar coordinates about the cone's apex, in a form that includes the cylinder (κ → 0: X = rθ, Y = y − y₀). The inverse is in
//! closed form, too: (κX, r − κY) has the length R and the angle κθ, and σ(y − y₀) = (2rY − κ(X² + Y²))/(r + R). **From the eye**, a point
//! q in space at the depth z is seen at O + (q − O)·D/(z + D), where D is the eye's distance. **From elsewhere**, a pinhole camera looks
//! at the image of the drawing's middle, scaled so that the neighbourhood of that point is true to size. If δ is a polynomial of degree
//! n, so are the numerators and the denominator of the view.

use super::dilation::Dilation;
use super::scene::{Eye, Scene};
use crate::error::{Error, show};
use crate::map::{
    AffineMap, Crease, Creases, Formula, Level, Map, NewtonInverse, Plane, Quotient, Real, source_coordinates,
};
use kurbo::{Affine, Point, Rect};
use std::sync::Arc;

/// A surface onto which artwork is projected. Lengths are in user units, angles in degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Onto {
    /// The ground under the artwork's bottom edge.
    Floor,
    /// A plane above its top edge.
    Ceiling,
    /// A side wall along its left edge.
    LeftWall,
    /// A side wall along its right edge.
    RightWall,
    /// Ground that rises by an angle away from the eye.
    Ramp(f64),
    /// A vertical wall, its right side turned away by an angle.
    Wall(f64),
    /// A cylinder whose front touches the artwork's middle.
    Cylinder {
        /// The radius.
        radius: f64,
        /// The axis is horizontal.
        level: bool,
        /// It is seen from inside.
        inside: bool,
    },
    /// A vertical cone whose front touches the artwork's middle.
    Cone {
        /// The radius at the top.
        top: f64,
        /// The radius at the bottom.
        bottom: f64,
        /// The height; the artwork's if `None`.
        height: Option<f64>,
        /// It is seen from inside.
        inside: bool,
    },
    /// A sphere whose front touches the artwork's middle. It cannot be laid flat.
    Sphere {
        /// The radius.
        radius: f64,
        /// It is seen from inside.
        inside: bool,
    },
    /// A sphere with the eye on its near pole, on which lines become circles.
    Dome,
}

impl Onto {
    /// Returns the surface in the notation of `--onto`, for messages.
    fn text(self) -> String {
        let inside = |inside: bool| if inside { ",inside" } else { "" };
        match self {
            Self::Floor => "plane:floor".into(),
            Self::Ceiling => "plane:ceiling".into(),
            Self::LeftWall => "plane:left".into(),
            Self::RightWall => "plane:right".into(),
            Self::Ramp(a) => format!("plane:ramp={a}"),
            Self::Wall(a) => format!("plane:wall={a}"),
            Self::Cylinder { radius, level, inside: i } => {
                format!("cylinder:radius={radius}{}{}", if level { ",level" } else { "" }, inside(i))
            }
            Self::Cone { top, bottom, inside: i, .. } => {
                format!("cone:top-radius={top},bottom-radius={bottom}{}", inside(i))
            }
            Self::Sphere { radius, inside: i } => format!("sphere:radius={radius}{}", inside(i)),
            Self::Dome => "sphere:eye".into(),
        }
    }

    fn wrong(self, problem: impl Into<String>) -> Error {
        Error::usage("onto", self.text(), problem)
    }

    /// Returns the angle of a floor or ramp, radians.
    fn rise(self) -> Option<f64> {
        match self {
            Self::Floor => Some(0.0),
            Self::Ramp(a) => Some(a.to_radians()),
            _ => None,
        }
    }

    /// Returns the surface in space.
    pub(super) fn surface(self, scene: &Scene) -> Result<Surface, Error> {
        let r = scene.frame;
        let middle = r.center();
        let positive = |name: &str, v: f64| {
            if v > 0.0 && v < 1e9 { Ok(v) } else { Err(self.wrong(format!("has a {name} that is not positive"))) }
        };
        match self {
            Self::Cylinder { radius, level, inside } => {
                let radius = positive("radius", radius)?;
                Ok(Surface::Cone(Cone { middle, radius, slope: 0.0, horizontal: level, inside }))
            }
            Self::Cone { top, bottom, height, inside } => {
                let (top, bottom) = (positive("top", top)?, positive("bottom", bottom)?);
                let height = height.unwrap_or(r.height());
                if height <= 0.0 {
                    return Err(self.wrong("needs a height=… for artwork that has none"));
                }
                let (radius, slope) = ((top + bottom) / 2.0, (bottom - top) / height);
                Ok(Surface::Cone(Cone { middle, radius, slope, horizontal: false, inside }))
            }
            Self::Sphere { radius, inside } => {
                Ok(Surface::Sphere(Sphere { middle, radius: positive("radius", radius)?, inside }))
            }
            Self::Dome => match scene.eye {
                Eye::At(foot, distance) => Ok(Surface::Radial(Radial::stereographic(foot, distance, r))),
                Eye::Infinite(_) => Err(self.wrong("has the eye on it, so the eye needs a `distance`")),
            },
            _ => self.plane(scene).map(Surface::Plane),
        }
    }

    fn plane(self, scene: &Scene) -> Result<SpacePlane, Error> {
        let r = scene.frame;
        let c = r.center();
        let upright = |angle: f64| [-angle.sin(), 0.0, angle.cos()];
        let (at, normal) = match (self, self.rise()) {
            (_, Some(a)) => (Point::new(c.x, r.y1), [0.0, snap_to_zero(a.cos()), a.sin()]),
            (Self::Ceiling, _) => (Point::new(c.x, r.y0), [0.0, -1.0, 0.0]),
            (Self::LeftWall, _) => (Point::new(r.x0, c.y), [-1.0, 0.0, 0.0]),
            (Self::RightWall, _) => (Point::new(r.x1, c.y), [1.0, 0.0, 0.0]),
            (Self::Wall(a), _) => (c, upright(a.to_radians()).map(snap_to_zero)),
            _ => (c, upright(0.0).map(snap_to_zero)),
        };
        let through = [at.x, at.y, 0.0];
        let (gap, size) = match scene.eye {
            Eye::At(foot, distance) => (dot(normal, minus(through, [foot.x, foot.y, -distance])), distance),
            Eye::Infinite(towards) => (-dot(normal, towards), 1.0),
        };
        if gap <= 1e-9 * size {
            return Err(self.wrong(format!(
                "is seen from behind or edge-on by an eye {}; move the eye to its front side, for a floor above it",
                scene.eye
            )));
        }
        Ok(SpacePlane::new(through, normal, at))
    }
}

/// Rounds the cosine of a right angle to zero.
fn snap_to_zero(v: f64) -> f64 {
    if v.abs() < 1e-15 { 0.0 } else { v }
}

/// Returns the scale at which artwork `drawn` high becomes `length` long on the floor or ramp; the parent module has the formula.
pub(super) fn scale_for(
    onto: Option<Onto>,
    length: f64,
    drawn: f64,
    eye_height: Option<f64>,
    eye: Eye,
) -> Result<f64, Error> {
    let Some(angle) = onto.and_then(Onto::rise) else {
        let problem = "is for `onto plane:floor` and plane:ramp=ANGLE; elsewhere use `picture-width`";
        return Err(Error::usage("length", "", problem));
    };
    let (up, away) = (length * angle.sin(), length * angle.cos());
    let (seen, in_front) = match (eye, eye_height) {
        (Eye::Infinite(_), _) => (up + away * eye.line_of_sight()[1], true),
        (Eye::At(_, distance), Some(eye)) => (eye + (up - eye) * distance / (distance + away), distance + away > 0.0),
        (Eye::At(..), None) => {
            return Err(Error::missing("eye-height", "the height of the eye above the floor; `length` needs it"));
        }
    };
    if seen > 0.0 && in_front && drawn > 0.0 {
        return Ok(seen / drawn);
    }
    let problem = "is impossible: the eye does not see so long a stretch of this ground from its front; shorten it, or move the eye";
    Err(Error::usage("length", "", problem))
}

/// Samples the artwork's box.
pub(super) fn box_samples(r: Rect) -> impl Iterator<Item = Point> {
    const N: u32 = 16;
    let share = |k: u32| f64::from(k) / f64::from(N);
    let point = move |i, j| Point::new(r.x0 + share(i) * r.width(), r.y0 + share(j) * r.height());
    (0..=N).flat_map(move |i| (0..=N).map(move |j| point(i, j)))
}

/// Refuses a surface that a ray through the artwork's box misses.
pub(super) fn check_hit(onto: Option<Onto>, projection: &Anamorphosis, frame: Rect) -> Result<(), Error> {
    let missed = box_samples(frame).find(|p| projection.defined(*p).max(0.0) == 0.0);
    let Some(p) = missed else { return Ok(()) };
    let advice = match projection.surface {
        Surface::Plane(_) => {
            "the ray never comes down on the plane; raise the eye, go nearer, or make the artwork smaller (`picture-width`, `length`)"
        }
        Surface::Radial(_) => "the control points are pushed through infinity; push them less",
        _ => "the ray misses the surface; make the artwork smaller (`picture-width`) or the radius larger",
    };
    let problem = format!("does not hold the artwork's box: at {} {advice}", show(p));
    Err(onto.map_or_else(|| Error::usage("push", "", problem.clone()), |onto| onto.wrong(problem.clone())))
}

/// Returns the camera at `at`, whose z is in front of the drawing. Refuses one that has a part of the image behind it.
pub(super) fn camera(at: Space, projection: &Anamorphosis, scene: &Scene) -> Result<Camera, Error> {
    let [x, y, z] = at;
    let wrong = |problem: String| Error::usage("view", format!("{x},{y},{z}"), problem);
    let (p, middle) = (scene.scale * Point::new(x, y), scene.frame.center());
    let camera = Camera::new([p.x, p.y, -z], projection.point(middle), middle)
        .ok_or_else(|| wrong("is on the surface itself; move it away".into()))?;
    match box_samples(scene.frame).find(|p| camera.depth(projection.point(*p)) <= 0.0) {
        Some(p) => Err(wrong(format!("is too near: the image of {} lies behind it; go further away", show(p)))),
        None => Ok(camera),
    }
}

/// A vector or point in space.
pub(super) type Space = [f64; 3];

pub(super) fn dot(a: Space, b: Space) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Space, b: Space) -> Space {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn minus(a: Space, b: Space) -> Space {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn length(a: Space) -> f64 {
    dot(a, a).sqrt()
}

fn unit_vector(a: Space) -> Space {
    let n = length(a);
    a.map(|v| v / n)
}

/// Returns the directions right and down of a picture seen along `forward`. The picture is upright, or has its bottom towards the viewer
/// if `forward` is straight up or down.
pub(super) fn picture_axes(forward: Space) -> [Space; 2] {
    const DOWN: Space = [0.0, 1.0, 0.0];
    let right = cross(DOWN, forward);
    let right = if length(right) < 1e-12 { [1.0, 0.0, 0.0] } else { unit_vector(right) };
    [right, cross(forward, right)]
}

/// A plane in space with coordinates in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SpacePlane {
    /// A point of the plane.
    pub(super) through: Space,
    /// Its unit normal, away from the eye.
    pub(super) normal: Space,
    /// Unit vectors: rightwards and down the page, as seen from the eye's side.
    pub(super) axes: [Space; 2],
    /// The position of `through` on the sheet that is laid flat.
    pub(super) at: Point,
}

impl SpacePlane {
    /// Creates the plane through a point, which is `at` on the sheet that is laid flat; `normal` points away from the eye.
    pub(super) fn new(through: Space, normal: Space, at: Point) -> Self {
        let normal = unit_vector(normal);
        Self { through, normal, axes: picture_axes(normal), at }
    }

    /// Returns the point of the plane nearest to the eye, in its coordinates, and the distance. For an eye at infinity, returns a far point
    /// in the eye's direction, and the sine of the eye's elevation; `None` if the direction is square to the plane.
    pub(super) fn nearest(&self, eye: Eye) -> Option<(Point, f64)> {
        let to = match eye {
            Eye::At(foot, distance) => minus([foot.x, foot.y, -distance], self.through),
            Eye::Infinite(towards) => towards.map(|v| v * 1e9),
        };
        let [x, y] = self.axes.map(|a| dot(a, to));
        let height = -dot(self.normal, to);
        let at = Point::new(self.at.x + x, self.at.y + y);
        match eye {
            Eye::At(..) => Some((at, height)),
            Eye::Infinite(_) => (x.hypot(y) > 1.0).then_some((at, height * 1e-9)),
        }
    }
}

/// A cone, or a cylinder as one of slope 0, with a vertical or horizontal axis, which touches the drawing along a line or at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cone {
    /// A point of contact, `radius` away from the axis.
    pub(super) middle: Point,
    /// The radius at the point of contact.
    pub(super) radius: f64,
    /// Growth of the radius per unit downwards (rightwards for a horizontal axis); 0 for a cylinder.
    pub(super) slope: f64,
    /// The axis is horizontal.
    pub(super) horizontal: bool,
    /// It is seen from inside.
    pub(super) inside: bool,
}

/// A sphere that touches the plane of the drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sphere {
    /// The point of contact.
    pub(super) middle: Point,
    /// Its radius.
    pub(super) radius: f64,
    /// It is seen from inside.
    pub(super) inside: bool,
}

/// A surface given by a polynomial δ.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Radial {
    /// The map from the drawing to the coordinates of `delta`.
    pub(super) to_coordinates: Affine,
    pub(super) delta: Plane,
    /// The region in which the inverse is sought.
    pub(super) domain: Rect,
}

/// A surface with its position in space.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Surface {
    Plane(SpacePlane),
    Cone(Cone),
    Sphere(Sphere),
    Radial(Radial),
}

/// An eye and a surface: takes points of the drawing along their rays to the surface.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Anamorphosis {
    pub(super) eye: Eye,
    pub(super) surface: Surface,
}

/// Returns δ for a plane, as a linear form about the returned point of the drawing: constant, coefficients of x and y.
fn plane_form(eye: Eye, p: &SpacePlane) -> (Point, [f64; 3]) {
    let [nx, ny, nz] = p.normal;
    match eye {
        Eye::At(foot, distance) => {
            let across = dot(p.normal, minus(p.through, [foot.x, foot.y, -distance]));
            (foot, [nz * distance / across, nx / across, ny / across])
        }
        Eye::Infinite(towards) => {
            let across = dot(p.normal, towards);
            let distance = dot(p.normal, minus([p.at.x, p.at.y, 0.0], p.through));
            (p.at, [1.0 - distance / across, -nx / across, -ny / across])
        }
    }
}

/// The equation aλ² + 2bλ + c = 0 for the intersections of a ray with a surface.
struct Quadratic<S> {
    a: S,
    b: S,
    c: S,
    /// `true` for a hollow, whose far side is seen.
    hollow: bool,
}

impl<S: Real> Quadratic<S> {
    /// Returns `true` if the nearer root is wanted, because the eye is outside a surface that is not a hollow.
    fn is_near(&self) -> bool {
        self.c.value() > 0.0 && !self.hollow
    }

    /// Returns λ at the visible intersection.
    fn root(&self) -> S {
        let root = (self.b * self.b - self.a * self.c).sqrt();
        self.c / (if self.is_near() { root } else { -root } - self.b)
    }
}

impl Quadratic<f64> {
    /// Returns a number that is positive if there is a root in front of the eye.
    fn defined(&self) -> f64 {
        let d = self.b * self.b - self.a * self.c;
        if d <= 0.0 {
            return d;
        }
        let root = d.sqrt();
        d.min(match self.is_near() {
            true => root - self.b,
            false if self.c > 0.0 => -root - self.b,
            false => root + self.b,
        })
    }
}

impl Cone {
    /// Returns the intersections with a ray, given by its start and its direction.
    fn intersections<S: Real>(&self, [from, along]: [[S; 3]; 2]) -> Quadratic<S> {
        // The axis turned vertical.
        let turned = |[x, y, z]: [S; 3]| if self.horizontal { [y, x, z] } else { [x, y, z] };
        let middle = if self.horizontal { swapped(self.middle) } else { self.middle };
        let ([x, y, z], [dx, dy, dz]) = (turned(from), turned(along));
        let g = self.slope;
        let (ox, oz) = (x - middle.x, z - self.axis());
        let radius = (y - middle.y) * g + self.radius;
        Quadratic {
            a: dx * dx + dz * dz - dy * dy * (g * g),
            b: dx * ox + dz * oz - dy * radius * g,
            c: ox * ox + oz * oz - radius * radius,
            hollow: self.inside,
        }
    }

    /// Returns the depth z of the axis.
    pub(super) fn axis(&self) -> f64 {
        if self.inside { -self.radius } else { self.radius }
    }

    /// Returns the radius at a point in space.
    pub(super) fn radius_at(&self, q: Space) -> f64 {
        let along = if self.horizontal { q[0] - self.middle.x } else { q[1] - self.middle.y };
        self.radius + self.slope * along
    }
}

/// Exchanges x and y.
fn swapped(p: Point) -> Point {
    Point::new(p.y, p.x)
}

impl Sphere {
    /// Returns the intersections with a ray, given by its start and its direction.
    fn intersections<S: Real>(&self, [from, d]: [[S; 3]; 2]) -> Quadratic<S> {
        let centre = self.centre();
        let o: [S; 3] = std::array::from_fn(|i| from[i] - centre[i]);
        let dot = |a: [S; 3], b: [S; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        Quadratic { a: dot(d, d), b: dot(d, o), c: dot(o, o) - self.radius * self.radius, hollow: self.inside }
    }

    /// Returns the centre.
    pub(super) fn centre(&self) -> Space {
        [self.middle.x, self.middle.y, if self.inside { -self.radius } else { self.radius }]
    }
}

impl Radial {
    /// Returns the surface of a net whose control points are moved along rays.
    pub(super) fn net(dilation: &Dilation) -> Self {
        let (to_coordinates, delta) = dilation.plane();
        Self { to_coordinates, delta, domain: dilation.domain() }
    }

    /// Returns the sphere that has the eye on its near pole and touches the drawing with its far pole: δ = 1 + |p − foot|²/distance².
    pub(super) fn stereographic(foot: Point, distance: f64, domain: Rect) -> Self {
        let to_coordinates = Affine::scale(1.0 / distance) * Affine::translate(-foot.to_vec2());
        Self { to_coordinates, delta: Plane::new(vec![vec![1.0, 0.0, 1.0], vec![], vec![1.0]]), domain }
    }

    fn delta_at<S: Real>(&self, x: S, y: S) -> S {
        let [a, b, c, d, e, f] = self.to_coordinates.as_coeffs();
        self.delta.at(x * a + y * c + e, x * b + y * d + f)
    }
}

/// Distance in front of the drawing at which rays start outside a surface, in units of its radius.
const RAY_START: f64 = 4.0;

impl Anamorphosis {
    /// Returns the start and the direction of the ray through (x, y). It starts at the eye, but at most `most` in front of the drawing.
    fn ray<S: Real>(&self, x: S, y: S, most: f64) -> [[S; 3]; 2] {
        match self.eye {
            // A ray from a far eye would lose digits on the way to the surface.
            Eye::At(foot, distance) if distance > most => {
                let [u, v] = [(x - foot.x) / distance, (y - foot.y) / distance];
                [[x - u * most, y - v * most, S::from(-most)], [u, v, S::from(1.0)]]
            }
            Eye::At(foot, distance) => {
                let from = [foot.x, foot.y, -distance].map(S::from);
                [from, [x - foot.x, y - foot.y, S::from(distance)]]
            }
            Eye::Infinite(_) => {
                let v = self.eye.line_of_sight();
                [[x - most * v[0], y - most * v[1], S::from(-most)], v.map(S::from)]
            }
        }
    }

    /// Returns the image of (x, y) in space.
    pub(super) fn image<S: Real>(&self, x: S, y: S) -> [S; 3] {
        let on_ray =
            |[start, direction]: [[S; 3]; 2], lambda: S| std::array::from_fn(|i| start[i] + direction[i] * lambda);
        let delta = match &self.surface {
            Surface::Plane(p) => {
                let (at, [d, dx, dy]) = plane_form(self.eye, p);
                (x - at.x) * dx + (y - at.y) * dy + d
            }
            Surface::Radial(r) => r.delta_at(x, y),
            Surface::Cone(r) => {
                let ray = self.ray(x, y, RAY_START * r.radius);
                return on_ray(ray, r.intersections(ray).root());
            }
            Surface::Sphere(s) => {
                let ray = self.ray(x, y, RAY_START * s.radius);
                return on_ray(ray, s.intersections(ray).root());
            }
        };
        match self.eye {
            Eye::At(foot, distance) => {
                let lambda = S::from(1.0) / delta;
                [(x - foot.x) * lambda + foot.x, (y - foot.y) * lambda + foot.y, (lambda - 1.0) * distance]
            }
            Eye::Infinite(towards) => {
                let shift = delta - 1.0;
                [x + shift * towards[0], y + shift * towards[1], shift * towards[2]]
            }
        }
    }

    /// Returns the point of the surface that the eye sees at the point `p` of the drawing.
    pub(super) fn point(&self, p: Point) -> Space {
        self.image(p.x, p.y)
    }

    /// Returns a number that is positive if the ray through `p` meets the surface.
    pub(super) fn defined(&self, p: Point) -> f64 {
        match (&self.surface, self.eye) {
            (Surface::Cone(r), _) => {
                let d = r.intersections(self.ray(p.x, p.y, RAY_START * r.radius)).defined();
                if d > 0.0 { d.min(r.radius_at(self.point(p))) } else { d }
            }
            (Surface::Sphere(s), _) => s.intersections(self.ray(p.x, p.y, RAY_START * s.radius)).defined(),
            (_, Eye::Infinite(_)) => 1.0,
            (Surface::Plane(s), _) => {
                let (at, [d, dx, dy]) = plane_form(self.eye, s);
                d + dx * (p.x - at.x) + dy * (p.y - at.y)
            }
            (Surface::Radial(r), _) => r.delta_at(p.x, p.y),
        }
    }
}

/// A pinhole camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Camera {
    position: Space,
    /// The unit vector of the direction in which it looks.
    forward: Space,
    /// The directions right and down of its picture.
    axes: [Space; 2],
    /// The distance from the point at which it looks.
    distance: f64,
    /// The point of the picture where that point appears.
    centre: Point,
}

impl Camera {
    /// Creates a camera that looks towards `target`, which appears at `centre`, true to size. `None` if the two coincide.
    pub(super) fn new(position: Space, target: Space, centre: Point) -> Option<Self> {
        let along = minus(target, position);
        let distance = length(along);
        let forward = along.map(|v| v / distance);
        let axes = picture_axes(forward);
        (distance > 0.0 && distance.is_finite()).then_some(Self { position, forward, axes, distance, centre })
    }

    /// Returns the distance of a point in front of the camera.
    pub(super) fn depth<S: Real>(&self, q: [S; 3]) -> S {
        component(self.forward, self.position, q)
    }
}

/// Returns n·(q − o), where q = (x, y, z).
fn component<S: Real>(n: Space, o: Space, [x, y, z]: [S; 3]) -> S {
    (x - o[0]) * n[0] + (y - o[1]) * n[1] + (z - o[2]) * n[2]
}

impl Anamorphosis {
    /// Returns the quotient (axis₀·(q − from), axis₁·(q − from))·scale / (depth·(q − from)) + origin of the image q, if δ is a polynomial.
    /// Without a `depth` direction there is no division.
    fn flattened(
        &self,
        from: Space,
        axes: [Space; 2],
        scale: f64,
        depth: Option<Space>,
        origin: Point,
    ) -> Option<Quotient> {
        let (to_coordinates, delta, domain) = match &self.surface {
            Surface::Radial(r) => (r.to_coordinates, r.delta.clone(), r.domain),
            Surface::Plane(p) => {
                let (at, form) = plane_form(self.eye, p);
                (Affine::translate(-at.to_vec2()), Plane::linear(form), Rect::ZERO)
            }
            _ => return None,
        };
        let one = Plane::linear([1.0, 0.0, 0.0]);
        // The paper's point (p, 1) + (δ − 1)·(O, w) of a ray, whose weight is δ, or 1 for an eye at infinity with w = 0.
        let (eye, weight) = match self.eye {
            Eye::At(foot, distance) => ([foot.x, foot.y, -distance], delta.clone()),
            Eye::Infinite(towards) => (towards, one.clone()),
        };
        let [x, y] = source_coordinates(to_coordinates);
        // Times the point's weight, n·(q − from) is n·(p − from) + (δ − 1)·n·(O − w·from).
        let along = |n: Space| {
            let d = Plane::linear(std::array::from_fn(|i| {
                let [x, y, z] = if i == 0 { [x[0] - from[0], y[0] - from[1], -from[2]] } else { [x[i], y[i], 0.0] };
                n[0] * x + n[1] * y + n[2] * z
            }));
            let o = if self.eye.is_infinite() { dot(n, eye) } else { dot(n, minus(eye, from)) };
            d.plus(o, &delta).plus(-o, &one)
        };
        let [u, v] = axes.map(|n| along(n).scaled(scale));
        Some(match depth {
            None => Quotient::rational(to_coordinates, origin, u, v, weight, domain),
            Some(n) => Quotient::rational(to_coordinates, origin, u, v, along(n), domain).guarded(weight),
        })
    }

    /// Returns the surface laid flat, true to size; `None` for a surface for which this is impossible.
    pub(super) fn unrolled(&self) -> Option<Arc<dyn Map>> {
        match &self.surface {
            Surface::Plane(p) => Some(self.flattened(p.through, p.axes, 1.0, None, p.at)?.simplest()),
            Surface::Cone(r) => Some(Arc::new(Unrolled { projection: self.clone(), cone: *r })),
            _ => None,
        }
    }

    /// Returns the eye's view, which is the drawing itself, computed through space.
    pub(super) fn eye_view(&self) -> Arc<dyn Map> {
        Arc::new(EyeView(self.clone()))
    }

    /// Returns a camera's view. The inverse is sought over `domain`.
    pub(super) fn camera_view(&self, camera: &Camera, domain: Rect) -> Arc<dyn Map> {
        match self.flattened(camera.position, camera.axes, camera.distance, Some(camera.forward), camera.centre) {
            Some(q) => q.simplest(),
            None => Arc::new(CameraView { projection: self.clone(), camera: *camera, domain }),
        }
    }

    /// Returns the edge of the part of the drawing whose rays meet the surface.
    fn edge_crease(&self) -> Crease {
        let projection = self.clone();
        Crease::edge(Level::Field(Arc::new(move |p: Point| projection.defined(p))))
    }

    /// Returns the point of the drawing at which the eye sees a point in space.
    fn seen_at<S: Real>(&self, [x, y, z]: [S; 3]) -> (S, S) {
        match self.eye {
            Eye::At(foot, distance) => {
                let scale = S::from(distance) / (z + distance);
                ((x - foot.x) * scale + foot.x, (y - foot.y) * scale + foot.y)
            }
            Eye::Infinite(_) => {
                let v = self.eye.line_of_sight();
                (x - z * v[0], y - z * v[1])
            }
        }
    }
}

/// The eye's view of a surface.
struct EyeView(Anamorphosis);

impl Formula for EyeView {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        self.0.seen_at(self.0.image(x, y))
    }

    fn creases(&self, out: &mut Creases) {
        out.push(self.0.edge_crease());
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(AffineMap::IDENTITY))
    }
}

/// A camera's view of a surface.
#[derive(Clone)]
struct CameraView {
    projection: Anamorphosis,
    camera: Camera,
    domain: Rect,
}

impl Formula for CameraView {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let q = self.projection.image(x, y);
        let c = &self.camera;
        let scale = S::from(c.distance) / c.depth(q);
        let [u, v] = c.axes.map(|n| component(n, c.position, q) * scale);
        (u + c.centre.x, v + c.centre.y)
    }

    fn creases(&self, out: &mut Creases) {
        out.push(self.projection.edge_crease());
        let (projection, camera) = (self.projection.clone(), self.camera);
        out.push(Crease::edge(Level::Field(Arc::new(move |p: Point| {
            if projection.defined(p) > 0.0 { camera.depth(projection.point(p)) } else { 1.0 }
        }))));
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        let margin = 1e-9 * (self.domain.width() + self.domain.height());
        Some(Arc::new(NewtonInverse::new(Arc::new(self.clone()), self.domain, margin, [1, 1])))
    }
}

/// A cylinder or cone that is rolled out.
#[derive(Clone)]
struct Unrolled {
    projection: Anamorphosis,
    cone: Cone,
}

impl Unrolled {
    /// Returns the cone, κ, σ, and the middle after the axis is turned vertical.
    fn constants(&self) -> (Cone, f64, f64, Point) {
        let r = self.cone;
        let sigma = r.slope.hypot(1.0);
        (r, -r.slope / sigma, sigma, if r.horizontal { swapped(r.middle) } else { r.middle })
    }
}

impl Formula for Unrolled {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let (r, kappa, sigma, m) = self.constants();
        let [x, y, z] = self.projection.image(x, y);
        let (x, y) = if r.horizontal { (y, x) } else { (x, y) };
        let (dx, dy) = (x - m.x, y - m.y);
        let towards = z - r.axis();
        let angle = dx.atan2(if r.inside { towards } else { -towards });
        let radius = dy * r.slope + r.radius;
        let (u, v) = if kappa == 0.0 {
            (angle * radius, dy)
        } else {
            let half = (angle * (kappa / 2.0)).sin();
            (radius * (angle * kappa).sin() / kappa, dy * sigma + radius * half * half * (2.0 / kappa))
        };
        let (u, v) = (u + m.x, v + m.y);
        if r.horizontal { (v, u) } else { (u, v) }
    }

    fn creases(&self, out: &mut Creases) {
        out.push(self.projection.edge_crease());
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(RolledUp(self.clone())))
    }
}

/// The inverse: the surface is rolled up again and seen by the eye.
struct RolledUp(Unrolled);

impl Formula for RolledUp {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let (r, kappa, sigma, m) = self.0.constants();
        let (x, y) = if r.horizontal { (y, x) } else { (x, y) };
        let (u, v) = (x - m.x, y - m.y);
        let (radius, angle, dy) = if kappa == 0.0 {
            (S::from(r.radius), u / r.radius, v)
        } else {
            let (p, q) = (u * kappa, v * -kappa + r.radius);
            let radius = p.hypot(q);
            let slant = (v * (2.0 * r.radius) - (u * u + v * v) * kappa) / (radius + r.radius);
            (radius, p.atan2(q) / kappa, slant / sigma)
        };
        let towards = radius * angle.cos();
        let z = if r.inside { towards } else { -towards } + r.axis();
        let (x, y) = (radius * angle.sin() + m.x, dy + m.y);
        self.0.projection.seen_at(if r.horizontal { [y, x, z] } else { [x, y, z] })
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(self.0.clone()))
    }
}
