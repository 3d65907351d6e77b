//! The image of one segment under a map that is smooth on it, sampled eight parameters at a time; the direction in which a segment is
//! fitted; and the points where its image may be sharp.

use super::limits::HIDDEN;
use super::overview::Overview;
use crate::map::{Enclosure, Jet, Map, RationalBezier, RationalDegree, enclose_segment};
use crate::outline::Seg;
use bezierfit::parts::{VANISHING_DERIVATIVE, fma, tangent_beside};
use bezierfit::{BreakPoint, Lane, Lanes, NotFinite, Quotient, SlowSpots, Source};
use kurbo::{Point, Vec2};
use std::cmp::Ordering;

/// The degree of a bicubic net: under a map of at most this degree, a few samples determine the image of a segment.
pub(super) const LOW_DEGREE: usize = 6;

/// A source segment in its canonical direction, with the smooth map that holds on it.
#[derive(Clone, Copy)]
pub(super) struct SourceCurve<'a> {
    pub(super) seg: &'a Seg,
    pub(super) map: &'a dyn Map,
    /// The map's degree, if it is a quotient of polynomials.
    degree: Option<RationalDegree>,
    /// The coefficients of the power basis, constant term first; unused for an arc unless `w` is set.
    c: [Vec2; 4],
    /// The derivative at the end: exact, whereas the power basis rounds it.
    last: Vec2,
    /// The length of the control polygon: the scale against which derivatives are judged.
    pub(super) size: f64,
    /// The denominator of an arc in rational form, in the power basis. If set, `c` holds the numerators relative to the centre.
    w: Option<[f64; 3]>,
    /// Bounds for the map around the segment.
    overview: Option<&'a Overview>,
}

// The loops over eight lanes run by index through several arrays at once, the form that LLVM vectorises.
#[allow(clippy::needless_range_loop)]
impl<'a> SourceCurve<'a> {
    #[inline(always)]
    pub(super) fn new(seg: &'a Seg, map: &'a dyn Map, degree: Option<RationalDegree>) -> Self {
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
        Self { seg, map, degree, c, last, size, w: None, overview: None }
    }

    /// Returns this curve with an overview of its map.
    pub(super) fn with_overview(self, overview: Option<&'a Overview>) -> Self {
        Self { overview, ..self }
    }

    /// The source curve of a segment. If a proof is wanted, an arc of less than half a turn becomes a rational quadratic: the
    /// same curve in another parametrisation.
    #[inline(always)]
    pub(super) fn for_proof(seg: &'a Seg, map: &'a dyn Map, degree: Option<RationalDegree>, proof: bool) -> Self {
        let mut out = Self::new(seg, map, degree);
        if proof {
            out.make_rational();
        }
        out
    }

    /// Turns an arc of less than half a turn into a rational quadratic.
    fn make_rational(&mut self) {
        let Seg::Arc(a) = self.seg else { return };
        // At half a turn the weight of the middle control point is zero.
        if a.sweep.abs() > 3.0 {
            return;
        }
        // With h half the sweep and s = sin h, c = cos h, the control points in the axes of the middle angle are (c, −s),
        // (1, 0), (c, s), with weights 1, c, 1. Numerators and denominator are converted to the power basis.
        let (h, middle) = (0.5 * a.sweep, a.start + 0.5 * a.sweep);
        let (s, c) = h.sin_cos();
        let (sm, cm) = middle.sin_cos();
        let (u, v) = (a.a * cm + a.b * sm, a.b * cm - a.a * sm);
        self.c = [u * c - v * s, u * (2.0 * (1.0 - c)) + v * (2.0 * s), u * (2.0 * (c - 1.0)), Vec2::ZERO];
        self.w = Some([1.0, 2.0 * (c - 1.0), 2.0 * (1.0 - c)]);
        self.last = self.deriv_rational(1.0);
    }

    /// Converts a parameter of this curve to one of the segment; the reverse of [`param`](Self::param).
    fn segment_param(&self, t: f64) -> f64 {
        match (self.seg, self.w) {
            (Seg::Arc(a), Some(_)) => {
                let h = 0.25 * a.sweep;
                0.5 + 0.5 * ((2.0 * t - 1.0) * h.tan()).atan() / h
            }
            _ => t,
        }
    }

    fn deriv_rational(&self, t: f64) -> Vec2 {
        let [c0, c1, c2, _] = self.c;
        let Some([w0, w1, w2]) = self.w else { return Vec2::ZERO };
        let (n, dn) = ((c2 * t + c1) * t + c0, c2 * (2.0 * t) + c1);
        let (w, dw) = ((w2 * t + w1) * t + w0, w2 * (2.0 * t) + w1);
        (dn * w - n * dw) / (w * w)
    }

