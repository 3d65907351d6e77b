//! Clip paths: as PDF's own where one outline says it all, else as masks.

use crate::file::{File, MaskKind, State};
use crate::outline::from_usvg;
use crate::space::affine;
use crate::stream::Stream;
use kurbo::{Affine, BezPath, Rect, Shape as _};
use pdf_writer::Ref;
use usvg::{ClipPath, Fill, FillRule, Group, Node};

/// Restricts what is drawn to a clip path. Returns the group of a mask if outlines cannot do it.
pub(crate) fn apply(file: &mut File<'_>, stream: &mut Stream, clip: &ClipPath, bounds: Rect) -> Option<Ref> {
    if let Some(outlines) = outlines(file, clip) {
        for (path, rule) in &outlines {
            stream.clip(path, *rule);
        }
        return None;
    }
    Some(file.group(bounds, stream.shift, |file, stream| {
        if let Some(next) = clip.clip_path()
            && let Some(mask) = apply(file, stream, next, bounds)
        {
            let state = file.state(State::default().mask(MaskKind::Luminosity, mask));
            stream.state(state);
        }
        stream.content.set_fill_gray(1.0);
        stream.transform(affine(clip.transform()));
        silhouette(file, stream, clip.root(), bounds);
    }))
}

/// The outlines whose common part is the clip path; `None` if there are no such outlines.
fn outlines(file: &File<'_>, clip: &ClipPath) -> Option<Vec<(BezPath, FillRule)>> {
    let mut own = Vec::new();
    collect(file, clip.root(), affine(clip.transform()), &mut own)?;
    let rule = own.first().map_or(FillRule::NonZero, |(_, rule)| *rule);
    let boxes: Vec<Rect> = own.iter().map(|(path, _)| path.bounding_box()).collect();
    // Outlines that overlap would add up their winding numbers.
    if own.iter().any(|(_, r)| *r != rule) || !are_apart(&boxes) {
        return None;
    }
    let mut path = BezPath::new();
    own.iter().for_each(|(p, _)| path.extend(p.iter()));
    if path.elements().is_empty() {
        // An empty clip path hides everything, an empty outline is no clip path.
        path = Rect::ZERO.to_path(1.0);
    }
    let mut out = clip.clip_path().map_or(Some(Vec::new()), |next| outlines(file, next))?;
    out.push((path, rule));
    Some(out)
}

/// Returns `true` if no two of the boxes overlap. Of many boxes it says `false`: looking at all pairs would take long.
fn are_apart(boxes: &[Rect]) -> bool {
    const MOST: usize = 256;
    let overlap = |a: &Rect, b: &Rect| a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
    boxes.len() <= MOST && boxes.iter().enumerate().all(|(i, a)| !boxes[i + 1..].iter().any(|b| overlap(a, b)))
}

/// Collects the outlines of a clip path's content; `None` if a part of it is clipped in turn.
fn collect(file: &File<'_>, g: &Group, to_user: Affine, out: &mut Vec<(BezPath, FillRule)>) -> Option<()> {
    for child in g.children() {
        match child {
            Node::Group(g) if g.clip_path().is_some() => return None,
            Node::Group(g) => collect(file, g, to_user * affine(g.transform()), out)?,
            Node::Text(t) => collect(file, t.flattened(), to_user * affine(t.flattened().transform()), out)?,
            Node::Path(p) => {
                if let Some(fill) = p.fill().filter(|_| p.is_visible()) {
                    out.push((to_user * outline(file, p), Fill::rule(fill)));
                }
            }
            Node::Image(_) => {}
        }
    }
    Some(())
}

fn outline(file: &File<'_>, p: &usvg::Path) -> BezPath {
    (file.options.exact)(p).unwrap_or_else(|| from_usvg(p.data()))
}

/// Fills the content of a clip path with the current colour.
fn silhouette(file: &mut File<'_>, stream: &mut Stream, g: &Group, bounds: Rect) {
    for child in g.children() {
        let group = match child {
            Node::Group(g) => &**g,
            Node::Text(t) => t.flattened(),
            Node::Path(p) => {
                if let Some(fill) = p.fill().filter(|_| p.is_visible()) {
                    stream.outline(&outline(file, p));
                    match fill.rule() {
                        FillRule::NonZero => stream.content.fill_nonzero(),
                        FillRule::EvenOdd => stream.content.fill_even_odd(),
                    };
                }
                continue;
            }
            Node::Image(_) => continue,
        };
        stream.save();
        stream.transform(affine(group.transform()));
        let inner = affine(group.transform()).inverse();
        let inner = if inner.is_finite() { inner.transform_rect_bbox(bounds) } else { bounds };
        if let Some(clip) = group.clip_path()
            && let Some(mask) = apply(file, stream, clip, inner)
        {
            let state = file.state(State::default().mask(MaskKind::Luminosity, mask));
            stream.state(state);
        }
        silhouette(file, stream, group, inner);
        stream.restore();
    }
}
