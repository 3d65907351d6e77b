//! Texts: they become groups of outlines, with a group inside for every named element.

use super::keeper::{self, Keeper};
use crate::scene::geometry::is_invertible;
use crate::scene::lettering::{is_named, is_naming, text_content};
use crate::scene::model::Group;
use crate::source::elements::{ElementId, Namespace, is_live};
use crate::source::text::SourceText;
use pathwarp::engine::decimal::matrix;
use pathwarp::map::Class;
use std::ops::Range;

/// A named element of a text, with its content in painting order.
struct TextSpan {
    element: ElementId,
    content: Vec<SpanItem>,
}

/// A part of a span's content.
#[derive(Clone, Copy)]
enum SpanItem {
    /// Index of an outline.
    Outline(usize),
    /// Index of a span.
    Span(usize),
}

/// The spans of a text. The first is the text itself.
struct SpanTree(Vec<TextSpan>);

impl SpanTree {
    /// The index of the innermost span of a chain of elements, `path`, outermost first. Adds a span that is missing or, with `reopen`, is
    /// no longer the last of its parent; its element then gets a second group.
    fn find_or_add(&mut self, path: &[ElementId], reopen: bool) -> usize {
        let mut span = 0;
        for &e in path {
            let content = &self.0[span].content;
            let span_of = |item: &SpanItem| match *item {
                SpanItem::Span(s) if self.0[s].element == e => Some(s),
                _ => None,
            };
            let found = match content.last() {
                Some(last) if reopen => span_of(last),
                _ => content.iter().rev().find_map(span_of),
            };
            span = found.unwrap_or_else(|| {
                let new = self.0.len();
                self.0.push(TextSpan { element: e, content: Vec::new() });
                self.0[span].content.push(SpanItem::Span(new));
                new
            });
        }
        span
    }
}

/// Replaces a text by a group of outlines, if it has changed. `owners` are the outlines' source elements, if it needs groups inside.
pub(super) fn patch_text(k: &mut Keeper<'_, '_>, e: ElementId, content: &Group, owners: &[ElementId]) {
    if !content.children.iter().any(|n| k.changed(n)) {
        return;
    }
    let source = k.source;
    let words = words(source, e);
    let inner = if owners.len() == content.children.len() {
        let spans = span_tree(source, e, owners);
        let written = SpanWriter { k, spans: &spans, content, owners, written: Vec::new() }.items(0);
        k.writer.group_around(content, &written)
    } else {
        // The outlines keep the text's declarations of paint, such as `currentColor`.
        k.written_inside(e, |w| {
            w.surroundings = w.surroundings.map(|s| s.for_text(source, Some(e)));
            w.group(content, "")
        })
    };
    let inner = k.between_pictures(e, inner);
    let title = source.elements[e].title.as_ref().unwrap_or(&words);
    let title = if title.is_empty() { String::new() } else { k.writer.markup.title(title) };
    k.edits.rename(e, "g");
    k.remove_attributes(e, &["x", "y", "dx", "dy", "rotate", "textLength", "lengthAdjust"]);
    if !words.is_empty() && source.attr(e, "aria-label").is_none() {
        k.edits.set_attr(e, "aria-label", words);
    }
    k.new_groups.insert(e);
    let animations = keeper::kept_animations(source, e);
    k.edits.set_content(e, format!("{title}{inner}{animations}"));
    move_html(k, e);
}

/// Moves the HTML that a text stands for under an affine map; under other maps, the text replaces it.
fn move_html(k: &mut Keeper<'_, '_>, text: ElementId) {
    let Ok(found) = k.source.foreign.binary_search_by_key(&text, |f| f.1) else { return };
    let html = k.source.foreign[found].0;
    let reader = k.input.drawing.reader();
    let frame = k.source.elements[html].parent.and_then(|p| reader.transform_to_root(p)).filter(|f| is_invertible(*f));
    let map = k.input.bends.bend_of(Some(text)).map(|i| k.input.bends.each[i].map.class());
    match (frame, map) {
        (Some(frame), Some(Class::Affine(map))) => {
            let transform = frame.inverse() * map * frame * k.input.drawing.own_transform(html);
            k.edits.set_attr(html, "transform", matrix(transform));
        }
        _ => k.edits.replace(html, String::new()),
    }
}

/// Sorts the outlines of a text into spans.
fn span_tree(source: &SourceText, text: ElementId, owners: &[ElementId]) -> SpanTree {
    let mut spans = SpanTree(vec![TextSpan { element: text, content: Vec::new() }]);
    let path = |element: ElementId| {
        let ancestors = source.ancestors(element).take_while(|&a| a != text);
        let mut path: Vec<ElementId> = ancestors.filter(|&a| is_named(source, a)).collect();
        path.reverse();
        path
    };
    for (i, &owner) in owners.iter().enumerate() {
        let span = spans.find_or_add(&path(owner), true);
        spans.0[span].content.push(SpanItem::Outline(i));
    }
    // Named elements without outlines get an empty group, so that their names remain.
    for named in text_content(source, text).filter(|&n| is_named(source, n)) {
        spans.find_or_add(&path(named), false);
    }
    spans
}

