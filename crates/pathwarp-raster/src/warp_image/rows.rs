//! A tile's pixels, row by row, in the form that the compiler turns into vector instructions. The vector unit's width changes
//! nothing in the results: every pixel's sums are taken in the same order.

use super::TILE;
use super::sample::Footprint;
use super::trace::{Row, Trace};
use kurbo::Point;

/// Up to this stretch, and with no more than [`MOST_SKEW`], eight pixels a side hold the kernel.
const MOST_STRETCH: f64 = 1.75;
/// The off-diagonal entry of the footprint's matrix that does without: the kernel is then stretched along the picture's own
/// axes.
const MOST_SKEW: f64 = 0.1;
/// Places along a side of a tile where the stretch is looked at.
const LOOKS: usize = 5;
/// Bytes of a pixel.
pub(super) const BYTES: usize = 4;

/// A bitmap's bytes.
#[derive(Clone, Copy)]
pub(super) struct Bytes<'a> {
    pub(super) data: &'a [u8],
    pub(super) width: usize,
    pub(super) height: usize,
}

/// How a tile's pixels are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// Nothing shrinks: four pixels a side.
    Between,
    /// A little shrinks: up to eight.
    Stretched,
    /// Each pixel by itself.
    Each,
}

impl Way {
    pub(super) fn of(trace: &Trace) -> Self {
        let share = |k: usize| k as f64 / (LOOKS - 1) as f64;
        let mut way = Self::Between;
        for k in 0..LOOKS * LOOKS {
            let jet = trace.at(share(k % LOOKS), share(k / LOOKS));
            let Some(footprint) = Footprint::new(&jet) else { continue };
            if footprint.longest > MOST_STRETCH || footprint.skew() > MOST_SKEW {
                return Self::Each;
            }
            way = Self::Stretched;
        }
        way
    }
}

/// The places of a row's pixels, from a pixel of the source near them.
struct Places {
    /// That pixel's column and row.
    base: [f64; 2],
    x: [f32; TILE],
    y: [f32; TILE],
}

#[inline(always)]
fn cubic(c: [f32; 4]) -> [f32; TILE] {
    let mut out = [0.0; TILE];
    for (i, o) in out.iter_mut().enumerate() {
        let u = i as f32;
        *o = ((c[3] * u + c[2]) * u + c[1]) * u + c[0];
    }
    out
}

impl Places {
    /// `near`: some place of the tile.
    #[inline(always)]
    fn new(row: &Row, near: Point) -> Self {
        let base = [near.x.floor(), near.y.floor()];
        // Pixels count from their middles.
        Self { base, x: cubic(row.place(0, base[0] + 0.5)), y: cubic(row.place(1, base[1] + 0.5)) }
    }

    /// Which byte of the source the block of `side` × `side` pixels begins with whose first one is `left`, `top` from the
    /// base; none if it is not all in the source.
    #[inline(always)]
    fn block(&self, source: Bytes<'_>, left: f32, top: f32, side: usize) -> Option<usize> {
        let (x, y) = (f64::from(left) + self.base[0], f64::from(top) + self.base[1]);
        let inside =
            x >= 0.0 && y >= 0.0 && x <= source.width as f64 - side as f64 && y <= source.height as f64 - side as f64;
        inside.then(|| (y as usize * source.width + x as usize) * BYTES)
    }
}

/// Makes the row's pixels that can be made fast; calls `other` for the others.
#[inline(always)]
pub(super) fn between(
    source: Bytes<'_>,
    row: &Row,
    near: Point,
    out: &mut [u8],
    mut other: impl FnMut(usize) -> [u8; BYTES],
) {
    const SIDE: usize = 4;
    let places = Places::new(row, near);
    for (i, pixel) in out.as_chunks_mut::<BYTES>().0.iter_mut().enumerate().take(TILE) {
        let (x, y) = (places.x[i], places.y[i]);
        let (left, top) = (x.floor(), y.floor());
        let block = places.block(source, left - 1.0, top - 1.0, SIDE);
        *pixel = match block {
            Some(at) => {
                let sums = columns::<{ SIDE * BYTES }>(source, at, &weights(y - top));
                color(across(&sums, &weights(x - left)))
            }
            None => other(i),
        };
    }
}

