//! Weights that make a Bézier triangle of degree two birational.
//!
//! Let u be barycentric coordinates and Pᵢⱼ the control points in homogeneous coordinates, Pᵢᵢ those of the corners. With weights 1 in
//! the corners, F(u) = Σ uᵢ²·Pᵢᵢ + Σ uᵢuⱼ·cᵢⱼ·Pᵢⱼ (i < j), where cᵢⱼ is twice the weight of Pᵢⱼ. F is birational if its three conics share
//! three points. Then two moving lines Σ uₖ·ℓₖ follow it, and u ~ (ℓ·X) × (ℓ'·X) for X = F(u). A moving line follows F if ℓᵢ·Pᵢᵢ = 0,
//! ℓⱼ·Pᵢᵢ = −cᵢⱼ·ℓᵢ·Pᵢⱼ for i ≠ j, and the terms in u₀u₁u₂ cancel. There are two independent solutions ℓ for two choices of weights. With
//! p, q, r the barycentric coordinates of P₀₁, P₀₂, P₁₂, g = q₀r₁ − q₁r₀ and h = p₀r₂ − p₂r₀, these are, for the two roots σ of
//!
//! > (q₁ + σg)(p₂ + σh) = p₁q₂(1 − σr₀)
//!
//! > c₁₂² = (1 − σr₀)/(r₁r₂),  c₀₂/c₀₁ = c₁₂p₁r₁/(q₁ + σg),  c₀₁² = r₂(q₁ + σg)/(p₁(p₀q₁r₂ + g(p₂ + σh)))
//!
//! A regular net has σ = 2 and the weights 1. Of two solutions, the one with weights nearer to 1 is taken. The corners' weights λᵢ² are
//! free: they multiply cᵢⱼ by λᵢλⱼ.

use super::{coordinates, index};
use crate::map::{Plane, Quotient};
use kurbo::{Point, Rect};

/// The weights of P₀₁, P₀₂ and P₁₂, and the inverse.
pub(super) struct Birational {
    pub(super) weights: [f64; 3],
    pub(super) back: Quotient,
}

/// Returns the weights for a net of six points, by [`index`], over a reference triangle. `lambda` holds the square roots of the
/// corners' weights. `None` if the corners lie on a line, or if no positive weights make the map birational.
pub(super) fn birational(points: &[Point], lambda: [f64; 3], reference: [Point; 3]) -> Option<Birational> {
    let corners = [[2, 0, 0], [0, 2, 0], [0, 0, 2]].map(|k| points[index(k)]);
    let to_coordinates = coordinates(corners);
    let barycentric = |ijk: [usize; 3]| {
        let at = to_coordinates * points[index(ijk)];
        let (b1, b2) = (at.x + 1.0 / 3.0, at.y + 1.0 / 3.0);
        [1.0 - b1 - b2, b1, b2]
    };
    let [[p0, p1, p2], [q0, q1, q2], [r0, r1, r2]] = [[1, 1, 0], [1, 0, 1], [0, 1, 1]].map(barycentric);
    let (g, h) = (q0 * r1 - q1 * r0, p0 * r2 - p2 * r0);
    // The equation for σ is aσ² + bσ + c = 0; the root of larger size comes without cancellation, the other from their product c/a.
    let (a, b, c) = (g * h, q1 * h + p2 * g + p1 * q2 * r0, q1 * p2 - p1 * q2);
    let larger = -0.5 * (b + (b * b - 4.0 * a * c).sqrt().copysign(b));
    let positive = |v: f64| (v > 0.0 && v.is_finite()).then_some(v);
    let solve = |sigma: f64| {
        let (m, square) = (q1 + sigma * g, (1.0 - sigma * r0) / (r1 * r2));
        let c12 = positive(square)?.sqrt();
        let ratio = positive(c12 * p1 * r1 / m)?;
        let c01 = positive(r2 * m / (p1 * (p0 * q1 * r2 + g * (p2 + sigma * h))))?.sqrt();
        let c02 = ratio * c01;
        // The values of ℓᵢ at the corners, for ℓ₀ = 1 at corner 1 and 0 at corner 2, or the reverse.
        let line = |l01: f64, l02: f64| {
            let (l10, l20) = (-c01 * (p1 * l01 + p2 * l02), -c02 * (q2 * l02 + q1 * l01));
            let (l12, l21) = ((square * r1 * l10 - c12 * l20) / sigma, (square * r2 * l20 - c12 * l10) / sigma);
            [[0.0, l01, l02], [l10, 0.0, l12], [l20, l21, 0.0]]
        };
        Some(([c01, c02, c12].map(|c| 0.5 * c), [line(1.0, 0.0), line(0.0, 1.0)]))
    };
    let near_one = |w: &[f64; 3]| w.iter().map(|w| w.ln().powi(2)).sum::<f64>();
    let found = [larger / a, c / larger].into_iter().filter_map(solve);
    let (weights, lines) = found.min_by(|a, b| near_one(&a.0).total_cmp(&near_one(&b.0)))?;
    // A linear form with these values at the corners, by its value and derivatives in the middle, the origin of `coordinates`.
    let form = |[b0, b1, b2]: [f64; 3]| [(b0 + b1 + b2) / 3.0, b1 - b0, b2 - b0];
    let [l, m] = lines.map(|l| l.map(form));
    // u, up to a factor, as the cross product of the two moving lines.
    let u = [(1, 2), (2, 0), (0, 1)]
        .map(|(j, k)| Plane::linear(l[j]).times_linear(m[k]).plus(-1.0, &Plane::linear(l[k]).times_linear(m[j])));
    let sum = |f: &dyn Fn(Point) -> f64| {
        let terms = u.iter().zip(reference).zip(lambda);
        terms.fold(Plane::default(), |sum, ((u, corner), lambda)| sum.plus(f(corner) / lambda, u))
    };
    // The denominator W is positive at the image of the middle of the triangle.
    let w = [1.0, 2.0 * weights[0], 2.0 * weights[1], 1.0, 2.0 * weights[2], 1.0];
    let middle = points.iter().zip(w).map(|(p, w)| p.to_vec2() * w).sum::<kurbo::Vec2>() / w.iter().sum::<f64>();
    let at = to_coordinates * middle.to_point();
    let sign = sum(&|_| 1.0).at(at.x, at.y).signum();
    let origin = reference[0];
    let domain = points.iter().fold(Rect::from_points(points[0], points[0]), |b, p| b.union_pt(*p));
    let [x, y, w] = [sum(&|p| sign * (p.x - origin.x)), sum(&|p| sign * (p.y - origin.y)), sum(&|_| sign)];
    let [l0, l1, l2] = lambda;
    let weights = [weights[0] * l0 * l1, weights[1] * l0 * l2, weights[2] * l1 * l2];
    Some(Birational { weights, back: Quotient::rational(to_coordinates, origin, x, y, w, domain) })
}
