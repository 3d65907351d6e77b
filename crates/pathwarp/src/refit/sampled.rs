//! Proofs from the samples that an attempt has taken anyway.
//!
//! As in [`super::certify`], D(τ) = g(τ) − C(φ(τ)) bounds the distance of image and cubic both ways if φ maps [0, 1] onto itself.
//! Here φ has the slopes at the ends that make D's first derivatives vanish there, |g′| / |C′| = Hermite's handle over the
//! actual one, and up to three more coefficients through the feet:
//!
//! > φ = τ + v·(p₀(1−τ) + p₁τ + v·r(u)),  v = τ(1−τ), u = 2τ−1, p₀ = φ′(0)−1, p₁ = 1−φ′(1), r of degree two or less
//!
//! It stays in [0, 1] if its Bernstein coefficients do. With double zeros at both ends D = v²·q, and as D is of a known degree n,
//! q is of degree n−4: sixteen samples determine it up to n = 19 (a cubic under a bicubic map has n = 18), thirty-two up to
//! n = 35.
//!
//! **Basis.** D = Σ cₖBₖ, where Bₖ is v² times the Gegenbauer polynomial of degree k and index 4, divided by its largest value. A
//! Gegenbauer polynomial of index λ oscillates about evenly under the weight (1−u²)^(λ/2), so the Bₖ do, and the tail beyond k
//! is little more than it must be if it is bounded by the sum of its coefficients.
//!
//! **Bound.** With L the part of D up to k = d, T = Σ |cₖ| over k > d, M the largest sample,
//!
//! > sup |D| ≤ sup |L| + T ≤ K(d)·(M + T) + T
//!
//! where K(d) is what a polynomial v²·(degree d) can exceed its largest sample by: [`GROWTH`]. The best d is taken. Where that is
//! close, L is looked at on a grid of three times as many places ([`FINE_GROWTH`]). All that holds for the component of D in
//! any direction, hence for its length.
//!
//! **Denominators.** Where g = G/W, V is a polynomial close to 1/W, and VW·D takes the place of D; |VW − 1| is a polynomial known
//! at twenty-four places.
//!
//! **Rounding.** Samples, ends and end slopes are known up to some 1e-14 of the coordinates. What of that reaches the bound is
//! at most the sum of the coefficients' sensitivities (240 for sixteen samples, 52 for thirty-two) times that; it is added.

mod tables;

use super::certify::Algebra;
use super::fit::{fma, largest, sum};
use super::samples::UNIT;
use super::source::{Curve, Lane, Lanes, Source};
use super::verify::Candidate;
use kurbo::Point;
use tables::{Expansion, FINE, FREE, LESS, Tables, V};

/// Degrees of L that are tried.
const TRIED: [usize; 4] = [2, 4, 6, 8];
/// K(d): the largest value on [0, 1] of v²·(polynomial of degree d) that is at most one at j/17. By linear programs at 640
/// Chebyshev nodes, times 1/cos(π(d+4)/1280) for what is between them (Ehlich and Zeller), rounded up.
pub(super) const GROWTH: [f64; 9] = [1.0070, 1.0150, 1.0401, 1.0740, 1.0929, 1.2209, 1.2271, 1.3326, 1.3958];
/// K of the fine grid j/51 from 2 to 49, for d = 5.
const FINE_GROWTH: f64 = 1.0215;
/// What a polynomial of degree sixteen exceeds its largest value at the first twenty-four samples by.
const BELOW_GROWTH: f64 = 12.0;
/// Its degree.
const BELOW: usize = 16;
/// Degrees of D that sixteen and thirty-two samples determine.
const MOST: [usize; 2] = [19, 35];
/// The largest value of τ(1−τ)².
const LEFT: f64 = 4.0 / 27.0;

/// A basis function's values are exact to rounding, and so is what is summed from them.
const ARITHMETIC: f64 = 1.0 + 1e-9;

