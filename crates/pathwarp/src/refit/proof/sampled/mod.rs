//! Proofs from the samples that a fit has taken anyway.
//!
//! Here φ has the slopes at the ends that make D′ vanish there, |g′| / |C′| = Hermite's handle over the actual one, and up to
//! eight more coefficients, by least squares from the foot points:
//!
//! > φ = τ + v·(p₀(1−τ) + p₁τ + v·r(u)),  v = τ(1−τ), u = 2τ−1, p₀ = φ′(0)−1, p₁ = 1−φ′(1)
//!
//! It stays in [0, 1] if its Bernstein coefficients do. With double zeros at both ends D = v²·q, and as D is of a known degree
//! n, q is of degree n−4: sixteen samples determine it up to n = 19 (a cubic under a bicubic map has n = 18), thirty-two up to
//! n = 35.
//!
//! **Basis.** D = Σ cₖBₖ, where Bₖ is v² times the Gegenbauer polynomial of degree k and index 4, divided by its largest value.
//! A Gegenbauer polynomial of index λ oscillates about evenly under the weight (1−u²)^(λ/2), so the Bₖ do, and bounding the tail
//! beyond k by the sum of its coefficients loses little.
//!
//! **Bound.** With L the part of D up to k = d, T = Σ |cₖ| over k > d, and M the largest sample,
//!
//! > sup |D| ≤ sup |L| + T ≤ K(d)·(M + T) + T
//!
//! where K(d) ([`GROWTH`]) is the largest factor by which a polynomial v²·(degree d) can exceed its largest sample. The best d is
//! taken. If the bound is close, L is evaluated on a grid of three times as many places ([`FINE_GROWTH`](expand::FINE_GROWTH)).
//! All that holds for the component of D in any direction, hence for its length.
//!
//! **Denominators.** If g = G/W, V is a polynomial close to 1/W, and VW·D takes the place of D; |VW − 1| is a polynomial known at
//! twenty-four places.
//!
//! **Rounding.** Samples, ends and end slopes are known up to some 1e-14 of the coordinates. The bound grows by at most that
//! times the sum of the coefficients' sensitivities (240 for sixteen samples, 52 for thirty-two), which is added.

mod basis;
mod expand;
mod phi;
mod tables;
#[cfg(test)]
mod tests;

use super::form::RationalForm;
use crate::refit::candidate::Candidate;
use crate::refit::lanes::{Lane, Lanes, fma, largest};
use crate::refit::limits::{MAX_DENOMINATOR_VARIATION, PROOF_ROUNDING, STOPPING_COST};
use crate::refit::samples::UNIT;
use crate::refit::source::SourceCurve;
use expand::{GROWTH, clear, coefficients, difference, supremum};
use kurbo::Point;
use phi::{Phi, through};
use tables::{CLEARING, CLEARING_LESS, FREE, SampleTables};

/// Degrees of D that sixteen and thirty-two samples determine.
const DETERMINED: [usize; 2] = [19, 35];
/// Factor by which a polynomial of degree [`BELOW`] can exceed its largest value at the first twenty-four samples.
const BELOW_GROWTH: f64 = 12.0;
/// Highest degree of VW.
const BELOW: usize = 16;
/// The largest value of τ(1−τ)².
const SLOPE_GROWTH: f64 = 4.0 / 27.0;
/// Rounding of basis functions and of sums of them.
const ARITHMETIC: f64 = 1.0 + 1e-9;

/// Proofs of one candidate. Each returns a bound for the distance between candidate and image, both ways; infinity if none
/// was found. A bound larger than `enough` is no proof, only an indication of how far off one is.
pub(super) struct SampledProof<'a> {
    source: &'a SourceCurve<'a>,
    form: &'a RationalForm,
    c: &'a Candidate,
    /// Images at the fitted and the checked samples, relative to the first point.
    g: [&'a Lanes; 2],
    enough: f64,
    /// The derivative of C∘φ left over at the ends where the image stops and C nearly does.
    left: [f64; 2],
    /// Degree of V.
    clearing: usize,
}

