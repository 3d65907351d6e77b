//! Pictures of meshes, drawn by a small rasterizer with a depth buffer and shading.

use crate::mesh::{Mark, Mesh, PolygonKind, fan};
use crate::settings::Box3;
use glam::{DMat3, DVec3};

/// A perspective camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera3 {
    eye: DVec3,
    /// Rows: the directions right, up and forward.
    axes: DMat3,
    /// Half the height of the view at distance 1.
    half: f64,
}

/// Depth below which nothing is drawn, as a fraction of the distance to the middle of the scene, or in [`draw`] of the greatest depth.
const NEAR: f64 = 1e-3;

impl Camera3 {
    /// Makes a camera at `eye` that looks at the middle of a box and shows all of it, y up. `None` unless the box is in front of the eye.
    #[must_use]
    pub fn at(eye: DVec3, scene: Box3) -> Option<Self> {
        /// Height of the view as a multiple of the scene's, which leaves a margin.
        const MARGIN: f64 = 1.04;
        let to_middle = scene.center() - eye;
        let forward = to_middle.try_normalize()?;
        // Seen straight from above, the back of the scene is at the top of the picture.
        let right = forward.cross(DVec3::Y).try_normalize().unwrap_or(DVec3::X);
        let axes = DMat3::from_cols(right, right.cross(forward), forward).transpose();
        let mut half: f64 = 0.0;
        for p in scene.corners().map(|p| axes * (p - eye)) {
            if p.z <= NEAR * to_middle.length() {
                return None;
            }
            half = half.max(p.x.abs().max(p.y.abs()) / p.z);
        }
        Some(Self { eye, axes, half: half * MARGIN })
    }

    /// Makes a camera that looks at the middle of a box from this direction, twice the box's diagonal away.
    #[must_use]
    pub fn towards(direction: DVec3, scene: Box3) -> Option<Self> {
        Self::at(scene.center() + direction.try_normalize()? * 2.0 * scene.diagonal(), scene)
    }

    /// Returns the position of a point in a square picture of `side` pixels, and its depth.
    fn project(&self, p: DVec3, side: f64) -> DVec3 {
        let q = self.axes * (p - self.eye);
        let k = 0.5 * side / (self.half * q.z);
        DVec3::new(0.5 * side + k * q.x, 0.5 * side - k * q.y, q.z)
    }
}

/// Colours of objects, in turn: red, green, blue.
const PALETTE: [[f64; 3]; 6] = [
    [0.36, 0.55, 0.76],
    [0.87, 0.56, 0.29],
    [0.45, 0.68, 0.43],
    [0.80, 0.43, 0.45],
    [0.58, 0.47, 0.70],
    [0.62, 0.55, 0.45],
];
/// Colour of back faces, which are seen through openings or where a map turned faces over.
const INSIDE: [f64; 3] = [0.75, 0.72, 0.68];
const GUIDE: [f64; 3] = [0.80, 0.10, 0.35];
/// Samples along each side of a pixel.
const SAMPLES: usize = 2;

/// Returns the number of samples that [`draw`] examines for a mesh: all in the bounding box of each triangle.
#[must_use]
pub fn samples(mesh: &Mesh, camera: &Camera3, side: usize) -> f64 {
    let fine = (side * SAMPLES) as f64;
    let projected: Vec<DVec3> = mesh.positions.iter().map(|p| camera.project(*p, fine)).collect();
    let triangles = mesh.polygons().flat_map(|(_, corners)| fan(corners));
    // The length of an interval within the picture.
    let length = |v: [f64; 3]| {
        let [min, max] = [v.iter().copied().fold(fine, f64::min), v.iter().copied().fold(0.0, f64::max)];
        (max.min(fine) - min.max(0.0)).max(0.0)
    };
    let corners = triangles.map(|t| t.map(|c| projected[c.vertex as usize]));
    corners.map(|t| length(t.map(|p| p.x)) * length(t.map(|p| p.y))).sum()
}

/// Draws a mesh with guides over it, on white: `side` × `side` opaque pixels of red, green, blue and alpha.
#[must_use]
pub fn draw(mesh: &Mesh, guides: &[Vec<DVec3>], camera: &Camera3, side: usize) -> Vec<u8> {
    let fine = side * SAMPLES;
    let mut canvas = Canvas { side: fine, color: vec![[1.0; 3]; fine * fine], nearness: vec![0.0; fine * fine] };
    let projected: Vec<DVec3> = mesh.positions.iter().map(|p| camera.project(*p, fine as f64)).collect();
    // The direction to the light, which is above the camera to its left.
    let light = camera.axes.transpose() * DVec3::new(-0.4, 0.6, -0.7).normalize();
    let near = NEAR * projected.iter().map(|p| p.z.abs()).fold(0.0, f64::max);
    let mut objects: usize = 0;
    let mut lines = Vec::new();
    let mut marks = mesh.marks.iter().peekable();
    for (n, (kind, corners)) in mesh.polygons().enumerate() {
        while let Some((_, mark)) = marks.next_if(|(first, _)| *first as usize <= n) {
            objects += usize::from(matches!(mark, Mark::Object(_) | Mark::Group(_)));
        }
        let base = PALETTE[objects.saturating_sub(1) % PALETTE.len()];
        if kind == PolygonKind::Line {
            lines.extend(corners.windows(2).map(|w| ([w[0], w[1]].map(|c| projected[c.vertex as usize]), base)));
        }
        if kind != PolygonKind::Face {
            continue;
        }
        for t in fan(corners) {
            let t = t.map(|c| c.vertex as usize);
            let [a, b, c] = t.map(|v| mesh.positions[v]);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let facing = normal.dot(camera.eye - a) >= 0.0;
            let shade = 0.35 + 0.65 * (normal.dot(light) * if facing { 1.0 } else { -1.0 }).max(0.0);
            let color = (if facing { base } else { INSIDE }).map(|v| v * shade);
            if t.iter().all(|v| projected[*v].z > near) {
                canvas.triangle(t.map(|v| projected[v]), color);
            }
        }
    }
    lines.into_iter().for_each(|(ends, color)| canvas.line(ends, near, color));
    for guide in guides {
        for w in guide.windows(2) {
            canvas.line([w[0], w[1]].map(|p| camera.project(p, fine as f64)), near, GUIDE);
        }
    }
    canvas.pixels()
}

