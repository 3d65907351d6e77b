//! Writes glTF: one node with a mesh for each object, one primitive for each material and kind of polygon. Polygons become triangles,
//! coordinates single precision.

use crate::mesh::assets::Assets;
use crate::mesh::error::MeshError;
use crate::mesh::model::{Corner, Mark, Mesh, NONE, PolygonKind};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use gltf::Glb;
use serde_json::{Map, Value, json};
use std::borrow::Cow;
use std::collections::HashMap;

/// Writes the binary form, `.glb`.
///
/// # Errors
/// More bytes than the format can count.
pub fn write_binary(mesh: &Mesh) -> Result<Vec<u8>, MeshError> {
    let (root, bin) = build(mesh, None);
    let text = serde_json::to_vec(&root).map_err(|e| MeshError::whole(e.to_string()))?;
    let header = gltf::binary::Header { magic: *b"glTF", version: 2, length: 0 };
    let glb = Glb { header, json: Cow::Owned(text), bin: Some(Cow::Owned(bin)) };
    glb.to_vec().map_err(|e| MeshError::whole(e.to_string()))
}

/// Writes the text form, `.gltf`, with its buffer inside.
///
/// # Errors
/// As [`write_binary`].
pub fn write_text(mesh: &Mesh) -> Result<Vec<u8>, MeshError> {
    let (root, _) = build(mesh, Some("data:application/octet-stream;base64,"));
    serde_json::to_vec(&root).map_err(|e| MeshError::whole(e.to_string()))
}

/// Polygons that share an object, a material and a kind.
#[derive(Default)]
struct Part {
    material: Option<usize>,
    kind: Option<PolygonKind>,
    index: HashMap<Corner, u32>,
    corners: Vec<Corner>,
    indices: Vec<u32>,
}

impl Part {
    fn add(&mut self, c: &Corner) {
        let next = u32::try_from(self.corners.len()).unwrap_or(NONE);
        let n = *self.index.entry(*c).or_insert_with(|| {
            self.corners.push(*c);
            next
        });
        self.indices.push(n);
    }
}

/// The objects by name, each with its parts, and the names of materials that the file did not have.
fn parts(mesh: &Mesh, assets: &Assets) -> (Vec<(String, Vec<Part>)>, Vec<String>) {
    let mut objects: Vec<(String, Vec<Part>)> = Vec::new();
    let mut added: Vec<String> = Vec::new();
    let (mut name, mut material, mut fresh) = (String::new(), None, true);
    let mut marks = mesh.marks.iter().peekable();
    for (n, (kind, corners)) in mesh.polygons().enumerate() {
        while let Some((_, mark)) = marks.next_if(|(first, _)| *first as usize <= n) {
            match mark {
                Mark::Object(t) | Mark::Group(t) => (name, fresh) = (t.clone(), true),
                Mark::Material(t) if t == "none" => material = None,
                Mark::Material(t) => {
                    let all = || assets.materials.iter().chain(&added);
                    material = Some(all().position(|m| m == t).unwrap_or_else(|| all().count()));
                    if material == Some(assets.materials.len() + added.len()) {
                        added.push(t.clone());
                    }
                }
                Mark::Smoothing(_) | Mark::Library(_) => {}
            }
        }
        if std::mem::take(&mut fresh) || objects.is_empty() {
            objects.push((name.clone(), Vec::new()));
        }
        let Some((_, parts)) = objects.last_mut() else { continue };
        let found = parts.iter().position(|p| p.material == material && p.kind == Some(kind));
        let at = found.unwrap_or_else(|| {
            parts.push(Part { material, kind: Some(kind), ..Part::default() });
            parts.len() - 1
        });
        let part = &mut parts[at];
        match kind {
            PolygonKind::Face => {
                for w in corners.windows(2).skip(1) {
                    [corners[0], w[0], w[1]].iter().for_each(|c| part.add(c));
                }
            }
            PolygonKind::Line => corners.windows(2).flatten().for_each(|c| part.add(c)),
            PolygonKind::Points => corners.iter().for_each(|c| part.add(c)),
        }
    }
    (objects, added)
}

