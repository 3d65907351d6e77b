//! Warps what a drawing shows, pixel by pixel, at the lowest resolution that shows the same.

use crate::error::Error;
use crate::pixmap::new_pixmap;
use crate::render::draw;
use crate::warp_image::{GridInverse, ImageWarp, lattice, shown, warp_image};
use kurbo::{Affine, Point, Rect, Vec2};
use pathwarp::budget::{Budget, Exceeded};
use pathwarp::map::{Creases, Map};
use std::fmt;
use tiny_skia::{IntRect, Pixmap, Transform};
use usvg::Node;
use usvg::filter::Kind;

/// Most pixels of the drawing before the warp.
const MOST_BEFORE: f64 = 4e6;
/// Pixels along the longer side where a drawing is compared with another.
const COMPARED: f64 = 128.0;
/// The largest difference that nobody notices, of 255, and the share of what is painted that may exceed it.
const NOTICED: u8 = 8;
const NOTICED_SHARE: f64 = 0.01;
/// The largest difference between a smooth picture and one of half its size at most places, the share of other places, and the largest
/// difference anywhere.
const SMOOTH: f64 = 3.0;
const SMOOTH_SHARE: f64 = 0.05;
const SHARP: f64 = 24.0;
/// A length that exceeds whole pixels by less is rounded.
const ROUNDING: f64 = 1e-6;
/// Resolutions tried, each twice the one before.
const LEVELS: i32 = 4;
/// The fewest pixels of a picture along a side.
const LEAST_SIDE: f64 = 64.0;

/// Counts a picture of this width and height before it is made.
pub type Counter<'a> = dyn Fn(f64, f64) -> Result<(), Exceeded> + 'a;

/// Warps drawings of one area.
pub struct DrawingWarp<'a> {
    area: Rect,
    placed: Affine,
    map: &'a dyn Map,
    inverse: GridInverse<'a>,
    after: Affine,
    bounds: Rect,
    count: &'a Counter<'a>,
    budget: &'a Budget,
}

impl fmt::Debug for DrawingWarp<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DrawingWarp").field("map", &self.map).field("area", &self.area).finish_non_exhaustive()
    }
}

impl<'a> DrawingWarp<'a> {
    /// Warps drawings whose page is `area`, placed in the plane of `map`; `after` leads from that plane to the plane of the result. Work
    /// is charged to `budget`. Returns `None` if the map is not defined on all of the area, or makes nothing of it.
    pub fn new(
        (area, placed): (Rect, Affine),
        map: &'a dyn Map,
        after: Affine,
        count: &'a Counter<'a>,
        budget: &'a Budget,
    ) -> Option<Self> {
        /// Cells along a side of the area where the map is looked at.
        const CELLS: usize = 64;
        /// Reach of the inverse beyond the area, and pixels that it is made for.
        const REACH: f64 = 0.02;
        const PIXELS: f64 = 48.0;
        let places: Vec<Point> = lattice(area, CELLS).map(|p| placed * p).collect();
        let mut images = vec![Point::ORIGIN; places.len()];
        map.points(&places, &mut images);
        let mut creases = Creases::default();
        map.creases(&mut creases);
        let is_defined = images.iter().all(|p| p.is_finite()) && places.iter().all(|p| creases.defined_at(*p));
        let images = images.into_iter().map(|p| after * p);
        let bounds = images.map(|p| Rect::from_origin_size(p, (0.0, 0.0))).reduce(|a, b| a.union(b))?;
        let has_area = bounds.width() > 0.0 && bounds.height() > 0.0 && bounds.is_finite();
        let place = placed.transform_rect_bbox(area);
        let reach = REACH * place.width().max(place.height());
        let inverse = || GridInverse::new(map, place, reach, Affine::IDENTITY, Affine::IDENTITY, PIXELS).strict();
        (is_defined && has_area).then(|| Self { area, placed, map, inverse: inverse(), after, bounds, count, budget })
    }

    /// The bounding box of the image of the area.
    #[must_use]
    pub fn bounds(&self) -> Rect {
        self.bounds
    }

    /// Returns `true` if a warped drawing looks like `other`, whose page is the bounding box of the image, with at most `finest` pixels
    /// per unit.
    ///
    /// # Errors
    /// The work exceeds the limits, or the renderer fails.
    pub fn resembles(&self, tree: &usvg::Tree, other: &usvg::Tree, finest: f64) -> Result<bool, Error> {
        let bounds = self.bounds;
        let (target, density) = grid(bounds, (COMPARED / bounds.width().max(bounds.height())).min(finest), 1.0);
        let picture = self.warped(tree, target, density)?;
        let other = self.drawn(other, (bounds, target), density)?;
        Ok(alike(&picture, &other))
    }

