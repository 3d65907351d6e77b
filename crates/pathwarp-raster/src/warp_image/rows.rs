//! Computes the pixels of a tile row by row, in loops that the compiler vectorizes. The order of summation for each pixel is fixed, so
//! results do not depend on the vector width.

use super::sample::Footprint;
use super::tile::{BYTES, ChannelOrder, Firsts, OUTSIDE, SourceBlock, TILE};
use super::trace::{Trace, TraceRow};

/// Maximum stretch at which a kernel of radius two fits into eight pixels a side.
const MAX_STRETCH: f64 = 1.99;
/// Off-diagonal entry of the footprint's matrix up to which the kernel is stretched along the axes of the picture.
const MAX_SKEW: f64 = 0.1;
/// Sample points of the stretch along a side of a tile.
const SAMPLES: usize = 5;

/// The method for the pixels of a tile.
#[derive(Debug, Clone, Copy)]
pub(super) enum TileMethod {
    /// Nothing shrinks: interpolate between four pixels a side.
    Interpolated,
    /// Slight shrinking along the axes of the picture: up to eight pixels a side.
    Stretched,
    /// Slight shrinking along other axes.
    Skewed(CornerShapes),
    /// Compute each pixel separately.
    Each,
}

/// The inverse of the footprint's matrix in the corners of a tile, left to right, top to bottom. It changes little in between.
#[derive(Debug, Clone, Copy)]
pub(super) struct CornerShapes([[[f32; 3]; 2]; 2]);

impl CornerShapes {
    fn new(trace: &Trace) -> Self {
        Self([0.0, 1.0].map(|v| [0.0, 1.0].map(|u| Footprint::inverse_matrix(&trace.jet_at(u, v)).map(|m| m as f32))))
    }

    /// Interpolates for row `j`: the entries in the first column, and their change from column to column.
    #[inline(always)]
    pub(super) fn row(&self, j: f32, area: [f32; 2]) -> [[f32; 3]; 2] {
        let between = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let [top, bottom] = self.0;
        let [left, right]: [[f32; 3]; 2] =
            std::array::from_fn(|side| std::array::from_fn(|k| between(top[side][k], bottom[side][k], j / area[1])));
        [left, std::array::from_fn(|k| (right[k] - left[k]) / area[0])]
    }
}

impl TileMethod {
    /// Reach of the kernels around the source points of a tile, in pixels.
    #[inline(always)]
    pub(super) fn margin(&self) -> f64 {
        match self {
            Self::Interpolated => 3.0,
            _ => 6.0,
        }
    }

    /// The memory layout that the method reads.
    #[inline(always)]
    pub(super) fn layout(&self) -> ChannelOrder {
        if matches!(self, Self::Skewed(_)) { ChannelOrder::Planar } else { ChannelOrder::Interleaved }
    }

    /// Chooses the method for a tile.
    pub(super) fn choose(trace: &Trace) -> Self {
        let share = |k: usize| k as f64 / (SAMPLES - 1) as f64;
        let (mut shrinks, mut skew) = (false, 0.0_f64);
        for k in 0..SAMPLES * SAMPLES {
            let jet = trace.jet_at(share(k % SAMPLES), share(k / SAMPLES));
            let Some(footprint) = Footprint::new(&jet) else { continue };
            let [sx, s, sy] = footprint.stretch();
            if sx.max(sy) + s.abs() > MAX_STRETCH {
                return Self::Each;
            }
            (shrinks, skew) = (true, skew.max(s.abs()));
        }
        match shrinks {
            false => Self::Interpolated,
            true if skew <= MAX_SKEW => Self::Stretched,
            true => Self::Skewed(CornerShapes::new(trace)),
        }
    }
}

/// The source points of the pixels of a row, measured from the centre of the first pixel of a block.
struct RowPoints {
    x: [f32; TILE],
    y: [f32; TILE],
}

impl RowPoints {
    #[inline(always)]
    fn new(row: &TraceRow, block: &SourceBlock) -> Self {
        let [x, y] = block.corner.map(|c| c as f64 + 0.5);
        Self { x: cubic(row.coordinate(0, x)), y: cubic(row.coordinate(1, y)) }
    }
}

/// Evaluates a cubic for every column.
#[inline(always)]
fn cubic(c: [f32; 4]) -> [f32; TILE] {
    let mut out = [0.0; TILE];
    for (i, o) in out.iter_mut().enumerate() {
        let u = i as f32;
        *o = ((c[3] * u + c[2]) * u + c[1]) * u + c[0];
    }
    out
}

/// The `SIDE` × `SIDE` pixels of the block that each pixel of a row reads: the index of the first, and the weights.
struct Taps<const SIDE: usize> {
    first: Firsts,
    x: [[f32; TILE]; SIDE],
    y: [[f32; TILE]; SIDE],
}

