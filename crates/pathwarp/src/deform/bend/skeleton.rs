//! The skeleton: a path's pieces in a row, measured, oriented, and joined.

use super::map::{MovingFrame, Ribbon, SkeletonPiece, Spine, Strip, normal};
use crate::anchors;
use crate::error::{Error, show};
use crate::map::curves::ArcLength;
use crate::outline::{Seg, Subpath};
use crate::param::NamedPath;
use kurbo::{Line, Point, Vec2};

/// Below this angle (radians) a joint is smooth.
const SMOOTH: f64 = 1e-6;
/// Below this angle a corner is invisible.
const UNSEEN: f64 = 5e-3;
/// 1 + cos of the turn beyond which a mitre would be longer than eight times the height.
const SHARPEST: f64 = 1.0 / 32.0;

/// The measured pieces of a path.
pub(super) struct Skeleton {
    spines: Vec<(Spine, ArcLength)>,
    pub(super) closed: bool,
    pub(super) length: f64,
    /// The height at which lengths are measured.
    even: f64,
    name: String,
}

/// A joint at which the tangent jumps.
pub(super) struct Corner {
    pub(super) at: Point,
    /// Radians.
    pub(super) turn: f64,
}

/// The pieces with their sides, and notes on their joints.
pub(super) struct Joined {
    pub(super) pieces: Vec<SkeletonPiece>,
    pub(super) corners: Vec<Corner>,
    pub(super) notes: Vec<String>,
}

impl Skeleton {
    /// Takes the only connected run of `path`. Unless `as_drawn`, an open one is oriented left to right, except if it goes around more
    /// than once, a closed one clockwise (up is then outside). `reverse` turns it around after that.
    pub(super) fn new(path: &NamedPath, as_drawn: bool, reverse: bool) -> Result<Self, Error> {
        let mut sub = anchors::only_subpath(path, "a single connected run of them")?;
        let backwards = match sub.closed {
            true => turns_left(&sub),
            false => runs_left(&sub) && !winds(&sub),
        };
        if reverse != (backwards && !as_drawn) {
            sub = sub.reversed();
        }
        let measured: Vec<_> = sub.segs.into_iter().map(|s| (Spine::new(s), ArcLength::of(&s))).collect();
        let length: f64 = measured.iter().map(|(_, t)| t.length()).sum();
        if !(length > 0.0 && length.is_finite()) {
            return Err(Error::usage("along", path.name.clone(), "has no length"));
        }
        let spines = measured.into_iter().filter(|(_, t)| t.length() > 1e-12 * length).collect();
        Ok(Self { spines, closed: sub.closed, length, even: 0.0, name: path.name.clone() })
    }

    pub(super) fn has_arcs(&self) -> bool {
        self.spines.iter().any(|(s, _)| matches!(s.seg, Seg::Arc(_)))
    }

    /// Measures lengths at height `d`: along the offset curve, whose speed is (1 + κd) times the skeleton's.
    pub(super) fn at_height(self, d: f64) -> Result<Self, Error> {
        /// Samples of a piece.
        const SAMPLES: u32 = 256;
        /// Below this share of the skeleton's speed, the offset is close to a cusp.
        const SLOWEST: f64 = 1e-3;
        let rate = move |s: &Spine, u: f64| 1.0 + s.moving(u).bend * d;
        for (spine, _) in &self.spines {
            let mut all = (0..=SAMPLES).map(|i| f64::from(i) / f64::from(SAMPLES));
            if let Some(u) = all.find(|u| rate(spine, *u).is_nan() || rate(spine, *u) < SLOWEST) {
                let problem = format!(
                    "needs a gentler bend: near {} the centre of curvature is no further from the skeleton than half the \
artwork's height; a smaller `width` helps too",
                    show(spine.seg.eval(u))
                );
                return Err(Error::usage("spacing", "even", problem));
            }
        }
        let measured = self.spines.into_iter().map(|(s, _)| {
            let table = ArcLength::new(&move |u| s.seg.deriv(u).hypot() * rate(&s, u));
            (s, table)
        });
        let spines: Vec<(Spine, ArcLength)> = measured.collect();
        let length = spines.iter().map(|(_, t)| t.length()).sum();
        Ok(Self { spines, length, even: d, ..self })
    }

