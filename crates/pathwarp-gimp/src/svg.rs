//! Reads SVG that GIMP exported, and writes SVG that GIMP imports without scaling.
//!
//! GIMP exports the canvas as a viewBox in pixels, and width and height in inches rounded to six digits; only the viewBox is
//! exact. On import it scales by width and height over the viewBox, at the resolution of the image. Sizes in px that equal the
//! viewBox avoid any scaling.

use crate::error::Error;
use crate::path::{FileKind, GimpPath, PathFile, Stroke, shortest_number};
use pathwarp::Outline;
use pathwarp::engine::decimal::trimmed;
use pathwarp::kurbo::Point;
use pathwarp::outline::{Seg, Subpath};
use roxmltree::{Document, Node, ParsingOptions};
use std::fmt::Write as _;

const NAMESPACE: &str = "http://www.w3.org/2000/svg";
const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";
const DOCTYPE: &str = "-//W3C//DTD SVG 20010904//EN";

/// The attributes that distinguish GIMP's exports from other SVG files.
const ATTRIBUTES: [(&str, &str); 3] = [("fill", "none"), ("stroke", "black"), ("stroke-width", "1")];

/// An attribute for GIMP's visibility switch, on paths that are switched off. GIMP ignores it.
const VISIBLE: &str = "data-gimp-visible";

/// Returns `true` if a file with these first bytes can be an export from GIMP.
pub(crate) fn may_be_export(head: &[u8]) -> bool {
    head.windows(DOCTYPE.len()).any(|w| w == DOCTYPE.as_bytes())
}

fn parse(text: &str) -> Result<Document<'_>, Error> {
    if !is_plain(text) {
        return Err(Error::damaged(0, "it declares entities or has very many attributes, which GIMP does not write"));
    }
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(text, options)
        .map_err(|e| Error::in_text(text, e.pos().row as usize, e.pos().col as usize, format!("not valid XML: {e}")))
}

/// Returns `true` if parsing takes time and memory in proportion to the text: there are no entities, which may expand to entities, and
/// no elements with very many attributes, which the parser compares with each other.
fn is_plain(text: &str) -> bool {
    /// Far more than the six that GIMP writes.
    const MAX_ATTRIBUTES: usize = 1000;
    // Two quotation marks stand for an attribute.
    let is_long = |tag: &str| {
        tag.len() > MAX_ATTRIBUTES && tag.bytes().filter(|b| matches!(b, b'"' | b'\'')).count() / 2 > MAX_ATTRIBUTES
    };
    !text.contains("<!ENTITY") && !text.split('<').any(|tag| is_long(tag.split('>').next().unwrap_or_default()))
}

/// Returns `true` if an SVG is as GIMP exports it: one or more paths, each with a name and GIMP's stroke and nothing else.
pub(crate) fn is_export(text: &str) -> bool {
    let Ok(doc) = parse(text) else { return false };
    let mut paths = doc.root_element().children().filter(Node::is_element).peekable();
    paths.peek().is_some()
        && paths.all(|p| {
            p.has_tag_name((NAMESPACE, "path"))
                && p.attribute("d").is_some()
                && ATTRIBUTES.iter().all(|(name, value)| p.attribute(*name) == Some(value))
                && p.attributes().all(|a| {
                    a.namespace() == Some(INKSCAPE)
                        || matches!(a.name(), "id" | "d" | "fill" | "stroke" | "stroke-width" | VISIBLE)
                })
        })
}

/// Reads the paths of an SVG.
pub(crate) fn read(text: &str) -> Result<PathFile, Error> {
    let doc = parse(text)?;
    let root = doc.root_element();
    if !root.has_tag_name((NAMESPACE, "svg")) {
        return Err(Error::damaged(root.range().start as u64, "not an SVG file"));
    }
    let numbers = |text: &str| text.split([' ', ',']).filter_map(|w| w.parse().ok()).collect::<Vec<f64>>();
    let size = match root.attribute("viewBox").map(numbers).as_deref() {
        Some([_, _, w, h]) if [w, h].iter().all(|v| v.is_finite() && **v > 0.0) => Some([*w, *h]),
        _ => None,
    };
    let mut paths = Vec::new();
    for p in root.children().filter(|n| n.has_tag_name((NAMESPACE, "path"))) {
        let data = p.attribute("d").unwrap_or_default();
        let damaged = |e: &dyn std::fmt::Display| Error::damaged(p.range().start as u64, format!("path data: {e}"));
        let data = if data.trim().is_empty() { Ok(Outline::default()) } else { Outline::from_svg(data) };
        let outline = data.map_err(|e| damaged(&e))?;
        if outline.segs().any(|s| !s.is_finite()) {
            return Err(damaged(&"a coordinate is out of range"));
        }
        let strokes =
            outline.subpaths.iter().map(|s| single_anchor_loop(s).unwrap_or_else(|| Stroke::from_subpath(s))).collect();
        let name = p.attribute("id").unwrap_or_default().to_owned();
        // Paths in GIMP's exports count as visible.
        let visible = p.attribute(VISIBLE) != Some("false");
        paths.push(GimpPath { name, visible, strokes });
    }
    Ok(PathFile { kind: FileKind::Svg, size, paths })
}

