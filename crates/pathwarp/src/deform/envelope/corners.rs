//! Where a closed path's four corners are, and which of its sides is the bottom.

use crate::anchors;
use crate::error::{Error, show};
use crate::outline::{Seg, Subpath};
use crate::param::{NamedPath, Settings};
use kurbo::{Point, Rect, Vec2};

/// A joint that turns by this much (degrees) is a corner to the eye.
const CORNER: f64 = 20.0;
/// A place this near to a corner by angle, as a share of the box, means that corner.
const SNAP: f64 = 0.15;
/// Pieces of a path at most: every joint is a crease of the map.
const MOST_PIECES: usize = 2000;
/// Samples of a piece.
const SAMPLES: u32 = 64;

/// Four sides of a closed path in the order in which the map uses them.
pub(in crate::deform) struct Ring {
    /// Bottom (left to right), right (upwards), top (right to left), left (downwards).
    pub(in crate::deform) sides: [Vec<Seg>; 4],
    pub(in crate::deform) notes: Vec<String>,
}

/// A place on the path: piece and parameter.
type Place = (usize, f64);

/// Reads a closed path: corners given or found, the bottom chosen, nothing mirrored.
pub(super) fn ring(path: &NamedPath, s: &Settings<'_>) -> Result<Ring, Error> {
    let sub = anchors::closed_subpath(path, "a single closed run of them", |lines| lines >= 2)?;
    if sub.segs.len() > MOST_PIECES {
        let problem = format!("has {} pieces; {MOST_PIECES} are the most: simplify it", sub.segs.len());
        return Err(Error::usage("envelope", path.name.clone(), problem));
    }
    let bounds = sub.segs.iter().map(Seg::bounding_box).reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO);
    if !(bounds.width() > 0.0 && bounds.height() > 0.0) {
        return Err(Error::usage("envelope", path.name.clone(), "is flat: it encloses nothing"));
    }
    let (places, how) = match s.texts("corners").first() {
        Some(text) => (given(&sub, text, s, bounds)?, "as given"),
        None => found(&path.name, &sub, bounds)?,
    };
    let drawn = cut(&sub.segs, places);
    let area: f64 = drawn.iter().flatten().map(area).sum();
    // On the screen, y down, bottom → right → top → left runs against the clock.
    let backwards = area > 0.0;
    let order = if backwards { [3, 2, 1, 0] } else { [0, 1, 2, 3] };
    let run = |i: usize| -> Vec<Seg> {
        if backwards { drawn[i].iter().rev().map(Seg::reversed).collect() } else { drawn[i].clone() }
    };
    let sides = order.map(run);
    let bottom = match s.number_if("bottom-side")? {
        Some(n) => order.iter().position(|i| *i + 1 == n as usize).unwrap_or(0),
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
            "bottom side: side {} as drawn, run {}, so that nothing is mirrored; `bottom-side` and `reverse` overrule that",
            order[bottom] + 1,
            if backwards { "backwards" } else { "forwards" }
        ),
    ];
    if s.flag("reverse")? {
        sides = mirrored(sides);
        notes.push("reverse: the bottom side is run the other way, the result is mirrored".into());
    }
    Ok(Ring { sides, notes })
}

/// The ring run the other way round from the bottom's end: left and right change places.
pub(super) fn mirrored([bottom, right, top, left]: [Vec<Seg>; 4]) -> [Vec<Seg>; 4] {
    let back = |s: Vec<Seg>| s.iter().rev().map(Seg::reversed).collect();
    [back(bottom), back(left), back(top), back(right)]
}

/// The lowest side on the screen among those that run to the right.
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
    // Of equals the first; a hair's difference is rounding.
    let mut best: Option<(usize, f64)> = None;
    for (i, side) in sides.iter().enumerate().filter(|(_, s)| to_the_right(s)) {
        let here = height(side);
        if best.is_none_or(|(_, b)| here > b + 1e-9 * (here.abs() + b.abs())) {
            best = Some((i, here));
        }
    }
    best.map_or(0, |b| b.0)
}

