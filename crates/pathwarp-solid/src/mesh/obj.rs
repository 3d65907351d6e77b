//! Wavefront OBJ: polygons with groups, materials, texture coordinates and normals.
//!
//! A deformed file differs from its source in coordinates only. Crates that read OBJ return triangles by material, without groups,
//! polylines or the order of objects, so none is used here. Long files are read and written on all threads; the result does not depend
//! on their number.

use super::{Corner, Mark, Mesh, MeshError, NONE, Polygon, PolygonKind, index32};
use glam::DVec3;
use rayon::prelude::*;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The text is cut at line ends into parts of about this many bytes, which are read in parallel and joined.
const PART: usize = 1 << 20;

/// Reads a mesh. Statements that do not describe polygons (free-form curves and surfaces, display settings) are counted in
/// [`Mesh::left_out`].
///
/// # Errors
/// [`MeshFault::Text`](super::MeshFault::Text) with the line that is damaged or has an index out of range.
pub fn read(text: &[u8]) -> Result<Mesh, MeshError> {
    let text: Cow<'_, [u8]> = if has_continuation(text) { join_lines(text).into() } else { text.into() };
    if text.iter().take(1024).any(|b| *b == 0) {
        return Err(MeshError::whole("is not an OBJ file: it holds bytes that are not text"));
    }
    let parts: Vec<&[u8]> = split_at_lines(&text);
    let read: Vec<Result<Part, (usize, String)>> = parts.par_iter().map(|p| read_part(p)).collect();
    let mut mesh = Mesh::default();
    let mut skipped: BTreeMap<String, usize> = BTreeMap::new();
    let mut lines_before = 0;
    for (part, text) in read.into_iter().zip(&parts) {
        let part = part.map_err(|(line, problem)| MeshError::at_line(lines_before + line, problem))?;
        append(&mut mesh, part, &mut skipped);
        lines_before += text.iter().filter(|b| **b == b'\n').count();
    }
    check_indices(&mesh, &text)?;
    if mesh.positions.is_empty() {
        return Err(MeshError::whole("holds no vertices (lines `v x y z`); models are read as OBJ, STL, PLY and glTF"));
    }
    mesh.left_out = skipped.into_iter().map(|(what, n)| format!("{n} lines of `{what}`")).collect();
    Ok(mesh)
}

