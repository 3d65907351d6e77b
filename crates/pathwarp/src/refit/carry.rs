//! Cubics carried to another place where the same segments come again, as the letters of a text do.
//!
//! From one place to the other a map changes little but its size and direction. A cubic of one place is given the ends and tangents of
//! the other, and handles longer by as much as the image is. Its error then differs from that of the first by a smooth amount, as
//! images of one curve under two smooth maps do, so that a few samples measure the difference: no fit, and no check of all samples.

use super::limits::{CARRIED_TURN, CARRY_DOWN, CARRY_MARGIN, CARRY_UP};
use super::segment::{Part, SegmentFitter};
use super::source::{SourceCurve, images};
use crate::map::Jet;
use bezierfit::parts::{ChordFrame, FOOT_ROUNDING, FitOwn, Leg, MERGE_GRID, MarkedCubic, SMOOTH_JOINT};
use bezierfit::{Lanes, Piece, Report, Source};
use kurbo::{Point, Vec2};

/// Consecutive segments at one site of the map.
#[derive(Clone, Copy)]
pub(super) struct Site<'a> {
    pub(super) fitter: &'a SegmentFitter<'a>,
    pub(super) parts: &'a [Part],
}

/// An end of a cubic.
struct End {
    p: Point,
    /// Unit tangent and speed of the image on the side of the cubic.
    tangent: Vec2,
    speed: f64,
}

impl<'a> Site<'a> {
    /// Returns `true` if cubics are carried to and from here: if the map is a quotient of polynomials, so that two images of a curve
    /// differ smoothly, no proofs are wanted, and single values are cheap.
    pub(super) fn carries(&self) -> bool {
        let SegmentFitter { map, degree, options, .. } = self.fitter;
        degree.is_some() && !options.certify && !map.prefers_batches()
    }

    /// The image at grid place `k`, seen from the segment after it or before it. `None` if it has no derivative there.
    fn end(&self, k: usize, after: bool) -> Option<End> {
        let (joint, place) = (k / MERGE_GRID, k % MERGE_GRID);
        let i = if after || place > 0 { joint } else { joint.checked_sub(1)? };
        let part = self.parts.get(i)?;
        let source = SourceCurve::new(&part.seg, self.fitter.map, None);
        let mut end = if place > 0 {
            source.end(place as f64 / MERGE_GRID as f64).ok()?
        } else {
            let jet = &part.jets[usize::from(!after)];
            source.end_with(if after { 0.0 } else { 1.0 }, jet.p, jet)
        };
        // Neighbouring pieces share a joint bit by bit.
        if let (0, Some(next)) = (place, self.parts.get(joint)) {
            end.p = next.jets[0].p;
        }
        let tangent = if after { end.away } else { end.into };
        (end.speed > 0.0).then_some(End { p: end.p, tangent, speed: end.speed })
    }

    /// Fits its segments one by one.
    pub(super) fn own(self) -> impl FitOwn {
        move |i: usize, pieces: &mut Vec<Piece>, report: &mut Report| {
            self.fitter.fit_inside(&self.parts[i], pieces, report)
        }
    }

    /// Returns `true` if the image is smooth at the joints inside a leg.
    fn is_smooth(&self, leg: Leg) -> bool {
        (leg.from / MERGE_GRID + 1..leg.to.div_ceil(MERGE_GRID)).all(|j| {
            let (Some(before), Some(after)) = (self.parts.get(j - 1), self.parts.get(j)) else { return false };
            let jet = &after.jets[0];
            let (into, away) = (jet.push(before.seg.deriv(1.0)), jet.push(after.seg.deriv(0.0)));
            into.cross(away).abs() <= SMOOTH_JOINT * into.dot(away)
        })
    }

    /// Images at eight places, given as segments and their parameters.
    fn images(&self, at: &[(usize, f64); 8]) -> Lanes {
        let point = |(segment, t): (usize, f64)| self.parts.get(segment).map_or(Point::ORIGIN, |s| s.seg.eval(t));
        images(self.fitter.map, &at.map(point))
    }
}

/// The change of a map's Jacobian from one place to another: J₁·J₀⁻¹.
#[derive(Debug, Clone, Copy)]
pub(super) struct Change {
    columns: [Vec2; 2],
    det: f64,
    /// The factor from 1 to the singular value farther from it.
    pub(super) factor: f64,
}

