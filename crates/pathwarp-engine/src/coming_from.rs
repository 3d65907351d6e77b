//! Names of other programs and plain words for what pathwarp does: the table `coming_from.txt`.

use crate::catalogue::Catalogue;
use pathwarp::deform::Info;
use pathwarp::param::{Kind, Param};
use pathwarp_solid::deform::Registry3;
use std::collections::HashSet;
use std::fmt::Write as _;

const TABLE: &str = include_str!("coming_from.txt");
/// Separates the parts of a menu path.
const MENU_SEPARATOR: char = '›';

/// A word for a task.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct ForeignWord {
    /// The program that uses the word; `None` for plain words.
    pub program: Option<&'static str>,
    /// The names of the task in that program, the usual one first. Menu paths contain ` › `.
    pub words: Vec<&'static str>,
    /// Advice for users of the word; may be empty.
    pub text: &'static str,
    /// A command line on samples, without `pathwarp`; `None` if pathwarp cannot do the task yet.
    pub command: Option<&'static str>,
}

impl ForeignWord {
    /// Returns the subcommand of the command line.
    #[must_use]
    pub fn subcommand(&self) -> Option<&'static str> {
        self.command?.split(' ').next()
    }

    /// Returns `true` if `wanted`, reduced by [`plain`], is one of the names or a part of a menu path.
    fn is_called(&self, wanted: &str) -> bool {
        self.words.iter().any(|w| plain(w) == wanted || w.split(MENU_SEPARATOR).any(|part| plain(part) == wanted))
    }

    /// Returns `true` if all words of `wanted`, reduced by [`plain`], are in one of the names, or in the name of the program.
    fn mentions(&self, wanted: &str) -> bool {
        self.words.iter().any(|w| {
            let known = plain(&format!("{} {w}", self.program.unwrap_or_default()));
            let known: HashSet<&str> = known.split(' ').collect();
            wanted.split(' ').all(|w| known.contains(w))
        })
    }

    /// Returns the command line with `IN` and `OUT` instead of the sample and its result.
    fn command_line(&self) -> Option<String> {
        let words = self.command?.split(' ').enumerate();
        let general = words.map(|(i, w)| match w.strip_prefix("samples/").and_then(|file| file.rsplit('.').next()) {
            Some(extension) if i == 1 => format!("IN.{extension}"),
            _ => w.to_owned(),
        });
        Some(format!("pathwarp {}", general.collect::<Vec<_>>().join(" ").replace(" -o out.", " -o OUT.")))
    }
}

/// Parses the whole table.
pub fn all() -> impl Iterator<Item = ForeignWord> {
    let mut program = None;
    TABLE.lines().filter_map(move |line| {
        if let Some(name) = line.strip_prefix("## ") {
            program = Some(name).filter(|name| *name != "Plain words");
        }
        let mut columns = line.split('|').map(str::trim);
        let (words, text, command) = (columns.next()?, columns.next()?, columns.next()?);
        let command = Some(command).filter(|c| !c.is_empty());
        let is_row = !line.starts_with('#');
        is_row.then(|| ForeignWord { program, words: words.split(';').map(str::trim).collect(), text, command })
    })
}

/// Returns the entries that are called `word`, plain words first.
fn entries_called(word: &str) -> Vec<ForeignWord> {
    let wanted = plain(word);
    let mut called: Vec<ForeignWord> = all().filter(|w| !wanted.is_empty() && w.is_called(&wanted)).collect();
    called.sort_by_key(|w| w.program.is_some());
    called
}

/// Returns the entries that are called `word`, or else those that mention it.
fn entries_for(word: &str) -> Vec<ForeignWord> {
    let (called, wanted) = (entries_called(word), plain(word));
    if called.is_empty() && !wanted.is_empty() { all().filter(|w| w.mentions(&wanted)).collect() } else { called }
}

/// Lists the styles and presets called `word`, with their command lines.
fn presets(catalogue: &dyn Catalogue, word: &str) -> Option<String> {
    let name = plain(word).replace(' ', "-");
    let params = catalogue.infos().into_iter().flat_map(|info| info.params.iter().map(move |p| (info, p)));
    let is_preset = |info: &Info, p: &Param| info.gallery.is_some_and(|g| g.presets == p.name);
    let takes_names = |(info, p): &(&Info, &Param)| matches!(p.kind, Kind::NameOrFile(_)) || is_preset(info, p);
    let mut known: Vec<_> = params.filter(takes_names).filter(|(_, p)| p.names().contains(&&*name)).collect();
    // Shapes, the presets of path parameters, come last.
    known.sort_by_key(|(_, p)| p.kind == Kind::Path);
    let lines = known.into_iter().map(|(info, p)| {
        let line = format!("pathwarp {} IN.svg --{} {name} -o OUT.svg", info.name, p.name);
        match p.kind {
            Kind::Path => format!("a shape: pathwarp text WORDS --in {name} -o OUT.svg; or {line}"),
            _ => format!("a {} of {}: {line}", p.name, info.name),
        }
    });
    let lines: Vec<String> = lines.collect();
    (!lines.is_empty()).then(|| format!("{word} is {}", lines.join("; or ")))
}

