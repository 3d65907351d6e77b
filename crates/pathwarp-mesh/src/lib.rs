//! Vector artwork on a surface in space, as Wavefront OBJ: filled shapes as a mesh, or their outlines as polylines.
//!
//! The artwork is flattened in the drawing's plane until its image in space is within the tolerance, filled with triangles (lyon's
//! sweep-line tessellator), and the triangles' edges are halved until they follow the surface. An edge is halved for both its
//! triangles alike, so the mesh has no cracks.
//!
//! Space has x to the right, y down and z away from the viewer; OBJ files are written with y up and z towards the viewer, the
//! way modelling programs expect, in the drawing's user units.
//!
//! ```
//! use pathwarp::Outline;
//! use pathwarp_mesh::{Shape, filled};
//!
//! let square = Outline::from_svg("M0,0 H10 V10 H0 Z").unwrap();
//! let bowl = |p: pathwarp::kurbo::Point| Some([p.x, p.y, 0.01 * (p.x * p.x + p.y * p.y)]);
//! let obj = filled(&[Shape { name: "square", outline: &square, even_odd: false }], &bowl, 0.01)?;
//! assert!(obj.lines().filter(|l| l.starts_with("f ")).count() > 8);
//! # Ok::<(), pathwarp_mesh::Error>(())
//! ```

mod flatten;
mod obj;
mod refine;
mod tessellate;

use pathwarp::Outline;
use pathwarp::kurbo::Point;
use thiserror::Error;

/// A point in space.
pub type Space = [f64; 3];

/// Takes points of the drawing into space; `None` where they have no place there.
pub type IntoSpace<'a> = dyn Fn(Point) -> Option<Space> + 'a;

/// One shape of the artwork.
#[derive(Debug, Clone, Copy)]
pub struct Shape<'a> {
    /// What it is called in the file.
    pub name: &'a str,
    /// Its outline, in the drawing's plane.
    pub outline: &'a Outline,
    /// Whether the even-odd rule fills it (else the nonzero rule).
    pub even_odd: bool,
}

/// Why there is no mesh.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Error {
    /// A point of the shape has no place on the surface.
    #[error("{shape} has no place in space at {},{}: the surface is not met there", at.x, at.y)]
    NoPlace {
        /// The shape.
        shape: String,
        /// A point of it.
        at: Point,
    },
    /// More triangles than are made.
    #[error("{shape} would take more than {most} triangles")]
    TooMany {
        /// The shape.
        shape: String,
        /// The limit.
        most: usize,
    },
    /// The tessellator gave up.
    #[error("{shape} cannot be filled with triangles: {why}")]
    Tessellation {
        /// The shape.
        shape: String,
        /// What it said.
        why: String,
    },
}

