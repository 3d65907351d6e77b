//! What ends a run, and with which exit code.

use crate::{flags, terminal};
use pathwarp::GeometryError;
use std::fmt::Display;
use std::path::Path;

/// Why the program stops.
#[derive(Debug)]
pub(crate) enum Failure {
    /// clap's own message: wrong usage, or help asked for.
    Clap(clap::Error),
    /// Wrong usage.
    Usage(String),
    /// A file cannot be read, understood or written.
    Input(String),
    /// Neither can one beside the artwork (a cage, a style, a mesh), which the message names.
    Beside(String),
    /// The geometry forbids it.
    Geometry(String),
}

impl Failure {
    pub(crate) fn usage(message: impl Into<String>) -> Self {
        Self::Usage(message.into())
    }

    /// Something about a file.
    pub(crate) fn file(path: &Path, what: impl Display) -> Self {
        Self::Input(format!("{}: {what}", path.display()))
    }

    /// Standard output is closed, or full.
    pub(crate) fn stdout(e: &std::io::Error) -> Self {
        Self::Input(format!("standard output: {e}"))
    }

    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::Clap(e) => u8::try_from(e.exit_code()).unwrap_or(2),
            Self::Usage(_) => 2,
            Self::Input(_) | Self::Beside(_) => 3,
            Self::Geometry(_) => 4,
        }
    }

    pub(crate) fn show(&self) {
        match self {
            // clap chooses the stream (help goes to standard output); a closed pipe there is nobody's fault.
            Self::Clap(e) => drop(e.print()),
            Self::Usage(m) | Self::Input(m) | Self::Beside(m) | Self::Geometry(m) => terminal::error(m),
        }
    }

    /// What is wrong with a recipe: its input errors are those of the files that it names.
    pub(crate) fn of_recipe(e: pathwarp::Error) -> Self {
        match Self::from(e) {
            Self::Input(m) => Self::Beside(m),
            other => other,
        }
    }

    /// The same failure, said to concern `input`.
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
        let m = e.to_string();
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
