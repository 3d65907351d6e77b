//! The declarations that apply to an element, weakest first (CSS Cascade 5).

use super::element::{self, Looks};
use super::sheet::{Declaration, Rules, declarations};
use selectors::context::SelectorCaches;
use usvg::roxmltree::Node;

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
        looks.add(rule.declarations.len());
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
