//! Converts HTML in a `foreignObject` to SVG text. draw.io and others write a label as a `switch` between HTML and a shorter text for
//! viewers that cannot show it. The text gets the words of the HTML, laid out by plain CSS (CSS Flexbox 1, CSS Inline 3).

use crate::sheet::declarations;
use crate::text;
use crate::tree::Styled;
use crate::value::{Units, length};
use crate::xml::escape;
use roxmltree::Node;
use std::fmt::Write as _;
use std::rc::Rc;

/// The text that replaces HTML.
pub(super) struct Foreign {
    /// Its lines, as the content of a `text`.
    pub(super) content: String,
    /// The colour that each element in `content` declares.
    pub(super) fills: Vec<Option<Rc<str>>>,
    /// The parts of the HTML that are left out, since they are not text; worded for people.
    pub(super) left_out: Vec<String>,
}

/// The style of words.
#[derive(Clone, PartialEq)]
struct Look {
    /// The font's size in px.
    size: f64,
    /// Height of a line as a multiple of the size; `None` for the height that the font sets.
    line_height: Option<f64>,
    /// The share of the free room beside the words that is on their left.
    align: f64,
    wraps: bool,
    /// Values of [`SHARED`].
    shared: [Option<Rc<str>>; SHARED.len()],
}

/// A rectangle for the text, and the shares of the free room to its left and above it.
#[derive(Clone, Copy)]
struct Room {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
    /// `None` for text that fills the width.
    free_left: Option<f64>,
    free_above: f64,
}

/// A word, white space, or the end of a line.
enum Piece {
    Word(String, Rc<Look>),
    Space,
    Break,
}

/// Ascent, descent and line gap of Arial and its twins, as multiples of the font's size.
const METRICS: [f64; 3] = [0.905, 0.212, 0.033];

impl Look {
    /// The height of a line, and the distance from its middle down to the middle of its letters. Chromium rounds ascent and descent.
    fn line_box(&self) -> (f64, f64) {
        let [ascent, descent, gap] = METRICS.map(|share| share * self.size);
        let normal = ascent.round() + descent.round() + gap.round();
        let height = self.line_height.map_or(normal, |multiple| multiple * self.size);
        let above = ((height - ascent.round() - descent.round()) / 2.0).floor() + ascent.round();
        (height, above - 0.5 * (height + ascent - descent))
    }
}

/// Properties of fonts and text that mean the same in SVG, with their names there.
const SHARED: [(&str, &str); 5] = [
    ("color", "fill"),
    ("font-family", "font-family"),
    ("font-weight", "font-weight"),
    ("font-style", "font-style"),
    ("text-decoration", "text-decoration"),
];

/// Initial values of [`SHARED`]. The `text` that the words are written to may have other values.
const INITIAL: [Option<&str>; SHARED.len()] = [Some("currentColor"), None, Some("normal"), Some("normal"), None];

/// The longest value of a property that is read, in bytes. Values are written for every word.
const LONGEST: usize = 256;

/// Elements with a default style, as the property and its value.
const STYLED: [(&[&str], &str, &str); 4] = [
    (&["b", "strong", "h1", "h2", "h3", "h4", "th"], "font-weight", "bold"),
    (&["i", "em"], "font-style", "italic"),
    (&["u"], "text-decoration", "underline"),
    (&["s", "strike", "del"], "text-decoration", "line-through"),
];

/// Elements that are left out.
const LEFT_OUT: [&str; 9] = ["img", "table", "hr", "input", "button", "svg", "math", "iframe", "video"];
const BLOCKS: [&str; 12] = ["div", "p", "h1", "h2", "h3", "h4", "ul", "ol", "li", "center", "pre", "section"];

/// Widths of the letters from space to tilde in Helvetica, in thousandths of the font's size (Adobe's font metrics).
#[rustfmt::skip]
const WIDTHS: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556, 556, 556, 556, 556, 556, 278,
    278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667, 611, 722,
    667, 944, 667, 667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, 556,
    556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584,
];

