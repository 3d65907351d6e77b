//! Rational patches and NURBS surfaces as JSON, with trimming curves, and NURBS curves in space. `docs/solid.md` describes the format.
//!
//! In memory, a curve is a surface of degree p × 1 with two equal rows of control points, one of which is written. Maps keep them equal.

use super::surface::{self, Surface, TrimCurve};
use crate::mesh::MeshError;
use glam::DVec3;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    surfaces: Vec<Entry>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    curves: Vec<SpaceCurve>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SpaceCurve {
    #[serde(default, skip_serializing_if = "String::is_empty")]
    name: String,
    degree: usize,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    knots: Option<Vec<f64>>,
    points: Vec<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    weights: Option<Vec<f64>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    #[serde(default, skip_serializing_if = "String::is_empty")]
    name: String,
    degree: [usize; 2],
    /// By default the knots of a Bézier patch over 0..1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    knots: Option<[Vec<f64>; 2]>,
    points: Vec<[f64; 3]>,
    /// By default all weights are 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    weights: Option<Vec<f64>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    trims: Vec<Vec<Trim>>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Trim {
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
/// [`MeshFault::Text`](crate::mesh::MeshFault::Text), with the position in the text or the surface, when the text is damaged.
pub fn read(text: &[u8]) -> Result<Vec<Surface>, MeshError> {
    let file: Document =
        serde_json::from_slice(text).map_err(|e| MeshError::whole(format!("is not a file of surfaces: {e}")))?;
    let ones = |given: Option<Vec<f64>>, n: usize| given.unwrap_or_else(|| vec![1.0; n]);
    // Degrees are checked below, but must not overflow here.
    let default_knots = |degree: usize| surface::single_span_knots(degree.min(usize::from(u8::MAX)));
    let mut out = Vec::with_capacity(file.surfaces.len());
    for (n, entry) in file.surfaces.into_iter().enumerate() {
        let curve = |c: Trim| TrimCurve {
            degree: c.degree,
            knots: c.knots.unwrap_or_else(|| default_knots(c.degree)),
            weights: ones(c.weights, c.points.len()),
            points: c.points,
        };
        let surface = Surface {
            name: entry.name,
            degree: entry.degree,
            knots: entry.knots.unwrap_or_else(|| entry.degree.map(default_knots)),
            weights: ones(entry.weights, entry.points.len()),
            points: entry.points.into_iter().map(DVec3::from_array).collect(),
            trims: entry.trims.into_iter().map(|l| l.into_iter().map(curve).collect()).collect(),
        };
        if let Some(fault) = surface.fault() {
            return Err(MeshError::whole(format!("surface {} {fault}", n + 1)));
        }
        out.push(surface);
    }
    for (n, c) in file.curves.into_iter().enumerate() {
        let surface = Surface {
            name: c.name,
            degree: [c.degree, 1],
            knots: [c.knots.unwrap_or_else(|| default_knots(c.degree)), surface::single_span_knots(1)],
            weights: ones(c.weights, c.points.len()).repeat(2),
            points: c.points.repeat(2).into_iter().map(DVec3::from_array).collect(),
            trims: Vec::new(),
        };
        if let Some(fault) = surface.fault() {
            return Err(MeshError::whole(format!("curve {}, as a surface of two equal rows, {fault}", n + 1)));
        }
        out.push(surface);
    }
    if out.is_empty() {
        return Err(MeshError::whole("holds no surfaces and no curves"));
    }
    Ok(out)
}

/// Writes surfaces. Every number is exact.
///
/// # Errors
/// A message when a number cannot be written as JSON.
pub fn write(surfaces: &[Surface]) -> Result<String, String> {
    let weights = |w: &[f64]| w.iter().any(|w| *w != 1.0).then(|| w.to_vec());
    let knots = |degree: usize, k: &Vec<f64>| (*k != surface::single_span_knots(degree)).then(|| k.clone());
    let curve = |c: &TrimCurve| Trim {
        degree: c.degree,
        knots: knots(c.degree, &c.knots),
        points: c.points.clone(),
        weights: weights(&c.weights),
    };
    let entry = |s: &Surface| Entry {
        name: s.name.clone(),
        degree: s.degree,
        knots: (s.knots != s.degree.map(surface::single_span_knots)).then(|| s.knots.clone()),
        points: s.points.iter().map(DVec3::to_array).collect(),
        weights: weights(&s.weights),
        trims: s.trims.iter().map(|l| l.iter().map(curve).collect()).collect(),
    };
    let space_curve = |s: &Surface| {
        let n = s.size()[0];
        SpaceCurve {
            name: s.name.clone(),
            degree: s.degree[0],
            knots: knots(s.degree[0], &s.knots[0]),
            points: s.points[..n].iter().map(DVec3::to_array).collect(),
            weights: weights(&s.weights[..n]),
        }
    };
    let (curves, surfaces): (Vec<&Surface>, Vec<&Surface>) = surfaces.iter().partition(|s| s.is_curve());
    let file = Document {
        surfaces: surfaces.into_iter().map(entry).collect(),
        curves: curves.into_iter().map(space_curve).collect(),
    };
    serde_json::to_string(&file).map(|t| t + "\n").map_err(|e| e.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_come_back() {
        let text = r#"{"curves":[{"name":"arc","degree":2,"points":[[1,0,0],[1,1,0],[0,1,0]],"weights":[1,0.5,1]}]}"#;
        let curves = read(text.as_bytes()).unwrap();
        assert_eq!(
            write(&curves).unwrap().trim(),
            text.replace("1,0,0", "1.0,0.0,0.0")
                .replace("1,1,0", "1.0,1.0,0.0")
                .replace("0,1,0]", "0.0,1.0,0.0]")
                .replace("[1,0.5,1]", "[1.0,0.5,1.0]")
        );
        let e = read(text.replace("0.5", "-0.5").as_bytes()).unwrap_err().to_string();
        assert!(e.contains("curve 1") && e.contains("weight 2"), "{e}");
    }

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
