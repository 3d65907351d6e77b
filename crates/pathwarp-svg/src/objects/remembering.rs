//! Adds to the objects of a result what they were.

use super::guides::Guides;
use super::names::{MADE, NAMESPACE, NODES, RECIPE, SOURCE, referred};
use super::nodes::{by_id, is_definition, parse};
use super::package::{definitions, pack};
use super::patches::apply;
use pathwarp::Error;
use pathwarp::budget::Limits;
use pathwarp_reader::xml::escape;
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;
use usvg::roxmltree::Node;

/// What an object is to remember.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Memory {
    /// Its id, in the source and in the result.
    pub id: String,
    /// The recipe, on one line: editors turn line ends in attributes into spaces.
    pub recipe: String,
    /// The paths that the recipe refers to.
    pub guides: Guides,
    /// A summary of the result's nodes, for finding out later what was done to them by hand.
    pub nodes: String,
}

/// Adds sources and recipes to the objects of `after`, the result of warping `before`. An object that has not changed gets none;
/// what is inside one forgets its own, which lives on in the source around it.
///
/// # Errors
/// Returns [`Error::Input`] if one of the files is not XML, or takes more work than the limits allow.
pub fn remember(before: &str, after: &str, memories: &[Memory], limits: &Limits) -> Result<String, Error> {
    let (old, new) = (parse(before, limits)?, parse(after, limits)?);
    let (olds, news) = (by_id(&old), by_id(&new));
    let mut patches: Vec<(Range<usize>, String)> = Vec::new();
    for m in memories {
        let (Some(&source), Some(&result)) = (olds.get(m.id.as_str()), news.get(m.id.as_str())) else { continue };
        let used = definitions(&olds, source);
        // A group around a clip path that was warped may itself read as before.
        let same_definitions = || definitions(&news, result).iter().all(|d| is_same(before, after, &olds, *d));
        if before[source.range()] == after[result.range()] && same_definitions() {
            continue;
        }
        for n in result.descendants() {
            patches.extend(own_attributes(after, n).map(|r| (r, String::new())));
        }
        let packed = pack(before, source, &used, &m.guides.markup)?;
        let made = made(&olds, &news, result).join(" ");
        let name_end = result.range().start + 1 + qualified(after, result).len();
        let attributes = format!(
            " xmlns:pathwarp=\"{NAMESPACE}\" pathwarp:{RECIPE}=\"{}\" pathwarp:{MADE}=\"{}\" pathwarp:{NODES}=\"{}\" pathwarp:{SOURCE}=\"{packed}\"",
            escape(&m.recipe),
            escape(&made),
            escape(&m.nodes),
        );
        patches.push((name_end..name_end, without_declared(after, result, attributes)));
    }
    Ok(apply(after, patches))
}

/// An element may declare a prefix only once.
fn without_declared(text: &str, n: Node<'_, '_>, attributes: String) -> String {
    let start = n.range().start;
    let tag = &text[start..n.first_child().map_or(n.range().end, |c| c.range().start)];
    if tag.contains(" xmlns:pathwarp=") {
        attributes.replacen(&format!(" xmlns:pathwarp=\"{NAMESPACE}\""), "", 1)
    } else {
        attributes
    }
}

/// The name of an element as written.
fn qualified<'t>(text: &'t str, n: Node<'_, '_>) -> &'t str {
    let rest = &text[n.range().start + 1..];
    &rest[..rest.find(|c: char| c.is_ascii_whitespace() || matches!(c, '/' | '>')).unwrap_or(rest.len())]
}

/// The attributes of ours at an element, each with the space before it.
fn own_attributes(text: &str, n: Node<'_, '_>) -> impl Iterator<Item = Range<usize>> {
    let ours = n.attributes().filter(|a| a.namespace() == Some(NAMESPACE)).map(|a| a.range()).collect::<Vec<_>>();
    ours.into_iter().map(|r| text[..r.start].trim_end().len()..r.end)
}

/// Returns `true` if a definition of the result reads as in the source.
fn is_same(before: &str, after: &str, olds: &HashMap<&str, Node<'_, '_>>, n: Node<'_, '_>) -> bool {
    let old = n.attribute("id").and_then(|id| olds.get(id));
    old.is_some_and(|o| before[o.range()] == after[n.range()])
}

/// Ids of the definitions that a result uses and the source did not have.
fn made(olds: &HashMap<&str, Node<'_, '_>>, news: &HashMap<&str, Node<'_, '_>>, result: Node<'_, '_>) -> Vec<String> {
    let mut found = BTreeSet::new();
    let mut open = referred(result);
    while let Some(name) = open.pop() {
        let Some(n) = news.get(name.as_str()) else { continue };
        let defined = n.ancestors().skip(1).any(|a| is_definition(a.tag_name().name()));
        if defined && !olds.contains_key(name.as_str()) && found.insert(name) {
            open.extend(referred(*n));
        }
    }
    found.into_iter().collect()
}
