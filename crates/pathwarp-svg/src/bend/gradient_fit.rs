//! Fits an SVG gradient to a bent one: the nearest linear or radial gradient, with as many stops as needed.
//!
//! The image of a gradient is constant along its level curves. If these are nearly lines or ellipses, they are also the level curves of an
//! SVG gradient, whose stops give the colour of each. The level curves are found by variable projection (Golub and Pereyra 1973): for
//! given level curves, the piecewise linear profile nearest to the samples follows by linear least squares, and the Levenberg–Marquardt
//! method moves the curves so that the remaining residuals shrink.

use super::shading::{GradientShape, SAME_OFFSET, Shading, Stop, premultiplied};
use pathwarp::kurbo::{Affine, Point, Vec2};
use usvg::SpreadMethod;

/// A point of the source and its image, in the user space of the result.
pub(super) type Moved = (Point, Point);

/// Number of samples in the search for level curves.
const SEARCH_SAMPLES: usize = 256;
/// Number of cells, that is, intervals of the piecewise linear profile, during the search.
const CELLS: usize = 10;
/// Numbers of cells of the profiles that are tried as gradients.
const TRIED_CELLS: [usize; 5] = [1, 2, 4, 8, 16];
/// Most periods of a gradient that repeats.
const MAX_PERIODS: f64 = 8.0;
/// Margin on either side of the samples' range, as a fraction of it, for points between and around the samples.
const MARGIN: f64 = 0.03;
/// Largest offset at which the colours of a radial gradient may begin, since some renderers hold 256 colours from offset 0 on.
const MAX_FIRST_OFFSET: f64 = 0.9;
/// Work of the search, in evaluations of a map.
pub(super) const SEARCH_WORK: f64 = 60e3;

/// The SVG gradient that looks like the bent one, if any does: the plainest good one, or else the best. `fitted` is the gradient under an
/// affine fit, from which a search starts. `error` measures the visible error of a gradient; at most 1 is acceptable.
pub(super) fn nearest(
    shading: &Shading,
    fitted: Option<&Shading>,
    moved: &[Moved],
    error: impl Fn(&Shading) -> f64,
) -> Option<Shading> {
    /// An error at which more stops are not worth their bytes.
    const GOOD: f64 = 0.4;
    let ramp = Ramp::new(shading, moved)?;
    let samples = Samples::new(shading, &ramp, moved)?;
    let few = samples.thinned(SEARCH_SAMPLES);
    let mut best: Option<(f64, Shading)> = None;
    // Tries gradients with these level curves, until one is good.
    let mut finds_good = |levels: Levels| {
        for gradient in samples.gradients(&ramp, levels) {
            let error = error(&gradient);
            if error <= best.as_ref().map_or(1.0, |b| b.0) {
                best = Some((error, gradient));
            }
            if error <= GOOD {
                return true;
            }
        }
        false
    };
    if !finds_good(few.refined(Levels::Lines(few.steepest()))) {
        let circles = few.refined(Levels::Circles(few.coarse_centre()));
        if !finds_good(circles) {
            let centre = circles.parameters();
            let concentric = [centre[0], centre[1], 0.0, 0.0, 0.0, 0.0];
            let starts = [Some(concentric), fitted.and_then(|f| f.ellipses(samples.to_user))];
            let found = starts.into_iter().flatten().map(|start| few.refined(Levels::Ellipses(start)));
            let rated = found.map(|e| (few.residuals(e).1, e)).min_by(|a, b| a.0.total_cmp(&b.0));
            rated.map(|(_, ellipses)| finds_good(ellipses));
        }
    }
    best.map(|b| b.1)
}

/// The colours along a gradient, with all visible periods written out, and a scale on which they change evenly.
struct Ramp {
    stops: Vec<Stop>,
    /// The scale's value at each stop. It does not grow where colours jump.
    scale: Vec<f64>,
}

