//! Dense checks of a fitted piece against the true image, both ways.

use super::fit::{self, Frame};
use super::samples::{STEEPER, foreseen};
use super::source::{Curve, Lane, Lanes};
use super::split::Slow;
use kurbo::{Point, Vec2};

/// Samples of the quick check, in batches of eight.
const BATCHES: usize = 8;
/// Samples a way of the thorough check.
const THOROUGH: usize = 160;

/// Known feet.
const FEET: usize = 18;
/// The feet of evenly spaced samples, those at both ends included.
pub(super) type Feet = [f64; FEET];

/// A fitted piece: where it lies on the source, and its handles.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    pub(super) t0: f64,
    pub(super) t1: f64,
    pub(super) p0: Point,
    pub(super) frame: Frame,
    pub(super) a: f64,
    pub(super) b: f64,
}

impl Candidate {
    fn param(&self, tau: f64) -> f64 {
        self.t0 + (self.t1 - self.t0) * tau
    }

    /// Images at `tau` (shares of the piece), relative to its first point.
    fn images(&self, source: &impl Curve, tau: &Lane) -> Result<Lanes, Point> {
        let mut t = [0.0; 8];
        for i in 0..8 {
            t[i] = self.param(tau[i]);
        }
        let mut g = source.images(&t)?;
        for i in 0..8 {
            g.x[i] -= self.p0.x;
            g.y[i] -= self.p0.y;
        }
        Ok(g)
    }

    fn at(&self, s: f64) -> Vec2 {
        let [c1, c2, c3] = self.frame.power(self.a, self.b);
        (c1 + (c2 + c3 * s) * s) * s
    }

    fn slope(&self, s: f64) -> Vec2 {
        let [c1, c2, c3] = self.frame.power(self.a, self.b);
        c1 + (c2 * 2.0 + c3 * (3.0 * s)) * s
    }
}

/// What the errors of sixteen samples may rise to between them; where a sample or that is above its limit, by samples halfway
/// beside it. `None` where that is nearly everywhere, or the errors halfway have nothing to do with those beside them. `errors` go
/// with `feet`, and have the sign of their side; the third limit is how far they may be from the mean of their neighbours.
pub(super) fn halfway(
    source: &impl Curve,
    c: &Candidate,
    feet: &Feet,
    errors: &Feet,
    limits: [f64; 3],
) -> Result<Option<f64>, Point> {
    /// Places looked at.
    const MOST: usize = 16;
    let mut all = [0.0; 2 * FEET - 1];
    let mut in_doubt = [false; FEET];
    let mut most = 0.0f64;
    for j in 1..FEET - 1 {
        let rises = foreseen([errors[j - 1], errors[j], errors[j + 1]], STEEPER);
        in_doubt[j] = errors[j].abs() > limits[0] || rises > limits[1];
        most = most.max(if in_doubt[j] { 0.0 } else { rises });
        all[2 * j] = errors[j];
    }
    let mut gaps = [0; MOST];
    let mut n = 0;
    for j in 0..FEET - 1 {
        if in_doubt[j] || in_doubt[j + 1] {
            if n == MOST {
                return Ok(None);
            }
            gaps[n] = j;
            n += 1;
        }
    }
    let gaps = &gaps[..n];
    for gaps in gaps.chunks(8) {
        let tau = std::array::from_fn(|i| (gaps[i.min(gaps.len() - 1)] as f64 + 0.5) / (FEET - 1) as f64);
        let (g, s, squares) = looked(source, c, feet, &tau, 2)?;
        let sided = c.frame.sided(&g, c.a, c.b, &s, &squares);
        for (j, e) in gaps.iter().zip(sided) {
            all[2 * j + 1] = e;
            if (e - 0.5 * (errors[*j] + errors[j + 1])).abs() > limits[2] {
                return Ok(None);
            }
        }
    }
    let tops = gaps.iter().map(|j| 2 * j + 1).chain((1..FEET - 1).filter(|j| in_doubt[*j]).map(|j| 2 * j));
    Ok(Some(tops.map(|k| foreseen([all[k - 1], all[k], all[k + 1]], 0.5 * STEEPER)).fold(most, f64::max)))
}