impl<'a> SampledProof<'a> {
    #[inline(always)]
    pub(super) fn new(
        source: &'a SourceCurve<'a>,
        form: &'a RationalForm,
        c: &'a Candidate,
        g: [&'a Lanes; 2],
        enough: f64,
    ) -> Self {
        Self { source, form, c, g, enough, left: [0.0; 2], clearing: CLEARING }
    }

    /// Degree of D, or of VW·D, with φ of degree p.
    #[inline(always)]
    fn degree(&self, p: usize) -> usize {
        let below = self.form.below;
        self.form.degree.max(below + 3 * p) + if below > 0 { self.clearing } else { 0 }
    }

    /// The bound for the Hermite cubic with φ = τ, from sixteen samples.
    pub(super) fn identity(&self) -> Result<f64, Point> {
        let hermite = [self.c.a, self.c.b] == self.c.frame.home;
        if hermite { self.with(&([0.0; 2], []), 1, DETERMINED[0]) } else { Ok(f64::INFINITY) }
    }

    /// The bound from sixteen samples, with approximate foot points.
    pub(super) fn sixteen(&mut self, feet: [&Lane; 2]) -> Result<f64, Point> {
        self.through::<3>(feet, DETERMINED[0])
    }

    /// The bound from thirty-two samples; the foot points should be accurate.
    pub(super) fn thirty_two(&mut self, feet: [&Lane; 2]) -> Result<f64, Point> {
        // If the denominator varies little, a V of low degree leaves room for a φ of higher degree.
        if self.form.below >= 8 {
            self.clearing = CLEARING_LESS;
            let less = self.through::<FREE>(feet, DETERMINED[1])?;
            self.clearing = CLEARING;
            if less <= self.enough {
                return Ok(less);
            }
        }
        self.through::<FREE>(feet, DETERMINED[1])
    }

    #[inline(always)]
    fn through<const F: usize>(&mut self, feet: [&Lane; 2], most: usize) -> Result<f64, Point> {
        // The highest degree of φ that so many samples allow.
        let Some(p) = (5..=F + 3).rev().find(|p| self.degree(*p) <= most) else { return Ok(f64::INFINITY) };
        let [h0, h1] = self.c.frame.home;
        let mut slopes = [h0 / self.c.a, h1 / self.c.b];
        if h0 == 0.0 || h1 == 0.0 {
            self.stopping(feet, &mut slopes);
        }
        match through::<F>(SampleTables::shared(), feet, slopes, p) {
            Some(phi) => self.with(&phi, p, most),
            None => Ok(f64::INFINITY),
        }
    }

    /// If the image stops at an end, D′ vanishes there only if φ′ or C′ does. If C nearly stops too, φ continues as the foot
    /// points do, and the rest of D′ is subtracted as a cubic with that slope.
    #[cold]
    fn stopping(&mut self, feet: [&Lane; 2], slopes: &mut [f64; 2]) {
        let handles = [self.c.a, self.c.b];
        // Parabolas through the first and the last two foot points.
        let along = [2.0 * feet[0][0] - 0.5 * feet[1][0], 2.0 * (1.0 - feet[0][7]) - 0.5 * (1.0 - feet[1][7])];
        for k in 0..2 {
            if self.c.frame.home[k] == 0.0 {
                let left = 3.0 * handles[k] * along[k] / UNIT;
                let slow = along[k] >= 0.0 && left * SLOPE_GROWTH <= STOPPING_COST * self.enough;
                (slopes[k], self.left[k]) = if slow { (along[k] / UNIT, left) } else { (0.0, 0.0) };
            }
        }
    }

    /// Subtracts that cubic from D.
    #[cold]
    fn subtract_slopes(&self, b: usize, d: &mut Lanes) {
        let tables = SampleTables::shared();
        let (t0, t1) = (self.c.frame.t0 * self.left[0], self.c.frame.t1 * self.left[1]);
        for i in 0..8 {
            let (l, r) = (tables.phi[0][b][i], tables.phi[1][b][i]);
            d.x[i] += t0.x * l - t1.x * r;
            d.y[i] += t0.y * l - t1.y * r;
        }
    }

    /// The bound with this φ, of degree p, from samples that determine D up to degree `limit`.
    #[inline(always)]
    fn with<const F: usize>(&self, phi: &Phi<F>, p: usize, limit: usize) -> Result<f64, Point> {
        let tables = SampleTables::shared();
        let c = self.c;
        let n = self.degree(p);
        if n > limit || self.form.below > BELOW - CLEARING {
            return Ok(f64::INFINITY);
        }
        let mut d = [Lanes::default(); 2];
        let [m0, m1] = [0, 1].map(|b| difference(tables, b, c, phi, self.g[b], &mut d[b]));
        let most = (if m0 > m1 { m0 } else { m1 }).sqrt();
        // No bound is lower than the largest sample.
        if most.is_nan() || most > self.enough {
            return Ok(most);
        }
        let noise = noise(self.form, c);
        let left = self.left[0] + self.left[1];
        if left > 0.0 {
            self.subtract_slopes(0, &mut d[0]);
            self.subtract_slopes(1, &mut d[1]);
        }
        let cost = SLOPE_GROWTH * left;
        let few = limit == DETERMINED[0];
        let data = ProofData { proof: self, noise, top: n.max(4) - 4, few, enough: self.enough - cost };
        let most = most + cost;
        let rest = if self.form.below == 0 && few { data.by_sixteen(&d, most) } else { data.by_more(phi, d)? };
        Ok(rest + cost)
    }
}

/// The data of a bound.
struct ProofData<'a> {
    proof: &'a SampledProof<'a>,
    /// Rounding of one sample of D.
    noise: f64,
    /// Degree of q.
    top: usize,
    /// Sixteen samples only.
    few: bool,
    enough: f64,
}

