//! Computes one pixel of the result as the average over its footprint in the source.

use crate::pixmap::bytes;
use pathwarp::map::Jet;
use std::sync::OnceLock;
use tiny_skia::{Pixmap, PremultipliedColorU8};

/// Maximum aspect ratio of a footprint. Longer ones are widened, which blurs them.
const MAX_ASPECT: f64 = 16.0;
/// Minimum number of pixels of a pyramid level per pixel of the result, along each side; the maximum is twice as many.
const MIN_SHRINK: f64 = 2.0;
/// A squared stretch that exceeds one by less is a rounding error.
const ROUNDING: f64 = 1e-9;

/// Returns the colour of a pixel of the result. `jet` maps pixels of the result to pixels of the source.
#[inline]
pub(super) fn pixel(pyramid: &Pyramid<'_>, jet: &Jet) -> PremultipliedColorU8 {
    let source = pyramid.level(0);
    let (width, height) = (source.width as f64, source.height as f64);
    let share = covered(jet.p.x, width, jet.dx.x.hypot(jet.dy.x)) * covered(jet.p.y, height, jet.dx.y.hypot(jet.dy.y));
    // Without an inverse the share is NaN.
    if share.is_nan() || share <= 0.0 {
        return PremultipliedColorU8::TRANSPARENT;
    }
    let (x, y) = (jet.p.x.clamp(0.0, width), jet.p.y.clamp(0.0, height));
    let mut sum = match Footprint::new(jet) {
        None => interpolated(source, x, y),
        Some(footprint) => footprint.average(pyramid, x, y),
    };
    for s in &mut sum {
        *s *= share as f32;
    }
    color(sum)
}

/// The share of a pixel between the edges 0 and `size` of the source, with `rate` source pixels per pixel of the result.
#[inline]
fn covered(at: f64, size: f64, rate: f64) -> f64 {
    let share_inside = |depth: f64| (depth / rate + 0.5).clamp(0.0, 1.0);
    share_inside(at) + share_inside(size - at) - 1.0
}

/// The Catmull-Rom cubic: E. Catmull, R. Rom, *A class of local interpolating splines*, 1974; R. G. Keys, *Cubic
/// convolution interpolation for digital image processing*, 1981, with a = −½.
#[inline]
pub(super) fn cubic(t: f32) -> f32 {
    let t = t.abs();
    if t < 1.0 {
        (1.5 * t - 2.5) * t * t + 1.0
    } else if t < 2.0 {
        ((2.5 - 0.5 * t) * t - 4.0) * t + 2.0
    } else {
        0.0
    }
}

/// Weights of the four pixels around a point at distance `t` after the second.
#[inline]
fn weights(t: f32) -> [f32; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1.0, -1.5 * t3 + 2.0 * t2 + 0.5 * t, 0.5 * t3 - 0.5 * t2]
}

/// Interpolates the source; the colours of its outermost pixels extend beyond its edge.
#[inline]
fn interpolated(source: &PyramidLevel<'_>, x: f64, y: f64) -> Channels {
    let (x, y) = (x - 0.5, y - 0.5);
    let (left, top) = (x.floor(), y.floor());
    let (wx, wy) = (weights((x - left) as f32), weights((y - top) as f32));
    let (left, top) = (left as isize - 1, top as isize - 1);
    let mut sum = [0.0; 4];
    if left >= 0 && top >= 0 && left as usize + 4 <= source.width && top as usize + 4 <= source.height {
        let (left, top) = (left as usize, top as usize);
        for (j, weight) in wy.into_iter().enumerate() {
            let row = &source.pixels[(top + j) * source.width + left..][..4];
            let mut part = [0.0; 4];
            for (pixel, w) in row.iter().zip(wx) {
                add(&mut part, channels(*pixel), w);
            }
            add(&mut sum, part, weight);
        }
        return sum;
    }
    let clamped = |v: isize, size: usize| (v.max(0) as usize).min(size - 1);
    for (row, weight) in (top..).zip(wy) {
        for (column, w) in (left..).zip(wx) {
            add(&mut sum, source.pixel(clamped(column, source.width), clamped(row, source.height)), weight * w);
        }
    }
    sum
}

/// The footprint of a pixel that covers more than a source pixel: the symmetric matrix S that stretches a unit square as the
/// Jacobian J does, S² = J·Jᵀ, but by at least one in every direction.
pub(super) struct Footprint {
    /// Direction of the longest axis.
    axis: [f64; 2],
    /// Lengths of the longest and the shortest axis, in pixels of the source per pixel of the result.
    pub(super) longest: f64,
    shortest: f64,
}

/// The integers from `from` to `to`, as a range within 0..`size`. Uses conversions, since rounding is a function call on some
/// processors.
#[inline]
fn integers_between(from: f64, to: f64, size: usize) -> (usize, usize) {
    // Conversions map negative numbers to zero.
    let first = from as usize;
    let first = if (first as f64) < from { first.saturating_add(1) } else { first };
    (first, if to >= 0.0 { (to as usize).saturating_add(1).min(size) } else { 0 })
}

