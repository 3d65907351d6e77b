//! The declarations that apply to an element, weakest first (CSS Cascade 5).

use super::element::{self, Looks};
use super::sheet::{Declaration, Rules};
use roxmltree::Node;
use selectors::context::SelectorCaches;

/// Bytes of a value that are computed in the time of a comparison.
const COMPUTED: usize = 8;

/// Comparisons that can be made in the time of storing a custom property.
const REMEMBERED: usize = 8;

/// Estimates the work of computing a value, in comparisons.
pub(super) fn work(value: &str) -> usize {
    1 + value.len() / COMPUTED
}

/// Lists the declarations of rules and of the style attribute, `own`, that apply to an element, weakest first.
pub(super) fn applying<'r, 'a>(
    rules: &'r Rules<'a>,
    own: &'r [Declaration<'a>],
    node: Node<'_, '_>,
    looks: &Looks,
    caches: &mut SelectorCaches,
) -> Vec<&'r Declaration<'a>> {
    let mut all = Vec::new();
    if !rules.is_empty() {
        let mut matches = element::matcher(node, looks, caches);
        for candidate in rules.candidates(node.tag_name().name(), node.attribute("id"), node.attribute("class")) {
            let Some((selector, order)) = rules.selectors.get(candidate).filter(|s| matches(&s.0)) else { continue };
            let block = &rules.blocks[*order];
            let variable = |d: &Declaration<'_>| if d.name.starts_with("--") { REMEMBERED } else { 0 };
            looks.add(block.declarations.iter().map(|d| variable(d) + work(&d.value)).sum());
            for d in &block.declarations {
                // Importance turns the order of layers around.
                let layer = if d.important { usize::MAX - block.layer } else { block.layer };
                all.push(((d.important, false, layer, selector.specificity(), *order), d));
            }
        }
    }
    all.extend(own.iter().map(|d| ((d.important, true, 0, 0, 0), d)));
    // The sort is stable: of equals, the later declaration is stronger.
    all.sort_by_key(|(strength, _)| *strength);
    all.into_iter().map(|(_, d)| d).collect()
}
