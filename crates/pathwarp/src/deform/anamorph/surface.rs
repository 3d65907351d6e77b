//! Surfaces in front of the eye, and their intersections with the rays through a drawing.
//!
//! Space is measured in user units: x to the right, y down, z away from the viewer; the drawing lies in z = 0 and the eye O at
//! (x, y, −distance). The ray through the drawing's point p is O + λ·d, d = (p, 0) − O, and the surface determines λ = 1/δ:
//!
//! - a plane through P with normal n: δ = n·d / n·(P − O), linear in p;
//! - a net of control points on rays, or the sphere on whose near pole the eye sits and whose far pole touches the drawing
//!   (δ = |d|²/distance², the inverse of the stereographic projection): δ is a polynomial;
//! - cylinders, cones and other spheres: the nearer root of a quadratic aλ² + 2bλ + c = 0, or the positive one from inside,
//!   each in the form that does not cancel, λ = c/(−b ± √(b² − ac)).
//!
//! J. Sánchez-Reyes, J. M. Chacón, *Anamorphic free-form deformation*, CAGD 46 (2016), §3, for the polynomial ones.

use super::dilation::Dilation;
use crate::map::Real;
use crate::map::polynomial::Plane;
use kurbo::{Affine, Point, Rect};

/// A vector or point in space.
pub(crate) type Space = [f64; 3];

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

fn unit(a: Space) -> Space {
    let n = length(a);
    a.map(|v| v / n)
}

/// Returns the directions (right, down) of a picture that looks along `forward`. It is upright, or with its bottom towards the viewer
/// if it looks straight up or down.
pub(super) fn picture_axes(forward: Space) -> [Space; 2] {
    const DOWN: Space = [0.0, 1.0, 0.0];
    let right = cross(DOWN, forward);
    let right = if length(right) < 1e-12 { [1.0, 0.0, 0.0] } else { unit(right) };
    [right, cross(forward, right)]
}

/// A plane in space with coordinates in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SpacePlane {
    /// A point of the plane.
    pub(crate) through: Space,
    /// Its unit normal, away from the eye.
    pub(crate) normal: Space,
    /// Unit vectors: rightwards and down the page, as seen from the eye's side.
    pub(crate) axes: [Space; 2],
    /// The coordinates of `through` in the plane.
    pub(crate) at: Point,
}

impl SpacePlane {
    /// Creates the plane through a point; `normal` points away from the eye.
    #[must_use]
    pub(crate) fn new(through: Space, normal: Space, at: Point) -> Self {
        let normal = unit(normal);
        Self { through, normal, axes: picture_axes(normal), at }
    }
}

/// A cylinder or cone with a vertical (or horizontal) axis that touches the plane of the drawing along a line or at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Round {
    /// The point of contact, `radius` away from the axis.
    pub(crate) middle: Point,
    /// The radius there.
    pub(crate) radius: f64,
    /// Growth of the radius per unit downwards (rightwards for a horizontal axis); 0 for a cylinder.
    pub(crate) slope: f64,
    /// The axis is horizontal.
    pub(crate) level: bool,
    /// It is seen from inside.
    pub(crate) inside: bool,
}

/// A sphere that touches the plane of the drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sphere {
    /// The point of contact.
    pub(crate) middle: Point,
    /// Its radius.
    pub(crate) radius: f64,
    /// It is seen from inside.
    pub(crate) inside: bool,
}

/// A surface given by a polynomial δ.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Radial {
    pub(super) pre: Affine,
    pub(super) delta: Plane,
    pub(super) domain: Rect,
}

/// The surface that the drawing is projected onto.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Surface {
    /// A plane.
    Plane(SpacePlane),
    /// A cylinder or cone.
    Round(Round),
    /// A sphere.
    Sphere(Sphere),
    /// Control points moved along rays.
    Radial(Radial),
}

/// An eye and a surface: takes points of the drawing to the points in space on the same ray.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Anamorphosis {
    /// The foot of the perpendicular from the eye to the drawing.
    pub(crate) foot: Point,
    /// The eye's distance in front of the drawing; positive.
    pub(crate) distance: f64,
    /// The surface that the drawing is projected onto.
    pub(crate) surface: Surface,
}

/// aλ² + 2bλ + c = 0 along a ray.
struct Quadratic<S> {
    a: S,
    b: S,
    c: f64,
}

impl<S: Real> Quadratic<S> {
    fn root(&self) -> S {
        let root = (self.b * self.b - self.a * self.c).sqrt();
        S::from(self.c) / (if self.c > 0.0 { root } else { -root } - self.b)
    }
}

impl Quadratic<f64> {
    /// Positive where there is a root in front of the eye.
    fn defined(&self) -> f64 {
        let d = self.b * self.b - self.a * self.c;
        if d <= 0.0 {
            return d;
        }
        let root = d.sqrt();
        d.min(if self.c > 0.0 { root - self.b } else { root + self.b })
    }
}

