//! How much a drawing unfolds to. `use`, patterns, markers, clip paths, masks and filters show other elements, which may show
//! others in turn: a few lines can stand for more than any program draws. usvg walks all of it, so it is counted before.

use pathwarp::Error;
use simplecss::{AttributeOperator, Declaration, DeclarationTokenizer, PseudoClass, StyleSheet};
use std::collections::HashMap;
use usvg::roxmltree::{self, Node, NodeId};

/// As many elements as a drawing may unfold to: as many as usvg takes in a file. Of two thousand drawings of all sorts none comes
/// to two thousand.
const MOST: u64 = 1_000_000;
/// As deep as what is shown may nest, references and elements. The stack of 256 MiB holds several times as much, but markers
/// on markers take usvg the square of their number.
const DEEPEST: usize = 4_000;
/// Drawings with so few references unfold to little, whatever they are.
const FEW: usize = 16;
/// In so many bytes there is no room for vertices and a marker whose product were large.
const SMALL: usize = 4096;

/// Whether a drawing may unfold to much: it has markers, which stand on every vertex, or other elements that show what is
/// referred to (`referring`), and more than a few references.
pub(crate) fn may_be_large(doc: &roxmltree::Document<'_>, markers: usize, referring: bool) -> bool {
    let text = doc.input_text();
    // Entities may hold references.
    let references = || text.bytes().filter(|b| matches!(b, b'#' | b'&')).count();
    markers > 1 || markers == 1 && text.len() > SMALL || (referring || markers > 0) && references() > FEW
}

/// Refuses a drawing that unfolds to too much; `name` is what it is called in messages.
///
/// # Errors
/// [`Error::Input`] naming the element.
pub(crate) fn check(doc: &roxmltree::Document<'_>, name: &str) -> Result<(), Error> {
    Unfolding::of(doc).count().map(|_| ()).map_err(|(node, why)| {
        let line = doc.text_pos_at(node.range().start).row;
        let tag = node.tag_name().name();
        let which = node.attribute("id").map_or(format!("<{tag}>"), |id| format!("<{tag} id=\"{id}\">"));
        let problem = match why {
            TooMuch::Elements => format!("{which} unfolds to more than {MOST} elements"),
            TooMuch::Depth => format!("what {which} shows nests deeper than {DEEPEST} levels"),
        };
        let advice = "by references that lead to references; replace some of them by plain shapes";
        Error::input(format!("{name}:{line}"), format!("{problem}, {advice}"))
    })
}

enum TooMuch {
    Elements,
    Depth,
}

/// The properties that may refer to something shown.
const PROPERTIES: [&str; 7] = ["fill", "stroke", "marker-start", "marker-mid", "marker-end", "clip-path", "mask"];
/// The first of these are paints, and paints and markers are inherited.
const PAINTS: usize = 2;
const INHERITED: usize = 5;

/// What a property says of what is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Says {
    /// Nothing, or `inherit`.
    #[default]
    Nothing,
    /// Something that refers to nothing.
    Plain,
    Shows(NodeId),
    /// The fill (0) or stroke (1) of the element around: of a `use`, or of what a marker is on.
    Context(usize),
}

/// What the inherited properties show.
type Inherited = [Option<NodeId>; INHERITED];

/// Something that is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct Body {
    node: NodeId,
    /// What it inherits; `None`: what its own place in the file says.
    inherited: Option<Inherited>,
    /// The paints of the element around.
    context: [Option<NodeId>; PAINTS],
}

/// What is inside a body.
struct Inside {
    elements: u64,
    depth: usize,
    /// What is shown there: how often, how deep.
    shown: Vec<(Body, u64, usize)>,
}

struct Unfolding<'a, 'i> {
    doc: &'a roxmltree::Document<'i>,
    by_id: HashMap<&'a str, Node<'a, 'i>>,
    sheet: StyleSheet<'a>,
    /// Elements and depth, by body; `None` while it is being counted.
    known: HashMap<Body, Option<(u64, usize)>>,
}

impl<'a, 'i> Unfolding<'a, 'i> {
    fn of(doc: &'a roxmltree::Document<'i>) -> Self {
        let mut by_id = HashMap::new();
        let mut sheet = StyleSheet::new();
        for node in doc.descendants().filter(Node::is_element) {
            if let Some(id) = node.attribute("id") {
                by_id.entry(id).or_insert(node);
            }
            if node.tag_name().name() == "style"
                && let Some(text) = node.text()
            {
                sheet.parse_more(text);
            }
        }
        // Of the rules only those can matter that speak of what is shown.
        let speaks = |d: &Declaration<'_>| matches!(d.name, "marker" | "filter") || PROPERTIES.contains(&d.name);
        sheet.rules.retain(|r| r.declarations.iter().any(speaks));
        Self { doc, by_id, sheet, known: HashMap::new() }
    }

