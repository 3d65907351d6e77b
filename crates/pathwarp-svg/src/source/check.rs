//! Bounds the size of a drawing, whose style sheets are resolved, before usvg expands it by what references and text add to it.

use super::elements::{first_by_id, is_shape};
use memchr::{memchr2, memmem};
use pathwarp::budget::{Budget, Exceeded, Limit, cost};
use pathwarp::{Error, Outline, Seg};
use pathwarp_reader::LARGEST;
use simplecss::DeclarationTokenizer;
use std::collections::HashMap;
use usvg::roxmltree::{self, Node, NodeId};

/// Features of a drawing that determine whether to load fonts and images, and what to count.
#[derive(Default)]
pub(super) struct Features {
    pub(super) text: bool,
    pub(super) images: bool,
    references: bool,
    markers: usize,
}

impl Features {
    fn find(xml: &roxmltree::Document<'_>) -> Self {
        let mut out = Self::default();
        for n in xml.descendants() {
            match n.tag_name().name() {
                "text" => out.text = true,
                "image" => out.images = true,
                "feImage" => (out.images, out.references) = (true, true),
                "marker" => out.markers += 1,
                "use" | "pattern" | "clipPath" | "mask" => out.references = true,
                _ => {}
            }
        }
        // An embedded SVG image may contain text.
        out.text |= out.images && ["image/svg", ".svg"].iter().any(|t| xml.input_text().contains(t));
        out
    }
}

/// Checks a drawing, and returns its features. `name` identifies it in errors.
///
/// # Errors
/// [`Error::Input`] if it exceeds the budget or nests too deeply.
pub(super) fn check_drawing(xml: &roxmltree::Document<'_>, name: &str, budget: &Budget) -> Result<Features, Error> {
    let features = Features::find(xml);
    if features.text {
        let too_much = |e| Error::limit(name, "its texts take", e);
        spend_spans(xml, budget).and_then(|()| spend_text_paths(xml, budget)).map_err(too_much)?;
    }
    spend_wide_strokes(xml, budget).map_err(|e| Error::limit(name, "with such wide strokes, its shapes take", e))?;
    let segments = if may_be_large(xml, features.markers, features.references) {
        count_expanded(xml, name, budget)?
    } else {
        count_plain(xml, name, budget)?
    };
    spend_wide_arcs(xml, segments, budget).map_err(|e| Error::limit(name, "with such wide arcs, its paths take", e))?;
    Ok(features)
}

/// Limit on the nesting of references and elements after expansion. The stack of 128 MiB allows several times as much, but
/// usvg needs quadratic time for markers on markers.
const MAX_DEPTH: usize = 2_000;
/// Number of references up to which a drawing cannot expand to much.
const FEW_REFERENCES: usize = 16;
/// Length of a text in bytes up to which one marker at all vertices stays small.
const SMALL_TEXT: usize = 4096;
/// Product of the bytes and references of a text up to which it cannot expand to much.
const SMALL_PRODUCT: usize = 1 << 22;

/// Returns `true` if a drawing could expand to a large number of elements: it has more than a few references, and either markers, which
/// are drawn at every vertex, or other elements that show others by reference (`referring`).
fn may_be_large(doc: &roxmltree::Document<'_>, markers: usize, referring: bool) -> bool {
    let text = doc.input_text();
    // Entities may contain references.
    let references = || text.bytes().filter(|b| matches!(b, b'#' | b'&')).count();
    let large = |count: usize| count > FEW_REFERENCES || count.saturating_mul(text.len()) > SMALL_PRODUCT;
    markers > 1 || (markers == 1 && text.len() > SMALL_TEXT) || ((referring || markers > 0) && large(references()))
}

/// Counts a drawing that cannot expand to much, and returns the number of its segments.
///
/// # Errors
/// [`Error::Input`] if it exceeds the budget.
fn count_plain(doc: &roxmltree::Document<'_>, name: &str, budget: &Budget) -> Result<u64, Error> {
    let sizes = doc.descendants().filter(Node::is_element).map(Size::of_element);
    let sum = sizes.fold(Size::default(), Size::plus);
    sum.check(budget).map_err(|e| Error::limit(name, "it takes", e))?;
    sum.spend(budget).map_err(|e| Error::limit(name, "with its images, it takes", e))?;
    Ok(sum.segments)
}

