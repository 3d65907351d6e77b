//! Anamorphosis in space: deforms models so that they look unchanged from one point.
//!
//! Every point moves along its ray through the eye O: p̂ = O + (p − O)/δ(p). Control points bᵢ of a reference are moved along their
//! rays to O + (bᵢ − O)/δᵢ, and δ interpolates ([`dilation`]). Over a tetrahedron of degree 1 the map is a perspective collineation
//! with centre O, in coordinates about O the matrix [I 0; d d₀] with δ(p) = d·p + d₀. Its axis, the plane δ = 1, keeps its points.
//!
//! To prescribe δ at a point p, one control point is set to δᵢ + (δ − δ(p))/Bᵢ(p), which from rest is the paper's
//! δ₃ = 1 + (δ − 1)/u₃.
//!
//! J. Sánchez-Reyes, J. M. Chacón, *Anamorphic free-form deformation*, CAGD 46 (2016); D. Hansford, D. Collins, *Anamorphic 3D
//! geometry*, Computing 79 (2007).

mod dilation;
mod reference;
mod sight;

use super::entry::{About3, Built3, Case3, Entry, Law3};
use super::ffd::{HULL, hull};
use crate::hull::HullMap;
use crate::lattice::{Lattice3, LatticeMap3};
use crate::map::{Chart, Collineation, Creases3, Fraction3, Jet3, Map3, Poly3, Radial, for_all};
use crate::settings::{Box3, Extent, Settings3, show};
use dilation::{Dilation3, MAX_DEGREE};
use glam::{DMat3, DMat4, DVec3, DVec4};
use pathwarp::Error;
use pathwarp::deform::{Example, Info, Pairs};
use pathwarp::param::{Kind, Param};
use pathwarp::setters;
use std::sync::Arc;

pub use reference::{Eye3, Reference3};

/// A push of a control point, or of a point of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Push3 {
    /// Moves a control point to a multiple of its distance from the eye.
    By([usize; 4], f64),
    /// Moves a control point this much further from the eye.
    Away([usize; 4], f64),
    /// Moves a control point to the point on its ray nearest to this one.
    To([usize; 4], DVec3),
    /// Moves a point of the model to a multiple of its distance from the eye, or this much further from an eye at infinity.
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
                n[..reference.indices()].iter().map(usize::to_string).collect::<Vec<_>>().join(",")
            }
            Self::Prescribe(p, by) => format!("{}:{by}", show(p)),
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
    eye: Eye3,
    reference: Reference3,
    pushes: Vec<Push3>,
    local: bool,
}

impl Anamorph3 {
    /// Makes an anamorphosis that moves nothing yet.
    #[must_use]
    pub fn new(eye: impl Into<Eye3>, reference: Reference3) -> Self {
        Self { eye: eye.into(), reference, pushes: Vec::new(), local: false }
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
        let base = self.base();
        Self { eye: self.eye.relative_to(base), reference: self.reference.clone().relative_to(base), ..self.clone() }
            .build_relative(base)
    }

    /// Returns the point relative to which the map is computed: the origin or, if that is far away, the middle of the reference.
    fn base(&self) -> DVec3 {
        /// Distance of the origin that counts as far, in sizes of the reference.
        const FAR: f64 = 16.0;
        let b = self.reference.bounds();
        if b.center().length() > FAR * b.diagonal() { b.center() } else { DVec3::ZERO }
    }

