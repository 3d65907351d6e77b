//! The deformations: one file each, and this list of them.
//!
//! To add one, write `NAME.rs` and two lines here (`cargo xtask new-deformation NAME` does both).

mod affine;
mod anamorph;
mod bend;
mod bilinear;
mod birational;
mod built;
mod bulge;
mod entry;
mod envelope;
mod expr;
mod ffd;
mod lens;
mod mesh;
mod mls;
mod mobius;
mod polar;
mod projective;
mod registry;
mod shaper;
mod similitude;
mod swirl;
mod triangle;
mod warp;
mod wave;
mod wordart;

pub use built::{Built, Explanation, InSpace, Overlay, Placement, Role, SavedFile, Seam, SpaceFile};
pub use entry::{Case, Deformation, Example, Info, Law, Pairs};
pub use registry::Registry;
pub use warp::Style;
pub use wordart::TextShape;

use std::sync::Arc;

/// The deformations of this crate, in the order `pathwarp list` shows them.
pub(crate) fn builtin() -> Vec<Arc<dyn Deformation>> {
    vec![
        Arc::new(shaper::Shaper),
        Arc::new(envelope::Envelope),
        Arc::new(warp::Warp),
        Arc::new(wordart::WordArt),
        Arc::new(bilinear::Bilinear),
        Arc::new(birational::BirationalDeformation),
        Arc::new(bend::Bend),
        Arc::new(polar::Polar),
        Arc::new(ffd::Ffd),
        Arc::new(mesh::Mesh),
        Arc::new(triangle::Triangle),
        Arc::new(mls::Mls),
        Arc::new(projective::Projective),
        Arc::new(anamorph::Anamorph),
        Arc::new(wave::Wave),
        Arc::new(swirl::Swirl),
        Arc::new(bulge::Bulge),
        Arc::new(lens::Lens),
        Arc::new(mobius::Mobius),
        Arc::new(expr::Expr),
        Arc::new(similitude::Similitude),
        Arc::new(affine::AffineDeformation),
    ]
}
