//! Computes the style of every element from the root down, and transforms from the leaves up, since the box of a group depends on
//! its children.

use crate::computed::{Computed, Inherited, Tracked, computed};
use crate::element::{ComparisonCounter, applying, work};
use crate::geometry::{self, shape_box};
use crate::ids::Ids;
use crate::sheet::{self, Declaration, Rules, declarations};
use crate::text::TextStyle;
use crate::value::{MEDIUM, Units, length};
use pathwarp::budget::{Budget, Exceeded, cost};
use pathwarp::kurbo::{Affine, Rect};
use roxmltree::{Document, Node, NodeId};
use selectors::context::SelectorCaches;
use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;
use std::sync::Arc;

/// Size of a drawing that specifies none (CSS 2.1, section 10.3.2).
const DEFAULT_SIZE: (f64, f64) = (300.0, 150.0);

const KEYFRAMES_NOTE: &str = "animations of style sheets (@keyframes) go the same ways as before";

/// Bytes of style that take as long to parse or to write as one comparison.
pub(super) const BYTES_PER_COMPARISON: usize = 16;

/// Bytes that a variable takes besides its value.
const VARIABLE: usize = 64;

/// Length in bytes from which finding an equal style attribute is faster than parsing it again.
const CACHED_STYLE: usize = 128;

/// The style and transform of an element.
#[derive(Debug)]
pub(super) struct Styled<'a> {
    pub(super) computed: Computed<'a>,
    pub(super) units: Units,
    /// `None` if the transform cannot be computed.
    pub(super) matrix: Option<Affine>,
}

/// The style of a drawing.
pub(super) struct Tree<'a> {
    /// The style of each element, in document order.
    pub(super) styles: Vec<Styled<'a>>,
    /// Indices of the elements that are style sheets.
    pub(super) sheets: BTreeSet<usize>,
    /// Unsupported features of the style sheets, worded for people.
    pub(super) unsupported: BTreeSet<String>,
    /// The properties that the style sheets declare.
    pub(super) declared: BTreeSet<String>,
    /// Small differences from what browsers show: a sentence, and the name or id that it is about.
    pub(super) notes: BTreeSet<(&'static str, String)>,
}

/// Computes the style of all elements.
///
/// # Errors
/// [`Exceeded`] when this takes more work than the budget allows.
pub(super) fn styled<'a>(doc: &'a Document<'_>, nodes: &[Node<'a, '_>], budget: &Budget) -> Result<Tree<'a>, Exceeded> {
    let (rules, sheets) = rules(nodes, budget)?;
    let counter = ComparisonCounter::new(budget);
    let mut caches = SelectorCaches::default();
    let ids = Ids::new(doc);
    // The values that each ancestor passes on to its children, outermost first.
    let mut ancestors: Vec<(NodeId, Inherited)> = Vec::new();
    let mut long_styles: HashMap<&str, Rc<[Declaration<'_>]>> = HashMap::new();
    let mut out: Vec<(Computed<'_>, Units)> = Vec::with_capacity(nodes.len());
    for node in nodes {
        let inline = node.attribute("style").map(|style| {
            // Many elements share the same style, so long ones are kept parsed.
            let parse = || declarations(style).into();
            if style.len() < CACHED_STYLE { parse() } else { Rc::clone(long_styles.entry(style).or_insert_with(parse)) }
        });
        let inline = inline.as_deref().unwrap_or_default();
        let declarations = if inline.is_empty() && rules.is_empty() {
            Vec::new()
        } else {
            applying(&rules, inline, *node, &counter, &mut caches)
        };
        if counter.exceeded() {
            break; // Then `counter.spend` fails below.
        }
        let parent = node.parent_element().map(|p| p.id());
        while ancestors.last().is_some_and(|(id, _)| Some(*id) != parent) {
            ancestors.pop();
        }
        let mut inherited = ancestors.last().map_or_else(|| root_inherited(doc), |(_, inherited)| inherited.clone());
        let custom = Rc::clone(&inherited.custom);
        let style = computed(*node, parent.is_none(), &declarations, &ids, &mut inherited);
        // Variables can expand a short value to a long one, so charge for the result.
        budget.spend(cost::COMPARISON * style.values().map(work).sum::<usize>() as f64)?;
        if !Rc::ptr_eq(&custom, &inherited.custom) {
            let bytes: usize = inherited.custom.values().map(|v| VARIABLE + v.len()).sum();
            budget.spend(cost::COMPARISON * (bytes / BYTES_PER_COMPARISON) as f64)?;
        }
        let units = inherited.units;
        if node.tag_name().name() == "svg" {
            inherited.units.viewport = viewport(*node, &style, &units);
        } else if let Some(size) = view_box(*node).filter(|_| node.tag_name().name() == "symbol") {
            inherited.units.viewport = size;
            inherited.in_symbol = true;
        }
        if node.has_children() {
            ancestors.push((node.id(), inherited));
        }
        out.push((style, units));
    }
    counter.spend(budget)?;
    let matrices = matrices(nodes, &out);
    let all = out.into_iter().zip(matrices).map(|((computed, units), matrix)| Styled { computed, units, matrix });
    let declared = rules.blocks.iter().flat_map(|b| &b.declarations).map(|d| d.name.to_string()).collect();
    let notes = rules.moving.into_iter().map(|name| (KEYFRAMES_NOTE, name)).collect();
    Ok(Tree { styles: all.collect(), sheets, unsupported: rules.unsupported, declared, notes })
}

/// The state that the root element inherits.
fn root_inherited(doc: &Document<'_>) -> Inherited {
    Inherited {
        in_symbol: false,
        has_markers: false,
        custom: Rc::default(),
        units: root_units(doc),
        color: csscolorparser::Color::default(),
        tracked: Tracked::default(),
        text: TextStyle::default(),
        words: Arc::default(),
    }
}

/// Reads the style sheets of a drawing. Returns the rules, and the indices of the elements that are sheets.
pub(super) fn rules<'a>(nodes: &[Node<'a, '_>], budget: &Budget) -> Result<(Rules<'a>, BTreeSet<usize>), Exceeded> {
    let mut rules = Rules::default();
    let mut sheets = BTreeSet::new();
    for (e, node) in nodes.iter().enumerate().filter(|(_, n)| is_sheet(n)) {
        sheets.insert(e);
        let queries = node.attribute("media").unwrap_or_default();
        match sheet::applies(queries) {
            Some(true) => {}
            Some(false) => continue,
            None => {
                rules.unsupported.insert(format!("the style sheet for “{queries}” is ignored"));
                continue;
            }
        }
        for text in node.children().filter_map(|c| c.text()) {
            budget.spend(cost::COMPARISON * (text.len() / BYTES_PER_COMPARISON) as f64)?;
            rules.add(text);
        }
    }
    let instructions = nodes.iter().take(1).flat_map(|root| root.document().root().children()).filter_map(|n| n.pi());
    rules.unsupported.extend(instructions.filter(|pi| pi.target == "xml-stylesheet").map(|pi| {
        let link = pi.value.unwrap_or_default().split("href=").nth(1).unwrap_or_default();
        format!("the style sheet {} is not read", link.split(' ').next().unwrap_or_default())
    }));
    Ok((rules, sheets))
}

fn is_sheet(node: &Node<'_, '_>) -> bool {
    let is_css = |kind: &str| kind.trim().is_empty() || kind.trim().eq_ignore_ascii_case("text/css");
    node.tag_name().name() == "style" && node.attribute("type").is_none_or(is_css)
}

/// The units of the root element. The window has the size of the drawing.
pub(super) fn root_units(doc: &Document<'_>) -> Units {
    let root = doc.root_element();
    let units = Units { font: MEDIUM, root_font: MEDIUM, window: DEFAULT_SIZE, viewport: DEFAULT_SIZE };
    let (box_width, box_height) = view_box(root).unwrap_or(DEFAULT_SIZE);
    let absolute = |name: &str| root.attribute(name).filter(|v| !v.contains('%')).and_then(|v| length(v, &units, 0.0));
    let window = match (absolute("width"), absolute("height")) {
        (Some(w), Some(h)) => (w, h),
        (Some(w), None) => (w, w * box_height / box_width),
        (None, Some(h)) => (h * box_width / box_height, h),
        (None, None) => (box_width, box_height),
    };
    Units { window, viewport: window, ..units }
}

/// The size of the viewport that an `<svg>` establishes, in its inner coordinates.
fn viewport<'a>(node: Node<'a, '_>, style: &Computed<'a>, units: &Units) -> (f64, f64) {
    let side = |name: &str| style.value(node, name).and_then(|v| units.length(name, v));
    let (w, h) = units.viewport;
    view_box(node).unwrap_or_else(|| (side("width").unwrap_or(w), side("height").unwrap_or(h)))
}

