//! Writes elements, attributes and styles by the conventions of the surrounding file.

use crate::bend::outcome::WarpedPart;
use crate::bend::pictures::BentImage;
use crate::scene::model::Part;
use crate::source::markup::Tag;
use crate::source::number::{outline_data, push, rectangle, single};
use crate::source::text::SourceText;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use pathwarp::kurbo::{Affine, Rect, Shape as _};
use pathwarp_reader::xml::escape;
use std::cell::RefCell;
use std::collections::HashMap;
use usvg::filter::{ColorInterpolation, DropShadow};
use usvg::{FillRule, LineCap, LineJoin, PaintOrder, ShapeRendering};

/// Presentation properties in order.
pub(super) type Properties = Vec<(&'static str, String)>;

/// Conventions of the file to which elements are written.
pub(super) struct Markup<'a> {
    source: &'a SourceText,
    /// Namespace prefix of elements with its colon; usually empty.
    pub(super) prefix: String,
    /// `true` if elements are written into the source, whose definitions they can refer to.
    pub(super) in_source: bool,
    /// `true` if properties are written to style attributes, which style sheets cannot override.
    pub(super) styled: bool,
    /// Cache: for a property, `true` if its name occurs in the source.
    mentioned: RefCell<HashMap<&'static str, bool>>,
}

impl<'a> Markup<'a> {
    pub(super) fn new(source: &'a SourceText, in_source: bool) -> Self {
        Self {
            source,
            prefix: if in_source { source.prefix().to_owned() } else { String::new() },
            in_source,
            styled: in_source && source.has_css(),
            mentioned: RefCell::default(),
        }
    }

    /// Returns `true` if an ancestor in the source may set a property, so that its default must be written out.
    pub(super) fn may_inherit(&self, name: &'static str) -> bool {
        let is_mentioned = || self.source.text.contains(name);
        self.in_source && *self.mentioned.borrow_mut().entry(name).or_insert_with(is_mentioned)
    }

    /// Adds a property, unless it has its default and no ancestor in the source may set it.
    pub(super) fn push_unless_default(&self, name: &'static str, value: &str, default: &str, out: &mut Properties) {
        if value != default || self.may_inherit(name) {
            out.push((name, value.to_owned()));
        }
    }

    /// Begins an element.
    pub(super) fn element(&self, name: &str) -> Tag {
        Tag::new(format!("{}{name}", self.prefix))
    }

    /// Name of the attribute for links.
    pub(super) fn link(&self) -> &'static str {
        let root = self.source.elements.first().map(|root| &self.source.text[root.range.start..root.open_end]);
        let declared = root.is_some_and(|root| root.contains("xmlns:xlink="));
        if self.in_source && !declared { "href" } else { "xlink:href" }
    }

    pub(super) fn title(&self, text: &str) -> String {
        self.element("title").around(&escape(text))
    }

    /// Wraps content in a group with the attribute `id`, unless that is empty.
    pub(super) fn named_group(&self, id: &str, content: String) -> String {
        if id.is_empty() { content } else { self.element("g").raw(id).around(&content) }
    }

    /// Properties as attributes, or as a style attribute if style sheets could override those.
    pub(super) fn attributes(&self, properties: &Properties) -> String {
        if self.styled && !properties.is_empty() {
            let all: Vec<String> = properties.iter().map(|(n, v)| format!("{n}:{v}")).collect();
            return format!(" style=\"{}\"", escape(&all.join(";")));
        }
        let mut out = String::new();
        for (n, v) in properties {
            // These properties have no presentation attribute.
            if matches!(*n, "mix-blend-mode" | "isolation") {
                out.extend([" style=\"", n, ":", v, "\""]);
            } else {
                out.extend([" ", n, "=\"", &escape(v), "\""]);
            }
        }
        out
    }

    /// Writes a path with the attribute `id` (empty for none).
    pub(super) fn path(&self, d: &str, id: &str, properties: &Properties) -> String {
        ["<", &self.prefix, "path", id, " d=\"", d, "\"", &self.attributes(properties), "/>"].concat()
    }
}

/// A paint and its opacity as CSS values; `None` for inherited values.
pub(super) struct CssPaint {
    pub(super) paint: Option<String>,
    pub(super) opacity: Option<String>,
}

/// Paints of a part; `None` for a paint that is missing or not written.
#[derive(Default)]
pub(super) struct CssPaints {
    pub(super) fill: Option<CssPaint>,
    pub(super) stroke: Option<CssPaint>,
}

/// Properties common to a part and its expanded stroke. Defaults are left out unless an ancestor may set the property.
fn shared(markup: &Markup<'_>, p: &Part) -> Properties {
    let mut out = Properties::new();
    markup.push_unless_default("visibility", if p.visible { "visible" } else { "hidden" }, "visible", &mut out);
    let rendering = match p.rendering {
        ShapeRendering::GeometricPrecision => "auto",
        ShapeRendering::OptimizeSpeed => "optimizeSpeed",
        ShapeRendering::CrispEdges => "crispEdges",
    };
    markup.push_unless_default("shape-rendering", rendering, "auto", &mut out);
    if markup.may_inherit("marker") {
        out.extend(["marker-start", "marker-mid", "marker-end"].map(|n| (n, "none".to_owned())));
    }
    out
}

