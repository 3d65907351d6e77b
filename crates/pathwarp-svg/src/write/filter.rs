//! Writes filters, all seventeen primitives, from their resolved form.

use crate::source::number::{escape, short};
use crate::write::fragment::Writer;
use std::fmt::Write as _;
use usvg::filter::{
    ColorChannel, ColorInterpolation, ColorMatrixKind, CompositeOperator, EdgeMode, Filter, Input, Kind, LightSource,
    MorphologyOperator, TransferFunction, TurbulenceKind,
};

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
    format!(" {name}=\"#{:02x}{:02x}{:02x}\"", c.red, c.green, c.blue)
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

/// The matrix of `saturate`, by the Filter Effects Module Level 1, §9.6: what keeps the luminance and stretches the rest.
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

impl Writer<'_> {
    fn light(&self, l: LightSource) -> String {
        match l {
            LightSource::DistantLight(l) => {
                let at = number("azimuth", l.azimuth) + &number("elevation", l.elevation);
                format!("<{}{at}/>", self.tag("feDistantLight"))
            }
            LightSource::PointLight(l) => {
                let at = number("x", l.x) + &number("y", l.y) + &number("z", l.z);
                format!("<{}{at}/>", self.tag("fePointLight"))
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
                format!("<{}{at}/>", self.tag("feSpotLight"))
            }
        }
    }

    /// The whole `<filter>`, in user space; `head` holds its id.
    pub(crate) fn filter_element(&mut self, f: &Filter, head: &str) -> String {
        let r = f.rect();
        let place = |r: usvg::NonZeroRect| {
            number("x", r.x()) + &number("y", r.y()) + &number("width", r.width()) + &number("height", r.height())
        };
        let mut out = format!("<{}{head} filterUnits=\"userSpaceOnUse\"{}>", self.tag("filter"), place(r));
        for p in f.primitives() {
            let (tag, attrs, inner) = self.primitive(p.kind());
            let space = match p.color_interpolation() {
                ColorInterpolation::SRGB => "sRGB",
                ColorInterpolation::LinearRGB => "linearRGB",
            };
            let tag = self.tag(tag);
            let _ = write!(
                out,
                "<{tag}{}{}{attrs}{}",
                place(p.rect()),
                word("color-interpolation-filters", space),
                word("result", &escape(p.result()))
            );
            if inner.is_empty() {
                out.push_str("/>");
            } else {
                let _ = write!(out, ">{inner}</{tag}>");
            }
        }
        let _ = write!(out, "</{}>", self.tag("filter"));
        out
    }

    /// Tag, attributes and content of a primitive.
    fn primitive(&mut self, kind: &Kind) -> (&'static str, String, String) {
        let none = String::new();
        match kind {
            Kind::DropShadow(s) => (
                "feDropShadow",
                input("in", s.input())
                    + &pair("stdDeviation", s.std_dev_x().get(), s.std_dev_y().get())
                    + &number("dx", s.dx())
                    + &number("dy", s.dy())
                    + &color("flood-color", s.color())
                    + &number("flood-opacity", s.opacity().get()),
                none,
            ),
            Kind::GaussianBlur(b) => (
                "feGaussianBlur",
                input("in", b.input()) + &pair("stdDeviation", b.std_dev_x().get(), b.std_dev_y().get()),
                none,
            ),
            Kind::Offset(o) => {
                ("feOffset", input("in", o.input()) + &number("dx", o.dx()) + &number("dy", o.dy()), none)
            }
            Kind::Blend(b) => (
                "feBlend",
                input("in", b.input1()) + &input("in2", b.input2()) + &word("mode", &b.mode().to_string()),
                none,
            ),
            Kind::Flood(f) => {
                ("feFlood", color("flood-color", f.color()) + &number("flood-opacity", f.opacity().get()), none)
            }
            Kind::Composite(c) => {
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
                ("feComposite", input("in", c.input1()) + &input("in2", c.input2()) + &operator, none)
            }
            Kind::Merge(m) => {
                let node = self.tag("feMergeNode");
                let inner = m.inputs().iter().map(|i| format!("<{node}{}/>", input("in", i))).collect();
                ("feMerge", none, inner)
            }
            Kind::Tile(t) => ("feTile", input("in", t.input()), none),
            Kind::Image(i) => ("feImage", self.fe_image(i.root()), none),
            Kind::ComponentTransfer(t) => {
                let inner = transfer(&self.tag("feFuncR"), t.func_r())
                    + &transfer(&self.tag("feFuncG"), t.func_g())
                    + &transfer(&self.tag("feFuncB"), t.func_b())
                    + &transfer(&self.tag("feFuncA"), t.func_a());
                ("feComponentTransfer", input("in", t.input()), inner)
            }
            Kind::ColorMatrix(m) => {
                let kind = match m.kind() {
                    ColorMatrixKind::Matrix(v) => word("type", "matrix") + &list("values", v),
                    // The function takes more than the primitive does.
                    ColorMatrixKind::Saturate(v) if v.get() > 1.0 => {
                        word("type", "matrix") + &list("values", &saturate(v.get()))
                    }
                    ColorMatrixKind::Saturate(v) => word("type", "saturate") + &number("values", v.get()),
                    ColorMatrixKind::HueRotate(v) => word("type", "hueRotate") + &number("values", *v),
                    ColorMatrixKind::LuminanceToAlpha => word("type", "luminanceToAlpha"),
                };
                ("feColorMatrix", input("in", m.input()) + &kind, none)
            }
            Kind::ConvolveMatrix(m) => {
                let data = m.matrix();
                let edge = match m.edge_mode() {
                    EdgeMode::None => "none",
                    EdgeMode::Duplicate => "duplicate",
                    EdgeMode::Wrap => "wrap",
                };
                let attrs = input("in", m.input())
                    + &word("order", &format!("{} {}", data.columns(), data.rows()))
                    + &list("kernelMatrix", data.data())
                    + &number("divisor", m.divisor().get())
                    + &number("bias", m.bias())
                    + &word("targetX", &data.target_x().to_string())
                    + &word("targetY", &data.target_y().to_string())
                    + &word("edgeMode", edge)
                    + &word("preserveAlpha", if m.preserve_alpha() { "true" } else { "false" });
                ("feConvolveMatrix", attrs, none)
            }
            Kind::Morphology(m) => {
                let operator = match m.operator() {
                    MorphologyOperator::Erode => "erode",
                    MorphologyOperator::Dilate => "dilate",
                };
                let attrs = input("in", m.input())
                    + &word("operator", operator)
                    + &pair("radius", m.radius_x().get(), m.radius_y().get());
                ("feMorphology", attrs, none)
            }
            Kind::DisplacementMap(m) => {
                let attrs = input("in", m.input1())
                    + &input("in2", m.input2())
                    + &number("scale", m.scale())
                    + &word("xChannelSelector", channel(m.x_channel_selector()))
                    + &word("yChannelSelector", channel(m.y_channel_selector()));
                ("feDisplacementMap", attrs, none)
            }
            Kind::Turbulence(t) => {
                let kind = match t.kind() {
                    TurbulenceKind::FractalNoise => "fractalNoise",
                    TurbulenceKind::Turbulence => "turbulence",
                };
                let attrs = pair("baseFrequency", t.base_frequency_x().get(), t.base_frequency_y().get())
                    + &word("numOctaves", &t.num_octaves().to_string())
                    + &word("seed", &t.seed().to_string())
                    + &word("stitchTiles", if t.stitch_tiles() { "stitch" } else { "noStitch" })
                    + &word("type", kind);
                ("feTurbulence", attrs, none)
            }
            Kind::DiffuseLighting(l) => {
                let attrs = input("in", l.input())
                    + &number("surfaceScale", l.surface_scale())
                    + &number("diffuseConstant", l.diffuse_constant())
                    + &color("lighting-color", l.lighting_color());
                ("feDiffuseLighting", attrs, self.light(l.light_source()))
            }
            Kind::SpecularLighting(l) => {
                let attrs = input("in", l.input())
                    + &number("surfaceScale", l.surface_scale())
                    + &number("specularConstant", l.specular_constant())
                    + &number("specularExponent", l.specular_exponent())
                    + &color("lighting-color", l.lighting_color());
                ("feSpecularLighting", attrs, self.light(l.light_source()))
            }
        }
    }

    /// The picture of an `feImage`, written once as a definition; the link to it.
    fn fe_image(&mut self, root: &usvg::Group) -> String {
        let scene = &self.job.document.scene();
        let Some(picture) = scene.pictures.get(&(std::ptr::from_ref(root) as usize)) else { return String::new() };
        let id = self.new_id("picture");
        let text = self.group(picture, &format!(" id=\"{id}\""));
        self.define(&text);
        let link = self.link();
        format!(" {link}=\"#{id}\"")
    }
}