/// Counts a drawing after expansion, and returns the number of its segments. `name` identifies the drawing in errors.
///
/// # Errors
/// [`Error::Input`] with the element that expands to too much.
fn count_expanded(doc: &roxmltree::Document<'_>, name: &str, budget: &Budget) -> Result<u64, Error> {
    let (size, _) = Unfolding::new(doc).count(budget).map_err(|(node, why)| {
        let line = doc.text_pos_at(node.range().start).row;
        let tag = node.tag_name().name();
        let which = node.attribute("id").map_or(format!("<{tag}>"), |id| format!("<{tag} id=\"{id}\">"));
        let place = format!("{name}:{line}");
        match why {
            TooMuch::Work(e) => {
                let what =
                    format!("{which} expands to more than is allowed: with all that its references show, it takes");
                Error::limit(place, what, e)
            }
            TooMuch::Depth => {
                let problem =
                    format!("the content of {which} nests deeper than {MAX_DEPTH} levels, through references to");
                Error::input(place, format!("{problem} references; replace some of them by plain shapes"))
            }
        }
    })?;
    size.spend(budget).map_err(|e| Error::limit(name, "with its images, it takes", e))?;
    Ok(size.segments)
}

/// The reason why a drawing expands to too much.
enum TooMuch {
    Work(Exceeded),
    Depth,
}

/// The size of a part of a drawing.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Size {
    elements: u64,
    segments: u64,
    letters: u64,
}

impl Size {
    /// The size of an element without its children.
    fn of_element(node: Node<'_, '_>) -> Self {
        let tag = node.tag_name().name();
        let is_text = is_painted(tag) && !is_shape(tag);
        Self {
            elements: 1,
            segments: if is_shape(tag) { vertices(node) } else { 0 },
            letters: if is_text { node.children().map(letters).sum() } else { 0 },
        }
    }

    fn plus(self, o: Self) -> Self {
        self.plus_times(o, 1)
    }

    fn plus_times(self, o: Self, n: u64) -> Self {
        Self {
            elements: self.elements.saturating_add(o.elements.saturating_mul(n)),
            segments: self.segments.saturating_add(o.segments.saturating_mul(n)),
            letters: self.letters.saturating_add(o.letters.saturating_mul(n)),
        }
    }

    /// The work of resolving it.
    fn work(self) -> f64 {
        let Self { elements, segments, letters } = self;
        cost::ELEMENT * elements as f64 + cost::SEGMENT * segments as f64 + cost::LETTER * letters as f64
    }

    /// Compares with the limits, regardless of the work done so far. As bending takes work, too, an error about work says “at least”.
    fn check(self, budget: &Budget) -> Result<(), Exceeded> {
        budget.check(Limit::Elements, self.elements as f64)?;
        budget.check(Limit::Work, self.work()).map_err(Exceeded::cut_short)
    }

    /// Charges for it. Drawings in images are charged to the same budget.
    fn spend(self, budget: &Budget) -> Result<(), Exceeded> {
        budget.take(Limit::Elements, self.elements as f64)?;
        budget.spend(self.work())
    }
}

/// Properties that may refer to an element to show.
const PROPERTIES: [&str; 7] = ["fill", "stroke", "marker-start", "marker-mid", "marker-end", "clip-path", "mask"];
/// Number of the first [`PROPERTIES`] that are paints.
const PAINTS: usize = 2;
/// Number of the first [`PROPERTIES`] that are inherited: paints and markers.
const INHERITED: usize = 5;

/// The reference in a property's value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Reference {
    /// Not set, or `inherit`.
    #[default]
    Unset,
    /// Set to a value without a reference.
    Plain,
    /// Set to a reference to this element.
    Shows(NodeId),
    /// The fill (0) or stroke (1) of the context element: the `use`, or the shape with the marker.
    Context(usize),
}

