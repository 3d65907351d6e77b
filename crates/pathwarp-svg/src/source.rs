//! The source text as a table of elements with their places in it: what the writer patches and what names are looked up in.

use crate::keep::is_animation;
use pathwarp::Error;
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use usvg::roxmltree;

const SVG: &str = "http://www.w3.org/2000/svg";
const XLINK: &str = "http://www.w3.org/1999/xlink";
const XML: &str = "http://www.w3.org/XML/1998/namespace";
const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";

/// An element's number: its place in document order.
pub(crate) type ElementId = usize;

/// Where an attribute's name comes from, as far as anybody here asks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Namespace {
    None,
    Xlink,
    Xml,
    Inkscape,
    Other,
}

#[derive(Debug)]
pub(crate) struct Attr {
    pub(crate) name: String,
    pub(crate) namespace: Namespace,
    /// The whole attribute in the text, quotes included.
    pub(crate) range: Range<usize>,
    /// The value in the text, without the quotes.
    pub(crate) value_range: Range<usize>,
    /// The value, where it differs from the text (entities, line ends).
    value: Option<String>,
}

#[derive(Debug)]
pub(crate) struct Element {
    pub(crate) parent: Option<ElementId>,
    /// The local name; empty for elements that are not SVG.
    pub(crate) tag: String,
    /// The name as written, prefix included, right after `<`.
    pub(crate) qname: Range<usize>,
    pub(crate) range: Range<usize>,
    /// One past the `>` of the opening tag.
    pub(crate) open_end: usize,
    /// The closing tag; `None` for `<a/>`.
    pub(crate) close: Option<Range<usize>>,
    pub(crate) attrs: Vec<Attr>,
    /// What its `<title>` child says.
    pub(crate) title: Option<String>,
}

/// The text and its elements.
#[derive(Debug)]
pub(crate) struct Source {
    pub(crate) text: String,
    pub(crate) elements: Vec<Element>,
    /// Elements by id, in document order.
    pub(crate) by_id: HashMap<String, Vec<ElementId>>,
    /// All style sheets' text, one after the other.
    pub(crate) css: String,
    /// Element and property names that a selector or a declaration of the style sheets mentions.
    css_words: HashSet<String>,
    /// Whether anything moves.
    pub(crate) animated: bool,
    /// Why the text cannot be patched in place.
    pub(crate) unpatchable: Option<String>,
    line_starts: Vec<usize>,
}

/// The elements that draw by themselves.
pub(crate) fn is_shape(tag: &str) -> bool {
    matches!(tag, "path" | "rect" | "circle" | "ellipse" | "line" | "polyline" | "polygon")
}

/// The elements whose ids usvg carries into its tree.
fn is_tracked(tag: &str) -> bool {
    is_shape(tag) || matches!(tag, "g" | "a" | "use" | "text" | "image" | "svg" | "switch")
}

impl Source {
    /// Reads `text`, called `name` in messages.
    pub(crate) fn parse(text: String, name: &str) -> Result<Self, Error> {
        let options = roxmltree::ParsingOptions { allow_dtd: true, nodes_limit: 4_000_000, ..Default::default() };
        let doc = roxmltree::Document::parse_with_options(&text, options).map_err(|e| {
            let at = e.pos();
            Error::input(format!("{name}:{}:{}", at.row, at.col), format!("this is not well-formed XML: {e}"))
        })?;
        let root = doc.root_element();
        if root.tag_name().name() != "svg" || !matches!(root.tag_name().namespace(), Some(SVG) | None) {
            let at = doc.text_pos_at(root.range().start);
            return Err(Error::input(
                format!("{name}:{}:{}", at.row, at.col),
                format!("the root element is <{}>, not <svg>", root.tag_name().name()),
            ));
        }
        let mut number: HashMap<roxmltree::NodeId, ElementId> = HashMap::new();
        let mut elements = Vec::new();
        let mut by_id: HashMap<String, Vec<ElementId>> = HashMap::new();
        let mut css = String::new();
        let mut unpatchable = None;
        for node in doc.descendants().filter(roxmltree::Node::is_element) {
            let id = elements.len();
            number.insert(node.id(), id);
            let element = element(&text, node, node.parent().and_then(|p| number.get(&p.id()).copied()))
                // An entity's own text stands in the DTD, before the root.
                .filter(|e| e.range.start >= root.range().start);
            match element {
                Some(e) => {
                    if let Some(v) = e.attr(&text, "id").filter(|v| !v.is_empty()) {
                        by_id.entry(v.into_owned()).or_default().push(id);
                    }
                    if e.tag == "style" {
                        css.push_str(node.text().unwrap_or_default());
                        css.push('\n');
                    }
                    elements.push(e);
                }
                None => {
                    unpatchable.get_or_insert_with(|| {
                        "parts of it come from DTD entities, which have no place in the text".to_owned()
                    });
                    elements.push(Element {
                        parent: None,
                        tag: String::new(),
                        qname: 0..0,
                        range: 0..0,
                        open_end: 0,
                        close: None,
                        attrs: Vec::new(),
                        title: None,
                    });
                }
            }
        }
        let css_words = words(&css);
        let line_starts = std::iter::once(0).chain(text.match_indices('\n').map(|(i, _)| i + 1)).collect();
        drop(doc);
        let animated = elements.iter().any(|e| is_animation(&e.tag));
        Ok(Self { animated, text, elements, by_id, css, css_words, unpatchable, line_starts })
    }