/// The filled shapes as a mesh, within `tolerance` (user units) of the surface along every edge's middle.
///
/// # Errors
/// See [`enum@Error`].
pub fn filled(shapes: &[Shape<'_>], space: &IntoSpace<'_>, tolerance: f64) -> Result<String, Error> {
    let mut out = obj::Writer::new();
    for s in shapes {
        let polygons = flatten::polygons(s, space, tolerance)?;
        let mesh = tessellate::fill(s, &polygons)?;
        let mesh = refine::to_surface(s.name, mesh, space, tolerance)?;
        out.mesh(s.name, &mesh);
    }
    Ok(out.finish())
}

/// The shapes' outlines as polylines within `tolerance` (user units) of their images in space.
///
/// # Errors
/// See [`enum@Error`].
pub fn outlines(shapes: &[Shape<'_>], space: &IntoSpace<'_>, tolerance: f64) -> Result<String, Error> {
    let mut out = obj::Writer::new();
    for s in shapes {
        let mut lines = Vec::new();
        for polygon in flatten::polygons(s, space, tolerance)? {
            let place = |p: &Point| space(*p).ok_or_else(|| Error::NoPlace { shape: s.name.to_owned(), at: *p });
            let points: Result<Vec<Space>, Error> = polygon.points.iter().map(place).collect();
            lines.push((points?, polygon.closed));
        }
        out.polylines(s.name, &lines);
    }
    Ok(out.finish())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vertices and faces of an OBJ file, back in the drawing's orientation.
    fn read(obj: &str) -> (Vec<Space>, Vec<[usize; 3]>) {
        let numbers = |l: &str| -> Vec<f64> { l.split(' ').skip(1).map(|w| w.parse().unwrap()).collect() };
        let v = obj.lines().filter(|l| l.starts_with("v ")).map(numbers).map(|n| [n[0], -n[1], -n[2]]).collect();
        let f = obj.lines().filter(|l| l.starts_with("f ")).map(numbers);
        (v, f.map(|n| [n[0] as usize - 1, n[1] as usize - 1, n[2] as usize - 1]).collect())
    }

    fn area(a: Space, b: Space, c: Space) -> f64 {
        let (u, v) = ([b[0] - a[0], b[1] - a[1], b[2] - a[2]], [c[0] - a[0], c[1] - a[1], c[2] - a[2]]);
        let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        0.5 * (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt()
    }

    const RING: &str = "M60,30 A30,30 0 1 1 0,30 A30,30 0 1 1 60,30 Z M45,30 A15,15 0 1 0 15,30 A15,15 0 1 0 45,30 Z";

    #[test]
    fn a_ring_rolled_on_a_cylinder_keeps_its_area_and_its_hole() {
        // Rolling keeps lengths, so the mesh's area tends to the flat one: π(30² − 15²).
        const RADIUS: f64 = 25.0;
        let roll = |p: Point| {
            let (s, c) = (p.x / RADIUS).sin_cos();
            Some([RADIUS * s, p.y, RADIUS * (1.0 - c)])
        };
        let ring = Outline::from_svg(RING).unwrap();
        let truth = std::f64::consts::PI * (900.0 - 225.0);
        let mut last = f64::INFINITY;
        for tolerance in [1.0, 0.1, 0.01] {
            let obj = filled(&[Shape { name: "ring", outline: &ring, even_odd: false }], &roll, tolerance).unwrap();
            let (v, f) = read(&obj);
            let got: f64 = f.iter().map(|t| area(v[t[0]], v[t[1]], v[t[2]])).sum();
            let off = (got - truth).abs() / truth;
            assert!(off < last && off < 0.2 * tolerance.sqrt(), "{tolerance}: {got} {truth}");
            last = off;
            // Every vertex lies on the cylinder, every edge's middle within the tolerance of it.
            for t in &f {
                for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                    let (a, b) = (v[t[i]], v[t[j]]);
                    let m = [0.5 * (a[0] + b[0]), 0.5 * (a[2] + b[2])];
                    let radius = |x: f64, z: f64| x.hypot(RADIUS - z);
                    assert!((radius(a[0], a[2]) - RADIUS).abs() < 1e-4);
                    assert!((radius(m[0], m[1]) - RADIUS).abs() <= tolerance * 1.01);
                }
            }
            // No cracks: an inner edge has two triangles, and those with one form closed rings.
            let mut edges = std::collections::HashMap::new();
            for t in &f {
                for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                    *edges.entry((t[i].min(t[j]), t[i].max(t[j]))).or_insert(0) += 1;
                }
            }
            assert!(edges.values().all(|n| *n <= 2));
            let mut ends = std::collections::HashMap::new();
            for (e, _) in edges.iter().filter(|(_, n)| **n == 1) {
                *ends.entry(e.0).or_insert(0) += 1;
                *ends.entry(e.1).or_insert(0) += 1;
            }
            assert!(ends.values().all(|n| *n == 2));
        }
    }

    #[test]
    fn outlines_follow_the_surface() {
        let wave = |p: Point| Some([p.x, p.y, 5.0 * (p.x / 8.0).sin()]);
        let line = Outline::from_svg("M0,0 H60").unwrap();
        let obj = outlines(&[Shape { name: "line", outline: &line, even_odd: false }], &wave, 0.01).unwrap();
        let (v, _) = read(&obj);
        assert!(v.len() > 10 && obj.lines().filter(|l| l.starts_with("l ")).count() == 1);
        assert!(v.iter().all(|q| (q[2] - 5.0 * (q[0] / 8.0).sin()).abs() < 1e-6));
    }

    #[test]
    fn faults_name_the_shape() {
        let hole = |p: Point| (p.x < 20.0).then_some([p.x, p.y, 0.0]);
        let ring = Outline::from_svg(RING).unwrap();
        let shapes = [Shape { name: "ring", outline: &ring, even_odd: true }];
        assert!(matches!(filled(&shapes, &hole, 0.1), Err(Error::NoPlace { shape, .. }) if shape == "ring"));
        let rough = |p: Point| Some([p.x, p.y, (p.x * 1e4).sin() * 1e3]);
        assert!(matches!(filled(&shapes, &rough, 1e-6), Err(Error::TooMany { .. })));
    }
}
