//! Divides texts into pieces of one font and one script before they are drawn.
//!
//! If the font of a line lacks a letter, usvg shapes the whole line with another font, and gives up if that yields another number of
//! glyphs. It shapes all letters of one direction by the script of the first letter. Therefore, each text that needs several fonts or
//! scripts is rewritten: every piece is a `tspan` with a position, and with a name for its font that [`Chooser`] knows.
//!
//! A chunk is a stretch of a text that begins at a given position, and a span is a stretch of a chunk in one style.

use super::edit::splice;
use super::elements::{SVG, tag_end};
use super::faces::Look;
use super::fonts::{Chooser, PIECE, PieceFonts};
use super::shaping::{ShapingStyle, TextFont, shape_with_fallback};
use pathwarp_reader::xml::escape;
use pathwarp_text::{Run, Writing, runs};
use std::collections::{BTreeSet, HashMap};
use std::fmt::Write as _;
use std::ops::Range;
use std::sync::Arc;
use unicode_script::{Script, UnicodeScript as _};
use usvg::fontdb::{Database, ID};
use usvg::roxmltree::{Document, Node};
use usvg::{LengthAdjust, Text, TextAnchor, TextChunk, TextFlow, TextSpan, WritingMode};

/// A drawing with its texts in pieces.
pub(super) struct Divided {
    /// The drawing; `None` if it may stay as it is.
    pub(super) text: Option<String>,
    pub(super) fonts: Vec<PieceFonts>,
    pub(super) db: Arc<Database>,
    /// Letters that no font has, each with the text around it.
    pub(super) missing: BTreeSet<(String, String)>,
}

/// A cluster of letters in a chunk.
struct Letter {
    /// Bytes of the chunk.
    bytes: Range<usize>,
    /// Advance as shaped, in the text's user units.
    natural: f64,
    /// Advance with spacing, in the text's user units.
    advance: f64,
    /// Index of the part of the chunk.
    part: usize,
}

/// Part of a chunk in one font.
struct Part {
    /// Index of the chunk's span.
    span: usize,
    run: Run,
    /// The face, unless it is the span's.
    face: Option<ID>,
    /// `true` if its letters are drawn as small capitals.
    small: bool,
    /// `true` if no font has its letters.
    missing: bool,
}

/// Letters that are set together.
struct Piece {
    /// Indices among the characters of the text.
    chars: Range<usize>,
    /// Attributes of its `tspan`.
    attributes: String,
    /// `true` if its letters are written as capitals.
    small: bool,
    /// Invisible characters before and after its text, which determine the order of its letters.
    around: [&'static str; 2],
}

/// Divides the texts of a drawing into pieces, given usvg's tree of it.
pub(super) fn divided(xml: &Document<'_>, tree: &usvg::Tree, chooser: &Chooser) -> Divided {
    let mut out = Divided { text: None, fonts: Vec::new(), db: tree.fontdb().clone(), missing: BTreeSet::new() };
    let texts = xml.descendants().filter(|n| n.has_tag_name((SVG, "text")));
    let by_id: HashMap<&str, Node<'_, '_>> = texts.filter_map(|n| Some((n.attribute("id")?, n))).collect();
    let mut edits: Vec<(Range<usize>, String)> = Vec::new();
    let mut fonts: HashMap<(usvg::Font, String), Vec<TextFont>> = HashMap::new();
    each_text(tree.root(), &mut |text| {
        let Some(node) = by_id.get(text.id()) else { return };
        let mut divider = Divider { text, chooser, language: language(*node), fonts: &mut fonts, out: &mut out };
        let Some(pieces) = divider.pieces() else { return };
        let shown: Vec<char> = text.chunks().iter().flat_map(|c| c.text().chars()).collect();
        let mut writer = Writer {
            source: xml.input_text(),
            shown: &shown,
            next: 0,
            pieces: &pieces,
            rotate: text.rotate(),
            on_path: Vec::new(),
        };
        // Copies of a text share its element; the first one counts.
        let known = edits.iter().any(|(range, _)| *range == node.range());
        edits.extend(writer.element(*node).filter(|_| !known).map(|text| (node.range(), text)));
    });
    edits.sort_by_key(|(range, _)| range.start);
    out.text = (!edits.is_empty()).then(|| splice(xml.input_text(), edits));
    out
}

/// The language that an element or one around it declares; empty if none does.
fn language(node: Node<'_, '_>) -> String {
    let declared = |n: Node<'_, '_>| n.attributes().find(|a| a.name() == "lang").map(|a| a.value().to_owned());
    node.ancestors().find_map(declared).unwrap_or_default()
}

/// Visits all texts except the ones in images, which are separate drawings.
fn each_text(group: &usvg::Group, visit: &mut dyn FnMut(&Text)) {
    for node in group.children() {
        match node {
            usvg::Node::Group(g) => each_text(g, visit),
            usvg::Node::Text(t) => visit(t),
            _ => {}
        }
        if !matches!(node, usvg::Node::Image(_)) {
            node.subroots(|g| each_text(g, visit));
        }
    }
}

/// The drawing with an id for each text, by which [`divided`] finds it. Returns `None` if all texts have one.
pub(super) fn with_ids(xml: &Document<'_>) -> Option<String> {
    let source = xml.input_text();
    let lacks_id = |n: &Node<'_, '_>| n.has_tag_name((SVG, "text")) && n.attribute("id").is_none_or(str::is_empty);
    let insertion = |(i, node): (usize, Node<'_, '_>)| {
        let start = node.range().start;
        let at = start + source[start..].find(|c: char| c.is_whitespace() || c == '>' || c == '/')?;
        Some((at..at, format!(" id=\"{PIECE}text-{i}\"")))
    };
    let insertions: Vec<_> = xml.descendants().filter(lacks_id).enumerate().map(insertion).collect::<Option<_>>()?;
    (!insertions.is_empty()).then(|| splice(source, insertions))
}

/// Divides one text.
struct Divider<'a> {
    text: &'a Text,
    chooser: &'a Chooser,
    language: String,
    /// The fonts of texts, by their requested font and language.
    fonts: &'a mut HashMap<(usvg::Font, String), Vec<TextFont>>,
    out: &'a mut Divided,
}

