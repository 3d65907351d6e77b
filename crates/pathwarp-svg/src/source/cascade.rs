//! Which elements a property is declared on, by attribute, style sheet or style attribute, as the cascade of CSS says.

use crate::source::edit::declared;
use crate::source::text::{ElementId, Source};
use simplecss::{AttributeOperator, PseudoClass, StyleSheet};

/// The value that `property` has on every element for which anything declares one. (Nothing is inherited here.)
pub(crate) fn values(source: &Source, property: &'static str) -> Vec<Option<String>> {
    let sheet = StyleSheet::parse(&source.css);
    // In the order of the cascade: the later wins, and what is important wins over all that is not.
    let said = |important: bool| {
        let rules = sheet.rules.iter().flat_map(|r| r.declarations.iter().map(move |d| (&r.selector, d)));
        rules.filter(move |(_, d)| d.name == property && d.important == important)
    };
    let one = |e: ElementId| {
        let node = Node { source, e };
        let own = source.attr(e, "style").and_then(|s| declared(&s, property).map(ToOwned::to_owned));
        let (own, strong) = match own {
            Some(v) => match v.split_once('!') {
                Some((v, _)) => (Some(v.trim().to_owned()), true),
                None => (Some(v), false),
            },
            None => (None, false),
        };
        let sheets = |important| {
            let mut matching = said(important).filter(|(s, _)| s.matches(&node));
            matching.next_back().map(|(_, d)| d.value.to_owned())
        };
        own.clone()
            .filter(|_| strong)
            .or_else(|| sheets(true))
            .or(own)
            .or_else(|| sheets(false))
            .or_else(|| source.attr(e, property).map(|v| v.trim().to_owned()))
    };
    (0..source.elements.len()).map(one).collect()
}

/// An element as selectors see it.
#[derive(Clone, Copy)]
struct Node<'a> {
    source: &'a Source,
    e: ElementId,
}

impl simplecss::Element for Node<'_> {
    fn parent_element(&self) -> Option<Self> {
        self.source.elements.get(self.e)?.parent.map(|e| Self { e, ..*self })
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        let parent = self.source.elements.get(self.e)?.parent?;
        let before = self.e.checked_sub(1).filter(|&b| b > parent)?;
        let sibling = self.source.ancestors(before).find(|&a| self.source.elements[a].parent == Some(parent))?;
        Some(Self { e: sibling, ..*self })
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.source.elements.get(self.e).is_some_and(|e| e.tag == name)
    }

    fn attribute_matches(&self, name: &str, operator: AttributeOperator<'_>) -> bool {
        self.source.attr(self.e, name).is_some_and(|v| operator.matches(&v))
    }

    fn pseudo_class_matches(&self, class: PseudoClass<'_>) -> bool {
        matches!(class, PseudoClass::FirstChild) && self.prev_sibling_element().is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the rules of CSS 2.1, section 6.4: importance, then origin, then specificity, then order.
    #[test]
    fn the_strongest_declaration_wins() {
        let css = ".k{x:class} rect{x:type} #i{x:id} circle{x:strong!important} g > path{x:child} line + line{x:next}";
        let body = "<rect/><rect class='k'/><rect id='i' class='k'/><rect style='x:style' id='i'/><circle style='x:style'/>\
                    <circle style='x:style!important'/><g><path/></g><path x='attribute'/><path/><line/><line/>\
                    <rect x='attribute'/>";
        let text = format!("<svg xmlns='http://www.w3.org/2000/svg'><style>{css}</style>{body}</svg>");
        let found = values(&Source::parse(text, "t").unwrap(), "x");
        let found: Vec<&str> = found.iter().skip(2).map(|v| v.as_deref().unwrap_or("-")).collect();
        let wanted =
            ["type", "class", "id", "style", "strong", "style", "-", "child", "attribute", "-", "-", "next", "type"];
        assert_eq!(found, wanted);
    }
}
