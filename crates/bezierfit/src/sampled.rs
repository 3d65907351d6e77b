//! Proofs that a cubic C lies within a distance of the image g, from the samples that a fit has taken anyway.
//!
//! The module `proof` explains the method: a bound for the polynomial D = g − C∘φ bounds the distance. Here φ has the
//! end slopes that make D′ vanish there, namely Hermite's handle over the actual one, and up to eight more coefficients, by least
//! squares from the foot points:
//!
//! > φ = τ + v·(p₀(1−τ) + p₁τ + v·r(u)),  v = τ(1−τ), u = 2τ−1, p₀ = φ′(0)−1, p₁ = 1−φ′(1)
//!
//! φ stays in [0, 1] if its Bernstein coefficients do. As D has double zeros at both ends, D = v²·q, and if D is of degree n, q is of
//! degree n−4: sixteen samples determine it up to n = 19 (a cubic under a bicubic map has n = 18), thirty-two up to n = 35.
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
//! taken. If the bound is close, L is evaluated on a grid of three times as many points ([`FINE_GROWTH`]).
//! All that holds for the component of D in any direction, hence for its length.
//!
//! **Denominators.** If g = G/W, V is a polynomial close to 1/W, and VW·D replaces D; |VW − 1| is a polynomial known at
//! twenty-four samples.
//!
//! **Rounding.** Samples, ends and end slopes are known up to some 1e-14 of the coordinates. The bound grows by at most that
//! times the sum of the coefficients' sensitivities (240 for sixteen samples, 52 for thirty-two), which is added.

#[cfg(test)]
mod tests;

use crate::fit::Candidate;
use crate::sample::{CHECKED, FITTED, Lane, Lanes, UNIT, fma, larger, largest, sum};
use crate::source::{Quotient, Result, Source, images_into};
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Largest |VW − 1| allowed for a cleared denominator; the bound is divided by one minus |VW − 1|.
pub(crate) const MAX_VARIATION: f64 = 0.5;

/// Rounding of samples, ends and slopes relative to their coordinates: 45 units in the last place. Added to every bound.
pub(crate) const ROUNDING: f64 = 1e-14;

/// Degrees of D that sixteen and thirty-two samples determine.
const DETERMINED: [usize; 2] = [19, 35];
/// Factor by which a polynomial of degree [`MAX_VW_DEGREE`] can exceed its largest value at the first twenty-four samples.
const VW_GROWTH: f64 = 12.0;
/// Highest degree of VW.
const MAX_VW_DEGREE: usize = 16;
/// Rounding of basis functions and of sums of them.
const ARITHMETIC: f64 = 1.0 + 1e-9;

/// Proofs for one candidate. Each returns a bound for the Hausdorff distance between candidate and image; infinity if none
/// was found. A bound larger than `enough` is no proof and only indicates how far off one is.
pub(crate) struct SampledProof<'a, S> {
    source: &'a S,
    form: &'a Quotient,
    c: &'a Candidate,
    /// Images at the fitted and the checked samples, relative to the first point.
    g: [&'a Lanes; 2],
    enough: f64,
}

