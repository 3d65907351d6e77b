//! Reads glTF.

use super::accessor::Buffers;
use super::primitive;
use crate::mesh::assets::Assets;
use crate::mesh::error::MeshError;
use crate::mesh::model::{Mark, Mesh, NONE};
use glam::DMat4;
use gltf::{Gltf, Node};
use pathwarp::budget::{Budget, Limit};
use serde_json::Value;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Returns `true` if the file begins like binary glTF, or is JSON that says it is glTF.
#[must_use]
pub fn sniff(bytes: &[u8]) -> bool {
    bytes.starts_with(b"glTF")
        || bytes.trim_ascii_start().starts_with(b"{") && bytes.windows(7).any(|w| w == b"\"asset\"")
}

/// Reads the meshes of the default scene, or of the first, in its coordinates.
///
/// # Errors
/// The file is damaged or refers to buffers outside itself, or shows more than the limits allow.
pub fn read(bytes: &[u8], budget: &Budget) -> Result<Mesh, MeshError> {
    let damaged =
        |e: String| MeshError::whole(format!("is a damaged glTF file: {}", e.chars().take(200).collect::<String>()));
    let mut file = checked(bytes).map_err(damaged)?;
    let root = json(bytes).ok_or_else(|| damaged("its JSON cannot be read".into()))?;
    let buffers = Buffers::of(&mut file)?;
    let document = &file.document;
    let mut assets = Assets::of(&root);
    for (i, image) in document.images().enumerate() {
        if let gltf::image::Source::View { view, .. } = image.source() {
            let bytes =
                buffers.view(&view).ok_or_else(|| MeshError::whole(format!("picture {i} is outside its buffer")))?;
            assets.pictures.push((i, bytes.to_vec()));
        }
    }
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let scene = scene.ok_or_else(|| MeshError::whole("has no scene"))?;
    let mut mesh = Mesh::default();
    let mut lost = BTreeSet::new();
    // A stack of its own: nodes may be nested deeper than the program's.
    let mut open: Vec<(Node<'_>, DMat4)> = scene.nodes().map(|n| (n, DMat4::IDENTITY)).collect();
    open.reverse();
    while let Some((node, parent)) = open.pop() {
        // Children that are their own parents' parents go on for ever.
        budget.take(Limit::Elements, 1.0)?;
        let own = node.transform().matrix().map(|column| column.map(f64::from));
        let to_scene = parent * DMat4::from_cols_array_2d(&own);
        object(&mut mesh, &node, &to_scene, &assets, &buffers, budget, &mut lost)?;
        let children: Vec<_> = node.children().map(|c| (c, to_scene)).collect();
        open.extend(children.into_iter().rev());
    }
    if mesh.positions.is_empty() {
        return Err(MeshError::whole("shows no mesh with positions"));
    }
    for (key, name) in [("animations", "animations"), ("cameras", "cameras"), ("skins", "skins")] {
        if root.get(key).and_then(Value::as_array).is_some_and(|a| !a.is_empty()) {
            lost.insert(name.into());
        }
    }
    mesh.left_out.extend(lost);
    mesh.assets = Some(Arc::new(assets));
    Ok(mesh)
}

/// A file whose references have been checked.
fn checked(bytes: &[u8]) -> Result<Gltf, String> {
    let Gltf { document, blob } = Gltf::from_slice_without_validation(bytes).map_err(|e| e.to_string())?;
    // gltf 1.4.1 panics while it checks a primitive whose positions are not among the accessors.
    let root = document.into_json();
    let mut attributes = root.meshes.iter().flat_map(|m| &m.primitives).flat_map(|p| p.attributes.values());
    if let Some(index) = attributes.find(|i| i.value() >= root.accessors.len()) {
        return Err(format!("a primitive uses accessor {}, and there are {}", index.value(), root.accessors.len()));
    }
    let document = gltf::Document::from_json(root).map_err(|e| e.to_string())?;
    Ok(Gltf { document, blob })
}

fn object(
    mesh: &mut Mesh,
    node: &Node<'_>,
    to_scene: &DMat4,
    assets: &Assets,
    buffers: &Buffers,
    budget: &Budget,
    lost: &mut BTreeSet<String>,
) -> Result<(), MeshError> {
    let Some(shape) = node.mesh() else { return Ok(()) };
    let name = node.name().or(shape.name()).map_or_else(|| format!("node {}", node.index() + 1), str::to_owned);
    let mark =
        |mesh: &mut Mesh, mark: Mark| mesh.marks.push((u32::try_from(mesh.polygons.len()).unwrap_or(NONE), mark));
    mark(mesh, Mark::Object(name));
    for p in shape.primitives() {
        let material = p.material().index().and_then(|i| assets.materials.get(i));
        // Without a name, the material of the object before would go on.
        mark(mesh, Mark::Material(material.cloned().unwrap_or_else(|| "none".into())));
        primitive::append(mesh, &p, to_scene, buffers, lost)?;
        // A node may show a mesh again and again: each of its vertices is then one more point to map.
        let count = |a: Option<gltf::Accessor<'_>>| a.map_or(0, |a| a.count()) as f64;
        budget.spend(count(p.get(&gltf::Semantic::Positions)) + count(p.indices()))?;
    }
    Ok(())
}

/// The JSON as it is, also of binary files.
fn json(bytes: &[u8]) -> Option<Value> {
    if bytes.starts_with(b"glTF") {
        serde_json::from_slice(&gltf::Glb::from_slice(bytes).ok()?.json).ok()
    } else {
        serde_json::from_slice(bytes).ok()
    }
}