/// Estimates the width of words. Other letters are taken to be 0.6 em wide, and bold ones to be 6 % wider.
fn width(words: &str, look: &Look) -> f64 {
    let advance = |c: char| WIDTHS.get((c as usize).wrapping_sub(32)).map_or(0.6, |w| f64::from(*w) / 1000.0);
    let is_bold = |v: &Rc<str>| matches!(&**v, "bold" | "bolder" | "600" | "700" | "800" | "900");
    let is_bold = look.shared.iter().flatten().any(is_bold);
    words.chars().map(advance).sum::<f64>() * look.size * if is_bold { 1.06 } else { 1.0 }
}

/// The text of a `foreignObject`, which is the first of `nodes` and `styles`. `None` if it has no words.
pub(super) fn foreign_text(nodes: &[Node<'_, '_>], styles: &[Styled<'_>], units: &Units) -> Option<Foreign> {
    let foreign = *nodes.first()?;
    let side = |name: &str| foreign.attribute(name).and_then(|v| units.length(name, v)).unwrap_or(0.0);
    let [x, y, width, height] = ["x", "y", "width", "height"].map(side);
    let shared = INITIAL.map(|v| v.map(Rc::from));
    let initial = Rc::new(Look { size: units.font, line_height: None, align: 0.0, wraps: true, shared });
    let mut html = Html { nodes, styles, units, pieces: Vec::new(), left_out: Vec::new() };
    let look = html.look(foreign, &initial);
    let room = Room { x, y, width, height, free_left: None, free_above: 0.0 };
    let (room, content, look) = html.innermost(foreign, room, look);
    html.add(content, &look);
    let lines = lines(html.pieces, if look.wraps { room.width } else { f64::INFINITY });
    (!lines.is_empty()).then(|| written(&lines, room, look.align, html.left_out))
}

/// Reads HTML.
struct Html<'n, 'a, 'i> {
    nodes: &'n [Node<'a, 'i>],
    styles: &'n [Styled<'a>],
    units: &'n Units,
    pieces: Vec<Piece>,
    left_out: Vec<String>,
}