impl<'a, S: Source> SampledProof<'a, S> {
    #[inline(always)]
    pub(crate) fn new(source: &'a S, form: &'a Quotient, c: &'a Candidate, g: [&'a Lanes; 2], enough: f64) -> Self {
        Self { source, form, c, g, enough }
    }

    /// Degree of D, or of VW·D, with φ of degree p.
    #[inline(always)]
    fn degree(&self, p: usize) -> usize {
        let below = self.form.below;
        self.form.degree.max(below + 3 * p) + if below > 0 { V_DEGREE } else { 0 }
    }

    /// The bound for the Hermite cubic with φ = τ, from sixteen samples.
    pub(crate) fn identity(&self) -> Result<f64> {
        let hermite = [self.c.a, self.c.b] == self.c.frame.home;
        if hermite { self.bound(&([0.0; 2], []), 1, DETERMINED[0]) } else { Ok(f64::INFINITY) }
    }

    /// The bound from sixteen samples, with approximate foot points.
    pub(crate) fn sixteen(&self, feet: [&Lane; 2]) -> Result<f64> {
        self.bound_through::<3>(feet, DETERMINED[0])
    }

    /// The bound from thirty-two samples; the foot points should be accurate.
    pub(crate) fn thirty_two(&self, feet: [&Lane; 2]) -> Result<f64> {
        self.bound_through::<FREE>(feet, DETERMINED[1])
    }

    #[inline(always)]
    fn bound_through<const F: usize>(&self, feet: [&Lane; 2], most: usize) -> Result<f64> {
        // The highest degree of φ that so many samples allow: with F coefficients it is at most F + 3, and 5 is the least that helps.
        let Some(p) = (5..=F + 3).rev().find(|p| self.degree(*p) <= most) else { return Ok(f64::INFINITY) };
        let [h0, h1] = self.c.frame.home;
        let slopes = [h0 / self.c.a, h1 / self.c.b];
        match fit_phi::<F>(SampleTables::shared(), feet, slopes, p) {
            Some(phi) => self.bound(&phi, p, most),
            None => Ok(f64::INFINITY),
        }
    }

    /// The bound with φ of degree `p` from samples that determine D up to degree `limit`.
    #[inline(always)]
    fn bound<const F: usize>(&self, phi: &Phi<F>, p: usize, limit: usize) -> Result<f64> {
        let tables = SampleTables::shared();
        let c = self.c;
        let n = self.degree(p);
        if n > limit || self.form.below > MAX_VW_DEGREE - V_DEGREE {
            return Ok(f64::INFINITY);
        }
        let mut d = [Lanes::default(); 2];
        let [m0, m1] = [0, 1].map(|b| difference(tables, b, c, phi, self.g[b], &mut d[b]));
        let most = larger(m0, m1).sqrt();
        // No bound is lower than the largest sample.
        if most.is_nan() || most > self.enough {
            return Ok(most);
        }
        let noise = noise(self.form, c);
        let few = limit == DETERMINED[0];
        let data = ProofData { proof: self, noise, top: n.max(4) - 4, few, enough: self.enough };
        if self.form.below == 0 && few { Ok(data.by_sixteen(&d, most)) } else { data.by_more(phi, d) }
    }
}

/// A proof with the degree, rounding and goal of its bound.
struct ProofData<'a, S> {
    proof: &'a SampledProof<'a, S>,
    /// Rounding of one sample of D.
    noise: f64,
    /// Degree of q.
    top: usize,
    /// Set if there are only sixteen samples.
    few: bool,
    enough: f64,
}

impl<S: Source> ProofData<'_, S> {
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
        let mut c = [[0.0; 8]; 4];
        let tables = SampleTables::shared();
        coefficients(&tables.few, d, &mut c);
        let bound = supremum(tables, &c, most, self.enough);
        bound * ARITHMETIC + self.noise * amplification(tables.few.noise[top / 2][top % 2])
    }

    /// The bound with denominators, or from thirty-two samples.
    #[inline(never)]
    fn by_more<const F: usize>(&self, phi: &Phi<F>, d: [Lanes; 2]) -> Result<f64> {
        let tables = SampleTables::shared();
        let SampledProof { source, form, c, .. } = *self.proof;
        let few = self.few;
        let h = c.t1 - c.t0;
        let t = |b: usize| tables.places[b][0].map(|tau| fma(h, tau, c.t0));
        let mut d = [d[0], d[1], Lanes::default(), Lanes::default()];
        if !few {
            for b in [2, 3] {
                let mut g = Lanes::default();
                images_into(source, &t(b), &mut g)?;
                for i in 0..8 {
                    g.x[i] -= c.p0.x;
                    g.y[i] -= c.p0.y;
                }
                difference(tables, b, c, phi, &g, &mut d[b]);
            }
        }
        let mut variation = 0.0;
        if form.below > 0 {
            let mut w = [[1.0; 8]; 4];
            for b in 0..if few { 3 } else { 4 } {
                w[b] = form.denominators(source, &t(b));
            }
            if w.iter().flatten().any(|v| v.is_nan() || *v <= 0.0) {
                return Ok(f64::INFINITY);
            }
            variation = VW_GROWTH * clear(tables, &mut w);
            if variation.is_nan() || variation >= MAX_VARIATION {
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
                squares[i] = larger(fma(d.x[i], d.x[i], d.y[i] * d.y[i]), squares[i]);
            }
        }
        let most = largest(&squares).sqrt();
        let share = 1.0 - variation;
        let data = ProofData { enough: self.enough * share, noise: self.noise * (1.0 + variation), ..*self };
        let bound = if few {
            data.by_sixteen(&[d[0], d[1]], most)
        } else {
            let mut c = [[0.0; 16]; 4];
            coefficients(&tables.many, &d, &mut c);
            let bound = supremum(tables, &c, most, data.enough);
            bound * ARITHMETIC + data.noise * amplification(tables.many.noise[self.top / 2][self.top % 2])
        };
        Ok(bound / share)
    }
}

