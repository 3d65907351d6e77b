//! The thorough check: both one-sided distances, without the foot points of the fit.

use crate::refit::candidate::Candidate;
use crate::refit::gather;
use crate::refit::lanes::{Lane, Lanes, larger, largest};
use crate::refit::limits::THOROUGH_SAMPLES;
use crate::refit::source::SourceCurve;
use crate::refit::split::SlowSpots;
use kurbo::{Point, Vec2};

/// Newton steps from the nearest sample.
const NEWTON_STEPS: usize = 4;

/// The Hausdorff distance between candidate and image, by sampling: the nearest sample by search, then Newton steps.
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
    Ok(from_cubic(source, c, [&curve, &images], &taus, enough, worst).sqrt())
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
}

/// The largest squared distance of an image from the cubic.
fn from_image(c: &Candidate, images: &[Lanes], curve: &[Vec2], enough: f64) -> f64 {
    let mut from = 0;
    let mut worst = 0.0;
    for g in images {
        let mut s = [0.0; 8];
        for i in 0..8 {
            from = nearest(curve, from, Vec2::new(g.x[i], g.y[i]), enough).0;
            s[i] = from as f64 / THOROUGH_SAMPLES as f64;
        }
        worst = larger(worst, largest(&c.frame.distances(g, c.a, c.b, &mut s, NEWTON_STEPS)));
    }
    worst
}

/// The largest squared distance of a point of the cubic from the image, if larger than `worst`.
fn from_cubic(
    source: &SourceCurve<'_>,
    c: &Candidate,
    [curve, images]: [&[Vec2]; 2],
    taus: &[f64],
    enough: f64,
    mut worst: f64,
) -> f64 {
    let origin = c.p0.to_vec2();
    let h = c.t1 - c.t0;
    let mut from = 0;
    for q in curve {
        let (i, mut best) = nearest(images, from, *q, enough);
        from = i;
        let mut tau = taus[i];
        for _ in 0..NEWTON_STEPS {
            // A distance below the known error need not be refined.
            if best <= worst {
                break;
            }
            let (p, d) = source.image(c.param(tau));
            let (r, v) = (p.to_vec2() - origin - *q, d * h);
            best = best.min(r.hypot2());
            tau = (tau - r.dot(v) / (v.hypot2() + f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        }
        worst = worst.max(best);
    }
    worst
}
