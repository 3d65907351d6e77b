//! Polygon meshes: vertices, faces of any number of corners, groups, materials, texture coordinates and normals.

mod deform;
mod flat;
pub mod gltf;
pub mod obj;
pub mod ply;
pub mod stl;

use crate::settings::Box3;
use glam::DVec3;
use pathwarp::budget::Exceeded;
use serde_json::{Map, Value};
use std::collections::HashMap;
use std::sync::Arc;
use thiserror::Error;

pub use deform::{Deformed, Undefined3, deform, refine};
pub use flat::{FlatShape, extrude};

pub(crate) use deform::{Edge, edge, from_chord, parts_of_halved};
pub(crate) use flat::sides;

/// Stands for a missing index.
pub const NONE: u32 = u32::MAX;

/// A corner of a polygon: indices of its vertex, texture coordinates and normal. The last two may be [`NONE`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Corner {
    /// Index into [`Mesh::positions`].
    pub vertex: u32,
    /// Index into [`Mesh::uvs`].
    pub uv: u32,
    /// Index into [`Mesh::normals`].
    pub normal: u32,
}

/// The kind of a polygon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PolygonKind {
    /// A face.
    Face,
    /// A polyline.
    Line,
    /// Single points.
    Points,
}

/// A face, polyline or list of points: the corners from the end of the previous polygon to `end`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Polygon {
    /// Index in [`Mesh::corners`] after its last corner.
    pub end: u32,
    /// Kind.
    pub kind: PolygonKind,
}

/// A change of state that holds from one polygon onwards.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Mark {
    /// An object begins.
    Object(String),
    /// The groups change.
    Group(String),
    /// The material changes.
    Material(String),
    /// The smoothing group changes.
    Smoothing(String),
    /// A file of materials is named.
    Library(String),
}

/// A mesh of polygons.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    /// Vertices.
    pub positions: Vec<DVec3>,
    /// Colours of the vertices (red, green, blue, opacity): none, or one for each vertex.
    pub colors: Vec<[f64; 4]>,
    /// Normals.
    pub normals: Vec<DVec3>,
    /// Texture coordinates; the third is 0 unless the file gives it.
    pub uvs: Vec<[f64; 3]>,
    /// The corners of all polygons.
    pub corners: Vec<Corner>,
    /// The polygons, in order.
    pub polygons: Vec<Polygon>,
    /// Marks in order, each with the index of the first polygon it applies to.
    pub marks: Vec<(u32, Mark)>,
    /// Materials of a glTF file, to which the marks refer by name.
    pub assets: Option<Arc<Assets>>,
    /// Contents of the file that the mesh lacks, each as a phrase for a warning.
    pub left_out: Vec<String>,
}

impl Mesh {
    /// Returns `true` if any vertex is translucent.
    #[must_use]
    pub fn is_translucent(&self) -> bool {
        self.colors.iter().any(|c| c[3] != 1.0)
    }

    /// Returns the bounding box of the vertices, or `None` if there are none.
    #[must_use]
    pub fn bounds(&self) -> Option<Box3> {
        Box3::around(self.positions.iter().copied())
    }

    /// Iterates over the corners of each polygon, with its kind.
    pub fn polygons(&self) -> impl Iterator<Item = (PolygonKind, &[Corner])> {
        let mut start = 0;
        self.polygons.iter().map(move |p| {
            let range = start..p.end as usize;
            start = range.end;
            (p.kind, self.corners.get(range).unwrap_or_default())
        })
    }

    /// Iterates over the corners of each face.
    pub fn faces(&self) -> impl Iterator<Item = &[Corner]> {
        self.polygons().filter(|(kind, _)| *kind == PolygonKind::Face).map(|(_, corners)| corners)
    }

    /// Appends a polygon.
    pub fn push(&mut self, kind: PolygonKind, corners: impl IntoIterator<Item = Corner>) {
        self.corners.extend(corners);
        self.polygons.push(Polygon { end: index32(self.corners.len()), kind });
    }

    /// Iterates over the faces as triangles, in fans from their first corners.
    pub fn triangles(&self) -> impl Iterator<Item = [Corner; 3]> {
        self.faces().flat_map(fan)
    }

