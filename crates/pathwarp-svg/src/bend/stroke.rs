//! Bends strokes: scales their width, or expands them to outlines.

use super::options::{Edit, Strokes};
use super::outcome::StrokeOutcome;
use super::task::PartTask;
use super::width::StrokeWidth;
use crate::scene::areas::{spend_dashes, spend_stroke, stroke_outlines};
use crate::scene::geometry::stretch;
use pathwarp::engine::SharedEdges;
use pathwarp::kurbo::{Affine, BezPath, Point};
use pathwarp::refit::{self, Assurance, PathReport};
use pathwarp::{GeometryError, Outline, fit};
use usvg::Stroke;

/// Fraction of the tolerance for the sides of a stroke.
const SIDES: f64 = 0.15;
/// Fraction of the tolerance for gaps between sides, half of it for either side.
const GAPS: f64 = 0.3;
/// Fraction of the tolerance for expanding the stroke. The rest is for refitting the outline.
const EXPANSION: f64 = SIDES + 0.5 * GAPS;

/// Fraction of the tolerance for making outlines simple.
const UNION: f64 = 0.1;
/// Fraction of the tolerance that an expansion may take before it is repeated.
const MAX_EXPANSION: f64 = 0.5;
/// Finest tolerance of an expansion, in user units.
const FINEST: f64 = 1e-9;
/// Finest tolerance of an expansion as a fraction of the largest coordinate, so that rounding is smaller.
const FINEST_SHARE: f64 = 64.0 * f64::EPSILON;

/// Index that stands for the whole drawing instead of a contour.
const DRAWING: usize = usize::MAX;

/// A bent stroke with the measures for its report.
pub(super) struct BentStroke {
    pub(super) outcome: StrokeOutcome,
    /// Report on the outline.
    pub(super) report: Option<PathReport>,
    /// Largest distance of a scaled stroke from the exact one, in root user units, as if the path were exact.
    pub(super) error: Option<f64>,
    /// Factor by which the path's error adds to `error`.
    pub(super) leverage: f64,
    /// `true` if the stroke should be outlined, but the map is not defined around it.
    pub(super) off_domain: bool,
}

impl BentStroke {
    fn scaled(scale: f64, error: Option<f64>) -> Self {
        Self { outcome: StrokeOutcome::Scaled(scale), report: None, error, leverage: 1.0, off_domain: false }
    }

    /// A scaled stroke of known width; `pieces` is the number of segments of the path.
    fn with_width(w: &StrokeWidth<'_>, scale: f64, pieces: usize) -> Self {
        Self { leverage: w.leverage(pieces), ..Self::scaled(scale, Some(w.error(scale))) }
    }

    /// A scaled stroke of unknown width, where the map has no derivative on the path.
    fn unknown() -> Self {
        Self::scaled(1.0, Some(f64::INFINITY))
    }

    fn outlined(path: BezPath, report: Option<PathReport>) -> Self {
        Self { outcome: StrokeOutcome::Outlined(path), report, ..Self::scaled(1.0, None) }
    }
}

/// Returns `true` if a stroke is a hairline, which only marks its centre line: no wider than the tolerance, or than a hairline in print.
pub(super) fn is_hairline(t: &PartTask<'_>, s: &Stroke) -> bool {
    let width = f64::from(s.width().get()) * stretch(t.part.frame);
    // usvg keeps widths in single precision.
    width <= t.options().refit.tolerance.max(t.context.hairline) * (1.0 + f64::from(f32::EPSILON))
}

/// Warps the stroke of a part whose path is bent to `path` of `pieces` segments. A stroke with a picture (`pictured`) is always expanded.
pub(super) fn stroke(
    t: &PartTask<'_>,
    path: &BezPath,
    pieces: usize,
    pictured: bool,
) -> Result<BentStroke, GeometryError> {
    let p = t.part;
    if p.in_tile && p.stroke.is_some() {
        return Ok(BentStroke::outlined(path.clone(), None));
    }
    let resolves = t.options().edit == Some(Edit::Resolve);
    let Some(s) = p.stroke.as_ref().filter(|_| !p.fixed_width || resolves) else {
        return Ok(BentStroke::scaled(1.0, None));
    };
    // Even a stroke that is not outlined is expanded with its dashes, to measure its box.
    spend_dashes(&p.local, s, &t.options().refit.budget).map_err(GeometryError::Limit)?;
    let mode = t.options().strokes;
    if p.fixed_width {
        let (path, report) = outline(t, s, stretch(t.part.frame))?;
        return Ok(BentStroke::outlined(path, Some(report)));
    }
    if mode == Strokes::Keep {
        return Ok(BentStroke::scaled(1.0, None));
    }
    let width = StrokeWidth::sample(t, s, pieces);
    let scaled = |w: &StrokeWidth<'_>, scale: f64| BentStroke::with_width(w, scale, pieces);
    let mean = || width.as_ref().map_or_else(BentStroke::unknown, |w| scaled(w, w.mean()));
    if mode == Strokes::Scale {
        return Ok(mean());
    }
    if mode == Strokes::Auto {
        let hairline = is_hairline(t, s);
        let needs_outline = !hairline && (p.stroke_tiles.is_some() || pictured);
        if let Some(w) = width.as_ref().filter(|_| !needs_outline) {
            let right = [w.mean(), w.middle()].into_iter().find(|s| w.is_right(*s, t.options().refit.tolerance));
            if let Some(scale) = right.or_else(|| hairline.then(|| w.mean())) {
                return Ok(scaled(w, scale));
            }
        }
    }
    // The stretch on the path, from its user space to root user space.
    let known = width.as_ref().map(|w| w.stretch).filter(|s| *s > 0.0 && s.is_finite());
    match outline(t, s, known.unwrap_or_else(|| stretch(p.frame))) {
        Ok((path, report)) => Ok(BentStroke::outlined(path, Some(report))),
        // The outline may leave the map's domain; scale the width instead.
        Err(e) if mode == Strokes::Auto && !matches!(e, GeometryError::Limit(_)) => {
            Ok(BentStroke { off_domain: true, ..mean() })
        }
        Err(e) => Err(e),
    }
}