/// Factor from the noise of the samples to the noise of the bound, given the factor to the noise of the `coefficients`.
#[inline(always)]
fn amplification(coefficients: f64) -> f64 {
    // The tail occurs twice in the bound, and the samples have noise themselves.
    let largest = GROWTH[GROWTH.len() - 1];
    (1.0 + largest) * coefficients + 2.0 * largest
}

/// Rounding of the samples and of the ends and end slopes, so that D's zeros there are not exact. It is relative to the coordinates
/// and to the length of the whole segment's image, which is estimated by its speed at the ends.
#[inline(always)]
fn noise(form: &Quotient, c: &Candidate) -> f64 {
    let speeds = 3.0 * (c.frame.home[0] + c.frame.home[1]) / (c.t1 - c.t0);
    let one = ROUNDING * (c.p0.x.abs() + c.p0.y.abs() + c.frame.size + speeds) + form.blur;
    // One for the sample, one for the ends' positions in between, and 4/27 for either end slope, the maxima of the Hermite basis.
    one * (1.0 + 1.0 + 8.0 / 27.0)
}

/// The polynomial φ − τ: p₀, p₁, and the coefficients of v²r in the orthonormal basis.
pub(crate) type Phi<const F: usize> = ([f64; 2], [f64; F]);

/// φ of degree at most `p` with the given slopes at the ends, by least squares from the foot points. `None` if it leaves
/// [0, 1].
#[inline(always)]
pub(crate) fn fit_phi<const F: usize>(
    tables: &SampleTables,
    feet: [&Lane; 2],
    slopes: [f64; 2],
    p: usize,
) -> Option<Phi<F>> {
    let ends = [slopes[0] - 1.0, 1.0 - slopes[1]];
    let mut parts = [[0.0; 8]; F];
    for k in 0..F {
        let row = &tables.phi[k + 2];
        for i in 0..8 {
            parts[k][i] = fma(row[0][i], feet[0][i], row[1][i] * feet[1][i]);
        }
    }
    let mut c = [0.0; F];
    let mut b = tables.line;
    for j in 0..12 {
        b[j] = fma(tables.bernstein[0][j], ends[0], fma(tables.bernstein[1][j], ends[1], b[j]));
    }
    for k in 0..F {
        if k + 4 < p {
            let known = &tables.products[k];
            c[k] = sum(&parts[k]) - known[0] - known[1] * ends[0] - known[2] * ends[1];
        }
        for j in 0..12 {
            b[j] = fma(tables.bernstein[k + 2][j], c[k], b[j]);
        }
    }
    // The first and the last Bernstein coefficients are 0 and 1; those beside them, an eleventh of the slopes.
    let mut furthest = 0.0;
    for j in 2..10 {
        furthest = larger((b[j] - 0.5).abs(), furthest);
    }
    let slopes_inside = slopes.iter().all(|s| (0.0..11.0).contains(s));
    // The margin is for rounding.
    (slopes_inside && furthest < 0.5 - 1e-9 && sum(&parts[0]).is_finite()).then_some((ends, c))
}

/// Degrees d of L that are tried.
const TRIED: [usize; 4] = [2, 4, 6, 8];
/// K(d): the largest value on [0, 1] of v²·(polynomial of degree d) that is at most one at j/17. From linear programs at 640
/// Chebyshev nodes, times 1/cos(π(d+4)/1280) for the maximum between those (Ehlich and Zeller), rounded up.
pub(crate) const GROWTH: [f64; 9] = [1.0070, 1.0150, 1.0401, 1.0740, 1.0929, 1.2209, 1.2271, 1.3326, 1.3958];
/// K for the fine grid j/51 from 2 to 49, for d = 5.
pub(crate) const FINE_GROWTH: f64 = 1.0215;