    /// Warps a drawing, with at least `coarsest` and at most `finest` pixels per unit of the plane of the result. Returns the picture and
    /// its position in that plane, or `None` if nothing is painted.
    ///
    /// # Errors
    /// As for [`DrawingWarp::resembles`].
    pub fn paint(&self, tree: &usvg::Tree, coarsest: f64, finest: f64) -> Result<Option<(Pixmap, Rect)>, Error> {
        let bounds = self.bounds;
        let least = coarsest.max(LEAST_SIDE / bounds.width().min(bounds.height()));
        let level = (0..LEVELS).rev().find(|k| finest * 0.5_f64.powi(*k) >= least).unwrap_or(0);
        let (target, finest) = grid(bounds, finest, 2_f64.powi(level));
        let density = |level: i32| finest * 0.5_f64.powi(level);
        let mut picture = self.warped(tree, target, density(level))?;
        let Some(part) = painted(&picture) else { return Ok(None) };
        let corner = Vec2::new(part.x().into(), part.y().into()) / density(level);
        let size = (f64::from(part.width()) / density(level), f64::from(part.height()) / density(level));
        let target = Rect::from_origin_size(target.origin() + corner, size);
        picture = picture.clone_rect(part).unwrap_or(picture);
        for level in (0..level).rev() {
            if is_smooth(&picture) {
                break;
            }
            picture = self.warped(tree, target, density(level))?;
        }
        Ok(Some((picture, target)))
    }

    /// A drawing warped over `target`.
    fn warped(&self, tree: &usvg::Tree, target: Rect, density: f64) -> Result<Pixmap, Error> {
        /// Pixels of the drawing for one of the result; where the map stretches it more, it is shown a little smoother.
        const SHARE: f64 = 0.8;
        let size = ((target.width() * density).round(), (target.height() * density).round());
        (self.count)(size.0, size.1)?;
        let before = SHARE * density * (self.bounds.area() / self.area.area()).sqrt();
        let before = whole_offsets(tree, before).min((MOST_BEFORE / self.area.area()).sqrt());
        let before = before.max(1.0 / self.area.width().min(self.area.height()));
        let source = self.drawn(tree, (self.area, self.area), before)?;
        let to_area = Affine::translate(self.area.origin().to_vec2()) * Affine::scale(1.0 / before);
        let size = (size.0 as u32, size.1 as u32);
        let warp = ImageWarp {
            source: &source,
            placed: self.placed * to_area,
            map: self.map,
            inverse: &self.inverse,
            shown: self.after.inverse() * shown(target, size),
            size,
        };
        warp_image(&warp)
    }

    /// A part of a drawing whose page is `area`, as a picture of this density.
    fn drawn(&self, tree: &usvg::Tree, (area, part): (Rect, Rect), density: f64) -> Result<Pixmap, Error> {
        let side = |length: f64| (length * density - ROUNDING).ceil().max(1.0);
        let mut out = new_pixmap(side(part.width()), side(part.height()), &self.budget.limits())?;
        let scale = density * area.width() / f64::from(tree.size().width());
        let [scale, x, y] = [scale, density * (area.x0 - part.x0), density * (area.y0 - part.y0)].map(|v| v as f32);
        draw(tree, Transform::from_row(scale, 0.0, 0.0, scale, x, y), &mut out, self.budget)?;
        Ok(out)
    }
}

/// A density of `least` to twice as much at which a drawing's filters offset by nearly whole pixels: the renderer drops fractions.
fn whole_offsets(tree: &usvg::Tree, least: f64) -> f64 {
    let offset = |p: &usvg::filter::Primitive| match p.kind() {
        Kind::Offset(o) => [o.dx(), o.dy()],
        Kind::DropShadow(s) => [s.dx(), s.dy()],
        _ => [0.0; 2],
    };
    let groups = tree.root().children().iter().filter_map(|n| if let Node::Group(g) = n { Some(g) } else { None });
    let filters = groups.flat_map(|g| g.filters());
    let all: Vec<f64> = filters.flat_map(|f| f.primitives()).flat_map(offset).map(|v| f64::from(v).abs()).collect();
    let dropped = |density: f64| all.iter().map(|v| (v * density).fract()).fold(0.0, f64::max);
    // Slightly more, for rounding.
    let whole = all.iter().filter(|v| **v > 0.0).map(|v| (v * least).ceil() / v * (1.0 + ROUNDING));
    let tried = whole.filter(|d| *d < 2.0 * least).chain([least]);
    tried.min_by(|a, b| dropped(*a).total_cmp(&dropped(*b)).then(a.total_cmp(b))).unwrap_or(least)
}

