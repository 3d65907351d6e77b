//! Images of surfaces: exact ones where the map is rational and the degree allows it, otherwise bicubic patches within a tolerance.
//!
//! For an approximate image, every Bézier patch is cut into n × n cells, with one n for all patches of a model, so that patches that share
//! an edge still do. A cell has the position, both tangents and the twist of the exact image at its corners; so neighbours join smoothly,
//! and the error falls with n⁴. The distance is measured at equal parameters, on a grid within each cell.
//!
//! The exact image of a rational patch under a rational map is a rational patch. Under a collineation (degree 1), p̂ = p/δ and ŵ = w·δ for
//! control points and weights, whatever the knots. Under a map of degree d, a patch of degree m × n becomes one of degree dm × dn, by
//! products of Bernstein polynomials.

use super::surface::{self, BezierPatch, MAX_DEGREE, Scaled, Surface};
use crate::map::{Chain3, Collineation, Fraction3, Map3};
use crate::settings::grid;
use glam::{DVec3, DVec4, Vec4Swizzles as _};
use pathwarp::budget::{Budget, Exceeded};
use std::collections::BTreeMap;

/// Limit on cells along a side of a patch. Only at a crease, where cells converge slowly, would more be needed.
pub(super) const MAX_CELLS: usize = 64;
/// Distance from a crease at which derivatives are taken, in the parameters. A power of two, so that neighbours use the same points.
pub(super) const INSET: f64 = 1.0 / 1_048_576.0;
/// Samples along each side of a cell at which the distance is measured.
pub(super) const SAMPLES: usize = 4;

/// The image of a patch as n × n bicubic cells.
pub(super) struct Cells {
    n: usize,
    /// (3n + 1)² control points, u fastest.
    points: Vec<DVec3>,
    /// The largest distance measured.
    pub(super) distance: f64,
}

/// The image of a point of the patch, its derivatives by u and v, and the mixed one.
pub(super) type Corner = [DVec3; 4];

/// Returns the image of a point of the patch, and its derivatives by u and v.
fn tangents(patch: &BezierPatch, map: &dyn Map3, u: f64, v: f64) -> [DVec3; 3] {
    let [p, du, dv] = patch.jet(u, v);
    let jet = map.jet(p);
    [jet.p, jet.d * du, jet.d * dv]
}

fn corner(patch: &BezierPatch, map: &dyn Map3, [u, v]: [f64; 2], n: usize, inset: f64) -> Corner {
    let [inner_u, inner_v] = [u, v].map(|t| t.clamp(inset, 1.0 - inset));
    // The twist is a difference quotient of tangents, with about this relative error. It moves one control point of a cell, by a ninth.
    let h = 1e-4 / n as f64;
    let (before, after) = ((v - h).max(inset), (v + h).min(1.0 - inset));
    let [p, du, dv] = tangents(patch, map, u, v);
    let across = |v: f64| tangents(patch, map, inner_u, v)[1];
    let twist = (across(after) - across(before)) / (after - before);
    if [u, v] == [inner_u, inner_v] {
        return [p, du, dv, twist];
    }
    let beside = tangents(patch, map, inner_u, inner_v);
    if is_torn(p, &beside, inset) {
        return [beside[0], beside[1], beside[2], twist];
    }
    // Neighbours agree on the derivative along a shared side; across it, each has the derivative on its side.
    [p, across(v), tangents(patch, map, u, inner_v)[2], twist]
}

/// Returns `true` if the image `p` of a point is much farther from the image `beside` it, `inset` away in the parameters, than the
/// derivatives there explain.
pub(super) fn is_torn(p: DVec3, [beside, ds, dt]: &[DVec3; 3], inset: f64) -> bool {
    const FAR: f64 = 100.0;
    p.distance(*beside) > FAR * inset * (ds.length() + dt.length())
}

/// Returns the number of evaluations that n × n cells take.
pub(super) fn work(patch: &BezierPatch, n: usize) -> f64 {
    let samples = (n * SAMPLES + 1) * (n * SAMPLES + 1);
    (patch.work() * (3 * (n + 1) * (n + 1) + samples)) as f64
}

/// Fits n × n cells and measures their distance from the image. Derivatives at the sides are taken `inset` from them, in the parameters:
/// 0, or [`INSET`] if a crease may lie along a side.
pub(super) fn fit(patch: &BezierPatch, map: &dyn Map3, n: usize, inset: f64) -> Cells {
    let parameters = grid([n + 1, n + 1, 1]).map(|[i, j, _]| [i as f64 / n as f64, j as f64 / n as f64]);
    let mut out = Cells::new(n, parameters.map(|uv| corner(patch, map, uv, n, inset)).collect());
    out.measure(|_, u, v| map.point(patch.point(u, v)));
    out
}

