//! Whole paths, subpath by subpath; long ones in chunks on several threads.
//!
//! **Announced samples.** Calls of some maps are expensive, such as those of another program, but the fitter asks for eight values or one
//! jet at a time. Most of the points are known long before: the nodes and sixteen samples of each segment, the samples of a run to be
//! merged, and those of all parts of a stretch once its break points are placed. They are announced to the cache in front of the map
//! (`map::Gathered`), which asks for them in one batch. They equal the points that the fitter asks for bit by bit, so the result does not
//! depend on the cache. Points that were not announced are asked for singly.

#[cfg(feature = "parallel")]
use super::limits::WORTH_THREADS;
use super::limits::{CHUNK, CHUNK_CORNER, MANY_NODES};
use super::merge::{self, MergeMemory, Merger};
use super::options::Options;
use super::overview::Overview;
use super::report::{PathReport, RefittedPath, SUMMED, SpanReport, reverse};
use super::segment::{Part, SegmentFitter};
use super::shared::{Span, is_reversed};
use super::source::{self, SourceCurve};
use crate::error::GeometryError;
use crate::map::{Class, CreaseKind, Creases, Jet, Map};
use crate::outline::{Outline, Seg, Subpath};
use bezierfit::parts::{CHECKED, FITTED, UNEVEN, spaced};
use bezierfit::{Assurance, Piece, Report};
use kurbo::{Affine, Point};
use std::sync::Arc;

/// Moves control points. Only arcs are approximated, after the map, so that the tolerance holds in the image.
pub(super) fn affine(
    outline: &Outline,
    m: Affine,
    options: &Options,
    out: &mut RefittedPath,
) -> Result<(), GeometryError> {
    outline.segs().try_for_each(finite)?;
    for sub in &outline.subpaths {
        if !(m * sub.start).is_finite() {
            return Err(infinity(sub.start));
        }
        let mut pieces = Vec::with_capacity(sub.segs.len());
        let spans = spans_of(sub, options, out);
        for (_, tolerance, segs) in runs(&spans, options.tolerance, 0, &sub.segs) {
            let before = pieces.len();
            let mut report = PathReport::default();
            for seg in segs {
                affine_segment(seg, m, tolerance, &mut pieces, &mut report)?;
            }
            if !spans.is_empty() {
                report.share = report.max_error / tolerance;
                out.spans.push(SpanReport { pieces: pieces.len() - before, max_error: report.max_error });
            }
            out.report.add(report);
        }
        out.subpath(m * sub.start, &pieces, sub.closed);
    }
    Ok(())
}

fn affine_segment(
    seg: &Seg,
    m: Affine,
    tolerance: f64,
    pieces: &mut Vec<Piece>,
    report: &mut PathReport,
) -> Result<(), GeometryError> {
    let image = seg.transformed(m);
    finite(&image)?;
    match image {
        Seg::Line(l) => pieces.push(Piece::Line(l)),
        Seg::Arc(a) => {
            let (canonical, flipped) = source::canonical(seg);
            let start = pieces.len();
            if let Seg::Arc(c) = canonical.transformed(m) {
                pieces.extend(c.to_cubics(tolerance).map(Piece::Cubic));
            }
            if flipped {
                reverse(&mut pieces[start..]);
            }
            report.add_error(a.cubics_error(a.cubics_needed(tolerance)), Assurance::Certified);
        }
        other => pieces.push(Piece::Cubic(other.to_cubic())),
    }
    Ok(())
}

/// The spans of the next subpath to be written, from the options.
fn spans_of(sub: &Subpath, options: &Options, out: &RefittedPath) -> Vec<Span> {
    let mut left = sub.segs.len();
    let spans = options.spans.iter().skip(out.spans.len()).take_while(|s| {
        let is_unfinished = left > 0;
        left = left.saturating_sub(s.segments);
        is_unfinished
    });
    spans.copied().collect()
}

/// The runs of equal tolerance, with the index of their span, in a part of a subpath whose first segment is `from`. Without spans,
/// `tolerance` holds for all of it.
fn runs<'s>(spans: &[Span], tolerance: f64, from: usize, segs: &'s [Seg]) -> Vec<(usize, f64, &'s [Seg])> {
    if spans.is_empty() {
        return vec![(0, tolerance, segs)];
    }
    let (mut out, mut start) = (Vec::new(), 0_usize);
    for (i, span) in spans.iter().enumerate() {
        let end = start + span.segments;
        let range = start.saturating_sub(from).min(segs.len())..end.saturating_sub(from).min(segs.len());
        if !range.is_empty() {
            out.push((i, span.tolerance, &segs[range]));
        }
        start = end;
    }
    out
}

