//! The check of a drawing before it is resolved: everything that references, style sheets and text make of it is counted.

use super::{selectors, unfold};
use pathwarp::Error;
use pathwarp::budget::{Budget, Exceeded, Limit};
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
    selectors::count(xml, budget).map_err(|e| Error::limit(name, "its style sheet takes", e))?;
    if features.text {
        spans(xml, budget).map_err(|e| Error::limit(name, "its texts take", e))?;
    }
    if unfold::may_be_large(xml, features.markers, features.references) {
        unfold::check(xml, name, budget)?;
    } else {
        unfold::count_plain(xml, name, budget)?;
    }
    Ok(features)
}

/// Counts the letters that are compared with every span of their text.
fn spans(xml: &roxmltree::Document<'_>, budget: &Budget) -> Result<(), Exceeded> {
    let texts = xml.descendants().filter(|n| n.tag_name().name() == "text");
    for text in texts {
        let (mut spans, mut letters) = (0, 0);
        for n in text.descendants() {
            if n.is_element() {
                spans += 1;
            } else {
                letters += n.text().map_or(0, str::len) as u64;
            }
        }
        // The text itself is no span.
        budget.spend(Limit::Comparisons, (spans - 1) * letters)?;
    }
    Ok(())
}
