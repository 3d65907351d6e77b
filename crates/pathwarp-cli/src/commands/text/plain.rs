//! Words as outlines for the editor, which keeps in the drawing what they are.

use super::{failure, style};
use crate::failure::Failure;
use crate::options::Reading;
use pathwarp::budget::{Limit, cost};
use pathwarp::param::LengthUnit;
use pathwarp_editor::Words;
use pathwarp_svg::{FontFile, LetteringOptions, bundled_font, write_lettering};
use pathwarp_text::{Font, TextLimits, TextStyle, layout_within};

/// Sets words as a drawing in mm.
pub(crate) fn set(words: &Words, reading: &Reading) -> Result<String, Failure> {
    let read = reading.read_options();
    let find = |family: &String| style::find_font(family, style::REGULAR, false, &read);
    let file: Option<FontFile> = words.font.as_ref().map(find).transpose()?;
    let mut fonts: Vec<Font<'_>> = Vec::new();
    if let Some(file) = &file {
        fonts.push(Font::new(&file.bytes, file.index).map_err(|e| Failure::Input(e.to_string()))?);
    }
    fonts.push(Font::new(bundled_font(), 0).map_err(|e| Failure::Input(e.to_string()))?);
    let letter_spacing = 0.01 * words.spacing * words.size;
    let style = TextStyle { size: words.size, letter_spacing, ..TextStyle::default() };
    let limits = reading.limits.for_input(words.text.len());
    let most = |cost: f64| (limits.of(Limit::Work) / cost) as usize;
    let most = TextLimits { letters: most(cost::LETTER), segments: most(cost::SEGMENT) };
    let text = layout_within(&words.text, &fonts, &style, &most).map_err(|e| failure(&e, &limits))?;
    let options = LetteringOptions { fill: None, margin: 0.0, unit: Some(LengthUnit::Mm) };
    Ok(write_lettering(&text, &options)?)
}
