//! Measures for tests, benchmarks and fuzz targets: distances both ways, painted areas, pictures. They share no code with the measured
//! libraries.

pub mod curves;
mod distance;
mod polygon;
mod random;
mod turns;

pub use distance::{Image, Position, Run, Sampled, apart, far, flat};
pub use polygon::Polygon;
pub use random::Random;
pub use turns::{arriving, kink, largest_turn, leaving, turn};

#[cfg(feature = "drawings")]
mod corpus;
#[cfg(feature = "drawings")]
pub mod drawings;
#[cfg(feature = "drawings")]
mod maps;
#[cfg(feature = "drawings")]
mod painted;
#[cfg(feature = "drawings")]
mod pictures;

#[cfg(feature = "drawings")]
pub use corpus::{corpus, cubics};
#[cfg(feature = "drawings")]
pub use maps::{BOX, Bicubic, Fold, Rational, Ripple, distance};
#[cfg(feature = "drawings")]
pub use painted::painted;
#[cfg(feature = "drawings")]
pub use pictures::{Difference, beyond_edges, difference, ink, on_white};
