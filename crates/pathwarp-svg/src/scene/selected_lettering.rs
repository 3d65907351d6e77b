//! Finds the selected lettering of a drawing, and makes frames around it.

use super::drawing::Drawing;
use super::lettering::{Heights, PlacedLetter, TextLine};
use crate::source::elements::ElementId;
use crate::source::select::Selection;
use pathwarp::Outline;
use pathwarp::kurbo::Rect;
use pathwarp::param::{self, Frame};
use std::collections::BTreeMap;
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

    /// Returns `true` if there is lettering and every baseline is horizontal, so that frames can be made.
    #[must_use]
    pub fn is_level(&self) -> bool {
        !self.lines.is_empty() && self.lines.iter().all(|l| l.is_level)
    }

    /// Returns `true` if the selected artwork consists of lettering only, and the drawing has no bitmaps.
    #[must_use]
    pub fn is_all(&self) -> bool {
        self.is_all
    }

    /// Makes a frame around the lettering. Horizontally, it extends from the leftmost start to the rightmost end of a line; vertically, by
    /// `kind` over all lines: for [`BaselineAscent`](LetteringFrame::BaselineAscent), from the lowest baseline to the highest ascent.
    ///
    /// # Errors
    /// [`LetteringFrameError::NoLettering`] without lines, [`LetteringFrameError::NotLevel`] if a baseline is not horizontal,
    /// [`LetteringFrameError::NoOutlines`] if letters have no ink, [`LetteringFrameError::NoHeight`] if the font lacks the height.
    pub fn frame(&self, kind: LetteringFrame) -> Result<Frame, LetteringFrameError> {
        if self.lines.is_empty() {
            return Err(LetteringFrameError::NoLettering);
        }
        if let Some(l) = self.lines.iter().find(|l| !l.is_level) {
            return Err(LetteringFrameError::NotLevel { line: l.name.clone() });
        }
        let min = |y: &dyn Fn(&TextLine) -> f64| self.lines.iter().map(y).fold(f64::INFINITY, f64::min);
        let max = |y: &dyn Fn(&TextLine) -> f64| -min(&|l| -y(l));
        let baseline = max(&|l| l.start.y);
        let above = |height: fn(&Heights) -> f64| min(&|l| l.start.y - height(&l.heights));
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

/// The lettering among the painted and selected shapes.
pub(crate) fn lettering(drawing: &Drawing, selection: &Selection) -> Lettering {
    let selected = drawing.selected_parts(selection);
    let shapes = drawing.shapes();
    let lines = selected_lines(drawing, &selected);
    let outline = |l: &PlacedLetter| {
        let pieces = l.subpaths.iter().flat_map(|(i, r)| shapes[*i].outline.subpaths.get(r.clone()));
        Outline { subpaths: pieces.flatten().cloned().collect() }
    };
    let placed = || lines.iter().flat_map(|l| &l.letters);
    let letter = |l: &PlacedLetter| l.with_outline(outline(l));
    let letters = placed().map(letter).collect();
    let mut draws_letters = vec![false; shapes.len()];
    placed().flat_map(|l| &l.subpaths).for_each(|(i, _)| draws_letters[*i] = true);
    let scene = drawing.scene();
    let owners: Vec<ElementId> = lines.iter().filter_map(|l| l.owner).collect();
    let belongs = |i: usize| draws_letters[i] || scene.parts[i].owner.is_some_and(|o| owners.contains(&o));
    let is_all = (0..shapes.len()).all(|i| belongs(i) || !selected[i] || !shapes[i].painted)
        && scene.bitmaps.is_empty()
        && !lines.is_empty();
    Lettering { lines, letters, is_all }
}

/// The lines that keep a letter, each with only the letters whose parts are all painted and selected.
fn selected_lines(drawing: &Drawing, selected: &[bool]) -> Vec<TextLine> {
    let shapes = drawing.shapes();
    let is_whole = |l: &&PlacedLetter| l.subpaths.iter().all(|(i, _)| selected[*i] && shapes[*i].painted);
    let letters = |line: &TextLine| line.letters.iter().filter(is_whole).cloned().collect();
    let lines = drawing.lines().iter().map(|line| TextLine { letters: letters(line), ..line.clone() });
    lines.filter(|l| !l.letters.is_empty()).collect()
}

/// Limit on objects, since more members of one group are hardly meant as objects.
const MAX_OBJECTS: usize = 10_000;

/// Finds the objects among the painted and selected shapes, from left to right: each selected element or, if the whole drawing is selected,
/// each member of the outermost group that has several. Members whose boxes overlap are one object.
pub(crate) fn objects(drawing: &Drawing, selection: &Selection) -> Vec<PlacedLetter> {
    let (source, shapes) = (&drawing.source, drawing.shapes());
    let selected = drawing.selected_parts(selection);
    let parts = drawing.scene().parts.iter().zip(shapes).zip(selected).enumerate();
    let parts = parts.filter(|(_, ((_, s), selected))| *selected && s.painted);
    // From the root to each part.
    let paths: Vec<(usize, Vec<ElementId>)> = parts
        .filter_map(|(i, ((p, _), _))| {
            let mut path: Vec<ElementId> = source.ancestors(p.element()?).collect();
            path.reverse();
            Some((i, path))
        })
        .collect();
    let elements = selection.resolve(source);
    let is_whole = elements.first() == Some(&true);
    // The outermost level on which the paths of two parts differ.
    let differs = |k: usize| paths.windows(2).any(|w| w[0].1.get(k) != w[1].1.get(k));
    let longest = paths.iter().map(|p| p.1.len()).max().unwrap_or_default();
    let level = (0..longest).find(|k| differs(*k)).unwrap_or(longest);
    let mut found: BTreeMap<ElementId, (Rect, Vec<usize>)> = BTreeMap::new();
    for (i, path) in &paths {
        let Some(bounds) = shapes[*i].outline.bounding_box().filter(Rect::is_finite) else { continue };
        let selected = path.iter().find(|e| !is_whole && elements[**e]);
        let object = selected.copied().unwrap_or(path[level.min(path.len() - 1)]);
        let (all, parts) = found.entry(object).or_insert((bounds, Vec::new()));
        *all = all.union(bounds);
        parts.push(*i);
    }
    let mut found: Vec<_> = found.into_iter().map(|(e, (bounds, parts))| (bounds, parts, e)).collect();
    if found.len() > MAX_OBJECTS {
        return Vec::new();
    }
    found.sort_by(|a, b| a.0.x0.total_cmp(&b.0.x0));
    // Objects whose boxes do not overlap.
    let mut apart: Vec<(Rect, Vec<usize>, ElementId)> = Vec::new();
    for mut next in found {
        while let Some(k) = apart.iter().rposition(|o| is_whole && o.0.overlaps(next.0)) {
            let other = apart.remove(k);
            next = (next.0.union(other.0), [other.1, next.1].concat(), other.2);
        }
        apart.push(next);
    }
    apart.sort_by(|a, b| a.0.x0.total_cmp(&b.0.x0));
    let object = |(b, parts, element): (Rect, Vec<usize>, ElementId)| PlacedLetter {
        name: source.display_name(element),
        // Objects have no baseline, and form one line.
        origin: (b.x0, 0.0).into(),
        advance: b.width(),
        subpaths: parts.into_iter().map(|i| (i, 0..shapes[i].outline.subpaths.len())).collect(),
    };
    apart.into_iter().map(object).collect()
}

/// For every part, its letters or, if `of_objects` is `true`, the objects that it belongs to.
pub(crate) fn letters_by_part(drawing: &Drawing, selection: &Selection, of_objects: bool) -> Vec<Vec<LetterSubpaths>> {
    let mut out = vec![Vec::new(); drawing.scene().parts.len()];
    let letters: Vec<PlacedLetter> = if of_objects {
        objects(drawing, selection)
    } else {
        let lines = selected_lines(drawing, &drawing.selected_parts(selection));
        lines.into_iter().flat_map(|l| l.letters).collect()
    };
    for (letter, l) in letters.iter().enumerate() {
        for (i, range) in &l.subpaths {
            out[*i].push(LetterSubpaths { letter, range: range.clone() });
        }
    }
    out
}
