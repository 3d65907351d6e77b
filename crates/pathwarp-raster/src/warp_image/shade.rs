//! Warps a paint: the inverse map gives every pixel of the result its position in the paint.

use super::grid_inverse::GridInverse;
use super::tile::{MIN_TILE, PixelArea, TILE, announce};
use super::trace::{ChebyshevBasis, MAX_ERROR};
use crate::error::Error;
use crate::pixmap::{for_each_chunk_pair, new_pixmap};
use kurbo::{Affine, BezPath, Point, Rect};
use pathwarp::budget::Limits;
use pathwarp::engine::{Batches, Gathered};
use pathwarp::map::Map;
use pathwarp::outline::boundary;
use std::fmt;
use tiny_skia::{ColorU8, Pixmap, PremultipliedColorU8};

/// Largest error of a source point in a traced tile, in pixels of the result.
const MAX_SHADE_ERROR: f64 = 1.0 / 64.0;
/// Largest side of a block in pixels. Smooth colours tolerate a larger error than the pixels of a bitmap, so a cubic covers a larger
/// area than a tile.
const BLOCK: usize = 2 * TILE;
/// Pictures with fewer pixels are painted faster on one thread.
const MIN_PARALLEL: usize = 1 << 17;

/// The colours at points of a paint's coordinates: red, green, blue and alpha, 0 to 1, not premultiplied.
pub type Colors<'a> = dyn Fn(&[Point], &mut [[f64; 4]]) + Sync + 'a;

/// A paint, a map, and the part of the plane that the result shows.
#[derive(Clone, Copy)]
pub struct Shade<'a> {
    /// The paint.
    pub colors: &'a Colors<'a>,
    /// From the plane of the result to the paint's coordinates.
    pub inverse: &'a GridInverse<'a>,
    /// The view of the result: maps its pixels (the box 0, 0, width, height) to the plane.
    pub shown: Affine,
    /// Width and height of the result in pixels.
    pub size: (u32, u32),
    /// The shape in the plane that limits the visible area, together with two pixels around it; `None` if everything is visible.
    pub shape: Option<&'a BezPath>,
}

impl fmt::Debug for Shade<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Shade").field("size", &self.size).finish_non_exhaustive()
    }
}

/// Warps a paint. Pixels without an inverse, and those far from the shape, take the colour of the nearest pixel in their row, or else of
/// the nearest row, so that a clip along the edge of the image shows no gap and the file stays small.
///
/// # Errors
/// [`Error::Empty`] and [`Error::TooLarge`] for impossible sizes of the result; [`Error::NoInverse`] when no pixel has an inverse.
pub fn shade(shade: &Shade<'_>) -> Result<Pixmap, Error> {
    let (width, height) = shade.size;
    let mut out = new_pixmap(f64::from(width), f64::from(height), &Limits::default())?;
    // Estimate the size of a pixel of the result in the paint's coordinates.
    let centre = shade.shown * Point::new(0.5 * f64::from(width), 0.5 * f64::from(height));
    let det = (shade.inverse.jet(centre).det() * shade.shown.determinant()).abs();
    let unit = if det > 0.0 && det.is_finite() { det.sqrt() } else { shade.shown.determinant().abs().sqrt() };
    let painter = ShadePainter {
        shade,
        cover: shade.shape.map(|shape| Cover::new(shape, shade.shown, shade.size)),
        basis: ChebyshevBasis::new(),
        to_trace: Affine::scale(MAX_ERROR / (MAX_SHADE_ERROR * unit)),
    };
    let columns = width as usize;
    let mut known = vec![false; columns * height as usize];
    let blocks = |top: usize, rows: usize| {
        let lefts = (0..columns).step_by(BLOCK);
        let blocks = lefts.map(|left| PixelArea { left, top, width: BLOCK.min(columns - left), height: rows });
        blocks.filter_map(|block| painter.visible(block)).collect::<Vec<_>>()
    };
    let paint = |band: usize, pixels: &mut [PremultipliedColorU8], known: &mut [bool], inverse: &dyn Map| {
        let top = band * BLOCK;
        let blocks = blocks(top, pixels.len() / columns);
        let mut band = ShadeBand { top, columns, pixels, known, inverse };
        blocks.into_iter().for_each(|block| painter.block(&mut band, block));
    };
    // A costly inverse, such as another program's, is asked for many points at once.
    let batches = shade.inverse.cost().batches.is_some();
    if known.len() >= MIN_PARALLEL {
        for_each_chunk_pair(out.pixels_mut(), &mut known, columns * BLOCK, |i, pixels, known| {
            let cache = batches.then(|| painter.cache(blocks(i * BLOCK, pixels.len() / columns)));
            paint(i, pixels, known, cache.as_ref().map_or(shade.inverse, |cache| cache as &dyn Map));
        });
    } else {
        let all = || (0..height as usize).step_by(BLOCK).flat_map(|top| blocks(top, BLOCK.min(height as usize - top)));
        let cache = batches.then(|| painter.cache(all().collect()));
        let inverse = cache.as_ref().map_or(shade.inverse as &dyn Map, |cache| cache);
        let bands = out.pixels_mut().chunks_mut(columns * BLOCK).zip(known.chunks_mut(columns * BLOCK));
        bands.enumerate().for_each(|(i, (pixels, known))| paint(i, pixels, known, inverse));
    }
    if !known.contains(&true) {
        return Err(Error::NoInverse);
    }
    if known.contains(&false) {
        extend(&mut out, &known);
    }
    Ok(out)
}

