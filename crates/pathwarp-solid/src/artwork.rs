//! Maps vector artwork to a surface in space and writes it as Wavefront OBJ: a mesh of the filled shapes, or their outlines as
//! polylines.
//!
//! The artwork is flattened in the plane until its image in space is within the tolerance, and triangulated by lyon's sweep-line
//! tessellator. Then edges of triangles are halved until they follow the surface. Both triangles at an edge are split alike, so that
//! the mesh has no cracks.
//!
//! In space, x points right, y down and z away from the viewer. In OBJ files, y points up and z towards the viewer, as modelling
//! programs expect. Lengths are in user units of the drawing.
//!
//! ```
//! use pathwarp::Outline;
//! use pathwarp::budget::Budget;
//! use pathwarp_solid::artwork::{NamedShape, filled};
//!
//! let square = Outline::from_svg("M0,0 H10 V10 H0 Z").unwrap();
//! let bowl = |p: pathwarp::kurbo::Point| Some([p.x, p.y, 0.01 * (p.x * p.x + p.y * p.y)]);
//! let obj = filled(&[NamedShape { name: "square", outline: &square, even_odd: false }], &bowl, 0.01, &Budget::default())?;
//! assert!(obj.lines().filter(|l| l.starts_with("f ")).count() > 8);
//! # Ok::<(), pathwarp_solid::artwork::Error>(())
//! ```

use crate::mesh::{Edge, edge, from_chord, parts_of_halved, sides};
use lyon_tessellation::geom::euclid::default::Point2D;
use lyon_tessellation::path::Path;
use lyon_tessellation::{BuffersBuilder, FillOptions, FillRule, FillTessellator, FillVertex, VertexBuffers};
use pathwarp::budget::{Budget, Exceeded, cost};
use pathwarp::kurbo::{Point, Rect};
use pathwarp::{Outline, Seg};
use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;

/// A point in space: x, y, z.
pub type Point3 = [f64; 3];

/// Maps points of the drawing to a surface in space. Returns `None` for points without an image.
pub type SurfaceFn<'a> = dyn Fn(Point) -> Option<Point3> + 'a;

/// A named shape of the artwork.
#[derive(Debug, Clone, Copy)]
pub struct NamedShape<'a> {
    /// Name of the object in the file.
    pub name: &'a str,
    /// Outline in the plane of the drawing.
    pub outline: &'a Outline,
    /// Fill rule: even-odd if `true`, else nonzero.
    pub even_odd: bool,
}

/// An error that prevents artwork from becoming a mesh or polylines.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A point of the shape has no image on the surface.
    #[error("{shape} has no image on the surface at {},{}", at.x, at.y)]
    NoPlace {
        /// Name of the shape.
        shape: String,
        /// The point.
        at: Point,
    },
    /// The shapes need too many triangles or points.
    #[error("{shape} takes {exceeded}, as sides of triangles or of polylines")]
    TooMany {
        /// Name of the shape that exceeds the limit.
        shape: String,
        /// The limit.
        exceeded: Exceeded,
    },
    /// The tessellator failed.
    #[error("{shape} cannot be filled with triangles: {why}")]
    Tessellation {
        /// Name of the shape.
        shape: String,
        /// Message of the tessellator.
        why: String,
    },
}