/// Explains a word that was typed as a command but is none.
pub fn suggestion(catalogue: &dyn Catalogue, word: &str) -> Option<String> {
    let preset = presets(catalogue, word);
    // A program's word that is also a preset's name means the same deformation, which the preset's line shows.
    let is_meant = |w: &ForeignWord| w.program.is_none() || (preset.is_none() && w.command.is_some());
    let entry = entries_called(word).into_iter().find(is_meant);
    let line = entry.as_ref().and_then(ForeignWord::command_line);
    match (preset, line, entry) {
        (Some(preset), Some(line), _) => Some(format!("{preset}; or use {line}")),
        (Some(preset), None, _) => Some(preset),
        (None, Some(line), _) => Some(format!("there is no command {word}; use {line}")),
        (None, None, Some(entry)) => {
            Some(format!("there is no command {word}: {}", entry.text.trim_start_matches("Not there: ")))
        }
        (None, None, None) => None,
    }
}

/// Returns `true` if the help of a deformation mentions all of `word`.
fn has_in_help(info: &Info, word: &str) -> bool {
    let wanted = format!(" {} ", plain(word));
    let params = info.params.iter().map(|p| p.help);
    let mut texts = [info.about, info.source].into_iter().chain(params);
    // A single letter between the two spaces is no word to look for.
    wanted.len() > 3 && texts.any(|text| format!(" {} ", plain(text)).contains(&wanted))
}

/// Reduces a name to small letters without accents and signs, and leaves out words that only name its kind.
pub fn plain(name: &str) -> String {
    const KINDS: [&str; 5] = ["tool", "effect", "filter", "panel", "lpe"];
    let name: String = name.to_lowercase().chars().filter_map(without_accent).collect();
    let words = name.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty() && !KINDS.contains(w));
    words.collect::<Vec<_>>().join(" ")
}

/// Removes the accent of a small Latin letter; `None` for an accent alone.
fn without_accent(c: char) -> Option<char> {
    #[rustfmt::skip]
    const ACCENTED: [&str; 17] = [
        "aàáâãäåāăą", "cçćĉċč", "dďđ", "eèéêëēĕėęě", "gĝğġģ", "hĥħ", "iìíîïĩīĭįı", "jĵ", "kķ", "lĺļľŀł", "nñńņňŉ", "oòóôõöøōŏő", "rŕŗř",
        "sśŝşš", "tţťŧ", "uùúûüũūŭůűų", "zźżž",
    ];
    let plain = ACCENTED.iter().find(|all| all.contains(c)).and_then(|all| all.chars().next());
    (!matches!(c, '\u{300}'..='\u{36f}')).then(|| plain.unwrap_or(c))
}

/// Returns the text of `pathwarp help WORD`; `title` describes a subcommand. `None` if the word is unknown.
pub fn help(plane: &dyn Catalogue, word: &str, title: impl Fn(&str) -> Option<String>) -> Option<String> {
    let mut out = presets(plane, word).map(|p| p + "\n\n").unwrap_or_default();
    for entry in entries_for(word) {
        let program = entry.program.map(|p| format!("{p}, ")).unwrap_or_default();
        let _ = write!(out, "{program}{}:", entry.words[0]);
        if let Some((name, title)) = entry.subcommand().and_then(|name| Some((name, title(name)?))) {
            let _ = write!(out, " {name} — {title}");
        }
        let text = Some(entry.text).filter(|t| !t.is_empty()).map(|t| format!("\n  {t}")).unwrap_or_default();
        let line = entry.command_line().map(|line| format!("\n    {line}")).unwrap_or_default();
        let _ = write!(out, "{text}{line}\n\n");
    }
    if out.is_empty() {
        for catalogue in [plane, &Registry3::builtin()] {
            let solid = if catalogue.is_solid() { "solid " } else { "" };
            for info in catalogue.infos().into_iter().filter(|info| has_in_help(info, word)) {
                let _ = writeln!(out, "{word} is in the help of {solid}{} — {}", info.name, info.title);
            }
        }
    }
    (!out.is_empty()).then(|| {
        out + "`pathwarp help NAME` describes a command. The page docs/coming-from.md shows all words with pictures.\n"
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_found_as_people_type_them() {
        let commands = |word: &str| entries_for(word).iter().map(ForeignWord::subcommand).collect::<Vec<_>>();
        assert_eq!(commands("puppet-warp tool"), [Some("mls"); 2]);
        assert_eq!(commands("Rotate"), [Some("affine")]);
        assert_eq!(commands("Free Distort"), [Some("projective")]);
        assert_eq!(commands("make with top object"), [Some("envelope")]);
        assert_eq!(commands("Pattern along Path LPE"), [Some("bend")]);
        assert!(commands("LIQUIFY").len() > 4 && commands("liquify").contains(&Some("swirl")));
        assert_eq!(commands("zipper"), [None]);
        assert_eq!(commands("PÚPPET wärp"), commands("puppet warp"));
        assert_eq!(commands("pu\u{301}ppet warp"), commands("puppet warp"));
        assert!(commands("lattice deformation inkscape").contains(&Some("ffd")));
        assert!(commands("").is_empty() && commands("›").is_empty() && commands("unheard-of").is_empty());
    }

    #[test]
    fn every_line_is_a_row() {
        let rows = TABLE.lines().filter(|l| !l.starts_with('#') && !l.trim().is_empty());
        assert_eq!(rows.clone().count(), all().count());
        assert!(rows.clone().all(|l| l.matches('|').count() == 2));
        for w in all() {
            assert!(w.words.iter().all(|w| !w.is_empty()), "{w:?}");
            assert!(w.command.is_some() || w.text.starts_with("Not there"), "{w:?}");
            for name in &w.words {
                assert!(entries_for(name).contains(&w), "{name}");
            }
        }
    }
}
