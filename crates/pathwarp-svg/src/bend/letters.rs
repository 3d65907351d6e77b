//! Letters that are placed one by one, each by an affine map, instead of being bent by the map as a whole.

use super::options::WarpOptions;
use crate::scene::drawing::Drawing;
use crate::scene::lettering::selected::{LetterSubpaths, letters_by_part};
use pathwarp::Outline;
use pathwarp::kurbo::Affine;
use std::ops::Range;

/// The subpaths of a part that belong to one letter, with the letter's places.
#[derive(Debug, Clone)]
pub(crate) struct LetterPiece {
    range: Range<usize>,
    pub(crate) places: Vec<Affine>,
}

impl LetterPiece {
    /// The letter's subpaths of `whole`.
    pub(crate) fn of(&self, whole: &Outline) -> Outline {
        Outline { subpaths: whole.subpaths.get(self.range.clone()).unwrap_or_default().to_vec() }
    }

    /// The index in `whole` of the letter's first subpath.
    pub(crate) fn first(&self) -> usize {
        self.range.start
    }

    /// What holds for the letter's subpaths of `whole`, for each of its places.
    pub(crate) fn repeated(&self, whole: &[f64]) -> Vec<f64> {
        whole.get(self.range.clone()).unwrap_or_default().repeat(self.places.len())
    }
}

/// Places all letters of an outline.
pub(crate) fn placed(whole: &Outline, pieces: &[LetterPiece]) -> Outline {
    Outline { subpaths: pieces.iter().flat_map(|p| p.of(whole).repeated(&p.places).subpaths).collect() }
}

/// Lists the placed letters of every part; empty for parts that the map bends.
pub(crate) fn pieces(drawing: &Drawing, options: &WarpOptions) -> Vec<Vec<LetterPiece>> {
    let places = &options.letters.places;
    if places.is_empty() {
        return vec![Vec::new(); drawing.scene().parts.len()];
    }
    let piece = |l: LetterSubpaths| {
        let places = places.get(l.letter).filter(|p| !p.is_empty())?.clone();
        Some(LetterPiece { range: l.range, places })
    };
    letters_by_part(drawing, options.letters.of.as_ref().unwrap_or(&options.selection))
        .into_iter()
        .map(|of_part| of_part.into_iter().filter_map(piece).collect())
        .collect()
}

/// For the selected painted shapes in order, the outline with its letters placed, if there are any.
pub(crate) fn placed_outlines(drawing: &Drawing, options: &WarpOptions) -> Vec<Option<Outline>> {
    let selected = drawing.selected_parts(&options.selection);
    let shapes = drawing.shapes().iter().zip(selected).zip(pieces(drawing, options));
    let chosen = shapes.filter(|((s, selected), _)| *selected && s.painted);
    chosen.map(|((s, _), pieces)| (!pieces.is_empty()).then(|| placed(&s.outline, &pieces))).collect()
}
