//! Parameters of deformations, declared once: the command line, recipes, help, the schema and editors all follow from one table.
//!
//! A deformation declares a table of [`Param`]s: name, [`Kind`], default, range, help. A caller collects values as text in
//! [`Args`]. [`Settings`] brings the two together in a [`Frame`], the box that gives percentages a meaning, and returns typed and
//! range-checked values:
//!
//! ```
//! use pathwarp::kurbo::Rect;
//! use pathwarp::param::{Args, Axis, Frame, Param, Settings};
//!
//! const PARAMS: [Param; 2] = [
//!     Param::length("radius", Axis::X, "Radius of the circle.").default("50%"),
//!     Param::angle("start", "Angle at which the circle starts.").default("0"),
//! ];
//! let args = Args::from_pairs(&[("start", "0.25turn")]);
//! let frame = Frame::new(Rect::new(0.0, 0.0, 80.0, 40.0));
//! let settings = Settings::new(&PARAMS, &args, &frame)?;
//! assert_eq!(settings.number("radius")?, 40.0);
//! assert_eq!(settings.number("start")?, 90.0);
//! # Ok::<(), pathwarp::Error>(())
//! ```
//!
//! Values remain text until the deformation is built, so that a saved recipe means the same on other artwork. Lengths become user
//! units, angles degrees. Errors name parameters without dashes.

mod args;
mod circle;
mod declaration;
mod frame;
mod length;
mod letter;
mod number;
mod settings;
mod value;

pub use args::{Args, NamedPath, NamedText, is_inline};
pub(crate) use circle::is_spiral;
pub use declaration::{Axis, Kind, Param};
pub use frame::Frame;
pub use length::{Length, LengthError, LengthUnit};
pub use letter::Letter;
pub(crate) use letter::word_space;
pub use settings::Settings;
