//! Fits of whole curves and paths, to a tolerance or with a given number of pieces, which takes a search for the tolerance.

use crate::joined::{Covered, JoinSettings, fewest, join};
use crate::limits::CUBICS_FIRST;
use crate::merge::{OwnPieces, ReachMemory};
use crate::nodes::{NodeSettings, Side, is_structure, placed};
use crate::options::{Degree, Error, Nodes, Options, Pieces};
use crate::part::{Part, parts};
use crate::report::{Assurance, Fitted, Piece, Report};
use crate::run::{RunSegment, SegmentRun};
use crate::sample::{Lane, Lanes, fma};
use crate::scale::smooth_parts;
use crate::source::{NotFinite, Quotient, Result, SlowSpots, Source};
use crate::spline::CurveRun;
use crate::stretch::StretchFitter;
use kurbo::{BezPath, ParamCurve, PathEl, PathSeg, Point, Vec2};
use std::cell::Cell;

/// Most evaluations between two checks of their number: a plan of eight pieces and its repair.
const ONE_ROUND: usize = 200_000;

/// Covers a curve with few pieces, within `options.tolerance`. The curve may have corners, cusps and jumps at its
/// [breaks](Source::breaks).
///
/// # Errors
/// [`Error::NotFinite`] if the curve is not finite somewhere, [`Error::NotMet`] or [`Error::TooFewPieces`] if tolerance or number of pieces
/// cannot be met, [`Error::Tolerance`] or [`Error::Corner`] if the options are out of range.
///
/// ```
/// use bezierfit::{Options, fit};
/// use kurbo::{Point, Vec2};
///
/// let spiral = |t: f64| {
///     let (s, c) = (20.0 * t).sin_cos();
///     (Point::new(100.0 * t * c, 100.0 * t * s), Vec2::new(c - 20.0 * t * s, s + 20.0 * t * c) * 100.0)
/// };
/// let fitted = fit(&spiral, &Options::new(0.01))?;
/// assert!(fitted.report.max_error <= 0.01 && fitted.report.unresolved.is_empty());
/// assert!(fitted.path.segments().count() <= 16);
/// # Ok::<(), bezierfit::Error>(())
/// ```
pub fn fit(source: &dyn Source, options: &Options) -> Result<Fitted, Error> {
    limited(options, &|options| Ok(fit_source(&source, options)?))
}

fn fit_source(source: &&dyn Source, options: &Options) -> Result<Fitted> {
    let mut out = Fitted { path: BezPath::new(), report: Report::default() };
    let mut memory = ReachMemory::default();
    let calls = Cell::new(0);
    let parts = parts(source, options.tolerance, &calls)?;
    let mut rest = &parts[..];
    while let Some(first) = rest.first() {
        let count = 1 + rest[1..].iter().take_while(|p| !p.jumps).count();
        let start = first.ends[0].p;
        if options.degree == Degree::Quadratic {
            out.path.move_to(start);
            append_splines(&rest[..count], (options, &calls), &mut out)?;
        } else {
            let pieces = merged_parts(&rest[..count], (options, &calls), &mut memory, &mut out.report)?;
            append(&mut out.path, start, &pieces, false);
        }
        rest = &rest[count..];
    }
    Ok(out)
}

