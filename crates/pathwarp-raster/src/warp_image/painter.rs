//! Warps a bitmap tile by tile.

use super::image_warp::{ImageWarp, composed};
use super::rows::{self, TileMethod};
use super::sample::{self, Pyramid};
use super::tile::{BYTES, BitmapBytes, MIN_TILE, PixelArea, SourceBlock, TILE, announce};
use super::trace::{ChebyshevBasis, Trace};
use crate::error::Error;
use crate::pixmap::{bytes, for_each_chunk, new_pixmap};
use kurbo::{Affine, Point, Rect, Vec2};
use pathwarp::budget::Limits;
use pathwarp::engine::{Batches, Gathered};
use pathwarp::map::{Creases, Jet, Map};
use tiny_skia::Pixmap;

/// Warps a bitmap.
///
/// # Errors
/// [`Error::Empty`] and [`Error::TooLarge`] for impossible sizes of the result.
pub fn warp_image(warp: &ImageWarp<'_>) -> Result<Pixmap, Error> {
    let (width, height) = warp.size;
    // The limit on a result grows with its input, here the source.
    let limits = Limits::default().for_input(warp.source.data().len());
    let (width_px, height_px) = (f64::from(width), f64::from(height));
    let mut out = new_pixmap(width_px, height_px, &limits.for_pixels(width_px * height_px))?;
    let touched_tiles = TouchedTiles::new(warp);
    let painter = ImagePainter {
        warp,
        to_source: warp.placed.inverse(),
        pyramid: Pyramid::new(warp.source),
        bitmap: BitmapBytes {
            data: warp.source.data(),
            width: warp.source.width() as usize,
            height: warp.source.height() as usize,
        },
        basis: ChebyshevBasis::new(),
        arch: pulp::Arch::new(),
    };
    let columns = width as usize;
    for_each_chunk(out.data_mut(), columns * BYTES * TILE, |band, rows| {
        let (top, height) = (band * TILE, rows.len() / (columns * BYTES));
        let touched = (0..columns).step_by(TILE).filter(|left| touched_tiles.contain(left / TILE, band));
        let tile = |left: usize| PixelArea { left, top, width: TILE.min(columns - left), height };
        let tiles: Vec<PixelArea> = touched.map(tile).collect();
        let cache = warp.inverse.prefers_batches().then(|| painter.cache(tiles.clone()));
        let inverse = cache.as_ref().map_or(warp.inverse, |cache| cache as &dyn Map);
        let mut band = ImageBand { top, stride: columns * BYTES, rows, block: SourceBlock::default(), inverse };
        tiles.into_iter().for_each(|tile| painter.tile(&mut band, tile));
    });
    Ok(out)
}

/// A band of whole rows of the result.
struct ImageBand<'a> {
    /// The first row.
    top: usize,
    /// Bytes per row.
    stride: usize,
    rows: &'a mut [u8],
    /// The part of the source that a tile reads. The next tile reuses the memory.
    block: SourceBlock,
    /// The inverse, or a cache of it.
    inverse: &'a dyn Map,
}

impl ImageBand<'_> {
    /// The bytes of row `j` of an area.
    #[inline(always)]
    fn row(&mut self, area: PixelArea, j: usize) -> &mut [u8] {
        &mut self.rows[(area.top - self.top + j) * self.stride + area.left * BYTES..][..area.width * BYTES]
    }
}

/// Data shared by all tiles.
struct ImagePainter<'a> {
    warp: &'a ImageWarp<'a>,
    to_source: Affine,
    pyramid: Pyramid<'a>,
    bitmap: BitmapBytes<'a>,
    basis: ChebyshevBasis,
    arch: pulp::Arch,
}