/// The elements to which the inherited [`PROPERTIES`] refer.
type Inherited = [Option<NodeId>; INHERITED];

/// A subtree to show, with all that affects its content.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct Body {
    node: NodeId,
    /// Inherited values; `None` for the ones at the element's position in the file.
    inherited: Option<Inherited>,
    /// Paints of the context element.
    context: [Option<NodeId>; PAINTS],
}

/// The content of a body, as far as it has been counted.
struct Content {
    size: Size,
    depth: usize,
    /// Bodies shown inside that are not counted yet, each with the number of times and the depth at which it is shown.
    shown: Vec<(Body, u64, usize)>,
}

/// Counts a drawing with all that its references show.
struct Unfolding<'a, 'i> {
    doc: &'a roxmltree::Document<'i>,
    by_id: HashMap<&'a str, Node<'a, 'i>>,
    /// Size and depth by body; `None` while the body is being counted.
    known: HashMap<Body, Option<(Size, usize)>>,
}

impl<'a, 'i> Unfolding<'a, 'i> {
    fn new(doc: &'a roxmltree::Document<'i>) -> Self {
        Self { doc, by_id: first_by_id(doc), known: HashMap::new() }
    }

    /// The size of the drawing with all repetitions, and the depth of the deepest nesting.
    fn count(&mut self, budget: &Budget) -> Result<(Size, usize), (Node<'a, 'i>, TooMuch)> {
        let root = Body { node: self.doc.root_element().id(), inherited: None, context: [None; PAINTS] };
        let first = self.content(root);
        // Visiting elements takes time, too, so bound it as well.
        let mut visited = first.size;
        // The body being counted, after the ones that show it.
        let mut open = vec![(root, first)];
        self.known.insert(root, None);
        let (mut finished, mut first_over) = ((Size::default(), 0), None);
        while let Some((body, content)) = open.last_mut() {
            if let Some(next) = content.shown.pop() {
                let (other, times, outer_depth) = next;
                match self.known.get(&other) {
                    Some(Some((size, depth))) => {
                        content.size = content.size.plus_times(*size, times);
                        content.depth = content.depth.max(outer_depth + depth);
                    }
                    // usvg breaks the cycle here.
                    Some(None) => {}
                    None => {
                        content.shown.push(next);
                        let new = self.content(other);
                        visited.elements += new.size.elements + new.shown.len() as u64;
                        self.known.insert(other, None);
                        open.push((other, new));
                    }
                }
                continue;
            }
            let node = self.doc.get_node(body.node).unwrap_or(self.doc.root_element());
            finished = (content.size, content.depth);
            self.known.insert(*body, Some(finished));
            open.pop();
            if finished.0.check(budget).is_err() {
                first_over.get_or_insert(node);
            }
            visited.check(budget).map_err(|e| (node, TooMuch::Work(e.cut_short())))?;
            if finished.1.max(open.len()) > MAX_DEPTH {
                return Err((node, TooMuch::Depth));
            }
        }
        // Report the size of the whole drawing, but name the first element that exceeds the limits.
        let counted = finished.0.check(budget);
        counted.map(|()| finished).map_err(|e| (first_over.unwrap_or(self.doc.root_element()), TooMuch::Work(e)))
    }

