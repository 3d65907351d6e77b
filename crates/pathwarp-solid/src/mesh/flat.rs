//! Shapes in the plane as triangles, and their extrusion into solids.
//!
//! Before extrusion, a shape is changed so that no two vertices coincide and the outline does not touch itself. Walls of the solid would
//! otherwise share an edge there.

use super::{Corner, Mark, Mesh, NONE, PolygonKind, index32};
use glam::DVec3;
use std::collections::{BTreeMap, HashMap, HashSet};

/// A shape in the plane, filled with triangles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FlatShape {
    /// Name.
    pub name: String,
    /// Vertices, y up.
    pub points: Vec<[f64; 2]>,
    /// Triangles as indices into `points`, all counter-clockwise or all clockwise.
    pub triangles: Vec<[u32; 3]>,
}

/// Distance between vertices, as a fraction of the largest coordinate, below which they would coincide in a single-precision file.
const COINCIDENT: f64 = 1e-6;
/// Least distance by which such vertices are moved, as a fraction of the largest coordinate.
const APART: f64 = 1e-5;

impl FlatShape {
    /// Returns twice the area, negative if the triangles are clockwise.
    fn doubled_area(&self) -> f64 {
        let doubled = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| self.point(i));
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        self.triangles.iter().map(doubled).sum()
    }

    fn point(&self, i: u32) -> [f64; 2] {
        self.points[i as usize]
    }

    fn largest_coordinate(&self) -> f64 {
        self.points.iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()))
    }

    /// Adds the vertices and triangles of another shape.
    fn append(&mut self, other: &Self) {
        let first = self.points.len() as u32;
        self.points.extend_from_slice(&other.points);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| first + i)));
    }

    /// Returns the shape with counter-clockwise triangles, without triangles that repeat a vertex. Triangles without area stay: they hold
    /// the shape together.
    fn counter_clockwise(&self) -> Self {
        let is_clockwise = self.doubled_area() < 0.0;
        let triangles = self.triangles.iter().map(|&[a, b, c]| if is_clockwise { [a, c, b] } else { [a, b, c] });
        Self { triangles: triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect(), ..self.clone() }
    }

    /// Returns the shape with coinciding vertices moved apart, each towards the middle of the triangles around it.
    fn separated(mut self) -> Self {
        let step = COINCIDENT * self.largest_coordinate();
        // The first vertex in each cell of a grid; only vertices in adjacent cells can coincide.
        let mut first: HashMap<[i64; 2], u32> = HashMap::new();
        // Each coinciding vertex, with its number among those at its position, and its triangles.
        let mut crowded: BTreeMap<u32, (u32, Vec<usize>)> = BTreeMap::new();
        let mut counts: HashMap<u32, u32> = HashMap::new();
        for (i, p) in (0u32..).zip(&self.points) {
            let [x, y] = p.map(|v| (v / step).floor() as i64);
            let mut near = (-1..=1).flat_map(|a| (-1..=1).map(move |b| [x.saturating_add(a), y.saturating_add(b)]));
            if let Some(other) = near.find_map(|c| first.get(&c).copied()) {
                let count = counts.entry(other).or_default();
                *count += 1;
                crowded.entry(other).or_default();
                crowded.entry(i).or_default().0 = *count;
            } else {
                first.insert([x, y], i);
            }
        }
        for (n, t) in self.triangles.iter().enumerate() {
            for i in t {
                if let Some((_, fan)) = crowded.get_mut(i) {
                    fan.push(n);
                }
            }
        }
        let (old, distance) = (self.clone(), APART * self.largest_coordinate());
        for (vertex, (number, fan)) in crowded {
            // Move by 1 to 16.5 times the distance, since the triangles of two vertices may lie on one side.
            let distance = distance * (1.0 + 0.5 * f64::from(number % 32));
            self.points[vertex as usize] = moved_inwards(&old, vertex, &fan, distance);
        }
        self
    }

    /// Returns the shape in which parts that meet at a single vertex have a vertex each, moved apart.
    fn unpinched(mut self) -> Self {
        // The ends of the outline's sides, by the vertex at which they start.
        let mut starts: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (a, b) in outline_sides(&self.triangles) {
            starts.entry(a).or_default().push(b);
        }
        starts.retain(|_, next| next.len() > 1);
        // The triangles at these vertices, each under its vertex and the corner that follows it in the triangle.
        let mut after: HashMap<(u32, u32), usize> = HashMap::new();
        for (n, t) in self.triangles.iter().enumerate() {
            let corners = (0..3).map(|k| (t[k], t[(k + 1) % 3])).filter(|(a, _)| starts.contains_key(a));
            corners.for_each(|side| _ = after.insert(side, n));
        }
        let (old, distance) = (self.clone(), APART * self.largest_coordinate());
        for (vertex, parts) in starts {
            for (k, first) in parts.into_iter().enumerate() {
                let fan = triangles_round(&old, &after, vertex, first);
                let point = moved_inwards(&old, vertex, &fan, distance);
                let new = if k == 0 { vertex } else { self.points.len() as u32 };
                if k == 0 {
                    self.points[vertex as usize] = point;
                } else {
                    self.points.push(point);
                }
                for n in fan {
                    let corner = old.triangles[n].iter().position(|i| *i == vertex).unwrap_or_default();
                    self.triangles[n][corner] = new;
                }
            }
        }
        self
    }
}

