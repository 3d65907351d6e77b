//! Placement of single letters, as an option.

use crate::source::select::Selection;
use pathwarp::kurbo::Affine;
use pathwarp::map::Chain;
use std::fmt;

/// Placement of letters one by one.
#[derive(Clone, Default)]
pub struct LetterPlaces {
    /// Affine maps to the copies of each letter of [`Lettering::letters`](crate::Lettering::letters). Empty: the letters are
    /// bent like everything else.
    pub places: Vec<Vec<Affine>>,
    /// The selection whose letters those are. `None`: what is bent.
    pub of: Option<Selection>,
    /// Map applied to the placed letters: the remaining steps.
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
        self.places == other.places
            && self.of == other.of
            && a.len() == b.len()
            && a.iter().zip(b).all(|(a, b)| std::sync::Arc::ptr_eq(a, b))
    }
}