    /// All elements, however often they show, and the deepest nesting.
    fn count(&mut self) -> Result<(u64, usize), (Node<'a, 'i>, TooMuch)> {
        let root = Body { node: self.doc.root_element().id(), inherited: None, context: [None; PAINTS] };
        let first = self.inside(root);
        // What is looked into takes time as well.
        let mut looked = first.elements;
        let mut open = vec![(root, first)];
        self.known.insert(root, None);
        let mut last = (0, 0);
        while let Some((body, inside)) = open.last_mut() {
            if let Some(next) = inside.shown.pop() {
                let (other, times, at) = next;
                match self.known.get(&other) {
                    Some(Some((elements, depth))) => {
                        inside.elements = inside.elements.saturating_add(elements.saturating_mul(times));
                        inside.depth = inside.depth.max(at + depth);
                    }
                    // usvg cuts circles.
                    Some(None) => {}
                    None => {
                        inside.shown.push(next);
                        let new = self.inside(other);
                        looked += new.elements + new.shown.len() as u64;
                        self.known.insert(other, None);
                        open.push((other, new));
                    }
                }
                continue;
            }
            let node = self.doc.get_node(body.node).unwrap_or(self.doc.root_element());
            last = (inside.elements, inside.depth);
            self.known.insert(*body, Some(last));
            open.pop();
            if last.0.max(looked) > MOST {
                return Err((node, TooMuch::Elements));
            }
            if last.1.max(open.len()) > DEEPEST {
                return Err((node, TooMuch::Depth));
            }
        }
        Ok(last)
    }

    /// One body without what it shows.
    fn inside(&self, body: Body) -> Inside {
        let mut out = Inside { elements: 0, depth: 0, shown: Vec::new() };
        let Some(top) = self.doc.get_node(body.node) else { return out };
        let placed = |node: NodeId| Body { node, inherited: None, context: [None; PAINTS] };
        let mut todo = vec![(top, body.inherited.unwrap_or_else(|| self.place(top)), 1)];
        while let Some((node, mut inherited, depth)) = todo.pop() {
            out.elements += 1;
            out.depth = out.depth.max(depth);
            let tag = node.tag_name().name();
            if node != top && is_defined(tag) {
                continue;
            }
            let (says, filters) = self.says(node);
            for (slot, say) in inherited.iter_mut().zip(says) {
                match say {
                    Says::Shows(id) => *slot = Some(id),
                    Says::Plain => *slot = None,
                    Says::Context(paint) => *slot = body.context[paint],
                    Says::Nothing => {}
                }
            }
            let [fill, stroke, start, middle, end] = inherited;
            let mut show = |target: Option<Body>, times| out.shown.extend(target.map(|t| (t, times, depth)));
            if is_painted(tag) {
                show(fill.map(placed), 1);
                show(stroke.map(placed), 1);
            }
            if start.or(middle).or(end).is_some() && matches!(tag, "path" | "line" | "polyline" | "polygon") {
                let on = |marker: NodeId| Body { context: [fill, stroke], ..placed(marker) };
                show(start.map(on), 1);
                show(middle.map(on), vertices(node));
                show(end.map(on), 1);
            }
            for say in &says[INHERITED..] {
                if let Says::Shows(target) = say {
                    show(Some(placed(*target)), 1);
                }
            }
            for filter in filters {
                show(Some(placed(filter)), 1);
            }
            let linked = || self.linked(node).map(|n| n.id());
            match tag {
                "use" => {
                    let copy = |node| Body { node, inherited: Some(inherited), context: [fill, stroke] };
                    show(linked().map(copy), 1);
                }
                "feImage" => show(linked().map(placed), 1),
                "pattern" if node.first_element_child().is_none() => show(linked().map(placed), 1),
                _ => {}
            }
            let children = node.children().filter(Node::is_element);
            todo.extend(children.map(|child| (child, inherited, depth + 1)));
        }
        out
    }

