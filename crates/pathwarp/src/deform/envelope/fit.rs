//! The Coons patch of a box into a ring of four sides, with warnings where sides cross or the map folds.

use super::distortion::grid;
use crate::anchors;
use crate::deform::entry::{Built, Role};
use crate::error::{Error, show};
use crate::map::{AffineMap, Coons, Map, Pace, Side, Sides};
use crate::outline::{Outline, Seg, Subpath};
use crate::param::{Choice as _, Frame, choice};
use kurbo::{Affine, BezPath, Line, Point, Rect};
use std::sync::Arc;

/// A side that strays from the line between its ends by no more than this share of its length is straight.
const STRAIGHT: f64 = 1e-9;

/// Smallest lean that is worth a warning, in degrees.
const VISIBLE_LEAN: f64 = 0.05;

choice! {
    /// The lines of the artwork that stay straight in an envelope.
    pub enum Keep {
        /// What suits the shape and the artwork: verticals for lettering unless the shape has four corners of its own, and else whatever
        /// distorts the artwork less.
        Auto = "auto",
        /// None in particular.
        Nothing = "nothing",
        /// Verticals, by the ruled map between bottom and top; a closed shape is filled in columns.
        Verticals = "verticals",
        /// Horizontals, by the ruled map between left and right; a closed shape is filled in rows.
        Horizontals = "horizontals",
        /// All, by a projective map. All sides must be straight.
        Lines = "lines",
    }
}

choice! {
    /// The spacing of the artwork along a side of an envelope.
    #[non_exhaustive]
    pub enum Spread {
        /// Even by length.
        Length = "length",
        /// By the curves' parameters; pieces share a side by their lengths.
        Parameter = "parameter",
        /// By even steps across the screen: along x for bottom and top, along y for left and right.
        Extent = "extent",
    }
}

impl Spread {
    /// Returns the pace along a side: bottom and top if `horizontal`, or left and right.
    fn pace(self, horizontal: bool) -> Pace {
        match self {
            Self::Parameter => Pace::Parameter,
            Self::Extent if horizontal => Pace::Width,
            Self::Extent => Pace::Height,
            Self::Length => Pace::Length,
        }
    }
}

/// Builds the map of the box `frame` into the sides of a ring.
pub(in crate::deform) fn fit(frame: Rect, ring: &Ring, keep: Keep, spread: Option<Spread>) -> Result<Built, Error> {
    let anchors::Anchors::Four(from) = anchors::frame_corners(&Frame::new(frame))? else {
        return Err(no_length("frame"));
    };
    let mut built = Built::new(Arc::new(AffineMap::IDENTITY));
    built.explanation.notes.clone_from(&ring.notes);
    built.explanation.warnings.clone_from(&ring.warnings);
    built.overlay(Role::Cage, preview(&ring.closed()));

    if keep == Keep::Lines {
        for (side, name) in ring.sides.iter().zip(SIDES) {
            demand_straight(side, name, "`keep lines` needs four straight sides")?;
        }
        let corners = ring.sides.each_ref().map(|side| side.first().map_or(Point::ORIGIN, Seg::start));
        built.note("kept: every line, by the projective map of the four corners");
        built.map = Arc::new(anchors::projective("envelope", from, corners)?);
        return Ok(built);
    }

    let map = Coons::new(sides_at_pace(ring, spread, keep, &mut built)?, to_unit(frame));
    let from_unit = Affine::new([frame.width(), 0.0, 0.0, -frame.height(), frame.x0, frame.y1]);
    let s = map.sides();
    built.explanation.warnings.extend(crossings([&s.bottom, &s.right, &s.top, &s.left]));
    built.explanation.warnings.extend(fold_warning(&map, from_unit));
    built.map = anchors::simplified(map.simplest(), frame);
    Ok(built)
}

/// Returns the map of a box to the unit square, with v upwards.
pub(super) fn to_unit(frame: Rect) -> Affine {
    let (w, h) = (frame.width(), frame.height());
    Affine::new([1.0 / w, 0.0, 0.0, -1.0 / h, -frame.x0 / w, frame.y1 / h])
}

