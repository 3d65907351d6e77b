//! The elements of a document, with the positions of their tags and attributes in the source text.

use memchr::memrchr;
use pathwarp::kurbo::Affine;
use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;
use std::str::FromStr as _;
use usvg::roxmltree;

pub(crate) const SVG: &str = "http://www.w3.org/2000/svg";
pub(crate) const XLINK: &str = "http://www.w3.org/1999/xlink";
pub(crate) const XML: &str = "http://www.w3.org/XML/1998/namespace";
pub(crate) const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";
/// The namespace of the attributes that pathwarp stores in files.
pub(crate) const PATHWARP: &str = "https://github.com/pathwarp/pathwarp/ns/1";

/// Returns `true` if a URI is Sodipodi's namespace, whose host has changed over the years.
pub(crate) fn is_sodipodi(uri: &str) -> bool {
    uri.ends_with("/DTD/sodipodi-0.dtd")
}

/// An element's number in document order.
pub(crate) type ElementId = usize;

/// Namespace of an attribute, as far as this crate distinguishes them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Namespace {
    None,
    Xlink,
    Xml,
    Inkscape,
    Sodipodi,
    Pathwarp,
    Other,
}

impl Namespace {
    pub(crate) fn from_uri(uri: Option<&str>) -> Self {
        match uri {
            None => Self::None,
            Some(XLINK) => Self::Xlink,
            Some(XML) => Self::Xml,
            Some(INKSCAPE) => Self::Inkscape,
            Some(PATHWARP) => Self::Pathwarp,
            Some(uri) if is_sodipodi(uri) => Self::Sodipodi,
            Some(_) => Self::Other,
        }
    }
}

/// Returns `true` for the tag of a basic shape or a `path`.
pub(crate) fn is_shape(tag: &str) -> bool {
    matches!(tag, "path" | "rect" | "circle" | "ellipse" | "line" | "polyline" | "polygon")
}

/// Returns `true` if usvg keeps the ids of elements with this tag in its tree.
pub(crate) fn is_tracked(tag: &str) -> bool {
    is_shape(tag) || matches!(tag, "g" | "a" | "use" | "text" | "image" | "svg" | "switch")
}

pub(crate) fn is_animation(tag: &str) -> bool {
    matches!(tag, "animate" | "set" | "animateTransform" | "animateMotion" | "animateColor")
}

/// An attribute of an element.
#[derive(Debug)]
pub(crate) struct Attr {
    /// Range of the local name in the text.
    pub(crate) name: Range<usize>,
    pub(crate) namespace: Namespace,
    /// Range of the whole attribute in the text, closing quote included.
    pub(crate) range: Range<usize>,
    /// Range of the value in the text, without the quotes.
    pub(crate) value_range: Range<usize>,
    /// The parsed value, if it differs from the text (entities, line ends).
    pub(crate) value: Option<String>,
}

impl Attr {
    /// Local name.
    pub(crate) fn name<'a>(&self, text: &'a str) -> &'a str {
        text.get(self.name.clone()).unwrap_or("")
    }

    pub(crate) fn value<'a>(&'a self, text: &'a str) -> Cow<'a, str> {
        match &self.value {
            Some(v) => Cow::Borrowed(v),
            None => Cow::Borrowed(&text[self.value_range.clone()]),
        }
    }
}

/// An element of the source, with its positions.
#[derive(Debug, Default)]
pub(crate) struct Element {
    pub(crate) parent: Option<ElementId>,
    /// Local name; empty for elements outside the SVG namespace.
    pub(crate) tag: Cow<'static, str>,
    /// Range of the name as written, prefix included.
    pub(crate) qname: Range<usize>,
    pub(crate) range: Range<usize>,
    /// Position after the `>` of the opening tag.
    pub(crate) open_end: usize,
    /// Range of the closing tag; `None` for `<a/>`.
    pub(crate) close: Option<Range<usize>>,
    pub(crate) attrs: Vec<Attr>,
    /// Text of the `<title>` child.
    pub(crate) title: Option<String>,
}

impl Element {
    /// The attribute without a namespace that has this name.
    pub(crate) fn find(&self, text: &str, name: &str) -> Option<&Attr> {
        self.attrs.iter().find(|a| a.namespace == Namespace::None && a.name(text) == name)
    }

    /// The value of the attribute without a namespace that has this name.
    pub(crate) fn attr<'a>(&'a self, text: &'a str, name: &str) -> Option<Cow<'a, str>> {
        self.find(text, name).map(|a| a.value(text))
    }

    /// The attribute that usvg takes as the element's id.
    pub(crate) fn id_attr(&self, text: &str) -> Option<&Attr> {
        let is_id = |a: &&Attr| matches!(a.namespace, Namespace::None | Namespace::Xml) && a.name(text) == "id";
        self.attrs.iter().find(is_id)
    }
}

