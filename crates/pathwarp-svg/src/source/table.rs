//! Builds the table of elements, with their source positions, from a parsed document.

use super::element::{Attr, Element};
use super::tags::{ElementId, Namespace, SVG};
use super::unpatchable::Unpatchable;
use memchr::memrchr;
use std::borrow::Cow;
use usvg::roxmltree;

/// The elements of a document.
pub(crate) struct Table {
    pub(crate) elements: Vec<Element>,
    /// Text of all style sheets.
    pub(crate) css: String,
    /// Reason why the text cannot be patched in place.
    pub(crate) unpatchable: Option<Unpatchable>,
}

impl Table {
    /// Lists the elements of a document. Returns `None` if the root is not `<svg>`.
    pub(crate) fn of(doc: &roxmltree::Document<'_>) -> Option<Self> {
        let root = doc.root_element();
        if root.tag_name().name() != "svg" || !matches!(root.tag_name().namespace(), Some(SVG) | None) {
            return None;
        }
        let start = root.range().start;
        let mut out = Self { elements: Vec::new(), css: String::new(), unpatchable: None };
        // The current element and its ancestors.
        let mut open: Vec<(Option<roxmltree::NodeId>, ElementId)> = Vec::new();
        for node in doc.descendants().filter(roxmltree::Node::is_element) {
            let id = out.elements.len();
            let around = node.parent().map(|p| p.id());
            while open.last().is_some_and(|o| o.0 != around) {
                open.pop();
            }
            let parent = open.last().map(|o| o.1);
            open.push((Some(node.id()), id));
            // The replacement text of an entity is in the DTD, before the root.
            let element = (node.range().start >= start).then(|| element(doc.input_text(), node, parent)).flatten();
            out.elements.push(element.unwrap_or_else(|| {
                out.unpatchable.get_or_insert(Unpatchable::Entities);
                Element {
                    parent: None,
                    tag: Cow::Borrowed(""),
                    qname: 0..0,
                    range: 0..0,
                    open_end: 0,
                    close: None,
                    attrs: Vec::new(),
                    title: None,
                }
            }));
            if out.elements.last().is_some_and(|e| e.tag == "style") {
                out.css.push_str(node.text().unwrap_or_default());
                out.css.push('\n');
            }
        }
        Some(out)
    }
}

/// Locates an element in the source. Returns `None` if it comes from an entity.
fn element(text: &str, node: roxmltree::Node<'_, '_>, parent: Option<ElementId>) -> Option<Element> {
    let range = node.range();
    let rest = text.as_bytes().get(range.clone())?.strip_prefix(b"<")?;
    let len = rest.iter().position(|b| b.is_ascii_whitespace() || matches!(b, b'/' | b'>'))?;
    let qname = range.start + 1..range.start + 1 + len;
    let name = node.tag_name();
    let local = name.name();
    // The name may have a prefix.
    let before = rest.get(..len)?.strip_suffix(local.as_bytes())?;
    if !matches!(before.last(), None | Some(b':')) {
        return None;
    }
    let attributes = node.attributes();
    let mut attrs = Vec::with_capacity(attributes.len());
    let mut last = qname.end;
    for a in attributes {
        let (r, v) = (a.range(), a.range_value());
        let raw = text.get(v.clone())?;
        if r.start < last || r.end > range.end || !text.as_bytes().get(r.clone())?.contains(&b'=') {
            return None;
        }
        last = last.max(r.end);
        let full = a.range_qname();
        attrs.push(Attr {
            name: full.end.checked_sub(a.name().len())?..full.end,
            namespace: Namespace::of(a.namespace()),
            range: r,
            value: (raw != a.value()).then(|| a.value().to_owned()),
            value_range: v,
        });
    }
    // The parser does not list namespace declarations as attributes; their quoted values may contain `>`.
    let open_end = tag_end(text, last, range.end)?;
    let close =
        if open_end < range.end { Some(memrchr(b'<', text.as_bytes().get(..range.end)?)?..range.end) } else { None };
    let svg = matches!(name.namespace(), Some(SVG) | None);
    let title = node
        .children()
        .find(|c| c.is_element() && c.tag_name().name() == "title")
        .and_then(|t| t.text())
        .map(|t| t.trim().to_owned())
        .filter(|t| !t.is_empty());
    let tag = if svg { known(local).map_or_else(|| Cow::Owned(local.to_owned()), Cow::Borrowed) } else { "".into() };
    Some(Element {
        parent,
        tag,
        qname,
        range: range.start..close.as_ref().map_or(open_end, |c| c.end),
        open_end,
        close,
        attrs,
        title,
    })
}

/// Interns common element names to avoid allocating them.
fn known(tag: &str) -> Option<&'static str> {
    Some(match tag {
        "path" => "path",
        "g" => "g",
        "svg" => "svg",
        "rect" => "rect",
        "circle" => "circle",
        "use" => "use",
        "defs" => "defs",
        "stop" => "stop",
        "title" => "title",
        "ellipse" => "ellipse",
        "line" => "line",
        "polygon" => "polygon",
        "polyline" => "polyline",
        "linearGradient" => "linearGradient",
        "radialGradient" => "radialGradient",
        "clipPath" => "clipPath",
        "mask" => "mask",
        "style" => "style",
        _ => return None,
    })
}

/// Finds the end of an opening tag: after the first `>` outside of quotes.
pub(crate) fn tag_end(text: &str, from: usize, to: usize) -> Option<usize> {
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
