//! An element of the source with the positions of its tags and attributes in the text.

use super::tags::{ElementId, Namespace};
use std::borrow::Cow;
use std::ops::Range;

#[derive(Debug)]
pub(crate) struct Attr {
    /// Range of the local name in the text.
    pub(crate) name: Range<usize>,
    pub(crate) namespace: Namespace,
    /// Range of the whole attribute in the text, closing quote included.
    pub(crate) range: Range<usize>,
    /// Range of the value in the text, without the quotes.
    pub(crate) value_range: Range<usize>,
    /// The parsed value, if it differs from the text (entities, line ends).
    pub(crate) value: Option<String>,
}

impl Attr {
    /// Local name.
    pub(crate) fn name<'a>(&self, text: &'a str) -> &'a str {
        text.get(self.name.clone()).unwrap_or("")
    }

    pub(crate) fn value<'a>(&'a self, text: &'a str) -> Cow<'a, str> {
        match &self.value {
            Some(v) => Cow::Borrowed(v),
            None => Cow::Borrowed(&text[self.value_range.clone()]),
        }
    }
}

#[derive(Debug)]
pub(crate) struct Element {
    pub(crate) parent: Option<ElementId>,
    /// Local name; empty for elements outside the SVG namespace.
    pub(crate) tag: Cow<'static, str>,
    /// Range of the name as written, prefix included.
    pub(crate) qname: Range<usize>,
    pub(crate) range: Range<usize>,
    /// Position after the `>` of the opening tag.
    pub(crate) open_end: usize,
    /// Range of the closing tag; `None` for `<a/>`.
    pub(crate) close: Option<Range<usize>>,
    pub(crate) attrs: Vec<Attr>,
    /// Text of the `<title>` child.
    pub(crate) title: Option<String>,
}

impl Element {
    /// Finds an attribute without a namespace.
    pub(crate) fn find(&self, text: &str, name: &str) -> Option<&Attr> {
        self.attrs.iter().find(|a| a.namespace == Namespace::None && a.name(text) == name)
    }

    pub(crate) fn attr<'a>(&'a self, text: &'a str, name: &str) -> Option<Cow<'a, str>> {
        self.find(text, name).map(|a| a.value(text))
    }

    /// The attribute that usvg takes as the element's id.
    pub(crate) fn id_attr(&self, text: &str) -> Option<&Attr> {
        let is_id = |a: &&Attr| matches!(a.namespace, Namespace::None | Namespace::Xml) && a.name(text) == "id";
        self.attrs.iter().find(is_id)
    }
}
