//! Lays out patterns as geometry: repeats the content of a tile over a shape, so that it can be warped.
//!
//! A tile shows nothing outside its cell. A path in a plain colour, clipped to the cell, becomes one path over all cells: adjacent cells
//! leave no seam, and the file stays small. Paths with a gradient or a pattern are repeated cell by cell.

use super::builder::{Context, Painted, SceneBuilder, known_outline};
use crate::scene::areas::stroke_outline;
use crate::scene::geometry::{affine, is_invertible, rect, stretch};
use crate::scene::model::{Clip, Group, LazyOutline, Node, Part, PartRole, SceneNote, Tiles};
use pathwarp::Outline;
use pathwarp::kurbo::common::{solve_cubic, solve_quadratic};
use pathwarp::kurbo::{Affine, Line, Point, Rect, Vec2};
use pathwarp::outline::{Seg, Subpath};
use std::borrow::Cow;
use std::sync::Arc;
use usvg::{BlendMode, Paint, PaintOrder};

/// Limit on the cells over one shape. More cells make a texture in which single tiles cannot be told apart.
const MAX_CELLS: f64 = 5_000.0;
/// Tolerance for clipped arcs and expanded strokes, as a fraction of a tile's side.
const TOLERANCE: f64 = 1e-6;
/// Margin around a shape's box as a fraction of its size, so that rounding does not show at its edge.
const MARGIN: f64 = 0.01;

/// Notes for the user on patterns that cannot be laid out.
const TOO_MANY: &str = "a pattern follows the warp as a whole, as it has too many tiles to bend one by one";
const NOT_BENT: &str =
    "a pattern follows the warp as a whole, as tiles with masks, filters or bitmaps cannot be bent one by one";

/// One of the two paints of a path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PaintKind {
    Fill,
    Stroke,
}

/// The cells of a pattern over a shape.
struct Layout<'l> {
    /// Corner of each cell in the pattern's space.
    cells: &'l [Vec2],
    /// Leads from the pattern's space to the shape's user space.
    to_shape: Affine,
    /// A cell relative to its corner.
    cell: Rect,
    /// Area to cover, in the shape's user space.
    area: Rect,
    /// Leads from the shape's user space to root user space.
    frame: Affine,
    context: Context,
}

impl Layout<'_> {
    /// Repeats an outline over all cells, as one outline in the shape's user space. It is clipped to the cell before, so that points that
    /// coincide in one cell do so in every cell, to the last bit.
    fn repeat(&self, outline: &Outline) -> Outline {
        let inside = clip_to_box(outline, self.cell, TOLERANCE * self.cell.width());
        let copy = |corner: &Vec2| inside.transformed(Affine::translate(*corner)).transformed(self.to_shape);
        let all = Outline { subpaths: self.cells.iter().flat_map(|corner| copy(corner).subpaths).collect() };
        clip_to_box(&all, self.area, TOLERANCE * self.area.width().max(self.area.height()))
    }

    /// A group of the shape's tiles that only transforms its content.
    fn group(&self, transform: Affine, children: Vec<Node>) -> Group {
        Group::plain(self.context.owner, transform, children)
    }
}

/// Lays out the pattern of a path's fill or stroke. Returns `None` if there is no pattern, or it is transformed as a whole.
pub(super) fn lay_out_tiles(
    b: &mut SceneBuilder<'_>,
    p: &usvg::Path,
    kind: PaintKind,
    frame: Affine,
    context: Context,
) -> Option<Tiles> {
    let (paint, opacity, bounds) = match kind {
        PaintKind::Stroke => p.stroke().map(|s| (s.paint(), s.opacity(), p.stroke_bounding_box()))?,
        PaintKind::Fill => p.fill().map(|f| (f.paint(), f.opacity(), p.bounding_box()))?,
    };
    let Paint::Pattern(pattern) = paint else { return None };
    let tiling = b.tiling.as_ref()?;
    if !p.is_visible()
        || (kind == PaintKind::Stroke && !tiling.strokes)
        || matches!(context.role, PartRole::Clip | PartRole::Pattern)
    {
        return None;
    }
    let area = rect(bounds);
    let margin = MARGIN * area.width().max(area.height());
    let area = area.inflate(margin, margin);
    let is_mask = context.role == PartRole::Mask;
    let painted = if is_mask { Painted::Mask(context.bend) } else { Painted::Element(context.owner) };
    if !(tiling.is_needed)(painted, area, frame) {
        return None;
    }
    match pattern_over(b, pattern, area, frame, context) {
        Ok(content) => Some(Tiles { opacity: opacity.get(), content }),
        Err(text) => {
            if let Some(t) = &mut b.tiling {
                t.notes.push(SceneNote { text, name: pattern.id().to_owned() });
            }
            None
        }
    }
}

