//! Drawings as DXF, in millimetres.

use super::exported::{Exported, counted};
use super::kerf::{self, Cut};
use crate::failure::Failure;
use crate::options::CommonOptions;
use crate::units::{MM_PER_PX, units_per_px};
use pathwarp::budget::cost;
use pathwarp::edit::united;
use pathwarp::kurbo::Affine;
use pathwarp::param::{Axis, Frame};
use pathwarp::refit;
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
    let suited = options.tolerance.is_none();
    let tolerance = tolerance.map_or_else(default, Ok)?;
    let cut = |s: &PlotShape| -> Result<Cut, Failure> {
        let rule = s.even_odd.filter(|_| options.union);
        let united = rule.map(|even_odd| united(&s.outline, even_odd, tolerance)).transpose();
        let united = united.map_err(pathwarp::Error::from)?.flatten();
        Ok(Cut { outline: united.as_ref().unwrap_or(&s.outline).transformed(to_mm), even_odd: s.even_odd })
    };
    let mut cuts: Vec<Cut> = plot.shapes.iter().map(cut).collect::<Result<_, _>>()?;
    let mut warnings = lost_in_dxf(&plot);
    let mm_per_unit = to_mm.determinant().abs().sqrt();
    if let Some(kerf) = options.kerf {
        let frame = Frame::new(doc.view_box()).with_units_per_px(units_per_px(doc));
        let by = 0.5 * kerf.in_units(Axis::Diagonal, &frame) * mm_per_unit;
        let contours = cuts.iter().map(|c| c.outline.subpaths.len() as f64).sum::<f64>();
        let spent = doc.budget().spend(cost::COMPARISON * contours * contours);
        spent.map_err(|e| pathwarp::Error::limit(doc.name(), "with --kerf, it takes", e))?;
        let together = |i: usize| (&plot.shapes[i].layer, plot.shapes[i].color);
        let refit = refit::Options::new(tolerance * mm_per_unit).with_suited(suited);
        let fewer = kerf::widen(&mut cuts, together, by, &refit).map_err(pathwarp::Error::from)?;
        if fewer > 0 {
            let contours = counted(fewer, "contour", "contours");
            warnings.push(format!("--kerf leaves {contours} fewer: narrow ones close, and those that meet unite"));
        }
    }
    let shapes = plot.shapes.iter().zip(&cuts);
    let shapes: Vec<Shape<'_>> = shapes
        .map(|(s, cut)| Shape { layer: s.layer.as_deref().unwrap_or_default(), color: s.color, outline: &cut.outline })
        .collect();
    let settings = pathwarp_dxf::Options {
        curves: if options.dxf_polylines { Curves::Polylines } else { Curves::Splines },
        tolerance: tolerance * mm_per_unit,
        suited,
        page,
        limits: doc.budget().limits(),
    };
    let text = pathwarp_dxf::write(&shapes, &settings)
        .map_err(|e| pathwarp::Error::limit(doc.name(), "as polylines, it takes", e))?;
    Ok(Exported { bytes: text.into_bytes(), warnings })
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
