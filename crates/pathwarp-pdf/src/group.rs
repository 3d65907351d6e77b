//! Draws groups: clip paths, masks, opacity, blend modes, and what is in them.

use crate::file::{File, MaskKind, State};
use crate::space::{affine, rect, roomy};
use crate::stream::Stream;
use crate::{clip, image, path, picture};
use kurbo::{Affine, Rect, Vec2};
use pdf_writer::Ref;
use usvg::{BlendMode, Group, Mask, MaskType, Node};

/// Draws a group.
pub(crate) fn draw(file: &mut File<'_>, stream: &mut Stream, g: &Group) {
    let transform = affine(g.transform());
    let is_plain = !g.should_isolate();
    if is_plain && transform == Affine::IDENTITY {
        children(file, stream, g);
        return;
    }
    stream.save();
    stream.transform(transform);
    if is_plain {
        children(file, stream, g);
    } else if g.filters().is_empty() {
        isolated(file, stream, g);
    } else {
        filtered(file, stream, g);
    }
    stream.restore();
}

fn children(file: &mut File<'_>, stream: &mut Stream, g: &Group) {
    for child in g.children() {
        match child {
            Node::Group(g) => draw(file, stream, g),
            Node::Path(p) => path::draw(file, stream, p),
            Node::Image(i) => image::draw(file, stream, i),
            Node::Text(t) => draw(file, stream, t.flattened()),
        }
    }
}

/// Draws a group that is composed on its own, in its own coordinates.
fn isolated(file: &mut File<'_>, stream: &mut Stream, g: &Group) {
    let bounds = roomy(rect(g.layer_bounding_box().to_rect()));
    let mut masks = Vec::new();
    if let Some(clip) = g.clip_path() {
        masks.extend(clip::apply(file, stream, clip, bounds).map(|m| (MaskKind::Luminosity, m)));
    }
    masks.extend(g.mask().map(|m| mask(file, m, stream.shift)));
    let state = State::default().opacity(g.opacity().get()).blend(g.blend_mode());
    // A clip path alone does not need a group.
    if masks.is_empty() && state.is_plain() && !g.isolate() {
        children(file, stream, g);
        return;
    }
    let mut content = file.group(bounds, stream.shift, |file, stream| children(file, stream, g));
    while masks.len() > 1 {
        let Some((kind, mask)) = masks.pop() else { break };
        content = file.group(bounds, stream.shift, |file, stream| {
            let state = file.state(State::default().mask(kind, mask));
            stream.state(state);
            stream.object(content);
        });
    }
    let state = masks.pop().map_or(state, |(kind, mask)| state.mask(kind, mask));
    compose(file, stream, state, content);
}

/// Draws an object under a graphics state.
fn compose(file: &mut File<'_>, stream: &mut Stream, state: State, object: Ref) {
    if !state.is_plain() {
        let state = file.state(state);
        stream.state(state);
    }
    stream.object(object);
}

/// Adds a mask.
fn mask(file: &mut File<'_>, m: &Mask, shift: Vec2) -> (MaskKind, Ref) {
    let kind = match m.kind() {
        MaskType::Luminance => MaskKind::Luminosity,
        MaskType::Alpha => MaskKind::Alpha,
    };
    let area: Rect = rect(m.rect().to_rect());
    let group = file.group(area, shift, |file, stream| {
        let outer = m.mask().map(|m| mask(file, m, shift));
        let content = file.group(area, shift, |file, stream| draw(file, stream, m.root()));
        let state = outer.map_or(State::default(), |(kind, group)| State::default().mask(kind, group));
        compose(file, stream, state, content);
    });
    (kind, group)
}

/// Draws a group with a filter as a picture.
fn filtered(file: &mut File<'_>, stream: &mut Stream, g: &Group) {
    if file.failed.is_some() {
        return;
    }
    let drawn = picture::of_group(file, g).and_then(|drawn| {
        let Some(picture) = drawn else { return Ok(None) };
        let object = image::add(file, &picture.pixmap, true)?;
        Ok(Some((object, picture.area)))
    });
    let (object, area) = match drawn {
        Ok(Some(drawn)) => drawn,
        Ok(None) => return,
        Err(e) => {
            file.failed = Some(e);
            return;
        }
    };
    file.pictures += 1;
    if g.blend_mode() != BlendMode::Normal {
        let state = file.state(State::default().blend(g.blend_mode()));
        stream.state(state);
    }
    image::place(stream, object, area);
}
