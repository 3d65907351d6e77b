//! The image of a segment as a quotient of polynomials: degrees and denominators.

use crate::map::{RationalBezier, RationalDegree};
use crate::refit::lanes::Lane;
use crate::refit::source::SourceCurve;

/// Chebyshev nodes of the longest proof: more than the degree of D for a bicubic map of a cubic (max(18, 3·9)) and for a
/// rational map of degree 4 (12 + 27 + 5), enough for the bound to lose little.
pub(super) const NODES: usize = 48;
/// Coefficients of its p (see [`nodes`](super::nodes)), and of its V.
pub(super) const PHI: usize = 8;
pub(super) const CLEARING: usize = 6;

/// A segment's image as a quotient of polynomials.
#[derive(Debug, Clone)]
pub(in crate::refit) struct RationalForm {
    /// Degree of numerators and denominator in the segment's parameter.
    pub(super) degree: usize,
    /// Degree of the denominator; 0 if there is none.
    pub(super) below: usize,
    /// Bernstein coefficients of the denominator, if the map provides them.
    weights: Option<Vec<f64>>,
    /// Degree of the map: the power to which the source's own denominator occurs.
    power: i32,
    /// Distance of the pieces' ends from the image, if larger than rounding.
    pub(super) blur: f64,
}

impl RationalForm {
    /// `map` is the degree that the source's map declares. `None` if the image is not known to be a quotient of polynomials
    /// of sufficiently low degree: it can only be checked.
    pub(in crate::refit) fn new(source: &SourceCurve<'_>, map: Option<RationalDegree>) -> Option<Self> {
        let (degree, rational) = source.degree()?;
        let out = if let Some(a) = map {
            let below = if a.rational || rational { a.degree * degree } else { 0 };
            Self { degree: a.degree * degree, below, weights: None, power: a.degree as i32, blur: 0.0 }
        } else {
            if rational {
                return None;
            }
            let image = source.map.image(&RationalBezier::from_seg(source.seg)?)?;
            let n = image.degree();
            let weights = (!image.is_polynomial()).then(|| image.points.iter().map(|p| p[2]).collect::<Vec<_>>());
            Self { degree: n, below: if weights.is_some() { n } else { 0 }, weights, power: 1, blur: 0.0 }
        };
        (out.total(PHI, CLEARING) < NODES && out.below + CLEARING - 1 < NODES).then_some(out)
    }

    /// For pieces whose ends may be that far from the image.
    pub(in crate::refit) fn with_blur(self, blur: f64) -> Self {
        Self { blur, ..self }
    }

    /// Degree of D, or of F: at most that of VW·C∘φ, with `p` coefficients of φ's p and `v` of V.
    pub(super) fn total(&self, p: usize, v: usize) -> usize {
        let composed = 3 * (p + 1);
        if self.below > 0 { (self.below + composed).max(self.degree) + v - 1 } else { self.degree.max(composed) }
    }

    /// The denominators at eight parameters.
    pub(super) fn denominators(&self, source: &SourceCurve<'_>, t: &Lane) -> Lane {
        match &self.weights {
            Some(w) => bernstein(w, t),
            None => source.denominators(t, &source.points(t), self.power),
        }
    }
}

/// The Bernstein polynomial with coefficients `b` at eight parameters.
fn bernstein(b: &[f64], t: &Lane) -> Lane {
    let n = b.len() - 1;
    let mut out = [0.0; 8];
    for i in 0..8 {
        // Horner's scheme in s/(1−s) or its inverse, whichever is at most one.
        let flip = t[i] > 0.5;
        let (s, u) = if flip { (1.0 - t[i], t[i]) } else { (t[i], 1.0 - t[i]) };
        let r = s / u;
        let (mut sum, mut choose) = (0.0, 1.0);
        let mut power = u.powi(n as i32);
        for k in 0..=n {
            let c = if flip { b[n - k] } else { b[k] };
            sum += choose * power * c;
            power *= r;
            choose *= (n - k) as f64 / (k + 1) as f64;
        }
        out[i] = sum;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bernstein_sums_are_right_in_both_halves() {
        // Coefficients k/n give the identity.
        let b: Vec<f64> = (0..=7).map(|k| f64::from(k) / 7.0).collect();
        let t = [0.0, 0.1, 0.3, 0.5, 0.6, 0.8, 0.99, 1.0];
        for (v, t) in bernstein(&b, &t).iter().zip(t) {
            assert!((v - t).abs() < 1e-14);
        }
    }
}