/// The positions of the letters of a chunk. The line runs to the right, or down in vertical text.
struct Layout {
    /// The position of each letter along the line and across it.
    positions: Vec<(f64, f64)>,
    /// The start of the next chunk, along the line and across it.
    end: (f64, f64),
}

impl Divider<'_> {
    /// The pieces of the text, in the order of its characters. Returns `None` if usvg shapes it as a whole, or it cannot be divided.
    fn pieces(&mut self) -> Option<Vec<Piece>> {
        let text = self.text;
        let chunks: Vec<_> = text.chunks().iter().map(|c| self.parts(c)).collect();
        let note = |(chunk, (parts, letters)): (&TextChunk, &(Vec<Part>, Vec<Letter>))| {
            let lost = letters.iter().filter(|l| parts[l.part].missing).map(|l| &chunk.text()[l.bytes.clone()]);
            let lost: String = lost.collect();
            if !lost.is_empty() {
                self.out.missing.insert((lost, chunk.text().to_owned()));
            }
        };
        text.chunks().iter().zip(&chunks).for_each(note);
        let is_divided = |(chunk, (parts, _)): (&TextChunk, &(Vec<Part>, Vec<Letter>))| is_divided(chunk, parts);
        if !text.chunks().iter().zip(&chunks).any(is_divided) {
            return None;
        }
        let vertical = text.writing_mode() == WritingMode::TopToBottom;
        // The number of characters in the chunks before, and the end of the last chunk, unless it is on a path.
        let (mut out, mut offset, mut last) = (Vec::new(), 0, Some((0.0, 0.0)));
        for (chunk, (parts, mut letters)) in text.chunks().iter().zip(chunks) {
            let on_path = matches!(chunk.text_flow(), TextFlow::Path(_));
            if on_path && vertical {
                return None;
            }
            let count = chunk.text().chars().count();
            let given = (chunk.x().map(f64::from), chunk.y().map(f64::from));
            let start = match (on_path, given) {
                (true, _) => (given.0.unwrap_or(0.0), 0.0),
                (false, (Some(x), Some(y))) => (x, y),
                (false, (x, y)) => (x.unwrap_or(last?.0), y.unwrap_or(last?.1)),
            };
            add_spacing(chunk, &mut letters);
            if let Some(layout) = self.layout(chunk, &letters, offset, vertical) {
                let place = |(along, across): (f64, f64)| match (on_path, vertical) {
                    (true, _) => (start.0 + along, across),
                    (false, true) => (start.0 - across, start.1 + along),
                    (false, false) => (start.0 + along, start.1 + across),
                };
                self.cut(chunk, &parts, &letters, &layout, &place, offset, &mut out);
                last = (!on_path).then(|| place(layout.end));
            }
            offset += count;
        }
        out.sort_by_key(|p: &Piece| p.chars.start);
        Some(out)
    }

    /// The parts and letters of a chunk, from left to right.
    fn parts(&mut self, chunk: &TextChunk) -> (Vec<Part>, Vec<Letter>) {
        let (mut parts, mut letters) = (Vec::new(), Vec::new());
        for run in runs(chunk.text()) {
            let mut stretches: Vec<(usize, Range<usize>)> = Vec::new();
            for (i, span) in chunk.spans().iter().enumerate() {
                let range = span.start().max(run.range.start)..span.end().min(run.range.end);
                match stretches.last_mut() {
                    _ if range.is_empty() => {}
                    Some((first, whole)) if sets_alike(&chunk.spans()[*first], span) => whole.end = range.end,
                    _ => stretches.push((i, range)),
                }
            }
            if run.rtl {
                stretches.reverse();
            }
            for (span, range) in stretches {
                let run = Run { range, ..run.clone() };
                self.shape(chunk, span, &run, &mut parts, &mut letters);
            }
        }
        (parts, letters)
    }

    /// Adds the parts and letters of a run in one span.
    fn shape(&mut self, chunk: &TextChunk, index: usize, run: &Run, parts: &mut Vec<Part>, letters: &mut Vec<Letter>) {
        let span = &chunk.spans()[index];
        let size = span.font_size().get();
        let mut variations: Vec<(String, f32)> =
            span.font().variations().iter().map(|v| (String::from_utf8_lossy(&v.tag).into_owned(), v.value)).collect();
        if span.font_optical_sizing() == usvg::FontOpticalSizing::Auto && !variations.iter().any(|v| v.0 == "opsz") {
            variations.push(("opsz".into(), size));
        }
        let features = [(span.small_caps(), "smcp=1"), (!span.apply_kerning(), "kern=0")];
        let features: Vec<&str> = features.into_iter().filter(|f| f.0).map(|f| f.1).collect();
        let language = self.language.clone();
        let features = features.join(",");
        let mut style = ShapingStyle { size: f64::from(size), features, variations, language: language.clone() };
        let db = &mut self.out.db;
        let fonts = self.fonts.entry((span.font().clone(), language)).or_insert_with(|| {
            let faces = self.chooser.candidates(span.font(), db);
            // `None`: for every writing.
            faces.into_iter().filter_map(|face| TextFont::of_face(face, None, db)).collect()
        });
        let look = Look::of_text(span.font());
        let is_small = span.small_caps() && fonts.first().is_some_and(|f| !f.has_small_capitals());
        // Stretches of letters with their bytes, and `true` for those drawn as small capitals.
        let mut stretches: Vec<(bool, Range<usize>)> = Vec::new();
        for (i, c) in chunk.text()[run.range.clone()].char_indices() {
            let (start, small) = (run.range.start + i, is_small && c.is_lowercase());
            match stretches.last_mut() {
                Some((same, stretch)) if *same == small => stretch.end = start + c.len_utf8(),
                _ => stretches.push((small, start..start + c.len_utf8())),
            }
        }
        if run.rtl {
            stretches.reverse();
        }
        for (small, range) in stretches {
            style.size = f64::from(size) * if small { SMALL_CAPITALS } else { 1.0 };
            let run = Run { range, ..run.clone() };
            // Capitals may have another number of bytes.
            let (capitals, origins) = if small { capitals(chunk.text(), &run.range) } else { Default::default() };
            let (line, range) = if small { (&*capitals, 0..capitals.len()) } else { (chunk.text(), run.range.clone()) };
            let shown = Run { range, ..run.clone() };
            let origin = |b: usize| if small { origins[b] } else { b };
            for found in shape_with_fallback(line, &shown, fonts, (&style, look), (self.chooser, db)) {
                let face = fonts[found.font].face.filter(|_| found.font > 0);
                let part = parts.len();
                letters.extend(found.clusters.into_iter().map(|(bytes, advance)| Letter {
                    bytes: origin(bytes.start)..origin(bytes.end),
                    natural: advance,
                    advance,
                    part,
                }));
                parts.push(Part { span: index, run: run.clone(), face, small, missing: found.missing });
            }
        }
    }

    /// Places the letters of a chunk as usvg does. Returns `None` if it has none.
    fn layout(&self, chunk: &TextChunk, letters: &[Letter], offset: usize, vertical: bool) -> Option<Layout> {
        let mut order: Vec<usize> = (0..letters.len()).collect();
        order.sort_by_key(|i| letters[*i].bytes.start);
        let (mut shifts, mut sum) = (vec![(0.0, 0.0); letters.len()], (0.0, 0.0));
        for &i in &order {
            let at = offset + chunk.text()[..letters[i].bytes.start].chars().count();
            let shift = |list: &[f32]| list.get(at).copied().map_or(0.0, f64::from);
            sum = (sum.0 + shift(self.text.dx()), sum.1 + shift(self.text.dy()));
            shifts[i] = if vertical { (sum.1, -sum.0) } else { sum };
        }
        let (first, last) = (*order.first()?, *order.last()?);
        let (mut left, mut right, mut advance) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
        let mut positions = Vec::new();
        for (letter, shift) in letters.iter().zip(&shifts) {
            let start = advance + shift.0;
            left = left.min(start.min(start + letter.advance));
            right = right.max(start.max(start + letter.advance));
            positions.push((start, shift.1));
            advance += letter.advance;
        }
        let anchored = |width: f64| match chunk.anchor() {
            TextAnchor::Start => 0.0,
            TextAnchor::Middle => -0.5 * width,
            TextAnchor::End => -width,
        };
        let before = match chunk.text_flow() {
            TextFlow::Linear => shifts[first].0 - left + anchored(right - left),
            TextFlow::Path(_) => anchored(advance),
        };
        positions.iter_mut().for_each(|p| p.0 += before);
        Some(Layout { positions, end: (before + advance + shifts[last].0, shifts[last].1) })
    }

    /// Cuts a chunk into pieces. `place` maps a position along and across the line to coordinates, and `offset` is the number of characters
    /// before the chunk.
    #[expect(clippy::too_many_arguments, reason = "the properties of one chunk")]
    fn cut(
        &mut self,
        chunk: &TextChunk,
        parts: &[Part],
        letters: &[Letter],
        layout: &Layout,
        place: &dyn Fn((f64, f64)) -> (f64, f64),
        offset: usize,
        out: &mut Vec<Piece>,
    ) {
        let shift = |i: usize| {
            let before: f64 = letters[..i].iter().map(|l| l.advance).sum();
            (layout.positions[i].0 - before, layout.positions[i].1)
        };
        let near = |a: (f64, f64), b: (f64, f64)| (a.0 - b.0).abs() < 1e-6 && (a.1 - b.1).abs() < 1e-6;
        let mut start = 0;
        for end in 1..=letters.len() {
            let part = &parts[letters[start].part];
            let mark = direction_mark(&chunk.text()[part.run.range.clone()], part.run.rtl);
            let span = &chunk.spans()[part.span];
            // Spacing would add to the mark, too, so each letter is placed by itself.
            let is_apart = !mark.is_empty() && (span.letter_spacing() != 0.0 || span.text_length().is_some());
            let goes_on =
                |next: &Letter| next.part == letters[start].part && near(shift(end), shift(start)) && !is_apart;
            if letters.get(end).is_some_and(goes_on) {
                continue;
            }
            let group = &letters[start..end];
            let bytes = group.iter().map(|l| l.bytes.start).min().unwrap_or(0)
                ..group.iter().map(|l| l.bytes.end).max().unwrap_or(0);
            let chars = |b: usize| offset + chunk.text()[..b].chars().count();
            let (x, y) = place(layout.positions[start]);
            let mut attributes = match chunk.text_flow() {
                TextFlow::Linear => format!(" x=\"{x}\" y=\"{y}\""),
                TextFlow::Path(_) if y == 0.0 => format!(" x=\"{x}\""),
                TextFlow::Path(_) => format!(" x=\"{x}\" dy=\"{y}\""),
            };
            attributes += &self.style(span, part, group, is_apart);
            // usvg adds no letter spacing after the last letter, which would cut an underline short; an invisible character gets it.
            let around = match part.run.rtl {
                // The mark at the end keeps white space in the direction of the line.
                true if !mark.is_empty() => [mark, "\u{200f}"],
                _ if span.letter_spacing() == 0.0 || is_apart => [mark, ""],
                true => ["\u{200f}", ""],
                false => ["", "\u{200e}"],
            };
            out.push(Piece { chars: chars(bytes.start)..chars(bytes.end), attributes, small: part.small, around });
            start = end;
        }
    }

    /// The attributes of a piece except its position. `is_apart` is `true` for a piece of one letter, placed without spacing.
    fn style(&mut self, span: &TextSpan, part: &Part, letters: &[Letter], is_apart: bool) -> String {
        let mut style = " style=\"text-anchor:start".to_owned();
        if let Some(face) = part.face
            && let Some(n) = self.font(span, face, part.run.writing)
        {
            let _ = write!(style, ";font-family:{PIECE}{n}");
        }
        if is_apart {
            style += ";letter-spacing:0";
        }
        if part.small {
            let _ = write!(style, ";font-size:{}px", f64::from(span.font_size().get()) * SMALL_CAPITALS);
        }
        style.push('"');
        let natural: f64 = letters.iter().map(|l| l.natural).sum();
        let advance: f64 = letters.iter().map(|l| l.advance).sum();
        let is_ignored = ignores_spacing(part.run.writing) && span.letter_spacing() != 0.0;
        match (span.text_length(), span.length_adjust()) {
            (length, LengthAdjust::Spacing) if (length.is_some() || is_ignored) && !is_apart && letters.len() > 1 => {
                let after_last = letters.last().map_or(0.0, |l| l.advance - l.natural);
                let _ = write!(style, " textLength=\"{}\"", advance - after_last);
            }
            (Some(_), LengthAdjust::SpacingAndGlyphs) if natural > 0.0 => {
                let _ = write!(style, " textLength=\"{advance}\" lengthAdjust=\"spacingAndGlyphs\"");
            }
            _ => {}
        }
        style
    }

    /// The index in [`Divided::fonts`] of a piece's fonts: a copy of the text's face, from which usvg takes the heights, and the `face`
    /// that draws the letters. By the copy's own id, [`Chooser`] finds the other one.
    fn font(&mut self, span: &TextSpan, face: ID, writing: Writing) -> Option<usize> {
        let first = self.fonts.get(&(span.font().clone(), self.language.clone()))?.first()?.face?;
        // A font without colours may have letters for emoji, so usvg must not look into it.
        let for_heights = if writing == Writing::Emoji { face } else { first };
        let db = Arc::make_mut(&mut self.out.db);
        let info = db.face(for_heights)?.clone();
        let known = self.out.fonts.iter().position(|(a, b)| {
            *b == face
                && db.face(*a).is_some_and(|a| a.post_script_name == info.post_script_name && a.index == info.index)
        });
        Some(known.unwrap_or_else(|| {
            self.out.fonts.push((db.push_face_info(info), face));
            self.out.fonts.len() - 1
        }))
    }
}

