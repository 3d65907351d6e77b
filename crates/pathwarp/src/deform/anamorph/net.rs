//! Control points that are pushed along rays through the eye.

use super::dilation::{Dilation, Reference};
use super::scene::{Eye, Scene};
use super::surface::{Anamorphosis, Radial, SpacePlane, Surface, cross, minus};
use crate::deform::entry::Built;
use crate::error::{Error, GeometryError, show};
use kurbo::{Point, Rect, Vec2};

/// A net of control points, and the pushes along rays through the eye.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PushedNet {
    /// Three corners of a triangle or two of a box; if empty, the artwork's box.
    pub(super) reference: Vec<Point>,
    /// Degrees across and down a box; a triangle uses the first.
    pub(super) degree: [usize; 2],
    pub(super) pushes: Vec<Push>,
}

impl Default for PushedNet {
    fn default() -> Self {
        Self { reference: Vec::new(), degree: [1, 1], pushes: Vec::new() }
    }
}

/// A push of a control point. The third number of a box's control point is 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Push {
    /// To this many times its distance from the eye.
    By([usize; 3], f64),
    /// Away from the eye by this many user units.
    Away([usize; 3], f64),
    /// To the point of its ray nearest to this one.
    To([usize; 3], Point),
    /// So that this point goes to this many times its distance from the eye, or away from an eye at infinity by this length.
    Prescribe(Point, f64),
}

impl Push {
    pub(super) fn param(self) -> &'static str {
        match self {
            Self::By(..) => "push",
            Self::Away(..) => "away",
            Self::To(..) => "at",
            Self::Prescribe(..) => "point",
        }
    }

    /// Describes the control point, or the prescribed point, for messages.
    fn text(self, reference: &Reference) -> String {
        match (self, reference) {
            (Self::Prescribe(p, by), _) => format!("{}:{by}", show(p)),
            (Self::By([i, j, k], _) | Self::Away([i, j, k], _) | Self::To([i, j, k], _), Reference::Triangle(..)) => {
                format!("{i},{j},{k}")
            }
            (Self::By([i, j, _], _) | Self::Away([i, j, _], _) | Self::To([i, j, _], _), _) => format!("{i},{j}"),
        }
    }
}

impl PushedNet {
    /// Returns δ of the pushed net: a point's distance from the eye as a fraction of its image's or, for an eye at infinity, 1 minus the
    /// length of the push.
    pub(super) fn dilation(&self, scene: &Scene, local: bool) -> Result<Dilation, Error> {
        let reference = self.reference(scene)?;
        let mut out = Dilation::none(reference);
        for push in &self.pushes {
            let wrong = |problem: String| Error::usage(push.param(), push.text(&reference), problem);
            let check_delta = |delta: f64| {
                let range = if scene.eye.is_infinite() { -1e9..1e9 } else { 1e-6..1e6 };
                let out_of_range = || wrong("would go through the eye, or out of reach; push it less".into());
                range.contains(&delta).then_some(delta).ok_or_else(out_of_range)
            };
            if let Push::By(node, _) | Push::Away(node, _) | Push::To(node, _) = *push
                && !reference.has(node)
            {
                return Err(wrong(format!("is not a control point: {}", describe_numbers(&reference))));
            }
            // δ of a push to so many times the distance, and of one away from a point by a length.
            let delta_by = |factor: f64| {
                if scene.eye.is_infinite() {
                    let problem = "multiplies the distance of an eye at infinity; give a length instead, by `away`, or after a `point`";
                    return Err(wrong(problem.into()));
                }
                check_delta(1.0 / factor)
            };
            let delta_away = |from: Point, length: f64| {
                check_delta(match scene.eye {
                    Eye::At(foot, distance) => {
                        let d = (from - foot).hypot().hypot(distance);
                        d / (d + length)
                    }
                    Eye::Infinite(_) => 1.0 - length,
                })
            };
            match *push {
                Push::By(node, factor) => out.set(node, delta_by(factor)?),
                Push::Away(node, length) => out.set(node, delta_away(reference.point(node), length)?),
                Push::To(node, to) => {
                    let from = reference.point(node);
                    let delta = match scene.eye {
                        Eye::At(foot, 0.0) => (from - foot).hypot2() / (to - foot).dot(from - foot),
                        Eye::Infinite([x, y, 0.0]) => 1.0 + (to - from).dot(Vec2::new(x, y)),
                        _ => {
                            let problem = "is for an eye in the drawing; for one in front of it use `push` or `away`";
                            return Err(wrong(problem.into()));
                        }
                    };
                    out.set(node, check_delta(delta)?);
                }
                Push::Prescribe(p, value) => {
                    let p = scene.scale * p;
                    let delta = if scene.eye.is_infinite() { delta_away(p, value)? } else { delta_by(value)? };
                    let problem = "is on a fixed side, or no control point is free to move; raise `degree` or choose another `reference`";
                    let node = out.prescribe(p, delta, |node| is_held(&reference, node, local));
                    check_delta(out.delta_of(node.ok_or_else(|| wrong(problem.into()))?))?;
                }
            }
        }
        Ok(out)
    }

