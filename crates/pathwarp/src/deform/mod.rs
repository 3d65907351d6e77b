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

pub use affine::Affine;
pub use anamorph::{Anamorph, Onto};
pub use bend::{Align, Bend, LetterSetting, Stretch};
pub use bilinear::Bilinear;
pub use birational::Birational;
pub use built::{Built, Explanation, InSpace, Overlay, Placement, Role, SavedFile, Seam, SpaceFile};
pub use bulge::Bulge;
pub use entry::{Case, Deformation, Example, Gallery, Info, Law, Pairs};
pub use envelope::{Envelope, Keep, Spread};
pub use expr::Expr;
pub use ffd::Ffd;
pub use lens::{Lens, LensModel};
pub use mesh::Mesh;
pub use mls::{Mls, Stiffness};
pub use mobius::Mobius;
pub use polar::Polar;
pub use projective::Projective;
pub use registry::Registry;
pub use shaper::Shaper;
pub use similitude::Similitude;
pub use swirl::{Falloff, Swirl};
pub use triangle::Triangle;
pub use warp::{Style, Warp};
pub use wave::Wave;
pub use wordart::{TextShape, WordArt};

use std::sync::Arc;

/// The deformations of this crate, in the order `pathwarp list` shows them.
pub(crate) fn builtin() -> Vec<Arc<dyn Deformation>> {
    vec![
        Arc::new(shaper::Entry),
        Arc::new(envelope::Entry),
        Arc::new(warp::Entry),
        Arc::new(wordart::Entry),
        Arc::new(bilinear::Entry),
        Arc::new(birational::Entry),
        Arc::new(bend::Entry),
        Arc::new(polar::Entry),
        Arc::new(ffd::Entry),
        Arc::new(mesh::Entry),
        Arc::new(triangle::Entry),
        Arc::new(mls::Entry),
        Arc::new(projective::Entry),
        Arc::new(anamorph::Entry),
        Arc::new(wave::Entry),
        Arc::new(swirl::Entry),
        Arc::new(bulge::Entry),
        Arc::new(lens::Entry),
        Arc::new(mobius::Entry),
        Arc::new(expr::Entry),
        Arc::new(similitude::Entry),
        Arc::new(affine::Entry),
    ]
}