/// Refits one subpath under a map that is not affine.
///
/// Long subpaths are divided into chunks, which are refitted on all threads. The chunks depend on the subpath alone, so the result
/// does not depend on the number of threads.
pub(super) fn subpath(
    sub: &Subpath,
    map: &dyn Map,
    creases: &Creases,
    (options, announced): (&Options, bool),
    memory: &mut MergeMemory,
    out: &mut RefittedPath,
) -> Result<(), GeometryError> {
    sub.segs.first().map_or(Ok(()), finite)?;
    let start = map.jet(sub.start);
    if !creases.defined_at(sub.start) || !start.is_finite() {
        return Err(infinity(sub.start));
    }
    let projective = matches!(map.class(), Class::Projective(_));
    let work = map.work();
    // The values at the nodes.
    options.budget.spend(work * sub.segs.len() as f64).map_err(GeometryError::Limit)?;
    let spans = spans_of(sub, options, out);
    let refit_chunk = |from: usize, segs: &[Seg], memory: &mut MergeMemory| {
        if !announced {
            announce(&[segs], map, creases, options);
        }
        let mut all = Vec::new();
        for (span, tolerance, segs) in runs(&spans, options.tolerance, from, segs) {
            let (options, degree) = (&options.clone().with_tolerance(tolerance), map.rational_degree());
            let overview = if degree.is_none() { Overview::new(map, segs) } else { None };
            let overview = overview.as_ref();
            let fitter = SegmentFitter { map, projective, degree, creases, work, options, overview };
            let is_first = from == 0 && all.is_empty();
            let (node, jet) = if is_first { (sub.start, start) } else { (segs[0].start(), map.jet(segs[0].start())) };
            let nodes = NodeJets { fitter: &fitter, jets: [jet; 2], node, last: 0 };
            let is_ring = sub.closed && segs.len() == sub.segs.len();
            let (pieces, found) = if options.nodes.merges() {
                refit_merged(&fitter, (segs, is_ring), nodes, memory)?
            } else {
                refit_singly(&fitter, segs, nodes)?
            };
            let mut report = PathReport::default();
            report.add_pieces(found);
            report.share = report.max_error / tolerance;
            if !spans.is_empty() && report.max_error > tolerance * (1.0 + SUMMED) && report.unresolved.is_empty() {
                report.unresolved.extend(segs.first().map(Seg::start));
            }
            all.push((span, pieces, report));
        }
        Ok::<_, GeometryError>(all)
    };
    let parts = if sub.segs.len() <= CHUNK {
        vec![refit_chunk(0, &sub.segs, memory)?]
    } else {
        let known = memory.known();
        let alone = |from: usize, segs: &[Seg]| refit_chunk(from, segs, &mut MergeMemory::new(Arc::clone(&known)));
        in_parallel(&chunks(&sub.segs, options), alone)?
    };
    let (mut pieces, first) = (Vec::new(), out.spans.len());
    out.spans.extend(spans.iter().map(|_| SpanReport { pieces: 0, max_error: 0.0 }));
    for (span, more, report) in parts.into_iter().flatten() {
        if let Some(s) = out.spans.get_mut(first + span) {
            s.pieces += more.len();
            s.max_error = s.max_error.max(report.max_error);
        }
        out.report.add(report);
        if pieces.is_empty() { pieces = more } else { pieces.extend(more) }
    }
    // Segments beyond the limit were not fitted.
    options.budget.spend(0.0).map_err(GeometryError::Limit)?;
    out.subpath(pieces.first().map_or(start.p, Piece::start), &pieces, sub.closed);
    Ok(())
}

/// Announces the samples of a whole path, if it is short. A longer one is announced chunk by chunk. Returns `true` if nothing is left to
/// be announced.
pub(super) fn announce_short(outline: &Outline, map: &dyn Map, creases: &Creases, options: &Options) -> bool {
    if !map.prefers_batches() {
        return true;
    }
    let is_short = outline.segs().count() <= CHUNK;
    if is_short {
        let subpaths: Vec<&[Seg]> = outline.subpaths.iter().map(|s| s.segs.as_slice()).collect();
        announce(&subpaths, map, creases, options);
    }
    is_short
}

/// Announces the samples for the refit of these runs of segments, to a map that prefers batches.
fn announce(runs: &[&[Seg]], map: &dyn Map, creases: &Creases, options: &Options) {
    announce_segments(runs.iter().copied().flatten(), map, options);
    if options.nodes.merges() && creases.items().iter().all(|c| c.kind == CreaseKind::Edge) {
        merge::announce(runs, map, options);
    }
}

