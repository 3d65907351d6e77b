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
    pub(super) more: String,
    /// `true` if nothing shines through the graphic where it paints.
    opaque: bool,
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
    pub(super) fn need(&self, at: usize) -> Need {
        self.needs[at]
    }

    /// The matrix that keeps the edges of an opaque graphic smooth in place of one that makes its alpha full, as in Figma's shadows.
    pub(super) fn smooth(&self, m: &ColorMatrix) -> Option<ColorMatrixKind> {
        let (ColorMatrixKind::Matrix(v), Input::SourceAlpha) = (m.kind(), m.input()) else { return None };
        let is_full = matches!(v[15..], [0.0, 0.0, 0.0, factor, 0.0] if factor > 1.0);
        (self.opaque && is_full).then(|| ColorMatrixKind::Matrix([&v[..18], &[1.0, 0.0]].concat()))
    }
}

enum Stacked<'a> {
    Nothing,
    Source,
    Result(usize),
    Shadow(&'a DropShadow, ColorInterpolation),
}

/// The layers that a filter draws beneath and above its graphic, as far as there are any. Returns `None` if it changes or cuts the graphic.
pub(super) fn layers_around(f: &Filter, content: Rect, opaque: bool) -> Option<[Option<Layer>; 2]> {
    /// Limit on primitives, as the time grows with their number squared.
    const MOST: usize = 1000;
    let all = f.primitives();
    if all.len() > MOST {
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
    let (Some((at, _)), None) = (sources.next(), sources.next()) else { return None };
    let layers = [layer(f, &stack[..at], opaque, opaque), layer(f, &stack[at + 1..], false, opaque)];
    // Results are composited in sRGB.
    let linear = all.iter().any(|p| p.color_interpolation() == ColorInterpolation::LinearRGB);
    (!linear || (opaque && layers[1].is_none())).then_some(layers)
}

/// Adds the stack of a primitive, from the bottom to the top. Returns `None` if it is not a stack on the graphic.
fn push<'a>(f: &'a Filter, at: usize, out: &mut Vec<Stacked<'a>>) -> Option<()> {
    /// Most layers; references can ask for any number.
    const MAX_LAYERS: usize = 64;
    let p = &f.primitives()[at];
    // Makes the limit count each call.
    out.push(Stacked::Nothing);
    let layer = |input: &'a Input| match input {
        Input::SourceGraphic => {
            out.push(Stacked::Source);
            Some(())
        }
        // A silhouette covers the graphic.
        Input::SourceAlpha => None,
        Input::Reference(name) => push(f, last_named(f, name, at)?, out),
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
            (last_named(f, p.result(), f.primitives().len()) == Some(at)).then_some(())?;
            out.push(Stacked::Result(at));
        }
    }
    (out.len() <= MAX_LAYERS).then_some(())
}

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

/// The layer of a part of a stack; `hidden` if the graphic covers it. Returns `None` if it draws nothing.
fn layer(f: &Filter, stack: &[Stacked<'_>], hidden: bool, opaque: bool) -> Option<Layer> {
    let mut needs = vec![Need::Nothing; f.primitives().len()];
    let (mut more, mut nodes) = (String::new(), String::new());
    let begin = |tag: &str| Tag::new(tag).with("color-interpolation-filters", "sRGB");
    for (k, layer) in stack.iter().enumerate() {
        let result = match layer {
            Stacked::Nothing | Stacked::Source => continue,
            Stacked::Result(at) => {
                needs[*at] = if hidden { Need::Visible } else { Need::Result };
                f.primitives()[*at].result().to_owned()
            }
            Stacked::Shadow(s, space) => {
                let [offset, flood, result] = ["o", "f", "s"].map(|part| format!("pathwarp-{k}{part}"));
                let blur = begin("feGaussianBlur").input("in", s.input());
                more += &blur.numbers("stdDeviation", &[s.std_dev_x().get(), s.std_dev_y().get()]).empty();
                let by = begin("feOffset").numbers("dx", &[s.dx()]).numbers("dy", &[s.dy()]);
                more += &by.with("result", &offset).empty();
                let color = begin("feFlood").with("flood-color", &shadow_color(s, *space));
                more += &color.numbers("flood-opacity", &[s.opacity().get()]).with("result", &flood).empty();
                let cut = begin("feComposite").with("in", &flood).with("in2", &offset).with("operator", "in");
                more += &cut.with("result", &result).empty();
                result
            }
        };
        nodes += &Tag::new("feMergeNode").with("in", &result).empty();
    }
    for at in (0..needs.len()).rev() {
        let kind = f.primitives()[at].kind();
        let current = needs[at];
        let (mut all, mut need) = (inputs(kind), Need::Result);
        if current == Need::Visible {
            if cuts_out(f, at) {
                all.truncate(1);
                needs[at] = Need::Uncut;
            }
            if is_local(kind) {
                need = Need::Visible;
            }
        }
        for input in all.into_iter().filter(|_| current != Need::Nothing) {
            if let Input::Reference(name) = input
                && let Some(i) = last_named(f, name, at)
            {
                needs[i] = needs[i].max(need);
            }
        }
    }
    (!nodes.is_empty()).then(|| Layer { needs, more: more + &begin("feMerge").around(&nodes), opaque })
}

/// Returns `true` if a pixel of the result depends on the same pixel of the inputs only.
pub(super) fn is_local(kind: &Kind) -> bool {
    use Kind::{Blend, ColorMatrix, ComponentTransfer, Composite, Merge};
    matches!(kind, Blend(_) | ColorMatrix(_) | ComponentTransfer(_) | Composite(_) | Merge(_))
}

fn cuts_out(f: &Filter, at: usize) -> bool {
    let Kind::Composite(c) = f.primitives()[at].kind() else { return false };
    let is_graphic = match c.input2() {
        Input::SourceGraphic | Input::SourceAlpha => true,
        Input::Reference(name) => last_named(f, name, at).is_some_and(|i| {
            let p = &f.primitives()[i];
            // The last value of the fourth row is the alpha of transparent pixels.
            matches!(p.kind(), Kind::ColorMatrix(m) if !matches!(m.input(), Input::Reference(_))
                && matches!(m.kind(), ColorMatrixKind::Matrix(v) if v.get(19).is_some_and(|a| *a <= 0.0)))
        }),
    };
    c.operator() == CompositeOperator::Out && is_graphic
}
