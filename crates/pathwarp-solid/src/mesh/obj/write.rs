//! Writes OBJ: parts of the text by all threads, joined in order.

use crate::mesh::model::{Corner, Mark, Mesh, NONE, PolygonKind};
use rayon::prelude::*;

/// Lines of a part.
const PART: usize = 1 << 14;
/// The largest whole number up to which every one is a floating-point number.
const EXACT: f64 = 9_007_199_254_740_992.0;

/// Writes a mesh with this many decimals.
#[must_use]
pub fn write(mesh: &Mesh, decimals: u8) -> Vec<u8> {
    let scale = 10f64.powi(i32::from(decimals));
    let mut out = b"# pathwarp: x right, y up, z towards the viewer\n".to_vec();
    let libraries = mesh.marks.iter().filter(|(_, m)| matches!(m, Mark::Library(_)));
    libraries.for_each(|(_, m)| mark(&mut out, m));
    let colored = mesh.colors.len() == mesh.positions.len();
    lines(&mut out, mesh.positions.len(), |i, out| {
        out.push(b'v');
        numbers(out, &mesh.positions[i].to_array(), scale);
        if colored {
            numbers(out, &mesh.colors[i][..3], COLORS);
        }
    });
    lines(&mut out, mesh.uvs.len(), |i, out| {
        out.extend_from_slice(b"vt");
        let uv = &mesh.uvs[i];
        numbers(out, if uv[2] == 0.0 { &uv[..2] } else { uv }, DIRECTIONS);
    });
    lines(&mut out, mesh.normals.len(), |i, out| {
        out.extend_from_slice(b"vn");
        numbers(out, &mesh.normals[i].to_array(), DIRECTIONS);
    });
    let mut from = 0;
    for (first, m) in mesh.marks.iter().filter(|(_, m)| !matches!(m, Mark::Library(_))) {
        let first = (*first as usize).min(mesh.polygons.len());
        polygons(&mut out, mesh, from..first);
        from = first;
        mark(&mut out, m);
    }
    polygons(&mut out, mesh, from..mesh.polygons.len());
    out
}

/// Colours to eight decimals, and texture coordinates and normals to nine: files in single precision hold seven figures.
const COLORS: f64 = 1e8;
const DIRECTIONS: f64 = 1e9;

/// Appends `n` lines.
fn lines(out: &mut Vec<u8>, n: usize, line: impl Fn(usize, &mut Vec<u8>) + Sync) {
    let part = |k: usize| {
        let mut text = Vec::with_capacity(PART * 40);
        for i in k * PART..((k + 1) * PART).min(n) {
            line(i, &mut text);
            text.push(b'\n');
        }
        text
    };
    let parts: Vec<Vec<u8>> = (0..n.div_ceil(PART)).into_par_iter().map(part).collect();
    out.reserve(parts.iter().map(Vec::len).sum());
    parts.iter().for_each(|p| out.extend_from_slice(p));
}

fn polygons(out: &mut Vec<u8>, mesh: &Mesh, range: std::ops::Range<usize>) {
    lines(out, range.len(), |i, out| {
        let i = range.start + i;
        let start = if i == 0 { 0 } else { mesh.polygons[i - 1].end as usize };
        let polygon = mesh.polygons[i];
        out.push(match polygon.kind {
            PolygonKind::Face => b'f',
            PolygonKind::Line => b'l',
            PolygonKind::Points => b'p',
        });
        for c in &mesh.corners[start..polygon.end as usize] {
            corner(out, c);
        }
    });
}

fn corner(out: &mut Vec<u8>, c: &Corner) {
    out.push(b' ');
    whole(out, u64::from(c.vertex) + 1);
    if c.uv == NONE && c.normal == NONE {
        return;
    }
    out.push(b'/');
    if c.uv != NONE {
        whole(out, u64::from(c.uv) + 1);
    }
    if c.normal != NONE {
        out.push(b'/');
        whole(out, u64::from(c.normal) + 1);
    }
}

fn mark(out: &mut Vec<u8>, mark: &Mark) {
    let (keyword, text) = match mark {
        Mark::Object(t) => ("o", t),
        Mark::Group(t) => ("g", t),
        Mark::Material(t) => ("usemtl", t),
        Mark::Smoothing(t) => ("s", t),
        Mark::Library(t) => ("mtllib", t),
    };
    // A line break within a name would begin another statement.
    let text: String = text.chars().map(|c| if c.is_control() { '_' } else { c }).collect();
    out.extend_from_slice(format!("{keyword} {text}").trim_end().as_bytes());
    out.push(b'\n');
}

/// Appends numbers in steps of 1/`scale`.
fn numbers(out: &mut Vec<u8>, values: &[f64], scale: f64) {
    for v in values {
        out.push(b' ');
        let steps = (v * scale).round();
        if steps.abs() < EXACT {
            decimal(out, steps as i64, scale as u64);
        } else {
            out.extend_from_slice(ryu::Buffer::new().format(*v).as_bytes());
        }
    }
}

/// Appends `steps`/`scale` without trailing zeros; `scale` is a power of ten.
fn decimal(out: &mut Vec<u8>, steps: i64, scale: u64) {
    if steps < 0 {
        out.push(b'-');
    }
    let (integer, mut rest) = (steps.unsigned_abs() / scale, steps.unsigned_abs() % scale);
    whole(out, integer);
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

fn whole(out: &mut Vec<u8>, mut v: u64) {
    let mut digits = [0u8; 20];
    let mut at = digits.len();
    loop {
        at -= 1;
        digits[at] = b'0' + u8::try_from(v % 10).unwrap_or(0);
        v /= 10;
        if v == 0 {
            break;
        }
    }
    out.extend_from_slice(&digits[at..]);
}

#[cfg(test)]
mod tests {
    use super::super::read;
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