impl Round {
    /// Returns the ray through (x, y) from the eye, after swapping coordinates for a horizontal axis.
    fn ray<S: Real>(&self, foot: Point, distance: f64, x: S, y: S) -> Quadratic<S> {
        let (x, y, foot, middle) =
            if self.level { (y, x, swap(foot), swap(self.middle)) } else { (x, y, foot, self.middle) };
        let (dx, dy) = (x - foot.x, y - foot.y);
        let g = self.slope;
        let (ox, oz) = (foot.x - middle.x, -distance - self.axis());
        let radius = self.radius + g * (foot.y - middle.y);
        Quadratic {
            a: dx * dx + distance * distance - dy * dy * (g * g),
            b: dx * ox + distance * oz - dy * (g * radius),
            c: ox * ox + oz * oz - radius * radius,
        }
    }

    /// Returns the z of the axis.
    pub(super) fn axis(&self) -> f64 {
        if self.inside { -self.radius } else { self.radius }
    }

    /// Returns the radius at a point in space.
    pub(super) fn radius_at(&self, q: Space) -> f64 {
        let along = if self.level { q[0] - self.middle.x } else { q[1] - self.middle.y };
        self.radius + self.slope * along
    }
}

pub(super) fn swap(p: Point) -> Point {
    Point::new(p.y, p.x)
}

impl Sphere {
    fn ray<S: Real>(&self, foot: Point, distance: f64, x: S, y: S) -> Quadratic<S> {
        let (dx, dy) = (x - foot.x, y - foot.y);
        let o = minus([foot.x, foot.y, -distance], self.centre());
        Quadratic {
            a: dx * dx + dy * dy + distance * distance,
            b: dx * o[0] + dy * o[1] + distance * o[2],
            c: dot(o, o) - self.radius * self.radius,
        }
    }

    /// Returns the centre.
    #[must_use]
    pub(crate) fn centre(&self) -> Space {
        [self.middle.x, self.middle.y, if self.inside { -self.radius } else { self.radius }]
    }
}

impl Radial {
    /// Returns the surface of a net whose control points are moved along rays.
    #[must_use]
    pub(crate) fn net(dilation: &Dilation) -> Self {
        let (pre, delta) = dilation.plane();
        Self { pre, delta, domain: dilation.domain() }
    }

    /// Returns the sphere that has the eye on its near pole and touches the drawing with its far pole: δ = 1 + |p − foot|²/distance².
    #[must_use]
    pub(crate) fn stereographic(foot: Point, distance: f64, domain: Rect) -> Self {
        let pre = Affine::scale(1.0 / distance) * Affine::translate(-foot.to_vec2());
        Self { pre, delta: Plane::new(vec![vec![1.0, 0.0, 1.0], vec![], vec![1.0]]), domain }
    }

    fn at<S: Real>(&self, x: S, y: S) -> S {
        let [a, b, c, d, e, f] = self.pre.as_coeffs();
        self.delta.at(x * a + y * c + e, x * b + y * d + f)
    }
}

impl Anamorphosis {
    /// Returns the eye.
    #[must_use]
    pub(crate) fn eye(&self) -> Space {
        [self.foot.x, self.foot.y, -self.distance]
    }

    /// Returns the factor by which the image of (x, y) is further from the eye.
    fn stretch<S: Real>(&self, x: S, y: S) -> S {
        match &self.surface {
            Surface::Plane(p) => {
                let across = dot(p.normal, minus(p.through, self.eye()));
                let n = p.normal;
                S::from(across) / ((x - self.foot.x) * n[0] + (y - self.foot.y) * n[1] + self.distance * n[2])
            }
            Surface::Round(r) => r.ray(self.foot, self.distance, x, y).root(),
            Surface::Sphere(s) => s.ray(self.foot, self.distance, x, y).root(),
            Surface::Radial(r) => S::from(1.0) / r.at(x, y),
        }
    }

    /// Returns the image in space.
    pub(super) fn at<S: Real>(&self, x: S, y: S) -> [S; 3] {
        let k = self.stretch(x, y);
        [(x - self.foot.x) * k + self.foot.x, (y - self.foot.y) * k + self.foot.y, (k - 1.0) * self.distance]
    }

    /// Returns the point of the surface that the eye sees at the drawing's point `p`.
    #[must_use]
    pub(crate) fn point(&self, p: Point) -> Space {
        self.at(p.x, p.y)
    }

    /// Positive where the ray through `p` meets the surface.
    #[must_use]
    pub(crate) fn defined(&self, p: Point) -> f64 {
        match &self.surface {
            Surface::Round(r) => {
                let d = r.ray(self.foot, self.distance, p.x, p.y).defined();
                if d > 0.0 { d.min(r.radius_at(self.point(p))) } else { d }
            }
            Surface::Sphere(s) => s.ray(self.foot, self.distance, p.x, p.y).defined(),
            Surface::Plane(_) => 1.0 / self.stretch(p.x, p.y),
            Surface::Radial(r) => r.at(p.x, p.y),
        }
    }
}
