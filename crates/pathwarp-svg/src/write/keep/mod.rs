//! Patches the source text in place: elements, their order and all else in the file stay wherever possible.

mod elements;
mod keeper;
mod pages;
mod text;

use super::fragment::Writer;
use super::input::WriteInput;
use super::keep::keeper::{Keeper, Warped};
use super::{line, page};
use crate::bend::outcome::{Notes, Skipped};
use crate::source::edit::Edits;
use crate::source::elements::{Element, ElementId, Unpatchable, is_live, is_shape};
use crate::source::number::rectangle;
use crate::source::text::SourceText;
use pathwarp::engine::decimal::matrix;
use pathwarp::kurbo::{Affine, Rect};
use pathwarp_reader::guarded;

/// Patches the text. `change` is the visible area before and after, if it changes.
pub(super) fn write(
    input: &WriteInput<'_>,
    change: Option<(Rect, Rect)>,
    skipped: &mut Vec<Skipped>,
    notes: &mut Notes,
) -> Result<String, Unpatchable> {
    let mut writer = Writer::new(*input, true, skipped, notes);
    let mut k = Keeper::new(*input, &mut writer);
    if let Some((_, after)) = change {
        pages::fix_percentages(&mut k, after.size());
    }
    elements::patch_clips(&mut k)?;
    elements::patch_masks(&mut k)?;
    elements::patch_group(&mut k, &input.scene.root);
    elements::name_united(&mut k);
    let [beneath, above] = line::layers(k.writer);
    if !above.is_empty() {
        let first = (1..input.source.elements.len()).find(|&e| {
            let e = &input.source.elements[e];
            e.parent == Some(0)
                && (is_shape(&e.tag) || matches!(&*e.tag, "g" | "a" | "svg" | "switch" | "use" | "text" | "image"))
        });
        if let Some(first) = first {
            k.edits.insert_before(first, &beneath);
        }
        k.edits.wrap_content(0, String::new(), above);
    }
    move_slots(&mut k);
    enlarge_regions(&mut k);
    let warped = Warped::new(input);
    keeper::remove_live_attributes(&mut k, &warped);
    keeper::remove_outdated_animations(&mut k, &warped);
    if let Some(change) = change {
        for (name, value) in page::attributes(input, change) {
            if name == "viewBox" {
                k.edits.set_attr(0, name, value);
            } else {
                k.edits.set_page_side(name, value);
            }
        }
        pages::move_pages_and_guides(&mut k, change);
    }
    let edits = k.edits;
    let defs = std::mem::take(&mut writer.defs.text);
    if edits.is_empty() && defs.is_empty() {
        return Ok(input.source.as_in_file().into_owned());
    }
    let (text, starts) = finish(input.source, edits, &defs, &writer.markup.prefix)?;
    if !input.source.has_css() {
        return Ok(text);
    }
    let old_starts = input.source.positions_in_file(starts.iter().map(|(e, _)| input.source.elements[*e].range.start));
    let starts: Vec<_> = old_starts.into_iter().zip(starts.iter().map(|s| s.1)).collect();
    let guarded = guarded(&input.source.as_in_file(), &text, &starts, &input.drawing.budget);
    let Ok(guarded) = guarded else {
        notes.add("the style sheets are too long to see whether their rules now apply to other elements (--limit comparisons=…)", "");
        return Ok(text);
    };
    Ok(guarded.unwrap_or(text))
}

/// Applies the fits of filtered elements and images to their transforms.
fn move_slots(k: &mut Keeper<'_, '_>) {
    for (s, placed) in k.input.scene.slots.iter().zip(k.input.slots) {
        if let (None, Some(e)) = (s.owner, s.element)
            && placed.fit != Affine::IDENTITY
        {
            k.edits.set_attr(e, "transform", matrix(k.input.drawing.own_transform(e) * placed.fit));
            k.edits.remove_attrs(e, |a| is_live(a, &k.source.text));
        }
    }
}

/// Enlarges the regions of filters in user space. Regions in box units follow the boxes of the filtered elements.
fn enlarge_regions(k: &mut Keeper<'_, '_>) {
    for (id, region) in std::mem::take(&mut k.writer.defs.regions) {
        if let Some(e) = k.definition(&id, "filter").filter(|&e| k.source.in_user_space(e, "filterUnits") == Some(true))
        {
            for (name, value) in rectangle(region) {
                k.edits.set_attr(e, name, value);
            }
        }
    }
}

/// Adds the new definitions to the file's `<defs>`, or else at its end, so that the title stays the first child. Returns the text, and
/// where the elements of the source begin in it.
fn finish(
    source: &SourceText,
    mut edits: Edits<'_>,
    defs: &str,
    prefix: &str,
) -> Result<(String, Vec<(ElementId, usize)>), Unpatchable> {
    if defs.is_empty() {
        return Ok(edits.apply());
    }
    // Elements that the reader added are not in the file.
    let is_defs = |e: &Element| e.tag == "defs" && e.parent == Some(0) && e.close.is_some() && source.is_in_file(e);
    match source.elements.iter().position(is_defs) {
        Some(e) => edits.wrap_content(e, String::new(), defs.to_owned()),
        None if source.elements[0].close.is_some() => {
            edits.wrap_content(0, String::new(), format!("<{prefix}defs>\n{defs}</{prefix}defs>\n"));
        }
        None => return Err(Unpatchable::EmptyRoot),
    }
    Ok(edits.apply())
}
