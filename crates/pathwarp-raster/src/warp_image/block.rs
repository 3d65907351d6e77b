//! The part of a bitmap that a tile reads, converted to floating point once since every pixel is read a dozen times.

use super::area::TILE;
use super::trace::Trace;

/// Bytes and channels per pixel.
pub(super) const BYTES: usize = 4;
/// Maximum side of a block in pixels.
const MOST: usize = 160;
/// Sample points along a side of a tile for finding its part of the source.
const SAMPLES: usize = 5;

/// The bytes of a bitmap.
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
    values: Vec<f32>,
    /// First column and row.
    pub(super) corner: [usize; 2],
    size: [usize; 2],
}

impl SourceBlock {
    /// Reads the pixels that a tile needs: its places and `margin` pixels around them. Returns `false` if there are none or too many.
    #[inline(always)]
    pub(super) fn read(&mut self, source: BitmapBytes<'_>, trace: &Trace, margin: f64, layout: ChannelOrder) -> bool {
        let share = |k: usize| k as f64 / (SAMPLES - 1) as f64;
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for k in 0..SAMPLES * SAMPLES {
            let p = trace.at(share(k % SAMPLES), share(k / SAMPLES)).p;
            low = [low[0].min(p.x), low[1].min(p.y)];
            high = [high[0].max(p.x), high[1].max(p.y)];
        }
        for (k, most) in [source.width, source.height].into_iter().enumerate() {
            let from = (low[k] - margin).floor().clamp(0.0, most as f64);
            let to = (high[k] + margin).ceil().clamp(from, most as f64);
            (self.corner[k], self.size[k]) = (from as usize, (to - from) as usize);
        }
        let [width, height] = self.size;
        if width == 0 || height == 0 || width > MOST || height > MOST {
            return false;
        }
        self.values.resize(width * height * BYTES, 0.0);
        let rows = self.values.chunks_exact_mut(width * BYTES).zip(self.corner[1]..);
        for (to, row) in rows {
            let from = &source.data[(row * source.width + self.corner[0]) * BYTES..][..width * BYTES];
            match layout {
                ChannelOrder::Interleaved => {
                    for (value, byte) in to.iter_mut().zip(from) {
                        *value = f32::from(*byte);
                    }
                }
                ChannelOrder::Planar => {
                    for (c, channel) in to.chunks_exact_mut(width).enumerate() {
                        for (value, pixel) in channel.iter_mut().zip(from.as_chunks::<BYTES>().0) {
                            *value = f32::from(pixel[c]);
                        }
                    }
                }
            }
        }
        true
    }

    /// Returns the indices of the first of `side` × `side` pixels at `left`, `top` from the corner, or [`OUTSIDE`] if they are not all
    /// in the block.
    #[inline(always)]
    pub(super) fn firsts(&self, left: &[f32; TILE], top: &[f32; TILE], side: usize, layout: ChannelOrder) -> Firsts {
        // At this magnitude the last bit has the value 1, so the low bits hold the integer that was added.
        const WHOLE: f32 = (1_u32 << 23) as f32;
        let [most_left, most_top] = self.size.map(|n| n as f32 - side as f32);
        let stride = (self.size[0] * BYTES) as u32;
        let step = if layout == ChannelOrder::Interleaved { BYTES as u32 } else { 1 };
        let mut out = [0; TILE];
        for i in 0..TILE {
            let whole = |v: f32| (v + WHOLE).to_bits() & 0xFFFF;
            let inside = (left[i] >= 0.0) & (top[i] >= 0.0) & (left[i] <= most_left) & (top[i] <= most_top);
            let first = whole(top[i]) * stride + whole(left[i]) * step;
            out[i] = if inside { first } else { OUTSIDE };
        }
        out
    }

    /// Returns the values from an index on, and the number of values per row.
    #[inline(always)]
    pub(super) fn from(&self, first: u32) -> Option<(&[f32], usize)> {
        self.values.get(first as usize..).map(|v| (v, self.size[0] * BYTES))
    }
}

/// Indices into a [`SourceBlock`] for a row of a tile.
pub(super) type Firsts = [u32; TILE];

/// Marks pixels outside the block.
pub(super) const OUTSIDE: u32 = u32::MAX;
