//! The style: size, spacing, and fonts, found by file or family, with their weights and variations.

use clap::ArgMatches;
use pathwarp::kurbo::Rect;
use pathwarp::param::{Args, Axis, Frame, Length, LengthUnit, Settings};
use pathwarp_engine::failure::Failure;
use pathwarp_engine::weights::{WEIGHTS, Wanted};
use pathwarp_svg::ReadOptions;
use pathwarp_svg::engine::family_styles;
use pathwarp_text::{Align, Direction, Font, Ligatures, TextStyle, Variation, features, variations};

/// The size of the em in user units of the page, and the unit of both.
pub(super) struct Em {
    pub(super) size: f64,
    /// `None` for px.
    pub(super) unit: Option<LengthUnit>,
    /// The frame that percentages refer to.
    frame: Frame,
}

impl Em {
    /// Reads `--size`, or another option that determines the unit of the page's user units.
    pub(super) fn given(m: &ArgMatches, name: &str, default: f64) -> Result<Self, Failure> {
        let text = word(m, name);
        let typed = text.map(str::parse::<Length>).transpose();
        let typed = typed.map_err(|e| Failure::usage(format!("--{name}: `{}` {e}", text.unwrap_or_default())))?;
        let default = Length { value: default, unit: LengthUnit::User };
        let (size, unit) = match typed.unwrap_or(default) {
            Length { value, unit: LengthUnit::M } => (1000.0 * value, Some(LengthUnit::Mm)),
            Length { value, unit: LengthUnit::Q } => (0.25 * value, Some(LengthUnit::Mm)),
            Length { value, unit: LengthUnit::Percent } => (default.value * value / 100.0, None),
            Length { value, unit } => (value, Some(unit).filter(|u| u.px().is_some_and(|px| px != 1.0))),
        };
        let px = unit.and_then(LengthUnit::px).unwrap_or(1.0);
        Ok(Self { size: 0.0, unit, frame: Frame::new(Rect::ZERO).with_units_per_px([1.0 / px; 2]) }.resized(size))
    }

    /// Returns another size on the same page.
    pub(super) fn resized(&self, size: f64) -> Self {
        let frame = Frame { rect: Rect::new(0.0, 0.0, size, size), ..self.frame.clone() };
        Self { size, unit: self.unit, frame }
    }

    /// Returns the user units of the page per px.
    pub(super) fn units_per_px(&self) -> [f64; 2] {
        self.frame.units_per_px
    }

    /// Returns the length given for the option `name`, in user units of the page.
    pub(super) fn length(&self, m: &ArgMatches, name: &str) -> Result<Option<f64>, Failure> {
        let Some(text) = word(m, name) else { return Ok(None) };
        let args = Args::new();
        Ok(Some(Settings::new(&[], &args, &self.frame)?.length_in(name, text, Axis::X)?))
    }
}

/// Returns the value of an option that the command may lack.
fn word<'m>(m: &'m ArgMatches, name: &str) -> Option<&'m str> {
    m.try_get_one::<String>(name).ok().flatten().map(String::as_str)
}

/// Reads the options for the style.
pub(super) fn style(m: &ArgMatches, em: &Em) -> Result<TextStyle, Failure> {
    /// Distance between lines in a shape, as a share of the size.
    const GAP: f64 = 0.06;
    let word = |name: &str| word(m, name);
    let lists = m.get_many::<String>("features").into_iter().flatten().map(|list| features(list));
    let lists: Vec<Vec<_>> = lists.collect::<Result<_, _>>().map_err(|e| Failure::usage(format!("--features: {e}")))?;
    let gap = (word("in").is_some() && word("line-height").is_none()).then_some(GAP * em.size);
    Ok(TextStyle {
        size: em.size,
        letter_spacing: em.length(m, "letter-spacing")?.unwrap_or(0.0),
        word_spacing: em.length(m, "word-spacing")?.unwrap_or(0.0),
        line_height: em.length(m, "line-height")?,
        gap: em.length(m, "gap")?.or(gap),
        align: match word("align") {
            Some("left") => Align::Left,
            Some("center") => Align::Center,
            Some("right") => Align::Right,
            Some("justify") => Align::Justify,
            Some("fill") => Align::Fill,
            None if word("on").is_some() => Align::Center,
            None if word("in").is_some() => Align::Fill,
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
        features: lists.concat(),
    })
}

/// Parses a weight: a number or a name.
pub(super) fn weight_of(text: &str) -> Result<u16, Failure> {
    let named = WEIGHTS.iter().find(|(name, _)| text.eq_ignore_ascii_case(name)).map(|(_, w)| *w);
    let weight = named.or_else(|| text.parse().ok()).filter(|w| (1..=1000).contains(w));
    weight.ok_or_else(|| {
        let names: Vec<&str> = WEIGHTS.iter().map(|(name, _)| *name).collect();
        Failure::usage(format!("--weight: `{text}` is neither a number from 1 to 1000 nor one of {}", names.join(", ")))
    })
}

/// Returns the positions on variation axes given by `--variation`.
pub(super) fn axis_positions(m: &ArgMatches) -> Result<Vec<Variation>, Failure> {
    let lists = m.get_many::<String>("variation").into_iter().flatten().map(|list| variations(list));
    let lists: Vec<Vec<_>> =
        lists.collect::<Result<_, _>>().map_err(|e| Failure::usage(format!("--variation: {e}")))?;
    Ok(lists.concat())
}

/// Checks that the first font has the requested weight and slant, as it is, by an axis, or by synthesis if that is allowed.
pub(super) fn check_style(font: &Font<'_>, name: &str, wanted: &Wanted, read: &ReadOptions) -> Result<(), Failure> {
    let lacking = wanted.weight_lacking(font);
    let is_bolder = lacking.is_some_and(|w| f64::from(w) > font.weight());
    let problem = match lacking {
        Some(w) if !(wanted.synthesize && is_bolder) => format!("--weight: {name} has no weight near {w}"),
        _ if wanted.italic_lacking(font) && !wanted.synthesize => format!("--italic: {name} has no italic"),
        _ => return Ok(()),
    };
    let mut styles = family_styles(name, read);
    if styles.is_empty() {
        styles.push((font.weight().round() as u16, font.is_italic()));
    }
    let shown = styles.iter().map(|(w, italic)| format!("{w}{}", if *italic { " italic" } else { "" }));
    let shown = shown.collect::<Vec<_>>().join(", ");
    let advice = match (wanted.synthesize, lacking) {
        (true, _) => "; only bolder weights can be synthesised",
        (false, Some(_)) if !is_bolder => "",
        (false, _) => ", or make it with --synthesize",
    };
    Err(Failure::usage(format!("{problem}, only {shown}; name a font that has it with --font{advice}")))
}
