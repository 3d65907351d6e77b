//! Guides: splines of cubics with continuous derivative, near to points.
//!
//! The values and derivatives at the knots minimise the weighted squares of the distances at the samples' parameters, plus a little bending
//! energy, which fixes what the samples leave open: a banded system. The samples' foot points are the next parameters. Intervals between
//! knots are halved where the guide is too far away or, in the mean, to one side; and weights move towards the furthest samples (Lawson).
//! The parameter `s` is nearly arc length, so that derivatives are nearly unit vectors.

use crate::banded::solve_banded;
use kurbo::{CubicBez, Point, Vec2};

/// Points with their parameters along a curve and their weights.
#[derive(Debug, Default, Clone)]
pub(crate) struct Samples {
    parameters: Vec<f64>,
    points: Vec<Point>,
    weights: Vec<f64>,
    /// Distances from the last guide.
    distances: Vec<f64>,
}

impl Samples {
    pub(crate) fn push(&mut self, parameter: f64, point: Point, weight: f64) {
        self.parameters.push(parameter);
        self.points.push(point);
        self.weights.push(weight);
        self.distances.push(0.0);
    }
}

/// An end of a guide.
#[derive(Debug, Clone, Copy)]
pub(crate) struct End {
    pub(crate) point: Point,
    /// Direction, if it is given.
    pub(crate) direction: Option<Vec2>,
}

/// The ends of a guide.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Ends {
    /// The guide runs from one end to the other.
    Open([End; 2]),
    /// The guide is closed.
    Closed,
}

/// A spline of cubics with continuous derivative.
#[derive(Debug, Clone, Default)]
pub(crate) struct Guide {
    /// Parameters of the knots.
    pub(crate) knots: Vec<f64>,
    /// Points and derivatives at the knots.
    values: Vec<(Point, Vec2)>,
}

/// Weight of the bending of an interval relative to the distances of its points.
const STIFFNESS: f64 = 1e-6;
/// Weight of given ends relative to that of all samples.
const END_WEIGHT: f64 = 1e3;
/// A guide up to this multiple of the allowed distance away may still come within it by other weights.
const REACHABLE: f64 = 2.5;

/// The cubic Hermite basis on an interval of length h, at the share t of it.
fn basis(t: f64, h: f64) -> [f64; 4] {
    let u = 1.0 - t;
    [u * u * (1.0 + 2.0 * t), u * u * t * h, t * t * (3.0 - 2.0 * t), -t * t * u * h]
}

impl Guide {
    /// The spline with these knots that is nearest to the samples.
    fn least_squares(knots: Vec<f64>, samples: &Samples, ends: Ends) -> Option<Self> {
        let n = knots.len();
        let (mut band, mut right, mut weights) = (vec![[0.0; 4]; 2 * n], vec![Vec2::ZERO; 2 * n], vec![0.0; n]);
        for i in 0..samples.parameters.len() {
            let (s, p, weight) = (samples.parameters[i], samples.points[i], samples.weights[i]);
            let k = interval(&knots, s);
            let h = knots[k + 1] - knots[k];
            let b = basis((s - knots[k]) / h, h);
            for i in 0..4 {
                for j in i..4 {
                    band[2 * k + i][j - i] += weight * b[i] * b[j];
                }
                right[2 * k + i] += p.to_vec2() * (weight * b[i]);
            }
            weights[k] += weight;
        }
        let total: f64 = weights.iter().sum();
        for k in 0..n - 1 {
            let h = knots[k + 1] - knots[k];
            let stiffness = STIFFNESS * (weights[k] + 1e-3 * total / n as f64); // Intervals without samples are stiff, too.
            // ∫ Bᵢ″Bⱼ″ over the interval, times h³.
            let bending = [
                [12.0, 6.0 * h, -12.0, 6.0 * h],
                [0.0, 4.0 * h * h, -6.0 * h, 2.0 * h * h],
                [0.0, 0.0, 12.0, -6.0 * h],
                [0.0, 0.0, 0.0, 4.0 * h * h],
            ];
            for i in 0..4 {
                for j in i..4 {
                    band[2 * k + i][j - i] += stiffness * bending[i][j];
                }
            }
        }
        if let Ends::Open(ends) = ends {
            for (i, End { point, direction }) in [(0, ends[0]), (2 * n - 2, ends[1])] {
                // Parameters are nearly lengths, so that derivatives are directions.
                for (i, given) in [(i, Some(point.to_vec2())), (i + 1, direction)] {
                    if let Some(given) = given {
                        band[i][0] += END_WEIGHT * total;
                        right[i] += given * (END_WEIGHT * total);
                    }
                }
            }
        }
        let values = solve_banded(band, right)?;
        let values = values.chunks_exact(2).map(|v| (v[0].to_point(), v[1])).collect();
        let mut out = Self { knots, values };
        if let Ends::Open(ends) = ends {
            for (i, End { point, direction }) in [(0, ends[0]), (n - 1, ends[1])] {
                out.values[i] = (point, direction.unwrap_or(out.values[i].1));
            }
        }
        Some(out)
    }