impl Cells {
    /// Makes the cells with these corners, u fastest.
    pub(super) fn new(n: usize, corners: Vec<Corner>) -> Self {
        let width = 3 * n + 1;
        let mut points = vec![DVec3::ZERO; width * width];
        let step = 1.0 / (3.0 * n as f64);
        for (k, [p, du, dv, twist]) in corners.into_iter().enumerate() {
            let (i, j) = (3 * (k % (n + 1)), 3 * (k / (n + 1)));
            for [a, b, _] in grid([3, 3, 1]) {
                // The control points from one before to one after the corner, along u and v.
                let (x, y) = ((i + a).wrapping_sub(1), (j + b).wrapping_sub(1));
                if x < width && y < width {
                    let (s, t) = ((a as f64 - 1.0) * step, (b as f64 - 1.0) * step);
                    points[y * width + x] = p + du * s + dv * t + twist * (s * t);
                }
            }
        }
        Self { n, points, distance: 0.0 }
    }

    /// Measures the distance from an image, given as a function of the number of the column, u and v.
    pub(super) fn measure(&mut self, image: impl Fn(usize, f64, f64) -> DVec3) {
        let samples = (self.n * SAMPLES) as f64;
        for [column, row, _] in grid([self.n, self.n, 1]) {
            let cell = self.cell(column, row);
            for [k, l, _] in grid([SAMPLES, SAMPLES, 1]) {
                let (i, j) = (column * SAMPLES + k, row * SAMPLES + l);
                let (u, v) = ((i as f64 + 0.5) / samples, (j as f64 + 0.5) / samples);
                let fitted = cell.point(u * self.n as f64 - column as f64, v * self.n as f64 - row as f64);
                let distance = fitted.distance(image(i, u, v));
                self.distance = if distance.is_nan() { f64::INFINITY } else { self.distance.max(distance) };
            }
        }
    }

    /// Iterates over rows of control points, u fastest.
    pub(super) fn rows(&self) -> impl DoubleEndedIterator<Item = &[DVec3]> {
        self.points.chunks(3 * self.n + 1)
    }

    fn cell(&self, i: usize, j: usize) -> BezierPatch {
        let width = 3 * self.n + 1;
        let point = |[a, b, _]: [usize; 3]| self.points[(3 * j + b) * width + 3 * i + a].extend(1.0);
        BezierPatch { degree: [3, 3], points: grid([4, 4, 1]).map(point).collect() }
    }
}

/// Joins the images of a surface's patches, u fastest, all with one number of cells.
pub(super) fn join_cells(surface: &Surface, breaks: &[Vec<f64>; 2], pieces: &[Cells]) -> Surface {
    let n = pieces.first().map_or(1, |c| c.n);
    let spans = breaks.each_ref().map(|b| b.len() - 1);
    let size = spans.map(|s| 3 * n * s + 1);
    let mut points = vec![DVec3::ZERO; size[0] * size[1]];
    for (k, piece) in pieces.iter().enumerate() {
        let corner = [(k % spans[0]) * 3 * n, (k / spans[0]) * 3 * n];
        for (m, p) in piece.points.iter().enumerate() {
            points[(corner[1] + (m / (3 * n + 1))) * size[0] + corner[0] + (m % (3 * n + 1))] = *p;
        }
    }
    let cut = |b: &Vec<f64>| -> Vec<f64> {
        let inner = b.windows(2).flat_map(|w| (0..n).map(move |i| w[0] + (w[1] - w[0]) * (i as f64 / n as f64)));
        inner.chain(b.last().copied()).collect()
    };
    Surface {
        name: surface.name.clone(),
        degree: [3, 3],
        knots: breaks.each_ref().map(|b| surface::bezier_knots(3, &cut(b))),
        weights: vec![1.0; points.len()],
        points,
        trims: surface.trims.clone(),
    }
}

/// Returns the exact image under a map, if it is a surface of allowed degree with positive weights.
///
/// # Errors
/// [`Exceeded`] when it takes more work than the budget allows.
pub(super) fn exact_image(surface: &Surface, map: &Chain3, budget: &Budget) -> Result<Option<Surface>, Exceeded> {
    let mut out = surface.clone();
    for step in map.steps() {
        let image = match step.collineation() {
            Some(c) => Some(projected(&out, c)),
            None => {
                let (pieces, breaks) = out.pieces();
                let max = MAX_DEGREE / out.degree[0].max(out.degree[1]);
                fractions(&pieces, step, max, budget)?.and_then(|f| compose(&out, &pieces, &breaks, &f))
            }
        };
        let is_sound = |s: &Surface| s.weights.iter().all(|w| *w > 0.0) && s.points.iter().all(|p| p.is_finite());
        let Some(image) = image.filter(is_sound) else { return Ok(None) };
        out = image;
    }
    Ok(Some(out))
}

