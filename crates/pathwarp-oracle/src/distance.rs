//! The distance between two curves, in both directions.
//!
//! Both are sampled until no chord is farther from its arc than a tenth of a height, estimated from the turns of the chords. Every sample
//! of one is then compared with the other: first with its chords, and, farthest samples first, with the curve over every chord near which
//! the nearest point may lie. So cusps, hairpins and crossings need no good start. The distance of a sample is exact, and the largest
//! one falls short of the distance of the curves by at most its growth between two samples.

use crate::curves::{Curve, Curved};
use crate::polygon::{Polygon, to_edge};
use kurbo::{Point, Vec2};
use std::slice::from_ref;

/// A piece of a curve, and a parameter from 0 to 1 on it.
pub type Position = (usize, f64);

/// Maps points, many at a time.
pub type Image<'a> = &'a (dyn Fn(&[Point], &mut [Point]) + 'a);

/// A function that gives the points at many positions.
type At<'a> = Box<dyn Fn(&[Position], &mut [Point]) + 'a>;

/// A curve in pieces.
pub struct Run<'a> {
    pieces: usize,
    at: At<'a>,
}

impl<'a> Run<'a> {
    /// A curve of `pieces` pieces that a function describes.
    pub fn new(pieces: usize, at: impl Fn(Position) -> Point + 'a) -> Self {
        Self { pieces, at: Box::new(move |all, out| all.iter().zip(out).for_each(|(p, out)| *out = at(*p))) }
    }

    /// The curves themselves.
    pub fn of(curves: &'a [Curve]) -> Self {
        Self::image(curves, &|points, out| out.copy_from_slice(points))
    }

    /// The image of curves under a map.
    pub fn image(curves: &'a [Curve], image: Image<'a>) -> Self {
        let at = move |positions: &[Position], out: &mut [Point]| {
            let points: Vec<Point> = positions.iter().map(|(i, t)| curves[*i].at(*t)).collect();
            image(&points, out);
        };
        Self { pieces: curves.len(), at: Box::new(at) }
    }

    /// The number of pieces.
    pub fn pieces(&self) -> usize {
        self.pieces
    }

    /// The point at a position.
    pub fn at(&self, position: Position) -> Point {
        self.points(&[position])[0]
    }

    fn points(&self, positions: &[Position]) -> Vec<Point> {
        let mut out = vec![Point::ORIGIN; positions.len()];
        (self.at)(positions, &mut out);
        out
    }

    /// Samples each piece `n` times, and more often where a chord may be farther from its arc than a tenth of `height`.
    pub fn sampled(&self, n: usize, height: f64) -> Sampled<'_> {
        const MAX_SAMPLES: usize = 40_000;
        const MAX_ROUNDS: usize = 40;
        let even = |i: usize| (0..=n).map(move |k| (i, k as f64 / n as f64));
        let mut positions: Vec<Position> = (0..self.pieces).flat_map(even).collect();
        let mut points = self.points(&positions);
        let mut changed = vec![true; positions.len()];
        for _ in 0..MAX_ROUNDS {
            let steps = steps(&positions, &points);
            let must_be_halved = |k: &usize| {
                let (i, j) = (*k, k + 1);
                let is_divisible = positions[i].0 == positions[j].0 && positions[j].1 - positions[i].1 > 1e-13;
                let has_changed = changed[i.saturating_sub(1)..(i + 3).min(changed.len())].contains(&true);
                is_divisible && has_changed && bulge(&steps, i) > 0.1 * height
            };
            let halved: Vec<usize> = (0..steps.len()).filter(must_be_halved).collect();
            if halved.is_empty() || positions.len() > MAX_SAMPLES {
                break;
            }
            let middle = |k: usize| (positions[k].0, 0.5 * (positions[k].1 + positions[k + 1].1));
            let new: Vec<Position> = halved.iter().map(|k| middle(*k)).collect();
            let images = self.points(&new);
            let mut next = 0;
            let mut all = Vec::with_capacity(positions.len() + new.len());
            for k in 0..positions.len() {
                all.push((positions[k], (points[k], false)));
                if halved.get(next) == Some(&k) {
                    all.push((new[next], (images[next], true)));
                    next += 1;
                }
            }
            (positions, (points, changed)) = all.into_iter().unzip();
        }
        let steps = steps(&positions, &points);
        let end = |k: usize| if positions[k].0 == positions[k + 1].0 { points[k + 1] } else { points[k] };
        let chords = Polygon::new((0..steps.len()).map(|k| [points[k], end(k)]).collect());
        let bounds: Vec<f64> = (0..steps.len()).map(|k| 2.0 * bulge(&steps, k)).collect();
        let largest_bound = bounds.iter().copied().fold(0.0, f64::max);
        Sampled { run: self, positions, points, chords, bounds, largest_bound }
    }
}