impl<'a, 'i> Html<'_, 'a, 'i> {
    /// The value of a property of an element, or else of the obsolete attribute for it.
    fn property(&self, node: Node<'_, '_>, name: &str) -> Option<String> {
        let index = self.nodes.binary_search_by_key(&node.range().start, |n| n.range().start).ok()?;
        let declared = match &self.styles[index].computed.style {
            Some(style) => style.iter().rev().find(|d| d.0 == name).map(|d| d.1.to_string()),
            None => {
                let inline = declarations(node.attribute("style").unwrap_or_default());
                inline.iter().rev().find(|d| d.name == name).map(|d| d.value.to_string())
            }
        };
        let obsolete = [("color", "color"), ("font-family", "face"), ("text-align", "align")].into_iter();
        let obsolete = obsolete.filter(|o| o.0 == name).find_map(|o| node.attribute(o.1).map(ToOwned::to_owned));
        let value = declared.or(obsolete).map(|v| v.trim().to_owned());
        value.filter(|v| v.len() <= LONGEST && !v.eq_ignore_ascii_case("inherit"))
    }

    /// The value of a property in px. `font` is the size of the element's font, and `full` what 100 % stand for.
    fn px(&self, node: Node<'_, '_>, font: f64, name: &str, full: f64) -> Option<f64> {
        length(&self.property(node, name)?, &Units { font, ..*self.units }, full)
    }

    /// The look of an element's words, given the look of its parent. Records what else the element paints.
    fn look(&mut self, node: Node<'_, '_>, parent: &Rc<Look>) -> Rc<Look> {
        let mut look = Look::clone(parent);
        let tag = node.tag_name().name();
        if let Some(size) = self.property(node, "font-size") {
            let px = text::size(&size, parent.size).or_else(|| self.px(node, parent.size, "font-size", parent.size));
            look.size = px.unwrap_or(parent.size);
        }
        for ((name, _), value) in SHARED.iter().zip(&mut look.shared) {
            let by_default = STYLED.iter().find(|s| s.1 == *name && s.0.contains(&tag)).map(|s| s.2.to_owned());
            *value = self.property(node, name).or(by_default).map(Rc::from).or(value.take());
        }
        if let Some(height) = self.property(node, "line-height").filter(|_| look.size > 0.0) {
            let multiple = self.px(node, look.size, "line-height", look.size).map(|px| px / look.size);
            look.line_height = height.parse().ok().or(multiple).filter(|h| *h > 0.0);
        }
        let align = self.property(node, "text-align").or_else(|| (tag == "center").then(|| "center".to_owned()));
        look.align = align.map_or(look.align, |a| free_share(&a));
        look.wraps = self.property(node, "white-space").map_or(look.wraps, |w| !matches!(w.as_str(), "nowrap" | "pre"));
        for name in ["background", "background-color", "border", "box-shadow", "transform"] {
            let paints = |v: &String| !matches!(v.as_str(), "" | "none" | "transparent" | "initial" | "0" | "0px");
            let found = self.property(node, name).filter(paints);
            self.left_out.extend(found.map(|v| format!("“{name}: {}”", text::excerpt(&v))));
        }
        self.left_out.extend((tag == "li").then(|| "the marks of a list".to_owned()));
        // Most elements look like what is around them.
        if look == **parent { Rc::clone(parent) } else { Rc::new(look) }
    }

    /// Goes into elements that hold nothing but another one. Returns the room, the content and its look.
    fn innermost(&mut self, outer: Node<'a, 'i>, mut room: Room, mut look: Rc<Look>) -> (Room, Node<'a, 'i>, Rc<Look>) {
        let mut node = outer;
        loop {
            let has_words = node.children().any(|c| c.is_text() && !c.text().unwrap_or_default().trim().is_empty());
            let mut elements = node.children().filter(Node::is_element);
            let (Some(only), None, false) = (elements.next(), elements.next(), has_words) else { break };
            let tag = only.tag_name().name();
            if LEFT_OUT.contains(&tag) || tag == "br" {
                break;
            }
            look = self.look(only, &look);
            if BLOCKS.contains(&tag) {
                let px = |name: &str| self.px(only, look.size, name, room.width);
                let sides = |kind: &str| {
                    let side = |side: &str| px(&format!("{kind}-{side}")).or_else(|| px(kind)).unwrap_or(0.0);
                    ["left", "right", "top", "bottom"].map(side)
                };
                let (margin, padding) = (sides("margin"), sides("padding"));
                let is_border_box = self.property(only, "box-sizing").is_some_and(|b| b == "border-box");
                let inner = |declared: f64, padding: f64| if is_border_box { declared - padding } else { declared };
                room.x += margin[0] + padding[0];
                room.y += margin[2] + padding[2];
                let rest = room.width - margin[0] - padding[0] - margin[1] - padding[1];
                room.width = px("width").map_or(rest, |w| inner(w, padding[0] + padding[1]));
                if let Some(h) = self.px(only, look.size, "height", room.height) {
                    let height = inner(h, padding[2] + padding[3]);
                    room = Room { height, free_above: 0.0, free_left: None, ..room };
                }
            }
            if self.property(only, "display").is_some_and(|d| d.ends_with("flex")) {
                let share = |name: &str| self.property(only, name).map_or(0.0, |v| free_share(&v));
                let is_column = self.property(only, "flex-direction").is_some_and(|d| d.starts_with("column"));
                let (main, cross) = (share("justify-content"), share("align-items"));
                let (left, above) = if is_column { (cross, main) } else { (main, cross) };
                (room.free_left, room.free_above) = (Some(left), above);
            }
            node = only;
        }
        (room, node, look)
    }

    /// Adds the words of an element.
    fn add(&mut self, node: Node<'a, 'i>, look: &Rc<Look>) {
        for child in node.children() {
            if let Some(text) = child.text().filter(|_| child.is_text()) {
                for (i, word) in text.split(|c: char| c.is_ascii_whitespace()).enumerate() {
                    self.pieces.extend((i > 0).then_some(Piece::Space));
                    self.pieces.extend((!word.is_empty()).then(|| Piece::Word(word.to_owned(), Rc::clone(look))));
                }
            }
            let tag = child.tag_name().name();
            if LEFT_OUT.contains(&tag) {
                self.left_out.push(format!("<{tag}>"));
            } else if child.is_element() {
                let look = self.look(child, look);
                let is_block = BLOCKS.contains(&tag) || self.property(child, "display").is_some_and(|d| d == "block");
                self.pieces.extend((tag == "br" || (is_block && self.is_in_line())).then_some(Piece::Break));
                self.add(child, &look);
                self.pieces.extend((is_block && self.is_in_line()).then_some(Piece::Break));
            }
        }
    }

    /// Returns `true` if the last line has words so far.
    fn is_in_line(&self) -> bool {
        matches!(self.pieces.iter().rfind(|p| !matches!(p, Piece::Space)), Some(Piece::Word(..)))
    }
}

