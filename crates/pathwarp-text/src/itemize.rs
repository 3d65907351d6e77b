//! Splits a line into runs of one direction and one script, in visual order.

use harfrust::Script as ShapeScript;
use skrifa::Tag;
use std::ops::Range;
use unicode_bidi::{BidiInfo, Level};
use unicode_script::{Script, UnicodeScript as _};

/// Text of one direction and one script.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Run {
    /// Byte range in the line.
    pub(crate) range: Range<usize>,
    pub(crate) rtl: bool,
    pub(crate) script: Script,
}

/// Returns the runs of a line from left to right (Unicode annex 9, rules L1 and L2).
pub(crate) fn runs(line: &str, rtl: bool, script: Option<Script>) -> Vec<Run> {
    let base = if rtl { Level::rtl() } else { Level::ltr() };
    let scripts = scripts(line, script);
    let bidi = BidiInfo::new(line, Some(base));
    let mut out = Vec::new();
    for paragraph in &bidi.paragraphs {
        let (levels, visual) = bidi.visual_runs(paragraph, paragraph.range.clone());
        for range in visual {
            let rtl = levels.get(range.start).is_some_and(Level::is_rtl);
            let mut parts: Vec<Run> = scripts
                .iter()
                .map(|(r, script)| Run { range: r.start.max(range.start)..r.end.min(range.end), rtl, script: *script })
                .filter(|r| !r.range.is_empty())
                .collect();
            if rtl {
                parts.reverse();
            }
            out.append(&mut parts);
        }
    }
    out
}

/// Splits a line by script. Characters common to many scripts join the preceding text, or else the following text (Unicode annex 24,
/// 5.1).
fn scripts(line: &str, all: Option<Script>) -> Vec<(Range<usize>, Script)> {
    if let Some(script) = all {
        return vec![(0..line.len(), script)];
    }
    let own = |c: char| Some(c.script()).filter(|s| !matches!(s, Script::Common | Script::Inherited | Script::Unknown));
    let mut out: Vec<(Range<usize>, Script)> = Vec::new();
    for (i, c) in line.char_indices() {
        let end = i + c.len_utf8();
        let script = own(c);
        match out.last_mut() {
            Some((range, s)) if script.is_none() || script == Some(*s) => {
                debug_assert_eq!(range.end, i);
                range.end = end;
            }
            // Leading common characters take the first script found.
            Some((range, s)) if *s == Script::Common => {
                range.end = end;
                *s = script.unwrap_or(*s);
            }
            _ => out.push((i..end, script.unwrap_or(Script::Common))),
        }
    }
    out
}

/// Converts a script for the shaper.
pub(crate) fn for_shaper(script: Script) -> Option<ShapeScript> {
    ShapeScript::from_iso15924_tag(Tag::from_u32(script.as_iso15924_tag()))
}

/// Whether a script joins letters, which letter spacing would tear apart (CSS Text 3, "Cursive Scripts").
pub(crate) fn joins(script: Script) -> bool {
    matches!(
        script,
        Script::Arabic
            | Script::Hanifi_Rohingya
            | Script::Mandaic
            | Script::Mongolian
            | Script::Nko
            | Script::Phags_Pa
            | Script::Syriac
    )
}

/// Whether the first character with a direction is right-to-left (Unicode annex 9, rules P2 and P3).
pub(crate) fn starts_rtl(text: &str) -> bool {
    matches!(unicode_bidi::get_base_direction_full(text), unicode_bidi::Direction::Rtl)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split(line: &str, rtl: bool) -> Vec<(String, bool, Script)> {
        runs(line, rtl, None).into_iter().map(|r| (line[r.range].to_owned(), r.rtl, r.script)).collect()
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
        assert!(starts_rtl("12 ג a") && !starts_rtl("a ג") && !starts_rtl("1 2"));
    }
}
