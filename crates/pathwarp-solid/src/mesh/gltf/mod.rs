//! glTF 2.0, `.glb` and `.gltf`, read by means of the crate gltf.
//!
//! Every node with a mesh becomes an object in the scene's coordinates. Materials, textures and pictures are kept unchanged. Nothing
//! outside the file is opened. glTF measures lengths in metres, the mesh in millimetres.

#[cfg(test)]
mod tests;

use super::{Assets, Corner, Mark, Mesh, MeshError, NONE, PolygonKind, fan, index32};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use glam::{DMat3, DMat4, DVec3};
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::{Source, View};
use gltf::mesh::{Mode, Semantic};
use gltf::{Accessor, Glb, Gltf, Node, Primitive};
use pathwarp::budget::{Budget, Limit};
use serde_json::{Map, Value, json};
use std::borrow::Cow;
use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

/// Millimetres in glTF's unit of length.
const METRE: f64 = 1000.0;

/// Returns `true` if the file begins like binary glTF, or is JSON with a key `asset`.
#[must_use]
pub fn sniff(bytes: &[u8]) -> bool {
    let is_json = bytes.trim_ascii_start().starts_with(b"{");
    bytes.starts_with(b"glTF") || (is_json && bytes.windows(7).any(|w| w == b"\"asset\""))
}