/// Images at further places, their feet, and the squared distances.
fn looked(
    source: &impl Curve,
    c: &Candidate,
    feet: &Feet,
    tau: &Lane,
    steps: usize,
) -> Result<(Lanes, Lane, Lane), Point> {
    let mut s: Lane = tau.map(|t| guess(feet, t));
    let g = c.images(source, tau)?;
    let squares = c.frame.distances(&g, c.a, c.b, &mut s, steps);
    Ok((g, s, squares))
}

/// The distance between the candidate and the image over its stretch, by many samples, more of them around slow spots.
/// `feet` are first guesses.
pub(super) fn dense(
    source: &impl Curve,
    c: &Candidate,
    feet: &Feet,
    slow: &Slow,
    tolerance: f64,
) -> Result<f64, Point> {
    let mut worst = 0.0f64;
    let mut last = Foot { tau: 0.0, s: 0.0, slope: c.frame.t0 };
    let mut sound = true;
    let walk = |tau: &Lane, worst: &mut f64, last: &mut Foot, depth: u32| -> Result<(bool, Lane), Point> {
        walk(source, c, feet, tau, worst, last, depth)
    };
    let looked = |tau: &Lane, steps: usize| looked(source, c, feet, tau, steps).map(|(_, _, squares)| squares);
    let mut even = [[0.0; 8]; BATCHES];
    for (k, squares) in even.iter_mut().enumerate() {
        let tau: Lane = std::array::from_fn(|i| ((k * 8 + i) as f64 + 0.5) / (BATCHES * 8) as f64);
        let (good, d) = walk(&tau, &mut worst, &mut last, 0)?;
        sound &= good;
        *squares = d;
    }
    sound &= turns_little(last.slope, c.frame.t1) || walk(&spread(last.tau, 1.0), &mut worst, &mut last, 1)?.0;
    // Eight more between the neighbours of every sample that is nearly the largest: where the cubic nearly stops, the distance
    // has a corner that no parabola follows.
    let mut tops = 0.0f64;
    let even = even.as_flattened();
    for i in 0..even.len() {
        let (before, after) = (if i > 0 { even[i - 1] } else { 0.0 }, even.get(i + 1).copied().unwrap_or(0.0));
        if even[i] < NEAR * worst || even[i] < before || even[i] < after {
            continue;
        }
        // Closer and closer while it rises.
        let (mut at, mut w) = ((i as f64 + 0.5) * STEP, STEP);
        for _ in 0..ZOOMS {
            let tau = spread(at - w, at + w).map(|t| t.clamp(0.0, 1.0));
            let d = looked(&tau, 3)?;
            let top = (0..8).fold(0, |k, j| if d[j] > d[k] { j } else { k });
            let (highest, rise) = (d[top].sqrt(), peak(&d, d[top]));
            let news = highest.max(rise) > RISES * tops;
            tops = tops.max(highest).max(rise);
            if !news {
                break;
            }
            (at, w) = (tau[top], 0.25 * w);
        }
    }
    for t in slow.all() {
        let at = (t - c.t0) / (c.t1 - c.t0);
        if at > 0.0 && at < 1.0 {
            let mut w = 1.0 / (BATCHES * 8) as f64;
            for _ in 0..3 {
                let tau: Lane = std::array::from_fn(|i| (at + w * (i as f64 - 3.5) / 4.0).clamp(0.0, 1.0));
                worst = worst.max(fit::largest(&looked(&tau, 4)?));
                w *= 0.125;
            }
        }
    }
    for chunk in source.places(c.t0, c.t1).chunks(8) {
        let tau: Lane = std::array::from_fn(|i| (chunk[i.min(chunk.len() - 1)] - c.t0) / (c.t1 - c.t0));
        worst = worst.max(fit::largest(&looked(&tau, 3)?));
    }
    let worst = worst.sqrt().max(tops);
    if sound { Ok(worst) } else { thorough(source, c, slow, tolerance) }
}