/// Live attributes (see [`is_live`]) in Sodipodi's namespace: the kind of shape and its parameters, and the kinds of a path's nodes.
const LIVE_SODIPODI: &str = "type cx cy rx ry start end open arc-type sides r1 r2 arg1 arg2 expansion revolution radius argument \
                             t0 original href nodetypes linespacing";

/// Live attributes in Inkscape's namespace: parameters of stars, path effects and boxes.
const LIVE_INKSCAPE: &str = "flatsided rounded randomized radius original original-d href path-effect perspectiveID box3dsidetype \
                             corner0 corner7";

/// Prefixes of further live attributes in Inkscape's namespace: of connectors, centres of rotation, and positions of tiled clones.
const LIVE_FAMILIES: [&str; 5] = ["connector-", "connection-", "transform-center-", "tiled-clone-", "tile-"];

/// Returns `true` if an attribute is out of date once its element has been warped.
pub(crate) fn is_live(a: &Attr, text: &str) -> bool {
    let name = a.name(text);
    let is_among = |names: &str| names.split(' ').any(|n| n == name);
    match a.namespace {
        Namespace::Sodipodi => is_among(LIVE_SODIPODI),
        Namespace::Inkscape => is_among(LIVE_INKSCAPE) || LIVE_FAMILIES.iter().any(|f| name.starts_with(f)),
        // The source and the recipe of an earlier warp.
        Namespace::Pathwarp => true,
        Namespace::None | Namespace::Xlink | Namespace::Xml | Namespace::Other => false,
    }
}

/// The elements of a document, with the text of its style sheets.
pub(crate) struct Table {
    pub(crate) elements: Vec<Element>,
    /// Text of all style sheets.
    pub(crate) css: String,
    /// Reason why the text cannot be patched in place.
    pub(crate) unpatchable: Option<Unpatchable>,
}

impl Table {
    /// Lists the elements of a document. Returns `None` if the root is not `<svg>`.
    pub(crate) fn read(doc: &roxmltree::Document<'_>) -> Option<Self> {
        let root = doc.root_element();
        if root.tag_name().name() != "svg" || !matches!(root.tag_name().namespace(), Some(SVG) | None) {
            return None;
        }
        let start = root.range().start;
        let mut out = Self { elements: Vec::new(), css: String::new(), unpatchable: None };
        // The current element and its ancestors.
        let mut open: Vec<(Option<roxmltree::NodeId>, ElementId)> = Vec::new();
        for node in doc.descendants().filter(roxmltree::Node::is_element) {
            let id = out.elements.len();
            let around = node.parent().map(|p| p.id());
            while open.last().is_some_and(|o| o.0 != around) {
                open.pop();
            }
            let parent = open.last().map(|o| o.1);
            open.push((Some(node.id()), id));
            // The replacement text of an entity is in the DTD, before the root.
            let element = (node.range().start >= start).then(|| element(doc.input_text(), node, parent)).flatten();
            out.elements.push(element.unwrap_or_else(|| {
                out.unpatchable.get_or_insert(Unpatchable::Entities);
                Element::default()
            }));
            if out.elements.last().is_some_and(|e| e.tag == "style") {
                out.css.push_str(node.text().unwrap_or_default());
                out.css.push('\n');
            }
        }
        Some(out)
    }
}

/// Locates an element in the source. Returns `None` if it comes from an entity.
fn element(text: &str, node: roxmltree::Node<'_, '_>, parent: Option<ElementId>) -> Option<Element> {
    let range = node.range();
    let rest = text.as_bytes().get(range.clone())?.strip_prefix(b"<")?;
    let len = rest.iter().position(|b| b.is_ascii_whitespace() || matches!(b, b'/' | b'>'))?;
    let qname = range.start + 1..range.start + 1 + len;
    let name = node.tag_name();
    let local = name.name();
    // Only a prefix may precede the local name.
    let before = rest.get(..len)?.strip_suffix(local.as_bytes())?;
    if !matches!(before.last(), None | Some(b':')) {
        return None;
    }
    let attributes = node.attributes();
    let mut attrs = Vec::with_capacity(attributes.len());
    let mut attrs_end = qname.end;
    for a in attributes {
        let (whole, value_range) = (a.range(), a.range_value());
        let raw = text.get(value_range.clone())?;
        // In the text of an entity, positions may be those of another tag.
        if whole.start < attrs_end || whole.end > range.end || !text.as_bytes().get(whole.clone())?.contains(&b'=') {
            return None;
        }
        attrs_end = attrs_end.max(whole.end);
        let name_end = a.range_qname().end;
        attrs.push(Attr {
            name: name_end.checked_sub(a.name().len())?..name_end,
            namespace: Namespace::from_uri(a.namespace()),
            range: whole,
            value: (raw != a.value()).then(|| a.value().to_owned()),
            value_range,
        });
    }
    // The parser does not list namespace declarations as attributes; their quoted values may contain `>`.
    let open_end = tag_end(text, attrs_end, range.end)?;
    let close =
        if open_end < range.end { Some(memrchr(b'<', text.as_bytes().get(..range.end)?)?..range.end) } else { None };
    let title = node.children().find(|c| c.is_element() && c.tag_name().name() == "title");
    let title = title.and_then(|t| t.text()).map(str::trim).filter(|t| !t.is_empty()).map(ToOwned::to_owned);
    let tag = match name.namespace() {
        Some(SVG) | None => common_tag(local).map_or_else(|| Cow::Owned(local.to_owned()), Cow::Borrowed),
        Some(_) => Cow::Borrowed(""),
    };
    let range = range.start..close.as_ref().map_or(open_end, |c| c.end);
    Some(Element { parent, tag, qname, range, open_end, close, attrs, title })
}

