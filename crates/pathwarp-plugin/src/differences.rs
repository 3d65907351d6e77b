//! Derivatives by differences, for programs that give values only.
//!
//! Central differences D(h) = (F(p + h) − F(p − h))/2h have an error c₂h² + c₄h⁴ + …; Richardson's extrapolation
//! (4·D(h/2) − D(h))/3 removes the first term (L. F. Richardson 1911). The correction |D(h/2) − D(h)|/3 bounds what is left, up to
//! the rounding error ε|F|/h. If that is too much, smaller steps are tried, and the result with the least estimate is taken.

use pathwarp::kurbo::{Point, Vec2};
use pathwarp::map::Jet;

/// Steps, as shares of the frame's diagonal. The first one is best for maps that bend a few times across the frame: the error is
/// 10⁻¹² there by either term. The others are for waves of a hundredth of the frame, and of a thousandth.
const STEPS: [f64; 3] = [1e-3, 1e-4, 1e-5];

/// An estimate of the relative error that is good enough. Where the third derivative happens to be small, the error is a few tens
/// of times the estimate; a tangent needs half as many digits.
const GOOD: f64 = 3e-11;

/// Values at a point's four neighbours at the whole step, then at half of it.
const STENCIL: [(f64, f64); 8] =
    [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (0.5, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.0, -0.5)];

/// The jets at `ps`, from a function that gives the values at many points. `size` is the frame's diagonal.
pub(crate) fn jets(ps: &[Point], size: f64, values: impl Fn(&[Point], &mut [Point])) -> Vec<Jet> {
    let mut out: Vec<Jet> = vec![Jet::UNDEFINED; ps.len()];
    let mut least = vec![f64::INFINITY; ps.len()];
    let mut left: Vec<usize> = (0..ps.len()).collect();
    for (round, share) in STEPS.into_iter().enumerate() {
        if left.is_empty() {
            break;
        }
        let mut asked = Vec::with_capacity(9 * left.len());
        for p in left.iter().filter_map(|i| ps.get(*i)) {
            let h = step(*p, share * size);
            if round == 0 {
                asked.push(*p);
            }
            asked.extend(STENCIL.iter().map(|(x, y)| *p + Vec2::new(x * h, y * h)));
        }
        let mut images = vec![Point::ORIGIN; asked.len()];
        values(&asked, &mut images);
        let each = STENCIL.len() + usize::from(round == 0);
        let mut again = Vec::new();
        for ((i, places), images) in left.iter().zip(asked.chunks_exact(each)).zip(images.chunks_exact(each)) {
            let (Some(jet), Some(least)) = (out.get_mut(*i), least.get_mut(*i)) else { continue };
            let (mut places, mut images) = (places, images);
            if round == 0 {
                jet.p = images[0];
                (places, images) = (&places[1..], &images[1..]);
            }
            let ((dx, x_off), (dy, y_off)) = (slope(places, images, 0), slope(places, images, 2));
            let rounding = f64::EPSILON * jet.p.to_vec2().hypot() / (0.5 * (places[0] - places[1]).hypot());
            let (scale, off) = (dx.hypot().max(dy.hypot()), x_off.max(y_off) + rounding);
            if off < *least || !least.is_finite() {
                (jet.dx, jet.dy, *least) = (dx, dy, off);
            }
            // An estimate that is not a number, at the edge of a domain, may become one at a smaller step.
            if off.is_nan() || off > GOOD * scale.max(f64::MIN_POSITIVE) {
                again.push(*i);
            }
        }
        left = again;
    }
    out
}

/// A power of two near `h`, so that p ± h is exact more often; larger where coordinates are.
fn step(p: Point, h: f64) -> f64 {
    /// Smallest step as a share of the coordinates, which have 53 bits.
    const FINEST: f64 = 1e-8;
    let least = FINEST * p.x.abs().max(p.y.abs());
    h.max(least).max(f64::MIN_POSITIVE).log2().round().exp2()
}

/// The extrapolated slope along one axis, which has the places `k` and `k` + 4 of the stencil, with the estimate of its error.
fn slope(places: &[Point], images: &[Point], k: usize) -> (Vec2, f64) {
    let central = |k: usize| (images[k] - images[k + 1]) / (places[k] - places[k + 1]).hypot();
    let (whole, half) = (central(k), central(k + 4));
    let correction = (half - whole) / 3.0;
    // Of the fourth order, after a correction of the second: its square, relative to the slope.
    let size = half.hypot().max(f64::MIN_POSITIVE);
    let off = correction.hypot() * (correction.hypot() / size).min(1.0);
    (half + correction, off)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Waves from a tenth of the frame to a thousandth: exact to the digits that their steps can have.
    #[test]
    fn the_error_is_under_control() {
        for (length, most) in [(300.0, 1e-10), (10.0, 1e-9), (1.0, 1e-7), (0.1, 1e-6)] {
            let k = std::f64::consts::TAU / length;
            let f = |p: Point| Point::new(p.x + (k * p.y).sin() / k, p.y * 2.0 + 0.5 * (k * p.x).cos() / k);
            let ps: Vec<Point> = (0..50).map(|i| Point::new(3.7 * f64::from(i), 90.0 - 1.9 * f64::from(i))).collect();
            let found = jets(&ps, 100.0, |ps, out| {
                for (p, o) in ps.iter().zip(out) {
                    *o = f(*p);
                }
            });
            for (p, j) in ps.iter().zip(&found) {
                assert_eq!(j.p, f(*p));
                let (dx, dy) = (Vec2::new(1.0, -0.5 * (k * p.x).sin()), Vec2::new((k * p.y).cos(), 2.0));
                let off = (j.dx - dx).hypot().max((j.dy - dy).hypot());
                assert!(off < most, "{length}: {off:e} at {p}");
            }
        }
    }

    #[test]
    fn outside_of_the_domain_the_jet_is_undefined() {
        let found = jets(&[Point::new(1.0, 1.0)], 1.0, |_, out| out.fill(Point::new(f64::NAN, f64::NAN)));
        assert!(found[0].p.is_nan() && found[0].dx.is_nan());
    }
}
