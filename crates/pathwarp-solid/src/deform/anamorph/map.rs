//! The map p̂ = O + (p − O)/δ(p), and its inverse along each ray.

use super::dilation::Dilation3;
use crate::box3::Box3;
use crate::map::{Chart, Collineation, Creases3, Fraction3, Jet3, Map3, Radial, for_all};
use glam::{DMat3, DVec3, DVec4};
use std::sync::Arc;

/// Points this close to a side of the moved region, relative to the coordinates, are on it.
const ROUNDING: f64 = 1e-12;

/// A form in (x, y, z, 1) at a point, 0 on a side of the moved region.
fn beyond(form: &DVec4, p: DVec3) -> f64 {
    let q = p.extend(1.0);
    let v = form.dot(q);
    if v.abs() <= ROUNDING * form.abs().dot(q.abs()) { 0.0 } else { v }
}

/// Every point moves along its ray through the eye.
#[derive(Debug, Clone)]
pub(super) struct RadialMap {
    pub(super) eye: DVec3,
    pub(super) dilation: Dilation3,
    /// If the map is local: forms in (x, y, z, 1) of which none is negative where points move.
    pub(super) within: Option<Arc<[DVec4]>>,
    /// The least and the largest δ of a control point.
    pub(super) range: (f64, f64),
}

impl RadialMap {
    /// Returns `true` if the point may move.
    fn moves(&self, p: DVec3) -> bool {
        self.within.as_deref().is_none_or(|forms| forms.iter().all(|f| beyond(f, p) >= 0.0))
    }

    /// Returns whether a box moves or stays; `None` if the end of the moved region may cross it.
    fn moves_on(&self, on: &Box3) -> Option<bool> {
        let corners = on.corners();
        // The moved region is convex: a box is inside if its corners are, and outside if one side has all of them behind it.
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

/// The inverse: on the ray of q = O + r the point O + s·r with s = δ(O + s·r).
#[derive(Debug, Clone)]
struct RadialInverse(RadialMap);

/// Steps of Newton's method along a ray.
const STEPS: usize = 50;
/// Places along a ray at which a root is looked for if Newton's method finds none.
const PLACES: u32 = 96;
/// The range in which they lie exceeds that of the control points' δ by this factor.
const BEYOND: f64 = 8.0;

impl RadialInverse {
    /// δ(O + s·r) − s and its slope.
    fn off(&self, r: DVec3, s: f64) -> (f64, f64) {
        let (delta, slope) = self.0.dilation.jet(self.0.eye + r * s);
        (delta - s, slope.dot(r) - 1.0)
    }

    /// The root near `s`. Where the map keeps the order of points along the ray, the slope is negative.
    fn newton(&self, r: DVec3, mut s: f64) -> Option<f64> {
        for _ in 0..STEPS {
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
        let (least, most) = (self.0.range.0 / BEYOND, self.0.range.1 * BEYOND);
        let found = self.newton(r, 1.0).filter(|s| (least..=most).contains(s));
        found.or_else(|| {
            let place = |i: u32| least * (most / least).powf(f64::from(i) / f64::from(PLACES));
            let falls = |i: &u32| self.off(r, place(*i)).0 >= 0.0 && self.off(r, place(i + 1)).0 < 0.0;
            (0..PLACES).filter(falls).find_map(|i| self.bisected(r, place(i), place(i + 1)))
        })
    }

    /// The root between a place where the difference is positive and one where it is negative.
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
        // Outside points stay where they are, unless points from inside are there.
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
