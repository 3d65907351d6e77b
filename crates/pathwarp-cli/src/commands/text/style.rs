//! The style options.

use crate::failure::Failure;
use clap::ArgMatches;
use pathwarp::kurbo::Rect;
use pathwarp::param::{Args, Axis, Frame, Length, LengthUnit, Settings};
use pathwarp_text::{Align, Direction, Ligatures, TextStyle, features};

/// The size of the em, and the unit that it and the whole page have.
pub(super) struct Em {
    pub(super) size: f64,
    /// `None`: px.
    pub(super) unit: Option<LengthUnit>,
    /// Percentages refer to it.
    frame: Frame,
}

impl Em {
    /// Reads `--size`. With a unit, user units of the page are that unit.
    pub(super) fn given(m: &ArgMatches) -> Result<Self, Failure> {
        let text = m.get_one::<String>("size").map(String::as_str);
        let typed = text.map(str::parse::<Length>).transpose();
        let typed = typed.map_err(|e| Failure::usage(format!("--size: `{}` {e}", text.unwrap_or_default())))?;
        let default = Length { value: TextStyle::default().size, unit: LengthUnit::User };
        let (size, unit) = match typed.unwrap_or(default) {
            Length { value, unit: LengthUnit::M } => (1000.0 * value, Some(LengthUnit::Mm)),
            Length { value, unit: LengthUnit::Q } => (0.25 * value, Some(LengthUnit::Mm)),
            Length { value, unit: LengthUnit::Percent } => (default.value * value / 100.0, None),
            Length { value, unit } => (value, Some(unit).filter(|u| u.px().is_some_and(|px| px != 1.0))),
        };
        let px = unit.and_then(LengthUnit::px).unwrap_or(1.0);
        let frame = Frame::new(Rect::new(0.0, 0.0, size, size)).with_units_per_px([1.0 / px; 2]);
        Ok(Self { size, unit, frame })
    }

    /// User units of the page per px.
    pub(super) fn units_per_px(&self) -> [f64; 2] {
        self.frame.units_per_px
    }

    /// The length given for the option `name`, in user units of the page.
    pub(super) fn length(&self, m: &ArgMatches, name: &str) -> Result<Option<f64>, Failure> {
        let Some(text) = m.get_one::<String>(name) else { return Ok(None) };
        let args = Args::new();
        Ok(Some(Settings::new(&[], &args, &self.frame)?.length_in(name, text, Axis::X)?))
    }
}

pub(super) fn style(m: &ArgMatches, em: &Em) -> Result<TextStyle, Failure> {
    let word = |name: &str| m.get_one::<String>(name).map(String::as_str);
    let mut all = Vec::new();
    for list in m.get_many::<String>("features").into_iter().flatten() {
        all.extend(features(list).map_err(|e| Failure::usage(format!("--features: {e}")))?);
    }
    Ok(TextStyle {
        size: em.size,
        letter_spacing: em.length(m, "letter-spacing")?.unwrap_or(0.0),
        word_spacing: em.length(m, "word-spacing")?.unwrap_or(0.0),
        line_height: em.length(m, "line-height")?,
        gap: em.length(m, "gap")?,
        align: match word("align") {
            Some("left") => Align::Left,
            Some("center") => Align::Center,
            Some("right") => Align::Right,
            Some("justify") => Align::Justify,
            Some("fill") => Align::Fill,
            None if m.contains_id("on") => Align::Center,
            _ => Align::Start,
        },
        direction: match word("direction") {
            Some("ltr") => Direction::Ltr,
            Some("rtl") => Direction::Rtl,
            _ => Direction::Auto,
        },
        script: word("script").map(str::to_owned),
        language: word("language").map(str::to_owned),
        kerning: word("kerning") != Some("off"),
        ligatures: match word("ligatures") {
            Some("on") => Ligatures::On,
            Some("off") => Ligatures::Off,
            _ => Ligatures::Auto,
        },
        features: all,
    })
}
