//! Back to Béziers: the image of a path under a map, as lines and cubics within a stated distance.
//!
//! One entry, [`warp_path`]. Affine maps move control points; elsewhere each source segment is taken in its canonical direction,
//! split where the map is not smooth (`split`), sampled eight places at a time (`source`), fitted by cubics with the right end
//! tangents and the best handle lengths (`fit`, `step`), over as few stretches as the tolerance allows (`breaks`), each looked at
//! closely where its samples may not tell all (`verify`), and proven where map and segment are quotients of polynomials
//! (`sampled`, `certify`). Pieces may be merged across smooth joints (`merge`).

mod breaks;
// Loops over eight lanes run by index through several arrays at once, the form the compiler turns into vectors.
#[allow(clippy::needless_range_loop)]
mod certify;
#[allow(clippy::needless_range_loop)]
mod chebyshev;
#[allow(clippy::needless_range_loop)]
mod fit;
#[allow(clippy::needless_range_loop)]
mod merge;
#[allow(clippy::needless_range_loop)]
mod sampled;
#[allow(clippy::needless_range_loop)]
mod samples;
mod shared;
#[allow(clippy::needless_range_loop)]
mod source;
mod split;
#[allow(clippy::needless_range_loop)]
mod step;
#[allow(clippy::needless_range_loop)]
mod verify;

pub use shared::SharedEdges;

use crate::error::GeometryError;
use crate::map::{Class, CreaseKind, Creases, Jet, Map};
use crate::outline::{Outline, Seg, Subpath};
use certify::Algebra;
use kurbo::{Affine, BezPath, CubicBez, Line, Point};
use source::{Curve, End, Source};
use std::sync::Arc;

/// How a path is refitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// The largest allowed distance, in root user units, between the true image and the output, measured both ways.
    pub tolerance: f64,
    /// Prove the bound where the map allows it, instead of checking it densely.
    pub certify: bool,
    /// Join consecutive pieces across smooth joints where that saves nodes.
    pub merge: bool,
    /// Edges that merging leaves alone, so that neighbours stay watertight.
    pub shared: Arc<SharedEdges>,
}

impl Options {
    /// Checked against `tolerance`, without merging.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        Self { tolerance, certify: false, merge: false, shared: Arc::default() }
    }
}

/// How the reported error is known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Assurance {
    /// Sampled densely; true up to what happens between samples.
    Checked,
    /// A proven bound.
    Certified,
    /// No approximation was made; the error is rounding.
    Exact,
}

/// What refitting a path did.
#[derive(Debug, Clone, PartialEq)]
pub struct PathReport {
    /// Segments in the source, closing lines included.
    pub segments_in: usize,
    /// Segments in the output, closing lines included.
    pub segments_out: usize,
    /// The largest distance between true image and output, root user units.
    pub max_error: f64,
    /// How `max_error` is known: the weakest of all segments.
    pub assurance: Assurance,
    /// Places in the source where the work budget ended before the tolerance was met.
    pub over_budget: Vec<Point>,
}

/// A warped path.
#[derive(Debug, Clone, PartialEq)]
pub struct Warped {
    /// The image.
    pub path: BezPath,
    /// What was done.
    pub report: PathReport,
}

/// The image of `outline` under `map`, within `options.tolerance`.
///
/// Sub-paths keep their order, direction and closedness; source nodes stay nodes; smooth joints stay smooth. Affine maps
/// move control points (arcs become cubics within the tolerance); under projective maps lines stay lines.
///
/// # Errors
/// [`GeometryError::Infinity`] if the path meets a place where the map is undefined or not finite,
/// [`GeometryError::NotFinite`] if the path itself has such coordinates. The shape's name in them is "path"; see
/// [`GeometryError::on_shape`].
///
/// ```
/// use pathwarp::{Outline, map::Formula, map::Real, refit};
///
/// struct Wave;
/// impl Formula for Wave {
///     fn f<S: Real>(&self, x: S, y: S) -> (S, S) { (x, y + (x / 20.0).sin() * 5.0) }
/// }
/// let square = Outline::from_svg("M0 0H100V100H0Z").unwrap();
/// let warped = refit::warp_path(&square, &Wave, &refit::Options::new(0.01)).unwrap();
/// assert!(warped.report.max_error <= 0.01);
/// ```
pub fn warp_path(outline: &Outline, map: &dyn Map, options: &Options) -> Result<Warped, GeometryError> {
    let mut out = Output::default();
    if let Class::Affine(m) = map.class() {
        outline.segs().try_for_each(finite)?;
        affine(outline, m, options, &mut out);
    } else {
        let mut creases = Creases::default();
        map.creases(&mut creases);
        for sub in &outline.subpaths {
            warp_subpath(sub, map, &creases, options, &mut out)?;
        }
    }
    out.report.segments_in = outline.segs().count();
    Ok(Warped { path: out.path, report: out.report })
}

