//! Options for reading drawings: fonts, limits on work, and access to linked files.

use crate::failure::Failure;
use pathwarp::budget::Limits;
use pathwarp_svg::{GenericFamilies, ReadOptions, check_fonts};
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

/// The options about reading drawings, which every command that reads one has.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Reading {
    /// Limits on the work that an input may cause.
    pub(crate) limits: Limits,
    /// Read linked files from anywhere, not only beside the input.
    pub(crate) external: bool,
    pub(crate) fonts: Fonts,
    /// The folder that links are relative to; `None`: the input's.
    pub(crate) base: Option<PathBuf>,
}

/// The fonts for text.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Fonts {
    /// Files, and folders of them.
    pub(crate) paths: Vec<PathBuf>,
    /// Ignore the installed ones.
    pub(crate) no_system: bool,
    pub(crate) generic: GenericFamilies,
}

impl Reading {
    /// Checks that what was named as fonts are fonts.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        Ok(check_fonts(&self.fonts.paths)?)
    }

    /// Lets a switch end the work.
    pub(crate) fn stop(&mut self, switch: Option<&'static AtomicBool>) {
        self.limits = switch.map_or(self.limits, |switch| self.limits.stopped_by(switch));
    }

    /// The same as options of the library.
    pub(crate) fn read_options(&self) -> ReadOptions {
        ReadOptions::default()
            .with_limits(self.limits)
            .with_external(self.external)
            .with_fonts(self.fonts.paths.clone())
            .with_system_fonts(!self.fonts.no_system)
            .with_generic_families(self.fonts.generic.clone())
    }
}
