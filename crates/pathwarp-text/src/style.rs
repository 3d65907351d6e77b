//! The style of a text, and its checks.

use crate::error::Error;
use crate::setting::Feature;
use unicode_script::Script;

/// The base direction of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Direction {
    /// The direction of the first character that has one, else left to right.
    #[default]
    Auto,
    /// Left to right.
    Ltr,
    /// Right to left.
    Rtl,
}

/// Alignment of lines within the width of the longest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Align {
    /// At the start: left, or right for right-to-left text.
    #[default]
    Start,
    /// Left.
    Left,
    /// Centred.
    Center,
    /// Right.
    Right,
    /// Justified: widens the spaces of every line that has any.
    Justify,
    /// Sized: every line is as large as makes its ink as wide as the widest line's.
    Fill,
}

/// Use of optional ligatures (`liga`, `clig`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Ligatures {
    /// On without letter spacing, which a ligature cannot follow.
    #[default]
    Auto,
    /// Always.
    On,
    /// Never. Required ligatures (`rlig`) are not affected.
    Off,
}

/// The style of a text. Lengths are in user units.
#[derive(Debug, Clone, PartialEq)]
pub struct TextStyle {
    /// Size of the em, greater than 0 and at most 1e6.
    pub size: f64,
    /// Space added between clusters, but not within joined scripts (Arabic, Syriac, …). Positive or negative, at most a thousand
    /// times the size.
    pub letter_spacing: f64,
    /// Space added to every space character. Positive or negative, at most a thousand times the size.
    pub word_spacing: f64,
    /// Distance between baselines, of lines that are sized by [`Align::Fill`] at their size; `None` for the font's (ascent + descent +
    /// line gap). At least 0, at most a thousand times the size.
    pub line_height: Option<f64>,
    /// Distance from the lower end of a line's ink to the upper end of the next one's, instead of a distance between baselines. Positive or
    /// negative, at most a thousand times the size.
    pub gap: Option<f64>,
    /// Alignment of lines.
    pub align: Align,
    /// Base direction of all lines.
    pub direction: Direction,
    /// Script of the text as an ISO 15924 code such as `Deva`; `None` to derive it from the characters.
    pub script: Option<String>,
    /// Language as a BCP 47 tag such as `sr` or `tr`; fonts have special letter forms for some.
    pub language: Option<String>,
    /// Kern pairs of letters.
    pub kerning: bool,
    /// Use of optional ligatures.
    pub ligatures: Ligatures,
    /// OpenType features, which override `kerning` and `ligatures`.
    pub features: Vec<Feature>,
}

impl Default for TextStyle {
    /// A size of 72 with the spacing of the font, aligned to the start.
    fn default() -> Self {
        Self {
            size: 72.0,
            letter_spacing: 0.0,
            word_spacing: 0.0,
            line_height: None,
            gap: None,
            align: Align::Start,
            direction: Direction::Auto,
            script: None,
            language: None,
            kerning: true,
            ligatures: Ligatures::Auto,
            features: Vec::new(),
        }
    }
}

/// Checks the numbers of a style and parses its script and language.
pub(crate) fn check(style: &TextStyle) -> Result<(Option<Script>, Option<harfrust::Language>), Error> {
    /// Largest size of the em.
    const LARGEST: f64 = 1e6;
    /// Largest length in units of the size.
    const FURTHEST: f64 = 1e3;
    let out_of_range = |property, value, range| Err(Error::Style { property, value, range });
    if !(style.size > 0.0 && style.size <= LARGEST) {
        return out_of_range("size", style.size, "greater than 0 and at most 1000000");
    }
    let far = |v: f64| v.is_nan() || v.abs() > FURTHEST * style.size;
    if far(style.letter_spacing) {
        return out_of_range("letter spacing", style.letter_spacing, "at most 1000 times the size");
    }
    if far(style.word_spacing) {
        return out_of_range("word spacing", style.word_spacing, "at most 1000 times the size");
    }
    if let Some(h) = style.line_height.filter(|h| far(*h) || *h < 0.0) {
        return out_of_range("line height", h, "at least 0 and at most 1000 times the size");
    }
    if let Some(gap) = style.gap.filter(|g| far(*g)) {
        return out_of_range("gap", gap, "at most 1000 times the size");
    }
    let script = style.script.as_deref().map(|code| {
        let mut letters = code.chars();
        let title: String = letters
            .next()
            .map(|c| c.to_ascii_uppercase())
            .into_iter()
            .chain(letters.map(|c| c.to_ascii_lowercase()))
            .collect();
        Script::from_short_name(&title)
            .ok_or_else(|| Error::setting(code, "is not a script code of ISO 15924, such as Latn, Arab or Deva"))
    });
    let language = style.language.as_deref().map(|tag| {
        let valid =
            tag.split('-').all(|part| (1..=8).contains(&part.len()) && part.bytes().all(|b| b.is_ascii_alphanumeric()));
        harfrust::Language::new(tag)
            .filter(|_| valid)
            .ok_or_else(|| Error::setting(tag, "is not a language tag of BCP 47, such as en, sr-Cyrl or tr"))
    });
    Ok((script.transpose()?, language.transpose()?))
}
