//! The source text as a table of elements with their places in it: what the writer patches and what names are looked up in.

use crate::source::marks::{self, Marks};
use crate::source::table::Table;
use crate::write::keep::is_animation;
use pathwarp::Error;
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::sync::OnceLock;
use usvg::roxmltree;

pub(crate) const SVG: &str = "http://www.w3.org/2000/svg";
pub(crate) const XLINK: &str = "http://www.w3.org/1999/xlink";
pub(crate) const XML: &str = "http://www.w3.org/XML/1998/namespace";
pub(crate) const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";

/// An element's number: its place in document order.
pub(crate) type ElementId = usize;

/// Where an attribute's name comes from, as far as anybody here asks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Namespace {
    None,
    Xlink,
    Xml,
    Inkscape,
    Other,
}

#[derive(Debug)]
pub(crate) struct Attr {
    /// The local name in the text.
    pub(crate) name: Range<usize>,
    pub(crate) namespace: Namespace,
    /// The whole attribute in the text, quotes included.
    pub(crate) range: Range<usize>,
    /// The value in the text, without the quotes.
    pub(crate) value_range: Range<usize>,
    /// The value, where it differs from the text (entities, line ends).
    pub(crate) value: Option<String>,
}

#[derive(Debug)]
pub(crate) struct Element {
    pub(crate) parent: Option<ElementId>,
    /// The local name; empty for elements that are not SVG.
    pub(crate) tag: Cow<'static, str>,
    /// The name as written, prefix included, right after `<`.
    pub(crate) qname: Range<usize>,
    pub(crate) range: Range<usize>,
    /// One past the `>` of the opening tag.
    pub(crate) open_end: usize,
    /// The closing tag; `None` for `<a/>`.
    pub(crate) close: Option<Range<usize>>,
    pub(crate) attrs: Vec<Attr>,
    /// What its `<title>` child says.
    pub(crate) title: Option<String>,
}

/// The text and its elements.
#[derive(Debug)]
pub(crate) struct Source {
    pub(crate) text: String,
    pub(crate) elements: Vec<Element>,
    /// All style sheets' text, one after the other.
    pub(crate) css: String,
    /// Whether anything moves.
    pub(crate) animated: bool,
    /// Why the text cannot be patched in place.
    pub(crate) unpatchable: Option<String>,
    marks: Marks,
    // What follows is worked out when it is first asked for.
    by_id: OnceLock<HashMap<String, Vec<ElementId>>>,
    ids: OnceLock<HashMap<String, Vec<ElementId>>>,
    css_words: OnceLock<HashSet<String>>,
    line_starts: OnceLock<Vec<usize>>,
}

/// The elements that draw by themselves.
pub(crate) fn is_shape(tag: &str) -> bool {
    matches!(tag, "path" | "rect" | "circle" | "ellipse" | "line" | "polyline" | "polygon")
}

/// The elements whose ids usvg carries into its tree.
pub(crate) fn is_tracked(tag: &str) -> bool {
    is_shape(tag) || matches!(tag, "g" | "a" | "use" | "text" | "image" | "svg" | "switch")
}

