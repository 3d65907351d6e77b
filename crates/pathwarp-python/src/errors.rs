//! Errors as the exceptions of `pathwarp._errors`.

use pathwarp_engine::{Error, ErrorKind};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Returns the exception for an error.
pub(crate) fn exception(py: Python<'_>, error: &Error) -> PyErr {
    let class = match error.kind {
        ErrorKind::Usage => "UsageError",
        ErrorKind::Input => "InputError",
        ErrorKind::Geometry => "GeometryError",
        ErrorKind::Limit => "LimitError",
        _ => "InternalError",
    };
    let d = &error.details;
    let built = || {
        let attributes = PyDict::new(py);
        attributes.set_item("parameter", d.parameter.as_deref())?;
        attributes.set_item("value", d.value.as_deref())?;
        match d.at {
            Some(at) => attributes.set_item("place", (at.x, at.y))?,
            None => attributes.set_item("place", d.file.as_deref())?,
        }
        if let Some(exceeded) = d.limit {
            attributes.set_item("limit", exceeded.limit.name())?;
            attributes.set_item("needs", Some(exceeded.enough()).filter(|n| n.is_finite()))?;
        }
        py.import("pathwarp._errors")?.getattr(class)?.call((&d.with_dashes,), Some(&attributes))
    };
    built().map_or_else(|e: PyErr| e, PyErr::from_value)
}

/// Returns an exception about a wrong argument.
pub(crate) fn usage(py: Python<'_>, message: &str) -> PyErr {
    let made = py.import("pathwarp._errors").and_then(|m| m.getattr("UsageError")).and_then(|c| c.call1((message,)));
    made.map_or_else(|e| e, PyErr::from_value)
}