/// Computes D at the samples of batch `b`. Returns the largest square of its length.
#[inline(never)]
pub(crate) fn difference<const F: usize>(
    tables: &SampleTables,
    b: usize,
    c: &Candidate,
    (ends, phi): &Phi<F>,
    g: &Lanes,
    out: &mut Lanes,
) -> f64 {
    let mut f = tables.places[b][0];
    if F > 0 {
        for i in 0..8 {
            f[i] = fma(tables.phi[0][b][i], ends[0], fma(tables.phi[1][b][i], ends[1], f[i]));
        }
        for k in 0..F {
            for i in 0..8 {
                f[i] = fma(tables.phi[k + 2][b][i], phi[k], f[i]);
            }
        }
    }
    let [c1, c2, c3] = c.frame.power(c.a, c.b);
    let mut squares = [0.0; 8];
    for i in 0..8 {
        let t = f[i];
        let x = g.x[i] - fma(fma(c3.x, t, c2.x), t, c1.x) * t;
        let y = g.y[i] - fma(fma(c3.y, t, c2.y), t, c1.y) * t;
        (out.x[i], out.y[i]) = (x, y);
        squares[i] = fma(x, x, y * y);
    }
    largest(&squares)
}

/// Replaces the values of W by those of VW, and returns the largest |VW − 1| of the first twenty-four.
#[inline(never)]
pub(crate) fn clear(tables: &SampleTables, w: &mut [Lane; 4]) -> f64 {
    let mut parts = [[0.0; 8]; V_DEGREE + 1];
    for b in 0..2 {
        for i in 0..8 {
            let v = 1.0 / w[b][i];
            for k in 0..=V_DEGREE {
                parts[k][i] = fma(tables.inverse[k][b][i], v, parts[k][i]);
            }
        }
    }
    let v = parts.map(|p| sum(&p));
    let mut most = [0.0; 8];
    for b in 0..4 {
        for i in 0..8 {
            let u = tables.places[b][2][i];
            w[b][i] *= fma(fma(fma(fma(v[4], u, v[3]), u, v[2]), u, v[1]), u, v[0]);
            let variation = (w[b][i] - 1.0).abs();
            most[i] = if b < 3 && variation > most[i] { variation } else { most[i] };
        }
    }
    largest(&most)
}

/// Computes the coefficients of D: the even ones of x and y, then the odd ones of x and y.
#[inline(never)]
pub(crate) fn coefficients<const B: usize, const H: usize>(
    e: &SampleExpansion<H>,
    d: &[Lanes; B],
    c: &mut [[f64; H]; 4],
) {
    let mut folded = [[0.0; H]; 4];
    for b in 0..B {
        for i in 0..4 {
            let (x, y, mx, my) = (d[b].x[i], d[b].y[i], d[b].x[7 - i], d[b].y[7 - i]);
            let k = 4 * b + i;
            (folded[0][k], folded[1][k], folded[2][k], folded[3][k]) = (x + mx, y + my, x - mx, y - my);
        }
    }
    let mut sums = [[0.0; H]; 4];
    for i in 0..H {
        let (even, odd) = (&e.even[i], &e.odd[i]);
        let [ex, ey, ox, oy] = [folded[0][i], folded[1][i], folded[2][i], folded[3][i]];
        for k in 0..H {
            sums[0][k] = fma(even[k], ex, sums[0][k]);
            sums[1][k] = fma(even[k], ey, sums[1][k]);
            sums[2][k] = fma(odd[k], ox, sums[2][k]);
            sums[3][k] = fma(odd[k], oy, sums[3][k]);
        }
    }
    *c = sums;
}

/// Largest |L|, with coefficients 0 to 5, at the points of the fine grid that are not samples.
#[inline(never)]
fn on_fine_grid<const H: usize>(tables: &SampleTables, c: &[[f64; H]; 4]) -> f64 {
    let [even, odd] = &tables.fine;
    let mut all = [0.0; 8];
    for b in [0, 8] {
        for i in 0..8 {
            let at = |m: &[[f64; 16]; FINE], c: &[f64; H]| {
                fma(m[0][b + i], c[0], fma(m[1][b + i], c[1], m[2][b + i] * c[2]))
            };
            let (ex, ey, ox, oy) = (at(even, &c[0]), at(even, &c[1]), at(odd, &c[2]), at(odd, &c[3]));
            let square = |x: f64, y: f64| fma(x, x, y * y);
            // The larger of the two mirror images.
            let (l, r) = (square(ex + ox, ey + oy), square(ex - ox, ey - oy));
            all[i] = larger(larger(l, r), all[i]);
        }
    }
    largest(&all).sqrt()
}

