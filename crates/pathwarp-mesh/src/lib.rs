//! Maps vector artwork to a surface in space and writes it as Wavefront OBJ: a mesh of the filled shapes, or their outlines as
//! polylines.
//!
//! The artwork is flattened in the plane until its image in space is within the tolerance and triangulated (by lyon's sweep-line
//! tessellator). Then edges of triangles are halved until they follow the surface; both triangles at an edge are split alike, so
//! the mesh has no cracks.
//!
//! In space x points right, y down and z away from the viewer. OBJ files have y up and z towards the viewer, as modelling programs
//! expect, in user units of the drawing.
//!
//! ```
//! use pathwarp::Outline;
//! use pathwarp::budget::Budget;
//! use pathwarp_mesh::{NamedShape, filled};
//!
//! let square = Outline::from_svg("M0,0 H10 V10 H0 Z").unwrap();
//! let bowl = |p: pathwarp::kurbo::Point| Some([p.x, p.y, 0.01 * (p.x * p.x + p.y * p.y)]);
//! let obj = filled(&[NamedShape { name: "square", outline: &square, even_odd: false }], &bowl, 0.01, &Budget::default())?;
//! assert!(obj.lines().filter(|l| l.starts_with("f ")).count() > 8);
//! # Ok::<(), pathwarp_mesh::Error>(())
//! ```

mod error;
mod flatten;
mod obj;
mod refine;
mod shape;
mod tessellate;

pub use error::Error;
pub use shape::{NamedShape, Point3, SurfaceFn};
pub use tessellate::FlatMesh;

use obj::ObjWriter;
use pathwarp::budget::Budget;