/// The pieces of consecutive segments, and their report.
type Refitted = Result<(Vec<Piece>, Report), GeometryError>;

/// Refits segments one by one.
fn refit_singly(fitter: &SegmentFitter<'_>, segs: &[Seg], mut nodes: NodeJets<'_>) -> Refitted {
    let (mut pieces, mut report) = (Vec::with_capacity(segs.len() + segs.len() / 2), Report::default());
    for seg in segs {
        let ends = nodes.next(seg)?;
        fitter.fit(seg, ends, &mut pieces, &mut report).map_err(|e| infinity(e.at))?;
    }
    Ok((pieces, report))
}

/// Refits segments, with fewer pieces across smooth joints. Chains of shared segments are refitted separately, in one direction. `is_ring`
/// is `true` if the segments are a whole closed subpath.
fn refit_merged(
    fitter: &SegmentFitter<'_>,
    (segs, is_ring): (&[Seg], bool),
    mut nodes: NodeJets<'_>,
    memory: &mut MergeMemory,
) -> Refitted {
    let (mut parts, mut chains) = (Vec::with_capacity(segs.len()), Vec::new());
    let shared = &fitter.options.shared;
    for chain in segs.chunk_by(|a, b| shared.continues_chain(a, b)) {
        let is_shared = shared.contains(&chain[0]);
        for seg in chain {
            let ends = nodes.next(seg)?;
            fitter.parts(seg, ends, is_shared && matches!(seg, Seg::Arc(_)), &mut parts).map_err(|e| infinity(e.at))?;
        }
        chains.push((parts.len(), is_shared.then(|| is_reversed(chain))));
    }
    for i in 1..parts.len() {
        let (before, after) = parts.split_at_mut(i);
        Part::join(&mut before[i - 1], &mut after[0]);
    }
    let count = parts.len();
    let (mut pieces, mut report, mut from) = (Vec::with_capacity(count), Report::default(), 0);
    for (to, reversed) in chains {
        let chain = &mut parts[from..to];
        if reversed == Some(true) {
            Part::reverse_all(chain);
        }
        let (mut more, mut found) = match reversed {
            None if is_ring && chain.len() == count && fitter.options.nodes.are_placed() => {
                merge_ring(fitter, chain, memory)?
            }
            None => merge_parts(fitter, (chain, false), memory)?,
            // The shapes of other paths may be known here, but not on the other side of the chain.
            Some(_) => merge_parts(fitter, (chain, false), &mut MergeMemory::default())?,
        };
        if reversed == Some(true) {
            reverse(&mut more);
            found.pieces.reverse();
        }
        report.add(&found);
        from = to;
        if pieces.is_empty() { pieces = more } else { pieces.extend(more) }
    }
    Ok((pieces, report))
}

/// Merges the parts of a closed subpath from its first corner on: its start need not be a node. The result begins at the nearest node.
fn merge_ring(fitter: &SegmentFitter<'_>, parts: &mut [Part], memory: &mut MergeMemory) -> Refitted {
    let start = parts[0].jets[0].p;
    let before = |i: usize| if i == 0 { parts.len() } else { i } - 1;
    let corner = (0..parts.len()).find(|&i| !merge::joins(&parts[before(i)], &parts[i]));
    parts.rotate_left(corner.unwrap_or(0));
    let (mut pieces, mut report) = merge_parts(fitter, (parts, corner.is_none()), memory)?;
    let distance = |i: &usize| pieces[*i].start().distance_squared(start);
    let nearest = (0..pieces.len()).min_by(|i, j| distance(i).total_cmp(&distance(j))).unwrap_or(0);
    pieces.rotate_left(nearest);
    if report.pieces.len() == pieces.len() {
        report.pieces.rotate_left(nearest);
    }
    Ok((pieces, report))
}

/// Merges the parts of one chain; `is_ring` is `true` for a closed subpath without corners.
fn merge_parts(fitter: &SegmentFitter<'_>, (parts, is_ring): (&[Part], bool), memory: &mut MergeMemory) -> Refitted {
    let found = Merger::new(fitter, (parts, is_ring), memory).merged().map_err(|e| infinity(e.at))?;
    // Affine images keep their control points, unless these are far too many: flattened curves, outlines of dashes.
    if !parts.is_empty() && parts.len() <= MANY_NODES * found.0.len() && parts.iter().all(Part::is_affine) {
        let (mut pieces, mut report) = (Vec::with_capacity(parts.len()), Report::default());
        parts.iter().try_for_each(|p| fitter.fit_part(p, &mut pieces, &mut report)).map_err(|e| infinity(e.at))?;
        return Ok((pieces, report));
    }
    Ok(found)
}