    /// The slow spots, as parameters of this curve.
    pub(super) fn slow_spots(&self) -> SlowSpots {
        let spots = match self.seg {
            Seg::Line(_) => return SlowSpots::default(),
            Seg::Quad(s) => SlowSpots::of_quad(s),
            Seg::Cubic(s) => SlowSpots::of_cubic(s),
            Seg::Arc(s) => SlowSpots::of_arc([s.a, s.b], s.start, s.sweep),
        };
        if self.w.is_some() { spots.map(|t| self.param(t)) } else { spots }
    }

    /// Converts a parameter of the segment to one of this curve.
    fn param(&self, t: f64) -> f64 {
        match (self.seg, self.w) {
            (Seg::Arc(a), Some(_)) => {
                // The tangent of half the angle from the middle is linear in the rational parameter.
                let h = 0.25 * a.sweep;
                0.5 + 0.5 * (h * (2.0 * t - 1.0)).tan() / h.tan()
            }
            _ => t,
        }
    }

    /// The derivative of the source.
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

    /// The source points at eight parameters.
    #[inline(always)]
    fn seg_points(&self, t: &Lane) -> Lanes {
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

    /// The source points at eight parameters, as points.
    pub(super) fn sampled(&self, t: &Lane) -> [Point; 8] {
        let g = self.seg_points(t);
        std::array::from_fn(|i| Point::new(g.x[i], g.y[i]))
    }

    /// The source point at a parameter.
    pub(super) fn at(&self, t: f64) -> Point {
        match (self.seg, self.w) {
            (Seg::Arc(a), Some([w0, w1, w2])) if t > 0.0 && t < 1.0 => {
                let [c0, c1, c2, _] = self.c;
                a.center + ((c2 * t + c1) * t + c0) / ((w2 * t + w1) * t + w0)
            }
            _ => self.seg.eval(t),
        }
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
            let first = self.deriv(t);
            let (second, third) = (self.c[2] * 2.0 + self.c[3] * (6.0 * t), self.c[3] * 6.0);
            let negligible = (VANISHING_DERIVATIVE * self.size) * 10.0;
            if first.hypot() <= negligible {
                let v = if second.hypot() > negligible { second * side } else { third };
                let d = jet.push(v);
                let largest = (jet.dx.hypot2() + jet.dy.hypot2()).sqrt() * v.hypot();
                if d.hypot() > 1e-6 * largest {
                    return d / d.hypot();
                }
            }
        }
        tangent_beside(self, t, side)
    }
}

/// The images of eight points.
#[inline(always)]
pub(super) fn images(map: &dyn Map, points: &[Point; 8]) -> Lanes {
    let mut images = [Point::ORIGIN; 8];
    map.points(points, &mut images);
    Lanes { x: images.map(|p| p.x), y: images.map(|p| p.y) }
}

