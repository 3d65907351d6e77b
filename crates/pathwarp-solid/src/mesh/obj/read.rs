//! Reads OBJ: the text is cut at line ends, the parts are read by all threads, and joined.

use super::tokens::{index, number, shown, vector, words};
use crate::mesh::error::MeshError;
use crate::mesh::model::{Corner, Mark, Mesh, NONE, Polygon, PolygonKind};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Bytes of a part.
const PART: usize = 1 << 20;

/// Reads a mesh. Statements that are not polygons (free-form curves and surfaces, display settings) are counted in
/// [`Mesh::left_out`].
///
/// # Errors
/// A line that is damaged, or an index that is out of range.
pub fn read(text: &[u8]) -> Result<Mesh, MeshError> {
    let joined;
    let text = if has_continuation(text) {
        joined = join_lines(text);
        &joined[..]
    } else {
        text
    };
    if text.iter().take(1024).any(|b| *b == 0) {
        return Err(MeshError::whole("is not an OBJ file: it holds bytes that are not text"));
    }
    let parts: Vec<&[u8]> = split(text);
    let read: Vec<Result<Part, (usize, String)>> = parts.par_iter().map(|p| part(p)).collect();
    let mut mesh = Mesh::default();
    let mut skipped: BTreeMap<String, usize> = BTreeMap::new();
    let mut lines = 0;
    for (part, text) in read.into_iter().zip(&parts) {
        let part = part.map_err(|(line, problem)| MeshError::at(lines + line, problem))?;
        join(&mut mesh, part, &mut skipped);
        lines += text.iter().filter(|b| **b == b'\n').count();
    }
    check(&mesh, text)?;
    if mesh.positions.is_empty() {
        return Err(MeshError::whole("holds no vertices (lines `v x y z`)"));
    }
    mesh.left_out = skipped.into_iter().map(|(what, n)| format!("{n} lines of `{what}`")).collect();
    Ok(mesh)
}

/// Returns `true` if a line ends with a backslash.
fn has_continuation(text: &[u8]) -> bool {
    // Files rarely hold a backslash at all, and looking for one byte is fast.
    text.contains(&b'\\') && text.split(|b| *b == b'\n').any(|line| line.trim_ascii_end().ends_with(b"\\"))
}

/// Joins lines that end with a backslash.
fn join_lines(text: &[u8]) -> Vec<u8> {
    let mut out = Vec::with_capacity(text.len());
    for line in text.split_inclusive(|b| *b == b'\n') {
        let bare = line.trim_ascii_end();
        match bare.strip_suffix(b"\\") {
            Some(rest) => {
                out.extend_from_slice(rest);
                out.push(b' ');
            }
            None => out.extend_from_slice(line),
        }
    }
    out
}

fn split(mut text: &[u8]) -> Vec<&[u8]> {
    let mut out = Vec::new();
    while text.len() > PART {
        let end = text[PART..].iter().position(|b| *b == b'\n').map_or(text.len(), |i| PART + i + 1);
        let (head, tail) = text.split_at(end);
        out.push(head);
        text = tail;
    }
    out.push(text);
    out
}

/// The statements of one part of the text.
#[derive(Default)]
struct Part {
    mesh: Mesh,
    /// Indices that count back from the end: field of the corner (vertex, uv, normal), corner, index relative to the part's own
    /// first vertex, uv or normal.
    relative: Vec<(usize, usize, i64)>,
    skipped: BTreeMap<String, usize>,
}

/// Reads a part. An error has the line within it, from 1.
fn part(text: &[u8]) -> Result<Part, (usize, String)> {
    let mut out = Part::default();
    for (n, line) in text.split(|b| *b == b'\n').enumerate() {
        statement(line, &mut out).map_err(|problem| (n + 1, problem))?;
    }
    Ok(out)
}

fn statement(line: &[u8], out: &mut Part) -> Result<(), String> {
    let mut rest = words(line);
    let Some(keyword) = rest.next() else { return Ok(()) };
    let damaged = |what: &str| format!("`{}` is not {what}", shown(line));
    let mesh = &mut out.mesh;
    match keyword {
        b"v" => {
            mesh.positions.push(vector(&mut rest).ok_or_else(|| damaged("a vertex `v x y z` with finite numbers"))?);
            if let Some(color) = vector(&mut rest) {
                // Vertices before the first colour are white.
                mesh.colors.resize(mesh.positions.len() - 1, [1.0; 4]);
                mesh.colors.push(color.extend(1.0).to_array());
            }
        }
        b"vn" => mesh.normals.push(vector(rest).ok_or_else(|| damaged("a normal `vn x y z`"))?),
        b"vt" => {
            let uv: Option<Vec<f64>> = rest.take(3).map(number).collect();
            let uv = uv.filter(|uv| !uv.is_empty()).ok_or_else(|| damaged("texture coordinates `vt u v`"))?;
            mesh.uvs.push(std::array::from_fn(|k| uv.get(k).copied().unwrap_or(0.0)));
        }
        b"f" => polygon(PolygonKind::Face, 3, rest, out).map_err(|what| damaged(&what))?,
        b"l" => polygon(PolygonKind::Line, 2, rest, out).map_err(|what| damaged(&what))?,
        b"p" => polygon(PolygonKind::Points, 1, rest, out).map_err(|what| damaged(&what))?,
        b"o" => mark(mesh, Mark::Object(text_after(line, keyword))),
        b"g" => mark(mesh, Mark::Group(text_after(line, keyword))),
        b"usemtl" => mark(mesh, Mark::Material(text_after(line, keyword))),
        b"s" => mark(mesh, Mark::Smoothing(text_after(line, keyword))),
        b"mtllib" => mark(mesh, Mark::Library(text_after(line, keyword))),
        _ => *out.skipped.entry(shown(keyword)).or_default() += 1,
    }
    Ok(())
}

