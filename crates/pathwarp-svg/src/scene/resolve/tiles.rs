//! Patterns as geometry: what a tile shows, laid out over a shape, so that it can be warped like anything else.
//!
//! A tile shows nothing outside of its cell. So what is drawn by one path in one colour is drawn by one path for all cells:
//! cells that touch leave no seam, and the file stays small. What has a gradient or a pattern of its own is drawn cell by cell.

use super::{Builder, Context};
use crate::bend::paint;
use crate::bend::stroke;
use crate::scene::geometry;
use crate::scene::model::{Clip, Group, Node, Part, Referrer, Role, Tiles};
use crate::scene::resolve::cut;
use crate::source::text::ElementId;
use pathwarp::Outline;
use pathwarp::kurbo::{Affine, Rect, Vec2};
use pathwarp::map::Map;
use std::sync::Arc;
use usvg::{BlendMode, Paint, PaintOrder};

/// Cells over one shape. More are a texture in which no single tile can be seen.
const MOST_CELLS: f64 = 5_000.0;
/// Segments of all tiles of a drawing: more would make it slow to open.
const MOST_SEGMENTS: usize = 250_000;
/// Arcs that are cut and strokes that are expanded are right to this part of a tile's side.
const FINE: f64 = 1e-6;
/// By this share of its size a shape's box is enlarged, so that no rounding shows at its edge.
const MARGIN: f64 = 0.01;

const TOO_MANY: &str = "a pattern follows the warp as a whole, as its tiles are too many to be bent one by one";
const NOT_BENT: &str =
    "a pattern follows the warp as a whole, as its tiles hold masks, filters or bitmaps and cannot be bent one by one";

/// Which patterns are to become geometry, and how much of it there may be.
pub(crate) struct Tiling<'a> {
    map: &'a dyn Map,
    /// The distance, in root user units, by which an affine map may miss before tiles are bent; `None`: they always are.
    visible: Option<f64>,
    /// Whether patterns on strokes are meant, too.
    strokes: bool,
    /// For every element whether it is selected.
    chosen: Vec<bool>,
    all: bool,
    left: usize,
    notes: Vec<(&'static str, String)>,
}

impl<'a> Tiling<'a> {
    pub(crate) fn new(map: &'a dyn Map, visible: Option<f64>, strokes: bool, chosen: Vec<bool>, all: bool) -> Self {
        Self { map, visible, strokes, chosen, all, left: MOST_SEGMENTS, notes: Vec::new() }
    }

    /// What could not be done.
    pub(super) fn notes(self) -> Vec<(&'static str, String)> {
        self.notes
    }
}

/// Where the cells of a pattern are.
struct Layout<'l> {
    /// Each one's corner, in the pattern's space.
    cells: &'l [Vec2],
    /// From the pattern's space to the shape's user space.
    place: Affine,
    /// A cell from its corner.
    cell: Rect,
    /// What of the shape's user space is needed.
    area: Rect,
    /// From the shape's user space to root user space.
    frame: Affine,
    context: Context,
}

impl Layout<'_> {
    /// An outline in a cell at all cells, as one in the shape's user space. The steps are taken in this order, and corners that
    /// are one stay one to the last bit.
    fn everywhere(&self, outline: &Outline) -> Outline {
        let inside = cut::within(outline, self.cell, FINE * self.cell.width());
        let all =
            self.cells.iter().flat_map(|c| inside.transformed(Affine::translate(*c)).transformed(self.place).subpaths);
        let all = Outline { subpaths: all.collect() };
        cut::within(&all, self.area, FINE * self.area.width().max(self.area.height()))
    }

    fn group(&self, transform: Affine, children: Vec<Node>) -> Group {
        Group::plain(self.context.owner, transform, children)
    }
}

