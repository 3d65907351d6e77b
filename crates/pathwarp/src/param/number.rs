//! Numbers with a unit behind them, and the errors of values.

use thiserror::Error;

/// Text that is not a value of the expected kind. Messages continue a sentence that begins with the text.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub(super) enum ValueError {
    #[error("is not a number")]
    NotANumber,
    #[error("has the unit `{0}`, but must be a plain number or a percentage")]
    UnexpectedUnit(String),
    #[error("is not a whole number")]
    NotWhole,
    #[error("is not a length, such as 12, 3mm or 50%")]
    NotALength,
    #[error("has the unknown unit `{0}`; use px, mm, cm, m, in, pt, pc, q or %")]
    UnknownLengthUnit(String),
    #[error("is not an angle, such as 30 or 0.5turn")]
    NotAnAngle,
    #[error("has the unknown unit `{0}`; use deg, rad, grad or turn")]
    UnknownAngleUnit(String),
    #[error("has {found} numbers instead of {expected}")]
    WrongCount { found: usize, expected: usize },
    #[error("is not a point x,y")]
    NotAPoint,
    #[error("is neither a box x,y,w,h nor the word artwork")]
    NotABox,
    #[error("has no area")]
    NoArea,
    /// One word of several has the error.
    #[error("contains `{word}`, which {error}")]
    In { word: String, error: Box<Self> },
}

/// Splits a number from its unit: `12.5mm` into 12.5 and `mm`.
pub(super) fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    // The longest prefix that is a number: the `e` of an exponent belongs to it, the `e` of a unit does not.
    (1..=text.len())
        .rev()
        .filter(|&n| text.is_char_boundary(n))
        .find_map(|n| text[..n].parse::<f64>().ok().filter(|v| v.is_finite()).map(|v| (v, text[n..].trim_start())))
}
