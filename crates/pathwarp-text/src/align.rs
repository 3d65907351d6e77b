//! Aligns lines and widens spaces.

use crate::lettering::{Cluster, LetteringLine};
use crate::style::Align;
use kurbo::Affine;

/// Aligns lines within the width of the longest.
pub(crate) fn align(lines: &mut [LetteringLine], align: Align, rtl: bool) {
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
