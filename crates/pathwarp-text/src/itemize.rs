//! Splits a line into runs of one direction and one writing, in visual order.

use harfrust::Script as ShapeScript;
use skrifa::Tag;
use std::ops::Range;
use unicode_bidi::{BidiInfo, Level};
use unicode_script::{Script, UnicodeScript as _};

/// The kind of the letters of a run: a script, or emoji.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Writing {
    /// Letters of a script, with the punctuation and digits among them.
    Script(Script),
    /// Pictures: characters that Unicode shows as emoji, with what modifies and joins them.
    Emoji,
}

impl Writing {
    /// Returns the name of the script in Unicode, with spaces, such as `Devanagari` or `Canadian Aboriginal`; `Emoji` for pictures.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Script(script) => script.full_name().replace('_', " "),
            Self::Emoji => "Emoji".into(),
        }
    }

    /// Returns `true` if letters stand side by side unchanged, so that a shaper may take two such writings for one.
    #[must_use]
    pub fn is_plain(self) -> bool {
        use Script as S;
        let plain =
            [S::Common, S::Latin, S::Greek, S::Cyrillic, S::Armenian, S::Georgian, S::Han, S::Hiragana, S::Katakana];
        matches!(self, Self::Script(script) if plain.contains(&script))
    }
}

/// Text of one direction and one writing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Run {
    /// Byte range in the line.
    pub range: Range<usize>,
    /// `true` if its letters go from right to left.
    pub rtl: bool,
    /// The writing of its letters.
    pub writing: Writing,
    /// Number, from the left, of the level run that it belongs to (Unicode annex 9, BD7).
    pub level_run: usize,
}

/// Returns the runs of a line from left to right, in a paragraph that goes from left to right.
///
/// ```
/// let runs = pathwarp_text::runs("Hi שלום 👍🏽");
/// let names: Vec<_> = runs.iter().map(|r| (r.writing.name(), r.rtl)).collect();
/// assert_eq!(names, [("Latin".into(), false), ("Hebrew".into(), true), ("Hebrew".into(), false), ("Emoji".into(), false)]);
/// ```
#[must_use]
pub fn runs(line: &str) -> Vec<Run> {
    runs_from(line, false, None)
}

/// Returns the runs of a line from left to right (Unicode annex 9, rules L1 and L2), in a paragraph that goes from right to left if `rtl`.
/// A given `script` holds for all letters.
pub(crate) fn runs_from(line: &str, rtl: bool, script: Option<Script>) -> Vec<Run> {
    let base = if rtl { Level::rtl() } else { Level::ltr() };
    let writings = writings(line, script);
    let bidi = BidiInfo::new(line, Some(base));
    let mut out = Vec::new();
    for paragraph in &bidi.paragraphs {
        let (levels, visual) = bidi.visual_runs(paragraph, paragraph.range.clone());
        for (level_run, range) in visual.into_iter().enumerate() {
            let rtl = levels.get(range.start).is_some_and(Level::is_rtl);
            let clipped = |r: &Range<usize>| r.start.max(range.start)..r.end.min(range.end);
            let parts = writings.iter().map(|(r, w)| Run { range: clipped(r), rtl, writing: *w, level_run });
            let first = out.len();
            out.extend(parts.filter(|r| !r.range.is_empty()));
            if rtl {
                out[first..].reverse();
            }
        }
    }
    out
}

/// Splits a line by writing, unless the script is given. Characters common to many scripts join the preceding letters, or else the
/// following ones (Unicode annex 24, 5.1).
fn writings(line: &str, given: Option<Script>) -> Vec<(Range<usize>, Writing)> {
    if let Some(script) = given {
        return vec![(0..line.len(), Writing::Script(script))];
    }
    const COMMON: Writing = Writing::Script(Script::Common);
    let is_shared = |s: &Script| matches!(s, Script::Common | Script::Inherited | Script::Unknown);
    // Variation selectors of Mongolian stand between letters of any script to keep them apart.
    let script = |c: char| Some(c.script()).filter(|s| !is_shared(s) && !matches!(c, '\u{180b}'..='\u{180d}'));
    let mut out: Vec<(Range<usize>, Writing)> = Vec::new();
    let mut emoji_end = 0;
    for (i, c) in line.char_indices() {
        let end = i + c.len_utf8();
        emoji_end = emoji_end.max(i + emoji_length(&line[i..]));
        let found = if i < emoji_end { Some(Writing::Emoji) } else { script(c).map(Writing::Script) };
        match out.last_mut() {
            Some((range, w)) if found == Some(*w) || (found.is_none() && *w != Writing::Emoji) => range.end = end,
            // Leading common characters take the first script found.
            Some((range, w)) if *w == COMMON && found != Some(Writing::Emoji) => {
                range.end = end;
                *w = found.unwrap_or(COMMON);
            }
            _ => out.push((i..end, found.unwrap_or(COMMON))),
        }
    }
    out
}

