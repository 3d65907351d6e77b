//! Temporary ids, inserted into the text that usvg reads: its nodes are identified by id.

use super::tags::ElementId;
use std::collections::HashSet;

/// The elements with a temporary id, which is the stem followed by the element's number.
#[derive(Debug, Default, Clone)]
pub(crate) struct Marks {
    pub(crate) stem: String,
    /// In document order.
    pub(crate) elements: Vec<ElementId>,
}

/// Finds a prefix that occurs nowhere in the text.
pub(crate) fn stem(text: &str) -> String {
    let mut stem = "warp-".to_owned();
    while text.contains(&stem) {
        stem.push('x');
    }
    stem
}

/// Collects everything that looks like a reference. False positives do no harm.
pub(crate) fn links(text: &str) -> HashSet<&str> {
    text.match_indices('#')
        .map(|(i, _)| {
            let rest = &text[i + 1..];
            &rest[..rest.find(|c: char| !(c.is_alphanumeric() || "-_.:".contains(c))).unwrap_or(rest.len())]
        })
        .collect()
}
