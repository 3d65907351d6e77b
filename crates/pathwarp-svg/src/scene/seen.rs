//! The part of a drawing that is seen: not what clip paths, masks and zero opacity hide, nor what lies off the page.

use super::affine::stretch;
use super::model::{Bitmap, Group, Node, Part, PartRole, Scene};
use pathwarp::kurbo::{Affine, Point, Rect};

/// What counts: flags of parts and of bitmaps.
pub(crate) struct Counted {
    pub(crate) parts: Vec<bool>,
    pub(crate) bitmaps: Vec<bool>,
    /// Strokes count by half their width.
    pub(crate) strokes: bool,
}

/// Bounding box of what is seen of what counts. `page` is the visible area, if there is one.
pub(crate) fn seen_box(scene: &Scene, page: Option<Rect>, counted: &Counted) -> Option<Rect> {
    in_group(scene, &scene.root, page, counted, &|_| true)
}

/// The same, with what of it lies off the page.
pub(crate) fn uncut_box(scene: &Scene, page: Rect, counted: &Counted) -> Option<Rect> {
    in_group(scene, &scene.root, None, counted, &|b| overlap(b, page).is_some())
}

/// The place of a bitmap in root user space. `None` if it is hidden, or stands for one that was not read.
pub(crate) fn picture_box(b: &Bitmap) -> Option<Rect> {
    let [p, q, r, s] = picture_corners(b)?;
    Some(Rect::from_points(p, q).union(Rect::from_points(r, s)))
}

/// The corners of a bitmap in root user space, likewise.
pub(crate) fn picture_corners(b: &Bitmap) -> Option<[Point; 4]> {
    let size = b.image.size();
    let all = Rect::new(0.0, 0.0, f64::from(size.width()), f64::from(size.height()));
    let r = b.crop.map_or(all, |c| c.intersect(all));
    let corners = [(r.x0, r.y0), (r.x1, r.y0), (r.x1, r.y1), (r.x0, r.y1)].map(|p| b.frame * Point::from(p));
    (b.image.is_visible() && !b.is_unread()).then_some(corners).filter(|c| c.iter().all(|p| p.is_finite()))
}

/// Bounding box of what `room` leaves of what counts, as far as the box of each is `kept`.
fn in_group(
    scene: &Scene,
    g: &Group,
    room: Option<Rect>,
    counted: &Counted,
    kept: &dyn Fn(Rect) -> bool,
) -> Option<Rect> {
    let room = room_in(scene, g, room)?;
    let left = |all: Rect| room.map_or(Some(all), |room| overlap(all, room)).filter(|b| kept(*b));
    let one = |n: &Node| match n {
        Node::Group(g) => in_group(scene, g, room, counted, kept),
        Node::Text { content, .. } => in_group(scene, content, room, counted, kept),
        Node::Part(i) => {
            let p = &scene.parts[*i];
            let seen = is_seen(p) && p.role == PartRole::Paint && counted.parts[*i];
            let by = if counted.strokes { reach(p, scene.to_px) } else { 0.0 };
            left(p.outline().bounding_box().filter(|b| seen && b.is_finite())?.inflate(by, by))
        }
        Node::Image(i) => left(picture_box(&scene.bitmaps[*i]).filter(|_| counted.bitmaps[*i])?),
    };
    g.children.iter().filter_map(one).reduce(|a, b| a.union(b))
}

/// How far a part's stroke extends from its path, in root user space: half its width.
pub(crate) fn reach(p: &Part, to_px: Affine) -> f64 {
    let space = if p.fixed_width { to_px.inverse() } else { p.frame };
    p.stroke.as_ref().filter(|_| !p.in_tile).map_or(0.0, |s| 0.5 * f64::from(s.width().get()) * stretch(space))
}

/// Returns `true` if a part is visible and has a paint that is not transparent.
pub(crate) fn is_seen(p: &Part) -> bool {
    let fill = p.fill.as_ref().is_some_and(|f| f.opacity().get() > 0.0);
    let stroke = p.stroke.as_ref().is_some_and(|s| s.opacity().get() > 0.0);
    p.visible && (fill || stroke)
}

/// The room that a group leaves its content: `Some(None)` if it is unbounded, `None` if the group hides everything.
fn room_in(scene: &Scene, g: &Group, room: Option<Rect>) -> Option<Option<Rect>> {
    if g.opacity <= 0.0 {
        return None;
    }
    let mut room = room;
    let clip = match g.clip {
        Some(i) => Some(clip_box(scene, i, &|i| scene.parts[i].outline().bounding_box())?),
        None => None,
    };
    let mask = g.mask.map(|i| mask_box(scene, i));
    for bound in clip.into_iter().chain(mask) {
        room = Some(room.map_or(Some(bound), |room| overlap(room, bound))?);
    }
    Some(room)
}

/// Bounding box of a clip path, given the boxes of parts; `None` if it hides everything.
pub(crate) fn clip_box(scene: &Scene, i: usize, part_box: &dyn Fn(usize) -> Option<Rect>) -> Option<Rect> {
    fn content(g: &Group, part_box: &dyn Fn(usize) -> Option<Rect>) -> Option<Rect> {
        let own = g.children.iter().filter_map(|n| match n {
            Node::Group(g) => content(g, part_box),
            Node::Text { content: text, .. } => content(text, part_box),
            Node::Part(i) => part_box(*i),
            Node::Image(_) => None,
        });
        own.reduce(|a, b| a.union(b))
    }
    let clip = &scene.clips[i];
    let own = content(&clip.root, part_box)?;
    match clip.clip {
        Some(next) => overlap(own, clip_box(scene, next, part_box)?),
        None => Some(own),
    }
}

/// Bounding box of a mask in root user space, whatever its brightness.
fn mask_box(scene: &Scene, i: usize) -> Rect {
    let m = &scene.masks[i];
    m.frame.transform_rect_bbox(overlap(m.rect, m.content).unwrap_or_default())
}

/// The common part of two areas, which may be lines or points.
pub(crate) fn overlap(a: Rect, b: Rect) -> Option<Rect> {
    let (x0, x1) = (a.x0.max(b.x0), a.x1.min(b.x1));
    let (y0, y1) = (a.y0.max(b.y0), a.y1.min(b.y1));
    (x0 <= x1 && y0 <= y1).then(|| Rect::new(x0, y0, x1, y1))
}
