//! Writes filters: all seventeen primitives, in their resolved form and in user space.

use super::layers::{Layer, Need};
use super::markup::{self, Markup};
use crate::scene::areas;
use crate::source::markup::Tag;
use crate::source::number::{rectangle, singles};
use pathwarp::kurbo::Rect;
use usvg::filter::{
    ColorChannel, ColorInterpolation, ColorMatrixKind, Composite, CompositeOperator, ConvolveMatrix, EdgeMode, Filter,
    Input, Kind, LightSource, MorphologyOperator, Primitive, TransferFunction, Turbulence, TurbulenceKind,
};

/// Writes a `<filter>` with a region. `pictures` holds the link attributes of its `feImage`s in order. For a `layer`, the part drawn
/// beneath or above the filter's graphic, only the primitives that it needs are written, followed by those that draw it.
pub(super) fn element(
    markup: &Markup<'_>,
    f: &Filter,
    region: Rect,
    id: &str,
    pictures: Vec<String>,
    layer: Option<&Layer>,
) -> String {
    let mut pictures = pictures.into_iter();
    let primitives = f.primitives().iter().enumerate().map(|(i, p)| {
        let space = match p.color_interpolation() {
            ColorInterpolation::SRGB => "sRGB",
            ColorInterpolation::LinearRGB => "linearRGB",
        };
        let begin = |tag: &str| {
            let tag = markup.element(tag).with_all(rectangle(areas::primitive_region(f, p, region)));
            tag.with("color-interpolation-filters", space)
        };
        let (mut tag, content) = primitive(markup, &begin, p, &mut pictures);
        match (layer.map(|l| l.need(i)), p.kind()) {
            (Some(Need::Nothing), _) => return String::new(),
            (Some(_), Kind::ColorMatrix(m)) if let Some(kind) = layer.and_then(|l| l.with_smooth_edges(m)) => {
                tag = color_matrix(begin("feColorMatrix").input("in", m.input()), &kind);
            }
            // A composite that is not cut out passes its input on: the graphic hides the rest.
            (Some(Need::Uncut), Kind::Composite(c)) => tag = begin("feOffset").input("in", c.input1()),
            _ => {}
        }
        let tag = tag.with("result", p.result());
        if content.is_empty() { tag.empty() } else { tag.around(&content) }
    });
    let primitives: String = primitives.collect();
    let filter = markup.element("filter").with("id", id).with("filterUnits", "userSpaceOnUse");
    filter.with_all(rectangle(region)).around(&(primitives + layer.map_or("", |l| &l.drawing)))
}