    /// Builds the map with eye and reference relative to `base`; pushes are absolute.
    fn build_relative(&self, base: DVec3) -> Result<Built3, Error> {
        let nodes = self.reference.nodes();
        let mut values = vec![1.0; nodes.len()];
        for push in &self.pushes {
            self.apply(*push, base, &nodes, &mut values)?;
        }
        let dilation = Dilation3::new(&self.reference, self.eye, &values);
        let linear = dilation.linear().filter(|_| !self.local);
        let map: Arc<dyn Map3> = match (linear, &self.reference) {
            (Some(form), _) => Arc::new(Collineation::about(perspective(self.eye, form), base)),
            (None, Reference3::Spline(..) | Reference3::Hull(_)) => {
                // A rational lattice whose control points have moved, with δ as weights.
                let rest = self.lattice(base);
                let mut lattice = rest.clone();
                for ([i, j, k, _], delta) in nodes.iter().zip(&values).filter(|(_, v)| **v != 1.0) {
                    let node = [*i, *j, *k];
                    lattice.place(node, self.eye.image(rest.point(node) - base, *delta) + base);
                    if let Eye3::At(_) = self.eye {
                        lattice.set_weight(node, *delta * rest.weight(node));
                    }
                }
                match self.reference {
                    Reference3::Hull(_) => Arc::new(HullMap::new(&rest, &lattice)?),
                    _ => Arc::new(LatticeMap3::new(&lattice, !self.local)),
                }
            }
            (None, reference) => {
                let range = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
                let sides = self.local.then(|| dilation.sides(reference).into());
                Arc::new(RadialMap { eye: self.eye, base, dilation, sides, range })
            }
        };
        let mut built = Built3::new(map);
        let bounds = self.reference.bounds();
        let far = 1e4 * bounds.diagonal();
        built.eye = Some(self.eye.before(bounds.center(), far) + base);
        built.note(format!("{} control points; {}", nodes.len(), self.reference.numbers()));
        if let Some(form) = linear {
            let d = form.truncate();
            let (constant, center) = match self.eye {
                Eye3::At(eye) => (form.dot(eye.extend(1.0)), "the eye"),
                Eye3::Infinite(_) => (form.w - d.dot(base), "the origin"),
            };
            built.note(format!("collineation: {},{},{},{constant} about {center} (d and its constant)", d.x, d.y, d.z));
        }
        if let Some([shared, torn]) = self.reference.faces(&values) {
            built.note(format!("continuous across the faces {shared}"));
            if !torn.is_empty() {
                let problem = "outer faces with corners that move, where a model that crosses them is torn";
                built.note(format!("{problem}: {torn}"));
            }
        }
        for (node, delta) in nodes.iter().zip(&values).filter(|(_, v)| **v != 1.0) {
            let from = self.reference.point(*node);
            let to = self.eye.image(from, *delta);
            built.note(format!("control point at {} moves to {}", show(from + base), show(to + base)));
            built.guides.push([self.eye.before(from, 0.0), from, to].map(|p| p + base).to_vec());
        }
        Ok(built)
    }

    /// Returns the lattice at rest of a reference that has one, moved by `base`.
    fn lattice(&self, base: DVec3) -> Lattice3 {
        match self.reference.clone().relative_to(-base) {
            Reference3::Hull(lattice) => lattice,
            Reference3::Spline(region, degree, cells) => Lattice3::regular(region, degree, cells),
            other => Lattice3::regular(other.bounds(), [1; 3], [1; 3]),
        }
    }

    /// Returns the influence of every control point at `p`: the value there of the δ that is 1 at this control point and 0 at all others.
    fn influence(&self, p: DVec3, nodes: &[[usize; 4]]) -> Vec<f64> {
        let mut out = vec![0.0; nodes.len()];
        if let Reference3::Spline(..) | Reference3::Hull(_) = self.reference {
            let lattice = self.lattice(DVec3::ZERO);
            let local = match self.reference {
                Reference3::Hull(_) => {
                    HullMap::new(&lattice, &lattice).ok().and_then(|hull| hull.local(p)).map(|u| u.p)
                }
                _ => Some(p),
            };
            for (node, v) in local.into_iter().flat_map(|u| lattice.influence(u)) {
                out[lattice.index(node)] = v;
            }
            return out;
        }
        let unit = |i: usize| (0..nodes.len()).map(|k| if k == i { 1.0 } else { 0.0 }).collect::<Vec<_>>();
        (0..nodes.len()).for_each(|i| out[i] = Dilation3::new(&self.reference, self.eye, &unit(i)).value(p));
        out
    }

