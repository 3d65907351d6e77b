//! Traces the opaque area of a picture.

use pathwarp::Outline;
use pathwarp::kurbo::Point;
use std::collections::HashMap;

/// The opacity of a picture's pixels, row by row, from 0 to 255.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Opacity {
    /// Number of pixels in a row.
    pub width: usize,
    /// The opacity of each pixel.
    pub values: Vec<u8>,
}

/// The opacity along the outline: one half.
const HALF: f64 = 127.5;

impl Opacity {
    /// Returns `true` if all pixels are more than half opaque.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.values.iter().all(|v| f64::from(*v) > HALF)
    }

    /// Polygons along which the picture is half opaque, in pixels, by marching squares: opacity changes linearly between the centres of
    /// neighbouring pixels, and is 0 beyond the picture's edge.
    ///
    /// ```
    /// use pathwarp_svg::engine::Opacity;
    ///
    /// let one = Opacity { width: 3, values: vec![0, 0, 0, 0, 255, 0, 0, 0, 0] }.traced();
    /// assert_eq!(one.bounding_box().unwrap(), pathwarp::kurbo::Rect::new(1.0, 1.0, 2.0, 2.0));
    /// ```
    #[must_use]
    pub fn traced(&self) -> Outline {
        let height = self.values.len() / self.width.max(1);
        // The grid has a border of transparent pixels.
        let value = |x: usize, y: usize| {
            let inside = (1..=self.width).contains(&x) && (1..=height).contains(&y);
            if inside { f64::from(self.values[(y - 1) * self.width + x - 1]) } else { 0.0 }
        };
        // The crossing on an edge of the grid, which is identified by its first end and its direction: to the right (0) or down (1).
        let crossing = |&(x, y, down): &(usize, usize, usize)| {
            let (a, b) = (value(x, y), value(x + 1 - down, y + down));
            let t = (HALF - a) / (b - a);
            let [dx, dy] = if down == 1 { [0.0, t] } else { [t, 0.0] };
            Point::new(x as f64 - 0.5 + dx, y as f64 - 0.5 + dy)
        };
        // The edge of the grid that follows another one along the outline.
        let mut next = HashMap::new();
        for y in 0..=height {
            for x in 0..=self.width {
                let corners = [value(x, y), value(x + 1, y), value(x + 1, y + 1), value(x, y + 1)].map(|v| v > HALF);
                let edges = [(x, y, 0), (x + 1, y, 1), (x, y + 1, 0), (x, y, 1)];
                // Opaque pixels lie to the right of the outline, which separates two diagonally opposite ones.
                for i in (0..4).filter(|i| corners[*i] && !corners[(i + 3) % 4]) {
                    // Number of opaque corners in a row from corner i, around the cell.
                    let run = (1..4).find(|k| !corners[(i + k) % 4]).unwrap_or(1);
                    next.insert(edges[(i + run + 3) % 4], edges[(i + 3) % 4]);
                }
            }
        }
        let mut starts: Vec<_> = next.keys().copied().collect();
        starts.sort_unstable();
        let mut out = Outline::default();
        for start in starts {
            let (mut ring, mut edge) = (Vec::new(), start);
            while let Some(to) = next.remove(&edge) {
                ring.push(crossing(&edge));
                edge = to;
            }
            if ring.len() > 2 {
                out.subpaths.extend(Outline::from_points(&ring, true).subpaths);
            }
        }
        out
    }
}