/// A sample whose square is below this share of the largest is no top.
const NEAR: f64 = 0.64;
/// A top that is this many times as high as what was seen before is looked at closer, so often at most.
const RISES: f64 = 1.001;
const ZOOMS: usize = 4;
/// Between samples.
const STEP: f64 = 1.0 / (BATCHES * 8) as f64;

/// The largest distance between evenly spaced samples: parabolas through three neighbours, where the middle one is the largest
/// of them. Squares are given, of samples none larger than `most`.
fn peak(squares: &[f64], most: f64) -> f64 {
    let tops = squares.windows(3).filter(|w| w[1] >= NEAR * most && w[1] >= w[0] && w[1] >= w[2]);
    tops.map(|w| vertex(w[0].sqrt(), w[1].sqrt(), w[2].sqrt())).fold(0.0, f64::max)
}

/// How high the parabola through three neighbours rises, of which the middle one is the largest.
fn vertex(a: f64, b: f64, c: f64) -> f64 {
    let bend = 2.0 * b - a - c;
    if bend > 0.0 { b + (c - a).powi(2) / (8.0 * bend) } else { b }
}

/// A sample's foot on the cubic.
#[derive(Debug, Clone, Copy)]
struct Foot {
    tau: f64,
    s: f64,
    slope: Vec2,
}

/// Eight shares between two.
fn spread(a: f64, b: f64) -> Lane {
    std::array::from_fn(|i| a + (b - a) * (i as f64 + 1.0) / 8.0)
}

/// Measures the next eight samples; between two whose feet see the cubic turn much, eight more. Returns whether the feet
/// advance, and the cubic between them is known; and the eight distances, squared.
fn walk(
    source: &impl Curve,
    c: &Candidate,
    feet: &Feet,
    tau: &Lane,
    worst: &mut f64,
    last: &mut Foot,
    depth: u32,
) -> Result<(bool, Lane), Point> {
    /// Sixty-four samples, eight and eight more in between.
    const DEPTH: u32 = 2;
    /// Feet this close are in order.
    const ROUNDING: f64 = 1e-9;
    let mut s: Lane = tau.map(|t| guess(feet, t));
    let g = c.images(source, tau)?;
    // Steps left out would only make distances larger.
    let d = c.frame.distances(&g, c.a, c.b, &mut s, 2);
    *worst = worst.max(fit::largest(&d));
    let [c1, c2, c3] = c.frame.power(c.a, c.b);
    let (mut dx, mut dy) = ([0.0; 8], [0.0; 8]);
    for i in 0..8 {
        dx[i] = (c3.x * 3.0 * s[i] + c2.x * 2.0) * s[i] + c1.x;
        dy[i] = (c3.y * 3.0 * s[i] + c2.y * 2.0) * s[i] + c1.y;
    }
    // Nearly always all eight are in order and see little turn: one test for all.
    let mut before = [(last.s, last.slope.x, last.slope.y); 8];
    for i in 1..8 {
        before[i] = (s[i - 1], dx[i - 1], dy[i - 1]);
    }
    let mut margin = [0.0; 8];
    for i in 0..8 {
        let (s0, x0, y0) = before[i];
        let dot = x0 * dx[i] + y0 * dy[i];
        let little = 4.0 * dot * dot - (x0 * x0 + y0 * y0) * (dx[i] * dx[i] + dy[i] * dy[i]);
        let m = if dot < little { dot } else { little };
        let order = s[i] - s0;
        margin[i] = -(if m < order { m } else { order });
    }
    if fit::largest(&margin) < 0.0 {
        *last = Foot { tau: tau[7], s: s[7], slope: Vec2::new(dx[7], dy[7]) };
        return Ok((true, d));
    }
    let mut sound = true;
    for i in 0..8 {
        let next = Foot { tau: tau[i], s: s[i], slope: Vec2::new(dx[i], dy[i]) };
        if next.s < last.s - ROUNDING {
            return Ok((false, d));
        }
        if !turns_little(last.slope, next.slope) {
            sound &= depth < DEPTH && walk(source, c, feet, &spread(last.tau, next.tau), worst, last, depth + 1)?.0;
        }
        *last = next;
    }
    Ok((sound, d))
}

