//! Translates the engine's messages, which name options, to the page's terms: it has controls instead.

use pathwarp::deform::Info;
use std::collections::BTreeMap;
use std::ops::Range;

/// The page's names of parameters.
#[derive(Debug)]
pub(crate) struct Names(BTreeMap<&'static str, String>);

impl Names {
    /// Collects the names of all parameters. A parameter that deformations label differently keeps its name in the registry.
    pub(crate) fn of<'a>(infos: impl Iterator<Item = &'a Info>) -> Self {
        let mut names: BTreeMap<&'static str, String> = BTreeMap::new();
        for info in infos {
            for p in info.params {
                let label = info.by_hand.labels.iter().find(|(name, _)| *name == p.name);
                let label = label.map_or_else(|| words(p.name), |(_, label)| (*label).to_owned());
                let known = names.entry(p.name).or_insert_with(|| label.clone());
                if *known != label {
                    *known = words(p.name);
                }
            }
        }
        Self(names)
    }

    /// Removes options from a message: those of parameters become names of controls; advice about others is dropped, unless it is all.
    pub(crate) fn without_options(&self, message: &str) -> String {
        let parts: Vec<String> = message.split("; ").filter_map(|part| self.part(part)).collect();
        if parts.is_empty() { self.name_options(message, true) } else { parts.join("; ") }
    }

    /// Converts a part of a message, between semicolons; `None` if nothing is left of it.
    fn part(&self, text: &str) -> Option<String> {
        let mut text = self.name_options(text, false);
        while let Some(option) = option(&text, 0) {
            let (before, after) = (&text[..option.start], &text[option.end..]);
            if let (Some(open), Some(close)) = (before.rfind(" ("), after.find(')')) {
                text = before[..open].to_owned() + &after[close + 1..];
            } else {
                let ends = [", or ", ", and ", ". "].into_iter().filter_map(|end| before.rfind(end));
                text = before[..ends.max()?].to_owned();
            }
        }
        Some(text)
    }

    /// Replaces options by names of controls: options of parameters, or all.
    fn name_options(&self, text: &str, all: bool) -> String {
        let (mut out, mut done) = (String::with_capacity(text.len()), 0);
        // `true` after a name of a control instead of a quoted option, whose closing quote is dropped.
        let mut quoted = false;
        let between = |text: &str, quoted: bool| if quoted { text.replacen('`', "", 1) } else { text.to_owned() };
        while let Some(range) = option(text, done) {
            let name = &text[range.start + 2..range.end];
            let label = self.0.get(name).cloned().or_else(|| all.then(|| words(name)));
            out += &between(&text[done..range.start], quoted);
            quoted = label.is_some() && out.ends_with('`');
            if quoted {
                out.pop();
            }
            out += &label.map_or_else(|| text[range.clone()].to_owned(), |label| format!("“{label}”"));
            done = range.end;
        }
        out + &between(&text[done..], quoted)
    }
}

/// Finds the first option in a text from an offset on.
fn option(text: &str, from: usize) -> Option<Range<usize>> {
    text[from..].match_indices("--").map(|(at, _)| from + at).find_map(|at| {
        let begins = text[..at].chars().next_back().is_none_or(|c| c.is_whitespace() || "(`'“".contains(c));
        let rest = &text[at + 2..];
        let length =
            rest.find(|c: char| !c.is_ascii_lowercase() && !c.is_ascii_digit() && c != '-').unwrap_or(rest.len());
        (begins && rest.starts_with(|c: char| c.is_ascii_lowercase())).then(|| at..at + 2 + length)
    })
}

/// Converts a name in kebab case to words: `reverse-shaper` to “Reverse shaper”.
fn words(name: &str) -> String {
    let mut out = String::new();
    for c in name.chars() {
        if c.is_ascii_digit() && out.ends_with(|c: char| c.is_ascii_lowercase()) {
            out.push(' ');
        }
        let c = if c == '-' { ' ' } else { c };
        out.push(if out.is_empty() { c.to_ascii_uppercase() } else { c });
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::deform::Registry;
    use pathwarp_engine::edits::EDITS;
    use pathwarp_engine::options::OPTIONS;

    fn names(registry: &Registry) -> Names {
        Names::of(registry.entries().iter().map(|e| e.info()).chain(&EDITS))
    }

    #[test]
    fn controls_are_named_and_other_advice_is_left_out() {
        let registry = Registry::builtin();
        let names = names(&registry);
        for (told, plain) in [
            ("--reverse-shaper: is a flag", "“Reverse shaper”: is a flag"),
            (
                "the corners are in doubt: `--keep verticals` would do",
                "the corners are in doubt: “Keep” verticals would do",
            ),
            (
                "the DXF holds the middle of a stroke (--strokes outline, when warping, gives its edges)",
                "the DXF holds the middle of a stroke",
            ),
            (
                "too much work; allow a larger --tolerance, or, if you trust the file, raise the limit with --limit work=9",
                "too much work",
            ),
            (
                "`a` is absolute; name it relative to the recipe, or allow it with --allow-external",
                "`a` is absolute; name it relative to the recipe",
            ),
            ("--frame: there is no drawing", "“Frame”: there is no drawing"),
            ("a--b.svg: is no drawing", "a--b.svg: is no drawing"),
        ] {
            assert_eq!(names.without_options(told), plain);
        }
    }

    #[test]
    fn no_option_is_left() {
        let registry = Registry::builtin();
        let names = names(&registry);
        let params = registry.entries().iter().flat_map(|e| e.info().params).map(|p| p.name);
        for name in OPTIONS.iter().map(|o| o.name).chain(params) {
            for text in [
                format!("--{name}: `9` is not right"),
                format!("the artwork extends past the page; --{name} X,Y,W,H shows it (5 %), or --{name} does"),
                format!("12 became outlines (--{name} scale|keep prevents that)"),
                format!("`--{name}` and `--{name} 3` exclude each other"),
            ] {
                let plain = names.without_options(&text);
                assert!(!plain.contains("--") && plain.len() > 5, "{text}: {plain}");
            }
        }
    }
}
