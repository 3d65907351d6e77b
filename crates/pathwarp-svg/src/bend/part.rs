//! Bends a part: its path, fill, stroke and paints.

use super::fits::{self, PaintFit};
use super::gradients::{BentGradient, NewGradient, PaintedGradient};
use super::options::{Strokes, WarpOptions};
use super::outcome::{StrokeOutcome, WarpedPart};
use super::pictures::PictureError;
use super::task::{BentPath, LetterPiece, PartTask};
use super::{path, stroke};
use crate::scene::geometry::stretch;
use crate::scene::model::{Part, PartRole};
use pathwarp::kurbo::{BezPath, Line, ParamCurveNearest as _, Point, Shape as _};
use pathwarp::map::Class;
use pathwarp::outline::Subpath;
use pathwarp::refit::PathReport;
use pathwarp::{GeometryError, Outline, Seg};
use usvg::{Paint, Stroke};

/// Bends a part with its paints.
pub(super) fn warp(t: &PartTask<'_>) -> Result<WarpedPart, GeometryError> {
    let p = t.part;
    // The centre line of an outlined stroke is not written, so a draft suffices.
    let draft = p.fill.is_none() && p.stroke.as_ref().is_some_and(|s| expands(t, s)) && !p.in_tile;
    let bent = if draft { t.draft()? } else { t.bend(&t.outline, &t.contours)? };
    let fit = paint_fit(t, &bent.path);
    let (segments_in, pieces) = (bent.report.segments_in, bent.report.segments_out);
    let Filled { mut path, mut data, fill, mut report } = bend_fill(t, bent)?;
    // A gradient on a stroke can become a picture only if the stroke is expanded.
    let stroke_gradient = p.stroke.as_ref().and_then(|s| BentGradient::replacing(t, s.paint(), fit, expands(t, s)));
    let mut unpainted = None;
    let (stroke_gradient, stroke_picture) = by_kind(stroke_gradient, &mut unpainted);
    let stroke = stroke::stroke(t, &path, pieces, stroke_picture.is_some())?;
    if draft && stroke.outcome.outline().is_none() {
        let refitted = t.bend(&t.outline, &t.contours)?;
        (path, data, report) = (refitted.path, refitted.data, [Some(refitted.report), None]);
    }
    let error = report[0].as_ref().map_or(0.0, |r| r.max_error);
    // Report only what is written. If only the expanded stroke is painted, the path is not.
    let mut written = kept_reports(p, &stroke.outcome, report, fill.is_some());
    written.extend(stroke.report);
    let report = combined_report(segments_in, written);
    let fill_gradient = p.fill.as_ref().and_then(|f| BentGradient::replacing(t, f.paint(), fit, true));
    let (fill_gradient, fill_picture) = by_kind(fill_gradient, &mut unpainted);
    let mut out = WarpedPart {
        path,
        fill,
        decimals: t.decimals,
        coarsest: t.coarsest(),
        data,
        stroke: stroke.outcome,
        stroke_error: stroke.error.map(|e| e + stroke.leverage * (error + t.rounding)),
        stroke_off_domain: stroke.off_domain,
        fit,
        fill_gradient,
        stroke_gradient,
        fill_image: None,
        stroke_image: None,
        unpainted,
        residual: None,
        report,
        rounding: t.rounding,
    };
    let filled = out.fill.as_ref().filter(|f| !f.is_empty()).unwrap_or(&out.path);
    out.fill_image = fill_picture.and_then(|g| g.painted(t, filled, &mut out.unpainted));
    if let (Some(g), StrokeOutcome::Outlined(outline)) = (stroke_picture, &out.stroke) {
        out.stroke_image = g.painted(t, outline, &mut out.unpainted);
    }
    out.residual = fit.filter(|_| follows_fit(p, &out, t.options())).map(|f| f.miss * stretch(t.write));
    Ok(out)
}

/// The replacement of a gradient, by kind: a gradient or a picture. Records the reason why there is none in `unpainted`.
fn by_kind(
    bent: Option<BentGradient>,
    unpainted: &mut Option<PictureError>,
) -> (Option<NewGradient>, Option<PaintedGradient>) {
    match bent {
        None => (None, None),
        Some(BentGradient::Near(near)) => (Some(near), None),
        Some(BentGradient::Picture(picture)) => (None, Some(picture)),
        Some(BentGradient::Unbent(why)) => {
            *unpainted = Some(why);
            (None, None)
        }
    }
}

/// Returns `true` if a part's stroke may become an outline.
fn expands(t: &PartTask<'_>, s: &Stroke) -> bool {
    match t.options().strokes {
        Strokes::Outline => !t.part.fixed_width,
        Strokes::Auto => !t.part.fixed_width && !stroke::is_hairline(t, s),
        Strokes::Keep | Strokes::Scale => false,
    }
}

/// Finds the affine fit for the part's gradients and patterns.
fn paint_fit(t: &PartTask<'_>, path: &BezPath) -> Option<PaintFit> {
    let p = t.part;
    let mut paints = p.fill.iter().map(usvg::Fill::paint).chain(p.stroke.iter().map(Stroke::paint));
    if paints.all(|paint| matches!(paint, Paint::Color(_))) {
        return None;
    }
    let options = t.options();
    let area = p.local.bounding_box()?;
    match t.pieces {
        // The paint of a single placed letter moves with it.
        [LetterPiece { copies, .. }] if copies.len() == 1 => {
            fits::fit(area, copies[0] * p.frame, t.write, &options.letters.after)
        }
        _ => fits::fit_copies(area, p.frame, t.write, t.context.map, &options.copies, path.bounding_box()),
    }
}