/// The same with the kernel stretched.
#[inline(always)]
pub(super) fn stretched(
    source: Bytes<'_>,
    row: &Row,
    near: Point,
    out: &mut [u8],
    mut other: impl FnMut(usize) -> [u8; BYTES],
) {
    const SIDE: usize = 8;
    let places = Places::new(row, near);
    let stretch = [stretches(row, 0), stretches(row, 1)];
    for (i, pixel) in out.as_chunks_mut::<BYTES>().0.iter_mut().enumerate().take(TILE) {
        let (x, y) = (places.x[i], places.y[i]);
        let (left, top) = ((x - 2.0 * stretch[0][i]).ceil(), (y - 2.0 * stretch[1][i]).ceil());
        *pixel = match places.block(source, left, top, SIDE) {
            Some(at) => {
                let (wx, wy) = (kernel(left - x, stretch[0][i]), kernel(top - y, stretch[1][i]));
                let used = ((y + 2.0 * stretch[1][i] - top) as usize + 1).min(SIDE);
                let sums = columns::<{ SIDE * BYTES }>(source, at, &wy[..used]);
                let scale = 1.0 / (wx.iter().sum::<f32>() * wy.iter().sum::<f32>());
                color(across(&sums, &wx).map(|v| v * scale))
            }
            None => other(i),
        };
    }
}

/// How many pixels of the source a pixel of the row covers along one coordinate, at least one.
#[inline(always)]
fn stretches(row: &Row, coordinate: usize) -> [f32; TILE] {
    let c = row.place(coordinate, 0.0);
    let (along, down) = (cubic([c[1], 2.0 * c[2], 3.0 * c[3], 0.0]), cubic(row.down(coordinate)));
    let mut out = [0.0; TILE];
    for (o, (a, b)) in out.iter_mut().zip(along.iter().zip(&down)) {
        // Tiles with more are not made this way.
        *o = (a * a + b * b).sqrt().clamp(1.0, MOST_STRETCH as f32);
    }
    out
}

/// Catmull and Rom's weights of the four pixels around a place that lies `t` behind the second.
#[inline(always)]
fn weights(t: f32) -> [f32; 4] {
    const CUBED: [f32; 4] = [-0.5, 1.5, -1.5, 0.5];
    const SQUARED: [f32; 4] = [1.0, -2.5, 2.0, -0.5];
    const ONCE: [f32; 4] = [-0.5, 0.0, 0.5, 0.0];
    const ALONE: [f32; 4] = [0.0, 1.0, 0.0, 0.0];
    let mut out = [0.0; 4];
    for k in 0..4 {
        out[k] = ((CUBED[k] * t + SQUARED[k]) * t + ONCE[k]) * t + ALONE[k];
    }
    out
}

/// Their stretched weights of the eight pixels from `first` on.
#[inline(always)]
fn kernel(first: f32, stretch: f32) -> [f32; 8] {
    let per = 1.0 / stretch;
    let mut out = [0.0; 8];
    for (k, w) in out.iter_mut().enumerate() {
        let t = ((first + k as f32) * per).abs();
        let inner = (1.5 * t - 2.5) * t * t + 1.0;
        let outer = ((2.5 - 0.5 * t) * t - 4.0) * t + 2.0;
        *w = if t < 1.0 {
            inner
        } else if t < 2.0 {
            outer
        } else {
            0.0
        };
    }
    out
}

/// Sums of rows of `N` bytes, from byte `at` on.
#[inline(always)]
fn columns<const N: usize>(source: Bytes<'_>, at: usize, weights: &[f32]) -> [f32; N] {
    let mut sums = [0.0; N];
    for (row, weight) in weights.iter().enumerate() {
        // Always there: the block is in the source.
        let Some(bytes) = source.data.get(at + row * source.width * BYTES..).and_then(<[u8]>::first_chunk::<N>) else {
            break;
        };
        for (sum, byte) in sums.iter_mut().zip(bytes) {
            *sum += weight * f32::from(*byte);
        }
    }
    sums
}

/// The sum over the columns.
#[inline(always)]
fn across(sums: &[f32], weights: &[f32]) -> [f32; BYTES] {
    let mut out = [0.0; BYTES];
    for (pixel, weight) in sums.as_chunks::<BYTES>().0.iter().zip(weights) {
        for (o, s) in out.iter_mut().zip(pixel) {
            *o += weight * s;
        }
    }
    out
}

/// The nearest colour there is, as [`super::color`].
#[inline(always)]
fn color(c: [f32; BYTES]) -> [u8; BYTES] {
    let alpha = (c[3] + 0.5).clamp(0.0, 255.0).floor();
    let mut out = [0; BYTES];
    for (o, v) in out.iter_mut().zip(c) {
        *o = (v + 0.5).clamp(0.0, alpha) as u8;
    }
    out[3] = alpha as u8;
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unstretched_the_kernel_is_the_weights() {
        for t in [0.0, 0.25, 0.5, 0.875] {
            // The block begins two pixels before the place.
            let first = (-2.0_f32).ceil() - t + if t > 0.0 { 1.0 } else { 0.0 };
            let (w, k) = (weights(t), kernel(first, 1.0));
            let skipped = if t > 0.0 { 0 } else { 1 };
            for (a, b) in w.iter().zip(&k[skipped..]) {
                assert!((a - b).abs() < 1e-6, "{t}: {w:?} {k:?}");
            }
            assert!((k.iter().sum::<f32>() - 1.0).abs() < 1e-6);
        }
    }
}