/// Pieces of consecutive parts, fewer where the parts join smoothly. Stops early where `options` allow no more evaluations.
fn merged_parts<S: Source>(
    parts: &[Part<'_, S>],
    (options, calls): (&Options, &Cell<usize>),
    memory: &mut ReachMemory,
    report: &mut Report,
) -> Result<Vec<Piece>> {
    let slow = SlowSpots::default();
    let mut covered = Vec::with_capacity(parts.len());
    let mut out = Vec::new();
    for part in parts {
        calls.set(0);
        let (mut pieces, mut report) = (Vec::new(), Report::default());
        let mut fitter = StretchFitter::new(part, &slow, options.tolerance, (options.certify, 0.0), f64::INFINITY);
        fitter.counted = Some((calls, options.evaluations.saturating_sub(ONE_ROUND)));
        fitter.cover(&part.ends[0], &part.ends[1], &mut pieces, &mut report)?;
        let own = Covered { part: *part, pieces, report };
        own.append_to(if options.nodes.merges() { &fitter.joints } else { &[] }, &mut covered);
    }
    if options.nodes.merges() {
        let Options { tolerance, certify, .. } = *options;
        let (corner, finely) = (options.max_smooth_turn(), covered.len() > parts.len());
        let settings = JoinSettings { tolerance, corner, certify, finely, evenly: false };
        join(&covered, settings, memory, &mut out, report)?;
    } else {
        for own in covered {
            out.extend(own.pieces);
            report.add(&own.report);
        }
    }
    Ok(out)
}

/// Appends quadratics for consecutive parts.
fn append_splines<S: Source>(
    parts: &[Part<'_, S>],
    (options, calls): (&Options, &Cell<usize>),
    out: &mut Fitted,
) -> Result<()> {
    let spent = || calls.get() >= options.evaluations;
    let mut rest = parts;
    while let Some(first) = rest.first() {
        let smooth = |w: &[Part<'_, S>]| {
            let (u, v) = (w[0].ends[1].into, w[1].ends[0].away);
            options.nodes.merges() && u.cross(v).atan2(u.dot(v)).abs() <= options.max_smooth_turn()
        };
        let count = 1 + rest.windows(2).take_while(|w| smooth(w)).count();
        let ends = [first.ends[0], rest[count - 1].ends[1]];
        calls.set(0);
        let run = CurveRun { curves: &rest[..count], tolerance: options.tolerance, is_spent: &spent };
        run.cover(ends, &mut out.path, &mut out.report)?;
        rest = &rest[count..];
    }
    Ok(())
}

/// Replaces the segments of a path by few, within `options.tolerance`. Corners stay: see [`Options::corner`].
///
/// With [`Degree::Quadratic`], cubics become quadratics; with [`Nodes::Source`](crate::Nodes), each separately.
///
/// # Errors
/// [`Error::NotFinite`] if a coordinate is not finite, [`Error::NotMet`] or [`Error::TooFewPieces`] if tolerance or number of pieces cannot
/// be met, [`Error::Tolerance`] or [`Error::Corner`] if the options are out of range.
///
/// ```
/// use bezierfit::{Options, simplify};
/// use kurbo::{Circle, PathEl, Shape};
///
/// // A circle of 64 cubics.
/// let circle = Circle::new((0.0, 0.0), 100.0).to_path(1e-12);
/// let simple = simplify(&circle, &Options::new(0.1))?;
/// assert_eq!(simple.path.segments().count(), 4);
/// # Ok::<(), bezierfit::Error>(())
/// ```
pub fn simplify(path: &BezPath, options: &Options) -> Result<Fitted, Error> {
    limited(options, &|options| Ok(simplify_path(path, options)?))
}

/// Fits the curve on which points lie, in their order: applies [`simplify`] to the lines from one to the next, so that only corners of
/// the curve stay. It is closed if the last point is the first.
///
/// # Errors
/// [`Error::NotFinite`] if a point is not finite, and the other errors of [`simplify`].
///
/// ```
/// use bezierfit::{Options, fit_points};
///
/// let wave = (0..400).map(|i| (f64::from(i), 20.0 * (f64::from(i) / 30.0).sin()));
/// assert!(fit_points(wave, &Options::new(0.1))?.path.segments().count() < 20);
/// # Ok::<(), bezierfit::Error>(())
/// ```
pub fn fit_points(points: impl IntoIterator<Item = impl Into<Point>>, options: &Options) -> Result<Fitted, Error> {
    let mut elements: Vec<PathEl> = points.into_iter().map(|p| PathEl::LineTo(p.into())).collect();
    if let Some(PathEl::LineTo(start)) = elements.first().copied() {
        elements[0] = PathEl::MoveTo(start);
        if let [_, _, .., last] = &mut elements[..]
            && *last == PathEl::LineTo(start)
        {
            *last = PathEl::ClosePath;
        }
    }
    simplify(&BezPath::from_vec(elements), options)
}

fn simplify_path(path: &BezPath, options: &Options) -> Result<Fitted> {
    let mut out = Fitted { path: BezPath::new(), report: Report::default() };
    let mut memory = ReachMemory::default();
    for subpath in subpaths(path) {
        let elements = subpath.elements();
        let Some(PathEl::MoveTo(start)) = elements.first().copied() else { continue };
        let closed = elements.last() == Some(&PathEl::ClosePath);
        if let Some(at) = subpath.segments().map(|s| s.end()).chain([start]).find(|p| !p.is_finite()) {
            return Err(NotFinite { t: 0.0, at });
        }
        let mut segments: Vec<Segment> = subpath.segments().map(Segment::new).collect();
        if options.nodes.merges() && segments.iter().any(Segment::has_length) {
            segments.retain(Segment::has_length);
        }
        let parts = smooth_parts(segments, closed, options);
        let start = parts.first().and_then(|p| p.segments.first()).map_or(start, |s| s.seg.start());
        let (mut pieces, closes) = (Vec::new(), closed && parts.len() == 1);
        if options.degree == Degree::Quadratic {
            out.path.move_to(start);
        }
        for part in parts {
            let options = Options { tolerance: options.tolerance - part.distance, ..*options };
            let (mut rest, first) = (&part.segments[..], out.report.pieces.len());
            while !rest.is_empty() {
                rest = &rest[match options.degree {
                    Degree::Quadratic => append_quadratics(rest, &options, &mut out)?,
                    Degree::Cubic => smooth_run((rest, closes), &options, &mut memory, &mut pieces, &mut out.report)?,
                }..];
            }
            out.report.widen(first, part.distance);
        }
        match options.degree {
            Degree::Cubic => append(&mut out.path, pieces.first().map_or(start, Piece::start), &pieces, closed),
            Degree::Quadratic if closed => out.path.close_path(),
            Degree::Quadratic => {}
        }
    }
    Ok(out)
}

/// A run of the first segments, as far as they join smoothly, and their number; 0 if the first is a point or has slow spots.
fn smooth_start(segments: &[Segment], options: &Options) -> Result<(SegmentRun<Segment>, usize)> {
    let mut run = SegmentRun::new(true, segments.len().min(64));
    let most = if options.nodes.merges() { segments.len() } else { 1 };
    let count = run.extend(&segments[..most], options.max_inner_turn(), |segment| {
        let form = if options.certify { segment.quotient() } else { None };
        let ends = [segment.end(0.0)?, segment.end(1.0)?];
        let is_line = matches!(segment.seg, PathSeg::Line(_));
        let is_smooth = segment.slow_spots().all().is_empty() && segment.has_length();
        Ok(is_smooth.then(|| RunSegment::new(*segment, form, ends, is_line)))
    })?;
    for i in 0..count {
        let before = &segments[if i == 0 { segments.len() } else { i } - 1];
        run.segments[i].kept = is_structure(&before.side(1.0), &segments[i].side(0.0));
    }
    Ok((run, count))
}

/// Returns a function that appends the segment of a given index unchanged.
fn append_unchanged(segments: &[Segment]) -> impl FnMut(usize, &mut Vec<Piece>, &mut Report) -> Result<()> {
    |i, pieces, report| {
        pieces.push(segments[i].piece());
        report.add_error(0.0, Assurance::Exact);
        Ok(())
    }
}

/// Appends the pieces of the first segments, as far as they join smoothly, and returns the number of those segments. If `closed`, the
/// first segment follows the last.
pub(crate) fn smooth_run(
    (segments, closed): (&[Segment], bool),
    options: &Options,
    memory: &mut ReachMemory,
    pieces: &mut Vec<Piece>,
    report: &mut Report,
) -> Result<usize> {
    let (run, count) = smooth_start(segments, options)?;
    let mut append_own = append_unchanged(segments);
    if options.nodes.are_placed() && count > usize::from(options.nodes == Nodes::Auto) {
        let closed = closed && count == segments.len() && run.closes(options.max_inner_turn());
        let Options { nodes, tolerance, .. } = *options;
        placed(&run, NodeSettings { nodes, tolerance, closed, left: f64::INFINITY }, memory, pieces, report)?;
        return Ok(count);
    }
    if count < 2 {
        append_own(0, pieces, report)?;
        return Ok(1);
    }
    fewest(&run, OwnPieces::new(count, append_own), (options.tolerance, false), memory, pieces, report)?;
    Ok(count)
}

/// Appends quadratics for the first segments, as far as they join smoothly, and returns the number of those segments.
fn append_quadratics(segments: &[Segment], options: &Options, out: &mut Fitted) -> Result<usize> {
    let (mut run, mut count) = smooth_start(segments, options)?;
    if let (true, Some(to)) = (options.nodes.are_placed(), (1..count).find(|i| run.segments[*i].kept)) {
        (run, count) = smooth_start(&segments[..to], options)?;
    }
    let one = &segments[0];
    match one.seg {
        PathSeg::Line(l) if count < 2 => out.path.line_to(l.p1),
        PathSeg::Quad(q) if count < 2 => out.path.quad_to(q.p1, q.p2),
        _ if count == 0 => {
            // The segment has no length, or must be divided at slow spots.
            if one.has_length() {
                let calls = Cell::new(0);
                append_splines(&parts(&BrokenSegment(*one), options.tolerance, &calls)?, (options, &calls), out)?;
            }
            return Ok(1);
        }
        _ => {
            let ends = [run.segments[0].from, run.segments[count - 1].to];
            let (mut curves, mut error) = (segments[..count].to_vec(), 0.0);
            if count > 16 {
                // Long runs become few cubics first, so that circles of 100,000 cubics take linear time.
                let tolerance = CUBICS_FIRST * options.tolerance;
                let (mut pieces, mut report, mut memory) = (Vec::new(), Report::default(), ReachMemory::default());
                let own = OwnPieces::new(count, append_unchanged(segments));
                fewest(&run, own, (tolerance, false), &mut memory, &mut pieces, &mut report)?;
                (curves, error) = (pieces.into_iter().map(Segment::from).collect(), report.max_error);
            }
            let first = out.report.pieces.len();
            let run = CurveRun { curves: &curves, tolerance: options.tolerance - error, is_spent: &|| false };
            run.cover(ends, &mut out.path, &mut out.report)?;
            out.report.widen(first, error);
            return Ok(count);
        }
    }
    out.report.add_error(0.0, Assurance::Exact);
    Ok(1)
}

/// A segment that is broken at its slow spots.
struct BrokenSegment(Segment);

impl Source for BrokenSegment {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        self.0.eval(t)
    }

    fn breaks(&self) -> Vec<f64> {
        self.0.slow_spots().all().to_vec()
    }
}

/// A whole path as a source. Each segment takes an equal share of the parameter.
#[derive(Debug, Clone)]
pub struct PathSource {
    segments: Vec<Segment>,
}

impl PathSource {
    /// Makes a source from a path. `None` if it has no segments.
    #[must_use]
    pub fn new(path: &BezPath) -> Option<Self> {
        let segments: Vec<Segment> = path.segments().map(Segment::new).collect();
        (!segments.is_empty()).then_some(Self { segments })
    }
}

impl Source for PathSource {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        let n = self.segments.len();
        let i = ((t * n as f64) as usize).min(n - 1);
        let (p, d) = self.segments[i].eval(t * n as f64 - i as f64);
        (p, d * n as f64)
    }

    fn breaks(&self) -> Vec<f64> {
        let n = self.segments.len() as f64;
        let slow = |(i, s): (usize, &Segment)| s.slow_spots().map(|t| (i as f64 + t) / n).all().to_vec();
        let mut out: Vec<f64> = (1..self.segments.len()).map(|i| i as f64 / n).collect();
        out.extend(self.segments.iter().enumerate().flat_map(slow));
        out
    }

    fn is_simple(&self) -> bool {
        true
    }
}

