//! Proof that the Jacobian determinant det J keeps its sign on a box, for maps made of quotients of polynomials.
//!
//! For F = (X, Y)/W of degree d, W³·det J is the determinant of (X, Y, W) and their two partial derivatives: a polynomial of degree
//! 3(d − 1), or 2(d − 1) if W = 1. Its values at sufficiently many Chebyshev nodes determine its coefficients cᵢⱼ for the products
//! of Chebyshev polynomials Tᵢ(s)·Tⱼ(t). Because |Tᵢ| ≤ 1, it has no zero if
//!
//! > |c₀₀| > Σ |cᵢⱼ|, (i, j) ≠ (0, 0)
//!
//! A box for which this fails is divided into four. Two values of different signs end the attempt.

use crate::map::{Crease, Creases, Jet, Level, Map, RationalBezier, RationalDegree};
use kurbo::{Point, Rect};
use std::f64::consts::PI;
use std::sync::Arc;

/// Highest degree of the determinant. Above it, one box would take more samples than most drawings.
const MAX_DEGREE: usize = 24;
/// Limit on successive divisions of a box into four. Near a zero of det J every division fails.
const MAX_DEPTH: usize = 6;
/// Generous bound for rounding errors of the values and their sums, some hundred times 2⁻⁵², relative to the largest product in det J.
const ROUNDING: f64 = 1e-10;

/// Returns the sign that det J has in all of `bounds`, as 1 or −1, if it can be proven with at most `samples` jets.
///
/// The map may have creases parallel to the axes. With other creases, or where a denominator vanishes, nothing is proven.
pub(super) fn proven(map: &dyn Map, bounds: Rect, samples: usize) -> Option<f64> {
    let mut jets_left = samples;
    let mut common = None;
    for (cell, branch) in pieces(map, bounds, samples)? {
        let sign = Proof::new(branch.as_deref().unwrap_or(map), cell, &mut jets_left)?.sign(cell, MAX_DEPTH)?;
        if *common.get_or_insert(sign) != sign {
            return None;
        }
    }
    common
}

/// A cell, and the branch of the map that is smooth on it; `None` if the map itself is.
type Piece = (Rect, Option<Arc<dyn Map>>);

/// Divides `bounds` along the creases. `None` if a crease is not parallel to an axis, or if there would be more than `max` pieces.
fn pieces(map: &dyn Map, bounds: Rect, max: usize) -> Option<Vec<Piece>> {
    if map.branch(bounds.center()).is_none() {
        return Some(vec![(bounds, None)]);
    }
    let mut creases = Creases::default();
    map.creases(&mut creases);
    let (mut xs, mut ys) = (vec![bounds.x0, bounds.x1], vec![bounds.y0, bounds.y1]);
    for Crease { level, .. } in creases.items() {
        match *level {
            Level::Line { a, b, c } | Level::Stretch { a, b, c, .. } => match (a == 0.0, b == 0.0) {
                (false, true) => xs.push(-c / a),
                (true, false) => ys.push(-c / b),
                _ => return None,
            },
            Level::Circle { .. } | Level::Field(_) => return None,
        }
    }
    let sorted_within = |mut cuts: Vec<f64>, from: f64, to: f64| {
        cuts.retain(|v| (from..=to).contains(v));
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        cuts
    };
    let (xs, ys) = (sorted_within(xs, bounds.x0, bounds.x1), sorted_within(ys, bounds.y0, bounds.y1));
    if xs.len() * ys.len() > max {
        return None;
    }
    let mut out = Vec::with_capacity(xs.len() * ys.len());
    for y in ys.windows(2) {
        for x in xs.windows(2) {
            let cell = Rect::new(x[0], y[0], x[1], y[1]);
            out.push((cell, Some(map.branch(cell.center())?)));
        }
    }
    Some(out)
}

/// Returns the degree of a smooth map as a quotient of polynomials, which the map declares or the exact image of a line shows.
fn rational_degree(map: &dyn Map, bounds: Rect) -> Option<RationalDegree> {
    map.rational_degree().or_else(|| {
        let diagonal = [bounds.origin(), Point::new(bounds.x1, bounds.y1)];
        let image = map.image(&RationalBezier::polynomial(&diagonal))?;
        image.is_polynomial().then(|| RationalDegree::polynomial(image.degree()))
    })
}

/// A proof for one smooth piece.
struct Proof<'a> {
    map: &'a dyn Map,
    rational: bool,
    /// Interpolates det J, or W³·det J.
    basis: Chebyshev,
    /// Jets that may still be taken.
    jets_left: &'a mut usize,
}

