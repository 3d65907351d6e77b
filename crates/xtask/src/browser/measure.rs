//! Measures the difference between the picture of a result and the warped picture of the original.

use pathwarp_raster::Pixmap;
use std::f64::consts::TAU;

/// A pixel differs if one of its channels lies more than this outside the channel's range within [`NEIGHBOURHOOD`] pixels in the other
/// picture. Edges may move, and letters are drawn at fractions of pixels.
const VISIBLE: u8 = 40;
const NEIGHBOURHOOD: usize = 3;
/// Pixels this close to the edge of the page are not compared: they depend on content off the page, and on antialiasing.
const EDGE: usize = 8;
/// The largest fraction of the painted pixels that may differ, however small the drawing is on its page.
const MAX_OF_INK: f64 = 0.25;
/// Fewer differing pixels than this may be an accident of antialiasing.
const MIN_PIXELS: usize = 12;
/// Amplitude and wavelength of the curved map, as fractions of the picture's larger side. Lengths change by at most a fifth.
const AMPLITUDE: f64 = 0.025;
const WAVELENGTH: f64 = 0.8;

/// A picture in RGBA with premultiplied alpha, so that white stands out from the transparent page like every other colour.
pub(super) struct Picture {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) data: Vec<u8>,
}

/// The pixels that differ, as fractions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gap {
    /// Fraction of all pixels of the picture.
    pub(super) of_page: f64,
    /// Fraction of the painted pixels.
    pub(super) of_ink: f64,
}

impl Gap {
    /// Returns `true` if people would see a difference.
    pub(super) fn differs(self, max_of_page: f64) -> bool {
        self.of_page > max_of_page || self.of_ink > MAX_OF_INK
    }
}

/// The map from user units to pixels: scales and offsets along x and y.
#[derive(Debug, Clone, Copy)]
pub(super) struct ToPixels {
    pub(super) scale: [f64; 2],
    pub(super) offset: [f64; 2],
}

/// A map for which no element takes a shortcut, and whose exact inverse is known.
#[derive(Debug, Clone, Copy)]
pub(super) enum Bend {
    /// To the right by this many pixels. It differs from a translation by a billionth of a unit, enough for the program not to treat it as one.
    Shift(usize),
    /// X = x + a sin(k y), Y = y + a sin(k X): two shears, one after the other. So y = Y − a sin(k X) and x = X − a sin(k y).
    Curve {
        /// a, in pixels.
        amplitude: f64,
        /// k, per pixel.
        wave: f64,
    },
}

impl Bend {
    pub(super) fn curve(width: usize, height: usize) -> Self {
        let side = width.max(height) as f64;
        Self::Curve { amplitude: AMPLITUDE * side, wave: TAU / (WAVELENGTH * side) }
    }

    /// The formulas for `pathwarp expr`, in user units.
    pub(super) fn formulas(self, ToPixels { scale: [a, d], offset: [e, f] }: ToPixels) -> [String; 2] {
        match self {
            Self::Shift(by) => [format!("x + {:e} + 1e-9*sin(x)", by as f64 / a), "y + 1e-9*sin(y)".into()],
            Self::Curve { amplitude, wave } => {
                let x = format!("(x + {:e}*sin({:e}*y + {:e}))", amplitude / a, wave * d, wave * f);
                let y = format!("y + {:e}*sin({:e}*{x} + {:e})", amplitude / d, wave * a, wave * e);
                [x, y]
            }
        }
    }

    /// The pixel that is mapped to this one.
    fn source(self, x: usize, y: usize) -> Option<(usize, usize)> {
        match self {
            Self::Shift(by) => Some((x.checked_sub(by)?, y)),
            Self::Curve { amplitude, wave } => {
                let (to_x, to_y) = (x as f64 + 0.5, y as f64 + 0.5);
                let from_y = to_y - amplitude * (wave * to_x).sin();
                let from_x = to_x - amplitude * (wave * from_y).sin();
                (from_x >= 0.0 && from_y >= 0.0).then_some((from_x as usize, from_y as usize))
            }
        }
    }
}

impl Picture {
    pub(super) fn new(pixmap: &Pixmap) -> Self {
        Self { width: pixmap.width() as usize, height: pixmap.height() as usize, data: pixmap.data().to_vec() }
    }

    /// The picture at this size, cut off or with transparent pixels to the right and below.
    pub(super) fn on_page(&self, [width, height]: [usize; 2]) -> Self {
        let mut data = vec![0; 4 * width * height];
        let across = 4 * width.min(self.width);
        for (to, from) in data.chunks_exact_mut(4 * width).zip(self.data.chunks_exact(4 * self.width)) {
            to[..across].copy_from_slice(&from[..across]);
        }
        Self { width, height, data }
    }

