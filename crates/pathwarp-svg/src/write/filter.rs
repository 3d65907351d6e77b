//! Filters: all seventeen primitives, in their resolved form and in user space.

use super::markup::{self, Markup};
use crate::scene::areas;
use crate::source::number::short;
use pathwarp::kurbo::Rect;
use pathwarp_reader::xml::escape;
use std::fmt::Write as _;
use usvg::filter::{
    ColorChannel, ColorInterpolation, ColorMatrix, ColorMatrixKind, ComponentTransfer, Composite, CompositeOperator,
    ConvolveMatrix, DiffuseLighting, DisplacementMap, DropShadow, EdgeMode, Filter, Input, Kind, LightSource, Merge,
    Morphology, MorphologyOperator, SpecularLighting, TransferFunction, Turbulence, TurbulenceKind,
};

/// Writes a `<filter>` with the region `all`. `head` holds its id, `pictures` the link attributes of its `feImage`s in order.
pub(super) fn element(markup: &Markup<'_>, f: &Filter, all: Rect, head: &str, pictures: Vec<String>) -> String {
    let mut pictures = pictures.into_iter();
    let region = |r: Rect| region(r).map(|(name, value)| word(name, &value)).concat();
    let filter = markup.tag("filter");
    let mut out = format!("<{filter}{head} filterUnits=\"userSpaceOnUse\"{}>", region(all));
    for p in f.primitives() {
        let Primitive { tag, attributes, content } = primitive(markup, p.kind(), &mut pictures);
        let space = match p.color_interpolation() {
            ColorInterpolation::SRGB => "sRGB",
            ColorInterpolation::LinearRGB => "linearRGB",
        };
        let tag = markup.tag(tag);
        let _ = write!(
            out,
            "<{tag}{}{}{attributes}{}",
            region(areas::part(f, p, all)),
            word("color-interpolation-filters", space),
            word("result", &escape(p.result()))
        );
        if content.is_empty() {
            out.push_str("/>");
        } else {
            let _ = write!(out, ">{content}</{tag}>");
        }
    }
    let _ = write!(out, "</{filter}>");
    out
}

