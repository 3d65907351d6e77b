//! Drawings in formats other than SVG, and GIMP's paths in every format.

mod contours;
mod dxf;
mod exported;
mod kerf;
mod pdf;

pub use exported::Exported;
pub use kerf::KerfReport;
pub use pathwarp_dxf::{MAX_DEGREE, Spline, write_splines};

use crate::failure::Failure;
use crate::format::Format;
use crate::links::Destination;
use crate::options::CommonOptions;
use pathwarp::kurbo::Size;
use pathwarp::param::LengthUnit;
use pathwarp_gimp::{GimpPath, Stroke, new_xcf, to_json, to_svg};
use pathwarp_svg::engine::compressed;
use pathwarp_svg::{Document, PageFit, ReadOptions};
use std::path::Path;

/// Writes a document in another format.
type Writer = fn(&Document, &CommonOptions, Option<f64>) -> Result<Exported, Failure>;

/// Returns a drawing with the page size that the options ask for.
fn resized(doc: &Document, options: &CommonOptions) -> String {
    let Some(scale) = options.page_scale(doc.size_px()) else { return doc.text().to_owned() };
    // SVG knows neither metres nor plain numbers that are not px.
    let (name, unit) = match scale.unit {
        LengthUnit::Cm => ("cm", LengthUnit::Cm),
        LengthUnit::In => ("in", LengthUnit::In),
        LengthUnit::Pt => ("pt", LengthUnit::Pt),
        LengthUnit::Pc => ("pc", LengthUnit::Pc),
        LengthUnit::Mm | LengthUnit::M | LengthUnit::Q => ("mm", LengthUnit::Mm),
        _ => ("", LengthUnit::Px),
    };
    doc.resized(scale.by, name, unit.px().unwrap_or(1.0))
}

/// Writes the drawing `svg` in a format, with links that hold at its destination. `read` has the options to read it, and `tolerance` (user
/// units) is the distance within which the lines of a DXF follow curves; by default, the options decide.
pub fn drawing(
    svg: String,
    (format, destination): (Format, &Destination),
    read: &ReadOptions,
    options: &CommonOptions,
    tolerance: Option<f64>,
) -> Result<Exported, Failure> {
    if options.kerf.is_none() && !options.engrave.is_empty() {
        return Err(Failure::usage("--engrave says what is not cut; it goes with --kerf"));
    }
    if options.kerf.is_some() && format != Format::Dxf {
        let advice = "in other formats, `pathwarp offset --by` moves outlines by half of it";
        return Err(Failure::usage(format!("--kerf is for a DXF; {advice}")));
    }
    let resizes = options.page_width.is_some() || options.page_height.is_some();
    if resizes && matches!(options.page, PageFit::Sheet(_)) {
        let advice = "--page-width and --page-height scale it; omit them, or --fit";
        return Err(Failure::usage(format!("a sheet of paper has its own size; {advice}")));
    }
    let write: Option<Writer> = match format {
        Format::Pdf => Some(pdf::write),
        Format::Dxf => Some(dxf::write),
        _ => None,
    };
    let parsed = |text: &str| Document::read(text.as_bytes(), "the result", read);
    let svg = if resizes { resized(&parsed(&svg)?, options) } else { svg };
    let Some(write) = write else {
        let svg = destination.linked(svg, read)?;
        if format == Format::Svgz {
            return Ok(compressed(&svg).map_err(|e| Failure::file(Path::new("the result"), e))?.into());
        }
        return Ok(svg.into_bytes().into());
    };
    let doc = parsed(&svg)?;
    // Coordinates far from the origin suffer from the single precision of PDF and its readers.
    let doc = doc.moved_to_origin()?.map_or(Ok(doc), |moved| parsed(&moved))?;
    // A DXF is made from the document's outlines, a PDF from usvg's tree.
    let resolved = if format == Format::Dxf { None } else { doc.resolved()? };
    write(&resolved.map_or(Ok(doc), |resolved| parsed(&resolved))?, options, tolerance)
}

/// Writes GIMP's paths in a format. Sizes are in px. The lines of a DXF follow curves within `tolerance`.
pub fn paths(
    canvas: [f64; 2],
    paths: &[GimpPath],
    format: Format,
    options: &CommonOptions,
    tolerance: Option<f64>,
) -> Result<Exported, Failure> {
    /// Largest side of an image that GIMP opens, in pixels.
    const LARGEST_SIDE: f64 = 524_288.0;
    if !matches!(format, Format::PointList | Format::Xcf) {
        let svg = to_svg(canvas, paths, None);
        return drawing(svg, (format, &Destination::Back), &ReadOptions::default(), options, tolerance);
    }
    let scale = options.page_scale(Size::new(canvas[0], canvas[1])).map_or(1.0, |scale| scale.by);
    let scaled = |p: &[f64; 2]| p.map(|v| v * scale);
    let stroke = |s: &Stroke| Stroke { closed: s.closed, points: s.points.iter().map(scaled).collect() };
    let path = |p: &GimpPath| GimpPath { strokes: p.strokes.iter().map(stroke).collect(), ..p.clone() };
    let (canvas, paths) = (scaled(&canvas), paths.iter().map(path).collect::<Vec<_>>());
    let bytes = match format {
        Format::Xcf => new_xcf(canvas.map(|v| v.ceil().clamp(1.0, LARGEST_SIDE) as u32), &paths),
        _ => to_json(Some(canvas), &paths).into_bytes(),
    };
    Ok(bytes.into())
}
