//! The fonts for text in drawings.

use crate::failure::Failure;
use pathwarp_svg::{GenericFamilies, ReadOptions, check_fonts};
use std::path::PathBuf;

/// The fonts that the options name.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Fonts {
    /// Files, and folders of them.
    pub(crate) paths: Vec<PathBuf>,
    /// Ignore the installed ones.
    pub(crate) no_system: bool,
    pub(crate) generic: GenericFamilies,
}

impl Fonts {
    /// Checks that what was named are fonts.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        Ok(check_fonts(&self.paths)?)
    }

    /// The options for reading a drawing with these fonts.
    pub(crate) fn read_options(&self) -> ReadOptions {
        ReadOptions::default()
            .with_fonts(self.paths.clone())
            .with_system_fonts(!self.no_system)
            .with_generic_families(self.generic.clone())
    }
}
