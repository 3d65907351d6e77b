//! Bends an outline and writes it as path data: keeps arcs, chooses decimals, drops closing lines that come from rounding.

use super::options::Edit;
use super::united::AREA_SHARE;
use crate::source::number::{MAX_DECIMALS, arcs_data, path_data, path_data_by};
use pathwarp::edit::{Area, Offset, OpenPaths};
use pathwarp::engine::{SharedEdges, Span, SpanReport};
use pathwarp::kurbo::{BezPath, PathEl, Point, Vec2};
use pathwarp::map::{AffineMap, Class, Map};
use pathwarp::outline::{EllipticArc, Subpath};
use pathwarp::refit::{self, Assurance, PathReport, RefittedPath};
use pathwarp::{GeometryError, Outline, Seg};
use std::f64::consts::PI;
use std::ops::Range;

/// The image of a path.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct WarpedPath {
    /// SVG path data, rounded. Arcs whose images are circles again stay arcs.
    pub data: String,
    /// Lines and cubics, not rounded.
    pub path: BezPath,
    /// Statistics.
    pub report: PathReport,
}

/// Edits a path and writes it as path data, as [`Document::warp`](crate::Document::warp) with the option
/// [`edit`](crate::WarpOptions::edit) writes a `<path>` without a stroke.
///
/// # Errors
/// [`GeometryError::NotFinite`] if a coordinate is not finite, [`GeometryError::Limit`] if the work exceeds the budget of the options,
/// [`GeometryError::Crossings`] if the crossings of an area's edges are not found.
pub fn edit_path(
    outline: &Outline,
    edit: Edit,
    options: &refit::Options,
    precision: Option<u8>,
) -> Result<WarpedPath, GeometryError> {
    // Nothing specifies the fill: subpaths that return to their start are areas, and the others are lines.
    let outline = &returning_closed(outline);
    let edit = match edit {
        Edit::Offset(offset) => Edit::Offset(Offset { open: OpenPaths::Move, ..offset }),
        other => other,
    };
    if let Edit::Unite { .. } = edit {
        // Find the area within a share of the tolerance; the rest is for its gaps.
        let area =
            Area::of(outline, false, AREA_SHARE * options.tolerance)?.with_gaps_closed(options.tolerance, outline);
        let united = area.with_arcs_of(outline, AREA_SHARE * options.tolerance);
        return warp_path(&united, &AffineMap::IDENTITY, options, precision);
    }
    let Some(RefittedPath { path, report, .. }) = edit.apply(outline, options, &[])? else {
        return warp_path(outline, &AffineMap::IDENTITY, options, precision);
    };
    // A path that would not get fewer nodes stays as it is written.
    if matches!(edit, Edit::Simplify { .. }) && report.segments_out >= report.segments_in {
        return warp_path(outline, &AffineMap::IDENTITY, options, precision);
    }
    let digits = Digits { size: 1.0, given: precision, tolerance: options.tolerance };
    Ok(WarpedPath { data: path_data(&path, digits.decimals(options.tolerance)), path, report })
}

/// Closes the subpaths that return to their start.
fn returning_closed(outline: &Outline) -> Outline {
    let mut outline = outline.clone();
    for sub in &mut outline.subpaths {
        sub.closed |= sub.segs.len() > 1 && sub.end() == sub.start;
    }
    outline
}