/// Lays out a pattern over an area. Returns the note for the user if it cannot be laid out.
fn pattern_over(
    b: &mut SceneBuilder<'_>,
    pattern: &Arc<usvg::Pattern>,
    area: Rect,
    frame: Affine,
    context: Context,
) -> Result<Group, &'static str> {
    let to_shape = affine(pattern.transform());
    if !is_invertible(to_shape) {
        return Err(TOO_MANY);
    }
    let tile = pattern.rect();
    let cells = cells(tile, to_shape, area)?;
    let work = count_segments(pattern.root())?.saturating_mul(cells.len());
    let budget = b.tiling.as_ref().map_or(0, |t| t.budget);
    if cells.len() as f64 > MAX_CELLS || work > budget {
        return Err(TOO_MANY);
    }
    if let Some(t) = &mut b.tiling {
        t.budget -= work;
    }
    let cell = Rect::new(0.0, 0.0, f64::from(tile.width()), f64::from(tile.height()));
    let layout = Layout { cells: &cells, to_shape, cell, area, frame, context };
    let to_cell = affine(pattern.root().transform());
    let mut out = tile_group(b, pattern.root(), to_cell, &layout);
    // A tile is an isolated image, which does not blend with the backdrop.
    out.isolate |= blends(pattern.root());
    Ok(out)
}

/// Corners of the cells that touch `area`. The cell at the pattern's origin is `tile`.
fn cells(tile: usvg::NonZeroRect, to_shape: Affine, area: Rect) -> Result<Vec<Vec2>, &'static str> {
    /// Factor on the limit for cells in the box of a rotated shape, of which the shape touches fewer. The exact number is checked later.
    const SPARE: f64 = 4.0;
    let (x, y) = (f64::from(tile.x()), f64::from(tile.y()));
    let (w, h) = (f64::from(tile.width()), f64::from(tile.height()));
    let needed = to_shape.inverse().transform_rect_bbox(area);
    // The first column and row, and the ones after the last.
    let columns = (((needed.x0 - x) / w).floor(), ((needed.x1 - x) / w).ceil());
    let rows = (((needed.y0 - y) / h).floor(), ((needed.y1 - y) / h).ceil());
    let count = (columns.1 - columns.0) * (rows.1 - rows.0);
    if count.is_nan() || count > SPARE * MAX_CELLS {
        return Err(TOO_MANY);
    }
    let cell = Rect::new(0.0, 0.0, w, h);
    let mut cells = Vec::new();
    for j in 0..(rows.1 - rows.0) as u32 {
        for i in 0..(columns.1 - columns.0) as u32 {
            let corner = Vec2::new(x + (columns.0 + f64::from(i)) * w, y + (rows.0 + f64::from(j)) * h);
            let common = to_shape.transform_rect_bbox(cell + corner).intersect(area);
            if common.width() > 0.0 && common.height() > 0.0 {
                cells.push(corner);
            }
        }
    }
    Ok(cells)
}

/// Lays out a group of a tile over all cells. `to_cell` leads from inside the group to the cell.
fn tile_group(b: &mut SceneBuilder<'_>, g: &usvg::Group, to_cell: Affine, layout: &Layout<'_>) -> Group {
    let clip = g.clip_path().map(|c| tile_clip(b, c, to_cell, layout));
    let mut children = Vec::new();
    for c in g.children() {
        let inner = match c {
            usvg::Node::Group(c) => c,
            usvg::Node::Text(t) => t.flattened(),
            usvg::Node::Path(p) => {
                tile_path(b, p, to_cell, layout, &mut children);
                continue;
            }
            usvg::Node::Image(_) => continue,
        };
        let inner = tile_group(b, inner, to_cell * affine(inner.transform()), layout);
        children.push(Node::Group(Box::new(inner)));
    }
    let group = layout.group(Affine::IDENTITY, children);
    Group { opacity: g.opacity().get(), blend: g.blend_mode(), isolate: g.isolate(), clip, ..group }
}

