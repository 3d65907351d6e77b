//! The source text with its elements, for looking up names and attributes. Patches refer to positions in it.

use super::edit::splice;
use super::elements::{
    Attr, Element, ElementId, INKSCAPE, Namespace, SVG, Table, Unpatchable, XLINK, declared, is_animation, is_tracked,
};
use super::mesh::{self, MeshGradient};
use super::threads::{both, map_parallel};
use pathwarp::budget::Budget;
use pathwarp::{Error, Outline};
use pathwarp_reader::xml::{self, escape};
use pathwarp_reader::{Change, Linked, Plain, Words, resolve};
use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::ops::Range;
use std::sync::{Arc, OnceLock};
use usvg::roxmltree;

/// Limit on missing prefixes to declare. Each costs one parse.
const MAX_PREFIXES: usize = 16;

/// The text and its elements.
#[derive(Debug, Default)]
pub(crate) struct SourceText {
    pub(crate) text: String,
    pub(crate) elements: Vec<Element>,
    /// Concatenated text of all style sheets.
    pub(crate) css: String,
    /// The properties that the style sheets declare.
    declared: BTreeSet<String>,
    /// `true` if the drawing has animations.
    pub(crate) animated: bool,
    /// Reason why the text cannot be patched in place.
    pub(crate) unpatchable: Option<Unpatchable>,
    /// Namespace prefixes that the file did not declare; `text` does.
    pub(crate) undeclared: Vec<String>,
    /// Differences of `text` from the file, in order. `text` is resolved so that usvg reads it as browsers read the file.
    pub(crate) originals: Vec<Change>,
    /// Elements whose numbers are out of range, each with the first such number.
    pub(crate) far: Vec<(ElementId, String)>,
    /// Unsupported style: the element, or `None` for style sheets, and a message.
    pub(crate) unsupported_style: Vec<(Option<ElementId>, String)>,
    /// The declarations of paint that hold for each element, inherited ones included.
    pub(crate) words: Vec<Arc<Words>>,
    /// Small differences from browsers' rendering: a sentence, and the element or name that it concerns.
    pub(crate) notes: BTreeSet<(&'static str, String)>,
    /// Texts that stand for HTML in the same `switch`: pairs of the `foreignObject` and the `text`, in document order.
    pub(crate) foreign: Vec<(ElementId, ElementId)>,
    /// Mesh gradients by id.
    pub(crate) meshes: HashMap<String, MeshGradient>,
    /// Temporary ids in the document that usvg reads.
    marks: Marks,
    /// Outlines of `path` elements, read ahead for large drawings.
    pub(crate) ahead: Ahead,
    // The following fields are computed on first use.
    by_id: OnceLock<HashMap<String, Vec<ElementId>>>,
    by_tree_id: OnceLock<HashMap<String, Vec<ElementId>>>,
    line_starts: OnceLock<Vec<usize>>,
    /// Numbers of characters before evenly spaced positions.
    characters: OnceLock<Vec<usize>>,
}

impl SourceText {
    /// Reads `text` and calls `then` with the table of its elements and the XML document for usvg, in which temporary ids
    /// identify the elements. `name` identifies the text in errors.
    pub(crate) fn read<T>(
        text: String,
        name: &str,
        budget: &Budget,
        linked: Linked<'_>,
        then: impl FnOnce(&Self, &roxmltree::Document<'_>) -> Result<T, Error>,
    ) -> Result<(Self, T), Error> {
        let mut undeclared = Vec::new();
        let (source, result) = to_plain(text, name, budget, Some(&mut undeclared), linked, |plain, doc, expanded| {
            let mut source = Self::from_plain(doc, plain, name)?;
            if expanded {
                source.unpatchable.get_or_insert(Unpatchable::Entities);
            }
            let (marked, marks) = source.instrumented(std::iter::empty());
            // Without reliable positions, ids cannot be inserted.
            let marked = marked.filter(|_| source.unpatchable.is_none());
            source.marks = marks;
            let result = match marked {
                Some(marked) => then(&source, &xml::parse_checked(&marked, name)?),
                None => then(&source, doc),
            };
            Ok((source, result?))
        })?;
        Ok((Self { undeclared, ..source }, result))
    }

    /// The text and elements of a drawing that was resolved into plain SVG. `name` identifies it in errors.
    pub(crate) fn from_plain(doc: &roxmltree::Document<'_>, plain: Plain, name: &str) -> Result<Self, Error> {
        let root = doc.root_element();
        let Some(Table { elements, css, unpatchable }) = Table::read(doc) else {
            let start = doc.text_pos_at(root.range().start);
            let place = format!("{name}:{}:{}", start.row, start.col);
            return Err(Error::input(place, format!("the root element is <{}>, not <svg>", root.tag_name().name())));
        };
        Ok(Self {
            text: doc.input_text().to_owned(),
            animated: elements.iter().any(|e| is_animation(&e.tag)),
            elements,
            css,
            unpatchable,
            meshes: mesh::read(doc),
            originals: plain.changes,
            far: plain.far,
            unsupported_style: plain.unsupported,
            declared: plain.declared,
            words: plain.words,
            notes: plain.notes,
            foreign: plain.foreign,
            ..Self::default()
        })
    }

    /// Returns `true` if the drawing can be read on any thread: the smallest stack is deep enough, and nothing in it could make its readers
    /// panic. References multiply the depth, as their targets may hold further references.
    pub(crate) fn is_shallow(&self) -> bool {
        /// Limit on depth times references. A level takes a few kilobytes of stack.
        const MAX_LEVELS: usize = 80;
        let mut depths: Vec<usize> = Vec::with_capacity(self.elements.len());
        let mut references = 1;
        for e in &self.elements {
            depths.push(e.parent.map_or(0, |p| depths[p] + 1));
            let refers =
                matches!(e.tag.as_ref(), "use" | "clipPath" | "mask" | "pattern" | "marker" | "filter" | "image");
            references += usize::from(refers);
        }
        // Entities make depths unreliable. An embedded font may be crafted to make its reader panic, which only `with_stack` catches.
        self.unpatchable.is_none()
            && !self.css.contains("@font-face")
            && depths.iter().max().is_none_or(|d| d * references <= MAX_LEVELS)
    }

    /// Calls `f`, and meanwhile reads the outlines of a large drawing on another thread.
    pub(crate) fn reading_ahead<T: Send>(&self, f: impl FnOnce() -> T + Send) -> T {
        if self.text.len() < WORTH_THREADS {
            return f();
        }
        // Don't read inside `get_or_init`: a thread waiting for others may run a task that needs the outlines, too.
        both(f, || self.ahead.set(read_outlines(&self.text, &self.elements))).0
    }

    /// The element's style attribute as results have it, unless a warp changes it.
    pub(crate) fn written_style(&self, e: ElementId) -> String {
        let first = self.originals.partition_point(|o| o.element < e);
        let original = self.originals[first..].iter().take_while(|o| o.element == e).find(|o| o.name == "style");
        let value = original.map_or_else(|| self.attr(e, "style").map(Cow::into_owned), |o| o.value.clone());
        value.unwrap_or_default()
    }

    /// Returns `false` for an element that the reader added.
    pub(crate) fn is_in_file(&self, e: &Element) -> bool {
        let next = self.originals.partition_point(|o| o.range.end <= e.range.start);
        self.originals.get(next).is_none_or(|o| e.range.start < o.range.start)
    }

    /// The whole text as it is in the file.
    pub(crate) fn as_in_file(&self) -> Cow<'_, str> {
        self.part_in_file(0..self.text.len())
    }