/// What a shape is called until its owner names it.
const PATH: &str = "path";

/// One output piece.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Piece {
    Line(Line),
    Cubic(CubicBez),
}

impl Piece {
    fn reversed(self) -> Self {
        match self {
            Self::Line(l) => Self::Line(Line::new(l.p1, l.p0)),
            Self::Cubic(c) => Self::Cubic(CubicBez::new(c.p3, c.p2, c.p1, c.p0)),
        }
    }
}

#[derive(Debug)]
struct Output {
    path: BezPath,
    report: PathReport,
}

impl Default for Output {
    fn default() -> Self {
        let report = PathReport {
            segments_in: 0,
            segments_out: 0,
            max_error: 0.0,
            assurance: Assurance::Exact,
            over_budget: Vec::new(),
        };
        Self { path: BezPath::new(), report }
    }
}

impl Output {
    fn note(&mut self, error: f64, assurance: Assurance) {
        self.report.max_error = self.report.max_error.max(error);
        self.report.assurance = self.report.assurance.min(assurance);
    }

    /// Writes a subpath; a closed one's last line is drawn by the close command.
    fn subpath(&mut self, start: Point, pieces: &[Piece], closed: bool) {
        self.report.segments_out += pieces.len();
        self.path.move_to(start);
        let by_close = closed && matches!(pieces.last(), Some(Piece::Line(_)));
        for p in &pieces[..pieces.len() - usize::from(by_close)] {
            match p {
                Piece::Line(l) => self.path.line_to(l.p1),
                Piece::Cubic(c) => self.path.curve_to(c.p1, c.p2, c.p3),
            }
        }
        if closed {
            self.path.close_path();
        }
    }
}

/// Control points move exactly; only arcs need approximating, which is done after the map, so that the tolerance counts there.
fn affine(outline: &Outline, m: Affine, options: &Options, out: &mut Output) {
    for sub in &outline.subpaths {
        let mut pieces = Vec::with_capacity(sub.segs.len());
        for seg in &sub.segs {
            match seg.transformed(m) {
                Seg::Line(l) => pieces.push(Piece::Line(l)),
                Seg::Arc(a) => {
                    let (canonical, flipped) = split::canonical(seg);
                    let start = pieces.len();
                    if let Seg::Arc(c) = canonical.transformed(m) {
                        pieces.extend(c.to_cubics(options.tolerance).map(Piece::Cubic));
                    }
                    if flipped {
                        turn(&mut pieces[start..]);
                    }
                    out.note(a.cubics_error(a.cubics_needed(options.tolerance)), Assurance::Certified);
                }
                other => pieces.push(Piece::Cubic(other.to_cubic())),
            }
        }
        out.subpath(m * sub.start, &pieces, sub.closed);
    }
}

fn finite(seg: &Seg) -> Result<(), GeometryError> {
    if seg.is_finite() { Ok(()) } else { Err(GeometryError::NotFinite { shape: PATH.into(), at: seg.start() }) }
}

fn infinity(at: Point) -> GeometryError {
    GeometryError::Infinity { shape: PATH.into(), at }
}

