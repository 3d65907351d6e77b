//! Preserves the style of an edited drawing: where rules of its sheets match other elements than before, style attributes override them.

use crate::computed::{MARKERS, is_valid};
use crate::element::{ComparisonCounter, applying};
use crate::ids::Ids;
use crate::rewrite::ReadError;
use crate::sheet::{Declaration, declarations};
use crate::table::attribute_property;
use crate::tree::{root_units, rules};
use crate::xml::{self, escape, name_end};
use pathwarp::budget::Budget;
use roxmltree::Node;
use selectors::context::SelectorCaches;
use std::collections::{BTreeSet, HashMap};

/// Adds declarations to an edited drawing so that its style sheets give no element a value that it did not have before.
///
/// `kept` pairs the offsets at which an element begins in the original and in the edited text.
/// All other elements are new, and their attributes alone decide their style. Returns `None` if there is nothing to add.
///
/// # Errors
/// [`ReadError::Xml`] when one of the texts is not XML; [`ReadError::Limit`] when its style takes more work than the budget allows.
pub fn guarded(
    before: &str,
    after: &str,
    kept: &[(usize, usize)],
    budget: &Budget,
) -> Result<Option<String>, ReadError> {
    let (old_doc, new_doc) =
        (xml::document(before).map_err(ReadError::Xml)?, xml::document(after).map_err(ReadError::Xml)?);
    let (old_nodes, new_nodes) = (xml::elements(&old_doc), xml::elements(&new_doc));
    let (old_rules, _) = rules(&old_nodes, budget)?;
    let (new_rules, _) = rules(&new_nodes, budget)?;
    if new_rules.is_empty() {
        return Ok(None);
    }
    let counter = ComparisonCounter::new(budget);
    // The validity of a length does not depend on the font's size, so the root's units serve for all elements.
    let (units, ids) = (root_units(&old_doc), Ids::new(&old_doc));
    let is_valid = |d: &Declaration<'_>| is_valid(d, units, &ids);
    let (mut old_caches, mut new_caches) = (SelectorCaches::default(), SelectorCaches::default());
    let starts: HashMap<usize, Node<'_, '_>> = old_nodes.iter().map(|n| (n.range().start, *n)).collect();
    let origins: HashMap<usize, usize> = kept.iter().map(|(from, to)| (*to, *from)).collect();
    let mut out = String::new();
    let mut copied_to = 0;
    for node in new_nodes {
        let origin = origins.get(&node.range().start).and_then(|start| starts.get(start)).copied();
        let old_inline = declarations(origin.and_then(|n| n.attribute("style")).unwrap_or_default());
        let new_inline = declarations(node.attribute("style").unwrap_or_default());
        let old_by_rules = origin.map_or_else(Vec::new, |n| applying(&old_rules, &[], n, &counter, &mut old_caches));
        let new_by_rules = applying(&new_rules, &[], node, &counter, &mut new_caches);
        if counter.exceeded() {
            break;
        }
        if old_by_rules == new_by_rules {
            continue;
        }
        let old = [&old_by_rules, &old_inline.iter().collect()];
        let new = [&new_by_rules, &new_inline.iter().collect()];
        let added = corrections(node, old, new, &is_valid);
        if added.is_empty() {
            continue;
        }
        let (range, value) = match node.attribute_node("style") {
            Some(a) => {
                let is_closed = a.value().trim_end().ends_with(';') || new_inline.is_empty();
                (a.range_value(), format!("{}{}{added}", escape(a.value()), if is_closed { "" } else { ";" }))
            }
            None => {
                let end = name_end(after, node);
                (end..end, format!(" style=\"{added}\""))
            }
        };
        out.push_str(&after[copied_to..range.start]);
        out.push_str(&value);
        copied_to = range.end;
    }
    counter.spend(budget)?;
    out.push_str(&after[copied_to..]);
    Ok((copied_to > 0).then_some(out))
}