impl Footprint {
    /// Returns `None` if no direction shrinks.
    #[inline]
    pub(super) fn new(jet: &Jet) -> Option<Self> {
        let (a, c) = (jet.dx.x * jet.dx.x + jet.dy.x * jet.dy.x, jet.dx.y * jet.dx.y + jet.dy.y * jet.dy.y);
        let b = jet.dx.x * jet.dx.y + jet.dy.x * jet.dy.y;
        // The eigenvalues of J·Jᵀ, with the entries a, b and c, are the mean of a and c plus and minus this radius.
        let (mean, radius) = (0.5 * (a + c), (0.5 * (a - c)).hypot(b));
        if mean + radius <= 1.0 + ROUNDING {
            return None;
        }
        let longest = (mean + radius).sqrt();
        let shortest = (mean - radius).max(0.0).sqrt().max(1.0).max(longest / MAX_ASPECT);
        // Take the eigenvector from the row of the matrix that does not suffer from cancellation.
        let axis = if a > c { [0.5 * (a - c) + radius, b] } else { [b, 0.5 * (c - a) + radius] };
        let length = axis[0].hypot(axis[1]);
        let axis = if length > 0.0 { axis.map(|v| v / length) } else { [1.0, 0.0] };
        Some(Self { axis, longest, shortest })
    }

    /// The upper left, off-diagonal and lower right entries of S.
    pub(super) fn stretch(&self) -> [f64; 3] {
        self.matrix(self.longest, self.shortest)
    }

    /// The upper left, off-diagonal and lower right entries of S⁻¹ for a jet.
    pub(super) fn inverse_matrix(jet: &Jet) -> [f64; 3] {
        Self::new(jet).map_or([1.0, 0.0, 1.0], |f| f.matrix(1.0 / f.longest, 1.0 / f.shortest))
    }

    /// The matrix p·a·aᵀ + q·(1 − a·aᵀ), where a is the longest axis.
    fn matrix(&self, p: f64, q: f64) -> [f64; 3] {
        let [x, y] = self.axis;
        [q + (p - q) * x * x, (p - q) * x * y, q + (p - q) * y * y]
    }

    /// Returns the weighted average around a point, given in pixels of the source.
    fn average(&self, pyramid: &Pyramid<'_>, x: f64, y: f64) -> Channels {
        let steps = (self.shortest / MIN_SHRINK).log2().floor().max(0.0) as usize;
        let steps = steps.min(pyramid.deepest());
        let level = pyramid.level(steps);
        let scale = 0.5_f64.powi(steps as i32);
        let (p, q) = (self.longest * scale, self.shortest * scale);
        let ([sx, s, sy], [ix, i, iy]) = (self.matrix(p, q), self.matrix(1.0 / p, 1.0 / q));
        // Measure from pixel centres.
        let (x, y) = (x * scale - 0.5, y * scale - 0.5);
        let (wide, high) = (2.0 * (sx.abs() + s.abs()), 2.0 * (s.abs() + sy.abs()));
        let (mut sum, mut total) = ([0.0; 4], 0.0);
        let (top, bottom) = integers_between(y - high, y + high, level.height);
        if i.abs() * (wide + high) < 1e-3 {
            // The footprint lies along rows and columns, so the weights of columns are equal in every row.
            let (left, right) = integers_between(x - wide, x + wide, level.width);
            let mut columns = [0.0; COLUMNS];
            let count = right.saturating_sub(left).min(COLUMNS);
            for (k, w) in columns[..count].iter_mut().enumerate() {
                *w = cubic(((left + k) as f64 - x) as f32 * ix as f32);
                total += *w;
            }
            let mut row_total = 0.0;
            for row in top..bottom {
                let weight = cubic((row as f64 - y) as f32 * iy as f32);
                row_total += weight;
                let mut part = [0.0; 4];
                for (pixel, w) in level.pixels[row * level.width + left..][..count].iter().zip(&columns) {
                    add(&mut part, channels(*pixel), *w);
                }
                add(&mut sum, part, weight);
            }
            total *= row_total;
        } else {
            for row in top..bottom {
                let dy = row as f64 - y;
                // The kernel is nonzero for |S⁻¹·d| < 2 in both coordinates.
                let ([a0, a1], [b0, b1]) = (interval_within_kernel(ix, i * dy), interval_within_kernel(i, iy * dy));
                let (left, right) = integers_between(x + a0.max(b0), x + a1.min(b1), level.width);
                if left >= right {
                    continue;
                }
                let (mut u, mut v) = ((left as f64 - x) * ix + i * dy, (left as f64 - x) * i + iy * dy);
                for pixel in &level.pixels[row * level.width..][left..right] {
                    let weight = cubic(u as f32) * cubic(v as f32);
                    add(&mut sum, channels(*pixel), weight);
                    total += weight;
                    (u, v) = (u + ix, v + i);
                }
            }
        }
        // The point is on the picture, so about a quarter of the weights or more should be, too.
        if total <= 0.1 * (p * q) as f32 {
            return interpolated(level, x + 0.5, y + 0.5);
        }
        sum.map(|s| s / total)
    }
}