/// Returns the length in bytes of the emoji that a text begins with (Unicode technical standard 51, section 1.4.9); 0 if there is none.
fn emoji_length(text: &str) -> usize {
    const JOINER: char = '\u{200d}';
    // Variation selectors that ask for a picture or for text.
    const AS_PICTURE: char = '\u{fe0f}';
    const AS_TEXT: char = '\u{fe0e}';
    // Keycap, skin tones and tags.
    let modifies = |c: char| matches!(c, '\u{20e3}' | '\u{1f3fb}'..='\u{1f3ff}' | '\u{e0020}'..='\u{e007f}');
    let mut chars = text.chars();
    let Some(first) = chars.next() else { return 0 };
    match chars.next() {
        Some(AS_PICTURE) => {}
        Some(AS_TEXT) => return 0,
        _ if !is_picture(first) => return 0,
        _ => {}
    }
    let mut joined = false;
    let goes_on = |c: &char| {
        let goes_on = joined || *c == JOINER || *c == AS_PICTURE || modifies(*c);
        joined = *c == JOINER;
        goes_on
    };
    let rest: usize = text.chars().skip(1).take_while(goes_on).map(char::len_utf8).sum();
    first.len_utf8() + rest
}

/// Returns `true` if a character is a picture by default (`Emoji_Presentation` of Unicode; beyond U+1F300, all pictures).
fn is_picture(c: char) -> bool {
    const SINGLE: &str = "⏰⏳☔☕♿⚓⚡⚽⚾⛄⛅⛎⛔⛪⛲⛳⛵⛺⛽✅✊✋✨❌❎❓❔❕❗➕➖➗➰➿⬛⬜⭐⭕🀄🃏🆎";
    let range = matches!(c, '⌚' | '⌛' | '⏩'..='⏬' | '◽' | '◾' | '♈'..='♓' | '⚪' | '⚫' | '\u{1f191}'..='\u{1f19a}')
        || matches!(c, '\u{1f1e6}'..='\u{1f202}' | '\u{1f21a}'..='\u{1f265}' | '\u{1f300}'..='\u{1f6ff}' | '\u{1f7e0}'..='\u{1f7ff}')
        || matches!(c, '\u{1f900}'..='\u{1faff}');
    range || (c > '⌀' && SINGLE.contains(c))
}

/// Converts a script for the shaper.
pub(crate) fn for_shaper(script: Script) -> Option<ShapeScript> {
    ShapeScript::from_iso15924_tag(Tag::from_u32(script.as_iso15924_tag()))
}

/// Returns `true` if a script joins letters, which letter spacing would tear apart (CSS Text 3, "Cursive Scripts").
pub(crate) fn joins_letters(writing: Writing) -> bool {
    use Script as S;
    let joined = [S::Arabic, S::Hanifi_Rohingya, S::Mandaic, S::Mongolian, S::Nko, S::Phags_Pa, S::Syriac];
    matches!(writing, Writing::Script(script) if joined.contains(&script))
}

/// Returns `true` if the first character with a direction is right-to-left (Unicode annex 9, rules P2 and P3).
pub(crate) fn starts_rtl(text: &str) -> bool {
    matches!(unicode_bidi::get_base_direction_full(text), unicode_bidi::Direction::Rtl)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split(line: &str, rtl: bool) -> Vec<(String, bool, Script)> {
        let script = |r: &Run| match r.writing {
            Writing::Script(script) => script,
            Writing::Emoji => Script::Unknown,
        };
        runs_from(line, rtl, None).into_iter().map(|r| (line[r.range.clone()].to_owned(), r.rtl, script(&r))).collect()
    }

    #[test]
    fn lines_are_split_by_direction_and_script() {
        let (latin, hebrew, greek) = (Script::Latin, Script::Hebrew, Script::Greek);
        assert_eq!(split("(abc 12)", false), [("(abc 12)".into(), false, latin)]);
        assert_eq!(
            split("ab גד 12 ef", false),
            [
                ("ab ".into(), false, latin),
                ("12".into(), false, hebrew),
                ("גד ".into(), true, hebrew),
                (" ".into(), false, hebrew),
                ("ef".into(), false, latin)
            ]
        );
        assert_eq!(split("גד ef", true), [("ef".into(), false, latin), ("גד ".into(), true, hebrew)]);
        assert_eq!(split("aβ", false), [("a".into(), false, latin), ("β".into(), false, greek)]);
        assert_eq!(
            split("a 👩‍👩‍👧 1️⃣2 ☺ ☺️", false),
            [
                ("a ".into(), false, latin),
                ("👩‍👩‍👧".into(), false, Script::Unknown),
                (" ".into(), false, Script::Common),
                ("1️⃣".into(), false, Script::Unknown),
                ("2 ☺ ".into(), false, Script::Common),
                ("☺️".into(), false, Script::Unknown)
            ]
        );
        assert!(starts_rtl("12 ג a") && !starts_rtl("a ג") && !starts_rtl("1 2"));
    }
}