/// Maps a path and writes its image as path data, as [`Document::warp`](crate::Document::warp) does for a `<path>` in root user
/// space. `precision` is the number of decimals; `None` takes enough for a hundredth of the tolerance.
///
/// ```
/// use pathwarp::map::AffineMap;
/// use pathwarp::{Outline, kurbo::Affine, refit};
///
/// let circle = Outline::from_svg("M0,0 A5,5 0 0 1 10,0")?;
/// let options = refit::Options::new(0.01);
/// let warped = pathwarp_svg::warp_path(&circle, &AffineMap(Affine::scale(2.0)), &options, Some(0))?;
/// assert_eq!(warped.data, "M0,0 A10 10 0 0 1 10 -10 A10 10 0 0 1 20 0");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`GeometryError::Infinity`] if the map is undefined on the path, [`GeometryError::NotFinite`] if a coordinate is not finite,
/// [`GeometryError::Limit`] if the work exceeds the budget of the options, [`GeometryError::Tolerance`] if a tolerance is not positive.
pub fn warp_path(
    outline: &Outline,
    map: &dyn Map,
    options: &refit::Options,
    precision: Option<u8>,
) -> Result<WarpedPath, GeometryError> {
    options.check()?;
    let digits = Digits { size: 1.0, given: precision, tolerance: options.tolerance };
    // The tolerances of the contours.
    let contours: Vec<f64> = outline.subpaths.iter().map(|s| options.of_contour(s)).collect();
    let finest = contours.iter().copied().fold(options.tolerance, f64::min);
    let mut outline = outline.clone();
    outline.subpaths.iter_mut().for_each(|s| drop_closing_stub(s, digits.rounding(finest)));
    let spans = SharedEdges::held([(&outline, &contours[..])]).spans(&outline, &contours);
    let tolerance = digits.remaining(options.tolerance);
    let options = options.clone().with_tolerance(tolerance).with_spans(digits.remaining_for_spans(&spans));
    if let Some((image, report)) = with_arcs(map, &outline, &options, false)? {
        let data = arcs_data(&image, digits.extra_for_arcs(), |i| digits.decimals(contours[i]));
        return Ok(WarpedPath { data, path: image.to_bez_path(finest), report });
    }
    let warped = refit::warp_path(&outline, map, &options)?;
    let mut report = warped.report;
    let [error, share] = digits.errors(&spans, &warped.spans);
    (report.max_error, report.share) = (report.max_error.max(error), share.max(report.max_error / options.tolerance));
    let data = digits.path_data(&warped.path, &outline, &spans, &warped.spans);
    Ok(WarpedPath { data, path: warped.path, report })
}

/// Largest sweep of a written arc. The centre of a longer one is too sensitive to rounding of its ends, without bound at half a turn.
const MAX_SWEEP: f64 = (2.0 / 3.0) * PI;

/// Largest distance of an image from its circle, as a fraction of the radius. Rounding of f64 is far below it.
const CIRCULAR: f64 = 1e-10;

/// Largest radius of an image, in distances between the image's start and its middle. Flatter arcs are better written as curves.
const MAX_RADIUS: f64 = 1e4;

/// Bends an outline in root user space. Images of arcs, and with `lines` of lines, that are circular arcs are arcs in the result. Returns
/// `None` if there are no such images.
pub(super) fn with_arcs(
    map: &dyn Map,
    outline: &Outline,
    options: &refit::Options,
    lines: bool,
) -> Result<Option<(Outline, PathReport)>, GeometryError> {
    let may_be_arc = |s: &Seg| matches!(s, Seg::Arc(_)) || (lines && matches!(s, Seg::Line(_)));
    if !outline.segs().any(may_be_arc) || !outline.segs().all(Seg::is_finite) {
        return Ok(None);
    }
    let mut report = PathReport::default();
    let image = if let Class::Affine(m) = map.class() {
        outline.transformed(m)
    } else if options.certify {
        // The test for circles only compares samples, so it certifies nothing.
        return Ok(None);
    } else {
        if map.prefers_batches() {
            let starts = outline.subpaths.iter().map(|s| s.start);
            map.prepare(&outline.segs().flat_map(compared_points).chain(starts).collect::<Vec<_>>(), &[]);
        }
        let images = |s: &Subpath| {
            s.segs.iter().map(|g| Some(g).filter(|g| may_be_arc(g)).and_then(|g| circular_image(g, map))).collect()
        };
        let arcs: Vec<Vec<Option<EllipticArc>>> = outline.subpaths.iter().map(images).collect();
        if arcs.iter().flatten().all(Option::is_none) {
            return Ok(None);
        }
        let add = |sum: &mut usize, n: usize| {
            *sum += n;
            Some(*sum)
        };
        let span_ends: Vec<usize> = options.spans.iter().map(|s| s.segments).scan(0, add).collect();
        let mut end = 0;
        let subpaths = outline.subpaths.iter().zip(&arcs).map(|(s, arcs)| {
            end += s.segs.len();
            bend_subpath((s, end - s.segs.len()), arcs, map, (options, &span_ends), &mut report)
        });
        Outline { subpaths: subpaths.collect::<Result<_, _>>()? }
    };
    let image = Outline { subpaths: image.subpaths.into_iter().map(divide_long_arcs).collect() };
    report.segments_in = outline.segs().count();
    report.segments_out = image.segs().count();
    report.account_for_rounding(outline, image.extent(), options.tolerance);
    Ok(Some((image, report)))
}

