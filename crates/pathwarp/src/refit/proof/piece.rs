//! The proofs for one piece, in the order of their cost.

use super::form::RationalForm;
use super::nodes;
use super::sampled::SampledProof;
use crate::refit::candidate::Candidate;
use crate::refit::lanes::{Lane, Lanes};
use crate::refit::limits::{LONG_PROOF_ERROR, LONG_PROOF_WITHIN};
use crate::refit::samples::{CHECKED, FITTED};
use crate::refit::source::SourceCurve;
use kurbo::Point;

/// A bound for the distance between candidate and image: at most the tolerance if one of the proofs succeeds; otherwise a
/// larger one, or infinity. `g` and `feet` are those of the fitted and the checked samples, at which `error` was measured.
pub(in crate::refit) fn piece(
    source: &SourceCurve<'_>,
    form: &RationalForm,
    c: &Candidate,
    g: [&Lanes; 2],
    feet: [&Lane; 2],
    [error, tolerance]: [f64; 2],
) -> Result<f64, Point> {
    let mut sampled = SampledProof::new(source, form, c, g, tolerance);
    let identity = sampled.identity()?;
    if identity <= tolerance {
        return Ok(identity);
    }
    let sixteen = sampled.sixteen(feet)?;
    if sixteen <= tolerance {
        return Ok(sixteen);
    }
    let (mut s0, mut s1) = (*feet[0], *feet[1]);
    c.frame.distances(g[0], c.a, c.b, &mut s0, 2);
    c.frame.distances(g[1], c.a, c.b, &mut s1, 2);
    let thirty_two = sampled.thirty_two([&s0, &s1])?;
    if thirty_two <= tolerance {
        return Ok(thirty_two);
    }
    let polynomial = form.below == 0;
    let hopeless = thirty_two > LONG_PROOF_WITHIN * tolerance || error > LONG_PROOF_ERROR * tolerance;
    if polynomial && thirty_two.is_finite() && hopeless {
        return Ok(thirty_two);
    }
    let mut feet = [0.0; 16];
    for i in 0..8 {
        feet[FITTED[i] as usize - 1] = s0[i];
        feet[CHECKED[i] as usize - 1] = s1[i];
    }
    if !polynomial {
        let quick = nodes::quick(source, form, c, &feet)?;
        if quick <= tolerance {
            return Ok(quick);
        }
    }
    nodes::bound(source, form, c, &feet)
}
