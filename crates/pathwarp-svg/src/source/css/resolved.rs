//! Writes computed style into the text.

use super::cascade::own;
use super::letters::{Rewritten, rewritten};
use super::needed::is_needed;
use super::text::Letters;
use super::tree::{Styled, Tree, attribute, styled};
use crate::source::style::with_declaration;
use crate::source::tags::ElementId;
use crate::source::xml::{self, escape};
use pathwarp::budget::{Budget, Exceeded, Limit};
use pathwarp::kurbo::Affine;
use std::ops::Range;
use usvg::roxmltree::{NS_XML_URI, Node};

/// Bytes of style that are written in the time of a comparison.
const WRITTEN: usize = 16;

const SINGLE_LETTERS: &str = "only from left to right, as its letters have positions of their own";

/// The text with its style resolved.
#[derive(Debug)]
pub(crate) struct Resolved {
    pub(crate) text: String,
    /// In the order of the text.
    pub(crate) originals: Vec<Original>,
    /// What is not supported: the element, or none for the style sheets, and what there is to say.
    pub(crate) unsupported: Vec<(Option<ElementId>, String)>,
}

/// An attribute or words that differ from the file's.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Original {
    /// The last element that begins before.
    pub(crate) element: ElementId,
    /// The attribute's name. Words have none.
    pub(crate) name: &'static str,
    /// The attribute and the space before it, or the words.
    pub(crate) range: Range<usize>,
    /// The file's own text in this place.
    pub(crate) text: String,
    /// The attribute's value in a result that does not change it, if it has one there: that of the file, unless a transform is
    /// frozen, as boxes that it refers to change.
    pub(crate) value: Option<String>,
    /// That attribute, with the space before it.
    pub(crate) kept: String,
}

/// A new value for an attribute, and what a result is to have if that is not what the file has.
struct Edit {
    name: &'static str,
    value: String,
    kept: Option<String>,
}

/// Resolves the style of a drawing. Returns `None` if usvg reads it as it is, or the text cannot be parsed.
///
/// # Errors
/// It takes more work than the budget allows.
pub(crate) fn resolved(text: &str, budget: &Budget) -> Result<Option<Resolved>, Exceeded> {
    if !is_needed(text) || text.contains("<!ENTITY") {
        return Ok(None);
    }
    let Ok(doc) = xml::document(text) else { return Ok(None) };
    let nodes: Vec<Node<'_, '_>> = doc.descendants().filter(Node::is_element).collect();
    let Tree { styles, sheets, unsupported } = styled(&doc, &nodes, budget)?;
    let mut out = Resolved {
        text: String::with_capacity(text.len() * 2),
        originals: Vec::new(),
        unsupported: unsupported.into_iter().map(|why| (None, why)).collect(),
    };
    let mut all: Vec<(Original, String)> = Vec::new();
    for (e, (node, style)) in nodes.iter().zip(&styles).enumerate() {
        all.extend(edits(*node, style).into_iter().map(|edit| edit.of(text, e, *node)));
        if sheets.contains(&e) {
            // usvg passes over sheets of other types.
            all.push(Edit { name: "type", value: "text/plain".to_owned(), kept: None }.of(text, e, *node));
        }
        if node.tag_name().name() == "text" {
            match words(text, e, *node, &styles[e..]) {
                Some(new) => all.extend(new),
                None => out.unsupported.push((Some(e), SINGLE_LETTERS.to_owned())),
            }
        }
        out.unsupported.extend(style.computed.unsupported.iter().map(|why| (Some(e), why.clone())));
        if style.matrix.is_none() {
            out.unsupported.push((Some(e), "its transform is not supported".to_owned()));
        }
    }
    all.sort_by_key(|(o, _)| (o.range.start, o.range.end));
    let mut done = 0;
    for (original, new) in all {
        let Some(before) = text.get(done..original.range.start) else { continue };
        budget.spend(Limit::Comparisons, (new.len() / WRITTEN) as u64)?;
        done = original.range.end;
        out.text.push_str(before);
        let start = out.text.len();
        out.text.push_str(&new);
        out.originals.push(Original { range: start..out.text.len(), ..original });
    }
    out.text.push_str(&text[done..]);
    Ok(Some(out).filter(|o| !o.originals.is_empty() || !o.unsupported.is_empty()))
}

