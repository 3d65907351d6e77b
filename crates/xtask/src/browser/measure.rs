//! How far two pictures are apart.

use pathwarp_raster::Pixmap;
use std::f64::consts::TAU;

/// A channel differs when it lies outside what the other picture has within [`REACH`] pixels by more than this: edges move, and letters
/// are drawn at parts of pixels.
const VISIBLE: u8 = 40;
const REACH: usize = 3;
/// What comes in at the page's edge is not measured, nor is antialiasing beside it.
const EDGE: usize = 8;
/// Of what is painted, this share must not differ, however small it is on its page.
const MOST_OF_INK: f64 = 0.25;
/// Pixels of a difference that is no accident of antialiasing.
const FEWEST: usize = 12;
/// The curved map: its amplitude and its wavelength as shares of the picture's larger side. Lengths change by a fifth at most.
const AMPLITUDE: f64 = 0.025;
const WAVELENGTH: f64 = 0.8;

/// A picture of four channels, with premultiplied alpha: so white shows on the transparent page as every other colour does.
pub(super) struct Picture {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) data: Vec<u8>,
}

/// What a comparison finds.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gap {
    /// The differing pixels, as a share of the page.
    pub(super) share: f64,
    /// The same as a share of the painted pixels.
    pub(super) of_ink: f64,
}

impl Gap {
    /// Whether people see other drawings.
    pub(super) fn differs(self, worst: f64) -> bool {
        self.share > worst || self.of_ink > MOST_OF_INK
    }
}

/// The map from user units to pixels: scales and offsets.
#[derive(Debug, Clone, Copy)]
pub(super) struct ToPixels {
    pub(super) scale: [f64; 2],
    pub(super) offset: [f64; 2],
}

/// A map that every element takes the whole road through, and whose exact picture is known.
#[derive(Debug, Clone, Copy)]
pub(super) enum Bend {
    /// To the right by so many pixels. It is affine to within a billionth of a unit, but not to the program.
    Shift(usize),
    /// X = x + a sin(k y), Y = y + a sin(k X): two shears, one after the other, and so y = Y − a sin(k X), x = X − a sin(k y).
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

    /// The options of `pathwarp expr`, in user units.
    pub(super) fn formulas(self, ToPixels { scale: [a, d], offset: [e, f] }: ToPixels) -> [String; 2] {
        match self {
            Self::Shift(by) => [format!("x + {:e} + 1e-9*sin(x)", by as f64 / a), "y + 1e-9*sin(y)".into()]
                .map(|f| f.replace("+ -", "- ")),
            Self::Curve { amplitude, wave } => {
                let x = format!("(x + {:e}*sin({:e}*y + {:e}))", amplitude / a, wave * d, wave * f);
                let y = format!("y + {:e}*sin({:e}*{x} + {:e})", amplitude / d, wave * a, wave * e);
                [x, y]
            }
        }
    }

    /// The pixel whose image is this one.
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

    /// The mean of nine pixels: a line of one pixel has the same strength wherever it lies between the pixels.
    fn softened(&self) -> Self {
        let (w, h) = (self.width, self.height);
        let mean = |data: &[u8], step: usize, at: usize, first: bool, last: bool| {
            let before = if first { data[at] } else { data[at - step] };
            let after = if last { data[at] } else { data[at + step] };
            ((u16::from(before) + u16::from(data[at]) + u16::from(after)) / 3) as u8
        };
        let across: Vec<u8> =
            (0..self.data.len()).map(|i| mean(&self.data, 4, i, i / 4 % w == 0, i / 4 % w == w - 1)).collect();
        let data = (0..across.len()).map(|i| mean(&across, 4 * w, i, i < 4 * w, i >= 4 * w * (h - 1))).collect();
        Self { width: w, height: h, data }
    }

    /// What the picture becomes under a map. Where there is no source on the page, so `found` shows what it likes.
    fn bent(&self, bend: Bend, page: [usize; 2], found: &Self) -> (Self, Vec<bool>) {
        let mut data = found.data.clone();
        let mut known = vec![false; self.width * self.height];
        let inside = |x: usize, y: usize, edge: usize| {
            let within = |c: usize, side: usize| c >= edge && c + edge < side;
            within(x, page[0]) && within(y, page[1])
        };
        for (i, is_known) in known.iter_mut().enumerate() {
            let (x, y) = (i % self.width, i / self.width);
            if let Some((from_x, from_y)) = bend.source(x, y).filter(|(x, y)| inside(*x, *y, 0)) {
                let from = 4 * (from_y * self.width + from_x);
                data[4 * i..4 * i + 4].copy_from_slice(&self.data[from..from + 4]);
                // A shift moves nothing across the upper and the lower edge; what was hidden by the left one may be seen.
                *is_known = match bend {
                    Bend::Shift(by) => x >= 2 * by + EDGE && x + EDGE < page[0],
                    Bend::Curve { .. } => inside(x, y, EDGE) && inside(from_x, from_y, EDGE),
                };
            }
        }
        (Self { width: self.width, height: self.height, data }, known)
    }

    /// Whether the pixel lies outside what `other` has near it.
    fn stands_out(&self, other: &Self, at: usize) -> bool {
        let (x, y) = (at % self.width, at / self.width);
        let rows = y.saturating_sub(REACH)..(y + REACH + 1).min(self.height);
        let columns = x.saturating_sub(REACH)..(x + REACH + 1).min(self.width);
        let (mut least, mut most) = ([255; 4], [0; 4]);
        for near in rows.flat_map(|y| columns.clone().map(move |x| 4 * (y * self.width + x))) {
            for k in 0..4 {
                least[k] = least[k].min(other.data[near + k]);
                most[k] = most[k].max(other.data[near + k]);
            }
        }
        (0..4).any(|k| {
            let own = self.data[4 * at + k];
            own > most[k].saturating_add(VISIBLE) || own.saturating_add(VISIBLE) < least[k]
        })
    }
}

/// Compares the picture of a result with that of its original under the map; `page` is the extent of the drawing's page. Returns the
/// differing pixels, too, by which a mark can be put on each.
pub(super) fn compare(original: &Picture, found: &Picture, bend: Bend, page: [usize; 2]) -> (Gap, Vec<bool>) {
    let page = [page[0].min(found.width), page[1].min(found.height)];
    let soft = matches!(bend, Bend::Curve { .. }).then(|| [original.softened(), found.softened()]);
    let [original, found] = soft.as_ref().map_or([original, found], |[o, f]| [o, f]);
    let (expected, known) = original.bent(bend, page, found);
    let apart = |i: usize| (4 * i..4 * i + 4).any(|k| expected.data[k].abs_diff(found.data[k]) > VISIBLE);
    let marks: Vec<bool> = (0..known.len())
        .map(|i| known[i] && apart(i) && (expected.stands_out(found, i) || found.stands_out(&expected, i)))
        .collect();
    let differing = marks.iter().filter(|m| **m).count();
    let painted = |i: usize| expected.data[4 * i + 3] > VISIBLE || found.data[4 * i + 3] > VISIBLE;
    let ink = (0..known.len()).filter(|i| known[*i] && painted(*i)).count();
    let of_ink = if differing < FEWEST { 0.0 } else { differing as f64 / ink.max(1) as f64 };
    (Gap { share: differing as f64 / (found.width * found.height) as f64, of_ink }, marks)
}
