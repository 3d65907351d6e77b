//! Writes lattices as JSON, in the format that the module `file` describes, and has the limits that files and parameters share.

use crate::map::Lattice;

/// The highest degree of a lattice.
pub(in crate::deform) const MAX_DEGREE: usize = 10;
/// The largest number of Bézier pieces along an axis.
pub(in crate::deform) const MAX_CELLS: usize = 64;

/// Returns a lattice as JSON.
pub(super) fn write(lattice: &Lattice) -> String {
    let r = lattice.region();
    // Adding zero turns −0 into 0.
    let numbers = |v: &[f64]| format!("[{}]", v.iter().map(|v| format!("{}", v + 0.0)).collect::<Vec<_>>().join(", "));
    let row = |j: usize| {
        let points = (0..lattice.columns()).map(|i| {
            let (p, w) = (lattice.point(i, j), lattice.weight(i, j));
            if w == 1.0 { numbers(&[p.x, p.y]) } else { numbers(&[p.x, p.y, w]) }
        });
        format!("    [{}]", points.collect::<Vec<_>>().join(", "))
    };
    let [d, c] = [lattice.degree(), lattice.cells()];
    format!(
        "{{\n  \"degree\": {d:?},\n  \"cells\": {c:?},\n  \"region\": {},\n  \"points\": [\n{}\n  ]\n}}\n",
        numbers(&[r.x0, r.y0, r.width(), r.height()]),
        (0..lattice.rows()).map(row).collect::<Vec<_>>().join(",\n")
    )
}
