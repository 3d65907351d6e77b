//! What the artwork is thrown onto, as the user writes it.

use super::camera::Camera;
use super::scene::Scene;
use super::surface::{Anamorphosis, Radial, Round, Space, SpacePlane, Sphere, Surface};
use crate::error::Error;
use crate::param::{Axis, Settings};
use kurbo::{Point, Rect};

/// `KIND:WORD,NAME=VALUE,…` taken apart.
struct Words<'t> {
    text: &'t str,
    kind: &'t str,
    list: Vec<(&'t str, Option<&'t str>)>,
}

impl<'t> Words<'t> {
    fn new(text: &'t str) -> Self {
        let (kind, rest) = text.split_once(':').unwrap_or((text, ""));
        let list = rest.split(',').map(str::trim).filter(|w| !w.is_empty());
        let list = list.map(|w| w.split_once('=').map_or((w, None), |(n, v)| (n.trim(), Some(v.trim()))));
        Self { text, kind: kind.trim(), list: list.collect() }
    }

    fn has(&self, name: &str) -> bool {
        self.list.contains(&(name, None))
    }

    fn value(&self, name: &str) -> Option<&'t str> {
        self.list.iter().find(|w| w.0 == name).and_then(|w| w.1)
    }

    fn wrong(&self, problem: impl Into<String>) -> Error {
        Error::usage("onto", self.text, problem)
    }

    /// Nothing but these words may be there.
    fn only(&self, switches: &[&str], values: &[&str]) -> Result<(), Error> {
        for (name, value) in &self.list {
            let known = if value.is_some() { values } else { switches };
            if !known.contains(name) {
                let all: Vec<String> =
                    switches.iter().map(|s| (*s).to_owned()).chain(values.iter().map(|v| format!("{v}=…"))).collect();
                return Err(self.wrong(format!(
                    "has `{name}`, which a {} does not know; it knows {}",
                    self.kind,
                    all.join(", ")
                )));
            }
        }
        Ok(())
    }

    fn size(&self, s: &Settings<'_>, name: &str) -> Result<Option<f64>, Error> {
        let Some(text) = self.value(name) else { return Ok(None) };
        let v = s.length_in("onto", text, Axis::X)?;
        if v > 0.0 && v < 1e9 { Ok(Some(v)) } else { Err(self.wrong(format!("has a {name} that is not positive"))) }
    }

    fn radius(&self, s: &Settings<'_>) -> Result<f64, Error> {
        match (self.size(s, "radius")?, self.size(s, "diameter")?) {
            (Some(r), None) => Ok(r),
            (None, Some(d)) => Ok(d / 2.0),
            _ => Err(self.wrong(format!("needs radius=… or diameter=…, such as {}:radius=40mm", self.kind))),
        }
    }
}

/// Reads `onto`.
pub(super) fn surface(s: &Settings<'_>, text: &str, scene: &Scene, distance: f64) -> Result<Surface, Error> {
    let w = Words::new(text);
    let r = scene.frame;
    let middle = r.center();
    match w.kind {
        "plane" => plane(s, &w, scene, distance).map(Surface::Plane),
        "cylinder" => {
            w.only(&["inside", "level"], &["radius", "diameter"])?;
            let radius = w.radius(s)?;
            Ok(Surface::Round(Round { middle, radius, slope: 0.0, level: w.has("level"), inside: w.has("inside") }))
        }
        "cone" => {
            w.only(&["inside"], &["top", "bottom", "height"])?;
            let (Some(top), Some(bottom)) = (w.size(s, "top")?, w.size(s, "bottom")?) else {
                return Err(w.wrong(
                    "needs the radii at the top and the bottom, such as cone:top=45mm,bottom=30mm,height=100mm",
                ));
            };
            let height = w.size(s, "height")?.unwrap_or(r.height());
            if height <= 0.0 {
                return Err(w.wrong("needs a height=… for artwork that has none"));
            }
            let slope = (bottom - top) / height;
            Ok(Surface::Round(Round {
                middle,
                radius: (top + bottom) / 2.0,
                slope,
                level: false,
                inside: w.has("inside"),
            }))
        }
        "sphere" if w.has("eye") => {
            w.only(&["eye"], &[])?;
            Ok(Surface::Radial(Radial::stereographic(scene.eye, distance, r)))
        }
        "sphere" => {
            w.only(&["inside"], &["radius", "diameter"])?;
            Ok(Surface::Sphere(Sphere { middle, radius: w.radius(s)?, inside: w.has("inside") }))
        }
        _ => Err(w.wrong("is no surface; there are plane:…, cylinder:…, cone:… and sphere:…")),
    }
}

/// The angle of a floor or ramp, if it is one.
fn rise(s: &Settings<'_>, w: &Words<'_>) -> Result<Option<f64>, Error> {
    if w.kind != "plane" {
        return Ok(None);
    }
    if w.has("floor") {
        return Ok(Some(0.0));
    }
    w.value("ramp").map(|t| s.angle_in("onto", t).map(f64::to_radians)).transpose()
}

