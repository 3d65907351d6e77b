//! Chooses the resolution of a warped paint.
//!
//! Renderers interpolate between the pixels of a picture. A smooth gradient therefore needs only enough pixels for the interpolated
//! colours to be right; only jumps and kinks need as many as the screen has.

use super::grid_inverse::GridInverse;
use super::image_warp::shown;
use super::shade::{Colors, Shade, shade};
use crate::error::Error;
use crate::pixmap::bytes;
use kurbo::{Affine, BezPath, Point, Rect, Vec2};
use pathwarp::map::Map;
use std::fmt;
use tiny_skia::Pixmap;

/// Margin around the target in pixels: renderers read up to two pixels on either side of a point.
const MARGIN: f64 = 2.0;
/// Reach of the paint around its source, in pixels: enough for the margin even where the map compresses it several times.
const REACH: f64 = 12.0;
/// Largest reach as a fraction of the source's longer side.
const MAX_REACH: f64 = 0.3;
/// Range of the growth of a side from one picture to the next.
const GROWTH: (f64, f64) = (1.2, 4.0);
/// Safety factor on the expected growth.
const SAFETY: f64 = 1.05;
/// A side grows if its second differences add up to at least this fraction of those along the other side.
const GROWING_SHARE: f64 = 0.4;

/// A colour that the result must show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenColor {
    /// Point in the plane of the result.
    pub at: Point,
    /// Red, green, blue and alpha, 0 to 1, premultiplied.
    pub color: [f64; 4],
}

/// Accepted differences between an interpolated picture and the exact colours, where 1 is the range of a channel.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ShadeTolerance {
    /// Largest usual difference.
    pub usual: f64,
    /// Fraction of the colours that may exceed it.
    pub share: f64,
    /// Largest difference of any colour.
    pub largest: f64,
}

impl ShadeTolerance {
    /// Invisible, except that kinks at stops may be softened a little.
    pub const UNNOTICED: Self = Self { usual: 1.5 / 255.0, share: 0.05, largest: 8.0 / 255.0 };
    /// Invisible everywhere.
    pub const INVISIBLE: Self = Self { usual: 1.5 / 255.0, share: 0.0, largest: 1.5 / 255.0 };
}

/// A paint to warp at the lowest sufficient resolution.
#[derive(Clone, Copy)]
pub struct SmoothShade<'a> {
    /// The paint.
    pub colors: &'a Colors<'a>,
    /// The part of the paint to warp, in its coordinates.
    pub source: Rect,
    /// Maps the paint's coordinates to the plane of the map.
    pub placed: Affine,
    /// The map.
    pub map: &'a dyn Map,
    /// Maps the plane of the map to the plane of the result.
    pub after: Affine,
    /// The part of the result's plane to paint.
    pub target: Rect,
    /// The shape that limits the visible area; `None` if all of the target is visible.
    pub shape: Option<&'a BezPath>,
    /// Colours to compare with. Without any, the resolution is `finest`.
    pub seen: &'a [SeenColor],
    /// Accepted differences from `seen`.
    pub tolerance: ShadeTolerance,
    /// Smallest number of pixels across the target and down.
    pub coarsest: Vec2,
    /// Largest number of pixels per unit of the plane, reached if nothing less suffices.
    pub finest: f64,
}

impl fmt::Debug for SmoothShade<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SmoothShade").field("map", &self.map).field("target", &self.target).finish_non_exhaustive()
    }
}

