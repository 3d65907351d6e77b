//! A closed path divided into four sides: its corners and its bottom, given or found.

use super::columns::part;
use super::ring::{Corners, Ring, SAMPLES, area, mirrored, reversed};
use crate::anchors;
use crate::error::{Error, show};
use crate::outline::{Seg, Subpath};
use crate::param::NamedPath;
use kurbo::{Point, Rect, Vec2};

/// A joint that turns by at least this angle (degrees) looks like a corner.
const CORNER: f64 = 20.0;
/// A point this close to a corner by angle, as a share of the box, snaps to it.
const SNAP: f64 = 0.15;
/// Limit on a path's pieces: every joint is a crease of the map.
const MAX_PIECES: usize = 2000;
/// A location on the path: piece and parameter.
type Location = (usize, f64);

/// Returns the box of a closed path.
pub(super) fn bounds(sub: &Subpath) -> Rect {
    sub.segs.iter().map(Seg::bounding_box).reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO)
}

/// Reads a closed path that encloses something.
pub(super) fn closed(path: &NamedPath) -> Result<Subpath, Error> {
    let sub = anchors::closed_subpath(path, "a single closed run of them", |lines| lines >= 2)?;
    if sub.segs.len() > MAX_PIECES {
        let problem = format!("has {} pieces; the limit is {MAX_PIECES}: simplify it", sub.segs.len());
        return Err(Error::usage("envelope", path.name.clone(), problem));
    }
    let bounds = bounds(&sub);
    if !(bounds.width() > 0.0 && bounds.height() > 0.0) {
        return Err(Error::usage("envelope", path.name.clone(), "is flat: it encloses nothing"));
    }
    Ok(sub)
}

/// Divides a closed path into four sides. Corners and bottom are found unless given; nothing is mirrored unless `reverse`.
pub(super) fn ring(
    path: &NamedPath,
    corners: Option<&Corners>,
    bottom_side: Option<usize>,
    reverse: bool,
) -> Result<Ring, Error> {
    let sub = closed(path)?;
    let bounds = bounds(&sub);
    let (locations, how) = match corners {
        Some(corners) => (given(&sub, corners, bounds)?, "as given"),
        None => found(&path.name, &sub, bounds)?,
    };
    let drawn = cut(&sub.segs, locations);
    let area: f64 = drawn.iter().flatten().map(area).sum();
    // With y down, bottom → right → top → left is counter-clockwise on the screen.
    let backwards = area > 0.0;
    let order = if backwards { [3, 2, 1, 0] } else { [0, 1, 2, 3] };
    let run = |i: usize| -> Vec<Seg> { if backwards { reversed(&drawn[i]) } else { drawn[i].clone() } };
    let sides = order.map(run);
    let bottom = match bottom_side {
        Some(n) => order.iter().position(|i| *i + 1 == n).unwrap_or(0),
        None => lowest(&sides),
    };
    let mut sides: [Vec<Seg>; 4] = std::array::from_fn(|i| sides[(bottom + i) % 4].clone());
    let corners: Vec<String> = sides.iter().filter_map(|s| s.first()).map(|s| show(s.start())).collect();
    let mut notes = vec![
        format!(
            "corners of {} ({how}): {} (bottom left, bottom right, top right, top left)",
            path.name,
            corners.join(" ")
        ),
        format!(
            "bottom side: side {} as drawn, run {}, so that nothing is mirrored; `bottom-side` and `reverse` override that",
            order[bottom] + 1,
            if backwards { "backwards" } else { "forwards" }
        ),
    ];
    if reverse {
        sides = mirrored(sides);
        notes.push("reverse: the bottom side runs the other way, so that the result is mirrored".into());
    }
    Ok(Ring { sides, notes, warnings: Vec::new() })
}

/// Returns the lowest side on the screen among those that run to the right.
fn lowest(sides: &[Vec<Seg>; 4]) -> usize {
    let height = |side: &[Seg]| {
        // Mean height by length.
        let parts = side
            .iter()
            .flat_map(|s| (0..SAMPLES).map(move |i| (f64::from(i) + 0.5) / f64::from(SAMPLES)).map(move |t| (s, t)));
        let (sum, length) = parts.fold((0.0, 0.0), |(sum, all), (s, t)| {
            let speed = s.deriv(t).hypot();
            (sum + speed * s.eval(t).y, all + speed)
        });
        sum / length
    };
    let to_the_right = |side: &[Seg]| side.first().zip(side.last()).is_some_and(|(a, b)| b.end().x > a.start().x);
    // The first of equals; tiny differences are rounding.
    let mut best: Option<(usize, f64)> = None;
    for (i, side) in sides.iter().enumerate().filter(|(_, s)| to_the_right(s)) {
        let here = height(side);
        if best.is_none_or(|(_, b)| here > b + 1e-9 * (here.abs() + b.abs())) {
            best = Some((i, here));
        }
    }
    best.map_or(0, |b| b.0)
}