/// Interpolates the pixels of a row whose source is in the block, and calls `other` for the others.
#[inline(always)]
pub(super) fn interpolated(
    block: &SourceBlock,
    row: &TraceRow,
    out: &mut [u8],
    other: impl FnMut(usize) -> [u8; BYTES],
) {
    const SIDE: usize = 4;
    let RowPoints { x, y } = RowPoints::new(row, block);
    let (mut left, mut top) = ([0.0; TILE], [0.0; TILE]);
    let mut taps = Taps { first: [0; TILE], x: [[0.0; TILE]; SIDE], y: [[0.0; TILE]; SIDE] };
    for i in 0..TILE {
        let (a, b) = (x[i].floor(), y[i].floor());
        (left[i], top[i]) = (a - 1.0, b - 1.0);
        let (u, v) = (weights(x[i] - a), weights(y[i] - b));
        for k in 0..SIDE {
            taps.x[k][i] = u[k];
            taps.y[k][i] = v[k];
        }
    }
    taps.first = block.firsts(&left, &top, SIDE, ChannelOrder::Interleaved);
    paint::<SIDE, { SIDE * BYTES }>(block, &taps, out, other);
}

/// Filters a row with a kernel stretched along the axes of the picture. Calls `other` for pixels whose source is not in the block.
#[inline(always)]
pub(super) fn stretched(block: &SourceBlock, row: &TraceRow, out: &mut [u8], other: impl FnMut(usize) -> [u8; BYTES]) {
    const SIDE: usize = 8;
    let RowPoints { x, y } = RowPoints::new(row, block);
    let (left, wx) = kernels(&x, &stretches(row, 0));
    let (top, wy) = kernels(&y, &stretches(row, 1));
    let taps = Taps { first: block.firsts(&left, &top, SIDE, ChannelOrder::Interleaved), x: wx, y: wy };
    paint::<SIDE, { SIDE * BYTES }>(block, &taps, out, other);
}

#[inline(always)]
fn paint<const SIDE: usize, const N: usize>(
    block: &SourceBlock,
    taps: &Taps<SIDE>,
    out: &mut [u8],
    other: impl FnMut(usize) -> [u8; BYTES],
) {
    let mut colors = [[0.0; BYTES]; TILE];
    let n = out.len() / BYTES;
    for (i, color) in colors.iter_mut().enumerate().take(n) {
        let Some((mut values, stride)) = block.values_from(taps.first[i]) else { continue };
        let mut sums = [0.0; N];
        for j in 0..SIDE {
            let Some(pixels) = values.first_chunk::<N>() else { break };
            for k in 0..N {
                sums[k] += taps.y[j][i] * pixels[k];
            }
            values = values.get(stride..).unwrap_or_default();
        }
        for j in 0..SIDE {
            for c in 0..BYTES {
                color[c] += taps.x[j][i] * sums[BYTES * j + c];
            }
        }
    }
    finish(&colors, &taps.first, out, other);
}

/// Writes the colours of a row, rounded as [`super::sample::color`] does, and calls `other` for pixels outside the block.
#[inline(always)]
fn finish(colors: &[[f32; BYTES]; TILE], first: &Firsts, out: &mut [u8], mut other: impl FnMut(usize) -> [u8; BYTES]) {
    // At this magnitude the last bit has the value 1: adding it rounds and leaves an integer in the low bits.
    const WHOLE: f32 = (1_u32 << 23) as f32;
    let mut bytes = [[0; BYTES]; TILE];
    for (bytes, color) in bytes.iter_mut().zip(colors) {
        let alpha = min(max(color[3], 0.0), 255.0);
        for c in 0..BYTES {
            bytes[c] = (min(max(color[c], 0.0), alpha) + WHOLE).to_bits() as u8;
        }
    }
    for ((i, pixel), bytes) in out.as_chunks_mut::<BYTES>().0.iter_mut().enumerate().zip(bytes) {
        *pixel = if first[i] == OUTSIDE { other(i) } else { bytes };
    }
}

