//! Finds fonts for letters that the fonts of a text lack, in the order of fontconfig and Chromium.

use super::faces::{BUNDLED, DISPLAY, Look};
use pathwarp_text::Writing;
use skrifa::{FontRef, MetadataProvider as _};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use usvg::fontdb::{Database, FaceInfo, ID, Source};

/// Letters that a text needs.
#[derive(Clone, Copy)]
pub(super) struct Wanted<'a> {
    pub(super) letters: &'a str,
    pub(super) writing: Writing,
    /// The language as a BCP 47 tag; empty if unknown.
    pub(super) language: &'a str,
    pub(super) look: Look,
}

/// Finds a font for letters that is not used yet: of a general family, or else of a family for the writing, or else of any; and of a
/// family, the face that looks most like the text.
pub(super) fn fallback(wanted: &Wanted<'_>, used: &[ID], db: &Database) -> Option<ID> {
    let look = wanted.look;
    let difference = |f: &FaceInfo| {
        (f.style != look.style, f.stretch != look.stretch, f.weight.0.abs_diff(look.weight.0), f.weight.0)
    };
    let (script, region) = (wanted.writing.name(), region(wanted.language));
    let specific = [format!("Noto Sans {script}"), format!("Noto Sans CJK {region}"), format!("Noto Sans {region}")];
    let emoji = wanted.writing == Writing::Emoji;
    let rank = |f: &FaceInfo| if is_bundled(f) { LAST } else { rank(family(f), &specific, emoji) };
    let mut all: Vec<&FaceInfo> = db.faces().filter(|f| !used.contains(&f.id)).collect();
    // The sort is stable, so the first of several equal faces wins.
    all.sort_by(|a, b| (rank(a), family(a), difference(a)).cmp(&(rank(b), family(b), difference(b))));
    all.into_iter().map(|f| f.id).find(|id| wanted.letters.chars().all(|c| has_letter(*id, c, db)))
}

/// The first family name of a face.
fn family(face: &FaceInfo) -> &str {
    face.families.first().map_or("", |(name, _)| name)
}

/// The rank of the bundled fonts, after all others.
const LAST: usize = 100;

/// The rank of a family for a writing with `specific` families (fontconfig's `60-latin.conf`; names of the Noto families): the lower, the
/// sooner it is tried.
fn rank(family: &str, specific: &[String; 3], emoji: bool) -> usize {
    const GENERAL: [&str; 7] =
        ["Noto Sans", "DejaVu Sans", "Verdana", "Arial", "Liberation Sans", "Helvetica", "Tahoma"];
    let is_kind = |words: &[&str]| words.iter().any(|w| family.contains(w));
    if emoji && family.contains("Emoji") {
        return 0;
    }
    let known = GENERAL.into_iter().chain(specific.iter().map(String::as_str)).position(|f| f == family);
    match known {
        Some(position) => 1 + position,
        None if is_kind(&["Mono", "Math", "Symbols", "Serif", "UI"]) => 60,
        None if family.starts_with("Noto Sans") => 40,
        None => 50,
    }
}

/// The suffix of Noto's families for the Chinese characters of a language; without a language, Japanese, as in fontconfig.
fn region(language: &str) -> &'static str {
    let language = language.to_ascii_lowercase();
    let has = |part: &str| language.split('-').any(|p| p == part);
    match language.split('-').next() {
        Some("ko") => "KR",
        Some("zh" | "yue") if has("hk") || has("mo") || has("yue") => "HK",
        Some("zh") if has("tw") || has("hant") => "TC",
        Some("zh") => "SC",
        _ => "JP",
    }
}

/// Returns `true` for the bundled fonts.
fn is_bundled(face: &FaceInfo) -> bool {
    matches!(&face.source, Source::Binary(data) if [BUNDLED, DISPLAY].contains(&data.as_ref().as_ref()))
}

/// The letters of a font, as sorted ranges.
type Letters = Vec<RangeInclusive<u32>>;

/// Returns `true` if a font can show a letter.
fn has_letter(face: ID, letter: char, db: &Database) -> bool {
    // Joiners, direction marks and variation selectors need no glyph.
    if matches!(letter, '\u{200c}'..='\u{200f}' | '\u{fe00}'..='\u{fe0f}') {
        return true;
    }
    let asked = |data: &[u8], index: u32| Some(FontRef::from_index(data, index).ok()?.charmap().map(letter).is_some());
    match db.face(face).map(|f| (&f.source, f.index)) {
        Some((Source::File(path), index)) => {
            let letters = letters_of(path, index, || db.with_face_data(face, letters_in).unwrap_or_default());
            let (letter, after) = (u32::from(letter), letters.partition_point(|r| *r.start() <= u32::from(letter)));
            after > 0 && letters[after - 1].contains(&letter)
        }
        _ => db.with_face_data(face, asked).flatten().unwrap_or(false),
    }
}

/// The letters that `read` finds in a font file, cached. A drawing may look for thousands of letters in all fonts, and opening a file
/// takes longer than the search.
fn letters_of(path: &Path, index: u32, read: impl FnOnce() -> Letters) -> Arc<Letters> {
    static KNOWN: Mutex<BTreeMap<(PathBuf, u32), Arc<Letters>>> = Mutex::new(BTreeMap::new());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    known.entry((path.to_owned(), index)).or_insert_with(|| Arc::new(read())).clone()
}

/// The letters of a font file.
fn letters_in(data: &[u8], index: u32) -> Letters {
    let Ok(font) = FontRef::from_index(data, index) else { return Letters::new() };
    let mut all: Vec<u32> = font.charmap().mappings().map(|(letter, _)| letter).collect();
    all.sort_unstable();
    let mut out = Letters::new();
    for letter in all {
        match out.last_mut() {
            Some(last) if letter <= last.end() + 1 => *last = *last.start()..=letter,
            _ => out.push(letter..=letter),
        }
    }
    out
}
