//! A swirl: artwork is turned about a centre, by an angle that decreases with the distance.
//!
//! The map keeps the distance r from the centre, and areas, being a shear in r²/2 and the polar angle; its inverse is the swirl by the
//! opposite angle. It is the twist of A. Barr, *Global and local deformations of solid primitives*, SIGGRAPH 1984, with the radius in the
//! role of the axis.

use super::entry::{Built, Case, Entry, Example, Info, Law};
use crate::error::Error;
use crate::map::{AffineMap, Class, Crease, Creases, Formula, Level, Map, Real};
use crate::param::{Axis, Choice as _, Kind, choice, parameters};
use kurbo::{Affine, Point, Rect};
use std::sync::Arc;

parameters! {
    /// A swirl: artwork turned about a centre, by an angle that falls off with the distance.
    ///
    /// In polar coordinates about the centre (r, θ) ↦ (r, θ + α·f(r/R)), α being the angle, R the radius and f the [`Falloff`]. Areas are kept.
    ///
    /// ```
    /// use pathwarp::{deform::Swirl, kurbo::Point, map::Map};
    ///
    /// let swirl = Swirl::new((50.0, 50.0), 40.0).angle(90.0).build()?;
    /// assert_eq!(swirl.map.point(Point::new(90.0, 50.0)), Point::new(90.0, 50.0)); // The rim stays.
    /// # Ok::<(), pathwarp::Error>(())
    /// ```
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Swirl(s) {
        /// Angle at the centre, clockwise on the screen.
        angle: f64 = angle("angle").default("45").slider(-360.0, 360.0);
        /// Centre of the swirl.
        center: Point = new("center", Kind::Point).default("50%,50%");
        /// Radius at which the swirl ends; 50% reaches the artwork's corners.
        radius: f64 = length("radius", Axis::Diagonal).default("50%").within(1e-6, 1e9).slider(1.0, 1000.0);
        /// Falloff of the angle: soft at centre and rim, sharp (linear, with a kink at the rim), or endless (a bell curve).
        falloff: Falloff = new("falloff", Kind::Choice(Falloff::WORDS)).default("soft");
    }
}