/// The subpaths of a path, each as a path.
pub(crate) fn subpaths(path: &BezPath) -> impl Iterator<Item = BezPath> + '_ {
    let elements = path.elements();
    let starts = (0..elements.len()).filter(|i| matches!(elements[*i], PathEl::MoveTo(_)));
    let ends = starts.clone().skip(1).chain([elements.len()]);
    starts.zip(ends).map(|(i, j)| BezPath::from_vec(elements[i..j].to_vec()))
}

/// Appends pieces as a subpath. If `closed`, the close command stands for a last line.
pub fn append(path: &mut BezPath, start: Point, pieces: &[Piece], closed: bool) {
    path.move_to(start);
    let by_close = closed && matches!(pieces.last(), Some(Piece::Line(_)));
    for piece in &pieces[..pieces.len() - usize::from(by_close)] {
        match piece {
            Piece::Line(l) => path.line_to(l.p1),
            Piece::Cubic(c) => path.curve_to(c.p1, c.p2, c.p3),
        }
    }
    if closed {
        path.close_path();
    }
}

/// A segment of a path as a source.
#[derive(Debug, Clone, Copy)]
pub struct Segment {
    seg: PathSeg,
    /// Coefficients of the power basis, constant term first.
    c: [Vec2; 4],
}

impl Segment {
    /// Makes a source from kurbo's segment.
    #[must_use]
    pub fn new(seg: PathSeg) -> Self {
        let c = match seg {
            PathSeg::Line(s) => [s.p0.to_vec2(), s.p1 - s.p0, Vec2::ZERO, Vec2::ZERO],
            PathSeg::Quad(s) => [s.p0.to_vec2(), (s.p1 - s.p0) * 2.0, (s.p2 - s.p1) - (s.p1 - s.p0), Vec2::ZERO],
            PathSeg::Cubic(s) => {
                let (d0, d1, d2) = (s.p1 - s.p0, s.p2 - s.p1, s.p3 - s.p2);
                [s.p0.to_vec2(), d0 * 3.0, (d1 - d0) * 3.0, (d2 - d1) - (d1 - d0)]
            }
        };
        Self { seg, c }
    }