/// Filters a row with a kernel stretched along any axes, which [`CornerShapes::row`] gives. Calls `other` for pixels outside the block.
#[inline(always)]
pub(super) fn skewed(
    block: &SourceBlock,
    row: &TraceRow,
    shape: [[f32; 3]; 2],
    out: &mut [u8],
    other: impl FnMut(usize) -> [u8; BYTES],
) {
    const SIDE: usize = 8;
    const MAX: f32 = MAX_STRETCH as f32;
    let RowPoints { x, y } = RowPoints::new(row, block);
    let mut shapes = [[0.0; TILE]; 3];
    for (k, values) in shapes.iter_mut().enumerate() {
        for (i, v) in values.iter_mut().enumerate() {
            *v = shape[0][k] + shape[1][k] * i as f32;
        }
    }
    let (mut left, mut top, mut bottom) = ([0.0; TILE], [0.0; TILE], [0.0; TILE]);
    for i in 0..TILE {
        let [ix, k, iy] = [shapes[0][i], shapes[1][i], shapes[2][i]];
        let det = ix * iy - k * k;
        let (wide, high) = (2.0 * min((iy + k.abs()) / det, MAX), 2.0 * min((ix + k.abs()) / det, MAX));
        (left[i], top[i], bottom[i]) = ((x[i] - wide).ceil(), (y[i] - high).ceil(), y[i] + high);
    }
    let first = block.firsts(&left, &top, SIDE, ChannelOrder::Planar);
    let mut colors = [[0.0; BYTES]; TILE];
    let n = out.len() / BYTES;
    for (i, color) in colors.iter_mut().enumerate().take(n) {
        let Some((mut values, stride)) = block.values_from(first[i]) else { continue };
        let [ix, k, iy] = [shapes[0][i], shapes[1][i], shapes[2][i]];
        let (mut sums, mut totals) = ([[0.0; SIDE]; BYTES], [0.0; SIDE]);
        let mut line = top[i];
        while line <= bottom[i] {
            let dy = line - y[i];
            let (mut u, mut v) = ([0.0; SIDE], [0.0; SIDE]);
            for n in 0..SIDE {
                let dx = left[i] - x[i] + n as f32;
                u[n] = ix * dx + k * dy;
                v[n] = k * dx + iy * dy;
            }
            let mut weights = [0.0; SIDE];
            for n in 0..SIDE {
                weights[n] = catmull_rom(u[n]) * catmull_rom(v[n]);
                totals[n] += weights[n];
            }
            for (c, sums) in sums.iter_mut().enumerate() {
                let Some(channel) = values.get(c * stride / BYTES..).and_then(<[f32]>::first_chunk::<SIDE>) else {
                    break;
                };
                for n in 0..SIDE {
                    sums[n] += weights[n] * channel[n];
                }
            }
            values = values.get(stride..).unwrap_or_default();
            line += 1.0;
        }
        let scale = 1.0 / sum(&totals);
        for (a, s) in color.iter_mut().zip(&sums) {
            *a = sum(s) * scale;
        }
    }
    finish(&colors, &first, out, other);
}

/// The smaller of two numbers that are not NaN, in a single instruction.
#[inline(always)]
fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The larger of two numbers that are not NaN, in a single instruction.
#[inline(always)]
fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The sum, in an order that suits vector units.
#[inline(always)]
fn sum(v: &[f32; 8]) -> f32 {
    ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7]))
}

/// Source pixels per pixel of the row along one coordinate, at least one.
#[inline(always)]
fn stretches(row: &TraceRow, coordinate: usize) -> [f32; TILE] {
    let c = row.coordinate(coordinate, 0.0);
    let (along, down) = (cubic([c[1], 2.0 * c[2], 3.0 * c[3], 0.0]), cubic(row.down(coordinate)));
    let mut out = [0.0; TILE];
    for (o, (a, b)) in out.iter_mut().zip(along.iter().zip(&down)) {
        // Tiles with a larger stretch use another method.
        *o = min(max((a * a + b * b).sqrt(), 1.0), MAX_STRETCH as f32);
    }
    out
}

/// Catmull-Rom weights of the four pixels around a point at distance `t` after the second.
#[inline(always)]
fn weights(t: f32) -> [f32; 4] {
    // Coefficients of t³, t², t and 1.
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

/// Returns the first of the eight pixels under the stretched kernel at every point, and their weights, which sum to one.
#[inline(always)]
fn kernels(centres: &[f32; TILE], stretch: &[f32; TILE]) -> ([f32; TILE], [[f32; TILE]; 8]) {
    let (mut first, mut weights, mut total) = ([0.0; TILE], [[0.0; TILE]; 8], [0.0; TILE]);
    for i in 0..TILE {
        first[i] = (centres[i] - 2.0 * stretch[i]).ceil();
    }
    for (k, weights) in weights.iter_mut().enumerate() {
        for i in 0..TILE {
            weights[i] = catmull_rom((first[i] + k as f32 - centres[i]) / stretch[i]);
            total[i] += weights[i];
        }
    }
    for weights in &mut weights {
        for i in 0..TILE {
            weights[i] /= total[i];
        }
    }
    (first, weights)
}

/// The Catmull-Rom cubic without branches: its outer piece, which is zero at 2, plus the excess of the inner piece,
/// (1 − t)²(2t − 1).
#[inline(always)]
fn catmull_rom(x: f32) -> f32 {
    let t = min(x.abs(), 2.0);
    let m = max(1.0 - t, 0.0);
    ((2.5 - 0.5 * t) * t - 4.0) * t + 2.0 + m * m * (1.0 - 2.0 * m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unstretched_kernel_equals_the_weights() {
        let mut centres = [0.0; TILE];
        for (i, p) in centres.iter_mut().enumerate() {
            *p = 7.0 + i as f32 / TILE as f32;
        }
        let (first, kernels) = kernels(&centres, &[1.0; TILE]);
        for (i, p) in centres.into_iter().enumerate() {
            // At an integer point the first of five pixels has weight zero.
            let skipped = if p == 7.0 { 1 } else { 0 };
            assert_eq!(first[i] + skipped as f32, 6.0);
            for (k, w) in weights(p - 7.0).into_iter().enumerate() {
                assert!((w - kernels[k + skipped][i]).abs() < 1e-6, "{p}");
            }
        }
    }

    #[test]
    fn the_branchless_cubic_is_the_same() {
        for k in -300..300 {
            let t = 0.01 * k as f32;
            assert!((catmull_rom(t) - super::super::sample::cubic(t)).abs() < 2e-6, "{t}");
        }
    }
}