/// Cuts a long subpath into chunks that are refitted separately: of [`CHUNK`] segments, or up to the next corner after them if
/// pieces are merged. Each comes with the index of its first segment.
fn chunks<'s>(segs: &'s [Seg], options: &Options) -> Vec<(usize, &'s [Seg])> {
    let is_corner = |w: &[Seg]| {
        let (into, away) = (w[0].deriv(1.0), w[1].deriv(0.0));
        into.cross(away).abs() >= CHUNK_CORNER * into.dot(away)
            && !(options.shared.contains(&w[0]) && options.shared.continues_chain(&w[0], &w[1]))
    };
    let (mut out, mut rest) = (Vec::new(), segs);
    while rest.len() > CHUNK {
        let more = if options.nodes.merges() { rest[CHUNK - 1..].windows(2).position(is_corner) } else { Some(0) };
        let (chunk, after) = rest.split_at(more.map_or(rest.len(), |n| CHUNK + n));
        out.push((segs.len() - rest.len(), chunk));
        rest = after;
    }
    if !rest.is_empty() {
        out.push((segs.len() - rest.len(), rest));
    }
    out
}

/// The jets at the ends of one segment after the other.
struct NodeJets<'a> {
    fitter: &'a SegmentFitter<'a>,
    /// The jets at the last two nodes; each segment's last jet is the next one's first.
    jets: [Jet; 2],
    /// The last node.
    node: Point,
    /// The index of its jet.
    last: usize,
}

impl NodeJets<'_> {
    #[inline(always)]
    fn next(&mut self, seg: &Seg) -> Result<[&Jet; 2], GeometryError> {
        finite(seg)?;
        let SegmentFitter { map, creases, .. } = self.fitter;
        if let Some(at) = creases.first_undefined(seg) {
            return Err(infinity(at));
        }
        let (start, end) = (self.last, 1 - self.last);
        if seg.start() != self.node {
            self.jets[start] = map.jet(seg.start());
        }
        (self.node, self.last) = (seg.end(), end);
        self.jets[end] = map.jet(self.node);
        let [first, last] = [&self.jets[start], &self.jets[end]];
        if first.is_finite() && last.is_finite() {
            Ok([first, last])
        } else {
            Err(infinity(if first.is_finite() { seg.end() } else { seg.start() }))
        }
    }
}

/// The name of a shape in errors, until its owner replaces it.
const PATH: &str = "path";

fn finite(seg: &Seg) -> Result<(), GeometryError> {
    if seg.is_finite() { Ok(()) } else { Err(GeometryError::NotFinite { shape: PATH.into(), at: seg.start() }) }
}

fn infinity(at: Point) -> GeometryError {
    GeometryError::Infinity { shape: PATH.into(), at }
}

/// Announces the nodes and the samples of every segment.
pub(super) fn announce_segments<'a>(segs: impl Iterator<Item = &'a Seg>, map: &dyn Map, options: &Options) {
    let degree = map.rational_degree();
    let (mut points, mut jets) = (Vec::new(), Vec::new());
    for seg in segs.filter(|s| s.is_finite()) {
        jets.extend([seg.start(), seg.end()]);
        let (canonical, _) = source::canonical(seg);
        let source = SourceCurve::for_proof(&canonical, map, degree, options.certify);
        points.extend([&FITTED, &CHECKED, &UNEVEN].iter().flat_map(|set| source.sampled(&spaced(0.0, 1.0, set))));
    }
    // Each segment begins where the one before ends.
    jets.dedup();
    map.prepare(&points, &jets);
}

/// Applies `f` to each chunk with the index of its first item. Returns the first error, in the chunks' order.
pub(super) fn in_parallel<T: Sync, R: Send, E: Send>(
    chunks: &[(usize, &[T])],
    f: impl Fn(usize, &[T]) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E> {
    #[cfg(feature = "parallel")]
    if chunks.iter().map(|(_, c)| c.len()).sum::<usize>() >= WORTH_THREADS {
        use rayon::prelude::*;
        let results: Vec<Result<R, E>> = chunks.par_iter().map(|(i, c)| f(*i, c)).collect();
        return results.into_iter().collect();
    }
    chunks.iter().map(|(i, c)| f(*i, c)).collect()
}