    /// Returns the scale k at which artwork of `width` is as long as the skeleton's offset at height k·`height`:
    /// k·width = length + k·height·(total turn), because the offset's length is linear in the height.
    pub(super) fn even_scale(&self, width: f64, height: f64) -> Result<f64, Error> {
        /// Samples of a piece, between which its tangent turns by less than half a circle.
        const SAMPLES: u32 = 256;
        let turn = |s: &Spine| {
            let tangent = |i: u32| s.moving(f64::from(i) / f64::from(SAMPLES)).t;
            (0..SAMPLES).map(|i| (tangent(i), tangent(i + 1))).map(|(a, b)| a.cross(b).atan2(a.dot(b))).sum::<f64>()
        };
        let turn: f64 = self.spines.iter().map(|(s, _)| turn(s)).sum();
        let scale = self.length / (width - height * turn);
        if scale > 0.0 && scale.is_finite() {
            return Ok(scale);
        }
        let problem = "the artwork is so high against its width that no size of it fits; use `spacing baseline`";
        Err(Error::usage("spacing", "even", problem))
    }

    /// Converts arcs to cubics within `tolerance`, and lines to quadratics if `raise`, for the paper's handles.
    pub(super) fn polynomial(mut self, tolerance: f64, raise: bool) -> Self {
        let spines = std::mem::take(&mut self.spines);
        for (spine, table) in spines {
            match spine.seg {
                Seg::Arc(a) => {
                    let cubics = a.to_cubics(tolerance).map(Seg::Cubic);
                    self.spines.extend(cubics.map(|s| (Spine::new(s), ArcLength::of(&s))));
                }
                Seg::Line(l) if raise => {
                    let raised = Seg::Quad(kurbo::QuadBez::new(l.p0, l.p0.midpoint(l.p1), l.p1));
                    self.spines.push((Spine::new(raised), table));
                }
                _ => self.spines.push((spine, table)),
            }
        }
        self.length = self.spines.iter().map(|(_, t)| t.length()).sum();
        self
    }

    /// Returns the distance of the highest point on the screen, or of the lowest.
    pub(super) fn extreme(&self, lowest: bool) -> f64 {
        /// Samples of a piece. They decide the position of the artwork, not its shape.
        const SAMPLES: u32 = 256;
        let (mut best, mut start) = ((f64::INFINITY, 0.0), 0.0);
        for (spine, table) in &self.spines {
            for i in 0..=SAMPLES {
                let s = table.length() * f64::from(i) / f64::from(SAMPLES);
                let y = spine.seg.eval(table.parameter(s)).y;
                let y = if lowest { -y } else { y };
                if y < best.0 {
                    best = (y, start + s);
                }
            }
            start += table.length();
        }
        best.1
    }

    /// Returns the pieces before and after each joint.
    fn joints(&self) -> impl Iterator<Item = (usize, usize)> {
        let n = self.spines.len();
        (0..if self.closed { n } else { n - 1 }).map(move |i| (i, (i + 1) % n))
    }

