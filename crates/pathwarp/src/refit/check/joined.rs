//! The check of a cubic across joints: the error is smooth along each segment, and may have corners at the joints.

use super::probe::probe;
use crate::refit::candidate::Candidate;
use crate::refit::curve::{ImageCurve, PartSamples};
use crate::refit::lanes::{Lane, largest};
use crate::refit::limits::{FOOT_ROUNDING, PEAK_FACTOR, PEAK_NEAR};
use crate::refit::peaks::{parabola_peak, predicted_end_peak, predicted_peak};
use crate::refit::resolution::turns_little;
use crate::refit::samples::Evenly;
use kurbo::{Point, Vec2};

/// The distance between the candidate and the image, by the samples of each smooth part and closer ones where it may exceed
/// `enough` between them. `None` if the foot points do not advance along the cubic or it may turn by more than 60° from one to the
/// next, so that the samples may have missed something.
pub(in crate::refit) fn joined(
    source: &impl ImageCurve,
    c: &Candidate,
    feet: &Evenly,
    parts: &[PartSamples],
    enough: f64,
) -> Result<Option<f64>, Point> {
    let power = c.frame.power(c.a, c.b);
    let mut last = 0.0;
    let mut worst = 0.0f64;
    // Signed distances at the ends of the intervals between samples, and their places on the piece.
    let (mut errors, mut taus) = (vec![0.0], vec![0.0]);
    for part in parts {
        errors.drain(..errors.len() - 1);
        taus.drain(..taus.len() - 1);
        for t in part {
            let tau = t.map(|t| c.tau(t));
            let p = probe(source, c, feet, &tau, 3)?;
            worst = worst.max(largest(&p.squares).sqrt());
            let signed = c.frame.signed_distances(&p.g, c.a, c.b, &p.s, &p.squares);
            errors.extend(signed);
            taus.extend(tau);
            for s in p.s {
                if s < last - FOOT_ROUNDING || !turns_little_between(&power, [last, s]) {
                    return Ok(None);
                }
                last = s;
            }
        }
        if worst > enough {
            return Ok(Some(worst));
        }
        let end = errors.len() - 1;
        for i in 0..=end {
            let (before, after) = (i.max(1) - 1, (i + 1).min(end));
            let peak = if i == 0 {
                predicted_end_peak([errors[0], errors[1], errors[2]], PEAK_FACTOR)
            } else if i == end {
                predicted_end_peak([errors[end], errors[end - 1], errors[end - 2]], PEAK_FACTOR)
            } else {
                predicted_peak([errors[before], errors[i], errors[after]], PEAK_FACTOR)
            };
            if peak > enough {
                worst = worst.max(closely(source, c, feet, [taus[before], taus[after]])?);
            }
        }
    }
    Ok(turns_little_between(&power, [last, 1.0]).then_some(worst))
}

/// Returns `true` if the cubic C(s) = ((c₃s + c₂)s + c₁)s turns little between two parameters: if the three control vectors of its
/// derivative there are pairwise less than 60° apart. The slopes at both ends alone would not see a hook between them.
fn turns_little_between([c1, c2, c3]: &[Vec2; 3], [s, t]: [f64; 2]) -> bool {
    let control = |u: f64, v: f64| *c1 + *c2 * (u + v) + *c3 * (3.0 * u * v);
    let (first, middle, last) = (control(s, s), control(s, t), control(t, t));
    turns_little(first, middle) && turns_little(middle, last) && turns_little(first, last)
}

/// The largest distance between two places, by eight samples and the parabolas through them.
fn closely(source: &impl ImageCurve, c: &Candidate, feet: &Evenly, [a, b]: [f64; 2]) -> Result<f64, Point> {
    let tau: Lane = std::array::from_fn(|i| a + (b - a) * (i as f64 + 1.0) / 9.0);
    let errors = probe(source, c, feet, &tau, 3)?.squares.map(f64::sqrt);
    let top = largest(&errors);
    let tops = errors.windows(3).filter(|w| w[1] >= PEAK_NEAR * top && w[1] >= w[0] && w[1] >= w[2]);
    Ok(tops.map(|w| parabola_peak(w[0], w[1], w[2])).fold(top, f64::max))
}
