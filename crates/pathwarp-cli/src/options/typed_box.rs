//! A box as typed, `X,Y,W,H`.

use pathwarp::kurbo::{Point, Rect, Size};
use pathwarp::param::{Axis, Frame, Length};

/// Position and size as typed; none is a percentage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TypedBox(pub(super) [Length; 4]);

impl TypedBox {
    /// The box in user units of a drawing.
    pub(crate) fn rect(&self, units_per_px: [f64; 2]) -> Rect {
        let scale = Frame::new(Rect::ZERO).with_units_per_px(units_per_px);
        let [x, y, w, h] = self.0;
        let (x, y) = (x.in_units(Axis::X, &scale), y.in_units(Axis::Y, &scale));
        Rect::from_origin_size(Point::new(x, y), Size::new(w.in_units(Axis::X, &scale), h.in_units(Axis::Y, &scale)))
    }
}
