//! GIMP's paths and strokes.

/// A named list of strokes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GimpPath {
    /// The name, unique in an image.
    pub name: String,
    /// Visibility in GIMP.
    pub visible: bool,
    /// The strokes, in order.
    pub strokes: Vec<Stroke>,
}

/// A connected sequence of anchors with their handles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stroke {
    /// `true` if the last anchor connects to the first.
    pub closed: bool,
    /// Control points in pixels, y down: for every anchor its incoming handle, the anchor, its outgoing handle. The single
    /// precision of XCF is kept without change.
    pub points: Vec<[f64; 2]>,
}

impl Stroke {
    /// Returns the number of anchors.
    #[must_use]
    pub fn anchors(&self) -> usize {
        self.points.len() / 3
    }
}

impl GimpPath {
    /// Returns the bounding box of the curves (left, top, right, bottom); `None` for a path without anchors.
    #[must_use]
    pub fn bounds(&self) -> Option<[f64; 4]> {
        self.outline().bounding_box().map(|b| [b.x0, b.y0, b.x1, b.y1])
    }
}
