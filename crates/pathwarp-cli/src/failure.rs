//! Failures: the errors that end a run, each with its exit code.

use crate::{advice, flags, terminal};
use pathwarp::GeometryError;
use std::fmt::Display;
use std::path::Path;

/// An error that ends the run.
#[derive(Debug)]
pub(crate) enum Failure {
    /// clap's own message: wrong usage, or a request for help.
    Clap(clap::Error),
    /// Wrong usage.
    Usage(String),
    /// A file cannot be read, parsed or written.
    Input(String),
    /// The same for a file other than the artwork (a cage, a style, a mesh); the message names that file.
    SideFile(String),
    /// The geometry does not allow it.
    Geometry(String),
}

impl Failure {
    pub(crate) fn usage(message: impl Into<String>) -> Self {
        Self::Usage(message.into())
    }

    /// A problem with the file `path`.
    pub(crate) fn file(path: &Path, problem: impl Display) -> Self {
        Self::Input(format!("{}: {problem}", path.display()))
    }

    /// A failed write to standard output.
    pub(crate) fn stdout(e: &std::io::Error) -> Self {
        Self::Input(format!("standard output: {e}"))
    }

    /// The exit code.
    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::Clap(e) => u8::try_from(e.exit_code()).unwrap_or(2),
            Self::Usage(_) => 2,
            Self::Input(_) | Self::SideFile(_) => 3,
            Self::Geometry(_) => 4,
        }
    }

    /// Prints the message.
    pub(crate) fn show(&self) {
        match self {
            // clap picks the stream: help goes to standard output. Ignore a closed pipe.
            Self::Clap(e) => drop(e.print()),
            Self::Usage(m) | Self::Input(m) | Self::SideFile(m) | Self::Geometry(m) => terminal::error(m),
        }
    }

    /// An error from a recipe. Its input errors name the side file they occurred in, so the artwork's name is not added to them.
    pub(crate) fn of_recipe(e: pathwarp::Error) -> Self {
        match Self::from(e) {
            Self::Input(m) => Self::SideFile(m),
            other => other,
        }
    }

    /// The same failure with the name of the input in front, unless the message starts with it already.
    pub(crate) fn about(self, input: &str) -> Self {
        let with = |m: String| if m.starts_with(input) { m } else { format!("{input}: {m}") };
        match self {
            Self::Input(m) => Self::Input(with(m)),
            Self::Geometry(m) => Self::Geometry(with(m)),
            other => other,
        }
    }
}

impl From<clap::Error> for Failure {
    fn from(e: clap::Error) -> Self {
        Self::Clap(e)
    }
}

impl From<pathwarp::Error> for Failure {
    fn from(e: pathwarp::Error) -> Self {
        let m = advice::error(&e);
        match e {
            pathwarp::Error::Input { .. } => Self::Input(m),
            pathwarp::Error::Geometry(GeometryError::FlatFrame { .. }) => {
                Self::Geometry(format!("{m} (--frame X,Y,W,H, or --base where there is one)"))
            }
            pathwarp::Error::Geometry(_) => Self::Geometry(flags::led(&m)),
            _ => Self::Usage(format!("--{m}")),
        }
    }
}

impl From<pathwarp_raster::Error> for Failure {
    fn from(e: pathwarp_raster::Error) -> Self {
        Self::Input(e.to_string())
    }
}