    /// Returns the unit normals at every piece's ends, mitred at corners, and the corners.
    fn sides(&self) -> Result<(Vec<[Vec2; 2]>, Vec<Corner>), Error> {
        let ends: Vec<[MovingFrame; 2]> = self.spines.iter().map(|(s, _)| [s.moving(0.0), s.moving(1.0)]).collect();
        let mut sides: Vec<[Vec2; 2]> = ends.iter().map(|[a, b]| [normal(a.t), normal(b.t)]).collect();
        let mut corners = Vec::new();
        for (i, j) in self.joints() {
            let (n, m) = (sides[i][1], sides[j][0]);
            let turn = n.cross(m).atan2(n.dot(m));
            if turn.abs() <= SMOOTH {
                continue;
            }
            let at = ends[j][0].p;
            if 1.0 + n.dot(m) < SHARPEST {
                let problem =
                    format!("turns back on itself at {}, where artwork cannot follow; round that corner", show(at));
                return Err(Error::usage("along", self.name.clone(), problem));
            }
            if turn.abs() > UNSEEN {
                corners.push(Corner { at, turn });
            }
            let mitre = (n + m) / (1.0 + n.dot(m));
            (sides[i][1], sides[j][0]) = (mitre, mitre);
        }
        Ok((sides, corners))
    }

    /// Joins pieces whose sides are unit normals, for artwork that is at most `height` from the skeleton.
    pub(super) fn with_normals(self, height: f64) -> Result<Joined, Error> {
        let (sides, corners) = self.sides()?;
        let mut strips = Vec::with_capacity(self.spines.len());
        for ((spine, table), [a, b]) in self.spines.iter().zip(sides) {
            let (first, last) = (spine.moving(0.0), spine.moving(1.0));
            let mitres = [a - normal(first.t), b - normal(last.t)];
            match spine.seg {
                Seg::Line(line) => strips.extend(on_a_line(line, mitres, height)),
                _ => {
                    let curved =
                        Strip::Normals { spine: *spine, table: table.clone(), mitres, even: self.even, smooth: false };
                    strips.push((curved, table.length()));
                }
            }
        }
        let pieces = self.in_a_row(strips);
        Ok(Joined { pieces, corners, notes: Vec::new() })
    }

    /// Joins pieces whose sides are the paper's handles: `given` for every piece, or the unit normals of the control polygon's legs
    /// times `unit`.
    pub(super) fn with_handles(
        self,
        given: Option<&[Vec<Vec<Vec2>>]>,
        unit: f64,
        by_arc_length: bool,
    ) -> Result<Joined, Error> {
        let (sides, corners) = if given.is_some() { (Vec::new(), Vec::new()) } else { self.sides()? };
        if let Some(g) = given.filter(|g| g.len() != self.spines.len()) {
            let problem = format!("has handles for {} pieces; the skeleton has {}", g.len(), self.spines.len());
            return Err(Error::input("handles", problem));
        }
        let mut ribbons = Vec::with_capacity(self.spines.len());
        for (i, (spine, _)) in self.spines.iter().enumerate() {
            let points = control_points(&spine.seg);
            let degree = points.len() - 1;
            let levels = match given {
                Some(g) => g[i].clone(),
                None => vec![legs(&points, sides[i]).into_iter().map(|n| n * unit).collect()],
            };
            let ribbon = Ribbon::new(points, &levels).ok_or_else(|| {
                let wanted: Vec<String> = (1..=degree).rev().map(|n| n.to_string()).collect();
                let problem = format!(
                    "piece {} has degree {degree}: its levels need {} handles; it has {:?}",
                    i + 1,
                    wanted.join(", "),
                    levels.iter().map(Vec::len).collect::<Vec<_>>()
                );
                Error::input("handles", problem)
            })?;
            ribbons.push(ribbon);
        }
        let mut notes = Vec::new();
        for (i, j) in self.joints() {
            let (a, b) = (ribbons[i].side_at_end(1), ribbons[j].side_at_end(0));
            let at = self.spines[j].0.seg.start();
            if (a - b).hypot() > 1e-6 * (a.hypot() + b.hypot()) {
                let problem = format!(
                    "the handles on both sides of the joint at {} differ: {:.6},{:.6} and {:.6},{:.6}; the artwork would tear",
                    show(at),
                    a.x,
                    a.y,
                    b.x,
                    b.y
                );
                return Err(Error::input("handles", problem));
            }
        }
        let strips = self.spines.iter().zip(ribbons).map(|((_, table), ribbon)| {
            let length = table.length();
            (Strip::Ribbon { ribbon, unit, table: by_arc_length.then(|| table.clone()) }, length)
        });
        let strips: Vec<_> = strips.collect();
        let joints: Vec<_> = self.joints().collect();
        let pieces = self.in_a_row(strips);
        // The straight continuations of open ends are pieces too.
        let first = usize::from(!self.closed);
        for (i, j) in joints {
            notes.push(continuity(&pieces[first + i], &pieces[first + j], unit));
        }
        Ok(Joined { pieces, corners, notes })
    }

