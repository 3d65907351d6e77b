//! Divides a filter that draws beneath and above its graphic, such as a shadow, into a filter for either layer.

use super::markup::shadow_color;
use crate::scene::areas::overlap;
use crate::scene::geometry::rect;
use crate::source::markup::Tag;
use pathwarp::kurbo::Rect;
use usvg::BlendMode;
use usvg::filter::{
    ColorInterpolation, ColorMatrix, ColorMatrixKind, CompositeOperator, DropShadow, Filter, Input, Kind, Primitive,
};

/// A layer of a filter's drawing.
pub(super) struct Layer {
    /// The need for each primitive.
    needs: Vec<Need>,
    /// Further primitives, the last of which draws the layer.
    pub(super) drawing: String,
    /// `true` if nothing shines through the graphic where it paints.
    is_opaque: bool,
}

/// The need of a layer for a primitive, in increasing order.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Need {
    #[default]
    Nothing,
    /// The input alone, since the graphic hides the area that the primitive would cut out.
    Uncut,
    /// The result outside the graphic, which hides it elsewhere.
    Visible,
    /// The result everywhere.
    Result,
}

impl Layer {
    /// The need for a primitive.
    pub(super) fn need(&self, primitive: usize) -> Need {
        self.needs[primitive]
    }

    /// The matrix that keeps the edges of an opaque graphic smooth in place of one that makes its alpha full, as in Figma's shadows.
    pub(super) fn with_smooth_edges(&self, m: &ColorMatrix) -> Option<ColorMatrixKind> {
        let (ColorMatrixKind::Matrix(v), Input::SourceAlpha) = (m.kind(), m.input()) else { return None };
        let makes_full = matches!(v[15..], [0.0, 0.0, 0.0, factor, 0.0] if factor > 1.0);
        (self.is_opaque && makes_full).then(|| ColorMatrixKind::Matrix([&v[..18], &[1.0, 0.0]].concat()))
    }
}

/// An image in the stack that a filter draws.
enum Stacked<'a> {
    Nothing,
    /// The graphic.
    Source,
    /// The result of a primitive.
    Result(usize),
    Shadow(&'a DropShadow, ColorInterpolation),
}

/// The layers that a filter draws beneath and above its graphic, as far as there are any. Returns `None` if it changes or cuts the graphic.
/// `content` is the graphic's box.
pub(super) fn layers_around(f: &Filter, content: Rect, is_opaque: bool) -> Option<[Option<Layer>; 2]> {
    /// Limit on primitives, as the time grows with their number squared.
    const MAX_PRIMITIVES: usize = 1000;
    let all = f.primitives();
    if all.len() > MAX_PRIMITIVES {
        return None;
    }
    let region = rect(f.rect().to_rect());
    // Regions are held in single precision.
    let slack = 1e-4 * region.width().max(region.height());
    if overlap(content, region.inflate(slack, slack)) != Some(content) {
        return None;
    }
    let mut stack = Vec::new();
    push(f, all.len().checked_sub(1)?, &mut stack)?;
    let mut sources = stack.iter().enumerate().filter(|(_, s)| matches!(s, Stacked::Source));
    let (Some((source, _)), None) = (sources.next(), sources.next()) else { return None };
    let layers = [layer(f, &stack[..source], is_opaque, is_opaque), layer(f, &stack[source + 1..], false, is_opaque)];
    // Results are composited in sRGB.
    let is_linear = all.iter().any(|p| p.color_interpolation() == ColorInterpolation::LinearRGB);
    (!is_linear || (is_opaque && layers[1].is_none())).then_some(layers)
}

/// Adds the stack of primitive `i`, from the bottom to the top. Returns `None` if it is not a stack on the graphic.
fn push<'a>(f: &'a Filter, i: usize, out: &mut Vec<Stacked<'a>>) -> Option<()> {
    /// Most layers; references can ask for any number.
    const MAX_LAYERS: usize = 64;
    let p = &f.primitives()[i];
    // Makes the limit count each call.
    out.push(Stacked::Nothing);
    let layer = |input: &'a Input| match input {
        Input::SourceGraphic => {
            out.push(Stacked::Source);
            Some(())
        }
        // A silhouette covers the graphic.
        Input::SourceAlpha => None,
        Input::Reference(name) => push(f, last_named(f, name, i)?, out),
    };
    match p.kind() {
        Kind::Merge(_) | Kind::Blend(_) | Kind::Composite(_) if is_stack(p) => {
            (p.rect() == f.rect()).then_some(())?;
            inputs(p.kind()).into_iter().rev().try_for_each(layer)?;
        }
        Kind::DropShadow(s) if *s.input() == Input::SourceGraphic && p.rect() == f.rect() => {
            out.extend([Stacked::Shadow(s, p.color_interpolation()), Stacked::Source]);
        }
        // An empty background.
        Kind::Flood(flood) if flood.opacity().get() == 0.0 => {}
        _ => {
            (last_named(f, p.result(), f.primitives().len()) == Some(i)).then_some(())?;
            out.push(Stacked::Result(i));
        }
    }
    (out.len() <= MAX_LAYERS).then_some(())
}

/// Returns `true` if a primitive lays its inputs upon one another.
fn is_stack(p: &Primitive) -> bool {
    matches!(p.kind(), Kind::Merge(_))
        || matches!(p.kind(), Kind::Blend(b) if b.mode() == BlendMode::Normal)
        || matches!(p.kind(), Kind::Composite(c) if c.operator() == CompositeOperator::Over)
}

