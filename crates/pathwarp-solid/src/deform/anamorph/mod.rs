//! Anamorphosis in space: deforms models so that they look unchanged from one place.
//!
//! Every point moves along its ray through the eye O: p̂ = O + (p − O)/δ(p). Control points bᵢ of a reference are moved along their
//! rays to O + (bᵢ − O)/δᵢ, and δ interpolates ([`dilation`]). Over a tetrahedron of degree 1 the map is a perspective collineation
//! with centre O, in coordinates about O the matrix [I 0; d d₀] with δ(p) = d·p + d₀; its axis, the plane δ = 1, stays in place.
//!
//! To prescribe δ at a point p, one control point is set to δᵢ + (δ − δ(p))/Bᵢ(p), which from rest is the paper's
//! δ₃ = 1 + (δ − 1)/u₃.
//!
//! J. Sánchez-Reyes, J. M. Chacón, *Anamorphic free-form deformation*, CAGD 46 (2016); D. Hansford, D. Collins, *Anamorphic 3D
//! geometry*, Computing 79 (2007).

mod dilation;
mod reference;

use super::entry::{About3, Built3, Case3, Entry, Law3};
use crate::map::{Chart, Collineation, Creases3, Fraction3, Jet3, Map3, Radial, for_all};
use crate::settings::{Box3, Extent, Settings3, show};
use dilation::{Dilation3, MAX_DEGREE};
use glam::{DMat3, DMat4, DVec3, DVec4};
use pathwarp::Error;
use pathwarp::deform::{Example, Info, Pairs};
use pathwarp::param::{Kind, Param};
use pathwarp::setters;
use std::sync::Arc;

pub use reference::Reference3;

