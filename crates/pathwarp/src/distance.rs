//! The Hausdorff distance between two paths: how far two drawings of the same shape are apart.
//!
//! ```
//! use pathwarp::{Outline, distance};
//!
//! let circle = Outline::from_svg("M90,50 A40,40 0 1 1 10,50 A40,40 0 1 1 90,50 Z")?;
//! let octagon = Outline::from_svg("M90,50 L78,78 L50,90 L22,78 L10,50 L22,22 L50,10 L78,22 Z")?;
//! let apart = distance::symmetric(&circle, &octagon).unwrap_or_default();
//! // In the middle of each side.
//! assert!((3.0..3.3).contains(&apart), "{apart}");
//! # Ok::<(), pathwarp::Error>(())
//! ```

use crate::outline::{Outline, Seg};
use kurbo::{Point, Rect};

/// Intervals per segment that [`symmetric`] samples.
const PER_SEGMENT: usize = 64;
/// Starting points of the search for the nearest point of a segment.
const STRETCHES: usize = 16;

/// The symmetric Hausdorff distance between two paths: the largest distance from a point of either path to the other.
///
/// Sampled at 65 points per segment, whose nearest points are found by the Gauss–Newton method from 17 starting points per
/// segment. A lower bound, exact up to the movement of the distance between samples. `None` if one of the paths is empty.
#[must_use]
pub fn symmetric(a: &Outline, b: &Outline) -> Option<f64> {
    Some(one_way(a, b)?.max(one_way(b, a)?))
}

/// The largest distance from a point of `from` to `to`.
fn one_way(from: &Outline, to: &Outline) -> Option<f64> {
    let targets: Vec<(Rect, &Seg)> = to.segs().map(|s| (s.bounding_box(), s)).collect();
    let dots: Vec<Point> = to.subpaths.iter().filter(|s| s.segs.is_empty()).map(|s| s.start).collect();
    if targets.is_empty() && dots.is_empty() {
        return None;
    }
    let samples = from.segs().flat_map(|s| (0..=PER_SEGMENT).map(|i| s.eval(i as f64 / PER_SEGMENT as f64)));
    let alone = from.subpaths.iter().filter(|s| s.segs.is_empty()).map(|s| s.start);
    let mut last = 0;
    samples
        .chain(alone)
        .map(|p| {
            let mut best = dots.iter().map(|d| d.distance(p)).fold(f64::INFINITY, f64::min);
            // Neighbouring samples have neighbouring foot points: starting at the last winner prunes nearly all other segments.
            let winner = last;
            let near = targets.get(winner).into_iter();
            for (i, (bounds, seg)) in near.map(|t| (winner, t)).chain(targets.iter().enumerate()) {
                if box_distance(bounds, p) < best {
                    let d = to_segment(seg, p, best);
                    if d < best {
                        (best, last) = (d, i);
                    }
                }
            }
            best
        })
        .reduce(f64::max)
}

fn box_distance(r: &Rect, p: Point) -> f64 {
    let dx = (r.x0 - p.x).max(p.x - r.x1).max(0.0);
    let dy = (r.y0 - p.y).max(p.y - r.y1).max(0.0);
    dx.hypot(dy)
}

/// The distance from `p` to `seg`, or `known` if that is smaller.
fn to_segment(seg: &Seg, p: Point, known: f64) -> f64 {
    let mut best = known;
    for i in 0..=STRETCHES {
        let mut t = i as f64 / STRETCHES as f64;
        let mut d = seg.eval(t).distance(p);
        // Gauss–Newton for the foot point.
        for _ in 0..6 {
            let v = seg.deriv(t);
            let n = v.hypot2();
            if n == 0.0 {
                break;
            }
            let next = (t - (seg.eval(t) - p).dot(v) / n).clamp(0.0, 1.0);
            let nd = seg.eval(next).distance(p);
            if nd >= d {
                break;
            }
            (t, d) = (next, nd);
        }
        best = best.min(d);
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_distances() {
        let path = |d: &str| Outline::from_svg(d).unwrap();
        // Concentric circles; and a line beside a longer one, whose far end has the largest distance.
        let ring = |r: f64| path(&format!("M{r},0 A{r},{r} 0 0 1 -{r},0 A{r},{r} 0 0 1 {r},0 Z"));
        assert!((symmetric(&ring(10.0), &ring(10.5)).unwrap() - 0.5).abs() < 1e-9);
        assert!((symmetric(&path("M0,0 H10"), &path("M0,1 H14")).unwrap() - 17.0_f64.sqrt()).abs() < 1e-12);
        assert!(symmetric(&ring(10.0), &ring(10.0)).unwrap() < 1e-12);
        assert_eq!(symmetric(&ring(1.0), &Outline::default()), None);
    }
}
