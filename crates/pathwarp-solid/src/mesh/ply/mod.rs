//! PLY, text and binary, by means of the crate ply-rs-bw. Faces are not split into triangles.

#[cfg(test)]
mod tests;

use super::{Corner, Mesh, MeshError, NONE, PolygonKind, fan, index32, unify};
use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    Addable, ElementDef, Encoding, Header, Ply, Property, PropertyAccess, PropertyAccessResult, PropertyDef,
    PropertyType, ScalarType,
};
use ply_rs_bw::writer::Writer;
use std::borrow::Cow;

/// The names of a vertex's numbers, in the order of [`Element::values`]; each number may have several names.
const NAMES: [&[&str]; 12] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["red", "r", "diffuse_red"],
    &["green", "g", "diffuse_green"],
    &["blue", "b", "diffuse_blue"],
    &["alpha", "a", "diffuse_alpha"],
    &["s", "u", "texture_u"],
    &["t", "v", "texture_v"],
];
/// Indices in [`Element::values`] of the first normal, colour, opacity and texture coordinate.
const NORMAL: usize = 3;
const COLOR: usize = 6;
const ALPHA: usize = 9;
const UV: usize = 10;

/// The names of the list of a face's vertices.
const INDICES: [&str; 2] = ["vertex_indices", "vertex_index"];
/// The name of the list of a face's texture coordinates.
const TEXTURE: &str = "texcoord";
/// The names of the ends of an edge.
const ENDS: [&str; 2] = ["vertex1", "vertex2"];

/// Returns the index of a vertex property in [`Element::values`].
fn value_index(name: &str) -> Option<usize> {
    NAMES.iter().position(|all| all.contains(&name))
}

/// A vertex, face or edge.
#[derive(Debug, Default)]
struct Element {
    /// The numbers of a vertex.
    values: [f64; 12],
    /// The vertices of a face or an edge.
    indices: Vec<u32>,
    /// u and v for each corner of a face.
    uvs: Vec<f32>,
    /// `true` if an index is negative or not a whole number.
    damaged: bool,
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let single = match &property {
            Property::Char(v) => Some(f64::from(*v)),
            Property::UChar(v) => Some(f64::from(*v)),
            Property::Short(v) => Some(f64::from(*v)),
            Property::UShort(v) => Some(f64::from(*v)),
            Property::Int(v) => Some(f64::from(*v)),
            Property::UInt(v) => Some(f64::from(*v)),
            Property::Float(v) => Some(f64::from(*v)),
            Property::Double(v) => Some(*v),
            _ => None,
        };
        if let (Some(v), Some(i)) = (single, value_index(name)) {
            // Colours in single bytes range up to 255.
            let is_byte = (COLOR..UV).contains(&i) && matches!(property, Property::UChar(_));
            self.values[i] = if is_byte { v / 255.0 } else { v };
        } else if let (Some(v), true) = (single, ENDS.contains(&name)) {
            self.damaged |= v < 0.0 || v.fract() != 0.0;
            // Casting a number that is too large gives `u32::MAX`, which is out of range.
            self.indices.push(v as u32);
        } else if INDICES.contains(&name) {
            self.set_indices(property);
        } else if name == TEXTURE {
            match property {
                Property::ListFloat(v) => self.uvs = v,
                Property::ListDouble(v) => self.uvs = v.into_iter().map(|v| v as f32).collect(),
                _ => return PropertyAccessResult::Ignored,
            }
        } else {
            return PropertyAccessResult::Ignored;
        }
        PropertyAccessResult::Set
    }

    fn get_float(&self, name: &str) -> Option<f32> {
        value_index(name).map(|i| self.values[i] as f32)
    }

    fn get_double(&self, name: &str) -> Option<f64> {
        value_index(name).map(|i| self.values[i])
    }

    fn get_uchar(&self, name: &str) -> Option<u8> {
        // The cast saturates.
        value_index(name).map(|i| (self.values[i] * 255.0).round() as u8)
    }

    fn get_uint(&self, name: &str) -> Option<u32> {
        ENDS.iter().position(|e| *e == name).and_then(|i| self.indices.get(i).copied())
    }

    fn get_list_uint(&self, name: &str) -> Option<&[u32]> {
        INDICES.contains(&name).then_some(&self.indices)
    }
}

impl Element {
    fn set_indices(&mut self, property: Property) {
        let mut is_damaged = false;
        let mut index = |v: Option<u32>| {
            is_damaged |= v.is_none();
            v.unwrap_or(u32::MAX)
        };
        self.indices = match property {
            Property::ListChar(v) => v.into_iter().map(|v| index(u32::try_from(v).ok())).collect(),
            Property::ListUChar(v) => v.into_iter().map(u32::from).collect(),
            Property::ListShort(v) => v.into_iter().map(|v| index(u32::try_from(v).ok())).collect(),
            Property::ListUShort(v) => v.into_iter().map(u32::from).collect(),
            Property::ListInt(v) => v.into_iter().map(|v| index(u32::try_from(v).ok())).collect(),
            Property::ListUInt(v) => v,
            _ => vec![index(None)],
        };
        self.damaged |= is_damaged;
    }
}

