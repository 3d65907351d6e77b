//! XML text: parsing it, and the escapes for writing it.

use super::precheck;
use memchr::memchr3;
use pathwarp::Error;
use pathwarp::budget::Budget;
use usvg::roxmltree;

/// Parses XML that is known to be within the budget.
pub(super) fn document(text: &str) -> Result<roxmltree::Document<'_>, roxmltree::Error> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    roxmltree::Document::parse_with_options(text, options)
}

/// Parses XML. `name` identifies the text in errors.
pub(crate) fn parse<'a>(text: &'a str, name: &str, budget: &Budget) -> Result<roxmltree::Document<'a>, Error> {
    check(text, name, budget)?;
    parse_checked(text, name)
}

/// Counts the work of parsing.
pub(crate) fn check(text: &str, name: &str, budget: &Budget) -> Result<(), Error> {
    precheck::count(text, budget).map_err(|e| Error::limit(name, "its markup takes", e))
}

/// Parses XML that is known to be within the budget. `name` identifies the text in errors.
pub(crate) fn parse_checked<'a>(text: &'a str, name: &str) -> Result<roxmltree::Document<'a>, Error> {
    document(text).map_err(|e| {
        let at = e.pos();
        Error::input(format!("{name}:{}:{}", at.row, at.col), format!("not well-formed XML: {e}"))
    })
}

/// Escapes text for an attribute value in double quotes. The result is valid as element content, too.
pub(crate) fn escape(text: &str) -> String {
    let bytes = text.as_bytes();
    let has = |a, b, c| memchr3(a, b, c, bytes).is_some();
    if !has(b'&', b'<', b'>') && !has(b'"', b'\n', b'\r') && !bytes.contains(&b'\t') {
        return text.to_owned();
    }
    escaped(text, true)
}

/// Escapes text for element content, in which quotes, tabs and line breaks stay as they are.
pub(crate) fn escape_content(text: &str) -> String {
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