    /// What an element inherits in the place where it stands.
    fn place(&self, node: Node<'a, 'i>) -> Inherited {
        let mut out = Inherited::default();
        let mut open: Vec<usize> = (0..INHERITED).collect();
        for around in node.ancestors().skip(1).filter(Node::is_element) {
            let (says, _) = self.says(around);
            open.retain(|&i| match says[i] {
                Says::Nothing | Says::Context(_) => true,
                Says::Plain => false,
                Says::Shows(target) => {
                    out[i] = Some(target);
                    false
                }
            });
        }
        out
    }

    /// What the properties of an element say, by attribute, style sheet and style attribute; and the filters named anywhere,
    /// of which there may be a list.
    fn says(&self, node: Node<'a, 'i>) -> ([Says; PROPERTIES.len()], Vec<NodeId>) {
        let mut out = [(Says::Nothing, false); PROPERTIES.len()];
        let mut filters = Vec::new();
        let mut set = |name: &str, value: &str, important: bool| match name {
            "filter" => filters.extend(urls(value).filter_map(|id| self.by_id.get(id)).map(Node::id)),
            "fill" | "stroke" | "mask" | "clip-path" | "marker" | "marker-start" | "marker-mid" | "marker-end" => {
                for (i, p) in PROPERTIES.iter().enumerate() {
                    if (*p == name || name == "marker" && p.starts_with("marker-")) && !out[i].1 {
                        out[i] = (self.value(value), important);
                    }
                }
            }
            _ => {}
        };
        for a in node.attributes() {
            set(a.name(), a.value(), false);
        }
        let rules = self.sheet.rules.iter().filter(|r| r.selector.matches(&Element(node)));
        for d in rules.flat_map(|r| &r.declarations) {
            set(d.name, d.value, d.important);
        }
        for d in node.attribute("style").into_iter().flat_map(DeclarationTokenizer::from) {
            set(d.name, d.value, d.important);
        }
        (out.map(|o| o.0), filters)
    }

    fn value(&self, value: &str) -> Says {
        match value.trim() {
            "inherit" => Says::Nothing,
            "context-fill" => Says::Context(0),
            "context-stroke" => Says::Context(1),
            v => urls(v).find_map(|id| self.by_id.get(id)).map_or(Says::Plain, |n| Says::Shows(n.id())),
        }
    }

    fn linked(&self, node: Node<'a, 'i>) -> Option<Node<'a, 'i>> {
        let links = || node.attributes().filter(|a| a.name() == "href");
        let link = links().find(|a| a.namespace().is_none()).or_else(|| links().next())?;
        self.by_id.get(link.value().trim().strip_prefix('#')?).copied()
    }
}

/// What shows only where something refers to it.
fn is_defined(tag: &str) -> bool {
    matches!(tag, "pattern" | "marker" | "clipPath" | "mask" | "filter" | "symbol" | "defs" | "style" | "metadata")
}

/// What has a fill and a stroke.
fn is_painted(tag: &str) -> bool {
    crate::source::text::is_shape(tag) || matches!(tag, "text" | "tspan" | "textPath" | "tref")
}

/// The ids that `url(#…)`s name.
fn urls(value: &str) -> impl Iterator<Item = &str> {
    value.split("url(").skip(1).filter_map(|rest| {
        let inside = rest.split(')').next()?;
        inside.trim().trim_matches(['"', '\'']).trim().strip_prefix('#')
    })
}

/// No fewer than the vertices of a path, polyline or polygon: as many as there are numbers and commands.
fn vertices(node: Node<'_, '_>) -> u64 {
    let text = node.attribute("d").or_else(|| node.attribute("points")).unwrap_or("");
    let mut inside = false;
    let starts = text.bytes().filter(|b| {
        let number = b.is_ascii_digit();
        let starts = number && !inside || matches!(b, b'z' | b'Z');
        inside = number;
        starts
    });
    starts.count() as u64 + 2
}

/// An element as selectors see it.
struct Element<'a, 'i>(Node<'a, 'i>);

impl simplecss::Element for Element<'_, '_> {
    fn parent_element(&self) -> Option<Self> {
        self.0.parent_element().map(Element)
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        self.0.prev_sibling_element().map(Element)
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.0.tag_name().name() == name
    }

    fn attribute_matches(&self, name: &str, operator: AttributeOperator<'_>) -> bool {
        self.0.attribute(name).is_some_and(|v| operator.matches(v))
    }

