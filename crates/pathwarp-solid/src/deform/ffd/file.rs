//! Lattices in space as JSON.
//!
//! ```json
//! {
//!   "degree": [1, 1, 1],
//!   "cells": [1, 1, 1],
//!   "region": [0, 0, 0, 10, 10, 10],
//!   "points": [
//!     [[[0, 0, 0], [10, 0, 0]], [[0, 10, 0], [10, 10, 0]]],
//!     [[[0, 0, 10], [10, 0, 10]], [[0, 10, 10], [12, 10, 10, 2]]]
//!   ]
//! }
//! ```
//!
//! `points` are layers from the back, each of rows from the bottom, each from left to right: x, y, z and, unless it is 1, the
//! weight. A row has degree + cells points. `region` is x, y, z, width, height and depth of the box; without it the box is the
//! model's.

use super::{MAX_CELLS, MAX_DEGREE};
use crate::box3::Box3;
use crate::lattice::Lattice3;
use glam::DVec3;
use pathwarp::Error;
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LatticeFile {
    degree: [usize; 3],
    #[serde(default = "one")]
    cells: [usize; 3],
    region: Option<[f64; 6]>,
    points: Vec<Vec<Vec<Vec<f64>>>>,
}

fn one() -> [usize; 3] {
    [1; 3]
}

/// Reads a lattice. The flag is `true` if the file names its region; otherwise the region is `frame`.
pub(super) fn read(name: &str, text: &str, frame: Box3) -> Result<(Lattice3, bool), Error> {
    let file: LatticeFile = serde_json::from_str(text).map_err(|e| {
        Error::input(format!("{name}:{}:{}", e.line(), e.column()), format!("is not a lattice in space: {e}"))
    })?;
    let wrong = |what: String| Error::input(name, what);
    for (what, numbers, most) in [("degrees", file.degree, MAX_DEGREE), ("cells", file.cells, MAX_CELLS)] {
        if numbers.iter().any(|n| !(1..=most).contains(n)) {
            return Err(wrong(format!("its {what} are {numbers:?}; each must be 1 to {most}")));
        }
    }
    let region = match file.region {
        None => frame,
        Some(r @ [x, y, z, w, h, d]) if r.iter().all(|v| v.abs() < 1e100) && w > 0.0 && h > 0.0 && d > 0.0 => {
            let min = DVec3::new(x, y, z);
            Box3 { min, max: min + DVec3::new(w, h, d) }
        }
        Some(r) => return Err(wrong(format!("its region {r:?} is not a box x, y, z, width, height, depth"))),
    };
    let mut lattice = Lattice3::regular(region, file.degree, file.cells);
    let [nx, ny, nz] = lattice.size();
    let fits = file.points.len() == nz && file.points.iter().all(|l| l.len() == ny && l.iter().all(|r| r.len() == nx));
    if !fits {
        return Err(wrong(format!(
            "its points are not {nz} layers of {ny} rows of {nx}, as its degree and cells ask for"
        )));
    }
    for node in lattice.nodes() {
        let [i, j, k] = node;
        let (p, w) = match file.points[k][j][i][..] {
            [x, y, z] => (DVec3::new(x, y, z), 1.0),
            [x, y, z, w] => (DVec3::new(x, y, z), w),
            _ => return Err(wrong(format!("point {i},{j},{k} is neither x, y, z nor x, y, z, weight"))),
        };
        if !(p.abs().max_element() < 1e100 && w.abs() < 1e100) {
            return Err(wrong(format!("point {i},{j},{k} is larger than 1e100")));
        }
        lattice.place(node, p);
        lattice.set_weight(node, w);
    }
    Ok((lattice, file.region.is_some()))
}

/// Writes a lattice.
pub(super) fn write(lattice: &Lattice3) -> String {
    let numbers = |v: &[f64]| format!("[{}]", v.iter().map(|v| format!("{}", v + 0.0)).collect::<Vec<_>>().join(", "));
    let [nx, ny, nz] = lattice.size();
    let point = |i: usize, j: usize, k: usize| {
        let (p, w) = (lattice.point([i, j, k]), lattice.weight([i, j, k]));
        if w == 1.0 { numbers(&p.to_array()) } else { numbers(&p.extend(w).to_array()) }
    };
    let row = |j: usize, k: usize| format!("[{}]", (0..nx).map(|i| point(i, j, k)).collect::<Vec<_>>().join(", "));
    let layer = |k: usize| format!("    [{}]", (0..ny).map(|j| row(j, k)).collect::<Vec<_>>().join(",\n     "));
    let (r, layers) = (lattice.region(), (0..nz).map(layer).collect::<Vec<_>>().join(",\n"));
    let region: Vec<f64> = r.min.to_array().into_iter().chain(r.size().to_array()).collect();
    let [d, c] = [lattice.degree(), lattice.cells()];
    format!(
        "{{\n  \"degree\": {d:?},\n  \"cells\": {c:?},\n  \"region\": {},\n  \"points\": [\n{layers}\n  ]\n}}\n",
        numbers(&region)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        let frame = Box3::new(DVec3::ZERO, DVec3::ONE);
        let mut lattice =
            Lattice3::regular(Box3::new(DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 6.0, 8.0)), [2, 1, 3], [2, 1, 1]);
        lattice.shift([1, 0, 2], DVec3::new(0.125, -0.5, 3.0));
        lattice.set_weight([3, 1, 0], 2.5);
        let (back, named) = read("a.json", &write(&lattice), frame).unwrap();
        assert!(named && back.nodes().all(|n| (back.point(n) - lattice.point(n)).length() < 1e-14 && back.weight(n) == lattice.weight(n)));
        assert_eq!((back.region(), back.degree(), back.cells()), (lattice.region(), lattice.degree(), lattice.cells()));
    }

    #[test]
    fn faults_are_named() {
        let frame = Box3::new(DVec3::ZERO, DVec3::ONE);
        for (text, part) in [
            ("{", "a.json:1:1"),
            (r#"{"degree":[0,1,1],"points":[]}"#, "degrees"),
            (r#"{"degree":[1,1,1],"points":[]}"#, "2 layers of 2 rows of 2"),
            (r#"{"degree":[1,1,1],"region":[0,0,0,1,0,1],"points":[]}"#, "not a box"),
        ] {
            let e = read("a.json", text, frame).unwrap_err().to_string();
            assert!(e.contains(part), "{text}: {e}");
        }
    }
}
