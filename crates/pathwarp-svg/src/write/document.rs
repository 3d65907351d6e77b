//! Writes a warped document: patches the source in place, or flattens it.

use super::fragment::Writer;
use super::input::WriteInput;
use super::{keep, line, page};
use crate::bend::options::{Structure, WarpOptions};
use crate::bend::outcome::{Notes, Skipped, Warning, WarpedDocument};
use crate::scene::drawing::Drawing;
use crate::source::elements::{ElementId, is_shape};
use crate::source::images::{is_same_link, shown};
use crate::source::mesh::is_mesh;
use crate::source::text::SourceText;
use crate::source::tree::{Unsupported, is_definition, unsupported};
use pathwarp::Error;
use pathwarp::kurbo::Rect;
use pathwarp_reader::xml::escape;
use std::borrow::Cow;
use std::collections::HashSet;
use std::fmt::Write as _;

/// Writes the document to `out`, with warnings, skipped elements, and artwork that lies past the page or has moved onto it.
pub(crate) fn write(input: &WriteInput<'_>, out: &mut WarpedDocument) -> Result<(), Error> {
    let structure = input.options.structure;
    let unread = unread_images(input.drawing, input.options).chain(unknown_elements(input));
    let mut notes = Notes::default();
    for note in &input.scene.notes {
        notes.add(note.text, &note.name);
    }
    for prefix in &input.source.undeclared {
        notes.add("the file used namespace prefixes without declaring them; the result declares them", prefix);
    }
    // The visible areas before and after; the file states the new one unless its view is to stay.
    let change = page::change(input);
    let written = change.filter(|_| !input.options.same_view);
    let patched = match (structure, &input.scene.unpatchable) {
        (Structure::Flatten, _) => None,
        _ if input.options.line.only && input.line.is_some() => None,
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
            flatten(input, written, &mut out.skipped, &mut notes)
        }
    };
    out.skipped.extend(unsupported_styles(input));
    if input.outcomes.iter().any(|o| o.warped().is_some()) {
        note_private(input.source, &mut notes);
        note_style_sheets(input.source, &mut notes);
    }
    out.warnings.extend(notes.warnings());
    out.back = page::back(input);
    if input.options.overhang && out.back.is_none() {
        let shown = change.map_or_else(|| input.drawing.visible_area(), |(_, after)| after);
        let arrived = page::arrivals(input, shown);
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
        let written = source.link(e)?;
        let link = missed.iter().find(|link| is_same_link(&written, link))?;
        let reason = if drawing.missed.outside.contains(link) {
            "lies outside of the drawing's folder, and was not read"
        } else if link.contains("://") {
            "is not a file on this machine"
        } else {
            "cannot be read"
        };
        Some(Skipped { id: source.display_name(e), why: format!("its image, {}, {reason}", shown(link)) })
    })
}

/// Writes a new file: the artwork and the cut line around it (`line`), or that alone. `change` is the visible area before and after.
fn flatten(
    input: &WriteInput<'_>,
    change: Option<(Rect, Rect)>,
    skipped: &mut Vec<Skipped>,
    notes: &mut Notes,
) -> String {
    let source = input.source;
    let mut w = Writer::new(*input, false, skipped, notes);
    if source.animated {
        w.notes.add("animations are dropped, as the file is flattened", "");
    }
    let mut out =
        String::from("<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\"");
    let page = change.map_or_else(Vec::new, |change| page::attributes(input, change));
    for name in ["id", "class", "width", "height", "viewBox", "preserveAspectRatio"] {
        let new = page.iter().find(|p| p.0 == name).map(|p| Cow::Borrowed(p.1.as_str()));
        if let Some(value) = new.or_else(|| source.attr(0, name)) {
            let _ = write!(out, " {name}=\"{}\"", escape(&value));
            if name == "id" {
                w.defs.taken.insert(value.into_owned());
            }
        }
    }
    out.push_str(">\n");
    if let Some(t) = source.elements.first().and_then(|e| e.title.as_ref()) {
        let _ = writeln!(out, "<title>{}</title>", escape(t));
    }
    let [mut body, above] = line::layers(&mut w);
    for n in input.scene.root.children.iter().filter(|_| !(input.options.line.only && input.line.is_some())) {
        body.push_str(&w.node(n));
        body.push('\n');
    }
    if !w.defs.text.is_empty() {
        let _ = write!(out, "<defs>\n{}</defs>\n", w.defs.text);
    }
    out.push_str(&body);
    out.push_str(&above);
    out.push_str("</svg>\n");
    out
}

