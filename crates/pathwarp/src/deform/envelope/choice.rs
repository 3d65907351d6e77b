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
    /// It leaves out thin parts beyond jumps at the ends, as lettering does.
    pub(super) core: bool,
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
        if self.lettering {
            let columns = filled(self.frame, shape, true, &Room { core: true, ..self.room });
            return columns.or_else(|e| patch.map(|p| p.1).map_err(|_| e));
        }
        let fills = |upright: bool| Columns::new(shape, upright, &Room::default()).map_or(0.0, |c| c.coverage);
        let scored = |b: Built| {
            let d = self.distortion(&*b.map);
            (b, d)
        };
        let mut all: Vec<(Built, f64)> = Vec::new();
        all.extend(patch.map(|p| scored(p.1)).ok());
        for upright in [true, false].into_iter().filter(|u| fills(*u) >= FILLS) {
            all.extend(filled(self.frame, shape, upright, &self.room).map(scored).ok());
        }
        let least = all.into_iter().reduce(|a, b| if b.1 < a.1 { b } else { a });
        least.map(|b| b.0).ok_or_else(|| nothing(shape))
    }

    /// Returns the distortion of the artwork.
    fn distortion(&self, map: &dyn Map) -> f64 {
        let f = self.frame;
        let grid: Vec<Point> = grid(GRID).map(|p| f.origin() + Vec2::new(p.x * f.width(), p.y * f.height())).collect();
        let points = if self.ink.is_empty() { &grid } else { self.ink };
        distortion(&points.iter().map(|p| map.jet(*p)).collect::<Vec<_>>())
    }
}

/// Returns places of the unit square.
pub(super) fn grid(n: u32) -> impl Iterator<Item = Point> {
    let at = move |i: u32| (f64::from(i) + 0.5) / f64::from(n);
    (0..n * n).map(move |k| Point::new(at(k % n), at(k / n)))
}

/// Returns the mean of how far a map stretches and squeezes, beside its mean stretches to the right and upwards: the squares of the
/// logarithms of both stretches.
pub(super) fn distortion(jets: &[Jet]) -> f64 {
    /// For a place that is folded over or squeezed to nothing.
    const MOST: f64 = 20.0;
    let one = |[a, b]: [f64; 2]| {
        let d = a.ln().powi(2) + b.ln().powi(2);
        if b > 0.0 && d < MOST { d } else { MOST }
    };
    stretches(jets).into_iter().map(one).sum::<f64>() / jets.len() as f64
}

/// Returns the largest and the smallest stretch at every place, beside the mean stretches along both axes; the smallest is negative
/// where the map mirrors.
fn stretches(jets: &[Jet]) -> Vec<[f64; 2]> {
    let mean = |v: fn(&Jet) -> Vec2| jets.iter().map(|j| v(j).hypot()).sum::<f64>() / jets.len() as f64;
    let (x, y) = (mean(|j| j.dx), mean(|j| j.dy));
    let one = |j: &Jet| {
        let (dx, dy) = (j.dx / x, j.dy / y);
        // Singular values by the sums of the conformal and the anticonformal part.
        let (c, a) = ((dx.x + dy.y).hypot(dx.y - dy.x), (dx.x - dy.y).hypot(dx.y + dy.x));
        [0.5 * (c + a), 0.5 * (c - a)]
    };
    jets.iter().map(one).collect()
}

/// Returns `true` if a shape has four corners of its own: no other sharp node points outwards, its bottom runs to the right and its
/// sides upwards, and nothing folds or is stretched much more one way than the other.
fn honest(shape: &Subpath, ring: &Ring) -> bool {
    /// The largest angle of the bottom and of the sides with the screen's axes, as a tangent.
    const TURNED: f64 = 0.9;
    /// The largest ratio of both stretches, beside their means, but for a tenth of the places.
    const UNEVEN: f64 = 3.0;
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
    let screen: Vec<Jet> = jets.iter().map(|j| Jet { dy: -j.dy, ..*j }).collect();
    let mut ratios: Vec<f64> =
        stretches(&screen).iter().map(|[a, b]| if *b > 0.0 { a / b } else { f64::INFINITY }).collect();
    ratios.sort_by(f64::total_cmp);
    level && ratios[ratios.len() - 1] < f64::INFINITY && ratios[ratios.len() * 9 / 10] <= UNEVEN
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
    let c = Columns::new(shape, upright, room).ok_or_else(|| nothing(shape))?;
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
