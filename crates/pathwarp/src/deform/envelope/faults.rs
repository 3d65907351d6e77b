//! Warnings about an envelope: sides that cross, and folds of the map.

use super::ring::SIDES;
use crate::error::show;
use crate::map::{Coons, Map, Side};
use kurbo::{Affine, Line, Point, Rect};

/// Chords of a side.
const CHORDS: u32 = 400;
/// Chords that are looked at only if their common box is met.
const BLOCK: usize = 20;
/// Overshoot, in lengths of a chord, that still counts as its end.
const ROUNDING: f64 = 1e-9;
/// Samples of the map's determinant along an axis.
const GRID: u32 = 64;

/// Returns the warnings. `inverse` takes the unit square to the source.
pub(super) fn warnings(map: &Coons, inverse: Affine) -> Vec<String> {
    let s = map.sides();
    let sides = [&s.bottom, &s.right, &s.top, &s.left];
    let mut out = crossings(sides);
    out.extend(fold(map, inverse));
    out
}

fn crossings(sides: [&Side; 4]) -> Vec<String> {
    let size = sides[0].length() + sides[2].length();
    let chords = sides.map(|s| Chords::new(s, ROUNDING * size));
    let mut out = Vec::new();
    for i in 0..4 {
        for j in i..4 {
            let meets = |p: Point| sides[i].ends().iter().chain(&sides[j].ends()).any(|e| e.distance(p) <= 1e-6 * size);
            let pairs = chords[i].all.iter().enumerate().flat_map(|(k, a)| {
                // A side against itself: each pair once, without neighbours.
                let from = if i == j { k + 2 } else { 0 };
                chords[j].near(a, from).map(move |b| (a, b))
            });
            let found = pairs.filter_map(|(a, b)| crossing(a, b)).find(|p| !meets(*p));
            if let Some(at) = found {
                let what = if i == j {
                    format!("the {} side crosses itself", SIDES[i])
                } else {
                    format!("the {} and the {} side cross", SIDES[i], SIDES[j])
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

/// The chords of a side.
struct Chords {
    all: Vec<Line>,
    /// The box of every [`BLOCK`] of them.
    boxes: Vec<Rect>,
}

impl Chords {
    /// Cuts a side into chords. Their boxes are wider by `room`.
    fn new(side: &Side, room: f64) -> Self {
        let points: Vec<Point> = (0..=CHORDS).map(|i| side.at(f64::from(i) / f64::from(CHORDS)).0).collect();
        let all: Vec<Line> = points.windows(2).map(|p| Line::new(p[0], p[1])).collect();
        let of = |lines: &[Line]| {
            let start = Rect::from_points(lines[0].p0, lines[0].p1);
            lines.iter().fold(start, |b, l| b.union_pt(l.p1)).inflate(room, room)
        };
        let boxes = all.chunks(BLOCK).map(of).collect();
        Self { all, boxes }
    }

    /// Returns the chords, from a number on, in the blocks whose box meets that of `line`.
    fn near(&self, line: &Line, from: usize) -> impl Iterator<Item = &Line> {
        let here = Rect::from_points(line.p0, line.p1);
        let first = from / BLOCK;
        let blocks = self.boxes.iter().enumerate().skip(first).filter(move |(_, b)| b.overlaps(here));
        blocks.flat_map(move |(k, _)| {
            let (start, end) = ((k * BLOCK).max(from), self.all.len().min((k + 1) * BLOCK));
            &self.all[start.min(end)..end]
        })
    }
}

/// Returns the point where two chords cross or touch, ends included: sides may cross in the joint of two chords.
fn crossing(a: &Line, b: &Line) -> Option<Point> {
    let (v, w, d) = (a.p1 - a.p0, b.p1 - b.p0, b.p0 - a.p0);
    let det = v.cross(w);
    // Parallel chords, as of a straight stretch, meet nowhere or everywhere.
    if det.abs() <= 1e-9 * v.hypot() * w.hypot() {
        return None;
    }
    let (t, u) = (d.cross(w) / det, d.cross(v) / det);
    let inside = |t: f64| (-ROUNDING..=1.0 + ROUNDING).contains(&t);
    (inside(t) && inside(u)).then(|| a.p0 + v * t)
}

fn fold(map: &Coons, inverse: Affine) -> Option<String> {
    /// Below this share of the mean a negative determinant counts as zero: it vanishes at smooth corners.
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
bends too sharply for its neighbours; straighten it, or move the corners",
        show(map.point(inverse * q)),
        SIDES[side],
        100.0 * folded.len() as f64 / dets.len() as f64
    ))
}
