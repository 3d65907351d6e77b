//! The package that an object carries: its source and the definitions it uses as a small SVG file, gzip and base64.
//!
//! ```xml
//! <svg xmlns="…"><defs>definitions</defs><g>guides</g>the element</svg>
//! ```

use super::names::referred;
use super::nodes::is_definition;
use crate::source::read::{compressed, unpacked};
use crate::source::tags::SVG;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use pathwarp::Error;
use pathwarp::budget::{Budget, Limits};
use pathwarp_reader::xml::escape;
use std::collections::{BTreeSet, HashMap};
use std::fmt::Write as _;
use usvg::roxmltree::{Document, Node};

/// The definitions that an element refers to, directly or by way of others, in document order.
pub(super) fn definitions<'a, 'i>(by_id: &HashMap<&'a str, Node<'a, 'i>>, n: Node<'a, 'i>) -> Vec<Node<'a, 'i>> {
    let mut found: BTreeSet<Node<'a, 'i>> = BTreeSet::new();
    let mut open = vec![n];
    while let Some(n) = open.pop() {
        for name in referred(n) {
            let Some(&target) = by_id.get(name.as_str()) else { continue };
            let defined = target.ancestors().any(|a| is_definition(a.tag_name().name()));
            if defined && found.insert(target) {
                open.push(target);
            }
        }
    }
    // What lies inside another definition comes with it.
    let inner = |d: &Node<'a, 'i>| d.ancestors().skip(1).any(|a| found.contains(&a) || a == n);
    found.iter().filter(|d| !inner(d)).copied().collect()
}

/// Packs an element of a document.
pub(super) fn pack(text: &str, n: Node<'_, '_>, definitions: &[Node<'_, '_>], guides: &str) -> Result<String, Error> {
    let mut out = String::from("<svg");
    for ns in n.namespaces() {
        match ns.name() {
            None => {
                let _ = write!(out, " xmlns=\"{}\"", escape(ns.uri()));
            }
            Some("xml") => {}
            Some(prefix) => {
                let _ = write!(out, " xmlns:{prefix}=\"{}\"", escape(ns.uri()));
            }
        }
    }
    out.push_str("><defs>");
    definitions.iter().for_each(|d| out.push_str(&text[d.range()]));
    out.push_str("</defs><g>");
    out.push_str(guides);
    out.push_str("</g>");
    out.push_str(&text[n.range()]);
    out.push_str("</svg>");
    let packed = compressed(&out).map_err(|e| Error::input("the source", format!("cannot be packed: {e}")))?;
    Ok(STANDARD.encode(packed))
}

/// Unpacks to the text of the small SVG file.
pub(super) fn unpack(value: &str, limits: &Limits) -> Result<String, Error> {
    let damaged = |e: &dyn std::fmt::Display| Error::input("the source of a warped object", format!("is damaged: {e}"));
    let packed: String = value.split_ascii_whitespace().collect();
    let bytes = STANDARD.decode(packed).map_err(|e| damaged(&e))?;
    let text = unpacked(&bytes, "the source of a warped object", &Budget::new(*limits))?;
    let text = text.ok_or_else(|| damaged(&"it is not compressed"))?;
    String::from_utf8(text).map_err(|e| damaged(&e))
}

/// The parts of a parsed package.
pub(super) struct Package<'a, 'i> {
    pub(super) element: Node<'a, 'i>,
    pub(super) definitions: Vec<Node<'a, 'i>>,
    pub(super) guides: Node<'a, 'i>,
}

impl<'a, 'i> Package<'a, 'i> {
    /// Finds the parts. Returns `None` if one is missing.
    pub(super) fn of(doc: &'a Document<'i>) -> Option<Self> {
        let mut parts = doc.root_element().children().filter(Node::is_element);
        let (defs, guides, element) = (parts.next()?, parts.next()?, parts.next()?);
        let named = |n: Node<'_, '_>, tag| n.tag_name().namespace() == Some(SVG) && n.tag_name().name() == tag;
        (named(defs, "defs") && named(guides, "g")).then(|| Self {
            element,
            definitions: defs.children().filter(Node::is_element).collect(),
            guides,
        })
    }
}
