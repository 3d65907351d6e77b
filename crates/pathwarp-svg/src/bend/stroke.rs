//! Strokes under a map: the scaled width, its error, and expanded outlines.

use super::options::Strokes;
use super::outcome::StrokeOutcome;
use super::task::PartTask;
use crate::scene::affine::stretch;
use crate::scene::expand::stroke_outline;
use crate::scene::regular::is_point;
use pathwarp::kurbo::{Affine, BezPath, Vec2};
use pathwarp::map::{AffineMap, Chain, Map};
use pathwarp::refit::{self, PathReport};
use pathwarp::{GeometryError, Outline};
use std::sync::Arc;
use usvg::{LineCap, Stroke};

/// Largest relative error of the width of a scaled stroke; beyond it, the stroke is expanded.
const WIDTH_ERROR: f64 = 0.02;

/// Share of the tolerance for expanding a stroke; the rest is for refitting the outline. Twice as much needs two thirds of the
/// segments, so a finer outline would cost more nodes than a finer refit saves.
const EXPANSION: f64 = 0.5;

/// Warps the stroke of a part whose path is bent to `path`. A stroke with a picture (`pictured`) is always expanded.
/// An expanded stroke has a report.
pub(super) fn stroke(
    t: &PartTask<'_>,
    path: &BezPath,
    pictured: bool,
) -> Result<(StrokeOutcome, Option<PathReport>), GeometryError> {
    let p = t.part;
    let scaled = |scale: f64| (StrokeOutcome::Scaled(scale), None);
    let expanded = |(path, report): (BezPath, PathReport)| (StrokeOutcome::Outlined(path), Some(report));
    if p.in_tile && p.stroke.is_some() {
        return Ok((StrokeOutcome::Outlined(path.clone()), None));
    }
    let Some(s) = p.stroke.as_ref().filter(|_| !p.fixed_width) else { return Ok(scaled(1.0)) };
    Ok(match t.options().strokes {
        Strokes::Keep => scaled(1.0),
        Strokes::Scale => scaled(part_width(t, s).map_or(1.0, |w| w.scale)),
        Strokes::Outline => expanded(outlined(t, s)?),
        Strokes::Auto => match part_width(t, s).filter(|_| p.stroke_tiles.is_none() && !pictured) {
            Some(w) if w.error <= WIDTH_ERROR => scaled(w.scale),
            // The outline may reach outside of the map's domain; then scale the width.
            w => outlined(t, s).map_or_else(|_| scaled(w.map_or(1.0, |w| w.scale)), expanded),
        },
    })
}

/// Finds the width of a part's stroke, over all placed letters.
fn part_width(t: &PartTask<'_>, s: &Stroke) -> Option<StrokeWidth> {
    if t.pieces.is_empty() {
        return width(&t.outline, t.part.frame, t.write, t.context.map, s);
    }
    let each = t.pieces.iter().flat_map(|piece| piece.places.iter().map(move |m| (piece, *m)));
    let widths = each.map(|(piece, m)| {
        let mut map = Chain::new([Arc::new(AffineMap(m)) as Arc<dyn Map>]);
        map.push(Arc::new(t.options().letters.after.clone()));
        width(&piece.of(&t.whole), t.part.frame, t.write, &map, s)
    });
    StrokeWidth::common(&widths.collect::<Option<Vec<_>>>()?)
}

/// Expands a part's stroke and bends the outline.
fn outlined(t: &PartTask<'_>, s: &Stroke) -> Result<(BezPath, PathReport), GeometryError> {
    let (p, options) = (t.part, t.options());
    let fine = (options.refit.tolerance / stretch(p.frame) * EXPANSION).max(1e-9);
    let expanded = |local: &Outline, places: &[Affine]| {
        stroke_outline(local, s, fine).transformed(p.frame).repeated(places).subpaths
    };
    let subpaths = if t.pieces.is_empty() {
        expanded(&p.local, &options.copies)
    } else {
        t.pieces.iter().flat_map(|piece| expanded(&piece.of(&p.local), &piece.places)).collect()
    };
    let refit = options.refit.clone().with_tolerance(options.refit.tolerance * (1.0 - EXPANSION));
    let warped = refit::warp_path(&Outline { subpaths }, t.map, &refit)?;
    Ok((t.to_local(warped.path), warped.report))
}

