//! The surfaces that artwork is projected onto.

use super::camera::Camera;
use super::scene::Scene;
use super::surface::{Anamorphosis, Radial, Round, SpacePlane, Sphere, Surface};
use crate::error::{Error, show};
use kurbo::{Point, Rect};

/// A surface that artwork is projected onto. Lengths in user units, angles in degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Onto {
    /// The ground under the artwork's bottom edge.
    Floor,
    /// A plane above its top edge.
    Ceiling,
    /// A side wall along its left edge.
    LeftWall,
    /// A side wall along its right edge.
    RightWall,
    /// Ground that rises by an angle away from the eye.
    Ramp(f64),
    /// A vertical wall, its right side turned away by an angle.
    Wall(f64),
    /// A cylinder whose front touches the artwork's middle.
    Cylinder {
        /// The radius.
        radius: f64,
        /// The axis is horizontal.
        level: bool,
        /// It is seen from inside.
        inside: bool,
    },
    /// A vertical cone whose front touches the artwork's middle.
    Cone {
        /// The radius at the top.
        top: f64,
        /// The radius at the bottom.
        bottom: f64,
        /// The height; the artwork's if `None`.
        height: Option<f64>,
        /// It is seen from inside.
        inside: bool,
    },
    /// A sphere whose front touches the artwork's middle. It cannot be laid flat.
    Sphere {
        /// The radius.
        radius: f64,
        /// It is seen from inside.
        inside: bool,
    },
    /// A sphere through the eye, a dome with the eye on its near pole: lines become circles.
    Dome,
}

impl Onto {
    /// Returns the text that means this surface.
    fn text(self) -> String {
        let inside = |inside: bool| if inside { ",inside" } else { "" };
        match self {
            Self::Floor => "plane:floor".into(),
            Self::Ceiling => "plane:ceiling".into(),
            Self::LeftWall => "plane:left".into(),
            Self::RightWall => "plane:right".into(),
            Self::Ramp(a) => format!("plane:ramp={a}"),
            Self::Wall(a) => format!("plane:wall={a}"),
            Self::Cylinder { radius, level, inside: i } => {
                format!("cylinder:radius={radius}{}{}", if level { ",level" } else { "" }, inside(i))
            }
            Self::Cone { top, bottom, inside: i, .. } => format!("cone:top={top},bottom={bottom}{}", inside(i)),
            Self::Sphere { radius, inside: i } => format!("sphere:radius={radius}{}", inside(i)),
            Self::Dome => "sphere:eye".into(),
        }
    }

    fn wrong(self, problem: impl Into<String>) -> Error {
        Error::usage("onto", self.text(), problem)
    }

    /// Returns the angle of a floor or ramp, radians.
    fn rise(self) -> Option<f64> {
        match self {
            Self::Floor => Some(0.0),
            Self::Ramp(a) => Some(a.to_radians()),
            _ => None,
        }
    }

    /// Returns the surface in space.
    pub(super) fn surface(self, scene: &Scene, distance: f64) -> Result<Surface, Error> {
        let r = scene.frame;
        let middle = r.center();
        let positive = |name: &str, v: f64| {
            if v > 0.0 && v < 1e9 { Ok(v) } else { Err(self.wrong(format!("has a {name} that is not positive"))) }
        };
        match self {
            Self::Cylinder { radius, level, inside } => {
                let radius = positive("radius", radius)?;
                Ok(Surface::Round(Round { middle, radius, slope: 0.0, level, inside }))
            }
            Self::Cone { top, bottom, height, inside } => {
                let (top, bottom) = (positive("top", top)?, positive("bottom", bottom)?);
                let height = height.unwrap_or(r.height());
                if height <= 0.0 {
                    return Err(self.wrong("needs a height=… for artwork that has none"));
                }
                let (radius, slope) = ((top + bottom) / 2.0, (bottom - top) / height);
                Ok(Surface::Round(Round { middle, radius, slope, level: false, inside }))
            }
            Self::Sphere { radius, inside } => {
                Ok(Surface::Sphere(Sphere { middle, radius: positive("radius", radius)?, inside }))
            }
            Self::Dome => Ok(Surface::Radial(Radial::stereographic(scene.eye, distance, r))),
            _ => self.plane(scene, distance).map(Surface::Plane),
        }
    }

