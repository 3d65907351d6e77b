//! Rational patches and NURBS surfaces as JSON, with trimming curves. `docs/solid.md` describes the format.

use super::surface::{self, Surface, TrimCurve};
use crate::mesh::MeshError;
use glam::DVec3;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    surfaces: Vec<Entry>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    #[serde(default, skip_serializing_if = "String::is_empty")]
    name: String,
    degree: [usize; 2],
    /// By default those of a Bézier patch over 0..1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    knots: Option<[Vec<f64>; 2]>,
    points: Vec<[f64; 3]>,
    /// By default 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    weights: Option<Vec<f64>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    trims: Vec<Vec<Curve>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Curve {
    degree: usize,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    knots: Option<Vec<f64>>,
    points: Vec<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    weights: Option<Vec<f64>>,
}

/// Reads surfaces.
///
/// # Errors
/// The text is damaged. The error says where in the text, or in which surface.
pub fn read(text: &[u8]) -> Result<Vec<Surface>, MeshError> {
    let file: File =
        serde_json::from_slice(text).map_err(|e| MeshError::whole(format!("is not a file of surfaces: {e}")))?;
    let mut out = Vec::with_capacity(file.surfaces.len());
    for (n, entry) in file.surfaces.into_iter().enumerate() {
        let ones = |given: Option<Vec<f64>>, n: usize| given.unwrap_or_else(|| vec![1.0; n]);
        // Degrees are checked below, but must not overflow here.
        let default = |d: usize| surface::single(d.min(usize::from(u8::MAX)), [0.0, 1.0]);
        let curve = |c: Curve| TrimCurve {
            degree: c.degree,
            knots: c.knots.unwrap_or_else(|| default(c.degree)),
            weights: ones(c.weights, c.points.len()),
            points: c.points,
        };
        let surface = Surface {
            name: entry.name,
            degree: entry.degree,
            knots: entry.knots.unwrap_or_else(|| entry.degree.map(default)),
            weights: ones(entry.weights, entry.points.len()),
            points: entry.points.into_iter().map(DVec3::from_array).collect(),
            trims: entry.trims.into_iter().map(|l| l.into_iter().map(curve).collect()).collect(),
        };
        if let Some(fault) = surface.fault() {
            return Err(MeshError::whole(format!("surface {} {fault}", n + 1)));
        }
        out.push(surface);
    }
    if out.is_empty() {
        return Err(MeshError::whole("holds no surfaces"));
    }
    Ok(out)
}

/// Writes surfaces. Every number is exact.
///
/// # Errors
/// A number cannot be written as JSON.
pub fn write(surfaces: &[Surface]) -> Result<String, String> {
    let weights = |w: &[f64]| w.iter().any(|w| *w != 1.0).then(|| w.to_vec());
    let curve = |c: &TrimCurve| Curve {
        degree: c.degree,
        knots: (c.knots != surface::single(c.degree, [0.0, 1.0])).then(|| c.knots.clone()),
        points: c.points.clone(),
        weights: weights(&c.weights),
    };
    let entry = |s: &Surface| Entry {
        name: s.name.clone(),
        degree: s.degree,
        knots: (s.knots != s.degree.map(|d| surface::single(d, [0.0, 1.0]))).then(|| s.knots.clone()),
        points: s.points.iter().map(DVec3::to_array).collect(),
        weights: weights(&s.weights),
        trims: s.trims.iter().map(|l| l.iter().map(curve).collect()).collect(),
    };
    let file = File { surfaces: surfaces.iter().map(entry).collect() };
    serde_json::to_string(&file).map(|t| t + "\n").map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_come_back_and_damage_is_named() {
        let text = r#"{"surfaces":[{"name":"a","degree":[1,1],"knots":[[0,0,1,2,2],[0,0,1,1]],"points":[[0,0,0],[1,0,0],[2,0,1],[0,1,0],
            [1,1,0],[2,1,1]],"weights":[1,2,1,1,0.5,1],"trims":[[{"degree":1,"points":[[0,0],[1,0.3]]}]]}]}"#;
        let surfaces = read(text.as_bytes()).unwrap();
        assert_eq!(read(write(&surfaces).unwrap().as_bytes()).unwrap(), surfaces);
        for (from, to, part) in [
            ("[1,1],", "[13,1],", "degree 13"),
            ("[1,1],", "[4000000000,1],", "degree 4000000000"),
            ("[1,2,1,1,", "[1,0,1,1,", "weight 2"),
            ("[1,2,1,1,", "[1,1,1,", "5 weights for 6"),
            ("[0,0,1,2,2]", "[0,0,2,2]", "6 control points; its degrees and knots take 2 × 2"),
            ("[1,0,0]", "[1,0,1e300]", "control point 2"),
            ("[1,0.3]", "[1,0.3],[2,2]", "trimming curve has 3"),
            ("\"name\"", "\"nome\"", "unknown field"),
        ] {
            let e = read(text.replacen(from, to, 1).as_bytes()).unwrap_err().to_string();
            assert!(e.contains(part), "{to}: {e}");
        }
    }
}
