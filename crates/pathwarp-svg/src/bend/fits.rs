//! The best affine fit of a map, for paints, filtered groups, and bitmaps and patterns that are not bent point by point.

use super::bends::{Bend, Bends};
use super::options::{Patterns, Strokes, WarpOptions};
use super::path::decimals;
use super::pictures::{BentImage, ImageRequest, Images, is_jpeg};
use crate::scene::drawing::Drawing;
use crate::scene::geometry::{is_invertible, stretch};
use crate::scene::model::{Bitmap, PartRole, Scene, Slot};
use crate::scene::resolve::{Painted, Tiling};
use crate::source::number::path_data;
use pathwarp::kurbo::{Affine, Point, Rect, Vec2};
use pathwarp::map::Map;
use pathwarp::{Error, Outline, refit};
use usvg::ImageRendering;

/// An affine approximation of a map over a box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PaintFit {
    /// Leads from the shape's user space in the source to its user space in the result.
    pub(crate) affine: Affine,
    /// Largest distance between fit and map over the samples, relative to the size of the box's image.
    pub(crate) residual: f64,
    /// Largest distance between fit and map over the samples, in units of the user space in the result.
    pub(crate) miss: f64,
}

/// Finds the least-squares affine fit of `map` over a grid on `area`. `read` leads from the user space of `area` to root user space, and
/// `write` from the user space of the result. Returns `None` where the map is not finite.
pub(crate) fn fit(area: Rect, read: Affine, write: Affine, map: &dyn Map) -> Option<PaintFit> {
    let back = write.inverse();
    let points: Vec<Point> = grid(area).map(|p| read * p).collect();
    let mut images = points.clone();
    map.points(&points, &mut images);
    let pairs: Vec<(Point, Point)> =
        grid(area).zip(images).map(|(p, q)| (p, back * q)).filter(|(_, q)| q.is_finite()).collect();
    let n = pairs.len() as f64;
    if pairs.len() < 3 {
        return None;
    }
    let mean = |f: fn(&(Point, Point)) -> Point| {
        (pairs.iter().map(|p| f(p).to_vec2()).fold(Vec2::ZERO, |a, b| a + b) / n).to_point()
    };
    let (p0, q0) = (mean(|p| p.0), mean(|p| p.1));
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    let (mut ux, mut uy) = (Vec2::ZERO, Vec2::ZERO);
    for (p, q) in &pairs {
        let (d, w) = (*p - p0, *q - q0);
        xx += d.x * d.x;
        xy += d.x * d.y;
        yy += d.y * d.y;
        ux += w * d.x;
        uy += w * d.y;
    }
    let det = xx * yy - xy * xy;
    // A box without area, such as a straight line's: use the map's derivative.
    let (cx, cy) = if det > 1e-12 * (xx + yy).powi(2) {
        ((ux * yy - uy * xy) / det, (uy * xx - ux * xy) / det)
    } else {
        let centre = read * area.center();
        let jet = map.jet(centre);
        if !jet.is_finite() {
            return None;
        }
        let local = back * Affine::new([jet.dx.x, jet.dx.y, jet.dy.x, jet.dy.y, 0.0, 0.0]) * read;
        let [a, b, c, d, ..] = local.as_coeffs();
        (Vec2::new(a, b), Vec2::new(c, d))
    };
    let shift = q0.to_vec2() - cx * p0.x - cy * p0.y;
    let affine = Affine::new([cx.x, cx.y, cy.x, cy.y, shift.x, shift.y]);
    let miss = pairs.iter().map(|(p, q)| (affine * *p).distance(*q)).fold(0.0, f64::max);
    let size = (cx * area.width()).hypot() + (cy * area.height()).hypot();
    affine.is_finite().then_some(PaintFit { affine, residual: if size > 0.0 { miss / size } else { 0.0 }, miss })
}

