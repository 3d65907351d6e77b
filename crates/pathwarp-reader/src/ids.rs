//! Finds the targets of references, and attributes by name.

use crate::value::percent_decoded;
use roxmltree::{Document, NS_XML_URI, Node};
use std::cell::OnceCell;
use std::collections::HashMap;

/// The elements of a drawing by id. The first of several with the same id wins.
pub(super) struct Ids<'a, 'i> {
    doc: &'a Document<'i>,
    known: OnceCell<HashMap<&'a str, Node<'a, 'i>>>,
}

impl<'a, 'i> Ids<'a, 'i> {
    pub(super) fn new(doc: &'a Document<'i>) -> Self {
        Self { doc, known: OnceCell::new() }
    }

    pub(super) fn get(&self, id: &str) -> Option<Node<'a, 'i>> {
        let known = self.known.get_or_init(|| {
            let mut out = HashMap::new();
            for node in self.doc.descendants() {
                if let Some(id) = node.attribute("id") {
                    out.entry(id).or_insert(node);
                }
            }
            out
        });
        known.get(id).copied()
    }

    /// The element that an element's `href` refers to.
    pub(super) fn target(&self, node: Node<'_, '_>) -> Option<Node<'a, 'i>> {
        let links = || node.attributes().filter(|a| a.name() == "href");
        let link = links().find(|a| a.namespace().is_none()).or_else(|| links().next())?;
        self.get(&percent_decoded(link.value().trim().strip_prefix('#')?))
    }
}

/// Looks up an attribute whose name has no prefix, or the prefix `xml`.
pub(super) fn attribute<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    match name.strip_prefix("xml:") {
        Some(name) => node.attribute((NS_XML_URI, name)),
        None => node.attribute(name),
    }
}