    /// Changes δ at a control point, of which `values` holds one for each of `nodes`.
    fn apply(&self, push: Push3, base: DVec3, nodes: &[[usize; 4]], values: &mut [f64]) -> Result<(), Error> {
        let wrong = |problem: String| Error::usage(push.param(), push.text(&self.reference), problem);
        let check_delta = |delta: f64| {
            let range = if let Eye3::At(_) = self.eye { 1e-6..1e6 } else { -1e12..1e12 };
            let out_of_reach = || wrong("would go through the eye, or out of reach; push it less".into());
            range.contains(&delta).then_some(delta).ok_or_else(out_of_reach)
        };
        let find = |node: [usize; 4]| {
            let missing = || wrong(format!("is not a control point: {}", self.reference.numbers()));
            nodes.iter().position(|n| *n == node).ok_or_else(missing)
        };
        let delta_by = |factor: f64| match self.eye {
            Eye3::At(_) => check_delta(1.0 / factor),
            Eye3::Infinite(_) => Err(wrong(
                "multiplies the distance of an eye at infinity; give a length instead, by `away`, or after a `point`"
                    .into(),
            )),
        };
        let delta_away = |from: DVec3, length: f64| {
            check_delta(match self.eye {
                Eye3::At(eye) => {
                    let distance = (from - eye).length();
                    distance / (distance + length)
                }
                Eye3::Infinite(_) => 1.0 - length,
            })
        };
        match push {
            Push3::By(node, factor) => values[find(node)?] = delta_by(factor)?,
            Push3::Away(node, length) => values[find(node)?] = delta_away(self.reference.point(node), length)?,
            Push3::To(node, to) => {
                let (i, from, to) = (find(node)?, self.reference.point(node), to - base);
                values[i] = check_delta(match self.eye {
                    Eye3::At(eye) => (from - eye).length_squared() / (to - eye).dot(from - eye),
                    Eye3::Infinite(towards) => 1.0 + (to - from).dot(towards),
                })?;
            }
            Push3::Prescribe(p, value) => {
                let p = p - base;
                let wanted = if let Eye3::At(_) = self.eye { delta_by(value)? } else { delta_away(p, value)? };
                let influence = self.influence(p, nodes);
                let here: f64 = influence.iter().zip(&*values).map(|(b, v)| b * v).sum();
                let free = (0..nodes.len()).filter(|i| !self.reference.is_held(nodes[*i], self.local));
                let strongest = free.map(|i| (i, influence[i])).max_by(|a, b| a.1.total_cmp(&b.1));
                let (i, b) = strongest.filter(|(_, b)| *b > 1e-9).ok_or_else(|| {
                    wrong("is on a fixed face, or no control point is free to move; raise `degree` or choose another `reference`".into())
                })?;
                values[i] = check_delta(values[i] + (wanted - here) / b)?;
            }
        }
        Ok(())
    }
}

/// Returns the matrix of p ↦ O + (p − O)/δ for a linear form δ in (x, y, z, 1). For the eye (O, w) it is (p + O·(δ − 1), 1 + w·(δ − 1)).
fn perspective(eye: Eye3, delta: DVec4) -> DMat4 {
    let (d, eye) = (delta.truncate(), eye.homogeneous());
    let columns = [eye * d.x, eye * d.y, eye * d.z, eye * (delta.w - 1.0)];
    DMat4::IDENTITY + DMat4::from_cols(columns[0], columns[1], columns[2], columns[3])
}

// The map p̂ = O + (p − O)/δ(p), and its inverse along each ray.

/// Distance from a side of the moved region, relative to the coordinates, within which points count as on it.
const ROUNDING: f64 = 1e-12;

/// Returns the value of a linear form in (x, y, z, 1), or 0 if that is rounding. Forms are positive inside the side that they describe.
fn signed_side(form: &DVec4, p: DVec3) -> f64 {
    let q = p.extend(1.0);
    let v = form.dot(q);
    if v.abs() <= ROUNDING * form.abs().dot(q.abs()) { 0.0 } else { v }
}

/// The map that moves every point along its ray through the eye.
#[derive(Debug, Clone)]
struct RadialMap {
    /// The eye, relative to `base`, as are `dilation` and `sides`.
    eye: Eye3,
    base: DVec3,
    dilation: Dilation3,
    /// For a local map, forms in (x, y, z, 1) that are all nonnegative where points move.
    sides: Option<Arc<[DVec4]>>,
    /// The smallest and the largest δ of a control point.
    range: (f64, f64),
}

impl RadialMap {
    /// Returns `true` if a point may move.
    fn moves(&self, p: DVec3) -> bool {
        self.sides.as_deref().is_none_or(|forms| forms.iter().all(|f| signed_side(f, p - self.base) >= 0.0))
    }

    /// Returns δ of the tetrahedron around a box as a linear form, or 1 outside all of them; `None` if a face may cross the box.
    fn linear_on(&self, on: &Box3) -> Option<DVec4> {
        self.dilation.around(&on.corners().map(|p| p - self.base))
    }

    /// Returns the map with δ = `divisor`/`common`.
    fn along_rays(&self, chart: Chart, divisor: Poly3, common: Poly3) -> Fraction3 {
        match self.eye {
            Eye3::At(eye) => Fraction3::radial(chart, eye + self.base, divisor, &common),
            Eye3::Infinite(towards) => Fraction3::shifted(chart, towards, &divisor, common),
        }
    }

    /// Returns `true` if a whole box moves, `false` if none of it does, or `None` if a side of the moved region may cross it.
    fn moves_on(&self, on: &Box3) -> Option<bool> {
        let corners = on.corners();
        // The moved region is convex, so a box is inside if its corners are, and outside if they are all behind one side.
        if corners.iter().all(|p| self.moves(*p)) {
            return Some(true);
        }
        let behind = |f: &DVec4| corners.iter().all(|p| signed_side(f, *p - self.base) <= 0.0);
        self.sides.as_deref().is_some_and(|forms| forms.iter().any(behind)).then_some(false)
    }
}

