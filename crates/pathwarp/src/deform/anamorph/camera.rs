//! Views of an anamorphosis: unrolled true to size, from the eye, and from elsewhere.
//!
//! **Unrolled.** A plane has coordinates in itself. A cylinder or cone is cut along its far line and rolled out. With the
//! radius R(y) = r + g·(y − y₀), σ = √(1 + g²) and κ = −g/σ, the point at angle θ and height y lies, measured from the middle
//! (x₀, y₀), at
//!
//! > X = R·sin(κθ)/κ,  Y = σ·(y − y₀) + 2R·sin²(κθ/2)/κ
//!
//! which are polar coordinates about the cone's apex, written so that the cylinder (κ → 0: X = rθ, Y = y − y₀) is no special
//! case. Both directions are in closed form: (X, Y) gives R = |(κX, r − κY)|, κθ its angle, σ(y − y₀) = (2rY − κ(X² + Y²))/(r + R),
//! and a point in space is seen at O + (q − O)·D/(z + D), D being the eye's distance and z the point's depth.
//!
//! **From elsewhere.** A pinhole camera at C looks at the image of the drawing's middle, scaled so that the surroundings of that
//! point are true to size. Where δ is a polynomial of degree n, so are numerators and denominator of the view.

use super::surface::{Anamorphosis, Radial, Round, Space, Surface, dot, length, minus, picture_axes, swap};
use crate::map::polynomial::{Plane, Quotient, source_coordinates};
use crate::map::{AffineMap, Crease, Creases, Formula, Level, Map, NewtonInverse, Real};
use kurbo::{Affine, Point, Rect};
use std::sync::Arc;

/// A pinhole camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Camera {
    /// Its position.
    pub(crate) at: Space,
    forward: Space,
    axes: [Space; 2],
    reach: f64,
    centre: Point,
}

impl Camera {
    /// Creates a camera at `at` that looks towards `target`, which appears at `centre`, true to size. `None` if the two coincide.
    #[must_use]
    pub(crate) fn new(at: Space, target: Space, centre: Point) -> Option<Self> {
        let along = minus(target, at);
        let reach = length(along);
        let forward = along.map(|v| v / reach);
        (reach > 0.0 && reach.is_finite()).then(|| Self { at, forward, axes: picture_axes(forward), reach, centre })
    }

    /// Returns the distance of a point in front of the camera.
    #[must_use]
    pub(crate) fn depth_of(&self, q: Space) -> f64 {
        self.depth(q)
    }

    fn depth<S: Real>(&self, q: [S; 3]) -> S {
        project(self.forward, self.at, q)
    }
}

/// Returns n·(q − o).
fn project<S: Real>(n: Space, o: Space, [x, y, z]: [S; 3]) -> S {
    (x - o[0]) * n[0] + (y - o[1]) * n[1] + (z - o[2]) * n[2]
}

impl Anamorphosis {
    /// Returns δ, if it is a polynomial, with its coordinates and its domain.
    fn polynomial(&self) -> Option<(Affine, Plane, Rect)> {
        match &self.surface {
            Surface::Radial(Radial { pre, delta, domain }) => Some((*pre, delta.clone(), *domain)),
            Surface::Plane(p) => {
                let k = 1.0 / dot(p.normal, minus(p.through, self.eye()));
                let [nx, ny, nz] = p.normal.map(|v| v * k);
                let pre = Affine::translate(-self.foot.to_vec2());
                Some((pre, Plane::linear([nz * self.distance, nx, ny]), Rect::ZERO))
            }
            _ => None,
        }
    }

    /// Returns the quotient (axis₀·(q − from), axis₁·(q − from))·scale / depth + origin of the image q, if δ is a polynomial.
    /// Without a `depth` direction it is undivided.
    fn flattened(
        &self,
        from: Space,
        axes: [Space; 2],
        scale: f64,
        depth: Option<Space>,
        origin: Point,
    ) -> Option<Quotient> {
        let (pre, delta, domain) = self.polynomial()?;
        let [x, y] = source_coordinates(pre);
        // n·(q − from)·δ = n·(O − from)·δ + n·d.
        let along = |n: Space| {
            let d = Plane::linear(std::array::from_fn(|i| {
                let foot = if i == 0 { n[0] * self.foot.x + n[1] * self.foot.y - n[2] * self.distance } else { 0.0 };
                n[0] * x[i] + n[1] * y[i] - foot
            }));
            d.plus(dot(n, minus(self.eye(), from)), &delta)
        };
        let [u, v] = axes.map(|n| along(n).scaled(scale));
        Some(match depth {
            None => Quotient::rational(pre, origin, u, v, delta, domain),
            Some(n) => Quotient::rational(pre, origin, u, v, along(n), domain).guarded(delta),
        })
    }