/// Returns `true` if any line ends with a backslash.
fn has_continuation(text: &[u8]) -> bool {
    // Few files contain a backslash at all, and searching for a single byte is fast.
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

fn split_at_lines(mut text: &[u8]) -> Vec<&[u8]> {
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
    /// Indices that count back from the end: field (vertex, uv or normal), corner, and index relative to the part's first vertex, uv or
    /// normal.
    relative: Vec<(usize, usize, i64)>,
    skipped: BTreeMap<String, usize>,
}

/// Reads a part. An error holds the line within the part, counted from 1.
fn read_part(text: &[u8]) -> Result<Part, (usize, String)> {
    let mut out = Part::default();
    for (n, line) in text.split(|b| *b == b'\n').enumerate() {
        read_line(line, &mut out).map_err(|problem| (n + 1, problem))?;
    }
    Ok(out)
}

fn read_line(line: &[u8], out: &mut Part) -> Result<(), String> {
    let mut rest = words(line);
    let Some(keyword) = rest.next() else { return Ok(()) };
    let damaged = |what: &str| format!("`{}` is not {what}", beginning(line));
    let mesh = &mut out.mesh;
    match keyword {
        b"v" => {
            mesh.positions.push(vector(&mut rest).ok_or_else(|| damaged("a vertex `v x y z` with finite numbers"))?);
            if let Some(color) = vector(&mut rest) {
                // Vertices without a colour are white.
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
        b"f" => read_polygon(PolygonKind::Face, 3, rest, out).map_err(|what| damaged(&what))?,
        b"l" => read_polygon(PolygonKind::Line, 2, rest, out).map_err(|what| damaged(&what))?,
        b"p" => read_polygon(PolygonKind::Points, 1, rest, out).map_err(|what| damaged(&what))?,
        b"o" => mesh.mark(Mark::Object(text_after(line, keyword))),
        b"g" => mesh.mark(Mark::Group(text_after(line, keyword))),
        b"usemtl" => mesh.mark(Mark::Material(text_after(line, keyword))),
        b"s" => mesh.mark(Mark::Smoothing(text_after(line, keyword))),
        b"mtllib" => mesh.mark(Mark::Library(text_after(line, keyword))),
        _ => *out.skipped.entry(beginning(keyword)).or_default() += 1,
    }
    Ok(())
}

fn text_after(line: &[u8], keyword: &[u8]) -> String {
    String::from_utf8_lossy(&line.trim_ascii()[keyword.len()..]).trim().to_owned()
}

/// Reads a polygon of corners `v`, `v/uv`, `v//n` or `v/uv/n`. The error describes a correct line.
fn read_polygon<'a>(
    kind: PolygonKind,
    min: usize,
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
    if out.mesh.corners.len() - first < min {
        return Err(format!("a polygon of at least {min} corners"));
    }
    out.mesh.polygons.push(Polygon { end: index32(out.mesh.corners.len()), kind });
    Ok(())
}

/// Appends a part to the mesh.
fn append(mesh: &mut Mesh, part: Part, skipped: &mut BTreeMap<String, usize>) {
    let before = [mesh.positions.len(), mesh.uvs.len(), mesh.normals.len()];
    let Part { mesh: mut added, relative, skipped: added_skipped } = part;
    for (field, corner, i) in relative {
        let i = i64::try_from(before[field]).unwrap_or(i64::MAX) + i;
        let c = &mut added.corners[corner];
        // Out of range, but not the index that stands for a missing one.
        *[&mut c.vertex, &mut c.uv, &mut c.normal][field] = u32::try_from(i).unwrap_or(NONE - 1);
    }
    if !added.colors.is_empty() || !mesh.colors.is_empty() {
        mesh.colors.resize(before[0], [1.0; 4]);
        added.colors.resize(added.positions.len(), [1.0; 4]);
        mesh.colors.append(&mut added.colors);
    }
    let (corners, polygons) = (index32(mesh.corners.len()), index32(mesh.polygons.len()));
    mesh.positions.append(&mut added.positions);
    mesh.uvs.append(&mut added.uvs);
    mesh.normals.append(&mut added.normals);
    mesh.corners.append(&mut added.corners);
    mesh.polygons.extend(added.polygons.iter().map(|p| Polygon { end: p.end.saturating_add(corners), ..*p }));
    mesh.marks.extend(added.marks.into_iter().map(|(first, m)| (first.saturating_add(polygons), m)));
    for (what, n) in added_skipped {
        *skipped.entry(what).or_default() += n;
    }
}

fn check_indices(mesh: &Mesh, text: &[u8]) -> Result<(), MeshError> {
    let [vertices, uvs, normals] = [mesh.positions.len(), mesh.uvs.len(), mesh.normals.len()];
    let is_out_of_range = |c: &Corner| {
        let is_sound = |i: u32, n: usize| i == NONE || (i as usize) < n;
        (c.vertex as usize) >= vertices || !is_sound(c.uv, uvs) || !is_sound(c.normal, normals)
    };
    let Some(corner) = mesh.corners.par_iter().position_first(is_out_of_range) else { return Ok(()) };
    let polygon = mesh.polygons.partition_point(|p| p.end as usize <= corner);
    let counts = format!("{vertices} vertices, {uvs} texture coordinates and {normals} normals");
    let problem = format!("an index is out of range: there are {counts}");
    Err(match line_of(text, polygon) {
        Some(line) => MeshError::at_line(line, problem),
        None => MeshError::whole(problem),
    })
}

/// Returns the line of a polygon, counted from 1.
fn line_of(text: &[u8], polygon: usize) -> Option<usize> {
    let is_polygon = |line: &[u8]| matches!(words(line).next(), Some(b"f" | b"l" | b"p"));
    let mut lines = text.split(|b| *b == b'\n').enumerate().filter(|(_, line)| is_polygon(line));
    lines.nth(polygon).map(|(n, _)| n + 1)
}

/// Iterates over the words of a line, without its comment.
fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    let end = line.iter().position(|b| *b == b'#').unwrap_or(line.len());
    line[..end].split(u8::is_ascii_whitespace).filter(|w| !w.is_empty())
}

/// Reads a finite number that is not so large that its square overflows.
fn number(word: &[u8]) -> Option<f64> {
    let v: f64 = std::str::from_utf8(word).ok()?.parse().ok()?;
    (v.abs() < 1e100).then_some(v)
}

/// Reads a vector from the next three words.
fn vector<'a>(mut words: impl Iterator<Item = &'a [u8]>) -> Option<DVec3> {
    let mut next = || number(words.next()?);
    Some(DVec3::new(next()?, next()?, next()?))
}

/// Reads an index, which counts from 1, or from the end if negative.
fn index(word: &[u8]) -> Option<i64> {
    let digits = word.strip_prefix(b"-").unwrap_or(word);
    if digits.len() > 10 || !digits.iter().all(u8::is_ascii_digit) {
        return None;
    }
    std::str::from_utf8(word).ok()?.parse().ok().filter(|n| *n != 0)
}