/// A phrase for a paint server that the renderer does not know.
fn unknown_paint(tag: &str) -> Option<&'static str> {
    match tag {
        "hatch" => Some("a hatch"),
        _ => is_mesh(tag).then_some("a mesh gradient"),
    }
}

/// The reason why content that the renderer does not know is not warped.
fn unknown_content(source: &SourceText, e: ElementId) -> Option<&'static str> {
    Some(match unsupported(source, e)? {
        Unsupported::FlowedText => {
            "text that flows in a frame (flowRoot) cannot be warped, as only Inkscape lays it out; convert it to ordinary text or to \
             paths there"
        }
        Unsupported::Foreign => "foreign content (HTML in a foreignObject) cannot be warped",
        Unsupported::Elsewhere => "what it refers to is in another file, which is not read",
    })
}

/// Notes private data from which Illustrator would restore the unwarped artwork.
fn note_private(source: &SourceText, notes: &mut Notes) {
    let is_illustrator = |e: ElementId| {
        source.elements[e].tag == "foreignObject"
            && source.attr(e, "requiredExtensions").is_some_and(|x| x.contains("AdobeIllustrator"))
    };
    if (0..source.elements.len()).any(is_illustrator) {
        notes.add(
            "Illustrator opens the private data that the file holds (i:pgf) instead of the warped artwork; save the original \
             without “Preserve Illustrator Editing Capabilities”",
            "",
        );
    }
}

/// Notes unsupported rules of the style sheets, and what reading the source noted.
fn note_style_sheets(source: &SourceText, notes: &mut Notes) {
    for (_, why) in source.unsupported_style.iter().filter(|(element, _)| element.is_none()) {
        notes.add("the style sheets ask for more than is supported", why);
    }
    for (text, name) in &source.notes {
        notes.add(text, name);
    }
}

/// Lists the selected elements with an unsupported style.
fn unsupported_styles(input: &WriteInput<'_>) -> Vec<Skipped> {
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
fn unknown_elements(input: &WriteInput<'_>) -> Vec<Skipped> {
    let source = input.source;
    let is_known =
        |e: ElementId| unknown_content(source, e).is_none() && unknown_paint(&source.elements[e].tag).is_none();
    let all = 0..source.elements.len();
    if all.clone().all(is_known) {
        return Vec::new();
    }
    let selected = input.options.selection.resolve(source);
    let parts = input.scene.parts.iter().zip(input.outcomes);
    let warped: HashSet<ElementId> =
        parts.filter(|(_, o)| o.warped().is_some()).filter_map(|(p, _)| p.element()).collect();
    let unknown_server = |e: ElementId, property: &str| {
        let server = source.paint_server(e, property)?;
        unknown_paint(&source.elements[server].tag).filter(|_| source.mesh(server).is_none())
    };
    let why = |e: ElementId| {
        if let Some(why) = unknown_content(source, e) {
            return Some(why.to_owned());
        }
        let tag = source.elements[e].tag.as_ref();
        let mut painted = ["fill", "stroke"].into_iter().filter(|_| is_shape(tag) || tag == "text");
        let (name, kind) = painted.find_map(|name| Some((name, unknown_server(e, name)?)))?;
        Some(if warped.contains(&e) {
            format!("only in its outline; its {name}, {kind}, is unchanged")
        } else {
            format!("its {name} is {kind}; such shapes cannot be warped")
        })
    };
    all.filter(|&e| selected[e] && !is_definition(source, e))
        .filter_map(|e| Some(Skipped { id: source.display_name(e), why: why(e)? }))
        .collect()
}
