//! Style attributes and style sheets as text.
//!
//! simplecss's `DeclarationTokenizer` does not fit here: it stops at the first declaration it cannot parse and drops
//! `!important` and comments, while an editor has to keep all of them.

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
