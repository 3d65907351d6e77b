//! The drawing as the editor's web page shows it: rewritten by usvg, so that only shapes, paints and embedded pictures remain.
//!
//! usvg resolves scripts, events, links, foreign objects and style sheets away; the page gets plain elements with attributes, one per line.
//! While something is dragged, most lines stay and most others differ in one attribute, so only changed attributes are sent.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use pathwarp::budget::{Budget, Limits};
use pathwarp::kurbo::{BezPath, Point, Rect, Shape as _, Size, Vec2};
use pathwarp_raster::{Pixmap, encode_png, render_group};
use pathwarp_svg::ReadOptions;
use pathwarp_svg::usvg_tree::parse_tree;
use serde_json::{Value, json};
use std::ops::Range;
use std::sync::Arc;
use usvg::{Indent, Node, Transform, WriteOptions};

/// Prefix of every id of the drawing, which distinguishes them from the web page's.
const ID_PREFIX: &str = "art-";

/// A drawing in the form that is shown: one element per line.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Picture {
    lines: Vec<String>,
}

impl Picture {
    /// Resolves a drawing. Coordinates get this number of decimals, in px.
    pub(crate) fn from_svg(svg: &str, decimals: u8, reading: &ReadOptions) -> Result<Self, String> {
        let tree = resolved(svg, reading)?;
        let options = WriteOptions {
            id_prefix: Some(ID_PREFIX.into()),
            coordinates_precision: decimals,
            indent: Indent::Spaces(0),
            ..WriteOptions::default()
        };
        let text = well_formed(&tree.to_string(&options));
        Ok(Self { lines: text.lines().map(ToOwned::to_owned).collect() })
    }

    /// Returns the text of a drawing as SVG whose page is the box of its content.
    pub(crate) fn thumbnail(svg: &str, reading: &ReadOptions) -> Result<String, String> {
        /// Margin around the content, as a share of its size.
        const MARGIN: f64 = 0.02;
        let tree = resolved(svg, reading)?;
        let content = content_box(&tree, svg.len())?;
        let margin = MARGIN * content.width().max(content.height());
        let options = WriteOptions { coordinates_precision: 2, indent: Indent::Spaces(0), ..WriteOptions::default() };
        let text = well_formed(&tree.to_string(&options));
        let (_, rest) = text.split_once('>').ok_or("the drawing has no root")?;
        let page = content.inflate(margin, margin);
        let (width, height) = (page.width(), page.height());
        Ok(format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"{width}\" \
             height=\"{height}\" viewBox=\"{} {} {width} {height}\">{rest}",
            page.x0, page.y0
        ))
    }

    /// Draws the content of a drawing as a PNG whose longer side has `longest` pixels. Also returns the box that the PNG fills, in px.
    pub(crate) fn bitmap(svg: &str, longest: f32, reading: &ReadOptions) -> Result<(Vec<u8>, Rect), String> {
        let (pixmap, filled) = render_content(resolved(svg, reading)?.as_ref(), longest, svg.len())?;
        Ok((encode_png(&pixmap).map_err(|e| e.to_string())?, filled))
    }

    /// Returns the whole text.
    pub(crate) fn text(&self) -> String {
        self.lines.join("\n")
    }

    /// Returns the indices of the lines that are paths, with their path data.
    pub(crate) fn paths(&self) -> Vec<(usize, &str)> {
        let lines = self.lines.iter().enumerate();
        lines.filter_map(|(i, line)| Some((i, &line[data_range(line)?]))).collect()
    }

    /// Replaces the path data of lines.
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

    /// Returns the message that turns `old` into this picture: the changed attributes if only attributes differ, else everything.
    pub(crate) fn message(&self, old: Option<&Self>) -> Value {
        let changes = old.and_then(|old| self.changes(old));
        changes.map_or_else(|| json!({ "whole": self.text() }), |changes| json!({ "changes": changes }))
    }

    /// Returns the changed attributes as line, name, value.
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
                // Entities occur only in ids, which rarely change; decoding them here is not worth it.
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

