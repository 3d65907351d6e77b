//! The quick way to the next picture of a drag: where only path data differ from the text before, they are sent as they are, and
//! usvg need not read and write the whole drawing again.
//!
//! This is right only if each `d` of the text is the `d` of one element of the picture and nothing else follows from its shape. So
//! it is used only for drawings without anything that usvg derives from shapes, and only after the two have been compared.

use crate::picture::Picture;
use pathwarp::kurbo::{BezPath, Rect, Shape as _};
use std::ops::Range;

/// Markup that rules the short way out: shapes without path data, shapes that are drawn elsewhere or again, and paints and effects
/// that usvg computes from bounding boxes.
const DERIVED: [&str; 16] = [
    "<rect", "<circle", "<ellipse", "<line", "<poly", "<text", "<use", "<svg:", "<switch", "Gradient", "<pattern",
    "clipPath", "<mask", "<filter", "<marker", "<style",
];
/// Largest distance between the boxes of the same path in the text and in the picture: coordinates are rounded.
const ROUNDING: f64 = 0.05;

/// The text of the last picture, and the line of the picture that each path of it has.
#[derive(Debug)]
pub(crate) struct Quick {
    text: String,
    /// The places of path data in the text.
    data: Vec<Range<usize>>,
    lines: Vec<usize>,
}

impl Quick {
    /// Prepares the quick way from this text, of which `picture` is the picture. Returns `None` if there is none.
    pub(crate) fn from(text: String, picture: &Picture) -> Option<Self> {
        if DERIVED.iter().any(|word| text.contains(word)) {
            return None;
        }
        let (data, paths) = (data(&text), picture.paths());
        let same = |(range, (_, shown)): (&Range<usize>, &(usize, &str))| is_same(&text[range.clone()], shown);
        (data.len() == paths.len() && data.iter().zip(&paths).all(same)).then(|| {
            let lines = paths.iter().map(|(line, _)| *line).collect();
            Self { text, data, lines }
        })
    }

    /// Goes on to the next text: the lines whose path data differ, with the new data. Returns `None` if anything else differs.
    pub(crate) fn next(&mut self, text: &str) -> Option<Vec<(usize, String)>> {
        let new = data(text);
        if self.data.len() != new.len() {
            return None;
        }
        let mut changes = Vec::new();
        let (mut old_end, mut new_end) = (0, 0);
        for ((old, new), line) in self.data.iter().zip(&new).zip(&self.lines) {
            if self.text[old_end..old.start] != text[new_end..new.start] {
                return None;
            }
            (old_end, new_end) = (old.end, new.end);
            let value = &text[new.clone()];
            // A path without segments or with entities is usvg's to read.
            if value.is_empty() || value.contains(['&', '"', '<']) {
                return None;
            }
            if *value != self.text[old.clone()] {
                changes.push((*line, value.to_owned()));
            }
        }
        if self.text[old_end..] != text[new_end..] {
            return None;
        }
        text.clone_into(&mut self.text);
        self.data = new;
        Some(changes)
    }
}

/// The places of path data in a text, between their quotes.
fn data(text: &str) -> Vec<Range<usize>> {
    /// The attribute's name with what is around it.
    const NAME: &str = " d=";
    let mut out = Vec::new();
    let mut from = 0;
    while let Some(at) = text[from..].find(NAME) {
        let quote = from + at + NAME.len();
        let Some(mark @ (b'"' | b'\'')) = text.as_bytes().get(quote).copied() else {
            from = quote;
            continue;
        };
        let start = quote + 1;
        let Some(length) = text[start..].find(mark as char) else { break };
        out.push(start..start + length);
        from = start + length;
    }
    out
}

/// Returns `true` if two texts of path data have the same extent and number of subpaths.
fn is_same(a: &str, b: &str) -> bool {
    let read = |d: &str| {
        let path = BezPath::from_svg(d).ok()?;
        let starts = path.elements().iter().filter(|e| matches!(e, pathwarp::kurbo::PathEl::MoveTo(_))).count();
        Some((path.bounding_box(), starts))
    };
    let near = |a: Rect, b: Rect| {
        let off = [a.x0 - b.x0, a.y0 - b.y0, a.x1 - b.x1, a.y1 - b.y1];
        off.iter().all(|v| v.abs() <= ROUNDING)
    };
    read(a).zip(read(b)).is_some_and(|((a, m), (b, n))| m == n && near(a, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(first: &str, fill: &str) -> String {
        format!(
            "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 40 20'><title>a d= b</title><g transform='scale(2)'>\
             <path fill=\"{fill}\" d=\"{first}\"/></g><path d='M5,5H9V9z'/></svg>"
        )
    }

    fn quick(text: &str) -> Option<Quick> {
        Quick::from(text.to_owned(), &Picture::of(text, 2).unwrap())
    }

    #[test]
    fn path_data_alone_go_the_quick_way() {
        let mut quick = quick(&text("M0,0h9v9z", "red")).unwrap();
        let changes = quick.next(&text("M0,0H8V9z", "red")).unwrap();
        let [(line, data)] = changes.as_slice() else { panic!("{changes:?}") };
        assert_eq!(data, "M0,0H8V9z");
        let mut picture = Picture::of(&text("M0,0h9v9z", "red"), 2).unwrap();
        picture.redraw(&changes);
        assert_eq!(picture.paths()[0], (*line, "M0,0H8V9z"));
        assert_eq!(quick.next(&text("M0,0H8V9z", "red")), Some(Vec::new()));
    }

    #[test]
    fn anything_else_takes_the_long_way() {
        let start = || quick(&text("M0,0h9v9z", "red")).unwrap();
        assert_eq!(start().next(&text("M0,0h9v9z", "blue")), None);
        assert_eq!(start().next(&text("", "red")), None);
        assert_eq!(start().next(&text("M0,0h9v9z", "red").replace("<path d", "<path/><path d")), None);
        // Paths that are not drawn, and whatever is drawn otherwise.
        assert!(quick(&text("M0,0h9v9z", "red").replace("fill", "display='none' fill")).is_none());
        assert!(
            quick(&text("M0,0h9v9z", "red").replace("<path d='M5,5H9V9z'", "<rect width='4' height='3'")).is_none()
        );
        assert!(quick(&text("M0,0h9v9z", "red").replace("</svg>", "<linearGradient/></svg>")).is_none());
    }
}
