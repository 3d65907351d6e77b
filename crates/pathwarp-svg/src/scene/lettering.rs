//! Finds the lettering in a drawing: lines with their baselines and letters.
//!
//! It comes from two sources: text (by usvg's layout), and outlines with data attributes, as
//! [`write_lettering`](crate::engine::write_lettering) writes them:
//!
//! ```xml
//! <g data-ascent="57" data-descent="16" data-cap-height="38" data-x-height="29">
//!   <g data-baseline="20 80 220 80">
//!     <path aria-label="W" data-glyph="20 80 51.5" d="…"/>
//!   </g>
//! </g>
//! ```
//!
//! `data-baseline` holds the line's start and end, and `data-glyph` a letter's origin on the baseline and its advance. The other
//! attributes are heights from the baseline. All are in the element's user units.

use super::geometry::{GeometryReader, from_usvg};
use super::model::{Part, PartRole, PlacedText, Scene};
use crate::source::elements::{Attr, ElementId, Namespace};
use crate::source::read::ReadOptions;
use crate::source::text::SourceText;
use crate::source::tree;
use pathwarp::kurbo::{Affine, Point, Vec2};
use pathwarp::param::Letter;
use pathwarp::{Error, Outline};
use pathwarp_reader::xml;
use skrifa::MetadataProvider;
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlinePen};
use std::borrow::Cow;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use usvg::layout::{PositionedGlyph, Span};
use usvg::{Color, Fill, Node, Paint, tiny_skia_path as ts};

/// Finds all lines of a drawing: first the lines of texts in painting order, then the lines of outlines.
pub(super) fn lines(tree: &usvg::Tree, reader: &GeometryReader<'_>, scene: &Scene) -> Vec<TextLine> {
    let mut out = Vec::new();
    let texts = if scene.texts.is_empty() { HashMap::new() } else { texts_by_address(tree) };
    for PlacedText { text, owner, frame, first } in &scene.texts {
        if let Some(text) = texts.get(text) {
            let lines = shaped_lines(text, tree.fontdb(), *frame, &scene.parts, *first);
            out.extend(lines.into_iter().map(|l| TextLine { owner: *owner, ..l }));
        }
    }
    out.extend(marked_lines(reader, scene));
    out
}

/// A letter with the subpaths that draw it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PlacedLetter {
    pub(crate) name: String,
    /// In root user space.
    pub(crate) origin: Point,
    pub(crate) advance: f64,
    /// Parts, with the range of their subpaths.
    pub(crate) subpaths: Vec<(usize, Range<usize>)>,
}

impl PlacedLetter {
    /// The letter for deformations, with an outline.
    pub(crate) fn with_outline(&self, outline: Outline) -> Letter {
        Letter { name: self.name.clone(), origin: self.origin, advance: self.advance, outline }
    }
}

/// Heights of a line's font above the baseline, and its descent below it, in the line's user units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Heights {
    pub(crate) ascent: f64,
    pub(crate) descent: f64,
    pub(crate) cap_height: f64,
    pub(crate) x_height: f64,
}

impl From<[f64; 4]> for Heights {
    /// Ascent, descent, height of capitals and of lower-case letters.
    fn from([ascent, descent, cap_height, x_height]: [f64; 4]) -> Self {
        Self { ascent, descent, cap_height, x_height }
    }
}

/// A line of lettering, in root user space.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TextLine {
    /// Name for messages.
    pub(crate) name: String,
    /// The element of the whole text, if any.
    pub(crate) owner: Option<ElementId>,
    pub(crate) start: Point,
    pub(crate) end: Point,
    /// In root user units.
    pub(crate) heights: Heights,
    /// `true` if the baseline is horizontal and runs to the right, with upright letters.
    pub(crate) is_level: bool,
    pub(crate) letters: Vec<PlacedLetter>,
}