/// Returns `true` if the file starts like PLY.
#[must_use]
pub fn sniff(bytes: &[u8]) -> bool {
    bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r")
}

/// Reads a mesh: vertices with normals, colours and texture coordinates, faces, and edges. Anything else is named in [`Mesh::left_out`].
///
/// # Errors
/// [`MeshFault::Text`](super::MeshFault::Text) when the file announces too much, an index is out of range, or a number not finite.
pub fn read(bytes: &[u8]) -> Result<Mesh, MeshError> {
    let damaged = |e: ParseError| {
        let text: String = e.to_string().lines().next().unwrap_or_default().chars().take(200).collect();
        MeshError::whole(format!("is a damaged PLY file: {text}"))
    };
    let bytes = normalized(bytes);
    let parser = Parser::<Element>::new();
    let mut reader = Reader::new(&*bytes);
    let header = parser.read_header(&mut reader).map_err(damaged)?;
    let mut mesh = Mesh::default();
    for element in header.elements.values() {
        check_count(element, &header, reader.get_ref().len())?;
        let all = parser.read_payload_for_element(&mut reader, element, &header).map_err(damaged)?;
        match element.name.as_str() {
            "vertex" => vertices(&mut mesh, element, &all)?,
            "face" => faces(&mut mesh, element, &all)?,
            "edge" => edges(&mut mesh, &all)?,
            other => mesh.left_out.push(format!("{} elements `{other}`", all.len())),
        }
        mesh.left_out.extend(unknown_properties(element));
    }
    if mesh.positions.is_empty() {
        return Err(MeshError::whole("holds no vertices"));
    }
    Ok(mesh)
}

/// Returns text that the parser can read: numbers like `.5` and `5.` get their zeros, empty lines go. Binary files are unchanged.
fn normalized(bytes: &[u8]) -> Cow<'_, [u8]> {
    /// Bytes at the beginning within which the format is declared.
    const HEAD: usize = 1024;
    const ASCII: &[u8] = b"format ascii";
    let is_text = bytes.windows(ASCII.len()).take(HEAD).any(|w| w == ASCII);
    let Some(text) = std::str::from_utf8(bytes).ok().filter(|_| is_text) else { return bytes.into() };
    let lacks_zero =
        |t: &str| t.trim_start_matches(['+', '-']).starts_with('.') || t.ends_with('.') || t.contains(".e");
    let is_odd = |t: &str| lacks_zero(&t.to_ascii_lowercase()) && t.parse::<f64>().is_ok();
    let lines = || text.split(['\n', '\r']).map(str::trim_ascii);
    let is_odd_line = |line: &str| line.is_empty() || line.split_ascii_whitespace().any(is_odd);
    if !lines().rev().skip(1).any(is_odd_line) {
        return bytes.into();
    }
    let mut out = String::with_capacity(text.len() + HEAD);
    for line in lines().filter(|line| !line.is_empty()) {
        for word in line.split_ascii_whitespace() {
            match word.parse::<f64>() {
                Ok(v) if is_odd(word) => out.push_str(&v.to_string()),
                _ => out.push_str(word),
            }
            out.push(' ');
        }
        out.pop();
        out.push('\n');
    }
    out.into_bytes().into()
}

/// Checks, before elements are read, that as many as announced fit into the `left` bytes of the file.
fn check_count(element: &ElementDef, header: &Header, left: usize) -> Result<(), MeshError> {
    let bytes = |t: &ScalarType| match t {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    };
    // A list takes at least the bytes of its length.
    let min_bytes = |p: &PropertyDef| match &p.data_type {
        PropertyType::Scalar(t) | PropertyType::List(t, _) => bytes(t),
    };
    let min_size: usize = match header.encoding {
        // A digit and a space or line end for each property.
        Encoding::Ascii => 2 * element.properties.len(),
        _ => element.properties.values().map(min_bytes).sum(),
    };
    let name = &element.name;
    if min_size == 0 && element.count > 0 {
        return Err(MeshError::whole(format!("announces elements `{name}` without properties")));
    }
    // The last line may lack its line break.
    if element.count.saturating_mul(min_size) > left + 1 {
        let n = element.count;
        return Err(MeshError::whole(format!(
            "announces {n} elements `{name}`, but only {left} bytes are left for them"
        )));
    }
    Ok(())
}

/// Names the properties that are not read.
fn unknown_properties(element: &ElementDef) -> Option<String> {
    let known = |name: &str| match element.name.as_str() {
        "vertex" => value_index(name).is_some(),
        "face" => INDICES.contains(&name) || name == TEXTURE,
        "edge" => ENDS.contains(&name),
        _ => true,
    };
    let names: Vec<&str> = element.properties.keys().map(String::as_str).filter(|n| !known(n)).take(8).collect();
    (!names.is_empty()).then(|| format!("properties of elements `{}`: {}", element.name, names.join(", ")))
}

