//! The drawing as a page shows it: written anew by usvg, so that only shapes, paints and embedded pictures are left of a file.
//!
//! usvg resolves scripts, events, links, foreign objects and style sheets away; the page gets plain elements with attributes, one a
//! line. While something is dragged, most lines stay and most of the others differ in one attribute, so only that is sent.

use pathwarp_svg::ReadOptions;
use pathwarp_svg::usvg_tree::parse_tree;
use serde_json::{Value, json};
use std::ops::Range;
use usvg::{Indent, WriteOptions};

/// Put before every id of the drawing, so that it cannot be one of the page's.
const ID_PREFIX: &str = "art-";

/// A drawing, ready to be shown: one element a line.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Picture {
    lines: Vec<String>,
}

impl Picture {
    /// Resolves a drawing. `decimals` is the number of decimals of coordinates, in px.
    pub(crate) fn of(svg: &str, decimals: u8) -> Result<Self, String> {
        let tree = parse_tree(svg.as_bytes(), "the drawing", &ReadOptions::default()).map_err(|e| e.to_string())?;
        let options = WriteOptions {
            id_prefix: Some(ID_PREFIX.into()),
            coordinates_precision: decimals,
            indent: Indent::Spaces(0),
            ..WriteOptions::default()
        };
        let text = tree.to_string(&options);
        Ok(Self { lines: text.lines().map(ToOwned::to_owned).collect() })
    }

    /// The text of a drawing that shows all there is, and not the page.
    pub(crate) fn small(svg: &str) -> Result<String, String> {
        /// Space around the drawing, as a share of its size.
        const MARGIN: f32 = 0.02;
        let tree = parse_tree(svg.as_bytes(), "the drawing", &ReadOptions::default()).map_err(|e| e.to_string())?;
        let seen = tree.root().abs_layer_bounding_box();
        let margin = MARGIN * seen.width().max(seen.height());
        let options = WriteOptions { coordinates_precision: 2, indent: Indent::Spaces(0), ..WriteOptions::default() };
        let text = tree.to_string(&options);
        let (_, rest) = text.split_once('>').ok_or("the drawing has no root")?;
        let (x, y) = (seen.x() - margin, seen.y() - margin);
        let (width, height) = (seen.width() + 2.0 * margin, seen.height() + 2.0 * margin);
        Ok(format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{width}\" \
             height=\"{height}\" viewBox=\"{x} {y} {width} {height}\">{rest}"
        ))
    }

    /// The whole text.
    pub(crate) fn text(&self) -> String {
        self.lines.join("\n")
    }

    /// The lines that are paths, with their path data.
    pub(crate) fn paths(&self) -> Vec<(usize, &str)> {
        let lines = self.lines.iter().enumerate();
        lines.filter_map(|(i, line)| Some((i, &line[data_range(line)?]))).collect()
    }

    /// Gives lines new path data.
    pub(crate) fn redraw(&mut self, changes: &[(usize, String)]) {
        for (line, data) in changes {
            if let Some(line) = self.lines.get_mut(*line)
                && let Some(range) = data_range(line)
            {
                let rest = line.split_off(range.end);
                line.truncate(range.start);
                line.push_str(data);
                line.push_str(&rest);
            }
        }
    }

    /// The message that turns `old` into this picture: the attributes that differ, if only attributes do, else everything.
    pub(crate) fn message(&self, old: Option<&Self>) -> Value {
        let changes = old.and_then(|old| self.changes(old));
        changes.map_or_else(|| json!({ "whole": self.text() }), |changes| json!({ "changes": changes }))
    }

    /// The changed attributes as line, name, value.
    fn changes(&self, old: &Self) -> Option<Vec<(usize, &str, &str)>> {
        if self.lines.len() != old.lines.len() {
            return None;
        }
        let mut out = Vec::new();
        for (i, (new, old)) in self.lines.iter().zip(&old.lines).enumerate().filter(|(_, (new, old))| new != old) {
            let (new, old) = (Element::parse(new)?, Element::parse(old)?);
            if new.tag != old.tag || new.attributes.len() != old.attributes.len() {
                return None;
            }
            for ((name, value), (old_name, old_value)) in new.attributes.iter().zip(&old.attributes) {
                // Entities would have to be decoded; they occur in ids only, which rarely change.
                if name != old_name || value.contains('&') {
                    return None;
                }
                if value != old_value {
                    out.push((i, *name, *value));
                }
            }
        }
        Some(out)
    }
}

/// The place of the path data in a line.
fn data_range(line: &str) -> Option<Range<usize>> {
    const NAME: &str = " d=\"";
    let start = line.starts_with("<path ").then(|| line.find(NAME)).flatten()? + NAME.len();
    Some(start..start + line[start..].find('"')?)
}

/// An opening tag as usvg writes it.
struct Element<'t> {
    tag: &'t str,
    attributes: Vec<(&'t str, &'t str)>,
}

impl<'t> Element<'t> {
    fn parse(line: &'t str) -> Option<Self> {
        let inside = line.strip_prefix('<')?.strip_suffix('>')?;
        let inside = inside.strip_suffix('/').unwrap_or(inside);
        let (tag, mut rest) = inside.split_once(' ').unwrap_or((inside, ""));
        let mut attributes = Vec::new();
        while !rest.is_empty() {
            let (name, after) = rest.split_once("=\"")?;
            let (value, after) = after.split_once('"')?;
            attributes.push((name.trim_start(), value));
            rest = after;
        }
        Some(Self { tag, attributes })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(body: &str) -> Picture {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' viewBox='0 0 40 20'>{body}</svg>"
        );
        Picture::of(&svg, 4).unwrap()
    }

    #[test]
    fn only_what_changed_is_sent() {
        let (a, b) = (
            picture("<path d='M0,0 H9 V9'/><path d='M5,5 H9 V9'/>"),
            picture("<path d='M0,0 H9 V9'/><path d='M5,5 H8 V9'/>"),
        );
        let message = b.message(Some(&a));
        let changes = message["changes"].as_array().unwrap();
        assert_eq!(changes.len(), 1);
        assert_eq!((&changes[0][1], &changes[0][2]), (&json!("d"), &json!("M 5 5 L 8 5 L 8 9")));
        assert_eq!(a.message(Some(&a)), json!({ "changes": [] }));
        // Another number of elements, or none before: everything.
        let c = picture("<path d='M0,0 H9 V9'/>");
        assert_eq!(c.message(Some(&a))["whole"].as_str().unwrap().matches("<path").count(), 1);
        assert!(c.message(None)["whole"].is_string());
    }

    #[test]
    fn nothing_that_runs_or_loads_is_left() {
        let hostile = "<script>alert(1)</script><path d='M0,0 H9 V9' onclick='alert(2)' style='fill:green;background:url(http://a.example/p)'/>\
            <foreignObject width='9' height='9'><body xmlns='http://www.w3.org/1999/xhtml'><img src='http://b.example/'/></body>\
            </foreignObject><a xlink:href='javascript:alert(3)'><rect width='3' height='3'/></a>\
            <image xlink:href='http://c.example/x.png' width='5' height='5'/><animate onbegin='alert(4)'/>\
            <style>@import url(http://d.example/); path { fill: red }</style><use xlink:href='http://e.example/#x'/>";
        let text = picture(hostile).text();
        for word in [
            "script", "alert", "onclick", "onbegin", "foreign", "example", "animate", "@import", "<a ", "<use",
            "<style",
        ] {
            assert!(!text.contains(word), "{word} is in {text}");
        }
        assert!(text.matches("<path").count() == 2, "{text}");
    }
}
