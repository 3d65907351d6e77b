//! The map that suits the shape and the artwork: the patch of four sides, columns or rows.

use super::columns::Columns;
use super::corners;
use super::fit::{Keep, Spread, fit, to_unit};
use super::ring::{Ring, area, shown};
use crate::deform::built::{Built, Role};
use crate::error::{Error, show};
use crate::map::{AffineMap, Coons, Jet, Map, Pace, Side, Sides};
use crate::outline::Subpath;
use kurbo::{Affine, Point, Rect, Vec2};
use std::sync::Arc;

/// Columns that hold at least this part of a shape's area fill it.
const FILLS: f64 = 0.8;
/// Samples along an axis of the box, where the artwork is not known.
const GRID: u32 = 24;

/// The room that artwork leaves in a shape.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::deform) struct Room {
    /// The share of the greatest height at which it ends, in columns.
    pub(super) ends: Option<f64>,
    /// Its distance from the outline.
    pub(super) padding: f64,
}

/// What a map is chosen by.
pub(super) struct Choice<'a> {
    pub(super) frame: Rect,
    pub(super) keep: Keep,
    pub(super) spread: Option<Spread>,
    pub(super) room: Room,
    pub(super) lettering: bool,
    /// Points of the artwork; empty if they are not known.
    pub(super) ink: &'a [Point],
}

impl Choice<'_> {
    /// Builds the map. `closed` is the shape if it is not divided by the user, `ring` its division.
    pub(super) fn build(&self, closed: Option<Subpath>, ring: Result<Ring, Error>) -> Result<Built, Error> {
        // Curves that meet enclose a shape.
        let closed = closed.or_else(|| ring.as_ref().ok().filter(|r| r.meets()).map(Ring::closed));
        match (self.keep, closed) {
            (Keep::Verticals | Keep::Horizontals, Some(shape)) => {
                filled(self.frame, &shape, self.keep == Keep::Verticals, &self.room)
            }
            (Keep::Auto, Some(shape)) => self.suited(&shape, ring),
            (keep, _) => self.patched(&ring?, keep),
        }
    }

    /// Builds the patch of four sides.
    fn patched(&self, ring: &Ring, keep: Keep) -> Result<Built, Error> {
        let keep = if keep == Keep::Auto { Keep::Nothing } else { keep };
        fit(padded(self.frame, ring, self.room.padding)?, ring, keep, self.spread)
    }

    /// Builds what suits the shape and the artwork.
    fn suited(&self, shape: &Subpath, ring: Result<Ring, Error>) -> Result<Built, Error> {
        let patch = ring.and_then(|ring| Ok((honest(shape, &ring), self.patched(&ring, Keep::Nothing)?)));
        if let Ok((true, built)) = patch {
            return Ok(built);
        }
        let columns = |upright| filled(self.frame, shape, upright, &self.room).map(|b| (b, 0.0));
        let fills = |upright: bool| Columns::new(shape, upright, 0.0, 0.0).map_or(0.0, |c| c.coverage);
        if self.lettering {
            let upright = fills(true) >= FILLS.min(fills(false));
            return columns(upright).map(|c| c.0).or_else(|e| patch.map(|p| p.1).map_err(|_| e));
        }
        let scored = |b: Built| {
            let d = self.distortion(&*b.map, corners::bounds(shape));
            (b, d)
        };
        let mut all: Vec<(Built, f64)> = Vec::new();
        all.extend(patch.map(|p| scored(p.1)).ok());
        for upright in [true, false].into_iter().filter(|u| fills(*u) >= FILLS) {
            all.extend(columns(upright).map(|c| scored(c.0)).ok());
        }
        let least = all.into_iter().reduce(|a, b| if b.1 < a.1 { b } else { a });
        least.map(|b| b.0).ok_or_else(|| nothing(shape))
    }

    /// Returns the mean over the artwork of how far it is stretched and squeezed beside what the shape's box does to it: the squares of
    /// the logarithms of both stretches.
    fn distortion(&self, map: &dyn Map, shape: Rect) -> f64 {
        let f = self.frame;
        let grid: Vec<Point> = grid(GRID).map(|p| f.origin() + Vec2::new(p.x * f.width(), p.y * f.height())).collect();
        let points = if self.ink.is_empty() { &grid } else { self.ink };
        points.iter().map(|p| stretched(&map.jet(*p), f, shape)).sum::<f64>() / points.len() as f64
    }
}