/// The size of synthetic small capitals as a fraction of the font size, as in browsers (CSS Fonts 4, section 6.6, leaves it open).
const SMALL_CAPITALS: f64 = 0.7;

/// Letters of a text as capitals, and the position in the text of each of their bytes and of the end.
fn capitals(text: &str, range: &Range<usize>) -> (String, Vec<usize>) {
    let (mut out, mut origins) = (String::new(), Vec::new());
    for (i, c) in text[range.clone()].char_indices() {
        out.extend(c.to_uppercase());
        origins.resize(out.len(), range.start + i);
    }
    origins.push(range.end);
    (out, origins)
}

/// Returns `true` if two spans are shaped together.
fn sets_alike(a: &TextSpan, b: &TextSpan) -> bool {
    let font = |s: &TextSpan| (s.font_size(), s.small_caps(), s.apply_kerning(), s.font_optical_sizing());
    let spacing = |s: &TextSpan| [Some(s.letter_spacing()), Some(s.word_spacing()), s.text_length()];
    font(a) == font(b) && spacing(a) == spacing(b) && a.font() == b.font()
}

/// Returns `true` if usvg would shape a chunk differently from its parts.
fn is_divided(chunk: &TextChunk, parts: &[Part]) -> bool {
    let lacks_spacing = |p: &Part| ignores_spacing(p.run.writing) && chunk.spans()[p.span].letter_spacing() != 0.0;
    // A shaper may take plain writings, whose letters do not join, for one.
    let mixed = |a: &Part, b: &Part| {
        let (x, y) = (&a.run, &b.run);
        x.level_run == y.level_run && x.writing != y.writing && !(x.writing.is_plain() && y.writing.is_plain())
    };
    parts.iter().any(|p| p.face.is_some() || p.small || lacks_spacing(p))
        || parts.windows(2).any(|w| mixed(&w[0], &w[1]))
}

