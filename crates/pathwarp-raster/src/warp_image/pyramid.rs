//! A picture at full size, half, a quarter, and so on.

use super::color::{Channels, add, channels, color};
use std::sync::OnceLock;
use tiny_skia::{Pixmap, PremultipliedColorU8};

/// Weights of the eight pixels around the middle of a pair, from the inside out: the cubic of [`super::sample`], stretched by two,
/// at (k + ½)/2.
const HALVING: [f32; 4] = [0.433_593_75, 0.113_281_25, -0.035_156_25, -0.011_718_75];

/// A picture of the pyramid.
pub(super) struct PyramidLevel<'a> {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) pixels: std::borrow::Cow<'a, [PremultipliedColorU8]>,
}

/// The pictures. Those after the first are computed on first use.
pub(super) struct Pyramid<'a> {
    source: PyramidLevel<'a>,
    halves: Vec<OnceLock<PyramidLevel<'static>>>,
}

impl<'a> Pyramid<'a> {
    pub(super) fn new(source: &'a Pixmap) -> Self {
        let (width, height) = (source.width() as usize, source.height() as usize);
        let levels = width.max(height).ilog2() as usize;
        Self {
            source: PyramidLevel { width, height, pixels: source.pixels().into() },
            halves: (0..levels).map(|_| OnceLock::new()).collect(),
        }
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
    pub(super) fn at(&self, x: usize, y: usize) -> Channels {
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