/// Twice the area between a piece and the origin.
pub(super) fn area(s: &Seg) -> f64 {
    let at = |i: u32| s.eval(f64::from(i) / f64::from(SAMPLES)).to_vec2();
    (0..SAMPLES).map(|i| at(i).cross(at(i + 1))).sum()
}

/// The path's pieces from corner to corner.
fn cut(segs: &[Seg], places: [Place; 4]) -> [Vec<Seg>; 4] {
    let part = |s: &Seg, a: f64, b: f64| match s {
        _ if a == 0.0 && b == 1.0 => *s,
        Seg::Arc(arc) => Seg::Arc(arc.subsegment(a, b)),
        other => other.part(a, b).unwrap_or(*other),
    };
    std::array::from_fn(|i| {
        let ((from, a), (to, b)) = (places[i], places[(i + 1) % 4]);
        let mut out = Vec::new();
        let (mut at, mut start) = (from, a);
        // Once round at most.
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
        // Parts end where the next begins but for rounding.
        let next = segs[to].eval(b);
        if let Some(last) = out.last_mut() {
            *last = anchors::ending_at(last, next);
        }
        out
    })
}

/// Corners as the user gave them: four numbers of nodes, or four places on the path.
fn given(sub: &Subpath, text: &str, s: &Settings<'_>, bounds: Rect) -> Result<[Place; 4], Error> {
    let words: Vec<&str> = text.split([',', ' ', ';']).filter(|w| !w.is_empty()).collect();
    let numbers: Option<Vec<usize>> = words.iter().map(|w| w.parse().ok()).collect();
    let places: Vec<Place> = match numbers {
        Some(n) if n.len() == 4 => {
            let most = sub.segs.len();
            if let Some(bad) = n.iter().find(|n| !(1..=most).contains(n)) {
                return Err(Error::usage(
                    "corners",
                    text,
                    format!("node {bad} is not there: the path has nodes 1 to {most}"),
                ));
            }
            n.iter().map(|n| (n - 1, 0.0)).collect()
        }
        _ => {
            let points = s.points_in("corners", text)?;
            points.iter().map(|p| nearest(sub, *p, Vec2::new(1.0, 1.0), bounds)).collect()
        }
    };
    let Ok(mut places) = <[Place; 4]>::try_from(places) else {
        return Err(Error::usage("corners", text, "is neither four numbers of nodes (1,4,7,9) nor four points x,y"));
    };
    places.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    if places.windows(2).any(|w| w[0] == w[1]) {
        return Err(Error::usage("corners", text, "names one place of the path twice; four different ones are needed"));
    }
    Ok(places)
}

/// A path's only four nodes, or four corners by angle, if each lies in another quarter of the path's box or they span at least as much as the next choice:
/// the places nearest to the box's corners.
fn found(name: &str, sub: &Subpath, bounds: Rect) -> Result<([Place; 4], &'static str), Error> {
    let n = sub.segs.len();
    let sharp: Vec<usize> = (0..n).filter(|&i| turn(&sub.segs[(i + n - 1) % n], &sub.segs[i]) >= CORNER).collect();
    let four = <[usize; 4]>::try_from(sharp.clone()).ok().map(|c| c.map(|i| (i, 0.0)));
    let boxed = by_box(sub, bounds, &sharp);
    let span = |places: &[Place; 4]| {
        let p = places.map(|(i, t)| sub.segs[i].eval(t));
        (p[2] - p[0]).cross(p[3] - p[1]).abs()
    };
    let quartered = |places: &[Place; 4]| {
        let mut seen: Vec<_> = places.iter().filter_map(|p| quarter(sub.segs[p.0].eval(p.1), bounds)).collect();
        seen.sort_unstable();
        seen.dedup();
        seen.len() == 4
    };
    // Somebody who draws four nodes means them, unless they are those of a circle.
    let nodes = [0, 1, 2, 3].map(|i| (i, 0.0));
    if n == 4 && quartered(&nodes) {
        return Ok((nodes, "its four nodes"));
    }
    match (four, boxed) {
        (Some(four), None) => Ok((four, "found by angle")),
        (Some(four), Some(boxed)) if quartered(&four) || span(&four) >= span(&boxed) => Ok((four, "found by angle")),
        (_, Some(boxed)) => Ok((boxed, "the places nearest to the corners of its box")),
        (None, None) => {
            let problem = format!(
                "has {} corners by angle, and none can be told from its box: say where they are with `corners` (four node numbers, or four points)",
                sharp.len()
            );
            Err(Error::usage("envelope", name, problem))
        }
    }
}

