//! Texts whose letters have become outlines: the element that each outline comes from.
//!
//! usvg lays a text out as a whole and does not record the `tspan` or `textPath` of a letter. A drawing with names inside its
//! texts is therefore resolved a second time, with each of these elements painted in a unique colour.

use crate::source::element::Attr;
use crate::source::read::ReadOptions;
use crate::source::tags::{ElementId, Namespace};
use crate::source::text::SourceText;
use crate::source::tree;
use pathwarp::Error;
use pathwarp_reader::xml;
use std::collections::HashMap;
use usvg::{Color, Fill, Node, Paint};

/// For each text element, the source elements of its outlines' nodes, in order.
pub(crate) type Owners = HashMap<ElementId, Vec<ElementId>>;

/// Finds the owners of the letters of all texts with names inside.
pub(crate) fn owners(source: &SourceText, name: &str, options: &ReadOptions) -> Result<Owners, Error> {
    let mut out = Owners::new();
    if source.unpatchable.is_some() {
        return Ok(out);
    }
    let texts = (0..source.elements.len()).filter(|&e| source.elements[e].tag == "text");
    let named: Vec<ElementId> = texts.filter(|&t| inside(source, t).any(|e| is_named(source, e))).collect();
    if named.is_empty() {
        return Ok(out);
    }
    let painted: Vec<ElementId> = named.iter().flat_map(|&t| std::iter::once(t).chain(inside(source, t))).collect();
    let styles = painted.iter().filter_map(|&e| Some((e, format!("fill:{};stroke:none", colour(e)?))));
    let painted = source.instrumented_with(styles).0;
    let (tree, _) = tree::resolve_again(&xml::parse_checked(&painted, name)?, name, options)?;
    collect(tree.root(), source, &mut out);
    Ok(out)
}

/// Encodes an element's number as a colour.
fn colour(e: ElementId) -> Option<String> {
    (e < 1 << 24).then(|| format!("#{e:06x}"))
}

/// Decodes a colour.
fn element(c: Color) -> ElementId {
    usize::from(c.red) << 16 | usize::from(c.green) << 8 | usize::from(c.blue)
}

fn collect(g: &usvg::Group, source: &SourceText, out: &mut Owners) {
    for n in g.children() {
        match n {
            Node::Group(g) => collect(g, source, out),
            Node::Text(t) => {
                let Some(&[text]) = source.by_tree_id().get(t.id()).map(Vec::as_slice) else { continue };
                let end = source.elements[text].range.end;
                let mut last = text;
                let owners = t.flattened().children().iter().map(|n| {
                    // Glyphs of a colour font belong to the element of their neighbours.
                    if let Node::Path(p) = n
                        && let Some(Paint::Color(c)) = p.fill().map(Fill::paint)
                        && (text..source.elements.len()).contains(&element(*c))
                        && source.elements[element(*c)].range.start < end
                    {
                        last = element(*c);
                    }
                    last
                });
                out.insert(text, owners.collect());
            }
            Node::Path(_) | Node::Image(_) => {}
        }
    }
}

/// Lists the elements that make up a text.
pub(crate) fn inside(source: &SourceText, text: ElementId) -> impl Iterator<Item = ElementId> + '_ {
    source.descendants(text).filter(|&e| matches!(source.elements[e].tag.as_ref(), "tspan" | "textPath" | "tref" | "a"))
}

/// Returns `true` for attributes that identify an element: id, class, data and ARIA attributes, and Inkscape's.
pub(crate) fn is_naming(a: &Attr, text: &str) -> bool {
    let name = a.name(text);
    let plain = name == "id" || name == "class" || name.starts_with("data-") || name.starts_with("aria-");
    plain && a.namespace == Namespace::None || a.namespace == Namespace::Inkscape
}

/// Returns `true` if an element has a title or an identifying attribute.
pub(crate) fn is_named(source: &SourceText, e: ElementId) -> bool {
    let el = &source.elements[e];
    el.title.is_some() || el.attrs.iter().any(|a| is_naming(a, &source.text))
}
