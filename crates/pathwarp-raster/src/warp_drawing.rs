//! Warps what a drawing shows, pixel by pixel, at the lowest resolution that shows the same.

use crate::error::Error;
use crate::pixmap::{bytes, new_pixmap};
use crate::render::draw;
use crate::warp_image::{GridInverse, ImageWarp, composed, lattice, lengths, shown, warp_image};
use kurbo::{Affine, Point, Rect, Vec2};
use pathwarp::budget::{Budget, Exceeded};
use pathwarp::map::{Creases, Jet, Map};
use std::fmt;
use tiny_skia::{IntRect, Pixmap, Transform};
use usvg::Node;
use usvg::filter::Kind;

/// Largest number of pixels of the drawing before the warp.
const MAX_SOURCE_PIXELS: f64 = 4e6;
/// Pixels along the longer side of two compared pictures.
const COMPARED: f64 = 128.0;
/// Pixels along the longer side in a first comparison, and the share of the painted pixels that may differ in it.
const COMPARED_FIRST: f64 = 64.0;
const COMPARED_FIRST_SHARE: f64 = 0.1;
/// Largest difference that nobody notices, of 255, and the share of the painted pixels that may exceed it.
const UNNOTICED: u8 = 8;
const UNNOTICED_SHARE: f64 = 0.01;
/// Largest usual difference between a smooth picture and its copy of half the size, of 255, the share of pixels that may exceed it, and
/// the largest difference of any pixel.
const SMOOTH: f64 = 3.0;
const SMOOTH_SHARE: f64 = 0.05;
const SMOOTH_MAX: f64 = 24.0;
/// Least ratio of the squared losses at a quarter and at half of the size of a blurred picture. Interpolation is of second order, so the
/// losses have a ratio of 4, and their squares one of 16.
const BLURRED: f64 = 5.0;
/// A length that exceeds whole pixels by less is rounded.
const ROUNDING: f64 = 1e-6;
/// Least number of pixels along a side of a picture.
const LEAST_SIDE: f64 = 64.0;

/// A function that counts a picture of this width and height before it is made.
pub type Counter<'a> = dyn Fn(f64, f64) -> Result<(), Exceeded> + 'a;

