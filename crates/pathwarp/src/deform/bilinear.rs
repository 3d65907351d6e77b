//! The bilinear map of a rectangle onto four corners, which divides all four sides evenly.
//!
//! F(u, v) = P + u·a + v·b + uv·c with a = Q−P, b = S−P, c = P−Q+R−S. Lines along the rectangle's sides stay straight and are divided
//! evenly; other lines become parabolas. The image of a curve of degree n is exactly a curve of degree 2n.
//!
//! For the inverse, let q = F − P. Eliminating v from q − u·a = v·(b + u·c) leaves k₂u² + k₁u + k₀ = 0 with k₂ = −a×c, k₁ = q×c − a×b and
//! k₀ = q×b. At a root 2k₂u + k₁ = −det F', so the root is chosen by the side of the fold on which the corners lie. See G. Wolberg,
//! *Digital Image Warping* (1990), §3.6.

use super::entry::{Built, ByHand, Case, Entry, Example, Info, Law, Pairs};
use crate::anchors::{self, Anchors, FourToFour};
use crate::error::Error;
use crate::map::rational_bezier::Scaled;
use crate::map::{AffineMap, Chain, Crease, Creases, Formula, Level, Map, RationalBezier, Real};
use crate::param::Param;
use kurbo::{Affine, Point, Vec2};
use std::sync::Arc;

/// The bilinear map of a quadrilateral, usually a box, onto four corners, its sides divided evenly.
///
/// F(u, v) = (1−u)(1−v)·P + u(1−v)·Q + uv·R + (1−u)v·S, where a projective map takes the base's corners to the unit square of (u, v).
///
/// ```
/// use pathwarp::{deform::Bilinear, kurbo::Point, map::Map};
///
/// let base = [(0.0, 100.0), (100.0, 100.0), (100.0, 0.0), (0.0, 0.0)];
/// let skewed = Bilinear::new(base, [(0.0, 100.0), (95.0, 90.0), (75.0, 20.0), (15.0, 5.0)]).build()?;
/// assert!(skewed.map.point(Point::new(50.0, 50.0)).distance(Point::new(46.25, 53.75)) < 1e-12);
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Bilinear {
    corners: FourToFour,
}

impl Bilinear {
    /// Creates the map that takes the points `from` to the points `to`, in the order given.
    pub fn new(from: [impl Into<Point>; 4], to: [impl Into<Point>; 4]) -> Self {
        Self { corners: FourToFour::new(from.map(Into::into), to.map(Into::into)) }
    }

    /// Builds the map. A target that is not convex gives a warning, because the artwork folds over itself there.
    ///
    /// # Errors
    /// [`Error::Geometry`] when points coincide or three lie on a line, or when the base is not convex.
    pub fn build(&self) -> Result<Built, Error> {
        let FourToFour { from, to, .. } = self.corners;
        self.corners.check()?;
        let to_unit = anchors::to_standard("base", &Anchors::Four(from))?;
        let map = BilinearMap::new(to);
        // The determinant is bilinear, too, so its signs at the corners tell.
        let dets = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(u, v)| map.det(u, v));
        let mut built = self.corners.shown_on(Built::new(Arc::new(Chain::new([to_unit, map.or_affine()]))));
        if dets.iter().any(|d| *d > 0.0) && dets.iter().any(|d| *d < 0.0) {
            built.warn("bilinear: the target is not convex: the artwork folds over itself");
        }
        Ok(built)
    }
}

