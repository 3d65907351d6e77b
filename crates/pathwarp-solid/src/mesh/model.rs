//! The mesh as data.

use super::assets::Assets;
use crate::box3::Box3;
use glam::DVec3;
use std::sync::Arc;

/// An index that is not there.
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
    /// Index after its last corner in [`Mesh::corners`].
    pub end: u32,
    /// Its kind.
    pub kind: PolygonKind,
}

/// Something that holds from a polygon on.
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
    /// Colours of the vertices, red, green, blue and opacity: none, or one for each vertex.
    pub colors: Vec<[f64; 4]>,
    /// Normals.
    pub normals: Vec<DVec3>,
    /// Texture coordinates; the third is 0 unless the file has it.
    pub uvs: Vec<[f64; 3]>,
    /// The corners of all polygons.
    pub corners: Vec<Corner>,
    /// The polygons, in order.
    pub polygons: Vec<Polygon>,
    /// Marks with the index of the first polygon that they hold for, in order.
    pub marks: Vec<(u32, Mark)>,
    /// Materials of a glTF file, to which the marks refer by name.
    pub assets: Option<Arc<Assets>>,
    /// What was in the file and is not in the mesh, each a phrase for a warning.
    pub left_out: Vec<String>,
}

impl Mesh {
    /// Returns `true` if vertices are translucent.
    #[must_use]
    pub fn is_translucent(&self) -> bool {
        self.colors.iter().any(|c| c[3] != 1.0)
    }

    /// The bounding box of the vertices; `None` if there are none.
    #[must_use]
    pub fn bounds(&self) -> Option<Box3> {
        Box3::around(self.positions.iter().copied())
    }

    /// The corners of each polygon with its kind.
    pub fn polygons(&self) -> impl Iterator<Item = (PolygonKind, &[Corner])> {
        let mut start = 0;
        self.polygons.iter().map(move |p| {
            let own = start..p.end as usize;
            start = own.end;
            (p.kind, self.corners.get(own).unwrap_or_default())
        })
    }

    /// The corners of each face.
    pub fn faces(&self) -> impl Iterator<Item = &[Corner]> {
        self.polygons().filter(|(kind, _)| *kind == PolygonKind::Face).map(|(_, corners)| corners)
    }

    /// Appends a polygon.
    pub fn push(&mut self, kind: PolygonKind, corners: impl IntoIterator<Item = Corner>) {
        self.corners.extend(corners);
        self.polygons.push(Polygon { end: u32::try_from(self.corners.len()).unwrap_or(NONE), kind });
    }

    /// The faces as triangles: fans from the first corner.
    pub fn triangles(&self) -> impl Iterator<Item = [Corner; 3]> {
        self.faces().flat_map(|f| f.windows(2).skip(1).map(|w| [f[0], w[0], w[1]]))
    }

    /// The name of the object or group that a polygon belongs to; empty if it has none.
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
