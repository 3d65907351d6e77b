//! Reads eyes, nets, surfaces and mirrors from text.

use super::net::{Push, PushedNet};
use super::scene::Eye;
use super::{Look, Mirror, MirrorShape, Onto};
use crate::error::Error;
use crate::param::{Axis, Settings};

/// Reads the eye: in the drawing, until another parameter gives its distance, or at infinity. DZ points towards the viewer, unlike z.
pub(super) fn eye(s: &Settings<'_>) -> Result<Eye, Error> {
    let Some(text) = s.texts("eye").pop().filter(|t| t.starts_with("inf")) else {
        return Ok(Eye::At(s.point("eye")?, 0.0));
    };
    let wrong =
        || Error::usage("eye", text, "is not inf:DX,DY, inf:DX,DY,DZ or inf: and two angles such as 30deg,20deg");
    let parts: Vec<&str> = text.strip_prefix("inf:").ok_or_else(wrong)?.split(',').map(str::trim).collect();
    let number = |text: &str| s.number_in("eye", text);
    Ok(Eye::Infinite(match parts[..] {
        [right, up] if right.ends_with(char::is_alphabetic) => {
            let [right, up] = [s.angle_in("eye", right)?.to_radians(), s.angle_in("eye", up)?.to_radians()];
            [right.sin() * up.cos(), -up.sin(), -right.cos() * up.cos()]
        }
        [x, y] => [number(x)?, number(y)?, 0.0],
        [x, y, z] => [number(x)?, number(y)?, -number(z)?],
        _ => return Err(wrong()),
    }))
}

/// Reads the view in which the surface is drawn.
pub(super) fn look(s: &Settings<'_>) -> Result<Look, Error> {
    let Some(text) = s.texts("view").pop() else {
        return Ok(if s.flag("seen")? { Look::Eye } else { Look::Unrolled });
    };
    if s.flag("seen")? {
        return Err(Error::usage("view", text, "cannot go with `seen`; omit one of them"));
    }
    let parts: Vec<&str> = text.split(',').collect();
    let [x, y, z] = parts[..] else {
        return Err(Error::usage("view", text, "is not a point X,Y,Z"));
    };
    let p = s.point_in("view", &format!("{x},{y}"))?;
    Ok(Look::From([p.x, p.y, s.length_in("view", z, Axis::X)?]))
}

/// Reads the control points; `None` if none of their parameters is given.
pub(super) fn net(s: &Settings<'_>) -> Result<Option<PushedNet>, Error> {
    const NAMES: [&str; 6] = ["reference", "degree", "push", "away", "at", "point"];
    if !NAMES.iter().any(|n| s.given(n)) {
        return Ok(None);
    }
    let reference = s.texts("reference").pop().map(|text| s.points_in("reference", text)).transpose()?;
    let text = s.texts("degree").pop().unwrap_or("1");
    let triangle = reference.as_ref().is_some_and(|r| r.len() == 3);
    let (m, n) = if triangle { (text, text) } else { text.split_once('x').unwrap_or((text, text)) };
    let wrong = || Error::usage("degree", text, "is not a degree: a number from 1 to 10, or for a box two such as 3x2");
    let degree = |part: &str| part.trim().parse().ok().filter(|n| (1..=10).contains(n)).ok_or_else(wrong);
    let degree = [degree(m)?, degree(n)?];
    // The control point that a value begins with, and the rest of the value.
    let node = |name: &str, text: &str| -> Result<([usize; 3], String), Error> {
        if triangle {
            return s.node_in::<3>(name, text).map(|(node, rest)| (node, rest.to_owned()));
        }
        s.node_in::<2>(name, text).map(|([i, j], rest)| ([i, j, 0], rest.to_owned()))
    };
    let mut pushes = Vec::new();
    for text in s.texts("push") {
        let (node, rest) = node("push", text)?;
        pushes.push(Push::By(node, s.number_in("push", &rest)?));
    }
    for text in s.texts("away") {
        let (node, rest) = node("away", text)?;
        pushes.push(Push::Away(node, s.length_in("away", &rest, Axis::Diagonal)?));
    }
    for text in s.texts("at") {
        let (node, rest) = node("at", text)?;
        pushes.push(Push::To(node, s.point_in("at", &rest)?));
    }
    for text in s.texts("point") {
        let (point, factor) = text.rsplit_once(':').ok_or_else(|| Error::usage("point", text, "is not X,Y:FACTOR"))?;
        let infinite = s.texts("eye").pop().is_some_and(|t| t.starts_with("inf"));
        let value =
            if infinite { s.length_in("point", factor, Axis::Diagonal)? } else { s.number_in("point", factor)? };
        pushes.push(Push::Prescribe(s.point_in("point", point)?, value));
    }
    Ok(Some(PushedNet { reference: reference.unwrap_or_default(), degree, pushes }))
}