/// Returns the beginning of a text, for messages.
fn beginning(text: &[u8]) -> String {
    const MAX_CHARS: usize = 40;
    String::from_utf8_lossy(text).trim().chars().take(MAX_CHARS).collect()
}

/// Lines in each of the parts in which text is written in parallel.
const LINES: usize = 1 << 14;
/// The number 2⁵³, up to which every integer is a floating-point number.
const MAX_EXACT: f64 = 9_007_199_254_740_992.0;

/// Writes a mesh; coordinates get `decimals` decimals.
#[must_use]
pub fn write(mesh: &Mesh, decimals: u8) -> Vec<u8> {
    let scale = 10f64.powi(i32::from(decimals));
    let mut out = b"# pathwarp: x right, y up, z towards the viewer\n".to_vec();
    let libraries = mesh.marks.iter().filter(|(_, m)| matches!(m, Mark::Library(_)));
    libraries.for_each(|(_, m)| push_mark(&mut out, m));
    push_lines(&mut out, mesh.positions.len(), |i, out| {
        out.push(b'v');
        push_numbers(out, &mesh.positions[i].to_array(), scale);
        if mesh.is_colored() {
            push_numbers(out, &mesh.colors[i][..3], COLOR_SCALE);
        }
    });
    push_lines(&mut out, mesh.uvs.len(), |i, out| {
        out.extend_from_slice(b"vt");
        let uv = &mesh.uvs[i];
        push_numbers(out, if uv[2] == 0.0 { &uv[..2] } else { uv }, SCALE);
    });
    push_lines(&mut out, mesh.normals.len(), |i, out| {
        out.extend_from_slice(b"vn");
        push_numbers(out, &mesh.normals[i].to_array(), SCALE);
    });
    let mut from = 0;
    for (first, m) in mesh.marks.iter().filter(|(_, m)| !matches!(m, Mark::Library(_))) {
        let first = (*first as usize).min(mesh.polygons.len());
        push_polygons(&mut out, mesh, from..first);
        from = first;
        push_mark(&mut out, m);
    }
    push_polygons(&mut out, mesh, from..mesh.polygons.len());
    out
}

/// Scale of colours, with eight decimals; texture coordinates and normals have nine, since single precision has seven significant digits.
const COLOR_SCALE: f64 = 1e8;
const SCALE: f64 = 1e9;

/// Appends `n` lines.
fn push_lines(out: &mut Vec<u8>, n: usize, line: impl Fn(usize, &mut Vec<u8>) + Sync) {
    let part = |k: usize| {
        let mut text = Vec::with_capacity(LINES * 40);
        for i in k * LINES..((k + 1) * LINES).min(n) {
            line(i, &mut text);
            text.push(b'\n');
        }
        text
    };
    let parts: Vec<Vec<u8>> = (0..n.div_ceil(LINES)).into_par_iter().map(part).collect();
    out.reserve(parts.iter().map(Vec::len).sum());
    parts.iter().for_each(|p| out.extend_from_slice(p));
}

fn push_polygons(out: &mut Vec<u8>, mesh: &Mesh, range: std::ops::Range<usize>) {
    push_lines(out, range.len(), |i, out| {
        let i = range.start + i;
        let start = if i == 0 { 0 } else { mesh.polygons[i - 1].end as usize };
        let polygon = mesh.polygons[i];
        out.push(match polygon.kind {
            PolygonKind::Face => b'f',
            PolygonKind::Line => b'l',
            PolygonKind::Points => b'p',
        });
        for c in &mesh.corners[start..polygon.end as usize] {
            push_corner(out, c);
        }
    });
}

fn push_corner(out: &mut Vec<u8>, c: &Corner) {
    out.push(b' ');
    push_whole(out, u64::from(c.vertex) + 1);
    if c.uv == NONE && c.normal == NONE {
        return;
    }
    out.push(b'/');
    if c.uv != NONE {
        push_whole(out, u64::from(c.uv) + 1);
    }
    if c.normal != NONE {
        out.push(b'/');
        push_whole(out, u64::from(c.normal) + 1);
    }
}

fn push_mark(out: &mut Vec<u8>, mark: &Mark) {
    let (keyword, text) = match mark {
        Mark::Object(t) => ("o", t),
        Mark::Group(t) => ("g", t),
        Mark::Material(t) => ("usemtl", t),
        Mark::Smoothing(t) => ("s", t),
        Mark::Library(t) => ("mtllib", t),
    };
    // A line break in a name would start another statement.
    let text: String = text.chars().map(|c| if c.is_control() { '_' } else { c }).collect();
    out.extend_from_slice(format!("{keyword} {text}").trim_end().as_bytes());
    out.push(b'\n');
}