/// Bound for |D| from its coefficients and its largest sample. Evaluates the fine grid only if that may bring the bound
/// down to `enough`.
#[inline(always)]
pub(crate) fn supremum<const H: usize>(tables: &SampleTables, c: &[[f64; H]; 4], most: f64, enough: f64) -> f64 {
    let (mut even, mut odd) = ([0.0; H], [0.0; H]);
    for k in 0..H {
        even[k] = fma(c[0][k], c[0][k], c[1][k] * c[1][k]).sqrt();
        odd[k] = fma(c[2][k], c[2][k], c[3][k] * c[3][k]).sqrt();
    }
    // Everything beyond the tried degrees.
    let mut tail = 0.0;
    for k in TRIED.len() + 1..H {
        tail += even[k] + odd[k];
    }
    let mut best = f64::INFINITY;
    let mut fine = 0.0;
    for j in (0..TRIED.len()).rev() {
        // The even coefficient of degree d is not in the tail; the odd one after it is.
        let d = TRIED[j];
        tail += odd[d / 2];
        let bound = fma(GROWTH[d], most + tail, tail);
        best = if bound < best { bound } else { best };
        tail += even[d / 2];
        fine = if d / 2 == FINE { tail } else { fine };
    }
    if best > enough && most + fine <= enough {
        let largest = larger(on_fine_grid(tables, c), most + fine);
        let bound = fma(FINE_GROWTH, largest, fine);
        best = if bound < best { bound } else { best };
    }
    best
}

/// Half of the sixteen further samples of the longer proof, in seventeenths; the others mirror them. Together with the sixteen even
/// samples, they have nearly the largest determinant in the basis that is possible.
const EXTRA: [[f64; 4]; 2] = [[0.15, 0.35, 0.62, 1.4], [2.4, 3.44, 4.54, 7.47]];
/// Coefficients of either parity of L on the fine grid.
pub(crate) const FINE: usize = 3;
/// Degree of V.
pub(crate) const V_DEGREE: usize = 4;
/// Largest number of free coefficients of φ. With p₀ and p₁ there are [`PHI_BASIS`].
pub(crate) const FREE: usize = 8;
const PHI_BASIS: usize = FREE + 2;

/// Constant tables of the proofs from samples.
pub(crate) struct SampleTables {
    /// Values of τ, v and u at the samples, by batches.
    pub(crate) places: [[Lane; 3]; 4],
    pub(crate) few: SampleExpansion<8>,
    pub(crate) many: SampleExpansion<16>,
    /// Basis functions 0, 2, 4 and 1, 3, 5 in the left half of the fine grid.
    pub(crate) fine: [[[f64; 16]; FINE]; 2],
    /// Basis of φ − τ at the samples, by batches: v(1−τ), vτ, and v² times the polynomials orthonormal under v⁴ at the sixteen samples.
    pub(crate) phi: [[Lane; 4]; PHI_BASIS],
    /// Inner products of the orthonormal functions with τ, v(1−τ) and vτ over the sixteen samples.
    pub(crate) products: [[f64; 3]; FREE],
    /// Bernstein coefficients of degree eleven of the basis and, in `line`, of τ.
    pub(crate) bernstein: [[f64; 12]; PHI_BASIS],
    pub(crate) line: [f64; 12],
    /// Row k computes the k-th power coefficient of V from the values of 1/W at the sixteen samples.
    pub(crate) inverse: [[Lane; 2]; V_DEGREE + 1],
}

