//! Deformations: a typed constructor for each, and the registry that builds them from text.
//!
//! Every deformation is a type with a constructor, chainable setters and `build`, such as [`Shaper`], [`Bend`] or [`Wave`].
//! `build` returns a [`Built`]: the [`map`](Built::map), with notes, warnings and guides for the user. Plain numbers are user
//! units, angles are degrees, clockwise on the screen, and boxes named `frame` are the artwork's.
//!
//! The [`Registry`] holds the same deformations as entries ([`Deformation`]) that read their parameters from text, as the command
//! line and recipes do. Programs add further entries with [`Registry::with`].
//!
//! To add one to this crate, run `cargo xtask new-deformation NAME`, which writes `NAME.rs` and three lines here.

mod affine;
mod anamorph;
mod bend;
mod bilinear;
mod birational;
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
#[cfg(feature = "serde")]
mod warp;
mod wave;
#[cfg(feature = "serde")]
mod wordart;

pub use affine::Affine;
pub use anamorph::{Anamorph, Mirror, MirrorShape, Onto};
pub use bend::{Align, Bend, LetterSetting, Stretch};
pub use bilinear::Bilinear;
pub use birational::Birational;
pub use bulge::Bulge;
pub use entry::{
    Built, ByHand, Case, Deformation, Example, Explanation, Failure, Gallery, Guides, Hidden, InSpace, Info, Instead,
    Law, Overlay, Pairs, Place, Placement, Role, SavedFile, Seam, SightMark, SpaceFile, Undefined, Variant,
};
pub use envelope::{Envelope, Keep, Lines, Spread};
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
#[cfg(feature = "serde")]
pub use warp::{Style, Warp};
pub use wave::Wave;
#[cfg(feature = "serde")]
pub use wordart::{ShapeBox, TextShape, WordArt};

use std::sync::Arc;

/// Returns the deformations of this crate, in the order of `pathwarp list`.
pub(crate) fn builtin() -> Vec<Arc<dyn Deformation>> {
    vec![
        Arc::new(shaper::ENTRY),
        Arc::new(envelope::ENTRY),
        #[cfg(feature = "serde")]
        Arc::new(warp::ENTRY),
        #[cfg(feature = "serde")]
        Arc::new(wordart::ENTRY),
        Arc::new(bilinear::ENTRY),
        Arc::new(birational::ENTRY),
        Arc::new(bend::ENTRY),
        Arc::new(polar::ENTRY),
        Arc::new(ffd::ENTRY),
        Arc::new(mesh::ENTRY),
        Arc::new(triangle::ENTRY),
        Arc::new(mls::ENTRY),
        Arc::new(projective::ENTRY),
        Arc::new(anamorph::ENTRY),
        Arc::new(wave::ENTRY),
        Arc::new(swirl::ENTRY),
        Arc::new(bulge::ENTRY),
        Arc::new(lens::ENTRY),
        Arc::new(mobius::ENTRY),
        Arc::new(expr::ENTRY),
        Arc::new(similitude::ENTRY),
        Arc::new(affine::ENTRY),
    ]
}