/// Recognizes a closed stroke with a single anchor. GIMP omits its `C` command, so its four points read as three lines.
fn single_anchor_loop(s: &Subpath) -> Option<Stroke> {
    match s.segs.as_slice() {
        [Seg::Line(first), Seg::Line(second), Seg::Line(third)] if !s.closed && third.p1 == s.start => {
            let [outgoing, incoming] = [first.p1, second.p1];
            let points = [incoming, s.start, outgoing].map(|p| [p.x, p.y]).to_vec();
            Some(Stroke { closed: true, points })
        }
        _ => None,
    }
}

/// Writes paths as SVG that GIMP imports without scaling: sizes in pixels, a matching viewBox, and one `path` each with its name
/// as id. Paths that are not visible in GIMP are marked for [`read`](crate::read). `decimals` rounds coordinates; without it they
/// keep the single precision of GIMP.
///
/// The outer handles at the ends of open strokes carry no geometry and are lost.
#[must_use]
pub fn to_svg(size: [f64; 2], paths: &[GimpPath], decimals: Option<u8>) -> String {
    let [w, h] = size.map(shortest_number);
    // A name that is no id is also written as Inkscape's label.
    let is_labelled = paths.iter().any(|p| !is_id(&p.name));
    let inkscape = if is_labelled { format!("\n     xmlns:inkscape=\"{INKSCAPE}\"") } else { String::new() };
    let mut out = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"no\"?>\n<!DOCTYPE svg PUBLIC \"{DOCTYPE}\"\n              \
         \"http://www.w3.org/TR/2001/REC-SVG-20010904/DTD/svg10.dtd\">\n\n<svg xmlns=\"{NAMESPACE}\"{inkscape}\n     \
         width=\"{w}px\" height=\"{h}px\"\n     viewBox=\"0 0 {w} {h}\">\n"
    );
    for p in paths {
        let name = escaped(&p.name);
        // Writing to a string cannot fail.
        let _ = write!(out, "  <path id=\"{name}\"");
        if !is_id(&p.name) {
            let _ = write!(out, " inkscape:label=\"{name}\"");
        }
        for (name, value) in ATTRIBUTES {
            let _ = write!(out, " {name}=\"{value}\"");
        }
        if !p.visible {
            let _ = write!(out, " {VISIBLE}=\"false\"");
        }
        let strokes: Vec<String> = p.strokes.iter().map(|s| path_data(s, decimals)).collect();
        let _ = writeln!(out, "\n        d=\"{}\" />", strokes.join("\n           "));
    }
    out + "</svg>\n"
}

/// Formats the path data of a stroke.
fn path_data(s: &Stroke, decimals: Option<u8>) -> String {
    let number = |v: f64| decimals.map_or_else(|| shortest_number(v), |d| trimmed(v, usize::from(d)));
    let point = |p: Point| format!("{},{}", number(p.x), number(p.y));
    let triples: Vec<[Point; 3]> = s.triples().collect();
    let Some((first, last)) = triples.first().zip(triples.last()) else { return String::new() };
    let mut out = format!("M {}", point(first[1]));
    let mut segment = |from: &[Point; 3], to: &[Point; 3]| {
        // GIMP stores a line with handles that coincide with their anchors.
        let _ = if from[2] == from[1] && to[0] == to[1] {
            write!(out, " L {}", point(to[1]))
        } else {
            write!(out, " C {} {} {}", point(from[2]), point(to[0]), point(to[1]))
        };
    };
    triples.windows(2).for_each(|w| segment(&w[0], &w[1]));
    if s.closed {
        // `Z` draws a closing line by itself.
        if last[2] != last[1] || first[0] != first[1] {
            segment(last, first);
        }
        out += " Z";
    }
    out
}

/// Returns `true` if a name is a valid XML id.
fn is_id(name: &str) -> bool {
    let mut chars = name.chars();
    chars.next().is_some_and(|c| c.is_alphabetic() || c == '_')
        && chars.all(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | '.'))
}

/// Escapes the value of an attribute. Characters that XML does not allow become U+FFFD.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            // An XML reader would turn these into spaces.
            '\t' | '\n' | '\r' => {
                let _ = write!(out, "&#{};", u32::from(c));
            }
            '\u{0}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}
