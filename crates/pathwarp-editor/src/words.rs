//! Words that a drawing was set from: it carries them in an attribute of its root, so that they can be changed when it is opened again.

use crate::host::Words;

/// The attribute.
const WORDS: &str = "data-words";

/// The drawing with the words that it shows.
pub(crate) fn written(words: &Words, svg: &str) -> String {
    let json = serde_json::to_string(words).unwrap_or_default();
    let value = json.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
    svg.replacen("<svg ", &format!("<svg {WORDS}=\"{value}\" "), 1)
}

/// The words that a drawing was set from.
pub(crate) fn of(svg: &str) -> Option<Words> {
    let document = usvg::roxmltree::Document::parse(svg).ok()?;
    serde_json::from_str(document.root_element().attribute(WORDS)?).ok()
}
