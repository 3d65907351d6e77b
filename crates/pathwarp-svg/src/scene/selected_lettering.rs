//! Finds the selected lettering of a drawing, and makes frames around it.

use super::drawing::Drawing;
use super::lettering::{Heights, PlacedLetter, TextLine};
use crate::source::elements::ElementId;
use crate::source::select::Selection;
use pathwarp::Outline;
use pathwarp::kurbo::Rect;
use pathwarp::param::{self, Frame};
use std::ops::Range;

/// Vertical extent of a frame around lettering. The left and right sides are the ends of the lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum LetteringFrame {
    /// From the baseline to the font's ascent.
    BaselineAscent,
    /// From the baseline to the height of capitals.
    BaselineCapHeight,
    /// From the baseline to the height of lower-case letters.
    BaselineXHeight,
    /// From the font's descent to its ascent.
    AscentDescent,
    /// The bounding box of the letters' outlines.
    Ink,
}

/// The reason why lettering has no frame.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LetteringFrameError {
    /// There is no text, and there are no outlines with data attributes.
    #[error("there is no lettering: only text, and outlines written as lettering, have baselines")]
    NoLettering,
    /// A baseline is not horizontal from left to right.
    #[error("the baseline of `{line}` is not horizontal from left to right")]
    NotLevel {
        /// Text of the line.
        line: String,
    },
    /// The letters have no outlines.
    #[error("the lettering has no outlines")]
    NoOutlines,
    /// The font does not specify the height.
    #[error("the font does not specify this height")]
    NoHeight,
}

/// The lettering in a selection.
#[derive(Debug, Clone, PartialEq)]
pub struct Lettering {
    lines: Vec<TextLine>,
    letters: Vec<param::Letter>,
    is_all: bool,
}

impl Lettering {
    /// The letters, line by line.
    #[must_use]
    pub fn letters(&self) -> &[param::Letter] {
        &self.letters
    }

    /// Whether there is lettering and every baseline is horizontal, so that frames can be made.
    #[must_use]
    pub fn is_level(&self) -> bool {
        !self.lines.is_empty() && self.lines.iter().all(|l| l.level)
    }

    /// Whether the selected artwork consists of lettering only.
    #[must_use]
    pub fn is_all(&self) -> bool {
        self.is_all
    }

    /// Makes a frame around the lettering. Horizontally, it extends from the leftmost start to the rightmost end of a line;
    /// vertically, by `kind` over all lines. For [`BaselineAscent`](LetteringFrame::BaselineAscent), that is from the lowest baseline
    /// to the highest ascent.
    ///
    /// # Errors
    /// Returns the reason why there is no such frame.
    pub fn frame(&self, kind: LetteringFrame) -> Result<Frame, LetteringFrameError> {
        if self.lines.is_empty() {
            return Err(LetteringFrameError::NoLettering);
        }
        if let Some(l) = self.lines.iter().find(|l| !l.level) {
            return Err(LetteringFrameError::NotLevel { line: l.name.clone() });
        }
        let min = |of: &dyn Fn(&TextLine) -> f64| self.lines.iter().map(of).fold(f64::INFINITY, f64::min);
        let max = |of: &dyn Fn(&TextLine) -> f64| -min(&|l| -of(l));
        let baseline = max(&|l| l.start.y);
        let above = |of: fn(&Heights) -> f64| min(&|l| l.start.y - of(&l.heights));
        let (top, bottom) = match kind {
            LetteringFrame::BaselineAscent => (above(|h| h.ascent), baseline),
            LetteringFrame::BaselineCapHeight => (above(|h| h.cap_height), baseline),
            LetteringFrame::BaselineXHeight => (above(|h| h.x_height), baseline),
            LetteringFrame::AscentDescent => (above(|h| h.ascent), max(&|l| l.start.y + l.heights.descent)),
            LetteringFrame::Ink => {
                let boxes = self.letters.iter().filter_map(|l| l.outline.bounding_box());
                let ink = boxes.reduce(|a, b| a.union(b)).ok_or(LetteringFrameError::NoOutlines)?;
                return Ok(Frame::new(ink).on_baseline(baseline));
            }
        };
        if bottom - top <= 0.0 {
            return Err(LetteringFrameError::NoHeight);
        }
        Ok(Frame::new(Rect::new(min(&|l| l.start.x), top, max(&|l| l.end.x), bottom)).on_baseline(baseline))
    }
}

/// The subpaths of a part that belong to a letter.
#[derive(Debug, Clone)]
pub(crate) struct LetterSubpaths {
    /// Index in [`Lettering::letters`].
    pub(crate) letter: usize,
    pub(crate) range: Range<usize>,
}

/// Finds the lettering among the painted and selected shapes.
pub(crate) fn lettering(drawing: &Drawing, selection: &Selection) -> Lettering {
    let selected = drawing.selected_parts(selection);
    let shapes = drawing.shapes();
    let lines = selected_lines(drawing, &selected);
    let outline = |l: &PlacedLetter| {
        let pieces = l.subpaths.iter().flat_map(|(i, r)| shapes[*i].outline.subpaths.get(r.clone()));
        Outline { subpaths: pieces.flatten().cloned().collect() }
    };
    let letters = lines.iter().flat_map(|l| &l.letters);
    let letters = letters.map(|l| param::Letter {
        name: l.name.clone(),
        origin: l.origin,
        advance: l.advance,
        outline: outline(l),
    });
    let letters = letters.collect();
    let mut lettered = vec![false; shapes.len()];
    for (i, _) in lines.iter().flat_map(|l| &l.letters).flat_map(|l| &l.subpaths) {
        lettered[*i] = true;
    }
    let scene = drawing.scene();
    let owners: Vec<ElementId> = lines.iter().filter_map(|l| l.owner).collect();
    let belongs = |i: usize| lettered[i] || scene.parts[i].owner.is_some_and(|o| owners.contains(&o));
    let is_all = (0..lettered.len()).all(|i| belongs(i) || !selected[i] || !shapes[i].painted)
        && scene.bitmaps.is_empty()
        && !lines.is_empty();
    Lettering { lines, letters, is_all }
}

/// The lines, with the letters whose parts are all painted and selected.
fn selected_lines(drawing: &Drawing, selected: &[bool]) -> Vec<TextLine> {
    let shapes = drawing.shapes();
    let whole = |l: &PlacedLetter| l.subpaths.iter().all(|(i, _)| selected[*i] && shapes[*i].painted);
    let lines = drawing
        .lines()
        .iter()
        .map(|line| TextLine { letters: line.letters.iter().filter(|l| whole(l)).cloned().collect(), ..line.clone() });
    lines.filter(|l| !l.letters.is_empty()).collect()
}

/// Lists the letters in every part.
pub(crate) fn letters_by_part(drawing: &Drawing, selection: &Selection) -> Vec<Vec<LetterSubpaths>> {
    let mut out = vec![Vec::new(); drawing.scene().parts.len()];
    let lines = selected_lines(drawing, &drawing.selected_parts(selection));
    for (letter, l) in lines.iter().flat_map(|l| &l.letters).enumerate() {
        for (i, range) in &l.subpaths {
            out[*i].push(LetterSubpaths { letter, range: range.clone() });
        }
    }
    out
}
