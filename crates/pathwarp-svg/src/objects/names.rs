//! Names of the attributes, and references between elements.

pub(super) use crate::source::tags::PATHWARP as NAMESPACE;
use std::collections::HashMap;
use std::ops::Range;
use usvg::roxmltree::Node;

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

/// All names that an element and its descendants refer to.
pub(super) fn referred(n: Node<'_, '_>) -> Vec<String> {
    let values = n.descendants().flat_map(|n| n.attributes().map(|a| a.value()).collect::<Vec<_>>());
    values.flat_map(|v| references(v).map(|r| v[r].to_owned()).collect::<Vec<_>>()).collect()
}

/// Replacements in `text` that rename ids, and the references to them, of an element and its descendants.
pub(super) fn renaming(text: &str, n: Node<'_, '_>, names: &HashMap<String, String>) -> Vec<(Range<usize>, String)> {
    let mut out = Vec::new();
    for a in n.descendants().flat_map(|n| n.attributes().collect::<Vec<_>>()) {
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
