//! Elliptical arcs in the form that affine maps preserve: a center and two conjugate semi-axes.
//!
//! > P(θ) = c + cos θ · a + sin θ · b
//!
//! If a ⟂ b, these are the principal axes of the ellipse. An affine map takes c, a and b to their images and keeps θ, so nested SVG
//! transforms lose no accuracy.

use kurbo::{Affine, CubicBez, Point, Rect, Vec2};
use std::f64::consts::{PI, TAU};

/// An arc of an ellipse, parametrised over `t` in [0, 1] at constant angular speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EllipticArc {
    /// The first point, stored beside the ellipse so that neighbours meet to the last bit.
    pub p0: Point,
    /// The last point.
    pub p1: Point,
    /// The center of the ellipse.
    pub center: Point,
    /// The first conjugate semi-axis.
    pub a: Vec2,
    /// The second conjugate semi-axis.
    pub b: Vec2,
    /// The angle of the first point, in radians.
    pub start: f64,
    /// The angle swept, in radians, positive from `a` to `b`.
    pub sweep: f64,
}

impl EllipticArc {
    /// Creates the arc of an ellipse from the angle `start` over the angle `sweep`, in radians.
    #[must_use]
    pub fn new(center: Point, a: Vec2, b: Vec2, start: f64, sweep: f64) -> Self {
        let (start, sweep) = (on_grid(start), on_grid(sweep));
        let at = |th: f64| center + a * th.cos() + b * th.sin();
        let p0 = at(start);
        // A full turn closes exactly.
        let p1 = if (sweep.abs() - TAU).abs() < 1e-14 { p0 } else { at(start + sweep) };
        Self { p0, p1, center, a, b, start, sweep }
    }

    /// Creates the arc of SVG's `A` command, converted as in the SVG 2 specification, §B.2.4 and §B.2.5, whose equations have the numbers
    /// B.5.x. `None` if the command draws a straight line (a zero radius) or nothing (coincident ends).
    #[must_use]
    pub fn from_svg(
        p0: Point,
        radii: Vec2,
        x_rotation_degrees: f64,
        large: bool,
        sweep: bool,
        p1: Point,
    ) -> Option<Self> {
        // The computation starts at the lexicographically smaller end, so that arcs drawn from either end are equal to the last bit.
        if (p0.x, p0.y) > (p1.x, p1.y) {
            return Self::from_svg(p1, radii, x_rotation_degrees, large, !sweep, p0).map(|a| a.reversed());
        }
        let (mut rx, mut ry) = (radii.x.abs(), radii.y.abs());
        if p0 == p1 || rx == 0.0 || ry == 0.0 || !(rx * ry * x_rotation_degrees).is_finite() {
            return None;
        }
        let (sin, cos) = x_rotation_degrees.to_radians().sin_cos();
        // (B.5.1) half the chord, in the axes of the ellipse
        let h = (p0 - p1) / 2.0;
        let (x1, y1) = (cos * h.x + sin * h.y, cos * h.y - sin * h.x);
        // (B.5.8) radii that are too small to reach both ends are scaled up
        let lambda = (x1 / rx).powi(2) + (y1 / ry).powi(2);
        if lambda > 1.0 {
            rx *= lambda.sqrt();
            ry *= lambda.sqrt();
        }
        // (B.5.2) the center, in terms of the normalised chord so that tiny or huge radii do not overflow
        let (u, v) = (x1 / rx, y1 / ry);
        let d = u * u + v * v;
        let k = ((1.0 - d).max(0.0) / d).sqrt() * if large == sweep { -1.0 } else { 1.0 };
        let (cu, cv) = (k * v, -k * u);
        let mid = p0.midpoint(p1);
        let center = mid + Vec2::new(cos * rx * cu - sin * ry * cv, sin * rx * cu + cos * ry * cv);
        // (B.5.5), (B.5.6) the angles
        let th0 = (v - cv).atan2(u - cu);
        let th1 = (-v - cv).atan2(-u - cu);
        let mut delta = (th1 - th0).rem_euclid(TAU);
        if !sweep {
            delta -= TAU;
        }
        // The ends differ, so a sweep near 0 or a full turn is a rounding error. If the radii were scaled up, it is a half turn.
        if delta.abs() < 1e-12 || (delta.abs() - TAU).abs() < 1e-12 {
            delta = if lambda >= 1.0 { PI.copysign(delta) } else { return None };
        }
        let (a, b) = (Vec2::new(cos * rx, sin * rx), Vec2::new(-sin * ry, cos * ry));
        Some(Self { p0, p1, center, a, b, start: on_grid(th0), sweep: on_grid(delta) })
    }

