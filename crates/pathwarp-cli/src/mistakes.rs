//! Mistakes of new users: commands and options of other programs, values apart from their units, names without quotes.

use pathwarp_engine::advice::likely;
use pathwarp_engine::catalogue::Catalogue;
use pathwarp_engine::coming_from;
use pathwarp_engine::format::Format;
use pathwarp_engine::input::split_reference;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Synonyms of options, with the proper option, which is suggested if the command has it.
const OPTIONS: [(&[&str], &str); 22] = [
    (&["output", "outfile", "out-file", "export-filename", "to", "o"], "out"),
    (&["angle", "rotation", "turn", "degrees"], "rotate"),
    (&["angle", "degrees", "arc"], "sweep"),
    (&["slant", "lean", "italic", "oblique", "shear"], "skew-x"),
    (&["formula", "function", "expression", "f"], "x 'x + 4*sin(y/16)'"),
    (&["amount", "strength", "intensity", "curve", "percent"], "bend"),
    (&["preset", "shape", "type", "name", "kind", "effect"], "style"),
    (&["path", "curve", "on", "circle", "onto"], "along"),
    (&["along", "path", "curve", "circle", "arc", "spiral"], "on circle:r=60mm"),
    (&["to", "corners", "destination", "dst", "quad"], "target"),
    (&["cage", "mesh", "path"], "shaper"),
    (&["only", "id", "layer", "object", "ids"], "select"),
    (&["dpi", "resolution"], "image-dpi"),
    (&["verbose", "v", "debug"], "explain"),
    (&["force", "overwrite", "replace"], "in-place"),
    (&["json", "log"], "report FILE.json"),
    (&["recurse", "folder"], "recursive"),
    (&["amplitude", "amp"], "height"),
    (&["width", "size", "zoom", "factor"], "scale-x 1.5 (a factor; also --scale-y)"),
    (&["height"], "scale-y 1.5 (a factor)"),
    (&["translate", "shift", "offset", "dx"], "move-x 10mm (a length; also --move-y)"),
    (&["dy"], "move-y 10mm (a length)"),
];

/// Explains an unknown command.
pub(crate) fn command(catalogue: &dyn Catalogue, word: &str) -> Option<String> {
    let path = Path::new(word);
    let lower = word.to_lowercase();
    if path.is_file() || path.extension().is_some_and(|_| Format::of(path).is_some()) || lower.contains("://") {
        return Some(format!(
            "{word} is a drawing, not a command; say what to do with it, such as `pathwarp warp {word} --style flag -o OUT.svg`; \
             `pathwarp edit {word}` opens it in the browser, `pathwarp list` shows all deformations"
        ));
    }
    if path.is_dir() {
        return Some(format!(
            "{word} is a folder, not a command; `pathwarp warp -r {word} --style flag --out-dir OUT` warps the drawings in it"
        ));
    }
    coming_from::suggestion(catalogue, word)
}

/// Finds the first option with one dash instead of two, which would be read as letters: `-rotate 5` as `-r -o tate 5`.
pub(crate) fn single_dashed(words: &[OsString], known: impl FnOnce() -> Vec<String>) -> Option<String> {
    let name = |w: &OsString| w.to_str()?.strip_prefix('-')?.split('=').next().map(str::to_owned);
    let is_name =
        |n: &String| n.len() > 2 && n.chars().all(|c| c.is_ascii_lowercase() || c == '-') && !n.starts_with('-');
    let names: Vec<String> = words.iter().filter_map(name).filter(is_name).collect();
    let known = if names.is_empty() { Vec::new() } else { known() };
    names.into_iter().find(|n| known.contains(n)).map(|n| format!("-{n} is not an option; use --{n}"))
}