/// Finds the fit of a shape that `copies` move in root user space: the paint of one is stretched over the box of all. If no affine map
/// comes near the image of that box, as around a ring, the paint is stretched over the box of the image, `result`.
pub(crate) fn fit_copies(
    area: Rect,
    read: Affine,
    write: Affine,
    map: &dyn Map,
    copies: &[Affine],
    result: Rect,
) -> Option<PaintFit> {
    /// Largest relative residual of a useful fit.
    const MAX_RESIDUAL: f64 = 0.25;
    let back = read.inverse();
    let Some(whole) = copies.iter().map(|m| (back * *m * read).transform_rect_bbox(area)).reduce(|a, b| a.union(b))
    else {
        return fit(area, read, write, map);
    };
    // Without width or height, keep the size.
    let scale = |one: f64, all: f64| if one > 0.0 && all > 0.0 { all / one } else { 1.0 };
    let onto = |all: Rect| {
        Affine::translate(all.origin().to_vec2())
            * Affine::scale_non_uniform(scale(area.width(), all.width()), scale(area.height(), all.height()))
            * Affine::translate(-area.origin().to_vec2())
    };
    Some(match fit(whole, read, write, map).filter(|f| f.residual <= MAX_RESIDUAL) {
        Some(fit) => PaintFit { affine: fit.affine * onto(whole), ..fit },
        None => PaintFit { affine: onto(result), residual: 1.0, miss: f64::INFINITY },
    })
}

impl PaintFit {
    /// Returns `true` if the fit moves no corner of `area` by more than 1e-9 of its diagonal.
    pub(crate) fn is_identity(&self, area: Rect) -> bool {
        let size = area.width().hypot(area.height());
        let corners = [(area.x0, area.y0), (area.x1, area.y0), (area.x1, area.y1), (area.x0, area.y1)];
        corners.into_iter().map(Point::from).all(|p| (self.affine * p).distance(p) <= 1e-9 * size)
    }
}

/// A square lattice of points over a box.
fn grid(r: Rect) -> impl Iterator<Item = Point> {
    const N: u32 = 8;
    let at = |i: u32| f64::from(i) / f64::from(N);
    (0..=N).flat_map(move |i| (0..=N).map(move |j| Point::new(r.x0 + r.width() * at(i), r.y0 + r.height() * at(j))))
}

/// A slot, which moves as a whole, under a map.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlacedSlot {
    /// The affine fit, in the slot's coordinates.
    pub(crate) fit: Affine,
    /// Leads from the slot's coordinates to root user space in the result.
    write: Affine,
}

/// The frame in the result of a part, bitmap or slot that moves along with its slot.
pub(crate) fn frame_in_result(scene: &Scene, placed: &[PlacedSlot], slot: Option<usize>, frame: Affine) -> Affine {
    match slot.and_then(|s| Some((placed.get(s)?, scene.slots.get(s)?))) {
        Some((p, s)) if p.write != s.frame => p.write * s.frame.inverse() * frame,
        _ => frame,
    }
}

/// Places filtered groups and images by the affine fit of their map. A group whose parts have different bends does not move.
/// `part_bends` has the index of each part's bend.
pub(super) fn place_slots(drawing: &Drawing, bends: &Bends<'_>, part_bends: &[Option<usize>]) -> Vec<PlacedSlot> {
    let scene = drawing.scene();
    let mut out: Vec<PlacedSlot> = Vec::with_capacity(scene.slots.len());
    for s in &scene.slots {
        let outer = frame_in_result(scene, &out, s.outer, s.frame);
        let fit = slot_bend(s, scene, bends, part_bends)
            .filter(|_| is_invertible(s.frame) && is_invertible(outer))
            .and_then(|k| fit(s.area, s.frame, outer, bends.each[k].map))
            .filter(|f| is_invertible(f.affine) && !f.is_identity(s.area));
        let fit = fit.map_or(Affine::IDENTITY, |f| f.affine);
        out.push(PlacedSlot { fit, write: outer * fit });
    }
    out
}