/// Cuts the path at its corners.
fn cut(segs: &[Seg], locations: [Location; 4]) -> [Vec<Seg>; 4] {
    std::array::from_fn(|i| {
        let ((from, a), (to, b)) = (locations[i], locations[(i + 1) % 4]);
        let mut out = Vec::new();
        let (mut at, mut start) = (from, a);
        // At most once around.
        for _ in 0..=segs.len() {
            if at == to && b > start {
                out.push(part(&segs[at], start, b));
                break;
            }
            out.push(part(&segs[at], start, 1.0));
            (at, start) = ((at + 1) % segs.len(), 0.0);
            if at == to && b == 0.0 {
                break;
            }
        }
        // Close the gap that rounding leaves to the next part.
        let next = segs[to].eval(b);
        if let Some(last) = out.last_mut() {
            *last = anchors::ending_at(last, next);
        }
        out
    })
}

/// Returns the locations of given corners.
fn given(sub: &Subpath, corners: &Corners, bounds: Rect) -> Result<[Location; 4], Error> {
    let (mut locations, text) = match corners {
        Corners::Nodes(nodes) => {
            let text = nodes.map(|n| n.to_string()).join(",");
            let most = sub.segs.len();
            if let Some(bad) = nodes.iter().find(|n| !(1..=most).contains(n)) {
                let problem = format!("has node {bad}, which is not there: the path has nodes 1 to {most}");
                return Err(Error::usage("corners", text, problem));
            }
            (nodes.map(|n| (n - 1, 0.0)), text)
        }
        Corners::Points(points) => {
            let text = points.map(show).join(" ");
            (points.map(|p| nearest(sub, p, Vec2::new(1.0, 1.0), bounds)), text)
        }
    };
    locations.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    if locations.windows(2).any(|w| w[0] == w[1]) {
        return Err(Error::usage("corners", text, "names one point of the path twice; four different ones are needed"));
    }
    Ok(locations)
}

/// Finds corners: a path's only four nodes if each lies in another quarter of its box; four corners by angle if they do too, or
/// span at least as much as the last choice; the points nearest to the box's corners.
fn found(name: &str, sub: &Subpath, bounds: Rect) -> Result<([Location; 4], &'static str), Error> {
    let n = sub.segs.len();
    let sharp: Vec<usize> = (0..n).filter(|&i| turn(sub, i).abs() >= CORNER).collect();
    let four = <[usize; 4]>::try_from(sharp.clone()).ok().map(|c| c.map(|i| (i, 0.0)));
    let boxed = by_box(sub, bounds, &sharp);
    let span = |locations: &[Location; 4]| {
        let p = locations.map(|(i, t)| sub.segs[i].eval(t));
        (p[2] - p[0]).cross(p[3] - p[1]).abs()
    };
    let quartered = |locations: &[Location; 4]| {
        let mut seen: Vec<_> = locations.iter().filter_map(|p| quarter(sub.segs[p.0].eval(p.1), bounds)).collect();
        seen.sort_unstable();
        seen.dedup();
        seen.len() == 4
    };
    // Four nodes are meant as corners, unless they are those of a circle.
    let nodes = [0, 1, 2, 3].map(|i| (i, 0.0));
    if n == 4 && quartered(&nodes) {
        return Ok((nodes, "its four nodes"));
    }
    match (four, boxed) {
        (Some(four), None) => Ok((four, "found by angle")),
        (Some(four), Some(boxed)) if quartered(&four) || span(&four) >= span(&boxed) => Ok((four, "found by angle")),
        (_, Some(boxed)) => Ok((boxed, "the points nearest to the corners of its box")),
        (None, None) => {
            let problem = format!(
                "has {} corners by angle, and its box does not determine them: give `corners` (four node numbers, or four points)",
                sharp.len()
            );
            Err(Error::usage("envelope", name, problem))
        }
    }
}

/// Returns the quarter of the box that a point lies in; `None` if it is too close to the box's middle lines.
fn quarter(p: Point, bounds: Rect) -> Option<(bool, bool)> {
    /// Distance from the middle lines, as a share of the box.
    const MIDDLE: f64 = 0.05;
    let (x, y) = ((p.x - bounds.x0) / bounds.width() - 0.5, (p.y - bounds.y0) / bounds.height() - 0.5);
    (x.abs() > MIDDLE && y.abs() > MIDDLE).then_some((x > 0.0, y > 0.0))
}

