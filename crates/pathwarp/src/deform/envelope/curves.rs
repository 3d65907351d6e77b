//! Sides drawn one by one: two facing curves, or three, or four, or one with a height.

use super::corners::{Ring, mirrored};
use crate::anchors;
use crate::error::{Error, show};
use crate::outline::Seg;
use crate::param::{Axis, Settings};
use kurbo::{Affine, CubicBez, Line, Point, Vec2};

/// Ends this near, as a share of the whole, meet.
const MEET: f64 = 1e-4;

/// Reads the curves that are given; `None` if there are none.
pub(super) fn ring(s: &Settings<'_>) -> Result<Option<Ring>, Error> {
    let mut notes = Vec::new();
    let [bottom, right, top, left] = ["bottom", "right", "top", "left"].map(|n| curve(s, n));
    let (mut bottom, mut right, mut top, mut left) = (bottom?, right?, top?, left?);
    let given = [&bottom, &right, &top, &left].iter().filter(|c| c.is_some()).count();
    if given == 0 {
        return Ok(None);
    }
    if given == 1 {
        let height = match s.number_if("height")? {
            Some(h) => h,
            None => s.frame().extent(Axis::Y),
        };
        let moved =
            |c: &[Seg], y: f64| c.iter().map(|s| s.transformed(Affine::translate((0.0, y)))).collect::<Vec<_>>();
        match (&bottom, &top) {
            (Some(b), None) => top = Some(moved(b, -height)),
            (None, Some(t)) => bottom = Some(moved(t, height)),
            _ => return Err(facing(if left.is_some() { "right" } else { "left" })),
        }
        notes.push(format!("the facing side: the same curve, {height:.6} away"));
    } else if s.given("height") {
        let text = s.texts("height").join(" ");
        return Err(Error::usage("height", text, "goes with `bottom` or `top` alone: here the facing side is drawn"));
    }

    // Which pair is drawn on both sides: its ends are the corners.
    let lying = match (&mut bottom, &mut top, &mut left, &mut right) {
        (Some(a), Some(b), ..) => {
            run(a, b, |v| v.x);
            true
        }
        (.., Some(a), Some(b)) => {
            run(a, b, |v| -v.y);
            false
        }
        (Some(_), ..) => return Err(facing("top")),
        _ => return Err(facing("bottom")),
    };
    let (first, second) = if lying { (&bottom, &top) } else { (&left, &right) };
    let (Some(first), Some(second)) = (first.clone(), second.clone()) else { return Err(facing("top")) };
    let [a, b, c, d] = [start(&first), end(&first), start(&second), end(&second)];
    let size = [b, c, d].iter().map(|p| p.distance(a)).fold(0.0, f64::max);
    let (names, between) = if lying {
        (["left", "right"], [(left, a, c), (right, b, d)])
    } else {
        (["bottom", "top"], [(bottom, a, c), (top, b, d)])
    };
    let square = s.choice("sides")? == "square";
    let mut crossing = Vec::new();
    for (k, (name, (drawn, from, to))) in names.into_iter().zip(between).enumerate() {
        crossing.push(match drawn {
            Some(c) => joined(name, c, from, to, size)?,
            None if square => {
                let along =
                    if k == 0 { [leaving(&first), leaving(&second)] } else { [arriving(&first), arriving(&second)] };
                vec![at_right_angles(from, to, along)]
            }
            None => vec![Seg::Line(Line::new(from, to))],
        });
    }
    let back = |c: &[Seg]| c.iter().rev().map(Seg::reversed).collect::<Vec<_>>();
    let (Some(x), Some(y)) = (crossing.pop(), crossing.pop()) else { return Err(facing("top")) };
    // (y, x) are the pair between: left and right, or bottom and top.
    let mut sides = if lying { [first, x, back(&second), back(&y)] } else { [y, second, back(&x), back(&first)] };
    let area: f64 = sides.iter().flatten().map(super::corners::area).sum();
    let mirrors = area > 0.0;
    if mirrors {
        // Turned by half a turn of the parameters: bottom stays bottom.
        sides = mirrored(sides);
        notes.push("the curves are run right to left: the other way they would mirror".into());
    }
    if s.flag("reverse")? {
        sides = mirrored(sides);
        notes.push("reverse: the curves are run the other way, the result is mirrored".into());
    }
    let corners = sides.each_ref().map(|s| show(start(s))).join(" ");
    notes.insert(0, format!("corners: {corners} (bottom left, bottom right, top right, top left)"));
    Ok(Some(Ring { sides, notes }))
}

