//! The image of one source segment under a map that is smooth on it, sampled eight parameters at a time.

use super::lanes::{Lane, Lanes, fma, sum};
use super::limits::{ONE_SIDED_STEP, VANISHING_DERIVATIVE};
use crate::map::{Jet, Map};
use crate::outline::Seg;
use kurbo::{Point, Vec2};

/// A source segment in its canonical direction, with the smooth map that holds on it.
#[derive(Clone, Copy)]
pub(super) struct SourceCurve<'a> {
    pub(super) seg: &'a Seg,
    pub(super) map: &'a dyn Map,
    /// Coefficients of the power basis, constant term first; unused for an arc unless `w` is set.
    c: [Vec2; 4],
    /// The derivative at the end: exact, where the power basis has it only up to rounding.
    last: Vec2,
    /// Length of the control polygon: the scale against which derivatives are judged.
    size: f64,
    /// Denominator of an arc in rational form, power basis. If set, `c` holds the numerators relative to the centre.
    w: Option<[f64; 3]>,
}

/// A point between two pieces: a place on the image, with the tangents on both sides.
#[derive(Debug, Clone, Copy)]
pub(super) struct BreakPoint {
    pub(super) t: f64,
    pub(super) p: Point,
    /// Speed of the image with respect to the parameter; zero where the derivative vanishes.
    pub(super) speed: f64,
    /// Unit tangent just before.
    pub(super) into: Vec2,
    /// Unit tangent just after.
    pub(super) away: Vec2,
}

impl<'a> SourceCurve<'a> {
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

    /// As [`SourceCurve::new`]. If a proof is wanted, turns an arc of less than half a turn into a rational quadratic: the
    /// same curve in another parametrisation.
    #[inline(always)]
    pub(super) fn for_proof(seg: &'a Seg, map: &'a dyn Map, proof: bool) -> Self {
        let mut out = Self::new(seg, map);
        if proof {
            out.make_rational();
        }
        out
    }

    /// See [`SourceCurve::for_proof`].
    pub(super) fn make_rational(&mut self) {
        let Seg::Arc(a) = self.seg else { return };
        // At half a turn the weight of the middle control point is zero.
        if a.sweep.abs() > 3.0 {
            return;
        }
        // With h half the sweep and s = sin h, c = cos h, the control points in the axes of the middle angle are (c, −s),
        // (1, 0), (c, s), with weights 1, c, 1. Power basis of the numerators and of the denominator.
        let (h, mid) = (0.5 * a.sweep, a.start + 0.5 * a.sweep);
        let (s, c) = h.sin_cos();
        let (sm, cm) = mid.sin_cos();
        let (u, v) = (a.a * cm + a.b * sm, a.b * cm - a.a * sm);
        self.c = [u * c - v * s, u * (2.0 * (1.0 - c)) + v * (2.0 * s), u * (2.0 * (c - 1.0)), Vec2::ZERO];
        self.w = Some([1.0, 2.0 * (c - 1.0), 2.0 * (1.0 - c)]);
        self.last = self.deriv_rational(1.0);
    }

    /// Returns `true` if the source has a denominator.
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

    /// Converts a parameter of the segment to one of this curve.
    pub(super) fn param(&self, t: f64) -> f64 {
        match (self.seg, self.w) {
            (Seg::Arc(a), Some(_)) => {
                // The tangent of half the angle from the middle is linear in the rational parameter.
                let h = 0.25 * a.sweep;
                0.5 + 0.5 * (h * (2.0 * t - 1.0)).tan() / h.tan()
            }
            _ => t,
        }
    }

    /// The degree of the source as a quotient of polynomials, and `true` if it has a denominator. `None` for an arc that is
    /// not in rational form.
    pub(super) fn degree(&self) -> Option<(usize, bool)> {
        match self.seg {
            Seg::Line(_) => Some((1, false)),
            Seg::Quad(_) => Some((2, false)),
            Seg::Cubic(_) => Some((3, false)),
            Seg::Arc(_) => self.w.map(|_| (2, true)),
        }
    }

    /// The denominators of the image at eight parameters: the map's, times the source's to the power of the map's degree.
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

    /// Writes the images at eight parameters. `Err`: the source point at which the map is not finite.
    #[inline(always)]
    pub(super) fn images_into(&self, t: &Lane, g: &mut Lanes) -> Result<(), Point> {
        *g = self.points(t);
        self.map.lanes(&mut g.x, &mut g.y);
        // One test for all: the sum is finite only if every term is. Terms too large to add up are too large to fit.
        let mut all = [0.0; 8];
        for i in 0..8 {
            all[i] = g.x[i] + g.y[i];
        }
        if sum(&all).is_finite() { Ok(()) } else { Err(self.not_finite(t, g)) }
    }

