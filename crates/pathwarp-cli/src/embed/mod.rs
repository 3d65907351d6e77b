//! pathwarp inside other programs and languages: everything is given as text, as on the command line, and drawings stay in memory.
//!
//! A [`Warper`] is a recipe with its options. It maps points, bends paths and warps drawings, with the same numbers as the command
//! line: both take the same road. Nothing is printed, and no file is written. Panics become errors.
//!
//! ```
//! use pathwarp::deform::Registry;
//! use pathwarp_cli::embed::Warper;
//!
//! let mut warper = Warper::new(&Registry::builtin(), "arc", &[("bend", "40%")])?;
//! warper.set_option("tolerance", "0.01")?;
//! let warped = warper.warp_path("M0,0 H100 V50 H0 Z")?;
//! assert!(warped.path.data.starts_with('M') && warped.path.report.max_error <= 0.01);
//! # Ok::<(), pathwarp_cli::embed::Error>(())
//! ```

mod error;
mod names;
mod points;
mod warper;

pub use error::{Details, Error, ErrorKind};
pub use names::{option_names, option_words, preset};
pub use points::PointMap;
pub use warper::{Drawing, Path, Warper};
