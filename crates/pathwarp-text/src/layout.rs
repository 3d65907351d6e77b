//! Text to lines of clusters: cut, shaped, spaced, aligned.

use crate::error::guarded;
use crate::itemize::{self, Run};
use crate::shape::{self, Glyph, MOST_GLYPHS, ShapedCluster, Shaper};
use crate::{Error, Feature, Font, Metrics};
use kurbo::{Affine, BezPath, Point, Rect};
use skrifa::GlyphId;
use std::collections::hash_map::Entry;
use std::collections::{BTreeSet, HashMap};
use unicode_script::Script;

/// More characters than this are a book.
const MOST_CHARACTERS: usize = 20_000;
/// More path elements than this in one text: about 200 MB.
const MOST_ELEMENTS: usize = 1 << 22;

/// Which way the text's base direction goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Direction {
    /// As the first character that has a direction; to the right without one.
    #[default]
    Auto,
    /// To the right.
    Ltr,
    /// To the left.
    Rtl,
}

/// Where the lines of a text stand, in the width of the longest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Align {
    /// Where the text starts: left, or right for text that goes to the left.
    #[default]
    Start,
    /// At the left.
    Left,
    /// In the middle.
    Center,
    /// At the right.
    Right,
    /// From side to side: the spaces between words are widened, in every line that has one.
    Justify,
}

/// Whether optional ligatures (`liga`, `clig`) are set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Ligatures {
    /// Unless there is letter spacing, which a ligature could not follow.
    #[default]
    Auto,
    /// Always.
    On,
    /// Never. Those that a script cannot do without (`rlig`) stay.
    Off,
}

/// How text is set. Lengths are in user units.
#[derive(Debug, Clone, PartialEq)]
pub struct Style {
    /// The size of the em: above 0, up to 1e6.
    pub size: f64,
    /// Room added between clusters, none after a line's last; joined scripts (Arabic, Syriac, …) are not torn apart. Of either
    /// sign, at most a thousand sizes.
    pub letter_spacing: f64,
    /// Room added to every space. Of either sign, at most a thousand sizes.
    pub word_spacing: f64,
    /// From one baseline to the next; without it, as the font says (ascent + descent + line gap). At least 0, at most a thousand
    /// sizes.
    pub line_height: Option<f64>,
    /// Where lines stand.
    pub align: Align,
    /// The base direction of all lines.
    pub direction: Direction,
    /// The script of all text, an ISO 15924 code such as `Deva`; without it, as Unicode says of every character.
    pub script: Option<String>,
    /// The language, a BCP 47 tag such as `sr` or `tr`: fonts have letters of their own for some.
    pub language: Option<String>,
    /// Whether pairs of letters are kerned.
    pub kerning: bool,
    /// Whether optional ligatures are set.
    pub ligatures: Ligatures,
    /// OpenType features; these overrule the two above.
    pub features: Vec<Feature>,
}

impl Default for Style {
    /// 72 units high, as the font wants it, from the text's start.
    fn default() -> Self {
        Self {
            size: 72.0,
            letter_spacing: 0.0,
            word_spacing: 0.0,
            line_height: None,
            align: Align::Start,
            direction: Direction::Auto,
            script: None,
            language: None,
            kerning: true,
            ligatures: Ligatures::Auto,
            features: Vec::new(),
        }
    }
}

/// Characters that belong together (a letter with its marks, a ligature), as one outline.
#[derive(Debug, Clone, PartialEq)]
pub struct Cluster {
    /// Its characters.
    pub text: String,
    /// Its left end on the baseline.
    pub origin: Point,
    /// Its advance width as shaped: kerning counts, letter and word spacing do not.
    pub advance: f64,
    /// Its outline in place; empty for a space. Overlaps are to be filled by the nonzero rule.
    pub outline: BezPath,
    /// What it is made of.
    pub glyphs: Vec<Glyph>,
}

/// A line of text.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Its characters.
    pub text: String,
    /// Left end of the baseline: where the first cluster's advance starts.
    pub start: Point,
    /// Right end of the baseline: where the last cluster's advance ends.
    pub end: Point,
    /// From left to right.
    pub clusters: Vec<Cluster>,
}