impl SmoothShade<'_> {
    /// Paints the target and two pixels around it. Returns the picture and its position in the plane.
    ///
    /// # Errors
    /// [`Error::Empty`] and [`Error::TooLarge`] for impossible sizes of the picture; [`Error::NoInverse`] when no pixel has an inverse.
    pub fn paint(&self) -> Result<(Pixmap, Rect), Error> {
        let finest = Vec2::new(self.target.width(), self.target.height()) * self.finest;
        let finest = Vec2::new(finest.x.max(self.coarsest.x), finest.y.max(self.coarsest.y));
        let limit = |v: Vec2| Vec2::new(v.x.min(finest.x), v.y.min(finest.y));
        let mut pixels = if self.seen.is_empty() { finest } else { self.coarsest };
        loop {
            let (pixmap, area) = self.painted(pixels)?;
            if pixels == finest {
                return Ok((pixmap, area));
            }
            let growth = Interpolation { pixmap: &pixmap, area }.growth(self.seen, &self.tolerance);
            let Some(growth) = growth else { return Ok((pixmap, area)) };
            let next = limit(Vec2::new(pixels.x * growth.x, pixels.y * growth.y));
            // If the side to grow has reached its limit, finish at full resolution.
            pixels = if next == pixels { finest } else { next };
        }
    }

    /// Paints with the given number of pixels across the target and down.
    fn painted(&self, pixels: Vec2) -> Result<(Pixmap, Rect), Error> {
        let (pixel_width, pixel_height) = (self.target.width() / pixels.x, self.target.height() / pixels.y);
        let with_margin = |n: f64| (n + 2.0 * MARGIN).ceil().max(1.0);
        let (columns, rows) = (with_margin(pixels.x), with_margin(pixels.y));
        let area = Rect::from_center_size(self.target.center(), (columns * pixel_width, rows * pixel_height));
        let size = (columns as u32, rows as u32);
        // Extend the paint to the pixels around its image that renderers read.
        let reach = (REACH / pixels.x.min(pixels.y)).min(MAX_REACH) * self.source.width().max(self.source.height());
        let side = (pixels.x * pixels.y).sqrt();
        let inverse = GridInverse::new(self.map, self.source, reach, self.placed, self.after, side);
        let (colors, shape) = (self.colors, self.shape);
        let pixmap = shade(&Shade { colors, inverse: &inverse, shown: shown(area, size), size, shape })?;
        Ok((pixmap, area))
    }
}

/// A picture as a renderer shows it, interpolated between its pixels.
struct Interpolation<'a> {
    pixmap: &'a Pixmap,
    area: Rect,
}