impl SampleTables {
    pub(crate) fn shared() -> &'static Self {
        static TABLES: LazyLock<Box<SampleTables>> = LazyLock::new(|| Box::new(SampleTables::new()));
        &TABLES
    }

    fn new() -> Self {
        let mirrored = |h: [f64; 4]| -> Lane { std::array::from_fn(|i| if i < 4 { h[i] } else { 17.0 - h[7 - i] }) };
        let sets = [FITTED, CHECKED, mirrored(EXTRA[0]), mirrored(EXTRA[1])];
        let places = sets.map(|s| {
            let tau = s.map(|j| j * UNIT);
            [tau, tau.map(|t| t * (1.0 - t)), tau.map(|t| 2.0 * t - 1.0)]
        });
        let basis = GegenbauerBasis::new();
        let half = std::array::from_fn(|i| basis.at(places[i / 4][0][i % 4]));
        // The left half of the points j/51 that are not samples, which are those with j = 3i.
        let mut grid = (2..26).filter(|j| j % 3 != 0).map(|j| f64::from(j) / 51.0);
        let grid: [_; 16] = std::array::from_fn(|_| basis.at(grid.next().unwrap_or(0.5)));
        let (phi, products, bernstein) = phi_tables(&places);
        let power = |u: f64| -> [f64; V_DEGREE + 1] { std::array::from_fn(|k| u.powi(k as i32)) };
        let rows: [[f64; V_DEGREE + 1]; 16] = std::array::from_fn(|i| power(places[i / 8][2][i % 8]));
        let gram = inverse(std::array::from_fn::<[f64; V_DEGREE + 1], { V_DEGREE + 1 }, _>(|r| {
            std::array::from_fn(|c| rows.iter().map(|p| p[r] * p[c]).sum())
        }));
        let at = |k: usize, i: usize| -> f64 { (0..=V_DEGREE).map(|c| gram[k][c] * rows[i][c]).sum() };
        let inverse = std::array::from_fn(|k| std::array::from_fn(|b| std::array::from_fn(|i| at(k, 8 * b + i))));
        Self {
            places,
            few: SampleExpansion::new(&half),
            many: SampleExpansion::new(&half),
            fine: std::array::from_fn(|odd| std::array::from_fn(|k| grid.map(|b| b[2 * k + odd]))),
            phi,
            products,
            bernstein,
            line: std::array::from_fn(|j| j as f64 / 11.0),
            inverse,
        }
    }
}

/// The tables `phi`, `products` and `bernstein` of [`SampleTables`].
type PhiTables = ([[Lane; 4]; PHI_BASIS], [[f64; 3]; FREE], [[f64; 12]; PHI_BASIS]);

fn phi_tables(places: &[[Lane; 3]; 4]) -> PhiTables {
    let tau = |i: usize| places[i / 8][0][i % 8];
    let v = |t: f64| t * (1.0 - t);
    // Functions are known by their values at the samples, then at the nodes from which Bernstein coefficients are interpolated.
    const AT: usize = 32 + 12;
    let at: [f64; AT] = std::array::from_fn(|i| if i < 32 { tau(i) } else { (i - 32) as f64 / 11.0 });
    let dot = |a: &[f64; AT], b: &[f64; AT]| -> f64 { (0..16).map(|i| a[i] * b[i]).sum() };
    let mut q = [[0.0; AT]; PHI_BASIS];
    q[0] = at.map(|t| v(t) * (1.0 - t));
    q[1] = at.map(|t| v(t) * t);
    for k in 2..PHI_BASIS {
        let last = q[k - 1];
        let mut next =
            if k == 2 { at.map(|t| v(t) * v(t)) } else { std::array::from_fn(|i| (2.0 * at[i] - 1.0) * last[i]) };
        // Gram–Schmidt, twice because of rounding.
        for _ in 0..2 {
            for base in &q[2..k] {
                let f = dot(&next, base);
                next = std::array::from_fn(|i| next[i] - f * base[i]);
            }
        }
        let size = dot(&next, &next).sqrt();
        q[k] = next.map(|v| v / size);
    }
    let choose = |j: usize| (0..j).fold(1.0, |c, i| c * (11 - i) as f64 / (i + 1) as f64);
    let collocation: [[f64; 12]; 12] = std::array::from_fn(|i| {
        let t = at[32 + i];
        std::array::from_fn(|j| choose(j) * t.powi(j as i32) * (1.0 - t).powi(11 - j as i32))
    });
    let solved = inverse(collocation);
    (
        q.map(|q| std::array::from_fn(|b| std::array::from_fn(|i| q[8 * b + i]))),
        std::array::from_fn(|k| [dot(&q[k + 2], &at), dot(&q[k + 2], &q[0]), dot(&q[k + 2], &q[1])]),
        q.map(|q| std::array::from_fn(|j| (0..12).map(|i| solved[j][i] * q[32 + i]).sum())),
    )
}

