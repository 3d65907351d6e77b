//! Keeps the size of lengths in percent of the page when the page changes: they become numbers. Inkscape's pages and guide lines move.

use super::keeper::Keeper;
use crate::scene::geometry::Dimension::{self, Diagonal, Height, Width};
use crate::source::elements::{ElementId, declared};
use crate::source::number::{rectangle, short};
use crate::source::text::SourceText;
use pathwarp::kurbo::{Rect, Size, Vec2};

/// Attributes that may be percentages of the viewport, alone or in lists.
#[rustfmt::skip]
const LENGTHS: &[(&str, Dimension)] = &[
    ("x", Width), ("y", Height), ("width", Width), ("height", Height), ("x1", Width), ("y1", Height), ("x2", Width), ("y2", Height),
    ("cx", Width), ("cy", Height), ("rx", Width), ("ry", Height), ("r", Diagonal), ("fx", Width), ("fy", Height), ("fr", Diagonal),
    ("dx", Width), ("dy", Height), ("markerWidth", Width), ("markerHeight", Height),
];

/// Properties that may be percentages of the viewport's diagonal.
const PROPERTIES: [&str; 3] = ["stroke-width", "stroke-dasharray", "stroke-dashoffset"];

/// Default percentages of gradients in user space.
const OF_GRADIENTS: [(&str, &[(&str, &str)]); 2] =
    [("linearGradient", &[("x2", "100%")]), ("radialGradient", &[("cx", "50%"), ("cy", "50%"), ("r", "50%")])];

/// Replaces percentages of the root's viewport by numbers if its size changes. Must come before other edits, which start from lengths that
/// usvg has resolved.
pub(super) fn fix_percentages(k: &mut Keeper<'_, '_>, after: Size) {
    let before = k.input.drawing.reader().root_size();
    if after == before {
        return;
    }
    for e in 1..k.source.elements.len() {
        if has_percentages(k.source, e) && refers_to_root(k.source, e) && is_in_user_space(k.source, e) {
            fix_lengths(k, e, before);
        }
    }
    if k.source.text.contains('%') {
        for name in PROPERTIES {
            fix_property(k, name, Diagonal.in_view(before));
        }
    }
}

/// Returns `true` if an element of SVG may have percentages, written or not.
fn has_percentages(source: &SourceText, e: ElementId) -> bool {
    let el = &source.elements[e];
    match el.tag.as_ref() {
        "" => false,
        "svg" | "use" | "linearGradient" | "radialGradient" => true,
        _ => source.text[el.range.start..el.open_end].contains('%'),
    }
}

/// Returns `true` if percentages of an element refer to the root.
fn refers_to_root(source: &SourceText, e: ElementId) -> bool {
    let establishes = |a: &ElementId| match source.elements[*a].tag.as_ref() {
        "svg" | "symbol" | "marker" => true,
        "pattern" => source.attr(*a, "viewBox").is_some(),
        _ => false,
    };
    source.ancestors(e).skip(1).find(establishes) == Some(0)
}

/// Returns `true` unless the lengths of an element are fractions of a box.
fn is_in_user_space(source: &SourceText, e: ElementId) -> bool {
    let name = match source.elements[e].tag.as_ref() {
        "linearGradient" | "radialGradient" => "gradientUnits",
        "pattern" => "patternUnits",
        "mask" => "maskUnits",
        "filter" => "filterUnits",
        primitive if primitive.starts_with("fe") => {
            return source.elements[e].parent.and_then(|f| source.in_user_space(f, "primitiveUnits")).unwrap_or(true);
        }
        _ => return true,
    };
    source.in_user_space(e, name).unwrap_or(false)
}

/// The text with its percentages of `full` replaced by numbers. Returns `None` if it has none.
fn numbers(text: &str, full: f64) -> Option<String> {
    let number = |part: &str| Some(short((part.strip_suffix('%')?.trim_end().parse::<f64>().ok()? / 100.0) * full));
    let parts = || text.split([' ', ',', '\t', '\n', '\r']).filter(|p| !p.is_empty());
    parts().any(|p| number(p).is_some()).then(|| {
        let all = parts().map(|p| number(p).unwrap_or_else(|| p.to_owned()));
        all.collect::<Vec<_>>().join(" ")
    })
}