/// Returns the filled shapes as a mesh in OBJ format. The midpoint of every edge is within `tolerance` (user units) of the surface.
///
/// `budget` counts the sides of the triangles as segments.
///
/// # Errors
/// A point has no image on the surface, or a shape needs too many triangles.
pub fn filled(
    shapes: &[NamedShape<'_>],
    space: &SurfaceFn<'_>,
    tolerance: f64,
    budget: &Budget,
) -> Result<String, Error> {
    let mut out = ObjWriter::new();
    for s in shapes {
        let polygons = flatten::polygons(s, space, tolerance, budget)?;
        let mesh = tessellate::fill(s, &polygons)?;
        let mesh = refine::to_surface(s.name, mesh, space, tolerance, budget)?;
        out.mesh(s.name, &mesh);
    }
    Ok(out.finish())
}

/// Fills a shape with triangles in the plane of the drawing, within `tolerance` (user units) of its outline.
///
/// # Errors
/// The shape needs too many points, or cannot be filled.
pub fn flat(shape: &NamedShape<'_>, tolerance: f64, budget: &Budget) -> Result<FlatMesh, Error> {
    let polygons = flatten::polygons(shape, &|p| Some([p.x, p.y, 0.0]), tolerance, budget)?;
    tessellate::fill(shape, &polygons)
}

/// Returns the outlines of the shapes as polylines in OBJ format, within `tolerance` (user units) of their images in space.
///
/// # Errors
/// A point has no image on the surface, or the shapes need more segments than `budget` has.
pub fn outlines(
    shapes: &[NamedShape<'_>],
    space: &SurfaceFn<'_>,
    tolerance: f64,
    budget: &Budget,
) -> Result<String, Error> {
    let mut out = ObjWriter::new();
    for s in shapes {
        let mut lines = Vec::new();
        for polygon in flatten::polygons(s, space, tolerance, budget)? {
            let place = |p: &pathwarp::kurbo::Point| {
                space(*p).ok_or_else(|| Error::NoPlace { shape: s.name.to_owned(), at: *p })
            };
            let points: Result<Vec<Point3>, Error> = polygon.points.iter().map(place).collect();
            lines.push((points?, polygon.closed));
        }
        out.polylines(s.name, &lines);
    }
    Ok(out.finish())
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::Outline;
    use pathwarp::kurbo::Point;

    /// Parses vertices and faces of an OBJ file, in the orientation of the drawing.
    fn read(obj: &str) -> (Vec<Point3>, Vec<[usize; 3]>) {
        let numbers = |l: &str| -> Vec<f64> { l.split(' ').skip(1).map(|w| w.parse().unwrap()).collect() };
        let v = obj.lines().filter(|l| l.starts_with("v ")).map(numbers).map(|n| [n[0], -n[1], -n[2]]).collect();
        let f = obj.lines().filter(|l| l.starts_with("f ")).map(numbers);
        (v, f.map(|n| [n[0] as usize - 1, n[1] as usize - 1, n[2] as usize - 1]).collect())
    }

    fn area(a: Point3, b: Point3, c: Point3) -> f64 {
        let (u, v) = ([b[0] - a[0], b[1] - a[1], b[2] - a[2]], [c[0] - a[0], c[1] - a[1], c[2] - a[2]]);
        let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        0.5 * (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt()
    }

    const RING: &str = "M60,30 A30,30 0 1 1 0,30 A30,30 0 1 1 60,30 Z M45,30 A15,15 0 1 0 15,30 A15,15 0 1 0 45,30 Z";

    #[test]
    fn a_ring_rolled_on_a_cylinder_keeps_its_area_and_its_hole() {
        // Rolling preserves lengths, so the area of the mesh tends to the flat one: π(30² − 15²).
        const RADIUS: f64 = 25.0;
        let roll = |p: Point| {
            let (s, c) = (p.x / RADIUS).sin_cos();
            Some([RADIUS * s, p.y, RADIUS * (1.0 - c)])
        };
        let ring = Outline::from_svg(RING).unwrap();
        let truth = std::f64::consts::PI * (900.0 - 225.0);
        let mut last = f64::INFINITY;
        for tolerance in [1.0, 0.1, 0.01] {
            let obj = filled(
                &[NamedShape { name: "ring", outline: &ring, even_odd: false }],
                &roll,
                tolerance,
                &Budget::default(),
            )
            .unwrap();
            let (v, f) = read(&obj);
            let got: f64 = f.iter().map(|t| area(v[t[0]], v[t[1]], v[t[2]])).sum();
            let off = (got - truth).abs() / truth;
            assert!(off < last && off < 0.2 * tolerance.sqrt(), "{tolerance}: {got} {truth}");
            last = off;
            // Every vertex is on the cylinder, and the midpoint of every edge within the tolerance of it.
            for t in &f {
                for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                    let (a, b) = (v[t[i]], v[t[j]]);
                    let m = [0.5 * (a[0] + b[0]), 0.5 * (a[2] + b[2])];
                    let radius = |x: f64, z: f64| x.hypot(RADIUS - z);
                    assert!((radius(a[0], a[2]) - RADIUS).abs() < 1e-4);
                    assert!((radius(m[0], m[1]) - RADIUS).abs() <= tolerance * 1.01);
                }
            }
            // No cracks: inner edges have two triangles, and edges with one triangle form closed rings.
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
        let obj =
            outlines(&[NamedShape { name: "line", outline: &line, even_odd: false }], &wave, 0.01, &Budget::default())
                .unwrap();
        let (v, _) = read(&obj);
        assert!(v.len() > 10 && obj.lines().filter(|l| l.starts_with("l ")).count() == 1);
        assert!(v.iter().all(|q| (q[2] - 5.0 * (q[0] / 8.0).sin()).abs() < 1e-6));
    }

    #[test]
    fn errors_name_the_shape() {
        let hole = |p: Point| (p.x < 20.0).then_some([p.x, p.y, 0.0]);
        let ring = Outline::from_svg(RING).unwrap();
        let shapes = [NamedShape { name: "ring", outline: &ring, even_odd: true }];
        assert!(
            matches!(filled(&shapes, &hole, 0.1, &Budget::default()), Err(Error::NoPlace { shape, .. }) if shape == "ring")
        );
        let rough = |p: Point| Some([p.x, p.y, (p.x * 1e4).sin() * 1e3]);
        assert!(matches!(filled(&shapes, &rough, 1e-6, &Budget::default()), Err(Error::TooMany { .. })));
    }
}
