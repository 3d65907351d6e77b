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
    /// The parts of the HTML that are not text, worded for people.
    pub(super) beyond: Vec<String>,
}

/// The style of words.
#[derive(Clone, PartialEq)]
struct Look {
    size: f64,
    /// Height of a line as a multiple of the size; `None` for the height that the font sets.
    line: Option<f64>,
    /// The share of the free room beside the words that is on their left.
    align: f64,
    wraps: bool,
    /// Values of [`SAME`].
    same: [Option<Rc<str>>; SAME.len()],
}

/// A rectangle for the text, and the shares of the free room to its left and above it. `across` is `None` for text that fills the width.
#[derive(Clone, Copy)]
struct Room {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
    across: Option<f64>,
    down: f64,
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
        let height = self.line.map_or(ascent.round() + descent.round() + gap.round(), |line| line * self.size);
        let above = ((height - ascent.round() - descent.round()) / 2.0).floor() + ascent.round();
        (height, above - 0.5 * (height + ascent - descent))
    }
}

/// Properties of fonts and text that mean the same in SVG, by their names there.
const SAME: [(&str, &str); 5] = [
    ("color", "fill"),
    ("font-family", "font-family"),
    ("font-weight", "font-weight"),
    ("font-style", "font-style"),
    ("text-decoration", "text-decoration"),
];

/// Initial values of [`SAME`]. The `text` that the words are written to may have other values.
const INITIAL: [Option<&str>; SAME.len()] = [Some("currentColor"), None, Some("normal"), Some("normal"), None];

/// The longest value of a property, in bytes.
const LONGEST: usize = 256;

/// Elements with a default style, as the property and its value.
const STYLED: [(&[&str], &str, &str); 4] = [
    (&["b", "strong", "h1", "h2", "h3", "h4", "th"], "font-weight", "bold"),
    (&["i", "em"], "font-style", "italic"),
    (&["u"], "text-decoration", "underline"),
    (&["s", "strike", "del"], "text-decoration", "line-through"),
];

const BEYOND: [&str; 9] = ["img", "table", "hr", "input", "button", "svg", "math", "iframe", "video"];
const BLOCKS: [&str; 12] = ["div", "p", "h1", "h2", "h3", "h4", "ul", "ol", "li", "center", "pre", "section"];

/// Widths of the letters from space to tilde in Helvetica, in thousandths of the font's size (Adobe's font metrics).
#[rustfmt::skip]
const WIDTHS: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556, 556, 556, 556, 556, 556, 278,
    278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667, 611, 722,
    667, 944, 667, 667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, 556,
    556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584,
];

/// Estimates the width of words.
fn width(words: &str, look: &Look) -> f64 {
    let advance = |c: char| WIDTHS.get((c as usize).wrapping_sub(32)).map_or(0.6, |w| f64::from(*w) / 1000.0);
    let is_bold = look.same.iter().flatten().any(|v| matches!(&**v, "bold" | "bolder" | "600" | "700" | "800" | "900"));
    words.chars().map(advance).sum::<f64>() * look.size * if is_bold { 1.06 } else { 1.0 }
}

/// The text of a `foreignObject`, which is the first of `nodes` and `styles`. `None` if it has no words.
pub(super) fn foreign_text(nodes: &[Node<'_, '_>], styles: &[Styled<'_>], units: &Units) -> Option<Foreign> {
    let foreign = *nodes.first()?;
    let side = |name: &str, full: f64| foreign.attribute(name).and_then(|v| length(v, units, full)).unwrap_or(0.0);
    let [x, y, width, height] = [("x", 0), ("y", 1), ("width", 0), ("height", 1)]
        .map(|(name, axis)| side(name, if axis == 0 { units.viewport.0 } else { units.viewport.1 }));
    let same = INITIAL.map(|v| v.map(Rc::from));
    let look = Rc::new(Look { size: units.font, line: None, align: 0.0, wraps: true, same });
    let mut html = Html { nodes, styles, units, pieces: Vec::new(), beyond: Vec::new() };
    let look = html.look(foreign, &look);
    let (room, content, look) = html.innermost(foreign, Room { x, y, width, height, across: None, down: 0.0 }, look);
    html.add(content, &look);
    let lines = lines(html.pieces, if look.wraps { room.width } else { f64::INFINITY });
    (!lines.is_empty()).then(|| written(&lines, room, look.align, html.beyond))
}

/// Reads HTML.
struct Html<'n, 'a, 'i> {
    nodes: &'n [Node<'a, 'i>],
    styles: &'n [Styled<'a>],
    units: &'n Units,
    pieces: Vec<Piece>,
    beyond: Vec<String>,
}

