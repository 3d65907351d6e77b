//! Names of parameters in the dialogs, besides those of deformations and common options. The latter are in kebab case, so an underscore can
//! mark additional parameters that belong to one of them.

/// The word between two steps.
pub(super) const CHAIN: &str = "+";

/// Parameter: the deformation to apply.
pub(super) const DEFORMATION: &str = "inkscape-deformation";
/// Parameter: another action.
pub(super) const ACTION: &str = "inkscape-action";
/// Parameter: the number of selected paths that are guides, or [`AUTOMATIC`].
pub(super) const GUIDES: &str = "inkscape-guides";
/// Parameter: the treatment of objects that are warped already.
pub(super) const AGAIN: &str = "inkscape-again";
/// Parameter: show warnings in a window.
pub(super) const WARNINGS: &str = "inkscape-warnings";
/// Parameter: new values for a warp.
pub(super) const CHANGES: &str = "inkscape-changes";
/// Parameter: show the settings of a warp, and change nothing.
pub(super) const SHOW: &str = "inkscape-show";
/// Parameter: discard changes made by hand.
pub(super) const DISCARD: &str = "inkscape-discard";

/// Value: the usual choice.
pub(super) const AUTOMATIC: &str = "auto";
/// Value: change the warp instead of warping its result.
pub(super) const REPLACE: &str = "replace";
/// Value: warp the result.
pub(super) const ADD: &str = "add";

/// Value: no choice, since Inkscape has no empty values.
pub(super) const NONE: &str = "-";

/// Suffix: a number in percent.
pub(super) const PERCENT: &str = "_percent";
/// Suffix: the unit of a length.
pub(super) const UNIT: &str = "_unit";
/// Suffix: a file that replaces a name.
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

/// Returns `true` for an argument that names the action.
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

/// Splits a line into words. An unclosed quote ends with the line.
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