impl Ramp {
    fn new(shading: &Shading, moved: &[Moved]) -> Option<Self> {
        let parameters = moved.iter().map(|p| shading.parameter_at(p.0)).filter(|t| t.is_finite());
        let (from, to) = range(parameters);
        let stops = match shading.spread {
            SpreadMethod::Pad => padded(&shading.stops, from, to),
            SpreadMethod::Repeat | SpreadMethod::Reflect => {
                let (first, last) = (from.floor(), to.ceil());
                if last - first > MAX_PERIODS {
                    return None;
                }
                (0..(last - first) as usize).flat_map(|n| period(shading, first + n as f64)).collect()
            }
        };
        let change = |pair: &[Stop]| {
            let (a, b) = (premultiplied(pair[0].color), premultiplied(pair[1].color));
            a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        let length = stops.last()?.offset - stops.first()?.offset;
        // The scale grows a little even where colours do not change, so that jumps and ends are fitted, too.
        let total: f64 = stops.windows(2).map(change).sum();
        if !(length > 0.0 && total > 0.0) {
            return None;
        }
        let least = 0.2 * total / length;
        let mut scale = vec![0.0];
        for pair in stops.windows(2) {
            let distance = pair[1].offset - pair[0].offset;
            let growth = if distance <= SAME_OFFSET { 0.0 } else { change(pair) + least * distance };
            scale.push(scale[scale.len() - 1] + growth);
        }
        Some(Self { stops, scale })
    }

    /// The scale's value at the gradient's parameter `t`. It grows a little beyond the first and last stops, although colours are constant
    /// there, since profiles would otherwise have kinks.
    fn scale_at(&self, t: f64) -> f64 {
        const BEYOND: f64 = 0.15;
        let last = self.stops.len() - 1;
        let next = self.stops.partition_point(|s| s.offset <= t).clamp(1, last);
        let [from, to] = [self.stops[next - 1].offset, self.stops[next].offset];
        let rate = if to - from <= SAME_OFFSET { 0.0 } else { (self.scale[next] - self.scale[next - 1]) / (to - from) };
        let end = self.scale[last];
        (self.scale[next - 1] + (t - from) * rate).clamp(-BEYOND * end, (1.0 + BEYOND) * end)
    }

    /// The colour at the value `v` of the scale.
    fn color_at(&self, v: f64) -> [f64; 4] {
        let next = self.scale.partition_point(|s| *s < v).clamp(1, self.scale.len() - 1);
        let (a, b) = (self.scale[next - 1], self.scale[next]);
        let share = if b > a { ((v - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
        let [from, to] = [self.stops[next - 1].color, self.stops[next].color];
        std::array::from_fn(|k| from[k] + share * (to[k] - from[k]))
    }

    /// The stops of a gradient that has these values of the scale at evenly spaced offsets.
    fn stops(&self, profile: &[f64]) -> Vec<Stop> {
        let mut out = Vec::new();
        let cells = (profile.len() - 1) as f64;
        for (k, pair) in profile.windows(2).enumerate() {
            let (from, to) = (pair[0], pair[1]);
            out.push(Stop { offset: k as f64 / cells, color: self.color_at(from) });
            let is_between = |i: &usize| (self.scale[*i] - from) * (self.scale[*i] - to) < 0.0;
            let mut crossed: Vec<usize> = (0..self.scale.len()).filter(is_between).collect();
            if to < from {
                crossed.reverse();
            }
            let offset = |v: f64| (k as f64 + (v - from) / (to - from)) / cells;
            out.extend(crossed.iter().map(|&i| Stop { offset: offset(self.scale[i]), color: self.stops[i].color }));
        }
        out.push(Stop { offset: 1.0, color: self.color_at(profile[profile.len() - 1]) });
        pruned(&out)
    }
}

/// The stops, with another at either end of the range where colours jump at the first or the last stop.
fn padded(stops: &[Stop], from: f64, to: f64) -> Vec<Stop> {
    let jumps =
        |a: Option<&Stop>, b: Option<&Stop>| a.zip(b).is_none_or(|(a, b)| (b.offset - a.offset).abs() <= SAME_OFFSET);
    let end = |s: Option<&Stop>, at: f64| s.map(|s| Stop { offset: at, ..*s });
    let (first, last) = (stops.first(), stops.last());
    let before = end(first, from).filter(|b| jumps(first, stops.get(1)) && first.is_some_and(|f| b.offset < f.offset));
    let second = stops.len().checked_sub(2).and_then(|k| stops.get(k));
    let after = end(last, to).filter(|a| jumps(last, second) && last.is_some_and(|l| a.offset > l.offset));
    before.into_iter().chain(stops.iter().copied()).chain(after).collect()
}

/// The stops of a gradient in its period from `n` to `n + 1`.
fn period(shading: &Shading, n: f64) -> Vec<Stop> {
    let (Some(first), Some(last)) = (shading.stops.first(), shading.stops.last()) else { return Vec::new() };
    let mut out = vec![Stop { offset: 0.0, ..*first }];
    out.extend(&shading.stops);
    out.push(Stop { offset: 1.0, ..*last });
    if shading.spread == SpreadMethod::Reflect && n.rem_euclid(2.0) == 1.0 {
        out.reverse();
        out.iter_mut().for_each(|s| s.offset = 1.0 - s.offset);
    }
    out.iter_mut().for_each(|s| s.offset += n);
    out
}

/// Drops stops without which the colours stay the same.
fn pruned(stops: &[Stop]) -> Vec<Stop> {
    /// A difference that rounding to 255 levels hides.
    const HIDDEN: f64 = 0.3 / 255.0;
    let mut out: Vec<Stop> = Vec::with_capacity(stops.len());
    // The stops dropped since the last one that is kept.
    let mut dropped: Vec<Stop> = Vec::new();
    for (i, stop) in stops.iter().enumerate() {
        let is_interpolated = |s: &Stop, a: &Stop, b: &Stop| {
            let share = if b.offset > a.offset { (s.offset - a.offset) / (b.offset - a.offset) } else { 2.0 };
            (0..4).all(|k| (a.color[k] + share * (b.color[k] - a.color[k]) - s.color[k]).abs() <= HIDDEN)
        };
        if let (Some(a), Some(b)) = (out.last(), stops.get(i + 1)) {
            dropped.push(*stop);
            if dropped.iter().all(|s| is_interpolated(s, a, b)) {
                continue;
            }
        }
        dropped.clear();
        out.push(*stop);
    }
    out
}

/// The level curves of a gradient, in the coordinates of [`Samples`].
#[derive(Debug, Clone, Copy)]
enum Levels {
    /// Lines perpendicular to the direction at this angle.
    Lines(f64),
    /// Circles around a point.
    Circles([f64; 2]),
    /// Ellipses that shrink to a focus: the focus; p and r, where \[\[p, r\], \[r, −p\]\] is the logarithm of the symmetric matrix of
    /// determinant 1 that makes circles of them; and the shift of their centres, mapped from the plane to the unit disc.
    Ellipses([f64; 6]),
}

impl Levels {
    fn parameters(self) -> Vec<f64> {
        match self {
            Self::Lines(angle) => vec![angle],
            Self::Circles(centre) => centre.to_vec(),
            Self::Ellipses(all) => all.to_vec(),
        }
    }

    fn with_parameters(self, p: &[f64]) -> Self {
        match self {
            Self::Lines(_) => Self::Lines(p[0]),
            Self::Circles(_) => Self::Circles([p[0], p[1]]),
            Self::Ellipses(_) => Self::Ellipses(std::array::from_fn(|k| p[k])),
        }
    }

    /// The focus, the matrix, and the shift of the centres for each unit of the circles' radius, of the parameters of [`Self::Ellipses`].
    fn cone(parameters: [f64; 6]) -> (Point, Affine, Vec2) {
        /// Largest shift. From 1 on, the circles would no longer be nested.
        const MAX_SHIFT: f64 = 0.9;
        let [fx, fy, p, r, ex, ey] = parameters;
        // The matrix exponential in closed form: cosh m plus the logarithm times sinh m / m, where m² = p² + r².
        let m = p.hypot(r);
        let (cosh, ratio) = (m.cosh(), if m > 1e-9 { m.sinh() / m } else { 1.0 });
        let shift = Vec2::new(ex, ey);
        let shift = shift * (MAX_SHIFT / (1.0 + shift.hypot2()).sqrt());
        (Point::new(fx, fy), Affine::new([cosh + ratio * p, ratio * r, ratio * r, cosh - ratio * p, 0.0, 0.0]), shift)
    }

    /// The parameter of the level curve through each point.
    fn parameters_at(self, points: &[Point]) -> Vec<f64> {
        match self {
            Self::Lines(angle) => {
                let direction = Vec2::from_angle(angle);
                points.iter().map(|q| q.to_vec2().dot(direction)).collect()
            }
            Self::Circles([x, y]) => points.iter().map(|q| q.distance(Point::new(x, y))).collect(),
            Self::Ellipses(p) => {
                let (focus, to_circles, shift) = Self::cone(p);
                // The positive root s of |y − s·shift| = s.
                let a = 1.0 - shift.hypot2();
                let radius = |q: &Point| {
                    let y = (to_circles * (*q - focus).to_point()).to_vec2();
                    let b = y.dot(shift);
                    ((b * b + a * y.hypot2()).sqrt() - b) / a
                };
                points.iter().map(radius).collect()
            }
        }
    }

    /// The gradient whose offset 1 is at the parameter `to`, and whose offset 0 is at `from` for lines and at the focus otherwise.
    /// `to_user` leads from the samples' coordinates to user space.
    fn shading(self, (from, to): (f64, f64), to_user: Affine, stops: Vec<Stop>) -> Shading {
        let scale = to_user.determinant().abs().sqrt();
        let (kind, transform) = match self {
            Self::Lines(angle) => {
                let direction = Vec2::from_angle(angle);
                let round = rounder((to - from) * scale);
                let [a, b] = [from, to].map(|s| to_user * (direction * s).to_point());
                let [a, b] = [a, b].map(|p| Point::new(round(p.x), round(p.y)));
                (GradientShape::Linear { from: a, slope: (b - a) / (b - a).hypot2() }, Affine::IDENTITY)
            }
            Self::Circles([x, y]) => {
                let round = rounder(to * scale);
                let (centre, radius) = (to_user * Point::new(x, y), round(to * scale));
                let centre = Point::new(round(centre.x), round(centre.y));
                (GradientShape::Radial { centre, radius, focus: centre, focal_radius: 0.0 }, Affine::IDENTITY)
            }
            Self::Ellipses(p) => {
                let (focus, to_circles, shift) = Self::cone(p);
                let transform = to_user * Affine::translate(focus.to_vec2()) * to_circles.inverse() * Affine::scale(to);
                let centre = shift.to_point();
                (GradientShape::Radial { centre, radius: 1.0, focus: Point::ORIGIN, focal_radius: 0.0 }, transform)
            }
        };
        Shading { to_gradient: transform.inverse(), kind, stops, spread: SpreadMethod::Pad }
    }
}

/// A function that rounds to the power of ten at or below a ten thousandth of a length.
fn rounder(length: f64) -> impl Fn(f64) -> f64 {
    let unit = 10.0_f64.powf((1e-4 * length).log10().floor());
    move |v| (v / unit).round() * unit
}

impl Shading {
    /// The level curves of a radial gradient with the centre moved to the focus, as parameters of [`Levels::Ellipses`]. `to_user` leads
    /// from the samples' coordinates to user space.
    fn ellipses(&self, to_user: Affine) -> Option<[f64; 6]> {
        let GradientShape::Radial { focus, .. } = self.kind else { return None };
        let to_gradient = self.to_gradient * to_user;
        let [a, b, c, d, ..] = to_gradient.as_coeffs();
        // The square of the symmetric matrix of determinant 1; half of the square's logarithm is the matrix's.
        let unit = to_gradient.determinant().abs();
        let [xx, xy, yy] = [a * a + b * b, a * c + b * d, c * c + d * d].map(|v| v / unit);
        let m = (0.5 * (xx + yy)).max(1.0).acosh();
        let half = if m > 1e-6 { 0.5 * m / m.sinh() } else { 0.5 };
        let focus = to_gradient.inverse() * focus;
        let all = [focus.x, focus.y, half * 0.5 * (xx - yy), half * xy, 0.0, 0.0];
        all.iter().all(|v| v.is_finite()).then_some(all)
    }
}

/// Points of the result about their mean, in units of their standard deviation, with their values on the ramp's scale.
struct Samples {
    points: Vec<Point>,
    values: Vec<f64>,
    /// Leads to the user space of the result.
    to_user: Affine,
}

impl Samples {
    fn new(shading: &Shading, ramp: &Ramp, moved: &[Moved]) -> Option<Self> {
        let n = moved.len() as f64;
        let mean = moved.iter().map(|m| m.1.to_vec2()).fold(Vec2::ZERO, |a, b| a + b) / n;
        let spread = (moved.iter().map(|m| (m.1.to_vec2() - mean).hypot2()).sum::<f64>() / n).sqrt();
        if moved.len() < 3 * CELLS || !(spread > 0.0 && spread.is_finite()) {
            return None;
        }
        let to_user = Affine::translate(mean) * Affine::scale(spread);
        let from_user = to_user.inverse();
        let values: Vec<f64> = moved.iter().map(|m| ramp.scale_at(shading.parameter_at(m.0))).collect();
        let points = moved.iter().map(|m| from_user * m.1).collect();
        values.iter().all(|v| v.is_finite()).then_some(Self { points, values, to_user })
    }

    /// At most `most` of the samples, evenly taken.
    fn thinned(&self, most: usize) -> Self {
        let step = self.points.len().div_ceil(most).max(1);
        Self {
            points: self.points.iter().copied().step_by(step).collect(),
            values: self.values.iter().copied().step_by(step).collect(),
            to_user: self.to_user,
        }
    }

    /// The direction in which the values rise, by least squares.
    fn steepest(&self) -> f64 {
        let (mut xx, mut xy, mut yy, mut vx, mut vy) = (0.0, 0.0, 0.0, 0.0, 0.0);
        let mean = self.values.iter().sum::<f64>() / self.values.len() as f64;
        for (q, v) in self.points.iter().zip(&self.values) {
            xx += q.x * q.x;
            xy += q.x * q.y;
            yy += q.y * q.y;
            vx += q.x * (v - mean);
            vy += q.y * (v - mean);
        }
        (xx * vy - xy * vx).atan2(yy * vx - xy * vy)
    }

    /// The best centre for circles among points on rings around the samples, near and far.
    fn coarse_centre(&self) -> [f64; 2] {
        const PER_RING: u32 = 16;
        const RADII: [f64; 5] = [0.0, 0.7, 1.5, 3.0, 8.0];
        let on_ring = |r: f64, k: u32| {
            let p = Vec2::from_angle(std::f64::consts::TAU * f64::from(k) / f64::from(PER_RING)) * r;
            [p.x, p.y]
        };
        let centres = RADII.into_iter().flat_map(|r| (0..PER_RING).map(move |k| on_ring(r, k)));
        let rated = centres.map(|c| (self.residuals(Levels::Circles(c)).1, c));
        rated.min_by(|a, b| a.0.total_cmp(&b.0)).map_or([0.0; 2], |b| b.1)
    }

    /// The residuals of the best profile along these level curves, and the sum of their squares.
    fn residuals(&self, levels: Levels) -> (Vec<f64>, f64) {
        let along = levels.parameters_at(&self.points);
        let range = range(along.iter().copied());
        let profile = fit_profile(&along, &self.values, range, CELLS);
        let residuals = along.iter().zip(&self.values).map(|(s, v)| v - profile_at(&profile, range, *s));
        let residuals: Vec<f64> = residuals.collect();
        let sum = residuals.iter().map(|r| r * r).sum::<f64>();
        (residuals, if sum.is_finite() { sum } else { f64::INFINITY })
    }

    /// The level curves near `start` and of its kind whose residuals are least, by the Levenberg–Marquardt method.
    fn refined(&self, start: Levels) -> Levels {
        const ROUNDS: usize = 24;
        /// Step of the finite differences that give the derivatives.
        const STEP: f64 = 1e-5;
        let (mut levels, mut damping) = (start, 1e-3);
        let (mut residuals, mut sum) = self.residuals(levels);
        for _ in 0..ROUNDS {
            let p = levels.parameters();
            let derivative = |k: usize| {
                let mut shifted = p.clone();
                shifted[k] += STEP;
                let (there, _) = self.residuals(levels.with_parameters(&shifted));
                there.iter().zip(&residuals).map(|(a, b)| (a - b) / STEP).collect::<Vec<f64>>()
            };
            let columns: Vec<Vec<f64>> = (0..p.len()).map(derivative).collect();
            let before = sum;
            for _ in 0..6 {
                let Some(step) = damped_step(&columns, &residuals, damping) else { break };
                let next = levels.with_parameters(&p.iter().zip(&step).map(|(p, s)| p - s).collect::<Vec<f64>>());
                let (next_residuals, next_sum) = self.residuals(next);
                if next_sum < sum {
                    (levels, residuals, sum, damping) = (next, next_residuals, next_sum, damping * 0.2);
                    break;
                }
                damping *= 5.0;
            }
            if sum.is_nan() || sum >= 0.999 * before {
                break;
            }
        }
        levels
    }

    /// The gradients with these level curves, from few stops to many.
    fn gradients(&self, ramp: &Ramp, levels: Levels) -> impl Iterator<Item = Shading> {
        let along = levels.parameters_at(&self.points);
        let (from, to) = range(along.iter().copied());
        let margin = MARGIN * (to - from);
        let range = (from - margin, to + margin);
        let is_radial = !matches!(levels, Levels::Lines(_));
        let range = if is_radial { (range.0.max(0.0), range.1) } else { range };
        let tried = if is_radial && range.0 > MAX_FIRST_OFFSET * range.1 { &[][..] } else { &TRIED_CELLS };
        tried.iter().map(move |&cells| {
            let profile = monotone(fit_profile(&along, &self.values, range, cells));
            let mut stops = ramp.stops(&profile);
            if is_radial {
                stops.iter_mut().for_each(|s| s.offset = (range.0 + s.offset * (range.1 - range.0)) / range.1);
            }
            levels.shading(range, self.to_user, stops)
        })
    }
}

/// The least and the largest of some values.
fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), s| (a.min(s), b.max(s)))
}

/// The index of the cell that holds the parameter `s` in an evenly divided range, and the parameter within that cell, 0 to 1.
fn cell(s: f64, (from, to): (f64, f64), cells: usize) -> (usize, f64) {
    let u = (((s - from) / (to - from)) * cells as f64).clamp(0.0, cells as f64);
    let k = (u as usize).min(cells - 1);
    (k, u - k as f64)
}

/// The value of a profile at the parameter `s`.
fn profile_at(profile: &[f64], range: (f64, f64), s: f64) -> f64 {
    let (k, u) = cell(s, range, profile.len() - 1);
    profile[k] + u * (profile[k + 1] - profile[k])
}

/// The piecewise linear function nearest to the samples, by its values at the ends of `cells` cells.
fn fit_profile(along: &[f64], values: &[f64], range: (f64, f64), cells: usize) -> Vec<f64> {
    /// Weight of the differences between neighbours, which determine the values of cells without samples.
    const TIE: f64 = 1e-6;
    let tie = TIE * along.len() as f64;
    let (mut diagonal, mut beside, mut right) = (vec![0.0; cells + 1], vec![-tie; cells], vec![0.0; cells + 1]);
    for k in 0..cells {
        diagonal[k] += tie;
        diagonal[k + 1] += tie;
    }
    for (s, v) in along.iter().zip(values) {
        let (k, u) = cell(*s, range, cells);
        let w = 1.0 - u;
        diagonal[k] += w * w;
        diagonal[k + 1] += u * u;
        beside[k] += w * u;
        right[k] += w * v;
        right[k + 1] += u * v;
    }
    // Gaussian elimination of a tridiagonal system.
    for k in 0..cells {
        let factor = beside[k] / diagonal[k];
        diagonal[k + 1] -= factor * beside[k];
        right[k + 1] -= factor * right[k];
    }
    for k in (0..=cells).rev() {
        let above = if k < cells { beside[k] * right[k + 1] } else { 0.0 };
        right[k] = (right[k] - above) / diagonal[k];
    }
    right
}

/// The profile with its values raised or lowered to the last extreme, so that it rises or falls throughout.
fn monotone(mut profile: Vec<f64>) -> Vec<f64> {
    let falls = profile[profile.len() - 1] < profile[0];
    let sign = if falls { -1.0 } else { 1.0 };
    let mut extreme = f64::NEG_INFINITY;
    for v in &mut profile {
        extreme = extreme.max(sign * *v);
        *v = sign * extreme;
    }
    profile
}

/// The step of the Levenberg–Marquardt method: the solution of the damped normal equations. `columns` are the derivatives of the residuals.
/// Returns `None` if the equations are singular.
fn damped_step(columns: &[Vec<f64>], residuals: &[f64], damping: f64) -> Option<Vec<f64>> {
    let n = columns.len();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut rows: Vec<Vec<f64>> = (0..n)
        .map(|i| (0..n).map(|j| dot(&columns[i], &columns[j])).chain([dot(&columns[i], residuals)]).collect())
        .collect();
    let largest = (0..n).map(|i| rows[i][i]).fold(0.0, f64::max);
    for (i, row) in rows.iter_mut().enumerate() {
        row[i] += damping * row[i].max(1e-6 * largest);
    }
    for i in 0..n {
        let pivot = rows[i].clone();
        if !(pivot[i] > 0.0 && pivot[i].is_finite()) {
            return None;
        }
        for row in rows.iter_mut().skip(i + 1) {
            let factor = row[i] / pivot[i];
            row.iter_mut().zip(&pivot).for_each(|(a, b)| *a -= factor * b);
        }
    }
    let mut out = vec![0.0; n];
    for i in (0..n).rev() {
        let rest: f64 = (i + 1..n).map(|j| rows[i][j] * out[j]).sum();
        out[i] = (rows[i][n] - rest) / rows[i][i];
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::super::shading::tests::shading;
    use super::*;

    /// Straight lines across become circles around (50, 400): 100 units of x are a quarter of a turn, and y is the radius.
    fn ring(p: Point) -> Point {
        Point::new(50.0, 400.0)
            + Vec2::from_angle((p.x - 150.0) / 100.0 * std::f64::consts::FRAC_PI_2) * (80.0 + 2.0 * p.y)
    }

    /// The Möbius map z / (1 + z / 400) about (50, 40): circles stay circles, whose centres move.
    fn inversion(p: Point) -> Point {
        let (x, y) = (p.x - 50.0, p.y - 40.0);
        let (a, b) = (1.0 + x / 400.0, y / 400.0);
        let size = a * a + b * b;
        Point::new((x * a + y * b) / size, (y * a - x * b) / size)
    }

    fn points(n: u32) -> impl Iterator<Item = Point> {
        (0..n).map(move |k| {
            let k = f64::from(k);
            Point::new((k * 0.618_033_988_749_895).fract() * 100.0, (k + 0.5) / f64::from(n) * 80.0)
        })
    }

    /// The nearest gradient, and its largest difference from the definition on 99 % of points to which it was not fitted.
    fn fitted(gradient: &str, map: fn(Point) -> Point) -> Option<(Shading, f64)> {
        let source = shading(gradient);
        let off = |found: &Shading, points: &mut dyn Iterator<Item = Point>| {
            let one = |p: Point| {
                let (a, b) = (source.premultiplied(p), found.premultiplied(map(p)));
                a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
            };
            let mut all: Vec<f64> = points.map(one).collect();
            all.sort_by(f64::total_cmp);
            all[all.len() * 99 / 100]
        };
        let moved: Vec<Moved> = points(400).map(|p| (p, map(p))).collect();
        let found = nearest(&source, None, &moved, |s| off(s, &mut points(400)) / (8.0 / 255.0))?;
        let worst = off(&found, &mut points(5000));
        Some((found, worst))
    }

    #[test]
    fn lines_that_become_circles_are_a_radial_gradient() {
        let stops = "<stop stop-color='red'/><stop offset='.3' stop-color='#0f8' stop-opacity='.5'/><stop offset='1' \
                     stop-color='blue'/>";
        for (spread, end, most) in [("pad", "1", 0.5), ("reflect", ".4", 1.0)] {
            let geometry = format!("x2='0' y2='{end}' spreadMethod='{spread}'");
            let gradient = format!("<linearGradient id='a' {geometry}>{stops}</linearGradient>");
            let (found, worst) = fitted(&gradient, ring).unwrap();
            let GradientShape::Radial { centre, .. } = found.kind else { panic!("{gradient}: {found:?}") };
            let centre = found.to_gradient.inverse() * centre;
            assert!(centre.distance(Point::new(50.0, 400.0)) < most, "{gradient}: {centre}");
            assert!(worst < 8.5 / 255.0, "{gradient}: {}", worst * 255.0);
        }
    }

    #[test]
    fn uneven_lines_are_a_linear_gradient_with_more_stops() {
        let uneven = |p: Point| Point::new(p.x + 0.008 * p.x * p.x, p.y);
        let gradient =
            "<linearGradient id='a'><stop stop-color='red'/><stop offset='1' stop-color='blue'/></linearGradient>";
        let (found, worst) = fitted(gradient, uneven).unwrap();
        assert!(matches!(found.kind, GradientShape::Linear { .. }), "{found:?}");
        assert!((3..=12).contains(&found.stops.len()) && worst < 3.5 / 255.0, "{found:?}: {}", worst * 255.0);
        // A jump stays one, where it belongs.
        let hard = "<linearGradient id='a'><stop offset='.5' stop-color='red'/><stop offset='.5' stop-color='blue'/>\
                    </linearGradient>";
        let (found, _) = fitted(hard, |p| Point::new(2.0 * p.x, p.y)).unwrap();
        let jump = found.stops.windows(2).find(|w| w[1].offset - w[0].offset < 1e-3).unwrap();
        assert!((jump[0].color[0] - 1.0).abs() < 0.01 && (jump[1].color[2] - 1.0).abs() < 0.01, "{found:?}");
    }

    #[test]
    fn circles_whose_centres_move_are_a_radial_gradient() {
        let gradient = "<radialGradient id='a' gradientUnits='userSpaceOnUse' cx='50' cy='40' r='60'><stop stop-color='yellow'/><stop offset='1' stop-color='#06c'/></radialGradient>";
        let (found, worst) = fitted(gradient, inversion).unwrap();
        assert!(
            matches!(found.kind, GradientShape::Radial { .. }) && worst < 8.5 / 255.0,
            "{found:?}: {}",
            worst * 255.0
        );
    }

    #[test]
    fn waves_are_no_gradient() {
        let wave = |p: Point| Point::new(p.x, p.y + 10.0 * (p.x / 8.0).sin());
        let gradient = "<linearGradient id='a' x2='0' y2='1'><stop stop-color='red'/><stop offset='1' stop-color='blue'/>\
                        </linearGradient>";
        assert!(fitted(gradient, wave).is_none());
    }
}
