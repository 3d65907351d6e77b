//! Writes a warped document: patched in place, or flattened.

use super::input::WriteInput;
use super::{arrivals, flat, keep, page, unsupported};
use crate::bend::options::{Structure, WarpOptions};
use crate::bend::outcome::{Notes, Skipped, WarpedDocument};
use crate::bend::warning::Warning;
use crate::scene::drawing::Drawing;
use crate::source::images::{is_same_link, shown};
use crate::source::tags::ElementId;
use pathwarp::Error;

/// Writes the document to `out`, with warnings and everything skipped.
pub(crate) fn write(input: &WriteInput<'_>, out: &mut WarpedDocument) -> Result<(), Error> {
    let structure = input.options.structure;
    let unread = unread_images(input.drawing, input.options).chain(unsupported::elements(input));
    let mut notes = Notes::default();
    for note in &input.scene.notes {
        notes.add(note.text, &note.name);
    }
    for prefix in &input.source.undeclared {
        notes.add("the file used namespace prefixes without declaring them; the result declares them", prefix);
    }
    let change = page::change(input);
    let written = change.filter(|_| !input.options.same_view);
    let patched = match (structure, &input.scene.unpatchable) {
        (Structure::Flatten, _) => None,
        (_, Some(why)) => Some(Err(why.clone())),
        _ => Some(keep::write(input, written, &mut out.skipped, &mut notes)),
    };
    out.svg = match (patched, structure) {
        (Some(Ok(svg)), _) => {
            out.skipped.extend(unread);
            svg
        }
        (Some(Err(why)), Structure::Keep) => {
            return Err(Error::input(&input.drawing.name, format!("the file's structure cannot be kept: {why}")));
        }
        (patched, _) => {
            if let Some(Err(why)) = patched {
                out.warnings.push(Warning::Flattened(why.to_string()));
            }
            out.skipped.extend(unread.map(|s| Skipped { why: s.why + "; it is left out", ..s }));
            flat::write(input, written, &mut out.skipped, &mut notes)
        }
    };
    out.skipped.extend(unsupported::styles(input));
    unsupported::note_private(input, &mut notes);
    unsupported::note_style_sheets(input, &mut notes);
    out.warnings.extend(notes.warnings());
    if input.options.overhang {
        let shown = change.map_or_else(|| input.drawing.visible_area(), |(_, after)| after);
        let arrived = arrivals::arrivals(input, shown);
        out.warnings.extend((!arrived.is_empty()).then_some(Warning::Arrivals(arrived)));
        out.overhang = page::overhang(input);
        out.blank = page::is_blank(input, shown);
    }
    out.page = change.map(|(before, after)| [before, after]);
    Ok(())
}

/// Lists the selected images that could not be read.
fn unread_images(drawing: &Drawing, options: &WarpOptions) -> impl Iterator<Item = Skipped> {
    let source = &drawing.source;
    let missed = &drawing.missed.images;
    let selected = if missed.is_empty() { Vec::new() } else { options.selection.resolve(source) };
    let is_image = move |e: ElementId| matches!(source.elements[e].tag.as_ref(), "image" | "feImage");
    let images = selected.into_iter().enumerate().filter(move |(e, s)| *s && is_image(*e));
    images.filter_map(|(e, _)| {
        let own = source.link(e)?;
        let link = missed.iter().find(|link| is_same_link(&own, link))?;
        let reason = if link.contains("://") {
            "is not a file on this machine"
        } else if drawing.missed.outside.contains(link) {
            "lies outside of the drawing's folder, and was not read"
        } else {
            "cannot be read"
        };
        Some(Skipped { id: source.display_name(e), why: format!("its image, {}, {reason}", shown(link)) })
    })
}
