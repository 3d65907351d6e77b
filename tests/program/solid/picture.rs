//! Pictures of models for tests: the face that is visible in each pixel.

use super::model::Model;

/// A camera that looks from `eye` at `at`.
pub struct Camera {
    pub eye: [f64; 3],
    pub at: [f64; 3],
}

/// Pixels along a side.
const SIDE: usize = 400;
/// Pixels per unit at distance 1: a field of view of about 32°.
const SCALE: f64 = 700.0;

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] - b[k])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    a.map(|v| v / dot(a, a).sqrt())
}

impl Camera {
    /// Returns the number of pixels that show a face, and of those that show another face, or none, in the other picture.
    pub fn differing(&self, a: &Model, b: &Model) -> (usize, usize) {
        let (a, b) = (self.faces(a), self.faces(b));
        let shown = a.iter().zip(&b).filter(|(a, b)| a.is_some() || b.is_some()).count();
        (a.iter().zip(&b).filter(|(a, b)| a != b).count(), shown)
    }

    /// Returns the face in each pixel.
    fn faces(&self, model: &Model) -> Vec<Option<usize>> {
        let forward = unit(minus(self.at, self.eye));
        let right = unit(cross(forward, [0.0, 1.0, 0.0]));
        let up = cross(right, forward);
        let project = |p: [f64; 3]| {
            let v = minus(p, self.eye);
            let depth = dot(v, forward);
            assert!(depth > 0.0);
            let half = SIDE as f64 / 2.0;
            [half + SCALE * dot(v, right) / depth, half - SCALE * dot(v, up) / depth, 1.0 / depth]
        };
        let corners: Vec<[f64; 3]> = model.vertices.iter().map(|p| project(*p)).collect();
        let mut seen = vec![None; SIDE * SIDE];
        let mut nearness = vec![0.0; SIDE * SIDE];
        for (i, face) in model.faces.iter().enumerate() {
            for k in 1..face.len() - 1 {
                let t = [corners[face[0]], corners[face[k]], corners[face[k + 1]]];
                fill(t, &mut |at, near| {
                    if near > nearness[at] {
                        (nearness[at], seen[at]) = (near, Some(i));
                    }
                });
            }
        }
        seen
    }
}

/// Calls `paint` with every pixel whose middle is in a triangle, and the reciprocal depth there.
fn fill([a, b, c]: [[f64; 3]; 3], paint: &mut dyn FnMut(usize, f64)) {
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if area == 0.0 {
        return;
    }
    let bound = |k: usize, f: fn(f64, f64) -> f64| f(f(a[k], b[k]), c[k]).clamp(0.0, SIDE as f64) as usize;
    for y in bound(1, f64::min)..(bound(1, f64::max) + 1).min(SIDE) {
        for x in bound(0, f64::min)..(bound(0, f64::max) + 1).min(SIDE) {
            let (px, py) = (x as f64 + 0.5, y as f64 + 0.5);
            let part = |p: [f64; 3], q: [f64; 3]| ((q[0] - p[0]) * (py - p[1]) - (q[1] - p[1]) * (px - p[0])) / area;
            let (u, v, w) = (part(b, c), part(c, a), part(a, b));
            if u >= 0.0 && v >= 0.0 && w >= 0.0 {
                paint(y * SIDE + x, u * a[2] + v * b[2] + w * c[2]);
            }
        }
    }
}