/// Appends numbers, rounded to multiples of 1/`scale`.
fn push_numbers(out: &mut Vec<u8>, values: &[f64], scale: f64) {
    for v in values {
        out.push(b' ');
        let steps = (v * scale).round();
        if steps.abs() < MAX_EXACT {
            push_decimal(out, steps as i64, scale as u64);
        } else {
            out.extend_from_slice(ryu::Buffer::new().format(*v).as_bytes());
        }
    }
}

/// Appends `steps`/`scale` without trailing zeros; `scale` is a power of ten.
fn push_decimal(out: &mut Vec<u8>, steps: i64, scale: u64) {
    if steps < 0 {
        out.push(b'-');
    }
    let (integer, mut rest) = (steps.unsigned_abs() / scale, steps.unsigned_abs() % scale);
    push_whole(out, integer);
    if rest > 0 {
        out.push(b'.');
        let mut unit = scale / 10;
        while rest > 0 {
            out.push(b'0' + u8::try_from(rest / unit).unwrap_or(0));
            rest %= unit;
            unit /= 10;
        }
    }
}

/// Appends a whole number, without a formatter, since most of a file are indices.
fn push_whole(out: &mut Vec<u8>, mut v: u64) {
    let mut digits = [0u8; 20];
    let mut start = digits.len();
    loop {
        start -= 1;
        digits[start] = b'0' + u8::try_from(v % 10).unwrap_or(0);
        v /= 10;
        if v == 0 {
            break;
        }
    }
    out.extend_from_slice(&digits[start..]);
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# a comment\nmtllib paint.mtl\no box one\nv 0 0 0\nv 1 0 0\nv 1.5 1 -0.25\nv 0 1 1e-3\nvt 0 0.5\nvn 0 0 1\n\
                        g side left\nusemtl red\ns 1\nf 1/1/1 2/1/1 3/1/1 -1//-1\nl 1 2 \\\n 3\np 4\n";

    #[test]
    fn quads_names_materials_lines_and_relative_indices_survive() {
        let mesh = read(TEXT.as_bytes()).unwrap();
        let text = String::from_utf8(write(&mesh, 6)).unwrap();
        for line in [
            "mtllib paint.mtl",
            "o box one",
            "v 1.5 1 -0.25",
            "v 0 1 0.001",
            "vt 0 0.5",
            "vn 0 0 1",
            "g side left",
            "usemtl red",
            "s 1",
            "f 1/1/1 2/1/1 3/1/1 4//1",
            "l 1 2 3",
            "p 4",
        ] {
            assert!(text.lines().any(|l| l == line), "{line} not in\n{text}");
        }
        assert_eq!(read(text.as_bytes()).unwrap(), mesh);
        assert_eq!(mesh.name_of(0), "side left");
    }

    #[test]
    fn long_files_are_joined_in_order() {
        let mut text = String::from("o all\n");
        for i in 0..200_000 {
            text += &format!("v {i} {} 0.5\n", -i);
            if i >= 3 {
                text += "f -1 -2 -3\n";
            }
        }
        let mesh = read(text.as_bytes()).unwrap();
        assert_eq!((mesh.positions.len(), mesh.polygons.len()), (200_000, 199_997));
        let last = mesh.faces().last().unwrap();
        assert_eq!(last.iter().map(|c| c.vertex).collect::<Vec<_>>(), [199_999, 199_998, 199_997]);
        assert_eq!(read(&write(&mesh, 3)).unwrap(), mesh);
    }

    #[test]
    fn damage_is_named_with_its_line() {
        for (text, part) in [
            ("v 0 0\n", "line 1"),
            ("v 0 0 0\nv nan 0 0\n", "line 2"),
            ("v 0 0 0\n\nf 1 1 2\n", "line 3: an index is out of range"),
            ("v 0 0 0\nf 1 1 -2\n", "out of range"),
            ("v 0 0 0\nf 1 1\n", "at least 3"),
            ("v 0 0 0\nf 1 1 99999999999999\n", "line 2"),
            ("v 0 0 0\nf 1/x 1 1\n", "corners"),
            ("hello\n", "no vertices"),
            ("solid \0\0\0", "not text"),
        ] {
            let e = read(text.as_bytes()).unwrap_err().to_string();
            assert!(e.contains(part), "{text}: {e}");
        }
    }
}
