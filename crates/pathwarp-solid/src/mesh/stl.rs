//! STL, binary and text, by means of the crate stl_io.
//!
//! STL has triangles without shared vertices, in single precision; corners at one position become one vertex. The number of triangles
//! is checked against the length of the file before it is read.

use super::{Corner, Mesh, MeshError, NONE, PolygonKind, index32};
use glam::DVec3;
use std::borrow::Cow;
use std::io::Cursor;
use stl_io::{Normal, Triangle, Vertex};

/// Bytes before the triangles of a binary file: a header and the number of triangles.
const HEAD: usize = 84;
/// Bytes of a triangle in a binary file.
const TRIANGLE: usize = 50;

/// Returns `true` for an STL file: a binary one of the right length, or text that starts like one.
#[must_use]
pub fn sniff(bytes: &[u8]) -> bool {
    is_binary(bytes) || is_text(bytes)
}

fn is_binary(bytes: &[u8]) -> bool {
    announced(bytes).is_some_and(|n| bytes.len() == HEAD + n * TRIANGLE)
}

/// Returns the number of triangles that a binary file announces.
fn announced(bytes: &[u8]) -> Option<usize> {
    let number: [u8; 4] = bytes.get(HEAD - 4..HEAD)?.try_into().ok()?;
    usize::try_from(u32::from_le_bytes(number)).ok()
}

fn is_text(bytes: &[u8]) -> bool {
    let start = &bytes[..bytes.len().min(1024)];
    let word = start.trim_ascii_start().get(..5);
    word.is_some_and(|w| w.eq_ignore_ascii_case(b"solid")) && !start.contains(&0)
}

/// Reads a mesh.
///
/// # Errors
/// [`MeshFault::Text`](super::MeshFault::Text) when the length does not fit the number of triangles, or a number is not finite.
pub fn read(bytes: &[u8]) -> Result<Mesh, MeshError> {
    if !sniff(bytes) {
        let n = announced(bytes).unwrap_or(0);
        let (length, needed) = (bytes.len(), HEAD + n * TRIANGLE);
        let problem = "has a wrong length for an STL file";
        return Err(MeshError::whole(format!("{problem}: {n} triangles take {needed} bytes, and it has {length}")));
    }
    let bytes: Cow<'_, [u8]> = if !is_binary(bytes) {
        // stl_io knows keywords in lower case only.
        bytes.to_ascii_lowercase().into()
    } else if let Some(rest) = bytes.strip_prefix(b"solid") {
        // Some programs start the header of a binary file like a text file.
        [b"Solid", rest].concat().into()
    } else {
        bytes.into()
    };
    let read = stl_io::read_stl(&mut Cursor::new(bytes))
        .map_err(|e| MeshError::whole(format!("is a damaged STL file: {e}")))?;
    let mut mesh = Mesh::default();
    for (i, v) in read.vertices.iter().enumerate() {
        let p = DVec3::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2]));
        if !p.is_finite() {
            return Err(MeshError::whole(format!("vertex {} is not finite", i + 1)));
        }
        mesh.positions.push(p);
    }
    for face in &read.faces {
        let corner = |v: usize| Corner { vertex: index32(v), uv: NONE, normal: NONE };
        mesh.push(PolygonKind::Face, face.vertices.map(corner));
    }
    if mesh.polygons.is_empty() {
        return Err(MeshError::whole("holds no triangles"));
    }
    Ok(mesh)
}

/// Writes the faces as triangles, in binary.
///
/// # Errors
/// [`MeshFault::Text`](super::MeshFault::Text) when there are more triangles than the format can count.
pub fn write(mesh: &Mesh) -> Result<Vec<u8>, MeshError> {
    let single = |p: DVec3| [p.x as f32, p.y as f32, p.z as f32];
    let triangle = |t: [Corner; 3]| {
        let [a, b, c] = t.map(|c| mesh.positions[c.vertex as usize]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        Triangle { normal: Normal::new(single(normal)), vertices: [a, b, c].map(|p| Vertex::new(single(p))) }
    };
    let triangles: Vec<Triangle> = mesh.triangles().map(triangle).collect();
    if u32::try_from(triangles.len()).is_err() {
        return Err(MeshError::whole("has more triangles than an STL file can count"));
    }
    let mut out = Vec::with_capacity(HEAD + triangles.len() * TRIANGLE);
    stl_io::write_stl(&mut out, triangles.iter()).map_err(|e| MeshError::whole(e.to_string()))?;
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{obj, topology};

    const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

    #[test]
    fn binary_and_text_are_read_and_corners_are_joined() {
        let mesh = obj::read(TETRAHEDRON.as_bytes()).unwrap();
        let bytes = write(&mesh).unwrap();
        assert!(sniff(&bytes) && bytes.len() == HEAD + 4 * TRIANGLE);
        let mut like_text = bytes.clone();
        like_text[..5].copy_from_slice(b"solid");
        let text = "solid t\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 2 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid t\n";
        let upper = text.to_ascii_uppercase();
        for (file, faces, points) in
            [(&bytes[..], 4, 4), (&like_text[..], 4, 4), (text.as_bytes(), 1, 3), (upper.as_bytes(), 1, 3)]
        {
            let back = read(file).unwrap();
            assert_eq!((back.polygons.len(), back.positions.len()), (faces, points));
        }
        assert_eq!(topology(&read(&bytes).unwrap()), topology(&mesh));
    }

    #[test]
    fn damaged_files_are_refused_quickly() {
        let good = write(&obj::read(TETRAHEDRON.as_bytes()).unwrap()).unwrap();
        let mut announced_too_many = good.clone();
        announced_too_many[80..84].copy_from_slice(&1_000_000_000u32.to_le_bytes());
        let mut not_finite = good.clone();
        not_finite[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
        for (file, part) in [
            (&announced_too_many[..], "1000000000 triangles take"),
            (&good[..100], "wrong length"),
            (&not_finite[..], "not finite"),
            (&b"solid a\nfacet normal 0 0\n"[..], "damaged"),
            (&b"solid a\nendsolid a\n"[..], "no triangles"),
        ] {
            let e = read(file).unwrap_err().to_string();
            assert!(e.contains(part), "{part}: {e}");
        }
    }
}