fn plane(s: &Settings<'_>, w: &Words<'_>, scene: &Scene, distance: f64) -> Result<SpacePlane, Error> {
    w.only(&["floor", "ceiling", "left", "right"], &["ramp", "wall"])?;
    if w.list.len() != 1 {
        return Err(w.wrong(
            "is not one of plane:floor, plane:ceiling, plane:left, plane:right, plane:ramp=ANGLE, plane:wall=ANGLE",
        ));
    }
    let r = scene.frame;
    let c = r.center();
    let upright = |angle: f64| [-angle.sin(), 0.0, angle.cos()];
    let (at, normal) = if let Some(a) = rise(s, w)? {
        (Point::new(c.x, r.y1), [0.0, exact(a.cos()), a.sin()])
    } else if w.has("ceiling") {
        (Point::new(c.x, r.y0), [0.0, -1.0, 0.0])
    } else if w.has("left") {
        (Point::new(r.x0, c.y), [-1.0, 0.0, 0.0])
    } else if w.has("right") {
        (Point::new(r.x1, c.y), [1.0, 0.0, 0.0])
    } else {
        let a = s.angle_in("onto", w.value("wall").unwrap_or("0"))?.to_radians();
        (c, upright(a).map(exact))
    };
    let through = [at.x, at.y, 0.0];
    let eye = [scene.eye.x, scene.eye.y, -distance];
    let gap: f64 = (0..3).map(|i| normal[i] * (through[i] - eye[i])).sum();
    if gap <= 1e-9 * distance {
        return Err(w.wrong(format!(
            "is seen from behind or edge-on by an eye at {}, {distance} in front; move the eye to its front side, for a floor above it",
            crate::error::show(scene.eye)
        )));
    }
    Ok(SpacePlane::new(through, normal, at))
}

/// The cosine of a right angle is zero.
fn exact(v: f64) -> f64 {
    if v.abs() < 1e-15 { 0.0 } else { v }
}

/// The scale at which the artwork becomes `length` long on the floor or ramp.
pub(super) fn scale_for(s: &Settings<'_>, length: f64, eye_height: Option<f64>, distance: f64) -> Result<f64, Error> {
    let text = s.texts("onto").pop().unwrap_or("");
    let Some(angle) = rise(s, &Words::new(text))? else {
        return Err(Error::usage(
            "length",
            "",
            "is for `onto plane:floor` and plane:ramp=ANGLE; elsewhere use `picture-width`",
        ));
    };
    let Some(eye) = eye_height else {
        return Err(Error::Missing {
            param: "eye-height".into(),
            hint: "how high the eye is above the floor; `length` needs it".into(),
        });
    };
    let (up, away) = (length * angle.sin(), length * angle.cos());
    let seen = eye + (up - eye) * distance / (distance + away);
    let drawn = s.frame().rect.height();
    if seen > 0.0 && distance + away > 0.0 && drawn > 0.0 {
        return Ok(seen / drawn);
    }
    Err(Error::usage(
        "length",
        "",
        "cannot be had: from there, so long a stretch of this ground is not seen from its front",
    ))
}

/// A grid over the artwork's box.
fn places(r: Rect) -> impl Iterator<Item = Point> {
    const N: u32 = 16;
    let at = move |i: u32, j: u32| {
        let (u, v) = (f64::from(i) / f64::from(N), f64::from(j) / f64::from(N));
        Point::new(r.x0 + u * r.width(), r.y0 + v * r.height())
    };
    (0..=N).flat_map(move |i| (0..=N).map(move |j| at(i, j)))
}

/// Every ray through the artwork's box must meet the surface.
pub(super) fn must_be_met(s: &Settings<'_>, cast: &Anamorphosis, frame: Rect) -> Result<(), Error> {
    let missed = places(frame).find(|p| cast.defined(*p).max(0.0) == 0.0);
    let Some(p) = missed else { return Ok(()) };
    let advice = match cast.surface {
        Surface::Plane(_) => {
            "the ray there never comes down on the plane; raise the eye, go nearer, or make the artwork smaller (`picture-width`, `length`)"
        }
        Surface::Radial(_) => "the control points are pushed through infinity there; push them less",
        _ => "the ray there misses the surface; make the artwork smaller (`picture-width`) or the radius larger",
    };
    let name = if s.given("onto") { "onto" } else { "push" };
    let text = s.texts(name).pop().unwrap_or("");
    Err(Error::usage(name, text, format!("does not hold the artwork's box: at {} {advice}", crate::error::show(p))))
}

/// Where `view` stands.
pub(super) fn view(s: &Settings<'_>, text: &str, scene: &Scene) -> Result<Space, Error> {
    let parts: Vec<&str> = text.split(',').collect();
    let [x, y, z] = parts[..] else {
        return Err(Error::usage("view", text, "is not a place X,Y,Z"));
    };
    let p = scene.scale * s.point_in("view", &format!("{x},{y}"))?;
    Ok([p.x, p.y, -s.length_in("view", z, Axis::X)?])
}

/// Nothing may lie behind the camera.
pub(super) fn must_be_in_view(text: &str, cast: &Anamorphosis, camera: &Camera, frame: Rect) -> Result<(), Error> {
    match places(frame).find(|p| camera.depth_of(cast.point(*p)) <= 0.0) {
        Some(p) => Err(Error::usage(
            "view",
            text,
            format!("is too near: the image of {} lies behind it; go further away", crate::error::show(p)),
        )),
        None => Ok(()),
    }
}
