//! The proof of a cubic over several segments: each segment is proven against its part of the cubic.

use super::check::parts;
use super::cubic::RunCubic;
use super::run::SegmentRun;
use crate::refit::proof;
use kurbo::{CubicBez, ParamCurve, ParamCurveDeriv, Point};

/// The proven distance of a cubic from the run, which is divided at the foot points of the joints. `feet` are those of its samples.
/// Infinite if nothing can be proven.
pub(super) fn proven(run: &SegmentRun<'_>, c: &RunCubic, feet: &[f64], tolerance: f64) -> Result<f64, Point> {
    let cubic = c.cubic();
    let [first, last] = c.samples;
    let (mut s, mut worst) = (0.0, 0.0f64);
    for (i, [a, b]) in parts(run.per_segment, c.samples) {
        let Some((segment, form)) = run.segments.get(i).and_then(|r| Some((r, r.form.as_ref()?))) else {
            return Ok(f64::INFINITY);
        };
        let next = if b == last { 1.0 } else { foot_point(&cubic, segment.to.p, feet[b - first]) };
        if next <= s {
            return Ok(f64::INFINITY);
        }
        let param = |k: usize| (k - i * run.per_segment) as f64 / run.per_segment as f64;
        let part = cubic.subsegment(s..next);
        worst = worst.max(proof::stretch(&segment.source, form, [param(a), param(b)], &part, tolerance)?);
        if worst > tolerance {
            break;
        }
        s = next;
    }
    Ok(worst)
}

/// The parameter of the point of `c` nearest to `p`, by Newton steps from `s`.
fn foot_point(c: &CubicBez, p: Point, mut s: f64) -> f64 {
    let slope = c.deriv();
    for _ in 0..8 {
        let (r, v) = (c.eval(s) - p, slope.eval(s).to_vec2());
        s = (s - r.dot(v) / (v.hypot2() + f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    }
    s
}
