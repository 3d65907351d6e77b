//! Sets text: itemizes, shapes, spaces, aligns and stacks lines of clusters.

use crate::error::{Error, guarded};
use crate::font::Font;
use crate::itemize::{self, Run};
use crate::lettering::{Cluster, LetteringLine, OutlinedText};
use crate::limits::TextLimits;
use crate::metrics::FontMetrics;
use crate::painter::{GlyphPainter, SpacedCluster};
use crate::shape::{self, RunShaper, ShapedCluster};
use crate::style::{Align, Direction, Feature, Ligatures, TextStyle, check};
use kurbo::{Affine, Vec2};
use std::collections::{BTreeSet, HashMap};

/// Sets text within the default limits. Lines end at newlines; tabs and other control characters become spaces. Characters that the
/// first font lacks come from the next font that has them.
///
/// ```
/// use pathwarp_text::{Align, Font, TextStyle, features, layout};
///
/// # let bytes = include_bytes!("../../pathwarp-svg/fonts/NotoSans-Regular.subset.ttf");
/// let fonts = [Font::new(bytes, 0)?];
/// let style = TextStyle { align: Align::Center, features: features("liga=0")?, ..TextStyle::default() };
/// let two = layout("one\nand two", &fonts, &style)?;
/// let middle = |i: usize| two.lines[i].start.midpoint(two.lines[i].end).x;
/// assert!((middle(0) - middle(1)).abs() < 1e-9);
/// assert!(two.missing.is_empty());
/// # Ok::<(), pathwarp_text::Error>(())
/// ```
///
/// # Errors
/// [`Error::Style`] and [`Error::Setting`] for an invalid style; [`Error::NoFont`]; [`Error::Empty`] and [`Error::TooLarge`] for the text;
/// [`Error::Glyph`] and [`Error::Failed`] for a damaged font.
pub fn layout(text: &str, fonts: &[Font<'_>], style: &TextStyle) -> Result<OutlinedText, Error> {
    layout_within(text, fonts, style, &TextLimits::default())
}

/// Sets text within `limits`; see [`layout`].
///
/// # Errors
/// Any [`Error`] of [`layout`].
pub fn layout_within(
    text: &str,
    fonts: &[Font<'_>],
    style: &TextStyle,
    limits: &TextLimits,
) -> Result<OutlinedText, Error> {
    let metrics = fonts.first().ok_or(Error::NoFont)?.metrics(style.size);
    let (script, language) = check(style)?;
    let lines = lines(text);
    let text = lines.join("\n");
    limits.letters(text.chars().count())?;
    let rtl = match style.direction {
        Direction::Auto => itemize::starts_rtl(&text),
        Direction::Ltr => false,
        Direction::Rtl => true,
    };
    let (size, features) = (style.size, features(style));
    let mut shaper = RunShaper { fonts, size, features, language, limits, glyph_count: 0 };
    let mut painter = GlyphPainter { fonts, size, outlines: HashMap::new(), limits, element_count: 0 };
    let set_lines = || -> Result<Vec<LetteringLine>, Error> {
        let step = style.line_height.unwrap_or(metrics.ascent + metrics.descent + metrics.line_gap);
        let mut out = Vec::with_capacity(lines.len());
        for (i, line) in lines.iter().enumerate() {
            let y = metrics.ascent + i as f64 * step;
            let clusters = clusters(line, &itemize::runs_from(line, rtl, script), style, &mut shaper)?;
            out.push(painter.line(line, clusters, y)?);
        }
        align(&mut out, style.align, rtl);
        if style.align == Align::Fill || style.gap.is_some() {
            stack(&mut out, style, &metrics);
        }
        Ok(out)
    };
    let lines = guarded(set_lines)?;
    let missing: BTreeSet<char> = lines.iter().flat_map(|l| missing(l, fonts)).collect();
    let out = OutlinedText { text, metrics, rtl, lines, missing: missing.into_iter().collect() };
    if out.page().area() > 0.0 { Ok(out) } else { Err(Error::Empty) }
}

/// Splits text into lines and replaces control characters.
fn lines(text: &str) -> Vec<String> {
    let text = text.replace("\r\n", "\n");
    let is_line_end = |c: char| matches!(c, '\n' | '\r' | '\u{b}' | '\u{c}' | '\u{85}' | '\u{2028}' | '\u{2029}');
    let plain = |c: char| match c {
        c if c.is_control() => ' ',
        // Noncharacters, which XML does not allow.
        '\u{fffe}' | '\u{ffff}' => '\u{fffd}',
        c => c,
    };
    text.split(is_line_end).map(|l| l.chars().map(plain).collect()).collect()
}

/// Returns the OpenType features of a style. Later ones override earlier ones.
fn features(style: &TextStyle) -> Vec<harfrust::Feature> {
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

/// Shapes and spaces a line. The clusters go from left to right.
fn clusters(
    line: &str,
    runs: &[Run],
    style: &TextStyle,
    shaper: &mut RunShaper<'_, '_>,
) -> Result<Vec<SpacedCluster>, Error> {
    let word_spacing = |c: &ShapedCluster| if is_space(&line[c.range.clone()]) { style.word_spacing } else { 0.0 };
    let mut out: Vec<SpacedCluster> = Vec::new();
    for run in runs {
        let script_joins = itemize::joins_letters(run.writing);
        let shaped = shaper.run(line, run)?;
        let count = shaped.len();
        for (i, cluster) in shaped.into_iter().enumerate() {
            let joins_next = script_joins && i + 1 < count;
            // Letters move together until they would pass each other.
            let closest = -cluster.advance.max(0.0);
            let letter = if joins_next || cluster.advance == 0.0 { 0.0 } else { style.letter_spacing.max(closest) };
            out.push(SpacedCluster { gap: letter + word_spacing(&cluster), cluster });
        }
    }
    // No letter spacing follows the last cluster; a space keeps its word spacing.
    if let Some(last) = out.last_mut() {
        last.gap = word_spacing(&last.cluster);
    }
    Ok(out)
}

/// Returns the characters of a line that no font has.
fn missing(line: &LetteringLine, fonts: &[Font<'_>]) -> Vec<char> {
    let mut out = Vec::new();
    for c in line.clusters.iter().filter(|c| c.glyphs.iter().any(|g| g.id == 0)) {
        let before = out.len();
        out.extend(c.text.chars().filter(|c| !fonts.iter().any(|f| f.has(*c))));
        if out.len() == before {
            // Every character is in some font, but no font has the whole cluster.
            out.extend(c.text.chars());
        }
    }
    out
}

/// Aligns lines within the width of the longest.
pub(crate) fn align(lines: &mut [LetteringLine], align: Align, rtl: bool) {
    if align == Align::Fill {
        return fill(lines);
    }
    let width = lines.iter().map(|l| l.end.x).fold(0.0, f64::max);
    for line in lines {
        let room = width - line.end.x;
        let dx = match align {
            Align::Center => 0.5 * room,
            Align::Right => room,
            Align::Justify if widen(line, room) => 0.0,
            Align::Start | Align::Justify | Align::Fill if rtl => room,
            Align::Left | Align::Start | Align::Justify | Align::Fill => 0.0,
        };
        move_line(line, Vec2::new(dx, 0.0));
    }
}

/// Scales every line so that its ink is as wide as the widest line's, and starts at x = 0.
fn fill(lines: &mut [LetteringLine]) {
    let width = lines.iter().filter_map(LetteringLine::ink).map(|b| b.width()).fold(0.0, f64::max);
    for line in lines {
        let Some(ink) = line.ink().filter(|b| (width / b.width()).is_finite()) else { continue };
        let scale = width / ink.width();
        let y = line.start.y;
        let transform = Affine::translate((0.0, y)) * Affine::scale(scale) * Affine::translate((-ink.x0, -y));
        for c in &mut line.clusters {
            c.origin = transform * c.origin;
            c.advance *= scale;
            c.outline.apply_affine(transform);
            for g in &mut c.glyphs {
                (g.dx, g.dy, g.advance) = (g.dx * scale, g.dy * scale, g.advance * scale);
            }
        }
        line.scale = scale;
        line.start.x = 0.0;
        line.end.x = width;
    }
}

/// Moves lines vertically if they differ in size or have a gap between their ink. `metrics` hold for a line of scale 1.
pub(crate) fn stack(lines: &mut [LetteringLine], style: &TextStyle, metrics: &FontMetrics) {
    // The baseline and scale of the previous line, and the lower end of its ink.
    let mut above: Option<(f64, f64, f64)> = None;
    for line in lines {
        let y = line.start.y;
        let ink = line.ink().map_or((0.0, 0.0), |b| (b.y0 - y, b.y1 - y));
        let baseline = match (above, style.gap, style.line_height) {
            (None, ..) => metrics.ascent * line.scale,
            (Some((.., lower)), Some(gap), _) => lower + gap - ink.0,
            (Some((before, ..)), None, Some(height)) => before + height * line.scale,
            (Some((before, scale, _)), None, None) => {
                before + (metrics.descent + metrics.line_gap) * scale + metrics.ascent * line.scale
            }
        };
        move_line(line, Vec2::new(0.0, baseline - y));
        above = Some((baseline, line.scale, baseline + ink.1));
    }
}

fn move_line(line: &mut LetteringLine, by: Vec2) {
    line.clusters.iter_mut().for_each(|c| move_cluster(c, by));
    line.start += by;
    line.end += by;
}

/// Distributes `room` among the spaces of a line; returns `false` if there are none.
fn widen(line: &mut LetteringLine, room: f64) -> bool {
    let spaces = line.clusters.iter().filter(|c| is_space(&c.text)).count();
    if spaces == 0 {
        return false;
    }
    let share = room / spaces as f64;
    let mut dx = 0.0;
    for c in &mut line.clusters {
        move_cluster(c, Vec2::new(dx, 0.0));
        if is_space(&c.text) {
            dx += share;
        }
    }
    line.end.x += room;
    true
}

fn move_cluster(c: &mut Cluster, by: Vec2) {
    if by != Vec2::ZERO {
        c.origin += by;
        c.outline.apply_affine(Affine::translate(by));
    }
}

/// Returns `true` if a cluster is a space that separates words.
pub(crate) fn is_space(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| matches!(c, ' ' | '\u{a0}'))
}