/// Returns the text of a drawing with its large embedded pictures reduced to few pixels; `None` if there are none. Pictures without a
/// width and a height stay, as their size would change, and all stay if pixels are meant to be seen (`image-rendering: pixelated`).
pub(crate) fn lightened(svg: &str, reading: &ReadOptions) -> Option<String> {
    /// Length in bytes from which on the text of a picture is large.
    const LARGE: usize = 1 << 16;
    /// The longer side of reduced pictures, in pixels.
    const PIXELS: f32 = 400.0;
    let (mut out, mut done) = (String::new(), 0);
    for (start, _) in svg.match_indices("data:image/") {
        let Some(quote @ ('"' | '\'')) = svg[..start].chars().next_back() else { continue };
        let end = start + svg[start..].find(quote)?;
        let tag = svg[..start].rfind('<').map_or("", |from| &svg[from..start]);
        let rest = svg[end..].find('>').map_or("", |to| &svg[end..end + to]);
        let has = |name: &str| tag.contains(name) || rest.contains(name);
        if start < done
            || end - start < LARGE
            || !(tag.starts_with("<image") && has(" width=") && has(" height="))
            || svg.contains("pixelated")
        {
            continue;
        }
        let alone = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\"><image xlink:href=\"{}\"/></svg>",
            &svg[start..end]
        );
        let Ok((png, _)) = Picture::bitmap(&alone, PIXELS, reading) else { continue };
        out += &svg[done..start];
        out += "data:image/png;base64,";
        out += &STANDARD.encode(png);
        done = end;
    }
    (done > 0).then(|| out + &svg[done..])
}

/// Draws the content of a drawing with `longest` pixels on the longer side. Also returns the box that the pixels fill, in px. `length` is
/// the length of the drawing's text. The renderer moves the corner of the box to the origin.
fn render_content(tree: &usvg::Tree, longest: f32, length: usize) -> Result<(Pixmap, Rect), String> {
    let content = tree.root().abs_layer_bounding_box();
    let scale = longest / content.width().max(content.height());
    let size = [content.width(), content.height()].map(|side| f64::from((side * scale).ceil().max(1.0)));
    let budget = Budget::new(Limits::default().for_input(length));
    let pixmap = render_group(tree.root(), Transform::from_scale(scale, scale), size, &budget);
    let pixmap = pixmap.map_err(|e| e.to_string())?.ok_or("the drawing shows nothing")?;
    let corner = Point::new(content.x().into(), content.y().into());
    Ok((pixmap, Rect::from_origin_size(corner, Size::new(size[0], size[1]) / f64::from(scale))))
}

/// Returns the box of a drawing's content in px, without the transparent pixels at the edges of bent bitmaps.
fn content_box(tree: &usvg::Tree, length: usize) -> Result<Rect, String> {
    /// Longer side of the bitmap in which transparent edges are searched for, in pixels.
    const PIXELS: f32 = 128.0;
    let all = tree.root().abs_layer_bounding_box();
    let all = Rect::new(all.left().into(), all.top().into(), all.right().into(), all.bottom().into());
    if !tree.root().children().iter().any(has_image) {
        return Ok(all);
    }
    let (pixmap, filled) = render_content(tree, PIXELS, length)?;
    let pixel = filled.width() / f64::from(pixmap.width());
    let visible = (0..).zip(pixmap.pixels()).filter(|(_, p)| p.alpha() > 0).map(|(i, _)| {
        let [x, y] = [i % pixmap.width(), i / pixmap.width()].map(|n| pixel * f64::from(n));
        Rect::from_origin_size(filled.origin() + Vec2::new(x, y), Size::new(pixel, pixel))
    });
    Ok(visible.reduce(|a, b| a.union(b)).map_or(all, |r| r.intersect(all)))
}

fn has_image(node: &Node) -> bool {
    match node {
        Node::Image(_) => true,
        Node::Group(group) => group.children().iter().any(has_image),
        Node::Path(_) | Node::Text(_) => false,
    }
}

