//! Writes the computed style into the text of a drawing.

use crate::foreign::{self, Foreign};
use crate::ids::{attribute, attribute_node};
use crate::sheet::{Declaration, declarations};
use crate::text::{Letters, Rewritten, elements_touch, rewritten};
use crate::tree::{BYTES_PER_COMPARISON, Styled, Tree, styled};
use crate::value::{length, percent_decoded, safe_id};
use crate::words::Words;
use crate::xml::{self, escape, name_end};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use csscolorparser::Color;
use memchr::memmem;
use pathwarp::budget::{Budget, Exceeded, cost};
use pathwarp::engine::decimal::matrix;
use pathwarp::kurbo::Affine;
use roxmltree::{Document, Node};
use std::borrow::Cow;
use std::cell::OnceCell;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::ops::Range;
use std::sync::Arc;

const KERNED: &str = "letters of different elements of a text are kerned, which browsers do not do";

/// Words to search the text for, each with `true` if it is a unit, and the difference from browsers that it implies.
const HINTS: [(&str, bool, &str); 8] = [
    ("vw", true, WINDOW),
    ("vh", true, WINDOW),
    ("vmin", true, WINDOW),
    ("vmax", true, WINDOW),
    ("ex", true, "ex and ch are half an em in every font"),
    ("ch", true, "ex and ch are half an em in every font"),
    ("<tref", false, "tref shows nothing, as in browsers"),
    ("font-variation-settings", false, "font-variation-settings apply to installed fonts, too"),
];
const WINDOW: &str = "lengths in vw and vh refer to the drawing, not to a window around it";

/// Lists the differences from browsers that the words in a drawing imply.
fn hints(text: &str) -> impl Iterator<Item = &'static str> {
    let is_unit = |start: usize, word: &str| {
        let (before, after) = (text.as_bytes().get(start.wrapping_sub(1)), text.as_bytes().get(start + word.len()));
        before.is_some_and(u8::is_ascii_digit) && after.is_none_or(|b| b";)}\"', \n\t".contains(b))
    };
    let found = move |&&(word, unit, _): &&(&str, bool, &str)| {
        memmem::find_iter(text.as_bytes(), word).any(|start| !unit || is_unit(start, word))
    };
    HINTS.iter().filter(found).map(|&(_, _, difference)| difference)
}

/// Completes “… is drawn …”.
const SINGLE_LETTERS: &str = "only from left to right, as its letters have positions of their own";

/// A drawing resolved into plain SVG.
#[derive(Debug, Default)]
pub struct Plain {
    /// The new text of the drawing; `None` if it is the original text.
    pub text: Option<String>,
    /// Differences from the original, in the order of the text.
    pub changes: Vec<Change>,
    /// Unsupported features: the element, or `None` for the style sheets, and a phrase about it (after “is drawn” if it is “only …”).
    pub unsupported: Vec<(Option<usize>, String)>,
    /// Elements whose numbers were out of range, each with the first such number. The new text has smaller numbers instead.
    pub far: Vec<(usize, String)>,
    /// The properties that the style sheets declare.
    pub declared: BTreeSet<String>,
    /// The declarations about paint that win, for each element of the new text, in document order.
    pub words: Vec<Arc<Words>>,
    /// Small differences from what browsers show: a sentence, and the id or name it is about.
    pub notes: BTreeSet<(&'static str, String)>,
    /// Texts that stand for HTML in the same `switch`: the numbers of the `foreignObject` and the `text`.
    pub foreign: Vec<(usize, usize)>,
}

/// An attribute or a run of characters that differs from the original. Elements are numbered in the order of the new text, from 0.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Change {
    /// The last element that begins before the change.
    pub element: usize,
    /// The attribute's local name; `xml:space` keeps its prefix. Empty for text content.
    pub name: &'static str,
    /// Range in the new text (until [`resolve`] writes it, in the original): the attribute with the space before it, or the text content.
    pub range: Range<usize>,
    /// The original text.
    pub text: String,
    /// The attribute's value in an edited drawing, the output that keeps the original markup; `None` if it has none there. It differs from
    /// the original value if a transform was frozen, since the boxes that it refers to change, or if an id had to be renamed.
    pub value: Option<String>,
    /// The text of the attribute with this value, and the space before it.
    pub kept: String,
}

