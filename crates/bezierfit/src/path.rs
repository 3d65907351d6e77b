//! Fits of whole curves and paths, to a tolerance or with a given number of pieces, for which the tolerance is searched for.

use crate::limits::{CUBICS_FIRST, JUMP};
use crate::merge::{FitOwn, MergeSettings, OwnPieces, ReachMemory, Reaches, refined};
use crate::options::{Degree, Error, Options, Pieces};
use crate::report::{Assurance, Fitted, Piece, Report};
use crate::run::{RunSegment, SegmentRun};
use crate::sample::{Lane, Lanes, fma};
use crate::source::{BreakPoint, NotFinite, ONE_SIDED_STEP, Quotient, SlowSpots, Source};
use crate::spline::Run;
use crate::stretch::StretchFitter;
use kurbo::{BezPath, ParamCurve, PathEl, PathSeg, Point, Vec2};

/// Evaluations of a source by [`fit`], at most, for each smooth part between its [breaks](Source::breaks). Usual curves need some
/// hundreds for each piece. Where it is reached, the rest of the part is listed as unresolved. Only quadratics, and a given number of
/// pieces, which takes several fits, may need a multiple.
pub const MAX_EVALUATIONS: usize = 2_000_000;

/// Evaluations between two looks at their number, at most: of a plan of eight pieces and its repair.
const ONE_ROUND: usize = 200_000;

/// Covers a curve with few pieces, within `options.tolerance`. The curve may have corners, cusps and jumps where it
/// [says](Source::breaks) so.
///
/// Places at which the tolerance could not be met are listed in the report.
///
/// # Errors
/// The curve is not finite somewhere, or the options make no sense.
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
pub fn fit<S: Source>(source: &S, options: &Options) -> Result<Fitted, Error> {
    limited(options, &|options| Ok(fitted(source, options)?))
}

fn fitted<S: Source>(source: &S, options: &Options) -> Result<Fitted, NotFinite> {
    let mut out = Fitted { path: BezPath::new(), report: Report::default() };
    let mut memory = ReachMemory::default();
    let parts = parts(source, options.tolerance)?;
    let mut rest = &parts[..];
    while let Some(first) = rest.first() {
        let count = 1 + rest[1..].iter().take_while(|p| !p.jumps).count();
        let start = first.ends[0].p;
        if options.degree == Degree::Quadratic {
            out.path.move_to(start);
            splines(&rest[..count], options, &mut out)?;
        } else {
            let pieces = merged_parts(&rest[..count], options, &mut memory, &mut out.report)?;
            append(&mut out.path, start, &pieces, false);
        }
        rest = &rest[count..];
    }
    Ok(out)
}

/// A smooth part of a curve, with its own parameter from 0 to 1.
struct Part<'a, S> {
    source: &'a S,
    t0: f64,
    t1: f64,
    ends: [BreakPoint; 2],
    /// It begins elsewhere than the part before ends.
    jumps: bool,
}

impl<S> Clone for Part<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S> Copy for Part<'_, S> {}

impl<S> Part<'_, S> {
    fn at(&self, t: f64) -> f64 {
        if t == 1.0 { self.t1 } else { self.t0 + (self.t1 - self.t0) * t }
    }

    fn is_whole(&self) -> bool {
        (self.t0, self.t1) == (0.0, 1.0)
    }
}

impl<S: Source> Source for Part<'_, S> {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        let (p, d) = self.source.eval(self.at(t));
        (p, d * (self.t1 - self.t0))
    }

    fn points(&self, t: &Lane, out: &mut Lanes) {
        self.source.points(&t.map(|t| self.at(t)), out);
    }

    fn is_simple(&self) -> bool {
        self.source.is_simple()
    }

    fn quotient(&self) -> Option<Quotient> {
        // The denominator of a part would be another one.
        self.source.quotient().filter(|q| q.below == 0 || self.is_whole())
    }

    fn denominators(&self, t: &Lane) -> Lane {
        self.source.denominators(t)
    }

    fn place(&self, t: f64) -> Point {
        self.source.place(self.at(t))
    }

    fn end(&self, t: f64) -> Result<BreakPoint, NotFinite> {
        if t == 0.0 || t == 1.0 {
            return Ok(self.ends[usize::from(t == 1.0)]);
        }
        let end = self.source.end(self.at(t))?;
        Ok(BreakPoint { t, speed: end.speed * (self.t1 - self.t0), ..end })
    }
}

