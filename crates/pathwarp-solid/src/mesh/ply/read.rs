//! Reads PLY.

use super::element::{ALPHA, COLOR, ENDS, Element, INDICES, NORMAL, TEXTURE, UV, place};
use crate::mesh::error::MeshError;
use crate::mesh::model::{Corner, Mesh, NONE, PolygonKind};
use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Encoding, Header, PropertyType, ScalarType};

/// Returns `true` if the file begins like PLY.
#[must_use]
pub fn sniff(bytes: &[u8]) -> bool {
    bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r")
}

/// Reads a mesh: vertices with normals, colours and texture coordinates, faces and edges. What else there is, is named in
/// [`Mesh::left_out`].
///
/// # Errors
/// The file is damaged: more announced than there is, an index out of range, a number that is not finite.
pub fn read(bytes: &[u8]) -> Result<Mesh, MeshError> {
    let damaged = |e: ParseError| {
        let text: String = e.to_string().lines().next().unwrap_or_default().chars().take(200).collect();
        MeshError::whole(format!("is a damaged PLY file: {text}"))
    };
    let parser = Parser::<Element>::new();
    let mut reader = Reader::new(bytes);
    let header = parser.read_header(&mut reader).map_err(damaged)?;
    let mut mesh = Mesh::default();
    for element in header.elements.values() {
        check_announced(element, &header, reader.get_ref().len())?;
        let all = parser.read_payload_for_element(&mut reader, element, &header).map_err(damaged)?;
        match element.name.as_str() {
            "vertex" => vertices(&mut mesh, element, &all)?,
            "face" => faces(&mut mesh, element, &all)?,
            "edge" => edges(&mut mesh, &all)?,
            other => mesh.left_out.push(format!("{} elements `{other}`", all.len())),
        }
        mesh.left_out.extend(unknown(element));
    }
    if mesh.positions.is_empty() {
        return Err(MeshError::whole("holds no vertices"));
    }
    Ok(mesh)
}

/// Checks that so many elements fit into the rest of the file, before it is read.
fn check_announced(element: &ElementDef, header: &Header, left: usize) -> Result<(), MeshError> {
    let bytes = |t: &ScalarType| match t {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    };
    let least: usize = match header.encoding {
        // A digit and a space or line end for each.
        Encoding::Ascii => 2 * element.properties.len(),
        _ => element
            .properties
            .values()
            .map(|p| match &p.data_type {
                PropertyType::Scalar(t) | PropertyType::List(t, _) => bytes(t),
            })
            .sum(),
    };
    let name = &element.name;
    if least == 0 && element.count > 0 {
        return Err(MeshError::whole(format!("announces elements `{name}` without properties")));
    }
    // The last line may lack its end.
    if element.count.saturating_mul(least) > left + 1 {
        let n = element.count;
        return Err(MeshError::whole(format!("announces {n} elements `{name}`, and {left} bytes are left for them")));
    }
    Ok(())
}

/// Properties that are not read.
fn unknown(element: &ElementDef) -> Option<String> {
    let known = |name: &str| match element.name.as_str() {
        "vertex" => place(name).is_some(),
        "face" => INDICES.contains(&name) || name == TEXTURE,
        "edge" => ENDS.contains(&name),
        _ => true,
    };
    let names: Vec<&str> = element.properties.keys().map(String::as_str).filter(|n| !known(n)).take(8).collect();
    (!names.is_empty()).then(|| format!("properties of elements `{}`: {}", element.name, names.join(", ")))
}

fn vertices(mesh: &mut Mesh, element: &ElementDef, all: &[Element]) -> Result<(), MeshError> {
    let has = |from: usize, n: usize| (from..from + n).all(|i| element.properties.keys().any(|k| place(k) == Some(i)));
    if !has(0, 3) {
        return Err(MeshError::whole("has vertices without x, y and z"));
    }
    for (i, e) in all.iter().enumerate() {
        let v = &e.values;
        // The square of a larger number overflows.
        if !v.iter().all(|v| v.abs() < 1e100) {
            return Err(MeshError::whole(format!("vertex {} is not finite", i + 1)));
        }
        mesh.positions.push(DVec3::new(v[0], v[1], v[2]));
        if has(NORMAL, 3) {
            mesh.normals.push(DVec3::new(v[NORMAL], v[NORMAL + 1], v[NORMAL + 2]));
        }
        if has(COLOR, 3) {
            let alpha = if has(ALPHA, 1) { v[ALPHA] } else { 1.0 };
            mesh.colors.push([v[COLOR], v[COLOR + 1], v[COLOR + 2], alpha]);
        }
        if has(UV, 2) {
            mesh.uvs.push([v[UV], v[UV + 1], 0.0]);
        }
    }
    Ok(())
}

fn faces(mesh: &mut Mesh, element: &ElementDef, all: &[Element]) -> Result<(), MeshError> {
    if !INDICES.iter().any(|n| element.properties.contains_key(*n)) {
        return Err(MeshError::whole("has faces without vertex_indices"));
    }
    let (normals, uvs) = (!mesh.normals.is_empty(), mesh.uvs.len() == mesh.positions.len());
    let mut small = 0;
    for (i, e) in all.iter().enumerate() {
        check_indices(mesh, e, "face", i)?;
        if e.indices.len() < 3 {
            small += 1;
            continue;
        }
        let first = u32::try_from(mesh.uvs.len()).unwrap_or(NONE);
        let cornered = e.uvs.len() == 2 * e.indices.len();
        if cornered {
            mesh.uvs.extend(e.uvs.chunks(2).map(|c| [f64::from(c[0]), f64::from(c[1]), 0.0]));
        }
        let corner = |(k, v): (usize, &u32)| Corner {
            vertex: *v,
            uv: if cornered {
                first.saturating_add(u32::try_from(k).unwrap_or(NONE))
            } else if uvs {
                *v
            } else {
                NONE
            },
            normal: if normals { *v } else { NONE },
        };
        mesh.push(PolygonKind::Face, e.indices.iter().enumerate().map(corner));
    }
    if small > 0 {
        mesh.left_out.push(format!("{small} faces of fewer than three corners"));
    }
    Ok(())
}

fn edges(mesh: &mut Mesh, all: &[Element]) -> Result<(), MeshError> {
    for (i, e) in all.iter().enumerate() {
        check_indices(mesh, e, "edge", i)?;
        if e.indices.len() == 2 {
            let corner = |v: &u32| Corner { vertex: *v, uv: NONE, normal: NONE };
            mesh.push(PolygonKind::Line, e.indices.iter().map(corner));
        }
    }
    Ok(())
}

fn check_indices(mesh: &Mesh, e: &Element, kind: &str, i: usize) -> Result<(), MeshError> {
    let n = mesh.positions.len();
    if e.damaged || e.indices.iter().any(|v| *v as usize >= n) {
        return Err(MeshError::whole(format!(
            "an index of {kind} {} is out of range: there are {n} vertices before it",
            i + 1
        )));
    }
    Ok(())
}