fn warp_subpath(
    sub: &Subpath,
    map: &dyn Map,
    creases: &Creases,
    options: &Options,
    out: &mut Output,
) -> Result<(), GeometryError> {
    let projective = matches!(map.class(), Class::Projective(_));
    sub.segs.first().map_or(Ok(()), finite)?;
    // The jets at the last two nodes; each is the next segment's first.
    let mut jets = [map.jet(sub.start); 2];
    let mut at = sub.start;
    if !creases.defined_at(at) || !jets[0].is_finite() {
        return Err(infinity(at));
    }
    let start = jets[0].p;
    let mut pieces = Vec::with_capacity(sub.segs.len() + sub.segs.len() / 2);
    // Where each segment's pieces begin.
    let mut bounds = Vec::with_capacity(if options.merge { sub.segs.len() + 1 } else { 0 });
    bounds.push(0);
    let job = Job { map, algebra: map.rational_degree(), creases, options };
    for (i, seg) in sub.segs.iter().enumerate() {
        finite(seg)?;
        if let Some(at) = creases.first_undefined(seg) {
            return Err(infinity(at));
        }
        let here = i % 2;
        if seg.start() != at {
            jets[here] = map.jet(seg.start());
        }
        at = seg.end();
        jets[1 - here] = map.jet(at);
        let [first, last] = [&jets[here], &jets[1 - here]];
        if !first.is_finite() || !last.is_finite() {
            return Err(infinity(if first.is_finite() { at } else { seg.start() }));
        }
        if projective && matches!(seg, Seg::Line(_)) {
            pieces.push(Piece::Line(Line::new(first.p, last.p)));
        } else {
            job.warp_seg(seg, [first, last], &mut pieces, &mut out.report).map_err(infinity)?;
        }
        if options.merge {
            bounds.push(pieces.len());
        }
    }
    let smooth = creases.items().iter().all(|c| c.kind == CreaseKind::Edge);
    if options.merge && smooth && bounds.len() == sub.segs.len() + 1 {
        let merger = merge::Merger { map, algebra: job.algebra, options };
        pieces = merger.merged(&sub.segs, &pieces, &bounds, &mut out.report).map_err(infinity)?;
    }
    out.subpath(start, &pieces, sub.closed);
    Ok(())
}

/// Two sides of a crease that are this share of the tolerance apart are torn, not rounded.
const TORN: f64 = 0.01;

/// A part that an affine branch moves exactly, between the nodes it shares with its neighbours.
fn affine_part(part: &Seg, from: Point, to: Point, tolerance: f64, pieces: &mut Vec<Piece>) {
    let near = |a: Point, b: Point| a.distance(b) <= TORN * tolerance;
    let (a, b) = (part.start(), part.end());
    if !near(a, from) {
        pieces.push(Piece::Line(Line::new(from, a)));
    }
    let (p0, p3) = (if near(a, from) { from } else { a }, if near(b, to) { to } else { b });
    pieces.push(match part {
        Seg::Line(_) => Piece::Line(Line::new(p0, p3)),
        other => Piece::Cubic(CubicBez { p0, p3, ..other.to_cubic() }),
    });
    if !near(b, to) {
        pieces.push(Piece::Line(Line::new(b, to)));
    }
}

/// The pieces run backwards.
fn turn(pieces: &mut [Piece]) {
    pieces.reverse();
    for p in pieces {
        *p = p.reversed();
    }
}

/// Shorter than this share of its coordinates, a segment is rounding of two equal points.
const ROUNDING: f64 = 1e-15;

/// Arcs that are to be proven are cut into parts of at most this angle (a little over a third of a turn).
const MOST_RATIONAL: f64 = 2.2;

/// What all segments of a path share.
struct Job<'a> {
    map: &'a dyn Map,
    /// What kind of quotient of polynomials the map is.
    algebra: Option<crate::map::RationalDegree>,
    creases: &'a Creases,
    options: &'a Options,
}

