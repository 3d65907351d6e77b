//! Adds sources and recipes to the objects of a result.

use super::nodes::{Guides, MADE, NAMESPACE, NODES, RECIPE, SOURCE, apply, by_id, is_definition, parse, referred};
use crate::source::elements::SVG;
use crate::source::read::{packed, unpacked_text};
use pathwarp::Error;
use pathwarp::budget::{Budget, Limits};
use pathwarp_reader::xml::{escape, name_end};
use std::collections::{BTreeSet, HashMap};
use std::fmt::Write as _;
use std::ops::Range;
use usvg::roxmltree::{Document, Node};

/// The source and recipe that an object remembers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Memory {
    /// Its id, in the source and in the result.
    pub id: String,
    /// The recipe, on one line, as editors turn line ends in attributes into spaces.
    pub recipe: String,
    /// The paths to which the recipe refers.
    pub guides: Guides,
    /// A summary of the result's nodes, for finding later edits by hand.
    pub nodes: String,
}

/// Adds sources and recipes to the objects of `after`, the result of warping `before`. An unchanged object gets none. Objects inside an
/// object lose theirs, which its source contains.
///
/// # Errors
/// Returns [`Error::Input`] if one of the files is not XML, or takes more work than the limits allow.
pub fn remember(before: &str, after: &str, memories: &[Memory], limits: &Limits) -> Result<String, Error> {
    let (old, new) = (parse(before, limits)?, parse(after, limits)?);
    let (olds, news) = (by_id(&old), by_id(&new));
    let mut patches: Vec<(Range<usize>, String)> = Vec::new();
    for m in memories {
        let (Some(&source), Some(&result)) = (olds.get(m.id.as_str()), news.get(m.id.as_str())) else { continue };
        let used = definitions(&olds, source);
        // The text of an object may be unchanged although a clip path that it uses was warped.
        let same_definitions = || definitions(&news, result).iter().all(|d| is_same(before, after, &olds, *d));
        if before[source.range()] == after[result.range()] && same_definitions() {
            continue;
        }
        for n in result.descendants() {
            patches.extend(pathwarp_attributes(after, n).map(|r| (r, String::new())));
        }
        let packed = pack(before, source, &used, &m.guides.markup)?;
        let made = new_definitions(&olds, &news, result).join(" ");
        let name_end = name_end(after, result);
        let attributes = format!(
            " xmlns:pathwarp=\"{NAMESPACE}\" pathwarp:{RECIPE}=\"{}\" pathwarp:{MADE}=\"{}\" pathwarp:{NODES}=\"{}\" pathwarp:{SOURCE}=\"{packed}\"",
            escape(&m.recipe),
            escape(&made),
            escape(&m.nodes),
        );
        patches.push((name_end..name_end, without_declared(after, result, attributes)));
    }
    Ok(apply(after, patches))
}

/// The attributes without the declaration of their prefix if the element has it, as it may declare a prefix only once.
fn without_declared(text: &str, n: Node<'_, '_>, attributes: String) -> String {
    let start = n.range().start;
    let tag = &text[start..n.first_child().map_or(n.range().end, |c| c.range().start)];
    if tag.contains(" xmlns:pathwarp=") {
        attributes.replacen(&format!(" xmlns:pathwarp=\"{NAMESPACE}\""), "", 1)
    } else {
        attributes
    }
}

/// The attributes in pathwarp's namespace on an element, each with the space before it.
fn pathwarp_attributes(text: &str, n: Node<'_, '_>) -> impl Iterator<Item = Range<usize>> {
    let ranges = n.attributes().filter(|a| a.namespace() == Some(NAMESPACE)).map(|a| a.range());
    ranges.map(|r| text[..r.start].trim_end().len()..r.end)
}

/// Returns `true` if a definition of the result has the text that it has in the source.
fn is_same(before: &str, after: &str, olds: &HashMap<&str, Node<'_, '_>>, n: Node<'_, '_>) -> bool {
    let old = n.attribute("id").and_then(|id| olds.get(id));
    old.is_some_and(|o| before[o.range()] == after[n.range()])
}

