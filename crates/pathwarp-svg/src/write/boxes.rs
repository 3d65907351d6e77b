//! Measures the boxes of parts as written, and the regions of filters and masks.

use super::input::WriteInput;
use super::markup::{part_box, stroke_scale};
use crate::bend::bends::Bend;
use crate::bend::outcome::{StrokeOutcome, WarpedPart};
use crate::scene::areas::{is_seen, overlap, stroke_outline};
use crate::scene::geometry::rect;
use crate::scene::model::{Group, Part, PartRole};
use crate::source::number::{path_data, rectangle};
use pathwarp::kurbo::{Affine, BezPath, Insets, Point, Rect, Shape as _};
use pathwarp::{Outline, Seg, refit};
use std::borrow::Cow;
use usvg::FillRule;
use usvg::filter::Filter;

/// Tolerance of outlines that are measured, as a fraction of their size.
const OUTLINE_TOLERANCE: f64 = 1e-4;

/// An approximation of the path written for a part.
pub(super) fn path<'a>(p: &Part, warped: Option<&'a WarpedPart>) -> Cow<'a, BezPath> {
    if let Some(d) = warped {
        return Cow::Borrowed(&d.path);
    }
    let size = p.local.bounding_box().map_or(1.0, |b| b.width().max(b.height()));
    Cow::Owned(p.local.to_bez_path((size * OUTLINE_TOLERANCE).max(1e-12)))
}

/// Bounding box of a path's segments; empty if it has none.
fn segments_box(path: &BezPath) -> Rect {
    let segs = || path.segments().map(Seg::from);
    let ends = segs().map(|s| Rect::from_points(s.start(), s.end())).reduce(|a, b| a.union(b));
    ends.map_or(Rect::ZERO, |ends| segs().fold(ends, |all, s| s.extend(all)))
}

/// Bounding box of a path's image under `frame`.
pub(super) fn box_under(frame: Affine, path: &BezPath) -> Rect {
    if frame == Affine::IDENTITY { segments_box(path) } else { segments_box(&(frame * path)) }
}

/// A quickly computed box that contains all that a part paints.
pub(super) fn quick_box(p: &Part, warped: Option<&WarpedPart>, frame: Affine) -> Rect {
    let path = match warped {
        Some(d) => d.path.control_box(),
        None => p.local.bounding_box().unwrap_or(Rect::ZERO),
    };
    let all = match (&p.stroke, warped.map(|d| &d.stroke)) {
        (None, _) => path,
        (Some(_), Some(StrokeOutcome::Outlined(o))) => path.union(o.control_box()),
        (Some(s), _) => {
            // Miters or square caps extend farthest; this is their extent in half widths.
            let ratio = f64::from(s.miterlimit().get()).max(std::f64::consts::SQRT_2);
            let extent = 0.5 * f64::from(s.width().get()) * stroke_scale(warped) * ratio;
            path.inflate(extent, extent)
        }
    };
    frame.transform_rect_bbox(all)
}

/// Bounding box of everything a part paints.
pub(super) fn painted_box(p: &Part, warped: Option<&WarpedPart>, frame: Affine) -> Rect {
    let path = path(p, warped);
    let path_box = box_under(frame, &path);
    match (&p.stroke, warped.map(|d| &d.stroke)) {
        (None, _) => path_box,
        (Some(_), Some(StrokeOutcome::Outlined(o))) => path_box.union(box_under(frame, o)),
        (Some(s), _) => {
            // Scaling the path down and its outline up is the same as scaling the stroke's width.
            let scale = stroke_scale(warped);
            let size = path.bounding_box();
            let size = size.width().max(size.height()) / scale;
            let shrunk = Outline::from(&*path).transformed(Affine::scale(1.0 / scale));
            let outline = stroke_outline(&shrunk, s, (OUTLINE_TOLERANCE * size).max(1e-9));
            let outline = outline.transformed(frame * Affine::scale(scale));
            outline.bounding_box().map_or(path_box, |b| path_box.union(b))
        }
    }
}