    /// The part between two knots, which become one.
    fn closed_part(&self, [first, last]: [usize; 2]) -> Self {
        let mut values = self.values[first..=last].to_vec();
        let [(p, d), (q, e)] = [values[0], values[last - first]];
        let both = (p.midpoint(q), (d + e) * 0.5);
        (values[0], values[last - first]) = (both, both);
        Self { knots: self.knots[first..=last].to_vec(), values }
    }

    /// Point, first and second derivative.
    fn jet(&self, s: f64) -> (Point, Vec2, Vec2) {
        let k = interval(&self.knots, s);
        let h = self.knots[k + 1] - self.knots[k];
        let t = (s - self.knots[k]) / h;
        let [(p, d), (q, e)] = [self.values[k], self.values[k + 1]];
        let (a, b) = (d * h, e * h);
        let (c2, c3) = ((q - p) * 3.0 - a * 2.0 - b, (p - q) * 2.0 + a + b);
        let point = p + (a + (c2 + c3 * t) * t) * t;
        (point, (a + (c2 * 2.0 + c3 * (3.0 * t)) * t) / h, (c2 * 2.0 + c3 * (6.0 * t)) / (h * h))
    }

    /// The parameter of the point nearest to `p`, sought from `s`, the distance, and the signed distance of `p` to the left.
    fn foot(&self, p: Point, s: f64) -> (f64, f64, f64) {
        let (mut least, mut nearest, mut left) = (f64::INFINITY, s, 0.0);
        let mut now = s;
        let ends = [self.knots[0], self.knots[self.knots.len() - 1]];
        for _ in 0..3 {
            let (q, d, dd) = self.jet(now);
            let v = p - q;
            let far = v.hypot();
            if far < least {
                (least, nearest, left) = (far, now, d.cross(v) / d.hypot());
            }
            // Newton's method for the derivative of the squared distance, whose second derivative is kept positive.
            let slope = d.hypot2() - v.dot(dd).min(0.5 * d.hypot2());
            let step = v.dot(d) / slope;
            // Stop if the step would shorten the squared distance by less than a millionth.
            if !step.is_finite() || (v.dot(d) * step).abs() < 1e-6 * far * far {
                break;
            }
            now = (now + step).clamp(ends[0], ends[1]);
        }
        (nearest, least, left)
    }