    /// Positions in the file of ascending positions in the text.
    pub(crate) fn positions_in_file(&self, positions: impl Iterator<Item = usize>) -> Vec<usize> {
        let mut originals = self.originals.iter().peekable();
        let (mut removed, mut added) = (0, 0);
        let in_file = |at: usize| {
            while let Some(o) = originals.next_if(|o| o.range.end <= at) {
                (removed, added) = (removed + o.text.len(), added + o.range.len());
            }
            at + removed - added
        };
        positions.map(in_file).collect()
    }

    /// A part of the text as it is in the file.
    pub(crate) fn part_in_file(&self, range: Range<usize>) -> Cow<'_, str> {
        let first = self.originals.partition_point(|o| o.range.start < range.start);
        let inside = self.originals[first..].iter().take_while(|o| o.range.end <= range.end);
        let mut out = String::new();
        let mut done = range.start;
        for o in inside {
            out.push_str(&self.text[done..o.range.start]);
            out.push_str(&o.text);
            done = o.range.end;
        }
        let rest = &self.text[done..range.end];
        if done == range.start { Cow::Borrowed(rest) } else { Cow::Owned(out + rest) }
    }

    /// Elements by id, in document order.
    pub(crate) fn by_id(&self) -> &HashMap<String, Vec<ElementId>> {
        self.by_id.get_or_init(|| {
            let mut out: HashMap<String, Vec<ElementId>> = HashMap::new();
            for (i, e) in self.elements.iter().enumerate() {
                if let Some(id) = e.attr(&self.text, "id").filter(|id| !id.is_empty()) {
                    out.entry(id.into_owned()).or_default().push(i);
                }
            }
            out
        })
    }