impl Tables {
    /// Replaces the values of W by those of VW, and returns the largest |VW − 1| of the first twenty-four.
    #[inline(never)]
    fn clear(&self, w: &mut [Lane; 4], degree: usize) -> f64 {
        let inverse = &self.inverse[usize::from(degree == LESS)];
        let mut parts = [[0.0; 8]; V + 1];
        for b in 0..2 {
            for i in 0..8 {
                let v = 1.0 / w[b][i];
                for k in 0..=V {
                    parts[k][i] = fma(inverse[k][b][i], v, parts[k][i]);
                }
            }
        }
        let v = parts.map(|p| sum(&p));
        let mut most = [0.0; 8];
        for b in 0..4 {
            for i in 0..8 {
                let u = self.places[b][2][i];
                w[b][i] *= fma(fma(fma(fma(v[4], u, v[3]), u, v[2]), u, v[1]), u, v[0]);
                let off = (w[b][i] - 1.0).abs();
                most[i] = if b < 3 && off > most[i] { off } else { most[i] };
            }
        }
        largest(&most)
    }
}

/// The polynomial φ − τ: p₀, p₁, and its part v²r in the orthonormal basis.
type Phi<const F: usize> = ([f64; 2], [f64; F]);

/// φ of degree `p` at most with these slopes at the ends. `None`: it leaves [0, 1].
#[inline(always)]
fn through<const F: usize>(tables: &Tables, feet: [&Lane; 2], slopes: [f64; 2], p: usize) -> Option<Phi<F>> {
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
    // The coefficients are right up to rounding; the first and the last are 0 and 1, those beside them the slopes' elevenths.
    const ROUNDING: f64 = 1e-9;
    let mut outside = 0.0;
    for j in 2..10 {
        let off = (b[j] - 0.5).abs();
        outside = if off > outside { off } else { outside };
    }
    let slopes_inside = slopes.iter().all(|s| (0.0..11.0).contains(s));
    (slopes_inside && outside < 0.5 - ROUNDING && sum(&parts[0]).is_finite()).then_some((ends, c))
}

