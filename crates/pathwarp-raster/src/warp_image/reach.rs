//! Where a picture goes: its image's box, and the tiles of the result that it touches.

use super::{ImageWarp, in_pixels};
use kurbo::{Affine, Point, Rect};
use pathwarp::map::{Creases, Map};
use tiny_skia::Pixmap;

/// Cells along a side of the picture.
const CELLS: usize = 192;

/// How far a picture reaches once it is warped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// The box of its image.
    pub bounds: Rect,
    /// The largest stretch: how many units of length of the image one of the picture's pixels becomes.
    pub stretch: f64,
    /// The smallest.
    pub squeeze: f64,
    /// A place on the picture where the map is not defined.
    pub undefined: Option<Point>,
}

/// How far the box `area` reaches, placed by `placed`, bent by `map` and carried on by `after`: from samples inside and many
/// along the edge. `None` if the map is defined nowhere on it.
#[must_use]
pub fn extent(area: Rect, placed: Affine, map: &dyn Map, after: Affine) -> Option<Extent> {
    const ALONG: usize = 2048;
    let mut creases = Creases::default();
    map.creases(&mut creases);
    let at = |u: f64, v: f64| Point::new(area.x0 + u * area.width(), area.y0 + v * area.height());
    let n = CELLS as f64;
    let inside = (0..=CELLS).flat_map(|j| (0..=CELLS).map(move |i| (i as f64 / n, j as f64 / n)));
    let edge = (0..=ALONG).map(|k| k as f64 / ALONG as f64).flat_map(|t| [(t, 0.0), (t, 1.0), (0.0, t), (1.0, t)]);
    let mut out: Option<Extent> = None;
    let mut undefined = None;
    for (u, v) in inside.chain(edge) {
        let p = placed * at(u, v);
        let jet = in_pixels(&map.jet(p), after, placed);
        if !jet.p.is_finite() || !creases.defined_at(p) {
            undefined = undefined.or(Some(p));
            continue;
        }
        let frobenius = jet.dx.hypot2() + jet.dy.hypot2();
        let apart = (frobenius * frobenius - 4.0 * jet.det() * jet.det()).max(0.0).sqrt();
        let stretch = (0.5 * (frobenius + apart)).sqrt();
        let squeeze = jet.det().abs() / stretch;
        let e = out.get_or_insert(Extent {
            bounds: Rect::from_origin_size(jet.p, (0.0, 0.0)),
            stretch: 0.0,
            squeeze: f64::INFINITY,
            undefined,
        });
        e.bounds = e.bounds.union_pt(jet.p);
        if stretch.is_finite() {
            e.stretch = e.stretch.max(stretch);
            e.squeeze = e.squeeze.min(squeeze);
        }
    }
    out.map(|e| Extent { undefined, ..e })
}

/// The tiles of the result that the picture touches. The others need not ask the inverse, which may well have an answer for
/// them (a projective map sends what lies beyond the horizon back, too).
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

    /// A cell whose corners are not all mapped may reach anywhere near those that are; its neighbours cover most of it.
    fn touch(&mut self, cell: [Point; 4], tile: usize, rows: usize) {
        let mut known = cell.into_iter().filter(|p| p.is_finite());
        let Some(first) = known.next() else { return };
        let b = known.fold(Rect::from_origin_size(first, (0.0, 0.0)), |b, p| b.union_pt(p));
        // Sides bulge, and pixels at the edge are half covered.
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

/// The images of a grid over the picture, in pixels of the result.
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
