//! One smooth source piece and its image: sampled eight parameters at a time, with one-sided tangents at its break points.

use super::fit::{self, fma};
use crate::map::{Jet, Map};
use crate::outline::Seg;
use kurbo::{Point, Vec2};

/// Eight numbers side by side: what one pass of the fit works on (two AVX registers of four, or four SSE2 ones of two).
pub(super) type Lane = crate::map::batch::Lane;

/// Eight points.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Lanes {
    pub(super) x: Lane,
    pub(super) y: Lane,
}

/// Below this share of its usual size a derivative says nothing about the direction of the curve.
const VANISHING: f64 = 1e-9;

/// Where one-sided directions are taken instead, as a share of the segment: far above rounding, and the direction there is
/// off by about the same number of radians, a thousandth of the angle the joints are promised to.
const BESIDE: f64 = 3e-7;

/// A curve that can be fitted: the image of one segment, or of several in a row.
pub(super) trait Curve {
    /// Writes the images at eight parameters. `Err`: the source place where the map is not finite.
    fn images_into(&self, t: &Lane, out: &mut Lanes) -> Result<(), Point>;
    /// Images at eight parameters. `Err`: the source place where the map is not finite.
    #[inline(always)]
    fn images(&self, t: &Lane) -> Result<Lanes, Point> {
        let mut out = Lanes::default();
        self.images_into(t, &mut out)?;
        Ok(out)
    }
    /// The image's point and derivative at one parameter.
    fn image(&self, t: f64) -> (Point, Vec2);
    /// The break point at `t`.
    fn end(&self, t: f64) -> Result<End, Point>;
    /// Places in (t0, t1) that a close look must not miss, besides those spread evenly.
    fn places(&self, _t0: f64, _t1: f64) -> Vec<f64> {
        Vec::new()
    }
    /// The source's point at `t`, to name in messages.
    fn at(&self, t: f64) -> Point;
    /// The curve as the image of one segment, which proofs need.
    fn single(&self) -> Option<&Source<'_>>;
}

/// A source segment in its canonical direction under the smooth map that holds on it.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) seg: &'a Seg,
    pub(super) map: &'a dyn Map,
    /// Power basis, constant term first; of no meaning for an arc.
    c: [Vec2; 4],
    /// Derivative at the end, which the power basis knows only up to rounding.
    last: Vec2,
    /// Length of the control polygon, the yardstick of the derivative.
    size: f64,
    /// Weights of an arc in its rational form, power basis; then `c` holds its numerators about the centre.
    w: Option<[f64; 3]>,
}

/// A break point: a place on the image, with the tangents on both sides.
#[derive(Debug, Clone, Copy)]
pub(super) struct End {
    pub(super) t: f64,
    pub(super) p: Point,
    /// Speed of the image with respect to the segment's parameter; zero where the derivative vanishes.
    pub(super) speed: f64,
    /// Unit tangent just before.
    pub(super) into: Vec2,
    /// Unit tangent just after.
    pub(super) away: Vec2,
}

impl<'a> Source<'a> {
    #[inline(always)]
    pub(super) fn new(seg: &'a Seg, map: &'a dyn Map) -> Self {
        let zero = Vec2::ZERO;
        let (c, last, size) = match seg {
            Seg::Line(s) => {
                let d = s.p1 - s.p0;
                ([s.p0.to_vec2(), d, zero, zero], d, d.hypot())
            }
            Seg::Quad(s) => {
                let (d0, d1) = (s.p1 - s.p0, s.p2 - s.p1);
                ([s.p0.to_vec2(), d0 * 2.0, d1 - d0, zero], d1 * 2.0, d0.hypot() + d1.hypot())
            }
            Seg::Cubic(s) => {
                let (d0, d1, d2) = (s.p1 - s.p0, s.p2 - s.p1, s.p3 - s.p2);
                let c = [s.p0.to_vec2(), d0 * 3.0, (d1 - d0) * 3.0, (d2 - d1) - (d1 - d0)];
                (c, d2 * 3.0, d0.hypot() + d1.hypot() + d2.hypot())
            }
            Seg::Arc(s) => ([zero; 4], s.deriv(1.0), s.a.hypot().max(s.b.hypot()) * s.sweep.abs()),
        };
        Self { seg, map, c, last, size, w: None }
    }

    /// As [`Source::new`]; for proofs, an arc of less than half a turn as a rational quadratic: the same curve, another
    /// parameter.
    #[inline(always)]
    pub(super) fn for_proof(seg: &'a Seg, map: &'a dyn Map, proof: bool) -> Self {
        let mut out = Self::new(seg, map);
        if proof {
            out.make_rational();
        }
        out
    }

