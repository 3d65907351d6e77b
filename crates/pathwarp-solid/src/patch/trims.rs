//! Trimming loops of the parts of a surface: clipped at the part's sides, in the coordinates of the part.
//!
//! A loop is clipped like a polygon (I. E. Sutherland, G. W. Hodgman, *Reentrant polygon clipping*, CACM 17, 1974): parts beyond a side
//! are omitted, and the ends are joined along the side. Clipped loops may run along a side to and fro; that does not change which points
//! an odd number of loops surrounds.

use super::crossing::Graphs;
use super::part::section;
use super::surface::{self, Surface, TrimCurve};
use glam::DVec4;

/// A Bézier curve in homogeneous coordinates (u·w, v·w, 0, w).
type Curve = Vec<DVec4>;

/// Distance from a side within which parameters count as on it, and area up to which loops are omitted.
const ROUNDING: f64 = 1e-12;
/// Number of equal parts of a curve; a crossing of a layer's side is searched for in each.
const STEPS: usize = 48;
/// Limit on halvings of a curve to fit it.
const MAX_HALVINGS: usize = 8;

/// The loops of a part over 0..1 × 0..1. A point belongs to the surface if an odd number of loops surrounds it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Trims(Vec<Vec<Curve>>);

impl Trims {
    /// Returns the loops of a surface in its parameters, or `None` if it is not trimmed.
    pub(super) fn from_surface(surface: &Surface) -> Option<Self> {
        let curves = |t: &TrimCurve| {
            let points = t.points.iter().zip(&t.weights).map(|([u, v], w)| DVec4::new(u * w, v * w, 0.0, *w));
            let row = surface::bezier_row(t.degree, &t.knots, &points.collect::<Vec<_>>());
            (0..(row.len() - 1) / t.degree).map(|i| row[i * t.degree..=(i + 1) * t.degree].to_vec()).collect::<Vec<_>>()
        };
        let loops: Vec<Vec<Curve>> = surface.trims.iter().map(|l| l.iter().flat_map(curves).collect()).collect();
        (!loops.is_empty()).then_some(Self(loops))
    }

    /// Returns polygons through many points of the loops.
    pub(super) fn polygons(&self) -> Vec<Vec<[f64; 2]>> {
        self.0.iter().map(|l| polygon(l)).collect()
    }

