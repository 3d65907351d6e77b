//! The proof for an image that is taken for a line.

use super::chebyshev::{ChebyshevTables, SharedTables};
use super::form::{CLEARING, NODES, PHI, RationalForm};
use super::nodes::{QUICK_CLEARING, cleared, rounding};
use crate::refit::candidate::Candidate;
use crate::refit::frame::ChordFrame;
use crate::refit::lanes::Lane;
use crate::refit::source::{BreakPoint, SourceCurve};
use kurbo::{Point, Vec2};

/// A bound for the distance between the image and the line between two break points: the component of D across the line, if
/// the image runs along the line in one direction. Then each point's partner is the point of the image with the same
/// component along the line.
pub(in crate::refit) fn line(
    source: &SourceCurve<'_>,
    form: &RationalForm,
    from: &BreakPoint,
    to: &BreakPoint,
    size: f64,
    tolerance: f64,
) -> Result<f64, Point> {
    let q = to.p - from.p;
    let length = q.hypot();
    let unit = if length > 0.0 { q / length } else { Vec2::ZERO };
    let third = length / 3.0;
    let frame = ChordFrame { q, t0: unit, t1: unit, floor: [0.0; 2], size, home: [third; 2], pull: 0.0 };
    let c = Candidate { t0: from.t, t1: to.t, p0: from.p, frame, a: third, b: third };
    if form.degree + form.below < 24 && form.total(4, QUICK_CLEARING) < 24 {
        let quick = with_nodes::<24, 4, QUICK_CLEARING>(source, form, &c)?;
        if quick <= tolerance {
            return Ok(quick);
        }
    }
    with_nodes::<NODES, PHI, CLEARING>(source, form, &c)
}

fn with_nodes<const N: usize, const P: usize, const V: usize>(
    source: &SourceCurve<'_>,
    form: &RationalForm,
    c: &Candidate,
) -> Result<f64, Point>
where
    ChebyshevTables<N, P>: SharedTables,
{
    let tables = ChebyshevTables::<N, P>::shared();
    let unit = c.frame.t0;
    let (mut across, mut pace, mut w) = ([0.0; N], [0.0; N], [1.0; N]);
    for b in (0..N).step_by(8) {
        let t: Lane = std::array::from_fn(|i| c.t0 + (c.t1 - c.t0) * tables.tau[b + i]);
        if form.below > 0 {
            w[b..b + 8].copy_from_slice(&form.denominators(source, &t));
        }
        for i in 0..8 {
            let (p, d) = source.image(t[i]);
            if !p.is_finite() || !d.is_finite() {
                return Err(source.at(t[i]));
            }
            let k = b + i;
            across[k] = (p - c.p0).cross(unit);
            // W²·g' = G'W − GW' is a polynomial and has the sign of g'.
            pace[k] = d.dot(unit) * (w[k] * w[k]);
        }
    }
    let mut share = 1.0;
    if form.below > 0 {
        let Some(e) = cleared::<N, P, V>(tables, &mut w, form.below + V - 1) else { return Ok(f64::INFINITY) };
        for k in 0..N {
            across[k] *= w[k];
        }
        share = 1.0 - e;
    }
    let degree = (form.degree + form.below).min(N);
    if degree >= N || tables.least(&pace, degree) < 0.0 {
        return Ok(f64::INFINITY);
    }
    let most = across.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    Ok(tables.supremum(&across, &[0.0; N], most, form.total(P, V)) / share + rounding(c))
}