/// Reads the meshes of the default scene, or of the first, in its coordinates as millimetres.
///
/// # Errors
/// [`MeshFault::Text`](super::MeshFault::Text) when the file is damaged or refers to buffers outside itself, and
/// [`MeshFault::Limit`](super::MeshFault::Limit) when it shows more than the budget allows.
pub fn read(bytes: &[u8], budget: &Budget) -> Result<Mesh, MeshError> {
    let damaged =
        |e: String| MeshError::whole(format!("is a damaged glTF file: {}", e.chars().take(200).collect::<String>()));
    let mut file = parse(bytes).map_err(damaged)?;
    let root = json(bytes).ok_or_else(|| damaged("its JSON cannot be read".into()))?;
    let buffers = Buffers::from_file(&mut file)?;
    let document = &file.document;
    let mut assets = Assets::from_json(&root);
    for (i, image) in document.images().enumerate() {
        if let gltf::image::Source::View { view, .. } = image.source() {
            let outside = || MeshError::whole(format!("picture {i} is outside its buffer"));
            assets.pictures.push((i, buffers.view(&view).ok_or_else(outside)?.to_vec()));
        }
    }
    let scene = document.default_scene().or_else(|| document.scenes().next());
    let scene = scene.ok_or_else(|| MeshError::whole("has no scene"))?;
    let mut mesh = Mesh::default();
    let mut lost = BTreeSet::new();
    // An explicit stack, since nodes may be nested deeper than the program's stack allows.
    let mut open: Vec<(Node<'_>, DMat4)> = scene.nodes().map(|n| (n, DMat4::from_scale(DVec3::splat(METRE)))).collect();
    open.reverse();
    while let Some((node, parent)) = open.pop() {
        // Without a limit, a node that is its descendant would be visited for ever.
        budget.take(Limit::Elements, 1.0)?;
        let to_parent = node.transform().matrix().map(|column| column.map(f64::from));
        let to_scene = parent * DMat4::from_cols_array_2d(&to_parent);
        append_node(&mut mesh, &node, &to_scene, &assets, &buffers, budget, &mut lost)?;
        let children: Vec<_> = node.children().map(|c| (c, to_scene)).collect();
        open.extend(children.into_iter().rev());
    }
    if mesh.positions.is_empty() {
        return Err(MeshError::whole("shows no mesh with positions"));
    }
    for key in ["animations", "cameras", "skins"] {
        if root.get(key).and_then(Value::as_array).is_some_and(|a| !a.is_empty()) {
            lost.insert(key.into());
        }
    }
    mesh.left_out.extend(lost);
    mesh.assets = Some(Arc::new(assets));
    Ok(mesh)
}

/// Parses a file and checks its references.
fn parse(bytes: &[u8]) -> Result<Gltf, String> {
    let Gltf { document, blob } = Gltf::from_slice_without_validation(bytes).map_err(|e| e.to_string())?;
    // gltf 1.4.1 panics when it checks a primitive whose positions are not among the accessors.
    let root = document.into_json();
    let mut attributes = root.meshes.iter().flat_map(|m| &m.primitives).flat_map(|p| p.attributes.values());
    if let Some(index) = attributes.find(|i| i.value() >= root.accessors.len()) {
        return Err(format!(
            "a primitive uses accessor {}, but there are only {}",
            index.value(),
            root.accessors.len()
        ));
    }
    let document = gltf::Document::from_json(root).map_err(|e| e.to_string())?;
    Ok(Gltf { document, blob })
}

/// Appends the mesh of a node as an object.
fn append_node(
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
    mesh.mark(Mark::Object(name));
    for p in shape.primitives() {
        let material = p.material().index().and_then(|i| assets.materials.get(i));
        // Without this mark, the material of the previous object would still apply.
        mesh.mark(Mark::Material(material.cloned().unwrap_or_else(|| "none".into())));
        append_primitive(mesh, &p, to_scene, buffers, lost)?;
        // Many nodes may show one mesh; each time, its vertices are more points to map.
        let count = |a: Option<Accessor<'_>>| a.map_or(0, |a| a.count()) as f64;
        budget.spend(count(p.get(&Semantic::Positions)) + count(p.indices()))?;
    }
    Ok(())
}

/// Returns the JSON of a text or binary file.
fn json(bytes: &[u8]) -> Option<Value> {
    if bytes.starts_with(b"glTF") {
        serde_json::from_slice(&Glb::from_slice(bytes).ok()?.json).ok()
    } else {
        serde_json::from_slice(bytes).ok()
    }
}

/// Appends a primitive with its vertices in scene coordinates. `lost` collects the names of omitted features.
fn append_primitive(
    mesh: &mut Mesh,
    primitive: &Primitive<'_>,
    to_scene: &DMat4,
    buffers: &Buffers,
    lost: &mut BTreeSet<String>,
) -> Result<(), MeshError> {
    let Some(positions) = primitive.get(&Semantic::Positions) else {
        lost.insert("primitives without positions".into());
        return Ok(());
    };
    let count = positions.count();
    let first = mesh.positions.len();
    for p in buffers.floats::<3>(&positions)? {
        let p = to_scene.transform_point3(DVec3::from_array(p));
        // The square of a larger number would overflow.
        if p.abs().max_element().is_nan() || p.abs().max_element() > 1e100 {
            return Err(MeshError::whole(format!("a vertex of accessor {} is not finite", positions.index())));
        }
        mesh.positions.push(p);
    }
    let [normals, uvs] = append_attributes(mesh, primitive, to_scene, buffers, lost)?;
    if !mesh.colors.is_empty() {
        mesh.colors.resize(mesh.positions.len(), [1.0; 4]);
    }
    if primitive.morph_targets().next().is_some() {
        lost.insert("morph targets".into());
    }
    let indices = match primitive.indices() {
        Some(accessor) => buffers.indices(&accessor)?,
        None => (0..index32(count)).collect(),
    };
    if let Some(i) = indices.iter().find(|i| **i as usize >= count) {
        return Err(MeshError::whole(format!("the index {i} is out of range: there are {count} vertices")));
    }
    let index = |first: Option<usize>, i: u32| first.map_or(NONE, |first| index32(first).saturating_add(i));
    let corner = |i: &u32| Corner { vertex: index(Some(first), *i), uv: index(uvs, *i), normal: index(normals, *i) };
    append_polygons(mesh, primitive.mode(), &indices, to_scene.determinant() < 0.0, corner);
    Ok(())
}

/// Appends normals, texture coordinates and colours of the vertices added last. Returns the indices of the first normal and of the first
/// texture coordinates.
fn append_attributes(
    mesh: &mut Mesh,
    primitive: &Primitive<'_>,
    to_scene: &DMat4,
    buffers: &Buffers,
    lost: &mut BTreeSet<String>,
) -> Result<[Option<usize>; 2], MeshError> {
    let count = primitive.get(&Semantic::Positions).map_or(0, |a| a.count());
    let check_count = |n: usize, what: &str| {
        if n == count { Ok(()) } else { Err(MeshError::whole(format!("has {n} {what} for {count} vertices"))) }
    };
    let (mut normals, mut uvs) = (None, None);
    for (semantic, accessor) in primitive.attributes() {
        match semantic {
            Semantic::Positions => {}
            Semantic::Normals => {
                check_count(accessor.count(), "normals")?;
                normals = Some(mesh.normals.len());
                let m = DMat3::from_mat4(*to_scene);
                // The cofactor matrix is the inverse transpose up to a factor, which is negative if the node mirrors.
                let sign = 1f64.copysign(m.determinant());
                let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
                let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign;
                let all = buffers.floats::<3>(&accessor)?.into_iter().map(DVec3::from_array);
                mesh.normals.extend(all.map(|n| (cofactors * n).try_normalize().unwrap_or(n)));
            }
            Semantic::TexCoords(0) => {
                check_count(accessor.count(), "texture coordinates")?;
                uvs = Some(mesh.uvs.len());
                // glTF counts v from the top, [`Mesh`] from the bottom.
                mesh.uvs.extend(buffers.floats::<2>(&accessor)?.into_iter().map(|[u, v]| [u, 1.0 - v, 0.0]));
            }
            Semantic::Colors(0) => {
                check_count(accessor.count(), "colours")?;
                mesh.colors.resize(mesh.positions.len() - count, [1.0; 4]);
                if accessor.dimensions() == Dimensions::Vec4 {
                    mesh.colors.extend(buffers.floats::<4>(&accessor)?);
                } else {
                    mesh.colors.extend(buffers.floats::<3>(&accessor)?.into_iter().map(|[r, g, b]| [r, g, b, 1.0]));
                }
            }
            Semantic::Tangents => {
                lost.insert("tangents (viewers compute them from normals and texture coordinates)".into());
            }
            Semantic::Joints(_) | Semantic::Weights(_) => {
                lost.insert("skins".into());
            }
            other => {
                lost.insert(format!("attributes {}", other.to_string()));
            }
        }
    }
    Ok([normals, uvs])
}

/// Appends the polygons; mirrored triangles are turned over.
fn append_polygons(mesh: &mut Mesh, mode: Mode, indices: &[u32], mirrored: bool, corner: impl Fn(&u32) -> Corner) {
    let mut triangle = |[a, b, c]: [u32; 3]| {
        let t = if mirrored { [a, c, b] } else { [a, b, c] };
        if a != b && b != c && c != a {
            mesh.push(PolygonKind::Face, t.map(|i| corner(&i)));
        }
    };
    match mode {
        Mode::Triangles => indices.as_chunks().0.iter().for_each(|t| triangle(*t)),
        Mode::TriangleStrip => indices.windows(3).enumerate().for_each(|(i, t)| {
            triangle(if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] });
        }),
        Mode::TriangleFan => fan(indices).for_each(triangle),
        Mode::Lines => indices.chunks_exact(2).for_each(|t| mesh.push(PolygonKind::Line, t.iter().map(&corner))),
        Mode::LineStrip if indices.len() > 1 => mesh.push(PolygonKind::Line, indices.iter().map(&corner)),
        Mode::LineLoop if indices.len() > 1 => {
            mesh.push(PolygonKind::Line, indices.iter().chain(indices.first()).map(&corner));
        }
        Mode::Points if !indices.is_empty() => mesh.push(PolygonKind::Points, indices.iter().map(&corner)),
        _ => {}
    }
}