pub(crate) fn sides(triangles: &[[u32; 3]]) -> impl Iterator<Item = (u32, u32)> {
    triangles.iter().flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])])
}

/// Iterates over the sides that no triangle passes in reverse. They form the outline, with the shape to its left.
fn outline_sides(triangles: &[[u32; 3]]) -> impl Iterator<Item = (u32, u32)> {
    let all: HashSet<(u32, u32)> = sides(triangles).collect();
    sides(triangles).filter(move |(a, b)| !all.contains(&(*b, *a)))
}

/// Returns the triangles round a vertex, from the side to `first` as far as the next side of the outline.
fn triangles_round(shape: &FlatShape, after: &HashMap<(u32, u32), usize>, vertex: u32, first: u32) -> Vec<usize> {
    let mut out: Vec<usize> = Vec::new();
    let mut next = first;
    // Where several triangles claim a side, this could go round for ever.
    while let Some(n) = after.get(&(vertex, next)).filter(|_| out.len() < shape.triangles.len()) {
        let t = shape.triangles[*n];
        let corner = t.iter().position(|i| *i == vertex).unwrap_or_default();
        out.push(*n);
        next = t[(corner + 2) % 3];
        if next == first {
            break;
        }
    }
    out
}

/// Returns the position of a vertex after a move by `distance` towards the middle of its triangles.
fn moved_inwards(shape: &FlatShape, vertex: u32, fan: &[usize], distance: f64) -> [f64; 2] {
    let from = shape.point(vertex);
    let others = fan.iter().flat_map(|n| shape.triangles[*n]).filter(|i| *i != vertex);
    let mut sum = [0.0; 2];
    for p in others.map(|i| shape.point(i)) {
        // A corner at the same point gives NaN, and the vertex stays.
        let length = (p[0] - from[0]).hypot(p[1] - from[1]);
        (0..2).for_each(|a| sum[a] += (p[a] - from[a]) / length);
    }
    let length = sum[0].hypot(sum[1]);
    if length > 0.0 { [0, 1].map(|a| from[a] + distance * sum[a] / length) } else { from }
}