/// Change of a stroke's width along a path.
#[derive(Debug, Clone, Copy, PartialEq)]
struct StrokeWidth {
    /// Factor for width and dashes.
    scale: f64,
    /// Largest relative error of the factor along the path.
    error: f64,
}

/// Applies the linear part of `m`.
fn linear(m: Affine, v: Vec2) -> Vec2 {
    let [a, b, c, d, ..] = m.as_coeffs();
    Vec2::new(a * v.x + c * v.y, b * v.x + d * v.y)
}

/// Finds the width of a stroke along `outline` (in root user space) whose user space has the transform `read` in the source
/// and `write` in the result. Returns `None` if the map's derivative is not finite.
fn width(outline: &Outline, read: Affine, write: Affine, map: &dyn Map, stroke: &Stroke) -> Option<StrokeWidth> {
    let (before, after) = (read.inverse(), write.inverse());
    let frames = (after.determinant() / before.determinant()).abs();
    let (mut across, mut along) = (Vec::new(), Vec::new());
    let (mut area, mut length) = (0.0, 0.0);
    let mut dots: Vec<f64> = Vec::new();
    let segments = outline.segs().count().max(1);
    // Long paths need fewer samples per segment.
    let samples: &[f64] = match segments {
        0..=64 => &[0.0, 0.25, 0.5, 0.75, 1.0],
        65..=4096 => &[0.1, 0.5, 0.9],
        _ => &[0.5],
    };
    for s in outline.segs() {
        for &t in samples {
            let (p, v) = (s.eval(t), s.deriv(t));
            let jet = map.jet(p);
            let here = linear(before, v).hypot();
            let there = linear(after, jet.push(v)).hypot();
            if here <= 0.0 {
                // A subpath of zero length shows its caps, which extend in all directions.
                let column = |e| linear(after, jet.push(linear(read, e)));
                let (x, y) = (column(Vec2::new(1.0, 0.0)), column(Vec2::new(0.0, 1.0)));
                let long = stretch(Affine::new([x.x, x.y, y.x, y.y, 0.0, 0.0]));
                if is_point(s, s.start()) && stroke.linecap() != LineCap::Butt && long > 0.0 {
                    dots.extend([long, x.cross(y).abs() / long]);
                }
                continue;
            }
            let det = jet.det().abs() * frames;
            if !(det.is_finite() && there > 0.0) {
                return None;
            }
            across.push(det * here / there);
            along.push(there / here);
            area += det.sqrt() * here;
            length += here;
        }
    }
    let scale = match dots.as_slice() {
        _ if length > 0.0 => area / length,
        [long, short, ..] => (long * short).sqrt(),
        _ => return Some(StrokeWidth { scale: 1.0, error: 0.0 }),
    };
    along.extend(&dots);
    let worst = |all: &[f64]| all.iter().fold(0.0_f64, |m, r| m.max((r / scale - 1.0).abs()));
    let mut error = worst(&across);
    // Caps, joins and dashes extend along the path, too.
    if segments > 1 || !dots.is_empty() || stroke.linecap() != LineCap::Butt || stroke.dasharray().is_some() {
        error = error.max(worst(&along));
    }
    Some(StrokeWidth { scale, error })
}

impl StrokeWidth {
    /// Combines several widths to their mean, with its largest error.
    fn common(all: &[Self]) -> Option<Self> {
        let scale = all.iter().map(|w| w.scale).sum::<f64>() / all.len() as f64;
        let error = |w: &Self| (1.0 + w.error) * (w.scale / scale).max(scale / w.scale) - 1.0;
        let error = all.iter().map(error).fold(0.0, f64::max);
        (scale > 0.0).then_some(Self { scale, error })
    }
}
