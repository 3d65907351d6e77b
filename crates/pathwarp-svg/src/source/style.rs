//! Style attributes and style sheets as text.
//!
//! simplecss's `DeclarationTokenizer` does not fit here: it stops at the first declaration it cannot parse and drops
//! `!important` and comments, while an editor has to keep all of them.

use std::collections::HashSet;

/// Splits a style attribute, or the block of a rule, into declarations.
pub(crate) fn declarations(style: &str) -> impl Iterator<Item = (&str, &str)> {
    // Quoted strings and url(data:…;base64,…) may contain semicolons.
    let mut parts = Vec::new();
    let (mut depth, mut quote, mut start) = (0_i32, None, 0);
    for (i, c) in style.char_indices() {
        match (quote, c) {
            (None, '"' | '\'') => quote = Some(c),
            (Some(q), c) if q == c => quote = None,
            (None, '(') => depth += 1,
            (None, ')') => depth -= 1,
            (None, ';') if depth <= 0 => {
                parts.push(&style[start..i]);
                start = i + 1;
            }
            _ => {}
        }
    }
    parts.push(&style[start..]);
    parts.into_iter().filter_map(|p| p.split_once(':')).map(|(n, v)| (n.trim(), v.trim()))
}

/// Returns the value of a property in a style attribute.
pub(crate) fn declared<'a>(style: &'a str, name: &str) -> Option<&'a str> {
    declarations(style).filter(|(n, _)| n.eq_ignore_ascii_case(name)).last().map(|d| d.1)
}

/// Sets a property in a style attribute, at the position of the existing declaration if there is one.
pub(crate) fn with_declaration(style: &str, name: &str, value: &str) -> String {
    let mut out: Vec<String> = Vec::new();
    let mut set = false;
    for (n, v) in declarations(style) {
        if !n.eq_ignore_ascii_case(name) {
            out.push(format!("{n}:{v}"));
        } else if !set {
            out.push(format!("{n}:{value}"));
            set = true;
        }
    }
    if !set {
        out.push(format!("{name}:{value}"));
    }
    out.join(";")
}

/// Lists the words of a style sheet in lower case, except class and id names: `.rect` does not mention `<rect>`.
pub(crate) fn words(css: &str) -> HashSet<String> {
    let mut out = HashSet::new();
    let mut word = String::new();
    let mut before = ' ';
    let mut is_name = false;
    let css: String = css
        .split("/*")
        .enumerate()
        .map(|(i, s)| if i == 0 { s } else { s.split_once("*/").map_or("", |p| p.1) })
        .collect();
    for c in css.chars().chain(['\n']) {
        if c.is_alphanumeric() || c == '-' || c == '_' {
            if word.is_empty() {
                is_name = before == '.' || before == '#';
            }
            word.push(c);
        } else {
            if !word.is_empty() && !is_name {
                out.insert(word.to_ascii_lowercase());
            }
            word.clear();
            if c == '*' {
                out.insert("*".to_owned());
            }
            before = c;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_class_is_not_a_type_selector() {
        let w = words("/* rect */ .circle, g > line:hover{fill:red}");
        assert!(w.contains("line") && w.contains("fill") && !w.contains("circle") && !w.contains("*"));
    }
}