impl Interpolation<'_> {
    /// Returns the factors by which the sides of the picture should grow, or `None` if it is good enough.
    fn growth(&self, seen: &[SeenColor], tolerance: &ShadeTolerance) -> Option<Vec2> {
        // Sums of second differences along both sides, where colours differ visibly.
        let mut bends = [0.0_f64; 2];
        let mut differences: Vec<f64> = Vec::with_capacity(seen.len());
        for s in seen {
            let (found, bend) = self.color_at(s.at);
            let difference = s.color.iter().zip(found).map(|(w, f)| (w - f).abs()).fold(0.0, f64::max);
            differences.push(difference);
            if difference > tolerance.usual {
                bends = [bends[0] + bend[0], bends[1] + bend[1]];
            }
        }
        differences.sort_by(f64::total_cmp);
        let largest = differences.last().copied().unwrap_or_default();
        let rank = differences.len().saturating_sub(1 + (tolerance.share * differences.len() as f64) as usize);
        let usual = differences.get(rank).copied().unwrap_or_default();
        if largest <= tolerance.largest && usual <= tolerance.usual {
            return None;
        }
        // The error of interpolation falls with the square of the distance of the pixels, and at kinks in proportion to it.
        let growth = (usual / tolerance.usual).sqrt().max(largest / tolerance.largest);
        let growth = (SAFETY * growth).clamp(GROWTH.0, GROWTH.1);
        let largest = bends[0].max(bends[1]);
        let factor = |bend: f64| if bend >= GROWING_SHARE * largest { growth } else { 1.0 };
        Some(Vec2::new(factor(bends[0]), factor(bends[1])))
    }

    /// The premultiplied colour at a point, and the second differences along both sides.
    fn color_at(&self, p: Point) -> ([f64; 4], [f64; 2]) {
        let (width, height) = (self.pixmap.width() as usize, self.pixmap.height() as usize);
        // The pixel before a coordinate, and the fraction of the way to the next one.
        let position = |v: f64, start: f64, size: f64, pixels: usize| {
            let v = (((v - start) / size) * pixels as f64 - 0.5).clamp(0.0, pixels as f64 - 1.0);
            let i = (v as usize).min(pixels.saturating_sub(2));
            (i, v - i as f64)
        };
        let (i, u) = position(p.x, self.area.x0, self.area.width(), width);
        let (j, v) = position(p.y, self.area.y0, self.area.height(), height);
        let read = |i: usize, j: usize| {
            let pixel = self.pixmap.pixels()[j.min(height - 1) * width + i.min(width - 1)];
            bytes(pixel).map(|v| f64::from(v) / 255.0)
        };
        let [a, b, c, d] = [read(i, j), read(i + 1, j), read(i, j + 1), read(i + 1, j + 1)];
        let color = std::array::from_fn(|k| {
            let (top, bottom) = (a[k] + u * (b[k] - a[k]), c[k] + u * (d[k] - c[k]));
            top + v * (bottom - top)
        });
        let bend = |before: [f64; 4], here: [f64; 4], after: [f64; 4]| {
            (0..4).map(|k| (before[k] - 2.0 * here[k] + after[k]).abs()).fold(0.0, f64::max)
        };
        (color, [bend(read(i.saturating_sub(1), j), a, b), bend(read(i, j.saturating_sub(1)), a, c)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::warp_image::shade::tests::each;
    use pathwarp::map::{AffineMap, Formula, Real};

    struct Bend;

    impl Formula for Bend {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            (x, y + (x / 25.0).sin() * 8.0)
        }
    }

    const SOURCE: Rect = Rect::new(0.0, 0.0, 100.0, 60.0);

    fn seen(map: &dyn Map, color: &dyn Fn(Point) -> [f64; 4]) -> Vec<SeenColor> {
        let point = |k: u32| Point::new(f64::from(k) / 10.0, 60.0 * (f64::from(k) * 0.618).fract());
        (0..1000).map(|k| SeenColor { at: map.point(point(k)), color: color(point(k)) }).collect()
    }

    fn painted(map: &dyn Map, color: &(dyn Fn(Point) -> [f64; 4] + Sync), tolerance: ShadeTolerance) -> (Pixmap, Rect) {
        let seen = seen(map, color);
        let target = Rect::new(0.0, -8.0, 100.0, 68.0);
        let (placed, after) = (Affine::IDENTITY, Affine::IDENTITY);
        let (source, coarsest, finest) = (SOURCE, Vec2::new(12.0, 12.0), 8.0);
        let colors = &each(color);
        let (seen, shape) = (&seen[..], None);
        let shade =
            SmoothShade { colors, source, placed, map, after, target, shape, seen, tolerance, coarsest, finest };
        shade.paint().unwrap()
    }

    #[test]
    fn the_resolution_follows_from_the_colours() {
        let grey = |v: f64| [v, v, v, 1.0];
        let plain = |p: Point| grey(0.2 + 0.6 * p.x / 100.0);
        let smooth = |p: Point| grey(0.5 + 0.5 * (p.y / 10.0).sin());
        let jump = |p: Point| grey(if p.y < 30.0 { 0.0 } else { 1.0 });
        let size = |color: &(dyn Fn(Point) -> [f64; 4] + Sync)| {
            let (pixmap, area) = painted(&Bend, color, ShadeTolerance::INVISIBLE);
            assert!(area.x0 < 0.0 && area.x1 > 100.0 && area.y0 < -8.0 && area.y1 > 68.0, "{area}");
            let found = Interpolation { pixmap: &pixmap, area };
            let off = |s: &SeenColor| {
                s.color.iter().zip(found.color_at(s.at).0).map(|(w, f)| (w - f).abs()).fold(0.0, f64::max)
            };
            let seen = seen(&Bend, color);
            (pixmap.width(), pixmap.height(), seen.iter().map(off).fold(0.0, f64::max))
        };
        let [plain, smooth, jump] = [size(&plain), size(&smooth), size(&jump)];
        println!("{plain:?} {smooth:?} {jump:?}");
        assert_eq!((plain.0, plain.1), (16, 16));
        assert!(smooth.1 > 30 && smooth.1 < 200, "{smooth:?}");
        // At full resolution, and off only at the jump itself.
        assert_eq!((jump.0, jump.1), (804, 612));
        assert!(plain.2 <= 1.5 / 255.0 && smooth.2 <= 1.5 / 255.0 && jump.2 > 0.1);
    }

    /// Only one side grows, up to its limit; the other must follow, or the search would not end.
    #[test]
    fn the_search_ends_at_the_limit_of_one_side() {
        let map = AffineMap(Affine::IDENTITY);
        let color = |p: Point| [(p.x * 1000.0).sin().abs(), 0.0, 0.0, 1.0];
        let (pixmap, _) = painted(&map, &color, ShadeTolerance::INVISIBLE);
        assert_eq!((pixmap.width(), pixmap.height()), (804, 612));
    }
}
