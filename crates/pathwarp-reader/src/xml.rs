//! Parses and escapes XML.

use memchr::{memchr, memchr_iter, memchr2_iter, memchr3, memmem};
use pathwarp::Error;
use pathwarp::budget::{Budget, Exceeded, Limit, cost};
use roxmltree::Node;
use std::collections::{HashMap, HashSet};

/// Parses XML that is known to be within the budget.
///
/// # Errors
/// [`roxmltree::Error`] when the text is not well-formed.
pub fn document(text: &str) -> Result<roxmltree::Document<'_>, roxmltree::Error> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    roxmltree::Document::parse_with_options(text, options)
}

/// The elements of a drawing, in document order.
pub(super) fn elements<'a, 'i>(doc: &'a roxmltree::Document<'i>) -> Vec<Node<'a, 'i>> {
    doc.descendants().filter(Node::is_element).collect()
}

/// Parses XML. `name` identifies the text in errors.
///
/// # Errors
/// [`Error::Input`] when the text is not well-formed, or takes more than the budget allows.
pub fn parse<'a>(text: &'a str, name: &str, budget: &Budget) -> Result<roxmltree::Document<'a>, Error> {
    check(text, name, budget)?;
    parse_checked(text, name)
}

/// Charges the budget for parsing.
///
/// # Errors
/// [`Error::Input`] when parsing takes more than the budget allows.
pub fn check(text: &str, name: &str, budget: &Budget) -> Result<(), Error> {
    charge(text, budget).map_err(|e| Error::limit(name, "its markup takes", e))
}

/// Parses XML that is known to be within the budget. `name` identifies the text in errors.
///
/// # Errors
/// [`Error::Input`] when the text is not well-formed.
pub fn parse_checked<'a>(text: &'a str, name: &str) -> Result<roxmltree::Document<'a>, Error> {
    document(text).map_err(|e| {
        let position = e.pos();
        Error::input(format!("{name}:{}:{}", position.row, position.col), format!("not well-formed XML: {e}"))
    })
}

/// Expands the references to entities, so that each element has a range in the text. Returns `None` if no entity holds elements.
#[must_use]
pub fn with_elements_of_entities(text: &str) -> Option<String> {
    let entities = declared(text);
    if !entities.iter().any(|(_, value)| value.contains('<')) {
        return None;
    }
    // The subset of the DTD ends with a bracket.
    let start = text.find(']')?;
    let mut out = text[..start].to_owned();
    // The parts still to expand, the next one last, with the number of entities that each is nested in.
    let mut left: Vec<(&str, usize)> = vec![(&text[start..], 0)];
    while let Some((part, level)) = left.pop() {
        // At the first reference to an entity.
        let split = part.split_once('&').and_then(|(before, rest)| Some((before, rest.split_once(';')?)));
        let Some((before, (name, after))) = split else {
            out.push_str(part);
            continue;
        };
        out.push_str(before);
        left.push((after, level));
        match entities.iter().find(|e| e.0 == name).filter(|_| level < MAX_LEVELS) {
            Some((_, value)) => left.push((value, level + 1)),
            None => out.extend(["&", name, ";"]),
        }
    }
    Some(out)
}

/// The offset behind the name of an element, where attributes can be inserted.
#[must_use]
pub fn name_end(text: &str, node: Node<'_, '_>) -> usize {
    let start = node.range().start + 1;
    text[start..].find(|c: char| c.is_ascii_whitespace() || matches!(c, '/' | '>')).map_or(text.len(), |i| start + i)
}

/// Escapes text for an attribute value in double quotes. The result is valid as element content, too.
#[must_use]
pub fn escape(text: &str) -> String {
    let bytes = text.as_bytes();
    let has = |a, b, c| memchr3(a, b, c, bytes).is_some();
    if !has(b'&', b'<', b'>') && !has(b'"', b'\n', b'\r') && !bytes.contains(&b'\t') {
        return text.to_owned();
    }
    escaped(text, true)
}

/// Escapes text for element content, in which quotes, tabs and line breaks stay as they are.
#[must_use]
pub fn escape_content(text: &str) -> String {
    escaped(text, false)
}

fn escaped(text: &str, in_attribute: bool) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' if in_attribute => out.push_str("&quot;"),
            '\n' if in_attribute => out.push_str("&#10;"),
            '\r' if in_attribute => out.push_str("&#13;"),
            '\t' if in_attribute => out.push_str("&#9;"),
            c => out.push(c),
        }
    }
    out
}

/// Charges the budget for what the parser does with a text.
fn charge(text: &str, budget: &Budget) -> Result<(), Exceeded> {
    tags(text, budget)?;
    entities(text, budget)?;
    namespaces(text, budget)?;
    attributes(text, budget)
}

/// Charges for declarations of namespaces. The parser gives an element with one a copy of all that are in scope, and compares
/// each with the others.
fn namespaces(text: &str, budget: &Budget) -> Result<(), Exceeded> {
    /// Namespaces that are compared in the time of one comparison.
    const PER_COMPARISON: f64 = 3.0;
    /// More namespaces than in any ordinary drawing.
    const FEW: usize = 64;
    let declarations = || memmem::find_iter(text.as_bytes(), "xmlns").map(|i| &text[i + "xmlns".len()..]);
    let all: HashSet<&str> = declarations().filter_map(|rest| rest.split([' ', '>', '/']).next()).collect();
    if all.len() <= FEW {
        return Ok(());
    }
    budget.spend(cost::COMPARISON * declarations().count() as f64 * all.len() as f64 / PER_COMPARISON)
}

