//! Names of results: the file that *Save* writes, and files that it must not replace.

use std::path::{Path, PathBuf};

/// Suffix of the drawing's name in results.
const SUFFIX: &str = "-bent";
/// Most names that are tried.
const MOST_NAMES: usize = 1000;

/// Returns the usual name for the result of `source`: an unused one beside it.
pub(crate) fn default_result(source: &Path) -> PathBuf {
    let stem = source.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    unused_name(source, &(stem + SUFFIX))
}

/// Returns an unused name for words, beside `beside`.
pub(crate) fn words_file(text: &str, beside: &Path) -> PathBuf {
    /// Longest name, in letters.
    const LONGEST: usize = 40;
    let name: String = text.trim().chars().take(LONGEST).collect();
    let words: Vec<&str> = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    unused_name(beside, &if words.is_empty() { "words".to_owned() } else { words.join("-") })
}

/// Returns an unused name beside a file, numbered if necessary.
fn unused_name(beside: &Path, stem: &str) -> PathBuf {
    let last = || beside.with_file_name(format!("{stem}-{MOST_NAMES}.svg"));
    numbered_names(beside, stem).find(|p| !p.exists()).unwrap_or_else(last)
}

/// Returns names beside a file, numbered from the second on.
fn numbered_names(beside: &Path, stem: &str) -> impl Iterator<Item = PathBuf> {
    (1..MOST_NAMES).map(move |n| {
        let number = if n == 1 { String::new() } else { format!("-{n}") };
        beside.with_file_name(format!("{stem}{number}.svg"))
    })
}

/// Returns the file beside `opened` that holds `source`, the drawing shown or the source of the result shown, and `true`: for `x-bent.svg`
/// one of `x.svg`, `x.svgz`, `x-source.svg`, `x-source-2.svg` and so on. If none holds it, returns an unused name, and `false`.
pub(crate) fn source_of(opened: &Path, source: &[u8]) -> Option<(PathBuf, bool)> {
    let stem = opened.file_stem()?.to_string_lossy().into_owned();
    let stem = stem.rfind(SUFFIX).map_or(stem.as_str(), |at| &stem[..at]);
    let drawings = [".svg", ".svgz"].map(|extension| opened.with_file_name(format!("{stem}{extension}")));
    let has_content = |name: &Path| std::fs::read(name).is_ok_and(|content| content == source);
    let beside = format!("{stem}-source");
    let known = drawings
        .into_iter()
        .chain(numbered_names(opened, &beside).take_while(|n| n.exists()))
        .find(|name| has_content(name));
    Some(known.map_or_else(|| (unused_name(opened, &beside), false), |name| (name, true)))
}

/// Returns the path of the file `name` in the folder of `beside`.
pub(crate) fn file_beside(name: &str, beside: &Path) -> Result<PathBuf, String> {
    let name = name.trim();
    let wrong = |problem: &str| Err(format!("`{name}` {problem}"));
    if name.is_empty() {
        return Err("the file needs a name".into());
    }
    if name.contains(['/', '\\', '\0']) || name.starts_with('.') {
        return wrong("is not a plain file name");
    }
    let path = Path::new(name);
    let with_extension = if path.extension().is_some() { path.to_owned() } else { path.with_extension("svg") };
    Ok(beside.with_file_name(with_extension))
}

/// Returns the folder that a user names: absolute, relative to the drawing's folder, or beginning with `~`. It must exist.
pub(crate) fn folder(name: &str, drawing: &Path) -> Result<PathBuf, String> {
    let named = match (name.strip_prefix('~'), std::env::home_dir()) {
        (Some(rest), Some(home)) if rest.is_empty() || rest.starts_with(['/', '\\']) => {
            home.join(rest.trim_start_matches(['/', '\\']))
        }
        _ => drawing.parent().unwrap_or(Path::new("")).join(name),
    };
    if named.is_dir() { Ok(named) } else { Err(format!("there is no folder {name}")) }
}

/// Returns `true` if the file has one of these extensions.
pub(crate) fn has_extension(file: &Path, all: &[&str]) -> bool {
    file.extension().is_some_and(|e| all.iter().any(|a| e.eq_ignore_ascii_case(a)))
}

/// Returns `true` if both paths lead to the same file.
pub(crate) fn same_file(a: &Path, b: &Path) -> bool {
    a == b || matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stay_in_the_folder() {
        let beside = Path::new("/art/logo.svg");
        assert_eq!(default_result(beside), Path::new("/art/logo-bent.svg"));
        assert_eq!(words_file("It's “Fjord” & <sea>\n", beside), Path::new("/art/It-s-Fjord-sea.svg"));
        assert_eq!(words_file(" … ", beside), Path::new("/art/words.svg"));
        assert_eq!(file_beside("flag", beside), Ok("/art/flag.svg".into()));
        assert_eq!(file_beside("flag.pdf", beside), Ok("/art/flag.pdf".into()));
        for wrong in ["", "../x.svg", "a/b.svg", ".hidden", "a\\b"] {
            assert!(file_beside(wrong, beside).is_err(), "{wrong}");
        }
    }
}