/// The width and height that an element's `viewBox` declares.
fn view_box(node: Node<'_, '_>) -> Option<(f64, f64)> {
    let b: svgtypes::ViewBox = node.attribute("viewBox")?.parse().ok()?;
    Some((b.w, b.h))
}

/// Computes the transforms of elements whose style sheets contribute to them, and of the root. All others are the identity: usvg reads
/// their `transform` attribute itself. `None` marks a transform that cannot be computed.
fn matrices<'a>(nodes: &[Node<'a, '_>], styles: &[(Computed<'a>, Units)]) -> Vec<Option<Affine>> {
    let mut out = vec![Some(Affine::IDENTITY); nodes.len()];
    let is_root_transformed = nodes.first().is_some_and(|root| root.has_attribute("transform"));
    if !is_root_transformed && styles.iter().all(|(s, _)| s.transform.is_empty()) {
        return out;
    }
    let indices: HashMap<NodeId, usize> = nodes.iter().enumerate().map(|(i, n)| (n.id(), i)).collect();
    // Union of the children's boxes, in the element's coordinates.
    let mut boxes: Vec<Option<Rect>> = vec![None; nodes.len()];
    for (i, (node, (style, units))) in nodes.iter().zip(styles).enumerate().rev() {
        let tag = node.tag_name().name();
        let attr = |name: &str| style.value(*node, name);
        let bounds = if matches!(tag, "g" | "a" | "switch") { boxes[i] } else { shape_box(tag, attr, units) };
        let declared = |name: &str| {
            let in_style = style.transform.iter().find(|d| d.name == name).map(|d| d.value.as_ref());
            in_style.or_else(|| node.attribute(name).filter(|_| matches!(name, "transform" | "transform-origin")))
        };
        let reference = match declared("transform-box").unwrap_or("view-box") {
            // CSS lays out the root as a box.
            _ if i == 0 => Some(Rect::from_origin_size((0.0, 0.0), units.window)),
            "view-box" => Some(Rect::from_origin_size((0.0, 0.0), units.viewport)),
            // `fill-box`, `stroke-box` and others: strokes are left out.
            _ => bounds,
        };
        let matrix = reference.and_then(|r| geometry::matrix(declared, units, r, i == 0));
        out[i] = if style.transform.is_empty() && i > 0 { Some(Affine::IDENTITY) } else { matrix };
        if let (Some(bounds), Some(m), Some(&parent)) =
            (bounds, matrix, node.parent_element().and_then(|p| indices.get(&p.id())))
        {
            let image = m.transform_rect_bbox(bounds);
            boxes[parent] = Some(boxes[parent].map_or(image, |b| b.union(image)));
        }
    }
    out
}