    /// Line and column (in characters), counted from 1.
    pub(crate) fn line_column(&self, at: usize) -> (usize, usize) {
        let line = self.line_starts.partition_point(|&s| s <= at);
        let start = line.checked_sub(1).and_then(|l| self.line_starts.get(l)).copied().unwrap_or(0);
        (line, self.text.get(start..at).map_or(0, |s| s.chars().count()) + 1)
    }

    pub(crate) fn attr(&self, e: ElementId, name: &str) -> Option<Cow<'_, str>> {
        self.elements.get(e)?.attr(&self.text, name)
    }

    /// An attribute whatever its namespace prefix means, e.g. Inkscape's label.
    pub(crate) fn attr_in(&self, e: ElementId, namespace: Namespace, name: &str) -> Option<Cow<'_, str>> {
        let el = self.elements.get(e)?;
        el.attrs.iter().find(|a| a.namespace == namespace && a.name == name).map(|a| a.value(&self.text))
    }

    /// The target of `href` or `xlink:href`, without the `#`.
    pub(crate) fn href(&self, e: ElementId) -> Option<String> {
        self.link(e)?.trim().strip_prefix('#').map(ToOwned::to_owned)
    }

    /// What `href` or `xlink:href` says.
    pub(crate) fn link(&self, e: ElementId) -> Option<Cow<'_, str>> {
        self.attr_in(e, Namespace::None, "href").or_else(|| self.attr_in(e, Namespace::Xlink, "href"))
    }

    /// The element and its ancestors, innermost first.
    pub(crate) fn ancestors(&self, e: ElementId) -> impl Iterator<Item = ElementId> {
        std::iter::successors(Some(e), |&e| self.elements.get(e).and_then(|e| e.parent))
    }

    /// The nearest enclosing `<svg>` (not the element itself).
    pub(crate) fn viewport(&self, e: ElementId) -> Option<ElementId> {
        self.ancestors(e).skip(1).find(|&a| self.elements[a].tag == "svg")
    }

    pub(crate) fn label(&self, e: ElementId) -> Option<Cow<'_, str>> {
        self.attr_in(e, Namespace::Inkscape, "label")
    }

    /// The id, or a readable stand-in such as `path at 12:5`.
    pub(crate) fn display_name(&self, e: ElementId) -> String {
        match self.attr(e, "id") {
            Some(id) if !id.is_empty() => id.into_owned(),
            _ => {
                let (line, column) = self.line_column(self.elements[e].range.start);
                format!("{} at {line}:{column}", self.elements[e].tag)
            }
        }
    }

    /// Whether there are style sheets.
    pub(crate) fn has_css(&self) -> bool {
        !self.css.trim().is_empty()
    }

    /// Whether the style sheets say anything with this name: an element in a selector or a property in a declaration.
    pub(crate) fn css_mentions(&self, word: &str) -> bool {
        self.css_words.contains(word)
    }

    /// The prefix that SVG's own elements carry, with its colon: mostly "".
    pub(crate) fn prefix(&self) -> &str {
        let Some(root) = self.elements.first() else { return "" };
        let name = self.text.get(root.qname.clone()).unwrap_or("");
        name.find(':').map_or("", |i| &name[..=i])
    }

    /// The text with a temporary id on every element that has none of its own, so that usvg's tree can be told apart; and
    /// what each id stands for.
    pub(crate) fn instrumented(&self) -> (String, HashMap<String, Vec<ElementId>>) {
        self.instrumented_with(std::iter::empty())
    }

    /// The same with declarations added to elements' style attributes.
    pub(crate) fn instrumented_with(
        &self,
        styles: impl Iterator<Item = (ElementId, String)>,
    ) -> (String, HashMap<String, Vec<ElementId>>) {
        let mut stem = "warp-".to_owned();
        while self.text.contains(&stem) {
            stem.push('x');
        }
        // Everything that looks like a reference; more than there are does no harm.
        let links: HashSet<&str> = self
            .text
            .match_indices('#')
            .map(|(i, _)| {
                let rest = &self.text[i + 1..];
                &rest[..rest.find(|c: char| !(c.is_alphanumeric() || "-_.:".contains(c))).unwrap_or(rest.len())]
            })
            .collect();
        let mut ids: HashMap<String, Vec<ElementId>> = HashMap::new();
        let mut patches: Vec<(Range<usize>, String)> = Vec::new();
        for (i, e) in self.elements.iter().enumerate() {
            if !is_tracked(&e.tag) {
                continue;
            }
            let own =
                e.attrs.iter().find(|a| a.name == "id" && matches!(a.namespace, Namespace::None | Namespace::Xml));
            let value = own.map(|a| a.value(&self.text));
            let shared = |id: &str| self.by_id.get(id).is_some_and(|v| v.len() > 1);
            let referenced = |id: &str| links.contains(id);
            match (own, value) {
                (Some(_), Some(id)) if !id.is_empty() && (!shared(&id) || referenced(&id)) => {
                    ids.entry(id.into_owned()).or_default().push(i);
                }
                (own, _) => {
                    let id = format!("{stem}{i}");
                    patches.push(match own {
                        Some(a) => (a.value_range.clone(), id.clone()),
                        None => (e.qname.end..e.qname.end, format!(" id=\"{id}\"")),
                    });
                    ids.insert(id, vec![i]);
                }
            }
        }
        patches.extend(styles.filter_map(|(e, style)| {
            let e = self.elements.get(e)?;
            Some(match e.find("style") {
                Some(a) => (a.value_range.end..a.value_range.end, format!(";{style}")),
                None => (e.qname.end..e.qname.end, format!(" style=\"{style}\"")),
            })
        }));
        patches.sort_by_key(|(at, _)| at.start);
        let mut out = String::with_capacity(self.text.len() + patches.len() * 16);
        let mut done = 0;
        for (at, new) in patches {
            // Of elements from one entity only the first is told.
            if at.start >= done {
                out.push_str(&self.text[done..at.start]);
                out.push_str(&new);
                done = at.end;
            }
        }
        out.push_str(&self.text[done..]);
        (out, ids)
    }
}

