//! The box to which percentages refer.

use super::{Axis, Letter};
use kurbo::{Point, Rect};
use std::sync::Arc;

/// The box to which percentages refer: the bounding box of the artwork, the view box, or a box named by the user. Root user
/// units, y down.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// The box.
    pub rect: Rect,
    /// The y coordinate of the baseline if the box belongs to lettering. Deformations along a curve place it on the curve by
    /// default.
    pub baseline: Option<f64>,
    /// The known letters of the artwork. Empty if there are none, or if their baseline is not horizontal.
    pub letters: Arc<[Letter]>,
}

impl Frame {
    /// A frame without lettering.
    #[must_use]
    pub fn new(rect: Rect) -> Self {
        Self { rect: rect.abs(), baseline: None, letters: Arc::new([]) }
    }

    /// Adds letters.
    #[must_use]
    pub fn with_letters(self, letters: Arc<[Letter]>) -> Self {
        Self { letters, ..self }
    }

    /// Sets the baseline of the lettering to `y`.
    #[must_use]
    pub fn on_baseline(self, y: f64) -> Self {
        Self { baseline: Some(y), ..self }
    }

    /// The length of 100 % along `axis`, in user units.
    #[must_use]
    pub fn extent(&self, axis: Axis) -> f64 {
        match axis {
            Axis::X => self.rect.width(),
            Axis::Y => self.rect.height(),
            Axis::Diagonal => self.rect.width().hypot(self.rect.height()),
        }
    }

    /// The four corners: bottom left, bottom right, top right, top left as seen on the screen.
    #[must_use]
    pub fn corners(&self) -> [Point; 4] {
        let r = self.rect;
        [Point::new(r.x0, r.y1), Point::new(r.x1, r.y1), Point::new(r.x1, r.y0), Point::new(r.x0, r.y0)]
    }
}