/// Suggests a replacement for an unknown option: known ones that begin with it, a synonym, or a similar one.
pub(crate) fn option(unknown: &str, known: &[&str]) -> String {
    /// The least similarity of a mistyped option, from 0 to 1.
    const LEAST: f64 = 0.6;
    let name = unknown.trim_start_matches('-').to_lowercase();
    let longer = |k: &&&str| k.strip_prefix(name.as_str()).is_some_and(|rest| rest.starts_with('-'));
    let longer: Vec<&str> = known.iter().filter(longer).copied().collect();
    let mut synonyms = OPTIONS.iter().filter(|(words, _)| words.contains(&name.as_str())).map(|(_, text)| *text);
    let synonym = synonyms.find(|text| text.split(' ').next().is_some_and(|option| known.contains(&option)));
    let meant = match &longer[..] {
        [] => {
            let is_similar = |k: &&str| strsim::normalized_damerau_levenshtein(&name, k) > LEAST;
            synonym.or_else(|| likely(&name, known.iter().copied()).filter(is_similar)).map(str::to_owned)
        }
        longer => Some(longer.join(" or --")),
    };
    if ["i", "in", "input", "file", "infile"].contains(&name.as_str()) {
        return "files are named without an option".to_owned();
    }
    meant.map_or_else(|| "--help lists the options".to_owned(), |meant| format!("use --{meant}"))
}

/// An option's value that a space has split.
struct Torn {
    /// The second part, a separate word.
    word: String,
    /// The option with the whole value.
    whole: String,
    why: &'static str,
}

/// Returns `true` for a unit alone.
fn is_unit(word: &str) -> bool {
    ["%", "mm", "cm", "in", "inch", "inches", "pt", "px", "pc", "m", "deg", "degrees", "°", "rad", "turn"]
        .contains(&word)
}

fn is_number(word: &str) -> bool {
    word.parse::<f64>().is_ok_and(f64::is_finite)
}

/// Returns `true` for a number, with a unit or not, or a point.
fn is_measure(word: &str) -> bool {
    word.split([',', ':']).all(|part| {
        let number = part.trim_end_matches(|c: char| c.is_ascii_alphabetic() || c == '%' || c == '°');
        is_number(number) && (number.len() == part.len() || is_unit(&part[number.len()..]))
    })
}

/// Returns `true` for a letter of path data, alone or followed by numbers.
fn is_data(word: &str) -> bool {
    let numbers = word.trim_start_matches(|c| "MLHVCSQTAZmlhvcsqtaz".contains(c));
    numbers.len() < word.len() && (numbers.is_empty() || is_measure(numbers))
}

/// Finds words that belong to the value of the option before them: `--size 40 mm`, `--target 0,0 9,0 9,9`.
fn torn(words: &[String]) -> Option<Torn> {
    for (i, word) in words.iter().enumerate().filter(|(_, w)| w.len() > 2 && w.starts_with("--")) {
        let (option, first, rest) = match (word.split_once('='), &words[i + 1..]) {
            (Some((option, first)), rest) => (option, first, rest),
            (None, [first, rest @ ..]) => (word.as_str(), first.as_str(), rest),
            (None, []) => continue,
        };
        let Some(next) = rest.first() else { continue };
        if is_number(first) && is_unit(next) {
            let why = "a number and its unit are one word";
            return Some(Torn { word: next.clone(), whole: format!("{option} {first}{next}"), why });
        }
        // A list of points, or path data: M 0,0 C 1,2 …
        let begins_list = is_data(first) || (first.contains(',') && is_measure(first));
        let more = rest.iter().take_while(|w| (is_measure(w) || is_data(w)) && !Path::new(w).exists());
        let more: Vec<&str> = more.map(String::as_str).collect();
        if begins_list && !more.is_empty() {
            let (whole, why) = match option {
                "--pair" if !first.contains(':') => (format!("{option} {first}:{next}"), "a pair has a colon"),
                "--pair" | "--pin" | "--move" => {
                    (format!("{option} {first} {option} {next}"), "the option is given for each value")
                }
                _ => (format!("{option} '{first} {}'", more.join(" ")), "a value with spaces needs quotes"),
            };
            return Some(Torn { word: next.clone(), whole, why });
        }
    }
    None
}

/// Warns if a unit is set as text.
pub(crate) fn unit_as_text(words: &[OsString], text: &[&str]) -> Option<String> {
    let words: Vec<String> = words.iter().map(|w| w.to_string_lossy().into_owned()).collect();
    let Torn { word, whole, .. } = torn(&words).filter(|t| text.contains(&t.word.as_str()))?;
    Some(format!("“{word}” is set as a line of text; if it is the unit, write it without a space: {whole}"))
}