/// Text as outlines. The longest line starts at x = 0, and the first line's ascent is at y = 0; y points down.
#[derive(Debug, Clone, PartialEq)]
pub struct Lettering {
    /// The text; newlines between lines, control characters replaced by spaces.
    pub text: String,
    /// The first font's heights.
    pub metrics: Metrics,
    /// Whether the base direction is to the left.
    pub rtl: bool,
    /// From top to bottom.
    pub lines: Vec<Line>,
    /// Characters that no font has, each once.
    pub missing: Vec<char>,
}

impl Lettering {
    /// The smallest box around all outlines; none without any.
    #[must_use]
    pub fn ink(&self) -> Option<Rect> {
        let outlines = self.lines.iter().flat_map(|l| &l.clusters).map(|c| &c.outline).filter(|o| !o.is_empty());
        outlines.map(kurbo::Shape::bounding_box).reduce(|a, b| a.union(b))
    }

    /// The box around all lines: from end to end of the baselines, from the first ascent to the last descent.
    #[must_use]
    pub fn line_box(&self) -> Rect {
        let of = |l: &Line| {
            Rect::new(l.start.x, l.start.y - self.metrics.ascent, l.end.x, l.end.y + self.metrics.descent).abs()
        };
        self.lines.iter().map(of).reduce(|a, b| a.union(b)).unwrap_or_default()
    }

    /// The box around ink and lines.
    #[must_use]
    pub fn page(&self) -> Rect {
        let lines = self.line_box();
        self.ink().map_or(lines, |ink| ink.union(lines))
    }
}

