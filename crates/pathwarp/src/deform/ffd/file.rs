//! Lattices as JSON.
//!
//! ```json
//! {
//!   "degree": [2, 1],
//!   "cells": [1, 1],
//!   "region": [20, 20, 200, 100],
//!   "points": [
//!     [[20, 20], [120, 45], [220, 20]],
//!     [[20, 120], [120, 95, 2], [220, 120]]
//!   ]
//! }
//! ```
//!
//! `points` has rows from the top, each from left to right. A point is x and y in user units, and the weight, which may be
//! negative, unless it is 1. A row has degree + cells points; `cells` above 1 mean uniform clamped B-splines, and may be omitted
//! otherwise. `region` is x, y, width and height of the box that the lattice deforms, by default the artwork's.

use super::save::{MAX_CELLS, MAX_DEGREE};
use crate::error::Error;
use crate::map::Lattice;
use kurbo::{Point, Rect};
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LatticeFile {
    degree: [usize; 2],
    #[serde(default = "one")]
    cells: [usize; 2],
    region: Option<[f64; 4]>,
    points: Vec<Vec<Vec<f64>>>,
}

fn one() -> [usize; 2] {
    [1, 1]
}

/// Returns the box that a file gives as x, y, width and height, or else `frame`.
pub(in crate::deform) fn region_in_file(name: &str, given: Option<[f64; 4]>, frame: Rect) -> Result<Rect, Error> {
    match given {
        None => Ok(frame),
        Some([x, y, w, h]) if w > 0.0 && h > 0.0 && [x, y, w, h].iter().all(|v| v.abs() < 1e100) => {
            Ok(Rect::new(x, y, x + w, y + h))
        }
        Some(r) => Err(Error::input(name, format!("its region {r:?} is not a box x, y, width, height"))),
    }
}

/// Reads a lattice. The flag is `true` if the file names its region; otherwise the region is `frame`.
pub(super) fn read(name: &str, text: &str, frame: Rect) -> Result<(Lattice, bool), Error> {
    let file: LatticeFile = serde_json::from_str(text)
        .map_err(|e| Error::input(format!("{name}:{}:{}", e.line(), e.column()), format!("is not a lattice: {e}")))?;
    let wrong = |what: String| Error::input(name, what);
    if file.degree.iter().any(|d| !(1..=MAX_DEGREE).contains(d)) {
        return Err(wrong(format!("its degrees are {:?}; each must be 1 to {MAX_DEGREE}", file.degree)));
    }
    if file.cells.iter().any(|c| !(1..=MAX_CELLS).contains(c)) {
        return Err(wrong(format!("its cells are {:?}; each number must be 1 to {MAX_CELLS}", file.cells)));
    }
    let region = region_in_file(name, file.region, frame)?;
    let mut lattice = Lattice::regular(region, file.degree, file.cells);
    let (found, needed) = (file.points.len(), lattice.rows());
    if found != needed {
        let ([_, degree], [_, cells]) = (file.degree, file.cells);
        let problem = format!("it has {found} rows of points; degree {degree} with {cells} cells down needs {needed}");
        return Err(wrong(problem));
    }
    for (j, row) in file.points.iter().enumerate() {
        if row.len() != lattice.columns() {
            return Err(wrong(format!("row {j} has {} points; {} are needed", row.len(), lattice.columns())));
        }
        for (i, p) in row.iter().enumerate() {
            let (x, y, w) = match p[..] {
                [x, y] => (x, y, 1.0),
                [x, y, w] => (x, y, w),
                _ => return Err(wrong(format!("point {i} of row {j} has {} numbers: x, y or x, y, weight", p.len()))),
            };
            if [x, y, w].iter().any(|v| v.abs() > 1e100) {
                return Err(wrong(format!("point {i} of row {j} has a number larger than 1e100")));
            }
            lattice.place(i, j, Point::new(x, y));
            lattice.set_weight(i, j, w);
        }
    }
    Ok((lattice, file.region.is_some()))
}

#[cfg(test)]
mod tests {
    use super::super::save::write;
    use super::*;
    use kurbo::Vec2;

    #[test]
    fn a_written_lattice_is_read_back() {
        let mut l = Lattice::regular(Rect::new(-5.5, 2.0, 30.0, 40.0), [3, 2], [2, 1]);
        l.shift(1, 1, Vec2::new(0.1, -7.0));
        l.set_weight(2, 0, 1.5);
        let (back, named) = read("l.json", &write(&l), Rect::ZERO).unwrap();
        assert!(named && write(&back) == write(&l));
        assert_eq!(back.weight(2, 0), 1.5);
    }

    #[test]
    fn faults_are_named() {
        let fault = |text: &str| read("l.json", text, Rect::new(0.0, 0.0, 1.0, 1.0)).unwrap_err().to_string();
        assert!(fault("{\"degree\": [1,1],\n\"points\": 5}").contains("l.json:2:"));
        assert!(fault("{\"degree\": [1,11], \"points\": []}").contains("1 to 10"));
        assert!(fault("{\"degree\": [1,1], \"points\": [[[0,0],[1,0]]]}").contains("1 rows of points"));
        assert!(fault("{\"degree\": [1,1], \"points\": [[[0,0],[1,0]],[[0,1]]]}").contains("row 1 has 1 points"));
        assert!(fault("{\"degree\": [1,1], \"points\": [[[0,0],[1,0]],[[0,1],[1]]]}").contains("point 1 of row 1"));
        assert!(fault("{\"degree\": [1,1], \"region\": [0,0,0,1], \"points\": []}").contains("not a box"));
        let ok = read(
            "l.json",
            "{\"degree\":[1,1],\"points\":[[[0,0],[1,0]],[[0,1],[1,1]]]}",
            Rect::new(0.0, 0.0, 1.0, 1.0),
        );
        assert!(!ok.unwrap().1);
    }
}
