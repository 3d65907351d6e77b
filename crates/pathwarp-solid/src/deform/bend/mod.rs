//! Bending along a skeleton: the generalised algorithm of de Casteljau in space.
//!
//! Each leg of the skeleton's control polygon has two handles, s and t. A step of the algorithm is an affine map of all of space,
//! p + u·(q − p) + v·s + w·t, instead of a point on a leg, so that F(u, v, w) = C(u) + v·S(u) + w·T(u), with C the Bézier curve
//! of the control points and S and T those of the handles, one degree lower; handles of deeper levels add curves of still lower
//! degree. (The paper: *Free-form deformations with a generalized de Casteljau algorithm*, equations 2 and 3.) Pieces of degree 1
//! to 3, or the pieces of a B-spline, follow each other.
//!
//! Barr's twist, taper and bend have the same form with other curves C, S and T (A. H. Barr, *Global and local deformations of
//! solid primitives*, SIGGRAPH 1984), and are exact here.

mod entry;
mod map;
mod strip;

pub(super) use entry::Entry;

use super::built::Built3;
use crate::box3::Box3;
use glam::{DQuat, DVec3};
use map::BendMap3;
use pathwarp::Error;
use pathwarp::map::bspline;
use std::sync::Arc;
use strip::Strip;

/// The curve that a model follows.
#[derive(Debug, Clone, PartialEq)]
pub enum Spine3 {
    /// Bézier pieces of this degree, 1 to 3, that share their ends.
    Bezier(Vec<DVec3>, usize),
    /// The control points of a uniform clamped B-spline of this degree.
    Spline(Vec<DVec3>, usize),
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
    /// Its level, from 1.
    pub level: usize,
    /// Its number on that level, over all pieces, from 0.
    pub index: usize,
    /// The image of a unit along the first axis after the one that follows the skeleton, if it is set.
    pub side: Option<DVec3>,
    /// The image of a unit along the second.
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
    /// Bends a model in this box, whose extent along x follows the curve.
    #[must_use]
    pub fn new(bounds: Box3, spine: Spine3) -> Self {
        Self { bounds, spine, axis: 0, through: None, handles: Vec::new() }
    }

    /// Sets the axis of the model that follows the curve: 0, 1 or 2.
    #[must_use]
    pub fn axis(self, axis: usize) -> Self {
        Self { axis: axis.min(2), ..self }
    }

    /// Sets a point of the line that becomes the curve. Default: the middle of the box.
    #[must_use]
    pub fn through(self, p: DVec3) -> Self {
        Self { through: Some(p), ..self }
    }

