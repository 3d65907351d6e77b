//! Strokes under maps: what is written covers the image of every point inside of the stroke, and of none outside, up to the tolerance.

use super::paths::{Random, drawn, path};
use super::{Maps, maps};
use pathwarp::Outline;
use pathwarp::kurbo::{Point, Rect, Vec2};
use pathwarp_oracle::curves::{self, Curve};
use pathwarp_oracle::measure::sampled;
use serde_json::Value;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Points that are tried on either side of each stroke.
const PROBES: usize = 200;

/// A polygon with the numbers by which windings around it are counted.
struct Polygon(Vec<[Point; 2]>);

impl Polygon {
    /// Subpaths as chords that are within a tenth of `height` of them.
    fn along(subpaths: &[Vec<Curve>], height: f64) -> Self {
        let same = |ps: &[Point]| ps.to_vec();
        let runs = subpaths.iter().map(|run| sampled(run, &same, 64, height).points);
        Self(runs.flat_map(|p| p.windows(2).map(|w| [w[0], w[1]]).collect::<Vec<_>>()).collect())
    }

    fn winding(&self, p: Point) -> i32 {
        let crossed = |[a, b]: &[Point; 2]| {
            let is_left = (p.y - a.y) * (b.x - a.x) < (p.x - a.x) * (b.y - a.y);
            match (a.y <= p.y, b.y <= p.y) {
                (true, false) if !is_left => 1,
                (false, true) if is_left => -1,
                _ => 0,
            }
        };
        self.0.iter().map(crossed).sum()
    }
}

/// The distance of a point from the middle line, as chords of it.
fn from_line(chords: &[[Point; 2]], p: Point) -> f64 {
    let to = |[a, b]: &[Point; 2]| {
        let along = *b - *a;
        let t = if along.hypot2() > 0.0 { ((p - *a).dot(along) / along.hypot2()).clamp(0.0, 1.0) } else { 0.0 };
        p.distance(*a + along * t)
    };
    chords.iter().map(to).fold(f64::INFINITY, f64::min)
}

/// Points on the edges of a stroke, on either side, as far as other parts of it do not cover them.
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

/// The smaller singular value of a Jacobian.
fn least_stretch([dx, dy]: &[Vec2; 2]) -> f64 {
    let (sum, det) = (dx.hypot2() + dy.hypot2(), dx.cross(*dy));
    (0.5 * (sum - (sum * sum - 4.0 * det * det).max(0.0).sqrt())).sqrt()
}

/// How many probes were decided, and where one is on the wrong side.
struct Probed {
    decided: usize,
    wrong: Vec<(Point, bool)>,
}

/// Strokes `d` round about `width` wide and looks on which side of the written outline points beside the edge come to lie. `None`: the
/// program refuses the pair, or says that it misses the tolerance.
fn probed(r: &mut Random, d: &str, width: f64, map: &Maps) -> Option<Probed> {
    let text = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'><path d=\"{d}\" fill='none' stroke='#000' \
         stroke-width='{width}' stroke-linejoin='round' stroke-linecap='round'/></svg>"
    );
    let mut warper = map.warper.clone();
    warper.set_option("strokes", "outline").unwrap();
    let done = warper.warp_drawing(text.as_bytes(), None).ok()?;
    let report: Value = serde_json::from_str(&done.report).unwrap();
    let of = |v: &Value| v.as_f64().unwrap_or(f64::NAN);
    let tolerance = of(&report["tolerance"]);
    if report["shapes"].as_array()?.iter().any(|s| s["over_budget"].as_array().is_some_and(|o| !o.is_empty())) {
        return None;
    }
    let frame: Vec<f64> = report["frame"].as_array()?.iter().map(of).collect();
    let frame = Rect::new(frame[0], frame[1], frame[0] + frame[2], frame[1] + frame[3]);
    let out = String::from_utf8(done.bytes).unwrap();
    let (written, style) = out.split_once("<path d=\"")?.1.split_once('>')?.0.split_once('"')?;
    if style.contains("stroke=\"#000") || style.contains("stroke='#000") {
        // An affine map takes the stroke along as it is.
        return None;
    }
    let written = Polygon::along(&curves::closed(curves::read(written)), 0.2 * tolerance);
    let points = warper.point_map(|| Some(frame), || Outline::from_svg(d).unwrap_or_default()).ok()?;
    let source = curves::read(d);
    if source.is_empty() {
        return None;
    }
    let lines = Polygon::along(&source, 0.05 * tolerance);
    let edges = edges(r, &source, width);
    let mut jacobians = vec![[Vec2::ZERO; 2]; edges.len()];
    points.jacobians(&edges, &mut jacobians);
    let mut all = Probed { decided: 0, wrong: Vec::new() };
    // Where the map turns areas over, windings of the image say nothing.
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
        let middle = lines.0.iter().min_by(|a, b| from_line(&[**a], edge).total_cmp(&from_line(&[**b], edge))).unwrap();
        let out = edge - middle[0].midpoint(middle[1]);
        for (by, inside) in [(-room, true), (room, false)] {
            let q = edge + out / out.hypot() * by;
            let off = from_line(&lines.0, q) - 0.5 * width;
            if (off < 0.0) != inside || off.abs() < 0.8 * room || (overlaps && !inside) {
                continue;
            }
            let (mut image, mut jacobian) = ([Point::ORIGIN], [[Vec2::ZERO; 2]]);
            points.points(&[q], &mut image);
            points.jacobians(&[q], &mut jacobian);
            // Where the map changes fast, the stretch at the edge says little about the disc.
            let changes = !(0.7..1.4).contains(&(least_stretch(&jacobian[0]) * room / (1.5 * tolerance)));
            if changes || !image[0].is_finite() {
                continue;
            }
            all.decided += 1;
            if (written.winding(image[0]) != 0) != inside {
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
    // Inverses need the frame of what they undo.
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
