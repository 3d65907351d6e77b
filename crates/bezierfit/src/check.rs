//! The two closer checks of a cubic against the true curve.
//!
//! - [`dense`]: 64 samples, more where the cubic turns, and closer ones around every maximum.
//! - [`thorough`]: 160 samples each way, with a search for every nearest point. For curves whose foot points cannot be
//!   followed along the cubic.

use crate::fit::Candidate;
use crate::limits::{DENSE_BATCHES, FOOT_ROUNDING, MAX_CLOSER, MAX_ZOOMS, PEAK_NEAR, THOROUGH_SAMPLES, ZOOM_RISE};
use crate::sample::{ALL, Evenly, Lane, Lanes, larger, largest, parabola_peak, turns_little};
use crate::source::{NotFinite, SlowSpots, Source};
use kurbo::Vec2;

/// The check's work in evaluations of the map: its own, and its search.
pub(crate) const THOROUGH_WORK: usize = 800;

/// Newton steps from the nearest place on the chords through the samples,
const STEPS: usize = 2;
/// and where those leave an error above the tolerance.
const MORE_STEPS: usize = 4;

/// The Hausdorff distance between candidate and image, by sampling: the nearest sample by search, the place on the
/// chords beside it, then Newton steps. Steps left out would only make distances larger.
#[cold]
pub(crate) fn thorough(
    source: &impl Source,
    c: &Candidate,
    slow: &SlowSpots,
    tolerance: f64,
) -> Result<f64, NotFinite> {
    let taus = places(c, slow);
    let mut images = Vec::with_capacity(taus.len() / 8);
    let lanes = taus.chunks_exact(8).map(|chunk| std::array::from_fn(|i| c.param(chunk[i])));
    Source::announce(&mut lanes.map(|t| (source, t)), &mut std::iter::empty());
    for chunk in taus.chunks_exact(8) {
        let tau: Lane = std::array::from_fn(|i| chunk[i]);
        images.push(c.images(source, &tau)?);
    }
    let [c1, c2, c3] = c.frame.power(c.a, c.b);
    let at = |s: f64| (c1 + (c2 + c3 * s) * s) * s;
    let curve: Vec<Vec2> = (0..=THOROUGH_SAMPLES).map(|i| at(i as f64 / THOROUGH_SAMPLES as f64)).collect();
    let enough = tolerance * tolerance;
    let worst = from_image(c, &images, &curve, enough);
    let images: Vec<Vec2> = images.iter().flat_map(|g| (0..8).map(|i| Vec2::new(g.x[i], g.y[i]))).collect();
    let images = Sampled { at: &taus, points: &images };
    Ok(from_cubic(source, c, &curve, &images, enough, worst)?.sqrt())
}

/// Evenly spaced places, and geometrically denser ones around slow spots, in order; a multiple of eight.
fn places(c: &Candidate, slow: &SlowSpots) -> Vec<f64> {
    let step = 1.0 / THOROUGH_SAMPLES as f64;
    let mut dense = Vec::new();
    for t in slow.all() {
        let at = c.tau(*t);
        if at > 0.0 && at < 1.0 {
            let mut w = step;
            dense.push(at);
            for _ in 0..16 {
                dense.extend([at - w, at + w]);
                w *= 0.6;
            }
        }
    }
    dense.retain(|t| (0.0..=1.0).contains(t));
    dense.sort_by(f64::total_cmp);
    let mut dense = dense.into_iter().peekable();
    let mut taus = Vec::with_capacity(THOROUGH_SAMPLES + 8 + dense.len());
    for i in 0..=THOROUGH_SAMPLES {
        let even = i as f64 / THOROUGH_SAMPLES as f64;
        while let Some(t) = dense.next_if(|t| *t < even) {
            taus.push(t);
        }
        taus.push(even);
    }
    taus.resize(taus.len().next_multiple_of(8), 1.0);
    taus
}

/// The sample of `set` nearest to `p`, and its squared distance: downhill from `from`, or the best of all if that does not
/// come within `enough` (squared).
fn nearest(set: &[Vec2], from: usize, p: Vec2, enough: f64) -> (usize, f64) {
    let d = |i: usize| (set[i] - p).hypot2();
    let (mut at, mut best) = (from, d(from));
    while at + 1 < set.len() && d(at + 1) < best {
        at += 1;
        best = d(at);
    }
    // After a step ahead, what lies behind is farther.
    while at <= from && at > 0 && d(at - 1) < best {
        at -= 1;
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
}

/// A curve by its samples.
struct Sampled<'a> {
    at: &'a [f64],
    points: &'a [Vec2],
}

