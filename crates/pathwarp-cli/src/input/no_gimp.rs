//! Stands in for GIMP's files in a program that is built without them. Reading such a file as a drawing says so.

use super::artwork::FileArtwork;
use crate::failure::Failure;
use crate::options::CommonOptions;
use pathwarp::budget::Limits;
use pathwarp::{Error, Outline};
use std::path::Path;

pub(super) const HEAD: usize = 0;

pub(super) fn may_begin(_head: &[u8]) -> bool {
    false
}

pub(super) fn open(_: &Path, _: &CommonOptions, _: Option<&Path>) -> Result<Option<Box<dyn FileArtwork>>, Failure> {
    Ok(None)
}

pub(crate) fn outline(_file: &Path, _name: Option<&str>, _: &Limits) -> Result<Option<Outline>, Error> {
    Ok(None)
}

pub(crate) fn svg_name(_input: &Path) -> Option<String> {
    None
}