    /// Returns `true` if no point of the part belongs to the surface.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(super) fn count(&self) -> usize {
        self.0.iter().map(Vec::len).sum()
    }

    /// Returns the loops of the part over `from[0]`..`to[0]` × `from[1]`..`to[1]`, or `None` if all of it belongs to the surface.
    pub(super) fn part(&self, from: [f64; 2], to: [f64; 2]) -> Option<Self> {
        let to_part = |p: &DVec4| {
            let coordinate = |a: usize| (p[a] - from[a] * p.w) / (to[a] - from[a]);
            DVec4::new(coordinate(0), coordinate(1), 0.0, p.w)
        };
        let sides = [DVec4::X, DVec4::W - DVec4::X, DVec4::Y, DVec4::W - DVec4::Y];
        let clip_all = |curves: &Vec<Curve>| {
            let curves = curves.iter().map(|c| c.iter().map(to_part).collect()).collect();
            sides.iter().fold(curves, |curves: Vec<Curve>, side| clip(&curves, *side))
        };
        Self(self.0.iter().map(clip_all).collect()).reduced()
    }

    pub(super) fn transposed(&self) -> Self {
        let swap = |c: &Curve| c.iter().map(|p| DVec4::new(p.y, p.x, 0.0, p.w)).collect();
        Self(self.0.iter().map(|l| l.iter().map(swap).collect()).collect())
    }

    /// Returns the loops of a layer, the part above the curve `layer` − 1 of `graphs` (or v = 0) and below the curve `layer` (or v = 1), as
    /// cubics within a tolerance, or `None` if all of the layer belongs to the surface. Its coordinates are s = u and t from 0 to 1.
    pub(super) fn layer(&self, graphs: &Graphs<'_>, layer: usize, tolerance: f64) -> Option<Self> {
        let to_layer = |p: [f64; 2]| {
            let [low, high] = graphs.sides(layer, p[0]).map(|[height, _slope]| height);
            // Where the sides meet, t is huge, so that a point counts as below both or above both.
            [p[0], (p[1] - low) / (high - low).max(ROUNDING)]
        };
        let follow_all = |curves: &Vec<Curve>| {
            let mut follower = LayerFollower { tolerance, ..LayerFollower::default() };
            follower.beyond = curves.last().and_then(|c| side_of(to_layer(point(c, 1.0 - ON_SIDE))[1])); // The end may lie on a side.
            for curve in curves {
                let point_at = |t: f64| to_layer(point(curve, t));
                spans(&point_at).into_iter().for_each(|span| follower.follow(&point_at, span));
            }
            follower.kept.closed()
        };
        Self(self.0.iter().map(follow_all).collect()).reduced()
    }

    /// Returns the loops as trimming curves of a surface.
    pub(super) fn curves(&self) -> Vec<Vec<TrimCurve>> {
        let curve = |c: &Curve| TrimCurve {
            degree: c.len() - 1,
            knots: surface::single_span_knots(c.len() - 1),
            points: c.iter().map(|p| [p.x / p.w, p.y / p.w]).collect(),
            weights: c.iter().map(|p| p.w).collect(),
        };
        self.0.iter().map(|l| l.iter().map(curve).collect()).collect()
    }

    /// Returns the part without loops around nothing and without pairs of loops around the whole part, or `None` if a single loop around
    /// the whole part is left.
    fn reduced(self) -> Option<Self> {
        /// Fraction of the part that a loop must surround to count as a loop around all of it.
        const ALL: f64 = 1.0 - 1e-9;
        let with_area = self.0.into_iter().map(|l| (area(&l), l)).filter(|(a, _)| *a > ROUNDING);
        let (mut whole, some): (Vec<_>, Vec<_>) = with_area.partition(|(a, _)| *a >= ALL);
        if whole.len() % 2 == 1 && some.is_empty() {
            return None;
        }
        whole.truncate(whole.len() % 2);
        Some(Self(whole.into_iter().chain(some).map(|(_, l)| l).collect()))
    }
}

/// Distance from a side within which parameters of a fitted loop count as on it.
const ON_SIDE: f64 = 1e-9;

/// Returns the side beyond which a height is, `true` for t = 1; `None` inside the layer.
fn side_of(t: f64) -> Option<bool> {
    if (-ON_SIDE..=1.0 + ON_SIDE).contains(&t) { None } else { Some(t > 0.5) }
}

/// Moves a point into the layer, and onto a side that it is near.
fn snap([s, t]: [f64; 2]) -> [f64; 2] {
    match t.clamp(0.0, 1.0) {
        t if t < ON_SIDE => [s, 0.0],
        t if t > 1.0 - ON_SIDE => [s, 1.0],
        t => [s, t],
    }
}

fn point(curve: &Curve, t: f64) -> [f64; 2] {
    let (p, _) = surface::curve(curve.iter().copied(), t);
    [p.x / p.w, p.y / p.w]
}

fn line([a, b]: [[f64; 2]; 2]) -> Curve {
    [a, b].map(|[u, v]| DVec4::new(u, v, 0.0, 1.0)).to_vec()
}

/// Returns the polygon with many corners on each curve of a loop.
fn polygon(curves: &[Curve]) -> Vec<[f64; 2]> {
    const CORNERS: usize = 16;
    curves.iter().flat_map(|c| (0..CORNERS).map(|i| point(c, i as f64 / CORNERS as f64))).collect()
}

/// Returns the area inside a loop, approximated by the area of its polygon. Exact if all curves are straight.
fn area(curves: &[Curve]) -> f64 {
    let corners = polygon(curves);
    let next = corners.iter().cycle().skip(1);
    0.5 * corners.iter().zip(next).map(|(p, q)| p[0] * q[1] - p[1] * q[0]).sum::<f64>().abs()
}

