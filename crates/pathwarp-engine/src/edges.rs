//! The opaque parts of pictures, and the colours beyond the edge of a drawing.

use crate::bitmap::{Bender, Pixel, count_picture, count_pixels, too_much};
use pathwarp_raster::{Picture, Pixmap, RenderOptions, Size, encode_png, header_size};
use pathwarp_svg::ReadOptions;
use pathwarp_svg::engine::{EdgePainter, Opacity, PictureError};

/// Pixels of a bleed per px without a given resolution, which is 300 in an inch; and the most pixels that a bleed gets.
const PRINTED: f64 = 300.0 / 96.0;
const MOST: f64 = 16e6;
/// Distance from the edge, in pixels, at which colours are pure.
const EDGE: usize = 2;

impl EdgePainter for Bender {
    fn opacity(&self, data: &[u8]) -> Option<Opacity> {
        let (width, height) = header_size(data).ok()?;
        count_pixels(&self.budget, Pixel::Decoded, f64::from(width) * f64::from(height)).ok()?;
        let picture = Picture::read_stored_within(data, &self.budget.limits()).ok()?;
        let values = picture.pixmap.pixels().iter().map(|p| p.alpha()).collect();
        Some(Opacity { width: picture.pixmap.width() as usize, values })
    }

    fn continued(&self, drawing: &str, [width, height]: [f64; 2]) -> Result<Vec<u8>, PictureError> {
        let scale: f64 = self.dpi().map_or(PRINTED, |dpi| dpi / 96.0).min((MOST / (width * height)).sqrt());
        let pixels = (width * scale).ceil().max(1.0);
        count_picture(&self.budget, Pixel::Warped, (pixels, (height * scale).ceil())).map_err(too_much)?;
        let read = ReadOptions::default().with_system_fonts(false).with_turned(Some(Picture::turned));
        let tree = pathwarp_svg::usvg_tree::parse_tree(drawing.as_bytes(), "the artwork", &read);
        let tree = tree.map_err(|e| e.to_string())?;
        let options = RenderOptions { size: Size::Width(pixels as u32), background: None };
        let mut drawn = options.render_counted(&tree, &self.budget).map_err(|e| e.to_string())?;
        let (width, height) = (drawn.width() as usize, drawn.height() as usize);
        // Pixels at edges mix in the colours below.
        let opaque = |x: usize, y: usize| drawn.pixels()[y * width + x].alpha() == 255;
        let inside = |i: usize| {
            let (x, y) = (i % width, i / width);
            let room =
                (EDGE..width.saturating_sub(EDGE)).contains(&x) && (EDGE..height.saturating_sub(EDGE)).contains(&y);
            room && [(x - EDGE, y), (x + EDGE, y), (x, y - EDGE), (x, y + EDGE), (x, y)]
                .iter()
                .all(|p| opaque(p.0, p.1))
        };
        let inside: Vec<bool> = (0..width * height).map(inside).collect();
        continue_colors(&mut drawn, &inside);
        Ok(encode_png(&drawn).map_err(|e| e.to_string())?)
    }
}

/// Gives every pixel the colour of the nearest one that counts (`counts`). Those are opaque.
pub(crate) fn continue_colors(picture: &mut Pixmap, counts: &[bool]) {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let nearest = nearest(width, height, |i| counts[i]);
    let pixels = picture.pixels_mut();
    // A pixel that counts is its nearest one, so no colour is overwritten before it is read.
    for (i, from) in nearest.into_iter().enumerate().filter(|(_, from)| *from != NONE) {
        pixels[i] = pixels[from as usize];
    }
}

/// Stands for no pixel.
const NONE: u32 = u32::MAX;

/// For each pixel, the nearest one that counts: two passes that propagate the neighbours' distances (P.-E. Danielsson, Euclidean Distance
/// Mapping, 1980), exact but for a fraction of a pixel.
fn nearest(width: usize, height: usize, counts: impl Fn(usize) -> bool) -> Vec<u32> {
    let mut found: Vec<u32> = (0..width * height).map(|i| if counts(i) { i as u32 } else { NONE }).collect();
    let far = |i: usize, from: u32| {
        if from == NONE {
            return usize::MAX;
        }
        let from = from as usize;
        let [dx, dy] = [(i % width).abs_diff(from % width), (i / width).abs_diff(from / width)];
        dx * dx + dy * dy
    };
    let mut take = |i: usize, neighbor: usize| {
        if far(i, found[neighbor]) < far(i, found[i]) {
            found[i] = found[neighbor];
        }
    };
    let mut pass = |y: usize, beside: Option<usize>| {
        for x in 0..width {
            if let Some(beside) = beside {
                let columns = x.saturating_sub(1)..(x + 2).min(width);
                columns.for_each(|c| take(y * width + x, beside * width + c));
            }
        }
        (1..width).for_each(|x| take(y * width + x, y * width + x - 1));
        (1..width).rev().for_each(|x| take(y * width + x - 1, y * width + x));
    };
    (0..height).for_each(|y| pass(y, y.checked_sub(1)));
    (0..height).rev().for_each(|y| pass(y, Some(y + 1).filter(|y| *y < height)));
    found
}

#[cfg(test)]
mod tests {
    use super::nearest;

    /// Compares the distances with those found by trying all pixels.
    #[test]
    fn pixels_find_the_nearest() {
        let (width, height) = (31, 23);
        let counts = |i: usize| i % 97 == 5 || i % 211 == 60;
        let distance = |i: usize, j: usize| {
            ((i % width) as f64 - (j % width) as f64).hypot((i / width) as f64 - (j / width) as f64)
        };
        for (i, from) in nearest(width, height, counts).into_iter().enumerate() {
            let least =
                (0..width * height).filter(|j| counts(*j)).map(|j| distance(i, j)).fold(f64::INFINITY, f64::min);
            assert!(distance(i, from as usize) < least + 0.3, "{i}");
        }
    }
}
