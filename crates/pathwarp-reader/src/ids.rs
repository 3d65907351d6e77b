//! Finds the targets of references, and attributes by name.

use crate::value::percent_decoded;
use roxmltree::{Attribute, Document, NS_XML_URI, Node};
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
        self.get(&percent_decoded(attribute(node, "href")?.trim().strip_prefix('#')?))
    }
}

/// The value of an attribute whose name has no prefix, or the prefix `xml`; `href` may have any.
pub(super) fn attribute<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    attribute_node(node, name).map(|a| a.value())
}

/// Looks up an attribute whose name has no prefix, or the prefix `xml`. `href` may have any, if there is none without.
pub(super) fn attribute_node<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Attribute<'a, 'i>> {
    match name.strip_prefix("xml:") {
        Some(name) => node.attribute_node((NS_XML_URI, name)),
        None if name == "href" => node.attribute_node(name).or_else(|| node.attributes().find(|a| a.name() == name)),
        None => node.attribute_node(name),
    }
}
