//! Files that use an editor's namespace prefix without declaring it, as happens when drawings are put together by hand. Editors
//! know their prefixes by name; an XML parser must be told.

use super::tags::{INKSCAPE, SVG, XLINK};
use std::borrow::Cow;

/// Prefixes as Inkscape reads them.
const KNOWN: [(&str, &str); 8] = [
    ("inkscape", INKSCAPE),
    ("sodipodi", "http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd"),
    ("svg", SVG),
    ("xlink", XLINK),
    ("rdf", "http://www.w3.org/1999/02/22-rdf-syntax-ns#"),
    ("cc", "http://creativecommons.org/ns#"),
    ("dc", "http://purl.org/dc/elements/1.1/"),
    ("xhtml", "http://www.w3.org/1999/xhtml"),
];

/// Declares a prefix in the root element. Returns `None` if the root element cannot be found.
pub(super) fn declared(text: &str, prefix: &str) -> Option<String> {
    let known = KNOWN.iter().find(|k| k.0 == prefix).map(|k| Cow::Borrowed(k.1));
    let uri = known.unwrap_or_else(|| Cow::Owned(format!("urn:undeclared:{prefix}")));
    let at = root_name_end(text)?;
    let (before, after) = text.split_at_checked(at)?;
    Some(format!("{before} xmlns:{prefix}=\"{uri}\"{after}"))
}

/// Position after the name in the first opening tag.
fn root_name_end(text: &str) -> Option<usize> {
    let mut at = 0;
    loop {
        at += text.get(at..)?.find('<')?;
        let rest = text.get(at..)?;
        at += match rest.as_bytes().get(1)? {
            b'?' => rest.find("?>")?,
            b'!' if rest.starts_with("<!--") => rest.find("-->")?,
            b'!' => doctype_end(rest)?,
            _ => return Some(at + rest.find(|c: char| c.is_ascii_whitespace() || matches!(c, '/' | '>'))?),
        };
    }
}

/// Position of the `>` that ends a DOCTYPE with or without a subset.
fn doctype_end(text: &str) -> Option<usize> {
    let close = text.find('>')?;
    match text.find('[').filter(|&open| open < close) {
        Some(open) => {
            let end = open + text.get(open..)?.find(']')?;
            Some(end + text.get(end..)?.find('>')?)
        }
        None => Some(close),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_declares_the_prefix() {
        let cases = [
            ("<svg/>", "<svg xmlns:cc=\"http://creativecommons.org/ns#\"/>"),
            (
                "<?xml version='1.0'?><!-- <a> --><!DOCTYPE svg [<!ENTITY a 'b'>]>\n<s:svg\n>",
                "<s:svg xmlns:cc=\"http://",
            ),
        ];
        for (text, wanted) in cases {
            let found = declared(text, "cc").unwrap();
            assert!(found.contains(wanted), "{found}");
        }
        assert!(declared("<svg>", "figma").unwrap().contains("xmlns:figma=\"urn:undeclared:figma\""));
        assert_eq!(declared("<!-- ", "cc"), None);
    }
}
