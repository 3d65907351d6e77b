//! Measures the difference of two pictures.
//!
//! Compares premultiplied channels including alpha, so that the colour of transparent pixels does not matter. Edges differ by
//! a few levels between versions and platforms of a renderer; a shifted curve differs by dozens of levels along its whole
//! length. [`Difference::share_over`] with a threshold in between distinguishes the two.

use crate::error::Error;
use crate::pixmap::{bytes, new_pixmap};
use pathwarp::budget::Limits;
use tiny_skia::{ColorU8, Pixmap, PremultipliedColorU8};

/// The difference of two pictures of the same size.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Width of both pictures in pixels.
    pub width: u32,
    /// Height of both pictures in pixels.
    pub height: u32,
    /// Largest difference of any channel of any pixel, 0 to 255.
    pub max_channel: u8,
    /// Mean absolute difference over all channels of all pixels, in units of 1/255.
    pub mean_abs: f64,
    /// Number of pixels for each value of the largest difference among their channels.
    histogram: Box<[u64; 256]>,
}

impl Difference {
    /// Returns `true` if the pictures are equal pixel for pixel.
    pub fn is_same(&self) -> bool {
        self.max_channel == 0
    }

    /// Returns the number of pixels with a channel that differs by more than `threshold`.
    pub fn pixels_over(&self, threshold: u8) -> u64 {
        self.histogram.iter().skip(usize::from(threshold) + 1).sum()
    }

    /// Returns the fraction of pixels with a channel that differs by more than `threshold`.
    pub fn share_over(&self, threshold: u8) -> f64 {
        self.pixels_over(threshold) as f64 / (f64::from(self.width) * f64::from(self.height))
    }
}

/// Measures the difference of two pictures.
///
/// # Errors
/// [`Error::SizesDiffer`] when the pictures differ in size.
pub fn compare(a: &Pixmap, b: &Pixmap) -> Result<Difference, Error> {
    check_sizes(a, b)?;
    let mut histogram = Box::new([0u64; 256]);
    let mut sum = 0u64;
    for (a, b) in a.pixels().iter().zip(b.pixels()) {
        let differences = channel_differences(*a, *b);
        sum += differences.iter().map(|d| u64::from(*d)).sum::<u64>();
        histogram[usize::from(largest(differences))] += 1;
    }
    let max_channel = (0..=u8::MAX).rfind(|d| histogram[usize::from(*d)] > 0).unwrap_or(0);
    let channels = 4.0 * f64::from(a.width()) * f64::from(a.height());
    Ok(Difference { width: a.width(), height: a.height(), max_channel, mean_abs: sum as f64 / channels, histogram })
}

/// Visualises the difference: `a` in pale grey, and red where `b` differs, stronger for larger differences.
///
/// # Errors
/// [`Error::SizesDiffer`] when the pictures differ in size.
pub fn diff_image(a: &Pixmap, b: &Pixmap) -> Result<Pixmap, Error> {
    check_sizes(a, b)?;
    let limits = Limits::default().for_input(a.data().len());
    let mut picture = new_pixmap(f64::from(a.width()), f64::from(a.height()), &limits)?;
    for ((a, b), out) in a.pixels().iter().zip(b.pixels()).zip(picture.pixels_mut()) {
        let difference = largest(channel_differences(*a, *b));
        *out = if difference == 0 { pale(*a) } else { red(difference) }.premultiply();
    }
    Ok(picture)
}

fn check_sizes(a: &Pixmap, b: &Pixmap) -> Result<(), Error> {
    let (a, b) = ((a.width(), a.height()), (b.width(), b.height()));
    if a == b { Ok(()) } else { Err(Error::SizesDiffer { a, b }) }
}

fn channel_differences(a: PremultipliedColorU8, b: PremultipliedColorU8) -> [u8; 4] {
    let (a, b) = (bytes(a), bytes(b));
    std::array::from_fn(|channel| a[channel].abs_diff(b[channel]))
}

fn largest(differences: [u8; 4]) -> u8 {
    differences.into_iter().fold(0, u8::max)
}

