//! Matches elements against selectors, by the crate `selectors`. Every access is counted, since a selector of many parts can
//! try many combinations of an element's ancestors and siblings.

use crate::names::{AnyPseudoElement, Name, PseudoClass, Svg};
use crate::sheet::{Declaration, Rules};
use pathwarp::budget::{Budget, Exceeded, cost};
use roxmltree::Node;
use selectors::OpaqueElement;
use selectors::attr::{AttrSelectorOperation, CaseSensitivity, NamespaceConstraint};
use selectors::bloom::BloomFilter;
use selectors::context::{
    MatchingContext, MatchingForInvalidation, MatchingMode, NeedsSelectorFlags, QuirksMode, SelectorCaches,
};
use selectors::matching::{ElementSelectorFlags, matches_selector};
use selectors::parser::Selector;
use std::cell::Cell;

/// Bytes of an attribute's value that take as long to read as one comparison.
const VALUE_BYTES: usize = 32;

/// Attributes that take as long to search as one comparison.
const ATTRIBUTES: usize = 64;

/// Cost of trying a selector, in comparisons.
const SELECTOR: usize = 2;

/// Counts the comparisons of matching, up to a limit.
pub(super) struct ComparisonCounter {
    done: Cell<u64>,
    max: f64,
}

impl ComparisonCounter {
    pub(super) fn new(budget: &Budget) -> Self {
        Self { done: Cell::new(0), max: budget.left() / cost::COMPARISON }
    }

    /// Charges the budget for all comparisons so far.
    pub(super) fn spend(&self, budget: &Budget) -> Result<(), Exceeded> {
        budget.spend(cost::COMPARISON * self.done.get() as f64)
    }

    /// Adds comparisons. Returns `false` if matching has to stop.
    pub(super) fn add(&self, comparisons: usize) -> bool {
        self.done.set(self.done.get().saturating_add(comparisons as u64));
        !self.exceeded()
    }

    pub(super) fn exceeded(&self) -> bool {
        self.done.get() as f64 > self.max
    }
}

/// An element that counts accesses, and appears to have no neighbours once the limit is exceeded.
#[derive(Clone, Copy)]
struct Counted<'a, 'b, 'i> {
    node: Node<'b, 'i>,
    counter: &'a ComparisonCounter,
}

impl std::fmt::Debug for Counted<'_, '_, '_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.node.fmt(f)
    }
}

impl<'b, 'i> Counted<'_, 'b, 'i> {
    fn neighbour(self, find: impl FnOnce(&Node<'b, 'i>) -> Option<Node<'b, 'i>>) -> Option<Self> {
        self.counter.add(1).then(|| find(&self.node)).flatten().map(|node| Self { node, ..self })
    }

    fn attribute(&self, name: &str) -> Option<&'b str> {
        let value = self.node.attribute(name);
        let comparisons = 1 + value.map_or(0, str::len) / VALUE_BYTES + self.node.attributes().len() / ATTRIBUTES;
        value.filter(|_| self.counter.add(comparisons))
    }
}