/// A band of whole rows of the result.
struct ShadeBand<'a> {
    /// The first row.
    top: usize,
    columns: usize,
    pixels: &'a mut [PremultipliedColorU8],
    /// For every pixel, `true` if it is painted.
    known: &'a mut [bool],
    /// The inverse, or a cache of it.
    inverse: &'a dyn Map,
}

/// Data shared by all tiles.
struct ShadePainter<'a> {
    shade: &'a Shade<'a>,
    /// The visible part; `None` if everything is visible.
    cover: Option<Cover>,
    basis: ChebyshevBasis,
    /// Scales the paint's coordinates to those of traces, in which [`MAX_ERROR`], their tolerance, stands for [`MAX_SHADE_ERROR`].
    to_trace: Affine,
}

impl<'a> ShadePainter<'a> {
    /// The visible part of an area. `None` if nothing is visible, or nothing has an inverse.
    fn visible(&self, area: PixelArea) -> Option<PixelArea> {
        let visible = self.cover.as_ref().map_or(Some(area), |cover| cover.visible(area));
        visible.filter(|visible| self.shade.inverse.touches(visible.covered(self.shade.shown)))
    }

    /// Caches the values of the inverse for these blocks, computed in batches. Painting needs no jets.
    fn cache(&self, blocks: Vec<PixelArea>) -> Gathered<'a> {
        let cache = Gathered::new(self.shade.inverse);
        announce(blocks, &self.basis, (self.shade.shown, self.to_trace), &cache, |pixels| {
            cache.prepare(pixels, &[]);
        });
        cache
    }

    /// Paints a block, dividing it until the inverse is close to a cubic.
    fn block(&self, band: &mut ShadeBand<'_>, area: PixelArea) {
        match area.trace(&self.basis, self.shade.shown, band.inverse, self.to_trace) {
            Some(trace) => {
                for tile in area.tiles().filter_map(|tile| self.visible(tile)) {
                    let (right, down) = (tile.left - area.left, tile.top - area.top);
                    self.paint(band, tile, |j| {
                        let row = trace.pixels(down + j);
                        move |i| row.point(right + i)
                    });
                }
            }
            None if area.width.max(area.height) > MIN_TILE => {
                area.quarters().filter_map(|a| self.visible(a)).for_each(|quarter| self.block(band, quarter));
            }
            None => {
                let pixels: Vec<Point> = area.pixels(self.shade.shown).collect();
                let mut sources = vec![Point::ORIGIN; pixels.len()];
                band.inverse.points(&pixels, &mut sources);
                let sources = &sources;
                self.paint(band, area, |j| move |i| self.to_trace * sources[j * area.width + i]);
            }
        }
    }

    /// Paints at most a tile. `row` gives the source points of a row's pixels, scaled by `to_trace`.
    fn paint<Row: Fn(usize) -> Point>(&self, band: &mut ShadeBand<'_>, area: PixelArea, row: impl Fn(usize) -> Row) {
        let to_paint = self.to_trace.inverse();
        let (mut points, mut colors) = ([Point::ORIGIN; TILE], [[0.0; 4]; TILE]);
        for j in 0..area.height {
            let start = (area.top - band.top + j) * band.columns + area.left;
            let pixels = &mut band.pixels[start..start + area.width];
            let known = &mut band.known[start..start + area.width];
            let source = row(j);
            let (points, colors) = (&mut points[..area.width], &mut colors[..area.width]);
            for (i, point) in points.iter_mut().enumerate() {
                *point = to_paint * source(i);
            }
            (self.shade.colors)(points, colors);
            for (((pixel, known), point), color) in pixels.iter_mut().zip(known).zip(points).zip(colors) {
                if point.is_finite() {
                    // The cast saturates.
                    let [r, g, b, a] = color.map(|v| (v * 255.0 + 0.5) as u8);
                    *pixel = ColorU8::from_rgba(r, g, b, a).premultiply();
                    *known = true;
                }
            }
        }
    }
}