    /// Returns the circular arc that a cubic approximates, if its handles are within `near` of the usual approximation's. `None` for other
    /// cubics, and for arcs of more than 135°.
    #[must_use]
    pub fn of_cubic(c: &CubicBez, near: f64) -> Option<Self> {
        let (u, v, chord) = (c.p1 - c.p0, c.p3 - c.p2, c.p3 - c.p0);
        let sweep = u.cross(v).atan2(u.dot(v));
        if !(1e-3..=0.75 * PI).contains(&sweep.abs()) {
            return None;
        }
        let radius = chord.hypot() / (2.0 * (0.5 * sweep).sin().abs());
        let across = Vec2::new(-chord.y, chord.x).normalize() * sweep.signum();
        let center = c.p0.midpoint(c.p3) + across * (radius * (0.5 * sweep).cos());
        let (a, b) = (Vec2::new(radius, 0.0), Vec2::new(0.0, radius));
        let arc = Self { p0: c.p0, p1: c.p3, ..Self::new(center, a, b, (c.p0 - center).angle(), sweep) };
        let usual = arc.to_cubic();
        (usual.p1.distance(c.p1) <= near && usual.p2.distance(c.p2) <= near).then_some(arc)
    }

    /// Returns `true` for an arc of a circle, up to rounding.
    #[must_use]
    pub fn is_circular(&self) -> bool {
        /// Allowance for rounding, as a share of a radius.
        const SLACK: f64 = 1e-6;
        let (size, slack) = (self.a.hypot(), SLACK * self.a.hypot());
        (size - self.b.hypot()).abs() <= slack && self.a.dot(self.b).abs() <= slack * size
    }

    /// Returns the point at `t` in [0, 1]. The ends are exact.
    #[inline]
    #[must_use]
    pub fn eval(&self, t: f64) -> Point {
        if t == 0.0 || t == 1.0 {
            return if t == 0.0 { self.p0 } else { self.p1 };
        }
        let (s, c) = (self.start + t * self.sweep).sin_cos();
        self.center + self.a * c + self.b * s
    }

    /// Returns the derivative with respect to `t`.
    #[inline]
    #[must_use]
    pub fn deriv(&self, t: f64) -> Vec2 {
        let (s, c) = (self.start + t * self.sweep).sin_cos();
        (self.b * c - self.a * s) * self.sweep
    }

