//! The declarations that apply to an element, weakest first (CSS Cascade 5).

use super::element::{self, Looks};
use super::sheet::{Declaration, Rules, declarations};
use selectors::context::SelectorCaches;
use usvg::roxmltree::Node;

/// Bytes of a value that are computed in the time of a comparison.
const COMPUTED: usize = 8;

/// Comparisons that can be made in the time of storing a custom property.
const REMEMBERED: usize = 8;

/// Estimates the work of computing a value, in comparisons.
pub(super) fn work(value: &str) -> usize {
    1 + value.len() / COMPUTED
}

/// Lists the declarations of rules and of the style attribute that apply to an element, weakest first.
pub(super) fn applying<'a>(
    rules: &'a Rules,
    own: &'a [Declaration],
    node: Node<'_, '_>,
    looks: &Looks,
    caches: &mut SelectorCaches,
) -> Vec<&'a Declaration> {
    let mut all = Vec::new();
    for (order, rule) in rules.rules.iter().enumerate() {
        let Some(specificity) = element::specificity(&rule.selectors, node, looks, caches) else { continue };
        let variable = |d: &Declaration| if d.name.starts_with("--") { REMEMBERED } else { 0 };
        looks.add(rule.declarations.iter().map(|d| variable(d) + work(&d.value)).sum());
        for d in &rule.declarations {
            // Importance turns the order of layers around.
            let layer = if d.important { usize::MAX - rule.layer } else { rule.layer };
            all.push(((d.important, false, layer, specificity, order), d));
        }
    }
    all.extend(own.iter().map(|d| ((d.important, true, 0, 0, 0), d)));
    // The sort is stable: of equals, the later declaration is stronger.
    all.sort_by_key(|(strength, _)| *strength);
    all.into_iter().map(|(_, d)| d).collect()
}

/// The declarations of an element's style attribute.
pub(super) fn own(node: Node<'_, '_>) -> Vec<Declaration> {
    node.attribute("style").map_or_else(Vec::new, declarations)
}