impl Edit {
    /// The edit of an element in the text, and the attribute that it writes.
    fn of(self, text: &str, element: ElementId, node: Node<'_, '_>) -> (Original, String) {
        let Self { name, value, kept } = self;
        let range = place(text, node, name);
        let old = text[range.clone()].to_owned();
        // Lines keep their numbers.
        let lines = "\n".repeat(old.matches('\n').count());
        let written = |value: &str| format!(" {lines}{name}=\"{}\"", escape(value));
        let new = written(&value);
        let (value, kept) = match kept {
            Some(v) => (Some(v.clone()), written(&v)),
            None => (attribute(node, name).map(ToOwned::to_owned), old.clone()),
        };
        (Original { element, name, range, text: old, value, kept }, new)
    }
}

/// The edits of a text's words. `None` if they cannot be made.
fn words(
    text: &str,
    e: ElementId,
    node: Node<'_, '_>,
    styles: &[Styled],
) -> Option<impl Iterator<Item = (Original, String)>> {
    let letters = styles.iter().map(|s| s.computed.letters).take(node.descendants().filter(Node::is_element).count());
    let letters: Vec<Letters> = letters.collect();
    let new = if letters.iter().all(|l| *l == Letters::default()) { Vec::new() } else { rewritten(node, &letters)? };
    Some(new.into_iter().map(move |Rewritten { elements, range, text: new }| {
        let old = text[range.clone()].to_owned();
        let original = Original { element: e + elements, name: "", range, text: old.clone(), value: None, kept: old };
        (original, escape(&new))
    }))
}

/// The attributes to change in an element.
fn edits(node: Node<'_, '_>, style: &Styled) -> Vec<Edit> {
    let computed = &style.computed;
    let mut out: Vec<Edit> =
        computed.attributes.iter().map(|(name, v)| Edit { name, value: v.clone(), kept: None }).collect();
    let mut declarations = computed.style.clone();
    // The origin of what only an animation turns stays.
    let is_still = |m: &Affine| *m == Affine::IDENTITY && node.attribute("transform").is_none();
    let frozen = style.matrix.filter(|m| !computed.transform.is_empty() && !is_still(m)).map(frozen);
    if let Some([transform, origin, ..]) = &frozen {
        declarations.extend([transform, origin].map(|(n, v)| ((*n).to_owned(), v.clone())));
    }
    let before: Vec<(String, String)> = own(node).into_iter().map(|d| (d.name, d.value)).collect();
    if declarations != before {
        let value = declarations.iter().map(|(n, v)| format!("{n}:{v}")).collect::<Vec<_>>().join(";");
        let kept = frozen.map(|all| {
            let was = node.attribute("style").unwrap_or_default().to_owned();
            let important = if computed.transform.iter().any(|d| d.important) { " !important" } else { "" };
            all.iter().fold(was, |s, (name, value)| with_declaration(&s, name, &format!("{value}{important}")))
        });
        out.push(Edit { name: "style", value, kept });
    }
    out
}

/// Declarations of a transform that refers to nothing. The first two are for usvg.
fn frozen(m: Affine) -> [(&'static str, String); 6] {
    let list = m.as_coeffs().map(|c| c.to_string()).join(",");
    let none = || "none".to_owned();
    [
        ("transform", format!("matrix({list})")),
        ("transform-origin", "0 0".to_owned()),
        ("transform-box", "view-box".to_owned()),
        ("rotate", none()),
        ("scale", none()),
        ("translate", none()),
    ]
}

/// The range of an attribute with the space before it, or the place after the element's name.
fn place(text: &str, node: Node<'_, '_>, name: &str) -> Range<usize> {
    let (namespace, local) = name.strip_prefix("xml:").map_or((None, name), |local| (Some(NS_XML_URI), local));
    if let Some(a) = node.attributes().find(|a| a.namespace() == namespace && a.name() == local) {
        let range = a.range();
        return text[..range.start].trim_end().len()..range.end;
    }
    let start = node.range().start + 1;
    let end =
        text[start..].find(|c: char| c.is_ascii_whitespace() || matches!(c, '/' | '>')).map_or(start, |i| start + i);
    end..end
}
