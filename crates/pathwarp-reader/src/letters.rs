//! Rewrites the words of a text: in the case that its style asks for, and with marks for its direction.

use super::text::{Letters, separated};
use roxmltree::{Node, NodeId};
use std::collections::HashMap;
use std::ops::Range;

/// New content for a run of characters.
pub(super) struct Rewritten {
    /// Number of elements inside of the text that begin before.
    pub(super) elements: usize,
    pub(super) range: Range<usize>,
    pub(super) text: String,
}

/// A run of characters, before and after.
struct Run<'a> {
    new: Rewritten,
    old: &'a str,
    style: Letters,
}

/// Rewrites a text. `letters` has the style of its elements, its own first. `None` if its direction cannot be set: letters have
/// positions of their own, and marks would count as letters.
pub(super) fn rewritten(text: Node<'_, '_>, letters: &[Letters]) -> Option<Vec<Rewritten>> {
    let mut styles: HashMap<NodeId, Letters> = HashMap::new();
    let mut lines: Vec<Vec<Run<'_>>> = vec![Vec::new()];
    let mut elements = 0;
    let mut before = None;
    let (mut is_marked, mut is_placed) = (false, false);
    for node in text.descendants() {
        if node.is_element() {
            let own = letters.get(elements).copied().unwrap_or_default();
            elements += 1;
            if node == text || is_part(node) && node.parent().is_some_and(|p| styles.contains_key(&p.id())) {
                styles.insert(node.id(), own);
                if begins_line(node) {
                    lines.push(Vec::new());
                }
                is_marked |= own.direction.is_some();
                is_placed |= has_places(node);
            }
            continue;
        }
        let style = node.parent().and_then(|p| styles.get(&p.id())).filter(|_| node.is_text());
        let (Some(&style), Some(old), Some(line)) = (style, node.text(), lines.last_mut()) else { continue };
        let new = Rewritten { elements: elements - 1, range: node.range(), text: style.case.of(old, before) };
        before = old.chars().next_back().or(before);
        line.push(Run { new, old, style });
    }
    if is_marked && is_placed {
        return None;
    }
    if !is_placed {
        lines.iter_mut().for_each(|line| mark(line));
    }
    Some(lines.into_iter().flatten().filter(|r| r.new.text != r.old).map(|r| r.new).collect())
}

/// Sets the direction of a line, separates ligatures, and ends it so that the last letter has its space, too.
fn mark(line: &mut [Run<'_>]) {
    /// Invisible; nothing follows for which it would leave space.
    const END: char = '\u{2060}';
    let is_letter = |c: char| !c.is_whitespace();
    for run in line.iter_mut().filter(|r| r.style.separate) {
        run.new.text = separated(&run.new.text);
    }
    if let Some(last) = line.iter_mut().rfind(|r| r.old.contains(is_letter)).filter(|r| r.style.separate) {
        let at = last.new.text.trim_end().len();
        last.new.text.insert(at, END);
    }
    if let Some(first) = line.iter_mut().find(|r| r.old.contains(is_letter))
        && let (Some(at), Some(direction)) = (first.new.text.find(is_letter), first.style.direction)
    {
        first.new.text.insert(at, direction);
    }
}

fn is_part(node: Node<'_, '_>) -> bool {
    matches!(node.tag_name().name(), "tspan" | "textPath" | "a" | "tref")
}

/// Whether letters of different elements touch: usvg kerns them, and browsers do not.
pub(super) fn joined(text: Node<'_, '_>) -> bool {
    let mut ends = false;
    text.descendants().skip(1).any(|node| {
        if node.is_element() {
            ends &= is_part(node) && !begins_line(node);
            return false;
        }
        let letters = node.text().filter(|_| node.is_text()).unwrap_or_default();
        let joins = ends && letters.starts_with(char::is_alphanumeric);
        ends = letters.ends_with(char::is_alphanumeric);
        joins
    })
}

/// usvg sets text on a path, and text from another place on, as a line of its own.
fn begins_line(node: Node<'_, '_>) -> bool {
    ["x", "y"].iter().any(|a| node.has_attribute(*a)) || node.tag_name().name() == "textPath"
}

/// Returns `true` if single letters are placed or rotated, or `textLength` spreads them.
fn has_places(node: Node<'_, '_>) -> bool {
    let several = |v: &str| v.split([',', ' ', '\n', '\t', '\r']).filter(|n| !n.is_empty()).nth(1).is_some();
    node.has_attribute("textLength")
        || ["x", "y", "dx", "dy", "rotate"].iter().any(|a| node.attribute(*a).is_some_and(several))
}
