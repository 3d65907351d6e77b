//! Curved surfaces: Bézier patches and NURBS, rational or not, with trimming curves; their files, their exact images, and refitting
//! where an exact image would be of too high a degree.

mod bernstein;
mod bezier;
pub mod bpt;
mod compose;
mod crossing;
mod cut;
mod deform;
pub mod json;
mod knots;
mod layers;
mod part;
mod refit;
mod side;
mod surface;
mod tessellate;
mod trims;

pub use bezier::{BezierPatch, MAX_DEGREE};
pub use deform::{DeformedPatches, PatchError, deform_patches};
pub use surface::{Surface, TrimCurve};
pub use tessellate::{tessellate, tessellate_image};