    /// Returns the arc in the opposite direction.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self { p0: self.p1, p1: self.p0, start: self.start + self.sweep, sweep: -self.sweep, ..*self }
    }

    /// Returns the exact image under an affine map.
    #[must_use]
    pub fn transformed(&self, m: Affine) -> Self {
        let [k0, k1, k2, k3, ..] = m.as_coeffs();
        let [a, b] = [self.a, self.b].map(|v| Vec2::new(k0 * v.x + k2 * v.y, k1 * v.x + k3 * v.y));
        let [p0, p1, center] = [self.p0, self.p1, self.center].map(|p| m * p);
        Self { p0, p1, center, a, b, ..*self }
    }

    /// Returns half the width and height of the whole ellipse.
    pub(super) fn half_size(&self) -> Vec2 {
        Vec2::new(self.a.x.hypot(self.b.x), self.a.y.hypot(self.b.y))
    }

    /// Returns the bounding box.
    #[must_use]
    pub fn bounding_box(&self) -> Rect {
        let mut r = Rect::from_points(self.p0, self.p1);
        // x is extreme where −a.x sin θ + b.x cos θ = 0, at two angles half a turn apart; likewise y.
        for extreme in [self.b.x.atan2(self.a.x), self.b.y.atan2(self.a.y)] {
            for th in [extreme, extreme + PI] {
                let ahead = if self.sweep >= 0.0 { th - self.start } else { self.start - th }.rem_euclid(TAU);
                if ahead <= self.sweep.abs() {
                    r = r.union_pt(self.center + self.a * th.cos() + self.b * th.sin());
                }
            }
        }
        r
    }

    /// Returns the part between `t0` and `t1`.
    #[must_use]
    pub fn subsegment(&self, t0: f64, t1: f64) -> Self {
        let (start, sweep) = (self.start + t0 * self.sweep, (t1 - t0) * self.sweep);
        Self { p0: self.eval(t0), p1: self.eval(t1), start, sweep, ..*self }
    }

    /// Returns the cubic with the end points and end tangents of the arc, and handles of (4/3)·tan(Δ/4) for the sweep Δ. It is close
    /// for sweeps up to about a quarter turn.
    #[must_use]
    pub fn to_cubic(&self) -> CubicBez {
        // Clamped because the tangent has a pole at a full turn. `to_cubics` cuts such arcs.
        let k = 4.0 / 3.0 * (self.sweep.clamp(-PI, PI) / 4.0).tan() / self.sweep;
        let (d0, d1) = (self.deriv(0.0), self.deriv(1.0));
        CubicBez::new(self.p0, self.p0 + d0 * k, self.p1 - d1 * k, self.p1)
    }

    /// Returns the major semi-axis of the ellipse, the larger singular value of the matrix (a b).
    #[must_use]
    pub fn major(&self) -> f64 {
        let (aa, bb, ab) = (self.a.hypot2(), self.b.hypot2(), self.a.dot(self.b));
        (0.5 * (aa + bb) + (0.5 * (aa - bb)).hypot(ab)).sqrt()
    }

    /// Returns a bound for the distance between the arc and `n` cubics for equal parts of it. A cubic for the sweep φ deviates from the
    /// unit circle by (2/27)·sin⁶(φ/4)/cos²(φ/4) (Goldapp, *Approximation of circular arcs by cubic polynomials*, 1991), and from an
    /// affine image of the circle by at most the major semi-axis times that.
    #[must_use]
    pub(crate) fn cubics_error(&self, n: usize) -> f64 {
        let (s, c) = (self.sweep / n as f64 / 4.0).sin_cos();
        ((2.0 / 27.0 * s.powi(6)) / (c * c)) * self.major()
    }

    /// Returns the number of cubics that stay within `tolerance` of the arc, at least one per quarter turn.
    #[must_use]
    pub(crate) fn cubics_needed(&self, tolerance: f64) -> usize {
        /// Limit on cubics, enough for an error of 1e-16 of the radius.
        const MAX_CUBICS: usize = 1000;
        let mut n = ((self.sweep.abs() / (PI / 2.0) - 1e-9).ceil().max(1.0) as usize).min(MAX_CUBICS);
        while n < MAX_CUBICS && self.cubics_error(n) > tolerance {
            n += 1;
        }
        n
    }

    /// Returns cubics within `tolerance` of the arc.
    pub fn to_cubics(&self, tolerance: f64) -> impl Iterator<Item = CubicBez> + '_ {
        let n = self.cubics_needed(tolerance);
        (0..n).map(move |i| self.subsegment(i as f64 / n as f64, (i + 1) as f64 / n as f64).to_cubic())
    }

    /// Returns `true` if every coordinate is below `limit` in magnitude.
    pub(super) fn is_within(&self, limit: f64) -> bool {
        let points = [self.p0, self.p1, self.center, self.a.to_point(), self.b.to_point()];
        points.iter().all(|p| p.x.abs() < limit && p.y.abs() < limit)
    }
}

/// Rounds an angle to a multiple of 2⁻⁴⁸ (3.6e-15, a few times the rounding of a full turn). Sums of such angles are exact, so that
/// an arc reversed twice is the same to the last bit.
fn on_grid(angle: f64) -> f64 {
    const PER_RADIAN: f64 = (1u64 << 48) as f64;
    (angle * PER_RADIAN).round() / PER_RADIAN
}

#[cfg(test)]
mod tests {
    use super::*;

    fn svg(p0: (f64, f64), r: (f64, f64), rot: f64, large: bool, sweep: bool, p1: (f64, f64)) -> EllipticArc {
        EllipticArc::from_svg(p0.into(), r.into(), rot, large, sweep, p1.into()).unwrap()
    }

