//! The work of matching style sheets, measured by doing it once with a counter. A selector of many descendants tries every
//! way to choose them among an element's ancestors, so a few kilobytes can ask for any amount.

use super::sheets::ParsingWork;
use pathwarp::budget::{Budget, Exceeded, Limit};
use simplecss::{AttributeOperator, PseudoClass, StyleSheet};
use std::cell::Cell;
use usvg::roxmltree::{self, Node};

/// Below this product of the lengths of text and style sheets, matching is fast, unless selectors are deep.
const SMALL: usize = 1 << 28;

/// Selectors of at most this many parts are tried in few ways.
const PLAIN: usize = 3;

/// Bytes of an attribute's value, and attributes, that are looked at in the time of a comparison.
const VALUE: usize = 32;
const ATTRIBUTES: usize = 64;

/// Counts the comparisons that parsing and matching a document's style sheets take.
///
/// # Errors
/// They exceed the limit.
pub(crate) fn count(doc: &roxmltree::Document<'_>, budget: &Budget) -> Result<(), Exceeded> {
    let styles = || doc.descendants().filter(|n| n.tag_name().name() == "style");
    let texts = || styles().flat_map(|n| n.children()).filter_map(|c| c.text());
    let mut parsing = ParsingWork::default();
    texts().for_each(|text| parsing.add(text));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "casts saturate")]
    budget.spend(Limit::Comparisons, parsing.steps as u64)?;
    let mut sheet = StyleSheet::new();
    texts().for_each(|text| sheet.parse_more(text));
    let length: usize = texts().map(str::len).sum();
    let deep = || sheet.rules.iter().any(|r| r.selector.to_string().split([' ', '>', '+']).count() > PLAIN);
    if length == 0 || length.saturating_mul(doc.input_text().len()) < SMALL && !deep() {
        return Ok(());
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "casts saturate")]
    let most = budget.left(Limit::Comparisons) as u64;
    let steps = Cell::new(0);
    for node in doc.descendants().filter(Node::is_element) {
        for rule in &sheet.rules {
            steps.set(steps.get() + 1);
            if rule.selector.matches(&Counted { node, steps: &steps, most }) {
                steps.set(steps.get() + rule.declarations.len() as u64);
            }
            if steps.get() > most {
                return budget.spend_cut(Limit::Comparisons, steps.get());
            }
        }
    }
    budget.spend(Limit::Comparisons, steps.get())
}

/// An element that counts where a selector goes from it, and has no neighbours once the limit is exceeded.
struct Counted<'a, 'b, 'i> {
    node: Node<'b, 'i>,
    steps: &'a Cell<u64>,
    most: u64,
}

impl<'a, 'b, 'i> Counted<'a, 'b, 'i> {
    fn go(&self, to: Option<Node<'b, 'i>>) -> Option<Self> {
        self.steps.set(self.steps.get() + 1);
        let node = to.filter(|_| self.steps.get() <= self.most)?;
        Some(Self { node, steps: self.steps, most: self.most })
    }
}

impl simplecss::Element for Counted<'_, '_, '_> {
    fn parent_element(&self) -> Option<Self> {
        self.go(self.node.parent_element())
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        self.go(self.node.prev_sibling_element())
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.node.tag_name().name() == name
    }

    fn attribute_matches(&self, name: &str, operator: AttributeOperator<'_>) -> bool {
        let value = self.node.attribute(name);
        let looked_at = value.map_or(0, str::len) / VALUE + self.node.attributes().len() / ATTRIBUTES;
        self.steps.set(self.steps.get() + looked_at as u64);
        value.is_some_and(|v| operator.matches(v))
    }

    fn pseudo_class_matches(&self, class: PseudoClass<'_>) -> bool {
        matches!(class, PseudoClass::FirstChild) && self.node.prev_sibling_element().is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deep_selectors_end_by_the_limit() {
        let ends = |parts: usize| {
            let (open, close) = ("<g>".repeat(60), "</g>".repeat(60));
            let css = "x ".to_owned() + &"* ".repeat(parts);
            let svg = format!("<svg><style>{css}{{fill:red}}</style>{open}<rect/>{close}</svg>");
            count(&roxmltree::Document::parse(&svg).unwrap(), &Budget::default()).is_err()
        };
        assert!(!ends(2) && ends(20));
    }
}