fn mark(mesh: &mut Mesh, mark: Mark) {
    mesh.marks.push((u32::try_from(mesh.polygons.len()).unwrap_or(NONE), mark));
}

fn text_after(line: &[u8], keyword: &[u8]) -> String {
    String::from_utf8_lossy(&line.trim_ascii()[keyword.len()..]).trim().to_owned()
}

/// Reads the corners `v`, `v/uv`, `v//n` or `v/uv/n`. The error says what the line should be.
fn polygon<'a>(
    kind: PolygonKind,
    fewest: usize,
    words: impl Iterator<Item = &'a [u8]>,
    out: &mut Part,
) -> Result<(), String> {
    let first = out.mesh.corners.len();
    let counts = [out.mesh.positions.len(), out.mesh.uvs.len(), out.mesh.normals.len()];
    for word in words {
        let mut corner = [NONE; 3];
        for (field, text) in word.split(|b| *b == b'/').enumerate() {
            if text.is_empty() && field > 0 {
                continue;
            }
            let i = index(text).filter(|_| field < 3).ok_or("a polygon of corners v, v/vt, v//vn or v/vt/vn")?;
            if i > 0 {
                corner[field] = u32::try_from(i - 1).unwrap_or(NONE);
            } else {
                let here = i64::try_from(counts[field]).unwrap_or(i64::MAX);
                out.relative.push((field, out.mesh.corners.len(), here + i));
            }
        }
        let [vertex, uv, normal] = corner;
        out.mesh.corners.push(Corner { vertex, uv, normal });
    }
    if out.mesh.corners.len() - first < fewest {
        return Err(format!("a polygon of at least {fewest} corners"));
    }
    out.mesh.polygons.push(Polygon { end: u32::try_from(out.mesh.corners.len()).unwrap_or(NONE), kind });
    Ok(())
}

/// Appends a part to the mesh.
fn join(mesh: &mut Mesh, part: Part, skipped: &mut BTreeMap<String, usize>) {
    let base = [mesh.positions.len(), mesh.uvs.len(), mesh.normals.len()];
    let (corners, polygons) = (mesh.corners.len(), mesh.polygons.len());
    let mut own = part.mesh;
    for (field, corner, i) in part.relative {
        let i = i64::try_from(base[field]).unwrap_or(i64::MAX) + i;
        let c = &mut own.corners[corner];
        let slot = [&mut c.vertex, &mut c.uv, &mut c.normal];
        if let Some(slot) = slot.into_iter().nth(field) {
            // One before the last index is out of range, and not the missing one.
            *slot = u32::try_from(i).unwrap_or(NONE - 1);
        }
    }
    if !own.colors.is_empty() || !mesh.colors.is_empty() {
        mesh.colors.resize(base[0], [1.0; 4]);
        own.colors.resize(own.positions.len(), [1.0; 4]);
        mesh.colors.append(&mut own.colors);
    }
    mesh.positions.append(&mut own.positions);
    mesh.uvs.append(&mut own.uvs);
    mesh.normals.append(&mut own.normals);
    mesh.corners.append(&mut own.corners);
    let shift = u32::try_from(corners).unwrap_or(NONE);
    mesh.polygons.extend(own.polygons.iter().map(|p| Polygon { end: p.end.saturating_add(shift), ..*p }));
    let shift = u32::try_from(polygons).unwrap_or(NONE);
    mesh.marks.extend(own.marks.into_iter().map(|(first, m)| (first.saturating_add(shift), m)));
    for (what, n) in part.skipped {
        *skipped.entry(what).or_default() += n;
    }
}

/// Checks that every index is in range.
fn check(mesh: &Mesh, text: &[u8]) -> Result<(), MeshError> {
    let counts = [mesh.positions.len(), mesh.uvs.len(), mesh.normals.len()];
    let bad = |c: &Corner| {
        let optional = |i: u32, n: usize| i == NONE || (i as usize) < n;
        (c.vertex as usize) >= counts[0] || !optional(c.uv, counts[1]) || !optional(c.normal, counts[2])
    };
    let Some(at) = mesh.corners.par_iter().position_first(bad) else { return Ok(()) };
    let polygon = mesh.polygons.partition_point(|p| p.end as usize <= at);
    let problem = format!(
        "an index is out of range: there are {} vertices, {} texture coordinates and {} normals",
        counts[0], counts[1], counts[2]
    );
    Err(match line_of(text, polygon) {
        Some(line) => MeshError::at(line, problem),
        None => MeshError::whole(problem),
    })
}

/// The line of a polygon.
fn line_of(text: &[u8], polygon: usize) -> Option<usize> {
    let is_polygon = |line: &[u8]| matches!(words(line).next(), Some(b"f" | b"l" | b"p"));
    let mut lines = text.split(|b| *b == b'\n').enumerate().filter(|(_, line)| is_polygon(line));
    lines.nth(polygon).map(|(n, _)| n + 1)
}
