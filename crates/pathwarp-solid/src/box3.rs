//! Boxes in space.

use glam::DVec3;

/// A box with edges along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Box3 {
    /// The corner at the left, bottom and back.
    pub min: DVec3,
    /// The corner at the right, top and front.
    pub max: DVec3,
}

impl Box3 {
    /// The smallest box around two points.
    #[must_use]
    pub fn new(a: DVec3, b: DVec3) -> Self {
        Self { min: a.min(b), max: a.max(b) }
    }

    /// The smallest box around points; `None` if there are none that are finite.
    #[must_use]
    pub fn around(points: impl IntoIterator<Item = DVec3>) -> Option<Self> {
        let finite = points.into_iter().filter(|p| p.is_finite());
        finite.map(|p| Self { min: p, max: p }).reduce(|a, b| Self { min: a.min.min(b.min), max: a.max.max(b.max) })
    }

    /// Width, height and depth.
    #[must_use]
    pub fn size(&self) -> DVec3 {
        self.max - self.min
    }

    /// The middle.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// The length of the diagonal.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        self.size().length()
    }

    /// Returns `true` if `p` is inside or on the boundary.
    #[must_use]
    pub fn contains(&self, p: DVec3) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }

    /// The box with every face moved outwards by `by`.
    #[must_use]
    pub fn inflate(&self, by: DVec3) -> Self {
        Self { min: self.min - by, max: self.max + by }
    }

    /// The eight corners; x changes fastest.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, a: f64, b: f64| if i & bit == 0 { a } else { b };
            DVec3::new(
                pick(1, self.min.x, self.max.x),
                pick(2, self.min.y, self.max.y),
                pick(4, self.min.z, self.max.z),
            )
        })
    }
}
