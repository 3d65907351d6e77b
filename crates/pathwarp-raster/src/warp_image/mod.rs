//! A bitmap bent by a map: every pixel of the result asks the inverse map where it comes from.
//!
//! The inverse's derivatives say what a pixel of the result covers in the source, to first order a parallelogram. Where that
//! is no larger than a source pixel, the source is interpolated (Catmull and Rom's cubic, which keeps the pixels' own
//! values); where it is larger, the same cubic is stretched over it, so that everything the pixel covers counts and nothing
//! aliases; a footprint that is long in one direction only is stretched in that direction only. This is elliptical weighted
//! averaging (P. S. Heckbert, *Fundamentals of Texture Mapping and Image Warping*, 1989, chapter 3) with a sharper kernel
//! than his Gaussian. Very large footprints read from a pyramid of halved pictures (L. Williams, *Pyramidal Parametrics*,
//! 1983), two to four of whose pixels go into one; so the work per pixel is bounded.
//!
//! Colours are averaged as they are stored, sRGB with premultiplied alpha: as browsers and resvg composite, and as the
//! edges of warped shapes beside the picture are antialiased. Beyond the source's edge all is transparent, and the edge is
//! antialiased over one pixel of the result.
//!
//! Over a tile the inverse is nearly always as good as a cubic through a few of its values ([`trace`]), and neighbouring
//! pixels are then made together ([`rows`]); elsewhere every pixel asks.
//!
//! The work is done in tiles, in parallel. Memory is the source, a third of it again for the pyramid where there is
//! shrinking, and the result.

mod block;
mod pyramid;
mod reach;
mod rows;
mod sample;
mod shade;
mod trace;

use crate::{Error, render::new_pixmap};
use block::{BYTES, Block, Bytes};
use kurbo::{Affine, Point, Rect, Vec2};
use pathwarp::map::{Jet, Map};
use pyramid::Pyramid;
use rayon::prelude::*;
use reach::Reach;
use rows::Way;
use tiny_skia::{Pixmap, PremultipliedColorU8};
use trace::{ASKED, Basis, Trace};

pub use reach::{Extent, extent};
pub use shade::{Shade, shade};

/// Pixels along the side of a tile: its part of the source stays in the cache.
const TILE: usize = 32;
/// Tiles over which the inverse is no cubic are divided down to this; then every pixel asks.
const SMALLEST: usize = 8;

/// What is to be warped, and onto what.
#[derive(Clone, Copy)]
pub struct ImageWarp<'a> {
    /// The bitmap.
    pub source: &'a Pixmap,
    /// Where it lies: from its pixels (its box is 0, 0, width, height) to the plane.
    pub placed: Affine,
    /// The map of the plane.
    pub map: &'a dyn Map,
    /// The map's inverse; values that are not finite mean "from nowhere".
    pub inverse: &'a dyn Map,
    /// What the result shows: from its pixels (its box is 0, 0, width, height) to the plane.
    pub shown: Affine,
    /// The result's pixels.
    pub size: (u32, u32),
}

/// Warps a bitmap.
///
/// # Errors
/// [`Error::Empty`] and [`Error::TooLarge`] for impossible sizes of the result.
pub fn warp_image(warp: &ImageWarp<'_>) -> Result<Pixmap, Error> {
    let (width, height) = warp.size;
    let mut out = new_pixmap(f64::from(width), f64::from(height))?;
    let reach = Reach::new(warp, warp.shown.inverse(), TILE);
    let painter = Painter {
        warp,
        to_source: warp.placed.inverse(),
        pyramid: Pyramid::new(warp.source),
        bytes: Bytes {
            data: warp.source.data(),
            width: warp.source.width() as usize,
            height: warp.source.height() as usize,
        },
        basis: Basis::new(),
        arch: pulp::Arch::new(),
    };
    let columns = width as usize;
    out.data_mut().par_chunks_mut(columns * BYTES * TILE).enumerate().for_each(|(band, rows)| {
        let mut band = Band { top: band * TILE, stride: columns * BYTES, rows, block: Block::default() };
        let height = band.rows.len() / band.stride;
        for left in (0..columns).step_by(TILE) {
            if reach.touches(left / TILE, band.top / TILE) {
                let area = Area { left, top: band.top, width: TILE.min(columns - left), height };
                painter.tile(&mut band, area);
            }
        }
    });
    Ok(out)
}