    /// The segment as a piece, raised to a cubic if it is a quadratic.
    fn piece(&self) -> Piece {
        match self.seg {
            PathSeg::Line(l) => Piece::Line(l),
            other => Piece::Cubic(other.to_cubic()),
        }
    }

    /// The segment's start (`t` = 0) or end (1) as one side of a joint.
    fn side(&self, t: f64) -> Side {
        let [d1, d2] = self.derivatives(t);
        Side { tangent: d1, bend: d2, is_line: matches!(self.seg, PathSeg::Line(_)) }
    }

    /// Kurbo's segment.
    pub(crate) fn segment(&self) -> PathSeg {
        self.seg
    }

    /// The first and the second derivative.
    pub(crate) fn derivatives(&self, t: f64) -> [Vec2; 2] {
        let [_, c1, c2, c3] = self.c;
        [(c3 * (3.0 * t) + c2 * 2.0) * t + c1, c3 * (6.0 * t) + c2 * 2.0]
    }

    /// Parameters at which the segment nearly stops.
    pub(crate) fn slow_spots(&self) -> SlowSpots {
        match &self.seg {
            PathSeg::Line(_) => SlowSpots::default(),
            PathSeg::Quad(s) => SlowSpots::of_quad(s),
            PathSeg::Cubic(s) => SlowSpots::of_cubic(s),
        }
    }

