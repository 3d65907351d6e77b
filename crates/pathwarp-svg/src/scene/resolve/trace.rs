//! Traces usvg's paths back to source elements and their exact outlines.

use super::builder::SceneBuilder;
use crate::scene::model::LazyOutline;
use crate::scene::usvg_path::{from_usvg, same_path};
use crate::source::tags::{ElementId, is_shape};
use pathwarp::Outline;
use pathwarp::kurbo::Point;
use std::collections::HashMap;
use std::sync::Arc;
use usvg::tiny_skia_path as ts;

/// Origin of a path.
pub(super) struct Traced {
    /// The shape element with the path's id.
    pub(super) source: Option<ElementId>,
    /// The original of a copy.
    pub(super) copied: Option<ElementId>,
    /// The element that `outline` was read from; `None` if it was converted from usvg's path.
    pub(super) drawn: Option<ElementId>,
    pub(super) outline: LazyOutline,
}

/// Finds the element and the outline of a path.
pub(super) fn trace(b: &mut SceneBuilder<'_>, p: &usvg::Path) -> Traced {
    let candidates = b.elements(p.id());
    let only = b.element(p.id()).filter(|&e| b.tag(e) == "path");
    if let Some((e, outline)) = only.and_then(|e| Some((e, path_outline(b, e)?))) {
        return Traced { source: Some(e), copied: None, drawn: Some(e), outline };
    }
    let shared = candidates.len() > 1;
    for &e in candidates {
        if !is_shape(b.tag(e)) || (shared && b.taken.contains(&e)) {
            continue;
        }
        let exact = b.reader.outline(e).filter(|o| !shared || same_path(o, p.data()));
        if exact.is_some() || !shared {
            if shared {
                b.taken.insert(e);
            }
            let drawn = exact.is_some().then_some(e);
            let outline = exact.unwrap_or_else(|| from_usvg(p.data())).into();
            return Traced { source: Some(e), copied: None, drawn, outline };
        }
    }
    let (copied, outline) = copy_of(b, p.data()).unzip();
    let outline = outline.unwrap_or_else(|| from_usvg(p.data())).into();
    Traced { source: None, copied, drawn: copied, outline }
}

/// The outline of a `path` element; computed on first use.
fn path_outline(b: &SceneBuilder<'_>, e: ElementId) -> Option<LazyOutline> {
    let d = b.reader.source.attr(e, "d")?.into_owned();
    let ahead = Arc::clone(&b.reader.source.ahead);
    Some(LazyOutline::shared(move || {
        let known = ahead.get().and_then(|known| known.get(&e).cloned());
        known.unwrap_or_else(|| Arc::new(Outline::from_svg_lossy(&d)))
    }))
}

/// A path's outline, read from the source if possible.
pub(super) fn known_outline(b: &mut SceneBuilder<'_>, p: &usvg::Path) -> Outline {
    let own = b.element(p.id()).filter(|&e| is_shape(b.tag(e))).and_then(|e| b.reader.outline(e));
    own.or_else(|| copy_of(b, p.data()).map(|c| c.1)).unwrap_or_else(|| from_usvg(p.data()))
}

/// Finds the original of a copied path (in a `use`, in a marker), with its outline.
fn copy_of(b: &mut SceneBuilder<'_>, path: &ts::Path) -> Option<(ElementId, Outline)> {
    /// Maps a point to a grid cell, coarse against f32 rounding; the eight neighbours are searched, too.
    fn cell(p: Point) -> [i64; 2] {
        [p.x, p.y].map(|v| (v * 16.0).floor() as i64)
    }
    /// Limit on comparisons, so that a million equal copies take no quadratic time.
    const TRIES: usize = 64;
    if b.starts.is_none() {
        let mut starts: HashMap<_, Vec<_>> = HashMap::new();
        for (e, el) in b.reader.source.elements.iter().enumerate() {
            if is_shape(&el.tag)
                && let Some(o) = b.reader.outline(e)
                && let Some(first) = o.subpaths.iter().find(|s| !s.segs.is_empty() || s.closed)
            {
                starts.entry(cell(first.start)).or_default().push(e);
                b.outlines.insert(e, o);
            }
        }
        b.starts = Some(starts);
    }
    let start = path.points().first()?;
    let [x, y] = cell(Point::new(f64::from(start.x), f64::from(start.y)));
    let starts = b.starts.as_ref()?;
    let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [x.saturating_add(i), y.saturating_add(j)]));
    around
        .filter_map(|c| starts.get(&c))
        .flatten()
        .take(TRIES)
        .filter_map(|e| Some((*e, b.outlines.get(e)?)))
        .find(|(_, o)| same_path(o, path))
        .map(|(e, o)| (e, o.clone()))
}
