//! The words of other programs, and what to use here: the table `coming_from.txt`.

use std::collections::HashSet;
use std::fmt::Write as _;

const TABLE: &str = include_str!("coming_from.txt");
/// Separates the parts of a menu path.
const STEP: char = '›';

/// A word of another program.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct ForeignWord {
    /// The program that has it.
    pub program: &'static str,
    /// Its names there; the first is the usual one. Menu paths have ` › ` in them.
    pub words: Vec<&'static str>,
    /// What to know about it here; may be empty.
    pub text: &'static str,
    /// The command line after `pathwarp`, on samples. `None` if there is nothing like it yet.
    pub command: Option<&'static str>,
}

impl ForeignWord {
    /// The subcommand to use.
    #[must_use]
    pub fn subcommand(&self) -> Option<&'static str> {
        self.command?.split(' ').next()
    }

    /// Returns `true` if this is what a user calls `wanted`, which is [`plain`]: the whole name, or a part of its menu path.
    fn is_called(&self, wanted: &str) -> bool {
        self.words.iter().any(|w| plain(w) == wanted || w.split(STEP).any(|part| plain(part) == wanted))
    }

    /// Returns `true` if all words of `wanted` are in one of the names, or in the name of the program.
    fn mentions(&self, wanted: &str) -> bool {
        self.words.iter().any(|w| {
            let known = plain(&format!("{} {w}", self.program));
            let known: HashSet<&str> = known.split(' ').collect();
            wanted.split(' ').all(|w| known.contains(w))
        })
    }
}

/// The whole table.
pub fn all() -> impl Iterator<Item = ForeignWord> {
    let mut program = "";
    TABLE.lines().filter_map(move |line| {
        if let Some(name) = line.strip_prefix("## ") {
            program = name;
        }
        let mut columns = line.split('|').map(str::trim);
        let (words, text, command) = (columns.next()?, columns.next()?, columns.next()?);
        let command = Some(command).filter(|c| !c.is_empty());
        let is_row = !line.starts_with('#');
        is_row.then(|| ForeignWord { program, words: words.split(';').map(str::trim).collect(), text, command })
    })
}

/// The entries that `word` may mean: those of that name, or else those that mention it.
#[must_use]
pub fn found(word: &str) -> Vec<ForeignWord> {
    let wanted = plain(word);
    if wanted.is_empty() {
        return Vec::new();
    }
    let named: Vec<ForeignWord> = all().filter(|w| w.is_called(&wanted)).collect();
    if named.is_empty() { all().filter(|w| w.mentions(&wanted)).collect() } else { named }
}

/// What a word may mean that was typed as a command.
pub(crate) fn meant(word: &str) -> Option<String> {
    let wanted = plain(word);
    let entry = all().find(|w| w.command.is_some() && w.is_called(&wanted))?;
    let (program, command) = (entry.program, entry.command?);
    Some(format!("there is no command {word}; what {program} calls {}: pathwarp {command}", entry.words[0]))
}

/// A name in small letters, without signs and without words that say only what it is.
fn plain(name: &str) -> String {
    const KINDS: [&str; 5] = ["tool", "effect", "filter", "panel", "lpe"];
    let name = name.to_lowercase();
    let words = name.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty() && !KINDS.contains(w));
    words.collect::<Vec<_>>().join(" ")
}

/// What `pathwarp help WORD` says about entries; `title` returns what a subcommand does.
pub(crate) fn help(entries: &[ForeignWord], title: impl Fn(&str) -> Option<String>) -> String {
    let mut out = String::new();
    for ForeignWord { program, words, text, command } in entries {
        let _ = write!(out, "{program}, {}", words[0]);
        let subcommand = command.and_then(|c| c.split(' ').next());
        match subcommand.and_then(|name| Some((name, title(name)?))) {
            Some((name, title)) => _ = writeln!(out, ": {name} — {title}"),
            None => _ = writeln!(out, ":"),
        }
        if !text.is_empty() {
            let _ = writeln!(out, "  {text}");
        }
        if let Some(command) = command {
            let _ = writeln!(out, "    pathwarp {command}");
        }
        out.push('\n');
    }
    out.push_str(
        "`pathwarp help NAME` describes a command. The page docs/coming-from.md shows all words with pictures.\n",
    );
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_found_as_people_type_them() {
        let commands = |word: &str| found(word).iter().map(ForeignWord::subcommand).collect::<Vec<_>>();
        assert_eq!(commands("puppet-warp tool"), [Some("mls"); 2]);
        assert_eq!(commands("Free Distort"), [Some("projective")]);
        assert_eq!(commands("make with top object"), [Some("envelope")]);
        assert_eq!(commands("Pattern along Path LPE"), [Some("bend")]);
        assert!(commands("LIQUIFY").len() > 4 && commands("liquify").contains(&Some("swirl")));
        assert_eq!(commands("zipper"), [None]);
        assert!(commands("lattice deformation inkscape").contains(&Some("ffd")));
        assert!(commands("").is_empty() && commands("›").is_empty() && commands("unheard-of").is_empty());
    }

    #[test]
    fn every_line_is_a_row() {
        let rows = TABLE.lines().filter(|l| !l.starts_with('#') && !l.trim().is_empty());
        assert_eq!(rows.clone().count(), all().count());
        assert!(rows.clone().all(|l| l.matches('|').count() == 2));
        for w in all() {
            assert!(!w.program.is_empty() && w.words.iter().all(|w| !w.is_empty()), "{w:?}");
            assert!(w.command.is_some() || w.text.starts_with("Not there yet"), "{w:?}");
            for name in &w.words {
                assert!(found(name).contains(&w), "{name}");
            }
        }
    }
}
