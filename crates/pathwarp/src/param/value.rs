//! Parsing of values: numbers, lengths and angles with units, points and boxes.

use super::{Axis, Frame};
use kurbo::{Point, Rect, Size};
use std::str::FromStr;
use thiserror::Error;

/// Reads a plain number or a percentage.
pub(super) fn number(text: &str) -> Result<f64, ValueError> {
    match split(text) {
        Some((v, "")) => Ok(v),
        Some((v, "%")) => Ok(v / 100.0),
        Some((_, unit)) => Err(ValueError::UnexpectedUnit(unit.to_owned())),
        None => Err(ValueError::NotANumber),
    }
}

/// Reads a whole number.
pub(super) fn count(text: &str) -> Result<f64, ValueError> {
    match split(text) {
        Some((v, "")) if v.fract() == 0.0 => Ok(v),
        _ => Err(ValueError::NotWhole),
    }
}

/// Reads a length, in user units.
pub(super) fn length(text: &str, axis: Axis, frame: &Frame) -> Result<f64, ValueError> {
    Ok(parse(text)?.in_units(axis, frame))
}

/// Reads an angle, in degrees.
pub(super) fn angle(text: &str) -> Result<f64, ValueError> {
    let (v, unit) = split(text).ok_or(ValueError::NotAnAngle)?;
    match unit {
        "" | "deg" | "°" => Ok(v),
        "rad" => Ok(v.to_degrees()),
        "grad" => Ok(v * 0.9),
        "turn" => Ok(v * 360.0),
        _ => Err(ValueError::UnknownAngleUnit(unit.to_owned())),
    }
}

/// Reads `expected` numbers, separated by commas, white space or both.
pub(super) fn numbers(text: &str, expected: usize) -> Result<Vec<f64>, ValueError> {
    let parse = |word: &str| match split(word) {
        Some((v, "")) => Ok(v),
        _ => Err(in_word(word, ValueError::NotANumber)),
    };
    let out: Vec<f64> = words(text).map(parse).collect::<Result<_, _>>()?;
    if out.len() == expected { Ok(out) } else { Err(ValueError::WrongCount { found: out.len(), expected }) }
}

/// Names the word of several that has an error.
fn in_word(word: &str, error: ValueError) -> ValueError {
    ValueError::In { word: word.to_owned(), error: Box::new(error) }
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| c == ',' || c.is_whitespace()).filter(|w| !w.is_empty())
}

/// Reads a point. Percentages count from the left and top of the frame.
pub(super) fn point(text: &str, frame: &Frame) -> Result<Point, ValueError> {
    let [x, y] = words(text).collect::<Vec<_>>()[..] else { return Err(ValueError::NotAPoint) };
    let coordinate =
        |t: &str, axis, origin: f64| length(t, axis, frame).map(|v| if t.ends_with('%') { origin + v } else { v });
    Ok(Point::new(coordinate(x, Axis::X, frame.rect.x0)?, coordinate(y, Axis::Y, frame.rect.y0)?))
}

/// Reads a box `x,y,w,h`. Percentages count from the left and top of the frame, or are of its width and height.
pub(super) fn rect(text: &str, frame: &Frame) -> Result<Rect, ValueError> {
    let [x, y, w, h] = words(text).collect::<Vec<_>>()[..] else { return Err(ValueError::NotABox) };
    let origin = point(&format!("{x},{y}"), frame)?;
    let (w, h) = (length(w, Axis::X, frame)?, length(h, Axis::Y, frame)?);
    if w > 0.0 && h > 0.0 { Ok(Rect::from_origin_size(origin, Size::new(w, h))) } else { Err(ValueError::NoArea) }
}

/// Returns `true` if a path reference consists of points `x,y x,y …` and is not a name: every word is a pair of coordinates.
pub(super) fn looks_like_points(text: &str) -> bool {
    let unit = Frame::new(Rect::new(0.0, 0.0, 1.0, 1.0));
    text.contains(',') && points(text, &unit).is_ok()
}

/// Reads points `x,y x,y …`, separated by white space or semicolons.
pub(super) fn points(text: &str, frame: &Frame) -> Result<Vec<Point>, ValueError> {
    let pairs = text.split(|c: char| c == ';' || c.is_whitespace()).filter(|w| !w.is_empty());
    pairs.map(|w| point(w, frame).map_err(|e| in_word(w, e))).collect()
}

/// A length as typed. [`Length::in_units`] gives it in user units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Length {
    /// The number.
    pub value: f64,
    /// Its unit.
    pub unit: LengthUnit,
}

/// The unit of a length. Absolute units are those of CSS, with 96 px to the inch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the names say it")]
pub enum LengthUnit {
    /// User units of the drawing, without a suffix.
    User,
    /// Percent of the frame.
    Percent,
    Px,
    Mm,
    Cm,
    M,
    In,
    Pt,
    Pc,
    /// Quarter millimetres.
    Q,
}

const PX_PER_INCH: f64 = 96.0;

