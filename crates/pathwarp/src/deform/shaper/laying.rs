//! The eight ways to lay the corners of a base on those of a cage, and the one that distorts least.
//!
//! A way is judged by the best similitude from the base's corners to the cage's, without reflection: with both sets about their
//! means as complex numbers bᵢ and cᵢ, what the similitude leaves over is √(1 − |Σ b̄ᵢcᵢ|² ÷ (Σ|bᵢ|² Σ|cᵢ|²)) of the cage's size.

use crate::anchors::Arrangement;
use kurbo::{Point, Vec2};

/// Ways whose distortions differ by less than this tie: artwork and cages up to about 1.3 times as wide as high, or as high as
/// wide, are not turned on their sides.
const TIE: f64 = 0.25;

/// One way to lay base on cage.
pub(super) struct Way {
    pub(super) arrangement: Arrangement,
    /// Distance from the best similitude as a share of the cage's size: 0 to 1.
    pub(super) distortion: f64,
    /// Angle by which that similitude turns, −180° to 180°, clockwise on the screen.
    pub(super) turn: f64,
}

impl Way {
    /// Judges an arrangement of the cage's corners for a base: bottom left, bottom right, then on around.
    pub(super) fn new(base: &[Point; 4], cage: &[Point; 4], arrangement: Arrangement) -> Self {
        let order = arrangement.order();
        let (b, c) = (centred(*base), centred(order.map(|i| cage[i])));
        let sum = b.iter().zip(&c).fold(Vec2::ZERO, |s, (b, c)| s + Vec2::new(b.dot(*c), b.cross(*c)));
        let size = |v: &[Vec2; 4]| v.iter().map(|p| p.hypot2()).sum::<f64>();
        let kept = sum.hypot2() / (size(&b) * size(&c));
        Self { arrangement, distortion: (1.0 - kept).max(0.0).sqrt(), turn: sum.angle().to_degrees() }
    }

    /// The way that distorts least; among ties `lowest`, or else the one that turns least. Ways that mirror the artwork, which
    /// hardly distorts a narrow box, are left out.
    pub(super) fn least(base: &[Point; 4], cage: &[Point; 4], lowest: Arrangement) -> Self {
        let by_rule = Self::new(base, cage, lowest);
        let all = (0..8).map(|i| Self::new(base, cage, Arrangement { bottom: i % 4, reversed: i >= 4 }));
        let mirrors = |w: &Self| area(base) * area(&w.arrangement.order().map(|i| cage[i])) < 0.0;
        let all: Vec<Self> = all.filter(|w| !mirrors(w)).collect();
        let least = all.iter().map(|w| w.distortion).fold(by_rule.distortion, f64::min);
        let ties = |w: &Self| w.distortion < least + TIE;
        if ties(&by_rule) {
            return by_rule;
        }
        all.into_iter().filter(ties).min_by(|a, b| a.turn.abs().total_cmp(&b.turn.abs())).unwrap_or(by_rule)
    }
}

/// The signed area of a quadrilateral.
fn area(q: &[Point; 4]) -> f64 {
    0.5 * (q[2] - q[0]).cross(q[3] - q[1])
}

fn centred(points: [Point; 4]) -> [Vec2; 4] {
    let mean = points.iter().fold(Vec2::ZERO, |sum, p| sum + p.to_vec2()) / 4.0;
    points.map(|p| p.to_vec2() - mean)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box of this width and height, turned clockwise: bottom left, bottom right, top right, top left.
    fn turned(width: f64, height: f64, degrees: f64) -> [Point; 4] {
        let corners = [(-width, height), (width, height), (width, -height), (-width, -height)];
        let (sin, cos) = degrees.to_radians().sin_cos();
        corners.map(|(x, y)| Point::new(7.0 + x * cos - y * sin, -3.0 + x * sin + y * cos))
    }

    #[test]
    fn similar_cages_are_not_distorted_however_they_lie() {
        for (width, degrees) in [4.0, 10.0].iter().flat_map(|w| (-89..=89).map(move |d| (*w, f64::from(d)))) {
            let (base, cage) = (turned(width, 1.0, 0.0), turned(3.0 * width, 3.0, degrees));
            // As drawn from any corner, in either direction.
            for start in 0..8 {
                let drawn: [Point; 4] =
                    std::array::from_fn(|i| cage[(if start < 4 { start + i } else { start + 4 - i }) % 4]);
                let heights = std::array::from_fn(|i| 0.5 * (drawn[i].y + drawn[(i + 1) % 4].y));
                let way = Way::least(&base, &drawn, Arrangement::by_rule(&drawn, &heights));
                assert!(way.distortion < 1e-7, "{width}:1 by {degrees}°, from {start}: {}", way.distortion);
                assert!((way.turn - degrees).abs() < 1e-6, "{width}:1 by {degrees}°, from {start}: {}", way.turn);
            }
        }
    }

    #[test]
    fn near_squares_follow_the_rule() {
        for (w, h) in [(1.25, 1.0), (1.0, 1.25), (1.0, 1.0)] {
            let (base, cage) = (turned(w, h, 0.0), turned(1.0, 1.0, 20.0));
            let heights = std::array::from_fn(|i| 0.5 * (cage[i].y + cage[(i + 1) % 4].y));
            let rule = Arrangement::by_rule(&cage, &heights);
            let (bottom, reversed) = (rule.bottom, rule.reversed);
            let way = Way::least(&base, &cage, rule);
            assert_eq!((way.arrangement.bottom, way.arrangement.reversed), (bottom, reversed));
        }
    }

    #[test]
    fn reflections_are_the_worst() {
        let base = turned(2.0, 1.0, 0.0);
        let way = |bottom, reversed| Way::new(&base, &base, Arrangement { bottom, reversed }).distortion;
        assert!(way(0, false) < 1e-7 && way(2, false) < 1e-7);
        // Σ|b|² = 5, and the mirror image leaves 4 − 1 of it: √(1 − (3/5)²).
        assert!((way(0, true) - 0.8).abs() < 1e-12, "{}", way(0, true));
        // On its side: 4 of 5 remain.
        assert!((way(1, false) - 0.6).abs() < 1e-12, "{}", way(1, false));
    }
}
