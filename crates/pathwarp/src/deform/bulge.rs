//! A bulge: artwork within a disc is pushed away from the centre, or towards it by a negative amount (a pinch).
//!
//! With q = (r/R)² every point stays on its ray and r' = r·k(q), m = 2^amount being the scale at the centre:
//!
//! - sharp: q' = m²q / (1 + (m² − 1)·q), so k = m/√(1 + (m² − 1)·q). In q this is a projective map of the line that keeps 0
//!   and 1: the inverse is the same with 1/m. At the rim the radial scale jumps from 1/m² to 1,
//! - soft: k = exp(ln m·(1 − q)²). At the rim value and slope vanish. d ln r'/d ln r = 1 − 4·ln m·q(1 − q) > 0 as long as
//!   |ln m| < 1, which holds for amounts up to 1; the inverse is one equation in one unknown, solved by bracketed Newton.
//!
//! Both are smooth at the centre, being smooth in r². Elementary.

use super::entry::{Built, Case, Entry, Example, Info, Law};
use crate::error::Error;
use crate::map::{
    AffineMap, Class, Cost, Crease, Creases, Formula, INVERSE_WORK, Jet, Level, Map, Real, increasing_root,
};
use crate::param::{Axis, Kind, parameters};
use kurbo::{Affine, Point, Rect, Vec2};
use std::f64::consts::LN_2;
use std::sync::Arc;

parameters! {
    /// A bulge, or a pinch: artwork pushed out from a centre, or drawn in, within a disc.
    ///
    /// Every point stays on its ray; with q = (r/R)² and m = 2^amount it moves by the factor exp(ln m·(1 − q)²), or with a sharp
    /// edge m/√(1 + (m² − 1)·q). A sharp pinch is the exact inverse of the sharp bulge.
    ///
    /// ```
    /// use pathwarp::{deform::Bulge, kurbo::Point, map::Map};
    ///
    /// let bulge = Bulge::new((50.0, 50.0), 40.0).amount(1.0).build()?;
    /// let jet = bulge.map.jet(Point::new(50.0, 50.0));
    /// assert!((jet.dx.x - 2.0).abs() < 1e-12); // The centre is twice as large.
    /// # Ok::<(), pathwarp::Error>(())
    /// ```
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Bulge(s) {
        /// At 1 the middle is twice as large, at -1 half as large (pinch).
        amount: f64 = number("amount").default("0.7").within(-1.0, 1.0);
        /// Centre of the bulge.
        center: Point = new("center", Kind::Point).default("50%,50%");
        /// Radius at which the bulge ends; 50% reaches the artwork's corners.
        radius: f64 = length("radius", Axis::Diagonal).default("50%").within(1e-6, 1e9).slider(1.0, 1000.0);
        /// Edge at the rim: without a kink, or with one.
        sharp: bool = either("edge", &["soft", "sharp"]);
    }
}

