//! The opaque parts of pictures, and the colours beyond the edge of a drawing.

use crate::bitmap::{Bender, PX_PER_INCH, Pixel, count_picture, count_pixels, too_much};
use pathwarp_raster::{Picture, Pixmap, RenderOptions, Size, encode_png, header_size};
use pathwarp_svg::ReadOptions;
use pathwarp_svg::engine::{EdgePainter, Opacity, PictureError};

/// Pixels per inch of a bleed unless a resolution is given: that of prints.
const PRINT_DPI: f64 = 300.0;
/// Most pixels of a bleed.
const MOST: f64 = 16e6;
/// Distance from the edge, in pixels, at which the colours below are no longer mixed in.
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
        let scale = (self.dpi.unwrap_or(PRINT_DPI) / PX_PER_INCH).min((MOST / (width * height)).sqrt());
        let pixels = (width * scale).ceil().max(1.0);
        count_picture(&self.budget, Pixel::Warped, (pixels, (height * scale).ceil())).map_err(too_much)?;
        let read = ReadOptions::default().with_system_fonts(false).with_turned(Some(Picture::turned));
        let tree = pathwarp_svg::usvg_tree::parse_tree(drawing.as_bytes(), "the artwork", &read);
        let tree = tree.map_err(|e| e.to_string())?;
        let options = RenderOptions { size: Size::Width(pixels as u32), background: None };
        let mut drawn = options.render_counted(&tree, &self.budget).map_err(|e| e.to_string())?;
        let (width, height) = (drawn.width() as usize, drawn.height() as usize);
        let is_opaque = |(x, y): (usize, usize)| drawn.pixels()[y * width + x].alpha() == 255;
        let is_pure = |i: usize| {
            let (x, y) = (i % width, i / width);
            let has_room = |v: usize, size: usize| (EDGE..size.saturating_sub(EDGE)).contains(&v);
            let around = || [(x - EDGE, y), (x + EDGE, y), (x, y - EDGE), (x, y + EDGE), (x, y)];
            has_room(x, width) && has_room(y, height) && around().into_iter().all(is_opaque)
        };
        let are_pure: Vec<bool> = (0..width * height).map(is_pure).collect();
        continue_colors(&mut drawn, &are_pure);
        Ok(encode_png(&drawn).map_err(|e| e.to_string())?)
    }
}

/// Gives every pixel the colour of the nearest source. Sources are opaque pixels, marked in `are_sources`.
pub(crate) fn continue_colors(picture: &mut Pixmap, are_sources: &[bool]) {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let nearest = nearest(width, height, |i| are_sources[i]);
    let pixels = picture.pixels_mut();
    // A source is its own nearest source, so no colour is overwritten before it is read.
    for (i, from) in nearest.into_iter().enumerate().filter(|(_, from)| *from != NONE) {
        pixels[i] = pixels[from as usize];
    }
}

/// Stands for no pixel.
const NONE: u32 = u32::MAX;

/// Returns the nearest source of each pixel: two passes that propagate the neighbours' sources (P.-E. Danielsson, Euclidean Distance
/// Mapping, 1980), exact but for a fraction of a pixel.
fn nearest(width: usize, height: usize, is_source: impl Fn(usize) -> bool) -> Vec<u32> {
    let mut found: Vec<u32> = (0..width * height).map(|i| if is_source(i) { i as u32 } else { NONE }).collect();
    let squared_distance = |i: usize, from: u32| {
        if from == NONE {
            return usize::MAX;
        }
        let from = from as usize;
        let [dx, dy] = [(i % width).abs_diff(from % width), (i / width).abs_diff(from / width)];
        dx * dx + dy * dy
    };
    let mut take = |i: usize, neighbor: usize| {
        if squared_distance(i, found[neighbor]) < squared_distance(i, found[i]) {
            found[i] = found[neighbor];
        }
    };
    let mut update_row = |y: usize, row_before: Option<usize>| {
        for (x, row) in (0..width).flat_map(|x| row_before.map(|row| (x, row))) {
            let columns = x.saturating_sub(1)..(x + 2).min(width);
            columns.for_each(|column| take((y * width) + x, (row * width) + column));
        }
        (1..width).for_each(|x| take((y * width) + x, (y * width) + x - 1));
        (1..width).rev().for_each(|x| take((y * width) + x - 1, (y * width) + x));
    };
    (0..height).for_each(|y| update_row(y, y.checked_sub(1)));
    (0..height).rev().for_each(|y| update_row(y, Some(y + 1).filter(|y| *y < height)));
    found
}

#[cfg(test)]
mod tests {
    use super::nearest;

    /// Compares the distances with those found by trying all pixels.
    #[test]
    fn pixels_find_the_nearest() {
        let (width, height) = (31, 23);
        let is_source = |i: usize| i % 97 == 5 || i % 211 == 60;
        let distance = |i: usize, j: usize| {
            ((i % width) as f64 - (j % width) as f64).hypot((i / width) as f64 - (j / width) as f64)
        };
        for (i, from) in nearest(width, height, is_source).into_iter().enumerate() {
            let distances = (0..width * height).filter(|j| is_source(*j)).map(|j| distance(i, j));
            let least = distances.fold(f64::INFINITY, f64::min);
            assert!(distance(i, from as usize) < least + 0.3, "{i}");
        }
    }
}
