//! Tiles of the result, and the part of a bitmap that each reads.

use super::trace::{ChebyshevBasis, SAMPLES, Trace};
use kurbo::{Affine, Point, Rect};
use pathwarp::map::Map;

/// Side of a tile in pixels, such that its part of the source fits into the cache.
pub(super) const TILE: usize = 32;
/// Side of the smallest tiles. If the inverse is not close to a cubic even there, it is evaluated for every pixel.
pub(super) const MIN_TILE: usize = 8;

/// A rectangle of pixels of the result.
#[derive(Clone, Copy)]
pub(super) struct PixelArea {
    pub(super) left: usize,
    pub(super) top: usize,
    pub(super) width: usize,
    pub(super) height: usize,
}

impl PixelArea {
    /// The four quarters, without empty ones.
    pub(super) fn quarters(self) -> impl Iterator<Item = Self> {
        let (w, h) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let quarter = move |k: usize| {
            let (right, low) = (k % 2, k / 2);
            Self {
                left: self.left + right * w,
                top: self.top + low * h,
                width: if right == 0 { w } else { self.width - w },
                height: if low == 0 { h } else { self.height - h },
            }
        };
        (0..4).map(quarter).filter(|a| a.width > 0 && a.height > 0)
    }

    /// Divides the area into parts no larger than a tile.
    pub(super) fn tiles(self) -> impl Iterator<Item = Self> {
        let (right, bottom) = (self.left + self.width, self.top + self.height);
        let corners = (self.top..bottom)
            .step_by(TILE)
            .flat_map(move |top| (self.left..right).step_by(TILE).map(move |left| (left, top)));
        corners.map(move |(left, top)| {
            let (width, height) = (TILE.min(right - left), TILE.min(bottom - top));
            Self { left, top, width, height }
        })
    }

    /// The box in the plane that the pixels cover.
    pub(super) fn covered(self, shown: Affine) -> Rect {
        let (left, top) = (self.left as f64, self.top as f64);
        shown.transform_rect_bbox(Rect::new(left, top, left + self.width as f64, top + self.height as f64))
    }

    /// Approximates the source points of the pixels by a polynomial; `None` if that is not accurate. `shown` maps pixels to the plane,
    /// `inverse` maps the plane back, and `then` leads from there to the coordinates in which source points are measured.
    pub(super) fn trace(self, basis: &ChebyshevBasis, shown: Affine, inverse: &dyn Map, then: Affine) -> Option<Trace> {
        let mut values = [Point::ORIGIN; SAMPLES];
        inverse.points(&self.samples(basis, shown), &mut values);
        for value in &mut values {
            *value = then * *value;
        }
        basis.interpolate(&values, self.span())
    }

    /// The distance between the centres of the first and the last column and row; 1 for a single one, so that there is a
    /// derivative.
    fn span(self) -> (f64, f64) {
        ((self.width - 1).max(1) as f64, (self.height - 1).max(1) as f64)
    }

    /// The points at which a trace samples the inverse.
    fn samples(self, basis: &ChebyshevBasis, shown: Affine) -> [Point; SAMPLES] {
        let (size, left, top) = (self.span(), self.left as f64 + 0.5, self.top as f64 + 0.5);
        let mut samples = [Point::ORIGIN; SAMPLES];
        for (sample, (u, v)) in samples.iter_mut().zip(basis.sample_points()) {
            *sample = shown * Point::new(left + u * size.0, top + v * size.1);
        }
        samples
    }

    /// The centres of the pixels in the plane, row by row.
    pub(super) fn pixels(self, shown: Affine) -> impl Iterator<Item = Point> {
        let centre = move |k: usize| {
            let (i, j) = (self.left + (k % self.width), self.top + (k / self.width));
            shown * Point::new(i as f64 + 0.5, j as f64 + 0.5)
        };
        (0..self.width * self.height).map(centre)
    }
}

/// Prepares `inverse`, a cache, for the traces of `areas` and of their parts, one size after the other; traces need no jets. Calls
/// `announce_pixels` with the pixels of the smallest parts that cannot be traced.
pub(super) fn announce(
    mut areas: Vec<PixelArea>,
    basis: &ChebyshevBasis,
    (shown, then): (Affine, Affine),
    inverse: &dyn Map,
    announce_pixels: impl Fn(&[Point]),
) {
    while !areas.is_empty() {
        let samples: Vec<Point> = areas.iter().flat_map(|a| a.samples(basis, shown)).collect();
        inverse.prepare(&samples, &[]);
        areas.retain(|a| a.trace(basis, shown, inverse, then).is_none());
        let (divided, smallest): (Vec<_>, Vec<_>) = areas.into_iter().partition(|a| a.width.max(a.height) > MIN_TILE);
        announce_pixels(&smallest.iter().flat_map(|a| a.pixels(shown)).collect::<Vec<_>>());
        areas = divided.into_iter().flat_map(PixelArea::quarters).collect();
    }
}

