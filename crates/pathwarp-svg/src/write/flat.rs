//! Flattened output: a new file with everything resolved.

use super::fragment::Writer;
use super::input::WriteInput;
use super::page;
use crate::bend::outcome::{Notes, Skipped};
use pathwarp::kurbo::Rect;
use pathwarp_reader::xml::escape;
use std::borrow::Cow;
use std::fmt::Write as _;

/// Writes the file; `change` is the visible area before and after, if that changes.
pub(super) fn write(
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
    let page = change.map_or_else(Vec::new, |change| page::attributes(input.source, change));
    for name in ["id", "class", "width", "height", "viewBox", "preserveAspectRatio"] {
        let new = page.iter().find(|p| p.0 == name).map(|p| Cow::Borrowed(p.1.as_str()));
        if let Some(v) = new.or_else(|| source.attr(0, name)) {
            let _ = write!(out, " {name}=\"{}\"", escape(&v));
            if name == "id" {
                w.defs.taken.insert(v.into_owned());
            }
        }
    }
    out.push_str(">\n");
    if let Some(t) = source.elements.first().and_then(|e| e.title.as_ref()) {
        let _ = writeln!(out, "<title>{}</title>", escape(t));
    }
    let mut body = String::new();
    for n in &input.scene.root.children {
        body.push_str(&w.node(n));
        body.push('\n');
    }
    if !w.defs.text.is_empty() {
        let _ = write!(out, "<defs>\n{}</defs>\n", w.defs.text);
    }
    out.push_str(&body);
    out.push_str("</svg>\n");
    out
}
