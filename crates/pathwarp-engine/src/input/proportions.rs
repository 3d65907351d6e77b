//! The proportions of a rectangle in a photograph: its four corners and the picture's centre, at which the camera points, determine the
//! ratio of width to height and the camera's focal length.
//!
//! Method: Z. Zhang and L.-W. He, *Whiteboard scanning and image enhancement*, Digital Signal Processing 17 (2007). With
//! corners (x, y, 1) from the middle, m₁ upper left, m₂ upper right, m₃ lower left, m₄ lower right:
//!
//! - k₂ = (m₁ × m₄)·m₃ / (m₂ × m₄)·m₃ and k₃ = (m₁ × m₄)·m₂ / (m₃ × m₄)·m₂, where (a × b)·c is twice the area of triangle abc,
//! - n₂ = k₂ m₂ − m₁ and n₃ = k₃ m₃ − m₁ are the directions of width and height, seen by a camera of focal length 1,
//! - they are at right angles: f² = −(n₂ₓ n₃ₓ + n₂ᵧ n₃ᵧ) / (n₂z n₃z),
//! - (width / height)² = ((n₂ₓ² + n₂ᵧ²) / f² + n₂z²) / ((n₃ₓ² + n₃ᵧ²) / f² + n₃z²).

use crate::readable::three_figures;
use pathwarp::kurbo::{Point, Rect, Vec2};
use serde::Serialize;

/// Focal lengths of cameras, in diagonals of the picture, from action cameras to long telephoto lenses.
const LENSES: std::ops::RangeInclusive<f64> = 0.5..=3.0;
/// The largest relative change of the ratio that one pixel at one corner may cause.
const SENSITIVITY: f64 = 0.03;
/// The diagonal of 35 mm film in mm, the reference for stated focal lengths.
const FILM: f64 = 43.27;

/// A rectangle that a camera sees.
#[derive(Debug, Clone, Copy, Serialize)]
pub(crate) struct Proportions {
    /// Ratio of width to height.
    pub ratio: f64,
    /// The camera's focal length, in diagonals of the picture.
    pub focal_length: f64,
}

impl Proportions {
    /// Finds the rectangle with these corners, counterclockwise from the lower left, in a picture of this area, if a camera may see one so.
    pub(super) fn seen(corners: [Point; 4], picture: Rect) -> Option<Self> {
        let [lower_left, lower_right, upper_right, upper_left] = corners.map(|p| p - picture.center());
        let (m1, m2, m3, m4) = (upper_left, upper_right, lower_left, lower_right);
        let twice_area = |a: Vec2, b: Vec2, c: Vec2| (b - a).cross(c - a);
        let k2 = twice_area(m1, m4, m3) / twice_area(m2, m4, m3);
        let k3 = twice_area(m1, m4, m2) / twice_area(m3, m4, m2);
        let (n2, n2z) = (k2 * m2 - m1, k2 - 1.0);
        let (n3, n3z) = (k3 * m3 - m1, k3 - 1.0);
        let f_squared = -n2.dot(n3) / (n2z * n3z);
        let length = |n: Vec2, z: f64| (n.hypot2() / f_squared + z * z).sqrt();
        let ratio = length(n2, n2z) / length(n3, n3z);
        let focal_length = f_squared.sqrt() / picture.width().hypot(picture.height());
        (ratio.is_normal() && focal_length.is_normal()).then_some(Self { ratio, focal_length })
    }

    /// Returns `true` if the focal length is a camera's, and one pixel at a corner hardly changes the ratio.
    pub(super) fn is_sound(&self, corners: [Point; 4], picture: Rect) -> bool {
        // The logarithm of the ratio, relative to this one, if a corner is shifted.
        let log_ratio = |corner: usize, shift: Vec2| {
            let mut corners = corners;
            corners[corner] += shift;
            Self::seen(corners, picture).map_or(f64::INFINITY, |p| (p.ratio / self.ratio).ln())
        };
        // Its derivative by the corner, as a difference over one pixel.
        let change = |corner: usize| {
            let along = |pixel: Vec2| log_ratio(corner, 0.5 * pixel) - log_ratio(corner, -0.5 * pixel);
            along(Vec2::new(1.0, 0.0)).hypot(along(Vec2::new(0.0, 1.0)))
        };
        LENSES.contains(&self.focal_length) && (0..4).all(|corner| change(corner) < SENSITIVITY)
    }

    /// Reports the ratio, with 1 for the shorter side, and the focal length in a line.
    pub(crate) fn note(&self) -> String {
        let term = |v: f64| three_figures(v.max(1.0));
        format!(
            "--crop: width to height is {} : {}, as seen with a focal length of {} mm on 35 mm film; --ratio says otherwise",
            term(self.ratio),
            term(1.0 / self.ratio),
            three_figures(FILM * self.focal_length)
        )
    }
}