fn projected(surface: &Surface, map: &Collineation) -> Surface {
    let mut out = surface.clone();
    for (p, w) in out.points.iter_mut().zip(&mut out.weights) {
        let q = map.homogeneous(*p);
        (*p, *w) = (q.xyz() / q.w, *w * q.w);
    }
    out
}

/// Returns the map on each piece as a fraction of polynomials of degree `max` or less.
fn fractions(
    pieces: &[BezierPatch],
    map: &dyn Map3,
    max: usize,
    budget: &Budget,
) -> Result<Option<Vec<Fraction3>>, Exceeded> {
    let mut out: Vec<Fraction3> = Vec::with_capacity(pieces.len());
    for piece in pieces {
        // Finding a fraction takes about as much work as this many evaluations. A piece is assumed to have the degree of the one before.
        let d = out.last().map_or(max, Fraction3::degree) + 1;
        budget.spend(d.pow(4) as f64)?;
        match piece.bounds().and_then(|b| map.fraction(&b, max)) {
            Some(fraction) => out.push(fraction),
            None => return Ok(None),
        }
    }
    Ok(Some(out))
}

/// Returns the image of a surface from the map on each of its pieces, if the degree allows it and the pieces' images join.
fn compose(
    surface: &Surface,
    pieces: &[BezierPatch],
    breaks: &[Vec<f64>; 2],
    fractions: &[Fraction3],
) -> Option<Surface> {
    /// Distance within which control points shared by two pieces agree if the map tears nothing, as a fraction of the surface's size.
    const ROUNDING: f64 = 1e-9;
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
    let mut all: Vec<Option<DVec4>> = vec![None; size[0] * size[1]];
    let slack = ROUNDING * surface.bounds()?.diagonal();
    for (n, (piece, fraction)) in pieces.iter().zip(fractions).enumerate() {
        let corner = [(n % spans[0]) * degree[0], (n / spans[0]) * degree[1]];
        for (k, p) in substituted(piece, fraction, d).into_iter().enumerate() {
            let (i, j) = (corner[0] + (k % (degree[0] + 1)), corner[1] + (k / (degree[0] + 1)));
            let differs =
                |q: DVec4| (q.xyz() / q.w).distance(p.xyz() / p.w) > slack || (q.w - p.w).abs() > ROUNDING * p.w.abs();
            if all[j * size[0] + i].replace(p).is_some_and(differs) {
                return None;
            }
        }
    }
    let all: Vec<DVec4> = all.into_iter().collect::<Option<_>>()?;
    let is_polynomial = !surface.is_rational() && fractions.iter().all(|f| f.parts[3].is_one());
    Some(Surface {
        name: surface.name.clone(),
        degree,
        knots: [0, 1].map(|a| surface::bezier_knots(degree[a], &breaks[a])),
        points: all.iter().map(|p| p.xyz() / p.w).collect(),
        // The weights of a polynomial surface are known to be 1; products would round them.
        weights: all.iter().map(|p| if is_polynomial { 1.0 } else { p.w }).collect(),
        trims: surface.trims.clone(),
    })
}

/// Returns the homogeneous control points of a patch's image under a map, raised to degree `d`.
fn substituted(piece: &BezierPatch, fraction: &Fraction3, d: usize) -> Vec<DVec4> {
    let (middle, half) = (fraction.chart.middle(), fraction.chart.half());
    let scaled = |f: &dyn Fn(&DVec4) -> f64| Scaled::new(piece.degree, piece.points.iter().map(f)).powers(d);
    let axis = |a: usize| scaled(&move |p| (p[a] - middle[a] * p.w) / half[a]);
    let (coordinates, weights) = ([axis(0), axis(1), axis(2)], scaled(&|p| p.w));
    let mut terms: BTreeMap<[usize; 3], [f64; 4]> = BTreeMap::new();
    for (k, part) in fraction.parts.iter().enumerate() {
        part.terms().for_each(|(powers, c)| terms.entry(*powers).or_default()[k] = c);
    }
    let mut sums = [(); 4].map(|()| Scaled::zero(piece.degree.map(|n| n * d)));
    for ([i, j, k], c) in terms {
        let product = coordinates[0][i].times(&coordinates[1][j]).times(&coordinates[2][k]);
        let product = product.times(&weights[d - i - j - k]);
        sums.iter_mut().zip(c).for_each(|(s, c)| s.add(c, &product));
    }
    let [x, y, z, w] = sums.map(|s| s.bernstein());
    (0..w.len()).map(|i| DVec4::new(x[i], y[i], z[i], w[i])).collect()
}
