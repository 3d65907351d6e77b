//! The control points and where they are pushed.

use super::dilation::{Dilation, Reference};
use super::scene::Scene;
use super::surface::SpacePlane;
use crate::deform::built::Built;
use crate::error::{Error, GeometryError};
use crate::param::{Axis, Settings};
use kurbo::{Point, Rect, Shape};

/// The parameters that belong to the net.
pub(super) const NAMES: [&str; 6] = ["reference", "degree", "push", "away", "at", "point"];

/// The net with its control points pushed; the eye is `distance` in front of the drawing.
pub(super) fn dilation(s: &Settings<'_>, scene: &Scene, distance: f64) -> Result<Dilation, Error> {
    let reference = reference(s, scene)?;
    let mut out = Dilation::none(reference);
    let far = |p: Point| (p - scene.eye).hypot().hypot(distance);
    let sound = |name: &str, text: &str, delta: f64| {
        if delta.is_finite() && (1e-6..1e6).contains(&delta) {
            return Ok(delta);
        }
        Err(Error::usage(name, text, "would take the point through the eye, or out of reach; push it less"))
    };
    for text in s.texts("push") {
        let (node, rest) = node(s, "push", text, &reference)?;
        out.set(node, sound("push", text, 1.0 / s.number_in("push", rest)?)?);
    }
    for text in s.texts("away") {
        let (node, rest) = node(s, "away", text, &reference)?;
        let d = far(reference.point(node));
        out.set(node, sound("away", text, d / (d + s.length_in("away", rest, Axis::Diagonal)?))?);
    }
    for text in s.texts("at") {
        if distance > 0.0 {
            return Err(Error::usage(
                "at",
                text,
                "says a place in the drawing, but the eye is in front of it; use `push` or `away`",
            ));
        }
        let (node, rest) = node(s, "at", text, &reference)?;
        let ray = reference.point(node) - scene.eye;
        let along = (s.point_in("at", rest)? - scene.eye).dot(ray) / ray.hypot2();
        out.set(node, sound("at", text, 1.0 / along)?);
    }
    let local = s.flag("local")?;
    let sides = reference.corners().len();
    let held = |node: [usize; 3]| match reference {
        Reference::Triangle(..) => reference.on_side(node, 0),
        Reference::Rectangle(..) => local && (0..sides).any(|k| reference.on_side(node, k)),
    };
    for text in s.texts("point") {
        let wrong = || Error::usage("point", text, "is not X,Y:FACTOR");
        let (place, factor) = text.rsplit_once(':').ok_or_else(wrong)?;
        let p = scene.scale * s.point_in("point", place)?;
        let delta = sound("point", text, 1.0 / s.number_in("point", factor)?)?;
        let moved = out.prescribe(p, delta, held).ok_or_else(|| {
            Error::usage("point", text, "is on a side that is held, or there is no control point free to move; raise `degree` or choose another `reference`")
        })?;
        sound("point", text, out.of(moved))?;
    }
    Ok(out)
}

fn reference(s: &Settings<'_>, scene: &Scene) -> Result<Reference, Error> {
    let points = match s.texts("reference").pop() {
        Some(text) => s.points_in("reference", text)?.into_iter().map(|p| scene.scale * p).collect(),
        None => vec![scene.frame.origin(), Point::new(scene.frame.x1, scene.frame.y1)],
    };
    let text = s.texts("degree").pop().unwrap_or("1");
    match points[..] {
        [a, b, c] => {
            let area = (b - a).cross(c - a).abs();
            if area <= 1e-12 * (b - a).hypot2().max((c - a).hypot2()) {
                return Err(GeometryError::Collinear { path: "reference".into(), which: [1, 2, 3], points }.into());
            }
            Ok(Reference::Triangle([a, b, c], degree(text, text)?))
        }
        [a, b] => {
            let r = Rect::from_points(a, b);
            if r.width() <= 0.0 || r.height() <= 0.0 {
                return Err(Error::usage("reference", "", "has no area"));
            }
            let (m, n) = text.split_once('x').unwrap_or((text, text));
            Ok(Reference::Rectangle(r, [degree(text, m)?, degree(text, n)?]))
        }
        _ => {
            Err(Error::usage("reference", "", format!("has {} points; a triangle has three, a box two", points.len())))
        }
    }
}

fn degree(text: &str, part: &str) -> Result<usize, Error> {
    let n = part.trim().parse().ok().filter(|n| (1..=10).contains(n));
    n.ok_or_else(|| Error::usage("degree", text, "is no degree: a number from 1 to 10, or for a box two such as 3x2"))
}

/// Reads `I,J:…` or `I,J,K:…`.
fn node<'t>(s: &Settings<'_>, name: &str, text: &'t str, r: &Reference) -> Result<([usize; 3], &'t str), Error> {
    let (node, rest, which) = match r {
        Reference::Triangle(_, n) => {
            let (node, rest) = s.node_in::<3>(name, text)?;
            (node, rest, format!("I, J and K must add up to {n}, the degree"))
        }
        Reference::Rectangle(_, [m, n]) => {
            let ([i, j], rest) = s.node_in::<2>(name, text)?;
            ([i, j, 0], rest, format!("I runs from 0 to {m} across, J from 0 to {n} down"))
        }
    };
    if r.has(node) {
        Ok((node, rest))
    } else {
        Err(Error::usage(name, text, format!("names no control point: {which}")))
    }
}

/// The plane of a triangle's three corners after they have been pushed, if the net is one of degree 1.
pub(super) fn flat(d: &Dilation, foot: Point, distance: f64) -> Option<SpacePlane> {
    let (along, d0) = d.collineation(foot)?;
    // δ = d·(p − foot) + d₀ = n·d/n·(P − O) with the ray (p − foot, distance): n is (d, d₀/distance).
    let normal = [along.x, along.y, d0 / distance];
    // Where it meets the eye's line of sight through the middle of the reference.
    let [a, b, c] = d.reference().corners().try_into().ok()?;
    let middle = a + ((b - a) + (c - a)) / 3.0;
    let k = 1.0 / d.at(middle);
    let to = foot + (middle - foot) * k;
    Some(SpacePlane::new([to.x, to.y, distance * (k - 1.0)], normal, middle))
}

/// Warns of sides that tear what crosses them.
pub(super) fn tell_torn_sides(d: &Dilation, frame: Rect, built: &mut Built) {
    let corners = d.reference().corners();
    let room = 1e-9 * (frame.width() + frame.height());
    let inner = frame.inflate(-room, -room);
    for k in 0..corners.len() {
        let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
        let meets = Rect::from_points(a, b).bounding_box().overlaps(inner);
        if meets && !d.side_is_fixed(k) {
            built.warn(format!(
                "the side of the reference from {} to {} has control points moved: what crosses it is torn apart; keep that side's \
points in place, choose another `reference`, or leave out `local`",
                crate::error::show(a),
                crate::error::show(b)
            ));
        }
    }
}