/// Returns the sides, parametrised at the `given` pace or at the one that suits `keep`, with straight ones where `keep` needs them.
pub(super) fn sides_at_pace(ring: &Ring, given: Option<Spread>, keep: Keep, built: &mut Built) -> Result<Sides, Error> {
    let [bottom, right, top, left] = &ring.sides;
    let (top, left) = (reversed(top), reversed(left));
    let spread = given.unwrap_or(Spread::Length);
    let side = |c: &[Seg], k: usize, horizontal: bool| {
        let pace = spread.pace(horizontal);
        Side::new(c, pace).ok_or_else(|| no_pace(SIDES[k], pace, spread))
    };
    let straight = |c: &[Seg], k: usize| {
        let what =
            format!("`keep {}` needs the {} and the {} side straight", keep.name(), SIDES[(k + 2) % 4], SIDES[k]);
        demand_straight(c, SIDES[k], &what)?;
        let ends = c.first().zip(c.last()).map(|(a, b)| (a.start(), b.end()));
        ends.map(|(a, b)| Side::straight(a, b)).ok_or_else(|| no_length(SIDES[k]))
    };
    let (horizontal, axis) = match keep {
        Keep::Verticals => (true, Pace::Width),
        Keep::Horizontals => (false, Pace::Height),
        Keep::Auto | Keep::Nothing | Keep::Lines => {
            return Ok(Sides {
                bottom: side(bottom, 0, true)?,
                right: side(right, 1, false)?,
                top: side(&top, 2, true)?,
                left: side(&left, 3, false)?,
            });
        }
    };
    // The kept lines run between a pair of curves; the other two sides are kept lines, too.
    let ([c, d], [i, j]) = if horizontal { ([bottom, &top], [0, 2]) } else { ([&left, right], [3, 1]) };
    // At even steps along the axis, lines do not lean; along a curve that turns back, there are no such steps.
    let exact = if given.is_some() { None } else { Side::new(c, axis).zip(Side::new(d, axis)) };
    let (a, b) = match exact {
        Some(pair) => pair,
        None => (side(c, i, horizontal)?, side(d, j, horizontal)?),
    };
    let lean = lean(&a, &b, horizontal);
    let what = if horizontal { "verticals" } else { "horizontals" };
    let note =
        format!("kept: {what} are straight and lean by at most {lean:.3}°, by the ruled map between the two curves");
    built.note(note);
    if given.is_none() && lean >= VISIBLE_LEAN {
        built.warn(format!(
            "envelope: {what} stay straight but lean by up to {lean:.1}°: a curve turns back, or the curves do not span the same range"
        ));
    }
    Ok(if horizontal {
        Sides { bottom: a, top: b, right: straight(right, 1)?, left: straight(&left, 3)? }
    } else {
        Sides { left: a, right: b, bottom: straight(bottom, 0)?, top: straight(&top, 2)? }
    })
}

/// Returns the largest angle of the lines between two curves with the vertical, or between vertical curves with the horizontal, in degrees.
fn lean(a: &Side, b: &Side, horizontal: bool) -> f64 {
    const SAMPLES: u32 = 256;
    let angle = |i: u32| {
        let u = f64::from(i) / f64::from(SAMPLES);
        let v = b.at(u).0 - a.at(u).0;
        let (across, along) = if horizontal { (v.x, v.y) } else { (v.y, v.x) };
        across.abs().atan2(along.abs()).to_degrees()
    };
    (0..=SAMPLES).map(angle).fold(0.0, f64::max)
}

/// Returns `true` if a side of a ring is not straight.
pub(super) fn is_curved(ring: &Ring, k: usize) -> bool {
    demand_straight(&ring.sides[k], SIDES[k], "").is_err()
}

/// Refuses a curved side; a side without length is accepted. `what` begins the message.
fn demand_straight(c: &[Seg], name: &str, what: &str) -> Result<(), Error> {
    let Some(side) = Side::new(c, Pace::Length) else { return Ok(()) };
    let (distance, at) = side.farthest_from_chord();
    if distance <= STRAIGHT * side.length() {
        return Ok(());
    }
    let at = show(at);
    let problem =
        format!("{what}; the {name} side is curved: near {at} it is {distance:.6} off the line between its ends");
    Err(Error::advised("keep", "the envelope", problem, ". No map keeps such lines then: omit `keep`"))
}

fn no_length(name: &str) -> Error {
    Error::usage("envelope", format!("the {name} side"), "has no length")
}

