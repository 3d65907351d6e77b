//! Captions: words that are set on a drawing before all other edits; a recipe stores their text.

use crate::advice;
use crate::edits::CAPTION;
use crate::failure::Failure;
use crate::lettering::{REGULAR, bundled, find_font, laid_out_with_installed, read_font};
use crate::options::CommonOptions;
use crate::units::units_per_px;
use crate::weights::{WEIGHTS, Wanted, with_variations};
use pathwarp::kurbo::{Point, Rect};
use pathwarp::param::{Frame, Settings};
use pathwarp::recipe::Step;
use pathwarp_svg::engine::lettering_group;
use pathwarp_svg::{Document, ReadOptions, Selection};
use pathwarp_text::{Align, Font, OutlinedText, TextStyle};

/// Returns `true` if a step sets a caption.
pub fn is_caption(step: &Step) -> bool {
    step.deformation == CAPTION.name
}

/// Returns the frame for captions: the box of the drawing without them, or else its page.
pub fn frame(document: &Document) -> Frame {
    let bounds = document.seen_box(&Selection::default()).unwrap_or_else(|| document.view_box());
    Frame::new(bounds).with_units_per_px(units_per_px(document))
}

/// Returns the drawing with captions, read by the options `read`, and warnings about letters that no font has. The group of the k-th is
/// called `caption-k`, and its letters `caption-k-1` and so on, with more hyphens before the numbers if the drawing has such names.
///
/// # Errors
/// [`Failure::Usage`] without words, [`Failure::Library`] for a wrong value or unknown family, and [`Failure::Input`] for too many words.
pub fn captioned(
    document: &Document,
    steps: &[Step],
    read: &ReadOptions,
    options: &CommonOptions,
) -> Result<(Document, Vec<String>), Failure> {
    let frame = frame(document);
    let mut name = CAPTION.name.to_owned();
    while document.text().contains(&format!("id=\"{name}-1\"")) {
        name.push('-');
    }
    let (mut groups, mut warnings) = (String::new(), Vec::new());
    for (step, k) in steps.iter().zip(1..) {
        let settings = Settings::new(CAPTION.params, &step.args, &frame)?;
        settings.check_values()?;
        let (text, origin) = lay_out(&settings, read, options)?;
        let fill = settings.texts("fill").last().copied().unwrap_or("black");
        groups += &lettering_group(&text, &format!("{name}-{k}"), fill, settings.point("at")? - origin)?;
        warnings.extend((!text.missing.is_empty()).then(|| advice::missing_letters(&text.missing)));
    }
    Ok((Document::read(document.with_appended(&groups).as_bytes(), document.name(), read)?, warnings))
}

/// Sets a caption. Returns its outlines, and the point of them that goes to the position `at`.
fn lay_out(s: &Settings<'_>, read: &ReadOptions, options: &CommonOptions) -> Result<(OutlinedText, Point), Failure> {
    let lines = s.texts("words").join("\n");
    if lines.trim().is_empty() {
        return Err(Failure::usage("--words: a caption needs words"));
    }
    let (weight, italic) = (s.choice("weight")?, s.flag("italic")?);
    let weight = WEIGHTS.iter().find(|(name, _)| *name == weight).map_or(REGULAR, |(_, w)| *w);
    let family = s.texts("font").last().copied();
    let file = family.map(|name| find_font(name, weight, italic, read)).transpose()?;
    let chosen = file.as_ref().zip(family).map(|(file, name)| read_font(name, file)).transpose()?;
    let wanted = Wanted { weight: Some(weight), italic, synthesize: true };
    let fonts: Vec<Font<'_>> = with_variations(chosen.into_iter().chain([bundled()?]).collect(), &[], &wanted)?;
    let size = s.number("size")?;
    // The share of the baseline's length at which the point lies.
    let (align, share) = match s.choice("align")? {
        "center" => (Align::Center, 0.5),
        "right" => (Align::Right, 1.0),
        _ => (Align::Left, 0.0),
    };
    let style = TextStyle {
        size,
        align,
        letter_spacing: size * s.number("letter-spacing")?,
        line_height: Some(size * s.number("line-height")?),
        ..TextStyle::default()
    };
    let limits = options.reading.limits.for_input(lines.len());
    let text = laid_out_with_installed(&lines, &fonts, &style, (weight, italic), read, &limits)?;
    let baselines = text.lines.iter().map(|l| Rect::from_points(l.start, l.end)).reduce(|a, b| a.union(b));
    let baselines = baselines.unwrap_or_default();
    Ok((text, Point::new(baselines.x0 + share * baselines.width(), baselines.y0)))
}