    /// Adds a mark that holds from the next polygon onwards.
    pub(crate) fn mark(&mut self, mark: Mark) {
        self.marks.push((index32(self.polygons.len()), mark));
    }

    fn is_colored(&self) -> bool {
        !self.colors.is_empty() && self.colors.len() == self.positions.len()
    }

    /// Returns the name of the object or group that a polygon belongs to; empty if there is none.
    #[must_use]
    pub fn name_of(&self, polygon: usize) -> &str {
        let before = self.marks.iter().take_while(|(first, _)| *first as usize <= polygon);
        let name = before.filter_map(|(_, m)| match m {
            Mark::Object(name) | Mark::Group(name) => Some(name.as_str()),
            _ => None,
        });
        name.last().unwrap_or_default()
    }
}

/// Converts an index. One that needs more than 32 bits becomes [`NONE`].
pub(crate) fn index32(i: usize) -> u32 {
    u32::try_from(i).unwrap_or(NONE)
}

/// Returns a polygon as triangles, in a fan from its first corner.
pub(crate) fn fan<T: Copy>(corners: &[T]) -> impl Iterator<Item = [T; 3]> {
    corners.windows(2).skip(1).map(|w| [corners[0], w[0], w[1]])
}

/// Returns the vertices at the ends of each side of a polygon, in its direction.
fn polygon_sides(corners: &[Corner]) -> impl Iterator<Item = (u32, u32)> {
    corners.iter().zip(corners.iter().cycle().skip(1)).map(|(a, b)| (a.vertex, b.vertex))
}

/// The topology of a mesh's faces, with their volume and area.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Topology {
    /// Vertices that belong to a face. Vertices at one position count as one.
    pub vertices: usize,
    /// Edges.
    pub edges: usize,
    /// Faces.
    pub faces: usize,
    /// Edges of only one face.
    pub open_edges: usize,
    /// Edges of more than two faces, or of two faces that run along it in the same direction.
    pub bad_edges: usize,
    /// Volume inside a closed, consistently oriented surface; positive if faces are counter-clockwise as seen from outside.
    pub volume: f64,
    /// Area of the surface.
    pub area: f64,
}

impl Topology {
    /// Returns `true` if the surface has no boundary and every edge joins two faces of equal orientation.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.faces > 0 && self.open_edges == 0 && self.bad_edges == 0
    }

    /// Returns the Euler number V − E + F: 2 for a ball, 0 for a ring.
    #[must_use]
    pub fn euler(&self) -> i64 {
        self.vertices as i64 - self.edges as i64 + self.faces as i64
    }
}

/// Examines the faces of a mesh. Vertices at one position count as one, since many files repeat vertices along seams.
#[must_use]
pub fn topology(mesh: &Mesh) -> Topology {
    // Adding 0 turns −0 into 0.
    let key = |p: &DVec3| (*p + 0.0).to_array().map(f64::to_bits);
    let mut numbers: HashMap<[u64; 3], u32> = HashMap::with_capacity(mesh.positions.len());
    let number = |p: &DVec3| {
        let next = numbers.len() as u32;
        *numbers.entry(key(p)).or_insert(next)
    };
    let by_vertex: Vec<u32> = mesh.positions.iter().map(number).collect();
    let mut used = vec![false; numbers.len()];
    // Numbers of faces that run along each edge forwards and backwards.
    let mut edges: HashMap<Edge, [u32; 2]> = HashMap::new();
    let (mut faces, mut volume, mut area) = (0, 0.0, 0.0);
    let origin = mesh.bounds().map_or(DVec3::ZERO, |b| b.center());
    for face in mesh.faces() {
        faces += 1;
        for (v, w) in polygon_sides(face) {
            let (a, b) = (by_vertex[v as usize], by_vertex[w as usize]);
            used[a as usize] = true;
            if a != b {
                edges.entry(edge(a, b)).or_default()[usize::from(a > b)] += 1;
            }
        }
    }
    for t in mesh.triangles() {
        let [a, b, c] = t.map(|c| mesh.positions[c.vertex as usize] - origin);
        volume += a.dot(b.cross(c)) / 6.0;
        area += 0.5 * (b - a).cross(c - a).length();
    }
    Topology {
        vertices: used.iter().filter(|u| **u).count(),
        edges: edges.len(),
        faces,
        open_edges: edges.values().filter(|n| n[0] + n[1] == 1).count(),
        bad_edges: edges.values().filter(|n| n[0] + n[1] > 1 && **n != [1, 1]).count(),
        volume,
        area,
    }
}