/// What image and cubic differ by at the corresponding places of batch `b`, and the largest square of that.
#[inline(never)]
fn difference<const F: usize>(
    tables: &Tables,
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

/// The coefficients of D: even ones of x and y, odd ones of x and y.
#[inline(never)]
fn coefficients<const B: usize, const H: usize>(e: &Expansion<H>, d: &[Lanes; B], c: &mut [[f64; H]; 4]) {
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

/// The largest value of L, coefficients 0 to 5, on the fine grid but for the samples.
#[inline(never)]
fn on_fine_grid<const H: usize>(tables: &Tables, c: &[[f64; H]; 4]) -> f64 {
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

/// The bound for |D| from its coefficients and its largest sample; with `enough`, that is looked at closer only where that may
/// bring it down so far.
#[inline(always)]
fn supremum<const H: usize>(tables: &Tables, c: &[[f64; H]; 4], most: f64, enough: f64) -> f64 {
    let (mut even, mut odd) = ([0.0; H], [0.0; H]);
    for k in 0..H {
        even[k] = fma(c[0][k], c[0][k], c[1][k] * c[1][k]).sqrt();
        odd[k] = fma(c[2][k], c[2][k], c[3][k] * c[3][k]).sqrt();
    }
    // Beyond the tried degrees all together.
    let mut tail = 0.0;
    for k in TRIED.len() + 1..H {
        tail += even[k] + odd[k];
    }
    let mut best = f64::INFINITY;
    let mut fine = 0.0;
    for j in (0..TRIED.len()).rev() {
        // The even coefficient of degree d is not in the tail, the odd one after it is.
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

/// A bound for the distance between candidate and image, both ways; infinite if none was found. `hermite` are the handles that
/// would follow the image's pace at the ends. `g` are the images at the samples [`FITTED`] and [`CHECKED`], relative to the first
/// point. A bound larger than `enough` is none: it only tells how far from one that is.
pub(super) struct Sampled<'a> {
    source: &'a Source<'a>,
    algebra: &'a Algebra,
    c: &'a Candidate,
    hermite: [f64; 2],
    g: [&'a Lanes; 2],
    enough: f64,
    /// What is left of C's derivative at the ends, times φ's, if the image stops there and C nearly does.
    left: [f64; 2],
    /// Degree of V.
    clearing: usize,
}

impl<'a> Sampled<'a> {
    #[inline(always)]
    pub(super) fn new(
        source: &'a Source<'a>,
        algebra: &'a Algebra,
        c: &'a Candidate,
        hermite: [f64; 2],
        g: [&'a Lanes; 2],
        enough: f64,
    ) -> Self {
        Self { source, algebra, c, hermite, g, enough, left: [0.0; 2], clearing: V }
    }

    /// Degree of D, or of VW·D, with φ of degree p.
    #[inline(always)]
    fn degree(&self, p: usize) -> usize {
        let below = self.algebra.below;
        self.algebra.degree.max(below + 3 * p) + if below > 0 { self.clearing } else { 0 }
    }

    /// The bound with φ = τ, for the Hermite cubic.
    pub(super) fn even(&self) -> Result<f64, Point> {
        let own = [self.c.a, self.c.b] == self.hermite;
        if own { self.with(&([0.0; 2], []), 1, MOST[0]) } else { Ok(f64::INFINITY) }
    }

    /// The bound from the sixteen samples, whose feet are known about.
    pub(super) fn few(&mut self, feet: [&Lane; 2]) -> Result<f64, Point> {
        self.through::<3>(feet, MOST[0])
    }

    /// The bound from thirty-two samples; the feet should be known well.
    pub(super) fn many(&mut self, feet: [&Lane; 2]) -> Result<f64, Point> {
        // A V of low degree lets φ have a higher one, where the denominator varies little.
        if self.algebra.below >= 8 {
            self.clearing = LESS;
            let less = self.through::<FREE>(feet, MOST[1])?;
            self.clearing = V;
            if less <= self.enough {
                return Ok(less);
            }
        }
        self.through::<FREE>(feet, MOST[1])
    }

    #[inline(always)]
    fn through<const F: usize>(&mut self, feet: [&Lane; 2], most: usize) -> Result<f64, Point> {
        // The highest degree of φ that so many samples allow.
        let Some(p) = (5..=F + 3).rev().find(|p| self.degree(*p) <= most) else { return Ok(f64::INFINITY) };
        let [h0, h1] = self.hermite;
        let mut slopes = [h0 / self.c.a, h1 / self.c.b];
        if h0 == 0.0 || h1 == 0.0 {
            self.stopping(feet, &mut slopes);
        }
        match through::<F>(Tables::shared(), feet, slopes, p) {
            Some(phi) => self.with(&phi, p, most),
            None => Ok(f64::INFINITY),
        }
    }
    /// Where the image stops at an end, D′ vanishes there only if φ′ or C′ does. Where C nearly stops too, φ goes on as the feet
    /// do, and what is left of D′ is taken off as a cubic with that slope.
    #[cold]
    fn stopping(&mut self, feet: [&Lane; 2], slopes: &mut [f64; 2]) {
        /// What that may cost of the tolerance.
        const COST: f64 = 0.3;
        let handles = [self.c.a, self.c.b];
        // Parabolas through the first and last two feet.
        let along = [2.0 * feet[0][0] - 0.5 * feet[1][0], 2.0 * (1.0 - feet[0][7]) - 0.5 * (1.0 - feet[1][7])];
        for k in 0..2 {
            if self.hermite[k] == 0.0 {
                let left = 3.0 * handles[k] * along[k] / UNIT;
                let slow = along[k] >= 0.0 && left * LEFT <= COST * self.enough;
                (slopes[k], self.left[k]) = if slow { (along[k] / UNIT, left) } else { (0.0, 0.0) };
            }
        }
    }

    /// Takes the cubic off.
    #[cold]
    fn take_off(&self, b: usize, d: &mut Lanes) {
        let tables = Tables::shared();
        let (t0, t1) = (self.c.frame.t0 * self.left[0], self.c.frame.t1 * self.left[1]);
        for i in 0..8 {
            let (l, r) = (tables.phi[0][b][i], tables.phi[1][b][i]);
            d.x[i] += t0.x * l - t1.x * r;
            d.y[i] += t0.y * l - t1.y * r;
        }
    }

    /// The bound with this φ, of degree p, from samples that determine D of degree `most`.
    #[inline(always)]
    fn with<const F: usize>(&self, phi: &Phi<F>, p: usize, most: usize) -> Result<f64, Point> {
        let tables = Tables::shared();
        let c = self.c;
        let (limit, n) = (most, self.degree(p));
        if n > limit || self.algebra.below > BELOW - V {
            return Ok(f64::INFINITY);
        }
        let mut d = [Lanes::default(); 2];
        let [m0, m1] = [0, 1].map(|b| difference(tables, b, c, phi, self.g[b], &mut d[b]));
        let most = (if m0 > m1 { m0 } else { m1 }).sqrt();
        // More than the samples themselves show nothing proves.
        if most.is_nan() || most > self.enough {
            return Ok(most);
        }
        let noise = noise(self.algebra, c, self.hermite);
        let left = self.left[0] + self.left[1];
        if left > 0.0 {
            self.take_off(0, &mut d[0]);
            self.take_off(1, &mut d[1]);
        }
        let cost = LEFT * left;
        let few = limit == MOST[0];
        let known = Known { job: self, noise, top: n.max(4) - 4, few, enough: self.enough - cost };
        let most = most + cost;
        let rest = if self.algebra.below == 0 && few { known.by_few(&d, most) } else { known.by_more(phi, d)? };
        Ok(rest + cost)
    }
}

/// What a proof knows.
struct Known<'a> {
    job: &'a Sampled<'a>,
    noise: f64,
    /// Degree of q.
    top: usize,
    /// Whether from sixteen samples only.
    few: bool,
    enough: f64,
}

impl Known<'_> {
    /// The bound from sixteen samples, the largest of which is `most`.
    #[inline(always)]
    fn by_few(&self, d: &[Lanes; 2], most: f64) -> f64 {
        let top = self.top;
        if let Some(growth) = GROWTH.get(top) {
            let limit = growth * (most * ARITHMETIC + 2.0 * self.noise);
            if limit <= self.enough {
                return limit;
            }
        }
        let mut k = [[0.0; 8]; 4];
        let tables = Tables::shared();
        coefficients(&tables.few, d, &mut k);
        let least = supremum(tables, &k, most, self.enough);
        least * ARITHMETIC + self.noise * shares(tables.few.noise[top / 2][top % 2])
    }

    /// With denominators, or from thirty-two samples.
    #[inline(never)]
    fn by_more<const F: usize>(&self, phi: &Phi<F>, d: [Lanes; 2]) -> Result<f64, Point> {
        let tables = Tables::shared();
        let Sampled { source, algebra, c, .. } = self.job;
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
                self.job.take_off(b, &mut d[b]);
            }
        }
        let mut off = 0.0;
        if algebra.below > 0 {
            let mut w = [[1.0; 8]; 4];
            for b in 0..if few { 3 } else { 4 } {
                w[b] = algebra.denominators(source, &t(b));
            }
            if w.iter().flatten().any(|v| v.is_nan() || *v <= 0.0) {
                return Ok(f64::INFINITY);
            }
            off = BELOW_GROWTH * tables.clear(&mut w, self.job.clearing);
            /// A denominator that varies so much is split instead.
            const WORST: f64 = 0.1;
            if off.is_nan() || off >= WORST {
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
        let known = Known { enough: self.enough * share, noise: self.noise * (1.0 + off), ..*self };
        let limit = if few {
            known.by_few(&[d[0], d[1]], most)
        } else {
            let mut k = [[0.0; 16]; 4];
            coefficients(&tables.many, &d, &mut k);
            let least = supremum(tables, &k, most, known.enough);
            least * ARITHMETIC + known.noise * shares(tables.many.noise[self.top / 2][self.top % 2])
        };
        Ok(limit / share)
    }
}

/// What the noise of the samples becomes in the bound, given what it may become in the coefficients.
#[inline(always)]
fn shares(all: f64) -> f64 {
    // Both times that the tail is in it, and the samples' own.
    let largest = GROWTH[GROWTH.len() - 1];
    (1.0 + largest) * all + 2.0 * largest
}

/// Rounding of the samples, and of the ends and the slopes there, which makes D's zeros there none.
#[inline(always)]
fn noise(algebra: &Algebra, c: &Candidate, hermite: [f64; 2]) -> f64 {
    /// Relative to the coordinates and the length of the whole segment's image, for which its speed at the ends stands.
    const ROUNDING: f64 = 1e-14;
    let speeds = 3.0 * (hermite[0] + hermite[1]) / (c.t1 - c.t0);
    let one = ROUNDING * (c.p0.x.abs() + c.p0.y.abs() + c.frame.size + speeds) + algebra.blur;
    // Its own, and that of the cubic through the ends' errors: one for either end's place, 4/27 for either slope.
    one * (1.0 + 1.0 + 8.0 / 27.0)
}

#[cfg(test)]
mod tests;