/// The steps from each sample to the next of the piece; zero from one piece to the next.
fn steps(positions: &[Position], points: &[Point]) -> Vec<Vec2> {
    let step = |k: usize| if positions[k].0 == positions[k + 1].0 { points[k + 1] - points[k] } else { Vec2::ZERO };
    (0..points.len().saturating_sub(1)).map(step).collect()
}

/// Estimates the distance of an arc from its chord: an eighth of the chord times the turn to the next chord. The first and the
/// last chord of a piece may hide a turn back, after which they are short.
fn bulge(steps: &[Vec2], k: usize) -> f64 {
    let chord = steps[k];
    let [before, after] =
        [k.checked_sub(1), Some(k + 1)].map(|k| k.and_then(|k| steps.get(k)).copied().unwrap_or_default());
    let turn = |other: Vec2| {
        let (sin, cos) = (chord.cross(other).abs(), chord.dot(other));
        // The tangent of a small angle is hardly more than the angle.
        if sin < 0.2 * cos { sin / cos } else { sin.atan2(cos) }
    };
    let hidden = |other: Vec2| if chord.hypot() < 0.4 * other.hypot() { other.hypot() } else { 0.0 };
    let is_at_end = before == Vec2::ZERO || after == Vec2::ZERO;
    let hidden = if is_at_end { hidden(before).max(hidden(after)) } else { 0.0 };
    0.125 * (chord.hypot() * turn(before).max(turn(after))).max(hidden)
}

/// The samples of a curve and their positions.
pub struct Sampled<'a> {
    pub run: &'a Run<'a>,
    pub positions: Vec<Position>,
    pub points: Vec<Point>,
    /// The lines between consecutive samples of a piece.
    pub chords: Polygon,
    /// Generous bounds on the distance of the curve from each chord.
    bounds: Vec<f64>,
    largest_bound: f64,
}