impl Bulge {
    /// Creates a bulge that ends at `radius`, 1e-6 to 1e9 user units from `center`.
    pub fn new(center: impl Into<Point>, radius: f64) -> Self {
        Self { center: center.into(), radius, ..Self::defaults(Rect::ZERO) }
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Usage`] for an amount or a radius out of range.
    pub fn build(&self) -> Result<Built, Error> {
        self.check()?;
        let Self { center, radius, amount, sharp } = *self;
        Ok(Built::new(Arc::new(BulgeMap(Inner { center, radius, ln_m: amount * LN_2, sharp }))))
    }
}

static INFO: Info = Info::new("bulge", "blow up the middle, or pinch it")
    .group("Classics")
    .about("Pushes artwork away from a centre, most in the middle and not at all at the radius; with a negative amount draws it in \
(pinch). Outside the radius nothing moves. --edge soft ends without a kink at the rim; --edge sharp is rounder, and its pinch \
undoes its bulge exactly.")
    .source("elementary; see the formulas at the top of deform/bulge.rs")
    .params(Bulge::PARAMS)
    .demo(&[("amount", "1"), ("radius", "40")])
    .examples(&[
        Example { what: "As it comes", command: "bulge samples/logo.svg -o out.svg" },
        Example { what: "Pinch a word", command: "bulge samples/lettering.svg --amount -0.6 -o out.svg" },
        Example {
            what: "A bubble over a grid",
            command: "bulge samples/grid.svg --amount 1 --radius 25% --edge sharp -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("amount", "0")]),
        Law::Identity(&[("amount", "0"), ("edge", "sharp")]),
        Law::Undoes(&[("amount", "0.8"), ("edge", "sharp")], &[("amount", "-0.8"), ("edge", "sharp")]),
    ])
    .cases(&[
        Case { args: &[("radius", "40")], at: (50.0, 50.0), to: (50.0, 50.0), tolerance: 0.0 },
        Case { args: &[("radius", "40")], at: (90.0, 50.0), to: (90.0, 50.0), tolerance: 0.0 },
        // Half-way out, q = 1/4: sharp k = 2/√(7/4), soft k = 2^(9/16).
        Case {
            args: &[("radius", "40"), ("amount", "1"), ("edge", "sharp")],
            at: (70.0, 50.0),
            to: (50.0 + 40.0 / 1.322_875_655_532_295_3, 50.0),
            tolerance: 1e-12,
        },
        Case {
            args: &[("radius", "40"), ("amount", "1")],
            at: (50.0, 30.0),
            to: (50.0, 50.0 - 20.0 * 1.476_826_145_939_499_3),
            tolerance: 1e-12,
        },
    ]);

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| Bulge::read(s)?.build());

/// The formula inside the disc, continued outside.
#[derive(Debug, Clone, Copy)]
struct Inner {
    center: Point,
    radius: f64,
    /// ln m, the logarithm of the scale at the centre.
    ln_m: f64,
    sharp: bool,
}

impl Inner {
    /// Returns `true` inside the disc.
    fn contains(&self, p: Point) -> bool {
        (p - self.center).hypot() < self.radius
    }

    /// Adds the rim.
    fn crease(&self, out: &mut Creases) {
        let Self { center, radius, .. } = *self;
        out.push(Crease::kink(Level::Circle { center, radius }));
    }

    fn class(&self) -> Class {
        if self.ln_m == 0.0 { Class::Affine(Affine::IDENTITY) } else { Class::Smooth }
    }
}

impl Formula for Inner {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let (u, v) = (x - self.center.x, y - self.center.y);
        let q = (u * u + v * v) / (self.radius * self.radius);
        let k = if self.sharp {
            let m = self.ln_m.exp();
            S::from(m) / (q * (m * m - 1.0) + 1.0).sqrt()
        } else {
            ((-q + 1.0).powi(2) * self.ln_m).exp()
        };
        (u * k + self.center.x, v * k + self.center.y)
    }
}

/// The bulge inside the disc, and the identity outside.
#[derive(Debug, Clone, Copy)]
struct BulgeMap(Inner);

impl Formula for BulgeMap {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        if self.0.contains(Point::new(x.value(), y.value())) { self.0.f(x, y) } else { (x, y) }
    }

    fn class(&self) -> Class {
        self.0.class()
    }

    fn creases(&self, out: &mut Creases) {
        self.0.crease(out);
    }

    fn branch(&self, inside: Point) -> Option<Arc<dyn Map>> {
        Some(if self.0.contains(inside) { Arc::new(self.0) } else { Arc::new(AffineMap::IDENTITY) })
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        if self.0.sharp {
            return Some(Arc::new(Self(Inner { ln_m: -self.0.ln_m, ..self.0 })));
        }
        Some(Arc::new(SoftInverse(self.0)))
    }
}

/// The inverse of the soft bulge.
#[derive(Debug, Clone, Copy)]
struct SoftInverse(Inner);

impl SoftInverse {
    /// Returns the point of the disc that goes to `p`.
    fn source(&self, p: Point) -> Point {
        let Inner { center, radius, ln_m, .. } = self.0;
        let d = p - center;
        let target = d.hypot2() / (radius * radius);
        if target == 0.0 || target >= 1.0 {
            return p;
        }
        // g(q) = ln q + 2·ln m·(1 − q)² − ln q' grows from −∞ to above 0 over (0, 1]. Its root is q, and `target` is q'.
        let g = |q: f64| ((q / target).ln() + 2.0 * ln_m * (1.0 - q).powi(2), 1.0 / q - 4.0 * ln_m * (1.0 - q));
        let start = (target * (-2.0 * ln_m * (1.0 - target).powi(2)).exp()).clamp(f64::MIN_POSITIVE, 1.0);
        let q = increasing_root((0.0, 1.0), start, g, |q, _, step: f64| step.abs() <= 2.0 * f64::EPSILON * q);
        center + d * (q / target).sqrt()
    }
}

impl Map for SoftInverse {
    fn jet(&self, p: Point) -> Jet {
        if !self.0.contains(p) {
            return Jet { p, dx: Vec2::new(1.0, 0.0), dy: Vec2::new(0.0, 1.0) };
        }
        let at = self.source(p);
        self.0.jet(at).inverted(at)
    }

    fn point(&self, p: Point) -> Point {
        self.source(p)
    }

    /// A quarter of the radius, times the scale at the centre if that is below 1.
    fn detail(&self, _: Rect) -> Option<f64> {
        Some(0.25 * self.0.radius * self.0.ln_m.exp().min(1.0))
    }

    /// A point takes a few Newton steps with a logarithm each.
    fn cost(&self) -> Cost<'_> {
        Cost::new(INVERSE_WORK)
    }

    fn class(&self) -> Class {
        self.0.class()
    }

    fn creases(&self, out: &mut Creases) {
        self.0.crease(out);
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(BulgeMap(self.0)))
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

    fn build(pairs: &[(&str, &str)]) -> Arc<dyn Map> {
        ENTRY.build_from(&Args::from_pairs(pairs), &check::frame()).unwrap().map
    }

    #[test]
    fn the_centre_is_scaled_as_promised_and_nothing_folds() {
        for edge in ["soft", "sharp"] {
            for (amount, m) in [("1", 2.0), ("-1", 0.5), ("0.5", 2.0f64.sqrt())] {
                let map = build(&[("edge", edge), ("amount", amount)]);
                assert!((map.jet(Point::new(50.0, 50.0)).det() - m * m).abs() < 1e-12);
                for i in 0..100 {
                    assert!(map.jet(Point::new(50.0 + 0.7 * f64::from(i), 50.0)).det() > 0.0, "{edge} {amount} {i}");
                }
            }
        }
    }

    /// A pinch to half the size at the centre is undone by doubling, however near the centre.
    #[test]
    fn the_soft_inverse_is_right_beside_the_centre() {
        let back = build(&[("amount", "-1"), ("center", "0,0"), ("radius", "40")]).inverse().unwrap();
        for x in [1e-8, 3e-8, 1e-5] {
            let scale = back.point(Point::new(x, 0.0)).x / x;
            assert!((scale - 2.0).abs() < 1e-9, "{x}: {scale}");
        }
    }

    #[test]
    fn the_soft_inverse_has_the_right_derivatives() {
        let back = build(&[("amount", "-1")]).inverse().unwrap();
        for (x, y) in [(50.0, 50.0), (50.0 + 1e-9, 50.0), (60.0, 41.0), (20.0, 70.0), (119.0, 50.0)] {
            let (p, h) = (Point::new(x, y), 1e-5);
            let j = back.jet(p);
            let dx = (back.point(p + Vec2::new(h, 0.0)) - back.point(p - Vec2::new(h, 0.0))) / (2.0 * h);
            let dy = (back.point(p + Vec2::new(0.0, h)) - back.point(p - Vec2::new(0.0, h))) / (2.0 * h);
            assert!((dx - j.dx).hypot() + (dy - j.dy).hypot() < 1e-6, "{p:?}: {j:?} {dx:?} {dy:?}");
        }
    }
}
