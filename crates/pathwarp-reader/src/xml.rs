//! XML text: parsing it, and the escapes for writing it.

use super::precheck;
use memchr::memchr3;
use pathwarp::Error;
use pathwarp::budget::Budget;

/// Parses XML that is known to be within the budget.
///
/// # Errors
/// It is not well-formed.
pub fn document(text: &str) -> Result<roxmltree::Document<'_>, roxmltree::Error> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    roxmltree::Document::parse_with_options(text, options)
}

/// Parses XML. `name` identifies the text in errors.
///
/// # Errors
/// It is not well-formed, or takes more than the budget allows.
pub fn parse<'a>(text: &'a str, name: &str, budget: &Budget) -> Result<roxmltree::Document<'a>, Error> {
    check(text, name, budget)?;
    parse_checked(text, name)
}

/// Counts the work of parsing.
///
/// # Errors
/// It exceeds the budget.
pub fn check(text: &str, name: &str, budget: &Budget) -> Result<(), Error> {
    precheck::count(text, budget).map_err(|e| Error::limit(name, "its markup takes", e))
}

/// Parses XML that is known to be within the budget. `name` identifies the text in errors.
///
/// # Errors
/// It is not well-formed.
pub fn parse_checked<'a>(text: &'a str, name: &str) -> Result<roxmltree::Document<'a>, Error> {
    document(text).map_err(|e| {
        let at = e.pos();
        Error::input(format!("{name}:{}:{}", at.row, at.col), format!("not well-formed XML: {e}"))
    })
}

/// Writes the elements that entities hold in their places. `None` if there are none.
pub(super) fn with_elements_of_entities(text: &str) -> Option<String> {
    let entities = precheck::declared(text);
    // The subset of the DTD ends with a bracket.
    let start = text.find("]").filter(|_| entities.iter().any(|(_, v)| v.contains('<')))?;
    let mut out = text[..start].to_owned();
    let mut left: Vec<(&str, usize)> = vec![(&text[start..], 0)];
    while let Some((part, level)) = left.pop() {
        let Some((before, name, after)) = reference(part) else {
            out.push_str(part);
            continue;
        };
        out.push_str(before);
        left.push((after, level));
        match entities.iter().find(|e| e.0 == name).filter(|_| level < precheck::LEVELS) {
            Some((_, value)) => left.push((value, level + 1)),
            None => {
                out.push('&');
                out.push_str(name);
                out.push(';');
            }
        }
    }
    Some(out)
}

/// The first reference to an entity, with the text before and after it.
fn reference(text: &str) -> Option<(&str, &str, &str)> {
    let (before, rest) = text.split_once('&')?;
    let (name, after) = rest.split_once(';')?;
    Some((before, name, after))
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