/// Lays out a clip path in a tile. Returns its index.
fn tile_clip(b: &mut SceneBuilder<'_>, c: &usvg::ClipPath, to_cell: Affine, layout: &Layout<'_>) -> usize {
    let first = b.scene.parts.len();
    let clip = c.clip_path().map(|c| tile_clip(b, c, to_cell, layout));
    let inside = Layout { context: Context { role: PartRole::Clip, ..layout.context }, ..*layout };
    let inner = to_cell * affine(c.transform()) * affine(c.root().transform());
    let root = tile_group(b, c.root(), inner, &inside);
    let parts = first..b.scene.parts.len();
    b.push_clip(Clip { clip, ..Clip::foreign(c.id(), root, layout.context.owner, parts) })
}

/// Lays out a path in a tile and adds its nodes to `out`.
fn tile_path(b: &mut SceneBuilder<'_>, p: &usvg::Path, to_cell: Affine, layout: &Layout<'_>, out: &mut Vec<Node>) {
    if !p.is_visible() || !is_invertible(to_cell) {
        return;
    }
    let outline = known_outline(b, p);
    let is_clip = layout.context.role == PartRole::Clip;
    let order = match p.paint_order() {
        PaintOrder::FillAndStroke => [PaintKind::Fill, PaintKind::Stroke],
        PaintOrder::StrokeAndFill => [PaintKind::Stroke, PaintKind::Fill],
    };
    for kind in order {
        let (paint, painted) = match (kind, p.fill(), p.stroke().filter(|_| !is_clip)) {
            (PaintKind::Fill, Some(f), _) => (f.paint(), Cow::Borrowed(&outline)),
            (PaintKind::Stroke, _, Some(s)) => {
                let tolerance = TOLERANCE * layout.cell.width() / stretch(to_cell);
                (s.paint(), Cow::Owned(stroke_outline(&outline, s, tolerance)))
            }
            _ => continue,
        };
        let is_plain = is_clip || matches!(paint, Paint::Color(_));
        TilePaint { path: p, kind, is_plain }.add_parts(b, &painted, to_cell, layout, out);
    }
}

/// The fill or the stroke of a path in a tile.
struct TilePaint<'p> {
    path: &'p usvg::Path,
    kind: PaintKind,
    /// `true` for a single colour, so that one path serves all cells.
    is_plain: bool,
}

impl TilePaint<'_> {
    /// Adds the parts that paint `outline` in all cells.
    fn add_parts(
        &self,
        b: &mut SceneBuilder<'_>,
        outline: &Outline,
        to_cell: Affine,
        layout: &Layout<'_>,
        out: &mut Vec<Node>,
    ) {
        let in_cell = outline.transformed(to_cell);
        if self.is_plain {
            let all = layout.repeat(&in_cell);
            if !all.is_empty() {
                b.scene.parts.push(self.part(all.into(), layout.frame, layout.context));
                out.push(Node::Part(b.scene.parts.len() - 1));
            }
            return;
        }
        let inside = clip_to_box(&in_cell, layout.cell, TOLERANCE * layout.cell.width()).transformed(to_cell.inverse());
        if inside.is_empty() {
            return;
        }
        for c in layout.cells {
            let transform = layout.to_shape * Affine::translate(*c) * to_cell;
            let frame = layout.frame * transform;
            // The paint may be a pattern in turn.
            let tiles = lay_out_tiles(b, self.path, self.kind, frame, layout.context);
            let mut part = self.part(inside.clone().into(), frame, layout.context);
            match self.kind {
                PaintKind::Stroke => part.stroke_tiles = tiles,
                PaintKind::Fill => part.fill_tiles = tiles,
            }
            b.scene.parts.push(part);
            out.push(Node::Group(Box::new(layout.group(transform, vec![Node::Part(b.scene.parts.len() - 1)]))));
        }
    }

    /// A part with this paint alone.
    fn part(&self, local: LazyOutline, frame: Affine, context: Context) -> Part {
        Part {
            fill: self.path.fill().filter(|_| self.kind == PaintKind::Fill).cloned(),
            stroke: self.path.stroke().filter(|_| self.kind == PaintKind::Stroke).cloned(),
            rendering: self.path.rendering_mode(),
            slot: context.slot,
            in_tile: true,
            ..Part::plain(context.role, context.owner, local, frame)
        }
    }
}