impl Source {
    /// Reads `text`, called `name` in messages, and hands `then` the table of its elements and the XML document that usvg is
    /// to resolve: with temporary ids, so that usvg's tree can be told apart.
    pub(crate) fn read<T>(
        text: String,
        name: &str,
        then: impl FnOnce(&Self, &roxmltree::Document<'_>) -> Result<T, Error>,
    ) -> Result<(Self, T), Error> {
        if let Some(marked) = marks::mark(&text)
            && let Ok(doc) = xml(&marked.text, name)
            && let Some(table) = Table::of(&doc, &marked.patches)
            && table.unpatchable.is_none()
            && table.elements.len() == marked.elements
        {
            let source = Self::new(text, table, marked.marks);
            let result = then(&source, &doc)?;
            return Ok((source, result));
        }
        let mut source = Self::parse(text, name)?;
        let (marked, marks) = source.instrumented();
        source.marks = marks;
        // Where positions are not to be trusted, the text must not be touched.
        let marked = if source.unpatchable.is_none() { marked } else { source.text.clone() };
        let result = then(&source, &xml(&marked, name)?)?;
        Ok((source, result))
    }

    /// The table of `text`, called `name` in messages; without temporary ids.
    pub(crate) fn parse(text: String, name: &str) -> Result<Self, Error> {
        let doc = xml(&text, name)?;
        let root = doc.root_element();
        let Some(table) = Table::of(&doc, &[]) else {
            let at = doc.text_pos_at(root.range().start);
            return Err(Error::input(
                format!("{name}:{}:{}", at.row, at.col),
                format!("the root element is <{}>, not <svg>", root.tag_name().name()),
            ));
        };
        drop(doc);
        Ok(Self::new(text, table, Marks::default()))
    }

    fn new(text: String, table: Table, marks: Marks) -> Self {
        let Table { elements, css, unpatchable } = table;
        let animated = elements.iter().any(|e| is_animation(&e.tag));
        Self {
            text,
            elements,
            css,
            animated,
            unpatchable,
            marks,
            by_id: OnceLock::new(),
            ids: OnceLock::new(),
            css_words: OnceLock::new(),
            line_starts: OnceLock::new(),
        }
    }

    /// Elements by id, in document order.
    pub(crate) fn by_id(&self) -> &HashMap<String, Vec<ElementId>> {
        self.by_id.get_or_init(|| {
            let mut out: HashMap<String, Vec<ElementId>> = HashMap::new();
            for (i, e) in self.elements.iter().enumerate() {
                if let Some(v) = e.attr(&self.text, "id").filter(|v| !v.is_empty()) {
                    out.entry(v.into_owned()).or_default().push(i);
                }
            }
            out
        })
    }

    /// What the ids of usvg's tree stand for.
    pub(crate) fn ids(&self) -> &HashMap<String, Vec<ElementId>> {
        self.ids.get_or_init(|| {
            let mut out: HashMap<String, Vec<ElementId>> = HashMap::new();
            let mut marked = self.marks.elements.iter().copied().peekable();
            for (i, e) in self.elements.iter().enumerate() {
                if marked.next_if_eq(&i).is_some() {
                    out.insert(format!("{}{i}", self.marks.stem), vec![i]);
                } else if is_tracked(&e.tag)
                    && let Some(id) = e.name(&self.text)
                {
                    out.entry(id.value(&self.text).into_owned()).or_default().push(i);
                }
            }
            out
        })
    }

    /// Line and column (in characters), counted from 1.
    pub(crate) fn line_column(&self, at: usize) -> (usize, usize) {
        let starts = self
            .line_starts
            .get_or_init(|| std::iter::once(0).chain(self.text.match_indices('\n').map(|(i, _)| i + 1)).collect());
        let line = starts.partition_point(|&s| s <= at);
        let start = line.checked_sub(1).and_then(|l| starts.get(l)).copied().unwrap_or(0);
        (line, self.text.get(start..at).map_or(0, |s| s.chars().count()) + 1)
    }

    pub(crate) fn attr(&self, e: ElementId, name: &str) -> Option<Cow<'_, str>> {
        self.elements.get(e)?.attr(&self.text, name)
    }

