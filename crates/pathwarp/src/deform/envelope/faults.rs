//! What is wrong with an envelope: sides that cross, and where the map folds over.

use crate::error::show;
use crate::map::{Coons, Map, Side};
use kurbo::{Affine, Line, Point};

/// Chords of a side.
const CHORDS: u32 = 400;
/// How far outside a chord, in its lengths, still counts as its end.
const ROUNDING: f64 = 1e-9;
/// Places along an axis at which the map's determinant is looked at.
const GRID: u32 = 64;

const NAMES: [&str; 4] = ["bottom", "right", "top", "left"];

/// Warnings for people. `inverse` takes the unit square to the source.
pub(super) fn warnings(map: &Coons, inverse: Affine) -> Vec<String> {
    let s = map.sides();
    let sides = [&s.bottom, &s.right, &s.top, &s.left];
    let mut out = crossings(sides);
    out.extend(fold(map, inverse));
    out
}

fn crossings(sides: [&Side; 4]) -> Vec<String> {
    let chords = sides.map(|s| {
        let at = |i: u32| s.at(f64::from(i) / f64::from(CHORDS)).0;
        (0..CHORDS).map(|i| Line::new(at(i), at(i + 1))).collect::<Vec<_>>()
    });
    let size = sides[0].length() + sides[2].length();
    let mut out = Vec::new();
    for i in 0..4 {
        for j in i..4 {
            let meets = |p: Point| sides[i].ends().iter().chain(&sides[j].ends()).any(|e| e.distance(p) <= 1e-6 * size);
            let pairs = chords[i].iter().enumerate().flat_map(|(k, a)| {
                // A side against itself: each pair once, neighbours never.
                let from = if i == j { k + 2 } else { 0 };
                chords[j].iter().skip(from).map(move |b| (a, b))
            });
            let found = pairs.filter_map(|(a, b)| crossing(a, b)).find(|p| !meets(*p));
            if let Some(at) = found {
                let what = if i == j {
                    format!("the {} side crosses itself", NAMES[i])
                } else {
                    format!("the {} and the {} side cross", NAMES[i], NAMES[j])
                };
                out.push(format!(
                    "envelope: {what} near {}: the artwork folds over there; move the curves apart",
                    show(at)
                ));
            }
        }
    }
    out
}

/// Where two chords cross or touch, their ends included: sides may well cross in the joint of two chords.
fn crossing(a: &Line, b: &Line) -> Option<Point> {
    let (v, w, d) = (a.p1 - a.p0, b.p1 - b.p0, b.p0 - a.p0);
    let det = v.cross(w);
    // Parallel chords, those of a straight stretch, meet nowhere or everywhere.
    if det.abs() <= 1e-9 * v.hypot() * w.hypot() {
        return None;
    }
    let (t, u) = (d.cross(w) / det, d.cross(v) / det);
    let inside = |t: f64| (-ROUNDING..=1.0 + ROUNDING).contains(&t);
    (inside(t) && inside(u)).then(|| a.p0 + v * t)
}

fn fold(map: &Coons, inverse: Affine) -> Option<String> {
    /// Below this share of the mean a determinant is nothing rather than negative: at smooth corners it vanishes.
    const NOTHING: f64 = 1e-6;
    let at = |i: u32| (f64::from(i) + 0.5) / f64::from(GRID);
    let places = (0..GRID * GRID).map(|k| Point::new(at(k % GRID), at(k / GRID)));
    let dets: Vec<(Point, f64)> = places.map(|q| (q, map.jet(inverse * q).det())).collect();
    let sum: f64 = dets.iter().map(|d| d.1).sum();
    let mean = dets.iter().map(|d| d.1.abs()).sum::<f64>() / dets.len() as f64;
    let up = sum.signum();
    let folded: Vec<_> = dets.iter().filter(|d| d.1 * up < -NOTHING * mean).collect();
    let worst = folded.iter().min_by(|a, b| (a.1 * up).total_cmp(&(b.1 * up)))?;
    let q = worst.0;
    let distances = [q.y, 1.0 - q.x, 1.0 - q.y, q.x];
    let side = (0..4).fold(0, |best, i| if distances[i] < distances[best] { i } else { best });
    let along = 100.0 * if side % 2 == 0 { q.x } else { q.y };
    Some(format!(
        "envelope: the map folds over near {} (nearest to the {} side, {along:.0} % along it; {:.1} % of the box): a side there \
bends too sharply for its neighbours; straighten it, or put the corners elsewhere",
        show(map.point(inverse * q)),
        NAMES[side],
        100.0 * folded.len() as f64 / dets.len() as f64
    ))
}