    /// The content of a body, with the bodies shown inside still to be counted.
    fn content(&self, body: Body) -> Content {
        let mut out = Content { size: Size::default(), depth: 0, shown: Vec::new() };
        let Some(top) = self.doc.get_node(body.node) else { return out };
        let in_place = |node: NodeId| Body { node, inherited: None, context: [None; PAINTS] };
        let mut todo = vec![(top, body.inherited.unwrap_or_else(|| self.inherited(top)), 1)];
        while let Some((node, mut inherited, depth)) = todo.pop() {
            out.size = out.size.plus(Size::of_element(node));
            out.depth = out.depth.max(depth);
            let tag = node.tag_name().name();
            if node != top && is_hidden(tag) {
                continue;
            }
            let (references, filters) = self.references(node);
            for (value, reference) in inherited.iter_mut().zip(references) {
                match reference {
                    Reference::Shows(id) => *value = Some(id),
                    Reference::Plain => *value = None,
                    Reference::Context(paint) => *value = body.context[paint],
                    Reference::Unset => {}
                }
            }
            let [fill, stroke, start, middle, end] = inherited;
            let mut show = |target: Option<Body>, times| out.shown.extend(target.map(|t| (t, times, depth)));
            if is_painted(tag) {
                show(fill.map(in_place), 1);
                show(stroke.map(in_place), 1);
            }
            if start.or(middle).or(end).is_some() && matches!(tag, "path" | "line" | "polyline" | "polygon") {
                let on = |marker: NodeId| Body { context: [fill, stroke], ..in_place(marker) };
                show(start.map(on), 1);
                show(middle.map(on), vertices(node));
                show(end.map(on), 1);
            }
            for reference in &references[INHERITED..] {
                if let Reference::Shows(target) = reference {
                    show(Some(in_place(*target)), 1);
                }
            }
            for filter in filters {
                show(Some(in_place(filter)), 1);
            }
            let linked = || self.linked(node).map(|n| n.id());
            match tag {
                "use" => {
                    let copy = |node| Body { node, inherited: Some(inherited), context: [fill, stroke] };
                    show(linked().map(copy), 1);
                }
                "feImage" => show(linked().map(in_place), 1),
                "pattern" if node.first_element_child().is_none() => show(linked().map(in_place), 1),
                _ => {}
            }
            let children = node.children().filter(Node::is_element);
            todo.extend(children.map(|child| (child, inherited, depth + 1)));
        }
        out
    }

    /// The values that an element inherits at its position in the file. There it has no context, so context paints count as unset.
    fn inherited(&self, node: Node<'a, 'i>) -> Inherited {
        let mut out = Inherited::default();
        let mut open: Vec<usize> = (0..INHERITED).collect();
        for ancestor in node.ancestors().skip(1).filter(Node::is_element) {
            let (references, _) = self.references(ancestor);
            open.retain(|&i| match references[i] {
                Reference::Unset | Reference::Context(_) => true,
                Reference::Plain => false,
                Reference::Shows(target) => {
                    out[i] = Some(target);
                    false
                }
            });
        }
        out
    }

    /// Resolves the [`PROPERTIES`] of an element from attributes and the style attribute. Filters are listed from all
    /// declarations, as each may hold several.
    fn references(&self, node: Node<'a, 'i>) -> ([Reference; PROPERTIES.len()], Vec<NodeId>) {
        // The second value is `true` for an important declaration, which later ones do not replace.
        let mut out = [(Reference::Unset, false); PROPERTIES.len()];
        let mut filters = Vec::new();
        let mut set = |name: &str, value: &str, important: bool| match name {
            "filter" => filters.extend(urls(value).filter_map(|id| self.by_id.get(id)).map(Node::id)),
            "fill" | "stroke" | "mask" | "clip-path" | "marker" | "marker-start" | "marker-mid" | "marker-end" => {
                for (i, p) in PROPERTIES.iter().enumerate() {
                    if (*p == name || (name == "marker" && p.starts_with("marker-"))) && !out[i].1 {
                        out[i] = (self.reference(value), important);
                    }
                }
            }
            _ => {}
        };
        for a in node.attributes() {
            set(a.name(), a.value(), false);
        }
        for d in node.attribute("style").into_iter().flat_map(DeclarationTokenizer::from) {
            set(d.name, d.value, d.important);
        }
        (out.map(|o| o.0), filters)
    }

    /// The reference in the value of a property.
    fn reference(&self, value: &str) -> Reference {
        match value.trim() {
            "inherit" => Reference::Unset,
            "context-fill" => Reference::Context(0),
            "context-stroke" => Reference::Context(1),
            v => urls(v).find_map(|id| self.by_id.get(id)).map_or(Reference::Plain, |n| Reference::Shows(n.id())),
        }
    }

