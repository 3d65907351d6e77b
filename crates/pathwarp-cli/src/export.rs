//! Drawings in the formats besides SVG.

use crate::failure::Failure;
use crate::format::Format;
use crate::options::CommonOptions;
use crate::units::{MM_PER_PX, units_per_px};
use pathwarp::Outline;
use pathwarp::edit::united;
use pathwarp::kurbo::Affine;
use pathwarp::param::Frame;
use pathwarp_dxf::Shape;
use pathwarp_svg::usvg_tree::{self, ExactOutlines};
use pathwarp_svg::{Document, Plot, PlotShape, ReadOptions, Selection, compressed};
use std::path::Path;

/// Strokes that are wider than this many mm are hardly meant as lines to cut.
const WIDE_STROKE: f64 = 0.5;

/// A drawing in some format.
pub(crate) struct Exported {
    pub(crate) bytes: Vec<u8>,
    /// Messages about content that the format cannot express.
    pub(crate) warnings: Vec<String>,
}

impl From<Vec<u8>> for Exported {
    fn from(bytes: Vec<u8>) -> Self {
        Self { bytes, warnings: Vec::new() }
    }
}

/// The drawing `svg` in a format. `read` says how to read it, `tolerance` (user units) how close the lines of a DXF follow
/// curves; by default it is that of the options.
pub(crate) fn drawing(
    svg: String,
    format: Format,
    read: &ReadOptions,
    options: &CommonOptions,
    tolerance: Option<f64>,
) -> Result<Exported, Failure> {
    let parsed = |text: &str| Document::read(text.as_bytes(), "the result", read);
    // PDF and its reader know single precision only.
    let document = || {
        let there = parsed(&svg)?;
        there.moved_to_origin()?.map_or(Ok(there), |near| parsed(&near))
    };
    match format {
        Format::Svgz => Ok(compressed(&svg).map_err(|e| Failure::file(Path::new("the result"), e))?.into()),
        Format::Pdf => pdf(&document()?, options),
        Format::Dxf => dxf(&document()?, options, tolerance),
        _ => Ok(svg.into_bytes().into()),
    }
}

/// A drawing as PDF.
fn pdf(doc: &Document, options: &CommonOptions) -> Result<Exported, Failure> {
    let exact = ExactOutlines::of(doc);
    let written = usvg_tree::with_stack(doc, || {
        let outline = |path: &_| exact.get(path).cloned();
        let limits = doc.budget().limits();
        let options = pathwarp_pdf::Options { exact: &outline, picture_dpi: options.image_dpi, limits };
        Ok(pathwarp_pdf::write(usvg_tree::tree(doc), &options))
    })??;
    let (pictures, coarser) = (written.pictures, written.coarser);
    let warning = format!(
        "PDF has no filters: {} a filter {} a picture in it",
        counted(pictures, "group with", "groups with"),
        if pictures == 1 { "is" } else { "are" },
    );
    let less = format!(
        "{} fewer pixels than the resolution asks for, within the limits; --limit work and --limit memory raise them",
        counted(coarser, "of these pictures has", "of these pictures have")
    );
    let warnings = [(pictures > 0).then_some(warning), (coarser > 0).then_some(less)];
    Ok(Exported { bytes: written.bytes, warnings: warnings.into_iter().flatten().collect() })
}

/// A drawing as DXF, in millimetres.
fn dxf(doc: &Document, options: &CommonOptions, tolerance: Option<f64>) -> Result<Exported, Failure> {
    let plot = doc.plot()?;
    let page = [doc.size_px().width, doc.size_px().height].map(|v| v * MM_PER_PX);
    let to_px = doc.user_to_px();
    let to_mm = Affine::new([MM_PER_PX, 0.0, 0.0, -MM_PER_PX, 0.0, page[1]]) * to_px;
    let default = || {
        let bounds = doc.artwork_box(&Selection::default());
        let frame = Frame::new(bounds.unwrap_or_else(|| doc.view_box())).with_units_per_px(units_per_px(doc));
        options.tolerance_for(bounds, &frame)
    };
    let tolerance = tolerance.map_or_else(default, Ok)?;
    let outline = |s: &PlotShape| -> Result<Outline, Failure> {
        let rule = s.even_odd.filter(|_| options.union);
        let united = rule.map(|even_odd| united(&s.outline, even_odd, tolerance)).transpose();
        let united = united.map_err(pathwarp::Error::from)?.flatten();
        Ok(united.as_ref().unwrap_or(&s.outline).transformed(to_mm))
    };
    let outlines: Vec<Outline> = plot.shapes.iter().map(outline).collect::<Result<_, _>>()?;
    let shapes = plot.shapes.iter().zip(&outlines);
    let shapes: Vec<Shape<'_>> = shapes
        .map(|(s, outline)| Shape { layer: s.layer.as_deref().unwrap_or_default(), color: s.color, outline })
        .collect();
    let settings = pathwarp_dxf::Options {
        curves: options.dxf_curves,
        tolerance: tolerance * to_mm.determinant().abs().sqrt(),
        page,
        limits: doc.budget().limits(),
    };
    let text = pathwarp_dxf::write(&shapes, &settings)
        .map_err(|e| pathwarp::Error::limit(doc.name(), "as polylines, it takes", e))?;
    Ok(Exported { bytes: text.into_bytes(), warnings: lost_in_dxf(&plot) })
}

/// Describes the content that outlines cannot show.
fn lost_in_dxf(plot: &Plot) -> Vec<String> {
    let mut out = Vec::new();
    let lost = &plot.lost;
    let kinds = [
        (lost.bitmaps, "bitmap", "bitmaps"),
        (lost.patterns, "pattern", "patterns"),
        (lost.filters, "filter", "filters"),
    ];
    let left_out: Vec<String> = kinds.iter().filter(|k| k.0 > 0).map(|k| counted(k.0, k.1, k.2)).collect();
    if !left_out.is_empty() {
        out.push(format!("a DXF holds outlines only: left out {}", left_out.join(", ")));
    }
    if lost.hidden > 0 {
        let groups = counted(lost.hidden, "group", "groups");
        out.push(format!("a DXF cannot hide: of {groups}, parts that a clip path or mask hides are in it"));
    }
    let is_wide = |width: f64| width * MM_PER_PX > WIDE_STROKE;
    let wide = plot.shapes.iter().filter(|s| s.stroke_width.is_some_and(is_wide)).count();
    if wide > 0 {
        let strokes = counted(wide, "stroke wider", "strokes wider");
        out.push(format!(
            "{strokes} than {WIDE_STROKE} mm: the DXF holds the middle of a stroke (--strokes outline, when warping, gives its edges)"
        ));
    }
    out
}

/// A number with the noun in the singular or plural.
fn counted(n: usize, one: &str, more: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { more })
}