/// Properties of an expanded stroke.
pub(super) fn outlined(markup: &Markup<'_>, p: &Part, stroke: CssPaint) -> Properties {
    let mut out = shared(markup, p);
    out.extend(stroke.paint.map(|v| ("fill", v)));
    out.extend(stroke.opacity.map(|v| ("fill-opacity", v)));
    out.push(("fill-rule", "nonzero".into()));
    out.push(("stroke", "none".into()));
    out.retain(|(n, v)| !((*n == "fill-opacity" && v == "1") || *n == "fill-rule") || markup.may_inherit(n));
    out
}

/// Properties of a part with the given paints, with the stroke's width and dashes multiplied by `scale`.
pub(super) fn part_style(markup: &Markup<'_>, p: &Part, paints: CssPaints, scale: f64) -> Properties {
    let mut all = shared(markup, p);
    match (&p.fill, paints.fill) {
        (Some(f), Some(css)) => {
            all.extend(css.paint.map(|v| ("fill", v)));
            all.extend(css.opacity.map(|v| ("fill-opacity", v)));
            all.push(("fill-rule", fill_rule(f.rule()).into()));
        }
        _ => all.push(("fill", "none".into())),
    }
    match (&p.stroke, paints.stroke) {
        (Some(s), Some(css)) => {
            push_stroke(s, css, scale, &mut all);
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

fn push_stroke(s: &usvg::Stroke, css: CssPaint, scale: f64, all: &mut Properties) {
    all.extend(css.paint.map(|v| ("stroke", v)));
    all.extend(css.opacity.map(|v| ("stroke-opacity", v)));
    all.push(("stroke-width", single(f64::from(s.width().get()) * scale)));
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
    all.push(("stroke-miterlimit", single(f64::from(s.miterlimit().get()))));
    all.push(("stroke-dasharray", dashes(s, scale)));
    all.push(("stroke-dashoffset", single(f64::from(s.dashoffset()) * scale)));
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

/// Position of a bent bitmap as attributes of its element, whose user space `to_user` leads to.
pub(super) fn bent_attributes(bent: &BentImage, to_user: Affine) -> [(&'static str, String); 5] {
    let [x, y, width, height] = rectangle(to_user.transform_rect_bbox(bent.area));
    [x, y, width, height, ("preserveAspectRatio", "none".into())]
}

/// A file as a `data:` URL.
pub(super) fn data_url(media_type: &str, data: &[u8]) -> String {
    format!("data:{media_type};base64,{}", STANDARD.encode(data))
}

/// A bent bitmap as a `data:` URL.
pub(super) fn bent_url(bent: &BentImage) -> String {
    data_url(bent.media_type(), &bent.file)
}

/// Bounding box of a part's path in its user space.
pub(super) fn part_box(p: &Part, warped: Option<&WarpedPart>) -> Rect {
    match warped {
        Some(w) => w.fill.iter().fold(w.path.bounding_box(), |b, f| b.union(f.bounding_box())),
        None => p.local.bounding_box().unwrap_or_default(),
    }
}

/// Path data of a part. If it is unchanged, its original text is used where possible.
pub(super) fn part_data(p: &Part, warped: Option<&WarpedPart>, source: &SourceText) -> String {
    if let Some(w) = warped {
        return w.data.clone().unwrap_or_else(|| w.text(&w.path));
    }
    let original = p.drawn.and_then(|e| source.attr(e, "d").filter(|_| source.elements[e].tag == "path"));
    original.map_or_else(|| outline_data(&p.local), |d| escape(&d))
}

/// Factor for the width and dashes of a part's stroke.
pub(super) fn stroke_scale(warped: Option<&WarpedPart>) -> f64 {
    warped.map_or(1.0, |w| w.stroke.scale())
}

/// The dashes of a stroke multiplied by `scale`, as the value of `stroke-dasharray`.
pub(super) fn dashes(s: &usvg::Stroke, scale: f64) -> String {
    let Some(list) = s.dasharray() else { return "none".into() };
    list.iter().map(|d| single(f64::from(*d) * scale)).collect::<Vec<_>>().join(",")
}

/// Begins an SVG drawing of an area.
pub(super) fn svg(view: Rect) -> Tag {
    let tag = Tag::new("svg").with("xmlns", "http://www.w3.org/2000/svg");
    let tag = tag.with("xmlns:xlink", "http://www.w3.org/1999/xlink");
    tag.with("viewBox", &rectangle(view).map(|side| side.1).join(" "))
}

/// A number rounded to decimals.
pub(super) fn number(v: f64, decimals: u8) -> String {
    let mut out = String::new();
    push(&mut out, v, decimals);
    out
}

/// A fill rule as a CSS value.
pub(super) fn fill_rule(rule: FillRule) -> &'static str {
    if rule == FillRule::EvenOdd { "evenodd" } else { "nonzero" }
}

/// A colour as `#rrggbb`.
pub(super) fn color(c: usvg::Color) -> String {
    format!("#{:02x}{:02x}{:02x}", c.red, c.green, c.blue)
}

/// The colour of a drop shadow as browsers paint it. The reader has changed sRGB colours to linear light, which resvg expects.
pub(super) fn shadow_color(s: &DropShadow, space: ColorInterpolation) -> String {
    // The transfer function of sRGB (CSS Color 4, section 10.2).
    let encoded = |c: u8| {
        let v = f64::from(c) / 255.0;
        (255.0 * if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }).round() as u8
    };
    let c = s.color();
    match space {
        ColorInterpolation::SRGB => color(usvg::Color::new_rgb(encoded(c.red), encoded(c.green), encoded(c.blue))),
        ColorInterpolation::LinearRGB => color(c),
    }
}