/// The last primitive with this name among the first `before` ones.
fn last_named(f: &Filter, name: &str, before: usize) -> Option<usize> {
    f.primitives()[..before].iter().rposition(|p| p.result() == name)
}

/// The inputs of a primitive, from the top to the bottom.
fn inputs(kind: &Kind) -> Vec<&Input> {
    match kind {
        Kind::Merge(m) => m.inputs().iter().rev().collect(),
        Kind::Blend(b) => vec![b.input1(), b.input2()],
        Kind::Composite(c) => vec![c.input1(), c.input2()],
        Kind::DisplacementMap(m) => vec![m.input1(), m.input2()],
        Kind::ColorMatrix(m) => vec![m.input()],
        Kind::ComponentTransfer(t) => vec![t.input()],
        Kind::ConvolveMatrix(m) => vec![m.input()],
        Kind::DiffuseLighting(l) => vec![l.input()],
        Kind::DropShadow(s) => vec![s.input()],
        Kind::GaussianBlur(b) => vec![b.input()],
        Kind::Morphology(m) => vec![m.input()],
        Kind::Offset(o) => vec![o.input()],
        Kind::SpecularLighting(l) => vec![l.input()],
        Kind::Tile(t) => vec![t.input()],
        Kind::Flood(_) | Kind::Image(_) | Kind::Turbulence(_) => Vec::new(),
    }
}

/// The layer of a part of a stack; `is_hidden` if the graphic covers it. Returns `None` if it draws nothing.
fn layer(f: &Filter, stack: &[Stacked<'_>], is_hidden: bool, is_opaque: bool) -> Option<Layer> {
    let mut needs = vec![Need::Nothing; f.primitives().len()];
    let (mut drawing, mut nodes) = (String::new(), String::new());
    let begin = |tag: &str| Tag::new(tag).with("color-interpolation-filters", "sRGB");
    for (number, image) in stack.iter().enumerate() {
        let result = match image {
            Stacked::Nothing | Stacked::Source => continue,
            Stacked::Result(i) => {
                needs[*i] = if is_hidden { Need::Visible } else { Need::Result };
                f.primitives()[*i].result().to_owned()
            }
            Stacked::Shadow(s, space) => {
                let [offset, flood, result] = ["o", "f", "s"].map(|part| format!("pathwarp-{number}{part}"));
                let blur = begin("feGaussianBlur").input("in", s.input());
                drawing += &blur.numbers("stdDeviation", &[s.std_dev_x().get(), s.std_dev_y().get()]).empty();
                let shift = begin("feOffset").numbers("dx", &[s.dx()]).numbers("dy", &[s.dy()]);
                drawing += &shift.with("result", &offset).empty();
                let color = begin("feFlood").with("flood-color", &shadow_color(s, *space));
                drawing += &color.numbers("flood-opacity", &[s.opacity().get()]).with("result", &flood).empty();
                let shadow = begin("feComposite").with("in", &flood).with("in2", &offset).with("operator", "in");
                drawing += &shadow.with("result", &result).empty();
                result
            }
        };
        nodes += &Tag::new("feMergeNode").with("in", &result).empty();
    }
    // Inputs come before the primitives that need them.
    for i in (0..needs.len()).rev() {
        let kind = f.primitives()[i].kind();
        let current = needs[i];
        let (mut all, mut need) = (inputs(kind), Need::Result);
        if current == Need::Visible {
            if cuts_out_graphic(f, i) {
                all.truncate(1);
                needs[i] = Need::Uncut;
            }
            if is_local(kind) {
                need = Need::Visible;
            }
        }
        for input in all.into_iter().filter(|_| current != Need::Nothing) {
            if let Input::Reference(name) = input
                && let Some(source) = last_named(f, name, i)
            {
                needs[source] = needs[source].max(need);
            }
        }
    }
    drawing += &begin("feMerge").around(&nodes);
    (!nodes.is_empty()).then_some(Layer { needs, drawing, is_opaque })
}

/// Returns `true` if a pixel of the result depends on the same pixel of the inputs only.
pub(super) fn is_local(kind: &Kind) -> bool {
    use Kind::{Blend, ColorMatrix, ComponentTransfer, Composite, Merge};
    matches!(kind, Blend(_) | ColorMatrix(_) | ComponentTransfer(_) | Composite(_) | Merge(_))
}

/// Returns `true` if a primitive cuts the area of the graphic out of its first input.
fn cuts_out_graphic(f: &Filter, i: usize) -> bool {
    let Kind::Composite(c) = f.primitives()[i].kind() else { return false };
    let is_graphic = match c.input2() {
        Input::SourceGraphic | Input::SourceAlpha => true,
        Input::Reference(name) => last_named(f, name, i).is_some_and(|i| {
            let p = &f.primitives()[i];
            // The last value of the fourth row is the alpha of transparent pixels.
            matches!(p.kind(), Kind::ColorMatrix(m) if !matches!(m.input(), Input::Reference(_))
                && matches!(m.kind(), ColorMatrixKind::Matrix(v) if v.get(19).is_some_and(|a| *a <= 0.0)))
        }),
    };
    c.operator() == CompositeOperator::Out && is_graphic
}