impl<'a> ImagePainter<'a> {
    /// Caches the values of the inverse for these tiles, computed in batches.
    fn cache(&self, tiles: Vec<PixelArea>) -> Gathered<'a> {
        let cache = Gathered::new(self.warp.inverse);
        announce(tiles, &self.basis, (self.warp.shown, self.to_source), &cache, |pixels| cache.prepare(&[], pixels));
        cache
    }

    /// Paints a tile, dividing it until the inverse is close to a cubic.
    fn tile(&self, band: &mut ImageBand<'_>, area: PixelArea) {
        match area.trace(&self.basis, self.warp.shown, band.inverse, self.to_source) {
            Some(trace) => self.arch.dispatch(TracedTile { painter: self, band, area, trace }),
            None if area.width.max(area.height) > MIN_TILE => {
                area.quarters().for_each(|quarter| self.tile(band, quarter));
            }
            None => self.each_pixel(band, area),
        }
    }

    /// Paints a small tile, evaluating the inverse for every pixel.
    fn each_pixel(&self, band: &mut ImageBand<'_>, area: PixelArea) {
        let centre = |i: isize, j: isize| {
            self.warp.shown * Point::new(area.left as f64 + i as f64 + 0.5, area.top as f64 + j as f64 + 0.5)
        };
        // From pixels of the result to pixels of the source.
        let between_pixels = |jet: &Jet| composed(jet, self.to_source, self.warp.shown);
        let mut centres = [Point::ORIGIN; MIN_TILE];
        let mut jets = [[Jet::default(); MIN_TILE]; MIN_TILE];
        for (j, row) in jets[..area.height].iter_mut().enumerate() {
            for (i, p) in centres[..area.width].iter_mut().enumerate() {
                *p = centre(i as isize, j as isize);
            }
            band.inverse.jets(&centres[..area.width], &mut row[..area.width]);
            for jet in &mut row[..area.width] {
                *jet = between_pixels(jet);
            }
        }
        let inverse = band.inverse;
        let jet_at = |i: isize, j: isize| {
            let in_tile = usize::try_from(i).ok().zip(usize::try_from(j).ok());
            match in_tile.filter(|(i, j)| *i < area.width && *j < area.height) {
                Some((i, j)) => jets[j][i],
                None => between_pixels(&inverse.jet(centre(i, j))),
            }
        };
        for (j, row) in jets.iter().enumerate().take(area.height) {
            for (pixel, (i, jet)) in band.row(area, j).as_chunks_mut().0.iter_mut().zip(row.iter().enumerate()) {
                let jet = Some(*jet)
                    .filter(|jet| jet.p.is_finite())
                    .or_else(|| extrapolated(self.warp.source, |di, dj| jet_at(i as isize + di, j as isize + dj)));
                if let Some(jet) = jet {
                    *pixel = bytes(sample::pixel(&self.pyramid, &jet));
                }
            }
        }
    }
}

/// A tile with a polynomial for the source points of its pixels. It is a type rather than a closure because compiling all of it for the
/// available vector unit depends on inlining.
struct TracedTile<'a, 'b> {
    painter: &'a ImagePainter<'a>,
    band: &'a mut ImageBand<'b>,
    area: PixelArea,
    trace: Trace,
}

impl pulp::WithSimd for TracedTile<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { painter, band, area, trace } = self;
        let mut method = TileMethod::choose(&trace);
        let mut block = std::mem::take(&mut band.block);
        if !matches!(method, TileMethod::Each) && !block.read(painter.bitmap, &trace, method.margin(), method.layout())
        {
            method = TileMethod::Each;
        }
        for j in 0..area.height {
            let row = trace.pixels(j);
            let out = band.row(area, j);
            let single = |i: usize| bytes(sample::pixel(&painter.pyramid, &trace.pixel(i, j)));
            match method {
                TileMethod::Interpolated => rows::interpolated(&block, &row, out, single),
                TileMethod::Stretched => rows::stretched(&block, &row, out, single),
                TileMethod::Skewed(shapes) => {
                    let size = [(area.width - 1).max(1) as f32, (area.height - 1).max(1) as f32];
                    rows::skewed(&block, &row, shapes.row(j as f32, size), out, single);
                }
                TileMethod::Each => {
                    for (i, pixel) in out.as_chunks_mut().0.iter_mut().enumerate() {
                        *pixel = single(i);
                    }
                }
            }
        }
        band.block = block;
    }
}

