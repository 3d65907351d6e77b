//! Cuts away the part of a drawing that other parts hide in its image.

use super::task::PartTask;
use super::united::AREA_SHARE;
use crate::scene::model::PartRole;
use pathwarp::edit::Area;
use pathwarp::kurbo::Rect;
use pathwarp::{GeometryError, Outline};
use std::sync::Arc;
use usvg::FillRule;

impl PartTask<'_> {
    /// Cuts the hidden part out of the outline to bend: out of the area of a fill without a stroke, otherwise out of the line.
    pub(super) fn without_hidden(mut self) -> Result<Self, GeometryError> {
        let Some(hidden) = self.hidden else { return Ok(self) };
        let seen = match self.seen_fill()? {
            Some(fill) if self.part.stroke.is_none() => fill,
            _ => hidden.lines_outside(&self.outline, AREA_SHARE * self.finest),
        };
        (self.outline, self.contours) = (Arc::new(seen), Vec::new());
        Ok(self)
    }

    /// Returns the area of the fill without what is hidden; `None` if there is no fill or nothing of it is hidden.
    pub(super) fn seen_fill(&self) -> Result<Option<Outline>, GeometryError> {
        let fill = self.part.fill.as_ref();
        let even_odd = fill.is_some_and(|f| f.rule() == FillRule::EvenOdd);
        let has_area = fill.is_some() || self.part.role == PartRole::Clip;
        self.hidden.filter(|_| has_area).map(|hidden| self.seen_area(hidden, &self.whole, even_odd)).transpose()
    }

    /// Returns an area without its hidden part.
    pub(super) fn seen_area(&self, hidden: &Area, outline: &Outline, even_odd: bool) -> Result<Outline, GeometryError> {
        let fine = AREA_SHARE * self.finest;
        Ok(Area::of(outline, even_odd, fine)?.difference(hidden, fine)?.outline().clone())
    }
}

/// Returns `true` if the boxes of a part and of the hidden area meet.
pub(super) fn meet(part: Option<Rect>, hidden: &Area) -> bool {
    part.zip(hidden.outline().bounding_box()).is_some_and(|(a, b)| a.overlaps(b))
}