    /// Returns the net before its pushes, whose corners are given in the drawing, in the artwork scaled to its apparent size.
    fn reference(&self, scene: &Scene) -> Result<Reference, Error> {
        let points = match &self.reference[..] {
            [] => vec![scene.frame.origin(), Point::new(scene.frame.x1, scene.frame.y1)],
            given => given.iter().map(|p| scene.scale * *p).collect(),
        };
        if self.degree.iter().any(|n| !(1..=10).contains(n)) {
            return Err(Error::usage("degree", format!("{:?}", self.degree), "is out of range: 1 to 10"));
        }
        match points[..] {
            [a, b, c] => {
                let area = (b - a).cross(c - a).abs();
                if area <= 1e-12 * (b - a).hypot2().max((c - a).hypot2()) {
                    return Err(GeometryError::Collinear { path: "reference".into(), which: [1, 2, 3], points }.into());
                }
                Ok(Reference::Triangle([a, b, c], self.degree[0]))
            }
            [a, b] => {
                let r = Rect::from_points(a, b);
                if r.width() <= 0.0 || r.height() <= 0.0 {
                    return Err(Error::usage("reference", "", "has no area; name two opposite corners of a box"));
                }
                Ok(Reference::Rectangle(r, self.degree))
            }
            _ => {
                let problem = format!("has {} points; a triangle has three, a box two", points.len());
                Err(Error::usage("reference", "", problem))
            }
        }
    }
}

/// Returns `true` for control points that a prescribed point must not move: on the first side of a triangle, which joins what stays, and
/// with `local` on the edge of a box.
fn is_held(reference: &Reference, node: [usize; 3], local: bool) -> bool {
    match reference {
        Reference::Triangle(..) => reference.on_side(node, 0),
        Reference::Rectangle(..) => local && (0..reference.corners().len()).any(|k| reference.on_side(node, k)),
    }
}

/// Describes the numbers of a reference's control points.
fn describe_numbers(reference: &Reference) -> String {
    match reference {
        Reference::Triangle(_, n) => format!("I, J and K must add up to {n}, the degree"),
        Reference::Rectangle(_, [m, n]) => format!("I runs from 0 to {m} across, J from 0 to {n} down"),
    }
}

/// Returns the plane of a triangle's three corners after their pushes, if the net has degree 1.
pub(super) fn plane_of_corners(d: &Dilation, eye: Eye) -> Option<SpacePlane> {
    let Reference::Triangle([a, b, c], 1) = d.reference else { return None };
    let middle = a + ((b - a) + (c - a)) / 3.0;
    // The orientation of the corners in the drawing, as seen from the eye.
    let orientation = (b - a).cross(c - a).signum();
    let projection = Anamorphosis { eye, surface: Surface::Radial(Radial::net(d)) };
    let [a, b, c, through] = [a, b, c, middle].map(|p| projection.point(p));
    let normal = cross(minus(b, a), minus(c, a));
    Some(SpacePlane::new(through, normal.map(|v| v * orientation), middle))
}

/// Warns of sides at which artwork is torn.
pub(super) fn warn_of_torn_sides(d: &Dilation, frame: Rect, built: &mut Built) {
    let corners = d.reference.corners();
    // Artwork along the edge of the box counts, as strokes reach past it.
    let rounding = 1e-9 * (frame.width() + frame.height());
    let frame = frame.inflate(rounding, rounding);
    for k in 0..corners.len() {
        let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
        if Rect::from_points(a, b).overlaps(frame) && !d.side_is_fixed(k) {
            let [a, b] = [a, b].map(show);
            built.warn(format!(
                "the side of the reference from {a} to {b} has control points moved: artwork that crosses it is torn apart; keep that \
side's points in place, choose another `reference`, or omit `local`"
            ));
        }
    }
}