/// Fills pixels that were not painted with the colour of the nearest one in their row, or else of the nearest row.
fn extend(out: &mut Pixmap, known: &[bool]) {
    let width = out.width() as usize;
    let pixels = out.pixels_mut();
    let mut filled = Vec::with_capacity(known.len() / width);
    for (row, known) in pixels.chunks_mut(width).zip(known.chunks(width)) {
        let ends = known.iter().position(|k| *k).zip(known.iter().rposition(|k| *k));
        filled.push(ends.is_some());
        let Some((first, last)) = ends else { continue };
        for i in (0..first).rev() {
            row[i] = row[i + 1];
        }
        for i in first + 1..width {
            if i > last || !known[i] {
                row[i] = row[i - 1];
            }
        }
    }
    let (Some(first), Some(last)) = (filled.iter().position(|f| *f), filled.iter().rposition(|f| *f)) else { return };
    for j in (0..first).rev() {
        pixels.copy_within((j + 1) * width..(j + 2) * width, j * width);
    }
    for (j, filled) in filled.iter().enumerate().skip(first + 1) {
        if j > last || !filled {
            pixels.copy_within((j - 1) * width..j * width, j * width);
        }
    }
}

/// Side of a cell in pixels.
const CELL: usize = 8;
/// Tolerance of the polygon that stands for the shape, in pixels.
const FLATNESS: f64 = 0.25;
/// Distance from the shape, in pixels, up to which pixels are needed: renderers read up to two on either side of a point.
const MARGIN: f64 = 2.0 + FLATNESS;

/// The cells that a shape touches or comes near.
struct Cover {
    columns: usize,
    /// Row by row, `true` for these cells.
    cells: Vec<bool>,
}

impl Cover {
    /// `shown` maps the pixels of a picture of the given size to the shape's plane.
    fn new(shape: &BezPath, shown: Affine, (width, height): (u32, u32)) -> Self {
        let [columns, rows] = [width, height].map(|n| (n as usize).div_ceil(CELL));
        let mut cover = Self { columns, cells: vec![false; columns * rows] };
        let mut windings = vec![0_i32; columns * rows];
        boundary(&(shown.inverse() * shape), FLATNESS, |a, b| {
            cover.touch(a, b, rows);
            add_winding(a, b, &mut windings, columns);
        });
        // A cell without edges is all inside or all outside. This covers too much for shapes with the even-odd rule.
        for (cell, winding) in cover.cells.iter_mut().zip(windings) {
            *cell |= winding != 0;
        }
        cover
    }

