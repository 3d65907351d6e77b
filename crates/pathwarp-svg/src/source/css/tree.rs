//! The style of every element, from the root down, and the transforms, from the leaves up: the box of a group depends on those
//! of its children.

use super::cascade::{applying, own, work};
use super::computed::{Computed, Inherited, computed};
use super::element::Looks;
use super::shapes::shape_box;
use super::sheet::Rules;
use super::text::TextStyle;
use super::value::{Custom, Units, length};
use super::{media, transform};
use crate::source::tags::ElementId;
use pathwarp::budget::{Budget, Exceeded, Limit};
use pathwarp::kurbo::{Affine, Rect};
use selectors::context::SelectorCaches;
use std::cell::Cell;
use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;
use usvg::roxmltree::{Document, NS_XML_URI, Node, NodeId};

/// Font size where nothing sets one, in px.
const MEDIUM: f64 = 16.0;

/// Size of a drawing that does not tell (CSS 2.1, section 10.3.2).
const REPLACED: (f64, f64) = (300.0, 150.0);

/// Bytes of a style sheet that are parsed in the time of a comparison.
const PARSED: usize = 16;

/// Bytes that a variable takes besides its value.
const VARIABLE: usize = 64;

/// The style of an element.
#[derive(Debug)]
pub(super) struct Styled {
    pub(super) computed: Computed,
    /// Its transform. `None` if it cannot be computed.
    pub(super) matrix: Option<Affine>,
}

/// The style of a drawing.
pub(super) struct Tree {
    /// Element by element.
    pub(super) styles: Vec<Styled>,
    /// The elements that are style sheets.
    pub(super) sheets: BTreeSet<ElementId>,
    /// What is not supported of them, in words.
    pub(super) unsupported: BTreeSet<String>,
}

/// Computes the style of all elements.
///
/// # Errors
/// It takes more work than the budget allows.
pub(super) fn styled(doc: &Document<'_>, nodes: &[Node<'_, '_>], budget: &Budget) -> Result<Tree, Exceeded> {
    let mut rules = Rules::default();
    let mut sheets = BTreeSet::new();
    for (e, node) in nodes.iter().enumerate().filter(|(_, n)| is_sheet(n)) {
        sheets.insert(e);
        let queries = node.attribute("media").unwrap_or_default();
        match media::applies(queries) {
            Some(true) => {}
            Some(false) => continue,
            None => {
                rules.unsupported.insert(format!("the style sheet for “{queries}” is ignored"));
                continue;
            }
        }
        for text in node.children().filter_map(|c| c.text()) {
            budget.spend(Limit::Comparisons, (text.len() / PARSED) as u64)?;
            rules.add(text);
        }
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "casts saturate")]
    let looks = Looks { done: Cell::new(0), most: budget.left(Limit::Comparisons) as u64 };
    let mut caches = SelectorCaches::default();
    let mut inherited: HashMap<NodeId, Inherited> = HashMap::new();
    let mut out: Vec<(Computed, Units)> = Vec::with_capacity(nodes.len());
    for node in nodes {
        let own = own(*node);
        let declarations = applying(&rules, &own, *node, &looks, &mut caches);
        if looks.exceeded() {
            break;
        }
        let parent = node.parent_element().and_then(|p| inherited.get(&p.id()));
        let mut here = parent.cloned().unwrap_or_else(|| Inherited {
            custom: Rc::new(Custom::new()),
            units: root_units(doc),
            dashes: [None, None],
            text: TextStyle::default(),
        });
        let tag = node.tag_name().name();
        let style = computed(tag, parent.is_none(), &declarations, |name| attribute(*node, name), &mut here);
        // Variables can make any value of a short one.
        budget.spend(Limit::Comparisons, style.values().map(work).sum::<usize>() as u64)?;
        if parent.is_none_or(|p| !Rc::ptr_eq(&p.custom, &here.custom)) {
            let bytes: usize = here.custom.values().map(|v| VARIABLE + v.len()).sum();
            budget.spend(Limit::Comparisons, (bytes / PARSED) as u64)?;
        }
        let units = here.units;
        if tag == "svg" {
            here.units.viewport = viewport(*node, &style, &units);
        }
        if node.has_children() {
            inherited.insert(node.id(), here);
        }
        out.push((style, units));
    }
    budget.spend_cut(Limit::Comparisons, looks.done.get())?;
    let matrices = matrices(nodes, &out);
    let all = out.into_iter().zip(matrices).map(|((computed, _), matrix)| Styled { computed, matrix });
    Ok(Tree { styles: all.collect(), sheets, unsupported: rules.unsupported })
}