/// The bytes of all buffers. Every access is checked.
struct Buffers(Vec<Vec<u8>>);

impl Buffers {
    /// Takes the buffers of a file, which must be in it and as long as announced.
    fn from_file(file: &mut Gltf) -> Result<Self, MeshError> {
        let mut blob = file.blob.take();
        let mut out = Vec::new();
        for (i, buffer) in file.document.buffers().enumerate() {
            let bytes = match buffer.source() {
                Source::Bin => blob.take().ok_or_else(|| MeshError::whole(format!("buffer {i} is missing")))?,
                Source::Uri(uri) => data_of(uri).map_err(|e| MeshError::whole(format!("buffer {i} {e}")))?,
            };
            let (have, announced) = (bytes.len(), buffer.length());
            if have < announced {
                return Err(MeshError::whole(format!("buffer {i} has {have} bytes, but announces {announced}")));
            }
            out.push(bytes);
        }
        Ok(Self(out))
    }

    /// Returns the bytes of a view.
    fn view(&self, view: &View<'_>) -> Option<&[u8]> {
        let end = view.offset().checked_add(view.length())?;
        self.0.get(view.buffer().index())?.get(view.offset()..end)
    }

    /// Returns the numbers of an accessor, `N` at a time; missing components are 0.
    fn floats<const N: usize>(&self, accessor: &Accessor<'_>) -> Result<Vec<[f64; N]>, MeshError> {
        // Normalized integers are fractions of the largest one.
        let largest = largest(accessor.data_type()).filter(|_| accessor.normalized());
        let mut out = Vec::new();
        self.each(accessor, |numbers| {
            let mut item = [0.0; N];
            let values = numbers.iter().map(|v| largest.map_or(*v, |largest| (v / largest).max(-1.0)));
            item.iter_mut().zip(values).for_each(|(o, v)| *o = v);
            out.push(item);
        })?;
        Ok(out)
    }