fn facing(name: &str) -> Error {
    Error::Missing {
        param: name.to_owned(),
        hint: "the curve that faces the given one (or `bottom` or `top` alone, with `height`)".into(),
    }
}

/// One connected open curve.
fn curve(s: &Settings<'_>, name: &str) -> Result<Option<Vec<Seg>>, Error> {
    let Some(path) = s.path_if(name)? else { return Ok(None) };
    let sub = anchors::only_subpath(&path, "a single connected run of them")?;
    if sub.closed {
        return Err(Error::usage(
            name,
            path.name,
            "is closed: a side is an open curve; for a closed path use `envelope`",
        ));
    }
    if sub.segs.is_empty() {
        return Err(Error::usage(name, path.name, "is a single point"));
    }
    Ok(Some(sub.segs))
}

fn start(c: &[Seg]) -> Point {
    c.first().map_or(Point::ORIGIN, Seg::start)
}

fn end(c: &[Seg]) -> Point {
    c.last().map_or(Point::ORIGIN, Seg::end)
}

fn leaving(c: &[Seg]) -> Vec2 {
    c.first().map_or(Vec2::ZERO, |s| s.deriv(0.0))
}

fn arriving(c: &[Seg]) -> Vec2 {
    c.last().map_or(Vec2::ZERO, |s| s.deriv(1.0))
}

/// Turns both curves so that they run along `way`.
fn run(a: &mut Vec<Seg>, b: &mut Vec<Seg>, way: impl Fn(Vec2) -> f64) {
    for c in [a, b] {
        if way(end(c) - start(c)) < 0.0 {
            *c = c.iter().rev().map(Seg::reversed).collect();
        }
    }
}

/// A drawn side between two corners, turned to run from the first, its ends moved onto them by what is rounding.
fn joined(name: &str, c: Vec<Seg>, from: Point, to: Point, size: f64) -> Result<Vec<Seg>, Error> {
    let back: Vec<Seg> = c.iter().rev().map(Seg::reversed).collect();
    let off = |c: &[Seg]| start(c).distance(from).max(end(c).distance(to));
    let mut c = if off(&back) < off(&c) { back } else { c };
    let gap = off(&c);
    if gap > MEET * size {
        let problem = format!(
            "does not meet its neighbours: it runs from {} to {}, their corners are {} and {}, {gap:.6} away",
            show(start(&c)),
            show(end(&c)),
            show(from),
            show(to)
        );
        return Err(Error::usage(name, "the curve", problem));
    }
    if let Some(last) = c.last_mut() {
        *last = anchors::ending_at(last, to);
    }
    if let Some(first) = c.first_mut() {
        *first = anchors::ending_at(&first.reversed(), from).reversed();
    }
    Ok(c)
}

/// The cubic that leaves one curve and reaches the other at right angles.
fn at_right_angles(from: Point, to: Point, [a, b]: [Vec2; 2]) -> Seg {
    let way = to - from;
    let handle = |along: Vec2| {
        let n = along.turn_90();
        let n = if n.dot(way) < 0.0 { -n } else { n };
        if n.hypot() > 0.0 { n * (way.hypot() / (3.0 * n.hypot())) } else { way / 3.0 }
    };
    Seg::Cubic(CubicBez::new(from, from + handle(a), to - handle(b), to))
}
