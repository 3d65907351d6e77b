//! The style options.

use crate::failure::Failure;
use clap::ArgMatches;
use pathwarp::kurbo::Rect;
use pathwarp::param::{Args, Axis, Frame, Settings};
use pathwarp_text::{Align, Direction, Ligatures, TextStyle, features};

pub(super) fn style(m: &ArgMatches) -> Result<TextStyle, Failure> {
    let word = |name: &str| m.get_one::<String>(name).map(String::as_str);
    let base = TextStyle::default();
    let size = length(m, "size", base.size)?.unwrap_or(base.size);
    let mut all = Vec::new();
    for list in m.get_many::<String>("features").into_iter().flatten() {
        all.extend(features(list).map_err(|e| Failure::usage(format!("--features: {e}")))?);
    }
    Ok(TextStyle {
        size,
        letter_spacing: length(m, "letter-spacing", size)?.unwrap_or(0.0),
        word_spacing: length(m, "word-spacing", size)?.unwrap_or(0.0),
        line_height: length(m, "line-height", size)?,
        align: match word("align") {
            Some("left") => Align::Left,
            Some("center") => Align::Center,
            Some("right") => Align::Right,
            Some("justify") => Align::Justify,
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

/// The length given for the option `name`; percentages refer to `size`.
pub(super) fn length(m: &ArgMatches, name: &str, size: f64) -> Result<Option<f64>, Failure> {
    let Some(text) = m.get_one::<String>(name) else { return Ok(None) };
    let frame = Frame::new(Rect::new(0.0, 0.0, size, size));
    let args = Args::new();
    Ok(Some(Settings::new(&[], &args, &frame)?.length_in(name, text, Axis::X)?))
}
