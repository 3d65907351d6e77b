//! Shape elements: they become paths, or groups if fill and stroke need separate paths.

use super::keeper::Keeper;
use crate::bend::outcome::WarpedPart;
use crate::scene::model::{Node, Part};
use crate::source::number::short;
use crate::source::tags::ElementId;
use crate::write::values::{dashes, part_data};
use usvg::{Fill, Stroke};

const MARKERS: [&str; 3] = ["marker-start", "marker-mid", "marker-end"];

/// Patches a shape element with the image of part `i`.
pub(super) fn shape(k: &mut Keeper<'_, '_>, e: ElementId, i: usize) {
    let p = k.input.part(i);
    let Some(warped) = k.input.warped(i) else { return };
    let outlined = p.stroke.is_some() && warped.stroke.outline().is_some();
    let separate_fill = warped.fill.as_ref().is_some_and(|f| !f.elements().is_empty());
    if k.input.in_pieces(i) || outlined || separate_fill {
        let content = k.writer.part(i);
        k.make_group(e, content);
        return;
    }
    let tag = k.tag(e);
    if tag != "path" {
        k.edits.rename(e, "path");
        k.remove_geometry(e);
        // Only what was a line or a polygon before has markers.
        if matches!(tag, "rect" | "circle" | "ellipse")
            && k.source.attr(e, "style").is_some_and(|s| s.contains("marker-"))
        {
            for name in MARKERS {
                k.edits.set_property(e, name, "none".into());
            }
        }
    }
    k.edits.set_attr(e, "d", part_data(p, Some(warped), k.source));
    k.remove_lettering(e);
    patch_paint(k, e, i, p, warped);
    patch_stroke(k, e, p, warped);
}

fn patch_paint(k: &mut Keeper<'_, '_>, e: ElementId, i: usize, p: &Part, warped: &WarpedPart) {
    let paints = [("fill", p.fill.as_ref().map(Fill::paint)), ("stroke", p.stroke.as_ref().map(Stroke::paint))];
    for (name, paint) in paints {
        if let Some(paint) = paint.filter(|paint| k.input.paint_fit(paint, p, Some(warped)).is_some()) {
            let paint = k.writer.paint(paint, p, Some(warped));
            k.edits.set_property(e, name, paint);
        }
    }
    // A shape without width or height shows the fallback colour of a paint server in box units. The warped shape may have
    // both, and must not show the paint server.
    let flat = p.local.bounding_box().is_some_and(|b| b.width() == 0.0 || b.height() == 0.0);
    if flat && (k.source.text.contains("objectBoundingBox") || k.source.text.contains("Gradient")) {
        for (name, value) in k.writer.properties(i) {
            if matches!(name, "fill" | "stroke") {
                k.edits.set_property(e, name, value);
            }
        }
    }
    if warped.fill.is_some() {
        k.edits.set_property(e, "fill", "none".into());
    }
}

fn patch_stroke(k: &mut Keeper<'_, '_>, e: ElementId, p: &Part, warped: &WarpedPart) {
    let scale = warped.stroke.scale();
    let Some(s) = p.stroke.as_ref().filter(|_| (scale - 1.0).abs() > 1e-9) else { return };
    k.edits.set_property(e, "stroke-width", short(f64::from(s.width().get()) * scale));
    // In units of `pathLength`, dashes are the same on the new path.
    if s.dasharray().is_some() && k.source.attr(e, "pathLength").is_none() {
        k.edits.set_property(e, "stroke-dasharray", dashes(s, scale));
        if s.dashoffset() != 0.0 {
            k.edits.set_property(e, "stroke-dashoffset", short(f64::from(s.dashoffset()) * scale));
        }
    }
}

/// Replaces a shape with markers by a group of the shape and its markers (`nodes`, in painting order).
pub(super) fn marked_shape(k: &mut Keeper<'_, '_>, e: ElementId, nodes: &[&Node]) {
    if !nodes.iter().any(|n| k.changed(n)) {
        return;
    }
    let content = nodes.iter().map(|n| k.writer.node(n)).collect();
    k.make_group(e, content);
    for name in MARKERS {
        k.edits.set_style(e, name, "none".into());
    }
}