impl Builder<'_> {
    /// The tiles of a path's fill or stroke; `None` where its pattern follows as a whole, or there is none.
    pub(super) fn tiles(
        &mut self,
        p: &usvg::Path,
        stroke: bool,
        frame: Affine,
        context: Context,
        element: Option<ElementId>,
    ) -> Option<Tiles> {
        let (paint, opacity, b) = if stroke {
            let s = p.stroke()?;
            (s.paint(), s.opacity(), p.stroke_bounding_box())
        } else {
            let f = p.fill()?;
            (f.paint(), f.opacity(), p.bounding_box())
        };
        let Paint::Pattern(pattern) = paint else { return None };
        let tiling = self.tiling.as_ref()?;
        let selected = tiling.all
            || context.role == Role::Mask
            || context.owner.or(element).and_then(|e| tiling.chosen.get(e)).is_some_and(|c| *c);
        if !p.is_visible()
            || !selected
            || stroke && !tiling.strokes
            || matches!(context.role, Role::Clip | Role::Pattern)
        {
            return None;
        }
        let area = Rect::new(f64::from(b.left()), f64::from(b.top()), f64::from(b.right()), f64::from(b.bottom()));
        let margin = MARGIN * area.width().max(area.height());
        let area = area.inflate(margin, margin);
        if let Some(visible) = tiling.visible
            && paint::fit(area, frame, Affine::IDENTITY, tiling.map).is_none_or(|f| f.miss <= visible)
        {
            return None;
        }
        match self.tiles_over(pattern, area, frame, Context { owner: context.owner.or(element), ..context }) {
            Ok(content) => Some(Tiles { opacity: opacity.get(), content }),
            Err(why) => {
                if let Some(t) = &mut self.tiling {
                    t.notes.push((why, pattern.id().to_owned()));
                }
                None
            }
        }
    }

    fn tiles_over(
        &mut self,
        pattern: &Arc<usvg::Pattern>,
        area: Rect,
        frame: Affine,
        context: Context,
    ) -> Result<Group, &'static str> {
        let r = pattern.rect();
        let place = geometry::affine(pattern.transform());
        if !crate::bend::part::usable(place) {
            return Err(TOO_MANY);
        }
        let (x, y) = (f64::from(r.x()), f64::from(r.y()));
        let (w, h) = (f64::from(r.width()), f64::from(r.height()));
        let needed = place.inverse().transform_rect_bbox(area);
        let columns = (((needed.x0 - x) / w).floor(), ((needed.x1 - x) / w).ceil());
        let rows = (((needed.y0 - y) / h).floor(), ((needed.y1 - y) / h).ceil());
        // The box of a turned shape holds more than the shape's own; those beyond it go below.
        const SPARE: f64 = 4.0;
        let count = (columns.1 - columns.0) * (rows.1 - rows.0);
        if count.is_nan() || count > SPARE * MOST_CELLS {
            return Err(TOO_MANY);
        }
        let cell = Rect::new(0.0, 0.0, w, h);
        let mut cells = Vec::new();
        for j in 0..(rows.1 - rows.0) as u32 {
            for i in 0..(columns.1 - columns.0) as u32 {
                let corner = Vec2::new(x + (columns.0 + f64::from(i)) * w, y + (rows.0 + f64::from(j)) * h);
                let seen = place.transform_rect_bbox(cell + corner).intersect(area);
                if seen.width() > 0.0 && seen.height() > 0.0 {
                    cells.push(corner);
                }
            }
        }
        let work = weight(pattern.root())?.saturating_mul(cells.len());
        let left = self.tiling.as_ref().map_or(0, |t| t.left);
        if cells.len() as f64 > MOST_CELLS || work > left {
            return Err(TOO_MANY);
        }
        if let Some(t) = &mut self.tiling {
            t.left -= work;
        }
        let layout = Layout { cells: &cells, place, cell, area, frame, context };
        let to_cell = geometry::affine(pattern.root().transform());
        let mut out = self.tile_group(pattern.root(), to_cell, &layout);
        // A tile is a picture of its own, and blends with nothing below it.
        out.isolate |= blends(pattern.root());
        Ok(out)
    }

    /// What a group of a tile shows in all cells; `to_cell` leads from inside it.
    fn tile_group(&mut self, g: &usvg::Group, to_cell: Affine, layout: &Layout<'_>) -> Group {
        let clip = g.clip_path().map(|c| self.tile_clip(c, to_cell, layout));
        let mut children = Vec::new();
        for c in g.children() {
            match c {
                usvg::Node::Group(c) => {
                    let inner = self.tile_group(c, to_cell * geometry::affine(c.transform()), layout);
                    children.push(Node::Group(Box::new(inner)));
                }
                usvg::Node::Text(t) => {
                    let t = t.flattened();
                    let inner = self.tile_group(t, to_cell * geometry::affine(t.transform()), layout);
                    children.push(Node::Group(Box::new(inner)));
                }
                usvg::Node::Path(p) if p.is_visible() => self.tile_path(p, to_cell, layout, &mut children),
                usvg::Node::Path(_) | usvg::Node::Image(_) => {}
            }
        }
        let group = layout.group(Affine::IDENTITY, children);
        Group { opacity: g.opacity().get(), blend: g.blend_mode(), isolate: g.isolate(), clip, ..group }
    }

    fn tile_clip(&mut self, c: &usvg::ClipPath, to_cell: Affine, layout: &Layout<'_>) -> usize {
        let first = self.parts.len();
        let clip = c.clip_path().map(|c| self.tile_clip(c, to_cell, layout));
        let inside = Layout { context: Context { role: Role::Clip, ..layout.context }, ..*layout };
        let inner = to_cell * geometry::affine(c.transform()) * geometry::affine(c.root().transform());
        let root = self.tile_group(c.root(), inner, &inside);
        self.clips.push(Clip {
            id: c.id().to_owned(),
            transform: Affine::IDENTITY,
            clip,
            root,
            referrers: vec![Referrer { element: None, owner: layout.context.owner }],
            parts: first..self.parts.len(),
            foreign: true,
        });
        self.clips.len() - 1
    }

    fn tile_path(&mut self, p: &usvg::Path, to_cell: Affine, layout: &Layout<'_>, out: &mut Vec<Node>) {
        if !crate::bend::part::usable(to_cell) {
            return;
        }
        let outline = self.known_outline(p);
        let fill = |b: &mut Self, out: &mut Vec<Node>| {
            if let Some(f) = p.fill() {
                let plain = matches!(f.paint(), Paint::Color(_)) || layout.context.role == Role::Clip;
                b.tile_piece(p, false, plain, &outline, to_cell, layout, out);
            }
        };
        let stroke_first = p.paint_order() == PaintOrder::StrokeAndFill;
        if !stroke_first {
            fill(self, out);
        }
        if let Some(s) = p.stroke().filter(|_| layout.context.role != Role::Clip) {
            let fine = FINE * layout.cell.width() / crate::bend::part::stretch(to_cell);
            let expanded = stroke::outline(&outline, s, fine);
            self.tile_piece(p, true, matches!(s.paint(), Paint::Color(_)), &expanded, to_cell, layout, out);
        }
        if stroke_first {
            fill(self, out);
        }
    }

    #[allow(clippy::too_many_arguments, reason = "one piece of one path, and where it goes")]
    fn tile_piece(
        &mut self,
        p: &usvg::Path,
        stroke: bool,
        plain: bool,
        outline: &Outline,
        to_cell: Affine,
        layout: &Layout<'_>,
        out: &mut Vec<Node>,
    ) {
        let context = layout.context;
        let part = |local: Outline, frame| Part {
            drawn: None,
            source: None,
            owner: context.owner,
            role: context.role,
            local: local.into(),
            frame,
            fill: p.fill().filter(|_| !stroke).cloned(),
            stroke: p.stroke().filter(|_| stroke).cloned(),
            paint_order: PaintOrder::FillAndStroke,
            rendering: p.rendering_mode(),
            visible: true,
            fixed_width: false,
            slot: context.slot,
            in_tile: true,
            fill_tiles: None,
            stroke_tiles: None,
        };
        let in_cell = outline.transformed(to_cell);
        if plain {
            let all = layout.everywhere(&in_cell);
            if !all.is_empty() {
                self.parts.push(part(all, layout.frame));
                out.push(Node::Part(self.parts.len() - 1));
            }
            return;
        }
        let inside = cut::within(&in_cell, layout.cell, FINE * layout.cell.width()).transformed(to_cell.inverse());
        if inside.is_empty() {
            return;
        }
        for c in layout.cells {
            let place = layout.place * Affine::translate(*c) * to_cell;
            let frame = layout.frame * place;
            // A pattern in a pattern.
            let tiles = self.tiles(p, stroke, frame, context, None);
            let mut part = part(inside.clone(), frame);
            *(if stroke { &mut part.stroke_tiles } else { &mut part.fill_tiles }) = tiles;
            self.parts.push(part);
            out.push(Node::Group(Box::new(layout.group(place, vec![Node::Part(self.parts.len() - 1)]))));
        }
    }
}

/// The segments in a tile, roughly; an error if it holds what cannot be laid out as geometry.
fn weight(g: &usvg::Group) -> Result<usize, &'static str> {
    if g.mask().is_some() || !g.filters().is_empty() {
        return Err(NOT_BENT);
    }
    let mut sum = g.clip_path().map_or(Ok(0), |c| weight(c.root()))?;
    for c in g.children() {
        sum += match c {
            usvg::Node::Group(g) => weight(g)?,
            usvg::Node::Text(t) => weight(t.flattened())?,
            // An expanded stroke has some four times as many.
            usvg::Node::Path(p) => p.data().len() * if p.stroke().is_some() { 4 } else { 1 },
            usvg::Node::Image(_) => return Err(NOT_BENT),
        };
    }
    Ok(sum)
}

/// Whether anything in a group blends with what is below it.
pub(super) fn blends(g: &usvg::Group) -> bool {
    g.children().iter().any(|c| matches!(c, usvg::Node::Group(g) if g.blend_mode() != BlendMode::Normal || blends(g)))
}