/// Adds the spacing of a chunk to its letters, as usvg does.
fn add_spacing(chunk: &TextChunk, letters: &mut [Letter]) {
    let count = letters.len();
    let span = |at: usize| chunk.spans().iter().find(|s| (s.start()..s.end()).contains(&at));
    for (i, l) in letters.iter_mut().enumerate() {
        let (Some(span), Some(c)) = (span(l.bytes.start), chunk.text()[l.bytes.start..].chars().next()) else {
            continue;
        };
        if i + 1 < count && takes_spacing(c.script()) {
            l.advance += f64::from(span.letter_spacing());
        }
        if matches!(c, ' ' | '\u{a0}' | '\u{1361}' | '\u{10100}' | '\u{10101}' | '\u{1039f}' | '\u{1091f}') {
            l.advance += f64::from(span.word_spacing());
        }
    }
    for span in chunk.spans() {
        let Some(target) = span.text_length().map(f64::from) else { continue };
        let is_in_span = |l: &&mut Letter| (span.start()..span.end()).contains(&l.bytes.start);
        let natural: Vec<f64> = letters.iter_mut().filter(is_in_span).map(|l| l.natural).collect();
        let (width, gaps) = (natural.iter().sum::<f64>(), natural.len().saturating_sub(1) as f64);
        for l in letters.iter_mut().filter(is_in_span) {
            l.advance = match span.length_adjust() {
                LengthAdjust::Spacing if gaps > 0.0 => l.natural + (target - width) / gaps,
                LengthAdjust::Spacing => l.natural,
                LengthAdjust::SpacingAndGlyphs => l.natural * target / width.max(f64::MIN_POSITIVE),
            };
        }
    }
}

