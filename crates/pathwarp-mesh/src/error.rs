//! Errors of making a mesh.

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
    /// The shape needs too many triangles or points.
    #[error("{shape} would need more than {most} triangles or points")]
    TooMany {
        /// Name of the shape.
        shape: String,
        /// The limit.
        most: usize,
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