/// Bounds the number of elements by the number of tags and comments. Short texts pass: their elements are counted once they are parsed.
fn tags(text: &str, budget: &Budget) -> Result<(), Exceeded> {
    /// Tags per element; more than in any ordinary drawing.
    const PER_ELEMENT: f64 = 8.0;
    const FEW: usize = 10_000;
    let tags = memchr_iter(b'<', text.as_bytes()).count();
    if tags < FEW {
        return Ok(());
    }
    budget.check(Limit::Elements, tags as f64 / PER_ELEMENT).map_err(Exceeded::cut_short)
}

/// Charges for the bytes that entities expand to, and for looking them up.
fn entities(text: &str, budget: &Budget) -> Result<(), Exceeded> {
    let declared = declared(text);
    if declared.is_empty() {
        return Ok(());
    }
    // The parser searches entities in order and takes the first with the name.
    let mut index: HashMap<&str, usize> = HashMap::new();
    for (i, (name, _)) in declared.iter().enumerate() {
        index.entry(name).or_insert(i);
    }
    // Entities may refer to later ones, so sizes grow round by round, up to the depth that the parser allows.
    let mut sizes: Vec<f64> = declared.iter().map(|(_, value)| value.len() as f64).collect();
    for _ in 0..=MAX_LEVELS {
        let next: Vec<f64> = declared.iter().map(|(_, value)| expanded(value, &index, &sizes)).collect();
        if next == sizes {
            break;
        }
        sizes = next;
    }
    let total = expanded(text, &index, &sizes) - text.len() as f64;
    budget.take(Limit::Bytes, total.max(0.0))?;
    let lookups: u64 = references(text).filter_map(|name| index.get(name)).map(|&i| i as u64 + 1).sum();
    budget.spend(cost::COMPARISON * lookups as f64)
}

/// Depth of nested entities that the parser follows.
const MAX_LEVELS: usize = 10;

/// Lists the names and values of the entities that a text declares.
fn declared(text: &str) -> Vec<(&str, &str)> {
    memmem::find_iter(text.as_bytes(), "<!ENTITY").filter_map(|at| declaration(&text[at..])).collect()
}

/// Parses the declaration that a text begins with into name and value.
fn declaration(text: &str) -> Option<(&str, &str)> {
    let rest = text.strip_prefix("<!ENTITY")?.trim_start();
    let (name, rest) = rest.split_once(|c: char| c.is_ascii_whitespace())?;
    let rest = rest.trim_start();
    let quote = rest.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    let rest = &rest[1..];
    Some((name, &rest[..rest.find(quote)?]))
}

/// Lists the names of the entities that a text refers to.
fn references(text: &str) -> impl Iterator<Item = &str> {
    text.split('&').skip(1).filter_map(|rest| Some(rest.split_once(';')?.0))
}

/// The size of a text with its references expanded.
fn expanded(text: &str, index: &HashMap<&str, usize>, sizes: &[f64]) -> f64 {
    let inner = references(text).filter_map(|name| index.get(name)).map(|&i| sizes[i]);
    text.len() as f64 + inner.sum::<f64>()
}

/// Charges for comparing the names of an element's attributes with each other, and likewise the declarations of its style.
fn attributes(text: &str, budget: &Budget) -> Result<(), Exceeded> {
    /// Shorter tags have so few attributes that comparing them takes no time.
    const LONG_TAG: usize = 4096;
    let bytes = text.as_bytes();
    let mut next = 0;
    while let Some(start) = bytes.get(next..).and_then(|b| memchr(b'<', b)).map(|i| next + i) {
        let end = memchr(b'>', &bytes[start..]).map_or(bytes.len(), |i| start + i);
        next = end + 1;
        if end - start >= LONG_TAG {
            let tag = &bytes[start..end];
            let attributes = memchr2_iter(b'"', b'\'', tag).count() as f64 / 2.0;
            let declarations = memchr_iter(b';', tag).count() as f64;
            budget.spend(cost::COMPARISON * (attributes * attributes + declarations * declarations) / 2.0)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::budget::Limits;

    /// The expected sizes are counted by hand.
    #[test]
    fn expansions_are_counted_before_they_happen() {
        let within = |text: &str, bytes: f64| {
            let budget = Budget::new(Limits::default().with(Limit::Bytes, bytes));
            charge(text, &budget).is_ok()
        };
        // 10 bytes in four references, less the references themselves.
        let flat = "<!DOCTYPE s [<!ENTITY a \"aaaaaaaaaa\">]><s>&a;&a;&a;&a;</s>";
        assert!(within(flat, 40.0) && !within(flat, 39.0));
        let mut nested = "<!DOCTYPE s [<!ENTITY a0 'ten bytes.'>".to_owned();
        for i in 1..10 {
            nested += &format!("<!ENTITY a{i} '{}'>", format!("&a{};", i - 1).repeat(10));
        }
        nested += "]><s>&a9;</s>";
        assert!(!within(&nested, 1e10) && within(&nested, 1e12));
        assert!(within("<s>a & b; &lt; &amp;</s>", 1.0));
        assert!(within("<s/>", 0.0));
    }

    #[test]
    fn many_attributes_are_many_comparisons() {
        let tag = |n: usize| format!("<s {}/>", (0..n).map(|i| format!("a{i}=''")).collect::<Vec<_>>().join(" "));
        let within = |text: &str| charge(text, &Budget::default()).is_ok();
        assert!(within(&tag(1000)) && !within(&tag(100_000)));
    }
}