    /// Returns the indices of an accessor, out of range if its type is not one for indices.
    fn indices(&self, accessor: &Accessor<'_>) -> Result<Vec<u32>, MeshError> {
        let is_unsigned = matches!(accessor.data_type(), DataType::U8 | DataType::U16 | DataType::U32);
        let mut out = Vec::new();
        self.each(accessor, |numbers| out.extend(numbers.first().map(|v| if is_unsigned { *v as u32 } else { NONE })))?;
        Ok(out)
    }

    /// Calls `f` with the components of every item.
    fn each(&self, accessor: &Accessor<'_>, mut f: impl FnMut(&[f64])) -> Result<(), MeshError> {
        let wrong = |what: &str| MeshError::whole(format!("accessor {} {what}", accessor.index()));
        if accessor.sparse().is_some() {
            return Err(wrong("is sparse, which is not read; save the model without sparse accessors"));
        }
        let view = accessor.view().ok_or_else(|| wrong("has no data"))?;
        let bytes = self.view(&view).ok_or_else(|| wrong("is outside its buffer"))?;
        let components = match accessor.dimensions() {
            Dimensions::Scalar => 1,
            Dimensions::Vec2 => 2,
            Dimensions::Vec3 => 3,
            Dimensions::Vec4 => 4,
            _ => return Err(wrong("holds matrices")),
        };
        let (kind, size) = (accessor.data_type(), accessor.size());
        let stride = view.stride().unwrap_or(size).max(size);
        // The last item must end within the view.
        let last = accessor.count().checked_sub(1).and_then(|n| n.checked_mul(stride));
        let end = last.and_then(|n| n.checked_add(accessor.offset())).and_then(|n| n.checked_add(size));
        if accessor.count() > 0 && end.is_none_or(|end| end > bytes.len()) {
            return Err(wrong(&format!("announces {} items, but its data ends before them", accessor.count())));
        }
        let mut numbers = [0.0; 4];
        for i in 0..accessor.count() {
            let start = accessor.offset() + i * stride;
            let item = &bytes[start..start + size];
            for (n, part) in numbers.iter_mut().zip(item.chunks_exact(size / components)) {
                *n = number(kind, part).ok_or_else(|| wrong("is damaged"))?;
            }
            f(&numbers[..components]);
        }
        Ok(())
    }
}

/// Decodes a number of this type.
fn number(kind: DataType, bytes: &[u8]) -> Option<f64> {
    Some(match kind {
        DataType::I8 => i8::from_le_bytes(bytes.try_into().ok()?).into(),
        DataType::U8 => u8::from_le_bytes(bytes.try_into().ok()?).into(),
        DataType::I16 => i16::from_le_bytes(bytes.try_into().ok()?).into(),
        DataType::U16 => u16::from_le_bytes(bytes.try_into().ok()?).into(),
        DataType::U32 => u32::from_le_bytes(bytes.try_into().ok()?).into(),
        DataType::F32 => f32::from_le_bytes(bytes.try_into().ok()?).into(),
    })
}

/// Returns the largest integer of this type.
fn largest(kind: DataType) -> Option<f64> {
    match kind {
        DataType::I8 => Some(i8::MAX.into()),
        DataType::U8 => Some(u8::MAX.into()),
        DataType::I16 => Some(i16::MAX.into()),
        DataType::U16 => Some(u16::MAX.into()),
        DataType::U32 => Some(u32::MAX.into()),
        DataType::F32 => None,
    }
}

/// Returns the bytes of a data URI.
fn data_of(uri: &str) -> Result<Vec<u8>, String> {
    let shown: String = uri.chars().take(60).collect();
    let outside =
        || format!("is outside the file (`{shown}`), and only the file itself is read; save the model as .glb");
    let (_, data) = uri.strip_prefix("data:").and_then(|rest| rest.split_once(";base64,")).ok_or_else(outside)?;
    STANDARD.decode(data).map_err(|e| format!("is damaged: {e}"))
}

/// Writes the binary form, `.glb`: a node with a mesh for each object, and a primitive for each material and kind of polygon. Faces are
/// split into triangles, and coordinates are stored in single precision.
///
/// # Errors
/// [`MeshFault::Text`](super::MeshFault::Text) when there are more bytes than the format can count.
pub fn write_binary(mesh: &Mesh) -> Result<Vec<u8>, MeshError> {
    let (root, bin) = build(mesh, None);
    let text = serde_json::to_vec(&root).map_err(|e| MeshError::whole(e.to_string()))?;
    let header = gltf::binary::Header { magic: *b"glTF", version: 2, length: 0 };
    let glb = Glb { header, json: Cow::Owned(text), bin: Some(Cow::Owned(bin)) };
    glb.to_vec().map_err(|e| MeshError::whole(e.to_string()))
}