/// Appends shapes as objects: flat at z = 0 if `depth` is 0, closed solids from z = 0 to `depth` if it is larger, with a front, a back and
/// walls between them. Where solids would touch themselves or each other in an edge or at a corner, vertices move apart, by some
/// hundred-thousandths of the largest coordinate. Indices that need more than 32 bits become [`NONE`].
pub fn extrude(mesh: &mut Mesh, shapes: &[FlatShape], depth: f64) {
    let mut all = FlatShape::default();
    let mut ends = Vec::with_capacity(shapes.len());
    for shape in shapes {
        all.append(&shape.counter_clockwise());
        ends.push(all.triangles.len());
    }
    let all = if depth == 0.0 { all } else { all.unpinched().separated() };
    // The first vertices at z = 0 and at z = `depth`.
    let back = index32(mesh.positions.len());
    let front = back.saturating_add(index32(all.points.len()));
    let layer = |z: f64| all.points.iter().map(move |[x, y]| DVec3::new(*x, *y, z));
    mesh.positions.extend(layer(0.0));
    if depth != 0.0 {
        mesh.positions.extend(layer(depth));
    }
    let corner = |first: u32, i: u32| Corner { vertex: first.saturating_add(i), uv: NONE, normal: NONE };
    let mut from = 0;
    for (shape, to) in shapes.iter().zip(ends) {
        let triangles = &all.triangles[std::mem::replace(&mut from, to)..to];
        mesh.mark(Mark::Object(shape.name.clone()));
        if depth == 0.0 {
            triangles.iter().for_each(|t| mesh.push(PolygonKind::Face, t.map(|i| corner(back, i))));
            continue;
        }
        for [a, b, c] in triangles {
            mesh.push(PolygonKind::Face, [*a, *b, *c].map(|i| corner(front, i)));
            mesh.push(PolygonKind::Face, [*a, *c, *b].map(|i| corner(back, i)));
        }
        for (a, b) in outline_sides(triangles) {
            mesh.push(PolygonKind::Face, [corner(back, a), corner(back, b), corner(front, b), corner(front, a)]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Mesh, topology};

    /// Two squares that touch at a corner, with one vertex there or two, and a shape with a slit: every solid is closed.
    #[test]
    fn touching_parts_become_solids() {
        let points =
            vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0], [1.0, 1.0]];
        for corner in [2, 7] {
            let triangles = vec![[0, 1, 2], [0, 2, 3], [corner, 4, 5], [corner, 5, 6]];
            let shape = FlatShape { name: "corners".into(), points: points.clone(), triangles };
            let mut mesh = Mesh::default();
            extrude(&mut mesh, &[shape], 1.0);
            let t = topology(&mesh);
            assert!(t.is_closed() && t.euler() == 4 && (t.volume - 2.0).abs() < 1e-4, "{t:?}");
        }
        let points = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [2.0, 0.5]];
        let shape = FlatShape { name: "slit".into(), points, triangles: vec![[0, 1, 2], [0, 2, 3], [4, 6, 5]] };
        let mut mesh = Mesh::default();
        extrude(&mut mesh, &[shape], 1.0);
        let t = topology(&mesh);
        assert!(t.is_closed() && t.euler() == 4 && (t.volume - 1.5).abs() < 1e-4, "{t:?}");
        // Two shapes with a common side.
        let square = |x: f64| FlatShape {
            name: "square".into(),
            points: vec![[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        };
        let mut mesh = Mesh::default();
        extrude(&mut mesh, &[square(3.0), square(4.0)], 1.0);
        let t = topology(&mesh);
        assert!(t.is_closed() && t.euler() == 4 && (t.volume - 2.0).abs() < 1e-3 && mesh.marks.len() == 2, "{t:?}");
    }

    #[test]
    fn a_frame_becomes_a_ring() {
        // A square with a square hole, as eight triangles, given clockwise.
        let p = |r: f64| [[-r, -r], [r, -r], [r, r], [-r, r]];
        let points = [p(2.0), p(1.0)].concat();
        let triangles = (0..4u32)
            .flat_map(|i| {
                let j = (i + 1) % 4;
                [[i, i + 4, j], [j, i + 4, j + 4]]
            })
            .collect();
        let shape = FlatShape { name: "frame".into(), points, triangles };
        let mut mesh = Mesh::default();
        extrude(&mut mesh, std::slice::from_ref(&shape), 0.5);
        let t = topology(&mesh);
        assert!(t.is_closed() && t.euler() == 0 && (t.volume - 6.0).abs() < 1e-12, "{t:?}");
        let mut flat = Mesh::default();
        extrude(&mut flat, &[shape], 0.0);
        let t = topology(&flat);
        assert!((t.open_edges, t.faces) == (8, 8) && (t.area - 12.0).abs() < 1e-12, "{t:?}");
    }
}