/// Expands a part's stroke and bends the outline. `stretch` is the assumed factor by which the map stretches lengths near the path, from
/// the part's user space to root user space. If the map turns out to stretch the outline more, the stroke is expanded again.
fn outline(t: &PartTask<'_>, s: &Stroke, stretch: f64) -> Result<(BezPath, PathReport), GeometryError> {
    let (p, options) = (t.part, t.options());
    // A stroke of fixed width is expanded on the page.
    let to_px = t.context.to_px;
    let on_page = p.fixed_width.then(|| Outline::clone(&t.outline).transformed(to_px));
    let (local, frame) = on_page.as_ref().map_or((&*p.local, p.frame), |o| (o, to_px.inverse()));
    spend_stroke(&p.local, s, &options.refit.budget).map_err(GeometryError::Limit)?;
    // The outline of every contour, with the contour's index in the part; `tolerance` is that of each expansion, in the part's user space.
    let expanded = |tolerance: &dyn Fn(usize) -> f64| -> Vec<(usize, Outline)> {
        let one = |local: &Outline, copies: &[Affine], first: usize| {
            let tolerances = |i: usize| [SIDES, GAPS].map(|share| (share / EXPANSION) * tolerance(first + i));
            let placed = |(i, o): (usize, Outline)| (first + i, o.transformed(frame).repeated(copies));
            stroke_outlines(local, s, tolerances).into_iter().map(placed).collect::<Vec<_>>()
        };
        if t.pieces.is_empty() {
            one(local, &options.copies, 0)
        } else {
            t.pieces.iter().flat_map(|piece| one(&piece.cut_from(local), &piece.copies, piece.first())).collect()
        }
    };
    let extent =
        local.bounding_box().map_or(0.0, |b| [b.x0, b.x1, b.y0, b.y1].map(f64::abs).into_iter().fold(0.0, f64::max));
    let least = FINEST.max(FINEST_SHARE * extent);
    let tolerance = |i: usize, stretch: f64| ((t.allowed_of(i) * EXPANSION) / stretch).max(least);
    let largest = |all: &[(usize, Outline)]| all.iter().map(|(_, o)| largest_stretch(t, o)).fold(0.0, f64::max);
    let (mut assumed, allowed) = (stretch, t.allowed_of(DRAWING));
    let mut outlines = expanded(&|i| tolerance(i, assumed));
    let mut found = largest(&outlines);
    // The map may stretch more beside the path than on it.
    let expansion = tolerance(DRAWING, assumed) * found;
    if expansion > MAX_EXPANSION * allowed {
        assumed *= expansion / (allowed * EXPANSION);
        outlines = expanded(&|i| tolerance(i, assumed));
        found = largest(&outlines);
    }
    // Errors in root user space: of the expansion, and of the union. The rest of the tolerance is for refitting.
    let expansion = |i: usize| tolerance(i, assumed) * found;
    let finest = t.whole_contours.iter().copied().fold(allowed, f64::min);
    let united = if options.union { UNION * finest } else { 0.0 };
    let rest = |i: usize| (t.allowed_of(i) - expansion(i)).max((1.0 - MAX_EXPANSION) * t.allowed_of(i)) - united;
    let mut refit = t.refit(rest(DRAWING));
    let mut contours: Vec<usize> = outlines.iter().flat_map(|(i, o)| vec![*i; o.subpaths.len()]).collect();
    let mut whole = Outline { subpaths: outlines.into_iter().flat_map(|(_, o)| o.subpaths).collect() };
    if let Some(hidden) = t.hidden {
        whole = t.seen_area(hidden, &whole, false)?;
        contours = vec![DRAWING; whole.subpaths.len()];
    }
    if !t.whole_contours.is_empty() {
        let rests: Vec<f64> = contours.iter().map(|i| rest(*i)).collect();
        refit = refit.with_spans(SharedEdges::default().spans(&whole, &rests));
    }
    let warped = refit::warp_path(&whole, t.map, &refit)?;
    let mut report = warped.report;
    let largest = contours.iter().map(|i| expansion(*i)).fold(0.0, f64::max);
    report.max_error += united + if t.whole_contours.is_empty() { expansion(DRAWING) } else { largest };
    // Hide that the fractions add up to a little more than the whole after rounding.
    if (allowed..allowed * (1.0 + 1e-12)).contains(&report.max_error) {
        report.max_error = allowed;
    }
    report.assurance = report.assurance.min(Assurance::Checked);
    let path = if options.union { fit::union(&warped.path, united)? } else { warped.path };
    Ok((t.to_local(path), report))
}

/// The largest factor by which the map stretches lengths at the nodes of an expanded stroke, from the part's user space to root user space.
fn largest_stretch(t: &PartTask<'_>, outline: &Outline) -> f64 {
    let frame = stretch(t.part.frame);
    let stretch_at = |p: Point| {
        let jet = t.map.jet(p);
        stretch(Affine::new([jet.dx.x, jet.dx.y, jet.dy.x, jet.dy.y, 0.0, 0.0])) * frame
    };
    // NaN is ignored: the refit reports where the map is undefined.
    outline.segs().map(|s| stretch_at(s.start())).fold(0.0, f64::max)
}