impl Map3 for RadialMap {
    fn jet(&self, p: DVec3) -> Jet3 {
        if !self.moves(p) {
            return Jet3::identity(p);
        }
        let local = p - self.base;
        let (delta, slope) = self.dilation.jet(local);
        let outer = |v: DVec3| DMat3::from_cols(v * slope.x, v * slope.y, v * slope.z);
        match self.eye {
            Eye3::At(eye) => {
                let d = (DMat3::IDENTITY - outer(local - eye) * (1.0 / delta)) * (1.0 / delta);
                Jet3 { p: self.eye.image(local, delta) + self.base, d }
            }
            Eye3::Infinite(towards) => Jet3 { p: p + towards * (delta - 1.0), d: DMat3::IDENTITY + outer(towards) },
        }
    }

    fn point(&self, p: DVec3) -> DVec3 {
        if !self.moves(p) {
            return p;
        }
        let local = p - self.base;
        self.eye.image(local, self.dilation.value(local)) + self.base
    }

    fn points(&self, ps: &mut [DVec3]) {
        match (&self.dilation, self.eye) {
            (Dilation3::Cuboid { local, tensor }, Eye3::At(eye))
                if self.sides.is_none() && self.base == DVec3::ZERO =>
            {
                for_all(&Radial { local: *local, eye, tensor }, ps);
            }
            _ => ps.iter_mut().for_each(|p| *p = self.point(*p)),
        }
    }

    fn fraction(&self, on: &Box3, max: usize) -> Option<Fraction3> {
        let chart = Chart::on(on);
        if let Dilation3::Tetrahedra(_) = self.dilation {
            let delta = chart.relative_to(self.base).linear(self.linear_on(on)?);
            return Some(self.along_rays(chart, delta, Poly3::constant(1.0)));
        }
        if !self.moves_on(on)? {
            return Some(Fraction3::identity(chart));
        }
        if self.dilation.degree() > max {
            return None;
        }
        let (divisor, common) = self.dilation.fraction(&chart.relative_to(self.base));
        Some(self.along_rays(chart, divisor, common))
    }

    fn branch(&self, on: &Box3) -> Option<Arc<dyn Map3>> {
        if let Dilation3::Tetrahedra(_) = self.dilation {
            return Some(Arc::new(Collineation::about(perspective(self.eye, self.linear_on(on)?), self.base)));
        }
        Some(match self.moves_on(on)? {
            true => Arc::new(Self { sides: None, ..self.clone() }),
            false => Arc::new(Collineation::IDENTITY),
        })
    }