    /// Lines up the pieces; an open skeleton continues straight at both ends.
    fn in_a_row(&self, strips: Vec<(Strip, f64)>) -> Vec<SkeletonPiece> {
        let mut pieces = Vec::with_capacity(strips.len() + 2);
        let mut at = 0.0;
        for (strip, length) in strips {
            pieces.push(SkeletonPiece { from: at, anchor: at, length, strip });
            at += length;
        }
        let Some((first, last)) = pieces.first().zip(pieces.last()) else { return pieces };
        if self.closed {
            return pieces;
        }
        let straight = |piece: &SkeletonPiece, s: f64, t: Vec2| {
            let (p, _, n) = piece.jet(s, 0.0);
            Strip::Straight { p, t, n }
        };
        let (t0, t1) = (self.spines[0].0.moving(0.0).t, self.spines[self.spines.len() - 1].0.moving(1.0).t);
        let (before, after) = (straight(first, 0.0, t0), straight(last, last.length, t1));
        if !matches!(last.strip, Strip::Straight { .. }) {
            pieces.push(SkeletonPiece { from: at, anchor: at, length: 1.0, strip: after });
        }
        if matches!(pieces[0].strip, Strip::Straight { .. }) {
            pieces[0].from = f64::NEG_INFINITY;
        } else {
            pieces.insert(0, SkeletonPiece { from: f64::NEG_INFINITY, anchor: 0.0, length: 1.0, strip: before });
        }
        pieces
    }
}

/// The strips on a side of a polygon. Artwork turns near its corners: the sides are blended into a mitre within a few times what it
/// juts out at `height`, and stand straight on the rest of the line. On a line too short for that they are blended all along.
fn on_a_line(line: Line, mitres: [Vec2; 2], height: f64) -> Vec<(Strip, f64)> {
    /// Length of a blend as a multiple of the mitre's width: at the corner, artwork on its inner side keeps a third of its width, and
    /// with a factor of 2 none.
    const REACH: f64 = 3.0;
    let length = line.length();
    let t = (line.p1 - line.p0) / length;
    let between = |from: f64, to: f64, mitres: [Vec2; 2], smooth: bool| {
        let part = Line::new(line.p0 + t * from, line.p0 + t * to);
        let seg = Seg::Line(if to < length { part } else { Line::new(part.p0, line.p1) });
        let strip = if mitres == [Vec2::ZERO; 2] {
            Strip::Straight { p: part.p0, t, n: normal(t) }
        } else {
            Strip::Normals { spine: Spine::new(seg), table: ArcLength::of(&seg), mitres, even: 0.0, smooth }
        };
        (strip, to - from)
    };
    let [a, b] = mitres.map(|m| REACH * height * m.hypot());
    if !(a + b < length && height > 0.0) {
        return vec![between(0.0, length, mitres, false)];
    }
    let mut out = vec![between(a, length - b, [Vec2::ZERO; 2], false)];
    if a > 0.0 {
        out.insert(0, between(0.0, a, [mitres[0], Vec2::ZERO], true));
    }
    if b > 0.0 {
        out.push(between(length - b, length, [Vec2::ZERO, mitres[1]], true));
    }
    out
}

