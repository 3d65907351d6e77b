//! Facts about a drawing's structure that warping must preserve.

use std::collections::BTreeMap;
use usvg::roxmltree::{Document, Node, ParsingOptions};

/// Counts ids, classes and titles, each with the id of the nearest enclosing element. `None` if the text is not XML.
pub(super) fn facts(text: &str) -> Option<BTreeMap<String, usize>> {
    let options = ParsingOptions { allow_dtd: true, ..Default::default() };
    let document = Document::parse_with_options(text, options).ok()?;
    let mut facts = BTreeMap::new();
    let mut add = |fact: String| *facts.entry(fact).or_insert(0_usize) += 1;
    for e in document.descendants().filter(Node::is_element) {
        let outer = e.ancestors().skip(1).find_map(|o| o.attribute("id")).unwrap_or("");
        if let Some(id) = e.attribute("id") {
            add(format!("#{id} in #{outer}"));
        }
        for class in e.attribute("class").unwrap_or("").split_whitespace() {
            add(format!(".{class} in #{outer}"));
        }
        if e.tag_name().name() == "title" {
            add(format!("title {} in #{outer}", e.text().unwrap_or("").trim()));
        }
    }
    Some(facts)
}
