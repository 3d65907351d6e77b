//! Errors as the exceptions of `pathwarp._errors`.

use pathwarp_cli::embed::{Error, ErrorKind};
use pyo3::prelude::*;

/// The exception for an error.
pub(crate) fn exception(py: Python<'_>, error: &Error) -> PyErr {
    let class = match error.kind {
        ErrorKind::Usage => "UsageError",
        ErrorKind::Input => "InputError",
        ErrorKind::Geometry => "GeometryError",
        ErrorKind::Limit => "LimitError",
        _ => "InternalError",
    };
    raised(py, class, &error.message)
}

/// An exception about a wrong argument.
pub(crate) fn usage(py: Python<'_>, message: &str) -> PyErr {
    raised(py, "UsageError", message)
}

fn raised(py: Python<'_>, class: &str, message: &str) -> PyErr {
    let made = py.import("pathwarp._errors").and_then(|m| m.getattr(class)).and_then(|c| c.call1((message,)));
    made.map_or_else(|e| e, PyErr::from_value)
}