impl Swirl {
    /// Creates a swirl by 45° that ends at `radius`, 1e-6 to 1e9 user units from `center`.
    pub fn new(center: impl Into<Point>, radius: f64) -> Self {
        Self { center: center.into(), radius, ..Self::defaults(Rect::ZERO) }
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Usage`] for a radius out of range.
    pub fn build(&self) -> Result<Built, Error> {
        self.check()?;
        let Self { center, radius, angle, falloff } = *self;
        let inner = Inner { center, radius, angle: angle.to_radians(), falloff };
        Ok(Built::new(if falloff == Falloff::Endless { Arc::new(inner) } else { Arc::new(SwirlMap(inner)) }))
    }
}

choice! {
    /// The share f(ρ) of a swirl's angle at ρ = r/R.
    #[non_exhaustive]
    pub enum Falloff {
        /// (1 − ρ²)² up to the rim, then nothing: smooth, its curvature jumps at the rim.
        Soft = "soft",
        /// 1 − ρ up to the rim, then nothing: a kink at the rim.
        Sharp = "sharp",
        /// exp(−2ρ²) everywhere.
        Endless = "endless",
    }
}

static INFO: Info = Info::new("swirl", "turn the middle, and keep the rim")
    .group("Classics")
    .about("Turns artwork about a centre by an angle that falls off to nothing at the radius. Circles about the centre stay \
themselves, no area changes, and outside the radius nothing moves (with --falloff endless, hardly anything).")
    .source("elementary; the twist of A. Barr, Global and local deformations of solid primitives, SIGGRAPH 1984, in the plane")
    .params(Swirl::PARAMS)
    .demo(&[("angle", "120"), ("radius", "40"), ("falloff", "sharp")])
    .examples(&[
        Example { what: "As it comes", command: "swirl samples/logo.svg -o out.svg" },
        Example {
            what: "A whole turn of the middle only",
            command: "swirl samples/grid.svg --angle 1turn --radius 30% -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("angle", "0")]),
        Law::Area(&[], 1.0),
        Law::Area(&[("falloff", "sharp")], 1.0),
        Law::Area(&[("falloff", "endless"), ("angle", "-400")], 1.0),
        Law::Undoes(&[("angle", "200"), ("center", "30,40")], &[("angle", "-200"), ("center", "30,40")]),
        Law::Undoes(&[("falloff", "endless")], &[("falloff", "endless"), ("angle", "-45")]),
    ])
    .cases(&[
        // The centre and the rim stay; half-way out, sharp turns by half the angle and soft by 9/16 of it.
        Case { args: &[("radius", "40")], at: (50.0, 50.0), to: (50.0, 50.0), tolerance: 0.0 },
        Case { args: &[("radius", "40")], at: (90.0, 50.0), to: (90.0, 50.0), tolerance: 0.0 },
        Case {
            args: &[("radius", "40"), ("angle", "180"), ("falloff", "sharp")],
            at: (70.0, 50.0),
            to: (50.0, 70.0),
            tolerance: 1e-12,
        },
        Case { args: &[("radius", "40"), ("angle", "160")], at: (70.0, 50.0), to: (50.0, 70.0), tolerance: 1e-12 },
        Case {
            args: &[("radius", "40"), ("angle", "148.41315910257657"), ("falloff", "endless")],
            at: (90.0, 50.0),
            // exp(−2) of it: 20.0855… degrees.
            to: (50.0 + 40.0 * 0.939_180_971_610_258_4, 50.0 + 40.0 * 0.343_422_629_663_816_7),
            tolerance: 1e-9,
        },
    ]);

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| Swirl::read(s)?.build());

/// The formula inside the disc, continued outside.
#[derive(Debug, Clone, Copy)]
struct Inner {
    center: Point,
    radius: f64,
    /// Radians.
    angle: f64,
    falloff: Falloff,
}

impl Formula for Inner {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let (u, v) = (x - self.center.x, y - self.center.y);
        let f = match self.falloff {
            Falloff::Sharp => -(u.hypot(v) / self.radius) + 1.0,
            Falloff::Soft => (-((u * u + v * v) / (self.radius * self.radius)) + 1.0).powi(2),
            Falloff::Endless => ((u * u + v * v) * (-2.0 / (self.radius * self.radius))).exp(),
        };
        let (sin, cos) = ((f * self.angle).sin(), (f * self.angle).cos());
        (u * cos - v * sin + self.center.x, u * sin + v * cos + self.center.y)
    }

    fn class(&self) -> Class {
        if self.angle == 0.0 { Class::Affine(Affine::IDENTITY) } else { Class::Smooth }
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(Self { angle: -self.angle, ..*self }))
    }
}

/// The swirl inside the disc, and the identity outside.
#[derive(Debug, Clone, Copy)]
struct SwirlMap(Inner);

impl SwirlMap {
    /// Returns `true` inside the disc.
    fn contains(&self, p: Point) -> bool {
        (p - self.0.center).hypot() < self.0.radius
    }
}

impl Formula for SwirlMap {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        if self.contains(Point::new(x.value(), y.value())) { self.0.f(x, y) } else { (x, y) }
    }

    fn class(&self) -> Class {
        Formula::class(&self.0)
    }

    fn creases(&self, out: &mut Creases) {
        let Inner { center, radius, .. } = self.0;
        out.push(Crease::kink(Level::Circle { center, radius }));
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        Some(if self.contains(inside) { Arc::new(self.0) } else { Arc::new(AffineMap::IDENTITY) })
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(Self(Inner { angle: -self.0.angle, ..self.0 })))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check;
    use crate::deform::Deformation as _;
    use crate::param::Args;

    #[test]
    fn is_sound() {
        let faults = check::entry(&ENTRY);
        assert!(faults.is_empty(), "{faults:#?}");
    }

    #[test]
    fn the_centre_turns_by_the_whole_angle() {
        for falloff in ["soft", "sharp", "endless"] {
            let b =
                ENTRY.build_from(&Args::from_pairs(&[("falloff", falloff), ("angle", "90")]), &check::frame()).unwrap();
            let j = b.map.jet(Point::new(50.0, 50.0));
            assert!((j.dx - kurbo::Vec2::new(0.0, 1.0)).hypot() < 1e-12, "{falloff}: {j:?}");
            assert!((j.dy - kurbo::Vec2::new(-1.0, 0.0)).hypot() < 1e-12, "{falloff}: {j:?}");
        }
    }
}
