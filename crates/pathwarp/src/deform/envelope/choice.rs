//! The map that suits the shape and the artwork: the patch of four sides, columns or rows.

use super::columns::{Columns, Room, bisected, filled, nothing};
use super::corners;
use super::distortion::{distortion, grid, stretches, turned};
use super::fit::{Keep, Spread, fit, is_curved};
use super::ring::{Ring, area, bounds, reversed};
use crate::deform::built::Built;
use crate::error::{Error, show};
use crate::map::{Coons, Jet, Map, Pace, Side, Sides};
use crate::outline::{Seg, Subpath};
use kurbo::{Affine, Line, Point, Rect, Vec2};

/// Columns that hold at least this part of a shape's area fill it.
const FILLS: f64 = 0.8;
/// Samples along an axis of the box, where the artwork is not known.
const GRID: u32 = 24;

/// What a map is chosen by.
#[derive(Clone, Copy)]
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
            (Keep::Auto, Some(shape)) => self.suited(&shape, ring.ok()),
            (keep, _) => {
                let ring = ring?;
                // No ruled map keeps lines between curved sides; columns and rows do.
                let across = match keep {
                    Keep::Verticals => [1, 3],
                    Keep::Horizontals => [0, 2],
                    _ => return self.patched(&ring, keep),
                };
                if across.iter().any(|k| is_curved(&ring, *k)) {
                    return filled(self.frame, &ring.closed(), keep == Keep::Verticals, &self.room);
                }
                self.patched(&ring, keep)
            }
        }
    }

    /// Builds the patch of four sides.
    fn patched(&self, ring: &Ring, keep: Keep) -> Result<Built, Error> {
        let keep = if keep == Keep::Auto { Keep::Nothing } else { keep };
        fit(padded(self.frame, ring, self.room.padding)?, ring, keep, self.spread)
    }

    /// Builds what suits the shape and the artwork.
    fn suited(&self, shape: &Subpath, ring: Option<Ring>) -> Result<Built, Error> {
        let is_honest = ring.as_ref().is_some_and(|ring| honest(shape, ring));
        let (ring, frame) = match ring {
            Some(ring) if is_honest && self.lettering => {
                let (ring, frame) = between_notches(ring, shape, self.frame);
                (Some(ring), frame)
            }
            ring => (ring, self.frame),
        };
        let patch = || Choice { frame, ..*self }.patched(ring.as_ref()?, Keep::Nothing).ok();
        if is_honest && let Some(built) = patch() {
            return Ok(built);
        }
        if self.lettering {
            return filled(self.frame, shape, true, &self.room).or_else(|e| patch().ok_or(e));
        }
        let fills = |upright: bool| Columns::new(shape, upright, &Room::default()).map_or(0.0, |c| c.coverage);
        let scored = |b: Built| {
            let d = self.distortion(&*b.map);
            (b, d)
        };
        let mut all: Vec<(Built, f64)> = Vec::new();
        all.extend(patch().map(scored));
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
        let corners = [(f.x0, f.y1), (f.x1, f.y1), (f.x1, f.y0), (f.x0, f.y0)].map(|p| map.point(p.into()));
        distortion(&points.iter().map(|p| map.jet(*p)).collect::<Vec<_>>()) + turned(corners)
    }
}

/// Returns `true` if a shape has four corners of its own: no other sharp node points outwards, its bottom runs to the right and its
/// sides upwards, and nothing folds or is stretched much more one way than the other.
fn honest(shape: &Subpath, ring: &Ring) -> bool {
    /// The largest angle of the bottom and of the sides with the screen's axes, as a tangent.
    const TURNED: f64 = 0.9;
    /// The largest ratio of both stretches, beside their means, but for a tenth of the places.
    const UNEVEN: f64 = 2.2;
    let around: f64 = shape.segs.iter().map(area).sum();
    let pointed: Vec<Point> = corners::sharp(shape, around.signum()).map(|i| shape.segs[i].start()).collect();
    let size = bounds(shape).size().max_side();
    let is_corner =
        |p: &Point| ring.sides.iter().flat_map(|s| s.first()).any(|s| s.start().distance(*p) <= 1e-9 * size);
    if pointed.len() != 4 || !pointed.iter().all(is_corner) {
        return false;
    }
    let side = |k: usize, back: bool| {
        let s = &ring.sides[k];
        Side::new(&if back { reversed(s) } else { s.clone() }, Pace::Length)
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

/// Ends lettering between the notches of a swallow-tailed banner: a side with one becomes straight, and the box is widened, so that its
/// own upright through the notch ends the letters.
fn between_notches(mut ring: Ring, shape: &Subpath, frame: Rect) -> (Ring, Rect) {
    let around: f64 = shape.segs.iter().map(area).sum();
    let notches: Vec<Point> = corners::sharp(shape, -around.signum()).map(|i| shape.segs[i].start()).collect();
    let (Some(bottom), Some(top)) =
        (Side::new(&ring.sides[0], Pace::Length), Side::new(&reversed(&ring.sides[2]), Pace::Length))
    else {
        return (ring, frame);
    };
    // The share of the width, from its side on, whose upright has the notch on it.
    let share = |notch: Point, right: bool| {
        let outside = |t: f64| {
            let u = if right { 1.0 - t } else { t };
            let (from, to) = (bottom.at(u).0, top.at(u).0);
            ((to - from).cross(notch - from) > 0.0) != right
        };
        (outside(0.0) && !outside(0.5)).then(|| bisected(0.5, 0.0, |t| if outside(t) { 1.0 } else { -1.0 }))
    };
    let [mut left, mut right] = [0.0_f64; 2];
    for (k, is_right, out) in [(3, false, &mut left), (1, true, &mut right)] {
        let side = &ring.sides[k];
        let nodes: Vec<Point> = side.iter().skip(1).map(Seg::start).filter(|p| notches.contains(p)).collect();
        let Some(deepest) = nodes.iter().filter_map(|p| share(*p, is_right)).reduce(f64::max) else { continue };
        let (from, to) = (side[0].start(), side[side.len() - 1].end());
        ring.notes.push(format!("the letters end at {}", nodes.iter().map(|p| show(*p)).collect::<Vec<_>>().join(" ")));
        ring.sides[k] = vec![Seg::Line(Line::new(from, to))];
        *out = deepest;
    }
    let width = frame.width() / (1.0 - left - right);
    (ring, Rect::new(frame.x0 - left * width, frame.y0, frame.x1 + right * width, frame.y1))
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
