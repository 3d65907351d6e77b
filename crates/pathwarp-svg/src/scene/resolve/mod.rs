//! Resolves a drawing: walks usvg's tree and finds the source element, the exact outline and the exact transform of
//! everything in it.

mod builder;
mod cut;
mod markers;
mod slots;
mod tiles;
mod tiling;
mod trace;
mod walk;

pub(crate) use tiling::{Painted, Tiling};

use super::affine::{affine, f32_bits, is_near, linear_part};
use super::geometry::GeometryReader;
use super::letters::Owners;
use super::model::{PartRole, Scene};
use crate::source::text::SourceText;
use builder::{Context, SceneBuilder};
use pathwarp::kurbo::{Affine, Size};
use std::collections::HashMap;

/// Resolves the drawing. Patterns become geometry as far as `tiling` asks for it. Clip paths and masks
/// are there once for each of the bends in `division` that those who refer to them have.
pub(crate) fn build(
    tree: &usvg::Tree,
    source: &SourceText,
    letters: &Owners,
    dpi: f64,
    tiling: Option<Tiling<'_>>,
    division: &[Option<usize>],
) -> Scene {
    let page = Size::new(f64::from(tree.size().width()), f64::from(tree.size().height()));
    let reader = GeometryReader { source, dpi, page };
    let mut b = SceneBuilder::new(reader, letters, tiling, division);
    let (top, to_px) = root_group(&b, tree, page);
    b.top = Some(std::ptr::from_ref(top));
    let root = walk::group(&mut b, top, Affine::IDENTITY, Context::top(PartRole::Paint));
    let SceneBuilder { mut scene, tiling, .. } = b;
    scene.root = root;
    scene.to_px = to_px;
    scene.notes = tiling.map(|t| t.notes).unwrap_or_default();
    let mut by_source: HashMap<_, Vec<_>> = HashMap::new();
    for (i, p) in scene.parts.iter().enumerate() {
        if let Some(e) = p.source {
            by_source.entry(e).or_default().push(i);
        }
    }
    scene.by_source = by_source;
    scene
}

/// Finds the group that holds root user space, and the transform from there to px.
fn root_group<'t>(b: &SceneBuilder<'_>, tree: &'t usvg::Tree, page: Size) -> (&'t usvg::Group, Affine) {
    let by_source = b.reader.view_box_transform(0, page);
    let [usvg::Node::Group(g)] = tree.root().children() else { return (tree.root(), by_source) };
    // usvg wraps everything in a group exactly if the root has a transform or a background.
    let has_transform = b.reader.source.attr(0, "transform").is_some();
    let moved = f32_bits(by_source) != f32_bits(Affine::IDENTITY) || has_transform;
    let background = b.may_have_background
        && g.id().is_empty()
        && g.transform().is_identity()
        && matches!(g.children().first(), Some(usvg::Node::Path(p)) if p.id().is_empty());
    if !moved && !background {
        return (tree.root(), by_source);
    }
    let t = affine(g.transform());
    let (u, v) = (by_source.as_coeffs(), t.as_coeffs());
    // usvg centres the drawing in f32, where numbers of the page's size cancel, and moves it there, however far.
    let slack = 1e-6 * (page.width + page.height + 1.0) + 3e-7 * u[4].abs().max(u[5].abs());
    let agree =
        is_near(linear_part(by_source), linear_part(t)) && (u[4] - v[4]).abs() <= slack && (u[5] - v[5]).abs() <= slack;
    // If the page equals its viewBox up to rounding, there is no such group.
    let [.., x, y] = u;
    let rounding = is_near(linear_part(by_source), Affine::IDENTITY) && x.abs().max(y.abs()) <= slack && !has_transform;
    if rounding && !agree && !background {
        return (tree.root(), by_source);
    }
    (g, if agree { by_source } else { t })
}
