//! Drawings in the formats besides SVG.

#[cfg(feature = "dxf")]
mod dxf;
mod exported;
#[cfg(feature = "dxf")]
mod kerf;
#[cfg(feature = "pdf")]
mod pdf;

pub(crate) use exported::Exported;

use crate::failure::Failure;
use crate::format::Format;
use crate::options::CommonOptions;
use pathwarp_svg::{Document, ReadOptions, compressed};
use std::path::Path;

/// Writes a document in another format.
type Writer = fn(&Document, &CommonOptions, Option<f64>) -> Result<Exported, Failure>;

/// The drawing `svg` in a format. `read` says how to read it, `tolerance` (user units) how close the lines of a DXF follow
/// curves; by default it is that of the options.
pub(crate) fn drawing(
    svg: String,
    format: Format,
    read: &ReadOptions,
    options: &CommonOptions,
    tolerance: Option<f64>,
) -> Result<Exported, Failure> {
    if options.kerf.is_some() && format != Format::Dxf {
        let advice = "in other formats, `pathwarp offset --by` moves outlines by half of it";
        return Err(Failure::usage(format!("--kerf is for a DXF; {advice}")));
    }
    let write: Option<Writer> = match format {
        #[cfg(feature = "pdf")]
        Format::Pdf => Some(pdf::write),
        #[cfg(feature = "dxf")]
        Format::Dxf => Some(dxf::write),
        Format::Svgz => return Ok(compressed(&svg).map_err(|e| Failure::file(Path::new("the result"), e))?.into()),
        _ => None,
    };
    let Some(write) = write else { return Ok(svg.into_bytes().into()) };
    let parsed = |text: &str| Document::read(text.as_bytes(), "the result", read);
    // PDF and its reader know single precision only.
    let there = parsed(&svg)?;
    write(&there.moved_to_origin()?.map_or(Ok(there), |near| parsed(&near))?, options, tolerance)
}