/// Returns the filled shapes as a mesh in OBJ format, every edge within `tolerance` (user units) of the image of its midpoint in the plane.
///
/// `budget` counts the sides of the triangles as segments.
///
/// # Errors
/// [`Error::NoPlace`] when a point has no image on the surface, [`Error::TooMany`] when a shape exceeds the budget,
/// [`Error::Tessellation`] when a shape cannot be filled.
pub fn filled(
    shapes: &[NamedShape<'_>],
    space: &SurfaceFn<'_>,
    tolerance: f64,
    budget: &Budget,
) -> Result<String, Error> {
    scene(&[(shapes.to_vec(), space)], tolerance, budget)
}

/// Writes filled shapes on several surfaces as one mesh in OBJ format.
///
/// # Errors
/// [`Error::NoPlace`], [`Error::TooMany`] or [`Error::Tessellation`] with the name of the first shape that fails.
pub fn scene(
    groups: &[(Vec<NamedShape<'_>>, &SurfaceFn<'_>)],
    tolerance: f64,
    budget: &Budget,
) -> Result<String, Error> {
    let mut out = ObjWriter::new();
    for (s, space) in groups.iter().flat_map(|(shapes, space)| shapes.iter().map(move |s| (s, space))) {
        let flat = fill(s, &polygons(s, space, tolerance, budget)?)?;
        out.mesh(s.name, &to_surface(s.name, flat, space, tolerance, budget)?);
    }
    Ok(out.text)
}

/// Fills a shape with triangles in the plane of the drawing, within `tolerance` (user units) of its outline.
///
/// # Errors
/// [`Error::TooMany`] when the shape exceeds the budget, [`Error::Tessellation`] when it cannot be filled.
pub fn flat(shape: &NamedShape<'_>, tolerance: f64, budget: &Budget) -> Result<FlatMesh, Error> {
    fill(shape, &polygons(shape, &|p| Some([p.x, p.y, 0.0]), tolerance, budget)?)
}

/// Returns the outlines of the shapes as polylines in OBJ format, within `tolerance` (user units) of their images in space.
///
/// # Errors
/// [`Error::NoPlace`] when a point has no image on the surface, [`Error::TooMany`] when the shapes exceed the budget.
pub fn outlines(
    shapes: &[NamedShape<'_>],
    space: &SurfaceFn<'_>,
    tolerance: f64,
    budget: &Budget,
) -> Result<String, Error> {
    let mut out = ObjWriter::new();
    for s in shapes {
        let mut lines = Vec::new();
        for polygon in polygons(s, space, tolerance, budget)? {
            let points: Result<Vec<Point3>, Error> = polygon.points.iter().map(|p| image(s.name, space, *p)).collect();
            lines.push((points?, polygon.closed));
        }
        out.polylines(s.name, &lines);
    }
    Ok(out.text)
}

/// Returns the image of a point of a shape on the surface.
fn image(shape: &str, space: &SurfaceFn<'_>, p: Point) -> Result<Point3, Error> {
    space(p).ok_or_else(|| Error::NoPlace { shape: shape.to_owned(), at: p })
}

/// Maximum number of halvings of a segment. Its parts then count as within the tolerance.
const MAX_HALVINGS: u32 = 14;

/// A polygon or polyline in the plane of the drawing.
struct Polygon {
    points: Vec<Point>,
    closed: bool,
}

/// Flattens all subpaths of a shape.
fn polygons(
    shape: &NamedShape<'_>,
    space: &SurfaceFn<'_>,
    tolerance: f64,
    budget: &Budget,
) -> Result<Vec<Polygon>, Error> {
    let mut out = Vec::new();
    for sub in &shape.outline.subpaths {
        let mut points = vec![sub.start];
        for seg in &sub.segs {
            let before = points.len();
            flatten(seg, &|p| image(shape.name, space, p), tolerance, &mut points)?;
            spend(shape.name, (points.len() - before) as f64, budget)?;
        }
        if sub.closed && points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        out.push(Polygon { points, closed: sub.closed });
    }
    Ok(out)
}

/// Charges the budget for segments of a shape.
fn spend(shape: &str, segments: f64, budget: &Budget) -> Result<(), Error> {
    let spent = budget.spend(cost::SEGMENT * segments);
    spent.map_err(|exceeded| Error::TooMany { shape: shape.to_owned(), exceeded })
}

/// Appends points of a segment, without its first, whose chords are within `tolerance` of the image.
fn flatten(
    seg: &Seg,
    image: &impl Fn(Point) -> Result<Point3, Error>,
    tolerance: f64,
    out: &mut Vec<Point>,
) -> Result<(), Error> {
    // Parameter ranges with their numbers of halvings. Curves start with quarters, so that a symmetric bend is not missed.
    let mut stack: Vec<(f64, f64, u32)> = match seg {
        Seg::Line(_) => vec![(0.0, 1.0, 0)],
        _ => (0..4).rev().map(|i| (0.25 * f64::from(i), 0.25 * f64::from(i + 1), 2)).collect(),
    };
    while let Some((a, b, depth)) = stack.pop() {
        let (from, to) = (image(seg.eval(a))?.into(), image(seg.eval(b))?.into());
        let mut error: f64 = 0.0;
        for k in [0.25, 0.5, 0.75] {
            error = error.max(from_chord(from, to, image(seg.eval(a + k * (b - a)))?.into()));
        }
        if error <= tolerance || depth >= MAX_HALVINGS {
            out.push(seg.eval(b));
        } else {
            let m = 0.5 * (a + b);
            stack.push((m, b, depth + 1));
            stack.push((a, m, depth + 1));
        }
    }
    Ok(())
}

/// Triangles in the plane of the drawing.
#[derive(Debug)]
pub struct FlatMesh {
    /// Vertices.
    pub points: Vec<Point>,
    /// Indices of the corners of triangles, all of one orientation.
    pub triangles: Vec<[u32; 3]>,
}

/// Triangulates a filled shape.
fn fill(shape: &NamedShape<'_>, polygons: &[Polygon]) -> Result<FlatMesh, Error> {
    let all = polygons.iter().flat_map(|p| &p.points);
    let bounds = all.fold(None, |r: Option<Rect>, p| Some(r.map_or(Rect::from_points(*p, *p), |r| r.union_pt(*p))));
    let empty = FlatMesh { points: Vec::new(), triangles: Vec::new() };
    let Some(b) = bounds else { return Ok(empty) };
    let size = b.width().max(b.height());
    if size == 0.0 {
        return Ok(empty);
    }
    // The tessellator works in single precision, in a box of size 1 about the origin.
    let c = b.center();
    let mut path = Path::builder();
    for polygon in polygons.iter().filter(|p| p.points.len() > 2) {
        let to_unit = |p: &Point| Point2D::new(((p.x - c.x) / size) as f32, ((p.y - c.y) / size) as f32);
        path.begin(to_unit(&polygon.points[0]));
        for p in &polygon.points[1..] {
            path.line_to(to_unit(p));
        }
        // Filling closes every subpath.
        path.end(true);
    }
    let mut buffers: VertexBuffers<Point, u32> = VertexBuffers::new();
    let rule = if shape.even_odd { FillRule::EvenOdd } else { FillRule::NonZero };
    let vertex = |v: FillVertex<'_>| {
        let p = v.position();
        Point::new(f64::from(p.x) * size + c.x, f64::from(p.y) * size + c.y)
    };
    FillTessellator::new()
        .tessellate_path(
            &path.build(),
            &FillOptions::default().with_fill_rule(rule),
            &mut BuffersBuilder::new(&mut buffers, vertex),
        )
        .map_err(|e| Error::Tessellation { shape: shape.name.to_owned(), why: e.to_string() })?;
    Ok(FlatMesh { points: buffers.vertices, triangles: buffers.indices.as_chunks().0.to_vec() })
}

/// Number of sides per triangle of a mesh, since two triangles share a side.
const SIDES: f64 = 1.5;
/// Maximum number of rounds of halving, which gives at most 2^20 parts per edge. They then count as within the tolerance.
const MAX_ROUNDS: usize = 20;

/// Triangles in space.
struct TriangleMesh {
    points: Vec<Point3>,
    triangles: Vec<[u32; 3]>,
}

/// Maps a flat mesh to the surface and subdivides it until it follows the surface.
fn to_surface(
    name: &str,
    flat: FlatMesh,
    space: &SurfaceFn<'_>,
    tolerance: f64,
    budget: &Budget,
) -> Result<TriangleMesh, Error> {
    let charge = |triangles: usize| spend(name, SIDES * triangles as f64, budget);
    let FlatMesh { points: mut sources, mut triangles } = flat;
    let images: Result<Vec<Point3>, Error> = sources.iter().map(|p| image(name, space, *p)).collect();
    let mut points = images?;
    charge(triangles.len())?;
    // Edges whose middles are within the tolerance.
    let mut fine: HashSet<Edge> = HashSet::new();
    for _ in 0..MAX_ROUNDS {
        let mut middles: HashMap<Edge, u32> = HashMap::new();
        for (a, b) in sides(&triangles) {
            let e = edge(a, b);
            if fine.contains(&e) || middles.contains_key(&e) {
                continue;
            }
            let (a, b) = (e.0 as usize, e.1 as usize);
            let m = sources[a].midpoint(sources[b]);
            let q = image(name, space, m)?;
            if from_chord(points[a].into(), points[b].into(), q.into()) <= tolerance {
                fine.insert(e);
            } else {
                middles.insert(e, points.len() as u32);
                sources.push(m);
                points.push(q);
            }
        }
        if middles.is_empty() {
            return Ok(TriangleMesh { points, triangles });
        }
        let mut finer = Vec::with_capacity(triangles.len() * 2);
        for t in &triangles {
            let halves = [0, 1, 2].map(|i| middles.get(&edge(t[i], t[(i + 1) % 3])).copied());
            let corner = |k: usize| if k < 3 { t[k] } else { halves[k - 3].unwrap_or_default() };
            finer.extend(parts_of_halved(halves.map(|h| h.is_some())).iter().map(|part| part.map(corner)));
        }
        charge(finer.len() - triangles.len())?;
        triangles = finer;
    }
    Ok(TriangleMesh { points, triangles })
}

/// The text of an OBJ file, and the number of its vertices.
struct ObjWriter {
    text: String,
    vertices: usize,
}

impl ObjWriter {
    fn new() -> Self {
        Self { text: String::from("# pathwarp: x right, y up, z towards the viewer; user units\n"), vertices: 0 }
    }

    fn object(&mut self, name: &str) {
        // Many readers end names at white space.
        let name: String = name.chars().map(|c| if c.is_whitespace() || c.is_control() { '_' } else { c }).collect();
        let _ = writeln!(self.text, "o {name}");
    }

    fn vertex(&mut self, p: &Point3) {
        // Subtracting avoids negative zeros.
        let _ = writeln!(self.text, "v {} {} {}", p[0], 0.0 - p[1], 0.0 - p[2]);
    }

    fn mesh(&mut self, name: &str, mesh: &TriangleMesh) {
        if mesh.triangles.is_empty() {
            return;
        }
        self.object(name);
        for p in &mesh.points {
            self.vertex(p);
        }
        let first = self.vertices as u64 + 1;
        for t in &mesh.triangles {
            let [a, b, c] = t.map(|i| u64::from(i) + first);
            let _ = writeln!(self.text, "f {a} {b} {c}");
        }
        self.vertices += mesh.points.len();
    }

    fn polylines(&mut self, name: &str, lines: &[(Vec<Point3>, bool)]) {
        self.object(name);
        for (points, closed) in lines.iter().filter(|(p, _)| p.len() > 1) {
            for p in points {
                self.vertex(p);
            }
            self.text.push('l');
            for i in (0..points.len()).chain(closed.then_some(0)) {
                let _ = write!(self.text, " {}", self.vertices + i + 1);
            }
            self.text.push('\n');
            self.vertices += points.len();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
            // No cracks: inner edges have two triangles, and edges of one triangle form closed rings.
            let mut edges = HashMap::new();
            for t in &f {
                for (i, j) in [(0, 1), (1, 2), (2, 0)] {
                    *edges.entry((t[i].min(t[j]), t[i].max(t[j]))).or_insert(0) += 1;
                }
            }
            assert!(edges.values().all(|n| *n <= 2));
            let mut ends = HashMap::new();
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
