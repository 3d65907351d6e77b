//! Tests of the proofs from samples, against brute force.

use super::*;
use crate::fit::ChordFrame;
use crate::sample::{CHECKED, FITTED, UNIT, feet_between};
use crate::source::images;
use kurbo::{CubicBez, ParamCurve, ParamCurveDeriv, Point, Vec2};

/// Pseudo-random numbers in [−1, 1].
struct Noise(u64);
impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    fn point(&mut self, size: f64) -> Point {
        Point::new(size * self.next(), size * self.next())
    }
}

/// A map by polynomials in xⁱyʲ, i, j < 4, over a denominator that is 1 plus a small polynomial.
struct RationalMap {
    x: [[f64; 4]; 4],
    y: [[f64; 4]; 4],
    w: [[f64; 4]; 4],
    degree: usize,
    rational: bool,
}

impl RationalMap {
    fn new(r: &mut Noise, degree: usize, bend: f64, below: f64) -> Self {
        let mut random = |bend: f64, at: (usize, usize)| {
            let mut c: [[f64; 4]; 4] = std::array::from_fn(|i| {
                std::array::from_fn(|j| if i + j <= degree && i + j > 0 { bend * r.next() } else { 0.0 })
            });
            c[at.0][at.1] += 1.0;
            c
        };
        let (x, y, w) = (random(bend, (1, 0)), random(bend, (0, 1)), random(below, (0, 0)));
        Self { x, y, w, degree, rational: below > 0.0 }
    }
    fn poly(c: &[[f64; 4]; 4], x: f64, y: f64) -> [f64; 3] {
        let mut out = [0.0; 3];
        for i in 0..4 {
            for j in 0..4 {
                let (a, b) = (x.powi(i as i32), y.powi(j as i32));
                out[0] += c[i][j] * a * b;
                out[1] += if i > 0 { c[i][j] * i as f64 * x.powi(i as i32 - 1) * b } else { 0.0 };
                out[2] += if j > 0 { c[i][j] * j as f64 * a * y.powi(j as i32 - 1) } else { 0.0 };
            }
        }
        out
    }
}

/// A cubic under a map.
struct Image {
    cubic: CubicBez,
    degree: usize,
    map: RationalMap,
}

impl Source for Image {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        let (p, v) = (self.cubic.eval(t), self.cubic.deriv().eval(t).to_vec2());
        let [f, g, w] = [&self.map.x, &self.map.y, &self.map.w].map(|c| RationalMap::poly(c, p.x, p.y));
        let q = |n: [f64; 3], k: usize| (n[k] * w[0] - n[0] * w[k]) / (w[0] * w[0]);
        let d = Vec2::new(q(f, 1), q(g, 1)) * v.x + Vec2::new(q(f, 2), q(g, 2)) * v.y;
        (Point::new(f[0] / w[0], g[0] / w[0]), d)
    }
    fn quotient(&self) -> Option<Quotient> {
        let degree = self.degree * self.map.degree;
        Some(Quotient { below: if self.map.rational { degree } else { 0 }, ..Quotient::polynomial(degree) })
    }
    fn denominators(&self, t: &Lane) -> Lane {
        t.map(|t| RationalMap::poly(&self.map.w, self.cubic.eval(t).x, self.cubic.eval(t).y)[0])
    }
}

/// Largest distance of 400 points of the image from the cubic, by brute force and golden sections.
fn truth(source: &impl Source, c: &Candidate) -> f64 {
    let cubic = c.frame.cubic(c.p0, c.p0 + c.frame.q, c.a, c.b);
    let mut worst = 0.0f64;
    for i in 0..=400 {
        let p = source.eval(c.t0 + (c.t1 - c.t0) * f64::from(i) / 400.0).0;
        let d = |s: f64| cubic.eval(s.clamp(0.0, 1.0)).distance(p);
        // Try every local minimum of the distance: near a hairpin or a crossing, the nearest sample may be beside the wrong one.
        let at: Vec<f64> = (-1..=65).map(|j| d(f64::from(j) / 64.0)).collect();
        let mut least = f64::INFINITY;
        for j in (1..66).filter(|j| at[*j] <= at[j - 1] && at[*j] <= at[j + 1]) {
            let s = (j - 1) as f64 / 64.0;
            let (mut lo, mut hi) = (s - 1.0 / 64.0, s + 1.0 / 64.0);
            for _ in 0..50 {
                let (a, b) = (lo + 0.382 * (hi - lo), hi - 0.382 * (hi - lo));
                if d(a) < d(b) { hi = b } else { lo = a }
            }
            least = least.min(d(0.5 * (lo + hi)));
        }
        worst = worst.max(least);
    }
    worst
}