    /// Returns the surface laid flat, true to size; `None` for surfaces that cannot be.
    #[must_use]
    pub(crate) fn unrolled(&self) -> Option<Arc<dyn Map>> {
        match &self.surface {
            Surface::Plane(p) => Some(self.flattened(p.through, p.axes, 1.0, None, p.at)?.simplest()),
            Surface::Round(r) => Some(Arc::new(Unrolled { of: self.clone(), round: *r })),
            _ => None,
        }
    }

    /// Returns the eye's view: the drawing itself, computed through space.
    #[must_use]
    pub(crate) fn seen(&self) -> Arc<dyn Map> {
        Arc::new(Seen(self.clone()))
    }

    /// Returns a camera's view. The inverse is searched over `domain`.
    #[must_use]
    pub(crate) fn viewed(&self, camera: &Camera, domain: Rect) -> Arc<dyn Map> {
        match self.flattened(camera.at, camera.axes, camera.reach, Some(camera.forward), camera.centre) {
            Some(q) => q.simplest(),
            None => Arc::new(Viewed { of: self.clone(), camera: *camera, domain }),
        }
    }

    fn edge(&self) -> Crease {
        let own = self.clone();
        Crease::edge(Level::Field(Arc::new(move |p| own.defined(p))))
    }

    /// Returns the point of the drawing at which the eye sees a point in space.
    fn back<S: Real>(&self, [x, y, z]: [S; 3]) -> (S, S) {
        let k = S::from(self.distance) / (z + self.distance);
        ((x - self.foot.x) * k + self.foot.x, (y - self.foot.y) * k + self.foot.y)
    }
}

struct Seen(Anamorphosis);

impl Formula for Seen {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        self.0.back(self.0.at(x, y))
    }

    fn creases(&self, out: &mut Creases) {
        out.push(self.0.edge());
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(AffineMap::IDENTITY))
    }
}

struct Viewed {
    of: Anamorphosis,
    camera: Camera,
    domain: Rect,
}

impl Formula for Viewed {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let q = self.of.at(x, y);
        let c = &self.camera;
        let k = S::from(c.reach) / c.depth(q);
        let [u, v] = c.axes.map(|n| project(n, c.at, q) * k);
        (u + c.centre.x, v + c.centre.y)
    }

    fn creases(&self, out: &mut Creases) {
        out.push(self.of.edge());
        let (of, camera) = (self.of.clone(), self.camera);
        out.push(Crease::edge(Level::Field(Arc::new(move |p| {
            if of.defined(p) > 0.0 { camera.depth(of.point(p)) } else { 1.0 }
        }))));
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        let own = Self { of: self.of.clone(), camera: self.camera, domain: self.domain };
        let reach = 1e-9 * (self.domain.width() + self.domain.height());
        Some(Arc::new(NewtonInverse::new(Arc::new(own), self.domain, reach, [1, 1])))
    }
}

/// A cylinder or cone rolled out.
#[derive(Clone)]
struct Unrolled {
    of: Anamorphosis,
    round: Round,
}

impl Unrolled {
    /// Returns the surface, κ, σ, and its middle after turning the axis vertical.
    fn round(&self) -> (Round, f64, f64, Point) {
        let r = self.round;
        let sigma = r.slope.hypot(1.0);
        (r, -r.slope / sigma, sigma, if r.level { swap(r.middle) } else { r.middle })
    }
}

impl Formula for Unrolled {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let (r, kappa, sigma, m) = self.round();
        let [x, y, z] = self.of.at(x, y);
        let (x, y) = if r.level { (y, x) } else { (x, y) };
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
        if r.level { (v, u) } else { (u, v) }
    }

    fn creases(&self, out: &mut Creases) {
        out.push(self.of.edge());
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(Rolled(self.clone())))
    }
}

/// The inverse: rolled up again, and seen by the eye.
struct Rolled(Unrolled);

impl Formula for Rolled {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let (r, kappa, sigma, m) = self.0.round();
        let (x, y) = if r.level { (y, x) } else { (x, y) };
        let (u, v) = (x - m.x, y - m.y);
        let (radius, angle, dy) = if kappa == 0.0 {
            (S::from(r.radius), u / r.radius, v)
        } else {
            let (p, q) = (u * kappa, v * -kappa + r.radius);
            let radius = p.hypot(q);
            let t = (v * (2.0 * r.radius) - (u * u + v * v) * kappa) / (radius + r.radius);
            (radius, p.atan2(q) / kappa, t / sigma)
        };
        let towards = radius * angle.cos();
        let z = if r.inside { towards } else { -towards } + r.axis();
        let (x, y) = (radius * angle.sin() + m.x, dy + m.y);
        self.0.of.back(if r.level { [y, x, z] } else { [x, y, z] })
    }

    /// Behind the eye nothing is seen.
    fn creases(&self, _: &mut Creases) {}

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(self.0.clone()))
    }
}
