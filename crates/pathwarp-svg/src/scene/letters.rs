//! Texts whose letters have become outlines: which element each outline comes from, and the groups that keep its name.
//!
//! usvg lays a text out as a whole and forgets which `tspan` or `textPath` a letter came from. So a drawing with names inside
//! its texts is resolved a second time with every such element painted in a colour of its own; the colours tell.

use crate::scene::model::Group;
use crate::source::number::escape;
use crate::source::read::{self, ReadOptions};
use crate::source::text::{self as source, Attr, ElementId, Namespace, Source};
use crate::write::keep::Keeper;
use pathwarp::Error;
use std::collections::HashMap;
use usvg::{Color, Fill, Node, Paint};

/// By text element: for every node of its outlines, in order, the element that it comes from.
pub(crate) type Owners = HashMap<ElementId, Vec<ElementId>>;

/// Who owns which letters, for the texts that have names inside.
pub(crate) fn owners(source: &Source, name: &str, options: &ReadOptions) -> Result<Owners, Error> {
    let mut out = Owners::new();
    if source.unpatchable.is_some() {
        return Ok(out);
    }
    let texts = (0..source.elements.len()).filter(|&e| source.elements[e].tag == "text");
    let meant: Vec<ElementId> = texts.filter(|&t| inside(source, t).any(|e| is_named(source, e))).collect();
    if meant.is_empty() {
        return Ok(out);
    }
    let painted: Vec<ElementId> = meant.iter().flat_map(|&t| std::iter::once(t).chain(inside(source, t))).collect();
    let styles = painted.iter().filter_map(|&e| Some((e, format!("fill:{};stroke:none", colour(e)?))));
    let painted = source.instrumented_with(styles).0;
    let (tree, _) = read::tree(&source::xml(&painted, name)?, name, options)?;
    collect(tree.root(), source, &mut out);
    Ok(out)
}

/// Red, green and blue spell the element's number.
fn colour(e: ElementId) -> Option<String> {
    (e < 1 << 24).then(|| format!("#{e:06x}"))
}

fn element(c: Color) -> ElementId {
    usize::from(c.red) << 16 | usize::from(c.green) << 8 | usize::from(c.blue)
}

fn collect(g: &usvg::Group, source: &Source, out: &mut Owners) {
    for n in g.children() {
        match n {
            Node::Group(g) => collect(g, source, out),
            Node::Text(t) => {
                let Some(&[text]) = source.ids().get(t.id()).map(Vec::as_slice) else { continue };
                let end = source.elements[text].range.end;
                let mut last = text;
                let owners = t.flattened().children().iter().map(|n| {
                    // Glyphs with colours of their own stay with their neighbours.
                    if let Node::Path(p) = n
                        && let Some(Paint::Color(c)) = p.fill().map(Fill::paint)
                        && (text..source.elements.len()).contains(&element(*c))
                        && source.elements[element(*c)].range.start < end
                    {
                        last = element(*c);
                    }
                    last
                });
                out.insert(text, owners.collect());
            }
            Node::Path(_) | Node::Image(_) => {}
        }
    }
}

/// The elements that a text is made of.
fn inside(source: &Source, text: ElementId) -> impl Iterator<Item = ElementId> + '_ {
    let end = source.elements[text].range.end;
    let all = (text + 1..source.elements.len()).take_while(move |&e| source.elements[e].range.start < end);
    all.filter(|&e| matches!(source.elements[e].tag.as_ref(), "tspan" | "textPath" | "tref" | "a"))
}

/// Attributes by which an element is known.
fn names(name: &str, namespace: Namespace) -> bool {
    let plain = name == "id" || name == "class" || name.starts_with("data-") || name.starts_with("aria-");
    plain && namespace == Namespace::None || namespace == Namespace::Inkscape
}

fn is_named(source: &Source, e: ElementId) -> bool {
    let el = &source.elements[e];
    el.title.is_some() || el.attrs.iter().any(|a| names(a.name(&source.text), a.namespace))
}

/// A named element of a text with what is left of it, in painting order.
struct Span {
    element: ElementId,
    content: Vec<Item>,
}

#[derive(Clone, Copy)]
enum Item {
    /// By number among the outlines.
    Outline(usize),
    /// By number among the spans.
    Span(usize),
}

/// The spans of a text, the text itself the first.
struct Spans(Vec<Span>);

impl Spans {
    fn new(text: ElementId) -> Self {
        Self(vec![Span { element: text, content: Vec::new() }])
    }

    /// The innermost span of a chain of elements, `path`, outermost first. With `anew`, one that is no longer the last is
    /// opened again.
    fn at(&mut self, path: &[ElementId], anew: bool) -> usize {
        let mut here = 0;
        for &e in path {
            let inside = &self.0[here].content;
            let is = |i: &Item| matches!(i, Item::Span(s) if self.0[*s].element == e).then_some(*i);
            let found = match inside.last() {
                Some(last) if anew => is(last),
                _ => inside.iter().rev().find_map(is),
            };
            here = if let Some(Item::Span(s)) = found {
                s
            } else {
                let new = self.0.len();
                self.0.push(Span { element: e, content: Vec::new() });
                self.0[here].content.push(Item::Span(new));
                new
            };
        }
        here
    }
}

