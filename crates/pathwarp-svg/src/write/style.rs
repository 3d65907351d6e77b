//! Presentation properties of parts.

use super::markup::{Markup, Properties};
use super::values::dashes;
use crate::scene::model::Part;
use crate::source::number::short;
use usvg::{FillRule, LineCap, LineJoin, PaintOrder, ShapeRendering};

/// Paints of a part as CSS values; `None` for a paint that is missing or not written.
#[derive(Default)]
pub(super) struct CssPaints {
    pub(super) fill: Option<String>,
    pub(super) stroke: Option<String>,
}

/// Properties common to the fill and the expanded stroke of a part.
fn shared(markup: &Markup<'_>, p: &Part) -> Properties {
    let mut out = Properties::new();
    if !p.visible {
        out.push(("visibility", "hidden".into()));
    } else if markup.may_inherit("visibility") {
        out.push(("visibility", "visible".into()));
    }
    match p.rendering {
        ShapeRendering::GeometricPrecision => {
            if markup.may_inherit("shape-rendering") {
                out.push(("shape-rendering", "auto".into()));
            }
        }
        ShapeRendering::OptimizeSpeed => out.push(("shape-rendering", "optimizeSpeed".into())),
        ShapeRendering::CrispEdges => out.push(("shape-rendering", "crispEdges".into())),
    }
    if markup.may_inherit("marker") {
        out.extend(["marker-start", "marker-mid", "marker-end"].map(|n| (n, "none".to_owned())));
    }
    out
}

/// Properties of an expanded stroke.
pub(super) fn outlined(markup: &Markup<'_>, p: &Part, stroke: &usvg::Stroke, paint: String) -> Properties {
    let mut out = shared(markup, p);
    out.push(("fill", paint));
    out.push(("fill-opacity", short(f64::from(stroke.opacity().get()))));
    out.push(("fill-rule", "nonzero".into()));
    out.push(("stroke", "none".into()));
    out.retain(|(n, v)| !(*n == "fill-opacity" && v == "1" || *n == "fill-rule") || markup.may_inherit(n));
    out
}

/// Properties of a part with the given paints, with the stroke's width and dashes multiplied by `scale`.
pub(super) fn part_style(markup: &Markup<'_>, p: &Part, paints: CssPaints, scale: f64) -> Properties {
    let mut all = shared(markup, p);
    match (&p.fill, paints.fill) {
        (Some(f), Some(paint)) => {
            all.push(("fill", paint));
            all.push(("fill-opacity", short(f64::from(f.opacity().get()))));
            all.push(("fill-rule", if f.rule() == FillRule::EvenOdd { "evenodd" } else { "nonzero" }.into()));
        }
        _ => all.push(("fill", "none".into())),
    }
    match (&p.stroke, paints.stroke) {
        (Some(s), Some(paint)) => {
            push_stroke(s, paint, scale, &mut all);
            if p.fixed_width {
                all.push(("vector-effect", "non-scaling-stroke".into()));
            }
        }
        _ => all.push(("stroke", "none".into())),
    }
    let order = match p.paint_order {
        PaintOrder::FillAndStroke => "normal",
        PaintOrder::StrokeAndFill => "stroke",
    };
    all.push(("paint-order", order.into()));
    all.retain(|(name, value)| !is_default(name, value) || markup.may_inherit(name));
    all
}

fn push_stroke(s: &usvg::Stroke, paint: String, scale: f64, all: &mut Properties) {
    all.push(("stroke", paint));
    all.push(("stroke-opacity", short(f64::from(s.opacity().get()))));
    all.push(("stroke-width", short(f64::from(s.width().get()) * scale)));
    let cap = match s.linecap() {
        LineCap::Butt => "butt",
        LineCap::Round => "round",
        LineCap::Square => "square",
    };
    all.push(("stroke-linecap", cap.into()));
    let join = match s.linejoin() {
        LineJoin::Miter => "miter",
        LineJoin::MiterClip => "miter-clip",
        LineJoin::Round => "round",
        LineJoin::Bevel => "bevel",
    };
    all.push(("stroke-linejoin", join.into()));
    all.push(("stroke-miterlimit", short(f64::from(s.miterlimit().get()))));
    all.push(("stroke-dasharray", dashes(s, scale)));
    all.push(("stroke-dashoffset", short(f64::from(s.dashoffset()) * scale)));
}

/// Returns `true` if a value is the property's initial value.
fn is_default(name: &str, value: &str) -> bool {
    let default = match name {
        "fill-opacity" | "stroke-opacity" | "stroke-width" => "1",
        "fill-rule" => "nonzero",
        "stroke" | "stroke-dasharray" => "none",
        "stroke-linecap" => "butt",
        "stroke-linejoin" => "miter",
        "stroke-miterlimit" => "4",
        "stroke-dashoffset" => "0",
        "paint-order" => "normal",
        _ => return false,
    };
    value == default
}
