//! The map of a box into a ring of four sides.

use super::faults;
use super::ring::{Ring, SIDES, reversed};
use crate::anchors;
use crate::deform::built::{Built, Role};
use crate::error::{Error, show};
use crate::map::{AffineMap, Class, Coons, Pace, Side, Sides};
use crate::outline::Seg;
use crate::param::Frame;
use kurbo::{Affine, Point, Rect};
use std::sync::Arc;

/// A side that strays from the line between its ends by no more than this share of its length is straight.
const STRAIGHT: f64 = 1e-9;

/// Least lean that is worth a warning, in degrees.
const VISIBLE_LEAN: f64 = 0.05;

/// The lines of the artwork that stay straight in an envelope.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// What suits the shape and the artwork: verticals for lettering unless the shape has four corners of its own, and else whatever
    /// distorts the artwork less.
    Auto,
    /// None in particular.
    Nothing,
    /// Verticals, by the ruled map between bottom and top; a closed shape is filled in columns.
    Verticals,
    /// Horizontals, by the ruled map between left and right; a closed shape is filled in rows.
    Horizontals,
    /// All, by a projective map. All sides must be straight.
    Lines,
}

impl Keep {
    pub(in crate::deform) fn named(name: &str) -> Self {
        match name {
            "auto" => Self::Auto,
            "verticals" => Self::Verticals,
            "horizontals" => Self::Horizontals,
            "lines" => Self::Lines,
            _ => Self::Nothing,
        }
    }

    pub(in crate::deform) fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Nothing => "nothing",
            Self::Verticals => "verticals",
            Self::Horizontals => "horizontals",
            Self::Lines => "lines",
        }
    }
}

/// The spacing of the artwork along a side of an envelope.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Spread {
    /// Even by length.
    Length,
    /// By the curves' parameters; pieces share a side by their lengths.
    Parameter,
    /// By even steps across the screen: along x for bottom and top, along y for left and right.
    Extent,
}

impl Spread {
    fn name(self) -> &'static str {
        match self {
            Self::Length => "length",
            Self::Parameter => "parameter",
            Self::Extent => "extent",
        }
    }

    /// Returns the pace of a lying or standing side.
    fn pace(self, lying: bool) -> Pace {
        match self {
            Self::Parameter => Pace::Parameter,
            Self::Extent if lying => Pace::Width,
            Self::Extent => Pace::Height,
            Self::Length => Pace::Length,
        }
    }
}

/// Builds the map of the box `frame` into these sides.
pub(in crate::deform) fn fit(frame: Rect, ring: &Ring, keep: Keep, spread: Option<Spread>) -> Result<Built, Error> {
    let anchors::Anchors::Four(from) = anchors::frame_corners(&Frame::new(frame))? else {
        return Err(no_length("frame"));
    };
    let pre = to_unit(frame);
    let mut built = Built::new(Arc::new(AffineMap::IDENTITY));
    built.explanation.notes.clone_from(&ring.notes);
    built.explanation.warnings.clone_from(&ring.warnings);
    built.overlay(Role::Cage, ring.path());

    if keep == Keep::Lines {
        for (side, name) in ring.sides.iter().zip(SIDES) {
            demand_straight(side, name, "`keep lines` needs four straight sides")?;
        }
        let corners = ring.sides.each_ref().map(|side| side.first().map_or(Point::ORIGIN, Seg::start));
        built.note("kept: every line, by the projective map of the four corners");
        built.map = Arc::new(anchors::projective("envelope", from, corners)?);
        return Ok(built);
    }

    let map = Coons::new(paced(ring, spread, keep, &mut built)?, pre);
    let inverse = Affine::new([frame.width(), 0.0, 0.0, -frame.height(), frame.x0, frame.y1]);
    built.explanation.warnings.extend(faults::warnings(&map, inverse));
    let map = map.simplest();
    built.map = match map.class() {
        Class::Affine(m) => Arc::new(AffineMap(anchors::settled(m, &Frame::new(frame)))),
        _ => map,
    };
    Ok(built)
}

/// Returns the map of a box to the unit square, with v upwards.
pub(super) fn to_unit(frame: Rect) -> Affine {
    let (w, h) = (frame.width(), frame.height());
    Affine::new([1.0 / w, 0.0, 0.0, -1.0 / h, -frame.x0 / w, frame.y1 / h])
}