/// Returns places of the unit square.
pub(super) fn grid(n: u32) -> impl Iterator<Item = Point> {
    let at = move |i: u32| (f64::from(i) + 0.5) / f64::from(n);
    (0..n * n).map(move |k| Point::new(at(k % n), at(k / n)))
}

/// Returns how far a map stretches and squeezes beside what the boxes ask for: the squares of the logarithms of both stretches.
pub(super) fn stretched(jet: &Jet, frame: Rect, shape: Rect) -> f64 {
    /// For a place that is folded over or squeezed to nothing.
    const MOST: f64 = 20.0;
    let [a, b] = stretches(jet, frame, shape);
    let d = a.ln().powi(2) + b.ln().powi(2);
    if a > 0.0 && b > 0.0 && d < MOST { d } else { MOST }
}

/// Returns the largest and the smallest stretch of a map at a point, in shares of both boxes; the smallest is negative where it mirrors.
fn stretches(jet: &Jet, frame: Rect, shape: Rect) -> [f64; 2] {
    let share = |v: Vec2, size: f64| Vec2::new(v.x * size / shape.width(), v.y * size / shape.height());
    let (dx, dy) = (share(jet.dx, frame.width()), share(jet.dy, frame.height()));
    // Singular values by the sums of the conformal and the anticonformal part.
    let (c, a) = ((dx.x + dy.y).hypot(dx.y - dy.x), (dx.x - dy.y).hypot(dx.y + dy.x));
    [0.5 * (c + a), 0.5 * (c - a)]
}

/// Returns `true` if a shape has four corners of its own: no other sharp node points outwards, its bottom runs to the right and its
/// sides upwards, and nothing folds or is stretched much more one way than the other.
fn honest(shape: &Subpath, ring: &Ring) -> bool {
    /// The largest angle of the bottom and of the sides with the screen's axes, as a tangent.
    const TURNED: f64 = 0.9;
    /// The largest ratio of both stretches, beside that of the boxes.
    const UNEVEN: f64 = 6.0;
    let around: f64 = shape.segs.iter().map(area).sum();
    let pointed: Vec<Point> = corners::sharp(shape, around.signum()).map(|i| shape.segs[i].start()).collect();
    let size = corners::bounds(shape).size().max_side();
    let is_corner =
        |p: &Point| ring.sides.iter().flat_map(|s| s.first()).any(|s| s.start().distance(*p) <= 1e-9 * size);
    if pointed.len() != 4 || !pointed.iter().all(is_corner) {
        return false;
    }
    let side = |k: usize, back: bool| {
        let s = &ring.sides[k];
        Side::new(&if back { super::ring::reversed(s) } else { s.clone() }, Pace::Length)
    };
    let (Some(bottom), Some(right), Some(top), Some(left)) =
        (side(0, false), side(1, false), side(2, true), side(3, true))
    else {
        return false;
    };
    let map = Coons::new(Sides { bottom, right, top, left }, Affine::IDENTITY);
    let jets: Vec<Jet> = grid(GRID).map(|p| map.jet(p)).collect();
    let [right, up] = [jets.iter().map(|j| j.dx).sum::<Vec2>(), jets.iter().map(|j| j.dy).sum::<Vec2>()];
    let level = right.y.abs() <= TURNED * right.x && up.x.abs() <= -TURNED * up.y;
    let (unit, bounds) = (Rect::new(0.0, 0.0, 1.0, 1.0), corners::bounds(shape));
    let even = |j: &Jet| {
        let [a, b] = stretches(&Jet { dy: -j.dy, ..*j }, unit, bounds);
        b > 0.0 && a <= UNEVEN * b
    };
    level && jets.iter().all(even)
}

