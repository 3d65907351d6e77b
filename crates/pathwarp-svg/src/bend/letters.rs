//! Letters that are placed one by one, each by an affine map of its own, instead of going through the map as a whole.

use crate::bend::options::WarpOptions;
use crate::document::Document;
use pathwarp::Outline;
use pathwarp::kurbo::Affine;
use pathwarp::map::Chain;
use std::fmt;
use std::ops::Range;

/// Where letters go.
#[derive(Clone, Default)]
pub struct LetterPlaces {
    /// For every letter of [`Lettering::letters`](crate::Lettering::letters) the affine maps that give its copies. Empty: letters
    /// go through the map like everything else.
    pub places: Vec<Vec<Affine>>,
    /// What they go through from there: the steps that follow.
    pub after: Chain,
}

impl fmt::Debug for LetterPlaces {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "LetterPlaces({} letters)", self.places.len())
    }
}

impl PartialEq for LetterPlaces {
    fn eq(&self, other: &Self) -> bool {
        let (a, b) = (self.after.steps(), other.after.steps());
        self.places == other.places && a.len() == b.len() && a.iter().zip(b).all(|(a, b)| std::sync::Arc::ptr_eq(a, b))
    }
}

/// The subpaths of a part that belong to one letter, and where they go.
#[derive(Debug, Clone)]
pub(crate) struct Piece {
    pub(crate) range: Range<usize>,
    pub(crate) places: Vec<Affine>,
}

impl Piece {
    /// Its subpaths of `whole`.
    pub(crate) fn of(&self, whole: &Outline) -> Outline {
        Outline { subpaths: whole.subpaths.get(self.range.clone()).unwrap_or_default().to_vec() }
    }
}

/// All the pieces' images.
pub(crate) fn placed(whole: &Outline, pieces: &[Piece]) -> Outline {
    Outline { subpaths: pieces.iter().flat_map(|p| p.of(whole).repeated(&p.places).subpaths).collect() }
}

impl Document {
    /// For every part the pieces it is placed in; none where it goes through the map.
    pub(crate) fn pieces(&self, options: &WarpOptions) -> Vec<Vec<Piece>> {
        let places = &options.letters.places;
        if places.is_empty() {
            return vec![Vec::new(); self.scene().parts.len()];
        }
        let piece = |(k, range): (usize, Range<usize>)| {
            Some(Piece { range, places: places.get(k).filter(|p| !p.is_empty())?.clone() })
        };
        self.letters_by_part(&options.selection)
            .into_iter()
            .map(|of_part| of_part.into_iter().filter_map(piece).collect())
            .collect()
    }

    /// The shapes that [`Document::selected`] gives, in its order, as they are after the first step if their letters are placed
    /// one by one.
    #[must_use]
    pub fn placed(&self, options: &WarpOptions) -> Vec<Option<Outline>> {
        let meant = self.meant(&options.selection);
        let chosen =
            self.shapes().iter().zip(meant).zip(self.pieces(options)).filter(|((s, meant), _)| *meant && s.painted);
        chosen.map(|((s, _), pieces)| (!pieces.is_empty()).then(|| placed(&s.outline, &pieces))).collect()
    }
}
