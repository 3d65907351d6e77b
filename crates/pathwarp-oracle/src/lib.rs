//! What tests, benchmarks and fuzz targets measure with: distances both ways, painted areas, pictures. Nothing here shares code with what
//! is measured.

pub mod area;
mod corpus;
pub mod curves;
mod distance;
pub mod drawings;
mod maps;
pub mod measure;

pub use corpus::{corpus, cubics};
pub use distance::{arriving, distance, distance_of_run, largest_turn, leaving, turn};
pub use maps::{BOX, Bicubic, Fold, Rational, Ripple};