/// Matrices from samples to coefficients. The i-th and the (7−i)-th sample of a batch are mirror images.
pub(crate) struct SampleExpansion<const H: usize> {
    /// Row i: contributions of the sum (`odd`: difference) of the i-th sample and its mirror image to the coefficients 0, 2, 4…
    /// (1, 3, 5…).
    pub(crate) even: [[f64; H]; H],
    pub(crate) odd: [[f64; H]; H],
    /// `noise[k][odd]` bounds the summed change of the coefficients up to number 2k + odd if no sample changes by more than one.
    pub(crate) noise: [[f64; 2]; H],
}

/// The functions Bₖ, as the divisors that make their largest values one.
pub(crate) struct GegenbauerBasis(pub(crate) [f64; GegenbauerBasis::COUNT]);

impl GegenbauerBasis {
    /// Number of functions: one for each of thirty-two samples.
    pub(crate) const COUNT: usize = 32;

    pub(crate) fn new() -> Self {
        /// Number of nodes. A polynomial of degree n is at most 1/cos(πn/2N) times its largest value at them.
        const N: usize = 512;
        let mut largest = [0.0f64; Self::COUNT];
        for i in 0..N / 2 {
            let at = Self([1.0; Self::COUNT]).at(0.5 + 0.5 * (PI * (i as f64 + 0.5) / N as f64).cos());
            for (l, v) in largest.iter_mut().zip(at) {
                *l = l.max(v.abs());
            }
        }
        Self(std::array::from_fn(|k| largest[k] / (PI * (k + 4) as f64 / (2 * N) as f64).cos()))
    }

    /// Values of the functions at `tau`.
    pub(crate) fn at(&self, tau: f64) -> [f64; Self::COUNT] {
        let (u, v) = (2.0 * tau - 1.0, tau * (1.0 - tau));
        // Gegenbauer polynomials of index 4 (DLMF 18.9.1).
        let (mut last, mut c) = (0.0, 1.0);
        std::array::from_fn(|k| {
            let out = v * v * c / self.0[k];
            let n = k as f64;
            (last, c) = (c, (2.0 * (n + 4.0) * u * c - (n + 7.0) * last) / (n + 1.0));
            out
        })
    }
}

impl<const H: usize> SampleExpansion<H> {
    /// Builds the matrices from the values of the basis at the first halves of the batches.
    pub(crate) fn new(basis: &[[f64; GegenbauerBasis::COUNT]; 16]) -> Self {
        // A sum of mirror images is twice the even part.
        let rows = |odd: usize| -> [[f64; H]; H] {
            inverse(std::array::from_fn(|i| std::array::from_fn(|k| 2.0 * basis[i][2 * k + odd])))
        };
        let (even, odd) = (rows(0), rows(1));
        let row = |m: &[[f64; H]; H], k: usize| 2.0 * m[k].iter().map(|v| v.abs()).sum::<f64>();
        let mut noise = [[0.0; 2]; H];
        let mut all = 0.0;
        for k in 0..H {
            let e = all + row(&even, k);
            all = e + row(&odd, k);
            noise[k] = [e, all];
        }
        let turned = |m: [[f64; H]; H]| std::array::from_fn(|i| std::array::from_fn(|k| m[k][i]));
        Self { even: turned(even), odd: turned(odd), noise }
    }
}

/// The inverse of a matrix, by Gauss–Jordan elimination with pivots.
pub(crate) fn inverse<const N: usize>(mut a: [[f64; N]; N]) -> [[f64; N]; N] {
    let mut b: [[f64; N]; N] = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    for c in 0..N {
        let pivot = (c..N).max_by(|i, j| a[*i][c].abs().total_cmp(&a[*j][c].abs())).unwrap_or(c);
        a.swap(c, pivot);
        b.swap(c, pivot);
        let k = 1.0 / a[c][c];
        a[c] = a[c].map(|v| v * k);
        b[c] = b[c].map(|v| v * k);
        for r in 0..N {
            if r != c {
                let f = a[r][c];
                for j in 0..N {
                    a[r][j] -= f * a[c][j];
                    b[r][j] -= f * b[c][j];
                }
            }
        }
    }
    b
}
