//! The dense check: many samples along the image, whose foot points must advance along the cubic.

use super::probe::{Probe, probe};
use super::thorough::thorough;
use crate::refit::candidate::Candidate;
use crate::refit::gather;
use crate::refit::lanes::{Lane, largest};
use crate::refit::limits::{DENSE_BATCHES, FOOT_ROUNDING, MAX_CLOSER, MAX_ZOOMS, PEAK_NEAR, ZOOM_RISE};
use crate::refit::peaks::parabola_peak;
use crate::refit::resolution::turns_little;
use crate::refit::samples::Evenly;
use crate::refit::source::SourceCurve;
use crate::refit::split::SlowSpots;
use kurbo::{Point, Vec2};

/// Distance between samples.
const STEP: f64 = 1.0 / (DENSE_BATCHES * 8) as f64;

/// The distance between the candidate and the image over its stretch, by dense sampling, more densely around slow spots.
/// `feet` are foot points of sixteen samples, to start from. Returns `true` beside it if the thorough check was needed.
pub(in crate::refit) fn dense(
    source: &SourceCurve<'_>,
    c: &Candidate,
    feet: &Evenly,
    slow: &SlowSpots,
    tolerance: f64,
) -> Result<(f64, bool), Point> {
    let last = FootPoint { tau: 0.0, s: 0.0, slope: c.frame.t0 };
    let mut walk = Walk { source, c, feet, worst: 0.0, last, closer: MAX_CLOSER };
    let by_search = || Ok((thorough(source, c, slow, tolerance)?, true));
    let mut even = [[0.0; 8]; DENSE_BATCHES];
    let tau = |k: usize| -> Lane { std::array::from_fn(|i| ((k * 8 + i) as f64 + 0.5) / (DENSE_BATCHES * 8) as f64) };
    gather::announce(source, &(0..DENSE_BATCHES).map(|k| tau(k).map(|t| c.param(t))), &std::iter::empty());
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
struct Walk<'a> {
    source: &'a SourceCurve<'a>,
    c: &'a Candidate,
    feet: &'a Evenly,
    /// Square of the largest distance so far.
    worst: f64,
    last: FootPoint,
    /// Batches of closer samples that may still be taken.
    closer: usize,
}

impl Walk<'_> {
    /// Measures the next eight samples. Where two consecutive foot points see the cubic turn by more than 60°, samples
    /// eight more places in between. Returns the eight squared distances; `None` if the foot points do not advance or the cubic
    /// between them remains unknown.
    fn advance(&mut self, tau: &Lane) -> Result<Option<Lane>, Point> {
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
    fn closer(&mut self, tau: f64) -> Result<bool, Point> {
        let Some(left) = self.closer.checked_sub(1) else { return Ok(false) };
        self.closer = left;
        Ok(self.advance(&spread(self.last.tau, tau))?.is_some())
    }

    /// Eight more samples between the neighbours of every local maximum that is nearly the largest: where the cubic nearly
    /// stops, the distance has a corner that no parabola follows. Returns the highest distance found.
    fn zoom_on_peaks(&self, even: &[f64]) -> Result<f64, Point> {
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
