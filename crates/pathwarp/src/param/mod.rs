//! Parameters of deformations, declared in one table for the command line, recipes, help, the schema and editors.
//!
//! A deformation declares a table of [`Param`]s: name, [`Kind`], default, range and help. A caller collects values as text in
//! [`Args`]. [`Settings`] combines the two with a [`Frame`], the box to which percentages refer, and returns typed and
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
//! Values remain text until the deformation is built, so that a recipe can be applied to other artwork. Lengths become user
//! units, angles become degrees. Errors name parameters without dashes.

mod circle;
mod declaration;
mod frame;
mod letter;
mod settings;
mod shape;
mod typed;
mod value;

use crate::error::Error;
use crate::outline::Outline;
use circle::is_circle;
use std::collections::BTreeMap;

pub use declaration::{Axis, Kind, Param};
pub use frame::Frame;
pub use letter::Letter;
pub(crate) use letter::word_space;
pub use settings::Settings;
pub use shape::{is_shape, shape_names};
pub(crate) use typed::{Choice, Value, choice, parameters};
pub use value::{Length, LengthError, LengthUnit};

pub(crate) use circle::is_spiral;

/// A path to which a value refers.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPath {
    /// A name for messages: the parameter's, followed by the reference as typed if that was looked up.
    pub name: String,
    /// The geometry in root user units.
    pub outline: Outline,
}

/// A file that a value names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedText {
    /// The file's name as typed, for messages.
    pub name: String,
    /// The text of the file.
    pub text: String,
}

/// The values given for each parameter, with the geometry of path references and the text of files.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Args {
    typed: BTreeMap<String, Vec<String>>,
    paths: BTreeMap<String, NamedPath>,
    files: BTreeMap<String, NamedText>,
}

impl Args {
    /// Creates an empty list of values.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a value. The value of a flag is `true`.
    pub fn push(&mut self, name: &str, value: impl Into<String>) {
        self.typed.entry(name.to_owned()).or_default().push(value.into());
    }

    /// Replaces the values given for `name`.
    pub fn set(&mut self, name: &str, values: Vec<String>) {
        self.typed.insert(name.to_owned(), values);
    }

    /// Creates values from pairs of name and value.
    #[must_use]
    pub fn from_pairs(pairs: &[(&str, &str)]) -> Self {
        let mut args = Self::new();
        pairs.iter().for_each(|(name, value)| args.push(name, *value));
        args
    }

    /// Returns the values given for `name`.
    #[must_use]
    pub fn get(&self, name: &str) -> &[String] {
        self.typed.get(name).map_or(&[], Vec::as_slice)
    }

    /// Returns all values, by name.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &[String])> {
        self.typed.iter().map(|(n, v)| (n.as_str(), v.as_slice()))
    }

    /// Looks up every path reference that is not inline (`M …`, `x,y …`) with `look_up`, so that building a deformation needs no
    /// files. `look_up` returns `None` to leave a reference to a later call. References already looked up are kept.
    ///
    /// # Errors
    /// The first [`Error`] that `look_up` returns.
    pub fn resolve_paths(
        &mut self,
        params: &[Param],
        mut look_up: impl FnMut(&str) -> Result<Option<Outline>, Error>,
    ) -> Result<(), Error> {
        for p in params.iter().filter(|p| p.kind == Kind::Path) {
            for text in self.typed.get(p.name).into_iter().flatten() {
                if !is_inline(text)
                    && !self.paths.contains_key(text)
                    && let Some(outline) = look_up(text)?
                {
                    self.paths.insert(text.clone(), NamedPath { name: text.clone(), outline });
                }
            }
        }
        Ok(())
    }

    /// Returns the number of segments of all paths, looked up or typed.
    pub(crate) fn path_segments(&self) -> usize {
        /// The length of texts, in bytes, up to which their few segments are not counted.
        const SHORT: usize = 2000;
        let typed = self.typed.values().flatten().filter(|text| text.len() > SHORT && is_inline(text));
        let typed: usize = typed.map(|text| Outline::from_svg_lossy(text).segs().count()).sum();
        self.paths.values().map(|p| p.outline.segs().count()).sum::<usize>() + typed
    }

    /// Reads every file that a parameter of kind [`Kind::File`] or [`Kind::NameOrFile`] names, with `read`.
    ///
    /// # Errors
    /// The first [`Error`] that `read` returns.
    pub fn resolve_files(
        &mut self,
        params: &[Param],
        mut read: impl FnMut(&str) -> Result<String, Error>,
    ) -> Result<(), Error> {
        for p in params {
            let named = self.typed.get(p.name).into_iter().flatten().filter(|v| p.reads_file(v));
            for name in named {
                if !self.files.contains_key(name) {
                    let text = read(name)?;
                    self.files.insert(name.clone(), NamedText { name: name.clone(), text });
                }
            }
        }
        Ok(())
    }
}

/// Returns `true` if a path reference contains the path, as path data, points, a circle, an arc or a spiral, and is not a name.
#[must_use]
pub fn is_inline(text: &str) -> bool {
    is_path_data(text) || is_circle(text) || value::looks_like_points(text)
}

/// Returns `true` if `text` looks like SVG path data: a move command followed by coordinates.
fn is_path_data(text: &str) -> bool {
    let rest = text.trim_start().strip_prefix(['M', 'm']);
    rest.is_some_and(|r| r.trim_start().starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)))
}