/// Returns `true` if a part paints anything in an area, up to the boxes of its segments and the reach of its stroke.
pub(super) fn paints_in(p: &Part, warped: Option<&WarpedPart>, frame: Affine, area: Rect) -> bool {
    if overlap(quick_box(p, warped, frame), area).is_none() || overlap(painted_box(p, warped, frame), area).is_none() {
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

/// Least growth of a side that counts, as a fraction of the content's size. Rounding causes less.
const LEAST_GROWTH: f64 = 1e-4;

/// The growth of the regions of a group's filters: on each side, the distance by which the bent content extends past the source's. Both
/// are measured in the filters' user space, which follows the affine fit of the map.
pub(super) fn growth(input: &WriteInput<'_>, g: &Group) -> Insets {
    let slot = g.slot.filter(|_| !g.filters.is_empty()).map(|i| &input.scene.slots[i]);
    let Some(slot) = slot.filter(|s| !s.fits_outside && input.changes(s.parts.clone())) else { return Insets::ZERO };
    let (from_root, from_new_root) = (slot.frame.inverse(), input.written(g.slot, slot.frame).inverse());
    let painted = slot.parts.clone().filter(|&i| {
        let p = input.part(i);
        p.role == PartRole::Paint && is_seen(p) && input.warped(i).is_none_or(WarpedPart::draws)
    });
    let boxes = painted.map(|i| {
        let p = input.part(i);
        let before = painted_box(p, None, from_root * p.frame);
        (before, painted_box(p, input.warped(i), from_new_root * input.written(p.slot, p.frame)))
    });
    let all = boxes.reduce(|(a, b), (c, d)| (a.union(c), b.union(d)));
    let Some((before, after)) = all.filter(|(a, b)| a.is_finite() && b.is_finite()) else { return Insets::ZERO };
    let least = LEAST_GROWTH * before.width().max(before.height());
    let side = |outwards: f64| if outwards > least { outwards } else { 0.0 };
    let (left, top) = (side(before.x0 - after.x0), side(before.y0 - after.y0));
    Insets::new(left, top, side(after.x1 - before.x1), side(after.y1 - before.y1))
}

/// The region of a filter in user space, grown.
pub(super) fn grown(f: &Filter, growth: Insets) -> Rect {
    rect(f.rect().to_rect()) + growth
}

/// Decimals of the warped border of a mask's region.
const DECIMALS: u8 = 9;

/// Intervals on each side of a region, at whose ends the map is evaluated.
const SAMPLES: usize = 16;

/// Attributes for the region of a mask, which covers all of its content after the warp.
pub(super) fn region(input: &WriteInput<'_>, mask: usize) -> Vec<(&'static str, String)> {
    let m = &input.scene.masks[mask];
    let mut area = m.rect;
    if input.changes(m.parts.clone()) {
        let from_root = input.written(m.slot, m.frame).inverse();
        for i in m.parts.clone() {
            let p = input.part(i);
            let to_frame = from_root * input.written(p.slot, p.frame);
            let warped = input.warped(i);
            let covered = match (&p.stroke, warped.and_then(|w| w.stroke.outline())) {
                (_, Some(outline)) => outline.bounding_box().abs(),
                (Some(s), None) => {
                    let width = f64::from(s.width().get()) * stroke_scale(warped);
                    let extent = width * f64::from(s.miterlimit().get());
                    part_box(p, warped).inflate(extent, extent)
                }
                (None, None) => part_box(p, warped),
            };
            area = area.union(to_frame.transform_rect_bbox(covered));
        }
        // A filter in the mask may fill the region.
        if let Some(Bend { map, .. }) = input.bend(m.parts.clone()) {
            let border_point = |side: usize, i: usize| {
                let t = i as f64 / SAMPLES as f64;
                let [x, y] = [[t, 0.0], [1.0, t], [t, 1.0], [0.0, t]][side];
                Point::new(m.rect.x0 + x * m.rect.width(), m.rect.y0 + y * m.rect.height())
            };
            let border = (0..4).flat_map(|side| (0..=SAMPLES).map(move |i| border_point(side, i)));
            let image = border.map(|p| from_root * map.point(m.frame * p));
            area = image.filter(|p| p.is_finite()).fold(area, |area, p| area.union_pt(p));
        }
        // A region larger than necessary only costs rendering time.
        let margin = 0.01 * area.width().max(area.height());
        area = area.inflate(margin, margin);
    }
    [("maskUnits", "userSpaceOnUse".into())].into_iter().chain(rectangle(area)).collect()
}

/// Path data for the warped border of a mask's region, if the border clips the content.
pub(super) fn edge(input: &WriteInput<'_>, mask: usize) -> Option<String> {
    let m = &input.scene.masks[mask];
    if m.rect.contains_rect(m.content) || !input.changes(m.parts.clone()) {
        return None;
    }
    let Bend { map, options } = input.bend(m.parts.clone())?;
    let r = m.rect;
    let corners = [(r.x0, r.y0), (r.x1, r.y0), (r.x1, r.y1), (r.x0, r.y1)].map(Point::from);
    let border = Outline::from_points(&corners, true).transformed(m.frame).repeated(&options.copies);
    let warped = refit::warp_path(&border, *map, &options.refit).ok()?;
    let mut path = warped.path;
    path.apply_affine(input.written(m.slot, m.frame).inverse());
    Some(path_data(&path, DECIMALS))
}