impl Source for SourceCurve<'_> {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        let j = self.map.jet(self.at(t));
        (j.p, j.push(self.deriv(t)))
    }

    #[inline(always)]
    fn points(&self, t: &Lane, g: &mut Lanes) {
        *g = images(self.map, &self.sampled(t));
    }

    #[inline(always)]
    fn is_simple(&self) -> bool {
        self.degree.is_some()
    }

    fn quotient(&self) -> Option<Quotient> {
        let (degree, rational) = match self.seg {
            Seg::Line(_) => (1, false),
            Seg::Quad(_) => (2, false),
            Seg::Cubic(_) => (3, false),
            // Only in rational form is an arc a quotient of polynomials.
            Seg::Arc(_) => self.w.map(|_| (2, true))?,
        };
        if let Some(map) = self.degree {
            let degree = map.degree * degree;
            let below = if map.rational || rational { degree } else { 0 };
            return Some(Quotient { below, ..Quotient::polynomial(degree) });
        }
        if rational {
            return None;
        }
        let image = self.map.image(&RationalBezier::from_seg(self.seg)?)?;
        let weights = (!image.is_polynomial()).then(|| image.points.iter().map(|p| p[2]).collect::<Vec<_>>());
        let below = if weights.is_some() { image.degree() } else { 0 };
        Some(Quotient { below, weights, ..Quotient::polynomial(image.degree()) })
    }

    /// The denominators of the map, times the segment's denominator to the power of the map's degree.
    fn denominators(&self, t: &Lane) -> Lane {
        let mut out: Lane = self.sampled(t).map(|p| self.map.denominator(p));
        if let Some([w0, w1, w2]) = self.w {
            let power = self.degree.map_or(1, |d| d.degree as i32);
            for (w, t) in out.iter_mut().zip(t) {
                *w *= ((w2 * t + w1) * t + w0).powi(power);
            }
        }
        out
    }

    fn resolved(&self, between: [f64; 2], intervals: usize, tolerance: f64) -> Option<bool> {
        if self.degree.is_some_and(|d| d.degree <= LOW_DEGREE) {
            return Some(true);
        }
        if let (Some(overview), Seg::Line(_) | Seg::Quad(_) | Seg::Cubic(_)) = (self.overview, self.seg) {
            let ([_, c1, c2, c3], [t, h]) = (self.c, [between[0], between[1] - between[0]]);
            let coefficients =
                [(c1 + (c2 * 2.0 + c3 * (3.0 * t)) * t) * h, (c2 + c3 * (3.0 * t)) * (h * h), c3 * (h * h * h)];
            if overview.resolves(self.at(t), coefficients, intervals, HIDDEN * tolerance) {
                return Some(true);
            }
        }
        let along = enclose_segment(self.seg, between.map(|t| self.segment_param(t)));
        if let Some(detail) = self.map.detail(Enclosure::area(&along)) {
            return Some(along[0].d[0].hypot(along[1].d[0]) <= 0.5 * intervals as f64 * detail);
        }
        Some(Enclosure::resolved(&self.map.enclose(along)?, intervals, HIDDEN * tolerance))
    }

    fn place(&self, t: f64) -> Point {
        self.at(t)
    }

    fn end(&self, t: f64) -> Result<BreakPoint, NotFinite> {
        let at = self.at(t);
        let jet = self.map.jet(at);
        if jet.is_finite() { Ok(self.end_with(t, jet.p, &jet)) } else { Err(NotFinite { t, at }) }
    }

    fn announce<'s>(points: &mut dyn Iterator<Item = (&'s Self, Lane)>, ends: &mut dyn Iterator<Item = (&'s Self, f64)>)
    where
        Self: 's,
    {
        let (mut points, mut ends) = (points.peekable(), ends.peekable());
        let first = points.peek().map(|(s, _)| *s).or_else(|| ends.peek().map(|(s, _)| *s));
        let Some(map) = first.map(|s| s.map).filter(|m| m.prefers_batches()) else { return };
        let values: Vec<Point> = points.flat_map(|(s, t)| s.sampled(&t)).collect();
        let jets: Vec<Point> = ends.map(|(s, t)| s.at(t)).collect();
        map.prepare(&values, &jets);
    }
}

/// Returns the segment in the direction in which every copy of it is fitted, and `true` if that is the reverse of the given one.
///
/// Two shapes that share an edge run along it in opposite directions. Fitting one of them and mirroring the result gives
/// both the same curves to the last bit.
#[inline]
pub(super) fn canonical(seg: &Seg) -> (Seg, bool) {
    if is_backwards(seg) { (seg.reversed(), true) } else { (*seg, false) }
}

/// Returns `true` if [`canonical`] reverses the segment.
#[inline]
pub(super) fn is_backwards(seg: &Seg) -> bool {
    let order = match seg {
        Seg::Line(s) => compare(s.p0, s.p1),
        Seg::Quad(s) => compare(s.p0, s.p2),
        Seg::Cubic(s) => compare(s.p0, s.p3).then_with(|| compare(s.p1, s.p2)),
        Seg::Arc(s) => compare(s.p0, s.p1).then_with(|| 0.0f64.total_cmp(&s.sweep)),
    };
    order == Ordering::Greater
}

#[inline]
fn compare(a: Point, b: Point) -> Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outline::EllipticArc;
    use kurbo::CubicBez;

    #[test]
    fn both_directions_have_one_canonical_form() {
        let segs = [
            Seg::Cubic(CubicBez::new((0.0, 0.0), (3.0, 1.0), (2.0, 5.0), (0.0, 0.0))),
            Seg::Cubic(CubicBez::new((5.0, 0.1), (3.0, 1.0), (2.0, 5.0), (0.0, 0.3))),
            Seg::Arc(EllipticArc::new(Point::new(3.0, 4.0), (5.0, 1.0).into(), (0.3, 2.0).into(), 0.7, 1.9)),
            Seg::Arc(EllipticArc::new(
                Point::new(3.0, 4.0),
                (5.0, 1.0).into(),
                (0.3, 2.0).into(),
                0.7,
                -std::f64::consts::TAU,
            )),
        ];
        for s in &segs {
            let (a, fa) = canonical(s);
            let (b, fb) = canonical(&s.reversed());
            assert_eq!(a, b);
            assert_ne!(fa, fb);
        }
    }
}