/// A box of whole pixels, a multiple of `of` along each side, around `target`; and their density.
fn grid(target: Rect, density: f64, of: f64) -> (Rect, f64) {
    let side = |length: f64| (length * density / of - ROUNDING).ceil().max(1.0) * of / density;
    (Rect::from_origin_size(target.origin(), (side(target.width()), side(target.height()))), density)
}

/// The part of a picture that is painted, with a margin for what is interpolated.
fn painted(picture: &Pixmap) -> Option<IntRect> {
    const MARGIN: usize = 2;
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let (mut from, mut to) = ([width, height], [0, 0]);
    for (j, row) in picture.pixels().chunks_exact(width).enumerate() {
        if let Some(first) = row.iter().position(|p| p.alpha() > 0) {
            let last = row.iter().rposition(|p| p.alpha() > 0).unwrap_or(first);
            from = [from[0].min(first), from[1].min(j)];
            to = [to[0].max(last + 1), j + 1];
        }
    }
    let [x, y] = from.map(|v| v.saturating_sub(MARGIN));
    let [w, h] = [(to[0] + MARGIN).min(width).saturating_sub(x), (to[1] + MARGIN).min(height).saturating_sub(y)];
    if to[1] == 0 { None } else { IntRect::from_xywh(x as i32, y as i32, w as u32, h as u32) }
}

/// Returns `true` if two pictures of the same size look alike. Edges may lie a pixel apart, so each pixel may have any colour
/// between those of the pixels around it in the other.
fn alike(a: &Pixmap, b: &Pixmap) -> bool {
    let (width, height) = (a.width() as usize, a.height() as usize);
    let read = |of: &Pixmap, at: usize| <[u8; 4]>::try_from(&of.data()[4 * at..4 * at + 4]).unwrap_or_default();
    let between = |own: [u8; 4], around: &Pixmap, at: usize| {
        let (x, y) = (at % width, at / width);
        let middle = read(around, at);
        let (mut least, mut most) = (middle, middle);
        for v in y.saturating_sub(1)..(y + 2).min(height) {
            for u in x.saturating_sub(1)..(x + 2).min(width) {
                let c = read(around, v * width + u);
                least = std::array::from_fn(|k| least[k].min(c[k]));
                most = std::array::from_fn(|k| most[k].max(c[k]));
            }
        }
        (0..4).all(|k| own[k] >= least[k].saturating_sub(NOTICED) && own[k] <= most[k].saturating_add(NOTICED))
    };
    let (mut painted, mut off) = (0_u32, 0_u32);
    for at in 0..width * height {
        let (c, d) = (read(a, at), read(b, at));
        painted += u32::from(c[3].max(d[3]) > NOTICED);
        let is_near = (0..4).all(|k| c[k].abs_diff(d[k]) <= NOTICED);
        off += u32::from(!(is_near || between(c, b, at) && between(d, a, at)));
    }
    f64::from(off) <= NOTICED_SHARE * f64::from(painted)
}

/// Returns `true` if half as many pixels along each side, interpolated, show nearly the same.
fn is_smooth(picture: &Pixmap) -> bool {
    let (width, height) = (picture.width() as usize / 2, picture.height() as usize / 2);
    let read = |x: usize, y: usize| &picture.data()[4 * (y * picture.width() as usize + x)..][..4];
    // Sums of squares of four pixels.
    let sums = (0..width * height).map(|at| {
        let (x, y) = (2 * (at % width), 2 * (at / width));
        let four = [read(x, y), read(x + 1, y), read(x, y + 1), read(x + 1, y + 1)];
        std::array::from_fn(|k| four.iter().map(|p| i32::from(p[k])).sum())
    });
    let sums: Vec<[i32; 4]> = sums.collect();
    // A pixel lies a quarter of a square beside the middle of its own.
    let beside =
        |v: usize, n: usize| if v.is_multiple_of(2) { (v / 2).saturating_sub(1) } else { (v / 2 + 1).min(n - 1) };
    let (mut over, mut noticed) = (0_usize, 0_usize);
    for at in 0..4 * width * height {
        let (x, y) = (at % (2 * width), at / (2 * width));
        let (u, v) = (beside(x, width), beside(y, height) * width);
        let [a, b, c, d] = [y / 2 * width + x / 2, y / 2 * width + u, v + x / 2, v + u].map(|i| sums[i]);
        let off = (0..4).map(|k| (9 * a[k] + 3 * (b[k] + c[k]) + d[k] - 64 * i32::from(read(x, y)[k])).abs());
        let off = f64::from(off.max().unwrap_or(0)) / 64.0;
        if off > SHARP {
            return false;
        }
        over += usize::from(off > SMOOTH);
        noticed += usize::from(off > f64::from(NOTICED));
    }
    let share = |n: usize| n as f64 / (4 * width * height) as f64;
    share(over) <= SMOOTH_SHARE && share(noticed) <= NOTICED_SHARE
}