    /// Returns `true` if the segment is more than a point.
    fn has_length(&self) -> bool {
        self.c[1..].iter().any(|c| c.hypot2() > 0.0)
    }
}

impl From<PathSeg> for Segment {
    fn from(seg: PathSeg) -> Self {
        Self::new(seg)
    }
}

impl From<Piece> for Segment {
    fn from(piece: Piece) -> Self {
        Self::new(match piece {
            Piece::Line(l) => PathSeg::Line(l),
            Piece::Cubic(c) => PathSeg::Cubic(c),
        })
    }
}

impl Source for Segment {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        (self.seg.eval(t), self.derivatives(t)[0])
    }

    fn points(&self, t: &Lane, out: &mut Lanes) {
        let [c0, c1, c2, c3] = self.c;
        for i in 0..8 {
            out.x[i] = fma(fma(fma(c3.x, t[i], c2.x), t[i], c1.x), t[i], c0.x);
            out.y[i] = fma(fma(fma(c3.y, t[i], c2.y), t[i], c1.y), t[i], c0.y);
        }
    }

    fn is_simple(&self) -> bool {
        true
    }

    fn quotient(&self) -> Option<Quotient> {
        Some(Quotient::polynomial(match self.seg {
            PathSeg::Line(_) => 1,
            PathSeg::Quad(_) => 2,
            PathSeg::Cubic(_) => 3,
        }))
    }
}