/// Returns `true` if letter spacing applies to a script. As in browsers, it does not apply to scripts with joined letters.
fn takes_spacing(script: Script) -> bool {
    use Script as S;
    let joined =
        [S::Arabic, S::Syriac, S::Nko, S::Manichaean, S::Psalter_Pahlavi, S::Mandaic, S::Mongolian, S::Phags_Pa];
    !joined.contains(&script)
}

/// Returns `true` if usvg ignores letter spacing for a script, unlike browsers.
fn ignores_spacing(writing: Writing) -> bool {
    use Script as S;
    let scripts = [S::Devanagari, S::Bengali, S::Gurmukhi, S::Modi, S::Sharada, S::Syloti_Nagri, S::Tirhuta, S::Ogham];
    matches!(writing, Writing::Script(script) if scripts.contains(&script))
}

/// The direction mark before a piece whose letters would not run in one direction by themselves.
fn direction_mark(text: &str, rtl: bool) -> &'static str {
    let goes_left = |c: char| matches!(c, '\u{590}'..='\u{8ff}' | '\u{fb1d}'..='\u{fdff}' | '\u{fe70}'..='\u{fefc}' | '\u{10800}'..='\u{10fff}' | '\u{1e800}'..='\u{1efff}');
    match rtl {
        true if !text.chars().all(char::is_alphabetic) => "\u{202e}",
        false if text.chars().any(goes_left) => "\u{202d}",
        _ => "",
    }
}

