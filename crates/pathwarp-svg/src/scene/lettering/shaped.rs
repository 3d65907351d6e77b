//! Lettering of text as laid out by usvg: position and subpaths of each glyph.
//!
//! usvg merges the outlines of a span's glyphs into one path. To find the boundaries, each glyph is drawn again from its font
//! in the same way. If the two disagree (colour fonts, bitmap glyphs), the text is treated as having no letters.

use super::line::{Heights, PlacedLetter, TextLine};
use crate::scene::model::Part;
use crate::scene::usvg_path::from_usvg;
use pathwarp::Outline;
use pathwarp::kurbo::{Affine, Point};
use skrifa::MetadataProvider;
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlinePen};
use std::ops::Range;
use usvg::layout::{PositionedGlyph, Span};
use usvg::tiny_skia_path as ts;

/// Baselines at least this far apart, in font sizes, belong to different lines; closer ones to raised or lowered letters.
const ANOTHER_LINE: f64 = 0.5;

/// A glyph in the text's user space.
struct Glyph {
    text: String,
    origin: Point,
    advance: f64,
    size: f64,
    heights: Heights,
    part: usize,
    range: Range<usize>,
    /// Centre of the outline's box.
    centre: f64,
    turned: bool,
}

/// Finds the lines of a text whose parts are `parts[first..]`. `frame` maps the text to root user space.
pub(crate) fn lines(
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
        let same = |row: &&mut Vec<Glyph>| {
            !straight
                || row.first().is_some_and(|f| (f.origin.y - g.origin.y).abs() < ANOTHER_LINE * f.size.max(g.size))
        };
        match rows.last_mut().filter(same) {
            Some(row) => row.push(g),
            None => rows.push(vec![g]),
        }
    }
    rows.into_iter().filter_map(|row| line(row, frame, straight)).collect()
}

fn line(row: Vec<Glyph>, frame: Affine, straight: bool) -> Option<TextLine> {
    let (wide, marks): (Vec<Glyph>, Vec<Glyph>) = row.into_iter().partition(|g| g.advance > 0.0);
    // The line's baseline is the one with the largest total advance; raised letters keep their height above it.
    let share = |y: f64| wide.iter().filter(|g| g.origin.y == y).map(|g| g.advance).sum::<f64>();
    let y = wide.iter().map(|g| g.origin.y).max_by(|a, b| share(*a).total_cmp(&share(*b)))?;
    let from = wide.iter().map(|g| g.origin.x).fold(f64::INFINITY, f64::min);
    let to = wide.iter().map(|g| g.origin.x + g.advance).fold(f64::NEG_INFINITY, f64::max);
    let largest = wide.iter().max_by(|a, b| a.size.total_cmp(&b.size))?;
    let straight = straight && !wide.iter().any(|g| g.turned);
    let name: String = wide.iter().map(|g| g.text.as_str()).collect();
    let mut line = TextLine::new(name, Point::new(from, y), Point::new(to, y), largest.heights, frame, straight);
    let middles: Vec<f64> = wide.iter().map(|g| g.origin.x + 0.5 * g.advance).collect();
    let across = Point::new(1.0, 0.0).to_vec2();
    let stretch = (frame * across.to_point() - frame * Point::ORIGIN).hypot();
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
        let off = |i: &usize| (middles[*i] - m.centre).abs();
        if let Some(l) = (0..middles.len()).min_by(|a, b| off(a).total_cmp(&off(b))) {
            line.letters[l].subpaths.push((m.part, m.range));
        }
    }
    Some(line)
}

/// Lists the glyphs with an outline. Returns `None` if they do not add up to the text's paths.
fn glyphs(text: &usvg::Text, fonts: &usvg::fontdb::Database, parts: &[Part], first: usize) -> Option<Vec<Glyph>> {
    let mut out = Vec::new();
    let mut part = first;
    for span in text.layouted() {
        part += usize::from(span.overline.is_some()) + usize::from(span.underline.is_some());
        let mut taken = 0;
        for g in &span.positioned_glyphs {
            let Some((outline, metrics)) = drawn(g, span, fonts) else { continue };
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
                turned: t.ky != 0.0 || t.sx <= 0.0,
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

/// A glyph's metrics from its font.
struct Metrics {
    /// Font units.
    advance: f64,
    /// The text's user units.
    heights: Heights,
}

/// Draws a glyph as usvg does. Returns `None` if it has no outline, such as a space.
fn drawn(g: &PositionedGlyph, span: &Span, fonts: &usvg::fontdb::Database) -> Option<(Outline, Metrics)> {
    fonts.with_face_data(g.font, |data, index| {
        let font = skrifa::FontRef::from_index(data, index).ok()?;
        let axes = font.axes();
        let mut set: Vec<(skrifa::Tag, f32)> =
            span.variations.iter().map(|v| (skrifa::Tag::from_be_bytes(v.tag), v.value)).collect();
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
        let scaled = |v: Option<f32>| v.map_or(0.0, |v| f64::from(v).abs() * per_unit);
        let own = Metrics {
            advance: f64::from(glyphs.advance_width(id)?),
            heights: Heights {
                ascent: scaled(Some(metrics.ascent)),
                descent: scaled(Some(metrics.descent)),
                cap_height: scaled(metrics.cap_height.filter(|h| *h > 0.0).or_else(|| height('H'))),
                x_height: scaled(metrics.x_height.filter(|h| *h > 0.0).or_else(|| height('x'))),
            },
        };
        Some((from_usvg(&path), own))
    })?
}

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
