//! The fonts: found by file or family, at their weight and variations.

use crate::failure::Failure;
use crate::input;
use clap::ArgMatches;
use pathwarp_svg::{FontFile, installed_styles, system_font};
use pathwarp_text::{Font, Variation, variations};
use std::path::Path;

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
/// The weight of a family's regular font.
pub(super) const REGULAR: u16 = 400;

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
    weight: Option<u16>,
    italic: bool,
) -> Result<Vec<Font<'a>>, Failure> {
    let mut out = Vec::with_capacity(fonts.len());
    for (i, font) in fonts.into_iter().enumerate() {
        let mut own = Vec::new();
        if let Some(w) = weight
            && let Some(axis) = font.axes().iter().find(|a| a.tag == "wght")
        {
            own.extend(Variation::new("wght", f64::from(w).clamp(axis.min, axis.max)).ok());
        }
        let slant = font.axes().into_iter().find(|a| italic && matches!(a.tag.as_str(), "ital" | "slnt"));
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

/// Checks that the first font has the weight and the slant asked for, by itself or by an axis.
pub(super) fn check_style(font: &Font<'_>, name: &str, weight: Option<u16>, italic: bool) -> Result<(), Failure> {
    /// Weights this far apart look alike: neighbouring names.
    const NEAR: f64 = 150.0;
    let has_axis = |tags: &[&str]| font.axes().iter().any(|a| tags.contains(&a.tag.as_str()));
    let light = weight.filter(|w| (font.weight() - f64::from(*w)).abs() > NEAR && !has_axis(&["wght"]));
    let upright = italic && !font.is_italic() && !has_axis(&["ital", "slnt"]);
    let wanted = match (light, upright) {
        (Some(w), _) => format!("--weight: {name} has no weight near {w}"),
        (None, true) => format!("--italic: {name} has no italic"),
        (None, false) => return Ok(()),
    };
    let mut styles = installed_styles(name);
    if styles.is_empty() {
        styles.push((font.weight().round() as u16, font.is_italic()));
    }
    let shown = styles.iter().map(|(w, italic)| format!("{w}{}", if *italic { " italic" } else { "" }));
    let shown = shown.collect::<Vec<_>>().join(", ");
    Err(Failure::usage(format!("{wanted}, only {shown}; name a font that has it with --font")))
}

/// Finds a font by its file or by its family.
pub(super) fn find(name: &str, weight: u16, italic: bool) -> Result<FontFile, Failure> {
    let read = |path: &Path, index| input::bytes(path).map(|bytes| FontFile { bytes, index });
    let path = Path::new(name);
    if path.is_file() {
        return read(path, 0);
    }
    if let Some((file, index)) = name.rsplit_once('#')
        && let Ok(index) = index.parse()
    {
        return read(Path::new(file), index);
    }
    let kinds = ["ttf", "otf", "ttc", "otc", "woff", "woff2", "pfb"];
    let looks_like_file = name.contains(['/', '\\'])
        || path.extension().and_then(|e| e.to_str()).is_some_and(|e| kinds.iter().any(|k| e.eq_ignore_ascii_case(k)));
    if looks_like_file {
        return read(path, 0);
    }
    Ok(system_font(name, weight, italic)?)
}