struct Canvas {
    side: usize,
    color: Vec<[f64; 3]>,
    /// Reciprocal depths, which are linear in a picture's coordinates.
    nearness: Vec<f64>,
}

impl Canvas {
    fn triangle(&mut self, [a, b, c]: [DVec3; 3], color: [f64; 3]) {
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let limit = self.side as f64;
        let span = |u: f64, v: f64, w: f64| {
            let (from, to) = (u.min(v).min(w).clamp(0.0, limit), u.max(v).max(w).clamp(0.0, limit));
            from as usize..(to.ceil() as usize).min(self.side)
        };
        let (columns, rows) = (span(a.x, b.x, c.x), span(a.y, b.y, c.y));
        for y in rows {
            for x in columns.clone() {
                let (px, py) = (x as f64 + 0.5, y as f64 + 0.5);
                // Barycentric coordinates, as the shares of the triangle's area opposite the corners.
                let share = |p: DVec3, q: DVec3| ((q.x - p.x) * (py - p.y) - (q.y - p.y) * (px - p.x)) / area;
                let (u, v, w) = (share(b, c), share(c, a), share(a, b));
                let nearness = u / a.z + v / b.z + w / c.z;
                let i = y * self.side + x;
                if u >= 0.0 && v >= 0.0 && w >= 0.0 && nearness > self.nearness[i] {
                    (self.nearness[i], self.color[i]) = (nearness, color);
                }
            }
        }
    }

    /// Draws a thin line over everything drawn so far, if the depth of both ends is greater than `near`.
    fn line(&mut self, [a, b]: [DVec3; 2], near: f64, color: [f64; 3]) {
        if a.z <= near || b.z <= near || !(a.is_finite() && b.is_finite()) {
            return;
        }
        let limit = self.side as f64;
        let steps = (b - a).truncate().abs().max_element().ceil().clamp(1.0, 8.0 * limit);
        for i in 0..=steps as usize {
            let p = a.lerp(b, i as f64 / steps);
            if (0.0..limit).contains(&p.x) && (0.0..limit).contains(&p.y) {
                self.color[p.y as usize * self.side + p.x as usize] = color;
            }
        }
    }

    /// Returns the pixels, each the mean of its samples.
    fn pixels(&self) -> Vec<u8> {
        let side = self.side / SAMPLES;
        let mut out = Vec::with_capacity(4 * side * side);
        for y in 0..side {
            for x in 0..side {
                for k in 0..3 {
                    let (top, left) = (y * SAMPLES, x * SAMPLES);
                    let sample = |i: usize| self.color[(top + (i / SAMPLES)) * self.side + left + (i % SAMPLES)][k];
                    let mean = (0..SAMPLES * SAMPLES).map(sample).sum::<f64>() / (SAMPLES * SAMPLES) as f64;
                    out.push((mean.clamp(0.0, 1.0) * 255.0).round() as u8);
                }
                out.push(255);
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::obj;

    #[test]
    fn the_nearer_face_and_lines_are_seen_and_the_background_is_white() {
        let two = "o far\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nl 1 3\nf 1 2 3 4\no near\nv -.5 -.5 1\nv .5 -.5 1\nv .5 .5 1\nv -.5 .5 1\nf 5 6 7 8\n";
        let mesh = obj::read(two.as_bytes()).unwrap();
        let camera = Camera3::at(DVec3::new(0.0, 0.0, 10.0), mesh.bounds().unwrap()).unwrap();
        let picture = draw(&mesh, &[], &camera, 64);
        let at = |x: usize, y: usize| &picture[4 * (y * 64 + x)..][..3];
        assert!(at(32, 32)[0] > at(32, 32)[2], "orange: {:?}", at(32, 32));
        assert!(at(6, 32)[0] < at(6, 32)[2], "blue: {:?}", at(6, 32));
        assert_ne!(at(32, 31), at(36, 32), "the line lies over the faces, which follow it");
        assert_eq!(at(0, 0), [255; 3]);
        assert!(Camera3::at(DVec3::new(0.0, 0.0, 0.5), mesh.bounds().unwrap()).is_none());
    }
}
