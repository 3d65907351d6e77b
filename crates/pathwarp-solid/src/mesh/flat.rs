//! A shape in the plane as triangles, and its preparation for a solid: no two vertices in one place, and none at which the outline touches
//! itself, since walls of the solid would meet there in one edge.

use std::collections::{BTreeMap, HashMap, HashSet};

/// A shape in the plane, filled with triangles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FlatShape {
    /// Its name.
    pub name: String,
    /// Vertices, y up.
    pub points: Vec<[f64; 2]>,
    /// Triangles, all counter-clockwise or all clockwise.
    pub triangles: Vec<[u32; 3]>,
}

/// Vertices that are closer, as a share of the largest coordinate, would be one in a file in single precision.
const SAME: f64 = 1e-6;
/// They are drawn apart by this share.
const APART: f64 = 1e-5;

impl FlatShape {
    /// Twice the area, negative if the triangles are clockwise.
    pub(super) fn area(&self) -> f64 {
        let twice = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| self.at(i));
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        self.triangles.iter().map(twice).sum()
    }

    fn at(&self, i: u32) -> [f64; 2] {
        self.points.get(i as usize).copied().unwrap_or_default()
    }

    /// The largest coordinate.
    fn reach(&self) -> f64 {
        self.points.iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()))
    }

    /// The sides of the triangles.
    pub(super) fn sides(&self) -> impl Iterator<Item = (u32, u32)> {
        self.triangles.iter().flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])])
    }

    /// The same shape, counter-clockwise, without triangles of fewer than three vertices. Those without area stay, as they keep the
    /// shape together.
    pub(super) fn turned(&self) -> Self {
        let turned = self.area() < 0.0;
        let own = |[a, b, c]: [u32; 3]| if turned { [a, c, b] } else { [a, b, c] };
        let triangles =
            self.triangles.iter().copied().map(own).filter(|[a, b, c]| a != b && b != c && c != a).collect();
        Self { triangles, ..self.clone() }
    }

    /// The same shape with vertices in one place drawn apart, each into the middle of its own triangles.
    pub(super) fn separated(mut self) -> Self {
        let step = SAME * self.reach();
        let cell = |p: &[f64; 2]| p.map(|v| (v / step).floor() as i64);
        let mut first: HashMap<[i64; 2], u32> = HashMap::new();
        let mut crowded: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (i, p) in (0u32..).zip(&self.points) {
            let [x, y] = cell(p);
            let near = (-1..=1).flat_map(|a| (-1..=1).map(move |b| [x.saturating_add(a), y.saturating_add(b)]));
            let other = near.filter_map(|c| first.get(&c).copied()).next();
            if let Some(other) = other {
                crowded.entry(other).or_default();
                crowded.entry(i).or_default();
            } else {
                first.insert([x, y], i);
            }
        }
        for (n, t) in self.triangles.iter().enumerate() {
            for i in t {
                if let Some(fan) = crowded.get_mut(i) {
                    fan.push(n);
                }
            }
        }
        let (old, by) = (self.clone(), APART * self.reach());
        for (k, (vertex, fan)) in crowded.into_iter().enumerate() {
            // By different lengths, as their triangles may lie on one side.
            let by = by * (1.0 + 0.25 * (k % 4) as f64);
            self.points[vertex as usize] = drawn_back(&old, vertex, &fan, by);
        }
        self
    }

    /// The same shape with a vertex for each of the parts that meet in one only, drawn apart.
    pub(super) fn unpinched(mut self) -> Self {
        let all: HashSet<(u32, u32)> = self.sides().collect();
        let mut starts: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (a, b) in self.sides().filter(|(a, b)| !all.contains(&(*b, *a))) {
            starts.entry(a).or_default().push(b);
        }
        starts.retain(|_, next| next.len() > 1);
        // The triangles at each such vertex, by the corner that follows it.
        let mut after: HashMap<(u32, u32), usize> = HashMap::new();
        for (n, t) in self.triangles.iter().enumerate() {
            let corners = (0..3).map(|k| (t[k], t[(k + 1) % 3])).filter(|(a, _)| starts.contains_key(a));
            corners.for_each(|side| _ = after.insert(side, n));
        }
        let (old, by) = (self.clone(), APART * self.reach());
        for (vertex, parts) in starts {
            for (k, first) in parts.into_iter().enumerate() {
                let fan = fan(&old, &after, vertex, first);
                let at = drawn_back(&old, vertex, &fan, by);
                let own = if k == 0 {
                    self.points[vertex as usize] = at;
                    vertex
                } else {
                    self.points.push(at);
                    u32::try_from(self.points.len() - 1).unwrap_or(u32::MAX)
                };
                for n in fan {
                    let corner = old.triangles[n].iter().position(|i| *i == vertex).unwrap_or_default();
                    self.triangles[n][corner] = own;
                }
            }
        }
        self
    }
}

/// The triangles round a vertex from the side to `next` to the next side of the outline.
fn fan(shape: &FlatShape, after: &HashMap<(u32, u32), usize>, vertex: u32, first: u32) -> Vec<usize> {
    let mut out: Vec<usize> = Vec::new();
    let mut next = first;
    // Sides that several triangles claim could lead in circles.
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

/// A vertex, drawn into the middle of its triangles.
fn drawn_back(shape: &FlatShape, vertex: u32, fan: &[usize], by: f64) -> [f64; 2] {
    let at = shape.at(vertex);
    let others = fan.iter().flat_map(|n| shape.triangles[*n]).filter(|i| *i != vertex);
    let mut sum = [0.0; 2];
    for p in others.map(|i| shape.at(i)) {
        let length = (p[0] - at[0]).hypot(p[1] - at[1]);
        (0..2).for_each(|a| sum[a] += (p[a] - at[a]) / length);
    }
    let length = sum[0].hypot(sum[1]);
    if length > 0.0 { [0, 1].map(|a| at[a] + by * sum[a] / length) } else { at }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Mesh, extrude, topology};

    /// Two squares that touch in a corner, one vertex there or two, and a slit in a third: each solid is one for itself.
    #[test]
    fn touching_parts_become_solids() {
        let points =
            vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0], [1.0, 1.0]];
        for corner in [2, 7] {
            let triangles = vec![[0, 1, 2], [0, 2, 3], [corner, 4, 5], [corner, 5, 6]];
            let shape = FlatShape { name: "corners".into(), points: points.clone(), triangles };
            let mut mesh = Mesh::default();
            extrude(&mut mesh, &shape, 1.0);
            let t = topology(&mesh);
            assert!(t.is_closed() && t.euler() == 4 && (t.volume - 2.0).abs() < 1e-4, "{t:?}");
        }
        let points = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [2.0, 0.5]];
        let shape = FlatShape { name: "slit".into(), points, triangles: vec![[0, 1, 2], [0, 2, 3], [4, 6, 5]] };
        let mut mesh = Mesh::default();
        extrude(&mut mesh, &shape, 1.0);
        let t = topology(&mesh);
        assert!(t.is_closed() && t.euler() == 4 && (t.volume - 1.5).abs() < 1e-4, "{t:?}");
    }
}
