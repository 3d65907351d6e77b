//! Stands in for the paths of GIMP's files in a program that is built without them.

use crate::failure::{Failure, Status};
use crate::format::Format;
use crate::left_out;
use crate::options::CommonOptions;
use std::path::Path;

pub(super) fn copy(
    _file: &Path,
    _target: Option<&Path>,
    format: Format,
    _options: &CommonOptions,
    split: bool,
    _salvage: bool,
) -> Result<Option<Status>, Failure> {
    match left_out::missing("xcf") {
        Some(said) if split || !matches!(format, Format::Pdf | Format::Dxf) => Err(Failure::Usage(said)),
        _ => Ok(None),
    }
}
