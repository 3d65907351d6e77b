//! Writes PLY, binary, with coordinates in double precision.

use super::element::{ALPHA, COLOR, ENDS, Element, INDICES, NORMAL, UV};
use crate::mesh::error::MeshError;
use crate::mesh::model::{Mesh, NONE, PolygonKind};
use crate::mesh::unify::unify;
use ply_rs_bw::ply::{Addable, ElementDef, Encoding, Ply, PropertyDef, PropertyType, ScalarType};
use ply_rs_bw::writer::Writer;

/// Writes a mesh. A vertex becomes several if its corners differ in texture coordinates or normals.
///
/// # Errors
/// The crate's.
pub fn write(mesh: &Mesh) -> Result<Vec<u8>, MeshError> {
    let unified = unify(mesh);
    let colored = mesh.colors.len() == mesh.positions.len() && !mesh.colors.is_empty();
    let (with_uvs, with_normals) =
        (unified.corners.iter().any(|c| c.uv != NONE), unified.corners.iter().any(|c| c.normal != NONE));
    let mut vertices = Vec::with_capacity(unified.corners.len());
    for c in &unified.corners {
        let mut e = Element::default();
        e.values[..3].copy_from_slice(&mesh.positions[c.vertex as usize].to_array());
        if let Some(n) = mesh.normals.get(c.normal as usize) {
            e.values[NORMAL..NORMAL + 3].copy_from_slice(&n.to_array());
        }
        if colored {
            e.values[COLOR..=ALPHA].copy_from_slice(&mesh.colors[c.vertex as usize]);
        }
        if let Some(uv) = mesh.uvs.get(c.uv as usize) {
            e.values[UV..UV + 2].copy_from_slice(&uv[..2]);
        }
        vertices.push(e);
    }
    let (mut faces, mut edges) = (Vec::new(), Vec::new());
    let mut rest = &unified.index[..];
    for (kind, corners) in mesh.polygons() {
        let (own, after) = rest.split_at(corners.len().min(rest.len()));
        rest = after;
        let element = |own: &[u32]| Element { indices: own.to_vec(), ..Element::default() };
        match kind {
            PolygonKind::Face => faces.push(element(own)),
            PolygonKind::Line => edges.extend(own.windows(2).map(element)),
            // Vertices without a face are points by themselves.
            PolygonKind::Points => {}
        }
    }
    let largest = faces.iter().map(|f| f.indices.len()).max().unwrap_or(0);
    let count = if u8::try_from(largest).is_ok() { ScalarType::UChar } else { ScalarType::UInt };
    let mut ply = Ply::<Element>::new();
    ply.header.encoding = Encoding::BinaryLittleEndian;
    let scalars = |names: &[&'static str], t: ScalarType| -> Vec<(&'static str, PropertyType)> {
        names.iter().map(|n| (*n, PropertyType::Scalar(t.clone()))).collect()
    };
    let mut properties = scalars(&["x", "y", "z"], ScalarType::Double);
    if with_normals {
        properties.extend(scalars(&["nx", "ny", "nz"], ScalarType::Float));
    }
    if with_uvs {
        properties.extend(scalars(&["s", "t"], ScalarType::Float));
    }
    if colored {
        let opacity: &[&str] = if mesh.is_translucent() { &["alpha"] } else { &[] };
        properties.extend(scalars(&[&["red", "green", "blue"], opacity].concat(), ScalarType::UChar));
    }
    add(&mut ply, "vertex", properties, vertices);
    add(&mut ply, "face", vec![(INDICES[0], PropertyType::List(count, ScalarType::UInt))], faces);
    if !edges.is_empty() {
        add(&mut ply, "edge", scalars(&ENDS, ScalarType::UInt), edges);
    }
    let mut out = Vec::new();
    Writer::new().write_ply(&mut out, &mut ply).map_err(|e| MeshError::whole(e.to_string()))?;
    Ok(out)
}

fn add(ply: &mut Ply<Element>, name: &str, properties: Vec<(&str, PropertyType)>, all: Vec<Element>) {
    let mut element = ElementDef::new(name.to_owned());
    element.count = all.len();
    for (name, kind) in properties {
        element.properties.add(PropertyDef::new(name.to_owned(), kind));
    }
    ply.header.elements.add(element);
    ply.payload.insert(name.to_owned(), all);
}
