//! Whole paths, subpath by subpath.

use super::merge::{FittedSegments, Merger, may_be_smooth};
use super::options::Options;
use super::piece::{FittedPiece, PathWriter, reverse};
use super::report::Assurance;
use super::segment::SegmentFitter;
use super::split;
use crate::budget::Limit;
use crate::error::GeometryError;
use crate::map::{Class, CreaseKind, Creases, Map};
use crate::outline::{Outline, Seg, Subpath};
use kurbo::{Affine, Line, Point};

/// Number of evaluations of the map after which they are counted in the budget.
const COUNTED_TOGETHER: usize = 10_000;

/// Moves control points. Only arcs are approximated, after the map, so that the tolerance holds in the image.
pub(super) fn affine(
    outline: &Outline,
    m: Affine,
    options: &Options,
    out: &mut PathWriter,
) -> Result<(), GeometryError> {
    outline.segs().try_for_each(finite)?;
    for sub in &outline.subpaths {
        let mut pieces = Vec::with_capacity(sub.segs.len());
        for seg in &sub.segs {
            match seg.transformed(m) {
                Seg::Line(l) => pieces.push(FittedPiece::Line(l)),
                Seg::Arc(a) => {
                    let (canonical, flipped) = split::canonical(seg);
                    let start = pieces.len();
                    if let Seg::Arc(c) = canonical.transformed(m) {
                        pieces.extend(c.to_cubics(options.tolerance).map(FittedPiece::Cubic));
                    }
                    if flipped {
                        reverse(&mut pieces[start..]);
                    }
                    out.report.add_error(a.cubics_error(a.cubics_needed(options.tolerance)), Assurance::Certified);
                }
                other => pieces.push(FittedPiece::Cubic(other.to_cubic())),
            }
        }
        out.subpath(m * sub.start, &pieces, sub.closed);
    }
    Ok(())
}

/// Refits one subpath under a map that is not affine.
pub(super) fn subpath(
    sub: &Subpath,
    map: &dyn Map,
    creases: &Creases,
    options: &Options,
    out: &mut PathWriter,
) -> Result<(), GeometryError> {
    let projective = matches!(map.class(), Class::Projective(_));
    sub.segs.first().map_or(Ok(()), finite)?;
    // The jets at the last two nodes; each segment's last is the next one's first.
    let mut jets = [map.jet(sub.start); 2];
    let mut at = sub.start;
    if !creases.defined_at(at) || !jets[0].is_finite() {
        return Err(infinity(at));
    }
    let start = jets[0].p;
    let mut pieces = Vec::with_capacity(sub.segs.len() + sub.segs.len() / 2);
    // The index of each segment's first piece.
    let mut bounds = Vec::with_capacity(if options.merge { sub.segs.len() + 1 } else { 0 });
    bounds.push(0);
    // Joints of the image that may be smooth, by the index of the segment that begins there.
    let mut smooth = Vec::with_capacity(bounds.capacity());
    let fitter = SegmentFitter { map, degree: map.rational_degree(), creases, options };
    let mut counted = out.report.evaluations;
    for (i, seg) in sub.segs.iter().enumerate() {
        finite(seg)?;
        if let Some(at) = creases.first_undefined(seg) {
            return Err(infinity(at));
        }
        let here = i % 2;
        if seg.start() != at {
            jets[here] = map.jet(seg.start());
        }
        if options.merge {
            smooth.push(i > 0 && may_be_smooth(&sub.segs[i - 1], seg, &jets[here]));
        }
        at = seg.end();
        jets[1 - here] = map.jet(at);
        let [first, last] = [&jets[here], &jets[1 - here]];
        if !first.is_finite() || !last.is_finite() {
            return Err(infinity(if first.is_finite() { at } else { seg.start() }));
        }
        if projective && matches!(seg, Seg::Line(_)) {
            pieces.push(FittedPiece::Line(Line::new(first.p, last.p)));
        } else {
            fitter.fit(seg, [first, last], &mut pieces, &mut out.report).map_err(infinity)?;
        }
        if options.merge {
            bounds.push(pieces.len());
        }
        let evaluations = out.report.evaluations;
        if evaluations >= counted + COUNTED_TOGETHER || i + 1 == sub.segs.len() {
            let new = (evaluations - counted) as u64;
            options.budget.spend_cut(Limit::Evaluations, new).map_err(GeometryError::Limit)?;
            counted = evaluations;
        }
    }
    // Across other creases than the domain's edge the image has corners.
    let uncreased = creases.items().iter().all(|c| c.kind == CreaseKind::Edge);
    if options.merge && uncreased {
        let merger = Merger { map, degree: fitter.degree, options };
        let fitted = FittedSegments { segs: &sub.segs, smooth: &smooth, pieces: &pieces, bounds: &bounds };
        pieces = merger.merged(&fitted, &mut out.report).map_err(infinity)?;
    }
    out.subpath(start, &pieces, sub.closed);
    Ok(())
}

/// Name of a shape in errors, until its owner replaces it.
const PATH: &str = "path";

fn finite(seg: &Seg) -> Result<(), GeometryError> {
    if seg.is_finite() { Ok(()) } else { Err(GeometryError::NotFinite { shape: PATH.into(), at: seg.start() }) }
}

fn infinity(at: Point) -> GeometryError {
    GeometryError::Infinity { shape: PATH.into(), at }
}
