//! Strokes under maps: the result covers the image of every point inside of the stroke, and of none outside, up to the tolerance.

use super::paths::{drawn, path};
use super::{Maps, maps};
use pathwarp::kurbo::{Point, Vec2};
use pathwarp_oracle::curves::{self, Curve};
use pathwarp_oracle::{Polygon, Random, Run};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Number of points probed on either side of each stroke.
const PROBES: usize = 200;

/// Returns subpaths as chords that are within a tenth of `height` of them.
fn chords(subpaths: &[Vec<Curve>], height: f64) -> Polygon {
    Polygon::new(subpaths.iter().flat_map(|run| Run::of(run).sampled(64, height).chords.edges).collect())
}

/// Returns points on the edges of a stroke, on either side, where other parts of it do not cover them.
fn edges(r: &mut Random, source: &[Vec<Curve>], width: f64) -> Vec<Point> {
    let mut out = Vec::new();
    for _ in 0..PROBES {
        let run = &source[r.below(source.len())];
        let (curve, t) = (run[r.below(run.len())], r.between(0.001, 0.999));
        let along = curve.at(t + 5e-4) - curve.at(t - 5e-4);
        if along.hypot() > 0.0 {
            let side = if r.below(2) == 0 { 0.5 } else { -0.5 };
            out.push(curve.at(t) + Vec2::new(-along.y, along.x) * (side * width / along.hypot()));
        }
    }
    out
}

/// Returns the smaller singular value of a Jacobian.
fn least_stretch([dx, dy]: &[Vec2; 2]) -> f64 {
    let (sum, det) = (dx.hypot2() + dy.hypot2(), dx.cross(*dy));
    (0.5 * (sum - (sum * sum - 4.0 * det * det).max(0.0).sqrt())).sqrt()
}

/// The number of probes that were decided, and those on the wrong side.
struct Probed {
    decided: usize,
    wrong: Vec<(Point, bool)>,
}

/// Strokes `d` about `width` wide, and finds the side of the written outline on which points beside the edge lie. `None` if the program
/// refuses the pair, or reports that it misses the tolerance.
fn probed(r: &mut Random, d: &str, width: f64, map: &Maps) -> Option<Probed> {
    let text = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path d=\"{d}\" fill='none' stroke='#000' \
         stroke-width='{width}' stroke-linejoin='round' stroke-linecap='round'/></svg>"
    );
    let mut warper = map.warper.clone();
    warper.set_option("strokes", "outline").unwrap();
    let done = super::done(&warper, &text, d)?;
    let (tolerance, points) = (done.tolerance, &done.map);
    let (written, style) = done.svg.split_once("<path d=\"")?.1.split_once('>')?.0.split_once('"')?;
    if style.contains("stroke=\"#000") || style.contains("stroke='#000") {
        // An affine map transforms the stroke as a whole.
        return None;
    }
    let written = chords(&curves::closed(curves::read(written)), 0.2 * tolerance);
    let source = curves::read(d);
    if source.is_empty() {
        return None;
    }
    let lines = chords(&source, 0.05 * tolerance);
    let edges = edges(r, &source, width);
    let mut jacobians = vec![[Vec2::ZERO; 2]; edges.len()];
    points.jacobians(&edges, &mut jacobians);
    let mut all = Probed { decided: 0, wrong: Vec::new() };
    // Where the map turns areas over, winding numbers of the image are meaningless.
    let turns: Vec<f64> = jacobians.iter().map(|[dx, dy]| dx.cross(*dy)).collect();
    if turns.iter().any(|t| *t < 0.0) && turns.iter().any(|t| *t > 0.0) {
        return Some(all);
    }
    let chosen = edges.iter().zip(&jacobians).filter_map(|(edge, jacobian)| {
        // A disc of a tolerance in the image has a preimage no longer than this.
        let room = 1.5 * tolerance / least_stretch(jacobian);
        (room < 0.05 * width).then_some((*edge, room))
    });
    // A bend may lay one part of the plane on another.
    let overlaps = map.name.contains("bend ");
    for (edge, room) in chosen {
        let middle = lines.edges[lines.nearest(edge).1];
        let out = edge - middle[0].midpoint(middle[1]);
        for (by, inside) in [(-room, true), (room, false)] {
            let q = edge + out / out.hypot() * by;
            let off = lines.distance(q) - 0.5 * width;
            if (off < 0.0) != inside || off.abs() < 0.8 * room || (overlaps && !inside) {
                continue;
            }
            let (mut image, mut jacobian) = ([Point::ORIGIN], [[Vec2::ZERO; 2]]);
            points.points(&[q], &mut image);
            points.jacobians(&[q], &mut jacobian);
            // Where the map changes fast, the stretch at the edge is no bound for the disc.
            let changes = !(0.7..1.4).contains(&(least_stretch(&jacobian[0]) * room / (1.5 * tolerance)));
            if changes || !image[0].is_finite() {
                continue;
            }
            all.decided += 1;
            if written.covers(image[0]) != inside {
                all.wrong.push((image[0], inside));
            }
        }
    }
    Some(all)
}

#[test]
fn strokes_cover_what_they_covered() {
    let wanted: usize = std::env::var("PATHWARP_STROKES").ok().and_then(|n| n.parse().ok()).unwrap_or(400);
    let first: usize = std::env::var("PATHWARP_FIRST").ok().and_then(|n| n.parse().ok()).unwrap_or(0);
    let mut maps = maps();
    // Inverses need the frame of the map that they undo.
    maps.retain(|m| !m.name.starts_with("inverse"));
    let (next, decided, refused) = (AtomicUsize::new(first), AtomicUsize::new(0), AtomicUsize::new(0));
    let failures: Mutex<Vec<String>> = Mutex::default();
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(2, usize::from) {
            scope.spawn(|| {
                loop {
                    let i = next.fetch_add(1, Ordering::Relaxed);
                    if i >= first + wanted {
                        break;
                    }
                    let mut r = Random::new(0x57_0000_0000 + i as u64);
                    let (_, d) = if i % 5 == 4 { drawn(&mut r) } else { path(&mut r) };
                    let width = r.between(0.5, 3.0).exp2();
                    let map = &maps[r.below(maps.len())];
                    let Some(found) = probed(&mut r, &d, width, map) else {
                        refused.fetch_add(1, Ordering::Relaxed);
                        continue;
                    };
                    decided.fetch_add(found.decided, Ordering::Relaxed);
                    if let [(p, inside), ..] = found.wrong[..] {
                        let n = found.wrong.len();
                        let p = format!("{p:?}, which is {}", if inside { "inside" } else { "outside" });
                        let what = format!("{i}: {n} of {}, {p}: {width} {}\n   {d}", found.decided, map.name);
                        failures.lock().unwrap().push(what);
                    }
                }
            });
        }
    });
    let (decided, refused) = (decided.into_inner(), refused.into_inner());
    println!("{wanted} strokes, {refused} refused, {decided} points beside edges");
    assert!(2 * refused < wanted && decided > 20 * wanted, "{refused} of {wanted} refused, {decided} points decided");
    let mut failures = failures.into_inner().unwrap();
    failures.sort();
    assert!(failures.is_empty(), "{} strokes:\n{}", failures.len(), failures.join("\n"));
}