/// Writes the text form, `.gltf`, with its buffer embedded.
///
/// # Errors
/// [`MeshFault::Text`](super::MeshFault::Text) when there are more bytes than the format can count.
pub fn write_text(mesh: &Mesh) -> Result<Vec<u8>, MeshError> {
    let (root, _) = build(mesh, Some("data:application/octet-stream;base64,"));
    serde_json::to_vec(&root).map_err(|e| MeshError::whole(e.to_string()))
}

/// Polygons that share an object, a material and a kind.
struct Part {
    /// Index of the material.
    material: Option<usize>,
    kind: PolygonKind,
    /// The distinct corners, which become the vertices.
    corners: Vec<Corner>,
    /// Index in `corners` of each.
    known: HashMap<Corner, u32>,
    /// The polygons, as indices into `corners`.
    indices: Vec<u32>,
}

impl Part {
    fn add(&mut self, c: &Corner) {
        let next = index32(self.corners.len());
        let index = *self.known.entry(*c).or_insert(next);
        if index == next {
            self.corners.push(*c);
        }
        self.indices.push(index);
    }
}

/// Returns the objects in order, each with its name and parts, and the names of materials that `assets` lacks.
fn parts(mesh: &Mesh, assets: &Assets) -> (Vec<(String, Vec<Part>)>, Vec<String>) {
    let mut objects: Vec<(String, Vec<Part>)> = Vec::new();
    let mut added: Vec<String> = Vec::new();
    let (mut name, mut material, mut begins) = (String::new(), None, true);
    let mut marks = mesh.marks.iter().peekable();
    for (n, (kind, corners)) in mesh.polygons().enumerate() {
        while let Some((_, mark)) = marks.next_if(|(first, _)| *first as usize <= n) {
            match mark {
                Mark::Object(t) | Mark::Group(t) => (name, begins) = (t.clone(), true),
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
        if std::mem::take(&mut begins) {
            objects.push((name.clone(), Vec::new()));
        }
        let Some((_, parts)) = objects.last_mut() else { continue };
        let found = parts.iter().position(|p| p.material == material && p.kind == kind);
        let i = found.unwrap_or_else(|| {
            let (corners, known, indices) = Default::default();
            parts.push(Part { material, kind, corners, known, indices });
            parts.len() - 1
        });
        let part = &mut parts[i];
        match kind {
            PolygonKind::Face => fan(corners).flatten().for_each(|c| part.add(&c)),
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

/// Codes of the component types that are written.
const FLOAT: u32 = 5126;
const UNSIGNED: u32 = 5125;

impl Store {
    fn view(&mut self, bytes: &[u8]) -> usize {
        // Every component must start at a multiple of its size.
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
    let positions = corners().map(|c| (mesh.positions[c.vertex as usize] / METRE).to_array());
    attributes.insert("POSITION".into(), json!(store.floats(positions, true)));
    if corners().all(|c| (c.normal as usize) < mesh.normals.len()) {
        let normals = corners().map(|c| mesh.normals[c.normal as usize].normalize_or_zero().to_array());
        attributes.insert("NORMAL".into(), json!(store.floats(normals, false)));
    }
    if corners().all(|c| (c.uv as usize) < mesh.uvs.len()) {
        // glTF counts v from the top, [`Mesh`] from the bottom.
        let uvs = corners().map(|c| mesh.uvs[c.uv as usize]).map(|[u, v, _]| [u, 1.0 - v]);
        attributes.insert("TEXCOORD_0".into(), json!(store.floats(uvs, false)));
    }
    if mesh.is_colored() {
        let colors = corners().map(|c| mesh.colors[c.vertex as usize]);
        let opaque = |[r, g, b, _]: [f64; 4]| [r, g, b];
        let accessor =
            if mesh.is_translucent() { store.floats(colors, false) } else { store.floats(colors.map(opaque), false) };
        attributes.insert("COLOR_0".into(), json!(accessor));
    }
    let mode = match part.kind {
        PolygonKind::Points => 0,
        PolygonKind::Line => 1,
        PolygonKind::Face => 4,
    };
    let mut out = json!({"attributes": attributes, "indices": store.indices(&part.indices), "mode": mode});
    if let Some(m) = part.material {
        out["material"] = json!(m);
    }
    out
}

/// Returns the JSON and the buffer, which the JSON contains as base64 after the prefix `inline`, if there is one.
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
