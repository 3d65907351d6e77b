//! Content that the renderer does not know, and that is therefore not warped: each such element is reported.

use super::input::WriteInput;
use crate::bend::outcome::{Notes, Skipped};
use crate::source::tags::{ElementId, is_shape};
use crate::source::text::SourceText;
use crate::source::undrawn::{Unknown, is_definition, unknown};
use std::collections::HashSet;

/// A paint server that the renderer does not know, in words.
fn paint(tag: &str) -> Option<&'static str> {
    match tag {
        "meshgradient" | "meshGradient" | "mesh" => Some("a mesh gradient"),
        "hatch" => Some("a hatch"),
        _ => None,
    }
}

/// Why content that the renderer does not know is not warped.
fn content(source: &SourceText, e: ElementId) -> Option<&'static str> {
    Some(match unknown(source, e)? {
        Unknown::FlowedText => {
            "text that flows in a frame (flowRoot) cannot be warped, as only Inkscape lays it out; convert it to ordinary text or to \
             paths there"
        }
        Unknown::Foreign => "foreign content (HTML in a foreignObject) cannot be warped",
        Unknown::Elsewhere => "what it refers to is in another file, which is not read",
    })
}

/// Notes private data from which its editor would restore the artwork as it was.
pub(super) fn note_private(input: &WriteInput<'_>, notes: &mut Notes) {
    let is_illustrator = |e: ElementId| {
        input.source.elements[e].tag == "foreignObject"
            && input.source.attr(e, "requiredExtensions").is_some_and(|x| x.contains("AdobeIllustrator"))
    };
    let all = 0..input.source.elements.len();
    if all.into_iter().any(is_illustrator) && input.outcomes.iter().any(|o| o.warped().is_some()) {
        notes.add(
            "Illustrator opens the private data that the file holds (i:pgf) instead of the warped artwork; save the original \
             without “Preserve Illustrator Editing Capabilities”",
            "",
        );
    }
}

/// Notes what is not supported of the style sheets.
pub(super) fn note_style_sheets(input: &WriteInput<'_>, notes: &mut Notes) {
    if !input.outcomes.iter().any(|o| o.warped().is_some()) {
        return;
    }
    for (_, why) in input.source.unsupported_style.iter().filter(|(element, _)| element.is_none()) {
        notes.add("the style sheets ask for more than is supported", why);
    }
    for (what, name) in &input.source.notes {
        notes.add(what, name);
    }
}

/// Lists the selected elements whose style asks for what is not supported.
pub(super) fn styles(input: &WriteInput<'_>) -> Vec<Skipped> {
    let source = input.source;
    let unsupported = || source.unsupported_style.iter().filter_map(|(e, why)| Some(((*e)?, why)));
    if unsupported().next().is_none() {
        return Vec::new();
    }
    let selected = input.options.selection.resolve(source);
    let shown = unsupported().filter(|(e, _)| selected[*e] && !is_definition(source, *e));
    shown.map(|(e, why)| Skipped { id: source.display_name(e), why: why.clone() }).collect()
}

/// Lists the selected elements that are not warped because the renderer does not know them or their paint.
pub(super) fn elements(input: &WriteInput<'_>) -> Vec<Skipped> {
    let source = input.source;
    let known = |e: ElementId| content(source, e).is_none() && paint(&source.elements[e].tag).is_none();
    let all = 0..source.elements.len();
    if all.clone().all(known) {
        return Vec::new();
    }
    let selected = input.options.selection.resolve(source);
    let parts = input.scene.parts.iter().zip(input.outcomes);
    let warped: HashSet<ElementId> =
        parts.filter(|(_, o)| o.warped().is_some()).filter_map(|(p, _)| p.element()).collect();
    let unknown = |e: ElementId, property: &str| {
        let value = source.ancestors(e).find_map(|a| source.property(a, property).filter(|v| v != "inherit"))?;
        let id = value.strip_prefix("url(")?.split(')').next()?.trim_matches(['"', '\'', ' ']).strip_prefix('#')?;
        paint(&source.elements[*source.by_id().get(id)?.first()?].tag)
    };
    let why = |e: ElementId| {
        if let Some(why) = content(source, e) {
            return Some(why.to_owned());
        }
        let tag = source.elements[e].tag.as_ref();
        let painted = ["fill", "stroke"].into_iter().filter(|_| is_shape(tag) || tag == "text");
        let (name, kind) = { painted }.find_map(|name| Some((name, unknown(e, name)?)))?;
        Some(if warped.contains(&e) {
            format!("only its outline is; its {name}, {kind}, is unchanged")
        } else {
            format!("its {name} is {kind}; such shapes cannot be warped")
        })
    };
    all.filter(|&e| selected[e] && !is_definition(source, e))
        .filter_map(|e| Some(Skipped { id: source.display_name(e), why: why(e)? }))
        .collect()
}