/// Most fits in the bisection for the least error, and the ratio of tolerances at which it ends.
const MAX_TRIALS: usize = 40;
const CLOSE_ENOUGH: f64 = 1.01;
/// After the bisection, most further fits, the ratio of their tolerances, and the number of fits in a row without improvement that ends
/// them: a narrow range of tolerances, down to a seventieth, may find break points that suit the symmetry of a curve.
const MAX_POLISHING: usize = 100;
const POLISHING_RATIO: f64 = 0.9;
const MAX_MISSES: i32 = 40;

/// Fits with the tolerance of the options, or with a tolerance that leads to the wanted number of pieces.
pub(crate) fn limited(options: &Options, fit: &dyn Fn(&Options) -> Result<Fitted, Error>) -> Result<Fitted, Error> {
    options.check()?;
    let with = |tolerance: f64| fit(&Options { tolerance, pieces: Pieces::Fewest, ..*options });
    let first = with(options.tolerance)?;
    let (allowed, exactly) = match options.pieces {
        Pieces::Fewest => match first.report.unresolved.first().filter(|_| !options.best) {
            Some(at) => return Err(Error::NotMet { at: *at, error: first.report.max_error }),
            None => return Ok(first),
        },
        Pieces::AtMost(n) => (n, false),
        Pieces::Exactly(n) => (n, true),
    };
    if piece_count(&first) <= allowed && !exactly {
        return Ok(first);
    }
    let (best, least) = closest(allowed, (options.tolerance, first), &with)?;
    let Some(mut best) = best else { return Err(Error::TooFewPieces { allowed, least }) };
    if exactly {
        divide(&mut best, allowed);
    } else if best.report.max_error > options.tolerance {
        let worst = best.report.pieces.iter().enumerate().max_by(|a, b| a.1.error.total_cmp(&b.1.error));
        best.report.unresolved.extend(worst.and_then(|(i, _)| Some(best.path.segments().nth(i)?.eval(0.5))));
    }
    Ok(best)
}