fn vertices(mesh: &mut Mesh, element: &ElementDef, all: &[Element]) -> Result<(), MeshError> {
    let known: Vec<usize> = element.properties.keys().filter_map(|k| value_index(k)).collect();
    let has = |first: usize, n: usize| (first..first + n).all(|i| known.contains(&i));
    if !has(0, 3) {
        return Err(MeshError::whole("has vertices without x, y and z"));
    }
    for (i, e) in all.iter().enumerate() {
        let v = &e.values;
        // The square of a larger number would overflow.
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
    let (has_normals, has_uvs) = (!mesh.normals.is_empty(), mesh.uvs.len() == mesh.positions.len());
    let mut small = 0;
    for (i, e) in all.iter().enumerate() {
        check_indices(mesh, e, "face", i)?;
        if e.indices.len() < 3 {
            small += 1;
            continue;
        }
        let first_uv = index32(mesh.uvs.len());
        let corners_have_uvs = e.uvs.len() == 2 * e.indices.len();
        if corners_have_uvs {
            mesh.uvs.extend(e.uvs.chunks(2).map(|c| [f64::from(c[0]), f64::from(c[1]), 0.0]));
        }
        let corner = |(k, v): (usize, &u32)| {
            let by_vertex = |has: bool| if has { *v } else { NONE };
            let uv = if corners_have_uvs { first_uv.saturating_add(index32(k)) } else { by_vertex(has_uvs) };
            Corner { vertex: *v, uv, normal: by_vertex(has_normals) }
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
        let problem = format!("is out of range: there are {n} vertices before it");
        return Err(MeshError::whole(format!("an index of {kind} {} {problem}", i + 1)));
    }
    Ok(())
}

/// Writes a mesh. A vertex becomes several if its corners differ in texture coordinates or normals. Faces of different sizes become
/// triangles.
///
/// # Errors
/// [`MeshFault::Text`](super::MeshFault::Text) with the message of the crate that writes the file.
pub fn write(mesh: &Mesh) -> Result<Vec<u8>, MeshError> {
    let unified = unify(mesh);
    let has_uvs = unified.corners.iter().any(|c| c.uv != NONE);
    let has_normals = unified.corners.iter().any(|c| c.normal != NONE);
    let mut vertices = Vec::with_capacity(unified.corners.len());
    for c in &unified.corners {
        let mut e = Element::default();
        e.values[..3].copy_from_slice(&mesh.positions[c.vertex as usize].to_array());
        if let Some(n) = mesh.normals.get(c.normal as usize) {
            e.values[NORMAL..NORMAL + 3].copy_from_slice(&n.to_array());
        }
        if mesh.is_colored() {
            e.values[COLOR..=ALPHA].copy_from_slice(&mesh.colors[c.vertex as usize]);
        }
        if let Some(uv) = mesh.uvs.get(c.uv as usize) {
            e.values[UV..UV + 2].copy_from_slice(&uv[..2]);
        }
        vertices.push(e);
    }
    let element = |indices: &[u32]| Element { indices: indices.to_vec(), ..Element::default() };
    let (mut faces, mut edges) = (Vec::new(), Vec::new());
    let mut rest = &unified.index[..];
    for (kind, corners) in mesh.polygons() {
        let (indices, after) = rest.split_at(corners.len().min(rest.len()));
        rest = after;
        match kind {
            PolygonKind::Face => faces.push(element(indices)),
            PolygonKind::Line => edges.extend(indices.windows(2).map(element)),
            // Points need no element: a vertex without a face is read as one.
            PolygonKind::Points => {}
        }
    }
    // Some readers, such as trimesh, accept faces of one size only.
    if faces.windows(2).any(|w| w[0].indices.len() != w[1].indices.len()) {
        faces = faces.iter().flat_map(|f| fan(&f.indices).map(|t| element(&t))).collect();
    }
    let largest = faces.iter().map(|f| f.indices.len()).max().unwrap_or(0);
    let count = if u8::try_from(largest).is_ok() { ScalarType::UChar } else { ScalarType::UInt };
    let mut ply = Ply::<Element>::new();
    ply.header.encoding = Encoding::BinaryLittleEndian;
    let scalars = |names: &[&'static str], t: ScalarType| -> Vec<(&'static str, PropertyType)> {
        names.iter().map(|n| (*n, PropertyType::Scalar(t.clone()))).collect()
    };
    let mut properties = scalars(&["x", "y", "z"], ScalarType::Double);
    if has_normals {
        properties.extend(scalars(&["nx", "ny", "nz"], ScalarType::Float));
    }
    if has_uvs {
        properties.extend(scalars(&["s", "t"], ScalarType::Float));
    }
    if mesh.is_colored() {
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
