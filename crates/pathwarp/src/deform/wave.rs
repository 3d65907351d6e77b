//! A sine wave: artwork is pushed to and fro across the direction in which the wave runs, or along it.
//!
//! In the formula of [`Wave`], s = (p − o)·d with the unit vector d along the wave, and n is a quarter turn to its left on the screen for a
//! shear, or d for a push. With g = 1 the wave grows from nothing, like a flag at its pole. The shear keeps s: its determinant is 1, and
//! its inverse is the wave with −h. A. Barr, *Global and local deformations of solid primitives*, SIGGRAPH 1984, offsets points by a
//! function of their position along an axis; the wave is one.

use super::entry::{Built, Case, Entry, Example, Info, Law};
use crate::error::Error;
use crate::map::{Class, Formula, Map, Real};
use crate::param::{Axis, Frame, parameters};
use kurbo::{Affine, Rect, Vec2};
use std::f64::consts::TAU;
use std::sync::Arc;

parameters! {
    /// A sine wave: artwork pushed to and fro across the direction of the wave, or along it.
    ///
    /// F(p) = p + a(s)·sin(2π·s/λ + φ)·n with s counted along the wave from where the artwork begins, n the unit vector across
    /// (or along) it, λ its length, φ its phase, and a(s) = h·(1 − g + g·s/S), with its height h, its growth g and the artwork's extent S.
    ///
    /// ```
    /// use pathwarp::{deform::Wave, kurbo::{Point, Rect}, map::Map};
    ///
    /// let wave = Wave::new(Rect::new(0.0, 0.0, 100.0, 100.0)).length(40.0).height(3.0).build()?;
    /// assert!(wave.map.point(Point::new(10.0, 5.0)).distance(Point::new(10.0, 2.0)) < 1e-12);
    /// # Ok::<(), pathwarp::Error>(())
    /// ```
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Wave(s) {
        /// Distance of a crest from the middle.
        height: f64 = length("height", Axis::Y).default("10%").slider(0.0, 100.0);
        /// Distance from crest to crest.
        length: f64 = length("length", Axis::X).default("60%").within(1e-3, 1e9).slider(1.0, 1000.0);
        /// Direction of the wave: 0 to the right, 90 downwards.
        angle: f64 = angle("angle").default("0");
        /// Phase at which the artwork begins: 0 in the middle, 90 on a crest.
        phase: f64 = angle("phase").default("0");
        /// Share of the height that is missing at the start: 0 none of it, 1 all.
        grow: f64 = number("grow").default("0").within(0.0, 1.0);
        /// Move points across the wave (shear) or along it (push).
        push: bool = either("kind", &["shear", "push"]);
        let frame: Rect = s.frame().rect;
    }
}