/// Returns the sides at their pace, and straight ones where `keep` needs them.
pub(super) fn paced(ring: &Ring, given: Option<Spread>, keep: Keep, built: &mut Built) -> Result<Sides, Error> {
    let [bottom, right, top, left] = &ring.sides;
    let (top, left) = (reversed(top), reversed(left));
    let spread = given.unwrap_or(Spread::Length);
    let side = |c: &[Seg], k: usize, lying: bool| {
        let pace = spread.pace(lying);
        Side::new(c, pace).ok_or_else(|| no_pace(SIDES[k], pace, spread))
    };
    let straight = |c: &[Seg], k: usize| {
        let what =
            format!("`keep {}` needs the {} and the {} side straight", keep.name(), SIDES[(k + 2) % 4], SIDES[k]);
        demand_straight(c, SIDES[k], &what)?;
        let ends = c.first().zip(c.last()).map(|(a, b)| (a.start(), b.end()));
        ends.map(|(a, b)| Side::straight(a, b)).ok_or_else(|| no_length(SIDES[k]))
    };
    let (lying, axis) = match keep {
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
    // The kept lines run between a pair of curves; the other two sides are kept lines themselves.
    let (pair, names) = if lying { ([bottom, &top], [0, 2]) } else { ([&left, right], [3, 1]) };
    let exact = if given.is_some() { None } else { Side::new(pair[0], axis).zip(Side::new(pair[1], axis)) };
    let (a, b) = match exact {
        Some(pair) => pair,
        None => (side(pair[0], names[0], lying)?, side(pair[1], names[1], lying)?),
    };
    let lean = lean(&a, &b, lying);
    let what = if lying { "verticals" } else { "horizontals" };
    built.note(format!(
        "kept: {what} are straight and lean by at most {lean:.3}°, by the ruled map between the two curves"
    ));
    if given.is_none() && lean >= VISIBLE_LEAN {
        built.warn(format!(
            "envelope: {what} stay straight but lean by up to {lean:.1}°: a curve turns back, or the curves do not span the same range"
        ));
    }
    Ok(if lying {
        Sides { bottom: a, top: b, right: straight(right, 1)?, left: straight(&left, 3)? }
    } else {
        Sides { left: a, right: b, bottom: straight(bottom, 0)?, top: straight(&top, 2)? }
    })
}

/// Returns the largest lean of the lines between two curves, degrees.
fn lean(a: &Side, b: &Side, lying: bool) -> f64 {
    const SAMPLES: u32 = 256;
    let one = |i: u32| {
        let u = f64::from(i) / f64::from(SAMPLES);
        let v = b.at(u).0 - a.at(u).0;
        let (off, along) = if lying { (v.x, v.y) } else { (v.y, v.x) };
        off.abs().atan2(along.abs()).to_degrees()
    };
    (0..=SAMPLES).map(one).fold(0.0, f64::max)
}

/// Returns `true` if a side of a ring is not straight.
pub(super) fn is_curved(ring: &Ring, k: usize) -> bool {
    demand_straight(&ring.sides[k], SIDES[k], "").is_err()
}

/// Refuses a curved side, not one without length; `what` begins the message.
fn demand_straight(c: &[Seg], name: &str, what: &str) -> Result<(), Error> {
    let Some(side) = Side::new(c, Pace::Length) else { return Ok(()) };
    let (off, at) = side.off_straight();
    if off <= STRAIGHT * side.length() {
        return Ok(());
    }
    let problem =
        format!("{what}; the {name} side is curved: near {} it is {off:.6} off the line between its ends", show(at));
    Err(Error::advised("keep", "the envelope", problem, ". No map keeps such lines then: omit `keep`"))
}

fn no_length(name: &str) -> Error {
    Error::usage("envelope", format!("the {name} side"), "has no length")
}

fn no_pace(name: &str, pace: Pace, spread: Spread) -> Error {
    if !matches!(pace, Pace::Width | Pace::Height) {
        return no_length(name);
    }
    let across = if pace == Pace::Width { "left to right" } else { "bottom to top" };
    let problem =
        format!("needs sides that run {across} without turning back; the {name} side does not: use `by length`");
    Error::usage("by", spread.name(), problem)
}