    /// The element to which `href` refers, or else `xlink:href`.
    fn linked(&self, node: Node<'a, 'i>) -> Option<Node<'a, 'i>> {
        let links = || node.attributes().filter(|a| a.name() == "href");
        let link = links().find(|a| a.namespace().is_none()).or_else(|| links().next())?;
        self.by_id.get(link.value().trim().strip_prefix('#')?).copied()
    }
}

/// The number of letters of a text node; 0 for other nodes.
fn letters(n: Node<'_, '_>) -> u64 {
    n.text().filter(|_| n.is_text()).map_or(0, |t| t.chars().count()) as u64
}

/// Returns `true` if elements with this tag are drawn only by reference, or never.
fn is_hidden(tag: &str) -> bool {
    matches!(tag, "pattern" | "marker" | "clipPath" | "mask" | "filter" | "symbol" | "defs" | "style" | "metadata")
}

/// Returns `true` if elements with this tag have a fill and a stroke.
fn is_painted(tag: &str) -> bool {
    is_shape(tag) || matches!(tag, "text" | "tspan" | "textPath")
}

/// The ids in the `url(#…)` of a value.
fn urls(value: &str) -> impl Iterator<Item = &str> {
    value.split("url(").skip(1).filter_map(|rest| {
        let inside = rest.split(')').next()?;
        inside.trim().trim_matches(['"', '\'']).trim().strip_prefix('#')
    })
}

/// An upper bound on the number of vertices of a path, polyline or polygon, from its numbers and commands; 2 for a line, and for other
/// shapes, which have few.
fn vertices(node: Node<'_, '_>) -> u64 {
    /// Bytes whose count fits a byte, so that the compiler adds many at once.
    const BLOCK: usize = u8::MAX as usize;
    let text = node.attribute("d").or_else(|| node.attribute("points")).unwrap_or("");
    // Comparing adjacent bytes needs no state, so the compiler vectorizes it.
    let starts =
        |(before, b): (&u8, &u8)| u8::from((b.is_ascii_digit() & !before.is_ascii_digit()) | ((b | 0x20) == b'z'));
    let bytes = text.as_bytes();
    let first = bytes.first().map_or(0, |b| starts((&b' ', b)));
    let pairs = bytes.chunks(BLOCK).zip(bytes.get(1..).unwrap_or_default().chunks(BLOCK));
    let rest = pairs.map(|(before, block)| u64::from(before.iter().zip(block).map(starts).sum::<u8>()));
    u64::from(first) + rest.sum::<u64>() + 2
}

/// Charges for the segments of paths that carry text. Each text measures the whole of its path.
fn spend_text_paths(xml: &roxmltree::Document<'_>, budget: &Budget) -> Result<(), Exceeded> {
    /// Fewest bytes of path data for a curve. Lines can be shorter, but measuring them takes hardly any time.
    const MIN_CURVE: usize = 12;
    let links = || xml.descendants().filter(|n| n.tag_name().name() == "textPath").filter_map(href);
    if links().next().is_none() {
        return Ok(());
    }
    let data = |n: Node<'_, '_>| Some((n.attribute("id")?.to_owned(), n.attribute("d")?.len()));
    let lengths: HashMap<String, usize> = xml.descendants().filter_map(data).collect();
    links().try_for_each(|id| {
        let segments = lengths.get(id).map_or(0, |length| length / MIN_CURVE);
        budget.spend(cost::SEGMENT * segments as f64)
    })
}

/// The id to which an element refers.
fn href<'a>(n: Node<'a, '_>) -> Option<&'a str> {
    let link = n.attributes().find(|a| a.name() == "href")?.value();
    link.trim().strip_prefix('#')
}