/// Computes the declarations that restore an element's style, as the text of an attribute. `old` and `new` list the declarations of
/// the rules that apply, weakest first, and those of the style attribute. Invalid ones do not count.
fn corrections(
    node: Node<'_, '_>,
    old: [&Vec<&Declaration<'_>>; 2],
    new: [&Vec<&Declaration<'_>>; 2],
    is_valid: &dyn Fn(&Declaration<'_>) -> bool,
) -> String {
    let names = old[0].iter().chain(new[0]).flat_map(|d| match d.name.as_ref() {
        "marker" => MARKERS.to_vec(),
        name => vec![name],
    });
    let names: BTreeSet<&str> = names.filter(|name| !name.starts_with("--")).collect();
    let mut out = Vec::new();
    for name in names {
        let last_valid = |all: &[&Declaration<'_>]| {
            let sets = |d: &&&Declaration<'_>| d.name == name || (d.name == "marker" && MARKERS.contains(&name));
            all.iter().rev().filter(sets).find(|d| is_valid(d)).map(|d| (d.value.to_string(), d.important))
        };
        let winner = |[rules, inline]: [&Vec<&Declaration<'_>>; 2]| match (last_valid(rules), last_valid(inline)) {
            (Some(rule), Some(inline)) => Some(if rule.1 && !inline.1 { rule } else { inline }),
            (rule, inline) => inline.or(rule),
        };
        let (old_inline, new_inline) = (last_valid(old[1]), last_valid(new[1]));
        // A value that the edit sets counts; otherwise the element keeps the value that it had.
        let wanted = match new_inline {
            Some(inline) if old_inline.is_none_or(|old| old.0 != inline.0) => Some(inline.0),
            _ => winner(old).map(|w| w.0),
        };
        if winner(new).map(|w| w.0) == wanted {
            continue;
        }
        let value = wanted.or_else(|| from_attribute(node, name)).unwrap_or_else(|| "unset".to_owned());
        let important = if last_valid(new[0]).is_some_and(|rule| rule.1) { "!important" } else { "" };
        out.push(format!("{name}:{value}{important}"));
    }
    escape(&out.join(";"))
}

/// Converts the value of an attribute to CSS.
fn from_attribute(node: Node<'_, '_>, name: &str) -> Option<String> {
    let value = node.attribute(name)?.trim();
    match name {
        "d" if node.tag_name().name() == "path" => Some(format!("path('{value}')")),
        "transform" => {
            let m: svgtypes::Transform = value.parse().ok()?;
            Some(format!("matrix({},{},{},{},{},{})", m.a, m.b, m.c, m.d, m.e, m.f))
        }
        "x" | "y" | "width" | "height" | "r" | "rx" | "ry" | "cx" | "cy"
            if value.ends_with(|c: char| c.is_ascii_digit()) =>
        {
            Some(format!("{value}px"))
        }
        _ => attribute_property(name).map(|_| value.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mended(css: &str, before: &str, after: &str, kept: &[(&str, &str)]) -> String {
        let drawing = |body: &str| format!("<svg xmlns='http://www.w3.org/2000/svg'><style>{css}</style>{body}</svg>");
        let (before, after) = (drawing(before), drawing(after));
        let kept: Vec<_> = kept.iter().map(|(was, is)| (before.find(was).unwrap(), after.find(is).unwrap())).collect();
        let out = guarded(&before, &after, &kept, &Budget::default()).unwrap().unwrap_or_else(|| after.clone());
        out.split_once("</style>").unwrap().1.strip_suffix("</svg>").unwrap().to_owned()
    }

    #[test]
    fn rules_do_not_hit_new_elements() {
        let new = "<g><path fill='red' style='opacity:.5'/></g>";
        assert_eq!(mended("rect{fill:blue}", "", new, &[]), new);
        let css = "path{fill:blue;opacity:1;stroke:red!important}*{transform:scale(2)}";
        assert_eq!(
            mended(css, "", "<g transform='translate(1 2)'/><path fill='red' style='opacity:.5'/>", &[]),
            "<g style=\"transform:matrix(1,0,0,1,1,2)\" transform='translate(1 2)'/>\
         <path fill='red' style='opacity:.5;fill:red;stroke:unset!important;transform:unset'/>"
        );
    }

    #[test]
    fn renamed_elements_look_as_before() {
        let css = "circle{fill:teal;marker:none}path{fill:red;stroke:blue}";
        assert_eq!(
            mended(css, "<circle/>", "<path/>", &[("<circle", "<path")]),
            "<path style=\"fill:teal;marker-end:none;marker-mid:none;marker-start:none;stroke:unset\"/>"
        );
        // Declarations of the edit count; others stay.
        assert_eq!(
            mended(css, "<circle style='fill:red'/>", "<path style='fill:gold'/>", &[("<circle", "<path")])
                .matches("fill:gold")
                .count(),
            1
        );
        assert_eq!(mended("g{fill:red}", "<g/>", "<g/>", &[("<g/>", "<g/>")]), "<g/>");
    }

    /// Browsers take the last valid declaration.
    #[test]
    fn invalid_declarations_do_not_count() {
        let css = "circle{fill:teal;fill:nonsense;stroke:rgb(1,2)}";
        assert_eq!(mended(css, "<circle/>", "<g/>", &[("<circle", "<g")]), "<g style=\"fill:teal\"/>");
        assert_eq!(
            mended(css, "<circle style='fill:5'/>", "<g style='fill:5'/>", &[("<circle", "<g")])
                .matches("fill:teal")
                .count(),
            1
        );
    }

    #[test]
    fn positions_among_siblings() {
        let css = ".a:nth-child(3){fill:red}";
        let (before, after) = ("<g/><path class='a'/>", "<title/><g/><path class='a'/>");
        let kept = [("<g/>", "<g/>"), ("<path", "<path")];
        assert_eq!(mended(css, before, after, &kept), after.replace("<path", "<path style=\"fill:red\""));
    }
}