/// Estimates the number of segments in a tile. Returns the note for the user if the tile cannot be laid out as geometry.
fn count_segments(g: &usvg::Group) -> Result<usize, &'static str> {
    if g.mask().is_some() || !g.filters().is_empty() {
        return Err(NOT_BENT);
    }
    let mut sum = g.clip_path().map_or(Ok(0), |c| count_segments(c.root()))?;
    for c in g.children() {
        sum += match c {
            usvg::Node::Group(g) => count_segments(g)?,
            usvg::Node::Text(t) => count_segments(t.flattened())?,
            // An expanded stroke has about four times as many segments.
            usvg::Node::Path(p) => p.data().len() * if p.stroke().is_some() { 4 } else { 1 },
            usvg::Node::Image(_) => return Err(NOT_BENT),
        };
    }
    Ok(sum)
}

/// Returns `true` if anything in a group blends with its backdrop.
pub(super) fn blends(g: &usvg::Group) -> bool {
    g.children().iter().any(|c| matches!(c, usvg::Node::Group(g) if g.blend_mode() != BlendMode::Normal || blends(g)))
}

/// Clips a filled outline to a box. Arcs across its border become cubics within `tolerance`.
fn clip_to_box(outline: &Outline, area: Rect, tolerance: f64) -> Outline {
    if outline.bounding_box().is_none_or(|b| area.union(b) == area) {
        return outline.clone();
    }
    let borders = [
        Border { axis: 0, position: area.x0, inwards: 1.0 },
        Border { axis: 0, position: area.x1, inwards: -1.0 },
        Border { axis: 1, position: area.y0, inwards: 1.0 },
        Border { axis: 1, position: area.y1, inwards: -1.0 },
    ];
    let loops = outline.subpaths.iter().map(|s| {
        let mut segs = s.segs.clone();
        close(&mut segs, s.start);
        borders.iter().fold(segs, |segs, b| b.cut(segs, tolerance))
    });
    let subpath = |segs: Vec<Seg>| Some(Subpath { start: segs.first()?.start(), segs, closed: true });
    Outline { subpaths: loops.filter_map(subpath).collect() }
}

/// Closes a run of segments from `start` with a line.
fn close(segs: &mut Vec<Seg>, start: Point) {
    if let Some(end) = segs.last().map(Seg::end).filter(|e| *e != start) {
        segs.push(Seg::Line(Line::new(end, start)));
    }
}

/// A line parallel to an axis, with the side to keep.
#[derive(Debug, Clone, Copy)]
struct Border {
    /// The coordinate that the border fixes: 0 for x, 1 for y.
    axis: usize,
    position: f64,
    /// 1 to keep larger coordinates, −1 to keep smaller ones.
    inwards: f64,
}

impl Border {
    /// Signed distance of a point from the border, positive inside.
    fn distance(self, p: Point) -> f64 {
        ([p.x, p.y][self.axis] - self.position) * self.inwards
    }

    /// The projection of a point onto the border.
    fn project(self, p: Point) -> Point {
        if self.axis == 0 { Point::new(self.position, p.y) } else { Point::new(p.x, self.position) }
    }

    /// Clips a closed run of segments to the inside.
    fn cut(self, segs: Vec<Seg>, tolerance: f64) -> Vec<Seg> {
        let mut kept: Vec<Seg> = Vec::with_capacity(segs.len());
        for s in segs {
            let b = s.bounding_box();
            let [p, q] = [(b.x0, b.y0), (b.x1, b.y1)].map(|corner| self.distance(corner.into()));
            match s {
                s if p.min(q) >= 0.0 => kept.push(s),
                _ if p.max(q) <= 0.0 => {}
                Seg::Arc(arc) => arc.to_cubics(tolerance).for_each(|c| self.split(Seg::Cubic(c), &mut kept)),
                s => self.split(s, &mut kept),
            }
        }
        // Lines along the border replace the parts outside.
        let mut out: Vec<Seg> = Vec::with_capacity(kept.len() + 2);
        for s in kept {
            if let Some(end) = out.last().map(Seg::end).filter(|e| *e != s.start()) {
                out.push(Seg::Line(Line::new(end, s.start())));
            }
            out.push(s);
        }
        if let Some(start) = out.first().map(Seg::start) {
            close(&mut out, start);
        }
        out
    }

