//! Changes of lens, which make fisheye pictures and straighten them.
//!
//! A ray that makes the angle θ with the axis meets the picture at a distance r = f·ρ(θ) from its middle, where f is the focal length and
//! ρ depends on the [`LensModel`]. The change from the lens ρ to the lens ρ' takes the distance r to r' = f'·ρ'(ρ⁻¹(r/f)) and keeps
//! directions. The inverse exchanges the lenses. The five projections are in Kannala & Brandt, *A generic camera model and calibration
//! method for conventional, wide-angle, and fish-eye lenses*, IEEE PAMI 28 (2006), equations (1)–(5).

use super::entry::{Built, Case, Entry, Example, Info, Law};
use crate::error::Error;
use crate::map::{Class, Crease, Creases, Formula, Level, Map, Real};
use crate::param::{Choice as _, Frame, Kind, choice, parameters};
use kurbo::{Affine, Point, Rect};
use std::f64::consts::PI;
use std::sync::Arc;

parameters! {
    /// A change of lens: artwork drawn by one [`LensModel`], redrawn by another, as fisheye pictures are made and straightened.
    ///
    /// r' = f'·ρ'(ρ⁻¹(r/f)) about the centre, ρ and ρ' being the two models. The focal lengths f and f' follow from the field of
    /// view across the diagonal of the artwork's box.
    ///
    /// ```
    /// use pathwarp::{deform::{Lens, LensModel}, kurbo::{Point, Rect}, map::Map};
    ///
    /// let fisheye = Lens::new(Rect::new(0.0, 0.0, 100.0, 100.0)).to(LensModel::Equidistant).field(90.0).build()?;
    /// let corner = Point::new(100.0, 0.0);
    /// assert!(fisheye.map.point(corner).distance(corner) < 1e-12);
    /// # Ok::<(), pathwarp::Error>(())
    /// ```
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Lens(s) {
        /// The lens that the artwork is drawn with.
        from: LensModel = new("from", Kind::Choice(LensModel::WORDS)).default("rectilinear");
        /// The lens to draw it with.
        to: LensModel = new("to", Kind::Choice(LensModel::WORDS)).default("equisolid");
        /// The angle of view across the diagonal of the artwork's box.
        field: f64 = angle("field").default("110").within(0.01, 359.0);
        /// The point the lens looks at.
        center: Point = new("center", Kind::Point).default("50%,50%");
        /// Keep the corners in place (corners), or the scale in the middle (middle).
        keep_middle: bool = either("keep", &["corners", "middle"]);
        let frame: Rect = s.frame().rect;
    }
}