impl Job<'_> {
    /// Appends the image of one segment. The jets are those at its ends. `Err`: where the map is not finite.
    fn warp_seg(
        &self,
        seg: &Seg,
        jets: [&Jet; 2],
        pieces: &mut Vec<Piece>,
        report: &mut PathReport,
    ) -> Result<(), Point> {
        let turned;
        let flipped = split::backwards(seg);
        let canonical = if flipped {
            turned = seg.reversed();
            &turned
        } else {
            seg
        };
        let [first, last] = if flipped { [jets[1], jets[0]] } else { jets };
        let start = pieces.len();
        match canonical {
            Seg::Arc(a) if self.options.certify && a.sweep.abs() > MOST_RATIONAL && self.algebra.is_some() => {
                // Only arcs of less than half a turn are quotients of polynomials with positive denominators.
                let n = (a.sweep.abs() / MOST_RATIONAL).ceil();
                let mut from = *first;
                for i in 0..n as usize {
                    let part = a.subsegment(i as f64 / n, (i + 1) as f64 / n);
                    let to = if i + 1 == n as usize { *last } else { self.map.jet(part.p1) };
                    if !to.is_finite() {
                        return Err(part.p1);
                    }
                    self.warp(&Seg::Arc(part), [&from, &to], pieces, report)?;
                    from = to;
                }
            }
            _ => self.warp(canonical, [first, last], pieces, report)?,
        }
        if flipped {
            turn(&mut pieces[start..]);
        }
        Ok(())
    }

    /// Appends the image of a segment in its canonical direction, given the jets at its ends.
    fn warp(&self, seg: &Seg, jets: [&Jet; 2], pieces: &mut Vec<Piece>, report: &mut PathReport) -> Result<(), Point> {
        let certify = self.options.certify;
        let mut whole = Source::new(seg, self.map);
        if certify {
            whole.make_rational();
        }
        if whole.size() <= ROUNDING * (seg.start().to_vec2().hypot() + seg.end().to_vec2().hypot()) {
            // A segment that goes nowhere stays one (it carries line caps and markers), and has no direction to keep.
            pieces.push(Piece::Line(Line::new(jets[0].p, jets[1].p)));
            return Ok(());
        }
        let mut slow = split::slow(seg);
        if whole.is_rational() {
            slow = slow.map(|t| whole.param(t));
        }
        if self.creases.items().is_empty() {
            let from = whole.end_with(0.0, jets[0].p, jets[0]);
            let to = whole.end_with(1.0, jets[1].p, jets[1]);
            return self.cover(&whole, self.algebra, 0.0, &slow, [&from, &to], pieces, report);
        }
        self.warp_parts(seg, jets, &whole, &slow, pieces, report)
    }

    /// Covers a smooth part, whose ends are at most `blur` from the source's image.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    fn cover(
        &self,
        source: &Source<'_>,
        known: Option<crate::map::RationalDegree>,
        blur: f64,
        slow: &split::Slow,
        [from, to]: [&End; 2],
        pieces: &mut Vec<Piece>,
        report: &mut PathReport,
    ) -> Result<(), Point> {
        let algebra = if self.options.certify { Algebra::of(source, known) } else { None };
        let algebra = algebra.map(|a| a.with_blur(blur));
        let known = known.filter(|_| blur == 0.0);
        let tolerance = self.options.tolerance;
        step::Stepper { source, slow, tolerance, algebra, known, careful: false, attempts: 0 }
            .cover(from, to, pieces, report)
    }

    /// As [`Job::warp`], for a map that has creases.
    #[inline(never)]
    fn warp_parts(
        &self,
        seg: &Seg,
        jets: [&Jet; 2],
        whole: &Source<'_>,
        slow: &split::Slow,
        pieces: &mut Vec<Piece>,
        report: &mut PathReport,
    ) -> Result<(), Point> {
        let (map, certify) = (self.map, self.options.certify);
        let splits = self.creases.splits(seg);
        let nodes = [jets[0].p, jets[1].p];
        let tolerance = self.options.tolerance;
        let mut from = (0.0, nodes[0]);
        let mut from_t = 0.0;
        for i in 0..=splits.len() {
            let to_t = splits.get(i).copied().unwrap_or(1.0);
            let to = match splits.get(i) {
                Some(&t) => (whole.param(t), map.jet(seg.eval(t)).p),
                None => (1.0, nodes[1]),
            };
            let branch = map.branch(whole.at(0.5 * (from.0 + to.0)));
            if let Some(Class::Affine(m)) = branch.as_ref().map(Map::class)
                && let Some(part) = seg.part(from_t, to_t)
            {
                affine_part(&part.transformed(m), from.1, to.1, tolerance, pieces);
                (from, from_t) = (to, to_t);
                continue;
            }
            let inside;
            let source = match &branch {
                None => whole,
                Some(b) => {
                    inside = Source::for_proof(seg, b, certify);
                    &inside
                }
            };
            // The break points; where the map tears, the branch's own value, to be joined to the node by a line.
            let mut blur = 0.0f64;
            let mut end = |(t, p): (f64, Point), jet: &Jet| -> Result<(End, bool), Point> {
                if branch.is_none() && (t == 0.0 || t == 1.0) {
                    return Ok((source.end_with(t, p, jet), false));
                }
                let own = source.end_at(t, None)?;
                let off = own.p.distance(p);
                if off > TORN * tolerance {
                    return Ok((own, true));
                }
                blur = blur.max(off);
                Ok((End { p, ..own }, false))
            };
            let ((e0, torn0), (e1, torn1)) = (end(from, jets[0])?, end(to, jets[1])?);
            if torn0 {
                pieces.push(Piece::Line(Line::new(from.1, e0.p)));
            }
            self.cover(source, source.map.rational_degree(), blur, slow, [&e0, &e1], pieces, report)?;
            if torn1 {
                pieces.push(Piece::Line(Line::new(e1.p, to.1)));
            }
            from_t = to_t;
            from = to;
        }
        Ok(())
    }
}