impl<'a> Proof<'a> {
    fn new(map: &'a dyn Map, bounds: Rect, jets_left: &'a mut usize) -> Option<Self> {
        let RationalDegree { degree: d, rational } = rational_degree(map, bounds)?;
        // The nodes are also used for W, whose degree is d.
        let of_derivative = d.saturating_sub(1);
        let degree = if rational { of_derivative.checked_mul(3)?.max(d) } else { of_derivative.checked_mul(2)? };
        (degree <= MAX_DEGREE).then(|| Self { map, rational, basis: Chebyshev::new(degree), jets_left })
    }

    /// Returns the sign of det J in a cell, which may be divided `depth` times.
    fn sign(&mut self, cell: Rect, depth: usize) -> Option<f64> {
        let n = self.basis.nodes.len();
        *self.jets_left = self.jets_left.checked_sub(n * n)?;
        // Maps s from −1 to 1 onto an interval.
        let scale = |from: f64, to: f64, s: f64| 0.5 * ((to + from) + (to - from) * s);
        let (mut points, mut jets) = (Vec::with_capacity(n * n), vec![Jet::default(); n * n]);
        for t in &self.basis.nodes {
            let y = scale(cell.y0, cell.y1, *t);
            points.extend(self.basis.nodes.iter().map(|s| Point::new(scale(cell.x0, cell.x1, *s), y)));
        }
        self.map.jets(&points, &mut jets);
        let mut values: Vec<f64> = jets.iter().map(Jet::det).collect();
        let mut sizes: Vec<f64> = jets.iter().map(|j| j.dx.hypot() * j.dy.hypot()).collect();
        let mut is_w_positive = true;
        if self.rational {
            let denominators: Vec<f64> = points.iter().map(|p| self.map.denominator(*p)).collect();
            for ((v, size), w) in values.iter_mut().zip(&mut sizes).zip(&denominators) {
                let cube = w * w * w;
                (*v, *size) = (*v * cube, *size * cube.abs());
            }
            is_w_positive = self.basis.sign(&denominators, largest(&denominators)) == Some(1.0);
        }
        if values.iter().any(|v| *v < 0.0) && values.iter().any(|v| *v > 0.0) {
            return None;
        }
        match self.basis.sign(&values, largest(&sizes)) {
            Some(sign) if is_w_positive => Some(sign),
            _ if depth == 0 => None,
            _ => {
                let c = cell.center();
                let quarters = [(cell.x0, cell.y0), (cell.x1, cell.y0), (cell.x0, cell.y1), (cell.x1, cell.y1)];
                let mut signs = quarters.into_iter().map(|p| self.sign(Rect::from_points(p, c), depth - 1));
                let first = signs.next()??;
                signs.all(|s| s == Some(first)).then_some(first)
            }
        }
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| f64::max(m, v.abs()))
}

/// Interpolation at n × n Chebyshev nodes, exact for polynomials of degree n − 1 in each variable.
struct Chebyshev {
    /// cos(π(k + ½)/n).
    nodes: Vec<f64>,
    /// Row i gives the coefficient of Tᵢ from the values at the nodes.
    rows: Vec<f64>,
}

impl Chebyshev {
    fn new(degree: usize) -> Self {
        let n = degree + 1;
        let angle = |k: usize| PI * (k as f64 + 0.5) / n as f64;
        let row = |i: usize| {
            let scale = if i == 0 { 1.0 } else { 2.0 } / n as f64;
            (0..n).map(move |k| scale * (i as f64 * angle(k)).cos())
        };
        Self { nodes: (0..n).map(|k| angle(k).cos()).collect(), rows: (0..n).flat_map(row).collect() }
    }

    /// Returns the sign of the polynomial with these `values`, row by row, if the inequality shows that it has no zero in the square.
    /// Rounding errors are at most [`ROUNDING`] times `size`.
    fn sign(&self, values: &[f64], size: f64) -> Option<f64> {
        let n = self.nodes.len();
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let (mut constant, mut others) = (0.0, ROUNDING * size);
        // Transform the rows, then the columns.
        let across: Vec<f64> = values.chunks(n).flat_map(|v| self.rows.chunks(n).map(move |r| dot(r, v))).collect();
        let mut column = vec![0.0; n];
        for i in 0..n {
            for (c, row) in column.iter_mut().zip(across.chunks(n)) {
                *c = row[i];
            }
            for (j, r) in self.rows.chunks(n).enumerate() {
                let c = dot(r, &column);
                if (i, j) == (0, 0) {
                    constant = c;
                } else {
                    others += c.abs();
                }
            }
        }
        (constant.abs() > others).then(|| constant.signum())
    }
}

#[cfg(test)]
mod tests;