/// The share of the free room before content that CSS aligns by a keyword; `unsafe` may precede it.
fn free_share(keyword: &str) -> f64 {
    match keyword.rsplit(' ').next().unwrap_or_default() {
        "center" => 0.5,
        "right" | "end" | "flex-end" => 1.0,
        _ => 0.0,
    }
}

/// A part of a line with one look.
type Run = (String, Rc<Look>);

/// Breaks words into lines that are no wider than `max_width`.
fn lines(pieces: Vec<Piece>, max_width: f64) -> Vec<Vec<Run>> {
    let mut out: Vec<Vec<Run>> = vec![Vec::new()];
    let (mut line_width, mut after_space) = (0.0, false);
    for piece in pieces {
        let Piece::Word(word, look) = piece else {
            after_space = matches!(piece, Piece::Space);
            if !after_space {
                out.push(Vec::new());
                line_width = 0.0;
            }
            continue;
        };
        let (advance, gap) = (width(&word, &look), width(" ", &look));
        // Widths are rough, so a line may be a quarter of an em too wide.
        if after_space && line_width > 0.0 && line_width + gap + advance > max_width + 0.25 * look.size {
            out.push(Vec::new());
            line_width = 0.0;
        }
        let space = if after_space && line_width > 0.0 { " " } else { "" };
        line_width += advance + if space.is_empty() { 0.0 } else { gap };
        after_space = false;
        let Some(line) = out.last_mut() else { continue };
        match line.last_mut().filter(|run| run.1 == look) {
            Some(run) => run.0.extend([space, &word]),
            None => line.push((format!("{space}{word}"), look)),
        }
    }
    // A line break at the end starts no line.
    out.truncate(out.iter().rposition(|l| !l.is_empty()).map_or(0, |last| last + 1));
    out
}

/// Writes lines as text.
fn written(lines: &[Vec<Run>], room: Room, align: f64, left_out: Vec<String>) -> Foreign {
    // Lines without words are as high as the first words.
    let of_first = lines.iter().flatten().next().map_or((0.0, 0.0), |r| r.1.line_box());
    let tallest = |a: (f64, f64), b: (f64, f64)| if b.0 > a.0 { b } else { a };
    let line_box = |line: &Vec<Run>| line.iter().map(|r| r.1.line_box()).reduce(tallest).unwrap_or(of_first);
    let line_boxes: Vec<(f64, f64)> = lines.iter().map(line_box).collect();
    let widest = lines.iter().map(|l| l.iter().map(|r| width(&r.0, &r.1)).sum::<f64>()).fold(0.0, f64::max);
    // Lines are aligned in a block as wide as the widest, and the block in the room, unless the room has hardly any width.
    let block = if room.width < 2.0 { widest } else { widest.min(room.width) };
    let x = match room.free_left.filter(|left| *left != align) {
        Some(left) => room.x + left * (room.width - block) + align * block,
        None => room.x + align * room.width,
    };
    let mut y = room.y + room.free_above * (room.height - line_boxes.iter().map(|b| b.0).sum::<f64>());
    let anchor = ["start", "middle", "end"][(2.0 * align) as usize];
    let mut out = Foreign { content: String::new(), fills: Vec::new(), left_out };
    for (line, (height, letters_below_middle)) in lines.iter().zip(line_boxes) {
        let middle = y + 0.5 * height + letters_below_middle;
        y += height;
        if line.is_empty() {
            continue;
        }
        out.fills.push(None);
        let _ = write!(out.content, "<tspan x=\"{x:.4}\" y=\"{middle:.4}\" style=\"text-anchor:{anchor}\">");
        for (words, look) in line {
            let mut style = format!("font-size:{}px;dominant-baseline:central", look.size);
            for ((_, name), value) in SHARED.iter().zip(&look.shared) {
                style.extend(value.iter().flat_map(|v| [";", *name, ":", &**v]));
            }
            out.fills.push(look.shared[0].clone());
            let _ = write!(out.content, "<tspan style=\"{}\">{}</tspan>", escape(&style), escape(words));
        }
        out.content.push_str("</tspan>");
    }
    out
}