/// Warps drawings of one area.
pub struct DrawingWarp<'a> {
    /// The page of the drawings.
    area: Rect,
    /// Leads from the page to the plane of the map.
    placed: Affine,
    map: &'a dyn Map,
    inverse: GridInverse<'a>,
    /// Leads from the plane of the map to the plane of the result.
    after: Affine,
    /// Bounding box of the image of the area, in the plane of the result.
    bounds: Rect,
    /// Lengths of the image of a unit: in the direction that shrinks most, apart from a few outliers, and on average.
    lengths: [f64; 2],
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
        /// Cells along a side of the area, at whose corners the map is sampled.
        const CELLS: usize = 64;
        /// Reach of the inverse beyond the area, as a fraction of its longer side, and the pixels along a side that it is made for.
        const REACH: f64 = 0.02;
        const PIXELS: f64 = 48.0;
        /// One of so many samples may shrink more than `lengths` tells.
        const PER_OUTLIER: usize = 20;
        let samples: Vec<Point> = lattice(area, CELLS).map(|p| placed * p).collect();
        let mut images = vec![Jet::default(); samples.len()];
        map.jets(&samples, &mut images);
        let mut creases = Creases::default();
        map.creases(&mut creases);
        let is_defined = images.iter().all(|jet| jet.p.is_finite()) && samples.iter().all(|p| creases.defined_at(*p));
        let images: Vec<Jet> = images.into_iter().map(|jet| composed(&jet, after, placed)).collect();
        let mut shortest: Vec<f64> = images.iter().map(|jet| lengths(jet)[0]).collect();
        shortest.sort_unstable_by(f64::total_cmp);
        let mean = (images.iter().map(|jet| jet.det().abs()).sum::<f64>() / images.len() as f64).sqrt();
        let lengths = [shortest[images.len() / PER_OUTLIER], mean];
        let bounds = images.iter().map(|jet| Rect::from_points(jet.p, jet.p)).reduce(|a, b| a.union(b))?;
        let has_area = bounds.width() > 0.0 && bounds.height() > 0.0 && bounds.is_finite();
        if !is_defined || !has_area {
            return None;
        }
        let source = placed.transform_rect_bbox(area);
        let reach = REACH * source.width().max(source.height());
        let inverse = GridInverse::new(map, source, reach, Affine::IDENTITY, Affine::IDENTITY, PIXELS).strict();
        Some(Self { area, placed, map, inverse, after, bounds, lengths, count, budget })
    }

    /// The bounding box of the image of the area.
    #[must_use]
    pub fn bounds(&self) -> Rect {
        self.bounds
    }

    /// Returns `true` if a warped drawing looks like `other`, whose page is the bounding box of the image: if at most a small share of the
    /// painted pixels, or the area `unseen` in square units, differs. Both are drawn with at most `finest` pixels per unit.
    ///
    /// # Errors
    /// [`Error::TooLarge`] and [`Error::TooMuch`] when the work exceeds the limits, or [`Error::Renderer`].
    pub fn resembles(&self, tree: &usvg::Tree, other: &usvg::Tree, finest: f64, unseen: f64) -> Result<bool, Error> {
        /// Pixels of the drawing for one pixel of the result, along a side.
        const SHARE: f64 = 0.8;
        let bounds = self.bounds;
        let source_density = |density: f64| SHARE * density * (bounds.area() / self.area.area()).sqrt();
        let density_for = |pixels: f64| pixels / bounds.width().max(bounds.height());
        let resembles = |density: f64, share: f64| -> Result<bool, Error> {
            let density = whole_offsets(other, density);
            let target = whole_pixels(bounds, density);
            let picture = self.warped(tree, (target, density), source_density(density))?;
            Ok(alike(&picture, &self.drawn(other, (bounds, target), density)?, share, unseen * density * density))
        };
        let first = density_for(COMPARED_FIRST);
        Ok((first >= finest || resembles(first, COMPARED_FIRST_SHARE)?)
            && resembles(density_for(COMPARED).min(finest), UNNOTICED_SHARE)?)
    }

    /// Warps a drawing, with at least `coarsest` and at most `finest` pixels per unit of the plane of the result. Returns the picture and
    /// its position in that plane, or `None` if nothing is painted.
    ///
    /// # Errors
    /// [`Error::TooLarge`] and [`Error::TooMuch`] when the work exceeds the limits, or [`Error::Renderer`].
    pub fn paint(&self, tree: &usvg::Tree, coarsest: f64, finest: f64) -> Result<Option<(Pixmap, Rect)>, Error> {
        /// The least growth from a resolution to the next.
        const GROWTH: f64 = 1.4;
        /// Pixels of the drawing for one pixel of the result, along a side. Where the map stretches more, the result is a little smoother.
        const SHARE: f64 = 0.9;
        /// Largest such number in the direction that the map shrinks most, since sampling more is slow, and the smallest on average.
        const SHRUNK_SHARE: f64 = 1.9;
        const LEAST_SHARE: f64 = 0.5;
        let [shortest, mean] = self.lengths;
        let source_density =
            |density: f64| density * (SHARE * mean).min((SHRUNK_SHARE * shortest).max(LEAST_SHARE * mean));
        let bounds = self.bounds;
        let mut density = coarsest.max(LEAST_SIDE / bounds.width().min(bounds.height())).min(finest);
        let mut target = whole_pixels(bounds, density);
        let mut picture = self.warped(tree, (target, density), source_density(density))?;
        let Some(part) = painted(&picture) else { return Ok(None) };
        let [x, y, width, height] =
            [part.x().into(), part.y().into(), part.width().into(), part.height().into()].map(|v: f64| v / density);
        target = Rect::from_origin_size(target.origin() + Vec2::new(x, y), (width, height));
        picture = picture.clone_rect(part).unwrap_or(picture);
        while density < finest && !is_smooth(&picture) {
            // The density is the finest one, halved any number of times.
            let halvings = (finest / (GROWTH * density)).log2().floor().max(0.0);
            density = finest * (-halvings).exp2();
            target = whole_pixels(target, density);
            picture = self.warped(tree, (target, density), source_density(density))?;
        }
        Ok(Some((picture, target)))
    }

    /// A drawing warped over `target`, from a picture of about `source_density` pixels per unit.
    fn warped(&self, tree: &usvg::Tree, (target, density): (Rect, f64), source_density: f64) -> Result<Pixmap, Error> {
        let size = ((target.width() * density).round(), (target.height() * density).round());
        (self.count)(size.0, size.1)?;
        let source_density = whole_offsets(tree, source_density).min((MAX_SOURCE_PIXELS / self.area.area()).sqrt());
        let source_density = source_density.max(1.0 / self.area.width().min(self.area.height()));
        let source = self.drawn(tree, (self.area, self.area), source_density)?;
        let to_area = Affine::translate(self.area.origin().to_vec2()) * Affine::scale(1.0 / source_density);
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

/// The least density near the given one at which a drawing's filters offset by nearly whole pixels: the renderer drops fractions.
fn whole_offsets(tree: &usvg::Tree, density: f64) -> f64 {
    /// Range of the result, in multiples of the given density, and the largest fraction of a pixel that may be dropped.
    const LEAST: f64 = 0.85;
    const MOST: f64 = 2.0;
    const DROPPED: f64 = 0.15;
    /// Multiples tried of each offset.
    const TRIED: u32 = 3;
    let mut offsets = Vec::new();
    push_offsets(tree.root(), &mut offsets);
    let (least, most) = (LEAST * density, MOST * density);
    // Slightly more, for rounding.
    let whole = |v: f64| move |k: u32| ((v * least).ceil() + f64::from(k)) / v * (1.0 + ROUNDING);
    let tried = offsets.iter().filter(|v| **v > 0.0).flat_map(|v| (0..TRIED).map(whole(*v)));
    let tried = tried.filter(|d| *d < most).chain([density]);
    let dropped = |density: f64| offsets.iter().map(|v| (v * density).fract()).fold(DROPPED, f64::max);
    let better = |a: &f64, b: &f64| dropped(*a).total_cmp(&dropped(*b)).then(a.total_cmp(b));
    tried.min_by(better).unwrap_or(density)
}

/// Lists the offsets of filters, in units of the page.
fn push_offsets(g: &usvg::Group, out: &mut Vec<f64>) {
    let (x, y) = g.abs_transform().get_scale();
    let offset = |p: &usvg::filter::Primitive| match p.kind() {
        Kind::Offset(o) => [o.dx(), o.dy()],
        Kind::DropShadow(s) => [s.dx(), s.dy()],
        _ => [0.0; 2],
    };
    let offsets = g.filters().iter().flat_map(|f| f.primitives()).map(offset);
    out.extend(offsets.flat_map(|[dx, dy]| [dx * x, dy * y]).map(|v| f64::from(v).abs()));
    for n in g.children() {
        if let Node::Group(g) = n {
            push_offsets(g, out);
        }
    }
}

/// The box with the origin of `target` that is enlarged to whole pixels.
fn whole_pixels(target: Rect, density: f64) -> Rect {
    let side = |length: f64| (length * density - ROUNDING).ceil().max(1.0) / density;
    Rect::from_origin_size(target.origin(), (side(target.width()), side(target.height())))
}

/// The painted part of a picture, with a margin for interpolation.
fn painted(picture: &Pixmap) -> Option<IntRect> {
    const MARGIN: usize = 2;
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let (mut start, mut end) = ([width, height], [0, 0]);
    for (j, row) in picture.pixels().chunks_exact(width).enumerate() {
        if let Some(first) = row.iter().position(|p| p.alpha() > 0) {
            let last = row.iter().rposition(|p| p.alpha() > 0).unwrap_or(first);
            start = [start[0].min(first), start[1].min(j)];
            end = [end[0].max(last + 1), j + 1];
        }
    }
    let [x, y] = start.map(|v| v.saturating_sub(MARGIN));
    let [w, h] = [(end[0] + MARGIN).min(width).saturating_sub(x), (end[1] + MARGIN).min(height).saturating_sub(y)];
    if end[1] == 0 { None } else { IntRect::from_xywh(x as i32, y as i32, w as u32, h as u32) }
}

/// Returns `true` if at most a share of the painted pixels, or `unseen` pixels, differs between two pictures of the same size. Edges may
/// lie a pixel apart, so a pixel may have any colour between the colours around it in the other picture.
fn alike(a: &Pixmap, b: &Pixmap, share: f64, unseen: f64) -> bool {
    let (width, height) = (a.width() as usize, a.height() as usize);
    let is_between = |color: [u8; 4], picture: &Pixmap, index: usize| {
        let (x, y) = (index % width, index / width);
        let (mut least, mut most) = ([u8::MAX; 4], [0; 4]);
        for v in y.saturating_sub(1)..(y + 2).min(height) {
            for u in x.saturating_sub(1)..(x + 2).min(width) {
                let c = bytes(picture.pixels()[v * width + u]);
                least = std::array::from_fn(|k| least[k].min(c[k]));
                most = std::array::from_fn(|k| most[k].max(c[k]));
            }
        }
        (0..4).all(|k| color[k] >= least[k].saturating_sub(UNNOTICED) && color[k] <= most[k].saturating_add(UNNOTICED))
    };
    let (mut painted, mut different) = (0_u32, 0_u32);
    for (i, (p, q)) in a.pixels().iter().zip(b.pixels()).enumerate() {
        let (c, d) = (bytes(*p), bytes(*q));
        painted += u32::from(c[3].max(d[3]) > UNNOTICED);
        let is_near = (0..4).all(|k| c[k].abs_diff(d[k]) <= UNNOTICED);
        different += u32::from(!(is_near || (is_between(c, b, i) && is_between(d, a, i))));
    }
    f64::from(different) <= (share * f64::from(painted)).max(unseen)
}

/// Returns `true` if half as many pixels along each side, interpolated, show nearly the same picture, or if twice as many would.
fn is_smooth(picture: &Pixmap) -> bool {
    let half = Loss::new(picture, 2);
    half.max <= SMOOTH_MAX
        && ((half.over_smooth <= SMOOTH_SHARE && half.noticed <= UNNOTICED_SHARE)
            || Loss::new(picture, 4).squares >= BLURRED * half.squares)
}

/// Differences of a picture from a reduced copy of it, in which squares of pixels are averaged, interpolated to the full size.
#[derive(Default)]
struct Loss {
    /// The largest difference of a channel, 0 to 255.
    max: f64,
    /// The shares of pixels above [`SMOOTH`] and [`UNNOTICED`].
    over_smooth: f64,
    noticed: f64,
    /// The sum of the squared differences.
    squares: f64,
}

impl Loss {
    /// Measures the loss for squares of `n` pixels a side.
    fn new(picture: &Pixmap, n: usize) -> Self {
        let (width, height) = (picture.width() as usize / n, picture.height() as usize / n);
        let read = |x: usize, y: usize| picture.data()[4 * (y * picture.width() as usize + x)..][..4].iter();
        let mut sums = vec![[0.0; 4]; width * height];
        for (x, y) in (0..n * height).flat_map(|y| (0..n * width).map(move |x| (x, y))) {
            sums[(y / n) * width + (x / n)].iter_mut().zip(read(x, y)).for_each(|(s, v)| *s += f64::from(*v));
        }
        // The indices of a pixel's square and of the square next to it, and the weight of the latter.
        let mixture = |v: usize, squares: usize| {
            let offset = ((v % n) as f64 + 0.5) / n as f64 - 0.5;
            let beside = if offset < 0.0 { (v / n).saturating_sub(1) } else { (v / n + 1).min(squares - 1) };
            (v / n, beside, offset.abs())
        };
        let columns: Vec<_> = (0..n * width).map(|x| mixture(x, width)).collect();
        let mut out = Self::default();
        for y in 0..n * height {
            let (row, next_row, v) = mixture(y, height);
            for (x, (column, next_column, u)) in columns.iter().enumerate() {
                let squares = [(row, *column), (row, *next_column), (next_row, *column), (next_row, *next_column)];
                let [a, b, c, d] = squares.map(|(row, column)| sums[row * width + column]);
                let sum = |k: usize| (a[k] * (1.0 - u) + b[k] * u) * (1.0 - v) + (c[k] * (1.0 - u) + d[k] * u) * v;
                let area = (n * n) as f64;
                let differences = read(x, y).enumerate().map(|(k, value)| (sum(k) / area - f64::from(*value)).abs());
                let difference = differences.fold(0.0, f64::max);
                out.max = out.max.max(difference);
                out.over_smooth += f64::from(u8::from(difference > SMOOTH));
                out.noticed += f64::from(u8::from(difference > f64::from(UNNOTICED)));
                out.squares += difference * difference;
            }
        }
        let pixels = (n * n * width * height) as f64;
        Self { over_smooth: out.over_smooth / pixels, noticed: out.noticed / pixels, ..out }
    }
}
