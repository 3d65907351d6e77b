//! Bending along a skeleton: the generalised algorithm of de Casteljau in space.
//!
//! Each leg of the skeleton's control polygon has two handles, s and t. A step of the algorithm is an affine map of all of space,
//! p + u·(q − p) + v·s + w·t, instead of a point on a leg, so that F(u, v, w) = C(u) + v·S(u) + w·T(u), with C the Bézier curve
//! of the control points and S and T those of the handles, one degree lower; handles of deeper levels add curves of still lower
//! degree (Y.-K. Chang and A. Rockwood, *A generalized de Casteljau approach to 3D free-form deformation*, SIGGRAPH 1994, equations 2
//! and 3). Where several pieces meet, and on splines, handles stand at the points instead: S and T are then curves like C, and lines along
//! the skeleton are as smooth as it is (equations 4 and 5).
//!
//! Barr's twist, taper and bend have the same form with other curves C, S and T (A. H. Barr, *Global and local deformations of
//! solid primitives*, SIGGRAPH 1984), and are exact here.

use super::entry::{About3, Built3, Case3, Entry, Law3};
use crate::map::{Chart, Creases3, Fraction3, Jet3, Local, Map3, Poly3, Swept, Tensor, for_all};
use crate::settings::{Box3, Settings3};
use glam::{DMat3, DQuat, DVec3};
use pathwarp::Error;
use pathwarp::deform::{Example, Info};
use pathwarp::engine::{Joint, bspline};
use pathwarp::param::{Kind, Param};
use pathwarp::setters;
use std::sync::Arc;

/// The curve that a model follows.
#[derive(Debug, Clone, PartialEq)]
pub enum Spine3 {
    /// Bézier pieces of this degree, 1 to 10, that share their ends.
    Bezier(Vec<DVec3>, usize),
    /// The control points of a uniform clamped B-spline of this degree, 1 to 10.
    Spline(Vec<DVec3>, usize),
    /// The points of a C² cubic spline with centripetal parameters.
    Through(Vec<DVec3>),
    /// Straight, and longer than the model by this factor.
    Stretch(f64),
    /// Straight, with sides of this factor in the middle.
    Swell(f64),
    /// Straight, with the sides turned by this angle (radians) from end to end: Barr's twist.
    Twist(f64),
    /// Straight, with the sides growing to this factor: Barr's taper.
    Taper(f64),
    /// A circular arc of the model's length that turns by this angle (radians): Barr's bend.
    Arc(f64),
}

/// A handle of a leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Handle3 {
    /// The level, from 1.
    pub level: usize,
    /// The number on that level, over all pieces, from 0; of a spline, the number of the point.
    pub index: usize,
    /// The image of a unit along the first axis after the one that follows the skeleton, if set.
    pub side: Option<DVec3>,
    /// The image of a unit along the second axis after it, if set.
    pub up: Option<DVec3>,
}

/// Bends a model along a curve.
///
/// ```
/// use glam::DVec3;
/// use pathwarp_solid::{Box3, deform::{Bend3, Spine3}, map::Map3};
///
/// let bar = Box3::new(DVec3::new(0.0, -1.0, -1.0), DVec3::new(10.0, 1.0, 1.0));
/// let twisted = Bend3::new(bar, Spine3::Twist(std::f64::consts::FRAC_PI_2)).build()?;
/// assert!((twisted.map.point(DVec3::new(10.0, 1.0, 0.0)) - DVec3::new(10.0, 0.0, 1.0)).length() < 1e-15);
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Bend3 {
    bounds: Box3,
    spine: Spine3,
    axis: usize,
    through: Option<DVec3>,
    handles: Vec<Handle3>,
}

impl Bend3 {
    /// Bends a model in this box. Its extent along x follows the curve.
    #[must_use]
    pub fn new(bounds: Box3, spine: Spine3) -> Self {
        Self { bounds, spine, axis: 0, through: None, handles: Vec::new() }
    }

    setters! {
        /// Sets the axis of the model that follows the curve: 0, 1 or 2.
        axis(axis: usize) => axis: axis.min(2);
        /// Sets a point of the line that becomes the curve. Defaults to the middle of the box.
        through(p: DVec3) => through: Some(p);
    }