impl TextLine {
    /// Makes a line without letters between two points of a user space that `frame` maps to root user space. `straight` is
    /// `false` for text on a path.
    pub(crate) fn new(name: String, from: Point, to: Point, heights: Heights, frame: Affine, straight: bool) -> Self {
        /// Largest slope that single-precision rounding can give a horizontal line.
        const TILT: f64 = 1e-5;
        let (start, end) = (frame * from, frame * to);
        let [a, b, c, d, ..] = frame.as_coeffs();
        let Heights { ascent, descent, cap_height, x_height } = heights;
        let heights = [ascent, descent, cap_height, x_height].map(|h| (Vec2::new(-c, -d) * h).hypot()).into();
        let run = end.x - start.x;
        let is_level = straight && d > 0.0 && run > 0.0 && (end.y - start.y).abs() <= TILT * run && b.abs() <= TILT * a;
        Self { name, owner: None, start, end, heights, is_level, letters: Vec::new() }
    }
}

/// All texts of a drawing and of the drawings shown in it as images, by address. Nesting takes no stack.
fn texts_by_address(tree: &usvg::Tree) -> HashMap<usize, &usvg::Text> {
    let mut out = HashMap::new();
    let mut groups = vec![tree.root()];
    while let Some(group) = groups.pop() {
        for node in group.children() {
            match node {
                Node::Group(g) => groups.push(g),
                Node::Text(t) => {
                    out.insert(std::ptr::from_ref::<usvg::Text>(t) as usize, &**t);
                }
                Node::Image(i) => {
                    if let usvg::ImageKind::SVG(tree) = i.kind() {
                        groups.push(tree.root());
                    }
                }
                Node::Path(_) => {}
            }
        }
    }
    out
}

/// Least distance of the baselines of different lines, in font sizes. Closer baselines are those of raised or lowered letters.
const ANOTHER_LINE: f64 = 0.5;

/// A glyph of a text, with lengths in the text's user units.
struct Glyph {
    text: String,
    origin: Point,
    advance: f64,
    size: f64,
    heights: Heights,
    /// Index of the part that draws it, with the range of its subpaths.
    part: usize,
    range: Range<usize>,
    /// Centre of the outline's box in x.
    centre: f64,
    /// `true` if it is rotated or mirrored.
    is_turned: bool,
}

/// Finds the lines of a text whose parts are `parts[first..]`. `frame` maps the text to root user space.
fn shaped_lines(
    text: &usvg::Text,
    fonts: &usvg::fontdb::Database,
    frame: Affine,
    parts: &[Part],
    first: usize,
) -> Vec<TextLine> {
    let Some(glyphs) = glyphs(text, fonts, parts, first) else { return Vec::new() };
    let straight = text.chunks().iter().all(|c| matches!(c.text_flow(), usvg::TextFlow::Linear))
        && text.writing_mode() == usvg::WritingMode::LeftToRight;
    let mut rows: Vec<Vec<Glyph>> = Vec::new();
    for g in glyphs {
        let is_near = |f: &Glyph| (f.origin.y - g.origin.y).abs() < ANOTHER_LINE * f.size.max(g.size);
        match rows.last_mut().filter(|row| !straight || row.first().is_some_and(is_near)) {
            Some(row) => row.push(g),
            None => rows.push(vec![g]),
        }
    }
    rows.into_iter().filter_map(|row| shaped_line(row, frame, straight)).collect()
}

/// Makes a line of a row of glyphs. Returns `None` if none of them has an advance.
fn shaped_line(row: Vec<Glyph>, frame: Affine, straight: bool) -> Option<TextLine> {
    let (wide, marks): (Vec<Glyph>, Vec<Glyph>) = row.into_iter().partition(|g| g.advance > 0.0);
    // The line's baseline is the one with the largest total advance; raised letters keep their height above it.
    let length = |y: f64| wide.iter().filter(|g| g.origin.y == y).map(|g| g.advance).sum::<f64>();
    let y = wide.iter().map(|g| g.origin.y).max_by(|a, b| length(*a).total_cmp(&length(*b)))?;
    let from = wide.iter().map(|g| g.origin.x).fold(f64::INFINITY, f64::min);
    let to = wide.iter().map(|g| g.origin.x + g.advance).fold(f64::NEG_INFINITY, f64::max);
    let largest = wide.iter().max_by(|a, b| a.size.total_cmp(&b.size))?;
    let straight = straight && !wide.iter().any(|g| g.is_turned);
    let name: String = wide.iter().map(|g| g.text.as_str()).collect();
    let mut line = TextLine::new(name, Point::new(from, y), Point::new(to, y), largest.heights, frame, straight);
    let middles: Vec<f64> = wide.iter().map(|g| g.origin.x + 0.5 * g.advance).collect();
    let stretch = (frame * Point::new(1.0, 0.0) - frame * Point::ORIGIN).hypot();
    line.letters = wide
        .into_iter()
        .map(|g| PlacedLetter {
            name: g.text,
            // Raised letters have their origin on the baseline, too.
            origin: frame * Point::new(g.origin.x, y),
            advance: g.advance * stretch,
            subpaths: vec![(g.part, g.range)],
        })
        .collect();
    // Marks without an advance belong to the nearest letter.
    for m in marks {
        let distance = |i: &usize| (middles[*i] - m.centre).abs();
        if let Some(nearest) = (0..middles.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))) {
            line.letters[nearest].subpaths.push((m.part, m.range));
        }
    }
    Some(line)
}

