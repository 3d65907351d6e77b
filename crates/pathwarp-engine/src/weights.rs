//! Weights and italics: which fonts have the requested ones, as they are or by an axis, and how missing ones are synthesised.

use crate::failure::Failure;
use pathwarp_text::{Font, Variation};

/// Names of weights (OpenType 1.9.1, OS/2 usWeightClass).
pub const WEIGHTS: [(&str, u16); 9] = [
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

/// The requested style.
pub struct Wanted {
    /// The weight from 1 to 1000; `None` for the font's.
    pub weight: Option<u16>,
    /// `true` for italic, `false` for upright.
    pub italic: bool,
    /// `true` to synthesise styles that a font lacks.
    pub synthesize: bool,
}

impl Wanted {
    /// Returns the requested weight, if a font has neither it nor an axis for it.
    pub fn weight_lacking(&self, font: &Font<'_>) -> Option<u16> {
        /// Largest difference between weights that look alike: neighbouring names.
        const NEAR: f64 = 150.0;
        self.weight.filter(|w| (font.weight() - f64::from(*w)).abs() > NEAR && !has_axis(font, &["wght"]))
    }

    /// Returns the weight that is set if it is neither the requested one nor synthesised.
    pub fn other_weight(&self, font: &Font<'_>) -> Option<f64> {
        let wanted = f64::from(self.weight?);
        let axis = font.axes().into_iter().find(|a| a.tag == "wght");
        let nearest = axis.map_or(font.weight(), |a| wanted.max(a.min).min(a.max));
        let is_synthesized = self.synthesize && self.weight_lacking(font).is_some();
        ((nearest - wanted).abs() >= 1.0 && !is_synthesized).then_some(nearest)
    }

    /// Returns `true` if italics are requested, and the font has neither them nor an axis for them.
    pub fn italic_lacking(&self, font: &Font<'_>) -> bool {
        self.italic && !font.is_italic() && !has_axis(font, &["ital", "slnt"])
    }

    /// Synthesises the weight and slant that a font lacks.
    fn synthesized<'a>(&self, font: Font<'a>) -> Font<'a> {
        /// Thickness of stems, as a share of the em, for each step of weight: em/24 from regular to bold (FreeType's
        /// FT_GlyphSlot_Embolden).
        const PER_WEIGHT: f64 = 1.0 / 24.0 / 300.0;
        /// The angle of a synthesised oblique, in degrees (CSS Fonts 4, font-style).
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

/// Sets the fonts to their variations: `--variation` for the first font, `--weight` for every font with a weight axis.
pub fn with_variations<'a>(
    fonts: Vec<Font<'a>>,
    positions: &[Variation],
    wanted: &Wanted,
) -> Result<Vec<Font<'a>>, Failure> {
    let mut out = Vec::with_capacity(fonts.len());
    for (i, font) in fonts.into_iter().enumerate() {
        let mut variations = Vec::new();
        let font = wanted.synthesized(font);
        if let Some(w) = wanted.weight
            && let Some(axis) = font.axes().iter().find(|a| a.tag == "wght")
        {
            variations.extend(Variation::new("wght", f64::from(w).max(axis.min).min(axis.max)).ok());
        }
        let slant = font.axes().into_iter().find(|a| wanted.italic && matches!(a.tag.as_str(), "ital" | "slnt"));
        if let Some(axis) = slant {
            // An italic axis runs from 0 to 1, a slant axis counts degrees counterclockwise.
            let end = if axis.tag == "ital" { axis.max } else { axis.min };
            variations.extend(Variation::new(&axis.tag, end).ok());
        }
        if i == 0 {
            variations.extend_from_slice(positions);
        }
        let varied = if variations.is_empty() { Ok(font) } else { font.with_variations(&variations) };
        out.push(varied.map_err(|e| Failure::usage(format!("--variation: {e}")))?);
    }
    Ok(out)
}
