//! Failures: the errors that end a run, each with its exit code.

use crate::advice::{self, Flags};
use pathwarp::GeometryError;
use pathwarp::budget::Exceeded;
use pathwarp::kurbo::Point;
use std::fmt::Display;
use std::path::Path;

/// An error that ends the run.
#[derive(Debug)]
pub enum Failure {
    /// Wrong usage.
    Usage(String),
    /// A file cannot be read or parsed.
    Input(String),
    /// A picture takes more work than a limit allows: message, limit and exit code.
    Limited(String, Exceeded, u8),
    /// An output cannot be written.
    Output(String),
    /// The geometry does not allow the deformation.
    Geometry(String),
    /// An error of the libraries; flags and advice are added when it is shown.
    Library {
        /// The error.
        error: Box<pathwarp::Error>,
        /// The input at fault; `None` if the message already names a file.
        input: Option<String>,
        /// `true` if the error occurred in a recipe: an [`Error::Input`](pathwarp::Error::Input) is then about a side file (a cage, a
        /// style, a mesh), which the message names.
        of_recipe: bool,
    },
}

impl Failure {
    /// A failure because of wrong usage.
    pub fn usage(message: impl Into<String>) -> Self {
        Self::Usage(message.into())
    }

    /// A failure because of a problem with the file `path`.
    pub fn file(path: &Path, problem: impl Display) -> Self {
        Self::Input(format!("{}: {problem}", path.display()))
    }

    /// A failure because of a problem with the output file `path`.
    pub fn output(path: &Path, problem: impl Display) -> Self {
        Self::Output(format!("{}: {problem}", path.display()))
    }

    /// A failure to write to standard output.
    pub fn stdout(e: &std::io::Error) -> Self {
        Self::Output(format!("standard output: {e}"))
    }

    /// Returns `true` if the recipe is at fault, so that every input fails alike.
    pub fn is_of_recipe(&self) -> bool {
        matches!(self, Self::Library { error, of_recipe: true, .. } if !matches!(**error, pathwarp::Error::Geometry(_)))
    }

    /// Returns the shape and the point at which the map is infinite or undefined, if that is the failure.
    pub(crate) fn infinity(&self) -> Option<(&str, Point)> {
        let Self::Library { error, .. } = self else { return None };
        match &**error {
            pathwarp::Error::Geometry(GeometryError::Infinity { shape, at }) => Some((shape, *at)),
            _ => None,
        }
    }

    /// Returns the exit code.
    pub fn code(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            Self::Input(_) => 3,
            Self::Limited(_, _, code) => *code,
            Self::Geometry(_) => 4,
            Self::Output(_) => 5,
            Self::Library { error, .. } => match **error {
                pathwarp::Error::Input { .. } => 3,
                pathwarp::Error::Geometry(_) => 4,
                _ => 2,
            },
        }
    }

    /// Returns the message, in which parameters appear as `flags`.
    pub fn message(&self, flags: &Flags) -> String {
        match self {
            Self::Usage(m) | Self::Input(m) | Self::Limited(m, ..) | Self::Output(m) | Self::Geometry(m) => m.clone(),
            Self::Library { error, input, .. } => {
                let message = advice::error_message(error, flags);
                input.as_ref().map_or_else(|| message.clone(), |i| prefixed(i, &message))
            }
        }
    }

    /// A failure to look up references or to build a recipe.
    pub fn of_recipe(error: pathwarp::Error) -> Self {
        Self::Library { error: Box::new(error), input: None, of_recipe: true }
    }

    /// Puts the name of the input in front, unless the failure is wrong usage or concerns another file.
    pub fn about(self, name: &str) -> Self {
        match self {
            Self::Input(m) => Self::Input(prefixed(name, &m)),
            Self::Limited(m, exceeded, code) => Self::Limited(prefixed(name, &m), exceeded, code),
            Self::Geometry(m) => Self::Geometry(prefixed(name, &m)),
            Self::Library { error, of_recipe, .. } => {
                let concerns_input = match *error {
                    pathwarp::Error::Input { .. } => !of_recipe,
                    pathwarp::Error::Geometry(_) => true,
                    _ => false,
                };
                Self::Library { error, input: concerns_input.then(|| name.to_owned()), of_recipe }
            }
            other => other,
        }
    }
}

/// Puts the name of a file before a message that does not begin with it.
fn prefixed(name: &str, message: &str) -> String {
    if message.starts_with(name) { message.to_owned() } else { format!("{name}: {message}") }
}

impl From<pathwarp::Error> for Failure {
    fn from(error: pathwarp::Error) -> Self {
        Self::Library { error: Box::new(error), input: None, of_recipe: false }
    }
}

impl From<pathwarp_raster::Error> for Failure {
    fn from(e: pathwarp_raster::Error) -> Self {
        use pathwarp_raster::Error::{TooLarge, TooMuch};
        let message = advice::picture_message(&e);
        match e {
            TooLarge { exceeded, .. } | TooMuch(exceeded) => Self::Limited(message, exceeded, 3),
            _ => Self::Input(message),
        }
    }
}
