//! Errors of fonts and lettering.

use crate::metrics::FontAxis;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use thiserror::Error;

/// The reason why text cannot be set.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// The bytes are not a readable font.
    #[error("not a readable font: {0}")]
    NotAFont(String),
    /// The file has no font with this index.
    #[error("the file has no font {index}; it has {count}, counted from 0")]
    NoSuchFace {
        /// Requested index.
        index: u32,
        /// Number of fonts.
        count: u32,
    },
    /// A variation names an axis that the font lacks.
    #[error("the font has no axis `{tag}`; {}", list(axes))]
    NoSuchAxis {
        /// Requested axis.
        tag: String,
        /// Axes of the font; empty if it is not a variable font.
        axes: Vec<FontAxis>,
    },
    /// The value of a variation is out of range.
    #[error("{value} is out of range for the axis `{tag}`, which goes from {min} to {max}")]
    OutsideAxis {
        /// Axis.
        tag: String,
        /// Requested value.
        value: f64,
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// A setting (feature, variation, script or language) is malformed or has an invalid value.
    #[error("`{value}` {problem}")]
    Setting {
        /// The setting as written.
        value: String,
        /// The rest of the sentence that the setting begins.
        problem: String,
    },
    /// A property of the style is out of range.
    #[error("{property} {value} is out of range: it must be {range}")]
    Style {
        /// Name of the property.
        property: &'static str,
        /// Its value.
        value: f64,
        /// Valid range in words.
        range: &'static str,
    },
    /// The list of fonts is empty.
    #[error("no font given")]
    NoFont,
    /// The text is empty or has no extent.
    #[error("no text to set: it is empty or has no extent")]
    Empty,
    /// The text or its outlines exceed a limit.
    #[error("the text has at least {needed} {quantity}, and the limit is {most}")]
    TooLarge {
        /// The limited quantity.
        quantity: Quantity,
        /// The amount needed, or counted when work stopped.
        needed: usize,
        /// The limit.
        most: usize,
    },
    /// A glyph is damaged.
    #[error("glyph {glyph} of the font is damaged: {problem}")]
    Glyph {
        /// Number of the glyph.
        glyph: u32,
        /// Description of the problem.
        problem: String,
    },
    /// The font makes its reader or the shaper panic.
    #[error("the font is damaged and cannot be used")]
    Failed,
}

/// A limited quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Letters of the text.
    Letters,
    /// Glyphs that the fonts make of the letters.
    Glyphs,
    /// Segments of the outlines.
    Segments,
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Letters => "letters",
            Self::Glyphs => "glyphs",
            Self::Segments => "segments",
        })
    }
}

impl Error {
    pub(crate) fn setting(value: &str, problem: impl Into<String>) -> Self {
        Self::Setting { value: value.to_owned(), problem: problem.into() }
    }
}

/// Lists axes with their ranges.
fn list(axes: &[FontAxis]) -> String {
    if axes.is_empty() {
        return "it is not a variable font".into();
    }
    let all: Vec<String> = axes.iter().map(|a| format!("{} ({} to {})", a.tag, a.min, a.max)).collect();
    format!("its axes are {}", all.join(", "))
}

/// Runs code that reads a font and turns a panic into an error. The external readers are made for hostile fonts, but this crate
/// cannot guarantee that they never panic.
pub(crate) fn guarded<T>(read: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    catch_unwind(AssertUnwindSafe(read)).unwrap_or(Err(Error::Failed))
}