/// Writes one text with its pieces.
struct Writer<'a> {
    source: &'a str,
    /// The characters that usvg shows.
    shown: &'a [char],
    /// Index of the next character.
    next: usize,
    pieces: &'a [Piece],
    /// Rotation of each character, in degrees.
    rotate: &'a [f32],
    /// Start and end tags of the elements from a `textPath` inwards. usvg puts only the first piece in a `textPath` on the path, so each
    /// piece gets a new one.
    on_path: Vec<(String, String)>,
}

impl Writer<'_> {
    /// Writes an element without its positions. Returns `None` if usvg shows other characters.
    fn element(&mut self, node: Node<'_, '_>) -> Option<String> {
        let whole = &self.source[node.range()];
        let tag = &whole[..tag_end(whole, 0, whole.len())?];
        if tag.ends_with("/>") {
            return None;
        }
        let mut out = String::new();
        let mut at = 0;
        let tag_start = node.range().start;
        for a in node.attributes().filter(|a| matches!(a.name(), "x" | "y" | "dx" | "dy" | "rotate" | "space")) {
            out += tag.get(at..a.range().start.checked_sub(tag_start)?)?;
            at = a.range().end.checked_sub(tag_start)?;
        }
        out += tag.get(at..)?.strip_suffix('>')?;
        out += if node.has_tag_name((SVG, "text")) { " xml:space=\"preserve\">" } else { ">" };
        let name = whole[1..].split(|c: char| c.is_whitespace() || c == '>' || c == '/').next()?;
        let end = format!("</{name}>");
        let is_on_path = node.tag_name().name() == "textPath" || !self.on_path.is_empty();
        if is_on_path {
            self.on_path.push((out.clone(), end.clone()));
        }
        for child in node.children() {
            if let Some(text) = child.text().filter(|_| child.is_text()) {
                out += &self.letters(text)?;
            } else if child.is_element() && matches!(child.tag_name().name(), "tspan" | "textPath" | "a") {
                out += &self.element(child)?;
            } else if child.has_tag_name((SVG, "tref")) {
                return None;
            } else if child.is_element() {
                out += &self.source[child.range()];
            }
        }
        if is_on_path {
            self.on_path.pop();
        }
        Some(out + &end)
    }

    /// Writes characters in the pieces to which they belong. Returns `None` if usvg shows other characters.
    fn letters(&mut self, text: &str) -> Option<String> {
        let mut stretches: Vec<Stretch> = Vec::new();
        for c in text.chars() {
            let is_space = |c: char| matches!(c, ' ' | '\t' | '\n' | '\r');
            match self.shown.get(self.next) {
                Some(shown) if *shown == c || (is_space(*shown) && is_space(c)) => {}
                _ if is_space(c) => continue,
                _ => return None,
            }
            let at = self.next;
            self.next += 1;
            let piece = self.pieces.partition_point(|p| p.chars.end <= at);
            if !self.pieces.get(piece).is_some_and(|p| p.chars.contains(&at)) {
                continue;
            }
            if stretches.last().is_none_or(|s| s.piece != piece) {
                stretches.push(Stretch { piece, chars: at..at, letters: String::new(), turns: Vec::new() });
            }
            let Some(stretch) = stretches.last_mut() else { continue };
            stretch.chars.end = at + 1;
            // Marks of direction are dropped, since the positions of pieces determine their order.
            if !matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}') {
                stretch.letters.push(if is_space(c) { ' ' } else { c });
                stretch.turns.push(self.rotate.get(at).copied().unwrap_or(0.0));
            }
        }
        let is_empty =
            |s: &Stretch| s.letters.chars().all(|c| matches!(c, '\u{180b}' | '\u{200b}'..='\u{200d}' | '\u{2060}'));
        Some(stretches.into_iter().filter(|s| !is_empty(s)).map(|s| self.stretch(s)).collect())
    }

    /// Writes a stretch as a `tspan`.
    fn stretch(&self, stretch: Stretch) -> String {
        let Piece { chars, attributes, small, around: [before, after] } = &self.pieces[stretch.piece];
        let Stretch { chars: written, letters, mut turns, .. } = stretch;
        let is_start = written.start == chars.start;
        let mut out = String::new();
        if is_start {
            self.on_path.iter().rev().for_each(|(_, end)| out += end);
            self.on_path.iter().for_each(|(start, _)| out += start);
        }
        // A piece that continues in the next element gets no position there.
        let style = attributes.find(" style=").unwrap_or(0);
        let _ = write!(out, "<tspan{}", if is_start { attributes } else { &attributes[style..] });
        let before = if is_start { before } else { "" };
        if self.rotate.iter().any(|r| *r != 0.0) {
            turns.splice(..0, before.chars().map(|_| 0.0));
            let _ = write!(out, " rotate=\"{}\"", turns.iter().map(f32::to_string).collect::<Vec<_>>().join(" "));
        }
        let after = if written.end == chars.end { after } else { "" };
        let letters = if *small { letters.to_uppercase() } else { letters };
        let _ = write!(out, ">{before}{}{after}</tspan>", escape(&letters));
        out
    }
}

/// A part of a piece within one element.
struct Stretch {
    /// Index of the piece.
    piece: usize,
    /// Indices among the characters of the text.
    chars: Range<usize>,
    letters: String,
    /// Rotation of each letter, in degrees.
    turns: Vec<f32>,
}