    /// Sets handles of a skeleton of Bézier pieces. Handles of the first level that are not set are perpendicular to their legs,
    /// of length 1, and turn as little as possible from leg to leg; others are 0.
    #[must_use]
    pub fn handle(mut self, handle: Handle3) -> Self {
        self.handles.push(handle);
        self
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Usage`] for a flat box, a wrong number of points, legs without length, and handles that do not exist.
    pub fn build(&self) -> Result<Built3, Error> {
        let size = self.bounds.size()[self.axis];
        if !(size > 0.0 && size.is_finite()) {
            let name = ["x", "y", "z"][self.axis];
            return Err(Error::usage("along", name, "has no length: the model is flat along it; choose another axis"));
        }
        let through = self.through.unwrap_or(self.bounds.center());
        let pieces = self.pieces(through)?;
        let mut skeleton = Vec::new();
        for piece in &pieces {
            skeleton.extend((0..=16).map(|i| piece.stand(f64::from(i) / 16.0).at[0]));
        }
        let count = pieces.len();
        let (axis, start) = (self.axis, self.bounds.min[self.axis]);
        let mut built = Built3::new(Arc::new(BendMap3::new(pieces.into(), axis, start, size, through)));
        let length: f64 = skeleton.windows(2).map(|w| w[0].distance(w[1])).sum();
        built.note(format!("skeleton: {count} pieces, {length:.6} long; the model is {size:.6} long along it"));
        built.guides.push(skeleton);
        Ok(built)
    }

    fn pieces(&self, through: DVec3) -> Result<Vec<Strip>, Error> {
        let straight = matches!(self.spine, Spine3::Twist(_) | Spine3::Taper(_) | Spine3::Arc(_));
        if let Some(h) = self.handles.first().filter(|_| straight || matches!(self.spine, Spine3::Spline(..))) {
            let problem = "is a handle, and only a skeleton of Bézier pieces takes handles";
            return Err(Error::usage(param_of(h), h.index.to_string(), problem));
        }
        let mut from = through;
        from[self.axis] = self.bounds.min[self.axis];
        let along = DVec3::AXES[self.axis] * self.bounds.size()[self.axis];
        let sides = [DVec3::AXES[(self.axis + 1) % 3], DVec3::AXES[(self.axis + 2) % 3]];
        match &self.spine {
            Spine3::Twist(angle) => Ok(vec![Strip::Twist { from, along, sides, angle: *angle }]),
            Spine3::Taper(factor) => Ok(vec![Strip::Taper { from, along, sides, factor: *factor }]),
            // An arc that turns by nothing is straight.
            Spine3::Arc(angle) if angle.abs() < 1e-12 => Ok(vec![Strip::Twist { from, along, sides, angle: 0.0 }]),
            Spine3::Arc(angle) => Ok(vec![Strip::Arc { from, along, sides, angle: *angle }]),
            Spine3::Bezier(points, degree) => self.ribbons(points, *degree),
            Spine3::Spline(points, degree) => {
                if points.len() <= *degree || !(1..=3).contains(degree) {
                    let problem =
                        format!("has too few points: a spline of degree {degree} needs {} or more", degree + 1);
                    return Err(Error::usage("skeleton", "", problem));
                }
                let cells = bspline::extraction(*degree, points.len() - degree);
                let bezier = |(cell, rows): (usize, &Vec<Vec<f64>>)| -> Vec<DVec3> {
                    rows.iter().map(|row| row.iter().zip(&points[cell..]).map(|(k, p)| *p * *k).sum()).collect()
                };
                let pieces: Vec<Vec<DVec3>> = cells.iter().enumerate().map(bezier).collect();
                let mut joined = vec![pieces[0][0]];
                joined.extend(pieces.iter().flat_map(|p| &p[1..]).copied());
                self.ribbons(&joined, *degree)
            }
        }
    }

    /// Bézier pieces with handles.
    fn ribbons(&self, points: &[DVec3], degree: usize) -> Result<Vec<Strip>, Error> {
        let wrong = |problem: String| Error::usage("skeleton", "", problem);
        if points.len() < 2 || !(1..=3).contains(&degree) || !(points.len() - 1).is_multiple_of(degree) {
            let (n, k) = (points.len(), degree);
            return Err(wrong(format!(
                "has {n} points; pieces of degree {k} that share their ends need {}, {}, {} …",
                k + 1,
                2 * k + 1,
                3 * k + 1
            )));
        }
        let legs = points.len() - 1;
        let mut first = self.turning_least(points).map_err(wrong)?;
        let pieces = legs / degree;
        let mut deeper: Vec<Vec<[DVec3; 2]>> =
            (2..=degree).map(|j| vec![[DVec3::ZERO; 2]; pieces * (degree + 1 - j)]).collect();
        let mut deepest = 1;
        for h in &self.handles {
            let level = if h.level == 1 { Some(&mut first) } else { deeper.get_mut(h.level.wrapping_sub(2)) };
            let Some(pair) = level.and_then(|l| l.get_mut(h.index)) else {
                let counts: Vec<String> =
                    (1..=degree).map(|j| format!("0 to {} on level {j}", pieces * (degree + 1 - j) - 1)).collect();
                let problem = format!("is not a handle: they are {}", counts.join(", "));
                return Err(Error::usage(param_of(h), format!("{},{}", h.level, h.index), problem));
            };
            *pair = [h.side.unwrap_or(pair[0]), h.up.unwrap_or(pair[1])];
            deepest = deepest.max(h.level);
        }
        let piece = |i: usize| {
            let mut levels = vec![first[i * degree..(i + 1) * degree].to_vec()];
            for (j, all) in (2..=deepest).zip(&deeper) {
                let n = degree + 1 - j;
                levels.push(all[i * n..(i + 1) * n].to_vec());
            }
            Strip::Ribbon { points: points[i * degree..=(i + 1) * degree].to_vec(), levels }
        };
        Ok((0..pieces).map(piece).collect())
    }

    /// Handles perpendicular to their legs that turn as little as possible from leg to leg. The error ends a sentence about the
    /// skeleton.
    fn turning_least(&self, points: &[DVec3]) -> Result<Vec<[DVec3; 2]>, String> {
        let mut out: Vec<[DVec3; 2]> = Vec::new();
        let mut previous = DVec3::AXES[self.axis];
        let mut side = DVec3::AXES[(self.axis + 1) % 3];
        for (i, leg) in points.windows(2).enumerate() {
            let direction = (leg[1] - leg[0]).try_normalize();
            let direction =
                direction.ok_or_else(|| format!("has two equal points, {i} and {}; move them apart", i + 1))?;
            side = (DQuat::from_rotation_arc(previous, direction) * side).reject_from_normalized(direction).normalize();
            out.push([side, direction.cross(side)]);
            previous = direction;
        }
        Ok(out)
    }
}

fn param_of(h: &Handle3) -> &'static str {
    match (h.level, h.side) {
        (1, Some(_)) => "side",
        (1, None) => "up",
        _ => "shear",
    }
}