/// Returns the error for a side that has no parametrisation at a pace.
fn no_pace(name: &str, pace: Pace, spread: Spread) -> Error {
    if !matches!(pace, Pace::Width | Pace::Height) {
        return no_length(name);
    }
    let across = if pace == Pace::Width { "left to right" } else { "bottom to top" };
    let problem =
        format!("needs sides that run {across} without turning back; the {name} side does not: use `by length`");
    Error::usage("by", spread.name(), problem)
}

/// Chords per side.
const CHORDS: u32 = 400;
/// Chords per block. Only blocks whose box is met are searched.
const BLOCK: usize = 20;
/// Overshoot beyond a chord that still counts as its end, as a share of its length.
const ROUNDING: f64 = 1e-9;
/// Samples of the map's determinant along an axis.
const GRID: u32 = 64;

/// Warns of sides, in the order of [`SIDES`], that cross one another or themselves.
fn crossings(sides: [&Side; 4]) -> Vec<String> {
    let size = sides[0].length() + sides[2].length();
    let chords = sides.map(|s| Chords::new(s, ROUNDING * size));
    let mut out = Vec::new();
    for i in 0..4 {
        for j in i..4 {
            let is_end =
                |p: Point| sides[i].ends().iter().chain(&sides[j].ends()).any(|e| e.distance(p) <= 1e-6 * size);
            let pairs = chords[i].all.iter().enumerate().flat_map(|(k, a)| {
                // Within a side, each pair of chords is compared once, without neighbours.
                let from = if i == j { k + 2 } else { 0 };
                chords[j].near(a, from).map(move |b| (a, b))
            });
            if let Some(at) = pairs.filter_map(|(a, b)| crossing(a, b)).find(|p| !is_end(*p)).map(show) {
                let what = if i == j {
                    format!("the {} side crosses itself", SIDES[i])
                } else {
                    format!("the {} and the {} side cross", SIDES[i], SIDES[j])
                };
                out.push(format!("envelope: {what} near {at}: the artwork folds over there; move the curves apart"));
            }
        }
    }
    out
}

/// The chords of a side.
struct Chords {
    all: Vec<Line>,
    /// The box of every block of [`BLOCK`] chords.
    boxes: Vec<Rect>,
}

impl Chords {
    /// Cuts a side into chords. Boxes are enlarged by `margin`.
    fn new(side: &Side, margin: f64) -> Self {
        let points: Vec<Point> = (0..=CHORDS).map(|i| side.at(f64::from(i) / f64::from(CHORDS)).0).collect();
        let all: Vec<Line> = points.windows(2).map(|p| Line::new(p[0], p[1])).collect();
        let block_box = |lines: &[Line]| {
            let start = Rect::from_points(lines[0].p0, lines[0].p1);
            lines.iter().fold(start, |b, l| b.union_pt(l.p1)).inflate(margin, margin)
        };
        let boxes = all.chunks(BLOCK).map(block_box).collect();
        Self { all, boxes }
    }

    /// Returns the chords, from number `from` on, in the blocks whose box meets the box of `line`.
    fn near(&self, line: &Line, from: usize) -> impl Iterator<Item = &Line> {
        let here = Rect::from_points(line.p0, line.p1);
        let first = from / BLOCK;
        let blocks = self.boxes.iter().enumerate().skip(first).filter(move |(_, b)| b.overlaps(here));
        blocks.flat_map(move |(k, _)| {
            let (start, end) = ((k * BLOCK).max(from), self.all.len().min((k + 1) * BLOCK));
            &self.all[start.min(end)..end]
        })
    }
}

/// Returns the point where two chords cross or touch, ends included: sides may cross in the joint of two chords.
fn crossing(a: &Line, b: &Line) -> Option<Point> {
    let (v, w, d) = (a.p1 - a.p0, b.p1 - b.p0, b.p0 - a.p0);
    let det = v.cross(w);
    // Parallel chords, as on a straight stretch, meet nowhere or everywhere.
    if det.abs() <= 1e-9 * v.hypot() * w.hypot() {
        return None;
    }
    let (t, u) = (d.cross(w) / det, d.cross(v) / det);
    let is_on_chord = |t: f64| (-ROUNDING..=1.0 + ROUNDING).contains(&t);
    (is_on_chord(t) && is_on_chord(u)).then(|| a.p0 + v * t)
}