/// The attributes of a region in user space.
pub(super) fn region(r: Rect) -> [(&'static str, String); 4] {
    [("x", short(r.x0)), ("y", short(r.y0)), ("width", short(r.width())), ("height", short(r.height()))]
}

/// A filter primitive.
struct Primitive {
    tag: &'static str,
    attributes: String,
    content: String,
}

impl Primitive {
    fn new(tag: &'static str, attributes: String) -> Self {
        Self { tag, attributes, content: String::new() }
    }

    fn with_content(self, content: String) -> Self {
        Self { content, ..self }
    }
}

fn primitive(markup: &Markup<'_>, kind: &Kind, pictures: &mut impl Iterator<Item = String>) -> Primitive {
    match kind {
        Kind::DropShadow(s) => drop_shadow(s),
        Kind::GaussianBlur(b) => {
            let deviation = pair("stdDeviation", b.std_dev_x().get(), b.std_dev_y().get());
            Primitive::new("feGaussianBlur", input("in", b.input()) + &deviation)
        }
        Kind::Offset(o) => {
            Primitive::new("feOffset", input("in", o.input()) + &number("dx", o.dx()) + &number("dy", o.dy()))
        }
        Kind::Blend(b) => {
            let inputs = input("in", b.input1()) + &input("in2", b.input2());
            Primitive::new("feBlend", inputs + &word("mode", &b.mode().to_string()))
        }
        Kind::Flood(f) => {
            let opacity = number("flood-opacity", f.opacity().get());
            Primitive::new("feFlood", color("flood-color", f.color()) + &opacity)
        }
        Kind::Composite(c) => composite(c),
        Kind::Merge(m) => merge(markup, m),
        Kind::Tile(t) => Primitive::new("feTile", input("in", t.input())),
        Kind::Image(_) => Primitive::new("feImage", pictures.next().unwrap_or_default()),
        Kind::ComponentTransfer(t) => component_transfer(markup, t),
        Kind::ColorMatrix(m) => color_matrix(m),
        Kind::ConvolveMatrix(m) => convolve_matrix(m),
        Kind::Morphology(m) => morphology(m),
        Kind::DisplacementMap(m) => displacement_map(m),
        Kind::Turbulence(t) => turbulence(t),
        Kind::DiffuseLighting(l) => diffuse_lighting(markup, l),
        Kind::SpecularLighting(l) => specular_lighting(markup, l),
    }
}

fn drop_shadow(s: &DropShadow) -> Primitive {
    let attributes = input("in", s.input())
        + &pair("stdDeviation", s.std_dev_x().get(), s.std_dev_y().get())
        + &number("dx", s.dx())
        + &number("dy", s.dy())
        + &color("flood-color", s.color())
        + &number("flood-opacity", s.opacity().get());
    Primitive::new("feDropShadow", attributes)
}

fn composite(c: &Composite) -> Primitive {
    let operator = match c.operator() {
        CompositeOperator::Over => word("operator", "over"),
        CompositeOperator::In => word("operator", "in"),
        CompositeOperator::Out => word("operator", "out"),
        CompositeOperator::Atop => word("operator", "atop"),
        CompositeOperator::Xor => word("operator", "xor"),
        CompositeOperator::Lighter => word("operator", "lighter"),
        CompositeOperator::Arithmetic { k1, k2, k3, k4 } => {
            word("operator", "arithmetic")
                + &number("k1", k1)
                + &number("k2", k2)
                + &number("k3", k3)
                + &number("k4", k4)
        }
    };
    Primitive::new("feComposite", input("in", c.input1()) + &input("in2", c.input2()) + &operator)
}

fn merge(markup: &Markup<'_>, m: &Merge) -> Primitive {
    let node = markup.tag("feMergeNode");
    let inputs = m.inputs().iter().map(|i| format!("<{node}{}/>", input("in", i))).collect();
    Primitive::new("feMerge", String::new()).with_content(inputs)
}

fn component_transfer(markup: &Markup<'_>, t: &ComponentTransfer) -> Primitive {
    let functions = transfer(&markup.tag("feFuncR"), t.func_r())
        + &transfer(&markup.tag("feFuncG"), t.func_g())
        + &transfer(&markup.tag("feFuncB"), t.func_b())
        + &transfer(&markup.tag("feFuncA"), t.func_a());
    Primitive::new("feComponentTransfer", input("in", t.input())).with_content(functions)
}

fn color_matrix(m: &ColorMatrix) -> Primitive {
    let kind = match m.kind() {
        ColorMatrixKind::Matrix(v) => word("type", "matrix") + &list("values", v),
        // The CSS function allows values that the primitive does not.
        ColorMatrixKind::Saturate(v) if v.get() > 1.0 => word("type", "matrix") + &list("values", &saturate(v.get())),
        ColorMatrixKind::Saturate(v) => word("type", "saturate") + &number("values", v.get()),
        ColorMatrixKind::HueRotate(v) => word("type", "hueRotate") + &number("values", *v),
        ColorMatrixKind::LuminanceToAlpha => word("type", "luminanceToAlpha"),
    };
    Primitive::new("feColorMatrix", input("in", m.input()) + &kind)
}

fn convolve_matrix(m: &ConvolveMatrix) -> Primitive {
    let data = m.matrix();
    let edge = match m.edge_mode() {
        EdgeMode::None => "none",
        EdgeMode::Duplicate => "duplicate",
        EdgeMode::Wrap => "wrap",
    };
    let attributes = input("in", m.input())
        + &word("order", &format!("{} {}", data.columns(), data.rows()))
        + &list("kernelMatrix", data.data())
        + &number("divisor", m.divisor().get())
        + &number("bias", m.bias())
        + &word("targetX", &data.target_x().to_string())
        + &word("targetY", &data.target_y().to_string())
        + &word("edgeMode", edge)
        + &word("preserveAlpha", if m.preserve_alpha() { "true" } else { "false" });
    Primitive::new("feConvolveMatrix", attributes)
}

fn morphology(m: &Morphology) -> Primitive {
    let operator = match m.operator() {
        MorphologyOperator::Erode => "erode",
        MorphologyOperator::Dilate => "dilate",
    };
    let attributes =
        input("in", m.input()) + &word("operator", operator) + &pair("radius", m.radius_x().get(), m.radius_y().get());
    Primitive::new("feMorphology", attributes)
}

fn displacement_map(m: &DisplacementMap) -> Primitive {
    let attributes = input("in", m.input1())
        + &input("in2", m.input2())
        + &number("scale", m.scale())
        + &word("xChannelSelector", channel(m.x_channel_selector()))
        + &word("yChannelSelector", channel(m.y_channel_selector()));
    Primitive::new("feDisplacementMap", attributes)
}

fn turbulence(t: &Turbulence) -> Primitive {
    let kind = match t.kind() {
        TurbulenceKind::FractalNoise => "fractalNoise",
        TurbulenceKind::Turbulence => "turbulence",
    };
    let attributes = pair("baseFrequency", t.base_frequency_x().get(), t.base_frequency_y().get())
        + &word("numOctaves", &t.num_octaves().to_string())
        + &word("seed", &t.seed().to_string())
        + &word("stitchTiles", if t.stitch_tiles() { "stitch" } else { "noStitch" })
        + &word("type", kind);
    Primitive::new("feTurbulence", attributes)
}

fn diffuse_lighting(markup: &Markup<'_>, l: &DiffuseLighting) -> Primitive {
    let attributes = input("in", l.input())
        + &number("surfaceScale", l.surface_scale())
        + &number("diffuseConstant", l.diffuse_constant())
        + &color("lighting-color", l.lighting_color());
    Primitive::new("feDiffuseLighting", attributes).with_content(light(markup, l.light_source()))
}

fn specular_lighting(markup: &Markup<'_>, l: &SpecularLighting) -> Primitive {
    let attributes = input("in", l.input())
        + &number("surfaceScale", l.surface_scale())
        + &number("specularConstant", l.specular_constant())
        + &number("specularExponent", l.specular_exponent())
        + &color("lighting-color", l.lighting_color());
    Primitive::new("feSpecularLighting", attributes).with_content(light(markup, l.light_source()))
}

fn light(markup: &Markup<'_>, l: LightSource) -> String {
    match l {
        LightSource::DistantLight(l) => {
            let at = number("azimuth", l.azimuth) + &number("elevation", l.elevation);
            format!("<{}{at}/>", markup.tag("feDistantLight"))
        }
        LightSource::PointLight(l) => {
            let at = number("x", l.x) + &number("y", l.y) + &number("z", l.z);
            format!("<{}{at}/>", markup.tag("fePointLight"))
        }
        LightSource::SpotLight(l) => {
            let mut at = number("x", l.x) + &number("y", l.y) + &number("z", l.z);
            at += &(number("pointsAtX", l.points_at_x)
                + &number("pointsAtY", l.points_at_y)
                + &number("pointsAtZ", l.points_at_z));
            at += &number("specularExponent", l.specular_exponent.get());
            if let Some(angle) = l.limiting_cone_angle {
                at += &number("limitingConeAngle", angle);
            }
            format!("<{}{at}/>", markup.tag("feSpotLight"))
        }
    }
}

fn input(name: &str, i: &Input) -> String {
    let value = match i {
        Input::SourceGraphic => "SourceGraphic".into(),
        Input::SourceAlpha => "SourceAlpha".into(),
        Input::Reference(r) => escape(r),
    };
    format!(" {name}=\"{value}\"")
}

fn number(name: &str, v: f32) -> String {
    format!(" {name}=\"{}\"", short(v.into()))
}

fn pair(name: &str, a: f32, b: f32) -> String {
    format!(" {name}=\"{} {}\"", short(a.into()), short(b.into()))
}

fn list(name: &str, values: &[f32]) -> String {
    let all: Vec<String> = values.iter().map(|v| short((*v).into())).collect();
    format!(" {name}=\"{}\"", all.join(" "))
}

fn word(name: &str, value: &str) -> String {
    format!(" {name}=\"{value}\"")
}

fn color(name: &str, c: usvg::Color) -> String {
    format!(" {name}=\"{}\"", markup::color(c))
}

fn transfer(tag: &str, f: &TransferFunction) -> String {
    let body = match f {
        TransferFunction::Identity => word("type", "identity"),
        TransferFunction::Table(v) => word("type", "table") + &list("tableValues", v),
        TransferFunction::Discrete(v) => word("type", "discrete") + &list("tableValues", v),
        TransferFunction::Linear { slope, intercept } => {
            word("type", "linear") + &number("slope", *slope) + &number("intercept", *intercept)
        }
        TransferFunction::Gamma { amplitude, exponent, offset } => {
            word("type", "gamma")
                + &number("amplitude", *amplitude)
                + &number("exponent", *exponent)
                + &number("offset", *offset)
        }
    };
    format!("<{tag}{body}/>")
}

fn channel(c: ColorChannel) -> &'static str {
    match c {
        ColorChannel::R => "R",
        ColorChannel::G => "G",
        ColorChannel::B => "B",
        ColorChannel::A => "A",
    }
}

/// Matrix of `saturate` (Filter Effects Module Level 1, §9.6), which keeps the luminance and scales the saturation.
fn saturate(s: f32) -> [f32; 20] {
    const LUMINANCE: [f32; 3] = [0.213, 0.715, 0.072];
    let mut out = [0.0; 20];
    for (row, values) in out.chunks_mut(5).enumerate().take(3) {
        for (column, (v, l)) in values.iter_mut().zip(LUMINANCE).enumerate() {
            *v = l - l * s + if row == column { s } else { 0.0 };
        }
    }
    out[18] = 1.0;
    out
}