/// Number of intervals at whose ends an image is compared with its circle.
const SAMPLES: u32 = 24;

/// The points of an arc whose images are compared with a circle; none for other segments.
fn compared_points(g: &Seg) -> Vec<Point> {
    let Seg::Arc(arc) = g else { return Vec::new() };
    (0..=SAMPLES).map(|i| arc.eval(f64::from(i) / f64::from(SAMPLES))).collect()
}

/// The image of a circular arc or a line, if that is a circular arc.
fn circular_image(g: &Seg, map: &dyn Map) -> Option<EllipticArc> {
    if let Seg::Arc(arc) = g {
        let r = arc.a.hypot();
        if (arc.b.hypot() - r).abs() > CIRCULAR * r || arc.a.dot(arc.b).abs() > CIRCULAR * r * r {
            return None;
        }
    }
    let image = |i: u32| map.point(g.eval(f64::from(i) / f64::from(SAMPLES)));
    let (first, last) = (image(0), image(SAMPLES));
    // The circle through the ends of the first and the second third, which all samples must follow in one direction.
    let center = circumcenter(first, image(SAMPLES / 3), image(2 * SAMPLES / 3))?;
    let radius = first.distance(center);
    if radius > MAX_RADIUS * first.distance(image(SAMPLES / 2)) {
        return None;
    }
    let (mut sweep, mut before) = (0.0, first - center);
    for i in 1..=SAMPLES {
        let v = image(i) - center;
        let step = before.cross(v).atan2(before.dot(v));
        if (v.hypot() - radius).abs() > CIRCULAR * radius || !v.is_finite() || step * sweep < 0.0 {
            return None;
        }
        sweep += step;
        before = v;
    }
    let start = (first - center).atan2();
    let (a, b) = (Vec2::new(radius, 0.0), Vec2::new(0.0, radius));
    Some(EllipticArc { p0: first, p1: last, center, a, b, start, sweep })
}

/// The centre of the circle through three points; `None` if they lie on a line.
fn circumcenter(p: Point, q: Point, r: Point) -> Option<Point> {
    let (u, v) = (q - p, r - p);
    let d = 2.0 * u.cross(v);
    let to = Vec2::new(v.y * u.hypot2() - u.y * v.hypot2(), u.x * v.hypot2() - v.x * u.hypot2()) / d;
    (p + to).is_finite().then_some(p + to)
}

/// Bends a subpath, given the images of its arcs; the segments between them are refitted. `first` is the index of its first segment in
/// the outline, and `span_ends` are the indices of the segments at which the spans end.
fn bend_subpath(
    (s, first): (&Subpath, usize),
    arcs: &[Option<EllipticArc>],
    map: &dyn Map,
    (options, span_ends): (&refit::Options, &[usize]),
    report: &mut PathReport,
) -> Result<Subpath, GeometryError> {
    let mut out = Subpath { start: map.point(s.start), segs: Vec::with_capacity(s.segs.len()), closed: s.closed };
    let mut rest = s.segs.iter().zip(arcs).zip(first..).peekable();
    while let Some(((g, arc), from)) = rest.next() {
        if let Some(arc) = arc {
            let p0 = out.end();
            out.segs.push(Seg::Arc(EllipticArc { p0, ..*arc }));
            report.assurance = report.assurance.min(Assurance::Checked);
            report.max_error = report.max_error.max(CIRCULAR * arc.a.hypot());
            continue;
        }
        let mut run = Subpath { start: g.start(), segs: vec![*g], closed: false };
        while let Some(((g, _), _)) = rest.next_if(|((_, arc), _)| arc.is_none()) {
            run.segs.push(*g);
        }
        let options = options.clone().with_spans(spans_within(&options.spans, span_ends, from..from + run.segs.len()));
        let refitted = refit::warp_path(&Outline { subpaths: vec![run] }, map, &options)?;
        report.add(refitted.report);
        out.segs.extend(Outline::from(&refitted.path).subpaths.into_iter().flat_map(|s| s.segs));
    }
    Ok(out)
}

/// The spans within a range of segments, cut at its ends. `ends` are the indices of the segments at which the spans end.
fn spans_within(spans: &[Span], ends: &[usize], segments: Range<usize>) -> Vec<Span> {
    let first = ends.partition_point(|end| *end <= segments.start);
    let overlapping =
        spans[first..].iter().zip(&ends[first..]).take_while(|(s, end)| **end - s.segments < segments.end);
    let cut = |(s, &end): (&Span, &usize)| {
        let start = (end - s.segments).max(segments.start);
        Span { segments: end.min(segments.end) - start, ..*s }
    };
    overlapping.map(cut).collect()
}

