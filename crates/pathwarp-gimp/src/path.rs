//! GIMP's model of a path.

/// A path: a named list of strokes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GimpPath {
    /// Its name, unique in an image.
    pub name: String,
    /// Whether GIMP shows it.
    pub visible: bool,
    /// Its strokes, in order.
    pub strokes: Vec<Stroke>,
}

/// A connected run of anchors with their handles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stroke {
    /// Whether the last anchor is joined to the first.
    pub closed: bool,
    /// Control points in pixels, y down: for every anchor its incoming handle, itself, its outgoing handle. XCF holds single
    /// precision, which is kept here without change.
    pub points: Vec<[f64; 2]>,
}

impl Stroke {
    /// How many anchors it has.
    #[must_use]
    pub fn anchors(&self) -> usize {
        self.points.len() / 3
    }
}

impl GimpPath {
    /// The box (left, top, right, bottom) of the curves; `None` for a path without anchors.
    #[must_use]
    pub fn bounds(&self) -> Option<[f64; 4]> {
        self.outline().bounding_box().map(|b| [b.x0, b.y0, b.x1, b.y1])
    }
}