    /// See [`Source::for_proof`].
    pub(super) fn make_rational(&mut self) {
        let Seg::Arc(a) = self.seg else { return };
        if a.sweep.abs() > 3.0 {
            return;
        }
        // With h half the sweep and s = sin h, c = cos h, in the axes of the middle angle: (c, −s), (1, 0), (c, s), the middle one
        // of weight c. Power basis of the numerators and the denominator.
        let (h, mid) = (0.5 * a.sweep, a.start + 0.5 * a.sweep);
        let (s, c) = h.sin_cos();
        let (sm, cm) = mid.sin_cos();
        let (u, v) = (a.a * cm + a.b * sm, a.b * cm - a.a * sm);
        self.c = [u * c - v * s, u * (2.0 * (1.0 - c)) + v * (2.0 * s), u * (2.0 * (c - 1.0)), Vec2::ZERO];
        self.w = Some([1.0, 2.0 * (c - 1.0), 2.0 * (1.0 - c)]);
        self.last = self.deriv_rational(1.0);
    }

    /// Whether the source is a quotient of polynomials with a denominator.
    pub(super) fn is_rational(&self) -> bool {
        self.w.is_some()
    }

    fn deriv_rational(&self, t: f64) -> Vec2 {
        let [c0, c1, c2, _] = self.c;
        let Some([w0, w1, w2]) = self.w else { return Vec2::ZERO };
        let (n, dn) = ((c2 * t + c1) * t + c0, c2 * (2.0 * t) + c1);
        let (w, dw) = ((w2 * t + w1) * t + w0, w2 * (2.0 * t) + w1);
        (dn * w - n * dw) / (w * w)
    }

    /// The parameter here of what the segment has at `t`.
    pub(super) fn param(&self, t: f64) -> f64 {
        match (self.seg, self.w) {
            (Seg::Arc(a), Some(_)) => {
                // Half the angle from the middle has a tangent that is linear in the rational parameter.
                let h = 0.25 * a.sweep;
                0.5 + 0.5 * (h * (2.0 * t - 1.0)).tan() / h.tan()
            }
            _ => t,
        }
    }

    /// Degree of the source as a quotient of polynomials, and whether it has a denominator.
    pub(super) fn degree(&self) -> Option<(usize, bool)> {
        match self.seg {
            Seg::Line(_) => Some((1, false)),
            Seg::Quad(_) => Some((2, false)),
            Seg::Cubic(_) => Some((3, false)),
            Seg::Arc(_) => self.w.map(|_| (2, true)),
        }
    }

    /// The denominators of the image at eight parameters: the map's times the source's, the latter to the map's degree.
    pub(super) fn denominators(&self, t: &Lane, points: &Lanes, power: i32) -> Lane {
        let mut out = self.map.denominators(&points.x, &points.y);
        if let Some([w0, w1, w2]) = self.w {
            for i in 0..8 {
                out[i] *= ((w2 * t[i] + w1) * t[i] + w0).powi(power);
            }
        }
        out
    }

    /// The source's derivative.
    #[inline(always)]
    pub(super) fn deriv(&self, t: f64) -> Vec2 {
        match self.seg {
            _ if t == 1.0 => self.last,
            Seg::Arc(_) if self.w.is_some() => self.deriv_rational(t),
            Seg::Arc(s) => s.deriv(t),
            _ => {
                let [_, c1, c2, c3] = self.c;
                (c3 * (3.0 * t) + c2 * 2.0) * t + c1
            }
        }
    }

    /// Length of the control polygon.
    pub(super) fn size(&self) -> f64 {
        self.size
    }

    /// Source points at eight parameters.
    #[inline(always)]
    pub(super) fn points(&self, t: &Lane) -> Lanes {
        let mut out = Lanes::default();
        if let Seg::Arc(a) = self.seg {
            if let Some([w0, w1, w2]) = self.w {
                let [c0, c1, c2, _] = self.c;
                for i in 0..8 {
                    let t = t[i];
                    let k = 1.0 / ((w2 * t + w1) * t + w0);
                    out.x[i] = a.center.x + ((c2.x * t + c1.x) * t + c0.x) * k;
                    out.y[i] = a.center.y + ((c2.y * t + c1.y) * t + c0.y) * k;
                }
                return out;
            }
            for i in 0..8 {
                let p = a.eval(t[i]);
                (out.x[i], out.y[i]) = (p.x, p.y);
            }
            return out;
        }
        let [c0, c1, c2, c3] = self.c;
        for i in 0..8 {
            let t = t[i];
            out.x[i] = fma(fma(fma(c3.x, t, c2.x), t, c1.x), t, c0.x);
            out.y[i] = fma(fma(fma(c3.y, t, c2.y), t, c1.y), t, c0.y);
        }
        out
    }