/// The reason why a drawing cannot be resolved.
#[derive(Debug)]
pub enum ReadError {
    /// It is not XML.
    Xml(roxmltree::Error),
    /// It takes more work than the budget allows.
    Limit(Exceeded),
}

impl From<Exceeded> for ReadError {
    fn from(e: Exceeded) -> Self {
        Self::Limit(e)
    }
}

/// A new value for an attribute.
struct Edit {
    name: &'static str,
    /// `None` removes the attribute.
    value: Option<String>,
    /// The value for an edited drawing, if it is not the original one.
    kept: Option<String>,
}

/// Returns the text of the drawing that an image links to; `None` if the link leads to none.
pub type Linked<'a> = &'a dyn Fn(&str) -> Option<String>;

/// Resolves a drawing whose markup is known to be within the budget (see [`xml::check`]).
///
/// # Errors
/// [`Exceeded`] when the style takes more work than the budget allows.
pub fn resolve(doc: &Document<'_>, budget: &Budget, linked: Linked<'_>) -> Result<Plain, Exceeded> {
    let text = doc.input_text();
    let (mut all, mut out) = changes(doc, budget, linked)?;
    if all.is_empty() {
        return Ok(out);
    }
    all.sort_by_key(|(change, _)| (change.range.start, change.range.end));
    let mut new_text = String::with_capacity(text.len() * 2);
    let mut copied_to = 0;
    for (change, new) in all {
        let Some(before) = text.get(copied_to..change.range.start) else { continue }; // It overlaps an earlier change.
        budget.spend(cost::COMPARISON * (new.len() / BYTES_PER_COMPARISON) as f64)?;
        copied_to = change.range.end;
        new_text.push_str(before);
        let start = new_text.len();
        new_text.push_str(&new);
        out.changes.push(Change { range: start..new_text.len(), ..change });
    }
    new_text.push_str(&text[copied_to..]);
    out.text = Some(new_text);
    Ok(out)
}

/// Lists all changes, each with its new text.
fn changes(
    doc: &Document<'_>,
    budget: &Budget,
    linked: Linked<'_>,
) -> Result<(Vec<(Change, String)>, Plain), Exceeded> {
    let text = doc.input_text();
    let nodes = xml::elements(doc);
    let Tree { styles, sheets, unsupported, declared, mut notes } = styled(doc, &nodes, budget)?;
    let unsupported = unsupported.into_iter().map(|why| (None, why)).collect();
    notes.extend(hints(text).map(|hint| (hint, String::new())));
    let mut out = Plain { unsupported, declared, notes, ..Plain::default() };
    let mut all: Vec<(Change, String)> = Vec::new();
    let mut defs = String::new();
    // If any id is renamed, edited drawings keep all references as they are written here.
    let has_escapes = text.contains('%') && text.contains("href");
    let references = References { text, targets: OnceCell::new(), has_escapes };
    let any_renamed = nodes.iter().filter_map(|n| n.attribute("id")).any(|id| references.break_at(id));
    // The end of content that has been replaced.
    let mut replaced_to = 0;
    for (i, (node, style)) in nodes.iter().zip(&styles).enumerate() {
        if node.range().start < replaced_to {
            continue;
        }
        let element = out.words.len();
        out.words.push(Arc::clone(&style.computed.words));
        let edits = edits(*node, style, Some(&references).filter(|_| any_renamed), linked);
        all.extend(edits.into_iter().map(|edit| edit.locate(text, element, *node)));
        if sheets.contains(&i) {
            // The styles are computed, so usvg must not apply the sheet again; it ignores sheets of other types.
            let edit = Edit { name: "type", value: Some("text/plain".to_owned()), kept: None };
            all.push(edit.locate(text, element, *node));
        }
        if node.tag_name().name() == "text" {
            if elements_touch(*node) {
                out.notes.insert((KERNED, node.attribute("id").unwrap_or_default().to_owned()));
            }
            if let Some((html, foreign)) = html_instead_of(i, &nodes, &styles)
                && let Some(change) = content_change(text, element, *node, foreign.content)
            {
                all.push(change);
                replaced_to = node.range().end;
                out.foreign.push((element - (i - html), element));
                out.words.extend(foreign.fills.iter().map(|fill| style.computed.words.with_fill(fill.as_deref())));
                let why = foreign.left_out.iter().map(|what| format!("only without {what}, which text does not have"));
                out.unsupported.extend(why.map(|why| (Some(element), why)));
            } else {
                match letter_changes(text, element, *node, &styles[i..]) {
                    Some(new) => all.extend(new),
                    None => out.unsupported.push((Some(element), SINGLE_LETTERS.to_owned())),
                }
            }
        }
        let id = node.attribute("id").unwrap_or_default();
        out.notes.extend(style.computed.notes.iter().map(|note| (*note, id.to_owned())));
        out.unsupported.extend(style.computed.unsupported.iter().map(|why| (Some(element), why.clone())));
        if style.matrix.is_none() {
            out.unsupported.push((Some(element), "its transform is not supported".to_owned()));
        }
        if style.computed.is_linear
            && let Some((edit, gradient)) = linear_gradient(i, *node, (&nodes, &styles))
        {
            all.push(edit.locate(text, element, *node));
            defs.push_str(&gradient);
        }
        if let Some((edit, path)) = path_of_text(element, *node, doc) {
            all.push(edit.locate(text, element, *node));
            defs.push_str(&path);
        }
        out.far.extend(style.computed.far.iter().map(|far| (element, far.clone())));
    }
    if let Some(end) = text[..doc.root_element().range().end].rfind('<').filter(|_| !defs.is_empty()) {
        let new = format!("<defs xmlns=\"http://www.w3.org/2000/svg\">{defs}</defs>");
        let empty = Change { element: out.words.len() - 1, range: end..end, ..Change::default() };
        all.push((empty, new));
    }
    Ok((all, out))
}

