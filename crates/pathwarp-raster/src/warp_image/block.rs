//! The part of a bitmap that a tile reads, in floating point: every pixel is read a dozen times.

use super::TILE;
use super::trace::Trace;

/// Bytes of a pixel, and its channels.
pub(super) const BYTES: usize = 4;
/// The largest part, in pixels a side.
const MOST: usize = 160;
/// Places along a side of a tile that are looked at to find its part of the source.
const LOOKS: usize = 5;

/// A bitmap's bytes.
#[derive(Clone, Copy)]
pub(super) struct Bytes<'a> {
    pub(super) data: &'a [u8],
    pub(super) width: usize,
    pub(super) height: usize,
}

/// How a block's rows lie in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Layout {
    /// Pixel by pixel.
    Pixels,
    /// Channel by channel, each of them a row.
    Channels,
}

/// A part of a bitmap.
#[derive(Debug, Default)]
pub(super) struct Block {
    values: Vec<f32>,
    /// The first column and row.
    pub(super) corner: [usize; 2],
    size: [usize; 2],
}

impl Block {
    /// Reads what a tile needs: its places and `margin` pixels around them. Whether there is anything, and not too much.
    #[inline(always)]
    pub(super) fn read(&mut self, source: Bytes<'_>, trace: &Trace, margin: f64, layout: Layout) -> bool {
        let share = |k: usize| k as f64 / (LOOKS - 1) as f64;
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for k in 0..LOOKS * LOOKS {
            let p = trace.at(share(k % LOOKS), share(k / LOOKS)).p;
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
                Layout::Pixels => {
                    for (value, byte) in to.iter_mut().zip(from) {
                        *value = f32::from(*byte);
                    }
                }
                Layout::Channels => {
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

    /// Where the `side` × `side` pixels begin whose first ones are at `left`, `top` from the corner; [`OUTSIDE`] where they
    /// are not all in the block.
    #[inline(always)]
    pub(super) fn firsts(&self, left: &[f32; TILE], top: &[f32; TILE], side: usize, layout: Layout) -> Firsts {
        // The unit of a number's last bit at this size is 1: the low bits are the whole number that was added.
        const WHOLE: f32 = (1_u32 << 23) as f32;
        let [most_left, most_top] = self.size.map(|n| n as f32 - side as f32);
        let stride = (self.size[0] * BYTES) as u32;
        let step = if layout == Layout::Pixels { BYTES as u32 } else { 1 };
        let mut out = [0; TILE];
        for i in 0..TILE {
            let whole = |v: f32| (v + WHOLE).to_bits() & 0xFFFF;
            let inside = (left[i] >= 0.0) & (top[i] >= 0.0) & (left[i] <= most_left) & (top[i] <= most_top);
            let first = whole(top[i]) * stride + whole(left[i]) * step;
            out[i] = if inside { first } else { OUTSIDE };
        }
        out
    }

    /// The values from there on, and how many there are in a row.
    #[inline(always)]
    pub(super) fn from(&self, first: u32) -> Option<(&[f32], usize)> {
        self.values.get(first as usize..).map(|v| (v, self.size[0] * BYTES))
    }
}

/// Where pixels begin in a [`Block`], for a row of a tile.
pub(super) type Firsts = [u32; TILE];

/// Not in the block.
pub(super) const OUTSIDE: u32 = u32::MAX;