/// The slots of a drawing that is not bent.
pub(crate) fn unmoved(scene: &Scene) -> Vec<PlacedSlot> {
    scene.slots.iter().map(|s| PlacedSlot { fit: Affine::IDENTITY, write: s.frame }).collect()
}

/// The largest distance over `area` of a map's derivative from the identity, the derivative of a translation. `read` leads from the user
/// space of `area` to root user space, and `write` from the user space of the result.
pub(crate) fn distance_from_translation(area: Rect, read: Affine, write: Affine, map: &dyn Map) -> f64 {
    let linear = |a: Affine, v: Vec2| (a * v.to_point()).to_vec2() - a.translation();
    let back = write.inverse();
    // The Frobenius norm of the difference; infinite where the map is not defined.
    let distance = |p: Point| {
        let jet = map.jet(read * p);
        let change = |v: Vec2| (linear(back, jet.push(linear(read, v))) - v).hypot2();
        let distance = (change(Vec2::new(1.0, 0.0)) + change(Vec2::new(0.0, 1.0))).sqrt();
        if distance.is_finite() { distance } else { f64::INFINITY }
    };
    grid(area).map(distance).fold(0.0, f64::max)
}

/// Index of the bend of all parts in a slot; `None` if they have several.
pub(crate) fn slot_bend(s: &Slot, scene: &Scene, bends: &Bends<'_>, part_bends: &[Option<usize>]) -> Option<usize> {
    // Parts of tiles and of filters' pictures are never bent and do not count.
    let mut parts = s.parts.clone().filter(|&i| scene.parts[i].role != PartRole::Pattern);
    match parts.next() {
        Some(first) => part_bends[first].filter(|k| parts.all(|i| part_bends[i] == Some(*k))),
        None => bends.bend_of(s.owner.or(s.element)),
    }
}

/// Result for the filters of a slot. Pictures are in the slot's user space in the result.
#[derive(Debug)]
pub(crate) enum FilterOutcome {
    /// The filters follow the fit, which looks right.
    Fits,
    /// The filters' drawing beneath and above the graphic became pictures.
    Around { beneath: Option<BentImage>, above: Option<BentImage> },
    /// The graphic with its filters became a picture.
    Whole(BentImage),
}

impl FilterOutcome {
    /// The pictures beneath and above the graphic, which is not drawn in between for [`FilterOutcome::Whole`].
    pub(crate) fn pictures(&self) -> [Option<&BentImage>; 2] {
        match self {
            Self::Fits => [None, None],
            Self::Around { beneath, above } => [beneath.as_ref(), above.as_ref()],
            Self::Whole(image) => [Some(image), None],
        }
    }
}

/// Result for a bitmap.
#[derive(Debug)]
pub(crate) enum EmbeddedImage {
    /// Not selected, or placed exactly by its slot.
    Placed,
    /// Placed approximately, with the reason.
    Approximate(String),
    /// Bent, in the user space outside its placing transform.
    Bent {
        image: BentImage,
        /// Path data of the outline that clips the image, if it extends beyond, as a JPEG has no transparency.
        clip: Option<String>,
    },
}

/// Largest relative residual of an exact affine fit.
const EXACT: f64 = 1e-6;

