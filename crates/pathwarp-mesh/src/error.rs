//! Errors of making a mesh.

use pathwarp::budget::Exceeded;
use pathwarp::kurbo::Point;
use thiserror::Error;

/// The reason why a mesh cannot be made.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// A point of the shape has no image on the surface.
    #[error("{shape} has no image on the surface at {},{}", at.x, at.y)]
    NoPlace {
        /// Name of the shape.
        shape: String,
        /// The point.
        at: Point,
    },
    /// The shapes need too many triangles or points.
    #[error("{shape} takes {exceeded}, as sides of triangles or of polylines")]
    TooMany {
        /// Name of the shape that exceeds the limit.
        shape: String,
        /// The limit.
        exceeded: Exceeded,
    },
    /// The tessellator failed.
    #[error("{shape} cannot be filled with triangles: {why}")]
    Tessellation {
        /// Name of the shape.
        shape: String,
        /// Message of the tessellator.
        why: String,
    },
}
