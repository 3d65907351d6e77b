//! Guides that a recipe refers to: kept with the objects, for the day when they are gone from the drawing.

use super::nodes::{by_id, parse};
use pathwarp::Error;
use pathwarp::budget::Limits;
use pathwarp_reader::xml::escape;
use std::fmt::Write as _;
use usvg::roxmltree::Node;

/// Copies of paths, as they lie in root user space.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Guides {
    /// Elements, in groups with the transforms around them.
    pub(super) markup: String,
}

impl Guides {
    /// Copies the paths with these ids.
    ///
    /// # Errors
    /// Returns [`Error::Input`] if `svg` is not XML, or takes more work than the limits allow.
    pub fn of(svg: &str, ids: &[String], limits: &Limits) -> Result<Self, Error> {
        let mut out = Self::default();
        if ids.is_empty() {
            return Ok(out);
        }
        let doc = parse(svg, limits)?;
        let found = by_id(&doc);
        for n in ids.iter().filter_map(|id| found.get(id.as_str())) {
            out.markup += &copy(svg, *n);
        }
        Ok(out)
    }

    /// The copies as an SVG file.
    #[must_use]
    pub fn file(&self) -> String {
        format!("<svg xmlns=\"{}\">{}</svg>", crate::source::tags::SVG, self.markup)
    }
}

/// An element inside groups with the transforms around it.
fn copy(text: &str, n: Node<'_, '_>) -> String {
    let mut out = String::new();
    let transforms: Vec<&str> = n.ancestors().skip(1).filter_map(|a| a.attribute("transform")).collect();
    for t in transforms.iter().rev() {
        let _ = write!(out, "<g transform=\"{}\">", escape(t));
    }
    out.push_str(&text[n.range()]);
    transforms.iter().for_each(|_| out.push_str("</g>"));
    out
}