/// Divides arcs of more than [`MAX_SWEEP`].
fn divide_long_arcs(s: Subpath) -> Subpath {
    let divided = |g: Seg| -> Vec<Seg> {
        match g {
            Seg::Arc(a) => {
                let n = (a.sweep.abs() / MAX_SWEEP).ceil().max(1.0);
                (0..n as u32).map(|i| Seg::Arc(a.subsegment(f64::from(i) / n, f64::from(i + 1) / n))).collect()
            }
            other => vec![other],
        }
    };
    Subpath { segs: s.segs.into_iter().flat_map(divided).collect(), ..s }
}

/// The fraction of the tolerance that rounding may use.
pub(super) const ROUNDING: f64 = 0.01;

/// The number of decimals of coordinates: the given one, or enough for [`ROUNDING`]. `size` is the length of a unit as written, in root
/// user units.
pub(super) fn decimals(size: f64, tolerance: f64, given: Option<u8>) -> u8 {
    given.unwrap_or_else(|| {
        let needed = (size * std::f64::consts::FRAC_1_SQRT_2 / (ROUNDING * tolerance)).log10().ceil();
        if needed.is_finite() { needed.clamp(0.0, f64::from(MAX_DECIMALS)) as u8 } else { MAX_DECIMALS }
    })
}

/// Largest error from rounding, in units of the last decimal: half the diagonal of a square unit, and 0.3 for cubics written as quadratics.
const ERROR_PER_UNIT: f64 = std::f64::consts::FRAC_1_SQRT_2 + 0.3;

/// Largest error from rounding to `decimals`, in root user units.
pub(super) fn rounding(size: f64, decimals: u8) -> f64 {
    size * ERROR_PER_UNIT * 0.1_f64.powi(i32::from(decimals))
}

/// The tolerance that remains after rounding.
pub(super) fn allowed(tolerance: f64, rounding: f64) -> f64 {
    (tolerance - rounding).max(0.5 * tolerance)
}

/// Rounding may use this many times [`ROUNDING`] of a contour's tolerance: a tenth of it.
const CONTOUR_FACTOR: f64 = 10.0;

/// Determines the decimals of written coordinates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Digits {
    /// The length of a unit as written, in root user units.
    pub(super) size: f64,
    /// The requested number of decimals, if any.
    pub(super) given: Option<u8>,
    /// The tolerance of the drawing.
    pub(super) tolerance: f64,
}

impl Digits {
    /// The number of decimals for a contour: the whole drawing's, or more if its rounding exceeds a tenth of the contour's tolerance.
    pub(super) fn decimals(self, tolerance: f64) -> u8 {
        decimals(self.size, self.tolerance.min(CONTOUR_FACTOR * tolerance), self.given)
    }

    /// The number of additional decimals that an arc may have.
    pub(super) fn extra_for_arcs(self) -> u8 {
        if self.given.is_none() { 4 } else { 0 }
    }

    /// The largest error from rounding a contour with this tolerance, in root user units.
    pub(super) fn rounding(self, tolerance: f64) -> f64 {
        rounding(self.size, self.decimals(tolerance))
    }

    /// The largest step between coordinates that rounding may have, in units as written; the unit of the last decimal is the power of ten
    /// below. In root user space it is the same under any transform. `None` if the number of decimals is requested.
    pub(super) fn coarsest(self, tolerance: f64) -> Option<f64> {
        let unit = || ROUNDING * self.tolerance.min(CONTOUR_FACTOR * tolerance) * std::f64::consts::SQRT_2 / self.size;
        self.given.is_none().then(unit)
    }

    /// The tolerance that remains after rounding. It does not depend on the transform (`size`) unless a number of decimals is requested,
    /// so that neighbours under different transforms share edges.
    pub(super) fn remaining(self, tolerance: f64) -> f64 {
        let rounding =
            self.coarsest(tolerance).map_or_else(|| self.rounding(tolerance), |u| u * self.size * ERROR_PER_UNIT);
        allowed(tolerance, rounding)
    }

    /// The spans with the tolerances that remain after rounding.
    pub(super) fn remaining_for_spans(self, spans: &[Span]) -> Vec<Span> {
        spans.iter().map(|s| Span { tolerance: self.remaining(s.tolerance), ..*s }).collect()
    }

