//! Möbius maps: w = (a·z + b)/(c·z + d) in complex numbers, ad ≠ bc.
//!
//! Circles and lines become circles and lines, and angles are kept. The map is given by its pole, by three points and their
//! images, or by its coefficients.
//!
//! - By the pole P: w = z₀ + (z − z₀)/(1 − (z − z₀)/(P − z₀)) keeps the middle z₀ of the box, and has the derivative 1 there.
//! - By three points: H(z) = (z − p₁)(p₂ − p₃)/((z − p₃)(p₂ − p₁)) takes p₁, p₂, p₃ to 0, 1, ∞. With K the corresponding map for their
//!   images, the map is K⁻¹ ∘ H, which keeps the cross-ratio.
//!
//! For a rational Bézier curve z = Z/W of degree n, w = (aZ + bW)·conj(cZ + dW) / |cZ + dW|² is exactly a rational curve of degree 2n.
//! The inverse is (d·w − b)/(a − c·w). See Ahlfors, *Complex Analysis* (3rd ed. 1979), §3.3, and Needham, *Visual Complex Analysis*
//! (1997), chapter 3.

use super::entry::{Built, ByHand, Case, Entry, Example, Explanation, Info, Law, Overlay, Role};
use crate::anchors;
use crate::error::{Error, GeometryError, show};
use crate::map::rational_bezier::Scaled;
use crate::map::{AffineMap, Crease, Creases, Formula, Level, Map, RationalBezier, Real};
use crate::outline::Outline;
use crate::param::{Kind, NamedPath, Param};
use kurbo::{Affine, Point, Rect, Vec2};
use std::sync::Arc;

/// A Möbius map w = (a·z + b)/(c·z + d) of complex numbers z = x + iy. Circles become circles, angles are kept.
///
/// ```
/// use pathwarp::{deform::Mobius, kurbo::{Point, Rect}, map::Map};
///
/// let map = Mobius::by_pole(Rect::new(0.0, 0.0, 100.0, 100.0), (50.0, 250.0)).build()?.map;
/// assert!(map.point(Point::new(50.0, 150.0)).distance(Point::new(50.0, 250.0)) < 1e-11);
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Mobius {
    frame: Rect,
    /// a, b, c, d, for points relative to `from` and images relative to `to`.
    m: [Vec2; 4],
    from: Point,
    to: Point,
    /// The parameter to blame for a map that does not exist.
    param: &'static str,
    overlays: Vec<Overlay>,
}

impl Mobius {
    /// Creates the map that takes `pole` to infinity and keeps the middle of the artwork's box, with the derivative 1 there.
    pub fn by_pole(frame: Rect, pole: impl Into<Point>) -> Self {
        let z0 = frame.center();
        let p = pole.into() - z0;
        // z/(1 − z/p) = p·z/(p − z).
        let m = [p, Vec2::ZERO, -Vec2::new(1.0, 0.0), p];
        Self { frame, m, from: z0, to: z0, param: "pole", overlays: Vec::new() }
    }

    /// Creates the map that takes three distinct points to three distinct points.
    pub fn by_points(frame: Rect, from: [impl Into<Point>; 3], to: [impl Into<Point>; 3]) -> Self {
        let (p, q) = (from.map(Into::into), to.map(Into::into));
        let overlay = |role, p: &[Point]| Overlay { role, path: Outline::from_points(p, false).to_bez_path(0.0) };
        let overlays = vec![overlay(Role::Base, &p), overlay(Role::Target, &q)];
        let m = by_points(p.map(|z| z - p[0]), q.map(|w| w - q[0]));
        Self { frame, m, from: p[0], to: q[0], param: "to", overlays }
    }

    /// Creates the map with the coefficients a, b, c, d; x is the real part, y the imaginary one.
    #[must_use]
    pub fn by_coefficients(frame: Rect, coefficients: [Vec2; 4]) -> Self {
        let (from, to) = (Point::ORIGIN, Point::ORIGIN);
        Self { frame, m: coefficients, from, to, param: "coefficients", overlays: Vec::new() }
    }