/// Proves random pieces. Returns the number of proofs of the three kinds, and the largest and the least bound ÷ truth.
fn prove(degree: usize, below: f64, rounds: usize) -> ([usize; 3], f64, f64) {
    let mut r = Noise(17 + degree as u64);
    let (mut kinds, mut loosest, mut tightest) = ([0; 3], 0.0f64, f64::INFINITY);
    for round in 0..rounds {
        let map = RationalMap::new(&mut r, degree, [0.02, 0.1, 0.3][round % 3], below);
        let p = [0; 4].map(|_| r.point(0.6));
        let (cubic, kind) = match round % 4 {
            0 => (CubicBez::new(p[0], p[0].lerp(p[1], 1.0 / 3.0), p[0].lerp(p[1], 2.0 / 3.0), p[1]), 1),
            1 => (CubicBez::new(p[0], p[0].lerp(p[1], 2.0 / 3.0), p[2].lerp(p[1], 2.0 / 3.0), p[2]), 2),
            _ => (CubicBez::new(p[0], p[1], p[2], p[3]), 3),
        };
        let source = Image { cubic, degree: kind, map };
        let (t0, t1) = (0.4 + 0.3 * r.next(), 0.9 + 0.1 * r.next());
        let form = source.quotient().and_then(Quotient::provable);
        let (Some(form), Ok(from), Ok(to)) = (form, source.end(t0), source.end(t1)) else {
            continue;
        };
        let hermite = [from.speed, to.speed].map(|s| s * (t1 - t0) / 3.0);
        let even = round % 2 == 0;
        let stretch = if even { [1.0; 2] } else { [1.0 + 0.2 * r.next(), 1.0 + 0.2 * r.next()] };
        let (a, b) = (hermite[0] * stretch[0], hermite[1] * stretch[1]);
        let q = to.p - from.p;
        let frame = ChordFrame {
            q,
            t0: from.away,
            t1: to.into,
            floor: [0.0; 2],
            size: q.hypot() + a + b,
            home: hermite,
            pull: 0.0,
        };
        let c = Candidate { t0, t1, p0: from.p, frame, a, b };
        let images = |set: &Lane| {
            let mut g = images(&source, &set.map(|j| t0 + (t1 - t0) * j * UNIT)).unwrap_or_default();
            for i in 0..8 {
                g.x[i] -= from.p.x;
                g.y[i] -= from.p.y;
            }
            g
        };
        let g = [images(&FITTED), images(&CHECKED)];
        let mut s0 = FITTED.map(|j| j * UNIT);
        frame.distances(&g[0], a, b, &mut s0, 4);
        let mut s1 = feet_between(&s0);
        frame.distances(&g[1], a, b, &mut s1, 4);
        let real = truth(&source, &c);
        // The tolerance is near the true error, so that every stage occurs.
        let enough = real * [1.03, 1.1, 1.6, 5.0][round % 4 / 2 * 2 + round / 4 % 2] + 1e-9;
        let proof = SampledProof::new(&source, &form, &c, [&g[0], &g[1]], enough);
        let feet = [&s0, &s1];
        for (k, bound) in [proof.identity(), proof.sixteen(feet), proof.thirty_two(feet)].into_iter().enumerate() {
            let Ok(bound) = bound else { continue };
            if bound <= enough {
                kinds[k] += 1;
                // 1e-12 for the rounding of `truth`.
                tightest = tightest.min((bound + 1e-12) / real);
                if real > 1e-6 {
                    loosest = loosest.max(bound / real);
                }
            }
        }
    }
    (kinds, loosest, tightest)
}

#[test]
fn proofs_hold_for_random_pieces() {
    for (degree, below, rounds) in [(6, 0.0, 1500), (3, 0.0, 600), (4, 0.05, 900), (2, 0.2, 600)] {
        let (kinds, loosest, tightest) = prove(degree, below, rounds);
        assert!(tightest >= 1.0, "{degree}: {tightest}");
        // Sixteen samples do not determine a quotient's D with a φ of degree five.
        let met = |k: usize| kinds[k] > rounds / 60 || below > 0.0 && k == 1;
        assert!((0..3).all(met), "{degree}: {kinds:?}");
        assert!(loosest <= 5.0);
    }
}