    /// Adds a handle of a skeleton: of a leg of Bézier pieces, or of a point of a spline. Handles of the first level that are not set
    /// are perpendicular to their legs, of length 1, and turn as little as possible from leg to leg, or are their mitres at points; others
    /// are 0.
    #[must_use]
    pub fn handle(mut self, handle: Handle3) -> Self {
        self.handles.push(handle);
        self
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Usage`] for a flat box, a wrong number of points, legs without length, and handles that do not exist, vanish, or differ
    /// on both sides of a joint.
    pub fn build(&self) -> Result<Built3, Error> {
        let size = self.bounds.size()[self.axis];
        if !(size > 0.0 && size.is_finite()) {
            let name = ["x", "y", "z"][self.axis];
            return Err(Error::usage("along", name, "has no length: the model is flat along it; choose another axis"));
        }
        let through = self.through.unwrap_or(self.bounds.center());
        if let Some(h) = self.handles.iter().find(|h| h.level == 1 && [h.side, h.up].contains(&Some(DVec3::ZERO))) {
            let problem = "has no length: the model would collapse there; make it longer";
            return Err(Error::usage(param_of(h), h.index.to_string(), problem));
        }
        let (pieces, knots) = self.pieces(through)?;
        // The polyline for guides, with 16 segments for each piece.
        let points = pieces.iter().flat_map(|p| (0..=16).map(|i| p.curves_at(f64::from(i) / 16.0).values[0]));
        let skeleton: Vec<DVec3> = points.collect();
        let count = pieces.len();
        let [from, to] = [self.bounds.min, self.bounds.max].map(|p| p - through);
        let (b, c) = ((self.axis + 1) % 3, (self.axis + 2) % 3);
        let corners = [(from[b], from[c]), (to[b], from[c]), (to[b], to[c]), (from[b], to[c])];
        let first_level: Vec<_> = pieces.iter().flat_map(|p| p.first_level(corners)).collect();
        // Compares derivatives on both sides of a joint, along the skeleton and along the four edges of the box.
        let joint = |i: usize| {
            let before = (pieces[i - 1].curves_at(1.0), knots[i] - knots[i - 1]);
            let after = (pieces[i].curves_at(0.0), knots[i + 1] - knots[i]);
            let slopes = |(v, w)| [before, after].map(|(curves, width)| (curves.slope(v, w) / width).to_array());
            let DVec3 { x, y, z } = after.0.values[0];
            let lines: Vec<_> = [(0.0, 0.0)].into_iter().chain(corners).map(slopes).collect();
            Joint::new(format!("{x:.6},{y:.6},{z:.6}"), &lines)
        };
        let joints: Vec<Joint> = (1..count).map(joint).collect();
        let (axis, start) = (self.axis, self.bounds.min[self.axis]);
        let (pieces, knots) = (pieces.into(), knots.into());
        let mut built = Built3::new(Arc::new(BendMap3 { pieces, knots, axis, start, length: size, through }));
        let length: f64 = skeleton.windows(2).map(|w| w[0].distance(w[1])).sum();
        built.note(format!("skeleton: {count} pieces, {length:.6} long; the model is {size:.6} long along it"));
        built.notes.extend(joints.iter().map(Joint::described));
        built.warnings.extend(Joint::warning(&joints));
        built.guides.push(skeleton);
        built.guides.extend(first_level);
        Ok(built)
    }

    /// Returns the pieces and their ends, which are given as fractions of the model's length.
    fn pieces(&self, through: DVec3) -> Result<(Vec<Piece>, Vec<f64>), Error> {
        let mut from = through;
        from[self.axis] = self.bounds.min[self.axis];
        let along = DVec3::AXES[self.axis] * self.bounds.size()[self.axis];
        let sides = [DVec3::AXES[(self.axis + 1) % 3], DVec3::AXES[(self.axis + 2) % 3]];
        let straight = |length: f64, sizes: &[f64]| {
            let n = sizes.len() - 1;
            let points = (0..=n).map(|i| from + along * (length * i as f64 / n as f64)).collect();
            Piece::skeleton(points, vec![sizes.iter().map(|k| sides.map(|s| s * *k)).collect()])
        };
        let preset = match &self.spine {
            Spine3::Twist(angle) => Piece::Twist { from, along, sides, angle: *angle },
            // An arc with no turn is straight.
            Spine3::Arc(angle) if angle.abs() < 1e-12 => Piece::Twist { from, along, sides, angle: 0.0 },
            Spine3::Arc(angle) => Piece::Arc { from, along, sides, angle: *angle },
            Spine3::Taper(factor) => straight(1.0, &[1.0, *factor]),
            Spine3::Stretch(factor) => straight(*factor, &[1.0, 1.0]),
            // The middle of the quadratic (1, m, 1) is (1 + m)/2.
            Spine3::Swell(factor) => straight(1.0, &[1.0, 2.0 * factor - 1.0, 1.0]),
            Spine3::Bezier(points, degree) => {
                let pieces = self.bezier_pieces(points, *degree)?;
                let knots = even_knots(pieces.len());
                return Ok((pieces, knots));
            }
            Spine3::Spline(points, degree) => return self.spline(points, *degree),
            Spine3::Through(points) => return self.interpolated(points),
        };
        match self.handles.first() {
            Some(h) => {
                let problem = "goes with `skeleton` alone: a `preset` takes no handles";
                Err(Error::usage(param_of(h), h.index.to_string(), problem))
            }
            None => Ok((vec![preset], vec![0.0, 1.0])),
        }
    }

    /// Makes the pieces of a B-spline of this degree, whose points and handles together are control points in nine dimensions.
    fn spline(&self, points: &[DVec3], degree: usize) -> Result<(Vec<Piece>, Vec<f64>), Error> {
        if points.len() <= degree || !(1..=MAX_DEGREE).contains(&degree) {
            let needed = degree + 1;
            let needs = format!("a spline of degree {degree}, 1 to {MAX_DEGREE}, needs {needed} or more");
            return Err(Error::usage("skeleton", "", format!("has too few points: {needs}")));
        }
        let handles = self.handles_at_points(mitres(&self.least_turning(&directions(points)?)))?;
        let frames: Vec<[f64; 9]> = points.iter().zip(&handles).map(|(p, [s, t])| flat([*p, *s, *t])).collect();
        let part = |f: &[f64; 9], k: usize| DVec3::new(f[3 * k], f[3 * k + 1], f[3 * k + 2]);
        let piece = |f: Vec<[f64; 9]>| {
            let handles = f.iter().map(|f| [part(f, 1), part(f, 2)]).collect();
            Piece::skeleton(f.iter().map(|f| part(f, 0)).collect(), vec![handles])
        };
        let pieces: Vec<Piece> = bspline::pieces(degree, &frames, false).into_iter().map(piece).collect();
        let knots = even_knots(pieces.len());
        Ok((pieces, knots))
    }

    /// Makes the pieces of a cubic spline through points. Between them, S is the C¹ cubic whose derivative at the points is
    /// S' = −(S·C″)/|C'|²·C', which keeps S perpendicular to C without turning it about C; T is alike.
    fn interpolated(&self, points: &[DVec3]) -> Result<(Vec<Piece>, Vec<f64>), Error> {
        directions(points)?;
        let distances: Vec<f64> = points.windows(2).map(|p| p[0].distance(p[1])).collect();
        // Their sum is 1, so the last knot is 1.
        let widths = bspline::centripetal(&distances);
        let coordinates: Vec<[f64; 3]> = points.iter().map(DVec3::to_array).collect();
        let pieces = bspline::through(&coordinates, &widths, false).into_iter();
        let pieces: Vec<Vec<DVec3>> = pieces.map(|p| p.into_iter().map(DVec3::from).collect()).collect();
        let tangent =
            |p: &[DVec3], end: usize| (p[end + 1] - p[end]).try_normalize().unwrap_or((p[3] - p[0]).normalize());
        let mut tangents: Vec<DVec3> = pieces.iter().map(|p| tangent(p, 0)).collect();
        tangents.extend(pieces.last().map(|p| tangent(p, 2)));
        let handles = self.least_turning(&tangents).into_iter().map(|leg| leg.handles).collect();
        let handles = self.handles_at_points(handles)?;
        let piece = |(i, p): (usize, Vec<DVec3>)| {
            let [a, b, c] = [p[1] - p[0], p[2] - p[1], p[3] - p[2]];
            // The inner coefficients, from the derivatives S' and T' at the end next to them. The bound stands in for a leg `a` of no length.
            let inner = |pair: [DVec3; 2], a: DVec3| {
                pair.map(|h| h - a * (h.dot(b - a) / (1.5 * a.length_squared()).max(1e-18 * b.length_squared())))
            };
            let (g, h) = (handles[i], handles[i + 1]);
            Piece::skeleton(p, vec![vec![g, inner(g, a), inner(h, c), h]])
        };
        let mut knots = vec![0.0];
        widths.iter().for_each(|w| knots.push(knots[knots.len() - 1] + w));
        Ok((pieces.into_iter().enumerate().map(piece).collect(), knots))
    }

    /// Returns the handles at the points of a spline: `defaults`, replaced by the handles that are set.
    fn handles_at_points(&self, mut defaults: Vec<[DVec3; 2]>) -> Result<Vec<[DVec3; 2]>, Error> {
        let last = defaults.len() - 1;
        for h in &self.handles {
            let Some(pair) = defaults.get_mut(h.index).filter(|_| h.level == 1) else {
                let problem =
                    format!("is not a handle: a spline has them at its points, 0 to {last}, and no deeper level");
                return Err(Error::usage(param_of(h), format!("{},{}", h.level, h.index), problem));
            };
            *pair = [h.side.unwrap_or(pair[0]), h.up.unwrap_or(pair[1])];
        }
        Ok(defaults)
    }

    /// Makes Bézier pieces, with handles on their legs if any are set or there is one piece, and else at their points.
    fn bezier_pieces(&self, points: &[DVec3], degree: usize) -> Result<Vec<Piece>, Error> {
        if points.len() < 2 || !(1..=MAX_DEGREE).contains(&degree) || !(points.len() - 1).is_multiple_of(degree) {
            let (n, [one, two, three]) = (points.len(), [1, 2, 3].map(|pieces| pieces * degree + 1));
            let needs = format!("1 to {MAX_DEGREE}, that share their ends need {one}, {two}, {three} …");
            let problem = format!("has {n} points; pieces of degree {degree}, {needs}");
            return Err(Error::usage("skeleton", "", problem));
        }
        let pieces = (points.len() - 1) / degree;
        let legs = self.least_turning(&directions(points)?);
        if pieces > 1 && self.handles.is_empty() {
            // One point cannot have the mitres of both ends of a quadratic that turns by more than a right angle.
            if degree == 2 && legs.chunks(2).any(|l| l[0].direction.dot(l[1].direction) < 0.0) {
                let mut raised = vec![points[0]];
                let raise = |p: &[DVec3]| [p[0].lerp(p[1], 2.0 / 3.0), p[2].lerp(p[1], 2.0 / 3.0), p[2]];
                raised.extend(points.windows(3).step_by(2).flat_map(raise));
                return self.bezier_pieces(&raised, 3);
            }
            let mut handles = mitres(&legs);
            for i in (0..pieces).map(|i| i * degree).filter(|_| degree > 1) {
                // At both ends of a piece, S' and T' must be parallel to C', or lines along it would kink at smooth joints. Between mitres
                // within a right angle they are, as in quadratics that are not raised; else the inner mitre moves.
                for (end, inner, leg) in [(i, i + 1, i), (i + degree, i + degree - 1, i + degree - 1)] {
                    let (d, from, to) = (legs[leg].direction, handles[end], handles[inner]);
                    handles[inner] = [0, 1].map(|k| from[k] + d * d.dot(to[k] - from[k]));
                }
            }
            let part = |i: usize| i * degree..=(i + 1) * degree;
            let piece = |i: usize| Piece::skeleton(points[part(i)].to_vec(), vec![handles[part(i)].to_vec()]);
            return Ok((0..pieces).map(piece).collect());
        }
        let mut levels: Vec<Vec<[Option<DVec3>; 2]>> =
            (1..=degree).map(|j| vec![[None; 2]; pieces * (degree + 1 - j)]).collect();
        let mut deepest = 1;
        for h in &self.handles {
            let Some(pair) = levels.get_mut(h.level.wrapping_sub(1)).and_then(|l| l.get_mut(h.index)) else {
                let counts: Vec<String> =
                    (1..=degree).map(|j| format!("0 to {} on level {j}", pieces * (degree + 1 - j) - 1)).collect();
                let problem = format!("is not a handle: they are {}", counts.join(", "));
                return Err(Error::usage(param_of(h), format!("{},{}", h.level, h.index), problem));
            };
            *pair = [h.side.or(pair[0]), h.up.or(pair[1])];
            deepest = deepest.max(h.level);
        }
        // Both legs at a joint share one handle there.
        let mitres = mitres(&legs);
        for joint in (1..pieces).map(|i| i * degree) {
            for k in 0..2 {
                let either = levels[0][joint - 1][k].or(levels[0][joint][k]).unwrap_or(mitres[joint][k]);
                for leg in [joint - 1, joint] {
                    levels[0][leg][k].get_or_insert(either);
                }
            }
        }
        let handle = |j: usize, i: usize| -> [DVec3; 2] {
            let default = if j == 0 { legs[i].handles } else { [DVec3::ZERO; 2] };
            std::array::from_fn(|k| levels[j][i][k].unwrap_or(default[k]))
        };
        let piece = |i: usize| {
            let level = |j: usize| (i * (degree - j)..(i + 1) * (degree - j)).map(|n| handle(j, n)).collect();
            Piece::skeleton(points[i * degree..=(i + 1) * degree].to_vec(), (0..deepest).map(level).collect())
        };
        let out: Vec<Piece> = (0..pieces).map(piece).collect();
        for (i, p) in out.windows(2).enumerate() {
            let (a, b) = (p[0].curves_at(1.0).values, p[1].curves_at(0.0).values);
            if let Some(k) = (1..3).find(|k| (a[*k] - b[*k]).length() > 1e-6 * (a[*k].length() + b[*k].length())) {
                let problem = format!("differs on both sides of the end of piece {i}: the model would tear");
                return Err(Error::usage(["side", "up"][k - 1], (i * degree + degree - 1).to_string(), problem));
            }
        }
        Ok(out)
    }

    /// Returns for each direction two handles perpendicular to it, which turn as little as possible from one direction to the next.
    fn least_turning(&self, directions: &[DVec3]) -> Vec<Leg> {
        let mut previous = DVec3::AXES[self.axis];
        let mut side = DVec3::AXES[(self.axis + 1) % 3];
        let leg = |direction: &DVec3| {
            let turn = DQuat::from_rotation_arc(previous, *direction);
            side = (turn * side).reject_from_normalized(*direction).normalize();
            previous = *direction;
            Leg { direction: *direction, handles: [side, direction.cross(side)] }
        };
        directions.iter().map(leg).collect()
    }
}

/// A leg of a skeleton's polygon, or a tangent, with its handles s and t.
struct Leg {
    direction: DVec3,
    handles: [DVec3; 2],
}

/// Returns the ends of pieces of equal length, as fractions of the whole.
fn even_knots(pieces: usize) -> Vec<f64> {
    (0..=pieces).map(|i| i as f64 / pieces as f64).collect()
}

/// The highest degree of a skeleton.
const MAX_DEGREE: usize = 10;

/// Returns the directions of a polygon's legs.
fn directions(points: &[DVec3]) -> Result<Vec<DVec3>, Error> {
    let leg = |(i, p): (usize, &[DVec3])| {
        let problem = || format!("has two equal points, {i} and {}; move them apart", i + 1);
        (p[1] - p[0]).try_normalize().ok_or_else(|| Error::usage("skeleton", "", problem()))
    };
    points.windows(2).enumerate().map(leg).collect()
}

/// Returns the handles at the points of a polygon from the directions and handles of its legs. They are mitres: lines between
/// them at constant v and w are parallel to the leg. Beyond a turn by a right angle, they stay as long as there.
fn mitres(legs: &[Leg]) -> Vec<[DVec3; 2]> {
    let inner = legs.windows(2).map(|l| {
        let [Leg { direction: d, handles: a }, Leg { direction: e, handles: b }] = l else { return legs[0].handles };
        let c = 1.0 + d.dot(*e);
        let inwards = (e - d).normalize_or_zero();
        let growth = 2.0 / c.max(c.sqrt()) - 1.0;
        // The skeleton turns back.
        if c < 1e-9 {
            return *a;
        }
        std::array::from_fn(|k| {
            let mean = a[k].midpoint(b[k]);
            mean + inwards * (growth * mean.dot(inwards))
        })
    });
    std::iter::once(legs[0].handles).chain(inner).chain([legs[legs.len() - 1].handles]).collect()
}

/// Returns the name of the parameter that sets a handle.
fn param_of(h: &Handle3) -> &'static str {
    match (h.level, h.side) {
        (1, Some(_)) => "side",
        (1, None) => "up",
        _ => "shear",
    }
}

/// The map: pieces one after another along an axis of the model. `knots` are their ends as fractions of `length`, from `start` on; v and
/// w are measured from `through` along the two axes that follow `axis` in cyclic order.
#[derive(Debug, Clone, PartialEq)]
struct BendMap3 {
    pieces: Arc<[Piece]>,
    knots: Arc<[f64]>,
    axis: usize,
    start: f64,
    length: f64,
    through: DVec3,
}

impl BendMap3 {
    fn sides(&self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }

    /// Returns the index of the piece at a fraction of the length. The first and the last piece extend outside.
    fn piece(&self, s: f64) -> usize {
        self.knots[1..self.pieces.len()].partition_point(|k| *k <= s)
    }

    /// Returns the index of the piece that applies to a whole box, if there is just one.
    fn piece_on(&self, on: &Box3) -> Option<usize> {
        let [from, to] = [on.min, on.max].map(|p| (p[self.axis] - self.start) / self.length);
        // Rounding may put a joint on either side of the box's end.
        let slack = 1e-9 * (1.0 / self.pieces.len() as f64 + to.abs());
        let (from, to) = (self.piece(from + slack), self.piece(to - slack));
        // A flat box may lie in a joint, on which both pieces agree.
        (from >= to).then_some(from)
    }

    /// Returns the curves at a point, v, w, and the derivative of u along the axis.
    fn curves_at(&self, p: DVec3) -> (Curves, f64, f64, f64) {
        let s = (p[self.axis] - self.start) / self.length;
        let i = self.piece(s);
        let width = self.knots[i + 1] - self.knots[i];
        let [b, c] = self.sides();
        let curves = self.pieces[i].curves_at((s - self.knots[i]) / width);
        (curves, p[b] - self.through[b], p[c] - self.through[c], 1.0 / (self.length * width))
    }
}

impl Map3 for BendMap3 {
    fn jet(&self, p: DVec3) -> Jet3 {
        let (curves, v, w, rate) = self.curves_at(p);
        let mut columns = [DVec3::ZERO; 3];
        let [b, c] = self.sides();
        columns[self.axis] = curves.slope(v, w) * rate;
        (columns[b], columns[c]) = (curves.values[1], curves.values[2]);
        Jet3 { p: curves.value(v, w), d: DMat3::from_cols(columns[0], columns[1], columns[2]) }
    }

    fn points(&self, ps: &mut [DVec3]) {
        let [Piece::Skeleton { curves: tensor, .. }] = &*self.pieces else {
            ps.iter_mut().for_each(|p| *p = self.point(*p));
            return;
        };
        // The tensor's coordinate runs from −1 to 1 along the axis; the others are lengths.
        let (mut middle, mut scale) = (self.through, DVec3::ONE);
        middle[self.axis] = self.start + 0.5 * self.length;
        scale[self.axis] = 2.0 / self.length;
        for_all(&Swept { axis: self.axis, local: Local { middle, scale }, tensor }, ps);
    }

    fn point(&self, p: DVec3) -> DVec3 {
        let (curves, v, w, _) = self.curves_at(p);
        curves.value(v, w)
    }

    fn fraction(&self, on: &Box3, max: usize) -> Option<Fraction3> {
        let (chart, piece) = (Chart::on(on), self.piece_on(on)?);
        let Piece::Skeleton { points, handles, curves } = &self.pieces[piece] else { return None };
        if handles.len().max(points.len() - 1) > max {
            return None;
        }
        let (knot, width) = (self.knots[piece], self.knots[piece + 1] - self.knots[piece]);
        let axis = DVec3::AXES[self.axis] * (2.0 / (self.length * width));
        let x = chart.linear(axis.extend(-2.0 * (self.start / self.length + knot) / width - 1.0));
        let [v, w] = self.sides().map(|a| chart.linear(DVec3::AXES[a].extend(-self.through[a])));
        let curves = curves.in_terms_of(&[x, Poly3::default(), Poly3::default()]);
        let part = |k: usize| curves[k].plus(1.0, &curves[k + 3].times(&v)).plus(1.0, &curves[k + 6].times(&w));
        Some(Fraction3 { chart, parts: [part(0), part(1), part(2), Poly3::constant(1.0)] })
    }

    fn branch(&self, on: &Box3) -> Option<Arc<dyn Map3>> {
        let piece = self.piece_on(on)?;
        let [from, to] = [self.knots[piece], self.knots[piece + 1]];
        let (start, length) = (self.start + self.length * from, self.length * (to - from));
        let (pieces, knots) = ([self.pieces[piece].clone()].into(), [0.0, 1.0].into());
        Some(Arc::new(Self { pieces, knots, start, length, ..*self }))
    }

    fn creases(&self, out: &mut Creases3) {
        for knot in &self.knots[1..self.pieces.len()] {
            let (axis, at) = (self.axis, self.start + self.length * knot);
            out.kink(move |p| p[axis] - at);
        }
    }
}

/// A piece of a bend, F(u, v, w) = C(u) + v·S(u) + w·T(u), with u from 0 to 1.
#[derive(Debug, Clone, PartialEq)]
enum Piece {
    /// The generalised algorithm of de Casteljau, each step of which is an affine map with the handles s and t of its level.
    Skeleton {
        /// Control points.
        points: Vec<DVec3>,
        /// Pairs s, t of handles on the first level: on each leg of the polygon, or at each control point.
        handles: Vec<[DVec3; 2]>,
        /// C, S and T, in x = 2u − 1.
        curves: Tensor<9>,
    },
    /// A straight line `from` + u·`along` whose sides turn by `angle` (radians).
    Twist { from: DVec3, along: DVec3, sides: [DVec3; 2], angle: f64 },
    /// A circular arc as long as `along` that turns by `angle` (radians) towards the first side.
    Arc { from: DVec3, along: DVec3, sides: [DVec3; 2], angle: f64 },
}

/// The three curves at a parameter, with their derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Curves {
    /// C, S and T.
    values: [DVec3; 3],
    /// C', S' and T'.
    slopes: [DVec3; 3],
}

impl Curves {
    /// Returns F.
    fn value(&self, v: f64, w: f64) -> DVec3 {
        self.values[0] + self.values[1] * v + self.values[2] * w
    }

    /// Returns ∂F/∂u.
    fn slope(&self, v: f64, w: f64) -> DVec3 {
        self.slopes[0] + self.slopes[1] * v + self.slopes[2] * w
    }
}

/// Lists the coordinates of three vectors.
fn flat(v: [DVec3; 3]) -> [f64; 9] {
    std::array::from_fn(|k| v[k / 3][k % 3])
}

impl Piece {
    /// Makes a piece with pairs of handles by level: n on the first, n − 1 on the second, and so on; the last levels may be omitted. A
    /// single level may instead have a pair at every control point.
    fn skeleton(points: Vec<DVec3>, levels: Vec<Vec<[DVec3; 2]>>) -> Self {
        let n = points.len();
        let mut sum: Vec<[f64; 9]> = points.iter().map(|p| flat([*p, DVec3::ZERO, DVec3::ZERO])).collect();
        for level in &levels {
            let curve = level.iter().map(|[s, t]| flat([DVec3::ZERO, *s, *t])).collect();
            sum.iter_mut().zip(elevate(curve, n)).for_each(|(o, p)| *o = std::array::from_fn(|k| o[k] + p[k]));
        }
        let degree = levels[0].len() - 1;
        // The degree of S and T; their higher coefficients are rounding errors.
        let curves = Tensor::bernstein([n, 1, 1], sum).without(degree, 3);
        Self::Skeleton { points, handles: levels.into_iter().next().unwrap_or_default(), curves }
    }

    /// Returns polylines of the first level of the algorithm, which takes the model's box to every leg as in the paper's figure 1c.
    /// `corners` are the corners of the box across the skeleton.
    fn first_level(&self, corners: [(f64, f64); 4]) -> Vec<Vec<DVec3>> {
        let Self::Skeleton { points, handles, .. } = self else { return Vec::new() };
        // 1 if the handles are at the points, 0 if they are on the legs.
        let at_points = usize::from(handles.len() == points.len());
        let mut out = vec![points.clone()];
        for leg in 0..points.len() - 1 {
            let ends = [0, 1].map(|end| {
                let [s, t] = handles[leg + end * at_points];
                corners.map(|(v, w)| points[leg + end] + s * v + t * w)
            });
            out.extend(ends.map(|[a, b, c, d]| vec![a, b, c, d, a]));
            out.extend((0..4).map(|k| vec![ends[0][k], ends[1][k]]));
        }
        out
    }

    /// Returns the curves at `u`.
    fn curves_at(&self, u: f64) -> Curves {
        match self {
            Self::Skeleton { curves, .. } => {
                let jets = curves.jet(DVec3::new(2.0 * u - 1.0, 0.0, 0.0));
                let part = |k: usize, d: usize| DVec3::from_array(std::array::from_fn(|a| jets[3 * k + a][d]));
                Curves { values: [0, 1, 2].map(|k| part(k, 0)), slopes: [0, 1, 2].map(|k| part(k, 1) * 2.0) }
            }
            Self::Twist { from, along, sides: [s, t], angle } => {
                let (sin, cos) = (angle * u).sin_cos();
                let (side, up) = (*s * cos + *t * sin, *t * cos - *s * sin);
                Curves { values: [*from + *along * u, side, up], slopes: [*along, up * *angle, -side * *angle] }
            }
            Self::Arc { from, along, sides: [s, t], angle } => {
                let (sin, cos) = (angle * u).sin_cos();
                let (direction, radius) = (along.normalize_or_zero(), along.length() / angle);
                // 1 − cos without cancellation.
                let rise = 2.0 * (0.5 * angle * u).sin().powi(2);
                let center = *from + (direction * sin + *s * rise) * radius;
                let (tangent, side) = (direction * cos + *s * sin, *s * cos - direction * sin);
                let slopes = [tangent * along.length(), -tangent * *angle, DVec3::ZERO];
                Curves { values: [center, side, *t], slopes }
            }
        }
    }
}

/// Raises the degree of a curve until it has `n` control points.
fn elevate(mut curve: Vec<[f64; 9]>, n: usize) -> Vec<[f64; 9]> {
    while curve.len() < n {
        let k = curve.len() as f64;
        let between = |i: usize, a: f64| std::array::from_fn(|c| a * curve[i - 1][c] + (1.0 - a) * curve[i][c]);
        let inner = (1..curve.len()).map(|i| between(i, i as f64 / k));
        curve = std::iter::once(curve[0]).chain(inner).chain(curve.last().copied()).collect();
    }
    curve
}

/// The presets: Barr's deformations, and two of the same form. The frame of laws and cases below is from 0,0,0 to 100,100,100.
const PRESETS: &[&str] = &["stretch", "swell", "taper", "twist", "bend"];

static ABOUT: About3 = About3 {
    info: Info::new("bend", "bend, twist or taper a model along a skeleton")
        .group("Along a curve")
        .about("One axis of the model (--along) follows a skeleton of control points (--skeleton), a Bézier curve of degree 1 to 10, \
several in a row, a B-spline (--spline), or a smooth curve through the points (--interpolate). The model keeps its size across: each leg of \
the skeleton has two handles, the images of a unit along the other two axes, which are perpendicular to it unless they are set (--side, \
--up). Handles of deeper levels (--shear) shear parts of the model. A spline has its handles at its points, and they are blended as \
these are, so that lines along it are as smooth as it is. Pieces in a row whose handles are not set are smooth wherever the \
skeleton is; a warning names what still has kinks.\n\nOr use a preset: stretch lengthens the model by --factor, swell scales its middle, taper its \
far end, twist turns it about the axis by --angle, bend rolls it up into an arc of --angle. The last three are Barr's.")
        .source("Y.-K. Chang and A. Rockwood, A generalized de Casteljau approach to 3D free-form deformation, SIGGRAPH 1994; A. H. Barr, \
Global and local deformations of solid primitives, SIGGRAPH 1984")
        .params(&[
            Param::new("skeleton", Kind::Text("X,Y,Z …"), "Control points of the skeleton, separated by spaces or semicolons."),
            Param::new("degree", Kind::Count, "Degree of the skeleton's pieces, which share their ends, or of the B-spline. Default: 3, or less \
for a skeleton of two or three points.")
            .within(1.0, MAX_DEGREE as f64),
            Param::flag("spline", "The points are those of a uniform clamped B-spline."),
            Param::flag("interpolate", "The skeleton is a smooth curve through the points."),
            Param::new("along", Kind::Choice(&["x", "y", "z"]), "The model's axis that follows the skeleton. Its extent becomes the \
whole skeleton.")
            .default("x"),
            Param::new("through", Kind::Text("X,Y,Z"), "A point of the line in the model that becomes the skeleton. Default: the \
middle of the model's box."),
            Param::new("side", Kind::Text("I:DX,DY,DZ"), "The handle of leg I (from 0), or of a spline's point: the image of a unit along the \
axis after --along (y after x, z after y, x after z).")
                .repeated(),
            Param::new("up", Kind::Text("I:DX,DY,DZ"), "The other handle there: the image of a unit along the third axis.").repeated(),
            Param::new("shear", Kind::Text("LEVEL,I:DX,DY,DZ:DX,DY,DZ"), "Both handles number I (from 0) of a deeper level, from 2.")
                .repeated(),
            Param::new("preset", Kind::Choice(PRESETS), "Stretch, swell, taper, twist or bend instead of a skeleton."),
            Param::angle("angle", "Angle of the twist or bend over the model's length; turns from the axis after --along to the third, \
and bends towards the axis after --along.")
            .default("90"),
            Param::number("factor", "Length of a stretch, size of the middle of a swell or of the far end of a taper. Default: 150 %, of a \
taper 50 %.")
            .within(0.0, 100.0)
            .slider(0.0, 3.0),
        ])
        .demo(&[("skeleton", "0,50,50 33,50,50 66,55,45 100,70,40"), ("side", "1:0,1.2,0.1")])
        .examples(&[
            Example {
                what: "Twist a model by a quarter turn about its upright axis",
                command: "solid bend samples/solid/teapot.obj --preset twist --along y --angle 90 -o out.obj",
            },
            Example {
                what: "Make it narrower at the top",
                command: "solid bend samples/solid/teapot.obj --preset taper --along y --factor 60% -o out.obj",
            },
            Example {
                what: "Let it lean along a curve",
                command: "solid bend samples/solid/teapot.obj --along y --skeleton '50%,0%,50% 50%,50%,50% 60%,80%,50% 85%,100%,50%' -o out.obj",
            },
        ]),
    laws: &[
        Law3::Identity(&[("skeleton", "0,50,50 100,50,50")]),
        Law3::Identity(&[("skeleton", "50,0,50 50,25,50 50,50,50 50,75,50 50,100,50"), ("along", "y"), ("spline", "true"), ("degree", "1")]),
        Law3::Identity(&[("preset", "twist"), ("angle", "0")]),
        Law3::Identity(&[("preset", "taper"), ("factor", "1")]),
        Law3::Identity(&[("preset", "bend"), ("angle", "0"), ("along", "z")]),
        Law3::Volume(&[("preset", "twist"), ("angle", "200"), ("along", "z")], 1.0),
        Law3::KeepsLinesAlong(&[("preset", "twist"), ("angle", "200")], [0.0, 1.0, 0.7]),
        Law3::KeepsLinesAlong(&[("preset", "taper"), ("factor", "2")], [1.0, 0.0, 0.0]),
        Law3::KeepsLinesAlong(&[("skeleton", "0,50,50 40,50,50 80,60,40 100,110,30")], [0.0, 1.0, 0.3]),
        // A straight skeleton of any degree with handles of one size gives the map of a single leg.
        Law3::Same(
            &[("skeleton", "0,50,50 100,50,50"), ("side", "0:0,2,0")],
            &[("skeleton", "0,50,50 50,50,50 100,50,50"), ("side", "0:0,2,0 1:0,2,0")],
        ),
        Law3::Identity(&[("skeleton", "0,50,50 25,50,50 50,50,50 75,50,50 100,50,50"), ("interpolate", "true")]),
        Law3::Identity(&[("preset", "stretch"), ("factor", "1")]),
        Law3::Volume(&[("preset", "stretch"), ("factor", "1.5"), ("along", "y")], 1.5),
        // With three points, a B-spline of degree 2 is a Bézier curve.
        Law3::Same(
            &[("skeleton", "0,50,50 50,60,40 100,50,50"), ("side", "0:0,1,0 1:0,2,0 2:0,1,0"), ("up", "0:0,0,1 1:0,0,2 2:0,0,1"), ("spline", "true")],
            &[("skeleton", "0,50,50 33.333333333333336,56.666666666666664,43.333333333333336 66.66666666666667,56.666666666666664,43.333333333333336 100,50,50"),
              ("side", "0:0,1,0 1:0,2,0 2:0,1,0"), ("up", "0:0,0,1 1:0,0,2 2:0,0,1")],
        ),
        // A taper is a skeleton of degree 2 whose handles differ in length.
        Law3::Same(
            &[("preset", "taper"), ("factor", "0.4")],
            &[("skeleton", "0,50,50 50,50,50 100,50,50"), ("side", "1:0,0.4,0"), ("up", "1:0,0,0.4")],
        ),
    ],
    cases: &[
        // Halfway through a quarter turn, 10 to the side of the axis: turned by 45°.
        Case3 {
            args: &[("preset", "twist"), ("angle", "90")],
            at: [50.0, 60.0, 50.0],
            to: [50.0, 57.071_067_811_865_476, 57.071_067_811_865_476],
            tolerance: 1e-13,
        },
        // Barr's linear taper: halfway the sides are three quarters.
        Case3 { args: &[("preset", "taper"), ("along", "z")], at: [90.0, 10.0, 50.0], to: [80.0, 20.0, 50.0], tolerance: 1e-13 },
        // A quarter of a circle of circumference 400 has the radius 200/π.
        Case3 {
            args: &[("preset", "bend"), ("angle", "90")],
            at: [100.0, 50.0, 20.0],
            to: [63.661_977_236_758_13, 113.661_977_236_758_13, 20.0],
            tolerance: 1e-13,
        },
        // C(1/2) = (P0 + 3·P1 + 3·P2 + P3)/8, S(1/2) = (s0 + 2·s1 + s2)/4.
        Case3 {
            args: &[("skeleton", "0,0,0 40,0,0 80,0,0 100,40,0"), ("side", "0:0,1,0 1:0,1,0 2:0,3,0"), ("up", "0:0,0,1 1:0,0,1 2:0,0,1")],
            at: [50.0, 58.0, 53.0],
            to: [57.5, 17.0, 3.0],
            tolerance: 1e-13,
        },
    ],
};

/// Reads the deformation from text.
pub(in crate::deform) const ENTRY: Entry = Entry(&ABOUT, |s| {
    let axis = ["x", "y", "z"].iter().position(|n| Some(*n) == s.flat().choice("along").ok()).unwrap_or(0);
    let mut bend = Bend3::new(s.bounds(), spine(s)?).axis(axis);
    if let Some(p) = s.point_if("through")? {
        bend = bend.through(p);
    }
    for handle in handles(s)? {
        bend = bend.handle(handle);
    }
    bend.build()
});

fn spine(s: &Settings3<'_>) -> Result<Spine3, Error> {
    if s.flat().given("preset") {
        if let Some(name) = ["skeleton", "spline", "interpolate", "degree"].into_iter().find(|n| s.flat().given(n)) {
            let problem = "cannot go with `preset`, which has its own skeleton";
            return Err(Error::usage(name, s.words(name).join(" "), problem));
        }
        let angle = s.flat().number("angle")?.to_radians();
        let factor = s.flat().number_if("factor")?;
        return Ok(match s.flat().choice("preset")? {
            "stretch" => Spine3::Stretch(factor.unwrap_or(1.5)),
            "swell" => Spine3::Swell(factor.unwrap_or(1.5)),
            "taper" => Spine3::Taper(factor.unwrap_or(0.5)),
            "twist" => Spine3::Twist(angle),
            _ => Spine3::Arc(angle),
        });
    }
    if let Some(name) = ["angle", "factor"].into_iter().find(|n| s.flat().given(n)) {
        return Err(Error::usage(name, s.words(name).join(" "), "is for a `preset`, and there is none; omit it"));
    }
    let points = s.listed_points("skeleton")?;
    if points.len() < 2 {
        return Err(Error::missing("skeleton", "two or more points X,Y,Z, unless there is a `preset`"));
    }
    let (spline, interpolate) = (s.flat().flag("spline")?, s.flat().flag("interpolate")?);
    if let Some(name) = ["spline", "degree"].into_iter().find(|n| interpolate && s.flat().given(n)) {
        let problem = "cannot go with `interpolate`, which makes a cubic spline";
        return Err(Error::usage(name, s.words(name).join(" "), problem));
    }
    // The range has been checked, so the cast is exact.
    let degree = s.flat().number_if("degree")?.map_or((points.len() - 1).min(3), |d| d as usize);
    Ok(match (spline, interpolate) {
        (_, true) => Spine3::Through(points),
        (true, _) => Spine3::Spline(points, degree),
        _ => Spine3::Bezier(points, degree),
    })
}

/// Reads `side`, `up` and `shear`.
fn handles(s: &Settings3<'_>) -> Result<Vec<Handle3>, Error> {
    let mut out = Vec::new();
    for name in ["side", "up"] {
        for word in s.words(name) {
            let ([index], value) = s.flat().node_in::<1>(name, word)?;
            let v = s.vector_in(name, value)?;
            let (side, up) = if name == "side" { (Some(v), None) } else { (None, Some(v)) };
            out.push(Handle3 { level: 1, index, side, up });
        }
    }
    for word in s.words("shear") {
        let ([level, index], value) = s.flat().node_in::<2>("shear", word)?;
        let wrong = || Error::usage("shear", word, "is not LEVEL,I:DX,DY,DZ:DX,DY,DZ with a level from 2");
        let (side, up) = value.split_once(':').filter(|_| level >= 2).ok_or_else(wrong)?;
        let (side, up) = (s.vector_in("shear", side)?, s.vector_in("shear", up)?);
        out.push(Handle3 { level, index, side: Some(side), up: Some(up) });
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pathwarp::check::{Counted, operations};

    /// Counts the operations of a skeleton: the 9, 27 and 54 products and sums of the paper's table 1, which takes the legs q − p as given,
    /// and the operations for the three curves of one degree that batches evaluate.
    #[test]
    fn operations_of_a_skeleton() {
        for (n, published) in [(1usize, 9), (2, 27), (3, 54)] {
            let counts = operations(|| {
                let mut row = vec![[Counted(1.0); 3]; n + 1];
                let [u, v, w] = [0.3, 0.4, 0.5].map(Counted);
                for level in 1..=n {
                    for i in 0..=n - level {
                        let leg: [Counted; 3] = std::array::from_fn(|k| Counted(row[i + 1][k].0 - row[i][k].0));
                        row[i] = std::array::from_fn(|k| row[i][k] + u * leg[k] + v * 0.5 + w * 0.25);
                    }
                }
            });
            assert_eq!(counts, [published, published, 0], "degree {n}");
            let points = (0..=n).map(|i| DVec3::new(i as f64, 1.0, 0.0)).collect();
            let Piece::Skeleton { curves: tensor, .. } = Piece::skeleton(points, vec![vec![[DVec3::Y, DVec3::Z]; n]])
            else {
                panic!()
            };
            let ours = operations(|| {
                let c = tensor.value([0.3, 0.0, 0.0].map(Counted));
                let _: [Counted; 3] = std::array::from_fn(|k| c[k] + c[k + 3] * 0.4 + c[k + 6] * 0.5);
            });
            assert_eq!(ours, [9 * n + 6, 9 * n + 6, 0], "degree {n}");
        }
    }
}