/// Lists the glyphs that have an outline. Returns `None` if their outlines are not the text's paths.
fn glyphs(text: &usvg::Text, fonts: &usvg::fontdb::Database, parts: &[Part], first: usize) -> Option<Vec<Glyph>> {
    let mut out = Vec::new();
    let mut part = first;
    for span in text.layouted() {
        // usvg draws lines over and under the letters before them, and a line through them last.
        part += usize::from(span.overline.is_some()) + usize::from(span.underline.is_some());
        let mut taken = 0;
        for g in &span.positioned_glyphs {
            let Some((outline, metrics)) = draw_glyph(g, span, fonts) else { continue };
            let range = taken..taken + outline.subpaths.len();
            if parts.get(part)?.local.subpaths.get(range.clone())? != outline.subpaths {
                return None;
            }
            taken = range.end;
            let t = g.transform();
            let size = f64::from(g.font_size());
            out.push(Glyph {
                text: g.text.clone(),
                origin: Point::new(f64::from(t.tx), f64::from(t.ty)),
                advance: f64::from(t.sx).hypot(f64::from(t.ky)) * metrics.advance,
                size,
                heights: metrics.heights,
                part,
                range,
                centre: outline.bounding_box().map_or(f64::from(t.tx), |b| b.center().x),
                is_turned: t.ky != 0.0 || t.sx <= 0.0,
            });
        }
        if taken > 0 {
            if parts.get(part)?.local.subpaths.len() != taken {
                return None;
            }
            part += 1;
        }
        part += usize::from(span.line_through.is_some());
    }
    Some(out)
}

/// Metrics of a glyph and its font.
struct Metrics {
    /// In font units.
    advance: f64,
    /// In the text's user units.
    heights: Heights,
}

/// The outline of a glyph as usvg draws it, with its metrics. Returns `None` if it has no outline, such as a space.
fn draw_glyph(g: &PositionedGlyph, span: &Span, fonts: &usvg::fontdb::Database) -> Option<(Outline, Metrics)> {
    fonts.with_face_data(g.font, |data, index| {
        let font = skrifa::FontRef::from_index(data, index).ok()?;
        let axes = font.axes();
        let set = span.variations.iter().map(|v| (skrifa::Tag::from_be_bytes(v.tag), v.value));
        let mut set: Vec<(skrifa::Tag, f32)> = set.collect();
        // The optical size defaults to the font size.
        let optical = skrifa::Tag::new(b"opsz");
        if span.font_optical_sizing == usvg::FontOpticalSizing::Auto
            && axes.get_by_tag(optical).is_some()
            && !set.iter().any(|(tag, _)| *tag == optical)
        {
            set.push((optical, g.font_size()));
        }
        let location = axes.location(set);
        let mut pen = Pen(ts::PathBuilder::new());
        let id: skrifa::GlyphId = g.id.into();
        let glyph = font.outline_glyphs().get(id)?;
        glyph.draw(DrawSettings::unhinted(Size::unscaled(), &location), &mut pen).ok()?;
        let path = pen.0.finish()?.transform(g.outline_transform())?;
        let metrics = font.metrics(Size::unscaled(), LocationRef::from(&location));
        let glyphs = font.glyph_metrics(Size::unscaled(), LocationRef::from(&location));
        let height = |c: char| font.charmap().map(c).and_then(|id| glyphs.bounds(id)).map(|b| b.y_max);
        let per_unit = f64::from(g.font_size()) / f64::from(metrics.units_per_em.max(1));
        let cap_height = metrics.cap_height.filter(|h| *h > 0.0).or_else(|| height('H'));
        let x_height = metrics.x_height.filter(|h| *h > 0.0).or_else(|| height('x'));
        let heights = [Some(metrics.ascent), Some(metrics.descent), cap_height, x_height];
        let heights = heights.map(|h| h.map_or(0.0, |h| f64::from(h).abs() * per_unit)).into();
        Some((from_usvg(&path), Metrics { advance: f64::from(glyphs.advance_width(id)?), heights }))
    })?
}

