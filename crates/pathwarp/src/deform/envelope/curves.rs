//! Sides drawn one by one: two facing curves, or three, or four, or one with a height.

use super::ring::{Ring, SIDES, area, mirrored, reversed};
use crate::anchors;
use crate::error::{Error, show};
use crate::outline::Seg;
use crate::param::NamedPath;
use kurbo::{Affine, CubicBez, Line, Point, Vec2};

/// Ends this close, as a share of the whole, meet.
const MEET: f64 = 1e-4;

/// The curves of an envelope, and how to complete them.
pub(super) struct Curves<'a> {
    /// Bottom, right, top, left.
    pub(super) drawn: &'a [Option<NamedPath>; 4],
    /// Distance of the facing side, if one curve is drawn.
    pub(super) height: Option<f64>,
    /// The default for that.
    pub(super) frame_height: f64,
    /// Joins two curves at right angles.
    pub(super) square: bool,
    pub(super) reverse: bool,
}

/// Two facing curves, run the same way, and those drawn between them.
struct Facing {
    /// Bottom and top, rather than left and right.
    lying: bool,
    first: Vec<Seg>,
    second: Vec<Seg>,
    /// From the first curve to the second, at their starts and at their ends.
    between: [Option<Vec<Seg>>; 2],
}

impl Curves<'_> {
    /// Returns the four sides.
    pub(super) fn ring(&self) -> Result<Ring, Error> {
        let mut notes = Vec::new();
        let facing = self.facing(&mut notes)?;
        let Facing { lying, first, second, between } = &facing;
        let [a, b, c, d] = [start(first), end(first), start(second), end(second)];
        let size = [b, c, d].iter().map(|p| p.distance(a)).fold(0.0, f64::max);
        let names = if *lying { ["left", "right"] } else { ["bottom", "top"] };
        let join = |k: usize, from: Point, to: Point| match &between[k] {
            Some(c) => joined(names[k], c.clone(), from, to, size),
            None if self.square => {
                let along =
                    if k == 0 { [leaving(first), leaving(second)] } else { [arriving(first), arriving(second)] };
                Ok(vec![at_right_angles(from, to, along)])
            }
            None => Ok(vec![Seg::Line(Line::new(from, to))]),
        };
        let (at_start, at_end) = (join(0, a, c)?, join(1, b, d)?);
        let Facing { lying, first, second, .. } = facing;
        let warnings = self.exchanged(lying, &first, &second).into_iter().collect();
        let mut sides = if lying {
            [first, at_end, reversed(&second), reversed(&at_start)]
        } else {
            [at_start, second, reversed(&at_end), reversed(&first)]
        };
        let area: f64 = sides.iter().flatten().map(area).sum();
        if area > 0.0 {
            // Half a turn of the parameters: bottom stays bottom.
            sides = mirrored(sides);
            notes.push("the curves run right to left: the other way they would mirror".into());
        }
        if self.reverse {
            sides = mirrored(sides);
            notes.push("reverse: the curves run the other way, so that the result is mirrored".into());
        }
        let corners = sides.each_ref().map(|s| show(start(s))).join(" ");
        notes.insert(0, format!("corners: {corners} (bottom left, bottom right, top right, top left)"));
        Ok(Ring { sides, notes, warnings })
    }

    /// Warns if each of two facing curves is where the other should be.
    fn exchanged(&self, lying: bool, first: &[Seg], second: &[Seg]) -> Option<String> {
        let middle = |c: &[Seg]| {
            let sum = c.iter().map(|s| s.start().to_vec2() + s.end().to_vec2()).fold(Vec2::ZERO, |a, b| a + b);
            sum / (2.0 * c.len().max(1) as f64)
        };
        let (a, b) = (middle(first), middle(second));
        let (wrong, what) = if lying {
            (
                b.y > a.y,
                "the top curve lies below the bottom curve, so that the artwork is upside down; exchange `bottom` and `top`",
            )
        } else {
            (
                b.x < a.x,
                "the right curve lies left of the left curve, so that the artwork is turned over; exchange `left` and `right`",
            )
        };
        (wrong && !self.reverse).then(|| format!("envelope: {what}"))
    }

    /// Returns the pair of curves drawn on both sides, the second a copy of the first if it is drawn alone.
    fn facing(&self, notes: &mut Vec<String>) -> Result<Facing, Error> {
        let [bottom, right, top, left] = [0, 1, 2, 3].map(|k| self.curve(k));
        let (mut bottom, right, mut top, left) = (bottom?, right?, top?, left?);
        let given = [&bottom, &right, &top, &left].iter().filter(|c| c.is_some()).count();
        if given == 1 {
            let height = self.height.unwrap_or(self.frame_height);
            let moved =
                |c: &[Seg], y: f64| c.iter().map(|s| s.transformed(Affine::translate((0.0, y)))).collect::<Vec<_>>();
            match (&bottom, &top) {
                (Some(b), None) => top = Some(moved(b, -height)),
                (None, Some(t)) => bottom = Some(moved(t, height)),
                _ => return Err(facing(if left.is_some() { "right" } else { "left" })),
            }
            notes.push(format!("the facing side: the same curve, {height:.6} away"));
        } else if let Some(height) = self.height {
            let problem = "goes with `bottom` or `top` alone: here the facing side is drawn";
            return Err(Error::usage("height", height.to_string(), problem));
        }
        // The corners are the ends of the pair that is drawn on both sides.
        match (bottom, top, left, right) {
            (Some(mut a), Some(mut b), left, right) => {
                run(&mut a, &mut b, |v| v.x);
                Ok(Facing { lying: true, first: a, second: b, between: [left, right] })
            }
            (bottom, top, Some(mut a), Some(mut b)) => {
                run(&mut a, &mut b, |v| -v.y);
                Ok(Facing { lying: false, first: a, second: b, between: [bottom, top] })
            }
            (Some(_), ..) => Err(facing("top")),
            _ => Err(facing("bottom")),
        }
    }

    /// Returns one connected open curve.
    fn curve(&self, k: usize) -> Result<Option<Vec<Seg>>, Error> {
        let Some(path) = &self.drawn[k] else { return Ok(None) };
        let sub = anchors::only_subpath(path, "a single connected run of them")?;
        let problem = match (sub.closed, sub.segs.is_empty()) {
            (true, _) => "is closed: a side is an open curve; for a closed path use `envelope`",
            (_, true) => "is a single point",
            _ => return Ok(Some(sub.segs)),
        };
        Err(Error::usage(SIDES[k], path.name.clone(), problem))
    }
}

fn facing(name: &str) -> Error {
    Error::missing(name, "the curve that faces the given one (or `bottom` or `top` alone, with `height`)")
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

/// Orients both curves so that `along` grows from start to end.
fn run(a: &mut Vec<Seg>, b: &mut Vec<Seg>, along: impl Fn(Vec2) -> f64) {
    for c in [a, b] {
        if along(end(c) - start(c)) < 0.0 {
            *c = reversed(c);
        }
    }
}

/// Orients a drawn side between two corners, and snaps its ends onto them.
fn joined(name: &str, c: Vec<Seg>, from: Point, to: Point, size: f64) -> Result<Vec<Seg>, Error> {
    let back = reversed(&c);
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

/// Returns the cubic that leaves one curve and reaches the other at right angles.
fn at_right_angles(from: Point, to: Point, [a, b]: [Vec2; 2]) -> Seg {
    let way = to - from;
    let handle = |along: Vec2| {
        let n = along.turn_90();
        let n = if n.dot(way) < 0.0 { -n } else { n };
        if n.hypot() > 0.0 { n * (way.hypot() / (3.0 * n.hypot())) } else { way / 3.0 }
    };
    Seg::Cubic(CubicBez::new(from, from + handle(a), to - handle(b), to))
}