/// Returns the points nearest to the corners of the path's box, or corners by angle near them; `None` if their order along the
/// path is not the box's.
fn by_box(sub: &Subpath, bounds: Rect, sharp: &[usize]) -> Option<[Location; 4]> {
    // Relative to the box, so that an ellipse is treated like a circle.
    let share = |v: Vec2| Vec2::new(v.x / bounds.width(), v.y / bounds.height());
    let box_corners = [(bounds.x0, bounds.y1), (bounds.x1, bounds.y1), (bounds.x1, bounds.y0), (bounds.x0, bounds.y0)];
    let locations = box_corners.map(Point::from).map(|c| {
        let location = nearest(sub, c, Vec2::new(1.0 / bounds.width(), 1.0 / bounds.height()), bounds);
        let here = sub.segs[location.0].eval(location.1);
        let off = |i: &usize| share(sub.segs[*i].start() - here).hypot();
        let corner = sharp.iter().min_by(|a, b| off(a).total_cmp(&off(b))).filter(|i| off(i) <= SNAP);
        corner.map_or(location, |i| (*i, 0.0))
    });
    let mut sorted = locations;
    sorted.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    // The box's corners must follow one another along the path, in either direction.
    let at = |p: &Location| sorted.iter().position(|q| q == p).unwrap_or(0);
    let [a, b, c, d] = locations.each_ref().map(at);
    let apart =
        |p: &[Location]| sub.segs[p[0].0].eval(p[0].1).distance(sub.segs[p[1].0].eval(p[1].1)) > 1e-9 * bounds.width();
    let in_turn = [(a, b), (b, c), (c, d), (d, a)];
    let round = |step: usize| in_turn.iter().all(|(x, y)| (x + step) % 4 == *y);
    (sorted.windows(2).all(apart) && (round(1) || round(3))).then_some(sorted)
}

/// Returns the nodes of a path that runs around its area with this sign at which it turns sharply outwards.
pub(super) fn sharp(sub: &Subpath, around: f64) -> impl Iterator<Item = usize> {
    (0..sub.segs.len()).filter(move |i| turn(sub, *i) * around >= CORNER)
}

/// Returns the angle by which the path turns at a node, degrees.
fn turn(sub: &Subpath, node: usize) -> f64 {
    let n = sub.segs.len();
    let (a, b) = (&sub.segs[(node + n - 1) % n], &sub.segs[node]);
    /// The direction is taken this much further in where a piece has no speed.
    const ASIDE: f64 = 1e-4;
    let direction = |s: &Seg, t: f64, aside: f64| {
        let v = s.deriv(t);
        let size = s.bounding_box();
        if v.hypot() <= 1e-9 * (size.width() + size.height()) { s.deriv(aside) } else { v }
    };
    let (v, w) = (direction(a, 1.0, 1.0 - ASIDE), direction(b, 0.0, ASIDE));
    v.cross(w).atan2(v.dot(w)).to_degrees()
}

/// Returns the location nearest to `c`, both axes scaled: the best sample, refined to where the distance's slope vanishes. Ends
/// of pieces are nodes.
fn nearest(sub: &Subpath, c: Point, scale: Vec2, bounds: Rect) -> Location {
    let scaled = |v: Vec2| Vec2::new(v.x * scale.x, v.y * scale.y);
    let off = |s: &Seg, t: f64| scaled(s.eval(t) - c);
    let mut best = (f64::INFINITY, (0, 0.0));
    for (i, s) in sub.segs.iter().enumerate() {
        for k in 0..=SAMPLES {
            let t = f64::from(k) / f64::from(SAMPLES);
            let here = off(s, t).hypot2();
            if here < best.0 {
                best = (here, (i, t));
            }
        }
    }
    let (i, t) = best.1;
    let s = &sub.segs[i];
    let step = 1.0 / f64::from(SAMPLES);
    let (mut lo, mut hi) = ((t - step).max(0.0), (t + step).min(1.0));
    let slope = |t: f64| off(s, t).dot(scaled(s.deriv(t)));
    // 60 bisections reduce a unit interval to rounding.
    for _ in 0..60 {
        let middle = 0.5 * (lo + hi);
        if slope(middle) > 0.0 {
            hi = middle;
        } else {
            lo = middle;
        }
    }
    let t = 0.5 * (lo + hi);
    let near = |p: Point| s.eval(t).distance(p) <= 1e-6 * (bounds.width() + bounds.height());
    match (near(s.start()), near(s.end())) {
        (true, _) => (i, 0.0),
        (_, true) => ((i + 1) % sub.segs.len(), 0.0),
        _ => (i, t),
    }
}