/// The element of a primitive, begun by `begin`, with its content. An `feImage` takes the next of `pictures`, even if it is left out.
fn primitive(
    markup: &Markup<'_>,
    begin: &dyn Fn(&str) -> Tag,
    primitive: &Primitive,
    pictures: &mut dyn Iterator<Item = String>,
) -> (Tag, String) {
    let tag = match primitive.kind() {
        Kind::DropShadow(s) => begin("feDropShadow")
            .input("in", s.input())
            .numbers("stdDeviation", &[s.std_dev_x().get(), s.std_dev_y().get()])
            .numbers("dx", &[s.dx()])
            .numbers("dy", &[s.dy()])
            .with("flood-color", &markup::shadow_color(s, primitive.color_interpolation()))
            .numbers("flood-opacity", &[s.opacity().get()]),
        Kind::GaussianBlur(b) => begin("feGaussianBlur")
            .input("in", b.input())
            .numbers("stdDeviation", &[b.std_dev_x().get(), b.std_dev_y().get()]),
        Kind::Offset(o) => begin("feOffset").input("in", o.input()).numbers("dx", &[o.dx()]).numbers("dy", &[o.dy()]),
        Kind::Blend(b) => {
            begin("feBlend").input("in", b.input1()).input("in2", b.input2()).with("mode", &b.mode().to_string())
        }
        Kind::Flood(f) => begin("feFlood")
            .with("flood-color", &markup::color(f.color()))
            .numbers("flood-opacity", &[f.opacity().get()]),
        Kind::Composite(c) => composite(begin("feComposite"), c),
        Kind::Merge(m) => {
            let node = |i: &Input| markup.element("feMergeNode").input("in", i).empty();
            return (begin("feMerge"), m.inputs().iter().map(node).collect());
        }
        Kind::Tile(t) => begin("feTile").input("in", t.input()),
        Kind::Image(_) => begin("feImage").raw(&pictures.next().unwrap_or_default()),
        Kind::ComponentTransfer(t) => {
            let all =
                [("feFuncR", t.func_r()), ("feFuncG", t.func_g()), ("feFuncB", t.func_b()), ("feFuncA", t.func_a())];
            let functions = all.into_iter().map(|(tag, f)| transfer(markup.element(tag), f).empty());
            return (begin("feComponentTransfer").input("in", t.input()), functions.collect());
        }
        Kind::ColorMatrix(m) => color_matrix(begin("feColorMatrix").input("in", m.input()), m.kind()),
        Kind::ConvolveMatrix(m) => convolve_matrix(begin("feConvolveMatrix"), m),
        Kind::Morphology(m) => {
            let operator = match m.operator() {
                MorphologyOperator::Erode => "erode",
                MorphologyOperator::Dilate => "dilate",
            };
            let tag = begin("feMorphology").input("in", m.input()).with("operator", operator);
            tag.numbers("radius", &[m.radius_x().get(), m.radius_y().get()])
        }
        Kind::DisplacementMap(m) => begin("feDisplacementMap")
            .input("in", m.input1())
            .input("in2", m.input2())
            .numbers("scale", &[m.scale()])
            .with("xChannelSelector", channel(m.x_channel_selector()))
            .with("yChannelSelector", channel(m.y_channel_selector())),
        Kind::Turbulence(t) => turbulence(begin("feTurbulence"), t),
        Kind::DiffuseLighting(l) => {
            let tag = begin("feDiffuseLighting")
                .input("in", l.input())
                .numbers("surfaceScale", &[l.surface_scale()])
                .numbers("diffuseConstant", &[l.diffuse_constant()])
                .with("lighting-color", &markup::color(l.lighting_color()));
            return (tag, light(markup, l.light_source()));
        }
        Kind::SpecularLighting(l) => {
            let tag = begin("feSpecularLighting")
                .input("in", l.input())
                .numbers("surfaceScale", &[l.surface_scale()])
                .numbers("specularConstant", &[l.specular_constant()])
                .numbers("specularExponent", &[l.specular_exponent()])
                .with("lighting-color", &markup::color(l.lighting_color()));
            return (tag, light(markup, l.light_source()));
        }
    };
    (tag, String::new())
}

impl Tag {
    /// Adds an attribute for the input of a primitive.
    pub(super) fn input(self, name: &str, i: &Input) -> Self {
        match i {
            Input::SourceGraphic => self.with(name, "SourceGraphic"),
            Input::SourceAlpha => self.with(name, "SourceAlpha"),
            Input::Reference(r) => self.with(name, r),
        }
    }

    /// Adds an attribute for a list of numbers.
    pub(super) fn numbers(self, name: &str, values: &[f32]) -> Self {
        self.with(name, &singles(values).join(" "))
    }
}

fn composite(tag: Tag, c: &Composite) -> Tag {
    let tag = tag.input("in", c.input1()).input("in2", c.input2());
    let operator = match c.operator() {
        CompositeOperator::Over => "over",
        CompositeOperator::In => "in",
        CompositeOperator::Out => "out",
        CompositeOperator::Atop => "atop",
        CompositeOperator::Xor => "xor",
        CompositeOperator::Lighter => "lighter",
        CompositeOperator::Arithmetic { k1, k2, k3, k4 } => {
            let tag = tag.with("operator", "arithmetic");
            return tag.numbers("k1", &[k1]).numbers("k2", &[k2]).numbers("k3", &[k3]).numbers("k4", &[k4]);
        }
    };
    tag.with("operator", operator)
}