/// Returns a box wider than `frame`, whose map into the sides keeps the frame `padding` off them.
fn padded(frame: Rect, ring: &Ring, padding: f64) -> Result<Rect, Error> {
    if padding == 0.0 {
        return Ok(frame);
    }
    let length = |k: usize| Side::new(&ring.sides[k], Pace::Length).map_or(0.0, |s| s.length());
    let share = |a: usize, b: usize| padding / length(a).min(length(b));
    let (x, y) = (share(0, 2), share(1, 3));
    if !(x < 0.5 && y < 0.5) {
        return Err(Error::usage("padding", padding.to_string(), "leaves nothing of the shape"));
    }
    Ok(frame.inflate(frame.width() * x / (1.0 - 2.0 * x), frame.height() * y / (1.0 - 2.0 * y)))
}

fn nothing(shape: &Subpath) -> Error {
    let b = corners::bounds(shape);
    let problem = format!(
        "leaves no room: the shape is {:.6} × {:.6}; take less `padding` or smaller `ends`",
        b.width(),
        b.height()
    );
    Error::usage("envelope", "the shape", problem)
}

/// Builds the map of a box into the columns (or the rows) of a closed path.
pub(super) fn filled(frame: Rect, shape: &Subpath, upright: bool, room: &Room) -> Result<Built, Error> {
    let ends = room.ends.unwrap_or(0.0);
    let c = Columns::new(shape, upright, room.padding, ends).ok_or_else(|| nothing(shape))?;
    let pace = if upright { Pace::Width } else { Pace::Height };
    let [a, b] = c.curves.each_ref().map(|s| Side::new(s, pace));
    let (Some(a), Some(b)) = (a, b) else { return Err(nothing(shape)) };
    let ([a0, a1], [b0, b1]) = (a.ends(), b.ends());
    let (first, last) = (Side::straight(a0, b0), Side::straight(a1, b1));
    let [from, to] = c.range;
    let unit = to_unit(frame);
    let (pre, sides) = if upright {
        let pre = Affine::new([to - from, 0.0, 0.0, 1.0, from, 0.0]);
        (pre * unit, Sides { bottom: a, top: b, left: first, right: last })
    } else {
        let pre = Affine::new([1.0, 0.0, 0.0, to - from, 0.0, from]);
        (pre * unit, Sides { left: a, right: b, bottom: first, top: last })
    };
    let mut built = Built::new(Arc::new(AffineMap::IDENTITY));
    let (what, lines) = if upright { ("columns", "verticals") } else { ("rows", "horizontals") };
    let (length, place) = if upright { ("height", "x") } else { ("width", "y") };
    let corner = |p: Point| if upright { p.x } else { p.y };
    let at = |s: f64| corner(a0) + s * (corner(a1) - corner(a0));
    built.note(format!(
        "filled in {what}, {lines} kept: from {place} = {:.6} to {:.6}, where the shape is still {:.0} % of its greatest {length}",
        at(from),
        at(to),
        100.0 * ends
    ));
    if room.padding == 0.0 && c.coverage < 1.0 - 1e-3 {
        built.note(format!(
            "the {what} hold {:.0} % of the shape: elsewhere such lines would leave it",
            100.0 * c.coverage
        ));
    }
    if !c.jumps.is_empty() {
        let places: Vec<String> = c.jumps.iter().map(|p| show(*p)).collect();
        built.warn(format!(
            "envelope: the outline jumps at {}: the {what} take slopes there; `--keep nothing` bends the artwork round instead",
            places.join(" and ")
        ));
    }
    built.overlay(Role::Cage, shown(shape));
    built.map = Coons::new(sides, pre).simplest();
    Ok(built)
}
