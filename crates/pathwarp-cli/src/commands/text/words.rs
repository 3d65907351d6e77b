//! The text to set: arguments, a file or standard input.

use crate::failure::Failure;
use crate::input;
use clap::ArgMatches;
use std::path::PathBuf;

/// The text and the one of `--below`. Only the latter may be alone.
pub(super) fn both(m: &ArgMatches) -> Result<[Option<String>; 2], Failure> {
    let below = m.get_one::<String>("below").map(|t| unescaped(t));
    let given = m.contains_id("file") || m.get_many::<String>("WORDS").is_some_and(|mut w| w.any(|w| !w.is_empty()));
    let text = (given || below.is_none()).then(|| words(m)).transpose()?;
    Ok([text, below])
}

/// The text of the arguments, a file or standard input.
fn words(m: &ArgMatches) -> Result<String, Failure> {
    let words: Vec<&str> = m.get_many::<String>("WORDS").into_iter().flatten().map(String::as_str).collect();
    let file = match (m.get_one::<PathBuf>("file"), &words[..]) {
        (Some(file), _) => file.clone(),
        (None, ["-"]) => PathBuf::from("-"),
        (None, []) => return Err(Failure::usage("text: give WORDS, or --file FILE; - reads standard input")),
        (None, words) => return Ok(words.iter().map(|w| unescaped(w)).collect::<Vec<_>>().join("\n")),
    };
    let name = input::display(&file);
    let text = String::from_utf8(input::bytes(&file)?)
        .map_err(|e| Failure::Input(format!("{name}: is not UTF-8 text (byte {})", e.utf8_error().valid_up_to())))?;
    // Drop a byte order mark, and the newline at the end of the file.
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let text = text.strip_suffix('\n').unwrap_or(text);
    Ok(text.strip_suffix('\r').unwrap_or(text).to_owned())
}

/// Replaces `\n` by a newline and `\\` by a backslash.
fn unescaped(word: &str) -> String {
    let mut out = String::with_capacity(word.len());
    let mut chars = word.chars().peekable();
    while let Some(c) = chars.next() {
        match (c, chars.peek()) {
            ('\\', Some('n')) => {
                chars.next();
                out.push('\n');
            }
            ('\\', Some('\\')) => {
                chars.next();
                out.push('\\');
            }
            _ => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escapes() {
        assert_eq!(unescaped(r"a\nb\\n\t\"), "a\nb\\n\\t\\");
    }
}
