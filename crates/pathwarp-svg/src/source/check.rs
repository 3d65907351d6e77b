//! The check of a drawing before it is resolved: everything that references, style sheets and text make of it is counted.

use super::unfold;
use super::usvgguard::{spans, text_paths, wide_arcs, wide_strokes};
use pathwarp::Error;
use pathwarp::budget::Budget;
use usvg::roxmltree;

/// Features of a drawing that decide about fonts, images and limits.
#[derive(Default)]
pub(super) struct Features {
    pub(super) text: bool,
    pub(super) images: bool,
    references: bool,
    markers: usize,
}

impl Features {
    fn of(xml: &roxmltree::Document<'_>) -> Self {
        let mut out = Self::default();
        for n in xml.descendants() {
            match n.tag_name().name() {
                "text" => out.text = true,
                "image" => out.images = true,
                "feImage" => (out.images, out.references) = (true, true),
                "marker" => out.markers += 1,
                "use" | "pattern" | "clipPath" | "mask" => out.references = true,
                _ => {}
            }
        }
        // An embedded SVG image may contain text.
        out.text |= out.images && ["image/svg", ".svg"].iter().any(|t| xml.input_text().contains(t));
        out
    }
}

/// Checks a drawing. `name` identifies it in errors.
///
/// # Errors
/// Returns [`Error::Input`] if it exceeds the budget or nests too deeply.
pub(super) fn drawing(xml: &roxmltree::Document<'_>, name: &str, budget: &Budget) -> Result<Features, Error> {
    let features = Features::of(xml);
    if features.text {
        let too_much = |e| Error::limit(name, "its texts take", e);
        spans(xml, budget).and_then(|()| text_paths(xml, budget)).map_err(too_much)?;
    }
    wide_strokes(xml, budget).map_err(|e| Error::limit(name, "with such wide strokes, its shapes take", e))?;
    let segments = if unfold::may_be_large(xml, features.markers, features.references) {
        unfold::check(xml, name, budget)?
    } else {
        unfold::count_plain(xml, name, budget)?
    };
    wide_arcs(xml, segments, budget).map_err(|e| Error::limit(name, "with such wide arcs, its paths take", e))?;
    Ok(features)
}