/// The curves of a loop that are kept, joined by straight lines where others are omitted.
#[derive(Default)]
struct Kept {
    curves: Vec<Curve>,
    /// `true` if curves were omitted after the last one that is kept.
    gap: bool,
    /// `true` if curves were omitted before the first one.
    gap_first: bool,
}

impl Kept {
    fn leave_out(&mut self) {
        self.gap = true;
        self.gap_first |= self.curves.is_empty();
    }

    fn add(&mut self, curve: Curve) {
        if std::mem::take(&mut self.gap)
            && let Some(last) = self.curves.last()
        {
            self.join(point(last, 1.0), point(&curve, 0.0));
        }
        self.curves.push(curve);
    }

    fn closed(mut self) -> Vec<Curve> {
        if let (true, Some(first), Some(last)) = (self.gap || self.gap_first, self.curves.first(), self.curves.last()) {
            self.join(point(last, 1.0), point(first, 0.0));
        }
        self.curves
    }

    fn join(&mut self, a: [f64; 2], b: [f64; 2]) {
        if (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) > ROUNDING {
            self.curves.push(line([a, b]));
        }
    }
}

/// Follows a loop through a layer.
///
/// Where the sides of the layer meet, all heights t are one point, and the loop may pass all of them at once. In the coordinates of the
/// layer, it then runs along a line across the layer.
#[derive(Default)]
struct LayerFollower {
    kept: Kept,
    /// The side beyond which the loop is, as returned by [`side_of`].
    beyond: Option<bool>,
    /// The point that the loop has reached, once a curve is kept. Before that no line leads to a side; [`Kept::closed`] joins the ends.
    last: [f64; 2],
    tolerance: f64,
}

impl LayerFollower {
    /// Follows a curve between two of its parameters, where it is all inside the layer or all beyond one side.
    fn follow(&mut self, curve: &dyn Fn(f64) -> [f64; 2], [from, to]: [f64; 2]) {
        let height = |side: bool| f64::from(u8::from(side));
        let (start, side) = (snap(curve(from)), side_of(curve(0.5 * (from + to))[1]));
        match (self.beyond, side) {
            (Some(old), Some(new)) if old != new => self.cross(start[0], height(old), height(new)),
            (Some(old), None) => self.cross(start[0], height(old), start[1]),
            (None, Some(new)) if !self.kept.curves.is_empty() => self.cross(self.last[0], self.last[1], height(new)),
            _ => {}
        }
        if side.is_some() {
            self.kept.leave_out();
        } else {
            let curves = fit_cubics(&|t| snap(curve(t)), [from, to], self.tolerance, MAX_HALVINGS);
            curves.into_iter().for_each(|c| self.kept.add(c));
        }
        (self.beyond, self.last) = (side, snap(curve(to)));
    }

    /// Adds a line across the layer.
    fn cross(&mut self, s: f64, from: f64, to: f64) {
        if (from - to).abs() > ON_SIDE {
            self.kept.add(line([[s, from], [s, to]]));
        }
    }
}

/// Clips a loop: omits the parts where a linear form in (u, v, 0, 1) is negative.
fn clip(curves: &[Curve], side: DVec4) -> Vec<Curve> {
    let mut kept = Kept::default();
    for curve in curves {
        let values: Vec<f64> = curve.iter().map(|p| height_above(side, *p)).collect();
        let mut cuts = vec![0.0];
        roots(&values, 0.0, 1.0, &mut cuts);
        cuts.push(1.0);
        for w in cuts.windows(2).filter(|w| w[0] < w[1]) {
            let piece = if cuts.len() == 2 { curve.clone() } else { section(curve, w[0], w[1]) };
            if height_above(side, surface::curve(piece.iter().copied(), 0.5).0) >= 0.0 {
                kept.add(piece);
            } else {
                kept.leave_out();
            }
        }
    }
    kept.closed()
}

/// Returns the value of a linear form at a point; 0 if the point is on the side.
fn height_above(side: DVec4, p: DVec4) -> f64 {
    let v = side.dot(p);
    if v.abs() <= ROUNDING * p.w { 0.0 } else { v }
}