/// A push of a control point, or of a point of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Push3 {
    /// Moves a control point to a multiple of its distance from the eye.
    By([usize; 4], f64),
    /// Moves a control point this much further from the eye.
    Away([usize; 4], f64),
    /// Moves a control point to the point on its ray nearest to this one.
    To([usize; 4], DVec3),
    /// Moves a point of the model to a multiple of its distance from the eye.
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
    /// Makes an anamorphosis that moves nothing yet.
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

    setters! {
        /// Moves only what is inside the reference.
        local(local: bool);
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
                let strongest = free.map(|i| (i, influence(i))).max_by(|a, b| a.1.total_cmp(&b.1));
                let (i, b) = strongest.filter(|(_, b)| *b > 1e-9).ok_or_else(|| {
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

// The map p̂ = O + (p − O)/δ(p), and its inverse along each ray.

/// Points this close to a side of the moved region, relative to the coordinates, count as on it.
const ROUNDING: f64 = 1e-12;

/// Evaluates a form in (x, y, z, 1) that is 0 on a side of the moved region.
fn beyond(form: &DVec4, p: DVec3) -> f64 {
    let q = p.extend(1.0);
    let v = form.dot(q);
    if v.abs() <= ROUNDING * form.abs().dot(q.abs()) { 0.0 } else { v }
}

/// Every point moves along its ray through the eye.
#[derive(Debug, Clone)]
struct RadialMap {
    eye: DVec3,
    dilation: Dilation3,
    /// For a local map, forms in (x, y, z, 1) that are all nonnegative where points move.
    within: Option<Arc<[DVec4]>>,
    /// The smallest and the largest δ of a control point.
    range: (f64, f64),
}

impl RadialMap {
    /// Whether a point may move.
    fn moves(&self, p: DVec3) -> bool {
        self.within.as_deref().is_none_or(|forms| forms.iter().all(|f| beyond(f, p) >= 0.0))
    }

    /// Whether a box may move. `None` if a side of the moved region may cross it.
    fn moves_on(&self, on: &Box3) -> Option<bool> {
        let corners = on.corners();
        // The moved region is convex, so a box is inside if its corners are, and outside if they are all behind one side.
        if corners.iter().all(|p| self.moves(*p)) {
            return Some(true);
        }
        let behind = |f: &DVec4| corners.iter().all(|p| beyond(f, *p) <= 0.0);
        self.within.as_deref().is_some_and(|forms| forms.iter().any(behind)).then_some(false)
    }
}

impl Map3 for RadialMap {
    fn jet(&self, p: DVec3) -> Jet3 {
        if !self.moves(p) {
            return Jet3::identity(p);
        }
        let ((delta, slope), ray) = (self.dilation.jet(p), p - self.eye);
        let outer = DMat3::from_cols(ray * slope.x, ray * slope.y, ray * slope.z);
        Jet3 { p: self.eye + ray / delta, d: (DMat3::IDENTITY - outer * (1.0 / delta)) * (1.0 / delta) }
    }

    fn point(&self, p: DVec3) -> DVec3 {
        if !self.moves(p) {
            return p;
        }
        self.eye + (p - self.eye) / self.dilation.at(p)
    }

    fn points(&self, ps: &mut [DVec3]) {
        match &self.dilation {
            Dilation3::Cuboid { local, tensor } if self.within.is_none() => {
                for_all(&Radial { local: *local, eye: self.eye, tensor }, ps);
            }
            _ => ps.iter_mut().for_each(|p| *p = self.point(*p)),
        }
    }

    fn fraction(&self, on: &Box3, most: usize) -> Option<Fraction3> {
        let chart = Chart::on(on);
        if !self.moves_on(on)? {
            return Some(Fraction3::identity(chart));
        }
        if self.dilation.degree() > most {
            return None;
        }
        let (divisor, common) = self.dilation.fraction(&chart);
        Some(Fraction3::radial(chart, self.eye, divisor, &common))
    }

    fn branch(&self, on: &Box3) -> Option<Arc<dyn Map3>> {
        Some(match self.moves_on(on)? {
            true => Arc::new(Self { within: None, ..self.clone() }),
            false => Arc::new(Collineation::IDENTITY),
        })
    }

    fn creases(&self, out: &mut Creases3) {
        for form in self.within.iter().flat_map(|forms| forms.iter().copied()) {
            out.kink(move |p| form.dot(p.extend(1.0)));
        }
        if self.within.is_none() {
            self.dilation.edge(out);
        } else {
            let own = self.clone();
            out.edge(move |p| if own.moves(p) { own.dilation.at(p) } else { 1.0 });
        }
    }

    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        Some(Arc::new(RadialInverse(self.clone())))
    }
}

/// The inverse. It takes q = O + r to the point O + s·r on the same ray with s = δ(O + s·r).
#[derive(Debug, Clone)]
struct RadialInverse(RadialMap);

/// Limit on the steps of Newton's method along a ray.
const MAX_STEPS: usize = 50;
/// Number of intervals along a ray to search for a root if Newton's method finds none.
const INTERVALS: u32 = 96;
/// Factor by which the searched range exceeds that of the control points' δ.
const BEYOND: f64 = 8.0;

impl RadialInverse {
    /// δ(O + s·r) − s and its slope.
    fn off(&self, r: DVec3, s: f64) -> (f64, f64) {
        let (delta, slope) = self.0.dilation.jet(self.0.eye + r * s);
        (delta - s, slope.dot(r) - 1.0)
    }

    /// Finds the root near `s`. The slope must be negative, which means that the map keeps the order of points along the ray.
    fn newton(&self, r: DVec3, mut s: f64) -> Option<f64> {
        for _ in 0..MAX_STEPS {
            let (off, slope) = self.off(r, s);
            let next = s - off / slope;
            if !(next > 0.0 && next.is_finite()) {
                return None;
            }
            let still = (next - s).abs() <= 2.0 * f64::EPSILON * s;
            s = next;
            if still {
                return (slope < 0.0).then_some(s);
            }
        }
        let (off, slope) = self.off(r, s);
        (off.abs() <= 64.0 * f64::EPSILON * s && slope < 0.0).then_some(s)
    }

    fn factor(&self, q: DVec3) -> Option<f64> {
        let r = q - self.0.eye;
        if self.0.dilation.is_sheet() {
            return Some(self.0.dilation.at(q)).filter(|d| *d > 0.0);
        }
        let (min, max) = (self.0.range.0 / BEYOND, self.0.range.1 * BEYOND);
        let found = self.newton(r, 1.0).filter(|s| (min..=max).contains(s));
        found.or_else(|| {
            let place = |i: u32| min * (max / min).powf(f64::from(i) / f64::from(INTERVALS));
            let falls = |i: &u32| self.off(r, place(*i)).0 >= 0.0 && self.off(r, place(i + 1)).0 < 0.0;
            (0..INTERVALS).filter(falls).find_map(|i| self.bisected(r, place(i), place(i + 1)))
        })
    }

    /// Bisects between `a`, where the difference is positive, and `b`, where it is negative.
    fn bisected(&self, r: DVec3, mut a: f64, mut b: f64) -> Option<f64> {
        for _ in 0..64 {
            let m = 0.5 * (a + b);
            if self.off(r, m).0 >= 0.0 { a = m } else { b = m }
        }
        let s = 0.5 * (a + b);
        (self.off(r, s).0.abs() <= 1e-12 * s).then_some(s)
    }

    fn source(&self, q: DVec3) -> Option<DVec3> {
        let source = self.factor(q).map(|s| self.0.eye + (q - self.0.eye) * s).filter(|p| self.0.moves(*p));
        // Outside points stay where they are, unless inside points have moved there.
        source.or_else(|| (!self.0.moves(q)).then_some(q))
    }
}

impl Map3 for RadialInverse {
    fn jet(&self, q: DVec3) -> Jet3 {
        self.source(q).map_or(Jet3::UNDEFINED, |p| Jet3 { p, d: self.0.jet(p).d.inverse() })
    }

    fn point(&self, q: DVec3) -> DVec3 {
        self.source(q).unwrap_or(DVec3::NAN)
    }

    fn inverse(&self) -> Option<Arc<dyn Map3>> {
        Some(Arc::new(self.0.clone()))
    }
}

/// A tetrahedron in the frame of laws and cases, with its eye.
const TETRAHEDRON: &str = "0,0,0 100,0,0 0,100,0 0,0,100";

static ABOUT: About3 = About3 {
    info: Info::new("anamorph", "deform a model so that it looks unchanged from one place")
        .group("Perspective and anamorphosis")
        .about("Moves every point along its ray through the eye (--eye), so that the picture from there stays the same, and from \
everywhere else the model is distorted: Ames rooms, sculptures that come together at one spot, reliefs.\n\n\
Control points of a reference (--reference) are pushed along their rays, and the model follows:\n  \
four points: a tetrahedron, whose control points I,J,K,L add up to the degree. At degree 1 planes stay plane.\n  \
two points: a box with control points I,J,K from the left, bottom and back; if it is flat, a sheet.\n  \
three points: a triangle as a sheet, control points I,J,K. All points of a ray through a sheet are moved by one factor.\n\n\
With --local nothing outside the reference moves: leave the control points of the face where the model leaves the reference in \
place, or a second layer of them for a smooth transition.")
        .source("J. Sánchez-Reyes, J. M. Chacón, Anamorphic free-form deformation, CAGD 46, 2016; D. Hansford, D. Collins, \
Anamorphic 3D geometry, Computing 79, 2007")
        .params(&[
            Param::new("eye", Kind::Text("X,Y,Z"), "The place from which the model looks unchanged.").needed(),
            Param::new("reference", Kind::Text("X,Y,Z …"), "Corners of the reference: four points, three, or two opposite corners of a \
box. Default: the model's box."),
            Param::new("degree", Kind::Text("N|LxMxN"), "Degree of the reference, 1 to 10; a box may have one along each axis.").default("1"),
            Param::new("push", Kind::Text("NODE:FACTOR"), "Take control point I,J,K (or I,J,K,L) to FACTOR times its distance from the \
eye, such as 1,1,0:150%.")
            .repeated(),
            Param::new("away", Kind::Text("NODE:LENGTH"), "Take a control point LENGTH further from the eye; a negative one comes closer.")
                .repeated(),
            Param::new("at", Kind::Text("NODE:X,Y,Z"), "Take a control point to the point of its ray nearest to X,Y,Z.").repeated(),
            Param::new("point", Kind::Text("X,Y,Z:FACTOR"), "Take a point of the model to FACTOR times its distance from the eye, by the \
control point that has most influence there and is not on the fixed face (the first three corners of a tetrahedron).")
            .repeated(),
            Param::flag("local", "Leave everything outside the reference in place."),
        ])
        .demo(&[("eye", "50,60,400"), ("degree", "2x1x1"), ("push", "1,1,0:1.6 0,0,1:0.8")])
        .examples(&[
            Example {
                what: "Stretch a model away from the eye: a perspective collineation",
                command: "solid anamorph samples/solid/teapot.obj --eye 50%,60%,600% --reference '0%,0%,100% 100%,0%,100% 0%,100%,100% 50%,50%,-50%' \
--push 0,0,0,1:160% -o out.obj",
            },
            Example {
                what: "Bend a model to and fro along its rays",
                command: "solid anamorph samples/solid/teapot.obj --eye 50%,60%,600% --degree 3x1x1 --push 1,0,0:1.3 --push 1,1,0:1.3 \
--push 2,0,1:0.8 --push 2,1,1:0.8 -o out.obj",
            },
            Example {
                what: "Draw out the spout alone: the three corners around its foot stay",
                command: "solid anamorph samples/solid/teapot.obj --eye 50%,60%,600% --local --reference \
'79%,-100%,-300% 79%,-100%,400% 79%,400%,50% 115%,60%,50%' --point 98%,70%,50%:125% -o out.obj",
            },
        ]),
    laws: &[
        Law3::Identity(&[("eye", "50,50,300")]),
        Law3::Identity(&[("eye", "50,50,300"), ("degree", "3x2x1"), ("push", "1,1,1:1")]),
        Law3::Identity(&[("eye", "50,50,300"), ("reference", "0,0,0 100,0,0 0,100,0"), ("degree", "3")]),
        Law3::KeepsPlanes(&[("eye", "50,60,300"), ("reference", TETRAHEDRON), ("push", "0,0,0,1:1.4 1,0,0,0:0.8")]),
        Law3::KeepsRays(&[("eye", "50,60,300"), ("reference", TETRAHEDRON), ("push", "0,0,0,1:1.4 1,0,0,0:0.8")], [50.0, 60.0, 300.0]),
        Law3::KeepsRays(&[("eye", "50,60,300"), ("reference", TETRAHEDRON), ("degree", "2"), ("push", "0,0,1,1:1.4")], [50.0, 60.0, 300.0]),
        Law3::KeepsRays(&[("eye", "50,60,300"), ("degree", "3x2x1"), ("push", "1,1,1:1.3 2,0,0:0.7")], [50.0, 60.0, 300.0]),
        Law3::KeepsRays(&[("eye", "50,60,300"), ("reference", "0,0,0 100,0,0 0,100,0"), ("degree", "2"), ("push", "1,1,0:1.3")], [50.0, 60.0, 300.0]),
        Law3::KeepsRays(&[("eye", "50,60,300"), ("reference", "0,0,0 100,100,0"), ("degree", "2"), ("push", "1,1,0:1.3")], [50.0, 60.0, 300.0]),
        // The same tetrahedron with its degree raised: δ of the middles of edges are means.
        Law3::Same(
            &[("eye", "50,60,300"), ("reference", TETRAHEDRON), ("push", "0,0,0,1:0.5")],
            &[("eye", "50,60,300"), ("reference", TETRAHEDRON), ("degree", "2"),
              ("push", "0,0,0,2:0.5 1,0,0,1:66.66666666666667% 0,1,0,1:66.66666666666667% 0,0,1,1:66.66666666666667%")],
        ),
        // A multiple of the distance, or the distance itself: control point 1,1,1 is 50, 40 and 200 away from the eye.
        Law3::Same(
            &[("eye", "50,60,300"), ("push", "1,1,1:2")],
            &[("eye", "50,60,300"), ("away", "1,1,1:210.0")],
        ),
        Law3::FixedOutside(LOCAL, [[20.0, 20.0, 20.0], [80.0, 80.0, 80.0]]),
    ],
    cases: &[
        // From rest the fourth corner takes the whole push: δ₃ = 1 + (δ − 1)/u₃ with u₃ = 1/4, δ = 4/5, so δ₃ = 1/5.
        Case3 {
            args: &[("eye", "0,0,300"), ("reference", TETRAHEDRON), ("point", "20,20,25:1.25")],
            at: [20.0, 20.0, 25.0],
            to: [25.0, 25.0, 300.0 - 275.0 * 1.25],
            tolerance: 1e-11,
        },
        // The plane of the three corners that stay is the axis.
        Case3 {
            args: &[("eye", "0,0,300"), ("reference", TETRAHEDRON), ("push", "0,0,0,1:3")],
            at: [37.0, 12.0, 0.0],
            to: [37.0, 12.0, 0.0],
            tolerance: 1e-12,
        },
    ],
};

const LOCAL: Pairs = &[
    ("eye", "50,60,300"),
    ("reference", "20,20,20 80,80,80"),
    ("degree", "2"),
    ("push", "1,1,1:1.2"),
    ("local", "true"),
];

/// Reads the deformation from text.
pub(in crate::deform) const ENTRY: Entry = Entry(&ABOUT, |s| {
    let eye =
        s.point_if("eye")?.ok_or_else(|| Error::missing("eye", "the place from which the model looks unchanged"))?;
    let mut points = Vec::new();
    for word in s.words("reference").into_iter().flat_map(|w| w.split(';')).filter(|w| !w.is_empty()) {
        points.push(s.point_in("reference", word)?);
    }
    if points.is_empty() {
        points = vec![s.bounds().min, s.bounds().max];
    }
    let degree = s.counts_if("degree", MAX_DEGREE)?.unwrap_or([1; 3]);
    let reference = Reference3::new(&points, degree, eye)?;
    let mut out = Anamorph3::new(eye, reference).local(s.flat().flag("local")?);
    for push in pushes(s, &reference)? {
        out = out.push(push);
    }
    out.build()
});

/// Reads the pushes of control points, then those of points.
fn pushes(s: &Settings3<'_>, reference: &Reference3) -> Result<Vec<Push3>, Error> {
    let mut out = Vec::new();
    for name in ["push", "away", "at"] {
        for word in s.words(name) {
            let (node, value) = if matches!(reference, Reference3::Tetrahedron(..)) {
                s.flat().node_in::<4>(name, word)?
            } else {
                let ([i, j, k], value) = s.flat().node_in::<3>(name, word)?;
                ([i, j, k, 0], value)
            };
            out.push(match name {
                "push" => Push3::By(node, s.flat().number_in(name, value)?),
                "away" => Push3::Away(node, s.length_in(name, value, Extent::Diagonal)?),
                _ => Push3::To(node, s.point_in(name, value)?),
            });
        }
    }
    for word in s.words("point") {
        let wrong = || Error::usage("point", word, "is not X,Y,Z:FACTOR, such as 10,20,30:150%");
        let (p, factor) = word.split_once(':').ok_or_else(wrong)?;
        let p: DVec3 = s.point_in("point", p)?;
        out.push(Push3::Prescribe(p, s.flat().number_in("point", factor)?));
    }
    Ok(out)
}
