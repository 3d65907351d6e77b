//! What part of a drawing is meant: selectors, exclusions, guides, and names.

use crate::source::text::{ElementId, Source};

/// The part of a document that is warped. Empty lists: everything.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Selection {
    /// Only these, each `#id`, `.class`, `tag` or a name (id, Inkscape label or title), with all that is inside.
    pub select: Vec<String>,
    /// Not these, nor what is inside them.
    pub exclude: Vec<String>,
    /// Names of cages, bases and targets: left as they are, and no part of the artwork.
    pub guides: Vec<String>,
}

impl Selection {
    /// Whether everything is meant.
    #[must_use]
    pub fn is_everything(&self) -> bool {
        self.select.is_empty() && self.exclude.is_empty() && self.guides.is_empty()
    }

    /// For every element whether it is meant.
    pub(crate) fn resolve(&self, source: &Source) -> Vec<bool> {
        let hits = |list: &[String], e: ElementId| list.iter().any(|s| matches(source, e, s));
        let mut chosen = Vec::with_capacity(source.elements.len());
        let mut barred: Vec<bool> = Vec::with_capacity(source.elements.len());
        for (e, el) in source.elements.iter().enumerate() {
            // Parents come first in document order.
            let (above, shut) = el.parent.map_or((false, false), |p| (chosen[p], barred[p]));
            chosen.push(above || self.select.is_empty() || hits(&self.select, e));
            barred.push(shut || hits(&self.exclude, e) || e > 0 && self.guides.iter().any(|g| named(source, e, g)));
        }
        chosen.iter().zip(&barred).map(|(c, b)| *c && !*b).collect()
    }
}

fn matches(source: &Source, e: ElementId, selector: &str) -> bool {
    match selector.split_at_checked(1) {
        Some(("#", name)) => named(source, e, name),
        Some((".", class)) => source.attr(e, "class").is_some_and(|c| c.split_ascii_whitespace().any(|c| c == class)),
        _ => source.elements[e].tag == selector || named(source, e, selector),
    }
}

/// Whether the element goes by this name: id, then Inkscape's label, then title.
pub(crate) fn named(source: &Source, e: ElementId, name: &str) -> bool {
    let name = name.strip_prefix('#').unwrap_or(name);
    source.attr(e, "id").is_some_and(|v| v == name)
        || source.label(e).is_some_and(|v| v == name)
        || source.elements[e].title.as_deref() == Some(name)
}