    /// Parameters at which a segment, extended past its ends, crosses the border.
    fn crossings(self, s: &Seg) -> Vec<f64> {
        /// Fraction of the other coefficients below which the cubic one counts as zero, since rounding errors in it would spoil the roots.
        const NEGLIGIBLE: f64 = 1e-11;
        let c = s.to_cubic();
        let [a, b, c, d] = [c.p0, c.p1, c.p2, c.p3].map(|p| self.distance(p));
        // Coefficients of the distance as a polynomial in the parameter, beside the constant a.
        let [linear, square, cubic] = [3.0 * (b - a), 3.0 * (a - 2.0 * b + c), d - a + 3.0 * (b - c)];
        match s {
            // Exact for lines.
            Seg::Line(_) => vec![a / (a - d)],
            _ if cubic.abs() <= NEGLIGIBLE * (a.abs() + linear.abs() + square.abs()) => {
                solve_quadratic(a, linear, square).into_iter().collect()
            }
            _ => solve_cubic(a, linear, square, cubic).into_iter().collect(),
        }
    }

    /// Splits a segment at the border and adds the parts inside to `kept`.
    fn split(self, s: Seg, kept: &mut Vec<Seg>) {
        /// Distance from an end parameter within which crossings are ignored.
        const END: f64 = 1e-12;
        let mut ends = self.crossings(&s);
        ends.retain(|t| *t > END && *t < 1.0 - END);
        ends.sort_by(f64::total_cmp);
        ends.push(1.0);
        let mut from = 0.0;
        for to in ends {
            if self.distance(s.eval(0.5 * (from + to))) >= 0.0
                && let Some(mut piece) = s.part(from, to)
            {
                let [start, end] = ends_mut(&mut piece);
                if from > 0.0 {
                    *start = self.project(*start);
                }
                if to < 1.0 {
                    *end = self.project(*end);
                }
                kept.push(piece);
            }
            from = to;
        }
    }
}

/// The start and the end of a segment.
fn ends_mut(s: &mut Seg) -> [&mut Point; 2] {
    match s {
        Seg::Line(l) => [&mut l.p0, &mut l.p1],
        Seg::Quad(q) => [&mut q.p0, &mut q.p2],
        Seg::Cubic(c) => [&mut c.p0, &mut c.p3],
        Seg::Arc(a) => [&mut a.p0, &mut a.p1],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::kurbo::Shape as _;

    /// Winding numbers are unchanged inside and zero outside.
    #[test]
    fn the_inside_keeps_its_windings() {
        let area = Rect::new(2.0, 1.0, 9.0, 8.0);
        for d in [
            "M5,4 m-6,0 a6,6 0 1 1 12,0 a6,6 0 1 1 -12,0 Z",
            "M0,0 L10,0 L10,10 L0,10 Z M3,3 L3,20 L20,20 L20,3 Z M4,4 L5,4 L5,5 Z",
            "M-3,5 C20,-30 -12,40 14,4 Q4,20 5,-5 L-9,2",
            "M2,1 L9,1 L9,8 L2,8 Z M0,1 L12,1 L12,8 L0,8 Z",
            "M20,20 L30,20 L30,30 Z",
        ] {
            let outline = Outline::from_svg(d).unwrap();
            let cut = clip_to_box(&outline, area, 1e-9).to_bez_path(1e-9);
            let mut whole = outline.to_bez_path(1e-9);
            if !d.ends_with('Z') {
                whole.close_path();
            }
            let mut seen = 0;
            for k in 0..60 * 60 {
                let p = Point::new(f64::from(k % 60) * 0.2031 - 1.0, f64::from(k / 60) * 0.1973 - 1.0);
                let wanted = if area.contains(p) { whole.winding(p) } else { 0 };
                assert_eq!(cut.winding(p), wanted, "{d} at {p:?}");
                seen += usize::from(wanted != 0);
            }
            assert!(seen > 50 || d.starts_with("M20"), "{d}");
            let b = cut.bounding_box();
            assert!(
                cut.elements().is_empty()
                    || area.union(b) == area
                    || area.inflate(1e-9, 1e-9).union(b) == area.inflate(1e-9, 1e-9)
            );
        }
    }

    /// Outlines inside the box are unchanged, arcs included.
    #[test]
    fn nothing_to_cut() {
        let o = Outline::from_svg("M4,4 a2,2 0 1 1 4,0 Z").unwrap();
        assert_eq!(clip_to_box(&o, Rect::new(0.0, 0.0, 10.0, 10.0), 1e-9), o);
    }
}
