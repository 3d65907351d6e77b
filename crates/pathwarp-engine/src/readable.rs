//! Text from files, made fit for a terminal: shortened, and without control characters, which could move the cursor or rename the window.

use pathwarp::engine::decimal::trimmed;
use serde::Serialize;
use std::borrow::Cow;

/// Most characters of a message that are shown; an id or name in it can be as long as its file.
const LONGEST: usize = 2000;
/// How many of them stand before the gap; the rest stand after it, since the end of a message tells what to do.
const HEAD: usize = 1400;

/// Prepares a name for a table: control characters become escapes.
pub fn safe_name(name: &str) -> Cow<'_, str> {
    escaped(name, is_unsafe_in_names)
}

/// Prepares a message: lines and tabs are kept, and a very long text gets a gap in its middle.
pub fn safe_message(message: &str) -> Cow<'_, str> {
    let length = message.chars().count();
    if length <= LONGEST {
        return escaped(message, is_unsafe);
    }
    let head: String = message.chars().take(HEAD).collect();
    let tail: String = message.chars().skip(length - (LONGEST - HEAD)).collect();
    let left_out = length - LONGEST;
    Cow::Owned(format!("{} … ({left_out} characters) … {}", escaped(&head, is_unsafe), escaped(&tail, is_unsafe)))
}

/// Writes indented JSON, with escapes for the control characters that JSON allows unescaped.
pub fn json(value: &impl Serialize) -> serde_json::Result<String> {
    serde_json::to_string_pretty(value).map(escaped_json)
}

/// Escapes control characters in JSON, where they occur in strings only.
fn escaped_json(mut json: String) -> String {
    if json.contains(is_unsafe) {
        let escaped = |c: char| if is_unsafe(c) { format!("\\u{:04x}", u32::from(c)) } else { c.into() };
        json = json.chars().map(escaped).collect();
    }
    json
}

fn is_unsafe(c: char) -> bool {
    is_unsafe_in_names(c) && c != '\n' && c != '\t'
}

/// Returns `true` for control characters and characters that change the order of the text (Unicode annex 9, table 4).
fn is_unsafe_in_names(c: char) -> bool {
    c.is_control() || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

fn escaped(text: &str, is_escaped: fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(is_escaped) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if is_escaped(c) { out.extend(c.escape_default()) } else { out.push(c) }
    }
    Cow::Owned(out)
}

/// Formats a positive number with three significant figures, or with twelve decimals if it is tiny.
pub(crate) fn three_figures(v: f64) -> String {
    const MOST_DECIMALS: f64 = 12.0;
    trimmed(v, (2.0 - v.log10().floor()).clamp(0.0, MOST_DECIMALS) as usize)
}

/// Lists the first `most` names, and the number of the others.
pub fn listed(names: &[impl AsRef<str>], most: usize) -> String {
    let shown: Vec<&str> = names.iter().take(most).map(AsRef::as_ref).collect();
    let more = names.len().saturating_sub(most);
    shown.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_shown_and_do_nothing() {
        assert_eq!(safe_name("plain “ünï” name"), "plain “ünï” name");
        assert_eq!(safe_name("\x1b[31mred\nline\u{9b}2J"), "\\u{1b}[31mred\\nline\\u{9b}2J");
        assert_eq!(safe_message("a\nb\tc\x07"), "a\nb\tc\\u{7}");
        assert_eq!(safe_name("a\u{202e}gvs.svg"), "a\\u{202e}gvs.svg");
        assert_eq!(escaped_json("{\"a\": \"\u{9b}31m\u{7f}ä\"\n}".into()), "{\"a\": \"\\u009b31m\\u007fä\"\n}");
    }

    #[test]
    fn long_messages_keep_both_ends() {
        let long = format!("error in {}: do this", "ä".repeat(500_000));
        let shown = safe_message(&long);
        assert!(shown.starts_with("error in ä") && shown.ends_with("ä: do this"), "{shown}");
        assert!(shown.chars().count() < LONGEST + 50, "{shown}");
        let short = "x".repeat(LONGEST);
        assert_eq!(safe_message(&short), short);
    }

    #[test]
    fn three_figures_of_any_size() {
        assert_eq!(three_figures(0.012_345), "0.0123");
        assert_eq!(three_figures(1200.0), "1200");
    }
}
