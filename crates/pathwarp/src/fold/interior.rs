//! Points inside a filled outline, found in one sweep.

use crate::outline::{Outline, boundary};
use kurbo::{Point, Rect};

/// Flattening tolerance, relative to the diagonal of the outline: far below the spacing of any grid.
const FLATNESS: f64 = 1e-3;

/// Returns the points of an `n` × `n` grid over `bounds` that lie inside the outline by the nonzero rule, row by row. Open subpaths
/// are closed by a line, as SVG fills them.
///
/// Every line of the flattened outline is visited once and recorded in the rows it crosses. The cost is the number of lines
/// plus crossings, where a winding number for each point would cost segments times points.
pub(super) fn interior(outline: &Outline, bounds: Rect, n: usize) -> Vec<Vec<Point>> {
    let mut rows = Rows { bounds, n, crossings: vec![Vec::new(); n] };
    let tolerance = FLATNESS * bounds.width().hypot(bounds.height());
    boundary(outline.to_bez_path(tolerance), tolerance, |a, b| rows.add(a, b));
    rows.points()
}

/// The crossings of each row: abscissa, and 1 for downwards or −1 for upwards.
struct Rows {
    bounds: Rect,
    n: usize,
    crossings: Vec<Vec<(f64, i32)>>,
}

impl Rows {
    fn x(&self, i: usize) -> f64 {
        self.bounds.x0 + self.bounds.width() * (i as f64 + 0.5) / self.n as f64
    }

    fn y(&self, k: usize) -> f64 {
        self.bounds.y0 + self.bounds.height() * (k as f64 + 0.5) / self.n as f64
    }

    /// The first row at or below `y`.
    fn first_from(&self, y: f64) -> usize {
        let k = ((y - self.bounds.y0) / self.bounds.height() * self.n as f64 - 0.5).ceil();
        k.clamp(0.0, self.n as f64) as usize
    }

    /// Records where the line crosses rows.
    fn add(&mut self, a: Point, b: Point) {
        let (top, bottom, direction) = if a.y < b.y { (a, b, 1) } else { (b, a, -1) };
        if top.y < bottom.y {
            for k in self.first_from(top.y)..self.first_from(bottom.y) {
                let t = (self.y(k) - top.y) / (bottom.y - top.y);
                self.crossings[k].push((top.x + (bottom.x - top.x) * t, direction));
            }
        }
    }

    /// The points of every row at which the winding number is not 0.
    fn points(mut self) -> Vec<Vec<Point>> {
        let mut out = Vec::with_capacity(self.n);
        for k in 0..self.n {
            let mut crossings = std::mem::take(&mut self.crossings[k]);
            crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (mut winding, mut next) = (0, 0);
            let mut row = Vec::new();
            for i in 0..self.n {
                let p = Point::new(self.x(i), self.y(k));
                while next < crossings.len() && crossings[next].0 <= p.x {
                    winding += crossings[next].1;
                    next += 1;
                }
                if winding != 0 {
                    row.push(p);
                }
            }
            out.push(row);
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{Shape, Vec2};

    /// kurbo's winding number, computed point by point from the curves, agrees except on the outline itself.
    #[test]
    fn the_sweep_agrees_with_winding_numbers() {
        const N: usize = 24;
        for data in [
            "M0,0 H100 V80 H0 Z M20,20 V60 H80 V20 Z",
            "M50,0 C110,10 90,100 40,90 S-20,10 50,0 Z M30,30 h20 v20 h-20 Z",
            "M0,50 A50,50 0 1 1 100,50 A50,50 0 1 1 0,50 Z",
            "M0,0 L100,0 L0,70 L100,70 Z",
        ] {
            let outline = Outline::from_svg(data).unwrap();
            let bounds = outline.bounding_box().unwrap();
            let path = outline.to_bez_path(1e-6);
            let found = interior(&outline, bounds, N).concat();
            assert!(found.len() > N, "{data}");
            for j in 0..N {
                for i in 0..N {
                    let at = |k: usize, from: f64, size: f64| from + size * (k as f64 + 0.5) / N as f64;
                    let p = Point::new(at(i, bounds.x0, bounds.width()), at(j, bounds.y0, bounds.height()));
                    let near = [-0.2, 0.2].iter().any(|d| path.winding(p + Vec2::new(*d, 0.0)) != path.winding(p));
                    assert!(near || (path.winding(p) != 0) == found.contains(&p), "{data} at {p}");
                }
            }
        }
    }

    #[test]
    fn open_subpaths_are_closed_and_flat_ones_are_empty() {
        let square = Outline::from_svg("M0,0 H10 V10 H0").unwrap();
        assert_eq!(interior(&square, square.bounding_box().unwrap(), 4).concat().len(), 16);
        let line = Outline::from_svg("M0,0 H10").unwrap();
        assert!(interior(&line, line.bounding_box().unwrap(), 4).concat().is_empty());
    }
}
