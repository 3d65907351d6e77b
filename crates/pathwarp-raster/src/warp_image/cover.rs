//! The tiles of a picture that a shape covers: what lies in other tiles is never seen.

use super::area::TILE;
use kurbo::{Affine, BezPath, Point, Rect};
use pathwarp::outline::boundary;

/// Flattening tolerance in pixels.
const FLAT: f64 = 0.25;
/// Reach of a pixel in pixels: renderers read up to two on either side of a place.
const MARGIN: f64 = 2.0 + FLAT;

/// For every tile, `true` if the shape touches it or comes near.
pub(super) struct Cover {
    columns: usize,
    tiles: Vec<bool>,
}

impl Cover {
    /// `shown` maps the pixels of a picture of the given size to the shape's plane.
    pub(super) fn of(shape: &BezPath, shown: Affine, (width, height): (u32, u32)) -> Self {
        let [columns, rows] = [width, height].map(|n| (n as usize).div_ceil(TILE));
        let mut cover = Self { columns, tiles: vec![false; columns * rows] };
        let mut windings = vec![0_i32; columns * rows];
        boundary(&(shown.inverse() * shape), FLAT, |a, b| {
            cover.touch(a, b, rows);
            wind(a, b, &mut windings, columns);
        });
        // A tile without edges is all inside or all outside. Where windings cancel under the even-odd rule, too much is covered.
        for (tile, winding) in cover.tiles.iter_mut().zip(windings) {
            *tile |= winding != 0;
        }
        cover
    }

    /// Returns `true` if anything in the tile with this first pixel is seen.
    pub(super) fn holds(&self, left: usize, top: usize) -> bool {
        self.tiles.get(top / TILE * self.columns + left / TILE).is_none_or(|seen| *seen)
    }

    /// Marks the tiles near a line.
    fn touch(&mut self, a: Point, b: Point, rows: usize) {
        let pieces = (a.distance(b) / TILE as f64).ceil().clamp(1.0, (self.columns + rows) as f64) as usize;
        for k in 0..pieces {
            let at = |k: usize| a.lerp(b, k as f64 / pieces as f64);
            let near = Rect::from_points(at(k), at(k + 1)).inflate(MARGIN, MARGIN);
            let range = |from: f64, to: f64, n: usize| {
                let tile = |v: f64| (v.max(0.0) / TILE as f64) as usize;
                if to < 0.0 { 0..0 } else { tile(from).min(n)..(tile(to) + 1).min(n) }
            };
            for j in range(near.y0, near.y1, rows) {
                for i in range(near.x0, near.x1, self.columns) {
                    self.tiles[j * self.columns + i] = true;
                }
            }
        }
    }
}

/// Adds a line to the winding numbers of the middles of tiles to its right.
fn wind(a: Point, b: Point, windings: &mut [i32], columns: usize) {
    let (top, bottom, direction) = if a.y < b.y { (a, b, 1) } else { (b, a, -1) };
    let slope = (bottom.x - top.x) / (bottom.y - top.y);
    for (j, row) in windings.chunks_mut(columns).enumerate() {
        let y = (j as f64 + 0.5) * TILE as f64;
        if top.y <= y && y < bottom.y {
            let x = top.x + slope * (y - top.y);
            let first = (x / TILE as f64 - 0.5).ceil().max(0.0) as usize;
            row.iter_mut().skip(first).for_each(|w| *w += direction);
        }
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
                let held = cover.holds(i as usize, j as usize);
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
