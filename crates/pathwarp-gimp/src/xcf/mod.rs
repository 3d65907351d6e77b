//! XCF, GIMP's native format: big-endian, a property list, then tables of pointers.
//!
//! Paths have one of three forms: `PROP_PATHS` (GIMP 1.x, and still written when every path is invisible), `PROP_VECTORS`
//! (GIMP 2), or separate items behind pointers (version 18, GIMP 3). Only these are read. Source: GIMP's `devel-docs/xcf.txt`
//! and files written by GIMP 2.10 and 3.0, whose point types (1, 2, 3) differ from that text.

mod items;
mod model;
mod old_paths;
mod primitives;
mod read;
mod rewrite;
mod vectors;

pub(crate) use model::{MAGIC, Xcf};
pub(crate) use read::read;
pub use rewrite::{new_xcf, rewrite};
