//! What can go wrong between the bytes of a font and its lettering.

use std::panic::{AssertUnwindSafe, catch_unwind};
use thiserror::Error;

/// Why there is no lettering.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// The bytes are no font that can be read.
    #[error("this is no font that can be read: {0}")]
    NotAFont(String),
    /// A collection has fewer fonts.
    #[error("there is no font {index} in this file; it holds {count}, counted from 0")]
    NoSuchFace {
        /// The one asked for.
        index: u32,
        /// How many there are.
        count: u32,
    },
    /// A variation names an axis that the font lacks.
    #[error("the font has no axis `{tag}`; {axes}")]
    NoSuchAxis {
        /// The axis asked for.
        tag: String,
        /// The axes there are, with their ranges, in words.
        axes: String,
    },
    /// A variation is outside its axis.
    #[error("{value} is outside the axis `{tag}`, which goes from {min} to {max}")]
    OutsideAxis {
        /// The axis.
        tag: String,
        /// The value asked for.
        value: f64,
        /// Its smallest value.
        min: f64,
        /// Its largest value.
        max: f64,
    },
    /// A setting has a form or a value it cannot have.
    #[error("`{value}` {problem}")]
    Setting {
        /// As it was written.
        value: String,
        /// What is wrong with it and what would be legal.
        problem: String,
    },
    /// A style has a number it cannot have.
    #[error("{what} of {value} is not possible; {legal}")]
    Style {
        /// What it is.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What would be legal.
        legal: &'static str,
    },
    /// No font was given.
    #[error("no font is given")]
    NoFont,
    /// There is nothing to set.
    #[error("there is no text to set: it is empty, or takes no room")]
    Empty,
    /// More text, or larger outlines, than is set.
    #[error("{0}; this is more than is set")]
    TooMuch(String),
    /// A glyph is damaged.
    #[error("glyph {glyph} of the font is damaged: {problem}")]
    Glyph {
        /// Its number.
        glyph: u32,
        /// What is wrong.
        problem: String,
    },
    /// The font made its reader or the shaper fail.
    #[error("the font is damaged: nothing can be set with it")]
    Failed,
}

impl Error {
    pub(crate) fn setting(value: &str, problem: impl Into<String>) -> Self {
        Self::Setting { value: value.to_owned(), problem: problem.into() }
    }
}

/// Runs what reads a font. The readers are made for hostile fonts, but they are not ours: should one panic, that is an error.
pub(crate) fn guarded<T>(read: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    catch_unwind(AssertUnwindSafe(read)).unwrap_or(Err(Error::Failed))
}