    /// The cubics of the spline.
    pub(crate) fn cubics(&self) -> impl Iterator<Item = CubicBez> + '_ {
        (1..self.knots.len()).map(|k| {
            let third = (self.knots[k] - self.knots[k - 1]) / 3.0;
            let [(p, d), (q, e)] = [self.values[k - 1], self.values[k]];
            CubicBez::new(p, p + d * third, q - e * third, q)
        })
    }

    /// Guides whose distance from all samples is at most `within`, with that distance: first with few knots, then with as many as it takes
    /// to come near to the samples without their noise. Intervals between knots are not shorter than `finest`. If no guide is found, `Err`
    /// holds the intervals in which the last one was too far away.
    pub(crate) fn candidates(
        samples: &mut Samples,
        mut knots: Vec<f64>,
        ends: Ends,
        [within, finest]: [f64; 2],
    ) -> Result<Vec<(Self, f64)>, Vec<[f64; 2]>> {
        /// Largest mean distance to one side, as a share of `within`: knots are added for one level after the other.
        const NEAR: [f64; 3] = [1.0, 0.25, 0.1];
        /// Most rounds of divisions for each level.
        const ROUNDS: usize = 8;
        let (mut out, mut failed, fine) = (Vec::new(), Vec::new(), 0.25 * within);
        let (mut levels, mut rounds) = (NEAR.iter().peekable(), 0);
        while let Some(near) = levels.peek() {
            // Fit twice: the second time, the foot points are the parameters.
            let first = Self::fitted(&knots, samples, ends);
            let Some((guide, mut misses)) = first.and_then(|_| Self::fitted(&knots, samples, ends)) else {
                break;
            };
            guide.add_edge_distances(samples, ends, fine, &mut misses);
            let far = furthest(&misses);
            if far <= REACHABLE * within {
                // Try more weight for far samples before dividing intervals.
                let evened = Self::even_out(&knots, samples, ends, fine);
                out.extend([Some((guide, far)), evened].into_iter().flatten().filter(|(_, far)| *far <= within));
            }
            let far = (0..misses.len()).filter(|k| misses[*k].far > within);
            failed = far.map(|k| [knots[k], knots[k + 1]]).collect();
            let divided = |near: f64| divided(&knots, &misses, [within, near * within, finest]);
            let (mut next, hopeless) = divided(**near);
            if hopeless && out.is_empty() {
                return Err(failed);
            }
            while next.len() == knots.len() || rounds == ROUNDS {
                levels.next();
                rounds = 0;
                match levels.peek() {
                    Some(near) if !out.is_empty() => next = divided(**near).0,
                    _ => return if out.is_empty() { Err(failed) } else { Ok(out) },
                }
            }
            rounds += 1;
            knots = next;
        }
        if out.is_empty() { Err(failed) } else { Ok(out) }
    }

    /// A spline whose largest distance is nearly as small as possible. In each round, samples gain weight with their distance (C. L.
    /// Lawson, *Contributions to the theory of linear least maximum approximation*, 1961).
    fn even_out(knots: &[f64], samples: &Samples, ends: Ends, fine: f64) -> Option<(Self, f64)> {
        const ROUNDS: usize = 4;
        /// Share of the weight that a sample keeps.
        const KEPT: f64 = 0.05;
        /// The rounds end with one whose distance is more than this share of the least before.
        const GAIN: f64 = 0.99;
        let (mut samples, mut best): (Samples, Option<(Self, f64)>) = (samples.clone(), None);
        for _ in 0..ROUNDS {
            let (guide, misses) = Self::fitted(knots, &mut samples, ends)?;
            let far = furthest(&misses);
            for (weight, distance) in samples.weights.iter_mut().zip(&samples.distances) {
                *weight *= KEPT + distance / far.max(f64::MIN_POSITIVE);
            }
            let least = best.as_ref().map_or(f64::INFINITY, |(_, least)| *least);
            if far < least {
                best = Some((guide, far));
            }
            if far > GAIN * least {
                break;
            }
        }
        let (guide, _) = best?;
        let mut misses = guide.misses(&mut samples);
        guide.add_edge_distances(&samples, ends, fine, &mut misses);
        Some((guide, furthest(&misses)))
    }

    /// The nearest spline, with the misses of its intervals. The samples' parameters become their foot points.
    fn fitted(knots: &[f64], samples: &mut Samples, ends: Ends) -> Option<(Self, Vec<Miss>)> {
        let guide = match ends {
            Ends::Open(_) => Self::least_squares(knots.to_vec(), samples, ends),
            Ends::Closed => Self::least_squares_closed(knots, samples),
        }?;
        let misses = guide.misses(samples);
        Some((guide, misses))
    }

    /// Misses of each interval. The samples' parameters become their foot points.
    fn misses(&self, samples: &mut Samples) -> Vec<Miss> {
        let mut out = vec![Miss::default(); self.knots.len() - 1];
        for i in 0..samples.parameters.len() {
            let (s, distance, left) = self.foot(samples.points[i], samples.parameters[i]);
            let k = interval(&self.knots, s);
            out[k].add((s - self.knots[k]) / (self.knots[k + 1] - self.knots[k]), distance, left, samples.weights[i]);
            (samples.parameters[i], samples.distances[i]) = (s, distance);
        }
        out
    }

    /// Adds the distances of the guide from the edges between neighbouring samples, measured in steps of about `fine` between foot points.
    fn add_edge_distances(&self, samples: &Samples, ends: Ends, fine: f64, misses: &mut [Miss]) {
        /// Most steps between two samples.
        const MOST: f64 = 64.0;
        let mut order: Vec<usize> = (0..samples.parameters.len()).collect();
        order.sort_by(|a, b| samples.parameters[*a].total_cmp(&samples.parameters[*b]));
        let Some(first) = order.first() else { return };
        let [from, to] = match ends {
            Ends::Open(ends) => ends.map(|e| e.point),
            Ends::Closed => [samples.points[*first]; 2],
        };
        let [start, end] = [self.knots[0], self.knots[self.knots.len() - 1]];
        let inner = order.iter().map(|i| (samples.parameters[*i], samples.points[*i]));
        let before = std::iter::once((start, from)).chain(inner.clone());
        for ((a, p), (b, q)) in before.zip(inner.chain([(end, to)])) {
            let speed = self.jet(a).1.hypot().max(self.jet(0.5 * (a + b)).1.hypot());
            let steps = ((b - a) * speed / fine).min(MOST);
            for j in 1..steps.ceil() as usize {
                let s = a + (b - a) * j as f64 / steps.ceil();
                let miss = &mut misses[interval(&self.knots, s)];
                miss.far = miss.far.max(squared_distance(self.jet(s).0, [p, q]).sqrt());
            }
        }
    }

    /// The nearest closed spline for knots from 0 to the length, fitted to samples that are repeated before the start and after the end.
    fn least_squares_closed(knots: &[f64], samples: &Samples) -> Option<Self> {
        let n = knots.len() - 1;
        let length = knots[n];
        let more = n.min(3);
        let mut all: Vec<f64> = knots[n - more..n].iter().map(|k| k - length).collect();
        all.extend(knots);
        all.extend(knots[1..=more].iter().map(|k| k + length));
        let [low, high] = [all[0], all[all.len() - 1]];
        let mut around = samples.clone();
        for i in 0..samples.parameters.len() {
            for round in [-length, length] {
                let s = samples.parameters[i] + round;
                if s >= low && s <= high {
                    around.push(s, samples.points[i], samples.weights[i]);
                }
            }
        }
        Some(Self::least_squares(all, &around, Ends::Closed)?.closed_part([more, more + n])) // `Closed`: ends without conditions.
    }
}