    /// Builds the map. It is undefined within 2 % of the box's diagonal from the pole.
    ///
    /// # Errors
    /// [`Error::Usage`] when ad = bc, as for points that coincide, or a pole in the middle of the box.
    pub fn build(&self) -> Result<Built, Error> {
        let Self { frame, m, from, to, .. } = *self;
        let [a, b, c, d] = m;
        let det = mul(a, d) - mul(b, c);
        let size = mul(a, d).hypot() + mul(b, c).hypot();
        if !(det.hypot() > 1e-12 * size && det.hypot().is_finite()) {
            return Err(Error::usage(self.param, "", "gives no Möbius map: everything would go to one point"));
        }
        // Artwork that is a point still needs a scale.
        let diagonal = frame.width().hypot(frame.height()).max(1e-9);
        let explanation = Explanation { overlays: self.overlays.clone(), ..Explanation::default() };
        let pole = (c != Vec2::ZERO).then(|| from + div(-d, c));
        let Some(pole) = pole.filter(|p| p.distance(frame.center()) < FAR * diagonal) else {
            // (a·z + b)/d.
            let a = div(a, d);
            let b = to.to_vec2() + div(b, d) - mul(a, from.to_vec2());
            let m = Affine::new([a.x, a.y, -a.y, a.x, b.x, b.y]);
            return Ok(Built::new(Arc::new(AffineMap(m))).explained(explanation));
        };
        let mut built = Built::new(Arc::new(MobiusMap { m, from, to, clear: CLEAR * diagonal })).explained(explanation);
        built.note(format!("pole at {}", show(pole)));
        if frame.contains(pole) {
            built.warn(format!(
                "mobius: the pole {} lies within the artwork's box: shapes around it are turned inside out",
                show(pole)
            ));
        }
        Ok(built)
    }
}

static INFO: Info = Info::new("mobius", "take circles to circles, by a pole, three points or coefficients")
    .group("Classics")
    .by_hand(ByHand {
        label: Some("Möbius"),
        ..ByHand::NONE
    })
    .guides(&["to", "from"], 0)
    .about("Straight lines become arcs of circles, circles stay circles, and angles are kept: small squares stay small squares. The \
simplest way in is the pole, the point that goes to infinity: artwork grows towards it and shrinks away from it. Or give three \
points and their images (--from, --to), or give the coefficients of w = (a·z + b)/(c·z + d), z = x + iy.\n\nArtwork must keep clear of the pole.")
    .source("L. Ahlfors, Complex Analysis, 3rd edition 1979, section 3.3")
    .params(&[
        Param::new(
            "pole",
            Kind::Point,
            "The point that goes to infinity; the middle of the artwork stays as it is. Default: below the middle, 1.6 diagonals away.",
        ),
        Param::path("from", "Three anchors in the source; with --to, instead of --pole."),
        Param::path("to", "Three anchors: the images of those of --from."),
        Param::new("coefficients", Kind::Numbers(8), "Real and imaginary parts of a, b, c, d; instead of --pole."),
    ])
    .demo(&[("pole", "60,250")])
    .examples(&[
        Example { what: "As it comes", command: "mobius samples/logo.svg -o out.svg" },
        Example {
            what: "Both ends of a word up, its middle kept",
            command: "mobius samples/lettering.svg --from '0%,50% 50%,50% 100%,50%' --to '5%,10% 50%,50% 95%,10%' -o out.svg",
        },
        Example {
            what: "A grid of circles",
            command: "mobius samples/grid.svg --pole 130%,-40% --fit page -o out.svg",
        },
    ])
    .laws(&[
        Law::Identity(&[("from", "0,0 50,20 100,0"), ("to", "0,0 50,20 100,0")]),
        Law::KeepsAngles(&[]),
        Law::KeepsAngles(&[("from", "0,100 50,100 100,100"), ("to", "0,100 50,80 100,100")]),
        // w = z₀ + (z − z₀)/(1 − (z − z₀)/(P − z₀)) with z₀ = 50 + 50i, P = 50 + 250i, multiplied out.
        Law::Same(&[("pole", "50,250")], &[("coefficients", "-50,150 0,5000 -1,0 50,250")]),
        Law::Same(&[("coefficients", "0,1 3,4 0,0 2,0")], &[("coefficients", "0,-2 -6,-8 0,0 -4,0")]),
        Law::KeepsLines(&[("from", "0,0 50,0 100,0"), ("to", "0,0 50,50 100,100")]),
    ])
    .cases(&[
        Case { args: &[("pole", "50,250")], at: (50.0, 50.0), to: (50.0, 50.0), tolerance: 1e-12 },
        // Half-way to the pole, as far again as the pole.
        Case { args: &[("pole", "50,250")], at: (50.0, 150.0), to: (50.0, 250.0), tolerance: 1e-11 },
        // 1/z takes 3 + 4i to (3 − 4i)/25.
        Case { args: &[("coefficients", "0 0 1 0 1 0 0 0")], at: (3.0, 4.0), to: (0.12, -0.16), tolerance: 1e-15 },
        Case {
            args: &[("from", "0,100 50,100 100,100"), ("to", "0,100 50,80 100,100")],
            at: (50.0, 100.0),
            to: (50.0, 80.0),
            tolerance: 1e-12,
        },
    ]);

