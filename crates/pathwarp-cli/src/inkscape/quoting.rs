//! Recipes as one line of text: words of a command line, in quotes where they need them.

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