impl Sampled<'_> {
    /// The parameter of the place nearest to `p` on the chords at sample `i`, and the derivative along the chord that has it.
    fn beside(&self, i: usize, p: Vec2) -> (f64, Vec2) {
        let r = p - self.points[i];
        let along = |j: usize| (j, r.dot(self.points[j] - self.points[i]));
        let ahead = along((i + 1).min(self.points.len() - 1));
        let (j, dot) = if ahead.1 > 0.0 { ahead } else { along(i.saturating_sub(1)) };
        let (v, h) = (self.points[j] - self.points[i], self.at[j] - self.at[i]);
        let share = (dot / (v.hypot2() + f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (self.at[i] + share * h, if h == 0.0 { Vec2::ZERO } else { v / h })
    }
}

/// The largest squared distance of an image from the cubic.
fn from_image(c: &Candidate, images: &[Lanes], curve: &[Vec2], enough: f64) -> f64 {
    let at: [f64; THOROUGH_SAMPLES + 1] = std::array::from_fn(|i| i as f64 / THOROUGH_SAMPLES as f64);
    let sampled = Sampled { at: &at, points: curve };
    let mut from = 0;
    let mut worst = 0.0;
    for g in images {
        let mut s = [0.0; 8];
        for i in 0..8 {
            let p = Vec2::new(g.x[i], g.y[i]);
            from = nearest(curve, from, p, enough).0;
            s[i] = sampled.beside(from, p).0;
        }
        let mut squares = c.frame.distances(g, c.a, c.b, &mut s, STEPS);
        if largest(&squares) > enough {
            squares = c.frame.distances(g, c.a, c.b, &mut s, MORE_STEPS);
        }
        worst = larger(worst, largest(&squares));
    }
    worst
}

/// The largest squared distance of a point of the cubic from the image, if larger than `worst`.
fn from_cubic(
    source: &impl Source,
    c: &Candidate,
    curve: &[Vec2],
    images: &Sampled<'_>,
    enough: f64,
    mut worst: f64,
) -> Result<f64, NotFinite> {
    let mut from = 0;
    let mut waiting = Vec::with_capacity(8);
    for q in curve {
        let (i, square) = nearest(images.points, from, *q, enough);
        from = i;
        // A distance below the known error need not be refined.
        if square > worst {
            let (tau, slope) = images.beside(i, *q);
            waiting.push(Foot { q: *q, square, tau, slope });
        }
        if waiting.len() == 8 {
            worst = refined(source, c, &mut waiting, enough, worst)?;
            waiting.clear();
        }
    }
    if waiting.is_empty() { Ok(worst) } else { refined(source, c, &mut waiting, enough, worst) }
}

/// A point of the cubic, its squared distance from the image, and the place to look next.
#[derive(Debug, Clone, Copy)]
struct Foot {
    q: Vec2,
    square: f64,
    tau: f64,
    /// Derivative of the image, nearly.
    slope: Vec2,
}

/// Measures the distances of up to eight points together. Returns the largest square, or `worst` if that is larger.
fn refined(
    source: &impl Source,
    c: &Candidate,
    feet: &mut [Foot],
    enough: f64,
    mut worst: f64,
) -> Result<f64, NotFinite> {
    let origin = c.p0.to_vec2();
    for _ in 0..=STEPS {
        let last = feet.len() - 1;
        let g = c.images(source, &std::array::from_fn(|i| feet[i.min(last)].tau))?;
        for (i, foot) in feet.iter_mut().enumerate() {
            let r = Vec2::new(g.x[i], g.y[i]) - foot.q;
            foot.square = foot.square.min(r.hypot2());
            foot.tau = (foot.tau - r.dot(foot.slope) / (foot.slope.hypot2() + f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        }
        if feet.iter().all(|f| f.square <= worst) {
            return Ok(worst);
        }
    }
    for foot in feet {
        // Take Newton steps with the derivative where the chords lead to no place within the tolerance.
        let (mut tau, mut best) = (foot.tau, foot.square);
        for _ in 0..MORE_STEPS {
            if best <= larger(worst, enough) {
                break;
            }
            let (p, d) = source.eval(c.param(tau));
            let (r, v) = (p.to_vec2() - origin - foot.q, d * (c.t1 - c.t0));
            best = best.min(r.hypot2());
            tau = (tau - r.dot(v) / (v.hypot2() + f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        }
        worst = worst.max(best);
    }
    Ok(worst)
}

/// Distance between samples.
const STEP: f64 = 1.0 / (DENSE_BATCHES * 8) as f64;

/// The distance between the candidate and the image over its stretch, by dense sampling, more densely around slow spots.
/// `feet` are foot points of sixteen samples, to start from. Returns `true` beside it if the thorough check was needed.
pub(crate) fn dense(
    source: &impl Source,
    c: &Candidate,
    feet: &Evenly,
    slow: &SlowSpots,
    tolerance: f64,
) -> Result<(f64, bool), NotFinite> {
    let last = FootPoint { tau: 0.0, s: 0.0, slope: c.frame.t0 };
    let mut walk = Walk { source, c, feet, worst: 0.0, last, closer: MAX_CLOSER };
    let by_search = || Ok((thorough(source, c, slow, tolerance)?, true));
    let mut even = [[0.0; 8]; DENSE_BATCHES];
    let tau = |k: usize| -> Lane { std::array::from_fn(|i| ((k * 8 + i) as f64 + 0.5) / (DENSE_BATCHES * 8) as f64) };
    Source::announce(&mut (0..DENSE_BATCHES).map(|k| (source, tau(k).map(|t| c.param(t)))), &mut std::iter::empty());
    for (k, squares) in even.iter_mut().enumerate() {
        let Some(d) = walk.advance(&tau(k))? else { return by_search() };
        *squares = d;
    }
    if !turns_little(walk.last.slope, c.frame.t1) && !walk.closer(1.0)? {
        return by_search();
    }
    let mut worst = walk.worst;
    let peaks = walk.zoom_on_peaks(even.as_flattened())?;
    for t in slow.all() {
        let at = c.tau(*t);
        if at > 0.0 && at < 1.0 {
            let mut w = STEP;
            for _ in 0..3 {
                let tau: Lane = std::array::from_fn(|i| (at + w * (i as f64 - 3.5) / 4.0).clamp(0.0, 1.0));
                worst = worst.max(largest(&probe(source, c, feet, &tau, 4)?.squares));
                w *= 0.125;
            }
        }
    }
    Ok((worst.sqrt().max(peaks), false))
}

/// A sample's foot point on the cubic.
#[derive(Debug, Clone, Copy)]
struct FootPoint {
    tau: f64,
    s: f64,
    slope: Vec2,
}

/// A walk along the image.
struct Walk<'a, S> {
    source: &'a S,
    c: &'a Candidate,
    feet: &'a Evenly,
    /// Square of the largest distance so far.
    worst: f64,
    last: FootPoint,
    /// Batches of closer samples that may still be taken.
    closer: usize,
}

impl<S: Source> Walk<'_, S> {
    /// Measures the next eight samples. Where two consecutive foot points see the cubic turn by more than 60°, samples
    /// eight more places in between. Returns the eight squared distances; `None` if the foot points do not advance or the cubic
    /// between them remains unknown.
    fn advance(&mut self, tau: &Lane) -> Result<Option<Lane>, NotFinite> {
        let c = self.c;
        // Newton steps left out would only make distances larger.
        let Probe { s, squares, .. } = probe(self.source, c, self.feet, tau, 2)?;
        self.worst = self.worst.max(largest(&squares));
        let [c1, c2, c3] = c.frame.power(c.a, c.b);
        let (mut dx, mut dy) = ([0.0; 8], [0.0; 8]);
        for i in 0..8 {
            dx[i] = (c3.x * 3.0 * s[i] + c2.x * 2.0) * s[i] + c1.x;
            dy[i] = (c3.y * 3.0 * s[i] + c2.y * 2.0) * s[i] + c1.y;
        }
        if advances_smoothly(self.last, &s, &dx, &dy) {
            self.last = FootPoint { tau: tau[7], s: s[7], slope: Vec2::new(dx[7], dy[7]) };
            return Ok(Some(squares));
        }
        for i in 0..8 {
            let next = FootPoint { tau: tau[i], s: s[i], slope: Vec2::new(dx[i], dy[i]) };
            if next.s < self.last.s - FOOT_ROUNDING {
                return Ok(None);
            }
            if !turns_little(self.last.slope, next.slope) && !self.closer(next.tau)? {
                return Ok(None);
            }
            self.last = next;
        }
        Ok(Some(squares))
    }

    /// Measures eight more samples up to `tau`. Returns `false` if the cubic remains unknown.
    fn closer(&mut self, tau: f64) -> Result<bool, NotFinite> {
        let Some(left) = self.closer.checked_sub(1) else { return Ok(false) };
        self.closer = left;
        Ok(self.advance(&spread(self.last.tau, tau))?.is_some())
    }

    /// Eight more samples between the neighbours of every local maximum that is nearly the largest: where the cubic nearly
    /// stops, the distance has a corner that no parabola follows. Returns the highest distance found.
    fn zoom_on_peaks(&self, even: &[f64]) -> Result<f64, NotFinite> {
        let mut highest = 0.0f64;
        for i in 0..even.len() {
            let (before, after) = (if i > 0 { even[i - 1] } else { 0.0 }, even.get(i + 1).copied().unwrap_or(0.0));
            if even[i] < PEAK_NEAR * self.worst || even[i] < before || even[i] < after {
                continue;
            }
            let (mut at, mut w) = ((i as f64 + 0.5) * STEP, STEP);
            for _ in 0..MAX_ZOOMS {
                let tau = spread(at - w, at + w).map(|t| t.clamp(0.0, 1.0));
                let d = probe(self.source, self.c, self.feet, &tau, 3)?.squares;
                let top = (0..8).fold(0, |k, j| if d[j] > d[k] { j } else { k });
                let (sample, between) = (d[top].sqrt(), highest_parabola(&d, d[top]));
                let rises = sample.max(between) > ZOOM_RISE * highest;
                highest = highest.max(sample).max(between);
                if !rises {
                    break;
                }
                (at, w) = (tau[top], 0.25 * w);
            }
        }
        Ok(highest)
    }
}

/// One test for all eight: foot points `s` in order after `last`, and no turn of 60° between two of them. Nearly always true.
#[inline(always)]
fn advances_smoothly(last: FootPoint, s: &Lane, dx: &Lane, dy: &Lane) -> bool {
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
    largest(&margin) < 0.0
}

/// The highest parabola through three neighbours, of which the middle one is a local maximum near `most`. Takes squares.
fn highest_parabola(squares: &[f64], most: f64) -> f64 {
    let tops = squares.windows(3).filter(|w| w[1] >= PEAK_NEAR * most && w[1] >= w[0] && w[1] >= w[2]);
    tops.map(|w| parabola_peak(w[0].sqrt(), w[1].sqrt(), w[2].sqrt())).fold(0.0, f64::max)
}

/// Eight places between `a` and `b`, the last of them `b`.
fn spread(a: f64, b: f64) -> Lane {
    std::array::from_fn(|i| a + (b - a) * (i as f64 + 1.0) / 8.0)
}

/// Eight samples with their foot points and squared distances.
pub(crate) struct Probe {
    pub(crate) g: Lanes,
    pub(crate) s: Lane,
    pub(crate) squares: Lane,
}

/// Samples the image at `tau` and measures its distance from the cubic, after `steps` Newton steps for the foot points.
pub(crate) fn probe(
    source: &impl Source,
    c: &Candidate,
    feet: &Evenly,
    tau: &Lane,
    steps: usize,
) -> Result<Probe, NotFinite> {
    let mut s: Lane = tau.map(|t| interpolated(feet, t));
    let g = c.images(source, tau)?;
    let squares = c.frame.distances(&g, c.a, c.b, &mut s, steps);
    Ok(Probe { g, s, squares })
}

/// Piecewise linear interpolation of the known foot points.
#[inline(always)]
fn interpolated(feet: &Evenly, tau: f64) -> f64 {
    let at = tau * (ALL - 1) as f64;
    let k = (at as usize).min(ALL - 2);
    feet[k] + (feet[k + 1] - feet[k]) * (at - k as f64)
}