    #[cold]
    fn not_finite(&self, t: &Lane, g: &Lanes) -> Point {
        let i = (0..8).find(|&i| !(g.x[i] + g.y[i]).is_finite()).unwrap_or(0);
        self.at(t[i])
    }

    /// The break point at `t`. `node` is the image of a source node or crease, shared with the neighbours bit by bit.
    pub(super) fn end_at(&self, t: f64, node: Option<Point>) -> Result<End, Point> {
        let at = self.at(t);
        let jet = self.map.jet(at);
        if jet.is_finite() { Ok(self.end_with(t, node.unwrap_or(jet.p), &jet)) } else { Err(at) }
    }

    /// As [`Source::end_at`], with the place's image and the map's finite jet there known.
    #[inline(always)]
    pub(super) fn end_with(&self, t: f64, p: Point, jet: &Jet) -> End {
        let v = self.deriv(t);
        let d = jet.push(v);
        let (n2, v2) = (d.hypot2(), v.hypot2());
        let j2 = jet.dx.hypot2() + jet.dy.hypot2();
        if n2 > VANISHING * VANISHING * j2 * v2 && v2 > (VANISHING * self.size).powi(2) {
            let speed = n2.sqrt();
            let u = d / speed;
            return End { t, p, speed, into: u, away: u };
        }
        let away = self.beside(t, 1.0, jet);
        let into = self.beside(t, -1.0, jet);
        End { t, p, speed: 0.0, into, away }
    }

    /// The unit tangent just after (`side` = 1) or just before (−1) a place where the derivative vanishes: the image of the
    /// first derivative of the source that does not (the k-th turns with (±1)^(k−1)); if the map kills that too, the
    /// direction a little beside the place.
    #[cold]
    fn beside(&self, t: f64, side: f64, jet: &Jet) -> Vec2 {
        if !matches!(self.seg, Seg::Arc(_)) {
            let v = self.deriv(t);
            let a = self.c[2] * 2.0 + self.c[3] * (6.0 * t);
            let b = self.c[3] * 6.0;
            let small = (VANISHING * self.size) * 10.0;
            if v.hypot() <= small {
                let w = if a.hypot() > small { a * side } else { b };
                let d = jet.push(w);
                let whole = (jet.dx.hypot2() + jet.dy.hypot2()).sqrt() * w.hypot();
                if d.hypot() > 1e-6 * whole {
                    return d / d.hypot();
                }
            }
        }
        // Farther and farther away until there is a direction; a constant image has none.
        let mut h = BESIDE;
        while h < 1.0 {
            let s = t + side * h;
            let s = if (0.0..=1.0).contains(&s) { s } else { t - side * h };
            let flip = if (s - t) * side < 0.0 { -1.0 } else { 1.0 };
            let (_, d) = self.image(s);
            let n = d.hypot();
            if n > 0.0 && n.is_finite() {
                // Beyond the segment's end there is nothing: the inner side's direction, mirrored as at a cusp or not, is
                // never used by a piece of this segment.
                return d * (flip / n);
            }
            h *= 30.0;
        }
        Vec2::ZERO
    }
}

impl Curve for Source<'_> {
    #[inline(always)]
    fn images_into(&self, t: &Lane, g: &mut Lanes) -> Result<(), Point> {
        *g = self.points(t);
        self.map.lanes(&mut g.x, &mut g.y);
        // One test for all: the sum is finite only if every term is (terms too large to add up are too large to fit).
        let mut sum = [0.0; 8];
        for i in 0..8 {
            sum[i] = g.x[i] + g.y[i];
        }
        if fit::sum(&sum).is_finite() { Ok(()) } else { Err(self.not_finite(t, g)) }
    }

    fn image(&self, t: f64) -> (Point, Vec2) {
        let j = self.map.jet(self.at(t));
        (j.p, j.push(self.deriv(t)))
    }

    fn end(&self, t: f64) -> Result<End, Point> {
        self.end_at(t, None)
    }

    fn at(&self, t: f64) -> Point {
        match (self.seg, self.w) {
            (Seg::Arc(a), Some([w0, w1, w2])) if t > 0.0 && t < 1.0 => {
                let [c0, c1, c2, _] = self.c;
                a.center + ((c2 * t + c1) * t + c0) / ((w2 * t + w1) * t + w0)
            }
            _ => self.seg.eval(t),
        }
    }

    fn single(&self) -> Option<&Source<'_>> {
        Some(self)
    }
}