    /// Shrinks an area of the picture to its visible cells. `None` if there are none.
    fn visible(&self, area: PixelArea) -> Option<PixelArea> {
        let cells = |start: usize, size: usize| start / CELL..(start + size).div_ceil(CELL);
        let (mut start, mut end) = ([usize::MAX; 2], [0; 2]);
        for j in cells(area.top, area.height) {
            for i in cells(area.left, area.width) {
                if self.cells.get(j * self.columns + i).is_none_or(|visible| *visible) {
                    start = [start[0].min(i), start[1].min(j)];
                    end = [end[0].max(i + 1), end[1].max(j + 1)];
                }
            }
        }
        let [left, top] = [start[0].saturating_mul(CELL).max(area.left), start[1].saturating_mul(CELL).max(area.top)];
        let [right, bottom] =
            [(end[0] * CELL).min(area.left + area.width), (end[1] * CELL).min(area.top + area.height)];
        (left < right && top < bottom).then(|| PixelArea { left, top, width: right - left, height: bottom - top })
    }

    /// Marks the cells near a line.
    fn touch(&mut self, a: Point, b: Point, rows: usize) {
        let pieces = (a.distance(b) / CELL as f64).ceil().clamp(1.0, (self.columns + rows) as f64) as usize;
        for k in 0..pieces {
            let point = |k: usize| a.lerp(b, k as f64 / pieces as f64);
            let near = Rect::from_points(point(k), point(k + 1)).inflate(MARGIN, MARGIN);
            let range = |start: f64, end: f64, cells: usize| {
                let cell = |v: f64| (v.max(0.0) / CELL as f64) as usize;
                if end < 0.0 { 0..0 } else { cell(start).min(cells)..(cell(end) + 1).min(cells) }
            };
            for j in range(near.y0, near.y1, rows) {
                for i in range(near.x0, near.x1, self.columns) {
                    self.cells[j * self.columns + i] = true;
                }
            }
        }
    }
}

