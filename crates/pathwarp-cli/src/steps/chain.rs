//! Chains, `A … + B …`: each part after a `+` is parsed once, into a step and the common options it gives.

use super::params::{args, step};
use crate::catalogue::Catalogue;
use crate::failure::Failure;
use crate::options::Given;
use clap::{Arg, Command};
use pathwarp::recipe::{Recipe, Step};
use std::ffi::OsString;

/// A part of a chain.
pub(crate) struct ChainPart {
    pub(crate) step: Step,
    /// The common options in this part; they apply to the whole chain.
    pub(crate) options: Given,
}

/// Other names of a deformation.
pub(crate) fn aliases(name: &str) -> Option<&'static str> {
    (name == "projective").then_some("perspective")
}

/// Where a step keeps the values of an option.
type OfStep = fn(&mut Step) -> &mut Vec<String>;

/// Options that apply to the whole chain if one part gives them, and else to the step of each part that does.
const OF_STEPS: [(&str, OfStep); 2] = [("select", |s| &mut s.select), ("exclude", |s| &mut s.exclude)];

/// Gives the steps of parts what is theirs alone: the selection, if several parts have one.
pub(crate) fn assign<'a>(parts: impl IntoIterator<Item = (&'a mut [Step], &'a mut Given)>) {
    let mut parts: Vec<_> = parts.into_iter().collect();
    for (name, of) in OF_STEPS {
        if parts.iter().filter(|(_, options)| options.gives(name)).count() < 2 {
            continue;
        }
        for (steps, options) in &mut parts {
            let values = options.take(name);
            steps.iter_mut().for_each(|step| of(step).extend(values.iter().cloned()));
        }
    }
}

/// The steps of all parts, and the options that hold for the whole chain.
pub(crate) fn chained(mut parts: Vec<ChainPart>) -> Result<(Recipe, Given), Failure> {
    assign(parts.iter_mut().map(|p| (std::slice::from_mut(&mut p.step), &mut p.options)));
    // The first part's options come last, as its inputs do.
    let mut options = parts.iter().skip(1).chain(parts.first()).map(|p| &p.options);
    let given = options.try_fold(Given::default(), |all, options| all.joined(options))?;
    Ok((Recipe { steps: parts.into_iter().map(|p| p.step).collect() }, given))
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
        c = c.subcommand(
            Command::new(info.name).aliases(aliases(info.name)).about(info.title).args(args(info)).args(options),
        );
    }
    let mut m = c.try_get_matches_from(words)?;
    let (name, sub) = m.remove_subcommand().ok_or_else(|| Failure::usage("a deformation must follow `+`"))?;
    Ok(ChainPart { step: step(catalogue, &name, &sub), options: Given::options(&sub) })
}
