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
//! The work is done in tiles, in parallel. Memory is the source, a third of it again for the pyramid where there is
//! shrinking, and the result.

mod pyramid;
mod reach;
mod sample;

use crate::{Error, render::new_pixmap};
use kurbo::{Affine, Point, Rect, Vec2};
use pathwarp::map::{Jet, Map};
use pyramid::Pyramid;
use rayon::prelude::*;
use reach::Reach;
use tiny_skia::{Pixmap, PremultipliedColorU8};

pub use reach::{Extent, extent};

/// Pixels along the side of a tile: its part of the source stays in the cache.
const TILE: usize = 32;

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
    let to_plane = |x: f64, y: f64| warp.shown * Point::new(x, y);
    let to_source = warp.placed.inverse();
    let reach = Reach::new(warp, warp.shown.inverse(), TILE);
    let pyramid = Pyramid::new(warp.source);

    let columns = width as usize;
    let jet_at = |x: f64, y: f64| in_pixels(&warp.inverse.jet(to_plane(x, y)), to_source, warp.shown);
    out.pixels_mut().par_chunks_mut(columns * TILE).enumerate().for_each(|(band, rows)| {
        let mut places = [Point::ORIGIN; TILE];
        let mut jets = [[Jet::default(); TILE]; TILE];
        for (tile, first) in (0..columns).step_by(TILE).enumerate() {
            if !reach.touches(tile, band) {
                continue;
            }
            let n = TILE.min(columns - first);
            let height = rows.len() / columns;
            let corner = ((first as f64) + 0.5, (band * TILE) as f64 + 0.5);
            for (j, row) in jets[..height].iter_mut().enumerate() {
                for (i, place) in places[..n].iter_mut().enumerate() {
                    *place = to_plane(corner.0 + i as f64, corner.1 + j as f64);
                }
                warp.inverse.jets(&places[..n], &mut row[..n]);
                for jet in &mut row[..n] {
                    *jet = in_pixels(jet, to_source, warp.shown);
                }
            }
            for (j, row) in rows.chunks_mut(columns).enumerate() {
                for (i, pixel) in row[first..first + n].iter_mut().enumerate() {
                    let jet = if jets[j][i].p.is_finite() {
                        Some(jets[j][i])
                    } else {
                        beside(warp.source, |di, dj| {
                            let at = (i.wrapping_add_signed(di), j.wrapping_add_signed(dj));
                            if at.0 < n && at.1 < height {
                                return jets[at.1][at.0];
                            }
                            jet_at(corner.0 + i as f64 + di as f64, corner.1 + j as f64 + dj as f64)
                        })
                    };
                    if let Some(jet) = jet {
                        *pixel = sample::pixel(&pyramid, &jet);
                    }
                }
            }
        }
    });
    Ok(out)
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