/// Which quarter of the box a place lies in; `None` if it is too near to the box's middle lines to tell.
fn quarter(p: Point, bounds: Rect) -> Option<(bool, bool)> {
    /// Share of the box.
    const MIDDLE: f64 = 0.05;
    let (x, y) = ((p.x - bounds.x0) / bounds.width() - 0.5, (p.y - bounds.y0) / bounds.height() - 0.5);
    (x.abs() > MIDDLE && y.abs() > MIDDLE).then_some((x > 0.0, y > 0.0))
}

/// The places nearest to the corners of the path's box, or corners by angle near them; `None` if they are not four in turn.
fn by_box(sub: &Subpath, bounds: Rect, sharp: &[usize]) -> Option<[Place; 4]> {
    // In shares of the box, so that an ellipse is treated as the circle it comes from.
    let share = |v: Vec2| Vec2::new(v.x / bounds.width(), v.y / bounds.height());
    let box_corners = [(bounds.x0, bounds.y1), (bounds.x1, bounds.y1), (bounds.x1, bounds.y0), (bounds.x0, bounds.y0)];
    let places = box_corners.map(Point::from).map(|c| {
        let place = nearest(sub, c, Vec2::new(1.0 / bounds.width(), 1.0 / bounds.height()), bounds);
        let here = sub.segs[place.0].eval(place.1);
        let off = |i: &usize| share(sub.segs[*i].start() - here).hypot();
        let corner = sharp.iter().min_by(|a, b| off(a).total_cmp(&off(b))).filter(|i| off(i) <= SNAP);
        corner.map_or(place, |i| (*i, 0.0))
    });
    let mut sorted = places;
    sorted.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    // The box's corners in turn must be the path's in turn, one way or the other.
    let at = |p: &Place| sorted.iter().position(|q| q == p).unwrap_or(0);
    let [a, b, c, d] = places.each_ref().map(at);
    let apart =
        |p: &[Place]| sub.segs[p[0].0].eval(p[0].1).distance(sub.segs[p[1].0].eval(p[1].1)) > 1e-9 * bounds.width();
    let in_turn = [(a, b), (b, c), (c, d), (d, a)];
    let round = |step: usize| in_turn.iter().all(|(x, y)| (x + step) % 4 == *y);
    (sorted.windows(2).all(apart) && (round(1) || round(3))).then_some(sorted)
}

/// How far the path turns from one piece to the next, degrees.
fn turn(a: &Seg, b: &Seg) -> f64 {
    /// Where a piece stands still its direction is taken a little further in.
    const ASIDE: f64 = 1e-4;
    let direction = |s: &Seg, t: f64, aside: f64| {
        let v = s.deriv(t);
        let size = s.bounding_box();
        if v.hypot() <= 1e-9 * (size.width() + size.height()) { s.deriv(aside) } else { v }
    };
    let (v, w) = (direction(a, 1.0, 1.0 - ASIDE), direction(b, 0.0, ASIDE));
    v.cross(w).atan2(v.dot(w)).to_degrees().abs()
}

/// The place nearest to `c`, both axes scaled: the best sample, refined where the distance's slope vanishes; ends of pieces are
/// nodes.
fn nearest(sub: &Subpath, c: Point, scale: Vec2, bounds: Rect) -> Place {
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
    // Halving 60 times leaves nothing of a unit interval.
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