/// The bent path of a part and its fill.
struct Filled {
    path: BezPath,
    /// The path data of the path, if already written.
    data: Option<String>,
    /// The filled outline if it is separate.
    fill: Option<BezPath>,
    /// Reports on the path and on the fill.
    report: [Option<PathReport>; 2],
}

/// The reports on a path and its fill, as far as they are written.
fn kept_reports(p: &Part, stroke: &StrokeOutcome, reports: [Option<PathReport>; 2], separate: bool) -> Vec<PathReport> {
    let [path, fill] = reports;
    let hidden = stroke.outline().is_some() && !p.in_tile && (p.fill.is_none() || separate);
    path.filter(|_| !hidden).into_iter().chain(fill).collect()
}

/// Combines the reports on several outlines of a source with `segments_in` segments.
fn combined_report(segments_in: usize, all: Vec<PathReport>) -> PathReport {
    let mut none = PathReport::default();
    none.segments_in = segments_in;
    all.into_iter().fold(none, |mut sum, r| {
        sum.segments_out += r.segments_out;
        sum.add(r);
        sum
    })
}

/// Bends the filled area if it differs from the path, whose image is `bent`.
fn bend_fill(t: &PartTask<'_>, bent: BentPath) -> Result<Filled, GeometryError> {
    let BentPath { path, data, report } = bent;
    let stroked = t.part.stroke.is_some() && t.part.role != PartRole::Clip;
    // With `Strokes::Keep`, each centre line has to stay one path, so only fills without a stroke are closed.
    let closes = !(stroked && t.options().strokes == Strokes::Keep);
    let seen = if stroked { t.seen_fill()? } else { None };
    let area = || filled_area(t, t.finest).filter(|(a, _)| closes || a.is_empty());
    let area = seen.map(|seen| (seen, Vec::new())).or_else(area);
    let report = Some(report);
    Ok(match area {
        None => Filled { path, data, fill: None, report: [report, None] },
        Some((area, _)) if area.is_empty() => Filled { path, data, fill: Some(BezPath::new()), report: [report, None] },
        Some((area, contours)) => {
            let closed = t.bend(&area, &contours)?;
            if stroked {
                Filled { path, data, fill: Some(closed.path), report: [report, Some(closed.report)] }
            } else {
                Filled { path: closed.path, data: closed.data, fill: None, report: [Some(closed.report), None] }
            }
        }
    })
}

/// Closes the subpaths of a fill if the map bends one of the closing lines, which are not drawn. Drops subpaths that enclose
/// nothing. Returns `None` if the fill equals the outline, else the fill with the tolerances of its contours.
fn filled_area(t: &PartTask<'_>, tolerance: f64) -> Option<(Outline, Vec<f64>)> {
    /// Samples along a line.
    const SAMPLES: u32 = 16;
    /// Fraction of the tolerance by which a line may bend at the samples, since it may bend more between them.
    const STRAIGHT: f64 = 0.95;
    let (p, outline, map) = (t.part, &t.outline, t.map);
    let sample = |a: Point, b: Point, i: u32| a.lerp(b, f64::from(i) / f64::from(SAMPLES));
    let bends = |a: Point, b: Point| {
        let chord = Line::new(map.point(a), map.point(b));
        (1..SAMPLES).any(|i| {
            let q = map.point(sample(a, b, i));
            let distance = chord.nearest(q, tolerance).distance_sq.sqrt();
            distance > STRAIGHT * tolerance && q.is_finite()
        })
    };
    let open = |s: &Subpath| !s.closed && s.start != s.end();
    if (p.fill.is_none() && p.role != PartRole::Clip) || matches!(map.class(), Class::Affine(_)) {
        return None;
    }
    if map.prefers_batches() {
        let lines = outline.subpaths.iter().filter(|s| open(s)).map(|s| (s.end(), s.start));
        let line = |(a, b): (Point, Point)| (1..SAMPLES).map(move |i| sample(a, b, i)).chain([a, b]);
        map.prepare(&lines.flat_map(line).collect::<Vec<_>>(), &[]);
    }
    if !outline.subpaths.iter().any(|s| open(s) && bends(s.end(), s.start)) {
        return None;
    }
    let closed = |s: &Subpath| {
        let mut s = s.clone();
        if open(&s) {
            s.segs.push(Seg::Line(Line::new(s.end(), s.start)));
            s.closed = true;
            path::drop_closing_stub(&mut s, t.rounding);
        }
        s
    };
    let encloses = |s: &&Subpath| !open(s) || !matches!(s.segs.as_slice(), [] | [Seg::Line(_)]);
    let kept = |i: &usize| encloses(&&outline.subpaths[*i]);
    let contours = (0..t.contours.len()).filter(kept).map(|i| t.contours[i]).collect();
    Some((Outline { subpaths: outline.subpaths.iter().filter(encloses).map(closed).collect() }, contours))
}

/// Returns `true` if one of the part's paints follows the affine fit: no gradient, picture or tiles replace it.
fn follows_fit(p: &Part, warped: &WarpedPart, options: &WarpOptions) -> bool {
    let w = warped;
    let fill_replaced = w.fill_gradient.is_some() || w.fill_image.is_some() || p.fill_tiles.is_some();
    let stroke_replaced = w.stroke_gradient.is_some() || w.stroke_image.is_some() || p.stroke_tiles.is_some();
    p.fill.as_ref().is_some_and(|f| options.moves(f.paint()) && !fill_replaced)
        || p.stroke.as_ref().is_some_and(|s| options.moves(s.paint()) && !stroke_replaced)
}
