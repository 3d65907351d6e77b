//! Anamorphosis in space: models that look unchanged from one place.
//!
//! Every point moves along its ray through the eye O: p̂ = O + (p − O)/δ(p). Control points bᵢ of a reference are moved along their
//! rays to O + (bᵢ − O)/δᵢ, and δ interpolates ([`dilation`]). Over a tetrahedron of degree 1 the map is a perspective collineation
//! with centre O, in coordinates about O the matrix [I 0; d d₀] with δ(p) = d·p + d₀; its axis, the plane δ = 1, stays in place.
//!
//! A point p prescribed to go to p/δ sets one control point, δᵢ + (δ − δ(p))/Bᵢ(p), from rest the paper's δ₃ = 1 + (δ − 1)/u₃.
//!
//! J. Sánchez-Reyes, J. M. Chacón, *Anamorphic free-form deformation*, CAGD 46 (2016); D. Hansford, D. Collins, *Anamorphic 3D
//! geometry*, Computing 79 (2007).

mod dilation;
mod entry;
mod map;
mod reference;

pub(super) use entry::Entry;
pub use reference::Reference3;

use super::built::Built3;
use crate::map::{Collineation, Map3};
use crate::settings::show;
use dilation::Dilation3;
use glam::{DMat3, DMat4, DVec3, DVec4};
use map::RadialMap;
use pathwarp::Error;
use std::sync::Arc;

/// A push of a control point, or of a point of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Push3 {
    /// To this many times its distance from the eye.
    By([usize; 4], f64),
    /// This much further from the eye.
    Away([usize; 4], f64),
    /// To the point of its ray nearest to this one.
    To([usize; 4], DVec3),
    /// So that this point goes to this many times its distance from the eye.
    Prescribe(DVec3, f64),
}

impl Push3 {
    fn param(self) -> &'static str {
        match self {
            Self::By(..) => "push",
            Self::Away(..) => "away",
            Self::To(..) => "at",
            Self::Prescribe(..) => "point",
        }
    }

    fn text(self, reference: &Reference3) -> String {
        match self {
            Self::By(n, _) | Self::Away(n, _) | Self::To(n, _) => {
                let count = if matches!(reference, Reference3::Tetrahedron(..)) { 4 } else { 3 };
                n[..count].iter().map(usize::to_string).collect::<Vec<_>>().join(",")
            }
            Self::Prescribe(p, factor) => format!("{}:{factor}", show(p)),
        }
    }
}

/// An anamorphosis in space.
///
/// ```
/// use glam::DVec3;
/// use pathwarp_solid::{deform::{Anamorph3, Push3, Reference3}, map::Map3};
///
/// let eye = DVec3::new(0.0, 0.0, 100.0);
/// let corners = [DVec3::ZERO, DVec3::new(50.0, 0.0, 0.0), DVec3::new(0.0, 50.0, 0.0), DVec3::new(0.0, 0.0, 50.0)];
/// let reference = Reference3::new(&corners, [1; 3], eye)?;
/// let built = Anamorph3::new(eye, reference).push(Push3::By([0, 0, 0, 1], 1.5)).build()?;
/// assert!((built.map.point(corners[3]) - DVec3::new(0.0, 0.0, 25.0)).length() < 1e-12);
/// # Ok::<(), pathwarp::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Anamorph3 {
    eye: DVec3,
    reference: Reference3,
    pushes: Vec<Push3>,
    local: bool,
}

impl Anamorph3 {
    /// Starts with nothing moved.
    #[must_use]
    pub fn new(eye: DVec3, reference: Reference3) -> Self {
        Self { eye, reference, pushes: Vec::new(), local: false }
    }

    /// Pushes a control point.
    #[must_use]
    pub fn push(mut self, push: Push3) -> Self {
        self.pushes.push(push);
        self
    }

    /// Moves only what is inside the reference.
    #[must_use]
    pub fn local(self, local: bool) -> Self {
        Self { local, ..self }
    }