    fn creases(&self, out: &mut Creases3) {
        let base = self.base;
        let mut forms = self.sides.as_deref().unwrap_or_default().to_vec();
        if let Dilation3::Tetrahedra(all) = &self.dilation {
            forms.extend(all.iter().flat_map(|t| t.0));
        }
        for form in forms {
            out.kink(move |p| form.dot((p - base).extend(1.0)));
        }
        if let Eye3::At(_) = self.eye {
            let map = self.clone();
            out.edge(move |p| {
                let delta = if map.moves(p) { map.dilation.value(p - base) } else { 1.0 };
                if delta.is_nan() { -1.0 } else { delta }
            });
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

/// The points from which a point q may have come, relative to the base: O + s·(q − O), or q − (s − 1)·O for O at infinity.
struct Ray {
    from: DVec3,
    along: DVec3,
}

impl RadialInverse {
    fn ray(&self, q: DVec3) -> Ray {
        match self.0.eye {
            Eye3::At(eye) => Ray { from: eye, along: q - self.0.base - eye },
            Eye3::Infinite(towards) => Ray { from: q - self.0.base + towards, along: -towards },
        }
    }

    /// Returns δ − s at the parameter s of a ray, and its derivative.
    fn residual(&self, r: &Ray, s: f64) -> (f64, f64) {
        let (delta, slope) = self.0.dilation.jet(r.from + r.along * s);
        (delta - s, slope.dot(r.along) - 1.0)
    }

    /// Finds the root near `s` by Newton's method. The slope must be negative: then the map keeps the order of points along the ray.
    fn newton(&self, r: &Ray, mut s: f64) -> Option<f64> {
        let is_ahead = |s: f64| s.is_finite() && (s > 0.0 || matches!(self.0.eye, Eye3::Infinite(_)));
        for _ in 0..MAX_STEPS {
            let (residual, slope) = self.residual(r, s);
            let next = s - residual / slope;
            if !is_ahead(next) {
                return None;
            }
            let is_still = (next - s).abs() <= 2.0 * f64::EPSILON * s.abs();
            s = next;
            if is_still {
                return (slope < 0.0).then_some(s);
            }
        }
        let (residual, slope) = self.residual(r, s);
        (residual.abs() <= 64.0 * f64::EPSILON * s.abs().max(1.0) && slope < 0.0).then_some(s)
    }

    /// Returns the parameter s of the source of `q`, at which s = δ.
    fn parameter(&self, q: DVec3) -> Option<f64> {
        let r = self.ray(q);
        let (least, most) = self.0.range;
        let is_infinite = matches!(self.0.eye, Eye3::Infinite(_));
        if self.0.dilation.is_sheet() {
            return Some(self.0.dilation.value(q - self.0.base)).filter(|d| *d > 0.0 || is_infinite);
        }
        let margin = BEYOND * (most - least + 1e-9);
        let (min, max) = if is_infinite { (least - margin, most + margin) } else { (least / BEYOND, most * BEYOND) };
        let found = self.newton(&r, 1.0).filter(|s| (min..=max).contains(s));
        found.or_else(|| {
            let sample = |i: u32| {
                let t = f64::from(i) / f64::from(INTERVALS);
                if is_infinite { min + t * (max - min) } else { min * (max / min).powf(t) }
            };
            let falls = |i: &u32| self.residual(&r, sample(*i)).0 >= 0.0 && self.residual(&r, sample(i + 1)).0 < 0.0;
            (0..INTERVALS).filter(falls).find_map(|i| self.bisect(&r, sample(i), sample(i + 1)))
        })
    }

    /// Bisects between `a`, where the residual is positive, and `b`, where it is negative.
    fn bisect(&self, r: &Ray, mut a: f64, mut b: f64) -> Option<f64> {
        for _ in 0..64 {
            let m = 0.5 * (a + b);
            if self.residual(r, m).0 >= 0.0 { a = m } else { b = m }
        }
        let s = 0.5 * (a + b);
        (self.residual(r, s).0.abs() <= 1e-12 * s.abs().max(1.0)).then_some(s)
    }

    fn source(&self, q: DVec3) -> Option<DVec3> {
        let ray = self.ray(q);
        let point_at = |s: f64| ray.from + ray.along * s + self.0.base;
        let source = self.parameter(q).map(point_at).filter(|p| self.0.moves(*p));
        // Points outside the moved region stay, unless points from inside have moved there.
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

/// A pentahedron as deep as the frame of laws and cases.
const PRISM: &str = "0,0,0 100,0,0 0,100,0 0,0,100 100,0,100 0,100,100";

/// A tetrahedron in the frame of laws and cases.
const TETRAHEDRON: &str = "0,0,0 100,0,0 0,100,0 0,0,100";

static ABOUT: About3 = About3 {
    info: Info::new("anamorph", "deform a model so that it looks unchanged from one place")
        .group("Perspective and anamorphosis")
        .about("Moves every point along its ray through the eye (--eye), so that the picture from there stays the same, and from \
everywhere else the model is distorted: Ames rooms, sculptures that come together at one spot, reliefs.\n\n\
Control points of a reference (--reference) are pushed along their rays, and the model follows:\n  \
four points: a tetrahedron, whose control points I,J,K,L add up to the degree. At degree 1 planes stay plane.\n  \
six points: a pentahedron, three corners and those opposite. I,J,K add up to the degree, and L counts along the edges.\n  \
two points: a box with control points I,J,K from the left, bottom and back; if it is flat, a sheet.\n  \
three points: a triangle as a sheet, control points I,J,K. All points of a ray through a sheet are moved by one factor.\n\n\
With --local nothing outside the reference moves: leave the control points of the face where the model leaves the reference in \
place, or a second layer of them for a smooth transition.")
        .source("J. Sánchez-Reyes, J. M. Chacón, Anamorphic free-form deformation, CAGD 46, 2016; D. Hansford, D. Collins, \
Anamorphic 3D geometry, Computing 79, 2007")
        .params(&[
            Param::new("eye", Kind::Text("X,Y,Z|inf:DX,DY,DZ"), "The place from which the model looks unchanged; inf: and a direction, or two \
angles to the right and up from the front such as inf:30deg,20deg, for an eye at infinity, where the picture is a parallel projection.")
            .needed(),
            Param::new("reference", Kind::Text("X,Y,Z …"), "Corners of the reference: four points, six, three, or two opposite corners of a \
box. Default: the model's box."),
            Param::new("degree", Kind::Text("N|LxMxN"), "Degree of the reference, 1 to 10; a box may have one along each axis, a pentahedron NxNxM.").default("1"),
            Param::flag("spline", "B-splines over the box: each control point has influence on a few cells only."),
            Param::new("cells", Kind::Text("LxMxN"), "Cells of the B-splines along x, y and z, 1 to 16 each: there are degree + cells \
control points. Default with --spline: 4x4x4."),
            Param::new("tetrahedra", Kind::Text("I,J,K,L …"), "Several tetrahedra at once, by the numbers of their corners among the points \
of the --reference, from 0; pushes name a point by its number, such as 4:150%. Nothing moves outside, and shared faces do not tear.")
            .repeated(),
            HULL,
            Param::new("collineation", Kind::Text("DX,DY,DZ,D"), "A collineation by its numbers: δ(p) = (DX,DY,DZ)·(p − eye) + D, as \
--explain prints them. For an eye at infinity p is not relative to it, and 1 − δ is the length of the move."),
            Param::new("axis", Kind::Text("X,Y,Z X,Y,Z X,Y,Z"), "A collineation by three points of its axis, the plane that stays; one \
--point sets how far."),
            Param::new("push", Kind::Text("NODE:FACTOR"), "Take control point I,J,K (or I,J,K,L) to FACTOR times its distance from the \
eye, such as 1,1,0:150%.")
            .repeated(),
            Param::new("away", Kind::Text("NODE:LENGTH"), "Take a control point LENGTH further from the eye; a negative one comes closer.")
                .repeated(),
            Param::new("at", Kind::Text("NODE:X,Y,Z"), "Take a control point to the point of its ray nearest to X,Y,Z.").repeated(),
            Param::new("point", Kind::Text("X,Y,Z:FACTOR|LENGTH"), "Take a point of the model to FACTOR times its distance from the eye, or a \
length with its unit further, by the \
control point that has most influence there and is not on the fixed face (the first three corners of a tetrahedron).")
            .repeated(),
            Param::flag("local", "Leave everything outside the reference in place."),
            Param::new("sight-hole", Kind::Save, "Save a rod on the ray from the eye through the middle of the model (OBJ). Cut out of the \
printed result, as a negative volume of the slicer, it leaves a hole through which the eye finds its place."),
        ])
        .demo(&[("eye", "50,60,400"), ("degree", "2x1x1"), ("push", "1,1,0:1.6 0,0,1:0.8")])
        .examples(&[
            Example {
                what: "Stretch a model away from the eye: a perspective collineation, with the rod of a sighting hole",
                command: "solid anamorph samples/solid/teapot.obj --eye 50%,60%,600% --reference '0%,0%,100% 100%,0%,100% 0%,100%,100% 50%,50%,-50%' \
--push 0,0,0,1:160% --sight-hole out.hole.obj -o out.obj",
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
        // Raising the degree of the tetrahedron changes nothing: δ of the middles of edges are means.
        Law3::Same(
            &[("eye", "50,60,300"), ("reference", TETRAHEDRON), ("push", "0,0,0,1:0.5")],
            &[("eye", "50,60,300"), ("reference", TETRAHEDRON), ("degree", "2"),
              ("push", "0,0,0,2:0.5 1,0,0,1:66.66666666666667% 0,1,0,1:66.66666666666667% 0,0,1,1:66.66666666666667%")],
        ),
        // Control point 1,1,1 is √(50² + 40² + 200²) = 210 away from the eye, so that doubling its distance adds 210.
        Law3::Same(
            &[("eye", "50,60,300"), ("push", "1,1,1:2")],
            &[("eye", "50,60,300"), ("away", "1,1,1:210.0")],
        ),
        Law3::Identity(&[("eye", "inf:1,2,3")]),
        Law3::Identity(&[("eye", "50,50,300"), ("cells", "2x3x2"), ("degree", "2")]),
        Law3::Identity(&[("eye", "50,50,300"), ("collineation", "0,0,0,1")]),
        Law3::KeepsRays(&[("eye", "50,60,300"), ("degree", "2"), ("cells", "3x2x2"), ("push", "1,2,1:1.3 3,0,0:0.7")], [50.0, 60.0, 300.0]),
        Law3::KeepsPlanes(&[("eye", "inf:0.2,0.3,1"), ("reference", TETRAHEDRON), ("away", "0,0,0,1:40 1,0,0,0:-20")]),
        // With one cell, B-splines are Bernstein polynomials.
        Law3::Same(
            &[("eye", "50,60,300"), ("degree", "3x2x1"), ("push", "1,1,1:1.3 2,0,0:0.7")],
            &[("eye", "50,60,300"), ("degree", "3x2x1"), ("cells", "1"), ("push", "1,1,1:1.3 2,0,0:0.7")],
        ),
        // A tetrahedron with one corner at twice the distance: δ falls from 1 at z = 0 to 1/2 at z = 100.
        Law3::Same(
            &[("eye", "50,60,300"), ("reference", TETRAHEDRON), ("push", "0,0,0,1:2")],
            &[("eye", "50,60,300"), ("collineation", "0,0,-0.005,-0.5")],
        ),
        Law3::Same(
            &[("eye", "50,60,300"), ("reference", TETRAHEDRON), ("push", "0,0,0,1:2")],
            &[("eye", "50,60,300"), ("axis", "7,9,0 1,0,0 0,1,0"), ("point", "0,0,100:2")],
        ),
        Law3::Same(
            &[("eye", "inf:0,0,2"), ("reference", TETRAHEDRON), ("away", "0,0,0,1:30")],
            &[("eye", "inf:0deg,0deg"), ("collineation", "0,0,-0.3,1")],
        ),
        Law3::Identity(&[("eye", "50,50,300"), ("reference", PRISM), ("degree", "3x3x2"), ("push", "1,1,1,1:1")]),
        Law3::KeepsRays(&[("eye", "50,60,300"), ("reference", PRISM), ("degree", "2x2x3"), ("push", "1,1,0,2:1.3 0,0,2,0:0.8")], [50.0, 60.0, 300.0]),
        Law3::KeepsRays(&[("eye", "50,60,300"), ("reference", PRISM), ("push", "1,0,0,1:1.4"), ("local", "true")], [50.0, 60.0, 300.0]),
        // A pentahedron that changes along its edges alone acts as a box: δ depends on z.
        Law3::Same(
            &[("eye", "50,60,300"), ("reference", PRISM), ("degree", "1x1x2"), ("push", "1,0,0,1:1.25 0,1,0,1:1.25 0,0,1,1:1.25")],
            &[("eye", "50,60,300"), ("degree", "1x1x2"), ("push", "0,0,1:1.25 1,0,1:1.25 0,1,1:1.25 1,1,1:1.25")],
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
    let eye = eye(s)?;
    let mut built = build(s, eye)?;
    let rod = s.last("sight-hole").map(|name| sight::rod(eye, &s.bounds(), &built, name));
    built.saves.extend(rod);
    Ok(built)
});

/// Builds the map for these settings.
fn build(s: &Settings3<'_>, eye: Eye3) -> Result<Built3, Error> {
    let (mut points, axis, form) = (s.listed_points("reference")?, s.listed_points("axis")?, collineation_form(s)?);
    let degree = s.counts_if("degree", MAX_DEGREE)?.unwrap_or([1; 3]);
    let cells = match s.counts_if("cells", MAX_CELLS)? {
        None if s.flat().flag("spline")? => Some([4; 3]),
        given => given,
    };
    let local = s.flat().flag("local")?;
    if let Some(form) = form {
        let others = ["reference", "axis", "cells", "push", "point", "away", "at"];
        if let Some(name) = others.iter().find(|n| s.flat().given(n)) {
            let problem = "cannot go with `collineation`, which has all numbers already; omit one of them";
            return Err(Error::usage(name, "", problem));
        }
        return Ok(build_collineation(eye, form));
    }
    let mut pushes = Vec::new();
    if let [a, b, c] = axis[..] {
        let wrong =
            || Error::missing("point", "one point X,Y,Z:FACTOR and where it goes; `axis` needs it, and nothing else");
        let [Push3::Prescribe(p, _)] = prescribed(s)?[..] else { return Err(wrong()) };
        if !points.is_empty() || cells.is_some() || degree != [1; 3] {
            return Err(wrong());
        }
        // The three points stay, so all depends on the fourth corner.
        points = vec![a, b, c, p];
        pushes = prescribed(s)?;
    } else if !axis.is_empty() {
        return Err(Error::usage("axis", "", "must have three points"));
    }
    if points.is_empty() {
        points = vec![s.bounds().min, s.bounds().max];
    }
    let hull = hull(s, &["reference", "degree", "cells", "spline", "tetrahedra", "axis", "local"])?;
    let reference = match (cells, &points[..]) {
        _ if let Some(hull) = hull => Reference3::Hull(hull),
        (None, _) if !s.words("tetrahedra").is_empty() => tetrahedra(s, points)?,
        (Some(cells), [a, b]) => Reference3::spline(Box3::new(*a, *b), degree, cells)?,
        (Some(_), _) => return Err(Error::usage("cells", "", "are for a box: give two corners of the `reference`")),
        (None, _) => Reference3::new(&points, degree, eye)?,
    };
    if pushes.is_empty() {
        pushes = node_pushes(s, &reference)?;
        pushes.extend(prescribed(s)?);
    }
    pushes.into_iter().fold(Anamorph3::new(eye, reference).local(local), Anamorph3::push).build()
}

/// Reads the eye.
fn eye(s: &Settings3<'_>) -> Result<Eye3, Error> {
    let missing = || Error::missing("eye", "the place from which the model looks unchanged");
    let text = s.last("eye").ok_or_else(missing)?;
    let Some(direction) = text.strip_prefix("inf:") else { return Ok(Eye3::At(s.point_in("eye", text)?)) };
    let parts: Vec<&str> = direction.split(',').map(str::trim).collect();
    let number = |text: &str| s.flat().number_in("eye", text);
    let towards = match parts[..] {
        [right, up] => {
            let angle = |text: &str| s.flat().angle_in("eye", text).map(f64::to_radians);
            let (right, up) = (angle(right)?, angle(up)?);
            DVec3::new(right.sin() * up.cos(), up.sin(), right.cos() * up.cos())
        }
        [x, y, z] => DVec3::new(number(x)?, number(y)?, number(z)?),
        _ => return Err(Error::usage("eye", text, "is not inf:DX,DY,DZ or inf: and two angles such as 30deg,20deg")),
    };
    let none = || Error::usage("eye", text, "has no direction; give one, such as inf:1,0,2");
    towards.try_normalize().map(Eye3::Infinite).ok_or_else(none)
}

/// Reads the numbers of a collineation.
fn collineation_form(s: &Settings3<'_>) -> Result<Option<DVec4>, Error> {
    let Some(text) = s.last("collineation") else { return Ok(None) };
    let all: Result<Vec<f64>, Error> = text.split(',').map(|t| s.flat().number_in("collineation", t)).collect();
    match all?[..] {
        [x, y, z, d] if DVec4::new(x, y, z, d).is_finite() => Ok(Some(DVec4::new(x, y, z, d))),
        _ => Err(Error::usage("collineation", text, "is not four numbers DX,DY,DZ,D")),
    }
}

/// Builds the collineation with δ(p) = d·(p − O) + d₀, or d·p + d₀ for an eye at infinity.
fn build_collineation(eye: Eye3, form: DVec4) -> Built3 {
    let base = eye.before(DVec3::ZERO, 0.0);
    let mut built = Built3::new(Arc::new(Collineation::about(perspective(eye.relative_to(base), form), base)));
    built.eye = matches!(eye, Eye3::At(_)).then_some(base);
    built
}

/// Reads tetrahedra, each by the numbers of its corners among the points of the reference.
fn tetrahedra(s: &Settings3<'_>, points: Vec<DVec3>) -> Result<Reference3, Error> {
    let read = |word: &str| {
        let numbers: Vec<usize> = word.split(',').filter_map(|t| t.trim().parse().ok()).collect();
        let wrong = |_| Error::usage("tetrahedra", word, "is not four numbers of points I,J,K,L");
        <[usize; 4]>::try_from(numbers).map_err(wrong)
    };
    Reference3::tetrahedra(points, s.words("tetrahedra").into_iter().map(read).collect::<Result<_, _>>()?)
}

/// Highest number of cells of B-splines along an axis.
const MAX_CELLS: usize = 16;

/// Reads the pushes of control points.
fn node_pushes(s: &Settings3<'_>, reference: &Reference3) -> Result<Vec<Push3>, Error> {
    let mut out = Vec::new();
    for name in ["push", "away", "at"] {
        for word in s.words(name) {
            let (node, value) = match reference.indices() {
                4 => s.flat().node_in::<4>(name, word)?,
                1 => s.flat().node_in::<1>(name, word).map(|([i], value)| ([i, 0, 0, 0], value))?,
                _ => s.flat().node_in::<3>(name, word).map(|([i, j, k], value)| ([i, j, k, 0], value))?,
            };
            out.push(match name {
                "push" => Push3::By(node, s.flat().number_in(name, value)?),
                "away" => Push3::Away(node, s.length_in(name, value, Extent::Diagonal)?),
                _ => Push3::To(node, s.point_in(name, value)?),
            });
        }
    }
    Ok(out)
}

/// Reads the pushes of points.
fn prescribed(s: &Settings3<'_>) -> Result<Vec<Push3>, Error> {
    let mut out = Vec::new();
    for word in s.words("point") {
        let wrong = || Error::usage("point", word, "is not X,Y,Z:FACTOR, such as 10,20,30:150%");
        let (p, factor) = word.split_once(':').ok_or_else(wrong)?;
        let p = s.point_in("point", p)?;
        let is_infinite = s.last("eye").is_some_and(|t| t.starts_with("inf"));
        let value = match is_infinite {
            true => s.length_in("point", factor, Extent::Diagonal)?,
            false => s.flat().number_in("point", factor)?,
        };
        out.push(Push3::Prescribe(p, value));
    }
    Ok(out)
}