/// Replaces percentages of a property in attributes and styles, and overrides those of style sheets.
fn fix_property(k: &mut Keeper<'_, '_>, name: &'static str, diagonal: f64) {
    if !k.source.text.contains(name) {
        return;
    }
    for e in 0..k.source.elements.len() {
        let Some(new) = k.source.property(e, name).and_then(|v| numbers(&v, diagonal)) else { continue };
        // The root's declarations are inherited, so they count, too.
        if k.tag(e).is_empty() || (e > 0 && !refers_to_root(k.source, e)) {
            continue;
        }
        let style = k.source.attr(e, "style");
        if k.source.css_declares(name) || style.is_some_and(|s| declared(&s, name).is_some()) {
            k.edits.set_style(e, name, new);
        } else {
            k.edits.set_attr(e, name, new);
        }
    }
}

/// Writes numbers for lengths that are percentages, or that are not given and whose default is one.
fn fix_lengths(k: &mut Keeper<'_, '_>, e: ElementId, view: Size) {
    let target = || k.source.target(e);
    let defaults: &[(&str, &str)] = match k.tag(e) {
        "svg" => &[("width", "100%"), ("height", "100%")],
        "use" if target().is_some_and(|t| k.tag(t) == "symbol") => &[("width", "100%"), ("height", "100%")],
        // Another gradient that it refers to may give them.
        gradient if target().is_none() => OF_GRADIENTS.iter().find(|g| g.0 == gradient).map_or(&[], |g| g.1),
        _ => &[],
    };
    for &(name, dimension) in LENGTHS {
        let default = defaults.iter().find(|d| d.0 == name).map(|d| d.1.into());
        let value = k.source.attr(e, name).or(default);
        if let Some(new) = value.and_then(|v| numbers(&v, dimension.in_view(view))) {
            k.edits.set_attr(e, name, new);
        }
    }
}

/// Largest relative difference of equal sides, as Inkscape writes eight digits.
const SAME: f64 = 1e-6;

/// Moves pages and guide lines with the page.
pub(super) fn move_pages_and_guides(k: &mut Keeper<'_, '_>, (before, after): (Rect, Rect)) {
    let source = k.source;
    // The names with the prefixes that Inkscape writes.
    let name = |e: ElementId| &source.text[source.elements[e].qname.clone()];
    let is_in_view = |e: &ElementId| source.elements[*e].parent.is_some_and(|p| name(p) == "sodipodi:namedview");
    for e in (0..source.elements.len()).filter(is_in_view) {
        match name(e) {
            "inkscape:page" => move_page(k, e, before, after),
            "sodipodi:guide" => move_guide_line(k, e, before, after),
            _ => {}
        }
    }
}

/// Moves a page of Inkscape's, or resizes it if it is as large as the visible area.
fn move_page(k: &mut Keeper<'_, '_>, e: ElementId, before: Rect, after: Rect) {
    let number = |name: &str| k.source.attr(e, name)?.trim().parse::<f64>().ok();
    let [Some(x), Some(y), Some(w), Some(h)] = ["x", "y", "width", "height"].map(number) else { return };
    let old = Rect::new(x, y, x + w, y + h);
    let whole = Rect::from_origin_size((0.0, 0.0), before.size());
    let slack = SAME * (before.width() + before.height());
    let differences = [old.x0 - whole.x0, old.y0 - whole.y0, old.x1 - whole.x1, old.y1 - whole.y1];
    let new = if differences.iter().all(|d| d.abs() <= slack) {
        Rect::from_origin_size((0.0, 0.0), after.size())
    } else {
        old + Vec2::new(before.x0 - after.x0, before.y0 - after.y0)
    };
    for (name, value) in rectangle(new) {
        k.edits.set_attr(e, name, value);
    }
}

/// Moves a guide line, whose coordinates count from the lower left corner, upwards.
fn move_guide_line(k: &mut Keeper<'_, '_>, e: ElementId, before: Rect, after: Rect) {
    let position = k.source.attr(e, "position").unwrap_or_default().into_owned();
    let Some((x, y)) = position.split_once(',') else { return };
    if let (Ok(x), Ok(y)) = (x.trim().parse::<f64>(), y.trim().parse::<f64>()) {
        let moved = [x + before.x0 - after.x0, y + after.y1 - before.y1].map(short).join(",");
        k.edits.set_attr(e, "position", moved);
    }
}