/// The parts between the breaks of a source.
fn parts<S: Source>(source: &S, tolerance: f64) -> Result<Vec<Part<'_, S>>, NotFinite> {
    let mut places = source.breaks();
    places.retain(|t| *t > 0.0 && *t < 1.0);
    places.push(1.0);
    places.sort_by(f64::total_cmp);
    places.dedup();
    let inner = places.len() > 1;
    let mut out: Vec<Part<'_, S>> = Vec::with_capacity(places.len());
    let mut t0 = 0.0;
    for t1 in places {
        let [mut from, mut to] = if inner {
            [beside(source, t0, 1.0)?, beside(source, t1, -1.0)?]
        } else {
            [source.end(t0)?, source.end(t1)?]
        };
        let mut jumps = false;
        if let Some(last) = out.last() {
            jumps = last.ends[1].p.distance(from.p) > JUMP * tolerance;
            if !jumps {
                from.p = last.ends[1].p;
            }
        }
        for (t, end) in [(0.0, &mut from), (1.0, &mut to)] {
            (end.t, end.speed) = (t, end.speed * (t1 - t0));
        }
        out.push(Part { source, t0, t1, ends: [from, to], jumps });
        t0 = t1;
    }
    Ok(out)
}

/// The end of a smooth part at `t`, with the tangent and the speed a little further inside.
fn beside<S: Source>(source: &S, t: f64, side: f64) -> Result<BreakPoint, NotFinite> {
    // The limit from the left, where the curve jumps.
    let (p, _) = source.eval(if side < 0.0 && t < 1.0 { t.next_down() } else { t });
    let near = source.end(t + side * ONE_SIDED_STEP)?;
    let along = if side > 0.0 { near.away } else { near.into };
    if !p.is_finite() {
        return Err(NotFinite { t, at: source.place(t) });
    }
    Ok(BreakPoint { t, p, speed: near.speed, into: along, away: along })
}

