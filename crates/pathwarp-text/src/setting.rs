//! Font features and variations, and their text form: `liga=0,ss01` and `wght=600`.

use crate::error::Error;
use skrifa::Tag;
use std::fmt;

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
    /// The tag is not four printable ASCII characters.
    pub fn new(tag: &str, value: u32) -> Result<Self, Error> {
        Ok(Self { tag: self::tag(tag, tag)?, value })
    }
}

impl Variation {
    /// Creates a position on an axis, in units of the axis.
    ///
    /// # Errors
    /// The tag is not four printable ASCII characters, or the value is not finite.
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

/// Parses OpenType features separated by commas: `liga=0, ss01, salt=2`. `on` and `off` mean 1 and 0, as does a sign in front
/// (`-liga`).
///
/// ```
/// let f = pathwarp_text::features("liga=0, ss01, -kern")?;
/// assert_eq!(f.iter().map(ToString::to_string).collect::<Vec<_>>(), ["liga=0", "ss01=1", "kern=0"]);
/// assert!(pathwarp_text::features("ligatures").is_err());
/// # Ok::<(), pathwarp_text::Error>(())
/// ```
///
/// # Errors
/// A tag is not four characters long, or a value is neither a whole number nor `on` or `off`.
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
/// A word is not of the form `axis=number`.
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

/// Splits a list at commas.
fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(',').map(str::trim).filter(|w| !w.is_empty())
}

/// Parses a tag; `word` is the setting for the error message.
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
