//! Words set as outlines: fonts found by file or family, and laid out within the limits.

use crate::advice;
use crate::failure::Failure;
use crate::input;
use crate::options::Reading;
use pathwarp::budget::{Exceeded, Limit, Limits, cost};
use pathwarp::param::LengthUnit;
use pathwarp_svg::ReadOptions;
use pathwarp_svg::engine::{FontFile, LetteringOptions, bundled_font, fallback_fonts, write_lettering};
use pathwarp_text::{Font, OutlinedText, TextLimits, TextStyle, layout_within};
use std::path::Path;

/// The weight of a family's regular font.
pub const REGULAR: u16 = 400;

/// Finds a font by its file or family.
pub fn find_font(name: &str, weight: u16, italic: bool, options: &ReadOptions) -> Result<FontFile, Failure> {
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
    Ok(pathwarp_svg::engine::find_font(name, weight, italic, options)?)
}

/// Sets words in a family, or in the bundled font, as a drawing in mm. Lists the characters that neither font has.
pub fn set_plainly(
    words: &str,
    family: Option<&str>,
    style: &TextStyle,
    reading: &Reading,
) -> Result<(String, Vec<char>), Failure> {
    let read = reading.read_options();
    let file = family.map(|name| find_font(name, REGULAR, false, &read)).transpose()?;
    let chosen = file.as_ref().zip(family).map(|(file, name)| read_font(name, file)).transpose()?;
    let fonts: Vec<Font<'_>> = chosen.into_iter().chain([bundled()?]).collect();
    let limits = reading.limits.for_input(words.len());
    let text = laid_out_with_installed(words, &fonts, style, (REGULAR, false), &read, &limits)?;
    let options = LetteringOptions { unit: Some(LengthUnit::Mm), ..LetteringOptions::default() };
    Ok((write_lettering(&text, &options)?, text.missing))
}

/// Reads the font in a file that `name` names.
pub fn read_font<'a>(name: &str, file: &'a FontFile) -> Result<Font<'a>, Failure> {
    Font::new(&file.bytes, file.index).map_err(|e| Failure::Input(format!("{name}: {e}")))
}

/// Returns the bundled font.
pub fn bundled() -> Result<Font<'static>, Failure> {
    Font::new(bundled_font(), 0).map_err(|e| Failure::Input(e.to_string()))
}

/// Lays out words within the limits. Installed fonts, of the weight and slope (`true` for italic) in `look`, supply letters that the fonts
/// lack.
pub fn laid_out_with_installed(
    words: &str,
    fonts: &[Font<'_>],
    style: &TextStyle,
    look: (u16, bool),
    read: &ReadOptions,
    limits: &Limits,
) -> Result<OutlinedText, Failure> {
    let text = laid_out(words, fonts, style, limits)?;
    if text.missing.is_empty() {
        return Ok(text);
    }
    let found = fallback_fonts(&text.text, fonts, look, style.language.as_deref().unwrap_or_default(), read);
    let found = found.iter().filter_map(|(file, w)| Some(Font::new(&file.bytes, file.index).ok()?.only_for(*w)));
    let all: Vec<Font<'_>> = fonts.iter().cloned().chain(found).collect();
    if all.len() == fonts.len() { Ok(text) } else { laid_out(words, &all, style, limits) }
}

/// Lays out words within the limits.
pub fn laid_out(words: &str, fonts: &[Font<'_>], style: &TextStyle, limits: &Limits) -> Result<OutlinedText, Failure> {
    let most = |cost: f64| (limits.of(Limit::Work) / cost) as usize;
    let text_limits = TextLimits { letters: most(cost::LETTER), segments: most(cost::SEGMENT) };
    layout_within(words, fonts, style, &text_limits).map_err(|e| failure(&e, limits))
}

/// Turns an error of the layout into a failure: a bad option is wrong usage, anything else a problem of the font or the text.
fn failure(e: &pathwarp_text::Error, limits: &Limits) -> Failure {
    use pathwarp_text::Error as E;
    match e {
        E::Style { .. } | E::Empty => Failure::usage(e.to_string()),
        E::Setting { .. } => Failure::usage(format!("--script or --language: {e}")),
        &E::TooLarge { needed, most, .. } => {
            let work = limits.of(Limit::Work);
            let needed = work * needed as f64 / most as f64;
            let exceeded = Exceeded { limit: Limit::Work, most: work, needed, cut: true };
            Failure::Input(format!("{e}; {}", advice::raise(&exceeded)))
        }
        _ => Failure::Input(e.to_string()),
    }
}