/// Adds a line to the winding numbers of the middles of cells to its right.
fn add_winding(a: Point, b: Point, windings: &mut [i32], columns: usize) {
    let (top, bottom, direction) = if a.y < b.y { (a, b, 1) } else { (b, a, -1) };
    let slope = (bottom.x - top.x) / (bottom.y - top.y);
    // Index of the first cell whose middle is not before `v`.
    let first = |v: f64| (v / CELL as f64 - 0.5).ceil().max(0.0) as usize;
    for (j, row) in windings.chunks_mut(columns).enumerate().take(first(bottom.y)).skip(first(top.y)) {
        let y = (j as f64 + 0.5) * CELL as f64;
        row.iter_mut().skip(first(top.x + slope * (y - top.y))).for_each(|w| *w += direction);
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use kurbo::{Rect, Shape as _, Vec2};
    use pathwarp::map::{Formula, Jet, Real};

    /// A paint whose colours are computed point by point.
    pub(crate) fn each(color: impl Fn(Point) -> [f64; 4]) -> impl Fn(&[Point], &mut [[f64; 4]]) {
        move |points, out| out.iter_mut().zip(points).for_each(|(o, p)| *o = color(*p))
    }

    /// Two shears, whose inverse has a closed form.
    struct Shears;

    impl Formula for Shears {
        fn f<S: Real>(&self, x: S, y: S) -> (S, S) {
            let x = x + (y / 9.0).sin() * 2.0;
            (x, y + (x / 7.0).cos())
        }
    }

    fn back(q: Point) -> Point {
        let y = q.y - (q.x / 7.0).cos();
        Point::new(q.x - (y / 9.0).sin() * 2.0, y)
    }

    #[test]
    fn pixels_have_the_colour_of_their_source() {
        let (placed, area) = (Affine::new([2.0, 0.1, -0.3, 1.5, 4.0, -2.0]), Rect::new(3.0, -5.0, 20.0, 25.0));
        let color = |p: Point| {
            [(p.x / 20.0).sin().abs(), (p.y / 10.0).fract().abs(), 0.5, 0.25 + 0.5 * (p.x / 9.0).cos().abs()]
        };
        let inverse = GridInverse::new(&Shears, area, 1.0, placed, Affine::IDENTITY, 100.0);
        let shown = Affine::new([0.2, 0.0, 0.0, 0.25, 1.0, -3.0]);
        let picture =
            shade(&Shade { colors: &each(color), inverse: &inverse, shown, size: (150, 90), shape: None }).unwrap();
        let (mut outside, mut inside) = (0, 0);
        for (at, found) in picture.pixels().iter().enumerate() {
            let from = placed.inverse() * back(shown * Point::new((at % 150) as f64 + 0.5, (at / 150) as f64 + 0.5));
            if !area.contains(from) {
                outside += 1;
                continue;
            }
            inside += 1;
            let [r, g, b, a] = color(from);
            let found = [found.red(), found.green(), found.blue(), found.alpha()].map(f64::from);
            for (k, (w, f)) in [r * a, g * a, b * a, a].into_iter().zip(found).enumerate() {
                // The second channel jumps, and a point that is off by a hundredth of a pixel may cross the jump.
                let crosses = k == 1 && ((from.y / 10.0).fract().abs() - 0.5).abs() > 0.499;
                assert!((w * 255.0 - f).abs() <= 1.6 || crosses, "{k} at {from:?}: {w} {f}");
            }
        }
        assert!(outside > 500 && inside > 5000, "{outside} {inside}");
    }

    /// A map that is undefined for x < 3.
    struct Half;

    impl Map for Half {
        fn jet(&self, p: Point) -> Jet {
            if p.x < 3.0 { Jet::UNDEFINED } else { Jet { p, dx: Vec2::new(1.0, 0.0), dy: Vec2::new(0.0, 1.0) } }
        }
    }

    #[test]
    fn colours_continue_where_there_is_no_inverse() {
        let color = |p: Point| [p.x / 20.0, p.y / 20.0, 0.0, 1.0];
        let area = Rect::new(0.0, 0.0, 20.0, 20.0);
        let inverse = GridInverse::new(&Half, area, 1.0, Affine::IDENTITY, Affine::IDENTITY, 20.0);
        let picture = shade(&Shade {
            colors: &each(color),
            inverse: &inverse,
            shown: Affine::IDENTITY,
            size: (20, 20),
            shape: None,
        })
        .unwrap();
        for y in 0..20 {
            let first = picture.pixel(3, y).unwrap();
            assert_eq!((picture.pixel(0, y), picture.pixel(2, y)), (Some(first), Some(first)));
            assert!(first.green().abs_diff((255.0 * (f64::from(y) + 0.5) / 20.0) as u8) <= 1, "{y}");
        }
        let beyond = Shade {
            colors: &each(color),
            inverse: &inverse,
            shown: Affine::translate((500.0, 0.0)),
            size: (20, 20),
            shape: None,
        };
        assert_eq!(shade(&beyond), Err(Error::NoInverse));
    }

    /// By kurbo's winding numbers, no pixel within reach of one inside is left out.
    #[test]
    fn no_seen_pixel_is_left_out() {
        for (data, most) in [
            ("M200,20 C320,40 300,180 160,190 S20,60 200,20 Z M150,80 v40 h40 v-40 Z", 0.75),
            ("M10,10 L310,195 L300,199 L5,20 Z", 0.45),
            ("M5,5 H315 V195 H5 Z", 1.0),
        ] {
            let path = BezPath::from_svg(data).unwrap();
            let (shown, size) = (Affine::new([0.5, 0.0, 0.0, 0.5, 3.0, -2.0]), (640, 416));
            let path = Affine::translate((3.0, -2.0)) * path;
            let cover = Cover::new(&path, shown, size);
            let (mut covered, mut all) = (0, 0);
            for (j, i) in (0..size.1).flat_map(|j| (0..size.0).map(move |i| (j, i))) {
                let pixel = PixelArea { left: i as usize, top: j as usize, width: 1, height: 1 };
                let held = cover.visible(pixel).is_some();
                all += 1;
                covered += i32::from(held);
                let near = [(0.0, 0.0), (-2.0, -2.0), (2.0, -2.0), (-2.0, 2.0), (2.0, 2.0)];
                let seen = near.iter().any(|(x, y)| {
                    let pixel = Point::new(f64::from(i) + 0.5 + x, f64::from(j) + 0.5 + y);
                    path.winding(shown * pixel) != 0
                });
                assert!(held || !seen, "{data}: {i},{j}");
            }
            assert!(f64::from(covered) <= most * f64::from(all), "{data}: {covered} of {all}");
        }
    }
}