    /// The paint server of an element's `fill` or `stroke`, declared on it or inherited: the first one with the id, as in browsers.
    pub(crate) fn paint_server(&self, e: ElementId, property: &str) -> Option<ElementId> {
        let value = self.ancestors(e).find_map(|a| self.property(a, property).filter(|v| v != "inherit"))?;
        let id = value.strip_prefix("url(")?.split(')').next()?.trim_matches(['"', '\'', ' ']).strip_prefix('#')?;
        self.by_id().get(id)?.first().copied()
    }

    /// The mesh gradient that an element defines.
    pub(crate) fn mesh(&self, e: ElementId) -> Option<&MeshGradient> {
        self.meshes.get(&*self.attr(e, "id")?).filter(|_| mesh::is_mesh(&self.elements[e].tag))
    }

    /// Elements by their id in usvg's tree, which may be a temporary one.
    pub(crate) fn by_tree_id(&self) -> &HashMap<String, Vec<ElementId>> {
        self.by_tree_id.get_or_init(|| {
            let mut out: HashMap<String, Vec<ElementId>> = HashMap::new();
            let mut marked = self.marks.elements.iter().copied().peekable();
            for (i, e) in self.elements.iter().enumerate() {
                if marked.next_if_eq(&i).is_some() {
                    out.insert(format!("{}{i}", self.marks.stem), vec![i]);
                } else if is_tracked(&e.tag)
                    && let Some(id) = e.id_attr(&self.text)
                {
                    out.entry(id.value(&self.text).into_owned()).or_default().push(i);
                }
            }
            out
        })
    }

    /// The line and column (in characters) of a position, both from 1.
    pub(crate) fn line_column(&self, at: usize) -> (usize, usize) {
        let starts = self
            .line_starts
            .get_or_init(|| std::iter::once(0).chain(self.text.match_indices('\n').map(|(i, _)| i + 1)).collect());
        let line = starts.partition_point(|&s| s <= at);
        let start = line.checked_sub(1).and_then(|l| starts.get(l)).copied().unwrap_or(0);
        (line, self.characters(at) - self.characters(start) + 1)
    }

    /// Number of characters before the byte `at`, counted from the nearest checkpoint, as a text may be a single line.
    fn characters(&self, at: usize) -> usize {
        /// Bytes between checkpoints.
        const STEP: usize = 1 << 8;
        // Counts the bytes that begin a character.
        let count = |from: usize, to: usize| {
            self.text.as_bytes()[from.min(to)..to].iter().filter(|b| (**b as i8) >= -0x40).count()
        };
        let known = self.characters.get_or_init(|| {
            let mut before = 0;
            let steps = (0..self.text.len()).step_by(STEP).map(|i| {
                let here = before;
                before += count(i, (i + STEP).min(self.text.len()));
                here
            });
            steps.collect()
        });
        let at = at.min(self.text.len());
        let block = (at / STEP).min(known.len().saturating_sub(1));
        known.get(block).map_or(0, |before| before + count(block * STEP, at))
    }