/// An attribute by its name with the prefix `xml`, or without a prefix.
pub(super) fn attribute<'a>(node: Node<'a, '_>, name: &str) -> Option<&'a str> {
    match name.strip_prefix("xml:") {
        Some(name) => node.attribute((NS_XML_URI, name)),
        None => node.attribute(name),
    }
}

fn is_sheet(node: &Node<'_, '_>) -> bool {
    node.tag_name().name() == "style" && matches!(node.attribute("type"), None | Some("" | "text/css"))
}

/// Units of the root element: the window is the drawing's size.
fn root_units(doc: &Document<'_>) -> Units {
    let root = doc.root_element();
    let units = Units { font: MEDIUM, root_font: MEDIUM, window: REPLACED, viewport: REPLACED };
    let inner = view_box(root).unwrap_or(REPLACED);
    let absolute = |name: &str| root.attribute(name).filter(|v| !v.contains('%')).and_then(|v| length(v, &units, 0.0));
    let window = match (absolute("width"), absolute("height")) {
        (Some(w), Some(h)) => (w, h),
        (Some(w), None) => (w, w * inner.1 / inner.0),
        (None, Some(h)) => (h * inner.0 / inner.1, h),
        (None, None) => inner,
    };
    Units { window, viewport: window, ..units }
}

/// Size of the viewport that an `<svg>` makes, in its own coordinates.
fn viewport(node: Node<'_, '_>, style: &Computed, units: &Units) -> (f64, f64) {
    let size = |name: &str, full: f64| {
        style.new_value(name).or_else(|| node.attribute(name)).and_then(|v| length(v, units, full)).unwrap_or(full)
    };
    view_box(node).unwrap_or_else(|| (size("width", units.viewport.0), size("height", units.viewport.1)))
}

fn view_box(node: Node<'_, '_>) -> Option<(f64, f64)> {
    let b: svgtypes::ViewBox = node.attribute("viewBox")?.parse().ok()?;
    Some((b.w, b.h))
}

/// The transforms of all elements. Where a style sheet has a part in one, it is computed; `None` if it cannot be.
fn matrices(nodes: &[Node<'_, '_>], styles: &[(Computed, Units)]) -> Vec<Option<Affine>> {
    if styles.iter().all(|(s, _)| s.transform.is_empty()) {
        return vec![Some(Affine::IDENTITY); nodes.len()];
    }
    let numbers: HashMap<NodeId, ElementId> = nodes.iter().enumerate().map(|(e, n)| (n.id(), e)).collect();
    // Of what is inside, in the element's own coordinates.
    let mut boxes: Vec<Option<Rect>> = vec![None; nodes.len()];
    let mut out = vec![Some(Affine::IDENTITY); nodes.len()];
    for (e, (node, (style, units))) in nodes.iter().zip(styles).enumerate().rev() {
        let tag = node.tag_name().name();
        let attr = |name: &str| style.new_value(name).or_else(|| node.attribute(name));
        let own = if matches!(tag, "g" | "a" | "switch") { boxes[e] } else { shape_box(tag, attr, units) };
        let declared = |name: &str| {
            let last = style.transform.iter().find(|d| d.name == name).map(|d| d.value.as_str());
            last.or_else(|| node.attribute(name).filter(|_| matches!(name, "transform" | "transform-origin")))
        };
        let reference = match declared("transform-box").unwrap_or("view-box") {
            "view-box" => Some(Rect::from_origin_size((0.0, 0.0), units.viewport)),
            // Strokes are left out of account.
            _ => own,
        };
        let matrix = reference.and_then(|r| transform::matrix(declared, units, r));
        out[e] = if style.transform.is_empty() { Some(Affine::IDENTITY) } else { matrix };
        if let (Some(own), Some(m), Some(&parent)) =
            (own, matrix, node.parent_element().and_then(|p| numbers.get(&p.id())))
        {
            let seen = m.transform_rect_bbox(own);
            boxes[parent] = Some(boxes[parent].map_or(seen, |b| b.union(seen)));
        }
    }
    out
}