/// Sets text. Lines end at newlines; a tab and any other control character is a space. What the first font lacks is taken from
/// the next that has it.
///
/// ```
/// use pathwarp_text::{Align, Font, Style, features, layout};
///
/// # let bytes = include_bytes!("../../pathwarp-svg/fonts/NotoSans-Regular.subset.ttf");
/// let fonts = [Font::new(bytes, 0)?];
/// let style = Style { align: Align::Center, features: features("liga=0")?, ..Style::default() };
/// let two = layout("one\nand two", &fonts, &style)?;
/// let middle = |i: usize| two.lines[i].start.midpoint(two.lines[i].end).x;
/// assert!((middle(0) - middle(1)).abs() < 1e-9);
/// assert!(two.missing.is_empty());
/// # Ok::<(), pathwarp_text::Error>(())
/// ```
///
/// # Errors
/// The style is not possible, the text is empty or far too long, or the font is damaged.
pub fn layout(text: &str, fonts: &[Font<'_>], style: &Style) -> Result<Lettering, Error> {
    let Some(font) = fonts.first() else { return Err(Error::NoFont) };
    let (script, language) = check(style)?;
    let lines = lines(text);
    let text = lines.join("\n");
    if text.chars().nth(MOST_CHARACTERS).is_some() {
        return Err(Error::TooMuch(format!("the text has more than {MOST_CHARACTERS} characters")));
    }
    let rtl = match style.direction {
        Direction::Auto => itemize::starts_rtl(&text),
        Direction::Ltr => false,
        Direction::Rtl => true,
    };
    let mut shaper = Shaper { fonts, size: style.size, features: features(style), language, budget: MOST_GLYPHS };
    let mut painter = Painter { fonts, size: style.size, drawn: HashMap::new(), budget: MOST_ELEMENTS };
    let set = || -> Result<Vec<Line>, Error> {
        let metrics = font.metrics(style.size);
        let step = style.line_height.unwrap_or(metrics.ascent + metrics.descent + metrics.line_gap);
        let mut out = Vec::with_capacity(lines.len());
        for (i, line) in lines.iter().enumerate() {
            let y = metrics.ascent + i as f64 * step;
            let clusters = clusters(line, &itemize::runs(line, rtl, script), style, &mut shaper)?;
            out.push(painter.line(line, clusters, y)?);
        }
        align(&mut out, style.align, rtl);
        Ok(out)
    };
    let lines = guarded(set)?;
    let missing: BTreeSet<char> = lines.iter().flat_map(|l| missing(l, fonts)).collect();
    let out = Lettering { text, metrics: font.metrics(style.size), rtl, lines, missing: missing.into_iter().collect() };
    if out.page().area() > 0.0 { Ok(out) } else { Err(Error::Empty) }
}

/// The style's numbers and names.
fn check(style: &Style) -> Result<(Option<Script>, Option<harfrust::Language>), Error> {
    /// Larger is no drawing's size.
    const LARGEST: f64 = 1e6;
    const FURTHEST: f64 = 1e3;
    let wrong = |what, value, legal| Err(Error::Style { what, value, legal });
    if !(style.size > 0.0 && style.size <= LARGEST) {
        return wrong("a size", style.size, "it is above 0 and at most 1000000");
    }
    let far = |v: f64| v.is_nan() || v.abs() > FURTHEST * style.size;
    if far(style.letter_spacing) {
        return wrong("a letter spacing", style.letter_spacing, "it is at most a thousand sizes");
    }
    if far(style.word_spacing) {
        return wrong("a word spacing", style.word_spacing, "it is at most a thousand sizes");
    }
    if let Some(h) = style.line_height.filter(|h| far(*h) || *h < 0.0) {
        return wrong("a line height", h, "it is at least 0 and at most a thousand sizes");
    }
    let script = style.script.as_deref().map(|code| {
        let mut letters = code.chars();
        let title: String = letters
            .next()
            .map(|c| c.to_ascii_uppercase())
            .into_iter()
            .chain(letters.map(|c| c.to_ascii_lowercase()))
            .collect();
        Script::from_short_name(&title)
            .ok_or_else(|| Error::setting(code, "is no script of ISO 15924, such as Latn, Arab or Deva"))
    });
    let language = style.language.as_deref().map(|tag| {
        let sound =
            tag.split('-').all(|part| (1..=8).contains(&part.len()) && part.bytes().all(|b| b.is_ascii_alphanumeric()));
        harfrust::Language::new(tag)
            .filter(|_| sound)
            .ok_or_else(|| Error::setting(tag, "is no language tag of BCP 47, such as en, sr-Cyrl or tr"))
    });
    Ok((script.transpose()?, language.transpose()?))
}

/// The lines of a text, without characters that have no place in one.
fn lines(text: &str) -> Vec<String> {
    let text = text.replace("\r\n", "\n");
    let ends = |c: char| matches!(c, '\n' | '\r' | '\u{b}' | '\u{c}' | '\u{85}' | '\u{2028}' | '\u{2029}');
    let plain = |c: char| match c {
        c if c.is_control() => ' ',
        // No characters, and not allowed in XML.
        '\u{fffe}' | '\u{ffff}' => '\u{fffd}',
        c => c,
    };
    text.split(ends).map(|l| l.chars().map(plain).collect()).collect()
}

fn features(style: &Style) -> Vec<harfrust::Feature> {
    let ligatures = match style.ligatures {
        Ligatures::Auto => style.letter_spacing == 0.0,
        Ligatures::On => true,
        Ligatures::Off => false,
    };
    let off = |name: &[u8; 4]| Feature { tag: skrifa::Tag::new(name), value: 0 };
    let mut all = Vec::new();
    if !style.kerning {
        all.push(off(b"kern"));
    }
    if !ligatures {
        all.extend([off(b"liga"), off(b"clig")]);
    }
    all.extend_from_slice(&style.features);
    shape::for_whole_text(&all)
}

/// A cluster and the room after it.
struct Spaced {
    cluster: ShapedCluster,
    gap: f64,
}

/// A line's clusters from left to right, spaced.
fn clusters(line: &str, runs: &[Run], style: &Style, shaper: &mut Shaper<'_, '_>) -> Result<Vec<Spaced>, Error> {
    let mut out: Vec<Spaced> = Vec::new();
    for run in runs {
        let joined = itemize::joins(run.script);
        let shaped = shaper.run(line, run)?;
        let count = shaped.len();
        for (i, cluster) in shaped.into_iter().enumerate() {
            let inside = joined && i + 1 < count;
            let letter = if inside || cluster.advance == 0.0 { 0.0 } else { style.letter_spacing };
            let word = if is_space(&line[cluster.range.clone()]) { style.word_spacing } else { 0.0 };
            out.push(Spaced { cluster, gap: letter + word });
        }
    }
    // Nothing follows the last one; a space keeps the room that is its own.
    if let Some(last) = out.last_mut() {
        last.gap = if is_space(&line[last.cluster.range.clone()]) { style.word_spacing } else { 0.0 };
    }
    Ok(out)
}

/// A space that separates words.
fn is_space(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| matches!(c, ' ' | '\u{a0}'))
}