    /// The value of an attribute without a namespace.
    pub(crate) fn attr(&self, e: ElementId, name: &str) -> Option<Cow<'_, str>> {
        self.elements.get(e)?.attr(&self.text, name)
    }

    /// The value of a property declared on an element.
    pub(crate) fn property(&self, e: ElementId, name: &str) -> Option<Cow<'_, str>> {
        let style = self.attr(e, "style");
        let declared = style.as_deref().and_then(|s| declared(s, name)).map(|v| v.to_owned().into());
        declared.or_else(|| self.attr(e, name))
    }

    /// An attribute in a namespace, e.g. Inkscape's label.
    pub(crate) fn attr_in(&self, e: ElementId, namespace: Namespace, name: &str) -> Option<Cow<'_, str>> {
        let el = self.elements.get(e)?;
        el.attrs.iter().find(|a| a.namespace == namespace && a.name(&self.text) == name).map(|a| a.value(&self.text))
    }

    /// Target of `href` or `xlink:href`, without the `#`.
    pub(crate) fn href(&self, e: ElementId) -> Option<String> {
        self.link(e)?.trim().strip_prefix('#').map(ToOwned::to_owned)
    }

    /// The element to which `href` or `xlink:href` refers: the last one with the id, as for usvg (except in a `use`).
    pub(crate) fn target(&self, e: ElementId) -> Option<ElementId> {
        self.by_id().get(&self.href(e)?)?.last().copied()
    }

    /// Returns `true` if an attribute such as `filterUnits`, on the element or the chain of its references, specifies user space; `None` if
    /// it is not given.
    pub(crate) fn in_user_space(&self, e: ElementId, units: &str) -> Option<bool> {
        /// Number of references that are followed, far more than files have, in case they form a circle.
        const MAX_LINKS: usize = 16;
        let mut chain = std::iter::successors(Some(e), |&e| self.target(e)).take(MAX_LINKS);
        chain.find_map(|e| self.attr(e, units)).map(|u| u.trim() == "userSpaceOnUse")
    }

    /// The value of `href` or `xlink:href`.
    pub(crate) fn link(&self, e: ElementId) -> Option<Cow<'_, str>> {
        self.attr_in(e, Namespace::None, "href").or_else(|| self.attr_in(e, Namespace::Xlink, "href"))
    }

    /// The element and its ancestors, innermost first.
    pub(crate) fn ancestors(&self, e: ElementId) -> impl Iterator<Item = ElementId> {
        std::iter::successors(Some(e), |&e| self.elements.get(e).and_then(|e| e.parent))
    }

    /// The elements inside an element, in document order.
    pub(crate) fn descendants(&self, e: ElementId) -> impl Iterator<Item = ElementId> + '_ {
        let end = self.elements[e].range.end;
        (e + 1..self.elements.len()).take_while(move |&d| self.elements[d].range.start < end)
    }

    /// The nearest enclosing `<svg>` (not the element itself).
    pub(crate) fn viewport(&self, e: ElementId) -> Option<ElementId> {
        self.ancestors(e).skip(1).find(|&a| self.elements[a].tag == "svg")
    }

    /// Inkscape's label of an element.
    pub(crate) fn label(&self, e: ElementId) -> Option<Cow<'_, str>> {
        self.attr_in(e, Namespace::Inkscape, "label")
    }

    /// The name of an image in messages; its element may be unknown.
    pub(crate) fn image_name(&self, e: Option<ElementId>) -> String {
        e.map_or_else(|| "an image".to_owned(), |e| self.display_name(e))
    }

    /// Names an element in messages: its id, or else its tag and position, such as `path at 12:5`, with the letter of a glyph:
    /// `path “G” at 12:5`.
    pub(crate) fn display_name(&self, e: ElementId) -> String {
        match self.attr(e, "id") {
            Some(id) if !id.is_empty() => id.into_owned(),
            _ => {
                let (line, column) = self.line_column(self.elements[e].range.start);
                let letter = self.attr(e, "data-glyph").and_then(|_| self.attr(e, "aria-label"));
                let letter = letter.map_or_else(String::new, |l| format!(" “{l}”"));
                format!("{}{letter} at {line}:{column}", self.elements[e].tag)
            }
        }
    }

    /// The text with an id for every graphics element that has none: its [name](Self::display_name).
    pub(crate) fn with_ids(&self) -> String {
        let lacks_id = |e: &&Element| is_tracked(&e.tag) && e.find(&self.text, "id").is_none();
        let insertion = |(e, element): (ElementId, &Element)| {
            let at = element.qname.end;
            lacks_id(&element).then(|| (at..at, format!(" id=\"{}\"", escape(&self.display_name(e)))))
        };
        let mut insertions: Vec<_> = self.elements.iter().enumerate().filter_map(insertion).collect();
        // Elements from the same entity share their positions.
        insertions.dedup_by_key(|(at, _)| at.start);
        splice(&self.text, insertions)
    }

    pub(crate) fn has_css(&self) -> bool {
        !self.css.trim().is_empty()
    }

    /// Returns `true` if a style sheet declares a property.
    pub(crate) fn css_declares(&self, property: &str) -> bool {
        self.declared.contains(property)
    }

    /// The namespace prefix of SVG elements with its colon; usually empty.
    pub(crate) fn prefix(&self) -> &str {
        let Some(root) = self.elements.first() else { return "" };
        let name = self.text.get(root.qname.clone()).unwrap_or("");
        name.find(':').map_or("", |i| &name[..=i])
    }

    /// The text with a temporary id for every element that usvg tracks and that has no unique id, and with `styles` appended to style
    /// attributes; `None` if that changes nothing. Also returns the temporary ids.
    pub(crate) fn instrumented(&self, styles: impl Iterator<Item = (ElementId, String)>) -> (Option<String>, Marks) {
        let mut marks = Marks { stem: stem(&self.text), elements: Vec::new() };
        let links = links(&self.text);
        let mut patches: Vec<(Range<usize>, String)> = Vec::new();
        for (i, e) in self.elements.iter().enumerate() {
            if !is_tracked(&e.tag) {
                continue;
            }
            let id: Option<&Attr> = e.id_attr(&self.text);
            let value = id.map(|a| a.value(&self.text));
            let is_shared = |id: &str| self.by_id().get(id).is_some_and(|v| v.len() > 1);
            // A shared id stays if something may refer to it.
            if value.is_none_or(|id| id.is_empty() || (is_shared(&id) && !links.contains(&*id))) {
                let temporary = format!("{}{i}", marks.stem);
                patches.push(match id {
                    Some(a) => (a.value_range.clone(), temporary),
                    None => (e.qname.end..e.qname.end, format!(" id=\"{temporary}\"")),
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
        // usvg reads a stand-in instead of a mesh gradient, which it does not know.
        patches.extend(self.elements.iter().filter(|e| mesh::is_mesh(&e.tag)).filter_map(|e| {
            let id = e.attr(&self.text, "id").filter(|id| self.meshes.contains_key(&**id))?;
            Some((e.range.start..e.range.start, mesh::stand_in(self.prefix(), &id)))
        }));
        if patches.is_empty() {
            return (None, marks);
        }
        patches.sort_by_key(|(at, _)| at.start);
        (Some(splice(&self.text, patches)), marks)
    }
}

/// Parses a drawing, resolves it into plain SVG, and calls `then` with the result, its tree, and `true` if entities that hold elements were
/// expanded. Undeclared prefixes are declared and added to `undeclared`; if that is `None`, they are an error.
pub(super) fn to_plain<T>(
    mut text: String,
    name: &str,
    budget: &Budget,
    mut undeclared: Option<&mut Vec<String>>,
    linked: Linked<'_>,
    then: impl FnOnce(Plain, &roxmltree::Document<'_>, bool) -> Result<T, Error>,
) -> Result<T, Error> {
    xml::check(&text, name, budget)?;
    loop {
        let expanded = xml::with_elements_of_entities(&text);
        let why = match xml::document(expanded.as_deref().unwrap_or(&text)) {
            Ok(doc) => {
                let mut plain = resolve(&doc, budget, linked).map_err(|e| Error::limit(name, "its style takes", e))?;
                let Some(new) = plain.text.take() else { return then(plain, &doc, expanded.is_some()) };
                drop(doc);
                return then(plain, &xml::parse_checked(&new, name)?, expanded.is_some());
            }
            Err(why) => why,
        };
        let added = undeclared.as_mut().filter(|added| added.len() < MAX_PREFIXES);
        if let (roxmltree::Error::UnknownNamespace(prefix, _), Some(added)) = (&why, added)
            && let Some(declared) = with_prefix(&text, prefix)
        {
            added.push(prefix.clone());
            text = declared;
            continue;
        }
        xml::parse_checked(&text, name)?;
        return Err(Error::input(name, why.to_string()));
    }
}

/// The elements with a temporary id, which is the stem followed by the element's index.
#[derive(Debug, Default, Clone)]
pub(crate) struct Marks {
    stem: String,
    /// In document order.
    pub(crate) elements: Vec<ElementId>,
}

/// Finds a prefix that occurs nowhere in the text.
fn stem(text: &str) -> String {
    let mut stem = "warp-".to_owned();
    while text.contains(&stem) {
        stem.push('x');
    }
    stem
}

/// Collects the ids in all that looks like a reference. False positives do no harm.
pub(crate) fn links(text: &str) -> HashSet<&str> {
    let is_end = |c: char| !(c.is_alphanumeric() || "-_.:".contains(c));
    let rests = text.match_indices('#').map(|(i, _)| &text[i + 1..]);
    rests.map(|rest| rest.split(is_end).next().unwrap_or_default()).collect()
}

/// Prefixes that Inkscape knows without a declaration.
const KNOWN_PREFIXES: [(&str, &str); 8] = [
    ("inkscape", INKSCAPE),
    ("sodipodi", "http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd"),
    ("svg", SVG),
    ("xlink", XLINK),
    ("rdf", "http://www.w3.org/1999/02/22-rdf-syntax-ns#"),
    ("cc", "http://creativecommons.org/ns#"),
    ("dc", "http://purl.org/dc/elements/1.1/"),
    ("xhtml", "http://www.w3.org/1999/xhtml"),
];

/// Declares a prefix in the root element. Returns `None` if the root element cannot be found.
fn with_prefix(text: &str, prefix: &str) -> Option<String> {
    let known = KNOWN_PREFIXES.iter().find(|k| k.0 == prefix).map(|k| k.1.to_owned());
    let uri = known.unwrap_or_else(|| format!("urn:undeclared:{prefix}"));
    let (before, after) = text.split_at_checked(root_name_end(text)?)?;
    Some(format!("{before} xmlns:{prefix}=\"{uri}\"{after}"))
}

/// The position after the name in the first opening tag.
fn root_name_end(text: &str) -> Option<usize> {
    let mut at = 0;
    loop {
        at += text.get(at..)?.find('<')?;
        let rest = text.get(at..)?;
        at += match rest.as_bytes().get(1)? {
            b'?' => rest.find("?>")?,
            b'!' if rest.starts_with("<!--") => rest.find("-->")?,
            b'!' => doctype_end(rest)?,
            _ => return Some(at + rest.find(|c: char| c.is_ascii_whitespace() || matches!(c, '/' | '>'))?),
        };
    }
}

/// The position of the `>` that ends a DOCTYPE, with or without a subset.
fn doctype_end(text: &str) -> Option<usize> {
    let close = text.find('>')?;
    match text.find('[').filter(|&open| open < close) {
        Some(open) => {
            let end = open + text.get(open..)?.find(']')?;
            Some(end + text.get(end..)?.find('>')?)
        }
        None => Some(close),
    }
}

/// Outlines by element, once they have been read.
type Ahead = Arc<OnceLock<HashMap<ElementId, Arc<Outline>>>>;

/// Length of a text in bytes from which reading outlines takes longer than starting threads.
pub(crate) const WORTH_THREADS: usize = 200_000;

/// Reads the outlines of all `path` elements.
fn read_outlines(text: &str, elements: &[Element]) -> HashMap<ElementId, Arc<Outline>> {
    let paths: Vec<ElementId> = (0..elements.len()).filter(|e| elements[*e].tag == "path").collect();
    let outline = |i: usize| {
        let d = elements[paths[i]].attr(text, "d")?;
        Some((paths[i], Arc::new(Outline::from_svg_lossy(&d))))
    };
    map_parallel(paths.len(), outline).into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> SourceText {
        SourceText::from_plain(&xml::document(text).unwrap(), Plain::default(), "t").unwrap()
    }

    #[test]
    fn positions_are_found() {
        let s = parsed("<svg xmlns='http://www.w3.org/2000/svg'>\n <rect  x = '1' id='a'/><g a='>'>t</g></svg>");
        let r = &s.elements[1];
        assert_eq!(&s.text[r.range.clone()], "<rect  x = '1' id='a'/>");
        assert_eq!(&s.text[r.find(&s.text, "x").unwrap().value_range.clone()], "1");
        assert!(r.close.is_none());
        let g = &s.elements[2];
        assert_eq!(&s.text[g.open_end..g.close.clone().unwrap().start], "t");
        assert_eq!(s.line_column(r.range.start), (2, 2));
    }

    #[test]
    fn temporary_ids_leave_the_rest_alone() {
        let drawings = [
            "<svg xmlns='http://www.w3.org/2000/svg'><path/><g id='q'><path id=''/></g></svg>",
            "<?xml version='1.0'?>\n<!DOCTYPE svg>\n<!-- <path> --><s:svg xmlns:s='http://www.w3.org/2000/svg' a='>'\n><s:g\n/>\
         <s:path xml:id = \"a\" d='M0,0'/><s:style type='text/x'><![CDATA[ <g> .b{} ]]></s:style><s:title>t &amp; u</s:title></s:svg >",
            "<svg xmlns='http://www.w3.org/2000/svg' xmlns:i='http://www.inkscape.org/namespaces/inkscape'>\
         <g id='a' i:label='&lt;'><path id='a' d='M0,0\n1,1'/></g><rect id='longer than warp-5' x='1'/><rect \
         id='longer than warp-5' y='2'/><use href='#a'/><text><tspan id='c'>warp-</tspan></text><svg/></svg>",
        ];
        for d in drawings {
            let direct = parsed(d);
            let wanted = direct.instrumented(std::iter::empty()).0.unwrap();
            let (source, n) =
                SourceText::read(d.to_owned(), "t", &Budget::default(), &|_| None, |_, doc| Ok(doc.input_text().len()))
                    .unwrap();
            assert_eq!((n, &source.text), (wanted.len(), &direct.text));
            assert_eq!(format!("{:?}", source.elements), format!("{:?}", direct.elements));
            for e in &source.elements {
                assert!(d[e.range.start..].starts_with(&format!("<{}", &d[e.qname.clone()])));
                assert_eq!(&d[e.open_end - 1..e.open_end], ">");
                assert!(e.attrs.iter().all(|a| d[a.range.clone()].contains(&d[a.value_range.clone()])));
            }
        }
        let (text, ids) = {
            let (s, text) = SourceText::read(drawings[0].to_owned(), "t", &Budget::default(), &|_| None, |_, doc| {
                Ok(doc.input_text().to_owned())
            })
            .unwrap();
            (text, s.by_tree_id().clone())
        };
        assert_eq!(
            text,
            "<svg id=\"warp-0\" xmlns='http://www.w3.org/2000/svg'><path id=\"warp-1\"/><g id='q'><path id='warp-3'/></g></svg>"
        );
        assert_eq!((&ids["q"], &ids["warp-3"]), (&vec![2], &vec![3]));
    }

    #[test]
    fn the_root_declares_the_prefix() {
        let cases = [
            ("<svg/>", "<svg xmlns:cc=\"http://creativecommons.org/ns#\"/>"),
            (
                "<?xml version='1.0'?><!-- <a> --><!DOCTYPE svg [<!ENTITY a 'b'>]>\n<s:svg\n>",
                "<s:svg xmlns:cc=\"http://",
            ),
        ];
        for (text, wanted) in cases {
            let found = with_prefix(text, "cc").unwrap();
            assert!(found.contains(wanted), "{found}");
        }
        assert!(with_prefix("<svg>", "figma").unwrap().contains("xmlns:figma=\"urn:undeclared:figma\""));
        assert_eq!(with_prefix("<!-- ", "cc"), None);
    }
}