/// Bytes and channels per pixel.
pub(super) const BYTES: usize = 4;
/// Largest side of a block in pixels.
const MAX_BLOCK: usize = 160;
/// Sample points along a side of a tile for finding its part of the source.
const PER_SIDE: usize = 5;

#[derive(Clone, Copy)]
pub(super) struct BitmapBytes<'a> {
    pub(super) data: &'a [u8],
    pub(super) width: usize,
    pub(super) height: usize,
}

/// Memory layout of the rows of a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ChannelOrder {
    /// Pixel by pixel.
    Interleaved,
    /// Channel by channel within each row.
    Planar,
}

/// A part of a bitmap.
#[derive(Debug, Default)]
pub(super) struct SourceBlock {
    /// The channels of the pixels, 0 to 255, row by row.
    values: Vec<f32>,
    /// First column and row.
    pub(super) corner: [usize; 2],
    /// Number of columns and of rows.
    size: [usize; 2],
}

impl SourceBlock {
    /// Reads the pixels that a tile needs: its source points and `margin` pixels around them. Returns `false` if these are none or too
    /// many.
    #[inline(always)]
    pub(super) fn read(&mut self, source: BitmapBytes<'_>, trace: &Trace, margin: f64, layout: ChannelOrder) -> bool {
        let share = |k: usize| k as f64 / (PER_SIDE - 1) as f64;
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for k in 0..PER_SIDE * PER_SIDE {
            let p = trace.jet_at(share(k % PER_SIDE), share(k / PER_SIDE)).p;
            low = [low[0].min(p.x), low[1].min(p.y)];
            high = [high[0].max(p.x), high[1].max(p.y)];
        }
        for (axis, size) in [source.width, source.height].into_iter().enumerate() {
            let start = (low[axis] - margin).floor().clamp(0.0, size as f64);
            let end = (high[axis] + margin).ceil().clamp(start, size as f64);
            (self.corner[axis], self.size[axis]) = (start as usize, (end - start) as usize);
        }
        let [width, height] = self.size;
        if width == 0 || height == 0 || width > MAX_BLOCK || height > MAX_BLOCK {
            return false;
        }
        self.values.resize(width * height * BYTES, 0.0);
        let rows = self.values.chunks_exact_mut(width * BYTES).zip(self.corner[1]..);
        for (values, row) in rows {
            let bytes = &source.data[(row * source.width + self.corner[0]) * BYTES..][..width * BYTES];
            match layout {
                ChannelOrder::Interleaved => {
                    for (value, byte) in values.iter_mut().zip(bytes) {
                        *value = f32::from(*byte);
                    }
                }
                ChannelOrder::Planar => {
                    for (c, channel) in values.chunks_exact_mut(width).enumerate() {
                        for (value, pixel) in channel.iter_mut().zip(bytes.as_chunks::<BYTES>().0) {
                            *value = f32::from(pixel[c]);
                        }
                    }
                }
            }
        }
        true
    }

    /// Returns the index of the upper left of `side` × `side` pixels at each `left`, `top` from the corner, or [`OUTSIDE`] if they are not
    /// all in the block.
    #[inline(always)]
    pub(super) fn firsts(&self, left: &[f32; TILE], top: &[f32; TILE], side: usize, layout: ChannelOrder) -> Firsts {
        // A whole number (as `left` and `top` are) that is added to this one is found in the low bits of the float.
        const WHOLE: f32 = (1_u32 << 23) as f32;
        let [max_left, max_top] = self.size.map(|n| n as f32 - side as f32);
        let stride = (self.size[0] * BYTES) as u32;
        let step = if layout == ChannelOrder::Interleaved { BYTES as u32 } else { 1 };
        let mut out = [0; TILE];
        for i in 0..TILE {
            let whole = |v: f32| (v + WHOLE).to_bits() & 0xFFFF;
            let inside = (left[i] >= 0.0) & (top[i] >= 0.0) & (left[i] <= max_left) & (top[i] <= max_top);
            let first = whole(top[i]) * stride + whole(left[i]) * step;
            out[i] = if inside { first } else { OUTSIDE };
        }
        out
    }

    /// Returns the values from an index on, and the number of values per row.
    #[inline(always)]
    pub(super) fn values_from(&self, first: u32) -> Option<(&[f32], usize)> {
        self.values.get(first as usize..).map(|v| (v, self.size[0] * BYTES))
    }
}

/// Indices into a [`SourceBlock`] for a row of a tile.
pub(super) type Firsts = [u32; TILE];

/// Marks pixels outside the block.
pub(super) const OUTSIDE: u32 = u32::MAX;
