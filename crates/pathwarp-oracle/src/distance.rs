//! The distance between two curves, in both directions.
//!
//! Both are sampled until no chord is farther from its arc than a tenth of a height, as the turns of the chords tell. Every sample of one
//! is then compared with the other: first with its chords, and, farthest samples first, with the curve itself over every chord beside
//! which the nearest point may lie. So cusps, hairpins and crossings need no good start. A sample's distance is true, and the
//! largest one falls short of the true distance by no more than what the distance grows by between two samples.

use crate::curves::{Curve, Curved};
use crate::polygon::{Polygon, to_edge};
use kurbo::{Point, Vec2};
use std::slice::from_ref;

/// A piece of a curve, and a parameter from 0 to 1 on it.
pub type Place = (usize, f64);

/// Maps points, many at a time.
pub type Image<'a> = &'a (dyn Fn(&[Point], &mut [Point]) + 'a);

/// The points at many places.
type At<'a> = Box<dyn Fn(&[Place], &mut [Point]) + 'a>;

/// A curve in pieces.
pub struct Run<'a> {
    pieces: usize,
    at: At<'a>,
}

impl<'a> Run<'a> {
    /// A curve of so many pieces that a function describes.
    pub fn new(pieces: usize, at: impl Fn(Place) -> Point + 'a) -> Self {
        Self { pieces, at: Box::new(move |places, out| places.iter().zip(out).for_each(|(p, out)| *out = at(*p))) }
    }

    pub fn of(curves: &'a [Curve]) -> Self {
        Self::image(curves, &|points, out| out.copy_from_slice(points))
    }

    /// The image of curves under a map.
    pub fn image(curves: &'a [Curve], image: Image<'a>) -> Self {
        let at = move |places: &[Place], out: &mut [Point]| {
            let points: Vec<Point> = places.iter().map(|(i, t)| curves[*i].at(*t)).collect();
            image(&points, out);
        };
        Self { pieces: curves.len(), at: Box::new(at) }
    }

    pub fn pieces(&self) -> usize {
        self.pieces
    }

    pub fn at(&self, place: Place) -> Point {
        let mut out = [Point::ORIGIN];
        (self.at)(&[place], &mut out);
        out[0]
    }

    fn points(&self, places: &[Place]) -> Vec<Point> {
        let mut out = vec![Point::ORIGIN; places.len()];
        (self.at)(places, &mut out);
        out
    }

    /// Samples each piece `n` times, and more often where a chord may be farther from its arc than a tenth of `height`.
    pub fn sampled(&self, n: usize, height: f64) -> Sampled<'_> {
        const MOST: usize = 40_000;
        let even = |i: usize| (0..=n).map(move |k| (i, k as f64 / n as f64));
        let mut places: Vec<Place> = (0..self.pieces).flat_map(even).collect();
        let mut points = self.points(&places);
        let mut changed = vec![true; places.len()];
        for _ in 0..40 {
            let steps = steps(&places, &points);
            let halved: Vec<usize> = (0..steps.len())
                .filter(|&k| {
                    let same = places[k].0 == places[k + 1].0 && places[k + 1].1 - places[k].1 > 1e-13;
                    let looked_at =
                        changed[k] || changed[k + 1] || (k > 0 && changed[k - 1]) || changed.get(k + 2) == Some(&true);
                    same && looked_at && bulge(&steps, k) > 0.1 * height
                })
                .collect();
            if halved.is_empty() || places.len() > MOST {
                break;
            }
            let middle = |k: usize| (places[k].0, 0.5 * (places[k].1 + places[k + 1].1));
            let new: Vec<Place> = halved.iter().map(|k| middle(*k)).collect();
            let images = self.points(&new);
            let mut next = 0;
            let mut all = Vec::with_capacity(places.len() + new.len());
            for k in 0..places.len() {
                all.push((places[k], (points[k], false)));
                if halved.get(next) == Some(&k) {
                    all.push((new[next], (images[next], true)));
                    next += 1;
                }
            }
            (places, (points, changed)) = all.into_iter().unzip();
        }
        let steps = steps(&places, &points);
        let to = |k: usize| if places[k].0 == places[k + 1].0 { points[k + 1] } else { points[k] };
        let chords = Polygon::new((0..steps.len()).map(|k| [points[k], to(k)]).collect());
        let rooms: Vec<f64> = (0..steps.len()).map(|k| 2.0 * bulge(&steps, k)).collect();
        let room = rooms.iter().copied().fold(0.0, f64::max);
        Sampled { run: self, places, points, chords, rooms, room }
    }
}

/// From each sample to the next of the same piece.
fn steps(places: &[Place], points: &[Point]) -> Vec<Vec2> {
    let step = |k: usize| if places[k].0 == places[k + 1].0 { points[k + 1] - points[k] } else { Vec2::ZERO };
    (0..points.len().saturating_sub(1)).map(step).collect()
}

