//! The style of a text: alignment, spacing, font features and variations, with checks and text forms.

use crate::error::Error;
use skrifa::Tag;
use std::fmt;
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
    /// Scaled, so that the ink of every line is as wide as the ink of the widest line.
    Fill,
}

/// Use of optional ligatures (`liga`, `clig`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Ligatures {
    /// On unless there is letter spacing, which cannot be applied within a ligature.
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
    /// times the size; a cluster moves back at most to the start of the one before it.
    pub letter_spacing: f64,
    /// Space added to every space character. Positive or negative, at most a thousand times the size.
    pub word_spacing: f64,
    /// Distance between baselines, which scales with lines that [`Align::Fill`] scales; `None` for the font's (ascent + descent + line
    /// gap). At least 0, at most a thousand times the size.
    pub line_height: Option<f64>,
    /// Distance from the lower end of a line's ink to the upper end of the next line's ink, instead of a distance between baselines.
    /// Positive or negative, at most a thousand times the size.
    pub gap: Option<f64>,
    /// Alignment of lines.
    pub align: Align,
    /// Base direction of all lines.
    pub direction: Direction,
    /// Script of the text as an ISO 15924 code such as `Deva`; `None` to derive it from the characters.
    pub script: Option<String>,
    /// Language as a BCP 47 tag such as `sr` or `tr`; fonts have special letter forms for some.
    pub language: Option<String>,
    /// `true` to kern pairs of letters.
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
    const MAX_SIZE: f64 = 1e6;
    /// Largest length in units of the size.
    const MAX_LENGTH: f64 = 1e3;
    let out_of_range = |property, value, range| Err(Error::Style { property, value, range });
    if !(style.size > 0.0 && style.size <= MAX_SIZE) {
        return out_of_range("size", style.size, "greater than 0 and at most 1000000");
    }
    let too_long = |v: f64| v.is_nan() || v.abs() > MAX_LENGTH * style.size;
    if too_long(style.letter_spacing) {
        return out_of_range("letter spacing", style.letter_spacing, "at most 1000 times the size");
    }
    if too_long(style.word_spacing) {
        return out_of_range("word spacing", style.word_spacing, "at most 1000 times the size");
    }
    if let Some(h) = style.line_height.filter(|h| too_long(*h) || *h < 0.0) {
        return out_of_range("line height", h, "at least 0 and at most 1000 times the size");
    }
    if let Some(gap) = style.gap.filter(|g| too_long(*g)) {
        return out_of_range("gap", gap, "at most 1000 times the size");
    }
    let script = style.script.as_deref().map(|code| {
        let mut capitalized = code.to_ascii_lowercase();
        capitalized.get_mut(..1).into_iter().for_each(str::make_ascii_uppercase);
        Script::from_short_name(&capitalized)
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

/// An OpenType feature and its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Feature {
    pub(crate) tag: Tag,
    pub(crate) value: u32,
}

/// A position on an axis of a variable font.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variation {
    pub(crate) tag: Tag,
    pub(crate) value: f64,
}

impl Feature {
    /// Creates a feature: 0 turns it off, 1 on, and larger values choose among alternatives.
    ///
    /// # Errors
    /// [`Error::Setting`] when the tag is not four printable ASCII characters.
    pub fn new(tag: &str, value: u32) -> Result<Self, Error> {
        Ok(Self { tag: self::tag(tag, tag)?, value })
    }
}

impl Variation {
    /// Creates a position on an axis, in units of the axis.
    ///
    /// # Errors
    /// [`Error::Setting`] when the tag is not four printable ASCII characters, or the value is not finite.
    pub fn new(tag: &str, value: f64) -> Result<Self, Error> {
        if !value.is_finite() {
            return Err(Error::setting(tag, "has a value that is not finite"));
        }
        Ok(Self { tag: self::tag(tag, tag)?, value })
    }
}

impl fmt::Display for Feature {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.tag, self.value)
    }
}