/// Extrapolates the jet of a neighbour to a pixel whose centre has no inverse, as is common outside the source. Returns it if its point
/// is outside the source, so that pixels along the edge are antialiased.
fn extrapolated(source: &Pixmap, neighbour: impl Fn(isize, isize) -> Jet) -> Option<Jet> {
    let (width, height) = (f64::from(source.width()), f64::from(source.height()));
    [(1, 0), (-1, 0), (0, 1), (0, -1)].into_iter().find_map(|(di, dj)| {
        let jet = neighbour(di, dj);
        let p = jet.p - jet.push(Vec2::new(di as f64, dj as f64));
        let is_outside = p.x < 0.0 || p.y < 0.0 || p.x > width || p.y > height;
        is_outside.then_some(Jet { p, ..jet })
    })
}

/// Largest number of cells along a side of the source, and the least pixels of the result along a side of a cell.
const MAX_CELLS: usize = 192;
const MIN_CELL: usize = 2;

/// The tiles of the result that the warped source touches. The inverse must not be evaluated in other tiles, where it may have values,
/// too: a projective inverse also maps points beyond the horizon.
struct TouchedTiles {
    touched: Vec<bool>,
    columns: usize,
}

impl TouchedTiles {
    fn new(warp: &ImageWarp<'_>) -> Self {
        let [columns, rows] = [warp.size.0, warp.size.1].map(|side| (side as usize).div_ceil(TILE));
        let mut out = Self { touched: vec![false; columns * rows], columns };
        for pair in corner_images(warp).windows(2) {
            for i in 0..pair[0].len() - 1 {
                out.touch([pair[0][i], pair[0][i + 1], pair[1][i], pair[1][i + 1]], rows);
            }
        }
        out
    }

    /// Marks the tiles around the image of a cell. If some of its corners have no image, its neighbours cover most of it.
    fn touch(&mut self, cell: [Point; 4], rows: usize) {
        let mut defined = cell.into_iter().filter(|p| p.is_finite());
        let Some(first) = defined.next() else { return };
        let b = defined.fold(Rect::from_points(first, first), |b, p| b.union_pt(p));
        // Allow for curved sides and for partly covered pixels at the edge.
        let b = b.inflate(2.0 + 0.5 * b.width(), 2.0 + 0.5 * b.height());
        let index = |v: f64, max: usize| ((v / TILE as f64).max(0.0) as usize).min(max);
        if b.x1 < 0.0 || b.y1 < 0.0 || b.x0 > (self.columns * TILE) as f64 || b.y0 > (rows * TILE) as f64 {
            return;
        }
        for row in index(b.y0, rows - 1)..=index(b.y1, rows - 1) {
            let columns = index(b.x0, self.columns - 1)..=index(b.x1, self.columns - 1);
            self.touched[row * self.columns..][columns].fill(true);
        }
    }

    fn contain(&self, column: usize, row: usize) -> bool {
        self.touched[row * self.columns + column]
    }
}

/// Maps the corners of a grid over the source to pixels of the result, row by row.
fn corner_images(warp: &ImageWarp<'_>) -> Vec<Vec<Point>> {
    let &ImageWarp { source, placed, map, size, .. } = warp;
    let cells = (size.0.max(size.1) as usize / MIN_CELL).clamp(1, MAX_CELLS);
    let (width, height) = (f64::from(source.width()), f64::from(source.height()));
    let to_target = warp.shown.inverse();
    let mut creases = Creases::default();
    map.creases(&mut creases);
    let row = |j: usize| {
        let v = height * j as f64 / cells as f64;
        let points: Vec<Point> = (0..=cells).map(|i| placed * Point::new(width * i as f64 / cells as f64, v)).collect();
        let mut out = vec![Point::ORIGIN; points.len()];
        map.points(&points, &mut out);
        let image = |(p, q): (&Point, Point)| {
            if creases.defined_at(*p) { to_target * q } else { Point::new(f64::NAN, f64::NAN) }
        };
        points.iter().zip(out).map(image).collect()
    };
    (0..=cells).map(row).collect()
}