/// Escapes the values of attributes in usvg's text, where only quotes are escaped, and keeps each on one line.
fn well_formed(text: &str) -> String {
    let (mut out, mut done, mut quoted) = (String::with_capacity(text.len()), 0, false);
    for (at, sign) in text.match_indices(['"', '<', '&', '\n']) {
        quoted ^= sign == "\"";
        let written = match sign {
            "<" => "&lt;",
            "&" if !text[at..].starts_with("&quot;") => "&amp;",
            "\n" => " ",
            _ => continue,
        };
        if quoted {
            out += &text[done..at];
            out += written;
            done = at + 1;
        }
    }
    out + &text[done..]
}

/// Returns the range of the path data in a line of a picture, which holds one element.
fn data_range(line: &str) -> Option<Range<usize>> {
    const NAME: &str = " d=\"";
    let start = line.starts_with("<path ").then(|| line.find(NAME)).flatten()? + NAME.len();
    Some(start..start + line[start..].find('"')?)
}

/// An opening tag in usvg's output.
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

/// Markup that excludes the quick update: shapes without path data, shapes drawn elsewhere or again, and paints and effects that usvg
/// derives from bounding boxes.
const DERIVED: [&str; 16] = [
    "<rect", "<circle", "<ellipse", "<line", "<poly", "<text", "<use", "<svg:", "<switch", "Gradient", "<pattern",
    "clipPath", "<mask", "<filter", "<marker", "<style",
];
/// Largest distance between the boxes of a path in the text and in the picture, due to rounded coordinates.
const ROUNDING: f64 = 0.05;

/// A quick update between pictures that differ in path data only: the last text, and the line of the picture for each path in it.
#[derive(Debug)]
pub(crate) struct PathUpdate {
    text: String,
    /// The ranges of path data in the text.
    data: Vec<Range<usize>>,
    lines: Vec<usize>,
}

impl PathUpdate {
    /// Prepares quick updates from this text, which `picture` shows. Returns `None` if the text does not permit them.
    pub(crate) fn prepare(text: String, picture: &Picture) -> Option<Self> {
        if DERIVED.iter().any(|word| text.contains(word)) {
            return None;
        }
        let (data, paths) = (path_data_ranges(&text), picture.paths());
        let is_shown =
            |(range, (_, shown)): (&Range<usize>, &(usize, &str))| has_same_extent(&text[range.clone()], shown);
        (data.len() == paths.len() && data.iter().zip(&paths).all(is_shown)).then(|| {
            let lines = paths.iter().map(|(line, _)| *line).collect();
            Self { text, data, lines }
        })
    }

    /// Proceeds to the next text. Returns the lines whose path data differ, with the new data, or `None` if anything else differs.
    pub(crate) fn next(&mut self, text: &str) -> Option<Vec<(usize, String)>> {
        let new = path_data_ranges(text);
        if self.data.len() != new.len() {
            return None;
        }
        let mut changes = Vec::new();
        let (mut old_end, mut new_end) = (0, 0);
        for ((old, new), line) in self.data.iter().zip(&new).zip(&self.lines) {
            if self.text[old_end..old.start] != text[new_end..new.start] {
                return None;
            }
            (old_end, new_end) = (old.end, new.end);
            let value = &text[new.clone()];
            // Paths without segments or with entities are left to usvg.
            if value.is_empty() || value.contains(['&', '"', '<']) {
                return None;
            }
            if *value != self.text[old.clone()] {
                changes.push((*line, value.to_owned()));
            }
        }
        if self.text[old_end..] != text[new_end..] {
            return None;
        }
        text.clone_into(&mut self.text);
        self.data = new;
        Some(changes)
    }
}

/// Returns the ranges of path data in a text, without their quotes.
fn path_data_ranges(text: &str) -> Vec<Range<usize>> {
    /// The attribute's name with the characters around it.
    const NAME: &str = " d=";
    let mut out = Vec::new();
    let mut from = 0;
    while let Some(at) = text[from..].find(NAME) {
        from += at + NAME.len();
        let Some(quote @ (b'"' | b'\'')) = text.as_bytes().get(from).copied() else { continue };
        let start = from + 1;
        let Some(length) = text[start..].find(quote as char) else { break };
        from = start + length;
        out.push(start..from);
    }
    out
}

