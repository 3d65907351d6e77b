//! The area that a filter paints, given what it is applied to.

use super::seen::overlap;
use pathwarp::kurbo::{Rect, Vec2};
use std::collections::HashMap;
use usvg::filter::{
    ColorMatrixKind, CompositeOperator, Filter, Input, Kind, MorphologyOperator, Primitive, TransferFunction,
};

/// Extent of a Gaussian in standard deviations; a renderer's three box blurs end there as well (Filter Effects Module Level 1, §9.14).
const BLUR_REACH: f64 = 3.0;

/// Bounds what `filter` paints from `content` with `region` in place of its own, all in the filter's user space. `None`: nothing.
pub(crate) fn painted(filter: &Filter, region: Rect, content: Rect) -> Option<Rect> {
    let mut results: HashMap<&str, Option<Rect>> = HashMap::new();
    let mut last = overlap(content, region);
    for p in filter.primitives() {
        let region = part(filter, p, region);
        let of = |input: &Input| match input {
            Input::SourceGraphic | Input::SourceAlpha => Some(content),
            Input::Reference(name) => results.get(name.as_str()).copied().unwrap_or(Some(region)),
        };
        last = primitive(p.kind(), &of, region).and_then(|b| overlap(b, region));
        results.insert(p.result(), last);
    }
    last
}

fn primitive(kind: &Kind, of: &dyn Fn(&Input) -> Option<Rect>, region: Rect) -> Option<Rect> {
    let either = |a: Option<Rect>, b: Option<Rect>| a.into_iter().chain(b).reduce(|a, b| a.union(b));
    let grown = |b: Rect, x: f32, y: f32| b.inflate(f64::from(x), f64::from(y));
    let blurred = |b: Rect, x: f32, y: f32| b.inflate(BLUR_REACH * f64::from(x), BLUR_REACH * f64::from(y));
    match kind {
        Kind::GaussianBlur(b) => of(b.input()).map(|i| blurred(i, b.std_dev_x().get(), b.std_dev_y().get())),
        Kind::DropShadow(s) => of(s.input()).map(|i| {
            let shadow = blurred(i, s.std_dev_x().get(), s.std_dev_y().get());
            i.union(shadow + Vec2::new(s.dx().into(), s.dy().into()))
        }),
        Kind::Offset(o) => of(o.input()).map(|i| i + Vec2::new(o.dx().into(), o.dy().into())),
        Kind::Blend(b) => either(of(b.input1()), of(b.input2())),
        Kind::Composite(c) => match c.operator() {
            CompositeOperator::In => of(c.input1()).and_then(|a| overlap(a, of(c.input2())?)),
            CompositeOperator::Out => of(c.input1()),
            CompositeOperator::Atop => of(c.input2()),
            CompositeOperator::Arithmetic { k4, .. } if k4 > 0.0 => Some(region),
            CompositeOperator::Over
            | CompositeOperator::Xor
            | CompositeOperator::Lighter
            | CompositeOperator::Arithmetic { .. } => either(of(c.input1()), of(c.input2())),
        },
        Kind::Merge(m) => m.inputs().iter().filter_map(of).reduce(|a, b| a.union(b)),
        Kind::Morphology(m) => of(m.input()).map(|i| match m.operator() {
            MorphologyOperator::Erode => i,
            MorphologyOperator::Dilate => grown(i, m.radius_x().get(), m.radius_y().get()),
        }),
        Kind::DisplacementMap(m) => of(m.input1()).map(|i| grown(i, m.scale().abs() / 2.0, m.scale().abs() / 2.0)),
        // The last value of a matrix's fourth row is the alpha of transparent pixels.
        Kind::ColorMatrix(m) => match m.kind() {
            ColorMatrixKind::Matrix(v) if v.get(19).is_some_and(|alpha| *alpha > 0.0) => Some(region),
            ColorMatrixKind::LuminanceToAlpha
            | ColorMatrixKind::Matrix(_)
            | ColorMatrixKind::Saturate(_)
            | ColorMatrixKind::HueRotate(_) => of(m.input()),
        },
        Kind::ComponentTransfer(t) if keeps_transparent(t.func_a()) => of(t.input()),
        Kind::ComponentTransfer(_)
        | Kind::ConvolveMatrix(_)
        | Kind::DiffuseLighting(_)
        | Kind::SpecularLighting(_)
        | Kind::Flood(_)
        | Kind::Image(_)
        | Kind::Tile(_)
        | Kind::Turbulence(_) => Some(region),
    }
}

/// Returns `true` if transparent pixels stay so.
fn keeps_transparent(alpha: &TransferFunction) -> bool {
    match alpha {
        TransferFunction::Identity => true,
        TransferFunction::Table(v) | TransferFunction::Discrete(v) => v.first().is_none_or(|a| *a <= 0.0),
        TransferFunction::Linear { intercept, .. } => *intercept <= 0.0,
        TransferFunction::Gamma { offset, .. } => *offset <= 0.0,
    }
}

/// The region of a primitive, which is the filter's unless it has one itself, if the filter's is `region`.
pub(crate) fn part(filter: &Filter, p: &Primitive, region: Rect) -> Rect {
    if p.rect() == filter.rect() { region } else { rect(p.rect()) }
}

pub(crate) fn rect(r: usvg::NonZeroRect) -> Rect {
    Rect::new(r.left().into(), r.top().into(), r.right().into(), r.bottom().into())
}
