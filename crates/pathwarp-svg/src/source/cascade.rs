//! Values of a property by the cascade of CSS: attribute, style sheet, style attribute.
//!
//! It serves properties that usvg does not resolve (`vector-effect`), so it follows CSS: importance, then specificity, then
//! order. The cascade in `unfold` must predict usvg and therefore follows usvg's rules.

use super::style::declared;
use super::tags::ElementId;
use super::text::SourceText;
use simplecss::{AttributeOperator, PseudoClass, StyleSheet};

/// Returns for every element the value declared for `property`. Nothing is inherited.
pub(crate) fn values(source: &SourceText, property: &'static str) -> Vec<Option<String>> {
    let sheet = StyleSheet::parse(&source.css);
    // Rules are sorted by specificity, then order.
    let declarations = |important: bool| {
        let rules = sheet.rules.iter().flat_map(|r| r.declarations.iter().map(move |d| (&r.selector, d)));
        rules.filter(move |(_, d)| d.name == property && d.important == important)
    };
    let value = |e: ElementId| {
        let element = StyledElement { source, e };
        let own = source.attr(e, "style").and_then(|s| declared(&s, property).map(ToOwned::to_owned));
        let (own, important) = match own {
            Some(v) => match v.split_once('!') {
                Some((v, _)) => (Some(v.trim().to_owned()), true),
                None => (Some(v), false),
            },
            None => (None, false),
        };
        let from_sheets = |important| {
            let mut matching = declarations(important).filter(|(s, _)| s.matches(&element));
            matching.next_back().map(|(_, d)| d.value.to_owned())
        };
        own.clone()
            .filter(|_| important)
            .or_else(|| from_sheets(true))
            .or(own)
            .or_else(|| from_sheets(false))
            .or_else(|| source.attr(e, property).map(|v| v.trim().to_owned()))
    };
    (0..source.elements.len()).map(value).collect()
}

/// Element adapter for selectors.
#[derive(Clone, Copy)]
struct StyledElement<'a> {
    source: &'a SourceText,
    e: ElementId,
}

impl simplecss::Element for StyledElement<'_> {
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
        let found = values(&SourceText::parse(text, "t").unwrap(), "x");
        let found: Vec<&str> = found.iter().skip(2).map(|v| v.as_deref().unwrap_or("-")).collect();
        let wanted =
            ["type", "class", "id", "style", "strong", "style", "-", "child", "attribute", "-", "-", "next", "type"];
        assert_eq!(found, wanted);
    }
}
