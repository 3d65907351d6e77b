//! The tiles of the result that a picture touches.

use super::image_warp::ImageWarp;
use kurbo::{Affine, Point, Rect};
use pathwarp::map::{Creases, Map};
use tiny_skia::Pixmap;

/// Number of cells along a side of the picture.
const CELLS: usize = 192;

/// The tiles of the result that the picture touches. Other tiles must not ask the inverse, which may have values for them: a
/// projective inverse also maps points beyond the horizon.
pub(super) struct Reach {
    touched: Vec<bool>,
    columns: usize,
}

impl Reach {
    pub(super) fn new(warp: &ImageWarp<'_>, to_target: Affine, tile: usize) -> Self {
        let (columns, rows) = (tiles(warp.size.0, tile), tiles(warp.size.1, tile));
        let mut out = Self { touched: vec![false; columns * rows], columns };
        let corners = images(warp.source, warp.placed, warp.map, to_target);
        for pair in corners.windows(2) {
            for i in 0..CELLS {
                let cell = [pair[0][i], pair[0][i + 1], pair[1][i], pair[1][i + 1]];
                out.touch(cell, tile, rows);
            }
        }
        out
    }

    /// Marks the tiles around the image of a cell. If some of its corners have no image, its neighbours cover most of it.
    fn touch(&mut self, cell: [Point; 4], tile: usize, rows: usize) {
        let mut defined = cell.into_iter().filter(|p| p.is_finite());
        let Some(first) = defined.next() else { return };
        let b = defined.fold(Rect::from_origin_size(first, (0.0, 0.0)), |b, p| b.union_pt(p));
        // Allow for curved sides and for partly covered pixels at the edge.
        let b = b.inflate(2.0 + 0.5 * b.width(), 2.0 + 0.5 * b.height());
        let index = |v: f64, most: usize| ((v / tile as f64).max(0.0) as usize).min(most);
        if b.x1 < 0.0 || b.y1 < 0.0 || b.x0 > (self.columns * tile) as f64 || b.y0 > (rows * tile) as f64 {
            return;
        }
        for row in index(b.y0, rows - 1)..=index(b.y1, rows - 1) {
            let columns = index(b.x0, self.columns - 1)..=index(b.x1, self.columns - 1);
            self.touched[row * self.columns..][columns].fill(true);
        }
    }

    pub(super) fn touches(&self, column: usize, row: usize) -> bool {
        self.touched[row * self.columns + column]
    }
}

fn tiles(pixels: u32, tile: usize) -> usize {
    (pixels as usize).div_ceil(tile)
}

/// Maps a grid over the picture to pixels of the result.
fn images(source: &Pixmap, placed: Affine, map: &dyn Map, to_target: Affine) -> Vec<Vec<Point>> {
    let (width, height) = (f64::from(source.width()), f64::from(source.height()));
    let mut creases = Creases::default();
    map.creases(&mut creases);
    let row = |j: usize| {
        let v = height * j as f64 / CELLS as f64;
        let places: Vec<Point> = (0..=CELLS).map(|i| placed * Point::new(width * i as f64 / CELLS as f64, v)).collect();
        let mut out = vec![Point::ORIGIN; places.len()];
        map.points(&places, &mut out);
        let defined = places.iter().zip(out);
        defined
            .map(|(p, q)| if creases.defined_at(*p) { to_target * q } else { Point::new(f64::NAN, f64::NAN) })
            .collect()
    };
    (0..=CELLS).map(row).collect()
}
