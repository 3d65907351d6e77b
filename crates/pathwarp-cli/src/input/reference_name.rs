//! The syntax of `FILE#NAME`.

use pathwarp::Error;
use std::path::{Path, PathBuf};

/// Splits `FILE#NAME`. Both may contain a `#`: the name starts after the first one that is preceded by an existing file, else
/// after the last.
pub(crate) fn split_reference(reference: &str) -> (PathBuf, Option<&str>) {
    if Path::new(reference).is_file() {
        return (reference.into(), None);
    }
    let cuts: Vec<usize> = reference.match_indices('#').map(|(i, _)| i).collect();
    let cut = cuts.iter().find(|&&i| Path::new(&reference[..i]).is_file()).or(cuts.last());
    match cut {
        Some(&i) => (reference[..i].into(), Some(&reference[i + 1..])),
        None => (reference.into(), None),
    }
}

/// The error for `#NAME` where no input document can hold it.
pub(crate) fn no_document(name: &str) -> Error {
    Error::input(format!("#{name}"), "there is no input document to find the path in")
}