    #[test]
    fn cubics_that_approximate_circles_are_told_from_others() {
        for sweep in [0.3, -1.2, PI / 2.0, -PI / 2.0, 2.0] {
            let arc = EllipticArc::new(Point::new(5.0, -2.0), Vec2::new(9.0, 0.0), Vec2::new(0.0, 9.0), 0.7, sweep);
            let mut c = arc.to_cubic();
            let found = EllipticArc::of_cubic(&c, 1e-6).unwrap();
            assert!(found.center.distance(arc.center) + (found.sweep - sweep).abs() < 1e-9, "{found:?}");
            c.p1 += Vec2::new(2e-3, 0.0);
            assert_eq!(EllipticArc::of_cubic(&c, 1e-3), None);
        }
        let line = CubicBez::new((0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0));
        let swing = CubicBez::new((0.0, 0.0), (1.0, 1.0), (2.0, -1.0), (3.0, 0.0));
        assert_eq!([line, swing].map(|c| EllipticArc::of_cubic(&c, 1e-3)), [None; 2]);
    }

    #[test]
    fn endpoint_form_agrees_with_its_ends_and_flags() {
        for large in [false, true] {
            for sweep in [false, true] {
                let a = svg((10.0, 20.0), (30.0, 15.0), 25.0, large, sweep, (42.0, 27.0));
                for (t, p) in [(1e-9, a.p0), (1.0 - 1e-9, a.p1)] {
                    assert!(a.eval(t).distance(p) < 1e-6, "{large} {sweep} {t}: {:?}", a.eval(t));
                }
                assert_eq!(a.sweep > 0.0, sweep);
                assert_eq!(a.sweep.abs() > PI, large);
            }
        }
    }

    #[test]
    fn radii_too_small_give_a_half_ellipse_about_the_middle() {
        let a = svg((0.0, 0.0), (1.0, 1.0), 0.0, false, true, (10.0, 0.0));
        assert!((a.sweep - PI).abs() < 1e-9);
        assert!(a.center.distance(Point::new(5.0, 0.0)) < 1e-12);
        assert!(a.eval(0.5).distance(Point::new(5.0, -5.0)) < 1e-12);
    }

    #[test]
    fn affine_images_are_exact_and_the_derivative_is_the_difference_quotient() {
        let m = Affine::new([1.3, 0.4, -0.7, 0.9, 5.0, -3.0]);
        let a = svg((10.0, 20.0), (30.0, 15.0), 25.0, true, false, (42.0, 27.0));
        let b = a.transformed(m);
        for i in 0..=16 {
            let t = f64::from(i) / 16.0;
            assert!(b.eval(t).distance(m * a.eval(t)) < 1e-12);
            let h = 1e-6;
            let slope = (a.eval(t + h) - a.eval(t - h)) / (2.0 * h);
            if i > 0 && i < 16 {
                assert!((slope - a.deriv(t)).hypot() < 1e-6);
            }
            assert!(a.bounding_box().inflate(1e-9, 1e-9).contains(a.eval(t)));
        }
    }

    #[test]
    fn the_stated_error_is_the_true_one() {
        for (sweep, n) in [(TAU, 4), (PI / 2.0, 1), (2.0, 1), (TAU, 7)] {
            let a = EllipticArc::new(Point::ORIGIN, Vec2::new(60.0, 80.0), Vec2::new(-80.0, 60.0), 0.3, sweep);
            let cubics =
                (0..n).map(|i| a.subsegment(f64::from(i) / f64::from(n), f64::from(i + 1) / f64::from(n)).to_cubic());
            let worst = cubics
                .flat_map(|c| (0..=2000).map(move |i| kurbo::ParamCurve::eval(&c, f64::from(i) / 2000.0)))
                .map(|p| (p.to_vec2().hypot() - 100.0).abs())
                .fold(0.0, f64::max);
            let stated = a.cubics_error(n as usize);
            assert!(worst <= stated * (1.0 + 1e-6) && worst > 0.98 * stated, "{sweep}/{n}: {worst} {stated}");
        }
    }

    #[test]
    fn cubics_stay_within_the_tolerance() {
        let a = EllipticArc::new(Point::ORIGIN, Vec2::new(100.0, 0.0), Vec2::new(0.0, 100.0), 0.3, TAU);
        for tol in [1.0, 0.1, 1e-3, 1e-6] {
            let worst = a
                .to_cubics(tol)
                .flat_map(|c| (0..=50).map(move |i| kurbo::ParamCurve::eval(&c, f64::from(i) / 50.0)))
                .map(|p| (p.to_vec2().hypot() - 100.0).abs())
                .fold(0.0, f64::max);
            assert!(worst <= tol, "{tol}: {worst}");
        }
    }
}