/// Distance from the pole within which the map is undefined, as a fraction of the frame's diagonal.
const CLEAR: f64 = 0.02;
/// Default distance of the pole, in diagonals of the frame.
const DEFAULT_DISTANCE: f64 = 1.6;
/// A pole farther away than this many diagonals counts as none: the map is a similitude.
const FAR: f64 = 1e12;

/// Reads the deformation from text.
pub(super) const ENTRY: Entry = Entry::new(&INFO, |s| {
    let frame = s.frame().rect;
    let mobius = match (s.numbers_if("coefficients")?, s.path_if("from")?, s.path_if("to")?) {
        (Some(v), None, None) if !s.given("pole") => {
            Mobius::by_coefficients(frame, std::array::from_fn(|i| Vec2::new(v[2 * i], v[2 * i + 1])))
        }
        (None, Some(from), Some(to)) if !s.given("pole") => {
            let overlay = |role, path: &NamedPath| Overlay { role, path: path.outline.to_bez_path(0.0) };
            let overlays = vec![overlay(Role::Base, &from), overlay(Role::Target, &to)];
            Mobius { overlays, ..Mobius::by_points(frame, three_anchors(&from)?, three_anchors(&to)?) }
        }
        (None, None, None) => {
            let below = Vec2::new(0.0, DEFAULT_DISTANCE * frame.width().hypot(frame.height()));
            let pole = if s.given("pole") { s.point("pole")? } else { frame.center() + below };
            Mobius::by_pole(frame, pole)
        }
        (Some(_), ..) => {
            return Err(Error::usage("coefficients", "", "are the whole map: omit `pole`, `from` and `to`"));
        }
        (None, Some(_), Some(_)) => {
            return Err(Error::usage("pole", "", "follows from `from` and `to`: omit it"));
        }
        (None, from, _) => {
            let (given, missing) = if from.is_some() { ("from", "to") } else { ("to", "from") };
            return Err(Error::missing(missing, format!("`{given}` goes with it")));
        }
    };
    mobius.build()
});

/// Returns the three distinct anchors of a path.
fn three_anchors(path: &NamedPath) -> Result<[Point; 3], Error> {
    let a = anchors::only_subpath(path, "three")?.anchors();
    let [p, q, r] = a[..] else {
        return Err(GeometryError::anchor_count(&path.name, &a, "three").into());
    };
    anchors::check_distinct(&path.name, &a)?;
    Ok([p, q, r])
}

/// The product of two complex numbers.
fn mul(a: Vec2, b: Vec2) -> Vec2 {
    Vec2::new(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x)
}