/// Some pixels of the result.
#[derive(Clone, Copy)]
struct Area {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
}

impl Area {
    /// The four quarters, those that are not empty.
    fn quarters(self) -> impl Iterator<Item = Self> {
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

    /// Where its pixels come from as a polynomial, if that is one: from the pixels by `shown` to the plane, through `inverse`,
    /// and by `last` to where it is wanted.
    fn trace(self, basis: &Basis, shown: Affine, inverse: &dyn Map, last: Affine) -> Option<Trace> {
        // A single column has a width, too, so that there is a derivative.
        let size = ((self.width - 1).max(1) as f64, (self.height - 1).max(1) as f64);
        let (left, top) = (self.left as f64 + 0.5, self.top as f64 + 0.5);
        let mut places = [Point::ORIGIN; ASKED];
        for (place, (u, v)) in places.iter_mut().zip(basis.places()) {
            *place = shown * Point::new(left + u * size.0, top + v * size.1);
        }
        let mut answers = [Point::ORIGIN; ASKED];
        inverse.points(&places, &mut answers);
        for answer in &mut answers {
            *answer = last * *answer;
        }
        basis.trace(&answers, size)
    }
}

/// Whole rows of the result.
struct Band<'a> {
    top: usize,
    stride: usize,
    rows: &'a mut [u8],
    /// What a tile reads, kept for the next one's use.
    block: Block,
}

impl Band<'_> {
    /// The bytes of an area's row.
    #[inline(always)]
    fn row(&mut self, area: Area, j: usize) -> &mut [u8] {
        &mut self.rows[(area.top - self.top + j) * self.stride + area.left * BYTES..][..area.width * BYTES]
    }
}

/// What all tiles share.
struct Painter<'a> {
    warp: &'a ImageWarp<'a>,
    to_source: Affine,
    pyramid: Pyramid<'a>,
    bytes: Bytes<'a>,
    basis: Basis,
    arch: pulp::Arch,
}

impl Painter<'_> {
    fn tile(&self, band: &mut Band<'_>, area: Area) {
        match area.trace(&self.basis, self.warp.shown, self.warp.inverse, self.to_source) {
            Some(trace) => self.arch.dispatch(Traced { painter: self, band, area, trace }),
            None if area.width.max(area.height) > SMALLEST => {
                area.quarters().for_each(|quarter| self.tile(band, quarter));
            }
            None => self.asked(band, area),
        }
    }

    /// Pixels that ask the inverse, each by itself.
    fn asked(&self, band: &mut Band<'_>, area: Area) {
        let place = |i: isize, j: isize| {
            self.warp.shown * Point::new(area.left as f64 + i as f64 + 0.5, area.top as f64 + j as f64 + 0.5)
        };
        let here = |jet: &Jet| in_pixels(jet, self.to_source, self.warp.shown);
        let mut places = [Point::ORIGIN; SMALLEST];
        let mut jets = [[Jet::default(); SMALLEST]; SMALLEST];
        for (j, row) in jets[..area.height].iter_mut().enumerate() {
            for (i, p) in places[..area.width].iter_mut().enumerate() {
                *p = place(i as isize, j as isize);
            }
            self.warp.inverse.jets(&places[..area.width], &mut row[..area.width]);
            for jet in &mut row[..area.width] {
                *jet = here(jet);
            }
        }
        let at = |i: isize, j: isize| {
            let known = usize::try_from(i).ok().zip(usize::try_from(j).ok());
            match known.filter(|(i, j)| *i < area.width && *j < area.height) {
                Some((i, j)) => jets[j][i],
                None => here(&self.warp.inverse.jet(place(i, j))),
            }
        };
        for (j, row) in jets.iter().enumerate().take(area.height) {
            for (pixel, (i, jet)) in band.row(area, j).as_chunks_mut().0.iter_mut().zip(row.iter().enumerate()) {
                let jet = Some(*jet)
                    .filter(|jet| jet.p.is_finite())
                    .or_else(|| beside(self.warp.source, |di, dj| at(i as isize + di, j as isize + dj)));
                if let Some(jet) = jet {
                    *pixel = bytes(sample::pixel(&self.pyramid, &jet));
                }
            }
        }
    }
}