    /// Builds the map.
    ///
    /// # Errors
    /// [`Error::Usage`] for control points that do not exist, pushes through the eye, and points that cannot be prescribed.
    pub fn build(&self) -> Result<Built3, Error> {
        let nodes = self.reference.nodes();
        let mut values = vec![1.0; nodes.len()];
        for push in &self.pushes {
            self.apply(*push, &nodes, &mut values)?;
        }
        let dilation = Dilation3::new(&self.reference, self.eye, &values);
        let linear = dilation.linear().filter(|_| !self.local);
        let range = values.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(*v), b.max(*v)));
        let within = self.local.then(|| dilation.sides(&self.reference).into());
        let map: Arc<dyn Map3> = match linear {
            Some(form) => Arc::new(Collineation::new(perspective(self.eye, form))),
            None => Arc::new(RadialMap { eye: self.eye, dilation, within, range }),
        };
        let mut built = Built3::new(map);
        built.eye = Some(self.eye);
        built.note(format!("{} control points; {}", nodes.len(), self.reference.numbers()));
        if let Some(form) = linear {
            let at_eye = form.dot(self.eye.extend(1.0));
            let d = form.truncate();
            built.note(format!("collineation: d = {:.6},{:.6},{:.6}, d0 = {at_eye:.6} about the eye", d.x, d.y, d.z));
        }
        for (node, delta) in nodes.iter().zip(&values).filter(|(_, v)| **v != 1.0) {
            let from = self.reference.point(*node);
            let to = self.eye + (from - self.eye) / delta;
            built.note(format!("control point at {} moves to {}", show(from), show(to)));
            built.guides.push(vec![self.eye, from, to]);
        }
        Ok(built)
    }

    fn apply(&self, push: Push3, nodes: &[[usize; 4]], values: &mut [f64]) -> Result<(), Error> {
        let wrong = |problem: String| Error::usage(push.param(), push.text(&self.reference), problem);
        let sound = |delta: f64| {
            if (1e-6..1e6).contains(&delta) {
                return Ok(delta);
            }
            Err(wrong("would go through the eye, or out of reach; push it less".into()))
        };
        let find = |node: [usize; 4]| {
            let missing = || wrong(format!("is not a control point: {}", self.reference.numbers()));
            nodes.iter().position(|n| *n == node).ok_or_else(missing)
        };
        let ray = |node: [usize; 4]| self.reference.point(node) - self.eye;
        match push {
            Push3::By(node, factor) => values[find(node)?] = sound(1.0 / factor)?,
            Push3::Away(node, length) => {
                let i = find(node)?;
                let distance = ray(node).length();
                values[i] = sound(distance / (distance + length))?;
            }
            Push3::To(node, to) => {
                let i = find(node)?;
                let along = (to - self.eye).dot(ray(node)) / ray(node).length_squared();
                values[i] = sound(1.0 / along)?;
            }
            Push3::Prescribe(p, factor) => {
                let wanted = sound(1.0 / factor)?;
                let here = Dilation3::new(&self.reference, self.eye, values).at(p);
                // The influence of a control point is δ with 1 at it and 0 elsewhere.
                let influence = |i: usize| {
                    let mut unit = vec![0.0; nodes.len()];
                    unit[i] = 1.0;
                    Dilation3::new(&self.reference, self.eye, &unit).at(p)
                };
                let free = (0..nodes.len()).filter(|i| !self.reference.held(nodes[*i], self.local));
                let most = free.map(|i| (i, influence(i))).max_by(|a, b| a.1.total_cmp(&b.1));
                let (i, b) = most.filter(|(_, b)| *b > 1e-9).ok_or_else(|| {
                    wrong("is on a fixed face, or no control point is free to move; raise `degree` or choose another `reference`".into())
                })?;
                values[i] = sound(values[i] + (wanted - here) / b)?;
            }
        }
        Ok(())
    }
}

/// The matrix of p ↦ O + (p − O)/δ for a linear form δ in (x, y, z, 1): (p + O·(δ − 1), δ).
fn perspective(eye: DVec3, delta: DVec4) -> DMat4 {
    let d = delta.truncate();
    let linear = DMat3::IDENTITY + DMat3::from_cols(eye * d.x, eye * d.y, eye * d.z);
    DMat4::from_cols(
        linear.x_axis.extend(d.x),
        linear.y_axis.extend(d.y),
        linear.z_axis.extend(d.z),
        (eye * (delta.w - 1.0)).extend(delta.w),
    )
}