/// Converts a pixel on white to grey, blended three quarters towards white.
fn pale(pixel: PremultipliedColorU8) -> ColorU8 {
    let white = u32::from(u8::MAX - pixel.alpha());
    let on_white = |channel: u8| u32::from(channel) + white;
    // Rec. 709 luma weights in 1/256.
    let luma = (54 * on_white(pixel.red()) + 183 * on_white(pixel.green()) + 19 * on_white(pixel.blue())) / 256;
    let grey = u8::try_from(191 + luma / 4).unwrap_or(u8::MAX);
    ColorU8::from_rgba(grey, grey, grey, 255)
}

/// A light red for the smallest difference, up to full red at about a fifth of the range.
fn red(difference: u8) -> ColorU8 {
    let rest = 160u8.saturating_sub(difference.saturating_mul(3));
    ColorU8::from_rgba(230, rest, rest, 255)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Size, render};

    fn ring(cx: f64) -> Pixmap {
        let svg = format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100">
            <circle cx="{cx}" cy="50" r="30" fill="none" stroke="#05a" stroke-width="3"/></svg>"##
        );
        render(&usvg::Tree::from_str(&svg, &usvg::Options::default()).unwrap(), Size::Native).unwrap()
    }

    #[test]
    fn a_picture_equals_itself() {
        let difference = compare(&ring(50.0), &ring(50.0)).unwrap();
        assert!(difference.is_same());
        assert_eq!((difference.max_channel, difference.mean_abs, difference.share_over(0)), (0, 0.0, 0.0));
        assert_eq!((difference.width, difference.height), (100, 100));
    }

    #[test]
    fn a_shifted_picture_is_caught() {
        let by_a_pixel = compare(&ring(50.0), &ring(51.0)).unwrap();
        assert!(by_a_pixel.max_channel > 200, "{}", by_a_pixel.max_channel);
        assert!(by_a_pixel.share_over(64) > 0.01, "{}", by_a_pixel.share_over(64));
        let by_a_tenth = compare(&ring(50.0), &ring(50.1)).unwrap();
        assert!(by_a_tenth.max_channel > 16 && by_a_tenth.share_over(8) > 0.01);
        assert!(by_a_tenth.mean_abs < by_a_pixel.mean_abs);
    }

    #[test]
    fn shares_are_exact() {
        let mut a = Pixmap::new(10, 10).unwrap();
        a.fill(tiny_skia::Color::BLACK);
        let mut b = a.clone();
        // 3 pixels differ by 7 in one channel, 1 by 200 in all colours.
        for pixel in &mut b.pixels_mut()[..3] {
            *pixel = PremultipliedColorU8::from_rgba(0, 7, 0, 255).unwrap();
        }
        b.pixels_mut()[99] = PremultipliedColorU8::from_rgba(200, 200, 200, 255).unwrap();
        let difference = compare(&a, &b).unwrap();
        let shares: Vec<f64> = [0, 6, 7, 199, 200, 255].into_iter().map(|t| difference.share_over(t)).collect();
        assert_eq!(shares, [0.04, 0.04, 0.01, 0.01, 0.0, 0.0]);
        assert_eq!(difference.max_channel, 200);
        assert_eq!(difference.mean_abs, (3.0 * 7.0 + 600.0) / 400.0);
        assert_eq!(compare(&b, &a).unwrap(), difference);
    }

    #[test]
    fn transparent_is_not_black() {
        let clear = Pixmap::new(2, 2).unwrap();
        let mut black = clear.clone();
        black.fill(tiny_skia::Color::BLACK);
        assert_eq!(compare(&clear, &black).unwrap().max_channel, 255);
    }

    #[test]
    fn sizes_must_agree() {
        let (a, b) = (Pixmap::new(2, 3).unwrap(), Pixmap::new(3, 2).unwrap());
        let expected = Error::SizesDiffer { a: (2, 3), b: (3, 2) };
        assert_eq!(compare(&a, &b), Err(expected.clone()));
        assert_eq!(diff_image(&a, &b).unwrap_err(), expected);
    }

    #[test]
    fn the_diff_image_is_red_exactly_where_pixels_differ() {
        let (a, b) = (ring(50.0), ring(53.0));
        let picture = diff_image(&a, &b).unwrap();
        for ((a, b), shown) in a.pixels().iter().zip(b.pixels()).zip(picture.pixels()) {
            assert_eq!(a != b, shown.red() != shown.green());
            assert_eq!(shown.alpha(), 255);
        }
    }
}
