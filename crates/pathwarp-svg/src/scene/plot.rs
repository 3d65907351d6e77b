//! Lists the outlines of a drawing for a plotter or cutter, each once, with its layer and colour.
//!
//! A plotter knows neither areas nor transparency, so an outline is drawn once, be it filled, stroked or both. Strokes are
//! drawn along their centre lines.

use super::areas::{is_seen, overlap, room_in_clip};
use super::geometry::stretch;
use super::model::{Group, Node, Scene};
use crate::source::elements::{ElementId, Namespace, is_shape};
use crate::source::text::SourceText;
use pathwarp::kurbo::{Line, Rect};
use pathwarp::{Outline, Seg};
use std::collections::HashSet;
use std::sync::Arc;
use usvg::{Fill, Paint, Stroke};

/// The outlines of a drawing.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Plot {
    /// The outlines, in painting order.
    pub shapes: Vec<PlotShape>,
    /// The content of the drawing that outlines cannot show.
    pub lost: PlotLoss,
}

/// An outline with its layer and colour.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PlotShape {
    /// Its index in [`Document::shapes`](crate::Document::shapes).
    pub shape: usize,
    /// The name of the layer; `None` outside all layers. Layers are Inkscape's, or in a drawing without any, the named groups of the
    /// outermost level that has several members.
    pub layer: Option<Arc<str>>,
    /// The colour of the stroke, else of the fill; of a gradient, the mean of its stops. `None` for a pattern.
    pub color: Option<[u8; 3]>,
    /// Outline in root user space. All subpaths of a fill, and other subpaths whose ends meet, are closed.
    pub outline: Arc<Outline>,
    /// The rule of the fill, if there is one: `true` for even-odd, `false` for nonzero.
    pub even_odd: Option<bool>,
    /// Width of the stroke in px, if there is one.
    pub stroke_width: Option<f64>,
}

/// Numbers of objects that outlines cannot show.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct PlotLoss {
    /// Bitmaps, which are left out.
    pub bitmaps: usize,
    /// Groups partly hidden by a clip path or mask. They are drawn whole.
    pub hidden: usize,
    /// Filters, which are left out.
    pub filters: usize,
    /// Shapes painted with a pattern, which is left out.
    pub patterns: usize,
}

/// Lists the outlines of a drawing.
pub(crate) fn plot(scene: &Scene, source: &SourceText) -> Plot {
    let mut walk = Walk { scene, source, layers: Layers::find(source), out: Plot::default() };
    walk.add_group(&scene.root, None);
    walk.out
}

/// State of the walk over the scene.
struct Walk<'a> {
    scene: &'a Scene,
    source: &'a SourceText,
    layers: Layers,
    out: Plot,
}

impl Walk<'_> {
    /// Adds the content of a group. `room` is the area that clip paths leave visible.
    fn add_group(&mut self, g: &Group, room: Option<Rect>) {
        if g.opacity <= 0.0 {
            return;
        }
        self.out.lost.filters += usize::from(!g.filters.is_empty());
        let Some(room) = room_in_clip(self.scene, g, room) else { return };
        let (shapes, bitmaps) = (self.out.shapes.len(), self.out.lost.bitmaps);
        for child in &g.children {
            match child {
                Node::Group(g) => self.add_group(g, room),
                Node::Text { content, .. } => self.add_group(content, room),
                Node::Part(i) => self.add_part(*i, room),
                Node::Image(_) => self.out.lost.bitmaps += 1,
            }
        }
        let drawn = &self.out.shapes[shapes..];
        let holds_all = |area: Rect| {
            let all = drawn.iter().filter_map(|s| s.outline.bounding_box()).reduce(|a, b| a.union(b));
            self.out.lost.bitmaps == bitmaps && all.is_none_or(|b| overlap(area, b) == Some(b))
        };
        let is_cut = g.clip.is_some_and(|i| !self.clip_area(i).is_some_and(holds_all));
        if (is_cut || g.mask.is_some()) && !drawn.is_empty() {
            self.out.lost.hidden += 1;
        }
    }

    /// The area of a clip path that is a rectangle; `None` for other shapes.
    fn clip_area(&self, clip: usize) -> Option<Rect> {
        let clip = &self.scene.clips[clip];
        let mut parts = clip.parts.clone().map(|i| self.scene.parts[i].outline());
        let (Some(only), None, None) = (parts.next(), parts.next(), clip.clip) else { return None };
        rectangle(&only)
    }

    /// Adds a part, unless it is invisible or outside of `room`.
    fn add_part(&mut self, i: usize, room: Option<Rect>) {
        let p = &self.scene.parts[i];
        let outline = p.outline();
        let bounds = outline.bounding_box().filter(Rect::is_finite);
        let in_room = bounds.is_some_and(|b| room.is_none_or(|room| overlap(room, b).is_some()));
        if !is_seen(p) || !in_room {
            return;
        }
        let stroke = p.stroke.as_ref().filter(|s| s.opacity().get() > 0.0);
        let fill = p.fill.as_ref().filter(|f| f.opacity().get() > 0.0);
        let paint = stroke.map(Stroke::paint).or(fill.map(Fill::paint));
        let is_pattern = |paint: Option<&Paint>| matches!(paint, Some(Paint::Pattern(_)));
        if is_pattern(paint) || is_pattern(fill.map(Fill::paint)) {
            self.out.lost.patterns += 1;
        }
        let scale = if p.fixed_width { 1.0 } else { stretch(self.scene.to_px * p.frame) };
        self.out.shapes.push(PlotShape {
            shape: i,
            layer: p.element().and_then(|e| self.layers.layer(self.source, e)),
            color: paint.and_then(color),
            outline: closed(outline, fill.is_some()),
            even_odd: fill.map(|f| f.rule() == usvg::FillRule::EvenOdd),
            stroke_width: stroke.map(|s| f64::from(s.width().get()) * scale),
        });
    }
}