/// Writes the spans of a text.
struct SpanWriter<'s, 'k, 'a, 'w> {
    k: &'k mut Keeper<'a, 'w>,
    spans: &'s SpanTree,
    content: &'s Group,
    owners: &'s [ElementId],
    /// Elements written so far.
    written: Vec<ElementId>,
}

impl SpanWriter<'_, '_, '_, '_> {
    fn items(&mut self, span: usize) -> String {
        let spans = self.spans;
        let mut out = String::new();
        for item in &spans.0[span].content {
            match *item {
                SpanItem::Outline(i) => {
                    let (node, owner) = (&self.content.children[i], self.owners[i]);
                    out.push_str(&self.k.written_inside(spans.0[0].element, |w| {
                        w.surroundings = w.surroundings.map(|s| s.for_text_element(owner));
                        w.node(node)
                    }));
                }
                SpanItem::Span(s) => out.push_str(&self.span(s)),
            }
        }
        out
    }

    fn span(&mut self, span: usize) -> String {
        let source = self.k.source;
        let element = self.spans.0[span].element;
        let el = &source.elements[element];
        // An element with several spans has its id and title on the first. Attributes that warping makes untrue are left out.
        let is_again = self.written.contains(&element);
        self.written.push(element);
        let text = &source.text;
        let kept =
            el.attrs.iter().filter(|a| is_naming(a, text) && !is_live(a, text) && !(is_again && a.name(text) == "id"));
        let head: String = kept.map(|a| format!(" {}", &text[a.range.clone()])).collect();
        let title = el.title.as_ref().filter(|_| !is_again);
        let title = title.map_or(String::new(), |t| self.k.writer.markup.title(t));
        let inner = self.items(span);
        self.k.writer.markup.element("g").raw(&head).around(&(title + &inner))
    }
}

/// Positions of the elements of a text that start a line: Inkscape's lines, and each `tspan` that goes back to the left and
/// down. Letters placed one by one do not go down.
fn line_starts(source: &SourceText, text: ElementId) -> Vec<usize> {
    let mut last = source.attr(text, "y");
    let mut out = Vec::new();
    for e in text_content(source, text) {
        let is_line = source.attr_in(e, Namespace::Sodipodi, "role").is_some_and(|r| r == "line");
        let (y, dy) = (source.attr(e, "y"), source.attr(e, "dy"));
        let moves_down = dy.is_some_and(|dy| dy.contains(|c: char| matches!(c, '1'..='9')))
            || y.as_ref().is_some_and(|y| last.as_ref().is_some_and(|last| last != y));
        if is_line || (moves_down && source.attr(e, "x").is_some()) {
            out.push(source.elements[e].range.start);
        }
        last = y.or(last);
    }
    out
}

/// The words of a text, without tags and elements that are not drawn.
fn words(source: &SourceText, e: ElementId) -> String {
    let el = &source.elements[e];
    let Some(close) = &el.close else { return String::new() };
    let hidden = source
        .descendants(e)
        .map(|c| &source.elements[c])
        .filter(|c| matches!(c.tag.as_ref(), "title" | "desc" | "metadata" | "style" | "script"));
    // Text to skip, and positions of line breaks.
    let breaks = line_starts(source, e).into_iter().map(|start| start..start);
    let mut gaps: Vec<Range<usize>> = hidden.map(|h| h.range.clone()).chain(breaks).collect();
    gaps.sort_by_key(|g| g.start);
    let mut raw = String::new();
    let mut copied_to = el.open_end;
    for gap in gaps {
        raw.push_str(&source.part_in_file(copied_to..gap.start.max(copied_to)));
        if gap.is_empty() {
            raw.push(' ');
        }
        copied_to = copied_to.max(gap.end);
    }
    raw.push_str(&source.part_in_file(copied_to..close.start.max(copied_to)));
    let mut out = String::new();
    let mut in_tag = false;
    for c in raw.chars() {
        match c {
            '<' => in_tag = true,
            '>' => in_tag = false,
            c if !in_tag => out.push(c),
            _ => {}
        }
    }
    let entities = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&apos;", "'"), ("&amp;", "&")];
    let out = entities.iter().fold(out, |o, (from, to)| o.replace(from, to));
    out.split_whitespace().collect::<Vec<_>>().join(" ")
}