/// Appends the parameters inside an interval where the polynomial with these Bernstein coefficients changes its sign, in order.
fn roots(c: &[f64], from: f64, to: f64, out: &mut Vec<f64>) {
    /// Length of an interval that counts as a single parameter.
    const NARROW: f64 = 1e-15;
    let mut signs = c.iter().filter(|v| **v != 0.0).map(|v| *v > 0.0);
    let first = signs.next();
    if signs.all(|s| Some(s) == first) {
        return;
    }
    let middle = 0.5 * (from + to);
    if to - from <= NARROW {
        out.push(middle);
        return;
    }
    let (mut left, mut right) = (Vec::with_capacity(c.len()), c.to_vec());
    for last in (0..c.len()).rev() {
        left.push(right[0]);
        (0..last).for_each(|i| right[i] = 0.5 * (right[i] + right[i + 1]));
    }
    roots(&left, from, middle, out);
    if left.last() == Some(&0.0) {
        out.push(middle);
    }
    roots(&right, middle, to, out);
}

/// Returns the parts of 0..1 between the parameters where the second coordinate passes 0 or 1.
fn spans(curve: &dyn Fn(f64) -> [f64; 2]) -> Vec<[f64; 2]> {
    let parameter = |i: usize| i as f64 / STEPS as f64;
    let values: Vec<f64> = (0..=STEPS).map(|i| curve(parameter(i))[1]).collect();
    let mut cuts = vec![0.0, 1.0];
    for level in [0.0, 1.0] {
        let is_above = |t: f64| curve(t)[1] > level;
        let mut add_crossing = |mut a: f64, mut b: f64| {
            let starts_above = is_above(a);
            for _ in 0..48 {
                let m = 0.5 * (a + b);
                if is_above(m) == starts_above { a = m } else { b = m }
            }
            cuts.push(b);
        };
        for i in 0..STEPS {
            if (values[i] > level) != (values[i + 1] > level) {
                add_crossing(parameter(i), parameter(i + 1));
            } else if i > 0 && (values[i - 1] > level) == (values[i] > level) {
                // Near its extremum, the coordinate may pass the level twice.
                let distance = |k: usize| (values[k] - level).abs();
                if distance(i) <= distance(i - 1).min(distance(i + 1)) {
                    let sign = if values[i] > level { 1.0 } else { -1.0 };
                    let turn = minimum(&|t| sign * (curve(t)[1] - level), parameter(i - 1), parameter(i + 1));
                    if is_above(turn) != (values[i] > level) {
                        add_crossing(parameter(i - 1), turn);
                        add_crossing(turn, parameter(i + 1));
                    }
                }
            }
        }
    }
    cuts.sort_by(f64::total_cmp);
    cuts.windows(2).filter(|w| w[1] - w[0] > ROUNDING).map(|w| [w[0], w[1]]).collect()
}

/// Returns the minimizer in an interval of a function with a single minimum, by ternary search.
fn minimum(f: &dyn Fn(f64) -> f64, mut a: f64, mut b: f64) -> f64 {
    for _ in 0..40 {
        let third = (b - a) / 3.0;
        if f(a + third) < f(b - third) { b -= third } else { a += third }
    }
    0.5 * (a + b)
}