impl Sampled<'_> {
    /// Goes on from a chord to its neighbours as long as they are nearer to a point. Returns an upper bound on the distance of the curve.
    fn walk(&self, p: Point, chord: &mut usize) -> f64 {
        let upper_bound = |k: usize| self.chords.edge_distance(k, p) + self.bounds[k];
        let mut best = upper_bound(*chord);
        loop {
            let ahead = if *chord + 1 < self.bounds.len() { upper_bound(*chord + 1) } else { f64::INFINITY };
            let behind = if *chord > 0 { upper_bound(*chord - 1) } else { f64::INFINITY };
            if ahead <= best {
                (best, *chord) = (ahead, *chord + 1);
            } else if behind < best {
                (best, *chord) = (behind, *chord - 1);
            } else {
                return best;
            }
        }
    }

    /// The distance of a point from the arc over a chord. Each round divides a bracket by nine and goes on with the nearest part and its
    /// neighbours, so that the lines between the last samples are within 1e-9 of the arc's height. At a jump, the line across it counts.
    fn arc_distance(&self, p: Point, k: usize) -> f64 {
        const PARTS: usize = 9;
        const MAX_ROUNDS: usize = 10;
        let ((i, mut from), (j, mut to)) = (self.positions[k], self.positions[k + 1]);
        let mut points = [Point::ORIGIN; PARTS + 1];
        (points[0], points[PARTS]) = (self.points[k], self.points[k + 1]);
        if i != j {
            return points[0].distance(p).min(points[PARTS].distance(p));
        }
        let mut best = f64::INFINITY;
        for _ in 0..MAX_ROUNDS {
            let position = |m: usize| from + (to - from) * m as f64 / PARTS as f64;
            let positions: [Position; PARTS - 1] = std::array::from_fn(|m| (i, position(m + 1)));
            (self.run.at)(&positions, &mut points[1..PARTS]);
            let parts: [f64; PARTS] = std::array::from_fn(|m| to_edge([points[m], points[m + 1]], p));
            let m = (1..PARTS).fold(0, |m, n| if parts[n] < parts[m] { n } else { m });
            best = parts[m];
            let bracket = [m.saturating_sub(1), (m + 2).min(PARTS)];
            [from, to] = bracket.map(position);
            [points[0], points[PARTS]] = bracket.map(|m| points[m]);
            if points[0].distance(points[PARTS]) <= 1e-5 * best {
                break;
            }
        }
        best
    }
}

/// Approximates a path by a polygon at a distance of at most `within`. Open subpaths stay open.
pub fn flat(path: &dyn Curved, within: f64) -> Polygon {
    Run::of(&path.curves()).sampled(8, 10.0 * within).chords
}

/// The largest distance of points from the curves `to`, with the farthest point.
pub fn far<'a>(points: &[Point], to: &'a [Sampled<'a>]) -> (f64, Point) {
    let mut all: Vec<(f64, Point, Option<Chord<'a>>)> = Vec::with_capacity(points.len());
    let (mut near, mut last): (Option<Chord<'a>>, _) = (None, 0.0);
    for p in points {
        if p.is_nan() {
            return (f64::NAN, *p);
        }
        // Mostly, the nearest chord is near the nearest chord of the last point.
        let mut bound = near.as_mut().map_or(f64::INFINITY, |(s, k)| s.walk(*p, k));
        if bound > 4.0 * last {
            for s in to {
                s.chords.search(*p, bound, |k, d| {
                    if d + s.bounds[k] < bound {
                        (bound, near) = (d + s.bounds[k], Some((s, k)));
                    }
                    bound
                });
            }
        }
        last = bound;
        all.push((bound, *p, near));
    }
    all.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
    let mut worst = (0.0, Point::ORIGIN);
    for (bound, p, near) in all {
        if bound <= worst.0 {
            break;
        }
        let d = exact_distance(p, to, near, worst.0);
        if d > worst.0 {
            worst = (d, p);
        }
    }
    worst
}

/// A chord of sampled curves, by its index.
type Chord<'a> = (&'a Sampled<'a>, usize);

/// The distance of a point from curves, of which `near` may be the nearest chord. Below `enough` it need not be exact.
fn exact_distance(p: Point, to: &[Sampled<'_>], near: Option<Chord<'_>>, enough: f64) -> f64 {
    let mut best = near.map_or(f64::INFINITY, |(s, k)| s.arc_distance(p, k));
    for s in to {
        s.chords.search(p, best + s.largest_bound, |k, d| {
            if best > enough && d - s.bounds[k] < best {
                best = best.min(s.arc_distance(p, k));
            }
            if best > enough { best + s.largest_bound } else { 0.0 }
        });
    }
    best
}

/// The largest distance between two curves, in either direction, with the point that is so far away.
pub fn apart(a: &Sampled<'_>, b: &Sampled<'_>) -> (f64, Point) {
    let (there, back) = (far(&a.points, from_ref(b)), far(&b.points, from_ref(a)));
    if there.0 > back.0 || there.0.is_nan() { there } else { back }
}