/// The quotient of two complex numbers.
fn div(a: Vec2, b: Vec2) -> Vec2 {
    mul(a, Vec2::new(b.x, -b.y)) / b.hypot2()
}

/// Returns the coefficients of K⁻¹ ∘ H.
fn by_points(p: [Vec2; 3], q: [Vec2; 3]) -> [Vec2; 4] {
    let h = |[p1, p2, p3]: [Vec2; 3]| [p2 - p3, -mul(p1, p2 - p3), p2 - p1, -mul(p3, p2 - p1)];
    let ([a, b, c, d], [e, f, g, i]) = (h(q), h(p));
    // The inverse of (a b; c d) is (d −b; −c a) up to a factor.
    [mul(d, e) - mul(b, g), mul(d, f) - mul(b, i), mul(a, g) - mul(c, e), mul(a, i) - mul(c, f)]
}

/// The map, with c ≠ 0.
#[derive(Debug, Clone, Copy)]
struct MobiusMap {
    /// a, b, c, d, for points relative to `from` and images relative to `to`.
    m: [Vec2; 4],
    from: Point,
    to: Point,
    /// Distance from the pole within which the map is undefined.
    clear: f64,
}

impl Formula for MobiusMap {
    fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
        let [a, b, c, d] = self.m;
        let (x, y) = (x - self.from.x, y - self.from.y);
        let (nx, ny) = (x * a.x - y * a.y + b.x, x * a.y + y * a.x + b.y);
        let (dx, dy) = (x * c.x - y * c.y + d.x, x * c.y + y * c.x + d.y);
        let n = dx * dx + dy * dy;
        ((nx * dx + ny * dy) / n + self.to.x, (ny * dx - nx * dy) / n + self.to.y)
    }

    fn creases(&self, out: &mut Creases) {
        let (pole, clear) = (self.from + div(-self.m[3], self.m[2]), self.clear);
        out.push(Crease::edge(Level::Circle { center: pole, radius: clear }));
    }

    fn image(&self, curve: &RationalBezier) -> Option<RationalBezier> {
        let [a, b, c, d] = self.m;
        let relative = |[x, y, w]: [f64; 3]| [x - self.from.x * w, y - self.from.y * w, w];
        let part = |f: &dyn Fn([f64; 3]) -> f64| Scaled::new(curve.points.iter().map(|p| f(relative(*p))));
        let (nx, ny) = (part(&|[x, y, w]| x * a.x - y * a.y + w * b.x), part(&|[x, y, w]| x * a.y + y * a.x + w * b.y));
        let (dx, dy) = (part(&|[x, y, w]| x * c.x - y * c.y + w * d.x), part(&|[x, y, w]| x * c.y + y * c.x + w * d.y));
        let sum = |p: &Scaled, q: &Scaled, k: f64, r: &Scaled, s: &Scaled| {
            let mut out = p.times(q);
            out.add_scaled(k, &r.times(s));
            out
        };
        let (x, y) = (sum(&nx, &dx, 1.0, &ny, &dy), sum(&ny, &dx, -1.0, &nx, &dy));
        let w = sum(&dx, &dx, 1.0, &dy, &dy);
        let image = RationalBezier::from_coordinates([&x, &y, &w], false);
        Some(image.mapped(|[x, y, w]| [x + self.to.x * w, y + self.to.y * w, w]))
    }

    /// |F − a/c|·|z − pole| is constant, so points near the inverse's pole a/c come from points far away.
    fn inverse(&self) -> Option<Arc<dyn Map>> {
        let [a, b, c, d] = self.m;
        let product = ((mul(a, d) - mul(b, c)).hypot()) / c.hypot2();
        let far = self.clear / (CLEAR * CLEAR);
        Some(Arc::new(Self { m: [d, -b, -c, a], from: self.to, to: self.from, clear: product / far }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check;
    use crate::deform::Deformation as _;
    use crate::outline::{EllipticArc, Seg};
    use crate::param::Args;

    /// A map around 9e8 agrees with the one around the origin, up to the rounding of the coordinates.
    #[test]
    fn far_from_the_origin_no_digits_are_lost() {
        let far = Vec2::new(9e8, -9e8);
        let frame = Rect::new(0.0, 0.0, 100.0, 60.0);
        let three = [(0.0, 50.0), (50.0, 40.0), (100.0, 50.0)].map(Point::from);
        let moved = [(5.0, 10.0), (50.0, 40.0), (95.0, 10.0)].map(Point::from);
        let pair = |by: Vec2| {
            let shifted = |p: [Point; 3]| p.map(|p| p + by);
            let pole = Mobius::by_pole(frame + by, Point::new(60.0, 250.0) + by).build().unwrap().map;
            [pole, Mobius::by_points(frame + by, shifted(three), shifted(moved)).build().unwrap().map]
        };
        for (near, away) in pair(Vec2::ZERO).iter().zip(pair(far)) {
            for (near, away) in [(near.clone(), away.clone()), (near.inverse().unwrap(), away.inverse().unwrap())] {
                for p in [(3.0, 4.0), (50.0, 20.0), (99.0, 59.0)].map(Point::from) {
                    assert!((away.point(p + far) - far).distance(near.point(p)) < 1e-6);
                }
            }
        }
    }

    #[test]
    fn is_sound() {
        let faults = check::entry(&ENTRY);
        assert!(faults.is_empty(), "{faults:#?}");
    }

    fn build(pairs: &[(&str, &str)]) -> Result<Built, Error> {
        ENTRY.build_from(&Args::from_pairs(pairs), &check::frame())
    }

    /// The circle through three points of the image holds all other points of the image.
    #[test]
    fn circles_and_lines_go_to_circles() {
        let m = build(&[("pole", "110,-20")]).unwrap().map;
        let circle = EllipticArc::new(Point::new(40.0, 50.0), Vec2::new(30.0, 0.0), Vec2::new(0.0, 30.0), 0.0, 6.0);
        for seg in [Seg::Arc(circle), Seg::Line(kurbo::Line::new((0.0, 90.0), (100.0, 35.0)))] {
            let p: Vec<Point> = (0..=20).map(|i| m.point(seg.eval(f64::from(i) / 20.0))).collect();
            let (a, b, c) = (p[0], p[7], p[14]);
            let (u, v) = (b - a, c - a);
            let k = 2.0 * u.cross(v);
            let centre = a + Vec2::new(v.y * u.hypot2() - u.y * v.hypot2(), u.x * v.hypot2() - v.x * u.hypot2()) / k;
            for q in &p {
                assert!((q.distance(centre) - a.distance(centre)).abs() < 1e-9 * a.distance(centre));
            }
        }
    }

    #[test]
    fn all_three_anchors_land() {
        let (from, to) = ("3,4 90,20 40,77", "10,10 60,80 -5,33");
        let m = build(&[("from", from), ("to", to)]).unwrap().map;
        for (p, q) in [((3.0, 4.0), (10.0, 10.0)), ((90.0, 20.0), (60.0, 80.0)), ((40.0, 77.0), (-5.0, 33.0))] {
            assert!(m.point(p.into()).distance(q.into()) < 1e-10);
        }
    }

    #[test]
    fn degenerate_maps_and_poles_on_artwork_are_refused() {
        assert!(build(&[("coefficients", "1 0 2 0 2 0 4 0")]).is_err());
        assert!(build(&[("from", "0,0 1,0 2,0")]).is_err());
        assert!(build(&[("from", "0,0 1,0 0,0"), ("to", "0,0 1,0 2,0")]).is_err());
        assert!(build(&[("pole", "50,50")]).is_err());
        let b = build(&[("pole", "50,80")]).unwrap();
        assert!(b.explanation.warnings[0].contains("pole 50,80"));
        let art = Outline::from_svg("M0,80 H100").unwrap();
        let e = crate::refit::warp_path(&art, &*b.map, &crate::refit::Options::new(0.1)).unwrap_err();
        assert!(e.to_string().contains("infinity at 4"), "{e}");
    }
}