/// The parts of `KIND:WORD,NAME=VALUE,…`.
struct Words<'t> {
    param: &'static str,
    text: &'t str,
    kind: &'t str,
    /// Words, and names with their values.
    list: Vec<(&'t str, Option<&'t str>)>,
}

impl<'t> Words<'t> {
    fn new(param: &'static str, text: &'t str) -> Self {
        let (kind, rest) = text.split_once(':').unwrap_or((text, ""));
        let list = rest.split(',').map(str::trim).filter(|w| !w.is_empty());
        let list = list.map(|w| w.split_once('=').map_or((w, None), |(n, v)| (n.trim(), Some(v.trim()))));
        Self { param, text, kind: kind.trim(), list: list.collect() }
    }

    fn has(&self, name: &str) -> bool {
        self.list.contains(&(name, None))
    }

    fn value(&self, name: &str) -> Option<&'t str> {
        self.list.iter().find(|w| w.0 == name).and_then(|w| w.1)
    }

    fn wrong(&self, problem: impl Into<String>) -> Error {
        Error::usage(self.param, self.text, problem)
    }

    /// Refuses words not in `words`, names with values not in `names`, and what is given twice.
    fn only(&self, words: &[&str], names: &[&str]) -> Result<(), Error> {
        for (name, value) in &self.list {
            let known = if value.is_some() { names } else { words };
            if !known.contains(name) {
                let (kind, names) = (self.kind, names.iter().map(|n| format!("{n}=…")));
                let all = words.iter().map(|w| (*w).to_owned()).chain(names).collect::<Vec<_>>().join(", ");
                return Err(self.wrong(format!("has “{name}”, which a {kind} does not have; it has {all}")));
            }
            if self.list.iter().filter(|w| w.0 == *name).count() > 1 {
                return Err(self.wrong(format!("has “{name}” twice; give it once")));
            }
        }
        Ok(())
    }

    /// Reads a positive length.
    fn size(&self, s: &Settings<'_>, name: &str) -> Result<Option<f64>, Error> {
        let Some(text) = self.value(name) else { return Ok(None) };
        let v = s.length_in(self.param, text, Axis::X)?;
        if v > 0.0 && v < 1e9 { Ok(Some(v)) } else { Err(self.wrong(format!("has a {name} that is not positive"))) }
    }

    fn radius(&self, s: &Settings<'_>) -> Result<f64, Error> {
        self.radius_at(s, "radius", "diameter")
    }

    /// Reads a radius by one of two names.
    fn radius_at(&self, s: &Settings<'_>, radius: &str, diameter: &str) -> Result<f64, Error> {
        match (self.size(s, radius)?, self.size(s, diameter)?) {
            (Some(r), None) => Ok(r),
            (None, Some(d)) => Ok(d / 2.0),
            (Some(_), Some(_)) => Err(self.wrong(format!("has a {radius} and a {diameter}; give one"))),
            (None, None) => Err(self.wrong(format!("needs {radius}=… or {diameter}=…, such as {diameter}=80mm"))),
        }
    }
}