    fn plane(self, scene: &Scene, distance: f64) -> Result<SpacePlane, Error> {
        let r = scene.frame;
        let c = r.center();
        let upright = |angle: f64| [-angle.sin(), 0.0, angle.cos()];
        let (at, normal) = match (self, self.rise()) {
            (_, Some(a)) => (Point::new(c.x, r.y1), [0.0, exact(a.cos()), a.sin()]),
            (Self::Ceiling, _) => (Point::new(c.x, r.y0), [0.0, -1.0, 0.0]),
            (Self::LeftWall, _) => (Point::new(r.x0, c.y), [-1.0, 0.0, 0.0]),
            (Self::RightWall, _) => (Point::new(r.x1, c.y), [1.0, 0.0, 0.0]),
            (Self::Wall(a), _) => (c, upright(a.to_radians()).map(exact)),
            _ => (c, upright(0.0).map(exact)),
        };
        let through = [at.x, at.y, 0.0];
        let eye = [scene.eye.x, scene.eye.y, -distance];
        let gap: f64 = (0..3).map(|i| normal[i] * (through[i] - eye[i])).sum();
        if gap <= 1e-9 * distance {
            return Err(self.wrong(format!(
                "is seen from behind or edge-on by an eye at {}, {distance} in front; move the eye to its front side, for a floor above it",
                show(scene.eye)
            )));
        }
        Ok(SpacePlane::new(through, normal, at))
    }
}

/// The cosine of a right angle is zero.
fn exact(v: f64) -> f64 {
    if v.abs() < 1e-15 { 0.0 } else { v }
}

/// Returns the scale at which artwork `drawn` high becomes `length` long on the floor or ramp.
pub(super) fn scale_for(
    onto: Option<Onto>,
    length: f64,
    drawn: f64,
    eye_height: Option<f64>,
    distance: f64,
) -> Result<f64, Error> {
    let Some(angle) = onto.and_then(Onto::rise) else {
        let problem = "is for `onto plane:floor` and plane:ramp=ANGLE; elsewhere use `picture-width`";
        return Err(Error::usage("length", "", problem));
    };
    let Some(eye) = eye_height else {
        return Err(Error::missing("eye-height", "the height of the eye above the floor; `length` needs it"));
    };
    let (up, away) = (length * angle.sin(), length * angle.cos());
    let seen = eye + (up - eye) * distance / (distance + away);
    if seen > 0.0 && distance + away > 0.0 && drawn > 0.0 {
        return Ok(seen / drawn);
    }
    let problem = "is impossible: from there, so long a stretch of this ground is not seen from its front";
    Err(Error::usage("length", "", problem))
}

/// Samples the artwork's box.
fn samples(r: Rect) -> impl Iterator<Item = Point> {
    const N: u32 = 16;
    let at = move |i: u32, j: u32| {
        let (u, v) = (f64::from(i) / f64::from(N), f64::from(j) / f64::from(N));
        Point::new(r.x0 + u * r.width(), r.y0 + v * r.height())
    };
    (0..=N).flat_map(move |i| (0..=N).map(move |j| at(i, j)))
}

/// Refuses a surface that a ray through the artwork's box misses.
pub(super) fn check_met(onto: Option<Onto>, cast: &Anamorphosis, frame: Rect) -> Result<(), Error> {
    let missed = samples(frame).find(|p| cast.defined(*p).max(0.0) == 0.0);
    let Some(p) = missed else { return Ok(()) };
    let advice = match cast.surface {
        Surface::Plane(_) => {
            "the ray there never comes down on the plane; raise the eye, go nearer, or make the artwork smaller (`picture-width`, `length`)"
        }
        Surface::Radial(_) => "the control points are pushed through infinity there; push them less",
        _ => "the ray there misses the surface; make the artwork smaller (`picture-width`) or the radius larger",
    };
    let problem = format!("does not hold the artwork's box: at {} {advice}", show(p));
    Err(onto.map_or_else(|| Error::usage("push", "", problem.clone()), |onto| onto.wrong(problem.clone())))
}

/// Refuses a camera that has part of the image behind it.
pub(super) fn check_in_view(text: &str, cast: &Anamorphosis, camera: &Camera, frame: Rect) -> Result<(), Error> {
    match samples(frame).find(|p| camera.depth_of(cast.point(*p)) <= 0.0) {
        Some(p) => {
            let problem = format!("is too near: the image of {} lies behind it; go further away", show(p));
            Err(Error::usage("view", text, problem))
        }
        None => Ok(()),
    }
}