impl Wave {
    /// Creates a wave over the artwork's box.
    #[must_use]
    pub fn new(frame: Rect) -> Self {
        Self::defaults(frame)
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Usage`] for a length or growth out of range.
    pub fn build(&self) -> Result<Built, Error> {
        self.check()?;
        let Self { height, length, grow, push, .. } = *self;
        let d = Vec2::from_angle(self.angle.to_radians());
        let along = Frame::new(self.frame).corners().map(|c| c.to_vec2().dot(d));
        let start = along.into_iter().fold(f64::INFINITY, f64::min);
        let extent = along.into_iter().fold(f64::NEG_INFINITY, f64::max) - start;
        let map = WaveMap {
            d,
            towards: if push { d } else { Vec2::new(d.y, -d.x) },
            origin: start,
            wave: TAU / length,
            phase: self.phase.to_radians(),
            height,
            // Artwork without extent leaves no room for the wave to grow.
            grow: if extent > 0.0 { grow / extent } else { 0.0 },
            initial: 1.0 - grow,
        };
        let mut built = Built::new(Arc::new(map));
        if push && (height / length).abs() * TAU > 1.0 {
            built.warn(format!(
                "wave: with `kind push` the artwork folds over itself where `height` exceeds `length`/2π = {:.6}",
                length / TAU
            ));
        }
        Ok(built)
    }
}

static INFO: Info = Info::new("wave", "wave artwork like water, or like a flag in the wind")
    .group("Classics")
    .about("Pushes the artwork up and down in a sine wave that runs from left to right, or in any direction. Lines across the wave \
stay straight, and no area changes. With --grow the wave starts flat and reaches its full height at the end: a flag at its pole. \
--kind push moves points along the wave instead of across it: the artwork is squeezed and stretched in turn.")
    .source("elementary; offsets along an axis as in A. Barr, Global and local deformations of solid primitives, SIGGRAPH 1984")
    .params(Wave::PARAMS)
    .demo(&[("angle", "20"), ("phase", "30"), ("grow", "0.5")])
    .examples(&[
        Example { what: "As it comes", command: "wave samples/logo.svg -o out.svg" },
        Example {
            what: "A flag at its pole",
            command: "wave samples/badge.svg --grow 1 --height 12% --length 70% -o out.svg",
        },
        Example { what: "From side to side", command: "wave samples/grid.svg --angle 90 --length 100% -o out.svg" },
    ])
    .laws(&[
        Law::Identity(&[("height", "0")]),
        Law::Area(&[("angle", "33"), ("phase", "50")], 1.0),
        Law::Area(&[("grow", "1"), ("angle", "-70")], 1.0),
        Law::Undoes(&[("height", "13"), ("angle", "20")], &[("height", "-13"), ("angle", "20")]),
        Law::Same(&[("height", "7"), ("phase", "180")], &[("height", "-7")]),
    ])
    .cases(&[
        // A quarter of the wave on, the crest; half of it, the middle; with grow, half the height half-way.
        Case { args: &[("length", "40"), ("height", "3")], at: (10.0, 5.0), to: (10.0, 2.0), tolerance: 1e-12 },
        Case { args: &[("length", "40"), ("height", "3")], at: (20.0, 5.0), to: (20.0, 5.0), tolerance: 1e-12 },
        Case {
            args: &[("length", "200"), ("height", "6"), ("grow", "1")],
            at: (50.0, 5.0),
            to: (50.0, 2.0),
            tolerance: 1e-12,
        },
        Case {
            args: &[("length", "40"), ("height", "3"), ("kind", "push"), ("angle", "90")],
            at: (7.0, 10.0),
            to: (7.0, 13.0),
            tolerance: 1e-12,
        },
    ]);

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| Wave::read(s)?.build());

/// The wave as a map.
#[derive(Clone)]
struct WaveMap {
    /// The unit vector d along the wave.
    d: Vec2,
    /// The unit vector along which points move: n or d.
    towards: Vec2,
    /// o·d, the position of the artwork's start along the wave.
    origin: f64,
    /// 2π/λ.
    wave: f64,
    /// φ, in radians.
    phase: f64,
    /// h, the full height.
    height: f64,
    /// The height at the start, and its growth per unit of s, as fractions of `height`.
    initial: f64,
    grow: f64,
}

impl Formula for WaveMap {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let s = x * self.d.x + y * self.d.y - self.origin;
        let a = (s * self.grow + self.initial) * self.height;
        let distance = a * (s * self.wave + self.phase).sin();
        (x + distance * self.towards.x, y + distance * self.towards.y)
    }

    fn class(&self) -> Class {
        if self.height == 0.0 { Class::Affine(Affine::IDENTITY) } else { Class::Smooth }
    }

    /// A shear keeps s, so its offset can be subtracted again.
    fn inverse(&self) -> Option<Arc<dyn Map>> {
        let is_shear = self.d.dot(self.towards) == 0.0;
        is_shear.then(|| Arc::new(Self { height: -self.height, ..self.clone() }) as Arc<dyn Map>)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check;
    use crate::deform::Deformation as _;
    use crate::param::Args;
    use kurbo::Point;

    #[test]
    fn is_sound() {
        let faults = check::entry(&ENTRY);
        assert!(faults.is_empty(), "{faults:#?}");
    }

    #[test]
    fn a_push_that_folds_warns_and_has_no_closed_inverse() {
        let build = |h: &str| {
            ENTRY.build_from(&Args::from_pairs(&[("kind", "push"), ("length", "40"), ("height", h)]), &check::frame())
        };
        let (gentle, steep) = (build("6").unwrap(), build("7").unwrap());
        assert!(
            gentle.explanation.warnings.is_empty() && steep.explanation.warnings[0].contains("folds"),
            "{:?}",
            steep.explanation.warnings
        );
        assert!(gentle.map.inverse().is_none());
        // The determinant changes sign just where the warning says: 1 + h·2π/λ·cos is negative half a wave on.
        let det = |b: &Built| b.map.jet(Point::new(20.0, 0.0)).det();
        assert!(det(&gentle) > 0.0 && det(&steep) < 0.0);
    }
}
