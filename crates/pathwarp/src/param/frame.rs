//! The box to which percentages refer.

use super::{Axis, Letter};
use kurbo::{Point, Rect};
use std::sync::Arc;

/// The box to which percentages refer: the bounding box of the artwork, the view box, or a box named by the user. Coordinates are in
/// root user units, y down.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// The box.
    pub rect: Rect,
    /// The y coordinate of the baseline if the box belongs to lettering. Deformations along a curve put it on the curve by default.
    pub baseline: Option<f64>,
    /// User units per px along x and y: 1 unless the drawing's `viewBox` scales it. Lengths with units refer to px.
    pub units_per_px: [f64; 2],
    /// The known letters of the artwork. Empty if there are none, or if their baseline is not horizontal.
    pub letters: Arc<[Letter]>,
    /// The objects of the artwork from left to right, as letters without outlines. Empty if they are not known.
    pub objects: Arc<[Letter]>,
    /// Points along the artwork, at which distortion is visible, for deformations that ask for [letters](Self::letters). Empty if
    /// they are not known.
    pub ink: Arc<[Point]>,
    /// The page of the drawing, to which circles and arcs may refer (`cx=50%page`); `None` if there is none.
    pub page: Option<Rect>,
}

impl Frame {
    /// Creates a frame without lettering.
    #[must_use]
    pub fn new(rect: Rect) -> Self {
        let (letters, objects, ink) = Default::default();
        Self { rect: rect.abs(), baseline: None, units_per_px: [1.0; 2], letters, objects, ink, page: None }
    }

    setters! {
        /// Adds letters.
        with_letters(letters: Arc<[Letter]>) => letters: letters;
        /// Adds objects.
        with_objects(objects: Arc<[Letter]>) => objects: objects;
        /// Sets the user units per px along x and y.
        with_units_per_px(units_per_px: [f64; 2]) => units_per_px: units_per_px;
        /// Sets the page.
        with_page(page: Rect) => page: Some(page);
        /// Sets the baseline of the lettering to `y`.
        on_baseline(y: f64) => baseline: Some(y);
    }

    /// Returns the length of a px along `axis`, in user units; along the diagonal, the root mean square, as in SVG.
    #[must_use]
    pub fn px(&self, axis: Axis) -> f64 {
        let [x, y] = self.units_per_px;
        match axis {
            Axis::X => x,
            Axis::Y => y,
            Axis::Diagonal => x.hypot(y) / std::f64::consts::SQRT_2,
        }
    }

    /// Returns the length of 100 % along `axis`, in user units.
    #[must_use]
    pub fn extent(&self, axis: Axis) -> f64 {
        match axis {
            Axis::X => self.rect.width(),
            Axis::Y => self.rect.height(),
            Axis::Diagonal => self.rect.width().hypot(self.rect.height()),
        }
    }

    /// Returns the four corners as seen on the screen: bottom left, bottom right, top right, top left.
    #[must_use]
    pub fn corners(&self) -> [Point; 4] {
        let r = self.rect;
        [Point::new(r.x0, r.y1), Point::new(r.x1, r.y1), Point::new(r.x1, r.y0), Point::new(r.x0, r.y0)]
    }
}
