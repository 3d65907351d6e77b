//! Text that `tref` elements show again.

use pathwarp::budget::{Budget, Exceeded, Limit};
use std::collections::{HashMap, HashSet};
use usvg::roxmltree::{Document, Node};

/// Letters of the elements that `tref` elements refer to, by id.
#[derive(Default)]
pub(super) struct Quoted<'a>(HashMap<&'a str, u64>);

impl<'a> Quoted<'a> {
    /// Finds the letters of a drawing. usvg looks at all elements for each reference.
    pub(super) fn of(doc: &'a Document<'_>, budget: &Budget) -> Result<Self, Exceeded> {
        let references = || doc.descendants().filter(|n| n.tag_name().name() == "tref").flat_map(links);
        let wanted: HashSet<&str> = references().collect();
        if wanted.is_empty() {
            return Ok(Self::default());
        }
        let all = doc.descendants().count();
        budget.spend(Limit::Comparisons, references().count().saturating_mul(all) as u64)?;
        let mut out = HashMap::new();
        for n in doc.descendants() {
            if let Some(id) = n.attribute("id").filter(|id| wanted.contains(id)) {
                out.entry(id).or_insert_with(|| n.descendants().map(letters).sum());
            }
        }
        Ok(Self(out))
    }

    /// The letters that an element shows again.
    pub(super) fn letters(&self, n: Node<'_, '_>) -> u64 {
        if self.0.is_empty() || n.tag_name().name() != "tref" {
            return 0;
        }
        links(n).filter_map(|id| self.0.get(id)).max().copied().unwrap_or(0)
    }
}

/// The ids that an element refers to, by a link with or without a namespace.
fn links<'a>(n: Node<'a, '_>) -> impl Iterator<Item = &'a str> {
    let values = n.attributes().filter(|a| a.name() == "href").map(|a| a.value());
    values.filter_map(|v| v.trim().strip_prefix('#'))
}

/// The letters of a piece of text; none of an element.
pub(super) fn letters(n: Node<'_, '_>) -> u64 {
    n.text().filter(|_| n.is_text()).map_or(0, |t| t.chars().count()) as u64
}
