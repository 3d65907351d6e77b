//! Formats of models, by extension and by content.

use crate::failure::Failure;
use pathwarp_solid::mesh::{Mark, Mesh, NONE, PolygonKind, gltf, ply, stl};
use std::path::Path;

/// The format of a model's file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ModelFormat {
    Obj,
    Stl,
    Ply,
    /// Binary glTF.
    Glb,
    /// glTF as JSON.
    Gltf,
    /// Bézier patches as text.
    Bpt,
    /// Surfaces as JSON.
    Surfaces,
}

/// Names, among the properties that a format has no room for.
pub(super) const NAMES: &str = "names";

/// Extensions and their formats.
const EXTENSIONS: [(&str, ModelFormat); 7] = [
    ("obj", ModelFormat::Obj),
    ("stl", ModelFormat::Stl),
    ("ply", ModelFormat::Ply),
    ("glb", ModelFormat::Glb),
    ("gltf", ModelFormat::Gltf),
    ("bpt", ModelFormat::Bpt),
    ("json", ModelFormat::Surfaces),
];

impl ModelFormat {
    /// The format that an extension says.
    pub(super) fn of(file: &Path) -> Option<Self> {
        let extension = file.extension()?;
        EXTENSIONS.into_iter().find(|(e, _)| extension.eq_ignore_ascii_case(e)).map(|(_, f)| f)
    }

    /// The format of a file without such an extension.
    pub(super) fn sniffed(bytes: &[u8]) -> Self {
        let json = || bytes.trim_ascii_start().starts_with(b"{");
        if gltf::sniff(bytes) {
            if json() { Self::Gltf } else { Self::Glb }
        } else if ply::sniff(bytes) {
            Self::Ply
        } else if stl::sniff(bytes) {
            Self::Stl
        } else if json() {
            Self::Surfaces
        } else {
            Self::Obj
        }
    }

    /// The format of an output; of standard output that of the input.
    ///
    /// # Errors
    /// The extension says another one.
    pub(super) fn of_output(target: Option<&Path>, input: Self) -> Result<Self, Failure> {
        let Some(target) = target else { return Ok(input) };
        match (Self::of(target), target.extension()) {
            (Some(format), _) => Ok(format),
            (None, None) => Ok(input),
            (None, Some(other)) => {
                let all: Vec<String> = EXTENSIONS.iter().map(|(e, _)| format!(".{e}")).collect();
                Err(Failure::usage(format!(
                    "{}: a model is written as {}, not as .{}",
                    target.display(),
                    all.join(", "),
                    other.to_string_lossy()
                )))
            }
        }
    }

    /// Returns `true` for curved surfaces.
    pub(super) fn is_curved(self) -> bool {
        matches!(self, Self::Bpt | Self::Surfaces)
    }

    /// The properties of a mesh for which the format has no room.
    pub(super) fn lost(self, mesh: &Mesh) -> Vec<&'static str> {
        let marked = |f: fn(&Mark) -> bool| mesh.marks.iter().any(|(_, m)| f(m));
        let kinds = |k: PolygonKind| mesh.polygons.iter().any(|p| p.kind == k);
        let named = |t: &str| !t.is_empty() && t != "none";
        let corners = |f: fn(&pathwarp_solid::mesh::Corner) -> u32| mesh.corners.iter().any(|c| f(c) != NONE);
        let mut out = Vec::new();
        let mut check = |lost: bool, what: &'static str| {
            if lost {
                out.push(what);
            }
        };
        if matches!(self, Self::Stl | Self::Ply) {
            check(marked(|m| matches!(m, Mark::Object(t) | Mark::Group(t) if !t.is_empty())), NAMES);
            check(mesh.marks.iter().any(|(_, m)| matches!(m, Mark::Material(t) if named(t))), "materials");
        }
        if self == Self::Stl {
            check(corners(|c| c.uv), "texture coordinates");
            check(corners(|c| c.normal), "normals of vertices");
            check(!mesh.colors.is_empty(), "colours");
            check(kinds(PolygonKind::Line) || kinds(PolygonKind::Points), "lines and points");
        }
        if self == Self::Obj && mesh.is_translucent() {
            out.push("the opacity of vertices");
        }
        if self == Self::Obj && mesh.assets.as_deref().is_some_and(|a| !a.is_empty()) {
            out.push("materials, except for their names");
        }
        out
    }
}