/// Charges for arcs whose ellipses are much wider than any page, such as ellipses that are enlarged to reach the arc's ends while their
/// radii keep an extreme ratio. usvg turns an arc into cubics, whose number grows with the radius; the time grows with the square of
/// their number.
fn spend_wide_arcs(xml: &roxmltree::Document<'_>, segments: u64, budget: &Budget) -> Result<(), Exceeded> {
    /// Radius up to which arcs take a negligible time.
    const WIDE: f64 = 1e8;
    /// The error of n cubics that approximate the unit circle, times n⁶.
    const ERROR: f64 = 1.1163;
    /// The error that usvg allows.
    const ALLOWED: f64 = 0.1;
    /// Comparisons for an arc, divided by the square of the number of its cubics; measured.
    const PER_SQUARE: f64 = 0.0125;
    // Path data is parsed again only if its numbers may describe such an arc.
    let arcs = |d: &str| {
        let suspected = memchr2(b'a', b'A', d.as_bytes()).is_some() && has_extreme_numbers(d);
        suspected.then(|| Outline::from_svg_lossy(d))
    };
    let radius = |s: &Seg| if let Seg::Arc(a) = s { a.a.hypot().max(a.b.hypot()) } else { 0.0 };
    let widest = |o: Outline| o.segs().map(radius).fold(0.0, f64::max);
    let paths = xml.descendants().filter_map(|n| n.attribute("d")).filter_map(arcs);
    let radius = paths.map(widest).fold(0.0, f64::max);
    if radius < WIDE {
        return Ok(());
    }
    let cubics = (ERROR * radius / ALLOWED).powf(1.0 / 6.0);
    // Any segment may be such an arc.
    budget.spend(cost::COMPARISON * segments as f64 * PER_SQUARE * cubics * cubics)
}

/// Returns `false` if all numbers of path data are certainly below 10⁴ and either zero or at least 10⁻³: no exponent, no five
/// digits before a point, no three zeros after it.
fn has_extreme_numbers(data: &str) -> bool {
    let (mut digits, mut zeros, mut fraction) = (0, 0, false);
    for byte in data.bytes() {
        match byte {
            b'e' | b'E' => return true,
            b'.' => (zeros, fraction) = (0, true),
            b'0' if fraction => zeros += 1,
            // Zeros after the first other digit don't count.
            b'0'..=b'9' if fraction => zeros = i32::MIN,
            b'0'..=b'9' => digits += 1,
            _ => (digits, fraction) = (0, false),
        }
        if digits > 4 || (fraction && zeros > 2) {
            return true;
        }
    }
    false
}

/// Charges for very wide strokes. For these, single precision is so coarse that usvg outlines them and finds their boxes by many
/// refinements, in a time that grows with the width.
fn spend_wide_strokes(xml: &roxmltree::Document<'_>, budget: &Budget) -> Result<(), Exceeded> {
    /// Width up to which strokes take a negligible time.
    const WIDE: f64 = 2e6;
    /// Comparisons for each shape and unit of width; measured.
    const UNIT: f64 = 350e-6;
    let text = xml.input_text();
    let widths = memmem::find_iter(text.as_bytes(), "stroke-width").filter_map(|at| {
        let value = text.get(at + "stroke-width".len()..)?.trim_start_matches([' ', ':', '=', '"', '\'']);
        let end = value.find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E' | '+' | '-')));
        value[..end.unwrap_or(value.len())].trim_end_matches(['e', 'E']).parse::<f64>().ok()
    });
    let width = widths.fold(0.0, f64::max).min(LARGEST); // Larger numbers are out of range.
    if width < WIDE {
        return Ok(());
    }
    let shapes = xml.descendants().filter(Node::is_element).count();
    budget.spend(cost::COMPARISON * shapes as f64 * width * UNIT)
}

/// Charges for texts: every letter is compared with every span, and with every other letter.
fn spend_spans(xml: &roxmltree::Document<'_>, budget: &Budget) -> Result<(), Exceeded> {
    /// Number of letters that are compared in the time of one comparison.
    const AT_A_TIME: f64 = 64.0;
    let texts = xml.descendants().filter(|n| n.tag_name().name() == "text");
    for text in texts {
        let (mut spans, mut all_letters) = (0.0, 0.0);
        for n in text.descendants() {
            if n.is_element() {
                spans += 1.0;
            }
            all_letters += letters(n) as f64;
        }
        // The text element counts as an element, but is no span.
        budget.spend(cost::COMPARISON * ((spans - 1.0) * all_letters + all_letters * all_letters / AT_A_TIME))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