/// The suffixes of the units, and the lengths of absolute ones in px.
const UNITS: [(&str, LengthUnit, Option<f64>); 10] = [
    ("", LengthUnit::User, None),
    ("%", LengthUnit::Percent, None),
    ("px", LengthUnit::Px, Some(1.0)),
    ("mm", LengthUnit::Mm, Some(PX_PER_INCH / 25.4)),
    ("cm", LengthUnit::Cm, Some(PX_PER_INCH / 2.54)),
    ("m", LengthUnit::M, Some(PX_PER_INCH / 0.0254)),
    ("in", LengthUnit::In, Some(PX_PER_INCH)),
    ("pt", LengthUnit::Pt, Some(PX_PER_INCH / 72.0)),
    ("pc", LengthUnit::Pc, Some(PX_PER_INCH / 6.0)),
    ("q", LengthUnit::Q, Some(PX_PER_INCH / 101.6)),
];

impl LengthUnit {
    /// Returns the length of an absolute unit in px; `None` for user units and percentages.
    #[must_use]
    pub fn px(self) -> Option<f64> {
        UNITS.iter().find(|(_, unit, _)| *unit == self)?.2
    }
}

impl Length {
    /// Returns the length along `axis` in user units.
    #[must_use]
    pub fn in_units(&self, axis: Axis, frame: &Frame) -> f64 {
        let unit = match self.unit {
            LengthUnit::Percent => frame.extent(axis) / 100.0,
            unit => unit.px().map_or(1.0, |px| px * frame.px(axis)),
        };
        self.value * unit
    }
}

/// Text that is not a length. The message continues a sentence that begins with the text.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(transparent)]
pub struct LengthError(ValueError);

impl FromStr for Length {
    type Err = LengthError;

    fn from_str(text: &str) -> Result<Self, LengthError> {
        parse(text).map_err(LengthError)
    }
}

/// Reads a length as typed.
fn parse(text: &str) -> Result<Length, ValueError> {
    let (value, unit) = split(text).ok_or(ValueError::NotALength)?;
    let is_unit = |suffix: &str| suffix == unit || (suffix, unit) == ("q", "Q");
    let known = UNITS.iter().find(|(suffix, ..)| is_unit(suffix));
    let (_, unit, _) = known.ok_or_else(|| ValueError::UnknownLengthUnit(unit.to_owned()))?;
    Ok(Length { value, unit: *unit })
}

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
    #[error("has no area; give it a width and a height above 0")]
    NoArea,
    /// An error in one word of several.
    #[error("contains `{word}`, which {error}")]
    In { word: String, error: Box<Self> },
}

/// Splits a number from its unit: `12.5mm` into 12.5 and `mm`.
pub(super) fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    // The longest prefix that is a number includes the `e` of an exponent, but not that of a unit.
    let mut prefixes = (1..=text.len()).rev().filter_map(|n| text.split_at_checked(n));
    prefixes.find_map(|(number, unit)| Some((number.parse().ok().filter(|v: &f64| v.is_finite())?, unit.trim_start())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units() {
        let f = Frame::new(Rect::new(10.0, 20.0, 110.0, 70.0));
        assert_eq!(length("25.4mm", Axis::X, &f), Ok(96.0));
        assert_eq!(length("50%", Axis::Y, &f), Ok(25.0));
        assert_eq!(length("1e1", Axis::Y, &f), Ok(10.0));
        assert_eq!(angle("0.25turn"), Ok(90.0));
        assert_eq!(number("-20%"), Ok(-0.2));
        assert_eq!(point("50%,100%", &f), Ok(Point::new(60.0, 70.0)));
        assert_eq!(points("1,2 3,4;5,6", &f).unwrap().len(), 3);
        assert_eq!(rect("50%,20,10%,10%", &f), Ok(Rect::new(60.0, 20.0, 70.0, 25.0)));
        assert!(rect("0,0,0,5", &f).is_err() && rect("1,2,3", &f).is_err());
        assert!(length("3 parsecs", Axis::X, &f).unwrap_err().to_string().contains("parsecs"));
        assert!(number("nan").is_err() && number("inf").is_err() && number("").is_err());
        assert!(count("1.5").is_err());
    }

    #[test]
    fn points_differ_from_names() {
        assert!(looks_like_points("0,0 10%,5mm"));
        assert!(!looks_like_points("cage.svg") && !looks_like_points("4,5.svg") && !looks_like_points("M0,0 L1,1"));
    }

    #[test]
    fn absolute_units_follow_the_scale_of_the_drawing() {
        // 100 mm wide and 50 mm high, in units of 1 mm across and 2 mm down.
        let px = 25.4 / 96.0;
        let frame = Frame::new(Rect::new(0.0, 0.0, 80.0, 20.0)).with_units_per_px([px, px / 2.0]);
        let units = |text: &str, axis| text.parse::<Length>().unwrap().in_units(axis, &frame);
        for (text, axis, wanted) in [
            ("10mm", Axis::X, 10.0),
            ("10mm", Axis::Y, 5.0),
            ("1in", Axis::X, 25.4),
            ("96px", Axis::X, 25.4),
            ("4Q", Axis::X, 1.0),
            ("10", Axis::Y, 10.0),
            ("50%", Axis::X, 40.0),
            ("8mm", Axis::Diagonal, (0.5 * (64.0 + 16.0_f64)).sqrt()),
        ] {
            assert!((units(text, axis) - wanted).abs() < 1e-12, "{text} {axis:?}: {}", units(text, axis));
        }
    }
}
