//! Text of dialogs.

use std::fmt::Write as _;

/// Escapes text for XML.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The label of a name in kebab case: `reverse-shaper` becomes “Reverse shaper”.
pub(super) fn label(name: &str) -> String {
    let text = name.replace('-', " ");
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |c| c.to_uppercase().chain(chars).collect())
}

/// Text for people, with options as the dialogs label them: `--reverse-shaper` becomes “Reverse shaper”.
pub(crate) fn labelled(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(i) = rest.find("--") {
        let (before, after) = (&rest[..i], &rest[i + 2..]);
        let len = after.find(|c: char| !(c.is_ascii_alphanumeric() || c == '-')).unwrap_or(after.len());
        out.push_str(before);
        if len == 0 || before.ends_with(|c: char| c.is_alphanumeric()) {
            out.push_str("--");
            rest = after;
            continue;
        }
        let _ = write!(out, "“{}”", label(&after[..len]));
        rest = &after[len..];
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn options_read_as_in_the_dialogs() {
        assert_eq!(labelled("use --reverse-shaper, or --by."), "use “Reverse shaper”, or “By”.");
        assert_eq!(labelled("a -- b 1--2 --"), "a -- b 1--2 --");
    }
}