/// Ids of the definitions that a result uses and the source does not have.
fn new_definitions(
    olds: &HashMap<&str, Node<'_, '_>>,
    news: &HashMap<&str, Node<'_, '_>>,
    result: Node<'_, '_>,
) -> Vec<String> {
    let mut found = BTreeSet::new();
    let mut open = referred(result);
    while let Some(name) = open.pop() {
        let Some(n) = news.get(name.as_str()) else { continue };
        let is_defined = n.ancestors().skip(1).any(|a| is_definition(a.tag_name().name()));
        if is_defined && !olds.contains_key(name.as_str()) && found.insert(name) {
            open.extend(referred(*n));
        }
    }
    found.into_iter().collect()
}

/// The definitions to which an element refers, directly or through others, in document order.
pub(super) fn definitions<'a, 'i>(by_id: &HashMap<&'a str, Node<'a, 'i>>, n: Node<'a, 'i>) -> Vec<Node<'a, 'i>> {
    let mut found: BTreeSet<Node<'a, 'i>> = BTreeSet::new();
    let mut open = vec![n];
    while let Some(n) = open.pop() {
        for name in referred(n) {
            let Some(&target) = by_id.get(name.as_str()) else { continue };
            let is_defined = target.ancestors().any(|a| is_definition(a.tag_name().name()));
            if is_defined && found.insert(target) {
                open.push(target);
            }
        }
    }
    // A definition inside another one comes with it.
    let is_inner = |d: &Node<'a, 'i>| d.ancestors().skip(1).any(|a| found.contains(&a) || a == n);
    found.iter().filter(|d| !is_inner(d)).copied().collect()
}

/// An element of a document, packed with its definitions and guides as a small SVG file.
pub(super) fn pack(text: &str, n: Node<'_, '_>, definitions: &[Node<'_, '_>], guides: &str) -> Result<String, Error> {
    let mut out = String::from("<svg");
    for ns in n.namespaces().filter(|ns| ns.name() != Some("xml")) {
        let prefix = ns.name().map_or_else(String::new, |prefix| format!(":{prefix}"));
        let _ = write!(out, " xmlns{prefix}=\"{}\"", escape(ns.uri()));
    }
    let definitions: String = definitions.iter().map(|d| &text[d.range()]).collect();
    let _ = write!(out, "><defs>{definitions}</defs><g>{guides}</g>{}</svg>", &text[n.range()]);
    packed(out.as_bytes())
}

/// The text of a packed SVG file.
pub(super) fn unpack(value: &str, limits: &Limits) -> Result<String, Error> {
    const PLACE: &str = "the source of a warped object";
    let text = unpacked_text(value, PLACE, &Budget::new(*limits))?;
    String::from_utf8(text).map_err(|e| Error::input(PLACE, format!("is damaged: {e}")))
}

/// The parts of an unpacked source.
pub(super) struct Package<'a, 'i> {
    pub(super) element: Node<'a, 'i>,
    pub(super) definitions: Vec<Node<'a, 'i>>,
    pub(super) guides: Node<'a, 'i>,
}

impl<'a, 'i> Package<'a, 'i> {
    /// Finds the parts. Returns `None` if one is missing.
    pub(super) fn find(doc: &'a Document<'i>) -> Option<Self> {
        let mut parts = doc.root_element().children().filter(Node::is_element);
        let (defs, guides, element) = (parts.next()?, parts.next()?, parts.next()?);
        let has_tag = |n: Node<'_, '_>, tag| n.tag_name().namespace() == Some(SVG) && n.tag_name().name() == tag;
        (has_tag(defs, "defs") && has_tag(guides, "g")).then(|| Self {
            element,
            definitions: defs.children().filter(Node::is_element).collect(),
            guides,
        })
    }
}