    /// An attribute whatever its namespace prefix means, e.g. Inkscape's label.
    pub(crate) fn attr_in(&self, e: ElementId, namespace: Namespace, name: &str) -> Option<Cow<'_, str>> {
        let el = self.elements.get(e)?;
        el.attrs.iter().find(|a| a.namespace == namespace && a.name(&self.text) == name).map(|a| a.value(&self.text))
    }

    /// The target of `href` or `xlink:href`, without the `#`.
    pub(crate) fn href(&self, e: ElementId) -> Option<String> {
        self.link(e)?.trim().strip_prefix('#').map(ToOwned::to_owned)
    }

    /// What `href` or `xlink:href` says.
    pub(crate) fn link(&self, e: ElementId) -> Option<Cow<'_, str>> {
        self.attr_in(e, Namespace::None, "href").or_else(|| self.attr_in(e, Namespace::Xlink, "href"))
    }

    /// The element and its ancestors, innermost first.
    pub(crate) fn ancestors(&self, e: ElementId) -> impl Iterator<Item = ElementId> {
        std::iter::successors(Some(e), |&e| self.elements.get(e).and_then(|e| e.parent))
    }

    /// The nearest enclosing `<svg>` (not the element itself).
    pub(crate) fn viewport(&self, e: ElementId) -> Option<ElementId> {
        self.ancestors(e).skip(1).find(|&a| self.elements[a].tag == "svg")
    }

    pub(crate) fn label(&self, e: ElementId) -> Option<Cow<'_, str>> {
        self.attr_in(e, Namespace::Inkscape, "label")
    }

    /// The id, or a readable stand-in such as `path at 12:5`.
    pub(crate) fn display_name(&self, e: ElementId) -> String {
        match self.attr(e, "id") {
            Some(id) if !id.is_empty() => id.into_owned(),
            _ => {
                let (line, column) = self.line_column(self.elements[e].range.start);
                format!("{} at {line}:{column}", self.elements[e].tag)
            }
        }
    }

    /// Whether there are style sheets.
    pub(crate) fn has_css(&self) -> bool {
        !self.css.trim().is_empty()
    }

    /// Whether the style sheets say anything with this name: an element in a selector or a property in a declaration.
    pub(crate) fn css_mentions(&self, word: &str) -> bool {
        !self.css.is_empty() && self.css_words.get_or_init(|| words(&self.css)).contains(word)
    }

    /// The prefix that SVG's own elements carry, with its colon: mostly "".
    pub(crate) fn prefix(&self) -> &str {
        let Some(root) = self.elements.first() else { return "" };
        let name = self.text.get(root.qname.clone()).unwrap_or("");
        name.find(':').map_or("", |i| &name[..=i])
    }

    /// The text with a temporary id on every element that has none of its own, and which elements these are.
    fn instrumented(&self) -> (String, Marks) {
        self.instrumented_with(std::iter::empty())
    }

    /// The same with declarations added to elements' style attributes.
    pub(crate) fn instrumented_with(&self, styles: impl Iterator<Item = (ElementId, String)>) -> (String, Marks) {
        let mut marks = Marks { stem: marks::stem(&self.text), elements: Vec::new() };
        let links = marks::links(&self.text);
        let mut patches: Vec<(Range<usize>, String)> = Vec::new();
        for (i, e) in self.elements.iter().enumerate() {
            if !is_tracked(&e.tag) {
                continue;
            }
            let own = e.name(&self.text);
            let value = own.map(|a| a.value(&self.text));
            let shared = |id: &str| self.by_id().get(id).is_some_and(|v| v.len() > 1);
            if value.is_none_or(|id| id.is_empty() || shared(&id) && !links.contains(&*id)) {
                let id = format!("{}{i}", marks.stem);
                patches.push(match own {
                    Some(a) => (a.value_range.clone(), id),
                    None => (e.qname.end..e.qname.end, format!(" id=\"{id}\"")),
                });
                marks.elements.push(i);
            }
        }
        patches.extend(styles.filter_map(|(e, style)| {
            let e = self.elements.get(e)?;
            Some(match e.find(&self.text, "style") {
                Some(a) => (a.value_range.end..a.value_range.end, format!(";{style}")),
                None => (e.qname.end..e.qname.end, format!(" style=\"{style}\"")),
            })
        }));
        patches.sort_by_key(|(at, _)| at.start);
        let mut out = String::with_capacity(self.text.len() + patches.len() * 16);
        let mut done = 0;
        for (at, new) in patches {
            // Of elements from one entity only the first is told.
            if at.start >= done {
                out.push_str(&self.text[done..at.start]);
                out.push_str(&new);
                done = at.end;
            }
        }
        out.push_str(&self.text[done..]);
        (out, marks)
    }
}

impl Attr {
    /// The local name.
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

impl Element {
    fn find(&self, text: &str, name: &str) -> Option<&Attr> {
        self.attrs.iter().find(|a| a.namespace == Namespace::None && a.name(text) == name)
    }

    fn attr<'a>(&'a self, text: &'a str, name: &str) -> Option<Cow<'a, str>> {
        self.find(text, name).map(|a| a.value(text))
    }

    /// What usvg takes for its id.
    fn name(&self, text: &str) -> Option<&Attr> {
        let named = |a: &&Attr| matches!(a.namespace, Namespace::None | Namespace::Xml) && a.name(text) == "id";
        self.attrs.iter().find(named)
    }
}

/// Parses XML, called `name` in messages.
pub(crate) fn xml<'a>(text: &'a str, name: &str) -> Result<roxmltree::Document<'a>, Error> {
    /// Elements, texts and comments together; usvg takes no more than a million elements.
    const MOST: u32 = 4_000_000;
    let options = roxmltree::ParsingOptions { allow_dtd: true, nodes_limit: MOST, ..Default::default() };
    roxmltree::Document::parse_with_options(text, options).map_err(|e| {
        if matches!(e, roxmltree::Error::NodesLimitReached) {
            return Error::input(name, format!("it has more than {MOST} elements, texts and comments"));
        }
        let at = e.pos();
        Error::input(format!("{name}:{}:{}", at.row, at.col), format!("this is not well-formed XML: {e}"))
    })
}