impl Keeper<'_, '_> {
    /// A text as a group of outlines with the same name, inside it a group for everything that has a name.
    pub(crate) fn text(&mut self, e: ElementId, content: &Group, owners: &[ElementId]) {
        if !content.children.iter().any(|n| self.changed(n)) {
            return;
        }
        let said = self.said(e);
        let inner = if owners.len() == content.children.len() {
            let mut spans = Spans::new(e);
            let path = |of: ElementId| {
                let up = self.source.ancestors(of).take_while(|&a| a != e);
                let mut path: Vec<ElementId> = up.filter(|&a| is_named(self.source, a)).collect();
                path.reverse();
                path
            };
            for (i, &owner) in owners.iter().enumerate() {
                let span = spans.at(&path(owner), true);
                spans.0[span].content.push(Item::Outline(i));
            }
            for named in inside(self.source, e).filter(|&n| is_named(self.source, n)) {
                spans.at(&path(named), false);
            }
            let mut seen = Vec::new();
            let written = self.items(0, &spans, content, &mut seen);
            self.writer.group_around(content, &written)
        } else {
            self.writer.group(content, "")
        };
        let title = self.source.elements[e].title.as_ref().unwrap_or(&said);
        let tag = self.writer.tag("title");
        let title = if title.is_empty() { String::new() } else { format!("<{tag}>{}</{tag}>", escape(title)) };
        self.edits.rename(e, "g");
        for name in ["x", "y", "dx", "dy", "rotate", "textLength", "lengthAdjust"] {
            self.edits.remove_attr(e, name);
        }
        if !said.is_empty() && self.source.attr(e, "aria-label").is_none() {
            self.edits.set_attr(e, "aria-label", said);
        }
        self.fragments.insert(e);
        let animations = self.kept_animations(e);
        self.edits.set_content(e, format!("{title}{inner}{animations}"));
    }

    /// What a span holds.
    fn items(&mut self, span: usize, spans: &Spans, content: &Group, seen: &mut Vec<ElementId>) -> String {
        let mut out = String::new();
        for item in &spans.0[span].content {
            match *item {
                Item::Outline(i) => out.push_str(&self.writer.node(&content.children[i])),
                Item::Span(s) => out.push_str(&self.span(s, spans, content, seen)),
            }
        }
        out
    }

    fn span(&mut self, span: usize, spans: &Spans, content: &Group, seen: &mut Vec<ElementId>) -> String {
        let element = spans.0[span].element;
        let el = &self.source.elements[element];
        // What comes again carries its name no second time.
        let again = seen.contains(&element);
        seen.push(element);
        let text = &self.source.text;
        let name = |a: &Attr| a.name(text);
        let kept = el.attrs.iter().filter(|a| names(name(a), a.namespace) && !(again && name(a) == "id"));
        let mut head: String = kept.map(|a| format!(" {}", &text[a.range.clone()])).collect();
        if self.source.has_css() {
            head.push_str(crate::write::keep::NO_EFFECTS);
        }
        let tag = self.writer.tag("title");
        let title = el.title.as_ref().filter(|_| !again);
        let title = title.map_or(String::new(), |t| format!("<{tag}>{}</{tag}>", escape(t)));
        let inner = self.items(span, spans, content, seen);
        format!("<{0}{head}>{title}{inner}</{0}>", self.writer.tag("g"))
    }

    /// The words of a text, tags and what is not drawn taken out.
    fn said(&self, e: ElementId) -> String {
        let el = &self.source.elements[e];
        let Some(close) = &el.close else { return String::new() };
        let text = &self.source.text;
        let silent = (e + 1..self.source.elements.len())
            .map(|c| &self.source.elements[c])
            .take_while(|c| c.range.start < el.range.end)
            .filter(|c| matches!(c.tag.as_ref(), "title" | "desc" | "metadata" | "style" | "script"));
        let mut raw = String::new();
        let mut at = el.open_end;
        for s in silent {
            raw.push_str(text.get(at..s.range.start).unwrap_or(""));
            at = at.max(s.range.end);
        }
        raw.push_str(text.get(at..close.start).unwrap_or(""));
        let mut out = String::new();
        let mut tag = false;
        for c in raw.chars() {
            match c {
                '<' => tag = true,
                '>' => tag = false,
                c if !tag => out.push(c),
                _ => {}
            }
        }
        let plain = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&apos;", "'"), ("&amp;", "&")];
        let out = plain.iter().fold(out, |o, (from, to)| o.replace(from, to));
        out.split_whitespace().collect::<Vec<_>>().join(" ")
    }
}