/// Compares K(d) with random polynomials v²q.
#[test]
fn growth_factors_hold_for_random_polynomials() {
    let mut r = Noise(5);
    let even: Vec<f64> = (1..17).map(|j| f64::from(j) / 17.0).collect();
    let fine: Vec<f64> = (2..50).map(|j| f64::from(j) / 51.0).collect();
    for d in 0..9 {
        let mut grown = [0.0f64; 2];
        for _ in 0..400 {
            let c: Vec<f64> = (0..=d).map(|k| r.next() * if k == d { 2.0 } else { 1.0 }).collect();
            let f = |t: f64| {
                let at = GegenbauerBasis([1.0; GegenbauerBasis::COUNT]).at(t);
                let size = GegenbauerBasis([1.0; GegenbauerBasis::COUNT]).at(0.5);
                (0..=d).map(|k| c[k] * at[k] / size[k / 2 * 2].abs()).sum::<f64>()
            };
            let most = |ts: &[f64]| ts.iter().map(|t| f(*t).abs()).fold(0.0, f64::max);
            let all: Vec<f64> = (1..1000).map(|i| f64::from(i) / 1000.0).collect();
            grown[0] = grown[0].max(most(&all) / most(&even));
            grown[1] = grown[1].max(most(&all) / most(&fine));
        }
        assert!(grown[0] <= GROWTH[d], "{d}: {grown:?}");
        assert!(d > 5 || grown[1] <= FINE_GROWTH, "{d}: {grown:?}");
    }
}

/// The graph from (0, 0) to (1, 0) of y = v²·q(x), with q given by its zeros and scaled to a largest value of 0.01.
struct Swing {
    zeros: Vec<f64>,
    size: f64,
}

impl Swing {
    fn new(zeros: Vec<f64>) -> Self {
        let mut out = Self { zeros, size: 1.0 };
        out.size = 0.01 / (0..=20_000).map(|i| out.y(f64::from(i) / 20_000.0).abs()).fold(0.0, f64::max);
        out
    }
    fn y(&self, x: f64) -> f64 {
        self.size * (x * (1.0 - x)).powi(2) * self.zeros.iter().map(|z| x - z).product::<f64>()
    }
}

impl Source for Swing {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        let h = 1e-6;
        // Only the slopes at the ends matter, and those are zero.
        let slope = if t == 0.0 || t == 1.0 { 0.0 } else { (self.y(t + h) - self.y(t - h)) / (2.0 * h) };
        (Point::new(t, self.y(t)), Vec2::new(1.0, slope))
    }
    fn quotient(&self) -> Option<Quotient> {
        Some(Quotient::polynomial(self.zeros.len() + 4))
    }
}

/// Bounds by sixteen and thirty-two samples for the distance of such an image from the straight line, which is 0.01, and the largest
/// sample.
fn swing_bounds(source: &Swing) -> ([f64; 2], f64) {
    let form = source.quotient().unwrap();
    let unit = Vec2::new(1.0, 0.0);
    let hermite = [1.0 / 3.0; 2];
    let frame = ChordFrame { q: unit, t0: unit, t1: unit, floor: [0.0; 2], size: 1.0, home: hermite, pull: 0.0 };
    let c = Candidate { t0: 0.0, t1: 1.0, p0: Point::ZERO, frame, a: hermite[0], b: hermite[1] };
    let places = [FITTED, CHECKED].map(|set| set.map(|j| j * UNIT));
    let g = places.map(|t| images(source, &t).unwrap());
    let most = g.iter().flat_map(|g| g.y).fold(0.0, |m: f64, y| m.max(y.abs()));
    let proof = SampledProof::new(source, &form, &c, [&g[0], &g[1]], 1.0);
    let feet = [&places[0], &places[1]];
    ([proof.sixteen(feet).unwrap(), proof.thirty_two(feet).unwrap()], most)
}

/// Parameters of the sixteen samples. An error of the highest degree that nearly vanishes at them shows only in its coefficients.
fn evenly() -> Vec<f64> {
    (1..17).map(|j| f64::from(j) * UNIT).collect()
}

#[test]
fn errors_hidden_between_samples_are_bounded() {
    let all: Vec<f64> = evenly();
    let mut hidden = 0;
    for i in 0..16 {
        for j in 0..i {
            let zeros = all.iter().enumerate().filter(|(k, _)| *k != i && *k != j).map(|(_, t)| *t).collect();
            let ([few, many], most) = swing_bounds(&Swing::new(zeros));
            assert!(few >= 0.01 && many >= 0.01, "{i} {j}: {few} {many}");
            hidden += usize::from(most * GROWTH[GROWTH.len() - 1] < 0.01);
        }
    }
    assert!(hidden > 20, "{hidden}");
}

/// An error of higher degree than sixteen samples determine may vanish at all of them, so that they must prove nothing.
#[test]
fn degrees_too_high_for_sixteen_samples_need_thirty_two() {
    let ([few, many], most) = swing_bounds(&Swing::new(evenly()));
    assert!(most < 1e-15 && few == f64::INFINITY && many >= 0.01, "{most} {few} {many}");
}
