//! Fits of whole curves and paths.

use crate::limits::ONE_SIDED_STEP;
use crate::merge::{MergeSettings, OwnPieces, ReachMemory, Reaches, refined};
use crate::options::Options;
use crate::report::{Assurance, Piece, Report};
use crate::run::{RunSegment, SegmentRun};
use crate::sample::{Lane, Lanes, fma};
use crate::source::{BreakPoint, NotFinite, Quotient, SlowSpots, Source};
use crate::stretch::StretchFitter;
use kurbo::{BezPath, ParamCurve, PathEl, PathSeg, Point, Vec2};

/// A path with what is known of its error.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Fitted {
    /// Lines and cubics.
    pub path: BezPath,
    /// How far the path is from the source.
    pub report: Report,
}

/// Covers a curve with few cubics and lines, within `options.tolerance`. The curve may have corners and cusps where it
/// [says](Source::breaks) so.
///
/// Places at which the tolerance could not be met are listed in the report.
///
/// # Errors
/// The curve is not finite somewhere.
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
/// # Ok::<(), bezierfit::NotFinite>(())
/// ```
pub fn fit<S: Source>(source: &S, options: &Options) -> Result<Fitted, NotFinite> {
    let mut places = source.breaks();
    places.retain(|t| *t > 0.0 && *t < 1.0);
    places.push(1.0);
    places.sort_by(f64::total_cmp);
    places.dedup();
    let (mut pieces, mut report) = (Vec::new(), Report::default());
    let slow = SlowSpots::default();
    let inner = places.len() > 1;
    let mut t0 = 0.0;
    for t1 in places {
        let from = if inner { beside(source, t0, 1.0)? } else { source.end(t0)? };
        let to = if inner { beside(source, t1, -1.0)? } else { source.end(t1)? };
        let mut fitter = StretchFitter::new(source, &slow, options.tolerance, (options.prove, 0.0), f64::INFINITY);
        fitter.cover(&from, &to, &mut pieces, &mut report)?;
        t0 = t1;
    }
    let start = source.eval(0.0).0;
    let mut path = BezPath::new();
    append(&mut path, start, &pieces, false);
    Ok(Fitted { path, report })
}

/// The end of a smooth part at `t`, with the tangent and the speed a little further inside.
fn beside<S: Source>(source: &S, t: f64, side: f64) -> Result<BreakPoint, NotFinite> {
    let (p, _) = source.eval(t);
    let near = source.end(t + side * ONE_SIDED_STEP)?;
    let along = if side > 0.0 { near.away } else { near.into };
    if !p.is_finite() {
        return Err(NotFinite { t, at: source.place(t) });
    }
    Ok(BreakPoint { t, p, speed: near.speed, into: along, away: along })
}

/// Replaces the segments of a path by few cubics and lines, within `options.tolerance`. Corners stay: joints that turn by more than
/// `options.corner`.
///
/// # Errors
/// The path has coordinates that are not finite.
///
/// ```
/// use bezierfit::{Options, simplify};
/// use kurbo::{Circle, PathEl, Shape};
///
/// // A circle of 64 cubics.
/// let circle = Circle::new((0.0, 0.0), 100.0).to_path(1e-12);
/// let simple = simplify(&circle, &Options::new(0.1))?;
/// assert_eq!(simple.path.segments().count(), 4);
/// # Ok::<(), bezierfit::NotFinite>(())
/// ```
pub fn simplify(path: &BezPath, options: &Options) -> Result<Fitted, NotFinite> {
    let mut out = Fitted { path: BezPath::new(), report: Report::default() };
    let mut memory = ReachMemory::default();
    let elements = path.elements();
    let mut first = 0;
    while first < elements.len() {
        let count = elements[first + 1..].iter().take_while(|e| !matches!(e, PathEl::MoveTo(_))).count();
        let subpath = BezPath::from_vec(elements[first..=first + count].to_vec());
        let closed = matches!(elements[first + count], PathEl::ClosePath);
        let segments: Vec<Segment> = subpath.segments().map(Segment::new).collect();
        let start = match elements[first] {
            PathEl::MoveTo(p) => p,
            _ => segments.first().map_or(Point::ORIGIN, |s| s.seg.start()),
        };
        if !start.is_finite() {
            return Err(NotFinite { t: 0.0, at: start });
        }
        let mut pieces = Vec::with_capacity(segments.len());
        let mut i = 0;
        while i < segments.len() {
            i += smooth_run(&segments[i..], options, &mut memory, &mut pieces, &mut out.report)?;
        }
        append(&mut out.path, start, &pieces, closed);
        first += count + 1;
    }
    Ok(out)
}

/// Appends the pieces of the first segments, as far as they join smoothly, and returns their number.
fn smooth_run(
    segments: &[Segment],
    options: &Options,
    memory: &mut ReachMemory,
    pieces: &mut Vec<Piece>,
    report: &mut Report,
) -> Result<usize, NotFinite> {
    let mut run = SegmentRun::new(true, segments.len().min(64));
    let joined = run.extend(segments, options.corner, |segment| {
        let form = if options.prove { segment.quotient() } else { None };
        let ends = [segment.end(0.0)?, segment.end(1.0)?];
        Ok(segment.is_smooth().then(|| RunSegment::new(*segment, form, ends, matches!(segment.seg, PathSeg::Line(_)))))
    })?;
    if joined < 2 {
        let piece = segments.first().map(Segment::piece);
        pieces.extend(piece);
        return Ok(1);
    }
    let own = OwnPieces::new(joined, |i: usize, pieces: &mut Vec<Piece>, _: &mut Report| {
        pieces.push(segments[i].piece());
        Ok(())
    });
    let settings = MergeSettings { tolerance: options.tolerance, proof: options.prove, marks: false, again: false };
    let mut reaches = Reaches::new(&run, own, settings, memory);
    let legs = reaches.fewest()?;
    let (mut own, legs) = refined(&run, reaches.own, legs, settings, memory)?;
    let assurance = if options.prove { Assurance::Certified } else { Assurance::Checked };
    own.append(legs, assurance, pieces, report)?;
    Ok(joined)
}

/// Writes pieces as a subpath. In a closed one, a last line is left to the close command.
pub(crate) fn append(path: &mut BezPath, start: Point, pieces: &[Piece], closed: bool) {
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

    /// The segment itself.
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