impl<'a, 'i> Html<'_, 'a, 'i> {
    /// The value of a property of an element, or else of the obsolete attribute for it.
    fn property(&self, node: Node<'_, '_>, name: &str) -> Option<String> {
        let at = self.nodes.binary_search_by_key(&node.range().start, |n| n.range().start).ok()?;
        let found = match &self.styles[at].computed.style {
            Some(style) => style.iter().rev().find(|d| d.0 == name).map(|d| d.1.to_string()),
            None => {
                let inline = declarations(node.attribute("style").unwrap_or_default());
                inline.iter().rev().find(|d| d.name == name).map(|d| d.value.to_string())
            }
        };
        let old = [("color", "color"), ("font-family", "face"), ("text-align", "align")].into_iter();
        let old = old.filter(|o| o.0 == name).find_map(|o| node.attribute(o.1).map(ToOwned::to_owned));
        let found = found.or(old).map(|v| v.trim().to_owned());
        found.filter(|v| v.len() <= LONGEST && !v.eq_ignore_ascii_case("inherit"))
    }

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
        for ((name, _), value) in SAME.iter().zip(&mut look.same) {
            let by_default = STYLED.iter().find(|s| s.1 == *name && s.0.contains(&tag)).map(|s| s.2.to_owned());
            *value = self.property(node, name).or(by_default).map(Rc::from).or(value.take());
        }
        if let Some(line) = self.property(node, "line-height").filter(|_| look.size > 0.0) {
            let px = self.px(node, look.size, "line-height", look.size).map(|px| px / look.size);
            look.line = line.parse().ok().or(px).filter(|l| *l > 0.0);
        }
        let align = self.property(node, "text-align").or_else(|| (tag == "center").then(|| "center".to_owned()));
        look.align = align.map_or(look.align, |a| free_share(&a));
        look.wraps = self.property(node, "white-space").map_or(look.wraps, |w| !matches!(w.as_str(), "nowrap" | "pre"));
        for name in ["background", "background-color", "border", "box-shadow", "transform"] {
            let paints = |v: &String| !matches!(v.as_str(), "" | "none" | "transparent" | "initial" | "0" | "0px");
            let found = self.property(node, name).filter(paints);
            self.beyond.extend(found.map(|v| format!("“{name}: {}”", text::start(&v))));
        }
        self.beyond.extend((tag == "li").then(|| "the marks of a list".to_owned()));
        // Most elements look like what is around them.
        if look == **parent { Rc::clone(parent) } else { Rc::new(look) }
    }

    /// Goes into elements that hold nothing but another one. Returns the room, the content and its look.
    fn innermost(&mut self, outer: Node<'a, 'i>, mut room: Room, mut look: Rc<Look>) -> (Room, Node<'a, 'i>, Rc<Look>) {
        let mut node = outer;
        loop {
            let has_words = node.children().any(|c| c.is_text() && !c.text().unwrap_or_default().trim().is_empty());
            let mut inside = node.children().filter(Node::is_element);
            let (Some(only), None, false) = (inside.next(), inside.next(), has_words) else { break };
            let tag = only.tag_name().name();
            if BEYOND.contains(&tag) || tag == "br" {
                break;
            }
            look = self.look(only, &look);
            if BLOCKS.contains(&tag) {
                let px = |name: &str| self.px(only, look.size, name, room.width);
                // The margin and the padding of a side.
                let side = |edge: &str| {
                    ["margin", "padding"].map(|kind| px(&format!("{kind}-{edge}")).or_else(|| px(kind)).unwrap_or(0.0))
                };
                let [left, right, top, bottom] = ["left", "right", "top", "bottom"].map(side);
                let border_box = self.property(only, "box-sizing").is_some_and(|b| b == "border-box");
                let inner = |given: f64, padding: f64| if border_box { given - padding } else { given };
                room.x += left[0] + left[1];
                room.y += top[0] + top[1];
                let rest = room.width - left[0] - left[1] - right[0] - right[1];
                room.width = px("width").map_or(rest, |w| inner(w, left[1] + right[1]));
                if let Some(h) = self.px(only, look.size, "height", room.height) {
                    (room.height, room.down, room.across) = (inner(h, top[1] + bottom[1]), 0.0, None);
                }
            }
            if self.property(only, "display").is_some_and(|d| d.ends_with("flex")) {
                let share = |name: &str| self.property(only, name).map_or(0.0, |v| free_share(&v));
                let is_column = self.property(only, "flex-direction").is_some_and(|d| d.starts_with("column"));
                let (main, cross) = (share("justify-content"), share("align-items"));
                let (across, down) = if is_column { (cross, main) } else { (main, cross) };
                (room.across, room.down) = (Some(across), down);
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
            if BEYOND.contains(&tag) {
                self.beyond.push(format!("<{tag}>"));
            } else if child.is_element() {
                let look = self.look(child, look);
                let is_block = BLOCKS.contains(&tag) || self.property(child, "display").is_some_and(|d| d == "block");
                let is_open = |pieces: &[Piece]| {
                    matches!(pieces.iter().rfind(|p| !matches!(p, Piece::Space)), Some(Piece::Word(..)))
                };
                self.pieces.extend((tag == "br" || (is_block && is_open(&self.pieces))).then_some(Piece::Break));
                self.add(child, &look);
                self.pieces.extend((is_block && is_open(&self.pieces)).then_some(Piece::Break));
            }
        }
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

/// Breaks words into lines that are no wider than `room`.
fn lines(pieces: Vec<Piece>, room: f64) -> Vec<Vec<Run>> {
    let mut out: Vec<Vec<Run>> = vec![Vec::new()];
    let (mut reached, mut space) = (0.0, false);
    for piece in pieces {
        let Piece::Word(word, look) = piece else {
            space = matches!(piece, Piece::Space);
            if !space {
                out.push(Vec::new());
                reached = 0.0;
            }
            continue;
        };
        let (advance, gap) = (width(&word, &look), width(" ", &look));
        // Widths are rough, so a line may be a quarter of an em too wide.
        if space && reached > 0.0 && reached + gap + advance > room + 0.25 * look.size {
            out.push(Vec::new());
            reached = 0.0;
        }
        let joint = if space && reached > 0.0 { " " } else { "" };
        reached += advance + if joint.is_empty() { 0.0 } else { gap };
        space = false;
        let line = out.last_mut().filter(|line| line.last().is_none_or(|run| run.1 != look));
        match line {
            Some(line) => line.push((format!("{joint}{word}"), look)),
            None => out.last_mut().and_then(|l| l.last_mut()).into_iter().for_each(|run| run.0.extend([joint, &word])),
        }
    }
    // A line break at the end starts no line.
    out.truncate(out.iter().rposition(|l| !l.is_empty()).map_or(0, |last| last + 1));
    out
}

/// Writes lines as text.
fn written(lines: &[Vec<Run>], room: Room, align: f64, beyond: Vec<String>) -> Foreign {
    let usual = lines.iter().flatten().next().map_or((0.0, 0.0), |r| r.1.line_box());
    let tallest = |a: (f64, f64), b: (f64, f64)| if b.0 > a.0 { b } else { a };
    let heights = lines.iter().map(|l| l.iter().map(|r| r.1.line_box()).reduce(tallest).unwrap_or(usual));
    let heights: Vec<(f64, f64)> = heights.collect();
    let widest = lines.iter().map(|l| l.iter().map(|r| width(&r.0, &r.1)).sum::<f64>()).fold(0.0, f64::max);
    // Lines are aligned in a block as wide as the widest, and the block in the room, unless the room has hardly any width.
    let block = if room.width < 2.0 { widest } else { widest.min(room.width) };
    let x = match room.across {
        Some(across) if across == align => room.x + align * room.width,
        Some(across) => room.x + across * (room.width - block) + align * block,
        None => room.x + align * room.width,
    };
    let mut y = room.y + room.down * (room.height - heights.iter().map(|h| h.0).sum::<f64>());
    let anchor = ["start", "middle", "end"][(2.0 * align) as usize];
    let mut out = Foreign { content: String::new(), fills: Vec::new(), beyond };
    for (line, (height, lower)) in lines.iter().zip(heights) {
        let middle = y + 0.5 * height + lower;
        y += height;
        if line.is_empty() {
            continue;
        }
        out.fills.push(None);
        let _ = write!(out.content, "<tspan x=\"{x:.4}\" y=\"{middle:.4}\" style=\"text-anchor:{anchor}\">");
        for (words, look) in line {
            let mut style = format!("font-size:{}px;dominant-baseline:central", look.size);
            for ((_, name), value) in SAME.iter().zip(&look.same) {
                style.extend(value.iter().flat_map(|v| [";", *name, ":", &**v]));
            }
            out.fills.push(look.same[0].clone());
            let _ = write!(out.content, "<tspan style=\"{}\">{}</tspan>", escape(&style), escape(words));
        }
        out.content.push_str("</tspan>");
    }
    out
}