/// Reads the surface.
pub(super) fn onto(s: &Settings<'_>, text: &str) -> Result<Onto, Error> {
    let w = Words::new("onto", text);
    match w.kind {
        "plane" => plane(s, &w),
        "cylinder" => {
            // The axis of a level cylinder is horizontal.
            w.only(&["inside", "level"], &["radius", "diameter"])?;
            Ok(Onto::Cylinder { radius: w.radius(s)?, level: w.has("level"), inside: w.has("inside") })
        }
        "cone" => {
            if let Some((end, _)) = w.list.iter().find(|(name, _)| ["top", "bottom"].contains(name)) {
                let problem =
                    format!("has “{end}”, which could be a radius or a diameter: {end}-radius=… or {end}-diameter=…");
                return Err(w.wrong(problem));
            }
            let names = ["top-radius", "top-diameter", "bottom-radius", "bottom-diameter", "height", "slant"];
            w.only(&["inside"], &names)?;
            let (top, bottom) = (w.radius_at(s, names[0], names[1])?, w.radius_at(s, names[2], names[3])?);
            let height = match (w.size(s, "height")?, w.size(s, "slant")?) {
                (Some(_), Some(_)) => return Err(w.wrong("has a height and a slant; give one")),
                (height, None) => height,
                (None, Some(slant)) => {
                    let height = (slant * slant - (top - bottom).powi(2)).sqrt();
                    let problem = "has a slant that is too short; make it longer than the difference of the radii";
                    Some(Some(height).filter(|h| *h > 0.0).ok_or_else(|| w.wrong(problem))?)
                }
            };
            Ok(Onto::Cone { top, bottom, height, inside: w.has("inside") })
        }
        "sphere" if w.has("eye") => {
            w.only(&["eye"], &[])?;
            Ok(Onto::Dome)
        }
        "sphere" => {
            w.only(&["inside"], &["radius", "diameter"])?;
            Ok(Onto::Sphere { radius: w.radius(s)?, inside: w.has("inside") })
        }
        _ => Err(w.wrong("is not a surface; there are plane:…, cylinder:…, cone:… and sphere:…")),
    }
}

/// Reads the mirror.
pub(super) fn mirror(s: &Settings<'_>) -> Result<Option<Mirror>, Error> {
    let foot = if s.given("foot") { Some(s.point("foot")?) } else { None };
    let Some(text) = s.texts("mirror").pop() else {
        let missing = || Error::missing("mirror", "the mirror whose foot this is");
        return if foot.is_some() { Err(missing()) } else { Ok(None) };
    };
    let w = Words::new("mirror", text);
    let known = ["radius", "diameter", "height", "lift", "tilt"];
    let shape = match w.kind {
        "cylinder" => {
            w.only(&[], &known)?;
            MirrorShape::Cylinder(w.radius(s)?, w.size(s, "height")?)
        }
        "cone" => {
            w.only(&[], &known)?;
            let height = w.size(s, "height")?.ok_or_else(|| w.wrong("needs height=…, such as height=60mm"))?;
            MirrorShape::Cone(w.radius(s)?, height)
        }
        "sphere" => {
            w.only(&[], &["radius", "diameter", "lift"])?;
            MirrorShape::Sphere(w.radius(s)?)
        }
        _ => return Err(w.wrong("is not a mirror; there are cylinder:…, cone:… and sphere:…")),
    };
    let tilt = w.value("tilt").map_or(Ok(0.0), |text| s.angle_in("mirror", text))?;
    let lift = w.value("lift").map_or(Ok(0.0), |text| s.length_in("mirror", text, Axis::Y))?;
    Ok(Some(Mirror { shape, tilt, lift, at: foot }))
}

/// Reads a plane.
fn plane(s: &Settings<'_>, w: &Words<'_>) -> Result<Onto, Error> {
    w.only(&["floor", "ceiling", "left", "right"], &["ramp", "wall"])?;
    let angle = |text: &Option<&str>| s.angle_in("onto", text.unwrap_or("0"));
    match &w.list[..] {
        [("floor", None)] => Ok(Onto::Floor),
        [("ceiling", None)] => Ok(Onto::Ceiling),
        [("left", None)] => Ok(Onto::LeftWall),
        [("right", None)] => Ok(Onto::RightWall),
        [("ramp", text)] => Ok(Onto::Ramp(angle(text)?)),
        [("wall", text)] => Ok(Onto::Wall(angle(text)?)),
        _ => Err(w.wrong(
            "is not one of plane:floor, plane:ceiling, plane:left, plane:right, plane:ramp=ANGLE, plane:wall=ANGLE",
        )),
    }
}