/// Closes the subpaths whose ends meet, and of a fill also those that enclose an area.
fn closed(outline: Arc<Outline>, filled: bool) -> Arc<Outline> {
    /// Largest gap from rounding, as a fraction of the size.
    const SLACK: f64 = 1e-9;
    if outline.subpaths.iter().all(|s| s.closed) {
        return outline;
    }
    let mut out = Arc::unwrap_or_clone(outline);
    for s in out.subpaths.iter_mut().filter(|s| !s.closed) {
        let (start, end) = (s.start, s.end());
        let ends_meet = start.distance(end) <= SLACK * s.diagonal();
        let has_area = !matches!(s.segs.as_slice(), [] | [Seg::Line(_)]);
        if has_area && filled && !ends_meet {
            s.segs.push(Seg::Line(Line::new(end, start)));
        }
        s.closed = has_area && (filled || ends_meet);
    }
    Arc::new(out)
}

/// The colour of a paint; of a gradient, the mean of its stops.
fn color(paint: &Paint) -> Option<[u8; 3]> {
    let stops = match paint {
        Paint::Color(c) => return Some([c.red, c.green, c.blue]),
        Paint::LinearGradient(g) => g.stops(),
        Paint::RadialGradient(g) => g.stops(),
        Paint::Pattern(_) => return None,
    };
    let colors = stops.iter().map(usvg::Stop::color).map(|c| [c.red, c.green, c.blue].map(usize::from));
    let sum = colors.fold([0; 3], |[r, g, b], c| [r + c[0], g + c[1], b + c[2]]);
    Some(sum.map(|v| (v / stops.len().max(1)) as u8))
}

/// The bounding box of an outline that is a rectangle along the axes.
fn rectangle(o: &Outline) -> Option<Rect> {
    /// Largest difference from rounding, as a fraction of the area.
    const SLACK: f64 = 1e-6;
    let bounds = o.bounding_box()?;
    let [only] = o.subpaths.as_slice() else { return None };
    // The shoelace formula: of all outlines with this bounding box, only the rectangle has its area.
    let mut area = 0.0;
    for seg in &only.segs {
        let Seg::Line(l) = seg else { return None };
        area += l.p0.to_vec2().cross(l.p1.to_vec2()) / 2.0;
    }
    // Clipping closes open outlines.
    area += only.end().to_vec2().cross(only.start.to_vec2()) / 2.0;
    ((area.abs() - bounds.area()).abs() <= SLACK * bounds.area()).then_some(bounds)
}

/// The layers of a drawing.
struct Layers {
    elements: HashSet<ElementId>,
    /// The layer of all other elements.
    rest: Option<Arc<str>>,
}

impl Layers {
    fn find(source: &SourceText) -> Self {
        let mode = |e: &ElementId| source.attr_in(*e, Namespace::Inkscape, "groupmode");
        let all = 0..source.elements.len();
        let elements: HashSet<ElementId> = all.filter(|e| mode(e).is_some_and(|mode| mode == "layer")).collect();
        // The layer of a cutting line does not count, so that named groups are layers beside it.
        if elements.iter().all(|e| source.attr(*e, "data-contour").is_some()) {
            Self::from_groups(source)
        } else {
            Self { elements, rest: None }
        }
    }

    /// The named groups of the outermost level that has several members.
    fn from_groups(source: &SourceText) -> Self {
        let mut members: Vec<Vec<ElementId>> = vec![Vec::new(); source.elements.len()];
        for (e, element) in source.elements.iter().enumerate() {
            if let Some(parent) = element.parent.filter(|_| is_drawn(&element.tag)) {
                members[parent].push(e);
            }
        }
        let (mut level, mut rest) = (0, None);
        while let [only] = members.get(level).map_or(&[][..], Vec::as_slice)
            && is_group(&source.elements[*only].tag)
        {
            rest = name(source, *only).or(rest);
            level = *only;
        }
        let groups = members.into_iter().nth(level).unwrap_or_default();
        let is_layer = |e: &ElementId| is_group(&source.elements[*e].tag) && name(source, *e).is_some();
        Self { elements: groups.into_iter().filter(is_layer).collect(), rest }
    }

    /// The name of an element's layer.
    fn layer(&self, source: &SourceText, e: ElementId) -> Option<Arc<str>> {
        let layer = source.ancestors(e).find(|a| self.elements.contains(a));
        layer.and_then(|a| name(source, a)).or_else(|| self.rest.clone())
    }
}

/// The label of a group, or else its id.
fn name(source: &SourceText, e: ElementId) -> Option<Arc<str>> {
    let found = source.label(e).or_else(|| source.attr(e, "id")).filter(|n| !n.trim().is_empty());
    found.map(|n| n.as_ref().into())
}

fn is_group(tag: &str) -> bool {
    matches!(tag, "g" | "a" | "svg" | "switch")
}

/// Returns `true` if elements with this tag are drawn where they stand.
fn is_drawn(tag: &str) -> bool {
    is_group(tag) || is_shape(tag) || matches!(tag, "use" | "text" | "image")
}
