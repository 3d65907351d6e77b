//! Calls by Inkscape, which starts the program for every effect with ids, parameters and the drawing's file: `--id=path1
//! --inkscape-deformation=warp --bend_percent=40 … /tmp/ink_ext_XXXXXX.svg`. The result goes to standard output; anything on
//! standard error opens a window.
//!
//! A call is turned into the words of an ordinary command line (`words.rs`), which the ordinary pipeline runs (`stage.rs`).

mod affine;
mod again;
mod call;
mod effect;
mod guides;
mod hand;
pub(crate) mod inx;
mod line;
mod names;
mod quoting;
mod restoring;
mod stage;
mod words;

use crate::advice::Flags;
use crate::failure::Failure;
use crate::output;
use crate::plugins;
use crate::status::Status;
use call::{Call, Job};
use pathwarp::deform::Registry;
use stage::{Dispatch, Stage};
use std::ffi::OsString;

/// Returns `true` if Inkscape started the program.
pub(crate) fn is_call(args: &[OsString]) -> bool {
    args.iter().skip(1).any(|a| names::is_job(&a.to_string_lossy()))
}

/// Does what Inkscape asks for.
pub(crate) fn run(registry: &Registry, args: &[OsString], dispatch: Dispatch) -> Result<Status, Failure> {
    let call = Call::read(args)?;
    let word = match &call.job {
        Job::Deformation(name) => name,
        // Any may be in a recipe.
        Job::Edit | Job::Hand => "list",
        Job::Release | Job::Convert(_) => "convert",
    };
    let (_, plugins) = plugins::load(registry, &["pathwarp".into(), word.into()], &[])?;
    let stage = Stage { registry: &plugins.added_to(registry), dispatch, call: &call };
    let done = match &call.job {
        Job::Deformation(name) => effect::run(&stage, name),
        Job::Edit => again::edit(&stage),
        Job::Release => again::release(&stage),
        Job::Hand => hand::run(&stage),
        Job::Convert(format) => return stage.convert(format).map_err(|f| in_a_window(&stage, &f)),
    };
    let svg = done.map_err(|f| in_a_window(&stage, &f))?;
    output::to_stdout(svg.as_bytes())?;
    Ok(Status::Complete)
}

/// A message for the window that Inkscape opens: parameters as the dialog labels them, and without the temporary file.
fn in_a_window(stage: &Stage<'_>, failure: &Failure) -> Failure {
    let plain = stage.without_file(failure, &stage.call.file);
    Failure::Input(inx::labelled(&plain.message(&Flags::of(stage.registry))))
}
