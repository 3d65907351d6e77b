//! The style: size, spacing, and the fonts, found by file or family, at their weight and variations.

use clap::ArgMatches;
use pathwarp::kurbo::Rect;
use pathwarp::param::{Args, Axis, Frame, Length, LengthUnit, Settings};
use pathwarp_engine::failure::Failure;
use pathwarp_svg::ReadOptions;
use pathwarp_svg::engine::family_styles;
use pathwarp_text::{Align, Direction, Font, Ligatures, TextStyle, Variation, features, variations};

/// The size of the em, and the unit that it and the whole page have.
pub(super) struct Em {
    pub(super) size: f64,
    /// `None`: px.
    pub(super) unit: Option<LengthUnit>,
    /// Percentages refer to it.
    frame: Frame,
}

impl Em {
    /// Reads `--size`, or another option that the whole page has its unit from. With a unit, user units of the page are that unit.
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

    /// Another size on the same page.
    pub(super) fn resized(&self, size: f64) -> Self {
        let frame = Frame { rect: Rect::new(0.0, 0.0, size, size), ..self.frame.clone() };
        Self { size, unit: self.unit, frame }
    }

    /// User units of the page per px.
    pub(super) fn units_per_px(&self) -> [f64; 2] {
        self.frame.units_per_px
    }

    /// The length given for the option `name`, in user units of the page.
    pub(super) fn length(&self, m: &ArgMatches, name: &str) -> Result<Option<f64>, Failure> {
        let Some(text) = word(m, name) else { return Ok(None) };
        let args = Args::new();
        Ok(Some(Settings::new(&[], &args, &self.frame)?.length_in(name, text, Axis::X)?))
    }
}

/// The value of an option that the command may have.
fn word<'m>(m: &'m ArgMatches, name: &str) -> Option<&'m str> {
    m.try_get_one::<String>(name).ok().flatten().map(String::as_str)
}

pub(super) fn style(m: &ArgMatches, em: &Em) -> Result<TextStyle, Failure> {
    let word = |name: &str| word(m, name);
    let mut all = Vec::new();
    for list in m.get_many::<String>("features").into_iter().flatten() {
        all.extend(features(list).map_err(|e| Failure::usage(format!("--features: {e}")))?);
    }
    /// Distance between lines in a shape, as a share of the size.
    const GAP: f64 = 0.06;
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
        features: all,
    })
}

/// Names of weights (OpenType 1.9.1, OS/2 usWeightClass).
const WEIGHTS: [(&str, u16); 9] = [
    ("thin", 100),
    ("extralight", 200),
    ("light", 300),
    ("regular", 400),
    ("medium", 500),
    ("semibold", 600),
    ("bold", 700),
    ("extrabold", 800),
    ("black", 900),
];
/// The style asked for.
pub(super) struct Wanted {
    pub(super) weight: Option<u16>,
    pub(super) italic: bool,
    /// Make what a font lacks.
    pub(super) synthesize: bool,
}

impl Wanted {
    /// The weight, if a font has neither it nor an axis for it.
    fn weight_lacking(&self, font: &Font<'_>) -> Option<u16> {
        /// Weights this far apart look alike: neighbouring names.
        const NEAR: f64 = 150.0;
        self.weight.filter(|w| (font.weight() - f64::from(*w)).abs() > NEAR && !has_axis(font, &["wght"]))
    }

    /// The weight that a font has instead of the one asked for.
    pub(super) fn other_weight(&self, font: &Font<'_>) -> Option<f64> {
        let wanted = f64::from(self.weight?);
        let axis = font.axes().into_iter().find(|a| a.tag == "wght");
        let has = axis.map_or(font.weight(), |a| wanted.max(a.min).min(a.max));
        let made = self.synthesize && self.weight_lacking(font).is_some();
        ((has - wanted).abs() >= 1.0 && !made).then_some(has)
    }

    /// Returns `true` if a font should be italic, and has neither that nor an axis for it.
    fn italic_lacking(&self, font: &Font<'_>) -> bool {
        self.italic && !font.is_italic() && !has_axis(font, &["ital", "slnt"])
    }

    /// Makes what a font lacks.
    fn synthesized<'a>(&self, font: Font<'a>) -> Font<'a> {
        /// Thickness of stems, as a share of the em, for each step of weight: em/24 from regular to bold (FreeType's
        /// FT_GlyphSlot_Embolden).
        const PER_WEIGHT: f64 = 1.0 / 24.0 / 300.0;
        /// The angle of a synthesised oblique, degrees (CSS Fonts 4, font-style).
        const SLANT: f64 = 14.0;
        if !self.synthesize {
            return font;
        }
        let (weight, slanted) = (self.weight_lacking(&font), self.italic_lacking(&font));
        let more = weight.map_or(0.0, |w| f64::from(w) - font.weight()).max(0.0);
        font.emboldened(more * PER_WEIGHT).slanted(if slanted { SLANT } else { 0.0 })
    }
}

fn has_axis(font: &Font<'_>, tags: &[&str]) -> bool {
    font.axes().iter().any(|a| tags.contains(&a.tag.as_str()))
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

/// The positions on variation axes that `--variation` gives.
pub(super) fn axis_positions(m: &ArgMatches) -> Result<Vec<Variation>, Failure> {
    let mut all = Vec::new();
    for list in m.get_many::<String>("variation").into_iter().flatten() {
        all.extend(variations(list).map_err(|e| Failure::usage(format!("--variation: {e}")))?);
    }
    Ok(all)
}

/// Sets the fonts to their variations: `--variation` applies to the first font, `--weight` to every font with a weight axis.
pub(super) fn with_variations<'a>(
    fonts: Vec<Font<'a>>,
    positions: &[Variation],
    wanted: &Wanted,
) -> Result<Vec<Font<'a>>, Failure> {
    let mut out = Vec::with_capacity(fonts.len());
    for (i, font) in fonts.into_iter().enumerate() {
        let mut own = Vec::new();
        let font = wanted.synthesized(font);
        if let Some(w) = wanted.weight
            && let Some(axis) = font.axes().iter().find(|a| a.tag == "wght")
        {
            own.extend(Variation::new("wght", f64::from(w).max(axis.min).min(axis.max)).ok());
        }
        let slant = font.axes().into_iter().find(|a| wanted.italic && matches!(a.tag.as_str(), "ital" | "slnt"));
        if let Some(axis) = slant {
            // An italic axis runs from 0 to 1, a slant axis counts degrees counterclockwise.
            let end = if axis.tag == "ital" { axis.max } else { axis.min };
            own.extend(Variation::new(&axis.tag, end).ok());
        }
        if i == 0 {
            own.extend_from_slice(positions);
        }
        let font = if own.is_empty() {
            font
        } else {
            font.with_variations(&own).map_err(|e| Failure::usage(format!("--variation: {e}")))?
        };
        out.push(font);
    }
    Ok(out)
}

/// Checks that the first font has the weight and the slant asked for, by itself, by an axis, or because it may be synthesised.
pub(super) fn check_style(font: &Font<'_>, name: &str, wanted: &Wanted, read: &ReadOptions) -> Result<(), Failure> {
    let lacking = wanted.weight_lacking(font);
    let bolder = lacking.is_some_and(|w| f64::from(w) > font.weight());
    let problem = match lacking {
        Some(w) if !(wanted.synthesize && bolder) => format!("--weight: {name} has no weight near {w}"),
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
        (false, Some(_)) if !bolder => "",
        (false, _) => ", or make it with --synthesize",
    };
    Err(Failure::usage(format!("{problem}, only {shown}; name a font that has it with --font{advice}")))
}
