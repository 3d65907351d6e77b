//! Exact images: a rational map of a rational patch is a rational patch.
//!
//! Under a collineation (degree 1) p̂ = p/δ and ŵ = w·δ for control points and weights, whatever the knots. Under a map of degree d
//! a patch of degree m × n becomes one of degree dm × dn, by products of Bernstein polynomials.

use super::bernstein::Scaled;
use super::bezier::{BezierPatch, MAX_DEGREE};
use super::knots;
use super::surface::Surface;
use crate::map::{Collineation, Fraction3, Map3};
use glam::{DVec4, Vec4Swizzles as _};
use pathwarp::budget::{Budget, Exceeded};
use std::collections::BTreeMap;

/// The exact image under a map, if it is a surface with positive weights of a degree that is allowed.
///
/// # Errors
/// More work than the limit allows.
pub(super) fn image(surface: &Surface, map: &dyn Map3, budget: &Budget) -> Result<Option<Surface>, Exceeded> {
    let out = match map.collineation() {
        Some(c) => Some(projected(surface, c)),
        None => composed(surface, map, budget)?,
    };
    let sound = |s: &Surface| s.weights.iter().all(|w| *w > 0.0) && s.points.iter().all(|p| p.is_finite());
    Ok(out.filter(sound))
}

fn projected(surface: &Surface, map: &Collineation) -> Surface {
    let mut out = surface.clone();
    for (p, w) in out.points.iter_mut().zip(&mut out.weights) {
        let q = map.matrix() * p.extend(1.0);
        (*p, *w) = (q.xyz() / q.w, *w * q.w);
    }
    out
}

/// The map on each piece.
fn fractions(
    pieces: &[BezierPatch],
    map: &dyn Map3,
    most: usize,
    budget: &Budget,
) -> Result<Option<Vec<Fraction3>>, Exceeded> {
    let mut out: Vec<Fraction3> = Vec::with_capacity(pieces.len());
    for piece in pieces {
        // About as much work as so many evaluations of the map; the first piece tells for the others.
        let d = out.last().map_or(most, Fraction3::degree) + 1;
        budget.spend(d.pow(4) as f64)?;
        match piece.bounds().and_then(|b| map.fraction(&b, most)) {
            Some(fraction) => out.push(fraction),
            None => return Ok(None),
        }
    }
    Ok(Some(out))
}

fn composed(surface: &Surface, map: &dyn Map3, budget: &Budget) -> Result<Option<Surface>, Exceeded> {
    let (pieces, breaks) = surface.pieces();
    let most = MAX_DEGREE / surface.degree[0].max(surface.degree[1]);
    let all = fractions(&pieces, map, most, budget)?;
    Ok(all.and_then(|fractions| joined(surface, &pieces, &breaks, &fractions)))
}

fn joined(
    surface: &Surface,
    pieces: &[BezierPatch],
    breaks: &[Vec<f64>; 2],
    fractions: &[Fraction3],
) -> Option<Surface> {
    /// Control points that two pieces share agree within this share of the surface's size, unless the map tears them apart.
    const SAME: f64 = 1e-9;
    if fractions.iter().all(Fraction3::is_identity) {
        return Some(surface.clone());
    }
    let d = fractions.iter().map(Fraction3::degree).max()?.max(1);
    let degree = surface.degree.map(|n| n * d);
    if degree.iter().any(|n| *n > MAX_DEGREE) {
        return None;
    }
    let spans = breaks.each_ref().map(|b| b.len() - 1);
    let size = [0, 1].map(|a| spans[a] * degree[a] + 1);
    let mut grid: Vec<Option<DVec4>> = vec![None; size[0] * size[1]];
    let near = SAME * surface.bounds()?.diagonal();
    for (n, (piece, fraction)) in pieces.iter().zip(fractions).enumerate() {
        let corner = [n % spans[0] * degree[0], n / spans[0] * degree[1]];
        for (k, p) in substituted(piece, fraction, d).into_iter().enumerate() {
            let (i, j) = (corner[0] + k % (degree[0] + 1), corner[1] + k / (degree[0] + 1));
            let slot = &mut grid[j * size[0] + i];
            match slot {
                Some(q) if (q.xyz() / q.w).distance(p.xyz() / p.w) > near || (q.w - p.w).abs() > SAME * p.w.abs() => {
                    return None;
                }
                _ => *slot = Some(p),
            }
        }
    }
    let all: Vec<DVec4> = grid.into_iter().collect::<Option<_>>()?;
    let polynomial = !surface.is_rational() && fractions.iter().all(|f| f.parts[3].is_one());
    Some(Surface {
        name: surface.name.clone(),
        degree,
        knots: [0, 1].map(|a| knots::joined(degree[a], &breaks[a])),
        points: all.iter().map(|p| p.xyz() / p.w).collect(),
        // Products round the weights of a polynomial surface, which are known.
        weights: all.iter().map(|p| if polynomial { 1.0 } else { p.w }).collect(),
        trims: surface.trims.clone(),
    })
}

/// The control points of a map of a patch, made homogeneous of degree `d`.
fn substituted(piece: &BezierPatch, fraction: &Fraction3, d: usize) -> Vec<DVec4> {
    let (middle, half) = (fraction.chart.middle(), fraction.chart.half());
    let scaled = |f: &dyn Fn(&DVec4) -> f64| Scaled::new(piece.degree, piece.points.iter().map(f)).powers(d);
    let axis = |a: usize| scaled(&move |p| (p[a] - middle[a] * p.w) / half[a]);
    let (coordinates, below) = ([axis(0), axis(1), axis(2)], scaled(&|p| p.w));
    let mut terms: BTreeMap<[usize; 3], [f64; 4]> = BTreeMap::new();
    for (k, part) in fraction.parts.iter().enumerate() {
        part.terms().for_each(|(powers, c)| terms.entry(*powers).or_default()[k] = c);
    }
    let mut sums = [(); 4].map(|()| Scaled::zero(piece.degree.map(|n| n * d)));
    for ([i, j, k], c) in terms {
        let product =
            coordinates[0][i].times(&coordinates[1][j]).times(&coordinates[2][k]).times(&below[d - i - j - k]);
        sums.iter_mut().zip(c).for_each(|(s, c)| s.add(c, &product));
    }
    let [x, y, z, w] = sums.map(|s| s.bernstein());
    (0..w.len()).map(|i| DVec4::new(x[i], y[i], z[i], w[i])).collect()
}