/// The buffer with its views and accessors.
#[derive(Default)]
struct Store {
    bin: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

/// glTF's numbers for the types that are written.
const FLOAT: u32 = 5126;
const UNSIGNED: u32 = 5125;

impl Store {
    fn view(&mut self, bytes: &[u8]) -> usize {
        // Every component starts at a multiple of its size.
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        self.views.push(json!({"buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len()}));
        self.bin.extend_from_slice(bytes);
        self.views.len() - 1
    }

    fn floats<const N: usize>(&mut self, items: impl Iterator<Item = [f64; N]>, bounded: bool) -> usize {
        let single: Vec<[f32; N]> = items.map(|i| i.map(|v| v as f32)).collect();
        let bytes: Vec<u8> = single.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1];
        let mut accessor =
            json!({"bufferView": self.view(&bytes), "componentType": FLOAT, "count": single.len(), "type": kind});
        if bounded {
            let bound = |f: fn(f32, f32) -> f32| -> Vec<f32> {
                (0..N).filter_map(|a| single.iter().map(|i| i[a]).reduce(f)).collect()
            };
            accessor["min"] = json!(bound(f32::min));
            accessor["max"] = json!(bound(f32::max));
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn indices(&mut self, items: &[u32]) -> usize {
        let bytes: Vec<u8> = items.iter().flat_map(|v| v.to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.accessors
            .push(json!({"bufferView": view, "componentType": UNSIGNED, "count": items.len(), "type": "SCALAR"}));
        self.accessors.len() - 1
    }
}

fn primitive(mesh: &Mesh, part: &Part, store: &mut Store) -> Value {
    let mut attributes = Map::new();
    let corners = || part.corners.iter();
    let at = |c: &Corner| mesh.positions[c.vertex as usize].to_array();
    attributes.insert("POSITION".into(), json!(store.floats(corners().map(at), true)));
    if corners().all(|c| (c.normal as usize) < mesh.normals.len()) {
        let normals = corners().map(|c| mesh.normals[c.normal as usize].normalize_or_zero().to_array());
        attributes.insert("NORMAL".into(), json!(store.floats(normals, false)));
    }
    if corners().all(|c| (c.uv as usize) < mesh.uvs.len()) {
        // Counted from the top there, from the bottom here.
        let uvs = corners().map(|c| mesh.uvs[c.uv as usize]).map(|[u, v, _]| [u, 1.0 - v]);
        attributes.insert("TEXCOORD_0".into(), json!(store.floats(uvs, false)));
    }
    if !mesh.colors.is_empty() && mesh.colors.len() == mesh.positions.len() {
        let colors = corners().map(|c| mesh.colors[c.vertex as usize]);
        let opaque = |[r, g, b, _]: [f64; 4]| [r, g, b];
        let accessor =
            if mesh.is_translucent() { store.floats(colors, false) } else { store.floats(colors.map(opaque), false) };
        attributes.insert("COLOR_0".into(), json!(accessor));
    }
    let mode = match part.kind {
        Some(PolygonKind::Points) => 0,
        Some(PolygonKind::Line) => 1,
        _ => 4,
    };
    let mut out = json!({"attributes": attributes, "indices": store.indices(&part.indices), "mode": mode});
    if let Some(m) = part.material {
        out["material"] = json!(m);
    }
    out
}

fn build(mesh: &Mesh, inline: Option<&str>) -> (Value, Vec<u8>) {
    let none = Assets::default();
    let assets = mesh.assets.as_deref().unwrap_or(&none);
    let (objects, added) = parts(mesh, assets);
    let mut store = Store::default();
    let (mut nodes, mut meshes) = (Vec::new(), Vec::new());
    for (name, parts) in &objects {
        let primitives: Vec<Value> = parts.iter().map(|p| primitive(mesh, p, &mut store)).collect();
        let named = |mut v: Value| {
            if !name.is_empty() {
                v["name"] = json!(name);
            }
            v
        };
        nodes.push(named(json!({"mesh": meshes.len()})));
        meshes.push(named(json!({"primitives": primitives})));
    }
    let mut root = assets.json.clone();
    for (i, bytes) in &assets.pictures {
        let view = store.view(bytes);
        if let Some(image) = root.get_mut("images").and_then(|v| v.get_mut(i)) {
            image["bufferView"] = json!(view);
        }
    }
    if !added.is_empty() {
        let all = root.entry("materials").or_insert_with(|| json!([]));
        if let Value::Array(all) = all {
            all.extend(added.iter().map(|name| json!({"name": name})));
        }
    }
    let mut buffer = json!({"byteLength": store.bin.len()});
    if let Some(prefix) = inline {
        buffer["uri"] = json!(format!("{prefix}{}", STANDARD.encode(&store.bin)));
    }
    root.insert("asset".into(), json!({"version": "2.0", "generator": "pathwarp"}));
    root.insert("scene".into(), json!(0));
    root.insert("scenes".into(), json!([{"nodes": (0..nodes.len()).collect::<Vec<_>>()}]));
    root.insert("nodes".into(), json!(nodes));
    root.insert("meshes".into(), json!(meshes));
    root.insert("accessors".into(), json!(store.accessors));
    root.insert("bufferViews".into(), json!(store.views));
    root.insert("buffers".into(), json!([buffer]));
    (Value::Object(root), store.bin)
}
