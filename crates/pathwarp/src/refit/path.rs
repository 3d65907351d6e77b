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
use super::shared::{Span, is_turned};
use super::source;
use super::source::SourceCurve;
use crate::error::GeometryError;
use crate::map::{Class, CreaseKind, Creases, Jet, Map};
use crate::outline::{Outline, Seg, Subpath};
use bezierfit::parts::{CHECKED, FITTED, UNEVEN, spaced};
use bezierfit::{Assurance, NotFinite, Piece, Report};
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
    let own = options.spans.iter().skip(out.spans.len()).take_while(|s| {
        let some = left > 0;
        left = left.saturating_sub(s.segments);
        some
    });
    own.copied().collect()
}

/// The runs of equal tolerance, with the index of their span, in a part of a subpath whose first segment is `from`.
fn runs<'s>(spans: &[Span], all: f64, from: usize, segs: &'s [Seg]) -> Vec<(usize, f64, &'s [Seg])> {
    if spans.is_empty() {
        return vec![(0, all, segs)];
    }
    let (mut out, mut start) = (Vec::new(), 0_usize);
    for (i, span) in spans.iter().enumerate() {
        let end = start + span.segments;
        let inside = start.saturating_sub(from).min(segs.len())..end.saturating_sub(from).min(segs.len());
        if !inside.is_empty() {
            out.push((i, span.tolerance, &segs[inside]));
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
    let refitted = |from: usize, segs: &[Seg], memory: &mut MergeMemory| {
        if !announced {
            announce(&[segs], map, creases, options);
        }
        let mut all = Vec::new();
        for (span, tolerance, segs) in runs(&spans, options.tolerance, from, segs) {
            let own;
            let options = if tolerance == options.tolerance {
                options
            } else {
                own = options.clone().with_tolerance(tolerance);
                &own
            };
            let degree = map.rational_degree();
            let overview = if degree.is_none() { Overview::new(map, segs) } else { None };
            let overview = overview.as_ref();
            let fitter = SegmentFitter { map, projective, degree, creases, work, options, overview };
            let first = from == 0 && all.is_empty();
            let nodes = if first { Nodes::new(&fitter, sub.start, start) } else { Nodes::inside(&fitter, segs) };
            let ring = sub.closed && segs.len() == sub.segs.len();
            let refit = if options.nodes.merges() {
                merged(&fitter, (segs, ring), nodes, memory)
            } else {
                unmerged(&fitter, segs, nodes)
            };
            let (pieces, found) = refit?;
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
        vec![refitted(0, &sub.segs, memory)?]
    } else {
        let known = memory.known();
        let alone = |from: usize, segs: &[Seg]| refitted(from, segs, &mut MergeMemory::new(Arc::clone(&known)));
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
fn unmerged(fitter: &SegmentFitter<'_>, segs: &[Seg], mut nodes: Nodes<'_>) -> Refitted {
    let (mut pieces, mut report) = (Vec::with_capacity(segs.len() + segs.len() / 2), Report::default());
    for seg in segs {
        let ends = nodes.next(seg)?;
        fitter.fit(seg, ends, &mut pieces, &mut report).map_err(lost)?;
    }
    Ok((pieces, report))
}

/// Refits segments, with fewer pieces across smooth joints. Chains of shared segments are refitted separately, in one direction. `ring` is
/// `true` if the segments are a whole closed subpath.
fn merged(
    fitter: &SegmentFitter<'_>,
    (segs, ring): (&[Seg], bool),
    mut nodes: Nodes<'_>,
    memory: &mut MergeMemory,
) -> Refitted {
    let (mut parts, mut chains) = (Vec::with_capacity(segs.len()), Vec::new());
    let shared = &fitter.options.shared;
    for chain in segs.chunk_by(|a, b| shared.goes_on(a, b)) {
        let is_shared = shared.contains(&chain[0]);
        for seg in chain {
            let ends = nodes.next(seg)?;
            fitter.parts(seg, ends, is_shared && matches!(seg, Seg::Arc(_)), &mut parts).map_err(lost)?;
        }
        chains.push((parts.len(), is_shared.then(|| is_turned(chain))));
    }
    for i in 1..parts.len() {
        let (before, after) = parts.split_at_mut(i);
        Part::join(&mut before[i - 1], &mut after[0]);
    }
    let whole = parts.len();
    let (mut pieces, mut report, mut from) = (Vec::with_capacity(whole), Report::default(), 0);
    for (to, turned) in chains {
        let own = &mut parts[from..to];
        let (mut more, mut found) = match turned {
            None if ring && own.len() == whole && fitter.options.nodes.are_placed() => ringed(fitter, own, memory)?,
            None => merged_parts(fitter, (own, false), memory)?,
            Some(turned) => {
                if turned {
                    own.reverse();
                    own.iter_mut().for_each(Part::reverse);
                }
                // The shapes of other paths may be known here, but not on the other side of the chain.
                merged_parts(fitter, (own, false), &mut MergeMemory::default())?
            }
        };
        if turned == Some(true) {
            reverse(&mut more);
            found.pieces.reverse();
        }
        report.add(&found);
        if pieces.is_empty() {
            pieces = more;
        } else {
            pieces.extend(more);
        }
        from = to;
    }
    Ok((pieces, report))
}

/// Merges the parts of a closed subpath from its first corner on: its start need not be a node. The result begins at the nearest node.
fn ringed(fitter: &SegmentFitter<'_>, parts: &mut [Part], memory: &mut MergeMemory) -> Refitted {
    let start = parts[0].jets[0].p;
    let before = |i: usize| if i == 0 { parts.len() } else { i } - 1;
    let corner = (0..parts.len()).find(|&i| !merge::joins(&parts[before(i)], &parts[i]));
    parts.rotate_left(corner.unwrap_or(0));
    let (mut pieces, mut report) = merged_parts(fitter, (parts, corner.is_none()), memory)?;
    let far = |i: &usize| pieces[*i].start().distance_squared(start);
    let nearest = (0..pieces.len()).min_by(|i, j| far(i).total_cmp(&far(j))).unwrap_or(0);
    pieces.rotate_left(nearest);
    if report.pieces.len() == pieces.len() {
        report.pieces.rotate_left(nearest);
    }
    Ok((pieces, report))
}

fn merged_parts(fitter: &SegmentFitter<'_>, (parts, ring): (&[Part], bool), memory: &mut MergeMemory) -> Refitted {
    let found = Merger::new(fitter, (parts, ring), memory).merged().map_err(lost)?;
    // Affine images keep their control points, unless these are far too many: flattened curves, outlines of dashes.
    if !parts.is_empty() && parts.len() <= MANY_NODES * found.0.len() && parts.iter().all(Part::is_affine) {
        let (mut pieces, mut report) = (Vec::with_capacity(parts.len()), Report::default());
        parts.iter().try_for_each(|p| fitter.fit_part(p, &mut pieces, &mut report)).map_err(lost)?;
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
            && !(options.shared.contains(&w[0]) && options.shared.goes_on(&w[0], &w[1]))
    };
    let mut out = Vec::new();
    let mut rest = segs;
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
struct Nodes<'a> {
    fitter: &'a SegmentFitter<'a>,
    /// The jets at the last two nodes; each segment's last jet is the next one's first.
    jets: [Jet; 2],
    /// The last node.
    at: Point,
    odd: bool,
}

impl<'a> Nodes<'a> {
    /// Starts at the node `at`, which has this jet.
    fn new(fitter: &'a SegmentFitter<'a>, at: Point, jet: Jet) -> Self {
        Self { fitter, jets: [jet; 2], at, odd: false }
    }

    /// Starts at the first of `segs`.
    fn inside(fitter: &'a SegmentFitter<'a>, segs: &[Seg]) -> Self {
        let at = segs.first().map_or(Point::ORIGIN, Seg::start);
        Self::new(fitter, at, fitter.map.jet(at))
    }

    #[inline(always)]
    fn next(&mut self, seg: &Seg) -> Result<[&Jet; 2], GeometryError> {
        finite(seg)?;
        let SegmentFitter { map, creases, .. } = self.fitter;
        if let Some(at) = creases.first_undefined(seg) {
            return Err(infinity(at));
        }
        let here = usize::from(self.odd);
        if seg.start() != self.at {
            self.jets[here] = map.jet(seg.start());
        }
        self.at = seg.end();
        self.jets[1 - here] = map.jet(self.at);
        self.odd = !self.odd;
        let [first, last] = [&self.jets[here], &self.jets[1 - here]];
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

fn lost(e: NotFinite) -> GeometryError {
    infinity(e.at)
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