/// Explains inputs that do not exist: parts of a value or of a name, or the output.
pub(crate) fn inputs(words: &[OsString], inputs: &[PathBuf], has_out: bool) -> Option<String> {
    let exists = |p: &Path| p.as_os_str() == "-" || p.exists() || split_reference(&p.to_string_lossy()).0.exists();
    let missing = inputs.iter().position(|p| !exists(p))?;
    let name = inputs[missing].display().to_string();
    let words: Vec<String> = words.iter().map(|w| w.to_string_lossy().into_owned()).collect();
    if let Some(Torn { whole, why, .. }) = torn(&words).filter(|t| inputs.iter().any(|i| *i == *t.word)) {
        return Some(format!("there is no file {name}; {why}: {whole}"));
    }
    if inputs.len() < 2 {
        return None;
    }
    // For `my logo.svg`, the words around the missing one form an existing name.
    let runs = (0..=missing).flat_map(|from| (missing..inputs.len()).map(move |to| &inputs[from..=to]));
    for words in runs.filter(|words| words.len() > 1) {
        let whole = words.iter().map(|p| p.display().to_string()).collect::<Vec<_>>().join(" ");
        if Path::new(&whole).exists() {
            return Some(format!("{name}: there is no such file; a name with spaces needs quotes: '{whole}'"));
        }
    }
    if ["to", "into", "as", "->", "=>"].contains(&name.as_str()) {
        let to = inputs.get(missing + 1).map_or("OUT.svg".into(), |to| to.display().to_string());
        return Some(format!("there is no file {name}; name the result with -o {to}"));
    }
    let is_last = missing + 1 == inputs.len();
    (is_last && !has_out && Format::of(&inputs[missing]).is_some())
        .then(|| format!("{name}: there is no such file; if the result is to be written there: -o {name}"))
}

/// Advises on a word beyond those that a command takes.
pub(crate) fn surplus(word: &str, words: &[OsString], known: &[&str]) -> String {
    let before = words.iter().position(|w| w == word).and_then(|i| words.get(i.checked_sub(1)?));
    let whole = format!("{} {word}", before.map_or_else(String::new, |w| w.to_string_lossy().into_owned()));
    if Path::new(&whole).exists() {
        return format!("a name with spaces needs quotes: '{whole}'");
    }
    if known.contains(&"out") && Path::new(word).extension().is_some() {
        return format!("to write to it: -o {word}; a name with spaces needs quotes");
    }
    if is_unit(word) {
        return "a number and its unit are one word, such as 40mm".to_owned();
    }
    "a value or a name with spaces needs quotes; --help says what the command takes".to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_put_together_again() {
        let whole = |line: &str| {
            let words: Vec<String> = line.split(' ').map(str::to_owned).collect();
            torn(&words).map(|t| t.whole)
        };
        for (line, expected) in [
            ("text A --size 40 mm", "--size 40mm"),
            ("warp a.svg --bend -40 %", "--bend -40%"),
            ("warp a.svg --bend=-40 %", "--bend -40%"),
            ("projective --target 0%,100% 100%,100% 75%,0% a.svg", "--target '0%,100% 100%,100% 75%,0%'"),
            ("bend a.svg --along M0,100 Q150,20 300,100", "--along 'M0,100 Q150,20 300,100'"),
            ("bend a.svg --along M 0,100", "--along 'M 0,100'"),
            ("mls --pair 5,5 6,6 a.svg", "--pair 5,5:6,6"),
            ("mls --pair 5,5:6,6 7,7:8,8", "--pair 5,5:6,6 --pair 7,7:8,8"),
        ] {
            assert_eq!(whole(line).as_deref(), Some(expected), "{line}");
        }
        for line in [
            "text 40 mm",
            "warp a.svg --bend 40% b.svg",
            "affine --scale-x 2 a.svg",
            "mls --pin 0,0 a.svg",
            "text A --size",
        ] {
            assert_eq!(whole(line), None, "{line}");
        }
    }

    #[test]
    fn options_by_their_beginning_and_other_names() {
        let known = ["scale-x", "scale-y", "skew-x", "rotate", "out"];
        let meant = |unknown: &str| option(unknown, &known);
        assert_eq!(meant("--scale"), "use --scale-x or --scale-y");
        assert_eq!(meant("--angle"), "use --rotate");
        assert_eq!(meant("--output"), "use --out");
        assert_eq!(meant("--height"), "use --scale-y 1.5 (a factor)");
        assert_eq!(meant("--skwe-x"), "use --skew-x");
        assert_eq!(meant("--wobble"), "--help lists the options");
    }
}
