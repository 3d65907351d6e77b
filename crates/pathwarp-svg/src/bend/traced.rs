//! Traces the opaque area of a picture.

use pathwarp::Outline;
use pathwarp::engine::{GridEdge, marching_squares};
use pathwarp::kurbo::Point;

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
        let crossing = |&(x, y, is_down): &GridEdge| {
            let [dx, dy] = if is_down { [0, 1] } else { [1, 0] };
            let (a, b) = (value(x, y), value(x + dx, y + dy));
            let t = (HALF - a) / (b - a);
            let [dx, dy] = if is_down { [0.0, t] } else { [t, 0.0] };
            Point::new(x as f64 - 0.5 + dx, y as f64 - 0.5 + dy)
        };
        let mut out = Outline::default();
        for edges in marching_squares([self.width + 1, height + 1], |x, y| value(x, y) > HALF) {
            let ring: Vec<Point> = edges.iter().map(crossing).collect();
            if ring.len() > 2 {
                out.subpaths.extend(Outline::from_points(&ring, true).subpaths);
            }
        }
        out
    }
}