/// Interns common tags to avoid allocating them.
fn common_tag(tag: &str) -> Option<&'static str> {
    Some(match tag {
        "path" => "path",
        "g" => "g",
        "svg" => "svg",
        "rect" => "rect",
        "circle" => "circle",
        "use" => "use",
        "defs" => "defs",
        "stop" => "stop",
        "title" => "title",
        "ellipse" => "ellipse",
        "line" => "line",
        "polygon" => "polygon",
        "polyline" => "polyline",
        "linearGradient" => "linearGradient",
        "radialGradient" => "radialGradient",
        "clipPath" => "clipPath",
        "mask" => "mask",
        "style" => "style",
        _ => return None,
    })
}

/// Finds the end of an opening tag, after the first `>` outside quotes.
pub(crate) fn tag_end(text: &str, from: usize, to: usize) -> Option<usize> {
    let mut quote = None;
    for (i, b) in text.as_bytes().get(from..to)?.iter().enumerate() {
        match (quote, b) {
            (None, b'"' | b'\'') => quote = Some(*b),
            (Some(q), b) if q == *b => quote = None,
            (None, b'>') => return Some(from + i + 1),
            _ => {}
        }
    }
    None
}

/// The elements of a document by id; of several with one id, the first.
pub(crate) fn first_by_id<'a, 'i>(doc: &'a roxmltree::Document<'i>) -> HashMap<&'a str, roxmltree::Node<'a, 'i>> {
    let mut out = HashMap::new();
    for n in doc.descendants() {
        if let Some(id) = n.attribute("id") {
            out.entry(id).or_insert(n);
        }
    }
    out
}

/// Parses a transform list and multiplies its transforms.
pub(crate) fn parse_transform(text: &str) -> Option<Affine> {
    let t = svgtypes::Transform::from_str(text).ok()?;
    Some(Affine::new([t.a, t.b, t.c, t.d, t.e, t.f]))
}

/// The reason why a source text cannot be patched in place.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Unpatchable {
    #[error("parts of it come from DTD entities, which have no position in the text")]
    Entities,
    #[error("an image shares its id with another element")]
    AmbiguousImage,
    #[error("a text shares its id with another element")]
    AmbiguousText,
    #[error("a painted path cannot be traced to one element of the source")]
    UntracedPath,
    #[error("an element with a {0} cannot be identified")]
    AmbiguousReferrer(&'static str),
    #[error("a nested viewport with a transform clips its content")]
    ClippingViewport,
    #[error("its root element is empty")]
    EmptyRoot,
}

/// Splits a style attribute or the block of a rule into declarations.
pub(crate) fn declarations(style: &str) -> impl Iterator<Item = (&str, &str)> {
    // Quoted strings and url(data:…;base64,…) may contain semicolons.
    let mut parts = Vec::new();
    let (mut depth, mut quote, mut start) = (0_i32, None, 0);
    for (i, c) in style.char_indices() {
        match (quote, c) {
            (None, '"' | '\'') => quote = Some(c),
            (Some(q), c) if q == c => quote = None,
            (None, '(') => depth += 1,
            (None, ')') => depth -= 1,
            (None, ';') if depth <= 0 => {
                parts.push(&style[start..i]);
                start = i + 1;
            }
            _ => {}
        }
    }
    parts.push(&style[start..]);
    parts.into_iter().filter_map(|p| p.split_once(':')).map(|(n, v)| (n.trim(), v.trim()))
}

/// Returns the value of a property in a style attribute.
pub(crate) fn declared<'a>(style: &'a str, name: &str) -> Option<&'a str> {
    declarations(style).filter(|(n, _)| n.eq_ignore_ascii_case(name)).last().map(|d| d.1)
}

/// The style attribute with a property set, in place of an existing declaration if there is one.
pub(crate) fn with_declaration(style: &str, name: &str, value: &str) -> String {
    let mut out: Vec<String> = Vec::new();
    let mut set = false;
    for (n, v) in declarations(style) {
        if !n.eq_ignore_ascii_case(name) {
            out.push(format!("{n}:{v}"));
        } else if !set {
            out.push(format!("{n}:{value}"));
            set = true;
        }
    }
    if !set {
        out.push(format!("{name}:{value}"));
    }
    out.join(";")
}