/// Draws glyphs as usvg's paths.
struct Pen(ts::PathBuilder);

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to(x, y);
    }

    fn quad_to(&mut self, cx0: f32, cy0: f32, x: f32, y: f32) {
        self.0.quad_to(cx0, cy0, x, y);
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        self.0.cubic_to(cx0, cy0, cx1, cy1, x, y);
    }

    fn close(&mut self) {
        self.0.close();
    }
}

/// Reads the lines of `<g data-baseline>` elements. A letter belongs to the innermost one.
fn marked_lines(reader: &GeometryReader<'_>, scene: &Scene) -> Vec<TextLine> {
    let source = reader.source;
    let mut out: BTreeMap<ElementId, TextLine> = BTreeMap::new();
    for e in 0..source.elements.len() {
        let Some(letter) = marked_letter(reader, scene, e) else { continue };
        let mut above = source.ancestors(e);
        let Some((group, ends)) = above.find_map(|a| Some((a, numbers(reader, a, "data-baseline")?))) else { continue };
        match out.entry(group) {
            Entry::Occupied(mut line) => line.get_mut().letters.push(letter),
            Entry::Vacant(entry) => {
                if let Some(line) = marked_line(reader, group, ends) {
                    entry.insert(line).letters.push(letter);
                }
            }
        }
    }
    out.into_values().collect()
}

/// Reads the line of an element with the start and end of its baseline.
fn marked_line(reader: &GeometryReader<'_>, e: ElementId, [x0, y0, x1, y1]: [f64; 4]) -> Option<TextLine> {
    let source = reader.source;
    let frame = reader.transform_to_root(e)?;
    let label = source.ancestors(e).find_map(|a| source.attr(a, "aria-label"));
    let name = label.map_or_else(|| source.display_name(e), Cow::into_owned);
    let names = ["data-ascent", "data-descent", "data-cap-height", "data-x-height"];
    let height = |name| source.ancestors(e).find_map(|a| numbers(reader, a, name)).map_or(0.0, |[v]| v.abs());
    let heights = names.map(height).into();
    Some(TextLine::new(name, Point::new(x0, y0), Point::new(x1, y1), heights, frame, true))
}

/// Reads the letter of an element with the attribute `data-glyph`. Returns `None` for other elements, and if it is not painted.
fn marked_letter(reader: &GeometryReader<'_>, scene: &Scene, e: ElementId) -> Option<PlacedLetter> {
    let parts = &scene.parts;
    let [x, y, advance] = numbers(reader, e, "data-glyph")?;
    let is_painted = |i: &usize| parts[*i].role == PartRole::Paint && parts[*i].painted();
    let painted: Vec<usize> = scene.by_source.get(&e)?.iter().copied().filter(is_painted).collect();
    let frame = parts[*painted.first()?].frame;
    let [a, b, ..] = frame.as_coeffs();
    let label = reader.source.attr(e, "aria-label");
    Some(PlacedLetter {
        name: label.map_or_else(|| reader.source.display_name(e), Cow::into_owned),
        origin: frame * Point::new(x, y),
        advance: (Vec2::new(a, b) * advance).hypot(),
        subpaths: painted.into_iter().map(|i| (i, 0..parts[i].local.subpaths.len())).collect(),
    })
}

/// Parses an attribute of exactly `N` finite numbers.
fn numbers<const N: usize>(reader: &GeometryReader<'_>, e: ElementId, name: &str) -> Option<[f64; N]> {
    let text = reader.source.attr(e, name)?;
    let words = text.split([' ', ',', '\t', '\n', '\r']).filter(|w| !w.is_empty());
    let values: Option<Vec<f64>> = words.take(N + 1).map(|w| w.parse::<f64>().ok().filter(|v| v.is_finite())).collect();
    values?.try_into().ok()
}

