//! The frame of a fit: the chord and the end tangents, which a piece must match.
//!
//! A cubic that shares its ends P₀, P₃ and its unit end tangents T₀, T₁ with the image has two unknowns left, its handle
//! lengths a, b:
//!
//! > C(s) = P₀(B₀+B₁) + P₃(B₂+B₃) + a·T₀·B₁ − b·T₁·B₂
//!
//! Everything here is relative to P₀, so C(0) = 0 and C(1) = q = P₃−P₀.

use super::lanes::{Lane, Lanes, clamp_unit, fma, norm_squared, residual_at};
use kurbo::{CubicBez, Point, Vec2};

/// Chord and end tangents of a piece, and the limits of its handles.
#[derive(Debug, Clone, Copy)]
pub(super) struct ChordFrame {
    /// The chord.
    pub(super) q: Vec2,
    /// Unit tangent at the start.
    pub(super) t0: Vec2,
    /// Unit tangent at the end.
    pub(super) t1: Vec2,
    /// Shortest handles allowed.
    pub(super) floor: [f64; 2],
    /// Scale of the piece: roughly the largest distance of the image from its first point.
    pub(super) size: f64,
    /// Handles of the Hermite cubic, to which the handles are pulled.
    pub(super) home: [f64; 2],
    /// Weight of that pull in the sum of squares; nearly straight pieces leave the handles undetermined.
    pub(super) pull: f64,
}

impl ChordFrame {
    /// The cubic with handles `a`, `b` in the power basis without its constant term: C(s) = ((c₃s + c₂)s + c₁)s.
    #[inline(always)]
    pub(super) fn power(&self, a: f64, b: f64) -> [Vec2; 3] {
        let (u, v) = (self.t0 * (3.0 * a), self.t1 * (3.0 * b));
        [u, self.q * 3.0 - u * 2.0 - v, self.q * -2.0 + u + v]
    }

    /// The cubic in the plane.
    pub(super) fn cubic(&self, p0: Point, p3: Point, a: f64, b: f64) -> CubicBez {
        CubicBez::new(p0, p0 + self.t0 * a, p3 - self.t1 * b, p3)
    }

    /// Moves the foot points by one Newton step. Not inlined: alone, the loop is vectorised.
    #[inline(never)]
    pub(super) fn settle(&self, g: &Lanes, a: f64, b: f64, s: &mut Lane) {
        let c = self.power(a, b);
        for foot in 0..8 {
            let t = s[foot];
            let (rx, ry, dx, dy) = residual_at(&c, t, g.x[foot], g.y[foot]);
            s[foot] = clamp_unit(t - fma(rx, dx, ry * dy) / norm_squared(dx, dy));
        }
    }

    /// Squared distances of the samples from the cubic, after `steps` Newton steps for the foot points. A step that
    /// increases the distance, as happens near a cusp of the cubic, is not taken.
    #[inline(always)]
    pub(super) fn distances(&self, g: &Lanes, a: f64, b: f64, s: &mut Lane, steps: usize) -> Lane {
        let c = self.power(a, b);
        let mut best = [f64::INFINITY; 8];
        let mut next = *s;
        for _ in 0..=steps {
            for i in 0..8 {
                let t = next[i];
                let (rx, ry, dx, dy) = residual_at(&c, t, g.x[i], g.y[i]);
                let d = fma(rx, rx, ry * ry);
                let better = d < best[i];
                best[i] = if better { d } else { best[i] };
                s[i] = if better { t } else { s[i] };
                next[i] = clamp_unit(t - fma(rx, dx, ry * dy) / norm_squared(dx, dy));
            }
        }
        best
    }

    /// The distances whose squares are given, signed by the side of the cubic on which each sample lies.
    #[inline(always)]
    pub(super) fn signed_distances(&self, g: &Lanes, a: f64, b: f64, s: &Lane, squares: &Lane) -> Lane {
        let c = self.power(a, b);
        let mut out = [0.0; 8];
        for i in 0..8 {
            let (rx, ry, dx, dy) = residual_at(&c, s[i], g.x[i], g.y[i]);
            out[i] = squares[i].sqrt().copysign(fma(rx, dy, -(ry * dx)));
        }
        out
    }

    /// The second handle with which a cubic of first handle `to` has the same area as the one with handles `a`, `b`.
    pub(super) fn slide(&self, a: f64, b: f64, to: f64) -> f64 {
        let k2 = 0.5 * self.t1.cross(self.t0);
        let (k0, k1) = (self.q.cross(self.t0), self.t1.cross(self.q));
        (k0 * a + k1 * b - k2 * a * b - k0 * to) / (k1 - k2 * to)
    }
}
