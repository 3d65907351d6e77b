//! The skeleton: the pieces of a path, measured, oriented and joined in a row. At corners the sides of both pieces meet in the mitre. The
//! parent module names the paper whose handles are an alternative to normals.

use super::map::{Curve, MovingFrame, Ribbon, SkeletonPiece, Spine, StripMap, normal};
use super::spline::{Part, directions, mitre};
use crate::error::{Error, show};
use crate::map::Joint;
use crate::map::curves::ArcLength;
use crate::outline::{Outline, Seg, Subpath};
use kurbo::{BezPath, Line, Point, Vec2};

/// A joint that turns by less than this angle (radians) is smooth.
const SMOOTH: f64 = 1e-6;
/// A corner that turns by less than this angle (radians) is invisible, and not reported.
const INVISIBLE: f64 = 5e-3;
/// Least 1 + cos of a turn. The mitre is √(2/(1 + cos)) times the height: eight times at this limit.
const SHARPEST: f64 = 1.0 / 32.0;

/// The measured pieces of a path.
pub(super) struct Skeleton {
    spines: Vec<(Spine, ArcLength)>,
    /// For a spline, every piece's handles at its control points and the distance of its knots; empty otherwise.
    spline_handles: Vec<(Vec<Vec2>, f64)>,
    pub(super) closed: bool,
    pub(super) length: f64,
    /// The height above the skeleton at which lengths are measured.
    even_height: f64,
    name: String,
}

/// A joint at which the tangent jumps.
pub(super) struct Corner {
    pub(super) at: Point,
    /// Radians.
    pub(super) turn: f64,
}

/// The pieces with their sides, and what is reported of their joints.
pub(super) struct Joined {
    pub(super) pieces: Vec<SkeletonPiece>,
    pub(super) corners: Vec<Corner>,
    pub(super) notes: Vec<String>,
    pub(super) warning: Option<String>,
}

/// Returns the segments of a subpath as pieces.
pub(super) fn parts_of_segments(sub: Subpath) -> Vec<Part> {
    let part = |s| Part { curve: Curve::Seg(s), handles: Vec::new(), width: 0.0 };
    sub.segs.into_iter().map(part).collect()
}

impl Skeleton {
    /// Measures the pieces of a path with this name. Unless `as_drawn`, a closed path is oriented clockwise, so that up is outside, and an
    /// open one left to right, unless it winds more than once. `reverse` then turns the path around.
    pub(super) fn new(
        (mut parts, closed, name): (Vec<Part>, bool, &str),
        as_drawn: bool,
        reverse: bool,
    ) -> Result<Self, Error> {
        let curves: Vec<&Curve> = parts.iter().map(|p| &p.curve).collect();
        let backwards = if closed { turns_left(&curves) } else { runs_left(&curves) && !winds(&curves) };
        if reverse != (backwards && !as_drawn) {
            parts = parts.into_iter().rev().map(Part::reversed).collect();
        }
        let measured: Vec<_> = parts.into_iter().map(|p| (measure(p.curve), (p.handles, p.width))).collect();
        let length: f64 = measured.iter().map(|((_, t), _)| t.length()).sum();
        if !(length > 0.0 && length.is_finite()) {
            return Err(Error::usage("along", name, "has no length"));
        }
        // Pieces shorter than this are left over by rounding.
        let real = measured.into_iter().filter(|((_, t), _)| t.length() > 1e-12 * length);
        let (spines, mut spline_handles): (Vec<_>, Vec<_>) = real.unzip();
        spline_handles.retain(|(handles, _)| !handles.is_empty());
        Ok(Self { spines, spline_handles, closed, length, even_height: 0.0, name: name.to_owned() })
    }

    /// Returns the curve, for a preview.
    pub(super) fn path(&self, tolerance: f64) -> BezPath {
        let segs: Vec<Seg> = self.spines.iter().flat_map(|(s, _)| s.curve.segs()).collect();
        let run = Subpath { start: self.spines[0].0.curve.eval(0.0), segs, closed: self.closed };
        Outline { subpaths: vec![run] }.to_bez_path(tolerance)
    }

