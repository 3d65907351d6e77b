//! The parts that a lean program is built without, and what it says where one of them is asked for.

/// A part of the program that a cargo feature adds.
struct Part {
    feature: &'static str,
    is_built_in: bool,
    what: &'static str,
    /// Its commands, options, values of options, and file extensions.
    words: &'static [&'static str],
}

const fn part(feature: &'static str, is_built_in: bool, what: &'static str, words: &'static [&'static str]) -> Part {
    Part { feature, is_built_in, what, words }
}

const PARTS: [Part; 7] = [
    part("dxf", cfg!(feature = "dxf"), "DXF", &["dxf", "dxf-curves", "kerf"]),
    part("editor", cfg!(feature = "editor"), "the editor", &["edit"]),
    part("gimp", cfg!(feature = "gimp"), "GIMP's files", &["gimp", "xcf", "json", "into", "salvage"]),
    part(
        "gimp",
        cfg!(any(feature = "dxf", feature = "gimp", feature = "pdf")),
        "PDF, DXF and GIMP's files",
        &["convert"],
    ),
    part("pdf", cfg!(feature = "pdf"), "PDF", &["pdf"]),
    part("plug-ins", cfg!(feature = "plug-ins"), "plug-ins", &["check", "new-plugin", "plugin"]),
    part("solid", cfg!(feature = "solid"), "solids", &["solid"]),
];

/// The message that this program has not what `word` is about; `None` if it has, or if no part of the program is about it.
pub(crate) fn missing(word: &str) -> Option<String> {
    let word = word.trim_start_matches('-');
    let part = PARTS.iter().find(|p| !p.is_built_in && p.words.iter().any(|w| w.eq_ignore_ascii_case(word)))?;
    let Part { feature, what, .. } = part;
    Some(format!(
        "this program was built without {what}, which {word} needs; a complete build has it, and so has one with `--features {feature}`"
    ))
}