/// Draws glyphs, each of them once.
struct Painter<'s, 'f> {
    fonts: &'s [Font<'f>],
    size: f64,
    drawn: HashMap<(usize, u32), BezPath>,
    /// How many path elements there may still be.
    budget: usize,
}

impl Painter<'_, '_> {
    fn line(&mut self, text: &str, spaced: Vec<Spaced>, y: f64) -> Result<Line, Error> {
        let mut x = 0.0;
        let mut clusters = Vec::with_capacity(spaced.len());
        for Spaced { cluster, gap } in spaced {
            let origin = Point::new(x, y);
            let mut outline = BezPath::new();
            for g in &cluster.glyphs {
                self.draw(g, origin, &mut outline)?;
            }
            x += cluster.advance + gap;
            clusters.push(Cluster {
                text: text[cluster.range].to_owned(),
                origin,
                advance: cluster.advance,
                outline,
                glyphs: cluster.glyphs,
            });
        }
        Ok(Line { text: text.to_owned(), start: Point::new(0.0, y), end: Point::new(x, y), clusters })
    }

    fn draw(&mut self, g: &Glyph, origin: Point, out: &mut BezPath) -> Result<(), Error> {
        let Some(font) = self.fonts.get(g.font) else { return Ok(()) };
        let key = (g.font, g.id);
        let glyph = match self.drawn.entry(key) {
            Entry::Occupied(e) => e.into_mut(),
            Entry::Vacant(e) => e.insert(font.outlines.draw(GlyphId::new(g.id), font.location())?),
        };
        self.budget = self
            .budget
            .checked_sub(glyph.elements().len())
            .ok_or_else(|| Error::TooMuch(format!("the outlines have more than {MOST_ELEMENTS} pieces")))?;
        let place =
            Affine::translate((origin.x + g.dx, origin.y + g.dy)) * Affine::scale(self.size / font.units_per_em());
        out.extend(glyph.elements().iter().map(|el| place * *el));
        Ok(())
    }
}

/// Moves lines to where they stand.
fn align(lines: &mut [Line], align: Align, rtl: bool) {
    let width = lines.iter().map(|l| l.end.x).fold(0.0, f64::max);
    for line in lines {
        let room = width - line.end.x;
        let before = match align {
            Align::Left => 0.0,
            Align::Center => 0.5 * room,
            Align::Right => room,
            Align::Justify if widen(line, room) => 0.0,
            Align::Start | Align::Justify => {
                if rtl {
                    room
                } else {
                    0.0
                }
            }
        };
        for c in &mut line.clusters {
            shift(c, before);
        }
        line.start.x += before;
        line.end.x += before;
    }
}

/// Shares out room among a line's spaces; false if there are none.
fn widen(line: &mut Line, room: f64) -> bool {
    let spaces = line.clusters.iter().filter(|c| is_space(&c.text)).count();
    if spaces == 0 {
        return false;
    }
    let each = room / spaces as f64;
    let mut before = 0.0;
    for c in &mut line.clusters {
        shift(c, before);
        if is_space(&c.text) {
            before += each;
        }
    }
    line.end.x += room;
    true
}

fn shift(c: &mut Cluster, dx: f64) {
    if dx != 0.0 {
        c.origin.x += dx;
        c.outline.apply_affine(Affine::translate((dx, 0.0)));
    }
}

/// The characters of a line that no font has.
fn missing(line: &Line, fonts: &[Font<'_>]) -> Vec<char> {
    let mut out = Vec::new();
    for c in line.clusters.iter().filter(|c| c.glyphs.iter().any(|g| g.id == 0)) {
        let before = out.len();
        out.extend(c.text.chars().filter(|c| !fonts.iter().any(|f| f.has(*c))));
        if out.len() == before {
            // Every font has some of the cluster, and none has all of it.
            out.extend(c.text.chars());
        }
    }
    out
}