/// The pieces of parts that follow each other. They run on across smooth joints of parts that need no more than two.
fn merged_parts<S: Source>(
    parts: &[Part<'_, S>],
    options: &Options,
    memory: &mut ReachMemory,
    report: &mut Report,
) -> Result<Vec<Piece>, NotFinite> {
    let slow = SlowSpots::default();
    let mut covered = Vec::with_capacity(parts.len());
    for part in parts {
        let (mut pieces, mut report) = (Vec::new(), Report::default());
        let mut fitter = StretchFitter::new(part, &slow, options.tolerance, (options.prove, 0.0), f64::INFINITY);
        fitter.most_evaluations = MAX_EVALUATIONS - ONE_ROUND;
        fitter.cover(&part.ends[0], &part.ends[1], &mut pieces, &mut report)?;
        covered.push((part, pieces, report));
    }
    let mut out = Vec::new();
    let mut i = 0;
    while i < covered.len() {
        let mut run = SegmentRun::new(parts[0].is_simple(), 8);
        let joined = if options.merge && covered.len() > 1 {
            run.extend(&covered[i..], options.corner, |(part, pieces, _)| {
                let form = if options.prove { part.quotient().and_then(Quotient::provable) } else { None };
                let is_line = matches!(pieces[..], [Piece::Line(_)]);
                Ok((pieces.len() <= 2).then(|| RunSegment::new(**part, form, part.ends, is_line)))
            })?
        } else {
            0
        };
        let known = |k: usize, pieces: &mut Vec<Piece>, report: &mut Report| {
            pieces.extend(&covered[i + k].1);
            report.add(&covered[i + k].2);
            Ok(())
        };
        if joined < 2 {
            known(0, &mut out, report)?;
            i += 1;
        } else {
            fewest(&run, OwnPieces::new(joined, known), options, memory, &mut out, report)?;
            i += joined;
        }
    }
    Ok(out)
}

/// Appends the fewest pieces of a run.
pub(crate) fn fewest<S: Source + Clone>(
    run: &SegmentRun<S>,
    own: OwnPieces<impl FitOwn>,
    options: &Options,
    memory: &mut ReachMemory,
    pieces: &mut Vec<Piece>,
    report: &mut Report,
) -> Result<(), NotFinite> {
    let proof = run.segments.first().is_some_and(RunSegment::is_provable);
    let settings = MergeSettings { tolerance: options.tolerance, proof, marks: false, again: false };
    let mut reaches = Reaches::new(run, own, settings, memory);
    let legs = reaches.fewest()?;
    let (mut own, legs) = refined(run, reaches.own, legs, settings, memory)?;
    let assurance = if proof { Assurance::Certified } else { Assurance::Checked };
    own.append(legs, assurance, pieces, report)
}

/// Appends quadratics for parts that follow each other.
fn splines<S: Source>(parts: &[Part<'_, S>], options: &Options, out: &mut Fitted) -> Result<(), NotFinite> {
    let mut rest = parts;
    while let Some(first) = rest.first() {
        let smooth = |w: &[Part<'_, S>]| {
            let (u, v) = (w[0].ends[1].into, w[1].ends[0].away);
            options.merge && u.cross(v).atan2(u.dot(v)).abs() <= options.corner
        };
        let count = 1 + rest.windows(2).take_while(|w| smooth(w)).count();
        let ends = [first.ends[0], rest[count - 1].ends[1]];
        let run = Run { curves: &rest[..count], tolerance: options.tolerance };
        run.cover(ends, &mut out.path, &mut out.report)?;
        rest = &rest[count..];
    }
    Ok(())
}

/// Replaces the segments of a path by few, within `options.tolerance`. Corners stay: joints that turn by more than `options.corner`.
///
/// With [`Degree::Quadratic`], cubics become quadratics; without [`Options::merge`], each on its own.
///
/// # Errors
/// The path has coordinates that are not finite, or the options make no sense.
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
    limited(options, &|options| Ok(simplified(path, options)?))
}

fn simplified(path: &BezPath, options: &Options) -> Result<Fitted, NotFinite> {
    let mut out = Fitted { path: BezPath::new(), report: Report::default() };
    let mut memory = ReachMemory::default();
    for subpath in subpaths(path) {
        let elements = subpath.elements();
        let (Some(PathEl::MoveTo(start)), closed) =
            (elements.first().copied(), matches!(elements.last(), Some(PathEl::ClosePath)))
        else {
            continue;
        };
        let segments: Vec<Segment> = subpath.segments().map(Segment::new).collect();
        if !start.is_finite() {
            return Err(NotFinite { t: 0.0, at: start });
        }
        let mut pieces = Vec::with_capacity(segments.len());
        let mut rest = &segments[..];
        if options.degree == Degree::Quadratic {
            out.path.move_to(start);
            while !rest.is_empty() {
                rest = &rest[quadratics(rest, options, &mut out)?..];
            }
            if closed {
                out.path.close_path();
            }
        } else {
            while !rest.is_empty() {
                rest = &rest[smooth_run(rest, options, &mut memory, &mut pieces, &mut out.report)?..];
            }
            append(&mut out.path, start, &pieces, closed);
        }
    }
    Ok(out)
}

/// The first segments as a run, as far as they join smoothly, and their number.
fn joined(segments: &[Segment], options: &Options) -> Result<(SegmentRun<Segment>, usize), NotFinite> {
    let mut run = SegmentRun::new(true, segments.len().min(64));
    let most = if options.merge { segments.len() } else { 1 };
    let count = run.extend(&segments[..most], options.corner, |segment| {
        let form = if options.prove { segment.quotient() } else { None };
        let ends = [segment.end(0.0)?, segment.end(1.0)?];
        let is_line = matches!(segment.seg, PathSeg::Line(_));
        Ok(segment.is_smooth().then(|| RunSegment::new(*segment, form, ends, is_line)))
    })?;
    Ok((run, count))
}

/// Appends one of the segments as it is.
fn unchanged(segments: &[Segment]) -> impl FnMut(usize, &mut Vec<Piece>, &mut Report) -> Result<(), NotFinite> {
    |i, pieces, report| {
        pieces.push(segments[i].piece());
        report.add_error(0.0, Assurance::Exact);
        Ok(())
    }
}

/// Appends the pieces of the first segments, as far as they join smoothly, and returns their number.
fn smooth_run(
    segments: &[Segment],
    options: &Options,
    memory: &mut ReachMemory,
    pieces: &mut Vec<Piece>,
    report: &mut Report,
) -> Result<usize, NotFinite> {
    let (run, count) = joined(segments, options)?;
    let mut itself = unchanged(segments);
    if count < 2 {
        itself(0, pieces, report)?;
        return Ok(1);
    }
    fewest(&run, OwnPieces::new(count, itself), options, memory, pieces, report)?;
    Ok(count)
}

/// Appends quadratics for the first segments, as far as they join smoothly, and returns their number.
fn quadratics(segments: &[Segment], options: &Options, out: &mut Fitted) -> Result<usize, NotFinite> {
    let (run, count) = joined(segments, options)?;
    let one = &segments[0];
    match one.seg {
        PathSeg::Line(l) if count < 2 => out.path.line_to(l.p1),
        PathSeg::Quad(q) if count < 2 => out.path.quad_to(q.p1, q.p2),
        _ if count == 0 => {
            // It has no length, or slow spots to be divided at.
            let slow = |t: f64| one.eval(t);
            let breaks = Broken { curve: slow, at: one.slow_spots() };
            if one.c[1..].iter().any(|c| c.hypot2() > 0.0) {
                splines(&parts(&breaks, options.tolerance)?, options, out)?;
            }
            return Ok(1);
        }
        _ => {
            let ends = [run.segments[0].from, run.segments[count - 1].to];
            let (mut curves, mut off) = (segments[..count].to_vec(), 0.0);
            if count > 16 {
                // Long runs become few cubics first, so that circles of 100,000 cubics take linear time.
                let close = Options { tolerance: CUBICS_FIRST * options.tolerance, ..*options };
                let (mut pieces, mut report, mut memory) = (Vec::new(), Report::default(), ReachMemory::default());
                fewest(
                    &run,
                    OwnPieces::new(count, unchanged(segments)),
                    &close,
                    &mut memory,
                    &mut pieces,
                    &mut report,
                )?;
                (curves, off) = (pieces.into_iter().map(Segment::from).collect(), report.max_error);
            }
            let first = out.report.pieces.len();
            let run = Run { curves: &curves, tolerance: options.tolerance - off };
            run.cover(ends, &mut out.path, &mut out.report)?;
            out.report.widen(first, off);
            return Ok(count);
        }
    }
    out.report.add_error(0.0, Assurance::Exact);
    Ok(1)
}

/// A curve that is broken at slow spots.
struct Broken<F> {
    curve: F,
    at: SlowSpots,
}

impl<F: Fn(f64) -> (Point, Vec2)> Source for Broken<F> {
    fn eval(&self, t: f64) -> (Point, Vec2) {
        (self.curve)(t)
    }

    fn breaks(&self) -> Vec<f64> {
        self.at.all().to_vec()
    }
}

/// A whole path as a source, each of its segments over an equal share of the parameter.
#[derive(Debug, Clone)]
pub struct PathSource {
    segments: Vec<Segment>,
}

impl PathSource {
    /// From a path. `None` if it has no segments.
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

/// Writes pieces as a subpath. In a closed one, a last line is left to the close command.
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
    /// From kurbo's segment.
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

    /// The segment itself, raised to a cubic.
    fn piece(&self) -> Piece {
        match self.seg {
            PathSeg::Line(l) => Piece::Line(l),
            other => Piece::Cubic(other.to_cubic()),
        }
    }

    /// As kurbo's segment.
    pub(crate) fn segment(&self) -> PathSeg {
        self.seg
    }

    /// The first and the second derivative.
    pub(crate) fn derivatives(&self, t: f64) -> [Vec2; 2] {
        let [_, c1, c2, c3] = self.c;
        [(c3 * (3.0 * t) + c2 * 2.0) * t + c1, c3 * (6.0 * t) + c2 * 2.0]
    }

    /// Where it nearly stops.
    pub(crate) fn slow_spots(&self) -> SlowSpots {
        match &self.seg {
            PathSeg::Line(_) => SlowSpots::default(),
            PathSeg::Quad(s) => SlowSpots::of_quad(s),
            PathSeg::Cubic(s) => SlowSpots::of_cubic(s),
        }
    }

    /// Returns `true` if it has a length and no cusps.
    fn is_smooth(&self) -> bool {
        self.slow_spots().all().is_empty() && self.c[1..].iter().any(|c| c.hypot2() > 0.0)
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

/// Fits tried on the way to the least error: it is then known to about a hundredth.
const TRIALS: usize = 40;
/// Ratio of tolerances between which the search ends.
const CLOSE: f64 = 1.01;
/// Further fits, each with this share of the error of the one before.
const POLISHED: usize = 20;
const CLOSER: f64 = 0.96;
/// Of these in a row, so many may need more pieces.
const MISSES: i32 = 4;

/// Fits with the tolerance of the options, or with the one that leads to the wanted number of pieces.
pub(crate) fn limited(options: &Options, fit: &dyn Fn(&Options) -> Result<Fitted, Error>) -> Result<Fitted, Error> {
    options.checked()?;
    let with = |tolerance: f64| fit(&Options { tolerance, pieces: Pieces::Fewest, ..*options });
    let first = with(options.tolerance)?;
    let (allowed, exactly) = match options.pieces {
        Pieces::Fewest => return Ok(first),
        Pieces::AtMost(n) => (n, false),
        Pieces::Exactly(n) => (n, true),
    };
    let mut least = count(&first);
    if least <= allowed && !exactly {
        return Ok(first);
    }
    let mut best = None;
    // Tolerances that need too many pieces, and that need few enough.
    let (mut low, mut high) = (0.0, f64::INFINITY);
    let mut tolerance = options.tolerance;
    let mut fitted = first;
    for _ in 0..TRIALS {
        let found = count(&fitted);
        least = least.min(found);
        // The error goes with the sixth power of the length.
        let factor = (found as f64 / allowed.max(1) as f64).powi(6);
        if found > allowed {
            low = tolerance;
        } else {
            high = tolerance;
            let error = |f: &Fitted| f.report.max_error;
            if best.as_ref().is_none_or(|b| error(&fitted) < error(b)) {
                best = Some(fitted);
            }
        }
        if low * CLOSE >= high {
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
    // What was found may be closer than its tolerance asked for, and smaller tolerances do not always need more pieces.
    let mut misses = 0;
    for _ in 0..POLISHED {
        let Some(b) = best.as_ref().filter(|_| misses < MISSES) else { break };
        misses += 1;
        let closer = CLOSER.powi(misses) * b.report.max_error;
        if closer < f64::MIN_POSITIVE {
            break;
        }
        let fitted = with(closer)?;
        if count(&fitted) <= allowed && fitted.report.max_error < b.report.max_error {
            (best, misses) = (Some(fitted), 0);
        }
    }
    let Some(mut best) = best else { return Err(Error::TooFewPieces { allowed, least }) };
    // A search for the fewer pieces found takes other tolerances, and may come closer.
    if !exactly && count(&best) < allowed {
        let pieces = Pieces::AtMost(count(&best));
        let fewer = limited(&Options { pieces, ..*options }, fit).ok();
        best = fewer.filter(|f| f.report.max_error < best.report.max_error).unwrap_or(best);
    }
    if exactly {
        divide(&mut best, allowed);
    } else if best.report.max_error > options.tolerance {
        let worst = best.report.pieces.iter().enumerate().max_by(|a, b| a.1.error.total_cmp(&b.1.error));
        best.report.unresolved.extend(worst.and_then(|(i, _)| Some(best.path.segments().nth(i)?.eval(0.5))));
    }
    Ok(best)
}

fn count(fitted: &Fitted) -> usize {
    fitted.report.pieces.len()
}

/// Divides pieces, the longest most, until there are `wanted`.
fn divide(fitted: &mut Fitted, wanted: usize) {
    let segs: Vec<PathSeg> = fitted.path.segments().collect();
    let length = |s: &PathSeg| s.start().distance(s.eval(0.5)) + s.eval(0.5).distance(s.end());
    let total: f64 = segs.iter().map(length).sum();
    if segs.len() != count(fitted) || segs.len() >= wanted || total <= 0.0 {
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
        // A close command has a line of its own unless the subpath is back at its start.
        let start = path.elements().iter().rev().find_map(|e| if let PathEl::MoveTo(p) = e { Some(*p) } else { None });
        let is_back = path.elements().last().and_then(PathEl::end_point) == start;
        if !(matches!(e, PathEl::ClosePath) && is_back) {
            let (seg, report) = (segs[next], fitted.report.pieces[next]);
            let before = (extra * along / total).round();
            along += length(&seg);
            let parts = 1 + ((extra * along / total).round() - before) as usize;
            for i in 0..parts {
                let [t0, t1] = [i, i + 1].map(|k| k as f64 / parts as f64);
                path.push(if parts == 1 { element(seg) } else { element(seg.subsegment(t0..t1)) });
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

fn element(seg: PathSeg) -> PathEl {
    match seg {
        PathSeg::Line(l) => PathEl::LineTo(l.p1),
        PathSeg::Quad(q) => PathEl::QuadTo(q.p1, q.p2),
        PathSeg::Cubic(c) => PathEl::CurveTo(c.p1, c.p2, c.p3),
    }
}
