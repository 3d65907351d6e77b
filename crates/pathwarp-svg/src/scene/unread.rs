//! Images that a drawing links to and that were not read.

use crate::source::images::shown;
use crate::source::tree::Missed;

/// Links to images that were not read, as they are shown in messages.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct UnreadImages {
    /// Links that lead to nothing readable: missing, damaged, too large.
    pub unreadable: Vec<String>,
    /// Links that lead out of the folder of the drawing, and were not followed.
    pub outside: Vec<String>,
}

impl UnreadImages {
    pub(crate) fn of(missed: &Missed) -> Self {
        let unreadable = missed.images.iter().filter(|l| !missed.outside.contains(l)).map(|l| shown(l).to_owned());
        Self { unreadable: unreadable.collect(), outside: missed.outside.clone() }
    }

    /// Returns `true` if every image was read.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.unreadable.is_empty() && self.outside.is_empty()
    }
}