/// An id that the drawing does not hold.
fn new_id(name: &str, number: usize, text: &str) -> String {
    let mut id = format!("{name}-{number}");
    while text.contains(&id) {
        id.push('x');
    }
    id
}

/// Makes an sRGB gradient of one that is interpolated in linear light, which usvg does not know. Returns the edit that renames the old
/// gradient, and the new one, which takes its geometry from the old one.
fn linear_gradient(
    index: usize,
    node: Node<'_, '_>,
    (nodes, styles): (&[Node<'_, '_>], &[Styled<'_>]),
) -> Option<(Edit, String)> {
    /// Stops for each interval. Colours between them are off by less than a level.
    const STEPS: usize = 32;
    let text = node.document().input_text();
    let id = node.attribute("id")?;
    let descendants = nodes.iter().zip(styles).skip(index + 1).take_while(|(n, _)| n.range().start < node.range().end);
    let mut last = 0.0_f32;
    let stops = descendants.filter_map(|(n, s)| {
        let given = n.attribute("offset").unwrap_or("0").trim();
        let share = given.strip_suffix('%').map(|p| p.parse().map(|v: f32| v / 100.0));
        // Offsets do not decrease.
        last = share.unwrap_or_else(|| given.parse()).unwrap_or(0.0).clamp(last, 1.0);
        Some((last, s.computed.stop?))
    });
    let stops: Vec<(f32, Color)> = stops.collect();
    let old = new_id("gradient", index, text);
    let mut out = String::new();
    for (i, (offset, color)) in stops.iter().enumerate() {
        let next = stops.get(i + 1).filter(|n| n.0 > *offset);
        for step in 0..if next.is_some() { STEPS } else { 1 } {
            let t = step as f32 / STEPS as f32;
            let mixed = next.map_or_else(|| *color, |n| color.interpolate_linear_rgb(&n.1, t));
            let offset = next.map_or(*offset, |n| offset + t * (n.0 - offset));
            let [r, g, b, a] = mixed.to_array();
            let [r, g, b] = [r, g, b].map(|v| (255.0 * v).round());
            let _ = write!(out, "<stop offset=\"{offset}\" stop-color=\"rgb({r},{g},{b})\" stop-opacity=\"{a}\"/>");
        }
    }
    let tag = node.tag_name().name();
    let new = format!("<{tag} id=\"{}\" href=\"#{old}\">{out}</{tag}>", escape(&safe_id(id)));
    (stops.len() > 1).then(|| (Edit { name: "id", value: Some(old), kept: Some(id.to_owned()) }, new))
}

/// Makes a path from the path data in the attribute `path` of a `textPath`, which usvg ignores. Returns the link to the path, and the path.
fn path_of_text(element: usize, node: Node<'_, '_>, doc: &Document<'_>) -> Option<(Edit, String)> {
    let data = node.attribute("path").filter(|_| node.tag_name().name() == "textPath")?;
    let id = new_id("text-path", element, doc.input_text());
    let path = format!("<path id=\"{id}\" d=\"{}\"/>", escape(data));
    Some((Edit { name: "href", value: Some(format!("#{id}")), kept: None }, path))
}

impl Edit {
    /// Locates the edit in the text. Returns the change and the attribute to write.
    fn locate(self, text: &str, element: usize, node: Node<'_, '_>) -> (Change, String) {
        let Self { name, value, kept } = self;
        let found = attribute_node(node, name);
        let range = attribute_range(text, node, found);
        let old = text[range.clone()].to_owned();
        // Keep the line numbers of everything that follows.
        let lines = "\n".repeat(old.matches('\n').count());
        let qname = found.and_then(|a| text.get(a.range_qname())).unwrap_or(name);
        let written = |value: &str| format!(" {lines}{qname}=\"{}\"", escape(value));
        let new = value.as_deref().map_or_else(|| lines.clone(), written);
        let (value, kept) = match kept {
            Some(v) => (Some(v.clone()), written(&v)),
            None => (found.map(|a| a.value().to_owned()), old.clone()),
        };
        (Change { element, name, range, text: old, value, kept }, new)
    }
}

/// The HTML that a text stands for: the index of the `foreignObject` before it in a `switch`, and the words in it.
fn html_instead_of(i: usize, nodes: &[Node<'_, '_>], styles: &[Styled<'_>]) -> Option<(usize, Foreign)> {
    nodes[i].parent_element().filter(|p| p.tag_name().name() == "switch")?;
    // Only the first text counts.
    let before = nodes[i].prev_siblings().skip(1).filter(Node::is_element);
    let found = before.take_while(|n| n.tag_name().name() != "text").find(|n| n.tag_name().name() == "foreignObject");
    let found = found.filter(|n| !n.has_attribute("requiredExtensions"))?;
    let html = nodes.binary_search_by_key(&found.range().start, |n| n.range().start).ok()?;
    let end = html + nodes[html..i].partition_point(|n| n.range().start < found.range().end);
    Some((html, foreign::foreign_text(&nodes[html..end], &styles[html..end], &styles[html].units)?))
}

/// The change that gives an element other content.
fn content_change(text: &str, element: usize, node: Node<'_, '_>, mut new: String) -> Option<(Change, String)> {
    let (first, last) = (node.first_child()?, node.last_child()?);
    let change = change_of_content(text, element, first.range().start..last.range().end)?;
    // Keep the line numbers of everything that follows.
    new.push_str(&"\n".repeat(change.text.matches('\n').count()));
    Some((change, new))
}

fn change_of_content(text: &str, element: usize, range: Range<usize>) -> Option<Change> {
    let old = text.get(range.clone())?.to_owned();
    Some(Change { element, range, text: old.clone(), kept: old, ..Change::default() })
}

/// Lists the changes to the content of a text. Returns `None` if they cannot be made.
fn letter_changes(
    text: &str,
    element: usize,
    node: Node<'_, '_>,
    styles: &[Styled<'_>],
) -> Option<impl Iterator<Item = (Change, String)>> {
    let elements = node.descendants().filter(Node::is_element).count();
    let letters: Vec<Letters> = styles.iter().take(elements).map(|s| s.computed.letters).collect();
    let new = if letters.iter().all(|l| *l == Letters::default()) { Vec::new() } else { rewritten(node, &letters)? };
    let start = node.range().start;
    // The content of an entity is in its declaration, before the text.
    let in_place = new.into_iter().filter(move |r| r.range.start > start);
    Some(in_place.filter_map(move |Rewritten { elements, range, text: new }| {
        Some((change_of_content(text, element + elements, range)?, escape(&new)))
    }))
}

/// Lists the changes to an element's attributes. `renamed` is `None` if no id is renamed.
fn edits(node: Node<'_, '_>, style: &Styled<'_>, renamed: Option<&References<'_>>, linked: Linked<'_>) -> Vec<Edit> {
    let computed = &style.computed;
    let refers = |v: &&String| renamed.is_some() && v.contains("url(#");
    let attributes = computed.attributes.iter();
    let mut out: Vec<Edit> =
        attributes.map(|(name, v)| Edit { name, value: v.clone(), kept: v.as_ref().filter(refers).cloned() }).collect();
    out.extend(renames(node, renamed));
    out.extend(attributes_to_remove(node).map(|name| Edit { name, value: None, kept: None }));
    let embedded = embedded_drawing(node, style, linked).into_iter().flatten();
    out.extend(embedded.map(|(name, value)| Edit { name, value: Some(value), kept: None }));
    // Without a transform, the origin may serve an animation: it stays.
    let is_transformed = || node.has_attribute("transform") && !computed.transform.is_empty();
    let frozen = style.matrix.filter(|m| *m != Affine::IDENTITY || is_transformed()).map(frozen);
    let css_text = |all: &mut dyn Iterator<Item = (&str, &str)>| {
        all.map(|(n, v)| format!("{n}:{v}")).collect::<Vec<_>>().join(";")
    };
    let new_style = computed.style.as_ref().map(|s| css_text(&mut s.iter().map(|(n, v)| (n.as_ref(), v.as_ref()))));
    if let Some([(_, list), ..]) = frozen.as_ref().filter(|_| node.parent_element().is_none()) {
        // usvg reads the root's transform from its attribute only, and turns it about the centre unless another origin is given.
        out.retain(|edit| edit.name != "transform");
        out.push(Edit { name: "transform", value: Some(list.clone()), kept: None });
        out.push(Edit { name: "transform-origin", value: Some("0 0".to_owned()), kept: None });
        out.extend(new_style.map(|v| Edit { name: "style", value: Some(v).filter(|v| !v.is_empty()), kept: None }));
    } else if let Some(all) = frozen {
        let old = node.attribute("style").unwrap_or_default().to_owned();
        let others = new_style.unwrap_or_else(|| {
            let all = declarations(&old);
            css_text(&mut all.iter().map(|d| (d.name.as_ref(), d.value.as_ref())))
        });
        let value = css_text(&mut all[..2].iter().map(|(n, v)| (*n, v.as_str())));
        let value = if others.is_empty() { value } else { format!("{others};{value}") };
        let important = if computed.transform.iter().any(|d| d.important) { " !important" } else { "" };
        let kept = all.iter().fold(old, |s, (name, value)| with_declaration(&s, name, &format!("{value}{important}")));
        out.push(Edit { name: "style", value: Some(value), kept: Some(kept) });
    } else if let Some(value) = new_style {
        let kept = Some(&value).filter(refers).cloned();
        out.push(Edit { name: "style", value: Some(value).filter(|v| !v.is_empty()), kept });
    }
    out
}

/// Renames ids with characters that would end a reference to them, and corrects links. Edited drawings keep both changes.
fn renames(node: Node<'_, '_>, renamed: Option<&References<'_>>) -> impl Iterator<Item = Edit> {
    node.attributes().filter_map(move |a| {
        let (name, new) = match a.name() {
            "id" if a.namespace().is_none() && renamed.is_some_and(|r| r.break_at(a.value())) => {
                ("id", safe_id(a.value()))
            }
            "href" => {
                let fragment = a.value().trim().strip_prefix('#')?;
                let decoded = percent_decoded(fragment);
                match safe_id(&decoded) {
                    id if id == fragment => return None,
                    id => ("href", Cow::Owned(format!("#{id}"))),
                }
            }
            _ => return None,
        };
        (new != a.value()).then(|| Edit { name, value: Some(new.clone().into_owned()), kept: Some(new.into_owned()) })
    })
}

/// Texts in a drawing that may be references.
struct References<'t> {
    text: &'t str,
    /// The text after each number sign up to the next one, without the escapes of XML and CSS, sorted. Computed on first use.
    targets: OnceCell<Vec<String>>,
    /// `true` if some links may have percent escapes.
    has_escapes: bool,
}

impl References<'_> {
    /// Returns `true` if references break at an id: it contains characters that end them, and something may refer to it.
    fn break_at(&self, id: &str) -> bool {
        if safe_id(id) == id {
            return false;
        }
        let targets = self.targets.get_or_init(|| {
            let mut all: Vec<_> = unescaped(self.text).split('#').skip(1).map(str::to_owned).collect();
            all.sort_unstable();
            all
        });
        let next = targets.get(targets.partition_point(|t| t.as_str() < id));
        self.has_escapes || next.is_some_and(|t| t.starts_with(id))
    }
}

/// A text without the escapes of XML and CSS for quotes and other signs.
fn unescaped(text: &str) -> String {
    const SIGNS: [(&str, &str); 6] =
        [("&quot;", "\""), ("&#34;", "\""), ("&apos;", "'"), ("&#39;", "'"), ("&amp;", "&"), ("\\", "")];
    SIGNS.iter().fold(text.to_owned(), |out, (from, to)| out.replace(from, to))
}

/// Sets a property in a style attribute.
fn with_declaration(style: &str, name: &str, value: &str) -> String {
    let important = |d: &Declaration<'_>| if d.important { " !important" } else { "" };
    let all = declarations(style);
    let others = all.iter().filter(|d| d.name != name).map(|d| format!("{}:{}{}", d.name, d.value, important(d)));
    others.chain([format!("{name}:{value}")]).collect::<Vec<_>>().join(";")
}

/// Declares a transform that depends on no box, without any other part of a transform. usvg needs only the first two declarations.
fn frozen(m: Affine) -> [(&'static str, String); 6] {
    let none = || "none".to_owned();
    [
        ("transform", matrix(m).replace(' ', ",")),
        ("transform-origin", "0 0".to_owned()),
        ("transform-box", "view-box".to_owned()),
        ("rotate", none()),
        ("scale", none()),
        ("translate", none()),
    ]
}

/// The range of an attribute with the space before it. Without an attribute, an empty range after the element's name.
fn attribute_range(text: &str, node: Node<'_, '_>, attribute: Option<roxmltree::Attribute<'_, '_>>) -> Range<usize> {
    if let Some(a) = attribute {
        let range = a.range();
        return text[..range.start].trim_end().len()..range.end;
    }
    let end = name_end(text, node);
    end..end
}

/// Lists the attributes to remove regardless of style.
fn attributes_to_remove(node: Node<'_, '_>) -> impl Iterator<Item = &'static str> {
    let root = ["display", "systemLanguage"].into_iter().filter(move |name| {
        // Browsers always show the root of a file.
        node.parent_element().is_none() && node.has_attribute(*name)
    });
    // No browser knows `tref`.
    let tref = (node.tag_name().name() == "tref" && attribute(node, "href").is_some()).then_some("href");
    // Any other character makes the list invalid, and nothing is drawn.
    let is_list =
        |b: u8| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.' | b',' | b'e' | b'E') || b.is_ascii_whitespace();
    let damaged = node.attribute("points").is_some_and(|list| !list.bytes().all(is_list));
    // Always fulfilled in browsers.
    let features = node.has_attribute("requiredFeatures").then_some("requiredFeatures");
    root.chain(tref).chain(damaged.then_some("points")).chain(features)
}

/// New attributes of an image that shows a drawing, which becomes embedded. A drawing with a viewBox fills the image's box by its
/// `preserveAspectRatio`, and is cut off there (CSS Images 3, section 4.2). Chromium stretches a drawing without a viewBox from its size to
/// the box; sides in percent, or not given, refer to the box. If the image's `preserveAspectRatio` is `none`, Chromium so stretches every
/// drawing with a fixed size, and the viewBox of every other.
fn embedded_drawing(
    image: Node<'_, '_>,
    style: &Styled<'_>,
    linked: Linked<'_>,
) -> Option<[(&'static str, String); 2]> {
    let link = attribute(image, "href").filter(|_| image.tag_name().name() == "image")?.trim();
    let text = link.strip_prefix("data:").map_or_else(|| linked(link), drawing_in_data)?;
    let drawing = xml::document(&text).ok()?;
    let root = drawing.root_element();
    let side = |name: &str| style.units.length(name, style.computed.value(image, name)?);
    let (width, height) = (side("width")?, side("height")?);
    let inner = |name: &str, full: f64| root.attribute(name).map_or(Some(full), |v| length(v, &style.units, full));
    let is_fixed = |name: &str| root.attribute(name).is_some_and(|v| !v.contains('%'));
    let stretched = image.attribute("preserveAspectRatio").is_some_and(|a| a.trim_start().starts_with("none"));
    let fills = root.has_attribute("viewBox") && !(stretched && is_fixed("width") && is_fixed("height"));
    let (w, h) = if fills { (width, height) } else { (inner("width", width)?, inner("height", height)?) };
    let aspect = if fills && stretched { " preserveAspectRatio=\"none\"" } else { "" };
    let (range, mut copied_to) = (root.range(), name_end(&text, root));
    let mut new = format!(
        "{}<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {w} {h}\" \
         preserveAspectRatio=\"none\">{} width=\"{w}\" height=\"{h}\"{aspect}",
        &text[..range.start],
        &text[range.start..copied_to]
    );
    let is_set =
        |name: &str| matches!(name, "width" | "height") || (!aspect.is_empty() && name == "preserveAspectRatio");
    for a in root.attributes().filter(|a| a.namespace().is_none() && is_set(a.name())) {
        new.push_str(text.get(copied_to..a.range().start)?);
        copied_to = a.range().end;
    }
    new.push_str(&text[copied_to..range.end]);
    new.push_str("</svg>");
    let link = format!("data:image/svg+xml;base64,{}", STANDARD.encode(new));
    Some([("href", link), ("preserveAspectRatio", "none".to_owned())])
}

/// The drawing in the part of a `data:` URL behind the colon.
fn drawing_in_data(data: &str) -> Option<String> {
    let (kind, data) = data.split_once(',').filter(|(kind, _)| kind.starts_with("image/svg+xml"))?;
    if !kind.ends_with("base64") {
        return Some(percent_decoded(data).into_owned());
    }
    let data: String = data.split_ascii_whitespace().collect();
    String::from_utf8(STANDARD.decode(data).ok()?).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resolved(body: &str) -> String {
        let svg =
            format!("<svg xmlns='http://www.w3.org/2000/svg' xmlns:x='http://www.w3.org/1999/xlink'>{body}</svg>");
        resolve(&xml::document(&svg).unwrap(), &Budget::default(), &|_| None).unwrap().text.unwrap_or(svg)
    }

    #[test]
    fn ids_of_any_length_are_renamed_with_their_references() {
        let rest = "b".repeat(100);
        for (id, reference) in [("a(", "url(#a\\("), ("a'", "url(\"#a&#39;"), ("a&quot;", "url('#a&#34;")] {
            let quote = reference.strip_prefix("url(").unwrap().split('#').next().unwrap();
            let (id, fill) = (format!("{id}{rest}"), format!("{reference}{rest}{quote})").replace('"', "&quot;"));
            let out = resolved(&format!("<g id=\"{id}\"/><path fill=\"{fill}\"/>"));
            assert!(!out.contains(&id), "{out}");
            let new = out.split("id=\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap();
            assert!(out.contains(&format!("url(#{new})")), "{out}");
        }
    }

    /// SVG 2, section 16.1.5: a link with a prefix does not count beside one without.
    #[test]
    fn links_without_a_prefix_count() {
        let drawing =
            |color: &str| format!("data:image/svg+xml,<svg xmlns='http://www.w3.org/2000/svg' fill='{color}'/>");
        let image = |x: &str, link: &str| {
            format!(
                "<image width='9' height='9' x:href=\"{}\" href=\"{}\"/>",
                escape(&drawing(x)),
                escape(&drawing(link))
            )
        };
        let data = |svg: &str| svg.split(" href=\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
        assert_eq!(data(&resolved(&image("red", "blue"))), data(&resolved(&image("lime", "blue"))));
    }
}