/// Warns of a fold. `from_unit` takes the unit square to the source.
fn fold_warning(map: &Coons, from_unit: Affine) -> Option<String> {
    /// Determinants of the other sign below this share of the mean count as zero, since the determinant vanishes at smooth corners.
    const NEGLIGIBLE: f64 = 1e-6;
    let dets: Vec<(Point, f64)> = grid(GRID).map(|q| (q, map.jet(from_unit * q).det())).collect();
    let sum: f64 = dets.iter().map(|d| d.1).sum();
    let mean = dets.iter().map(|d| d.1.abs()).sum::<f64>() / dets.len() as f64;
    let sign = sum.signum();
    let folded: Vec<_> = dets.iter().filter(|d| d.1 * sign < -NEGLIGIBLE * mean).collect();
    let (q, _) = folded.iter().min_by(|a, b| (a.1 * sign).total_cmp(&(b.1 * sign)))?;
    let distances = [q.y, 1.0 - q.x, 1.0 - q.y, q.x];
    let side = (0..4).fold(0, |best, i| if distances[i] < distances[best] { i } else { best });
    let along = 100.0 * if side % 2 == 0 { q.x } else { q.y };
    Some(format!(
        "envelope: the map folds over near {} (nearest to the {} side, {along:.0} % along it; {:.1} % of the box): a side there \
bends too sharply for its neighbours; straighten it, or move the corners",
        show(map.point(from_unit * *q)),
        SIDES[side],
        100.0 * folded.len() as f64 / dets.len() as f64
    ))
}

/// The sides' names, in the order of [`Ring::sides`].
pub(super) const SIDES: [&str; 4] = ["bottom", "right", "top", "left"];
/// Samples per piece.
pub(super) const SAMPLES: u32 = 64;

/// Four sides, head to tail.
#[derive(Clone)]
pub(in crate::deform) struct Ring {
    /// Bottom (left to right), right (upwards), top (right to left), left (downwards).
    pub(in crate::deform) sides: [Vec<Seg>; 4],
    pub(in crate::deform) notes: Vec<String>,
    pub(in crate::deform) warnings: Vec<String>,
}

/// The four corners of a closed path.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Corners {
    /// Numbers of nodes, from 1.
    Nodes([usize; 4]),
    /// The points of the path nearest to these.
    Points([Point; 4]),
}

impl Ring {
    /// Returns the sides as one closed path.
    pub(super) fn closed(&self) -> Subpath {
        let segs: Vec<Seg> = self.sides.iter().flatten().copied().collect();
        Subpath { start: segs.first().map_or(Point::ORIGIN, Seg::start), segs, closed: true }
    }

    /// Returns `true` if the bottom and the top meet at an end.
    pub(super) fn bottom_meets_top(&self) -> bool {
        let is_point = |side: &[Seg]| side.iter().all(|s| s.bounding_box().size().max_side() == 0.0);
        is_point(&self.sides[1]) || is_point(&self.sides[3])
    }
}

/// Draws a closed path.
pub(super) fn preview(path: &Subpath) -> BezPath {
    let outline = Outline { subpaths: vec![path.clone()] };
    let size = outline.bounding_box().map_or(1.0, |b| b.width() + b.height());
    outline.to_bez_path(1e-4 * size)
}

/// Reverses a side.
pub(super) fn reversed(side: &[Seg]) -> Vec<Seg> {
    side.iter().rev().map(Seg::reversed).collect()
}

/// Runs the ring the other way, from the end of the bottom, which exchanges left and right.
pub(super) fn mirrored([bottom, right, top, left]: [Vec<Seg>; 4]) -> [Vec<Seg>; 4] {
    [reversed(&bottom), reversed(&left), reversed(&top), reversed(&right)]
}

/// Returns twice the signed area between a piece and the origin. The sum over a closed path is positive if it runs clockwise on the screen.
pub(super) fn double_area(s: &Seg) -> f64 {
    let point = |i: u32| s.eval(f64::from(i) / f64::from(SAMPLES)).to_vec2();
    (0..SAMPLES).map(|i| point(i).cross(point(i + 1))).sum()
}

/// Returns the box of a closed path.
pub(super) fn bounds(sub: &Subpath) -> Rect {
    sub.segs.iter().map(Seg::bounding_box).reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO)
}

/// Returns the part of a segment between two parameters.
pub(super) fn part(s: &Seg, a: f64, b: f64) -> Seg {
    match s {
        _ if a == 0.0 && b == 1.0 => *s,
        Seg::Arc(arc) => Seg::Arc(arc.subsegment(a, b)),
        other => other.part(a, b).unwrap_or(*other),
    }
}
