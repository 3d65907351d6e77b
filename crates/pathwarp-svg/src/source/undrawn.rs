//! Lists content and style of a drawing that usvg does not render.

use super::tags::ElementId;
use super::text::SourceText;

/// Content that usvg does not know.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Unknown {
    /// Text in a frame, of Inkscape.
    FlowedText,
    /// HTML.
    Foreign,
    /// An element, a path or a text of another file.
    Elsewhere,
}

/// Classifies an element that usvg does not render.
pub(crate) fn unknown(source: &SourceText, e: ElementId) -> Option<Unknown> {
    match source.elements[e].tag.as_ref() {
        "flowRoot" => Some(Unknown::FlowedText),
        // Private data of an editor is not shown.
        "foreignObject" if source.attr(e, "requiredExtensions").is_none() => Some(Unknown::Foreign),
        "use" | "textPath" | "tref" if source.link(e).is_some_and(|link| is_elsewhere(&link)) => {
            Some(Unknown::Elsewhere)
        }
        _ => None,
    }
}

/// Returns `true` if an element is in `<defs>`: rendered only where it is referenced.
pub(crate) fn is_definition(source: &SourceText, e: ElementId) -> bool {
    source.ancestors(e).any(|a| source.elements[a].tag == "defs")
}

/// Returns `true` if a link leads to another file.
fn is_elsewhere(link: &str) -> bool {
    let link = link.trim_start();
    !link.is_empty() && !link.starts_with('#')
}

/// Lists what a picture of the drawing lacks: content, and style.
pub(crate) fn undrawn(source: &SourceText) -> Vec<String> {
    let shown = |e: &ElementId| !is_definition(source, *e);
    let content = (0..source.elements.len()).filter(shown).filter_map(|e| {
        let what = match unknown(source, e)? {
            Unknown::FlowedText => "text that flows in a frame (flowRoot), which only Inkscape lays out",
            Unknown::Foreign => "foreign content (HTML in a foreignObject)",
            Unknown::Elsewhere => "what it refers to is in another file",
        };
        Some(format!("{} is not drawn: {what}", source.display_name(e)))
    });
    let style = source.unsupported_style.iter().filter(|(e, _)| e.as_ref().is_none_or(shown)).map(|(e, why)| match e {
        Some(e) => format!("{}: {why}", source.display_name(*e)),
        None => format!("the style sheets ask for more than is supported: {why}"),
    });
    content.chain(style).collect()
}