    pub(super) fn has_arcs(&self) -> bool {
        self.spines.iter().any(|(s, _)| matches!(s.curve, Curve::Seg(Seg::Arc(_))))
    }

    /// Measures lengths at height `d`: along the offset curve, whose speed is (1 + κd) times the skeleton's.
    pub(super) fn at_height(mut self, d: f64) -> Result<Self, Error> {
        /// Samples of a piece.
        const SAMPLES: u32 = 256;
        /// Share of the skeleton's speed below which the offset is close to a cusp.
        const SLOWEST: f64 = 1e-3;
        let rate = move |s: &Spine, u: f64| 1.0 + s.moving_frame(u).curvature * d;
        for (spine, _) in &self.spines {
            let mut parameters = (0..=SAMPLES).map(|i| f64::from(i) / f64::from(SAMPLES));
            if let Some(u) = parameters.find(|u| rate(spine, *u).is_nan() || rate(spine, *u) < SLOWEST) {
                let problem = format!(
                    "needs a gentler bend: near {} the centre of curvature is no further from the skeleton than half the \
artwork's height; a smaller `width` helps too",
                    show(spine.curve.eval(u))
                );
                return Err(Error::usage("spacing", "even", problem));
            }
        }
        for (spine, table) in &mut self.spines {
            *table = ArcLength::new(&|u| spine.curve.deriv(u).hypot() * rate(spine, u));
        }
        let length = self.spines.iter().map(|(_, t)| t.length()).sum();
        Ok(Self { length, even_height: d, ..self })
    }