    /// The largest error of the spans, including rounding, and the largest fraction of a span's tolerance that its error takes.
    pub(super) fn errors(self, spans: &[Span], reports: &[SpanReport]) -> [f64; 2] {
        let errors = spans.iter().zip(reports).map(|(s, r)| (r.max_error + self.rounding(s.tolerance), s.tolerance));
        errors.fold([0.0, 0.0], |[error, share], (e, t)| [f64::max(error, e), f64::max(share, e / t)])
    }

    /// Writes `path`, the image of `outline`, with decimals for each span.
    pub(super) fn path_data(self, path: &BezPath, outline: &Outline, spans: &[Span], reports: &[SpanReport]) -> String {
        // For each element, the decimals of its handles and of its node, and the coarsest unit.
        let mut decimals: Vec<[u8; 2]> = Vec::with_capacity(path.elements().len());
        let mut units = Vec::with_capacity(path.elements().len());
        let mut spans = spans.iter().zip(reports).map(|(s, r)| (s, r.pieces)).peekable();
        let mut subpaths = outline.subpaths.iter();
        // Number of segments of the subpath whose spans are not done.
        let mut left = 0;
        for el in path.elements() {
            units.push(spans.peek().and_then(|(s, _)| self.coarsest(s.tolerance)));
            decimals.push(match el {
                PathEl::MoveTo(_) => {
                    // Skip the closing lines of the previous subpath, which are not written.
                    while left > 0 {
                        left -= spans.next().map_or(left, |(s, _)| s.segments);
                    }
                    left = subpaths.next().map_or(0, |s| s.segs.len());
                    let start = spans.peek().filter(|_| left > 0).map_or(f64::INFINITY, |(s, _)| s.nodes[0]);
                    [self.decimals(start); 2]
                }
                PathEl::ClosePath => [0; 2],
                _ => match spans.peek_mut() {
                    None => [MAX_DECIMALS; 2],
                    Some((s, pieces)) => {
                        let is_last = *pieces <= 1; // At its end, a span may meet contours with smaller tolerances.
                        let handles = self.decimals(s.tolerance);
                        let node = if is_last { handles.max(self.decimals(s.nodes[1])) } else { handles };
                        *pieces = pieces.saturating_sub(1);
                        if is_last {
                            left -= s.segments.min(left);
                            spans.next();
                        }
                        [handles, node]
                    }
                },
            });
        }
        path_data_by(path, |i| units[i], |i| decimals[i])
    }
}

/// Returns `true` if a subpath ends with a closing line not longer than `shortest`, after other segments.
pub(super) fn has_closing_stub(s: &Subpath, shortest: f64) -> bool {
    matches!(s.segs.as_slice(), [.., _, Seg::Line(stub)] if s.closed && stub.p0.distance(stub.p1) <= shortest)
}

/// Drops the closing line of a subpath if it is a stub. The segment before it then ends at the start.
pub(super) fn drop_closing_stub(s: &mut Subpath, shortest: f64) {
    if has_closing_stub(s, shortest) {
        s.segs.pop();
        match s.segs.last_mut() {
            Some(Seg::Line(l)) => l.p1 = s.start,
            Some(Seg::Quad(q)) => q.p2 = s.start,
            Some(Seg::Cubic(c)) => c.p3 = s.start,
            Some(Seg::Arc(a)) => a.p1 = s.start,
            None => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::Outline;

    #[test]
    fn only_stubs_are_dropped() {
        for (d, shortest, segments) in [
            ("M0 0C5 5 9 5 9 0L1e-9 1e-9Z", 1e-6, 2),
            ("M0 0C5 5 9 5 9 0L1e-9 1e-9Z", 1e-10, 3),
            ("M0 0C5 5 9 5 9 0L1e-9 1e-9", 1e-6, 2),
            ("M0 0C5 5 9 5 9 0Z", 1e-6, 2),
            ("M0 0A5 5 0 0 1 9 1A5 5 0 0 1 1e-9 1e-9Z", 1e-6, 2),
            ("M0 0L1e-9 0Z", 1e-6, 1),
        ] {
            let mut s = Outline::from_svg_lossy(d).subpaths.remove(0);
            drop_closing_stub(&mut s, shortest);
            assert_eq!(s.segs.len(), segments, "{d}");
            assert!(!s.closed || s.end() == s.start, "{d}");
        }
    }
}
