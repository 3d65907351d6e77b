//! Lists the elements of a file with their ids, labels and recipes, and edits its text.

use crate::source::edit::splice;
use crate::source::elements::{INKSCAPE, SVG, is_shape, is_sodipodi};
use pathwarp::Error;
use pathwarp::budget::{Budget, Limits};
use pathwarp_reader::xml::{self, escape};
use std::collections::HashMap;
use std::ops::Range;
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
    /// `true` for a path or basic shape that is drawn without a reference: not in `<defs>` or inside a clip path, mask or symbol.
    pub is_path: bool,
    /// `true` for a child of the root that may paint something.
    pub is_top: bool,
    /// `true` if the element or a group around it is locked in Inkscape or not displayed.
    pub is_locked: bool,
    /// Ids of the elements around it, the nearest first.
    pub inside: Vec<String>,
    /// The recipe by which it was warped, if it remembers one.
    pub recipe: Option<String>,
}

/// Lists the elements of the SVG namespace that have an id, in document order. Of several with one id, the first counts.
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
        let is_hidden = is_definition(tag) || matches!(tag, "title" | "desc" | "metadata" | "style");
        out.push(Object {
            id: id.to_owned(),
            label: n.attribute((INKSCAPE, "label")).map(ToOwned::to_owned),
            element: tag.to_owned(),
            is_path: is_shape(tag) && !around().any(|a| is_definition(a.tag_name().name())),
            is_top: n.parent() == Some(doc.root_element()) && !is_hidden,
            is_locked: n.ancestors().any(is_locked),
            inside: around().filter_map(|a| a.attribute("id")).map(ToOwned::to_owned).collect(),
            recipe: n.attribute((NAMESPACE, RECIPE)).map(ToOwned::to_owned),
        });
    }
    Ok(out)
}

/// Parses a drawing within limits.
pub(super) fn parse<'a>(svg: &'a str, limits: &Limits) -> Result<Document<'a>, Error> {
    xml::parse(svg, "the drawing", &Budget::new(limits.for_input(svg.len())))
}

/// Returns `true` for elements that are only drawn by reference.
pub(super) fn is_definition(tag: &str) -> bool {
    const DEFINITIONS: &str =
        "defs clipPath mask symbol pattern marker linearGradient radialGradient filter path-effect perspective";
    DEFINITIONS.split(' ').any(|t| t == tag)
}

/// Returns `true` for elements that Inkscape's tools cannot select.
fn is_locked(n: Node<'_, '_>) -> bool {
    let is_insensitive = |a: &usvg::roxmltree::Attribute<'_, '_>| {
        a.name() == "insensitive" && a.namespace().is_some_and(is_sodipodi) && a.value() == "true"
    };
    let hides = |style: &str| style.split(';').any(|d| d.split_whitespace().collect::<String>() == "display:none");
    n.attributes().any(|a| is_insensitive(&a))
        || n.attribute("display") == Some("none")
        || n.attribute("style").is_some_and(hides)
}

pub(super) use crate::source::elements::{PATHWARP as NAMESPACE, first_by_id as by_id};

/// The recipe, as words of a command line.
pub(super) const RECIPE: &str = "recipe";
/// The package with the source.
pub(super) const SOURCE: &str = "source";
/// A summary of the result's nodes.
pub(super) const NODES: &str = "nodes";
/// Ids of the definitions that the warp added.
pub(super) const MADE: &str = "made";

/// The references in an attribute value, `#NAME`, as ranges of the names.
pub(super) fn references(value: &str) -> impl Iterator<Item = Range<usize>> + '_ {
    value.match_indices('#').map(|(i, _)| {
        let rest = &value[i + 1..];
        let len = rest.find(|c: char| c.is_whitespace() || "\"')#;,".contains(c)).unwrap_or(rest.len());
        i + 1..i + 1 + len
    })
}

/// All names to which an element and its descendants refer.
pub(super) fn referred(n: Node<'_, '_>) -> Vec<String> {
    let values = n.descendants().flat_map(|n| n.attributes()).map(|a| a.value());
    values.flat_map(|v| references(v).map(move |r| v[r].to_owned())).collect()
}

/// Replacements in `text` that rename the ids of an element and its descendants, and references to such ids in them.
pub(super) fn renaming(text: &str, n: Node<'_, '_>, names: &HashMap<String, String>) -> Vec<(Range<usize>, String)> {
    let mut out = Vec::new();
    for a in n.descendants().flat_map(|n| n.attributes()) {
        let range = a.range_value();
        let raw = &text[range.clone()];
        if a.name() == "id" && a.namespace().is_none() {
            if let Some(new) = names.get(raw) {
                out.push((range, new.clone()));
            }
            continue;
        }
        for r in references(raw) {
            if let Some(new) = names.get(&raw[r.clone()]) {
                out.push((range.start + r.start..range.start + r.end, new.clone()));
            }
        }
    }
    out
}

/// Applies replacements. A replacement inside a range that is replaced as a whole is dropped.
pub(super) fn apply(text: &str, mut patches: Vec<(Range<usize>, String)>) -> String {
    // Insertions at one position keep their order and precede a replacement that starts there.
    patches.sort_by_key(|(r, _)| (r.start, !r.is_empty(), std::cmp::Reverse(r.end)));
    splice(text, patches)
}

/// Copies of paths in root user space.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Guides {
    /// Elements, in groups with the transforms around them.
    pub(super) markup: String,
}

impl Guides {
    /// Copies the paths with these ids.
    ///
    /// # Errors
    /// Returns [`Error::Input`] if `svg` is not XML, or takes more work than the limits allow.
    pub fn of(svg: &str, ids: &[String], limits: &Limits) -> Result<Self, Error> {
        let mut out = Self::default();
        if ids.is_empty() {
            return Ok(out);
        }
        let doc = parse(svg, limits)?;
        let found = by_id(&doc);
        for n in ids.iter().filter_map(|id| found.get(id.as_str())) {
            out.markup += &copy(svg, *n);
        }
        Ok(out)
    }

    /// The copies as an SVG file.
    #[must_use]
    pub fn file(&self) -> String {
        format!("<svg xmlns=\"{}\">{}</svg>", SVG, self.markup)
    }
}

/// An element inside groups with the transforms around it.
fn copy(text: &str, n: Node<'_, '_>) -> String {
    let transforms = n.ancestors().skip(1).filter_map(|a| a.attribute("transform"));
    transforms.fold(text[n.range()].to_owned(), |inner, t| format!("<g transform=\"{}\">{inner}</g>", escape(t)))
}
