//! The cells of a picture that a shape covers: what lies in other cells is never seen.

use super::area::PixelArea;
use kurbo::{Affine, BezPath, Point, Rect};
use pathwarp::outline::boundary;

/// Side of a cell in pixels.
const CELL: usize = 8;
/// Flattening tolerance in pixels.
const FLAT: f64 = 0.25;
/// Reach of a pixel in pixels: renderers read up to two on either side of a place.
const MARGIN: f64 = 2.0 + FLAT;

/// For every cell, `true` if the shape touches it or comes near.
pub(super) struct Cover {
    columns: usize,
    cells: Vec<bool>,
}

impl Cover {
    /// `shown` maps the pixels of a picture of the given size to the shape's plane.
    pub(super) fn of(shape: &BezPath, shown: Affine, (width, height): (u32, u32)) -> Self {
        let [columns, rows] = [width, height].map(|n| (n as usize).div_ceil(CELL));
        let mut cover = Self { columns, cells: vec![false; columns * rows] };
        let mut windings = vec![0_i32; columns * rows];
        boundary(&(shown.inverse() * shape), FLAT, |a, b| {
            cover.touch(a, b, rows);
            wind(a, b, &mut windings, columns);
        });
        // A cell without edges is all inside or all outside. Where windings cancel under the even-odd rule, too much is covered.
        for (cell, winding) in cover.cells.iter_mut().zip(windings) {
            *cell |= winding != 0;
        }
        cover
    }

    /// The smallest area within one that holds all of its cells that are seen. `None` if there are none.
    pub(super) fn seen(&self, area: PixelArea) -> Option<PixelArea> {
        let cells = |from: usize, size: usize| from / CELL..(from + size).div_ceil(CELL);
        let (mut from, mut to) = ([usize::MAX; 2], [0; 2]);
        for j in cells(area.top, area.height) {
            for i in cells(area.left, area.width) {
                if self.cells.get(j * self.columns + i).is_none_or(|seen| *seen) {
                    from = [from[0].min(i), from[1].min(j)];
                    to = [to[0].max(i + 1), to[1].max(j + 1)];
                }
            }
        }
        let [left, top] = [(from[0].saturating_mul(CELL)).max(area.left), (from[1].saturating_mul(CELL)).max(area.top)];
        let [right, bottom] = [(to[0] * CELL).min(area.left + area.width), (to[1] * CELL).min(area.top + area.height)];
        (left < right && top < bottom).then(|| PixelArea { left, top, width: right - left, height: bottom - top })
    }

    /// Marks the cells near a line.
    fn touch(&mut self, a: Point, b: Point, rows: usize) {
        let pieces = (a.distance(b) / CELL as f64).ceil().clamp(1.0, (self.columns + rows) as f64) as usize;
        for k in 0..pieces {
            let at = |k: usize| a.lerp(b, k as f64 / pieces as f64);
            let near = Rect::from_points(at(k), at(k + 1)).inflate(MARGIN, MARGIN);
            let range = |from: f64, to: f64, n: usize| {
                let cell = |v: f64| (v.max(0.0) / CELL as f64) as usize;
                if to < 0.0 { 0..0 } else { cell(from).min(n)..(cell(to) + 1).min(n) }
            };
            for j in range(near.y0, near.y1, rows) {
                for i in range(near.x0, near.x1, self.columns) {
                    self.cells[j * self.columns + i] = true;
                }
            }
        }
    }
}

/// Adds a line to the winding numbers of the middles of cells to its right.
fn wind(a: Point, b: Point, windings: &mut [i32], columns: usize) {
    let (top, bottom, direction) = if a.y < b.y { (a, b, 1) } else { (b, a, -1) };
    let slope = (bottom.x - top.x) / (bottom.y - top.y);
    // The first cell whose middle is not before a place.
    let first = |v: f64| (v / CELL as f64 - 0.5).ceil().max(0.0) as usize;
    for (j, row) in windings.chunks_mut(columns).enumerate().take(first(bottom.y)).skip(first(top.y)) {
        let y = (j as f64 + 0.5) * CELL as f64;
        row.iter_mut().skip(first(top.x + slope * (y - top.y))).for_each(|w| *w += direction);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Shape as _;

    /// Agrees with kurbo's winding numbers at every pixel: no pixel within reach of one inside is left out.
    #[test]
    fn no_seen_pixel_is_left_out() {
        for (data, most) in [
            ("M200,20 C320,40 300,180 160,190 S20,60 200,20 Z M150,80 v40 h40 v-40 Z", 0.75),
            ("M10,10 L310,195 L300,199 L5,20 Z", 0.45),
            ("M5,5 H315 V195 H5 Z", 1.0),
        ] {
            let path = BezPath::from_svg(data).unwrap();
            let (shown, size) = (Affine::new([0.5, 0.0, 0.0, 0.5, 3.0, -2.0]), (640, 416));
            let path = Affine::translate((3.0, -2.0)) * path;
            let cover = Cover::of(&path, shown, size);
            let (mut covered, mut all) = (0, 0);
            for (j, i) in (0..size.1).flat_map(|j| (0..size.0).map(move |i| (j, i))) {
                let held = cover.seen(PixelArea { left: i as usize, top: j as usize, width: 1, height: 1 }).is_some();
                all += 1;
                covered += i32::from(held);
                let near = [(0.0, 0.0), (-2.0, -2.0), (2.0, -2.0), (-2.0, 2.0), (2.0, 2.0)];
                let seen = near.iter().any(|(x, y)| {
                    let pixel = Point::new(f64::from(i) + 0.5 + x, f64::from(j) + 0.5 + y);
                    path.winding(shown * pixel) != 0
                });
                assert!(held || !seen, "{data}: {i},{j}");
            }
            assert!(f64::from(covered) <= most * f64::from(all), "{data}: {covered} of {all}");
        }
    }
}