/// Bends a bitmap, if a bend applies to it.
pub(super) fn bend_bitmap(b: &Bitmap, scene: &Scene, slots: &[PlacedSlot], bend: Option<&Bend<'_>>) -> EmbeddedImage {
    let Some(Bend { map, options }) = bend else { return EmbeddedImage::Placed };
    let pixels = b.image.size();
    let area = Rect::new(0.0, 0.0, f64::from(pixels.width()), f64::from(pixels.height()));
    let write = frame_in_result(scene, slots, b.slot, b.frame);
    if !b.bends || b.is_unread() || !b.image.is_visible() || !is_invertible(b.frame) || !is_invertible(write) {
        return EmbeddedImage::Placed;
    }
    let fit = fit(area, b.frame, write, *map);
    if fit.is_some_and(|f| f.residual <= EXACT && f.is_identity(area)) {
        return EmbeddedImage::Placed;
    }
    let approximate = |why: &str| EmbeddedImage::Approximate(format!("{why}; it is placed by the best affine fit"));
    let Images::Warp(warper) = &options.images else { return approximate("images are kept") };
    let data = match b.image.kind() {
        usvg::ImageKind::JPEG(d) | usvg::ImageKind::PNG(d) | usvg::ImageKind::GIF(d) | usvg::ImageKind::WEBP(d) => d,
        // Not a bitmap.
        usvg::ImageKind::SVG(_) => return EmbeddedImage::Placed,
    };
    let after = (write * b.placing.inverse()).inverse();
    let pixelated = matches!(b.image.rendering_mode(), ImageRendering::Pixelated | ImageRendering::CrispEdges);
    let clip = if is_jpeg(data) { visible_outline(b, area, after, (*map, options)) } else { None };
    let clipped = clip.is_some();
    let (placed, crop, to_px) = (b.frame, b.crop, scene.to_px);
    let request = ImageRequest { data, placed, crop, clipped, pixelated, map: *map, after, to_px };
    match warper.warp(&request) {
        Ok(image) => EmbeddedImage::Bent { image, clip },
        Err(why) => approximate(&why.to_string()),
    }
}

/// Path data of the bent outline of a bitmap's visible part, in the user space to which `after` leads; `None` if it cannot be bent.
fn visible_outline(b: &Bitmap, area: Rect, after: Affine, (map, options): (&dyn Map, &WarpOptions)) -> Option<String> {
    let shown = b.crop.map_or(area, |c| c.intersect(area));
    let corners = [(shown.x0, shown.y0), (shown.x1, shown.y0), (shown.x1, shown.y1), (shown.x0, shown.y1)];
    let outline = Outline::from_points(&corners.map(|c| b.frame * Point::from(c)), true);
    let path = refit::warp_path(&outline, map, &options.refit).ok()?.path;
    let digits = decimals(stretch(after.inverse()), options.refit.tolerance, options.precision);
    Some(path_data(&(after * path), digits))
}

/// The drawing with pattern tiles laid out as geometry, if they are to be warped one by one. Returns `None` if nothing changes.
pub(crate) fn with_tiles(drawing: &Drawing, bends: &Bends<'_>) -> Result<Option<Drawing>, Error> {
    /// Visible error as a fraction of the page's diagonal: half a pixel if the page is drawn a thousand pixels across.
    const VISIBLE: f64 = 5e-4;
    let patterns = bends.options.patterns;
    if matches!(patterns, Patterns::Fit | Patterns::Keep) || drawing.scene().tiles.is_empty() {
        return Ok(None);
    }
    let view = drawing.view_box();
    let visible = VISIBLE * view.width().hypot(view.height());
    let lays_out = |bend: &Bend<'_>, area: Rect, frame: Affine| {
        let follows = || fit(area, frame, Affine::IDENTITY, bend.map).is_some_and(|f| f.miss <= visible);
        patterns == Patterns::Instantiate || bend.options.copies.len() > 1 || !follows()
    };
    let needed = |painted: Painted, area: Rect, frame: Affine| {
        let bend = match painted {
            Painted::Element(e) => bends.bend_of(e),
            // Without a division, the first bend stands for all.
            Painted::Mask(bend) => bend.or(Some(0)),
        };
        bend.and_then(|k| bends.each.get(k)).is_some_and(|bend| lays_out(bend, area, frame))
    };
    let strokes = matches!(bends.options.strokes, Strokes::Auto | Strokes::Outline);
    drawing.tiled(Tiling::new(&needed, strokes)).map(Some)
}
