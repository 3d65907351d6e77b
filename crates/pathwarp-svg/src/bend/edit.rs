//! What may be done to shapes instead of bending them.

use crate::scene::model::{Part, PartRole};
use crate::source::tags::ElementId;
use crate::source::text::SourceText;
use pathwarp::edit::{Offset, moved, through_vertices};
use pathwarp::refit::{self, RefittedPath};
use pathwarp::{GeometryError, Outline};

/// What is done to the selected shapes instead of bending them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Edit {
    /// Paths get the fewest nodes within the tolerance. A path that would not get fewer stays as it is written.
    Simplify {
        /// Joints that turn by more than this, in radians, stay corners.
        corner: f64,
        /// Contours of straight lines become curves through their vertices.
        polylines: bool,
    },
    /// Strokes and text become filled outlines.
    Outline,
    /// Areas grow or shrink, and open paths run beside themselves. Areas follow the rule of the fill.
    Offset(Offset),
}

impl Edit {
    /// The same edit of a part.
    pub(super) fn of(self, part: &Part) -> Self {
        match self {
            Self::Offset(offset) => {
                let even_odd = part.fill.as_ref().is_some_and(|f| f.rule() == usvg::FillRule::EvenOdd);
                Self::Offset(Offset { even_odd, ..offset })
            }
            other => other,
        }
    }

    /// The outline in a way that is no map; `None` if the outline is refitted.
    pub(super) fn edited(
        self,
        outline: &Outline,
        options: &refit::Options,
        contours: &[f64],
    ) -> Result<Option<RefittedPath>, GeometryError> {
        match self {
            Self::Simplify { polylines: true, .. } => through_vertices(outline, options, contours),
            Self::Offset(offset) => moved(outline, &offset, options).map(Some),
            Self::Simplify { .. } | Self::Outline => Ok(None),
        }
    }

    /// Returns `true` if a part may change.
    pub(super) fn concerns(self, part: &Part, source: &SourceText) -> bool {
        let tag = |e: Option<ElementId>| e.map_or("", |e| &*source.elements[e].tag);
        match self {
            // Of other elements, none has fewer nodes as a path.
            Self::Simplify { .. } => {
                part.owner.is_none() && matches!(tag(part.source), "path" | "polygon" | "polyline")
            }
            Self::Outline => part.stroke.is_some() || tag(part.owner) == "text",
            Self::Offset(_) => part.role == PartRole::Paint && part.painted(),
        }
    }
}