impl fmt::Display for Variation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.tag, self.value)
    }
}

/// Parses OpenType features separated by commas: `liga=0, ss01, salt=2`. `on` and `off` mean 1 and 0, as do `+` and `-` in
/// front (`-liga`); a value overrides the sign.
///
/// ```
/// let f = pathwarp_text::features("liga=0, ss01, -kern")?;
/// assert_eq!(f.iter().map(ToString::to_string).collect::<Vec<_>>(), ["liga=0", "ss01=1", "kern=0"]);
/// assert!(pathwarp_text::features("ligatures").is_err());
/// # Ok::<(), pathwarp_text::Error>(())
/// ```
///
/// # Errors
/// [`Error::Setting`] when a tag is not four characters long, or a value is neither a whole number nor `on` or `off`.
pub fn features(text: &str) -> Result<Vec<Feature>, Error> {
    let parse = |word: &str| {
        let (name, value) = match word.split_once('=') {
            Some((name, value)) => (name.trim(), Some(value.trim())),
            None => (word, None),
        };
        let (name, sign) = match name.strip_prefix('-') {
            Some(rest) => (rest, 0),
            None => (name.strip_prefix('+').unwrap_or(name), 1),
        };
        let value = match value {
            None => sign,
            Some("on") => 1,
            Some("off") => 0,
            Some(n) => n
                .parse()
                .map_err(|_| Error::setting(word, "must have a whole number, on or off as its value, as in liga=0"))?,
        };
        Ok(Feature { tag: tag(name, word)?, value })
    };
    words(text).map(parse).collect()
}

/// Parses positions on axes separated by commas: `wght=600, wdth=75`.
///
/// ```
/// let v = pathwarp_text::variations("wght=600, wdth=87.5")?;
/// assert_eq!(v.iter().map(ToString::to_string).collect::<Vec<_>>(), ["wght=600", "wdth=87.5"]);
/// # Ok::<(), pathwarp_text::Error>(())
/// ```
///
/// # Errors
/// [`Error::Setting`] when a word is not of the form `axis=number`.
pub fn variations(text: &str) -> Result<Vec<Variation>, Error> {
    let parse = |word: &str| {
        let parts = word.split_once('=').map(|(name, value)| (name.trim(), value.trim().parse::<f64>()));
        match parts {
            Some((name, Ok(value))) if value.is_finite() => Ok(Variation { tag: tag(name, word)?, value }),
            _ => Err(Error::setting(word, "is not an axis with a value, such as wght=600")),
        }
    };
    words(text).map(parse).collect()
}

/// Returns the items between a list's commas, trimmed, without empty ones.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(',').map(str::trim).filter(|w| !w.is_empty())
}

/// Parses the tag `name`; the error shows `word`, the whole setting.
fn tag(name: &str, word: &str) -> Result<Tag, Error> {
    let plain = name.len() == 4 && name.bytes().all(|b| (b' '..=b'~').contains(&b));
    let tag = plain.then(|| Tag::new_checked(name.as_bytes()).ok()).flatten();
    tag.ok_or_else(|| Error::setting(word, "does not start with a tag of four characters, such as liga, ss01 or wght"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_the_setting() {
        for (text, message) in
            [("liga=no", "`liga=no`"), ("liga=1,éa12", "`éa12`"), ("lig", "`lig`"), ("kern=-1", "whole")]
        {
            assert!(features(text).unwrap_err().to_string().contains(message), "{text}");
        }
        for text in ["wght", "wght=", "wght=nan", "weight=600", "wght:600"] {
            assert!(variations(text).unwrap_err().to_string().contains(text), "{text}");
        }
        assert!(features("").unwrap().is_empty() && variations(" , ").unwrap().is_empty());
        assert_eq!(features("smcp=off,salt=3,+dlig").unwrap().iter().map(|f| f.value).collect::<Vec<_>>(), [0, 3, 1]);
    }
}
