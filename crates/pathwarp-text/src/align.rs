//! Aligns lines, widens spaces, sizes lines to a width, and stacks them.

use crate::lettering::{Cluster, LetteringLine};
use crate::metrics::FontMetrics;
use crate::style::{Align, TextStyle};
use kurbo::Affine;

/// Aligns lines within the width of the longest.
pub(crate) fn align(lines: &mut [LetteringLine], align: Align, rtl: bool) {
    if align == Align::Fill {
        return fill(lines);
    }
    let width = lines.iter().map(|l| l.end.x).fold(0.0, f64::max);
    for line in lines {
        let room = width - line.end.x;
        let before = match align {
            Align::Left => 0.0,
            Align::Center => 0.5 * room,
            Align::Right => room,
            Align::Justify if widen(line, room) => 0.0,
            Align::Start | Align::Justify | Align::Fill => {
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

/// Scales every line so that its ink is as wide as the widest line's, from x = 0 on.
fn fill(lines: &mut [LetteringLine]) {
    let width = lines.iter().filter_map(LetteringLine::ink).map(|b| b.width()).fold(0.0, f64::max);
    for line in lines {
        let Some(ink) = line.ink().filter(|b| (width / b.width()).is_finite()) else { continue };
        let scale = width / ink.width();
        let y = line.start.y;
        let to = Affine::translate((0.0, y)) * Affine::scale(scale) * Affine::translate((-ink.x0, -y));
        for c in &mut line.clusters {
            c.origin = to * c.origin;
            c.advance *= scale;
            c.outline.apply_affine(to);
            for g in &mut c.glyphs {
                (g.dx, g.dy, g.advance) = (g.dx * scale, g.dy * scale, g.advance * scale);
            }
        }
        line.scale = scale;
        line.start.x = 0.0;
        line.end.x = width;
    }
}

/// Moves lines of different sizes, or with a gap between their ink, to their heights. `metrics` are those of a line of scale 1.
pub(crate) fn stack(lines: &mut [LetteringLine], style: &TextStyle, metrics: &FontMetrics) {
    // The baseline of the line before with its scale, and the lower end of its ink.
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
        let down = Affine::translate((0.0, baseline - y));
        for c in &mut line.clusters {
            c.origin = down * c.origin;
            c.outline.apply_affine(down);
        }
        (line.start, line.end) = (down * line.start, down * line.end);
        above = Some((baseline, line.scale, baseline + ink.1));
    }
}

/// Distributes `room` among the spaces of a line; returns `false` if there are none.
fn widen(line: &mut LetteringLine, room: f64) -> bool {
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

/// Moves a cluster horizontally.
fn shift(c: &mut Cluster, dx: f64) {
    if dx != 0.0 {
        c.origin.x += dx;
        c.outline.apply_affine(Affine::translate((dx, 0.0)));
    }
}

/// Returns `true` for a space that separates words.
pub(crate) fn is_space(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| matches!(c, ' ' | '\u{a0}'))
}
