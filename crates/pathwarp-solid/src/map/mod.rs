//! Maps of space: the result of a deformation once its parameters are known.
//!
//! A [`Map3`] takes every point of a model to a new place and knows its Jacobian there. Implement [`Map3::jet`]; the rest is
//! speed and knowledge: batches, creases, the inverse, and whether planes stay planes. [`Chain3`] composes maps;
//! [`NewtonInverse3`] inverts any smooth map over a box.

mod batch;
mod chain;
mod collineation;
mod collineation_map;
#[cfg(test)]
#[path = "../../../pathwarp/src/map/counted.rs"]
pub(crate) mod counted;
mod crease;
mod jet;
mod lane;
mod local;
mod newton;
mod poly;
mod tensor;
mod traits;

pub use chain::Chain3;
pub use collineation::Collineation;
pub use crease::{Crease3, Creases3, Level3};
pub use jet::Jet3;
pub use newton::NewtonInverse3;
pub use poly::{Chart, Fraction3};
pub use traits::Map3;

pub(crate) use batch::{Displaced, Quotient, Radial, Swept, for_all};
pub(crate) use local::Local;
#[cfg(test)]
use pathwarp::map::Real;
pub(crate) use poly::Poly3;
pub(crate) use tensor::Tensor;
