//! Deformations that are separate programs, in any language.
//!
//! An executable `pathwarp-NAME` describes itself as JSON and then maps batches of points, by the protocol in `docs/plugin-protocol.md`.
//! A [`Plugin`] is such a program with its entry for the [`Registry`](pathwarp::deform::Registry): it has parameters, help, recipes
//! and checks like every other deformation. [`installed`] finds the plug-ins of the user's folder.
//!
//! The program runs as long as it is needed, once for each thread that needs it at the same time. Nothing that it does can hang or
//! flood this process: every answer has a limit in seconds and bytes, after which the program and its children are killed. A map
//! whose program has failed gives NaN from then on, and [`Built::failure`](pathwarp::deform::Built::failure) returns the reason.
//!
//! Call [`end_all`] before ending the process without unwinding.

mod answer;
mod binary;
mod child;
mod deformation;
mod entry;
mod fault;
mod folder;
#[cfg(unix)]
mod pipes_by_poll;
#[cfg(any(test, not(unix)))]
mod pipes_by_threads;
mod session;
mod text;

pub use child::end_all;
pub use deformation::Plugin;
pub use entry::Reserved;
pub use fault::Fault;
pub use folder::{Broken, FOLDER_VARIABLE, Found, by_file, folder, installed, name_of};
pub use text::creases;