impl selectors::Element for Counted<'_, '_, '_> {
    type Impl = Svg;

    fn opaque(&self) -> OpaqueElement {
        // The address of its first byte identifies an element.
        let text = self.node.document().input_text().as_bytes();
        OpaqueElement::new(text.get(self.node.range().start).unwrap_or(&0))
    }

    fn parent_element(&self) -> Option<Self> {
        self.neighbour(Node::parent_element)
    }

    fn parent_node_is_shadow_root(&self) -> bool {
        false
    }

    fn containing_shadow_host(&self) -> Option<Self> {
        None
    }

    fn is_pseudo_element(&self) -> bool {
        false
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        self.neighbour(Node::prev_sibling_element)
    }

    fn next_sibling_element(&self) -> Option<Self> {
        self.neighbour(Node::next_sibling_element)
    }

    fn first_element_child(&self) -> Option<Self> {
        self.neighbour(Node::first_element_child)
    }

    fn is_html_element_in_html_document(&self) -> bool {
        false
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.counter.add(1) && self.node.tag_name().name() == name
    }

    fn has_namespace(&self, namespace: &str) -> bool {
        self.node.tag_name().namespace().unwrap_or_default() == namespace
    }

    fn is_same_type(&self, other: &Self) -> bool {
        self.node.tag_name() == other.node.tag_name()
    }

    fn attr_matches(
        &self,
        namespace: &NamespaceConstraint<&Name>,
        name: &Name,
        operation: &AttrSelectorOperation<&Name>,
    ) -> bool {
        let name = name.as_ref();
        let matches = |v: &str| self.counter.add(1 + v.len() / VALUE_BYTES) && operation.eval_str(v);
        match namespace {
            NamespaceConstraint::Any => self.node.attributes().filter(|a| a.name() == name).any(|a| matches(a.value())),
            NamespaceConstraint::Specific(uri) if uri.as_ref().is_empty() => {
                self.attribute(name).is_some_and(|value| operation.eval_str(value))
            }
            NamespaceConstraint::Specific(uri) => self.node.attribute((uri.as_ref(), name)).is_some_and(matches),
        }
    }

    fn match_non_ts_pseudo_class(&self, class: &PseudoClass, _: &mut MatchingContext<'_, Svg>) -> bool {
        *class == PseudoClass::Link && self.is_link()
    }

    fn match_pseudo_element(&self, _: &AnyPseudoElement, _: &mut MatchingContext<'_, Svg>) -> bool {
        false
    }

    fn apply_selector_flags(&self, _: ElementSelectorFlags) {}

    fn is_link(&self) -> bool {
        self.node.tag_name().name() == "a"
    }

    fn is_html_slot_element(&self) -> bool {
        false
    }

    fn has_id(&self, id: &Name, case: CaseSensitivity) -> bool {
        self.attribute("id").is_some_and(|v| case.eq(v.as_bytes(), id.as_ref().as_bytes()))
    }

    fn has_class(&self, name: &Name, case: CaseSensitivity) -> bool {
        let classes = self.attribute("class").unwrap_or_default();
        classes.split_ascii_whitespace().any(|c| case.eq(c.as_bytes(), name.as_ref().as_bytes()))
    }

    fn has_custom_state(&self, _: &Name) -> bool {
        false
    }

    fn imported_part(&self, _: &Name) -> Option<Name> {
        None
    }

    fn is_part(&self, _: &Name) -> bool {
        false
    }

    fn is_empty(&self) -> bool {
        !self.node.has_children()
    }

    fn is_root(&self) -> bool {
        self.node.parent_element().is_none()
    }

    fn add_element_unique_hashes(&self, _: &mut BloomFilter) -> bool {
        false
    }
}

/// Cost of storing a custom property, in comparisons.
const CUSTOM_PROPERTY: usize = 8;

/// Estimates the work of computing a value, in comparisons.
pub(super) fn work(value: &str) -> usize {
    const BYTES_PER_COMPARISON: usize = 8;
    1 + value.len() / BYTES_PER_COMPARISON
}

/// Lists the declarations that apply to an element, weakest first: from matching rules, and `inline` from its style attribute.
pub(super) fn applying<'r, 'a>(
    rules: &'r Rules<'a>,
    inline: &'r [Declaration<'a>],
    node: Node<'_, '_>,
    counter: &ComparisonCounter,
    caches: &mut SelectorCaches,
) -> Vec<&'r Declaration<'a>> {
    let mut all = Vec::new();
    if !rules.is_empty() {
        let (mode, quirks, flags) = (MatchingMode::Normal, QuirksMode::NoQuirks, NeedsSelectorFlags::No);
        let mut context = MatchingContext::new(mode, None, caches, quirks, flags, MatchingForInvalidation::No);
        let element = Counted { node, counter };
        let mut matches = |selector: &Selector<Svg>| {
            counter.add(SELECTOR) && matches_selector(selector, 0, None, element, &mut context)
        };
        for candidate in rules.candidates(node.tag_name().name(), node.attribute("id"), node.attribute("class")) {
            let Some((selector, order)) = rules.selectors.get(candidate).filter(|s| matches(&s.0)) else { continue };
            let block = &rules.blocks[*order];
            let variable = |d: &Declaration<'_>| if d.name.starts_with("--") { CUSTOM_PROPERTY } else { 0 };
            counter.add(block.declarations.iter().map(|d| variable(d) + work(&d.value)).sum());
            for d in &block.declarations {
                // `!important` reverses the order of layers.
                let layer = if d.important { usize::MAX - block.layer } else { block.layer };
                all.push(((d.important, false, layer, selector.specificity(), *order), d));
            }
        }
    }
    all.extend(inline.iter().map(|d| ((d.important, true, 0, 0, 0), d)));
    // The sort is stable, so that the later of two equally strong declarations wins.
    all.sort_by_key(|(strength, _)| *strength);
    all.into_iter().map(|(_, d)| d).collect()
}
