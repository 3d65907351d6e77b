//! Allocates pictures within the size limit, and goes through their pixels.

use crate::error::Error;
use pathwarp::budget::{Exceeded, Limit, Limits};
#[cfg(feature = "parallel")]
use rayon::prelude::*;
use tiny_skia::{FilterQuality, IntRect, Pixmap, PixmapPaint, PremultipliedColorU8, Transform};

/// Bytes held for each pixel of a new picture: the pixel itself, and its share of the file.
const HELD_BYTES: f64 = 8.0;

/// Checks the size of a picture to read. The limit on pixels guards against files that unpack to much more than their size.
pub(crate) fn check_size(width: f64, height: f64, limits: &Limits) -> Result<(), Error> {
    let too_large = |exceeded| Error::TooLarge { width, height, exceeded };
    limits.check(Limit::Pixels, width * height).map_err(too_large)
}

/// Creates a transparent picture. Fails if it would be empty or exceed the limits.
pub(crate) fn new_pixmap(width: f64, height: f64, limits: &Limits) -> Result<Pixmap, Error> {
    let too_large = |exceeded| Error::TooLarge { width, height, exceeded };
    limits.check(Limit::Memory, HELD_BYTES * width * height).map_err(too_large)?;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the limit; casts saturate")]
    let (whole_width, whole_height) = (width as u32, height as u32);
    if whole_width == 0 || whole_height == 0 {
        return Err(Error::Empty { width: whole_width, height: whole_height });
    }
    let (limit, needed) = (Limit::Memory, HELD_BYTES * width * height);
    let refused = || too_large(Exceeded { limit, most: limits.of(limit), needed, cut: false });
    Pixmap::new(whole_width, whole_height).ok_or_else(refused)
}

/// The premultiplied channels of a pixel.
#[inline]
pub(crate) fn bytes(p: PremultipliedColorU8) -> [u8; 4] {
    [p.red(), p.green(), p.blue(), p.alpha()]
}

/// The channels of a pixel with straight alpha.
#[inline]
pub(crate) fn straight(p: &PremultipliedColorU8) -> [u8; 4] {
    let c = p.demultiply();
    [c.red(), c.green(), c.blue(), c.alpha()]
}

/// Enlarges a part of a picture `factor` times. Pixels become squares if `squares`; else colours are interpolated linearly between the
/// centres of pixels, as browsers do.
///
/// # Errors
/// [`Error::TooLarge`] when the result exceeds the limits.
pub fn enlarged(source: &Pixmap, part: IntRect, factor: u32, squares: bool, limits: &Limits) -> Result<Pixmap, Error> {
    let size = |side: u32| f64::from(side) * f64::from(factor);
    let mut out = new_pixmap(size(part.width()), size(part.height()), limits)?;
    let quality = if squares { FilterQuality::Nearest } else { FilterQuality::Bilinear };
    let paint = PixmapPaint { quality, ..PixmapPaint::default() };
    let scale = Transform::from_scale(factor as f32, factor as f32);
    let transform = scale.pre_translate(-(part.x() as f32), -(part.y() as f32));
    out.draw_pixmap(0, 0, source.as_ref(), &paint, transform, None);
    Ok(out)
}

/// Calls `f` with the index and the content of every chunk of `size` elements.
pub(crate) fn for_each_chunk<T: Send>(data: &mut [T], size: usize, f: impl Fn(usize, &mut [T]) + Send + Sync) {
    #[cfg(feature = "parallel")]
    data.par_chunks_mut(size).enumerate().for_each(|(i, chunk)| f(i, chunk));
    #[cfg(not(feature = "parallel"))]
    data.chunks_mut(size).enumerate().for_each(|(i, chunk)| f(i, chunk));
}

/// Calls `f` with the index and the content of every chunk of `size` elements of two slices of the same length.
pub(crate) fn for_each_chunk_pair<T: Send, U: Send>(
    a: &mut [T],
    b: &mut [U],
    size: usize,
    f: impl Fn(usize, &mut [T], &mut [U]) + Send + Sync,
) {
    #[cfg(feature = "parallel")]
    a.par_chunks_mut(size).zip(b.par_chunks_mut(size)).enumerate().for_each(|(i, (a, b))| f(i, a, b));
    #[cfg(not(feature = "parallel"))]
    a.chunks_mut(size).zip(b.chunks_mut(size)).enumerate().for_each(|(i, (a, b))| f(i, a, b));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn enlarged_pixels_are_squares_or_blend() {
        let mut source = Pixmap::new(3, 2).unwrap();
        for (i, b) in source.data_mut().chunks_mut(4).enumerate() {
            b.copy_from_slice(&[40 * i as u8, 0, 0, 255]);
        }
        let part = IntRect::from_xywh(1, 0, 2, 2).unwrap();
        let [squares, blended] = [true, false].map(|s| enlarged(&source, part, 50, s, &Limits::default()).unwrap());
        let red = |p: &Pixmap, x: u32, y: u32| p.pixel(x, y).unwrap().red();
        for y in 0..100 {
            for x in 0..100 {
                assert_eq!(red(&squares, x, y), 40 * (1 + (x / 50 + 3 * (y / 50)) as u8), "{x} {y}");
                // Between the centres of the pixels 1, 2 and 4, 5.
                let at = |v: u32| f64::from(v) / 50.0 + 0.01 - 0.5;
                let exact = 40.0 * (1.0 + at(x).clamp(-1.0, 1.0) + 3.0 * at(y).clamp(0.0, 1.0));
                assert!((f64::from(red(&blended, x, y)) - exact).abs() < 2.0, "{x} {y}");
            }
        }
    }
}
