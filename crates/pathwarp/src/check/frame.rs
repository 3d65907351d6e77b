//! The frame of checks.

use crate::param::Frame;
use kurbo::Rect;

/// Returns the frame of checks, demos and cases: 0,0,100,100.
#[must_use]
pub fn frame() -> Frame {
    Frame::new(Rect::new(0.0, 0.0, 100.0, 100.0))
}