/// How far an arc may be from its chord: its height is an eighth of the chord times the turn to the next chord. The first and the last
/// chord of a piece may hide a turn back, after which they are short.
fn bulge(steps: &[Vec2], k: usize) -> f64 {
    let own = steps[k];
    let [before, after] =
        [k.checked_sub(1), Some(k + 1)].map(|k| k.and_then(|k| steps.get(k)).copied().unwrap_or_default());
    let turn = |other: Vec2| {
        let (sin, cos) = (own.cross(other).abs(), own.dot(other));
        // The tangent of a small angle is hardly more than the angle.
        if sin < 0.2 * cos { sin / cos } else { sin.atan2(cos) }
    };
    let hidden = |other: Vec2| if own.hypot() < 0.4 * other.hypot() { other.hypot() } else { 0.0 };
    let at_an_end = before == Vec2::ZERO || after == Vec2::ZERO;
    let hidden = if at_an_end { hidden(before).max(hidden(after)) } else { 0.0 };
    0.125 * (own.hypot() * turn(before).max(turn(after))).max(hidden)
}

/// A sampled curve: the samples and their places.
pub struct Sampled<'a> {
    pub run: &'a Run<'a>,
    pub places: Vec<Place>,
    pub points: Vec<Point>,
    /// The lines between consecutive samples of a piece.
    pub chords: Polygon,
    /// How far the curve may be from each chord, generously, and the most of that.
    rooms: Vec<f64>,
    room: f64,
}

impl Sampled<'_> {
    /// Goes on from a chord to its neighbours as long as they are nearer to a point. Returns a distance that the curve has at most.
    fn walk(&self, p: Point, chord: &mut usize) -> f64 {
        let most = |k: usize| self.chords.to(k, p) + self.rooms[k];
        let mut best = most(*chord);
        loop {
            let ahead = if *chord + 1 < self.rooms.len() { most(*chord + 1) } else { f64::INFINITY };
            let behind = if *chord > 0 { most(*chord - 1) } else { f64::INFINITY };
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
    /// neighbours, so that the lines between the last places are within 1e-9 of the arc's height. At a jump, the line across it counts.
    fn beside(&self, p: Point, k: usize) -> f64 {
        const PARTS: usize = 9;
        let ((i, mut from), (j, mut to)) = (self.places[k], self.places[k + 1]);
        let mut points = [Point::ORIGIN; PARTS + 1];
        (points[0], points[PARTS]) = (self.points[k], self.points[k + 1]);
        if i != j {
            return points[0].distance(p).min(points[PARTS].distance(p));
        }
        let mut best = f64::INFINITY;
        for _ in 0..10 {
            let place = |m: usize| from + (to - from) * m as f64 / PARTS as f64;
            let places: [Place; PARTS - 1] = std::array::from_fn(|m| (i, place(m + 1)));
            (self.run.at)(&places, &mut points[1..PARTS]);
            let parts: [f64; PARTS] = std::array::from_fn(|m| to_edge([points[m], points[m + 1]], p));
            let m = (1..PARTS).fold(0, |m, n| if parts[n] < parts[m] { n } else { m });
            best = parts[m];
            let bracket = [m.saturating_sub(1), (m + 2).min(PARTS)];
            [from, to] = bracket.map(place);
            [points[0], points[PARTS]] = bracket.map(|m| points[m]);
            if points[0].distance(points[PARTS]) <= 1e-5 * best {
                break;
            }
        }
        best
    }
}

/// A path as a polygon that is so close to it. Open subpaths stay open.
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
        // The nearest chord is near that of the last point, mostly, and else found anew.
        let mut most = near.as_mut().map_or(f64::INFINITY, |(s, k)| s.walk(*p, k));
        if most > 4.0 * last {
            for s in to {
                s.chords.search(*p, most, |k, d| {
                    if d + s.rooms[k] < most {
                        (most, near) = (d + s.rooms[k], Some((s, k)));
                    }
                    most
                });
            }
        }
        last = most;
        all.push((most, *p, near));
    }
    all.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
    let mut worst = (0.0, Point::ORIGIN);
    for (most, p, near) in all {
        if most <= worst.0 {
            break;
        }
        let d = exactly(p, to, near, worst.0);
        if d > worst.0 {
            worst = (d, p);
        }
    }
    worst
}

type Chord<'a> = (&'a Sampled<'a>, usize);

/// The distance of a point from curves, of which one chord may be the nearest. Below `enough` it need not be exact.
fn exactly(p: Point, to: &[Sampled<'_>], near: Option<Chord<'_>>, enough: f64) -> f64 {
    let mut best = near.map_or(f64::INFINITY, |(s, k)| s.beside(p, k));
    for s in to {
        s.chords.search(p, best + s.room, |k, d| {
            if best > enough && d - s.rooms[k] < best {
                best = best.min(s.beside(p, k));
            }
            if best > enough { best + s.room } else { 0.0 }
        });
    }
    best
}

/// The largest distance between two curves, in either direction, with the place that is so far away.
pub fn apart(a: &Sampled<'_>, b: &Sampled<'_>) -> (f64, Point) {
    let (there, back) = (far(&a.points, from_ref(b)), far(&b.points, from_ref(a)));
    if there.0 > back.0 || there.0.is_nan() { there } else { back }
}
