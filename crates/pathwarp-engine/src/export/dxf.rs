//! Drawings as DXF, in millimetres: lines are chained, rid of repetitions, and moved to make room for the cut.

use super::contours::{self, Contour};
use super::exported::{Exported, counted};
use super::kerf::{self, Kerf, KerfReport};
use crate::failure::Failure;
use crate::options::CommonOptions;
use crate::units::{MM_PER_PX, units_per_px};
use pathwarp::budget::cost;
use pathwarp::edit::united;
use pathwarp::kurbo::Affine;
use pathwarp::param::{Axis, Frame};
use pathwarp::{Outline, refit};
use pathwarp_dxf::{Curves, Shape};
use pathwarp_svg::{Document, Plot, PlotShape, Selection};
use std::str::FromStr as _;

/// Strokes wider than this, in mm, are hardly meant as lines to cut.
const WIDE_STROKE: f64 = 0.5;

/// Distance in mm within which ends of lines meet, and lines are equal.
const MEETING: f64 = 0.01;

/// Writes the drawing as DXF. The lines follow curves within `tolerance` (user units), or by default within the options' tolerance.
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
    let mm_per_unit = to_mm.determinant().abs().sqrt();
    let engraved = engraved(doc, &plot, &options.engrave)?;
    let unites = |i: usize| options.union || (options.kerf.is_some() && !engraved[i]);
    let mut lines = Vec::new();
    for (shape, s) in plot.shapes.iter().enumerate() {
        let rule = s.even_odd.filter(|_| unites(shape));
        let united = rule.map(|even_odd| united(&s.outline, even_odd, tolerance)).transpose();
        let united = united.map_err(pathwarp::Error::from)?.flatten();
        let outline = united.as_ref().unwrap_or(&s.outline).transformed(to_mm);
        lines.extend(outline.subpaths.into_iter().map(|path| Contour { shape, path }));
    }
    let mut warnings = lost_in_dxf(&plot);
    let frame = Frame::new(doc.view_box()).with_units_per_px(units_per_px(doc));
    let refit = refit::Options::new(tolerance * mm_per_unit).with_nodes(refit::Nodes::Source).with_suited(suited);
    let machine = Machine {
        kerf: options.kerf.map(|kerf| 0.5 * kerf.in_units(Axis::Diagonal, &frame) * mm_per_unit),
        engraved: &engraved,
        keep_duplicates: options.keep_duplicates,
        refit: &refit,
    };
    let (lines, kerf) = followed(doc, &plot, lines, &machine, &mut warnings)?;
    let mut cuts = vec![Outline::default(); plot.shapes.len()];
    lines.into_iter().for_each(|c| cuts[c.shape].subpaths.push(c.path));
    let shapes = plot.shapes.iter().zip(&cuts);
    let shapes: Vec<Shape<'_>> = shapes
        .map(|(s, outline)| Shape { layer: s.layer.as_deref().unwrap_or_default(), color: s.color, outline })
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
    Ok(Exported { bytes: text.into_bytes(), warnings, kerf })
}

/// Settings for the machine that follows the lines.
struct Machine<'a> {
    /// Half the width of its cut in mm, if lines move to make room for it.
    kerf: Option<f64>,
    /// For each shape, `true` if it is engraved instead of cut.
    engraved: &'a [bool],
    keep_duplicates: bool,
    refit: &'a refit::Options,
}

/// Returns the lines in mm that the machine follows: without repetitions, and moved to make room for the cut.
fn followed(
    doc: &Document,
    plot: &Plot,
    mut lines: Vec<Contour>,
    machine: &Machine<'_>,
    warnings: &mut Vec<String>,
) -> Result<(Vec<Contour>, Option<KerfReport>), Failure> {
    let near = machine.refit.tolerance.max(MEETING);
    let limit = |e| pathwarp::Error::limit(doc.name(), "comparing what a machine follows takes", e);
    let pen = |i: usize| (&plot.shapes[i].layer, plot.shapes[i].color);
    // With a kerf, lines are compared across layers and colours, but cut ones never with engraved ones.
    let kind = |i: usize| if machine.kerf.is_some() { Err(machine.engraved[i]) } else { Ok(pen(i)) };
    if machine.kerf.is_some() {
        let (cut, engraved): (Vec<Contour>, Vec<Contour>) = lines.into_iter().partition(|c| !machine.engraved[c.shape]);
        lines = contours::chained(&cut, pen, near);
        lines.extend(engraved);
    }
    let mut equals = contours::equal_earlier(&lines, kind, near, doc.budget()).map_err(limit)?;
    if !machine.keep_duplicates {
        let contours = equals.iter().flatten().count();
        let mut are_first = equals.iter().map(Option::is_none);
        lines.retain(|_| are_first.next().unwrap_or(true));
        let segments = contours::leave_out_lines(&mut lines, kind, near);
        equals = vec![None; lines.len()];
        let counts = [(contours, "contour", "contours"), (segments, "open line", "open lines")];
        let repeated: Vec<String> = counts.iter().filter(|c| c.0 > 0).map(|c| counted(c.0, c.1, c.2)).collect();
        if !repeated.is_empty() {
            warnings.push(format!("drawn twice, and cut once: {} (--duplicates keep)", repeated.join(" and ")));
        }
    }
    let Some(by) = machine.kerf else { return Ok((lines, None)) };
    let spend = |n: f64| doc.budget().spend(cost::COMPARISON * n).map_err(limit);
    let kerf = Kerf { by, near, refit: machine.refit, spend: &spend };
    let is_cut = |c: &Contour| !machine.engraved[c.shape];
    let name = |i: usize| doc.shapes()[plot.shapes[i].shape].id.clone();
    let (mut lines, report) = kerf::compensate(lines, &equals, is_cut, &kerf, name)?;
    lines.sort_by_key(|c| c.shape);
    warnings.extend(report.warnings());
    Ok((lines, Some(report)))
}

/// For each shape, `true` if a selector or a colour exempts it from cutting.
fn engraved(doc: &Document, plot: &Plot, named: &[String]) -> Result<Vec<bool>, Failure> {
    let mut out = vec![false; plot.shapes.len()];
    for name in named {
        let selection = Selection { select: vec![name.clone()], ..Selection::default() };
        let color = svgtypes::Color::from_str(name).ok().map(|c| [c.red, c.green, c.blue]);
        let checked = doc.check_selection(&selection);
        let has_color = |s: &PlotShape| s.color.is_some() && s.color == color;
        if checked.is_err() && plot.shapes.iter().any(has_color) {
            plot.shapes.iter().zip(&mut out).for_each(|(s, out)| *out |= has_color(s));
            continue;
        }
        checked?;
        let selected = doc.are_selected(&selection);
        plot.shapes.iter().zip(&mut out).for_each(|(s, out)| *out |= selected[s.shape]);
    }
    Ok(out)
}

/// Describes the content that outlines cannot show.
fn lost_in_dxf(plot: &Plot) -> Vec<String> {
    let mut out = Vec::new();
    let lost = &plot.lost;
    let counts = [
        (lost.bitmaps, "bitmap", "bitmaps"),
        (lost.patterns, "pattern", "patterns"),
        (lost.filters, "filter", "filters"),
    ];
    let left_out: Vec<String> = counts.iter().filter(|c| c.0 > 0).map(|c| counted(c.0, c.1, c.2)).collect();
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
