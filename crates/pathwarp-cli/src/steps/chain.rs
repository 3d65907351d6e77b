//! Chains, `A … + B …`: each part after a `+` is parsed once, into a step and the common options it gives.

use super::params::{args, step};
use crate::catalogue::Catalogue;
use crate::failure::Failure;
use crate::options::Given;
use clap::{Arg, Command};
use pathwarp::recipe::Step;
use std::ffi::OsString;

/// A part of a chain.
pub(crate) struct ChainPart {
    pub(crate) step: Step,
    /// The common options in this part; they apply to the whole chain.
    pub(crate) options: Given,
}

/// Parses the parts after each `+`, which take these common options.
pub(crate) fn parts(
    catalogue: &dyn Catalogue,
    words: &[&[OsString]],
    options: &[Arg],
) -> Result<Vec<ChainPart>, Failure> {
    words.iter().map(|words| part(catalogue, words, options)).collect()
}

fn part(catalogue: &dyn Catalogue, words: &[OsString], options: &[Arg]) -> Result<ChainPart, Failure> {
    let mut c = Command::new("pathwarp … +")
        .no_binary_name(true)
        .disable_help_flag(true)
        .disable_help_subcommand(true)
        .subcommand_required(true);
    for info in catalogue.infos() {
        c = c.subcommand(Command::new(info.name).about(info.title).args(args(info)).args(options));
    }
    let mut m = c.try_get_matches_from(words)?;
    let (name, sub) = m.remove_subcommand().ok_or_else(|| Failure::usage("a deformation must follow `+`"))?;
    Ok(ChainPart { step: step(catalogue, &name, &sub), options: Given::options(&sub) })
}
