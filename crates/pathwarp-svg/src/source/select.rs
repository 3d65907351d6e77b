//! Selects parts of a drawing by selectors, exclusions, guides, and names.

use super::elements::ElementId;
use super::text::SourceText;
use std::borrow::Cow;
use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

/// The part of a document to warp. By default, everything.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Selection {
    /// Elements to warp with all they contain, each as `#id`, `.class`, `tag` or a name: id, Inkscape label, title, or the position of an
    /// element without an id as in reports, such as `path at 12:5`. `[id=ID]` matches the id alone. If empty, everything is selected.
    pub select: Vec<String>,
    /// Elements to leave unchanged with all they contain, in the same form.
    pub exclude: Vec<String>,
    /// Names of cages, bases and targets. They are left unchanged and do not count as artwork.
    pub guides: Vec<String>,
    /// A set of elements from [`Document::divide`](crate::Document::divide), which replaces `select` and `exclude`.
    pub part: Option<Elements>,
}

/// A set of a document's elements.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Elements(Arc<[bool]>);

/// A part of a document whose elements belong to an equal subset of several selections.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Division {
    /// The indices of the selections in that subset.
    pub among: Vec<usize>,
    /// The part.
    pub selection: Selection,
}

/// Divides a document by selections. Elements in none of them belong to no part.
pub(crate) fn divide(source: &SourceText, selections: &[Selection]) -> Vec<Division> {
    let each: Vec<Vec<bool>> = selections.iter().map(|s| s.resolve(source)).collect();
    let among = |e: ElementId| -> Vec<usize> { (0..each.len()).filter(|&i| each[i][e]).collect() };
    let mut parts: BTreeMap<Vec<usize>, Vec<bool>> = BTreeMap::new();
    for e in 0..source.elements.len() {
        let among = among(e);
        if !among.is_empty() {
            parts.entry(among).or_insert_with(|| vec![false; source.elements.len()])[e] = true;
        }
    }
    let guides = selections.first().map(|s| s.guides.clone()).unwrap_or_default();
    let selection = |elements: Vec<bool>| Selection {
        guides: guides.clone(),
        part: Some(Elements(elements.into())),
        ..Selection::default()
    };
    parts.into_iter().map(|(among, elements)| Division { among, selection: selection(elements) }).collect()
}

impl Selection {
    /// Returns `true` if everything is selected.
    #[must_use]
    pub fn is_everything(&self) -> bool {
        self.part.is_none() && self.select.is_empty() && self.exclude.is_empty() && self.guides.is_empty()
    }

    /// The union of selections, with the guides of the last.
    pub(crate) fn union<'a>(source: &SourceText, all: impl Iterator<Item = &'a Self>) -> Self {
        let mut sum = Self { part: Some(Elements(vec![false; source.elements.len()].into())), ..Self::default() };
        for one in all {
            let elements = std::iter::zip(sum.resolve(source), one.resolve(source)).map(|(a, b)| a || b).collect();
            sum = Self { guides: one.guides.clone(), part: Some(Elements(elements)), ..sum };
        }
        sum
    }

    /// For every element, `true` if it is selected.
    pub(crate) fn resolve(&self, source: &SourceText) -> Vec<bool> {
        if let Some(Elements(part)) = &self.part {
            return part.to_vec();
        }
        let hits = |list: &[String], e: ElementId| list.iter().any(|s| matches(source, e, s));
        let mut selected = Vec::with_capacity(source.elements.len());
        let mut excluded: Vec<bool> = Vec::with_capacity(source.elements.len());
        for (e, el) in source.elements.iter().enumerate() {
            // In document order, parents precede their children.
            let is_in = |set: &[bool]| el.parent.is_some_and(|p| set[p]);
            selected.push(is_in(&selected) || self.select.is_empty() || hits(&self.select, e));
            let is_guide = || e > 0 && self.guides.iter().any(|g| is_named(source, e, g));
            excluded.push(is_in(&excluded) || hits(&self.exclude, e) || is_guide());
        }
        selected.iter().zip(&excluded).map(|(s, x)| *s && !*x).collect()
    }
}

/// Returns `true` if a selector matches an element.
pub(crate) fn matches_any(source: &SourceText, selector: &str) -> bool {
    (0..source.elements.len()).any(|e| matches(source, e, selector))
}

/// The names that selectors of this kind can match, in document order: classes for `.class`, otherwise ids, labels and titles.
pub(crate) fn candidates(source: &SourceText, selector: &str) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    for e in 0..source.elements.len() {
        if selector.starts_with('.') {
            let classes = source.attr(e, "class").unwrap_or_default();
            out.extend(classes.split_ascii_whitespace().map(|c| format!(".{c}")));
        } else {
            let mark = if selector.starts_with('#') { "#" } else { "" };
            let title = source.elements[e].title.as_deref().map(Cow::Borrowed);
            let names = [source.attr(e, "id"), source.label(e), title].into_iter().flatten();
            out.extend(names.filter(|n| !n.trim().is_empty()).map(|n| format!("{mark}{n}")));
        }
    }
    let mut seen = HashSet::new();
    out.retain(|n| seen.insert(n.clone()));
    out
}

/// Returns `true` if a selector matches an element.
fn matches(source: &SourceText, e: ElementId, selector: &str) -> bool {
    if let Some(id) = selector.strip_prefix("[id=").and_then(|s| s.strip_suffix(']')) {
        return source.attr(e, "id").is_some_and(|v| v == id);
    }
    match selector.split_at_checked(1) {
        Some(("#", name)) => is_named(source, e, name),
        Some((".", class)) => source.attr(e, "class").is_some_and(|c| c.split_ascii_whitespace().any(|c| c == class)),
        _ => {
            let by_position = || selector.contains(" at ") && source.display_name(e) == selector;
            source.elements[e].tag == selector || is_named(source, e, selector) || by_position()
        }
    }
}

/// Returns `true` if an element's id, Inkscape label or title is `name`.
pub(crate) fn is_named(source: &SourceText, e: ElementId, name: &str) -> bool {
    let name = name.strip_prefix('#').unwrap_or(name);
    source.attr(e, "id").is_some_and(|v| v == name)
        || source.label(e).is_some_and(|v| v == name)
        || source.elements[e].title.as_deref() == Some(name)
}
