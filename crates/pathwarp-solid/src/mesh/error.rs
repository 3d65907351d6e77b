//! Errors of reading a mesh.

use pathwarp::budget::Exceeded;
use std::fmt;
use thiserror::Error;

/// The reason why a file is not a mesh, with its place.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{}{problem}", self.place())]
pub struct MeshError {
    /// The line, counted from 1, if the file has lines.
    pub line: Option<usize>,
    /// The problem.
    pub problem: MeshFault,
}

/// A fault of a mesh file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum MeshFault {
    /// Text that says what is wrong.
    Text(String),
    /// More work than a limit allows.
    Limit(Exceeded),
}

impl fmt::Display for MeshFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(t) => f.write_str(t),
            Self::Limit(e) => write!(f, "the mesh takes {e}"),
        }
    }
}

impl MeshError {
    /// An error at a line.
    pub(crate) fn at(line: usize, problem: impl Into<String>) -> Self {
        Self { line: Some(line), problem: MeshFault::Text(problem.into()) }
    }

    /// An error about the whole file.
    pub(crate) fn whole(problem: impl Into<String>) -> Self {
        Self { line: None, problem: MeshFault::Text(problem.into()) }
    }

    fn place(&self) -> String {
        self.line.map_or_else(String::new, |n| format!("line {n}: "))
    }
}

impl From<Exceeded> for MeshError {
    fn from(e: Exceeded) -> Self {
        Self { line: None, problem: MeshFault::Limit(e) }
    }
}
