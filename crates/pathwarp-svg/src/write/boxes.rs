//! Bounding boxes of parts as they are written.

use super::values::stroke_scale;
use crate::bend::outcome::{StrokeOutcome, WarpedPart};
use crate::scene::model::Part;
use crate::scene::seen::overlap;
use crate::scene::stroked::stroke_outline;
use pathwarp::kurbo::{Affine, BezPath, Rect, Shape as _};
use pathwarp::{Outline, Seg};
use std::borrow::Cow;
use usvg::FillRule;

/// Relative tolerance of outlines that are measured.
const FINE: f64 = 1e-4;

/// Approximates the path that is written for a part.
pub(super) fn path<'a>(p: &Part, warped: Option<&'a WarpedPart>) -> Cow<'a, BezPath> {
    if let Some(d) = warped {
        return Cow::Borrowed(&d.path);
    }
    let size = p.local.bounding_box().map_or(1.0, |b| b.width().max(b.height()));
    Cow::Owned(p.local.to_bez_path((size * FINE).max(1e-12)))
}

/// Bounding box of a path; empty if it draws nothing.
fn extent(path: &BezPath) -> Rect {
    let segs = || path.segments().map(Seg::from);
    let ends = segs().map(|s| Rect::from_points(s.start(), s.end())).reduce(|a, b| a.union(b));
    ends.map_or(Rect::ZERO, |ends| segs().fold(ends, |all, s| s.extend(all)))
}

/// Bounding box of a path's image under `frame`.
pub(super) fn box_under(frame: Affine, path: &BezPath) -> Rect {
    if frame == Affine::IDENTITY { extent(path) } else { extent(&(frame * path)) }
}

/// A cheap bounding box of everything a part paints; it may be too large.
pub(super) fn bound(p: &Part, warped: Option<&WarpedPart>, frame: Affine) -> Rect {
    let path = match warped {
        Some(d) => d.path.control_box(),
        None => p.local.bounding_box().unwrap_or(Rect::ZERO),
    };
    let all = match (&p.stroke, warped.map(|d| &d.stroke)) {
        (None, _) => path,
        (Some(_), Some(StrokeOutcome::Outlined(o))) => path.union(o.control_box()),
        (Some(s), _) => {
            // The longest extent is that of miters or of square caps.
            let reach = f64::from(s.miterlimit().get()).max(std::f64::consts::SQRT_2);
            let reach = 0.5 * f64::from(s.width().get()) * stroke_scale(warped) * reach;
            path.inflate(reach, reach)
        }
    };
    frame.transform_rect_bbox(all)
}

/// Bounding box of everything a part paints.
pub(super) fn painted_box(p: &Part, warped: Option<&WarpedPart>, frame: Affine) -> Rect {
    let path = path(p, warped);
    let inside = box_under(frame, &path);
    match (&p.stroke, warped.map(|d| &d.stroke)) {
        (None, _) => inside,
        (Some(_), Some(StrokeOutcome::Outlined(o))) => inside.union(box_under(frame, o)),
        (Some(s), _) => {
            // Expansion is linear in the width: scale the path down instead of the width up.
            let scale = stroke_scale(warped);
            let size = path.bounding_box();
            let size = size.width().max(size.height()) / scale;
            let back = Outline::from(&*path).transformed(Affine::scale(1.0 / scale));
            let outline = stroke_outline(&back, s, (FINE * size).max(1e-9)).transformed(frame * Affine::scale(scale));
            outline.bounding_box().map_or(inside, |b| inside.union(b))
        }
    }
}

/// Returns `true` if a part paints anything in an area, up to the boxes of its segments and the reach of its stroke.
pub(super) fn paints_in(p: &Part, warped: Option<&WarpedPart>, frame: Affine, area: Rect) -> bool {
    if overlap(bound(p, warped, frame), area).is_none() || overlap(painted_box(p, warped, frame), area).is_none() {
        return false;
    }
    let fills = |path: &BezPath, rule: FillRule| {
        let placed = frame * path;
        let winding = placed.winding(area.center());
        let is_inside = if rule == FillRule::EvenOdd { winding % 2 != 0 } else { winding != 0 };
        is_inside || placed.segments().any(|s| overlap(s.bounding_box(), area).is_some())
    };
    match (&p.stroke, warped.map(|d| &d.stroke)) {
        (Some(_), Some(StrokeOutcome::Outlined(o))) if fills(o, FillRule::NonZero) => true,
        (Some(_), None | Some(StrokeOutcome::Scaled(_))) => true,
        _ => p.fill.as_ref().is_some_and(|f| fills(&path(p, warped), f.rule())),
    }
}
