//! The elements of a file: ids, labels, and what they remember.

use super::names::{NAMESPACE, RECIPE};
use crate::source::tags::{INKSCAPE, SVG, is_shape, is_sodipodi};
use pathwarp::Error;
use pathwarp::budget::{Budget, Limits};
use pathwarp_reader::xml;
use std::collections::HashMap;
use usvg::roxmltree::{Document, Node};

/// An element with an id.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Object {
    /// Its id.
    pub id: String,
    /// Inkscape's label.
    pub label: Option<String>,
    /// Source element, e.g. `circle`.
    pub element: String,
    /// `true` for a path or basic shape that is drawn where it stands, not in `<defs>` or inside a clip path, mask or symbol.
    pub is_path: bool,
    /// `true` for a child of the root that may paint something.
    pub is_top: bool,
    /// `true` if the element or a group around it is locked in Inkscape or not displayed.
    pub is_locked: bool,
    /// Ids of the elements around it, the nearest first.
    pub inside: Vec<String>,
    /// The recipe that it was warped by, if it remembers one.
    pub recipe: Option<String>,
}

/// Lists the elements of the SVG namespace that have an id, in document order. Of several with the same id, the first counts.
///
/// # Errors
/// Returns [`Error::Input`] if `svg` is not XML, or takes more work than the limits allow.
pub fn objects(svg: &str, limits: &Limits) -> Result<Vec<Object>, Error> {
    let doc = parse(svg, limits)?;
    let found = by_id(&doc);
    let mut out = Vec::new();
    for n in doc.descendants().filter(|n| n.tag_name().namespace() == Some(SVG)) {
        let Some(id) = n.attribute("id").filter(|id| found.get(id) == Some(&n)) else { continue };
        let around = || n.ancestors().skip(1);
        let tag = n.tag_name().name();
        let hidden = |n: Node<'_, '_>| {
            is_definition(n.tag_name().name()) || matches!(n.tag_name().name(), "title" | "desc" | "metadata" | "style")
        };
        out.push(Object {
            id: id.to_owned(),
            label: n.attribute((INKSCAPE, "label")).map(ToOwned::to_owned),
            element: tag.to_owned(),
            is_path: is_shape(tag) && !around().any(|a| is_definition(a.tag_name().name())),
            is_top: n.parent() == Some(doc.root_element()) && !hidden(n),
            is_locked: n.ancestors().any(is_locked),
            inside: around().filter_map(|a| a.attribute("id")).map(ToOwned::to_owned).collect(),
            recipe: n.attribute((NAMESPACE, RECIPE)).map(ToOwned::to_owned),
        });
    }
    Ok(out)
}

/// Parses a file within limits.
pub(super) fn parse<'a>(svg: &'a str, limits: &Limits) -> Result<Document<'a>, Error> {
    xml::parse(svg, "the drawing", &Budget::new(limits.for_input(svg.len())))
}

/// The elements by id; of several with the same, the first.
pub(super) fn by_id<'a, 'i>(doc: &'a Document<'i>) -> HashMap<&'a str, Node<'a, 'i>> {
    let mut out = HashMap::new();
    for n in doc.descendants() {
        if let Some(id) = n.attribute("id") {
            out.entry(id).or_insert(n);
        }
    }
    out
}

/// Returns `true` for elements that are only drawn where something refers to them.
pub(super) fn is_definition(tag: &str) -> bool {
    matches!(
        tag,
        "defs"
            | "clipPath"
            | "mask"
            | "symbol"
            | "pattern"
            | "marker"
            | "linearGradient"
            | "radialGradient"
            | "filter"
            | "path-effect"
            | "perspective"
    )
}

/// Returns `true` for what Inkscape's tools cannot select.
fn is_locked(n: Node<'_, '_>) -> bool {
    let insensitive = |a: &usvg::roxmltree::Attribute<'_, '_>| {
        a.name() == "insensitive" && a.namespace().is_some_and(is_sodipodi) && a.value() == "true"
    };
    let off = |text: &str| text.split(';').any(|d| d.split_whitespace().collect::<String>() == "display:none");
    n.attributes().any(|a| insensitive(&a))
        || n.attribute("display") == Some("none")
        || n.attribute("style").is_some_and(off)
}