/// Returns `true` if a closed run goes counter-clockwise on the screen: its area, y down, is negative.
fn turns_left(sub: &Subpath) -> bool {
    /// Chords of a piece.
    const CHORDS: u32 = 32;
    let chord = |s: &Seg, i: u32| {
        let at = |i: u32| s.eval(f64::from(i) / f64::from(CHORDS)) - sub.start;
        at(i).cross(at(i + 1))
    };
    sub.segs.iter().map(|s| (0..CHORDS).map(|i| chord(s, i)).sum::<f64>()).sum::<f64>() < 0.0
}

/// Returns `true` if an open run ends left of its start. The ends of a whole circle are the same up to rounding.
fn runs_left(sub: &Subpath) -> bool {
    const SAME: f64 = 1e-9;
    let size = sub.segs.iter().map(|s| s.eval(0.5).distance(sub.start)).fold(0.0, f64::max);
    sub.start.x - sub.end().x > SAME * size
}

/// Returns `true` if the tangent of an open run turns through more than a whole turn from its start to its end.
fn winds(sub: &Subpath) -> bool {
    /// Chords of a piece. They turn through a little less than the piece itself.
    const CHORDS: u32 = 32;
    let points = sub.segs.iter().flat_map(|s| (0..=CHORDS).map(|i| s.eval(f64::from(i) / f64::from(CHORDS))));
    let (mut last, mut chord, mut turn) = (sub.start, Vec2::ZERO, 0.0);
    for p in points.filter(|p| p.is_finite()) {
        let next = p - last;
        if next != Vec2::ZERO {
            turn += if chord == Vec2::ZERO { 0.0 } else { chord.cross(next).atan2(chord.dot(next)) };
            (last, chord) = (p, next);
        }
    }
    turn.abs() > std::f64::consts::TAU
}

fn control_points(seg: &Seg) -> Vec<Point> {
    match seg {
        Seg::Line(s) => vec![s.p0, s.p1],
        Seg::Quad(s) => vec![s.p0, s.p1, s.p2],
        other => {
            let c = other.to_cubic();
            vec![c.p0, c.p1, c.p2, c.p3]
        }
    }
}

/// Returns the unit normals of the control polygon's legs. The outer ones are given, because they may be mitred; a leg without
/// length takes its neighbours' mean.
fn legs(points: &[Point], ends: [Vec2; 2]) -> Vec<Vec2> {
    let n = points.len() - 1;
    let size: f64 = points.windows(2).map(|p| p[0].distance(p[1])).sum();
    let mut out: Vec<Vec2> = Vec::with_capacity(n);
    for (i, p) in points.windows(2).enumerate() {
        let leg = p[1] - p[0];
        let own = (leg.hypot() > 1e-9 * size).then(|| normal(leg / leg.hypot()));
        out.push(match own {
            _ if i == 0 => ends[0],
            _ if i == n - 1 => ends[1],
            Some(own) => own,
            None => (ends[0] + ends[1]) * 0.5,
        });
    }
    out
}

/// Describes the joint of two pieces by the paper's conditions (4) and (5), in distances instead of parameters.
fn continuity(a: &SkeletonPiece, b: &SkeletonPiece, unit: f64) -> String {
    let ((p, a0, _), (_, a1, _)) = (a.jet(a.length, 0.0), a.jet(a.length, unit));
    let ((_, b0, _), (_, b1, _)) = (b.jet(0.0, 0.0), b.jet(0.0, unit));
    let same = |a: Vec2, b: Vec2| (a - b).hypot() <= 1e-6 * (a.hypot() + b.hypot());
    let along = |a: Vec2, b: Vec2| a.cross(b).abs() <= SMOOTH * a.hypot() * b.hypot() && a.dot(b) > 0.0;
    let what = if same(a0, b0) && same(a1, b1) {
        "C¹: smooth"
    } else if along(a0, b0) && along(a1, b1) {
        "G¹: directions are continuous, but lengths are stretched differently on both sides"
    } else if along(a0, b0) {
        "G¹ on the skeleton only: beside it, lines along the skeleton have a kink (handles condition)"
    } else {
        "C⁰: a corner"
    };
    format!("joint at {} is {what}", show(p))
}