/// Squared distance of a point from an edge.
pub(crate) fn squared_distance(p: Point, [a, b]: [Point; 2]) -> f64 {
    let (v, w) = (b - a, p - a);
    let t = (w.dot(v) / v.hypot2()).clamp(0.0, 1.0);
    let t = if t.is_finite() { t } else { 0.0 };
    (w - v * t).hypot2()
}

/// Largest distance in all intervals.
fn furthest(misses: &[Miss]) -> f64 {
    misses.iter().map(|m| m.far).fold(0.0, f64::max)
}

/// Distances of a guide from the samples of one interval between knots.
#[derive(Debug, Default, Clone, Copy)]
struct Miss {
    /// The largest distance.
    far: f64,
    count: usize,
    /// For each quarter, the weighted sum of the distances to the left and the sum of the weights.
    quarters: [[f64; 2]; 4],
}

impl Miss {
    /// Adds a sample at a share of the interval, with its distance and its signed distance to the left.
    fn add(&mut self, share: f64, distance: f64, left: f64, weight: f64) {
        self.far = self.far.max(distance);
        self.count += 1;
        let quarter = &mut self.quarters[((4.0 * share) as usize).min(3)];
        quarter[0] += left * weight;
        quarter[1] += weight;
    }

    /// Largest mean distance to one side in a quarter, in which noise cancels.
    fn bias(&self) -> f64 {
        self.quarters.iter().map(|[sum, weight]| (sum / weight).abs()).fold(0.0, f64::max)
    }
}

/// Divides the intervals that are further away than `within` or, in the mean, than `near` to one side. Returns the knots, and `true` if an
/// interval that stays whole is so far away that other weights cannot bring it near.
fn divided(knots: &[f64], misses: &[Miss], [within, near, finest]: [f64; 3]) -> (Vec<f64>, bool) {
    /// Bias, as a share of the distance, from which on more knots help.
    const BIASED: f64 = 0.2;
    /// Noise has by chance a bias of this many times the largest distance, divided by the root of the number of samples.
    const CHANCE: f64 = 1.5;
    /// Least number of samples of an interval that is divided.
    const FEW: usize = 12;
    let (mut out, mut hopeless) = (vec![knots[0]], false);
    for (ends, miss) in knots.windows(2).zip(misses) {
        // Samples that are equally far to both sides are noise, which no division brings nearer.
        let noise = f64::max(BIASED, CHANCE / (miss.count as f64).sqrt()) * miss.far;
        let wanted = (miss.far > within && miss.bias() > noise) || miss.bias() > near;
        if wanted && ends[1] - ends[0] > 2.0 * finest && miss.count >= FEW {
            out.push(0.5 * (ends[0] + ends[1]));
        } else {
            hopeless |= miss.far > REACHABLE * within;
        }
        out.push(ends[1]);
    }
    (out, hopeless)
}

/// Index of the interval between knots that contains a parameter.
fn interval(knots: &[f64], s: f64) -> usize {
    knots[1..knots.len() - 1].partition_point(|k| *k <= s)
}