fn color_matrix(tag: Tag, kind: &ColorMatrixKind) -> Tag {
    match kind {
        ColorMatrixKind::Matrix(v) => tag.with("type", "matrix").numbers("values", v),
        // The CSS function allows values that the primitive does not.
        ColorMatrixKind::Saturate(v) if v.get() > 1.0 => {
            tag.with("type", "matrix").numbers("values", &saturate(v.get()))
        }
        ColorMatrixKind::Saturate(v) => tag.with("type", "saturate").numbers("values", &[v.get()]),
        ColorMatrixKind::HueRotate(v) => tag.with("type", "hueRotate").numbers("values", &[*v]),
        ColorMatrixKind::LuminanceToAlpha => tag.with("type", "luminanceToAlpha"),
    }
}

fn convolve_matrix(tag: Tag, m: &ConvolveMatrix) -> Tag {
    let data = m.matrix();
    let edge = match m.edge_mode() {
        EdgeMode::None => "none",
        EdgeMode::Duplicate => "duplicate",
        EdgeMode::Wrap => "wrap",
    };
    tag.input("in", m.input())
        .with("order", &format!("{} {}", data.columns(), data.rows()))
        .numbers("kernelMatrix", data.data())
        .numbers("divisor", &[m.divisor().get()])
        .numbers("bias", &[m.bias()])
        .with("targetX", &data.target_x().to_string())
        .with("targetY", &data.target_y().to_string())
        .with("edgeMode", edge)
        .with("preserveAlpha", if m.preserve_alpha() { "true" } else { "false" })
}

fn turbulence(tag: Tag, t: &Turbulence) -> Tag {
    let kind = match t.kind() {
        TurbulenceKind::FractalNoise => "fractalNoise",
        TurbulenceKind::Turbulence => "turbulence",
    };
    tag.numbers("baseFrequency", &[t.base_frequency_x().get(), t.base_frequency_y().get()])
        .with("numOctaves", &t.num_octaves().to_string())
        .with("seed", &t.seed().to_string())
        .with("stitchTiles", if t.stitch_tiles() { "stitch" } else { "noStitch" })
        .with("type", kind)
}

fn light(markup: &Markup<'_>, l: LightSource) -> String {
    let tag = match l {
        LightSource::DistantLight(l) => {
            markup.element("feDistantLight").numbers("azimuth", &[l.azimuth]).numbers("elevation", &[l.elevation])
        }
        LightSource::PointLight(l) => {
            markup.element("fePointLight").numbers("x", &[l.x]).numbers("y", &[l.y]).numbers("z", &[l.z])
        }
        LightSource::SpotLight(l) => {
            let tag = markup.element("feSpotLight").numbers("x", &[l.x]).numbers("y", &[l.y]).numbers("z", &[l.z]);
            let tag = tag.numbers("pointsAtX", &[l.points_at_x]).numbers("pointsAtY", &[l.points_at_y]);
            let tag = tag.numbers("pointsAtZ", &[l.points_at_z]);
            let tag = tag.numbers("specularExponent", &[l.specular_exponent.get()]);
            l.limiting_cone_angle.iter().fold(tag, |tag, angle| tag.numbers("limitingConeAngle", &[*angle]))
        }
    };
    tag.empty()
}

fn transfer(tag: Tag, f: &TransferFunction) -> Tag {
    match f {
        TransferFunction::Identity => tag.with("type", "identity"),
        TransferFunction::Table(v) => tag.with("type", "table").numbers("tableValues", v),
        TransferFunction::Discrete(v) => tag.with("type", "discrete").numbers("tableValues", v),
        TransferFunction::Linear { slope, intercept } => {
            tag.with("type", "linear").numbers("slope", &[*slope]).numbers("intercept", &[*intercept])
        }
        TransferFunction::Gamma { amplitude, exponent, offset } => {
            let tag = tag.with("type", "gamma").numbers("amplitude", &[*amplitude]);
            tag.numbers("exponent", &[*exponent]).numbers("offset", &[*offset])
        }
    }
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
    // Alpha stays.
    out[18] = 1.0;
    out
}