static INFO: Info = Info::new("bilinear", "stretch artwork to four corners, its sides divided evenly")
    .group("Envelopes")
    .by_hand(ByHand {
        label: Some("Four corners"),
        fixed: &["target"],
        neutral: &[("target", "0%,100% 100%,100% 100%,0% 0%,0%")],
        ..ByHand::NONE
    })
    .guides(&["target", "base"], 1)
    .about("Takes the corners of the artwork's box (or the Base) to the four anchors of the Target. Verticals and horizontals stay straight \
and keep their even spacing, where projective would crowd them towards the far side; slanting lines become parabolas.\n\nBoth start \
with the side that lies lowest on the screen, left to right, unless --base-as-drawn or --target-as-drawn say otherwise.")
    .source("G. Wolberg, Digital Image Warping, 1990, section 3.6")
    .params(&[
        Param::path("base", "Four anchors in the source. Default: the corners of the artwork's box."),
        Param::path("target", "Where the four anchors go: for those of the box from its bottom left over the right, such as 0%,100% 100%,85% 100%,15% 0%,0%.").default("0%,100% 100%,80% 100%,20% 0%,0%"),
        Param::flag("base-as-drawn", "Take the Base's anchors in the order they were drawn."),
        Param::flag("target-as-drawn", "Take the Target's anchors in the order they were drawn."),
    ])
    .demo(&[("target", "0,100 95,90 75,20 15,5")])
    .examples(&[
        Example {
            what: "As it comes: a word that tapers, all letters equally wide",
            command: "bilinear samples/lettering.svg -o out.svg",
        },
        Example {
            what: "Four corners",
            command: "bilinear samples/logo.svg --target '0%,100% 90%,110% 100%,0% 15%,-10%' -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("target", "0,0 100,0 100,100 0,100")]),
        Law::KeepsLines(&[("target", "0,100 100,120 130,20 30,0")]),
        Law::Area(&[("target", "0,100 200,100 200,0 0,0")], 2.0),
    ])
    .cases(&[
        Case { args: FOUR, at: (0.0, 100.0), to: (0.0, 100.0), tolerance: 1e-12 },
        Case { args: FOUR, at: (100.0, 100.0), to: (95.0, 90.0), tolerance: 1e-12 },
        Case { args: FOUR, at: (100.0, 0.0), to: (75.0, 20.0), tolerance: 1e-12 },
        Case { args: FOUR, at: (0.0, 0.0), to: (15.0, 5.0), tolerance: 1e-12 },
        // The middle goes to the corners' mean, a side's quarter to its quarter.
        Case { args: FOUR, at: (50.0, 50.0), to: (46.25, 53.75), tolerance: 1e-12 },
        Case { args: FOUR, at: (25.0, 100.0), to: (23.75, 97.5), tolerance: 1e-12 },
    ]);

const FOUR: Pairs = &[("target", "0,100 95,90 75,20 15,5")];

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| Bilinear { corners: anchors::four_to_four(s)? }.build());

/// P + u·a + v·b + uv·c over the unit square.
#[derive(Debug, Clone, Copy)]
struct BilinearMap {
    p: Vec2,
    a: Vec2,
    b: Vec2,
    c: Vec2,
}

impl BilinearMap {
    /// Creates the map that takes (0,0), (1,0), (1,1), (0,1) to these points.
    fn new(q: [Point; 4]) -> Self {
        Self { p: q[0].to_vec2(), a: q[1] - q[0], b: q[3] - q[0], c: (q[0] - q[1]) + (q[2] - q[3]) }
    }

    fn det(&self, u: f64, v: f64) -> f64 {
        (self.a + self.c * v).cross(self.b + self.c * u)
    }

    /// Returns an affine map if the corners form a parallelogram, or else this map.
    fn or_affine(self) -> Arc<dyn Map> {
        if self.c.hypot() > 1e-14 * (self.p.hypot() + self.a.hypot() + self.b.hypot()) {
            return Arc::new(self);
        }
        let Self { p, a, b, .. } = self;
        Arc::new(AffineMap(Affine::new([a.x, a.y, b.x, b.y, p.x, p.y])))
    }
}

impl Formula for BilinearMap {
    fn f<S: Real>(&self, u: S, v: S) -> (S, S) {
        let Self { p, a, b, c } = *self;
        let uv = u * v;
        (u * a.x + v * b.x + uv * c.x + p.x, u * a.y + v * b.y + uv * c.y + p.y)
    }

    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        let [u, v, w] = [0, 1, 2].map(|k| curve.coordinate(k));
        let (uv, uw, vw, ww) = (u.times(&v), u.times(&w), v.times(&w), w.times(&w));
        let sum = |p: f64, a: f64, b: f64, c: f64| {
            let mut out = Scaled::zero(2 * curve.degree());
            for (k, term) in [(p, &ww), (a, &uw), (b, &vw), (c, &uv)] {
                out.add_scaled(k, term);
            }
            out
        };
        let Self { p, a, b, c } = *self;
        let (x, y) = (sum(p.x, a.x, b.x, c.x), sum(p.y, a.y, b.y, c.y));
        Some(RationalBezier::from_coordinates([&x, &y, &ww], curve.is_polynomial()))
    }

    /// Returns up to two preimages, one on each side of the fold.
    fn preimages(&self, q: Point) -> Option<Vec<Point>> {
        let on_side = |side: f64| Map::point(&BilinearInverse { map: *self, side }, q);
        Some([1.0, -1.0].map(on_side).into_iter().filter(|p| p.is_finite()).collect())
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        let det = self.det(0.5, 0.5);
        let side = det.signum();
        (det != 0.0 && det.is_finite()).then(|| Arc::new(BilinearInverse { map: *self, side }) as Arc<dyn Map>)
    }
}

