//! Names of parameters in the dialogs, beside those of deformations and common options. Those are in kebab case, so an underscore
//! is free to mark what belongs to one of them.

/// The word between two steps.
pub(super) const CHAIN: &str = "+";

/// The deformation to apply.
pub(super) const DEFORMATION: &str = "inkscape-deformation";
/// Another thing to do.
pub(super) const ACTION: &str = "inkscape-action";
/// The number of selected paths that are guides, or [`AUTOMATIC`].
pub(super) const GUIDES: &str = "inkscape-guides";
/// The treatment of objects that are warped already.
pub(super) const AGAIN: &str = "inkscape-again";
/// Show warnings in a window.
pub(super) const WARNINGS: &str = "inkscape-warnings";
/// New values for a warp.
pub(super) const CHANGES: &str = "inkscape-changes";
/// Show the settings of a warp, and change nothing.
pub(super) const SHOW: &str = "inkscape-show";
/// Give up changes made by hand.
pub(super) const DISCARD: &str = "inkscape-discard";

/// The word for the usual choice.
pub(super) const AUTOMATIC: &str = "auto";
/// Change the warp instead of warping its result.
pub(super) const REPLACE: &str = "replace";
/// Warp the result.
pub(super) const ADD: &str = "add";

/// The value of an option without a choice, as Inkscape has no empty ones.
pub(super) const NONE: &str = "-";

/// A number in percent.
pub(super) const PERCENT: &str = "_percent";
/// The unit of a length.
pub(super) const UNIT: &str = "_unit";
/// A file of the user's instead of a name.
pub(super) const FILE: &str = "_file";

/// Units of lengths as Inkscape passes them, and as the command line takes them.
pub(super) const UNITS: [(&str, &str, &str); 6] = [
    ("percent", "%", "% of the artwork"),
    ("user", "", "user units"),
    ("mm", "mm", "mm"),
    ("cm", "cm", "cm"),
    ("in", "in", "in"),
    ("pt", "pt", "pt"),
];

/// Returns `true` for the argument that says what to do.
pub(super) fn is_job(arg: &str) -> bool {
    let name = arg.strip_prefix("--").and_then(|a| a.split_once('=')).map(|(name, _)| name);
    name.is_some_and(|n| n == DEFORMATION || n == ACTION)
}

/// Joins words to a line.
pub(super) fn joined(words: &[String]) -> String {
    let quoted = |w: &String| {
        let plain = !w.is_empty() && !w.contains(|c: char| c.is_whitespace() || c == '\'' || c == '"');
        if plain { w.clone() } else { format!("'{}'", w.replace('\'', "'\"'\"'")) }
    };
    words.iter().map(quoted).collect::<Vec<_>>().join(" ")
}

/// Splits a line into words. A quote that is not closed ends with the line.
pub(super) fn split(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut quote = None;
    for c in line.chars() {
        match (quote, c) {
            (Some(q), c) if c == q => quote = None,
            (None, '\'' | '"') => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (None, c) if c.is_whitespace() => words.extend(word.take()),
            (_, c) => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_come_back() {
        for words in [&["warp", "--bend=40%"][..], &["expr", "--x=x + 'a' \"b\"", "", "ä\nö"], &[]] {
            let words: Vec<String> = words.iter().map(ToString::to_string).collect();
            assert_eq!(split(&joined(&words)), words);
        }
        assert_eq!(split(" a  'b c'd \"e'f\" 'g h"), ["a", "b cd", "e'f", "g h"]);
    }
}
