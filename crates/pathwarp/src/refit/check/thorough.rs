//! The thorough check: both one-sided distances, without the foot points of the fit.

use crate::refit::candidate::Candidate;
use crate::refit::gather;
use crate::refit::lanes::{Lane, Lanes, larger, largest};
use crate::refit::limits::THOROUGH_SAMPLES;
use crate::refit::source::SourceCurve;
use crate::refit::split::SlowSpots;
use kurbo::{Point, Vec2};

/// The check's work in evaluations of the map: its own, and its search.
pub(in crate::refit) const THOROUGH_WORK: usize = 800;

/// Newton steps from the nearest place on the chords through the samples,
const STEPS: usize = 2;
/// and where those leave an error above the tolerance.
const MORE_STEPS: usize = 4;

/// The Hausdorff distance between candidate and image, by sampling: the nearest sample by search, the place on the
/// chords beside it, then Newton steps. Steps left out would only make distances larger.
#[cold]
pub(in crate::refit) fn thorough(
    source: &SourceCurve<'_>,
    c: &Candidate,
    slow: &SlowSpots,
    tolerance: f64,
) -> Result<f64, Point> {
    let taus = places(c, slow);
    let mut images = Vec::with_capacity(taus.len() / 8);
    let lanes = taus.chunks_exact(8).map(|chunk| std::array::from_fn(|i| c.param(chunk[i])));
    gather::announce(source, &lanes, &std::iter::empty());
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
    source: &SourceCurve<'_>,
    c: &Candidate,
    curve: &[Vec2],
    images: &Sampled<'_>,
    enough: f64,
    mut worst: f64,
) -> Result<f64, Point> {
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
    source: &SourceCurve<'_>,
    c: &Candidate,
    feet: &mut [Foot],
    enough: f64,
    mut worst: f64,
) -> Result<f64, Point> {
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
            let (p, d) = source.image(c.param(tau));
            let (r, v) = (p.to_vec2() - origin - foot.q, d * (c.t1 - c.t0));
            best = best.min(r.hypot2());
            tau = (tau - r.dot(v) / (v.hypot2() + f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        }
        worst = worst.max(best);
    }
    Ok(worst)
}