    /// Returns the images at eight parameters. `Err`: the source point at which the map is not finite.
    #[inline(always)]
    pub(super) fn images(&self, t: &Lane) -> Result<Lanes, Point> {
        let mut out = Lanes::default();
        self.images_into(t, &mut out)?;
        Ok(out)
    }

    #[cold]
    fn not_finite(&self, t: &Lane, g: &Lanes) -> Point {
        let i = (0..8).find(|&i| !(g.x[i] + g.y[i]).is_finite()).unwrap_or(0);
        self.at(t[i])
    }

    /// The image's point and derivative.
    pub(super) fn image(&self, t: f64) -> (Point, Vec2) {
        let j = self.map.jet(self.at(t));
        (j.p, j.push(self.deriv(t)))
    }

    /// The source's point.
    pub(super) fn at(&self, t: f64) -> Point {
        match (self.seg, self.w) {
            (Seg::Arc(a), Some([w0, w1, w2])) if t > 0.0 && t < 1.0 => {
                let [c0, c1, c2, _] = self.c;
                a.center + ((c2 * t + c1) * t + c0) / ((w2 * t + w1) * t + w0)
            }
            _ => self.seg.eval(t),
        }
    }

    /// The break point at `t`. `Err`: the source point, if the map is not finite there.
    pub(super) fn end(&self, t: f64) -> Result<BreakPoint, Point> {
        let at = self.at(t);
        let jet = self.map.jet(at);
        if jet.is_finite() { Ok(self.end_with(t, jet.p, &jet)) } else { Err(at) }
    }

    /// The break point at `t` where the map has the finite jet `jet`. `p` is the image of a source node or crease, which
    /// the neighbouring piece shares bit by bit.
    #[inline(always)]
    pub(super) fn end_with(&self, t: f64, p: Point, jet: &Jet) -> BreakPoint {
        let v = self.deriv(t);
        let d = jet.push(v);
        let (n2, v2) = (d.hypot2(), v.hypot2());
        let j2 = jet.dx.hypot2() + jet.dy.hypot2();
        if n2 > VANISHING_DERIVATIVE * VANISHING_DERIVATIVE * j2 * v2 && v2 > (VANISHING_DERIVATIVE * self.size).powi(2)
        {
            let speed = n2.sqrt();
            let u = d / speed;
            return BreakPoint { t, p, speed, into: u, away: u };
        }
        let away = self.one_sided_tangent(t, 1.0, jet);
        let into = self.one_sided_tangent(t, -1.0, jet);
        BreakPoint { t, p, speed: 0.0, into, away }
    }

    /// The unit tangent just after (`side` = 1) or just before (−1) a point at which the derivative vanishes: the image of
    /// the source's first derivative that does not vanish (the k-th has the sign (±1)^(k−1)). If the map's Jacobian maps
    /// that to zero too, returns the direction a little to that side.
    #[cold]
    fn one_sided_tangent(&self, t: f64, side: f64, jet: &Jet) -> Vec2 {
        if !matches!(self.seg, Seg::Arc(_)) {
            let v = self.deriv(t);
            let a = self.c[2] * 2.0 + self.c[3] * (6.0 * t);
            let b = self.c[3] * 6.0;
            let small = (VANISHING_DERIVATIVE * self.size) * 10.0;
            if v.hypot() <= small {
                let w = if a.hypot() > small { a * side } else { b };
                let d = jet.push(w);
                let whole = (jet.dx.hypot2() + jet.dy.hypot2()).sqrt() * w.hypot();
                if d.hypot() > 1e-6 * whole {
                    return d / d.hypot();
                }
            }
        }
        // Step farther away until there is a direction; a constant image has none.
        let mut h = ONE_SIDED_STEP;
        while h < 1.0 {
            let s = t + side * h;
            let s = if (0.0..=1.0).contains(&s) { s } else { t - side * h };
            let flip = if (s - t) * side < 0.0 { -1.0 } else { 1.0 };
            let (_, d) = self.image(s);
            let n = d.hypot();
            if n > 0.0 && n.is_finite() {
                // Beyond the end of the segment there is no curve. The tangent on that side is never used by a piece of
                // this segment, so the sign does not matter.
                return d * (flip / n);
            }
            h *= 30.0;
        }
        Vec2::ZERO
    }
}