    fn pseudo_class_matches(&self, class: PseudoClass<'_>) -> bool {
        matches!(class, PseudoClass::FirstChild) && self.0.prev_sibling_element().is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(body: &str) -> Result<(u64, usize), String> {
        let svg =
            format!("<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink'>{body}</svg>");
        let doc = roxmltree::Document::parse(&svg).unwrap();
        let counted = Unfolding::of(&doc).count();
        counted.map_err(|(node, _)| node.attribute("id").unwrap_or("").to_owned())
    }

    /// Counted by hand: every element where it stands and wherever it shows again.
    #[test]
    fn what_shows_again_counts_again() {
        let elements = |body: &str| count(body).unwrap().0;
        assert_eq!(elements("<g><rect/><x/></g><defs><rect/></defs>"), 5);
        // svg, defs, two copies of the group of two, each with its use.
        let group = "<defs><g id='g'><rect/></g></defs>";
        assert_eq!(elements(&format!("{group}<use xlink:href='#g'/><use href='#g'/>")), 2 + 2 * 3);
        // A pattern of two elements, by attribute, style, style sheet, from the group around and through a use.
        let pattern = "<pattern id='p'><rect/></pattern>";
        assert_eq!(elements(&format!("{pattern}<rect fill='url(#p) red'/>")), 3 + 2);
        assert_eq!(elements(&format!("{pattern}<rect style='fill:url( \"#p\" )' stroke='url(#p)'/>")), 3 + 4);
        assert_eq!(elements(&format!("{pattern}<style>.k{{fill:url(#p)}}</style><rect class='k'/><rect/>")), 5 + 2);
        assert_eq!(elements(&format!("{pattern}<g fill='url(#p)'><rect/><rect fill='red'/><rect/></g>")), 6 + 4);
        assert_eq!(elements(&format!("{pattern}{group}<use href='#g' fill='url(#p)'/>")), 4 + 2 + 2);
        let context = "<defs><g id='c' fill='context-fill'><rect/><rect/></g></defs>";
        assert_eq!(elements(&format!("{pattern}{context}<use href='#c' fill='url(#p)'/>")), 4 + 3 + 4);
        // What a pattern holds looks as its own place says, not as where it shows.
        assert_eq!(
            elements(&format!("<g stroke='url(#q)'>{pattern}</g><pattern id='q'/><rect fill='url(#p)'/>")),
            5 + 2 + 1
        );
        // A pattern without content shows another's; filters, masks and clip paths.
        assert_eq!(elements(&format!("{pattern}<pattern id='q' href='#p'/><rect fill='url(#q)'/>")), 4 + 1 + 2);
        let rest = "<clipPath id='c'><rect/></clipPath><mask id='m'><rect/><rect/></mask>\
                    <filter id='f'><feImage href='#m'/></filter>";
        assert_eq!(
            elements(&format!("{rest}<g clip-path='url(#c)' mask='url(#m)' filter='url(#f) url(#f)'/>")),
            5 + 2 + 3 + 2 * 5
        );
        // A marker of two elements on at most nine vertices.
        let marker = "<marker id='m'><rect/></marker>";
        assert_eq!(elements(&format!("{marker}<path marker-mid='url(#m)' d='M1,2L3 4zl-5-6'/>")), 3 + 9 * 2);
        // Circles end.
        assert_eq!(elements("<g id='g'><use href='#g'/></g>"), 3 + 3 - 1);
    }

    #[test]
    fn nests_of_references_are_bounded() {
        let nest = |levels: usize, tag: &str, show: &dyn Fn(usize) -> String| -> String {
            let level = |i| format!("<{tag} id='n{i}'>{}</{tag}>", (0..10).map(|_| show(i + 1)).collect::<String>());
            (0..levels).map(level).chain([format!("<{tag} id='n{levels}'><rect/></{tag}>"), show(0)]).collect()
        };
        let fill = |i: usize| format!("<rect fill='url(#n{i})'/>");
        assert!(count(&nest(4, "pattern", &fill)).is_ok());
        assert_eq!(count(&nest(9, "pattern", &fill)), Err("n3".into()));
        assert_eq!(count(&nest(50, "mask", &|i| format!("<g style='mask:url(#n{i})'/>"))).map_err(|e| e.len()), Err(3));
        assert_eq!(count(&nest(50, "symbol", &|i| format!("<use href='#n{i}'/>"))).map_err(|e| e.len()), Err(3));
        // A long chain of single references.
        let chain: String =
            (0..9000).map(|i| format!("<pattern id='n{i}'><rect fill='url(#n{})'/></pattern>", i + 1)).collect();
        assert!(count(&format!("{chain}<rect fill='url(#n0)'/>")).is_err());
        assert!(count(&format!("{chain}<rect fill='url(#n8900)'/>")).is_ok());
    }
}
