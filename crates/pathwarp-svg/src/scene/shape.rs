//! Shapes and named paths of a drawing, for users of the library.

use super::geometry::GeometryReader;
use super::model::{Part, PartRole, Scene};
use crate::source::ahead::WORTH_THREADS;
use crate::source::parallel::map_parallel;
use crate::source::tags::ElementId;
use crate::source::text::SourceText;
use pathwarp::Outline;
use std::sync::Arc;

/// A shape that is painted, clips or masks.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Shape {
    /// Id in the source, or else name and position such as `path at 12:5`. The parts of a text or `use` share it.
    pub id: String,
    /// Source element, e.g. `circle`.
    pub element: String,
    /// Outline in root user space.
    pub outline: Arc<Outline>,
    /// Line and column of the element in the source, counted from 1.
    pub at: (usize, usize),
    /// `true` if the shape is visible, has a fill or a stroke, and is not part of a clip path or mask.
    pub painted: bool,
    /// `true` if the shape's interior is painted, clips or masks.
    pub filled: bool,
    /// `true` if the even-odd rule determines the interior, `false` for the nonzero rule.
    pub even_odd: bool,
}

/// A path with a name, or one that could have one.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct NamedPath {
    /// Id in the source, or else name and position such as `path at 12:5`.
    pub id: String,
    /// Inkscape's label.
    pub label: Option<String>,
    /// Text of the `<title>`.
    pub title: Option<String>,
    /// Source element, e.g. `circle`.
    pub element: String,
    /// Outline in root user space.
    pub outline: Outline,
    /// Line and column of the element in the source, counted from 1.
    pub at: (usize, usize),
    /// For a path without an id, as listed by [`Document::paths`](crate::Document::paths): the id of the nearest ancestor that
    /// has one, or an empty string.
    pub group: Option<Arc<str>>,
}

/// Reads the outlines of a large drawing on several threads.
pub(super) fn read_outlines(scene: &Scene, source: &SourceText) {
    if source.text.len() >= WORTH_THREADS {
        map_parallel(scene.parts.len(), |i| scene.parts[i].local.segs().next().is_some());
    }
}

/// Lists the shapes of a scene.
pub(super) fn shapes(scene: &Scene, source: &SourceText) -> Vec<Shape> {
    let shape = |p: &Part| {
        let e = p.element();
        Shape {
            id: e.map_or_else(|| "path".to_owned(), |e| source.display_name(e)),
            element: e.map_or_else(|| "path".to_owned(), |e| source.elements[e].tag.to_string()),
            outline: p.outline(),
            at: e.map_or((1, 1), |e| source.line_column(source.elements[e].range.start)),
            painted: p.painted() && p.role == PartRole::Paint,
            filled: p.fill.is_some() || p.role != PartRole::Paint,
            even_odd: p.fill.as_ref().is_some_and(|f| f.rule() == usvg::FillRule::EvenOdd),
        }
    };
    scene.parts.iter().map(shape).collect()
}

/// Describes a shape element, painted or not. Returns `None` if it has no outline.
pub(crate) fn named_path(scene: &Scene, reader: &GeometryReader<'_>, e: ElementId) -> Option<NamedPath> {
    // Prefer the painted outline; an element that is not painted is read from the source.
    let parts = scene.by_source.get(&e).map_or(&[][..], Vec::as_slice);
    let painted = parts.iter().map(|&i| &scene.parts[i]).find(|p| p.role == PartRole::Paint);
    let outline = match painted {
        Some(p) => Arc::unwrap_or_clone(p.outline()),
        None => {
            let t = reader.transform_to_root(e).unwrap_or_default();
            reader.outline(e)?.transformed(t)
        }
    };
    let source = reader.source;
    Some(NamedPath {
        id: source.display_name(e),
        label: source.label(e).map(std::borrow::Cow::into_owned),
        title: source.elements[e].title.clone(),
        element: source.elements[e].tag.to_string(),
        outline,
        at: source.line_column(source.elements[e].range.start),
        group: None,
    })
}