    /// Replaces each pixel by the mean of 3 × 3, so that a line one pixel wide looks the same wherever it falls between pixels.
    fn softened(&self) -> Self {
        let (w, h) = (self.width, self.height);
        let mean = |data: &[u8], step: usize, at: usize, first: bool, last: bool| {
            let before = if first { data[at] } else { data[at - step] };
            let after = if last { data[at] } else { data[at + step] };
            ((u16::from(before) + u16::from(data[at]) + u16::from(after)) / 3) as u8
        };
        let across: Vec<u8> =
            (0..self.data.len()).map(|i| mean(&self.data, 4, i, (i / 4) % w == 0, (i / 4) % w == w - 1)).collect();
        let data = (0..across.len()).map(|i| mean(&across, 4 * w, i, i < 4 * w, i >= 4 * w * (h - 1))).collect();
        Self { width: w, height: h, data }
    }

    /// The image of the picture under a map, and `true` for each pixel to be compared. Pixels whose source is off the page come from
    /// `found`.
    fn warped(&self, bend: Bend, page: [usize; 2], found: &Self) -> (Self, Vec<bool>) {
        let mut data = found.data.clone();
        let mut comparable = vec![false; self.width * self.height];
        let is_on_page = |x: usize, y: usize, edge: usize| {
            [x, y].into_iter().zip(page).all(|(c, side)| c >= edge && c + edge < side)
        };
        for (i, is_comparable) in comparable.iter_mut().enumerate() {
            let (x, y) = (i % self.width, i / self.width);
            if let Some((from_x, from_y)) = bend.source(x, y).filter(|(x, y)| is_on_page(*x, *y, 0)) {
                let from = 4 * (from_y * self.width + from_x);
                data[4 * i..4 * i + 4].copy_from_slice(&self.data[from..from + 4]);
                // A shift moves nothing across the upper and lower edges, but brings in hidden columns from the left: `by`, and a margin.
                *is_comparable = match bend {
                    Bend::Shift(by) => x >= 2 * by + EDGE && x + EDGE < page[0],
                    Bend::Curve { .. } => is_on_page(x, y, EDGE) && is_on_page(from_x, from_y, EDGE),
                };
            }
        }
        (Self { width: self.width, height: self.height, data }, comparable)
    }

    /// Returns `true` if a pixel is outside the range of colours that `other` has near it.
    fn stands_out(&self, other: &Self, at: usize) -> bool {
        let (x, y) = (at % self.width, at / self.width);
        let rows = y.saturating_sub(NEIGHBOURHOOD)..(y + NEIGHBOURHOOD + 1).min(self.height);
        let columns = x.saturating_sub(NEIGHBOURHOOD)..(x + NEIGHBOURHOOD + 1).min(self.width);
        let (mut min, mut max) = ([255; 4], [0; 4]);
        for near in rows.flat_map(|y| columns.clone().map(move |x| 4 * (y * self.width + x))) {
            for k in 0..4 {
                min[k] = min[k].min(other.data[near + k]);
                max[k] = max[k].max(other.data[near + k]);
            }
        }
        (0..4).any(|k| {
            let value = self.data[4 * at + k];
            value > max[k].saturating_add(VISIBLE) || value.saturating_add(VISIBLE) < min[k]
        })
    }
}

/// Compares the picture of a result with the image of the original picture, of the same size, under the map. `page` is the extent of the
/// drawing's page. Also returns `true` for every pixel that differs.
pub(super) fn compare(original: &Picture, found: &Picture, bend: Bend, page: [usize; 2]) -> (Gap, Vec<bool>) {
    let page = [page[0].min(found.width), page[1].min(found.height)];
    let soft = matches!(bend, Bend::Curve { .. }).then(|| [original.softened(), found.softened()]);
    let [original, found] = soft.as_ref().map_or([original, found], |[o, f]| [o, f]);
    let (expected, comparable) = original.warped(bend, page, found);
    let apart = |i: usize| (4 * i..4 * i + 4).any(|k| expected.data[k].abs_diff(found.data[k]) > VISIBLE);
    let marks: Vec<bool> = (0..comparable.len())
        .map(|i| comparable[i] && apart(i) && (expected.stands_out(found, i) || found.stands_out(&expected, i)))
        .collect();
    let differing = marks.iter().filter(|m| **m).count();
    let painted = |i: usize| expected.data[4 * i + 3] > VISIBLE || found.data[4 * i + 3] > VISIBLE;
    let ink = (0..comparable.len()).filter(|i| comparable[*i] && painted(*i)).count();
    let of_ink = if differing < MIN_PIXELS { 0.0 } else { differing as f64 / ink.max(1) as f64 };
    (Gap { of_page: differing as f64 / (found.width * found.height) as f64, of_ink }, marks)
}
