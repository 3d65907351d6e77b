//! Polynomials in three variables as lists of terms, and quotients of them, as which maps describe themselves.

use super::local::Local;
use crate::settings::Box3;
use glam::{DVec3, DVec4};
use std::collections::BTreeMap;

/// A polynomial in x, y and z.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Poly3(BTreeMap<[usize; 3], f64>);

impl Poly3 {
    pub(crate) fn constant(v: f64) -> Self {
        let mut out = Self::default();
        out.add_term([0; 3], v);
        out
    }

    pub(crate) fn add_term(&mut self, powers: [usize; 3], c: f64) {
        if c != 0.0 {
            *self.0.entry(powers).or_default() += c;
        }
    }

    /// Iterates over the terms, as powers and coefficients.
    pub(crate) fn terms(&self) -> impl Iterator<Item = (&[usize; 3], f64)> {
        self.0.iter().map(|(powers, c)| (powers, *c))
    }

    /// Returns the largest sum of powers.
    pub(crate) fn degree(&self) -> usize {
        self.0.keys().map(|p| p.iter().sum()).max().unwrap_or(0)
    }

    /// Returns `true` if the polynomial is 1 everywhere.
    pub(crate) fn is_one(&self) -> bool {
        self.0.len() == 1 && self.0.get(&[0; 3]) == Some(&1.0)
    }

    /// Adds `k` times another polynomial.
    pub(crate) fn add(&mut self, k: f64, other: &Self) {
        other.terms().for_each(|(powers, c)| self.add_term(*powers, k * c));
    }

    /// Returns the sum of this and `k` times another polynomial.
    #[must_use]
    pub(crate) fn plus(&self, k: f64, other: &Self) -> Self {
        let mut out = self.clone();
        out.add(k, other);
        out
    }

    #[must_use]
    pub(crate) fn times(&self, other: &Self) -> Self {
        let mut out = Self::default();
        for (p, a) in self.terms() {
            for (q, b) in other.terms() {
                out.add_term(std::array::from_fn(|k| p[k] + q[k]), a * b);
            }
        }
        out
    }

    /// Returns the powers from 0 to `n`.
    pub(crate) fn powers(&self, n: usize) -> Vec<Self> {
        let mut out = vec![Self::constant(1.0)];
        for k in 0..n {
            out.push(out[k].times(self));
        }
        out
    }
}

/// Coordinates from −1 to 1 across a box, in which polynomials over the box are well conditioned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chart {
    middle: DVec3,
    half: DVec3,
}

impl Chart {
    /// Makes the coordinates of a box.
    #[must_use]
    pub fn on(b: &Box3) -> Self {
        // Any scale will do along an axis on which the box is flat.
        let size = 0.5 * b.size();
        let min = if size.max_element() > 0.0 { 1e-3 * size.max_element() } else { 1.0 };
        Self { middle: b.center(), half: size.max(DVec3::splat(min)) }
    }

    /// Returns the middle of the box.
    pub(crate) fn middle(&self) -> DVec3 {
        self.middle
    }

    /// Returns half the size of the box.
    pub(crate) fn half(&self) -> DVec3 {
        self.half
    }

    /// Returns the chart of the same box in coordinates relative to a point.
    pub(crate) fn relative_to(self, base: DVec3) -> Self {
        Self { middle: self.middle - base, ..self }
    }

    /// Returns a linear form in (x, y, z, 1) as a polynomial in the coordinates.
    pub(crate) fn linear(&self, form: DVec4) -> Poly3 {
        let mut out = Poly3::constant(form.dot(self.middle.extend(1.0)));
        for (a, v) in (form.truncate() * self.half).to_array().into_iter().enumerate() {
            let mut powers = [0; 3];
            powers[a] = 1;
            out.add_term(powers, v);
        }
        out
    }

    /// Returns x, y and z as polynomials in the coordinates.
    pub(crate) fn xyz(&self) -> [Poly3; 3] {
        [0, 1, 2].map(|a| self.linear(DVec3::AXES[a].extend(0.0)))
    }

    /// Returns the coordinates of another box as polynomials in the coordinates of this one.
    pub(crate) fn local(&self, other: &Local) -> [Poly3; 3] {
        [0, 1, 2].map(|a| {
            let scale = other.scale[a];
            self.linear((DVec3::AXES[a] * scale).extend(-other.middle[a] * scale))
        })
    }
}

/// A map as a quotient of polynomials in the coordinates of a [`Chart`].
#[derive(Debug, Clone, PartialEq)]
pub struct Fraction3 {
    pub(crate) chart: Chart,
    /// Three numerators and the common denominator.
    pub(crate) parts: [Poly3; 4],
}

impl Fraction3 {
    /// Makes the identity.
    #[must_use]
    pub fn identity(chart: Chart) -> Self {
        let [x, y, z] = chart.xyz();
        Self { chart, parts: [x, y, z, Poly3::constant(1.0)] }
    }

    /// Makes the map O + (p − O)·`common`/`divisor`, with the point O = `eye`.
    pub(crate) fn radial(chart: Chart, eye: DVec3, divisor: Poly3, common: &Poly3) -> Self {
        let [x, y, z] = chart.xyz();
        let part = |p: Poly3, o: f64| p.plus(-o, &Poly3::constant(1.0)).times(common).plus(o, &divisor);
        Self { chart, parts: [part(x, eye.x), part(y, eye.y), part(z, eye.z), divisor] }
    }

    /// Makes the map p + `along`·(`divisor`/`common` − 1).
    pub(crate) fn shifted(chart: Chart, along: DVec3, divisor: &Poly3, common: Poly3) -> Self {
        let by = divisor.plus(-1.0, &common);
        let [x, y, z] = chart.xyz();
        let part = |p: Poly3, v: f64| p.times(&common).plus(v, &by);
        Self { chart, parts: [part(x, along.x), part(y, along.y), part(z, along.z), common] }
    }

    /// Returns `true` if nothing moves.
    #[must_use]
    pub fn is_identity(&self) -> bool {
        *self == Self::identity(self.chart)
    }

    /// Returns the largest sum of powers.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.parts.iter().map(Poly3::degree).max().unwrap_or(0)
    }
}