/// The words of a style sheet. Class and id names are left out, as `.rect` says nothing about `<rect>`.
fn words(css: &str) -> HashSet<String> {
    let mut out = HashSet::new();
    let mut word = String::new();
    let mut before = ' ';
    let mut named = false;
    let css: String = css
        .split("/*")
        .enumerate()
        .map(|(i, s)| if i == 0 { s } else { s.split_once("*/").map_or("", |p| p.1) })
        .collect();
    for c in css.chars().chain(['\n']) {
        if c.is_alphanumeric() || c == '-' || c == '_' {
            if word.is_empty() {
                named = before == '.' || before == '#';
            }
            word.push(c);
        } else {
            if !word.is_empty() && !named {
                out.insert(word.to_ascii_lowercase());
            }
            word.clear();
            if c == '*' {
                out.insert("*".to_owned());
            }
            before = c;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_found() {
        let s = Source::parse(
            "<svg xmlns='http://www.w3.org/2000/svg'>\n <rect  x = '1' id='a'/><g a='>'>t</g></svg>".into(),
            "t",
        )
        .unwrap();
        let r = &s.elements[1];
        assert_eq!(&s.text[r.range.clone()], "<rect  x = '1' id='a'/>");
        assert_eq!(&s.text[r.find(&s.text, "x").unwrap().value_range.clone()], "1");
        assert!(r.close.is_none());
        let g = &s.elements[2];
        assert_eq!(&s.text[g.open_end..g.close.clone().unwrap().start], "t");
        assert_eq!(s.line_column(r.range.start), (2, 2));
    }

    /// The same things in the same places, however the ids came into the text.
    #[test]
    fn temporary_ids_leave_the_rest_alone() {
        let drawings = [
            "<svg xmlns='http://www.w3.org/2000/svg'><path/><g id='q'><path id=''/></g></svg>",
            "<?xml version='1.0'?>\n<!DOCTYPE svg>\n<!-- <path> --><s:svg xmlns:s='http://www.w3.org/2000/svg' a='>'\n><s:g\n/>\
             <s:path xml:id = \"a\" d='M0,0'/><s:style><![CDATA[ <g> .b{} ]]></s:style><s:title>t &amp; u</s:title></s:svg >",
            "<svg xmlns='http://www.w3.org/2000/svg' xmlns:i='http://www.inkscape.org/namespaces/inkscape'>\
             <g id='a' i:label='&lt;'><path id='a' d='M0,0\n1,1'/></g><rect id='longer than warp-5' x='1'/><rect \
             id='longer than warp-5' y='2'/><use href='#a'/><text><tspan id='c'>warp-</tspan></text><svg/></svg>",
        ];
        for d in drawings {
            let direct = Source::parse(d.to_owned(), "t").unwrap();
            let (wanted, marks) = direct.instrumented();
            let marked = marks::mark(d).unwrap();
            assert_eq!(marked.text, wanted);
            assert_eq!(marked.marks.elements, marks.elements);
            let (source, n) = Source::read(d.to_owned(), "t", |_, doc| Ok(doc.input_text().len())).unwrap();
            assert_eq!((n, &source.text), (wanted.len(), &direct.text));
            assert_eq!(format!("{:?}", source.elements), format!("{:?}", direct.elements));
            for e in &source.elements {
                assert!(d[e.range.start..].starts_with(&format!("<{}", &d[e.qname.clone()])));
                assert_eq!(&d[e.open_end - 1..e.open_end], ">");
                assert!(e.attrs.iter().all(|a| d[a.range.clone()].contains(&d[a.value_range.clone()])));
            }
        }
        let (text, ids) = {
            let (s, text) =
                Source::read(drawings[0].to_owned(), "t", |_, doc| Ok(doc.input_text().to_owned())).unwrap();
            (text, s.ids().clone())
        };
        assert_eq!(
            text,
            "<svg id=\"warp-0\" xmlns='http://www.w3.org/2000/svg'><path id=\"warp-1\"/><g id='q'><path id='warp-3'/></g></svg>"
        );
        assert_eq!((&ids["q"], &ids["warp-3"]), (&vec![2], &vec![3]));
        // Entities take the long way.
        assert!(marks::mark("<!DOCTYPE svg [<!ENTITY g '<g/>'>]><svg/>").is_none());
    }

    #[test]
    fn a_class_is_not_a_type_selector() {
        let w = words("/* rect */ .circle, g > line:hover{fill:red}");
        assert!(w.contains("line") && w.contains("fill") && !w.contains("circle") && !w.contains("*"));
    }
}