/// Whether two directions are less than 60° apart.
pub(super) fn turns_little(a: Vec2, b: Vec2) -> bool {
    let d = a.dot(b);
    d > 0.0 && 4.0 * d * d >= a.hypot2() * b.hypot2()
}

/// Piecewise linear between the known feet.
#[inline(always)]
fn guess(feet: &Feet, tau: f64) -> f64 {
    let at = tau * (FEET - 1) as f64;
    let k = (at as usize).min(FEET - 2);
    feet[k] + (feet[k + 1] - feet[k]) * (at - k as f64)
}

/// Both one-sided distances, with no help from the fit: nearest samples by search, then Newton steps.
#[cold]
pub(super) fn thorough(source: &impl Curve, c: &Candidate, slow: &Slow, tolerance: f64) -> Result<f64, Point> {
    let mut taus = Vec::with_capacity(THOROUGH + 72);
    taus.extend((0..=THOROUGH).map(|i| i as f64 / THOROUGH as f64));
    for t in slow.all() {
        let at = (t - c.t0) / (c.t1 - c.t0);
        if at > 0.0 && at < 1.0 {
            let mut w = 1.0 / THOROUGH as f64;
            taus.push(at);
            for _ in 0..16 {
                taus.extend([at - w, at + w]);
                w *= 0.6;
            }
        }
    }
    taus.retain(|t| (0.0..=1.0).contains(t));
    taus.sort_by(f64::total_cmp);
    while taus.len() % 8 != 0 {
        taus.push(1.0);
    }
    let mut images = Vec::with_capacity(taus.len());
    for chunk in taus.chunks_exact(8) {
        let tau: Lane = std::array::from_fn(|i| chunk[i]);
        let g = c.images(source, &tau)?;
        images.extend((0..8).map(|i| Vec2::new(g.x[i], g.y[i])));
    }
    let curve: Vec<Vec2> = (0..=THOROUGH).map(|i| c.at(i as f64 / THOROUGH as f64)).collect();
    // Downhill from the last nearest; all of them where that is not near enough.
    let enough = tolerance * tolerance;
    let nearest = |set: &[Vec2], from: usize, p: Vec2| {
        let d = |i: usize| (set[i] - p).hypot2();
        let (mut at, mut best) = (from, d(from));
        loop {
            if at + 1 < set.len() && d(at + 1) < best {
                at += 1;
            } else if at > 0 && d(at - 1) < best {
                at -= 1;
            } else {
                break;
            }
            best = d(at);
        }
        if best > enough {
            for (i, q) in set.iter().enumerate() {
                let d = (*q - p).hypot2();
                if d < best {
                    (at, best) = (i, d);
                }
            }
        }
        (at, best)
    };
    let mut from = 0;
    let mut worst = 0.0f64;
    for p in &images {
        let (i, mut best) = nearest(&curve, from, *p);
        from = i;
        let mut s = i as f64 / THOROUGH as f64;
        for _ in 0..4 {
            let (r, v) = (c.at(s) - *p, c.slope(s));
            s = (s - r.dot(v) / (v.hypot2() + f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            best = best.min((c.at(s) - *p).hypot2());
        }
        worst = worst.max(best);
    }
    let origin = c.p0.to_vec2();
    from = 0;
    for q in &curve {
        let (i, mut best) = nearest(&images, from, *q);
        from = i;
        let mut tau = taus[i];
        let h = c.t1 - c.t0;
        // Farther than what is already known to be the error only if Newton finds nothing nearer.
        for _ in 0..4 {
            if best > worst {
                let (p, d) = source.image(c.param(tau));
                let (r, v) = (p.to_vec2() - origin - *q, d * h);
                best = best.min(r.hypot2());
                tau = (tau - r.dot(v) / (v.hypot2() + f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            }
        }
        worst = worst.max(best);
    }
    Ok(worst.sqrt())
}
