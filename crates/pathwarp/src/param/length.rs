//! Lengths as typed: a number with a unit.

use super::number::{ValueError, split};
use super::{Axis, Frame};
use std::str::FromStr;
use thiserror::Error;

/// A length as typed. [`Length::in_units`] gives it in user units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Length {
    /// The number.
    pub value: f64,
    /// Its unit.
    pub unit: LengthUnit,
}

/// The unit of a length. Absolute units are CSS's: 96 px to the inch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
#[expect(missing_docs, reason = "the names say it")]
pub enum LengthUnit {
    /// None: user units of the drawing.
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

impl LengthUnit {
    /// The px that an absolute unit is long; `None` for user units and percentages.
    #[must_use]
    pub fn px(self) -> Option<f64> {
        Some(match self {
            Self::User | Self::Percent => return None,
            Self::Px => 1.0,
            Self::In => PX_PER_INCH,
            Self::Mm => PX_PER_INCH / 25.4,
            Self::Cm => PX_PER_INCH / 2.54,
            Self::M => PX_PER_INCH / 0.0254,
            Self::Q => PX_PER_INCH / 101.6,
            Self::Pt => PX_PER_INCH / 72.0,
            Self::Pc => PX_PER_INCH / 6.0,
        })
    }
}

impl Length {
    /// The length along `axis` in user units.
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

pub(super) fn parse(text: &str) -> Result<Length, ValueError> {
    let Some((value, unit)) = split(text) else {
        return Err(ValueError::NotALength);
    };
    let unit = match unit {
        "" => LengthUnit::User,
        "%" => LengthUnit::Percent,
        "px" => LengthUnit::Px,
        "mm" => LengthUnit::Mm,
        "cm" => LengthUnit::Cm,
        "m" => LengthUnit::M,
        "in" => LengthUnit::In,
        "pt" => LengthUnit::Pt,
        "pc" => LengthUnit::Pc,
        "q" | "Q" => LengthUnit::Q,
        _ => return Err(ValueError::UnknownLengthUnit(unit.to_owned())),
    };
    Ok(Length { value, unit })
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Rect;

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
