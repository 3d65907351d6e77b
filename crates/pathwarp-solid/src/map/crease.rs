//! Creases: surfaces on which a map of space is not smooth, and the boundary of its domain.
//!
//! Both are level sets φ(x, y, z) = 0 in the source, so that a chain can pull the crease of a later map back through the earlier
//! maps, as φ ∘ F.

use glam::DVec3;
use pathwarp::map::CreaseKind;
use std::fmt;
use std::sync::Arc;

/// A continuous function on space whose zero set is a crease.
pub type Level3 = Arc<dyn Fn(DVec3) -> f64 + Send + Sync>;

/// A crease: a level set and the behaviour there.
#[derive(Clone)]
pub struct Crease3 {
    /// The level set. At an edge, the map is defined where it is positive.
    pub level: Level3,
    /// The behaviour of the map at it.
    pub kind: CreaseKind,
}

impl fmt::Debug for Crease3 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Crease3").field("kind", &self.kind).finish_non_exhaustive()
    }
}

/// The creases of a map.
#[derive(Debug, Clone, Default)]
pub struct Creases3 {
    items: Vec<Crease3>,
}

impl Creases3 {
    /// Adds a surface on which the derivative jumps.
    pub fn kink(&mut self, level: impl Fn(DVec3) -> f64 + Send + Sync + 'static) {
        self.push(Crease3 { level: Arc::new(level), kind: CreaseKind::Kink });
    }

    /// Adds a part of the domain's boundary: the map is defined where `level` is positive.
    pub fn edge(&mut self, level: impl Fn(DVec3) -> f64 + Send + Sync + 'static) {
        self.push(Crease3 { level: Arc::new(level), kind: CreaseKind::Edge });
    }

    /// Adds a crease.
    pub fn push(&mut self, crease: Crease3) {
        self.items.push(crease);
    }

    /// The creases, in the order they were added.
    #[must_use]
    pub fn items(&self) -> &[Crease3] {
        &self.items
    }

    /// Returns `true` if the map is defined at `p`.
    #[must_use]
    pub fn defined_at(&self, p: DVec3) -> bool {
        self.items.iter().all(|c| c.kind != CreaseKind::Edge || (c.level)(p) > 0.0)
    }

    /// Returns `true` if a crease separates `p` and `q`, or passes through one of them.
    #[must_use]
    pub fn separate(&self, p: DVec3, q: DVec3) -> bool {
        self.items.iter().any(|c| (c.level)(p) * (c.level)(q) <= 0.0)
    }
}
