//! Bézier patches as text (`.bpt`), the usual form of Newell's teapot: the number of patches, then for each patch its two degrees m and n
//! and its (m + 1)·(n + 1) control points `x y z`, one per line, the second index fastest.

use super::surface::{MAX_DEGREE, Surface};
use crate::mesh::MeshError;
use glam::DVec3;
use std::fmt::Write as _;

/// Reads patches. A `#` starts a comment.
///
/// # Errors
/// [`MeshFault::Text`](crate::mesh::MeshFault::Text) when a line is damaged, or there are fewer or more patches than announced.
pub fn read(text: &[u8]) -> Result<Vec<Surface>, MeshError> {
    let text = std::str::from_utf8(text).map_err(|_| MeshError::whole("is not a patch file: it is not text"))?;
    let lines = text.lines().enumerate().map(|(n, l)| (n + 1, l.split('#').next().unwrap_or("")));
    let mut lines = lines.filter(|(_, l)| !l.trim().is_empty());
    let (count, _) = whole_numbers::<1>(lines.next(), "the number of patches")?;
    let mut out = Vec::new();
    for number in 1..=count[0] {
        let (degree, line) =
            whole_numbers::<2>(lines.next(), &format!("the degrees of patch {number} of {}", count[0]))?;
        if degree.iter().any(|d| !(1..=MAX_DEGREE).contains(d)) {
            return Err(MeshError::at_line(line, format!("degrees are 1 to {MAX_DEGREE}")));
        }
        let [rows, columns] = degree.map(|d| d + 1);
        let mut points = Vec::with_capacity(rows * columns);
        for _ in 0..rows * columns {
            points.push(point(lines.next(), number)?);
        }
        // In [`Surface`], the first index runs fastest.
        let transposed = (0..points.len()).map(|k| points[(k % rows) * columns + (k / rows)]).collect();
        out.push(Surface::bezier("", degree, transposed));
    }
    if let Some((line, text)) = lines.next() {
        let problem = format!("`{}` follows the {} patches that the file announces", beginning(text), count[0]);
        return Err(MeshError::at_line(line, problem));
    }
    if out.is_empty() {
        return Err(MeshError::whole("holds no patches"));
    }
    Ok(out)
}

/// Returns the beginning of a line, for messages.
fn beginning(text: &str) -> String {
    text.trim().chars().take(40).collect()
}

fn whole_numbers<const N: usize>(line: Option<(usize, &str)>, what: &str) -> Result<([usize; N], usize), MeshError> {
    let (line, text) = line.ok_or_else(|| MeshError::whole(format!("ends before {what}")))?;
    let numbers: Option<Vec<usize>> = text.split_whitespace().map(|w| w.parse().ok()).collect();
    let numbers = numbers.and_then(|n| n.try_into().ok());
    numbers.map(|n| (n, line)).ok_or_else(|| MeshError::at_line(line, format!("`{}` is not {what}", beginning(text))))
}

fn point(line: Option<(usize, &str)>, patch: usize) -> Result<DVec3, MeshError> {
    let (line, text) = line.ok_or_else(|| MeshError::whole(format!("ends within patch {patch}")))?;
    let numbers: Option<Vec<f64>> = text.split_whitespace().map(|w| w.parse().ok()).collect();
    match numbers.as_deref() {
        Some([x, y, z]) if [x, y, z].iter().all(|v| v.abs() < 1e100) => Ok(DVec3::new(*x, *y, *z)),
        _ => {
            let problem = format!("`{}` is not a control point `x y z` with finite numbers", beginning(text));
            Err(MeshError::at_line(line, problem))
        }
    }
}

/// Writes surfaces, NURBS as their Bézier patches.
///
/// # Errors
/// A message when a surface has weights or trimming curves, which the format cannot express.
pub fn write(surfaces: &[Surface]) -> Result<String, String> {
    let mut patches = Vec::new();
    for s in surfaces {
        if let Some(extra) = s.is_rational().then_some("weights").or((!s.trims.is_empty()).then_some("trimming curves"))
        {
            let name = if s.name.is_empty() { String::new() } else { format!(" `{}`", s.name) };
            return Err(format!("surface{name} has {extra}, and .bpt files have no room for them; write .json"));
        }
        patches.extend(s.pieces().0);
    }
    let mut out = format!("{}\n", patches.len());
    for p in &patches {
        let [m, n] = p.degree;
        let _ = writeln!(out, "{m} {n}");
        for k in 0..p.points.len() {
            let q = p.points[(k % (n + 1)) * (m + 1) + (k / (n + 1))];
            let _ = writeln!(out, "{} {} {}", q.x / q.w, q.y / q.w, q.z / q.w);
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWO: &str = "2 # patches\n1 2\n0 0 0\n0 1 0\n0 2 0\n1 0 0\n1 1 5\n1 2 0\n\n1 1\n0 0 1\n0 1 1\n1 0 1\n1 1 1\n";

    #[test]
    fn patches_come_back() {
        let read_back = read(TWO.as_bytes()).unwrap();
        assert_eq!((read_back.len(), read_back[0].degree), (2, [1, 2]));
        // u goes from the first row of three to the second.
        assert_eq!(read_back[0].pieces().0[0].point(1.0, 0.5), DVec3::new(1.0, 1.0, 2.5));
        let text = write(&read_back).unwrap();
        assert_eq!(read(text.as_bytes()).unwrap(), read_back);
        let mut weighted = read_back;
        weighted[0].weights[1] = 2.0;
        assert!(write(&weighted).unwrap_err().contains("weights"));
    }

    #[test]
    fn damage_is_named_with_its_line() {
        for (text, part) in [
            ("", "ends before the number of patches"),
            ("x\n", "line 1"),
            ("1000000000\n1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n", "ends before the degrees of patch 2"),
            ("1\n99 1\n", "degrees are 1 to 12"),
            ("1\n1 1\n0 0 0\n0 nan 0\n", "line 4"),
            ("1\n1 1\n0 0 0\n0 1\n", "line 4"),
            ("1\n1 1\n0 0 0\n", "ends within patch 1"),
            ("0\n", "no patches"),
            ("1\n1 1\n0 0 1\n0 1 1\n1 0 1\n1 1 1\n7\n", "line 7"),
        ] {
            let e = read(text.as_bytes()).unwrap_err().to_string();
            assert!(e.contains(part), "{text}: {e}");
        }
    }
}
