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

#[cfg(test)]
mod tests;

use crate::fit::Candidate;
use crate::limits::{MAX_DENOMINATOR_VARIATION, PROOF_ROUNDING, RANGE_ROUNDING, STOPPING_COST};
use crate::sample::{Lane, Lanes, UNIT, fma, largest, sum};
use crate::source::{NotFinite, Quotient, Source, images_into};
use crate::tables::{CLEARING, CLEARING_LESS, FINE, FREE, SampleExpansion, SampleTables};

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
pub(crate) struct SampledProof<'a, S> {
    source: &'a S,
    form: &'a Quotient,
    c: &'a Candidate,
    /// Images at the fitted and the checked samples, relative to the first point.
    g: [&'a Lanes; 2],
    enough: f64,
    /// The derivative of C∘φ left over at the ends where the image stops and C nearly does.
    left: [f64; 2],
    /// Degree of V.
    clearing: usize,
}

impl<'a, S: Source> SampledProof<'a, S> {
    #[inline(always)]
    pub(crate) fn new(source: &'a S, form: &'a Quotient, c: &'a Candidate, g: [&'a Lanes; 2], enough: f64) -> Self {
        Self { source, form, c, g, enough, left: [0.0; 2], clearing: CLEARING }
    }

    /// Degree of D, or of VW·D, with φ of degree p.
    #[inline(always)]
    fn degree(&self, p: usize) -> usize {
        let below = self.form.below;
        self.form.degree.max(below + 3 * p) + if below > 0 { self.clearing } else { 0 }
    }

    /// The bound for the Hermite cubic with φ = τ, from sixteen samples.
    pub(crate) fn identity(&self) -> Result<f64, NotFinite> {
        let hermite = [self.c.a, self.c.b] == self.c.frame.home;
        if hermite { self.with(&([0.0; 2], []), 1, DETERMINED[0]) } else { Ok(f64::INFINITY) }
    }

    /// The bound from sixteen samples, with approximate foot points.
    pub(crate) fn sixteen(&mut self, feet: [&Lane; 2]) -> Result<f64, NotFinite> {
        self.through::<3>(feet, DETERMINED[0])
    }

    /// The bound from thirty-two samples; the foot points should be accurate.
    pub(crate) fn thirty_two(&mut self, feet: [&Lane; 2]) -> Result<f64, NotFinite> {
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
    fn through<const F: usize>(&mut self, feet: [&Lane; 2], most: usize) -> Result<f64, NotFinite> {
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
    fn with<const F: usize>(&self, phi: &Phi<F>, p: usize, limit: usize) -> Result<f64, NotFinite> {
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
struct ProofData<'a, S> {
    proof: &'a SampledProof<'a, S>,
    /// Rounding of one sample of D.
    noise: f64,
    /// Degree of q.
    top: usize,
    /// Sixteen samples only.
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
        let mut k = [[0.0; 8]; 4];
        let tables = SampleTables::shared();
        coefficients(&tables.few, d, &mut k);
        let least = supremum(tables, &k, most, self.enough);
        least * ARITHMETIC + self.noise * amplification(tables.few.noise[top / 2][top % 2])
    }

    /// The bound with denominators, or from thirty-two samples.
    #[inline(never)]
    fn by_more<const F: usize>(&self, phi: &Phi<F>, d: [Lanes; 2]) -> Result<f64, NotFinite> {
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
fn noise(form: &Quotient, c: &Candidate) -> f64 {
    let speeds = 3.0 * (c.frame.home[0] + c.frame.home[1]) / (c.t1 - c.t0);
    let one = PROOF_ROUNDING * (c.p0.x.abs() + c.p0.y.abs() + c.frame.size + speeds) + form.blur;
    // Its own, and that of the cubic through the ends' errors: one for the place of either end, 4/27 for either slope.
    one * (1.0 + 1.0 + 8.0 / 27.0)
}

/// The polynomial φ − τ: p₀, p₁, and its part v²r in the orthonormal basis.
pub(crate) type Phi<const F: usize> = ([f64; 2], [f64; F]);

/// φ of degree at most `p` with the given slopes at the ends, by least squares from the foot points. `None` if it leaves
/// [0, 1].
#[inline(always)]
pub(crate) fn through<const F: usize>(
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
    let mut outside = 0.0;
    for j in 2..10 {
        let off = (b[j] - 0.5).abs();
        outside = if off > outside { off } else { outside };
    }
    let slopes_inside = slopes.iter().all(|s| (0.0..11.0).contains(s));
    (slopes_inside && outside < 0.5 - RANGE_ROUNDING && sum(&parts[0]).is_finite()).then_some((ends, c))
}

/// Degrees d of L that are tried.
const TRIED: [usize; 4] = [2, 4, 6, 8];
/// K(d): the largest value on [0, 1] of v²·(polynomial of degree d) that is at most one at j/17. From linear programs at 640
/// Chebyshev nodes, times 1/cos(π(d+4)/1280) for the maximum between those (Ehlich and Zeller), rounded up.
pub(crate) const GROWTH: [f64; 9] = [1.0070, 1.0150, 1.0401, 1.0740, 1.0929, 1.2209, 1.2271, 1.3326, 1.3958];
/// K for the fine grid j/51 from 2 to 49, for d = 5.
pub(crate) const FINE_GROWTH: f64 = 1.0215;

/// D at the places of batch `b`, and the largest square of its length.
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
pub(crate) fn clear(tables: &SampleTables, w: &mut [Lane; 4], degree: usize) -> f64 {
    let inverse = &tables.inverse[usize::from(degree == CLEARING_LESS)];
    let mut parts = [[0.0; 8]; CLEARING + 1];
    for b in 0..2 {
        for i in 0..8 {
            let v = 1.0 / w[b][i];
            for k in 0..=CLEARING {
                parts[k][i] = fma(inverse[k][b][i], v, parts[k][i]);
            }
        }
    }
    let v = parts.map(|p| sum(&p));
    let mut most = [0.0; 8];
    for b in 0..4 {
        for i in 0..8 {
            let u = tables.places[b][2][i];
            w[b][i] *= fma(fma(fma(fma(v[4], u, v[3]), u, v[2]), u, v[1]), u, v[0]);
            let off = (w[b][i] - 1.0).abs();
            most[i] = if b < 3 && off > most[i] { off } else { most[i] };
        }
    }
    largest(&most)
}

/// The coefficients of D: even ones of x and y, odd ones of x and y.
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

/// The largest value of L, coefficients 0 to 5, on the fine grid without the samples.
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
            let m = if l > r { l } else { r };
            all[i] = if m > all[i] { m } else { all[i] };
        }
    }
    largest(&all).sqrt()
}

/// The bound for |D| from its coefficients and its largest sample. Evaluates the fine grid only if that may bring the bound
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
        let limit = fma(GROWTH[d], most + tail, tail);
        best = if limit < best { limit } else { best };
        tail += even[d / 2];
        fine = if d / 2 == FINE { tail } else { fine };
    }
    if best > enough && most + fine <= enough {
        let at = on_fine_grid(tables, c);
        let largest = if at > most + fine { at } else { most + fine };
        let limit = fma(FINE_GROWTH, largest, fine);
        best = if limit < best { limit } else { best };
    }
    best
}