impl Attr {
    pub(crate) fn value<'a>(&'a self, text: &'a str) -> Cow<'a, str> {
        match &self.value {
            Some(v) => Cow::Borrowed(v),
            None => Cow::Borrowed(&text[self.value_range.clone()]),
        }
    }
}

impl Element {
    pub(crate) fn find(&self, name: &str) -> Option<&Attr> {
        self.attrs.iter().find(|a| a.namespace == Namespace::None && a.name == name)
    }

    fn attr<'a>(&'a self, text: &'a str, name: &str) -> Option<Cow<'a, str>> {
        self.find(name).map(|a| a.value(text))
    }
}

/// The element's places in the text; `None` if they are not there (it comes from an entity).
fn element(text: &str, node: roxmltree::Node<'_, '_>, parent: Option<ElementId>) -> Option<Element> {
    let range = node.range();
    let body = text.get(range.clone())?;
    let rest = body.strip_prefix('<')?;
    let len = rest.find(|c: char| c.is_whitespace() || c == '/' || c == '>')?;
    let qname = range.start + 1..range.start + 1 + len;
    let local = rest[..len].rsplit(':').next()?;
    if local != node.tag_name().name() {
        return None;
    }
    let mut attrs = Vec::new();
    let mut last = qname.end;
    for a in node.attributes() {
        let (r, v) = (a.range(), a.range_value());
        let raw = text.get(v.clone())?;
        if r.start < last || r.end > range.end || !text.get(r.clone())?.contains('=') {
            return None;
        }
        last = last.max(r.end);
        let namespace = match a.namespace() {
            None => Namespace::None,
            Some(XLINK) => Namespace::Xlink,
            Some(XML) => Namespace::Xml,
            Some(INKSCAPE) => Namespace::Inkscape,
            Some(_) => Namespace::Other,
        };
        let value = (raw != a.value()).then(|| a.value().to_owned());
        attrs.push(Attr { name: a.name().to_owned(), namespace, range: r, value_range: v, value });
    }
    // Namespace declarations are no attributes for the parser but stand among them; their quotes may hold a `>`.
    let open_end = tag_end(text, last, range.end)?;
    let close = (open_end < range.end).then(|| text[..range.end].rfind("</").map(|s| s..range.end)).flatten();
    let svg = matches!(node.tag_name().namespace(), Some(SVG) | None);
    let title = node
        .children()
        .find(|c| c.is_element() && c.tag_name().name() == "title")
        .and_then(|t| t.text())
        .map(|t| t.trim().to_owned())
        .filter(|t| !t.is_empty());
    let tag = if svg { local.to_owned() } else { String::new() };
    Some(Element { parent, tag, qname, range, open_end, close, attrs, title })
}