/// Returns cubics, each through four points of a curve and within a tolerance of it at three others.
fn fit_cubics(curve: &dyn Fn(f64) -> [f64; 2], [from, to]: [f64; 2], tolerance: f64, depth: usize) -> Vec<Curve> {
    let exact = |t: f64| curve(from + t * (to - from));
    let [a, p, q, d] = [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0].map(exact);
    let inner = |a: f64, p: f64, q: f64, d: f64| (-5.0 * a + 18.0 * p - 9.0 * q + 2.0 * d) / 6.0;
    let [b, c] = [[a, p, q, d], [d, q, p, a]].map(|[a, p, q, d]| [0, 1].map(|k| inner(a[k], p[k], q[k], d[k])));
    let cubic: Curve = [a, b, c, d].map(|[u, v]| DVec4::new(u, v, 0.0, 1.0)).to_vec();
    let is_close = |t: f64| {
        let (fit, truth) = (point(&cubic, t), exact(t));
        (fit[0] - truth[0]).hypot(fit[1] - truth[1]) <= tolerance
    };
    if depth == 0 || [1.0 / 6.0, 0.5, 5.0 / 6.0].into_iter().all(is_close) {
        return vec![cubic];
    }
    let middle = 0.5 * (from + to);
    [[from, middle], [middle, to]].into_iter().flat_map(|part| fit_cubics(curve, part, tolerance, depth - 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a circle of four rational quadratics.
    fn circle(u: f64, v: f64, r: f64) -> Vec<TrimCurve> {
        let corner = |k: usize| {
            [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [-1.0, 1.0], [-1.0, 0.0], [-1.0, -1.0], [0.0, -1.0], [1.0, -1.0]]
                [k % 8]
        };
        (0..4)
            .map(|k| TrimCurve {
                degree: 2,
                knots: surface::single_span_knots(2),
                points: (0..3).map(|i| corner(2 * k + i)).map(|[x, y]| [u + r * x, v + r * y]).collect(),
                weights: vec![1.0, 0.5f64.sqrt(), 1.0],
            })
            .collect()
    }

    fn trimmed(loops: Vec<Vec<TrimCurve>>) -> Trims {
        Trims::from_surface(&Surface { trims: loops, ..Surface::default() }).unwrap()
    }

    #[test]
    fn parts_of_a_disc() {
        let disc = trimmed(vec![circle(0.5, 0.5, 0.4)]);
        let quarter = disc.part([0.5, 0.5], [1.0, 1.0]).unwrap();
        // The quarter disc's area π·0.4²/4, as a fraction of a quarter of the square. `area` takes a polygon with 16 corners on the arc.
        let truth = std::f64::consts::PI * 0.16;
        assert_eq!(quarter.0.len(), 1);
        assert!((area(&quarter.0[0]) / truth - 1.0).abs() < 2e-3, "{}", area(&quarter.0[0]));
        for curve in &quarter.0[0] {
            for p in (0..=8).map(|i| point(curve, f64::from(i) / 8.0)) {
                let on_circle = (p[0].hypot(p[1]) - 0.8).abs() < 1e-12;
                assert!(on_circle || p[0].abs() < 1e-12 || p[1].abs() < 1e-12, "{p:?}");
            }
        }
        // Parts inside the disc, outside it, and inside the hole of a ring.
        assert_eq!(disc.part([0.4, 0.4], [0.6, 0.6]), None);
        assert!(disc.part([0.0, 0.0], [0.1, 0.1]).unwrap().is_empty());
        let ring = trimmed(vec![circle(0.5, 0.5, 0.4), circle(0.5, 0.5, 0.2)]);
        assert!(ring.part([0.45, 0.45], [0.55, 0.55]).unwrap().is_empty());
        assert_eq!(ring.part([0.45, 0.45], [1.0, 0.55]).unwrap().0.len(), 2);
        assert_eq!(ring.transposed().transposed(), ring);
        assert_eq!(trimmed(ring.curves()), ring);
    }

    #[test]
    fn signs_change_where_they_change() {
        // (t − 0.2)(t − 0.5)(t − 0.9), a double root (where a cut does no harm), a side along which the curve runs, and a line.
        for (c, truth) in [
            (vec![-0.09, 0.46 / 3.0, -0.41 / 3.0, 0.04], vec![0.2, 0.5, 0.9]),
            (vec![0.25, -0.25, 0.25], vec![0.5]),
            (vec![0.0, 0.0, 0.0], vec![]),
            (vec![-1.0, 1.0], vec![0.5]),
        ] {
            let mut found = Vec::new();
            roots(&c, 0.0, 1.0, &mut found);
            assert_eq!(found.len(), truth.len(), "{c:?}: {found:?}");
            assert!(found.iter().zip(&truth).all(|(a, b): (&f64, &f64)| (a - b).abs() < 1e-12), "{c:?}: {found:?}");
        }
    }
}
