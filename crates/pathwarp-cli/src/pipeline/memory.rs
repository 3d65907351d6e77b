//! One drawing or picture in memory: warped as from a file, without touching any.

use super::file_run::Batch;
use crate::advice::Flags;
use crate::failure::Failure;
use crate::input::{Input, WarpedResult, display};
use crate::options::Given;
use crate::report::FileReport;
use pathwarp::deform::Registry;
use pathwarp::recipe::Recipe;
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// The outcome of a warp in memory.
pub(crate) struct InMemory {
    pub(crate) bytes: Vec<u8>,
    pub(crate) report: FileReport,
    /// The lines of `--explain`.
    pub(crate) notes: Vec<String>,
}

/// Warps the content of a file called `name` by a recipe whose file references have been looked up. Linked pictures are looked up
/// beside `name`, which is empty if there is no such place. The switch `stop` ends the work.
pub(crate) fn warp_bytes(
    registry: &Registry,
    recipe: &Recipe,
    given: &Given,
    stop: Option<&'static AtomicBool>,
    name: &Path,
    bytes: &[u8],
) -> Result<InMemory, Failure> {
    let mut options = given.keeping_pages().read()?;
    options.reading.stop(stop);
    let batch = Batch { registry, recipe, options: &options, given, flags: Flags::of(registry) };
    let warped = Input::of_bytes(bytes, name, &options, None).and_then(|mut input| batch.warp(&mut input));
    let warped = warped.map_err(|f| f.about(&display(name)))?;
    match warped.result {
        WarpedResult::Bytes(bytes) => Ok(InMemory { bytes, report: warped.report, notes: warped.notes }),
        // Only an XCF is written to a file, and it is not read from memory.
        WarpedResult::File(_) => Err(Failure::usage("the result is a file")),
    }
}