    /// Returns the scale k at which artwork of `width` is as long as the skeleton's offset at height k·`height`. The length of an offset
    /// is linear in the height, so that k·width = length + k·height·(total turn).
    pub(super) fn even_scale(&self, width: f64, height: f64) -> Result<f64, Error> {
        /// Samples of a piece, between which its tangent turns by less than half a circle.
        const SAMPLES: u32 = 256;
        let turn = |s: &Spine| {
            let tangent = |i: u32| s.moving_frame(f64::from(i) / f64::from(SAMPLES)).t;
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

    /// Converts arcs to cubics within `tolerance`, for the paper's handles. In a path of several pieces, quadratics that turn by more
    /// than a right angle become cubics too, because one inner point cannot have the mitres of both ends.
    pub(super) fn polynomial(mut self, tolerance: f64) -> Self {
        let several = self.spline_handles.is_empty() && (self.closed || self.spines.len() > 1);
        for (spine, table) in std::mem::take(&mut self.spines) {
            match spine.curve {
                Curve::Seg(Seg::Arc(a)) => {
                    self.spines.extend(a.to_cubics(tolerance).map(|c| measure(Curve::Seg(Seg::Cubic(c)))));
                }
                Curve::Seg(Seg::Quad(q)) if several && (q.p1 - q.p0).dot(q.p2 - q.p1) < 0.0 => {
                    self.spines.push((Spine::new(Curve::Seg(Seg::Cubic(q.raise()))), table));
                }
                _ => self.spines.push((spine, table)),
            }
        }
        self.length = self.spines.iter().map(|(_, t)| t.length()).sum();
        self
    }

    /// Returns the distance along the skeleton of its highest point on the screen, or of its lowest.
    pub(super) fn extreme(&self, lowest: bool) -> f64 {
        /// Samples of a piece. They decide the position of the artwork, not its shape.
        const SAMPLES: u32 = 256;
        let (mut least_y, mut distance, mut start) = (f64::INFINITY, 0.0, 0.0);
        for (spine, table) in &self.spines {
            for i in 0..=SAMPLES {
                let s = table.length() * f64::from(i) / f64::from(SAMPLES);
                let y = spine.curve.eval(table.parameter(s)).y;
                let y = if lowest { -y } else { y };
                if y < least_y {
                    (least_y, distance) = (y, start + s);
                }
            }
            start += table.length();
        }
        distance
    }

    /// Returns the indices of the pieces before and after each joint.
    fn joints(&self) -> impl Iterator<Item = (usize, usize)> {
        let n = self.spines.len();
        (0..if self.closed { n } else { n - 1 }).map(move |i| (i, (i + 1) % n))
    }

    /// Returns the sides at every piece's ends, unit normals or mitres at corners, and the corners.
    fn sides(&self) -> Result<(Vec<[Vec2; 2]>, Vec<Corner>), Error> {
        let ends: Vec<[MovingFrame; 2]> =
            self.spines.iter().map(|(s, _)| [s.moving_frame(0.0), s.moving_frame(1.0)]).collect();
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
            if turn.abs() > INVISIBLE {
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
            let (first, last) = (spine.moving_frame(0.0), spine.moving_frame(1.0));
            let mitres = [a - normal(first.t), b - normal(last.t)];
            match spine.curve {
                Curve::Seg(Seg::Line(line)) => strips.extend(polygon_side(line, mitres, height)),
                _ => {
                    let (spine, table, even_height, length) =
                        (spine.clone(), table.clone(), self.even_height, table.length());
                    strips.push((StripMap::Normals { spine, table, mitres, even_height, smooth: false }, length));
                }
            }
        }
        Ok(Joined { pieces: self.line_up(strips), corners, notes: Vec::new(), warning: None })
    }

    /// Joins pieces whose sides are the paper's handles, for artwork `unit` high between these `heights`. The handles are `given` for each
    /// level of each piece, or belong to a spline. Otherwise a single piece has the normals of its control polygon's sides, and several
    /// pieces have mitres at their points, which keep parallels smooth wherever the skeleton is (the paper's equation 5).
    pub(super) fn with_handles(
        self,
        given: Option<&[Vec<Vec<Vec2>>]>,
        (unit, heights): (f64, [f64; 2]),
        by_arc_length: bool,
    ) -> Result<Joined, Error> {
        let has_handles = given.is_some() || !self.spline_handles.is_empty();
        let (sides, corners) = if has_handles { (Vec::new(), Vec::new()) } else { self.sides()? };
        if let Some(given) = given.filter(|g| g.len() != self.spines.len()) {
            let problem = format!("has handles for {} pieces; the skeleton has {}", given.len(), self.spines.len());
            return Err(Error::input("handles", problem));
        }
        let single = !self.closed && self.spines.len() == 1;
        let ribbon = |(i, (spine, _)): (usize, &(Spine, ArcLength))| {
            let points = spine.curve.points();
            let Some(given) = given else {
                if let Some((handles, _)) = self.spline_handles.get(i) {
                    return Ok(Ribbon::with_handles_at_points(points, handles));
                }
                let legs: Vec<Vec2> = directions(&points, false).into_iter().map(|d| normal(d) * unit).collect();
                if let Some(ribbon) = Ribbon::new(points.clone(), &[legs]).filter(|_| single) {
                    return Ok(ribbon);
                }
                let handles: Vec<Vec2> = mitres(&points, sides[i]).into_iter().map(|h| h * unit).collect();
                return Ok(Ribbon::with_handles_at_points(points, &handles));
            };
            let degree = points.len() - 1;
            Ribbon::new(points, &given[i]).ok_or_else(|| {
                let wanted: Vec<String> = (1..=degree).rev().map(|n| n.to_string()).collect();
                let (wanted, lengths) = (wanted.join(", "), given[i].iter().map(Vec::len).collect::<Vec<_>>());
                let problem = format!(
                    "piece {} has degree {degree}: its levels need {wanted} handles; it has {lengths:?}",
                    i + 1
                );
                Error::input("handles", problem)
            })
        };
        let ribbons: Vec<Ribbon> = self.spines.iter().enumerate().map(ribbon).collect::<Result<_, _>>()?;
        for (i, j) in self.joints() {
            let (a, b) = (ribbons[i].side_at_end(1), ribbons[j].side_at_end(0));
            if (a - b).hypot() > 1e-6 * (a.hypot() + b.hypot()) {
                let (at, [ax, ay], [bx, by]) = (show(self.spines[j].0.curve.eval(0.0)), [a.x, a.y], [b.x, b.y]);
                let problem = format!(
                    "the handles on both sides of the joint at {at} differ: {ax:.6},{ay:.6} and {bx:.6},{by:.6}; the artwork would tear"
                );
                return Err(Error::input("handles", problem));
            }
        }
        // By parameter, the pieces of a spline are long in proportion to the distances of their knots.
        let knot_span: f64 = self.spline_handles.iter().map(|(_, width)| width).sum();
        let strips = self.spines.iter().zip(ribbons).enumerate().map(|(i, ((_, table), ribbon))| {
            let knots = self.spline_handles.get(i).filter(|_| !by_arc_length);
            let length = knots.map_or(table.length(), |(_, width)| self.length * width / knot_span);
            (StripMap::Ribbon { ribbon, unit, table: by_arc_length.then(|| table.clone()) }, length)
        });
        let pieces = self.line_up(strips.collect());
        // An open skeleton has a straight piece before its first one.
        let first = usize::from(!self.closed);
        let joint = |(i, j)| joint(&pieces[first + i], &pieces[first + j], heights);
        let joints: Vec<Joint> = self.joints().map(joint).collect();
        let (notes, warning) = (joints.iter().map(Joint::described).collect(), Joint::warning(&joints));
        Ok(Joined { pieces, corners, notes, warning })
    }

    /// Lines up strips of given lengths as pieces. An open skeleton continues straight at both ends, in pieces whose length is not used.
    fn line_up(&self, strips: Vec<(StripMap, f64)>) -> Vec<SkeletonPiece> {
        let mut pieces = Vec::with_capacity(strips.len() + 2);
        let mut start = 0.0;
        for (strip, length) in strips {
            pieces.push(SkeletonPiece { applies_from: start, start, length, strip });
            start += length;
        }
        let Some((first, last)) = pieces.first().zip(pieces.last()) else { return pieces };
        if self.closed {
            return pieces;
        }
        let straight = |piece: &SkeletonPiece, s: f64, t: Vec2| {
            let (p, _, n) = piece.jet(s, 0.0);
            StripMap::Straight { p, t, n }
        };
        let (t0, t1) = (self.spines[0].0.moving_frame(0.0).t, self.spines[self.spines.len() - 1].0.moving_frame(1.0).t);
        let (before, after) = (straight(first, 0.0, t0), straight(last, last.length, t1));
        if !matches!(last.strip, StripMap::Straight { .. }) {
            pieces.push(SkeletonPiece { applies_from: start, start, length: 1.0, strip: after });
        }
        if matches!(pieces[0].strip, StripMap::Straight { .. }) {
            pieces[0].applies_from = f64::NEG_INFINITY;
        } else {
            pieces.insert(0, SkeletonPiece { applies_from: f64::NEG_INFINITY, start: 0.0, length: 1.0, strip: before });
        }
        pieces
    }
}

/// Returns the strips on a side of a polygon, where `mitres` are what the corners' mitres add to the normal. Near the corners, normals are
/// blended into the mitres, over a few times the mitre's width at `height`. A line too short for that is blended all along.
fn polygon_side(line: Line, mitres: [Vec2; 2], height: f64) -> Vec<(StripMap, f64)> {
    /// Length of a blend as a multiple of the mitre's width. At the inner side of a corner, artwork keeps a third of its width; a
    /// factor of 2 would leave nothing of it.
    const BLEND: f64 = 3.0;
    let length = line.length();
    let t = (line.p1 - line.p0) / length;
    let between = |from: f64, to: f64, mitres: [Vec2; 2], smooth: bool| {
        let part = Line::new(line.p0 + t * from, line.p0 + t * to);
        let seg = Seg::Line(if to < length { part } else { Line::new(part.p0, line.p1) });
        let strip = if mitres == [Vec2::ZERO; 2] {
            StripMap::Straight { p: part.p0, t, n: normal(t) }
        } else {
            StripMap::Normals {
                spine: Spine::new(Curve::Seg(seg)),
                table: ArcLength::of_segment(&seg),
                mitres,
                even_height: 0.0,
                smooth,
            }
        };
        (strip, to - from)
    };
    let [a, b] = mitres.map(|m| BLEND * height * m.hypot());
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

/// Samples a run of curves, with its joints twice.
fn samples<'a>(curves: &'a [&Curve]) -> impl Iterator<Item = Point> + 'a {
    const CHORDS: u32 = 32;
    curves.iter().flat_map(|s| (0..=CHORDS).map(|i| s.eval(f64::from(i) / f64::from(CHORDS))))
}

/// Returns `true` if a closed run goes counter-clockwise on the screen: with y down, its area is negative.
fn turns_left(curves: &[&Curve]) -> bool {
    let start = curves.first().map_or(Point::ORIGIN, |c| c.eval(0.0));
    let points: Vec<Vec2> = samples(curves).map(|p| p - start).collect();
    points.windows(2).map(|p| p[0].cross(p[1])).sum::<f64>() < 0.0
}

/// Returns `true` if an open run ends left of its start. Rounding does not count: a whole circle ends at its start.
fn runs_left(curves: &[&Curve]) -> bool {
    const ROUNDING: f64 = 1e-9;
    let (Some(first), Some(last)) = (curves.first(), curves.last()) else { return false };
    let start = first.eval(0.0);
    let size = curves.iter().map(|s| s.eval(0.5).distance(start)).fold(0.0, f64::max);
    start.x - last.eval(1.0).x > ROUNDING * size
}

/// Returns `true` if the tangent of an open run turns by more than a whole turn from its start to its end. Chords turn slightly less.
fn winds(curves: &[&Curve]) -> bool {
    let points: Vec<Point> = samples(curves).filter(|p| p.is_finite()).collect();
    let (mut chord, mut turn) = (Vec2::ZERO, 0.0);
    for next in points.windows(2).map(|p| p[1] - p[0]).filter(|next| *next != Vec2::ZERO) {
        turn += if chord == Vec2::ZERO { 0.0 } else { chord.cross(next).atan2(chord.dot(next)) };
        chord = next;
    }
    turn.abs() > std::f64::consts::TAU
}

/// Returns a piece with the table of its arc length.
fn measure(curve: Curve) -> (Spine, ArcLength) {
    let table = ArcLength::new(&|u| curve.deriv(u).hypot());
    (Spine::new(curve), table)
}

/// Returns handles at the control points of a piece, with the given ones at its ends and mitres of the control polygon between them. The
/// handle next to an end differs from that at the end only along the polygon's leg, so that handles turn there as unit normals do.
fn mitres(points: &[Point], ends: [Vec2; 2]) -> Vec<Vec2> {
    let (n, legs) = (points.len() - 1, directions(points, false));
    let inner = legs.windows(2).map(|d| mitre(normal(d[0]), normal(d[1])));
    let mut out: Vec<Vec2> = std::iter::once(ends[0]).chain(inner).chain([ends[1]]).collect();
    if n > 1 {
        out[1] = ends[0] + legs[0] * legs[0].dot(out[1] - ends[0]);
        out[n - 1] = ends[1] + legs[n - 1] * legs[n - 1].dot(out[n - 1] - ends[1]);
    }
    out
}

/// Compares the derivatives along the skeleton on both sides of a joint, with respect to distances instead of parameters.
fn joint(a: &SkeletonPiece, b: &SkeletonPiece, [low, high]: [f64; 2]) -> Joint {
    let line = |d: f64| [a.jet(a.length, d).1, b.jet(0.0, d).1].map(|v| [v.x, v.y]);
    Joint::new(show(b.point(0.0, 0.0)), &[0.0, low, high].map(line))
}