/// A tile whose pixels' places are a polynomial. A type of its own and no closure: all of it is to be compiled for the vector
/// unit that there is, which goes by inlining.
struct Traced<'a, 'b> {
    painter: &'a Painter<'a>,
    band: &'a mut Band<'b>,
    area: Area,
    trace: Trace,
}

impl pulp::WithSimd for Traced<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { painter, band, area, trace } = self;
        let mut way = Way::of(&trace);
        let mut block = std::mem::take(&mut band.block);
        if !matches!(way, Way::Each) && !block.read(painter.bytes, &trace, way.margin(), way.layout()) {
            way = Way::Each;
        }
        for j in 0..area.height {
            let row = trace.pixels(j);
            let out = band.row(area, j);
            let other = |i: usize| bytes(sample::pixel(&painter.pyramid, &trace.pixel(i, j)));
            match way {
                Way::Between => rows::between(&block, &row, out, other),
                Way::Stretched => rows::stretched(&block, &row, out, other),
                Way::Skewed(shapes) => {
                    let size = [(area.width - 1).max(1) as f32, (area.height - 1).max(1) as f32];
                    rows::skewed(&block, &row, shapes.row(j as f32, size), out, other);
                }
                Way::Each => {
                    for (i, pixel) in out.as_chunks_mut().0.iter_mut().enumerate() {
                        *pixel = other(i);
                    }
                }
            }
        }
        band.block = block;
    }
}

fn bytes(p: PremultipliedColorU8) -> [u8; BYTES] {
    [p.red(), p.green(), p.blue(), p.alpha()]
}

/// For a pixel whose middle comes from nowhere, as many inverses say of all that lies off the source: the jet as a neighbour's
/// goes on, if that is off the source. So the pixels along the edge get the share of it that they cover.
fn beside(source: &Pixmap, neighbour: impl Fn(isize, isize) -> Jet) -> Option<Jet> {
    let (width, height) = (f64::from(source.width()), f64::from(source.height()));
    [(1, 0), (-1, 0), (0, 1), (0, -1)].into_iter().find_map(|(di, dj)| {
        let jet = neighbour(di, dj);
        let p = jet.p - jet.push(Vec2::new(di as f64, dj as f64));
        let off = p.x < 0.0 || p.y < 0.0 || p.x > width || p.y > height;
        off.then_some(Jet { p, ..jet })
    })
}

/// The inverse's jet from pixels of the result to pixels of the source.
#[inline]
fn in_pixels(jet: &Jet, to_source: Affine, shown: Affine) -> Jet {
    let [a, b, c, d, ..] = to_source.as_coeffs();
    let along = |v: Vec2| Vec2::new(a * v.x + c * v.y, b * v.x + d * v.y);
    let [p, q, r, s, ..] = shown.as_coeffs();
    Jet { p: to_source * jet.p, dx: along(jet.push(Vec2::new(p, q))), dy: along(jet.push(Vec2::new(r, s))) }
}

/// From the pixels of a result of `size` pixels to the box `target` that it shows.
#[must_use]
pub fn shown(target: Rect, size: (u32, u32)) -> Affine {
    Affine::translate(target.origin().to_vec2())
        * Affine::scale_non_uniform(target.width() / f64::from(size.0), target.height() / f64::from(size.1))
}

/// Four channels, premultiplied, 0 to 255.
type Channels = [f32; 4];

#[inline]
fn channels(p: PremultipliedColorU8) -> Channels {
    [f32::from(p.red()), f32::from(p.green()), f32::from(p.blue()), f32::from(p.alpha())]
}

/// The nearest colour there is: the cubic's overshoots are cut.
#[inline]
fn color(c: Channels) -> PremultipliedColorU8 {
    let level = |v: f32, most: u8| ((v + 0.5) as u8).min(most);
    let alpha = level(c[3], 255);
    PremultipliedColorU8::from_rgba(level(c[0], alpha), level(c[1], alpha), level(c[2], alpha), alpha)
        .unwrap_or(PremultipliedColorU8::TRANSPARENT)
}

#[cfg(test)]
mod tests;