/// Returns `true` if two texts of path data have the same extent and number of subpaths.
fn has_same_extent(a: &str, b: &str) -> bool {
    let box_and_subpaths = |d: &str| {
        let path = BezPath::from_svg(d).ok()?;
        let starts = path.elements().iter().filter(|e| matches!(e, pathwarp::kurbo::PathEl::MoveTo(_))).count();
        Some((path.bounding_box(), starts))
    };
    let agree =
        |a: Rect, b: Rect| [a.x0 - b.x0, a.y0 - b.y0, a.x1 - b.x1, a.y1 - b.y1].iter().all(|v| v.abs() <= ROUNDING);
    box_and_subpaths(a).zip(box_and_subpaths(b)).is_some_and(|((a, m), (b, n))| m == n && agree(a, b))
}

fn resolved(svg: &str, reading: &ReadOptions) -> Result<Arc<usvg::Tree>, String> {
    parse_tree(svg.as_bytes(), "the drawing", reading).map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_name_is_shown() {
        let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><path id="a&lt;&amp;&quot;&#10;b" d="M1,1h5v5z"/></svg>"#;
        for text in [
            Picture::from_svg(svg, 2, &ReadOptions::default()).unwrap().text(),
            Picture::thumbnail(svg, &ReadOptions::default()).unwrap(),
        ] {
            let document =
                pathwarp_svg::Document::read(text.as_bytes(), "the picture", &ReadOptions::default()).unwrap();
            let id = &document.parts()[0].name;
            assert!(id.ends_with("a<&\" b"), "{id}");
        }
    }

    fn picture(body: &str) -> Picture {
        let svg = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' viewBox='0 0 40 20'>{body}</svg>"
        );
        Picture::from_svg(&svg, 4, &ReadOptions::default()).unwrap()
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
        // If the number of elements differs, or there is no old picture, everything is sent.
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

    fn text(first: &str, fill: &str) -> String {
        format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 40 20'><title>a d= b</title><g transform='scale(2)'>\
             <path fill=\"{fill}\" d=\"{first}\"/></g><path d='M5,5H9V9z'/></svg>"
        )
    }

    fn quick(text: &str) -> Option<PathUpdate> {
        PathUpdate::prepare(text.to_owned(), &Picture::from_svg(text, 2, &ReadOptions::default()).unwrap())
    }

    #[test]
    fn path_data_alone_go_the_quick_way() {
        let mut quick = quick(&text("M0,0h9v9z", "red")).unwrap();
        let changes = quick.next(&text("M0,0H8V9z", "red")).unwrap();
        let [(line, data)] = changes.as_slice() else { panic!("{changes:?}") };
        assert_eq!(data, "M0,0H8V9z");
        let mut picture = Picture::from_svg(&text("M0,0h9v9z", "red"), 2, &ReadOptions::default()).unwrap();
        picture.redraw(&changes);
        assert_eq!(picture.paths()[0], (*line, "M0,0H8V9z"));
        assert_eq!(quick.next(&text("M0,0H8V9z", "red")), Some(Vec::new()));
    }

    #[test]
    fn anything_else_takes_the_long_way() {
        let start = || quick(&text("M0,0h9v9z", "red")).unwrap();
        assert_eq!(start().next(&text("M0,0h9v9z", "blue")), None);
        assert_eq!(start().next(&text("", "red")), None);
        assert_eq!(start().next(&text("M0,0h9v9z", "red").replace("<path d", "<path/><path d")), None);
        // Undrawn paths, and paths drawn in other ways, exclude the quick update.
        assert!(quick(&text("M0,0h9v9z", "red").replace("fill", "display='none' fill")).is_none());
        assert!(
            quick(&text("M0,0h9v9z", "red").replace("<path d='M5,5H9V9z'", "<rect width='4' height='3'")).is_none()
        );
        assert!(quick(&text("M0,0h9v9z", "red").replace("</svg>", "<linearGradient/></svg>")).is_none());
    }
}