impl Lens {
    /// Creates the change from a rectilinear to an equisolid lens that looks at the middle of the artwork's box and keeps the
    /// corners fixed. (Rectilinear and orthographic lenses see less than 180 degrees.)
    #[must_use]
    pub fn new(frame: Rect) -> Self {
        Self::defaults(frame)
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Usage`] for a field of view that a lens cannot see, or artwork without size.
    pub fn build(&self) -> Result<Built, Error> {
        self.check()?;
        let Self { frame, center, from, to, .. } = *self;
        let half_field = self.field.to_radians() / 2.0;
        let degrees = || format!("{:.6}", 2.0 * half_field.to_degrees());
        for (name, lens) in [("from", from), ("to", to)] {
            if half_field >= lens.max_angle() {
                let limit = 2.0 * lens.max_angle().to_degrees();
                let problem = format!("is more than the lens of `{name}` can see: it must be below {limit} degrees");
                return Err(Error::usage("field", degrees(), problem));
            }
        }
        let corner = 0.5 * frame.width().hypot(frame.height());
        if corner <= 0.0 {
            return Err(Error::usage("field", degrees(), "spans artwork that has no size"));
        }
        let focal = corner / from.radius(half_field);
        let new_focal = if self.keep_middle { focal } else { corner / to.radius(half_field) };
        let mut built = Built::new(Arc::new(LensMap { center, from, to, focal, new_focal }));
        built.note(format!("focal lengths {focal:.6} and {new_focal:.6}"));
        Ok(built)
    }
}

choice! {
    /// The way a lens draws a ray at the angle θ from its axis: at the distance f·ρ(θ) from the middle.
    #[non_exhaustive]
    pub enum LensModel {
        /// ρ = tan θ: a pinhole; straight lines stay straight.
        Rectilinear = "rectilinear",
        /// ρ = 2·tan(θ/2): small shapes are kept.
        Stereographic = "stereographic",
        /// ρ = θ: angles from the axis to scale.
        Equidistant = "equidistant",
        /// ρ = 2·sin(θ/2): areas to scale.
        Equisolid = "equisolid",
        /// ρ = sin θ.
        Orthographic = "orthographic",
    }
}

static INFO: Info = Info::new("lens", "look through a fisheye, or straighten what was seen through one")
    .group("Classics")
    .about("Redraws the artwork as another lens would have taken it. From rectilinear to one of the fisheyes, straight lines bow \
outwards and the middle swells; the other way a fisheye picture is straightened. --field sets the angle of view from corner to \
corner of the artwork's box: the wider, the stronger.")
    .source("J. Kannala and S. Brandt, A generic camera model and calibration method for conventional, wide-angle, and fish-eye \
lenses, IEEE PAMI 28, 2006, equations (1)-(5)")
    .params(Lens::PARAMS)
    .demo(&[])
    .examples(&[
        Example { what: "As it comes: a fisheye", command: "lens samples/grid.svg -o out.svg" },
        Example {
            what: "Straighten a picture taken with a fisheye",
            command: "lens samples/badge.svg --from equidistant --to rectilinear --field 120 -o out.svg",
        },
        Example {
            what: "The middle to scale, the rest shrinking outwards",
            command: "lens samples/logo.svg --keep middle --field 150 -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("from", "equisolid"), ("to", "equisolid")]),
        Law::KeepsLines(&[("from", "orthographic"), ("to", "orthographic")]),
        Law::Undoes(
            &[("from", "rectilinear"), ("to", "stereographic")],
            &[("from", "stereographic"), ("to", "rectilinear")],
        ),
        Law::Undoes(
            &[("from", "orthographic"), ("to", "equidistant"), ("center", "40,45"), ("field", "100")],
            &[("from", "equidistant"), ("to", "orthographic"), ("center", "40,45"), ("field", "100")],
        ),
    ])
    .cases(&[
        Case { args: &[], at: (50.0, 50.0), to: (50.0, 50.0), tolerance: 0.0 },
        Case { args: &[], at: (100.0, 0.0), to: (100.0, 0.0), tolerance: 1e-12 },
        // A right angle of view: tan θ = 1/2 half-way to the corner; to equidistant, θ / 45° of the way.
        Case {
            args: &[("field", "90"), ("to", "equidistant")],
            at: (75.0, 75.0),
            to: (50.0 + 50.0 * 0.590_334_470_601_733, 50.0 + 50.0 * 0.590_334_470_601_733),
            tolerance: 1e-12,
        },
    ]);

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| Lens::read(s)?.build());

impl LensModel {
    /// Returns the largest angle θ that the lens can see.
    fn max_angle(self) -> f64 {
        if matches!(self, Self::Rectilinear | Self::Orthographic) { PI / 2.0 } else { PI }
    }

    /// Returns ρ(θ).
    fn radius<S: Real>(self, angle: S) -> S {
        let half = angle * 0.5;
        match self {
            Self::Rectilinear => angle.sin() / angle.cos(),
            Self::Stereographic => half.sin() / half.cos() * 2.0,
            Self::Equidistant => angle,
            Self::Equisolid => half.sin() * 2.0,
            Self::Orthographic => angle.sin(),
        }
    }

    /// Returns θ = ρ⁻¹(r).
    fn angle<S: Real>(self, r: S) -> S {
        let atan = |v: S| v.atan2(S::from(1.0));
        let asin = |v: S| v.atan2((-(v * v) + 1.0).sqrt());
        match self {
            Self::Rectilinear => atan(r),
            Self::Stereographic => atan(r * 0.5) * 2.0,
            Self::Equidistant => r,
            Self::Equisolid => asin(r * 0.5) * 2.0,
            Self::Orthographic => asin(r),
        }
    }
}

/// The change of lens as a map.
#[derive(Debug, Clone, Copy)]
struct LensMap {
    center: Point,
    from: LensModel,
    to: LensModel,
    /// The focal lengths f and f'.
    focal: f64,
    new_focal: f64,
}

impl LensMap {
    /// Returns the distance from the centre up to which both lenses see; infinite if it has no limit.
    fn max_radius(&self) -> f64 {
        let limit = self.from.max_angle().min(self.to.max_angle());
        let is_infinite = match self.from {
            LensModel::Rectilinear => true,
            LensModel::Stereographic => limit >= PI,
            _ => false,
        };
        if is_infinite { f64::INFINITY } else { self.focal * self.from.radius(limit) }
    }
}

impl Formula for LensMap {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        /// ρ and ρ⁻¹ are r·(1 + O(r²)): below this r the scale is f'/f to the last bit.
        const TINY: f64 = 1e-9;
        let (u, v) = (x - self.center.x, y - self.center.y);
        let r = u.hypot(v) / self.focal;
        let k = if r.value() < TINY {
            S::from(self.new_focal / self.focal)
        } else {
            self.to.radius(self.from.angle(r)) / r * (self.new_focal / self.focal)
        };
        (u * k + self.center.x, v * k + self.center.y)
    }

    fn class(&self) -> Class {
        if self.from != self.to {
            return Class::Smooth;
        }
        let o = self.center.to_vec2();
        Class::Affine(Affine::translate(o) * Affine::scale(self.new_focal / self.focal) * Affine::translate(-o))
    }

    fn creases(&self, out: &mut Creases) {
        let (max_radius, center) = (self.max_radius(), self.center);
        if max_radius.is_finite() && self.from != self.to {
            // The negative radius puts the domain inside the circle.
            out.push(Crease::edge(Level::Circle { center, radius: -max_radius }));
        }
    }

    /// A quarter of the radius within which θ is an analytic function of r: the focal length, or the distance to the rim if that is less.
    fn detail(&self, area: Rect) -> Option<f64> {
        let farthest = Frame::new(area).corners().map(|p| self.center.distance(p)).into_iter().fold(0.0, f64::max);
        Some(0.25 * self.focal.min(self.max_radius() - farthest).max(0.0))
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(Self { from: self.to, to: self.from, focal: self.new_focal, new_focal: self.focal, ..*self }))
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

    fn build(pairs: &[(&str, &str)]) -> Result<Built, Error> {
        ENTRY.build_from(&Args::from_pairs(pairs), &check::frame())
    }

    #[test]
    fn every_pair_of_lenses_returns_and_is_smooth_in_the_middle() {
        for from in LensModel::WORDS {
            for to in LensModel::WORDS {
                let m = build(&[("from", from), ("to", to)]).unwrap().map;
                let back = m.inverse().unwrap();
                for p in [(50.0, 50.0), (50.0, 50.0 + 1e-8), (52.0, 49.0), (3.0, 4.0)] {
                    assert!(back.point(m.point(p.into())).distance(p.into()) < 1e-10, "{from} {to}");
                }
                let (a, b) = (m.jet(Point::new(50.0, 50.0)), m.jet(Point::new(50.0, 50.0 + 1e-6)));
                assert!((a.dx - b.dx).hypot() + (a.dy - b.dy).hypot() < 1e-7, "{from} {to}: {a:?} {b:?}");
            }
        }
    }

    #[test]
    fn stereographic_from_equisolid_and_the_rest_agree_with_the_definitions() {
        // 100 degrees off the axis, by hand.
        let theta = 100f64.to_radians();
        let m =
            build(&[("from", "equisolid"), ("to", "stereographic"), ("field", "240"), ("keep", "middle")]).unwrap().map;
        let f = 50.0 * 2f64.sqrt() / (2.0 * 60f64.to_radians().sin());
        let p = m.point(Point::new(50.0 + f * 2.0 * (theta / 2.0).sin(), 50.0));
        assert!((p.x - 50.0 - f * 2.0 * (theta / 2.0).tan()).abs() < 1e-10);
    }

    #[test]
    fn too_wide_a_field_is_refused_and_the_edge_of_a_lens_is_an_edge() {
        let e = build(&[("field", "180")]).err().unwrap().to_string();
        assert!(e.contains("`from`") && e.contains("180 degrees"), "{e}");
        let m = build(&[("from", "equidistant"), ("to", "rectilinear"), ("field", "160")]).unwrap().map;
        let art = crate::Outline::from_svg("M50,50 H200").unwrap();
        assert!(crate::refit::warp_path(&art, &*m, &crate::refit::Options::new(0.1)).is_err());
    }
}