/// A mesh with one index per corner, as PLY has it.
struct Unified {
    /// The distinct corners.
    corners: Vec<Corner>,
    /// For each corner of the mesh, the index of an equal one in `corners`.
    index: Vec<u32>,
}

/// Numbers the distinct corners. The first corner of a vertex gets the number of the vertex; vertices without a polygon keep theirs.
fn unify(mesh: &Mesh) -> Unified {
    let bare = |v: usize| Corner { vertex: index32(v), uv: NONE, normal: NONE };
    let mut corners: Vec<Corner> = (0..mesh.positions.len()).map(bare).collect();
    let mut taken = vec![false; corners.len()];
    let mut others: HashMap<Corner, u32> = HashMap::new();
    let mut index = Vec::with_capacity(mesh.corners.len());
    for c in &mesh.corners {
        let v = c.vertex as usize;
        if !taken[v] && *c != bare(v) {
            (taken[v], corners[v]) = (true, *c);
        }
        // Corners of lines have neither texture coordinates nor normal, and take those of their vertex.
        let is_bare = *c == bare(v);
        index.push(if is_bare || corners[v] == *c {
            c.vertex
        } else {
            *others.entry(*c).or_insert_with(|| {
                corners.push(*c);
                index32(corners.len() - 1)
            })
        });
    }
    Unified { corners, index }
}

/// The parts of a glTF file that a map leaves unchanged: materials, and all they refer to.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Assets {
    /// The arrays named in [`KEPT`], unchanged.
    json: Map<String, Value>,
    /// The names of the materials, made unique.
    materials: Vec<String>,
    /// The bytes of pictures that a buffer holds, by the index of the picture.
    pictures: Vec<(usize, Vec<u8>)>,
}

/// The arrays of a glTF file that are kept.
const KEPT: [&str; 5] = ["materials", "textures", "samplers", "images", "extensionsUsed"];

impl Assets {
    /// Returns `true` if there are no materials.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.materials.is_empty()
    }

    /// Takes the assets from a file's JSON.
    fn from_json(root: &Value) -> Self {
        let mut out = Self::default();
        for key in KEPT {
            if let Some(v) = root.get(key) {
                out.json.insert(key.to_owned(), v.clone());
            }
        }
        let materials = root.get("materials").and_then(Value::as_array);
        for (i, m) in materials.into_iter().flatten().enumerate() {
            let name = m.get("name").and_then(Value::as_str).unwrap_or_default();
            let name = if name.is_empty() { format!("material {}", i + 1) } else { name.to_owned() };
            let taken = out.materials.contains(&name);
            out.materials.push(if taken { format!("{name} {}", i + 1) } else { name });
        }
        out
    }
}

/// An error that prevents reading a file as a mesh or writing it, and its position in the file.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{}{problem}", self.prefix())]
pub struct MeshError {
    /// The line, counted from 1, if one is known.
    pub line: Option<usize>,
    /// The problem.
    pub problem: MeshFault,
}

/// A fault in a mesh file.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MeshFault {
    /// Description of the fault.
    #[error("{0}")]
    Text(String),
    /// Reading takes more work than a limit allows.
    #[error("the mesh takes {0}")]
    Limit(Exceeded),
}

impl MeshError {
    /// Makes an error at a line.
    pub(crate) fn at_line(line: usize, problem: impl Into<String>) -> Self {
        Self { line: Some(line), problem: MeshFault::Text(problem.into()) }
    }

    /// Makes an error about the whole file.
    pub(crate) fn whole(problem: impl Into<String>) -> Self {
        Self { line: None, problem: MeshFault::Text(problem.into()) }
    }

    fn prefix(&self) -> String {
        self.line.map_or_else(String::new, |n| format!("line {n}: "))
    }
}

impl From<Exceeded> for MeshError {
    fn from(e: Exceeded) -> Self {
        Self { line: None, problem: MeshFault::Limit(e) }
    }
}