impl ProofData<'_> {
    /// The bound from sixteen samples, the largest of which is `most`.
    #[inline(always)]
    fn by_sixteen(&self, d: &[Lanes; 2], most: f64) -> f64 {
        let top = self.top;
        if let Some(growth) = GROWTH.get(top) {
            let limit = growth * (most * ARITHMETIC + 2.0 * self.noise);
            if limit <= self.enough {
                return limit;
            }
        }
        let mut k = [[0.0; 8]; 4];
        let tables = SampleTables::shared();
        coefficients(&tables.few, d, &mut k);
        let least = supremum(tables, &k, most, self.enough);
        least * ARITHMETIC + self.noise * amplification(tables.few.noise[top / 2][top % 2])
    }

    /// The bound with denominators, or from thirty-two samples.
    #[inline(never)]
    fn by_more<const F: usize>(&self, phi: &Phi<F>, d: [Lanes; 2]) -> Result<f64, Point> {
        let tables = SampleTables::shared();
        let SampledProof { source, form, c, .. } = self.proof;
        let few = self.few;
        let h = c.t1 - c.t0;
        let t = |b: usize| tables.places[b][0].map(|tau| fma(h, tau, c.t0));
        let mut d = [d[0], d[1], Lanes::default(), Lanes::default()];
        if !few {
            for b in [2, 3] {
                let mut g = Lanes::default();
                source.images_into(&t(b), &mut g)?;
                for i in 0..8 {
                    g.x[i] -= c.p0.x;
                    g.y[i] -= c.p0.y;
                }
                difference(tables, b, c, phi, &g, &mut d[b]);
                self.proof.subtract_slopes(b, &mut d[b]);
            }
        }
        let mut off = 0.0;
        if form.below > 0 {
            let mut w = [[1.0; 8]; 4];
            for b in 0..if few { 3 } else { 4 } {
                w[b] = form.denominators(source, &t(b));
            }
            if w.iter().flatten().any(|v| v.is_nan() || *v <= 0.0) {
                return Ok(f64::INFINITY);
            }
            off = BELOW_GROWTH * clear(tables, &mut w, self.proof.clearing);
            if off.is_nan() || off >= MAX_DENOMINATOR_VARIATION {
                return Ok(f64::INFINITY);
            }
            for (d, w) in d.iter_mut().zip(&w) {
                for i in 0..8 {
                    d.x[i] *= w[i];
                    d.y[i] *= w[i];
                }
            }
        }
        let mut squares = [0.0; 8];
        for d in &d {
            for i in 0..8 {
                let v = fma(d.x[i], d.x[i], d.y[i] * d.y[i]);
                squares[i] = if v > squares[i] { v } else { squares[i] };
            }
        }
        let most = largest(&squares).sqrt();
        let share = 1.0 - off;
        let data = ProofData { enough: self.enough * share, noise: self.noise * (1.0 + off), ..*self };
        let limit = if few {
            data.by_sixteen(&[d[0], d[1]], most)
        } else {
            let mut k = [[0.0; 16]; 4];
            coefficients(&tables.many, &d, &mut k);
            let least = supremum(tables, &k, most, data.enough);
            least * ARITHMETIC + data.noise * amplification(tables.many.noise[self.top / 2][self.top % 2])
        };
        Ok(limit / share)
    }
}

/// Factor from the noise of the samples to that of the bound, given that of the coefficients.
#[inline(always)]
fn amplification(coefficients: f64) -> f64 {
    // The tail occurs twice in the bound, and the samples have noise themselves.
    let largest = GROWTH[GROWTH.len() - 1];
    (1.0 + largest) * coefficients + 2.0 * largest
}

/// Rounding of the samples, and of the ends and the slopes there, because of which D's zeros there are not exact. The scale
/// is that of the coordinates and of the length of the whole segment's image, estimated by its speed at the ends.
#[inline(always)]
fn noise(form: &RationalForm, c: &Candidate) -> f64 {
    let speeds = 3.0 * (c.frame.home[0] + c.frame.home[1]) / (c.t1 - c.t0);
    let one = PROOF_ROUNDING * (c.p0.x.abs() + c.p0.y.abs() + c.frame.size + speeds) + form.blur;
    // Its own, and that of the cubic through the ends' errors: one for the place of either end, 4/27 for either slope.
    one * (1.0 + 1.0 + 8.0 / 27.0)
}