/// Maximum width of an upright footprint: twice the radius of the cubic, which is two, times the largest stretch of a level.
const COLUMNS: usize = (4.0 * 2.0 * MIN_SHRINK * MAX_ASPECT) as usize + 2;

/// The interval of d in which |slope·d + rest| < 2, the radius of the kernel.
#[inline]
fn interval_within_kernel(slope: f64, rest: f64) -> [f64; 2] {
    if slope.abs() < 1e-12 {
        return if rest.abs() < 2.0 { [f64::NEG_INFINITY, f64::INFINITY] } else { [1.0, -1.0] };
    }
    let (a, b) = ((-2.0 - rest) / slope, (2.0 - rest) / slope);
    [a.min(b), a.max(b)]
}

/// Weights of the eight pixels around the middle of a pair, from the inside out: half of [`cubic`] at (k + ½)/2, for k from 0.
const HALVING: [f32; 4] = [0.433_593_75, 0.113_281_25, -0.035_156_25, -0.011_718_75];

/// A picture of the pyramid.
pub(super) struct PyramidLevel<'a> {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) pixels: std::borrow::Cow<'a, [PremultipliedColorU8]>,
}

/// The source and its halved copies, which are computed on first use.
pub(super) struct Pyramid<'a> {
    source: PyramidLevel<'a>,
    halves: Vec<OnceLock<PyramidLevel<'static>>>,
}

impl<'a> Pyramid<'a> {
    pub(super) fn new(source: &'a Pixmap) -> Self {
        let (width, height) = (source.width() as usize, source.height() as usize);
        let halves = (0..width.max(height).ilog2()).map(|_| OnceLock::new()).collect();
        Self { source: PyramidLevel { width, height, pixels: source.pixels().into() }, halves }
    }

    /// Index of the deepest level.
    pub(super) fn deepest(&self) -> usize {
        self.halves.len()
    }

    /// Returns the picture halved `level` times.
    #[inline]
    pub(super) fn level(&self, level: usize) -> &PyramidLevel<'a> {
        match level.checked_sub(1).and_then(|above| Some((above, self.halves.get(above)?))) {
            None => &self.source,
            Some((above, lock)) => lock.get_or_init(|| self.level(above).half()),
        }
    }
}

impl PyramidLevel<'_> {
    #[inline]
    pub(super) fn pixel(&self, x: usize, y: usize) -> Channels {
        channels(self.pixels[y * self.width + x])
    }

    /// Halves width and height, summing columns for one row at a time.
    fn half(&self) -> PyramidLevel<'static> {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut pixels = Vec::with_capacity(width * height);
        let mut sums = vec![[0.0; 4]; self.width];
        let around = |i: usize, size: usize| {
            let clamped = move |k: usize| (2 * i + k).saturating_sub(3).min(size - 1);
            (0..8).map(move |k| (clamped(k), HALVING[if k < 4 { 3 - k } else { k - 4 }]))
        };
        for y in 0..height {
            sums.fill([0.0; 4]);
            for (row, weight) in around(y, self.height) {
                for (sum, pixel) in sums.iter_mut().zip(&self.pixels[row * self.width..][..self.width]) {
                    add(sum, channels(*pixel), weight);
                }
            }
            for x in 0..width {
                let mut sum = [0.0; 4];
                for (column, weight) in around(x, self.width) {
                    add(&mut sum, sums[column], weight);
                }
                pixels.push(color(sum));
            }
        }
        PyramidLevel { width, height, pixels: pixels.into() }
    }
}

/// Four premultiplied channels, 0 to 255.
pub(super) type Channels = [f32; 4];

#[inline]
pub(super) fn channels(p: PremultipliedColorU8) -> Channels {
    bytes(p).map(f32::from)
}

/// Rounds to the nearest valid colour, clipping the overshoots of the cubic.
#[inline]
pub(super) fn color(c: Channels) -> PremultipliedColorU8 {
    let level = |v: f32, max: u8| ((v + 0.5) as u8).min(max);
    let alpha = level(c[3], 255);
    PremultipliedColorU8::from_rgba(level(c[0], alpha), level(c[1], alpha), level(c[2], alpha), alpha)
        .unwrap_or(PremultipliedColorU8::TRANSPARENT)
}

/// Adds a weighted pixel to a sum.
#[inline]
pub(super) fn add(sum: &mut Channels, pixel: Channels, weight: f32) {
    for (s, c) in sum.iter_mut().zip(pixel) {
        *s += weight * c;
    }
}

#[cfg(test)]
mod tests {
    use super::integers_between;

    #[test]
    fn ranges_hold_the_whole_numbers_between() {
        let rounded = |from: f64, to: f64, size: usize| {
            (from.ceil().max(0.0) as usize, ((to.floor() + 1.0).max(0.0) as usize).min(size))
        };
        let bounds =
            [f64::NEG_INFINITY, -3.5, -1.0, -0.2, -0.0, 0.0, 0.3, 1.0, 6.5, 7.0, 9.9, 1e300, f64::INFINITY, f64::NAN];
        for from in bounds {
            for to in bounds {
                assert_eq!(integers_between(from, to, 8), rounded(from, to, 8), "{from} {to}");
            }
        }
    }
}
