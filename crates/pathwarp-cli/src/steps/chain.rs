//! Chains, `A … + B …`: each part after a `+` is parsed once, into a step and the common options it gives.

use super::params::{args, step};
use crate::failure::Failure;
use crate::options::{Given, options_without_inputs};
use clap::Command;
use pathwarp::deform::Registry;
use pathwarp::recipe::Step;
use std::ffi::OsString;

/// A part of a chain.
pub(crate) struct ChainPart {
    pub(crate) step: Step,
    /// The common options in this part; they apply to the whole chain.
    pub(crate) options: Given,
}

/// Parses the parts after each `+`. They take the common options only if `with_options`.
pub(crate) fn parts(registry: &Registry, words: &[&[OsString]], with_options: bool) -> Result<Vec<ChainPart>, Failure> {
    words.iter().map(|words| part(registry, words, with_options)).collect()
}

fn part(registry: &Registry, words: &[OsString], with_options: bool) -> Result<ChainPart, Failure> {
    let mut c = Command::new("pathwarp … +")
        .no_binary_name(true)
        .disable_help_flag(true)
        .disable_help_subcommand(true)
        .subcommand_required(true);
    for e in registry.entries() {
        let mut deformation = Command::new(e.info().name).about(e.info().title).args(args(e.info()));
        if with_options {
            deformation = deformation.args(options_without_inputs());
        }
        c = c.subcommand(deformation);
    }
    let mut m = c.try_get_matches_from(words)?;
    let (name, sub) = m.remove_subcommand().ok_or_else(|| Failure::usage("a deformation must follow `+`"))?;
    let options = if with_options { Given::options(&sub) } else { Given::default() };
    Ok(ChainPart { step: step(registry, &name, &sub), options })
}