/// The inverse on the side of the fold where the determinant has the sign `side`.
#[derive(Debug, Clone, Copy)]
struct BilinearInverse {
    map: BilinearMap,
    side: f64,
}

impl BilinearInverse {
    /// Returns the coefficients k₂, k₁, k₀.
    fn quadratic<S: Real>(&self, qx: S, qy: S) -> [S; 3] {
        let BilinearMap { a, b, c, .. } = self.map;
        let cross = |v: Vec2| qx * v.y - qy * v.x;
        [S::from(-a.cross(c)), cross(c) - a.cross(b), cross(b)]
    }
}

impl Formula for BilinearInverse {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let BilinearMap { p, a, b, c } = self.map;
        let (qx, qy) = (x - p.x, y - p.y);
        let [k2, k1, k0] = self.quadratic(qx, qy);
        // det F' at the solution.
        let det = (k1 * k1 - k2 * k0 * 4.0).sqrt() * self.side;
        // −k₁ and det have the same sign near the unit square unless it is bent far; then the other form of the root cancels less.
        let u = if (det - k1).value().abs() >= (det + k1).value().abs() {
            k0 * 2.0 / (det - k1)
        } else {
            -(k1 + det) / (k2 * 2.0)
        };
        // q − u·a = v·e with e = b + u·c.
        let (ex, ey) = (u * c.x + b.x, u * c.y + b.y);
        let v = ((qx - u * a.x) * ex + (qy - u * a.y) * ey) / (ex * ex + ey * ey);
        (u, v)
    }

    /// Points beyond the image of the fold have no preimage.
    fn creases(&self, out: &mut Creases) {
        let inverse = *self;
        out.push(Crease::edge(Level::Field(Arc::new(move |p: Point| {
            let q = p - inverse.map.p;
            let [k2, k1, k0] = inverse.quadratic(q.x, q.y);
            k1 * k1 - 4.0 * k2 * k0
        }))));
    }

    fn inverse(&self) -> Option<Arc<dyn Map>> {
        Some(Arc::new(self.map))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check;
    use crate::deform::Deformation as _;
    use crate::outline::Seg;
    use crate::param::Args;

    #[test]
    fn is_sound() {
        let faults = check::entry(&ENTRY);
        assert!(faults.is_empty(), "{faults:#?}");
    }

    fn build(pairs: &[(&str, &str)]) -> Built {
        ENTRY.build_from(&Args::from_pairs(pairs), &check::frame()).unwrap()
    }

    #[test]
    fn uprights_and_levels_stay_straight_and_even_and_images_are_of_twice_the_degree() {
        let m = build(FOUR).map;
        for (p, q) in [((30.0, 0.0), (30.0, 100.0)), ((0.0, 77.0), (100.0, 77.0))] {
            let (p, q) = (Point::from(p), Point::from(q));
            let (a, b) = (m.point(p), m.point(q));
            for i in 0..=10 {
                let t = f64::from(i) / 10.0;
                assert!(m.point(p.lerp(q, t)).distance(a.lerp(b, t)) < 1e-12);
            }
        }
        let cubic = Seg::Cubic(kurbo::CubicBez::new((5.0, 5.0), (90.0, 5.0), (20.0, 80.0), (60.0, 60.0)));
        assert_eq!(m.image(&RationalBezier::from_seg(&cubic).unwrap()).unwrap().degree(), 6);
    }

    #[test]
    fn the_inverse_returns_for_every_shape_of_target() {
        for target in [
            "0,100 95,90 75,20 15,5",   // as in the cases
            "0,100 100,100 75,0 25,0",  // a trapezium: two sides parallel
            "0,100 100,100 100,0 20,0", // one corner moved
            "100,100 0,90 10,10 95,0",  // mirrored
        ] {
            let m = build(&[("target", target), ("target-as-drawn", "true")]).map;
            let back = m.inverse().unwrap();
            for p in [(0.0, 0.0), (100.0, 100.0), (50.0, 50.0), (99.0, 1.0), (20.0, 70.0)] {
                assert!(back.point(m.point(p.into())).distance(p.into()) < 1e-9, "{target} {p:?}");
            }
        }
    }

    #[test]
    fn folds_are_reported() {
        assert!(build(FOUR).explanation.warnings.is_empty());
        let dented = build(&[("target", "0,100 100,100 20,80 0,0"), ("target-as-drawn", "true")]);
        assert!(dented.explanation.warnings[0].contains("folds"));
    }
}