fn tag_end(text: &str, from: usize, to: usize) -> Option<usize> {
    let mut quote = None;
    for (i, b) in text.as_bytes().get(from..to)?.iter().enumerate() {
        match (quote, b) {
            (None, b'"' | b'\'') => quote = Some(*b),
            (Some(q), b) if q == *b => quote = None,
            (None, b'>') => return Some(from + i + 1),
            _ => {}
        }
    }
    None
}

/// The words of a style sheet. Class and id names are left out, as `.rect` says nothing about `<rect>`.
fn words(css: &str) -> HashSet<String> {
    let mut out = HashSet::new();
    let mut word = String::new();
    let mut before = ' ';
    let mut named = false;
    let css: String = css
        .split("/*")
        .enumerate()
        .map(|(i, s)| if i == 0 { s } else { s.split_once("*/").map_or("", |p| p.1) })
        .collect();
    for c in css.chars().chain(['\n']) {
        if c.is_alphanumeric() || c == '-' || c == '_' {
            if word.is_empty() {
                named = before == '.' || before == '#';
            }
            word.push(c);
        } else {
            if !word.is_empty() && !named {
                out.insert(word.to_ascii_lowercase());
            }
            word.clear();
            if c == '*' {
                out.insert("*".to_owned());
            }
            before = c;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_found() {
        let s = Source::parse(
            "<svg xmlns='http://www.w3.org/2000/svg'>\n <rect  x = '1' id='a'/><g a='>'>t</g></svg>".into(),
            "t",
        )
        .unwrap();
        let r = &s.elements[1];
        assert_eq!(&s.text[r.range.clone()], "<rect  x = '1' id='a'/>");
        assert_eq!(&s.text[r.find("x").unwrap().value_range.clone()], "1");
        assert!(r.close.is_none());
        let g = &s.elements[2];
        assert_eq!(&s.text[g.open_end..g.close.clone().unwrap().start], "t");
        assert_eq!(s.line_column(r.range.start), (2, 2));
    }

    #[test]
    fn temporary_ids_leave_the_rest_alone() {
        let s = Source::parse(
            "<svg xmlns='http://www.w3.org/2000/svg'><path/><g id='q'><path id=''/></g></svg>".into(),
            "t",
        )
        .unwrap();
        let (text, ids) = s.instrumented();
        assert_eq!(
            text,
            "<svg id=\"warp-0\" xmlns='http://www.w3.org/2000/svg'><path id=\"warp-1\"/><g id='q'><path id='warp-3'/></g></svg>"
        );
        assert_eq!(ids["q"], [2]);
    }

    #[test]
    fn a_class_is_not_a_type_selector() {
        let w = words("/* rect */ .circle, g > line:hover{fill:red}");
        assert!(w.contains("line") && w.contains("fill") && !w.contains("circle") && !w.contains("*"));
    }
}