/// The closest fit found with at most `allowed` pieces, and the fewest pieces found. The search begins with a tolerance and its fit.
fn closest(
    allowed: usize,
    (mut tolerance, mut fitted): (f64, Fitted),
    with: &dyn Fn(f64) -> Result<Fitted, Error>,
) -> Result<(Option<Fitted>, usize), Error> {
    let (mut best, mut least) = (None::<Fitted>, piece_count(&fitted));
    // The largest tolerance that needs too many pieces, and the smallest that does not.
    let (mut low, mut high) = (0.0, f64::INFINITY);
    for _ in 0..MAX_TRIALS {
        let found = piece_count(&fitted);
        least = least.min(found);
        // The error goes with the sixth power of the length.
        let factor = (found as f64 / allowed.max(1) as f64).powi(6);
        if found > allowed {
            low = tolerance;
        } else {
            high = tolerance;
            if best.as_ref().is_none_or(|b| fitted.report.max_error < b.report.max_error) {
                best = Some(fitted);
            }
        }
        if low * CLOSE_ENOUGH >= high {
            break;
        }
        tolerance = match (low > 0.0, high.is_finite()) {
            (true, true) => (low * high).sqrt(),
            (true, false) => low * factor.clamp(2.0, 1e6),
            _ => high * factor.clamp(1e-6, 0.5),
        };
        if !(tolerance > f64::MIN_POSITIVE && tolerance.is_finite()) {
            break;
        }
        fitted = with(tolerance)?;
    }
    // A fit may be closer than its tolerance, and smaller tolerances do not always need more pieces.
    let mut misses = 0;
    for _ in 0..MAX_POLISHING {
        let Some(b) = best.as_ref().filter(|_| misses < MAX_MISSES) else { break };
        misses += 1;
        let closer = POLISHING_RATIO.powi(misses) * b.report.max_error;
        if closer < f64::MIN_POSITIVE {
            break;
        }
        let fitted = with(closer)?;
        if piece_count(&fitted) <= allowed && fitted.report.max_error < b.report.max_error {
            (best, misses) = (Some(fitted), 0);
        }
    }
    Ok((best, least))
}

fn piece_count(fitted: &Fitted) -> usize {
    fitted.report.pieces.len()
}

/// Divides pieces in proportion to their lengths until there are `wanted`.
fn divide(fitted: &mut Fitted, wanted: usize) {
    let segs: Vec<PathSeg> = fitted.path.segments().collect();
    let length = |s: &PathSeg| s.start().distance(s.eval(0.5)) + s.eval(0.5).distance(s.end());
    let total: f64 = segs.iter().map(length).sum();
    if segs.len() != piece_count(fitted) || segs.len() >= wanted || total <= 0.0 {
        return;
    }
    let extra = (wanted - segs.len()) as f64;
    let (mut path, mut each) = (BezPath::new(), Vec::with_capacity(wanted));
    let (mut along, mut next) = (0.0, 0);
    for e in fitted.path.elements() {
        if let PathEl::MoveTo(p) = e {
            path.move_to(*p);
            continue;
        }
        // A close command draws a line unless the subpath is back at its start.
        let start = path.elements().iter().rev().find_map(|e| if let PathEl::MoveTo(p) = e { Some(*p) } else { None });
        let is_back = path.elements().last().and_then(PathEl::end_point) == start;
        if !(matches!(e, PathEl::ClosePath) && is_back) {
            let (seg, report) = (segs[next], fitted.report.pieces[next]);
            let before = (extra * along / total).round();
            along += length(&seg);
            let parts = 1 + ((extra * along / total).round() - before) as usize;
            for i in 0..parts {
                let [t0, t1] = [i, i + 1].map(|k| k as f64 / parts as f64);
                path.push(if parts == 1 { seg.as_path_el() } else { seg.subsegment(t0..t1).as_path_el() });
            }
            each.resize(each.len() + parts, report);
            next += 1;
        }
        if let PathEl::ClosePath = e {
            path.close_path();
        }
    }
    (fitted.path, fitted.report.pieces) = (path, each);
}