/// The source element of each outline of a text, by the text's element.
pub(crate) type Owners = HashMap<ElementId, Vec<ElementId>>;

/// Finds the owners of all letters in texts that contain named elements, or elements whose colours depend on declarations elsewhere. For
/// this, usvg resolves the drawing again with a different colour for every element of these texts.
pub(crate) fn owners(source: &SourceText, name: &str, options: &ReadOptions) -> Result<Owners, Error> {
    let mut out = Owners::new();
    if source.unpatchable.is_some() {
        return Ok(out);
    }
    let texts = (0..source.elements.len()).filter(|&e| source.elements[e].tag == "text");
    let words = |e: ElementId| source.words.get(e);
    let depends = |e: ElementId| words(e).is_some_and(|words| words.depends());
    let is_themed = |t| text_content(source, t).any(|e| words(e) != words(t) && (depends(e) || depends(t)));
    let holds_name = |t| text_content(source, t).any(|e| is_named(source, e));
    let texts: Vec<ElementId> = texts.filter(|&t| is_themed(t) || holds_name(t)).collect();
    if texts.is_empty() {
        return Ok(out);
    }
    let elements = texts.iter().flat_map(|&t| std::iter::once(t).chain(text_content(source, t)));
    let styles = elements.filter_map(|e| Some((e, format!("fill:{};stroke:none", color_code(e)?))));
    let Some(painted) = source.instrumented(styles).0 else { return Ok(out) };
    let (tree, _) = tree::tree(&xml::parse_checked(&painted, name)?, name, &options.begin_again())?;
    collect_owners(tree.root(), source, &mut out);
    Ok(out)
}

/// Encodes an element's index as a colour. Returns `None` if it is too large.
fn color_code(e: ElementId) -> Option<String> {
    (e < 1 << 24).then(|| format!("#{e:06x}"))
}

/// Decodes an element's index from a colour.
fn coded_element(c: Color) -> ElementId {
    (usize::from(c.red) << 16) | (usize::from(c.green) << 8) | usize::from(c.blue)
}

/// Reads the owners of letters from the colours of the texts in a group.
fn collect_owners(g: &usvg::Group, source: &SourceText, out: &mut Owners) {
    for n in g.children() {
        match n {
            Node::Group(g) => collect_owners(g, source, out),
            Node::Text(t) => {
                let Some(&[text]) = source.by_tree_id().get(t.id()).map(Vec::as_slice) else { continue };
                let end = source.elements[text].range.end;
                let mut last = text;
                let owners = t.flattened().children().iter().map(|n| {
                    // Glyphs of a colour font belong to the element of their neighbours.
                    if let Node::Path(p) = n
                        && let Some(Paint::Color(c)) = p.fill().map(Fill::paint)
                        && (text..source.elements.len()).contains(&coded_element(*c))
                        && source.elements[coded_element(*c)].range.start < end
                    {
                        last = coded_element(*c);
                    }
                    last
                });
                out.insert(text, owners.collect());
            }
            Node::Path(_) | Node::Image(_) => {}
        }
    }
}

/// Lists the elements inside a text that hold letters.
pub(crate) fn text_content(source: &SourceText, text: ElementId) -> impl Iterator<Item = ElementId> + '_ {
    source.descendants(text).filter(|&e| matches!(source.elements[e].tag.as_ref(), "tspan" | "textPath" | "tref" | "a"))
}

/// Returns `true` if an attribute identifies an element: id, class, data and ARIA attributes, and Inkscape's.
pub(crate) fn is_naming(a: &Attr, text: &str) -> bool {
    let name = a.name(text);
    let plain = name == "id" || name == "class" || name.starts_with("data-") || name.starts_with("aria-");
    (plain && a.namespace == Namespace::None) || a.namespace == Namespace::Inkscape
}

/// Returns `true` if an element has a title or an identifying attribute.
pub(crate) fn is_named(source: &SourceText, e: ElementId) -> bool {
    let el = &source.elements[e];
    el.title.is_some() || el.attrs.iter().any(|a| is_naming(a, &source.text))
}