impl Change {
    /// `None` unless the change of every length is between [`CARRY_DOWN`] and [`CARRY_UP`].
    pub(super) fn new([dx, dy]: [Vec2; 2], to: &Jet) -> Option<Self> {
        let k = 1.0 / dx.cross(dy);
        let columns = [(to.dx * dy.y - to.dy * dx.y) * k, (to.dy * dx.x - to.dx * dy.x) * k];
        let (mean, det) = (0.5 * (columns[0].hypot2() + columns[1].hypot2()), columns[0].cross(columns[1]));
        let apart = (mean * mean - det * det).max(0.0).sqrt();
        let (most, least) = ((mean + apart).sqrt(), (mean - apart).max(0.0).sqrt());
        let within = most <= CARRY_UP && least >= CARRY_DOWN;
        (det > 0.0 && within).then(|| Self { columns, det, factor: most.max(1.0 / least) })
    }

    fn push(&self, v: Vec2) -> Vec2 {
        self.columns[0] * v.x + self.columns[1] * v.y
    }

    /// Returns `true` if a direction is changed into nearly another.
    fn turns(&self, from: Vec2, to: Vec2) -> bool {
        let v = self.push(from);
        v.cross(to).abs() <= CARRIED_TURN * v.dot(to)
    }

    /// Factor by which distances from a curve with this unit tangent change.
    fn across(&self, tangent: Vec2) -> f64 {
        self.det / self.push(tangent).hypot()
    }
}

/// A cubic that has passed its check, as far as other places need it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Carried {
    /// The partial derivatives of the map at the last joint before it.
    jacobian: [Vec2; 2],
    /// Unit tangents and speeds of the image at both ends.
    tangents: [Vec2; 2],
    speeds: [f64; 2],
    cubic: MarkedCubic,
}

impl Carried {
    /// A cubic from one of the site's legs. `None` if it begins or ends where the image stops.
    pub(super) fn new(site: &Site<'_>, leg: Leg, cubic: MarkedCubic) -> Option<Self> {
        let (from, to) = (site.end(leg.from, true)?, site.end(leg.to, false)?);
        let [Jet { dx, dy, .. }, _] = site.parts.get(leg.from / MERGE_GRID)?.jets;
        let (tangents, speeds) = ([from.tangent, to.tangent], [from.speed, to.speed]);
        Some(Self { jacobian: [dx, dy], tangents, speeds, cubic })
    }

    /// The cubic at another place, with a bound of its error. `None` if that may exceed `tolerance`.
    pub(super) fn at(&self, site: &Site<'_>, leg: Leg, tolerance: f64) -> Option<(Piece, f64)> {
        let change = Change::new(self.jacobian, &site.parts.get(leg.from / MERGE_GRID)?.jets[0])?;
        let across =
            self.cubic.batches.iter().flat_map(|b| &b.tangents).chain(&self.tangents).map(|t| change.across(*t));
        let error = self.cubic.error * across.fold(0.0, f64::max);
        let left = tolerance - error;
        if left <= 0.0 || !site.is_smooth(leg) {
            return None;
        }
        let (from, to) = (site.end(leg.from, true)?, site.end(leg.to, false)?);
        if !(change.turns(self.tangents[0], from.tangent) && change.turns(self.tangents[1], to.tangent)) {
            return None;
        }
        let (t0, t1) = (from.tangent, to.tangent);
        let frame = ChordFrame { q: to.p - from.p, t0, t1, floor: [0.0; 2], size: 0.0, home: [0.0; 2], pull: 0.0 };
        let [a, b] = self.cubic.handles;
        let (a, b) = (a * from.speed / self.speeds[0], b * to.speed / self.speeds[1]);
        let (mut difference, mut last) = (0.0f64, 0.0);
        for batch in &self.cubic.batches {
            let mut g = site.images(&batch.at);
            for i in 0..8 {
                g.x[i] -= from.p.x;
                g.y[i] -= from.p.y;
            }
            let mut s = batch.feet;
            let squares = frame.distances(&g, a, b, &mut s, 1);
            let errors = frame.signed_distances(&g, a, b, &s, &squares);
            for i in 0..8 {
                let off = (errors[i] - change.across(batch.tangents[i]) * batch.errors[i]).abs();
                // Written so that NaN fails.
                if !(off * CARRY_MARGIN <= left && s[i] >= last - FOOT_ROUNDING) {
                    return None;
                }
                difference = difference.max(off);
                last = s[i];
            }
        }
        let piece = Piece::Cubic(frame.cubic(from.p, to.p, a, b));
        Some((piece, error + CARRY_MARGIN * difference))
    }
}
