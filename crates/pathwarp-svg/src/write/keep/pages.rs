//! Inkscape's pages and guide lines, which are measured from the corners of the viewBox: they stay where they are when the page
//! changes. The page that was the whole viewBox is the whole viewBox again.

use super::keeper::Keeper;
use crate::source::number::short;
use crate::source::tags::ElementId;
use pathwarp::kurbo::{Rect, Vec2};

/// Sides that differ by less than this share are the same: Inkscape writes eight digits.
const SAME: f64 = 1e-6;

/// Moves pages and guide lines with the page.
pub(super) fn follow(k: &mut Keeper<'_, '_>, (before, after): (Rect, Rect)) {
    let namedview = |e: ElementId| k.source.elements[e].parent.is_some_and(|p| name(k, p) == "sodipodi:namedview");
    let found: Vec<ElementId> = (0..k.source.elements.len()).filter(|&e| namedview(e)).collect();
    for e in found {
        match name(k, e) {
            "inkscape:page" => one_page(k, e, before, after),
            "sodipodi:guide" => guide_line(k, e, before, after),
            _ => {}
        }
    }
}

/// The name of an element as Inkscape writes it.
fn name<'a>(k: &Keeper<'a, '_>, e: ElementId) -> &'a str {
    &k.source.text[k.source.elements[e].qname.clone()]
}

fn number(k: &Keeper<'_, '_>, e: ElementId, name: &str) -> Option<f64> {
    k.source.attr(e, name)?.trim().parse().ok()
}

fn one_page(k: &mut Keeper<'_, '_>, e: ElementId, before: Rect, after: Rect) {
    let values = ["x", "y", "width", "height"].map(|n| number(k, e, n));
    let [Some(x), Some(y), Some(w), Some(h)] = values else { return };
    let old = Rect::new(x, y, x + w, y + h);
    let whole = Rect::from_origin_size((0.0, 0.0), before.size());
    let near = SAME * (before.width() + before.height());
    let is_whole = [old.x0 - whole.x0, old.y0 - whole.y0, old.x1 - whole.x1, old.y1 - whole.y1];
    let new = if is_whole.iter().all(|d| d.abs() <= near) {
        Rect::from_origin_size((0.0, 0.0), after.size())
    } else {
        old + Vec2::new(before.x0 - after.x0, before.y0 - after.y0)
    };
    for (name, value) in [("x", new.x0), ("y", new.y0), ("width", new.width()), ("height", new.height())] {
        k.edits.set_attr(e, name, short(value));
    }
}

/// Guide lines count from the lower left corner, upwards.
fn guide_line(k: &mut Keeper<'_, '_>, e: ElementId, before: Rect, after: Rect) {
    let position = k.source.attr(e, "position").unwrap_or_default().into_owned();
    let Some((x, y)) = position.split_once(',') else { return };
    if let (Ok(x), Ok(y)) = (x.trim().parse::<f64>(), y.trim().parse::<f64>()) {
        let moved = [x + before.x0 - after.x0, y + after.y1 - before.y1].map(short).join(",");
        k.edits.set_attr(e, "position", moved);
    }
}
