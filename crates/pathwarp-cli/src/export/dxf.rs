//! Drawings as DXF, in millimetres.

use super::exported::{Exported, counted};
use crate::failure::Failure;
use crate::options::CommonOptions;
use crate::units::{MM_PER_PX, units_per_px};
use pathwarp::Outline;
use pathwarp::edit::united;
use pathwarp::kurbo::Affine;
use pathwarp::param::Frame;
use pathwarp_dxf::{Curves, Shape};
use pathwarp_svg::{Document, Plot, PlotShape, Selection};

/// Strokes that are wider than this many mm are hardly meant as lines to cut.
const WIDE_STROKE: f64 = 0.5;

/// The drawing as DXF. The lines follow curves within `tolerance` (user units), or within that of the options.
pub(super) fn write(doc: &Document, options: &CommonOptions, tolerance: Option<f64>) -> Result<Exported, Failure> {
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
        curves: if options.dxf_polylines { Curves::Polylines } else { Curves::Splines },
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
