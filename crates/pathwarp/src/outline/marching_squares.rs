//! Marching squares: the outline of a set of points on a grid, as the edges of the grid that it crosses.

use std::collections::HashMap;

/// An edge of a grid between neighbouring points: its left or upper end, and `true` if it runs down instead of to the right.
pub type GridEdge = (usize, usize, bool);

/// Returns the closed outlines of the points (x, y) for which `is_inside` holds, on a grid of so many cells across and down, as the edges
/// that they cross one after the other. No point on the grid's border may be inside. The set lies to the right of its outlines, which
/// separate two points of it that are diagonally opposite in a cell.
pub fn marching_squares([columns, rows]: [usize; 2], is_inside: impl Fn(usize, usize) -> bool) -> Vec<Vec<GridEdge>> {
    // The edge that follows another one along an outline.
    let mut next = HashMap::new();
    for (x, y) in (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))) {
        let corners = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)].map(|(x, y)| is_inside(x, y));
        let edges = [(x, y, false), (x + 1, y, true), (x, y + 1, false), (x, y, true)];
        for i in (0..4).filter(|i| corners[*i] && !corners[(i + 3) % 4]) {
            // Number of corners inside in a row from corner i, around the cell.
            let run = (1..4).find(|k| !corners[(i + k) % 4]).unwrap_or(1);
            next.insert(edges[(i + run + 3) % 4], edges[(i + 3) % 4]);
        }
    }
    let mut starts: Vec<GridEdge> = next.keys().copied().collect();
    starts.sort_unstable();
    let mut out = Vec::new();
    for start in starts {
        let (mut ring, mut edge) = (Vec::new(), start);
        while let Some(to) = next.remove(&edge) {
            ring.push(edge);
            edge = to;
        }
        if !ring.is_empty() {
            out.push(ring);
        }
    }
    out
}
